"""The colours of a GIF, at most 256."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np

from equipoise.plotting.cartoon import Colors

Array = np.ndarray[Any, Any]
BETWEEN = 8
"""Colours between any two of the few that are drawn with."""
UNKNOWN = 255


class Shades:
    """Every colour that is drawn with, and what lies between two of them where edges are smooth.

    All frames share them, so that nothing flickers.

    palette : (n, 3) uint8.
    """

    def __init__(self, colors: Colors) -> None:
        few = [np.frombuffer(bytes.fromhex(color[1:]), np.uint8) for color in colors.values()]
        parts = np.arange(1, BETWEEN + 1)[:, None] / (BETWEEN + 1)
        mixed = [one + (other.astype(float) - one) * parts for one, other in combinations(few, 2)]
        self.palette = np.round(np.vstack([*few, *mixed])).astype(np.uint8)
        self._known = np.full(1 << 24, UNKNOWN, np.uint8)

    def numbers(self, frame: Array) -> Array:
        """(height, width, 3) uint8 -> number of the nearest colour, (height, width) uint8."""
        codes = frame.astype(np.uint32) @ np.array([1 << 16, 1 << 8, 1], np.uint32)
        found = self._known[codes]
        new = np.unique(codes[found == UNKNOWN])
        if new.size:
            self._learn(new)
            found = self._known[codes]
        return found

    def _learn(self, codes: Array) -> None:
        few = np.stack([codes >> 16, codes >> 8 & 255, codes & 255], axis=-1).astype(np.int32)
        apart = few[:, None] - self.palette.astype(np.int32)
        self._known[codes] = np.sum(apart**2, axis=-1).argmin(axis=-1)
