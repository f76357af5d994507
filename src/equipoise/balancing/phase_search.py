"""The phases of rows on one shaft that make objectives smallest, and what they bring.

Section 5-5 of Yamashita, Ichikawa and Mori looks for the phase of two rows that makes the standard
deviation of their sum smallest, and 5-6 (1) asks for the phases of all rows at once, which was too
much work then.  Here every arrangement of a grid is looked at, the best ones are polished, what
is better than those is proved not to exist (`box_bounds`), and equal rows are swapped against
twist.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from math import ceil, degrees, pi
from typing import Any

import numpy as np

from equipoise.balancing.box_bounds import PhaseProof, prove
from equipoise.balancing.cylinder_phasing import (
    NOTHING,
    Combine,
    Cost,
    PhasedRows,
    PhaseObjective,
    RowSignals,
)
from equipoise.balancing.objectives import unit_of
from equipoise.balancing.phase_grid import (
    BETTER,
    PhaseGrid,
    Twist,
    alike,
    coarsened,
    distinct,
    first_least,
)
from equipoise.balancing.phase_polish import AfterStep, most_steps, polished
from equipoise.balancing.rounding import NEARLY
from equipoise.dataclass import dataclass
from equipoise.design.solvers import DesignProblem, DesignSolution, solve
from equipoise.design.variables import Range
from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.parts.balance import OF_ROWS, Limit, Objective, Phases
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.result import ProgressCallback, Result
from equipoise.signals import Array

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


def stepped(progress: ProgressCallback, begin: int, most: int, total: int) -> AfterStep:
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

    def pool(self, progress: ProgressCallback) -> Array:
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

    def polished(self, phases: Array, after: AfterStep = lambda: None) -> Array:
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

    def _starts(self, progress: ProgressCallback) -> Array:
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


LIMIT_TOLERANCE = 1e-6
"""Share of a limit by which it may be passed."""
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

    blocks_in = "balancing.blocks.phasing_blocks"
    pictures_in = "figures.balancing.phasing_charts"

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


class PhaseProblem(DesignProblem):
    """The phases of all rows but the first, which is at 0."""

    def __init__(
        self, search: PhaseSearch, progress: ProgressCallback = lambda done, total: None
    ) -> None:
        self.search, self.progress, self.solvers = search, progress, (PhasesWithProof(),)

    @property
    def spreads(self) -> list[Range]:
        cost = self.search.cost
        return [Range(0.0, cost.period)] * (cost.rows - 1)

    def values_of(self, places: Array) -> Array:
        """Phases (n, m), rad."""
        return np.hstack([np.zeros((len(places), 1)), super().values_of(places)])

    def evaluate(self, places: Array) -> tuple[Array, Array]:
        """Costs (n, 1), in which limits that are passed count, and 0 (n, 1)."""
        costs = self.search.cost.values(self.values_of(places))[:, None]
        return costs, np.zeros_like(costs)


class PhasesWithProof:
    """A grid of phases, the best of it polished, and boxes of phases in which none is better.

    SciPy's differential evolution was measured in the place of the grid: 2 to 8 rows, one to three
    objectives by mean squares or peaks, ten problems with three seeds and populations of 15 and 40
    for each number.  It came to the same optimum on eight of them, in 0.1 to 5 times the time,
    but missed it by 3 to 8 % with six rows in four of six runs, and by 6 to 16 % with eight rows in
    every run.  It ends at one arrangement, too, where the twist decides among all that are as good.
    """

    name = "branch and bound over all phases of the rows"

    def suits(self, problem: PhaseProblem) -> bool:
        return True

    def solve(self, problem: PhaseProblem) -> DesignSolution:
        """The details are the phases (m,) and their `PhaseProof`."""
        search = problem.search
        pool = search.pool(problem.progress)
        best = search.best(pool)
        known = float(search.cost.values(best))
        proof = prove(search.cost, best, search.improved, least=known, progress=problem.progress)
        if proof.phases is not best:
            best = search.best(np.vstack([pool, proof.phases]))
        return DesignSolution(best[None, 1:] / search.cost.period, details=(best, proof))


def choose_phases(
    machine: Machine,
    objectives: Sequence[Objective],
    phases: Phases | None = None,
    combine: Combine = "sum",
    progress: ProgressCallback | None = None,
    limits: Sequence[Limit] = (),
) -> Phasing:
    """Find the phases of a machine's rows that make objectives smallest; row 1 keeps its own.

    Where several are as good, those with the least roll and yaw moment.  None is below `bound`.

    Parameters
    ----------
    objectives : outputs with their measures; see `cylinder_phasing.Rows.signals`.
    phases : how finely to look; every 5 deg if None.
    combine : several objectives by their weighted sum, or the root of that of their squares.
    progress : is called with how many arrangements of the grid are computed and how many there
        are; then with the steps of refining the best ones, and with the boxes of the proof, and
        how many these are at most.
    limits : what must be kept.

    Raises
    ------
    ModelError : there are fewer than two rows, or an objective cannot be measured.
    UsageError : no phase changes an objective, there is none, or no phases keep the limits.
    MassError, MotionError, ResponseError : the machine cannot be computed.
    """
    search = PhaseSearch(machine, tuple(objectives), phases or Phases(), combine, tuple(limits))
    solution = solve(PhaseProblem(search, progress or (lambda done, total: None)))
    if solution.details is None:  # it proves nothing: no cost is below 0
        pool = np.vstack([search.present, PhaseProblem(search).values_of(solution.places)])
        best = search.best(pool)
        proof = PhaseProof(best, 0.0, 0, False)
    else:
        best, proof = solution.details
    for term in search.cost.limits:
        if term.value_at(best) > term.scale * (1 + LIMIT_TOLERANCE):
            least = f"{term.value_at(best):.4g} {unit_of(term.objective, machine)}"
            raise UsageError(
                Note(
                    "no phases keep the {name} within its limit; the best found leave {least}",
                    name=term.objective.name,
                    least=least,
                )
            )
    return phasing_of(search, best, proof)


def phasing_of(search: PhaseSearch, phases: Array, proof: PhaseProof) -> Phasing:
    """What phases (m,) relative to row 1 bring."""
    present, cost, grid, force = search.present, search.cost, search.grid, search.force
    moved = not np.all(phases == search.present)
    placed = with_phases(search.machine, phases, search.cost.period) if moved else search.machine
    varying = (Objective(output, "ripple") for output in OF_ROWS)
    lateral = [PhaseObjective(wish, search.rows.signals(wish)) for wish in varying]
    before, after = (
        {term.objective.name: term.value_at(at) for term in cost.terms} for at in (present, phases)
    )
    left = np.max(np.abs(force.total(phases)[0]), axis=0)[1:]
    loudest = float(np.max(np.abs(force.amplitudes), initial=0.0)) * len(phases)
    return Phasing(
        machine=placed,
        phases=tuple(row.phase for row in placed.rows),
        before=before,
        after=after,
        combined=(float(cost.of([*before.values()])), float(cost.of([*after.values()]))),
        remaining=tuple(force.orders[1:][left > SURVIVES * loudest].tolist()),
        lateral={
            item.objective.output: (item.value_at(present), item.value_at(phases))
            for item in lateral
        },
        combinations=0 if grid is None else grid.count,
        step=search.step if grid is None else grid.step,
        bound=proof.bound,
        looked_at=proof.boxes,
        notes=tuple(_notes(search, phases, proof.complete)),
    )


def _notes(search: PhaseSearch, phases: Array, complete: bool) -> Iterator[Note]:
    if np.all(phases == search.present):
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
    if not complete:
        yield Note(
            "the search ended before the optimum was proved; the gap bounds the possible "
            "improvement"
        )
