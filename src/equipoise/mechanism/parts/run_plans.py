"""How a machine is run, and the states in which it works over its life."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from equipoise.i18n import to_say
from equipoise.keys import Flag, Frozen, Number, declared, key
from equipoise.mechanism.parts.force_elements import Load

MOST_TURNS = 10_000


@declared
class RunPlan(Frozen):
    """Start and end of a run; what is left out is as in a run of a file without this table."""

    called = to_say("{what} of the run")

    duration: float | None = key(
        "time", "after which the run ends", default=None, example="2 s", above=0
    )
    turns: float | None = key(
        Number(), "of the crank, after which the run ends; 10000 at most", default=None, example=30,
        above=0, below=MOST_TURNS + 1,
    )  # fmt: skip
    speed: float | None = key(
        "angular speed", "of the crank at the start; 0 with a motor, else the drive's, where left "
        "out", default=None, example="0 rpm",
    )  # fmt: skip
    angle: float = key("angle", "of the crank at the start", default=0.0)
    off: float | None = key(
        "time", "at which the motor is switched off", default=None, example="1.5 s", above=0
    )
    off_turns: float | None = key(
        Number(), "of the crank, after which the motor is switched off", default=None, example=20,
        above=0,
    )  # fmt: skip
    support: bool = key(
        Flag(), "whether the support moves too; else the frame is fixed", default=False
    )


@declared
class DutyState(Frozen):
    """One state of a machine's duty; lives of its bearings and links are those of all states
    together.
    """

    called = to_say("{what} of duty state {number}")

    share: float = key(
        Number(), "of the operating time, against the sum of all shares", example=0.3, above=0
    )
    speed: float | None = key(
        "angular speed", "of the crank, in the direction of the drive's speed, which it has where "
        "left out", default=None, example="150 rpm", above=0,
    )  # fmt: skip
    load_factor: float = key(
        Number(), "by which all `loads` are multiplied; 0 for none", default=1.0, at_least=0
    )

    def scaled(self, loads: tuple[Load, ...]) -> tuple[Load, ...]:
        """Loads of a machine as they are in this state."""
        return tuple(_scaled(load, self.load_factor) for load in loads)


def _scaled(load: Load, factor: float) -> Load:
    if load.force is not None:
        return replace(load, force=(load.force[0] * factor, load.force[1] * factor))
    if load.torque is not None:
        return replace(load, torque=load.torque * factor)
    for name, gas in (("gas", load.gas), ("indicator", load.indicator)):
        if gas is not None:
            beyond = (factor * (pressure - load.back_pressure) for pressure in gas.pressure)
            pressures = tuple(load.back_pressure + pressure for pressure in beyond)
            scaled: dict[str, Any] = {name: replace(gas, pressure=pressures)}
            return replace(load, **scaled)
    assert load.table is not None
    columns = tuple(tuple(value * factor for value in column) for column in load.table.values)
    return replace(load, table=replace(load.table, values=columns))
