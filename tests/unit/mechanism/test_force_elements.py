"""Values of motor and flywheel: each wrong one is refused at its key."""

from __future__ import annotations

import pickle
from dataclasses import replace
from math import inf, nan
from typing import Any

import pytest

import equipoise as eq
from equipoise.mechanism.parts.force_elements import Motor, MotorTable
from unit.mechanism.build import crank_rocker, refused

FOUR = crank_rocker()
LINE = Motor(300.0, 2.0)
TABLE = MotorTable((0.0, 300.0), (2.0, 0.0))
CURVE = Motor(table=TABLE)
EITHER = (
    "give either no_load_speed and stall_torque, or torque, or table, or dc, or induction, or servo"
)


def wrong(where: str, words: str, motor: Motor) -> None:
    refused(f"drive.motor{where}", words, lambda: FOUR.with_drive(motor=motor))


@pytest.mark.parametrize(
    ("motor", "where", "words"),
    [
        (Motor(), "", EITHER),
        (Motor(300.0), "", EITHER),
        (Motor(stall_torque=2.0), "", EITHER),
        (replace(LINE, table=TABLE), "", EITHER),
        (Motor(300.0, table=TABLE), "", EITHER),
        (Motor(300.0, torque=1.0), "", EITHER),
        (Motor(table=TABLE, torque=1.0), "", EITHER),
        (Motor(torque=-1.0), ".torque", "got -1 N m; give more than 0"),
        (replace(LINE, no_load_speed=0.0), ".no_load_speed", "got 0 rad/s; give more than 0"),
        (replace(LINE, stall_torque=-2.0), ".stall_torque", "got -2 N m; give more than 0"),
        (replace(LINE, ratio=0.0), ".ratio", "got 0; give more than 0"),
        (replace(CURVE, ratio=-5.0), ".ratio", "got -5; give more than 0"),
        (replace(CURVE, inertia=-1e-3), ".inertia",
         "got -0.001 kg m^2; no body has a negative moment of inertia"),
        (replace(LINE, mean_speed="hold"), ".mean_speed",  # type: ignore[arg-type]
         "got 'hold'; give 'held' or 'free'"),
        (Motor(table=MotorTable((), ())), ".table",
         "the table has fewer than two rows; a curve needs two"),
        (Motor(table=MotorTable((1.0,), (1.0,))), ".table",
         "the table has fewer than two rows; a curve needs two"),
        (Motor(table=MotorTable((1.0, 2.0), (1.0,))), ".table", "the columns differ in length"),
        (Motor(table=MotorTable((1.0, 1.0), (1.0, 0.0))), ".table",
         "the speeds must rise from row to row"),
    ],
)  # fmt: skip
def test_values_of_a_motor(motor: Motor, where: str, words: str) -> None:
    wrong(where, words, motor)


@pytest.mark.parametrize("value", [nan, inf])
def test_numbers_are_finite(value: float) -> None:
    words = f"got {value}; give a finite number"
    wrong(".ratio", words, replace(LINE, ratio=value))
    wrong(".table.torque[2]", words, Motor(table=MotorTable((0.0, 1.0), (1.0, value))))


def test_flywheels() -> None:
    assert FOUR.with_drive(flywheel=0.2).drive.flywheel == 0.2
    words = "got -0.2 kg m^2; no body has a negative moment of inertia"
    refused("drive.flywheel", words, lambda: FOUR.with_drive(flywheel=-0.2))


@pytest.mark.parametrize(
    ("make", "key", "words"),
    [
        (lambda: Motor("3000 mm", 2.0), "no_load_speed", "got '3000 mm'..."),  # type: ignore[arg-type]
        (lambda: Motor(300.0, 2.0, ratio=None), "ratio", "got None; give a number"),  # type: ignore[arg-type]
        (lambda: MotorTable((1.0, "x"), (1.0, 0.0)), "speed", "got (1.0, 'x'); give numbers"),  # type: ignore[arg-type]
    ],
)
def test_shapes_of_a_motor(make: Any, key: str, words: str) -> None:
    refused(key, words, make)


def test_what_is_right_is_kept() -> None:
    full = replace(CURVE, ratio=12.5, inertia=8e-6, mean_speed="free")
    machine = FOUR.with_drive(motor=full, flywheel=0.2)
    assert machine.drive.motor == full
    assert pickle.loads(pickle.dumps(machine)) == machine
    assert replace(TABLE, file="a.csv") == TABLE


def test_a_motor_does_not_touch_how_the_linkage_is_solved() -> None:
    cycle = eq.mechanism.assemble(FOUR).cycle
    assert eq.mechanism.assemble(FOUR.with_drive(motor=LINE, flywheel=0.2)).cycle is cycle
