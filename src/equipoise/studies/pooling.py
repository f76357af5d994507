"""Designs that are given, computed in processes of this machine where that takes long.

A search and an analysis of tolerances draw designs as they go on.  Those that compiled loops
compute take microseconds, and the loops use all processors; the others are shared out.
"""

from __future__ import annotations

import pickle
from functools import lru_cache
from time import monotonic
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from equipoise.codegen.backends import processors
from equipoise.errors import UsageError
from equipoise.studies.evaluate import evaluator
from equipoise.studies.executors import Processes, Task, computed
from equipoise.studies.outcomes import Evaluator, Outcome

if TYPE_CHECKING:
    from equipoise.studies.study import Study

Array = np.ndarray[Any, Any]

PATIENCE = 2.0
"""Time of computing alone after which processes are started, which takes about as long, s."""
QUICK = 0.2
"""Time below which twice as many designs are computed alone before the clock is read again, s."""
SHARES = 4
"""Parts for each process, so that all end at about the same time."""


class DesignSlice(NamedTuple):
    """Some of the designs that are computed together.

    begin : place of the first among them.
    values : (P, d), SI units.
    """

    begin: int
    values: Array


class PooledEvaluator:
    """Computes designs of a study; a context manager, which ends its processes.

    Parameters
    ----------
    workers : processes; as many as this machine has processors if not given.  With one, and where
        loops compute everything, designs are computed here.

    Raises
    ------
    ModelError : an output cannot be computed of any design.
    UsageError : fewer than one worker.
    """

    def __init__(self, study: Study, workers: int | None = None) -> None:
        count = processors() if workers is None else workers
        if count < 1:
            raise UsageError(f"got {count} workers; give 1 or more")
        self.study, self.workers = study, count
        self.alone = evaluator(study)
        self.shared = count > 1 and not getattr(self.alone, "compiled", False)
        self.spent, self.step = 0.0, 1
        self.pool: Processes | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """End its processes."""
        if self.pool is not None:
            self.pool.close()

    def __call__(self, values: Array) -> Outcome:
        """Figures (P, m) of designs (P, d) in SI units, in their order, with reasons of failure.

        Raises
        ------
        UsageError : processes die, such as for want of memory.
        """
        if not self.shared:
            return self.alone(values)
        outcomes, begin = [], 0
        while begin < len(values) and self.pool is None:
            start = monotonic()
            outcomes.append(self.alone(values[begin : begin + self.step]))
            begin += self.step
            took = monotonic() - start
            self.spent += took
            if took < QUICK:
                self.step *= 2
            if self.spent > PATIENCE:
                self.pool = Processes(Task(_compute, pickle.dumps(self.study)), self.workers)
        if begin < len(values) and self.pool is not None:
            outcomes += self._shared_out(self.pool, values[begin:])
        return Outcome.joined(outcomes)

    def _shared_out(self, pool: Processes, values: Array) -> list[Outcome]:
        size = -(-len(values) // (SHARES * self.workers))
        starts = range(0, len(values), size)
        parts = (DesignSlice(start, values[start : start + size]) for start in starts)
        found = {part.begin: outcome for part, outcome in computed(pool, parts)}
        return [found[start] for start in starts]


def _compute(packed: bytes, part: DesignSlice) -> Outcome:
    """In another process: some designs of a study."""
    return _evaluator_of(packed)(part.values)


@lru_cache(maxsize=2)
def _evaluator_of(packed: bytes) -> Evaluator:
    return evaluator(pickle.loads(packed), threads=1)
