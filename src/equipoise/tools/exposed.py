"""What the hands on a tool get: weighted acceleration, and what a day of it amounts to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.exposure.daily import Exposure, Task, daily_exposure
from equipoise.exposure.iso_22867 import equivalent
from equipoise.exposure.weighting import squared_factor
from equipoise.results.result import Result
from equipoise.tools.model import Tool, Work
from equipoise.tools.response import ToolResponse, respond_tool

Array = np.ndarray[Any, Any]

WORKING, IDLING, RACING = "working", "idling", "racing"
NO_HANDS = "no hand holds the tool; give a station a hand with its stiffness, or its impedance"
NO_OPERATION = (
    'missing; add the table [operation] with the speed of the engine, such as speed = "7000 rpm"'
)


def weighted_squares(frequency: Any, displacement: Any) -> Any:
    """Mean square of the weighted acceleration (m/s2)^2 of harmonic displacements, m.

    frequency : rad/s.
    displacement : complex amplitudes of the same shape, with or without derivatives.
    """
    square = frequency * frequency
    moved = displacement * displacement.conj()
    return moved * (square * square * squared_factor(square / (4 * pi**2)) / 2)


@dataclass(frozen=True, eq=False)
class Grip:
    """Vibration where a hand holds, against the speed of the engine (S,), m/s2.

    acceleration : RMS in the vertical and the lateral plane, (2, S).
    a_hw : the same, weighted by Wh.
    """

    acceleration: Array
    a_hw: Array

    @property
    def a_hv(self) -> Array:
        """Total value (S,); along the shaft nothing moves in bending."""
        return np.asarray(np.sqrt(np.sum(self.a_hw**2, axis=0)))


def grips(response: ToolResponse) -> dict[str, Grip]:
    """Vibration of every station that a hand holds."""
    if not response.tool.grips:
        raise ModelError("shaft.stations", NO_HANDS)
    frequency = response.frequency
    found = {}
    for station in response.tool.grips:
        moved = response.displacement(station.name)
        weighted = np.sum(np.real(weighted_squares(frequency, moved)), axis=1)
        plain = np.sum(np.abs(frequency**2 * moved) ** 2, axis=1) / 2
        found[station.name] = Grip(np.sqrt(plain), np.sqrt(weighted))
    return found


@dataclass(frozen=True, eq=False, repr=False)
class ToolExposure(Result):
    """What the hands on a tool get, over a range of speeds and in a day.

    response : over the range of speeds.
    grips : by station.
    named : what a speed that the tool names is called, with its grips there.
    days : the day's exposure of each hand; empty where no work is told.
    equivalents : idling and racing as one value by ISO 22867, m/s2, of each hand; empty where the
        file does not tell both speeds.
    """

    response: ToolResponse
    grips: Mapping[str, Grip]
    named: Mapping[str, Mapping[str, Grip]]
    days: Mapping[str, Exposure]
    equivalents: Mapping[str, float]

    @property
    def speed(self) -> Array:
        """rad/s, (S,)."""
        return self.response.speed

    @cached_property
    def a_hv(self) -> Array:
        """Total value (S,) of the hand that gets most, m/s2."""
        return np.asarray(np.max([grip.a_hv for grip in self.grips.values()], axis=0))

    @property
    def worst(self) -> str | None:
        """The hand that gets most in a day."""
        return max(self.days, key=lambda name: self.days[name].a8) if self.days else None

    @property
    def a8(self) -> float | None:
        """Daily exposure A(8) of that hand, m/s2; None where no work is told."""
        return None if self.worst is None else self.days[self.worst].a8

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units."""
        return {
            "speed": self.speed,
            "a_hv": self.a_hv,
            "a8": self.a8,
            "hands": {
                name: {
                    "acceleration_vertical": grip.acceleration[0],
                    "acceleration_lateral": grip.acceleration[1],
                    "a_hw_vertical": grip.a_hw[0],
                    "a_hw_lateral": grip.a_hw[1],
                    "a_hv": grip.a_hv,
                }
                for name, grip in self.grips.items()
            },
            "named": {
                what: {name: float(grip.a_hv[0]) for name, grip in part.items()}
                for what, part in self.named.items()
            },
            "days": {name: day.to_dict() for name, day in self.days.items()},
            "equivalents": dict(self.equivalents),
        }


def expose_tool(tool: Tool, speeds: Array, duration: float | None = None) -> ToolExposure:
    """What the hands get over a range of speeds, rad/s, and in a day.

    duration : time a day, s, at the working speed, in the place of the work that the tool tells.

    Raises
    ------
    ModelError : no hand holds the tool, or nothing shakes it; as `respond_tool`.
    """
    response = respond_tool(tool, speeds)
    work = tool.work if duration is None else (Work("work", working_speed(tool), duration),)
    named = {what: grips(respond_tool(tool, speed)) for what, speed in _named(tool)}
    return ToolExposure(response, grips(response), named, _days(tool, work), _equivalents(named))


def _named(tool: Tool) -> Iterable[tuple[str, float]]:
    """The speeds that the tool names, rad/s."""
    if tool.operation is None:
        return
    yield WORKING, tool.operation.speed
    if tool.operation.idling is not None:
        yield IDLING, tool.operation.idling
    if tool.operation.racing is not None:
        yield RACING, tool.operation.racing


def working_speed(tool: Tool) -> float:
    """Speed of the engine at work, rad/s; a `ModelError` where it is not told."""
    if tool.operation is None:
        raise ModelError("operation", NO_OPERATION)
    return tool.operation.speed


def _days(tool: Tool, work: tuple[Work, ...]) -> dict[str, Exposure]:
    if not work:
        return {}
    at = grips(respond_tool(tool, np.array([part.speed for part in work])))
    return {
        name: daily_exposure(
            Task(part.name, float(a_hv), part.duration)
            for part, a_hv in zip(work, grip.a_hv, strict=True)
        )
        for name, grip in at.items()
    }


def _equivalents(named: Mapping[str, Mapping[str, Grip]]) -> dict[str, float]:
    """Idling and racing as one value of each hand, where the tool names both."""
    if IDLING not in named or RACING not in named:
        return {}
    idling, racing = named[IDLING], named[RACING]
    return {
        name: equivalent(float(idling[name].a_hv[0]), float(racing[name].a_hv[0]))
        for name in idling
    }
