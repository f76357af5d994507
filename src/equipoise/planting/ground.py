"""Loops and cusps of the tip's path over ground, and where that path is smooth.

Everything runs in the sense of time: ``way`` is the crank angle that the drive has turned, counted
positive whichever way it turns.
"""

from __future__ import annotations

from functools import partial
from itertools import chain, takewhile
from typing import Any, ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.tip import TipCurve, crossings, integral, lowest_within
from equipoise.planting.stroke import wrapped
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.signals import Array

STILL = 1e-9
"""Rate of the path, over its largest, at which the tip counts as standing still over ground."""
NEAREST = 14
"""Halvings of a step, by which samples crowd about a place where the path is slow: a loop may be
as small as the last of them."""
SMALLEST_LOOP = 1e-9
"""Height and width of a loop, over the height of the whole curve, below which it is a cusp."""
MOST_NODES = 6000
"""Pieces of a cycle among which crossings are looked for, whose number goes with the square."""
AT_ONCE, PIECES = 256, 4096
"""Loops that are measured, and pieces of the path that are followed, in one call: memory."""
MOST_STEPS, CLOSED = 20, 1e-12
"""Steps of Newton's method for a crossing, and the step (rad) at which it has been found."""


@dataclass(frozen=True)
class Loop:
    """A loop of the path over ground: the tip comes back to a place where it has been.

    first, second : crank angles, rad.  way : crank angle turned in between, rad.
    y : height of the crossing in the frame, m.  height, width : m.  area : m2.
    in_soil : whether the crossing lies below the surface.
    """

    first: float
    second: float
    way: float
    y: float
    height: float
    width: float
    area: float
    in_soil: bool

    declared: ClassVar[Declarations] = {
        "first": ResultOutput("crank angle of the first pass of the crossing", "angle"),
        "second": ResultOutput("crank angle of the second pass", "angle"),
        "way": ResultOutput("crank angle turned in between", "angle"),
        "y": ResultOutput("height of the crossing in the frame", "length"),
        "height": ResultOutput("height of the loop", "length"),
        "width": ResultOutput("width of the loop", "length"),
        "area": ResultOutput("area of the loop, m2"),
        "in_soil": ResultOutput("whether the crossing lies below the surface"),
    }


