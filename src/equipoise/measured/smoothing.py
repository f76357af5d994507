"""Values and extremes of noisy samples: polynomials, means, and swings above a threshold."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]


def means(time: Array, values: Array, starts: Array) -> tuple[Array, Array]:
    """Means of groups of samples that begin at `starts`."""
    counts = np.diff(np.append(starts, len(time)))
    return np.add.reduceat(time, starts) / counts, np.add.reduceat(values, starts) / counts


def zigzag(values: Array, threshold: float, last: bool = False) -> list[int]:
    """Places of the extremes between which the values move by more than the threshold.

    last : with the extreme reached after the last of them, from which there is no way back.
    """
    found: list[int] = []
    high = low = 0
    sense = 0
    for k, value in enumerate(values.tolist()):
        if sense >= 0 and value > values[high]:
            high = k
        if sense <= 0 and value < values[low]:
            low = k
        if sense >= 0 and value < values[high] - threshold:
            found.append(high)
            sense, low = -1, k
        elif sense <= 0 and value > values[low] + threshold:
            found.append(low)
            sense, high = 1, k
    if last and sense:
        found.append(high if sense > 0 else low)
    return found


ORDERS = ((9, (0, 1, 2, 3, 4)), (4, (0, 1, 2)), (2, (0, 1)), (1, (0,)))
STILL = ((8, (0, 2, 3, 4)), (5, (0, 2, 3)), (3, (0, 2)))
"""From how many samples on which powers of time are fitted; without slope for a place at rest."""


@dataclass(frozen=True, eq=False)
class Local:
    """A smooth curve through the samples about one time.

    at : that time, s.  value : of the curve there.
    spread : standard error of the value over that of one sample.
    noise : standard deviation of the samples about the curve; None where they are too few.
    powers : coefficients of time since `at` over `width`, from power 0 on.
    """

    at: float
    value: float
    spread: float
    noise: float | None
    powers: Array
    width: float


def fitted(
    time: Array,
    values: Array,
    at: float,
    width: float,
    *,
    window: tuple[float, float] | None = None,
    still: bool = False,
) -> Local:
    """Curve through the samples within `width` of a time, or within a window.

    still : the curve has no slope at that time.
    """
    low, high = window or (at - width, at + width)
    part = slice(np.searchsorted(time, low), np.searchsorted(time, high, "right"))
    u, y = (time[part] - at) / width, values[part]
    powers = next((row for least, row in (STILL if still else ORDERS) if len(u) >= least), None)
    if powers is None:
        return Local(at, np.nan, inf, None, np.zeros(5), width)
    design = u[:, None] ** np.array(powers)
    inverse = np.linalg.pinv(design.T @ design, hermitian=True)
    # Values about their mean: a large offset must not cost digits.
    mean = float(np.mean(y))
    found = inverse @ (design.T @ (y - mean))
    left = y - mean - design @ found
    free = len(u) - len(powers)
    noise = float(np.sqrt(left @ left / free)) if free > 0 else None
    coefficients = np.zeros(5)
    coefficients[list(powers)] = found
    coefficients[0] += mean
    return Local(
        at, float(coefficients[0]), float(np.sqrt(inverse[0, 0])), noise, coefficients, width
    )


def top(time: Array, values: Array, near: float, half: float) -> Local:
    """The turning point near a time; half : a half-period, s."""
    width = half / 3
    place = fitted(time, values, near, width)
    for _ in range(2):
        place = fitted(time, values, place.at + width * _level(place.powers), width)
    return place


def _level(powers: Array) -> float:
    """Where the curve is level, nearest to its middle and within it; else 0."""
    slope = np.trim_zeros(np.polynomial.polynomial.polyder(powers), "b")
    roots = np.polynomial.polynomial.polyroots(slope) if slope.size else np.empty(0)
    real = roots.real[np.abs(roots.imag) < 1e-9]
    near = real[np.abs(real) <= 1.0]
    return float(near[np.argmin(np.abs(near))]) if near.size else 0.0


def steepest_time(
    time: Array, values: Array, before: Local, after: Local, half: float
) -> tuple[float, float]:
    """When a half-swing is half done, s, and the standard error of that over noise.

    Friction moves the centre of a half-swing but not its shape, so these times are evenly spaced
    with any damping and friction.
    """
    level = (before.value + after.value) / 2
    width = half / 4
    at = (before.at + after.at) / 2
    curve = fitted(time, values, at, width)
    for _ in range(3):
        slope = curve.powers[1] / width
        if slope == 0 or not np.isfinite(curve.value):
            break
        step = (level - curve.value) / slope
        at = float(np.clip(at + step, before.at + 0.2 * half, after.at - 0.2 * half))
        curve = fitted(time, values, at, width)
    slope = abs(curve.powers[1]) / width
    spread = np.hypot(curve.spread, np.hypot(before.spread, after.spread) / 2)
    return at, float(spread / slope) if slope > 0 else inf
