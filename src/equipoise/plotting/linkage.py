"""A machine drawn at one crank angle: links, joints, gears, springs and the frame's pivots."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon
from matplotlib.path import Path

from equipoise.mechanism.model import FRAME
from equipoise.plotting.style import FAINT, INK, LINES, PALE
from equipoise.scene import hull

if TYPE_CHECKING:
    from equipoise.scene import Guide, Scene

Array = np.ndarray[Any, Any]

STUB = 0.3
"""Inches by which a line of a block goes on beyond where the block gets."""
BLOCK = 0.1 * np.array([1 + 0.6j, -1 + 0.6j, -1 - 0.6j, 1 - 0.6j])
"""Inches: corners of a block on a line along x."""
HALF, HIGH = 0.075, 0.13
"""Inches: half the width of a pivot's stand, and its height."""
HATCH = (-1.2, -0.4, 0.4, 1.2)
"""Where its hatching is, over half its width."""
CENTER = 6.5
"""Points: size of the sign of a centre of mass."""
QUARTERS = Path.make_compound_path(Path.wedge(0, 90), Path.wedge(180, 270))
"""Two quarters of a circle of radius 1."""


@dataclass(frozen=True)
class Slot:
    """A block on the line from `start` to `end`, whose direction is `way`, of size 1.

    on_frame : whether the line stands still.
    """

    place: complex
    way: complex
    start: complex
    end: complex
    on_frame: bool


@dataclass(frozen=True)
class Sketch:
    """Where everything is at one crank angle; complex, m.

    frame, places : points of the frame, and every point once, by name.
    outlines : link -> places around it.
    pins : points that bodies share.  held : those, and ends of springs.
    circles : pitch circles of gears, as middle and radius.
    slots : sliding joints.
    springs : both ends of each, the frame's last.
    mass_centers : link -> its centre of mass.
    """

    frame: dict[str, complex]
    places: dict[str, complex]
    outlines: dict[str, Array]
    pins: frozenset[str]
    held: frozenset[str]
    circles: tuple[tuple[complex, float], ...]
    slots: tuple[Slot, ...]
    springs: tuple[tuple[complex, complex], ...]
    mass_centers: dict[str, complex]

    @property
    def corners(self) -> Array:
        """Places that the picture has to hold."""
        round_about = [
            middle + radius * way for middle, radius in self.circles for way in (1, -1, 1j, -1j)
        ]
        return np.array([*self.places.values(), *round_about])


def sketch(scene: Scene, k: int = 0) -> Sketch:
    """A scene at the k-th of its crank angles."""
    places = {name: complex(place[k]) for name, place in scene.places.items()}

    def slot(guide: Guide) -> Slot:
        place, way = places[guide.point], complex(guide.way[k])
        ends = place - way * guide.behind[k], place + way * guide.ahead[k]
        return Slot(place, way, *ends, guide.on == FRAME)

    return Sketch(
        {name: places[name] for name in scene.frame},
        places,
        {body.name: np.array([places[name] for name in body.outline]) for body in scene.bodies},
        scene.pins,
        scene.pins | {to for _, to in scene.springs},
        tuple((places[wheel.center], wheel.radius) for wheel in scene.wheels),
        tuple(slot(guide) for guide in scene.guides),
        tuple((places[point], places[to]) for point, to in scene.springs),
        {link: complex(center[k]) for link, center in scene.mass_centers.items()},
    )


def draw_sketch(axes: Axes, drawn: Sketch, scale: float, inch: float) -> None:
    """Draw a machine lightly.

    scale : units of the axes in a metre.  inch : units of the axes in an inch.
    """
    for middle, radius in drawn.circles:
        at, look = _pair(middle * scale), {"ec": FAINT, "ls": (0, (4, 2)), "lw": 0.9}
        axes.add_patch(Circle(at, radius * scale, fill=False, **look))
    for outline in drawn.outlines.values():
        _draw_link(axes, outline * scale)
    for slot in drawn.slots:
        _draw_slot(axes, slot, scale, inch)
    for one, other in drawn.springs:
        _draw_spring(axes, one * scale, other * scale, inch)
    draw_frame(axes, drawn, scale, inch)
    joints = [place * scale for name, place in drawn.places.items() if name in drawn.pins]
    axes.plot(
        np.real(joints),
        np.imag(joints),
        "o",
        color=LINES,
        markerfacecolor="white",
        markersize=4.5,
        markeredgewidth=0.9,
        zorder=2.6,
    )


def draw_mass_centers(axes: Axes, drawn: Sketch, scale: float) -> None:
    """The sign of a centre of mass in each link that has one, and a line to one outside."""
    for link, center in drawn.mass_centers.items():
        around = drawn.outlines[link]
        if center in hull(np.append(around, center)):
            line = scale * np.array([_nearest(around, center), center])
            axes.plot(line.real, line.imag, color=LINES, linewidth=1.4, zorder=1.7)
    centers = scale * np.array([*drawn.mass_centers.values()])
    look: Any = {"linestyle": "none", "markersize": CENTER, "zorder": 2.7}
    axes.plot(centers.real, centers.imag, marker="o", mfc="white", mec=INK, mew=0.7, **look)
    look["markersize"] = 0.94 * CENTER
    axes.plot(centers.real, centers.imag, marker=QUARTERS, mfc=INK, mew=0, **look)


