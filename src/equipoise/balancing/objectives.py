"""What an objective asks: its signals, of all rows and of gauges too, and measures of them.

A row adds to the moments of all rows what its linkage does, and its forces by a lever that follows
from its place.

The linkages' force and moment are linear in the free numbers.  How the support answers depends on
its whole mass, and with it on added masses: it is taken from a machine near the solution, with the
derivative by each number there.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, lru_cache, partial
from math import pi

import numpy as np

from equipoise.balancing.design_variables import with_parameters
from equipoise.balancing.effects import Effects, Signal
from equipoise.balancing.program import Affine, ConeRows, Program
from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.dynamics.parameters import parameter_values
from equipoise.mechanism.formulas.kernels import cross
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.balance import (
    GAUGES,
    OF_ROWS,
    WITHIN,
    Objective,
    Statistic,
    output_of,
    quantity_of,
)
from equipoise.mechanism.parts.links import in_frame
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.quantities import SI
from equipoise.signals import Array, JumpSampling, Periodic, Tops, mean, smooth_tops, stencils_above
from equipoise.vibration.body import gauges_of
from equipoise.vibration.linear import Linear
from equipoise.vibration.linkages import rows_of

ACROSS: Mapping[str, Callable[[Array], Array]] = {
    "roll_moment": np.real,
    "yaw_moment": np.imag,
    **dict.fromkeys(("rocking_moment", "frame_rocking_moment"), np.asarray),
}
"""Moments about x and y: what each is of the complex one."""
OWN = dict.fromkeys(OF_ROWS, "rocking_moment")
"""What each row adds of its own to what only rows have."""


def arm_of(machine: Machine, motion: Motion, row: Row, about: str | None) -> complex:
    """From the point about which moments are taken to a row's drive pivot, m."""
    pivot = complex(*machine.frame[motion.linkage.pivot])
    return (
        pivot + complex(*row.offset) - (pivot if about is None else in_frame(machine.frame, about))
    )


def moment_of_row(output: str, row: Row, arm: complex, force: Array, moment: Array) -> Array:
    """What a row adds to a moment: (x, y, z) x F, with (x, y) the arm and z to the side, N m.

    force : complex, in the row's plane, N.
    moment : of the row about its own drive pivot, or complex its rocking moment, N m.
    """
    if output in ACROSS:
        whole = 1j * row.lateral * force + moment
        return np.asarray(ACROSS[output](whole))
    return np.asarray(moment + cross(arm, force))


SAMPLES = 1440
"""Of a gauge's signal in a turn."""
PADDING, LIGHT, STEP, ROUNDING = 1.0, 1e-6, 1e-3, 1e-10
"""Inertia of all links by which a link is padded; mass, of that of all, which counts as none; a
difference's step, over the link's mass; and what of a difference is rounding."""


@dataclass(frozen=True, eq=False)
class LinearizationPoint:
    """A machine near the solution, and its numbers (K,); None where they are not known."""

    machine: Machine
    numbers: Array | None = None

    @cached_property
    def linear(self) -> Linear:
        """The support, linear, on which linkages act with their whole force and moment."""
        return Linear.of(self.machine)


def signals_of(effects: Effects, objective: Objective, point: LinearizationPoint) -> list[Signal]:
    """Signals whose largest measure an objective is: one for each speed at which it is read."""
    output, machine = objective.output, effects.machine
    if output.startswith(GAUGES):
        signals = _gauge_signals(effects, objective, point)
    elif output in OF_ROWS or (len(machine.rows) > 1 and not output.startswith(WITHIN)):
        signals = [of_all_rows(effects, output, objective.about)]
    else:
        signals = [effects.signal(output, objective.about)]
    return [signal.with_orders(objective.orders) for signal in signals]


def of_all_rows(effects: Effects, output: str, about: str | None = None) -> Signal:
    """An output summed over all rows in their phases."""
    rows = effects.machine.rows
    if effects.motion.sampling is None:
        each = of_rows_alone(effects, output, about)
        turned = [item.ahead_by(row.phase) for item, row in zip(each, rows, strict=True)]
    else:  # at each row's own crank angles
        by_phase = {
            phase: of_rows_alone(effects.of_row(phase), output, about)
            for phase in {row.phase for row in rows}
        }
        turned = [by_phase[row.phase][k] for k, row in enumerate(rows)]
    start, columns = sum(item.start for item in turned), sum(item.columns for item in turned)
    return replace(turned[0], start=np.asarray(start), columns=np.asarray(columns))


