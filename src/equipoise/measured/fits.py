"""What the constants of a decay amount to, with confidence intervals by propagated covariance."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from math import pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import pinv
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.measured.record import FreeSwing, Record, RecordKind, reaches
from equipoise.measured.turning import Turns
from equipoise.signals import Array

STEP = 1e-30
"""Of complex differences, which do not cancel."""


@dataclass(frozen=True)
class FittedValue:
    """A value with the ends of its confidence interval, None where nothing is known of them."""

    value: float
    low: float | None = None
    high: float | None = None

    @property
    def includes_zero(self) -> bool:
        """Whether the interval includes zero; false where the interval is not known."""
        return self.low is not None and self.high is not None and self.low <= 0 <= self.high

    def apart_from(self, other: FittedValue) -> bool:
        """Whether the two intervals have nothing in common; false where one is not known."""
        if self.low is None or self.high is None or other.low is None or other.high is None:
            return False
        return self.high < other.low or other.high < self.low

    def to_dict(self) -> dict[str, float | None]:
        """Plain data."""
        return asdict(self)


@dataclass(frozen=True, eq=False)
class Constants:
    """Constants of a decay as a method finds them.

    damped : beta, damped angular frequency, rad/s.
    loss : -ln n, where n is the slope of the line of half-swings.
    friction : Coulomb friction over stiffness, m or rad.
    covariance : (3, 3) of the three, or None.
    factor : half-width of a confidence interval over the standard error, Student's t.
    """

    damped: float
    loss: float
    friction: float
    covariance: Array | None
    factor: float

    def quantities(self, kind: RecordKind, stiffness: float | None) -> dict[str, FittedValue]:
        """Every quantity by name, in SI units; see `_quantities`."""
        point = np.array([self.damped, self.loss, self.friction])
        values = _quantities(point.astype(complex), kind, stiffness)
        slopes = [_quantities(point + 1j * STEP * row, kind, stiffness) for row in np.eye(3)]
        fitted_values = {}
        for name, value in values.items():
            gradient = np.array([slope[name].imag for slope in slopes]) / STEP
            fitted_values[name] = self._interval(value.real, gradient)
        return fitted_values

    def line(self) -> dict[str, FittedValue]:
        """Slope n and intercept m of the line of half-swings."""
        n = float(np.exp(-self.loss))
        slope = self._interval(n, np.array([0.0, -n, 0.0]))
        rise = np.array([0.0, 2 * self.friction * n, -2 * (1 + n)])
        return {"slope": slope, "intercept": self._interval(-2 * self.friction * (1 + n), rise)}

    def _interval(self, value: float, gradient: Array) -> FittedValue:
        value = float(value)
        if self.covariance is None:
            return FittedValue(value)
        variance = float(gradient @ self.covariance @ gradient)
        half = self.factor * max(0.0, variance) ** 0.5
        return FittedValue(value, value - half, value + half)


def _quantities(point: Array, kind: RecordKind, stiffness: float | None) -> dict[str, Any]:
    """(60) to (62) of Yamashita, Ichikawa and Mori; complex numbers carry derivatives.

    point : beta (rad/s), -ln n, d (m or rad).
    """
    damped, loss, friction = point
    natural = damped * np.sqrt(1 + (loss / pi) ** 2)
    rate = damped * loss / pi
    values = {
        "damped_angular_frequency": damped,
        "natural_angular_frequency": natural,
        "damped_frequency": damped / (2 * pi),
        "natural_frequency": natural / (2 * pi),
        "damping_ratio": rate / natural,
        "logarithmic_decrement": 2 * loss,
        "decay_rate": rate,
        "coulomb_displacement": friction,
    }
    if stiffness is not None:
        inertia = stiffness / natural**2
        names = NAMES[kind]
        values |= {
            names[0]: inertia,
            "viscous_damping": 2 * rate * inertia,
            names[1]: stiffness * friction,
        }
    return values


NAMES: dict[RecordKind, tuple[str, str]] = {
    "length": ("mass", "coulomb_force"),
    "angle": ("inertia", "coulomb_torque"),
}
"""What inertia and friction are called."""


def student(confidence: float, free: float) -> float:
    """Half-width of a two-sided interval over the standard error."""
    from scipy.stats import t

    return float(t.ppf(0.5 + confidence / 2, free))


LEAST_SCATTER = 1e-4
"""Of the first half-swing, and of the half-period: what the polynomials may miss without noise."""


def line_of_swings(turns: Turns, confidence: float) -> Constants:
    """Constants from the straight line, and from the times at which half-swings are half done.

    Three half-swings have exactly one line, so there are no intervals.
    """
    spacing, spacing_variance = _spacing(turns)
    result, covariance = _line(turns)
    loss, friction = result[2:]
    damped = np.pi / spacing
    free = len(turns.time) - len(result)
    if free == 0:
        return Constants(damped, loss, friction, None, np.nan)
    both = np.zeros((3, 3))
    both[0, 0] = (damped / spacing) ** 2 * spacing_variance
    both[1:, 1:] = covariance[2:, 2:]
    return Constants(damped, loss, friction, both, student(confidence, free))


def _spacing(turns: Turns) -> tuple[float, float]:
    """Half-period, s, and its variance: slope of the times over their numbers, weighted."""
    count = np.arange(len(turns.passed))
    weight = 1 / turns.passed_spread**2
    mean = np.average(count, weights=weight)
    away = count - mean
    square = float(np.sum(weight * away**2))
    slope = float(np.sum(weight * away * turns.passed) / square)
    left = turns.passed - np.average(turns.passed, weights=weight) - slope * away
    least = (LEAST_SCATTER * slope) ** 2 * float(np.mean(weight))
    scatter = max(float(np.sum(weight * left**2)) / (len(count) - 2), least)
    return slope, scatter / square


def _line(turns: Turns) -> tuple[Array, Array]:
    """Centre, first amplitude, -ln n, d; and their covariance from the scatter of turns."""
    from scipy.optimize import least_squares

    number = np.arange(len(turns.time))
    sense = turns.side * np.where(number % 2 == 0, 1.0, -1.0)
    heights, spread = turns.heights, turns.spread / np.mean(turns.spread)
    scale = float(heights[0])

    def left(p: Array) -> Array:
        reach = reaches(number, p[1], p[2], p[3])
        expected = p[0] + sense * (reach + p[3])
        return np.asarray((turns.displacement / scale - expected) / spread)

    unit = np.array([scale, scale, 1.0, scale])
    tried = (
        least_squares(left, guess / unit, "3-point", x_scale="jac") for guess in _guesses(turns)
    )
    done = min(tried, key=lambda item: item.cost)
    free = len(number) - 4
    scatter = max(2 * done.cost / free, LEAST_SCATTER**2) if free else 0.0
    covariance = scatter * pinv(done.jac.T @ done.jac)
    return np.array(done.x * unit), np.array(covariance * np.outer(unit, unit))


def _guesses(turns: Turns) -> Iterator[Array]:
    """Start values with a viscous decay, with Coulomb friction, and with half of each.

    One of them leads to the line even where noise hides which of the two it is.
    """
    heights, loss = turns.heights, _viscous(turns)
    friction = float(heights[0] - heights[-1]) / (len(heights) - 1) / 4
    for share in (1.0, 0.0, 0.5):
        parts = share * loss, (1 - share) * friction
        yield np.array([*_begun(turns, 0, *parts), *parts])


def _viscous(turns: Turns) -> float:
    """-ln n with all of the decay viscous."""
    heights = turns.heights
    return float(np.log(heights[0] / heights[-1])) / (len(heights) - 1)


def _begun(turns: Turns, first: int, loss: float, friction: float) -> tuple[float, float]:
    """Centre, and amplitude at a turning point, by the half-swing that begins there."""
    amplitude = float(turns.heights[first]) / (1 + np.exp(-loss)) + friction
    side = turns.side * (-1) ** first
    return turns.displacement[first] - side * amplitude, amplitude


MOST, PER_HALF_SWING = 20_000, 64
"""Points that are fitted; but so many in a half-swing at least."""
UNKNOWNS = 6


@dataclass(frozen=True, eq=False)
class WholeFit:
    """The motion that comes closest to the samples.

    constants : of that motion.  motion : the motion itself.
    time, residual : (M,) of the points fitted, s and m or rad; means of several samples where
        there were too many.
    per_point : samples in each of them.
    correlated : over how many points the residual is correlated; 1 where not at all.
    """

    constants: Constants
    motion: FreeSwing
    time: Array
    residual: Array
    per_point: int
    correlated: float

    @property
    def rms(self) -> float:
        """Of the residual."""
        return float(np.sqrt(np.mean(self.residual**2)))


def fit_whole(record: Record, turns: Turns, line: Constants, confidence: float) -> WholeFit:
    """Fit the samples from the first to the last turning point.

    Intervals.  The covariance is that of white residuals times the number of points over which the
    residual is correlated, 1 + 2 (rho_1 + rho_2 + ...) up to the first rho below zero; Student's t
    counts so many points fewer.  White noise is hardly changed by it; noise of long waves, drift
    and what the model does not describe widen the intervals.

    Raises
    ------
    UsageError : no motion fits.
    """
    from scipy.optimize import least_squares

    time, values, per_point = _window(record, turns)
    zero, scale = float(turns.time[1]), float(turns.heights[0])
    unit = np.array([line.damped**-1, scale, scale, line.damped, line.damped, scale])

    def motion(p: Array) -> FreeSwing:
        turned, amplitude, center, damped, rate, friction = (p * unit).tolist()
        return FreeSwing(zero + turned, -turns.side, amplitude, center, damped, rate, friction)

    def left(p: Array) -> Array:
        return (motion(p).displacement(time) - values) / scale

    tried = [
        least_squares(left, guess / unit, "3-point", x_scale="jac", max_nfev=200)
        for guess in _first_guesses(turns, line)
    ]
    done = min(
        (item for item in tried if item.success), key=lambda result: result.cost, default=tried[0]
    )
    result = motion(done.x)
    if not done.success or not result.damped > 0:
        raise UsageError(
            Note("no damped vibration fits the whole record; give a record of a free decay")
        )
    residual = scale * done.fun
    correlated = _correlated(residual)
    free = len(time) / correlated - UNKNOWNS
    covariance = correlated * 2 * done.cost / max(len(time) - UNKNOWNS, 1)
    matrix = covariance * pinv(done.jac.T @ done.jac) * np.outer(unit, unit)
    change = np.zeros((3, UNKNOWNS))  # -ln n = pi sigma / beta in place of sigma
    change[0, 3] = change[2, 5] = 1.0
    change[1, 3], change[1, 4] = -result.loss / result.damped, np.pi / result.damped
    factor, three = student(confidence, max(free, 1.0)), change @ matrix @ change.T
    constants = Constants(result.damped, result.loss, result.friction, three, factor)
    return WholeFit(constants, result, time, residual, per_point, correlated)


def _first_guesses(turns: Turns, line: Constants) -> Iterator[Array]:
    """Turning point 1: its time since that found, amplitude, centre; beta, sigma, d.

    From the line, and with all of the decay viscous, should noise have led the line astray.
    """
    for loss, friction in ((line.loss, line.friction), (_viscous(turns), 0.0)):
        center, amplitude = _begun(turns, 1, loss, friction)
        rate = line.damped * loss / np.pi
        yield np.array([0.0, amplitude, center, line.damped, rate, friction])


def _window(record: Record, turns: Turns) -> tuple[Array, Array, int]:
    """Samples that are fitted, or means of them, and how many make one."""
    half = float(np.median(np.diff(turns.time)))
    first, last = turns.time[0] + 0.02 * half, turns.time[-1]
    part = slice(np.searchsorted(record.time, first), np.searchsorted(record.time, last, "right"))
    time, values = record.time[part], record.displacement[part]
    most = max(MOST, PER_HALF_SWING * len(turns.heights))
    step = -(-len(time) // most)
    if step == 1:
        return time, values, 1
    whole = len(time) // step * step
    groups = time[:whole].reshape(-1, step)
    close = np.ptp(groups, axis=1) < half / PER_HALF_SWING * 2  # no gap in the record
    means = values[:whole].reshape(-1, step).mean(axis=1)
    return groups.mean(axis=1)[close], means[close], step


def _correlated(residual: Array) -> float:
    """Over how many points a residual (M,) is correlated; 1 if it is white."""
    count = len(residual)
    spectrum = np.fft.rfft(residual, 2 * count)
    products = np.fft.irfft(np.abs(spectrum) ** 2)[:count]
    if not products[0] > 0:
        return 1.0
    rho = products / products[0]
    below = np.flatnonzero(rho <= 0)
    stop = int(below[0]) if below.size else count
    return float(max(1.0, 1 + 2 * np.sum(rho[1:stop])))