def _nearest(around: Array, place: complex) -> complex:
    """The place on an outline that is nearest to a place outside."""
    starts, ways = around, np.roll(around, -1) - around
    lengths = np.maximum(np.abs(ways), 1e-150)
    along = np.clip(((place - starts) * np.conj(ways)).real / lengths**2, 0.0, 1.0)
    feet = starts + along * ways
    return complex(feet[np.argmin(np.abs(feet - place))])


def _draw_link(axes: Axes, around: Array) -> None:
    """A bar between two points, a plate around several."""
    if len(around) < 2:
        return
    if len(around) == 2:
        _draw_bar(axes, around)
        return
    corners = np.column_stack([around.real, around.imag])
    look: Any = {"fc": PALE, "ec": LINES, "lw": 0.7, "alpha": 0.8, "joinstyle": "round"}
    axes.add_patch(Polygon(corners, zorder=1.4, **look))


def _draw_bar(axes: Axes, ends: Array) -> None:
    look: Any = {"solid_capstyle": "round"}
    for color, width, order in ((LINES, 5.4, 1.5), (PALE, 4.0, 1.6)):
        axes.plot(ends.real, ends.imag, color=color, linewidth=width, zorder=order, **look)


def _draw_slot(axes: Axes, slot: Slot, scale: float, inch: float) -> None:
    """A block on its line, with ground beside one that stands still."""
    line = np.array([slot.start, slot.end]) * scale + STUB * inch * slot.way * np.array([-1, 1])
    axes.plot(line.real, line.imag, color=LINES, linewidth=0.9, linestyle="-.", zorder=2.3)
    if slot.on_frame:
        _draw_rail(axes, line, inch)
    box = BLOCK * inch * slot.way + slot.place * scale
    corners = np.column_stack([box.real, box.imag])
    axes.add_patch(Polygon(corners, fc="white", ec=LINES, lw=0.9, zorder=2.4))


def _draw_rail(axes: Axes, line: Array, inch: float) -> None:
    """Hatched ground below a block's line."""
    rail = rail_of(line, inch)
    way = (rail[1] - rail[0]) / abs(rail[1] - rail[0])
    axes.plot(rail.real, rail.imag, color=LINES, linewidth=1.1, zorder=2.3)
    count = max(int(abs(rail[1] - rail[0]) / (0.09 * inch)), 2)
    feet = rail[0] + (rail[1] - rail[0]) * (np.arange(count) + 0.5) / count
    hatch = _apart(feet[:, None] - way * HALF * inch * np.array([0, 0.5 + 0.5j]))
    axes.plot(hatch.real, hatch.imag, color=LINES, linewidth=0.6, zorder=2.3)


def rail_of(line: Array, inch: float) -> Array:
    """Ends of the ground below a block's line (2,), from left to right."""
    start, end = line if (line[1] - line[0]).real > -1e-9 * abs(line[1] - line[0]) else line[::-1]
    way = (end - start) / (abs(end - start) or 1.0)
    return np.asarray(np.array([start, end]) - 1j * way * BLOCK[0].imag * inch)


def _draw_spring(axes: Axes, one: complex, other: complex, inch: float) -> None:
    """A zigzag, straight at both ends."""
    along = np.concatenate([[0, 0.15], 0.15 + 0.7 * (np.arange(10) + 0.5) / 10, [0.85, 1]])
    side = np.array([0, 0, *([1, -1] * 5), 0, 0]) * 0.05 * inch
    across = 1j * (other - one) / (abs(other - one) or 1.0)
    line = one + (other - one) * along + across * side
    axes.plot(line.real, line.imag, color=LINES, linewidth=0.9, zorder=2.2)


def draw_frame(axes: Axes, drawn: Sketch, scale: float, inch: float) -> None:
    """Stands below what carries something; other places of the frame as dots."""
    stands = [z for name, z in drawn.frame.items() if name in drawn.held]
    dots = scale * np.array([z for name, z in drawn.frame.items() if name not in drawn.held])
    _draw_pivots(axes, scale * np.array(stands), inch)
    if dots.size:
        axes.plot(dots.real, dots.imag, ".", color=LINES, markersize=5, zorder=2.5)


def _draw_pivots(axes: Axes, places: Array, inch: float) -> None:
    """The sign of points that stand still: a stand on hatched ground."""
    half, high = HALF * inch, HIGH * inch
    feet = places - 1j * high
    for place, foot in zip(places, feet, strict=True):
        stand = np.array([place, foot - half, foot + half])
        corners = np.column_stack([stand.real, stand.imag])
        axes.add_patch(Polygon(corners, fc="white", ec=LINES, lw=0.9, zorder=2.5))
    ground = _apart(feet[:, None] + half * np.array([-1.7, 1.7]))
    axes.plot(ground.real, ground.imag, color=LINES, linewidth=1.1, zorder=2.5)
    strokes = feet[:, None, None] + half * np.array([[k, k - 0.5 - 0.5j] for k in HATCH])
    hatch = _apart(strokes.reshape(-1, 2))
    axes.plot(hatch.real, hatch.imag, color=LINES, linewidth=0.6, zorder=2.5)


def _apart(strokes: Array) -> Array:
    """Lines (N, 2) as one that is broken between them."""
    gaps = np.full((len(strokes), 1), complex(np.nan, np.nan))
    return np.concatenate([strokes, gaps], axis=1).ravel()


def _pair(place: complex) -> tuple[float, float]:
    return place.real, place.imag