def of_rows_alone(effects: Effects, output: str, about: str | None = None) -> list[Signal]:
    """An output of every row by itself, in phase 0."""
    kind, _, axis = output.rpartition(".")
    if axis in {"x", "y"} and kind:
        part = np.real if axis == "x" else np.imag
        whole = of_rows_alone(effects, kind, about)
        return [replace(item, start=part(item.start), columns=part(item.columns)) for item in whole]
    machine = effects.machine
    force = effects.signal("frame_force" if output.startswith("frame") else "shaking_force")
    divided = force.divided(np.inf)
    if output not in OWN or machine.has_planes:
        divided = effects.signal(OWN.get(output, output))
    if not output.endswith("_moment"):
        return [divided] * len(rows_of(machine))
    signals = []
    for row in rows_of(machine):
        arm = arm_of(machine, effects.motion, row, about)
        there = moment_of_row(output, row, arm, force.start, divided.start)
        by_number = moment_of_row(output, row, arm, force.columns, divided.columns)
        signals.append(replace(divided, start=there, columns=by_number))
    return signals


# -- gauges of the support -------------------------------------------------------------------------


def _gauge_signals(
    effects: Effects, objective: Objective, point: LinearizationPoint
) -> list[Signal]:
    """A gauge's displacement (m or rad, without its mean) at each of the objective's speeds."""
    linear, row = reading_of(objective, point)
    speeds, rows = objective.speeds or (effects.machine.drive.speed,), rows_of(point.machine)
    return [read(effects, linear, row, speed, point.numbers, rows) for speed in speeds]


def reading_of(objective: Objective, point: LinearizationPoint) -> tuple[Linear, Array]:
    """The support near the solution, and a row (D,) that reads a gauge off its coordinates."""
    if point.machine.support is None:
        raise ModelError("support", Note("missing; a gauge needs a support that it stands on"))
    body, name = point.linear.body, objective.output.removeprefix(GAUGES)
    gauges = gauges_of(body)
    if name not in gauges:
        raise ModelError("support.gauges", unknown(name, gauges, "gauge"))
    return point.linear, body.row(gauges[name])[body.free]


def read(
    effects: Effects,
    linear: Linear,
    row: Array,
    speed: float,
    numbers: Array | None,
    rows: Sequence[Row],
) -> Signal:
    """What a reading (D,) of the free coordinates sees of some rows at a speed, rad/s."""
    wrench = _wrench(effects.at(speed), linear, rows)  # (6, 1 + K, orders)
    frequency = wrench.orders[1:] * speed
    along = np.broadcast_to(row[:, None], (len(frequency), len(row), 1))
    transfer = np.linalg.solve(linear.impedance(frequency), along)[..., 0]
    free = wrench.amplitudes[linear.body.free][..., 1:]
    amplitudes = np.zeros(wrench.amplitudes.shape[1:], complex)
    amplitudes[:, 1:] = np.einsum("nd,dkn->kn", transfer, free)
    if numbers is not None and len(numbers):
        whole = (free[:, 0] + np.einsum("k,dkn->dn", numbers, free[:, 1:])).T
        there = np.linalg.solve(linear.impedance(frequency), whole[..., None])[..., 0]
        mass, stiffness = _by_numbers(effects, linear)
        impedance = stiffness[:, None] - frequency[:, None, None] ** 2 * mass[:, None]
        bent = np.einsum("nd,knde,ne->kn", transfer, impedance, there)
        amplitudes[1:, 1:] -= bent
        amplitudes[0, 1:] += numbers @ bent
    samples = Periodic(amplitudes, wrench.turns).samples(SAMPLES * wrench.turns)
    return Signal(samples[0], samples[1:], wrench.turns)


def supports_more(effects: Effects, machine: Machine) -> bool:
    """Whether what the support has to carry depends on the numbers."""
    return any(
        np.any(by_number) for by_number in _by_numbers(effects, LinearizationPoint(machine).linear)
    )


