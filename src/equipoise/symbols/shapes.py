"""Signs of machines as plain geometry, for whatever draws them.

A corner of a shape has a place in the machine, m, and an offset from there in units, of which
whatever draws it says how large they are: a picture 640 pixels wide has units of a pixel.  So links
are to scale, and pins have one size.  Both are complex, x to the right and y upward.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import groupby
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.formulas.kernels import cross
from equipoise.signals import Array

PIN = 3.6
"""Radius."""
BLOCK = 13.0, 8.0
"""Half the length and half the height of a sliding block."""
STAND = 9.0, 15.0
"""Half the width of a pivot's stand, and its height."""
FOOT = 22.0
"""How far a pivot's sign reaches below it."""
APART = 6.0
"""Between two strokes of hatching."""
PISTON: tuple[Array, ...] = (
    np.array([0, 0.35 + 0j]),
    np.array([0.75 + 1j, 0.35 + 1j, 0.35 - 1j, 0.75 - 1j]),
    np.array([0.6 + 0.8j, 0.6 - 0.8j]),
    np.array([0.6, 1 + 0j]),
)
"""Lines of a piston in an open cylinder: along over its length, aside over half its width."""
KEPT = 128
"""Signs of a kind that are kept: while one point is dragged, most others stay where they are."""


@dataclass(frozen=True, eq=False)
class Shape:
    """A line through corners, or a circle about the only one.

    role : name in `looks.LOOKS`.
    places : (n,) complex, m.  offsets : (n,) complex, units.
    closed : whether it ends where it begins.
    radius, grown : of a circle: m and units, one of them not 0.
    """

    role: str
    places: Array
    offsets: Array
    closed: bool = False
    radius: float = 0.0
    grown: float = 0.0

    def at(self, scale: float, unit: float) -> Array:
        """Corners (n,) where a meter and a unit are so long."""
        return np.asarray(self.places * scale + self.offsets * unit)

    def size(self, scale: float, unit: float) -> float:
        """Radius of the circle there; 0 for a line."""
        return self.radius * scale + self.grown * unit


@dataclass(frozen=True, eq=False)
class BodyMark:
    """A shape that moves with a body, maybe the frame: from a point of that, in the body's axes.

    to : another point, to which the shape is stretched instead, along over 1 from the first.
    part : list and name of what it shows, if a page can have that deleted by it.
    table : key of the list that has the numbers which shape it.
    legend : role of what a legend shows of it, and what it calls that.
    """

    body: str
    point: str
    shape: Shape
    part: tuple[str, str] | None = None
    table: str = ""
    legend: tuple[str, str] | None = None
    to: str = ""


def runs(shapes: Iterable[Shape]) -> Iterator[list[Shape]]:
    """Neighbours that are drawn alike."""
    for _, run in groupby(shapes, lambda item: (item.role, item.radius + item.grown > 0)):
        yield list(run)


def line(role: str, *places: complex, closed: bool = False) -> Shape:
    """A line through places, m."""
    corners = np.array(places, complex)
    return Shape(role, corners, 0 * corners, closed)


def sign(role: str, place: complex, offsets: Any, closed: bool = False) -> Shape:
    """A line through offsets (units) from a place."""
    corners = np.array(offsets, complex)
    return Shape(role, np.full(len(corners), complex(place)), corners, closed)


def circle(role: str, center: complex, radius: float = 0.0, grown: float = 0.0) -> Shape:
    """A circle, of a radius in m or in units."""
    return Shape(role, np.array([center], complex), np.zeros(1, complex), True, radius, grown)


# -- links and what holds them ---------------------------------------------------------------------


def plate(corners: Array, roles: Sequence[str] = ("edge", "body")) -> list[Shape]:
    """A link with rounded corners: a bar between two points, a plate around several."""
    if len(corners) == 1:  # a dot is a line of next to no length
        return [sign(role, corners[0], [0, 0.01]) for role in roles]
    return [line(role, *corners, closed=len(corners) > 2) for role in roles]


def wheel(center: complex, radius: float, curve: Array | None = None) -> list[Shape]:
    """A wheel: its pitch circle, or the curve around its center that it has instead, with three
    spokes, so that one sees it turn.
    """
    ways = radius * np.exp(2j * np.pi * np.arange(3) / 3) if curve is None else _thirds(curve)
    spokes = [line("spoke", center, center + 0.94 * way) for way in ways]
    return [rim(center, radius, curve), *spokes]


