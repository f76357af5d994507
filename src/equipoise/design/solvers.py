"""Solvers: who looks for the best designs of a problem, how one is chosen, and what it proves.

A solver knows neither machines nor studies.  It is asked for designs, as places from 0 to 1 in the
spread of each variable, and is told what became of them: costs, which are all to be small, and
violations, which are above 0 where a limit is not kept or a design cannot be computed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import prod
from typing import Any, Protocol

import numpy as np

from equipoise.design.spreads import Choices, Range
from equipoise.i18n import Note, to_say

Array = np.ndarray[Any, Any]

UNPROVED = to_say("nothing proves that no other design is better; another seed may lead further")
"""What the result of a solver without a proof says of itself."""


@dataclass(frozen=True, eq=False)
class DesignProblem:
    """What a solver has to know of a problem with d variables.

    spreads : what each variable may be, (d,).
    objectives, limits : how many figures are to become small, M, and violations there are, L.
    population, generations : designs that are computed together, P, and how often at most.
    seed : of random numbers.
    first : places (P, d) to begin with, evenly spread, the model's own among them.
    values_of : values (n, d) at places (n, d); equal designs have equal values.
    known : which designs, by values (n, d), have been computed before, (n,).
    """

    spreads: Sequence[Range | Choices]
    objectives: int
    limits: int
    population: int
    generations: int
    seed: int
    first: Array
    values_of: Callable[[Array], Array]
    known: Callable[[Array], Array]

    @property
    def count(self) -> int:
        """How many designs there are; 0 where a variable may be any number of a range."""
        return prod(spread.count for spread in self.spreads)


class SolverRun(Protocol):
    """A solver at work on one problem."""

    def ask(self) -> Array | None:
        """Places (n, d) of designs to compute; None where there are no others."""

    def tell(self, places: Array, costs: Array, violations: Array) -> None:
        """Take in what became of them: costs (n, M), violations (n, L)."""

    @property
    def best(self) -> Array:
        """Places (K, d) of the designs that it goes on from, of which the best are shown first."""

    @property
    def proof(self) -> Note | None:
        """Why no design is better than the best computed; None while nothing proves it."""


class DesignSolver(Protocol):
    """A way to look for the best designs.

    name : such as ``NSGA-II``, for readers.
    exact : whether it goes on to its end, where it has a proof, though nothing gets better.
    """

    name: str
    exact: bool

    def suits(self, problem: DesignProblem) -> bool:
        """Whether it can solve the problem, and is the way to do so if none before it suits."""

    def begin(self, problem: DesignProblem) -> SolverRun: ...


def solver_for(problem: DesignProblem, solvers: Sequence[DesignSolver]) -> DesignSolver:
    """The first solver that suits a problem; the last suits all."""
    return next(solver for solver in solvers if solver.suits(problem))


class EveryDesign:
    """Computes all designs, where every variable is a list or whole numbers and time allows it."""

    name, exact = "complete enumeration", True

    def suits(self, problem: DesignProblem) -> bool:
        return 0 < problem.count <= problem.population * problem.generations

    def begin(self, problem: DesignProblem) -> SolverRun:
        return _Enumeration(problem)


class _Enumeration:
    def __init__(self, problem: DesignProblem) -> None:
        self.problem, self.begun = problem, 0
        self.best = np.empty((0, len(problem.spreads)))

    def ask(self) -> Array | None:
        numbers = np.arange(self.problem.count)[self.begun :][: self.problem.population]
        if not len(numbers):
            return None
        self.begun += len(numbers)
        counts = [spread.count for spread in self.problem.spreads]
        steps = np.column_stack(np.unravel_index(numbers, counts))
        return np.asarray((steps + 0.5) / counts)

    def tell(self, places: Array, costs: Array, violations: Array) -> None:
        """Nothing follows from what became of them."""

    @property
    def proof(self) -> Note | None:
        if self.begun < self.problem.count:
            return None
        return Note(to_say("every design that there is was computed, so that no other is better"))
