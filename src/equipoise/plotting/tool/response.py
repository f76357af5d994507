"""Bending moment and displacement along the shaft at one speed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from equipoise.figures.labels import Labels
from equipoise.handheld.exposed import grips
from equipoise.handheld.response import respond_tool
from equipoise.i18n import say
from equipoise.plotting.style import INK, blank, heading, shown
from equipoise.plotting.tool.shaft import (
    MM,
    PLACE,
    names_of,
    shaft_axis,
    write_names,
)
from equipoise.plotting.tool.speeds import turns
from equipoise.plotting.vibration.curves import KINDS, LINE, draw_markers, legend_at, rows_of
from equipoise.plotting.vibration.panels import (
    FOOT,
    LEFT,
    RIGHT,
    WIDTH,
    Unit,
    name_x,
    name_y,
    place,
    zero_line,
)

if TYPE_CHECKING:
    from equipoise.handheld.response import ToolResponse
    from equipoise.handheld.shapes import Line

Array = np.ndarray[Any, Any]

TOP, MOMENT, SHAPE, GAP = 0.58, 2.1, 2.1, 0.16
"""Inches: heading; heights of the panels; between them."""
POINTS = 401
"""Places along the shaft."""
BESIDE = 1e-9
"""m before a station, where the moment is that at its left."""
MOST_ORDERS = 3
"""Of which moment and shape are drawn."""
ORDERS = (KINDS[0], KINDS[1], KINDS[3])
MATTERS = 1e-3
"""Share of the largest displacement from which a plane's shape is drawn."""
DASHED: Any = (0, (4, 2))


def moment_figure(response: ToolResponse, speed: float | None) -> Figure:
    """RMS of the bending moment, and the shape of each order when it is largest."""
    tool = response.tool
    speed = speed_shown(response) if speed is None else speed
    one = respond_tool(tool, speed)
    places = _places(tool)
    line = one.line(places)
    loudest = _loudest(line)
    shapes = _shapes(one.orders, line, loudest)
    keys = _keys(one.orders, loudest, shapes)
    names = names_of(tool, LEFT, RIGHT)
    above = TOP + LINE * rows_of(keys) + names.height
    figure = blank(WIDTH, above + MOMENT + GAP + SHAPE + FOOT)
    what = say("RMS of the bending moment, and shape of each order when it is largest")
    heading(figure, tool.title, f"{what}; {turns(speed)} rpm", LEFT)
    legend_at(figure, keys, TOP - 0.06)
    wide = WIDTH - LEFT - RIGHT
    moment = place(figure, LEFT, FOOT + SHAPE + GAP, wide, MOMENT)
    shape = place(figure, LEFT, FOOT, wide, SHAPE)
    for axes in (moment, shape):
        shaft_axis(axes, tool)
    moment.tick_params(bottom=False, labelbottom=False)
    write_names(moment, names)
    _draw_moment(moment, places, line, loudest)
    _draw_shapes(shape, places, shapes)
    name_x(figure, say(PLACE))
    return figure


def speed_shown(response: ToolResponse) -> float:
    """Speed, rad/s, of work; else the one at which hands get most, or a station moves most."""
    operation, speeds = response.tool.operation, response.speed
    if len(speeds) == 1:
        return float(speeds[0])
    if operation is not None and np.min(speeds) <= operation.speed <= np.max(speeds):
        return operation.speed
    if response.tool.grips:
        felt = np.max([grip.a_hv for grip in grips(response).values()], axis=0)
    else:
        moved = [np.abs(response.displacement(one.name)) for one in response.tool.stations]
        felt = np.max([np.sum(one**2, axis=(0, 1)) for one in moved], axis=0)
    return float(speeds[np.argmax(felt)])


def _places(tool: Any) -> Array:
    """Places along the shaft, and both sides of each station."""
    at = np.array([station.position for station in tool.stations])
    every = np.concatenate([np.linspace(0.0, tool.shaft.length, POINTS), at, at - BESIDE])
    return np.unique(np.clip(every, 0.0, tool.shaft.length))


def _loudest(line: Line) -> list[int]:
    """Numbers of the orders whose moment is largest, the largest first."""
    size = np.max(np.sum(np.abs(line.moment[..., 0]) ** 2, axis=1), axis=0)
    return [int(k) for k in np.argsort(-size, kind="stable")[:MOST_ORDERS]]


