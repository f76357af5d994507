"""A tool over speeds: force on what holds it under a unit force, and what its engine shakes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from operator import itemgetter
from typing import Any, ClassVar, NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.handheld.layout import check_waves
from equipoise.handheld.model import PLANES, Excitation, Station, Tool
from equipoise.handheld.modes import swinging_below
from equipoise.handheld.response import (
    NOTHING,
    ToolResponse,
    checked_speeds,
    loud,
    respond_tool,
    rms_over_time,
    shakes,
)
from equipoise.i18n import Note
from equipoise.quantities import Dimension
from equipoise.results.declaring import Declarations, ResultOutput, values_of
from equipoise.results.result import Result
from equipoise.signals import Array, highest_at

MODES = 6
"""Natural frequencies."""
AROUND = (0.5, 1.25)
"""Range about the working speed, as shares of it, where the tool has no range of speeds."""
SPEEDS = 400
"""Equally spaced speeds in a range by default."""
RESONANCE_OFFSETS = np.array([-0.03, -0.01, -0.003, 0.003, 0.01, 0.03])
"""Shares of a resonance without damping beside which it is looked at."""
HALF = np.array([0.2, 0.4, 0.6, 0.8, 1, 1.3, 1.7, 2.3, 3, 4, 6, 9, 14, 22, 35])
WIDTHS = np.concatenate([-HALF, [0.0], HALF])
"""Half widths of a resonance with damping at which it is looked at."""
NARROW = 1e-9
"""Damping ratio below which a resonance is one without damping."""
PLACES = 401
"""Of the shaft at which the bending moment is looked at."""
LARGEST = 200_000
"""Frequencies times places that are computed at once."""
LOUD = 0.01
"""Share of the largest force from which an order's resonances are looked at."""
QUIET = 0.8
"""A dip is quiet where it lies below so much of the tops beside it, or of the ends of the range."""
ZOOMS, ACROSS = 6, 33
"""How often a lowest place is looked at more closely, and at how many speeds each time."""


SPEED = ResultOutput("speed of the engine", "angular speed", along="speed", column="speed")


def _planes(
    key: str, meaning: str, dimension: Dimension | None, read: str, **options: Any
) -> dict[str, ResultOutput]:
    """An output of the vertical plane, and that of the lateral one.

    read : attribute with both.  column : of the CSV file, where there is one.
    """
    column = options.pop("column", None)
    return {
        key + ("_lateral" if plane else ""): ResultOutput(
            f"{meaning}, {side}",
            dimension,
            read=lambda item, plane=plane: getattr(item, read)[plane],  # type: ignore[misc]
            column=column and f"{column}_{side}",
            rank=plane,
            **options,
        )
        for plane, side in enumerate(PLANES)
    }


@dataclass(frozen=True, eq=False)
class Transmission:
    """Force on the body at a station over the force that shakes, against speed.

    ratio : complex (2, S): vertical by a vertical force, lateral by a lateral one.
    quiet : speeds (rad/s) of each plane at which it is lowest between two resonances.
    lowest : amplitude of the ratio at these.
    """

    ratio: Array
    quiet: tuple[Array, Array]
    lowest: tuple[Array, Array]

    declared: ClassVar[Declarations] = {
        **_planes(
            "ratio",
            "force over that which shakes",
            None,
            "size",
            along="speed",
            column="transmission",
        ),
        **_planes(
            "phase", "by which the force is ahead", "angle", "phase", along="speed", column="phase"
        ),
        **_planes(
            "quiet_speeds", "speeds of least force between resonances", "angular speed", "quiet"
        ),
    }

    @property
    def size(self) -> Array:
        """Amplitude of the force over that of the force that shakes, (2, S)."""
        return np.abs(self.ratio)

    @property
    def phase(self) -> Array:
        """By which the force is ahead of that which shakes, rad, (2, S)."""
        return np.angle(self.ratio)


