"""What `equipoise respond` prints of a range of speeds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from equipoise.terminal.tables import number, table
from equipoise.terminal.units import Units
from equipoise.terminal.vibration import modes_table
from equipoise.vibration.response import EQUATIONS

if TYPE_CHECKING:
    from equipoise.vibration.sweep import Sweep

MOST_PEAKS = 6
"""Peaks that are told of each gauge."""


def print_sweep(sweep: Sweep, units: Units) -> None:
    """Natural frequencies, resonances, and what each gauge reads at its peaks."""
    unit = units.name("angular speed")
    ends = [
        units.shown(float(speed), "angular speed") for speed in (sweep.speed[0], sweep.speed[-1])
    ]
    print(sweep.machine.title)
    print(
        f"{sweep.machine.drive.link} driven at {ends[0]} to {ends[1]} {unit}, "
        f"{len(sweep.speed)} speeds"
    )
    print(f"model {sweep.model}, {EQUATIONS[sweep.model]}")
    print(modes_table(sweep.modes))
    print(_resonances(sweep, units))
    print(_gauges(sweep, units))
    for note in sweep.notes:
        print(f"note: {note}")


def _resonances(sweep: Sweep, units: Units) -> str:
    rows = []
    for resonance in sweep.resonances:
        shown = units.shown(resonance.speed, "angular speed")
        avoid = "no need"
        if resonance.avoid is not None:
            ends = (units.shown(speed, "angular speed") for speed in resonance.avoid)
            avoid = " to ".join(ends)
        share = f"{number(100 * resonance.share)} %"
        order = f"{resonance.order:.4g}"
        rows.append((shown, number(resonance.speed), order, str(resonance.mode), share, avoid))
    if not rows:
        return "\nno resonance in this range"
    unit = units.name("angular speed")
    header = (unit, "rad/s", "order", "mode", "share", f"keep away from, {unit}")
    small = " of small motion" if sweep.model == "exact" else ""
    what = "share of the loudest, amplified more than three times where to keep away"
    title = f"Resonances{small}; {what}"
    return table(title, header, rows, words=0)


def _gauges(sweep: Sweep, units: Units) -> str:
    rows = []
    for name, curve in sweep.gauges.items():
        dimension = "angle" if curve.rotation else "length"
        scale = units.value(1.0, dimension)  # type: ignore[arg-type]
        unit = units.name(dimension)  # type: ignore[arg-type]
        tops = sweep.peaks[name][:MOST_PEAKS]
        told = ", ".join(
            f"{number(value * scale)} at {units.shown(speed, 'angular speed')}"
            for speed, value in tops
        )
        least = int(np.nanargmin(curve.peak_to_peak))
        lowest = (
            f"{number(float(curve.peak_to_peak[least]) * scale)} at "
            f"{units.shown(float(sweep.speed[least]), 'angular speed')}"
        )
        rows.append((name, unit, lowest, told or "none"))
    title = f"Gauges; peak to peak, at {units.name('angular speed')}"
    return table(title, ("", "", "smallest", "peaks, the largest first"), rows, words=4)
