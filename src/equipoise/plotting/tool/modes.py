"""Pictures of a tool's modes: Fig. 5 of Nagamine and Irie, with stations and nodes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from equipoise.figures.labels import Labels
from equipoise.i18n import say
from equipoise.plotting.style import FAINT, MAIN, STRESS, blank, heading, shown
from equipoise.plotting.tool.shaft import (
    MM,
    PLACE,
    mark_stations,
    names_of,
    plane_named,
    shaft_axis,
    station_keys,
    write_names,
)
from equipoise.plotting.tool.speeds import turns
from equipoise.plotting.vibration.curves import LINE, legend_at, rows_of
from equipoise.plotting.vibration.panels import FOOT, WIDTH, place

if TYPE_CHECKING:
    from equipoise.handheld.modes import PlaneModes, ToolModes

Array = np.ndarray[Any, Any]

LEFT, RIGHT = 0.86, 1.24
"""Inches: margins, with numbers at the left and frequencies at the right."""
TOP, ROW, GAP = 0.58, 0.82, 0.1
"""Inches: heading; height of a shape; room between two."""
MOST = 6
"""Shapes in a picture."""
REACH = 1.42
"""Upper end of the axis of a shape, over its largest displacement."""
DASHED: Any = (0, (4, 2))
LETTERS = 18
"""In a line of what a free motion is called."""


def modes_figures(modes: ToolModes, plane: int) -> Iterator[Figure]:
    """Shapes without damping in one plane, some in each picture."""
    count = len(modes.planes[plane].frequency)
    for first in range(0, count, MOST):
        yield _figure(modes, plane, range(first, min(first + MOST, count)))


def _figure(modes: ToolModes, plane: int, numbers: Sequence[int]) -> Figure:
    tool, found = modes.tool, modes.planes[plane]
    names, keys = names_of(tool, LEFT, RIGHT), _keys(modes)
    head = TOP + LINE * rows_of(keys) + names.height
    whole = head + len(numbers) * (ROW + GAP) - GAP + FOOT
    figure = blank(WIDTH, whole)
    heading(figure, tool.title, _told(modes, plane, numbers), LEFT)
    legend_at(figure, keys, TOP - 0.06)
    for row, number in enumerate(numbers):
        bottom = whole - head - row * (ROW + GAP) - ROW
        axes = place(figure, LEFT, bottom, WIDTH - LEFT - RIGHT, ROW)
        shaft_axis(axes, tool)
        if row == 0:
            write_names(axes, names)
        _shape(axes, modes, found, number)
        _beside(axes, found, number)
        if row < len(numbers) - 1:
            axes.tick_params(bottom=False, labelbottom=False)
    axes.set_xlabel(say(PLACE))
    return figure


def _told(modes: ToolModes, plane: int, numbers: Sequence[int]) -> str:
    which = plane_named(plane, modes.alike)
    count = len(modes.planes[plane].frequency)
    told = f"{say('Shapes of free vibration without damping')}, {which}"
    if len(numbers) == count:
        return told
    first, last = numbers[0] + 1, numbers[-1] + 1
    return f"{told} " + say("({first} to {last} of {count})", first=first, last=last, count=count)


def _keys(modes: ToolModes) -> list[Line2D]:
    keys = [
        Line2D([], [], color=MAIN, linewidth=1.5, label=say("one end of the swing")),
        Line2D([], [], color=FAINT, linewidth=1.0, linestyle=DASHED, label=say("the other")),
        Line2D([], [], label=say("node, mm"), **_node_look()),
    ]
    return keys + station_keys(modes.tool.stations)


def _node_look() -> dict[str, Any]:
    look = {"color": STRESS, "marker": "x", "linestyle": "", "markersize": 5.0}
    return {**look, "markeredgewidth": 1.4}


def _shape(axes: Axes, modes: ToolModes, found: PlaneModes, number: int) -> None:
    """One shape with its stations and nodes."""
    shape, x = found.shapes[number], MM * modes.places
    axes.set_ylim(-REACH, REACH)
    axes.set_yticks([])
    axes.axhline(0, color=FAINT, linewidth=0.8, zorder=1.2)
    axes.plot(x, -shape, color=FAINT, linewidth=1.0, linestyle=DASHED, zorder=2)
    axes.plot(x, shape, color=MAIN, linewidth=1.5, zorder=3)
    mark_stations(axes, modes.tool, modes.places, shape)
    labels = Labels(axes)
    labels.avoid(x, shape)
    labels.avoid(x, -shape, weight=0.4)
    for station in modes.tool.stations:
        at = float(np.interp(station.position, modes.places, shape))
        labels.reserve(MM * station.position, at)
    nodes = MM * found.nodes[number]
    for node in nodes:
        axes.plot(node, 0.0, zorder=5, **_node_look())
        labels.reserve(float(node), 0.0)
    for node in nodes:
        text = f"{node:.0f}"
        labels.put(text, float(node), 0.0, near=5.0, color=STRESS, optional=True)


def _beside(axes: Axes, found: PlaneModes, number: int) -> None:
    """Number of a mode at the left, its frequency and lambda at the right."""
    figure: Any = axes.get_figure(root=True)
    inch = figure.dpi / axes.get_window_extent().width
    look: Any = {"transform": axes.transAxes, "va": "center"}
    axes.text(-0.1 * inch, 0.5, say("mode {number}", number=number + 1), ha="right", **look)
    lines = _figures(found, number)
    axes.text(1 + 0.1 * inch, 0.5, "\n".join(lines), linespacing=1.35, **look)


def _figures(found: PlaneModes, number: int) -> list[str]:
    """What is told of a mode, line by line."""
    hertz = float(found.cycles_per_second[number])
    if not hertz:
        return ["free:", *wrap(found.rigid[number], LETTERS)]
    minute = turns(float(found.frequency[number]))
    return [f"{shown(hertz)} Hz", f"{minute} 1/min", f"λ = {found.parameter[number]:.3f}"]
