"""Tables of conditions, verdicts, least moments and sensitivities."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.least_norm import least_moments
from equipoise.balancing.linear_conditions import conditions
from equipoise.balancing.physical_consistency import feasibility
from equipoise.balancing.sensitivity import known_outputs, sensitivities
from equipoise.terminal.conditions import print_added, print_conditions, print_sensitivities


def words(text: str) -> str:
    return " ".join(text.split())


def test_conditions(capsys: pytest.CaptureFixture[str]) -> None:
    given = eq.load("yamashita-1")
    print_conditions(given, [conditions(given), conditions(given, "sine")], feasibility(given))
    text = words(capsys.readouterr().out)
    assert "Conditions for which the shaking force is zero" in text
    assert "Conditions for which the shaking force is a pure sine of the crank angle" in text
    assert "coupler.moment_x / 71.5 mm + rocker.moment_x / 80 mm = 0 -0.3768 kg" in text
    assert "The shaking force can be made zero, with every mass as it is." in text


def test_nothing_to_meet(capsys: pytest.CaptureFixture[str]) -> None:
    yoke = eq.load("scotch-yoke")
    print_conditions(yoke, [conditions(yoke, "sine"), conditions(yoke)])
    text = words(capsys.readouterr().out)
    assert "none, it always is" in text
    assert "crank.moment_y = 0 0 kg mm" in text
    assert "yoke.mass = 0 1.200 kg" in text


def test_added(capsys: pytest.CaptureFixture[str]) -> None:
    print_added(least_moments(eq.load("yamashita-1"), ["crank", "rocker"]))
    text = words(capsys.readouterr().out)
    assert "rocker 30.15 15.37 38.43 15.37 148.4 59.36" in text


def test_sensitivities(capsys: pytest.CaptureFixture[str]) -> None:
    print_sensitivities(sensitivities(eq.load("yamashita-2")), np.radians(-100))
    text = words(capsys.readouterr().out)
    assert "coupler.center_y 0.1200 mm 0.2801 27.9, 214.7, 319.4, 330.6" in text
    assert "no effect at any crank angle: crank.inertia, coupler.inertia, rocker.inertia" in text
    assert "crank angles from -100.0 deg" in text


@pytest.mark.parametrize("output", known_outputs())
def test_every_output_has_a_title(output: str, capsys: pytest.CaptureFixture[str]) -> None:
    print_sensitivities(sensitivities(eq.load("yamashita-1"), output, 36))
    assert "effect of each parameter" in capsys.readouterr().out
