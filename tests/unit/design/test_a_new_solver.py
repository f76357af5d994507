"""A solver of one's own is one class in a list; searches, balance, fits, tools and the page take
it, and say what it proves.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.design.requirements import Requirement
from equipoise.design.solvers import SOLVERS, DesignProblem, DesignSolution
from equipoise.design.variables import Choices, Range
from equipoise.handheld.design import design_tool
from equipoise.i18n import Note
from equipoise.planting.search import fit_planting
from equipoise.results.blocks import Notes, Text
from equipoise.schema.template import Template
from equipoise.studies.blocks import searched_blocks
from equipoise.studies.evaluate import evaluator
from equipoise.studies.searching import Searched, search
from support.chosen import EXHAUSTIVE
from unit.web.pages import ask, opened

Array = np.ndarray[Any, Any]
MASSES = {"links.crank.mass": (0.1, 0.15, 0.2, 0.3), "links.rocker.mass": (0.2, 0.1, 0.4)}


class RandomSearch:
    """Designs drawn at random, in two generations."""

    name = "random search"

    def __init__(self, designs: int = 16) -> None:
        self.designs, self.seen = designs, list[DesignProblem]()

    def suits(self, problem: DesignProblem) -> bool:
        return problem.objectives == 1

    def solve(self, problem: DesignProblem) -> DesignSolution:
        random = np.random.default_rng(problem.seed)
        self.seen.append(problem)
        places, costs = [], []
        for _ in range(2):
            places.append(random.random((self.designs // 2, len(problem.spreads))))
            cost, violations = problem.evaluate(places[-1])
            costs.append(np.where(np.any(violations > 0, axis=1), np.inf, cost[:, 0]))
        best = np.argsort(np.concatenate(costs), kind="stable")
        return DesignSolution(np.concatenate(places)[best])


@pytest.fixture
def added() -> Iterator[RandomSearch]:
    SOLVERS.insert(0, RandomSearch())
    yield SOLVERS[0]  # type: ignore[misc]
    del SOLVERS[0]


def study(spreads: Any, *makes: str) -> eq.studies.Study:
    vary = [eq.design.Variable(path, spread) for path, spread in zip(MASSES, spreads, strict=True)]
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


def printed_texts(result: Searched) -> list[str]:
    return [str(block) for block in searched_blocks(result) if isinstance(block, Text | Notes)]


RANGES = (Range(0.1, 0.3), Range(0.1, 0.4))


def test_a_search_takes_a_solver_of_ones_own(added: RandomSearch) -> None:
    searched = search(study(RANGES))
    assert (searched.solver, searched.proof, searched.computed) == ("random search", None, 16)
    assert searched.stood_still, "it had no further designs"
    values = evaluator(searched.study)(searched.tried.values).figures[:, 0]
    assert searched.figures[0, 0] == np.min(values)
    assert searched.to_dict()["proved"] is False
    assert any("the optimum is not proved" in item for item in printed_texts(searched))


@EXHAUSTIVE  # On every change: `test_the_page_balances_by_it`, of the same machine.
def test_balance_chooses_gears_by_it(added: RandomSearch) -> None:
    """As good as the best of its own few choices, and no better than all of them tried."""
    machine = eq.load("balance-geared-a")
    balanced = eq.balance(machine)
    (problem,) = added.seen
    assert len(problem.costs) <= 16  # type: ignore[attr-defined]
    assert balanced.cost == pytest.approx(min(problem.costs.values()), abs=1e-6)  # type: ignore[attr-defined]
    SOLVERS.remove(added)
    assert eq.balance(machine).cost <= balanced.cost + 1e-8
    SOLVERS.insert(0, added)


def test_the_page_balances_by_it(added: RandomSearch) -> None:
    session, _ = opened("balance-geared-a")
    shown, _ = ask(session, "balance")
    assert len(added.seen) == 1
    balanced = eq.balance(eq.load("balance-geared-a"))
    assert shown.content["aims"][0]["after"] == pytest.approx(
        next(iter(balanced.objectives.values()))[1], rel=1e-3
    )


def test_phases_are_chosen_by_it_without_a_proof(added: RandomSearch) -> None:
    machine = eq.load("walking-transplanter")
    phasing = eq.balancing.choose_phases(machine, [eq.balancing.Objective("shaking_force")])
    assert phasing.bound == 0.0 and phasing.looked_at == 0
    assert any("before the optimum was proved" in str(note) for note in phasing.notes)
    SOLVERS.remove(added)
    best = eq.balancing.choose_phases(machine, [eq.balancing.Objective("shaking_force")])
    assert 0.0 < best.bound <= best.combined[1] <= phasing.combined[1] + 1e-12
    SOLVERS.insert(0, added)


# Searches of studies take it: the first test of this file.
@pytest.mark.exhaustive
def test_the_search_of_geometry_takes_it(added: RandomSearch) -> None:
    goal = Requirement("curve.height", make="smallest")
    fit = fit_planting(eq.load("kim-chung-a"), [goal], {"crank": (0.03, 0.05)})
    assert fit.solver == "random search" and not fit.proved
    assert fit.after["curve.height"] < eq.plant(eq.load("kim-chung-a"))["curve.height"]


# Searches of studies take it: the first test of this file.
@pytest.mark.exhaustive
def test_a_tool_is_designed_by_it(added: RandomSearch) -> None:
    design = design_tool(eq.load("brush-cutter"))
    assert design.to_dict()["solver"] == "random search" and not design.to_dict()["proved"]


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
    searched = search(replace(study(spreads, *makes), angles=720), population=8)
    assert isinstance(searched.proof, Note) and searched.stood_still
    assert searched.computed == 12 and searched.to_dict()["proved"] is True
    assert any("no other design is better" in item for item in printed_texts(searched))
    costs = []
    for crank, rocker in product(*MASSES.values()):
        machine = eq.load("yamashita-1").with_link("crank", mass=crank)
        summary = eq.analyze(machine.with_link("rocker", mass=rocker), 720).summary
        costs.append([summary["shaking_force.y"].rms, summary["drive_torque"].rms][: len(makes)])
    every = np.array(costs)
    beaten = [
        np.any(np.all(every <= item, axis=1) & np.any(every < item, axis=1)) for item in every
    ]
    front = every[~np.array(beaten)]
    np.testing.assert_allclose(searched.figures, front[np.argsort(front[:, 0])], rtol=1e-9)
