"""Motion laws: factors that textbooks print, exact derivatives, and what is wrong with one."""

from __future__ import annotations

from math import pi, radians, sqrt

import mpmath
import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from equipoise.mechanism.formulas.curves import NORMAL, spline
from equipoise.mechanism.parts.laws import (
    CAM,
    LAWS,
    AngleLaw,
    AngleSegment,
    LengthLaw,
    LengthSegment,
    wrong_law,
)

PEAKS = {  # of velocity and acceleration, as of Norton, Cam Design, table 3-1, and closed forms
    "cycloidal": (2.0, 2 * pi),
    "modified sine": (4 * pi / (4 + pi), 4 * pi**2 / (4 + pi)),
    "modified trapezoid": (2.0, 8 * pi / (2 + pi)),
    "3-4-5": (15 / 8, 10 / sqrt(3)),
    "4-5-6-7": (35 / 16, 84 / sqrt(5) / 5),
    "harmonic": (pi / 2, pi**2 / 2),
    "s-curve": (1.5, 6.0),
    "trapezoid": (1.5, 4.5),
    "linear": (1.0, 0.0),
}
FIRST_JUMP = {"harmonic": 2, "trapezoid": 2, "s-curve": 3, "linear": 1, "4-5-6-7": 4}
"""Lowest derivative that jumps between a law and a dwell; the third of all others."""


def radian(*values: float) -> tuple[float, ...]:
    return tuple(map(radians, values))


def swing(law: str, *, turns: int = 1) -> AngleLaw:
    """From -30 to 30 degrees, a dwell, and back."""
    ways = ((120, 30), (60, 30), (360 * turns - 180, -30))
    segments = tuple(AngleSegment(*radian(over, to), law) for over, to in ways)
    return AngleLaw(start=radians(-30), segments=segments, turns=turns)


@pytest.mark.parametrize("law", LAWS)
def test_a_law_goes_from_0_to_1_with_the_factors_of_textbooks(law):
    curve = NORMAL[law]()
    x = np.unique([*np.linspace(0, 1, 20001), 0.5 - sqrt(3) / 6, 0.5 - sqrt(5) / 10])
    y, y1, y2 = curve.at(x[:-1])
    assert y[0] == pytest.approx(0, abs=1e-15)
    assert curve.rise == pytest.approx(1, abs=1e-15)
    velocity, acceleration = PEAKS[law]
    assert np.max(y1) == pytest.approx(velocity, rel=1e-8)
    assert np.max(np.abs(y2)) == pytest.approx(acceleration, rel=1e-7)
    np.testing.assert_allclose(curve.at(1 - x[1:-1])[0], 1 - y[1:], atol=1e-14)


@pytest.mark.parametrize("law", [name for name in LAWS if name != "linear"])
def test_derivatives_are_those_of_the_value(law):
    motion = swing(law, turns=2)
    theta = np.random.default_rng(1).uniform(-20, 20, 40)
    step = 1e-4
    for k in range(2):
        low, high = (motion.value(theta + way)[k] for way in (-step, step))
        differences = (high - low) / (2 * step)
        np.testing.assert_allclose(motion.value(theta)[k + 1], differences, atol=1e-3)
        assert np.median(np.abs(motion.value(theta)[k + 1] - differences)) < 1e-7


def test_a_swing_by_a_sine_is_the_same_in_digits():
    motion = AngleLaw(between=radian(-30, 30), phase=0.3)
    for angle in (0.3, 1.0, 4.0):
        of = mpmath.mpf(angle) - mpmath.mpf(0.3)
        wanted = [-mpmath.cos(of), mpmath.sin(of), mpmath.cos(of)]
        actual = [float(part) for part in motion.value(angle)]
        assert actual == pytest.approx([radians(30) * float(item) for item in wanted], abs=1e-15)
    assert [motion.jumps(order).size for order in range(5)] == [0] * 5


@pytest.mark.parametrize("law", [name for name in LAWS if name != "linear"])
def test_it_reports_where_which_derivative_jumps(law):
    motion = swing(law)
    first = FIRST_JUMP.get(law, 3)
    assert all(motion.jumps(order).size == 0 for order in range(first))
    ends = motion.jumps(first)
    result = np.min(np.abs(ends[:, None] - radian(0, 120, 180)), axis=0)
    assert np.degrees(result[1:]) == pytest.approx([0, 0], abs=1e-9)


