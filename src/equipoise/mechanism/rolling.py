"""Gears whose ratio varies: how far the driven one turns for the driver, both against the carrier.

A law takes the driver's angle x, counted on through the turns, and returns the driven gear's
angle y with its first and second derivative by x.  The first is the ratio i; the pitch point
divides the line of centres by it, and both pitch curves roll on each other there.  With the vector
c from the driven gear's axis to the driver's, that point is at c / (1 - i) from the first and at
c i / (1 - i) from the second: so the ratio tells both curves, and the driver's curve the ratio.
Every pair here meshes from outside; its ratio is negative.

Formulas: ``docs/theory.md``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.mechanism.curves import Array, Curve, spline

Levels = tuple[Array, Array, Array]
"""Value, first and second derivative."""
Profile = Callable[[Array], Levels]
"""What repeats with the lobes of a gear."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)


@dataclass(frozen=True)
class Waves:
    """1 and a Fourier series: of the k-th cosine and sine there are k ``lobes`` waves in a turn."""

    cosines: tuple[float, ...]
    sines: tuple[float, ...]
    lobes: int = 1

    def __call__(self, x: Array) -> Levels:
        levels = [np.ones_like(x), np.zeros_like(x), np.zeros_like(x)]
        for shares, turned in ((self.cosines, 0.0), (self.sines, np.pi / 2)):
            for k, share in enumerate(shares, 1):
                order = k * self.lobes
                for level in range(3):
                    phase = order * x - turned + level * np.pi / 2
                    levels[level] = levels[level] + share * order**level * np.cos(phase)
        return levels[0], levels[1], levels[2]


@dataclass(frozen=True)
class EccentricCircle:
    """Distance from a point inside of a circle of radius 1 to its edge, by direction.

    eccentricity : of the point, below 1; direction 0 is the way to the nearest place of the edge.
    """

    eccentricity: float

    def __call__(self, x: Array) -> Levels:
        e, cos, sin = self.eccentricity, np.cos(x), np.sin(x)
        root = np.sqrt(1 - (e * sin) ** 2)
        first = e * sin - e * e * sin * cos / root
        bend = e * e * (cos * cos - sin * sin) / root + (e * e * sin * cos) ** 2 / root**3
        return root - e * cos, first, e * cos - bend


@dataclass(frozen=True, eq=False)
class Tabled:
    """The cubic spline through the rows of a table, whose first angle is `origin`."""

    spline: Curve
    origin: float

    @classmethod
    def through(cls, angles: Sequence[float], values: Sequence[float], period: float) -> Tabled:
        ways = np.append(np.subtract(angles, angles[0]), period)
        return cls(spline(ways, np.append(values, values[0]), 3), angles[0])

    @property
    def knots(self) -> Array:
        """Angles of the rows, and that at which the first comes again."""
        return self.origin + self.spline.knots

    def __call__(self, x: Array) -> Levels:
        return self.spline.at(x - self.origin)


@dataclass(frozen=True)
class HalfAngle:
    """y = mean x + (2 share / lobes) arg(1 + depth exp(i lobes x)), with x counted from zero.

    Of a pair of ellipses that is the tangent of half an angle times a factor, as of anomalies.
    """

    mean: float
    share: Any
    depth: Any
    lobes: int
    zero: Any = 0.0

    @classmethod
    def ellipses(cls, eccentricity: Any, mean: float, lobes: int) -> HalfAngle:
        """The driver's radius is p / (1 + eccentricity cos(lobes angle)): about its focus, with
        one lobe.
        """
        root = (1 - eccentricity**2 * (1 - mean * mean)) ** 0.5
        depth = eccentricity * (1 - mean) / (1 + root)
        return cls(mean, -mean, depth, lobes)

    @classmethod
    def limacon(cls, eccentricity: Any, mean: float, lobes: int) -> HalfAngle:
        """The driver's radius is r (1 - eccentricity cos(lobes angle))."""
        still = 1 - eccentricity**2
        inner = 1 - 1 / (1 - mean) ** 2
        radius = inner / (1 + (1 - still * inner) ** 0.5)  # over the distance of the centres
        wave = eccentricity * radius / (1 - radius)
        return cls(mean, 1 - mean, wave / (1 + (1 - wave * wave) ** 0.5), lobes)

    def __call__(self, x: Any) -> tuple[Any, Any, Any]:
        x = x - self.zero
        z = self.depth * np.exp(1j * self.lobes * x)
        part = 1 / (1 + z)
        y = self.mean * x + (2 / self.lobes) * self.share * np.angle(1 + z)
        first = self.mean + 2 * self.share * (z * part).real
        return y, first, -2 * self.lobes * self.share * (z * part * part).imag


