"""Crank angles of a loop, and what depends on them alone."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np

from equipoise.fused.source import Source

Array = np.ndarray[Any, Any]


def all_angles(count: int, turns: int) -> Array:
    """`count` crank angles (rad) in each turn, equally spaced from 0."""
    return np.arange(count * turns) * (2 * pi / count)


def between(count: int, turns: int) -> Array:
    """The angles half-way between those of `all_angles`."""
    return all_angles(count, turns) + pi / count


def grid_of(source: Source, theta: Array) -> Array:
    """Rows (G, N) of what the source wants to know of crank angles (N,), rad."""
    return np.ascontiguousarray([row.values(theta) for row in source.rows], dtype=float)
