"""The picture of both paths of the tip: relative to the machine, and over ground."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from equipoise.figures.crank import angle_step
from equipoise.figures.drawing import UNIT, Drawn, arrow, draw_machine, draw_still, keep_clear
from equipoise.figures.labels import Labels
from equipoise.figures.paths import BOTTOM, CM, GAP, LEFT, RIGHT, TOP, Mark, Paths, panels
from equipoise.i18n import say
from equipoise.plotting.style import (
    FAINT,
    INK,
    INSTANTS,
    LINES,
    MAIN,
    MARKS,
    NORMAL,
    SMALL,
    STRESS,
    blank,
    heading,
    short,
    shown,
)
from equipoise.symbols.shapes import line, soil

if TYPE_CHECKING:
    from equipoise.planting.summary import PlantingFigures

Array = np.ndarray[Any, Any]

MOST_UNITS = 12
SMALLER = 0.85
"""Size of the machine's signs, over that in a picture of their own."""
ARROWS_IN = ((0.12, 0.45), (0.55, 0.88))
"""Between which parts of the way from exit to entry the heads of arrows are."""


def path_figure(figures: PlantingFigures) -> Figure:
    """The path relative to the machine with the linkage, and the path over ground."""
    paths = Paths(figures)
    row = panels(paths)
    width = LEFT + RIGHT + sum(panel.width for panel in row) + GAP * (len(row) - 1)
    height = BOTTOM + TOP + row[0].height
    figure = blank(width, height)
    tip, drive = short(figures.planting.tip), short(figures.machine.drive.link)
    what = say(
        "Path of the tip {tip}, linkage at the lowest point; numbers: angle of {link}, deg",
        tip=tip,
        link=drive,
    )
    if paths.drives and figures.planting.units_per_turn > 1:
        what += "; " + say("dashed: other units")
    heading(figure, figures.machine.title, what, LEFT)
    at = LEFT
    for panel, draw in zip(row, (_machine_panel, _ground_panel), strict=False):
        place = (at / width, BOTTOM / height, panel.width / width, panel.height / height)
        axes = figure.add_axes(place)
        panel.settle(axes)
        unit = UNIT * panel.inch / 72 / CM
        ground = soil(panel.left / CM, panel.right / CM, paths.level, panel.bottom / CM, unit)
        draw_still(axes, ground, CM, panel.inch)
        draw(axes, paths, panel.inch)
        at += panel.width + GAP
    return figure


def _machine_panel(axes: Axes, paths: Paths, inch: float) -> None:
    axes.set_xlabel(say("x in the frame, cm"))
    axes.set_ylabel(say("height y in the frame, cm"))
    labels = Labels(axes)
    labels.avoid(axes.get_xlim(), [CM * paths.level] * 2)
    drawn = Drawn(paths.scene, -1, CM, inch, SMALLER)
    keep_clear(labels, draw_machine(axes, drawn, field=False))
    _path(axes, labels, paths, paths.on_machine(paths.cycle))
    if paths.tray.size:
        tray = [line("tray", *paths.tray)]
        keep_clear(labels, draw_still(axes, tray, CM, inch, lowest=2.7))
    marks = list(paths.marks(tuple(MARKS), over_ground=False))
    _dots(axes, marks, labels)
    _senses(axes, paths, over_ground=False)
    angles = _angle_ticks(axes, paths, inch)
    for name, place in drawn.points.items():
        _put(labels, Mark(short(name), place / CM, 45), near=5, fontweight="bold")
    for mark in marks:
        _put(labels, replace(mark, name=say(INSTANTS[mark.name])))
    if paths.tray.size:
        _put(labels, Mark(say("tray"), complex(np.mean(paths.tray)), 0), fontstyle="italic")
    for mark in angles:
        _put(labels, mark, near=5, optional=True, color=LINES, fontsize=SMALL - 1)


def _ground_panel(axes: Axes, paths: Paths, inch: float) -> None:
    axes.set_xlabel(say("distance over ground, cm"))
    axes.tick_params(labelleft=False)
    labels = Labels(axes)
    labels.avoid(axes.get_xlim(), [CM * paths.level] * 2)
    places = paths.over_ground(paths.ways)
    for number in range(1, min(paths.figures.planting.units_per_turn, MOST_UNITS)):
        _other_unit(axes, paths, places, number)
    _path(axes, labels, paths, places)
    marks = list(paths.marks(tuple(MARKS)[1:], over_ground=True))
    _dots(axes, marks, labels)
    _senses(axes, paths, over_ground=True)
    _hill_spacing(axes, paths, labels, inch)
    _travel(axes, paths, labels)
    for mark in _beside(marks, paths.figures["forward_speed"] > 0):
        _put(labels, replace(mark, name=say(INSTANTS[mark.name])))
    for number, place in enumerate(paths.crossings()):
        axes.plot(CM * place.real, CM * place.imag, "x", color=INK, markersize=5, zorder=4)
        if number == 0:
            _put(labels, Mark(say("crossing of the loop"), place, 0), near=9)


def _beside(marks: list[Mark], ahead: bool) -> list[Mark]:
    """The marks over ground with their names outside, and clear of the dimension."""
    places = {mark.name: mark.place for mark in marks}
    wishes = {"lowest": -135.0 if ahead else -45.0}
    left, right = sorted(("entry", "exit"), key=lambda name: places[name].real)
    wishes |= {left: 160.0, right: 20.0}
    return [replace(mark, away=wishes.get(mark.name, mark.away)) for mark in marks]


