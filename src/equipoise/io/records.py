"""Recorded decays: CSV files of time and displacement, or angle, with units in the header.

::

    time [s],displacement [mm]
    0,41.2
    0.002,41.1
"""

from __future__ import annotations

import os

from equipoise.errors import ModelError, UsageError
from equipoise.schema.csv_columns import Forms, arrays_of
from equipoise.schema.files import FileError, printable, read_text
from equipoise.measured.record import Record

LARGEST = 100_000_000
"""Bytes: some millions of rows."""
_RECORD: Forms = (("time", "displacement"), ("time", "angle"))


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
    columns = arrays_of(text, _RECORD)
    time = columns.pop("time")
    ((name, displacement),) = columns.items()
    return Record(time, displacement, "angle" if name == "angle" else "length")
