"""Small motion of the support: by orders, and with the torque it takes from the drive (54).

    M q.. + C q. + K q = W(theta) - T_r on pitch,   T_r = sum s'(theta) . a_A

W is force and torque on a support that stands still, as in (57), and a_A the acceleration of each
row's drive pivot, on a support that is not taken as turned, (53).  Its coefficients change with the
crank angle, so that it is no linear equation with constant coefficients.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, reduce
from math import copysign, pi
from operator import add

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.steps import size_of_bodies
from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.kinematics.motion import move
from equipoise.signals import Array, Periodic
from equipoise.vibration.body import IN_PLANE, PITCH
from equipoise.vibration.collocation import BoundaryConditions, Rates
from equipoise.vibration.hand_held import hand_vibration
from equipoise.vibration.linear import Linear, gauges_of
from equipoise.vibration.linkages import rows_of
from equipoise.vibration.response import DriveSignals, GaugeSignals, MountForce, Response, in_words
from equipoise.vibration.steady import ROUGH, SAMPLES, steady

NEUTRAL = 1e-9
"""Growth of a mode, beside its frequency, up to which it is rounding."""


def respond_linear(linear: Linear, speed: float) -> Response:
    """Response of a linear step, by orders."""
    body = linear.body
    moved = linear.motion(speed)
    moving = moved.derivative() * speed
    mounts, notes = _mounts(linear, moved, moving, speed)
    notes.extend(linear.unsettled)
    if any(mode.eigenvalue.real > NEUTRAL * mode.natural_frequency for mode in linear.modes):
        said = to_say("the support is unstable: the drawn position is no stable equilibrium")
        notes.append(Note(said))
    return Response(
        body.machine,
        linear.excitation.model,
        speed,
        moved.turns,
        _gauges(linear, (moved, moving, moving.derivative() * speed), speed),
        mounts,
        linear.modes,
        DriveSignals(_torque(linear, speed), grounded=(body.machine, speed)),
        notes=tuple(notes),
        motion=linear.body.whole(moved),
    )


def _gauges(
    linear: Linear, motion: tuple[Periodic, Periodic, Periodic], speed: float
) -> dict[str, GaugeSignals]:
    """What gauges read of displacements, velocities and accelerations (D, K + 1), at a speed of
    the crank, rad/s.
    """
    gauge_signals, body = {}, linear.body
    for name, gauge in gauges_of(linear.body).items():
        row = linear.body.row(gauge)
        moved, moving, change = (linear.seen_by(row, item) for item in motion)
        along = tuple(
            linear.seen_by(body.wrench(axis, gauge.point), motion[2])
            for axis in (() if gauge.exposure is None else np.eye(3))
        )
        hand = hand_vibration(along, speed, gauge.exposure)
        gauge_signals[name] = GaugeSignals(moved, moving, change, gauge.axis is not None, hand)
    return gauge_signals


def _mounts(
    linear: Linear, moved: Periodic, moving: Periodic, speed: float
) -> tuple[dict[str, MountForce], list[Note]]:
    """Forces of the mounts at small displacements and velocities (D, K + 1); and what to say."""
    exciting = force_amplitudes(linear, speed)
    mounts, notes = {}, []
    for name, mount in linear.body.support.mounts.items():
        row, preload = linear.body.row(mount), linear.rest.preload[name]
        force = linear.seen_by(row, moved) * -mount.spring
        force = force + linear.seen_by(row, moving) * -mount.damper
        said = ""
        if not linear.rest.carries(name, mount):
            force, preload = force * 0.0, 0.0
            said = to_say("{name} has no contact at rest and is ignored")
        elif mount.one_sided and force.extreme(-1)[0] + preload < 0:
            said = to_say(
                "{name} would be in tension, which a one-sided mount cannot transmit; the exact "
                "model includes the loss of contact"
            )
        if said:
            notes.append(Note(said, name=name))
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


# -- with the torque that the motion of the support takes from the drive ---------------------------


@dataclass(frozen=True, eq=False)
class Reduced:
    """States: free displacements (m, rad), then their velocities, of a planar support.

    linear : the system of step ``torque``.
    """

    linear: Linear
    speed: float

    @property
    def count(self) -> int:
        return 2 * len(self.free)

    @cached_property
    def free(self) -> tuple[int, ...]:
        """Which of surge, heave and pitch."""
        return tuple(IN_PLANE.index(number) for number in self.linear.body.free)

    @property
    def sense(self) -> float:
        """1 for a crank that turns counterclockwise, -1 for clockwise."""
        return copysign(1.0, self.speed)

    def rates(self, s: Array) -> Rates:
        """Derivatives of the states by s, the crank's turning, at s (P,)."""
        accelerations = self.accelerations(self.sense * s)

        def rates(states: Array) -> Array:
            moving = states[len(self.free) :]
            return np.concatenate([moving, accelerations(states)]) / abs(self.speed)

        return rates

    def accelerations(self, theta: Array) -> Rates:
        """Those of the free coordinates (D, ..., P) in m/s2 and rad/s2, by the states.

        theta : (P,) crank angles.
        """
        d, linear = len(self.free), self.linear
        wrench = linear.wrench_at(theta, self.speed)
        pull, inward = self._coupling(theta)

        def accelerations(states: Array) -> Array:
            place, rate = states[:d], states[d:]
            right = wrench.reshape(d, *(1,) * (states.ndim - 2), -1)
            right = right - np.einsum("ab,b...->a...", linear.stiffness, place)
            right = right - np.einsum("ab,b...->a...", linear.damping, rate)
            mass = np.broadcast_to(linear.mass, (*states.shape[1:], d, d)).astype(states.dtype)
            if PITCH in self.free:
                k = self.free.index(PITCH)
                mass[..., k, :] += pull.T
                right[k] = right[k] + inward * rate[k] ** 2
            solved = np.linalg.solve(mass, np.moveaxis(right, 0, -1)[..., None])[..., 0]
            return np.moveaxis(solved, -1, 0)

        return accelerations

    def _coupling(self, theta: Array) -> tuple[Array, Array]:
        """T_r = pull (D, P) . q.. - inward (P,) * pitch.^2."""
        machine = self.linear.body.machine
        reference = complex(*self.linear.body.reference[:2])
        pull, inward = np.zeros((3, len(theta))), np.zeros(len(theta))
        for row in rows_of(machine):
            motion = move(machine, theta + row.phase, self.speed, 0.0)
            first = sum(
                (link.mass or 0.0) * motion.mass_centers[name].place_1
                for name, link in machine.links.items()
            )
            arm = complex(*machine.frame[motion.linkage.pivot]) + complex(*row.offset) - reference
            pull += np.stack([first.real, first.imag, (np.conj(1j * arm) * first).real])
            inward += (np.conj(arm) * first).real
        return pull[list(self.free)], inward


def respond_coupled(linear: Linear, speed: float) -> Response:
    """Response by (54)."""
    system = Reduced(linear, speed)
    rough = linear.motion(speed).upto(ROUGH)

    def guess(s: Array) -> Array:
        theta = system.sense * s
        return np.concatenate([rough.values(theta), (rough.derivative() * speed).values(theta)])

    turns = rough.turns
    result = steady(system, [guess], turns, BoundaryConditions.periodic(system.count))
    theta = np.arange(SAMPLES * turns) * (2 * pi / SAMPLES)
    states = result.orbit.at(np.mod(system.sense * theta, 2 * pi * turns))
    moved, moving, change = (
        Periodic.of(part, turns)
        for part in (*np.split(states, 2), system.accelerations(theta)(states))
    )
    multipliers = result.multipliers(system.count)
    plain = respond_linear(linear, speed)
    return replace(
        plain,
        model="coupled",
        gauges=_gauges(linear, (moved, moving, change), speed),
        mounts=_mounts(linear, moved, moving, speed)[0],
        motion=linear.body.whole(moved),
        residual=result.residual,
        multipliers=multipliers,
        notes=(*plain.notes, *in_words(multipliers)),
    )
