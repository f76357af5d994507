"""All arrangements of phases on a grid, those that differ by symmetry only counted once.

A mean square of a sum of rows is a sum over pairs, since orders do not mix:

    sum_n |S_n|^2 = const + sum_(j<k) G_jk(phi_k - phi_j)
    G_jk(d) = 2 Re sum_n T*_jn T_kn exp(i n d)

so that tables of G over the grid give it for millions of arrangements.  Other measures are taken
from samples of the signal.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from itertools import combinations, permutations
from math import comb, factorial, prod

import numpy as np

from equipoise.balancing.cylinder_phasing import Cost, PhaseObjective, RowSignals, by_orders
from equipoise.balancing.rounding import NEARLY
from equipoise.dataclass import dataclass
from equipoise.signals import Array, synthesis

MOST = 5_000_000
"""Arrangements that are looked at."""
MOST_PAIRS, MOST_SAMPLES = 150_000_000, 1_000_000_000
"""Look-ups of pairs, and samples, that one search may take: some ten seconds."""
MOST_TABLE = 2**27
"""Samples that are held, of every row at every phase: half a GiB."""
CHUNK, SAMPLED_CHUNK = 50_000, 4_000
"""Arrangements that are judged together: by orders, and by samples, of which each takes many
more."""
SAMPLES = 96
"""In a turn, on which peaks are judged until they are polished."""
FEWEST = 4
"""Phases in a turn below which a grid is useless: of order 2 it would see one in a period."""
MOST_CANDIDATES = 3_000
"""Best arrangements among which different ones are looked for: beside each good one lie all its
neighbours on the grid."""
SAME = 1e-12
"""Over the largest amplitude: a difference of two rows that is rounding."""
BETTER = 1e-9
"""Share by which a value must fall to count as better."""
MOST_SWAPS, MOST_ROUNDS = 50_000, 100
"""Orders of equal rows among which the twist decides; where there are more, so many times the best
swap of two rows is made."""


@dataclass(frozen=True, eq=False)
class PhaseGrid:
    """Arrangements of the rows on phases that are whole multiples of a step; row 1 is at 0.

    levels : how many phases there are in a period.
    """

    cost: Cost
    levels: int

    @property
    def step(self) -> float:
        """rad."""
        return self.cost.period / self.levels

    @cached_property
    def groups(self) -> tuple[tuple[int, ...], ...]:
        """Rows but the first, by which of them may be swapped without any effect."""
        return tuple(
            rest for group in alike(self.cost) if (rest := tuple(k for k in group if k > 0))
        )

    @property
    def count(self) -> int:
        """Number of arrangements: within a group only the sorted ones."""
        return prod(comb(self.levels + len(group) - 1, len(group)) for group in self.groups)

    @property
    def affordable(self) -> bool:
        """Whether all arrangements can be looked at."""
        rows, terms = self.cost.rows, self.cost.measured
        summed = sum(
            term.signals.amplitudes[:, :, :, 0].size * self._samples
            for term in terms
            if not by_orders(term.measure)
        )
        pairs = rows * (rows - 1) // 2 * sum(by_orders(term.measure) for term in terms)
        count = self.count
        quick = count <= MOST and count * pairs <= MOST_PAIRS and count * summed <= MOST_SAMPLES
        return quick and self.levels * summed <= MOST_TABLE

    @property
    def _samples(self) -> int:
        return SAMPLES * self.cost.terms[0].signals.turns

    def best(self, progress: Callable[[int], None]) -> Array:
        """The best arrangements (R, m), rad, the best first; `progress` hears how many are done."""
        sampled = any(not by_orders(term.measure) for term in self.cost.measured)
        judges = [
            self._by_pairs(term) if by_orders(term.measure) else self._by_samples(term)
            for term in self.cost.measured
        ]
        levels, costs = np.zeros((0, self.cost.rows), np.int64), np.zeros(0)
        done = 0
        few = max(1, SAMPLED_CHUNK // self.cost.terms[0].signals.turns)
        for chunk in self._chunks(few if sampled else CHUNK):
            value = self.cost.of([judge(chunk) for judge in judges])
            levels, costs = np.vstack([levels, chunk]), np.concatenate([costs, value])
            if len(costs) > MOST_CANDIDATES:
                best = np.argpartition(costs, MOST_CANDIDATES)[:MOST_CANDIDATES]
                levels, costs = levels[best], costs[best]
            done += len(chunk)
            progress(done)
        value = levels[np.argsort(costs, kind="stable")] * self.step
        return np.asarray(value)

    def _chunks(self, size: int) -> Iterator[Array]:
        """Numbers of steps (B, m) of all arrangements, some at a time."""
        parts = [sorted_choices(self.levels, len(group)) for group in self.groups]
        for start in range(0, self.count, size):
            left = np.arange(start, min(start + size, self.count))
            chunk = np.zeros((len(left), self.cost.rows), np.int64)
            for group, part in zip(self.groups, parts, strict=True):
                left, here = np.divmod(left, len(part))
                chunk[:, group] = part[here]
            yield chunk

    def _by_pairs(self, term: PhaseObjective) -> Callable[[Array], Array]:
        """Value (B,) of numbers of steps (B, m), by the pairs' tables."""
        amplitudes = term.signals.amplitudes * np.sqrt(term.shares)
        turning = np.exp(1j * np.outer(term.signals.orders, np.arange(self.levels) * self.step))
        constant = np.sum(np.abs(amplitudes) ** 2, axis=(1, 2, 3))
        pairs = list(combinations(range(self.cost.rows), 2))

        def table_of(j: int, k: int) -> Array:
            product = np.sum(amplitudes[:, j].conj() * amplitudes[:, k], axis=1)
            return np.ascontiguousarray(2 * (product @ turning).real.T)

        tables = [table_of(j, k) for j, k in pairs]

        def judge(levels: Array) -> Array:
            total = np.broadcast_to(constant, (len(levels), len(constant))).copy()
            for (j, k), table in zip(pairs, tables, strict=True):
                total += table[(levels[:, k] - levels[:, j]) % self.levels]
            return np.asarray(np.sqrt(np.maximum(np.max(total, axis=1), 0.0)))

        return judge

    def _by_samples(self, term: PhaseObjective) -> Callable[[Array], Array]:
        """Value (B,) of numbers of steps (B, m), by samples of the signal."""
        phases = np.repeat(np.arange(self.levels)[:, None] * self.step, self.cost.rows, axis=1)
        theta = np.arange(self._samples) * (2 * np.pi / self._samples)
        if term.jumping is None:
            turned = term.signals.turned(phases)
            samples = np.stack([synthesis(item, theta).astype(np.float32) for item in turned])
        else:  # (levels, 1, m, C, samples), as the other
            angles = np.broadcast_to(theta * term.signals.turns, (self.levels, self._samples))
            samples = np.transpose(term.jumping.each(phases, angles), (1, 0, 3, 2))[:, None]
            samples = samples.astype(np.float32)

        def judge(levels: Array) -> Array:
            values = np.asarray(sum(samples[levels[:, k], :, k] for k in range(self.cost.rows)))
            values = values[:, :, 0] if values.shape[2] == 1 else np.linalg.norm(values, axis=2)
            high, low = np.max(values, axis=-1), np.min(values, axis=-1)
            value = high - low if term.measure == "peak_to_peak" else np.maximum(high, -low)
            if term.measure == "area":
                value = 2 * np.pi * np.mean(np.abs(values), axis=-1)
            return np.asarray(np.max(value, axis=1), float)

        return judge


