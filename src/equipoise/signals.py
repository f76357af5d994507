"""Periodic signals: their figures over a cycle, and their harmonics.

Convention: y(theta) = Re sum Y_n exp(i n theta), so that a_n = Re Y_n multiplies cos n theta and
b_n = -Im Y_n multiplies sin n theta; Y_0 is the mean.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property, partial
from math import pi, sqrt
from typing import Any

import numpy as np

from equipoise.displays import Brief
from equipoise.errors import UsageError

__all__ = ["Figures", "Periodic", "harmonics"]


def __dir__() -> list[str]:
    return __all__


Array = np.ndarray[Any, Any]

LEAST_SAMPLES, SAMPLES_PER_ORDER, NEWTON_ROUNDS = 720, 8, 4
"""Samples in a turn among which the highest is looked for; steps from there to the top."""
AT_ONCE = 2**22
"""Products of an order and an angle that are held at a time: 64 MiB."""
EQUAL, ROUNDING = 1e-9, 1e-12
"""Share of a signal's range within which tops are equal, and of its size that is rounding."""
GAUSS_POINTS, LONGEST_PANEL = 16, pi / 4
"""Of a panel between jumps, which is as many steps of the grid long at most: so the sampling has
about twice as many crank angles as the grid, and polynomials of degree 31 are integrated exactly.
rad: longer ones miss a quick return's work by 1e-6 of it where the grid is coarse."""
BESIDE = 2e-8
"""rad in a cycle of one turn: how far before and behind a jump its sides are taken.  Loads and
motion laws count up to 1e-9 of a cycle before a jump as behind it."""
STEPS_BETWEEN_BENDS = 4
"""Of the grid: rows of a table that lie closer, on the average, bend too little to be seen, and
each would cost 16 crank angles."""
MOST_ORDERS, ORDERS_AT_ONCE = 5000, 64
"""Of a signal that jumps; each takes a product with all samples."""
BESIDE_TOP = 4
"""Samples on each side of a local top that a polynomial goes through."""
STEPS = np.arange(-BESIDE_TOP, BESIDE_TOP + 1)
TO_POWERS = np.linalg.inv(np.vander(STEPS, increasing=True)).T
FIRST = np.arange(1, len(STEPS))
SECOND, SIXTH = (np.diff(np.eye(len(STEPS)), order, axis=0).T for order in (2, 6))
"""Matrices by which values (9,) give the powers of their polynomial, and their differences."""
ROUGH = 0.5
"""Largest sixth difference of these, over the largest second one, that a smooth curve has.  Order n
at N samples in a turn has (2 pi n / N)^4; a kink or a jump has 3 and more, wherever it lies."""
NEWTON_STEPS = 3
"""From a parabola's top to that of a polynomial."""
DENSE, TAIL, CLOSE = 33, 1e-7, 1e-2
"""Places in a panel among which its top is looked for; share of its last three Legendre
coefficients in the largest, up to which the signal is smooth in it; share of a signal's range
below the highest such place, up to which a panel may have the top."""


def highest_at(values: Array, smooth: bool = True) -> Array:
    """Index (...) of the highest of values (..., N); of equal ones the first.

    All that tells where a signal is largest or smallest asks here, so that rounding, which differs
    from processor to processor, does not decide between equal extremes.

    smooth : the values are samples of a curve, of which only local tops count; else any values.
    """
    values = np.asarray(values, dtype=float)
    with np.errstate(invalid="ignore"):
        high, low = (f(values, axis=-1, keepdims=True) for f in (np.max, np.min))
        low = np.where(np.isfinite(low), low, high)
        rounding = ROUNDING * np.maximum(np.abs(high), np.abs(low))
        near = values >= high - np.maximum(EQUAL * (high - low), rounding)
        if smooth:  # of the few that are near, those that no neighbour exceeds
            where = np.nonzero(near)
            k, count = where[-1], values.shape[-1]
            row, one = where[:-1], values[where]
            before = np.where(k > 0, values[(*row, k - 1)], -np.inf)
            after = np.where(k < count - 1, values[(*row, (k + 1) % count)], -np.inf)
            least, steady = rounding[..., 0][row], (high - low <= rounding)[..., 0][row]
            near[where] = (one >= np.maximum(before, after) - least) | steady
    found: Array = np.where(near.any(axis=-1), near.argmax(axis=-1), values.argmax(axis=-1))
    return found


