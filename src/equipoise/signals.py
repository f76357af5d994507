"""Periodic signals: their figures over a cycle, and their harmonics.

Convention: y(theta) = Re sum Y_n exp(i n theta), so that a_n = Re Y_n multiplies cos n theta and
b_n = -Im Y_n multiplies sin n theta; Y_0 is the mean.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, cached_property, partial
from math import pi, sqrt
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.displays import Brief
from equipoise.errors import UsageError
from equipoise.i18n import Note

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
JUMP_OFFSET = 2e-8
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
DERIVATIVES = (1, FIRST), (2, FIRST[:-1] * FIRST[1:])
"""First power of a polynomial that has a part in its first and second derivative, and factors."""
SECOND, SIXTH = (np.diff(np.eye(len(STEPS)), order, axis=0).T for order in (2, 6))
"""Matrices by which values (9,) give the powers of their polynomial, and their differences."""
ROUGH = 0.1
"""Largest sixth difference of these, over the largest second one, that a smooth curve has.  Order n
at N samples in a turn has (2 pi n / N)^4; a kink or a jump has 3 and more, wherever it lies."""
NEWTON_STEPS = 3
"""From a parabola's top to that of a polynomial."""
LIFT = 1 / 16
"""Share of a signal's range, or of a panel's, by which a smooth top is above its highest sample at
most: a quarter of this for one order at the roughest that counts as smooth, half of it in a panel.
"""
DENSE, TAIL = 33, 1e-7
"""Places in a panel among which its top is looked for; share of its last three Legendre
coefficients in the largest, up to which the signal is smooth in it."""


def highest_at(values: Array, smooth: bool = True) -> Array:
    """Index (...) of the highest of values (..., N); of equal ones the first.

    Every search for the place of an extreme ends here, so that rounding, which differs from
    processor to processor, does not decide between equal extremes.

    smooth : the values are samples of a curve, of which only local tops count; else any values.
    """
    values = np.asarray(values, dtype=float)
    with np.errstate(invalid="ignore"):
        high, low = (f(values, axis=-1, keepdims=True) for f in (np.max, np.min))
        low = np.where(np.isfinite(low), low, high)
        rounding = ROUNDING * np.maximum(np.abs(high), np.abs(low))
        candidates = values >= high - np.maximum(EQUAL * (high - low), rounding)
        if smooth:  # of the few that are near, those that no neighbour exceeds
            where = np.nonzero(candidates)
            k, count = where[-1], values.shape[-1]
            row, value = where[:-1], values[where]
            before = np.where(k > 0, values[(*row, k - 1)], -np.inf)
            after = np.where(k < count - 1, values[(*row, (k + 1) % count)], -np.inf)
            least, steady = rounding[..., 0][row], (high - low <= rounding)[..., 0][row]
            candidates[where] = (value >= np.maximum(before, after) - least) | steady
    numbers: Array = candidates.argmax(axis=-1)
    chosen = np.take_along_axis(candidates, numbers[..., None], axis=-1)[..., 0]
    return numbers if np.all(chosen) else np.where(chosen, numbers, values.argmax(axis=-1))


def first_below(angle: Array, values: Array, limit: float) -> float | None:
    """The angle at which values fall below a limit for the first time, between two of the angles;
    the first angle of values that are below it from there on; None where none is.

    angle, values : (N,), the angles in order; a number where nothing moves.
    """
    values = np.broadcast_to(values, angle.shape)
    low = values < limit
    falls = np.flatnonzero(low[1:] & ~low[:-1])
    if len(falls):
        k = int(falls[0])
        share = (values[k] - limit) / (values[k] - values[k + 1])
        return float(angle[k] + share * (angle[k + 1] - angle[k]))
    return float(angle[0]) if len(low) and low[0] else None


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

    def is_constant(self, scale: float = 0.0) -> bool:
        """Whether it varies by rounding alone, beside its peak or a scale in its own unit."""
        return self.peak_to_peak <= 1e-10 * max(self.peak, scale)


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
    return _figures_of_each(samples, *tops(np.concatenate([samples, -samples])))


Tops = tuple[Array, Array]
"""Highest value (M,) of each of several signals, and the crank angle (M,), rad, where it is."""


