"""What came of designs: figures and reasons, which are the best, sums, and how far a run is."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from time import monotonic, perf_counter
from typing import TYPE_CHECKING, Any, Protocol, cast

import numpy as np

from equipoise.codegen.figures import COMPUTED, REASONS
from equipoise.dataclass import dataclass
from equipoise.errors import needed
from equipoise.i18n import Note
from equipoise.quantities import Display, display
from equipoise.signals import Array

if TYPE_CHECKING:
    from equipoise.keys.requirement_kinds import Make
    from equipoise.quantities import Dimension
    from equipoise.studies.study import Output


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
        figures, reasons = zip(*((part.figures, part.reason) for part in parts), strict=True)
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
class DesignBlock:
    """Some designs (P), one after the other: values (P, d) in SI units, and what came of them."""

    values: Array
    outcome: Outcome


def feasible(outputs: Sequence[Output], figures: Array) -> Array:
    """Whether each design keeps each limit, (P, m); `figures` are (P, m)."""
    return np.stack(
        [
            output.requirement.satisfied(column)
            for output, column in zip(outputs, figures.T, strict=True)
        ],
        axis=1,
    )


def design_records(
    numbers: Sequence[str], values: Array, outputs: Sequence[str], figures: Array
) -> list[dict[str, Any]]:
    """Designs (K), each with its values (K, d) of numbers and figures (K, m) of outputs by name."""
    return [
        {
            "values": dict(zip(numbers, row, strict=True)),
            "figures": dict(zip(outputs, figure, strict=True)),
        }
        for row, figure in zip(values.tolist(), figures.tolist(), strict=True)
    ]


# -- which are the best ----------------------------------------------------------------------------


def non_dominated(costs: Array) -> Array:
    """Places of the rows of costs (n, M) that no other row dominates, in order; all to be small.

    Of equal rows only the first is taken.

    Raises
    ------
    UsageError : the library for several costs is not installed.
    """
    if costs.shape[1] == 1 or len(costs) < 2:
        return np.array([np.argmin(costs[:, 0])] if len(costs) else [], np.intp)
    moocore = needed("moocore", "a choice by several figures")
    return np.flatnonzero(moocore.is_nondominated(costs, keep_weakly=False))


def far_apart(costs: Array, count: int) -> Array:
    """Places of so many rows of costs (n, M) that lie far from each other, in order.

    The best of each cost first, then whichever is furthest from all that are taken, each cost
    measured over its range.
    """
    if not 0 < count < len(costs):
        return np.arange(min(count, len(costs)))
    low, high = costs.min(axis=0), costs.max(axis=0)
    places = (costs - low) / np.where(high > low, high - low, 1.0)
    taken = list(dict.fromkeys(int(k) for k in np.argmin(places, axis=0)))[:count]
    gap = np.min([np.sum((places - places[k]) ** 2, axis=1) for k in taken], axis=0)
    while len(taken) < count:
        gap[taken] = -1.0
        furthest = int(np.argmax(gap))
        taken.append(furthest)
        gap = np.minimum(gap, np.sum((places - places[furthest]) ** 2, axis=1))
    return np.sort(taken)


def why_none(
    outputs: Sequence[Output], reasons: Array, limits: Array, units: Sequence[str] = ()
) -> Note:
    """Say why no design keeps every limit.

    reasons : number of designs by reason, (256,).  limits : those that keep each output's, (m,).
    """
    computed = int(reasons[COMPUTED])
    if not computed:
        failed = [f"{what}: {reasons[k]}" for k, what in REASONS.items() if reasons[k]]
        return Note(
            "no design has figures ({names}); let the numbers vary closer to those of the model",
            names=", ".join(failed),
        )
    named = zip(outputs, units or [""] * len(outputs), limits, strict=True)
    texts = [f"{_limit(item, unit)}: {int(n)}" for item, unit, n in named if item.limited]
    return Note(
        "none of {computed} designs keeps every limit; designs that keep each limit: {names}; "
        "loosen a limit, or let more vary",
        computed=computed,
        names=", ".join(texts),
    )


def _limit(output: Output, unit: str) -> str:
    """Such as ``2 <= lift <= 3 m``.

    unit : SI, of a figure whose dimension is unknown; others are in the unit in which they are
        shown everywhere.
    """
    low, high = output.at_least, output.at_most
    if output.dimension is None:
        unit_display = Display(unit, 1.0)
    else:
        dimension = cast("Dimension", output.dimension)
        unit_display = display(dimension, [limit for limit in (low, high) if limit is not None])
    text = output.name
    if low is not None and high is not None:
        text = f"{_in(low, unit_display)} <= {text} <= {_in(high, unit_display)}"
    elif low is not None:
        text = f"{text} >= {_in(low, unit_display)}"
    elif high is not None:
        text = f"{text} <= {_in(high, unit_display)}"
    return unit_display.with_unit(text)


def _in(value: float, unit_display: Display) -> str:
    """A limit (SI) as it may stand in a file, without its unit."""
    return f"{value * unit_display.factor:g}"


PATIENCE, STILL, MARGIN = 20, 1e-4, 0.1
"""The search stands still if so many generations have added less than this share of the volume,
which reaches by a margin beyond the worst of the front."""


class Hypervolumes:
    """How much the front has grown."""

    def __init__(self) -> None:
        self.fronts: list[Array] = []

    def add(self, costs: Array) -> None:
        self.fronts.append(costs)

    @property
    def still(self) -> bool:
        """Whether the last generations have added next to nothing."""
        if len(self.fronts) <= PATIENCE or not len(self.fronts[-1 - PATIENCE]):
            return False
        before, now = self.fronts[-1 - PATIENCE], self.fronts[-1]
        if now.shape[1] == 1:
            gained = float(before[0, 0] - now[0, 0])
            return gained <= STILL * abs(float(now[0, 0]))
        old, new = self.volume(before), self.volume(now)
        return new - old <= STILL * new

    def volume(self, costs: Array) -> float:
        """Share of a box about the last front that costs (K, M) dominate."""
        from pymoo.indicators.hv import HV

        last = self.fronts[-1]
        low, high = last.min(axis=0), last.max(axis=0)
        wide = np.where(high > low, high - low, 1.0)
        places = (costs - low) / wide
        corner = 1 + MARGIN
        inside = places[np.all(places < corner, axis=1)]
        if not len(inside):
            return 0.0
        return float(HV(ref_point=np.full(len(low), corner))(inside)) / corner ** len(low)

    @property
    def all(self) -> Array:
        """Of every generation; NaN where there was no front yet."""
        if self.fronts[-1].shape[1] == 1:
            return np.array([f[0, 0] if len(f) else np.nan for f in self.fronts])
        return np.array([self.volume(f) if len(f) else np.nan for f in self.fronts])


# -- how far a run is ------------------------------------------------------------------------------


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

    def add(self, block: DesignBlock, *, computed: bool) -> None:
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
        good = outcome.computed & feasible(self.outputs, outcome.figures).all(axis=1)
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
            failures=dict(sorted(failures(self.reasons).items(), key=lambda item: -item[1])),
            best=dict(self.best),
        )


# -- how long a run takes --------------------------------------------------------------------------

FIRST_BATCH, LONGEST = 8, 1.0
"""So many times as many designs are computed next, unless that would take longer than this, s."""


@dataclass(frozen=True)
class Estimate:
    """How long designs take.

    designs : of one chunk that were computed.  rate : designs a second on one processor.
    workers : processors that have a chunk to compute.  seconds : for all designs on these.
    """

    designs: int
    rate: float
    workers: int
    seconds: float


def estimated(
    compute: Callable[[range], object], size: int, chunk: int, processors: int
) -> Estimate:
    """How long a number of designs take, from the chunk in their middle, or what is quick of it.

    compute : computes designs by their numbers, on one processor.
    """
    chunks = -(-size // chunk)
    begin = chunks // 2 * chunk

    def timed(count: int) -> float:
        start = perf_counter()
        compute(range(begin, begin + count))
        return max(perf_counter() - start, 1e-9)

    most, count = min(chunk, size - begin), 1
    timed(1)  # what is loaded and compiled at first is no part of a rate
    while True:
        seconds = timed(count)
        following = min(FIRST_BATCH * count, most)
        if following == count or following / count * seconds > LONGEST:
            break
        count = following
    workers = min(processors, chunks)
    return Estimate(count, count / seconds, workers, size * seconds / (count * workers))
