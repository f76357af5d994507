"""What no phases of rows can go below: branch and bound over boxes of phases.

Every measure is the largest of linear readings of a signal: of a mean square the reading along any
signal of length 1 (Cauchy and Schwarz), of a peak that at any crank angle, and so on.  So is the
cost that objectives make together, and any one reading bounds it from below.  A reading of a sum of
rows is a sum of functions of one phase each,

    cost(phases) >= sum_k R_k(phi_k),   R_k(phi) = Re sum_n z_kn exp(i n phi)

whose least over a box is found row by row.  The reading that is largest in the middle of a box is
wrong at its ends by the square of its width, so that boxes need not be small.  The box whose bound
is least is cut in two again and again, until no box could hold anything better by more than a
stated share, or until so many have been looked at; then the least bound of those left is told.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from equipoise.balancing.multi_row import AREA_SAMPLES, Cost, Term, by_orders
from equipoise.balancing.phase_grid import alike
from equipoise.signals import Array

CLOSE = 1e-4
"""Between cost and bound, over the cost before, at which the search ends."""
MOST_BOXES, HOPELESS, BATCH = 40_000, 10_000, 512
"""Boxes that are looked at; where none of these bounds anything, as of many rows; cut in two at
once."""
HALVINGS = 48
"""Of a side, below which phases are told apart no more."""
POINTS = 7
"""At which a row's function is taken over its interval."""
PEAK_SAMPLES = 720
"""In a turn, at which a peak is read."""
BETTER, TINY = 1e-9, 1e-300


@dataclass(frozen=True, eq=False)
class Proof:
    """phases : the best that were found (m,), rad.  bound : of the cost.  boxes : looked at."""

    phases: Array
    bound: float
    boxes: int


def prove(cost: Cost, phases: Array, polish: Callable[[Array], Array]) -> Proof:
    """Bound the cost from below over all phases; row 1 is at 0.

    Parameters
    ----------
    phases : (m,) the best known, rad.
    polish : leads from phases (m,) that are better than the best known to the least next to them.
    """
    return _Search(cost, polish).run(phases)


@dataclass(frozen=True, eq=False)
class _Boxes:
    """Boxes of phases: middles (B, m), rad; how often each side was halved (B, m); bounds (B,); and
    the row (B,) whose side is to be cut.
    """

    middles: Array
    halvings: Array
    bounds: Array
    widest: Array

    def of(self, places: Array) -> _Boxes:
        """Some of them."""
        return _Boxes(*(each[places] for each in vars(self).values()))

    def with_more(self, other: _Boxes) -> _Boxes:
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return _Boxes(*(np.concatenate(pair) for pair in pairs))


