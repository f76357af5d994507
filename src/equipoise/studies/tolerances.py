"""What manufacturing tolerances do to the figures of a machine, and shares of the variance.

The scatter of each figure comes from one run over many machines, whose numbers are drawn from their
tolerances.  Which tolerance causes it comes from a second run of about the same length.

In this, A and B are two tables of designs that have nothing to do with each other.  A with the
columns of one cause taken from B gives the effect of that cause: first order, by itself; total,
with all its interactions with others (Sobol 2001).  The estimates are (b) and (f) of Table 2 of
Saltelli et al. 2010.  A once more, with the tolerance of one cause halved or gone, gives the
scatter that is left; that is computed, not inferred.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict
from math import isnan
from time import monotonic
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.codegen.figures import COMPUTED
from equipoise.dataclass import dataclass
from equipoise.design.variables import Normal, Uniform
from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.results.result import ProgressCallback, Result
from equipoise.sequences import sobol
from equipoise.signals import Array
from equipoise.studies.evaluate import pooled
from equipoise.studies.outcomes import Evaluator, Outcome, failures, feasible, why_none
from equipoise.studies.study import BITS, SLOW_CHUNK, random_numbers, samples, values_at

if TYPE_CHECKING:
    from equipoise.studies.study import Output, Study


TWICE = 7
"""Stream of random numbers of A and B, apart from those of designs; of what is drawn again, one on.
"""
DRAWN_AGAIN, BLOCKS = 400, 1024
"""Bootstrap samples, and blocks of rows that are drawn."""
LEAST_ROWS_OF_SHARES = 16
"""Designs of A from which on shares are estimated."""


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
    if np.sum(whole) < LEAST_ROWS_OF_SHARES:
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
# not left where machines fail; its intervals draw single rows: 8 times the time at 1,024 of them,
# and 90 times at 4,096.
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
"""Percentiles of the table, %; the middle one is the median."""
BEYOND = 10
"""Machines that have to lie beyond a percentile for it to be listed."""
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


QUICK = 0.1
"""Time between reports of progress, s; more machines are computed together if these take less."""
LEAST_ROWS = 32
"""Rows of A, at least, by which causes are separated."""


@dataclass(frozen=True)
class Cause:
    """One tolerance, or several that are correlated and count as one.

    numbers : paths.
    effects : by output; those outputs are missing that do not vary, or too often fail.
    gain : by how much the variance falls if the tolerance is halved, as a share of it, in the mean
        over the outputs that have limits (over all where none has).
    halved, removed : share of machines within all limits with half of the tolerance and without it;
        None where there are no limits.
    """

    numbers: tuple[str, ...]
    effects: Mapping[str, Effect]
    gain: float
    halved: float | None
    removed: float | None


@dataclass(frozen=True, eq=False, repr=False)
class Tolerances(Result):
    """What the tolerances of a study do.

    designs : machines of the scatter.  failures : of these by reason.
    within : share of them that keep every limit; None where there are none.
    scatters : by output.
    causes : what to tighten first comes first.
    rows : machines in each of the tables by which causes are separated.
    unchanged : share of the machines of table A within all limits, beside `halved` and `removed`.
    computed : machines in all.
    """

    study: Study
    designs: int
    failures: Mapping[str, int]
    within: IntervalEstimate | None
    scatters: Mapping[str, Scatter]
    causes: tuple[Cause, ...]
    rows: int
    unchanged: float | None
    computed: int
    notes: tuple[str, ...]

    blocks_in = "studies.blocks.tolerances_blocks"

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units."""
        return {
            "title": self.study.title,
            "designs": self.designs,
            "computed": self.computed,
            "failures": dict(self.failures),
            "within": None if self.within is None else asdict(self.within),
            "outputs": {name: scatter.to_dict() for name, scatter in self.scatters.items()},
            "rows": self.rows,
            "unchanged": self.unchanged,
            "tighten": [
                {
                    "numbers": list(cause.numbers),
                    "gain": cause.gain,
                    "within_halved": cause.halved,
                    "within_removed": cause.removed,
                    "outputs": {name: asdict(effect) for name, effect in cause.effects.items()},
                }
                for cause in self.causes
            ],
            "notes": list(self.notes),
        }


def tolerance(
    study: Study,
    *,
    progress: ProgressCallback | None = None,
    compute: Evaluator | None = None,
    workers: int | None = None,
    cluster: str | None = None,
) -> Tolerances:
    """What the tolerances of a study do to its outputs, and which to tighten first.

    Parameters
    ----------
    study : varies by normal and uniform tolerances; `sampling.designs` machines are drawn for the
        scatter, and about as many again to separate the tolerances.
    progress : see `ProgressCallback`.
    compute : computes designs instead of the study's own evaluator.
    workers : processes that compute what no loop does, where that takes more than some seconds; as
        many as this machine has processors if not given.
    cluster : address of a Dask scheduler whose workers compute instead, such as
        ``tcp://192.168.0.7:8786``.

    Raises
    ------
    ModelError : something varies that is no tolerance, or there are too few designs; `where` is the
        key of the study.
    UsageError : no machine can be computed.
    """
    _check(study)
    with ExitStack() as exitstack:
        evaluate = compute or exitstack.enter_context(
            pooled(study, workers, cluster, machines_of(study))
        )
        return _tolerances(study, evaluate, progress)


