"""Cone programs against what is known of them: random ones with a solution, and one by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import sparse

from equipoise.balancing.program import solve_cones

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


@pytest.mark.parametrize("seed", range(5))
def test_random_programs_end_in_a_certificate(seed: int) -> None:
    """Rows are kept, and no value is below that of the dual, which is the same."""
    cost, matrix, right, cones = random_program(seed)
    end = solve_cones(cost, matrix, right, cones, TOLERANCE)
    assert end.status == "solved"
    assert end.dual_value == pytest.approx(end.value, rel=1e-6, abs=1e-6)
    np.testing.assert_allclose(matrix.T @ end.z, -cost, atol=1e-6 * (1 + abs(cost).max()))
    slack = right - matrix @ end.x
    assert abs(slack[:2]).max() < 1e-6 * (1 + abs(right).max())
    assert slack[2:11].min() > -1e-6 * (1 + abs(right).max())


@pytest.mark.parametrize("cone", [("nonnegative", 2), ("second-order", 2)])
def test_constraints_that_exclude_each_other_are_infeasible(cone: tuple[Any, int]) -> None:
    if cone[0] == "nonnegative":  # x <= -1 and x >= 1
        matrix, right = np.array([[1.0], [-1.0]]), np.array([-1.0, -1.0])
    else:  # |x + 3| <= -1
        matrix, right = np.array([[0.0], [-1.0]]), np.array([-1.0, 3.0])
    end = solve_cones(np.ones(1), sparse.csc_matrix(matrix), right, [cone], TOLERANCE)
    assert end.status == "infeasible"


def test_a_program_by_hand() -> None:
    """The least of x + y over the unit disc is -sqrt(2)."""
    matrix = sparse.csc_matrix(np.array([[0.0, 0.0], [-1.0, 0.0], [0.0, -1.0]]))
    right = np.array([1.0, 0.0, 0.0])
    cones: Any = [("second-order", 3)]
    end = solve_cones(np.ones(2), matrix, right, cones, 1e-9)
    assert end.value == pytest.approx(-np.sqrt(2), rel=1e-8)
    np.testing.assert_allclose(end.x, -np.sqrt(0.5), rtol=1e-6)
    np.testing.assert_allclose(end.z[0], np.sqrt(2), rtol=1e-6)
