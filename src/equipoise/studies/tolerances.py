"""What manufacturing tolerances do to the figures of a machine, and which to tighten first.

The scatter of each figure comes from one run over many machines, whose numbers are drawn from their
tolerances.  Which tolerance causes it comes from a second run of about the same length, see
`equipoise.studies.variance`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict
from time import monotonic
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.codegen.figures import COMPUTED
from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.results.result import Result
from equipoise.studies.evaluate import pooled
from equipoise.studies.outcomes import Evaluator, Outcome, failures, feasible, why_none
from equipoise.studies.sampling import samples
from equipoise.studies.study import SLOW_CHUNK
from equipoise.studies.variance import (
    Effect,
    IntervalEstimate,
    Scatter,
    causes_of,
    effects,
    scatter_of,
    share_of,
    tables,
)

if TYPE_CHECKING:
    from equipoise.studies.study import Study

Array = np.ndarray[Any, Any]

QUICK = 0.1
"""Time after which progress is told, s; more machines are computed together if it takes less."""
LEAST_ROWS = 32
"""Rows of A with which causes are told apart."""

OnProgress = Callable[[int, int], None]
"""Is called with how many machines are computed, and how many there are."""


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

    designs : machines whose scatter is told.  failures : of these by reason.
    within : share of them that keep every limit; None where there are none.
    scatters : by output.
    causes : what to tighten first comes first.
    rows : machines in each of the tables by which causes are told apart.
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

    blocks_in = "studies.tolerance_blocks.tolerances_blocks"

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
    progress: OnProgress | None = None,
    compute: Evaluator | None = None,
    workers: int | None = None,
    cluster: str | None = None,
) -> Tolerances:
    """What the tolerances of a study do to its outputs, and which to tighten first.

    Parameters
    ----------
    study : varies by normal and uniform tolerances; `sampling.designs` machines are drawn for the
        scatter, and about as many again to tell the tolerances apart.
    progress : see `OnProgress`.
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
        evaluate = compute or exitstack.enter_context(pooled(study, workers, cluster))
        return _tolerances(study, evaluate, progress)


def _tolerances(study: Study, evaluate: Evaluator, progress: OnProgress | None) -> Tolerances:
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
    """Rows of the tables that tell causes apart, with about as many machines as the scatter has."""
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
    """Computes machines, and tells how far it is.

    step : machines that are computed together; twice as many while that is quick, up to `most`.
    """

    compute: Evaluator
    step: int
    most: int
    progress: OnProgress | None
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
            what = "does not vary" if all(there) else "fails too often"
            yield f"{output.name} {what}, so that no tolerance is named as its cause"
    failed = float(np.mean([np.mean(~item.computed) for item in outcomes]))
    if failed > 0:
        yield (
            f"{100 * failed:.2g} % of the machines cannot be computed; causes are told apart by "
            "the others alone"
        )
