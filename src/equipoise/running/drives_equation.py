"""The equations of motion of a machine of several drives, of which some follow from forces.

    M q.. + h = Q + T

Angles of drives with a motor, and of those that are free, are the unknowns; all others follow their
motion over the crank angle.  That is the angle of the first drive where it is such an unknown
itself, else it goes on evenly with time.  A drive with a given motion takes its torque T from
outside, as a servo motor that follows the crank would: nothing but its own link feels it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MassError, UsageError, at_place
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.machine import Machine
from equipoise.running.drive_angles import DriveAngles
from equipoise.running.drivers import Driver
from equipoise.running.drives_friction import DrivesFriction, FrictionOf
from equipoise.running.drives_linkage import DrivesPose, References, pose_of, references_at
from equipoise.running.mount_contacts import MountContacts
from equipoise.running.sources import AppliedSource, SourceInputs, plus, sources_of
from equipoise.running.strokes import Strokes
from equipoise.signals import Array
from equipoise.vibration.support_motion import SupportMotion

NO_FREE_DRIVE = Note(
    "every drive follows a given motion, so that there is nothing to integrate; give one of them a "
    "motor, or `free = true`"
)
STROKES_ALONE = Note(
    "every drive follows a given stroke, so that there is nothing to integrate; "
    "`equipoise analyze` computes its motion and forces"
)


class DriveState(NamedTuple):
    """What acts in K states.

    where : all drives.  inertia : (N, N, K) of links and motors, kg m2.
    forces : of each of `DrivesEquation.acting` (S, N, K), N m, or N along a support.
    rubbing : friction in joints; None without.
    """

    pose: DrivesPose
    where: DriveAngles
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
        if reason := next(self.refusals(), None):
            raise UsageError(at_place(*reason))
        if missing := massless(self.machine):
            raise MassError(missing)
        if not self.unknowns:
            strokes_alone = all(drive.pushes for drive in self.drives)
            raise UsageError(at_place("drive", STROKES_ALONE if strokes_alone else NO_FREE_DRIVE))

    def refusals(self) -> Iterator[tuple[str, Note]]:
        """What such a run does not compute, with its place in the file."""
        if self.machine.rows:
            yield "rows", Note("a run of several drives computes one row; leave the others out")

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

    @property
    def coordinates(self) -> int:
        """How many coordinates the machine has: its drives come first."""
        return len(self.drives)

    def sizes(self) -> Array:
        """Usual sizes of the unknowns (U,): 1 of a drive's angle, rad."""
        return np.ones(len(self.unknowns))

    @cached_property
    def mounts(self) -> MountContacts:
        """Mounts of the support: none on a fixed frame."""
        return MountContacts((), 1.0, lambda coordinates, rates: (coordinates, rates))

    @cached_property
    def strokes(self) -> Strokes | None:
        """Drives that push as a given stroke has it; None without."""
        pushed = [k for k in self.given if self.drives[k].pushes]
        return Strokes(self.linkage, pushed, self.by_crank, self.start) if pushed else None

    @cached_property
    def by_crank(self) -> bool:
        """Whether the crank angle is an unknown, and not a matter of time."""
        return 0 in self.unknowns and self.machine.crank_turns

    @cached_property
    def linkage(self) -> Linkage:
        """The machine in the order in which it is computed."""
        return assemble(self.machine)

    @cached_property
    def sources(self) -> tuple[AppliedSource, ...]:
        """What acts beside the drives and friction in joints."""
        return tuple(sources_of(self.machine))

    @property
    def acting(self) -> tuple[str, ...]:
        """Keys of what acts beside the drives and friction in joints."""
        return tuple(source.key for source in self.sources)

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

    def support_motion(self, coordinates: Array, rates: Array) -> SupportMotion | None:
        """How the support moves, by coordinates (C, K) and their rates; None on a fixed frame."""
        return None

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

    def references_at_start(self) -> References:
        """References (..., 1) at the crank angle of the start, with all drives as the file has them
        there.

        Raises
        ------
        ResponseError : the links do not get there.
        """
        strokes = {} if self.strokes is None else self.strokes.references_at_start
        return {**references_at(self.linkage, self.start), **strokes}

    def references(self, state: DriveState) -> References:
        """What references have come to in K states (..., K)."""
        if self.strokes is None:
            return state.pose.references
        return {**state.pose.references, **self.strokes.references(state.where.angles)}

    def placed(self, time: Array, angles: Array, speeds: Array) -> DriveAngles:
        """All drives at times (K,), s, by the angles and speeds of the unknowns, each (U, K); those
        that push are NaN until `with_strokes` places them.
        """
        crank_speed = self._crank_speed(time, speeds)
        crank = angles[0] if self.by_crank else self.start + crank_speed * time
        count, free = self.coordinates, self.free
        whole = np.zeros((3, count, len(time)))  # angles, speeds and bias of accelerations
        jacobian, virtual = np.zeros((2, count, len(free), len(time)))
        jacobian[free, range(len(free))] = virtual[free, range(len(free))] = 1.0
        whole[0, free], whole[1, free] = angles, speeds
        for k in self.given:
            if self.drives[k].pushes:
                whole[:, k] = np.nan
                continue
            angle, first, second = self.drives[k].turned(crank)
            whole[:, k] = angle, first * crank_speed, second * crank_speed**2
            if self.by_crank:
                jacobian[k, 0] = first
        none = np.zeros((0, len(time)))
        return DriveAngles(
            crank, whole[0], whole[1], jacobian, whole[2], virtual, whole[1], none, none[:, None]
        )

    def with_strokes(self, time: Array, where: DriveAngles, near: References) -> DriveAngles:
        """All drives at times (K,), s, as of `placed`, with those that push.

        Raises
        ------
        MotionError : a stroke cannot be as long as it is to be.
        """
        if self.strokes is None:
            return where
        crank_speed = self._crank_speed(time, where.speeds[self.free])
        return self.strokes.placed(where, crank_speed, near)

    def _crank_speed(self, time: Array, speeds: Array) -> Array:
        """Speed of the crank (K,), rad/s, by those of the unknowns (U, K)."""
        return speeds[0] if self.by_crank else np.full(len(time), self.machine.drive.speed)

    def margins(self, state: DriveState) -> Array:
        """What falls to 0 (D, K) where a dyad, or a stroke, comes to its dead position, in the
        order of `dead_positions`.
        """
        dyads = state.pose.margins([*self.dyads.values()])
        if self.strokes is None:
            return dyads
        return np.vstack([dyads, self.strokes.margin(state.where.slopes)])

    @property
    def dead_positions(self) -> list[tuple[str, str]]:
        """What `margins` belong to: ``dead`` with the inner joint of a dyad, ``lever`` with the
        links that strokes move.
        """
        dyads = [("dead", joint) for joint in self.dyads]
        if self.strokes is None:
            return dyads
        return [*dyads, ("lever", ", ".join(self.strokes.links))]

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
        where = self.with_strokes(time, where, near)
        pose = self.pose(where.crank_angle, where.angles, where.speeds, near)
        crank_speed = self._crank_speed(time, where.speeds[self.free])
        inputs = SourceInputs(crank_speed, self.factors_at(time, since), pose.gravity)
        acting = [source.demands(pose.moving, inputs) for source in self.sources]
        forces = np.zeros((len(self.acting), self.coordinates, pose.count))
        for k, (source, demands) in enumerate(zip(self.sources, acting, strict=True)):
            forces[k] = pose.exerted(source, inputs, demands)
        forces[len(acting) :] = self.mount_forces(where)
        rubbing = None
        if self.friction is not None:
            rubbing = self.friction.of(pose, plus(pose.turning, *acting))
        return DriveState(pose, where, self.with_rotors(pose.inertia), forces, rubbing)

    def mount_forces(self, where: DriveAngles) -> Array:
        """Generalized forces (0, N, K) of mounts of the support: none on a fixed frame."""
        return np.zeros((0, *where.angles.shape))

    def pose(self, crank: Array, angles: Array, speeds: Array, near: References) -> DrivesPose:
        """The linkage as of `pose_of`."""
        return pose_of(self.linkage, crank, angles, speeds, near)

    def with_rotors(self, inertia: Array) -> Array:
        """Inertia (N, N, K), kg m2, of links with that of motors."""
        return inertia + np.diag(self.rotors)[:, :, None]

    def accelerations(
        self, state: DriveState, torques: Array, settled: Array
    ) -> tuple[Array, Array]:
        """Of all drives (N, K), rad/s2, with torques (N, K) on those that are unknown, N m; and
        friction (J, K) in joints, N m or N.

        settled : (J,), as of `DrivesFriction.senses`.

        Raises
        ------
        LockError : friction locks the machine.
        """
        where, inertia, count = state.where, state.inertia, torques.shape[1]
        demand = np.sum(inertia[:, :, None] * where.jacobian[None], axis=1)
        left = np.sum(where.virtual_speeds[:, :, None] * demand[:, None], axis=0)
        acting = state.forces.sum(axis=0) + torques - state.pose.bias
        acting = acting - np.sum(inertia * where.bias_accelerations, axis=1)
        known = np.sum(where.virtual_speeds * acting[:, None], axis=0)
        if state.rubbing is None:
            changes = _eliminated(left, known[:, None])[:, 0]
            return where.bias_accelerations + np.sum(where.jacobian * changes, axis=1), np.zeros(
                (0, count)
            )
        rubbing = np.einsum("nuk,jnk->ujk", where.virtual_speeds, state.rubbing.ways)
        both = _eliminated(left, np.concatenate([known[:, None], rubbing], axis=1))
        moved = np.sum(where.jacobian[:, :, None] * both, axis=1)
        whole, response = where.bias_accelerations + moved[:, 0], moved[:, 1:]
        efforts = state.rubbing.efforts(settled, whole, response)
        return whole + np.sum(response * efforts, axis=1), efforts

    def given_efforts(self, state: DriveState, accelerations: Array, efforts: Array) -> Array:
        """Torques, N m, and of strokes forces, N, of the drives with a given motion (G, K) in K
        states.
        """
        demand = np.einsum("ijk,jk->ik", state.inertia, accelerations)
        demand = demand + state.pose.bias - state.forces.sum(axis=0)
        if state.rubbing is not None:
            demand = demand - np.einsum("jgk,jk->gk", state.rubbing.ways, efforts)
        if self.strokes is not None:
            demand = self.strokes.efforts(state.where.slopes, demand)
        return np.asarray(demand[[*self.given]])

    def energy(self, angles: Array, speeds: Array, crank: Array, near: References) -> Array:
        """Kinetic energy (K,), J, of all drives at angles and speeds (N, K).

        crank : crank angles (K,), rad.  near : references there.
        """
        pose = self.pose(crank, angles, speeds, near)
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
