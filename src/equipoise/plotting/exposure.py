"""The pictures of hand-arm vibration: its spectrum, and a day's exposure against hours of work."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor, log10
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from equipoise.exposure.daily import ACTION, LIMIT, partial_exposure
from equipoise.exposure.weighting import EDGES, factor
from equipoise.figures.labels import Labels
from equipoise.plotting.style import (
    FAINT,
    INK,
    LINES,
    MAIN,
    PALE,
    STRESS,
    blank,
    free_name,
    heading,
    short,
    shown,
    styled,
)

if TYPE_CHECKING:
    from equipoise.exposure.daily import Exposure
    from equipoise.exposure.weighting import Weighted

Array = np.ndarray[Any, Any]

WIDTH, HEIGHT = 7.2, 4.4
LEFT, RIGHT, BOTTOM, TOP = 0.78, 0.2, 0.52, 0.72
"""Inches: margins of both pictures."""
CURVE, GAP = 0.85, 0.16
"""Inches: height of the panel of Wh below the spectrum, and the room between them."""
TOLD = (8.0, 16.0, 31.5, 63.0, 125.0, 250.0, 500.0, 1000.0)
"""Hz: bands that are named below the picture."""
DEEPEST = 1e-4
"""Of the highest band: what is lower is not drawn."""
SHORTEST, LONGEST = 1 / 12, 24.0
"""Ends of the hours of work; where a task takes less, half of that."""
TICKS = {1 / 720: "5 s", 1 / 60: "1 min", 1 / 12: "5 min", 0.25: "15 min", 0.5: "30 min"} | {
    float(hours): f"{hours} h" for hours in (1, 2, 4, 8, 16)
}
FINE = 150.0
"""Ratio of the ends of an axis, up to which 2 and 5 are told beside 1 and 10."""
MOST_NAMES = 8
"""Tasks that are drawn with their names."""


def drawings(
    measured: Sequence[tuple[str, Weighted]],
    tools: Sequence[tuple[str, float]],
    day: Exposure | None,
) -> dict[str, Figure]:
    """``spectrum`` of every input that has one, and ``exposure``, names that also do for files.

    tools : names and total values, m/s2.
    """
    figures: dict[str, Figure] = {}
    with styled():
        for name, weighted in measured:
            figures[free_name("spectrum", figures)] = spectrum_figure(weighted, name)
        figures["exposure"] = exposure_figure(tools, day)
    return figures


def spectrum_figure(weighted: Weighted, title: str) -> Figure:
    """One-third-octave spectra of all axes together, before and after weighting, and Wh."""
    figure = blank(WIDTH, HEIGHT)
    heading(figure, title, "One-third-octave bands, all axes together", LEFT)
    axes = _axes(figure, BOTTOM + CURVE + GAP, TOP)
    curve = _axes(figure, BOTTOM, HEIGHT - BOTTOM - CURVE)
    after = np.sqrt(np.sum(weighted.band_a_hw**2, axis=0))
    before = after if weighted.band_a_h is None else np.sqrt(np.sum(weighted.band_a_h**2, axis=0))
    top = float(np.max(before)) or 1.0
    low = max(DEEPEST * top, 0.5 * float(np.min(after[after > 0], initial=top)))
    if weighted.band_a_h is not None:
        _stairs(axes, before, low, FAINT, f"RMS, {shown(_root(weighted.a_h))} m/s²")
    _stairs(axes, after, low, MAIN, f"weighted, a_hv = {shown(weighted.a_hv)} m/s²")
    _levels(axes, low, 1.6 * top)
    axes.set_ylabel("RMS, m/s²")
    axes.tick_params(labelbottom=False)
    _legend(figure)
    smooth = np.geomspace(EDGES[0], EDGES[-1], 400)
    curve.plot(smooth, factor(smooth), color=INK, linewidth=1.2)
    _levels(curve, 0.005, 1.5)
    curve.set_ylabel("Wh")
    curve.set_xlabel("frequency, Hz")
    for part in (axes, curve):
        _frequencies(part)
    return figure


def exposure_figure(tools: Sequence[tuple[str, float]], day: Exposure | None) -> Figure:
    """A(8) against hours of work, of every task and of the day, with action and limit value."""
    figure = blank(WIDTH, HEIGHT)
    title = "Daily vibration exposure" if day is None else f"A(8) = {shown(day.a8)} m/s²"
    heading(figure, title, "Exposure A(8) against hours of work a day, Directive 2002/44/EC", LEFT)
    axes = _axes(figure, BOTTOM, TOP)
    axes.set_xscale("log")
    _limits(axes, tools, day)
    lines = [(name, a_hv) for name, a_hv in tools if a_hv > 0]
    ends = np.array(axes.get_xlim())
    for _, a_hv in lines:
        axes.plot(ends, _a8(a_hv, ends), color=MAIN, linewidth=1.1, zorder=3)
    labels = Labels(axes)
    for _, a_hv in lines:
        labels.avoid(ends, _a8(a_hv, ends))
    if day is not None and len(day.tasks) > 1 and day.a8 > 0:
        axes.plot(ends, _a8(day.a_hv, ends), color=STRESS, linewidth=1.6, zorder=4)
        labels.avoid(ends, _a8(day.a_hv, ends))
    _values(axes, labels)
    _points(axes, labels, lines, day)
    return figure


def _limits(axes: Axes, tools: Sequence[tuple[str, float]], day: Exposure | None) -> None:
    """Scales with their ticks."""
    marked = [partial_exposure(a_hv, 8 * 3600) for _, a_hv in tools if a_hv > 0]
    if day is not None:
        marked = [task.partial for task in day.tasks if task.partial > 0] or marked
        marked += [day.a8] * (day.a8 > 0)
    low = min([1.0, *(0.5 * value for value in marked)])
    high = max([10.0, *(2 * value for value in marked)])
    times = [] if day is None else [task.duration / 3600 for task in day.tasks]
    axes.set_xlim(min([SHORTEST, *(0.5 * hours for hours in times)]), LONGEST)
    _levels(axes, low, high)
    axes.xaxis.set_major_locator(FixedLocator([x for x in TICKS if x >= axes.get_xlim()[0]]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: TICKS.get(x, "")))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("work a day")
    axes.set_ylabel("A(8), m/s²")


def _values(axes: Axes, labels: Labels) -> None:
    """Action and limit value."""
    top = axes.get_ylim()[1]
    axes.axhspan(LIMIT, top, color=PALE, alpha=0.55, linewidth=0, zorder=0)
    ends = np.array(axes.get_xlim())
    for value, line in ((ACTION, "dashed"), (LIMIT, "solid")):
        axes.axhline(value, color=LINES, linewidth=1.0, linestyle=line, zorder=2)
        labels.avoid(ends, np.full(2, value))
    for value, name in ((ACTION, "action value"), (LIMIT, "limit value")):
        labels.put(f"{name} {value:g} m/s²", ends[0], value, wish=90.0, near=3.0, color=LINES)


def _points(
    axes: Axes, labels: Labels, lines: Sequence[tuple[str, float]], day: Exposure | None
) -> None:
    """Tasks where they stand, and the day; without times, each tool beside its line."""
    if day is None:
        low = axes.get_ylim()[0]
        for name, a_hv in lines[:MOST_NAMES]:
            hours = float(np.clip(8 * low * ACTION / a_hv**2, SHORTEST * 1.5, LONGEST / 1.5))
            labels.put(short(name), hours, float(_a8(a_hv, hours)), wish=-45.0, color=MAIN)
        return
    marked = [task for task in day.tasks if task.acceleration > 0]
    for task in marked:
        axes.plot(
            task.duration / 3600,
            task.partial,
            "o",
            color=MAIN,
            markerfacecolor="white",
            markersize=5,
            zorder=5,
        )
        labels.reserve(task.duration / 3600, task.partial)
    if len(day.tasks) > 1 and day.a8 > 0:
        axes.plot(day.duration / 3600, day.a8, "D", color=STRESS, markersize=5, zorder=6)
        labels.reserve(day.duration / 3600, day.a8)
        labels.put("all of them", day.duration / 3600, day.a8, wish=90.0, color=STRESS)
    for task in marked[:MOST_NAMES]:
        labels.put(short(task.name), task.duration / 3600, task.partial, wish=-45.0, color=MAIN)


def _a8(a_hv: float, hours: Any) -> Any:
    """A(8), m/s2, of a total value that acts for some hours."""
    return partial_exposure(a_hv, 3600.0) * np.sqrt(hours)


def _root(values: Array | None) -> float:
    return 0.0 if values is None else float(np.sqrt(np.sum(values**2)))


def _stairs(axes: Axes, values: Array, low: float, color: str, label: str) -> None:
    drawn = np.maximum(values, low)
    axes.stairs(drawn, EDGES, baseline=low, fill=True, color=color, alpha=0.5, label=label)
    axes.stairs(drawn, EDGES, baseline=low, color=color, linewidth=1.0)


def _frequencies(axes: Axes) -> None:
    axes.set_xscale("log")
    axes.set_xlim(EDGES[0], EDGES[-1])
    exact = [float(10 ** (0.1 * round(10 * np.log10(value)))) for value in TOLD]
    axes.xaxis.set_major_locator(FixedLocator(exact))
    names = dict(zip(exact, TOLD, strict=True))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{names.get(x, x):g}"))
    axes.xaxis.set_minor_locator(NullLocator())


def _levels(axes: Axes, low: float, high: float) -> None:
    """A logarithmic axis upwards, with plain numbers."""
    axes.set_yscale("log")
    axes.set_ylim(low, high)
    marks = (1.0, 2.0, 5.0) if high < FINE * low else (1.0,)
    powers = range(floor(log10(low)), ceil(log10(high)) + 1)
    ticks = [mark * 10.0**power for power in powers for mark in marks]
    axes.yaxis.set_major_locator(FixedLocator([tick for tick in ticks if low <= tick <= high]))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
    axes.yaxis.set_minor_locator(NullLocator())


def _legend(figure: Figure) -> None:
    figure.legend(
        loc="upper right",
        bbox_to_anchor=(1 - RIGHT / WIDTH, 1 - 0.44 / HEIGHT),
        ncols=2,
        borderaxespad=0,
        borderpad=0,
    )


def _axes(figure: Figure, bottom: float, top: float) -> Axes:
    """Axes between margins, inches, below and above."""
    box = (
        LEFT / WIDTH,
        bottom / HEIGHT,
        1 - (LEFT + RIGHT) / WIDTH,
        1 - (bottom + top) / HEIGHT,
    )
    return figure.add_axes(box)
