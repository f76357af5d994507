"""Outputs of several rows by orders, each row at phase 0, and their measures at any phases.

A row whose crank is ahead by phi has the amplitudes Y_n exp(i n phi) (see `Periodic.shifted`).
Rows are equal linkages, so that all that differs between them is a lever: with (x, y, z) the place
of a row's drive pivot, a force F = (F_x, F_y, 0) in its plane has the moment (x, y, z) x F.

By Parseval's theorem the mean square of a sum is that of its orders, S_n = sum_k T_kn exp(i n
phi_k); peaks are looked for on the signal itself, as the largest of all its tops.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from math import pi
from typing import Any, Literal

import numpy as np

from equipoise.balancing.effects import Effects
from equipoise.balancing.jumping_rows import JumpingDesigns, JumpingRows, smoothed
from equipoise.balancing.objectives import LinearizationPoint, of_rows_alone, read, reading_of
from equipoise.balancing.rounding import NEARLY, TINY
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.kinematics.jumps import bends_of, jumps_of
from equipoise.mechanism.parts.balance import (
    GAUGES,
    Objective,
    Statistic,
    cost_factor,
    output_of,
    wrong_objective,
)
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import AT_ONCE, Array, Periodic, present
from equipoise.vibration.excitation import motion_of
from equipoise.vibration.forced import chosen_model, steady_speed
from equipoise.vibration.linkages import rows_of

Combine = Literal["sum", "squares"]

OF_ALL = ("forces", "drives", "rows", "gauges")
"""Groups of outputs to which every row adds."""
AREA_SAMPLES = 1440
"""In a turn, from which an area is summed: the kinks where a sine changes its sign cost 2e-6 of it.
"""
SAMPLES, SAMPLE_MISS, NEWTON_ROUNDS, REACH = 360, 0.03, 4, 0.03
"""In a turn, among which tops are looked for; share of the range by which a sample may miss its
top; steps of Newton's method from there, and how far they may lead, rad."""
OF_ORDER = 8
"""Samples of the highest order, at least: between two of them, no more than one top."""
PENALTY = 1e3
"""On a limit that is passed by its own size: far more than phases can gain of objectives, each of
which counts as 1 times its weight before."""
NOTHING = 1e-12
"""Share of the loudest at which an amplitude or a value is rounding."""


@dataclass(frozen=True, eq=False)
class RowSignals:
    """What every row adds to an output while its phase is 0.

    amplitudes : complex (V, m, C, K + 1) of V speeds, m rows, C components (two of a vector) and
        the orders 0 to K of the period, in the output's unit.
    turns : of the crank in one period.
    jumping : the same as functions of the crank angle, where forces jump and all orders count.
    """

    amplitudes: Array
    turns: int = 1
    jumping: JumpingRows | None = None

    @property
    def orders(self) -> Array:
        """Order of each amplitude, events in one turn of the crank, (K + 1,)."""
        return np.arange(self.amplitudes.shape[-1]) / self.turns

    def turned(self, phases: Array) -> Array:
        """Amplitudes (..., V, m, C, K + 1) of each row at phases (..., m), rad."""
        turning = np.exp(1j * np.multiply.outer(phases, self.orders))
        return np.asarray(self.amplitudes * turning[..., None, :, None, :])

    def total(self, phases: Array) -> Array:
        """Amplitudes (..., V, C, K + 1) of the sum of all rows at phases (..., m), rad."""
        turning = np.exp(1j * np.multiply.outer(phases, self.orders))
        return np.asarray(np.einsum("vkcn,...kn->...vcn", self.amplitudes, turning))

    def alone(self, row: int) -> RowSignals:
        """What one row does without the others."""
        jumping = None if self.jumping is None else self.jumping.alone(row)
        return RowSignals(self.amplitudes[:, row : row + 1], self.turns, jumping)


