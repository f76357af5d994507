"""A recorded decay as a value, its smoothing, and free motion with damping and friction.

Free motion with viscous damping and Coulomb friction, exactly: one formula a half-swing.

x'' + 2 sigma x' + (beta^2 + sigma^2) (x - center) = -+ (beta^2 + sigma^2) d, where sigma is the
decay rate, beta the damped angular frequency and d the Coulomb friction over the stiffness.
Between two turning points the friction keeps its sense, so that the motion is one about a centre
moved by d; it ends where a turning point lies within d of the centre, since the spring no longer
overcomes the friction (that at rest is taken to be that in motion).
"""

from __future__ import annotations

from math import atan2, inf, isfinite, pi, sqrt
from typing import Any, Literal, NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import pinv
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note
from equipoise.signals import Array

ORDERS = ((9, (0, 1, 2, 3, 4)), (4, (0, 1, 2)), (2, (0, 1)), (1, (0,)))
STILL = ((8, (0, 2, 3, 4)), (5, (0, 2, 3)), (3, (0, 2)))
"""From how many samples on which powers of time are fitted; without slope for a place at rest."""


class Samples(NamedTuple):
    """Values (N,) at rising times (N,), s."""

    time: Array
    values: Array


def means(samples: Samples, starts: Array) -> Samples:
    """Means of groups of samples that begin at `starts`."""
    counts = np.diff(np.append(starts, len(samples.time)))
    return Samples(*(np.add.reduceat(row, starts) / counts for row in samples))


def zigzag(values: Array, threshold: float, last: bool = False) -> list[int]:
    """Places of the extremes between which the values move by more than the threshold.

    last : with the extreme reached after the last of them, from which there is no way back.
    """
    numbers: list[int] = []
    high = low = 0
    sense = 0
    for k, value in enumerate(values.tolist()):
        if sense >= 0 and value > values[high]:
            high = k
        if sense <= 0 and value < values[low]:
            low = k
        if sense >= 0 and value < values[high] - threshold:
            numbers.append(high)
            sense, low = -1, k
        elif sense <= 0 and value > values[low] + threshold:
            numbers.append(low)
            sense, high = 1, k
    if last and sense:
        numbers.append(high if sense > 0 else low)
    return numbers


class Local(NamedTuple):
    """A smooth curve through the samples about one time.

    at : that time, s.  value : of the curve there.
    spread : standard error of the value over that of one sample.
    noise : standard deviation of the samples about the curve; None where they are too few.
    powers : coefficients of time since `at` over `width`, s, from power 0 on.
    """

    at: float
    value: float
    spread: float
    noise: float | None
    powers: Array
    width: float

    @property
    def slope(self) -> float:
        """At that time, 1/s."""
        return float(self.powers[1] / self.width)


def fitted(samples: Samples, at: float, width: float, still: bool = False, side: int = 0) -> Local:
    """Curve through the samples within `width` of a time; only those after (1) or before (-1) it.

    still : the curve has no slope at that time.
    """
    time, values = samples
    low, high = at - width * (side <= 0), at + width * (side >= 0)
    part = slice(np.searchsorted(time, low), np.searchsorted(time, high, "right"))
    u, y = (time[part] - at) / width, values[part]
    powers = next((row for least, row in (STILL if still else ORDERS) if len(u) >= least), None)
    if powers is None:
        return Local(at, np.nan, inf, None, np.zeros(5), width)
    design = np.vander(u, powers[-1] + 1, increasing=True)[:, powers]
    inverse = pinv(design.T @ design, hermitian=True)
    mean = float(np.mean(y))  # values about it: a large offset must not cost digits
    value = inverse @ (design.T @ (y - mean))
    left = y - mean - design @ value
    free = len(u) - len(powers)
    noise = float(np.sqrt(left @ left / free)) if free > 0 else None
    coefficients = np.zeros(5)
    coefficients[list(powers)] = value
    coefficients[0] += mean
    spread = float(np.sqrt(inverse[0, 0]))
    return Local(at, float(coefficients[0]), spread, noise, coefficients, width)


def top(samples: Samples, guess: float, half: float) -> Local:
    """The turning point near a time; half : a half-period, s."""
    width = half / 3
    place = fitted(samples, guess, width)
    for _ in range(2):
        place = fitted(samples, place.at + width * _level(place.powers), width)
    return place


def _level(powers: Array) -> float:
    """Where the curve is level, nearest to its middle and within it; else 0."""
    slope = np.trim_zeros(np.polynomial.polynomial.polyder(powers), "b")
    roots = np.polynomial.polynomial.polyroots(slope) if slope.size else np.empty(0)
    real = roots.real[np.abs(roots.imag) < 1e-9]
    inside = real[np.abs(real) <= 1.0]
    return float(inside[np.argmin(np.abs(inside))]) if inside.size else 0.0


