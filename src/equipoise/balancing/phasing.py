"""Phases found for the rows of a machine, what they bring, and how near to the best they are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from equipoise.balancing.box_bounds import PhaseProof, prove
from equipoise.balancing.cylinder_phasing import Combine, PhaseObjective
from equipoise.balancing.objectives import unit_of
from equipoise.balancing.phase_search import PhaseSearch, Progress, with_phases
from equipoise.dataclass import dataclass
from equipoise.design.solvers import DesignProblem, DesignSolution, solve
from equipoise.design.variables import Range
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.parts.balance import Limit, Objective, Phases
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.objectives import OF_ROWS
from equipoise.results.result import Result
from equipoise.signals import Array

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
    pictures_in = "figures.pictures.phasing_pictures"

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

    def __init__(self, search: PhaseSearch, progress: Progress = lambda done, total: None) -> None:
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
    """A grid of phases, the best of it polished, and boxes of phases in which none is better."""

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
    progress: Progress | None = None,
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
