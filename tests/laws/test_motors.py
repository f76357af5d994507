"""Motors in a run: closed forms of a direct-current motor, points of Kloss' curve, energy."""

from __future__ import annotations

import json
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.loads import Load
from equipoise.mechanism.parts.motors import DcMotor, InductionMotor, Motor, ServoMotor
from equipoise.running.blocks import verdict
from equipoise.running.collocation import Instant
from equipoise.running.drivers import Controller
from equipoise.running.equation import CrankEquation
from equipoise.running.integration import Integration
from equipoise.schema.files import json_text
from equipoise.vibration.steady import speed_at
from laws.test_run import GRAVITY, INERTIA, WEIGHT, crank
from support.refusals import refused
from surface.running import equipoise
from unit.schema.samples import survives

DC = DcMotor("24 V", "0.4 ohm", 0.5, "50 mH")
RATIO, ROTOR = 2.0, 0.01
WHOLE = INERTIA + RATIO**2 * ROTOR


def driven(dc: DcMotor = DC, speed: float = 10.0, gravity: float = 0.0) -> eq.Machine:
    return crank(Motor(dc=dc, ratio=RATIO, inertia=ROTOR), speed, gravity)


@pytest.mark.exhaustive(but=["1.0-0.5", "-1.0-0.05"])
@pytest.mark.parametrize("inductance", [0.05, 0.5])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_step_of_voltage(inductance: float, sense: float) -> None:
    """Exactly: J dw/dt = n k i, L di/dt = U - R i - n k w by a matrix exponential; the larger
    inductance lets the motor swing about its no-load speed.
    """
    run = eq.run(driven(replace(DC, inductance=inductance), 10.0 * sense), "2 s")
    gear = RATIO * 0.5
    rates = np.array([[0.0, gear / WHOLE], [-gear / inductance, -0.4 / inductance]])
    end = np.linalg.solve(rates, [0.0, -24.0 / inductance])
    some = slice(None, None, 40)
    exact = np.array([end - expm(rates * time) @ end for time in run.time[some]])
    assert run.electric is not None
    assert np.max(np.abs(sense * run.crank_speed[some] - exact[:, 0])) < 1e-9 * 24 / gear
    assert np.max(np.abs(run.electric.current[some] - exact[:, 1])) < 1e-9 * 60
    assert run.energy_error < 1e-10
    assert np.max(np.abs(run.drive_torque - sense * gear * run.electric.current)) < 1e-9


def test_without_inductance_it_is_a_straight_line() -> None:
    """And what it takes from its supply is work and heat."""
    plain = eq.run(driven(replace(DC, inductance=0.0)), "1 s")
    line = Motor(24 / 0.5, 0.5 * 24 / 0.4, ratio=RATIO, inertia=ROTOR)
    other = eq.run(crank(line, 10.0, 0.0), "1 s")
    assert plain.crank_speed[-1] == pytest.approx(other.crank_speed[-1], rel=1e-10)
    assert plain.electric is not None and other.electric is None
    current = (24 - 0.5 * RATIO * plain.crank_speed) / 0.4
    np.testing.assert_allclose(plain.electric.current, current, atol=1e-9)
    assert plain.energy_error < 1e-10


def test_a_machine_runs_on_it_and_the_energies_balance() -> None:
    """Switched off, the field of its current turns into heat."""
    motor = Motor(dc=DcMotor("24 V", "0.2 ohm", 0.15, "2 mH"), ratio=5.0)
    machine = eq.load("transplanter").with_drive(motor=motor)
    run = eq.run(machine)
    assert run.end.kind == "steady" and run.energy_error < 1e-10
    off = eq.run(machine, "0.5 s", off="0.3 s")
    assert off.electric is not None
    after = off.time > 0.3 + 1e-12
    assert np.all(off.electric.current[after] == 0) and np.all(off.drive_torque[after] == 0)
    assert np.ptp(off.electric.supply[after]) == 0 and off.energy_error < 1e-10


