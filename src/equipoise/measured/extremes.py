"""Extremes of a noisy signal: means of neighbouring samples, and swings above a threshold."""

from __future__ import annotations

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