@dataclass(frozen=True, eq=False, repr=False)
class Transmissions(Result):
    """Of all stations where hands, a harness or the ground hold the tool.

    source : station at which a unit force shakes, once in a turn.
    speed : (S,), rad/s.
    stations : by name; hand, harness and ground there together.
    """

    tool: Tool
    source: str
    speed: Array
    stations: Mapping[str, Transmission]

    blocks_in = "handheld.blocks.transmissions_blocks"
    pictures_in = "figures.tool_charts.transmission_charts"
    declared: ClassVar[Declarations] = {
        "source": ResultOutput("station of the unit force"),
        "speed": SPEED,
        "transmission": ResultOutput(
            "at each station that a hand, a harness or the ground holds",
            of=Transmission.declared,
            family=True,
            read="stations",
            column="{}.",
        ),
    }


def source_of(tool: Tool) -> str:
    """The station at which the first excitation acts; the left end's where there is none."""
    if tool.excitations:
        return tool.excitations[0].station
    if not tool.stations:
        raise ModelError(
            "shaft.stations", Note("there is none; add what sits on the shaft and holds it")
        )
    return min(tool.stations, key=lambda item: item.position).name


def restrained_stations(tool: Tool) -> list[Station]:
    """Stations at which the body or the ground holds the tool."""
    return [
        station for station in tool.stations if station.hand or station.harness or station.grounded
    ]


def transmit(tool: Tool, speed: Array, source: str | None = None) -> Transmissions:
    """Transmission of a unit force to hands, harness and ground, at speeds (S,), rad/s.

    source : station of the force; that of the first excitation if None.
    """
    speed = checked_speeds(speed)
    source = source_of(tool) if source is None else tool.station(source).name
    names = [item.name for item in restrained_stations(tool)]
    if not names:
        raise ModelError("shaft.stations", Note("nothing holds the tool; give a hand or a harness"))

    forces = tuple(  # 1 N in each plane; the planes know nothing of each other
        Excitation(f"unit {plane}", source, force=1.0, direction=plane)  # type: ignore[arg-type]
        for plane in PLANES
    )
    unit = replace(tool, excitations=forces, design=None)
    response = respond_tool(unit, speed)
    result = {}
    for name in names:

        def again(speeds: Array, name: str = name) -> Array:
            return respond_tool(unit, speeds).whole_force(name)[:, 0]

        ratio = response.whole_force(name)[:, 0]
        dips = [lowest_places(speed, np.abs(row), k, again) for k, row in enumerate(ratio)]
        result[name] = Transmission(ratio, *zip(*dips, strict=True))
    return Transmissions(tool, source, speed, result)


def lowest_places(
    speed: Array, size: Array, plane: int, again: Callable[[Array], Array]
) -> tuple[Array, Array]:
    """Speeds at which a curve (S,) is lowest between higher ones, and how low it is there.

    again : computes the curve (2, S') at other speeds.
    """
    inner = np.flatnonzero((size[1:-1] < size[:-2]) & (size[1:-1] <= size[2:])) + 1
    tops = np.maximum.reduceat(size, [0, *inner])  # before, between and after the dips
    inner = inner[size[inner] < QUIET * np.minimum(tops[:-1], tops[1:])]
    low, high = speed[inner - 1], speed[inner + 1]
    lowest = size[inner]
    for _ in range(ZOOMS if inner.size else 0):
        across = low[:, None] + (high - low)[:, None] * np.linspace(0, 1, ACROSS)
        sizes = np.abs(again(across.ravel())[plane]).reshape(across.shape)
        best = np.clip(np.argmin(sizes, axis=1), 1, ACROSS - 2)[:, None]
        lowest = np.take_along_axis(sizes, best, 1)[:, 0]
        low = np.take_along_axis(across, best - 1, 1)[:, 0]
        high = np.take_along_axis(across, best + 1, 1)[:, 0]
    return (low + high) / 2, lowest


class Places(NamedTuple):
    """What some places (X) of the shaft do at some speeds, RMS over time, planes together, (X, S).

    displacement : m.  velocity : m/s.  acceleration : m/s2.  moment : of bending, N m.
    """

    displacement: Array
    velocity: Array
    acceleration: Array
    moment: Array


