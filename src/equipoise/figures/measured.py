"""Charts of what is measured: hand-arm vibration with a day's exposure, and free decay."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.exposure.blocks import VERDICTS
from equipoise.exposure.daily import ACTION, LIMIT, partial_exposure, verdict_of
from equipoise.exposure.weighting import EDGES, factor
from equipoise.figures.chart_parts import by_name, ends
from equipoise.figures.style import free_name, short
from equipoise.i18n import decimals, say
from equipoise.quantities import Display
from equipoise.results.charts import Axis, Band, Chart, Curve, Line, Mark, Panel, four_digits
from equipoise.signals import Array

if TYPE_CHECKING:
    from equipoise.exposure.daily import Exposure
    from equipoise.exposure.weighting import Weighted
    from equipoise.measured.decay import Decay


RATE = Display("m/s^2", 1.0)
LABELLED_BANDS = (8.0, 16.0, 31.5, 63.0, 125.0, 250.0, 500.0, 1000.0)
"""Hz: bands that are named below the picture."""
DEEPEST = 1e-4
"""Of the highest band: what is lower is not drawn."""
SHORTEST, LONGEST = 1 / 12, 24.0
"""Ends of the hours of work; where a task takes less, half of that."""
TIMES = {1 / 720: "5 s", 1 / 60: "1 min", 1 / 12: "5 min", 0.25: "15 min", 0.5: "30 min"} | {
    float(hours): f"{hours} h" for hours in (1, 2, 4, 8, 16)
}
JUDGED = {"above the action value": "warned", "above the limit value": "broken"}
"""Roles of what is not below both values, by its verdict."""
MOST_NAMES = 8
"""Tasks that are drawn with their names."""


def exposure_charts(
    measured: Sequence[tuple[str, Weighted]],
    tools: Sequence[tuple[str, float]],
    day: Exposure | None,
) -> dict[str, Chart]:
    """``spectrum`` of every input that has one, and ``exposure``, names that also do for files.

    tools : names and total values, m/s2.
    """
    charts: dict[str, Chart] = {}
    for name, weighted in measured:
        own = free_name("spectrum", charts)
        charts[own] = spectrum(weighted, name).named(own)
    charts["exposure"] = exposure(tools, day)
    return charts


def spectrum(weighted: Weighted, title: str) -> Chart:
    """One-third-octave spectra of all axes together, before and after weighting, and Wh."""
    after = np.sqrt(np.sum(weighted.band_a_hw**2, axis=0))
    before = after if weighted.band_a_h is None else np.sqrt(np.sum(weighted.band_a_h**2, axis=0))
    top = float(np.max(before)) or 1.0
    low = max(DEEPEST * top, 0.5 * float(np.min(after[after > 0], initial=top)))
    curves = []
    if weighted.band_a_h is not None:
        label = say("RMS, {value} m/s²", value=four_digits(_root(weighted.a_h)))
        curves.append(_stairs(before, low, "unweighted", label))
    label = say("weighted, total value aₕᵥ = {value} m/s²", value=four_digits(weighted.a_hv))
    curves.append(_stairs(after, low, "weighted", label))
    ticks = tuple(
        (float(10 ** (0.1 * round(10 * np.log10(item)))), decimals(f"{item:g}"))
        for item in LABELLED_BANDS
    )
    first, last = float(EDGES[0]), float(EDGES[-1])
    x = Axis(say("frequency"), Display("Hz", 1.0), "log", first, last, ticks=ticks)
    y = Axis(say("RMS"), RATE, "log", low, 1.6 * top)
    smooth = np.geomspace(first, last, 400)
    wh, weights = Axis("Wh", scale="log", low=0.005, high=1.5), factor(smooth)
    panels = (
        Panel(x, y, tuple(curves), height=200.0),
        Panel(x, wh, (Curve(smooth, weights, "", "ink"),), height=62.0),
    )
    return Chart("spectrum", title, say("One-third-octave bands, all axes together"), panels)


def _stairs(values: Array, low: float, role: str, label: str) -> Curve:
    """Bands as a line of steps: an area would have to stand on a 0 that its axis does not have."""
    x, high = np.repeat(EDGES, 2)[1:-1], np.repeat(np.maximum(values, low), 2)
    return Curve(x, high, label, role)


def exposure(tools: Sequence[tuple[str, float]], day: Exposure | None) -> Chart:
    """A(8) against hours of work, of every task and of the day, with action and limit value."""
    lines = [(name, a_hv) for name, a_hv in tools if a_hv > 0]
    x, y = _axes(lines, day)
    reach, (least, most) = np.array(ends(x)), ends(y)
    curves = [Curve(reach, _a8(a_hv, reach), "", "thin") for _, a_hv in lines]
    marks = []
    for value, name in ((ACTION, say("action value")), (LIMIT, say("limit value"))):
        text = f"{name} {decimals(f'{value:g}')} m/s²"
        marks.append(Mark(float(reach[0]), value, text, "lines", 60.0, sign=False, distance=3.0))
    if day is None:
        for name, a_hv in lines[:MOST_NAMES]:
            hours = float(np.clip(8 * least * ACTION / a_hv**2, SHORTEST * 1.5, LONGEST / 1.5))
            at = float(_a8(a_hv, hours))
            marks.append(Mark(hours, at, short(name), "main", -45.0, sign=False))
    else:
        if len(day.tasks) > 1 and day.a8 > 0:
            curves.append(Curve(reach, _a8(day.a_hv, reach), "", "strong"))
            marks.append(_judged(day.duration, day.a8, say("all of them"), "day", 90.0))
        tasks = [task for task in day.tasks if task.acceleration > 0]
        for number, task in enumerate(tasks):
            text = short(task.name) if number < MOST_NAMES else ""
            marks.append(_judged(task.duration, task.partial, text, "task", -45.0))
    levels = (Line(ACTION, "action value", axis="y"), Line(LIMIT, "limit value", axis="y"))
    panel = Panel(
        x,
        y,
        tuple(curves),
        tuple(marks),
        (Band(LIMIT, most, "forbidden", axis="y"),),
        levels,
        height=250.0,
    )
    title = say("Daily vibration exposure")
    if day is not None:
        title = say("A(8) = {value} m/s²", value=four_digits(day.a8))
    what = say("Exposure A(8) against hours of work a day, Directive 2002/44/EC")
    return Chart("exposure", title, what, (panel,))


def _judged(time: float, a8: float, text: str, role: str, wish: float) -> Mark:
    """Mark of A(8), m/s2, at a time of work, s; the legend names its sign beyond a limit."""
    verdict = verdict_of(a8)
    label = say(VERDICTS[verdict]) if verdict in JUDGED else ""
    return Mark(time / 3600, a8, text, JUDGED.get(verdict, role), wish, label=label)


def _axes(lines: Sequence[tuple[str, float]], day: Exposure | None) -> tuple[Axis, Axis]:
    """Hours of work, and A(8)."""
    marked = [partial_exposure(a_hv, 8 * 3600) for _, a_hv in lines]
    if day is not None:
        marked = [task.partial for task in day.tasks if task.partial > 0] or marked
        marked += [day.a8] * (day.a8 > 0)
    low = min([1.0, *(0.5 * value for value in marked)])
    high = max([10.0, *(2 * value for value in marked)])
    times = [] if day is None else [task.duration / 3600 for task in day.tasks]
    first = min([SHORTEST, *(0.5 * hours for hours in times)])
    ticks = tuple(TIMES.items())
    x = Axis(say("work a day"), scale="log", low=first, high=LONGEST, ticks=ticks)
    return x, Axis("A(8)", RATE, "log", low, high)


def _a8(a_hv: float, hours: Any) -> Any:
    """A(8), m/s2, of a total value that acts for some hours."""
    return partial_exposure(a_hv, 3600.0) * np.sqrt(hours)


def _root(values: Array | None) -> float:
    return 0.0 if values is None else float(np.sqrt(np.sum(values**2)))


MOST_DRAWN, PER_HALF_SWING = 4000, 60
"""Samples; points of the fitted curve in a half-swing."""
BEYOND = 1.5
"""Half-swings shown before the first and after the last turning point."""


def decay_charts(decay: Decay, title: str) -> dict[str, Chart]:
    """``record`` and ``swings``, names that also do for files."""
    return by_name([record(decay, title), swings(decay, title)])


def record(decay: Decay, title: str) -> Chart:
    """The samples, the motion fitted to them, and the turning points."""
    turns = decay.turns
    half = float(np.median(np.diff(turns.time)))
    low = max(float(decay.record.time[0]), float(turns.time[0]) - BEYOND * half)
    high = min(float(decay.record.time[-1]), float(turns.time[-1]) + BEYOND * half)
    time, values = _samples(decay, low, high)
    count = min(int(PER_HALF_SWING * (high - low) / half) + 2, 20_000)
    smooth = np.linspace(turns.time[0], turns.time[-1], count)
    curves = (
        Curve(time, values, say("samples"), "samples"),
        Curve(smooth, decay.fitted(smooth), say("fit"), "fit"),
    )
    named = say("turning points")
    marks = tuple(
        Mark(float(at), float(value), "", "turning", label=named)
        for at, value in zip(turns.time, turns.displacement, strict=True)
    )
    label = say("displacement") if decay.kind == "length" else say("angle")
    panel = Panel(
        Axis.of(say("time"), "time", low=low, high=high),
        Axis.of(label, decay.kind, values),
        curves,
        marks,
        lines=(Line(float(decay.whole.motion.center), "lines", axis="y"),),
        zero=False,
    )
    what = say("Record, motion fitted to all of it, turning points")
    return Chart("record", title, what, (panel,))


def swings(decay: Decay, title: str) -> Chart:
    """Each half-swing against the one before it, with the line."""
    heights = decay.turns.heights
    slope, cut = decay.line["slope"].value, decay.line["intercept"].value
    most = 1.08 * float(np.max(heights))
    reach = np.array([0.0, most])
    x = Axis.of(say("height of a half-swing"), decay.kind, heights, low=0.0, high=most)
    y = replace(x, label=say("height of the next"))
    sign = "\N{MINUS SIGN}" if cut < 0 else "+"
    line = {"slope": four_digits(slope), "sign": sign, "cut": x.quantity(abs(cut))}
    text, at = say("next = {slope} height {sign} {cut}", **line), 0.3 * most
    panel = Panel(
        x,
        y,
        (Curve(reach, reach, "", "even"), Curve(reach, slope * reach + cut, "", "thin")),
        (
            *(Mark(float(height), float(two), "", "turning") for height, two in pairwise(heights)),
            Mark(at, slope * at + cut, text, "main", -45.0, sign=False),
            Mark(0.6 * most, 0.6 * most, say("no decay"), "ink", 135.0, sign=False),
        ),
        height=280.0,
    )
    return Chart("swings", title, say("Each half-swing against the one before it"), (panel,))


def _samples(decay: Decay, low: float, high: float) -> tuple[Array, Array]:
    """Samples between two times, thinned where there are too many to be seen."""
    result = decay.record
    part = slice(np.searchsorted(result.time, low), np.searchsorted(result.time, high, "right"))
    time, values = result.time[part], result.displacement[part]
    step = -(-len(time) // MOST_DRAWN)
    return time[::step], values[::step]
