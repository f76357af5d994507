"""Our cone solver against Clarabel: random programs, and the plans of the examples."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import sparse

import equipoise as eq
from equipoise.balancing import program
from equipoise.balancing.program import clarabel_solver, interior_point_solver
from support.chosen import few

TOLERANCE = 1e-8


def random_program(seed: int) -> tuple[Any, ...]:
    """A program that has a solution, and whose dual has one: made from both."""
    rng = np.random.default_rng(seed)
    sizes = [("zero", 2), ("nonnegative", 9), *[("second-order", s) for s in (3, 3, 5, 12)]]
    rows = sum(size for _, size in sizes)
    matrix = rng.normal(size=(rows, 8)) * 10.0 ** rng.uniform(-2, 2, size=(rows, 1))
    slack, dual, start = np.zeros(rows), np.zeros(rows), 0
    for kind, size in sizes:
        part = slice(start, start + size)
        for vector in (slack, dual):
            values = rng.normal(size=size)
            if kind == "nonnegative":
                values = abs(values)
            elif kind == "second-order":
                values[0] = np.linalg.norm(values[1:]) + rng.uniform(0, 1)
            vector[part] = values
        if kind == "zero":
            slack[part] = 0.0
        start += size
    right = matrix @ rng.normal(size=8) + slack
    return -matrix.T @ dual, sparse.csc_matrix(matrix), right, sizes


@pytest.mark.parametrize("seed", range(20))
def test_random_programs_have_the_same_value(seed: int) -> None:
    cost, matrix, right, cones = random_program(seed)
    one = clarabel_solver(cost, matrix, right, cones, TOLERANCE)
    two = interior_point_solver(cost, matrix, right, cones, TOLERANCE)
    assert one.status == two.status == "solved"
    assert two.value == pytest.approx(one.value, rel=1e-6, abs=1e-6)
    assert two.dual_value == pytest.approx(two.value, rel=1e-6, abs=1e-6)
    slack = right - matrix @ two.x
    assert abs(slack[:2]).max() < 1e-6 * (1 + abs(right).max())
    assert slack[2:11].min() > -1e-6 * (1 + abs(right).max())


@pytest.mark.parametrize("cone", [("nonnegative", 2), ("second-order", 2)])
def test_constraints_that_exclude_each_other_are_infeasible(cone: tuple[Any, int]) -> None:
    if cone[0] == "nonnegative":  # x <= -1 and x >= 1
        matrix, right = np.array([[1.0], [-1.0]]), np.array([-1.0, -1.0])
    else:  # |x + 3| <= -1
        matrix, right = np.array([[0.0], [-1.0]]), np.array([-1.0, 3.0])
    end = interior_point_solver(np.ones(1), sparse.csc_matrix(matrix), right, [cone], TOLERANCE)
    assert end.status == "infeasible"


def test_a_program_by_hand() -> None:
    """The least of x + y over the unit disc is -sqrt(2)."""
    matrix = sparse.csc_matrix(np.array([[0.0, 0.0], [-1.0, 0.0], [0.0, -1.0]]))
    right = np.array([1.0, 0.0, 0.0])
    cones: Any = [("second-order", 3)]
    end = interior_point_solver(np.ones(2), matrix, right, cones, 1e-9)
    assert end.value == pytest.approx(-np.sqrt(2), rel=1e-8)
    np.testing.assert_allclose(end.x, -np.sqrt(0.5), rtol=1e-6)
    np.testing.assert_allclose(end.z[0], np.sqrt(2), rtol=1e-6)


PLANS = (
    *("balance-coupler", "balance-crank", "balance-rig", "balance-shafts", "balance-spring"),
    *("exudyn-slider-crank", "four-stroke-engine", "knife-drive", "pick-and-place", "twin-engine"),
)
"""Without those whose search solves hundreds of large programs, which differ in nothing else."""


@pytest.mark.parametrize("name", few(PLANS, {*PLANS} - {"balance-rig", "balance-shafts"}))
def test_plans_of_the_examples_come_to_the_same(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    machine, found = eq.load(name), []
    for solver in (clarabel_solver, interior_point_solver):
        monkeypatch.setattr(program, "usual_solver", lambda solver=solver: solver)
        found.append(eq.balance(machine).objectives)
    for key, (before, after) in found[0].items():
        assert found[1][key][1] == pytest.approx(after, rel=1e-6, abs=1e-9 * abs(before))
