"""Geometry that meets targets and limits on planting figures: goals, variables, a global search.

The search is differential evolution over whole generations of designs, which are solved together
and whose figures are exact, not sampled.  The polish is least squares on the targets.  Where a
figure is to become as small as the limits allow, it is another evolution in a small box: the best
design usually lies where two peaks tie, at a kink that stops methods which trust derivatives.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import fields, replace
from functools import cached_property, partial
from typing import Any, ClassVar, Literal, Self

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.design.evaluator import PooledEvaluator
from equipoise.design.lifts import Lift, joined, lifts_of, usual, with_lifts
from equipoise.design.requirements import Requirement
from equipoise.design.solvers import DesignProblem, DesignSolution, solve
from equipoise.design.variables import Range, Variable
from equipoise.errors import EquipoiseError, UsageError, at_place
from equipoise.i18n import Note
from equipoise.mechanism.assembly.family import Family
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.kinematics.tip import TipCurve
from equipoise.mechanism.parts.machine import Machine, unknown
from equipoise.planting.figures import machine_figures
from equipoise.planting.names import dimension_of
from equipoise.planting.stroke import kept_alike, twins_of
from equipoise.planting.summary import PlantingFigures, plant
from equipoise.results.result import Result
from equipoise.signals import Array

Sense = Literal["as given", "counterclockwise", "clockwise", "either"]


class Designs:
    """Machines that differ from one in some numbers.

    vary : names of numbers with their limits, m, rad or plain; None for what is `usual`.
    Arms that are alike stay so, unless what varies names gears of the further ones alone.
    sense : in which the crank turns.  Where it is "either", a last number decides: below 0
        clockwise.
    """

    def __init__(
        self,
        machine: Machine,
        vary: Mapping[str, tuple[float, float]] | None = None,
        sense: Sense = "as given",
    ) -> None:
        self.machine, self.sense = machine, sense
        self.given = (machine, vary, sense)
        known = {lift.name: lift for lift in lifts_of(machine)}
        names = [name for name in known if usual(name)] if vary is None else list(vary)
        if not names:
            raise UsageError(
                at_place("vary", Note("names nothing; name at least one number, or leave it out"))
            )
        self.lifts: list[Lift] = []
        self.ranges: list[Range] = []
        for name in names:
            item = known.get(name) or joined(machine, name)
            if item is None:
                raise UsageError(at_place(f"vary.{name}", unknown(name, known, "number to vary")))
            self.lifts.append(item)
            self.ranges.append(
                _range(item, *((item.low, item.high) if vary is None else vary[name]))
            )
        self.twins = [
            twin
            for twin in twins_of(machine)
            if all(twin.mate in lift.gears for lift in self.lifts if twin.gear in lift.gears)
        ]

    @property
    def variables(self) -> tuple[Variable, ...]:
        """What varies."""
        lifts = zip(self.lifts, self.ranges, strict=True)
        return tuple(Variable(lift.name, item, lift.dimension) for lift, item in lifts)

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest values, (n,) each."""
        low, high = [item.low for item in self.ranges], [item.high for item in self.ranges]
        turning = [1.0] if self.sense == "either" else []
        return np.array([*low, *(-t for t in turning)]), np.array([*high, *turning])

    @property
    def start(self) -> Array:
        """Values of the machine itself, inside the limits, (n,)."""
        values = [lift.start for lift in self.lifts]
        turning = [np.sign(self.machine.drive.speed)] if self.sense == "either" else []
        start: Array = np.clip([*values, *turning], *self.bounds)
        return start

    def build(self, values: Sequence[float] | Array) -> Machine:
        """The machine that has these values; places that have moved are rounded to `DIGITS`, and
        tables of gears scaled so that their curves close.
        """
        machine = self.machine
        size = abs(machine.drive.speed)
        speed = {
            "as given": machine.drive.speed,
            "counterclockwise": size,
            "clockwise": -size,
            "either": size if values[-1] >= 0 else -size,
        }[self.sense]
        drive = replace(machine.drive, speed=speed)
        new_machine = with_lifts(machine, [*zip(self.lifts, values, strict=False)], drive=drive)
        return kept_alike(new_machine, self.twins)


def _range(lift: Lift, low: float, high: float) -> Range:
    if lift.dimension == "length" and lift.name.count(".") == 0 and low <= 0 and low < high:
        raise UsageError(at_place(f"vary.{lift.name}", Note("a length must stay above 0")))
    try:
        return Range(low, high)
    except UsageError as error:
        raise UsageError(at_place(f"vary.{lift.name}", error.note)) from error


GRID = 180
"""Crank angles between which instants of designs are looked for."""
BATCH = 64
"""Designs that are sent to a process together: 15 at a time took 1.4 times as long as 60."""
OPEN = 1e-4
"""Squared sine of the smallest transmission angle (0.6 deg) below which a design counts as open."""
LEAST_LIFT = 0.01
"""Share of the path's height by which the tip of a design has to rise above the soil."""
COST_OF_OPEN, COST_OF_NONE = 1e9, 1e8
"""Cost of a design that cannot turn, and of one that lacks a figure."""
LIMITS = 1e3
"""Weight of limits beside targets in the global search."""


