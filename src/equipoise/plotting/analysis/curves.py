"""Coupler curves, and hodographs of their points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from equipoise.figures.drawing import Drawn, arrow, draw_machine, hold, keep_clear, moving, traced
from equipoise.figures.labels import Labels
from equipoise.i18n import say
from equipoise.plotting.analysis.looks import LINE_LOOKS, MM, over, title, unit_of
from equipoise.plotting.crank import angle_step
from equipoise.plotting.hodograph import nothing_there, numbers, origin, square, told_angles
from equipoise.plotting.style import (
    FAINT,
    INK,
    LINES,
    NORMAL,
    blank,
    heading,
    short,
    shown,
    styled,
)
from equipoise.plotting.vibration.panels import LEFT, RIGHT, WIDTH, legend, place, told_speed
from equipoise.symbols.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.mechanism.motion import Motion
    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

MOST_POINTS, MOST_VECTORS = 4, 3
"""Points that are followed in one picture: their paths, and their hodographs."""
FEW = (0, 90)
"""Crank angles, deg, that are told on the hodographs of several points."""
HIGHEST, LOWEST = 5.2, 1.4
"""Inches: height of the axes at most and at least."""
TOP, BOTTOM = 0.82, 0.5
"""Inches: above and below the axes."""
BETWEEN = 0.86
"""Inches between two axes, labels included."""


def followed(analysis: Analysis, points: Sequence[str] | None, most: int) -> list[str]:
    """The points that are asked for, or as many as a picture can hold."""
    return traced(analysis.motion)[:most] if points is None else [*points]


@styled()
def curves_figure(analysis: Analysis, points: Sequence[str] | None = None) -> Figure:
    """Paths of points of couplers, with dots after equal times; those of other points pale.

    points : names; where they are not given, some that are no joint of the frame's links.
    """
    motion = analysis.motion
    names = followed(analysis, points, MOST_POINTS)
    others = [name for name in moving(motion) if name not in names]
    held = [motion.points[name].place for name in (*names, *others)]
    scene = Scene.of(motion)
    frame = [complex(scene.places[name][0]) for name in scene.frame]
    panel = hold(MM * np.concatenate([*held, frame]), WIDTH - LEFT - RIGHT, HIGHEST, LOWEST)
    figure = blank(LEFT + RIGHT + panel.width, TOP + BOTTOM + panel.height)
    heading(figure, analysis.machine.title, _told_dots(motion), LEFT)
    axes = place(figure, LEFT, BOTTOM, panel.width, panel.height)
    panel.settle(axes)
    axes.set_xlabel(say("x in the frame, mm"))
    axes.set_ylabel(say("y in the frame, mm"))
    labels = Labels(axes)
    drawn = Drawn(scene, 0, MM, panel.inch)
    keep_clear(labels, draw_machine(axes, drawn, lambda piece: piece.layer in ("stands", "pivots")))
    for name in others:
        path = MM * over(analysis, motion.points[name].place)[1]
        axes.plot(path.real, path.imag, color=FAINT, linewidth=0.9, zorder=2)
        labels.avoid(path.real, path.imag, weight=0.5)
    for name, (color, dashes) in zip(names, LINE_LOOKS, strict=False):
        path = MM * over(analysis, motion.points[name].place)[1]
        axes.plot(path.real, path.imag, color=color, linestyle=dashes, linewidth=1.6, zorder=3)
        labels.avoid(path.real, path.imag)
        _sense(axes, analysis, name, color)
    _names(axes, labels, analysis, names, others)
    for name, (color, _) in zip(names, LINE_LOOKS, strict=False):
        _dots(axes, labels, analysis, name, color)
    if not names:
        nothing_there(axes, say("no point moves"))
    legend(figure, _keys(names, bool(others)))
    return figure


def _told_dots(motion: Motion) -> str:
    """What is drawn, and after which time a dot comes."""
    if not motion.whole_cycle:
        return say("Paths of points, at {speed}", speed=told_speed(motion.speed))
    step = angle_step(motion.turns)
    values = {"step": step, "speed": told_speed(motion.speed)}
    if not motion.speed:
        return say("Paths of points; dots every {step}° of the crank", **values)
    values["time"] = shown(1000 * np.radians(step) / abs(motion.speed))
    return say("Paths of points; dots every {step}° = {time} ms, at {speed}", **values)


def _sense(axes: Axes, analysis: Analysis, name: str, color: str) -> None:
    """The head of an arrow where the point is fastest."""
    point = analysis.motion.points[name]
    fastest = int(np.argmax(np.abs(point.place_1)))
    way = complex(point.place_1[fastest]) * float(np.sign(analysis.motion.speed))
    if not way:
        return
    head = MM * complex(point.place[fastest])
    tail = head - way / abs(way) * 0.02 * float(np.ptp(axes.get_xlim()))
    arrow(axes, tail, head, color=color, mutation_scale=13, lw=0, zorder=3.2)


def _names(
    axes: Axes, labels: Labels, analysis: Analysis, names: Sequence[str], others: Sequence[str]
) -> None:
    """Names of points beside their paths, and of the frame's."""
    motion = analysis.motion
    for name in (*names, *others):
        path = MM * motion.points[name].place
        k = int(np.argmax((path * np.exp(-0.7j)).real))
        look: Any = {"fontweight": "bold", "fontsize": NORMAL, "near": 4.0}
        color = dict(zip(names, LINE_LOOKS, strict=False)).get(name, (LINES,))[0]
        labels.put(short(name), path[k].real, path[k].imag, wish=40.0, color=color, **look)
    for name, z in analysis.machine.frame.items():
        x, y = MM * z[0], MM * z[1]
        labels.put(short(name), x, y, wish=45.0, fontweight="bold", color=INK, near=5.0)