def _tolerances(study: Study, evaluate: Evaluator, progress: ProgressCallback | None) -> Tolerances:
    causes = causes_of(study)
    rows, total = rows_of(study.size, len(causes)), machines_of(study)
    step = min(study.chunk, SLOW_CHUNK)
    run = _Run(evaluate, step, study.chunk, progress, total)
    starts = range(0, study.size, study.chunk)
    joined = run.joined(samples(study, k, min(study.chunk, study.size - k)) for k in starts)
    reasons = joined.counts
    there = np.sum(np.isfinite(joined.figures), axis=0)
    if not reasons[COMPUTED] or not np.all(there):
        raise UsageError(why_none(study.outputs, reasons, np.zeros(len(there))))
    values = [run.joined([table]) for table in tables(study, rows)]
    base = run.compute(study.own[None]).figures[0]
    text = _causes(study, causes, values)
    return Tolerances(
        study=study,
        designs=study.size,
        failures=failures(reasons),
        within=share_of(_kept_all(study, joined)) if _limited(study) else None,
        scatters={
            output.name: scatter_of(output, own, figures)
            for output, own, figures in zip(study.outputs, base, joined.figures.T, strict=True)
        },
        causes=tuple(sorted(text, key=lambda item: -item.gain)),
        rows=rows,
        unchanged=_part(study, values[0]),
        computed=run.done,
        notes=tuple(_notes(study, text, values)),
    )


def rows_of(designs: int, causes: int) -> int:
    """Rows of the tables that separate causes, with about as many machines as the scatter has."""
    return int(2 ** ((designs // (2 + 3 * causes)).bit_length() - 1)) if designs else 0


def machines_of(study: Study) -> int:
    """Machines that are computed in all: those of the scatter and those of the tables."""
    causes = len(causes_of(study))
    return study.size + rows_of(study.size, causes) * (2 + 3 * causes)


def _check(study: Study) -> None:
    for number, item in enumerate(study.vary, 1):
        if not item.spread.tolerance:
            raise ModelError(
                f"vary[{number}]",
                Note(
                    "{path} has a range or a list, which is no tolerance; give normal = {{ "
                    "deviation = ... }} or uniform = {{ half_width = ... }}",
                    path=item.path,
                ),
            )
    causes = len(causes_of(study))
    if rows_of(study.size, causes) < LEAST_ROWS:
        raise ModelError(
            "sampling.designs",
            Note(
                "got {size}; for {count} tolerances give {least} or more"
                if causes > 1
                else "got {size}; for one tolerance give {least} or more",
                size=study.size,
                count=causes,
                least=LEAST_ROWS * (2 + 3 * causes),
            ),
        )


# -- running ---------------------------------------------------------------------------------------


@dataclass
class _Run:
    """Computes machines, and reports progress.

    step : machines that are computed together; twice as many while that is quick, up to `most`.
    """

    compute: Evaluator
    step: int
    most: int
    progress: ProgressCallback | None
    total: int
    done: int = 0

    def joined(self, parts: Iterable[Array]) -> Outcome:
        """What came of all parts (n, d)."""
        result = []
        for part in parts:
            start = 0
            while start < len(part):
                begin = monotonic()
                result.append(self.compute(part[start : start + self.step]))
                if monotonic() - begin < QUICK and 2 * self.step <= self.most:
                    self.step *= 2
                start += len(result[-1].reason)
                self.done += len(result[-1].reason)
                if self.progress is not None:
                    self.progress(self.done, self.total)
        return Outcome.joined(result)


# -- reading off -----------------------------------------------------------------------------------


def _limited(study: Study) -> list[int]:
    """Columns of outputs with limits."""
    return [k for k, output in enumerate(study.outputs) if output.limited]


def _kept_all(study: Study, outcome: Outcome) -> Array:
    inside: Array = np.all(feasible(study.outputs, outcome.figures)[:, _limited(study)], axis=1)
    return inside


def _part(study: Study, outcome: Outcome) -> float | None:
    """Share of the machines of a table within all limits."""
    return float(np.mean(_kept_all(study, outcome))) if _limited(study) else None


def _causes(
    study: Study, causes: Sequence[Sequence[int]], outcomes: Sequence[Outcome]
) -> list[Cause]:
    by_output: dict[str, list[Effect]] = {}
    for k, output in enumerate(study.outputs):
        of_output = effects([item.figures[:, k] for item in outcomes], study.sampling.seed)
        if of_output is not None:
            by_output[output.name] = of_output
    counted = [study.names[k] for k in _limited(study)] or list(study.names)
    text = []
    for number, columns in enumerate(causes):
        each = {name: of_output[number] for name, of_output in by_output.items()}
        gains = [1 - each[name].halved ** 2 for name in counted if name in each]
        text.append(
            Cause(
                numbers=tuple(study.paths[k] for k in columns),
                effects=each,
                gain=float(np.mean(gains)) if gains else 0.0,
                halved=_part(study, outcomes[3 + 3 * number]),
                removed=_part(study, outcomes[4 + 3 * number]),
            )
        )
    return text


def _notes(study: Study, causes: Sequence[Cause], outcomes: Sequence[Outcome]) -> Iterator[str]:
    for k, output in enumerate(study.outputs):
        if output.name not in causes[0].effects:
            there = [bool(np.any(np.isfinite(item.figures[:, k]))) for item in outcomes]
            template = to_say(
                "{output} fails too often, so that no tolerance is named as its cause"
            )
            if all(there):
                template = to_say(
                    "{output} does not vary, so that no tolerance is named as its cause"
                )
            yield Note(template, output=output.name)
    failed = float(np.mean([np.mean(~item.computed) for item in outcomes]))
    if failed > 0:
        yield Note(
            "{share} % of the machines cannot be computed; causes are compared by the others alone",
            share=f"{100 * failed:.2g}",
        )