def _figures_of_each(
    samples: Array, values: Array, at: Array, shares: Array | None = None
) -> list[Figures]:
    """From samples (M, N), and the tops (2 M,) of these and of their opposites."""
    (high, depth), (high_at, low_at) = values.reshape(2, -1), at.reshape(2, -1)
    average, rms = mean(samples, shares), np.sqrt(mean(np.square(samples), shares))
    peak_at = place_of_peak(high, -depth, high_at, low_at)
    rows = (average, rms, np.maximum(high, depth), peak_at, high, high_at, -depth, low_at)
    return [Figures(*item) for item in np.array(rows).T.tolist()]


def place_of_peak(high: Array, low: Array, high_at: Array, low_at: Array) -> Array:
    """Crank angles (M,) of the largest absolute value, of equal ones the first, from the largest
    and smallest values (M,) and their crank angles (M,).
    """
    equal = np.abs(high + low) <= EQUAL * (high - low)
    values = np.where(high >= -low, high_at, low_at)
    return np.asarray(np.where(equal, np.minimum(high_at, low_at), values))


def sampled_tops(crank_angle: Array, values: Array) -> Tops:
    """Highest of values (M, N) taken at crank angles (N,), rad, and of nothing between them."""
    return np.max(values, axis=-1), crank_angle[highest_at(values)]


def smooth_tops(period: float, values: Array) -> Tops:
    """Highest values of curves through values (M, N), equally spaced from 0 over a period, rad.

    At a local top the curve is the polynomial through the 9 nearest values, or the root of that
    through their squares, as the size of a vector near zero is; the smoother of the two.  Order n
    is exact to 1.4e-3 (2 pi n / N)^9 of its amplitude, at N = 360 angles in a turn to 2e-13 for
    n = 5 and 1e-7 for n = 20.  Where neither is smooth, as at a kink or a jump, it is the highest
    value, so that no figure exceeds what the signal reaches.  Of equal tops the first counts.
    """
    count = values.shape[-1]
    grid = np.arange(count) * (period / count)
    if count <= 2 * BESIDE_TOP:
        return sampled_tops(grid, values)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        high, low = np.max(values, axis=-1), np.min(values, axis=-1)
        rounding = ROUNDING * np.maximum(np.abs(high), np.abs(low))
        slack = np.maximum(EQUAL * (high - low), rounding)
        row, k, rises = _local_tops(values, high - np.maximum(slack, LIFT * (high - low)), rounding)
        top, move = values[row, k], np.zeros(len(k))
        stencils = values[row[rises, None], (k[rises, None] + STEPS) % count]
        value, offset = _smoothest(_tops_of_stencils, stencils)
        higher = value > top[rises] + rounding[row[rises]]
        rises[rises] = higher
        top[rises], move[rises] = value[higher], offset[higher]
        best = np.array(high)
        np.maximum.at(best, row, top)
        first = np.flatnonzero(top >= (best - slack)[row])
    chosen = first[np.diff(row[first], prepend=-1) > 0]
    at = np.full(len(values), np.nan)
    at[row[chosen]] = within_period(grid[k[chosen]] + move[chosen] * grid[1], period)
    at[(high - low <= rounding) & np.isfinite(high)] = 0.0  # nothing but rounding swings
    others = np.isnan(at)  # signals that are not finite everywhere
    if np.any(others):
        at[others] = grid[highest_at(values[others])]
    return best, at


def _local_tops(values: Array, enough: Array, rounding: Array) -> tuple[Array, Array, Array]:
    """Signals and places (K,), in order, of samples of at least what is `enough` (M,) that no
    neighbour exceeds; and whether they exceed a neighbour by more than rounding.
    """
    count = values.shape[-1]
    falls, rises = np.empty((2, *values.shape), bool)
    np.greater_equal(values[:, :-1], values[:, 1:], out=falls[:, :-1])
    np.greater_equal(values[:, 1:], values[:, :-1], out=rises[:, 1:])
    np.greater_equal(values[:, -1], values[:, 0], out=falls[:, -1])
    np.greater_equal(values[:, 0], values[:, -1], out=rises[:, 0])
    row, k = np.divmod(np.flatnonzero(falls & rises), count)
    value = values[row, k]
    stencils = value >= enough[row]
    row, k, value = row[stencils], k[stencils], value[stencils]
    drop = value - np.minimum(values[row, k - 1], values[row, (k + 1) % count])
    return row, k, drop > rounding[row]


