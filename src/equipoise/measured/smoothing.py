"""Values and extremes of noisy samples: polynomials, means, and swings above a threshold."""

from __future__ import annotations

from math import inf
from typing import NamedTuple

import numpy as np

from equipoise.decompositions import pinv
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
