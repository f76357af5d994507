"""The motion of a support in space, by no small motion: place, readings of gauges, push of mounts.

With Z the displacement of the reference point and w the rotation vector, a point at b from the
reference point moves to Z + R b, with

    R = 1 + A [w] + B [w]^2,    W = (1 - B [w] + C [w]^2) w.,
    A = sin t / t,    B = (1 - cos t) / t^2,    C = (t - sin t) / t^3,    t = |w|

where [w] takes the cross product and W is the angular velocity in the support's own axes.  To the
second order this is the motion of which `vibration.body` has the stiffness of preloads; a support
that turns about one axis alone does so by the angle about it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from math import factorial
from typing import ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.parts.support import AXES, FREEDOMS, Gauge, Mount, unit_vector
from equipoise.quantities import Dimension
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.signals import Array
from equipoise.vibration.body import IN_PLANE, MountContact, SupportBody, gauges_of
from equipoise.vibration.response import of_support

NEXT, LAST = np.array([1, 2, 0]), np.array([2, 0, 1])
"""Of each axis, the one after it and the one before it."""
EYE = np.eye(3)[..., None]
SKEW = np.cross(np.eye(3)[:, None], np.eye(3)).transpose(2, 1, 0).reshape(9, 3)
"""[w] as a column, by w."""
TERMS = 12
"""Of the series of A, B and C, which have all digits up to t = 1."""
SERIES = np.array(
    [[(-1) ** n / factorial(2 * n + k) for n in range(TERMS)] for k in (1, 2, 3)]
    + [[(n + 1) * (-1) ** (n + 1) / factorial(2 * n + k) for n in range(TERMS)] for k in (4, 5)]
)
"""Coefficients (5, TERMS) of A, B, C and the derivatives of B and C by t^2, in powers of t^2."""


def cross(a: Array, b: Array) -> Array:
    """Cross products (..., 3, K) of vectors (..., 3, K)."""
    # a take costs a quarter of what slices of so few numbers do
    product = a.take(NEXT, -2) * b.take(LAST, -2) - a.take(LAST, -2) * b.take(NEXT, -2)
    return np.asarray(product)


def _series(square: Array) -> Array:
    """As `_coefficients`, at t^2 below 1."""
    return np.asarray(SERIES @ np.vander(square, TERMS, increasing=True).T)


def _coefficients(square: Array) -> Array:
    """A, B, C, and derivatives of B and C by t^2, (5, K), at t^2 (K,)."""
    is_small = square < 1.0
    if is_small.all():
        return _series(square)
    series = _series(np.where(is_small, square, 0.0))
    large = np.where(is_small, 1.0, square)
    t = np.sqrt(large)
    a, b = np.sin(t) / t, (1 - np.cos(t)) / large
    c = (1 - a) / large
    closed = np.array([
        a, b, c, (a / 2 - b) / large, ((a - np.cos(t)) / (2 * large) - c) / large,
    ])  # fmt: skip
    return np.where(is_small, series, closed)


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
        twice = second * w
        combined = twice[:, None] * w
        combined += EYE * (1 - np.einsum("ik,ik->k", twice, w))
        combined += (SKEW @ (first * w)).reshape(3, 3, -1)
        return np.asarray(combined)

    @cached_property
    def angular_velocity(self) -> Array:
        """W (3, K), rad/s, in the support's axes."""
        return np.asarray(np.einsum("ijk,jk->ik", self.turning, self.rate[3:]))

    @cached_property
    def angular_bias(self) -> Array:
        """Angular acceleration (3, K), rad/s2, in the support's axes while no rate changes."""
        w, rate = self.place[3:], self.rate[3:]
        changing = 2 * np.einsum("ik,ik->k", w, rate)
        _, _, c, b_by_square, c_by_square = self._powers
        turned = cross(w, rate)
        bent = cross(c_by_square * changing * w + c * rate, turned)
        return np.asarray(bent - b_by_square * changing * turned)

    def in_space(self, vectors: Array) -> Array:
        """Vectors (3, K) of the support's axes in those of space."""
        return np.asarray(np.einsum("ijk,jk->ik", self.rotation, vectors))

    def in_own_axes(self, vectors: Array) -> Array:
        """Vectors (..., 3), fixed in space, in the support's axes (..., 3, K)."""
        turned = vectors @ self.rotation.reshape(3, -1)
        return np.asarray(turned.reshape(*vectors.shape, -1))

    def turning_forces(self, moments: Array) -> Array:
        """Generalized forces (..., 3, K) along w of moments in the support's axes."""
        return np.asarray(np.einsum("jik,...jk->...ik", self.turning, moments))

    def generalized(self, force: Array, moment: Array) -> Array:
        """Generalized forces (6, K) of a force (3, K) and a moment about the reference point, in
        the support's axes.
        """
        return np.concatenate([self.in_space(force), self.turning_forces(moment)])


def in_plane(place: Array, rate: Array) -> SupportPlace:
    """The place of a support that moves in the plane: along surge, heave and pitch (3, K)."""
    whole = np.zeros((2, len(FREEDOMS), place.shape[-1]))
    whole[:, [*IN_PLANE]] = place, rate
    return SupportPlace(*whole)


