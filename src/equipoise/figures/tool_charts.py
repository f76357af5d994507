"""Charts along the shaft of a hand-held tool and over the speed of its engine, of the studies of a
tool, and of a design made better.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from math import pi
from textwrap import wrap
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.exposure.blocks import VERDICTS
from equipoise.exposure.daily import ACTION, EIGHT_HOURS, LIMIT
from equipoise.exposure.weighting import factor
from equipoise.figures.chart_parts import (
    SpeedCurve,
    by_name,
    curves_of,
    ends,
    groups,
    log_ends,
    ordered,
)
from equipoise.figures.style import KINDS, short
from equipoise.handheld.blocks import figure_named
from equipoise.handheld.design_plan import MEASURES
from equipoise.handheld.frequencies import scale_of
from equipoise.handheld.hand_exposure import grips
from equipoise.handheld.model import number_of
from equipoise.handheld.response import respond_tool
from equipoise.handheld.shaft import KEYS
from equipoise.i18n import capital, decimals, localized, say, to_say
from equipoise.quantities import Dimension, Display, display
from equipoise.results.charts import (
    DEGREES,
    RPM,
    Area,
    Axis,
    Chart,
    Curve,
    Line,
    Mark,
    Panel,
    PlaceLabel,
    four_digits,
    quantity,
)
from equipoise.signals import Array, highest_at

if TYPE_CHECKING:
    from equipoise.handheld.design import ToolDesign
    from equipoise.handheld.hand_exposure import ToolExposure
    from equipoise.handheld.layout import ShaftDeflection as ShaftLine
    from equipoise.handheld.model import Station, Tool
    from equipoise.handheld.modes import DeterminantChart, PlaneModes, ToolModes, Variation
    from equipoise.handheld.response import ToolResponse
    from equipoise.handheld.sweep import Transmissions


MM = 1000.0
MOST_MODES, MOST_SHAPES, MOST_NAMES, LONGEST = 24, 6, 24, 20
"""Natural frequencies that are marked; shapes in a picture; stations named; signs of a name."""
OVERHANG, BEFORE = 0.02, 1e-9
"""Share of the shaft that the axis goes on beyond its ends; m before a station, where the moment is
that at its left."""
REACH, LETTERS = 1.42, 18
"""Upper end of the axis of a shape, over its largest displacement; letters in a line of what a free
motion is called."""
POINTS, MOST_ORDERS, MATTERS = 401, 3, 1e-3
"""Places along the shaft; orders whose moment and shape are drawn; share of the largest
displacement from which a plane's shape is drawn."""
ORDER_ROLES = ("kind 0", "kind 1", "kind 3")
SIGNS = {
    "hand": to_say("hand"),
    "harness or ground": to_say("harness or ground"),
    "station": to_say("station"),
}
"""What holds a station, in words; the last holds nothing."""


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
    beyond = OVERHANG * tool.shaft.length
    label = say("place on the shaft from its left end")
    return Axis.of(label, "length", [0.1], low=-beyond, high=tool.shaft.length + beyond)


def shaft_lines(tool: Tool) -> tuple[Line, ...]:
    """A thin line at every station."""
    return tuple(Line(station.position, "station line") for station in tool.stations)


def station_flags(tool: Tool) -> tuple[PlaceLabel, ...]:
    """Names of the stations; where there are too many, of those that matter most."""

    def weight(station: Station) -> tuple[bool, bool, float]:
        is_so = any(excitation.station == station.name for excitation in tool.excitations)
        return kind_of(station) != "station", is_so, station.mass

    chosen = sorted(tool.stations, key=weight, reverse=True)[:MOST_NAMES]
    ranked = sorted(chosen, key=lambda station: station.position)
    return tuple(
        PlaceLabel(
            item.position, (short(item.name, LONGEST),), 1.0 + len(chosen) - chosen.index(item)
        )
        for item in ranked
    )


def mode_charts(modes: ToolModes) -> dict[str, Chart]:
    """``modes``, and ``modes-lateral`` where the planes differ.

    Many modes go on in ``modes-2`` and so on.
    """
    planes = (0,) if modes.alike else (0, 1)
    return by_name(chart for plane in planes for chart in shapes(modes, plane))


