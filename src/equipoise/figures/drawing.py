"""Machines drawn with Matplotlib, and the parts of the plane that hold them on one scale."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from equipoise.figures.labels import Labels
from equipoise.symbols.looks import LIGHT, LOOKS
from equipoise.symbols.pieces import Piece, Track, pieces
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import Shape

if TYPE_CHECKING:
    from equipoise.mechanism.motion import Motion

Array = np.ndarray[Any, Any]

UNIT = 0.64
"""Points: size of a unit of signs on paper."""
ROOM = 0.36
"""Inches free around what is drawn, for labels."""
STILL = 1e-9
"""Over the motion of what moves most: what is less stands still."""
FAR = ("field", "support")
"""Layers on which paths are drawn."""
FARTHEST, LOWEST = 0.6, 1.3
"""Order in which the first sign of these layers, and of others, is drawn."""
ORDERS = {FARTHEST: 0.5, LOWEST: 1.3}
"""By how much the last one lies above the first."""
WEIGHTS = {"edge": 1.0, "rail": 2.0, "stand": 3.0, "slot": 1.0, "block": 2.0, "spring": 1.0}
WEIGHTS |= {"planned": 1.0, "driver": 2.0, "mount": 2.0, "tray": 4.0, "needle": 2.0, "surface": 1.0}
"""What names keep clear of, and how much it matters."""


@dataclass(frozen=True)
class Panel:
    """Limits of axes of one scale, and how many of their units make an inch."""

    left: float
    right: float
    bottom: float
    top: float
    inch: float

    @property
    def width(self) -> float:
        """Inches."""
        return (self.right - self.left) / self.inch

    @property
    def height(self) -> float:
        """Inches."""
        return (self.top - self.bottom) / self.inch

    def settle(self, axes: Axes) -> None:
        """Give axes these limits, and round numbers about half an inch apart, on both the same."""
        axes.set_xlim(self.left, self.right)
        axes.set_ylim(self.bottom, self.top)
        exact = 0.45 * self.inch
        power = 10.0 ** np.floor(np.log10(exact))
        step = next(k * power for k in (1, 2, 5, 10, 20) if k * power >= exact)
        for low, high, put in (
            (self.left, self.right, axes.set_xticks),
            (self.bottom, self.top, axes.set_yticks),
        ):
            put(step * np.arange(np.ceil(low / step), np.floor(high / step) + 1))


def hold(places: Array, wide: float, high: float, low: float = 0.0, room: float = ROOM) -> Panel:
    """The part of the plane around places (in units of the axes) that fills so many inches.

    wide : exactly.  high, low : at most and at least.  room : free around the places.
    """
    start = complex(np.min(places.real), np.min(places.imag))
    end = complex(np.max(places.real), np.max(places.imag))
    across, up = (end - start).real, (end - start).imag
    inch = max(across / (wide - 2 * room), up / (high - 2 * room)) or 1.0
    half_up = max(up / 2 + room * inch, low * inch / 2)
    middle, half = (start + end) / 2, complex(wide * inch / 2, half_up)
    first, last = middle - half, middle + half
    return Panel(first.real, last.real, first.imag, last.imag, inch)


# -- a machine -------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Placed:
    """A shape where it is drawn, in units of the axes: corners (n,) complex, radius of a circle."""

    role: str
    corners: Array
    closed: bool
    radius: float
    link: str = ""
    layer: str = ""

    @property
    def path(self) -> Path:
        """As Matplotlib has it."""
        if self.radius:
            return Path.circle((self.corners[0].real, self.corners[0].imag), self.radius)
        corners = self.corners
        if self.closed:
            corners = np.append(corners, corners[:1])
        return Path(np.column_stack([corners.real, corners.imag]), closed=self.closed)


@dataclass(frozen=True, eq=False)
class Drawn:
    """A machine at the k-th crank angle of a scene.

    scale : units of the axes in a meter.  inch : units of the axes in an inch.
    size : of signs, over their usual one.
    """

    scene: Scene
    k: int
    scale: float
    inch: float
    size: float = 1.0

    @property
    def unit(self) -> float:
        """Of signs, in units of the axes."""
        return UNIT * self.size * self.inch / 72

    @property
    def points(self) -> dict[str, complex]:
        """Where every point is, in units of the axes."""
        return {
            name: self.scale * complex(place[self.k]) for name, place in self.scene.places.items()
        }

    @property
    def mass_centers(self) -> dict[str, complex]:
        """Likewise, of links whose mass is known."""
        centers = self.scene.mass_centers
        return {name: self.scale * complex(place[self.k]) for name, place in centers.items()}

    @property
    def outlines(self) -> dict[str, Array]:
        """Link -> what lies around it, likewise."""
        points = self.points
        return {
            body.name: np.array([points[name] for name in body.outline])
            for body in self.scene.bodies
        }

    def placed(self, piece: Piece) -> list[Placed]:
        """The shapes of a piece where they are at this crank angle."""
        track = piece.track(self.scene)
        return [self._placed(shape, track, piece) for shape in piece.shapes]

    def _placed(self, shape: Shape, track: Track | None, piece: Piece) -> Placed:
        size = shape.size(self.scale, self.unit)
        places, offsets = shape.places, shape.offsets
        if track is not None:
            turn = np.exp(1j * track.angle[self.k])
            stretched = places.real * track.stretch[self.k] + 1j * places.imag
            places, offsets = track.place[self.k] + stretched * turn, offsets * turn
        corners = places * self.scale + offsets * self.unit
        return Placed(shape.role, corners, shape.closed, size, piece.link, piece.layer)


def draw_machine(
    axes: Axes, drawn: Drawn, keep: Callable[[Piece], bool] = lambda piece: True, field: bool = True
) -> list[Placed]:
    """Draw the pieces of a machine that are kept; what was drawn."""
    found = [
        one
        for piece in pieces(drawn.scene, field=field)
        if keep(piece)
        for one in drawn.placed(piece)
    ]
    far = [one for one in found if one.layer in FAR]
    draw(axes, far, drawn.size, FARTHEST)
    draw(axes, [one for one in found if one not in far], drawn.size)
    return found


def draw(axes: Axes, shapes: Iterable[Placed], size: float = 1.0, lowest: float = LOWEST) -> None:
    """Draw shapes, the first of them lowest, in the looks of their roles."""
    runs = [list(run) for _, run in groupby(shapes, lambda one: one.role)]
    for number, run in enumerate(runs):
        look, dot = LOOKS[run[0].role], UNIT * size
        dashes = (0, [length * dot for length in look.dashes]) if look.dashes else "-"
        patch = PathPatch(
            Path.make_compound_path(*(one.path for one in run)),
            facecolor=LIGHT[look.fill] if look.fill else "none",
            edgecolor=LIGHT[look.line] if look.line else "none",
            linewidth=look.width * dot if look.line else 0.0,
            linestyle=dashes,
            capstyle="butt" if look.dashes or look.flat else "round",
            joinstyle="round",
            zorder=lowest + ORDERS.get(lowest, 0.4) * number / len(runs),
            gid=run[0].role,
        )
        axes.add_patch(patch)


def keep_clear(labels: Labels, shapes: Iterable[Placed]) -> None:
    """Keep names away from what is drawn."""
    for one in shapes:
        if one.radius and one.role != "wheel":
            middle = complex(one.corners[0])
            labels.reserve(middle.real, middle.imag, half=4 * UNIT)
        elif one.role in WEIGHTS:
            corners = np.append(one.corners, one.corners[:1]) if one.closed else one.corners
            labels.avoid(corners.real, corners.imag, WEIGHTS[one.role])


def key_of(role: str, label: str) -> Line2D:
    """A line for the legend, in the look of a role."""
    look = LOOKS[role]
    dashes: Any = (0, [length * UNIT for length in look.dashes]) if look.dashes else "-"
    color = LIGHT[look.line or "ink"]
    return Line2D([], [], color=color, linestyle=dashes, linewidth=look.width * UNIT, label=label)


def mass_key(label: str) -> Line2D:
    """The sign of a centre of mass for the legend."""
    quarters = Path.make_compound_path(Path.wedge(0, 90), Path.wedge(180, 270))
    look: Any = {"linestyle": "none", "markersize": 6, "mec": LIGHT["ink"], "mew": 0.7}
    return Line2D([], [], marker=quarters, mfc=LIGHT["ink"], label=label, **look)


def draw_still(
    axes: Axes, shapes: Iterable[Shape], scale: float, inch: float, lowest: float = FARTHEST
) -> list[Placed]:
    """Draw shapes that stand still; scale and inch as in `Drawn`."""
    unit = UNIT * inch / 72
    found = [
        Placed(one.role, one.at(scale, unit), one.closed, one.size(scale, unit)) for one in shapes
    ]
    draw(axes, found, lowest=lowest)
    return found


def arrow(axes: Axes, tail: complex, head: complex, **look: Any) -> None:
    """An arrow in units of the axes."""
    coordinates = look.pop("coordinates", "data")
    order = look.pop("zorder", 4)
    axes.annotate(
        "",
        (head.real, head.imag),
        xytext=(tail.real, tail.imag),
        xycoords=coordinates,
        textcoords=coordinates,
        arrowprops={"arrowstyle": "-|>", "color": LIGHT["ink"], "shrinkA": 0, "shrinkB": 0, **look},
        zorder=order,
    )


# -- points ----------------------------------------------------------------------------------------


def moving(motion: Motion) -> list[str]:
    """Points that do not stand still."""
    fastest = {name: float(np.max(np.abs(point.place_1))) for name, point in motion.points.items()}
    least = STILL * max(fastest.values())
    return [name for name, rate in fastest.items() if rate > least]


def traced(motion: Motion) -> list[str]:
    """Points with a path worth following: those of couplers, first those that are no joint.

    A point of a link that is pinned to the frame runs on a circle; these come only where a machine
    has no others, and those of the drive last of all.
    """
    machine, joints = motion.machine, motion.linkage.joints
    pinned = [link for link in machine.links.values() if set(link.points) & set(machine.frame)]
    circling = {point for link in pinned for point in link.points}
    names = moving(motion)
    driven = [name for name in names if name not in machine.links[machine.drive.link].points]
    found = [name for name in names if name not in circling] or driven or names
    return sorted(found, key=lambda name: name in joints.pins)
