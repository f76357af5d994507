"""The linkage at chosen crank angles, with the names of its joints and links."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from equipoise.errors import UsageError
from equipoise.i18n import say
from equipoise.mechanism.motion import Motion, PointMotion, move
from equipoise.plotting.analysis.looks import MM, over
from equipoise.plotting.analysis.plane import clear_angle, hold, moving
from equipoise.plotting.labels import Labels
from equipoise.plotting.linkage import (
    CENTER,
    HIGH,
    QUARTERS,
    Sketch,
    draw_mass_centers,
    draw_sketch,
    rail_of,
    sketch,
)
from equipoise.plotting.marks import arrow
from equipoise.plotting.style import (
    FAINT,
    INK,
    LINES,
    MAIN,
    NORMAL,
    SMALL,
    STRESS,
    blank,
    heading,
    short,
    shown,
    styled,
)
from equipoise.plotting.vibration.panels import LEFT, RIGHT, WIDTH, legend, place
from equipoise.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.plotting.panels import Panel
    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

MOST = 24
"""Crank angles in one picture."""
HIGHEST, LOWEST = 5.2, 1.4
"""Inches: height of the axes at most and at least."""
TOP, BOTTOM, GAP, NAME = 0.82, 0.5, 0.16, 0.22
"""Inches: above and below the axes; between several, and for the name above each."""
MANY, SMALLER = 3, 0.75
"""Axes beside each other in which signs are smaller, and how much."""
TURN = np.radians(np.linspace(22, 72, 26))
"""Crank angles ahead of the crank over which the arrow of its sense goes."""


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
    paths = [MM * over(analysis, point.place)[1] for point in _moving(motion)]
    columns = 1 if len(angles) == 1 else 2 if len(angles) <= 4 else MANY
    panel = hold(MM * np.array(scene.box), *_room(columns))
    drawn = [sketch(scene, k) for k in which]
    figure, every = _panels(analysis, panel, len(angles), columns)
    for axes, one, angle in zip(every, drawn, angles, strict=True):
        for path in paths:
            axes.plot(path.real, path.imag, color=MAIN, linewidth=0.6, alpha=0.55, zorder=1.2)
        inch = panel.inch * (SMALLER if columns == MANY else 1.0)
        draw_sketch(axes, one, MM, inch)
        if columns < MANY:
            draw_mass_centers(axes, one, MM)
        _label(axes, one, motion, inch, paths, columns)
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
    legend(figure, _keys(drawn[0], bool(paths), columns < MANY))
    return figure


def _told(angle: float) -> str:
    return f"{shown(round(float(np.degrees(angle)), 2))}°"


def _moving(motion: Motion) -> list[PointMotion]:
    return [motion.points[name] for name in moving(motion)]


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
    axes: Axes, drawn: Sketch, motion: Motion, inch: float, paths: list[Array], columns: int
) -> None:
    """Names of joints, of links where there is room, and the sense in which the crank turns."""
    labels = Labels(axes)
    for outline in drawn.outlines.values():
        around = MM * np.append(outline, outline[0])
        labels.avoid(around.real, around.imag)
    for path in paths:
        labels.avoid(path.real, path.imag, weight=0.4)
    for slot in drawn.slots:
        line = MM * np.array([slot.start, slot.end])
        labels.avoid(line.real, line.imag)
        if slot.on_frame:
            rail = rail_of(line, inch)
            labels.avoid(rail.real, rail.imag, weight=3.0)
    for z in (*drawn.places.values(), *drawn.mass_centers.values()):
        labels.reserve(MM * z.real, MM * z.imag, half=CENTER / 2)
    for z in drawn.frame.values():
        labels.reserve(MM * z.real, MM * z.imag - 0.6 * HIGH * inch, half=72 * 0.65 * HIGH)
    _sense(axes, drawn, motion, labels, inch)
    size = NORMAL if columns == 1 else SMALL
    look: Any = {"fontweight": "bold", "color": INK, "near": 5.0, "fontsize": size}
    for name, z in drawn.places.items():
        labels.put(short(name), MM * z.real, MM * z.imag, wish=_away(drawn, z), **look)
    if columns > 1:
        return
    look = {"fontstyle": "italic", "color": LINES, "near": 5.0}
    for link, outline in drawn.outlines.items():
        z = MM * complex(np.mean(outline)) if len(outline) > 1 else MM * _end(drawn, link)
        labels.put(short(link), z.real, z.imag, wish=_across(outline), **look)


def _end(drawn: Sketch, link: str) -> complex:
    """Where the name of a link with one point stands: half way to its centre of mass."""
    point = complex(drawn.outlines[link][0])
    return (point + drawn.mass_centers.get(link, point)) / 2


def _away(drawn: Sketch, z: complex) -> float:
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


def _sense(axes: Axes, drawn: Sketch, motion: Motion, labels: Labels, inch: float) -> None:
    """An arrow about the crank's pivot in the sense in which it turns."""
    if not motion.speed:
        return
    pivot = drawn.places[motion.linkage.pivot]
    arms = drawn.outlines[motion.machine.drive.link] - pivot
    arm = complex(arms[np.argmax(np.abs(arms))])
    if not arm:
        return
    radius = max(0.55 * abs(arm) * MM, 0.28 * inch)
    turned = np.exp(1j * np.sign(motion.speed) * TURN) * arm / abs(arm)
    line = MM * pivot + radius * turned
    axes.plot(line.real, line.imag, color=STRESS, linewidth=1.1, zorder=2.8)
    look: Any = {"color": STRESS, "mutation_scale": 9, "lw": 0.8, "zorder": 2.9}
    arrow(axes, complex(line[-4]), complex(line[-1]), **look)
    labels.avoid(line.real, line.imag, weight=2.0)


def _keys(drawn: Sketch, paths: bool, masses: bool) -> list[Any]:
    """What the signs are that the picture has."""
    found: list[Any] = []
    if drawn.mass_centers and masses:
        sign: Any = {"linestyle": "none", "markersize": CENTER, "mec": INK, "mew": 0.7}
        name = say("centre of mass")
        found.append(Line2D([], [], marker=QUARTERS, mfc=INK, label=name, **sign))
    if paths:
        look: Any = {"color": MAIN, "linewidth": 0.8, "alpha": 0.7}
        found.append(Line2D([], [], label=say("paths of points"), **look))
    if drawn.circles:
        look = {"color": FAINT, "linestyle": (0, (4, 2)), "linewidth": 0.9}
        found.append(Line2D([], [], label=say("pitch circles of gears"), **look))
    return found
