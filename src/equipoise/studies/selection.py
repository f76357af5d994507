"""The best designs of a store: those that keep every limit, by one figure or by several."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from equipoise.codegen.figures import COMPUTED, REASONS
from equipoise.errors import UsageError
from equipoise.mechanism.checks import unknown
from equipoise.results.result import Result
from equipoise.studies.design_space import Make, Output
from equipoise.studies.extras import needed
from equipoise.studies.outcomes import kept, signs_of

if TYPE_CHECKING:
    from equipoise.studies.outcomes import Block
    from equipoise.studies.store import Store

Array = np.ndarray[Any, Any]


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


COUNT = 10
"""Designs that are told, if not told otherwise."""


@dataclass(frozen=True, repr=False)
class Best(Result):
    """The best designs of a store, K of them.

    by : what makes them the best, and which way; several give a Pareto front.
    designs : (K,) their numbers.  values : (K, d).  figures : (K, m).  SI units.
    numbers, outputs : names of the columns of values and figures.
    front : number of designs that no other beats in everything, of which K are told; 1 where there
        is one figure to go by, but for others just as good.
    kept, computed, stored : number of designs that keep every limit, that have figures, that are
        stored at all.
    """

    records: ClassVar[str] = "designs"

    by: Mapping[str, Make]
    numbers: tuple[str, ...]
    outputs: tuple[str, ...]
    designs: Array
    values: Array
    figures: Array
    front: int
    kept: int
    computed: int
    stored: int

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units."""
        rows = zip(self.designs.tolist(), self.values.tolist(), self.figures.tolist(), strict=True)
        return {
            "by": dict(self.by),
            "front": self.front,
            "kept": self.kept,
            "computed": self.computed,
            "stored": self.stored,
            "designs": [
                {
                    "design": design,
                    "values": dict(zip(self.numbers, values, strict=True)),
                    "figures": dict(zip(self.outputs, figures, strict=True)),
                }
                for design, values, figures in rows
            ],
        }


def best(store: Store, count: int = COUNT, by: Mapping[str, Make | None] | None = None) -> Best:
    """The best designs that are stored so far, of those that keep every limit.

    Parameters
    ----------
    count : the most that are told; of a larger front some that lie far from each other.
    by : outputs, or varied numbers, to go by instead of the objectives of the study, each
        ``smallest`` or ``largest``; where None, as the study has it, or ``smallest``.

    Raises
    ------
    UsageError : there is nothing to go by, nothing is stored, or no design keeps the limits.
    """
    if count < 1:
        raise UsageError(f"got {count} designs; give 1 or more")
    outputs = outputs_of(store)
    ways = _ways(store, outputs, by)
    search = _Choice(store, outputs, ways, count)
    for start, block in store.in_blocks():
        search.add(start, block)
    search.check()
    return search.result()


def outputs_of(store: Store) -> tuple[Output, ...]:
    """Outputs of the study in a store, with their limits."""
    return tuple(Output(**output) for output in json.loads(store.texts["study"])["outputs"])


def _ways(
    store: Store, outputs: Sequence[Output], by: Mapping[str, Make | None] | None
) -> dict[str, Make]:
    makes = {output.name: output.make for output in outputs if output.make}
    if not by:
        if not makes:
            raise UsageError(
                "no output of the study is to become small or large; name one to go by, or give it "
                'make = "smallest" in the study'
            )
        return makes
    known = [*store.outputs, *store.numbers]
    for name in by:
        if name not in known:
            raise UsageError(unknown(name, known, "output or varied number"))
    return {name: way or makes.get(name) or "smallest" for name, way in by.items()}


