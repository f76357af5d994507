"""What a measure of the sum of all rows is the largest of, and how that changes with the phases.

Peaks are the largest of all tops of the signal.  How a top moves does not matter for its slope,
since the signal is level there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.balancing.phase_cost import AREA_SAMPLES, Term, by_orders, size, squared
from equipoise.signals import Periodic

Array = np.ndarray[Any, Any]
Pieces = tuple[Array, Array]
"""Values (P,) and their slopes (P, m) by the phases."""

SAMPLES, ROUNDS = 360, 4
"""In a turn, among which tops are looked for; steps of Newton's method from there."""
REACH = 0.1
"""rad, by which a top is followed."""
TINY = 1e-300


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
        found = []
        for total in term.signals.total(phases):
            signal = _levelled(Periodic(total, term.signals.turns))
            found.append((_looked_for(signal, 1), _looked_for(signal, -1)))
        return cls(term, tuple(found))

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
        high, rising = _tops(total, slopes, places[0], 1)
        if term.measure == "peak" and len(total.amplitudes) > 1:
            return high, rising
        low, falling = _tops(total, slopes, places[1], -1)
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


def _tops(total: Periodic, slopes: Array, start: Array, sign: int) -> Pieces:
    """Tops (sign 1) of a signal, or its bottoms (-1) with their sign turned; of a vector's length.

    total : amplitudes (C, K + 1).  slopes : (m, C, K + 1), its derivatives by the phases.
    start : (P,) where they are nearly, rad.
    """
    theta = _followed(_levelled(total), start, sign)
    values = total.values(theta)
    change = Periodic(slopes, total.turns).values(theta)
    if len(values) == 1:
        return sign * values[0], sign * change[:, 0].T
    sizes = size(values)
    return sign * sizes, sign * np.sum(change * values, axis=1).T / np.maximum(sizes, TINY)[:, None]


def _levelled(total: Periodic) -> Periodic:
    """The signal whose tops are looked for: the only component, or a vector's squared length."""
    one = len(total.amplitudes) == 1
    return Periodic(total.amplitudes[0], total.turns) if one else squared(total)


def _looked_for(signal: Periodic, sign: int) -> Array:
    """Crank angles (P,) of the tops (sign 1) or bottoms (-1) of a signal, rad."""
    count = max(SAMPLES * signal.turns, 8 * signal.amplitudes.shape[-1])
    values = sign * signal.samples(count)
    top = (values >= np.roll(values, 1)) & (values >= np.roll(values, -1))
    return _followed(signal, np.flatnonzero(top) * (signal.period / count), sign)


def _followed(signal: Periodic, start: Array, sign: int) -> Array:
    """Crank angles (P,) of tops or bottoms near a start (P,), rad, by Newton's method."""
    theta = start
    slope, bend = signal.derivative(), signal.derivative(2)
    for _ in range(ROUNDS):
        down, curve = slope.values(theta), bend.values(theta)
        move = np.divide(-down, curve, out=np.zeros_like(down), where=sign * curve < 0)
        theta = np.clip(theta + move, start - REACH, start + REACH)
    return theta
