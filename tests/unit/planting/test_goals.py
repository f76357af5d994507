"""Goals: distances, limits, tolerances, angles that come round again."""

from __future__ import annotations

from math import pi, radians
from typing import Any

import numpy as np
import pytest

from equipoise.design.requirements import Requirement
from equipoise.errors import UsageError
from support.refusals import refused


def slack(goal: Requirement, value: float) -> list[float]:
    return [float(part[0]) for part in goal.slack(np.array([value]))]


def test_distance_from_the_target() -> None:
    off = Requirement("curve.height", target=0.25).off(np.array([0.24, 0.25, 0.27]))
    assert off == pytest.approx([-0.01, 0.0, 0.02])


def test_angles_come_round() -> None:
    off = Requirement("entry.crank_angle", target=0.1).off(np.array([2 * pi - 0.1, 0.3, 7.0]))
    assert off == pytest.approx([-0.2, 0.2, 6.9 - 2 * pi])


def test_travel_is_no_angle_that_comes_round() -> None:
    off = Requirement("soil.crank_travel", target=0.1).off(np.array([6.2]))
    assert off == pytest.approx([6.1])


def test_slack_is_positive_inside() -> None:
    goal = Requirement("curve.width", at_least=0.1, at_most=0.3)
    assert slack(goal, 0.15) == pytest.approx([0.05, 0.15])
    assert slack(goal, 0.35) == pytest.approx([0.25, -0.05])


def test_limits_of_an_attitude_hold_across_the_turn() -> None:
    """170 deg to 190 deg, which the output tells as -170 deg."""
    goal = Requirement("entry.attitude", at_least=radians(170), at_most=radians(190))
    assert slack(goal, radians(-175)) == pytest.approx([radians(15), radians(5)])
    assert slack(goal, radians(-160)) == pytest.approx([radians(30), radians(-10)])


def test_what_is_made_large_becomes_small_with_the_other_sign() -> None:
    values = np.array([1.0, 2.0])
    assert list(Requirement("curve.lift", make="largest").size(values)) == [-1.0, -2.0]
    assert list(Requirement("curve.lift", make="smallest").size(values)) == [1.0, 2.0]
    assert list(Requirement("curve.lift", target=1.0).size(values)) == [0.0, 0.0]


def test_steps() -> None:
    height = Requirement("curve.height", target=0.25)
    assert height.scale(9.0, "length") == pytest.approx(0.09)
    assert height.scale(float("nan"), "length") == pytest.approx(0.0025)
    attitude = Requirement("entry.attitude", target=2.0)
    assert attitude.scale(1.0, "angle") == pytest.approx(radians(1))
    exact = Requirement("curve.height", target=0.25, tolerance=1e-3)
    assert exact.scale(9.0, "length") == 1e-3


def test_met() -> None:
    goal = Requirement("curve.height", target=0.25, at_most=0.2502)
    assert goal.met(0.2495, 1e-3)
    assert not goal.met(0.2485, 1e-3)
    assert not goal.met(0.2505, 1e-3)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"target": 1.0, "make": "smallest"}, {"place": "curve.height", "by": "_check"}),
        ({"make": "best"}, {"place": "curve.height", "last": "largest", "first": "smallest"}),
        ({"at_least": 2.0, "at_most": 1.0}, {"place": "curve.height", "by": "_check"}),
        ({"target": 1.0, "tolerance": 0.0}, {"place": "curve.height", "by": "_check"}),
        ({"target": 1.0, "at_most": 0.9}, {"place": "curve.height", "by": "_check"}),
    ],
)
def test_wrong_goals(given: dict[str, Any], expected: dict[str, Any]) -> None:
    with refused(UsageError, **expected):
        Requirement("curve.height", **given)
