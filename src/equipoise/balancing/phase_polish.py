"""From the best cells of the grid down to the minimum.

Mean squares are followed by Newton's method in a trust region.  Where their roots are summed, the
sum has a kink wherever one of them vanishes; sqrt(q + e^2) with a falling e leads there.  Peaks
have a kink where two of them tie, which is where the best phases usually lie: linear programs over
all tops, in a trust region too, find it.
"""

from __future__ import annotations

import numpy as np

from equipoise.balancing.phase_cost import Cost, Pieces, Tops
from equipoise.signals import Array

SMOOTHING = (1e-1, 1e-2, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11)
"""e over the value that counts as one."""
ROUNDS, SMALLEST, GAIN = 40, 1e-4, 1e-12
"""Linear programs; trust region, rad, and relative gain at which they end."""
CURVED, LEAP = 6, 0.05
"""Times that tops are looked for anew and followed; change of a phase meanwhile, rad."""


def polished(cost: Cost, phases: Array, step: float) -> Array:
    """Phases (m,) of the minimum next to these, rad; that of row 1 is kept.

    step : of the grid, rad.
    """
    found = _newton(cost, phases) if cost.smooth else _by_tops(cost, phases, step)
    return found if cost.values(found) < cost.values(phases) else phases


# -- mean squares ----------------------------------------------------------------------------------


def _newton(cost: Cost, phases: Array) -> Array:
    from scipy.optimize import minimize

    kinks = len(cost.terms) > 1 and cost.combine == "sum"
    free = phases[1:]
    for smoothing in SMOOTHING if kinks else (0.0,):
        result = minimize(
            lambda x, e: _slopes(cost, x, e)[0],
            free,
            (smoothing,),
            method="trust-exact",
            jac=lambda x, e: _slopes(cost, x, e)[1],
            hess=lambda x, e: _slopes(cost, x, e)[2],
            options={"gtol": 1e-14, "maxiter": 200, "initial_trust_radius": 0.1},
        )
        free = result.x
    return np.concatenate([phases[:1], free])


def _slopes(cost: Cost, free: Array, smoothing: float) -> tuple[float, Array, Array]:
    """What is minimised, its gradient and second derivatives by the phases of all rows but one.

    Roots smoothed by e, or without e the sum of squares itself.
    """
    phases = np.concatenate([[0.0], free])
    value, gradient, second = 0.0, np.zeros(len(free)), np.zeros((len(free),) * 2)
    for term, factor in zip(cost.terms, cost.factors, strict=True):
        square, slope, bend = term.square_with_slopes(phases)
        slope, bend = slope[1:], bend[1:, 1:]
        if smoothing:
            root = float(np.sqrt(square + (smoothing * term.scale) ** 2))
            value += factor * root
            gradient += factor * slope / (2 * root)
            second += factor * (bend / (2 * root) - np.outer(slope, slope) / (4 * root**3))
        else:
            value += factor**2 * square
            gradient += factor**2 * slope
            second += factor**2 * bend
    return value, gradient, second


# -- peaks -----------------------------------------------------------------------------------------


def _by_tops(cost: Cost, phases: Array, step: float) -> Array:
    """Linear programs, which cross from one set of tops to another, then curved ones."""
    best = _linear_programs(cost, phases, step)
    for _ in range(CURVED):
        found = _curved(cost, best)
        if not cost.values(found) < cost.values(best) * (1 - GAIN):
            break
        best = found
    return best


def _linear_programs(cost: Cost, phases: Array, step: float) -> Array:
    best, here, region = phases, float(cost.values(phases)), step
    for _ in range(ROUNDS):
        move, gain = _step(cost, best, region)
        if gain <= GAIN * here:
            break
        there = best + np.concatenate([[0.0], move])
        value = float(cost.values(there))
        if here - value > 0.1 * gain:
            best, here, region = there, value, min(2 * region, step)
        else:
            region /= 3
        if region < SMALLEST:
            break
    return best


def _step(cost: Cost, phases: Array, region: float) -> tuple[Array, float]:
    """Best change (m - 1,) of the phases within a region, and the gain that it promises.

    Numbers of the program: the changes over the region, and the largest value of each term over
    the present one.
    """
    from scipy.optimize import linprog

    found = [Tops.of(term, phases).pieces(phases) for term in cost.terms]
    now = np.array([np.max(values) for values, _ in found])
    weights, unit = _weights(cost, now), np.where(now > 0, now, 1.0)
    free = len(phases) - 1
    rows = _below(found, unit)
    rows[:, :free] *= region
    result = linprog(
        np.concatenate([np.zeros(free), weights * unit]),
        rows,
        -np.concatenate([values for values, _ in found]),
        bounds=[(-1.0, 1.0)] * free + [(None, None)] * len(found),
    )
    if result.x is None:
        return np.zeros(free), 0.0
    return result.x[:free] * region, float(weights @ now - result.fun)


def _below(found: list[Pieces], unit: Array) -> Array:
    """Rows (P, m - 1 + terms): slopes of each value, less that of the largest of its term."""
    rows = []
    for k, (_, slopes) in enumerate(found):
        beyond = np.zeros((len(slopes), len(found)))
        beyond[:, k] = -unit[k]
        rows.append(np.hstack([slopes[:, 1:], beyond]))
    return np.vstack(rows)


def _curved(cost: Cost, phases: Array) -> Array:
    """Phases (m,) of the minimum over the same tops, by sequential quadratic programs.

    Where fewer tops tie than there are phases, linear programs come near it only.
    """
    from scipy.optimize import minimize

    tops = [Tops.of(term, phases) for term in cost.terms]
    now = np.array([np.max(each.pieces(phases)[0]) for each in tops])
    unit, free = np.where(now > 0, now, 1.0), len(phases) - 1

    def pieces(x: Array) -> list[Pieces]:
        turned = np.concatenate([phases[:1], phases[1:] + x[:free]])
        return [each.pieces(turned) for each in tops]

    def room(x: Array) -> Array:
        largest = x[free:] * unit
        found = zip(pieces(x), largest, unit, strict=True)
        return np.concatenate([(most - values) / scale for (values, _), most, scale in found])

    def slopes(x: Array) -> Array:
        found = pieces(x)
        scale = np.concatenate([np.full(len(v), u) for (v, _), u in zip(found, unit, strict=True)])
        below: Array = -_below(found, unit) / scale[:, None]
        return below

    def total(x: Array) -> float:
        return float(cost.of(list(x[free:] * unit)))

    def total_slope(x: Array) -> Array:
        return np.concatenate([np.zeros(free), _weights(cost, x[free:] * unit) * unit])

    result = minimize(
        total,
        np.concatenate([np.zeros(free), now / unit]),
        jac=total_slope,
        method="SLSQP",
        bounds=[(-LEAP, LEAP)] * free + [(None, None)] * len(tops),
        constraints={"type": "ineq", "fun": room, "jac": slopes},
        options={"ftol": 1e-16, "maxiter": 100},
    )
    return np.concatenate([phases[:1], phases[1:] + result.x[:free]])


def _weights(cost: Cost, now: Array) -> Array:
    """Slope of the combined value by that of each term."""
    if cost.combine == "sum":
        return cost.factors
    parts = cost.factors * now
    return np.asarray(cost.factors * parts / max(float(np.linalg.norm(parts)), 1e-300))
