"""The phases of rows on one shaft that make objectives smallest.

Section 5-5 of Yamashita, Ichikawa and Mori looks for the phase of two rows that makes the standard
deviation of their sum smallest, and 5-6 (1) asks for the phases of all rows at once, which was too
much work then.  Here every arrangement of a grid is looked at, the best ones are polished, what
is better than those is proved not to exist (`phase_bound`), and equal rows are swapped against
twist.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from math import ceil, degrees, pi

import numpy as np

from equipoise.balancing.cylinder_phasing import (
    NOTHING,
    Combine,
    Cost,
    PhasedRows,
    PhaseObjective,
    RowSignals,
)
from equipoise.balancing.phase_grid import (
    BETTER,
    PhaseGrid,
    Twist,
    alike,
    coarsened,
    distinct,
    first_least,
)
from equipoise.balancing.phase_polish import Step, most_steps, polished
from equipoise.balancing.rounding import NEARLY
from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.parts.balance import Limit, Objective, Phases
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import Array

Progress = Callable[[int, int], None]
"""Is called with the steps done of a part of the work, and how many that part has at most: the
arrangements of the grid, steps of refining the best of them, boxes of the proof.
"""

CANDIDATES, COARSE_CANDIDATES = 16, 40
"""Cells that are polished of each distance apart; where the first grid had to be coarse."""
MOST_KINKED = 6
"""Arrangements that are polished where peaks count, which takes longer."""
GUESSES, FEW_LEVELS = 300, 12
"""Random starts over the number of rows, where a turn of the first grid has so few phases."""
WIDE = pi / 6
"""rad, apart from which cells are in different valleys of the first orders."""
SAME_PHASE = 1e-6
"""rad: phases so close count as one, as the flat bottom of a cost resolves them to 1e-8 only."""
MOST_BEST = 8
"""Arrangements that are as good, among which the twist decides."""


def stepped(progress: Progress, begin: int, most: int, total: int) -> Step:
    """What is called after each of at most so many steps, which follow others that are done.

    It is called once here, where nothing is done yet.
    """
    done = itertools.count()

    def after() -> None:
        progress(begin + min(next(done), most), total)

    after()
    return after


@dataclass(frozen=True, eq=False)
class PhaseSearch:
    """Phases are relative to row 1 here, rad.

    known_cost : what is to become small, where it does not follow from the machine as it is.

    Raises
    ------
    ModelError, UsageError : there is nothing to search.
    """

    machine: Machine
    objectives: tuple[Objective, ...]
    phases: Phases
    combine: Combine
    limits: tuple[Limit, ...] = ()
    known_cost: Cost | None = None

    def __post_init__(self) -> None:
        count, step = len(self.machine.rows), self.phases.step
        if count < 2:
            raise ModelError(
                "rows",
                Note(
                    "got {count} rows, which leaves no phase to choose; give two at least",
                    count=count,
                ),
            )
        if not self.objectives:
            raise UsageError(Note("got no objective; give an output to minimize"))
        if not 0 < step <= pi / 2 * (1 + NEARLY):
            raise UsageError(
                Note(
                    "got a step of {step:g} deg; give more than 0 deg and at most 90 deg",
                    step=degrees(step),
                )
            )

    @cached_property
    def present(self) -> Array:
        """Phases (m,) of the machine as it is."""
        values = np.array([row.phase for row in self.machine.rows])
        return np.asarray(values - values[0])

    @cached_property
    def rows(self) -> PhasedRows:
        return PhasedRows(self.machine)

    @cached_property
    def force(self) -> RowSignals:
        """Shaking force of the rows."""
        return self.rows.signals(Objective("shaking_force"))

    @cached_property
    def cost(self) -> Cost:
        if self.known_cost is not None:
            return self.known_cost
        terms = tuple(self._term(k, wish) for k, wish in enumerate(self.objectives, 1))
        return Cost(terms, self.combine, tuple(map(self._limit, self.limits)))

    def _term(self, number: int, objective: Objective) -> PhaseObjective:
        term = PhaseObjective(objective, self.rows.signals(objective, f"objectives[{number}]"))
        if not term.influenced:
            raise UsageError(
                Note(
                    "{name}: no phase changes it; choose another output, measure or orders",
                    name=objective.name,
                )
            )
        before = float(term.values(self.present))
        return replace(term, scale=term.single if self.vanishes(term) else before)

    def value_of(self, objective: Objective) -> float:
        """Value of an objective with the phases of the machine as it is."""
        return PhaseObjective(objective, self.rows.signals(objective)).value_at(self.present)

    def _limit(self, limit: Limit) -> PhaseObjective:
        term = PhaseObjective(limit.objective, self.rows.signals(limit.objective, "limits"))
        before = float(term.values(self.present))
        most = limit.most(before)
        if not most > NOTHING * term.single:
            raise UsageError(
                Note(
                    "the {name} is 0 before, of which there is no share; give the limit in a unit",
                    name=limit.name,
                )
            )
        return replace(term, scale=most)

    def vanishes(self, term: PhaseObjective) -> bool:
        """Whether an objective is 0 already, so that it counts over the sum of all rows alone."""
        return float(term.values(self.present)) <= BETTER * term.single

    @cached_property
    def levels(self) -> int:
        """Steps in a period."""
        return ceil(2 * pi / self.phases.step * (1 - NEARLY)) * self.force.turns

    @property
    def step(self) -> float:
        """The step asked for, made smaller until it divides a turn, rad."""
        return self.cost.period / self.levels

    @cached_property
    def grid(self) -> PhaseGrid | None:
        """The first grid; None where even the coarsest one has too many arrangements."""
        return coarsened(self.cost, self.levels)

    # -- search ------------------------------------------------------------------------------------

    def pool(self, progress: Progress) -> Array:
        """Arrangements (R, m) among which the best one is, the present one first."""
        cells = np.array([self._descended(start) for start in self._starts(progress)])
        if not self.cost.smooth:
            order = np.argsort(self.cost.values(cells), kind="stable")
            cells = distinct(cells[order], self.cost.period, [self.step / 2], MOST_KINKED)
        most, presents = most_steps(self.cost), [self.present]
        for k, phases in enumerate(cells):  # of long cycles each takes seconds, or a minute
            after = stepped(progress, k * most, most, len(cells) * most)
            presents.append(self.polished(phases, after))
        progress(len(cells) * most, len(cells) * most)
        return np.array(presents)

    def polished(self, phases: Array, after: Step = lambda: None) -> Array:
        """Phases (m,) of the least next to these, on the grid where they nearly are."""
        return self._snapped(polished(self.cost, phases, self.step, after))

    def improved(self, phases: Array, known: float) -> tuple[Array, float]:
        """Polished phases and their cost, where better than what is known; else an infinite cost.

        Peaks that are read at samples flatter.
        """
        if not self.cost.values(phases) < known:
            return phases, np.inf
        values = self.polished(phases)
        return values, float(self.cost.values(values))

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
        snapped = np.round(phases / self.step) * self.step
        snapped = np.where(np.abs(snapped - phases) < SAME_PHASE, snapped, phases)
        as_good = self.cost.values(snapped) <= self.cost.values(phases) + NOTHING * self._alone
        return np.asarray((snapped if as_good else phases) % self.cost.period)

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
        good = distinct(pool[values <= limit], self.cost.period, [SAME_PHASE], MOST_BEST)
        lateral = np.array([row.lateral for row in self.machine.rows])
        twist = Twist(self.force, lateral, alike(self.cost))
        laid = [twist.swapped(phases) for phases in good]
        result = laid[first_least(np.array([float(twist.of(phases)[0]) for phases in laid]))]
        return np.asarray((result - result[0]) % self.cost.period)


def with_phases(machine: Machine, phases: Array, period: float) -> Machine:
    """The machine with phases (m,) relative to row 1, which keeps its own, rad."""
    first, *others = machine.rows
    turned = (first.phase + phases[1:]) % period
    pairs = zip(others, turned.tolist(), strict=True)
    return machine.with_rows([first, *(replace(row, phase=phase) for row, phase in pairs)])
