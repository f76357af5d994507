"""Descents of the largest of functions: against published minima, and with exact slopes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal

import numpy as np
import pytest

import equipoise as eq
from equipoise.design.minimax import (
    MinimaxProblem,
    SequentialPrograms,
    ValuesAndSlopes,
    descended,
)
from equipoise.design.solvers import DesignProblem, solve
from equipoise.design.variables import Range
from equipoise.errors import ResponseError
from equipoise.handheld.design import Search
from equipoise.handheld.model import Tool

Array = np.ndarray[Any, Any]
LOW, WIDE = 0.0, 2.0


def cb2(x: Array) -> ValuesAndSlopes:
    """Problem CB2 of Charalambous and Bandler (1976): three functions of two numbers."""
    growth = 2 * np.exp(x[1] - x[0])
    values = np.array([x[0] ** 2 + x[1] ** 4, (2 - x[0]) ** 2 + (2 - x[1]) ** 2, growth])
    slopes = np.array([[2 * x[0], 4 * x[1] ** 3], [2 * x[0] - 4, 2 * x[1] - 4], [-growth, growth]])
    return ValuesAndSlopes(values, slopes)


class PublishedProblem(MinimaxProblem):
    """The same, both numbers from 0 to 2; 1 and their sum at most `most`."""

    start = np.array([0.1, 0.1])

    def __init__(self, most: float = 10.0) -> None:
        self.most, self.solvers = most, (SequentialPrograms(lambda done, total: None),)

    @property
    def spreads(self) -> list[Range]:
        return 2 * [Range(LOW, LOW + WIDE)]

    def functions(
        self, place: Array, slopes: bool = True
    ) -> tuple[ValuesAndSlopes, ValuesAndSlopes]:
        x = LOW + WIDE * place
        values, by_numbers = cb2(x)
        by_sum = np.full((1, 2), WIDE / self.most)
        limited = ValuesAndSlopes(np.array([(1 + x.sum()) / self.most]), by_sum)
        return ValuesAndSlopes(values, WIDE * by_numbers), limited


def test_a_published_minimum() -> None:
    """1.9522245 at (1.1390, 0.8996), where all three functions are equal nearby."""
    solution = solve(PublishedProblem())
    assert solution.solver == "sequential quadratic programs" and solution.proof is None
    assert LOW + WIDE * solution.places[0] == pytest.approx([1.1390, 0.8996], abs=1e-4)
    assert PublishedProblem().cost(solution.places[0]) == pytest.approx(1.9522245, abs=1e-6)


def test_within_a_limit_and_beyond_any() -> None:
    """The least on the line where the sum is as much as is allowed, by a fine grid."""
    solution = solve(PublishedProblem(most=2.5))
    first = np.linspace(0, 1.5, 150_001)
    at_grid = np.max(cb2(np.array([first, 1.5 - first])).values, axis=0)
    assert PublishedProblem().cost(solution.places[0]) == pytest.approx(at_grid.min(), rel=1e-6)
    with pytest.raises(ResponseError):
        solve(PublishedProblem(most=0.5))


def test_several_groups_with_bounds_of_their_own() -> None:
    """The sum of the largest of |x - 1|, |x - 3| and of 2 |x|: 3 over 0 to 1."""

    def groups(x: Array) -> list[ValuesAndSlopes]:
        both = np.array([[1.0], [-1.0]])
        first = ValuesAndSlopes(np.abs(x[0] - [1.0, 3.0]), np.sign(x - np.array([[1.0], [3.0]])))
        return [first, ValuesAndSlopes(2 * both[:, 0] * x[0], 2 * both)]

    end = descended(
        groups,
        np.array([0.7]),
        units=np.ones(2),
        box=(-5.0, 5.0),
        most=(50, 1e-12),
        total=lambda largest: (float(largest.sum()), np.ones(2)),
    )
    assert end == pytest.approx([0.0], abs=1e-6)
    far = descended(
        groups,
        np.array([0.7]),
        units=np.ones(2),
        box=(-5.0, 5.0),
        most=(50, 1e-12),
        total=lambda largest: (float(largest.sum()), np.ones(2)),
        least=np.array([0.0, 4.0]),  # the second counts beyond |x| = 2 only
    )
    assert far == pytest.approx([2.0], abs=1e-6)


@pytest.mark.parametrize("measure", ["rms", "peak"])
def test_slopes_of_a_tool_are_those_of_differences(measure: Literal["rms", "peak"]) -> None:
    tool = eq.load("brush-cutter")
    assert isinstance(tool, Tool) and tool.design is not None
    plan = replace(tool.design, measure=measure)
    search = Search(tool, plan, np.linspace(*plan.speeds, 7))
    place = np.full(len(search.spreads), 0.4)
    costs, violations = search.jacobian(place[None])
    step = 1e-6
    for k, axis in enumerate(np.eye(len(place))):
        ends = search.evaluate(np.array([place + step * axis, place - step * axis]))
        for slopes, values in zip((costs, violations), ends, strict=True):
            scale = max(float(np.abs(values).max()), float(np.abs(slopes).max()))
            assert slopes[0, 0, k] == pytest.approx(
                (values[0, 0] - values[1, 0]) / (2 * step), abs=1e-6 * scale
            )


def test_other_problems_have_none() -> None:
    assert DesignProblem.jacobian(PublishedProblem(), np.zeros((1, 2))) is None
