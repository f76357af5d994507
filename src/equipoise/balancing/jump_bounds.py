"""How small extremes of rows that jump can be over boxes of phases, from their pieces.

A sum of rows has a peak of at least its value at any crank angle, so that over a box of phases

    peak >= max_t [ f_k(t) + sum_{i /= k} min f_i over t + phi_i - phi_k +- (h_i + h_k) ]

for whichever row k the angle t goes with: a side of a jump stays one wherever its row is, which no
angle that all rows share does.  The least of a piece over an interval is that of the control points
of its cubic, so that the bound is one of the curves themselves and meets them in small boxes.

Where rows depend on numbers x (x_0 = 1), such as masses, a sum of rows at a crank angle that goes
with row k is linear in them,

    sum_j x_j F_j(phi),   F_j = f_kj(t) + sum_{i /= k} f_ij(t + phi_i - phi_k)

and over a box of phases each F_j lies between sums of what the pieces of f_ij reach there.  The
least of x_j F_j over an interval of x_j is concave in x_j, so that the chord between its ends is
nowhere above: a reading that is linear in x, below every peak in the box.  Of a vector the readings
are along the direction that it has in the middle of the box.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from equipoise.balancing.jumping_rows import JumpingDesigns
from equipoise.balancing.rounding import TINY
from equipoise.dataclass import dataclass
from equipoise.mechanism.outputs.declaring import Statistic
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


MOST = 12
"""Crank angles between jumps, and sides of jumps, at which a box is read."""
MOST_VALUES = 2**26
"""Values of tables of pieces: half a GiB."""


@dataclass(frozen=True, eq=False)
class Forms:
    """Of B boxes R readings, each constants (B, R) + slopes (B, R, K) @ numbers, of which the
    largest is no more than a value anywhere in the box.
    """

    constants: Array
    slopes: Array

    def at(self, numbers: Array) -> Array:
        """Readings (B, R) with numbers (B, K)."""
        return np.asarray(self.constants + np.einsum("brk,bk->br", self.slopes, numbers))

    def with_more(self, other: Forms) -> Forms:
        return Forms(
            np.concatenate([self.constants, other.constants], axis=1),
            np.concatenate([self.slopes, other.slopes], axis=1),
        )


def linear_forms(least: Array, most: Array, low: Array, high: Array) -> Forms:
    """Forms of sums x @ F, x_0 = 1, of which each F is between least and most (B, R, 1 + K).

    low, high : (B, K) ends of the numbers.
    """
    low, high = low[:, None], high[:, None]
    first, last = (np.minimum(end * least[..., 1:], end * most[..., 1:]) for end in (low, high))
    width = high - low
    chord = np.divide(last - first, width, out=np.zeros_like(first), where=width > 0)
    # where numbers have one sign the chord is the least itself, of which no digits are to be lost
    slopes = np.where(low >= 0, least[..., 1:], np.where(high <= 0, most[..., 1:], chord))
    return Forms(least[..., 0] + np.sum(first - slopes * low, axis=2), slopes)


@dataclass(frozen=True, eq=False)
class BoxReadings:
    """Of B boxes: groups of forms, the largest of each of which sum up to a measure's bound; the
    measure's values (B,) in the middles as far as they are read, and the loss (B, m) that each
    row's side of the box has in the bound.
    """

    groups: tuple[Forms, ...]
    values: Array
    losses: Array

    @property
    def bounds(self) -> Array:
        """Bounds (B,) of the measure from below, where no numbers are free."""
        return np.asarray(np.sum([np.max(item.constants, axis=1) for item in self.groups], axis=0))


@dataclass(frozen=True, eq=False)
class JumpReadings:
    """Reads the peak or peak to peak of rows over boxes."""

    designs: JumpingDesigns
    measure: Statistic

    @property
    def possible(self) -> bool:
        """Whether the tables of all pieces are small enough to be held."""
        start = self.designs.each[0]
        cells, levels = len(start.curves[0][0].x) + self._bins, 2 + int(np.log2(self._bins))
        return 4 * len(self.pieces.cubics) * levels * cells <= MOST_VALUES

    def over(self, middles: Array, halves: Array) -> BoxReadings:
        """Over boxes of phases alone, with middles and half sides (B, m), rad."""
        none = np.zeros((len(middles), 0))
        return self.readings(middles, halves, none, none, none)

    def readings(
        self, middles: Array, halves: Array, numbers: Array, low: Array, high: Array
    ) -> BoxReadings:
        """Over boxes of phases with middles and half sides (B, m), rad, and of numbers between low
        and high (B, K), read where these are `numbers`; row 1 is not moved.
        """
        halves = halves.copy()
        halves[:, 0] = 0.0
        shares = np.concatenate([np.ones((len(numbers), 1)), numbers], axis=1)
        of_one = 2 * self._leading * self._bins * len(self._functions[0])
        step = max(1, 4 * AT_ONCE // of_one)
        parts = [
            self._some(*(item[k : k + step] for item in (middles, halves, shares, low, high)))
            for k in range(0, len(middles), step)
        ]
        groups = tuple(
            Forms(
                *(np.concatenate([getattr(item, name) for item in some]) for name in vars(some[0]))
            )
            for some in zip(*(part.groups for part in parts), strict=True)
        )
        values, losses = (
            np.concatenate([getattr(part, name) for part in parts]) for name in ("values", "losses")
        )
        return BoxReadings(groups, values, losses)

    def _some(
        self, middles: Array, halves: Array, shares: Array, low: Array, high: Array
    ) -> BoxReadings:
        ahead = middles[:, None, :] - middles[:, : self._leading, None]
        reach = halves[:, None, :] + halves[:, : self._leading, None]
        each = np.arange(self._leading)
        reach[:, each, each] = 0.0
        ends = []
        for sign, rough in zip(self._signs, self._rough(ahead, reach, shares), strict=True):
            leader, angles = self._angles(ahead, rough, sign * shares)
            ends.append(self._read(leader, angles, ahead, reach, halves, sign, shares, low, high))
        if self.measure == "peak_to_peak" and not self._is_vector:
            values = np.sum([value for _, value, _ in ends], axis=0)
            losses = np.sum([loss for _, _, loss in ends], axis=0)
            return BoxReadings(tuple(forms for forms, _, _ in ends), values, losses)
        forms, value, losses = ends[0]
        for other, another, lost in ends[1:]:
            forms = forms.with_more(other)
            losses = np.where((another > value)[:, None], lost, losses)
            value = np.maximum(value, another)
        return BoxReadings((forms,), value, losses)

    # -- what there is to read ---------------------------------------------------------------------

    @cached_property
    def pieces(self) -> CubicPieces:
        """Of all functions: by row, then number, then component."""
        start = self.designs.each[0]
        places = start.curves[0][0].x
        rows = range(len(start.curves))
        cubics = [
            jumping_row.curves[row][0].c[..., c]
            for row in rows
            for jumping_row in self.designs.each
            for c in range(start.curves[row][0].c.shape[-1])
        ]
        return CubicPieces(places[:-1], np.diff(places), np.array(cubics))

    @cached_property
    def _functions(self) -> Array:
        """Places (m, 1 + K, C) of the functions among the pieces."""
        start = self.designs.each[0]
        shape = (len(start.curves), len(self.designs.each), -1)
        return np.arange(len(self.pieces.cubics)).reshape(shape)

    @property
    def _is_vector(self) -> bool:
        return self.designs.each[0].is_vector

    @property
    def _signs(self) -> tuple[float, ...]:
        """1 for what is highest, -1 for what is lowest: a vector's size has no use for this."""
        return SIGNS[:1] if self._is_vector else SIGNS

    @property
    def _bins(self) -> int:
        return BINS * self.designs.each[0].turns

    @property
    def _leading(self) -> int:
        return min(len(self._functions), MOST_LEADING)

    @cached_property
    def _windows(self) -> tuple[Array, Array]:
        return self.pieces.windows(self._bins)

    @cached_property
    def _centres(self) -> Array:
        """Values (functions, 2 N) in the middles of bins, twice around the cycle."""
        theta = (np.arange(2 * self._bins) + 0.5) * (self.pieces.period / self._bins)
        row = np.arange(len(self.pieces.cubics))[:, None]
        return self.pieces.values(*np.broadcast_arrays(row, theta))

    # -- where -------------------------------------------------------------------------------------

    def _angles(self, ahead: Array, rough: Array, shares: Array) -> tuple[Array, Array]:
        """Rows (B, A) with which crank angles go, and these as the rows count them (B, A), rad.

        rough : bounds (B, k, N) at the N crank angles of bins.
        """
        spacing, boxes = self.pieces.period / self._bins, len(ahead)
        parts = rough.reshape(boxes, self._leading, SEGMENTS, -1)
        size = parts.shape[3]
        tops = np.argmax(parts, axis=3) + size * np.arange(SEGMENTS)
        highest = np.max(parts, axis=3).reshape(boxes, -1)
        tops, leader = (tops + 0.5) * spacing, np.arange(self._leading)[:, None]
        leading, tops = _first(highest, tops.reshape(boxes, -1), SEGMENTS)
        chosen = [(leading, self._topped(leading, tops, ahead, shares))]
        sides = self._sides
        if len(sides):
            shape = (boxes, self._leading, len(sides))
            at = np.broadcast_to(sides, shape).reshape(boxes, -1)
            lead = np.broadcast_to(leader, shape[1:]).reshape(1, -1).repeat(boxes, axis=0)
            height = self._sum(lead, at, ahead, shares)
            chosen.append(_first(height, at, len(sides)))
        return tuple(np.concatenate(both, axis=1) for both in zip(*chosen, strict=True))  # type: ignore[return-value]

    def _topped(self, leader: Array, angles: Array, ahead: Array, shares: Array) -> Array:
        """Crank angles (B, A) led to the tops of parabolas."""
        width = self.pieces.period / self._bins
        neighbors = np.concatenate([angles - width, angles, angles + width], axis=1)
        heights = self._sum(np.tile(leader, 3), neighbors, ahead, shares)
        before, top, after = np.split(heights, 3, axis=1)
        bend = before - 2 * top + after
        way = np.divide(before - after, 2 * bend, out=np.zeros_like(bend), where=bend < 0)
        return np.asarray(angles + width * np.clip(way, -1.0, 1.0))

    @cached_property
    def _sides(self) -> Array:
        rows = self.designs.each[0]
        every = rows.edges(np.zeros(1))
        if len(every) > MOST_SIDES:
            every = every[: 2 * len(rows.jumps)][:MOST_SIDES]
        return np.asarray(every)

    def _rough(self, ahead: Array, reach: Array, shares: Array) -> list[Array]:
        """Bounds (B, k, N) at the N crank angles of bins, with shares (B, 1 + K) of the numbers; of
        the sum and of minus the sum, or of a vector's size alone.
        """
        spacing, count = self.pieces.period / self._bins, self._bins
        first = np.floor((ahead - reach) / spacing).astype(int)
        wide = np.minimum(np.floor((ahead + reach) / spacing).astype(int) - first + 1, count)
        level = np.log2(wide).astype(int)
        last = first + wide - 2**level
        least, most = self._windows
        middle = np.floor(ahead / spacing).astype(int) % count
        factors = shares[:, None, None, :, None]
        if self._is_vector:
            factors = factors * self._along(middle, shares)[:, :, :, None, :]
        bounds = [np.zeros((*ahead.shape[:2], count)) for _ in self._signs]
        for row, functions in enumerate(self._functions):
            for (j, c), function in np.ndenumerate(functions):
                at = [(level[..., row], function, item[..., row] % count) for item in (first, last)]
                low = np.minimum(least[at[0]], least[at[1]])
                high = np.maximum(most[at[0]], most[at[1]])
                for k, sign in enumerate(self._signs):
                    factor = sign * factors[..., j, c]
                    bounds[k] += np.where(factor > 0, factor * low, factor * high)
        return bounds

    def _along(self, middle: Array, shares: Array) -> Array:
        """Directions (B, k, N, C) of the sum in the middles of boxes."""
        window = np.lib.stride_tricks.sliding_window_view(self._centres, self._bins, axis=1)
        components = self._functions.shape[2]
        total = np.zeros((*middle.shape[:2], self._bins, components))
        for row, functions in enumerate(self._functions):
            for (j, c), function in np.ndenumerate(functions):
                total[..., c] += shares[:, j, None, None] * window[function, middle[..., row]]
        return np.asarray(total / np.maximum(np.linalg.norm(total, axis=3, keepdims=True), TINY))

    # -- readings there ----------------------------------------------------------------------------

    def _values(self, leader: Array, angles: Array, ahead: Array) -> tuple[Array, Array, Array]:
        """Functions (B, A, m, 1 + K, C) at crank angles (B, A); which, and where, rad."""
        each = np.arange(len(ahead))[:, None]
        at = angles[..., None] + ahead[each, leader]  # (B, A, m)
        where = np.broadcast_to(at[..., None, None], (*at.shape, *self._functions.shape[1:]))
        which = np.broadcast_to(self._functions, where.shape)
        return self.pieces.values(which, where), which, where

    def _sum(self, leader: Array, angles: Array, ahead: Array, shares: Array) -> Array:
        """Value (B, A) of the sum in the middles of boxes; of a vector its size."""
        values, _, _ = self._values(leader, angles, ahead)
        total = np.einsum("bamjc,bj->bac", values, shares)
        return np.asarray(np.linalg.norm(total, axis=2) if self._is_vector else total[..., 0])

    def _read(
        self,
        leader: Array,
        angles: Array,
        ahead: Array,
        reach: Array,
        halves: Array,
        sign: float,
        shares: Array,
        low: Array,
        high: Array,
    ) -> tuple[Forms, Array, Array]:
        """Forms of R readings, the highest value (B,), and the losses (B, m) of the best."""
        here, which, where = self._values(leader, angles, ahead)
        each = np.arange(len(ahead))[:, None]
        far = reach[each, leader]  # (B, A, m)
        own = np.arange(ahead.shape[2]) == leader[..., None]
        margin = (far + SLACK)[..., None, None]
        least, most = self.pieces.extremes(which, where - margin, where + margin)
        least, most = (np.where(own[..., None, None], here, item) for item in (least, most))
        total = np.einsum("bamjc,bj->bac", here, shares)
        along = np.full_like(total, sign)
        if self._is_vector:
            along = total / np.maximum(np.linalg.norm(total, axis=2, keepdims=True), TINY)
        along = along[:, :, None, None]
        least, most = (
            np.sum(np.where((along > 0) == at_least, along * least, along * most), axis=4)
            for at_least in (True, False)
        )  # (B, A, m, 1 + K)
        here = np.sum(along * here, axis=4)
        forms = linear_forms(np.sum(least, axis=2), np.sum(most, axis=2), low, high)
        shares = shares[:, None, None]
        whole = np.sum(here * shares, axis=3)
        drops = whole - np.sum(np.minimum(least * shares, most * shares), axis=3)  # (B, A, m)
        best = np.argmax(np.sum(whole - drops, axis=2), axis=1)
        row, at = np.arange(len(best)), np.arange(drops.shape[2])
        lost, lead = drops[row, best], leader[row, best]
        share = halves / np.maximum(far[row, best], SLACK)
        sides = lost * np.where(at == lead[:, None], 0.0, share)
        sides[row, lead] = np.sum(lost - sides, axis=1)
        sides[:, 0] = 0.0
        return forms, np.max(np.sum(whole, axis=2), axis=1), sides


def _first(height: Array, angles: Array, of_each: int) -> tuple[Array, Array]:
    """The rows (B, A) and the crank angles (B, A) of the largest heights (B, k * of_each)."""
    order = np.argsort(-height, axis=1, kind="stable")[:, :MOST]
    return order // of_each, np.take_along_axis(angles, order, axis=1)
