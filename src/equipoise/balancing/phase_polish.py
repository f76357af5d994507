"""From the best cells of the grid down to the minimum.

Mean squares are followed by Newton's method in a trust region.  Where their roots are summed, the
sum has a kink wherever one of them vanishes; sqrt(q + e^2) with a falling e leads there.  Peaks
have a kink where two of them tie, which is where the best phases usually lie: linear programs over
all tops, in a trust region too, find it.  How a top moves does not matter for its slope by the
phases, since the signal is level there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

import numpy as np

from equipoise.balancing.cylinder_phasing import (
    AREA_SAMPLES,
    PENALTY,
    Cost,
    PhaseObjective,
    by_orders,
    followed,
    squared,
    tops,
)
from equipoise.balancing.rounding import TINY
from equipoise.dataclass import dataclass
from equipoise.design.minimax import ValuesAndSlopes, descended
from equipoise.signals import Array, Periodic

AfterStep = Callable[[], None]
"""Is called after each step of what may take minutes."""

SMOOTHING = (1e-1, 1e-2, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11)
"""e over the value that counts as one."""
ROUNDS, SMALLEST, GAIN = 40, 1e-4, 1e-12
"""Linear programs; trust region, rad, and relative gain at which they end."""
CURVED, CURVED_ROUNDS, LEAP = 6, 100, 0.05
"""Times that tops are looked for anew and followed; programs meanwhile, and change of a phase, rad.
"""
NEWTON_ROUNDS, FLAT = 200, 1e-14
"""Steps of Newton's method for each e; slope at which it ends, where only rounding is left."""
UNCHANGED = 1e-16
"""Change of the cost at which SLSQP ends: below rounding, to go on while there is gain."""
REACH = 0.1
"""How far phases move at first, and a top may meanwhile, rad: far less than a wave of the orders
that count, so that a top stays the same one."""
GOOD_PREDICTION = 0.1
"""Share of the predicted gain, above which a step is taken, and the trust region grows."""
FINEST, MORE_WAYS, MOST_MOVES, AGAIN = 1e-6, 6, 2000, 1 / 8
"""rad: least step of a search without slopes; ways by chance that it tries; its steps; share of the
first step with which it begins again, nearer to the minimum."""


def most_steps(cost: Cost) -> int:
    """Steps that `polished` takes at most, whatever the machine."""
    if cost.smooth:
        return NEWTON_ROUNDS * len(_smoothing(cost))
    jumps = any(term.jumping is not None for term in cost.measured)
    return ROUNDS + CURVED * CURVED_ROUNDS + (2 * MOST_MOVES if jumps else 0)


def polished(cost: Cost, phases: Array, step: float, after: AfterStep = lambda: None) -> Array:
    """Phases (m,) of the minimum next to these, rad; that of row 1 is kept.

    step : of the grid, rad.
    after : is called after each step, of which there are `most_steps` at most.
    """
    if any(term.jumping is not None for term in cost.measured):
        phases = _compass(cost, phases, step, after)
        better = _better(cost, phases, _by_tops(cost, phases, step, after))
        return _compass(cost, better, AGAIN * step, after)
    newton = _newton(cost, phases, after) if cost.smooth else _by_tops(cost, phases, step, after)
    return _better(cost, phases, newton)


def _better(cost: Cost, phases: Array, candidate: Array) -> Array:
    return candidate if cost.values(candidate) < cost.values(phases) else phases


# -- jumps -----------------------------------------------------------------------------------------


def _compass(cost: Cost, phases: Array, size: float, after: AfterStep) -> Array:
    """Phases (m,) from which no step leads to anything better, in ever smaller steps from a size,
    rad: of one row, of two, and some by chance.

    Where jumps of two rows pass each other the peak itself jumps, which no slope foretells.
    """
    free, chance = len(phases) - 1, np.random.default_rng(1)
    each = np.eye(free)
    pairs = [a + sign * b for k, a in enumerate(each) for b in each[:k] for sign in (1, -1)]
    known = np.vstack([each, *(pair[None] for pair in pairs)])
    best, here = phases, float(cost.values(phases))
    for _ in range(MOST_MOVES):
        if size <= FINEST:
            break
        after()
        ways = np.vstack([known, chance.normal(size=(MORE_WAYS, free))])
        moves = np.pad(size * np.vstack([ways, -ways]), ((0, 0), (1, 0)))
        values = cost.values(best + moves)
        k = int(np.argmin(values))
        if values[k] < here * (1 - GAIN):
            best, here = best + moves[k], float(values[k])
        else:
            size /= 2
    return best


