"""Which numbers of a machine a search may change, and the machine that other numbers give."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from equipoise.design.lifts import Lift, joined, lifts_of, usual, with_lifts
from equipoise.design.spreads import Range
from equipoise.design.variables import Variable
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note
from equipoise.mechanism.parts.machine import Machine, unknown
from equipoise.planting.twins import kept_alike, twins_of
from equipoise.signals import Array

Sense = Literal["as given", "counterclockwise", "clockwise", "either"]


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
        self.given = (machine, vary, sense)
        known = {lift.name: lift for lift in lifts_of(machine)}
        names = [name for name in known if usual(name)] if vary is None else list(vary)
        if not names:
            raise UsageError(
                at_place("vary", Note("names nothing; name at least one number, or leave it out"))
            )
        self.lifts: list[Lift] = []
        self.ranges: list[Range] = []
        for name in names:
            item = known.get(name) or joined(machine, name)
            if item is None:
                raise UsageError(at_place(f"vary.{name}", unknown(name, known, "number to vary")))
            self.lifts.append(item)
            self.ranges.append(
                _range(item, *((item.low, item.high) if vary is None else vary[name]))
            )
        self.twins = [
            twin
            for twin in twins_of(machine)
            if all(twin.mate in lift.gears for lift in self.lifts if twin.gear in lift.gears)
        ]

    @property
    def variables(self) -> tuple[Variable, ...]:
        """What varies."""
        lifts = zip(self.lifts, self.ranges, strict=True)
        return tuple(Variable(lift.name, item, lift.dimension) for lift, item in lifts)

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest values, (n,) each."""
        low, high = [item.low for item in self.ranges], [item.high for item in self.ranges]
        turning = [1.0] if self.sense == "either" else []
        return np.array([*low, *(-t for t in turning)]), np.array([*high, *turning])

    @property
    def start(self) -> Array:
        """Values of the machine itself, inside the limits, (n,)."""
        values = [lift.start for lift in self.lifts]
        turning = [np.sign(self.machine.drive.speed)] if self.sense == "either" else []
        start: Array = np.clip([*values, *turning], *self.bounds)
        return start

    def build(self, values: Sequence[float] | Array) -> Machine:
        """The machine that has these values; places that have moved are rounded to `DIGITS`, and
        tables of gears scaled so that their curves close.
        """
        machine = self.machine
        size = abs(machine.drive.speed)
        speed = {
            "as given": machine.drive.speed,
            "counterclockwise": size,
            "clockwise": -size,
            "either": size if values[-1] >= 0 else -size,
        }[self.sense]
        drive = replace(machine.drive, speed=speed)
        new_machine = with_lifts(machine, [*zip(self.lifts, values, strict=False)], drive=drive)
        return kept_alike(new_machine, self.twins)


def _range(lift: Lift, low: float, high: float) -> Range:
    if lift.dimension == "length" and lift.name.count(".") == 0 and low <= 0 and low < high:
        raise UsageError(at_place(f"vary.{lift.name}", Note("a length must stay above 0")))
    try:
        return Range(low, high)
    except UsageError as error:
        raise UsageError(at_place(f"vary.{lift.name}", error.note)) from error
