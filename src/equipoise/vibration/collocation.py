"""Periodic solutions of ordinary differential equations, by Gauss's collocation.

Between two points of a mesh the solution is a polynomial whose derivative meets the equations at
Gauss's nodes.  Newton's method condenses every interval to an affine map from its begin to its
end; their product closes the period and is the monodromy matrix, whose eigenvalues decide whether
disturbances die out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import lstsq
from equipoise.signals import Array

Rates = Callable[[Array], Array]

STAGES = 8
"""Nodes in an interval: of order 16 at its ends."""
COMPLEX_STEP = 1e-30
"""Of the complex step of derivatives, of which no digits are lost however small it is."""
MOST_ROUNDS = 40
"""Steps of Newton's method, which takes about six where it comes to an end."""
NOTHING = 1e-10
"""Size of a state (m, rad and their rates) below which it is rounding."""
CLOSE = 1e-12
"""Change of the solution, beside its largest value, at which Newton's method stops."""
SETTLED = 1e-7
"""Change below which it stops too once a round brings less than a half."""


class System(Protocol):
    """Equations dx/ds = f(s, x) of n states over a period."""

    def rates(self, s: Array) -> Rates:
        """Function from states (n, ..., P), real or complex, to their derivatives at s (P,)."""


@dataclass(frozen=True, eq=False)
class BoundaryConditions:
    """What closes the solution: begin (n, n) x(0) + end (n, n) x(L) = value (n,)."""

    begin: Array
    end: Array
    value: Array

    @classmethod
    def periodic(cls, count: int) -> BoundaryConditions:
        return cls(-np.eye(count), np.eye(count), np.zeros(count))


@dataclass(frozen=True, eq=False)
class Orbit:
    """A periodic solution on a mesh of K intervals.

    points : (K + 1,) mesh.  starts : (n, K + 1) states there.
    slopes : (n, K, m) derivatives at the nodes.
    monodromy : (n, n), of a small disturbance over one period.
    change : last change by Newton's method, beside the solution's size.
    rounds : of Newton's method.
    """

    points: Array
    starts: Array
    slopes: Array
    monodromy: Array
    change: float
    rounds: int

    @cached_property
    def nodes(self) -> Array:
        """(K, m) values of s."""
        return nodes_of(self.points)

    @cached_property
    def states(self) -> Array:
        """(n, K, m) states at the nodes."""
        steps = np.diff(self.points)[:, None]
        return np.asarray(
            self.starts[:, :-1, None] + steps * np.einsum("jl,nkl->nkj", RULE.inner, self.slopes)
        )

    def at(self, s: Array) -> Array:
        """States (n, M) at any s (M,) of the period."""
        k = np.clip(np.searchsorted(self.points, s, side="right") - 1, 0, len(self.points) - 2)
        step = np.diff(self.points)[k]
        weights = RULE.integrals((s - self.points[k]) / step)
        return np.asarray(
            self.starts[:, k] + step * np.einsum("ml,nml->nm", weights, self.slopes[:, k])
        )

    def slopes_at(self, share: float) -> Array:
        """Derivatives (n, K) of the polynomials at a share of each interval."""
        return np.asarray(self.slopes @ RULE.values(np.array([share]))[0])

    def integral(self, values: Array) -> float:
        """Integral over the period of values (K, m) at the nodes."""
        return float(np.sum((values @ RULE.weights) * np.diff(self.points)))


@dataclass(frozen=True, eq=False)
class GaussRule:
    """Gauss's rule on [0, 1], by Legendre's polynomials, which keep it exact to rounding.

    nodes, weights : (m,).
    legendre : (m, m), coefficients of Lagrange's polynomials, a column each.
    """

    nodes: Array
    weights: Array
    legendre: Array

    @classmethod
    def of(cls, stages: int) -> GaussRule:
        x, w = np.polynomial.legendre.leggauss(stages)
        orders = np.arange(stages)
        values = np.polynomial.legendre.legvander(x, stages - 1)
        return cls((x + 1) / 2, w / 2, (orders + 0.5)[:, None] * values.T * w)

    def values(self, share: Array) -> Array:
        """Lagrange's polynomials (M, m) at shares (M,) of an interval."""
        stages = len(self.nodes)
        return np.polynomial.legendre.legvander(2 * share - 1, stages - 1) @ self.legendre

    def integrals(self, share: Array) -> Array:
        """Their integrals (M, m) from the begin of an interval."""
        stages = len(self.nodes)
        legendre = np.polynomial.legendre.legvander(2 * share - 1, stages)
        below = np.concatenate([-np.ones((len(share), 1)), legendre[:, : stages - 1]], axis=1)
        return np.asarray((legendre[:, 1:] - below) / (4 * np.arange(stages) + 2) @ self.legendre)

    @cached_property
    def inner(self) -> Array:
        """(m, m), integrals to each node."""
        return self.integrals(self.nodes)


RULE = GaussRule.of(STAGES)


def nodes_of(points: Array) -> Array:
    """Gauss's nodes (K, m) in every interval of a mesh (K + 1,)."""
    return np.asarray(points[:-1, None] + np.diff(points)[:, None] * RULE.nodes)


