"""Steady state: the periodic solution of a machine's equations, with what it leaves unsolved."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import ceil, pi
from typing import Any

import numpy as np

from equipoise.errors import ResponseError
from equipoise.structures.collocation import (
    NOTHING,
    RULE,
    Conditions,
    Orbit,
    System,
    solve,
)

Array = np.ndarray[Any, Any]
Guess = Callable[[Array], Array]

NO_STEADY_STATE = (
    "no steady state was found; the machine may not settle into one. Look at it from rest "
    "(`equipoise simulate`), or try another speed or more damping"
)
SAMPLES = 720
"""In a turn, at which a solution is read off."""
INTERVALS = 36
"""In a turn, to begin with."""
MOST_INTERVALS, MOST_SWINGS = 4000, 400
FINE = 1e-11
"""Residual of an interval at which it is left as it is."""
ROUNDS = 14
"""Of refinement: where a contact opens or a load sets in, intervals are cut in four."""
NEUTRAL = 1 + 1e-6
"""Multiplier up to which nothing grows, whatever rounding says."""
PROGRESS, PATIENCE = 0.7, 3
"""Share of the residual above which a finer mesh has brought nothing, and how often in a row."""
LOOSE = 1e-6
"""Change of the solution above which Newton's method has not found one."""


@dataclass(frozen=True, eq=False)
class Steady:
    """A periodic solution against crank angle.

    residual : of the worst interval, the share by which the equations are not met between nodes,
        times the interval's share of the period.
    """

    orbit: Orbit
    residual: float

    def multipliers(self, count: int) -> Array:
        """Floquet multipliers (count,) of the first `count` states: by what a disturbance has
        grown after one period; the largest first.
        """
        values = np.linalg.eigvals(self.orbit.monodromy[:count, :count])
        return np.asarray(values[np.argsort(-np.abs(values), kind="stable")])


def steady(
    system: System,
    guesses: Iterable[Guess],
    turns: int,
    conditions: Conditions,
    swings: float = 0.0,
) -> Steady:
    """Find the periodic solution on a mesh that is refined where the equations are not met.

    Parameters
    ----------
    guesses : states (n, M) against the crank's turning (M,), rad; the next is tried where one leads
        nowhere, or to a solution that is not stable, such as a support balanced on its head.
    swings : how often the support swings freely in a turn; the mesh has to follow that.

    Raises
    ------
    ResponseError : there is none that Newton's method could find.
    """
    if not swings <= MOST_SWINGS:
        raise ResponseError(
            f"the support swings freely {swings:.3g} times in a turn of the crank, more often than "
            f"the {MOST_SWINGS} that the exact equations follow; for so slow a crank choose the "
            "model moment"
        )
    intervals = (INTERVALS + ceil(swings)) * turns
    points = np.linspace(0.0, 2 * pi * turns, intervals + 1)
    orbit = _first(_tried(system, points, guess, conditions) for guess in guesses)
    return _refined(system, orbit, conditions, 2 * intervals + MOST_INTERVALS * turns)


def _first(tried: Iterable[Orbit | None]) -> Orbit:
    """The first solution that is stable, or else the first."""
    unstable = None
    for found in tried:
        if found is not None and _dies_out(found):
            return found
        unstable = unstable or found
    if unstable is None:
        raise ResponseError(NO_STEADY_STATE)
    return unstable


def _refined(system: System, orbit: Orbit, conditions: Conditions, most: int) -> Steady:
    """The solution on a mesh of at most so many intervals, or a few more."""
    error, idle = _residuals(system, orbit), 0
    for _ in range(ROUNDS):
        coarse = error > max(FINE, orbit.change)  # below its last change the solution is rounding
        if not np.any(coarse) or len(orbit.points) > most:
            break
        finer = _tried(system, _cut(orbit.points, coarse), orbit.at, conditions)
        if finer is None:
            break
        before, orbit = float(np.max(error)), finer
        error = _residuals(system, orbit)
        idle = idle + 1 if np.max(error) > PROGRESS * before else 0
        if idle == PATIENCE:  # what is left is rounding
            break
    return Steady(orbit, float(np.max(error)))


def _tried(system: System, points: Array, guess: Guess, conditions: Conditions) -> Orbit | None:
    with np.errstate(all="ignore"):
        try:
            orbit = solve(system, points, guess, conditions)
        except (np.linalg.LinAlgError, ResponseError):  # the second by a guess that takes too long
            return None
    return orbit if orbit.change < LOOSE else None


def _dies_out(orbit: Orbit) -> bool:
    """Whether disturbances do not grow; constants, such as the shift of a curve, have 1."""
    return bool(np.max(np.abs(np.linalg.eigvals(orbit.monodromy)), initial=0.0) < NEUTRAL)


def _residuals(system: System, orbit: Orbit) -> Array:
    """How far each interval (K,) is from the equations, beside the largest rate of each state."""
    steps = np.diff(orbit.points)
    scale = np.maximum(np.max(np.abs(orbit.slopes), axis=(1, 2)), NOTHING)
    worst = np.zeros(len(steps))
    for share in (RULE.nodes[0] / 2, 0.5, 1 - RULE.nodes[0] / 2):
        s = orbit.points[:-1] + share * steps
        missed = np.abs(orbit.slopes_at(share) - system.rates(s)(orbit.at(s))) / scale[:, None]
        worst = np.maximum(worst, np.max(missed, axis=0, initial=0.0))
    return np.asarray(worst * steps / (orbit.points[-1] - orbit.points[0]))


def _cut(points: Array, coarse: Array) -> Array:
    """The mesh with coarse intervals (K,) cut in four."""
    inner = points[:-1, None] + np.diff(points)[:, None] * np.array([0.25, 0.5, 0.75])
    return np.sort(np.concatenate([points, inner[coarse].ravel()]))
