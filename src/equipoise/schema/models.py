"""Reading the files of linkages and tools, with the tables and linkages that lie beside them."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.mechanism.model import Machine
from equipoise.quantities import parse
from equipoise.schema.files import printable
from equipoise.schema.numbers import parse_share
from equipoise.schema.objects import Context
from equipoise.schema.opening import Opened, bundled, content_of, opened, opened_example
from equipoise.schema.reading import read_table

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool

Folder = str | os.PathLike[str] | None


def load_linkage(path_or_name: str | os.PathLike[str]) -> Machine:
    """Read the file of a linkage and of nothing else, or a bundled example; as `load`."""
    file = opened(path_or_name)
    return loads_linkage(file.text, file.source, file.folder)


def loads_linkage(text: str, source: str = "<text>", folder: Folder = None) -> Machine:
    """Read the text of the file of a linkage and of nothing else; as `loads`."""
    machine: Machine = _in_file(
        source, lambda: machine_of(content_of(text, "linkage"), _beside(folder))
    )
    return machine


def load_tool(path_or_name: str | os.PathLike[str]) -> Tool:
    """Read the file of a tool and of nothing else, or a bundled example; as `load`."""
    file = opened(path_or_name)
    return loads_tool(file.text, file.source, file.folder)


def loads_tool(text: str, source: str = "<text>", folder: Folder = None) -> Tool:
    """Read the text of a tool's file and of nothing else; as `loads`."""
    tool: Tool = _in_file(source, lambda: tool_of(content_of(text, "tool"), _beside(folder)))
    return tool


def _beside(folder: Folder) -> Beside:
    return Beside(None if folder is None else Path(folder))


def _in_file(source: str, read: Callable[[], Any]) -> Any:
    try:
        return read()
    except ModelError as error:
        raise ModelError(printable(error.where), error.what, source) from error


# -- content ---------------------------------------------------------------------------------------


def machine_of(content: Mapping[str, Any], reader: Beside) -> Machine:
    """The machine of the content of a file; `reader` gets its tables by their files' names.

    The table [balance] is read when the machine is there, which tells what outputs are measured
    in; few files have it, and its modules take time to import.
    """
    balance = content.get("balance")
    rest = {name: value for name, value in content.items() if name != "balance"}
    machine: Machine = read_table(Machine, rest, Context(reader.read))
    if balance is None:
        return machine
    from equipoise.mechanism.balance import Balance, Limit

    context = Context(reader.read, {Limit: partial(_limit, machine)})
    return machine.with_balance(read_table(Balance, balance, context, ("balance",)))


def tool_of(content: Mapping[str, Any], reader: Beside) -> Tool:
    """The tool of the content of a file; `reader` gets its tables and linkages."""
    from equipoise.handheld.model import Tool

    tool: Tool = read_table(Tool, content, Context(reader.read))
    return tool


def _limit(machine: Machine, given: dict[str, Any]) -> Any:
    """A limit of an output, whose text is a share or in a unit of what the output is."""
    from equipoise.mechanism.balance import Limit
    from equipoise.mechanism.objectives import quantity_of, wrong_limit

    text, objective = given["at_most"], given["objective"]
    try:
        share = parse_share(text)
        if share is not None:
            return Limit(objective, ratio=share)
        # Only an output that there is tells what unit is wanted.
        for wrong in wrong_limit("", Limit(objective, at_most=1.0), machine):
            raise ModelError(wrong.where.removeprefix("."), wrong.what)
        quantity = quantity_of(objective, machine)
        assert quantity is not None
        return Limit(objective, at_most=parse(text, quantity))
    except UsageError as error:
        raise ModelError("at_most", str(error)) from error


# -- what lies beside -----------------------------------------------------------------------------


class Beside:
    """Reads tables by the names of their files, which are relative to the model file's folder.

    folder : None where the model did not come from a file; then every table is refused.
    """

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder

    def read(self, sort: str, file: str) -> Any:
        """What lies in a file, of a sort such as ``load``."""
        if sort == "linkage":
            return self.linkage(file)
        from equipoise.schema import tables

        read: Callable[[str, Path], Any] = getattr(tables, f"read_{sort}")
        return read(file, self._folder(file))

    def linkage(self, file: str) -> Machine:
        """The linkage of another model file, or a bundled one; it has masses and turns fully."""
        from equipoise.mechanism.dynamics import massless
        from equipoise.mechanism.linkage import assemble

        found = self._opened(file)
        try:
            machine = loads_linkage(found.text, folder=found.folder)
            _ = assemble(machine).cycle
        except EquipoiseError as error:
            where = f"{error.where}: " if isinstance(error, ModelError) and error.where else ""
            what = error.what if isinstance(error, ModelError) else str(error)
            raise ModelError("", f"{printable(file)}: {where}{what}") from error
        if lacking := massless(machine):
            raise ModelError("", f"{printable(file)}: {lacking}")
        return machine

    def _opened(self, file: str) -> Opened:
        """The model file of a linkage, of which one beside goes before a bundled one."""
        beside = self.folder is not None and os.path.isfile(self.folder / file)
        if not beside and file in bundled():
            return opened_example(file)
        if self.folder is None:
            raise ModelError(
                "",
                f"got {printable(file)!r}; without a file beside which to look, give the name of "
                "an example",
            )
        try:
            return opened(self.folder / file)
        except ModelError as error:
            raise ModelError("", f"{printable(file)}: {error.what}") from error

    def _folder(self, file: str) -> Path:
        if self.folder is None:
            raise ModelError("", f"got {printable(file)!r}; a table can only be read beside a file")
        return self.folder