def within_period(angle: Array, period: float) -> Array:
    """Angles from 0 to less than the period; what is short of the period by rounding is 0."""
    inside = np.mod(angle, period)
    return np.where(inside > period * (1 - ROUNDING), 0.0, inside)


@dataclass(frozen=True)
class Figures:
    """Figures of a signal over the crank angles at which it was taken, in its own unit.

    max_at, min_at, peak_at : crank angles, rad; peak is the largest absolute value.
    """

    mean: float
    rms: float
    peak: float
    peak_at: float
    max: float
    max_at: float
    min: float
    min_at: float

    @property
    def peak_to_peak(self) -> float:
        """Largest minus smallest value."""
        return self.max - self.min

    @property
    def signed_peak(self) -> float:
        """The value whose absolute value is the peak, with its sign."""
        at_max = abs(self.peak_at - self.max_at) <= abs(self.peak_at - self.min_at)
        return self.max if at_max else self.min


def figures(crank_angle: Array, samples: Array, period: float | None = None) -> Figures:
    """Mean, RMS and extremes of samples (N,), as `figures_of_each` takes them."""
    return figures_of_each(crank_angle, samples[None], period)[0]


def mean(samples: Array, shares: Array | None = None) -> Array:
    """Mean (...) of samples (..., N) by their shares (N,); equal ones if None."""
    return np.asarray(np.mean(samples, axis=-1) if shares is None else samples @ shares)


def figures_of_each(
    crank_angle: Array, samples: Array, period: float | None = None
) -> list[Figures]:
    """Figures of several signals (M, N) at crank angles (N,), rad, at once, which takes little
    longer than of one.

    period : rad, in which the crank angles are equally spaced from 0; then extremes are those of
        the curves through the samples (`smooth_tops`), else the largest and smallest samples.
    """
    tops = partial(sampled_tops, crank_angle) if period is None else partial(smooth_tops, period)
    return _figures_of_each(samples, tops)


Tops = tuple[Array, Array]
"""Highest value (M,) of each of several signals, and the crank angle (M,), rad, where it is."""


def _figures_of_each(
    samples: Array, tops: Callable[[Array], Tops], shares: Array | None = None
) -> list[Figures]:
    values, at = tops(np.concatenate([samples, -samples]))
    (high, deep), (high_at, deep_at) = values.reshape(2, -1), at.reshape(2, -1)
    average, rms = mean(samples, shares), np.sqrt(mean(np.square(samples), shares))
    peak, peak_at = np.maximum(high, deep), place_of_peak(high, high_at, deep, deep_at)
    rows = (average, rms, peak, peak_at, high, high_at, -deep, deep_at)
    return [Figures(*one) for one in np.array(rows).T.tolist()]


def place_of_peak(high: Array, high_at: Array, deep: Array, deep_at: Array) -> Array:
    """Crank angle of the larger of a highest value and of `deep`, the negative of a lowest one; of
    equal ones the first.
    """
    with np.errstate(invalid="ignore"):
        equal = np.abs(high - deep) <= EQUAL * (high + deep)
    return np.where(equal, np.minimum(high_at, deep_at), np.where(high >= deep, high_at, deep_at))


def sampled_tops(crank_angle: Array, values: Array) -> Tops:
    """Highest of values (M, N) taken at crank angles (N,), rad, and of nothing between them."""
    return np.max(values, axis=-1), crank_angle[highest_at(values)]