@lru_cache(maxsize=2)  # all gauges and speeds ask for the same
def _by_numbers(effects: Effects, linear: Linear) -> tuple[Array, Array]:
    """Mass and stiffness (K, D, D) that a unit of each number adds to the support, at a machine.

    By differences.  Links are padded with inertia, in which both are linear, so that all of them
    are bodies that there can be; and with mass where they have none.
    """
    machine = linear.body.machine
    padded, order = machine, list(machine.links)
    values = parameter_values(machine).reshape(-1, 4).copy()
    whole = np.sum(values, axis=0)
    for link in {part.link for part in effects.parts}:
        own = values[order.index(link)]
        own += [whole[0] if own[0] < LIGHT * whole[0] else 0.0, 0.0, 0.0, PADDING * whole[3]]
        padded = with_parameters(padded, link, own)
    start = Linear.of(padded)
    mass, stiffness = [], []
    for part in effects.parts:
        own = values[order.index(part.link)]
        for row in part.effect:
            share = STEP * own[0] / max(whole[0], float(np.max(np.abs(row[:3]), initial=0.0)))
            ends = (own + share * row, own - share * row)
            item, other = (Linear.of(with_parameters(padded, part.link, e)) for e in ends)
            mass.append((item.mass - other.mass) / (2 * share))
            stiffness.append((item.stiffness - other.stiffness) / (2 * share))
    pair = np.array(mass), np.array(stiffness)
    for columns, everything in zip(pair, (start.mass, start.stiffness), strict=True):
        columns[np.abs(columns) <= ROUNDING * np.max(np.abs(everything))] = 0.0
    return pair


def _wrench(effects: Effects, linear: Linear, rows: Sequence[Row]) -> Periodic:
    """Wrench (6, 1 + K, orders) of rows on the support, without their weight: as they are, and of a
    unit of each number; the moment is about the drive's pivot.
    """
    excitation, machine = linear.excitation, effects.machine
    force = effects.signal("frame_force").start - machine.mass * complex(*machine.gravity)
    forces = np.vstack([force, effects.signal("shaking_force").columns])
    rocking = np.zeros(forces.shape, complex)
    if machine.has_planes:
        weight = 1j * excitation.across * complex(*machine.gravity)
        still = effects.signal("frame_rocking_moment").start - weight
        rocking = np.vstack([still, effects.signal("rocking_moment").columns])
    moments = _moments(effects, linear)
    signals = np.stack([forces.real, forces.imag, moments, rocking.real, rocking.imag])
    periodic = effects.motion.periodic(signals)
    flat, total = periodic.amplitudes.reshape(5, -1), Periodic(np.zeros((6, 1, 1)), periodic.turns)
    for place in rows:
        here = excitation.about_reference(flat, place).reshape(6, *periodic.amplitudes.shape[1:])
        total = total + Periodic(here, periodic.turns).shifted(place.phase)
    return total


def _moments(effects: Effects, linear: Linear) -> Array:
    """Moment on the frame (1 + K, N) about the drive's pivot, less the mean of the weight's."""
    signal = effects.signal("frame_moment")
    both = np.vstack([signal.start, signal.columns])
    weight = effects.weight_moment(linear.excitation.pivot)
    means = effects.motion.mean(np.vstack([weight.start, weight.columns]))[:, None]
    return np.asarray(both - means)


# -- measures --------------------------------------------------------------------------------------


def measured(values: Array, measure: Statistic, sampling: JumpSampling | None = None) -> float:
    """Measure of a signal (N,) over a whole cycle, equally spaced or of a sampling."""
    return float(measured_each(values, measure, sampling))


def measured_each(values: Array, measure: Statistic, sampling: JumpSampling | None = None) -> Array:
    """Measures (...) of signals (..., N) over a whole cycle, equally spaced or of a sampling."""
    shares = None if sampling is None else sampling.shares
    if measure == "ripple":
        return measured_each(values - mean(values, shares)[..., None], "rms", sampling)
    if measure == "rms":
        return np.asarray(np.sqrt(mean(np.abs(values) ** 2, shares)))
    if measure == "area":
        return np.asarray(2 * pi * mean(np.abs(values), shares))
    tops = partial(smooth_tops, 2 * pi) if sampling is None else sampling.tops
    if np.iscomplexobj(values):
        return _highest(np.abs(values), tops)
    high, deep = (_highest(sign * values, tops) for sign in (1, -1))
    return np.asarray(np.maximum(high, deep) if measure == "peak" else high + deep)


def _highest(values: Array, tops: Callable[[Array], Tops]) -> Array:
    highest, _ = tops(values.reshape(-1, values.shape[-1]))
    return highest.reshape(values.shape[:-1])


