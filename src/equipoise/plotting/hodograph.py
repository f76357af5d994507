"""Ends of a vector's arrow over a cycle, on axes of one scale, with crank angles along them."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from equipoise.figures.drawing import Panel
from equipoise.figures.labels import Labels
from equipoise.plotting.crank import angle_step
from equipoise.plotting.style import FAINT, NORMAL, SMALL

Array = np.ndarray[Any, Any]

MARGIN = 0.14
"""Free at each side, over the width."""
ALIKE = 0.015
"""Over the width: dots nearer to each other share their number."""
QUARTERS, FEW_TURNS = 90, 3
"""Degrees between crank angles that are numbered; turns from which they are further apart."""


def square(places: Array, side: float) -> Panel:
    """A square of some inches around places and the origin."""
    held = np.append(places, 0)
    low = complex(np.min(held.real), np.min(held.imag))
    high = complex(np.max(held.real), np.max(held.imag))
    wide = max((high - low).real, (high - low).imag) * (1 + 2 * MARGIN) or 1.0
    middle, half = (low + high) / 2, wide / 2
    return Panel(
        middle.real - half,
        middle.real + half,
        middle.imag - half,
        middle.imag + half,
        wide / side,
    )


def origin(axes: Axes) -> None:
    """Lines through the place at which arrows begin."""
    for line in (axes.axhline, axes.axvline):
        line(0, color=FAINT, linewidth=0.8, zorder=1)


def nothing_there(axes: Axes, why: str) -> None:
    """Say in empty axes why they are."""
    look: Any = {"transform": axes.transAxes, "ha": "center", "fontsize": NORMAL, "zorder": 5}
    axes.text(0.5, 0.6, why, **look)


def told_angles(angles: Array) -> dict[int, int]:
    """A few crank angles (deg), and which of `angles` (N,), a whole cycle in rad, each is."""
    turns = round(float(angles[-1] + angles[1] - angles[0]) / (2 * np.pi))
    step = QUARTERS if turns < FEW_TURNS else angle_step(turns)
    each = len(angles) / (360 * turns)
    return {angle: round(angle * each) for angle in range(0, 360 * turns, step)}


def numbers(axes: Axes, labels: Labels, told: dict[int, int], values: Array, color: str) -> None:
    """Dots at crank angles, with their numbers; of several at one place the first."""
    near = ALIKE * float(np.ptp(axes.get_xlim()))
    apart: dict[int, int] = {}
    for angle, k in told.items():
        if all(abs(values[k] - values[other]) > near for other in apart.values()):
            apart[angle] = k
    at = [*apart.values()]
    axes.plot(values[at].real, values[at].imag, "o", color=color, markersize=3.5, zorder=4)
    for k in at:
        labels.reserve(values[k].real, values[k].imag, half=2.0)
    middle = complex(np.mean(values))
    for angle, k in apart.items():
        away = float(np.degrees(np.angle(values[k] - middle)))
        look: Any = {"color": color, "fontsize": SMALL, "near": 5.0, "optional": True}
        labels.put(f"{angle}", values[k].real, values[k].imag, wish=away, **look)
