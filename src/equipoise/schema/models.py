"""Files of linkages and tools, with the tables and linkages that lie in files beside them."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, ModelError, UsageError, at_place
from equipoise.i18n import Note
from equipoise.keys import Frozen
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.shown_units import PARAMETERS, amounts_of, units_of
from equipoise.quantities import format_exact, parse, showing_by_default
from equipoise.schema.files import printable, write
from equipoise.schema.numbers import format_share, parse_share
from equipoise.schema.open_files import (
    FolderPath,
    Opened,
    bundled,
    content_of,
    in_file,
    opened,
    opened_beside,
    opened_example,
)
from equipoise.schema.reading import Context, read_table
from equipoise.schema.writing import WorkedOut, Writer, file_tables, toml_text

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool


def load_linkage(path_or_name: str | os.PathLike[str]) -> Machine:
    """Read the file of a linkage and of nothing else, or a bundled example; as `load`."""
    return loads_linkage(*opened(path_or_name))


def loads_linkage(text: str, source: str = "<text>", folder: FolderPath = None) -> Machine:
    """Read the text of the file of a linkage and of nothing else; as `loads`."""
    with in_file(source):
        return machine_of(content_of(text, "linkage"), AdjacentFiles(folder))


def load_tool(path_or_name: str | os.PathLike[str]) -> Tool:
    """Read the file of a tool and of nothing else, or a bundled example; as `load`."""
    return loads_tool(*opened(path_or_name))


def loads_tool(text: str, source: str = "<text>", folder: FolderPath = None) -> Tool:
    """Read the text of a tool's file and of nothing else; as `loads`."""
    with in_file(source):
        return tool_of(content_of(text, "tool"), AdjacentFiles(folder))


# -- content ---------------------------------------------------------------------------------------


def machine_of(content: Mapping[str, Any], reader: AdjacentFiles) -> Machine:
    """The machine of the content of a file; `reader` gets its tables by their files' names.

    The table [balance] is read when the machine is there, which has the dimensions of
    outputs; few files have it, and its modules take time to import.
    """
    balance = content.get("balance")
    rest = {name: value for name, value in content.items() if name != "balance"}
    context = Context(reader.read, names=amounts_of(content.get(PARAMETERS, {})))
    machine: Machine = read_table(Machine, rest, context)
    if balance is not None:
        machine = _with_balance(machine, balance, context)
    if not context.expressions:
        return machine
    return machine.with_expressions(
        {str(at): expression for at, expression in context.expressions.items()}
    )


def _with_balance(machine: Machine, balance: Any, context: Context) -> Machine:
    from equipoise.mechanism.parts.balance import Balance, Limit

    of_balance = replace(context, makers={Limit: partial(_limit, machine)})
    plan = read_table(Balance, balance, of_balance, KeyPath(("balance",)))
    with of_balance.with_written():
        return machine.with_balance(plan)


def tool_of(content: Mapping[str, Any], reader: AdjacentFiles) -> Tool:
    """The tool of the content of a file; `reader` gets its tables and linkages."""
    from equipoise.handheld.model import Tool

    tool: Tool = read_table(Tool, content, Context(reader.read))
    return tool


def _limit(machine: Machine, given: dict[str, Any]) -> Any:
    """A limit of an output, whose text is a share or in a unit of what the output is."""
    from equipoise.mechanism.parts.balance import Limit, quantity_of, wrong_limit

    objective, asks = given["objective"], {**given}
    del asks["objective"]
    for key, text in asks.items():
        try:
            share = parse_share(text) if key == "at_most" else None
            if share is not None:
                return Limit(objective, ratio=share)
            # The unit follows only from an output that exists.
            for wrong in wrong_limit("", Limit(objective, asks=((key, 1.0),)), machine):
                raise ModelError(wrong.where.removeprefix("."), wrong.what)
            quantity = quantity_of(objective, machine)
            assert quantity is not None
            asks[key] = parse(text, quantity)
        except UsageError as error:
            raise ModelError(key, error.note) from error
    return Limit(objective, **asks)


# -- what lies beside -----------------------------------------------------------------------------


