"""What drives the crank: a motor or engine behind a gear or chain, as values."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.keys import (
    NO_INERTIA,
    ROW,
    Conditions,
    File,
    Frozen,
    Number,
    Text,
    declared,
    inside,
    key,
)

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine

MEAN_SPEEDS = ("held", "free")


@declared
class MotorTable(Frozen):
    """Torque of a motor against its speed: linear between its rows, and beyond them as between
    the last two.

    speed : rad/s, rising.  torque : N m, as long as `speed`.
    file : name of the CSV file that it came from.
    """

    speed: tuple[float, ...] = inside(ROW)
    torque: tuple[float, ...] = inside(ROW)
    file: str = inside(Text(), default="", compare=False)


@declared
class Motor(Frozen):
    """The motor or engine that turns the crank; its torque and speed are sizes.

    Torque falls in a straight line from the one at standstill to zero at no load, or follows the
    table.
    """

    file_order = ("no_load_speed", "stall_torque", "table", "ratio", "inertia", "mean_speed")
    conditions: ClassVar[Conditions] = {
        "oneOf": [
            {"required": ["no_load_speed", "stall_torque"], "properties": {"table": False}},
            {"required": ["table"], "properties": {"no_load_speed": False, "stall_torque": False}},
        ]
    }

    no_load_speed: float | None = key(
        "angular speed",
        "of the motor, at which its torque is 0",
        default=None,
        example="3000 rpm",
        above=0,
    )
    stall_torque: float | None = key(
        "torque", "of the motor at standstill", default=None, example="2 N m", above=0
    )
    table: MotorTable | None = key(
        File("motor"),
        "CSV file beside this one, instead of these two: `speed [rpm],torque [N m]`",
        default=None,
        example="motor.csv",
    )
    ratio: float = key(
        Number(), "turns of the motor in one turn of the driven link", default=1.0, above=0
    )
    inertia: float = key(
        "inertia", "of its rotor about its own axis", default=0.0, at_least=0, why=NO_INERTIA
    )
    mean_speed: Literal["held", "free"] = key(
        Text(MEAN_SPEEDS),
        "`held`: the motor is so set that the mean speed is the drive's `speed`; `free`: its curve "
        "holds as it is, and the speed follows from it",
        default="held",
    )


def wrong_motor(machine: Machine) -> Iterator[ModelError]:
    """Everything that is wrong with a machine's motor."""
    motor = machine.drive.motor
    if motor is None:
        return
    where = "drive.motor"
    line = (motor.no_load_speed, motor.stall_torque)
    if (motor.table is None) != (None not in line) or (
        motor.table is not None and any(value is not None for value in line)
    ):
        yield ModelError(where, "give either no_load_speed and stall_torque, or table")
        return
    if motor.table is not None:
        yield from _wrong_table(f"{where}.table", motor.table)


def _wrong_table(where: str, table: MotorTable) -> Iterator[ModelError]:
    if len(table.speed) != len(table.torque):
        yield ModelError(where, "the columns differ in length")
    elif len(table.speed) < 2:
        yield ModelError(where, "the table has fewer than two rows; a curve needs two")
    elif any(b <= a for a, b in pairwise(table.speed)):
        yield ModelError(where, "the speeds must rise from row to row")
