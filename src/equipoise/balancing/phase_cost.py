"""Measures of the sum of all rows as functions of their phases, what they add up to, and slopes.

By Parseval's theorem the mean square of a sum is that of its orders, S_n = sum_k T_kn exp(i n
phi_k); peaks are looked for on the signal itself, as the largest of all its tops.  How a top moves
does not matter for its slope, since the signal is level there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Any, Literal

import numpy as np

from equipoise.balancing.multi_row import RowSignals
from equipoise.mechanism.balance import Measure, Objective
from equipoise.signals import Array, Periodic

Combine = Literal["sum", "squares"]

AREA_SAMPLES = 1440
"""In a turn, from which an area is summed."""
SAMPLES, NEAR, NEWTON_ROUNDS, REACH, LEAP = 360, 0.03, 4, 0.03, 0.1
"""In a turn, among which tops are looked for; share of the range by which a sample may miss its
top; steps of Newton's method from there, and how far they may lead, rad; the same where phases
change meanwhile."""
TINY = 1e-300
Pieces = tuple[Array, Array]
"""Values (P,) and their slopes (P, m) by the phases."""
NOTHING = 1e-12
"""Share of the loudest at which an amplitude or a value is rounding."""


def by_orders(measure: Measure) -> bool:
    """Whether a measure follows from the sizes of the orders."""
    return measure in {"rms", "ripple"}


@dataclass(frozen=True, eq=False)
class Term:
    """One objective as a function of the phases.

    signals : of each row, of the orders that count.
    scale : value that counts as one, in the output's unit.
    """

    objective: Objective
    signals: RowSignals
    scale: float = 1.0

    @property
    def measure(self) -> Measure:
        return self.objective.measure

    def values(self, phases: Array) -> Array:
        """Value (...) at phases (..., m), rad; of several speeds the loudest."""
        return np.asarray(np.max(self.each(self.signals.total(phases)), axis=-1))

    def each(self, total: Array) -> Array:
        """Measure (...) of signals by their orders (..., C, K + 1)."""
        if by_orders(self.measure):
            return np.asarray(np.sqrt(np.sum(np.abs(total) ** 2 * self.shares, axis=(-2, -1))))
        if self.measure == "area":
            values = Periodic(total, self.signals.turns).samples(AREA_SAMPLES * self.signals.turns)
            return np.asarray(2 * pi * np.mean(np.abs(values[..., 0, :]), axis=-1))
        if total.shape[-2] > 1:
            square = squared(Periodic(total, self.signals.turns))
            return np.asarray(np.sqrt(np.maximum(highest(square, 1), 0.0)))
        signal = Periodic(total[..., 0, :], self.signals.turns)
        high, low = highest(signal, 1), -highest(signal, -1)
        return high - low if self.measure == "peak_to_peak" else np.maximum(high, -low)

    @cached_property
    def shares(self) -> Array:
        """Share (K + 1,) of each squared amplitude in the mean square that is measured."""
        shares = np.full(self.signals.amplitudes.shape[-1], 0.5)
        shares[0] = 0.0 if self.measure == "ripple" else 1.0
        return shares

    @cached_property
    def single(self) -> float:
        """Sum of the values that every row has alone: m times that of one where all are equal."""
        rows = range(self.signals.amplitudes.shape[1])
        alone = [Term(self.objective, self.signals.alone(k)) for k in rows]
        return float(sum(term.values(np.zeros(1)) for term in alone))

    def value_at(self, phases: Array) -> float:
        """Value at phases (m,), 0 where it is what rounding leaves of the rows' own."""
        value = float(self.values(phases))
        return value if value > NOTHING * self.single else 0.0

    @cached_property
    def influenced(self) -> bool:
        """Whether phases change the value: two rows must meet in the same order."""
        sizes = np.max(np.abs(self.signals.amplitudes), axis=(0, 2))
        loud = sizes[:, 1:] > NOTHING * max(float(np.max(sizes)), 1e-300)
        if by_orders(self.measure):
            return bool(np.any(np.sum(loud, axis=0) > 1))
        return int(np.sum(np.any(loud, axis=1))) > 1

    def square_with_slopes(self, phases: Array) -> tuple[float, Array, Array]:
        """Mean square, its gradient (m,) and its second derivatives (m, m) at phases (m,), rad.

        Of the first speed.
        """
        turned = self.signals.turned(phases)[0]
        total, shares = np.sum(turned, axis=0), self.shares
        slope = 1j * self.signals.orders * turned
        bend = 1j * self.signals.orders * slope
        gradient = 2 * np.sum((total.conj() * slope * shares).real, axis=(1, 2))
        flat = (slope * np.sqrt(shares)).reshape(len(slope), -1)
        second = 2 * (flat.conj() @ flat.T).real
        second += np.diag(2 * np.sum((total.conj() * bend * shares).real, axis=(1, 2)))
        return float(np.sum(np.abs(total) ** 2 * shares)), gradient, second


