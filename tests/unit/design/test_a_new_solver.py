"""A solver of one's own is one class in a list; searches take it, and say what it proves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.design.solvers import DesignProblem, SolverRun
from equipoise.design.spreads import Choices, Range
from equipoise.i18n import Note
from equipoise.results.blocks import Notes, Text
from equipoise.schema.template import Template
from equipoise.studies.blocks import searched_blocks
from equipoise.studies.evaluate import evaluator
from equipoise.studies.evolution import SOLVERS
from equipoise.studies.searching import Searched, search

Array = np.ndarray[Any, Any]
MASSES = {"links.crank.mass": (0.1, 0.15, 0.2, 0.3), "links.rocker.mass": (0.2, 0.1, 0.4)}


class RandomSearch:
    """Designs drawn at random, which ends after two generations."""

    name, exact = "random search", False

    def suits(self, problem: DesignProblem) -> bool:
        return problem.count == 0

    def begin(self, problem: DesignProblem) -> SolverRun:
        return _Draws(problem)


class _Draws:
    proof = None

    def __init__(self, problem: DesignProblem) -> None:
        self.random, self.width = np.random.default_rng(problem.seed), len(problem.spreads)
        self.left, self.best = 2, np.empty((0, self.width))
        self.costs: list[Array] = []

    def ask(self) -> Array | None:
        self.left -= 1
        return self.random.random((8, self.width)) if self.left >= 0 else None

    def tell(self, places: Array, costs: Array, violations: Array) -> None:
        self.costs.append(costs)


@pytest.fixture
def added() -> Iterator[None]:
    SOLVERS.insert(0, RandomSearch())
    yield
    del SOLVERS[0]


def study(spreads: Any, *makes: str) -> eq.studies.Study:
    vary = [eq.design.Variable(path, one) for path, one in zip(MASSES, spreads, strict=True)]
    return eq.studies.Study(
        title="",
        model=Template.load("yamashita-1"),
        vary=tuple(vary),
        outputs=tuple(
            eq.studies.Output(name, make="smallest")
            for name in ("shaking_force.y.rms", "drive_torque.rms")[: len(makes) or 1]
        ),
        sampling=eq.studies.Sampling("sobol", 200),
    )


def told(found: Searched) -> list[str]:
    return [str(one) for one in searched_blocks(found) if isinstance(one, Text | Notes)]


RANGES = (Range(0.1, 0.3), Range(0.1, 0.4))


def test_a_search_takes_a_solver_of_ones_own(added: None) -> None:
    found = search(study(RANGES))
    assert (found.solver, found.proof, found.computed) == ("random search", None, 16)
    assert found.stood_still, "it had no further designs"
    values = evaluator(found.study)(found.tried.values).figures[:, 0]
    assert found.figures[0, 0] == np.min(values)
    assert found.to_dict()["proved"] is False
    assert any("nothing proves" in one for one in told(found))


def test_without_it_the_solver_follows_from_the_problem() -> None:
    few = {"population": 8, "generations": 2}
    lists = tuple(Choices(values) for values in MASSES.values())
    assert search(study(RANGES), **few).solver == "differential evolution"
    assert search(study(RANGES, "f", "g"), **few).solver == "NSGA-II"
    assert search(study(lists), **few).solver == "complete enumeration"
    too_few = {"population": 8, "generations": 1}
    assert search(study(lists), **too_few).solver == "differential evolution"


@pytest.mark.parametrize("makes", [("f",), ("f", "g")])
def test_lists_are_computed_one_and_all_and_that_is_a_proof(makes: tuple[str, ...]) -> None:
    """Against each machine by an analysis of its own."""
    spreads = tuple(Choices(values) for values in MASSES.values())
    found = search(replace(study(spreads, *makes), angles=720), population=8)
    assert isinstance(found.proof, Note) and found.stood_still
    assert found.computed == 12 and found.to_dict()["proved"] is True
    assert any("no other is better" in one for one in told(found))
    costs = []
    for crank, rocker in product(*MASSES.values()):
        machine = eq.load("yamashita-1").with_link("crank", mass=crank)
        summary = eq.analyze(machine.with_link("rocker", mass=rocker), 720).summary
        costs.append([summary["shaking_force.y"].rms, summary["drive_torque"].rms][: len(makes)])
    every = np.array(costs)
    beaten = [np.any(np.all(every <= one, axis=1) & np.any(every < one, axis=1)) for one in every]
    front = every[~np.array(beaten)]
    np.testing.assert_allclose(found.figures, front[np.argsort(front[:, 0])], rtol=1e-9)
