"""Functions and motions as Chebyshev's polynomials: at all nodes of a piece, or of a span, at once.

Functions of the crank angle are tabulated.  A motion asks for them again in every turn, while
solving a linkage costs the same at one crank angle and at hundreds.  So it is solved once, at the
nodes of all pieces at once, and pieces are halved until the last coefficients are rounding.

The motion over a span of time,

    y' = f(t, y)

is solved at all nodes by Newton's method with the derivatives of f at each of them, so that what
follows quickly, such as a motor's current, needs no shorter spans than what is slow.  One state
costs NumPy as much as all nodes together do.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping
from dataclasses import field
from functools import cached_property
from math import floor
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from equipoise.dataclass import dataclass
from equipoise.errors import ResponseError
from equipoise.i18n import Note
from equipoise.running.drivers import Driver
from equipoise.signals import Array

NODES = 16
"""Of a piece: with Chebyshev's nodes, which lie inside of it, so that a jump at its end is none."""
FINE = 1e-12
"""Share of a function's largest value below which a coefficient is rounding."""
HALVINGS = 10
"""After which a piece is left as it is; 12 pieces in a turn are a fortieth of a degree wide then,
and what is left is a corner, whose share of an integral is nothing.
"""
MOST_NODES = 200_000
ROUNDING = 1e-12
"""Of a period, within which a crank angle is the end of a piece."""

POINTS = chebyshev.chebpts1(NODES)
TO_CHEBYSHEV = np.linalg.inv(chebyshev.chebvander(POINTS, NODES - 1))
INTEGRAL = chebyshev.chebint(TO_CHEBYSHEV)
"""(NODES + 1, NODES), Chebyshev coefficients of the antiderivative of values at the nodes."""
DERIVATIVE = chebyshev.chebder(np.eye(NODES))
ORDERS = np.arange(NODES + 1)


def polynomials(x: Array | float) -> Array:
    """Chebyshev's polynomials (..., NODES + 1) at places (...) within -1 and 1."""
    return np.cos(np.multiply.outer(np.arccos(np.minimum(np.maximum(x, -1.0), 1.0)), ORDERS))


def integral_to(x: Array | float, begin: float) -> Array:
    """Weights (..., NODES) of the values at the nodes in their integral from `begin` to x, within
    -1 and 1.
    """
    return np.asarray((polynomials(x) - polynomials(begin)) @ INTEGRAL)


def roughness(values: Array) -> Array:
    """Size (...) of the last two Chebyshev coefficients of values (..., NODES) at the nodes."""
    return np.asarray(np.max(np.abs(values @ TO_CHEBYSHEV[-2:].T), axis=-1))


class Tabulated:
    """Functions (C,) of the crank angle that repeat after a period, rad.

    lows, highs : (P,) ends of the pieces, rad.  values : (C, P, NODES) at their nodes.
    coefficients : (P, C, NODES) of Chebyshev's polynomials.

    functions : values (C, N) at crank angles (N,).
    edges : rising from 0 to the period, between which the functions are smooth.
    groups : (C,) of each function, the number of the group whose largest value is its measure of
        rounding; each is measured by itself if None.
    sizes : (C,) of the terms in each function, which may cancel to rounding; 0 if None.
    """

    def __init__(
        self,
        functions: Callable[[Array], Array],
        edges: Array,
        groups: Array | None = None,
        sizes: Array | None = None,
    ) -> None:
        self.period = float(edges[-1])
        lows, highs = edges[:-1], edges[1:]
        pieces: list[tuple[Array, Array, Array]] = []
        scale = np.zeros(1) if sizes is None else sizes
        for left in range(HALVINGS, -1, -1):
            middle, half = (highs + lows) / 2, (highs - lows) / 2
            theta = middle[:, None] + half[:, None] * POINTS
            if theta.size > MOST_NODES:
                raise ResponseError(
                    Note("the load on the crank varies too rapidly within a cycle to be integrated")
                )
            values = functions(theta.ravel()).reshape(-1, *theta.shape)
            scale = np.maximum(scale, np.max(np.abs(values), axis=(1, 2)))
            size = scale
            if groups is not None:
                size = np.array([np.max(scale[groups == number]) for number in groups])
            rough = np.any(roughness(values) > FINE * size[:, None], axis=0) & (left > 0)
            pieces.append((lows[~rough], highs[~rough], values[:, ~rough]))
            if not np.any(rough):
                break
            lows = np.concatenate([lows[rough], middle[rough]])
            highs = np.concatenate([middle[rough], highs[rough]])
        low, high = (np.concatenate([piece[end] for piece in pieces]) for end in (0, 1))
        values = np.concatenate([piece[2] for piece in pieces], axis=1)
        order = np.argsort(low)
        self.lows, self.highs, self.values = low[order], high[order], values[:, order]
        self._starts: list[float] = self.lows.tolist()
        self.coefficients = np.moveaxis(self.values @ TO_CHEBYSHEV.T, 1, 0)

    def piece(self, theta: float, direction: float) -> tuple[int, float]:
        """Number of the piece in which the way goes on from a crank angle, and how many periods
        that angle is ahead of it, as an angle, rad; direction is 1 or -1.
        """
        inside = theta + direction * ROUNDING * self.period
        ahead = self.period * floor(inside / self.period)
        return bisect_right(self._starts, inside - ahead) - 1, ahead

    def within(self, k: int, low: float, high: float) -> tuple[Array, Array]:
        """Values (C, NODES) at the nodes of a part of a piece, between places from -1 to 1 in it,
        and coefficients (NODES,) of the first of them.
        """
        places = (low + high) / 2 + (high - low) / 2 * POINTS
        values = self.coefficients[k] @ polynomials(places)[:, :NODES].T
        return values, TO_CHEBYSHEV @ values[0]

    def at(self, theta: float) -> tuple[Array, Array]:
        """Values and derivatives (C,) at a crank angle."""
        k, ahead = self.piece(theta, 1.0)
        half = (self.highs[k] - self.lows[k]) / 2
        x = (theta - ahead - self.lows[k]) / half - 1
        basis, coefficients = polynomials(x)[:NODES], self.coefficients[k]
        return coefficients @ basis, coefficients @ (DERIVATIVE.T @ basis[:-1]) / half


