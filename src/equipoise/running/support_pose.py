"""A linkage whose drives each go their own ways, on a support that moves in the plane.

In the support's axes, from its reference point, with rho the place of a link's anchor, phi and w
the support's rotation and its rate, and Z the displacement of the reference point, the anchor has

    velocity       exp(-i phi) Z.  + rho.  + i w rho
    acceleration   exp(-i phi) Z.. + rho.. + i w. rho + 2 i w rho. - w^2 rho

and its link turns at the sum of its own rate and w.  So displacements and rotation of the support
are further coordinates beside the angles of the drives, and the support itself is one body more.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.steps import p
from equipoise.mechanism.checks import FRAME
from equipoise.mechanism.dynamics.friction import Demands
from equipoise.mechanism.formulas import kernels
from equipoise.running.drives_linkage import DrivesPose
from equipoise.running.sources import AppliedSource, SourceInputs
from equipoise.signals import Array
from equipoise.vibration.body import PITCH, PlanarInertia


@dataclass(frozen=True, eq=False)
class SupportedPose(DrivesPose):
    """A linkage in K states of its N drives and of its support, which has D coordinates.

    place, rate : displacements and velocities (3, K) of the support along surge, heave and pitch.
    offset : (K,), m, complex, by which the linkage stands beside that of the file.
    """

    support: PlanarInertia
    place: Array
    rate: Array
    offset: Array

    @property
    def _drives(self) -> int:
        return len(self.linkage.machine.driven)

    @cached_property
    def _back(self) -> Array:
        """What turns a vector in space (K,) into the support's axes."""
        return np.asarray(np.exp(-1j * self.place[PITCH]))

    @cached_property
    def gravity(self) -> Array:
        """(K,), m/s2, complex, in the support's axes."""
        return complex(*self.linkage.machine.gravity) * self._back

    def _way(self, coordinate: int, rho: Array | float) -> Array:
        """Velocity (K,) of a point at a place with a unit of speed along surge, heave or pitch."""
        return np.asarray((self._back, 1j * self._back, 1j * rho + 0 * self._back)[coordinate])

    def _arm(self, body: str) -> Array:
        """Place (K,) of a link's anchor, from the reference point, which is the frame's own."""
        if body == FRAME:
            return np.zeros(self.count)
        place = self.rows(p(self.linkage.anchors[body])[0])[-1]
        return np.asarray(place + self.offset - self.support.reference)

    @cached_property
    def _numbers(self) -> list[Array]:
        """Mass, first moment and inertia (L + 1, 1) of links and support."""
        return [
            np.concatenate([own, [[self.share * of_support]]])
            for own, of_support in zip(super()._numbers, self.support[:3], strict=True)
        ]

    @cached_property
    def _rates(self) -> list[Array]:
        """Both rates of anchors, rotations and both of their rates (L + 1, N + D + 1, K) of links
        and support, of whose second ones only those of the motion as it is count.
        """
        own, heavy, turning = super()._rates, self._heavy, self.rate[PITCH]
        links, drives, free = len(heavy), self._drives, self.support.free
        shape = links + 1, drives + len(free) + 1, self.count
        first, second, turn = (np.zeros(shape, complex) for _ in range(3))
        w, a = np.zeros((2, *shape))
        first[:links, :drives], w[:links, :drives] = own[0][:, :-1], own[3][:, :-1]
        turn[:] = 1.0
        turn[:links] = own[2][:, -1:]
        rho = np.zeros((links + 1, self.count), complex)
        for k, link in enumerate(heavy):
            rho[k] = self._arm(link)
        for k, coordinate in enumerate(free, drives):
            first[:, k] = self._way(coordinate, rho)
            w[:, k] = float(coordinate == PITCH)
        second[:, -1] = -(turning**2) * rho
        second[:links, -1] += own[1][:, -1] + 2j * turning * own[0][:, -1]
        w[:, -1] = turning
        w[:links, -1] += own[3][:, -1]
        a[:links, -1] = own[4][:, -1]
        return [first, second, turn, w, a]

    @cached_property
    def inertia(self) -> Array:
        """M (N + D, N + D, K) of links and support, kg, kg m and kg m2.

        What a flywheel has turns with its link; as far as it turns with the support, it is the
        support's.
        """
        whole = np.array(super().inertia)
        if PITCH in self.support.free:
            at = self._drives + self.support.free.index(PITCH)
            whole[at, at] -= self.share * self.linkage.machine.drive.flywheel
        return whole

    def generalized(self, demands: Demands) -> Array:
        """Generalized force (N + D, K) of what demands (K,) hold whose opposites the support bears:
        0 on the support.
        """
        total = np.zeros((self._drives + len(self.support.free), self.count))
        total[: self._drives] = super().generalized(demands)
        return total

    def exerted(self, source: AppliedSource, inputs: SourceInputs, demands: Demands) -> Array:
        """Generalized force (N + D, K) of a source: on the support, of what comes from outside."""
        total = self.generalized(demands)
        outside = source.from_outside(self.moving, inputs, demands)
        for body, (force, moment) in outside.items():
            rho = self._arm(body)
            for k, coordinate in enumerate(self.support.free, self._drives):
                total[k] -= kernels.dot(self._way(coordinate, rho), force)
                total[k] -= moment if coordinate == PITCH else 0.0
        return total
