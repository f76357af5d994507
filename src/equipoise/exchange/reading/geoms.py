"""Masses of the shapes of MJCF, as MuJoCo takes them where a body tells no inertial."""

from __future__ import annotations

from math import pi
from xml.etree.ElementTree import Element

import numpy as np

from equipoise.errors import ModelError, at_place
from equipoise.exchange.reading.markup import called, number, numbers
from equipoise.exchange.reading.spatial import Array, Frame3, Lump, direction
from equipoise.i18n import Note

WATER = "1000"
"""kg/m3, where a shape tells neither mass nor density."""
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
    x, y, w = across
    cross = np.array([[0, -w, y], [w, 0, -x], [-y, x, 0]])
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
