"""Figures of a whole machine that are told before and after: nothing that got worse is left out."""

from __future__ import annotations

from math import isclose, sqrt

import numpy as np

from equipoise.balancing.effects import ANGLES
from equipoise.balancing.objectives import measured
from equipoise.mechanism.balance import Objective
from equipoise.mechanism.dynamics import forces
from equipoise.mechanism.model import Machine
from equipoise.mechanism.motion import move
from equipoise.mechanism.outputs import DECLARED
from equipoise.results.analysis import Analysis
from equipoise.results.outputs import Outputs
from equipoise.signals import Array

GONE = 1e-9
"""Share of a figure before below which it is rounding."""


def figures_of(machine: Machine) -> dict[str, float]:
    """Figures by name, such as ``shaking_force.rms``; SI units.

    Moments are about the drive's pivot; areas are those under the absolute value over a turn, in J.
    Gauges are read by the model that is usual for the support.
    """
    motion = move(machine, ANGLES, acceleration=0.0)
    figures = {"mass": machine.mass}
    for one in Outputs.of(Analysis(motion, forces(motion))):
        for measure in one.declared.compared if one.declared.needs == "masses" else ():
            figures[f"{one.name}.{measure}"] = measured(one.component, measure)
    return figures | _of_rows(machine) | _of_support(machine) | _of_planting(machine)


def signal_columns(before: Machine, after: Machine) -> list[tuple[str, str, Array]]:
    """Name, unit and values (N,) of crank angle, force, moment and torque of both machines.

    Over the longer of their cycles, where an added shaft takes several turns to come back.
    """
    turns = [move(machine, 1).turns for machine in (before, after)]
    angles = np.arange(ANGLES * max(turns)) * (2 * np.pi / ANGLES)
    columns = [("crank_angle", "rad", angles)]
    for name, machine in (("before", before), ("after", after)):
        motion = move(machine, angles, acceleration=0.0)
        columns += [
            (f"{one.name}.{name}", one.unit, one.values)
            for one in Outputs.of(Analysis(motion, forces(motion))).ordered
            if one.declared.compared
        ]
    return columns


def _of_rows(machine: Machine) -> dict[str, float]:
    """Figures of all rows together, where there are several."""
    if len(machine.rows) < 2:
        return {}
    from equipoise.balancing.multi_row import Rows, Term

    rows, phases = Rows(machine), np.array([row.phase for row in machine.rows])
    figures = {}
    for one in [one for one in DECLARED.values() if one.needs == "rows"]:
        for measure in one.compared:
            objective = Objective(one.name.removeprefix("rows."), measure)
            value = Term(objective, rows.signals(objective)).value_at(phases)
            figures[f"{one.name}.{measure}"] = value
    return figures


def _of_support(machine: Machine) -> dict[str, float]:
    if machine.support is None:
        return {}
    from equipoise.vibration.forced import respond, usual_step

    response = respond(machine, model=usual_step(machine))
    figures = {}
    for name, gauge in response.gauges.items():
        figures[f"gauges.{name}.peak_to_peak"] = float(gauge.displacement.peak_to_peak)
        figures[f"gauges.{name}.ripple"] = float(gauge.displacement.vibration_rms)
    return figures


def _of_planting(machine: Machine) -> dict[str, float]:
    """Figures of the tip's path, which balancing must not change."""
    if machine.planting is None:
        return {}
    from equipoise.errors import EquipoiseError
    from equipoise.planting.summary import plant

    try:
        found = plant(machine).figures
    except EquipoiseError:  # a tip that never reaches the soil has no figures, and still shakes
        return {}
    return {f"planting.{name}": value for name, value in found.items()}


def planting_kept(before: dict[str, float], after: dict[str, float]) -> bool | None:
    """Whether every planting figure is what it was; None where there are none."""
    names = [name for name in before if name.startswith("planting.")]
    if not names:
        return None
    return all(isclose(before[n], after.get(n, np.nan), rel_tol=1e-9, abs_tol=1e-12) for n in names)


def equivalent_speeds(
    before: dict[str, float], after: dict[str, float], speed: float
) -> dict[str, float]:
    """Speeds (rad/s) at which the changed machine shakes as the old one did at `speed`.

    Shaking forces and moments grow with the square of the speed (Lee and Kim, conclusions).  What
    is gone but for rounding has no such speed.
    """
    return {
        name: speed * sqrt(before[name] / after[name])
        for name in before
        if name.startswith(("shaking_", "rows.")) and after.get(name, 0.0) > GONE * before[name] > 0
    }
