"""Pictures of signals against crank angle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from equipoise.figures.labels import Labels
from equipoise.i18n import say
from equipoise.plotting.style import FAINT, MAIN, degrees_shown, short, shown

Array = np.ndarray[Any, Any]

STEPS = (30, 60, 90, 180, 360, 720, 1440, 3600)
MOST_TICKS = 13


@dataclass(frozen=True)
class Line:
    """A signal: values (N,) at crank angles (N,), rad, with the whole cycle from end to end.

    marked : crank angles (rad) and values that are told.
    """

    theta: Array
    values: Array
    name: str = ""
    color: str = MAIN
    dashes: Any = "-"
    marked: Sequence[tuple[float, float]] = ()

    @property
    def varies(self) -> bool:
        """Whether the signal changes by more than rounding."""
        return bool(np.ptp(self.values) > 1e-9 * np.max(np.abs(self.values)))


def closed(theta: Array, values: Array, period: float) -> tuple[Array, Array]:
    """A cycle of samples (N,), with the first of them again at its end."""
    return np.append(theta, period), np.append(values, values[0])


def crank_axis(axes: Axes, turns: int, most: int = MOST_TICKS) -> None:
    """The x axis: angle of the drive link over the cycle, in degrees."""
    axes.set_xlim(0, 360 * turns)
    axes.set_xticks(np.arange(0, 360 * turns + 1, angle_step(turns, most)))


def angle_step(turns: int, most: int = MOST_TICKS) -> int:
    """Degrees between crank angles that are numbered."""
    return next((step for step in STEPS if 360 * turns / step < most), 360 * turns)


def crank_label(drive: str, speed: float) -> str:
    """What the x axis is."""
    text = say("crank angle: angle of {link} in the frame, deg", link=short(drive))
    return text + runs_left(speed)


def runs_left(speed: float) -> str:
    """A remark for axes on which time runs from right to left."""
    return "  " + say("(turns clockwise: time runs from right to left)") if speed < 0 else ""


def draw(axes: Axes, lines: Sequence[Line], floor: float | None = None) -> None:
    """The signals, and limits that leave room for what is written beside their extremes."""
    for line in lines:
        axes.plot(
            np.degrees(line.theta),
            line.values,
            color=line.color,
            linestyle=line.dashes,
            label=line.name,
            zorder=3,
        )
    values = np.concatenate([line.values for line in lines])
    low, high = float(np.min(values)), float(np.max(values))
    if not any(line.varies for line in lines) or high == low:
        half = max(abs(high), abs(low)) / 2 or 1.0
        low, high = low - half, high + half
    margin = 0.17 * (high - low)
    axes.set_ylim(low - margin if floor is None else floor, high + margin)
    if low < 0 < high:
        axes.axhline(0, color=FAINT, linewidth=0.8, zorder=1)


def mark(axes: Axes, lines: Sequence[Line], upright: Sequence[float], angles: bool = True) -> None:
    """Dots and values at the extremes.

    upright : where upright lines are, deg.  angles : whether the crank angles are told too.
    """
    labels = Labels(axes)
    for line in lines:
        labels.avoid(np.degrees(line.theta), line.values)
    for place in upright:
        labels.avoid([place, place], axes.get_ylim(), weight=0.5)
    told: list[tuple[float, float]] = []
    for line in reversed(lines):
        if not line.varies:
            continue
        middle = np.mean(line.values)
        for angle, value in line.marked:
            if any(_alike(axes, (angle, value), other) for other in told):
                continue
            told.append((angle, value))
            axes.plot(np.degrees(angle), value, "o", color=line.color, markersize=4, zorder=4)
            at = degrees_shown(angle)
            labels.put(
                say("{value} at {angle}", value=shown(value), angle=at) if angles else shown(value),
                float(np.degrees(angle)),
                value,
                wish=90.0 if value > middle else -90.0,
                color=line.color,
            )


def _alike(axes: Axes, one: tuple[float, float], other: tuple[float, float]) -> bool:
    """Whether two places can hardly be told apart."""
    low, high = axes.get_ylim()
    near = abs(one[1] - other[1]) < 0.004 * (high - low)
    return near and abs(one[0] - other[0]) < 0.01 * 2 * pi
