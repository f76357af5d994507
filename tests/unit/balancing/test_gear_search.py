"""Several geared shafts, each with a choice of gears, against all choices one by one."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from math import radians
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing import geared as gear_search
from equipoise.balancing.problem import Problem
from equipoise.balancing.solution import Solution
from equipoise.errors import UsageError
from equipoise.mechanism.parts.balance import Balance, GearedWeight, Limit, Objective, Weight
from support.chosen import EXHAUSTIVE
from support.refusals import refused
from unit.mechanism.build import crank_rocker

MACHINE = crank_rocker()
ROCKER = GearedWeight(
    "rocker", Weight(radius=0.2, at_most=2.0), ratio=(0.5, 2.0), pitch_radius=0.3, name="first"
)
TOOTHED = replace(ROCKER, ratio=None, pitch_radius=None, teeth=(17, 19), module=0.02)
CRANK = GearedWeight(
    "crank",
    Weight(radius=0.1, at_most=1.0),
    ratio=(1.0, 2.0),
    pitch_radius=0.2,
    direction=(radians(90), radians(90)),
    name="second",
)
FORCE = (Objective("shaking_moment"),)
FRACTIONS = (1.0, 4 / 3, 1.5, 5 / 3, 2.0)
"""Ratios of CRANK: p/q with q up to 3."""


def plan(*geared: GearedWeight) -> Balance:
    return Balance(geared=geared, objectives=FORCE)


def cost(*geared: GearedWeight) -> float:
    return eq.balance(MACHINE, plan(*geared)).cost


def each(geared: GearedWeight, ratios: Sequence[float]) -> list[GearedWeight]:
    return [replace(geared, ratio=(ratio, ratio)) for ratio in ratios]


def by_brute_force() -> dict[tuple[int, int, float], float]:
    """Cost of every pair of teeth, each with every ratio: one plan with given gears each."""
    actual = {}
    for a, b in product(range(17, 20), repeat=2):
        pitch = {"pitch_radius": 0.01 * a, "ratio": (a / b, a / b)}
        first = replace(ROCKER, **pitch)
        for ratio, second in zip(FRACTIONS, each(CRANK, FRACTIONS), strict=True):
            actual[a, b, ratio] = cost(first, second)
    return actual


def test_two_shafts_with_choices_each(monkeypatch: pytest.MonkeyPatch) -> None:
    """All 45 together; and where not all are tried, one shaft after the other gets there too."""
    brute = by_brute_force()
    least = min(brute.values())
    assert max(brute.values()) > 1.01 * least  # the gears count
    balanced = eq.balance(MACHINE, plan(TOOTHED, CRANK))
    assert balanced.cost == pytest.approx(least, rel=1e-6)
    assert balanced.bound == pytest.approx(balanced.cost, rel=1e-6)
    assert str(balanced.method).endswith("for each of 45 choices of gears")
    gears = [change.values for change in balanced.changes if change.kind == "gears"]
    assert [gear["driver"] for gear in gears] == ["rocker", "crank"]
    (a, b), ratio = gears[0]["teeth"], gears[1]["ratio"]
    key = min(brute, key=lambda item: abs(item[2] - ratio) + abs(item[0] - a) + abs(item[1] - b))
    assert brute[key] == pytest.approx(least, rel=1e-6)
    monkeypatch.setattr(gear_search, "MOST_CHOICES", 9)
    fewer = eq.balance(MACHINE, plan(TOOTHED, CRANK))
    assert fewer.cost == pytest.approx(least, rel=1e-6)


def test_what_is_proved_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    """The best of all teeth where all were tried; else of those that were."""
    teeth = {"teeth": (17, 18), "module": 0.02, "ratio": None, "pitch_radius": None}
    both = plan(replace(TOOTHED, teeth=(17, 18)), replace(CRANK, **teeth))
    every = eq.balance(MACHINE, both)
    assert not every.scope
    monkeypatch.setattr(gear_search, "MOST_CHOICES", 4)
    some = eq.balance(MACHINE, both)
    assert "for each of the gears tried" in map(str, some.scope)
    assert some.cost == pytest.approx(every.cost, rel=1e-6)


@EXHAUSTIVE  # On every change: `test_two_shafts_with_choices_each`, and `test_geared.py`.
def test_two_shafts_with_ranges(monkeypatch: pytest.MonkeyPatch) -> None:
    """No pair of ratios and directions of a grid is better; the search uses far fewer."""
    monkeypatch.setattr(gear_search, "MOST_CHOICES", 16)
    monkeypatch.setattr(gear_search, "MOST_ROUNDS", 1)
    first = replace(ROCKER, ratio=(0.8, 1.6))
    second = replace(CRANK, ratio=(2.0, 2.0), direction=(radians(30), radians(150)))
    result = cost(first, second)
    ratios = [0.8 + 0.1 * k for k in range(9)]
    ways = [radians(30 + 20 * k) for k in range(7)]
    grid = [
        cost(item, replace(second, direction=(way, way)))
        for item, way in product(each(first, ratios), ways)
    ]
    assert result <= min(grid) * (1 + 1e-6)


# On every change: `test_two_shafts_with_choices_each`.
@pytest.mark.exhaustive
def test_the_example_with_two_ranges_against_a_fine_grid() -> None:
    """No pair of given ratios is better, each with a plan of its own: 0.1 apart over the range of
    the rocker, and 0.005 apart about the ratio that is found.
    """
    machine = eq.load("balance-geared-two")
    assert machine.balance is not None
    first, second = machine.balance.geared
    balanced = eq.balance(machine)
    ratio, other = (change.values["ratio"] for change in balanced.changes if change.kind == "gears")
    ratios = [0.2 + 0.1 * k for k in range(29)] + [ratio + 0.005 * k for k in range(-4, 5)]
    grid = {
        (item.ratio, two.ratio): eq.balance(machine, replace(machine.balance, geared=(item, two)))
        for item, two in product(each(first, ratios), each(second, FRACTIONS))
    }
    least = min(value.cost for value in grid.values())
    assert balanced.cost <= least * (1 + 1e-6)
    assert grid[(ratio, ratio), (other, other)].cost == pytest.approx(balanced.cost, rel=1e-6)


# Proofs and limits of gears: the other tests of this file.
@pytest.mark.exhaustive
def test_order_of_shafts_does_not_count() -> None:
    assert cost(TOOTHED, CRANK) == pytest.approx(cost(CRANK, TOOTHED), rel=1e-6)


# Limits that nothing keeps: tests/unit/balancing/test_optimisation.py.
@pytest.mark.exhaustive
def test_limits_that_no_gears_keep() -> None:
    limits = (Limit(Objective("shaking_moment"), ratio=1e-6),)
    with refused(UsageError, least=0.336034, name="rms of shaking_moment", share=0.0001):
        eq.balance(MACHINE, replace(plan(TOOTHED, CRANK), limits=limits))


def test_errors_of_gears_are_not_all_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """Frames in which each was raised hold its problem; the first alone is raised in the end."""
    alive: list[weakref.ref[Problem]] = []
    of = Problem.of

    def recorded(*given: Any) -> Problem:
        problem = of(*given)
        alive.append(weakref.ref(problem))
        return problem

    monkeypatch.setattr(Problem, "of", recorded)
    own = replace(plan(TOOTHED), limits=(Limit(Objective("shaking_moment"), ratio=1e-6),))
    search = gear_search.GearSearch(gear_search.WithShafts(MACHINE, own, MACHINE))
    places = np.array([[k / 9] for k in range(9)])
    costs, impossible = search.evaluate(places)
    gc.collect()
    assert impossible.all() and np.all(costs == gear_search.LARGE)
    assert len(alive) == 9 and not any(item() is not None for item in alive[1:])
    assert search.first_error is not None and search.first_error.__traceback__ is None


def test_solutions_of_gears_are_not_all_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """A shaft of 23 by 23 teeth in 24 directions ran out of 2 GiB on its way."""
    alive: list[weakref.ref[Problem]] = []
    solved = gear_search.WithShafts.solved

    def recorded(shafts: gear_search.WithShafts, *others: Any) -> Solution:
        solution = solved(shafts, *others)
        alive.append(weakref.ref(solution.problem))
        return solution

    monkeypatch.setattr(gear_search.WithShafts, "solved", recorded)
    own = plan(TOOTHED)
    search = gear_search.GearSearch(gear_search.WithShafts(MACHINE, own, MACHINE))
    solution = search.run()
    gc.collect()
    assert len(alive) > len(search.tried) == 9
    assert [item() for item in alive if item() is not None] == [solution.problem]
