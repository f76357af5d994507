"""Recorded decays: CSV files of time and displacement, or angle, with units in the header.

::

    time [s],displacement [mm]
    0,41.2
    0.002,41.1

A record may have a million rows, so its columns are read as a whole; cell by cell, as a table of
loads is, only where something is wrong, to tell the place.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from equipoise.errors import ModelError, UsageError
from equipoise.io import tables
from equipoise.io.files import FileError, printable, read_text
from equipoise.io.unit_factors import FACTORS
from equipoise.io.unit_lists import plain_unit
from equipoise.measured.record import Record
from equipoise.mechanism.checks import HUGE, TINY

Array = np.ndarray[Any, Any]

LARGEST = 100_000_000
"""Bytes: some millions of rows."""
_RECORD: tables.Forms = (("time", "displacement"), ("time", "angle"))


def read_record(path: str | os.PathLike[str]) -> Record:
    """Read a recorded decay from a CSV file.

    Raises
    ------
    ModelError
        One sentence: file, line and column, what was given and what would be right.
    """
    shown = printable(path) or "''"
    try:
        return parse_record(read_text(path, LARGEST))
    except FileError as problem:
        raise ModelError("", f"{shown}: {problem}") from problem
    except UsageError as error:
        raise ModelError("", f"{shown}: {error}") from error
    except ModelError as error:
        raise ModelError("", f"{shown}, {error.what}") from error


def parse_record(text: str) -> Record:
    """Read the text of a recorded decay; errors begin with the number of the line."""
    columns = _columns_at_once(text)
    if columns is None:
        slow = tables._columns(text, _RECORD)
        columns = {name: np.array(column) for name, column in slow.items()}
    time = columns.pop("time")
    ((name, displacement),) = columns.items()
    return Record(time, displacement, "angle" if name == "angle" else "length")


def _columns_at_once(text: str) -> dict[str, Array] | None:
    """Columns by name in SI units; None where a row or cell is not what it should be."""
    rows = tables._rows(text)
    number, header = next(rows, (1, []))
    names, unit_of = tables._header(number, header, _RECORD)
    if not text.isascii() or "_" in text:  # Python reads such numbers, but they are none here
        return None
    cells = [row for _, row in rows]
    if not cells or any(len(row) != len(names) for row in cells):
        return None
    try:
        values = np.array([[float(cell) for cell in row] for row in cells])
    except ValueError:
        return None
    values *= [float(FACTORS[plain_unit(unit)]) for unit in unit_of]
    sizes = np.abs(values)
    if not np.all((sizes <= HUGE) & ((sizes >= TINY) | (sizes == 0))):
        return None
    columns = dict(zip(names, values.T.copy(), strict=True))
    return columns if np.all(np.diff(columns["time"]) > 0) else None
