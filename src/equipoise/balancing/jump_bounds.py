"""How small extremes of rows that jump can be over boxes of phases, from their pieces.

A sum of rows has a peak of at least its value at any crank angle, so that over a box of phases

    peak >= max_t [ f_k(t) + sum_{i /= k} min f_i over t + phi_i - phi_k +- (h_i + h_k) ]

for whichever row k the angle t goes with: a side of a jump stays one wherever its row is, which no
angle that all rows share does.  The least of a piece over an interval is that of the control points
of its cubic, so that the bound is one of the curves themselves and meets them in small boxes.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from equipoise.balancing.jumping_rows import JumpingRows
from equipoise.dataclass import dataclass
from equipoise.mechanism.parts.balance import Measure
from equipoise.signals import Array

BINS = 720
"""In a turn, by which the crank angles are ranked of which the best are looked at closely."""
SEGMENTS = 8
"""Of a cycle, of each of which the best crank angle is looked at closely."""
MOST_SIDES, MOST_LEADING = 64, 8
"""Sides of jumps and bends of a row that are looked at closely; rows with which angles go."""
AT_ONCE = 4_000_000
"""Values that are held at a time."""
SIGNS = (1.0, -1.0)
"""Of the highest and of the lowest value, each as the highest of a signal."""
SLACK = 1e-11
"""rad, by which intervals are made longer, beyond rounding."""


@dataclass(frozen=True, eq=False)
class BoxExtremes:
    """Of B boxes: bounds (B,) of a measure from below, its values (B,) in the middles as far as
    they are read, and the loss (B, m) that each row's side of the box has in the bound.
    """

    bounds: Array
    values: Array
    losses: Array


@dataclass(frozen=True, eq=False)
class JumpBounds:
    """Bounds the peak or peak to peak of rows with one component over boxes of phases."""

    rows: JumpingRows
    measure: Measure

    def over(self, middles: Array, halves: Array) -> BoxExtremes:
        """Over boxes with middles (B, m) and half sides (B, m), rad; row 1 is not moved."""
        halves = halves.copy()
        halves[:, 0] = 0.0
        step = max(1, AT_ONCE // (2 * self._leading * self._bins))
        parts = [
            self._over(middles[k : k + step], halves[k : k + step])
            for k in range(0, len(middles), step)
        ]
        names = ("bounds", "values", "losses")
        return BoxExtremes(*(np.concatenate([getattr(part, n) for part in parts]) for n in names))

    def _over(self, middles: Array, halves: Array) -> BoxExtremes:
        # (B, k, i): of row i behind row k
        ahead = middles[:, None, :] - middles[:, : self._leading, None]
        reach = halves[:, None, :] + halves[:, : self._leading, None]
        each = np.arange(self._leading)
        reach[:, each, each] = 0.0
        rough = self._rough(ahead, reach)
        high, low = (
            self._closely(halves, ahead, reach, item, sign)
            for item, sign in zip(rough, SIGNS, strict=True)
        )
        if self.measure == "peak_to_peak":
            both = [a + b for a, b in zip(high, low, strict=True)]
            return BoxExtremes(*both)
        upper = high[0] >= low[0]
        losses = np.where(upper[:, None], high[2], low[2])
        return BoxExtremes(np.maximum(high[0], low[0]), np.maximum(high[1], low[1]), losses)

    # -- all crank angles, roughly -----------------------------------------------------------------

    def _rough(self, ahead: Array, reach: Array) -> tuple[Array, Array]:
        """Bounds (B, k, N) of the sum, and of minus the sum, at the N crank angles of bins."""
        spacing, count = self.rows.period / self._bins, self._bins
        first = np.floor((ahead - reach) / spacing).astype(int)
        wide = np.minimum(np.floor((ahead + reach) / spacing).astype(int) - first + 1, count)
        level = np.log2(wide).astype(int)
        last = first + wide - 2**level
        shape = (*ahead.shape[:2], count)
        high, low = np.zeros(shape), np.zeros(shape)
        least, most = self._windows
        for row in range(ahead.shape[2]):
            ends = [(level[..., row], row, at[..., row] % count) for at in (first, last)]
            high += np.minimum(least[ends[0]], least[ends[1]])
            low -= np.maximum(most[ends[0]], most[ends[1]])
        return high, low

    @cached_property
    def _bins(self) -> int:
        return BINS * self.rows.turns

    @cached_property
    def _leading(self) -> int:
        """Rows with which crank angles go."""
        return min(len(self.rows.curves), MOST_LEADING)

    @cached_property
    def _windows(self) -> tuple[Array, Array]:
        return self.pieces.windows(self._bins)

    @cached_property
    def pieces(self) -> CubicPieces:
        return CubicPieces.of(self.rows)

    # -- the best of them, closely -----------------------------------------------------------------

    def _closely(
        self, halves: Array, ahead: Array, reach: Array, rough: Array, sign: float
    ) -> tuple[Array, Array, Array]:
        """Bounds (B,), values in the middles (B,) and losses (B, m) of the sum times a sign."""
        boxes, leading, rows = ahead.shape
        angles = self._angles(ahead, rough, sign)  # (B, k, A)
        at = angles[..., None] + ahead[:, :, None, :]  # (B, k, A, m)
        row = np.broadcast_to(np.arange(rows), at.shape)
        here = sign * self.pieces.values(row, at)
        far = reach[:, :, None, :] + SLACK
        least, most = self.pieces.extremes(row, at - far, at + far)
        least = least if sign > 0 else -most
        own = np.eye(rows, dtype=bool)[:leading, None]
        least = np.where(own, here, least)
        bounds = np.sum(least, axis=3).reshape(boxes, -1)
        best = np.argmax(bounds, axis=1)
        k, a = np.unravel_index(best, angles.shape[1:])
        each, each_row = np.arange(boxes), np.arange(rows)
        drops = (here - least)[each, k, a]  # (B, m), to which the leading row's side adds as well
        share = halves / np.maximum(reach[each, k], SLACK)
        sides = drops * np.where(each_row == k[:, None], 0.0, share)
        sides[each, k] = np.sum(drops - sides, axis=1)
        sides[:, 0] = 0.0
        values = np.max(np.sum(here, axis=3).reshape(boxes, -1), axis=1)
        whole = np.maximum(bounds[each, best], np.max(rough, axis=(1, 2)))
        return whole, values, sides

    def _angles(self, ahead: Array, rough: Array, sign: float) -> Array:
        """Crank angles (B, k, A), as each leading row counts them: the best of each segment, led
        to the top of a parabola, and all sides of jumps.
        """
        boxes, leading, count = rough.shape
        spacing = self.rows.period / count
        parts = rough.reshape(boxes, leading, SEGMENTS, -1)
        size = parts.shape[3]
        places = np.argmax(parts, axis=3) + size * np.arange(SEGMENTS)
        theta = (places + 0.5) * spacing
        neighbors = theta[..., None] + spacing * np.array([-1.0, 0.0, 1.0])  # (B, k, S, 3)
        at = neighbors[..., None] + ahead[:, :, None, None, :]
        row = np.broadcast_to(np.arange(ahead.shape[2]), at.shape)
        before, top, after = np.moveaxis(sign * np.sum(self.pieces.values(row, at), axis=4), 3, 0)
        bend = before - 2 * top + after
        way = np.divide(before - after, 2 * bend, out=np.zeros_like(bend), where=bend < 0)
        theta = theta + spacing * np.clip(way, -1.0, 1.0)
        sides = np.broadcast_to(self._sides, (boxes, leading, len(self._sides)))
        return np.concatenate([theta, sides], axis=2)

    @cached_property
    def _sides(self) -> Array:
        """Crank angles of both sides of jumps, and of bends where these are few."""
        every = self.rows.edges(np.zeros(1))
        if len(every) > MOST_SIDES:
            every = every[: 2 * len(self.rows.jumps)][:MOST_SIDES]
        return np.asarray(every)


def _doubled(bins: Array, pick: Any) -> Array:
    """Extremes (levels, m, 2 N) over 1, 2, 4, ... bins from each of bins (m, N) around a cycle."""
    count = bins.shape[1]
    levels = [bins]
    while 2 ** len(levels) <= count:
        levels.append(pick(levels[-1], np.roll(levels[-1], -(2 ** (len(levels) - 1)), axis=1)))
    return np.array([np.concatenate([level, level], axis=1) for level in levels])


@dataclass(frozen=True, eq=False)
class CubicPieces:
    """Cubics of rows by cell: their values, and between which values they lie over intervals.

    starts, widths : (P,) of the cells, rad.  cubics : (m, 4, P), of the highest power first.
    """

    starts: Array
    widths: Array
    cubics: Array

    @classmethod
    def of(cls, rows: JumpingRows) -> CubicPieces:
        """Of rows with one component."""
        places = rows.curves[0][0].x
        cubics = np.array([curve.c[..., 0] for curve, _ in rows.curves])
        return cls(places[:-1], np.diff(places), cubics)

    @property
    def period(self) -> float:
        return float(self.starts[-1] + self.widths[-1])

    @cached_property
    def _tables(self) -> tuple[Array, Array]:
        """Least and largest (levels, m, 2 P) of control points over 1, 2, 4, ... cells."""
        cells = np.arange(len(self.starts))
        least, most = (
            np.array(
                [
                    end(self._control(np.full(len(cells), k), cells, 0.0, self.widths), axis=0)
                    for k in range(len(self.cubics))
                ]
            )
            for end in (np.min, np.max)
        )
        return _doubled(least, np.minimum), _doubled(most, np.maximum)

    def _cell(self, theta: Array) -> tuple[Array, Array]:
        """Cell of crank angles, rad, and how far into it they are."""
        inside = np.mod(theta, self.period)
        cell = np.searchsorted(self.starts, inside, side="right") - 1
        return cell, np.clip(inside - self.starts[cell], 0.0, self.widths[cell])

    def values(self, row: Array, theta: Array) -> Array:
        """Values (...) of rows (...) at crank angles (...), rad."""
        cell, u = self._cell(theta)
        a, b, c, d = (self.cubics[row, power, cell] for power in range(4))
        return np.asarray(((a * u + b) * u + c) * u + d)

    def _control(self, row: Array, cell: Array, begin: Any, end: Any) -> Array:
        """Control points (4, ...) of the cubics of cells from a place in them to another."""
        a, b, c, d = (self.cubics[row, power, cell] for power in range(4))
        first, last = (((a * u + b) * u + c) * u + d for u in (begin, end))
        up, down = ((3 * a * u + 2 * b) * u + c for u in (begin, end))
        third = (end - begin) / 3
        return np.array([first, first + third * up, last - third * down, last])

    def windows(self, bins: int) -> tuple[Array, Array]:
        """Least and largest values (levels, m, N + 1, N) of each row: at [l, k, j, n] over 2^l of N
        bins of the cycle from bin j + n.
        """
        edges = np.arange(bins + 1) * (self.period / bins)
        ends = np.broadcast_arrays(edges[:-1] - SLACK, edges[1:] + SLACK)
        each = [self.extremes(np.full(bins, k), *ends) for k in range(len(self.cubics))]
        return tuple(
            np.lib.stride_tricks.sliding_window_view(
                _doubled(np.array([item[which] for item in each]), pick), bins, axis=2
            )
            for which, pick in enumerate((np.minimum, np.maximum))
        )  # type: ignore[return-value]

    def extremes(self, row: Array, low: Array, high: Array) -> tuple[Array, Array]:
        """Values (...) between which rows (...) lie from crank angles to others (...), rad."""
        count = len(self.starts)
        (first, begin), (last, end) = self._cell(low), self._cell(high)
        around = np.floor(high / self.period) - np.floor(low / self.period)
        last = last + count * around.astype(int)
        last = np.where(high - low >= self.period, first + count, last)
        same = first == last
        widths = self.widths[first]
        of_first = self._control(row, first, begin, np.where(same, end, widths))
        of_last = self._control(row, last % count, np.where(same, begin, 0.0), end)
        between = np.clip(last - first - 1, 0, count)
        level = np.log2(np.maximum(between, 1)).astype(int)
        from_first = (first + 1) % count
        from_last = (first + 1 + between - 2**level) % count
        result = []
        for table, pick in zip(self._tables, (np.minimum, np.maximum), strict=True):
            ends = pick.reduce(np.concatenate([of_first, of_last]), axis=0)
            inner = pick(table[level, row, from_first], table[level, row, from_last])
            result.append(np.where(between > 0, pick(ends, inner), ends))
        return result[0], result[1]
