"""Load tables: CSV files of force or torque against crank angle, with units in the header.

::

    crank_angle [deg],force_x [N],force_y [N]
    0,0,-12.5
    10,0,-13
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator
from math import isfinite
from pathlib import Path

from equipoise.errors import ModelError, UsageError
from equipoise.io import units
from equipoise.io.files import FileError, printable, read_text
from equipoise.mechanism.model import LoadTable

COLUMNS: dict[str, units.Dimension] = {
    "crank_angle": "angle",
    "force_x": "force",
    "force_y": "force",
    "torque": "torque",
}
_FORMS = (("crank_angle", "force_x", "force_y"), ("crank_angle", "torque"))
_RIGHT = "the header is crank_angle [deg],force_x [N],force_y [N] or crank_angle [deg],torque [N m]"


def read_table(file: str, folder: Path) -> LoadTable:
    """Read a load table.

    Parameters
    ----------
    file : its name, relative to `folder`.
    folder : that of the model file.

    Raises
    ------
    ModelError
        Names the table's file, line and column; `where` is empty.
    """
    try:
        text = read_text(folder / file)
    except FileError as problem:
        raise ModelError("", f"{printable(file)}: {problem}") from problem
    try:
        return parse_table(text, file)
    except ModelError as error:
        raise ModelError("", f"{printable(file)}, {error.what}") from error


def parse_table(text: str, file: str = "") -> LoadTable:
    """Read the text of a load table; errors begin with the number of the line."""
    rows = _rows(text)
    number, header = next(rows, (1, []))
    names, unit_of = _header(number, header)
    columns: list[list[float]] = [[] for _ in names]
    lines = []
    for number, row in rows:
        if len(row) != len(names):
            raise ModelError(
                "", f"line {number}: got {len(row)} values; the header has {len(names)} columns"
            )
        for name, unit, cell, column in zip(names, unit_of, row, columns, strict=True):
            column.append(_value(number, name, unit, cell))
        lines.append(number)
    if not columns[0]:
        raise ModelError(
            "", f"line {number}: there are no rows below the header; give at least one"
        )
    by_name = dict(zip(names, map(tuple, columns), strict=True))
    angles = by_name.pop("crank_angle")
    _check_rising(angles, lines)
    return LoadTable(angles, tuple(by_name[key] for key in COLUMNS if key in by_name), file)


def format_table(table: LoadTable) -> str:
    """Write a load table as CSV such that reading it gives exactly the same numbers."""
    names = _FORMS[0] if len(table.values) == 2 else _FORMS[1]
    degrees = [units.format_exact(angle, "angle").split(" ", 1) for angle in table.crank_angle]
    if all(unit == "deg" for _, unit in degrees):
        unit, angles = "deg", [number for number, _ in degrees]
    else:
        unit, angles = "rad", [repr(float(angle)) for angle in table.crank_angle]
    unit_of = [unit, *(units.KINDS[COLUMNS[name]].units[0] for name in names[1:])]
    lines = [",".join(f"{name} [{unit}]" for name, unit in zip(names, unit_of, strict=True))]
    for angle, *values in zip(angles, *table.values, strict=True):
        lines.append(",".join([angle, *(repr(float(value)) for value in values)]))
    return "\n".join(lines) + "\n"


def _rows(text: str) -> Iterator[tuple[int, list[str]]]:
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


def _header(line: int, cells: list[str]) -> tuple[list[str], list[str]]:
    names, unit_of = [], []
    for cell in cells:
        match = re.fullmatch(r"(\w+)\s*\[([^\]]*)\]", cell)
        name = match[1] if match else cell
        if name not in COLUMNS:
            raise ModelError("", f"line {line}: got the column {_cut(cell)}; {_RIGHT}")
        if match is None:
            unit = units.KINDS[COLUMNS[name]].units[0]
            raise ModelError(
                "", f"line {line}, column {name}: the unit is missing; {name} [{unit}]"
            )
        if name in names:
            raise ModelError("", f"line {line}, column {name}: given twice; {_RIGHT}")
        _value(line, name, match[2], "0")  # a wrong unit is the header's fault, not the row's
        names.append(name)
        unit_of.append(match[2])
    if not any(sorted(names) == sorted(form) for form in _FORMS):
        given = ", ".join(names) or "no column"
        raise ModelError("", f"line {line}: got {given}; {_RIGHT}")
    return names, unit_of


def _value(line: int, name: str, unit: str, cell: str) -> float:
    try:
        return units.parse(f"{cell} {unit}", COLUMNS[name])
    except UsageError as error:
        where = f"line {line}, column {name}"
        if not _is_number(cell):
            raise ModelError(
                "", f"{where}: got {_cut(cell)}; give a finite number with a decimal point"
            ) from error
        raise ModelError("", f"{where}: {error}") from error


def _is_number(cell: str) -> bool:
    try:
        return isfinite(float(cell)) and cell.isascii() and "_" not in cell
    except ValueError:
        return False


def _cut(cell: str) -> str:
    return repr(cell if len(cell) <= 60 else f"{cell[:57]}...")


def _check_rising(angles: tuple[float, ...], lines: list[int]) -> None:
    for line, before, after in zip(lines[1:], angles, angles[1:], strict=False):
        if after <= before:
            raise ModelError(
                "", f"line {line}, column crank_angle: the angles must rise from row to row"
            )
