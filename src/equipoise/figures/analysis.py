"""What charts of an analysis share: titles, axes, rows; and the charts of forces in joints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from equipoise.figures.shared import (
    ROOM,
    closed,
    continued,
    crank_axis,
    extent,
    extremes,
    groups,
    numbers,
    sampled_extremes,
    told_angles,
    told_speed,
)
from equipoise.figures.style import short
from equipoise.i18n import say
from equipoise.mechanism.kernels import cross
from equipoise.mechanism.reactions import JointForce, SliderForce
from equipoise.results.charts import DEGREES, Array, Axis, Chart, Curve, Mark, Panel, shown
from equipoise.signals import Periodic

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis


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


LEAST_FORCE = 1e-10
"""Over the largest force in a joint, and that at the length of the machine: less is rounding."""
IN_LINE, MOST_SQUARES = 3, 9
"""Squares side by side, and in one picture."""


@dataclass(frozen=True, eq=False)
class Joint:
    """A force (complex) or a couple (real) in a joint, (N,), SI units, and its name in words."""

    told: str
    values: Array

    @property
    def couple(self) -> bool:
        """Whether it is one."""
        return not np.iscomplexobj(self.values)


def joints_of(analysis: Analysis) -> dict[str, Joint]:
    """Every joint and pair of gears; of a sliding joint its couple too; rounding as zeros."""
    found, forces = {}, analysis.forces
    every = {**forces.joints, **forces.gears}
    largest = max((float(np.max(joint.size)) for joint in every.values()), default=0.0)
    force, moment = LEAST_FORCE * largest, LEAST_FORCE * largest * size_of(analysis)
    for name, joint in every.items():
        found[name] = Joint(named(name, joint), settled(joint.value, force))
        if isinstance(joint, SliderForce):
            told = say("{name}: couple on {on}", name=short(name), on=short(joint.on))
            found[f"{name}.moment"] = Joint(told, settled(joint.moment, moment))
    return found


def named(name: str, joint: JointForce) -> str:
    """Name of a joint, and which body acts on which; names made of these are not said twice."""
    bodies = {"on": short(joint.on), "by": short(joint.by)}
    if name == f"{joint.by} to {joint.on}":
        return say("teeth: {by} on {on}", **bodies)
    if name in (f"{joint.by} on {joint.on}", f"{joint.on} on {joint.by}"):
        return say("slider: {by} on {on}", **bodies)
    return say("{name}: {by} on {on}", name=short(name), **bodies)


def joints(analysis: Analysis) -> Iterator[Chart]:
    """Size of the force in every joint over crank angle, ten in a picture."""
    found = joints_of(analysis)
    every = list(found)
    for suffix, names in groups(every):
        what = title(analysis, say("Force in each joint") + continued(names, every), "", True)
        panels = tuple(_over_angle(analysis, found[name]) for name in names)
        yield Chart(f"joints{suffix}", analysis.machine.title, what, panels, columns=2)


def _over_angle(analysis: Analysis, joint: Joint) -> Panel:
    values = joint.values if joint.couple else np.abs(joint.values)
    if joint.couple:
        y = Axis.of(say("couple"), "torque", values, room=ROOM)
    else:
        y = Axis.of(say("force"), "force", values, low=0.0, room=ROOM)
    places = sampled_extremes(analysis.crank_angle, values)[: 2 if joint.couple else 1]
    return Panel(
        angle_axis(analysis),
        y,
        (Curve(*over(analysis, values)),),
        extremes(y, values, places, "main"),
        title=joint.told,
        message="" if np.any(values) else say("zero at every crank angle"),
        height=74.0,
    )


def joint_polars(analysis: Analysis) -> Iterator[Chart]:
    """The end of the arrow of every joint force, in the frame's axes, nine in a picture."""
    found = {name: joint for name, joint in joints_of(analysis).items() if not joint.couple}
    every = list(found)
    for suffix, names in groups(every, MOST_SQUARES):
        whole = np.concatenate([found[name].values for name in names])
        axis = Axis.of("", "force", whole)
        what = say("Force in each joint along x and y")
        remark = say("in {unit}; numbers: crank angle, deg", unit=axis.unit_name)
        told = title(analysis, what + continued(names, every), remark, of_one=True)
        panels = []
        for name in names:
            values = found[name].values
            marks: tuple[Mark, ...] = ()
            if analysis.motion.whole_cycle:
                size = extent(values, np.zeros(1))
                marks = numbers(told_angles(analysis.crank_angle), values, "all", size)
            line = over(analysis, values)[1]
            curve = Curve(line.real, line.imag, "", "thin")
            titled = found[name].told
            panels.append(Panel(axis, axis, (curve,), marks, title=titled, equal=True, rings=True))
        columns = len(names) if len(names) < IN_LINE else 2 if len(names) == 4 else IN_LINE
        title_of = analysis.machine.title
        yield Chart(
            f"joint-polars{suffix}", title_of, told, tuple(panels), columns=columns, stacked=False
        )
