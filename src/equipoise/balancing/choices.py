"""The best of all choices of gears, where shafts are added to the machine.

Numbers of teeth are tried one and all; of ratios and directions a grid, whose best are followed
as far down as they go.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf
from typing import Any

import numpy as np

from equipoise.balancing.geared import Gearing, Mesh, with_shafts
from equipoise.balancing.solution import Solution, solve_problem
from equipoise.balancing.design_variables import Change
from equipoise.balancing.problem import Problem
from equipoise.balancing.weights import AddedWeight
from equipoise.errors import UsageError
from equipoise.mechanism.balance import Balance
from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]
Progress = Callable[[int, int], None]

LARGE = 1e300
"""A cost that every solution is below, while none is known."""
CLOSER, NEARER = 1e-10, 1e-6
"""Of the cost, and of a ratio or direction, to which the best ones of a range are followed."""
TIE, MOST_TIES = 5e-9, 24
"""Difference in cost that is none; choices among which the lightest is looked for."""
BEST_CHOICES, STEPS, MOST_STEPS = 3, 40, 80
"""Choices that are followed; first steps over a range; programs that are solved for each."""


def solve(machine: Machine, plan: Balance, progress: Progress | None = None) -> Solution:
    """The best of all choices of gears."""
    base, weights = machine, list[AddedWeight]()
    for shafts in plan.shafts:
        base, more = with_shafts(base, shafts)
        weights += more
    return _with_gears(machine, plan, base, weights, progress)


def _with_gears(
    machine: Machine,
    plan: Balance,
    base: Machine,
    weights: list[AddedWeight],
    progress: Progress | None,
) -> Solution:
    """Add geared weights one by one; only one of them may have several choices of gears."""
    changes: list[Change] = []
    open_one: tuple[Gearing, list[Mesh]] | None = None
    for geared in plan.geared:
        gearing = Gearing(base, geared)
        meshes = gearing.meshes()
        if len(meshes) > 1:
            if geared is not plan.geared[-1]:
                raise UsageError(
                    "only the last of [[balance.geared]] may have several ratios; give the others "
                    "one ratio each"
                )
            open_one = (gearing, meshes)
        else:
            base, weight = gearing.added(meshes[0])
            weights.append(weight)
            changes.append(gearing.change(meshes[0]))
    if open_one is None:
        return _one(machine, plan, base, weights, changes, progress)
    return _scan(machine, plan, weights, changes, *open_one, progress)


def _one(
    machine: Machine,
    plan: Balance,
    base: Machine,
    weights: list[AddedWeight],
    changes: list[Change],
    progress: Progress | None = None,
    above: float = inf,
) -> Solution:
    problem = Problem.of(machine, plan, base, weights)
    return replace(solve_problem(problem, progress, above), meshes=tuple(changes))


def _scan(
    machine: Machine,
    plan: Balance,
    weights: list[AddedWeight],
    changes: list[Change],
    gearing: Gearing,
    meshes: list[Mesh],
    progress: Progress | None,
) -> Solution:
    """Solve for every choice of gears; over a range of ratios, follow the best to their tops."""
    found: list[tuple[Mesh, Solution]] = []
    problems: list[UsageError] = []
    least = LARGE

    def solved(mesh: Mesh, above: float) -> Solution:
        base, weight = gearing.added(mesh)
        told_of = [*changes, gearing.change(mesh)]
        return _one(machine, plan, base, [*weights, weight], told_of, None, above)

    def at(mesh: Mesh) -> float:
        nonlocal least
        try:
            one = solved(mesh, least)
        except UsageError as error:
            problems.append(error)
            return inf
        found.append((mesh, one))
        least = min(least, one.best.value)
        if progress is not None:
            progress(min(len(found), most), most)
        return one.best.value

    most = len(meshes) + (BEST_CHOICES * MOST_STEPS if gearing.ranges else 0)
    values = [at(mesh) for mesh in meshes]
    if not found:
        raise problems[0]
    for k in np.argsort(values)[:BEST_CHOICES]:
        if gearing.ranges and np.isfinite(values[k]):
            _follow(gearing, meshes[k], at)
    best = _lightest(found, least, lambda mesh: solved(mesh, inf))
    count = sum(one.best.nodes for _, one in found)
    method = f"{best.method}, for each of {len(found)} choices of gears"
    return replace(best, method=method, best=replace(best.best, nodes=count))


def _lightest(
    found: list[tuple[Mesh, Solution]], least: float, solved: Callable[[Mesh], Solution]
) -> Solution:
    """Of the choices that are as good as the best, the one that adds the least mass."""
    ties = {mesh for mesh, one in found if one.best.value <= least + TIE}
    equal = sorted(ties, key=lambda mesh: (mesh.ratio, mesh.direction))
    best = [solved(mesh) for mesh in equal[:: max(1, len(equal) // MOST_TIES)]]
    lightest = min(best, key=lambda one: one.problem.mass_added(one.numbers))
    return replace(lightest, ties=len(equal))


def _follow(gearing: Gearing, start: Mesh, cost: Callable[[Mesh], float]) -> None:
    """Go down from a choice of gears, along all that may be any number between two."""
    from scipy.optimize import minimize

    first = {"ratio": start.ratio, "direction": start.direction}
    ranges = gearing.ranges

    def at(numbers: Array) -> float:
        here = {name: float(x) for name, x in zip(ranges, numbers, strict=True)}
        mesh = gearing.near(start, here)
        return cost(mesh) if gearing.is_clear(mesh) else inf

    begin = np.array([first[name] for name in ranges])
    steps = [(high - low) / STEPS for low, high in ranges.values()]
    simplex = np.vstack([begin, *(begin + step for step in np.diag(steps))])
    limits = np.array(list(ranges.values()))
    over = simplex > limits[:, 1]
    simplex[over] = (2 * begin - simplex)[over]
    options = {"initial_simplex": simplex, "xatol": NEARER, "fatol": CLOSER, "maxfev": MOST_STEPS}
    minimize(at, begin, method="Nelder-Mead", bounds=limits, options=options)
