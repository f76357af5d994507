"""Rows whose signals jump, as functions of the crank angle: their sum has no ringing.

A row's signal is a cubic spline between its jumps, and between the rows of load tables, at which
its slope jumps.  The sum of rows at phases phi_k, sum_k f_k(theta + phi_k), is largest at a top
between these, or on one side of one of them, at theta = jump - phi_k; both are looked at.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import ceil, pi
from typing import Any

import numpy as np

from equipoise.balancing.rounding import TINY
from equipoise.dataclass import dataclass
from equipoise.design.minimax import ValuesAndSlopes
from equipoise.signals import JUMP_OFFSET, STEPS_BETWEEN_BENDS, Array, JumpSampling

SPACING = pi / 720
"""rad, between the nodes of splines, and between samples among which tops are looked for: values
are exact to 1e-9 of a signal of ten orders, and tops to 1e-8 after a step to a parabola's."""
SAMPLE_MISS, CLOSER, NARROWER = 0.05, 2, 8
"""Share of the range by which a sample may miss its top; steps to the tops of parabolas, and by how
much each has its neighbours nearer."""
AT_ONCE = 200_000
"""Values of one row that are held at a time."""
SMOOTHED_ORDERS = 60
"""Orders of the kernel that smooths a signal for bounds."""


@dataclass(frozen=True, eq=False)
class JumpingRows:
    """What every row adds to an output while its phase is 0, with its jumps.

    curves : of each row a function of crank angles (...), rad, to values (..., C), and its slope.
    jumps : (J,) crank angles of one row, rad.  turns : of the crank in a cycle.
    bends : (B,) crank angles of one row at which only slopes jump, rad.
    """

    curves: tuple[tuple[Any, Any], ...]
    jumps: Array
    turns: int
    bends: Array

    @classmethod
    def of(
        cls, read: Callable[[Array], Array], jumps: Array, turns: int, bends: Array
    ) -> JumpingRows:
        """From what gives values (m, C, N) of all rows at crank angles (N,), rad.

        So many bends are taken as lie 4 steps and more apart, on the average, as in `JumpSampling`.
        """
        from scipy.interpolate import CubicSpline, PPoly

        period, offset = 2 * pi * turns, JUMP_OFFSET * turns
        if len(bends) * STEPS_BETWEEN_BENDS > period / SPACING:
            bends = np.empty(0)
        bends = bends[np.all(np.abs(np.subtract.outer(bends, jumps)) > 4 * offset, axis=1)]
        starts = np.unique(np.concatenate([jumps, bends, [0.0]]))
        ends = np.append(starts[1:], period)
        pieces = [
            np.linspace(a, b, max(4, ceil((b - a) / SPACING)) + 1)
            for a, b in zip(starts, ends, strict=True)
        ]
        inside = [np.clip(x, x[0] + offset, x[-1] - offset) for x in pieces]
        values = np.moveaxis(read(np.concatenate(inside)), -1, 0)  # (N, m, C)
        parts = np.split(values, np.cumsum([len(x) for x in pieces])[:-1])
        splines = [CubicSpline(x, y) for x, y in zip(pieces, parts, strict=True)]
        places = np.concatenate([*(x[:-1] for x in pieces), [period]])
        coefficients = np.concatenate([spline.c for spline in splines], axis=1)
        curves = []
        for row in range(coefficients.shape[2]):
            curve = PPoly(coefficients[:, :, row], places, extrapolate="periodic")
            curves.append((curve, curve.derivative()))
        return cls(tuple(curves), jumps, turns, bends)

    @property
    def period(self) -> float:
        """Crank angle of a cycle, rad."""
        return 2 * pi * self.turns

    def alone(self, row: int) -> JumpingRows:
        """What one row does without the others."""
        return JumpingRows(self.curves[row : row + 1], self.jumps, self.turns, self.bends)

    def each(self, phases: Array, theta: Array) -> Array:
        """Values (m, ..., P, C) of every row at phases (..., m) and crank angles (..., P)."""
        pairs = zip(self.curves, np.moveaxis(phases, -1, 0), strict=True)
        return np.array([curve(theta + phase[..., None]) for (curve, _), phase in pairs])

    def slopes(self, phases: Array, theta: Array) -> Array:
        """Derivatives of the values by the crank angle, (m, ..., P, C)."""
        pairs = zip(self.curves, np.moveaxis(phases, -1, 0), strict=True)
        return np.array([slope(theta + phase[..., None]) for (_, slope), phase in pairs])

    def edges(self, phases: Array) -> Array:
        """Crank angles (..., 2 m (J + B)) beside jumps and bends of all rows at phases (..., m)."""
        at = np.concatenate([self.jumps, self.bends]) - phases[..., None]
        sides = at[..., None] + JUMP_OFFSET * self.turns * np.array([-1.0, 1.0])
        return sides.reshape(*phases.shape[:-1], -1)

    def values(self, phases: Array, measure: str) -> Array:
        """Peak or peak to peak (...) of the sum of all rows at phases (..., m), rad."""
        flat = np.reshape(phases, (-1, phases.shape[-1]))
        step = max(1, int(AT_ONCE * SPACING / self.period))
        parts = [self._values(flat[k : k + step], measure) for k in range(0, len(flat), step)]
        return np.concatenate(parts).reshape(phases.shape[:-1])

    def _values(self, phases: Array, measure: str) -> Array:
        high = self._highest(phases, 1.0)
        if self.is_vector:
            return high
        low = self._highest(phases, -1.0)
        return high + low if measure == "peak_to_peak" else np.maximum(high, low)

    def rms(self, phases: Array, about_mean: bool = False) -> float:
        """RMS of the sum of all rows at phases (m,), rad, or that about its mean."""
        grid = np.arange(round(self.period / SPACING)) * SPACING
        jumps, bends = (np.subtract.outer(at, phases).ravel() for at in (self.jumps, self.bends))
        sampling = JumpSampling.of(grid, self.turns, jumps, bends)
        total = np.sum(self.each(phases, sampling.crank_angle), axis=0)
        shares = sampling.shares[:, None]
        if about_mean:
            total = total - np.sum(shares * total, axis=0)
        return float(np.sqrt(np.sum(shares * total**2)))

    @property
    def is_vector(self) -> bool:
        """Whether it has several components, of which the size counts."""
        return bool(self.curves[0][0].c.shape[-1] > 1)

    def _sum(self, phases: Array, theta: Array, sign: float) -> Array:
        """Sum of all rows (..., P), times a sign; of a vector its size."""
        total = np.sum(self.each(phases, theta), axis=0)
        return np.asarray(
            np.linalg.norm(total, axis=-1) if self.is_vector else sign * total[..., 0]
        )

    def _highest(self, phases: Array, sign: float) -> Array:
        """Largest value (B,) of the sum, or of minus the sum (sign -1), at phases (B, m)."""
        best = np.max(self._sum(phases, self.edges(phases), sign), axis=1)
        owner, _, tops = self.tops(phases, sign)
        np.maximum.at(best, owner, tops)
        return np.asarray(best)

    def tops(
        self, phases: Array, sign: float, miss: float = SAMPLE_MISS
    ) -> tuple[Array, Array, Array]:
        """Tops between jumps at phases (B, m): of which, where, rad, and the values, (T,) each.

        near : share of the range by which a sample may be lower than the highest; 1 for all.
        """
        count = round(self.period / SPACING)
        spacing = self.period / count
        grid = np.broadcast_to(np.arange(count) * spacing, (len(phases), count))
        values = self._sum(phases, grid, sign)
        self._skip_jumps(phases, values)
        best, least = np.max(values, axis=1), np.min(values, axis=1)
        top = values >= (best - miss * (best - least))[:, None]
        top &= (values >= np.roll(values, 1, axis=1)) & (values >= np.roll(values, -1, axis=1))
        owner, place = np.nonzero(top)
        theta, reached = place * spacing, values[owner, place]
        for k in range(CLOSER):
            width = spacing / NARROWER**k
            neighbors = theta[:, None] + width * np.array([-1.0, 0.0, 1.0])
            before, here, after = self._sum(phases[owner], neighbors, sign).T
            bend = before - 2 * here + after
            way = np.divide(before - after, 2 * bend, out=np.zeros_like(bend), where=bend < 0)
            moved = theta + width * np.clip(way, -1.0, 1.0)
            result = self._sum(phases[owner], moved[:, None], sign)[:, 0]
            result = np.where(self._at_jump(phases[owner], moved), -np.inf, result)
            theta = np.where(result > reached, moved, theta)
            reached = np.maximum(result, reached)
        return owner, theta, reached

    def _skip_jumps(self, phases: Array, values: Array) -> None:
        """Give samples (B, N) that lie within a jump the lower of the values beside them.

        Jumps of two rows may coincide, of which rounding would take the one before the other.
        """
        count = values.shape[1]
        spacing = self.period / count
        at = (self.jumps - phases[..., None]).reshape(len(phases), -1)
        place = np.round(at / spacing).astype(int)
        owner, which = np.nonzero(np.abs(place * spacing - at) < self._within)
        place = place[owner, which]
        sides = [values[owner, (place + way) % count] for way in (-1, 1)]
        values[owner, place % count] = np.minimum(*sides)

    def _at_jump(self, phases: Array, theta: Array) -> Array:
        """Whether crank angles (T,) lie within a jump of some row at phases (T, m)."""
        at = (self.jumps - phases[..., None]).reshape(len(phases), -1)
        away = np.mod(theta[:, None] - at + self.period / 2, self.period) - self.period / 2
        return np.asarray(np.any(np.abs(away) < self._within, axis=1))

    @property
    def _within(self) -> float:
        """rad, from a jump, where no side of it is."""
        return JUMP_OFFSET * self.turns / 2

    # -- followed while phases change --------------------------------------------------------------

    def anchors(self, phases: Array, sign: float) -> tuple[Array, Array]:
        """Tops and sides of jumps at phases (m,): the row that each goes with, -1 of tops, and
        its crank angle, of a side in its row, rad; (P,) each.
        """
        _, theta, _ = self.tops(phases[None], sign, 1.0)
        sides = self.edges(np.zeros(1))
        rows = np.repeat(np.arange(len(phases)), len(sides))
        row = np.concatenate([np.full(len(theta), -1), rows])
        return row, np.concatenate([theta, np.tile(sides, len(phases))])

    def followed(self, phases: Array, row: Array, at: Array, sign: float) -> ValuesAndSlopes:
        """Values (P,) at anchors, times a sign, or sizes of a vector; slopes (P, m) by phases."""
        theta = at - np.where(row >= 0, phases[row], 0.0)
        each = self.each(phases, theta)  # (m, P, C)
        slope = np.moveaxis(self.slopes(phases, theta), 0, 1)  # (P, m, C)
        total = np.sum(each, axis=0)
        size = np.linalg.norm(total, axis=-1)
        along = np.full_like(total, sign)
        if self.is_vector:
            along = total / np.maximum(size, TINY)[:, None]
        by_phase = np.einsum("pmc,pc->pm", slope, along)
        # a side of a jump goes back as its row goes ahead
        carried = np.flatnonzero(row >= 0)
        by_phase[carried, row[carried]] -= np.sum(by_phase[carried], axis=1)
        return ValuesAndSlopes(size if self.is_vector else sign * total[:, 0], by_phase)


