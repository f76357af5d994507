"""Files of hand-held tools: reading, writing and the JSON Schema; see `models` for linkages.

pydantic is imported when the first file is read, not before.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from equipoise.errors import ModelError
from equipoise.handheld.model import Impedance, Tool
from equipoise.mechanism.model import Machine
from equipoise.schema.files import printable
from equipoise.schema.models import files_of, loads, save, write_beside
from equipoise.schema.opening import (
    Beside,
    bundled,
    content_of,
    impedance_keys,
    kind_of_text,
    opened,
    opened_example,
)

if TYPE_CHECKING:
    from equipoise.studies.study import Study


def load_tool(path_or_name: str | os.PathLike[str]) -> Tool:
    """Read the file of a tool, or a bundled example by its name.

    Parameters
    ----------
    path_or_name : path of a TOML file; if there is none of that name, a name from `examples`.

    Raises
    ------
    ModelError
        One sentence: file, table and key, what was given and what would be right.
    """
    file = opened(path_or_name)
    return loads_tool(file.text, file.source, file.folder)


def loads_tool(
    text: str, source: str = "<text>", folder: str | os.PathLike[str] | None = None
) -> Tool:
    """Read the text of a tool's file.

    Parameters
    ----------
    text : TOML.
    source : name for it in errors.
    folder : where its tables and linkages are; without it only bundled linkages are found.

    Raises
    ------
    ModelError
        As in `load_tool`.
    """
    try:
        return _tool(text, None if folder is None else Path(folder))
    except ModelError as error:
        raise ModelError(printable(error.where), error.what, source) from error


def load_any(path_or_name: str | os.PathLike[str]) -> Machine | Tool | Study:
    """Read a file of any kind; what tells none is read as that of a linkage."""
    file = opened(path_or_name)
    kind = kind_of_text(file.text)
    if kind == "study":
        from equipoise.schema.studies import study_in

        return study_in(file)
    read = loads_tool if kind == "tool" else loads
    return read(file.text, file.source, file.folder)


def _tool(text: str, folder: Path | None) -> Tool:
    content = content_of(text, "tool")

    from equipoise.schema.document_tool import ToolDocument
    from equipoise.schema.problems import validated

    return validated(ToolDocument, content).to_tool(Beside(folder))


def tool_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the tool's file, for editors."""
    from equipoise.schema.schema import tool_schema

    return tool_schema()


# -- writing ---------------------------------------------------------------------------------------


def dumps_tool(tool: Tool) -> str:
    """Write a tool as the text of its file; `loads_tool` of it gives an equal tool.

    Linkages and tables of impedance are named, not written: `save_tool` writes them too.

    Raises
    ------
    ModelError
        A linkage or table has no file name, or a section has what no file can tell.
    """
    parts = parts_of(tool)
    for part in parts:
        if not part.file:
            raise ModelError(part.where, "has no file; save the tool instead")
        if not part.kept and part.kind == "linkage" and part.file in bundled():
            raise ModelError(
                part.where,
                f"is not that of the example {part.file!r} any more; save the tool instead",
            )
    return _text(tool, {part.where: part.file for part in parts})


def save_tool(tool: Tool, path: str | os.PathLike[str]) -> None:
    """Write a tool as its file, and its linkages and tables of impedance beside it.

    They are called ``<stem>.linkage-<n>.toml`` and ``<stem>.impedance-<n>.csv``; a linkage that is
    a bundled example keeps its name.  The tool's file comes last, so that it never names a file
    that is not there.

    Raises
    ------
    UsageError
        The file cannot be written; says why.
    ModelError
        A section has what no file can tell.
    """
    from equipoise.schema.tables import format_impedance

    path = Path(path)
    names = {part.where: part.name_beside(path) for part in parts_of(tool)}
    text = _text(tool, names)
    for part, beside in _written(tool, path):
        if isinstance(part.value, Machine):
            save(part.value, beside)
        else:
            write_beside(beside, format_impedance(part.value))
    write_beside(path, text)


def files_of_tool(tool: Tool, path: str | os.PathLike[str]) -> list[Path]:
    """Every file that `save_tool` would write, the tool's file first."""
    found = [Path(path)]
    for part, beside in _written(tool, Path(path)):
        value = part.value
        found += files_of(value, beside) if isinstance(value, Machine) else [beside]
    return found


@dataclass(frozen=True)
class Part:
    """A linkage or table of impedance, which has a file of its own.

    where : key that names the file.
    file : name of the one that it came from.
    number : in the name of a new one.
    """

    where: str
    kind: Literal["linkage", "impedance"]
    value: Machine | Impedance
    file: str
    number: int

    @cached_property
    def kept(self) -> str:
        """Name of the bundled example that it is, or nothing."""
        if self.kind != "linkage" or self.file not in bundled():
            return ""
        example = opened_example(self.file)
        same = loads(example.text, example.source, example.folder) == self.value
        return self.file if same else ""

    def name_beside(self, path: Path) -> str:
        """Name of its file for a tool that is saved at a path."""
        if self.kept and not os.path.lexists(path.with_name(self.kept)):
            return self.kept
        suffix = "toml" if self.kind == "linkage" else "csv"
        return f"{path.stem}.{self.kind}-{self.number}.{suffix}"


def parts_of(tool: Tool) -> list[Part]:
    """Linkages and tables of impedance of a tool."""
    parts: list[Part] = []
    for number, station in enumerate(tool.stations, 1):
        tables = () if station.hand is None else station.hand.impedance
        keys = impedance_keys(f"shaft.stations[{number}].hand", len(tables))
        for where, table in zip(keys, tables, strict=True):
            parts.append(Part(where, "impedance", table, table.file, len(parts) + 1))
    for number, excitation in enumerate(tool.excitations, 1):
        if excitation.linkage is not None:
            where = f"excitations[{number}].linkage"
            parts.append(Part(where, "linkage", excitation.linkage, excitation.file, number))
    return parts


def _written(tool: Tool, path: Path) -> list[tuple[Part, Path]]:
    """The parts that are written beside the tool, each with its path."""
    named = ((part, part.name_beside(path)) for part in parts_of(tool))
    return [(part, path.with_name(name)) for part, name in named if name != part.kept]


def _text(tool: Tool, names: dict[str, str]) -> str:
    from equipoise.schema.old_writing import toml_text
    from equipoise.schema.writing_tool import tool_document

    return toml_text(tool_document(tool, names))
