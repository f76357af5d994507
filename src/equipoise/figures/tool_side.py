"""A hand-held tool from the side: at rest, deflected at work and in its modes, before and after."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from equipoise.errors import UsageError
from equipoise.figures.chart_parts import by_name
from equipoise.figures.style import short
from equipoise.figures.tool_charts import (
    LONGEST,
    POINTS,
    at_largest,
    change_texts,
    design,
    mode_charts,
    rpm_text,
    station_flags,
)
from equipoise.handheld.response import respond_tool
from equipoise.handheld.side import side_of
from equipoise.i18n import Note, say, to_say
from equipoise.results.charts import (
    Arrow,
    Axis,
    Chart,
    Curve,
    Line,
    Mark,
    Panel,
    PlaceLabel,
    four_digits,
    quantity,
)
from equipoise.signals import Array

if TYPE_CHECKING:
    from equipoise.handheld.design import ToolDesign
    from equipoise.handheld.model import Tool
    from equipoise.handheld.modes import ToolModes
    from equipoise.symbols.tool import ToolScene


SWING = 0.05
"""Largest displacement as it is drawn, over the length of the shaft."""
MOST_MODES = 4
LANE = 16.0
"""Between two arrows of places that a design moves, units."""


def side(tool: Tool) -> Chart:
    """``side``: what the tool is, to scale along its shaft; and how it moves at work."""
    panels = [_panel(side_of(tool), _named(tool))]
    panels += _at_work(tool)
    what = say("The tool from the side, shaft to scale; bodies as cubes of the density of water")
    caption = to_say("The tool from the side, at rest and as it is deflected at work.")
    return Chart("side", tool.title, what, tuple(panels), caption=caption)


def side_modes(modes: ToolModes) -> Chart:
    """``side-modes``: the tool in its lowest modes of the vertical plane."""
    lowest = np.flatnonzero(modes.planes[0].frequency > 0)[:MOST_MODES]
    still = np.ones(1)
    return _modes_chart(modes, [_swinging(modes, k, still)[0] for k in map(int, lowest)])


def in_mode(modes: ToolModes, number: int, count: int) -> list[Chart]:
    """The tool at `count` instants of half a swing, from one end to the other.

    number : of the mode in the vertical plane, counted from 1.

    Raises
    ------
    UsageError : there is no such mode.
    """
    frequency = modes.planes[0].frequency
    if not (1 <= number <= len(frequency) and frequency[number - 1] > 0):
        first, last = np.flatnonzero(frequency > 0)[[0, -1]] + 1
        raise UsageError(
            Note(
                "got {number}; of the vertical plane there are {first} to {last}",
                number=number,
                first=first,
                last=last,
            )
        )
    phases = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    return [_modes_chart(modes, [panel]) for panel in _swinging(modes, number - 1, phases)]


def _modes_chart(modes: ToolModes, panels: Sequence[Panel]) -> Chart:
    drawn_as = quantity(SWING * modes.tool.shaft.length, "length")
    what = say("Modes from the side; largest displacement drawn as {length}", length=drawn_as)
    caption = to_say("The tool from the side in its lowest natural vibrations.")
    return Chart("side-modes", modes.tool.title, what, tuple(panels), caption=caption)


def _swinging(modes: ToolModes, k: int, phases: Array) -> list[Panel]:
    """Mode k of the vertical plane; phases (N,) : shares of its largest displacement."""
    plane = modes.planes[0]
    frequency = four_digits(float(plane.cycles_per_second[k]))
    title = say("mode {number}: {frequency} Hz", number=k + 1, frequency=frequency)
    swing = SWING * modes.tool.shaft.length * phases[:, None]
    tool_scene = side_of(modes.tool, modes.places, swing * plane.shapes[k])
    panel = _panel(tool_scene, (), title)
    return [replace(panel, signs=tuple(tool_scene.at(instant))) for instant in range(len(phases))]


def side_design(design: ToolDesign) -> Chart:
    """``side-design``: the tool before and after, with arrows of what is moved along the shaft."""
    old = side_of(design.tool)
    moved = [
        (station.position, other.position)
        for station, other in zip(design.tool.stations, design.better.stations, strict=True)
        if station.position != other.position
    ]
    before = _panel(old, _named(design.tool), say("before"))
    after = _panel(side_of(design.better), _named(design.better), say("after"), moved)
    what = say("The tool from the side before and after; arrows: what is moved along the shaft")
    words = tuple(change_texts(design))
    caption = to_say("The tool from the side before and after what is changed.")
    both = (before, after)
    return Chart("side-design", design.tool.title, what, both, words=words, caption=caption)


def _named(tool: Tool) -> tuple[PlaceLabel, ...]:
    """Stations with where they are."""
    places = {station.name: quantity(station.position, "length", "mm") for station in tool.stations}
    by_label = {short(name, LONGEST): place for name, place in places.items()}
    return tuple(
        PlaceLabel(
            station_flag.at,
            (*station_flag.texts, by_label[station_flag.texts[0]]),
            station_flag.weight,
        )
        for station_flag in station_flags(tool)
    )


def _at_work(tool: Tool) -> Iterator[Panel]:
    """Deflected by the order that moves it most in the vertical plane, larger than it is."""
    if tool.operation is None or not tool.excitations:
        return
    along = np.linspace(0.0, tool.shaft.length, POINTS)
    response = respond_tool(tool, tool.operation.speed)
    moved = response.line(along).displacement[:, 0, :, 0]
    order = int(np.argmax(np.max(np.abs(moved), axis=0)))
    shape = at_largest(moved[:, order])
    most = float(np.max(np.abs(shape)))
    if not most:
        return
    factor = float(f"{SWING * tool.shaft.length / most:.1g}")
    title = say("at work, {speed} rpm", speed=rpm_text(tool.operation.speed))
    remark = say(
        "order {order}, displacement drawn {factor} times as large",
        order=four_digits(float(response.orders[order])),
        factor=f"{factor:g}",
    )
    yield _panel(side_of(tool, along, factor * shape[None]), (), title, remark=remark)


def _panel(
    scene: ToolScene,
    flags: tuple[PlaceLabel, ...] = (),
    title: str = "",
    moved: Sequence[tuple[float, float]] = (),
    remark: str = "",
) -> Panel:
    x, y = (Axis.of("", "length", [0.1], room=0.0) for _ in "xy")
    low, high = scene.box
    arrows, marks = [], []
    for lane, (before, after) in enumerate(moved):
        depth = low.imag - (lane + 0.5) * LANE * scene.unit
        tail, head = complex(before, depth), complex(after, depth)
        arrows.append(Arrow(tail, head, "move"))
        text = f"{x.format_value(before)} → {x.quantity(after)}"
        marks.append(Mark.of(max(tail, head, key=lambda z: z.real), text, "ink", 0.0, False))
    low -= 1j * LANE * scene.unit * len(arrows)
    still = Curve(scene.along[[0, -1]], np.zeros(2), "", "zero")
    return Panel(
        x,
        y,
        (still,),
        tuple(marks),
        lines=tuple(Line(flag.at, "station line") for flag in flags),
        arrows=tuple(arrows),
        flags=flags,
        title=title,
        remark=remark,
        equal=True,
        grid=False,
        zero=False,
        bare=True,
        signs=tuple(scene.at(0)),
        always_shown=(low, high),
    )


def side_mode_charts(modes: ToolModes) -> dict[str, Chart]:
    """``side-modes``, then ``modes`` and ``modes-lateral``."""
    return by_name([side_modes(modes)]) | mode_charts(modes)


def design_charts(result: ToolDesign) -> dict[str, Chart]:
    """``side-design`` and ``design``."""
    return by_name([side_design(result), design(result)])
