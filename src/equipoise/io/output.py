"""Result files: an analysis as JSON text or CSV."""

from __future__ import annotations

import csv
import io
import json
import os
from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.io.files import FileError, printable, write_text
from equipoise.results import Analysis, columns, to_dict, unit_of


def to_json(analysis: Analysis, split: bool = False) -> str:
    """The machine-readable output as one JSON object, in SI units; `split` as in `to_dict`."""
    return json.dumps(to_dict(analysis, split), default=_plain, allow_nan=False)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no place in the output")


def to_csv(analysis: Analysis) -> str:
    """Every array against crank angle, one row a crank angle; units stand in the header."""
    named = [("crank_angle", analysis.crank_angle), *columns(analysis)]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([f"{name} [{unit_of(name)}]" for name, _ in named])
    writer.writerows(np.column_stack([values for _, values in named]).tolist())
    return text.getvalue()


def write(path: str | os.PathLike[str], text: str, *, replace: bool = True) -> None:
    """Write a result file, whole or not at all.

    Raises
    ------
    UsageError : it cannot be written, or is there already and `replace` is false.
    """
    shown = printable(path) or "''"
    if not replace and os.path.lexists(path):
        raise UsageError(f"{shown}: is there already; choose another name")
    try:
        write_text(path, text)
    except FileError as problem:
        raise UsageError(f"{shown}: {problem}") from problem
