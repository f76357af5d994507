"""A tool from the side, as it is drawn: at rest, or deflected."""

from __future__ import annotations

import numpy as np

from equipoise.handheld.model import Excitation, Station, Tool
from equipoise.handheld.shaft import Shaft, Tube
from equipoise.signals import Array
from equipoise.symbols.tool import SeatSign, ToolScene, TubeSign

AT_END = 0.03
"""Share of the shaft within which a station is at an end."""


def side_of(tool: Tool, along: Array | None = None, deflected: Array | None = None) -> ToolScene:
    """The tool at rest, or at N instants.

    along : places (X,), m.  deflected : displacements (N, X), m, as large as they are to be drawn.
    """
    if along is None or deflected is None:
        along, deflected = np.array([0.0, tool.shaft.length]), np.zeros((1, 2))
    motor = _motor(tool)
    seats = tuple(_seat(tool, station, motor) for station in tool.stations)
    return ToolScene(tuple(_tubes(tool.shaft)), seats, along, deflected)


def _motor(tool: Tool) -> Station | None:
    """Where what turns with the engine shakes; the heaviest such station."""
    shaking = {excitation.station for excitation in tool.excitations if abs(excitation.ratio) == 1}
    matching_stations = [station for station in tool.stations if station.name in shaking]
    return max(matching_stations, key=lambda item: item.mass, default=None)


def _seat(tool: Tool, station: Station, motor: Station | None) -> SeatSign:
    acting = [cause for cause in tool.excitations if cause.station == station.name]
    part = ""
    if station is motor:
        part = "engine" if any(cause.linkage is not None for cause in acting) else "motor"
    elif motor is not None and _end(tool, station) not in (0, _end(tool, motor)):
        part = "blade"
    return SeatSign(
        station.name,
        station.position,
        station.mass,
        0.0 if station.absorber is None else station.absorber.mass,
        0 if station.hand is None else station.hand.hands,
        station.harness is not None,
        station.grounded,
        any(station.rotational_stiffness) or any(station.rotational_damping),
        "turns" if any(map(_turns, acting)) else "force" if acting else "",
        part,
    )


def _turns(cause: Excitation) -> bool:
    return cause.force is None or cause.direction == "rotating"


def _end(tool: Tool, station: Station) -> int:
    """-1 at the left end of the shaft, 1 at the right one, 0 between."""
    share = station.position / tool.shaft.length
    return -1 if share < AT_END else int(share > 1 - AT_END)


def _tubes(shaft: Shaft) -> list[TubeSign]:
    """Parts of the shaft; a part without a diameter, as where tubes overlap, has the largest
    diameter of its neighbours.
    """
    own = {(part.start, part.stop): part.profile for part in shaft.segments}
    values = [(a, b, own.get((a, b), shaft.profile)) for a, b, _ in shaft.pieces]
    wide = [item.outer_diameter if isinstance(item, Tube) else 0.0 for *_, item in values]
    both = [max(wide[max(k - 1, 0) : k + 2]) for k in range(len(wide))]
    sizes = (own or neighbor for own, neighbor in zip(wide, both, strict=True))
    return [TubeSign(a, b, size) for (a, b, _), size in zip(values, sizes, strict=True)]
