"""Forces in the joints: over crank angle, and as polar diagrams."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from equipoise.i18n import say
from equipoise.mechanism.dynamics import JointForce, SliderForce
from equipoise.plotting.analysis.looks import (
    ALL,
    angle_axis,
    line,
    name_angles,
    settled,
    size_of,
    title,
    unit_of,
)
from equipoise.plotting.analysis.polar import draw_polar
from equipoise.plotting.crank import draw, mark
from equipoise.plotting.hodograph import nothing_there, numbers, square, told_angles
from equipoise.plotting.style import MAIN, blank, heading, short, styled
from equipoise.plotting.vibration.panels import (
    LEFT,
    RIGHT,
    WIDTH,
    Unit,
    continued,
    grid,
    groups,
    name_panel,
    name_y,
    place,
)

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

ROW = 1.6
"""Inches: height of a row of panels."""
LARGEST, BETWEEN, ABOVE, BELOW = 2.5, 0.5, 0.28, 0.28
"""Inches: side of a square, between two of them, for its name above and its numbers below."""
NOTHING = 1e-10
"""Over the largest force in a joint, and that at the length of the machine: less is rounding."""
HEAD, FOOT, IN_LINE, MOST_SQUARES = 0.6, 0.1, 3, 9
"""Inches of heading and foot; squares side by side, and in one picture."""


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
        found[name] = Joint(_told(name, joint), settled(joint.value, force))
        if isinstance(joint, SliderForce):
            told = say("{name}: couple on {on}", name=short(name), on=short(joint.on))
            found[f"{name}.moment"] = Joint(told, settled(joint.moment, moment))
    return found


def _told(name: str, joint: JointForce) -> str:
    """Name of a joint, and which body acts on which; names made of these are not said twice."""
    bodies = {"on": short(joint.on), "by": short(joint.by)}
    if name == f"{joint.by} to {joint.on}":
        return say("teeth: {by} on {on}", **bodies)
    if name in (f"{joint.by} on {joint.on}", f"{joint.on} on {joint.by}"):
        return say("slider: {by} on {on}", **bodies)
    return say("{name}: {by} on {on}", name=short(name), **bodies)


@styled()
def joints_figures(analysis: Analysis) -> list[Figure]:
    """Size of the force in every joint over crank angle, ten in a picture."""
    return [*_over_angle(analysis)]


def _over_angle(analysis: Analysis) -> Iterator[Figure]:
    found = joints_of(analysis)
    every = list(found)
    for names in groups(every):
        what = title(analysis, say("Force in each joint") + continued(names, every), "", True)
        figure, panels = grid(len(names), ROW, analysis.machine.title, what)
        for axes, name in zip(panels, names, strict=True):
            joint = found[name]
            unit = unit_of("force", joint.values, joint.couple)
            values = unit.factor * (joint.values if joint.couple else np.abs(joint.values))
            one = line(analysis, values, told="both" if joint.couple else "max")
            angle_axis(axes, analysis, most=8)
            draw(axes, [one], floor=None if joint.couple else 0.0)
            name_panel(axes, joint.told)
            name_y(axes, _label(joint, unit))
            mark(axes, [one], [], angles=False)
            if not np.any(values):
                nothing_there(axes, say("zero at every crank angle"))
        name_angles(figure, analysis)
        yield figure


def _label(joint: Joint, unit: Unit) -> str:
    if joint.couple:
        return say("couple, {unit}", unit=unit.name)
    return say("force, {unit}", unit=unit.name)


@styled()
def joint_polars_figures(analysis: Analysis) -> list[Figure]:
    """The end of the arrow of every joint force, in the frame's axes, nine in a picture."""
    return [*_polars(analysis)]


def _polars(analysis: Analysis) -> Iterator[Figure]:
    found = {name: joint for name, joint in joints_of(analysis).items() if not joint.couple}
    every = list(found)
    for names in groups(every, MOST_SQUARES):
        unit = unit_of("force", np.concatenate([found[name].values for name in names]))
        what = say("Force in each joint along x and y")
        remark = say("in {unit}; numbers: crank angle, deg", unit=unit.name)
        told = title(analysis, what + continued(names, every), remark, of_one=True)
        columns = len(names) if len(names) < IN_LINE else 2 if len(names) == 4 else IN_LINE
        side = min((WIDTH - LEFT - RIGHT - (columns - 1) * BETWEEN) / columns, LARGEST)
        rows = ceil(len(names) / columns)
        row = ABOVE + side + BELOW
        figure = blank(WIDTH, HEAD + rows * row + FOOT)
        heading(figure, analysis.machine.title, told, LEFT)
        for number, name in enumerate(names):
            down, across = divmod(number, columns)
            left = LEFT + across * (side + BETWEEN)
            bottom = figure.get_figheight() - HEAD - (down + 1) * row + BELOW
            axes = place(figure, left, bottom, side, side)
            values = unit.factor * found[name].values
            square(values, side).settle(axes)
            name_panel(axes, found[name].told)
            labels = draw_polar(axes, analysis, {ALL: values}, thinner=0.7)
            if analysis.motion.whole_cycle:
                numbers(axes, labels, told_angles(analysis.crank_angle), values, MAIN)
        yield figure
