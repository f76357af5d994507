"""Result files: JSON text, CSV, pictures."""

from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.results.analysis import Analysis
from equipoise.schema.files import FileError, make_folder, printable, write_bytes

Array = np.ndarray[Any, Any]


def json_text(values: dict[str, Any]) -> str:
    """Nested values with NumPy arrays as one JSON object."""
    return json.dumps(values, default=_plain, allow_nan=False)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no place in the output")


def to_csv(analysis: Analysis) -> str:
    """Every array against crank angle, one row a crank angle; units stand in the header."""
    told = [(one.name, one.unit, one.values) for one in analysis.outputs.arrays]
    return csv_text([("crank_angle", "rad", analysis.crank_angle), *told])


def csv_text(table: Sequence[tuple[str, str, Array]]) -> str:
    """Columns, as name, unit and values (N,), as the text of a CSV file."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([f"{name} [{unit}]" if unit else name for name, unit, _ in table])
    writer.writerows(zip(*(values.tolist() for _, _, values in table), strict=True))
    return text.getvalue()


def write(path: str | os.PathLike[str], text: str | bytes, *, replace: bool = True) -> None:
    """Write a result file, whole or not at all; text as UTF-8.

    Raises
    ------
    UsageError : it cannot be written, or is there already and `replace` is false.
    """
    shown = printable(path) or "''"
    if not replace and os.path.lexists(path):
        raise UsageError(f"{shown}: is there already; choose another name")
    try:
        write_bytes(path, text if isinstance(text, bytes) else text.encode("utf-8"))
    except FileError as problem:
        raise UsageError(f"{shown}: {problem}") from problem


def write_all(folder: str | os.PathLike[str], files: Mapping[str, bytes]) -> None:
    """Write files into a folder, which is made where it is not there; each whole or not at all.

    Raises
    ------
    UsageError : they cannot be written.
    """
    path = Path(folder)
    try:
        make_folder(path)
        for name, data in files.items():
            path = Path(folder) / name
            write_bytes(path, data)
    except FileError as problem:
        raise UsageError(f"{printable(path)}: {problem}") from problem
