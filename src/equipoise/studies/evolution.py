"""Evolution of designs by pymoo, and the solvers of which a search takes the first that suits."""

from __future__ import annotations

from math import comb
from typing import Any

import numpy as np

from equipoise.design.solvers import DesignProblem, DesignSolver, EveryDesign, SolverRun
from equipoise.errors import UsageError, lacking

Array = np.ndarray[Any, Any]

MANY = 4
"""Objectives from which reference directions, not crowding, keep designs apart."""


class DifferentialEvolution:
    """For one objective."""

    name, exact = "differential evolution", False

    def suits(self, problem: DesignProblem) -> bool:
        return problem.objectives == 1

    def begin(self, problem: DesignProblem) -> SolverRun:
        _check_installed()
        from pymoo.algorithms.soo.nonconvex.de import DE

        first, size = problem.first, problem.population
        return _PymooRun(problem, DE(size, sampling=first, variant="DE/rand/1/bin", CR=0.9))


class CrowdingSort:
    """For two or three objectives: a front, along which designs are kept apart by crowding.

    Designs that were computed before are not bred again, so that lists are searched to their ends.
    """

    name, exact = "NSGA-II", False

    def suits(self, problem: DesignProblem) -> bool:
        return problem.objectives < MANY

    def begin(self, problem: DesignProblem) -> SolverRun:
        _check_installed()
        from pymoo.algorithms.moo.nsga2 import NSGA2

        given = {"sampling": problem.first, "eliminate_duplicates": _only_new(problem)}
        return _PymooRun(problem, NSGA2(problem.population, **given))


class DirectionSort:
    """For more objectives: designs are kept apart by reference directions."""

    name, exact = "NSGA-III", False

    def suits(self, problem: DesignProblem) -> bool:
        return True

    def begin(self, problem: DesignProblem) -> SolverRun:
        _check_installed()
        from pymoo.algorithms.moo.nsga3 import NSGA3
        from pymoo.util.ref_dirs import get_reference_directions

        size, makes = problem.population, problem.objectives
        fine = max(p for p in range(1, size) if comb(p + makes - 1, p) <= size)
        directions = get_reference_directions("das-dennis", makes, n_partitions=fine)
        given = {"sampling": problem.first, "eliminate_duplicates": _only_new(problem)}
        return _PymooRun(problem, NSGA3(directions, pop_size=size, **given))


SOLVERS: list[DesignSolver] = [
    EveryDesign(),
    DifferentialEvolution(),
    CrowdingSort(),
    DirectionSort(),
]


def _check_installed() -> None:
    if missing := lacking("a search"):
        raise UsageError(missing)


class _PymooRun:
    """An algorithm of pymoo, asked for a generation after the other."""

    proof = None

    def __init__(self, problem: DesignProblem, algorithm: Any) -> None:
        from pymoo.core.problem import Problem
        from pymoo.core.termination import NoTermination

        width, limits = len(problem.spreads), problem.limits
        cube = Problem(n_var=width, n_obj=problem.objectives, n_ieq_constr=limits, xl=0.0, xu=1.0)
        given = {"termination": NoTermination(), "seed": problem.seed, "verbose": False}
        self.algorithm = algorithm.setup(cube, **given)
        self.bred: Any = None

    def ask(self) -> Array | None:
        self.bred = self.algorithm.ask()
        return None if self.bred is None else np.asarray(self.bred.get("X"))

    def tell(self, places: Array, costs: Array, violations: Array) -> None:
        self.bred.set("X", places, "F", costs, "G", violations)
        self.algorithm.tell(infills=self.bred)

    @property
    def best(self) -> Array:
        return np.asarray(self.algorithm.pop.get("X"))


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
