"""Where a support is that moves in space, and what its points read there: by no small motion.

With Z the displacement of the reference point and w the rotation vector, a point at b from the
reference point moves to Z + R b, with

    R = 1 + A [w] + B [w]^2,    W = (1 - B [w] + C [w]^2) w.,
    A = sin t / t,    B = (1 - cos t) / t^2,    C = (t - sin t) / t^3,    t = |w|

where [w] takes the cross product and W is the angular velocity in the support's own axes.  To the
second order this is the motion of which `vibration.body` has the stiffness of preloads; a support
that turns about one axis alone does so by the angle about it.
"""

from __future__ import annotations

from functools import cached_property
from math import factorial
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.parts.support import AXES, FREEDOMS, Gauge, Mount, unit_vector
from equipoise.signals import Array
from equipoise.vibration.body import IN_PLANE, MountContact, SupportBody

TERMS = 12
"""Of the series of A, B and C, which have all digits up to t = 1."""


def cross(a: Any, b: Any) -> Array:
    """Cross products (..., 3, K) of vectors (..., 3, K)."""
    (ax, ay, az), (bx, by, bz) = np.moveaxis(a, -2, 0), np.moveaxis(b, -2, 0)
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-2)


def _coefficients(square: Array) -> Array:
    """A, B, C, and derivatives of B and C by t^2, (5, K), at t^2 (K,)."""
    small = np.minimum(square, 1.0)
    series = np.zeros((5, *square.shape))
    for n in reversed(range(TERMS)):
        term = (-small) ** n
        for k in range(3):
            series[k] += term / factorial(2 * n + 1 + k)
        slope = -(n + 1) * term
        series[3] += slope / factorial(2 * n + 4)
        series[4] += slope / factorial(2 * n + 5)
    large = np.maximum(square, 1.0)
    t = np.sqrt(large)
    a, b = np.sin(t) / t, (1 - np.cos(t)) / large
    c = (1 - a) / large
    closed = np.array([
        a, b, c, (a / 2 - b) / large, ((a - np.cos(t)) / (2 * large) - c) / large,
    ])  # fmt: skip
    return np.where(square < 1.0, series, closed)


@dataclass(frozen=True, eq=False)
class SupportPlace:
    """Displacements (6, K) of a support, in the order of `FREEDOMS`, and their rates."""

    place: Array
    rate: Array

    @cached_property
    def _powers(self) -> Array:
        """A to C, and derivatives, as of `_coefficients`."""
        return _coefficients(np.sum(self.place[3:] ** 2, axis=0))

    @cached_property
    def rotation(self) -> Array:
        """R (3, 3, K), which turns vectors of the support's axes into space."""
        a, b = self._powers[:2]
        return self._combined(a, b)

    @cached_property
    def turning(self) -> Array:
        """(3, 3, K), which makes the angular velocity in the support's axes of w."""
        b, c = self._powers[1:3]
        return self._combined(-b, c)

    def _combined(self, first: Array, second: Array) -> Array:
        """1 + first [w] + second [w]^2, (3, 3, K)."""
        w = self.place[3:]
        x, y, z = w
        zero = np.zeros_like(x)
        skew = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]])
        square = w[:, None] * w - np.eye(3)[:, :, None] * np.sum(w * w, axis=0)
        return np.asarray(np.eye(3)[:, :, None] + first * skew + second * square)

    @cached_property
    def angular_velocity(self) -> Array:
        """W (3, K), rad/s, in the support's axes."""
        return np.asarray(np.einsum("ijk,jk->ik", self.turning, self.rate[3:]))

    @cached_property
    def angular_bias(self) -> Array:
        """Angular acceleration (3, K), rad/s2, in the support's axes while no rate changes."""
        w, rate = self.place[3:], self.rate[3:]
        changing = 2 * np.sum(w * rate, axis=0)
        _, _, c, b_by_square, c_by_square = self._powers
        turned = cross(w, rate)
        bent = c_by_square * changing * cross(w, turned) + c * cross(rate, turned)
        return np.asarray(bent - b_by_square * changing * turned)

    def in_space(self, vectors: Array) -> Array:
        """Vectors (3, K) of the support's axes in those of space."""
        return np.asarray(np.einsum("ijk,jk->ik", self.rotation, vectors))

    def in_own_axes(self, vectors: Array) -> Array:
        """Vectors (3, K) of space in the support's axes."""
        return np.asarray(np.einsum("jik,jk->ik", self.rotation, vectors))

    def generalized(self, force: Array, moment: Array) -> Array:
        """Generalized forces (6, K) of a force (3, K) and a moment about the reference point, in
        the support's axes.
        """
        turning = np.einsum("jik,jk->ik", self.turning, moment)
        return np.concatenate([self.in_space(force), turning])


def in_plane(place: Array, rate: Array) -> SupportPlace:
    """The place of a support that moves in the plane: along surge, heave and pitch (3, K)."""
    whole = np.zeros((2, len(FREEDOMS), place.shape[-1]))
    whole[:, [*IN_PLANE]] = place, rate
    return SupportPlace(*whole)


@dataclass(frozen=True, eq=False)
class SpatialReading:
    """Motion of a point of the support along a direction fixed in space, or its rotation.

    along : unit vector (3,), or None for the rotation.  arm : (3,) from the reference point, m.
    axis : number of the rotation among `FREEDOMS`.
    """

    along: Array | None
    arm: Array
    axis: int = 0

    @classmethod
    def of(cls, body: SupportBody, item: Mount | Gauge) -> SpatialReading:
        """Where a mount acts, or a gauge reads."""
        if item.axis is not None:
            return cls(None, np.zeros(3), 3 + AXES.index(item.axis))
        return cls(np.array(unit_vector(item.direction)), np.array(item.point) - body.reference)

    def displacement(self, at: SupportPlace) -> Array:
        """(K,) from the drawn position, m or rad."""
        if self.along is None:
            return np.asarray(at.place[self.axis])
        turned = np.einsum("ijk,j->ik", at.rotation, self.arm) - self.arm[:, None]
        return np.asarray(self.along @ (at.place[:3] + turned))

    def velocity(self, at: SupportPlace) -> Array:
        """(K,), m/s or rad/s."""
        if self.along is None:
            return np.asarray(at.rate[self.axis])
        turning = at.in_space(cross(at.angular_velocity, self.arm[:, None]))
        return np.asarray(self.along @ (at.rate[:3] + turning))

    def wrench(self, force: Array, at: SupportPlace) -> Array:
        """Generalized forces (6, K) of a force or moment (K,) here."""
        if self.along is None:
            own = np.zeros_like(at.place)
            own[self.axis] = force
            return own
        push = at.in_own_axes(self.along[:, None] * force)
        return at.generalized(push, cross(self.arm[:, None], push))


@dataclass(frozen=True, eq=False)
class SpatialMount:
    """A mount of a support that moves in space.

    contact : how strongly it pushes.  at : where.
    """

    contact: MountContact
    at: SpatialReading

    def force(self, at: SupportPlace) -> Array:
        """With which it pushes the support (K,), N or N m."""
        return self.contact.pushing(self.at.displacement(at), self.at.velocity(at))


def spatial_mounts(
    body: SupportBody, contacts: tuple[MountContact, ...]
) -> tuple[SpatialMount, ...]:
    """The mounts of a support, each where it acts in space."""
    mounts = body.support.mounts
    return tuple(
        SpatialMount(item, SpatialReading.of(body, mounts[item.name])) for item in contacts
    )
