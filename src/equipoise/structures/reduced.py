"""Equation (54): small motion of the support with the torque that its motion takes from the drive.

    M q.. + C q. + K q = W(theta) - T_r on pitch,   T_r = sum s'(theta) . a_A

W is force and torque on a support that stands still, as in (57), and a_A the acceleration of each
row's drive pivot, on a support that is not taken as turned, (53).  Its coefficients change with the
crank angle, so that it is no linear equation with constant coefficients.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import copysign, pi
from typing import Any

import numpy as np

from equipoise.mechanism.motion import move
from equipoise.signals import Periodic
from equipoise.structures.beginning import ROUGH
from equipoise.structures.collocation import Conditions, Rates
from equipoise.structures.linear import Linear, gauges_of
from equipoise.structures.linkages import rows_of
from equipoise.structures.readings import IN_PLANE, PITCH
from equipoise.structures.response import GaugeSignals, Response, told_of
from equipoise.structures.small_motion import linear_mounts, respond_linear
from equipoise.structures.steady import SAMPLES, steady

Array = np.ndarray[Any, Any]


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

    def rates(self, s: Array) -> Rates:
        """Derivatives of the states by s, the crank's turning, at s (P,)."""
        theta = self.sense * s
        wrench = self.linear.wrench_at(theta, self.speed)
        pull, inward = self._coupling(theta)

        def rates(states: Array) -> Array:
            d = len(self.free)
            found = self._accelerations(wrench, pull, inward, states)
            return np.concatenate([states[d:], found]) / abs(self.speed)

        return rates

    @property
    def sense(self) -> float:
        """1 for a crank that turns counterclockwise, -1 for clockwise."""
        return copysign(1.0, self.speed)

    def accelerations(self, theta: Array, states: Array) -> Array:
        """Of the free coordinates (D, P) at crank angles (P,), m/s2 and rad/s2."""
        wrench = self.linear.wrench_at(theta, self.speed)
        return self._accelerations(wrench, *self._coupling(theta), states)

    def _accelerations(self, wrench: Array, pull: Array, inward: Array, states: Array) -> Array:
        d = len(self.free)
        place, rate = states[:d], states[d:]
        right = wrench.reshape(d, *(1,) * (states.ndim - 2), -1)
        right = right - np.einsum("ab,b...->a...", self.linear.stiffness, place)
        right = right - np.einsum("ab,b...->a...", self.linear.damping, rate)
        mass = np.broadcast_to(self.linear.mass, (*states.shape[1:], d, d)).astype(states.dtype)
        if PITCH in self.free:
            k = self.free.index(PITCH)
            mass = mass.copy()
            mass[..., k, :] += pull.T
            right[k] = right[k] + inward * rate[k] ** 2
        solved = np.linalg.solve(mass, np.moveaxis(right, 0, -1)[..., None])[..., 0]
        return np.moveaxis(solved, -1, 0)

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
    moved = linear.motion(speed)

    def guess(s: Array) -> Array:
        theta, rough = system.sense * s, moved.upto(ROUGH)
        return np.concatenate([rough.values(theta), (rough.derivative() * speed).values(theta)])

    turns = moved.turns
    found = steady(system, [guess], turns, Conditions.periodic(system.count))
    theta = np.arange(SAMPLES * turns) * (2 * pi / SAMPLES)
    states = found.orbit.at(np.mod(system.sense * theta, 2 * pi * turns))
    d = len(states) // 2
    accelerations = system.accelerations(theta, states)
    parts = [Periodic.of(part, turns) for part in (states[:d], states[d:], accelerations)]
    body = linear.body
    rows = {name: (body.row(gauge), gauge.axis) for name, gauge in gauges_of(body).items()}
    gauges = {
        name: GaugeSignals(
            linear.seen_by(row, parts[0]),
            linear.seen_by(row, parts[1]),
            linear.seen_by(row, parts[2]),
            axis is not None,
        )
        for name, (row, axis) in rows.items()
    }
    multipliers = found.multipliers(system.count)
    plain = respond_linear(linear, speed)
    return replace(
        plain,
        model="coupled",
        gauges=gauges,
        mounts=linear_mounts(linear, parts[0], parts[1], speed)[0],
        residual=found.residual,
        multipliers=multipliers,
        notes=(*plain.notes, *told_of(multipliers)),
    )
