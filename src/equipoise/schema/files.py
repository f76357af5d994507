"""Reading and writing whole files, with every mishap as one sentence; results as JSON and CSV."""

from __future__ import annotations

import csv
import io
import json
import os
import stat
from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from equipoise.atomic_files import make_folder, replaced
from equipoise.errors import UsageError, at_place
from equipoise.fence import OutsideError, holding, may_be_replaced, open_file
from equipoise.folders import reason
from equipoise.i18n import Note
from equipoise.quantities import column_heading

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis

LARGEST = 2_000_000
"""Bytes; no model file or load table comes near it."""


class FileError(Exception):
    """A file cannot be read or written; `note` says why and what would be right."""

    def __init__(self, note: Note) -> None:
        super().__init__(note)
        self.note = note


Name = str | os.PathLike[str]


def read_text(path: Name, largest: int = LARGEST, *, within: Name | None = None) -> str:
    """Read a regular file of UTF-8 text, with or without a byte order mark.

    largest : bytes that are read at most.
    within : folder out of which no link may lead, where a file in it has named this one.

    Raises
    ------
    FileError
        Missing, no regular file (a pipe would wait for ever), too large, not UTF-8.
    """
    data = read_bytes(path, largest, within=within)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise FileError(
            Note("line {line} is not text in UTF-8; give a text file saved as UTF-8", line=line)
        ) from error


def read_bytes(path: Name, largest: int = LARGEST, *, within: Name | None = None) -> bytes:
    """Read a regular file as it is; arguments and errors as of `read_text`."""
    try:
        return _bytes(open_file(path, within), largest)
    except OutsideError as error:
        raise FileError(error.note) from error
    except FileNotFoundError as error:
        raise FileError(Note("there is no such file")) from error
    except PermissionError as error:
        raise FileError(Note("the file may not be read; change its permissions")) from error
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        raise FileError(Note("the file cannot be read ({reason})", reason=reason(error))) from error


def _bytes(descriptor: int, largest: int) -> bytes:
    if stat.S_ISDIR(os.fstat(descriptor).st_mode):  # Python would refuse it, and leave it open
        os.close(descriptor)
        raise FileError(Note("this is a directory; give a file"))
    with open(descriptor, "rb") as file:
        status = os.fstat(file.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise FileError(Note("this is no regular file; give a file on disk"))
        data = b"" if status.st_size > largest else file.read(largest + 1)
        if max(status.st_size, len(data)) > largest:
            size = max(status.st_size, len(data)) / 1e6
            raise FileError(
                Note(
                    "the file has {size:.0f} MB; at most {largest:.0f} MB are read",
                    size=size,
                    largest=largest / 1e6,
                )
            )
    return data


def write(path: Name, text: str | bytes, *, replace: bool = True, links: bool = True) -> None:
    """Write a file, text as UTF-8; it is afterwards the old or the new one, never half of it.

    links : whether links are followed, a last one within its folder; else the path is absolute.

    Raises
    ------
    UsageError : it cannot be written, or is there already and `replace` is false.
    """
    place = printable(path) or "''"
    if not (replace or may_be_replaced()) and os.path.lexists(path):
        raise UsageError(at_place(place, Note("is there already; choose another name")))
    data = text if isinstance(text, bytes) else text.encode("utf-8")
    try:
        target = Path(path)
        if target.exists() and not target.is_file():  # the file would take the place of a device
            kind = Note("a directory") if target.is_dir() else Note("no regular file")
            raise UsageError(
                at_place(place, Note("this is {kind}; give the name of a file", kind=kind))
            )
        with replaced(path, links=links) as file:
            file.write(data)
    except (OSError, ValueError) as error:
        raise UsageError(
            at_place(
                place,
                Note(
                    "the file cannot be written ({reason}); choose another place or name",
                    reason=reason(error),
                ),
            )
        ) from error


def write_all(folder: Name, files: Mapping[str, bytes]) -> None:
    """Write files into a folder, which is made where it is not there; each whole or not at all.

    The folder is opened once: all go into the same, whatever is put in its place meanwhile.

    Raises
    ------
    UsageError : they cannot be written.
    """
    with holding():
        _make(folder)
        for name, data in files.items():
            write(Path(folder) / name, data)


def _make(folder: Name) -> None:
    try:
        make_folder(folder)
    except FileExistsError as error:
        place = printable(folder)
        raise UsageError(
            at_place(place, Note("this is a file; give the name of a folder"))
        ) from error
    except (OSError, ValueError) as error:
        what = Note("the folder cannot be made ({reason})", reason=reason(error))
        raise UsageError(
            at_place(
                printable(folder), Note("{sentence}; choose another place or name", sentence=what)
            )
        ) from error


def printable(path: Name) -> str:
    """Return a path as text that any terminal can print."""
    text = os.fspath(path).encode("utf-8", "backslashreplace").decode("utf-8")
    text = text if len(text) <= 300 else f"{text[:147]}...{text[-150:]}"
    return "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in text)


# -- results ---------------------------------------------------------------------------------------


def json_text(values: dict[str, Any]) -> str:
    """Nested values with NumPy arrays as one JSON object.

    Raises
    ------
    UsageError : one of them is not finite, for which JSON has no word.
    """
    try:
        return json.dumps(values, default=_plain, allow_nan=False)
    except ValueError as error:
        where = next(_endless(values, ""), "a figure")
        raise UsageError(
            at_place(
                where,
                Note(
                    "is beyond all numbers; sizes in the file are too far apart to be "
                    "computed with, check its lengths, masses, stiffnesses and speeds"
                ),
            )
        ) from error


def _endless(value: Any, where: str) -> Iterator[str]:
    """Names of the figures that are not finite."""
    if isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _endless(inner, f"{where}.{name}" if where else str(name))
    elif isinstance(value, list | tuple):
        for number, inner in enumerate(value, 1):
            yield from _endless(inner, f"{where}[{number}]")
    elif hasattr(value, "tolist"):
        yield from _endless(value.tolist(), where)
    elif isinstance(value, float) and not isfinite(value):
        yield where


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):  # an array of NumPy, or one of its numbers
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no place in the output")


def to_csv(analysis: Analysis, outputs: Iterable[str] = ()) -> str:
    """Every array against crank angle, one row a crank angle; units stand in the header.

    outputs : names of the outputs to write instead.
    """
    ones = analysis.outputs.chosen(outputs) or analysis.outputs.arrays
    values = [(item.name, item.unit, item.values) for item in ones]
    return csv_text([("crank_angle", "rad", analysis.crank_angle), *values])


def csv_text(table: Sequence[tuple[str, str, Any]]) -> str:
    """Columns, as name, unit and values (N,), as the text of a CSV file."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([column_heading(name, unit) for name, unit, _ in table])
    writer.writerows(zip(*(values.tolist() for _, _, values in table), strict=True))
    return text.getvalue()
