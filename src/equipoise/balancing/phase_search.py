"""The phases of rows on one shaft that make objectives smallest.

Section 5-5 of Yamashita, Ichikawa and Mori looks for the phase of two rows that makes the standard
deviation of their sum smallest, and 5-6 (1) asks for the phases of all rows at once, which was too
much work then.  Here every arrangement of a grid is looked at, the best ones are polished, what
is better than those is proved not to exist (`phase_bound`), and equal rows are swapped against
twist.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, degrees, pi
from typing import Any

import numpy as np

from equipoise.balancing.multi_row import NOTHING, Combine, Cost, Rows, RowSignals, Term
from equipoise.balancing.phase_bound import CLOSE, prove
from equipoise.balancing.phase_grid import (
    BETTER,
    Grid,
    Twist,
    alike,
    coarsened,
    distinct,
    first_least,
)
from equipoise.balancing.phase_polish import polished
from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.balance import Objective, Phases
from equipoise.mechanism.model import Machine
from equipoise.mechanism.objectives import OF_ROWS
from equipoise.results.result import Result
from equipoise.signals import Array

Progress = Callable[[int, int], None]
"""Is called with the arrangements looked at, and how many there are to look at."""

CANDIDATES, COARSE_CANDIDATES = 16, 40
"""Cells that are polished of each distance apart; where the first grid had to be coarse."""
MOST_KINKED = 6
"""Arrangements that are polished where peaks count, which takes longer."""
GUESSES, FEW_LEVELS = 300, 12
"""Random starts over the number of rows, where a turn of the first grid has so few phases."""
WIDE = pi / 6
"""rad, apart from which cells are in different valleys of the first orders."""
MOST_BEST = 8
"""Arrangements that are as good, among which the twist decides."""


@dataclass(frozen=True, eq=False)
class PhaseSearch:
    """Phases are relative to row 1 here, rad.

    Raises
    ------
    ModelError, UsageError : there is nothing to search.
    """

    machine: Machine
    objectives: tuple[Objective, ...]
    phases: Phases
    combine: Combine

    def __post_init__(self) -> None:
        count, step = len(self.machine.rows), self.phases.step
        if count < 2:
            raise ModelError(
                "rows", f"got {count} rows, which leaves no phase to choose; give two at least"
            )
        if not self.objectives:
            raise UsageError("got no objective; give what is to become small")
        if not 0 < step <= pi / 2 * (1 + 1e-12):
            raise UsageError(
                f"got a step of {degrees(step):g} deg; give more than 0 deg and at most 90 deg"
            )

    @cached_property
    def present(self) -> Array:
        """Phases (m,) of the machine as it is."""
        found = np.array([row.phase for row in self.machine.rows])
        return np.asarray(found - found[0])

    @cached_property
    def rows(self) -> Rows:
        return Rows(self.machine)

    @cached_property
    def force(self) -> RowSignals:
        """Shaking force of the rows."""
        return self.rows.signals(Objective("shaking_force"))

    @cached_property
    def cost(self) -> Cost:
        terms = tuple(self._term(k, wish) for k, wish in enumerate(self.objectives, 1))
        return Cost(terms, self.combine)

    def _term(self, number: int, objective: Objective) -> Term:
        term = Term(objective, self.rows.signals(objective, f"objectives[{number}]"))
        if not term.influenced:
            raise UsageError(
                f"{objective.name}: no phase changes it; choose another output, measure or orders"
            )
        before = float(term.values(self.present))
        return replace(term, scale=term.single if self.vanishes(term) else before)

    def vanishes(self, term: Term) -> bool:
        """Whether an objective is 0 already, so that it counts over the sum of all rows alone."""
        return float(term.values(self.present)) <= BETTER * term.single

    @cached_property
    def levels(self) -> int:
        """Steps in a period."""
        return ceil(2 * pi / self.phases.step * (1 - 1e-9)) * self.force.turns

    @property
    def step(self) -> float:
        """The step asked for, made smaller until it divides a turn, rad."""
        return self.cost.period / self.levels

    @cached_property
    def grid(self) -> Grid | None:
        """The first grid; None where even the coarsest one has too many arrangements."""
        return coarsened(self.cost, self.levels)

    # -- search ------------------------------------------------------------------------------------

    def pool(self, progress: Progress) -> Array:
        """Arrangements (R, m) among which the best one is, the present one first."""
        cells = np.array([self._descended(start) for start in self._starts(progress)])
        if not self.cost.smooth:
            order = np.argsort(self.cost.values(cells), kind="stable")
            cells = distinct(cells[order], self.cost.period, [self.step / 2], MOST_KINKED)
        return np.array([self.present, *map(self.polished, cells)])

    def polished(self, phases: Array) -> Array:
        """Phases (m,) of the least next to these, on the grid where they nearly are."""
        return self._snapped(polished(self.cost, phases, self.step))

    def _starts(self, progress: Progress) -> Array:
        """The best cells (S, m) of the grid; and the present and the equally spaced phases."""
        grid, rows = self.grid, self.cost.rows
        first = [self.present, np.arange(rows) * (self.cost.period / rows)]
        if grid is None or grid.levels < FEW_LEVELS * self.force.turns:
            shape = (max(2, GUESSES // rows), rows)
            guesses = np.random.default_rng(1).uniform(0.0, self.cost.period, shape)
            guesses[:, 0] = 0.0
            first += list(guesses)
        if grid is None:
            progress(len(first), len(first))
            return np.array(first)
        cells = grid.best(lambda done: progress(done, grid.count))
        most = CANDIDATES if grid.levels == self.levels else COARSE_CANDIDATES
        apart = sorted({max(WIDE, grid.step), grid.step}, reverse=True)
        return np.vstack([*first, distinct(cells, self.cost.period, apart, most)])

    def _descended(self, phases: Array) -> Array:
        """The arrangement from which no single row can be moved by a step for the better."""
        each = np.eye(len(phases))[1:]
        moves = self.step * np.vstack([np.zeros(len(phases)), each, -each])
        for _ in range(self.levels if self.grid is not None else 0):
            values = self.cost.values(phases + moves)
            best = int(np.argmin(values))
            if not values[best] < values[0] * (1 - BETTER):
                break
            phases = phases + moves[best]
        return phases

    def _snapped(self, phases: Array) -> Array:
        """Phases on the grid where they are there but for rounding."""
        near = np.round(phases / self.step) * self.step
        near = np.where(np.abs(near - phases) < 1e-6, near, phases)
        as_good = self.cost.values(near) <= self.cost.values(phases) + NOTHING * self._alone
        return np.asarray((near if as_good else phases) % self.cost.period)

    @cached_property
    def _alone(self) -> float:
        """Combined value of all rows without any cancelling."""
        return float(self.cost.of([term.single for term in self.cost.terms]))

    # -- choice ------------------------------------------------------------------------------------

    def best(self, pool: Array) -> Array:
        """The best arrangement (m,); the present one, which is the first, if none is better.

        Of those that are as good, and of those that swap equal rows, it is the one with the least
        roll and yaw moment, as section 5-5 of Yamashita, Ichikawa and Mori wants rows arranged.
        """
        values = self.cost.values(pool)
        limit = np.min(values) * (1 + BETTER) + NOTHING * self._alone
        if values[0] <= limit:
            return np.asarray(pool[0])
        good = distinct(pool[values <= limit], self.cost.period, [1e-6], MOST_BEST)
        lateral = np.array([row.lateral for row in self.machine.rows])
        twist = Twist(self.force, lateral, alike(self.cost))
        laid = [twist.swapped(phases) for phases in good]
        found = laid[first_least(np.array([float(twist.of(phases)[0]) for phases in laid]))]
        return np.asarray((found - found[0]) % self.cost.period)


SURVIVES = 1e-9
"""Share of the largest amplitude of all rows in phase, above which an order is left."""


@dataclass(frozen=True, eq=False, repr=False)
class Phasing(Result):
    """Phases found for the rows of a machine.

    machine : with the rows in these phases.  phases : rad, of each row; row 1 has kept its own.
    before, after : objective -> its value, in SI units.
    combined : all objectives together, before and after; each counts over its value before.
    remaining : orders of the shaking force of all rows together that are left.
    lateral : ``roll_moment`` and ``yaw_moment`` -> RMS before and after, N m.
    combinations : arrangements that the first grid has, of `step`, rad; 0 without a grid.
    bound : proved, of all objectives together in any phases.  looked_at : boxes that it took.
    """

    machine: Machine
    phases: tuple[float, ...]
    before: Mapping[str, float]
    after: Mapping[str, float]
    combined: tuple[float, float]
    remaining: tuple[float, ...]
    lateral: Mapping[str, tuple[float, float]]
    combinations: int
    step: float
    bound: float
    looked_at: int
    notes: tuple[Note, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """The machine-readable output, in SI units and rad."""
        return {
            "title": self.machine.title,
            "phases": list(self.phases),
            "objectives": [
                {"name": name, "before": self.before[name], "after": self.after[name]}
                for name in self.before
            ],
            "combined": {"before": self.combined[0], "after": self.combined[1]},
            "remaining_orders": list(self.remaining),
            "lateral": {
                name: {"before": before, "after": after}
                for name, (before, after) in self.lateral.items()
            },
            "bound": self.bound,
            "looked_at": self.looked_at,
            "combinations": self.combinations,
            "step": self.step,
            "notes": list(map(str, self.notes)),
        }


def choose_phases(
    machine: Machine,
    objectives: Sequence[Objective],
    phases: Phases | None = None,
    combine: Combine = "sum",
    progress: Progress | None = None,
) -> Phasing:
    """Find the phases of a machine's rows that make objectives smallest; row 1 keeps its own.

    Where several are as good, those with the least roll and yaw moment.  None is below `bound`.

    Parameters
    ----------
    objectives : outputs with their measures; see `multi_row.Rows.signals`.
    phases : how finely to look; every 5 deg if None.
    combine : several objectives by their weighted sum, or by the root of the sum of squares.
    progress : is told how many arrangements of the grid have been looked at.

    Raises
    ------
    ModelError : there are fewer than two rows, or an objective cannot be measured.
    UsageError : no phase changes an objective, or there is none.
    MassError, MotionError, ResponseError : the machine cannot be computed.
    """
    search = PhaseSearch(machine, tuple(objectives), phases or Phases(), combine)
    present, cost, grid = search.present, search.cost, search.grid
    pool = search.pool(progress or (lambda done, total: None))
    found = search.best(pool)
    proof = prove(cost, found, search.polished)
    if proof.phases is not found:
        found = search.best(np.vstack([pool, proof.phases]))
    placed = _placed(search, found)
    varying = (Objective(output, "ripple") for output in OF_ROWS)
    lateral = [Term(wish, search.rows.signals(wish)) for wish in varying]
    before, after = (
        {one.objective.name: one.value_at(at) for one in cost.terms} for at in (present, found)
    )
    force = search.force
    left = np.max(np.abs(force.total(found)[0]), axis=0)[1:]
    loudest = float(np.max(np.abs(force.amplitudes), initial=0.0)) * len(found)
    return Phasing(
        machine=placed,
        phases=tuple(row.phase for row in placed.rows),
        before=before,
        after=after,
        combined=(float(cost.of([*before.values()])), float(cost.of([*after.values()]))),
        remaining=tuple(force.orders[1:][left > SURVIVES * loudest].tolist()),
        lateral={
            one.objective.output: (one.value_at(present), one.value_at(found)) for one in lateral
        },
        combinations=0 if grid is None else grid.count,
        step=search.step if grid is None else grid.step,
        bound=proof.bound,
        looked_at=proof.boxes,
        notes=tuple(_notes(search, found, float(cost.values(found)) - proof.bound)),
    )


def _placed(search: PhaseSearch, found: Array) -> Machine:
    """The machine with phases (m,) relative to row 1."""
    if found is search.present or np.all(found == search.present):
        return search.machine
    first, *others = search.machine.rows
    turned = (first.phase + found[1:]) % search.cost.period
    moved = [replace(row, phase=phase) for row, phase in zip(others, turned.tolist(), strict=True)]
    return search.machine.with_rows([first, *moved])


def _notes(search: PhaseSearch, found: Array, gap: float) -> Iterator[Note]:
    if np.all(found == search.present):
        yield Note("no phases were found that are better than the present ones")
    grid = search.grid
    if grid is None:
        yield Note("there are too many rows for a grid: random arrangements were polished instead")
    elif grid.levels < search.levels:
        yield Note(
            "a grid of {step} deg has too many arrangements: one of {coarse} deg "
            "was looked at as a whole, and the fine one about its best "
            "arrangements",
            step=f"{np.degrees(search.step):.4g}",
            coarse=f"{np.degrees(grid.step):.4g}",
        )
    for term in search.cost.terms:
        if search.vanishes(term):
            yield Note(
                "{name} is 0 before, so it counts over the sum of what each row does alone",
                name=term.objective.name,
            )
    if gap > CLOSE * search.cost.whole:
        yield Note(
            "the search ended before it had proved that nothing better exists; "
            "the gap tells how far it came"
        )
