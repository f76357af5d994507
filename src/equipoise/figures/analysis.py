"""What charts of an analysis share: titles, axes, rows; and charts of any of its outputs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.crank import closed, crank_axis, told_speed
from equipoise.figures.style import short
from equipoise.i18n import say
from equipoise.mechanism.kernels import cross
from equipoise.results.charts import DEGREES, Axis, shown
from equipoise.signals import Periodic

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

MM = 1000.0
ONE, ALL = "one", "all"
"""Roles of one row, and of all of them together."""
NOTHING = 1e-11
"""Over what each link needs: less is rounding."""


# -- words and samples -----------------------------------------------------------------------------


def title(analysis: Analysis, what: str, remark: str = "", of_one: bool = False) -> str:
    """What is shown, at which speed, and a remark.

    of_one : whether it is of one row where there are several.
    """
    values = {"what": what, "speed": told_speed(analysis.motion.speed)}
    if of_one and len(analysis.machine.rows) > 1:
        told = say("{what} of one row, at {speed}", **values)
    else:
        told = say("{what}, at {speed}", **values)
    return f"{told}; {remark}" if remark else told


def about(analysis: Analysis) -> str:
    """The point about which moments are taken, in words."""
    pole = analysis.forces.about
    for name, place in analysis.machine.frame.items():
        if complex(*place) == pole:
            return short(name)
    return f"({shown(MM * pole.real)} mm, {shown(MM * pole.imag)} mm)"


def over(analysis: Analysis, values: Array) -> tuple[Array, Array]:
    """Crank angles (rad) and values (N,), of a whole cycle with the first of them again."""
    if not analysis.motion.whole_cycle:
        return analysis.crank_angle, values
    return closed(analysis.crank_angle, values, 2 * np.pi * analysis.motion.turns)


def angle_axis(analysis: Analysis) -> Axis:
    """The x axis: the whole cycle, or the crank angles there are."""
    motion = analysis.motion
    axis = crank_axis(short(motion.machine.drive.link, 16), motion.speed, motion.turns)
    if motion.whole_cycle:
        return axis
    low, high = (float(f(motion.crank_angle)) for f in (np.min, np.max))
    return Axis(axis.label, DEGREES, "crank", low, high if high > low else low + 0.02)


# -- rows ------------------------------------------------------------------------------------------


def has_rows(analysis: Analysis) -> bool:
    """Whether all rows together differ from one, and can be told."""
    return len(analysis.machine.rows) > 1 and analysis.motion.whole_cycle


def outputs(analysis: Analysis) -> dict[str, Array]:
    """Shaking force (complex), shaking moment and drive torque, (N,), of one row."""
    found = analysis.forces
    whole = {
        "shaking_force": found.shaking_force.value,
        "shaking_moment": found.shaking_moment,
        "drive_torque": found.drive_torque,
    }
    return _settled(analysis, whole)


def together(analysis: Analysis) -> dict[str, Array]:
    """The same of all rows, each with its crank ahead by its phase."""
    found = outputs(analysis)
    count = len(analysis.crank_angle)
    force, moment, torque = found.values()
    one = Periodic.of(np.array([force.real, force.imag, moment, torque]), analysis.motion.turns)
    whole = np.zeros((4, count))
    for row in analysis.machine.rows:
        values = one.shifted(row.phase).samples(count)
        values[2] += cross(complex(*row.offset), values[0] + 1j * values[1])
        whole += values
    summed = (whole[0] + 1j * whole[1], whole[2], whole[3])
    return _settled(analysis, dict(zip(found, summed, strict=True)))


def _settled(analysis: Analysis, found: dict[str, Array]) -> dict[str, Array]:
    """Zeros where nothing but rounding is left beside what each link needs."""
    force, moment = rounding(analysis)
    return {
        name: settled(values, force if name == "shaking_force" else moment)
        for name, values in found.items()
    }


def settled(values: Array, least: float) -> Array:
    """Values (N,), or zeros where none is larger than what is told as rounding."""
    return values if float(np.max(np.abs(values), initial=0.0)) > least else 0 * values


def rounding(analysis: Analysis) -> tuple[float, float]:
    """Force (N) and moment (N m) that are rounding beside what each link needs."""
    forces = analysis.forces
    demands = [
        demand
        for cause in (forces.inertia, forces.weights, forces.loads, forces.springs)
        for demand in cause.values()
    ]
    force = max(float(np.max(np.abs(demand))) for demand, _ in demands)
    moment = force * size_of(analysis)
    moment += max(float(np.max(np.abs(demand))) for _, demand in demands)
    return NOTHING * force, NOTHING * moment


def size_of(analysis: Analysis) -> float:
    """Diagonal of the box that holds every point all the time, m."""
    every = np.concatenate([point.place for point in analysis.motion.points.values()])
    return abs(complex(np.ptp(every.real), np.ptp(every.imag)))


def each(analysis: Analysis, output: str) -> Mapping[str, Array]:
    """An output of one row and, where there are several, of all together, by role."""
    one = outputs(analysis)[output]
    return {ONE: one, ALL: together(analysis)[output]} if has_rows(analysis) else {ALL: one}


def row_keys(analysis: Analysis) -> tuple[tuple[str, str], ...]:
    """What the two lines are, for a legend; nothing where there is one."""
    if not has_rows(analysis):
        return ()
    count = len(analysis.machine.rows)
    return (ONE, say("one row")), (ALL, say("all {count} rows", count=count))
