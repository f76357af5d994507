"""The charts of hand-held tools: modes, what is handed on, accelerations, moments, a design."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import pi
from textwrap import wrap
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.exposure.daily import ACTION, EIGHT_HOURS, LIMIT
from equipoise.exposure.weighting import factor
from equipoise.figures.style import KINDS, short
from equipoise.figures.sweep import Named, curves_of, log_ends, ordered
from equipoise.handheld.design_plan import KEYS, MEASURES
from equipoise.handheld.exposed import grips
from equipoise.handheld.frequencies import scale_of
from equipoise.handheld.hand_blocks import figure_named
from equipoise.handheld.response import respond_tool
from equipoise.handheld.studies import number_of
from equipoise.i18n import say, to_say
from equipoise.quantities import Dimension, Display, display
from equipoise.results.charts import (
    DEGREES,
    RPM,
    Area,
    Axis,
    Chart,
    Curve,
    Flag,
    Line,
    Mark,
    Panel,
    shown,
)

if TYPE_CHECKING:
    from equipoise.handheld.design import ToolDesign
    from equipoise.handheld.exposed import ToolExposure
    from equipoise.handheld.model import Station, Tool
    from equipoise.handheld.modes import PlaneModes, ToolModes
    from equipoise.handheld.response import ToolResponse
    from equipoise.handheld.shapes import Line as ShaftLine
    from equipoise.handheld.studies import DeterminantChart, Variation
    from equipoise.handheld.transmission import Transmissions

Array = np.ndarray[Any, Any]

MM = 1000.0
RATE = Display("m/s^2", 1.0)
ALONE = 0.1
"""Share by which the axis goes beyond a speed that stands alone."""
MOST_MODES, MOST_SHAPES, MOST_NAMES, LONGEST = 24, 6, 24, 20
"""Natural frequencies that are marked; shapes in a picture; stations named; signs of a name."""
BESIDE, BEFORE = 0.02, 1e-9
"""Share of the shaft that the axis goes on beyond its ends; m before a station, where the moment is
that at its left."""
REACH = 1.42
"""Upper end of the axis of a shape, over its largest displacement."""
LETTERS = 18
"""In a line of what a free motion is called."""
BREAK = 180.0
"""deg: a phase that leaps by more goes on at the other end."""
POINTS, MOST_ORDERS, MATTERS = 401, 3, 1e-3
"""Places along the shaft; orders whose moment and shape are drawn; share of the largest
displacement from which a plane's shape is drawn."""
ORDER_ROLES = ("kind 0", "kind 1", "kind 3")
MOST_CHANGES = 8
"""Changes of a design that are told."""
ROUNDEST = ((1.0,), (5.0, 2.0), (3.0, 4.0, 7.0, 6.0, 8.0, 9.0), (1.5, 2.5))
"""First digits of the numbers of an axis of frequencies, the roundest first."""
APART = 0.09
"""Of the height of the axes between these numbers, at least."""
SIGNS = {
    "hand": to_say("hand"),
    "harness or ground": to_say("harness or ground"),
    "station": to_say("station"),
}
"""What holds a station, in words; the last holds nothing."""
LEVELS = (
    ("action", ACTION, to_say("action: A(8) of {value} m/s²")),
    ("limit", LIMIT, to_say("limit: A(8) of {value} m/s²")),
)
"""Role, A(8) in m/s2, and name of each level."""
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
SHOWN_IN = {
    "mass": ("kg", "g", "kg"),
    "stiffness": ("kN/m", "kN/m", "kN/m"),
}
ALLOWED = {"lowest": to_say("lowest allowed"), "highest": to_say("highest allowed")}


def numbered(charts: Iterable[Chart]) -> dict[str, Chart]:
    """Charts by their names."""
    return {chart.name: chart for chart in charts}


# -- along the shaft -------------------------------------------------------------------------------


def plane_named(plane: int, alike: bool) -> str:
    """The vertical plane, the lateral one, or both where they are alike."""
    if alike:
        return say("both planes")
    return say("lateral plane") if plane else say("vertical plane")


