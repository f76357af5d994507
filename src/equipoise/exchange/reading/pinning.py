"""Points of links in the plane, and the pins that make one of several: names come last."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import field
from itertools import chain, count

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.kinematics.outline import STILL, LinkPlacement
from equipoise.mechanism.parts.machine import FRAME, Vector

SAME = 1e-9
"""Distance over the size of the machine below which two places are one."""


@dataclass(eq=False)
class Pinning:
    """Points of the frame and of links, by number; links that have the same number are pinned.

    poses : of every link.  wishes : names that a point should have, by its number.
    """

    poses: dict[str, LinkPlacement]
    points: dict[str, dict[int, Vector]] = field(init=False)
    wishes: dict[int, list[str]] = field(default_factory=dict)
    size: float = 1e-9

    def __post_init__(self) -> None:
        self.points = {link: {} for link in (FRAME, *self.poses)}

    def pose(self, link: str) -> LinkPlacement:
        return STILL if link == FRAME else self.poses[link]

    def at(self, link: str, place: complex) -> int | None:
        """The point of a link at a place of the frame, m."""
        tolerance, pose = SAME * self.size, self.pose(link)
        result = (item for item, local in self.points[link].items()
                 if abs(pose.out(local) - place) <= tolerance)  # fmt: skip
        return next(result, None)

    def put(self, link: str, place: complex, wish: str) -> int:
        """One more point of a link."""
        number = len(self.wishes)
        local = self.pose(link).into(place)
        self.points[link][number] = (local.real, local.imag)
        self.wishes[number] = [wish]
        self.size = max(self.size, abs(place))
        return number

    def held(self, link: str, place: complex, wish: str) -> int:
        """The point of a link at a place, new where there is none."""
        there = self.at(link, place)
        return self.put(link, place, wish) if there is None else there

    def pin(self, name: str, first: tuple[str, complex], other: tuple[str, complex]) -> None:
        """Make one of a point of each of two links.

        Raises
        ------
        ModelError : the links are pinned elsewhere already.
        """
        remaining, gone = (self.held(*end, name) for end in (first, other))
        if remaining == gone:
            return
        if any({remaining, gone} <= points.keys() for points in self.points.values()):
            links = f"{first[0]!r} and {other[0]!r}"
            raise ModelError(
                f"joint {name!r}",
                Note(
                    "{links} are pinned at another place already; a second pin leaves no motion",
                    links=links,
                ),
            )
        self.wishes[remaining] += self.wishes.pop(gone)
        self.wishes[gone] = []
        for points in self.points.values():
            if gone in points:
                points[remaining] = points.pop(gone)

    def named(self) -> dict[int, str]:
        """A name for every point, those of pins first; no two have the same."""
        holders = Counter(chain.from_iterable(self.points.values()))
        taken: dict[str, int] = {}
        for number, _ in sorted(holders.items(), key=lambda item: (-item[1], item[0])):
            taken[next(name for name in self._names(number) if name not in taken)] = number
        return {number: name for name, number in taken.items()}

    def _names(self, number: int) -> Iterator[str]:
        wishes = [item for item, _ in Counter(self.wishes[number]).most_common()]
        yield from wishes
        link = next(link for link, points in self.points.items() if number in points)
        yield f"{link}-{wishes[0]}"
        yield from (f"{wishes[0]} {n}" for n in count(2))
