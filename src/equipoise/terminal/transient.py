"""What `equipoise simulate` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from equipoise.terminal.tables import Array, Row, number, table
from equipoise.terminal.units import Units

if TYPE_CHECKING:
    from equipoise.quantities.units import Dimension
    from equipoise.vibration.transient import Transient

PARTS = 5
"""Equal stretches of the time, of which the first and the last show whether it has settled."""


def print_transient(found: Transient, units: Units) -> None:
    """Extremes of every gauge and mount, in the first and the last stretch of the time."""
    turns = abs(float(found.crank_angle[-1])) / (2 * np.pi)
    print(found.machine.title)
    print(f"from rest for {number(float(found.time[-1]))} s, {number(turns)} turns of the crank")
    rows = []
    for name, values in found.gauges.items():
        rows.append(_row(name, values, "length" if found.unit(name) == "m" else "angle", units))
    for name, values in found.mounts.items():
        rows.append(_row(name, values, "force" if found.along(name) else "torque", units))
    rows.append(_row("crank speed", found.crank_speed, "angular speed", units))
    header = ("", "smallest", "largest", "range in the first fifth", "in the last", "")
    print(table("Gauges, mounts and drive", header, rows))


def _row(name: str, values: Array, dimension: Dimension, units: Units) -> Row:
    values = values * units.value(1.0, dimension)
    stretch = max(1, len(values) // PARTS)
    low, high = float(np.min(values)), float(np.max(values))
    scale = max(abs(low), abs(high))
    ranges = (float(np.ptp(values[:stretch])), float(np.ptp(values[-stretch:])))
    return (name, *(number(value, scale) for value in (low, high, *ranges)), units.name(dimension))
