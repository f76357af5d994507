"""How figures scatter over many machines, and whose scatter is whose: shares of the variance.

A and B are two tables of designs that have nothing to do with each other.  A with the columns of
one cause taken from B tells what that cause does: first order, what it does by itself; total, with
all that it does together with others (Sobol 2001).  The estimates are (b) and (f) of Table 2 of
Saltelli et al. 2010.  A once more, with the tolerance of one cause halved or gone, tells what is
left without it; that is computed, not inferred.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from math import isnan
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.design.spreads import Normal, Uniform
from equipoise.sequences import sobol
from equipoise.studies.outcomes import feasible
from equipoise.studies.sampling import BITS, random_numbers, values_at

if TYPE_CHECKING:
    from equipoise.studies.design_space import Output
    from equipoise.studies.study import Study

Array = np.ndarray[Any, Any]

TWICE = 7
"""Stream of random numbers of A and B, apart from those of designs; of what is drawn again, one on.
"""
DRAWN_AGAIN, BLOCKS = 400, 1024
"""Bootstrap samples, and blocks of rows that are drawn."""
LEAST_ROWS = 16
"""Designs of A from which shares are told."""


@dataclass(frozen=True)
class IntervalEstimate:
    """A number with its 95 % interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Effect:
    """What one cause does to one figure.

    first, total : share of the variance by itself, and with all that it does with others.
    halved, removed : standard deviation that is left with half of the tolerance and without it,
        over that with all of it.
    """

    first: IntervalEstimate
    total: IntervalEstimate
    halved: float
    removed: float


def causes_of(study: Study) -> tuple[tuple[int, ...], ...]:
    """Columns that vary by themselves, or together because they are correlated."""
    groups = [{k} for k in range(len(study.paths))]
    for correlation in study.correlations:
        first, second = (
            study.paths.index(path) for path in (correlation.first, correlation.second)
        )
        union = groups[first] | groups[second]
        for k in union:
            groups[k] = union
    return tuple(dict.fromkeys(tuple(sorted(group)) for group in groups))


def tables(study: Study, rows: int) -> Iterator[Array]:
    """A and B, then for each cause A with it from B, with it halved, and without it; (rows, d).

    rows : a power of two.
    """
    width = len(study.vary)
    scrambling = random_numbers(study.sampling.seed, TWICE)
    places = sobol(2 * width, scrambling, BITS).random_base2(rows.bit_length() - 1)
    places += 0.5 / 2**BITS  # the middle of a cell: 0 is the end of a normal spread
    first, second = (values_at(study, half) for half in np.hsplit(places, 2))
    centre = np.array([centre_of(item.spread) for item in study.vary])
    yield from (first, second)
    for cause in causes_of(study):
        columns = list(cause)
        for values in (second, 0.5 * (first + centre), np.broadcast_to(centre, first.shape)):
            changed = first.copy()
            changed[:, columns] = values[:, columns]
            yield changed


def centre_of(spread: Normal | Uniform | Any) -> float:
    """Middle of a tolerance."""
    return spread.mean if isinstance(spread, Normal) else float(spread.centre)


def effects(figures: Sequence[Array], seed: int) -> list[Effect] | None:
    """What each cause does to one figure, given it for each of `tables`, (n,); NaN where failed.

    None where too few rows of all tables are there, or the figure does not vary.
    """
    table = np.array(figures)
    whole = np.all(np.isfinite(table), axis=0)
    if np.sum(whole) < LEAST_ROWS:
        return None
    table = table[:, whole]
    base, other = table[0], table[1]
    spread = float(np.std(base))
    if spread <= 1e-12 * float(np.max(np.abs(base))):
        return None
    halved, removed = (np.std(table[k::3], axis=1) / spread for k in (3, 4))
    shares = _shares(base, other, table[2::3], seed)
    left = zip(halved.tolist(), removed.tolist(), strict=True)
    return [Effect(*both, *estimates) for both, estimates in zip(shares, left, strict=True)]


# `scipy.stats.sobol_indices` gives the same estimates to 1e-16, but only of 2**n rows, which are
# not left where machines fail; its intervals draw single rows: 8 times the time at 1,024 of them.
def _shares(
    base: Array, other: Array, swapped: Array, seed: int
) -> list[tuple[IntervalEstimate, IntervalEstimate]]:
    """First-order and total share of each cause, with intervals by drawing rows again."""
    middle = np.mean([base, other])  # the estimates are closer without what does not vary
    base, other, swapped = base - middle, other - middle, swapped - middle
    mean, square = 0.5 * (base + other), 0.5 * (base**2 + other**2)
    terms = np.vstack([mean, square, other * (swapped - base), 0.5 * (base - swapped) ** 2])
    ratio = _ratios(np.mean(terms, axis=1)[None])[0]
    low, high = np.percentile(_ratios(_drawn_again(terms, seed)), [2.5, 97.5], axis=0)
    every = [IntervalEstimate(*map(float, item)) for item in zip(ratio, low, high, strict=True)]
    return [*zip(every[: len(swapped)], every[len(swapped) :], strict=True)]