class GroundPath:
    """Path of the tip of one machine over ground."""

    def __init__(self, curve: TipCurve) -> None:
        self.curve = curve
        speed, forward = float(curve.speed[0, 0]), float(curve.forward[0, 0])
        self.sense = 1.0 if speed > 0 else -1.0
        self.drive = forward / abs(speed)
        self.samples = np.append(curve.theta, curve.period)
        self.slow = crossings(self.rate_slope, self.samples)

    def place(self, way: Array) -> Array:
        """Places over ground, m, complex, as many as ways; over that at crank angle 0."""
        turned = self.sense * way.reshape(1, -1)
        return self.curve.at(turned).place.reshape(way.shape) + self.drive * way

    def rate(self, way: Array) -> Array:
        """Its derivative, m, complex, as many as ways."""
        turned = self.sense * way.reshape(1, -1)
        return self.sense * self.curve.at(turned).place_1.reshape(way.shape) + self.drive

    def rate_slope(self, way: Array) -> Array:
        """A signal with the sign of the derivative of the rate's size."""
        tip = self.curve.at(self.sense * way)
        slope: Array = kernels.dot(self.sense * tip.place_1 + self.drive, tip.place_2)
        return slope

    def crank_angle(self, way: float) -> float:
        """Crank angle within one cycle, rad."""
        return float(wrapped(self.curve, np.array(self.sense * way)))

    def cusps(self) -> tuple[float, ...]:
        """Crank angles at which the tip stands still over ground for an instant."""
        if not self.drive or not self.slow.size:
            return ()
        rates = np.abs(self.rate(self.slow[None])[0])
        largest = np.max(np.abs(self.rate(self.samples[None])))
        return tuple(self.crank_angle(way) for way in self.slow[rates < STILL * largest])

    def breaks(self, start: float, stop: float, pieces: int = 24) -> Array:
        """Ways (B,) from start to stop between which the path bends gently: they crowd about
        places where it is slow.

        pieces : of equal width, at least.
        """
        period = self.curve.period
        around = self.slow + period * np.floor((start - self.slow) / period)
        slow = np.concatenate([around + period * k for k in range(3)], axis=None)
        step = period / len(self.curve.theta) * 8
        crowded = _crowded(slow, step)
        inner = np.concatenate([np.linspace(start, stop, pieces + 1), crowded])
        return np.unique(inner[(inner >= start) & (inner <= stop)])

    def loops(self) -> tuple[Loop, ...]:
        """Every self-crossing of the path within one cycle, in the order of time."""
        if not self.drive:
            return ()
        nodes = self._nodes()
        places = self.place(nodes[None])[0]
        cycle = int(np.searchsorted(nodes, self.curve.period))
        crossed = self._polished(_crossing_pairs(nodes, places, cycle))
        ways = self._distinct(crossed)
        areas = self._areas(ways)
        smallest = SMALLEST_LOOP * float(self.curve.highest[0][0] - self.curve.lowest[0][0])
        measured = [
            self._measured(ways[k : k + AT_ONCE], areas[k : k + AT_ONCE])
            for k in range(0, len(ways), AT_ONCE)
        ]
        return tuple(loop for loop in chain(*measured) if loop.height + loop.width > smallest)

    def _nodes(self) -> Array:
        """Ways over two cycles at which the path is sampled: crowded where it is slow."""
        step = max(self.samples[1], 2 * self.curve.period / MOST_NODES)
        once = np.arange(0.0, self.curve.period, step)
        nodes = np.mod(_crowded(self.slow, step), self.curve.period)
        once = np.unique(np.concatenate([once, nodes]))
        return np.concatenate([once, once + self.curve.period])

    def _polished(self, ways: Array) -> Array:
        """Ways (L, 2) of crossings near ways (C, 2), by Newton's method on the two components of
        the way between both passes.

        At a cusp it creeps towards a single instant: then there is no crossing.
        """
        closed = [np.empty((0, 2))]
        for _ in range(MOST_STEPS):
            if not ways.size:
                break
            places, (item, other) = self.place(ways), self.rate(ways).T
            turn, gap = kernels.cross(item, other), places[:, 1] - places[:, 0]
            crossing = np.abs(turn) > 0
            steps = np.stack([kernels.cross(gap, other), kernels.cross(gap, item)], axis=-1)
            steps = steps[crossing] / turn[crossing, None]
            ways = ways[crossing] + steps
            close = np.max(np.abs(steps), axis=1) < CLOSED
            closed.append(ways[close])
            ways = ways[~close]
        return np.concatenate(closed)

    def _distinct(self, crossed: Array) -> Array:
        """Ways (L, 2) of those crossings (C, 2) that begin in the first cycle, each once."""
        period, once = self.curve.period, list[tuple[float, float]]()
        for first, second in sorted(map(tuple, crossed.tolist())):
            inside = -1e-12 <= first < period - 1e-12 and 1e-7 < second - first < period
            if inside and not _among(once, first, second):
                once.append((first, second))
        return np.array(once).reshape(-1, 2)

    def _measured(self, ways: Array, areas: Array) -> list[Loop]:
        """Loops between ways (L, 2), of areas (L,)."""
        crossing = self.place(ways[:, 0])
        extents = [self._extent(ways[:, 0], ways[:, 1], axis).tolist() for axis in ("imag", "real")]
        return [
            Loop(
                first=self.crank_angle(first),
                second=self.crank_angle(second),
                way=second - first,
                y=float(at.imag),
                height=height,
                width=width,
                area=float(area),
                in_soil=bool(at.imag < self.curve.surface[0]),
            )
            for (first, second), at, area, height, width in zip(
                ways.tolist(), crossing, areas, *extents, strict=True
            )
        ]

    def _areas(self, ways: Array) -> Array:
        """Areas (L,), m2, that the path goes around between ways (L, 2).

        Most of what loops go around is common to many, so that each piece of the path is followed
        once; only the ends of a loop, from and to the next break, are its own.
        """
        breaks = self.breaks(0.0, 2 * self.curve.period, len(self.curve.theta) // 4)
        inside = np.searchsorted(breaks, ways[:, 0]), np.searchsorted(breaks, ways[:, 1]) - 1
        starts, own, along = self._swept(breaks[:-1], breaks[1:])
        first, second = ways.T
        begin = np.minimum(breaks[inside[0]], second)
        end = np.maximum(breaks[inside[1]], begin)
        origins = self.place(first)
        total = np.zeros(len(ways))
        for low, high in ((first, begin), (end, second)):
            corners, areas, chords = self._swept(low, high)
            total += areas + kernels.cross(corners - origins, chords)
        for k, (i, j) in enumerate(zip(*inside, strict=True)):
            total[k] += np.sum(own[i:j] + kernels.cross(starts[i:j] - origins[k], along[i:j]))
        return np.abs(total) / 2

    def _swept(self, low: Array, high: Array) -> tuple[Array, Array, Array]:
        """Of pieces from ways `low` to `high` (N,): where they begin (N,), m, twice the areas (N,)
        that lines from there sweep, m2, and how far they lead (N,), m.
        """
        starts, ends = self.place(low), self.place(high)
        areas = [np.empty(0)]
        for k in range(0, len(low), PIECES):
            part = slice(k, k + PIECES)

            def sweeping(way: Array, origins: Array = starts[part, None]) -> Array:
                return np.asarray(kernels.cross(self.place(way) - origins, self.rate(way)))

            areas.append(integral(sweeping, np.stack([low[part], high[part]], axis=-1)))
        return starts, np.concatenate(areas), ends - starts

    def _extent(self, first: Array, second: Array, axis: str) -> Array:
        """Width or height (L,), m, of the path between ways `first` and `second` (L,)."""

        def part(way: Array, sign: int) -> Any:
            return sign * getattr(self.place(way), axis)

        least, most = (
            lowest_within(partial(part, sign=sign), first, second)[0] for sign in (1, -1)
        )
        return np.asarray(-most - least)


def _among(pairs: list[tuple[float, float]], first: float, second: float) -> bool:
    """Whether one of some rising pairs is this one, but for rounding."""
    close = takewhile(lambda pair: first - pair[0] < 1e-9, reversed(pairs))
    return any(first - a + abs(second - b) < 1e-9 for a, b in close)


def _crowded(middles: Array, step: float) -> Array:
    """Ways about each of some ways, at distances halved again and again."""
    distances = step * 0.5 ** np.arange(NEAREST)
    offsets = np.concatenate([-distances, [0.0], distances])
    nodes: Array = (middles[:, None] + offsets).ravel()
    return nodes


def _crossing_pairs(nodes: Array, places: Array, cycle: int) -> Array:
    """Ways (C, 2) at which the lines between nodes cross, with the first in the first cycle."""
    starts, ends = places[:-1], places[1:]
    pairs: list[tuple[int, int]] = []
    for i in range(cycle):
        last = min(i + cycle, len(starts))
        a, b = starts[i], ends[i]
        c, d = starts[i + 2 : last], ends[i + 2 : last]
        apart = (kernels.cross(b - a, c - a) > 0) != (kernels.cross(b - a, d - a) > 0)
        across = (kernels.cross(d - c, a - c) > 0) != (kernels.cross(d - c, b - c) > 0)
        pairs += [(i, int(k)) for k in i + 2 + np.flatnonzero(apart & across)]
    middles = (nodes[1:] + nodes[:-1]) / 2
    return np.asarray(middles[np.array(pairs, int).reshape(-1, 2)])