def _put(labels: Labels, mark: Mark, **look: Any) -> None:
    labels.put(mark.name, CM * mark.place.real, CM * mark.place.imag, wish=mark.away, **look)


def _path(axes: Axes, labels: Labels, paths: Paths, places: Array) -> None:
    """A path, bolder where it is in the soil."""
    axes.plot(CM * places.real, CM * places.imag, color=MAIN, linewidth=1.5, zorder=3)
    below = paths.in_soil(places)
    axes.plot(CM * below.real, CM * below.imag, color=STRESS, linewidth=2.8, zorder=3.1)
    labels.avoid(CM * places.real, CM * places.imag)


def _other_unit(axes: Axes, paths: Paths, places: Array, number: int) -> None:
    """The path of another planting unit of the same drive, which plants the hills between."""
    sense = np.sign(paths.figures["forward_speed"])
    x = CM * (places.real + sense * number * paths.figures["hill_spacing"])
    axes.plot(x, CM * places.imag, color=FAINT, linewidth=0.9, linestyle=(0, (4, 2)), zorder=2)


# -- what is marked on the paths -------------------------------------------------------------------


def _dots(axes: Axes, marks: Sequence[Mark], labels: Labels) -> None:
    """Instants, each with a marker of its own."""
    for mark in marks:
        axes.plot(
            CM * mark.place.real,
            CM * mark.place.imag,
            MARKS[mark.name],
            color=INK,
            markerfacecolor="white",
            markersize=5,
            markeredgewidth=1.1,
            zorder=4,
        )
        labels.reserve(CM * mark.place.real, CM * mark.place.imag)


def _senses(axes: Axes, paths: Paths, over_ground: bool) -> None:
    """Heads of arrows that tell how the tip runs along its path, clear of the crank angles."""
    leave = paths.way_of("exit", paths.way_of("lowest", paths.start))
    above = paths.way_of("entry", leave) - leave
    step = np.radians(angle_step(paths.curve.turns))
    place = paths.over_ground if over_ground else paths.on_machine
    shunned = [*paths.crossings()] if over_ground else []
    for shares in ARROWS_IN:
        first, last = (round((leave + above * share) / step) for share in shares)
        ways = step * (np.arange(first, max(last, first + 1)) + 0.5)
        places = place(ways)
        apart = np.abs(places[:, None] - np.array(shunned, complex))
        best = int(np.argmax(np.min(apart, axis=1))) if shunned else len(ways) // 2
        shunned += [complex(places[best])] if over_ground else []
        tail, head = CM * place(ways[best] + np.array([-0.01, 0.01]))
        arrow(axes, tail, head, color=MAIN, mutation_scale=13, zorder=3.2)


def _angle_ticks(axes: Axes, paths: Paths, inch: float) -> list[Mark]:
    """Short lines across the path at round crank angles; they come back with their numbers."""
    marks = []
    for angle in range(0, 360 * paths.curve.turns, angle_step(paths.curve.turns)):
        place, away = paths.place_and_away(paths.sense * np.radians(angle), over_ground=False)
        marks.append(Mark(str(angle), place, away))
        out = np.exp(1j * np.radians(away)) * 0.045 * inch
        ends = np.array([CM * place - out, CM * place + out])
        axes.plot(ends.real, ends.imag, color=MAIN, linewidth=0.8, zorder=3)
    return marks


def _hill_spacing(axes: Axes, paths: Paths, labels: Labels, inch: float) -> None:
    """A dimension between the first hill and the next, below the path."""
    spacing = CM * paths.figures["hill_spacing"] * float(np.sign(paths.figures["forward_speed"]))
    left, right = axes.get_xlim()
    deep = CM * float(np.min(paths.over_ground(paths.ways).imag))
    y = deep - 0.24 * inch
    text = say("hill spacing {spacing} cm", spacing=shown(abs(spacing)))
    shown_whole = left < spacing < right and paths.curve.turns == 1
    if shown_whole:
        for x in (0.0, spacing):
            ends = [deep - 0.07 * inch, y - 0.05 * inch]
            axes.plot([x, x], ends, color=INK, linewidth=0.6, zorder=4)
            labels.avoid([x, x], ends)
        look = {"arrowstyle": "<|-|>", "lw": 0.7, "mutation_scale": 8}
        arrow(axes, complex(0, y), complex(spacing, y), **look)
    labels.occupy(
        axes.text(
            spacing / 2 if shown_whole else (left + right) / 2,
            y - 0.07 * inch,
            text,
            fontsize=SMALL,
            ha="center",
            va="top",
            zorder=5,
        )
    )


def _travel(axes: Axes, paths: Paths, labels: Labels) -> None:
    """An arrow above the path in the direction in which the machine drives."""
    text = axes.annotate(
        say("machine drives"),
        (0.5, 1),
        xycoords="axes fraction",
        xytext=(0, -6),
        textcoords="offset points",
        ha="center",
        va="top",
        fontsize=NORMAL,
    )
    labels.occupy(text)
    box = text.get_window_extent()
    ahead = paths.figures["forward_speed"] > 0
    gap, length = 6 * labels.dot, 32 * labels.dot
    tail, way = (box.x1 + gap, length) if ahead else (box.x0 - gap, -length)
    middle = (box.y0 + box.y1) / 2
    ends = axes.transAxes.inverted().transform([(tail, middle), (tail + way, middle)])
    arrow(
        axes,
        complex(*ends[0]),
        complex(*ends[1]),
        lw=1.6,
        mutation_scale=13,
        coordinates="axes fraction",
    )
