"""Texts beside points, put where they cover neither each other nor what is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from equipoise.plotting.style import FAINT, INK, SMALL

Array = np.ndarray[Any, Any]

AROUND = tuple(range(0, 360, 30))
"""Directions, deg, in which a text may stand from its point."""
DISTANCES = (1.0, 2.0, 3.4, 5.2)
"""How far it may stand away, over the nearest distance."""
TEXT_ON_TEXT, ON_POINT, FARTHER, TURNED, COVERED = 400.0, 1000.0, 8.0, 2.0, 3.0
"""Costs: of covering another text, or the text's own point, of a step away, of 30 deg off the
wish, of covering a piece of a line."""
PIECE, CLEAR, EDGE = 2.0, 1.5, 3.0
"""Points: length of the pieces of lines, room around texts, and their distance from the frame."""
ROUNDS = 5000
"""In which texts side by side push each other; as many as a paper full of them takes."""


class Labels:
    """Texts of one axes, whose limits and place in the figure are settled."""

    def __init__(self, axes: Axes) -> None:
        self.axes = axes
        self.dot = cast(Figure, axes.figure).dpi / 72
        box = axes.get_window_extent()
        self.frame = np.array([box.x0, box.y0, box.x1, box.y1])
        self.boxes = np.empty((0, 4))
        self.pieces, self.weights = np.empty((0, 2)), np.empty(0)

    def avoid(self, x: Any, y: Any, weight: float = 1.0) -> None:
        """Keep texts away from a line."""
        corners = self.axes.transData.transform(np.column_stack([x, y]))
        steps = np.hypot(*np.diff(corners, axis=0).T)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        count = int(min(along[-1] / (PIECE * self.dot), 20_000)) + 2
        at = np.linspace(0.0, along[-1], count)
        pieces = [np.interp(at, along, part) for part in corners.T]
        self.pieces = np.concatenate([self.pieces, np.column_stack(pieces)])
        self.weights = np.concatenate([self.weights, np.full(count, weight)])

    def reserve(self, x: float, y: float, half: float = 3.0) -> None:
        """Keep texts away from a marker, so many points around its middle."""
        middle = self.axes.transData.transform((x, y))
        box = np.concatenate([middle - half * self.dot, middle + half * self.dot])
        self.boxes = np.vstack([self.boxes, box])

    def occupy(self, text: Any) -> None:
        """Keep other texts away from one that stands where it must."""
        box = text.get_window_extent()
        self.boxes = np.vstack([self.boxes, [box.x0, box.y0, box.x1, box.y1]])

    def put(
        self,
        text: str,
        x: float,
        y: float,
        wish: float = 90.0,
        directions: Sequence[float] = AROUND,
        near: float = 7.0,
        optional: bool = False,
        **look: Any,
    ) -> None:
        """Write a text beside a point.

        wish : direction (deg) in which it stands best.
        near : least distance, points.
        optional : leave it out where there is no room.
        """
        look = {"fontsize": SMALL, "color": INK, **look}
        drawn = self.axes.annotate(
            text,
            (x, y),
            xytext=(0, 0),
            textcoords="offset points",
            ha="center",
            va="center",
            bbox={"boxstyle": "square,pad=0.08", "fc": "white", "ec": "none", "alpha": 0.7},
            zorder=8,
            annotation_clip=False,
            **look,
        )
        extent = drawn.get_window_extent()
        size = np.array([extent.width, extent.height])
        offsets, costs = self._choices(
            np.array([extent.x0, extent.y0]) + size / 2,
            size,
            wish,
            directions,
            near * self.dot,
        )
        best = int(np.argmin(costs))
        if optional and costs[best] >= TEXT_ON_TEXT / 8:
            drawn.remove()
            return
        drawn.set_position(tuple(offsets[best] / self.dot))
        self.occupy(drawn)
        if np.hypot(*np.maximum(np.abs(offsets[best]) - size / 2, 0)) > 2.5 * near * self.dot:
            self._lead(x, y, offsets[best], size)

    def _choices(
        self, middle: Array, size: Array, wish: float, directions: Sequence[float], near: float
    ) -> tuple[Array, Array]:
        """Offsets (M, 2) of a text's middle from its point, pixels, and what each costs (M,)."""
        turned = np.radians(np.array([wish, *directions]))
        ways = np.column_stack([np.cos(turned), np.sin(turned)])
        support = np.abs(ways) @ size / 2
        offsets = np.concatenate([ways * (near * far + support)[:, None] for far in DISTANCES])
        bend = np.degrees(np.abs(np.angle(np.exp(1j * (turned - turned[0]))))) / 30
        costs = np.concatenate([TURNED * bend + FARTHER * step for step in range(len(DISTANCES))])
        edge, clear = EDGE * self.dot, CLEAR * self.dot
        least, most = self.frame[:2] + size / 2 + edge, self.frame[2:] - size / 2 - edge
        offsets = np.clip(middle + offsets, least, most) - middle
        low, high = middle + offsets - size / 2 - clear, middle + offsets + size / 2 + clear
        costs += TEXT_ON_TEXT * self._covered_boxes(low, high)
        costs += COVERED * self._covered_pieces(low, high)
        on_point = np.all(np.abs(offsets) < size / 2 + near / 2, axis=1)
        return offsets, costs + ON_POINT * on_point

    def _covered_boxes(self, low: Array, high: Array) -> Array:
        apart = (self.boxes[:, None, :2] >= high) | (self.boxes[:, None, 2:] <= low)
        count: Array = np.sum(~np.any(apart, axis=2), axis=0)
        return count

    def _covered_pieces(self, low: Array, high: Array) -> Array:
        inside = (self.pieces[:, None] >= low) & (self.pieces[:, None] <= high)
        cost: Array = self.weights @ np.all(inside, axis=2)
        return cost

    def _lead(self, x: float, y: float, offset: Array, size: Array) -> None:
        """A thin line from a point to the nearest place of its text's box."""
        corner = np.clip(0.0, offset - size / 2, offset + size / 2)
        self.axes.annotate(
            "",
            (x, y),
            xytext=tuple(corner / self.dot),
            textcoords="offset points",
            arrowprops={"arrowstyle": "-", "color": FAINT, "lw": 0.6, "shrinkA": 2, "shrinkB": 3},
            zorder=4,
            annotation_clip=False,
        )


def spread(
    middles: Sequence[float] | Array, widths: Sequence[float] | Array, low: float, high: float
) -> Array:
    """Middles of texts side by side, moved as little as keeps them apart and between two ends."""
    order = np.argsort(middles, kind="stable")
    half = np.array(widths)[order] / 2
    gaps = half[1:] + half[:-1]
    placed = np.array(middles, dtype=float)[order]
    for _ in range(ROUNDS):
        lack = gaps - np.diff(placed)
        if np.all(lack <= 1e-9):
            break
        push = np.maximum(lack, 0) / 2
        placed[:-1] -= push
        placed[1:] += push
        placed = np.clip(placed, low + half, high - half)
    result = np.empty_like(placed)
    result[order] = placed
    return result
