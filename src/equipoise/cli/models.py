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
    """Check a model file and tell how the linkage is built up.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example.
    """
    from equipoise.io.models import load
    from equipoise.terminal.check import print_check

    machine = load(file)
    with naming(file):
        print_check(machine)


@app.command
def schema() -> None:
    """Print the JSON Schema of the model file, for editors."""
    import json

    from equipoise.io.models import json_schema

    print(json.dumps(json_schema(), indent=2))


@app.command
def new(file: Annotated[str, FILE] = "machine.toml", /) -> None:
    """Write a commented model file to start from.

    Parameters
    ----------
    file
        Where to write it; a file that is there already is left alone.
    """
    from importlib.resources import files

    from equipoise.io.output import write

    start = files("equipoise").joinpath("io", "start.toml").read_text(encoding="utf-8")
    write(file, start, replace=False)
    print(f"wrote {file}; next: equipoise analyze {file}", file=sys.stderr)