def _smoothest(find: Callable[[Array], tuple[Array, Array, Array]], values: Array) -> Tops:
    """Tops (...) of curves through values (..., n), and their places; of values below zero through
    their squares where these are smoother.

    find : of values top, place and roughness (...); where this is above 1, of a value.
    """
    top, place, rough = find(values)
    below = (np.max(values, axis=-1) <= 0) & (rough > 0)  # smoother than 0 is nothing
    if np.any(below):
        squared, other, roughness = find(-np.square(values[below]))
        better = roughness < np.fmin(rough[below], 1.0)
        below[below] = better
        top[below], place[below] = -np.sqrt(np.maximum(-squared[better], 0.0)), other[better]
    return top, place


def _tops_of_stencils(values: Array) -> tuple[Array, Array, Array]:
    """Top (K,) of the polynomial through values (K, 9) and how many steps it is from the middle;
    and how rough they are: above 1 the middle stands.
    """
    middle = values[:, BESIDE_TOP]
    about = values - middle[:, None]
    sixth, second = (np.max(np.abs(_times(about, each)), axis=1) for each in (SIXTH, SECOND))
    powers = _times(about, TO_POWERS).T
    slope, bend = (derivative[:, None] * powers[k:] for k, derivative in DERIVATIVES)
    move = np.clip(-slope[0] / bend[0], -1.0, 1.0)
    for _ in range(NEWTON_STEPS):
        move = np.clip(move - _polynomial(slope, move) / _polynomial(bend, move), -1.0, 1.0)
    gain = _polynomial(powers, move)
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
    stencils = (k[:, None] + STEPS) % len(values)
    with np.errstate(invalid="ignore", divide="ignore"):
        top, move, _ = _tops_of_stencils(values[stencils])
    above = top > least
    return stencils[above], np.vander(move[above], len(STEPS), increasing=True) @ TO_POWERS.T


def _times(rows: Array, matrix: Array) -> Array:
    """Product (..., m) of rows (..., n) with a matrix (n, m), or with one of each row, row by row:
    each to the same bits whatever others there are, as a product of all rows at once is not.
    """
    return np.asarray(np.matmul(np.ascontiguousarray(rows)[..., None, :], matrix)[..., 0, :])


def _polynomial(powers: Array, x: Array) -> Array:
    """Values (K,) of polynomials, of which each power has a row of factors (n, K), at x (K,)."""
    result = powers[-1]
    for factor in powers[-2::-1]:
        result = result * x + factor
    return np.asarray(result)


