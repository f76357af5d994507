"""Signs of parts that are drawn as marks, each by the function that its kind names."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.element_kinds import PartKind, named_function
from equipoise.symbols.shapes import BodyMark

if TYPE_CHECKING:
    from equipoise.mechanism.parts.machine import Machine, Slider

UPPERMOST = ("rider", "face")
"""Roles of shapes that no other sign covers."""


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