def solve(
    system: System, points: Array, guess: Callable[[Array], Array], conditions: BoundaryConditions
) -> Orbit:
    """Find a periodic solution by Newton's method.

    Parameters
    ----------
    points : (K + 1,) mesh over one period.
    guess : states (n, M) at s (M,), from which to start.

    Returns
    -------
    Orbit, whose `change` shows whether Newton's method has converged.
    """
    nodes = nodes_of(points)
    rates = system.rates(nodes.ravel())
    starts, states = guess(points), guess(nodes.ravel()).reshape(-1, *nodes.shape)
    slopes = _slopes(rates, states)
    orbit = Orbit(points, starts, slopes, np.eye(len(starts)), np.inf, 0)
    misfit, last = np.inf, np.inf
    for number in range(1, MOST_ROUNDS + 1):
        step = _newton(rates, orbit, states, conditions)
        share = 1.0
        while True:
            tried = states + share * step.states
            result = replace(
                orbit, starts=starts + share * step.starts, slopes=_slopes(rates, tried)
            )
            new = _misfit(result, tried, conditions)
            if new <= 2 * misfit or share < 1 / 32 or not np.isfinite(misfit):
                break
            share /= 4
        scale = np.maximum(np.max(np.abs(tried), axis=(1, 2)), NOTHING)
        change = float(np.max(np.abs(step.starts) / scale[:, None]))
        if not np.isfinite(change):
            return replace(orbit, change=np.inf)
        starts, states, misfit = result.starts, tried, new
        orbit = replace(result, monodromy=step.monodromy, change=change, rounds=number)
        if share == 1.0 and (change < CLOSE or (change > last / 2 and last < SETTLED)):
            break  # there, or as near as rounding lets it come
        last = change
    return orbit


def _slopes(rates: Rates, states: Array) -> Array:
    return rates(states.reshape(len(states), -1)).reshape(states.shape)


def _misfit(orbit: Orbit, states: Array, conditions: BoundaryConditions) -> float:
    """How far from a solution, each state beside its own size."""
    scale = np.maximum(np.max(np.abs(states), axis=(1, 2)), NOTHING)
    inner = np.abs(orbit.states - states).max(axis=(1, 2))
    across = np.abs(orbit.starts[:, 1:] - _ends(orbit)).max(axis=1)
    return float(np.max(np.maximum(inner, across) / scale))


def _ends(orbit: Orbit) -> Array:
    return np.asarray(orbit.starts[:, :-1] + np.diff(orbit.points) * (orbit.slopes @ RULE.weights))


@dataclass(frozen=True, eq=False)
class _Step:
    starts: Array
    states: Array
    monodromy: Array


def _newton(rates: Rates, orbit: Orbit, states: Array, conditions: BoundaryConditions) -> _Step:
    """One step of Newton's method, condensed interval by interval."""
    count, intervals, stages = states.shape
    h = np.diff(orbit.points)
    jacobian = _jacobian(rates, states)  # (K, m, n, n)
    size = stages * count
    # Within an interval: dX_j - h sum_l a_jl J_l dX_l = dx + r_j
    coupling = np.einsum("k,jl,klab->kjalb", h, RULE.inner, jacobian).reshape(-1, size, size)
    misfit = np.moveaxis(orbit.states - states, 0, -1).reshape(intervals, size, 1)
    ones = np.tile(np.eye(count), (stages, 1))
    solved = np.linalg.solve(
        np.eye(size) - coupling,
        np.concatenate([np.broadcast_to(ones, (intervals, size, count)), misfit], axis=2),
    )
    weighted = np.einsum("k,l,klab->kalb", h, RULE.weights, jacobian).reshape(-1, count, size)
    through = weighted @ solved
    carry = np.eye(count) + through[..., :count]  # (K, n, n)
    rest = through[..., count] + (_ends(orbit) - orbit.starts[:, 1:]).T  # (K, n)
    monodromy, offset = np.eye(count), np.zeros(count)
    for k in range(intervals):
        monodromy, offset = carry[k] @ monodromy, carry[k] @ offset + rest[k]
    open_by = (
        conditions.value
        - conditions.begin @ orbit.starts[:, 0]
        - conditions.end @ orbit.starts[:, -1]
    )
    closing = conditions.begin + conditions.end @ monodromy
    first = lstsq(closing, open_by - conditions.end @ offset, rcond=None)[0]
    starts = np.empty((count, intervals + 1))
    starts[:, 0] = first
    for k in range(intervals):
        starts[:, k + 1] = carry[k] @ starts[:, k] + rest[k]
    inner = solved[..., :count] @ starts[:, :-1].T[..., None] + solved[..., count:]
    return _Step(starts, np.moveaxis(inner.reshape(intervals, stages, count), -1, 0), monodromy)


def _jacobian(rates: Rates, states: Array) -> Array:
    """Derivatives (K, m, n, n) of the rates by the states, by complex steps."""
    count, intervals, stages = states.shape
    flat = states.reshape(count, -1)
    moved = np.repeat(flat[:, None, :].astype(complex), count, axis=1)
    moved[np.arange(count), np.arange(count)] += 1j * COMPLEX_STEP
    slopes = rates(moved).imag / COMPLEX_STEP  # (n, n by state, P)
    return np.moveaxis(slopes, -1, 0).reshape(intervals, stages, count, count)
