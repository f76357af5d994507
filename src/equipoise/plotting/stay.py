"""When the tip is in the soil, on axes over crank angle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from equipoise.figures.labels import spread
from equipoise.i18n import say
from equipoise.plotting.style import INSTANTS, LINES, SMALL, SOIL, degrees_shown

if TYPE_CHECKING:
    from equipoise.planting.summary import PlantingFigures

EVENTS = {"entry": (0, (5, 2)), "lowest": (0, (5, 2, 1, 2)), "exit": (0, (1.5, 1.5))}
"""Instant -> dashes of its line."""
ABOVE = (5.5, 8.5, 16.8)
"""Points above the axes: the top of such a line, and the feet of its name and of its angle."""


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
        told = (degrees_shown(angle), say(INSTANTS[name]))
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
