"""Periodic signals: their figures over a cycle, and their harmonics.

Convention: y(theta) = Re sum Y_n exp(i n theta), so that a_n = Re Y_n multiplies cos n theta and
b_n = -Im Y_n multiplies sin n theta; Y_0 is the mean.
"""

from __future__ import annotations

from functools import cache, cached_property
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
        candidates = values >= high - np.maximum(EQUAL * (high - low), rounding)
        if smooth:  # of the few that are near, those that no neighbour exceeds
            where = np.nonzero(candidates)
            k, count = where[-1], values.shape[-1]
            row, value = where[:-1], values[where]
            before = np.where(k > 0, values[(*row, k - 1)], -np.inf)
            after = np.where(k < count - 1, values[(*row, (k + 1) % count)], -np.inf)
            least, steady = rounding[..., 0][row], (high - low <= rounding)[..., 0][row]
            candidates[where] = (value >= np.maximum(before, after) - least) | steady
    numbers: Array = np.where(
        candidates.any(axis=-1), candidates.argmax(axis=-1), values.argmax(axis=-1)
    )
    return numbers


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


def figures(crank_angle: Array, samples: Array) -> Figures:
    """Mean, RMS and extremes of samples (N,) taken at crank angles (N,), rad."""
    return figures_of_each(crank_angle, samples[None])[0]


def mean(samples: Array, shares: Array | None = None) -> Array:
    """Mean (...) of samples (..., N) by their shares (N,); equal ones if None."""
    return np.asarray(np.mean(samples, axis=-1) if shares is None else samples @ shares)


def figures_of_each(
    crank_angle: Array,
    samples: Array,
    shares: Array | None = None,
    shown: Array | slice = slice(None),
) -> list[Figures]:
    """Figures of several signals (M, N) at once, which takes little longer than of one.

    shares : (N,) of each sample in a mean, with sum 1; equal ones if None.
    shown : places of the samples that extremes are taken from; all of them if not given.
    """
    average, rms = mean(samples, shares), np.sqrt(mean(np.square(samples), shares))
    samples = samples[:, shown]
    whole = np.stack([samples, -samples])
    high, low = np.max(whole, axis=2)
    high_at, low_at = crank_angle[shown][highest_at(whole)]
    peak_at = place_of_peak(high, -low, high_at, low_at)
    rows = (average, rms, np.maximum(high, low), peak_at, high, high_at, -low, low_at)
    return [Figures(*item) for item in np.array(rows).T.tolist()]


def place_of_peak(high: Array, low: Array, high_at: Array, low_at: Array) -> Array:
    """Crank angles (M,) of the largest absolute value, of equal ones the first, from the largest
    and smallest values (M,) and their crank angles (M,).
    """
    equal = np.abs(high + low) <= EQUAL * (high - low)
    values = np.where(high >= -low, high_at, low_at)
    return np.asarray(np.where(equal, np.minimum(high_at, low_at), values))


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
    """

    crank_angle: Array
    shares: Array
    at: Array
    turns: int
    orders: int

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
        angles (B,) at which only slopes jump, rad; so many of these as the grid can tell apart.

        steps : of the grid between so many Gauss points.  With as many the highest third of the
            orders is good to 2e-4 of the largest, with half as many each is to 1e-10.
        """
        period, offset = 2 * pi * turns, JUMP_OFFSET * turns
        if len(bends) * STEPS_BETWEEN_BENDS > len(grid):
            bends = ()
        jump_ends = _ends_of_pieces(jumps, period, 4 * offset)
        ends = _ends_of_pieces(np.concatenate([jumps, bends]), period, 4 * offset)
        longest = min(steps * period / len(grid), LONGEST_PANEL)
        counts = np.ceil(np.diff(ends) / longest * (1 - ROUNDING))
        panels = [
            np.linspace(begin, end, max(int(count), 1) + 1)
            for begin, end, count in zip(ends[:-1], ends[1:], counts, strict=True)
        ]
        begins = np.concatenate([panel[:-1] for panel in panels])
        widths = np.concatenate([np.diff(panel) for panel in panels])
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
        return cls(theta[order], whole[order], at[order], turns, orders)

    @cached_property
    def shown(self) -> Array:
        """Places (M,) of the grid and of both sides of jumps: what is drawn, and has extremes."""
        return np.flatnonzero(self.shares == 0.0)

    @cached_property
    def grid(self) -> Array:
        """Places (N,) of the equally spaced crank angles."""
        return np.flatnonzero((self.shares == 0.0) & (self.at == self.crank_angle))

    def figures_of_each(self, samples: Array) -> list[Figures]:
        """Mean, RMS and extremes of each of several signals (M, N)."""
        return figures_of_each(self.at, samples, self.shares, self.shown)

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
        (high, high_at), (low, low_at) = (map(float, self.extreme(sign)) for sign in (1, -1))
        above = high >= -low - EQUAL * (high - low)
        return Figures(
            float(self.mean), float(self.rms), max(high, -low), high_at if above else low_at,
            high, high_at, low, low_at,
        )  # fmt: skip

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
