"""Rigid bodies in space, as URDF and MJCF have them, and the masses of their shapes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from math import pi
from typing import Literal
from xml.etree.ElementTree import Element

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, at_place
from equipoise.exchange.reading.imported import NoteTaker
from equipoise.exchange.reading.markup import called, number, numbers
from equipoise.i18n import Note
from equipoise.signals import Array

WORLD = "world"
DOWN = (0.0, 0.0, -9.80665)
"""m/s2, of files without gravity."""

MOST = 200
"""Bodies; no linkage has so many."""


ONE_SHAFT = 1e-9
"""By which the cosine between axes of one shaft may differ from 1, and they may lie apart over
their distance from the origin: more than the rounding of a chain of bodies leaves."""


@dataclass(frozen=True)
class SpatialOptions:
    """Options of an import of bodies in space.

    still : bodies that are held still, whatever joints they have.
    pins : that close loops, each as ``A = B`` of two bodies, or points of them.
    """

    still: tuple[str, ...] = ()
    pins: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Frame3:
    """Axes in space: their origin (3,), m, and their directions as columns (3, 3)."""

    origin: Array = field(default_factory=lambda: np.zeros(3))
    turn: Array = field(default_factory=lambda: np.eye(3))

    def __matmul__(self, inner: Frame3) -> Frame3:
        return Frame3(self.out(inner.origin), self.turn @ inner.turn)

    def out(self, place: Array) -> Array:
        """Where a place (3,) in these axes is in those around them."""
        values: Array = self.origin + self.turn @ place
        return values


@dataclass(frozen=True, eq=False)
class Lump:
    """Mass, kg; its centre (3,), m; moments and products of inertia about it (3, 3), kg m2."""

    mass: float
    center: Array
    inertia: Array

    def placed(self, at: Frame3) -> Lump:
        """The lump in the axes in which its own axes are at `at`."""
        return Lump(self.mass, at.out(self.center), at.turn @ self.inertia @ at.turn.T)


def combined(lumps: list[Lump]) -> Lump:
    """Several as one."""
    mass = sum(lump.mass for lump in lumps)
    if not mass:
        return Lump(0.0, lumps[0].center, np.zeros((3, 3)))
    center = sum((lump.mass * lump.center for lump in lumps), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for item in lumps:
        arm = item.center - center
        inertia += item.inertia + item.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return Lump(mass, center, inertia)


@dataclass(eq=False)
class Solid:
    """A body where it is drawn.

    lump : in space; `None` where the file has no inertia.  points : places in space by name.
    """

    name: str
    axes: Frame3
    lump: Lump | None = None
    points: dict[str, Array] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Joint3:
    """What holds a body on another: place (3,) and axis (3,) in space, of length 1."""

    name: str
    kind: Literal["hinge", "slide"]
    parent: str
    child: str
    place: Array
    axis: Array


@dataclass(frozen=True, eq=False)
class Loop3:
    """A point of one body that stays at a point of another, each (3,) in space."""

    name: str
    bodies: tuple[str, str]
    places: tuple[Array, Array]


@dataclass(frozen=True)
class Pull:
    """A spring between points of two bodies, N/m and m."""

    ends: tuple[tuple[str, str], tuple[str, str]]
    stiffness: float
    free_length: float


@dataclass(eq=False)
class Space(NoteTaker):
    """A system of bodies, where it is drawn.

    rigid : pairs of bodies that are one.  sums : of angles of hinges by name, each with a factor,
    that stay what they are.  driven : hinge that is driven.  speed : of its coordinate, rad/s.
    loose : bodies that move freely in the plane.
    """

    title: str
    gravity: tuple[float, ...] = DOWN
    solids: dict[str, Solid] = field(default_factory=lambda: {WORLD: Solid(WORLD, Frame3())})
    joints: dict[str, Joint3] = field(default_factory=dict)
    loops: list[Loop3] = field(default_factory=list)
    rigid: list[tuple[str, str]] = field(default_factory=list)
    sums: list[tuple[str, Mapping[str, float]]] = field(default_factory=list)
    pulls: list[Pull] = field(default_factory=list)
    driven: str = ""
    speed: float | None = None
    notes: list[str] = field(default_factory=list)
    loose: list[str] = field(default_factory=list)

    def add(self, solid: Solid) -> None:
        """Refuses a name that is there already, and more bodies than a machine has."""
        if len(self.solids) > MOST:
            raise ModelError(
                "", Note("there are more than {most} bodies; give a linkage", most=MOST)
            )
        if solid.name in self.solids:
            raise ModelError(
                "", Note("two bodies are called {name!r}; rename one", name=solid.name)
            )
        self.solids[solid.name] = solid

    def join(self, joint: Joint3) -> None:
        """Refuses a name that is there already."""
        if joint.name in self.joints:
            raise ModelError(
                "", Note("two joints are called {name!r}; rename one", name=joint.name)
            )
        self.joints[joint.name] = joint

    def hold(self, body: str) -> None:
        """Let a body stand still, without the joints and bodies between it and the world."""
        self.rigid.append((WORLD, body))
        while matching_joints := [key for key, joint in self.joints.items() if joint.child == body]:
            body = self.joints[matching_joints[0]].parent
            self._drop(matching_joints[0], {})
            self.rigid.append((WORLD, body))

    def _drop(self, joint: str, instead: Mapping[str, str]) -> None:
        """Leave out a joint, in whose place others stand in sums, or none."""
        del self.joints[joint]
        self.driven = instead.get(self.driven, self.driven)
        for index, (name, factors) in enumerate(self.sums):
            left: dict[str, float] = {}
            for key, factor in factors.items():
                new = instead.get(key, key)
                if new in self.joints:
                    left[new] = left.get(new, 0.0) + factor
            self.sums[index] = name, {key: item for key, item in left.items() if item}

    def tie_shafts(self) -> None:
        """Make one of bodies that turn together about one axis, as linkages in a row do."""
        order = [*self.joints]
        for index in range(len(self.sums)):
            factors = self.sums[index][1]
            if len(factors) != 2 or sum(factors.values()) != 0:
                continue
            entry, other = (self.joints[key] for key in sorted(factors, key=order.index))
            apart = np.linalg.norm(np.cross(other.place - entry.place, entry.axis))
            reach = np.linalg.norm(entry.place) + np.linalg.norm(other.place)
            same = entry.parent == other.parent and float(entry.axis @ other.axis) > 1 - ONE_SHAFT
            if same and apart <= ONE_SHAFT * (1 + reach):
                self.rigid.append((entry.child, other.child))
                self._drop(other.name, {other.name: entry.name})
        self.sums = [item for item in self.sums if item[1]]


SHORTEST = 1e-12
"""Length below which an axis or a quaternion is 0 but for the digits of the file: of numbers of
about 1, which have 15 at most, no fewer than three would be left.
"""


def direction(where: str, given: tuple[float, ...]) -> Array:
    """A vector (3,) of length 1.

    Raises
    ------
    ModelError : it has no length.
    """
    vector = np.array(given)
    length = float(np.linalg.norm(vector))
    if length < SHORTEST:
        raise ModelError(where, Note("its axis has no length; give one such as 0 0 1"))
    values: Array = vector / length
    return values


def _cross_matrix(vector: Array) -> Array:
    """The matrix (3, 3) whose product with another vector is the cross product with it."""
    x, y, z = vector
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def turned(axis: Array, angle: float) -> Array:
    """Rotation about an axis of length 1 by an angle, rad: (3, 3)."""
    cross = _cross_matrix(axis)
    values: Array = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return values


def by_euler(angles: tuple[float, ...], order: str) -> Array:
    """Rotation by angles (rad) about the axes of an order, each turned by those before it; in
    capitals about axes that stay.
    """
    values = np.eye(3)
    for angle, letter in zip(angles, order, strict=True):
        item = turned(np.eye(3)["xyz".index(letter.lower())], angle)
        values = values @ item if letter.islower() else item @ values
    return values


def by_quaternion(where: str, given: tuple[float, ...]) -> Array:
    """Rotation of w, x, y, z, of any length but 0."""
    length = float(np.linalg.norm(given))
    if length < SHORTEST:
        raise ModelError(where, Note("its quat has no length; give one such as 1 0 0 0"))
    w, *rest = (item / length for item in given)
    vector = np.array(rest)
    sine = float(np.linalg.norm(vector))
    return turned(vector / sine, 2 * np.arctan2(sine, w)) if sine > 1e-300 else np.eye(3)


WATER = "1000"
"""kg/m3, where a shape has neither mass nor density."""
SIZES = {"sphere": 1, "ellipsoid": 3, "box": 3, "capsule": 2, "cylinder": 2}
"""How many numbers the size of a shape has: radii and half lengths, m."""
LEAST = 1e-9
"""m, below which a size is none."""
ENDLESS = {"plane", "hfield"}
"""Shapes without a mass."""


def lumps(geom: Element, axes: Frame3) -> list[Lump | None]:
    """Mass of a shape in the axes of its body: nothing of one that has none, `None` of a mesh or
    another whose mass is not known here.
    """
    kind = geom.get("type", "mesh" if geom.get("mesh") else "sphere")
    if kind not in SIZES:
        return [] if kind in ENDLESS else [None]
    if kind in ("box", "cylinder", "capsule", "ellipsoid") and geom.get("fromto"):
        axes, half = _between(geom)
        radius = (*numbers(geom, "size", "0"), 0.0)[0]
        sizes: tuple[float, ...] = (radius, half) if SIZES[kind] == 2 else (radius, radius, half)
    else:
        sizes = numbers(geom, "size")[: SIZES[kind]]
    if len(sizes) < SIZES[kind] or min(sizes) < LEAST:
        raise ModelError(
            called(geom),
            at_place(
                "size", Note("a {kind} needs {sizes} numbers above 0", kind=kind, sizes=SIZES[kind])
            ),
        )
    volume, squares = _solid(kind, sizes)
    mass = number(geom, "mass") if geom.get("mass") else volume * number(geom, "density", WATER)
    return [Lump(mass, np.zeros(3), mass * np.diag(squares)).placed(axes)]


def toward(axis: Array) -> Array:
    """The smallest rotation that turns z into an axis of length 1."""
    z = np.array([0.0, 0.0, 1.0])
    across, along = np.cross(z, axis), float(axis @ z)
    if along < -1 + 1e-12:
        return np.diag([1.0, -1.0, -1.0])
    cross = _cross_matrix(across)
    values: Array = np.eye(3) + cross + cross @ cross / (1 + along)
    return values


def _between(geom: Element) -> tuple[Frame3, float]:
    """Axes in the middle of two ends, z along them, and half their distance."""
    ends = np.array(numbers(geom, "fromto", count=(6,))).reshape(2, 3)
    way = ends[0] - ends[1]
    axis = direction(called(geom), tuple(way))
    return Frame3(ends.mean(0), toward(axis)), float(np.linalg.norm(way)) / 2


def _solid(kind: str, sizes: tuple[float, ...]) -> tuple[float, tuple[float, float, float]]:
    """Volume, and squares of the radii of gyration about the three axes."""
    if kind == "box":
        return 8 * float(np.prod(sizes)), _three(sizes, 1 / 3)
    if kind == "ellipsoid":
        return 4 / 3 * pi * float(np.prod(sizes)), _three(sizes, 1 / 5)
    r = sizes[0]
    if kind == "sphere":
        return 4 / 3 * pi * r**3, (0.4 * r**2,) * 3
    half = sizes[1]
    tube, across = 2 * pi * r**2 * half, r**2 / 4 + half**2 / 3
    if kind == "cylinder":
        return tube, (across, across, r**2 / 2)
    ball = 4 / 3 * pi * r**3
    center = 3 / 8 * r + half  # of a half ball at an end
    tip = 0.4 * r**2 - (3 / 8 * r) ** 2 + center**2
    volume = tube + ball
    both = (tube * across + ball * tip) / volume
    return volume, (both, both, (tube * r**2 / 2 + ball * 0.4 * r**2) / volume)


def _three(sizes: tuple[float, ...], share: float) -> tuple[float, float, float]:
    a, b, c = (size**2 for size in sizes)
    return share * (b + c), share * (a + c), share * (a + b)