@dataclass(frozen=True, eq=False)
class Cost:
    """Several objectives as one: their weighted sum, or the root of the sum of squares, each over
    the value that counts as one.
    """

    terms: tuple[Term, ...]
    combine: Combine = "sum"

    @property
    def rows(self) -> int:
        return int(self.terms[0].signals.amplitudes.shape[1])

    @property
    def period(self) -> float:
        """By which a phase may change without any effect, rad."""
        return 2 * pi * self.terms[0].signals.turns

    @cached_property
    def factors(self) -> Array:
        """Weight over scale of each term."""
        return np.array([term.objective.weight / term.scale for term in self.terms])

    def values(self, phases: Array) -> Array:
        """Combined value (...) at phases (..., m), rad."""
        return self.of([term.values(phases) for term in self.terms])

    def of(self, values: Sequence[Any]) -> Array:
        """Combined value (...) of the values (...) of all terms."""
        parts = [
            factor * np.asarray(value) for factor, value in zip(self.factors, values, strict=True)
        ]
        if self.combine == "sum" or len(parts) == 1:
            return np.asarray(sum(parts))
        return np.asarray(np.sqrt(sum(part**2 for part in parts)))

    @property
    def smooth(self) -> bool:
        """Whether mean squares at one speed each are all there is."""
        return all(
            by_orders(term.measure) and len(term.signals.amplitudes) == 1 for term in self.terms
        )


def size(values: Array) -> Array:
    """Absolute value (..., N) of a signal (..., C, N)."""
    return np.asarray(np.sqrt(np.sum(np.square(values), axis=-2)))


def squared(vector: Periodic) -> Periodic:
    """Square (...) of the length of vectors (..., C), exactly: its orders reach twice as far."""
    count = 4 * vector.amplitudes.shape[-1] + 4
    return Periodic.of(np.sum(vector.samples(count) ** 2, axis=-2), vector.turns, 0.0)


def highest(signal: Periodic, sign: int) -> Array:
    """Largest value (...) of signals, or of their negatives (sign -1), to rounding.

    Every top that may be the highest is followed: the best phases make tops tie, and then the
    highest sample need not lie at the highest top.
    """
    flat = Periodic(sign * signal.amplitudes.reshape(-1, signal.amplitudes.shape[-1]), signal.turns)
    owner, start, best = _tops(flat, NEAR)
    np.maximum.at(best, owner, _at(flat, owner, _followed(flat, owner, start, REACH)))
    return best.reshape(signal.amplitudes.shape[:-1])


def _tops(flat: Periodic, near: float) -> tuple[Array, Array, Array]:
    """Tops among samples of signals (B,): of which signal, and where, rad, (T,) each; and the
    highest sample (B,) of every signal.

    near : share of the range by which a top may be lower than the highest; 1 for all of them.
    """
    count = max(SAMPLES * flat.turns, 8 * flat.amplitudes.shape[-1])
    values = flat.samples(count)
    best, least = np.max(values, axis=1), np.min(values, axis=1)
    top = values >= (best - near * (best - least))[:, None]
    top &= (values >= np.roll(values, 1, axis=1)) & (values >= np.roll(values, -1, axis=1))
    owner, place = np.nonzero(top)
    return owner, place * (flat.period / count), best


def _followed(flat: Periodic, owner: Array, start: Array, reach: float) -> Array:
    """Crank angles (T,) of the tops of signals `owner` (T,) by Newton's method, within a reach of
    where they are nearly, rad.
    """
    theta, slope, bend = start, flat.derivative(), flat.derivative(2)
    for _ in range(NEWTON_ROUNDS):
        down, curve = _at(slope, owner, theta), _at(bend, owner, theta)
        move = np.divide(-down, curve, out=np.zeros_like(down), where=curve < 0)
        theta = np.clip(theta + move, start - reach, start + reach)
    return theta