def _dots(axes: Axes, labels: Labels, analysis: Analysis, name: str, color: str) -> None:
    """Dots after equal times, some with their crank angles."""
    motion = analysis.motion
    if not motion.whole_cycle:
        return
    path = MM * motion.points[name].place
    turns = motion.turns
    ways = np.arange(0, 360 * turns, angle_step(turns))
    at = np.round(ways * len(path) / (360 * turns)).astype(int)
    axes.plot(path[at].real, path[at].imag, "o", color=color, markersize=2.6, zorder=3.5)
    numbers(axes, labels, told_angles(motion.crank_angle), path, color)


def _keys(names: Sequence[str], pale: bool) -> list[Any]:
    found = [
        Line2D([], [], color=color, linestyle=dashes, label=say("path of {point}", point=name))
        for name, (color, dashes) in zip(
            [short(name, 12) for name in names], LINE_LOOKS, strict=False
        )
    ]
    if pale:
        found.append(Line2D([], [], color=FAINT, linewidth=0.9, label=say("other points")))
    return found


# -- hodographs ------------------------------------------------------------------------------------


@styled()
def hodograph_figure(analysis: Analysis, points: Sequence[str] | None = None) -> Figure:
    """Ends of the arrows of velocity and acceleration of points.

    points : names; where they are not given, the same as of `curves_figure`.
    """
    motion = analysis.motion
    names = followed(analysis, points, MOST_VECTORS)
    every = [motion.points[name] for name in names]
    side = (WIDTH - LEFT - RIGHT - BETWEEN) / 2
    figure = blank(WIDTH, side + TOP + BOTTOM)
    what = title(
        analysis,
        say("Hodographs of velocity and acceleration"),
        say("numbers: crank angle, deg"),
        of_one=True,
    )
    heading(figure, analysis.machine.title, what, LEFT)
    pairs = (
        (say("velocity"), "m/s", 1.0, [point.velocity for point in every]),
        _scaled(say("acceleration"), [point.acceleration_vector for point in every]),
    )
    for number, (name, unit, factor, values) in enumerate(pairs):
        axes = place(figure, LEFT + number * (side + BETWEEN), BOTTOM, side, side)
        square(factor * np.concatenate([*values, [0]]), side).settle(axes)
        axes.set_xlabel(say("{quantity} along x, {unit}", quantity=name, unit=unit))
        axes.set_ylabel(say("{quantity} along y, {unit}", quantity=name, unit=unit))
        _hodographs(axes, analysis, [factor * one for one in values])
        if not names:
            nothing_there(axes, say("no point moves"))
    legend(figure, _of_points(names))
    return figure


def _scaled(name: str, values: list[Array]) -> tuple[str, str, float, list[Array]]:
    unit = unit_of("acceleration", np.concatenate([*values, [0]]))
    return name, unit.name, unit.factor, values


def _of_points(names: Sequence[str]) -> list[Any]:
    """Which line is of which point."""
    return [
        Line2D([], [], color=color, linestyle=dashes, label=short(name, 14))
        for name, (color, dashes) in zip(names, LINE_LOOKS, strict=False)
    ]


def _hodographs(axes: Axes, analysis: Analysis, values: list[Array]) -> None:
    origin(axes)
    axes.plot(0, 0, "o", color=LINES, markersize=3, zorder=3)
    labels = Labels(axes)
    for one, (color, dashes) in zip(values, LINE_LOOKS, strict=False):
        line = over(analysis, one)[1]
        axes.plot(line.real, line.imag, color=color, linestyle=dashes, linewidth=1.4, zorder=3)
        labels.avoid(line.real, line.imag)
    if not analysis.motion.whole_cycle:
        return
    told = told_angles(analysis.crank_angle)
    if len(values) > 1:
        told = {angle: k for angle, k in told.items() if angle in FEW}
    for one, (color, _) in zip(values, LINE_LOOKS, strict=False):
        numbers(axes, labels, told, one, color)
