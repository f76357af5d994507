"""The best first moments in closed form, where nothing but a mean square is asked.

Moved centres of mass without limits, and weights of given mass in rooms without limits: their
first moments are free, and the least mean square is that of a linear problem.
"""

from __future__ import annotations

from math import isfinite
from typing import Any

import numpy as np

from equipoise.balancing.branch_and_bound import Best
from equipoise.balancing.measures import mean_square_rows
from equipoise.balancing.design_variables import MovedCenter, DesignVariables
from equipoise.balancing.problem import WITHOUT_EFFECT, Problem
from equipoise.balancing.program import Program
from equipoise.balancing.weights import AddedWeight

Array = np.ndarray[Any, Any]


def closed_form(problem: Problem) -> list[Array] | None:
    """Numbers of each part at the least mean square, or None where there is no closed form."""
    plan = problem.plan
    squared = plan.combine == "squares" or len(plan.objectives) == 1
    if plan.limits or not squared or plan.added_mass is not None:
        return None
    if any(one.measure not in {"rms", "ripple"} or len(one.speeds) > 1 for one in plan.objectives):
        return None
    free = [_free_numbers(part) for part in problem.parts]
    if not free or any(numbers is None for numbers in free):
        return None
    counts = np.cumsum([0, *(part.count for part in problem.parts)])
    places = np.concatenate([start + n for start, n in zip(counts, free, strict=False)])
    found = _least_squares(problem, places, _given_numbers(problem))
    if found is None:
        return None
    return problem.tightened(np.split(found, counts[1:-1]))


def _free_numbers(part: DesignVariables) -> Array | None:
    """Which numbers of a part are first moments without limits; None where it has limits."""
    if isinstance(part, MovedCenter):
        move = part.move
        return np.array([0, 1]) if (move.x, move.y, move.center) == (None,) * 3 else None
    if isinstance(part, AddedWeight) and part.weight.mass is not None:
        free = part.weight.shape in {"any", "point"} and not isfinite(part.weight.radius)
        return np.array([1, 2]) if free else None
    return None


def _given_numbers(problem: Problem) -> Array:
    """All numbers, with those that are given and 0 elsewhere."""
    numbers = [np.zeros(part.count) for part in problem.parts]
    for part, own in zip(problem.parts, numbers, strict=True):
        if isinstance(part, AddedWeight) and part.weight.mass is not None:
            own[0] = part.weight.mass / part.mass_unit
    return np.concatenate(numbers)


def _least_squares(problem: Problem, places: Array, given: Array) -> Array | None:
    """All numbers, with those at some places such that the sum of squares is least."""
    matrices, vectors = [], []
    others = np.setdiff1d(np.arange(len(given)), places)
    lifts = others[given[others] == 0]
    for one in problem.plan.objectives:
        (signal,) = problem.signals[one.name]
        if np.max(np.abs(signal.columns[lifts]), initial=0.0) > WITHOUT_EFFECT:
            return None  # an inertia that grows with the square of a place
        matrix, vector = mean_square_rows(signal, one.measure)
        matrices.append(one.weight * matrix[:, places])
        vectors.append(one.weight * (vector + matrix @ given))
    moments = np.linalg.lstsq(np.concatenate(matrices), -np.concatenate(vectors), rcond=None)[0]
    found = given.copy()
    found[places] = moments
    return found


def as_best(problem: Problem, cost: float) -> Best:
    """A closed form as what the search would have found: no limit, no interval, no gap."""
    return Best(np.zeros(0), cost, cost, {}, Program(), 0)