def rim(center: complex, radius: float, curve: Array | None = None) -> Shape:
    """The pitch circle of a wheel, or its curve."""
    if curve is None:
        return circle("wheel", center, radius)
    return line("wheel", *(center + curve), closed=True)


def _thirds(curve: Array) -> Array:
    """Corners of a curve in three directions from its center, about equally far from each other."""
    ways = np.exp(2j * np.pi * np.arange(3) / 3) * curve[np.argmax(abs(curve))]
    return np.array([curve[np.argmin(abs(np.angle(curve / way)))] for way in ways])


@lru_cache(KEPT)
def pivot(place: complex, grounded: bool = True, way: complex = -1j) -> tuple[Shape, ...]:
    """The sign of a point that stands still: a stand, on hatched ground or on what carries it.

    way : of length 1, to the ground.
    """
    half, high = STAND
    foot, side = high * way, half * 1j * way
    shapes = hatching(place, foot + 1.6 * side, foot - 1.6 * side, way) if grounded else []
    reach = 1.6 if grounded else 1.0
    return (
        *shapes,
        sign("stand", place, [0, foot - side, foot + side], closed=True),
        sign("rail", place, [foot - reach * side, foot + reach * side]),
    )


def rails(
    low: complex, high: complex, unit: float, grounded: bool = True, meshing: int = 0
) -> list[Shape]:
    """The frame on both sides of a block that slides from one place to the other.

    unit : m, about; by which strokes of hatching are counted.
    meshing : 1 where something meshes with the block on the left of its way, -1 on the right.
    """
    way = _direction(low, high)
    side = way * 1j if (way * 1j).imag < -1e-6 or way.imag < 0 else way * -1j
    side = way * -1j * meshing if meshing else side
    off, over = BLOCK[1] + 1, BLOCK[0] + 4
    ends = np.array([low, high])
    shapes = []
    for s in (side, -side):
        offsets = np.array([-over * way, over * way]) + off * s
        shapes.append(Shape("rail", ends, offsets))
        if s == side and grounded:
            shapes[:0] = _hatched(ends, offsets, side, unit)
    return shapes


def slot(low: complex, high: complex) -> list[Shape]:
    """The part of a link that holds a block on its way from one place to the other."""
    grown = (BLOCK[0] + 5, BLOCK[1] + 5), (BLOCK[0] + 1, BLOCK[1])
    return [_box(role, low, high, *by) for role, by in zip(("rim", "slot"), grown, strict=True)]


@lru_cache(KEPT)
def block() -> tuple[Shape, ...]:
    """A sliding block at the origin, along x."""
    return (_box("block", 0, 0, *BLOCK),)


def zigzag(start: complex, end: complex, coils: int, role: str = "spring") -> Shape:
    """A spring between two places, straight at both ends."""
    steps = (np.arange(2 * coils) + 0.5) / (2 * coils)
    along = np.concatenate([[0, 0.15], 0.15 + 0.7 * steps, [0.85, 1]])
    side = 7j * np.array([0, 0, *([1, -1] * coils), 0, 0]) * _direction(start, end)
    return Shape(role, start + (end - start) * along, side)


def coils(length: float, unit: float) -> int:
    """How many a spring has; unit : m, about."""
    return max(5, round(0.7 * length / (16 * unit)))


@lru_cache(KEPT)
def mass(center: complex) -> tuple[Shape, ...]:
    """The sign of a centre of mass: two dark quarters of a circle."""
    radius = 4.6
    arc = np.concatenate([[0], radius * np.exp(1j * np.linspace(0, np.pi / 2, 7))])
    quarters = [sign("quarter", center, way * arc, closed=True) for way in (1, -1)]
    return (circle("mass", center, grown=radius), *quarters)


def driver(center: complex, radius: float, angles: Array, both: bool = False) -> list[Shape]:
    """An arrow about a drive's pivot: its arc over some angles, rad, at a radius in m.

    both : whether it has a head at either end.
    """
    arc = center + radius * np.exp(1j * angles)
    sense = np.sign(angles[-1] - angles[0])
    way = 1j * sense * np.exp(1j * (angles[-1] - 0.12 * sense))
    heads = [_head("driver-head", complex(arc[-1]), complex(way), 9.0)]
    if both:
        back = -1j * sense * np.exp(1j * (angles[0] + 0.12 * sense))
        heads.append(_head("driver-head", complex(arc[0]), complex(back), 9.0))
    return [line("driver", *arc), *heads]


