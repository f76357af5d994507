"""All designs of a study as a picture can show them: every one of few, how many where of many.

A store of millions is gone through twice, block by block; what is kept is as large as the picture.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.codegen.figures import COMPUTED
from equipoise.dataclass import dataclass
from equipoise.studies.outcomes import Block, feasible
from equipoise.studies.sampling import random_numbers
from equipoise.studies.store import UNKNOWN

if TYPE_CHECKING:
    from equipoise.studies.design_space import Output

Array = np.ndarray[Any, Any]
Blocks = Callable[[], Iterable[tuple[int, Block]]]
"""Gives all designs, each time anew, some at a time with the number of the first."""
Pair = tuple[str, str]

MOST, SOME = 2000, 250
"""Designs up to which each is drawn; those that are drawn as lines from axis to axis."""
BINS = 40
"""Along each side of a picture of many."""
MIDST, DECADES = (5, 95), 30.0
"""Percentiles of a figure above 0, and their ratio from which it is told by its decades."""
MOST_COLUMNS = 11
"""Stream of random numbers of those designs that are drawn as lines."""


@dataclass(frozen=True, eq=False)
class Spread:
    """What a column reaches over all designs that have figures; SI units."""

    low: float
    high: float
    log: bool

    @property
    def edges(self) -> Array:
        """Of the bins, (BINS + 1,)."""
        return self.at(np.arange(BINS + 1) / BINS)

    @property
    def middles(self) -> Array:
        """Of the bins, (BINS,)."""
        return self.at((np.arange(BINS) + 0.5) / BINS)

    def at(self, shares: Array | float) -> Array:
        """Values so far on the way from the lowest to the highest."""
        if self.log:
            return np.asarray(self.low * (self.high / self.low) ** np.asarray(shares))
        wide = self.high - self.low or abs(self.low) or 1.0
        return np.asarray(self.low + wide * np.asarray(shares))

    def bins(self, values: Array) -> Array:
        """The bin of each value (n,); any where there is none."""
        value = np.searchsorted(self.edges, np.nan_to_num(values), "right") - 1
        return np.asarray(np.clip(value, 0, BINS - 1))


@dataclass(frozen=True, eq=False)
class Cloud:
    """All designs that are stored.

    kept, beyond, failed : how many keep every limit, keep not all, have no figures.
    spreads : by name of a number or output.
    some : columns (n,) by name of designs with figures: all of them where `each`, else some that
        are drawn by chance.  good : whether each of them keeps every limit, (n,).
    counts : of two names: designs within limits and beyond, (2, BINS, BINS), along the second and
        the first; none where `each`.
    lost : of a number: middles of those bins, SI units, in which designs have no figures.
    """

    kept: int
    beyond: int
    failed: int
    spreads: Mapping[str, Spread]
    some: Mapping[str, Array]
    good: Array
    counts: Mapping[Pair, Array]
    lost: Mapping[str, Array]

    @property
    def each(self) -> bool:
        """Whether every design is among `some`."""
        return len(self.good) == self.kept + self.beyond


def cloud_of(
    blocks: Blocks,
    numbers: Sequence[str],
    outputs: Sequence[Output],
    pairs: Sequence[Pair],
    size: int,
) -> Cloud:
    """The cloud of some designs.

    Parameters
    ----------
    numbers, outputs : what the columns of values and figures are.
    pairs : names of the columns that are drawn against each other.
    size : number of designs, at most.
    """
    names = [*numbers, *(output.name for output in outputs)]
    few = size <= MOST
    chosen = (
        np.arange(size)
        if few
        else random_numbers(1, MOST_COLUMNS).choice(size, SOME, replace=False)
    )
    counted = np.zeros(3, int)
    least, most = np.full(len(names), np.inf), np.full(len(names), -np.inf)
    rows, marks = [np.empty((0, len(names)))], [np.empty((3, 0), bool)]
    for start, block in blocks():
        table, kinds = _table(block, outputs)
        counted += np.sum(kinds, axis=1)
        least, most = np.fmin(least, np.fmin.reduce(table)), np.fmax(most, np.fmax.reduce(table))
        own = np.isin(start + np.arange(len(table)), chosen)
        rows.append(table[own])
        marks.append(kinds[:, own])
    table, (good, bad, lost) = np.concatenate(rows), np.concatenate(marks, axis=1)
    there = good | bad
    ends = zip(names, least.tolist(), most.tolist(), table[there].T, strict=True)
    spreads = {
        name: _spread(low, high, column, name not in numbers) for name, low, high, column in ends
    }
    counts: dict[Pair, Array] = {}
    failed = {name: spreads[name].bins(table[lost, k]) for k, name in enumerate(numbers)}
    if not few:
        counts, failed = _counts(blocks, names, outputs, pairs, spreads)
    middles = {name: spreads[name].middles[np.unique(bins)] for name, bins in failed.items()}
    some = {name: table[there, k] for k, name in enumerate(names)}
    inside, outside, without = counted.tolist()
    return Cloud(inside, outside, without, spreads, some, good[there], counts, middles)


def _table(block: Block, outputs: Sequence[Output]) -> tuple[Array, Array]:
    """Values and figures (P, d + m), NaN where there are none; which designs keep every limit, keep
    not all, and fail, (3, P).
    """
    reason = block.outcome.reason
    stored, there = reason != UNKNOWN, reason == COMPUTED
    inside = there & np.all(feasible(outputs, block.outcome.figures), axis=1)
    figures = np.where(there[:, None], block.outcome.figures, np.nan)
    values = np.where(stored[:, None], block.values, np.nan)
    return np.hstack([values, figures]), np.array([inside, there & ~inside, stored & ~there])


def _spread(low: float, high: float, some: Array, figure: bool) -> Spread:
    """Of a column from its ends, and from some of its values."""
    if not low <= high:
        return Spread(0.0, 1.0, False)  # no design has it
    few, many = np.percentile(some, MIDST) if len(some) else (low, high)
    return Spread(low, high, bool(figure and low > 0 and many >= DECADES * few))


def _counts(
    blocks: Blocks,
    names: Sequence[str],
    outputs: Sequence[Output],
    pairs: Sequence[Pair],
    spreads: Mapping[str, Spread],
) -> tuple[dict[Pair, Array], dict[str, Array]]:
    """`Cloud.counts`, and bins of each number in which designs fail."""
    counts = {pair: np.zeros((2, BINS * BINS), int) for pair in pairs}
    lost = {name: np.zeros(BINS, int) for name in dict.fromkeys(first for first, _ in pairs)}
    for _, block in blocks():
        table, (good, bad, failed) = _table(block, outputs)
        bins = {name: spreads[name].bins(table[:, k]) for k, name in enumerate(names)}
        for (first, second), outcome in counts.items():
            cells = BINS * bins[second] + bins[first]
            for row, mask in enumerate((good, bad)):
                outcome[row] += np.bincount(cells[mask], minlength=BINS * BINS)
        for name in lost:
            lost[name] += np.bincount(bins[name][failed], minlength=BINS)
    return (
        {pair: count.reshape(2, BINS, BINS) for pair, count in counts.items()},
        {name: np.flatnonzero(result) for name, result in lost.items()},
    )
