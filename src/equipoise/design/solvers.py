"""Solvers: who looks for the best designs of a problem, how one is chosen, and what it proves.

A solver gets a problem and answers ``solve(problem)``.  It knows neither machines nor studies: it
chooses designs as places from 0 to 1 in the spread of each variable, and the problem answers with
costs, which are all to be small, and violations, which are above 0 where a limit is not kept or a
design cannot be computed.  Searches of studies, of gears and phases of balancing, of geometry and
of tools are problems; each brings the solvers that know more of it, and `SOLVERS` is asked first.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from math import prod
from typing import Any, Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.design.variables import Choices, Range
from equipoise.i18n import Note, to_say
from equipoise.sequences import sobol
from equipoise.signals import Array

UNPROVED = to_say("the optimum is not proved; another seed may give a better design")
"""What the result of a solver without a proof says of itself."""


@dataclass(frozen=True, eq=False)
class DesignSolution:
    """The best designs of a problem with d variables that a solver has found.

    places : (K, d), the best first.
    values : (K, d) of these in SI units, where they are known to more digits than by their places.
    proof : why no design is better; None where nothing proves it.
    solver : its name.
    details : further results of a solver for the problem that called it.
    """

    places: Array
    values: Array | None = None
    proof: Note | None = None
    solver: str = ""
    details: Any = None


class DesignProblem(ABC):
    """What a solver has to know of a problem with d variables.

    objectives, limits : how many figures are to become small, M, and violations there are, L.
    population, generations : designs that are computed together, P, and how often at most.
    seed : of random numbers.
    solvers : those that know more of such problems; the last suits all of them.
    """

    solvers: Sequence[DesignSolver] = ()
    objectives: int = 1
    limits: int = 1
    population: int = 100
    generations: int = 100
    seed: int = 1

    @property
    @abstractmethod
    def spreads(self) -> Sequence[Range | Choices]:
        """What each variable may be, (d,)."""

    @abstractmethod
    def evaluate(self, places: Array) -> tuple[Array, Array]:
        """Costs (n, M) and violations (n, L) of designs at places (n, d)."""

    def jacobian(self, places: Array) -> tuple[Array, Array] | None:
        """Slopes of costs (n, M, d) and violations (n, L, d) at places (n, d); None if unknown."""
        return None

    @property
    def first(self) -> Array:
        """Places (P, d) to begin with, evenly spread."""
        power = (self.population - 1).bit_length()  # SciPy warns of other numbers
        values: Array = sobol(len(self.spreads), self.seed).random_base2(power)
        return values[: self.population]

    @property
    def is_still(self) -> bool:
        """Whether further generations would bring next to nothing."""
        return False

    @property
    def count(self) -> int:
        """How many designs there are; 0 where a variable may be any number of a range."""
        return prod(spread.count for spread in self.spreads)

    def canonical(self, places: Array) -> Array:
        """Places (n, d), of equal designs the same."""
        return places

    def values_of(self, places: Array) -> Array:
        """Values (n, d) at places (n, d), SI units; equal designs have equal values."""
        columns = [spread.at(u) for spread, u in zip(self.spreads, places.T, strict=True)]
        return np.stack(columns, axis=1)

    def known(self, values: Array) -> Array:
        """Which designs, by values (n, d), have been computed before, (n,)."""
        return np.zeros(len(values), bool)


class DesignSolver(Protocol):
    """A way to look for the best designs."""

    @property
    def name(self) -> str:
        """For readers, such as ``NSGA-II``."""

    def suits(self, problem: Any) -> bool:
        """Whether it can solve the problem, and is the way to do so if none before it suits."""

    def solve(self, problem: Any) -> DesignSolution: ...


SOLVERS: list[DesignSolver] = []
"""Of one's own, for any problem; asked before those that a problem brings."""


def solve(problem: DesignProblem) -> DesignSolution:
    """The best designs by the first solver that suits a problem."""
    solver = next(solver for solver in (*SOLVERS, *problem.solvers) if solver.suits(problem))
    return replace(solver.solve(problem), solver=solver.name)


class EveryDesign:
    """Computes all designs, where every variable is a list or whole numbers and time allows it."""

    name = "complete enumeration"

    def suits(self, problem: DesignProblem) -> bool:
        return 0 < problem.count <= problem.population * problem.generations

    def solve(self, problem: DesignProblem) -> DesignSolution:
        counts = [spread.count for spread in problem.spreads]
        for begin in range(0, problem.count, problem.population):
            numbers = np.arange(begin, min(begin + problem.population, problem.count))
            steps = np.column_stack(np.unravel_index(numbers, counts))
            problem.evaluate(np.asarray((steps + 0.5) / counts))
        proof = to_say("all possible designs were computed: no other design is better")
        return DesignSolution(np.empty((0, len(counts))), proof=Note(proof))