def check_asks(goal: Requirement) -> None:
    """A search can do nothing with a figure that is only to be reported: `UsageError`."""
    if goal.is_fact:
        raise UsageError(
            at_place(goal.figure, Note("give at least one of target, at_least, at_most and make"))
        )


@dataclass(frozen=True, eq=False)
class GoalOutcome:
    """Designs judged, P of them.

    off : (P, T) targets, in steps.  slack : (P, L) limits, in steps, negative outside.
    size : (P,) what is to become small, in steps.  worst : (P,) see `OPEN`.
    """

    off: Array
    slack: Array
    size: Array
    worst: Array

    @classmethod
    def joined(cls, parts: Sequence[GoalOutcome]) -> GoalOutcome:
        """What came of all parts, one after the other."""
        names = [item.name for item in fields(cls)]
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))

    @property
    def feasible(self) -> Array:
        """Whether a design can turn and keeps every limit (P,)."""
        met: Array = (self.worst > OPEN) & np.all(self.slack >= 0, axis=1)
        return met & np.isfinite(self.cost)

    @cached_property
    def cost(self) -> Array:
        """One number (P,) for the global search."""
        outside = np.maximum(-self.slack, 0.0)
        cost = np.sum(self.off**2, axis=1) + self.size
        cost = cost + LIMITS * np.sum(outside + outside**2, axis=1)
        cost = np.where(np.isfinite(cost), cost, COST_OF_NONE)
        opened: Array = np.where(self.worst > OPEN, cost, COST_OF_OPEN * (1 - self.worst))
        return opened


class PlantingProblem(DesignProblem):
    """Designs of a machine and the goals that they have to meet; a context manager, which ends the
    processes that judge them.

    workers : processes, where judging takes more than some seconds; as many as this machine has
        processors if not given.
    expected : designs that are to be judged, if that is known; at most so many.
    judged : number of designs so far.

    Raises
    ------
    UsageError : a goal cannot be used, or there are fewer than one worker.
    """

    def __init__(
        self,
        designs: Designs,
        goals: Sequence[Requirement],
        workers: int | None = 1,
        expected: int = 0,
    ) -> None:
        self.designs, self.goals = designs, tuple(goals)
        self.judged = 0
        if not self.goals:
            raise UsageError(at_place("goals", Note("there is none; give at least one")))
        known, self.turns = _figures([designs.machine]), assemble(designs.machine).cycle.turns
        for goal in goals:
            if goal.figure not in known:
                raise UsageError(at_place("goals", unknown(goal.figure, known, "figure")))
            check_asks(goal)
        self.scales = [
            goal.scale(float(known[goal.figure][0]), dimension_of(goal.figure)) for goal in goals
        ]
        make = partial(_judging, *designs.given, self.goals)
        self.pooled = PooledEvaluator(
            self.judge_here,
            make,
            GoalOutcome.joined,
            workers,
            batch_size=BATCH,
            expected=expected,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.pooled.close()

    @property
    def spreads(self) -> list[Range]:
        return [Range(*ends) for ends in zip(*self.designs.bounds, strict=True)]

    def evaluate(self, places: Array) -> tuple[Array, Array]:
        """Costs (P, 1), in squared steps, and whether a limit is not kept (P, 1)."""
        outcome = self.judge(self.values_of(places))
        return outcome.cost[:, None], np.where(outcome.feasible, 0.0, 1.0)[:, None]

    @property
    def makes(self) -> bool:
        """Whether a figure is to become small or large."""
        return any(goal.make for goal in self.goals)

    def judge(self, values: Array) -> GoalOutcome:
        """Judge designs (P, n), together with processes of this machine where that takes long."""
        self.judged += len(values)
        return self.pooled(values)

    def judge_here(self, values: Array) -> GoalOutcome:
        """Judge designs (P, n) in this process; of none does the result depend on the others."""
        machines, worst = self._built(values)
        good = worst > OPEN
        fulls = {goal.figure: np.full(len(values), np.nan) for goal in self.goals}
        if np.any(good):
            some = [m for m, g in zip(machines, good, strict=True) if g and m is not None]
            computed = _figures(some, [*fulls], self.turns)
            for name, column in fulls.items():
                column[good] = computed[name]
        off, slack, size = [], [], np.zeros(len(values))
        for goal, scale in zip(self.goals, self.scales, strict=True):
            column = fulls[goal.figure]
            if goal.target is not None:
                off.append(goal.off(column) / scale)
            slack += [part / scale for part in goal.slack(column)]
            size = size + goal.size(column) / scale
        return GoalOutcome(_columns(off, len(values)), _columns(slack, len(values)), size, worst)

    def _built(self, values: Array) -> tuple[list[Machine | None], Array]:
        """Machines, and the smallest number (P,) of any of their dyads round the turn."""
        machines: list[Machine | None] = [None] * len(values)
        worst, families = np.full(len(values), -1.0), {}
        for k, row in enumerate(values):
            with suppress(EquipoiseError):  # lengths of nothing, pins that coincide
                machine = self.designs.build(row)
                families[k], machines[k] = assemble(machine), machine
        if families:
            family, count = Family([*families.values()]), len(families)
            ahead = np.linspace(0, 2 * np.pi * self.turns, GRID * self.turns + 1)
            theta = np.broadcast_to(ahead, (count, len(ahead)))
            with np.errstate(all="ignore"):
                numbers = family.margins(family.solve(theta))
            worst[[*families]] = np.min(np.nan_to_num(numbers, nan=-1.0), axis=1)
        return machines, worst


def _judging(
    machine: Machine,
    vary: Mapping[str, tuple[float, float]] | None,
    sense: Sense,
    goals: Sequence[Requirement],
) -> Callable[[Array], GoalOutcome]:
    """In another process: what judges designs."""
    return PlantingProblem(Designs(machine, vary, sense), goals).judge_here


def _figures(
    machines: list[Machine], wanted: Collection[str] | None = None, turns: int | None = None
) -> dict[str, Array]:
    """Figures of designs by name, (P,); NaN where a design does not have one."""
    with np.errstate(all="ignore"):
        curve = TipCurve(machines, GRID, turns)
        figures = machine_figures(curve, wanted)
        plants = np.all([_plants(arm) for arm in curve.arms], axis=0)
        return {name: np.where(plants, values, np.nan) for name, values in figures.items()}


def _plants(curve: TipCurve) -> Array:
    """Whether the tip reaches the soil, and rises well above it, (P,)."""
    lift, height = curve.highest[0] - curve.surface, curve.highest[0] - curve.lowest[0]
    plants: Array = (lift > LEAST_LIFT * height) & (curve.surface > curve.lowest[0])
    return plants


def figure_names(machine: Machine) -> list[str]:
    """Names of the figures of which a search can make goals."""
    return list(_figures([machine]))


def _columns(columns: list[Array], count: int) -> Array:
    return np.stack(columns, axis=1) if columns else np.zeros((count, 0))


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

    blocks_in = "planting.blocks.fit_blocks"

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
            "goals": [self._goal_to_dict(goal) for goal in self.goals],
            "before": None if self.before is None else self.before.to_dict(),
            "after": self.after.to_dict(),
        }

    def _goal_to_dict(self, goal: Requirement) -> dict[str, Any]:
        """A goal, whether it is met, and its figure before and after."""
        figures = {"before": self.before, "after": self.after}
        values = {when: figure and figure.get(goal.figure) for when, figure in figures.items()}
        requested = {"figure": goal.figure, **goal.asked_in("goals"), "tolerance": goal.tolerance}
        return {**requested, "met": self.met.get(goal.figure), **values}