@dataclass(frozen=True, eq=False)
class JumpingDesigns:
    """Rows whose signals jump and are linear in K numbers, such as masses.

    each : of the machine without these numbers, and of a unit of each of them, 1 + K.
    """

    each: tuple[JumpingRows, ...]

    @classmethod
    def of(
        cls, read: Callable[[Array], Array], jumps: Array, turns: int, bends: Array
    ) -> JumpingDesigns:
        """From what gives values (1 + K, m, C, N) of all rows at crank angles (N,), rad."""

        def flat(theta: Array) -> Array:
            values = read(theta)
            return values.reshape(-1, *values.shape[2:])

        count = read(np.zeros(1)).shape[1]
        whole = JumpingRows.of(flat, jumps, turns, bends)
        places = range(0, len(whole.curves), count)
        return cls(tuple(replace(whole, curves=whole.curves[k : k + count]) for k in places))

    def of_numbers(self, places: Sequence[int]) -> JumpingDesigns:
        """Designs with some of the K numbers only."""
        return JumpingDesigns((self.each[0], *(self.each[1 + k] for k in places)))

    def at(self, numbers: Array) -> JumpingRows:
        """The rows with numbers (K,)."""
        from scipy.interpolate import PPoly

        start, curves = self.each[0], []
        for row, (curve, _) in enumerate(start.curves):
            pairs = zip(numbers.tolist(), self.each[1:], strict=True)
            cubics = curve.c + sum(number * item.curves[row][0].c for number, item in pairs)
            whole = PPoly(cubics, curve.x, extrapolate="periodic")
            curves.append((whole, whole.derivative()))
        return replace(start, curves=tuple(curves))


def smoothed(amplitudes: Array, turns: int) -> Array:
    """Amplitudes (..., K + 1) of signals averaged over nearby crank angles, to few orders.

    By Jackson's kernel, which is nowhere negative: the average is nowhere beyond the signal's
    extremes, so that what bounds its peak from below bounds the signal's.
    """
    count = SMOOTHED_ORDERS * turns
    k = np.arange(min(amplitudes.shape[-1], count))
    angle = pi / (count + 1)
    shares = (count - k + 1) * np.cos(angle * k) + np.sin(angle * k) / np.tan(angle)
    return np.asarray(amplitudes[..., : len(k)] * shares / (count + 1))