@dataclass(frozen=True, eq=False)
class _Search:
    cost: Cost
    polish: Callable[[Array], Array]

    def run(self, phases: Array) -> Proof:
        rows, best, looked = self.cost.rows, phases, 1
        least, room = float(self.cost.values(best)), CLOSE * self.cost.whole
        middle = np.full((1, rows), self._half)
        middle[:, 0] = 0.0
        boxes, _ = self._bounded(middle, np.zeros((1, rows), int), np.zeros(1))
        left = np.inf
        while len(boxes.bounds) and np.min(boxes.bounds) < least - room:
            if looked >= (MOST_BOXES if np.min(boxes.bounds) > 0 else HOPELESS):
                break
            order = np.argsort(boxes.bounds, kind="stable")
            cut, values = self._bounded(*self._halves(boxes.of(order[:BATCH])))
            looked += len(values)
            if len(values) and np.min(values) < least - BETTER * self.cost.whole:
                best = self._better(cut.middles[np.argmin(values)], best)
                least = float(self.cost.values(best))
            boxes = boxes.of(order[BATCH:]).with_more(cut)
            closed = (boxes.bounds >= least - room) | (np.max(boxes.halvings, axis=1) > HALVINGS)
            left = min(left, float(np.min(boxes.bounds[closed], initial=np.inf)))
            boxes = boxes.of(~closed)
        return Proof(best, min(least, left, float(np.min(boxes.bounds, initial=np.inf))), looked)

    def _better(self, phases: Array, best: Array) -> Array:
        """The best phases after some that look better; reading peaks at samples flatters them."""
        if not self.cost.values(phases) < self.cost.values(best):
            return best
        return min(self.polish(phases), best, key=lambda each: float(self.cost.values(each)))

    @property
    def _half(self) -> float:
        return self.cost.period / 2

    def _halves(self, boxes: _Boxes) -> tuple[Array, Array, Array]:
        """Middles (2 B, m), halvings (2 B, m) and bounds (2 B,) of boxes cut in two.

        Of equal rows only rising phases are looked at, since they may be swapped.
        """
        each = np.arange(len(boxes.bounds))
        halvings, step = boxes.halvings.copy(), np.zeros(boxes.middles.shape)
        halvings[each, boxes.widest] += 1
        step[each, boxes.widest] = self._half / 2.0 ** halvings[each, boxes.widest]
        middles = np.vstack([boxes.middles - step, boxes.middles + step])
        halvings, bounds = np.vstack([halvings] * 2), np.tile(boxes.bounds, 2)
        halves, possible = self._half / 2.0**halvings, np.ones(len(bounds), bool)
        for one, other in self._ordered:
            low, high = middles[:, one] - halves[:, one], middles[:, other] + halves[:, other]
            possible &= low < high
        return middles[possible], halvings[possible], bounds[possible]

    @cached_property
    def _ordered(self) -> list[tuple[int, int]]:
        """Pairs of equal rows, row 1 left out."""
        groups = ([k for k in group if k > 0] for group in alike(self.cost))
        return [pair for group in groups for pair in pairwise(group)]

    # -- the bound of a box ------------------------------------------------------------------------

    def _bounded(self, middles: Array, halvings: Array, inherited: Array) -> tuple[_Boxes, Array]:
        """Boxes with their bounds, and the cost (B,) in their middles as it is read there."""
        reading, values = self._reading(middles)
        turned = reading * np.exp(1j * middles[..., None] * self._orders)
        along = (turned[:, :, None, :] @ self._points[halvings])[:, :, 0].real
        # Between points a function falls below their chord by no more than its bend allows.
        bend = np.sum(np.abs(reading) * self._orders**2, axis=2)
        spacing = 2 * self._half / 2.0**halvings / (POINTS - 1)
        drops = along[:, :, POINTS // 2] - np.min(along, axis=2) + bend * spacing**2 / 8
        bounds = values - np.sum(drops[:, 1:], axis=1)
        widest = 1 + np.argmax(drops[:, 1:], axis=1)
        return _Boxes(middles, halvings, np.maximum(bounds, inherited), widest), values

    @cached_property
    def _points(self) -> Array:
        """exp(i n d) (levels, K + 1, POINTS) at points d of an interval halved so many times."""
        places = np.linspace(-1.0, 1.0, POINTS)
        halves = self._half / 2.0 ** np.arange(HALVINGS + 2)
        return np.exp(1j * self._orders[:, None] * halves[:, None, None] * places)

    @cached_property
    def _orders(self) -> Array:
        return max((term.signals.orders for term in self.cost.terms), key=len)

    def _reading(self, phases: Array) -> tuple[Array, Array]:
        """The largest reading (B, m, K + 1) at phases (B, m), and its value (B,) there."""
        values, readings = [], []
        for term in self.cost.terms:
            value, reading = largest_reading(term, phases)
            missing = len(self._orders) - reading.shape[-1]
            values.append(value)
            readings.append(np.pad(reading, ((0, 0), (0, 0), (0, missing))))
        parts = self.cost.factors[:, None] * values
        shares = np.ones(parts.shape)
        if self.cost.combine == "squares":
            shares = parts / np.maximum(np.linalg.norm(parts, axis=0), TINY)
        factors = shares * self.cost.factors[:, None]
        whole = np.einsum("tb,tbkn->bkn", factors, np.array(readings))
        return whole, np.sum(shares * parts, axis=0)


def largest_reading(term: Term, phases: Array) -> tuple[Array, Array]:
    """Value (B,) of a term at phases (B, m), and amplitudes (B, m, K + 1) of the reading that is
    the term's there, and nowhere more than it.

    Of several speeds that of the loudest.
    """
    total = term.signals.total(phases)
    if by_orders(term.measure):
        sizes = term.each(total)
        readings = total.conj() * term.shares / np.maximum(sizes, TINY)[..., None, None]
    else:
        sizes, readings = _read_in_time(term, total)
    loudest = np.argmax(sizes, axis=1)
    each = np.arange(len(phases))
    reading, rows = readings[each, loudest], term.signals.amplitudes[loudest]
    return sizes[each, loudest], np.einsum("bcn,bkcn->bkn", reading, rows)


def _read_in_time(term: Term, total: Array) -> tuple[Array, Array]:
    """Values (B, V) of signals (B, V, C, K + 1) as they are read at crank angles, and the readings
    (B, V, C, K + 1).
    """
    turns, area = term.signals.turns, term.measure == "area"
    count = (AREA_SAMPLES if area else PEAK_SAMPLES) * turns
    theta = np.arange(count) * (2 * np.pi / (count // turns))
    waves = np.exp(1j * np.outer(term.signals.orders, theta))
    values = (total @ waves).real
    if area:
        signs = np.sign(values[..., :1, :])
        readings = (2 * np.pi / count) * (signs @ waves.T)
        return 2 * np.pi * np.mean(np.abs(values[..., 0, :]), axis=-1), readings

    def at(places: Array) -> tuple[Array, Array]:
        """Values (B, V, C) at crank angles (B, V), and their waves (B, V, 1, K + 1)."""
        found = np.take_along_axis(values, places[..., None, None], axis=-1)[..., 0]
        return found, waves.T[places][..., None, :]

    if values.shape[2] > 1:
        found, wave = at(np.argmax(np.sum(values**2, axis=2), axis=-1))
        sizes = np.linalg.norm(found, axis=-1)
        return sizes, (found / np.maximum(sizes, TINY)[..., None])[..., None] * wave
    (high, rising), (low, falling) = (
        at(pick(values[..., 0, :], axis=-1)) for pick in (np.argmax, np.argmin)
    )
    if term.measure == "peak_to_peak":
        return (high - low)[..., 0], rising - falling
    upper = high >= -low
    return np.maximum(high, -low)[..., 0], np.where(upper[..., None], rising, -falling)