def test_a_dwell_stands_still_and_the_next_turn_is_the_same():
    motion = swing("modified sine")
    still = motion.value(np.linspace(*radian(121, 179), 7))
    np.testing.assert_allclose(still[0], radians(30), atol=1e-15)
    np.testing.assert_array_equal(still[1:], 0)
    theta = np.linspace(0, 6, 9)
    np.testing.assert_allclose(motion.value(theta + 4 * pi), motion.value(theta), atol=1e-13)
    assert np.degrees(motion.extremes) == pytest.approx([-30, 30])
    assert motion.windings == 0


def test_a_full_turn_with_stops_gains_a_turn_in_each_cycle():
    segments = tuple(AngleSegment(*radian(90, to)) for to in (180, 180, 360, 360))
    motion = AngleLaw(segments=segments)
    assert not [*wrong_law("", motion)]
    assert motion.windings == 1
    angle = motion.value(np.radians([0, 45, 90, 135, 270, 405]))[0]
    assert np.degrees(angle) == pytest.approx([0, 90, 180, 180, 360, 450])


@pytest.mark.parametrize(("name", "degree"), [("cubic", 3), ("quintic", 5)])
def test_a_spline_is_that_of_scipy(name, degree):
    at, values = radian(10, 80, 150, 230, 300), radian(0, 70, 130, 260, 300)
    motion = AngleLaw(crank_angles=(*at, at[0] + 2 * pi), values=(*values, 2 * pi), spline=name)
    assert motion.windings == 1
    knots = np.array([*at, at[0] + 2 * pi])
    rest = np.array([*values, 2 * pi]) - (knots - knots[0])
    rest[-1] = rest[0]
    periodic = make_interp_spline(knots, rest, k=degree, bc_type="periodic")
    theta = np.linspace(knots[0], knots[-1], 101)[:-1]
    y, y1, y2 = motion.value(theta)
    np.testing.assert_allclose(y, periodic(theta) + theta - knots[0], atol=1e-13)
    np.testing.assert_allclose(y1, periodic(theta, 1) + 1, atol=1e-12)
    np.testing.assert_allclose(y2, periodic(theta, 2), atol=1e-11)
    assert [motion.jumps(order).size for order in range(degree)] == [0] * degree


def test_a_spline_closes_by_itself_where_no_row_does():
    values = (1.0, 2.0, 0.0)
    closed = spline(np.array([0, 2, 4, 2 * pi]), np.array([*values, 1.0]), 3)
    motion = LengthLaw(crank_angles=(0.0, 2.0, 4.0), values=values)
    assert not [*wrong_law("", motion)]
    np.testing.assert_array_equal(motion.value(np.array([1.0, 6.0])), closed.at([1.0, 6.0]))


WRONG = {
    "give exactly one of between": AngleLaw(),
    "take 290 deg of crank angle": AngleLaw(segments=(AngleSegment(*radian(290, 0)),)),
    "begins at 0 deg and ends at 20 deg; let it come back, or": AngleLaw(
        segments=(AngleSegment(*radian(360, 20)),)
    ),
    "begins at 0 mm and ends at 20 mm; let it come back": LengthLaw(
        segments=(LengthSegment(2 * pi, 0.02),)
    ),
    "speed jumps at crank angle 0 deg": AngleLaw(
        segments=tuple(AngleSegment(*radian(180, to), "linear") for to in (50, 0))
    ),
    "goes with segments": LengthLaw(between=(0.0, 1.0), start=0.003),
    "got 3 values at 2 angles": AngleLaw(crank_angles=(0, 1), values=(0, 1, 2)),
    "crank angle must rise from row to row": AngleLaw(crank_angles=(0, 2, 1), values=(0, 1, 2)),
    "over 401.07 deg of crank angle, more than the 360 deg": AngleLaw(
        crank_angles=(0, 2, 7), values=(0, 1, 2)
    ),
}


@pytest.mark.parametrize("problem_text", WRONG)
def test_what_is_wrong_is_reported_in_one_sentence(problem_text):
    (problem,) = wrong_law("drive.motion", WRONG[problem_text])
    assert problem_text in str(problem)
    assert str(problem).startswith("drive.motion")
    (of_cam,) = wrong_law("cams[1].lift", WRONG[problem_text], CAM)
    assert problem_text.replace("crank angle", "cam angle") in str(of_cam)
    assert "crank angle" not in str(of_cam)
