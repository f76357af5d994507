"""Threads by which counterweights are fastened, filled by screws of about the same weight.

Only what does not lie around its axis needs them: sectors, and discs beside it.
"""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise, product
from math import ceil, degrees, inf, pi, radians, sin
from typing import Any

import numpy as np

from equipoise.balancing.room import pins_on
from equipoise.balancing.workshop import covers, is_ring
from equipoise.dataclass import dataclass
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.bodies import material_of
from equipoise.signals import Array


@dataclass(frozen=True)
class CoarseThread:
    """A metric coarse thread.

    size : nominal diameter, mm.  area : stress area, m2 (ISO 898-1).  drill : diameter of the hole
    that it is tapped in, mm (ISO 2306).  runout : of that hole beyond the thread, where it ends in
    the part, mm (DIN 76-1, e1).
    """

    size: int
    area: float
    drill: float
    runout: float


COARSE_THREADS = (
    CoarseThread(5, 14.2e-6, 4.2, 4.2),
    CoarseThread(6, 20.1e-6, 5.0, 5.1),
    CoarseThread(8, 36.6e-6, 6.8, 6.2),
    CoarseThread(10, 58e-6, 8.5, 7.3),
    CoarseThread(12, 84.3e-6, 10.2, 8.3),
    CoarseThread(16, 157e-6, 14.0, 9.3),
    CoarseThread(20, 245e-6, 17.5, 11.2),
)
PRELOAD = 0.7 * 580e6
"""Stress of a tightened screw, Pa: 0.7 of the proof stress of property class 8.8 (ISO 898-1)."""
FRICTION, SAFETY = 0.12, 2.0
"""Between the counterweight and its link, of steel on steel; of what screws hold over the force."""
ENGAGEMENT = {"steel": 1.0, "cast iron": 1.0, "tungsten alloy": 1.0, "brass": 1.5, "lead": inf}
"""Material -> depth over the diameter from which a thread bears a tightened screw: about 1 in steel
and cast iron, as handbooks of machine elements have it; a choice for others."""
DEEP_ENGAGEMENT = 2.0
"""The same of aluminium, and where only a density is known."""
COUNTS = (2, 3, 4)
"""Screws by which a counterweight is fastened: two, so that it cannot turn about one; more where
two of no size fit and hold.
"""
EDGE = 1.5
"""Least distance of a thread's centre from an edge, over its diameter; from another twice that."""
DEEPEST = 4.0
"""Depth over the diameter up to which a thread goes all through; through thicker parts it would be
hard to tap, and its hole ends in them.
"""
MM = 1e-3


@dataclass(frozen=True)
class ScrewThreads:
    """Threads in a counterweight, from the side of its link.

    thread : of each.  places : in the axes of the link, m.  depth, hole : of the thread and of the
    hole that it is in, m; both the thickness where it goes all through.
    about_axis : radius, m, and direction, rad, of each about the axis; () of a disc beside it.
    """

    thread: CoarseThread
    places: tuple[complex, ...]
    depth: float
    hole: float
    about_axis: tuple[tuple[float, float], ...] = ()

    @property
    def size(self) -> int:
        """Nominal diameter, mm."""
        return self.thread.size

    @property
    def is_blind(self) -> bool:
        """Whether the holes end in the part."""
        return self.hole > self.depth

    @property
    def drilled(self) -> float:
        """Volume of all holes with their threads, m3."""
        radius = MM * self.thread.drill / 2
        return self.filled + len(self.places) * pi * radius**2 * (self.hole - self.depth)

    @property
    def filled(self) -> float:
        """Volume of the screws in the threads, m3."""
        return len(self.places) * pi * (MM * self.size / 2) ** 2 * self.depth


def needs_threads(piece: Mapping[str, Any], center: complex) -> bool:
    """Whether a piece has to be screwed on: it does not surround the axis at a centre."""
    if piece["shape"] == "disc":
        return not covers(piece, center, center)
    return piece["shape"] == "sector" and not is_ring(piece)


def threads_of(
    piece: Mapping[str, Any], center: complex, motion: Motion, link: str
) -> ScrewThreads | None:
    """The fewest and of these the smallest threads whose screws hold a piece by friction; None
    where none fit and hold.
    """
    force, thickness = SAFETY * _largest_force(piece, motion, link), piece["thickness"] or 0.0
    engagement = ENGAGEMENT.get(material_of(piece.get("density", 0.0)), DEEP_ENGAGEMENT)
    pins = pins_on(motion, link)
    for count, thread in product(COUNTS, COARSE_THREADS):
        depth, hole, share = _depths(thread, engagement, thickness)
        if count * FRICTION * PRELOAD * share * thread.area >= force:
            for polar, places in _with_room(piece, center, thread.size, count):
                if _clear(places, thread.size, pins):
                    return ScrewThreads(thread, places, depth, hole, polar)
    return None