@dataclass(frozen=True, eq=False)
class SpatialReadings:
    """Motions of G points of the support along directions fixed in space, or its rotations.

    along : unit vectors (G, 3), or 0 of rotations.  arms : (G, 3) from the reference point, m.
    about : (G, 3), 1 at the axis of what reads a rotation, else 0.
    """

    along: Array
    arms: Array
    about: Array

    @classmethod
    def of(cls, body: SupportBody, items: Sequence[Mount | Gauge]) -> SpatialReadings:
        """Where mounts act, or gauges read."""
        along, arms, about = np.zeros((3, len(items), 3))
        for k, item in enumerate(items):
            if item.axis is not None:
                about[k, AXES.index(item.axis)] = 1.0
            else:
                along[k] = unit_vector(item.direction)
                arms[k] = np.array(item.point) - body.reference
        return cls(along, arms, about)

    def read(self, at: SupportPlace) -> tuple[Array, Array]:
        """Displacements (G, K) from the drawn position, m or rad, and their derivatives (G, 6, K)
        by those of the support.
        """
        ways = np.empty((len(self.along), *at.place.shape))
        own_axes, arms = at.in_own_axes(self.along), self.arms[..., None]
        ways[:, :3] = self.along[..., None]
        ways[:, 3:] = at.turning_forces(cross(arms, own_axes)) + self.about[..., None]
        turned = np.sum(own_axes * arms, axis=1) - np.sum(self.along * self.arms, axis=1)[:, None]
        moved = self.along @ at.place[:3] + self.about @ at.place[3:]
        return moved + turned, ways


@dataclass(frozen=True, eq=False)
class SpatialMounts:
    """The mounts of a support that moves in space.

    contacts : how strongly they push.  at : where.
    """

    contacts: Sequence[MountContact]
    at: SpatialReadings

    @classmethod
    def of(cls, body: SupportBody, contacts: Sequence[MountContact]) -> SpatialMounts:
        """Each where it acts."""
        mounts = [body.support.mounts[contact.name] for contact in contacts]
        return cls(contacts, SpatialReadings.of(body, mounts))

    def forces(self, at: SupportPlace) -> Array:
        """With which they push the support (G, K), N or N m."""
        return self._push(at)[0]

    def wrench(self, at: SupportPlace, pushing: Sequence[bool]) -> Array:
        """Generalized forces (6, K) of those of them (G,) that push."""
        forces, ways = self._push(at)
        return np.asarray(np.einsum("g,gk,gik->ik", np.array(pushing, float), forces, ways))

    def _push(self, at: SupportPlace) -> tuple[Array, Array]:
        """Forces (G, K), and derivatives as of `SpatialReadings.read`."""
        moved, ways = self.at.read(at)
        forces, moving = np.empty_like(moved), np.einsum("gik,ik->gk", ways, at.rate)
        for k, contact in enumerate(self.contacts):
            forces[k] = contact.pushing(moved[k], moving[k])
        return forces, ways


NO_MOUNTS = SpatialMounts((), SpatialReadings(*np.zeros((3, 0, 3))))
"""Of a fixed frame."""


def _signal(name: str, dimension: Dimension, turned: Dimension) -> ResultOutput:
    """A signal (M,) of a gauge or mount."""
    return ResultOutput(name, dimension, turned, read=lambda values: values, column=name)


@dataclass(frozen=True, eq=False)
class SupportMotion:
    """How a support moves, at M instants.

    at : where it is, and how it moves there.  mounted : its mounts.
    """

    body: SupportBody
    at: SupportPlace
    mounted: SpatialMounts

    @property
    def place(self) -> Array:
        """Displacements (6, M), m, and rotation vector, rad, in the order of `FREEDOMS`."""
        return self.at.place

    @property
    def rate(self) -> Array:
        """Their rates by time (6, M)."""
        return self.at.rate

    @cached_property
    def gauges(self) -> Mapping[str, Array]:
        """Displacement (M,) at each gauge, m or rad."""
        gauges = gauges_of(self.body)
        moved, _ = SpatialReadings.of(self.body, [*gauges.values()]).read(self.at)
        return dict(zip(gauges, moved, strict=True))

    @cached_property
    def mounts(self) -> Mapping[str, Array]:
        """Force (M,) of each mount, N or N m."""
        names = (contact.name for contact in self.mounted.contacts)
        return dict(zip(names, self.mounted.forces(self.at), strict=True))

    @property
    def smooth_forces(self) -> Array:
        """(G, M) of its mounts, N or N m, below 0 where a one-sided mount would have to pull."""
        smooth = [replace(contact, one_sided=False) for contact in self.mounted.contacts]
        return SpatialMounts(smooth, self.mounted.at).forces(self.at)

    declared: ClassVar[Declarations] = {
        "gauges": of_support(
            "gauges", "of each gauge", {"displacement": _signal("displacement", "length", "angle")}
        ),
        "mounts": of_support(
            "mounts", "of each mount", {"force": _signal("force", "force", "torque")}
        ),
    }