def _shapes(orders: Array, line: Line, loudest: list[int]) -> dict[tuple[int, int], Array]:
    """(Place among the loudest, plane) -> displacement, m, at the instant when it is largest.

    The lateral plane is left out where it does the same as the vertical one.
    """
    moved = line.displacement[..., 0]
    least = MATTERS * float(np.max(np.abs(moved)))
    found: dict[tuple[int, int], Array] = {}
    for number, k in enumerate(loudest):
        both = [_largest(moved[:, plane, k]) for plane in range(2)]
        for plane, shape in enumerate(both):
            same = plane == 1 and np.allclose(shape, both[0], atol=least)
            if np.max(np.abs(shape)) > least and not same:
                found[number, plane] = shape
    return found


def _largest(amplitude: Array) -> Array:
    """Where an amplitude (X,) is at the instant when it is largest."""
    turned = np.exp(-0.5j * np.angle(np.sum(amplitude**2)))
    shape = np.real(amplitude * turned)
    return np.asarray(shape * np.sign(shape[np.argmax(np.abs(shape))] or 1.0))


def _keys(orders: Array, loudest: list[int], shapes: dict[tuple[int, int], Array]) -> list[Line2D]:
    keys = [Line2D([], [], color=INK, linewidth=1.8, label=say("all orders, root of squares"))]
    for number, k in enumerate(loudest):
        color, marker = ORDERS[number]
        look: Any = {"color": color, "marker": marker, "markerfacecolor": "white"}
        text = say("order {order}", order=shown(float(orders[k])))
        keys.append(Line2D([], [], label=text, markersize=4.5, **look))
    planes = {plane for _, plane in shapes}
    if planes == {0, 1}:
        keys.append(Line2D([], [], color=INK, linestyle=DASHED, label=say("lateral plane")))
    return keys


def _draw_moment(axes: Axes, places: Array, line: Line, loudest: list[int]) -> None:
    """RMS over time of all orders and planes, and of both planes of the loudest orders."""
    squares = np.sum(np.abs(line.moment[..., 0]) ** 2, axis=1) / 2
    total = np.sqrt(np.sum(squares, axis=1))
    unit = Unit.of("force", True, total)
    name_y(axes, say("moment, {unit}", unit=unit.name))
    x, top = MM * places, unit.factor * float(np.max(total))
    axes.set_ylim(0, 1.18 * top or 1.0)
    axes.plot(x, unit.factor * total, color=INK, linewidth=1.8, zorder=3)
    if len(loudest) > 1 or squares.shape[1] > 1:
        for number, k in enumerate(loudest):
            color, marker = ORDERS[number]
            look: Any = {"color": color, "linewidth": 1.1, "zorder": 3.5 + 0.1 * number}
            size = unit.factor * np.sqrt(squares[:, k])
            axes.plot(x, size, **look)
            draw_markers(axes, x, size, marker, number, look)
    k = int(np.argmax(total))
    labels = Labels(axes)
    labels.avoid(x, unit.factor * total)
    text = say(
        "{value} at {place} mm", value=f"{shown(top)} {unit.name}", place=f"{MM * places[k]:.0f}"
    )
    labels.put(text, float(x[k]), top, wish=60.0)


def _draw_shapes(axes: Axes, places: Array, shapes: dict[tuple[int, int], Array]) -> None:
    every = np.array([*shapes.values()]) if shapes else np.zeros((1, len(places)))
    unit = Unit.of("displacement", False, every)
    name_y(axes, say("displacement, {unit}", unit=unit.name))
    low, high = unit.factor * float(np.min(every)), unit.factor * float(np.max(every))
    room = 0.12 * (high - low) or 1.0
    axes.set_ylim(min(low, 0.0) - room, max(high, 0.0) + room)
    zero_line(axes)
    x = MM * places
    for (number, plane), shape in shapes.items():
        color, marker = ORDERS[number]
        look: Any = {"color": color, "linewidth": 1.5, "zorder": 3.9 - 0.1 * number}
        y = unit.factor * shape
        axes.plot(x, y, linestyle=DASHED if plane else "-", **look)
        draw_markers(axes, x, y, marker, number, look)
