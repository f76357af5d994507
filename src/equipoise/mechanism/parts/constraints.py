"""Geometric constraints between lines of bodies, as of drawing programs: what they ask of points.

A line joins two points of a body.  No analysis needs a constraint: it says what a designer wants to
keep while lengths change.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from math import inf, isfinite
from types import MappingProxyType
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import Frozen, Listing, MenuItem, TextKind, declared, key
from equipoise.mechanism.checks import FRAME, Bodies, unknown
from equipoise.quantities import format_quantity

BodyPoint = tuple[str, str]
"""A body and its point."""
BodyLine = tuple[BodyPoint, BodyPoint]
PlaneVector = Any
"""A pair of x and y, m; complex numbers where a derivative is taken by a complex step."""
LineEnds = tuple[PlaneVector, PlaneVector]

HOLDS = 1e-6
"""Largest miss, as of `MISSES`: files give lengths with some six digits, which have to do."""


def _way(line: LineEnds) -> PlaneVector:
    (x, y), (to_x, to_y) = line
    return to_x - x, to_y - y


def _dot(place: PlaneVector, other: PlaneVector) -> Any:
    return place[0] * other[0] + place[1] * other[1]


def _cross(place: PlaneVector, other: PlaneVector) -> Any:
    return place[0] * other[1] - place[1] * other[0]


def _length(line: LineEnds) -> Any:
    return _dot(_way(line), _way(line)) ** 0.5


def _equal(line: LineEnds, to: LineEnds) -> list[Any]:
    length, other = _length(line), _length(to)
    return [2 * (length - other) / (length + other)]


def _parallel(line: LineEnds, to: LineEnds) -> list[Any]:
    return [_cross(_way(line), _way(to)) / (_length(line) * _length(to))]


def _perpendicular(line: LineEnds, to: LineEnds) -> list[Any]:
    return [_dot(_way(line), _way(to)) / (_length(line) * _length(to))]


def _in_line(line: LineEnds, to: LineEnds) -> list[Any]:
    way = _way(line)
    return [_cross(way, _way((line[0], end))) / _dot(way, way) for end in to]


IN_LINE = "in line"
MISSES: Mapping[str, Callable[[LineEnds, LineEnds], list[Any]]] = MappingProxyType({
    "equal": _equal,
    "parallel": _parallel,
    "perpendicular": _perpendicular,
    IN_LINE: _in_line,
})  # fmt: skip
"""By how much two lines miss what each kind asks of them: a difference of lengths over their mean,
the sine of an angle, distances over the length of the first line.  None becomes 0 as a line shrinks
to a point, so that no solver takes that way out."""
ACROSS = ("equal",)
"""Kinds whose lines may lie on two bodies; directions on two bodies change as these turn."""


@declared
class Constraint(Frozen):
    """What two lines have to be to each other; the second one is moved first."""

    called = to_say("{what} of constraint {number}")
    menu_item = MenuItem(to_say("Constraint …"), ({"line": "line"},))
    file_order = ("kind", "line", "to")

    kind: str = key(
        TextKind((*MISSES,)),
        "`equal` lengths; `parallel`, `perpendicular` or `in line`, of one body",
        example="equal",
    )
    line: tuple[str, str] = key(
        Listing(TextKind(of="point"), (2,)), "two points of a body", example=["A", "B"]
    )
    to: tuple[str, str] = key(
        Listing(TextKind(of="point"), (2,)),
        "two points of a body, those of the other line; of them the second moves first",
        example=["C", "D"],
        word=to_say("other line"),
    )

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""
        known = {point for points in bodies.values() for point in points}
        for name, line in (("line", self.line), ("to", self.to)):
            missing = [point for point in line if point not in known]
            if missing:
                yield ModelError(f"{where}.{name}", unknown(missing[0], known, "point"))
                return
            if line[0] == line[1]:
                what = Note("got {point!r} twice; give two points", point=line[0])
                yield ModelError(f"{where}.{name}", what)
                return
            if not bodies_of(line, bodies):
                what = Note("no body has both {first} and {second}; give two points of one",
                            first=line[0], second=line[1])  # fmt: skip
                yield ModelError(f"{where}.{name}", what)
                return
        if {*self.line} == {*self.to}:
            yield ModelError(f"{where}.to", Note("is the same line; give another one"))
        elif self.kind not in ACROSS and not _shared(self, bodies):
            what = Note(
                "no body has both {line} and {other}, whose directions change to each other as "
                "bodies turn; give two lines of one body",
                line=_line_text(self.line),
                other=_line_text(self.to),
            )
            yield ModelError(f"{where}.to", what)

    def lines(self, bodies: Bodies) -> tuple[BodyLine, BodyLine]:
        """Both lines in a machine of these bodies."""
        both = _shared(self, bodies)
        of = (both, both) if both else (bodies_of(self.line, bodies), bodies_of(self.to, bodies))
        first, second = self.line, self.to
        return (
            ((of[0][0], first[0]), (of[0][0], first[1])),
            ((of[1][0], second[0]), (of[1][0], second[1])),
        )

    def misses(self, bodies: Bodies) -> float:
        """By how much it is missed, as of `MISSES`; infinite of a line of no length."""
        lines = self.lines(bodies)
        first, second = ((bodies[a][b], bodies[c][d]) for (a, b), (c, d) in lines)
        try:
            worst = max(map(abs, MISSES[self.kind](first, second)))
        except ZeroDivisionError:
            return inf
        return worst if isfinite(worst) else inf

    def remark(self, bodies: Bodies) -> Note:
        """A sentence on lines that miss it."""
        ends = [[complex(*bodies[body][point]) for body, point in line]
                for line in self.lines(bodies)]  # fmt: skip
        lengths = [format_quantity(abs(end - start), "length") for start, end in ends]
        return Note(
            "{line} ({length}) and {other} ({other_length}) are not {kind}, as a constraint asks; "
            "give other places, or take the constraint away",
            line=_line_text(self.line),
            length=lengths[0],
            other=_line_text(self.to),
            other_length=lengths[1],
            kind=self.kind,
        )


def _line_text(line: tuple[str, str]) -> str:
    return "-".join(line)


def bodies_of(line: tuple[str, str], bodies: Bodies) -> list[str]:
    """Bodies that have both points of a line, links before the frame."""
    names = [body for body, points in bodies.items() if {*line} <= points.keys()]
    return sorted(names, key=lambda body: body == FRAME)


def _shared(constraint: Constraint, bodies: Bodies) -> list[str]:
    other = bodies_of(constraint.to, bodies)
    return [body for body in bodies_of(constraint.line, bodies) if body in other]


def changed_points(before: Bodies, after: Bodies) -> frozenset[BodyPoint]:
    """Points that lie elsewhere in the axes of their body than before; new ones are none."""
    return frozenset(
        (body, point)
        for body, points in after.items()
        for point, place in points.items()
        if before.get(body, points).get(point, place) != place
    )