def kind_of(station: Station) -> str:
    """What holds a station: key of `SIGNS`."""
    if station.hand is not None:
        return "hand"
    grounded = any(station.stiffness) or any(station.rotational_stiffness)
    return "harness or ground" if station.harness is not None or grounded else "station"


def shaft_axis(tool: Tool) -> Axis:
    """Places along the shaft."""
    beyond = BESIDE * tool.shaft.length
    label = say("place on the shaft from its left end")
    return Axis.of(label, "length", [0.1], low=-beyond, high=tool.shaft.length + beyond)


def shaft_lines(tool: Tool) -> tuple[Line, ...]:
    """A thin line at every station."""
    return tuple(Line(station.position, "station line") for station in tool.stations)


def station_flags(tool: Tool) -> tuple[Flag, ...]:
    """Names of the stations; where there are too many, of those that matter most."""

    def weight(station: Station) -> tuple[bool, bool, float]:
        shaken = any(one.station == station.name for one in tool.excitations)
        return kind_of(station) != "station", shaken, station.mass

    chosen = sorted(tool.stations, key=weight, reverse=True)[:MOST_NAMES]
    ranked = sorted(chosen, key=lambda one: one.position)
    return tuple(
        Flag(one.position, (short(one.name, LONGEST),), 1.0 + len(chosen) - chosen.index(one))
        for one in ranked
    )


def mode_charts(modes: ToolModes) -> dict[str, Chart]:
    """``modes``, and ``modes-lateral`` where the planes differ.

    Many modes go on in ``modes-2`` and so on.
    """
    drawn = numbered(shapes(modes, 0))
    return drawn if modes.alike else drawn | numbered(shapes(modes, 1))


def shapes(modes: ToolModes, plane: int) -> Iterator[Chart]:
    """Shapes without damping in one plane, some in each picture: Fig. 5 of Nagamine and Irie."""
    count = len(modes.planes[plane].frequency)
    name = "modes-lateral" if plane else "modes"
    told = f"{say('Shapes of free vibration without damping')}, {plane_named(plane, modes.alike)}"
    kinds = {kind_of(station) for station in modes.tool.stations}
    keys = (
        ("shape", say("one end of the swing")),
        ("other end", say("the other")),
        ("node", say("node, mm")),
        *((kind, say(text)) for kind, text in SIGNS.items() if kind in kinds),
    )
    for number, first in enumerate(range(0, count, MOST_SHAPES), 1):
        last = min(first + MOST_SHAPES, count)
        panels = [_shape(modes, modes.planes[plane], k) for k in range(first, last)]
        panels[0] = replace(panels[0], flags=station_flags(modes.tool))
        part = {"first": first + 1, "last": last, "count": count}
        what = (
            told
            if count <= MOST_SHAPES
            else f"{told} " + say("({first} to {last} of {count})", **part)
        )
        own = f"{name}-{number}" if number > 1 else name
        yield Chart(own, modes.tool.title, what, tuple(panels), keys=keys)


def _shape(modes: ToolModes, found: PlaneModes, number: int) -> Panel:
    """One shape with its stations and nodes; its number at the left, its figures at the right."""
    shape, x = found.shapes[number], modes.places
    marks = [
        Mark(one.position, float(np.interp(one.position, x, shape)), "", kind_of(one))
        for one in modes.tool.stations
    ]
    marks += [
        Mark(float(node), 0.0, f"{MM * node:.0f}", "node", optional=True, near=5.0)
        for node in found.nodes[number]
    ]
    hertz = float(found.cycles_per_second[number])
    if hertz:
        minute = turns_told(float(found.frequency[number]))
        lines = [f"{shown(hertz)} Hz", f"{minute} 1/min", f"λ = {found.parameter[number]:.3f}"]
    else:
        lines = [say("free:"), *wrap(found.rigid[number], LETTERS)]
    return Panel(
        shaft_axis(modes.tool),
        Axis(low=-REACH, high=REACH, ticks=()),
        (Curve(x, -shape, "", "other end"), Curve(x, shape, "", "shape")),
        tuple(marks),
        lines=shaft_lines(modes.tool),
        grid=False,
        height=58.0,
        left=(say("mode {number}", number=number + 1),),
        right=tuple(lines),
    )


