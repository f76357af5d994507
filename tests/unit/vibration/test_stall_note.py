"""What is said of a motor that stalls: two torques that a reader can tell apart, or a limit."""

from __future__ import annotations

import re

import pytest

from equipoise.vibration.coupled import stall_note


@pytest.mark.parametrize(
    ("needed", "given", "texts"),
    [
        (510.61, 120.0, ("510.6", "120")),
        (120.01, 120.0, ("120.01", "120")),
        (120.003, 119.9999, ("120.003", "120")),
    ],
)
def test_torques_at_a_stall_differ(needed: float, given: float, texts: tuple[str, str]) -> None:
    sentence = str(stall_note(202.1, needed, given))
    assert sentence.startswith("the motor stalls at crank angle 202.1 deg: ")
    assert tuple(re.findall(r"([\d.]+) N m", sentence)) == texts


@pytest.mark.parametrize("needed", [120.0, 120.0000001, 119.99])
def test_a_motor_at_its_limit_says_so(needed: float) -> None:
    assert "the crank has 120 N m, which just hold it there" in str(stall_note(30, needed, 120.0))