class _Choice:
    """What is known of the designs so far."""

    def __init__(
        self, store: Store, outputs: Sequence[Output], ways: Mapping[str, Make], count: int
    ) -> None:
        self.store, self.outputs, self.ways, self.count = store, outputs, ways, count
        columns = [*store.numbers, *store.outputs]
        self.places = [columns.index(name) for name in ways]
        self.signs = signs_of(ways.values())
        self.reasons = np.zeros(256, np.int64)
        self.limits = np.zeros(len(outputs), np.int64)
        self.kept = 0
        self.designs = np.empty(0, np.int64)
        self.rows = np.empty((0, len(columns)))

    def add(self, start: int, block: Block) -> None:
        """Take in designs that follow each other from a number on."""
        self.reasons += block.outcome.counts
        computed = np.flatnonzero(block.outcome.computed)
        figures = block.outcome.figures[computed]
        inside = kept(self.outputs, figures)
        self.limits += np.sum(inside, axis=0)
        good = np.all(inside, axis=1)
        self.kept += int(np.sum(good))
        rows = np.hstack([block.values[computed[good]], figures[good]])
        self.designs = np.concatenate([self.designs, start + computed[good]])
        self.rows = np.concatenate([self.rows, rows])
        best_so_far = self.best()
        self.designs, self.rows = self.designs[best_so_far], self.rows[best_so_far]

    @property
    def costs(self) -> Array:
        costs: Array = self.rows[:, self.places] * self.signs
        return costs

    def best(self) -> Array:
        """Places of the rows that may still be among the best."""
        if len(self.ways) > 1:
            return non_dominated(self.costs)
        return np.argsort(self.costs[:, 0], kind="stable")[: self.count]

    def check(self) -> None:
        """Say why there is no best design, if there is none."""
        if self.kept:
            return
        where = self.store.path
        if not np.any(self.reasons[list(REASONS)]):
            raise UsageError(
                f"{where}: nothing is computed yet; go on with: equipoise resume {where}"
            )
        units = [self.store.units.get(output.name, "") for output in self.outputs]
        raise UsageError(f"{where}: {why_none(self.outputs, self.reasons, self.limits, units)}")

    def result(self) -> Best:
        size = len(self.designs) if len(self.ways) > 1 else 1
        told = far_apart(self.costs, self.count) if len(self.ways) > 1 else slice(None)
        designs, rows = self.designs[told], self.rows[told]
        if len(self.ways) > 1:
            order = np.argsort(self.costs[told][:, 0], kind="stable")
            designs, rows = designs[order], rows[order]
        split = len(self.store.numbers)
        stored = sum(int(self.reasons[k]) for k in REASONS)
        return Best(
            by=dict(self.ways),
            numbers=self.store.numbers,
            outputs=self.store.outputs,
            designs=designs,
            values=rows[:, :split],
            figures=rows[:, split:],
            front=size,
            kept=self.kept,
            computed=int(self.reasons[COMPUTED]),
            stored=stored,
        )


def why_none(
    outputs: Sequence[Output], reasons: Array, limits: Array, units: Sequence[str] = ()
) -> str:
    """Say why no design keeps every limit.

    reasons : number of designs by reason, (256,).  limits : those that keep each output's, (m,).
    """
    computed = int(reasons[COMPUTED])
    if not computed:
        failed = [f"{what}: {reasons[k]}" for k, what in REASONS.items() if reasons[k]]
        return (
            f"no design has figures ({', '.join(failed)}); let the numbers vary closer to those "
            "of the model"
        )
    named = zip(outputs, units or [""] * len(outputs), limits, strict=True)
    told = [f"{_limit(one, unit)} by {n}" for one, unit, n in named if one.limited]
    return (
        f"none of {computed} designs keeps every limit; kept is {', '.join(told)}; loosen a limit, "
        "or let more vary"
    )


def _limit(output: Output, unit: str) -> str:
    """Such as ``2 <= lift <= 3 m``."""
    low, high = output.at_least, output.at_most
    text = output.name if low is None else f"{low:g} <= {output.name}"
    text = text if high is None else f"{text} <= {high:g}"
    return f"{text} {unit}".strip()
