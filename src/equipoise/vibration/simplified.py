"""Simplified models of Yamashita, Ichikawa and Mori, by name: what the default one adds to them.

(59) ``linear``: the shaking force at the drive's pivot alone, whose moment is 0 for a support that
pitches about the crank's axis, however hard it is shaken.  (57) ``torque``: with the torque that
the drive takes from the support.  (54) ``coupled``: with the torque that the motion of the support
takes from the drive, too,

    M q.. + C q. + K q = W(theta) - T_r on pitch,   T_r = sum s'(theta) . a_A

W is force and torque on a support that stands still, as in (57), and a_A the acceleration of each
row's drive pivot, on a support that is not taken as turned, (53).  Its coefficients change with the
crank angle, so that it is no linear equation with constant coefficients.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from math import copysign, pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.dynamics.forces import Forces
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.signals import Array, Periodic
from equipoise.vibration.body import PITCH, SupportBody, rigid_mass
from equipoise.vibration.collocation import BoundaryConditions, Rates
from equipoise.vibration.excitation import SupportExcitation
from equipoise.vibration.linear import Linear, gauge_signals, mount_forces, respond_linear
from equipoise.vibration.linkages import rows_of
from equipoise.vibration.response import MODELS, ExcitationModel, Response, in_words
from equipoise.vibration.steady import ROUGH, SAMPLES, steady

# -- what linkages do ------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class PivotExcitation(SupportExcitation):
    """The shaking force at the drive's pivot, where the linkages' mass rides, (59).

    has_torque : whether the torque that the drive takes from the support is there, too, (57).
        Springs pull frame and links alike; left in, their torque on the drive would count.
    """

    has_torque: bool = False

    @property
    def model(self) -> ExcitationModel:
        return "torque" if self.has_torque else "linear"

    @property
    def rocks(self) -> bool:
        return False

    def _mass_of(self, row: Row) -> Array:
        arm = self.pivot_of(row) - self.body.reference
        return rigid_mass(self.machine.mass, arm, np.zeros((3, 3)))

    def _center_of(self, row: Row) -> Array:
        return self.pivot_of(row)

    def _moment(self, forces: Forces) -> Array:
        if self.has_torque:
            return -forces.drive_torque
        return np.zeros(len(forces.motion.crank_angle))


HAS_TORQUE: dict[str | None, bool] = {"linear": False, "torque": True, "coupled": True}
"""Of the models that stand on the force at the pivot: whether its torque is there, too."""


def linear_of(machine: Machine, model: str | None) -> Linear:
    """The linear system that a model stands on or is compared with: modes, rest, resonances.

    Raises
    ------
    UsageError : there is no such model.
    """
    check_model(model)
    if model not in HAS_TORQUE:
        return Linear.of(machine)
    return Linear(PivotExcitation(SupportBody(machine), HAS_TORQUE[model]))


def check_model(model: str | None) -> None:
    """Refuse the name of a model that there is not, with a `UsageError`."""
    if model is not None and model not in MODELS:
        names = ", ".join(MODELS)
        raise UsageError(
            Note("got the model {model!r}; give one of {names}", model=model, names=names)
        )


def response_by(model: ExcitationModel) -> Callable[[Linear, float], Response]:
    """What computes the response of a model of small motion, of its linear system at a speed."""
    return respond_coupled if model == "coupled" else respond_linear


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
        return self.linear.body.free_in_plane

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
        gauges=gauge_signals(linear, (moved, moving, change), speed),
        mounts=mount_forces(linear, moved, moving, speed)[0],
        motion=linear.body.whole(moved),
        residual=result.residual,
        multipliers=multipliers,
        notes=(*plain.notes, *in_words(multipliers)),
    )
