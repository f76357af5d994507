"""Motors by their curves, and by kind: direct-current, induction and servo motors."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import inf, sqrt
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import (
    NO_INERTIA,
    ROW,
    File,
    Frozen,
    KeyConditions,
    KeyTable,
    Number,
    TextKind,
    declared,
    inside,
    key,
    lacks,
    needs,
)
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.parts.row_laws import ramp_value, ramps_of

MOTOR_KINDS = (
    ("no_load_speed", "stall_torque"), ("table",), ("torque",), ("dc",), ("induction",), ("servo",),
)  # fmt: skip
"""Keys of a motor of which it has those of one kind."""
MEAN_SPEEDS = ("held", "free")


@declared
class MotorTable(CsvTable):
    """Torque of a motor against its speed: linear between its rows, and beyond them as between
    the last two.

    speed : rad/s, rising.  torque : N m, as long as `speed`.
    file : name of the CSV file that it came from.
    """

    sort = "motor"
    forms = (("speed", "torque"),)

    speed: tuple[float, ...] = inside(ROW)
    torque: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


@declared
class DcMotor(Frozen):
    """A motor of constant field: L di/dt = U - R i - k w, and its torque is k i."""

    called = to_say("{what} of the motor")

    voltage: float = key("voltage", "of the supply", example="24 V", above=0)
    resistance: float = key("resistance", "of armature and leads", example="0.4 ohm", above=0)
    torque_constant: float = key(
        "torque constant", "torque for a current, and voltage for a speed", example="0.08 N m/A",
        above=0,
    )  # fmt: skip
    inductance: float = key(
        "inductance", "of the armature; `run` computes how the current follows", default=0.0,
        example="0.6 mH", at_least=0,
    )  # fmt: skip

    @property
    def no_load_speed(self) -> float:
        """Speed, rad/s, at which it takes no current."""
        return self.voltage / self.torque_constant

    @property
    def stall_torque(self) -> float:
        """Torque, N m, at standstill, once the current is steady."""
        return self.torque_constant * self.voltage / self.resistance

    def steady_current(self, speed: Any) -> Any:
        """Current (...), A, at speeds (...), rad/s, that last."""
        return (self.voltage - self.torque_constant * speed) / self.resistance


@declared
class InductionMotor(Frozen):
    """A three-phase motor on a net: T = 2 T_b / (s / s_b + s_b / s) with the slip s.

    Resistance of the stator, and how the current in it sets in, are left out.
    """

    called = to_say("{what} of the motor")

    synchronous_speed: float = key(
        "angular speed", "of the field; torque is 0 there", example="1500 rpm", above=0
    )
    breakdown_torque: float = key("torque", "the largest", example="42 N m", above=0)
    breakdown_slip: float = key(
        Number(), "share of the synchronous speed by which it is slower there", example=0.22,
        above=0, below=1,
    )  # fmt: skip

    def torque(self, speed: Any) -> Any:
        """Torque (...), N m, at speeds (...), rad/s."""
        slip, least = 1 - speed / self.synchronous_speed, self.breakdown_slip
        return 2 * self.breakdown_torque * slip * least / (slip * slip + least * least)

    @property
    def breakdown_speed(self) -> float:
        """Speed, rad/s, at which its torque is largest."""
        return self.synchronous_speed * (1 - self.breakdown_slip)

    def speed_at(self, torque: float) -> float | None:
        """Speed, rad/s, at which its torque falls through a value; None where it never does."""
        share = torque / self.breakdown_torque
        if abs(share) > 1:
            return None
        slip = self.breakdown_slip * share / (1 + sqrt(1 - share * share))
        return self.synchronous_speed * (1 - slip)


@declared
class ServoMotor(Frozen):
    """T = k_w (w_ref - w) + k_a (a_ref - a), within the limit of torque, of speed w and angle a.

    The reference speed w_ref rises evenly from the speed at the start; a_ref is its integral.
    """

    called = to_say("{what} of the motor")

    speed: float = key(
        "angular speed", "of the motor, that the controller holds", example="3000 rpm", above=0
    )
    torque_limit: float = key(
        "torque", "the largest of the motor, in either sense", example="7 N m", above=0
    )
    speed_gain: float = key(
        "torsional damping", "torque for a deviation of the speed", example="0.2 N m s/rad",
        above=0,
    )  # fmt: skip
    angle_gain: float = key(
        "torsional stiffness", "torque for the angle by which the motor lags behind the integral "
        "of its reference speed; `run` computes it", default=0.0, example="4 N m/rad", at_least=0,
    )  # fmt: skip
    acceleration: float | None = key(
        "angular acceleration", "with which the reference speed of a `run` changes from that at "
        "the start; at once where left out", default=None, example="300 rad/s^2", above=0,
    )  # fmt: skip

    @property
    def rows(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Speeds, rad/s, and torques, N m, between which and beyond the curve by speed alone is
        straight.
        """
        most, band = self.torque_limit, self.torque_limit / self.speed_gain
        speeds = [self.speed + share * band for share in (-2, -1, 1, 2)]
        return tuple(speeds), (most, most, -most, -most)

    @property
    def remembers(self) -> bool:
        """Whether the torque depends on time or angle, and not on speed alone."""
        return self.angle_gain > 0 or self.acceleration is not None

    @property
    def stall_torque(self) -> float:
        """Torque, N m, on a motor that is held at rest, once it is steady."""
        lasting = inf if self.angle_gain else self.speed_gain * self.speed
        return min(self.torque_limit, lasting)


