"""Model files: reading, writing, the bundled examples and the JSON Schema.

pydantic is imported when the first file is read, not before.
"""

from __future__ import annotations

import os
import re
import tomllib
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from equipoise.errors import ModelError, UsageError
from equipoise.io import SCHEMA_VERSION
from equipoise.io.files import LARGEST, FileError, printable, read_text, write_text
from equipoise.mechanism.field import SoilTable
from equipoise.mechanism.model import LoadTable, Machine, unknown
from equipoise.mechanism.motor import MotorTable

__all__ = ["dumps", "examples", "json_schema", "load", "loads", "save"]

# tomllib takes a time that grows with the square of the number of parts of a dotted key: half a
# minute for forty thousand.  No key of a model file has more than five.
_ENDLESS_KEY = re.compile(r"""(?<![\w-])(?:["']?[\w-]++["']?[ \t]*+\.[ \t]*+){50}""")


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
    try:
        name = os.fspath(path_or_name)
    except TypeError:
        raise UsageError(f"got {path_or_name!r}; give a path, or the name of an example") from None
    if not os.path.isfile(name) and name in (bundled := _bundled()):
        example = bundled[name]
        folder = example.parent if isinstance(example, Path) else None
        return loads(example.read_text(encoding="utf-8"), example.name, folder)
    source = printable(name) or "''"
    try:
        text = read_text(name)
    except FileError as problem:
        what = str(problem)
        if not os.path.lexists(name) and isinstance(problem.__cause__, FileNotFoundError):
            what = f"{what}; {_known_examples(name)}"
        raise ModelError("", what, source) from problem
    return loads(text, source, Path(name).parent)


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
    from equipoise.io.writing import document_of, toml_text

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
    from equipoise.io.tables import format_table
    from equipoise.io.writing import document_of, toml_text

    path = Path(path)
    tables = tables_of(machine)
    names = _names(machine, path)
    text = toml_text(document_of(machine, names))
    for where, table in tables.items():
        _write(path.with_name(names[where]), format_table(table))
    _write(path, text)


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


def examples() -> dict[str, str]:
    """Names of the bundled model files, each with its title."""
    return {
        name: str(tomllib.loads(file.read_text(encoding="utf-8"))["title"])
        for name, file in _bundled().items()
    }


def json_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the model file, for editors."""
    from equipoise.io.schema import json_schema

    return json_schema()


# -- reading ---------------------------------------------------------------------------------------


def _machine(text: str, folder: Path | None) -> Machine:
    content = toml_content(text)

    from pydantic import ValidationError

    from equipoise.io.beside import Beside
    from equipoise.io.document import Document
    from equipoise.io.problems import translated

    try:
        document = Document.model_validate(content)
    except ValidationError as error:
        raise translated(error) from error
    return document.to_machine(Beside(folder))


def toml_content(text: str) -> dict[str, Any]:
    """Content of a file that begins with the version of its schema.

    Raises
    ------
    ModelError : it is no TOML, or of another version.
    """
    content = _toml(text)
    _check_version(content)
    return content


def _toml(text: str) -> dict[str, Any]:
    if len(text) > LARGEST:
        raise ModelError("", f"the text is longer than {LARGEST / 1e6:.0f} MB; give a model file")
    if endless := _ENDLESS_KEY.search(text):
        line = text.count("\n", 0, endless.start()) + 1
        raise ModelError("", f"line {line}: a key has more than 50 parts; model files need five")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ModelError("", _syntax(str(error))) from error
    except RecursionError as error:
        raise ModelError("", "lists or tables are nested too deeply for a model file") from error
    except ValueError as error:  # an integer of thousands of digits
        raise ModelError("", "a number has thousands of digits; give a usual one") from error


def _syntax(message: str) -> str:
    """Put the place in front of tomllib's message."""
    found = re.fullmatch(r"(.*) \(at (.*)\)", message, re.DOTALL)
    what, where = found.groups() if found else (message, "")
    what = "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in what)
    what = what if len(what) <= 200 else f"{what[:197]}..."
    if what.startswith(("Cannot overwrite", "Cannot declare", "Cannot mutate")):
        what += ", a key or table is given twice"
    return f"{where}: {what[:1].lower()}{what[1:]}; give valid TOML".removeprefix(": ")


def _check_version(content: dict[str, Any]) -> None:
    if "schema" not in content:
        raise ModelError(
            "schema", f"missing; begin the file with schema = {SCHEMA_VERSION} (all tables after)"
        )
    given = content["schema"]
    if type(given) is not int or given != SCHEMA_VERSION:
        from equipoise.io.unit_problems import described

        raise ModelError(
            "schema", f"got {described(given)}; this program reads schema = {SCHEMA_VERSION}"
        )


def _bundled() -> dict[str, Traversable]:
    folder = files("equipoise").joinpath("examples")
    if not folder.is_dir():
        return {}
    found = [file for file in folder.iterdir() if file.name.endswith(".toml")]
    return {file.name.removesuffix(".toml"): file for file in sorted(found, key=lambda f: f.name)}


def _known_examples(name: str) -> str:
    bare = os.path.basename(name).removesuffix(".toml")
    hint = unknown(printable(bare), _bundled(), "example").split("; ")[-1]
    near = f"{hint} or " if hint.startswith("did") else ""
    return f"{near}give a path, or the name of an example: run `equipoise examples`"


def _write(path: Path, text: str) -> None:
    try:
        write_text(path, text)
    except FileError as problem:
        raise UsageError(f"{printable(path)}: {problem}") from problem
