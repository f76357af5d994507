"""Model files: reading, writing, the bundled examples and the JSON Schema.

pydantic is imported when the first file is read, not before.
"""

from __future__ import annotations

import os
import re
import tomllib
from pathlib import Path
from typing import Any

from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.field import SoilTable
from equipoise.mechanism.force_elements import MotorTable
from equipoise.mechanism.model import LoadTable, Machine
from equipoise.schema.files import FileError, printable, write_text
from equipoise.schema.opening import FileKind, bundled, content_of, kind_of, opened


def load(path_or_name: str | os.PathLike[str]) -> Machine:
    """Read a model file, or a bundled example by its name.

    Parameters
    ----------
    path_or_name : path of a TOML file; if there is none of that name, a name from `examples`.

    Returns
    -------
    Machine
        In SI units and radians.

    Raises
    ------
    ModelError
        One sentence: file, table and key, what was given and what would be right.
    """
    file = opened(path_or_name)
    return loads(file.text, file.source, file.folder)


def loads(
    text: str, source: str = "<text>", folder: str | os.PathLike[str] | None = None
) -> Machine:
    """Read the text of a model file.

    Parameters
    ----------
    text : TOML.
    source : name for it in errors.
    folder : where its tables are; without it they are refused.

    Raises
    ------
    ModelError
        As in `load`.
    """
    try:
        return _machine(text, None if folder is None else Path(folder))
    except ModelError as error:
        raise ModelError(printable(error.where), error.what, source) from error


def dumps(machine: Machine) -> str:
    """Write a machine as the text of a model file; `loads` of it gives an equal machine.

    Tables of loads, soil and motor are named, not written: `save` writes them too.

    Raises
    ------
    ModelError
        A table has no file name.
    """
    from equipoise.schema.old_writing import document_of, toml_text

    tables = tables_of(machine)
    for where, table in tables.items():
        if not table.file:
            raise ModelError(where, "the table has no file; save the machine instead")
    return toml_text(document_of(machine, {where: table.file for where, table in tables.items()}))


def save(machine: Machine, path: str | os.PathLike[str]) -> None:
    """Write a machine as a model file, and its tables as CSV files beside it.

    Those of loads, soil and motor are called ``<stem>.load-<n>.csv``, ``<stem>.soil.csv`` and
    ``<stem>.motor.csv``.  Each file is afterwards either the old or the new one, never half of it;
    the model file comes last, so that it never names a table that is not there.

    Raises
    ------
    UsageError
        The file cannot be written; says why.
    """
    from equipoise.schema.old_writing import document_of, toml_text
    from equipoise.schema.tables import format_table

    path = Path(path)
    tables = tables_of(machine)
    names = _names(machine, path)
    text = toml_text(document_of(machine, names))
    for where, table in tables.items():
        write_beside(path.with_name(names[where]), format_table(table))
    write_beside(path, text)


def files_of(machine: Machine, path: str | os.PathLike[str]) -> list[Path]:
    """Every file that `save` would write, the model file first."""
    path = Path(path)
    return [path, *(path.with_name(name) for name in _names(machine, path).values())]


def _names(machine: Machine, path: Path) -> dict[str, str]:
    return {where: f"{path.stem}.{_part_of_name(where)}.csv" for where in tables_of(machine)}


def tables_of(machine: Machine) -> dict[str, LoadTable | SoilTable | MotorTable]:
    """Tables of a machine by the key that names them."""
    tables: dict[str, LoadTable | SoilTable | MotorTable] = {
        f"loads[{number}].table": load.table
        for number, load in enumerate(machine.loads, 1)
        if load.table is not None
    }
    planting = machine.planting
    if planting is not None and planting.soil is not None and planting.soil.table is not None:
        tables["planting.soil.table"] = planting.soil.table
    motor = machine.drive.motor
    if motor is not None and motor.table is not None:
        tables["drive.motor.table"] = motor.table
    return tables


def _part_of_name(where: str) -> str:
    number = re.search("[0-9]+", where)
    return f"load-{number[0]}" if number else where.split(".")[1]


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


def json_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the model file, for editors."""
    from equipoise.schema.schema import json_schema

    return json_schema()


# -- reading ---------------------------------------------------------------------------------------


def _machine(text: str, folder: Path | None) -> Machine:
    content = content_of(text, "linkage")

    from equipoise.schema.document import Document
    from equipoise.schema.opening import Beside
    from equipoise.schema.problems import validated

    return validated(Document, content).to_machine(Beside(folder))


def write_beside(path: Path, text: str) -> None:
    """Write a file; a `UsageError` says why it cannot be written."""
    try:
        write_text(path, text)
    except FileError as problem:
        raise UsageError(f"{printable(path)}: {problem}") from problem
