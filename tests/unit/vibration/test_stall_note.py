"""What is said of a motor that stalls: two torques that a reader can tell apart, or a limit."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

import equipoise as eq
from equipoise.mechanism.parts.motors import Motor
from equipoise.running.blocks import verdict
from equipoise.vibration.coupled import stall_note


@pytest.mark.parametrize(
    ("needed", "given", "texts"),
    [
        (510.61, 120.0, ("510.6", "120.0")),
        (120.01, 120.0, ("120.01", "120.00")),
        (120.003, 119.9999, ("120.003", "120.000")),
    ],
)
def test_torques_at_a_stall_differ(needed: float, given: float, texts: tuple[str, str]) -> None:
    sentence = str(stall_note(202.1, needed, given))
    assert sentence.startswith("the motor stalls at crank angle 202.1 deg: ")
    assert tuple(re.findall(r"([\d.]+) N m", sentence)) == texts


def test_torques_have_the_same_decimals() -> None:
    assert "needs 8.701 N m to go on, and has 8.700 N m" in str(stall_note(0.0, 8.701, 8.7))
    assert "needs 1e-09 N m to go on, and has 5e-10 N m" in str(stall_note(0.0, 1e-9, 5e-10))


@pytest.mark.parametrize("given", [8.7, 8.701])
def test_no_flywheel_is_advised_to_a_crank_that_has_not_moved(given: float) -> None:
    """It has no energy to give there."""
    sentence = str(stall_note(0.0, 8.701, given, at_rest=True))
    assert sentence.endswith("; give a stronger motor or a higher ratio")
    assert "flywheel" in str(stall_note(0.0, 8.701, given))


def test_a_run_from_rest_says_so() -> None:
    """A motor of a thousandth of the torque that the heaviest place needs."""
    machine = eq.load("quick-return")
    motor = Motor(no_load_speed=100.0, stall_torque=1e-3)
    run = eq.run(replace(machine, drive=replace(machine.drive, motor=motor)), "1 s")
    assert run.end.kind == "stall" and run.turned == 0
    assert verdict(run).startswith("The motor stalls at rest, at crank angle 0.0 deg: ")
    assert "flywheel" not in verdict(run)


@pytest.mark.parametrize("needed", [120.0, 120.0000001, 119.99])
def test_a_motor_at_its_limit_says_so(needed: float) -> None:
    assert "the crank has 120 N m, which just hold it there" in str(stall_note(30, needed, 120.0))


def test_a_flywheel_is_no_cure_before_the_first_turn_from_rest() -> None:
    """The work of motor and load alone decides there, as a flywheel begins without any."""
    sentence = str(stall_note(46.7, 66.92, 31.73, starting=True))
    assert "while it starts" in sentence
    assert "flywheel" not in sentence
