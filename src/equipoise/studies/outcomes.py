"""What came of designs: figures and reasons, sums over them, and how far a run is."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from time import monotonic
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from equipoise.codegen.figures import COMPUTED, REASONS

if TYPE_CHECKING:
    from equipoise.studies.design_space import Make, Output

Array = np.ndarray[Any, Any]

WINDOW = 60.0
"""Time over which the rate is taken, s."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """What was computed of some designs (P).

    figures : (P, m) in SI units, one column an output; NaN where a design failed.
    reason : (P,) uint8, a key of `REASONS`; 0 where all figures are there.
    """

    figures: Array
    reason: Array

    @property
    def computed(self) -> Array:
        """Whether each design (P,) has figures."""
        return np.asarray(self.reason == COMPUTED)

    @property
    def counts(self) -> Array:
        """Number of designs by reason, (256,)."""
        return np.bincount(self.reason, minlength=256)

    @classmethod
    def joined(cls, parts: Sequence[Outcome]) -> Outcome:
        """What came of all parts, one after the other."""
        figures, reasons = zip(*((one.figures, one.reason) for one in parts), strict=True)
        return cls(np.concatenate(figures), np.concatenate(reasons))


def failures(counts: Array) -> dict[str, int]:
    """How many designs failed, by why, of numbers by reason (256,)."""
    return {REASONS[k]: int(n) for k, n in enumerate(counts) if n and k != COMPUTED}


def signs_of(makes: Iterable[Make | None]) -> Array:
    """By what figures are multiplied so that all are to become small, (M,)."""
    return np.array([1.0 if make == "smallest" else -1.0 for make in makes])


class Evaluator(Protocol):
    """Computes designs given as values (P, d) in SI units, one column a varied number."""

    def __call__(self, values: Array) -> Outcome: ...


@dataclass(frozen=True, eq=False)
class Block:
    """Some designs (P), one after the other: values (P, d) in SI units, and what came of them."""

    values: Array
    outcome: Outcome


def kept(outputs: Sequence[Output], figures: Array) -> Array:
    """Whether each design keeps each limit, (P, m); `figures` are (P, m)."""
    low = [-np.inf if output.at_least is None else output.at_least for output in outputs]
    high = [np.inf if output.at_most is None else output.at_most for output in outputs]
    inside: Array = (figures >= low) & (figures <= high)
    return inside


@dataclass(frozen=True)
class Progress:
    """How far a sweep is.

    total : designs in all.  done : of them, those that are stored.
    computed : of those, how many were computed in this run, in so many seconds.
    rate : designs a second of late; None as long as there is none.
    failures : how many designs failed, by why; the most frequent first.
    best : the best value so far of each output that is to become small or large, by its name, among
        the designs that keep all limits.
    """

    total: int
    done: int
    computed: int
    seconds: float
    rate: float | None
    failures: Mapping[str, int]
    best: Mapping[str, float]

    @property
    def left(self) -> float | None:
        """Time until everything is done, s; None as long as there is no rate."""
        return (self.total - self.done) / self.rate if self.rate else None


class Tally:
    """Sums over the chunks that are done."""

    def __init__(self, outputs: Sequence[Output], total: int) -> None:
        self.outputs, self.total = outputs, total
        self.done = self.computed = 0
        self.reasons = np.zeros(256, np.int64)
        self.best: dict[str, float] = {}
        self.start = monotonic()
        self.of_late = deque([(self.start, 0)])

    def add(self, block: Block, *, computed: bool) -> None:
        """Count a chunk in: one that was stored before, or one that was computed just now."""
        count = len(block.values)
        self.done += count
        self.reasons += block.outcome.counts
        self._compare(block.outcome)
        if computed:
            self.computed += count
            self.of_late.append((monotonic(), self.computed))
            while len(self.of_late) > 2 and self.of_late[-1][0] - self.of_late[1][0] > WINDOW:
                self.of_late.popleft()

    def _compare(self, outcome: Outcome) -> None:
        good = outcome.computed & kept(self.outputs, outcome.figures).all(axis=1)
        for column, output in enumerate(self.outputs):
            if output.make and good.any():
                best = np.fmin if output.make == "smallest" else np.fmax
                here = float(best.reduce(outcome.figures[good, column]))
                self.best[output.name] = float(best(here, self.best.get(output.name, here)))

    def progress(self) -> Progress:
        """The sums as they stand."""
        (since, before), now = self.of_late[0], monotonic()
        since_then = self.computed - before
        return Progress(
            total=self.total,
            done=self.done,
            computed=self.computed,
            seconds=now - self.start,
            rate=since_then / max(now - since, 1e-9) if since_then else None,
            failures=dict(sorted(failures(self.reasons).items(), key=lambda one: -one[1])),
            best=dict(self.best),
        )
