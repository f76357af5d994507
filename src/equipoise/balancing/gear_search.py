"""Gears of the shafts that a plan adds, searched around the cone program.

Ratios, directions and numbers of teeth are no numbers of a cone program.  They are chosen outside
of it, for all shafts together, and the program answers with the best weights for each choice.
Of one shaft numbers of teeth are tried one and all, and of ratios and directions a grid.  Where
several shafts have more choices together than can be tried, some of each are, and from the best of
these one shaft after the other tries all of its own.  Ratios and directions are then followed, all
at once, as far down as they go.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from math import inf, prod

import numpy as np

from equipoise.balancing.geared import Gearing, Mesh
from equipoise.balancing.problem import Problem
from equipoise.balancing.solution import Solution, solve_problem
from equipoise.balancing.weights import AddedWeight
from equipoise.balancing.workshop import Change
from equipoise.dataclass import dataclass
from equipoise.design.solvers import DesignProblem, DesignSolution, solve
from equipoise.design.spreads import Choices, Range
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.parts.balance import Balance
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import Array

Progress = Callable[[int, int], None]
Choice = tuple[Mesh, ...]
"""The gears of all shafts, in the order of the plan."""

LARGE = 1e300
"""A cost that every solution is below, while none is known."""
CLOSER, NEARER = 1e-10, 1e-6
"""Of the cost, and of a ratio or direction, to which the best ones of a range are followed."""
TIE, MOST_TIES, LIGHT_TIES = 5e-9, 24, 8
"""Difference in cost that is none; choices, all over the range, among which the lightest is looked
for; and those beside them that looked lightest at first.
"""
BEST_CHOICES, STEPS, MOST_STEPS = 3, 40, 80
"""Choices that are followed; first steps over a range; programs that are solved for each and for
each shaft with a range.
"""
MOST_CHOICES, MOST_ROUNDS = 640, 4
"""Choices of several shafts together that are all tried: some 20 s, and 25 of each of two; rounds
over the shafts where there are more, of which the second seldom finds anything.
"""


@dataclass(frozen=True, eq=False)
class WithShafts:
    """A machine with shafts that its plan adds: the weights on them, and their gears."""

    machine: Machine
    plan: Balance
    base: Machine
    weights: tuple[AddedWeight, ...] = ()
    gears: tuple[Change, ...] = ()

    def with_gears(self, gearing: Gearing, mesh: Mesh) -> WithShafts:
        """With one more geared shaft."""
        base, weight = gearing.added(mesh, self.base)
        gears = (*self.gears, gearing.change(mesh))
        return replace(self, base=base, weights=(*self.weights, weight), gears=gears)

    def solved(self, progress: Progress | None = None, above: float = inf) -> Solution:
        """The best numbers with these gears; less closely where they cost more than `above`."""
        problem = Problem.of(self.machine, self.plan, self.base, self.weights)
        return replace(solve_problem(problem, progress, above), meshes=self.gears)


class GearSearch(DesignProblem):
    """The gears of every geared shaft of a plan, around the cone program.

    Of each shaft with several choices of gears the variables are which of them, and what of it may
    be any number between two: ratio, direction.

    start : the machine with all that is added to it but these shafts.

    Raises
    ------
    UsageError : no gears of a shaft mesh, or leave room for its counterweight.
    """

    def __init__(self, start: WithShafts, progress: Progress | None = None) -> None:
        self.start, self.progress, self.solvers = start, progress, (GearGrid(),)
        self.gearings = [Gearing(start.base, geared) for geared in start.plan.geared]
        self.options = [gearing.meshes() for gearing in self.gearings]
        self.ranges = [
            (k, name, *limits)
            for k, gearing in enumerate(self.gearings)
            for name, limits in gearing.ranges.items()
        ]
        self.solutions: list[tuple[Choice, Solution]] = []
        self.costs: dict[Choice, float] = {}
        self.problems: list[UsageError] = []
        self.most = 0

    @property
    def spreads(self) -> list[Range | Choices]:
        options = (Choices(tuple(map(float, range(len(own))))) for own in self.options)
        return [*options, *(Range(low, high) for _, _, low, high in self.ranges)]

    def evaluate(self, places: Array) -> tuple[Array, Array]:
        """Costs (n, 1), and 1 where gears do not mesh or limits clash, else 0, (n, 1)."""
        costs = []
        for values in self.values_of(places):
            options, numbers = np.split(values, [len(self.options)])
            start = (own[int(k)] for own, k in zip(self.options, options, strict=True))
            choice = self.with_numbers(tuple(start), numbers)
            costs.append(inf if choice is None else self.cost(choice))
        impossible = ~np.isfinite(np.array(costs)[:, None])
        return np.where(impossible, LARGE, np.array(costs)[:, None]), impossible.astype(float)

    def run(self) -> Solution:
        """The best choice of gears, the lightest of those that are as good, with its weights.

        Raises
        ------
        UsageError : limits clash, whatever the gears.
        """
        everything = prod(map(len, self.options))
        if everything == 1:
            (choice,) = product(*self.options)
            return self._with(choice).solved(self.progress)
        solve(self)
        if not self.solutions:
            raise self.problems[0]
        options = [set(own) for own in self.options]
        tried = sum(all(map(set.__contains__, options, choice)) for choice in self.costs)
        return replace(self._lightest(), gears_left=tried < everything)

    def _with(self, choice: Choice) -> WithShafts:
        with_shafts = self.start
        for gearing, mesh in zip(self.gearings, choice, strict=True):
            with_shafts = with_shafts.with_gears(gearing, mesh)
        return with_shafts

    def with_numbers(self, start: Choice, numbers: Array) -> Choice | None:
        """Gears with other numbers of `ranges`; None where a counterweight hits a link."""
        here: list[dict[str, float]] = [{} for _ in start]
        for (k, name, *_), number in zip(self.ranges, numbers, strict=True):
            here[k][name] = float(number)
        each = list(zip(self.gearings, start, here, strict=True))
        choice = tuple(
            gearing.with_numbers(mesh, own) if own else mesh for gearing, mesh, own in each
        )
        clear = all(
            gearing.is_clear(mesh)
            for gearing, mesh, own in zip(self.gearings, choice, here, strict=True)
            if own
        )
        return choice if clear else None

    def cost(self, choice: Choice) -> float:
        """Cost with these gears, not closely where others cost less; infinite where none do."""
        least = min((item.best.value for _, item in self.solutions), default=LARGE)
        try:
            solution = self._with(choice).solved(None, least)
        except UsageError as error:
            self.problems.append(error)
            self.costs[choice] = inf
            return inf
        self.solutions.append((choice, solution))
        if self.progress is not None:
            self.most = max(self.most, len(self.solutions))
            self.progress(len(self.solutions), self.most)
        self.costs[choice] = solution.best.value
        return solution.best.value

    def _lightest(self) -> Solution:
        """The lightest of those that cost least."""
        least = min(item.best.value for _, item in self.solutions)
        ties = {
            choice: item.problem.mass_added(item.numbers)
            for choice, item in self.solutions
            if item.best.value <= least + TIE
        }
        equal = sorted(ties, key=lambda choice: [(item.ratio, item.direction) for item in choice])
        light = sorted(equal, key=ties.__getitem__)[:LIGHT_TIES]
        tried = dict.fromkeys([*equal[:: max(1, len(equal) // MOST_TIES)], *light])
        lightest = min(
            (self._with(choice).solved() for choice in tried),
            key=lambda solution: solution.problem.mass_added(solution.numbers),
        )
        method = Note(
            "{method}, for each of {count} choices of gears",
            method=lightest.method,
            count=len(self.solutions),
        )
        return replace(
            lightest,
            method=method,
            best=replace(lightest.best, nodes=sum(item.best.nodes for _, item in self.solutions)),
            ties=len(equal),
            weighed=len(tried),
        )


class GearGrid:
    """Choices over the whole range, of which the best are followed downhill."""

    name = "grid of gears, followed downhill"

    def suits(self, problem: GearSearch) -> bool:
        return True

    def solve(self, problem: GearSearch) -> DesignSolution:
        choices = _first_choices(problem.options)
        ranged = len({k for k, *_ in problem.ranges})
        problem.most = len(choices) + BEST_CHOICES * MOST_STEPS * ranged
        for choice in choices:
            problem.cost(choice)
        if problem.solutions and len(choices) < prod(map(len, problem.options)):
            problem.most += BEST_CHOICES * sum(map(len, problem.options))
            for choice in _best_choices(problem):
                _try_by_turns(problem, choice)
        if problem.solutions and problem.ranges:
            for choice in _best_choices(problem):
                _follow(problem, choice)
        return DesignSolution(np.empty((0, len(problem.spreads))))


def _first_choices(options: list[list[Mesh]]) -> list[Choice]:
    """All choices; of several shafts with too many together, some of each."""
    choices = options
    several = sum(len(own) > 1 for own in choices) > 1
    while several and prod(map(len, choices)) > MOST_CHOICES:
        longest = max(map(len, choices))
        choices = [_some(own, min(len(own), longest - 1)) for own in options]
    return list(product(*choices))


def _best_choices(problem: GearSearch) -> list[Choice]:
    """The first among equals, so that the same search ends at the same gears everywhere."""
    there = [choice for choice, cost in problem.costs.items() if np.isfinite(cost)]
    return sorted(there, key=problem.costs.__getitem__)[:BEST_CHOICES]


def _try_by_turns(problem: GearSearch, best: Choice) -> None:
    """Try all gears of one shaft after the other, until none is better."""
    for _ in range(MOST_ROUNDS):
        before = best
        for k, own in enumerate(problem.options):
            ways = [(*best[:k], mesh, *best[k + 1 :]) for mesh in own]
            for way in ways:
                if way not in problem.costs:
                    problem.cost(way)
            best = min((best, *ways), key=problem.costs.__getitem__)
        if best == before:
            return


def _follow(problem: GearSearch, start: Choice) -> None:
    """Go down from a choice of gears, along all that may be any number between two."""
    from scipy.optimize import minimize

    def at(numbers: Array) -> float:
        choice = problem.with_numbers(start, numbers)
        return inf if choice is None else problem.cost(choice)

    begin = np.array([getattr(start[k], name) for k, name, *_ in problem.ranges])
    limits = np.array([ends for _, _, *ends in problem.ranges])
    steps = (limits[:, 1] - limits[:, 0]) / STEPS
    simplex = np.vstack([begin, *(begin + step for step in np.diag(steps))])
    over = simplex > limits[:, 1]
    simplex[over] = (2 * begin - simplex)[over]
    most = MOST_STEPS * len({k for k, *_ in problem.ranges})
    options = {"initial_simplex": simplex, "xatol": NEARER, "fatol": CLOSER, "maxfev": most}
    minimize(at, begin, method="Nelder-Mead", bounds=limits, options=options)


def _some(own: list[Mesh], count: int) -> list[Mesh]:
    """So many of the gears of a shaft, all over their range, both ends among them."""
    return [own[k] for k in np.rint(np.linspace(0, len(own) - 1, count)).astype(int)]