@dataclass(frozen=True)
class RatioCurve:
    """The ratio is a factor times a curve over the driver's angle."""

    curve: Profile
    factor: float

    def __call__(self, x: Array) -> tuple[Array, Array]:
        value, slope, _ = self.curve(x)
        return self.factor * value, self.factor * slope

    @classmethod
    def closing(cls, curve: Profile, mean: float, knots: Array) -> RatioCurve:
        """The factor with which the ratio has its mean."""
        return cls(curve, mean * (knots[-1] - knots[0]) / np.sum(_pieces(curve, knots)))


@dataclass(frozen=True)
class PitchCurve:
    """The driver's radius is a curve over the direction in its axes, against which it turns.

    factor : of the curve, over the distance of the centres, negative.
    """

    curve: Profile
    factor: float

    def __call__(self, x: Array) -> tuple[Array, Array]:
        radius, slope, _ = self.curve(-x)
        rest = 1 / (1 + self.factor * radius)
        return self.factor * radius * rest, -self.factor * slope * rest * rest

    @classmethod
    def closing(cls, curve: Profile, mean: float, knots: Array) -> PitchCurve:
        """The factor with which the driven gear's curve closes after whole turns.

        The mean ratio rises with it, ever less steeply, so that Newton's method comes from below.
        """
        period = knots[-1] - knots[0]
        at, weights = _nodes(knots)
        radius, _, _ = curve(-at)
        factor = mean / (1 - mean) * period / np.sum(weights * radius)
        most = -1 / float(np.max(radius))  # where the driver's curve reaches the other axis

        def missing(one: float) -> float:
            rest = 1 + one * radius
            return float(np.sum(weights * one * radius / rest) / period - mean)

        factor = max(factor, 0.5 * most)
        while missing(factor) > 0:
            factor = 0.5 * (factor + most)
        for _ in range(60):
            rest = 1 + factor * radius
            step = missing(factor) * period / float(np.sum(weights * radius / rest**2))
            factor -= step
            if abs(step) <= 1e-15 * abs(factor):
                break
        return cls(curve, float(factor))


@dataclass(frozen=True, eq=False)
class Summed:
    """Any ratio, summed by Gauss's quadrature over the pieces of a period between its knots.

    knots, sums : (K + 1,) angles of the driver, and how far the driven gear has come there.
    """

    mean: float
    rate: RatioCurve | PitchCurve
    knots: Array
    sums: Array
    zero: Any = 0.0

    @classmethod
    def of(cls, mean: float, rate: RatioCurve | PitchCurve, knots: Array) -> Summed:
        return cls(mean, rate, knots, np.append(0.0, np.cumsum(_pieces(rate, knots))))

    def __call__(self, x: Any) -> tuple[Any, Any, Any]:
        x = np.asarray(x - self.zero)
        begin, period = self.knots[0], self.knots[-1] - self.knots[0]
        rounds = np.floor((x - begin) / period)
        at = x - rounds * period
        k = np.clip(np.searchsorted(self.knots, at, "right") - 1, 0, len(self.knots) - 2)
        half = 0.5 * (at - self.knots[k])
        values, _ = self.rate(self.knots[k][..., None] + half[..., None] * (1 + NODES))
        y = self.mean * period * rounds + self.sums[k] + half * (values @ WEIGHTS)
        return (y, *self.rate(at))


Rolling = HalfAngle | Summed
"""How far the driven gear turns by the driver's angle."""


def _nodes(knots: Array) -> tuple[Array, Array]:
    """Places and weights (K, 12) of the quadrature over all pieces."""
    half = 0.5 * np.diff(knots)[:, None]
    return knots[:-1, None] + half * (1 + NODES), half * WEIGHTS


def _pieces(curve: Callable[[Array], Any], knots: Array) -> Array:
    """What a curve, the first value of what it gives, sums up to in each piece (K,)."""
    at, weights = _nodes(knots)
    return np.asarray(np.sum(weights * curve(at)[0], axis=1))