def smooth_tops(period: float, values: Array) -> Tops:
    """Highest values of curves through values (M, N), equally spaced from 0 over a period, rad.

    At a local top the curve is the polynomial through the 9 nearest values, or the root of that
    through their squares, as the size of a vector near zero is; the smoother of the two.  Order n
    is told to 1.4e-3 (2 pi n / N)^9 of its amplitude, at N = 360 angles in a turn to 2e-13 for
    n = 5 and 1e-7 for n = 20.  Where neither is smooth, as at a kink or a jump, it is the highest
    value, so that nothing is told that the signal does not reach.  Of equal tops the first counts.
    """
    count = values.shape[-1]
    grid = np.arange(count) * (period / count)
    if count <= 2 * BESIDE_TOP:
        return sampled_tops(grid, values)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        high, low = np.max(values, axis=-1), np.min(values, axis=-1)
        rounding = ROUNDING * np.maximum(np.abs(high), np.abs(low))
        slack = np.maximum(EQUAL * (high - low), rounding)
        row, k, rises = _local_tops(values, high - slack, rounding)
        top, move = values[row, k], np.zeros(len(k))
        near = values[row[rises, None], (k[rises, None] + STEPS) % count]
        found, way = _smoothest(_tops_of_stencils, near)
        higher = found > top[rises] + rounding[row[rises]]
        rises[rises] = higher
        top[rises], move[rises] = found[higher], way[higher]
        best = np.array(high)
        np.maximum.at(best, row, top)
        first = np.flatnonzero(top >= (best - slack)[row])
    own, begin = np.unique(row[first], return_index=True)
    chosen = first[begin]
    at = np.full(len(values), np.nan)
    at[own] = within_period(grid[k[chosen]] + move[chosen] * grid[1], period)
    others = np.isnan(at)  # signals that are not finite everywhere
    if np.any(others):
        at[others] = grid[highest_at(values[others])]
    return best, at


def _local_tops(values: Array, enough: Array, rounding: Array) -> tuple[Array, Array, Array]:
    """Signals and places (K,), in order, of samples that none beside them exceeds and near which a
    curve, even one with a kink, may come up to what is `enough` (M,); and whether it rises above
    the sample.
    """
    up = np.diff(values, axis=-1, append=values[:, :1])
    no_further = up <= rounding[:, None]
    from_below = up >= -rounding[:, None]
    no_further[:, 1:] &= from_below[:, :-1]
    no_further[:, 0] &= from_below[:, -1]
    row, k = np.nonzero(no_further)
    rise = np.abs(up[row, k - 1] + up[row, k]) / 2
    near = values[row, k] + rise >= enough[row]
    row, k, rise = row[near], k[near], rise[near]
    return row, k, rise > rounding[row]


def _smoothest(find: Callable[[Array], tuple[Array, Array, Array]], values: Array) -> Tops:
    """Tops (...) of curves through values (..., n), and their places; of values below zero through
    their squares where these are smoother.

    find : of values top, place and roughness (...); where this is above 1, of a value.
    """
    top, place, rough = find(values)
    below = np.max(values, axis=-1) <= 0
    if np.any(below):
        squared, other, roughness = find(-np.square(values[below]))
        better = roughness < np.fmin(rough[below], 1.0)
        below[below] = better
        top[below], place[below] = -np.sqrt(np.maximum(-squared[better], 0.0)), other[better]
    return top, place


def _tops_of_stencils(values: Array) -> tuple[Array, Array, Array]:
    """Top (K,) of the polynomial through values (K, 9) and how many steps it is beside the middle;
    and how rough they are: above 1 the middle stands.
    """
    middle = values[:, BESIDE_TOP]
    about = values - middle[:, None]
    sixth, second = (np.max(np.abs(about @ one), axis=1) for one in (SIXTH, SECOND))
    powers = about @ TO_POWERS
    slope, bend = powers[:, 1:] * FIRST, powers[:, 2:] * FIRST[:-1] * FIRST[1:]
    move = -slope[:, 0] / bend[:, 0]
    for _ in range(NEWTON_STEPS):
        move = np.clip(move, -1.0, 1.0)
        each = np.vander(move, len(STEPS), increasing=True)
        move = move - _dot(slope, each[:, :-1]) / _dot(bend, each[:, :-2])
    move = np.clip(move, -1.0, 1.0)
    gain = _dot(powers, np.vander(move, len(STEPS), increasing=True))
    rough = sixth / (ROUGH * second)
    higher = (rough <= 1) & (gain > 0)
    return middle + np.where(higher, gain, 0.0), np.where(higher, move, 0.0), rough