def turns_told(speed: float) -> str:
    """A speed or frequency, rad/s, in turns a minute: four digits, and all before the point."""
    minute = speed * RPM.factor
    return shown(minute) if minute < 1e4 else f"{minute:.0f}"


# -- over the engine's speed -----------------------------------------------------------------------


def engine_axis(speed: Array) -> Axis:
    """Speeds (S,), rad/s."""
    low, high = float(speed[0]), float(speed[-1])
    if len(speed) < 2:
        low, high = (1 - ALONE) * low, (1 + ALONE) * high
    return Axis(say("speed of the engine"), RPM, low=low, high=high)


def work_line(tool: Tool, axis: Axis) -> tuple[Line, ...]:
    """A line at the speed of work, where it is in sight."""
    assert axis.low is not None and axis.high is not None
    at = None if tool.operation is None else tool.operation.speed
    return (Line(at, "work"),) if at is not None and axis.low <= at <= axis.high else ()


def work_mark(lines: Sequence[Line], y: Axis, above: bool = True) -> tuple[Mark, ...]:
    """The name of that line inside, near the upper or the lower end of a log axis."""
    assert y.low is not None and y.high is not None
    place = y.low * (y.high / y.low) ** (0.95 if above else 0.05)
    text = say("work, {speed} rpm")
    return tuple(
        Mark(
            line.at,
            place,
            text.format(speed=turns_told(line.at)),
            "work",
            0.0,
            sign=False,
            near=3.0,
        )
        for line in lines
    )


def mode_lines(frequency: Array, axis: Axis) -> tuple[tuple[Line, ...], tuple[Flag, ...]]:
    """Light lines where an engine's turns meet natural frequencies, rad/s, and their numbers."""
    assert axis.low is not None and axis.high is not None
    inside = [
        (number, float(one))
        for number, one in enumerate(frequency, 1)
        if axis.low <= float(one) <= axis.high
    ][:MOST_MODES]
    flags = tuple(Flag(at, (str(number),), 1 / number) for number, at in inside)
    return tuple(Line(at, "natural") for _, at in inside), flags


def transmission_charts(
    transmissions: Transmissions, modes: ToolModes | None = None
) -> dict[str, Chart]:
    """``transmission``, and ``transmission-lateral`` where the planes differ.

    modes : of the tool, whose natural frequencies are drawn as light lines.
    """
    planes = (0,) if transmissions.tool.alike else (0, 1)
    return numbered(transmission(transmissions, plane, modes) for plane in planes)


def transmission(found: Transmissions, plane: int, modes: ToolModes | None) -> Chart:
    """Force ratio and phase of every station that is held: Fig. 6 of Nagamine and Irie."""
    curves = ordered({name: one.size[plane] for name, one in found.stations.items()})
    x = engine_axis(found.speed)
    lines, flags = mode_lines(np.empty(0) if modes is None else modes.planes[plane].frequency, x)
    low, high = log_ends(curves, 3.0, 2.0)
    y = Axis(say("force ratio"), scale="log", low=low, high=high)
    work = work_line(found.tool, x)
    marks = [*_quiet(found, curves, plane, low), *work_mark(work, y)]
    size = Panel(
        x,
        y,
        curves_of(found.speed, curves),
        tuple(marks),
        lines=(*lines, *work),
        flags=flags,
        flag_words=(say("mode"),) if flags else (),
        height=209.0,
    )
    keys = [("quiet speed", say("quiet speed, rpm"))]
    if flags:
        keys.append(("natural", say("natural frequency")))
    phase = Axis(say("phase"), DEGREES, low=-195 / DEGREES.factor, high=195 / DEGREES.factor)
    ticks = tuple((float(np.radians(at)), shown(at)) for at in range(-180, 181, 90))
    phases = Panel(
        x,
        replace(phase, ticks=ticks),
        tuple(_phase(found, one.name, number, plane) for number, one in enumerate(curves)),
        lines=(*lines, *work),
        height=97.0,
        zero=False,
    )
    told = say("Force on the body under a unit force at {station}", station=short(found.source))
    what = f"{told}, {plane_named(plane, found.tool.alike)}"
    name = "transmission-lateral" if plane else "transmission"
    return Chart(name, found.tool.title, what, (size, phases), keys=tuple(keys))