def cylinder(barrel: float, rod: float) -> tuple[Shape, Shape]:
    """A cylinder's rod and barrel, each from its own pin along x, so long, m."""
    return line("piston", 0, rod), _box("barrel", 0, barrel, 0.0, 6.0)


def arrow(role: str, length: float) -> tuple[Shape, Shape]:
    """An arrow: its shaft from the origin along x, so long, m, and its head, the tip at the origin.

    The head comes apart, because it keeps its size while the shaft gets longer.
    """
    return line(role, 0, length), _head(f"{role}-head", 0, 1, 13.0)


def _head(role: str, place: complex, way: complex, size: float) -> Shape:
    back = size * (-1 + np.array([0.38j, -0.38j]))
    return sign(role, place, way * np.array([0, *back]), closed=True)


# -- the field -------------------------------------------------------------------------------------


MOST_STUBBLES = 300
"""Beyond which a picture shows none of them, as where sizes are too far apart."""


def soil(left: float, right: float, surface: float, bottom: float, unit: float) -> list[Shape]:
    """Earth from its surface down to a depth, all m."""
    corners = complex(left, surface), complex(right, surface)
    deep = complex(right, bottom), complex(left, bottom)
    count = int(np.clip((right - left) / (28 * unit), 3, MOST_STUBBLES))
    x = left + (right - left) * (np.arange(count) + 0.5) / count
    strokes = [
        sign("stubble", complex(at, surface), [k - 4j, k - 7 - 11j]) for at in x for k in (-5, 0, 5)
    ]
    ground = line("soil", *corners, *deep, closed=True)
    return [ground, *strokes, line("surface", *corners)]


# -- parts of signs --------------------------------------------------------------------------------


def hull(places: Array) -> Array:
    """Corners of the smallest convex outline around places, counterclockwise."""
    ordered = sorted({complex(place) for place in places}, key=lambda z: (z.real, z.imag))
    if len(ordered) < 3:
        return np.array(ordered)
    size = abs(ordered[-1] - ordered[0])
    chains = []
    for row in (ordered, ordered[::-1]):
        chain: list[complex] = []
        for place in row:
            while len(chain) > 1 and (
                cross(chain[-1] - chain[-2], place - chain[-2]) <= 1e-9 * size**2
            ):
                chain.pop()
            chain.append(place)
        chains += chain[:-1]
    return np.array(chains)


def off_outline(places: Any, corners: Any) -> Array:
    """How far places (...) lie outside lines or convex plates; 0 inside.

    corners : (n, ...), counterclockwise.
    """
    around = np.asarray(corners)
    edges = np.roll(around, -1, axis=0) - around
    arms = places - around
    along = (arms * edges.conj()).real / np.maximum(np.abs(edges) ** 2, 1e-300)
    apart = np.abs(arms - np.clip(along, 0, 1) * edges).min(axis=0)
    return np.where(np.all((edges.conj() * arms).imag > 0, axis=0), 0.0, apart)


def _box(role: str, low: complex, high: complex, over: float, half: float) -> Shape:
    """A rectangle around a line, so much longer at both ends and so far to both sides."""
    way = _direction(low, high)
    offsets = np.array([-over + 1j * half, over + 1j * half, over - 1j * half, -over - 1j * half])
    return Shape(role, np.array([low, high, high, low], complex), offsets * way, True)


def hatching(place: complex, start: complex, end: complex, away: complex) -> list[Shape]:
    """Short strokes behind a line between two offsets from a place, on the side away."""
    ends = np.array([place, place], complex)
    return _hatched(ends, np.array([start, end]), away, 1.0)


def _hatched(places: Array, offsets: Array, away: complex, unit: float) -> list[Shape]:
    """Strokes behind a line between two corners, on the side away; unit : m, about."""
    along = (places[1] - places[0]) / unit + offsets[1] - offsets[0]
    count = max(3, round(abs(along) / APART))
    way = along / abs(along)
    shares = (np.arange(count) + 0.5) / count
    foot = places[0] + (places[1] - places[0]) * shares
    off = offsets[0] + (offsets[1] - offsets[0]) * shares
    stroke = 5 * away - 5 * way
    return [
        Shape("hatch", np.array([at, at]), np.array([by, by + stroke]))
        for at, by in zip(foot, off, strict=True)
    ]


def _direction(low: complex, high: complex) -> complex:
    way = complex(high) - complex(low)
    return way / abs(way) if abs(way) > 1e-12 else 1 + 0j
