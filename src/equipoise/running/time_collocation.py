"""Motion over a span of time as polynomials: collocation at all nodes of the span at once.

    y' = f(t, y)

at Chebyshev's nodes, by Newton's method with the derivatives of f at each of them, so that what
follows quickly, such as a motor's current, needs no shorter spans than what is slow.  One state
costs NumPy as much as all nodes together do.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.running.piece_motion import INTEGRALS
from equipoise.running.tabulated import (
    DERIVATIVE,
    NODES,
    POINTS,
    TO_CHEBYSHEV,
    integral_to,
    polynomials,
    roughness,
)
from equipoise.signals import Array

PATHS = INTEGRALS[1.0]
CLOSE, MOST_ROUNDS = 1e-11, 12
"""Change of the states, over their sizes, at which a span is solved, as what is left of it in the
integrals of the rates is a thousandth; it takes 3 or 4 rounds."""
QUICK = 1e-2
"""Share of what a round before missed, above which derivatives are computed anew."""
NUDGE = 1e-7
"""Share of its size by which a state is changed for derivatives, which only set how fast rounds
converge."""
DIVERGED = 1e3
"""Sizes of the states beyond which a round goes nowhere."""


@dataclass(frozen=True, eq=False)
class NodeValues:
    """What a function gives in K states.

    rates : (n, K) of the states.  quadratures : (Q, K) of what does not act back on these.
    others : (O, K) whatever else is of use.  references : (..., K) with which it was computed.
    """

    rates: Array
    quadratures: Array
    others: Array
    references: Mapping[str, Array] = field(default_factory=dict)


Function = Callable[[Array, Array, Mapping[str, Array]], "NodeValues | None"]
"""NodeValues at times (K,), s, and states (n, K), near references; None where there are none."""


@dataclass(frozen=True, eq=False)
class TimeSpan:
    """The motion over a span of time.

    begin, width : s.  start : states (n,) at the begin.  gained : quadratures (Q,) by then.
    values : at the nodes.
    """

    begin: float
    width: float
    start: Array
    gained: Array
    values: NodeValues

    def time(self, x: Any) -> Any:
        """Times, s, at places from -1 to 1."""
        return self.begin + self.width * (x + 1) / 2

    def states(self, x: Array) -> Array:
        """(n, K) at places (K,) from -1 to 1."""
        return np.asarray(self.start[:, None] + self._integrated(self.values.rates, x))

    def quadratures(self, x: Array) -> Array:
        """(Q, K) at places (K,)."""
        return np.asarray(self.gained[:, None] + self._integrated(self.values.quadratures, x))

    def others(self, x: Array) -> Array:
        """(O, K) at places (K,)."""
        return between_nodes(self.values.others, x)

    def rates(self, x: Array) -> Array:
        """Of the states (n, K) at places (K,)."""
        return between_nodes(self.values.rates, x)

    def references(self, x: Array) -> dict[str, Array]:
        """(..., K) at places (K,)."""
        each = self.values.references.items()
        return {name: between_nodes(values, x) for name, values in each}

    def beyond(self, x: float, times: Array) -> tuple[Array, dict[str, Array]]:
        """What states gain (n, K) from a place on up to times (K,), s, and references (..., K)
        there, by what is known at the place: parabolas, for references straight lines.
        """
        at, late = np.array([x]), times - self.time(x)
        rate, change = self.rates(at), self._by_time(self.values.rates, x)
        references = {}
        for name, values in self.values.references.items():
            references[name] = between_nodes(values, at) + self._by_time(values, x) * late
        return rate * late + change * late**2 / 2, references

    def changes(self, x: float) -> Array:
        """Derivative (O,) of the others by time at a place."""
        return self._by_time(self.values.others, x)[:, 0]

    def _by_time(self, values: Array, x: float) -> Array:
        """Derivative (..., 1) of values (..., NODES) by time at a place."""
        weights = polynomials(x)[: NODES - 1] @ DERIVATIVE @ TO_CHEBYSHEV
        return np.asarray((values @ weights)[..., None] * 2 / self.width)

    def _integrated(self, rates: Array, x: Array) -> Array:
        return np.asarray(self.width / 2 * (rates @ integral_to(x, -1.0).T))


def between_nodes(values: Array, x: Array) -> Array:
    """Values (..., K) at places (K,) from -1 to 1, by those (..., NODES) at the nodes."""
    return np.asarray(values @ TO_CHEBYSHEV.T @ polynomials(x)[:, :NODES].T)


def solved_span(
    function: Function,
    span: tuple[float, float],
    start: tuple[Array, Array],
    guess: tuple[Array, Mapping[str, Array]],
    sizes: Array,
    places: int = 0,
) -> TimeSpan | None:
    """The motion from a begin, s, over a width, s; None where Newton's method does not arrive.

    start : states (n,) and quadratures (Q,).  guess : states (n, NODES), and references near them.
    sizes : (n,) of the states.  places : how many states, from the first on, have the states after
        them as their rates, as places and speeds do.
    """
    begin, width = span
    times, paths = begin + width * (POINTS + 1) / 2, width / 2 * PATHS
    states, references = guess
    newton, before = None, np.inf
    for _ in range(MOST_ROUNDS):
        values = function(times, states, references)
        if values is None:
            return None
        references = values.references or references
        residual = start[0][:, None] + values.rates @ paths.T - states
        most = float(np.max(np.abs(residual) / sizes[:, None]))
        if most <= CLOSE:
            return TimeSpan(begin, width, *start, values)
        if not most < DIVERGED:
            return None
        if newton is None or most > QUICK * before:
            slopes = _slopes(function, (times, states, references), values.rates, sizes)
            if slopes is None:
                return None
            newton = NewtonStep(slopes, paths, places)
        before = most
        states = states + newton.step(residual)
    return None


def _slopes(
    function: Function,
    at: tuple[Array, Array, Mapping[str, Array]],
    rates: Array,
    sizes: Array,
) -> Array | None:
    """Derivatives (n, n, NODES) of the rates (n, NODES) by the states at the nodes."""
    times, states, references = at
    count, nodes = states.shape
    moved = np.repeat(states[:, None], count, axis=1)
    for k in range(count):
        moved[k, k] += NUDGE * sizes[k]
    many = {
        name: np.tile(values, (*[1] * (values.ndim - 1), count))
        for name, values in references.items()
    }
    values = function(np.tile(times, count), moved.reshape(count, -1), many)
    if values is None:
        return None
    changed = values.rates.reshape(count, count, nodes) - rates[:, None]
    return np.asarray(changed / (NUDGE * sizes[None, :, None]))


class NewtonStep:
    """What Newton's method changes states by, of which some are places with known speeds.

    With a places, w all other states, of which the first are speeds v, P integrals and A, W the
    derivatives of the rates of w by a and w,

        da = missed_a + P dv,    (1 - P W - P A P) dw = missed_w + P A missed_a

    where P A P acts on v alone: half the size costs an eighth of the time.
    """

    def __init__(self, slopes: Array, paths: Array, places: int) -> None:
        """slopes : (n, n, NODES).  paths : integrals (NODES, NODES).  places : as of
        `solved_span`.
        """
        self._paths, self._places = paths, places
        self._by_place = slopes[places:, :places]
        matrix = np.einsum("kl,ijl->ikjl", paths, slopes[places:, places:])
        inner = self._by_place[..., None] * paths  # (w, a, NODES, NODES)
        matrix[:, :, :places] += np.einsum("kl,ijlm->ikjm", paths, inner, optimize=True)
        size = (len(slopes) - places) * NODES
        try:
            self._inverse = np.linalg.inv(np.eye(size) - matrix.reshape(size, size))
        except np.linalg.LinAlgError:
            self._inverse = np.full((size, size), np.nan)

    def step(self, residual: Array) -> Array:
        """Change (n, NODES) of states whose integrals miss them by so much (n, NODES)."""
        of_places, others = residual[: self._places], residual[self._places :]
        right = others + np.einsum("ijl,jl->il", self._by_place, of_places) @ self._paths.T
        changes = (self._inverse @ right.ravel()).reshape(others.shape)
        return np.concatenate([of_places + changes[: self._places] @ self._paths.T, changes])


def unresolved(span: TimeSpan, sizes: Array, works: Array) -> float:
    """Size of the last coefficients of a span over what states, and quadratures, are at most.

    sizes : (n,).  works : (Q,).
    """
    values, width = span.values, span.width
    parts = [roughness(values.rates) / sizes, roughness(values.quadratures) / works]
    return width * float(max(np.max(part, initial=0.0) for part in parts))
