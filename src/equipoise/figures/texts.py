"""Texts beside points, put where they cover neither each other nor what is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from equipoise.figures.metrics import width_of
from equipoise.figures.sheet import Box, Sheet, Stroke, Words
from equipoise.figures.style import FAINT, SMALL

Array = np.ndarray[Any, Any]

AROUND = tuple(range(0, 360, 30))
"""Directions, deg, in which a text may stand from its point."""
DISTANCES = (1.0, 2.0, 3.4, 5.2)
"""How far it may stand away, over the nearest distance."""
TEXT_ON_TEXT, ON_POINT, FARTHER, TURNED, COVERED = 400.0, 1000.0, 8.0, 2.0, 3.0
"""Costs: of covering another text, or the text's own point, of a step away, of 30 deg off the
wish, of covering a piece of a line."""
PIECE, CLEAR, EDGE = 2.5, 1.5, 3.0
"""Points: length of the pieces of lines, room around texts, and their distance from the frame."""
LINE = 1.25
"""Height of a line of several, over the size of type."""
ROUNDS = 5000
"""In which texts side by side push each other; as many as a paper full of them takes."""
ON_TOP, LEAD = 8.0, 4.0
"""Orders of texts, and of the lines that lead to them."""


@dataclass(frozen=True)
class Text:
    """A text to be put beside a point, in lines.

    wish : direction (deg, against the clock) in which it stands best.  near : least distance.
    optional : leave it out where there is no room.
    """

    text: str
    color: str
    wish: float = 90.0
    near: float = 7.0
    optional: bool = False
    bold: bool = False
    size: float = SMALL


class Labels:
    """Texts inside a box of a sheet."""

    def __init__(self, sheet: Sheet, frame: Box) -> None:
        self.sheet = sheet
        self.frame = np.array(frame)
        self.boxes = np.empty((0, 4))
        self._pieces: list[Array] = []
        self._weights: list[Array] = []

    def avoid(self, places: Array, weight: float = 1.0) -> None:
        """Keep texts away from a line (N, 2)."""
        places = places[np.all(np.isfinite(places), axis=1)]
        if not len(places):
            return
        steps = np.hypot(*np.diff(places, axis=0).T)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        count = int(min(along[-1] / PIECE, 4000)) + 2
        at = np.linspace(0.0, along[-1], count)
        self._pieces.append(np.column_stack([np.interp(at, along, part) for part in places.T]))
        self._weights.append(np.full(count, weight))

    def reserve(self, x: float, y: float, half: float = 3.0) -> None:
        """Keep texts away from a marker, so many points around its middle."""
        self.boxes = np.vstack([self.boxes, [x - half, y - half, x + half, y + half]])

    def occupy(self, box: Box) -> None:
        """Keep texts out of a box."""
        self.boxes = np.vstack([self.boxes, box])

    def put(self, x: float, y: float, text: Text) -> bool:
        """Write a text beside a point; whether there was room."""
        lines = text.text.split("\n")
        wide = max(width_of(line, text.size, text.bold) for line in lines)
        size = np.array([wide, text.size * (1 + LINE * (len(lines) - 1))])
        offsets, costs = self._choices(np.array([x, y]), size, text.wish, text.near)
        best = int(np.argmin(costs))
        if text.optional and costs[best] >= TEXT_ON_TEXT / 8:
            return False
        middle = np.array([x, y]) + offsets[best]
        top = middle[1] - size[1] / 2
        style = Words(float(middle[0]), 0.0, "", text.size, text.color, "middle", text.bold)
        for number, line in enumerate(lines):
            base = float(top + text.size * (0.78 + LINE * number))
            self.sheet.add(replace(style, y=base, text=line, backed=True), ON_TOP)
        low, high = middle - size / 2, middle + size / 2
        self.occupy((low[0], low[1], high[0], high[1]))
        if np.hypot(*np.maximum(np.abs(offsets[best]) - size / 2, 0)) > 2.5 * text.near:
            self._lead(np.array([x, y]), offsets[best], size)
        return True

    def _choices(self, at: Array, size: Array, wish: float, near: float) -> tuple[Array, Array]:
        """Offsets (M, 2) of a text's middle from its point, and what each costs (M,)."""
        turned = np.radians(np.array([wish, *AROUND]))
        ways = np.column_stack([np.cos(turned), -np.sin(turned)])
        support = np.abs(ways) @ size / 2
        offsets = np.concatenate([ways * (near * far + support)[:, None] for far in DISTANCES])
        bend = np.degrees(np.abs(np.angle(np.exp(1j * (turned - turned[0]))))) / 30
        costs = np.concatenate([TURNED * bend + FARTHER * step for step in range(len(DISTANCES))])
        least, most = self.frame[:2] + size / 2 + EDGE, self.frame[2:] - size / 2 - EDGE
        offsets = np.clip(at + offsets, least, np.maximum(most, least)) - at
        low, high = at + offsets - size / 2 - CLEAR, at + offsets + size / 2 + CLEAR
        apart = (self.boxes[:, None, :2] >= high) | (self.boxes[:, None, 2:] <= low)
        costs += TEXT_ON_TEXT * np.sum(~np.any(apart, axis=2), axis=0)
        costs += COVERED * self._covered(low, high)
        on_point = np.all(np.abs(offsets) < size / 2 + near / 2, axis=1)
        return offsets, costs + ON_POINT * on_point

    def _covered(self, low: Array, high: Array) -> Any:
        """Weight of the pieces of lines in boxes, (M,)."""
        if not self._pieces:
            return 0.0
        if len(self._pieces) > 1:
            self._pieces = [np.concatenate(self._pieces)]
            self._weights = [np.concatenate(self._weights)]
        pieces, weights = self._pieces[0], self._weights[0]
        near = np.all((pieces >= np.min(low, axis=0)) & (pieces <= np.max(high, axis=0)), axis=1)
        pieces = pieces[near]
        inside = (pieces[:, None] >= low) & (pieces[:, None] <= high)
        return weights[near] @ np.all(inside, axis=2)

    def _lead(self, at: Array, offset: Array, size: Array) -> None:
        """A thin line from a point to the nearest place of its text's box."""
        corner = np.clip(0.0, offset - size / 2, offset + size / 2)
        far = float(np.hypot(*corner)) or 1.0
        ends = np.array([at + corner * min(2 / far, 1.0), at + corner * max(1 - 3 / far, 0.0)])
        self.sheet.add(Stroke((ends,), FAINT, 0.6), LEAD)


def spread(middles: Sequence[float], widths: Sequence[float], low: float, high: float) -> Array:
    """Middles of texts side by side, moved as little as keeps them apart and between two ends."""
    order = np.argsort(middles, kind="stable")
    half = np.array(widths, float)[order] / 2
    gaps = half[1:] + half[:-1]
    placed = np.array(middles, dtype=float)[order]
    for _ in range(ROUNDS):
        lack = gaps - np.diff(placed)
        if np.all(lack <= 1e-9) and np.all(placed >= low + half) and np.all(placed <= high - half):
            break
        push = np.maximum(lack, 0) / 2
        placed[:-1] -= push
        placed[1:] += push
        placed = np.clip(placed, low + half, high - half)
    result = np.empty_like(placed)
    result[order] = placed
    return result
