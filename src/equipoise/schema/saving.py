"""Writing machines and tools as files, and what lies in files of its own beside them."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from equipoise.errors import ModelError
from equipoise.keys import Frozen
from equipoise.mechanism.model import Machine
from equipoise.quantities import format_exact
from equipoise.schema.files import write_beside
from equipoise.schema.models import loads_linkage
from equipoise.schema.numbers import format_share
from equipoise.schema.opening import bundled, opened_example
from equipoise.schema.writing import Writer, beside, toml_text

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool


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


def _limit_table(machine: Machine, limit: Any) -> dict[str, Any]:
    from equipoise.mechanism.objectives import quantity_of

    if limit.ratio is not None:
        at_most = format_share(limit.ratio)
    else:
        quantity = quantity_of(limit.objective, machine)
        assert quantity is not None
        at_most = format_exact(limit.at_most, quantity)
    return {"objective": limit.objective, "at_most": at_most}


def dumped(model: Machine | Tool) -> str:
    """The text of a file that names those which its model came from.

    Raises
    ------
    ModelError : something has no file name, or a section has what no file can tell.
    """
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


def save_model(model: Machine | Tool, path: Path) -> None:
    """Write a file and those beside it, the model file last; errors as `text_of`."""
    parts = parts_of(model)
    text = text_of(model, {part.where: part.name_beside(path) for part in parts})
    for part, file in _written(parts, path):
        if isinstance(part.value, Machine):
            save_model(part.value, file)
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
