"""Outputs of several rows by orders, each row at phase 0, so that phases only turn them.

A row whose crank is ahead by phi has the amplitudes Y_n exp(i n phi) (see `Periodic.shifted`).
Rows are equal linkages, so that all that differs between them is a lever: with (x, y, z) the place
of a row's drive pivot, a force F = (F_x, F_y, 0) in its plane has the moment (x, y, z) x F.
A change to the linkage is made in each of them: outputs of all rows are signals of one's numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from equipoise.balancing.effects import Effects
from equipoise.balancing.gauges import Near, gauge_signals
from equipoise.balancing.measures import Signal
from equipoise.errors import UsageError
from equipoise.mechanism.balance import Objective
from equipoise.mechanism.dynamics import forces, place_of
from equipoise.mechanism.kernels import cross
from equipoise.mechanism.model import Machine
from equipoise.mechanism.motion import Motion, move
from equipoise.mechanism.objectives import GAUGES, JOINTS, OF_ROWS, output_of, wrong_objective
from equipoise.mechanism.support import Row
from equipoise.results.analysis import Analysis
from equipoise.signals import Array, Periodic
from equipoise.vibration.forced import chosen_model, steady_speed, usual_step
from equipoise.vibration.linear import ANGLES, Linear, gauges_of
from equipoise.vibration.linkages import rows_of

SHAKING, FRAME = 0, 3
"""Among signals of one row: force x, y and moment about the drive's pivot, twice."""
UNIT = np.array([1.0, 1j, 0.0]), np.array([0.0, 0.0, 1.0])
"""Force and moment of which force x, y and moment are 1 in turn."""


@dataclass(frozen=True, eq=False)
class RowSignals:
    """What every row adds to an output while its phase is 0.

    amplitudes : complex (V, m, C, K + 1) of V speeds, m rows, C components (two of a vector) and
        the orders 0 to K of the period, in the output's unit.
    turns : of the crank in one period.
    """

    amplitudes: Array
    turns: int = 1

    @property
    def orders(self) -> Array:
        """Order of each amplitude, events in one turn of the crank, (K + 1,)."""
        return np.arange(self.amplitudes.shape[-1]) / self.turns

    def kept(self, orders: Sequence[float]) -> RowSignals:
        """The same with these orders only; with all of them if there are none."""
        if not orders:
            return self
        wanted = np.any(np.isclose(self.orders[:, None], orders, atol=1e-9), axis=1)
        return RowSignals(np.where(wanted, self.amplitudes, 0.0), self.turns)

    def turned(self, phases: Array) -> Array:
        """Amplitudes (..., V, m, C, K + 1) of each row at phases (..., m), rad."""
        turning = np.exp(1j * np.multiply.outer(phases, self.orders))
        turned: Array = self.amplitudes * turning[..., None, :, None, :]
        return turned

    def total(self, phases: Array) -> Array:
        """Amplitudes (..., V, C, K + 1) of the sum of all rows at phases (..., m), rad."""
        turning = np.exp(1j * np.multiply.outer(phases, self.orders))
        total: Array = np.einsum("vkcn,...kn->...vcn", self.amplitudes, turning)
        return total

    def alone(self, row: int) -> RowSignals:
        """What one row does without the others."""
        return RowSignals(self.amplitudes[:, row : row + 1], self.turns)


@dataclass(frozen=True, eq=False)
class Rows:
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
        if output.startswith(JOINTS):
            raise UsageError(
                f"{output} acts within one row, so that no phase changes it; choose an output of "
                "all rows"
            )
        if output.startswith(GAUGES):
            found = self._gauge(output.removeprefix(GAUGES), objective.speeds)
        else:
            rows, one = rows_of(self.machine), self._alike(output) or self._one
            levers = np.ones((len(rows), 1, 1))
            if one is self._one:
                levers = np.array([self._lever(output, row, objective.about) for row in rows])
            found = RowSignals((levers @ one.amplitudes)[None], one.turns)
        return found.kept(objective.orders)

    def _lever(self, output: str, row: Row, about: str | None) -> Array:
        """Rows (C, 6) by which an output reads the signals of one row."""
        first = FRAME if output.startswith("frame") else SHAKING
        kind = output.removeprefix("frame_").removeprefix("shaking_")
        whole = np.eye(6)[first : first + 3]
        if output.endswith("_moment"):
            arm = arm_of(self.machine, self._motion, row, about)
            return moment_of_row(output, row, arm, *UNIT)[None] @ whole
        return whole[{"force": [0, 1], "force.x": [0], "force.y": [1]}[kind]]

    @cached_property
    def _motion(self) -> Motion:
        planting = self.machine.planting
        sudden = bool(self.machine.loads) or (planting is not None and planting.soil is not None)
        return move(self.machine, ANGLES * (8 if sudden else 1), acceleration=0.0)

    @cached_property
    def _one(self) -> Periodic:
        """Signals of one row (6, K + 1), each cut off where its own rounding begins."""
        found = forces(self._motion)
        shaking, frame = found.shaking_force, found.frame_force
        signals = (shaking.x, shaking.y, found.shaking_moment, frame.x, frame.y, found.frame_moment)
        turns = self._motion.turns
        return Periodic(_padded([Periodic.of(one, turns).amplitudes for one in signals]), turns)

    def _alike(self, output: str) -> Periodic | None:
        """A signal (1, K + 1) that is the same wherever its row is, such as the drive torque."""
        one = output_of(output, self.machine)
        if one.needs == "rows" or one.about or one.dimension == "force":
            return None
        values = one.values(Analysis(self._motion, forces(self._motion)))
        return Periodic.of(values[None], self._motion.turns)

    def _gauge(self, name: str, speeds: Sequence[float]) -> RowSignals:
        chosen_model(self.machine, None, False)  # refuses a machine without a support
        linear = self._linear
        reading = linear.body.row(gauges_of(linear.body)[name])[linear.body.free]
        each = [
            _read(linear, reading, steady_speed(self.machine, speed, False))
            for speed in (speeds or (None,))
        ]
        return RowSignals(
            _padded([found[:, None] for found in each]), linear.excitation.motion.turns
        )

    @cached_property
    def _linear(self) -> Linear:
        return Linear.of(self.machine, usual_step(self.machine))