def _depths(
    thread: CoarseThread, engagement: float, thickness: float
) -> tuple[float, float, float]:
    """Depth of a thread and of its hole, m, and the share of its screw's preload that it bears."""
    needed = engagement * MM * thread.size
    if thickness <= DEEPEST * MM * thread.size or needed == inf:
        return thickness, thickness, min(1.0, thickness / needed)
    depth = ceil(needed / MM)
    return MM * depth, MM * ceil(depth + thread.runout), 1.0


def _largest_force(piece: Mapping[str, Any], motion: Motion, link: str) -> float:
    """Of the inertia and weight of a piece over the cycle, at all speeds of the duty, N."""
    speeds = [motion.speed, *filter(None, (state.speed for state in motion.machine.duty))]
    accelerations = (_acceleration(piece, motion.at(speed), link) for speed in speeds)
    gravity = complex(*motion.machine.gravity)
    largest = max(float(np.max(np.abs(each - gravity))) for each in accelerations)
    return float(piece["mass"]) * largest


def _acceleration(piece: Mapping[str, Any], motion: Motion, link: str) -> Array:
    """Of the centre of mass of a piece (N,), m/s2."""
    points = motion.machine.links[link].points
    anchor, at = next(iter(points.items()))
    turning = motion.links[link]
    arm = np.exp(1j * turning.angle) * (complex(*piece["place"]) - complex(*at))
    about = 1j * turning.angular_acceleration - turning.angular_velocity**2
    return np.asarray(motion.points[anchor].acceleration_vector + about * arm)


def _clear(places: Sequence[complex], size: int, pins: Sequence[tuple[complex, float]]) -> bool:
    """Whether screws keep away from pins, of which place and radius are given, m."""
    edge = EDGE * size * MM
    return all(abs(at - pin) >= radius + edge for at in places for pin, radius in pins)


ThreadPlaces = tuple[tuple[float, float], ...]
"""Radius, m, and direction, rad, of each thread."""


def _with_room(
    piece: Mapping[str, Any], center: complex, size: int, count: int
) -> Iterator[tuple[ThreadPlaces, tuple[complex, ...]]]:
    """Places at whole millimetres and degrees, where threads keep away from edges."""
    edge = EDGE * size * MM
    if piece["shape"] == "disc":
        yield from (((), places) for places in _in_disc(piece, edge, count))
        return
    inner, outer, half = piece["inner_radius"], piece["outer_radius"], piece["angle"] / 2
    middle = round(degrees(piece["direction"]))
    offset = radians(middle) - piece["direction"]

    def keeps_away(radius: float, aside: float) -> bool:
        """Whether a thread at a radius, degrees beside the middle, keeps away from all edges."""
        to_end = min(max(half - abs(offset + radians(aside)), 0.0), pi / 2)
        return inner + edge <= radius <= outer - edge and radius * sin(to_end) >= edge

    for group in _in_sector(piece, count):
        if all(keeps_away(*item) for item in group):
            polar = tuple((r, phase(rect(1, radians(middle + aside)))) for r, aside in group)
            places = tuple(center + rect(*item) for item in polar)
            if all(abs(place - other) >= 2 * edge for place, other in pairwise(places)):
                yield polar, places


def _in_disc(piece: Mapping[str, Any], edge: float, count: int) -> Iterator[tuple[complex, ...]]:
    """Places on both sides of the middle of a disc, along and across it; or all four."""
    away = MM * round(piece["radius"] / 2 / MM)
    if not edge <= away <= piece["radius"] - edge:
        return
    place = complex(*piece["place"])
    pairs = [(place - to, place + to) for to in (away, 1j * away)]
    if count == 2:
        yield from pairs
    elif count == 4 and abs(away - 1j * away) >= 2 * edge:
        yield (*pairs[0], *pairs[1])


def _in_sector(piece: Mapping[str, Any], count: int) -> Iterator[tuple[tuple[float, float], ...]]:
    """Where threads of a sector may be: radius, m, and degrees beside its middle.

    Evenly along an arc, best half way between its edges and as far from its ends as from each
    other; or two below each other.
    """
    inner, outer = round(piece["inner_radius"] / MM), round(piece["outer_radius"] / MM)
    wide, middle = degrees(piece["angle"]), round((inner + outer) / 2)
    even = 2 - count % 2  # the first and the last are at whole degrees
    steps = sorted(range(even, int(wide), even), key=lambda item: abs(item - wide / count))
    for radius in sorted(range(inner, outer + 1), key=lambda item: abs(item - middle)):
        for step in steps:
            yield tuple((MM * radius, (k - (count - 1) / 2) * step) for k in range(count))
        if count == 2 and radius == middle:
            for far in range((outer - inner) // 4, (outer - inner) // 2):
                yield (MM * (middle - far), 0), (MM * (middle + far), 0)
