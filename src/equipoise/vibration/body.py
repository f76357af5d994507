"""The support as a rigid body on mounts: small motion, rest, and points that turn with it.

Small motion has six coordinates: displacement of the reference point along x, y, z and rotation
about x, y, z, in the order of `FREEDOMS`.  A force f at a point b is the generalized force
(f, (b - r) x f); a displacement along n of that point is read by the row (n, (b - r) x n).  How the
support can move picks coordinates out of the six at the very end.  Points of a planar support turn
with it, by no small angle; there places and rates are arrays (3, ...) along surge, heave and pitch.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import lstsq
from equipoise.errors import ModelError
from equipoise.i18n import Note, all_of
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import AXES, FREEDOMS, Gauge, Mount, Support, unit_vector
from equipoise.signals import Array, Periodic

MISSING = Note(
    "the machine stands on solid ground; add a table [support] with its mass, mounts and gauges"
).about("the-machine-stands-on-solid-ground")
LOOSE = 1e-9
"""Share of a load that may be left over by mounts that carry it."""


class PlanarInertia(NamedTuple):
    """A support alone in the plane, seen from its reference point.

    mass : kg.  first : first moment, complex, kg m.  inertia : kg m2.  reference : the point, m,
    complex.  free : which of surge, heave and pitch it can move in.
    """

    mass: float
    first: complex
    inertia: float
    reference: complex
    free: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class SupportBody:
    """The support of a machine, seen from its reference point; matrices are (6, 6)."""

    machine: Machine

    @property
    def support(self) -> Support:
        """The table of the model; raises a `ModelError` where there is none."""
        if self.machine.support is None:
            raise ModelError("support", MISSING)
        return self.machine.support

    @cached_property
    def free(self) -> Array:
        """Numbers of the coordinates in which it can move, (D,)."""
        return np.array([FREEDOMS.index(name) for name in self.support.coordinates])

    @property
    def free_in_plane(self) -> tuple[int, ...]:
        """Which of surge, heave and pitch a planar support can move in: their places."""
        return tuple(IN_PLANE.index(number) for number in self.free)

    @cached_property
    def reference(self) -> Array:
        """The point whose displacement is reported, (3,), m."""
        return np.array(self.support.reference)

    def wrench(self, force: Array, point: Any) -> Array:
        """Generalized force (..., 6) of forces (..., 3), N, at a point (3,) of the support."""
        (x, y, z), (fx, fy, fz) = np.asarray(point) - self.reference, np.moveaxis(force, -1, 0)
        moment = [y * fz - z * fy, z * fx - x * fz, x * fy - y * fx]  # `np.cross` takes far longer
        return np.concatenate([force, np.stack(moment, axis=-1)], axis=-1)

    def row(self, item: Mount | Gauge) -> Array:
        """Row (6,) that reads a displacement, or a rotation, off the coordinates."""
        if item.axis is not None:
            return np.asarray(np.eye(6)[3 + AXES.index(item.axis)])
        along = np.array(unit_vector(item.direction))
        values: Array = self.wrench(along, item.point)
        return values

    def whole(self, moved: Periodic) -> Periodic:
        """All six coordinates (6, K + 1), of those that are free (D, K + 1)."""
        values = np.zeros((len(FREEDOMS), moved.amplitudes.shape[-1]), complex)
        values[self.free] = moved.amplitudes
        return Periodic(values, moved.turns)

    @cached_property
    def mass(self) -> Array:
        """Mass matrix of the support alone."""
        arm = np.array(self.support.center_of_mass) - self.reference
        return rigid_mass(self.support.mass, arm, self._inertia(arm))

    @property
    def in_plane(self) -> PlanarInertia:
        """What of it moves in the plane of the drawing, of a planar support."""
        matrix = self.mass
        return PlanarInertia(
            float(matrix[0, 0]),
            complex(matrix[1, 5], -matrix[0, 5]),
            float(matrix[5, 5]),
            complex(*self.reference[:2]),
            self.free_in_plane,
        )

    def _inertia(self, arm: Array) -> Array:
        """Inertia tensor (3, 3) about the centre of mass, which lies at `arm` (3,)."""
        support = self.support
        if support.pivot_inertia is not None:
            about_center = support.pivot_inertia - support.mass * float(arm[:2] @ arm[:2])
            return np.diag([0.0, 0.0, about_center])
        if len(support.inertia) == 1:
            return np.diag([0.0, 0.0, support.inertia[0]])
        tensor = np.diag(support.inertia)
        if support.products:
            xy, yz, zx = support.products
            tensor = tensor - np.array([[0, xy, zx], [xy, 0, yz], [zx, yz, 0]])
        return tensor


def rigid_mass(mass: float, arm: Array, inertia: Array) -> Array:
    """Mass matrix (6, 6) of a rigid body: arm (3,) to its centre of mass, inertia (3, 3) there."""
    skew = skewed(arm)
    total = np.zeros((6, 6))
    total[:3, :3] = mass * np.eye(3)
    total[:3, 3:] = -mass * skew
    total[3:, :3] = mass * skew
    total[3:, 3:] = inertia - mass * skew @ skew
    return total


def skewed(arm: Array) -> Array:
    """The matrix that takes a vector v to arm x v."""
    x, y, z = arm
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def moved(mass: Array, arm: Array) -> Array:
    """A mass matrix (6, 6) about a point from which the old one lies at `arm` (3,)."""
    carry = np.eye(6)
    carry[:3, 3:] = -skewed(arm)
    return np.asarray(carry.T @ mass @ carry)


def turning_stiffness(force: Array, arm: Array) -> Array:
    """Stiffness (6, 6) of a force that keeps its direction while its point of attack turns along.

    The second-order part of its potential -f . R b, with R b = b + w x b + w x (w x b) / 2.
    """
    total = np.zeros((6, 6))
    outer = np.outer(force, arm)
    total[3:, 3:] = (force @ arm) * np.eye(3) - (outer + outer.T) / 2
    return total


@dataclass(frozen=True, eq=False)
class Rest:
    """The machine at rest in the drawn position.

    preload : mount -> force (N) or torque (N m) with which it pushes there; below 0 for a
        one-sided mount that does not touch: stiffness times its gap.
    stiffness : (6, 6) of preloads and weights, which keep their directions as the support turns.
    unbalance : (6,) what weights and preloads leave over, in the coordinates that are free.
    """

    preload: Mapping[str, float]
    stiffness: Array
    unbalance: Array

    def carries(self, name: str, mount: Mount) -> bool:
        """Whether a mount carries anything: a one-sided one may not touch."""
        return not mount.one_sided or self.preload[name] > 0


def at_rest(body: SupportBody, weights: list[tuple[Array, Array]]) -> Rest:
    """What holds the support, and how preloads and weights stiffen it.

    Mounts without a given preload share the weight as linear springs do that were put under the
    machine unloaded; one-sided ones that would have to pull let go.

    weights : force (3,) and point (3,) of each.

    Raises
    ------
    ModelError : the mounts do not carry the weight.
    """
    load = sum((body.wrench(force, point) for force, point in weights), np.zeros(6))
    preload = _shared(body, load)
    mounts = body.support.mounts
    stiffness = np.zeros((6, 6))
    left = load.copy()
    for name, mount in mounts.items():
        push = max(preload[name], 0.0) if mount.one_sided else preload[name]
        left += push * body.row(mount)
        if mount.point is not None:
            force = push * np.array(unit_vector(mount.direction))
            stiffness += turning_stiffness(force, np.array(mount.point) - body.reference)
    for force, point in weights:
        stiffness += turning_stiffness(force, point - body.reference)
    unbalance = np.zeros(6)
    unbalance[body.free] = left[body.free]
    return Rest(preload, stiffness, unbalance)


def _shared(body: SupportBody, load: Array) -> dict[str, float]:
    """Preload of every mount; those that are given, and those in which the weight settles."""
    mounts = body.support.mounts
    known = {name: m.preload for name, m in mounts.items() if m.preload is not None}
    rows = {name: body.row(mount)[body.free] for name, mount in mounts.items()}
    rates = {n: m.spring for n, m in mounts.items() if n not in known}
    left = load[body.free] + sum(force * rows[name] for name, force in known.items())
    if not any(rates.values()):
        if known or not np.any(left):
            return {**dict.fromkeys(mounts, 0.0), **known}
        raise ModelError("support.mounts", _uncarried(body, left))
    touching = dict(rates)
    for _ in range(len(rates) + 1):
        stiffness = np.zeros((len(body.free),) * 2)
        for n, k in touching.items():
            stiffness += k * np.outer(rows[n], rows[n])
        settled = lstsq(stiffness, left, rcond=1e-12)[0]
        floats = {n: float(-k * (rows[n] @ settled)) for n, k in rates.items()}
        engaged = {n: k for n, k in rates.items() if not (mounts[n].one_sided and floats[n] < 0)}
        if engaged.keys() == touching.keys():
            break
        touching = engaged
    over = left - stiffness @ settled
    if known:  # what they leave over along them, the support settles by; the linear model notes it
        along = np.array([rows[name] for name in known]).T
        over = over - along @ lstsq(along, over, rcond=1e-12)[0]
    if np.linalg.norm(over) > LOOSE * (np.linalg.norm(load) + np.linalg.norm(left)):
        raise ModelError("support.mounts", _uncarried(body, over))
    return {**{name: floats.get(name, 0.0) for name in mounts}, **known}


def _uncarried(body: SupportBody, over: Array) -> Note:
    is_loose = np.abs(over) > 0.05 * np.max(np.abs(over))
    return Note(
        "they do not carry the weight in {loose}; add a mount there, or give the mounts a preload",
        loose=_named(body, is_loose),
    )


def driven_away(body: SupportBody, is_loose: Array) -> Note:
    """Say in which of its coordinates (D,) nothing holds the support against a constant force."""
    return Note(
        "a constant force drives the support away in {loose}; add a mount there",
        loose=_named(body, is_loose),
    )


def unbounded_at(speed: float) -> Note:
    """Say that a vibration has no bound at a speed, rad/s."""
    return Note(
        "resonance without damping at {speed:g} rad/s; give the mounts a damping, or take "
        "another speed",
        speed=speed,
    )


def gauges_of(body: SupportBody) -> dict[str, Gauge]:
    """The gauges of the model; the free coordinates at the reference point where it has none."""
    if body.support.gauges:
        return dict(body.support.gauges)
    x, y, z = map(float, body.reference)
    gauges = {}
    for name in body.support.coordinates:
        if name in AXES:
            gauges[name] = Gauge(axis=name)
        else:
            first, second, third = map(float, np.eye(3)[FREEDOMS.index(name)])
            gauges[name] = Gauge((x, y, z), (first, second, third))
    return gauges


def _named(body: SupportBody, chosen: Array) -> Note | str:
    names = zip(body.support.coordinates, chosen, strict=True)
    return all_of([Note(name) for name, is_chosen in names if is_chosen])


SURGE, HEAVE, PITCH = 0, 1, 2
"""Places of the motions in the plane among the six of a body."""
IN_PLANE = (0, 1, 5)
"""Their numbers among the six coordinates of `vibration.body`."""


@dataclass(frozen=True, eq=False)
class Reading:
    """Motion of a point of the support along a direction fixed in space, or its rotation.

    along : unit vector (2,), or None for the rotation.  arm : (2,) from the reference point, m.
    share : 0 for an axis about which a planar support does not turn.
    """

    along: Array | None
    arm: Array
    share: float = 1.0

    @classmethod
    def of(cls, body: SupportBody, item: Mount | Gauge) -> Reading:
        if item.point is None:
            return cls(None, np.zeros(2), 1.0 if item.axis == "pitch" else 0.0)
        arm = (np.array(item.point) - body.reference)[:2]
        return cls(np.array(unit_vector(item.direction)[:2]), arm)

    def in_direction(self, direction: float) -> Reading:
        """The same point along a direction in the plane, rad from the x axis."""
        return replace(self, along=np.array(unit_vector(direction)[:2]))

    def displacement(self, place: Array) -> Array:
        """From the drawn position, m or rad."""
        x, y = self.turned(place[PITCH])
        return self._read(place, x - self.arm[0], y - self.arm[1])

    def velocity(self, place: Array, rate: Array) -> Array:
        """m/s or rad/s."""
        x, y = self.turned(place[PITCH])
        return self._read(rate, -rate[PITCH] * y, rate[PITCH] * x)

    def acceleration(self, place: Array, rate: Array, change: Array) -> Array:
        """m/s2 or rad/s2."""
        x, y = self.turned(place[PITCH])
        square = rate[PITCH] ** 2
        return self._read(change, -change[PITCH] * y - square * x, change[PITCH] * x - square * y)

    def wrench(self, force: Array, place: Array) -> tuple[Any, Any, Array]:
        """Force along x and y, and moment about the reference point, of a force or moment here."""
        if self.along is None:
            return 0.0, 0.0, force * self.share
        x, y = self.turned(place[PITCH])
        fx, fy = force * self.along[0], force * self.along[1]
        return fx, fy, x * fy - y * fx

    def turned(self, pitch: Array) -> tuple[Array, Array]:
        """The arm, turned with the support."""
        c, s = np.cos(pitch), np.sin(pitch)
        return c * self.arm[0] - s * self.arm[1], s * self.arm[0] + c * self.arm[1]

    def _read(self, moved: Array, x: Array, y: Array) -> Array:
        """A motion (3, ...) of the reference point, beside which the point moves by (x, y)."""
        if self.along is None:
            return np.asarray(moved[PITCH] * self.share)
        along_x, along_y = self.along
        return np.asarray(along_x * (moved[SURGE] + x) + along_y * (moved[HEAVE] + y))


@dataclass(frozen=True, eq=False)
class MountContact:
    """A mount: a spring and damper that may be preloaded, and may push on one side only."""

    name: str
    at: Reading
    preload: float
    stiffness: float
    damping: float
    one_sided: bool

    def force(self, place: Array, rate: Array) -> Array:
        """With which it pushes the support, N or N m."""
        return self.pushing(self.at.displacement(place), self.at.velocity(place, rate))

    def pushing(self, moved: Array, moving: Array) -> Array:
        """Force by a displacement, m or rad, and its rate."""
        force = self.preload - self.stiffness * moved - self.damping * moving
        if self.one_sided:
            force = np.where(force.real > 0, force, 0.0)
        return force


def contacts_of(body: SupportBody, rest: Rest) -> tuple[MountContact, ...]:
    """The mounts, where they act in the plane."""
    mount_contacts = []
    for name, mount in body.support.mounts.items():
        rates = mount.spring, mount.damper
        at = Reading.of(body, mount)
        mount_contacts.append(MountContact(name, at, rest.preload[name], *rates, mount.one_sided))
    return tuple(mount_contacts)
