"""Threads by which counterweights are fastened, filled by screws of about the same weight.

Only what does not lie around its axis needs them: sectors, and discs beside it.
"""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Iterator, Mapping, Sequence
from math import degrees, inf, pi, radians, sin
from typing import Any

import numpy as np

from equipoise.balancing.room import pins_on
from equipoise.balancing.workshop import covers, is_ring
from equipoise.dataclass import dataclass
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.bodies import material_of
from equipoise.signals import Array

STRESS_AREAS = {5: 14.2e-6, 6: 20.1e-6, 8: 36.6e-6, 10: 58e-6, 12: 84.3e-6, 16: 157e-6, 20: 245e-6}
"""Nominal diameter, mm -> stress area of a metric coarse thread, m2 (ISO 898-1)."""
PRELOAD = 0.7 * 580e6
"""Stress of a tightened screw, Pa: 0.7 of the proof stress of property class 8.8 (ISO 898-1)."""
FRICTION, SAFETY = 0.12, 2.0
"""Between the counterweight and its link, of steel on steel; of what screws hold over the force."""
ENGAGEMENT = {"steel": 1.0, "cast iron": 1.0, "tungsten alloy": 1.0, "brass": 1.5, "lead": inf}
"""Material -> depth over the diameter from which a thread bears a tightened screw: about 1 in steel
and cast iron, as handbooks of machine elements have it; a choice for others."""
DEEP_ENGAGEMENT = 2.0
"""The same of aluminium, and where only a density is known."""
SCREWS = 2
EDGE = 1.5
"""Least distance of a thread's centre from an edge, over its diameter; from another twice that."""
DEEPEST = 4.0
"""Depth over the diameter beyond which a thread is hard to tap."""
MM = 1e-3


@dataclass(frozen=True)
class ScrewThreads:
    """Threads through a counterweight.

    size : nominal diameter, mm.  places : in the axes of the link, m.
    about_axis : radius, m, and direction, rad, of each about the axis; () of a disc beside it.
    """

    size: int
    places: tuple[complex, ...]
    about_axis: tuple[tuple[float, float], ...] = ()


def needs_threads(piece: Mapping[str, Any], center: complex) -> bool:
    """Whether a piece has to be screwed on: it does not surround the axis at a centre."""
    if piece["shape"] == "disc":
        return not covers(piece, center, center)
    return piece["shape"] == "sector" and not is_ring(piece)


def threads_of(
    piece: Mapping[str, Any], center: complex, motion: Motion, link: str
) -> ScrewThreads | None:
    """The smallest threads whose screws hold a piece by friction; None where none fit and hold."""
    force, depth = SAFETY * _largest_force(piece, motion, link), piece["thickness"] or 0.0
    engagement = ENGAGEMENT.get(material_of(piece.get("density", 0.0)), DEEP_ENGAGEMENT)
    pins = pins_on(motion, link)
    for size, area in STRESS_AREAS.items():
        share = min(1.0, depth / (engagement * MM * size))
        if SCREWS * FRICTION * PRELOAD * share * area >= force and DEEPEST * MM * size >= depth:
            every = _with_room(piece, center, size)
            return next((item for item in every if _clear(item, pins)), None)
    return None


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


def _clear(threads: ScrewThreads, pins: Sequence[tuple[complex, float]]) -> bool:
    """Whether screws keep away from pins, of which place and radius are given, m."""
    edge = EDGE * threads.size * MM
    return all(abs(at - pin) >= radius + edge for at in threads.places for pin, radius in pins)


def _with_room(piece: Mapping[str, Any], center: complex, size: int) -> Iterator[ScrewThreads]:
    """Threads at whole millimetres and degrees, where they keep away from edges."""
    edge = EDGE * size * MM
    if piece["shape"] == "disc":
        away = MM * round(piece["radius"] / 2 / MM)
        if edge <= away and away + edge <= piece["radius"]:
            place = complex(*piece["place"])
            yield from (ScrewThreads(size, (place - to, place + to)) for to in (away, 1j * away))
        return
    inner, outer, half = piece["inner_radius"], piece["outer_radius"], piece["angle"] / 2
    middle = round(degrees(piece["direction"]))
    beside = radians(middle) - piece["direction"]

    def keeps_away(pair: Sequence[tuple[float, int]]) -> bool:
        """Whether threads at radii, degrees beside the middle, keep away from all edges."""
        apart = abs(rect(pair[0][0], radians(pair[0][1])) - rect(pair[1][0], radians(pair[1][1])))
        return apart >= 2 * edge and all(
            inner + edge <= radius <= outer - edge
            and radius * sin(min(max(half - abs(beside + radians(aside)), 0.0), pi / 2)) >= edge
            for radius, aside in pair
        )

    for pair in _pairs(piece):
        if keeps_away(pair):
            polar = tuple((r, phase(rect(1, radians(middle + aside)))) for r, aside in pair)
            yield ScrewThreads(size, tuple(center + rect(*item) for item in polar), polar)


def _pairs(piece: Mapping[str, Any]) -> Iterator[tuple[tuple[float, int], tuple[float, int]]]:
    """Where threads of a sector may be: radius, m, and degrees beside its middle.

    On both sides of the middle, best half way to its ends; or below each other.
    """
    inner, outer = round(piece["inner_radius"] / MM), round(piece["outer_radius"] / MM)
    most, radius = round(degrees(piece["angle"] / 2)), MM * round((inner + outer) / 2)
    for aside in sorted(range(1, most), key=lambda item: abs(item - most / 2)):
        yield (radius, -aside), (radius, aside)
    for far in range((outer - inner) // 4, (outer - inner) // 2):
        yield (radius - MM * far, 0), (radius + MM * far, 0)