def _at(signal: Periodic, owner: Array, theta: Array) -> Array:
    """Values (T,) of signals `owner` (T,) at crank angles (T,)."""
    turning = np.exp(1j * np.outer(theta, signal.orders))
    return np.asarray(np.sum((signal.amplitudes[owner] * turning).real, axis=1))


# -- slopes by the phases --------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Tops:
    """Tops of a term's signals, to be followed while the phases change a little.

    places : speed -> crank angles (P,), rad, of tops and of bottoms, as far as the measure has use
        for them.
    """

    term: Term
    places: tuple[tuple[Array, Array], ...]

    @classmethod
    def of(cls, term: Term, phases: Array) -> Tops:
        """All tops at phases (m,), rad."""
        signals = [Periodic(one, term.signals.turns) for one in term.signals.total(phases)]
        return cls(term, tuple((_looked_for(one, 1), _looked_for(one, -1)) for one in signals))

    def pieces(self, phases: Array) -> Pieces:
        """Values (P,) whose largest is the term's, and their slopes (P, m) by the phases (m,)."""
        turned = self.term.signals.turned(phases)
        found = [self._of_speed(*each) for each in zip(turned, self.places, strict=True)]
        return np.concatenate([v for v, _ in found]), np.vstack([s for _, s in found])

    def _of_speed(self, turned: Array, places: tuple[Array, Array]) -> Pieces:
        """The same at one speed, from the amplitudes (m, C, K + 1) of all rows."""
        term = self.term
        slopes = 1j * term.signals.orders * turned
        if by_orders(term.measure):
            return _root(np.sum(turned, axis=0), slopes, term.shares)
        total = Periodic(np.sum(turned, axis=0), term.signals.turns)
        if term.measure == "area":
            return _area(total, slopes)
        high, rising = _tops_with_slopes(total, slopes, places[0], 1)
        if term.measure == "peak" and len(total.amplitudes) > 1:
            return high, rising
        low, falling = _tops_with_slopes(total, slopes, places[1], -1)
        if term.measure == "peak":
            return np.concatenate([high, low]), np.vstack([rising, falling])
        # The largest of all sums is that of the largest; low values come with their sign turned.
        both = (high[:, None] + low).ravel()
        return both, (rising[:, None] + falling).reshape(len(both), -1)


def _root(total: Array, slopes: Array, shares: Array) -> Pieces:
    root = np.sqrt(np.sum(np.abs(total) ** 2 * shares))
    slope = np.sum((total.conj() * slopes * shares).real, axis=(1, 2)) / max(root, TINY)
    return np.array([root]), slope[None]


def _area(total: Periodic, slopes: Array) -> Pieces:
    count = AREA_SAMPLES * total.turns
    values = total.samples(count)[0]
    change = np.sign(values) * Periodic(slopes[:, 0], total.turns).samples(count)
    area = 2 * np.pi * np.mean(np.abs(values), keepdims=True)
    return area, 2 * np.pi * np.mean(change, axis=1)[None]


def _tops_with_slopes(total: Periodic, slopes: Array, start: Array, sign: int) -> Pieces:
    """Tops (sign 1) of a signal, or its bottoms (-1) with their sign turned; of a vector's length.

    total : amplitudes (C, K + 1).  slopes : (m, C, K + 1), its derivatives by the phases.
    start : (P,) where they are nearly, rad.
    """
    theta = _followed(_levelled(total, sign), np.zeros(len(start), int), start, LEAP)
    values = total.values(theta)
    change = Periodic(slopes, total.turns).values(theta)
    if len(values) == 1:
        return sign * values[0], sign * change[:, 0].T
    sizes = size(values)
    return sign * sizes, sign * np.sum(change * values, axis=1).T / np.maximum(sizes, TINY)[:, None]


def _levelled(total: Periodic, sign: int) -> Periodic:
    """The one signal whose tops are looked for: the only component, or a vector's squared length;
    turned over for bottoms (sign -1).
    """
    one = total if len(total.amplitudes) == 1 else squared(total)
    return Periodic(sign * one.amplitudes.reshape(1, -1), total.turns)


def _looked_for(total: Periodic, sign: int) -> Array:
    """Crank angles (P,) of the tops (sign 1) or bottoms (-1) of a signal, rad."""
    signal = _levelled(total, sign)
    owner, start, _ = _tops(signal, 1.0)
    return _followed(signal, owner, start, LEAP)
