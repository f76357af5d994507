"""Charts of a hand-held tool over the engine's speed: what is handed on, what hands get."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.exposure.blocks import VERDICTS
from equipoise.exposure.daily import ACTION, EIGHT_HOURS, LIMIT
from equipoise.exposure.weighting import factor
from equipoise.figures.shared import SpeedCurve, by_name, curves_of, ends, log_ends, ordered
from equipoise.figures.style import KINDS, short
from equipoise.figures.tool_shaft import MOST_MODES, plane_named, turns_told
from equipoise.i18n import say, to_say
from equipoise.quantities import Display
from equipoise.results.charts import (
    DEGREES,
    Area,
    Array,
    Axis,
    Chart,
    Curve,
    Line,
    Mark,
    Panel,
    PlaceLabel,
    shown,
)

if TYPE_CHECKING:
    from equipoise.handheld.exposed import ToolExposure
    from equipoise.handheld.model import Tool
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.sweep import Transmissions


RATE = Display("m/s^2", 1.0)
ALONE, BREAK = 0.1, 180.0
"""Share by which the axis goes beyond a speed that stands alone; deg: a phase that leaps by more
goes on at the other end."""
LEVELS = (
    ("action", ACTION, to_say("action: A(8) of {value} m/s²")),
    ("limit", LIMIT, to_say("limit: A(8) of {value} m/s²")),
)
"""Role, A(8) in m/s2, and name of each level."""


def engine_axis(speed: Array) -> Axis:
    """Speeds (S,), rad/s."""
    low, high = float(speed[0]), float(speed[-1])
    if len(speed) < 2:
        low, high = (1 - ALONE) * low, (1 + ALONE) * high
    return Axis.of(say("speed of the engine"), "angular speed", (), "rpm", low=low, high=high)


def work_line(tool: Tool, axis: Axis) -> tuple[Line, ...]:
    """A line at the speed of work, where it is in sight."""
    low, high = ends(axis)
    at = None if tool.operation is None else tool.operation.speed
    return (Line(at, "work"),) if at is not None and low <= at <= high else ()


def work_mark(lines: Sequence[Line], y: Axis, above: bool = True) -> tuple[Mark, ...]:
    """The name of that line inside, near the upper or the lower end of a log axis."""
    low, high = ends(y)
    place = low * (high / low) ** (0.95 if above else 0.05)
    names = {line.at: say("work, {speed} rpm", speed=turns_told(line.at)) for line in lines}
    return tuple(
        Mark(at, place, name, "work", 0.0, sign=False, near=3.0) for at, name in names.items()
    )


def mode_lines(frequency: Array, axis: Axis) -> tuple[tuple[Line, ...], tuple[PlaceLabel, ...]]:
    """Light lines where an engine's turns meet natural frequencies, rad/s, and their numbers."""
    low, high = ends(axis)
    every = enumerate(frequency.tolist(), 1)
    inside = [(number, item) for number, item in every if low <= item <= high][:MOST_MODES]
    flags = tuple(PlaceLabel(at, (str(number),), 1 / number) for number, at in inside)
    return tuple(Line(at, "natural") for _, at in inside), flags


def transmission_charts(
    transmissions: Transmissions, modes: ToolModes | None = None
) -> dict[str, Chart]:
    """``transmission``, and ``transmission-lateral`` where the planes differ.

    modes : of the tool, whose natural frequencies are drawn as light lines.
    """
    planes = (0,) if transmissions.tool.alike else (0, 1)
    return by_name(transmission(transmissions, plane, modes) for plane in planes)


def transmission(transmissions: Transmissions, plane: int, modes: ToolModes | None) -> Chart:
    """Force ratio and phase of every station that is held: Fig. 6 of Nagamine and Irie."""
    curves = ordered(
        {name: station.size[plane] for name, station in transmissions.stations.items()}
    )
    x = engine_axis(transmissions.speed)
    lines, flags = mode_lines(np.empty(0) if modes is None else modes.planes[plane].frequency, x)
    low, high = log_ends(curves, 3.0, 2.0)
    y = Axis(say("force ratio"), scale="log", low=low, high=high)
    work = work_line(transmissions.tool, x)
    size = Panel(
        x,
        y,
        curves_of(transmissions.speed, curves),
        (*_quiet(transmissions, curves, plane, low), *work_mark(work, y)),
        lines=(*lines, *work),
        flags=flags,
        flag_words=(say("mode"),) if flags else (),
        height=209.0,
    )
    keys = [("quiet speed", say("quiet speed, rpm"))]
    if flags:
        keys.append(("natural", say("natural frequency")))
    ticks = tuple((float(np.radians(at)), shown(at)) for at in range(-180, 181, 90))
    reach = 195 / DEGREES.factor
    phases = Panel(
        x,
        Axis(say("phase"), DEGREES, low=-reach, high=reach, ticks=ticks),
        tuple(
            _phase(transmissions, curve.name, number, plane) for number, curve in enumerate(curves)
        ),
        lines=(*lines, *work),
        height=97.0,
        zero=False,
    )
    text = say(
        "Force on the body under a unit force at {station}", station=short(transmissions.source)
    )
    what = f"{text}, {plane_named(plane, transmissions.tool.alike)}"
    name = "transmission-lateral" if plane else "transmission"
    return Chart(name, transmissions.tool.title, what, (size, phases), keys=tuple(keys))


