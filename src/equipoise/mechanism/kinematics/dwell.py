"""The longest crank angle over which something hardly moves, found on its continuous path."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.steps import Array
from equipoise.signals import within_period

RIVALS = 4
"""Dwells between the samples that are looked at closely: the longest by samples may not be it."""
ZONE, INNER, ROUNDS = 65, 513, 5
"""Crank angles about each end and between both, and how often the ends are looked at closer."""
DIRECTIONS = 64
HALVINGS = 44
"""Of a step, at one end of a rest."""
ALIKE = 1e-5
"""rad: dwells that differ by less are equal, and the first in the cycle is told."""


@dataclass(frozen=True)
class Dwell:
    """Crank angle over which something moves by no more than a tolerance.

    tolerance : m, or rad.  angle : of the crank, rad.
    begin : crank angle at which it begins, rad, where crank angles rise.
    """

    tolerance: float
    angle: float
    begin: float


@dataclass(frozen=True)
class Path:
    """A closed path of the crank angle: places and derivatives at N equal steps of a cycle.

    Between them it is the polynomial of fifth degree that they determine, whose error is that of
    rounding.

    place : complex (N,).  first, second : derivatives by crank angle.  period : rad.
    """

    place: Array
    first: Array
    second: Array
    period: float = 2 * pi

    @property
    def step(self) -> float:
        """rad between samples."""
        return self.period / len(self.place)

    def at(self, theta: Array) -> Array:
        """Places (K,) at crank angles (K,)."""
        h, count = self.step, len(self.place)
        whole = np.floor(theta / h)
        t, k = theta / h - whole, whole.astype(int) % count
        n = (k + 1) % count
        p, v, a = self.place[k], h * self.first[k], h * h * self.second[k]
        way = self.place[n] - p
        w, b = h * self.first[n], h * h * self.second[n]
        cubic = 10 * way - 6 * v - 4 * w - 1.5 * a + 0.5 * b
        quartic = -15 * way + 8 * v + 7 * w + 1.5 * a - b
        quintic = 6 * way - 3 * (v + w) - 0.5 * (a - b)
        values: Array = p + t * (v + t * (0.5 * a + t * (cubic + t * (quartic + t * quintic))))
        return values


def rests(
    theta: Array, speed: Array, speed_at: Callable[[Array], Array], least: float
) -> list[tuple[float, float]]:
    """Where something stands still: crank angles at which rests begin, and how long they are, rad.

    theta, speed : (N,) equal steps of a cycle, and the derivative there.
    speed_at : that at any crank angles (K,).  least : what is slower stands still.
    """
    still, step = np.abs(speed) <= least, theta[1] - theta[0]
    still &= np.roll(still, 1) | np.roll(still, -1)  # a dead point may be at one sample
    if not np.any(still) or np.all(still):
        return []
    begins = theta[still & ~np.roll(still, 1)]
    ends = theta[still & ~np.roll(still, -1)]
    ends = ends if ends[0] >= begins[0] else np.roll(ends, -1)

    def edge(inside: Array, outside: Array) -> Array:
        for _ in range(HALVINGS):
            middle = 0.5 * (inside + outside)
            rested = np.abs(speed_at(middle)) <= least
            inside, outside = np.where(rested, middle, inside), np.where(rested, outside, middle)
        return inside

    first, last = edge(begins, begins - step), edge(ends, ends + step)
    period = step * len(theta)
    lengths = (last - first) % period
    return list(zip((first % period).tolist(), lengths.tolist(), strict=True))


def longest_dwell(path: Path, tolerance: float) -> Dwell:
    """The longest part of a cycle in which no two places are further apart than a tolerance."""
    if _extent(path.place) <= tolerance:
        return Dwell(tolerance, path.period, 0.0)
    starts, lengths = _sampled(path.place, tolerance)
    if np.max(lengths) >= len(path.place) - 1:
        return Dwell(tolerance, path.period, 0.0)
    pairs: list[tuple[float, float]] = []
    for k in np.argsort(-lengths, kind="stable"):
        low, high = path.step * starts[k], path.step * (starts[k] + lengths[k])
        if len(pairs) == RIVALS or lengths[k] < np.max(lengths) - 2:
            break
        if all(_apart(low, item, path.period) > 2 * path.step for item, _ in pairs):
            pairs.append(_refined(path, low, high, tolerance))
    ends = sorted((float(within_period(np.array(a), path.period)), b - a) for a, b in pairs)
    longest = max(angle for _, angle in ends)
    begin, angle = next((a, b) for a, b in ends if b >= longest - ALIKE)
    return Dwell(tolerance, angle, begin)


def _extent(place: Array) -> float:
    """Distance of two places that are as far apart as any, but for a thousandth of it.

    It is one of those that lie farthest in some direction.
    """
    ways = np.exp(1j * np.arange(DIRECTIONS) * (2 * pi / DIRECTIONS))
    outer = place[[int(np.argmax((place * way).real)) for way in ways]]
    return float(np.max(np.abs(outer[:, None] - outer)))


def _apart(first: float, other: float, period: float) -> float:
    away = abs(first - other) % period
    return min(away, period - away)


def _sampled(place: Array, tolerance: float) -> tuple[Array, Array]:
    """Numbers of the first samples of parts that end at each sample, and their lengths, (N,).

    A part must begin behind every sample that is too far from one of its own.
    """
    count = len(place)
    reach = np.full(count, count)  # samples from each back to the last that is too far from it
    active = np.arange(count)
    for back in range(1, count + 1):
        far = np.abs(place[active] - place[active - back]) > tolerance
        reach[active[far]] = back
        active = active[~far]
        if back & (back - 1) == 0:  # now and then: what others hold back need not look further
            active = active[back < _held_back(reach)[active]]
        if not active.size:
            break
    lengths = _held_back(reach) - 1
    return (np.arange(count) - lengths) % count, lengths


def _held_back(reach: Array) -> Array:
    """Samples (N,) from each back to the last that is too far from it or one between."""
    count = len(reach)
    ends = np.arange(3 * count)  # two cycles before, so that what holds there is known
    last = np.maximum.accumulate(ends - np.tile(reach, 3))
    return np.asarray((ends - last)[2 * count :])


def _refined(path: Path, low: float, high: float, tolerance: float) -> tuple[float, float]:
    """Both ends of a dwell, from those among samples."""
    width = 2 * path.step
    inner = np.linspace(low, high, INNER)
    for _ in range(ROUNDS):
        middle, offsets = 0.5 * (low + high), width * np.linspace(-1.0, 1.0, ZONE)
        left, right = np.minimum(low + offsets, middle), np.maximum(high + offsets, middle)
        between = inner[(inner > left[-1]) & (inner < right[0])]
        theta = np.concatenate([left, between, right])
        places = path.at(theta)
        far = np.abs(places[:ZONE, None] - places) > tolerance
        far &= theta > left[:, None]
        first = np.min(np.where(far, theta, np.inf), axis=1)
        first = np.minimum.accumulate(first[::-1])[::-1]  # what begins earlier holds the later ones
        far = np.abs(places[-ZONE:, None] - places) > tolerance
        far &= theta < right[:, None]
        last = np.maximum.accumulate(np.max(np.where(far, theta, -np.inf), axis=1))
        good = (right < first[:, None]) & (left[:, None] > last)
        lengths = np.where(good, right - left[:, None], 0.0)
        item, other = np.unravel_index(np.argmax(lengths), lengths.shape)
        if good[item, other]:
            low, high = float(left[item]), float(right[other])
        width *= 4 / (ZONE - 1)
    return low, high
