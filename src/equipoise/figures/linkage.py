"""The linkage at chosen crank angles, with the names of its joints and links."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from equipoise.errors import UsageError
from equipoise.figures.drawing import (
    Drawn,
    Panel,
    Placed,
    draw_machine,
    hold,
    keep_clear,
    key_of,
    mass_key,
    moving,
)
from equipoise.figures.labels import Labels
from equipoise.i18n import say
from equipoise.mechanism.motion import move
from equipoise.plotting.style import (
    INK,
    LEFT,
    LINES,
    MAIN,
    NORMAL,
    RIGHT,
    SMALL,
    WIDTH,
    blank,
    heading,
    legend,
    place,
    short,
    shown,
    styled,
)
from equipoise.symbols.clear import clear_angle
from equipoise.symbols.looks import LIGHT
from equipoise.symbols.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.mechanism.motion import Motion
    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

MM = 1000.0
MOST = 24
"""Crank angles in one picture."""
HIGHEST, LOWEST = 5.2, 1.4
"""Inches: height of the axes at most and at least."""
TOP, BOTTOM, GAP, NAME = 0.82, 0.5, 0.16, 0.22
"""Inches: above and below the axes; between several, and for the name above each."""
PATH: Any = {"color": MAIN, "linewidth": 0.6, "alpha": 0.55}
MANY, SMALLER = 3, 0.75
"""Axes beside each other in which signs are smaller, and how much."""


@styled()
def linkage_figure(analysis: Analysis, at: Sequence[float] | None = None) -> Figure:
    """The linkage with names, signs of the centres of mass, and paths of its points.

    at : crank angles, rad, each with axes of its own; where they are not given, one at which
        joints and links keep apart.

    Raises
    ------
    MotionError : the linkage cannot reach a crank angle.
    UsageError : there are none of them, or too many.
    """
    motion = analysis.motion
    scene, count = Scene.of(motion), len(motion.crank_angle)
    if at is None:
        which = [clear_angle(scene)]
    else:  # after those of the cycle, so that blocks have the whole way that they run
        every = [*motion.crank_angle, *at]
        scene = Scene.of(move(analysis.machine, every, motion.speed, motion.acceleration))
        which = [*range(count, len(every))]
    angles = scene.crank_angle[which]
    if not 1 <= len(angles) <= MOST:
        raise UsageError(f"got {len(angles)} crank angles; a picture shows 1 to {MOST}")
    paths = [_path(motion, name) for name in moving(motion)]
    columns = 1 if len(angles) == 1 else 2 if len(angles) <= 4 else MANY
    panel = hold(MM * np.array(scene.box), *_room(columns))
    figure, every = _panels(analysis, panel, len(angles), columns)
    size = SMALLER if columns == MANY else 1.0
    for axes, k, angle in zip(every, which, angles, strict=True):
        drawn = Drawn(scene, k, MM, panel.inch, size)
        for path in paths:
            axes.plot(path.real, path.imag, zorder=1.2, **PATH)
        shapes = draw_machine(axes, drawn)
        _label(axes, drawn, shapes, paths, columns)
        if columns > 1:
            axes.set_title(_told(angle), fontsize=NORMAL, loc="left", pad=3)
    drive = short(analysis.machine.drive.link)
    if columns == 1:
        told = _told(angles[0])
        what = say(
            "Linkage, to scale; angle of {link} in the frame: {angle}", link=drive, angle=told
        )
    else:
        what = say("Linkage, to scale; above each: angle of {link} in the frame", link=drive)
    heading(figure, analysis.machine.title, what, LEFT)
    legend(figure, _keys(scene, bool(paths)))
    return figure


def _path(motion: Motion, name: str) -> Array:
    """Of a point, mm; closed where the cycle is whole."""
    place = MM * motion.points[name].place
    return np.append(place, place[:1]) if motion.whole_cycle else place


def _told(angle: float) -> str:
    return f"{shown(round(float(np.degrees(angle)), 2))}°"


def _room(columns: int) -> tuple[float, float, float]:
    """Inches of each axes: width, and height at most and at least."""
    wide = (WIDTH - LEFT - RIGHT - GAP * (columns - 1)) / columns
    if columns == 1:
        return wide, HIGHEST, LOWEST
    return wide, 1.4 * wide, 0.0


def _panels(
    analysis: Analysis, panel: Panel, count: int, columns: int
) -> tuple[Figure, list[Axes]]:
    """Axes of one scale, with numbers at the outer ones."""
    rows = ceil(count / columns)
    row = panel.height + (NAME if columns > 1 else 0.0)
    width = LEFT + RIGHT + columns * panel.width + (columns - 1) * GAP
    whole = TOP + BOTTOM + rows * row + (rows - 1) * GAP
    figure = blank(width, whole)
    every = []
    for number in range(count):
        down, across = divmod(number, columns)
        bottom = whole - TOP - (down + 1) * row - down * GAP
        left = LEFT + across * (panel.width + GAP)
        axes = place(figure, left, bottom, panel.width, panel.height)
        panel.settle(axes)
        last = number + columns >= count
        axes.tick_params(labelleft=across == 0, labelbottom=last)
        if across == 0:
            axes.set_ylabel(say("y in the frame, mm"))
        if last:
            axes.set_xlabel(say("x in the frame, mm"))
        every.append(axes)
    return figure, every


def _label(
    axes: Axes, drawn: Drawn, shapes: list[Placed], paths: list[Array], columns: int
) -> None:
    """Names of joints, and of links where there is room."""
    labels = Labels(axes)
    keep_clear(labels, shapes)
    for path in paths:
        labels.avoid(path.real, path.imag, weight=0.4)
    size = NORMAL if columns == 1 else SMALL
    look: Any = {"fontweight": "bold", "color": INK, "near": 5.0, "fontsize": size}
    for name, z in drawn.points.items():
        labels.put(short(name), z.real, z.imag, wish=_away(drawn, z), **look)
    if columns > 1:
        return
    look = {"fontstyle": "italic", "color": LINES, "near": 5.0}
    for link, outline in drawn.outlines.items():
        z = complex(np.mean(outline)) if len(outline) > 1 else _end(drawn, link)
        labels.put(short(link), z.real, z.imag, wish=_across(outline), **look)


def _end(drawn: Drawn, link: str) -> complex:
    """Where the name of a link with one point stands: half way to its centre of mass."""
    point = complex(drawn.outlines[link][0])
    return (point + drawn.mass_centers.get(link, point)) / 2


def _away(drawn: Drawn, z: complex) -> float:
    """Direction (deg) out of the links that meet at a point."""
    met = [outline for outline in drawn.outlines.values() if np.any(outline == z)]
    ways = [complex(np.mean(outline)) - z for outline in met]
    out = -sum(way / abs(way) for way in ways if way)
    return float(np.degrees(np.angle(out))) if abs(out) > 0.1 else 45.0


def _across(outline: Array) -> float:
    """Direction (deg) in which the name of a link stands: beside a bar, upward."""
    if len(outline) < 2:
        return 60.0
    way = float(np.degrees(np.angle(1j * (outline[1] - outline[0]))))
    return way if way >= 0 else way + 180


def _keys(scene: Scene, paths: bool) -> list[Any]:
    """What the signs are that the picture has."""
    found: list[Any] = []
    if scene.mass_centers:
        found.append(mass_key(say("centre of mass")))
    if paths:
        found.append(Line2D([], [], label=say("paths of points"), **PATH))
    if scene.wheels:
        found.append(key_of("wheel", say("pitch circles of gears")))
    if scene.planned:
        found.append(key_of("planned", say("spring to be found")))
    if scene.carrier is not None:
        found.append(Patch(fc=LIGHT["wheel"], ec=LIGHT["faint"], lw=0.8, label=say("support")))
    if scene.field is not None:
        found.append(Patch(fc=LIGHT["soil"], ec=LIGHT["earth"], lw=0.8, label=say("soil")))
    return found
