"""What computes the designs of a problem, in processes of this machine where that takes long.

A search and an analysis of tolerances draw designs as they go on, and a map has them all.  Those
that compiled loops compute take microseconds, and the loops use all processors; the others are
shared out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from time import monotonic
from typing import Any, Generic, NamedTuple, Self, TypeVar

import numpy as np

from equipoise.design.processes import ChunkTask, Pool, Runner

Array = np.ndarray[Any, Any]
Figures = TypeVar("Figures")
"""What is computed of some designs, in their order: an array (P, ...), or figures with reasons."""
Evaluate = Callable[[Array], Figures]
"""Computes designs (P, d), values in SI units."""
OnDesigns = Callable[[int], None]
"""Is called with the designs of a call that are computed so far."""

PATIENCE = 2.0
"""Time of computing alone after which processes are started, which takes about as long, s."""
QUICK = 0.2
"""Time below which twice as many designs are computed alone before the clock is read again, s."""
SHARES = 4
"""Parts for each process at least, so that all end at about the same time."""
HANDY = 0.05
"""Time of designs that are computed here though there are processes, s: to send them there and back
takes some milliseconds, and whoever descends asks for few at a time."""
PART = 1.0
"""Time that a part takes at most, so that progress is told, s."""


class DesignSlice(NamedTuple):
    """Some of the designs that are computed together.

    begin : place of the first among them.
    values : (P, d), SI units.
    """

    begin: int
    values: Array


class PooledEvaluator(Generic[Figures]):
    """Computes designs; a context manager, which ends its processes.

    Parameters
    ----------
    alone : computes designs here.
    make : makes the same in another process, to which it goes as bytes.
    join : what several parts give, one after the other, as one.
    workers : processes; as many as this machine has processors if not given.  With one, designs
        are computed here.
    shared : whether processes help at all; not where loops use all processors.
    together : designs that are sent together where there are as many for each process: those that
        one run of arrays computes take longer in small parts.
    elsewhere : begins a pool of others that compute instead, such as a cluster, once it is known
        how long a design takes.

    Raises
    ------
    UsageError : fewer than one worker; or as `elsewhere`.
    """

    def __init__(
        self,
        alone: Evaluate[Figures],
        make: Callable[[], Evaluate[Figures]],
        join: Callable[[Sequence[Figures]], Figures],
        workers: int | None = None,
        *,
        shared: bool = True,
        together: int = 1,
        elsewhere: Callable[[ChunkTask], Pool] | None = None,
    ) -> None:
        self.alone, self.join, self.together = alone, join, together
        self.runner: Runner[DesignSlice, Figures] = Runner(
            lambda part: alone(part.values), partial(_of_parts, make), workers, elsewhere=elsewhere
        )
        self.shared = elsewhere is not None or (self.runner.workers > 1 and shared)
        self.patience = PATIENCE if elsewhere is None else QUICK
        self.spent, self.count, self.step = 0.0, 0, 1

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """End its processes."""
        self.runner.close()

    @property
    def is_shared_out(self) -> bool:
        """Whether others compute, since computing alone has taken long."""
        return self.shared and self.spent > self.patience

    def __call__(self, values: Array, progress: OnDesigns | None = None) -> Figures:
        """What is computed of designs (P, d), SI units, in their order.

        Raises
        ------
        UsageError : processes die, such as for want of memory.
        """
        if not self.shared and progress is None:
            return self.alone(values)
        tell = progress or (lambda _: None)
        if self.is_shared_out and self.spent * len(values) < HANDY * self.count:
            return self.alone(values)
        outcomes, begin = [], 0
        while begin < len(values) and not (self.count and self.is_shared_out):
            start = monotonic()
            part = values[begin : begin + self.step]
            outcomes.append(self.alone(part))
            begin += len(part)
            took = monotonic() - start
            self.spent, self.count = self.spent + took, self.count + len(part)
            if took < QUICK:
                self.step *= 2
            tell(begin)
        if begin < len(values):
            outcomes += self._shared_out(values[begin:], lambda k: tell(begin + k))
        return self.join(outcomes)

    def _shared_out(self, values: Array, tell: OnDesigns) -> list[Figures]:
        workers = self.runner.workers
        share = -(-len(values) // (SHARES * workers))
        size = max(1, min(share, int(PART * self.count / max(self.spent, 1e-9))))
        size = max(size, min(self.together, -(-len(values) // workers)))
        starts = range(0, len(values), size)
        parts = (DesignSlice(start, values[start : start + size]) for start in starts)
        result, done = {}, 0
        for part, outcome in self.runner.each(parts):
            result[part.begin] = outcome
            done += len(part.values)
            tell(done)
        return [result[start] for start in starts]


def _of_parts(make: Callable[[], Evaluate[Any]]) -> Callable[[DesignSlice], Any]:
    """In another process: what computes parts."""
    evaluate = make()
    return lambda part: evaluate(part.values)
