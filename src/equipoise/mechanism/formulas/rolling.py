"""Gears whose ratio varies, and the straight strands of a belt.

A law takes the driver's angle x, counted on through the turns, and returns the driven gear's
angle y with its first and second derivative by x.  The first is the ratio i; the pitch point
divides the line of centres by it, and both pitch curves roll on each other there.  With the vector
c from the driven gear's axis to the driver's, that point is at c / (1 - i) from the first and at
c i / (1 - i) from the second: so the ratio gives both curves, and the driver's curve the ratio.
A ratio is negative of gears that mesh from outside, from 0 to 1 of a ring that a gear in it drives,
and above 1 of a ring that drives the gear in it.

Numbers of a law may be columns (P, 1), one for each of P designs; it then takes angles (P, K).  The
same law runs on terms: a `LawAngle` says how an angle is turned and looked up there.

Formulas: ``docs/theory.md``.

Complex vectors in the carrier's axes, m, from the driver's pin.  The left strand leaves the driver
on the left of the way to the driven pulley, the right one on its right.  Every number may be a
column.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields, is_dataclass, replace
from itertools import zip_longest
from math import pi, prod
from typing import Any, ClassVar, Literal, Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.formulas.curves import (
    MOST_POWERS,
    Curves,
    PeriodicCurve,
    direction,
    spline,
)
from equipoise.mechanism.formulas.kernels import half_angle, series_term, unit
from equipoise.signals import Array

Levels = tuple[Array, Array, Array]
"""Value, first and second derivative."""
Profile = Callable[[Array], Levels]
"""What repeats with the lobes of a gear."""
MOST_PRODUCTS = 6
"""Power of a rotation up to which it is multiplied by itself."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(5)
FEW_NODES, FEW_WEIGHTS = np.polynomial.legendre.leggauss(3)
"""Enough to rounding over a piece, and from the nearest of its ends."""


class LawAngle(Protocol):
    """The driver's angle, seen from the carrier, from the zero of a law on, as arrays or terms."""

    @property
    def angle(self) -> Any:
        """The angle itself, rad, counted on through the turns."""

    def turned(self, lobes: int) -> Any:
        """exp(i lobes angle)."""

    def direction(self, vector: Any) -> Any:
        """Angle of a vector, within half a turn of 0."""

    def curve(self, curve: Any, x: Any, factor: Any) -> Levels:
        """A periodic curve times a factor, and its two derivatives, at x."""


@dataclass(frozen=True)
class ArrayAngle:
    """A `LawAngle` of arrays."""

    angle: Any

    def turned(self, lobes: int) -> Any:
        return np.exp(1j * lobes * self.angle)

    def direction(self, vector: Any) -> Any:
        return direction(vector)

    def curve(self, curve: Any, x: Any, factor: Any) -> Levels:
        y, first, second = curve.at(x)
        return factor * y, factor * first, factor * second


class RollingLaw(ABC):
    """How far the driven gear turns by the driver's angle."""

    zero: Any
    """The driver's angle from which the law counts."""
    varied: ClassVar[tuple[str, ...]] = ("zero",)
    """Fields whose numbers designs may have of their own in compiled loops."""

    @abstractmethod
    def values(self, at: LawAngle) -> tuple[Any, Any, Any]:
        """The driven gear's angle with its two derivatives by the driver's."""

    def turn(self, at: LawAngle) -> Any:
        """Rotation of the driven gear where it is a product of few others; None elsewhere."""
        return None

    def __call__(self, x: Any) -> tuple[Any, Any, Any]:
        return self.values(ArrayAngle(x - self.zero))