def unit_of(objective: Objective, machine: Machine) -> str:
    """SI unit of a measure of an output."""
    quantity = quantity_of(objective, machine)
    if quantity is None:  # the area under what is no torque
        return f"{output_of(objective.output, machine).unit} rad"
    return SI[quantity]


def mean_square_rows(signal: Signal, measure: Statistic) -> tuple[Array, Array]:
    """Matrix (R, K) and vector (R,), R <= K + 1, of which |matrix numbers + vector| is the RMS.

    By the orthogonal factor of all samples, so that few rows are left and no digits are lost as in
    a Gram matrix.
    """
    both = np.vstack([signal.columns, signal.start])
    shares = None if signal.sampling is None else signal.sampling.shares
    if measure == "ripple":
        both = both - mean(both, shares)[:, None]
    if shares is not None:
        both = both * np.sqrt(shares * len(shares))
    samples = np.concatenate([both.real, both.imag], axis=1) if np.iscomplexobj(both) else both
    upper = np.linalg.qr(samples.T, mode="r") / np.sqrt(both.shape[1])
    return upper[:, :-1], upper[:, -1]


def bound_measure(
    program: Program,
    numbers: Array,
    signal: Signal,
    measure: Statistic,
    bound: Affine,
    name: str = "",
) -> None:
    """Keep a measure of a signal at or below a bound.

    Parameters
    ----------
    numbers : (K,) places of the signal's numbers in the program.
    bound : one row; where it is a limit by itself, `name` is the limit's, in the bound's unit.
    """
    count, fixed = len(signal.start), Affine.fixed(1.0)
    value = Affine(signal.columns.T, numbers, signal.start)
    peaks = stencils_above if signal.sampling is None else signal.sampling.stencils_above
    if measure in {"rms", "ripple"}:
        matrix, vector = mean_square_rows(signal, measure)
        rows = _bounded_cones(bound, 1, Affine(matrix, numbers, vector))
        program.cones(rows, len(vector) + 1, name, Affine.fixed(np.eye(1, len(vector) + 1)[0]))
    elif measure == "peak" and np.iscomplexobj(signal.start):
        parts, starts = (
            np.stack([both.real, both.imag], axis=-1) for both in (signal.columns, signal.start)
        )
        inner = Affine(parts.reshape(len(parts), -1).T, numbers, starts.ravel())
        rows, slope = (
            _bounded_cones(bound, count, inner),
            Affine.fixed(np.tile([1.0, 0.0, 0.0], count)),
        )
        program.add_lazy_rows(ConeRows("second-order", rows, 3, name, slope, peaks=peaks))
    elif measure == "peak":
        for sign in (1.0, -1.0):
            slope = Affine.fixed(np.ones(count))
            block = ConeRows("nonnegative", bound + sign * value, 1, name, slope, peaks=peaks)
            program.add_lazy_rows(block)
    elif measure == "peak_to_peak":
        high, low = program.numbers(2)
        for place, sign in ((high, -1.0), (low, 1.0)):
            program.add_lazy_rows(
                ConeRows("nonnegative", Affine.of(place, 1.0) + sign * value, peaks=peaks)
            )
        program.nonnegative(bound - Affine.of([high, low], [1.0, 1.0]), name, fixed)
    else:
        from scipy import sparse

        sizes = program.numbers(count)
        columns, each = np.concatenate([sizes, numbers]), sparse.eye_array(count)
        for sign in (1.0, -1.0):
            factors = sparse.hstack([each, sign * value.factors])
            program.nonnegative(Affine(factors, columns, sign * value.constant))
        program.nonnegative(bound - Affine.of(sizes, signal.angles), name, fixed)


def _bounded_cones(bound: Affine, count: int, inner: Affine) -> Affine:
    """The bound as first row of each of `count` cones, followed by that cone's share of `inner`."""
    columns = np.concatenate([bound.columns, inner.columns])
    split = len(bound.columns)
    size = len(inner.constant) // count + 1
    factors, constant = np.zeros((count, size, len(columns))), np.zeros((count, size))
    factors[:, 0, :split], constant[:, 0] = bound.factors[0], bound.constant[0]
    factors[:, 1:, split:] = inner.factors.reshape(count, size - 1, -1)
    constant[:, 1:] = inner.constant.reshape(count, size - 1)
    return Affine(factors.reshape(count * size, -1), columns, constant.ravel())