@dataclass(frozen=True, eq=False)
class JumpSampling:
    """Crank angles at which signals are taken that jump at known ones, over a whole cycle.

    A grid, both sides of every jump, and Gauss points between jumps, all rising.  Means are taken
    over the Gauss points, so that each piece is integrated by itself; extremes over the others.

    crank_angle : (N,) rad, at which values are taken.
    shares : (N,) of each value in a mean, with sum 1.
    at : (N,) rad, where values are said to be: both sides of a jump at the jump.
    turns : of the crank in the cycle.
    orders : amplitudes that are taken, beside the mean: as many as the grid resolves.
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
        cls,
        grid: Array,
        turns: int,
        jumps: Array,
        bends: Array | tuple[()] = (),
        steps: int = GAUSS_POINTS,
    ) -> JumpSampling:
        """For a grid (N,) of equally spaced crank angles from 0 over a cycle, jumps (J,) in it, and
        angles (B,) at which only slopes jump, rad; so many of these as the grid can resolve.

        steps : of the grid between so many Gauss points.  With as many the highest third of the
            orders is good to 2e-4 of the largest, with half as many each is to 1e-10.
        """
        period, offset = 2 * pi * turns, JUMP_OFFSET * turns
        if len(bends) * STEPS_BETWEEN_BENDS > len(grid):
            bends = ()
        jump_ends = _ends_of_pieces(jumps, period, 4 * offset)
        ends = _ends_of_pieces(np.concatenate([jumps, bends]), period, 4 * offset)
        longest = min(steps * period / len(grid), LONGEST_PANEL)
        pieces = np.diff(ends)
        counts = np.maximum(np.ceil(pieces / longest * (1 - ROUNDING)).astype(int), 1)
        number = np.arange(np.sum(counts)) - np.repeat(np.cumsum(counts) - counts, counts)
        begins = np.repeat(ends[:-1], counts) + number * np.repeat(pieces / counts, counts)
        widths = np.diff(begins, append=period)
        nodes, weights = _gauss_points()
        inside = (begins[:, None] + widths[:, None] * (1 + nodes) / 2).ravel()
        shares = (widths[:, None] * weights / (2 * period)).ravel()
        at_zero = np.any(within_period(jumps, period) < offset)
        sudden = jump_ends[:-1] if at_zero else jump_ends[1:-1]
        before = sudden - offset + period * (sudden < offset)
        theta = np.concatenate([grid, before, sudden + offset, inside])
        at = np.concatenate([grid, sudden, sudden, inside])
        whole = np.concatenate([np.zeros(len(theta) - len(inside)), shares])
        order = np.argsort(theta, kind="stable")
        orders = min((len(grid) - 1) // 2, MOST_ORDERS)
        edges = np.append(begins, period)
        return cls(theta[order], whole[order], at[order], turns, orders, edges)

    @cached_property
    def curve_places(self) -> Array:
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
        return _figures_of_each(samples, *self.tops(samples, (1, -1)), self.shares)

    def stencils_above(self, values: Array, least: float) -> tuple[Array, Array]:
        """Tops above a value of a signal (N,), as `stencils_above`."""
        legendre, _, to_series, _, _ = panel_series()
        with np.errstate(invalid="ignore", divide="ignore"):
            top, x, rough = _tops_of_panels(values[self.inside].reshape(-1, GAUSS_POINTS))
        some = (top > least) & (rough <= 1)
        between = legendre.legvander(x[some], GAUSS_POINTS - 1) @ to_series.T
        alone = np.zeros((len(values), GAUSS_POINTS))
        alone[:, 0] = 1.0
        k = self.curve_places[values[self.curve_places] > least]
        places = np.vstack(
            [np.repeat(k[:, None], GAUSS_POINTS, 1), self.inside.reshape(-1, GAUSS_POINTS)[some]]
        )
        return places, np.vstack([alone[: len(k)], between])

    def tops(self, values: Array, signs: Sequence[int] = (1,)) -> Tops:
        """Highest values of signals (M, N) times each of some signs, one after the other: of the
        grid, of both sides of jumps, and of the polynomial through the Gauss points of each panel,
        its ends too, where it is smooth.  Of equal tops the first counts.
        """
        shown = np.take(values, self.curve_places, axis=-1)
        panels = np.take(values, self.inside, axis=-1).reshape(len(values), -1, GAUSS_POINTS)
        ends = np.max(panels, axis=-1), np.min(panels, axis=-1)
        highest, lowest = np.hstack(
            [ends if sign > 0 else np.negative(ends[::-1]) for sign in signs]
        )
        shown = np.concatenate([sign * shown for sign in signs])
        sampled, at = sampled_tops(self.at[self.curve_places], shown)
        with np.errstate(invalid="ignore"):
            span = np.maximum(sampled, np.max(highest, axis=-1))
            span -= np.minimum(np.min(shown, axis=-1), np.min(lowest, axis=-1))
            slack = np.maximum(EQUAL * span, ROUNDING * np.abs(sampled))
            # a smooth curve, ends too, exceeds Gauss points by a thirtieth of their range at most
            reach = highest + LIFT * (highest - lowest)
            row, k = np.nonzero(reach >= (sampled - slack)[:, None])
            sign, own = np.divmod(row, len(values))
            top, x = tops_of_panels(np.array(signs)[sign, None] * panels[own, k])
            best = np.array(sampled)
            np.maximum.at(best, row, top)
            slack = np.maximum(EQUAL * span, ROUNDING * np.abs(best))
            at = np.where(sampled >= best - slack, at, np.inf)
            begin, end = self.edges[k], self.edges[k + 1]
            angle = within_period((begin + end) / 2 + (end - begin) / 2 * x, 2 * pi * self.turns)
            np.minimum.at(at, row, np.where(top >= (best - slack)[row], angle, np.inf))
        return best, at

    def periodic(self, samples: Array, most: int | None = None) -> Periodic:
        """Samples (..., N) by order, of which those after the first `most` + 1 may be left out."""
        last = self.orders if most is None else min(most, self.orders)
        weighted = samples * self.shares
        values = np.empty((*samples.shape[:-1], last + 1), complex)
        theta = -1j / self.turns * self.crank_angle
        waves = np.exp(np.outer(theta, np.arange(min(ORDERS_AT_ONCE, last + 1))))
        for begin in range(0, last + 1, ORDERS_AT_ONCE):
            some = (weighted * np.exp(begin * theta)) @ waves  # of order begin, and those after it
            values[..., begin : begin + some.shape[-1]] = some[..., : last + 1 - begin]
        values[..., 1:] *= 2
        return Periodic(values, self.turns)

    def amplitude(self, samples: Array, place: int) -> Array:
        """The amplitude (...) of one order of `periodic`, by its place."""
        wave = np.exp(-1j * place / self.turns * self.crank_angle)
        return np.asarray((samples * self.shares) @ wave * (2 if place else 1))


@cache
def _gauss_points() -> tuple[Array, Array]:
    """Nodes from -1 to 1 and weights, which take longer than all else of a sampling."""
    nodes, weights = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    nodes.flags.writeable = weights.flags.writeable = False
    return nodes, weights


def tops_of_panels(values: Array) -> Tops:
    """Highest value (...), and where it is from -1 to 1, of the smooth curves through values
    (..., 16) at the Gauss points of panels, their ends too; of the values where none is smooth.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        return _smoothest(_tops_of_panels, values)


