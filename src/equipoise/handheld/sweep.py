"""What is told of a tool where nothing in particular is asked: which answers, at which speeds."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.handheld.model import PLANES, Tool
from equipoise.handheld.modes import swinging_below
from equipoise.handheld.response import (
    NOTHING,
    ToolResponse,
    loud,
    respond_tool,
    rms_over_time,
    shakes,
)
from equipoise.handheld.transmission import Transmissions, held, transmit
from equipoise.results.result import Result
from equipoise.signals import highest_at

MODES = 6
"""Natural frequencies."""
AROUND = (0.5, 1.25)
"""Range about the working speed, as shares of it, where the tool tells none."""


def default_answers(tool: Tool) -> list[str]:
    """Those of ``modes``, ``respond`` and ``exposure`` that the tool has what is needed for."""
    if tool.operation is None or not tool.stations:
        return ["modes"]
    shaken = ["exposure"] if tool.excitations and tool.grips else []
    return ["modes", "respond", *shaken]


def default_speeds(tool: Tool) -> tuple[float, float] | None:
    """Lowest and highest speed of the engine, rad/s; None where the tool tells none."""
    operation = tool.operation
    if operation is None:
        return None
    if operation.speeds:
        return operation.speeds[0], operation.speeds[1]
    return AROUND[0] * operation.speed, AROUND[1] * operation.speed


Array = np.ndarray[Any, Any]

SPEEDS = 400
"""Equally spaced speeds in a range, if not told otherwise."""
BESIDE = np.array([-0.03, -0.01, -0.003, 0.003, 0.01, 0.03])
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


@dataclass(frozen=True, eq=False)
class Places:
    """What some places (X) of the shaft do at some speeds, RMS over time, planes together, (X, S).

    displacement : m.  velocity : m/s.  acceleration : m/s2.  moment : of bending, N m.
    """

    displacement: Array
    velocity: Array
    acceleration: Array
    moment: Array


@dataclass(frozen=True, eq=False, repr=False)
class ToolSweep(Result):
    """A tool over speeds (S,) of its engine, rad/s.

    transmissions : of a unit force, to what holds the tool; None where nothing does.
    response : under what shakes it; None where nothing does.
    further : places (m) that are told of besides the stations.
    """

    tool: Tool
    speed: Array
    transmissions: Transmissions | None
    response: ToolResponse | None
    further: tuple[float, ...] = ()

    def places(self, places: Sequence[float] | Array) -> Places:
        """What places (X), m, do at every speed; a `ModelError` where nothing shakes the tool."""
        frequency = self.shaken.frequency
        block = max(1, LARGEST // frequency.size)
        parts = [self._some(places[k : k + block]) for k in range(0, max(1, len(places)), block)]
        return Places(*map(np.concatenate, zip(*parts, strict=True)))

    def _some(self, places: Sequence[float] | Array) -> tuple[Array, ...]:
        """The same of a few places, so that memory lasts."""
        line, frequency = self.shaken.line(places), self.shaken.frequency
        moved = line.displacement
        return tuple(
            map(rms_over_time, (moved, moved * frequency, moved * frequency**2, line.moment))
        )

    @property
    def shaken(self) -> ToolResponse:
        """The response; a `ModelError` where nothing shakes the tool."""
        if self.response is None:
            raise ModelError("excitations", NOTHING)
        return self.response

    @cached_property
    def largest_moment(self) -> tuple[Array, Array]:
        """Largest RMS bending moment (S,), N m, and where in the shaft it is, m."""
        length = self.tool.shaft.length
        stations = np.array([one.position for one in self.tool.stations])
        beside = np.concatenate([stations, np.nextafter(stations, 0.0)])  # where it may jump
        where = np.unique(np.concatenate([np.linspace(0, length, PLACES), beside]))
        moment = self.places(where).moment
        at = highest_at(moment.T)
        return moment[at, np.arange(len(self.speed))], where[at]

    def force(self, station: str) -> dict[str, Array]:
        """Force (S,) on hand, harness and ground at a station, N, RMS over time and planes."""
        return {part: rms_over_time(force) for part, force in self.shaken.forces(station).items()}

    def power(self, station: str) -> dict[str, Array]:
        """Mean power (S,), W, that goes into hand, harness, ground and absorber at a station."""
        return {part: np.sum(each, axis=0) for part, each in self.shaken.power(station).items()}

    def to_dict(self, wanted: Collection[str] | None = None) -> dict[str, Any]:
        """As plain values in SI units.

        wanted : keys that are needed of those that take time; None for all.
        """
        found: dict[str, Any] = {"speed": self.speed}
        if self.transmissions is not None:
            found |= self.transmissions.to_dict()
        if self.response is None:
            return found
        found["orders"] = self.response.orders
        if wanted is None or "stations" in wanted:
            found["stations"] = self._stations()
        if wanted is None or "largest_moment" in wanted:
            moment, place = self.largest_moment
            found["largest_moment"] = {"moment": moment, "place": place}
        found["further"] = self._further()
        return found

    def _stations(self) -> dict[str, Any]:
        positions = [one.position for one in self.tool.stations]
        at = self.places(positions)
        return {
            one.name: {
                "position": one.position,
                "displacement": at.displacement[k],
                "velocity": at.velocity[k],
                "acceleration": at.acceleration[k],
                "moment": at.moment[k],
                "forces": self.force(one.name),
                "power": self.power(one.name),
            }
            for k, one in enumerate(self.tool.stations)
        }

    def _further(self) -> list[dict[str, Any]]:
        at = self.places(self.further)
        return [
            {"position": place, **{key: getattr(at, key)[k] for key in UNITS}}
            for k, place in enumerate(self.further)
        ]

    def columns(self) -> list[tuple[str, str, Array]]:
        """Figures against speed, as name, unit and values (S,)."""
        found: list[tuple[str, str, Array]] = [("speed", "rad/s", self.speed)]
        if self.transmissions is not None:
            for name, one in self.transmissions.stations.items():
                for plane, label in enumerate(PLANES):
                    found.append((f"{name}.transmission_{label}", "1", one.size[plane]))
                    found.append((f"{name}.phase_{label}", "rad", one.phase[plane]))
        if self.response is not None:
            for name, station in self._stations().items():
                for key, unit in UNITS.items():
                    found.append((f"{name}.{key}", unit, station[key]))
                found += [
                    (f"{name}.force_{part}", "N", each) for part, each in station["forces"].items()
                ]
                found += [
                    (f"{name}.power_{part}", "W", each) for part, each in station["power"].items()
                ]
            for row in self._further():
                name = f"{row['position']:.6g} m"
                found += [(f"{name}.{key}", unit, row[key]) for key, unit in UNITS.items()]
        return found


UNITS = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s^2", "moment": "N m"}


def sweep_tool(tool: Tool, speed: Array, further: Sequence[float] = ()) -> ToolSweep:
    """A tool at speeds (S,) of its engine, rad/s.

    further : places (m) that are told of besides the stations.

    Raises
    ------
    ModelError : nothing holds it and nothing shakes it; as `respond_tool`.
    """
    transmissions = transmit(tool, speed) if held(tool) else None
    response = respond_tool(tool, speed) if tool.excitations else None
    if transmissions is None and response is None:
        raise ModelError("shaft", "nothing holds the tool and nothing shakes it; add a station")
    found = ToolSweep(tool, np.asarray(speed), transmissions, response, tuple(further))
    if further:
        found.places(further)  # a place off the shaft is told at once
    return found


def speeds_between(tool: Tool, low: float, high: float, count: int = SPEEDS) -> Array:
    """Equally spaced speeds, rad/s, and more of them about the resonances of loud orders."""
    orders = {shake.order for shake in loud(shakes(tool), high, LOUD)} | {1.0}
    found = swinging_below(tool, max(orders) * high)
    wide = np.abs(found.real) > NARROW * found.imag
    about = [
        (found.imag[~wide, None] * (1 + BESIDE)).ravel(),
        (found.imag[wide, None] + np.abs(found.real[wide, None]) * WIDTHS).ravel(),
    ]
    beside = [part / order for order in orders for part in about]
    speeds = np.unique(np.concatenate([np.linspace(low, high, count), *beside]))
    return np.asarray(speeds[(speeds >= low) & (speeds <= high)])
