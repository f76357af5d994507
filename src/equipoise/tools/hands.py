"""Measured driving-point impedance of a hand, between the rows of its table."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.tools.duals import value_of
from equipoise.tools.model import Impedance, Tool

Array = np.ndarray[Any, Any]
TOUCHING = 1e-9
"""Share by which a frequency may pass the end of a table for rounding."""


def impedance(tables: Sequence[Impedance], s: Any) -> Array:
    """Force over velocity (2, F), N s/m, of both planes at s = i omega, 1/s."""
    frequency = np.abs(np.imag(value_of(s))) / (2 * pi)
    rows = np.broadcast_to(frequency, (2, frequency.shape[-1]))
    both = tables if len(tables) == 2 else (tables[0], tables[0])
    return np.array([_between(table, row) for table, row in zip(both, rows, strict=True)])


def _between(table: Impedance, frequency: Array) -> Array:
    real = np.interp(frequency, table.frequency, table.resistance)
    return np.asarray(real + 1j * np.interp(frequency, table.frequency, table.reactance))


def check_coverage(tool: Tool, lowest: float, highest: float) -> None:
    """Every table of a hand must reach from the lowest to the highest frequency, rad/s.

    Raises
    ------
    ModelError : says where a table begins or ends.
    """
    low, high = lowest / (2 * pi), highest / (2 * pi)
    for number, station in enumerate(tool.stations, 1):
        for table in station.hand.impedance if station.hand is not None else ():
            first, last = table.frequency[0], table.frequency[-1]
            if first <= low * (1 + TOUCHING) and last >= high * (1 - TOUCHING):
                continue
            raise ModelError(
                f"shaft.stations[{number}].hand.impedance",
                f"the table{f' {table.file}' if table.file else ''} reaches from {first:.4g} Hz to "
                f"{last:.4g} Hz, but {low:.4g} Hz to {high:.4g} Hz are asked for; measure the rest "
                "too, or ask for speeds whose orders lie within the table",
            )
