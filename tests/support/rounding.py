"""What the digits that print leaves out can do to a number that is computed from printed ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import floor, log10
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]


def half_digits(numbers: Sequence[float], significant: int) -> list[float]:
    """Half of the last digit of numbers that are printed with so many significant ones."""
    return [0.5 * 10.0 ** (floor(log10(abs(number))) - significant + 1) for number in numbers]


def reach(
    value: Callable[[Array], float], data: Sequence[float] | Array, halves: Sequence[float] | Array
) -> list[float]:
    """A number as its data have it, least and largest where each datum is half a digit off.

    Each is taken off to the side to which the number falls, or rises, by central differences.
    """
    at, by = np.array(data, float), np.array(halves, float)
    slopes = [value(at + by * item) - value(at - by * item) for item in np.eye(len(at))]
    off = by * np.sign(slopes)
    return [value(at - off), value(at + off)]
