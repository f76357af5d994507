"""Piecewise curves with exact derivatives, and the normalised motion laws made of them.

A piece is a polynomial and one sine wave of the way from its beginning, so that laws that differ
in their formulas are one table, evaluated alike.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from itertools import pairwise
from math import cos, factorial, pi, sin
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.formulas.curve_kernels import piece_value

Array = np.ndarray[Any, Any]

MOST_POWERS = 8
"""Coefficients of the polynomial of a piece."""
ORDERS = 5
"""Derivatives that are looked at for jumps, the curve itself among them."""
ROUNDING = 1e-9
"""Of the whole way: a knot belongs to the piece behind it, whatever its rounding."""
JUMP = 1e-6
"""Of the largest value of a derivative: what is more than rounding."""


def direction(vector: Any) -> Any:
    """Angle of a vector, rad, within half a turn of 0; also of terms, which `np.angle` refuses."""
    return np.arctan2(vector.imag, vector.real)


@dataclass(frozen=True, eq=False)
class PeriodicCurve:
    """A curve y(x) in K pieces, from 0 to `length`; beyond, it goes on periodically.

    knots : (K + 1,) ends of the pieces, from 0 on.
    powers : (K, MOST_POWERS) coefficients of t**0, t**1, ..., t counted from the piece's beginning.
    waves : (K, 3) amplitude, rate and phase of the sine that is added.
    """

    knots: Array
    powers: Array
    waves: Array

    @property
    def length(self) -> float:
        return float(self.knots[-1])

    @cached_property
    def rise(self) -> float:
        """By how much the curve is higher after its whole length."""
        return float(self._ends[0, 1, -1] - self._ends[0, 0, 0])

    def at(self, x: Any) -> tuple[Array, Array, Array]:
        """y and its two derivatives by x, each as `x` (...)."""
        rounds, piece, way = self.place(x)
        amplitude, rate, phase = np.moveaxis(self.waves[piece], -1, 0)
        turned = rate * way + phase
        powers = np.moveaxis(self.powers[piece], -1, 0)
        wave = amplitude, rate, np.cos(turned), np.sin(turned)
        y, y1, y2 = piece_value(way, *powers, *wave)  # type: ignore[call-arg,no-untyped-call]
        return y + self.rise * rounds, y1, y2

    def place(self, x: Any) -> tuple[Array, Array, Array]:
        """Rounds before x, and of what is left the piece and the way into it, as `x` (...)."""
        x = np.asarray(x, dtype=float)
        tolerance = ROUNDING * self.length
        rounds = np.floor((x + tolerance) / self.length)
        since = x - rounds * self.length
        piece = np.searchsorted(self.knots[1:-1], since + tolerance, side="right")
        return rounds, piece, since - self.knots[piece]

    def jumps(self, order: int) -> Array:
        """Where within the length the derivative of this order jumps, rising (J,)."""
        left, right = self._ends[order]
        before = np.roll(right, 1)
        if order == 0:
            before[0] -= self.rise
        # what a derivative may reach, where it is zero at all knots
        usual = (np.ptp(self._ends[0]) + np.max(abs(self.waves[:, 0]))) / self.length**order
        size = max(float(np.max(np.abs(self._ends[order]))), usual)
        return np.asarray(self.knots[:-1][np.abs(left - before) > JUMP * size])

    @cached_property
    def extremes(self) -> tuple[float, float]:
        """Smallest and largest y in the length, to about ten digits."""
        return tuple(self._extreme(sense) for sense in (-1.0, 1.0))  # type: ignore[return-value]

    def _extreme(self, sense: float) -> float:
        x = np.unique(
            np.add.outer(self.knots[:-1], np.linspace(0, 1, 33)[:-1] * self._widths[:, None])
        )
        best = x[int(np.argmax(sense * self.at(x)[0]))]
        width = float(np.max(self._widths)) / 32
        for _ in range(3):
            samples = best + np.linspace(-width, width, 65)
            best = samples[int(np.argmax(sense * self.at(samples)[0]))]
            width /= 24
        return float(self.at(best)[0])

    @property
    def _widths(self) -> Array:
        return np.diff(self.knots)

    @cached_property
    def _ends(self) -> Array:
        """Derivatives (ORDERS, 2, K) of each piece at its beginning and its end."""
        pieces = np.arange(len(self.powers))
        sides = (np.zeros(len(pieces)), self._widths)
        return np.array(
            [[self.value(pieces, way, order) for way in sides] for order in range(ORDERS)]
        )

    def value(self, piece: Array, way: Array, order: int) -> Array:
        """Derivative of an order, at ways into pieces."""
        value = np.zeros(np.shape(way))
        for power in range(self._degree, order - 1, -1):
            factor = factorial(power) / factorial(power - order)
            value = value * way + factor * self.powers[piece, power]
        if not self._waved:
            return value
        amplitude, rate, phase = np.moveaxis(self.waves[piece], -1, 0)
        turned = rate * way + phase + order * (pi / 2)
        wave: Array = value + amplitude * rate**order * np.sin(turned)
        return wave

    @cached_property
    def _degree(self) -> int:
        """Highest power that any piece has."""
        return int(np.max(np.flatnonzero(np.any(self.powers, axis=0)), initial=0))

    @cached_property
    def _waved(self) -> bool:
        return bool(np.any(self.waves[:, 0]))

    def summed(self) -> PeriodicCurve:
        """What a curve of polynomials sums up to, from 0 on."""
        powers = np.zeros_like(self.powers)
        powers[:, 1:] = self.powers[:, :-1] / np.arange(1, MOST_POWERS)
        pieces = PeriodicCurve(self.knots, powers, self.waves)
        ends = pieces.value(np.arange(len(powers)), self._widths, 0)
        powers[1:, 0] = np.cumsum(ends[:-1])
        return PeriodicCurve(self.knots, powers, self.waves)

    def stretched(self, length: float, rise: float) -> PeriodicCurve:
        """Curve over another length, and higher by a factor."""
        exponents = np.arange(MOST_POWERS)
        return PeriodicCurve(
            self.knots * length,
            self.powers * rise / length**exponents,
            self.waves * [rise, 1 / length, 1.0],
        )

    def lifted(self, by: float) -> PeriodicCurve:
        """Curve raised by a constant."""
        powers = self.powers.copy()
        powers[:, 0] += by
        return PeriodicCurve(self.knots, powers, self.waves)


@dataclass(frozen=True, eq=False)
class Curves:
    """Curves of the same knots, one for each row of what they are asked at, (..., P, N).

    one : tells the knots.  every : pieces of all, one curve after the other.
    begins, rises : (P, 1) first piece of each in `every`, and its rise.
    """

    one: PeriodicCurve
    every: PeriodicCurve
    begins: Array
    rises: Array

    @classmethod
    def of(cls, curves: Sequence[PeriodicCurve]) -> Curves:
        """Raises a `ValueError` where their knots differ."""
        curve = curves[0]
        if any(not np.array_equal(other.knots, curve.knots) for other in curves):
            raise ValueError
        powers, waves = (
            np.concatenate([getattr(c, n) for c in curves]) for n in ("powers", "waves")
        )
        begins = len(curve.powers) * np.arange(len(curves))
        rises = np.array([other.rise for other in curves])
        return cls(
            curve, PeriodicCurve(curve.knots, powers, waves), begins[:, None], rises[:, None]
        )

    def at(self, x: Any) -> tuple[Array, Array, Array]:
        """y and its two derivatives by x, each as `x`."""
        rounds, piece, way = self.one.place(x)
        y, y1, y2 = (self.every.value(piece + self.begins, way, order) for order in range(3))
        return y + self.rises * rounds, y1, y2


def joined(curves: Sequence[PeriodicCurve]) -> PeriodicCurve:
    """Curves one after the other."""
    begins = np.cumsum([0.0, *(curve.length for curve in curves)])
    knots = [curve.knots[:-1] + begin for curve, begin in zip(curves, begins, strict=False)]
    return PeriodicCurve(
        np.concatenate([*knots, begins[-1:]]),
        np.concatenate([curve.powers for curve in curves]),
        np.concatenate([curve.waves for curve in curves]),
    )


# -- normalised laws -------------------------------------------------------------------------------

Run = tuple[float, float, float, bool]
"""Of an acceleration: width; from where to where, phases of a sine if the last is true, else
levels with a straight line between."""


def _polynomial(*powers: float) -> PeriodicCurve:
    filled = np.zeros((1, MOST_POWERS))
    filled[0, : len(powers)] = powers
    return PeriodicCurve(np.array([0.0, 1.0]), filled, np.zeros((1, 3)))


def _accelerated(*runs: Run) -> PeriodicCurve:
    """The curve from 0 to 1, from rest to rest, whose acceleration has this shape."""
    place = speed = 0.0
    powers, waves = np.zeros((len(runs), MOST_POWERS)), np.zeros((len(runs), 3))
    for k, (width, begin, end, is_wave) in enumerate(runs):
        if is_wave:
            rate = (end - begin) / width
            powers[k, :2] = place + sin(begin) / rate**2, speed + cos(begin) / rate
            waves[k] = -1 / rate**2, rate, begin
            place += speed * width + cos(begin) * width / rate
            place += (sin(begin) - sin(end)) / rate**2
            speed += (cos(begin) - cos(end)) / rate
        else:
            slope = (end - begin) / width
            powers[k, :4] = place, speed, begin / 2, slope / 6
            place += width * (speed + width * (begin / 2 + width * slope / 6))
            speed += width * (begin + end) / 2
    knots = np.cumsum([0.0, *(run[0] for run in runs)])
    return PeriodicCurve(knots / knots[-1], powers / place, waves * [1 / place, 1.0, 1.0])


QUARTER = pi / 2
_UP, _DOWN = (1 / 8, 0.0, QUARTER, True), (1 / 8, 3 * QUARTER, 4 * QUARTER, True)
NORMAL: dict[str, Callable[[], PeriodicCurve]] = {
    "cycloidal": lambda: _accelerated((1.0, 0.0, 4 * QUARTER, True)),
    "modified sine": lambda: _accelerated(_UP, (3 / 4, QUARTER, 3 * QUARTER, True), _DOWN),
    "modified trapezoid": lambda: _accelerated(
        _UP, (1 / 4, 1.0, 1.0, False), (1 / 4, QUARTER, 3 * QUARTER, True),
        (1 / 4, -1.0, -1.0, False), _DOWN,
    ),
    "3-4-5": lambda: _polynomial(0, 0, 0, 10, -15, 6),
    "4-5-6-7": lambda: _polynomial(0, 0, 0, 0, 35, -84, 70, -20),
    "harmonic": lambda: _accelerated((1.0, QUARTER, 3 * QUARTER, True)),
    "s-curve": lambda: _accelerated(
        (1 / 12, 0.0, 1.0, False), (1 / 6, 1.0, 1.0, False), (1 / 12, 1.0, 0.0, False),
        (1 / 3, 0.0, 0.0, False),
        (1 / 12, 0.0, -1.0, False), (1 / 6, -1.0, -1.0, False), (1 / 12, -1.0, 0.0, False),
    ),
    "trapezoid": lambda: _accelerated(
        (1 / 3, 1.0, 1.0, False), (1 / 3, 0.0, 0.0, False), (1 / 3, -1.0, -1.0, False)
    ),
    "linear": lambda: _polynomial(0, 1),
}  # fmt: skip
"""Motion laws from 0 to 1 over a length of 1, by name."""


def sine(low: float, high: float, length: float) -> PeriodicCurve:
    """The sine that rises from `low`, where it rests, to `high` and comes back."""
    powers = np.zeros((1, MOST_POWERS))
    powers[0, 0] = (low + high) / 2
    wave = [[(low - high) / 2, 2 * pi / length, pi / 2]]
    return PeriodicCurve(np.array([0.0, length]), powers, np.array(wave))


def spline(knots: Array, values: Array, degree: int) -> PeriodicCurve:
    """The periodic spline of an odd degree through values (K + 1,) at knots (K + 1,) from 0 on.

    All derivatives but the highest go on through the knots, and from the end to the beginning; the
    values themselves are higher there by what the last is above the first.  Its unknowns are the
    lower derivatives at the knots; the others' continuity gives as many equations.
    """
    half, count = degree // 2, len(knots) - 1
    orders = np.arange(degree + 1)
    ends = np.array(
        [[[_slope(i, j) * (end or i == j) for i in range(degree + 1)] for j in range(degree + 1)]
         for end in (0, 1)]
    )  # fmt: skip
    # from derivatives 0..half at both ends of a piece of length 1 to its coefficients
    hermite = np.linalg.inv(np.concatenate([ends[0, : half + 1], ends[1, : half + 1]]))
    widths = np.diff(knots)
    scales = widths[:, None] ** np.tile(np.arange(half + 1), 2)
    of_piece = hermite * scales[:, None, :] / widths[:, None, None] ** orders[:, None]
    lengths = widths[:, None, None] ** orders[None, :, None]
    higher = [
        np.einsum("ji,kic->kjc", end[half + 1 : degree], of_piece * lengths)
        / widths[:, None, None] ** orders[half + 1 : degree, None]
        for end in ends
    ]
    matrix, right = np.zeros((count, half, count, half)), np.zeros((count, half))
    for k, (before, after) in enumerate(pairwise([count - 1, *range(count)])):
        for piece, side, sign in ((before, 1, 1.0), (after, 0, -1.0)):
            rows = sign * higher[side][piece]
            matrix[k, :, piece] += rows[:, 1 : half + 1]
            matrix[k, :, (piece + 1) % count] += rows[:, half + 2 :]
            right[k] -= rows[:, 0] * values[piece] + rows[:, half + 1] * values[piece + 1]
    flat = np.linalg.solve(matrix.reshape(count * half, -1), right.ravel())
    slopes = flat.reshape(count, half)
    known = np.concatenate(
        [values[:-1, None], slopes, values[1:, None], np.roll(slopes, -1, axis=0)], axis=1
    )
    powers = np.zeros((count, MOST_POWERS))
    powers[:, : degree + 1] = np.einsum("kic,kc->ki", of_piece, known)
    return PeriodicCurve(knots, powers, np.zeros((count, 3)))


def _slope(power: int, order: int) -> float:
    """Factor of t**power in its derivative of an order, at t = 1."""
    return factorial(power) / factorial(power - order) if power >= order else 0.0