def _tops_of_panels(values: Array) -> tuple[Array, Array, Array]:
    _, nodes, _, places, _ = panel_series()
    to_both, to_taylor, scale, limits = _panel_matrices()
    both = _times(values, to_both)
    sizes, curves = np.abs(both[..., :GAUSS_POINTS]), both[..., GAUSS_POINTS:]
    rounding = ROUNDING * np.max(sizes, axis=-1)
    tail, whole = np.max(sizes[..., -3:], axis=-1), np.max(sizes[..., 1:], axis=-1)
    rough = np.where(tail <= rounding, 0.0, tail / (TAIL * whole))
    k, highest = np.argmax(curves, axis=-1), np.argmax(values, axis=-1)
    top, x = np.max(curves, axis=-1), places[k]
    some = np.nonzero(rough <= 1)
    near = k[some]
    value, move = _tops_of_taylor(_times(values[some], to_taylor[near]), *limits[near].T)
    higher = value > top[some] + rounding[some]
    moved = x[some] + move * scale[near]
    x[some], top[some] = np.where(higher, (moved, value), (x[some], top[some]))
    kinked = ~(rough <= 1)
    top[kinked], x[kinked] = np.max(values, axis=-1)[kinked], nodes[highest[kinked]]
    return top, x, rough


def _tops_of_taylor(powers: Array, low: Array, high: Array) -> Tops:
    """Tops (K,) of polynomials by their powers (K, 16), and where between limits, from 0 on."""
    slope = powers[:, 1:] * np.arange(1, GAUSS_POINTS)
    bend = slope[:, 1:] * np.arange(1, GAUSS_POINTS - 1)
    at, down, curve, waves = np.zeros(len(powers)), slope[:, 0], bend[:, 0], np.ones_like(powers)
    for step in range(NEWTON_STEPS):
        if step:
            down = np.sum(slope * waves[:, :-1], axis=1)
            curve = np.sum(bend * waves[:, :-2], axis=1)
        at = np.clip(at - np.where(curve < 0, down / curve, 0.0), low, high)
        waves[:, 1:] = at[:, None]
        np.multiply.accumulate(waves, axis=1, out=waves)
    return np.sum(powers * waves, axis=1), at


