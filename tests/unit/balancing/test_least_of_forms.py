"""The least of a largest of readings, against grids of all numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from equipoise.balancing import box_bounds as module
from equipoise.balancing.box_bounds import FormSum, least_of_forms
from equipoise.balancing.jump_bounds import Forms
from support.chosen import few

Array = np.ndarray
BOXES, READINGS, SLACK = 4, 9, 1e-6
LOW, HIGH = np.full((BOXES, 2), -1.0), np.array([1.0, 2.0]) * np.ones((BOXES, 1))
DIRECTIONS, LEAST = np.array([[1.0, 1.0], [0.5, -1.0]]), np.array([-1.5, -1.2])


def forms(chance: np.random.Generator) -> Forms:
    return Forms(chance.normal(size=(BOXES, READINGS)), chance.normal(size=(BOXES, READINGS, 2)))


def value(part: FormSum, numbers: Array) -> Array:
    """Of one part (N, B), with numbers (N, 2) in every box."""
    actual = []
    for x in numbers:
        at = np.tile(x, (BOXES, 1))
        actual.append(part.factors * sum(np.max(group.at(at), axis=1) for group in part.groups))
    return np.array(actual)


@pytest.fixture(params=few([0, 1, 2], {0}))
def parts(request: pytest.FixtureRequest) -> list[FormSum]:
    """A peak and a sum of two, and a limit that some of the numbers keep."""
    chance = np.random.default_rng(request.param)
    factors = chance.uniform(0.5, 2.0, (2, BOXES))
    peak = FormSum((forms(chance),), factors[0])
    both = FormSum((forms(chance), forms(chance)), factors[1])
    limit = FormSum((forms(chance),), np.ones(BOXES), is_limit=True)
    middle = value(limit, np.zeros((1, 2)))[0]
    return [peak, both, replace(limit, factors=1.0 / (0.1 + np.abs(middle)))]


def grid() -> Array:
    x, y = np.meshgrid(np.linspace(-1, 1, 81), np.linspace(-1, 2, 121))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    return points[np.all(points @ DIRECTIONS.T >= LEAST, axis=1)]


def bounded(parts: list[FormSum]) -> module.Bounded:
    start = np.zeros((BOXES, 2))
    return least_of_forms(parts, LOW, HIGH, start, DIRECTIONS, LEAST, SLACK)


def test_nothing_on_a_grid_is_below_it_and_its_numbers_are_the_best(parts: list[FormSum]) -> None:
    points, actual = grid(), bounded(parts)
    total = value(parts[0], points) + value(parts[1], points)
    total[value(parts[2], points) > 1.0] = np.inf
    best = np.min(total, axis=0)
    allowed = np.isfinite(best)
    assert np.any(allowed)
    assert np.all(actual.bounds <= best + 1e-9)
    # on a grid of 0.025, along slopes of 10 together
    assert actual.bounds[allowed] == pytest.approx(best[allowed], abs=0.25)
    each = [
        value(part, actual.numbers[k : k + 1])[0, k] for part in parts[:2] for k in range(BOXES)
    ]
    there = np.array(each).reshape(2, -1).sum(axis=0)
    assert there[allowed] == pytest.approx(actual.bounds[allowed], abs=1e-6)


def test_without_a_solution_it_is_a_bound_all_the_same(
    parts: list[FormSum], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing rests on the program: any multipliers bound."""
    best = bounded(parts).bounds
    monkeypatch.setattr(module, "_solved", lambda *_: None)
    result = bounded(parts)
    assert np.all(result.bounds <= best + 1e-9)
    points = grid()
    total = value(parts[0], points) + value(parts[1], points)
    assert np.all(result.bounds <= np.min(total, axis=0))


def test_without_numbers_it_is_the_largest(parts: list[FormSum]) -> None:
    none = np.zeros((BOXES, 0))
    fixed = [
        replace(part, groups=tuple(Forms(g.constants, g.slopes[..., :0]) for g in part.groups))
        for part in parts[:2]
    ]
    result = least_of_forms(fixed, none, none, none, np.zeros((0, 0)), np.zeros(0), SLACK)
    wanted = sum(
        item.factors * sum(np.max(g.constants, axis=1) for g in item.groups) for item in fixed
    )
    assert result.bounds == pytest.approx(wanted, rel=1e-12)
