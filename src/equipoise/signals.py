"""Periodic signals: their figures over a cycle, and their harmonics.

Convention: y(theta) = Re sum Y_n exp(i n theta), so that a_n = Re Y_n multiplies cos n theta and
b_n = -Im Y_n multiplies sin n theta; Y_0 is the mean.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Figures:
    """Figures of a signal over the crank angles at which it was taken, in its own unit.

    max_at, min_at, peak_at : crank angles, rad; peak is the largest absolute value.
    """

    mean: float
    rms: float
    peak: float
    peak_at: float
    max: float
    max_at: float
    min: float
    min_at: float

    @property
    def peak_to_peak(self) -> float:
        """Largest minus smallest value."""
        return self.max - self.min


def figures(crank_angle: Array, samples: Array) -> Figures:
    """Mean, RMS and extremes of samples (N,) taken at crank angles (N,), rad."""
    highest, lowest = int(np.argmax(samples)), int(np.argmin(samples))
    peak = highest if samples[highest] >= -samples[lowest] else lowest
    return Figures(
        mean=float(np.mean(samples)),
        rms=float(np.sqrt(np.mean(np.square(samples)))),
        peak=float(abs(samples[peak])),
        peak_at=float(crank_angle[peak]),
        max=float(samples[highest]),
        max_at=float(crank_angle[highest]),
        min=float(samples[lowest]),
        min_at=float(crank_angle[lowest]),
    )


def harmonics(samples: Array, orders: int | None = None) -> Array:
    """Complex amplitudes Y_0 ... Y_orders of one period of equally spaced samples (..., N).

    orders : highest order; N // 2 if None.  At N / 2 the samples tell only a cosine.
    """
    samples = np.asarray(samples, dtype=float)
    count = samples.shape[-1]
    amplitudes = np.fft.rfft(samples, axis=-1) / count
    amplitudes[..., 1 : (count + 1) // 2] *= 2
    wanted: Array = amplitudes if orders is None else amplitudes[..., : orders + 1]
    return wanted


def synthesis(amplitudes: Array, theta: Array) -> Array:
    """Values at angles theta (M,), rad, of complex amplitudes Y_0 ... Y_n; shape (..., M)."""
    orders = np.arange(amplitudes.shape[-1])
    return (amplitudes @ np.exp(1j * np.outer(orders, theta))).real
