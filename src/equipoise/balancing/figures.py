"""Figures of a whole machine that are told before and after: nothing that got worse is left out."""

from __future__ import annotations

from math import isclose, sqrt
from typing import Any

import numpy as np

from equipoise.balancing.effects import ANGLES
from equipoise.balancing.measures import measured
from equipoise.mechanism.balance import Measure, Objective
from equipoise.mechanism.dynamics import Forces, forces
from equipoise.mechanism.model import Machine
from equipoise.mechanism.motion import move

Array = np.ndarray[Any, Any]

GONE = 1e-9
"""Share of a figure before below which it is rounding."""

OF_FORCE: tuple[Measure, ...] = ("rms", "peak")
OF_MOMENT: tuple[Measure, ...] = ("rms", "peak", "area")
OF_TORQUE: tuple[Measure, ...] = ("rms", "ripple", "peak", "peak_to_peak")


def figures_of(machine: Machine) -> dict[str, float]:
    """Figures by name, such as ``shaking_force.rms``; SI units.

    Moments are about the drive's pivot; areas are those under the absolute value over a turn, in J.
    Gauges are read by the model that is usual for the support.
    """
    found = forces(move(machine, ANGLES, acceleration=0.0))
    figures = {"mass": machine.mass}
    for name, values, measures in _signals(found):
        for measure in measures:
            figures[f"{name}.{measure}"] = measured(values, measure)
    return figures | _of_rows(machine) | _of_support(machine) | _of_planting(machine)


def _signals(found: Forces) -> list[tuple[str, Array, tuple[Measure, ...]]]:
    force = found.shaking_force
    signals: list[tuple[str, Array, tuple[Measure, ...]]] = [
        ("shaking_force", force.value, OF_FORCE),
        ("shaking_force.x", force.x, OF_FORCE),
        ("shaking_force.y", force.y, OF_FORCE),
        ("shaking_moment", found.shaking_moment, OF_MOMENT),
        ("drive_torque", found.drive_torque, OF_TORQUE),
    ]
    joints = [(f"joints.{name}", joint.value, OF_FORCE) for name, joint in found.joints.items()]
    gears = [(f"gears.{name}", mesh.value, OF_FORCE) for name, mesh in found.gears.items()]
    return signals + joints + gears


def signal_columns(before: Machine, after: Machine) -> list[tuple[str, str, Array]]:
    """Name, unit and values (N,) of crank angle, force, moment and torque of both machines.

    Over the longer of their cycles, where an added shaft takes several turns to come back.
    """
    turns = [move(machine, 1).turns for machine in (before, after)]
    angles = np.arange(ANGLES * max(turns)) * (2 * np.pi / ANGLES)
    columns = [("crank_angle", "rad", angles)]
    for name, machine in (("before", before), ("after", after)):
        found = forces(move(machine, angles, acceleration=0.0))
        columns += [
            (f"shaking_force.x.{name}", "N", found.shaking_force.x),
            (f"shaking_force.y.{name}", "N", found.shaking_force.y),
            (f"shaking_moment.{name}", "N m", found.shaking_moment),
            (f"drive_torque.{name}", "N m", found.drive_torque),
        ]
    return columns


def _of_rows(machine: Machine) -> dict[str, float]:
    """Figures of all rows together, where there are several."""
    if len(machine.rows) < 2:
        return {}
    from equipoise.balancing.multi_row import Rows
    from equipoise.balancing.phase_cost import Term

    rows, phases = Rows(machine), np.array([row.phase for row in machine.rows])
    figures = {}
    for output in ("shaking_force", "shaking_moment", "roll_moment", "yaw_moment"):
        for measure in OF_FORCE:
            objective = Objective(output, measure)
            value = Term(objective, rows.signals(objective)).told(phases)
            figures[f"rows.{output}.{measure}"] = value
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
