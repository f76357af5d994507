"""Values of motor and flywheel: each wrong one is refused at its key."""

from __future__ import annotations

import pickle
from dataclasses import replace
from math import inf, nan
from typing import Any

import pytest

import equipoise as eq
from equipoise.mechanism.parts.motors import Motor, MotorTable
from unit.mechanism.build import crank_rocker, refused

FOUR = crank_rocker()
LINE = Motor(300.0, 2.0)
TABLE = MotorTable((0.0, 300.0), (2.0, 0.0))
CURVE = Motor(table=TABLE)


def wrong(where: str, expected: dict[str, Any], motor: Motor) -> None:
    refused(f"drive.motor{where}", expected, lambda: FOUR.with_drive(motor=motor))


@pytest.mark.parametrize(
    ("motor", "where", "expected"),
    [
        (Motor(), "", {}),
        (Motor(300.0), "", {}),
        (Motor(stall_torque=2.0), "", {}),
        (replace(LINE, table=TABLE), "", {}),
        (Motor(300.0, table=TABLE), "", {}),
        (Motor(300.0, torque=1.0), "", {}),
        (Motor(table=TABLE, torque=1.0), "", {}),
        (Motor(torque=-1.0), ".torque", {"text": "-1 N m"}),
        (replace(LINE, no_load_speed=0.0), ".no_load_speed", {"text": "0 rad/s"}),
        (replace(LINE, stall_torque=-2.0), ".stall_torque", {"text": "-2 N m"}),
        (replace(LINE, ratio=0.0), ".ratio", {"text": 0}),
        (replace(CURVE, ratio=-5.0), ".ratio", {"text": -5}),
        (replace(CURVE, inertia=-1e-3), ".inertia", {"text": "-0.001 kg m^2"}),
        (replace(LINE, mean_speed="hold"), ".mean_speed",  # type: ignore[arg-type]
         {"leaf": "hold"}),
        (Motor(table=MotorTable((), ())), ".table", {}),
        (Motor(table=MotorTable((1.0,), (1.0,))), ".table", {}),
        (Motor(table=MotorTable((1.0, 2.0), (1.0,))), ".table", {}),
        (Motor(table=MotorTable((1.0, 1.0), (1.0, 0.0))), ".table", {}),
    ],
)  # fmt: skip
def test_values_of_a_motor(motor: Motor, where: str, expected: dict[str, Any]) -> None:
    wrong(where, expected, motor)


@pytest.mark.parametrize("value", [nan, inf])
def test_numbers_are_finite(value: float) -> None:
    wrong(".ratio", {"leaf": str(value)}, replace(LINE, ratio=value))
    wrong(
        ".table.torque[2]", {"leaf": str(value)}, Motor(table=MotorTable((0.0, 1.0), (1.0, value)))
    )


def test_flywheels() -> None:
    assert FOUR.with_drive(flywheel=0.2).drive.flywheel == 0.2
    refused("drive.flywheel", {"text": "-0.2 kg m^2"}, lambda: FOUR.with_drive(flywheel=-0.2))


@pytest.mark.parametrize(
    ("make", "key", "expected"),
    [
        (lambda: Motor("3000 mm", 2.0), "no_load_speed", {"given": "'3000 mm'"}),  # type: ignore[arg-type]
        (lambda: Motor(300.0, 2.0, ratio=None), "ratio", {}),  # type: ignore[arg-type]
        (lambda: MotorTable((1.0, "x"), (1.0, 0.0)), "speed", {"given": "(1.0, 'x')"}),  # type: ignore[arg-type]
    ],
)
def test_shapes_of_a_motor(make: Any, key: str, expected: dict[str, Any]) -> None:
    refused(key, expected, make)


def test_what_is_right_is_kept() -> None:
    full = replace(CURVE, ratio=12.5, inertia=8e-6, mean_speed="free")
    machine = FOUR.with_drive(motor=full, flywheel=0.2)
    assert machine.drive.motor == full
    assert pickle.loads(pickle.dumps(machine)) == machine
    assert replace(TABLE, file="a.csv") == TABLE


def test_a_motor_does_not_touch_how_the_linkage_is_solved() -> None:
    cycle = eq.mechanism.assemble(FOUR).cycle
    assert eq.mechanism.assemble(FOUR.with_drive(motor=LINE, flywheel=0.2)).cycle is cycle