def steepest_time(
    samples: Samples, before: Local, after: Local, half: float
) -> tuple[float, float]:
    """When a half-swing is half done, s, and the standard error of that over noise.

    Friction moves the centre of a half-swing but not its shape, so these times are evenly spaced
    with any damping and friction.
    """
    level = (before.value + after.value) / 2
    curve = fitted(samples, (before.at + after.at) / 2, half / 4)
    for _ in range(3):
        if curve.slope == 0 or not np.isfinite(curve.value):
            break
        at = curve.at + (level - curve.value) / curve.slope
        at = float(np.clip(at, before.at + 0.2 * half, after.at - 0.2 * half))
        curve = fitted(samples, at, half / 4)
    spread = np.hypot(curve.spread, np.hypot(before.spread, after.spread) / 2)
    return curve.at, float(spread / abs(curve.slope)) if curve.slope else inf


LARGEST_SWING = 1.0
"""rad: far more than a gauge's displacement over its arm can stand for."""
RecordKind = Literal["length", "angle"]

LEAST_SAMPLES = 12
"""Fewer cannot show three half-swings."""


@dataclass(frozen=True, eq=False)
class Record:
    """A displacement against time.

    Parameters
    ----------
    time : (N,), s, rising; it may begin anywhere, and its steps may differ.
    displacement : (N,), m or rad, from any zero.
    kind : ``"length"`` for m, ``"angle"`` for rad.

    Raises
    ------
    UsageError
        Shapes differ, a value is not finite, time does not rise, fewer than twelve samples.
    """

    time: Array
    displacement: Array
    kind: RecordKind = "length"

    def __post_init__(self) -> None:
        if self.kind not in ("length", "angle"):
            raise UsageError(
                at_place("kind", Note('got {kind!r}; give "length" or "angle"', kind=self.kind))
            )
        for name in ("time", "displacement"):
            object.__setattr__(self, name, _column(name, getattr(self, name)))
        count, moved = len(self.time), len(self.displacement)
        if count != moved:
            raise UsageError(
                Note(
                    "got {count} times and {moved} displacements; give as many of both",
                    count=count,
                    moved=moved,
                )
            )
        if count < LEAST_SAMPLES:
            raise UsageError(
                Note(
                    "got {count} samples; give at least {least_samples}, over three "
                    "half-swings or more",
                    count=count,
                    least_samples=LEAST_SAMPLES,
                )
            )
        if not np.all(np.diff(self.time) > 0):
            raise UsageError(at_place("time", Note("the times must rise from sample to sample")))

    @property
    def unit(self) -> str:
        """Of the displacement: ``m`` or ``rad``."""
        return "m" if self.kind == "length" else "rad"

    @property
    def duration(self) -> float:
        """From the first to the last sample, s."""
        return float(self.time[-1] - self.time[0])

    def as_angle(self, arm: float) -> Record:
        """The record as an angle, rad: displacement over the arm, m, from the pivot to the gauge.

        Raises
        ------
        UsageError : the record is one of angles, or the arm is not positive.
        """
        if self.kind == "angle":
            raise UsageError(
                at_place(
                    "arm", Note("the record is one of angles, which need no arm; leave it out")
                )
            )
        angle = self.displacement / positive("arm", arm)
        swing = float(np.ptp(angle)) / 2
        if swing > LARGEST_SWING:
            raise UsageError(
                at_place(
                    "arm",
                    Note(
                        "got {arm:g} m, by which the record swings {degrees:.3g} deg to either "
                        "side; that is no small angle, give the distance from the pivot to the "
                        "gauge",
                        arm=arm,
                        degrees=np.degrees(swing),
                    ),
                )
            )
        return Record(self.time, angle, "angle")


