"""Evolution of designs by pymoo, and the solvers of which a search takes the first that suits."""

from __future__ import annotations

from math import comb
from typing import Any

import numpy as np

from equipoise.design.solvers import DesignProblem, DesignSolution, DesignSolver, EveryDesign
from equipoise.errors import UsageError, lacking
from equipoise.signals import Array

MANY = 4
"""Objectives from which reference directions, not crowding, keep designs apart."""


class DifferentialEvolution:
    """For one objective."""

    name = "differential evolution"

    def suits(self, problem: DesignProblem) -> bool:
        return problem.objectives == 1

    def solve(self, problem: DesignProblem) -> DesignSolution:
        _check_installed()
        from pymoo.algorithms.soo.nonconvex.de import DE

        first, size = problem.first, problem.population
        return _evolved(problem, DE(size, sampling=first, variant="DE/rand/1/bin", CR=0.9))


class CrowdingSort:
    """For two or three objectives: a front, along which designs are kept apart by crowding.

    Designs that were computed before are not bred again, so that lists are searched to their ends.
    """

    name = "NSGA-II"

    def suits(self, problem: DesignProblem) -> bool:
        return problem.objectives < MANY

    def solve(self, problem: DesignProblem) -> DesignSolution:
        _check_installed()
        from pymoo.algorithms.moo.nsga2 import NSGA2

        given = {"sampling": problem.first, "eliminate_duplicates": _only_new(problem)}
        return _evolved(problem, NSGA2(problem.population, **given))


class DirectionSort:
    """For more objectives: designs are kept apart by reference directions."""

    name = "NSGA-III"

    def suits(self, problem: DesignProblem) -> bool:
        return True

    def solve(self, problem: DesignProblem) -> DesignSolution:
        _check_installed()
        from pymoo.algorithms.moo.nsga3 import NSGA3
        from pymoo.util.ref_dirs import get_reference_directions

        size, makes = problem.population, problem.objectives
        fine = max(p for p in range(1, size) if comb(p + makes - 1, p) <= size)
        directions = get_reference_directions("das-dennis", makes, n_partitions=fine)
        given = {"sampling": problem.first, "eliminate_duplicates": _only_new(problem)}
        return _evolved(problem, NSGA3(directions, pop_size=size, **given))


SOLVERS: tuple[DesignSolver, ...] = (
    EveryDesign(),
    DifferentialEvolution(),
    CrowdingSort(),
    DirectionSort(),
)


def _check_installed() -> None:
    if missing := lacking("a search"):
        raise UsageError(missing)


def _evolved(problem: DesignProblem, algorithm: Any) -> DesignSolution:
    """Where an algorithm of pymoo has come to, generation by generation."""
    from pymoo.core.problem import Problem
    from pymoo.core.termination import NoTermination

    width, limits = len(problem.spreads), problem.limits
    cube = Problem(n_var=width, n_obj=problem.objectives, n_ieq_constr=limits, xl=0.0, xu=1.0)
    given = {"termination": NoTermination(), "seed": problem.seed, "verbose": False}
    algorithm = algorithm.setup(cube, **given)
    for _ in range(problem.generations):
        bred = algorithm.ask()
        if bred is None:
            break  # there is hardly another design
        places = problem.canonical(np.asarray(bred.get("X")))
        costs, violations = problem.evaluate(places)
        bred.set("X", places, "F", costs, "G", violations)
        algorithm.tell(infills=bred)
        if problem.is_still:
            break
    return DesignSolution(np.asarray(algorithm.pop.get("X")))


def _only_new(problem: DesignProblem) -> Any:
    """What strikes out designs that were computed before, or are in a generation twice."""
    from pymoo.core.duplicate import DuplicateElimination

    class OnlyNew(DuplicateElimination):  # type: ignore[misc]
        def _do(self, bred: Any, other: Any, struck: Array) -> Array:
            values = problem.values_of(bred.get("X"))
            if other is None:
                _, first = np.unique(values, axis=0, return_index=True)
                struck[:] = True
                struck[first] = problem.known(values[first])
            elif len(other):
                there = {*map(bytes, problem.values_of(other.get("X")))}
                struck |= [bytes(row) in there for row in values]
            return struck

    return OnlyNew()
