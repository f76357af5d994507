"""What a gauge of the support reads, as a signal that is linear in the free numbers.

The linkages' force and moment are linear in them.  How the support answers depends on its whole
mass, and with it on added masses: it is taken from a machine near the solution, with the derivative
by each number there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from equipoise.balancing.design_variables import (
    with_parameters,
)
from equipoise.balancing.effects import Effects
from equipoise.balancing.measures import Signal
from equipoise.errors import ModelError
from equipoise.mechanism.balance import Objective
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.model import Machine
from equipoise.mechanism.parameters import parameter_values
from equipoise.signals import Array, Periodic
from equipoise.vibration.forced import usual_step
from equipoise.vibration.linear import Linear, Step, gauges_of
from equipoise.vibration.linkages import rows_of

SAMPLES = 1440
"""Of a gauge's signal in a turn."""
PADDING, LIGHT, STEP, ROUNDING = 1.0, 1e-6, 1e-3, 1e-10
"""Inertia of all links by which a link is padded; mass, of that of all, which counts as none; a
difference's step, over the link's mass; and what of a difference is rounding."""


@dataclass(frozen=True, eq=False)
class Near:
    """A machine near the solution, and its numbers (K,); None where they are not known."""

    machine: Machine
    numbers: Array | None = None


def gauge_signals(effects: Effects, objective: Objective, near: Near) -> list[Signal]:
    """A gauge's displacement (m or rad, without its mean) at each of the objective's speeds."""
    like = near.machine
    if like.support is None:
        raise ModelError("support", "missing; a gauge needs a support that it stands on")
    linear = Linear.of(like, usual_step(like))
    gauges = gauges_of(linear.body)
    name = objective.output.removeprefix("gauges.")
    if name not in gauges:
        raise ModelError("support.gauges", unknown(name, gauges, "gauge"))
    row = linear.body.row(gauges[name])[linear.body.free]
    speeds = objective.speeds or (effects.machine.drive.speed,)
    signals = (_at(effects, linear, row, speed, near.numbers) for speed in speeds)
    return [signal.kept(objective.orders) for signal in signals]


def _at(
    effects: Effects, linear: Linear, row: Array, speed: float, numbers: Array | None
) -> Signal:
    wrench = _wrench(effects.at(speed), linear)  # (6, 1 + K, orders)
    frequency = wrench.orders[1:] * speed
    seen = np.linalg.solve(
        linear.impedance(frequency), np.broadcast_to(row[:, None], (len(frequency), len(row), 1))
    )
    amplitudes = np.zeros(wrench.amplitudes.shape[1:], complex)
    free = wrench.amplitudes[linear.body.free]
    amplitudes[:, 1:] = np.einsum("nd,dkn->kn", seen[..., 0], free[..., 1:])
    if numbers is not None and len(numbers):
        there = np.linalg.solve(linear.impedance(frequency), _sum(free, numbers)[..., None])
        mass, stiffness = _by_numbers(effects, linear.body.machine)
        impedance = stiffness[:, None] - frequency[:, None, None] ** 2 * mass[:, None]
        bent = np.einsum("nd,knde,ne->kn", seen[..., 0], impedance, there[..., 0])
        amplitudes[1:, 1:] -= bent
        amplitudes[0, 1:] += numbers @ bent
    samples = Periodic(amplitudes, wrench.turns).samples(SAMPLES * wrench.turns)
    return Signal(samples[0], samples[1:], wrench.turns)


def _sum(wrench: Array, numbers: Array) -> Array:
    """Wrench (orders, D) of the orders but the mean for given numbers."""
    found: Array = wrench[:, 0, 1:] + np.einsum("k,dkn->dn", numbers, wrench[:, 1:, 1:])
    return found.T


def supports_more(effects: Effects, machine: Machine) -> bool:
    """Whether what the support has to carry depends on the numbers."""
    mass, stiffness = _by_numbers(effects, machine)
    return bool(np.any(mass) or np.any(stiffness))


def _by_numbers(effects: Effects, machine: Machine) -> tuple[Array, Array]:
    """Mass and stiffness (K, D, D) that a unit of each number adds to the support, at a machine.

    By differences.  Links are padded with inertia, in which both are linear, so that all of them
    are bodies that there can be; and with mass where they have none.
    """
    step, padded = usual_step(machine), machine
    order = list(machine.links)
    values = parameter_values(machine).reshape(-1, 4).copy()
    whole = np.sum(values, axis=0)
    for link in {part.link for part in effects.parts}:
        own = values[order.index(link)]
        own += [whole[0] if own[0] < LIGHT * whole[0] else 0.0, 0.0, 0.0, PADDING * whole[3]]
        padded = with_parameters(padded, link, own)
    start = Linear.of(padded, step)
    mass, stiffness = [], []
    for part in effects.parts:
        own = values[order.index(part.link)]
        for row in part.effect:
            share = STEP * own[0] / max(whole[0], float(np.max(np.abs(row[:3]), initial=0.0)))
            ends = (own + share * row, own - share * row)
            one, other = (Linear.of(with_parameters(padded, part.link, e), step) for e in ends)
            mass.append((one.mass - other.mass) / (2 * share))
            stiffness.append((one.stiffness - other.stiffness) / (2 * share))
    return _tidy(np.array(mass), start.mass), _tidy(np.array(stiffness), start.stiffness)


def _tidy(columns: Array, whole: Array) -> Array:
    """Columns without what is rounding beside the whole."""
    return np.where(np.abs(columns) > ROUNDING * np.max(np.abs(whole)), columns, 0.0)


def _wrench(effects: Effects, linear: Linear) -> Periodic:
    """Wrench on the support: of what is there already, and of a unit of each number."""
    excitation = linear.excitation
    pivot = excitation.pivot
    force = effects.signal("frame_force").start - _weight_of(effects.machine)
    forces = np.vstack([force, effects.signal("shaking_force").columns])
    moments = _moments(effects, excitation.step, pivot)
    signals = np.stack([forces.real, forces.imag, moments])
    one = Periodic.of(signals, effects.motion.turns)
    total = None
    for place in rows_of(linear.body.machine):
        shape = one.amplitudes.shape
        flat = excitation.about_reference(one.amplitudes.reshape(3, -1), place)
        here = Periodic(flat.reshape(6, *shape[1:]), one.turns).shifted(place.phase)
        total = here if total is None else total + here
    assert total is not None
    return total


def _weight_of(machine: Machine) -> complex:
    return machine.mass * complex(*machine.gravity)


def _moments(effects: Effects, step: Step, pivot: complex) -> Array:
    """Moment (1 + K, N) about the drive's pivot, as the step has it."""
    if step == "linear":
        return np.zeros((1 + effects.count, len(effects.motion.crank_angle)))
    signal = effects.signal("drive_torque" if step == "torque" else "frame_moment")
    both = np.vstack([signal.start, signal.columns])
    if step == "torque":
        return -both
    weight = effects.weight_moment(pivot)
    means = np.mean(np.vstack([weight.start, weight.columns]), axis=1, keepdims=True)
    return np.asarray(both - means)
