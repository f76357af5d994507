"""The equations of motion of a machine's drives together with its support.

Displacements and rotation of the support are unknowns beside the angles of drives.  What acts
between links and frame, such as springs, motors and friction, acts on nothing but the drives, as
the frame moves with the support; weight, mounts and loads from outside act on both.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.steps import size_of_bodies
from equipoise.mechanism.parts.support import FREEDOMS
from equipoise.running.drive_angles import DriveAngles
from equipoise.running.drives_equation import DrivesEquation
from equipoise.running.drives_linkage import DrivesPose, References
from equipoise.running.mount_contacts import MountContacts
from equipoise.running.support_pose import SupportedPose
from equipoise.running.supported_bodies import SupportedBodies
from equipoise.signals import Array
from equipoise.vibration.body import Rest, SupportBody, contacts_of
from equipoise.vibration.linear import Linear
from equipoise.vibration.support_motion import SupportMotion
from equipoise.vibration.support_place import SpatialMounts, SupportPlace

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
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        _ = self.rest

    @cached_property
    def body(self) -> SupportBody:
        """The support."""
        return SupportBody(self.machine)

    @cached_property
    def rest(self) -> Rest:
        """What holds the machine in the drawn position, as of the exact model."""
        return Linear.of(self.machine).rest

    @property
    def coordinates(self) -> int:
        """How many: first of the drives, then of the support."""
        return len(self.drives) + len(self.body.free)

    @cached_property
    def unknowns(self) -> tuple[int, ...]:
        """Places of coordinates that follow from forces."""
        count, single = len(self.drives), self.machine.has_crank
        free = (k for k, drive in enumerate(self.drives) if drive.moves_freely or single)
        return (*free, *range(count, self.coordinates))

    @property
    def acting(self) -> tuple[str, ...]:
        """Keys of what acts beside the drives and friction in joints."""
        return (*super().acting, MOUNTS)

    @cached_property
    def mounted(self) -> SpatialMounts:
        """The mounts."""
        return SpatialMounts.of(self.body, contacts_of(self.body, self.rest))

    @cached_property
    def mounts(self) -> MountContacts:
        """The mounts, with what is known of them at the time."""
        return MountContacts(self.mounted, float(self.usual_sizes[0]), self.support_place)

    def support_motion(self, coordinates: Array, rates: Array) -> SupportMotion:
        """How the support moves, by coordinates (N + D, K) and their rates."""
        return SupportMotion(self.body, self.support_place(coordinates, rates), self.mounted)

    @cached_property
    def usual_sizes(self) -> Array:
        """Of a vibration (6,) in the order of `FREEDOMS`, m and rad."""
        moved = USUAL_TILT * float(size_of_bodies(self.machine))
        return np.array([moved] * 3 + [USUAL_TILT] * 3)

    def sizes(self) -> Array:
        """Usual sizes of the unknowns (U,): 1 of a drive's angle, and those of a vibration."""
        of_support = self.usual_sizes[self.body.free]
        drives = len(self.unknowns) - len(of_support)
        return np.concatenate([np.ones(drives), of_support])

    def support_place(self, coordinates: Array, rates: Array) -> SupportPlace:
        """Where the support is, by coordinates (N + D, K) and their rates."""
        place, rate = np.zeros((2, len(FREEDOMS), coordinates.shape[1]))
        drives = len(self.drives)
        place[self.body.free], rate[self.body.free] = coordinates[drives:], rates[drives:]
        return SupportPlace(place, rate)

    def pose(self, where: DriveAngles, references: References) -> SupportedPose:
        """Linkages and support with coordinates (N + D, R K) and their rates."""
        own = super().pose(where, references)
        at = self.support_place(where.angles, where.speeds)
        origins = self.rows.of_each(self._origins, own.count // self.rows.count)
        return SupportedPose(
            self.linkage, own.along, own.share, self.bodies, at, origins,
            where.speeds[: len(self.drives)], self._rotors_on_support,
        )  # fmt: skip

    @cached_property
    def bodies(self) -> SupportedBodies:
        """Links and support, as of one row."""
        return SupportedBodies(self.linkage, self.body, 1 / self.rows.count)

    @cached_property
    def _origins(self) -> Array:
        """(3, R), m, of the axes of the rows' linkages from the reference point."""
        offsets = self.rows.offsets
        at = np.array([offsets.real, offsets.imag, self.rows.laterals])
        return np.asarray(at - self.body.reference[:, None])

    @cached_property
    def _rotors_on_support(self) -> tuple[float, ...]:
        """Moment of inertia of each drive's motor times its ratio, and of the flywheel, kg m2."""
        motors = (drive.motor for drive in self.drives)
        each = [0.0 if motor is None else motor.ratio * motor.inertia for motor in motors]
        return each[0] + self.machine.drive.flywheel, *each[1:]

    @cached_property
    def rotors(self) -> tuple[float, ...]:
        """Moments of inertia of motors and flywheel as their links feel them, kg m2."""
        first, *others = super().rotors
        return first + self.machine.drive.flywheel, *others

    def mount_forces(self, pose: DrivesPose) -> Array:
        """Generalized force (1, N + D, R K) of all mounts, of which each row has its share."""
        assert isinstance(pose, SupportedPose)
        forces = np.zeros((1, self.coordinates, pose.count))
        forces[0, len(self.drives) :] = self.mounts.wrench(pose.at)[self.body.free]
        return forces / self.rows.count