class AdjacentFiles:
    """Reads tables by the names of their files, which are relative to the model file's folder.

    folder : None where the model did not come from a file; then every table is refused.
    """

    def __init__(self, folder: FolderPath) -> None:
        self.folder = None if folder is None else Path(folder)

    def read(self, sort: str, file: str) -> Any:
        """What lies in a file, of a sort such as ``load``."""
        if sort == "linkage":
            return self.linkage(file)
        if self.folder is None:
            raise ModelError(
                "",
                Note(
                    "got {given!r}; a table can only be read beside a file", given=printable(file)
                ),
            )
        from equipoise.schema.tables import read_beside

        return read_beside(sort, file, self.folder)

    def linkage(self, file: str) -> Machine:
        """The linkage of another model file, or a bundled one; it has masses and turns fully."""
        from equipoise.mechanism.assembly.linkage import assemble
        from equipoise.mechanism.dynamics.forces import massless

        result = self._opened(file)
        try:
            machine = loads_linkage(result.text, printable(file), result.folder)
        except ModelError as error:  # which names its file
            raise ModelError("", error.note) from error  # lines would be for the other file
        try:
            _ = assemble(machine).cycle
        except EquipoiseError as error:
            raise ModelError("", at_place(printable(file), error.note)) from error
        if lacking := massless(machine):
            raise ModelError("", at_place(printable(file), lacking))
        return machine

    def _opened(self, file: str) -> Opened:
        """The model file of a linkage, of which one beside goes before a bundled one."""
        if self.folder is None:
            if file in bundled():
                return opened_example(file)
            raise ModelError(
                "",
                Note(
                    "got {given!r}; without a file beside which to look, give the name of an "
                    "example",
                    given=printable(file),
                ),
            )
        try:
            return opened_beside(file, self.folder)
        except ModelError as error:
            raise ModelError("", at_place(printable(file), error.what)) from error


class HeldFiles(AdjacentFiles):
    """Reads what lies beside a file out of what is held already, by sort and name; of no disk.

    tables : those that there are.  texts : of CSV files that are given now, by name.
    """

    def __init__(self, tables: Mapping[tuple[str, str], Any], texts: Mapping[str, str]) -> None:
        super().__init__(None)
        self.tables, self.texts = tables, texts

    def read(self, sort: str, file: str) -> Any:
        from equipoise.schema.tables import parse_table

        if file in self.texts:
            return parse_table(sort, self.texts[file], file)
        if (sort, file) not in self.tables:
            raise ModelError(
                "",
                Note(
                    "got {file!r}, which is not known here; choose that file, or drop it together "
                    "with the model",
                    file=printable(file),
                ),
            )
        return self.tables[sort, file]


# -- writing ---------------------------------------------------------------------------------------


def text_of(model: Machine | Tool, names: Mapping[str, str]) -> str:
    """The text of a file; as `plain_of`."""
    return toml_text(type(model), plain_of(model, names))


def plain_of(model: Machine | Tool, names: Mapping[str, str]) -> dict[str, Any]:
    """The content of a file; `names` are those of other files, by the key that names each.

    Raises
    ------
    ModelError : a tool has what no file can represent.
    """
    makers: dict[type[Frozen], Callable[[Any], dict[str, Any]]] = {}
    if isinstance(model, Machine) and model.balance is not None:
        from equipoise.mechanism.parts.balance import Limit

        makers[Limit] = partial(_limit_table, model)
    with showing_by_default(units_of(model)):
        return Writer(names, makers, _worked_out(model)).content(type(model), model)


def _worked_out(model: Machine | Tool) -> WorkedOut:
    """The expressions of a machine whose numbers are what they give."""
    if not isinstance(model, Machine) or not model.expressions:
        return WorkedOut()
    return WorkedOut(model.expressions, amounts_of(model.parameters))


def _limit_table(machine: Machine, limit: Any) -> dict[str, Any]:
    from equipoise.mechanism.parts.balance import quantity_of

    if limit.ratio is not None:
        return {"objective": limit.objective, "at_most": format_share(limit.ratio)}
    quantity = quantity_of(limit.objective, machine)
    assert quantity is not None
    asks = {key: format_exact(value, quantity) for key, value in limit.asks}
    return {"objective": limit.objective, **asks}