def _over_speeds(key: str, meaning: str, dimension: Dimension) -> ResultOutput:
    return ResultOutput(meaning, dimension, read=itemgetter(key), along="speed", column=key)


AT_PLACE: Declarations = {
    "position": ResultOutput("from the left end", "length", read=itemgetter("position")),
    "displacement": _over_speeds("displacement", "RMS over time, planes together", "length"),
    "velocity": _over_speeds("velocity", "RMS over time, planes together", "speed"),
    "acceleration": _over_speeds("acceleration", "RMS over time, planes together", "acceleration"),
    "moment": _over_speeds("moment", "bending moment, RMS over time, planes together", "torque"),
}
AT_STATION: Declarations = AT_PLACE | {
    "forces": ResultOutput(
        "force on hand, harness and ground, RMS over time, planes together",
        "force",
        family=True,
        read=itemgetter("forces"),
        along="speed",
        column="force_{}",
    ),
    "power": ResultOutput(
        "mean power into hand, harness, ground and absorber",
        "power",
        family=True,
        read=itemgetter("power"),
        along="speed",
        column="power_{}",
    ),
}
"""What a place of the shaft does over speeds (S,), and a station besides."""


@dataclass(frozen=True, eq=False, repr=False)
class ToolSweep(Result):
    """A tool over speeds (S,) of its engine, rad/s.

    transmissions : of a unit force, to what holds the tool; None where nothing does.
    response : under what shakes it; None where nothing does.
    further : places (m) that are reported besides the stations.
    """

    blocks_in = "handheld.blocks.sweep_blocks"
    headline_in = "handheld.blocks.sweep_headline"

    tool: Tool
    speed: Array
    transmissions: Transmissions | None
    response: ToolResponse | None
    further: tuple[float, ...] = ()

    def places(self, places: Sequence[float] | Array) -> Places:
        """What places (X), m, do at every speed; a `ModelError` where nothing shakes the tool."""
        frequency, parts = self.required_response.frequency, []
        block = max(1, LARGEST // frequency.size)  # a few at once, so that memory lasts
        for k in range(0, max(1, len(places)), block):
            line = self.required_response.line(places[k : k + block])
            moved = line.displacement
            pair = (moved, moved * frequency, moved * frequency**2, line.moment)
            parts.append(list(map(rms_over_time, pair)))
        return Places(*map(np.concatenate, zip(*parts, strict=True)))

    @property
    def required_response(self) -> ToolResponse:
        """The response; a `ModelError` where nothing shakes the tool."""
        if self.response is None:
            raise ModelError("excitations", NOTHING)
        return self.response

    @cached_property
    def largest_moment(self) -> tuple[Array, Array]:
        """Largest RMS bending moment (S,), N m, and where in the shaft it is, m."""
        length = self.tool.shaft.length
        stations = np.array([station.position for station in self.tool.stations])
        both_sides = np.concatenate([stations, np.nextafter(stations, 0.0)])  # where it may jump
        where = np.unique(np.concatenate([np.linspace(0, length, PLACES), both_sides]))
        moment = self.places(where).moment
        at = highest_at(moment.T)
        return moment[at, np.arange(len(self.speed))], where[at]

    def force(self, station: str) -> dict[str, Array]:
        """Force (S,) on hand, harness and ground at a station, N, RMS over time and planes."""
        return {
            part: rms_over_time(force)
            for part, force in self.required_response.forces(station).items()
        }

    def power(self, station: str) -> dict[str, Array]:
        """Mean power (S,), W, that goes into hand, harness, ground and absorber at a station."""
        return {
            part: np.sum(each, axis=0)
            for part, each in self.required_response.power(station).items()
        }

    def to_dict(self, wanted: Collection[str] | None = None) -> dict[str, Any]:
        """As plain values in SI units.

        wanted : keys that are needed of those that take time; None for all.
        """
        return values_of(self, self.declared, wanted)

    def _moved(self, places: Sequence[float]) -> list[dict[str, Any]]:
        """What each of some places does, by name of the figure."""
        at = self.places(places)._asdict()
        return [
            {"position": place, **{key: rows[k] for key, rows in at.items()}}
            for k, place in enumerate(places)
        ]

    @property
    def station_values(self) -> dict[str, Any]:
        """What each station does, and what holds it bears."""
        stations = self.tool.stations
        moved = zip(stations, self._moved([station.position for station in stations]), strict=True)
        return {
            item.name: {**row, "forces": self.force(item.name), "power": self.power(item.name)}
            for item, row in moved
        }

    @property
    def further_values(self) -> list[dict[str, Any]]:
        """What the further places do."""
        return self._moved(self.further)

    declared: ClassVar[Declarations] = {
        "speed": SPEED,
        "transmissions": ResultOutput(
            "of a unit force",
            of=Transmissions.declared,
            spliced=True,
            present="transmissions",
            column="",
        ),
        "orders": ResultOutput("events in a turn", read="response.orders", present="response"),
        "stations": ResultOutput(
            "of each station",
            of=AT_STATION,
            family=True,
            read="station_values",
            present="response",
            slow=True,
            column="{}.",
        ),
        "largest_moment": ResultOutput(
            "of the largest bending moment",
            of={
                "moment": ResultOutput(
                    "RMS over time", "torque", read=itemgetter(0), along="speed"
                ),
                "place": ResultOutput(
                    "from the left end", "length", read=itemgetter(1), along="speed"
                ),
            },
            present="response",
            slow=True,
        ),
        "further": ResultOutput(
            "of each place given by `--at`",
            of=AT_PLACE,
            many=True,
            read="further_values",
            named=lambda row: f"{row['position']:.6g} m",
            present="response",
            column="{}.",
        ),
    }


def sweep_tool(tool: Tool, speed: Array, further: Sequence[float] = ()) -> ToolSweep:
    """A tool at speeds (S,) of its engine, rad/s.

    further : places (m) that are reported besides the stations.

    Raises
    ------
    ModelError : nothing holds it and nothing shakes it; as `respond_tool`.
    """
    transmissions = transmit(tool, speed) if restrained_stations(tool) else None
    response = respond_tool(tool, speed) if tool.excitations else None
    if transmissions is None and response is None:
        raise ModelError(
            "shaft", Note("nothing holds the tool and nothing shakes it; add a station")
        )
    tool_sweep = ToolSweep(tool, np.asarray(speed), transmissions, response, tuple(further))
    if further:
        tool_sweep.places(further)  # refuse a place off the shaft at once
    return tool_sweep


def default_answers(tool: Tool) -> list[str]:
    """The answers of ``modes``, ``respond`` and ``exposure`` that the tool has the tables for."""
    if tool.operation is None or not tool.stations:
        return ["modes"]
    labels = ["exposure"] if tool.excitations and tool.grips else []
    return ["modes", "respond", *labels]


def default_speeds(tool: Tool) -> tuple[float, float] | None:
    """Lowest and highest speed of the engine, rad/s; None where the tool has no operation."""
    operation = tool.operation
    if operation is None:
        return None
    if operation.speeds:
        return operation.speeds[0], operation.speeds[1]
    return AROUND[0] * operation.speed, AROUND[1] * operation.speed


def speeds_between(tool: Tool, low: float, high: float, count: int = SPEEDS) -> Array:
    """Equally spaced speeds, rad/s, and more of them about the resonances of loud orders.

    Raises `ModelError` as `layout.check_waves`.
    """
    orders = {shake.order for shake in loud(shakes(tool), high, LOUD)} | {1.0}
    check_waves(tool, max(orders) * high)
    values = swinging_below(tool, max(orders) * high)
    wide = np.abs(values.real) > NARROW * values.imag
    about = [
        (values.imag[~wide, None] * (1 + RESONANCE_OFFSETS)).ravel(),
        (values.imag[wide, None] + np.abs(values.real[wide, None]) * WIDTHS).ravel(),
    ]
    near_resonances = [part / order for order in orders for part in about]
    speeds = np.unique(np.concatenate([np.linspace(low, high, count), *near_resonances]))
    return np.asarray(speeds[(speeds >= low) & (speeds <= high)])