@dataclass(frozen=True)
class Waves:
    """1 and a Fourier series: of the k-th cosine and sine there are k ``lobes`` waves in a turn."""

    cosines: tuple[Any, ...]
    sines: tuple[Any, ...]
    lobes: int = 1

    @property
    def terms(self) -> Iterator[tuple[Any, Any, int]]:
        """Cosine, sine and waves in a turn of each term."""
        pairs = zip_longest(self.cosines, self.sines, fillvalue=0.0)
        return ((cosine, sine, k * self.lobes) for k, (cosine, sine) in enumerate(pairs, 1))

    def __call__(self, x: Any) -> Levels:
        _, value, first = self.summed(ArrayAngle(x))
        second = 0.0 * x
        turn, wave = np.exp(1j * self.lobes * x), 1.0
        for cosine, sine, order in self.terms:
            wave = wave * turn
            second = second - order * order * ((cosine - 1j * sine) * wave).real
        return value, first, second

    def summed(self, at: LawAngle) -> Levels:
        """What it sums up to, from the mean alone on, its value and its first derivative."""
        still = 0.0 * at.angle
        levels: Any = (at.angle + still, 1.0 + still, still)
        turn, wave = at.turned(self.lobes), 1.0
        for cosine, sine, order in self.terms:
            wave = wave * turn
            levels = series_term(*levels, wave, cosine, sine, order)  # type: ignore[call-arg]
        y, value, first = levels
        return y, value, first


@dataclass(frozen=True)
class EccentricCircle:
    """Distance from a point inside of a circle of radius 1 to its edge, by direction.

    eccentricity : of the point, below 1; direction 0 is the way to the nearest place of the edge.
    """

    eccentricity: Any

    def __call__(self, x: Any) -> Levels:
        e, cos, sin = self.eccentricity, np.cos(x), np.sin(x)
        root = np.sqrt(1 - (e * sin) ** 2)
        first = e * sin - e * e * sin * cos / root
        bend = e * e * (cos * cos - sin * sin) / root + (e * e * sin * cos) ** 2 / root**3
        return root - e * cos, first, e * cos - bend


@dataclass(frozen=True, eq=False)
class Tabled:
    """The cubic spline through the rows of a table, whose first angle is `origin`."""

    spline: PeriodicCurve | Curves
    origin: Any

    @classmethod
    def through(cls, angles: Sequence[float], values: Sequence[float], period: float) -> Tabled:
        ways = np.append(np.subtract(angles, angles[0]), period)
        return cls(spline(ways, np.append(values, values[0]), 3), angles[0])

    def __call__(self, x: Any) -> Levels:
        return self.spline.at(x - self.origin)


