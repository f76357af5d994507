"""Piecewise curves with exact derivatives, motion laws made of them, and curves in the plane.

A piece is a polynomial and one sine wave of the way from its beginning, so that laws that differ
in their formulas are one table, evaluated alike.

A curve is a quintic spline of its parameter, so that four derivatives are continuous: a pin that
runs along it has an acceleration, and by that forces, whose first two derivatives do not jump.
The parameter is the length of the chords between the points; of a closed curve it is scaled to an
angle, 2 pi all the way round.

An open curve ends as the polynomials beside its ends go on (not-a-knot), so that a circle or a line
keeps its order there; through fewer than six points goes the one polynomial.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache
from itertools import pairwise
from math import cos, factorial, pi, sin, tau
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.formulas.kernels import piece_value, plane_piece
from equipoise.signals import Array

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
        y, y1, y2 = piece_value(way, *powers, *wave)  # type: ignore[call-arg]
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

    first : has the knots.  every : pieces of all, one curve after the other.
    begins, rises : (P, 1) first piece of each in `every`, and its rise.
    """

    first: PeriodicCurve
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
        rounds, piece, way = self.first.place(x)
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

AccelerationRun = tuple[float, float, float, bool]
"""Of an acceleration: width; from where to where, phases of a sine if the last is true, else
levels with a straight line between."""


def _polynomial(*powers: float) -> PeriodicCurve:
    filled = np.zeros((1, MOST_POWERS))
    filled[0, : len(powers)] = powers
    return PeriodicCurve(np.array([0.0, 1.0]), filled, np.zeros((1, 3)))


def _accelerated(*runs: AccelerationRun) -> PeriodicCurve:
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


