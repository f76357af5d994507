"""Signals of every shape in whose extremes rules differ."""

from __future__ import annotations

import numpy as np

Array = np.ndarray

SHAPES = ("smooth", "size of a vector", "rounded off", "cut off", "constant", "almost constant",
          "below zero", "two equal tops")  # fmt: skip


def curve_of(shape: str, theta: Array, turns: int, rng: np.random.Generator) -> Array:
    """A signal (N,) with some orders at crank angles (N,), rad."""
    orders = np.arange(1, rng.integers(2, 9))
    sizes, phases = rng.normal(size=len(orders)) / orders, rng.uniform(0, 2 * np.pi, len(orders))
    waves = np.exp(1j * (np.outer(theta, orders) / turns + phases))
    y, other = (waves.real * sizes).sum(1), (waves.imag * sizes).sum(1)
    return {
        "smooth": y,
        "size of a vector": np.hypot(y, other + 0.2),
        "rounded off": np.round(y, 1),
        "cut off": np.maximum(y, 0.1),
        "constant": np.full(len(theta), sizes[0]),
        "almost constant": 1e3 + 1e-14 * y,
        "below zero": -np.hypot(y, 0.5),
        "two equal tops": np.cos(2 * theta / turns + phases[0]),
    }[shape]
