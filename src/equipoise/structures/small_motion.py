"""Small motion: response of the linear steps, by orders."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.mechanism.dynamics import forces
from equipoise.mechanism.support import Gauge
from equipoise.signals import Periodic
from equipoise.structures.linear import Linear, gauges_of
from equipoise.structures.linkages import rows_of
from equipoise.structures.response import DriveSignals, GaugeSignals, MountForce, Response

Array = np.ndarray[Any, Any]

NEUTRAL = 1e-9
"""Growth of a mode, beside its frequency, up to which it is rounding."""


def respond_linear(linear: Linear, speed: float) -> Response:
    """Response of a linear step, by orders."""
    body = linear.body
    moved = linear.motion(speed)
    gauges = {
        name: _differentiated(linear.seen_by(body.row(gauge), moved), gauge, speed)
        for name, gauge in gauges_of(body).items()
    }
    mounts, notes = linear_mounts(linear, moved, moved.derivative() * speed, speed)
    if any(mode.eigenvalue.real > NEUTRAL * mode.natural_frequency for mode in linear.modes):
        notes.append("the support falls over by itself: it does not stand in the drawn position")
    return Response(
        body.machine,
        linear.excitation.step,
        speed,
        moved.turns,
        gauges,
        mounts,
        linear.modes,
        DriveSignals(_torque(linear, speed)),
        notes=tuple(notes),
    )


def linear_mounts(
    linear: Linear, moved: Periodic, moving: Periodic, speed: float
) -> tuple[dict[str, MountForce], list[str]]:
    """Forces of the mounts at small displacements and velocities (D, K + 1); and what to say."""
    exciting = force_amplitudes(linear, speed)
    mounts, notes = {}, []
    for name, mount in linear.body.support.mounts.items():
        row, preload = linear.body.row(mount), linear.rest.preload[name]
        force = linear.seen_by(row, moved) * -mount.spring
        force = force + linear.seen_by(row, moving) * -mount.damper
        if not linear.rest.carries(name, mount):
            force, preload = force * 0.0, 0.0
            notes.append(f"{name} does not touch at rest, and is left out")
        elif mount.one_sided and force.extreme(-1)[0] + preload < 0:
            notes.append(f"{name} would have to pull, which it cannot; the model exact lets it go")
        hands_on = exciting if mount.axis is None else exciting[:0]
        mounts[name] = mount_force(force, preload, hands_on)
    return mounts, notes


def _differentiated(moved: Periodic, gauge: Gauge, speed: float) -> GaugeSignals:
    velocity = moved.derivative() * speed
    return GaugeSignals(moved, velocity, velocity.derivative() * speed, gauge.axis is not None)


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
    """Amplitude (K + 1,) of the force of all linkages on the frame; 0 where rows cancel."""
    whole = linear.excitation.at(speed)
    one = linear.excitation.of_one(speed)
    sizes, single = (np.linalg.norm(signal.amplitudes[:3], axis=0) for signal in (whole, one))
    rounding = 1e-10 * len(rows_of(linear.body.machine)) * np.max(single[1:], initial=0.0)
    return np.where(sizes > rounding, sizes, 0.0)


def _torque(linear: Linear, speed: float) -> Periodic:
    """Torque on all cranks on solid ground."""
    motion = linear.excitation.motion.at(speed)
    one = Periodic.of(forces(motion).drive_torque, motion.turns)
    return summed(one.shifted(row.phase) for row in rows_of(linear.body.machine))


def summed(signals: Any) -> Periodic:
    """Sum of one signal or more."""
    total = None
    for signal in signals:
        total = signal if total is None else total + signal
    assert total is not None
    return total  # type: ignore[no-any-return]
