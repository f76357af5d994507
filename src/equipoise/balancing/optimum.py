"""The best numbers of one problem: closed form, cone program, or branch and bound."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from equipoise.balancing.branch_and_bound import Best, minimise
from equipoise.balancing.solution import infeasibility
from equipoise.balancing.solution import as_best, closed_form
from equipoise.balancing.design_variables import Change
from equipoise.balancing.problem import Problem
from equipoise.balancing.program import Affine, NoSolutionError, StalledError
from equipoise.errors import UsageError
from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]
Progress = Callable[[int, int], None]

SLACK, WORSE = 2e-9, 5e-9
"""Over the value before: by how much the cost may rise where that saves mass, as asked of the
solver and as read off the signals."""
STILL, SETTLED, ROUNDS = 1e-9, 1e-8, 20
"""Changes of cost and of numbers at which gauges have been read near enough; steps from near to
nearer."""
SHARES = (1.0, 0.5, 0.25, 0.1, 0.03, 0.01, 0.003)
"""Of a step towards the best of a nearby problem that are tried."""


@dataclass(frozen=True, eq=False)
class Solution:
    """Best numbers of one problem, the machine that they make, and the gears it has.

    ties : choices of gears that are as good.
    """

    problem: Problem
    best: Best
    numbers: list[Array]
    machine: Machine
    method: str
    meshes: tuple[Change, ...] = ()
    ties: int = 1


def solve_problem(
    problem: Problem, progress: Progress | None = None, above: float = inf
) -> Solution:
    """The best numbers of one problem; step by step from near to near, where gauges are read or
    gears may change their flanks.

    above : of several problems, the least cost so far.
    """
    problem = _begun(problem)
    found = _solve_once(problem, progress, above)
    bent = problem.reads_gauges and problem.supports_more
    if not bent and not problem.flips:
        return found
    cost = problem.cost_of(found.machine)
    for _ in range(ROUNDS):
        near = problem.near(found.numbers)
        towards = _solve_once(near, progress)
        if _limits_gauges(problem):  # which are kept where they are read, not a step before
            better = towards if _apart(found, towards) > SETTLED else None
        else:
            better = _on_the_way(near, found, towards, cost)
        if better is None:
            return replace(found, best=towards.best)
        found, cost = better, problem.cost_of(better.machine)
    return found


def _limits_gauges(problem: Problem) -> bool:
    return any(one.objective.output.startswith("gauges.") for one in problem.plan.limits)


def _apart(one: Solution, other: Solution) -> float:
    """The largest difference of any number, scaled."""
    pairs = zip(one.numbers, other.numbers, strict=True)
    return max(float(np.max(np.abs(a - b), initial=0.0)) for a, b in pairs)


def _begun(problem: Problem) -> Problem:
    """The problem, read near a machine that keeps the limits of gauges as far as can be.

    Near the machine as it is, with a lighter support, they may look as if they could not be kept.
    """
    gauged = [one for one in problem.plan.limits if one.objective.output.startswith("gauges.")]
    if not gauged or not problem.supports_more:
        return problem
    others = tuple(one for one in problem.plan.limits if one not in gauged)
    objectives = tuple(one.objective for one in gauged)
    first = replace(problem, plan=replace(problem.plan, objectives=objectives, limits=others))
    return problem.near(solve_problem(first).numbers)


def _on_the_way(
    problem: Problem, found: Solution, towards: Solution, cost: float
) -> Solution | None:
    """A solution between two that costs less than the first; None where there is none."""
    for share in SHARES:
        pairs = zip(found.numbers, towards.numbers, strict=True)
        between = [(1 - share) * one + share * other for one, other in pairs]
        numbers = problem.tightened(between)
        machine = problem.machine_with(numbers)
        if problem.cost_of(machine) < cost - STILL:
            return replace(towards, numbers=numbers, machine=machine)
    return None


def _solve_once(problem: Problem, progress: Progress | None, above: float = inf) -> Solution:
    problem.check_influence()
    numbers = closed_form(problem)
    if numbers is not None:
        machine = problem.machine_with(numbers)
        best = as_best(problem, problem.cost_of(machine))
        return Solution(problem, best, numbers, machine, "closed form")
    built = problem.built
    try:
        best = minimise(built.program, built.squares, problem.whole, progress, above)
    except StalledError as error:
        raise UsageError(f"{error}; change a limit a little, or free less") from error
    except NoSolutionError:
        raise infeasibility(problem) from None
    numbers = problem.split(best.x) if above < inf else _lightest(problem, best)
    numbers = problem.lightened(numbers)
    method = "cone program" if best.nodes == 1 else "branch and bound"
    return Solution(problem, best, numbers, problem.machine_with(numbers), method)


def _lightest(problem: Problem, best: Best) -> list[Array]:
    """Of the numbers that are as good, those that add the least mass."""
    found = problem.split(best.x)
    masses, units = problem.added_masses(problem.built.places)
    if not len(masses) or (problem.reads_gauges and not problem.leaves_masses_open):
        return found
    program = best.program.copy()
    terms = np.array(list(program.cost))
    weights = np.array([program.cost[int(term)] for term in terms])
    program.nonnegative(Affine.of(terms, -weights, best.value + SLACK * problem.whole))
    program.cost = {int(m): float(u) for m, u in zip(masses, units / np.max(units), strict=True)}
    try:
        lighter = problem.split(program.solve().x)
    except NoSolutionError:  # as near to the best as that, there may be no room to move
        return found
    worse = problem.cost_at(lighter) - best.value
    return lighter if worse <= WORSE * problem.whole else found