def _quiet(
    transmissions: Transmissions, curves: Sequence[SpeedCurve], plane: int, low: float
) -> Iterator[Mark]:
    """Marks at quiet speeds, on the curves, with their speeds."""
    for number, curve in enumerate(curves[: len(KINDS)]):
        for speed in transmissions.stations[curve.name].quiet[plane].tolist():
            value = np.exp(
                np.interp(speed, transmissions.speed, np.log(np.maximum(curve.values, 1e-300)))
            )
            at, role = max(float(value), low), f"quiet speed {number}"
            yield Mark(speed, at, turns_told(speed), role, -90.0, optional=True)


def _phase(transmissions: Transmissions, name: str, number: int, plane: int) -> Curve:
    phase = transmissions.stations[name].phase[plane]
    leap = np.flatnonzero(np.abs(np.diff(phase)) > np.radians(BREAK)) + 1
    role = f"kind {number}" if number < len(KINDS) else "quieter"
    return Curve(
        np.insert(transmissions.speed, leap, np.nan), np.insert(phase, leap, np.nan), "", role
    )


def exposure_charts(exposure: ToolExposure) -> dict[str, Chart]:
    """``acceleration`` and ``exposure`` of the hands against speed, with what is allowed."""
    return by_name([acceleration(exposure), weighted(exposure)])


def acceleration(exposure: ToolExposure) -> Chart:
    """RMS acceleration of each hand, with what is allowed of it: Fig. 7 of Nagamine and Irie."""
    read = {
        name: np.sqrt(np.sum(grip.acceleration**2, axis=0)) for name, grip in exposure.grips.items()
    }
    weight = factor(exposure.speed / (2 * pi))
    allowed = {role: level / weight for role, level in levels(exposure).items()}
    what = say(
        "Acceleration, not weighted; dotted: action and limit value if all of it is of order 1"
    )
    return _of_hands(exposure, "acceleration", read, allowed, what, say("RMS"))


def weighted(exposure: ToolExposure) -> Chart:
    """Weighted total value of each hand, with action and limit value for the time of work."""
    read = {name: grip.a_hv for name, grip in exposure.grips.items()}
    allowed = {
        role: np.full(len(exposure.speed), level) for role, level in levels(exposure).items()
    }
    what = say("Weighted acceleration; dotted: action and limit value")
    chart = _of_hands(exposure, "exposure", read, allowed, what, say("total value a_hv"))
    over = say(VERDICTS["above the limit value"])
    beyond = (np.where(item > allowed["limit"], item, np.nan) for item in read.values())
    stretches = tuple(
        Curve(exposure.speed, item, over, "broken stretch")
        for item in beyond
        if not np.all(np.isnan(item))
    )
    (panel,) = chart.panels
    chart = replace(chart, panels=(replace(panel, curves=(*panel.curves, *stretches)),))
    if exposure.worst is None or exposure.a8 is None:
        return chart
    text = {"a8": shown(exposure.a8), "hand": short(exposure.worst)}
    return replace(chart, what=f"{chart.what}; " + say("A(8) = {a8} m/s² at {hand}", **text))


def duration_of(exposure: ToolExposure) -> float:
    """Time of work a day, s; eight hours where it is not told."""
    return next((day.duration for day in exposure.days.values()), EIGHT_HOURS)


def levels(exposure: ToolExposure) -> dict[str, float]:
    """Steady total value, m/s2, at which A(8) is the action or the limit value."""
    share = float(np.sqrt(EIGHT_HOURS / duration_of(exposure)))
    return {role: level * share for role, level, _ in LEVELS}


def _of_hands(
    exposure: ToolExposure,
    name: str,
    read: Mapping[str, Array],
    allowed: Mapping[str, Array],
    what: str,
    label: str,
) -> Chart:
    """Curves of hands over speed, and a shade above what must not be."""
    tool, speed = exposure.response.tool, exposure.speed
    curves, x = ordered(read), engine_axis(speed)
    low, high = log_ends(curves, 1.8, 2.2, [float(np.min(row)) for row in allowed.values()])
    y = Axis(label, RATE, "log", low, high)
    work = work_line(tool, x)
    limits = tuple(
        Curve(speed, allowed[role], say(text, value=f"{level:g}"), role)
        for role, level, text in LEVELS
    )
    above = Area(speed, np.minimum(allowed["limit"], high), np.full(len(speed), high), "forbidden")
    marks = (*hand_peaks(tool, speed, curves, y), *work_mark(work, y, above=False))
    content = (*curves_of(speed, curves), *limits)
    panel = Panel(x, y, content, marks, lines=work, areas=(above,), height=245.0)
    hours = say("{hours} h a day", hours=shown(duration_of(exposure) / 3600))
    return Chart(name, tool.title, f"{what}, {hours}", (panel,))


def hand_peaks(tool: Tool, speed: Array, curves: Sequence[SpeedCurve], y: Axis) -> Iterator[Mark]:
    """Acceleration and speed at the highest place of curves.

    Where nothing takes power there is no highest place.
    """
    if not tool.damped and not any(
        station.hand and station.hand.impedance for station in tool.stations
    ):
        return
    for number, curve in enumerate(curves[: len(KINDS)]):
        k = int(np.nanargmax(curve.values))
        size = float(curve.values[k])
        if 0 < k < len(speed) - 1 and 0 < size <= (y.high or size):
            at = float(speed[k])
            text = say("{value} at {speed} rpm", value=y.quantity(size), speed=turns_told(at))
            yield Mark(at, size, text, f"kind {number}", 20.0, sign=False, optional=True)
