"""Columns of CSV files with units in the header: reading, writing, and what is wrong with them.

::

    crank_angle [deg],force_x [N],force_y [N]
    0,0,-12.5
    10,0,-13
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Iterator
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from equipoise import quantities
from equipoise.errors import ModelError, UsageError
from equipoise.quantities import FACTORS, HUGE, TINY, plain_unit
from equipoise.schema.files import FileError, printable, read_text

if TYPE_CHECKING:
    import numpy as np

Array: TypeAlias = "np.ndarray[Any, Any]"

COLUMNS: dict[str, quantities.Dimension] = {
    "crank_angle": "angle",
    "force_x": "force",
    "force_y": "force",
    "torque": "torque",
    "depth": "length",
    "resistance": "force",
    "speed": "angular speed",
    "time": "time",
    "displacement": "length",
    "angle": "angle",
    "frequency": "frequency",
    "x": "acceleration",
    "y": "acceleration",
    "z": "acceleration",
    "acceleration": "acceleration",
    "duration": "time",
    "reactance": "damping",
    "magnitude": "damping",
    "phase": "angle",
}
COLUMN_UNITS = {"crank_angle": "deg", "force_x": "N", "force_y": "N", "torque": "N m"} | {
    "depth": "mm",
    "resistance": "N",
    "speed": "rpm",
    "time": "s",
    "displacement": "mm",
    "angle": "deg",
    "frequency": "Hz",
    "x": "m/s^2",
    "y": "m/s^2",
    "z": "m/s^2",
    "acceleration": "m/s^2",
    "duration": "h",
    "reactance": "N s/m",
    "magnitude": "N s/m",
    "phase": "deg",
}
"""Units that a header is shown with."""
Forms = tuple[tuple[str, ...], ...]
"""Columns of each form of a table; the first must rise from row to row."""
OTHERWISE: dict[tuple[str, str], tuple[quantities.Dimension, str]] = {
    ("frequency", "resistance"): ("damping", "N s/m"),
}
"""Columns that are something else in a table with that first column."""


def _sort(name: str, forms: Forms) -> tuple[quantities.Dimension, str]:
    """Dimension of a column, and the unit that it is shown with."""
    first = forms[0][0] if forms else ""
    return OTHERWISE.get((first, name)) or (COLUMNS[name], COLUMN_UNITS[name])


def told_forms(forms: Forms) -> str:
    """Say which headers would be right."""
    headers = [",".join(f"{name} [{_sort(name, forms)[1]}]" for name in form) for form in forms]
    return f"the header is {' or '.join(headers)}"


def read_columns(file: str, folder: Path, forms: Forms) -> dict[str, tuple[float, ...]]:
    """Read a table beside a model file; errors name its file, line and column."""
    try:
        text = read_text(folder / file)
    except FileError as problem:
        raise ModelError("", f"{printable(file)}: {problem}") from problem
    try:
        return columns_of(text, forms)
    except ModelError as error:
        raise ModelError("", f"{printable(file)}, {error.what}") from error


def columns_of(text: str, forms: Forms) -> dict[str, tuple[float, ...]]:
    """Columns of a table by name, in SI units and radians."""
    rows = rows_of(text)
    number, header = next(rows, (1, []))
    names, unit_of = header_of(number, header, forms)
    columns: list[list[float]] = [[] for _ in names]
    lines = []
    for number, row in rows:
        if len(row) != len(names):
            raise ModelError(
                "", f"line {number}: got {len(row)} values; the header has {len(names)} columns"
            )
        for name, unit, cell, column in zip(names, unit_of, row, columns, strict=True):
            column.append(value_of(number, name, unit, cell, forms))
        lines.append(number)
    if not columns[0]:
        raise ModelError(
            "", f"line {number}: there are no rows below the header; give at least one"
        )
    by_name = dict(zip(names, map(tuple, columns), strict=True))
    _check_rising(forms[0][0], by_name[forms[0][0]], lines)
    return by_name


def arrays_of(text: str, forms: Forms) -> dict[str, Array]:
    """The same as arrays (N,), for files of a million rows: cell by cell only to tell a mistake."""
    import numpy as np

    found = _whole(text, forms)
    if found is None:
        found = {name: np.array(column) for name, column in columns_of(text, forms).items()}
    return found


def _whole(text: str, forms: Forms) -> dict[str, Array] | None:
    """All columns together; None where a row or cell is not what it should be."""
    import numpy as np

    lines = rows_of(text)
    names, unit_of = header_of(*next(lines, (1, [])), forms)
    if not text.isascii() or "_" in text:  # Python reads such numbers, but they are none here
        return None
    cells = [row for _, row in lines]
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
    found = dict(zip(names, values.T.copy(), strict=True))
    return found if np.all(np.diff(found[forms[0][0]]) > 0) else None


def csv_text(names: Iterable[str], unit_of: Iterable[str], columns: Iterable[Iterable[str]]) -> str:
    """Text of a CSV file from names, units and columns of numbers as text."""
    lines = [",".join(f"{name} [{unit}]" for name, unit in zip(names, unit_of, strict=True))]
    lines += map(",".join, zip(*columns, strict=True))
    return "\n".join(lines) + "\n"


def rows_of(text: str) -> Iterator[tuple[int, list[str]]]:
    """Rows that are not blank, with the number of their line."""
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        for row in reader:
            cells = [cell.strip() for cell in row]
            if any(cells):
                yield reader.line_num, cells
    except csv.Error as error:
        raise ModelError(
            "", f"line {reader.line_num}: this is no table of comma-separated values ({error})"
        ) from error


def header_of(line: int, cells: list[str], forms: Forms) -> tuple[list[str], list[str]]:
    """Names and units of the columns; a wrong one is told with its line."""
    names, unit_of = [], []
    for cell in cells:
        match = re.fullmatch(r"(\w+)\s*\[([^\]]*)\]", cell)
        name = match[1] if match else cell
        if not any(name in form for form in forms):
            raise ModelError(
                "", f"line {line}: got the column {shortened(cell)}; {told_forms(forms)}"
            )
        if match is None:
            unit = quantities.KINDS[_sort(name, forms)[0]].si
            raise ModelError(
                "", f"line {line}, column {name}: the unit is missing; {name} [{unit}]"
            )
        if name in names:
            raise ModelError("", f"line {line}, column {name}: given twice; {told_forms(forms)}")
        # A wrong unit is the header's fault, not the row's.
        value_of(line, name, match[2], "0", forms)
        names.append(name)
        unit_of.append(match[2])
    if not any(sorted(names) == sorted(form) for form in forms):
        given = ", ".join(names) or "no column"
        raise ModelError("", f"line {line}: got {given}; {told_forms(forms)}")
    return names, unit_of


def value_of(line: int, name: str, unit: str, cell: str, forms: Forms = ()) -> float:
    """A cell in SI units."""
    try:
        return quantities.parse(f"{cell} {unit}", _sort(name, forms)[0])
    except UsageError as error:
        where = f"line {line}, column {name}"
        if not _is_number(cell):
            raise ModelError(
                "", f"{where}: got {shortened(cell)}; give a finite number with a decimal point"
            ) from error
        raise ModelError("", f"{where}: {error}") from error


def _is_number(cell: str) -> bool:
    try:
        return isfinite(float(cell)) and cell.isascii() and "_" not in cell
    except ValueError:
        return False


def shortened(cell: str) -> str:
    """A cell for an error, cut where it is endless."""
    return repr(cell if len(cell) <= 60 else f"{cell[:57]}...")


def _check_rising(name: str, values: tuple[float, ...], lines: list[int]) -> None:
    plural = {"angle": "angles", "frequency": "frequencies"}
    what = plural.get(COLUMNS[name], f"{name}s")
    for line, before, after in zip(lines[1:], values, values[1:], strict=False):
        if after <= before:
            raise ModelError(
                "", f"line {line}, column {name}: the {what} must rise from row to row"
            )
