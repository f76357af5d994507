"""Flywheel and motor of the model file."""

from __future__ import annotations

import tomllib
from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from equipoise.mechanism.force_elements import Motor
from equipoise.mechanism.model import Machine
from equipoise.schema import dumps, json_schema, loads
from unit.schema.samples import FOUR_BAR, MOTOR

VALIDATOR = Draft202012Validator(json_schema())
CURVE = '\n[drive.motor]\ntable = "motor.csv"\n'
RPM = 2 * pi / 60


def motor_of(machine: Machine) -> Motor:
    motor = machine.drive.motor
    assert motor is not None
    return motor


# -- reading ---------------------------------------------------------------------------------------


def test_values_arrive_in_si_units() -> None:
    assert motor_of(loads(FOUR_BAR + MOTOR)) == Motor(3000 * RPM, 2.0)
    more = 'ratio = 25\ninertia = "80 g cm^2"\nmean_speed = "free"\n'
    motor = motor_of(loads(FOUR_BAR + MOTOR + more))
    assert motor == Motor(3000 * RPM, 2.0, ratio=25.0, inertia=8e-6, mean_speed="free")
    text = FOUR_BAR.replace("[frame]", 'flywheel = "2 kg cm^2"\n[frame]')
    assert loads(text).drive.flywheel == 2e-4
    assert loads(FOUR_BAR).drive.flywheel == 0
    assert loads(FOUR_BAR).drive.motor is None


@pytest.mark.parametrize("text", [MOTOR, CURVE, f"{MOTOR}ratio = 2.5\n"])
def test_schema_accepts(text: str) -> None:
    VALIDATOR.validate(tomllib.loads(FOUR_BAR + text))


# -- writing ---------------------------------------------------------------------------------------


def test_a_motor_is_written_as_people_write_it() -> None:
    written = dumps(loads(FOUR_BAR + MOTOR))
    assert f'speed = "193 rpm"\n{MOTOR}\n[frame]\n' in written


size = st.floats(1e-20, 1e20)
positive = st.just(0.0) | size


@given(size, size, size, positive, positive, st.sampled_from(["held", "free"]))
def test_random_motors_survive(
    speed: float, torque: float, ratio: float, inertia: float, flywheel: float, mean: str
) -> None:
    motor = Motor(speed, torque, ratio=ratio, inertia=inertia, mean_speed=mean)  # type: ignore[arg-type]
    machine = loads(FOUR_BAR).with_drive(flywheel=flywheel, motor=motor)
    text = dumps(machine)
    VALIDATOR.validate(tomllib.loads(text))
    assert loads(text) == machine