DEGREE = 5
SAMPLES = 32
"""Of each piece, where the nearest or the sharpest place is looked for."""
REFINED = 20
"""Steps of Newton's method to the nearest place, which halve where they go too far."""
ARCS, FEWEST_ARCS = 4, 40
"""Parts of a piece, and of the whole, at the ends of which the arc length is exact."""
STRAIGHT = 1e-9
"""Largest curvature times length that is rounding, of a straight line."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)
"""Enough for the arc length of a piece to rounding, where it does not all but stand still."""
HERMITE = np.array([
    [1, 0, 0, -10, 15, -6],
    [0, 1, 0, -6, 8, -3],
    [0, 0, 0.5, -1.5, 1.5, -0.5],
    [0, 0, 0, 10, -15, 6],
    [0, 0, 0, -4, 7, -3],
    [0, 0, 0, 0.5, -1, 0.5],
])  # fmt: skip
"""Between 0 and 1, by powers: what value and two derivatives at 0, then at 1, contribute."""


@dataclass(frozen=True, eq=False)
class PlaneCurve:
    """A curve in K pieces by its parameter.

    knots : (K + 1,) ends of the pieces, from 0 on.
    powers : (K, 6) complex coefficients of t**0, t**1, ..., t counted from the piece's beginning.
    closed : whether it ends where it begins, and the parameter is an angle.
    """

    knots: Array
    powers: Array
    closed: bool

    @property
    def ends(self) -> tuple[float, float] | None:
        """Parameters of both ends; None of a closed curve."""
        return None if self.closed else (float(self.knots[0]), float(self.knots[-1]))

    @cached_property
    def arcs(self) -> tuple[Array, Array]:
        """Knots (A + 1,), of which several lie in a piece, and coefficients (A, 6) between them of
        the arc length from the curve's beginning, m: exact with two derivatives at the knots.
        """
        parts = max(ARCS, -(-FEWEST_ARCS // len(self.powers)))
        share = np.arange(parts) / parts
        inner = self.knots[:-1, None] + np.diff(self.knots)[:, None] * share
        knots = np.append(inner.ravel(), self.knots[-1])
        half = 0.5 * np.diff(knots)
        nodes = (knots[:-1] + half)[:, None] + half[:, None] * NODES
        whole = np.cumsum(np.append(0.0, half * (np.abs(self.at(nodes)[1]) @ WEIGHTS)))
        _, c1, c2, _ = self.at(knots)
        pace = np.abs(c1)
        levels = np.transpose([whole, pace, (np.conj(c1) * c2).real / pace])
        data = np.concatenate([levels[:-1], levels[1:]], axis=1)
        return knots, _hermite(data, 2 * half)

    @cached_property
    def length(self) -> float:
        """Arc length of the whole, m."""
        knots, powers = self.arcs
        last = float(knots[-1] - knots[-2])
        return float(np.polynomial.polynomial.polyval(last, powers[-1]))

    def distance(self, s: Any) -> Array:
        """Arc length from the beginning, m, at parameters (...)."""
        s, _ = self.place(s)
        knots, powers = self.arcs
        piece = np.searchsorted(knots[1:-1], s, side="right")
        value: Array = plane_piece(s - knots[piece], *np.moveaxis(powers[piece], -1, 0))[0]
        return value

    def place(self, s: Any) -> tuple[Array, Array]:
        """Parameters (...), of a closed curve within one round, and the piece of each."""
        s = np.asarray(s, dtype=float)
        s = s - tau * np.floor(s / tau) if self.closed else s
        return s, np.searchsorted(self.knots[1:-1], s, side="right")

    def turned(self, rotation: Any) -> Any:
        """The parameter of a closed curve, of which exp(i s) is known."""
        return np.angle(rotation)

    def at(self, s: Any) -> tuple[Array, Array, Array, Array]:
        """Place and its first three derivatives by the parameter, complex, each as `s` (...)."""
        s, piece = self.place(s)
        powers = np.moveaxis(self.powers[piece], -1, 0)
        levels: tuple[Array, Array, Array, Array] = plane_piece(s - self.knots[piece], *powers)
        return levels

    @cached_property
    def samples(self) -> Array:
        """Parameters (S,) close to each other, from end to end."""
        share = np.arange(SAMPLES) / SAMPLES
        inner = self.knots[:-1, None] + np.diff(self.knots)[:, None] * share
        return np.append(inner.ravel(), self.knots[-1])

    def nearest(self, place: Any) -> Array:
        """Parameter of the nearest place of the curve, of places (...), complex."""
        place = np.asarray(place, dtype=complex)
        there = self.at(self.samples)[0]
        s: Array = self.samples[np.argmin(np.abs(there - place[..., None]), axis=-1)]
        most = float(np.max(np.diff(self.samples)))
        for _ in range(REFINED):
            c, c1, c2, _ = self.at(s)
            way = c - place
            slope = np.abs(c1) ** 2 + (np.conj(c2) * way).real
            step = (np.conj(c1) * way).real / np.where(slope > 0, slope, np.abs(c1) ** 2)
            s = s - np.clip(step, -most, most)
        return s

    @cached_property
    def sharpest(self) -> tuple[float, float]:
        """Smallest radius of curvature, m, and how far along the curve it is, m; infinite of a
        straight line.
        """
        _, c1, c2, _ = self.at(self.samples[: -1 if self.closed else None])
        bend = np.abs((np.conj(c1) * c2).imag) / np.maximum(np.abs(c1), 1e-300) ** 3
        at = int(np.argmax(bend))
        straight = bend[at] * self.length < STRAIGHT
        radius = float("inf") if straight else float(1 / bend[at])
        return radius, float(self.distance(self.samples[at]))


@lru_cache(128)
def curve_through(points: tuple[tuple[float, float], ...], closed: bool) -> PlaneCurve:
    """The curve through points, m, in their order; two at least, four of a closed one, of which no
    two that follow each other coincide.
    """
    places = np.array(points) @ np.array([1, 1j])
    if closed:
        places = np.append(places, places[0])
    knots = np.append(0.0, np.cumsum(np.abs(np.diff(places))))
    if closed:
        knots *= tau / knots[-1]
        knots[-1] = tau
    return _spline(knots, places, closed)


def _spline(knots: Array, places: Array, closed: bool) -> PlaneCurve:
    """The quintic spline through places at knots (K + 1,)."""
    count = len(places)
    if not closed and count <= DEGREE + 1:
        unit = float(knots[-1])
        powers = np.zeros((1, DEGREE + 1), complex)
        powers[0, :count] = np.linalg.solve(np.vander(knots / unit, increasing=True), places)
        ends = np.array([0.0, unit])
        return PlaneCurve(ends, powers / unit ** np.arange(DEGREE + 1), False)
    unit = float(knots[-1]) / (count - 1)  # so that the pieces' lengths are about 1
    widths = np.diff(knots) / unit
    slopes = _slopes(widths, places, closed)
    slopes = slopes / unit ** np.arange(1, 3)
    data = np.concatenate([places[:-1, None], slopes[:-1], places[1:, None], slopes[1:]], axis=1)
    return PlaneCurve(knots, _hermite(data, np.diff(knots)), closed)


def _hermite(data: Array, widths: Array) -> Array:
    """Coefficients (K, 6) from value and two derivatives at the beginning and the end of pieces."""
    scaled = data * widths[:, None] ** np.tile(np.arange(3), 2)
    return np.asarray((scaled @ HERMITE) / widths[:, None] ** np.arange(DEGREE + 1))


def _slopes(widths: Array, places: Array, closed: bool) -> Array:
    """First and second derivative (K + 1, 2) at the knots, such that the third and fourth go on
    through these; of an open curve the fifth, too, through the two beside each end.
    """
    count = len(widths)
    own = count if closed else count + 1
    matrix, right = np.zeros((2 * own, 2 * own)), np.zeros(2 * own, complex)
    inner = range(count) if closed else range(1, count)
    rows = [(knot, order) for knot in inner for order in (3, 4)]
    if not closed:
        rows += [(knot, DEGREE) for knot in (1, 2, count - 2, count - 1)]
    for row, (knot, order) in enumerate(rows):
        for piece, end, sign in ((knot - 1, 1, 1.0), (knot, 0, -1.0)):
            width = widths[piece % count]
            weights = sign * _derivative(order, end) * width ** np.tile(np.arange(3), 2)
            weights = weights / width**order
            for side, at in enumerate((piece % count, piece % count + 1)):
                value, *rest = weights[3 * side : 3 * side + 3]
                right[row] -= value * places[at]
                matrix[row, 2 * (at % own) : 2 * (at % own) + 2] += rest
    result = np.linalg.solve(matrix, right).reshape(own, 2)
    return np.append(result, result[:1], axis=0) if closed else result


def _derivative(order: int, end: int) -> Array:
    """What value and two derivatives at 0, then at 1, add to a derivative at one of both."""
    powers: Sequence[int] = range(order, DEGREE + 1) if end else (order,)
    return np.asarray(sum(HERMITE[:, k] * (factorial(k) // factorial(k - order)) for k in powers))
