"""Lengths and angles of a body: between its points, as they are typed and held."""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Iterator, Mapping
from itertools import combinations
from math import hypot
from typing import Any, Literal

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note, all_of, listed, say
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.parts.machine import Vector
from equipoise.quantities import Measured
from equipoise.web.messages import Drag

MOST = 4
"""Points of a body of which every two have their length told."""
REACHED = 1e-9
"""Over the lengths that are held: how far beyond each other they may be."""


@dataclass(frozen=True)
class Measure:
    """A length, or the direction of a line in the axes of its body.

    start, moves : points of the line; the second one moves when the value changes.
    """

    dimension: Literal["length", "angle"]
    start: str
    moves: str
    value: float

    def path(self, body: KeyPath) -> KeyPath:
        """Path of the number below that of its body."""
        what = "lengths" if self.dimension == "length" else "directions"
        return body / what / f"{self.start}-{self.moves}"

    def is_component(self, points: Mapping[str, Vector]) -> bool:
        """Whether the file has it as the x of its second point: a length along x from the origin.

        points : of its body, in the axes of that, m.
        """
        x, y = points[self.moves]
        return self.dimension == "length" and not any(points[self.start]) and y == 0 and x > 0

    @property
    def told(self) -> dict[str, Any]:
        """What a page is told of its points: which one moves, and both ends of a length."""
        ends = {"between": (self.start, self.moves)} if self.dimension == "length" else {}
        return {"moves": self.moves, **ends}

    @property
    def label(self) -> str:
        """What a page calls it."""
        line = say("{point} to {other}", point=self.start, other=self.moves)
        return line if self.dimension == "length" else listed(line, say("direction"))

    def place(
        self, points: Mapping[str, Vector], value: float, keep: tuple[str, ...] = ()
    ) -> Vector:
        """Where the second point goes for another value, in the axes of the body, m.

        points : in those axes.  keep : those from which it keeps its distance.

        Raises
        ------
        UsageError : a length is not above 0, or other lengths that are locked do not let it.
        """
        others = [name for name in keep if name in points and name not in (self.start, self.moves)]
        start = complex(*points[self.start])
        way = complex(*points[self.moves]) - start
        if self.dimension == "length" and value <= 0:
            given = Measured(value, "length", "mm")
            raise UsageError(Note("got a length of {given}; give more than 0", given=given))
        size, angle = hypot(way.real, way.imag), phase(way)
        total = start + (rect(value, angle) if self.dimension == "length" else rect(size, value))
        if others:
            centers = [start, *(complex(*points[name]) for name in others)]
            now = complex(*points[self.moves])
            radii = [abs(total - start), *(abs(now - center) for center in centers[1:])]
            tolerance = REACHED * sum(radii)
            places = [
                place
                for place in _crossings(centers[:2], radii[:2])
                if abs(abs(place - start) - radii[0]) <= tolerance
            ]
            if self.dimension == "angle" or len(others) > 1 or not places:
                names = all_of([f"{name}–{self.moves}" for name in others])
                raise UsageError(Note("{names} would not stay as long as locked", names=names))
            total = min(places, key=lambda place: abs(place - now))
        return total.real, total.imag


def measures_of(points: Mapping[str, Vector]) -> Iterator[Measure]:
    """Every length between the first points of a body, and directions of lines from its first.

    Of the first line the direction is what the axes of a link are, so that it is told of further
    ones only where the body is a link: its second point lies on the x axis.
    """
    names = [*points][:MOST]
    for start, end in combinations(names, 2):
        way = complex(*points[end]) - complex(*points[start])
        if not way:
            continue
        yield Measure("length", start, end, hypot(way.real, way.imag))
        if start == names[0] and way.imag:
            yield Measure("angle", start, end, phase(way))


def constrained_place(places: Mapping[str, complex], change: Drag) -> complex:
    """The nearest place to where a point is dragged at which its locked lengths stay, m.

    places : of all points, m.

    Raises
    ------
    UsageError : so many lengths are locked that it cannot move.
    """
    others = [name for name in change.keep if name in places and name != change.name]
    if not others:
        return change.to
    now = places[change.name]
    if len(others) > 2:
        raise UsageError(
            Note(
                "{count} lengths that end in {name} are locked; unlock one",
                count=len(others),
                name=change.name,
            )
        )
    centers = [places[name] for name in others]
    radii = [abs(now - center) for center in centers]
    if len(centers) == 1:
        way = change.to - centers[0]
        return centers[0] + (rect(radii[0], phase(way)) if way else now - centers[0])
    return min(_crossings(centers, radii), key=lambda place: abs(place - change.to), default=now)


def _crossings(centers: list[complex], radii: list[float]) -> Iterator[complex]:
    """Where two circles meet, m."""
    line = centers[1] - centers[0]
    apart = abs(line)
    if not apart:
        return
    along = (apart**2 + radii[0] ** 2 - radii[1] ** 2) / (2 * apart)
    height = max(radii[0] ** 2 - along**2, 0.0) ** 0.5
    for side in (1, -1):
        yield centers[0] + line / apart * complex(along, side * height)
