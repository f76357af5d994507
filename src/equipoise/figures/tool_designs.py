"""Charts of the studies of a hand-held tool, and of a design made better."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.figures.chart_parts import SpeedCurve, curves_of, ends, log_ends
from equipoise.figures.style import short
from equipoise.figures.tool_shaft import (
    RATE,
    TOTAL_VALUE,
    engine_axis,
    hand_peaks,
    plane_named,
    rpm_text,
    work_line,
    work_mark,
)
from equipoise.handheld.design_plan import KEYS, MEASURES
from equipoise.handheld.frequencies import scale_of
from equipoise.handheld.hand_blocks import figure_named
from equipoise.handheld.hand_exposure import grips
from equipoise.handheld.modes import number_of
from equipoise.handheld.response import respond_tool
from equipoise.i18n import capital, decimals, say, to_say
from equipoise.quantities import Dimension, Display, display
from equipoise.results.charts import RPM, Array, Axis, Chart, Curve, Line, Mark, Panel, four_digits

if TYPE_CHECKING:
    from equipoise.handheld.design import ToolDesign
    from equipoise.handheld.modes import DeterminantChart, ToolModes, Variation


MOST_CHANGES = 8
"""Changes of a design that are listed, at most."""
ROUNDEST = ((1.0,), (5.0, 2.0), (3.0, 4.0, 7.0, 6.0, 8.0, 9.0), (1.5, 2.5))
"""First digits of the numbers of an axis of frequencies, the roundest first."""
APART = 0.09
"""Of the height of the axes between these numbers, at least."""
STEPS = tuple(digit * 10.0**power for power in range(-2, 5) for digit in (1, 2, 5))
"""Of an axis of lambda."""
PARTS = {
    "": to_say("{number} of {station}"),
    "ground": to_say("{number} of {station} to the ground"),
    "harness": to_say("{number} of the harness at {station}"),
    "absorber": to_say("{number} of the absorber at {station}"),
}
NUMBERS = {
    "position": to_say("position"),
    "mass": to_say("mass"),
    "stiffness": to_say("stiffness"),
    "damping": to_say("damping"),
    "rotational_stiffness": to_say("rotational stiffness"),
    "rotational_damping": to_say("rotational damping"),
}
SHOWN_IN = {"mass": "kg", "stiffness": "kN/m"}
ALLOWED = {"lowest": to_say("lowest allowed"), "highest": to_say("highest allowed")}


# -- studies of a tool -----------------------------------------------------------------------------


def determinant_charts(chart: DeterminantChart, modes: ToolModes) -> dict[str, Chart]:
    """``determinant``: the function whose zeros are the modes, against lambda (their Fig. 2)."""
    planes = (0,) if modes.alike else (0, 1)
    panels = []
    for plane in planes:
        known = modes.planes[plane].parameter
        zeros = zeros_of(chart.parameter, chart.value[plane], known)
        top = 1.1 * float(np.max(np.abs(chart.value[plane]))) or 1.0
        marks = tuple(
            Mark(at, 0.0, decimals(f"{at:.3f}"), "zeros", 60.0, optional=True) for at in zeros
        )
        panels.append(
            Panel(
                Axis("λ", low=0.0, high=float(chart.parameter[-1])),
                Axis("± lg(1 + |D| / least peak)", low=-top, high=top),
                (Curve(chart.parameter, chart.value[plane], "", "thin"),),
                marks,
                title="" if modes.alike else plane_named(plane, alike=False),
            )
        )
    text = say("both planes") if modes.alike else say("by planes")
    what = say(
        "Characteristic function D without damping, {planes}; its zeros are the modes", planes=text
    )
    return {"determinant": Chart("determinant", modes.tool.title, what, tuple(panels))}


def zeros_of(parameter: Array, value: Array, known: Array) -> list[float]:
    """Zeros in a chart: those that are known exactly, and beyond them where its sign changes."""
    inside = known[(known > 0) & (known <= parameter[-1])]
    before = np.flatnonzero(np.signbit(value[1:]) != np.signbit(value[:-1]))
    x, y = parameter, value
    crossed = x[before] - y[before] * (x[before + 1] - x[before]) / (y[before + 1] - y[before])
    beyond = crossed[parameter[before] > np.max(known, initial=0.0)]
    return [*map(float, inside), *map(float, beyond)]


def variation_charts(variation: Variation) -> dict[str, Chart]:
    """``variation``: frequency and lambda against a number of a station (their Figs. 3 and 4).

    Places go with lambda, so that low frequencies are not crowded.
    """
    tool, values = variation.tool, variation.values
    vertical, lateral = variation.parameter
    apart = not np.allclose(vertical, lateral, rtol=1e-6, atol=1e-9)
    top = 1.06 * float(np.max(variation.parameter)) or 1.0
    x = Axis(named(variation), number_unit(KEYS[variation.key]), *_along(values))
    names = [plane_named(plane, alike=not apart) for plane in ((0, 1) if apart else (0,))]
    curves = [
        Curve(values, row, name, f"several {number}")
        for number, (name, rows) in enumerate(zip(names, variation.parameter, strict=False), 1)
        for row in rows.T
    ]
    panel = Panel(
        x,
        _turns_axis(scale_of(tool), top),
        tuple(curves),
        tuple(_numbers(variation, x)),
        lines=tuple(_lines(variation, x, top)),
        right_axis=_parameter_axis(top),
        height=225.0,
    )
    what = say("Natural frequencies without damping against the {number}", number=named(variation))
    return {"variation": Chart("variation", tool.title, what, (panel,))}


def number_unit(dimension: str) -> Display:
    """Display unit of a number of a station."""
    return display(cast(Dimension, dimension), (), SHOWN_IN.get(dimension))


def named(variation: Variation) -> str:
    """The number that varies, in words."""
    owner, _, last = variation.key.rpartition(".")
    if not owner and KEYS[variation.key] not in ("length", "mass"):
        owner = "ground"
    number = say(NUMBERS.get(last, last.replace("_", " ")))
    return say(PARTS[owner], number=number, station=short(variation.station))


def _along(values: Array) -> tuple[Any, float, float]:
    """Scale and ends of the axis: log where the values were chosen so."""
    log = len(values) > 2 and np.all(values > 0) and _uneven(np.log(values)) < _uneven(values)
    low, high = float(np.min(values)), float(np.max(values))
    if low == high:
        low, high = low - 0.05 * abs(low) - 1e-9, high + 0.05 * abs(high) + 1e-9
    return "log" if log else "linear", low, high


def _uneven(values: Array) -> float:
    steps = np.abs(np.diff(np.sort(values)))
    return float(np.ptp(steps) / np.mean(steps)) if np.any(steps) else 0.0


def _turns_axis(scale: float, top: float) -> Axis:
    """An axis of lambda in turns a minute, which grow with its square."""

    def place(minute: float) -> float:
        return float(np.sqrt(minute / RPM.factor / scale))

    highest = scale * top**2 * RPM.factor
    chosen = [0.0]
    powers = 10.0 ** np.arange(np.floor(np.log10(highest)), np.floor(np.log10(highest)) - 4, -1)
    for digits in ROUNDEST:
        for number in np.multiply.outer(powers, digits).ravel().tolist():
            far = all(abs(place(number) - place(item)) >= APART * top for item in chosen)
            if number <= highest and far:
                chosen.append(number)
    ticks = tuple((place(item), rpm_text(item / RPM.factor)) for item in sorted(chosen))
    unit = Display("1/min", 1.0)
    return Axis(say("natural frequency"), unit, low=0.0, high=top, ticks=ticks)


def _parameter_axis(top: float) -> Axis:
    """Axis of lambda, by steps of which there are nine at most."""
    step = next(step for step in STEPS if top <= 9 * step)
    return Axis(
        "λ",
        ticks=tuple((item, decimals(f"{item:g}")) for item in np.arange(0.0, top, step).tolist()),
    )


def _lines(variation: Variation, x: Axis, top: float) -> Iterator[Line]:
    """The number as it is, and the speed of the engine at work."""
    tool = variation.tool
    now = number_of(tool, variation.station, variation.key)
    if np.min(variation.values) <= now <= np.max(variation.values):
        yield Line(now, "now", say("now {value}", value=x.quantity(now)))
    if tool.operation is not None:
        at = float(np.sqrt(tool.operation.speed / scale_of(tool)))
        if at <= top:
            text = say("work, {speed} rpm", speed=rpm_text(tool.operation.speed))
            yield Line(at, "work", text, "y")


def _numbers(variation: Variation, x: Axis) -> Iterator[Mark]:
    """Numbers of the modes on their lines."""
    low, high = ends(x)
    at = low * (high / low) ** 0.06 if x.scale == "log" else low + 0.06 * (high - low)
    order = np.argsort(variation.values)
    for number, row in enumerate(variation.parameter[0].T, 1):
        y = float(np.interp(at, variation.values[order], row[order]))
        yield Mark(at, y, str(number), "main", distance=3.0, optional=True, sign=False)


# -- a design --------------------------------------------------------------------------------------


def design(result: ToolDesign) -> Chart:
    """What the hand that gets most gets over the band, before and after.

    The worst hand over the band is made better; at some speeds another one may be worse.
    """
    plan = result.tool.design
    hands = plan.hands if plan is not None else ()
    before, after = (
        [
            SpeedCurve(name, grip.a_hv)
            for name, grip in grips(respond_tool(tool, result.speed)).items()
            if not hands or name in hands
        ]
        for tool in (result.tool, result.better)
    )
    x = engine_axis(result.speed)
    low, high = log_ends([*before, *after], 1.8, 2.2)
    y = Axis(say(TOTAL_VALUE), RATE, "log", low, high)
    old = (replace(curve, label="", dashed=True) for curve in curves_of(result.speed, before))
    work = work_line(result.tool, x)
    marks = (*hand_peaks(result.better, result.speed, after, y), *work_mark(work, y, above=False))
    curves = (*old, *curves_of(result.speed, after))
    panel = Panel(x, y, curves, marks, lines=work, height=209.0)
    figure = result.figures[MEASURES.index("rms" if plan is None else plan.measure)]
    name = figure_named(figure).replace("a_hv", "aₕᵥ")  # as its axis has it
    values = " → ".join(map(four_digits, (figure.before, figure.after)))
    what = f"{capital(name)}: {values} m/s²"
    keys = (("dashed ink", say("before")), ("ink", say("after")))
    return Chart("design", result.tool.title, what, (panel,), keys=keys)


def change_texts(design: ToolDesign) -> list[str]:
    """Changes other than of lengths, before and after; at most `MOST_CHANGES` lines."""
    every = zip(design.variables, design.edges, strict=True)
    values = [(item, edge) for item, edge in every if item.dimension != "length"]
    words, count = [], len(values)
    for entry, edge in values:
        axis = Axis("", number_unit(entry.dimension))
        ends = f"{axis.format_value(entry.before)} → {axis.quantity(entry.after)}"
        end = f" ({say(ALLOWED[edge])})" if edge else ""
        words.append(f"{figure_named(entry)}: {ends}{end}")
    if count <= MOST_CHANGES:
        return words
    return [*words[: MOST_CHANGES - 1], say("and {count} more", count=count - MOST_CHANGES + 1)]