def test_a_weight_holds_the_crank_until_the_current_is_large_enough() -> None:
    """Level at the start; the torque n k U / R (1 - exp(-t R / L)) has to reach the weight's."""
    run = eq.run(driven(gravity=GRAVITY), "0.4 s")
    moves = run.time[np.argmax(run.crank_speed > 0) - 1]
    share = WEIGHT / (RATIO * 0.5 * 24 / 0.4)
    assert moves == pytest.approx(-0.05 / 0.4 * np.log(1 - share), rel=1e-6)
    assert run.energy_error < 1e-10
    held = replace(driven(), joints=(JointProperties("joints.A", drag_torque=4.0),))
    later = eq.run(held, "0.4 s")
    moves = later.time[np.argmax(later.crank_speed > 0) - 1]
    assert moves == pytest.approx(-0.05 / 0.4 * np.log(1 - 4.0 / 60.0), rel=1e-6)
    assert later.energy_error < 1e-10


KLOSS = InductionMotor("1500 rpm", 42.0, 0.22)


def test_points_of_the_curve_of_kloss() -> None:
    field = 1500 * 2 * np.pi / 60
    assert KLOSS.torque(field) == 0.0
    assert KLOSS.torque(field * (1 - 0.22)) == pytest.approx(42.0)
    assert KLOSS.torque(0.0) == pytest.approx(2 * 42 * 0.22 / (1 + 0.22**2))
    assert KLOSS.torque(field * 1.22) == pytest.approx(-42.0)
    motor = Motor(induction=KLOSS)
    for torque in (-10.0, 0.0, 3.0, 41.0):
        assert KLOSS.torque(speed_at(motor, torque)) == pytest.approx(torque, abs=1e-12)
    assert KLOSS.speed_at(43.0) is None


def test_a_start_along_the_curve_takes_the_time_of_its_integral() -> None:
    """J dw / T(w) = dt in closed form: with s = slip, J w_s / (2 T_b) ((1 - s^2) / (2 s_b) + s_b
    ln(1 / s)).
    """
    machine = crank(Motor(induction=KLOSS, inertia=ROTOR), 10.0, 0.0)
    run = eq.run(machine, turns=40)
    field = 1500 * 2 * np.pi / 60
    slip = 1 - run.crank_speed[1:] / field
    time = (1 - slip**2) / (2 * 0.22) + 0.22 * np.log(1 / slip)
    time = time * (INERTIA + ROTOR) * field / (2 * 42.0)
    np.testing.assert_allclose(run.time[1:], time, rtol=1e-7, atol=1e-9)
    assert run.energy_error < 1e-10


def test_an_induction_motor_that_is_overloaded_stalls() -> None:
    """Pulled down by more than its breakdown torque."""
    loaded = replace(
        crank(Motor(induction=KLOSS), 150.0, 0.0), loads=(Load("crank", torque=-45.0),)
    )
    run = eq.run(loaded, speed=150.0, turns=2000)
    assert run.end.kind == "stall"


def test_they_are_read_printed_and_written(tmp_path: Any) -> None:
    for motor in (Motor(dc=DC, ratio=RATIO), Motor(induction=KLOSS), Motor(servo=SERVO)):
        machine = crank(motor)
        survives(machine)
        eq.save(machine, tmp_path / "motor.toml")
        out = equipoise("check", str(tmp_path / "motor.toml")).out
        kinds = ("direct current, ", "induction, 1500 rpm without slip", "servo, 382.0 rpm, 6")
        assert any(kind in out for kind in kinds)
    run = eq.run(driven(), "2 s")
    content = json.loads(json_text(run.to_dict()))["electric"]
    assert content["current"][-1] == run.electric.current[-1]
    names = [f"{name} [{unit}]" for name, unit, _ in run.columns()]
    assert names[-3:] == ["electric.current [A]", "electric.supply [J]", "electric.heat [J]"]
    shown = " ".join(map(str, run.blocks()))
    assert "heat in the motor" in shown and "current of the motor" in shown


@pytest.mark.parametrize(
    "given",
    [{"dc": DC, "torque": 1.0}, {"induction": KLOSS, "dc": DC}, {"no_load_speed": 3.0, "dc": DC}],
)
def test_a_motor_is_of_one_kind(given: dict[str, Any]) -> None:
    with refused(ModelError, "drive.motor", no_load_speed="no_load_speed"):
        crank(Motor(**given))


