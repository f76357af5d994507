"""The same ``state`` on arrays, for where Numba is missing: some designs at a time, all angles."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

from equipoise.fused.source import Source

Array = np.ndarray[Any, Any]
AT_A_TIME = 16_384
"""Designs times crank angles, so that the values of a state stay in the processor's cache."""


def _rotation(angle: Array) -> Array:
    turned: Array = np.exp(1j * angle)
    return turned


SUPPORT = SimpleNamespace(
    smallest=np.minimum, greatest=np.maximum, angle_of=np.angle, rotation=_rotation
)


def run(source: Source, state: Callable[..., Any], table: Array, grid: Array) -> Array:
    """What a loop would gather (P, R) of designs (P, T) over a grid (G, N)."""
    out = np.empty((len(table), source.width))
    step = max(1, AT_A_TIME // grid.shape[1])
    with np.errstate(all="ignore"):
        for begin in range(0, len(table), step):
            some = slice(begin, begin + step)
            _fill(out[some], source, state, table[some], grid)
    return out


def _fill(out: Array, source: Source, state: Callable[..., Any], table: Array, grid: Array) -> None:
    arguments = [*grid, *_unpacked(source, table)]
    shape = (len(table), grid.shape[1])
    values = [np.broadcast_to(value, shape) for value in state(*arguments)]
    signals = dict(zip(source.gathered.signals, values, strict=False))
    for k, (signal, kind) in enumerate(source.gathered.columns):
        out[:, k] = _GATHER[kind](signals[signal])
    numbers = values[len(signals) : len(signals) + len(source.watched)]
    cosines = values[len(signals) + len(source.watched) :]
    places = (source.weakest, np.min, numbers), (source.strongest, np.max, numbers)
    for place, ways, found in (*places, (source.nearest, np.min, cosines)):
        for column, number in zip(out[:, place].T, found, strict=True):
            column[:] = ways(number, axis=1)


def _unpacked(source: Source, table: Array) -> list[Array]:
    """Columns (P, 1) of the table, two for a vector."""
    found, place = [], 0
    for slot in source.slots:
        column = table[:, place, None]
        found.append(column + 1j * table[:, place + 1, None] if slot.vector else column)
        place += 1 + slot.vector
    return found


_GATHER: dict[str, Callable[[Array], Array]] = {
    "sum": lambda x: x.sum(axis=1),
    "squares": lambda x: np.einsum("ij,ij->i", x, x),
    "highest": lambda x: x.max(axis=1),
    "lowest": lambda x: x.min(axis=1),
    "highest_at": lambda x: x.argmax(axis=1),
    "lowest_at": lambda x: x.argmin(axis=1),
}
