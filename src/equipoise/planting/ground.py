"""Loops and cusps of the tip's path over ground, and where that path is smooth.

Everything runs in the sense of time: ``way`` is the crank angle that the drive has turned, counted
positive whichever way it turns.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np

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
        """Place over ground, m, complex, (1, K); over the machine's place at crank angle 0."""
        return self.curve.at(self.sense * way).place + self.drive * way

    def rate(self, way: Array) -> Array:
        """Its derivative, m, complex, (1, K)."""
        return self.sense * self.curve.at(self.sense * way).place_1 + self.drive

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

    def breaks(self, start: float, stop: float) -> Array:
        """Ways (B,) from start to stop between which the path bends gently: they crowd about
        places where it is slow.
        """
        period = self.curve.period
        around = self.slow + period * np.floor((start - self.slow) / period)
        slow = np.concatenate([around + period * k for k in range(3)], axis=None)
        step = period / len(self.curve.theta) * 8
        near = _crowded(slow, step)
        inner = np.concatenate([np.linspace(start, stop, 25), near])
        return np.unique(inner[(inner >= start) & (inner <= stop)])

    def loops(self) -> tuple[Loop, ...]:
        """Every self-crossing of the path within one cycle, in the order of time."""
        if not self.drive:
            return ()
        nodes = self._nodes()
        places = self.place(nodes[None])[0]
        cycle = int(np.searchsorted(nodes, self.curve.period))
        crossed = _crossing_pairs(nodes, places, cycle)
        pairs = [pair for pair in (self._polished(*ways) for ways in crossed) if pair]
        found: list[tuple[float, float]] = []
        for first, second in sorted(pairs):
            inside = -1e-12 <= first < self.curve.period - 1e-12
            apart = inside and 1e-7 < second - first < self.curve.period
            if apart and not any(abs(first - a) + abs(second - b) < 1e-9 for a, b in found):
                found.append((first, second))
        loops = (self._loop(first, second) for first, second in found)
        smallest = SMALLEST_LOOP * float(self.curve.highest[0][0] - self.curve.lowest[0][0])
        return tuple(loop for loop in loops if loop.height + loop.width > smallest)

    def _nodes(self) -> Array:
        """Ways over two cycles at which the path is sampled: crowded where it is slow."""
        step = max(self.samples[1], 2 * self.curve.period / MOST_NODES)
        once = np.arange(0.0, self.curve.period, step)
        near = np.mod(_crowded(self.slow, step), self.curve.period)
        once = np.unique(np.concatenate([once, near]))
        return np.concatenate([once, once + self.curve.period])

    def _polished(self, first: float, second: float) -> tuple[float, float] | None:
        """Newton's method on the two components of the way between both passes.

        At a cusp it creeps towards a single instant: then there is no crossing.
        """
        ways = np.array([[first, second]])
        for _ in range(MOST_STEPS):
            gap = np.diff(self.place(ways)[0])[0]
            one, other = self.rate(ways)[0]
            turn = kernels.cross(one, other)
            if not abs(turn) > 0:
                break
            step = np.array([kernels.cross(gap, other), kernels.cross(gap, one)]) / turn
            ways = ways + step
            if np.max(np.abs(step)) < CLOSED:
                return float(ways[0, 0]), float(ways[0, 1])
        return None

    def _loop(self, first: float, second: float) -> Loop:
        breaks = self.breaks(first, second)
        origin = self.place(np.array([[first]]))[0, 0]
        swept = integral(
            lambda way: kernels.cross(self.place(way) - origin, self.rate(way)), breaks[None]
        )
        height, width = (self._extent(first, second, axis) for axis in ("imag", "real"))
        return Loop(
            first=self.crank_angle(first),
            second=self.crank_angle(second),
            way=second - first,
            y=float(origin.imag),
            height=height,
            width=width,
            area=abs(float(swept[0])) / 2,
            in_soil=bool(origin.imag < self.curve.surface[0]),
        )

    def _extent(self, first: float, second: float, axis: str) -> float:
        ends = np.array([first]), np.array([second])

        def part(way: Array, sign: int) -> Any:
            return sign * getattr(self.place(way), axis)

        least, most = (lowest_within(partial(part, sign=sign), *ends)[0] for sign in (1, -1))
        return float(-most[0] - least[0])


def _crowded(middles: Array, step: float) -> Array:
    """Ways about each of some ways, at distances halved again and again."""
    distances = step * 0.5 ** np.arange(NEAREST)
    offsets = np.concatenate([-distances, [0.0], distances])
    near: Array = (middles[:, None] + offsets).ravel()
    return near


def _crossing_pairs(nodes: Array, places: Array, cycle: int) -> list[tuple[float, float]]:
    """Ways at which the lines between nodes cross, with the first in the first cycle."""
    starts, ends = places[:-1], places[1:]
    pairs = []
    for i in range(cycle):
        last = min(i + cycle, len(starts))
        a, b = starts[i], ends[i]
        c, d = starts[i + 2 : last], ends[i + 2 : last]
        apart = (kernels.cross(b - a, c - a) > 0) != (kernels.cross(b - a, d - a) > 0)
        across = (kernels.cross(d - c, a - c) > 0) != (kernels.cross(d - c, b - c) > 0)
        pairs += [(i, int(k)) for k in i + 2 + np.flatnonzero(apart & across)]
    middles = (nodes[1:] + nodes[:-1]) / 2
    return [(float(middles[i]), float(middles[k])) for i, k in pairs]
