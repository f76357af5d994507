"""Geometry that meets targets and limits on planting figures: a global search, then a polish.

The search is differential evolution over whole generations of designs, which are solved together
and whose figures are exact, not sampled.  The polish is least squares on the targets.  Where a
figure is to become as small as the limits allow, it is another evolution in a small box: the best
design usually lies where two peaks tie, at a kink that stops methods which trust derivatives.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.design.requirements import Requirement
from equipoise.design.solvers import DesignSolution, solve
from equipoise.errors import EquipoiseError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.family import Family
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.machine import Machine
from equipoise.planting.designs import Designs, Sense
from equipoise.planting.goals import LIMITS, PlantingProblem
from equipoise.planting.summary import PlantingFigures, plant
from equipoise.results.result import Result
from equipoise.signals import Array

GENERATIONS, POPULATION = 300, 120
"""Of the global search, at most; it ends before where the targets are met or nothing gets
better."""
SMALLEST_POPULATION = 5
"""Differential evolution breeds a design from four others."""
CLOSE = 1e-2
"""Sum of squared steps from the targets at which the global search has found the place."""
PATIENCE, STILL = 40, 1e-4
"""A search stands still if so many generations have not lowered the cost by this share."""
MET = 1e-12
"""Sum of squared steps at which the polish need not try a further design."""
POLISHED = 5
"""Best designs of the global search that are polished."""
POLISHING, BOX = 100, 0.02
"""Generations in which a smallest figure is polished; half the width of its box, over the range of
a number."""
DIFFERENCE = 1e-5
"""Step of central differences, over the range of a number."""
INSIDE = 1e-7
"""Steps by which the polish stays inside the limits, so that its own tolerance keeps them too."""


@dataclass(frozen=True, eq=False, repr=False)
class Fit(Result):
    """Result of a search.

    machine : the design found.
    before, after : figures of the machine to start from (None where it has none, because its tip
        never reaches the soil, say) and of the design.
    goals : what was asked for.  designs : what could change.  values : what it has become.
    steps : for each goal, what counts as one step away from its target.
    judged : number of designs.  seed : of the random numbers.
    proved : whether no design can be better: every target is met to rounding, and every limit kept.
    solver : name of what looked for it.
    """

    machine: Machine
    before: PlantingFigures | None
    after: PlantingFigures
    goals: tuple[Requirement, ...]
    designs: Designs
    values: Mapping[str, float]
    steps: tuple[float, ...]
    judged: int
    seed: int
    proved: bool = False
    solver: str = "differential evolution"

    blocks_in = "planting.fit_blocks.fit_blocks"

    @property
    def met(self) -> dict[str, bool]:
        """Figure -> whether its target is met within its tolerance and its limits are kept.

        A figure that only is to become small or large has no entry.
        """
        met: dict[str, bool] = {}
        for goal, step in zip(self.goals, self.steps, strict=True):
            if goal.can_be_met:
                value = self.after.get(goal.figure)
                here = value is not None and goal.met(value, step)
                met[goal.figure] = met.get(goal.figure, True) and here
        return met

    def to_dict(self) -> dict[str, Any]:
        """Goals, values and figures before and after, in SI units."""
        return {
            "seed": self.seed,
            "judged": self.judged,
            "solver": self.solver,
            "proved": self.proved,
            "values": dict(self.values),
            "goals": [self._told(goal) for goal in self.goals],
            "before": None if self.before is None else self.before.to_dict(),
            "after": self.after.to_dict(),
        }

    def _told(self, goal: Requirement) -> dict[str, Any]:
        """A goal, whether it is met, and its figure before and after."""
        figures = {"before": self.before, "after": self.after}
        values = {when: figure and figure.get(goal.figure) for when, figure in figures.items()}
        asked = {"figure": goal.figure, **goal.asked_in("goals"), "tolerance": goal.tolerance}
        return {**asked, "met": self.met.get(goal.figure), **values}


Progress = Callable[[int, int, float], None]
"""Is called with the generation, the most there can be, and the cost of the best design."""


def fit_planting(
    machine: Machine,
    goals: Sequence[Requirement],
    vary: Mapping[str, tuple[float, float]] | None = None,
    sense: Sense = "as given",
    *,
    seed: int = 1,
    generations: int = GENERATIONS,
    population: int = POPULATION,
    progress: Progress | None = None,
    workers: int | None = None,
) -> Fit:
    """Look for the geometry that meets targets and limits on planting figures.

    Parameters
    ----------
    machine : where to start, with a `planting`; made of dyads, and of gears which the crank, the
        frame or each other drive.
    goals : what the figures have to be.
    vary : names of numbers that may change, with their limits in m, rad or plain; by default every
        length between the joints of links with two joints, the direction of the frame (keys of
        links, ``frame``, ``ground_angle``), the tips of arms that are alike (``tip.x``, ``tip.y``)
        and the eccentricity of gears (``gears.shape.eccentricity``).
    sense : in which the crank may turn.
    seed : of the random numbers; the same seed gives the same result.
    generations, population : of the global search.
    workers : processes that judge designs, where that takes more than some seconds; as many as this
        machine has processors if not given.  The result is the same with any number.

    Raises
    ------
    UsageError : a goal or number to vary cannot be used, or no design keeps the limits.
    ModelError, MotionError : the machine to start from cannot be used.
    """
    _check(machine, seed, generations, population)
    with PlantingProblem(Designs(machine, vary, sense), goals, workers) as problem:
        problem.seed, problem.generations, problem.population = seed, generations, population
        problem.solvers = (EvolutionAndPolish(progress),)
        return _fit(problem)


@dataclass(frozen=True)
class EvolutionAndPolish:
    """Differential evolution of the whole range, then least squares or an evolution nearby."""

    progress: Progress | None = None
    name: ClassVar[str] = "differential evolution"

    def suits(self, problem: PlantingProblem) -> bool:
        return True

    def solve(self, problem: PlantingProblem) -> DesignSolution:
        population = problem.population
        evolution = _Evolution(problem, problem.seed, problem.generations, self.progress)
        best = evolution.rounds(population)
        if problem.makes:
            polished = [evolution.near(best[0], max(SMALLEST_POPULATION, population // 3))]
        else:
            polished = list(_polished(problem, best))
        values = np.vstack([best, *polished])
        low, high = problem.designs.bounds
        return DesignSolution((values - low) / (high - low), values)


def _fit(problem: PlantingProblem) -> Fit:
    solution = solve(problem)
    candidates = problem.values_of(solution.places) if solution.values is None else solution.values
    values, after = _best(problem, candidates)
    best_outcome = problem.judge_here(values[None])
    met = bool(best_outcome.kept[0] and best_outcome.cost[0] < MET)
    names = [variable.path for variable in problem.designs.variables]
    return Fit(
        machine=after.machine,
        before=_figures(problem.designs.machine),
        after=after,
        goals=problem.goals,
        designs=problem.designs,
        values={name: float(value) for name, value in zip(names, values, strict=False)},
        steps=tuple(problem.scales),
        judged=problem.judged,
        seed=problem.seed,
        proved=(met and not problem.makes) or solution.proof is not None,
        solver=solution.solver,
    )


def _check(machine: Machine, seed: int, generations: int, population: int) -> None:
    if Family([assemble(machine)]).steps is None:
        raise UsageError(
            Note(
                "the search varies linkages of dyads, and gears driven by the crank or "
                "the frame; this one has gears on other links, or a group of loops"
            )
        )
    if seed < 0 or generations < 1 or population < SMALLEST_POPULATION:
        raise UsageError(
            Note("give a seed of 0 or more, 1 generation or more and a population of 5 or more")
        )


def _figures(machine: Machine) -> PlantingFigures | None:
    try:
        return plant(machine)
    except EquipoiseError:
        return None


class _Evolution:
    """Differential evolution, round after round, within a number of generations in all."""

    def __init__(
        self, problem: PlantingProblem, seed: int, generations: int, progress: Progress | None
    ) -> None:
        self.problem, self.generations, self.progress = problem, generations, progress
        self.generator = np.random.default_rng(seed)
        self.done = 0
        self.costs: list[float] = []

    def rounds(self, population: int) -> Array:
        """Best designs (K, n) of the whole range; a further round where the targets are missed."""
        low, high = self.problem.designs.bounds
        values = self.round(low, high, self.problem.designs.start, population, self.generations)
        while not self.problem.makes and not self._close() and self.done < self.generations:
            left = self.generations - self.done
            again = self.round(low, high, None, population, left)
            values = np.vstack([values, again])
        order = np.argsort(self.problem.judge(values).cost)
        best: Array = values[order[:POLISHED]]
        return best

    def near(self, start: Array, population: int) -> Array:
        """The best design (1, n) in a small box about another."""
        low, high = self.problem.designs.bounds
        reach = BOX * (high - low)
        box = np.maximum(low, start - reach), np.minimum(high, start + reach)
        self.generations = self.done + POLISHING
        return self.round(*box, start, population, POLISHING)[:1]

    def round(
        self, low: Array, high: Array, start: Array | None, population: int, generations: int
    ) -> Array:
        """The last generation between limits, the best first."""
        from scipy.optimize import differential_evolution
        from scipy.stats import qmc

        spread = qmc.LatinHypercube(len(low), rng=self.generator).random(population)
        first = low + (high - low) * spread
        if start is not None:
            first[0] = start
        self.costs = []
        result = differential_evolution(
            lambda values: self.problem.judge(np.atleast_2d(values.T)).cost,
            bounds=list(zip(low, high, strict=True)),
            strategy="currenttobest1bin",
            init=first,
            maxiter=generations,
            rng=self.generator,
            vectorized=True,
            updating="deferred",
            polish=False,
            callback=self._told,
            tol=0.0,
            mutation=(0.4, 0.9),
            recombination=0.9,
        )
        order = np.argsort(result.population_energies)
        return np.asarray(result.population)[order]

    def _told(self, intermediate_result: Any) -> bool:
        self.done += 1
        self.costs.append(float(intermediate_result.fun))
        if self.progress is not None:
            self.progress(self.done, self.generations, self.costs[-1])
        return self._close() or self._stands_still()

    def _close(self) -> bool:
        return not self.problem.makes and self.costs[-1] < CLOSE

    def _stands_still(self) -> bool:
        now, before = self.costs[-1], self.costs[-PATIENCE - 1 : -PATIENCE]
        return bool(before) and before[0] - now < STILL * (1 + abs(now))


def _polished(problem: PlantingProblem, starts: Array) -> Iterator[Array]:
    """Designs (1, n) nearest to the targets; it ends once one of them meets them all."""
    for start in starts:
        result = _nearest(problem, start)[None]
        yield result
        if problem.judge(result).cost[0] < MET:
            return


def _nearest(problem: PlantingProblem, start: Array) -> Array:
    """The design (n,) with the least squares of targets and violated limits.

    Its numbers are scaled to their limits, 0 to 1.
    """
    from scipy.optimize import least_squares

    low, high = problem.designs.bounds
    span = high - low

    def residuals(u: Array) -> Array:
        outcome = problem.judge(low + span * u)
        outside = np.minimum(outcome.slack - INSIDE, 0.0)
        both = np.hstack([outcome.off, np.sqrt(LIMITS) * outside])
        finite: Array = np.nan_to_num(both, nan=1e6)
        return finite

    def slopes(u: Array) -> Array:
        steps = DIFFERENCE * np.eye(len(u))
        ahead, behind = np.split(residuals(np.vstack([u + steps, u - steps])), 2)
        slope: Array = (ahead - behind).T / (2 * DIFFERENCE)
        return slope

    result = least_squares(
        lambda u: residuals(u[None])[0],
        np.clip((start - low) / span, DIFFERENCE, 1 - DIFFERENCE),
        slopes,
        bounds=(0.0, 1.0),
        xtol=1e-14,
        ftol=1e-14,
        gtol=1e-14,
        max_nfev=60,
    )
    design: Array = low + span * result.x
    return design


def _best(problem: PlantingProblem, candidates: Array) -> tuple[Array, PlantingFigures]:
    """The best design (n,) that turns fully and keeps the limits, looked at closely."""
    outcome = problem.judge(candidates)
    for k in np.lexsort([outcome.cost, ~outcome.kept]):
        after = _figures(problem.designs.build(candidates[k]))
        if after is not None and all(after.get(goal.figure) is not None for goal in problem.goals):
            return candidates[k], after
    raise UsageError(
        Note(
            "no design was found that turns fully, reaches the soil and has every "
            "figure asked for; widen the limits of [vary], or start from another "
            "machine"
        )
    )