def dumped(model: Machine | Tool) -> str:
    """The text of a file that names those which its model came from.

    Raises
    ------
    ModelError : something has no file name, or a section has what no file can represent.
    """
    parts = parts_of(model)
    of_tool = not isinstance(model, Machine)
    for part in parts:
        if not part.file:
            raise ModelError(
                part.where,
                Note("has no file; save the tool instead")
                if of_tool
                else Note("the table has no file; save the machine instead"),
            )
        if not part.bundled_name and part.sort == "linkage" and part.file in bundled():
            raise ModelError(
                part.where,
                Note(
                    "is not that of the example {file!r} any more; save the tool instead",
                    file=part.file,
                ),
            )
    return text_of(model, {part.where: part.file for part in parts})


def taken_along(model: Machine | Tool, name: str) -> tuple[str, dict[str, str]]:
    """The text of a file that is taken anywhere, and those of the tables it names, by their names.

    name : of the file, after which tables are called that have no name, or that of another one.

    Raises
    ------
    ModelError : a linkage of a tool has no file, or a section has what no file can represent.
    """
    from equipoise.schema.tables import format_table

    parts = parts_of(model)
    if any(part.sort == "linkage" for part in parts):
        _ = dumped(model)
    names: dict[str, str] = {}
    texts: dict[str, str] = {}
    for part in parts:
        names[part.where] = part.file
        if part.sort != "linkage":
            text, own = format_table(part.value), Path(part.file).name
            if not own or texts.get(own, text) != text:
                own = part.name_beside(Path(name))
            names[part.where], texts[own] = own, text
    return text_of(model, names), texts


def save_model(model: Machine | Tool, path: Path) -> None:
    """Write a file and those beside it, the model file last; errors as `text_of`."""
    parts = parts_of(model)
    text = text_of(model, {part.where: part.name_beside(path) for part in parts})
    for part, file in _written(parts, path):
        if isinstance(part.value, Machine):
            save_model(part.value, file)
        else:
            from equipoise.schema.tables import format_table

            write(file, format_table(part.value))
    write(path, text)


def files_of(model: Machine | Tool, path: str | os.PathLike[str]) -> list[Path]:
    """Every file that `save` would write, the model file first."""
    paths = [Path(path)]
    for part, file in _written(parts_of(model), Path(path)):
        paths += files_of(part.value, file) if isinstance(part.value, Machine) else [file]
    return paths


@dataclass(frozen=True)
class ModelPart:
    """A table or linkage that has a file of its own.

    where : key that names the file.
    sort : of `tables.TABLES`, or ``linkage``.
    file : name of the one that it came from.
    number : in the name of a new one; 0 for none.
    """

    where: str
    sort: str
    value: Any
    file: str
    number: int = 0

    @cached_property
    def bundled_name(self) -> str:
        """Name of the bundled example that it is, or nothing."""
        if self.sort != "linkage" or self.file not in bundled():
            return ""
        return self.file if loads_linkage(*opened_example(self.file)) == self.value else ""

    def name_beside(self, path: Path) -> str:
        """Name of its file for a model that is saved at a path."""
        if self.bundled_name and not os.path.lexists(path.with_name(self.bundled_name)):
            return self.bundled_name
        suffix = "toml" if self.sort == "linkage" else "csv"
        number = f"-{self.number}" if self.number else ""
        return f"{path.stem}.{self.sort}{number}.{suffix}"


def parts_of(model: Machine | Tool) -> list[ModelPart]:
    """Tables and linkages of a model that have files of their own."""
    parts: list[ModelPart] = []
    for where, sort, value, file in file_tables(type(model), model):
        number = len(parts) + 1
        if sort in {"load", "linkage"}:  # numbered as in the file
            number = int(where[where.index("[") + 1 : where.index("]")])
        parts.append(
            ModelPart(where, sort, value, file, 0 if sort in {"soil", "motor"} else number)
        )
    return parts


def _written(parts: list[ModelPart], path: Path) -> list[tuple[ModelPart, Path]]:
    """The parts that are written beside a model, each with its path."""
    named = ((part, part.name_beside(path)) for part in parts)
    return [(part, path.with_name(name)) for part, name in named if name != part.bundled_name]
