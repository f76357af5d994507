"""Which numbers of a machine a search may change, and the machine that other numbers give."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from equipoise.errors import UsageError
from equipoise.mechanism.parts.gears import closed
from equipoise.mechanism.parts.machine import FRAME, Machine, Vector, unknown
from equipoise.planting.twins import kept_alike, twins_of
from equipoise.planting.variables import Draft, Variable, joined, usual, variables
from equipoise.signals import Array

Sense = Literal["as given", "counterclockwise", "clockwise", "either"]

DIGITS = 12
"""Decimals of a metre to which moved points are rounded."""


class Designs:
    """Machines that differ from one in some numbers.

    vary : names of numbers with their limits, m, rad or plain; None for what is `usual`.
    Arms that are alike stay so, unless what varies names gears of the further ones alone.
    sense : in which the crank turns.  Where it is "either", a last number tells: below 0
        clockwise.
    """

    def __init__(
        self,
        machine: Machine,
        vary: Mapping[str, tuple[float, float]] | None = None,
        sense: Sense = "as given",
    ) -> None:
        self.machine, self.sense = machine, sense
        known = {variable.name: variable for variable in variables(machine)}
        names = [name for name in known if usual(name)] if vary is None else list(vary)
        if not names:
            raise UsageError("vary: names nothing; name at least one number, or leave it out")
        self.variables = []
        for name in names:
            one = known.get(name) or joined(machine, name)
            if one is None:
                raise UsageError(f"vary.{name}: {unknown(name, known, 'number to vary')}")
            self.variables.append(one if vary is None else _within(one, *vary[name]))
        self.twins = [
            twin
            for twin in twins_of(machine)
            if all(twin.mate in one.gears for one in self.variables if twin.gear in one.gears)
        ]

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest values, (n,) each."""
        low = [variable.low for variable in self.variables]
        high = [variable.high for variable in self.variables]
        turning = [1.0] if self.sense == "either" else []
        return np.array([*low, *(-t for t in turning)]), np.array([*high, *turning])

    @property
    def start(self) -> Array:
        """Values of the machine itself, inside the limits, (n,)."""
        values = [variable.start for variable in self.variables]
        turning = [np.sign(self.machine.drive.speed)] if self.sense == "either" else []
        start: Array = np.clip([*values, *turning], *self.bounds)
        return start

    def build(self, values: Sequence[float] | Array) -> Machine:
        """The machine that has these values; places that have moved are rounded to `DIGITS`, and
        tables of gears scaled so that their curves close.
        """
        machine = self.machine
        names = (FRAME, *machine.links)
        bodies = {name: _places(machine.points_of(name)) for name in names}
        draft = Draft(bodies, list(machine.gears))
        for variable, value in zip(self.variables, values, strict=False):
            variable.put(draft, float(value))
        points = {name: _pairs(bodies[name], machine.points_of(name)) for name in names}
        links = {
            name: link if points[name] == dict(link.points) else link.altered(points=points[name])
            for name, link in machine.links.items()
        }
        size = abs(machine.drive.speed)
        speed = {
            "as given": machine.drive.speed,
            "counterclockwise": size,
            "clockwise": -size,
            "either": size if values[-1] >= 0 else -size,
        }[self.sense]
        drive = replace(machine.drive, speed=speed)
        changed = {number for variable in self.variables for number in variable.gears}
        gears = tuple(
            closed(gear, points) if number in changed else gear
            for number, gear in enumerate(draft.gears)
        )
        made = replace(machine, frame=points[FRAME], links=links, gears=gears, drive=drive)
        return kept_alike(made, self.twins)


def _places(points: Mapping[str, Vector]) -> dict[str, complex]:
    return {name: complex(*place) for name, place in points.items()}


def _pairs(points: Mapping[str, complex], before: Mapping[str, Vector]) -> dict[str, Vector]:
    """Places of points; those that have moved with so many digits that a file stays readable."""
    return {
        name: old
        if place == complex(*old)
        else (round(place.real, DIGITS), round(place.imag, DIGITS))
        for (name, place), old in zip(points.items(), before.values(), strict=True)
    }


def _within(variable: Variable, low: float, high: float) -> Variable:
    if not low < high:
        raise UsageError(f"vary.{variable.name}: the first limit must be below the second")
    if variable.dimension == "length" and variable.name.count(".") == 0 and low <= 0:
        raise UsageError(f"vary.{variable.name}: a length must stay above 0")
    return replace(variable, low=low, high=high)