@declared
class Motor(Frozen):
    """The motor or engine that turns the crank; its torque and speed are sizes.

    Torque falls in a straight line from the one at standstill to zero at no load, is the same at
    every speed, or follows the table.
    """

    called = to_say("{what} of the motor")
    file_order = ("no_load_speed", "stall_torque", "torque", "table", "dc", "induction", "servo",
                  "ratio", "inertia", "mean_speed")  # fmt: skip
    conditions: ClassVar[KeyConditions] = {
        "oneOf": [
            needs(*kind)
            | lacks(*(name for other in MOTOR_KINDS if other != kind for name in other))
            for kind in MOTOR_KINDS
        ]
    }

    no_load_speed: float | None = key(
        "angular speed",
        "of the motor, at which its torque is 0",
        default=None,
        example="3000 rpm",
        above=0,
        word=to_say("no-load speed"),
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
        TextKind(MEAN_SPEEDS),
        "`held`: the motor is so set that the mean speed is the drive's `speed`; `free`: its curve "
        "holds as it is, and the speed follows from it",
        default="held",
    )
    torque: float | None = key(
        "torque",
        "of the motor at every speed, instead of a curve",
        default=None,
        example="0.5 N m",
        above=0,
    )
    dc: DcMotor | None = key(
        KeyTable(DcMotor, headed=True), "a direct-current motor, instead of a curve", default=None
    )
    induction: InductionMotor | None = key(
        KeyTable(InductionMotor, headed=True),
        "an induction motor, instead of a curve",
        default=None,
    )
    servo: ServoMotor | None = key(
        KeyTable(ServoMotor, headed=True), "a servo motor, instead of a curve", default=None
    )

    @property
    def reflected_inertia(self) -> float:
        """Moment of inertia of its rotor as the driven link feels it, kg m^2."""
        return self.ratio**2 * self.inertia

    @property
    def rows(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Speeds, rad/s, and torques, N m, between which and beyond its curve is straight; of one
        that has no `smooth_curve`.
        """
        if self.table is not None:
            return self.table.speed, self.table.torque
        if self.torque is not None:
            return (0.0, 1.0), (self.torque, self.torque)
        if self.servo is not None:
            return self.servo.rows
        line = self.dc or self
        assert line.no_load_speed is not None and line.stall_torque is not None
        return (0.0, line.no_load_speed), (line.stall_torque, 0.0)

    @property
    def largest_torque(self) -> float:
        """Largest torque, N m, at any speed in the sense in which it drives."""
        if self.induction is not None:
            return self.induction.breakdown_torque
        speeds, torques = self.rows
        at_rest = ramp_value(ramps_of(speeds, torques), 0.0)
        forward = (torque for speed, torque in zip(speeds, torques, strict=True) if speed >= 0)
        return float(max(at_rest, *forward))

    @property
    def smooth_curve(self) -> InductionMotor | None:
        """Curve of a motor where that is no sequence of straight lines: ``torque`` by speed, and
        ``speed_at`` a torque, up to ``synchronous_speed``.
        """
        return self.induction


def wrong_motor(where: str, motor: Motor) -> Iterator[ModelError]:
    """Everything that is wrong with a motor."""
    line, table = (motor.no_load_speed, motor.stall_torque), motor.table
    where_table = f"{where}.table"
    given = [any(getattr(motor, name) is not None for name in kind) for kind in MOTOR_KINDS]
    if sum(given) != 1 or line.count(None) == 1:
        note = Note(
            "give either {no_load_speed} and {stall_torque}, or torque, or table, or dc, or "
            "induction, or servo",
            **key_names("no_load_speed", "stall_torque"),
        )
        yield ModelError(where, note)
    elif motor.servo is not None and any(b <= a for a, b in pairwise(motor.servo.rows[0])):
        yield ModelError(
            f"{where}.servo.speed_gain",
            Note(
                "the speeds between which the torque falls from limit to limit are lost in "
                "rounding; give less, or a larger {torque_limit}",
                **key_names("torque_limit"),
            ),
        )
    elif table is None:
        return
    elif len(table.speed) != len(table.torque):
        yield ModelError(where_table, Note("the columns differ in length"))
    elif len(table.speed) < 2:
        yield ModelError(where_table, Note("the table has fewer than two rows; a curve needs two"))
    elif any(b <= a for a, b in pairwise(table.speed)):
        yield ModelError(where_table, Note("the speeds must rise from row to row"))
