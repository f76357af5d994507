"""Pictures of signals against crank angle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from equipoise.plotting.labels import Labels, spread
from equipoise.plotting.style import (
    FAINT,
    LINES,
    MAIN,
    SMALL,
    SOIL,
    blank,
    degrees_shown,
    heading,
    short,
    shown,
)

if TYPE_CHECKING:
    from equipoise.planting.summary import PlantingFigures

Array = np.ndarray[Any, Any]

WIDTH, HEIGHT = 7.2, 3.6
LEFT, RIGHT, BOTTOM, TOP = 0.78, 0.2, 0.52, 0.92
"""Inches: the picture and its margins."""

STEPS = (30, 60, 90, 180, 360, 720, 1440, 3600)
MOST_TICKS = 13
EVENTS = {"entry": (0, (5, 2)), "lowest": (0, (5, 2, 1, 2)), "exit": (0, (1.5, 1.5))}
"""Instant -> dashes of its line."""
ABOVE = (5.5, 8.5, 16.8)
"""Points above the axes: the top of such a line, and the feet of its name and of its angle."""


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


def closed(figures: PlantingFigures, theta: Array, values: Array) -> tuple[Array, Array]:
    """A cycle of samples, with the first of them again at its end."""
    return np.append(theta, figures.curve.period), np.append(values, values[0])


def signal_figure(figures: PlantingFigures, what: str, label: str, lines: Sequence[Line]) -> Figure:
    """One pair of axes: signals against crank angle, with the stay in the soil."""
    figure = blank(WIDTH, HEIGHT)
    axes = figure.add_axes(
        (
            LEFT / WIDTH,
            BOTTOM / HEIGHT,
            1 - (LEFT + RIGHT) / WIDTH,
            1 - (BOTTOM + TOP) / HEIGHT,
        )
    )
    heading(figure, figures.machine.title, what, LEFT)
    crank_axis(figures, axes)
    axes.set_ylabel(label)
    draw(axes, lines)
    soil_shade(figures, axes)
    event_names(figures, axes)
    mark(axes, lines, event_lines(figures, axes))
    if len(lines) > 1:
        figure.legend(
            handles=axes.get_lines()[: len(lines)],
            loc="upper right",
            bbox_to_anchor=(1 - RIGHT / WIDTH, 1 - 0.24 / HEIGHT),
            ncols=len(lines),
            borderaxespad=0,
        )
    return figure


def crank_axis(
    figures: PlantingFigures, axes: Axes, most: int = MOST_TICKS, label: bool = True
) -> None:
    """The x axis: angle of the drive link over the cycle, in degrees."""
    cycle = 360 * figures.curve.turns
    axes.set_xlim(0, cycle)
    axes.set_xticks(np.arange(0, cycle + 1, angle_step(figures.curve.turns, most)))
    if label:
        axes.set_xlabel(crank_label(figures))


def angle_step(turns: int, most: int = MOST_TICKS) -> int:
    """Degrees between crank angles that are numbered."""
    return next((step for step in STEPS if 360 * turns / step < most), 360 * turns)


def crank_label(figures: PlantingFigures) -> str:
    """What the x axis is."""
    text = f"crank angle: angle of {short(figures.machine.drive.link)} in the frame, deg"
    if figures["speed"] < 0:
        text += "  (turns clockwise: time runs from right to left)"
    return text


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


def soil_shade(figures: PlantingFigures, axes: Axes) -> None:
    """Shade the crank angles at which the tip is in the soil."""
    for low, high in soil_spans(figures):
        axes.axvspan(np.degrees(low), np.degrees(high), color=SOIL, linewidth=0, zorder=0)


def soil_spans(figures: PlantingFigures) -> list[tuple[float, float]]:
    """Stays in the soil as rising crank angles within one cycle, rad."""
    spans = []
    for visit in figures.visits:
        ends = (visit.entry, visit.exit)
        low, high = ends if figures["speed"] > 0 else ends[::-1]
        if low <= high:
            spans.append((low, high))
        else:
            spans += [(low, figures.curve.period), (0.0, high)]
    return spans


def event_lines(figures: PlantingFigures, axes: Axes) -> list[float]:
    """Lines at entry, lowest point and exit; they come back as crank angles in degrees."""
    places = [float(np.degrees(figures[f"{name}.crank_angle"])) for name in EVENTS]
    for place, dashes in zip(places, EVENTS.values(), strict=True):
        axes.axvline(place, color=LINES, linewidth=0.9, linestyle=dashes, zorder=2)
    return places


def event_names(figures: PlantingFigures, axes: Axes) -> None:
    """What those lines are, above the axes, each with a line to its place below."""
    box = axes.get_window_extent()
    low, high = axes.get_xlim()
    dot = cast(Figure, axes.figure).dpi / 72
    across, up = (high - low) / box.width * dot, dot / box.height
    look: Any = {"fontsize": SMALL, "ha": "center", "transform": axes.get_xaxis_transform()}
    rows, places = [], []
    for name in EVENTS:
        angle = figures[f"{name}.crank_angle"]
        places.append(float(np.degrees(angle)))
        told = (degrees_shown(angle), name)
        rows.append(
            [
                axes.text(0, 1 + y * up, text, **look)
                for y, text in zip(ABOVE[:0:-1], told, strict=True)
            ]
        )
    widths = [max(text.get_window_extent().width for text in row) / dot + 6 for row in rows]
    ends = (low - 20 * across, high + 10 * across)
    moved = spread(places, [width * across for width in widths], *ends)
    for row, place, x in zip(rows, places, moved, strict=True):
        for text in row:
            text.set_x(x)
        axes.plot(
            [place, x],
            [1, 1 + ABOVE[0] * up],
            color=LINES,
            linewidth=0.7,
            clip_on=False,
            transform=axes.get_xaxis_transform(),
        )


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
        middle = sum(line.values) / len(line.values)
        for angle, value in line.marked:
            if any(_alike(axes, (angle, value), other) for other in told):
                continue
            told.append((angle, value))
            axes.plot(np.degrees(angle), value, "o", color=line.color, markersize=4, zorder=4)
            labels.put(
                f"{shown(value)} at {degrees_shown(angle)}" if angles else shown(value),
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