# -- brakes ----------------------------------------------------------------------------------------


def braked(machine: eq.Machine, brake: float, motor: Motor | None = None) -> eq.Machine:
    return machine.with_drive(brake=brake, motor=motor)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_brake_stops_a_crank_and_takes_its_energy(sense: float) -> None:
    """Two turns by a constant torque T, and then 2 T / B more; evenly, as of a constant torque."""
    run = eq.run(braked(crank(speed=sense, gravity=0.0), 3.0, Motor(torque=4.0)), off_turns=2)
    fastest = np.sqrt(2 * 4.0 * 4 * pi / INERTIA)
    assert [event.kind for event in run.events] == ["off", "standstill"]
    assert run.stopping == pytest.approx((fastest * INERTIA / 3.0, 2 * 4 / 3), rel=1e-8)
    assert run.work["brake"][-1] == pytest.approx(-16 * pi, rel=1e-9)
    assert run.energy_error < 1e-11
    after = run.time >= run.events[0].time
    left = sense * (fastest - 3.0 / INERTIA * (run.time - run.events[0].time))
    assert np.max(np.abs(run.crank_speed - left)[after]) < 1e-7 * fastest
    assert "it stops in 1.603 s and 2.667" in verdict(run)
    assert run.to_dict()["stopping"]["turns"] == run.stopping[1]


def test_a_brake_does_nothing_while_a_motor_is_on() -> None:
    driven_on = braked(crank(gravity=0.0), 3.0, Motor(torque=4.0))
    with_it, without = (
        eq.run(item, turns=3) for item in (driven_on, driven_on.with_drive(brake=0.0))
    )
    assert with_it.end.time == pytest.approx(without.end.time, rel=1e-12)
    assert np.all(with_it.work["brake"] == 0) and "brake" not in without.work
    assert with_it.stopping is None


def test_a_brake_holds_what_is_smaller() -> None:
    """A crank whose weight pulls at it, level."""
    held = eq.run(braked(crank(), 1.001 * WEIGHT), speed=0.0)
    assert held.end.kind == "standstill" and held.end.time == 0
    falls = eq.run(braked(crank(), 0.999 * WEIGHT), speed=0.0)
    assert falls.end.kind == "standstill" and falls.end.time > 0
    assert falls.end.crank_angle < 0


def test_a_braked_pendulum_stops_where_its_energy_says() -> None:
    """From -90 deg on at 3 rad/s: J w^2 / 2 = B a + W (1 - cos a), as far as it goes; then it
    swings back if its weight is stronger there than the brake.
    """
    weak, speed = WEIGHT / 20, 3.0

    def left(way: float) -> float:
        return INERTIA * speed**2 / 2 - weak * way - WEIGHT * (1 - np.cos(way))

    run = eq.run(braked(crank(), weak), speed=speed, angle=-pi / 2)
    back = next(event for event in run.events if event.kind == "reversal")
    assert back.crank_angle + pi / 2 == pytest.approx(brentq(left, 0.0, pi), abs=1e-8)
    assert run.end.kind == "standstill"
    assert WEIGHT * abs(np.sin(run.end.crank_angle + pi / 2)) < weak
    assert run.energy_error < 1e-10


def test_a_brake_presses_rubbing_joints_as_a_load_does() -> None:
    """A torque against the motion, by the table of loads, is the same while the crank turns on."""
    machine = eq.load("plunger-pump").with_drive(motor=None)
    load = Load(machine.drive.link, torque=-np.sign(machine.drive.speed) * 2.0)
    fast = 10 * machine.drive.speed
    loaded = eq.run(replace(machine, loads=(*machine.loads, load)), turns=1.5, speed=fast)
    run = eq.run(braked(machine, 2.0), turns=1.5, speed=fast)
    assert run.end.kind == "turns"
    assert run.end.time == pytest.approx(loaded.end.time, rel=1e-9)
    assert run.end.speed == pytest.approx(loaded.end.speed, rel=1e-9)
    assert run.work["friction"][-1] == pytest.approx(loaded.work["friction"][-1], rel=1e-8)
    assert run.work["friction"][-1] < 0 > run.work["brake"][-1]


