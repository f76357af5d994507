"""The line of half-swings: each height against the one before it.

Heights h_k of successive half-swings, peak to valley and valley to peak, lie on h_(k+1) = n h_k + m
with n = exp(-sigma pi / beta) and m = -2 d (1 + n).  Two heights share the turning point between
them, so an error there shows in both, and in the abscissa as well as in the ordinate; a plain
regression of ordinates would find n too small.  So the heights are not the measured values here:
the turning points are, each with an error of its own, and the line is the one whose exact turning
points come closest to them in least squares.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.measured.estimate import Constants, student
from equipoise.measured.swinging import reaches
from equipoise.measured.turning import Turns

Array = np.ndarray[Any, Any]

LEAST_SCATTER = 1e-4
"""Of the first half-swing, and of the half-period: what the polynomials may miss without noise."""


def line_of_swings(turns: Turns, confidence: float) -> Constants:
    """Constants from the straight line, and from the times at which half-swings are half done.

    Three half-swings have exactly one line, so there are no intervals.
    """
    spacing, spacing_variance = _spacing(turns)
    found, covariance = _line(turns)
    loss, friction = found[2:]
    damped = np.pi / spacing
    free = len(turns.time) - len(found)
    if free == 0:
        return Constants(damped, loss, friction, None, np.nan)
    both = np.zeros((3, 3))
    both[0, 0] = (damped / spacing) ** 2 * spacing_variance
    both[1:, 1:] = covariance[2:, 2:]
    return Constants(damped, loss, friction, both, student(confidence, free))


def _spacing(turns: Turns) -> tuple[float, float]:
    """Half-period, s, and its variance: slope of the times over their numbers, weighted."""
    count = np.arange(len(turns.passed))
    weight = 1 / turns.passed_spread**2
    mean = np.average(count, weights=weight)
    away = count - mean
    square = float(np.sum(weight * away**2))
    slope = float(np.sum(weight * away * turns.passed) / square)
    left = turns.passed - np.average(turns.passed, weights=weight) - slope * away
    least = (LEAST_SCATTER * slope) ** 2 * float(np.mean(weight))
    scatter = max(float(np.sum(weight * left**2)) / (len(count) - 2), least)
    return slope, scatter / square


def _line(turns: Turns) -> tuple[Array, Array]:
    """Centre, first amplitude, -ln n, d; and their covariance from the scatter of turns."""
    from scipy.optimize import least_squares

    number = np.arange(len(turns.time))
    sense = turns.side * np.where(number % 2 == 0, 1.0, -1.0)
    heights, spread = turns.heights, turns.spread / np.mean(turns.spread)
    scale = float(heights[0])

    def left(p: Array) -> Array:
        reach = reaches(number, p[1], p[2], p[3])
        expected = p[0] + sense * (reach + p[3])
        return np.asarray((turns.displacement / scale - expected) / spread)

    unit = np.array([scale, scale, 1.0, scale])
    tried = [
        least_squares(left, guess / unit, "3-point", x_scale="jac") for guess in _guesses(turns)
    ]
    done = min(tried, key=lambda one: one.cost)
    free = len(number) - 4
    scatter = max(2 * done.cost / free, LEAST_SCATTER**2) if free else 0.0
    covariance = scatter * np.linalg.pinv(done.jac.T @ done.jac)
    return np.array(done.x * unit), np.array(covariance * np.outer(unit, unit))


def _guesses(turns: Turns) -> list[Array]:
    """The same with all of the decay viscous, with all of it Coulomb friction, with half of each.

    One of them leads to the line even where noise hides which of the two it is.
    """
    heights = turns.heights
    loss = float(np.log(heights[0] / heights[-1])) / (len(heights) - 1)
    friction = float(heights[0] - heights[-1]) / (len(heights) - 1) / 4
    guesses = []
    for share in (1.0, 0.0, 0.5):
        ratio = np.exp(-share * loss)
        amplitude = float(heights[0]) / (1 + ratio) + (1 - share) * friction
        center = turns.displacement[0] - turns.side * amplitude
        guesses.append(np.array([center, amplitude, share * loss, (1 - share) * friction]))
    return guesses
