"""The frequency weighting Wh of hand-transmitted vibration, exactly: ISO 5349-1, Annex A.

Analog filters in series, with s = i f where f is the frequency in Hz:

    high pass       s^2 / (s^2 + s f1/Q1 + f1^2)
    low pass        f2^2 / (s^2 + s f2/Q1 + f2^2)
    a-v transition  K (1 + s/f3) / (1 + s/(Q2 f4) + s^2/f4^2)

The transition leaves acceleration as it is below some 16 Hz and makes a velocity of it above.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

import numpy as np

from equipoise.errors import UsageError

Array = np.ndarray[Any, Any]

F1, F2 = 10**0.8, 10**3.1
"""Hz, corners of the band limits.  This and what follows: ISO 8041-1, Table 3, row Wh, as quoted in
the reference manual of the Larson Davis HVM200, Table 3.1; ISO 5349-1, Table A.1, rounds them."""
F3 = F4 = 100 / (2 * pi)
"""Hz, corners of the a-v transition: 100 rad/s."""
Q1, Q2 = sqrt(0.5), 0.64
"""Resonance quality of the band limits (Butterworth) and of the transition."""
K = 1.0
"""Gain."""

FASTEST = 1e20
"""Hz, beyond which the weighting is taken as 0; it is 1e-53 there."""


def squared_factor(f2: Any) -> Any:
    """Square of the magnitude of Wh, a rational function of the square of the frequency.

    f2 : frequency squared, Hz^2, not negative.  Only + - * / are used, so that it may be any object
        that has them: an array, a number of many digits, a number that carries derivatives.
    """
    high, low = f2 / F1**2, f2 / F2**2
    rise, fall = f2 / F3**2, f2 / F4**2
    passed = high * high / (1 + high * high) / (1 + low * low)  # as Q1 is that of Butterworth
    return passed * K**2 * (1 + rise) / (1 + fall * (1 / Q2**2 - 2) + fall * fall)


def factor(frequency: Any) -> Array:
    """Magnitude of Wh at frequencies of any shape, Hz; 0 and infinity are allowed.

    Raises
    ------
    UsageError : a frequency is not a number.
    """
    within, beyond = _within(frequency)
    return np.where(beyond, 0.0, np.sqrt(squared_factor(within * within)))


def weighting(frequency: Any) -> Array:
    """Complex response of Wh at frequencies of any shape, Hz; as `factor`.

    A negative frequency gives the conjugate, as filters of real signals do.
    """
    within, beyond = _within(frequency)
    s = 1j * within
    high = s * s / (s * s + s * F1 / Q1 + F1**2)
    low = F2**2 / (s * s + s * F2 / Q1 + F2**2)
    transition = K * (1 + s / F3) / (1 + s / (Q2 * F4) + (s / F4) ** 2)
    return np.where(beyond, 0.0, high * low * transition)


def _within(frequency: Any) -> tuple[Array, Array]:
    """Frequencies that can be squared, and which of them were beyond."""
    values = np.asarray(frequency, dtype=float)
    if np.any(np.isnan(values)):
        raise UsageError("frequency: got a value that is no number; give frequencies in Hz")
    return np.clip(values, -FASTEST, FASTEST), np.abs(values) > FASTEST
