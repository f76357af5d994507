"""The end of the shaking force's arrow over a cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from equipoise.figures.drawing import arrow, hold
from equipoise.figures.labels import Labels
from equipoise.i18n import say
from equipoise.plotting.analysis.looks import (
    ALL,
    ROW_LOOKS,
    each,
    has_rows,
    over,
    rings,
    row_keys,
    title,
    unit_of,
)
from equipoise.plotting.hodograph import nothing_there, numbers, origin, told_angles
from equipoise.plotting.style import (
    LINES,
    PALE,
    STRESS,
    blank,
    degrees_shown,
    heading,
    shown,
    styled,
)
from equipoise.plotting.vibration.panels import LEFT, RIGHT, WIDTH, legend, place

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

HIGHEST, LOWEST, TOP, BOTTOM = 4.8, 3.0, 0.66, 0.5
"""Inches: height of the axes at most and at least, and what is above and below them."""
KEYS = 0.16
"""Inches above the axes for the legend."""
ALIKE = 1e-6
"""Over the peak: a force whose size varies by less has none."""
MEAN = (0, (5, 2))
"""Dashes of the circle of the mean size."""


@styled()
def polar_figure(analysis: Analysis) -> Figure:
    """Shaking force as a polar diagram, with crank angles along it, its peak and mean size."""
    force = each(analysis, "shaking_force")
    unit = unit_of("force", np.concatenate([*force.values()]))
    ends = {name: unit.factor * values for name, values in force.items()}
    top = TOP + (KEYS if has_rows(analysis) else 0.0)
    mean = np.mean(np.abs(ends[ALL])) * np.array([0, 1, 1j, -1, -1j])
    held = np.concatenate([*ends.values(), mean])
    panel = hold(held, WIDTH - LEFT - RIGHT, HIGHEST, LOWEST)
    figure = blank(WIDTH, panel.height + top + BOTTOM)
    what = title(analysis, say("Shaking force"), say("numbers: crank angle, deg"))
    heading(figure, analysis.machine.title, what, LEFT)
    axes = place(figure, LEFT, BOTTOM, panel.width, panel.height)
    panel.settle(axes)
    axes.set_xlabel(say("shaking force along x, {unit}", unit=unit.name))
    axes.set_ylabel(say("shaking force along y, {unit}", unit=unit.name))
    labels = draw_polar(axes, analysis, ends)
    _told(axes, labels, analysis, ends[ALL], unit.name)
    if analysis.motion.whole_cycle:
        told = told_angles(analysis.crank_angle)
        for name, values in reversed(ends.items()):
            numbers(axes, labels, told, values, ROW_LOOKS[name]["color"])
    if has_rows(analysis):
        legend(figure, row_keys(analysis))
    return figure


def draw_polar(
    axes: Axes, analysis: Analysis, ends: dict[str, Array], thinner: float = 1.0
) -> Labels:
    """Curves over circles of equal size, in axes whose limits are settled."""
    axes.grid(visible=False)
    origin(axes)
    corners = np.array([complex(x, y) for x in axes.get_xlim() for y in axes.get_ylim()])
    step, count = rings(float(np.max(np.abs(corners))))
    for k in range(1, count + 1):
        axes.add_patch(Circle((0, 0), k * step, fill=False, ec=PALE, lw=0.6, zorder=0.5))
    labels = Labels(axes)
    for name, values in ends.items():
        line = over(analysis, values)[1]
        look = ROW_LOOKS[name]
        width = thinner * look["linewidth"]
        axes.plot(line.real, line.imag, label=name, **{**look, "linewidth": width})
        labels.avoid(line.real, line.imag)
    return labels


def _told(axes: Axes, labels: Labels, analysis: Analysis, values: Array, unit: str) -> None:
    """An arrow to the peak, and a circle of the mean size, with their values."""
    sizes = np.abs(values)
    k = int(np.argmax(sizes))
    if not sizes[k]:
        nothing_there(axes, say("zero at every crank angle"))
        return
    mean, peak = float(np.mean(sizes)), complex(values[k])
    circle = mean * np.exp(1j * np.radians(np.arange(361)))
    axes.plot(circle.real, circle.imag, color=LINES, linewidth=0.9, linestyle=MEAN, zorder=2)
    labels.avoid(circle.real, circle.imag, weight=0.6)
    if np.ptp(sizes) > ALIKE * sizes[k]:
        arrow(axes, 0j, peak, color=STRESS, lw=1.2, mutation_scale=11, zorder=3.5)
        labels.avoid([0, peak.real], [0, peak.imag])
        labels.reserve(peak.real, peak.imag)
        at = degrees_shown(float(analysis.crank_angle[k]))
        text = say("peak {value} {unit} at {angle}", value=shown(abs(peak)), unit=unit, angle=at)
        wish = float(np.degrees(np.angle(peak)))
        labels.put(text, peak.real, peak.imag, wish=wish, color=STRESS)
    away = mean * complex(np.exp(1j * (np.angle(peak) + 2.4)))
    text = say("mean size {value} {unit}", value=shown(mean), unit=unit)
    wish = float(np.degrees(np.angle(away)))
    labels.put(text, away.real, away.imag, wish=wish, color=LINES)
