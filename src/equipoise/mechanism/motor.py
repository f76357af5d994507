"""What drives the crank: a motor or engine behind a gear or chain, as values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.frozen import Frozen

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine

UNITS = {"no_load_speed": " rad/s", "stall_torque": " N m", "ratio": ""}
MEAN_SPEEDS = ("held", "free")


@dataclass(frozen=True)
class MotorTable(Frozen):
    """Torque of a motor against its speed: linear between its rows, and beyond them as between
    the last two.

    speed : rad/s, rising.  torque : N m, as long as `speed`.
    file : name of the CSV file that it came from.
    """

    shapes: ClassVar[dict[str, str]] = {"speed": "row", "torque": "row", "file": "text"}

    speed: tuple[float, ...]
    torque: tuple[float, ...]
    file: str = field(default="", compare=False)


@dataclass(frozen=True)
class Motor(Frozen):
    """The motor or engine that turns the crank.

    no_load_speed, stall_torque : rad/s and N m, both sizes: torque falls in a straight line from
        the one at standstill to zero at the other.  Instead of them
    table : torque against speed, of the motor.
    ratio : turns of the motor in one turn of the crank, more than 0.
    inertia : of its rotor about its own axis, kg m2.
    mean_speed : held, if the motor is so set that the crank turns at the drive's speed in the
        mean: its curve is shifted along the speed; free, if the curve holds as it is and the speed
        follows from it.
    """

    shapes: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("no_load_speed", "stall_torque"), "number?"),
        **dict.fromkeys(("ratio", "inertia"), "number"),
        "mean_speed": "text",
    }

    no_load_speed: float | None = None
    stall_torque: float | None = None
    table: MotorTable | None = None
    ratio: float = 1.0
    inertia: float = 0.0
    mean_speed: Literal["held", "free"] = "held"


def wrong_motor(machine: Machine) -> Iterator[ModelError]:
    """Everything that is wrong with a machine's motor and flywheel."""
    if machine.drive.flywheel < 0:
        yield ModelError(
            "drive.flywheel",
            f"got {machine.drive.flywheel:g} kg m^2; no body has a negative moment of inertia",
        )
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
    for key in ("no_load_speed", "stall_torque", "ratio"):
        value = getattr(motor, key)
        if value is not None and value <= 0:
            yield ModelError(f"{where}.{key}", f"got {value:g}{UNITS[key]}; give more than 0")
    if motor.inertia < 0:
        yield ModelError(
            f"{where}.inertia",
            f"got {motor.inertia:g} kg m^2; no body has a negative moment of inertia",
        )
    if motor.mean_speed not in MEAN_SPEEDS:
        yield ModelError(
            f"{where}.mean_speed", unknown(motor.mean_speed, MEAN_SPEEDS, "choice of mean speed")
        )
    if motor.table is not None:
        yield from _wrong_table(f"{where}.table", motor.table)


def _wrong_table(where: str, table: MotorTable) -> Iterator[ModelError]:
    if len(table.speed) != len(table.torque):
        yield ModelError(where, "the columns differ in length")
    elif len(table.speed) < 2:
        yield ModelError(where, "the table has fewer than two rows; a curve needs two")
    elif any(b <= a for a, b in pairwise(table.speed)):
        yield ModelError(where, "the speeds must rise from row to row")