def test_a_brake_in_a_file() -> None:
    machine = braked(crank(), 5.0)
    assert eq.loads(eq.dumps(machine)) == machine
    with refused(ModelError, "drive.brake"):
        braked(crank(), -5.0)


# -- servo motors ----------------------------------------------------------------------------------

SERVO = ServoMotor(speed=40.0, torque_limit=6.0, speed_gain=0.5)


def servoed(servo: ServoMotor, speed: float = 10.0, gravity: float = 0.0) -> eq.Machine:
    return crank(Motor(servo=servo, ratio=RATIO, inertia=ROTOR), speed, gravity)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_servo_motor_starts_at_its_limit_and_then_by_its_gain(sense: float) -> None:
    """Evenly, up to the speed at which the gain gives the limit, and exponentially from there."""
    run = eq.run(servoed(SERVO, sense), "1.2 s")
    rate, tau = RATIO * 6.0 / WHOLE, WHOLE / (RATIO**2 * 0.5)
    corner = (40.0 - 6.0 / 0.5) / RATIO
    late = run.time - corner / rate
    exact = np.where(late < 0, rate * run.time, 20.0 - 6.0 * np.exp(-late / tau))
    np.testing.assert_allclose(sense * run.crank_speed, exact, atol=1e-7)
    assert sense * run.drive_torque[0] == RATIO * 6.0
    assert run.energy_error < 1e-10


@pytest.mark.exhaustive(but=["3.0-1.0", "30.0--1.0", "0.0-1.0"])
@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("first", [0.0, 3.0, 30.0])
def test_a_servo_motor_follows_a_ramp(sense: float, first: float) -> None:
    """Exactly, by a matrix exponential of crank, reference and its acceleration, below the limit;
    from a speed above the reference's too.
    """
    servo = replace(SERVO, torque_limit=1e3, angle_gain=4.0, acceleration=60.0)
    run = eq.run(servoed(servo, sense), "1.5 s", speed=sense * first, angle=0.7)
    stiff, damp = np.array([4.0, 0.5]) * RATIO / WHOLE
    rates = np.zeros((5, 5))  # crank's angle and speed, reference's, its acceleration
    rates[[0, 2, 3], [1, 3, 4]] = 1.0
    rates[1, :4] = -RATIO * stiff, -RATIO * damp, stiff, damp
    begin = np.array([0.0, first, 0.0, RATIO * first, np.sign(40 - RATIO * first) * 60.0])
    end = abs(40.0 - RATIO * first) / 60.0
    assert 0 < end < 1.5
    after = expm(rates * end) @ begin
    after[4] = 0.0
    some = slice(None, None, 7)
    exact = np.array([
        expm(rates * time) @ begin if time < end else expm(rates * (time - end)) @ after
        for time in run.time[some]
    ])  # fmt: skip
    np.testing.assert_allclose(sense * run.crank_speed[some], exact[:, 1], atol=1e-8)
    np.testing.assert_allclose(sense * (run.crank_angle[some] - 0.7), exact[:, 0], atol=1e-8)
    assert run.energy_error < 1e-10


