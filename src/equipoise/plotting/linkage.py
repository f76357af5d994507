"""A machine drawn at one crank angle: links, joints, gears, springs and the frame's pivots."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon

from equipoise.mechanism import kernels
from equipoise.mechanism.joints import gear_pins
from equipoise.mechanism.model import FRAME
from equipoise.mechanism.steps import u
from equipoise.plotting.style import FAINT, LINES, PALE

if TYPE_CHECKING:
    from equipoise.mechanism.model import Slider
    from equipoise.mechanism.tip import TipCurve

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Sketch:
    """Where everything is at one crank angle; complex, m.

    frame, links : names of points and their places.  pins : points that bodies share.
    circles : pitch circles of gears, as middle and radius.
    guides : sliders as the place of the block and the direction of its line.
    springs : both ends of each, the frame's last.
    """

    frame: dict[str, complex]
    links: dict[str, dict[str, complex]]
    pins: frozenset[str]
    circles: tuple[tuple[complex, float], ...]
    guides: tuple[tuple[complex, complex], ...]
    springs: tuple[tuple[complex, complex], ...]

    @property
    def places(self) -> dict[str, complex]:
        """Every point once, those of the frame first."""
        places = dict(self.frame)
        for points in self.links.values():
            places = {**points, **places}
        return places

    @property
    def corners(self) -> Array:
        """Places that the picture has to hold."""
        round_about = [
            middle + radius * way for middle, radius in self.circles for way in (1, -1, 1j, -1j)
        ]
        return np.array([*self.places.values(), *round_about])


def sketch(curve: TipCurve, theta: float) -> Sketch:
    """The machine at a crank angle, rad."""
    machine, joints = curve.machines[0], curve.family.first.joints
    state = curve.family.solve(np.array([[theta]]))
    frame = {name: complex(*place) for name, place in machine.frame.items()}
    links = {
        name: {point: complex(curve.point_of(state, point, name)[0][0, 0]) for point in link.points}
        for name, link in machine.links.items()
    }

    def guide(slider: Slider) -> tuple[complex, complex]:
        turned = complex(np.ravel(state[u(slider.on)[0]])[0])
        way = turned * complex(np.exp(1j * slider.direction))
        return links[slider.link][slider.point], way

    circles: list[tuple[complex, float]] = []
    for gear in joints.gears:
        bodies = {FRAME: frame, **links}
        one, other = (bodies[gear.carrier][pin] for pin in gear_pins(joints, gear))
        driven = abs((other - one) / (1 - gear.speed_ratio))
        circles += [(one, driven * abs(gear.speed_ratio)), (other, driven)]
    return Sketch(
        frame,
        links,
        frozenset(joints.pins),
        tuple(circles),
        tuple(guide(slider) for slider in machine.sliders),
        tuple((links[spring.link][spring.point], frame[spring.to]) for spring in machine.springs),
    )


def draw_sketch(axes: Axes, drawn: Sketch, scale: float, inch: float) -> None:
    """Draw a machine lightly.

    scale : units of the axes in a metre.  inch : units of the axes in an inch.
    """
    for middle, radius in drawn.circles:
        axes.add_patch(
            Circle(
                _pair(middle * scale), radius * scale, fill=False, ec=FAINT, ls=(0, (4, 2)), lw=0.9
            )
        )
    for points in drawn.links.values():
        _draw_link(axes, np.array([*points.values()]) * scale)
    for place, way in drawn.guides:
        _draw_guide(axes, place * scale, way, inch)
    for one, other in drawn.springs:
        _draw_spring(axes, one * scale, other * scale, inch)
    for place in drawn.frame.values():
        _draw_pivot(axes, place * scale, inch)
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


def _draw_link(axes: Axes, places: Array) -> None:
    """A bar between two points, a plate around several."""
    around = hull(places)
    if len(around) < 2:
        return
    if len(around) == 2:
        for color, width, order in ((LINES, 5.4, 1.5), (PALE, 4.0, 1.6)):
            axes.plot(
                around.real,
                around.imag,
                color=color,
                linewidth=width,
                solid_capstyle="round",
                zorder=order,
            )
        return
    corners = np.column_stack([around.real, around.imag])
    axes.add_patch(
        Polygon(corners, fc=PALE, ec=LINES, lw=0.7, alpha=0.8, joinstyle="round", zorder=1.4)
    )


def _draw_guide(axes: Axes, place: complex, way: complex, inch: float) -> None:
    """A block on its line."""
    ends = np.array([place - 0.45 * inch * way, place + 0.45 * inch * way])
    axes.plot(ends.real, ends.imag, color=LINES, linewidth=0.9, linestyle="-.", zorder=2.3)
    box = np.array([1 + 0.6j, -1 + 0.6j, -1 - 0.6j, 1 - 0.6j]) * 0.1 * inch * way + place
    axes.add_patch(
        Polygon(np.column_stack([box.real, box.imag]), fc="white", ec=LINES, lw=0.9, zorder=2.4)
    )


def _draw_spring(axes: Axes, one: complex, other: complex, inch: float) -> None:
    """A zigzag, straight at both ends."""
    along = np.concatenate([[0, 0.15], 0.15 + 0.7 * (np.arange(10) + 0.5) / 10, [0.85, 1]])
    side = np.array([0, 0, *([1, -1] * 5), 0, 0]) * 0.05 * inch
    across = 1j * (other - one) / (abs(other - one) or 1.0)
    line = one + (other - one) * along + across * side
    axes.plot(line.real, line.imag, color=LINES, linewidth=0.9, zorder=2.2)


def _draw_pivot(axes: Axes, place: complex, inch: float) -> None:
    """The sign of a point that stands still: a stand on hatched ground."""
    half, high = 0.075 * inch, 0.13 * inch
    stand = np.array([place, place - half - 1j * high, place + half - 1j * high])
    axes.add_patch(
        Polygon(np.column_stack([stand.real, stand.imag]), fc="white", ec=LINES, lw=0.9, zorder=2.5)
    )
    foot = place - 1j * high
    axes.plot(
        [foot.real - 1.7 * half, foot.real + 1.7 * half],
        [foot.imag, foot.imag],
        color=LINES,
        linewidth=1.1,
        zorder=2.5,
    )
    for k in (-1.2, -0.4, 0.4, 1.2):
        axes.plot(
            [foot.real + k * half, foot.real + (k - 0.5) * half],
            [foot.imag, foot.imag - 0.5 * half],
            color=LINES,
            linewidth=0.6,
            zorder=2.5,
        )


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
                kernels.cross(chain[-1] - chain[-2], place - chain[-2]) <= 1e-9 * size**2
            ):
                chain.pop()
            chain.append(place)
        chains += chain[:-1]
    return np.array(chains)


def _pair(place: complex) -> tuple[float, float]:
    return place.real, place.imag