@cache
def _panel_matrices() -> tuple[Array, Array, Array, Array]:
    """What values (16,) at the Gauss points of a panel are multiplied by.

    to_both : (16, 49), by which they give their Legendre series, and values at 33 places.
    to_taylor : (33, 16, 16), by which they give their powers about each place, of what is
        scaled (33,) by the distance to the farther of its neighbours.
    limits : (33, 2), where these neighbours are, so scaled.
    """
    legendre, _, to_series, places, dense = panel_series()
    apart = np.diff(places, prepend=places[0], append=places[-1])
    scale = np.maximum(apart[:-1], apart[1:])
    to_taylor = np.empty((DENSE, GAUSS_POINTS, GAUSS_POINTS))
    derivative, factor = to_series.T, np.ones(DENSE)
    for power in range(GAUSS_POINTS):
        to_taylor[..., power] = (legendre.legval(places, derivative) * factor).T
        derivative, factor = legendre.legder(derivative), factor * scale / (power + 1)
    limits = np.stack([-apart[:-1], apart[1:]], axis=1) / scale[:, None]
    return np.hstack([to_series, to_series @ dense]), to_taylor, scale, limits


@cache
def panel_series() -> tuple[Any, Array, Array, Array, Array]:
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

    orders : highest order; N // 2 if None.  At N / 2 the samples determine only a cosine.
    """
    samples = np.asarray(samples, dtype=float)
    count = samples.shape[-1]
    amplitudes = np.fft.rfft(samples, axis=-1) / count
    amplitudes[..., 1 : (count + 1) // 2] *= 2
    wanted: Array = amplitudes if orders is None else amplitudes[..., : orders + 1]
    return wanted


def present(amplitudes: Array) -> Array:
    """Places of the orders (P,) of complex amplitudes (..., K + 1) that are not all zero."""
    return np.flatnonzero(np.any(amplitudes, axis=tuple(range(amplitudes.ndim - 1))))


def synthesis(amplitudes: Array, theta: Array) -> Array:
    """Values at angles theta (M,), rad, of complex amplitudes Y_0 ... Y_n; shape (..., M).

    Orders of which nothing has an amplitude cost nothing: of a long cycle most are such.
    """
    orders, theta = present(amplitudes), np.asarray(theta)
    amplitudes = amplitudes[..., orders]
    step = max(1, AT_ONCE // max(len(orders), 1))
    parts = [
        (amplitudes @ np.exp(1j * np.outer(orders, theta[k : k + step]))).real
        for k in range(0, max(len(theta), 1), step)
    ]
    return parts[0] if len(parts) == 1 else np.concatenate(parts, axis=-1)


def _folded_samples(amplitudes: Array, count: int) -> Array:
    """Values (..., count), equally spaced over a period, of more orders than they resolve.

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
        is order N / 2, whose phase N samples do not determine.
        """
        values = harmonics(samples, (np.shape(samples)[-1] - 1) // 2)
        sizes = np.max(np.abs(values), axis=tuple(range(values.ndim - 1)), initial=0.0)
        above = np.flatnonzero(sizes > scale * np.max(sizes))
        return cls(values[..., : (int(above[-1]) if above.size else 0) + 1], turns)

    def without_rounding(self, scale: float = 1e-14) -> Periodic:
        """The signals without orders that are a share of the largest of each signal at most.

        A cycle of many turns has hundreds of them between those of its parts.
        """
        sizes = self.sizes
        significant = sizes > scale * np.max(sizes, axis=-1, keepdims=True)
        return Periodic(np.where(significant, self.amplitudes, 0.0), self.turns)

    def amplitude(self, place: int) -> Array:
        """Complex amplitude (...) of one order by its place; 0 above the last."""
        if place < self.amplitudes.shape[-1]:
            return np.asarray(self.amplitudes[..., place])
        return np.zeros(self.amplitudes.shape[:-1], complex)

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
            raise UsageError(
                Note(
                    "signals of {turns} and {turns_2} turns cannot be added",
                    turns=self.turns,
                    turns_2=other.turns,
                )
            )
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
        *shape, known = self.amplitudes.shape
        if known == count:
            return self.amplitudes
        padded = np.zeros((*shape, count), self.amplitudes.dtype)
        padded[..., :known] = self.amplitudes
        return padded

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
        peak_at = place_of_peak(high, low, high_at, low_at)
        rows = (self.mean, self.rms, np.maximum(high, -low), peak_at, high, high_at, low, low_at)
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
