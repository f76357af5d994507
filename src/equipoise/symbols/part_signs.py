"""Signs of parts that are drawn as marks, each by the function that its kind names; and those of
loads in the line between two points.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import to_say
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.element_kinds import PartKind, named_function
from equipoise.mechanism.parts.loads import AlongLine
from equipoise.symbols.shapes import BodyMark, Shape

if TYPE_CHECKING:
    from equipoise.mechanism.parts.machine import Machine, Slider


UPPERMOST = ("rider", "face")
"""Roles of shapes that no other sign covers."""
LOAD_LEGEND = "pull", to_say("force between two points")
LOAD_HEAD = np.array([14 + 5j, 22 + 0j, 14 - 5j])
"""Corners of the arrow at each end of a load in a line, units; x along the line."""
LOAD_SHAPES = (
    Shape("pull", np.array([0j, 1 + 0j]), np.zeros(2, complex)),
    Shape("pull-head", np.zeros(3, complex), LOAD_HEAD),
    Shape("pull-head", np.ones(3, complex), -LOAD_HEAD),
)
"""A dashed line with an arrow at both ends; along over the length of the line."""


@dataclass(frozen=True)
class Surroundings:
    """What a sign may depend on beside its part.

    machine : makes the whole machine, which a sketch may not be.
    radii : of pins that are drawn to scale, by point, m.
    travel : gives the displacement of a slider along its guide, m, at one or at all crank angles.
    """

    machine: Callable[[], Machine]
    joints: Structure
    bodies: Bodies
    radii: Mapping[str, float]
    travel: Callable[[Slider], Any]

    def pin_between(self, link: str, on: str) -> str:
        """The pin that two bodies share; where a sketch has none, the first point of the link."""
        shared = self.joints.pins_between(link, on)
        return shared[0] if shared else next(iter(self.bodies[link]))


@dataclass(frozen=True)
class DraggedCircle:
    """A circle about a point, of which a number of a part is the radius, m.

    name : of the part.  key : of that number.  axis : the point.
    point : that across from which the circle is dragged.
    """

    name: str
    key: str
    axis: str
    point: str


def dragged_circles(
    machine: Machine, joints: Structure
) -> Iterator[tuple[str, int, PartKind, DraggedCircle]]:
    """Circles by which numbers of parts are dragged, each with the list of its part, the part's
    place there from 0, and the part.
    """
    for table, place, part in machine.parts:
        if part.dragged:
            yield table, place, part, named_function(part.dragged)(part, joints)


def signs_of(table: str, part: PartKind, around: Surroundings) -> list[BodyMark]:
    """The signs of a part, if its kind has one.  table : key of its list."""
    marks = named_function(part.sign)(part, around) if part.sign else ()
    return [replace(mark, table=table, legend=part.legend) for mark in marks]


def in_order(marks: Iterable[BodyMark]) -> tuple[BodyMark, ...]:
    """Marks, of which those come last that no other covers."""
    return tuple(sorted(marks, key=lambda mark: mark.shape.role in UPPERMOST))


def load_line_marks(loads: Iterable[AlongLine]) -> Iterator[BodyMark]:
    """The signs of those loads that act in a line between two points."""
    for load in loads:
        if load.toward is None or load.point is None:
            continue
        for shape in LOAD_SHAPES:
            yield BodyMark(load.link, load.point, shape, legend=LOAD_LEGEND, to=load.toward)