def _quiet(found: Transmissions, curves: Sequence[Named], plane: int, low: float) -> Iterator[Mark]:
    """Marks at quiet speeds, on the curves, with their speeds."""
    for number, curve in enumerate(curves[: len(KINDS)]):
        for speed in found.stations[curve.name].quiet[plane].tolist():
            value = np.exp(np.interp(speed, found.speed, np.log(np.maximum(curve.values, 1e-300))))
            at, role = max(float(value), low), f"quiet speed {number}"
            yield Mark(speed, at, turns_told(speed), role, -90.0, optional=True)


def _phase(found: Transmissions, name: str, number: int, plane: int) -> Curve:
    phase = found.stations[name].phase[plane]
    leap = np.flatnonzero(np.abs(np.diff(phase)) > np.radians(BREAK)) + 1
    role = f"kind {number}" if number < len(KINDS) else "quieter"
    return Curve(np.insert(found.speed, leap, np.nan), np.insert(phase, leap, np.nan), "", role)


def exposure_charts(exposure: ToolExposure) -> dict[str, Chart]:
    """``acceleration`` and ``exposure`` of the hands against speed, with what is allowed."""
    return {"acceleration": acceleration(exposure), "exposure": weighted(exposure)}


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
    allowed = {role: np.full(len(exposure.speed), one) for role, one in levels(exposure).items()}
    what = say("Weighted acceleration; dotted: action and limit value")
    chart = _of_hands(exposure, "exposure", read, allowed, what, "a_hv")
    if exposure.worst is None or exposure.a8 is None:
        return chart
    told = {"a8": shown(exposure.a8), "hand": short(exposure.worst)}
    return replace(chart, what=f"{chart.what}; " + say("A(8) = {a8} m/s² at {hand}", **told))


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
    drawn = (*curves_of(speed, curves), *limits)
    panel = Panel(x, y, drawn, marks, lines=work, areas=(above,), height=245.0)
    hours = say("{hours} h a day", hours=shown(duration_of(exposure) / 3600))
    return Chart(name, tool.title, f"{what}, {hours}", (panel,))


def hand_peaks(tool: Tool, speed: Array, curves: Sequence[Named], y: Axis) -> Iterator[Mark]:
    """Acceleration and speed at the highest place of curves.

    Where nothing takes power there is no highest place.
    """
    if not tool.damped and not any(one.hand and one.hand.impedance for one in tool.stations):
        return
    for number, curve in enumerate(curves[: len(KINDS)]):
        k = int(np.nanargmax(curve.values))
        size = float(curve.values[k])
        if 0 < k < len(speed) - 1 and 0 < size <= (y.high or size):
            at = float(speed[k])
            text = say("{value} at {speed} rpm", value=y.quantity(size), speed=turns_told(at))
            yield Mark(at, size, text, f"kind {number}", 20.0, sign=False, optional=True)


# -- bending moment --------------------------------------------------------------------------------


def response_charts(response: ToolResponse, speed: float | None = None) -> dict[str, Chart]:
    """``moment``: bending moment and displacement along the shaft at one speed of the engine.

    speed : rad/s; that of work if None, or else the one at which the hands get most.
    """
    return {"moment": moment(response, speed)}


