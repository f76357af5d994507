"""The equations of motion of a machine's drives together with its support, which moves in space.

Displacements and rotation of the support are unknowns beside the angles of drives.  What acts
between links and frame, such as springs, motors and friction, acts on nothing but the drives, as
the frame moves with the support; weight, mounts and loads from outside act on both.

In the support's axes, from its reference point, with b the place of a link's anchor, W the angular
velocity of the support, R its rotation and Z the displacement of the reference point, that has

    velocity       R^T Z.  + b.  + W x b
    acceleration   R^T Z.. + b.. + W. x b + 2 W x b. + W x (W x b)

and its link, which turns at w in the plane, the angular velocity W + w e and the acceleration
W. + w. e + W x w e, with e across the plane.  The support itself is one body more.  Links are
flat: their own inertia about an axis in the plane is half of that across it.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import p, size_of_bodies
from equipoise.mechanism.dynamics.forces import flywheel_on, inertia_about
from equipoise.mechanism.dynamics.friction import Demands
from equipoise.mechanism.dynamics.reactions import Acting
from equipoise.mechanism.parts.links import masses_of, moments_across
from equipoise.mechanism.parts.support import FREEDOMS
from equipoise.running.drives_equation import DrivesEquation, MountContacts
from equipoise.running.drives_linkage import DriveAngles, DrivesPose, References, inertial_of
from equipoise.running.sources import AppliedSource, SourceInputs
from equipoise.signals import Array
from equipoise.vibration.body import Rest, SupportBody, contacts_of
from equipoise.vibration.linear import Linear
from equipoise.vibration.support_motion import SpatialMounts, SupportMotion, SupportPlace, cross

MOUNTS = "mounts"
"""In the works of a run: springs and dampers between support and ground."""

USUAL_TILT = 0.01
"""rad: the usual size of a vibration; displacements over the size of the machine."""


@dataclass(frozen=True, eq=False)
class SupportedBodies:
    """L links that have a mass or an inertia, and at last the support.

    share : of the support, and of what turns with links, that such a linkage has.
    """

    linkage: Linkage
    body: SupportBody
    share: float

    @cached_property
    def links(self) -> list[str]:
        """Names of the links."""
        return [*inertial_of(self.linkage, self.share)]

    @cached_property
    def flywheels(self) -> Array:
        """Moments of inertia (L, 1) of what turns with links, kg m2, as it presses in joints."""
        each = [flywheel_on(self.linkage.machine, link) for link in self.links]
        return self.share * np.array(each)[:, None]

    @cached_property
    def _constants(self) -> Array:
        """Of each link (L, 1), complex where in its plane: mass, first moment from the anchor and
        that across the plane, half the inertia about the anchor, the integral of the squares of the
        plane's axes that turns twice as fast as the link, those of the plane's axes times that
        across, and of the square of that.
        """
        rows = []
        for name in self.links:
            link, anchor = self.linkage.machine.links[name], self.linkage.anchors[name]
            mass, moment, inertia = inertia_about(link, anchor)
            across, out_of_plane = moments_across(link, anchor)
            thickness = sum(part * plane**2 for part, _, plane in masses_of(link))
            twice = moment**2 / (2 * mass) if mass else 0j
            rows.append([mass, moment, across, inertia / 2, twice, out_of_plane, thickness])
        return np.array(rows, complex).reshape(-1, 7).T[..., None]

    def inertias(self, turn: Array) -> Array:
        """Mass matrices (L + 1, 6, 6, K) at the anchors, for translations before rotations, kg,
        kg m and kg m2.

        turn : unit vectors (L, K), complex, of the links.
        """
        mass, moment, across, half, twice, out_of_plane, thickness = self._constants
        matrices = np.zeros((len(turn) + 1, 6, 6, turn.shape[-1]))
        matrices[-1] = self.share * self.body.mass[..., None]
        own, even = matrices[:-1], half.real + thickness.real
        first, squares, tilted = moment * turn, twice * turn**2, -out_of_plane * turn
        for axis in range(3):
            own[:, axis, axis] = mass.real
        own[:, 3, 3], own[:, 4, 4] = even - squares.real, even + squares.real
        own[:, 5, 5] = 2 * half.real
        for row, column, value in (
            (0, 4, across.real), (0, 5, -first.imag), (1, 3, -across.real), (1, 5, first.real),
            (2, 3, first.imag), (2, 4, -first.real),
            (3, 4, -squares.imag), (3, 5, tilted.real), (4, 5, tilted.imag),
        ):  # fmt: skip
            own[:, row, column] = own[:, column, row] = value
        return matrices


ACROSS = np.array([0.0, 0.0, 1.0])[:, None]
"""Along the axes about which links turn."""
SWAPPED, SKEWED = np.array([1, 0, 2]), np.array([1.0, -1.0, 0.0])[:, None]


def _times_across(vectors: Array, along: Array) -> Array:
    """Cross products of vectors (3, K) with those that lie along the axes about which links turn
    (..., K).
    """
    return np.asarray(SKEWED * vectors.take(SWAPPED, 0) * along)


@dataclass(frozen=True, eq=False)
class SupportedPose(DrivesPose):
    """A linkage in K states of its N drives and of its support, which has D coordinates.

    at : where the support is.  origin : (3, K), m, of the linkage's axes from the reference point.
    speeds : of the drives (N, K), rad/s.
    rotors : moments of inertia of motors times their ratios, and of a flywheel, (N,), kg m2; as far
    as they turn with the support, they are the support's.
    """

    bodies: SupportedBodies
    at: SupportPlace
    origin: Array
    speeds: Array
    rotors: tuple[float, ...]

    @property
    def _drives(self) -> int:
        return len(self.linkage.machine.driven)

    @cached_property
    def _free(self) -> list[int]:
        """Coordinates of the support that it has, among all six."""
        coordinates: list[int] = self.bodies.body.free.tolist()
        return coordinates

    # -- bodies: the links, and at last the support ------------------------------------------------

    @cached_property
    def _arms(self) -> Array:
        """Anchors (L + 1, 3, K) from the reference point, m, which is the support's own."""
        names = [p(self.linkage.anchors[link])[0] for link in self.bodies.links]
        arms = np.zeros((len(names) + 1, 3, self.count))
        places = self._stacked(names)[:, -1]
        arms[:-1, 0], arms[:-1, 1] = places.real, places.imag
        arms[:-1] += self.origin
        return arms

    def _from_reference(self, place: Array, plane: float) -> Array:
        """A place (3, K) of the linkage's axes in the support's, m, from the reference point."""
        at = np.array([place.real, place.imag, np.full(self.count, plane)])
        return np.asarray(self.origin + at)

    @cached_property
    def _motions(self) -> Array:
        """Velocity of each anchor and angular velocity of each body, (L + 1, N + D + 1, 6, K), with
        a unit of speed of each coordinate alone; at last their accelerations while no coordinate
        accelerates.
        """
        drives, at, free = self._drives, self.at, self._free
        moves = [coordinate for coordinate in free if coordinate < 3]
        rotates = [coordinate - 3 for coordinate in free[len(moves) :]]
        motions = np.zeros((len(self.bodies.links) + 1, drives + len(free) + 1, 6, self.count))
        first, second, _, spin, change = self._rates
        motions[:-1, :drives, 0], motions[:-1, :drives, 1] = first[:, :-1].real, first[:, :-1].imag
        motions[:-1, :drives, 5] = spin[:, :-1]
        begin = drives + len(moves)
        motions[:, drives:begin, :3] = at.rotation[moves]
        turning = np.moveaxis(at.turning[:, rotates], 1, 0)
        turning = np.concatenate([turning, at.angular_bias[None]])
        motions[:, begin:, 3:] = turning
        motions[:, begin:, :3] = cross(turning, self._arms[:, None])
        last, twice = motions[:, -1], cross(at.angular_velocity, self._arms)
        twice[:-1, 0] += 2 * first[:, -1].real
        twice[:-1, 1] += 2 * first[:, -1].imag
        last[:, :3] += cross(at.angular_velocity, twice)
        last[:-1, 0] += second[:, -1].real
        last[:-1, 1] += second[:, -1].imag
        last[:-1, 3:] += _times_across(at.angular_velocity, spin[:, -1:])
        last[:-1, 5] += change[:, -1]
        return motions

    @cached_property
    def _demands(self) -> Array:
        """Force, and moment about the anchor, that bodies demand (L + 1, N + D + 1, 6, K), in the
        order of `_motions`.
        """
        inertias = self.bodies.inertias(self._rates[2][:, -1])
        demands = np.einsum("bxyk,bjyk->bjxk", inertias, self._motions)
        turning = np.zeros((len(inertias), 3, self.count))
        turning[:-1, 2] = self._rates[3][:, -1]
        turning += self.at.angular_velocity
        momenta = np.einsum("bxyk,byk->bxk", inertias[:, :, 3:], turning)
        gyroscopic = cross(turning[:, None], momenta.reshape(len(inertias), 2, 3, -1))
        demands[:, -1] += gyroscopic.reshape(momenta.shape)
        return np.asarray(demands)

    # -- sums over all bodies ----------------------------------------------------------------------

    @cached_property
    def _units(self) -> tuple[Array, Array]:
        """Force in the plane and moment across it (L, N + D, K) that units demand of links."""
        of_links = self._demands[:-1, :-1]
        turning = self.bodies.flywheels[:, None] * self._motions[:-1, :-1, 5]
        return of_links[:, :, 0] + 1j * of_links[:, :, 1], of_links[:, :, 5] + turning

    @cached_property
    def _turned(self) -> tuple[Array, Array]:
        """The same (L, K) while no coordinate accelerates."""
        of_links = self._demands[:-1, -1]
        turning = self.bodies.flywheels * (self._rates[4][:, -1] + self.at.angular_bias[2])
        return of_links[:, 0] + 1j * of_links[:, 1], of_links[:, 5] + turning

    @cached_property
    def _works(self) -> Array:
        """Of what bodies demand, along each coordinate (N + D, N + D + 1, K)."""
        return np.asarray(np.einsum("bixk,bjxk->ijk", self._motions[:, :-1], self._demands))

    @cached_property
    def inertia(self) -> Array:
        """M (N + D, N + D, K) of links and support, and of rotors between drives and support, kg,
        kg m and kg m2.
        """
        whole, about = self._works[:, :-1].copy(), self._motions[-1, :-1, 5]
        for k, rotor in enumerate(self.rotors):
            if rotor:
                whole[k] += self.share * rotor * about
                whole[:, k] += self.share * rotor * about
        return whole

    @cached_property
    def bias(self) -> Array:
        """h (N + D, K), N and N m."""
        total = self._works[:, -1].copy()
        rotors = self.share * np.array(self.rotors)
        gyroscopic = _times_across(self.at.angular_velocity, rotors @ self.speeds)
        total += np.einsum("ixk,xk->ik", self._motions[-1, :-1, 3:], gyroscopic)
        total[: self._drives] += np.outer(rotors, self.at.angular_bias[2])
        return total

    # -- what acts ---------------------------------------------------------------------------------

    @cached_property
    def _gravity(self) -> Array:
        """(3, K), m/s2, in the support's axes."""
        return self.at.in_own_axes(np.array([*self.linkage.machine.gravity, 0.0]))

    @property
    def gravity(self) -> Array:
        """Its part in the plane (K,), m/s2, complex."""
        return np.asarray(self._gravity[0] + 1j * self._gravity[1])

    def generalized(self, demands: Demands) -> Array:
        """Generalized force (N + D, K) of what demands (K,) hold whose opposites the support bears:
        0 on the support.
        """
        total = np.zeros((self._drives + len(self._free), self.count))
        total[: self._drives] = super().generalized(demands)
        return total

    def exerted(self, source: AppliedSource, inputs: SourceInputs, demands: Demands) -> Array:
        """Generalized force (N + D, K) of a source: on the support, of what comes from outside."""
        total = self.generalized(demands)
        on_support = total[self._drives :]
        if source.weighs:
            forces = self._demands[:, self._drives : -1, :3]
            on_support += np.einsum("bjxk,xk->jk", forces, self._gravity)
        wrenches = [self._wrench(acting) for acting in source.from_outside(self.moving, inputs)]
        if wrenches:
            force, moment = (sum(parts) for parts in zip(*wrenches, strict=True))
            on_support += self.at.generalized(force, moment)[self._free]
        return total

    def _wrench(self, acting: Acting) -> tuple[Array, Array]:
        """Force, and moment about the reference point, (3, K) of what acts on a link, in the plane
        of its point.
        """
        link, point, force, torque = acting
        name = point if isinstance(point, str) else None
        plane = self.linkage.machine.links[link].plane_of(name)
        place = 0j if point is None else self.moving.point(point).place if name else point
        arm = self._from_reference(place + np.zeros(self.count, complex), plane)
        force = force + np.zeros(self.count, complex)
        push = np.array([force.real, force.imag, np.zeros(self.count)])
        return push, cross(arm, push) + ACROSS * torque


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