def test_a_servo_motor_drives_a_linkage_as_in_time() -> None:
    """By SciPy's DOP853 on the equation of the crank, with the controller written anew; the limit
    is reached on the way.
    """
    servo = ServoMotor(speed=250.0, torque_limit=0.03, speed_gain=0.3, angle_gain=2.0,
                       acceleration=2500.0)  # fmt: skip
    machine = eq.load("transplanter").with_drive(motor=Motor(servo=servo, ratio=12.0))
    run = eq.run(machine, "0.2 s")
    equation, sense = CrankEquation(machine), np.sign(machine.drive.speed)

    def driving(time: float, angle: float, speed: float) -> float:
        ramp = min(time, 250.0 / 2500.0)
        ahead = 1250.0 * ramp**2 + 250.0 * (time - ramp) - 12.0 * sense * angle
        torque = 2.0 * ahead + 0.3 * (2500.0 * ramp - 12.0 * sense * speed)
        return float(12.0 * sense * np.clip(torque, -0.03, 0.03))

    def rates(time: float, state: np.ndarray) -> list[float]:
        given = driving(time, *state)
        inertia, slope, torques = equation.at(state[0], state[1], given, sense)
        return [state[1], (float(np.sum(torques)) + given - slope * state[1] ** 2 / 2) / inertia]

    leaves = float(run.time[np.argmax(run.crank_angle != 0.0) - 1])
    acting = float(np.sum(equation.at(0.0, 0.0)[2]))
    assert driving(leaves, 0.0, 0.0) == pytest.approx(-acting, rel=1e-6)
    by_time = solve_ivp(rates, (leaves, 0.2), [0.0, 0.0], "DOP853", rtol=1e-8, atol=1e-8)
    assert run.end.crank_angle == pytest.approx(by_time.y[0, -1], rel=1e-6)
    assert run.end.speed == pytest.approx(by_time.y[1, -1], rel=1e-6)
    limited = np.abs(run.drive_torque) > 0.999 * 12.0 * 0.03
    assert np.any(limited) and not np.all(limited)
    assert run.energy_error < 1e-10