def moment(response: ToolResponse, speed: float | None) -> Chart:
    """RMS of the bending moment, and the shape of each order when it is largest."""
    tool = response.tool
    speed = speed_shown(response) if speed is None else speed
    one = respond_tool(tool, speed)
    places = _places(tool)
    line = one.line(places)
    loudest = _loudest(line)
    drawn = _displaced(line, loudest)
    keys = [("strong", say("all orders, root of squares"))]
    for role, k in zip(ORDER_ROLES, loudest, strict=False):
        keys.append((role, say("order {order}", order=shown(float(one.orders[k])))))
    if {plane for _, plane in drawn} == {0, 1}:
        keys.append(("other end", say("lateral plane")))
    what = say("RMS of the bending moment, and shape of each order when it is largest")
    panels = (
        replace(_moments(tool, places, line, loudest), flags=station_flags(tool)),
        _shapes_of_orders(tool, places, drawn),
    )
    told = f"{what}; {turns_told(speed)} rpm"
    return Chart("moment", tool.title, told, panels, keys=tuple(keys))


def speed_shown(response: ToolResponse) -> float:
    """Speed, rad/s, of work; else the one at which hands get most, or a station moves most."""
    operation, speeds = response.tool.operation, response.speed
    if len(speeds) == 1:
        return float(speeds[0])
    if operation is not None and np.min(speeds) <= operation.speed <= np.max(speeds):
        return operation.speed
    if response.tool.grips:
        felt = np.max([grip.a_hv for grip in grips(response).values()], axis=0)
    else:
        moved = [np.abs(response.displacement(one.name)) for one in response.tool.stations]
        felt = np.max([np.sum(one**2, axis=(0, 1)) for one in moved], axis=0)
    return float(speeds[np.argmax(felt)])


def _places(tool: Tool) -> Array:
    """Places along the shaft, and both sides of each station."""
    at = np.array([station.position for station in tool.stations])
    every = np.concatenate([np.linspace(0.0, tool.shaft.length, POINTS), at, at - BEFORE])
    return np.unique(np.clip(every, 0.0, tool.shaft.length))


def _loudest(line: ShaftLine) -> list[int]:
    """Numbers of the orders whose moment is largest, the largest first."""
    size = np.max(np.sum(np.abs(line.moment[..., 0]) ** 2, axis=1), axis=0)
    return [int(k) for k in np.argsort(-size, kind="stable")[:MOST_ORDERS]]


def _displaced(line: ShaftLine, loudest: list[int]) -> dict[tuple[int, int], Array]:
    """(Place among the loudest, plane) -> displacement, m, at the instant when it is largest.

    The lateral plane is left out where it does the same as the vertical one.
    """
    moved = line.displacement[..., 0]
    least = MATTERS * float(np.max(np.abs(moved)))
    found: dict[tuple[int, int], Array] = {}
    for number, k in enumerate(loudest):
        both = [_largest(moved[:, plane, k]) for plane in range(2)]
        for plane, shape in enumerate(both):
            same = plane == 1 and np.allclose(shape, both[0], atol=least)
            if np.max(np.abs(shape)) > least and not same:
                found[number, plane] = shape
    return found


def _largest(amplitude: Array) -> Array:
    """Where an amplitude (X,) is at the instant when it is largest."""
    turned = np.exp(-0.5j * np.angle(np.sum(amplitude**2)))
    shape = np.real(amplitude * turned)
    return np.asarray(shape * np.sign(shape[np.argmax(np.abs(shape))] or 1.0))


def _moments(tool: Tool, places: Array, line: ShaftLine, loudest: list[int]) -> Panel:
    """RMS over time of all orders and planes, and of both planes of the loudest orders."""
    squares = np.sum(np.abs(line.moment[..., 0]) ** 2, axis=1) / 2
    total = np.sqrt(np.sum(squares, axis=1))
    y = Axis.of(say("moment"), "torque", total, low=0.0, room=0.18)
    curves = [Curve(places, total, "", "strong")]
    if len(loudest) > 1 or squares.shape[1] > 1:
        for role, k in zip(ORDER_ROLES, loudest, strict=False):
            curves.append(Curve(places, np.sqrt(squares[:, k]), "", role))
    k = int(np.argmax(total))
    at, top = float(places[k]), float(total[k])
    text = say("{value} at {place} mm", value=y.quantity(top), place=f"{MM * at:.0f}")
    mark = Mark(at, top, text, "ink", 60.0, sign=False)
    lines = shaft_lines(tool)
    return Panel(shaft_axis(tool), y, tuple(curves), (mark,), lines=lines, height=150.0)


