"""The pictures of a free decay: the record with its fit, and the line of half-swings."""

from __future__ import annotations

from itertools import pairwise
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from equipoise.figures.labels import Labels
from equipoise.plotting.style import FAINT, INK, LINES, MAIN, STRESS, blank, heading, shown, styled

if TYPE_CHECKING:
    from equipoise.measured.decay import Decay

Array = np.ndarray[Any, Any]

WIDTH, HEIGHT = 7.2, 3.6
SQUARE = 4.4
"""Inches: width of the picture of half-swings, whose axes are a square."""
LEFT, RIGHT, BOTTOM, TOP = 0.78, 0.2, 0.52, 0.72
"""Inches: margins of both pictures."""
UNITS = {"length": ("mm", 1e3), "angle": ("deg", 180 / pi)}
MOST_DRAWN, PER_HALF_SWING = 4000, 60
"""Samples; points of the fitted curve in a half-swing."""
BEYOND = 1.5
"""Half-swings shown before the first and after the last turning point."""


def drawings(decay: Decay, title: str) -> dict[str, Figure]:
    """``record`` and ``swings``, names that also do for files."""
    with styled():
        return {"record": record_figure(decay, title), "swings": swings_figure(decay, title)}


def record_figure(decay: Decay, title: str) -> Figure:
    """The samples, the motion fitted to them, and the turning points."""
    unit, scale = UNITS[decay.kind]
    turns = decay.turns
    half = float(np.median(np.diff(turns.time)))
    low = max(decay.record.time[0], turns.time[0] - BEYOND * half)
    high = min(decay.record.time[-1], turns.time[-1] + BEYOND * half)
    figure, axes = _axes(WIDTH, HEIGHT)
    heading(figure, title, "Record, motion fitted to all of it, turning points", LEFT)
    time, values = _samples(decay, low, high)
    axes.plot(
        time,
        scale * values,
        ".",
        color=FAINT,
        markersize=3.2,
        label="samples",
        zorder=2,
        markeredgewidth=0,
    )
    count = min(int(PER_HALF_SWING * (high - low) / half) + 2, 20_000)
    smooth = np.linspace(turns.time[0], turns.time[-1], count)
    fit = scale * decay.fitted(smooth)
    axes.plot(smooth, fit, color=MAIN, linewidth=0.9, label="fit", zorder=3)
    axes.plot(
        turns.time,
        scale * turns.displacement,
        "o",
        color=STRESS,
        markersize=4,
        markerfacecolor="white",
        label="turning points",
        zorder=4,
        clip_on=False,
    )
    axes.axhline(scale * decay.whole.motion.center, color=LINES, linewidth=0.7, zorder=1)
    axes.set_xlim(low, high)
    axes.set_xlabel("time, s")
    axes.set_ylabel(f"{'displacement' if decay.kind == 'length' else 'angle'}, {unit}")
    figure.legend(
        loc="upper right",
        bbox_to_anchor=(1 - RIGHT / WIDTH, 1 - 0.44 / HEIGHT),
        ncols=3,
        borderaxespad=0,
        borderpad=0,
        markerscale=1.6,
    )
    return figure


def swings_figure(decay: Decay, title: str) -> Figure:
    """Each half-swing against the one before it, with the line."""
    unit, scale = UNITS[decay.kind]
    heights = scale * decay.turns.heights
    slope, cut = decay.line["slope"].value, scale * decay.line["intercept"].value
    figure, axes = _axes(SQUARE, SQUARE + BOTTOM + TOP - LEFT - RIGHT)
    heading(figure, title, "Each half-swing against the one before it", LEFT)
    most = 1.08 * float(np.max(heights))
    reach = np.array([0.0, most])
    axes.plot(reach, reach, color=LINES, linewidth=0.8, linestyle=(0, (4, 2)), zorder=1)
    axes.plot(reach, slope * reach + cut, color=MAIN, linewidth=1.2, zorder=2)
    axes.plot(
        heights[:-1],
        heights[1:],
        "o",
        color=STRESS,
        markersize=4,
        markerfacecolor="white",
        zorder=3,
    )
    axes.set_xlim(0, most)
    axes.set_ylim(0, most)
    axes.set_xlabel(f"height of a half-swing, {unit}")
    axes.set_ylabel(f"height of the next, {unit}")
    _told(axes, slope, cut, unit, heights, most)
    return figure


def _told(axes: Axes, slope: float, cut: float, unit: str, heights: Array, most: float) -> None:
    """What the line and the dashes are."""
    labels = Labels(axes)
    reach = np.array([0.0, most])
    labels.avoid(reach, reach)
    labels.avoid(reach, slope * reach + cut)
    for before, after in pairwise(heights):
        labels.reserve(float(before), float(after))
    at = 0.3 * most
    sign = "\N{MINUS SIGN}" if cut < 0 else "+"
    told = f"next = {shown(slope)} height {sign} {shown(abs(cut))} {unit}"
    labels.put(told, at, slope * at + cut, wish=-45.0, color=MAIN)
    labels.put("no decay", 0.6 * most, 0.6 * most, wish=135.0, color=INK)


def _samples(decay: Decay, low: float, high: float) -> tuple[Array, Array]:
    """Samples between two times, thinned where there are too many to be seen."""
    record = decay.record
    part = slice(np.searchsorted(record.time, low), np.searchsorted(record.time, high, "right"))
    time, values = record.time[part], record.displacement[part]
    step = -(-len(time) // MOST_DRAWN)
    return time[::step], values[::step]


def _axes(width: float, height: float) -> tuple[Figure, Axes]:
    figure = blank(width, height)
    box = (
        LEFT / width,
        BOTTOM / height,
        1 - (LEFT + RIGHT) / width,
        1 - (BOTTOM + TOP) / height,
    )
    return figure, figure.add_axes(box)