def arm_of(machine: Machine, motion: Motion, row: Row, about: str | None) -> complex:
    """From the point about which moments are taken to a row's drive pivot, m."""
    pivot = complex(*machine.frame[motion.linkage.pivot])
    return pivot + complex(*row.offset) - (pivot if about is None else place_of(machine, about))


def moment_of_row(output: str, row: Row, arm: complex, force: Array, moment: Array) -> Array:
    """What a row adds to a moment: (x, y, z) x F, with (x, y) the arm and z to the side, N m.

    force : complex, in the row's plane, N.  moment : of the row about its own drive pivot, N m.
    """
    if output == "roll_moment":
        return np.asarray(-row.lateral * force.imag)
    if output == "yaw_moment":
        return np.asarray(row.lateral * force.real)
    return np.asarray(moment + cross(arm, force))


def _padded(each: Sequence[Array]) -> Array:
    """Amplitudes (..., K + 1) of unequal K as one array, the short ones filled up with 0."""
    count = max(found.shape[-1] for found in each)
    whole = np.zeros((len(each), *each[0].shape[:-1], count), complex)
    for row, found in zip(whole, each, strict=True):
        row[..., : found.shape[-1]] = found
    return whole


def _read(linear: Linear, reading: Array, speed: float) -> Array:
    """What a reading (D,) of the free coordinates sees of each row, (m, K + 1), at a speed, rad/s.

    (K - (n w)^2 M + i n w C) q_n = W_n, whose matrices do not depend on the phases.  They are
    symmetric, so that the answer to the reading itself serves all rows.
    """
    linear.motion(speed)  # refuses what resonates, or drives the support away
    one = linear.excitation.of_one(speed)
    impedance = linear.impedance(one.orders[1:] * speed)
    along = np.broadcast_to(reading[:, None], (len(impedance), len(reading), 1))
    answer = np.zeros((6, len(one.orders)), complex)
    answer[linear.body.free, 1:] = np.linalg.solve(impedance, along)[..., 0].T
    rows = rows_of(linear.excitation.machine)
    found = np.zeros((len(rows), len(one.orders)), complex)
    for k, row in enumerate(rows):
        wrench = one.amplitudes.copy()
        wrench[3:] += np.cross((*row.offset, row.lateral), wrench[:3].T).T
        found[k] = np.sum(answer * wrench, axis=0)
    return found


def signals_of(effects: Effects, objective: Objective, near: Near) -> list[Signal]:
    """Signals whose largest measure an objective is: one for each speed at which it is read."""
    if objective.output.startswith("gauges."):
        return gauge_signals(effects, objective, near)
    read = of_all_rows if _counts_rows(effects, objective.output) else Effects.signal
    return [read(effects, objective.output, objective.about).kept(objective.orders)]


def _counts_rows(effects: Effects, output: str) -> bool:
    """Whether an output is that of all rows: of machines that have several, but within no row."""
    of_one = output.startswith((GAUGES, JOINTS))
    return output in OF_ROWS or (len(effects.machine.rows) > 1 and not of_one)


def of_all_rows(effects: Effects, output: str, about: str | None = None) -> Signal:
    """An output summed over all rows in their phases."""
    kind, _, axis = output.rpartition(".")
    if axis in {"x", "y"} and kind:
        whole = of_all_rows(effects, kind, about)
        part = np.real if axis == "x" else np.imag
        return Signal(part(whole.start), part(whole.columns), whole.turns)
    first = "frame" if output.startswith("frame") else "shaking"
    one = effects.signal(output if output not in OF_ROWS else "shaking_force")
    force = effects.signal(f"{first}_force")
    total = Signal(0.0 * one.start, 0.0 * one.columns, one.turns)
    if output in OF_ROWS:
        total = Signal(total.start.real, total.columns.real, one.turns)
    for row in effects.machine.rows:
        here = one
        if output.endswith("_moment"):
            arm = arm_of(effects.machine, effects.motion, row, about)
            start = moment_of_row(output, row, arm, force.start, one.start)
            columns = moment_of_row(output, row, arm, force.columns, one.columns)
            here = Signal(start, columns, one.turns)
        total = _added(total, ahead_by(here, row.phase))
    return total


def _added(one: Signal, other: Signal) -> Signal:
    return Signal(one.start + other.start, one.columns + other.columns, one.turns)


def ahead_by(signal: Signal, phase: float) -> Signal:
    """The signal ahead by a phase, rad."""
    count = len(signal.start)
    turning = np.exp(1j * phase * np.fft.fftfreq(count, 1 / count) / signal.turns)

    def turned(values: Array) -> Array:
        found: Array = np.fft.ifft(np.fft.fft(values) * turning)
        return found if np.iscomplexobj(values) else found.real

    return Signal(turned(signal.start), turned(signal.columns), signal.turns)
