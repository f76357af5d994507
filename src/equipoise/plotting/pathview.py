"""The picture of both paths of the tip: relative to the machine, and over ground."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from equipoise.i18n import say
from equipoise.plotting.labels import Labels
from equipoise.plotting.linkage import draw_sketch
from equipoise.plotting.marks import angle_ticks, dots, hill_spacing, senses, travel
from equipoise.plotting.panels import BOTTOM, GAP, LEFT, RIGHT, TOP, Panel, panels
from equipoise.plotting.paths import CM, Mark, Paths
from equipoise.plotting.style import (
    EARTH,
    FAINT,
    INK,
    INSTANTS,
    LINES,
    MAIN,
    MARKS,
    SMALL,
    SOIL,
    STRESS,
    STUBBLE,
    blank,
    heading,
    short,
)

if TYPE_CHECKING:
    from equipoise.planting.summary import PlantingFigures

Array = np.ndarray[Any, Any]

MOST_UNITS = 12


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
        _soil(axes, panel, CM * paths.level)
        draw(axes, paths, panel.inch)
        at += panel.width + GAP
    return figure


def _soil(axes: Axes, panel: Panel, level: float) -> None:
    axes.axhspan(panel.bottom, level, fc=SOIL, ec=STUBBLE, hatch="////", linewidth=0, zorder=0.5)
    axes.axhline(level, color=EARTH, linewidth=1.1, zorder=1.2)


def _machine_panel(axes: Axes, paths: Paths, inch: float) -> None:
    axes.set_xlabel(say("x in the frame, cm"))
    axes.set_ylabel(say("height y in the frame, cm"))
    labels = Labels(axes)
    labels.avoid(axes.get_xlim(), [CM * paths.level] * 2)
    draw_sketch(axes, paths.drawn, CM, inch)
    for around in paths.drawn.outlines.values():
        outline = CM * np.append(around, around[0])
        labels.avoid(outline.real, outline.imag)
    _path(axes, labels, paths, paths.on_machine(paths.cycle))
    if paths.tray.size:
        tray = CM * paths.tray
        axes.plot(tray.real, tray.imag, color=INK, linewidth=2.2, zorder=2.7)
        labels.avoid(tray.real, tray.imag, weight=4)
    marks = list(paths.marks(tuple(MARKS), over_ground=False))
    dots(axes, marks, labels)
    senses(axes, paths, over_ground=False)
    angles = angle_ticks(axes, paths, inch)
    for place in paths.drawn.places.values():
        labels.reserve(CM * place.real, CM * place.imag)
    for name, place in paths.drawn.places.items():
        _put(labels, Mark(short(name), place, 45), near=5, fontweight="bold")
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
    dots(axes, marks, labels)
    senses(axes, paths, over_ground=True)
    hill_spacing(axes, paths, labels, inch)
    travel(axes, paths, labels)
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