def _shapes_of_orders(tool: Tool, places: Array, found: Mapping[tuple[int, int], Array]) -> Panel:
    every = np.array([*found.values()]) if found else np.zeros((1, len(places)))
    y = Axis.of(say("displacement"), "length", [*every.ravel(), 0.0], room=0.12)
    curves = tuple(
        Curve(places, shape, "", ORDER_ROLES[number], dashed=bool(plane))
        for (number, plane), shape in found.items()
    )
    curves = curves or (Curve(places, every[0], "", "faint"),)
    return Panel(shaft_axis(tool), y, curves, lines=shaft_lines(tool), height=150.0)


# -- studies of a tool -----------------------------------------------------------------------------


def determinant_charts(chart: DeterminantChart, modes: ToolModes) -> dict[str, Chart]:
    """``determinant``: the function whose zeros are the modes, against lambda (their Fig. 2)."""
    planes = (0,) if modes.alike else (0, 1)
    panels = []
    for plane in planes:
        known = modes.planes[plane].parameter
        zeros = zeros_of(chart.parameter, chart.value[plane], known)
        top = 1.1 * float(np.max(np.abs(chart.value[plane]))) or 1.0
        marks = tuple(Mark(at, 0.0, f"{at:.3f}", "zeros", 60.0, optional=True) for at in zeros)
        panels.append(
            Panel(
                Axis("λ", low=0.0, high=float(chart.parameter[-1])),
                Axis("± lg(1 + |D| / least peak)", low=-top, high=top),
                (Curve(chart.parameter, chart.value[plane], "", "thin"),),
                marks,
                title="" if modes.alike else plane_named(plane, alike=False),
            )
        )
    told = say("both planes") if modes.alike else say("by planes")
    what = say(
        "Characteristic function D without damping, {planes}; its zeros are the modes", planes=told
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
    """``variation``: lambda and frequency against a number of a station (their Figs. 3 and 4)."""
    tool, values = variation.tool, variation.values
    planes = 2 if _apart(variation) else 1
    top = 1.06 * float(np.max(variation.parameter)) or 1.0
    x = Axis(named(variation), number_unit(KEYS[variation.key]), *_along(values))
    names = [say("both planes")] if planes == 1 else [plane_named(k, alike=False) for k in (0, 1)]
    curves = [
        Curve(values, row, name, f"several {number}")
        for number, (name, rows) in enumerate(zip(names, variation.parameter, strict=False), 1)
        for row in rows.T
    ]
    lines = [*_now(variation, x), *_work(tool, top)]
    panel = Panel(
        x,
        Axis("λ", low=0.0, high=top),
        tuple(curves),
        tuple(_numbers(variation, x)),
        lines=tuple(lines),
        right_axis=_turns_axis(scale_of(tool), top),
        height=225.0,
    )
    what = say("Natural frequencies without damping against the {number}", number=named(variation))
    return {"variation": Chart("variation", tool.title, what, (panel,))}


def number_unit(dimension: str) -> Display:
    """The unit in which a number of a station is told."""
    return display(cast(Dimension, dimension), (), SHOWN_IN.get(dimension))


def named(variation: Variation) -> str:
    """The number that varies, in words."""
    owner, _, last = variation.key.rpartition(".")
    if not owner and KEYS[variation.key] not in ("length", "mass"):
        owner = "ground"
    number = say(NUMBERS.get(last, last.replace("_", " ")))
    return say(PARTS[owner], number=number, station=short(variation.station))


def _apart(variation: Variation) -> bool:
    """Whether the planes differ."""
    vertical, lateral = variation.parameter
    return not np.allclose(vertical, lateral, rtol=1e-6, atol=1e-9)


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
    """The same axis in turns a minute, which grow with the square of lambda."""

    def place(minute: float) -> float:
        return float(np.sqrt(minute / RPM.factor / scale))

    highest = scale * top**2 * RPM.factor
    chosen = [0.0]
    powers = 10.0 ** np.arange(np.floor(np.log10(highest)), np.floor(np.log10(highest)) - 4, -1)
    for digits in ROUNDEST:
        for number in np.multiply.outer(powers, digits).ravel().tolist():
            far = all(abs(place(number) - place(one)) >= APART * top for one in chosen)
            if number <= highest and far:
                chosen.append(number)
    ticks = tuple((place(one), turns_told(one / RPM.factor)) for one in sorted(chosen))
    return Axis(say("natural frequency"), Display("1/min", 1.0), ticks=ticks)


def _now(variation: Variation, x: Axis) -> Iterator[Line]:
    """The number as it is."""
    now = number_of(variation.tool, variation.station, variation.key)
    if np.min(variation.values) <= now <= np.max(variation.values):
        yield Line(now, "now", say("now {value}", value=x.quantity(now)))


def _work(tool: Tool, top: float) -> Iterator[Line]:
    """The speed of the engine at work."""
    if tool.operation is not None:
        at = float(np.sqrt(tool.operation.speed / scale_of(tool)))
        if at <= top:
            text = say("work, {speed} rpm", speed=turns_told(tool.operation.speed))
            yield Line(at, "work", text, "y")


def _numbers(variation: Variation, x: Axis) -> Iterator[Mark]:
    """Numbers of the modes on their lines."""
    assert x.low is not None and x.high is not None
    at = x.low + 0.06 * (x.high - x.low)
    if x.scale == "log":
        at = x.low * (x.high / x.low) ** 0.06
    order = np.argsort(variation.values)
    for number, row in enumerate(variation.parameter[0].T, 1):
        y = float(np.interp(at, variation.values[order], row[order]))
        yield Mark(at, y, str(number), "main", near=3.0, optional=True, sign=False)


# -- a design --------------------------------------------------------------------------------------


def design_charts(found: ToolDesign) -> dict[str, Chart]:
    """``design``."""
    return {"design": design(found)}


def design(found: ToolDesign) -> Chart:
    """What the hand that gets most gets over the band, before and after.

    The worst hand over the band is made better; at some speeds another one may be worse.
    """
    before, after = (_felt(tool, found) for tool in (found.tool, found.better))
    x = engine_axis(found.speed)
    low, high = log_ends([*before, *after], 1.8, 2.2)
    y = Axis("a_hv", RATE, "log", low, high)
    old = (replace(curve, label="", dashed=True) for curve in curves_of(found.speed, before))
    work = work_line(found.tool, x)
    marks = (*hand_peaks(found.better, found.speed, after, y), *work_mark(work, y, above=False))
    curves = (*old, *curves_of(found.speed, after))
    panel = Panel(x, y, curves, marks, lines=work, height=209.0)
    plan = found.tool.design
    one = found.figures[MEASURES.index("rms" if plan is None else plan.measure)]
    what = f"{figure_named(one)}: {shown(one.before)} → {shown(one.after)} m/s²"
    keys = (("dashed ink", say("before")), ("ink", say("after")))
    words = tuple(changes_told(found))
    return Chart("design", found.tool.title, what, (panel,), keys=keys, words=words)


def _felt(tool: Tool, found: ToolDesign) -> list[Named]:
    """a_hv of the hands that count; of all tools in the order of the tool before."""
    plan = found.tool.design
    hands = plan.hands if plan is not None and plan.hands else ()
    felt = grips(respond_tool(tool, found.speed))
    return [Named(name, grip.a_hv) for name, grip in felt.items() if not hands or name in hands]


def changes_told(found: ToolDesign) -> list[str]:
    """What was changed, each in words; where they are many, the first of them."""
    count = len(found.variables)
    words = []
    for one, edge in zip(found.variables, found.edges, strict=True):
        axis = Axis("", number_unit(one.dimension))
        ends = f"{axis.told(one.before)} → {axis.quantity(one.after)}"
        end = f" ({say(ALLOWED[edge])})" if edge else ""
        words.append(f"{short(figure_named(one), 40)}: {ends}{end}")
    if count <= MOST_CHANGES:
        return words
    return [*words[: MOST_CHANGES - 1], say("and {count} more", count=count - MOST_CHANGES + 1)]