def test_a_limit_of_torque_ends_a_piece(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where it is reached or left the torque has a corner, beside which pieces were halved and
    integrated in time: 2.1 s of processor time for 1.7 turns, which now take 0.13 s.  Time is left
    to the start alone, from rest to the limit and a little beyond.
    """
    calls = []
    original = Integration._in_time

    def counted(self: Integration, begin: Instant, edge: float) -> Instant | None:
        calls.append(begin.time)
        return original(self, begin, edge)

    monkeypatch.setattr(Integration, "_in_time", counted)
    servo = ServoMotor(speed=250.0, torque_limit=0.03, speed_gain=0.3, angle_gain=2.0,
                       acceleration=2500.0)  # fmt: skip
    machine = eq.load("transplanter").with_drive(motor=Motor(servo=servo, ratio=12.0))
    run = eq.run(machine, "0.6 s")
    limited = np.abs(run.drive_torque) > (1 - 1e-9) * 12.0 * 0.03
    assert np.count_nonzero(np.diff(limited.astype(int))) > 4
    assert len(calls) <= 2
    assert run.energy_error < 1e-11
    assert np.all(np.abs(run.drive_torque) <= 12.0 * 0.03 * (1 + 1e-15))


def test_a_servo_motor_that_holds_its_angle_does_not_fall_behind() -> None:
    """The mean speed of a steady state is the reference speed, whatever resists."""
    load = Load("crank", torque=-4.0)
    held, slower = (
        eq.run(replace(servoed(replace(SERVO, angle_gain=gain), gravity=GRAVITY), loads=(load,)))
        for gain in (3.0, 0.0)
    )
    assert held.end.kind == slower.end.kind == "steady"
    assert held.last_cycle is not None and slower.last_cycle is not None
    assert held.last_cycle.mean_speed == pytest.approx(20.0, rel=1e-5)
    assert slower.last_cycle.mean_speed == pytest.approx(20.0 - 4.0 / (RATIO**2 * 0.5), rel=1e-2)


# Its servo motor alone: `test_a_servo_motor_follows_a_ramp`.
@pytest.mark.exhaustive
def test_the_carton_pusher_starts_and_is_stopped() -> None:
    """As its file says: by the ramp to 60 rpm, whatever the load; then the brake takes what moves.

    The crank lags behind the ramp by half of its time, as far as the angle does not swing.
    """
    run = eq.run(eq.load("carton-pusher"))
    assert [event.kind for event in run.events] == ["off", "standstill"]
    off = run.events[0]
    assert off.crank_angle == pytest.approx(20 * pi)
    assert off.time == pytest.approx(10.0 + 0.5 * 1800 * pi / 30 / 600, abs=0.05)
    assert run.stopping is not None
    assert run.work["brake"][-1] == pytest.approx(-10.0 * run.stopping[1] * 2 * pi, rel=1e-9)
    assert run.last_cycle is not None
    assert run.last_cycle.mean_speed == pytest.approx(2 * pi, rel=1e-3)
    # 120 N over the way of the pusher from 262 to 352 deg, ten times
    ends = eq.move(run.machine, np.radians([262.0, 352.0])).points["F"].x
    assert run.work["loads"][-1] == pytest.approx(-1200 * (ends[1] - ends[0]), rel=1e-9)
    assert run.energy_error < 1e-9


def test_a_servo_motor_waits_for_its_ramp() -> None:
    """A weight on a level crank holds it until the torque is large enough, or for ever."""
    ramp = replace(SERVO, acceleration=60.0, speed_gain=0.1)
    run = eq.run(servoed(ramp, gravity=GRAVITY), "0.7 s")
    moves = run.time[np.argmax(run.crank_speed > 0) - 1]
    assert moves == pytest.approx(WEIGHT / (RATIO * 0.1 * 60.0), rel=1e-6)
    by_angle = eq.run(servoed(replace(ramp, angle_gain=1.0), gravity=GRAVITY), "0.7 s")
    moves = by_angle.time[np.argmax(by_angle.crank_speed > 0) - 1]
    assert 0.1 * 60 * moves + 30 * moves**2 == pytest.approx(WEIGHT / RATIO, rel=1e-6)
    weak = eq.run(servoed(replace(ramp, torque_limit=0.9 * WEIGHT / RATIO), gravity=GRAVITY))
    assert weak.end.kind == "stall" and weak.end.time == 0


def test_a_servo_motor_lets_its_crank_swing_back_until_it_is_strong_enough() -> None:
    """After a push, by a slow ramp: the weight turns it back first, and later it goes round."""
    slow = ServoMotor(speed=40.0, torque_limit=6.0, speed_gain=0.02, angle_gain=0.3,
                      acceleration=3.0)  # fmt: skip
    run = eq.run(servoed(slow, gravity=GRAVITY), "6 s", speed=2.0, angle=-pi / 2)
    kinds = [event.kind for event in run.events]
    assert "reversal" in kinds and kinds[-1] == "time"
    assert run.turned > 2 and run.energy_error < 1e-9
    equation = CrankEquation(run.machine)

    def rates(time: float, state: np.ndarray) -> list[float]:
        ramp = min(time, 36.0 / 3.0)
        ahead = 4.0 * ramp + 1.5 * ramp**2 + 40.0 * (time - ramp) - RATIO * (state[0] + pi / 2)
        torque = 0.3 * ahead + 0.02 * (4.0 + 3.0 * ramp - RATIO * state[1])
        weight = float(np.sum(equation.at(state[0], state[1])[2]))
        return [state[1], (weight + RATIO * float(np.clip(torque, -6.0, 6.0))) / WHOLE]

    by_time = solve_ivp(rates, (0.0, 6.0), [-pi / 2, 2.0], "DOP853", rtol=1e-10, atol=1e-10)
    assert run.end.crank_angle == pytest.approx(by_time.y[0, -1], rel=1e-6)


def test_a_servo_motor_in_other_commands_goes_by_its_speed_alone() -> None:
    motor = Motor(servo=replace(SERVO, angle_gain=3.0, acceleration=60.0))
    for torque in (-5.0, 0.0, 5.0):
        assert 0.5 * (40.0 - speed_at(motor, torque)) == pytest.approx(torque, abs=1e-12)


@pytest.mark.parametrize("gain", [0.0, 2.0])
@pytest.mark.parametrize("acceleration", [None, 20.0])
@pytest.mark.parametrize(("first", "angle", "since"), [(0.0, 0.0, 0.0), (4.0, 7.0, 1.0)])
def test_when_the_torque_of_a_servo_motor_at_rest_is_large_enough(
    gain: float, acceleration: float | None, first: float, angle: float, since: float
) -> None:
    """It is what was asked for then, and less before; on the ramp, after it, and from a time on."""
    servo = replace(SERVO, torque_limit=1e3, angle_gain=gain, acceleration=acceleration)
    controller = Controller(servo, first)
    for torque in (-10.0, 8.0, 19.0, 200.0 if gain else 20.0):
        time = controller.time_until(torque, angle, since)
        given = float(controller.torque(0.0, angle, time))
        assert time >= since
        assert given == pytest.approx(torque, rel=1e-12) or (time == since and given > torque)