def shapes(modes: ToolModes, plane: int) -> Iterator[Chart]:
    """Shapes without damping in one plane, some in each picture: Fig. 5 of Nagamine and Irie."""
    every = range(len(modes.planes[plane].frequency))
    name = "modes-lateral" if plane else "modes"
    label = f"{say('Shapes of free vibration without damping')}, {plane_named(plane, modes.alike)}"
    kinds = {kind_of(station) for station in modes.tool.stations}
    keys = (
        ("shape", say("one end of the swing")),
        ("other end", say("the other")),
        ("node", say("node, mm")),
        *((kind, say(text)) for kind, text in SIGNS.items() if kind in kinds),
    )
    for suffix, numbers, which in groups(every, MOST_SHAPES):
        panels = [_shape(modes, modes.planes[plane], k) for k in numbers]
        panels[0] = replace(panels[0], flags=station_flags(modes.tool))
        what = label + which
        caption = to_say("Shapes of the natural vibrations of the shaft.")
        own = name + suffix
        yield Chart(own, modes.tool.title, what, tuple(panels), keys=keys, caption=caption)


def _shape(modes: ToolModes, result: PlaneModes, number: int) -> Panel:
    """One shape with its stations and nodes; its number at the left, its figures at the right."""
    shape, x = result.shapes[number], modes.places
    marks = [
        Mark(station.position, float(np.interp(station.position, x, shape)), "", kind_of(station))
        for station in modes.tool.stations
    ]
    marks += [
        Mark(float(node), 0.0, f"{MM * node:.0f}", "node", optional=True, distance=5.0)
        for node in result.nodes[number]
    ]
    hertz = float(result.cycles_per_second[number])
    if hertz:
        minute = rpm_text(float(result.frequency[number]))
        lines = [
            f"{four_digits(hertz)} Hz",
            f"{minute} 1/min",
            decimals(f"λ = {result.parameter[number]:.3f}"),
        ]
    else:
        lines = [say("free:"), *wrap(localized(result.rigid[number]), LETTERS)]
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


def rpm_text(speed: float) -> str:
    """A speed or frequency, given in rad/s, as text in rpm: four digits, or all of the integer."""
    minute = speed * RPM.factor
    return four_digits(minute) if minute < 1e4 else f"{minute:.0f}"


# -- bending moment --------------------------------------------------------------------------------


def response_charts(response: ToolResponse, speed: float | None = None) -> dict[str, Chart]:
    """``moment``: bending moment and displacement along the shaft at one speed of the engine.

    speed : rad/s; that of work if None, or else the one at which the hands get most.
    """
    return by_name([moment(response, speed)])


def moment(response: ToolResponse, speed: float | None) -> Chart:
    """RMS of the bending moment, and the shape of each order when it is largest."""
    tool = response.tool
    speed = speed_shown(response) if speed is None else speed
    tool_response = respond_tool(tool, speed)
    at = np.array([station.position for station in tool.stations])  # and both sides of each
    places = np.concatenate([np.linspace(0.0, tool.shaft.length, POINTS), at, at - BEFORE])
    places = np.unique(np.clip(places, 0.0, tool.shaft.length))
    line = tool_response.line(places)
    size = np.max(np.sum(np.abs(line.moment[..., 0]) ** 2, axis=1), axis=0)
    loudest = [int(k) for k in np.argsort(-size, kind="stable")[:MOST_ORDERS]]
    displaced = _displaced(line, loudest)
    keys = [("strong", say("all orders, root of squares"))]
    for role, k in zip(ORDER_ROLES, loudest, strict=False):
        keys.append((role, say("order {order}", order=four_digits(float(tool_response.orders[k])))))
    if {plane for _, plane in displaced} == {0, 1}:
        keys.append(("other end", say("lateral plane")))
    what = say("RMS of the bending moment, and shape of each order when it is largest")
    text = f"{what}; {rpm_text(speed)} rpm"
    panels = _moments(tool, places, line, loudest), _shapes_of_orders(tool, places, displaced)
    caption = to_say("Bending moment and displacement along the shaft.")
    return Chart("moment", tool.title, text, panels, keys=tuple(keys), caption=caption)


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
        moved = [np.abs(response.displacement(station.name)) for station in response.tool.stations]
        felt = np.max([np.sum(item**2, axis=(0, 1)) for item in moved], axis=0)
    return float(speeds[highest_at(felt, smooth=False)])


def _displaced(line: ShaftLine, loudest: list[int]) -> dict[tuple[int, int], Array]:
    """(Place among the loudest, plane) -> displacement, m, at the instant when it is largest.

    The lateral plane is left out where it does the same as the vertical one.
    """
    moved = line.displacement[..., 0]
    least = MATTERS * float(np.max(np.abs(moved)))
    arrays: dict[tuple[int, int], Array] = {}
    for number, k in enumerate(loudest):
        vertical, lateral = (at_largest(moved[:, plane, k]) for plane in range(2))
        if np.max(np.abs(vertical)) > least:
            arrays[number, 0] = vertical
        if np.max(np.abs(lateral)) > least and not np.allclose(lateral, vertical, atol=least):
            arrays[number, 1] = lateral
    return arrays