@dataclass(frozen=True, eq=False)
class PhasedRows:
    """The rows of a machine, at the constant speed of its drive."""

    machine: Machine

    def signals(self, objective: Objective, where: str = "objective") -> RowSignals:
        """An objective's output of each row, by the orders that count.

        Shaking force, moment, drive torque, force and moment on the frame; ``roll_moment`` and
        ``yaw_moment``, those of the shaking force about the axes x and y through the drive's pivot;
        ``gauges.NAME``, a displacement (m) or rotation (rad) without its mean.

        Raises
        ------
        UsageError : the output is that of one row, which no phase changes.
        ModelError : there is no such output, or its measure cannot be taken; `where` it stands.
        MassError, MotionError, ResponseError : the machine cannot be computed.
        """
        for problem in wrong_objective(where, objective, self.machine):
            raise problem
        output = objective.output
        declared = output_of(output, self.machine)
        if declared.group not in OF_ALL or declared.needs == "planes":
            raise UsageError(
                Note(
                    "{output} acts within one row, so that no phase changes it; choose an "
                    "output of all rows",
                    output=output,
                )
            )
        if output.startswith(GAUGES):
            chosen_model(self.machine, None, False)  # refuses a machine without a support
            speeds = [steady_speed(self.machine, v, False) for v in objective.speeds or (None,)]
            for speed in speeds:
                self._point.linear.motion(speed)  # refuses what resonates, or drives it away
            objective = replace(objective, speeds=tuple(speeds))
        (amplitudes,) = of_each_row(self._effects, objective, self._point)
        designs = jumping_designs(self._effects, objective)
        jumping = None if designs is None else designs.each[0]
        return RowSignals(amplitudes, self._effects.motion.turns, jumping)

    @cached_property
    def _effects(self) -> Effects:
        return Effects(self.machine, [], motion_of(self.machine))

    @cached_property
    def _point(self) -> LinearizationPoint:
        return LinearizationPoint(self.machine)


def jumping_designs(effects: Effects, objective: Objective) -> JumpingDesigns | None:
    """What an objective reads of every row in phase 0, by the free numbers, as functions of the
    crank angle; None where nothing jumps, or some orders or a gauge count, of which nothing does.
    """
    jumps = jumps_of(effects.motion.linkage)
    if not len(jumps) or objective.orders or objective.output.startswith(GAUGES):
        return None

    def at(theta: Array) -> Array:
        rows = of_rows_alone(effects.at_angles(theta), objective.output, objective.about)
        values = np.array([np.vstack([row.start, row.columns]) for row in rows])
        parts = [values.real, values.imag] if np.iscomplexobj(values) else [values]
        return np.moveaxis(np.stack(parts, axis=2), 1, 0)

    turns = effects.motion.turns
    return JumpingDesigns.of(at, jumps, turns, bends_of(effects.motion.linkage, turns))


def of_each_row(effects: Effects, objective: Objective, point: LinearizationPoint) -> Array:
    """Amplitudes (1 + K, V, m, C, N) of what an objective reads: of every row as it is, and by a
    unit of each number, in phase 0.

    point : whose mass the support has to carry.
    """
    if objective.output.startswith(GAUGES):
        linear, row = reading_of(objective, point)
        rows = [replace(place, phase=0.0) for place in rows_of(point.machine)]
        speeds = objective.speeds or (effects.machine.drive.speed,)
        each = [[read(effects, linear, row, v, None, [item]) for item in rows] for v in speeds]
    else:
        each = [of_rows_alone(effects, objective.output, objective.about)]
    samples = np.array([[np.vstack([row.start, row.columns]) for row in rows] for rows in each])
    parts = [samples.real, samples.imag] if np.iscomplexobj(samples) else [samples]
    whole = np.moveaxis(np.stack(parts, axis=2), 3, 0)
    sampling, turns = each[0][0].sampling, each[0][0].turns
    periodic = Periodic.of(whole, turns) if sampling is None else sampling.periodic(whole)
    periodic = periodic.without_rounding()
    if not objective.orders:
        return periodic.amplitudes
    # Not of samples: between the crank angles that resolve jumps, what is left of them is smooth.
    near = np.isclose(periodic.orders[:, None], objective.orders, atol=NEARLY)
    return np.where(np.any(near, axis=1), periodic.amplitudes, 0.0)


