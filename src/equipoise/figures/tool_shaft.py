"""Charts along the shaft of a hand-held tool: its modes, and the bending moment at work."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from equipoise.figures.shared import by_name, continued, groups
from equipoise.figures.style import short
from equipoise.handheld.exposed import grips
from equipoise.handheld.response import respond_tool
from equipoise.i18n import decimals, say, to_say
from equipoise.results.charts import (
    RPM,
    Array,
    Axis,
    Chart,
    Curve,
    Line,
    Mark,
    Panel,
    PlaceLabel,
    quantity,
    shown,
)
from equipoise.signals import highest_at

if TYPE_CHECKING:
    from equipoise.handheld.layout import ShaftDeflection as ShaftLine
    from equipoise.handheld.model import Station, Tool
    from equipoise.handheld.modes import PlaneModes, ToolModes
    from equipoise.handheld.response import ToolResponse


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
    for suffix, numbers in groups(every, MOST_SHAPES):
        panels = [_shape(modes, modes.planes[plane], k) for k in numbers]
        panels[0] = replace(panels[0], flags=station_flags(modes.tool))
        what = label + continued(numbers, every)
        yield Chart(name + suffix, modes.tool.title, what, tuple(panels), keys=keys)


def _shape(modes: ToolModes, result: PlaneModes, number: int) -> Panel:
    """One shape with its stations and nodes; its number at the left, its figures at the right."""
    shape, x = result.shapes[number], modes.places
    marks = [
        Mark(station.position, float(np.interp(station.position, x, shape)), "", kind_of(station))
        for station in modes.tool.stations
    ]
    marks += [
        Mark(float(node), 0.0, f"{MM * node:.0f}", "node", optional=True, near=5.0)
        for node in result.nodes[number]
    ]
    hertz = float(result.cycles_per_second[number])
    if hertz:
        minute = turns_told(float(result.frequency[number]))
        lines = [
            f"{shown(hertz)} Hz",
            f"{minute} 1/min",
            decimals(f"λ = {result.parameter[number]:.3f}"),
        ]
    else:
        lines = [say("free:"), *wrap(result.rigid[number], LETTERS)]
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
        keys.append((role, say("order {order}", order=shown(float(tool_response.orders[k])))))
    if {plane for _, plane in displaced} == {0, 1}:
        keys.append(("other end", say("lateral plane")))
    what = say("RMS of the bending moment, and shape of each order when it is largest")
    text = f"{what}; {turns_told(speed)} rpm"
    panels = _moments(tool, places, line, loudest), _shapes_of_orders(tool, places, displaced)
    return Chart("moment", tool.title, text, panels, keys=tuple(keys))


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
