"""The picture of the changed machine: what to add, move and set, to scale."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from equipoise.figures.additions import MM, Mark, Posed, marks, posed_well
from equipoise.figures.drawing import (
    Drawn,
    Panel,
    Placed,
    arrow,
    draw_machine,
    keep_clear,
    key_of,
)
from equipoise.figures.labels import Labels
from equipoise.i18n import say, to_say
from equipoise.mechanism.motion import move
from equipoise.plotting.style import (
    INK,
    LEFT,
    LINES,
    MAIN,
    RIGHT,
    STRESS,
    blank,
    heading,
    legend,
    place,
    short,
    shown,
)
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import coils, zigzag

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.axes import Axes

    from equipoise.balancing.balanced import Balanced

Array = np.ndarray[Any, Any]

WIDEST, HIGHEST = 6.6, 5.2
NARROWEST, LOWEST = 4.6, 1.7
"""Inches: the axes at most and at least."""
TOP, BOTTOM, ROOM = 0.82, 0.5, 0.5
"""Inches: above and below the axes; free around what is drawn, for labels."""
FAR = 2.0
"""Over the size of the machine: rooms that are larger do not set the scale."""
NEAR = 0.12
"""Inches: dots that are nearer to each other look like one."""
FILL = 0.45
"""How opaque added masses are."""
DASHES: Any = {"room": (0, (5, 3)), "gear": (0, (8, 2, 1.5, 2)), "spring": "-"}
COLORS = {"room": LINES, "gear": STRESS, "spring": STRESS, "move": STRESS, "mass": MAIN}
NAMES = {
    "mass": to_say("added mass"),
    "move": to_say("centre of mass, from old to new"),
    "gear": to_say("pitch circles of new gears"),
    "spring": to_say("new spring"),
    "room": to_say("room allowed"),
}


def changes_figure(found: Balanced) -> Figure:
    """The new machine, as far as can be with nothing on top of each other, and its changes."""
    posed = posed_well(found.original, found.machine)
    drawn = marks(posed, found.changes, found.plan)
    scene = _without_new(posed.scene, Scene.of(move(found.original, [0.0])))
    panel = _panel(posed, scene, drawn)
    figure = blank(panel.width + LEFT + RIGHT, panel.height + TOP + BOTTOM)
    drive = short(found.machine.drive.link)
    changed = any(one.kind != "room" for one in drawn)
    what = say("What to change, to scale") if changed else say("Nothing to change, to scale")
    angle = f"{shown(round(float(np.degrees(posed.crank_angle)), 2))}°"
    what += "; " + say("angle of {link} in the frame: {angle}", link=drive, angle=angle)
    heading(figure, found.original.title, what, LEFT)
    axes = place(figure, LEFT, BOTTOM, panel.width, panel.height)
    panel.settle(axes)
    axes.set_xlabel(say("x in the frame, mm"))
    axes.set_ylabel(say("y in the frame, mm"))
    machine = Drawn(scene, posed.number, MM, panel.inch)
    shapes = draw_machine(axes, machine)
    for one in drawn:
        _draw(axes, one, machine.unit)
    _label(axes, machine, shapes, drawn)
    legend(figure, _keys(drawn, gears=bool(scene.wheels)))
    return figure


def _without_new(scene: Scene, old: Scene) -> Scene:
    """What there was before, and no centres of mass: what is new is drawn over it."""
    springs, wheels = scene.springs[: len(old.springs)], scene.wheels[: len(old.wheels)]
    return replace(scene, springs=springs, wheels=wheels, planned=(), mass_centers={})


def _panel(posed: Posed, scene: Scene, drawn: list[Mark]) -> Panel:
    """The part of the plane that holds machine and changes, on one scale."""
    machine = MM * scene.corners_at(posed.number)
    size = _size(machine)
    shapes = [m.outline for m in drawn if m.kind != "room" or _size(m.outline) <= FAR * size]
    held = np.concatenate([machine, *shapes])
    low = complex(np.min(held.real), np.min(held.imag))
    high = complex(np.max(held.real), np.max(held.imag))
    across, up = (high - low).real, (high - low).imag
    inch = max(across / (WIDEST - 2 * ROOM), up / (HIGHEST - 2 * ROOM)) or 1.0
    middle = (low + high) / 2
    half = complex(
        max(across / 2 + ROOM * inch, NARROWEST * inch / 2),
        max(up / 2 + ROOM * inch, LOWEST * inch / 2),
    )
    start, stop = middle - half, middle + half
    return Panel(start.real, stop.real, start.imag, stop.imag, inch)


def _size(places: Array) -> float:
    return float(max(np.ptp(places.real), np.ptp(places.imag)))


def _draw(axes: Axes, one: Mark, unit: float) -> None:
    """unit : of signs, mm."""
    color = COLORS[one.kind]
    x, y = one.outline.real, one.outline.imag
    if one.kind == "move":
        _move(axes, one)
    elif one.kind == "mass" and len(one.outline) == 1:
        axes.plot(x, y, "o", color=color, markersize=8, markeredgecolor="white", zorder=3.4)
    elif one.kind == "mass":
        outlines = [one.outline, *(hole[::-1] for hole in one.holes)]
        path = Path.make_compound_path(*(_path(outline) for outline in outlines))
        axes.add_patch(PathPatch(path, fc=color, ec="none", alpha=FILL, zorder=3.1))
        axes.add_patch(PathPatch(path, fc="none", ec=color, lw=1.0, zorder=3.2))
    elif one.kind == "spring":
        start, end = (complex(z) for z in one.outline)
        line = zigzag(start, end, coils(abs(end - start), unit)).at(1.0, unit)
        axes.plot(line.real, line.imag, color=color, label=one.kind, linewidth=1.4, zorder=2.8)
    else:
        look: Any = {"linestyle": DASHES[one.kind], "linewidth": 0.9, "zorder": 2.3}
        axes.plot(x, y, color=color, label=one.kind, **look)


def _path(outline: Array) -> Path:
    return Path(np.column_stack([outline.real, outline.imag]), closed=True)


def _move(axes: Axes, one: Mark) -> None:
    """From a hollow dot to a full one."""
    old, new = (complex(z) for z in one.outline)
    color = COLORS["move"]
    look: Any = {"color": color, "markersize": 5, "zorder": 3.6}
    axes.plot(old.real, old.imag, "o", markerfacecolor="white", **look)
    axes.plot(new.real, new.imag, "o", **look)
    if old != new:
        arrow(axes, old, new, color=color, lw=1.4, mutation_scale=11, zorder=3.5)


def _label(axes: Axes, machine: Drawn, shapes: list[Placed], drawn: list[Mark]) -> None:
    """What is changed by how much, and the names of points where there is room."""
    labels = Labels(axes)
    keep_clear(labels, shapes)
    for one in drawn:
        if len(one.outline) > 1:
            labels.avoid(one.outline.real, one.outline.imag, 0.25 if one.kind == "room" else 0.6)
    for at in _dots(drawn):
        labels.reserve(at.real, at.imag)
    for one, text in _together(drawn, NEAR * machine.inch):
        wish = float(np.degrees(np.angle(one.away)))
        labels.put(text, one.at.real, one.at.imag, wish=wish, color=COLORS[one.kind])
    look: Any = {"fontweight": "bold", "color": INK, "near": 5.0, "optional": True}
    for name, at in machine.points.items():
        labels.put(short(name), at.real, at.imag, wish=45.0, **look)


def _together(drawn: list[Mark], near: float) -> Iterator[tuple[Mark, str]]:
    """What has a text, with that; several that are alike and at one place share it."""
    left = [one for one in drawn if one.text]
    while left:
        first = left[0]
        alike = [one for one in left if one.text == first.text and abs(one.at - first.at) < near]
        left = [one for one in left if one not in alike]
        yield first, first.text if len(alike) == 1 else f"{len(alike)} × {first.text}"


def _dots(drawn: list[Mark]) -> list[complex]:
    """Places of points and centres of mass."""
    small = (one for one in drawn if one.kind == "move" or len(one.outline) == 1)
    return [complex(z) for one in small for z in one.outline]


def _keys(drawn: list[Mark], gears: bool) -> list[Any]:
    """What the signs are that the picture has.

    gears : whether there are some already.
    """
    kinds = {one.kind for one in drawn}
    found: list[Any] = []
    look: Any
    for kind, text in NAMES.items():
        if kind not in kinds:
            continue
        name = say(text)
        if kind == "mass" and all(len(one.outline) == 1 for one in drawn if one.kind == kind):
            look = {"color": COLORS[kind], "marker": "o", "markersize": 8, "mec": "white"}
            found.append(Line2D([], [], linestyle="none", label=name, **look))
        elif kind == "mass":
            look = {"facecolor": MAIN, "alpha": FILL, "linewidth": 0}
            found.append(Patch(label=name, **look))
        elif kind == "move":
            found.append(Line2D([], [], color=COLORS[kind], marker=">", label=name))
        else:
            width = 1.6 if kind == "spring" else 0.9
            look = {"color": COLORS[kind], "linestyle": DASHES[kind], "linewidth": width}
            found.append(Line2D([], [], label=name, **look))
    if gears:
        found.append(key_of("wheel", say("pitch circles of gears")))
    return found