def by_orders(measure: Statistic) -> bool:
    """Whether a measure follows from the sizes of the orders."""
    return measure in {"rms", "ripple"}


@dataclass(frozen=True, eq=False)
class PhaseObjective:
    """One objective as a function of the phases.

    signals : of each row, of the orders that count.
    scale : value that counts as one, in the output's unit.
    """

    objective: Objective
    signals: RowSignals
    scale: float = 1.0

    @property
    def measure(self) -> Statistic:
        return self.objective.measure

    def values(self, phases: Array) -> Array:
        """Value (...) at phases (..., m), rad; of several speeds the loudest."""
        if self.jumping is not None:
            return self.jumping.values(np.asarray(phases), self.measure)
        flat = phases.reshape(-1, phases.shape[-1])
        step = max(1, AT_ONCE // self._samples)
        parts = [
            np.max(self.each(self.signals.total(flat[k : k + step])), axis=-1)
            for k in range(0, max(len(flat), 1), step)
        ]
        return np.concatenate(parts).reshape(phases.shape[:-1])

    @property
    def jumping(self) -> JumpingRows | None:
        """The rows as functions of the crank angle, where extremes are measured that may jump."""
        return self.signals.jumping if self.measure in ("peak", "peak_to_peak") else None

    @property
    def smoothed(self) -> PhaseObjective:
        """A term of few orders that is nowhere larger; itself where nothing jumps."""
        if self.jumping is None:
            return self
        signals = RowSignals(
            smoothed(self.signals.amplitudes, self.signals.turns), self.signals.turns
        )
        return replace(self, signals=signals)

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

    @property
    def _samples(self) -> int:
        """Numbers that are held at a time to judge one set of phases."""
        speeds, rows, components, count = self.signals.amplitudes.shape
        in_time = max(SAMPLES * self.signals.turns, 2 * OF_ORDER * count)
        return int(max(speeds * components * in_time, rows * count))

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
        alone = [PhaseObjective(self.objective, self.signals.alone(k)) for k in rows]
        return float(sum(term.values(np.zeros(1)) for term in alone))

    def value_at(self, phases: Array) -> float:
        """Value at phases (m,), 0 where it is what rounding leaves of the rows' own.

        Mean squares of what jumps are those of its pieces, not of the orders that are kept.
        """
        value, jumping = float(self.values(phases)), self.signals.jumping
        if jumping is not None and by_orders(self.measure):
            value = jumping.rms(phases, self.measure == "ripple")
        return self.without_rounding(value)

    def without_rounding(self, value: float) -> float:
        """A value; 0 where it is what rounding leaves of the rows' own."""
        return value if value > NOTHING * self.single else 0.0

    @cached_property
    def influenced(self) -> bool:
        """Whether phases change the value: two rows must meet in the same order."""
        sizes = np.max(np.abs(self.signals.amplitudes), axis=(0, 2))
        loud = sizes[:, 1:] > NOTHING * max(float(np.max(sizes)), TINY)
        if by_orders(self.measure):
            return bool(np.any(np.sum(loud, axis=0) > 1))
        return int(np.sum(np.any(loud, axis=1))) > 1


@dataclass(frozen=True, eq=False)
class Cost:
    """Several objectives as one: their weighted sum, or the root of the weighted sum of squares,
    each over the value that counts as one; it rises steeply where limits are more than their scale.
    """

    terms: tuple[PhaseObjective, ...]
    combine: Combine = "sum"
    limits: tuple[PhaseObjective, ...] = ()

    @property
    def measured(self) -> tuple[PhaseObjective, ...]:
        """Everything whose value counts."""
        return (*self.terms, *self.limits)

    @property
    def rows(self) -> int:
        return int(self.terms[0].signals.amplitudes.shape[1])

    @property
    def period(self) -> float:
        """By which a phase may change without any effect, rad."""
        return 2 * pi * self.terms[0].signals.turns

    @cached_property
    def factors(self) -> Array:
        """What each term is multiplied by before all are combined."""
        factors = [cost_factor(term.objective.weight, self.combine) for term in self.terms]
        return np.array(factors) / [term.scale for term in self.terms]

    def values(self, phases: Array) -> Array:
        """Combined value (...) at phases (..., m), rad."""
        return self.of([term.values(phases) for term in self.measured])

    def of(self, values: Sequence[Any]) -> Array:
        """Combined value (...) of the values (...) of all terms, and of all limits."""
        parts = [factor * np.asarray(x) for factor, x in zip(self.factors, values, strict=False)]
        over = zip(self.limits, values[len(parts) :], strict=False)
        beyond = sum(PENALTY * np.maximum(np.asarray(x) / item.scale - 1, 0.0) for item, x in over)
        if self.combine == "sum" or len(parts) == 1:
            return np.asarray(sum(parts) + beyond)
        return np.asarray(np.sqrt(sum(part**2 for part in parts)) + beyond)

    @property
    def smoothed(self) -> Cost:
        """A cost that is nowhere larger, of terms that do not jump."""
        terms, limits = (
            tuple(item.smoothed for item in some) for some in (self.terms, self.limits)
        )
        return replace(self, terms=terms, limits=limits)

    @property
    def whole(self) -> float:
        """Combined value where every objective has the value that counts as one."""
        return float(self.of([term.scale for term in self.terms]))

    @property
    def smooth(self) -> bool:
        """Whether mean squares at one speed each are all there is."""
        return not self.limits and all(
            by_orders(term.measure) and len(term.signals.amplitudes) == 1 for term in self.terms
        )


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
    owner, start, best = tops(flat, SAMPLE_MISS)
    np.maximum.at(best, owner, _at(flat, owner, followed(flat, owner, start, REACH)))
    return best.reshape(signal.amplitudes.shape[:-1])


def tops(flat: Periodic, miss: float) -> tuple[Array, Array, Array]:
    """Tops among samples of signals (B,): of which signal, and where, rad, (T,) each; and the
    highest sample (B,) of every signal.

    near : share of the range by which a top may be lower than the highest; 1 for all of them.
    """
    count = max(SAMPLES * flat.turns, OF_ORDER * flat.amplitudes.shape[-1])
    values = flat.samples(count)
    best, least = np.max(values, axis=1), np.min(values, axis=1)
    top = values >= (best - miss * (best - least))[:, None]
    top &= (values >= np.roll(values, 1, axis=1)) & (values >= np.roll(values, -1, axis=1))
    owner, place = np.nonzero(top)
    return owner, place * (flat.period / count), best


def followed(flat: Periodic, owner: Array, start: Array, reach: float) -> Array:
    """Crank angles (T,) of the tops of signals `owner` (T,) by Newton's method, within a reach of
    where they are nearly, rad.
    """
    theta, slope, bend = start, flat.derivative(), flat.derivative(2)
    for _ in range(NEWTON_ROUNDS):
        down, curve = _at(slope, owner, theta), _at(bend, owner, theta)
        step = np.divide(-down, curve, out=np.zeros_like(down), where=curve < 0)
        theta = np.clip(theta + step, start - reach, start + reach)
    return theta


def _at(signal: Periodic, owner: Array, theta: Array) -> Array:
    """Values (T,) of signals `owner` (T,) at crank angles (T,)."""
    places = present(signal.amplitudes)
    orders, amplitudes = signal.orders[places], signal.amplitudes[:, places]
    step = max(1, AT_ONCE // max(len(orders), 1))
    values = np.empty(len(theta))
    for k in range(0, len(theta), step):
        some = slice(k, k + step)
        turning = np.exp(1j * np.outer(theta[some], orders))
        values[some] = np.sum((amplitudes[owner[some]] * turning).real, axis=1)
    return values
