"""What charts of an analysis share: titles, axes, rows; and the charts of forces in joints."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.chart_parts import (
    ROOM,
    closed,
    continued,
    crank_axis,
    extent,
    extremes,
    extremes_of,
    groups,
    numbered_angles,
    numbers,
    speed_text,
    without_empty,
)
from equipoise.figures.style import short
from equipoise.i18n import say
from equipoise.mechanism.dynamics.reactions import JointForce, SliderForce
from equipoise.mechanism.outputs.declared import body_named, joint_named
from equipoise.results.charts import DEGREES, Array, Axis, Chart, Curve, Mark, Panel, quantity
from equipoise.results.joint_blocks import contact_named, display_of_joints
from equipoise.signals import Figures

if TYPE_CHECKING:
    from equipoise.mechanism.dynamics.forces import Forces
    from equipoise.results.analysis import Analysis


SINGLE, ALL = "one", "all"
"""Roles of one row, and of all of them together."""
NOTHING = 1e-11
"""Over what each link needs: less is rounding."""


# -- words and samples -----------------------------------------------------------------------------


def title(
    analysis: Analysis,
    what: str,
    remark: str = "",
    of_one: bool = False,
    speed: float | None = None,
) -> str:
    """What is shown, at which speed, and a remark.

    of_one : whether it is of one row where there are several.
    speed : rad/s, where it is not that of the analysis, as in a state of the duty.
    """
    values = {"what": what, "speed": speed_text(analysis.motion.speed if speed is None else speed)}
    if of_one and len(analysis.machine.rows) > 1:
        text = say("{what} of one row, at {speed}", **values)
    else:
        text = say("{what}, at {speed}", **values)
    return f"{text}; {remark}" if remark else text


def about(analysis: Analysis) -> str:
    """The point about which moments are taken, in words."""
    pole = analysis.forces.about
    for name, place in analysis.machine.frame.items():
        if complex(*place) == pole:
            return short(name)
    return f"({quantity(pole.real, 'length')}, {quantity(pole.imag, 'length')})"


def over(analysis: Analysis, values: Array) -> tuple[Array, Array]:
    """Crank angles (rad) and values (N,), of a whole cycle with the first of them again.

    Where signals jump, both sides of each jump stand one above the other.
    """
    motion = analysis.motion
    theta, values = motion.shown(values)
    if not motion.whole_cycle:
        return theta, values
    return closed(theta, values, 2 * np.pi * motion.turns)


def with_figures(analysis: Analysis, values: Array) -> tuple[Array, Array, Figures]:
    """Crank angles and values as of `over`, and the figures of a signal (N,)."""
    return *over(analysis, values), analysis.motion.figures(values)


def angle_axis(analysis: Analysis) -> Axis:
    """The x axis: the whole cycle, or the crank angles there are."""
    motion = analysis.motion
    axis = crank_axis(short(motion.machine.drive.crank, 16), motion.speed, motion.turns)
    if motion.whole_cycle:
        return axis
    low, high = (float(f(motion.crank_angle)) for f in (np.min, np.max))
    return Axis(axis.label, DEGREES, "crank", low, high if high > low else low + 0.02)


# -- rows ------------------------------------------------------------------------------------------


def settled(values: Array, least: float) -> Array:
    """Values (N,), or zeros where none exceeds rounding, `least`; for complex values, component by
    component.
    """
    if np.iscomplexobj(values):
        return settled(values.real, least) + 1j * settled(values.imag, least)
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
    """Shaking force (complex), shaking moment or drive torque by role, (N,).

    Of one row and, where there are several, of all together, each with its crank ahead by its
    phase.  Zeros where nothing but rounding is left beside what each link needs.
    """
    force, moment = rounding(analysis)
    own = getattr(analysis.forces, output)
    if output == "shaking_force":
        own, least = own.value, force
    else:
        least = force if output == "drive_force" else moment
    if not analysis.rows_total:
        return {ALL: settled(own, least)}
    return {SINGLE: settled(own, least), ALL: settled(analysis.rows_total[output], least)}


def row_keys(analysis: Analysis) -> tuple[tuple[str, str], ...]:
    """What the two lines are, for a legend; nothing where there is one."""
    if not analysis.rows_total:
        return ()
    count = len(analysis.machine.rows)
    return (SINGLE, say("one row")), (ALL, say("{rows} rows together", rows=count))


# -- joints ----------------------------------------------------------------------------------------

LEAST_FORCE = 1e-10
"""Over the largest force in a joint, and that at the length of the machine: less is rounding."""
IN_LINE, MOST_SQUARES = 3, 9
"""Squares side by side, and in one picture."""


@dataclass(frozen=True, eq=False)
class JointCurve:
    """A force (complex) or a couple (real) in a joint, (N,), SI units, and its name in words."""

    label: str
    values: Array

    @property
    def couple(self) -> bool:
        """Whether it is one."""
        return not np.iscomplexobj(self.values)


def joints_of(analysis: Analysis) -> dict[str, JointCurve]:
    """Every joint, coupling and bearing; of a slider its couple too; rounding as zeros."""
    joint_curves, forces = {}, analysis.forces
    every = forces.solved.contacts
    largest = max((float(np.max(joint.size)) for joint in every.values()), default=0.0)
    force, moment = LEAST_FORCE * largest, LEAST_FORCE * largest * size_of(analysis)
    for name, joint in every.items():
        joint_curves[name] = JointCurve(named(forces, name, joint), settled(joint.value, force))
        if isinstance(joint, SliderForce):
            on = short(body_named(joint.on))
            text = say("{name}: couple on {on}", name=short(joint_named(name)), on=on)
            joint_curves[f"{name}.moment"] = JointCurve(text, settled(joint.moment, moment))
    for name in analysis.machine.bearings:
        value = forces.across.bearings[name].value
        joint_curves[f"bearings.{name}"] = JointCurve(
            say("bearing {name}", name=short(name)), value
        )
    return joint_curves


def named(forces: Forces, name: str, joint: JointForce) -> str:
    """Name of a joint, and which body acts on which; names made of these are not said twice."""
    bodies = {"on": short(body_named(joint.on)), "by": short(body_named(joint.by))}
    if name not in forces.joints:
        what = contact_named(forces, name)
        return say("{name}: {by} on {on}", name=what, **bodies)
    if name in (f"{joint.by} on {joint.on}", f"{joint.on} on {joint.by}"):
        return say("slider: {by} on {on}", **bodies)
    return say("{name}: {by} on {on}", name=short(joint_named(name)), **bodies)


def joints(analysis: Analysis) -> Iterator[Chart]:
    """Size of the force in every joint over crank angle, ten in a picture."""
    analysis = analysis.resolved
    result = joints_of(analysis)
    every = list(result)
    for suffix, names in groups(every, columns=2):
        what = title(analysis, say("Force in each joint") + continued(names, every), "", True)
        panels, words = without_empty(
            _over_angle(analysis, result[name], result.values()) for name in names
        )
        own = f"joints{suffix}"
        yield Chart(own, analysis.machine.title, what, panels, columns=2, words=words)


def _over_angle(analysis: Analysis, joint: JointCurve, every: Iterable[JointCurve]) -> Panel:
    """One of several joints, whose forces have one unit."""
    same_kind = np.concatenate([item.values for item in every if item.couple == joint.couple])
    if joint.couple:
        values, most = joint.values, 2
        y = Axis.of(say("couple"), "torque", same_kind, room=ROOM)
    else:
        values, most = np.abs(joint.values), 1
        unit = display_of_joints(analysis).unit
        y = Axis.of(say("force"), "force", same_kind, unit, low=0.0, room=ROOM)
    places = extremes_of(analysis.motion.figures(values))[:most]
    return Panel(
        angle_axis(analysis),
        y,
        (Curve(*over(analysis, values)),),
        extremes(y, values, places, "main"),
        title=joint.label,
        message="" if np.any(values) else say("zero at every crank angle"),
        height=74.0,
    )


def joint_polars(analysis: Analysis) -> Iterator[Chart]:
    """The end of the arrow of every joint force, in the frame's axes, nine in a picture."""
    by_name = {name: joint for name, joint in joints_of(analysis).items() if not joint.couple}
    every, unit = list(by_name), display_of_joints(analysis).unit
    in_line = 2 if len(every) == 4 else min(len(every), IN_LINE)
    for suffix, names in groups(every, MOST_SQUARES, in_line):
        axis = Axis.of("", "force", np.concatenate([by_name[name].values for name in names]), unit)
        what = say("Force in each joint along x and y") + continued(names, every)
        remark = say("in {unit}; numbers: crank angle, deg", unit=axis.unit_name)
        text = title(analysis, what, remark, of_one=True)
        panels = tuple(_square(analysis, by_name[name], axis) for name in names)
        own = f"joint-polars{suffix}"
        yield Chart(own, analysis.machine.title, text, panels, in_line, stacked=False)


def _square(analysis: Analysis, joint: JointCurve, axis: Axis) -> Panel:
    values = joint.values
    marks: tuple[Mark, ...] = ()
    if analysis.motion.whole_cycle:
        size = extent(values, np.zeros(1))
        marks = numbers(numbered_angles(analysis.crank_angle), values, "all", size)
    curve = Curve.of(over(analysis, values)[1], "", "thin")
    return Panel(axis, axis, (curve,), marks, title=joint.label, equal=True, rings=True)