def at_largest(amplitude: Array) -> Array:
    """Where an amplitude (X,) is at the instant when it is largest."""
    turned = np.exp(-0.5j * np.angle(np.sum(amplitude**2)))
    shape = np.real(amplitude * turned)
    return np.asarray(shape * np.sign(shape[highest_at(np.abs(shape), smooth=False)] or 1.0))


def _moments(tool: Tool, places: Array, line: ShaftLine, loudest: list[int]) -> Panel:
    """RMS over time of all orders and planes, and of both planes of the loudest orders."""
    squares = np.sum(np.abs(line.moment[..., 0]) ** 2, axis=1) / 2
    total = np.sqrt(np.sum(squares, axis=1))
    y = Axis.of(say("moment"), "torque", total, low=0.0, room=0.18)
    curves = [Curve(places, total, "", "strong")]
    if len(loudest) > 1 or squares.shape[1] > 1:
        for role, k in zip(ORDER_ROLES, loudest, strict=False):
            curves.append(Curve(places, np.sqrt(squares[:, k]), "", role))
    k = int(highest_at(total, smooth=False))
    at, top = float(places[k]), float(total[k])
    place = quantity(round(at, 3), "length")
    text = say("{value} at {place}", value=y.quantity(top), place=place)
    mark = Mark(at, top, text, "ink", 60.0, sign=False)
    return Panel(
        shaft_axis(tool),
        y,
        tuple(curves),
        (mark,),
        lines=shaft_lines(tool),
        flags=station_flags(tool),
        height=150.0,
    )


def _shapes_of_orders(tool: Tool, places: Array, shapes: Mapping[tuple[int, int], Array]) -> Panel:
    every = np.array([*shapes.values()]) if shapes else np.zeros((1, len(places)))
    y = Axis.of(say("displacement"), "length", [*every.ravel(), 0.0], room=0.12)
    curves = tuple(
        Curve(places, shape, "", ORDER_ROLES[number], dashed=bool(plane))
        for (number, plane), shape in shapes.items()
    )
    curves = curves or (Curve(places, every[0], "", "faint"),)
    return Panel(shaft_axis(tool), y, curves, lines=shaft_lines(tool), height=150.0)


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
    names = {line.at: say("work, {speed} rpm", speed=rpm_text(line.at)) for line in lines}
    return tuple(
        Mark(at, place, name, "work", 0.0, sign=False, distance=3.0) for at, name in names.items()
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
    ticks = tuple((float(np.radians(at)), four_digits(at)) for at in range(-180, 181, 90))
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
    return Chart(
        name,
        transmissions.tool.title,
        what,
        (size, phases),
        keys=tuple(keys),
        caption=to_say("Share of a shaking force that comes to what holds the tool."),
    )


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
            yield Mark(speed, at, rpm_text(speed), role, -90.0, optional=True)


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
    caption = to_say("Acceleration of the hands against speed of the engine.")
    return _of_hands(exposure, "acceleration", read, allowed, what, say("RMS"), caption)


def weighted(exposure: ToolExposure) -> Chart:
    """Weighted total value of each hand, with action and limit value for the time of work."""
    read = {name: grip.a_hv for name, grip in exposure.grips.items()}
    allowed = {
        role: np.full(len(exposure.speed), level) for role, level in levels(exposure).items()
    }
    what = say("Weighted acceleration; dotted: action and limit value")
    caption = to_say("Daily exposure of the hands, with what is allowed.")
    chart = _of_hands(exposure, "exposure", read, allowed, what, say(TOTAL_VALUE), caption)
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
    text = {"a8": four_digits(exposure.a8), "hand": short(exposure.worst)}
    return replace(chart, what=f"{chart.what}; " + say("A(8) = {a8} m/s² at {hand}", **text))


TOTAL_VALUE = to_say("vibration total value aₕᵥ (ISO 5349-1)")
"""Name of the axis along which the weighted vibration of hands is drawn."""


def duration_of(exposure: ToolExposure) -> float:
    """Time of work a day, s; eight hours by default."""
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
    caption: str,
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
    hours = say("{hours} h a day", hours=four_digits(duration_of(exposure) / 3600))
    return Chart(name, tool.title, f"{what}, {hours}", (panel,), caption=caption)


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
            text = say("{value} at {speed} rpm", value=y.quantity(size), speed=rpm_text(at))
            yield Mark(at, size, text, f"kind {number}", 20.0, sign=False, optional=True)


# -- numbers of the studies of a tool --------------------------------------------------------------

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
    caption = to_say("Vibration of the worst hand over the band of speeds, before and after.")
    return Chart("design", result.tool.title, what, (panel,), keys=keys, caption=caption)


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
