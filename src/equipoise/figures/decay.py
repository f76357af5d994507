"""The charts of a free decay: the record with its fit, and the line of half-swings."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.i18n import say
from equipoise.results.charts import Axis, Chart, Curve, Line, Mark, Panel, shown

if TYPE_CHECKING:
    from equipoise.measured.decay import Decay

Array = np.ndarray[Any, Any]

MOST_DRAWN, PER_HALF_SWING = 4000, 60
"""Samples; points of the fitted curve in a half-swing."""
BEYOND = 1.5
"""Half-swings shown before the first and after the last turning point."""


def charts(decay: Decay, title: str) -> dict[str, Chart]:
    """``record`` and ``swings``, names that also do for files."""
    return {"record": record(decay, title), "swings": swings(decay, title)}


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
    ends: dict[str, Any] = {"low": 0.0, "high": most}
    x = Axis.of(say("height of a half-swing"), decay.kind, heights, **ends)
    y = Axis.of(say("height of the next"), decay.kind, heights, **ends)
    sign = "\N{MINUS SIGN}" if cut < 0 else "+"
    line = {"slope": shown(slope), "sign": sign, "cut": x.quantity(abs(cut))}
    told, at = say("next = {slope} height {sign} {cut}", **line), 0.3 * most
    panel = Panel(
        x,
        y,
        (
            Curve(reach, reach, "", "even"),
            Curve(reach, slope * reach + cut, "", "thin"),
        ),
        (
            *(Mark(float(one), float(two), "", "turning") for one, two in pairwise(heights)),
            Mark(at, slope * at + cut, told, "main", -45.0, sign=False),
            Mark(0.6 * most, 0.6 * most, say("no decay"), "ink", 135.0, sign=False),
        ),
        height=280.0,
    )
    return Chart("swings", title, say("Each half-swing against the one before it"), (panel,))


def _samples(decay: Decay, low: float, high: float) -> tuple[Array, Array]:
    """Samples between two times, thinned where there are too many to be seen."""
    found = decay.record
    part = slice(np.searchsorted(found.time, low), np.searchsorted(found.time, high, "right"))
    time, values = found.time[part], found.displacement[part]
    step = -(-len(time) // MOST_DRAWN)
    return time[::step], values[::step]
