"""Small motion of the support, by orders: what its gauges read, and how its mounts push."""

from __future__ import annotations

from functools import reduce
from operator import add

import numpy as np

from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.steps import size_of_bodies
from equipoise.mechanism.dynamics.forces import forces
from equipoise.signals import Array, Periodic
from equipoise.vibration.hand_held import hand_vibration
from equipoise.vibration.linear import Linear, gauges_of
from equipoise.vibration.linkages import rows_of
from equipoise.vibration.response import DriveSignals, GaugeSignals, MountForce, Response

NEUTRAL = 1e-9
"""Growth of a mode, beside its frequency, up to which it is rounding."""


def respond_linear(linear: Linear, speed: float) -> Response:
    """Response of a linear step, by orders."""
    body = linear.body
    moved = linear.motion(speed)
    moving = moved.derivative() * speed
    mounts, notes = mount_forces(linear, moved, moving, speed)
    notes.extend(linear.unsettled)
    if any(mode.eigenvalue.real > NEUTRAL * mode.natural_frequency for mode in linear.modes):
        template = to_say("the support is unstable: the drawn position is no stable equilibrium")
        notes.append(Note(template))
    return Response(
        body.machine,
        linear.excitation.model,
        speed,
        moved.turns,
        gauge_signals(linear, (moved, moving, moving.derivative() * speed), speed),
        mounts,
        linear.modes,
        DriveSignals(_torque(linear, speed), grounded=(body.machine, speed)),
        notes=tuple(notes),
        motion=linear.body.whole(moved),
    )


def gauge_signals(
    linear: Linear, motion: tuple[Periodic, Periodic, Periodic], speed: float
) -> dict[str, GaugeSignals]:
    """What gauges read of displacements, velocities and accelerations (D, K + 1), at a speed of
    the crank, rad/s.
    """
    signals, body = {}, linear.body
    for name, gauge in gauges_of(linear.body).items():
        row = linear.body.row(gauge)
        moved, moving, change = (linear.seen_by(row, item) for item in motion)
        along = tuple(
            linear.seen_by(body.wrench(axis, gauge.point), motion[2])
            for axis in (() if gauge.exposure is None else np.eye(3))
        )
        hand = hand_vibration(along, speed, gauge.exposure)
        signals[name] = GaugeSignals(moved, moving, change, gauge.axis is not None, hand)
    return signals


def mount_forces(
    linear: Linear, moved: Periodic, moving: Periodic, speed: float
) -> tuple[dict[str, MountForce], list[Note]]:
    """Forces of the mounts at small displacements and velocities (D, K + 1); and what to say."""
    exciting = force_amplitudes(linear, speed)
    mounts, notes = {}, []
    for name, mount in linear.body.support.mounts.items():
        row, preload = linear.body.row(mount), linear.rest.preload[name]
        force = linear.seen_by(row, moved) * -mount.spring
        force = force + linear.seen_by(row, moving) * -mount.damper
        template = ""
        if not linear.rest.carries(name, mount):
            force, preload = force * 0.0, 0.0
            template = to_say("{name} has no contact at rest and is ignored")
        elif mount.one_sided and force.extreme(-1)[0] + preload < 0:
            template = to_say(
                "{name} would be in tension, which a one-sided mount cannot transmit; the exact "
                "model includes the loss of contact"
            )
        if template:
            notes.append(Note(template, name=name))
        hands_on = exciting if mount.axis is None else exciting[:0]
        mounts[name] = mount_force(force, preload, hands_on)
    return mounts, notes


def mount_force(varying: Periodic, preload: float, exciting: Array) -> MountForce:
    """A mount's whole force, and what it hands on of the force that excites, (K + 1,).

    exciting : amplitudes of that force; empty for a torsional mount, which hands on none.
    """
    amplitudes = varying.amplitudes.copy()
    amplitudes[0] += preload
    count = min(len(amplitudes), len(exciting))
    ratio = np.full(len(amplitudes), np.nan)
    loud = exciting[:count] > 1e-9 * np.max(exciting, initial=0.0)
    loud[:1] = False
    np.divide(np.abs(amplitudes[:count]), exciting[:count], out=ratio[:count], where=loud)
    whole = float(np.sqrt(np.sum(exciting[1:] ** 2) / 2))
    force = Periodic(amplitudes, varying.turns)
    handed_on = float(force.vibration_rms) / whole if whole else np.nan
    return MountForce(force, ratio, handed_on, torsional=not exciting.size)


def force_amplitudes(linear: Linear, speed: float) -> Array:
    """Amplitude (K + 1,) of the force of all linkages on the frame; 0 where they cancel."""
    signals = (linear.excitation.at(speed), linear.excitation.of_one(speed))
    sizes, single = (np.linalg.norm(signal.amplitudes[:3], axis=0) for signal in signals)
    machine = linear.body.machine
    own = machine.mass * size_of_bodies(machine) * speed**2
    top = max(float(np.max(single[1:], initial=0.0)), own)
    rounding = 1e-10 * len(rows_of(machine)) * top
    return np.where(sizes > rounding, sizes, 0.0)


def _torque(linear: Linear, speed: float) -> Periodic:
    """Torque on all cranks on solid ground."""
    motion = linear.excitation.motion.at(speed)
    periodic = motion.periodic(forces(motion).drive_torque)
    return reduce(add, (periodic.shifted(row.phase) for row in rows_of(linear.body.machine)))
