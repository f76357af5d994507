"""Forces in the joints: over crank angle, and as polar diagrams."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.analysis import angle_axis, over, settled, size_of, title
from equipoise.figures.crank import (
    ROOM,
    continued,
    extent,
    extremes,
    groups,
    numbers,
    sampled_extremes,
    told_angles,
)
from equipoise.figures.style import short
from equipoise.i18n import say
from equipoise.mechanism.dynamics import JointForce, SliderForce
from equipoise.results.charts import Axis, Chart, Curve, Mark, Panel

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

NOTHING = 1e-10
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
    force, moment = NOTHING * largest, NOTHING * largest * size_of(analysis)
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
