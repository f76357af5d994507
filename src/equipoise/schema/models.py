"""Files of linkages, tools and studies: reading, writing, the bundled examples, the JSON Schema."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from equipoise.errors import ModelError, UsageError
from equipoise.keys import Frozen
from equipoise.mechanism.model import Machine
from equipoise.quantities import format_exact, parse
from equipoise.schema.files import printable, write_beside
from equipoise.schema.numbers import format_share, parse_share
from equipoise.schema.objects import Context
from equipoise.schema.opening import (
    Beside,
    FileKind,
    Opened,
    bundled,
    content_of,
    kind_of,
    kind_of_text,
    opened,
    opened_example,
)
from equipoise.schema.reading import read_table
from equipoise.schema.writing import Writer, beside, toml_text

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.studies.study import Study

__all__ = ["dumps", "examples", "json_schema", "load", "load_linkage", "load_tool", "loads",
           "loads_linkage", "loads_tool", "save"]  # fmt: skip

Folder = str | os.PathLike[str] | None


def load(path_or_name: str | os.PathLike[str]) -> Any:
    """Read a file of any kind, or a bundled example by its name.

    Parameters
    ----------
    path_or_name : path of a TOML file; if there is none of that name, a name from `examples`.

    Returns
    -------
    Machine, Tool or Study
        In SI units and radians.  What tells no kind is read as the file of a linkage.

    Raises
    ------
    ModelError
        One sentence: file, table and key, what was given and what would be right.
    """
    return _loaded(opened(path_or_name))


def loads(text: str, source: str = "<text>", folder: Folder = None) -> Any:
    """Read the text of a file of any kind, as `load`.

    Parameters
    ----------
    text : TOML.
    source : name for it in errors.
    folder : where what it names is; without it tables are refused, and only bundled models found.
    """
    return _loaded(Opened(text, source, None if folder is None else Path(folder)))


def _loaded(file: Opened) -> Machine | Tool | Study:
    kind = kind_of_text(file.text)
    if kind == "study":
        from equipoise.schema.studies import study_in

        return study_in(file)
    read = loads_tool if kind == "tool" else loads_linkage
    return read(file.text, file.source, file.folder)


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


def _limit_table(machine: Machine, limit: Any) -> dict[str, Any]:
    from equipoise.mechanism.objectives import quantity_of

    if limit.ratio is not None:
        at_most = format_share(limit.ratio)
    else:
        quantity = quantity_of(limit.objective, machine)
        assert quantity is not None
        at_most = format_exact(limit.at_most, quantity)
    return {"objective": limit.objective, "at_most": at_most}


# -- writing ---------------------------------------------------------------------------------------


def text_of(model: Machine | Tool, names: Mapping[str, str]) -> str:
    """The text of a file; `names` are those of other files, by the key that names each.

    Raises
    ------
    ModelError : a tool has what no file can tell.
    """
    makers: dict[type[Frozen], Callable[[Any], dict[str, Any]]] = {}
    if isinstance(model, Machine) and model.balance is not None:
        from equipoise.mechanism.balance import Limit

        makers[Limit] = partial(_limit_table, model)
    content = Writer(names, makers).content(type(model), model)
    return toml_text(type(model), content)


def dumps(model: Machine | Tool | Study) -> str:
    """Write a machine, tool or study as the text of its file; reading it gives an equal one.

    Tables and linkages in files of their own are named, not written: `save` writes them too.

    Raises
    ------
    ModelError
        Something has no file name, or a section has what no file can tell.
    """
    if not isinstance(model, Frozen):
        from equipoise.schema.studies import study_text

        return study_text(model)
    parts = parts_of(model)
    noun = "machine" if isinstance(model, Machine) else "tool"
    for part in parts:
        if not part.file:
            table = "the table has" if noun == "machine" else "has"
            raise ModelError(part.where, f"{table} no file; save the {noun} instead")
        if not part.kept and part.sort == "linkage" and part.file in bundled():
            raise ModelError(
                part.where,
                f"is not that of the example {part.file!r} any more; save the tool instead",
            )
    return text_of(model, {part.where: part.file for part in parts})


def save(model: Machine | Tool | Study, path: str | os.PathLike[str]) -> None:
    """Write a machine, tool or study as its file, and what lies in files of its own beside it.

    Those are called ``<stem>.load-<n>.csv``, ``<stem>.soil.csv``, ``<stem>.motor.csv``,
    ``<stem>.linkage-<n>.toml`` and ``<stem>.impedance-<n>.csv``; a linkage that is a bundled
    example keeps its name.  Each file is afterwards either the old or the new one, never half of
    it; the model file comes last, so that it never names a file that is not there.

    Raises
    ------
    UsageError
        The file cannot be written; says why.
    ModelError
        A section has what no file can tell.
    """
    path = Path(path)
    if not isinstance(model, Frozen):
        write_beside(path, dumps(model))
        return
    parts = parts_of(model)
    text = text_of(model, {part.where: part.name_beside(path) for part in parts})
    for part, file in _written(parts, path):
        if isinstance(part.value, Machine):
            save(part.value, file)
        else:
            write_beside(file, _table_text(part.value))
    write_beside(path, text)


def files_of(model: Machine | Tool, path: str | os.PathLike[str]) -> list[Path]:
    """Every file that `save` would write, the model file first."""
    found = [Path(path)]
    for part, file in _written(parts_of(model), Path(path)):
        found += files_of(part.value, file) if isinstance(part.value, Machine) else [file]
    return found


@dataclass(frozen=True)
class Part:
    """A table or linkage that has a file of its own.

    where : key that names the file.
    sort : ``load``, ``soil``, ``motor``, ``impedance`` or ``linkage``.
    file : name of the one that it came from.
    number : in the name of a new one; 0 for none.
    """

    where: str
    sort: str
    value: Any
    file: str
    number: int = 0

    @cached_property
    def kept(self) -> str:
        """Name of the bundled example that it is, or nothing."""
        if self.sort != "linkage" or self.file not in bundled():
            return ""
        example = opened_example(self.file)
        same = loads_linkage(example.text, example.source, example.folder) == self.value
        return self.file if same else ""

    def name_beside(self, path: Path) -> str:
        """Name of its file for a model that is saved at a path."""
        if self.kept and not os.path.lexists(path.with_name(self.kept)):
            return self.kept
        suffix = "toml" if self.sort == "linkage" else "csv"
        number = f"-{self.number}" if self.number else ""
        return f"{path.stem}.{self.sort}{number}.{suffix}"


def parts_of(model: Machine | Tool) -> list[Part]:
    """Tables and linkages of a model that have files of their own."""
    parts: list[Part] = []
    for where, sort, value, file in beside(type(model), model):
        number = len(parts) + 1
        if sort in {"load", "linkage"}:  # numbered as in the file
            number = int(where[where.index("[") + 1 : where.index("]")])
        parts.append(Part(where, sort, value, file, 0 if sort in {"soil", "motor"} else number))
    return parts


def _written(parts: list[Part], path: Path) -> list[tuple[Part, Path]]:
    """The parts that are written beside a model, each with its path."""
    named = ((part, part.name_beside(path)) for part in parts)
    return [(part, path.with_name(name)) for part, name in named if name != part.kept]


def _table_text(table: Any) -> str:
    from equipoise.schema import tables

    impedance = type(table).__name__ == "Impedance"
    return tables.format_impedance(table) if impedance else tables.format_table(table)


# -- examples and schema ---------------------------------------------------------------------------


def examples(kind: FileKind | None = None) -> dict[str, str]:
    """Names of the bundled files of linkages, tools and studies, each with its title.

    kind : ``linkage``, ``tool`` or ``study``, for those of one kind only.
    """
    contents = {
        name: tomllib.loads(file.read_text(encoding="utf-8")) for name, file in bundled().items()
    }
    return {
        name: str(content["title"])
        for name, content in contents.items()
        if kind in {None, kind_of(content)}
    }


def json_schema(kind: FileKind = "linkage") -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the file of a linkage, tool or study, for editors."""
    from equipoise.schema.schemas import schema_of

    return schema_of(kind)