# -- mean squares ----------------------------------------------------------------------------------


def _smoothing(cost: Cost) -> tuple[float, ...]:
    """Values of e, one after the other; a single 0 where there are no kinks."""
    return SMOOTHING if len(cost.terms) > 1 and cost.combine == "sum" else (0.0,)


def _newton(cost: Cost, phases: Array, after: AfterStep) -> Array:
    from scipy.optimize import minimize

    free = phases[1:]
    for smoothing in _smoothing(cost):
        result = minimize(
            lambda x, e: _slopes(cost, x, e)[0],
            free,
            (smoothing,),
            method="trust-exact",
            jac=lambda x, e: _slopes(cost, x, e)[1],
            hess=lambda x, e: _slopes(cost, x, e)[2],
            options={"gtol": FLAT, "maxiter": NEWTON_ROUNDS, "initial_trust_radius": REACH},
            callback=lambda _: after(),
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
        square, slope, bend = square_with_slopes(term, phases)
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


def square_with_slopes(term: PhaseObjective, phases: Array) -> tuple[float, Array, Array]:
    """Mean square, its gradient (m,) and its second derivatives (m, m) at phases (m,), rad.

    Of the first speed.
    """
    turned, orders = term.signals.turned(phases)[0], term.signals.orders
    total, shares = np.sum(turned, axis=0), term.shares
    slope = 1j * orders * turned
    bend = 1j * orders * slope
    gradient = 2 * np.sum((total.conj() * slope * shares).real, axis=(1, 2))
    flat = (slope * np.sqrt(shares)).reshape(len(slope), -1)
    second = 2 * (flat.conj() @ flat.T).real
    second += np.diag(2 * np.sum((total.conj() * bend * shares).real, axis=(1, 2)))
    return float(np.sum(np.abs(total) ** 2 * shares)), gradient, second


# -- peaks -----------------------------------------------------------------------------------------


def _by_tops(cost: Cost, phases: Array, step: float, after: AfterStep) -> Array:
    """Linear programs, which cross from one set of tops to another, then curved ones."""
    best = _linear_programs(cost, phases, step, after)
    for _ in range(CURVED):
        values = _curved(cost, best, after)
        if not cost.values(values) < cost.values(best) * (1 - GAIN):
            break
        best = values
    return best


def _linear_programs(cost: Cost, phases: Array, step: float, after: AfterStep) -> Array:
    best, here, region = phases, float(cost.values(phases)), step
    for _ in range(ROUNDS):
        move, gain = _step(cost, best, region)
        after()
        if gain <= GAIN * here:
            break
        there = best + np.concatenate([[0.0], move])
        value = float(cost.values(there))
        if here - value > GOOD_PREDICTION * gain:
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

    items = [ActivePeaks.of(term, phases).pieces(phases) for term in cost.measured]
    now = np.array([np.max(values) for values, _ in items])
    weights, unit = _weights(cost, now), np.where(now > 0, now, 1.0)
    free = len(phases) - 1
    rows = _below(items, unit)
    rows[:, :free] *= region
    result = linprog(
        np.concatenate([np.zeros(free), weights * unit]),
        rows,
        -np.concatenate([values for values, _ in items]),
        bounds=[(-1.0, 1.0)] * free + [(float(low), None) for low in _least(cost) / unit],
    )
    if result.x is None:
        return np.zeros(free), 0.0
    return result.x[:free] * region, float(weights @ np.maximum(now, _least(cost)) - result.fun)


def _below(pieces: list[ValuesAndSlopes], unit: Array) -> Array:
    """Rows (P, m - 1 + terms): slopes of each value, less that of the largest of its term."""
    slopes = np.vstack([slopes[:, 1:] for _, slopes in pieces])
    owner = np.repeat(np.arange(len(pieces)), [len(values) for values, _ in pieces])
    return np.hstack([slopes, -np.diag(unit)[owner]])


def _curved(cost: Cost, phases: Array, after: AfterStep) -> Array:
    """Phases (m,) of the minimum over the same tops, by sequential quadratic programs.

    Where fewer tops tie than there are phases, linear programs come near it only.
    """
    tops = [ActivePeaks.of(term, phases) for term in cost.measured]
    now = np.array([np.max(each.pieces(phases)[0]) for each in tops])
    at_phases = partial(_pieces_at, tops, {})  # values and slopes are asked for one by one

    def groups(moves: Array) -> list[ValuesAndSlopes]:
        pieces = at_phases(np.concatenate([phases[:1], phases[1:] + moves]))
        return [ValuesAndSlopes(values, slopes[:, 1:]) for values, slopes in pieces]

    moves = descended(
        groups,
        np.zeros(len(phases) - 1),
        units=np.where(now > 0, now, 1.0),
        box=(-LEAP, LEAP),
        most=(CURVED_ROUNDS, UNCHANGED),
        total=lambda largest: (float(cost.of(list(largest))), _weights(cost, largest)),
        least=_least(cost),
        after=after,
    )
    return np.concatenate([phases[:1], phases[1:] + moves])


def _pieces_at(
    tops: list[ActivePeaks], known: dict[bytes, list[ValuesAndSlopes]], phases: Array
) -> list[ValuesAndSlopes]:
    """Pieces of all tops at phases (m,); those of the last phases are `known`."""
    key = phases.tobytes()
    if key not in known:
        known.clear()
        known[key] = [each.pieces(phases) for each in tops]
    return known[key]


def _weights(cost: Cost, now: Array) -> Array:
    """Slope of the combined value by that of each term, and of each limit where it is passed."""
    factors, beyond = cost.factors, [PENALTY / limit.scale for limit in cost.limits]
    if cost.combine == "squares":
        parts = factors * now[: len(factors)]
        factors = factors * parts / max(float(np.linalg.norm(parts)), TINY)
    return np.concatenate([factors, beyond])


def _least(cost: Cost) -> Array:
    """Values of terms and limits below which it is all the same."""
    return np.array([0.0] * len(cost.terms) + [limit.scale for limit in cost.limits])


@dataclass(frozen=True, eq=False)
class ActivePeaks:
    """Tops of a term's signals, to be followed while the phases change a little.

    places : speed -> crank angles (P,), rad, of tops and of bottoms, as far as the measure has use
        for them; where signals jump, those of sides of jumps too, with the rows that these go with.
    """

    term: PhaseObjective
    places: tuple[tuple[Any, Any], ...]

    @classmethod
    def of(cls, term: PhaseObjective, phases: Array) -> ActivePeaks:
        """All tops at phases (m,), rad."""
        if (jumping := term.jumping) is not None:
            return cls(term, ((jumping.anchors(phases, 1.0), jumping.anchors(phases, -1.0)),))
        signals = [Periodic(item, term.signals.turns) for item in term.signals.total(phases)]
        return cls(
            term, tuple((_looked_for(signal, 1), _looked_for(signal, -1)) for signal in signals)
        )

    def pieces(self, phases: Array) -> ValuesAndSlopes:
        """Values (P,) whose largest is the term's, and their slopes (P, m) by the phases (m,)."""
        if (jumping := self.term.jumping) is not None:
            ((first, second),) = self.places
            high = jumping.followed(phases, first[0], first[1], 1.0)
            low = jumping.followed(phases, second[0], second[1], -1.0)
            return self._of_ends(high, low, jumping.is_vector)
        turned = self.term.signals.turned(phases)
        values = [self._of_speed(*each) for each in zip(turned, self.places, strict=True)]
        return _stacked(values)

    def _of_speed(self, turned: Array, places: tuple[Array, Array]) -> ValuesAndSlopes:
        """Active peaks at one speed, from the amplitudes (m, C, K + 1) of all rows."""
        term = self.term
        slopes = 1j * term.signals.orders * turned
        if by_orders(term.measure):
            return _root(np.sum(turned, axis=0), slopes, term.shares)
        total = Periodic(np.sum(turned, axis=0), term.signals.turns)
        if term.measure == "area":
            return _area(total, slopes)
        high, low = (
            _tops_with_slopes(total, slopes, each, sign)
            for each, sign in zip(places, (1, -1), strict=True)
        )
        return self._of_ends(high, low, len(total.amplitudes) > 1)

    def _of_ends(
        self, of_tops: ValuesAndSlopes, of_bottoms: ValuesAndSlopes, is_vector: bool
    ) -> ValuesAndSlopes:
        """Of tops, and of bottoms with their sign turned; a vector's size has tops alone."""
        (high, rising), (low, falling) = of_tops, of_bottoms
        if self.term.measure == "peak" and is_vector:
            return of_tops
        if self.term.measure == "peak":
            return _stacked((of_tops, of_bottoms))
        # The largest of all sums is that of the largest; low values come with their sign turned.
        both = (high[:, None] + low).ravel()
        return ValuesAndSlopes(both, (rising[:, None] + falling).reshape(len(both), -1))


def _stacked(parts: Iterable[ValuesAndSlopes]) -> ValuesAndSlopes:
    values, slopes = zip(*parts, strict=True)
    return ValuesAndSlopes(np.concatenate(values), np.vstack(slopes))


def _root(total: Array, slopes: Array, shares: Array) -> ValuesAndSlopes:
    root = np.sqrt(np.sum(np.abs(total) ** 2 * shares))
    slope = np.sum((total.conj() * slopes * shares).real, axis=(1, 2)) / max(root, TINY)
    return ValuesAndSlopes(np.array([root]), slope[None])


def _area(total: Periodic, slopes: Array) -> ValuesAndSlopes:
    count = AREA_SAMPLES * total.turns
    values = total.samples(count)[0]
    change = np.sign(values) * Periodic(slopes[:, 0], total.turns).samples(count)
    area = 2 * np.pi * np.mean(np.abs(values), keepdims=True)
    return ValuesAndSlopes(area, 2 * np.pi * np.mean(change, axis=1)[None])


def _tops_with_slopes(total: Periodic, slopes: Array, start: Array, sign: int) -> ValuesAndSlopes:
    """Tops (sign 1) of a signal, or its bottoms (-1) with their sign turned; of a vector's length.

    total : amplitudes (C, K + 1).  slopes : (m, C, K + 1), its derivatives by the phases.
    start : (P,) where they are nearly, rad.
    """
    theta = followed(_levelled(total, sign), np.zeros(len(start), int), start, REACH)
    values = total.values(theta)
    change = Periodic(slopes, total.turns).values(theta)
    if len(values) == 1:
        return ValuesAndSlopes(sign * values[0], sign * change[:, 0].T)
    sizes = np.linalg.norm(values, axis=0)
    slopes = sign * np.sum(change * values, axis=1).T / np.maximum(sizes, TINY)[:, None]
    return ValuesAndSlopes(sign * sizes, slopes)


def _levelled(total: Periodic, sign: int) -> Periodic:
    """The one signal whose tops are looked for: the only component, or a vector's squared length;
    turned over for bottoms (sign -1).
    """
    item = total if len(total.amplitudes) == 1 else squared(total)
    return Periodic(sign * item.amplitudes.reshape(1, -1), total.turns)


def _looked_for(total: Periodic, sign: int) -> Array:
    """Crank angles (P,) of the tops (sign 1) or bottoms (-1) of a signal, rad."""
    signal = _levelled(total, sign)
    owner, start, _ = tops(signal, 1.0)
    return followed(signal, owner, start, REACH)
