"""Checks of numbers and arrays that come from outside."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.quantities.units import HUGE, TINY

Array = np.ndarray[Any, Any]

AXES = ("x", "y", "z")


def not_negative(name: str, value: Any, unit: str = "m/s^2") -> float:
    """A finite number of 0 or more."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.floating | np.integer):
        raise UsageError(f"{name}: got {value!r}; give a number of 0 or more")
    if value != 0 and not TINY <= value <= HUGE:
        raise UsageError(f"{name}: got {value:g} {unit}; give a finite number of 0 or more")
    return float(value)


def row(name: str, values: Any, unit: str) -> Array:
    """Finite numbers (N,)."""
    found = _numbers(name, values)
    if found.ndim != 1 or not found.size:
        raise UsageError(f"{name}: got the shape {found.shape}; give a row of numbers in {unit}")
    return found


def rising(name: str, values: Any, unit: str) -> Array:
    """Finite numbers (N,), each larger than the one before."""
    found = row(name, values, unit)
    if not np.all(np.diff(found) > 0):
        raise UsageError(f"{name}: the values must rise from one to the next")
    return found


def of_axes(name: str, values: Any, count: int) -> Array:
    """Finite numbers (axes, count) of one to three axes; a single row is one axis."""
    found = _numbers(name, values)
    found = found[np.newaxis] if found.ndim == 1 else found
    if found.ndim != 2 or not 1 <= len(found) <= len(AXES) or found.shape[1] != count:
        raise UsageError(
            f"{name}: got the shape {np.shape(values)}; give one to three axes of {count} values"
        )
    return found


def amplitudes(name: str, values: Any, count: int) -> Array:
    """As `of_axes`, of 0 or more."""
    found = of_axes(name, values, count)
    if np.any(found < 0):
        raise UsageError(f"{name}: got {np.min(found):g}; give values of 0 or more")
    return found


def sizes(name: str, values: Any) -> Array:
    """Absolute values of complex numbers of any shape."""
    try:
        found: Array = np.abs(np.array(values, dtype=complex))
    except (TypeError, ValueError):
        raise UsageError(f"{name}: got {type(values).__name__}; give rows of numbers") from None
    return found


def _numbers(name: str, values: Any) -> Array:
    try:
        found = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise UsageError(f"{name}: got {type(values).__name__}; give rows of numbers") from None
    if not np.all(np.abs(found) <= HUGE):
        raise UsageError(f"{name}: a value is not finite; give finite numbers")
    return found
