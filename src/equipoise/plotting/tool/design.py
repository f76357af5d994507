"""What a design does to the hands over its band of speeds."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from equipoise.figures.labels import Labels
from equipoise.handheld.design_plan import MEASURES
from equipoise.handheld.exposed import grips
from equipoise.handheld.response import respond_tool
from equipoise.i18n import say, to_say
from equipoise.plotting.style import FAINT, INK, blank, fit, heading, inches, short, shown
from equipoise.plotting.tool.speeds import (
    SPEED,
    Speeds,
    avoid_curves,
    curve_limits,
    engine_axis,
    name_work,
    tell_peaks,
    work_line,
)
from equipoise.plotting.tool.studies import UNITS
from equipoise.plotting.vibration.curves import KINDS, LINE, Curve, draw_curves, legend_at, rows_of
from equipoise.plotting.vibration.panels import FOOT, LEFT, RIGHT, RPM, WIDTH, name_x, name_y, place

if TYPE_CHECKING:
    from equipoise.handheld.design import ToolDesign
    from equipoise.handheld.model import Tool

TOP, TALL, STEP = 0.58, 2.9, 0.18
"""Inches: heading; the panel; a line of words."""
COLUMN = (WIDTH - LEFT - RIGHT) / 2
MOST = 8
"""Changes that are told."""
DASHED: Any = (0, (4, 2))


AT = re.compile("(a_hv|force) at (.+), (RMS over the band|largest)")
FIGURES = (
    to_say("a_hv of the worst hand, RMS over the band"),
    to_say("a_hv of the worst hand, largest"),
    to_say("mass"),
)
AT_STATION = {"a_hv": to_say("a_hv at {station}"), "force": to_say("force at {station}")}
WORST = {"RMS over the band": to_say("RMS over the band"), "largest": to_say("largest")}
"""Parts of the names of figures, in words."""
ALLOWED = {"lowest": to_say("lowest allowed"), "highest": to_say("highest allowed")}


def design_figure(found: ToolDesign) -> Figure:
    """Weighted acceleration of each hand, before and after.

    The worst hand over the band is made better; at some speeds another one may be worse.
    """
    told = changes_told(found)
    columns = _columns(told)
    before, after = (_curves(tool, found) for tool in (found.tool, found.better))
    keys = _keys()
    words = STEP * -(-len(told) // columns)
    rows = rows_of(after[: len(KINDS) + 1]) + rows_of(keys)
    above = TOP + words + LINE * rows + 0.06
    figure = blank(WIDTH, above + TALL + FOOT)
    heading(figure, found.tool.title, _measure_told(found), LEFT)
    _words(figure, told, columns)
    axes = place(figure, LEFT, FOOT, WIDTH - LEFT - RIGHT, TALL)
    engine_axis(axes, found.speed)
    name_y(axes, "a_hv, m/s²")
    name_x(figure, say(SPEED))
    handles = _draw(axes, found, before, after)
    legend_at(figure, handles, TOP + words)
    legend_at(figure, keys, TOP + words + LINE * rows_of(handles))
    return figure


def figure_named(name: str) -> str:
    """A figure of a design, as `handheld.design` calls it, in words."""
    at = AT.fullmatch(name)
    if at is None:
        return say(name) if name in FIGURES else name
    return f"{say(AT_STATION[at[1]], station=at[2])}, {say(WORST[at[3]])}"


def _measure_told(found: ToolDesign) -> str:
    """What was made small, in words; the first figures are the measures, in their order."""
    design = found.tool.design
    one = found.figures[MEASURES.index("rms" if design is None else design.measure)]
    return f"{figure_named(one.name)}: {shown(one.before)} → {shown(one.after)} m/s²"


def _curves(tool: Tool, found: ToolDesign) -> list[Curve]:
    """a_hv of the hands that count; of all tools in the order of the tool before."""
    design = found.tool.design
    hands = design.hands if design is not None and design.hands else ()
    felt = grips(respond_tool(tool, found.speed))
    return [Curve(name, grip.a_hv) for name, grip in felt.items() if not hands or name in hands]


def _keys() -> list[Line2D]:
    return [
        Line2D([], [], color=INK, linestyle=DASHED, linewidth=1.2, label=say("before")),
        Line2D([], [], color=INK, linewidth=1.5, label=say("after")),
    ]


def _draw(
    axes: Axes, found: ToolDesign, before: Sequence[Curve], after: Sequence[Curve]
) -> list[Line2D]:
    """All curves; what tells the hands apart."""
    curve_limits(axes, [*before, *after], (1.8, 2.2))
    work = work_line(axes, found.tool)
    colors = [color for color, _ in KINDS]
    for number, curve in enumerate(before):
        color = colors[number] if number < len(colors) else FAINT
        values = np.where(curve.values > 0, curve.values, np.nan)
        axes.plot(found.speed * RPM, values, color=color, linestyle=DASHED, linewidth=1.2)
    handles = draw_curves(axes, Speeds(found.speed), after)
    labels = Labels(axes)
    avoid_curves(labels, found.speed, [*before, *after])
    tell_peaks(labels, found.better, found.speed, list(zip(after, colors, strict=False)))
    name_work(axes, labels, work, above=False)
    return handles


def changes_told(found: ToolDesign) -> list[str]:
    """What was changed, each in words; where they are many, the first of them."""
    count = len(found.variables)
    words = []
    for one, edge in zip(found.variables, found.edges, strict=True):
        unit, factor = UNITS[one.dimension]
        ends = f"{shown(factor * one.before)} → {shown(factor * one.after)} {unit}"
        end = f" ({say(ALLOWED[edge])})" if edge else ""
        words.append(f"{short(one.name.replace('_', ' '), 40)}: {ends}{end}")
    return (
        words
        if count <= MOST
        else [*words[: MOST - 1], say("and {count} more", count=count - MOST + 1)]
    )


def _columns(told: Sequence[str]) -> int:
    """How many of these words stand beside each other."""
    scratch = blank(WIDTH, 1.0)
    return 2 if all(inches(scratch.text(0, 0, words))[0] <= COLUMN - 0.12 for words in told) else 1


def _words(figure: Figure, told: Sequence[str], columns: int) -> None:
    height = figure.get_figheight()
    for number, words in enumerate(told):
        down, across = divmod(number, columns)
        at = ((LEFT + across * COLUMN) / WIDTH, 1 - (TOP - 0.07 + STEP * down) / height)
        fit(figure.text(*at, words, va="top"), WIDTH - LEFT - RIGHT)
