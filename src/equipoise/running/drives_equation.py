"""The equations of motion of a machine of several drives, of which some follow from forces.

    M q.. + h = Q + T

Angles of drives with a motor, and of those that are free, are the unknowns; all others follow their
motion over the crank angle.  That is the angle of the first drive where it is such an unknown
itself, else it goes on evenly with time.  A drive with a given motion takes its torque T from
outside, as a servo motor that follows the crank would: nothing but its own link feels it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MassError, UsageError, at_place
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.machine import Machine
from equipoise.running.drivers import Driver
from equipoise.running.drives_friction import DrivesFriction, FrictionOf
from equipoise.running.drives_linkage import AppliedForces, DrivesPose, References, pose_of
from equipoise.running.sources import plus, sources_of
from equipoise.signals import Array


class DriveAngles(NamedTuple):
    """Angles of all drives (N, K), rad, and their rates.

    crank_angle : (K,) rad.  speeds : rad/s.  slopes : by the crank angle, of given motions, 0 of
    others.  bends : what given motions accelerate while the crank turns evenly, rad/s2, 0 of
    others.
    """

    crank_angle: Array
    angles: Array
    speeds: Array
    slopes: Array
    bends: Array


class DriveState(NamedTuple):
    """What acts in K states.

    inertia : (N, N, K) of links and motors, kg m2.  forces : of each source (S, N, K), N m.
    rubbing : friction in joints; None without.
    """

    pose: DrivesPose
    inertia: Array
    forces: Array
    rubbing: FrictionOf | None


@dataclass(frozen=True, eq=False)
class DrivesEquation:
    """A machine as a function of the angles and speeds of its drives.

    start : crank angle at the start, rad, where it goes on with time.

    Raises
    ------
    MassError : a link has no mass given.
    UsageError : no drive moves freely, or something acts that a run of several drives lacks.
    """

    machine: Machine
    start: float = 0.0

    def __post_init__(self) -> None:
        if missing := massless(self.machine):
            raise MassError(missing)
        if not self.unknowns:
            raise UsageError(
                at_place(
                    "drive",
                    Note(
                        "every drive follows a given motion, so that there is nothing to "
                        "integrate; give one of them a motor, or `free = true`"
                    ),
                )
            )
        if reason := next(_lacking(self.machine), None):
            raise UsageError(at_place(*reason))

    @property
    def drives(self) -> tuple[Drive | FurtherDrive, ...]:
        """All of them; the first one has the crank angle."""
        return self.machine.driven

    @cached_property
    def unknowns(self) -> tuple[int, ...]:
        """Places of the drives whose angles follow from forces."""
        return tuple(k for k, drive in enumerate(self.drives) if drive.moves_freely)

    @property
    def free(self) -> list[int]:
        """The same places, for arrays."""
        return [*self.unknowns]

    @cached_property
    def given(self) -> tuple[int, ...]:
        """Places of those that follow their motion."""
        return tuple(k for k in range(len(self.drives)) if k not in self.unknowns)

    @cached_property
    def by_crank(self) -> bool:
        """Whether the crank angle is an unknown, and not a matter of time."""
        return 0 in self.unknowns and self.machine.crank_turns

    @cached_property
    def linkage(self) -> Linkage:
        """The machine in the order in which it is computed."""
        return assemble(self.machine)

    @cached_property
    def sources(self) -> tuple[str, ...]:
        """Keys of what acts beside the drives and friction in joints."""
        return tuple(source.key for source in sources_of(self.machine))

    @cached_property
    def dyads(self) -> Mapping[str, str]:
        """Inner joints of dyads, and the values in a state that are 0 in their dead positions."""
        groups = self.linkage.groups
        return {group.joint: group.margin for group in groups if group.margin and not group.through}

    @cached_property
    def friction(self) -> DrivesFriction | None:
        """Friction in joints, where they have some."""
        if not self.machine.rubs:
            return None
        return DrivesFriction(self.linkage, abs(self.machine.drive.speed) or 1.0)

    @cached_property
    def rotors(self) -> tuple[float, ...]:
        """Moment of inertia of each drive's motor, as its link feels it, kg m2."""
        motors = (drive.motor for drive in self.drives)
        return tuple(0.0 if motor is None else motor.ratio**2 * motor.inertia for motor in motors)

    @property
    def nominal_speeds(self) -> list[float]:
        """Of each drive at crank angle 0, at the speed of the file, rad/s; of one whose motion
        begins at rest that of the crank.
        """
        crank = self.machine.drive.speed
        rates = [float(np.ravel(drive.turned(np.zeros(1))[1])[0]) for drive in self.drives]
        return [rate * crank or crank for rate in rates]

    def drivers(self) -> list[Driver]:
        """Of each drive, what turns it, at its start."""
        brakes = [self.machine.drive.brake, *[0.0] * len(self.machine.drives)]
        each = zip(self.drives, self.nominal_speeds, brakes, strict=True)
        return [Driver(drive.motor, speed, brake) for drive, speed, brake in each]

    def placed(self, time: Array, angles: Array, speeds: Array) -> DriveAngles:
        """All drives at times (K,), s, by the angles and speeds of the unknowns, each (U, K)."""
        pace = speeds[0] if self.by_crank else np.full(len(time), self.machine.drive.speed)
        crank = angles[0] if self.by_crank else self.start + pace * time
        whole = DriveAngles(crank, *np.zeros((4, len(self.drives), len(time))))
        whole.angles[self.free], whole.speeds[self.free] = angles, speeds
        for k in self.given:
            angle, first, second = self.drives[k].turned(crank)
            whole.angles[k], whole.speeds[k] = angle, first * pace
            whole.slopes[k], whole.bends[k] = first, second * pace**2
        return whole

    def factors_at(self, time: Array, since: float) -> list[Array]:
        """Factors (K,) of loads over time at times (K,), s, each on the line that it follows after
        an instant `since`.
        """
        return [load.line_after(since)(time) for load in self.machine.timed_loads]

    def at(self, time: Array, since: float, where: DriveAngles, near: References) -> DriveState:
        """What acts in K states.

        since : an instant, s, after which loads over time follow the line that counts.
        near : references in these states.

        Raises
        ------
        MotionError, ModelError : the machine cannot be there.
        """
        pose = pose_of(self.linkage, where.crank_angle, where.angles, where.speeds, near)
        pace = where.speeds[0] if self.by_crank else np.full(len(time), self.machine.drive.speed)
        applied = AppliedForces(pose, pace, self.factors_at(time, since))
        acting = {key: applied.demands(key) for key in self.sources}
        forces = np.zeros((len(self.sources), len(self.drives), pose.count))
        for k, demands in enumerate(acting.values()):
            forces[k] = pose.generalized(demands)
        rubbing = None
        if self.friction is not None:
            rubbing = self.friction.of(pose, plus(pose.turning, *acting.values()))
        return DriveState(pose, self.with_rotors(pose.inertia), forces, rubbing)

    def with_rotors(self, inertia: Array) -> Array:
        """Inertia (N, N, K), kg m2, of links with that of motors."""
        return inertia + np.diag(self.rotors)[:, :, None]

    def accelerations(
        self, state: DriveState, where: DriveAngles, torques: Array, settled: Array
    ) -> tuple[Array, Array]:
        """Of all drives (N, K), rad/s2, with torques (N, K) on those that are unknown, N m; and
        friction (J, K) in joints, N m or N.

        settled : (J,), as of `DrivesFriction.senses`.

        Raises
        ------
        LockError : friction locks the machine.
        """
        free, inertia, count = self.free, state.inertia, torques.shape[1]
        following = np.zeros((len(self.drives), len(free), count))
        following[free, range(len(free))] = 1.0
        if self.by_crank:
            following[:, 0] += where.slopes
        left = np.sum(inertia[free][:, :, None] * following[None], axis=1)
        acting = state.forces.sum(axis=0) + torques - state.pose.bias
        acting = (acting - np.sum(inertia * where.bends, axis=1))[free]
        if state.rubbing is None:
            changes = _eliminated(left, acting[:, None])[:, 0]
            return where.bends + np.sum(following * changes, axis=1), np.zeros((0, count))
        ways = state.rubbing.ways[:, free].transpose(1, 0, 2)
        both = _eliminated(left, np.concatenate([acting[:, None], ways], axis=1))
        moved = np.sum(following[:, :, None] * both, axis=1)
        whole, response = where.bends + moved[:, 0], moved[:, 1:]
        efforts = state.rubbing.efforts(settled, whole, response)
        return whole + np.sum(response * efforts, axis=1), efforts

    def given_torques(self, state: DriveState, accelerations: Array, efforts: Array) -> Array:
        """Of the drives with a given motion (G, N m) in K states (G, K)."""
        given = [*self.given]
        demand = np.einsum("ijk,jk->ik", state.inertia[given], accelerations)
        demand = demand + state.pose.bias[given] - state.forces[:, given].sum(axis=0)
        if state.rubbing is not None:
            demand = demand - np.einsum("jgk,jk->gk", state.rubbing.ways[:, given], efforts)
        return np.asarray(demand)

    def energy(self, angles: Array, speeds: Array, crank: Array, near: References) -> Array:
        """Kinetic energy (K,), J, of all drives at angles and speeds (N, K).

        crank : crank angles (K,), rad.  near : references there.
        """
        pose = pose_of(self.linkage, crank, angles, speeds, near)
        inertia = self.with_rotors(pose.inertia)
        return np.asarray(np.einsum("ik,ijk,jk->k", speeds, inertia, speeds) / 2)


def _eliminated(left: Array, right: Array) -> Array:
    """Solutions (U, R, K) of few equations (U, U, K) for R right-hand sides (U, R, K) by
    elimination of all states at once, for which an inertia needs no search for pivots.
    """
    left, right = left.copy(), right.copy()
    count = len(left)
    for k in range(count - 1):
        share = left[k + 1 :, k] / left[k, k]
        left[k + 1 :] -= share[:, None] * left[k]
        right[k + 1 :] -= share[:, None] * right[k]
    for k in reversed(range(count)):
        for j in range(k + 1, count):
            right[k] -= left[k, j] * right[j]
        right[k] /= left[k, k]
    return right


def _lacking(machine: Machine) -> Any:
    """What a run of several drives does not compute, with its place in the file."""
    if machine.rows:
        yield "rows", Note("a run of several drives computes one row; leave the others out")
    if machine.pushers:
        yield (
            "drive.stroke" if machine.drive.pushes else "drives",
            Note("a run of several drives computes no strokes; leave them out"),
        )
