"""What no phases of rows, and no masses with them, can go below: branch and bound over boxes.

`box_bounds` bounds the cost over a box of phases and numbers from below.  What it takes for the
cost is exact in the middle and wrong at the ends by the square of the box's width, so that boxes
need not be small.  That whose bound is least is cut in two again and again, until none could hold
anything better by more than a stated share, or until so many have been looked at; then the least
bound of those left is told.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from itertools import pairwise

import numpy as np

from equipoise.balancing.box_bounds import HALVINGS, Bounder, Boxes, Numbers
from equipoise.balancing.jump_bounds import TINY
from equipoise.balancing.multi_row import Cost
from equipoise.balancing.phase_grid import alike
from equipoise.dataclass import dataclass
from equipoise.signals import Array

CLOSE = 1e-4
"""Between cost and bound, over the cost before, at which the search ends."""
MOST_BOXES, HOPELESS, BATCH = 40_000, 10_000, 512
"""Boxes that are looked at, half as many with numbers; where none of these bounds anything, as of
many rows; cut in two at once."""
BETTER, ROUNDING = 1e-9, 1e-9
"""Shares of the cost before: what is better by less is as good; what a bound may be above by
rounding."""
LEAST_PART = 0.2
"""Share of a number's range that a cut leaves on either side."""

Improve = Callable[[Array, float], tuple[Array, float]]
"""Leads from phases (m,), at which the cost looks like so much, to the best next to them with its
cost; infinite where these are no better than is known."""


@dataclass(frozen=True, eq=False)
class PhaseProof:
    """phases : the best that were found (m,), rad.  bound : of the cost.  boxes : looked at.

    complete : whether the search ended as near to the best as it was to come.
    """

    phases: Array
    bound: float
    boxes: int
    complete: bool


def prove(
    cost: Cost,
    phases: Array,
    improve: Improve,
    numbers: Numbers | None = None,
    least: float | None = None,
    close: float = CLOSE,
    prices: tuple[float, ...] = (),
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> PhaseProof:
    """Bound the cost from below over all phases, and over all numbers; row 1 is at 0.

    Parameters
    ----------
    cost : where all numbers are 0.
    phases : (m,) the best known, rad.  least : cost there, with the best numbers known.
    prices : of each limit, where they are known; see `Bounder`.
    progress : is called with the boxes looked at, and how many these are at most.
    """
    prices = prices or (0.0,) * len(cost.limits)
    bounder = Bounder.of(cost, numbers, prices)
    known = float(cost.values(phases)) if least is None else least
    return _PhaseSearch(cost, bounder, improve, close).run(phases, known, progress)


@dataclass(frozen=True, eq=False)
class _PhaseSearch:
    cost: Cost
    bounder: Bounder
    improve: Improve
    close: float

    def run(self, phases: Array, least: float, progress: Callable[[int, int], None]) -> PhaseProof:
        best, looked, room = phases, 1, self.close * self.cost.whole
        most = MOST_BOXES // (2 if len(self.numbers.low) else 1)
        batch = min(BATCH, self.bounder.most_at_once)
        boxes, _, _ = self.bounder.bounded(self._first)
        left = np.inf
        while len(boxes.bounds) and np.min(boxes.bounds) < least - room:
            if looked >= (most if np.min(boxes.bounds) > 0 else HOPELESS):
                break
            progress(looked, most)
            order = np.argsort(boxes.bounds, kind="stable")
            cut, values, slopes = self.bounder.bounded(self._halves(boxes.of(order[:batch])))
            looked += len(values)
            if len(values):
                self.numbers.cut(slopes[np.argmin(cut.bounds)])
                if np.min(values) < least - BETTER * self.cost.whole:
                    place = np.argmin(values)
                    result, value = self.improve(cut.middles[place], float(values[place]))
                    best, least = (result, value) if value < least else (best, least)
            boxes = boxes.of(order[batch:]).with_more(cut)
            closed = (boxes.bounds >= least - room) | (np.max(boxes.halvings, axis=1) > HALVINGS)
            left = min(left, float(np.min(boxes.bounds[closed], initial=np.inf)))
            boxes = boxes.of(~closed)
        bound = min(least, left, float(np.min(boxes.bounds, initial=np.inf)))
        return PhaseProof(best, bound, looked, bound >= least - (1 + 1e-6) * room)

    @property
    def numbers(self) -> Numbers:
        return self.bounder.numbers

    @property
    def _first(self) -> Boxes:
        """All phases and numbers, as one box."""
        middles = np.full((1, self.cost.rows), self.bounder.half)
        middles[:, 0] = 0.0
        ends, values = self.numbers, np.zeros(1)
        low, high, start = ends.low[None], ends.high[None], ends.start[None]
        return Boxes(
            middles, np.zeros(middles.shape, int), low, high, start, values, values.astype(int)
        )

    def _halves(self, boxes: Boxes) -> Boxes:
        """Boxes cut in two, of which those are left out in which nothing is allowed.

        Of equal rows only rising phases are looked at, since they may be swapped.
        """
        rows, each = self.cost.rows, np.arange(len(boxes.bounds))
        turned = boxes.widest < rows
        halvings, step = boxes.halvings.copy(), np.zeros(boxes.middles.shape)
        at = each[turned], boxes.widest[turned]
        halvings[at] += 1
        step[at] = self.bounder.half / 2.0 ** halvings[at]
        low, high = np.vstack([boxes.low] * 2), np.vstack([boxes.high] * 2)
        at = each[~turned], boxes.widest[~turned] - rows
        ends, width = boxes.low[at], boxes.high[at] - boxes.low[at]
        here = (boxes.numbers[at] - ends) / np.maximum(width, TINY)
        here = np.clip(here, LEAST_PART, 1 - LEAST_PART)
        high[at] = low[at[0] + len(each), at[1]] = ends + width * (here + 0.5) / 2
        twice = boxes.of(np.tile(each, 2))
        middles = np.vstack([boxes.middles - step, boxes.middles + step])
        numbers = np.clip(twice.numbers, low, high)
        result = Boxes(
            middles, np.vstack([halvings] * 2), low, high, numbers, twice.bounds, twice.widest
        )
        return result.of(self._possible(result))

    def _possible(self, boxes: Boxes) -> Array:
        """Whether boxes (B,) hold anything that is allowed, and nothing that others hold too."""
        halves, values = self.bounder.half / 2.0**boxes.halvings, np.ones(len(boxes.bounds), bool)
        for item, other in self._ordered:
            low = boxes.middles[:, item] - halves[:, item]
            values &= low < boxes.middles[:, other] + halves[:, other]
        for direction, least in self.numbers.cuts:
            most = np.sum(np.maximum(direction * boxes.low, direction * boxes.high), axis=1)
            values &= most >= least - ROUNDING
        return values

    @cached_property
    def _ordered(self) -> list[tuple[int, int]]:
        """Pairs of equal rows, row 1 left out."""
        groups = ([k for k in group if k > 0] for group in alike(self.cost, self.numbers.columns))
        return [pair for group in groups for pair in pairwise(group)]
