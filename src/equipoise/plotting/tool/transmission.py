"""Force handed on to hands, harness and ground against speed: Fig. 6 of Nagamine and Irie."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from equipoise.figures.labels import Labels
from equipoise.i18n import say
from equipoise.plotting.style import FAINT, LINES, blank, heading, short
from equipoise.plotting.tool.shaft import plane_named
from equipoise.plotting.tool.speeds import (
    SPEED,
    Speeds,
    avoid_curves,
    curve_limits,
    engine_axis,
    mode_lines,
    name_work,
    turns,
    work_line,
)
from equipoise.plotting.vibration.curves import (
    KINDS,
    LINE,
    Curve,
    draw_curves,
    draw_markers,
    legend_at,
    ordered,
    rows_of,
)
from equipoise.plotting.vibration.panels import (
    FOOT,
    LEFT,
    RIGHT,
    RPM,
    WIDTH,
    name_x,
    name_y,
    place,
)

if TYPE_CHECKING:
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.transmission import Transmissions

Array = np.ndarray[Any, Any]

TOP, NUMBERS, GAP = 0.58, 0.26, 0.16
"""Inches: heading; numbers of modes; between the panels."""
SIZE, PHASE = 2.9, 1.35
"""Inches: height of both panels."""
BREAK = 180.0
"""deg: a phase that leaps by more goes on at the other end."""
LIGHT: Any = (0, (1.5, 2))


def transmission_figure(found: Transmissions, plane: int, modes: ToolModes | None) -> Figure:
    """Force ratio and phase of every station that is held, in one plane."""
    curves = ordered({name: one.size[plane] for name, one in found.stations.items()})
    frequency = np.empty(0) if modes is None else modes.planes[plane].frequency
    keys = _keys(found.speed, frequency)
    rows = rows_of(curves[: len(KINDS) + 1]) + rows_of(keys)
    above = TOP + LINE * rows + (NUMBERS if len(keys) > 1 else 0.06)
    whole = above + SIZE + GAP + PHASE + FOOT
    figure = blank(WIDTH, whole)
    heading(figure, found.tool.title, _told(found, plane), LEFT)
    wide = WIDTH - LEFT - RIGHT
    size = place(figure, LEFT, FOOT + PHASE + GAP, wide, SIZE)
    phase = place(figure, LEFT, FOOT, wide, PHASE)
    for axes in (size, phase):
        engine_axis(axes, found.speed)
        mode_lines(axes, frequency, named=axes is size)
    handles = _sizes(size, found, curves, plane)
    _phases(phase, found, curves, plane)
    legend_at(figure, handles, TOP - 0.06)
    legend_at(figure, keys, TOP - 0.06 + LINE * rows_of(handles))
    name_x(figure, say(SPEED))
    return figure


def _told(found: Transmissions, plane: int) -> str:
    which = plane_named(plane, found.tool.alike)
    told = say("Force on the body under a unit force at {station}", station=short(found.source))
    return f"{told}, {which}"


def _keys(speed: Array, frequency: Array) -> list[Line2D]:
    """What is marked: quiet speeds, and modes where some are in sight."""
    keys = [Line2D([], [], label=say("quiet speed, rpm"), **_quiet_look(LINES))]
    if np.any((frequency >= speed[0]) & (frequency <= speed[-1])):
        look: Any = {"color": FAINT, "linewidth": 0.9, "linestyle": LIGHT}
        keys.append(Line2D([], [], label=say("natural frequency"), **look))
    return keys


def _quiet_look(color: str) -> dict[str, Any]:
    return {"color": color, "marker": "v", "markersize": 5.5, "linestyle": ""}


def _sizes(axes: Axes, found: Transmissions, curves: list[Curve], plane: int) -> list[Line2D]:
    name_y(axes, say("force ratio"))
    axes.tick_params(labelbottom=False)
    curve_limits(axes, curves, (3.0, 2.0))
    work = work_line(axes, found.tool)
    handles = draw_curves(axes, Speeds(found.speed), curves)
    labels = Labels(axes)
    avoid_curves(labels, found.speed, curves)
    _quiet(axes, labels, found, curves, plane)
    name_work(axes, labels, work)
    return handles


def _quiet(
    axes: Axes, labels: Labels, found: Transmissions, curves: list[Curve], plane: int
) -> None:
    """Marks at quiet speeds, on the curves, with their speeds."""
    marked = []
    for curve, (color, _) in zip(curves, KINDS, strict=False):
        for speed in found.stations[curve.name].quiet[plane].tolist():
            value = np.exp(np.interp(speed, found.speed, np.log(np.maximum(curve.values, 1e-300))))
            marked.append((speed, max(float(value), axes.get_ylim()[0]), color))
    for speed, value, color in marked:
        axes.plot(speed * RPM, value, zorder=5, **_quiet_look(color))
        labels.reserve(speed * RPM, value)
    for speed, value, color in marked:
        labels.put(turns(speed), speed * RPM, value, wish=-90.0, color=color, optional=True)


def _phases(axes: Axes, found: Transmissions, curves: list[Curve], plane: int) -> None:
    name_y(axes, say("phase, deg"))
    axes.set_ylim(-195, 195)
    axes.set_yticks(np.arange(-180, 181, 90))
    work_line(axes, found.tool)
    x = found.speed * RPM
    for number, curve in enumerate(curves):
        phase = np.degrees(found.stations[curve.name].phase[plane])
        leap = np.flatnonzero(np.abs(np.diff(phase)) > BREAK) + 1
        named = number < len(KINDS)
        color, marker = KINDS[number] if named else (FAINT, "")
        look: Any = {"color": color, "linewidth": 1.3 if named else 0.7}
        look["zorder"] = 3.9 - 0.1 * number if named else 2.5
        axes.plot(np.insert(x, leap, np.nan), np.insert(phase, leap, np.nan), **look)
        if named:
            draw_markers(axes, x, phase, marker, number, look)
