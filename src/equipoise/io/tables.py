"""Tables of loads, of soil and of a motor: CSV files with units in the header.

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

from equipoise.errors import ModelError, UsageError
from equipoise.io import units
from equipoise.io.files import FileError, printable, read_text
from equipoise.mechanism.field import SoilTable
from equipoise.mechanism.model import LoadTable
from equipoise.mechanism.motor import MotorTable

COLUMNS: dict[str, units.Dimension] = {
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
}
COLUMN_UNITS = {"crank_angle": "deg", "force_x": "N", "force_y": "N", "torque": "N m"} | {
    "depth": "mm",
    "resistance": "N",
    "speed": "rpm",
    "time": "s",
    "displacement": "mm",
    "angle": "deg",
}
"""Units that a header is shown with."""
Forms = tuple[tuple[str, ...], ...]
_LOAD: Forms = (("crank_angle", "force_x", "force_y"), ("crank_angle", "torque"))
_SOIL: Forms = (("depth", "resistance"),)
_MOTOR: Forms = (("speed", "torque"),)
"""Columns of each kind of table; the first must rise from row to row."""


def _right(forms: Forms) -> str:
    headers = [",".join(f"{name} [{COLUMN_UNITS[name]}]" for name in form) for form in forms]
    return f"the header is {' or '.join(headers)}"


def read_load(file: str, folder: Path) -> LoadTable:
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
    columns = _read(file, folder, _LOAD)
    return _load_table(columns, file)


def read_soil(file: str, folder: Path) -> SoilTable:
    """Read a table of the soil's resistance against depth; as `read_load`."""
    columns = _read(file, folder, _SOIL)
    return SoilTable(columns["depth"], columns["resistance"], file)


def read_motor(file: str, folder: Path) -> MotorTable:
    """Read a table of a motor's torque against its speed; as `read_load`."""
    columns = _read(file, folder, _MOTOR)
    return MotorTable(columns["speed"], columns["torque"], file)


def parse_load(text: str, file: str = "") -> LoadTable:
    """Read the text of a load table; errors begin with the number of the line."""
    return _load_table(_columns(text, _LOAD), file)


def _load_table(columns: dict[str, tuple[float, ...]], file: str) -> LoadTable:
    angles = columns.pop("crank_angle")
    return LoadTable(angles, tuple(columns[key] for key in COLUMNS if key in columns), file)


def _read(file: str, folder: Path, forms: Forms) -> dict[str, tuple[float, ...]]:
    try:
        text = read_text(folder / file)
    except FileError as problem:
        raise ModelError("", f"{printable(file)}: {problem}") from problem
    try:
        return _columns(text, forms)
    except ModelError as error:
        raise ModelError("", f"{printable(file)}, {error.what}") from error


def _columns(text: str, forms: Forms) -> dict[str, tuple[float, ...]]:
    """Columns of a table by name, in SI units and radians."""
    rows = _rows(text)
    number, header = next(rows, (1, []))
    names, unit_of = _header(number, header, forms)
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
    _check_rising(forms[0][0], by_name[forms[0][0]], lines)
    return by_name


def format_table(table: LoadTable | SoilTable | MotorTable) -> str:
    """Write any table as CSV such that reading it gives exactly the same numbers."""
    if isinstance(table, LoadTable):
        return format_load(table)
    return format_soil(table) if isinstance(table, SoilTable) else format_motor(table)


def format_load(table: LoadTable) -> str:
    """Write a load table as CSV such that reading it gives exactly the same numbers."""
    names = _LOAD[0] if len(table.values) == 2 else _LOAD[1]
    unit, angles = _handy(table.crank_angle, "angle", "deg", "rad")
    unit_of = [unit, *(units.KINDS[COLUMNS[name]].units[0] for name in names[1:])]
    return _csv(names, unit_of, [angles, *(map(repr, column) for column in table.values)])


def format_soil(table: SoilTable) -> str:
    """Write a table of soil as CSV such that reading it gives exactly the same numbers."""
    return _csv(_SOIL[0], ["m", "N"], [map(repr, table.depth), map(repr, table.resistance)])


def format_motor(table: MotorTable) -> str:
    """Write a table of a motor as CSV such that reading it gives exactly the same numbers."""
    unit, speeds = _handy(table.speed, "angular speed", "rpm", "rad/s")
    return _csv(_MOTOR[0], [unit, "N m"], [speeds, map(repr, table.torque)])


def _handy(
    values: Iterable[float], dimension: units.Dimension, usual: str, si: str
) -> tuple[str, list[str]]:
    """A unit and the numbers of a column in it: the usual one if it is exact for all of them."""
    texts = [units.format_exact(value, dimension).split(" ", 1) for value in values]
    if all(unit == usual for _, unit in texts):
        return usual, [number for number, _ in texts]
    return si, [repr(float(value)) for value in values]


def _csv(names: Iterable[str], unit_of: Iterable[str], columns: Iterable[Iterable[str]]) -> str:
    lines = [",".join(f"{name} [{unit}]" for name, unit in zip(names, unit_of, strict=True))]
    lines += map(",".join, zip(*columns, strict=True))
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


def _header(line: int, cells: list[str], forms: Forms) -> tuple[list[str], list[str]]:
    names, unit_of = [], []
    for cell in cells:
        match = re.fullmatch(r"(\w+)\s*\[([^\]]*)\]", cell)
        name = match[1] if match else cell
        if not any(name in form for form in forms):
            raise ModelError("", f"line {line}: got the column {_cut(cell)}; {_right(forms)}")
        if match is None:
            unit = units.KINDS[COLUMNS[name]].units[0]
            raise ModelError(
                "", f"line {line}, column {name}: the unit is missing; {name} [{unit}]"
            )
        if name in names:
            raise ModelError("", f"line {line}, column {name}: given twice; {_right(forms)}")
        _value(line, name, match[2], "0")  # a wrong unit is the header's fault, not the row's
        names.append(name)
        unit_of.append(match[2])
    if not any(sorted(names) == sorted(form) for form in forms):
        given = ", ".join(names) or "no column"
        raise ModelError("", f"line {line}: got {given}; {_right(forms)}")
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


def _check_rising(name: str, values: tuple[float, ...], lines: list[int]) -> None:
    what = "angles" if COLUMNS[name] == "angle" else f"{name}s"
    for line, before, after in zip(lines[1:], values, values[1:], strict=False):
        if after <= before:
            raise ModelError(
                "", f"line {line}, column {name}: the {what} must rise from row to row"
            )
