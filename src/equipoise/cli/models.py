"""Commands about model files: `examples`, `check`, `schema`, `new`."""

from __future__ import annotations

import sys
from typing import Annotated

from equipoise.cli.app import FILE, app
from equipoise.cli.options import naming


@app.command(name="examples")
def examples_() -> None:
    """List the bundled model files; their names can stand for FILE everywhere."""
    from equipoise.io.models import examples

    found = examples()
    width = max(map(len, found))
    for name, title in found.items():
        print(f"{name:<{width}}  {title}")


@app.command
def check(file: Annotated[str, FILE], /) -> None:
    """Check a model file and tell how the linkage or tool is built up.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example.
    """
    from equipoise.io.tools import load_any
    from equipoise.tools.model import Tool

    model = load_any(file)
    if isinstance(model, Tool):
        from equipoise.terminal.check_tool import print_check_of_tool

        print_check_of_tool(model, file)
        return
    from equipoise.terminal.check import print_check

    with naming(file):
        print_check(model)


@app.command
def schema(*, tool: bool = False) -> None:
    """Print the JSON Schema of the model file, for editors.

    Parameters
    ----------
    tool
        That of the file of a hand-held tool.
    """
    import json

    from equipoise.io.models import json_schema
    from equipoise.io.tools import tool_schema

    print(json.dumps(tool_schema() if tool else json_schema(), indent=2))


@app.command
def new(file: Annotated[str, FILE] = "machine.toml", /, *, tool: bool = False) -> None:
    """Write a commented model file to start from.

    Parameters
    ----------
    file
        Where to write it; a file that is there already is left alone.
    tool
        That of a hand-held tool, not of a linkage.
    """
    from importlib.resources import files

    from equipoise.io.output import write

    name, command = ("start-tool.toml", "tool") if tool else ("start.toml", "analyze")
    start = files("equipoise").joinpath("io", name).read_text(encoding="utf-8")
    write(file, start, replace=False)
    print(f"wrote {file}; next: equipoise {command} {file}", file=sys.stderr)