def stencils_above(values: Array, least: float) -> tuple[Array, Array]:
    """Tops above a value of a curve through values (N,), equally spaced round a period: places
    (K, n) of values and their weights (K, n), of which the products add up to each top.
    """
    k = np.flatnonzero((values >= np.roll(values, 1)) & (values > np.roll(values, -1)))
    if len(values) < len(STEPS):
        k = k[values[k] > least]
        return k[:, None], np.ones((len(k), 1))
    near = (k[:, None] + STEPS) % len(values)
    with np.errstate(invalid="ignore", divide="ignore"):
        top, move, _ = _tops_of_stencils(values[near])
    above = top > least
    return near[above], np.vander(move[above], len(STEPS), increasing=True) @ TO_POWERS.T


def _dot(rows: Array, others: Array) -> Array:
    """Product (K,) of each row (K, n) with its other one."""
    return np.asarray(np.einsum("kn,kn->k", rows, others))


@dataclass(frozen=True, eq=False)
class JumpSampling:
    """Crank angles at which signals are taken that jump at known ones, over a whole cycle.

    A grid, both sides of every jump, and Gauss points between jumps, all rising.  Means are taken
    over the Gauss points, so that each piece is integrated by itself; extremes over the others.

    crank_angle : (N,) rad, at which values are taken.
    shares : (N,) of each value in a mean, with sum 1.
    at : (N,) rad, where values are said to be: both sides of a jump at the jump.
    turns : of the crank in the cycle.
    orders : amplitudes that are taken, beside the mean: as many as the grid tells apart.
    edges : (P + 1,) rad, ends of the panels between which Gauss points lie.
    """

    crank_angle: Array
    shares: Array
    at: Array
    turns: int
    orders: int
    edges: Array

    @classmethod
    def of(
        cls, grid: Array, turns: int, jumps: Array, bends: Array | tuple[()] = ()
    ) -> JumpSampling:
        """For a grid (N,) of equally spaced crank angles from 0 over a cycle, jumps (J,) in it, and
        angles (B,) at which only slopes jump, rad; so many of these as the grid can tell apart.
        """
        period, beside = 2 * pi * turns, BESIDE * turns
        if len(bends) * STEPS_BETWEEN_BENDS > len(grid):
            bends = ()
        jump_ends = _ends_of_pieces(jumps, period, 4 * beside)
        ends = _ends_of_pieces(np.concatenate([jumps, bends]), period, 4 * beside)
        longest = min(GAUSS_POINTS * period / len(grid), LONGEST_PANEL)
        counts = np.ceil(np.diff(ends) / longest * (1 - ROUNDING))
        panels = [
            np.linspace(begin, end, max(int(count), 1) + 1)
            for begin, end, count in zip(ends[:-1], ends[1:], counts, strict=True)
        ]
        begins = np.concatenate([panel[:-1] for panel in panels])
        widths = np.concatenate([np.diff(panel) for panel in panels])
        nodes, weights = np.polynomial.legendre.leggauss(GAUSS_POINTS)
        inside = (begins[:, None] + widths[:, None] * (1 + nodes) / 2).ravel()
        shares = (widths[:, None] * weights / (2 * period)).ravel()
        at_zero = np.any(within_period(jumps, period) < beside)
        sudden = jump_ends[:-1] if at_zero else jump_ends[1:-1]
        before = sudden - beside + period * (sudden < beside)
        theta = np.concatenate([grid, before, sudden + beside, inside])
        at = np.concatenate([grid, sudden, sudden, inside])
        whole = np.concatenate([np.zeros(len(theta) - len(inside)), shares])
        order = np.argsort(theta, kind="stable")
        orders = min((len(grid) - 1) // 2, MOST_ORDERS)
        edges = np.append(begins, period)
        return cls(theta[order], whole[order], at[order], turns, orders, edges)

    @cached_property
    def shown(self) -> Array:
        """Places (M,) of the grid and of both sides of jumps: what is drawn, and has extremes."""
        return np.flatnonzero(self.shares == 0.0)

    @cached_property
    def grid(self) -> Array:
        """Places (N,) of the equally spaced crank angles."""
        return np.flatnonzero((self.shares == 0.0) & (self.at == self.crank_angle))

    @cached_property
    def inside(self) -> Array:
        """Places (16 P,) of the Gauss points between jumps, over which means are taken."""
        return np.flatnonzero(self.shares)

    def figures_of_each(self, samples: Array) -> list[Figures]:
        """Mean, RMS and extremes of each of several signals (M, N)."""
        return _figures_of_each(samples, self.tops, self.shares)

    def stencils_above(self, values: Array, least: float) -> tuple[Array, Array]:
        """Tops above a value of a signal (N,), as `stencils_above`."""
        legendre, _, to_series, _, _ = _panel()
        with np.errstate(invalid="ignore", divide="ignore"):
            top, x, rough = _tops_of_panels(values[self.inside].reshape(-1, GAUSS_POINTS))
        some = (top > least) & (rough <= 1)
        between = legendre.legvander(x[some], GAUSS_POINTS - 1) @ to_series.T
        alone = np.zeros((len(values), GAUSS_POINTS))
        alone[:, 0] = 1.0
        k = self.shown[values[self.shown] > least]
        places = np.vstack(
            [np.repeat(k[:, None], GAUSS_POINTS, 1), self.inside.reshape(-1, GAUSS_POINTS)[some]]
        )
        return places, np.vstack([alone[: len(k)], between])

    def tops(self, values: Array) -> Tops:
        """Highest values of signals (M, N): of the grid, of both sides of jumps, and of the
        polynomial through the Gauss points of each panel, its ends too, where it is smooth.

        Of equal tops the first counts.
        """
        shown, inside = values[:, self.shown], values[:, self.inside]
        top, x = tops_of_panels(inside.reshape(len(values), -1, GAUSS_POINTS))
        middle, half = (self.edges[1:] + self.edges[:-1]) / 2, np.diff(self.edges) / 2
        sampled, sampled_at = sampled_tops(self.at[self.shown], shown)
        every = np.column_stack([sampled, top])
        at = within_period(np.column_stack([sampled_at, middle + half * x]), 2 * pi * self.turns)
        best = np.max(every, axis=1)
        with np.errstate(invalid="ignore"):
            span = best - np.min(shown, axis=1)
            slack = np.maximum(EQUAL * span, ROUNDING * np.abs(best))
            equal = every >= (best - slack)[:, None]
        return best, np.min(np.where(equal, at, np.inf), axis=1)

    def periodic(self, samples: Array) -> Periodic:
        """Samples (..., N) by order."""
        weighted = samples * self.shares
        found = np.empty((*samples.shape[:-1], self.orders + 1), complex)
        theta = -1j / self.turns * self.crank_angle
        waves = np.exp(np.outer(theta, np.arange(min(ORDERS_AT_ONCE, self.orders + 1))))
        for begin in range(0, self.orders + 1, ORDERS_AT_ONCE):
            some = (weighted * np.exp(begin * theta)) @ waves  # of order begin, and those after it
            found[..., begin : begin + some.shape[-1]] = some[..., : self.orders + 1 - begin]
        found[..., 1:] *= 2
        return Periodic(found, self.turns)


def tops_of_panels(values: Array) -> Tops:
    """Highest value (...), and where it is from -1 to 1, of the smooth curves through values
    (..., 16) at the Gauss points of panels, their ends too; of the values where none is smooth.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        return _smoothest(_tops_of_panels, values)


def _tops_of_panels(values: Array) -> tuple[Array, Array, Array]:
    legendre, nodes, to_series, places, dense = _panel()
    series = values @ to_series
    sizes = np.abs(series)
    rounding = ROUNDING * np.max(sizes, axis=-1)
    tail, whole = np.max(sizes[..., -3:], axis=-1), np.max(sizes[..., 1:], axis=-1)
    rough = np.where(tail <= rounding, 0.0, tail / (TAIL * whole))
    curves = series @ dense
    k, raw = np.argmax(curves, axis=-1), np.argmax(values, axis=-1)
    top, x = np.max(curves, axis=-1), places[k]
    high = np.max(top, axis=-1, keepdims=True)
    span = high - np.min(curves, axis=(-2, -1))[..., None]
    some = np.nonzero((top >= high - CLOSE * span) & (rough <= 1))
    around = places[np.maximum(k[some] - 1, 0)], places[np.minimum(k[some] + 1, DENSE - 1)]
    powers, at = series[some].T, x[some]
    slope, bend = legendre.legder(powers), legendre.legder(powers, 2)
    for _ in range(NEWTON_STEPS):
        down, curve = (legendre.legval(at, one, False) for one in (slope, bend))
        at = np.clip(at - np.where(curve < 0, down / curve, 0.0), *around)
    found = legendre.legval(at, powers, False)
    higher = found > top[some] + rounding[some]
    x[some], top[some] = np.where(higher, (at, found), (x[some], top[some]))
    rugged = ~(rough <= 1)
    top[rugged], x[rugged] = np.max(values, axis=-1)[rugged], nodes[raw[rugged]]
    return top, x, rough


@cache
def _panel() -> tuple[Any, Array, Array, Array, Array]:
    """NumPy's Legendre series; the Gauss points of a panel, the matrix from values there to their
    series, places with both ends among which tops are looked for, and that from a series to values
    there.
    """
    legendre, most = np.polynomial.legendre, GAUSS_POINTS - 1
    nodes, weights = legendre.leggauss(GAUSS_POINTS)
    to_series = legendre.legvander(nodes, most) * np.outer(weights, np.arange(most + 1) + 0.5)
    places = -np.cos(pi * np.arange(DENSE) / (DENSE - 1))
    return legendre, nodes, to_series, places, legendre.legvander(places, most).T


def _ends_of_pieces(angles: Array, period: float, least: float) -> Array:
    """0, angles and the period, rising, without those that come closer behind another than the
    least distance.
    """
    ends = np.unique(np.concatenate([[0.0], within_period(angles, period), [period]]))
    return np.delete(ends, 1 + np.flatnonzero(np.diff(ends[:-1]) < least))


def harmonics(samples: Array, orders: int | None = None) -> Array:
    """Complex amplitudes Y_0 ... Y_orders of one period of equally spaced samples (..., N).

    orders : highest order; N // 2 if None.  At N / 2 the samples tell only a cosine.
    """
    samples = np.asarray(samples, dtype=float)
    count = samples.shape[-1]
    amplitudes = np.fft.rfft(samples, axis=-1) / count
    amplitudes[..., 1 : (count + 1) // 2] *= 2
    wanted: Array = amplitudes if orders is None else amplitudes[..., : orders + 1]
    return wanted


def synthesis(amplitudes: Array, theta: Array) -> Array:
    """Values at angles theta (M,), rad, of complex amplitudes Y_0 ... Y_n; shape (..., M)."""
    orders, theta = np.arange(amplitudes.shape[-1]), np.asarray(theta)
    step = max(1, AT_ONCE // len(orders))
    parts = [
        (amplitudes @ np.exp(1j * np.outer(orders, theta[k : k + step]))).real
        for k in range(0, max(len(theta), 1), step)
    ]
    return parts[0] if len(parts) == 1 else np.concatenate(parts, axis=-1)


def _folded_samples(amplitudes: Array, count: int) -> Array:
    """Values (..., count), equally spaced over a period, of more orders than they tell apart.

    At such angles order n is the same as n less any multiple of the count.
    """
    orders = amplitudes.shape[-1]
    rounds = -(-orders // count)
    missing = [(0, 0)] * (amplitudes.ndim - 1) + [(0, rounds * count - orders)]
    padded = np.pad(amplitudes, missing).reshape(*amplitudes.shape[:-1], rounds, count)
    values: Array = np.fft.ifft(padded.sum(axis=-2), axis=-1).real * count
    return values


@dataclass(frozen=True, eq=False, repr=False)
class Periodic(Brief):
    """A periodic signal of the crank angle by its orders; one, or an array of them.

    amplitudes : complex (..., K + 1), Y_0 ... Y_K; Y_k belongs to order k / turns.
    turns : of the crank in one period.
    """

    amplitudes: Array
    turns: int = 1

    @classmethod
    def of(cls, samples: Array, turns: int = 1, scale: float = 1e-14) -> Periodic:
        """From samples (..., N), equally spaced from 0 over one period.

        Orders above the last that exceeds `scale` times the largest are rounding, and left out; so
        is order N / 2, whose phase N samples cannot tell.
        """
        found = harmonics(samples, (np.shape(samples)[-1] - 1) // 2)
        sizes = np.max(np.abs(found), axis=tuple(range(found.ndim - 1)), initial=0.0)
        above = np.flatnonzero(sizes > scale * np.max(sizes))
        return cls(found[..., : (int(above[-1]) if above.size else 0) + 1], turns)

    @property
    def orders(self) -> Array:
        """Order of each amplitude: events in one turn of the crank."""
        return np.arange(self.amplitudes.shape[-1]) / self.turns

    def count_to(self, order: int) -> int:
        """How many amplitudes there are up to an order, the mean included."""
        return int(min(order * self.turns + 1, self.amplitudes.shape[-1]))

    def upto(self, order: int) -> Periodic:
        """The signal without its orders above this one."""
        return Periodic(self.amplitudes[..., : self.count_to(order)], self.turns)

    @property
    def period(self) -> float:
        """Crank angle of one period, rad."""
        return 2 * pi * self.turns

    def values(self, theta: Array) -> Array:
        """Values (..., M) at crank angles (M,), rad."""
        return synthesis(self.amplitudes, np.asarray(theta) / self.turns)

    def samples(self, count: int) -> Array:
        """Values (..., count), equally spaced from 0 over one period."""
        half = self.amplitudes / 2
        half[..., 0] *= 2
        most = (count - 1) // 2
        if half.shape[-1] > most + 1:  # more orders than the samples can hold apart
            return _folded_samples(self.amplitudes, count)
        return np.fft.irfft(half, count, axis=-1) * count

    def shifted(self, phase: float) -> Periodic:
        """The signal y(theta + phase), which is ahead by the phase, rad."""
        return Periodic(self.amplitudes * np.exp(1j * self.orders * phase), self.turns)

    def derivative(self, times: int = 1) -> Periodic:
        """Derivative by crank angle, of which negative `times` integrate (and leave no mean)."""
        factor = np.ones(len(self.orders), complex)
        factor[1:] = (1j * self.orders[1:]) ** times
        factor[0] = 1.0 if times == 0 else 0.0
        return Periodic(self.amplitudes * factor, self.turns)

    def __add__(self, other: Periodic) -> Periodic:
        if self.turns != other.turns:
            raise UsageError(f"signals of {self.turns} and {other.turns} turns cannot be added")
        count = max(self.amplitudes.shape[-1], other.amplitudes.shape[-1])
        return Periodic(self._padded(count) + other._padded(count), self.turns)

    def __mul__(self, factor: float) -> Periodic:
        return Periodic(self.amplitudes * factor, self.turns)

    __rmul__ = __mul__

    def __neg__(self) -> Periodic:
        return self * -1.0

    def __sub__(self, other: Periodic) -> Periodic:
        return self + -other

    def _padded(self, count: int) -> Array:
        missing = count - self.amplitudes.shape[-1]
        widths = [(0, 0)] * (self.amplitudes.ndim - 1) + [(0, missing)]
        return np.pad(self.amplitudes, widths)

    @property
    def sizes(self) -> Array:
        """Amplitude R_n of each order, (..., K + 1)."""
        return np.abs(self.amplitudes)

    @property
    def phases(self) -> Array:
        """Phase of each order as a sine, rad: y = sum R_n sin(n theta + phase_n)."""
        return np.angle(1j * self.amplitudes)

    @property
    def mean(self) -> Array:
        """Mean value, (...)."""
        return self.amplitudes[..., 0].real

    @property
    def rms_by_order(self) -> Array:
        """RMS of each order, (..., K + 1)."""
        sizes = self.sizes.copy()
        sizes[..., 1:] /= sqrt(2)
        return sizes

    @property
    def rms(self) -> Array:
        """RMS of the whole signal with its mean, (...)."""
        total: Array = np.sqrt(np.sum(self.rms_by_order**2, axis=-1))
        return total

    @property
    def vibration_rms(self) -> Array:
        """RMS about the mean, (...)."""
        about_mean: Array = np.sqrt(np.sum(self.rms_by_order[..., 1:] ** 2, axis=-1))
        return about_mean

    @property
    def peak_to_peak(self) -> Array:
        """Largest minus smallest value, (...), not only at samples."""
        return self.extreme(1)[0] - self.extreme(-1)[0]

    @property
    def figures(self) -> Figures:
        """Figures of one signal, whose extremes may lie between samples."""
        (high, high_at), (low, low_at) = self.extreme(1), self.extreme(-1)
        peak, peak_at = np.maximum(high, -low), place_of_peak(high, high_at, -low, low_at)
        rows = (self.mean, self.rms, peak, peak_at, high, high_at, low, low_at)
        return Figures(*map(float, rows))

    def extreme(self, sign: int) -> tuple[Array, Array]:
        """Largest (sign 1) or smallest (-1) value (...) and its crank angle (...), rad.

        The highest of many samples, followed to its top by Newton's method.
        """
        count = max(LEAST_SAMPLES * self.turns, SAMPLES_PER_ORDER * self.amplitudes.shape[-1])
        values = sign * self.samples(count)
        best = highest_at(values)
        step = self.period / count
        at = best * step
        slope, curvature = self.derivative(), self.derivative(2)
        move: Array = np.zeros_like(at)
        for _ in range(NEWTON_ROUNDS):
            down, bend = slope._at(at + move), curvature._at(at + move)
            towards = np.divide(-down, bend, out=np.zeros_like(down), where=bend != 0)
            move = np.clip(move + towards, -step, step)
        top = sign * self._at(at + move)
        sampled = np.take_along_axis(values, best[..., None], axis=-1)[..., 0]
        better = top > sampled
        at = within_period(at + better * move, self.period)
        return sign * np.where(better, top, sampled), at

    def _at(self, theta: Array) -> Array:
        """Value of each signal (...) at a crank angle of its own (...)."""
        count = len(self.orders)
        amplitudes, flat = self.amplitudes.reshape(-1, count), np.ravel(theta)
        step = max(1, AT_ONCE // count)
        value = np.empty(len(flat))
        for k in range(0, len(flat), step):
            some = slice(k, k + step)
            turning = np.exp(1j * np.multiply.outer(flat[some], self.orders))
            value[some] = np.sum((amplitudes[some] * turning).real, axis=-1)
        return value.reshape(np.shape(theta))
