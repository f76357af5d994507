"""States in which a machine works over its life, each for a share of the time."""

from __future__ import annotations

from dataclasses import replace

from equipoise.i18n import to_say
from equipoise.keys import Frozen, Number, declared, key
from equipoise.mechanism.parts.force_elements import Load


@declared
class DutyState(Frozen):
    """One state of a machine's duty; the lives of its bearings are those of all states together."""

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
        factor = self.load_factor
        return tuple(_scaled(load, factor) for load in loads) if factor else ()


def _scaled(load: Load, factor: float) -> Load:
    if load.force is not None:
        return replace(load, force=(load.force[0] * factor, load.force[1] * factor))
    if load.torque is not None:
        return replace(load, torque=load.torque * factor)
    if load.gas is not None:
        beyond = (factor * (pressure - load.back_pressure) for pressure in load.gas.pressure)
        pressures = tuple(load.back_pressure + pressure for pressure in beyond)
        return replace(load, gas=replace(load.gas, pressure=pressures))
    assert load.table is not None
    columns = tuple(tuple(value * factor for value in column) for column in load.table.values)
    return replace(load, table=replace(load.table, values=columns))