INTEGRALS = {sense: integral_to(POINTS, -sense) for sense in (1.0, -1.0)}
"""By the sense of the way, (NODES, NODES): integrals from the begin of a part up to each node, of
values (NODES,) there, in a part from -1 to 1."""
ROW_PLACES = {sense: np.append(POINTS[:: int(sense)], sense) for sense in (1.0, -1.0)}
"""By the sense of the way, places (NODES + 1,) from -1 to 1 at which the track has its rows: the
nodes in passing, and the end."""
PASSED = {sense: integral_to(places, -sense) for sense, places in ROW_PLACES.items()}
"""By the sense of the way, (NODES + 1, NODES): integrals from the begin of a part up to each of
`ROW_PLACES`, of values (NODES,) at the nodes."""
AT_ENDS = {end: polynomials(end)[:NODES] for end in (1.0, -1.0)}
"""By the end of a part, 1 or -1, the polynomials (NODES,) there, which the coefficients of its
reduced inertia multiply."""
ELECTRIC = 3
"""Values of a motor's circuit in a row of the track: its current, and two works."""


@dataclass(frozen=True)
class Instant:
    """State of a run: s, rad, rad/s, and the work so far of each source, of the brake where there
    is one, and of the drive, J.

    electric : (3,) current of a direct-current motor, A, and work of its supply and heat so far, J.
    """

    time: float
    angle: float
    speed: float
    work: Array
    electric: Array = field(default_factory=lambda: np.zeros(ELECTRIC))


@dataclass(frozen=True, eq=False)
class TableRange:
    """A piece of the table, or a part of it.

    place : what is the same in every cycle.  ends : crank angles, rad.
    values : (C, NODES) at its nodes.  coefficients : (NODES,) of the reduced inertia.
    """

    place: tuple[float, ...]
    ends: tuple[float, float]
    values: Array
    coefficients: Array

    @property
    def half(self) -> float:
        """Half its width, rad."""
        return (self.ends[1] - self.ends[0]) / 2

    def inertia_at(self, x: Array) -> Array:
        """Reduced inertia (...), kg m2, at places (...) from -1 to 1 in it."""
        return np.asarray(polynomials(x)[..., :NODES] @ self.coefficients)

    def inertia_passed(self, sense: float) -> Array:
        """Reduced inertia (NODES + 1,), kg m2, at the `ROW_PLACES` of a sense."""
        return np.append(self.values[0][:: int(sense)], self.coefficients @ AT_ENDS[sense])


@dataclass(frozen=True, eq=False)
class PieceMotion:
    """The motion in a part of a piece, from its begin in a sense to its end.

    energy : kinetic, at the begin, J.
    rates : (R, NODES) by crank angle at the nodes, of time, of the motor's circuit and of works.
    driver : whose current follows the speed, unless it lags.
    """

    begin: Instant
    part: TableRange
    sense: float
    energy: float
    rates: Array
    driver: Driver

    @cached_property
    def passed(self) -> Array:
        """Rows (NODES + 1, ...) of the track at the `ROW_PLACES` of the sense."""
        sense, part = self.sense, self.part
        rows = self._rows(ROW_PLACES[sense], PASSED[sense], part.inertia_passed(sense))
        rows[-1, 1] = part.ends[sense > 0]
        return rows

    def rows(self, x: Array) -> Array:
        """Rows (N, ...) of the track at places (N,) from -1 to 1."""
        return self._rows(x, integral_to(x, -self.sense), self.part.inertia_at(x))

    def at(self, x: float) -> Instant:
        """The instant at a place from -1 to 1."""
        rows = self.passed[-1:] if x == self.sense else self.rows(np.array([x]))
        return instant_of(rows[0])

    def _rows(self, x: Array, integrals: Array, inertia: Array) -> Array:
        part, begin = self.part, self.begin
        gained = part.half * (integrals @ self.rates.T)
        rows = np.empty((len(x), 2 + gained.shape[1]))
        rows[:, 0] = begin.time + gained[:, 0]
        rows[:, 1] = part.ends[0] + part.half * (x + 1)
        energy = self.energy + gained[:, 1 + ELECTRIC :].sum(axis=1)
        rows[:, 2] = self.sense * np.sqrt(2 * energy / inertia)
        rows[:, 3 : 3 + ELECTRIC] = begin.electric + gained[:, 1 : 1 + ELECTRIC]
        if not self.driver.lags:
            rows[:, 3] = self.driver.current(rows[:, 2])
        rows[:, 3 + ELECTRIC :] = begin.work + gained[:, 1 + ELECTRIC :]
        return rows


def instant_of(row: Array) -> Instant:
    """The instant of a row of the track."""
    time, angle, speed = row[:3].tolist()
    return Instant(time, angle, speed, row[3 + ELECTRIC :], row[3 : 3 + ELECTRIC])


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
