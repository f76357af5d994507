"""Model files: reading, writing, the bundled examples and the JSON Schema.

pydantic is imported when the first file is read, not before.
"""

from __future__ import annotations

import os
import re
import tomllib
from functools import partial
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from equipoise.errors import ModelError, UsageError
from equipoise.io import SCHEMA_VERSION
from equipoise.io.files import LARGEST, FileError, printable, read_text, write_text
from equipoise.mechanism.model import LoadTable, Machine, unknown

__all__ = ["dumps", "examples", "json_schema", "load", "loads", "save"]

# tomllib takes a time that grows with the square of the number of parts of a dotted key: half a
# minute for forty thousand.  No key of a model file has more than four.
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
    folder : where its load tables are; without it they are refused.

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

    Load tables are named, not written: `save` writes them too.

    Raises
    ------
    ModelError
        A load table has no file name.
    """
    from equipoise.io.writing import document_of, toml_text

    for number, load in enumerate(machine.loads, 1):
        if load.table is not None and not load.table.file:
            raise ModelError(
                f"loads[{number}].table", "the table has no file; save the machine instead"
            )
    names = [None if load.table is None else load.table.file for load in machine.loads]
    return toml_text(document_of(machine, names))


def save(machine: Machine, path: str | os.PathLike[str]) -> None:
    """Write a machine as a model file, and its load tables as ``<stem>.load-<n>.csv`` beside it.

    Each file is afterwards either the old or the new one, never half of it; the model file comes
    last, so that it never names a table that is not there.

    Raises
    ------
    UsageError
        The file cannot be written; says why.
    """
    from equipoise.io.tables import format_table
    from equipoise.io.writing import document_of, toml_text

    path = Path(path)
    names: list[str | None] = []
    for number, load in enumerate(machine.loads, 1):
        names.append(None if load.table is None else f"{path.stem}.load-{number}.csv")
    text = toml_text(document_of(machine, names))
    for name, load in zip(names, machine.loads, strict=True):
        if name is not None and load.table is not None:
            _write(path.with_name(name), format_table(load.table))
    _write(path, text)


def examples() -> dict[str, str]:
    """Names of the bundled model files, each with its title."""
    return {
        name: str(tomllib.loads(file.read_text(encoding="utf-8"))["title"])
        for name, file in _bundled().items()
    }


def json_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the model file, for editors."""
    from equipoise.io.document import json_schema

    return json_schema()


# -- reading ---------------------------------------------------------------------------------------


def _machine(text: str, folder: Path | None) -> Machine:
    content = _toml(text)
    _check_version(content)

    from pydantic import ValidationError

    from equipoise.io.document import Document
    from equipoise.io.problems import translated

    try:
        document = Document.model_validate(content)
    except ValidationError as error:
        raise translated(error) from error
    return document.to_machine(partial(_table, folder=folder))


def _toml(text: str) -> dict[str, Any]:
    if len(text) > LARGEST:
        raise ModelError("", f"the text is longer than {LARGEST / 1e6:.0f} MB; give a model file")
    if endless := _ENDLESS_KEY.search(text):
        line = text.count("\n", 0, endless.start()) + 1
        raise ModelError("", f"line {line}: a key has more than 50 parts; model files need four")
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


def _table(file: str, folder: Path | None) -> LoadTable:
    from equipoise.io.tables import read_table

    if folder is None:
        raise ModelError("", f"got {printable(file)!r}; a table can only be read beside a file")
    return read_table(file, folder)


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
