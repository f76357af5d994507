"""Torque of motors at the crank: lines and tables, ratio, shift, either sense of rotation."""

from __future__ import annotations

import numpy as np
import pytest

from equipoise.errors import ResponseError
from equipoise.mechanism.parts.motors import Motor, MotorTable
from equipoise.vibration.steady import speed_at, torque_on_crank
from support.refusals import refused
from unit.vibration.build import Array

LINE = Motor(100.0, 5.0)
HUMP = Motor(table=MotorTable((0.0, 50.0, 100.0, 110.0), (2.0, 6.0, 4.0, -1.0)))


def torque(motor: Motor, speed: float | list[float], shift: float = 0.0, sense: float = 1) -> Array:
    result = torque_on_crank(motor, sense * 20.0)
    return result(np.atleast_1d(np.array(speed, float)), np.array(shift))


@pytest.mark.parametrize(
    ("motor", "curve"),
    [
        (LINE, {0.0: 5, 50.0: 2.5, 100.0: 0, 120.0: -1, -20.0: 6}),
        (
            HUMP,
            {0.0: 2, 25.0: 4, 50.0: 6, 75.0: 5, 100.0: 4, 105.0: 1.5, 110.0: -1, 120.0: -6}
            | {-10.0: 1.2},
        ),
        (Motor(100.0, 5.0, ratio=4.0), {0.0: 20, 12.5: 10, 25.0: 0}),
    ],
    ids=["line", "table", "geared"],
)
def test_torque_over_speed(motor: Motor, curve: dict[float, float]) -> None:
    """Straight between the rows and on beyond them; a gear turns the motor faster than the crank,
    and its torque acts as many times."""
    assert torque(motor, [*curve]) == pytest.approx([*curve.values()])


def test_a_table_of_two_rows_is_a_line() -> None:
    table = Motor(table=MotorTable((0.0, 100.0), (5.0, 0.0)))
    speeds = np.linspace(-50, 150, 21).tolist()
    np.testing.assert_allclose(torque(table, speeds), torque(LINE, speeds))


def test_power_is_the_same_on_both_sides_of_the_gear() -> None:
    geared = Motor(table=HUMP.table, ratio=3.7)
    crank = np.linspace(1, 29, 15)
    power = torque(geared, crank.tolist()) * crank
    np.testing.assert_allclose(power, torque(HUMP, (3.7 * crank).tolist()) * 3.7 * crank)


def test_shift_moves_the_curve_along_the_speed() -> None:
    """By rad/s of the motor."""
    for motor in (LINE, HUMP):
        assert torque(motor, [60.0], 15.0) == pytest.approx(torque(motor, [45.0]))
    geared = Motor(100.0, 5.0, ratio=4.0)
    assert torque(geared, [15.0], 8.0) == pytest.approx(torque(geared, [13.0]))


@pytest.mark.parametrize("motor", [LINE, HUMP, Motor(90.0, 3.0, ratio=2.0)])
def test_reversed(motor: Motor) -> None:
    """A crank that turns clockwise is driven clockwise, as hard at the same speed."""
    speeds = np.linspace(-5, 110, 24)
    forward = torque(motor, speeds.tolist(), 3.0)
    np.testing.assert_allclose(torque(motor, (-speeds).tolist(), 3.0, sense=-1), -forward)


def test_slopes_by_complex_steps() -> None:
    """The solver asks for derivatives so; each piece has its own."""
    result = torque_on_crank(HUMP, 10.0)
    speeds = np.array([25.0, 75.0, 105.0, 130.0, -3.0])
    slopes = result(speeds + 1e-30j, np.array(0.0)).imag / 1e-30
    assert slopes == pytest.approx([0.08, -0.04, -0.5, -0.5, 0.08])
    by_shift = result(speeds.astype(complex), np.array(1e-30j)).imag / 1e-30
    assert by_shift == pytest.approx(-slopes)


@pytest.mark.parametrize(
    ("motor", "wanted", "speed"),
    [
        (LINE, 2.5, 50.0),
        (LINE, 0.0, 100.0),
        (LINE, -1.0, 120.0),
        (LINE, 7.0, -40.0),
        (HUMP, 5.0, 75.0),
        (HUMP, 3.0, 102.0),
        (HUMP, -6.0, 120.0),
        (HUMP, 6.0, 50.0),
    ],
)
def test_speed_at_a_torque(motor: Motor, wanted: float, speed: float) -> None:
    """On the highest falling branch: there more load slows down, and is held."""
    assert speed_at(motor, wanted) == pytest.approx(speed)
    assert torque(motor, [speed]) == pytest.approx([wanted])


@pytest.mark.parametrize(
    ("motor", "torque"),
    [
        (HUMP, 7.0),
        (Motor(table=MotorTable((0.0, 10.0), (1.0, 2.0))), 1.5),
        (Motor(table=MotorTable((0.0, 10.0), (1.0, 1.0))), 1.0),
    ],
    ids=["too weak", "rising", "level"],
)
def test_a_torque_that_the_motor_nowhere_holds(motor: Motor, torque: float) -> None:
    with refused(ResponseError, torque=torque):
        speed_at(motor, torque)
