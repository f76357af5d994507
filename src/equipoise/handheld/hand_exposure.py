"""What the hands on a tool get: weighted acceleration over a day, and over a band of speeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from math import pi
from typing import Any, ClassVar, NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.exposure.daily import Exposure, Task, daily_exposure, equivalent
from equipoise.exposure.weighting import squared_factor
from equipoise.handheld.chain import Dual, carry, solve
from equipoise.handheld.layout import HarmonicField, Layout, check_coverage
from equipoise.handheld.model import PLANES, Tool, Work, number_of
from equipoise.handheld.response import (
    NOTHING,
    Reciprocal,
    ToolNumber,
    ToolResponse,
    loads_on,
    loud,
    orders_of,
    respond_tool,
    shakes,
)
from equipoise.handheld.shaft import KEYS, has_number
from equipoise.handheld.sweep import SPEED
from equipoise.i18n import Note
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.results.result import Result
from equipoise.signals import Array

WORKING, IDLING, RACING = "working", "idling", "racing"
NO_HANDS = Note(
    "no hand holds the tool; give a station a hand with its stiffness, or its impedance"
)
NO_OPERATION = Note(
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

    declared: ClassVar[Declarations] = {
        **{
            f"{key}_{side}": ResultOutput(
                f"{meaning}, {side}",
                "acceleration",
                read=lambda grip, key=key, k=k: getattr(grip, key)[k],  # type: ignore[misc]
                along="speed",
            )
            for key, meaning in (("acceleration", "RMS"), ("a_hw", "weighted RMS"))
            for k, side in enumerate(PLANES)
        },
        "a_hv": ResultOutput("total value", "acceleration", along="speed"),
    }

    @property
    def a_hv(self) -> Array:
        """Total value (S,); along the shaft nothing moves in bending."""
        return np.asarray(np.sqrt(np.sum(self.a_hw**2, axis=0)))


def grips(response: ToolResponse) -> dict[str, Grip]:
    """Vibration of every station that a hand holds."""
    if not response.tool.grips:
        raise ModelError("shaft.stations", NO_HANDS)
    frequency = response.frequency
    by_name = {}
    for station in response.tool.grips:
        moved = response.displacement(station.name)
        weighted = np.sum(np.real(weighted_squares(frequency, moved)), axis=1)
        plain = np.sum(np.abs(frequency**2 * moved) ** 2, axis=1) / 2
        by_name[station.name] = Grip(np.sqrt(plain), np.sqrt(weighted))
    return by_name


@dataclass(frozen=True, eq=False, repr=False)
class ToolExposure(Result):
    """What the hands on a tool get, over a range of speeds and in a day.

    response : over the range of speeds.
    grips : by station.
    named : what a speed that the tool names is called, with its grips there.
    days : the day's exposure of each hand; empty where the tool has no working time.
    """

    blocks_in = "handheld.blocks.exposure_of_tool"
    pictures_in = "figures.tool_charts.exposure_charts"
    headline_in = "handheld.blocks.exposure_headline"

    response: ToolResponse
    grips: Mapping[str, Grip]
    named: Mapping[str, Mapping[str, Grip]]
    days: Mapping[str, Exposure]

    @property
    def speed(self) -> Array:
        """rad/s, (S,)."""
        return self.response.speed

    @cached_property
    def a_hv(self) -> Array:
        """Total value (S,) of the hand that gets most, m/s2."""
        return np.asarray(np.max([grip.a_hv for grip in self.grips.values()], axis=0))

    @property
    def equivalents(self) -> dict[str, float]:
        """Idling and racing as one value by ISO 22867, m/s2, of each hand; of both, or none."""
        if not {IDLING, RACING} <= set(self.named):
            return {}
        modes = self.named[IDLING], self.named[RACING]
        return {
            name: equivalent(*(float(mode[name].a_hv[0]) for mode in modes)) for name in modes[0]
        }

    @property
    def worst(self) -> str | None:
        """The hand that gets most in a day."""
        return max(self.days, key=lambda name: self.days[name].a8) if self.days else None

    @property
    def a8(self) -> float | None:
        """Daily exposure A(8) of that hand, m/s2; None where the tool has no working time."""
        return None if self.worst is None else self.days[self.worst].a8

    declared: ClassVar[Declarations] = {
        "speed": replace(SPEED, column=None),
        "a_hv": ResultOutput("total value of the worst hand", "acceleration", along="speed"),
        "a8": ResultOutput("A(8) of the day; null without work", "acceleration"),
        "hands": ResultOutput(
            "of each hand", of=Grip.declared, family=True, read="grips", along="speed"
        ),
        "named": ResultOutput(
            "total value of each hand at the speeds of `[operation]`",
            "acceleration",
            family=True,
            read=lambda result: {
                what: {name: float(grip.a_hv[0]) for name, grip in part.items()}
                for what, part in result.named.items()
            },
        ),
        "days": ResultOutput(
            "exposure of each hand in a day", of=Exposure.declared, family=True, table="exposure"
        ),
        "equivalents": ResultOutput(
            "idling and racing as one value of each hand, ISO 22867", "acceleration", family=True
        ),
    }


def expose_tool(tool: Tool, speeds: Array, duration: float | None = None) -> ToolExposure:
    """What the hands get over a range of speeds, rad/s, and in a day.

    duration : time a day, s, at the working speed, instead of the tool's working time.

    Raises
    ------
    ModelError : no hand holds the tool, or nothing shakes it; as `respond_tool`.
    """
    response, operation = respond_tool(tool, speeds), tool.operation
    work = tool.work
    if duration is not None:
        if operation is None:
            raise ModelError("operation", NO_OPERATION)
        work = (Work("work", operation.speed, duration),)
    text = {}
    if operation is not None:
        text = {WORKING: operation.speed, IDLING: operation.idling, RACING: operation.racing}
    at = ((what, speed) for what, speed in text.items() if speed is not None)
    named = {what: grips(respond_tool(tool, speed)) for what, speed in at}
    return ToolExposure(response, grips(response), named, days_of(tool, work))


def days_of(tool: Tool, work: tuple[Work, ...]) -> dict[str, Exposure]:
    """What a day of work amounts to, by the hand that holds the tool; empty without work."""
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


class BandFigures(NamedTuple):
    """Squares over a band of speeds (S,), with their derivatives by the numbers (P,) asked for.

    hands : a_hv^2 of each hand, (m/s2)^2: value (S,) and slopes (P, S).
    forces : mean square over time of the force on the body at each station that is held, N2.
    """

    hands: dict[str, Dual]
    forces: dict[str, Dual]


class SpeedBand:
    """A tool over a band of speeds (S,), rad/s; what does not depend on a design is done once.

    least : share of the largest force below which an order is left out.

    Raises
    ------
    ModelError : no hand holds it, nothing shakes it, or a hand's table does not reach that far.
    """

    def __init__(self, tool: Tool, speed: Array, least: float = 0.0) -> None:
        if not tool.grips:
            raise ModelError("shaft.stations", NO_HANDS)
        if not tool.excitations:
            raise ModelError("excitations", NOTHING)
        self.tool, self.speed = tool, speed
        self.shakes = loud(shakes(tool), float(np.max(speed)), least)
        self.orders = orders_of(self.shakes)
        self.highest = float(self.orders[-1] * np.max(speed))
        check_coverage(tool, float(self.orders[0] * np.min(speed)), self.highest)
        self.frequency = np.multiply.outer(self.orders, speed).reshape(1, -1)

    def felt(
        self,
        numbers: Sequence[ToolNumber],
        values: Array | None = None,
        force_names: Sequence[str] = (),
        slopes: bool = True,
    ) -> BandFigures:
        """What the hands get with some numbers (P,) of the tool changed.

        values : of the numbers, both of a pair alike; the tool's own, each of a pair, if None.
        held : stations at which the force on the body is asked for too.
        slopes : whether the derivatives are asked for.
        """
        own = Layout(self.tool, self.highest)
        given = (own.of(self.tool.station(item), key) for item, key in numbers)
        changed = dict(zip(numbers, given if values is None else values.tolist(), strict=True))
        layout, s = Layout(self.tool, self.highest, changed), 1j * self.frequency
        carried = carry(layout.chain(s))
        loads = loads_on(layout, self.shakes, self.orders, self.speed)
        field = HarmonicField(layout, s, solve(carried, loads))
        names = [grip.name for grip in self.tool.grips]
        by = Reciprocal(field, carried, [*names, *force_names], numbers if slopes else ())
        squares = {name: weighted_squares(self.frequency, by.moved(name)) for name in names}
        hands = {name: self._over_orders(square) for name, square in squares.items()}
        forces = {}
        for name in force_names:  # mean square of the force on all that holds the station
            force = by.holding(name) * by.moved(name)
            forces[name] = self._over_orders(force * force.conj() * 0.5)
        return BandFigures(hands, forces)

    def _over_orders(self, squares: Dual) -> Dual:
        """Sum over planes and orders: from (2, K S) to (S,)."""
        shape = (2, len(self.orders), len(self.speed))
        value = squares.value.real.reshape(shape).sum(axis=(0, 1))
        slopes = squares.slopes.real.reshape(-1, *shape).sum(axis=(1, 2))
        return Dual(value, slopes)


def values_of(tool: Tool, numbers: Sequence[ToolNumber]) -> Array:
    """What these numbers are in the tool, (P,)."""
    return np.array([number_of(tool, station, key) for station, key in numbers])


def mean_over_band(square: Dual) -> Dual:
    """Mean (1,) over the equally spaced speeds of a band (S,), by trapezia."""
    weights = np.ones(square.value.size)
    weights[[0, -1]] = 0.5
    weights /= weights.sum()
    return Dual((square.value @ weights)[None], (square.slopes @ weights)[:, None])


def tool_sensitivities(tool: Tool, speed: Array) -> dict[ToolNumber, float]:
    """Derivative of the RMS over speeds (S,) of the worst hand's a_hv by every number of the tool.

    In m/s2 for each SI unit; of a pair of numbers, by both together.
    """
    numbers = [
        (station.name, key) for station in tool.stations for key in KEYS if has_number(station, key)
    ]
    means = [mean_over_band(hand) for hand in SpeedBand(tool, speed).felt(numbers).hands.values()]
    worst = max(means, key=lambda item: float(item.value[0]))
    slopes = worst.slopes[:, 0] / (2 * np.sqrt(worst.value))
    return dict(zip(numbers, slopes.tolist(), strict=True))
