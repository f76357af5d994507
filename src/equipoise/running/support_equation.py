"""The equations of motion of a machine's drives together with its support.

Displacements and rotation of the support are unknowns beside the angles of drives.  What acts
between links and frame, such as springs, motors and friction, acts on nothing but the drives, as
the frame moves with the support; weight, mounts and loads from outside act on both.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note, all_of
from equipoise.mechanism.assembly.steps import size_of_bodies
from equipoise.mechanism.parts.support import PLANAR
from equipoise.running.drive_angles import DriveAngles
from equipoise.running.drives_equation import DrivesEquation
from equipoise.running.drives_linkage import References, pose_of
from equipoise.running.mount_contacts import MountContacts
from equipoise.running.sources import AppliedSource, sources_of
from equipoise.running.support_pose import SupportedPose
from equipoise.signals import Array
from equipoise.vibration.body import (
    PITCH,
    MountContact,
    PlanarInertia,
    Rest,
    SupportBody,
    contacts_of,
)
from equipoise.vibration.linear import Linear
from equipoise.vibration.support_motion import SupportMotion

MOUNTS = "mounts"
"""In the works of a run: springs and dampers between support and ground."""
USUAL_TILT = 0.01
"""rad: the usual size of a vibration; displacements over the size of the machine."""


@dataclass(frozen=True, eq=False)
class SupportedEquation(DrivesEquation):
    """A machine as a function of the angles of its drives and of where its support is.

    The crank of a machine with a single drive is free where it has no motor.

    Raises
    ------
    MassError : a link has no mass given.
    ModelError : there is no support, or its mounts do not hold the machine.
    UsageError : something acts, or moves, that such a run lacks.
    """

    def __post_init__(self) -> None:
        self._refuse()
        super().__post_init__()
        _ = self.rest

    def _refuse(self) -> None:
        """Raise a `UsageError` where the support moves out of the plane."""
        out_of_plane = [Note(n) for n in self.body.support.coordinates if n not in PLANAR]
        if out_of_plane:
            note = Note(
                "a run with its support is for motion in the plane of the drawing; leave out "
                "{names}",
                names=all_of(out_of_plane),
            )
            raise UsageError(at_place("support.freedoms", note))

    @cached_property
    def body(self) -> SupportBody:
        """The support."""
        return SupportBody(self.machine)

    @cached_property
    def rest(self) -> Rest:
        """What holds the machine in the drawn position, as of the exact model."""
        return Linear.of(self.machine, "moment").rest

    @cached_property
    def support(self) -> PlanarInertia:
        """The support alone."""
        return self.body.in_plane

    @property
    def coordinates(self) -> int:
        """How many: first of the drives, then of the support."""
        return len(self.drives) + len(self.support.free)

    @cached_property
    def unknowns(self) -> tuple[int, ...]:
        """Places of coordinates that follow from forces."""
        count, single = len(self.drives), self.machine.has_crank
        free = (k for k, drive in enumerate(self.drives) if drive.moves_freely or single)
        return (*free, *range(count, self.coordinates))

    @cached_property
    def sources(self) -> tuple[AppliedSource, ...]:
        """What acts beside the drives, mounts and friction in joints."""
        mass, first, *_ = self.support
        return tuple(sources_of(self.machine, (mass / self.rows.count, first / self.rows.count)))

    @property
    def acting(self) -> tuple[str, ...]:
        """Keys of what acts beside the drives and friction in joints."""
        return (*super().acting, MOUNTS)

    @cached_property
    def contacts(self) -> tuple[MountContact, ...]:
        """The mounts."""
        return contacts_of(self.body, self.rest)

    @cached_property
    def mounts(self) -> MountContacts:
        """The mounts, with what is known of them at the time."""
        return MountContacts(self.contacts, float(self.usual_sizes[0]), self.place_and_rate)

    def support_motion(self, coordinates: Array, rates: Array) -> SupportMotion:
        """How the support moves, by coordinates (N + D, K) and their rates."""
        return SupportMotion(self.body, *self.place_and_rate(coordinates, rates), self.contacts)

    @cached_property
    def usual_sizes(self) -> Array:
        """Of a vibration (3,) along surge, heave and pitch, m, m and rad."""
        moved = USUAL_TILT * float(size_of_bodies(self.machine))
        return np.array([moved, moved, USUAL_TILT])

    def sizes(self) -> Array:
        """Usual sizes of the unknowns (U,): 1 of a drive's angle, and those of a vibration."""
        of_support = self.usual_sizes[[*self.support.free]]
        drives = len(self.unknowns) - len(of_support)
        return np.concatenate([np.ones(drives), of_support])

    def place_and_rate(self, angles: Array, speeds: Array) -> tuple[Array, Array]:
        """Displacements and velocities (3, K) of the support along surge, heave and pitch, by
        coordinates (N + D, K) and their rates.
        """
        place, rate = np.zeros((2, 3, angles.shape[1]))
        free, drives = [*self.support.free], len(self.drives)
        place[free], rate[free] = angles[drives:], speeds[drives:]
        return place, rate

    def pose(self, where: DriveAngles, near: References) -> SupportedPose:
        """Linkages and support with coordinates (N + D, R K) and their rates."""
        drives, rows = len(self.drives), self.rows
        angles, speeds = where.angles, where.speeds
        own = pose_of(self.linkage, where.crank_angle, angles[:drives], speeds[:drives], near)
        return SupportedPose(
            self.linkage, own.along, 1 / rows.count, self.support,
            *self.place_and_rate(angles, speeds),
            rows.of_each(rows.offsets, angles.shape[1] // rows.count),
        )  # fmt: skip

    def mount_forces(self, where: DriveAngles) -> Array:
        """Generalized force (1, N + D, K) of all mounts."""
        forces = np.zeros((1, *where.angles.shape))
        wrench = self.mounts.wrench(*self.place_and_rate(where.angles, where.speeds))
        forces[0, len(self.drives) :] = wrench[[*self.support.free]]
        return forces

    def with_rotors(self, inertia: Array) -> Array:
        """Inertia (N + D, N + D, K) with that of motors, which turn on the support."""
        whole, drives = np.array(inertia), len(self.drives)
        whole[:drives, :drives] = super().with_rotors(whole[:drives, :drives])
        if PITCH not in self.support.free:
            return whole
        pitch = drives + self.support.free.index(PITCH)
        for k, drive in enumerate(self.drives):
            if drive.motor is not None:
                both = drive.motor.ratio * drive.motor.inertia / self.rows.count
                whole[pitch, k] += both
                whole[k, pitch] += both
        return whole
