"""Signs for mounts, gauges, pivot and axes of rotation on a picture of the support."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from equipoise.mechanism.support import Direction, Mount, unit_vector
from equipoise.plotting.style import INK, LINES
from equipoise.plotting.vibration.body import MM, View, seen

Array = np.ndarray[Any, Any]

LENGTH, WIDE = 0.3, 0.055
"""Inches: a spring from the support to the ground, and half its width."""
ARROW = 0.24
"""Inches: length of a gauge's arrow."""
SEEN = 0.3
"""Length of the view of a unit vector below which it is seen end on."""


def draw_mount(axes: Axes, mount: Mount, view: View, center: complex, inch: float) -> None:
    """A mount with a point: spring or damper from there to hatched ground."""
    assert mount.point is not None
    place = complex(seen(np.array(mount.point), view))
    way = _along(mount.direction, view)
    if abs(way) < SEEN:
        _end_on(axes, place)
        return
    way /= -abs(way)
    outward = (place - center) * np.conj(way)
    if not mount.one_sided and abs(way.imag) < 0.5 and outward.real < 0:
        way = -way
    body = _spring() if mount.stiffness else _dashpot()
    pieces = [place + inch * LENGTH * way * (piece.real + 1j * piece.imag) for piece in body]
    for piece in pieces:
        axes.plot(piece.real, piece.imag, color=LINES, linewidth=1.0, zorder=5)
    _ground(axes, place + inch * LENGTH * way, way, inch)
    face = "white" if mount.one_sided else LINES
    axes.plot(
        place.real,
        place.imag,
        "o",
        color=LINES,
        markerfacecolor=face,
        markersize=4.5,
        markeredgewidth=1.0,
        zorder=5.2,
    )


def _spring() -> list[Array]:
    """A zigzag from 0 to 1, its sides over the length."""
    along = np.concatenate([[0, 0.2], 0.2 + 0.6 * (np.arange(6) + 0.5) / 6, [0.8, 1]])
    side = np.array([0, 0, *([1, -1] * 3), 0, 0]) * WIDE / LENGTH
    return [along + 1j * side]


def _dashpot() -> list[Array]:
    """A piston in a cylinder, open towards the ground."""
    half = WIDE / LENGTH
    cylinder = np.array([0.75 + 1j * half, 0.35 + 1j * half, 0.35 - 1j * half, 0.75 - 1j * half])
    piston = np.array([0.6 + 0.8j * half, 0.6 - 0.8j * half])
    return [np.array([0, 0.35 + 0j]), cylinder, piston, np.array([0.6, 1 + 0j])]


def _ground(axes: Axes, foot: complex, way: complex, inch: float) -> None:
    """A short line with hatching behind it."""
    across = 1j * way * 0.1 * inch
    line = np.array([foot - across, foot + across])
    axes.plot(line.real, line.imag, color=LINES, linewidth=1.2, zorder=5)
    for k in (-0.75, -0.05, 0.65):
        hatch = foot + np.array([k * across, (k - 0.5) * across + 0.05 * inch * way])
        axes.plot(hatch.real, hatch.imag, color=LINES, linewidth=0.6, zorder=5)


def _end_on(axes: Axes, place: complex) -> None:
    """A direction towards who looks: a dot in a circle."""
    look: Any = {"color": LINES, "markerfacecolor": "white", "zorder": 5.1}
    axes.plot(place.real, place.imag, "o", markersize=6.5, markeredgewidth=1.0, **look)
    axes.plot(place.real, place.imag, "o", color=LINES, markersize=1.8, zorder=5.2)


def draw_gauge(
    axes: Axes, point: tuple[float, float, float], direction: Direction, view: View, inch: float
) -> None:
    """A gauge: a diamond with an arrow in its direction."""
    place = complex(seen(np.array(point), view))
    way = _along(direction, view)
    look: Any = {"color": INK, "markerfacecolor": "white", "markeredgewidth": 1.1}
    axes.plot(place.real, place.imag, "D", markersize=5, zorder=5.4, **look)
    if abs(way) >= SEEN:
        head = place + ARROW * inch * way / abs(way)
        _arrow(axes, place, head)


def draw_turning(axes: Axes, place: complex, ring: int, color: str, inch: float) -> complex:
    """An arc with a head about an axis that is seen end on; where its name may point to."""
    radius = (0.15 + 0.07 * ring) * inch
    angles = np.radians(np.linspace(-60, 205, 40))
    arc = place + radius * np.exp(1j * angles)
    axes.plot(arc.real, arc.imag, color=color, linewidth=1.0, zorder=5)
    _arrow(axes, complex(arc[-4]), complex(arc[-1]), color)
    return complex(arc[8])


def draw_pivot(axes: Axes, place: complex, inch: float) -> None:
    """The pin that carries the support."""
    half, high = 0.085 * inch, 0.15 * inch
    stand = np.array([place, place - half - 1j * high, place + half - 1j * high])
    corners = np.column_stack([stand.real, stand.imag])
    axes.add_patch(Polygon(corners, fc="white", ec=INK, lw=1.0, zorder=5.1))
    _ground(axes, place - 1j * high, -1j, 1.3 * inch)
    look: Any = {"color": INK, "markerfacecolor": "white", "markeredgewidth": 1.0}
    axes.plot(place.real, place.imag, "o", markersize=4.5, zorder=5.3, **look)


def _along(direction: Direction, view: View) -> complex:
    """A unit vector in a view."""
    return complex(seen(np.array(unit_vector(direction)), view)) / MM


def _arrow(axes: Axes, tail: complex, head: complex, color: str = INK) -> None:
    axes.annotate(
        "",
        (head.real, head.imag),
        xytext=(tail.real, tail.imag),
        arrowprops={
            "arrowstyle": "-|>",
            "color": color,
            "lw": 1.0,
            "mutation_scale": 8,
            "shrinkA": 0,
            "shrinkB": 0,
        },
        zorder=5.3,
    )
