"""Tables of conditions, verdicts, least moments and sensitivities."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.least_norm import least_moments
from equipoise.balancing.linear_conditions import conditions, conditions_blocks
from equipoise.balancing.physical_consistency import feasibility
from equipoise.balancing.sensitivity import known_outputs, sensitivities
from support.printing import words


def test_conditions() -> None:
    given = eq.load("yamashita-1")
    found = conditions(given), conditions(given, "sine")
    text = words(
        conditions_blocks(*found, verdict=[one.reason for one in feasibility(given).answers])
    )
    assert "Conditions for shaking force to be zero" in text
    assert "Conditions for shaking force to be a pure sine of the crank angle" in text
    assert "coupler.moment_x / 71.5 mm + rocker.moment_x / 80 mm = 0 -0.3768 kg" in text
    assert "The shaking force can be made zero, with every mass as it is." in text


def test_nothing_to_meet() -> None:
    yoke = eq.load("scotch-yoke")
    text = words(conditions_blocks(conditions(yoke, "sine"), conditions(yoke)))
    assert "none, it always is" in text
    assert "crank.moment_y = 0 0 kg mm" in text
    assert "yoke.mass = 0 1.200 kg" in text


def test_added() -> None:
    text = words(least_moments(eq.load("yamashita-1"), ["crank", "rocker"]).blocks())
    assert "rocker 30.15 15.37 38.43 15.37 148.4 59.36" in text


def test_sensitivities() -> None:
    text = words(sensitivities(eq.load("yamashita-2")).blocks(zero=np.radians(-100)))
    assert "coupler.center_y 0.1200 mm 0.2801 27.9, 214.7, 319.4, 330.6" in text
    assert "No effect at any crank angle: crank.inertia, coupler.inertia, rocker.inertia" in text
    assert "crank angle from -100.0 deg" in text


@pytest.mark.parametrize("output", known_outputs())
def test_every_output_has_a_title(output: str) -> None:
    found = sensitivities(eq.load("yamashita-1"), output, 36)
    assert "effect of each parameter" in words(found.blocks())