def positive(name: str, value: float) -> float:
    """The value, which has to be a finite number above 0."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.number):
        raise UsageError(at_place(name, Note("got {value!r}; give a number above 0", value=value)))
    if not (isfinite(value) and value > 0):
        raise UsageError(at_place(name, Note("got {value:g}; give a number above 0", value=value)))
    return float(value)


def _column(name: str, values: Any) -> Array:
    try:
        column: Array = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise UsageError(
            at_place(name, Note("got {kind}; give a row of numbers", kind=type(values).__name__))
        ) from None
    if column.ndim != 1:
        raise UsageError(
            at_place(name, Note("got {ndim} dimensions; give one row of numbers", ndim=column.ndim))
        )
    if not np.all(np.isfinite(column)):
        raise UsageError(at_place(name, Note("a value is not finite; leave such samples out")))
    column.flags.writeable = False
    return column


@dataclass(frozen=True)
class FreeSwing:
    """A free motion, described from one of its turning points.

    Parameters
    ----------
    turned : time of that turning point, s.
    side : +1 where the displacement there is above the centre, -1 below.
    amplitude : its distance from the centre, in the record's unit.
    center : the position that the spring pulls to.
    damped : beta, damped angular frequency, rad/s.
    rate : sigma, 1/s; negative where the motion grows.
    friction : d, in the record's unit; a negative one feeds the motion.
    """

    turned: float
    side: float
    amplitude: float
    center: float
    damped: float
    rate: float
    friction: float

    @property
    def half_period(self) -> float:
        """Time from turning point to turning point, s."""
        return pi / self.damped

    @property
    def loss(self) -> float:
        """-ln of the ratio of two half-swings without Coulomb friction."""
        return self.rate * self.half_period

    def displacement(self, time: Array) -> Array:
        """Displacement (N,) at times (N,), which may lie before that turning point."""
        since = (time - self.turned) / self.half_period
        number = np.floor(since).astype(int)
        first, last = int(np.min(number, initial=0)), int(np.max(number, initial=0))
        swings = np.arange(first, last + 1)
        reach = reaches(swings, self.amplitude, self.loss, self.friction)
        stuck = (reach <= 0) & (swings >= 0)  # the first of these does not come about
        stop = int(swings[np.argmax(stuck)]) if stuck.any() else last + 1
        number = np.minimum(number, stop)
        reach = reach[number - first]
        after = np.where(number < stop, pi * (since - number), 0.0)  # at rest: as at the turn
        slow = self.rate / self.damped
        shape = np.exp(-slow * after) * (np.cos(after) + slow * np.sin(after))
        sense = np.where(number % 2 == 0, self.side, -self.side)
        moved: Array = self.center + sense * (self.friction + reach * shape)
        return moved


def reaches(number: Array, amplitude: float, loss: float, friction: float) -> Array:
    """How far half-swings k (K,) set out from the centre of each, at or below 0 where none does.

    A_k = A_0 r^k - 2 d (1 + r + ... + r^(k-1)) with A_0 = amplitude - d and r = exp(-loss).
    """
    power = np.exp(-loss * number)
    total = number if abs(loss) < 1e-12 else np.expm1(-loss * number) / np.expm1(-loss)
    reach: Array = (amplitude - friction) * power - 2 * friction * total
    return reach


def simulate_decay(
    time: Any,
    *,
    natural_frequency: float,
    damping_ratio: float = 0.0,
    coulomb: float = 0.0,
    start: float = 1.0,
    velocity: float = 0.0,
    center: float = 0.0,
    noise: float = 0.0,
    seed: int = 1,
    kind: RecordKind = "length",
) -> Record:
    """Free decay with viscous damping and Coulomb friction: exact, not integrated.

    Parameters
    ----------
    time : (N,), s, rising; the motion begins at the first.
    natural_frequency : undamped angular frequency sqrt(stiffness / inertia), rad/s.
    damping_ratio : of the viscous damping, 0 to below 1.
    coulomb : Coulomb friction over stiffness, m or rad.
    start, velocity : displacement and velocity at the first time.
    center : displacement at which the spring is at ease.
    noise : standard deviation of the normally distributed noise that is added.
    seed : of that noise.
    kind : ``"length"`` or ``"angle"``.

    Raises
    ------
    UsageError : a value cannot be used.
    """
    positive("natural_frequency", natural_frequency)
    if not 0 <= damping_ratio < 1:
        raise UsageError(
            at_place(
                "damping_ratio",
                Note("got {damping_ratio:g}; give 0 to below 1", damping_ratio=damping_ratio),
            )
        )
    for name, value in (("coulomb", coulomb), ("noise", noise)):
        if not value >= 0:
            raise UsageError(at_place(name, Note("got {value:g}; give 0 or more", value=value)))
    still = Record(time, np.zeros(np.shape(time)), kind)
    rate = damping_ratio * natural_frequency
    damped = natural_frequency * sqrt(1 - damping_ratio**2)
    motion = _from_start(float(still.time[0]), start - center, velocity, damped, rate, coulomb)
    displacement = center + motion.displacement(still.time)
    if noise:
        displacement += np.random.default_rng(seed).normal(0.0, noise, displacement.shape)
    return Record(still.time, displacement, kind)


def _from_start(
    time: float, start: float, velocity: float, damped: float, rate: float, friction: float
) -> FreeSwing:
    """The motion about 0 that passes `start` with that velocity."""
    if velocity == 0:
        side = 1.0 if start >= 0 else -1.0
        return FreeSwing(time, side, abs(start), 0.0, damped, rate, friction)
    side = 1.0 if velocity > 0 else -1.0  # it turns on the side to which it moves
    away = side * start + friction  # from the centre that friction has moved
    speed = side * velocity
    sine = (speed + rate * away) / damped
    turn = atan2(speed, rate * sine + damped * away)  # the velocity is 0; 0 < turn < pi
    slow = rate / damped
    reach = np.exp(-slow * turn) * (away * np.cos(turn) + sine * np.sin(turn))
    amplitude = float(reach) - friction
    return FreeSwing(time + turn / damped, side, amplitude, 0.0, damped, rate, friction)