def _ratios(means: Array) -> Array:
    """Shares of the variance (R, 2 g) of means (R, 2 + 2 g)."""
    variance = means[:, 1] - means[:, 0] ** 2
    shares: Array = means[:, 2:] / variance[:, None]
    return shares


def _drawn_again(terms: Array, seed: int) -> Array:
    """Means (R, T) of terms (T, n) over rows drawn anew each time, in blocks of random rows."""
    generator = random_numbers(seed, TWICE + 1)
    mixed = terms[:, generator.permutation(terms.shape[1])]
    blocks = np.array_split(mixed, min(BLOCKS, terms.shape[1]), axis=1)
    sums = np.array([block.sum(axis=1) for block in blocks])
    sizes = np.array([block.shape[1] for block in blocks])
    multinomial = generator.multinomial(
        len(blocks), np.full(len(blocks), 1 / len(blocks)), DRAWN_AGAIN
    )
    means: Array = (multinomial @ sums) / (multinomial @ sizes)[:, None]
    return means


PERCENTILES = (0.1, 1.0, 5.0, 50.0, 95.0, 99.0, 99.9)
"""Shares of machines, %, below whose figures the table tells of; the middle one is the median."""
BEYOND = 10
"""Machines that have to lie beyond a percentile for it to be told."""
BINS, ROUNDING = 40, 1e-12
"""Of a histogram; share of a figure below which its differences are rounding."""


@dataclass(frozen=True, eq=False)
class Scatter:
    """How one figure scatters over the machines that can be computed; in its own SI unit.

    base : of the model as its file has it; NaN where it lacks the figure.
    percentiles : percentage -> the figure below which so many machines are; only those that enough
        machines lie beyond.
    edges, counts : (B + 1,) and (B,) of a histogram.
    below, above : share of all machines under the lower and over the upper limit.
    within : share of all machines within the limits, failed ones counting as outside; None without
        limits.
    """

    output: Output
    base: float
    mean: float
    deviation: float
    least: float
    largest: float
    percentiles: Mapping[float, float]
    edges: Array
    counts: Array
    below: float
    above: float
    within: IntervalEstimate | None

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units."""
        return {
            "base": None if isnan(self.base) else self.base,
            "mean": self.mean,
            "deviation": self.deviation,
            "least": self.least,
            "largest": self.largest,
            "percentiles": {f"{p:g}": value for p, value in self.percentiles.items()},
            "histogram": {"edges": self.edges, "counts": self.counts},
            "at_least": self.output.at_least,
            "at_most": self.output.at_most,
            "below": self.below,
            "above": self.above,
            "within": None if self.within is None else asdict(self.within),
        }


def scatter_of(output: Output, base: float, figures: Array) -> Scatter:
    """Scatter of one figure, (P,) with NaN where it failed."""
    there = figures[np.isfinite(figures)]
    varies = np.ptp(there) > ROUNDING * np.max(np.abs(there))
    bins = int(np.clip(np.sqrt(there.size), 5, BINS)) if varies else 1
    counts, edges = np.histogram(there, bins)
    enough = [p for p in PERCENTILES if min(p, 100 - p) / 100 * there.size >= BEYOND]
    below = -np.inf if output.at_least is None else output.at_least
    above = np.inf if output.at_most is None else output.at_most
    return Scatter(
        output=output,
        base=float(base),
        mean=float(np.mean(there)),
        deviation=float(np.std(there)),
        least=float(np.min(there)),
        largest=float(np.max(there)),
        percentiles={p: float(np.percentile(there, p)) for p in enough},
        edges=edges,
        counts=counts,
        below=float(np.sum(there < below)) / len(figures),
        above=float(np.sum(there > above)) / len(figures),
        within=share_of(feasible([output], figures[:, None])[:, 0]) if output.limited else None,
    )


def share_of(good: Array) -> IntervalEstimate:
    """Share of machines (P,) with its 95 % interval, by Wilson's score."""
    from scipy.stats import binomtest

    number = int(np.sum(good))
    interval = binomtest(number, len(good)).proportion_ci(0.95, method="wilson")
    return IntervalEstimate(number / len(good), float(interval.low), float(interval.high))
