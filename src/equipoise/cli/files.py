"""Commands about files: `examples`, `check`, `schema`, `new`; `serve`; `completion` for shells."""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator
from typing import Annotated, Literal

from cyclopts import Parameter

from equipoise.cli.models import AnyFile
from equipoise.cli.options import count, error_in_file
from equipoise.cli.outputs import Shown, check_model_name, wrote
from equipoise.cli.runner import CommandResult, command
from equipoise.errors import UsageError
from equipoise.i18n import Note, say

STARTS = {
    # kind of file: text to start from, usual name, what comes next
    "linkage": ("start.toml", "machine.toml", "equipoise analyze {}"),
    "tool": ("start-tool.toml", "machine.toml", "equipoise tool {}"),
    "study": ("start-study.toml", "study.toml", "equipoise sweep {} -o designs.zarr"),
}


@command()
def examples() -> CommandResult:
    """List the bundled models and studies; their names can stand for FILE and STUDY everywhere."""
    from equipoise.results.blocks import Table
    from equipoise.schema import open_files

    return CommandResult(lambda: [Table.of("", ("", ""), open_files.examples().items())], title="")


@command(Shown)
def check(file: AnyFile, /) -> CommandResult:
    """Check a file, and describe the structure of the machine or the computations of a study."""
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.present import checks
    from equipoise.results.blocks import Block
    from equipoise.schema.documents import load
    from equipoise.schema.files import printable

    result = load(file)

    def blocks() -> Iterator[Block]:
        if isinstance(result, Tool):
            return checks.tool_blocks(result, printable(file))
        if isinstance(result, Machine):
            return checks.machine_blocks(result)
        from equipoise.present.checks import study_blocks
        from equipoise.schema.study_units import units_of

        return study_blocks(result, units_of(result), file)

    return CommandResult(blocks, owner=result)


@command()
def schema(*, tool: bool = False, study: bool = False) -> CommandResult:
    """Print the JSON Schema of the model file, for editors.

    Parameters
    ----------
    tool
        Schema of the file of a hand-held tool.
    study
        Schema of the study file.
    """
    import json

    from equipoise.schema.schemas import json_schema

    kind = _kind(tool, study)
    return CommandResult(lines=lambda: json.dumps(json_schema(kind), indent=2).splitlines())


@command(tool=False)
def completion(
    shell: Annotated[Literal["bash", "zsh", "fish", "powershell"], Parameter(name="SHELL")], /
) -> CommandResult:
    """Print a completion script for a shell.

    Parameters
    ----------
    shell
        Name of the shell; bash reads the script from
        ~/.local/share/bash-completion/completions/equipoise, fish from
        ~/.config/fish/completions/equipoise.fish, zsh as _equipoise from a folder of its fpath.
    """
    from equipoise.cli import app

    script = app.generate_completion(shell=shell)
    return CommandResult(lines=lambda: script.split("\n"))


@command()
def new(
    file: Annotated[str | None, Parameter(name="FILE")] = None,
    /,
    *,
    tool: bool = False,
    study: bool = False,
) -> CommandResult:
    """Write a commented model file to start from.

    Parameters
    ----------
    file
        File to write.  Default: machine.toml.  An existing file is not overwritten.
    tool
        Write the model of a hand-held tool instead of a linkage.
    study
        Write a study of many designs; default name: study.toml.
    """
    from importlib.resources import files

    from equipoise.schema.files import write

    name, usual, first = STARTS[_kind(tool, study)]
    start = files("equipoise").joinpath("schema", name).read_text(encoding="utf-8")
    path = usual if file is None else file
    check_model_name(path, "FILE")
    write(path, start, replace=False)
    return CommandResult(
        save=lambda: [wrote(path + say("; next: {command}", command=first.format(path)))]
    )


def _kind(tool: bool, study: bool) -> Literal["linkage", "tool", "study"]:
    if tool and study:
        raise UsageError(Note("--tool and --study are two kinds of files; give one of them"))
    return "tool" if tool else "study" if study else "linkage"


def serve(
    file: Annotated[str | None, Parameter(name="FILE")] = None,
    /,
    *,
    port: Annotated[int | None, count(0, 65535)] = None,
    no_browser: bool = False,
) -> None:
    """Open the live page in the browser, to animate, drag and change a linkage.

    The server runs until Ctrl+C and accepts connections from this computer only.

    Parameters
    ----------
    file
        Path of a model file or of a store of a study, or the name of a bundled example.  Default:
        choose one on the page.
    port
        Port of the server.  Default: 8471, or any free port.
    no_browser
        Print the address without opening a browser.
    """
    from equipoise.web import server
    from equipoise.web.desk import begun

    with error_in_file(file or ""):  # errors of a file are reported before a page is opened
        begin = begun(file)

    def announce(address: str) -> None:
        print(address, flush=True)
        print("press Ctrl+C to end", file=sys.stderr)
        if not no_browser:
            import webbrowser

            webbrowser.open(address)

    gc.freeze()
    server.serve(begin, port, announce)