def alike(cost: Cost, amplitudes: Sequence[Array] = ()) -> list[list[int]]:
    """Rows that do the same to every objective, by groups; what does not vary is left out.

    more : amplitudes (K, V, m, C, N) in which they must be alike as well.
    """
    signals = [term.signals.amplitudes[..., 1:] for term in cost.measured]
    signals += [item[..., 1:] for each in amplitudes for item in each]
    tops = [np.max(np.abs(a)) for a in signals]
    groups: list[list[int]] = []
    for k in range(cost.rows):
        for group in groups:
            gaps = (np.max(np.abs(a[:, group[0]] - a[:, k])) for a in signals)
            if all(gap <= SAME * top for gap, top in zip(gaps, tops, strict=True)):
                group.append(k)
                break
        else:
            groups.append([k])
    return groups


def sorted_choices(levels: int, count: int) -> Array:
    """All rising choices (R, count) of `count` numbers below `levels`, with repetition."""
    values = np.arange(levels, dtype=np.int64)[:, None]
    for _ in range(count - 1):
        last = values[:, -1]
        many = levels - last
        first = np.repeat(np.cumsum(many) - many, many)
        added = np.arange(int(many.sum())) - first + np.repeat(last, many)
        values = np.hstack([np.repeat(values, many, axis=0), added[:, None]])
    return values


