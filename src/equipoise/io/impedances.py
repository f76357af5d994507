"""Impedances of hands against frequency: CSV files with units in the header.

::

    frequency [Hz],resistance [N s/m],reactance [N s/m]
    20,120,-80
    40,150,10

Magnitude and phase may stand for resistance and reactance.
"""

from __future__ import annotations

from pathlib import Path

from equipoise.handheld.model import Impedance
from equipoise.schema import csv_columns
from equipoise.schema.points import from_polar

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