@dataclass(frozen=True)
class HalfAngle(RollingLaw):
    """y = mean x + (2 share / lobes) arg(1 + depth exp(i lobes x)), with x counted from zero.

    Of a pair of ellipses that is the tangent of half an angle times a factor, as of anomalies.
    """

    mean: Any
    share: Any
    depth: Any
    lobes: int
    zero: Any = 0.0

    varied = ("zero", "depth")

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
        root = (1 - still * inner) ** 0.5
        # over the distance of the centres, counted towards the driven gear's axis
        radius = inner / (1 + root) if mean < 1 else (1 + root) / still
        wave = eccentricity * radius / (1 - radius)
        return cls(mean, 1 - mean, wave / (1 + (1 - wave * wave) ** 0.5), lobes)

    def values(self, at: LawAngle) -> tuple[Any, Any, Any]:
        whole, _, ratio, bend = self._parts(at)
        y = self.mean * at.angle + (2 / self.lobes) * self.share * at.direction(whole)
        return y, ratio, bend

    def turn(self, at: LawAngle) -> Any:
        times, mean = float(2 * self.share / self.lobes), float(self.mean)
        if not times.is_integer() or abs(times) > MOST_PRODUCTS:
            return None
        whole, twice, *_ = self._parts(at)
        (along,) = unit(whole)
        if mean.is_integer() and abs(mean) <= MOST_PRODUCTS and self.lobes <= MOST_PRODUCTS:
            factors = [_power(at.turned(1), mean)] * abs(round(mean))
        else:
            factors = [np.exp(1j * (mean * at.angle))]
        factors += [_power(twice, times)] * (abs(round(times)) // 2)
        factors += [_power(along, times)] * (round(times) % 2)
        return prod(factors[1:], start=factors[0])

    def _parts(self, at: LawAngle) -> tuple[Any, ...]:
        numbers = self.mean, self.share, self.depth, self.lobes
        parts: tuple[Any, ...] = half_angle(at.turned(self.lobes), *numbers)
        return parts


@dataclass(frozen=True)
class RatioWaves(RollingLaw):
    """The ratio is its mean times 1 and a Fourier series; so is its sum."""

    mean: Any
    waves: Waves
    zero: Any = 0.0

    varied = ("zero", "waves")

    def values(self, at: LawAngle) -> tuple[Any, Any, Any]:
        y, first, second = self.waves.summed(at)
        return self.mean * y, self.mean * first, self.mean * second


@dataclass(frozen=True, eq=False)
class RatioTable(RollingLaw):
    """The ratio is a factor times the spline through a table; `table` has what that sums up to."""

    factor: Any
    table: Tabled
    zero: Any = 0.0

    @classmethod
    def closing(cls, table: Tabled, mean: float) -> RatioTable:
        """The factor with which the ratio has its mean."""
        assert isinstance(table.spline, PeriodicCurve)
        whole = table.spline.summed()
        return cls(mean * whole.length / whole.rise, Tabled(whole, table.origin))

    def values(self, at: LawAngle) -> tuple[Any, Any, Any]:
        return at.curve(self.table.spline, at.angle - self.table.origin, self.factor)


@dataclass(frozen=True, eq=False)
class PitchCurve(RollingLaw):
    """The driver's radius is a curve over the direction in its axes, against which it turns.

    factor : of the curve, over the distance of the centres; negative where the driver's axis and
        the driven gear's lie on both sides of the pitch point, or the driver is a ring.
    knots, sums : (K + 1,) angles of the driver over a period, and how far the driven gear has come
        there, by Gauss's quadrature.
    """

    mean: Any
    curve: Profile
    factor: Any
    knots: Array
    sums: Array
    zero: Any = 0.0

    @classmethod
    def closing(cls, curve: Profile, mean: float, knots: Array) -> PitchCurve:
        """The factor with which the driven gear's curve closes after whole turns.

        Up to where the driver's curve reaches the other axis, the mean ratio rises with it ever
        less steeply, and beyond, of a ring, ever more: Newton's method comes from the far side.
        """
        period, half = knots[-1] - knots[0], 0.5 * np.diff(knots)[:, None]
        at, weights = knots[:-1, None] + half * (1 + NODES), half * WEIGHTS / period
        radius, _, _ = curve(-at)
        ring = mean > 1
        pole = -1 / float(np.min(radius) if ring else np.max(radius))

        def missing(factor_tried: float) -> float:
            return float(
                np.sum(weights * factor_tried * radius / (1 + factor_tried * radius)) - mean
            )

        factor = float(mean / (1 - mean) / np.sum(weights * radius))
        factor = min(factor, 2 * pole) if ring else max(factor, 0.5 * pole)
        while missing(factor) < 0 if ring else missing(factor) > 0:
            factor = 0.5 * (factor + pole)
        for _ in range(60):
            step = missing(factor) / float(np.sum(weights * radius / (1 + factor * radius) ** 2))
            factor -= step
            if abs(step) <= 1e-15 * abs(factor):
                break
        pieces = period * np.sum(weights * factor * radius / (1 + factor * radius), axis=1)
        return cls(mean, curve, factor, knots, np.append(0.0, np.cumsum(pieces)))

    def values(self, at: LawAngle) -> tuple[Any, Any, Any]:
        curve, begin = self.summed()
        return at.curve(curve, at.angle - begin, 1.0)

    def summed(self) -> tuple[PeriodicCurve, float]:
        """The driven gear's angle as pieces between the knots, to 1e-12, and where they begin."""
        half = 0.5 * np.diff(self.knots)
        at = np.cos(pi * (np.arange(MOST_POWERS - 1) + 0.5) / (MOST_POWERS - 1))
        ratio, _ = self.rate(self.knots[:-1, None] + half[:, None] * (1 + at))
        ways = np.vander(1 + at, increasing=True)
        levels = np.linalg.solve(ways, ratio.T).T / half[:, None] ** np.arange(MOST_POWERS - 1)
        powers = np.column_stack([self.sums[:-1], levels / np.arange(1, MOST_POWERS)])
        knots = self.knots - self.knots[0]
        return PeriodicCurve(knots, powers, np.zeros((len(powers), 3))), float(self.knots[0])

    def rate(self, x: Any) -> tuple[Any, Any]:
        """The ratio and its derivative."""
        radius, slope, _ = self.curve(-x)
        rest = 1 / (1 + self.factor * radius)
        return self.factor * radius * rest, -self.factor * slope * rest * rest

    def __call__(self, x: Any) -> tuple[Any, Any, Any]:
        """On arrays the quadrature goes on from the nearest knot, to rounding."""
        x = np.asarray(x - self.zero)
        begin, period = self.knots[0], self.knots[-1] - self.knots[0]
        rounds = np.floor((x - begin) / period)
        at = x - rounds * period
        k = np.searchsorted(0.5 * (self.knots[1:] + self.knots[:-1]), at)
        half = 0.5 * (at - self.knots[k])
        ways = np.append(FEW_NODES, 1.0).reshape(-1, *(1 for _ in x.shape))  # the last is x itself
        ratio, bend = self.rate(self.knots[k] + half * (1 + ways))
        come = self.sums[k] if self.sums.ndim == 1 else np.take_along_axis(self.sums, k, axis=1)
        way = half * np.tensordot(FEW_WEIGHTS, ratio[:-1], 1)
        return self.mean * period * rounds + come + way, ratio[-1], bend[-1]


def _power(factor: Any, sign: float) -> Any:
    return factor if sign > 0 else factor.conjugate()


def stacked(values: Sequence[Any]) -> Any:
    """Laws of P designs as one, or parts of them; numbers that differ become columns (P, 1).

    Raises
    ------
    ValueError : they differ in more than numbers.
    """
    first = values[0]
    if any(type(value) is not type(first) for value in values):
        raise ValueError(values)
    if isinstance(first, PeriodicCurve):
        return Curves.of(values)
    if is_dataclass(first) and not isinstance(first, type):
        names = [field.name for field in fields(first)]
        return replace(
            first, **{name: stacked([getattr(v, name) for v in values]) for name in names}
        )
    if isinstance(first, tuple):
        return tuple(map(stacked, zip(*values, strict=True)))
    if all(np.array_equal(value, first) for value in values):
        return first
    if isinstance(first, np.ndarray):
        return np.stack(values)
    if isinstance(first, float):
        return np.array(values)[:, None]
    raise ValueError(values)


Side = Literal[1, -1]
LEFT: Side = 1
RIGHT: Side = -1


@dataclass(frozen=True)
class Strands:
    """A belt about two pulleys.

    apart : from the driver's pin to the driven pulley's.
    radius : of the driver.  other : of the driven pulley, below 0 where the belt is crossed.
    """

    apart: Any
    radius: Any
    other: Any

    @property
    def distance(self) -> Any:
        """Of the pins, m."""
        return abs(self.apart)

    @property
    def sine(self) -> Any:
        """Of the angle between a strand and the line of the pins."""
        return (self.radius - self.other) / self.distance

    @property
    def cosine(self) -> Any:
        return np.sqrt(1 - self.sine * self.sine)

    @property
    def length(self) -> Any:
        """Of a strand, m; both are as long."""
        return self.distance * self.cosine

    def way(self, side: Side) -> Any:
        """Unit vector along a strand, from the driver to the driven pulley."""
        return self.apart * (self.cosine - 1j * side * self.sine) / self.distance

    @property
    def toward(self) -> Any:
        """Sum of the unit vectors along both, which points from pin to pin."""
        return self.apart * (2 * self.cosine / self.distance)

    def ends(self, side: Side) -> tuple[Any, Any]:
        """Where a strand leaves the driver, and where it comes to the driven pulley."""
        out = 1j * side * self.way(side)
        return self.radius * out, self.apart + self.other * out

    def run_through(self, place: Any, share: float) -> bool:
        """Whether a strand comes to a place, from the driver's pin (complex, m), as near as this
        share of the distance of the pins.
        """
        for side in (LEFT, RIGHT):
            start, _ = self.ends(side)
            way = (place - start) * np.conj(self.way(side))
            inside = (way.real >= 0) & (way.real <= self.length)
            if np.all(inside & (abs(way.imag) <= share * self.distance)):
                return True
        return False
