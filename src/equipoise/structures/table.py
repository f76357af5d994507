"""Signals and modes as plain values for the machine-readable output."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import Any

import numpy as np

from equipoise.signals import Periodic
from equipoise.structures.modes import Mode

Values = dict[str, Any]

LEAST_ORDERS = 10
SMALL = 1e-9
"""Share of the largest amplitude below which higher orders are left out."""


def range_shown(speeds: Sequence[float]) -> str:
    """From which to which speed, rad/s, as a text."""
    first, last = (
        f"{speed * 30 / pi:.4g} rpm ({speed:.4g} rad/s)" for speed in (speeds[0], speeds[-1])
    )
    return f"at {first}" if len(speeds) == 1 else f"from {first} to {last}"


def by_order(signal: Periodic) -> Values:
    """Figures of one signal and its amplitudes by order; RMS is about the mean."""
    sizes = signal.sizes
    varying = sizes[1:]
    above = np.flatnonzero(varying > SMALL * np.max(varying, initial=0.0))
    last = max(int(above[-1]) + 1 if above.size else 0, LEAST_ORDERS * signal.turns)
    keep = slice(0, min(last, len(sizes) - 1) + 1)
    return {
        "mean": float(signal.mean),
        "peak_to_peak": float(signal.peak_to_peak),
        "max": float(signal.extreme(1)[0]),
        "min": float(signal.extreme(-1)[0]),
        "rms": float(signal.vibration_rms),
        "orders": signal.orders[keep].tolist(),
        "harmonics": sizes[keep].tolist(),
        "phases": signal.phases[keep].tolist(),
    }


def mode_values(mode: Mode) -> Values:
    """Figures of a mode; the shape as real and imaginary parts."""
    return {
        "natural_frequency": mode.natural_frequency,
        "hertz": mode.cycles_per_second,
        "damped_frequency": mode.damped_frequency,
        "damping_ratio": mode.damping_ratio,
        "eigenvalue": [mode.eigenvalue.real, mode.eigenvalue.imag],
        "shape": [[part.real, part.imag] for part in mode.shape.tolist()],
    }
