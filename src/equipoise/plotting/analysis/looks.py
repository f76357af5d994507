"""What the pictures of an analysis share: samples over the cycle, rows together, words."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, floor
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from equipoise import signals
from equipoise.i18n import say
from equipoise.mechanism.kernels import cross
from equipoise.plotting.crank import MOST_TICKS, Line, closed, crank_axis
from equipoise.plotting.style import EARTH, INK, LINES, MAIN, STRESS, short, shown
from equipoise.plotting.vibration.panels import Unit, by_phase, name_x, told_speed
from equipoise.signals import Periodic

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

MM = 1000.0
LINE_LOOKS: tuple[tuple[str, Any], ...] = (
    (MAIN, "-"),
    (STRESS, (0, (5, 1.6))),
    (INK, (0, (6, 1.6, 1.2, 1.6))),
    (EARTH, (0, (1.3, 1.1))),
    (LINES, (0, (10, 3))),
)
"""Colours and dashes of several lines in one picture."""
NOTHING = 1e-11
"""Over what each link needs: less is rounding."""
ONE, ALL = "one", "all"
ROW_LOOKS: dict[str, dict[str, Any]] = {
    ONE: {"color": LINES, "linewidth": 0.9, "zorder": 3.1},
    ALL: {"color": MAIN, "linewidth": 1.9, "zorder": 3.0},
}
"""Of one row, and of all of them together."""


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


# -- over crank angle ------------------------------------------------------------------------------


def over(analysis: Analysis, values: Array) -> tuple[Array, Array]:
    """Crank angles (rad) and values (N,), of a whole cycle with the first of them again."""
    if not analysis.motion.whole_cycle:
        return analysis.crank_angle, values
    return closed(analysis.crank_angle, values, 2 * np.pi * analysis.motion.turns)


def line(
    analysis: Analysis, values: Array, name: str = "", told: str = "both", **look: Any
) -> Line:
    """A signal (N,) in units of its axis.

    told : which extremes are marked: ``both``, ``max`` or none.
    """
    found = signals.figures(analysis.crank_angle, values)
    marked = {"both": 2, "max": 1, "": 0}[told]
    extremes = [(found.max_at, found.max), (found.min_at, found.min)]
    return Line(*over(analysis, values), name, **look, marked=extremes[:marked])


def angle_axis(axes: Axes, analysis: Analysis, most: int = MOST_TICKS) -> None:
    """The x axis: the whole cycle, or the crank angles there are, in degrees."""
    if analysis.motion.whole_cycle:
        crank_axis(axes, analysis.motion.turns, most)
        return
    low, high = (float(np.degrees(f(analysis.crank_angle))) for f in (np.min, np.max))
    axes.set_xlim((low, high) if high > low else (low - 1, high + 1))
    axes.locator_params(axis="x", nbins=most - 1, steps=[1, 1.5, 3, 4.5, 6, 9, 10])


def name_angles(figure: Figure, analysis: Analysis) -> None:
    """What the x axes are: the crank's angle."""
    drive = analysis.machine.drive
    name_x(figure, by_phase(short(drive.link, 16), analysis.motion.speed, with_motor=False))


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
    together = (whole[0] + 1j * whole[1], whole[2], whole[3])
    return _settled(analysis, dict(zip(found, together, strict=True)))


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
    """An output of one row and, where there are several, of all together."""
    one = outputs(analysis)[output]
    return {ONE: one, ALL: together(analysis)[output]} if has_rows(analysis) else {ALL: one}


def row_names(analysis: Analysis) -> dict[str, str]:
    """What one row and all of them are called."""
    return {ONE: say("one row"), ALL: say("all {count} rows", count=len(analysis.machine.rows))}


def row_keys(analysis: Analysis) -> list[Any]:
    """What the two lines are, for a legend."""
    names = row_names(analysis)
    return [Line2D([], [], label=names[name], **look) for name, look in ROW_LOOKS.items()]


# -- scale -----------------------------------------------------------------------------------------


def unit_of(quantity: str, values: Array, rotation: bool = False) -> Unit:
    """The unit for values, complex ones by their parts."""
    parts = np.concatenate([np.ravel(values.real), np.ravel(values.imag)])
    return Unit.of(quantity, rotation, parts)


def rings(reach: float) -> tuple[float, int]:
    """A round distance of up to four circles out to a radius, and how many there are."""
    step = 10.0 ** floor(np.log10(reach / 4))
    step *= next(by for by in (1, 2, 5, 10) if 4 * by * step >= reach)
    return step, ceil(reach / step)