GenerationProgress = Callable[[int, int, float], None]
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
    progress: GenerationProgress | None = None,
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
    designs, expected = Designs(machine, vary, sense), generations * population
    with PlantingProblem(designs, goals, workers, expected) as problem:
        problem.seed, problem.generations, problem.population = seed, generations, population
        problem.solvers = (EvolutionAndPolish(progress),)
        return _fit(problem)


@dataclass(frozen=True)
class EvolutionAndPolish:
    """Differential evolution of the whole range, then least squares or an evolution nearby."""

    progress: GenerationProgress | None = None
    name: ClassVar[str] = "differential evolution"

    def suits(self, problem: PlantingProblem) -> bool:
        return True

    def solve(self, problem: PlantingProblem) -> DesignSolution:
        population = problem.population
        evolution = _Evolution(problem, self.progress)
        best = evolution.rounds(population)
        if problem.makes:
            polished = [evolution.polished(best[0], max(SMALLEST_POPULATION, population // 3))]
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
    met = bool(best_outcome.feasible[0] and best_outcome.cost[0] < MET)
    names = [variable.path for variable in problem.designs.variables]
    return Fit(
        machine=after.machine,
        before=_planting_figures(problem.designs.machine),
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


def _planting_figures(machine: Machine) -> PlantingFigures | None:
    try:
        return plant(machine)
    except EquipoiseError:
        return None


class _Evolution:
    """Differential evolution, round after round, within a number of generations in all."""

    def __init__(self, problem: PlantingProblem, progress: GenerationProgress | None) -> None:
        self.problem, self.progress = problem, progress
        self.generations = problem.generations
        self.generator = np.random.default_rng(problem.seed)
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

    def polished(self, start: Array, population: int) -> Array:
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
            callback=self._on_generation,
            tol=0.0,
            mutation=(0.4, 0.9),
            recombination=0.9,
        )
        order = np.argsort(result.population_energies)
        return np.asarray(result.population)[order]

    def _on_generation(self, intermediate_result: Any) -> bool:
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
    for k in np.lexsort([outcome.cost, ~outcome.feasible]):
        after = _planting_figures(problem.designs.build(candidates[k]))
        if after is not None and all(after.get(goal.figure) is not None for goal in problem.goals):
            return candidates[k], after
    raise UsageError(
        Note(
            "no design was found that turns fully, reaches the soil and has every "
            "figure asked for; widen the limits of [vary], or start from another "
            "machine"
        )
    )
