"""Tables of loads, of soil and of a motor: CSV files with units in the header.

::

    crank_angle [deg],force_x [N],force_y [N]
    0,0,-12.5
    10,0,-13
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from equipoise import quantities
from equipoise.handheld.model import Impedance
from equipoise.mechanism.field import SoilTable
from equipoise.mechanism.force_elements import MotorTable
from equipoise.mechanism.model import LoadTable
from equipoise.schema import csv_columns
from equipoise.schema.csv_columns import COLUMNS, Forms, columns_of, csv_text, read_columns
from equipoise.schema.places import from_polar

_LOAD: Forms = (("crank_angle", "force_x", "force_y"), ("crank_angle", "torque"))
_SOIL: Forms = (("depth", "resistance"),)
_MOTOR: Forms = (("speed", "torque"),)
"""Columns of each kind of table; the first must rise from row to row."""


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
    columns = read_columns(file, folder, _LOAD)
    return _load_table(columns, file)


def read_soil(file: str, folder: Path) -> SoilTable:
    """Read a table of the soil's resistance against depth; as `read_load`."""
    columns = read_columns(file, folder, _SOIL)
    return SoilTable(columns["depth"], columns["resistance"], file)


def read_motor(file: str, folder: Path) -> MotorTable:
    """Read a table of a motor's torque against its speed; as `read_load`."""
    columns = read_columns(file, folder, _MOTOR)
    return MotorTable(columns["speed"], columns["torque"], file)


def parse_load(text: str, file: str = "") -> LoadTable:
    """Read the text of a load table; errors begin with the number of the line."""
    return _load_table(columns_of(text, _LOAD), file)


def _load_table(columns: dict[str, tuple[float, ...]], file: str) -> LoadTable:
    angles = columns.pop("crank_angle")
    return LoadTable(angles, tuple(columns[key] for key in COLUMNS if key in columns), file)


def format_table(table: LoadTable | SoilTable | MotorTable) -> str:
    """Write any table as CSV such that reading it gives exactly the same numbers."""
    if isinstance(table, LoadTable):
        return format_load(table)
    return format_soil(table) if isinstance(table, SoilTable) else format_motor(table)


def format_load(table: LoadTable) -> str:
    """Write a load table as CSV such that reading it gives exactly the same numbers."""
    names = _LOAD[0] if len(table.values) == 2 else _LOAD[1]
    unit, angles = _handy(table.crank_angle, "angle", "deg", "rad")
    unit_of = [unit, *(quantities.KINDS[COLUMNS[name]].si for name in names[1:])]
    return csv_text(names, unit_of, [angles, *(map(repr, column) for column in table.values)])


def format_soil(table: SoilTable) -> str:
    """Write a table of soil as CSV such that reading it gives exactly the same numbers."""
    return csv_text(_SOIL[0], ["m", "N"], [map(repr, table.depth), map(repr, table.resistance)])


def format_motor(table: MotorTable) -> str:
    """Write a table of a motor as CSV such that reading it gives exactly the same numbers."""
    unit, speeds = _handy(table.speed, "angular speed", "rpm", "rad/s")
    return csv_text(_MOTOR[0], [unit, "N m"], [speeds, map(repr, table.torque)])


def _handy(
    values: Iterable[float], dimension: quantities.Dimension, usual: str, si: str
) -> tuple[str, list[str]]:
    """A unit and the numbers of a column in it: the usual one if it is exact for all of them."""
    texts = [quantities.format_exact(value, dimension).split(" ", 1) for value in values]
    if all(unit == usual for _, unit in texts):
        return usual, [number for number, _ in texts]
    return si, [repr(float(value)) for value in values]


_IMPEDANCE: csv_columns.Forms = (
    ("frequency", "resistance", "reactance"),
    ("frequency", "magnitude", "phase"),
)


def read_impedance(file: str, folder: Path) -> Impedance:
    """Read a table of impedance.

    Parameters
    ----------
    file : its name, relative to `folder`.
    folder : that of the tool's file.

    Raises
    ------
    ModelError
        Names the table's file, line and column; `where` is empty.
    """
    columns = csv_columns.read_columns(file, folder, _IMPEDANCE)
    frequency = columns["frequency"]
    if "magnitude" in columns:
        pairs = zip(columns["magnitude"], columns["phase"], strict=True)
        resistance, reactance = zip(*(from_polar(*pair) for pair in pairs), strict=True)
        return Impedance(frequency, resistance, reactance, file)
    return Impedance(frequency, columns["resistance"], columns["reactance"], file)


def format_impedance(table: Impedance) -> str:
    """Write a table of impedance as CSV such that reading it gives exactly the same numbers."""
    columns = (table.frequency, table.resistance, table.reactance)
    return csv_columns.csv_text(
        _IMPEDANCE[0], ["Hz", "N s/m", "N s/m"], [map(repr, column) for column in columns]
    )
