"""Commands about files: `examples`, `check`, `schema`, `new`."""

from __future__ import annotations

import sys
from typing import Annotated

from equipoise.cli.app import FILE, app
from equipoise.cli.options import naming
from equipoise.errors import UsageError

STARTS = {
    # kind of file: text to start from, usual name, what comes next
    "linkage": ("start.toml", "machine.toml", "equipoise analyze {}"),
    "tool": ("start-tool.toml", "machine.toml", "equipoise tool {}"),
    "study": ("start-study.toml", "study.toml", "equipoise sweep {} -o designs.zarr"),
}


@app.command(name="examples")
def examples_() -> None:
    """List the bundled models and studies; their names can stand for FILE and STUDY everywhere."""
    from equipoise.schema.models import examples

    found = examples()
    width = max(map(len, found))
    for name, title in found.items():
        print(f"{name:<{width}}  {title}")


@app.command
def check(file: Annotated[str, FILE], /) -> None:
    """Check a file and tell how the linkage or tool is built up, or what a study will compute.

    Parameters
    ----------
    file
        Path of a model file or a study file, or the name of a bundled example.
    """
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.model import Machine
    from equipoise.schema.models import load

    found = load(file)
    if isinstance(found, Tool):
        from equipoise.terminal.check_tool import print_check_of_tool

        print_check_of_tool(found, file)
        return
    with naming(file):
        if isinstance(found, Machine):
            from equipoise.terminal.check import print_check

            print_check(found)
        else:
            from equipoise.schema.study_units import units_of
            from equipoise.terminal.check_study import print_check_of_study

            print_check_of_study(found, units_of(found), file)


@app.command
def schema(*, tool: bool = False, study: bool = False) -> None:
    """Print the JSON Schema of the model file, for editors.

    Parameters
    ----------
    tool
        That of the file of a hand-held tool.
    study
        That of the study file.
    """
    import json

    from equipoise.schema.models import json_schema

    print(json.dumps(json_schema(_kind(tool, study)), indent=2))


@app.command
def new(
    file: Annotated[str | None, FILE] = None, /, *, tool: bool = False, study: bool = False
) -> None:
    """Write a commented model file to start from.

    Parameters
    ----------
    file
        Where to write it, machine.toml if not given; a file that is there already is left alone.
    tool
        That of a hand-held tool, not of a linkage.
    study
        That of a study of many designs; study.toml if no name is given.
    """
    from importlib.resources import files

    from equipoise.schema.output import write

    name, usual, command = STARTS[_kind(tool, study)]
    start = files("equipoise").joinpath("schema", name).read_text(encoding="utf-8")
    path = usual if file is None else file
    write(path, start, replace=False)
    print(f"wrote {path}; next: {command.format(path)}", file=sys.stderr)


def _kind(tool: bool, study: bool) -> str:
    if tool and study:
        raise UsageError("--tool and --study are two kinds of files; give one of them")
    return "tool" if tool else "study" if study else "linkage"