def distinct(candidates: Array, period: float, apart: Sequence[float], most: int) -> Array:
    """The first arrangements (R, m) that differ from all before them, (S, m).

    apart : distances in the phase of some row, rad, the widest first; `most` of each.
    """
    chosen: list[int] = []
    for distance in apart:
        wanted = len(chosen) + most
        for k, phases in enumerate(candidates):
            if len(chosen) >= wanted:
                break
            off = np.abs((candidates[chosen] - phases + period / 2) % period - period / 2)
            if not chosen or np.min(np.max(off, axis=1)) > distance * (1 + NEARLY):
                chosen.append(k)
    return candidates[chosen]


def coarsened(cost: Cost, levels: int) -> PhaseGrid | None:
    """The finest grid that can be looked at as a whole, of divisors of `levels`."""
    least = FEWEST * cost.terms[0].signals.turns
    for divisor in range(1, levels // least + 1):
        if levels % divisor == 0:
            grid = PhaseGrid(cost, levels // divisor)
            if grid.affordable:
                return grid
    return None


@dataclass(frozen=True, eq=False)
class Twist:
    """Roll and yaw moment of rows, and the orders of equal ones.

    force : shaking force of the rows.  lateral : (m,) places to the side, m.
    groups : rows that may be swapped without any effect on what is asked.
    """

    force: RowSignals
    lateral: Array
    groups: Sequence[Sequence[int]]

    def of(self, phases: Array, orders: Array | None = None) -> Array:
        """Mean square (P,) of roll and yaw moment together, N2 m2, with phases (m,) in orders.

        sum_n |F_n|^2 / 2 |sum_k z_k exp(i n phi_k)|^2 is a sum over pairs of rows.
        """
        orders = np.arange(len(phases))[None] if orders is None else orders
        sizes = np.sum(np.abs(self.force.amplitudes[0, 0, :, 1:]) ** 2, axis=0) / 2
        turning = np.exp(1j * np.outer(phases, self.force.orders[1:]))
        pairs = ((sizes * turning) @ turning.conj().T).real
        swapped = pairs[orders[:, :, None], orders[:, None, :]]
        return np.asarray(np.einsum("j,pjk,k->p", self.lateral, swapped, self.lateral))

    def swapped(self, phases: Array) -> Array:
        """The phases (m,), swapped among equal rows until they twist least."""
        few = prod(factorial(len(group)) for group in self.groups) <= MOST_SWAPS
        orders = self._all_orders() if few else self._swaps()
        for _ in range(1 if few else MOST_ROUNDS):
            best = first_least(self.of(phases, orders))
            if best == 0:
                break
            phases = np.asarray(phases[orders[best]])
        return phases

    def _all_orders(self) -> Array:
        """Every order (P, m) of equal rows, the present one first."""
        orders = np.arange(len(self.lateral))[None]
        for group in self.groups:
            swapped = np.array(list(permutations(group)))
            orders = np.repeat(orders, len(swapped), axis=0)
            orders[:, group] = np.tile(swapped, (len(orders) // len(swapped), 1))
        return orders

    def _swaps(self) -> Array:
        """Orders (P, m) with two equal rows swapped; the present one first."""
        pairs = [pair for group in self.groups for pair in combinations(group, 2)]
        orders = np.repeat(np.arange(len(self.lateral))[None], len(pairs) + 1, axis=0)
        for order, (j, k) in zip(orders[1:], pairs, strict=True):
            order[[j, k]] = k, j
        return orders


def first_least(values: Array) -> int:
    """Place of the first of values (P,) that is as small as the least but for rounding."""
    return int(np.argmax(values <= np.min(values) + BETTER * np.max(values)))
