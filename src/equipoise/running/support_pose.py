"""Linkages whose drives each go their own ways, on a support that moves in space.

In the support's axes, from its reference point, with b the place of a link's anchor, W the angular
velocity of the support, R its rotation and Z the displacement of the reference point, that has

    velocity       R^T Z.  + b.  + W x b
    acceleration   R^T Z.. + b.. + W. x b + 2 W x b. + W x (W x b)

and its link, which turns at w in the plane, the angular velocity W + w e and the acceleration
W. + w. e + W x w e, with e across the plane.  So displacements and rotation of the support are
further coordinates beside the angles of the drives, and the support itself is one body more.  Links
are flat: their own inertia about an axis in the plane is half of that across it.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.steps import p, u
from equipoise.mechanism.dynamics.forces import flywheel_on, inertia_about
from equipoise.mechanism.dynamics.friction import Demands
from equipoise.mechanism.dynamics.reactions import Acting
from equipoise.mechanism.parts.links import masses_of, moments_across
from equipoise.running.drives_linkage import DrivesPose
from equipoise.running.sources import AppliedSource, SourceInputs
from equipoise.signals import Array
from equipoise.vibration.body import SupportBody
from equipoise.vibration.support_place import SupportPlace, cross

ACROSS = np.array([0.0, 0.0, 1.0])[:, None]
"""Along the axes about which links turn."""


@dataclass(frozen=True, eq=False)
class SupportedPose(DrivesPose):
    """A linkage in K states of its N drives and of its support, which has D coordinates.

    at : where the support is.  origin : (3, K), m, of the linkage's axes from the reference point.
    speeds : of the drives (N, K), rad/s.
    rotors : moments of inertia of motors times their ratios, and of a flywheel, (N,), kg m2; as far
    as they turn with the support, they are the support's.
    """

    body: SupportBody
    at: SupportPlace
    origin: Array
    speeds: Array
    rotors: tuple[float, ...]

    @property
    def _drives(self) -> int:
        return len(self.linkage.machine.driven)

    @property
    def _free(self) -> list[int]:
        """Coordinates of the support that it has, among all six."""
        return [*map(int, self.body.free)]

    # -- bodies: the links, and at last the support ------------------------------------------------

    @cached_property
    def _masses(self) -> Array:
        """(L + 1, 1, 1), kg."""
        links = [self._inertial[link][0] for link in self._heavy]
        return np.array([*links, self.share * self.body.support.mass])[:, None, None]

    @cached_property
    def _arms(self) -> Array:
        """Anchors (L + 1, 3, K) from the reference point, m, which is the support's own."""
        arms = np.zeros((len(self._heavy) + 1, 3, self.count))
        for k, link in enumerate(self._heavy):
            arms[k] = self._from_reference(self.rows(p(self.linkage.anchors[link])[0])[-1], 0.0)
        return arms

    def _from_reference(self, place: Array, plane: float) -> Array:
        """A place (3, K) of the linkage's axes in the support's, m, from the reference point."""
        at = np.array([place.real, place.imag, np.full(self.count, plane)])
        return np.asarray(self.origin + at)

    @cached_property
    def _moments(self) -> Array:
        """Mass times arm of the centre from the anchor (L + 1, 3, K), kg m."""
        moments = np.zeros((len(self._heavy) + 1, 3, self.count))
        for k, link in enumerate(self._heavy):
            first = self._inertial[link][1] * self._turn(link)
            across, _ = moments_across(self.linkage.machine.links[link], self.linkage.anchors[link])
            moments[k] = first.real, first.imag, np.full(self.count, across)
        own = self.body.mass  # mass times [arm] stands below its diagonal
        moments[-1] = self.share * np.array([own[5, 1], own[3, 2], own[4, 0]])[:, None]
        return moments

    def _turn(self, link: str) -> Array:
        return np.asarray(self.rows(u(link)[0])[-1])

    @cached_property
    def _inertias(self) -> Array:
        """Inertia tensors (L + 1, 3, 3, K) about the anchors, kg m2."""
        machine = self.linkage.machine
        tensors = np.zeros((len(self._heavy) + 1, 3, 3, self.count))
        tensors[-1] = self.share * self.body.mass[3:, 3:, None]
        for k, name in enumerate(self._heavy):
            link, anchor, turn = machine.links[name], self.linkage.anchors[name], self._turn(name)
            mass, moment, inertia = inertia_about(link, anchor)
            own = inertia - (abs(moment) ** 2 / mass if mass else 0.0)
            centre = moment * turn
            second = np.zeros((3, 3, self.count))  # integrals of x x, x y and so on
            second[0, 0] = second[1, 1] = own / 2
            if mass:
                flat = np.array([centre.real, centre.imag])
                second[:2, :2] += flat[:, None] * flat / mass
            _, across = moments_across(link, anchor)
            second[2, :2] = second[:2, 2] = (across * turn).real, (across * turn).imag
            second[2, 2] = sum(part * plane**2 for part, _, plane in masses_of(link))
            tensors[k] = np.eye(3)[:, :, None] * np.trace(second) - second
        return tensors

    @cached_property
    def _rates_by_coordinate(self) -> tuple[Array, Array]:
        """Velocity of each anchor, and angular velocity of each body, with a unit of speed of each
        coordinate (L + 1, N + D, 3, K).
        """
        links, drives, free = len(self._heavy), self._drives, self._free
        ways, turns = np.zeros((2, links + 1, drives + len(free), 3, self.count))
        rates = self._rates
        moved = rates[0][:, :-1]
        ways[:links, :drives, 0], ways[:links, :drives, 1] = moved.real, moved.imag
        turns[:links, :drives, 2] = rates[3][:, :-1]
        for k, coordinate in enumerate(free, drives):
            if coordinate < 3:
                ways[:, k] = self.at.rotation[coordinate]
            else:
                turning = self.at.turning[:, coordinate - 3]
                turns[:, k] = turning
                ways[:, k] = cross(turning, self._arms)
        return ways, turns

    def _demanded(self, way: Array, turn: Array) -> tuple[Array, Array]:
        """Force and moment (L + 1, ..., 3, K) that accelerations of anchors and angular ones
        demand of bodies that do not turn yet.
        """
        more = (1,) * (way.ndim - 3)
        moments = self._moments.reshape(len(way), *more, 3, self.count)
        masses = self._masses.reshape(len(way), *more, 1, 1)
        turned = np.einsum("bxyk,b...yk->b...xk", self._inertias, turn)
        return masses * way + cross(turn, moments), cross(moments, way) + turned

    @cached_property
    def _by_unit(self) -> tuple[Array, Array]:
        """Force and moment (L + 1, N + D, 3, K) that units of acceleration demand."""
        return self._demanded(*self._rates_by_coordinate)

    @cached_property
    def _moving(self) -> tuple[Array, Array]:
        """Force and moment (L + 1, 3, K) that bodies demand while no coordinate accelerates."""
        links, turning, bias = len(self._heavy), self.at.angular_velocity, self.at.angular_bias
        rates = self._rates
        own, bent = np.zeros((2, links + 1, 3, self.count))
        own[:links, 0], own[:links, 1] = rates[0][:, -1].real, rates[0][:, -1].imag
        bent[:links, 0], bent[:links, 1] = rates[1][:, -1].real, rates[1][:, -1].imag
        spins, changes = np.zeros((2, links + 1, 3, self.count))
        spins[:links, 2], changes[:links, 2] = rates[3][:, -1], rates[4][:, -1]
        bent += cross(bias, self._arms) + 2 * cross(turning, own)
        bent += cross(turning, cross(turning, self._arms))
        force, moment = self._demanded(bent, bias + changes + cross(turning, spins))
        whole = turning + spins
        force = force + cross(whole, cross(whole, self._moments))
        momenta = np.einsum("bxyk,byk->bxk", self._inertias, whole)
        return force, moment + cross(whole, momenta)

    # -- sums over all bodies ----------------------------------------------------------------------

    @cached_property
    def _units(self) -> tuple[Array, Array]:
        """Force in the plane and moment across it (L, N + D, K) that units demand of links."""
        force, moment = self._by_unit
        turning = self._flywheels[:, None] * self._rates_by_coordinate[1][:-1, :, 2]
        return force[:-1, :, 0] + 1j * force[:-1, :, 1], moment[:-1, :, 2] + turning

    @cached_property
    def _turned(self) -> tuple[Array, Array]:
        """The same (L, K) while no coordinate accelerates."""
        force, moment = self._moving
        turning = self._flywheels * (self._rates[4][:, -1] + self.at.angular_bias[2])
        return force[:-1, 0] + 1j * force[:-1, 1], moment[:-1, 2] + turning

    @cached_property
    def _flywheels(self) -> Array:
        """Moments of inertia (L, 1) of what turns with links, kg m2, as it presses in joints."""
        each = [flywheel_on(self.linkage.machine, link) for link in self._heavy]
        return self.share * np.array(each)[:, None]

    @cached_property
    def inertia(self) -> Array:
        """M (N + D, N + D, K) of links and support, and of rotors between drives and support, kg,
        kg m and kg m2.
        """
        (ways, turns), (force, moment) = self._rates_by_coordinate, self._by_unit
        whole = np.einsum("bixk,bjxk->ijk", ways, force) + np.einsum(
            "bixk,bjxk->ijk", turns, moment
        )
        about = turns[-1, :, 2]
        for k, rotor in enumerate(self.rotors):
            whole[k] += self.share * rotor * about
            whole[:, k] += self.share * rotor * about
        return np.asarray(whole)

    @cached_property
    def bias(self) -> Array:
        """h (N + D, K), N and N m."""
        (ways, turns), (force, moment) = self._rates_by_coordinate, self._moving
        total = np.einsum("bixk,bxk->ik", ways, force) + np.einsum("bixk,bxk->ik", turns, moment)
        spinning = self.share * np.array(self.rotors) @ self.speeds
        gyroscopic = cross(self.at.angular_velocity, ACROSS * spinning)
        total += np.einsum("ixk,xk->ik", turns[-1], gyroscopic)
        total[: self._drives] += np.outer(self.rotors, self.share * self.at.angular_bias[2])
        return np.asarray(total)

    # -- what acts ---------------------------------------------------------------------------------

    @cached_property
    def _gravity(self) -> Array:
        """(3, K), m/s2, in the support's axes."""
        return self.at.in_own_axes(
            np.repeat([[*self.linkage.machine.gravity, 0.0]], self.count, axis=0).T
        )

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
        wrenches = [self._wrench(acting) for acting in source.from_outside(self.moving, inputs)]
        if source.weighs:
            wrenches.append(self._weight)
        for force, moment in wrenches:
            total[self._drives :] += self.at.generalized(force, moment)[self._free]
        return total

    @property
    def _weight(self) -> tuple[Array, Array]:
        """Of all bodies, as of `_wrench`."""
        moments = np.sum(self._masses * self._arms + self._moments, axis=0)
        return float(np.sum(self._masses)) * self._gravity, cross(moments, self._gravity)

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
