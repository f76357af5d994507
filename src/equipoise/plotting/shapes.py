"""Signs of a linkage as lines and circles, for whatever draws them.

Places are complex numbers in pixels, x to the right and y downward.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Look:
    """How a shape is drawn.

    fill, line : names of colours in `plotting.cartoon.LIGHT`; none where there is none.
    width : of the line.  dashes : lengths of dash and gap.  Both for a picture 640 pixels wide.
    flat : whether the line ends where it ends, instead of in a half circle.
    """

    fill: str | None
    line: str | None
    width: float = 0.0
    dashes: tuple[float, float] | None = None
    flat: bool = False


BLOCK = 13.0, 8.0
"""Half the length and half the height of a sliding block."""
FOOT = 22.0
"""How far a pivot's sign reaches below it."""
EDGE, BODY = 10.4, 8.6
"""Width of a bar with and without its outline."""

LOOKS = {
    "wheel": Look("wheel", "lines", 1.0),
    "spoke": Look(None, "faint", 3.0),
    "trace": Look(None, "main", 1.6),
    "force-path": Look(None, "stress", 1.1, (4.0, 3.0)),
    "tie": Look(None, "faint", 3.0),
    "rail": Look(None, "lines", 1.2),
    "hatch": Look(None, "lines", 0.8),
    "edge": Look("lines", "lines", EDGE),
    "body": Look("pale", "pale", BODY),
    "rim": Look("pale", "lines", 1.0),
    "slot": Look("paper", "lines", 1.0),
    "block": Look("paper", "lines", 1.2),
    "spring": Look(None, "lines", 1.4),
    "stand": Look("paper", "lines", 1.2),
    "pin": Look("paper", "lines", 1.4),
    "mass": Look("paper", "ink", 0.9),
    "quarter": Look("ink", None),
    "tip": Look("main", "paper", 1.2),
    "force": Look(None, "stress", 2.6, flat=True),
    "head": Look("stress", None),
    "scale": Look(None, "ink", 1.4),
}


@dataclass(frozen=True, eq=False)
class Shape:
    """A line through points, or a circle about the only one.

    look : name in `LOOKS`.  points : (n,) complex.  closed : whether it ends where it begins.
    radius : of a circle; 0 for a line.
    """

    look: str
    points: Array
    closed: bool = False
    radius: float = 0.0


def runs(shapes: Iterable[Shape]) -> Iterator[list[Shape]]:
    """Neighbours that are drawn alike."""
    for _, run in groupby(shapes, lambda shape: (shape.look, shape.radius > 0)):
        yield list(run)


def line(look: str, *points: complex, closed: bool = False) -> Shape:
    """A line through some points."""
    return Shape(look, np.array(points, complex), closed)


def circle(look: str, center: complex, radius: float) -> Shape:
    """A circle."""
    return Shape(look, np.array([center]), True, radius)


def plate(corners: Array) -> list[Shape]:
    """A link with rounded corners: a bar between two points, a plate around several."""
    return [Shape(look, corners, len(corners) > 2) for look in ("edge", "body")]


def wheel(center: complex, radius: float) -> list[Shape]:
    """A gear: its pitch circle with three spokes, so that one sees it turn."""
    ways = np.exp(2j * np.pi * np.arange(3) / 3)
    spokes = [line("spoke", center, center + 0.94 * radius * way) for way in ways]
    return [circle("wheel", center, radius), *spokes]


def pivot(place: complex, unit: float) -> list[Shape]:
    """The sign of a point that stands still: a stand on hatched ground."""
    half, high = 9 * unit, 15 * unit
    foot = place + 1j * high
    ground = line("rail", foot - 1.6 * half, foot + 1.6 * half)
    return [
        *_hatching(foot - 1.5 * half, foot + 1.6 * half, 1j, unit),
        line("stand", place, foot - half, foot + half, closed=True),
        ground,
    ]


def rails(low: complex, high: complex, unit: float) -> list[Shape]:
    """The frame on both sides of a block that slides from one place to the other."""
    way = _direction(low, high)
    side = way * 1j if (way * 1j).imag > 1e-6 or way.imag > 0 else way * -1j
    off, over = (BLOCK[1] + 1) * unit, (BLOCK[0] + 4) * unit
    ends = low - over * way, high + over * way
    found = [line("rail", *(end + off * s for end in ends)) for s in (side, -side)]
    return [*_hatching(ends[0] + off * side, ends[1] + off * side, side, unit), *found]


def slot(low: complex, high: complex, unit: float) -> list[Shape]:
    """The part of a link that holds a block on its way from one place to the other."""
    grown = ((BLOCK[0] + 5) * unit, (BLOCK[1] + 5) * unit), ((BLOCK[0] + 1) * unit, BLOCK[1] * unit)
    return [_box(look, low, high, *by) for look, by in zip(("rim", "slot"), grown, strict=True)]


def block(unit: float) -> list[Shape]:
    """A sliding block at the origin, along x."""
    return [_box("block", 0, 0, BLOCK[0] * unit, BLOCK[1] * unit)]


def zigzag(length: float, unit: float) -> Shape:
    """A spring from the origin along x."""
    coils = max(5, round(0.7 * length / (16 * unit)))
    steps = (np.arange(2 * coils) + 0.5) / (2 * coils)
    along = length * np.concatenate([[0, 0.15], 0.15 + 0.7 * steps, [0.85, 1]])
    side = 7 * unit * np.array([0, 0, *([1, -1] * coils), 0, 0])
    return Shape("spring", along + 1j * side)


def mass(center: complex, unit: float) -> list[Shape]:
    """The sign of a centre of mass: two dark quarters of a circle."""
    radius = 4.6 * unit
    arc = radius * np.exp(1j * np.linspace(0, np.pi / 2, 7))
    quarters = [
        Shape("quarter", center + way * np.concatenate([[0], arc]), closed=True) for way in (1, -1)
    ]
    return [circle("mass", center, radius), *quarters]


def off_outline(place: complex, corners: Sequence[complex]) -> float:
    """How far a place lies outside a line or a convex plate; 0 inside."""
    around = np.array(corners)
    edges = np.roll(around, -1) - around
    arms = place - around
    along = np.clip((arms * edges.conj()).real / abs(edges) ** 2, 0, 1)
    inside = (edges.conj() * arms).imag
    if len(around) > 2 and (np.all(inside >= 0) or np.all(inside <= 0)):
        return 0.0
    return float(abs(arms - along * edges).min())


def _hatching(low: complex, high: complex, side: complex, unit: float) -> list[Shape]:
    """Short slanting lines off one side of a line."""
    way, length = _direction(low, high), abs(high - low)
    count = max(2, round(length / (5.5 * unit)))
    feet = low + way * length * np.arange(1, count) / count
    return [line("hatch", foot, foot + (side - way) * 5 * unit) for foot in feet]


def _box(look: str, low: complex, high: complex, length: float, height: float) -> Shape:
    """A rectangle that reaches beyond two places along their line, and to both sides of it."""
    way = _direction(low, high)
    along, across = length * way, height * 1j * way
    corners = (low - along - across, high + along - across)
    return line(look, *corners, high + along + across, low - along + across, closed=True)


def _direction(low: complex, high: complex) -> complex:
    return (high - low) / abs(high - low) if high != low else 1 + 0j
