"""Smooth curves in the plane through given points, with three derivatives.

A curve is a quintic spline of its parameter, so that four derivatives are continuous: a pin that
runs along it has an acceleration, and by that forces, whose first two derivatives do not jump.
The parameter is the length of the chords between the points; of a closed curve it is scaled to an
angle, 2 pi all the way round.

An open curve ends as the polynomials beside its ends go on (not-a-knot), so that a circle or a line
keeps its order there; through fewer than six points goes the one polynomial.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, lru_cache
from math import factorial, tau
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.formulas.curve_kernels import plane_piece

Array = np.ndarray[Any, Any]

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
        value: Array = plane_piece(s - knots[piece], *np.moveaxis(powers[piece], -1, 0))[0]  # type: ignore[no-untyped-call]
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
        levels: tuple[Array, Array, Array, Array] = plane_piece(s - self.knots[piece], *powers)  # type: ignore[no-untyped-call]
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
