"""Shaking force and moment, and the drive's torque, over crank angle."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from equipoise.i18n import say
from equipoise.plotting.analysis.looks import (
    ALL,
    LINE_LOOKS,
    ROW_LOOKS,
    about,
    angle_axis,
    each,
    has_rows,
    line,
    name_angles,
    row_keys,
    title,
    unit_of,
)
from equipoise.plotting.crank import draw, mark
from equipoise.plotting.hodograph import nothing_there
from equipoise.plotting.style import LINES, SMALL, short, shown, styled
from equipoise.plotting.vibration.panels import legend, name_panel, name_y, stack
from equipoise.results.naming import CAUSES

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

ROW, ONE_HIGH = 1.45, 2.4
"""Inches: height of one of several panels, and of a single one."""
KEYS = 0.16
"""Inches above the panels for the legend."""
MEAN = (0, (5, 2))
"""Dashes of the mean."""
NOTHING = 1e-9
"""Over the largest value: what is less is rounding."""


@styled()
def force_figure(analysis: Analysis) -> Figure:
    """Both components of the shaking force and its size over crank angle."""
    force = each(analysis, "shaking_force")
    what = title(analysis, say("Shaking force"))
    figure, panels = stack(3, ROW, analysis.machine.title, what, _room(analysis))
    unit = unit_of("force", np.concatenate([*force.values()]))
    parts: dict[str, Callable[[Array], Array]] = {
        say("along x, {unit}", unit=unit.name): np.real,
        say("along y, {unit}", unit=unit.name): np.imag,
        say("size, {unit}", unit=unit.name): np.abs,
    }
    for axes, (label, part) in zip(panels, parts.items(), strict=True):
        _signals(axes, analysis, {name: unit.factor * part(z) for name, z in force.items()})
        name_y(axes, label)
    return _finish(figure, analysis)


@styled()
def moment_figure(analysis: Analysis) -> Figure:
    """Shaking moment over crank angle."""
    moment = each(analysis, "shaking_moment")
    what = title(analysis, say("Shaking moment about {point}", point=about(analysis)))
    figure, panels = stack(1, ONE_HIGH, analysis.machine.title, what, _room(analysis))
    unit = unit_of("force", np.concatenate([*moment.values()]), rotation=True)
    _signals(panels[0], analysis, {name: unit.factor * m for name, m in moment.items()}, True)
    name_y(panels[0], say("shaking moment, {unit}", unit=unit.name))
    return _finish(figure, analysis)


@styled()
def torque_figure(analysis: Analysis) -> Figure:
    """Torque of the drive over crank angle, and below it what makes it."""
    torque = each(analysis, "drive_torque")
    drive = short(analysis.machine.drive.link, 16)
    what = title(analysis, say("Torque of the drive on {link}", link=drive))
    figure, panels = stack(2, 1.75, analysis.machine.title, what, KEYS)
    unit = unit_of("force", np.concatenate([*torque.values()]), rotation=True)
    scaled = {name: unit.factor * values for name, values in torque.items()}
    _signals(panels[0], analysis, scaled, True)
    name_y(panels[0], say("drive torque, {unit}", unit=unit.name))
    if analysis.motion.whole_cycle:
        _mean(panels[0], scaled[ALL], unit.name)
    _causes(panels[1], analysis)
    if has_rows(analysis):
        legend(figure, row_keys(analysis))
    name_angles(figure, analysis)
    return figure


def _room(analysis: Analysis) -> float:
    """Inches for a legend."""
    return KEYS if has_rows(analysis) else 0.0


def _signals(
    axes: Axes, analysis: Analysis, values: dict[str, Array], told_angles: bool = False
) -> None:
    """A signal of one row, and of all together, with its extremes."""
    lines = [
        line(analysis, one, name, color=ROW_LOOKS[name]["color"]) for name, one in values.items()
    ]
    angle_axis(axes, analysis)
    draw(axes, lines)
    for drawn, name in zip(axes.get_lines(), values, strict=False):
        drawn.set(**ROW_LOOKS[name])
    mark(axes, lines, [], told_angles)
    if not any(np.any(one) for one in values.values()):
        nothing_there(axes, say("zero at every crank angle"))


def _mean(axes: Axes, values: Array, unit: str) -> None:
    """A dashed line at the mean, and its value above the axes."""
    mean = float(np.mean(values))
    if abs(mean) <= NOTHING * float(np.max(np.abs(values))):
        mean = 0.0
    axes.axhline(mean, color=LINES, linewidth=0.9, linestyle=MEAN, zorder=2)
    rms = float(np.sqrt(np.mean(np.square(values))))
    told = {"mean": shown(mean), "rms": shown(rms), "unit": unit}
    text = say("dashed: mean {mean} {unit}; RMS {rms} {unit}", **told)
    axes.set_title(text, fontsize=SMALL, loc="right", pad=3, color=LINES)


def _causes(axes: Axes, analysis: Analysis) -> None:
    """The torque of each cause that there is; of one row."""
    parts = analysis.forces.split.by_cause("drive_torque")
    largest = max(float(np.max(np.abs(part))) for part in parts.values())
    there = {name: part for name, part in parts.items() if np.max(np.abs(part)) > NOTHING * largest}
    unit = unit_of("force", np.concatenate([*parts.values()]), rotation=True)
    lines, keys = [], []
    for (name, part), (color, dashes) in zip(
        ((name, there[name]) for name in CAUSES if name in there),
        (LINE_LOOKS[k] for k, name in enumerate(CAUSES) if name in there),
        strict=True,
    ):
        look: Any = {"color": color, "dashes": dashes}
        lines.append(line(analysis, unit.factor * part, told="", **look))
        keys.append(Line2D([], [], color=color, linestyle=dashes, label=say(CAUSES[name])))
    angle_axis(axes, analysis)
    draw(axes, lines or [line(analysis, 0 * analysis.crank_angle)])
    name_y(axes, say("by cause, {unit}", unit=unit.name))
    if has_rows(analysis):
        name_panel(axes, say("of one row"))
    if keys:
        axes.legend(
            handles=keys,
            loc="lower right",
            bbox_to_anchor=(1.0, 1.0),
            ncols=len(keys),
            borderaxespad=0.2,
            columnspacing=1.2,
            handlelength=2.4,
            fontsize=SMALL,
        )


def _finish(figure: Figure, analysis: Analysis) -> Figure:
    """Name the x axis, and say which line is which."""
    name_angles(figure, analysis)
    if has_rows(analysis):
        legend(figure, row_keys(analysis))
    return figure
