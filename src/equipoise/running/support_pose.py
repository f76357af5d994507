"""Linkages whose drives each go their own ways, on a support that moves in space.

In the support's axes, from its reference point, with b the place of a link's anchor, W the angular
velocity of the support, R its rotation and Z the displacement of the reference point, that has

    velocity       R^T Z.  + b.  + W x b
    acceleration   R^T Z.. + b.. + W. x b + 2 W x b. + W x (W x b)

and its link, which turns at w in the plane, the angular velocity W + w e and the acceleration
W. + w. e + W x w e, with e across the plane.  So displacements and rotation of the support are
further coordinates beside the angles of the drives, and the support itself is one body more.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.steps import p
from equipoise.mechanism.dynamics.friction import Demands
from equipoise.mechanism.dynamics.reactions import Acting
from equipoise.running.drives_linkage import DrivesPose
from equipoise.running.sources import AppliedSource, SourceInputs
from equipoise.running.supported_bodies import SupportedBodies
from equipoise.signals import Array
from equipoise.vibration.support_place import SupportPlace, cross

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
