"""Runs on a fixed frame: motions with a known answer, energy, and SciPy on the same equation."""

from __future__ import annotations

import itertools
from dataclasses import replace
from math import acos, pi
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

import equipoise as eq
from equipoise.errors import ResponseError, UsageError
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.motors import Motor
from equipoise.running import integration
from equipoise.running.blocks import run_blocks, run_headline, verdict
from equipoise.running.collocation import Instant
from equipoise.running.drivers import Driver
from equipoise.running.equation import CrankEquation
from equipoise.running.integration import Integration
from equipoise.running.run_results import Run
from support.analyses import subject_of
from support.chosen import EXHAUSTIVE, few
from support.refusals import refused, values_of

MASS, ARM, OWN, GRAVITY = 2.0, 0.3, 0.05, 9.81
INERTIA = OWN + MASS * ARM**2
WEIGHT = MASS * GRAVITY * ARM
"""Torque of the weight on a level crank, N m."""


def crank(motor: Motor | None = None, speed: float = 10.0, gravity: float = GRAVITY) -> eq.Machine:
    """One turning link, whose weight hangs straight down at crank angle -90 deg."""
    link = eq.Link({"A": (0.0, 0.0), "B": (1.0, 0.0)}, MASS, (ARM, 0.0), OWN)
    return eq.Machine(
        "crank",
        eq.Drive("crank", speed, motor=motor),
        {"A": (0.0, 0.0)},
        {"crank": link},
        gravity=(0.0, -gravity),
    )


def test_a_constant_torque_without_resistance() -> None:
    run = eq.run(crank(Motor(torque=4.0), gravity=0.0), turns=5)
    rate = 4.0 / INERTIA
    assert run.end.kind == "turns"
    assert run.end.time == pytest.approx(np.sqrt(2 * 10 * pi / rate), rel=1e-9)
    assert run.crank_speed == pytest.approx(rate * run.time, rel=1e-8)
    assert run.work["drive"][-1] == pytest.approx(4.0 * 10 * pi, rel=1e-9)


def test_weight_that_does_nothing_is_tabulated_as_nothing() -> None:
    """Of level strokes only rounding is left, which was halved to thousands of pieces a turn."""
    guide = eq.Slider("ram", "C", on="frame", through="A", direction=0.0)
    links = {
        "crank": eq.Link({"A": (0.0, 0.0), "B": (0.03, 0.0)}, 0.5, (0.0, 0.0), 1e-4),
        "rod": eq.Link({"B": (0.0, 0.0), "C": (0.11, 0.0)}, 0.2, (0.11, 0.0), 1e-5),
        "ram": eq.Link({"C": (0.0, 0.0)}, 0.4, (0.07, 0.0), 1e-4),
    }
    level = eq.Machine("level", eq.Drive("crank", 80.0, motor=Motor(torque=2.0)),
                       {"A": (0.0, 0.0)}, links, {"C": "forward"}, (guide,))  # fmt: skip
    up = replace(level, gravity=(-9.81, 0.0))
    pieces, others = (len(CrankEquation(machine).table.lows) for machine in (level, up))
    assert pieces <= others < 100


def test_a_motor_of_a_straight_line_starts_exponentially() -> None:
    motor = Motor(300.0, 20.0, ratio=3.0, inertia=0.01)
    run = eq.run(crank(motor, -10.0, 0.0))
    tau = (INERTIA + 9 * 0.01) / (9 * 20.0 / 300.0)
    assert run.end.kind == "steady"
    wanted = -100.0 * (1 - np.exp(-run.time / tau))
    assert run.crank_speed == pytest.approx(wanted, abs=1e-6)
    assert run.starting_time == pytest.approx(-tau * np.log(0.05), rel=1e-3)


def test_a_stiff_start_is_followed_by_angle(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces in which the speed changes too quickly are halved, which takes a twentieth of the time
    that integration in time does; only the moment about standstill is left to that.
    """
    calls = []
    original = Integration._in_time

    def counted(self: Integration, begin: Instant, edge: float) -> Instant | None:
        calls.append((begin.speed, edge - begin.angle))
        return original(self, begin, edge)

    monkeypatch.setattr(Integration, "_in_time", counted)
    machine = eq.load("transplanter").with_drive(motor=Motor(270 * pi / 30, 20.0))
    run = eq.run(machine, turns=5)
    assert len(calls) == 1
    assert calls[0][0] == 0.0
    assert calls[0][1] < pi / 90
    assert run.energy_error < 1e-11
    assert run.crank_speed[-1] == pytest.approx(speed_by_scipy(machine, run), rel=1e-8)


# How many rounds it takes changes no figure; motion near a steady state: test_flywheels.py.
@pytest.mark.exhaustive
def test_near_a_steady_state_a_piece_takes_few_rounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each is begun with what the cycle before has gained there, so that 30 turns take 0.3 s; the
    motion is that of a run without that knowledge.
    """
    counts = {"_torques": 0, "_by_angle": 0}

    def counted(name: str) -> Any:
        original = getattr(Integration, name)

        def call(self: Integration, *values: Any) -> Any:
            counts[name] += 1
            if forgets:
                self.cycle_before.clear()
            return original(self, *values)

        return call

    for name in counts:
        monkeypatch.setattr(Integration, name, counted(name))
    machine = eq.load("transplanter").with_drive(motor=Motor(270 * pi / 30, 20.0))
    forgets = False
    run = eq.run(machine, turns=10)
    assert counts["_torques"] < 3 * counts["_by_angle"]
    forgets = True
    anew = eq.run(machine, turns=10)
    assert run.end.time == pytest.approx(anew.end.time, rel=1e-12)
    assert run.end.speed == pytest.approx(anew.end.speed, rel=1e-11)


def speed_by_scipy(machine: eq.Machine, result: Run) -> float:
    """Crank speed at the end of a run, rad/s, integrated in time from its second cycle on."""
    equation, driver = CrankEquation(machine), Driver.of(machine)
    begin = result.begins[-2]

    def rates(_: float, state: np.ndarray) -> list[float]:
        inertia, slope, torques = equation.at(state[0], state[1])
        driving = float(driver.torque(np.asarray(state[1])))
        change = (float(np.sum(torques)) + driving - slope * state[1] ** 2 / 2) / inertia
        return [state[1], change]

    solution = solve_ivp(
        rates, (begin.time, result.end.time), [begin.angle, begin.speed], "DOP853",
        rtol=1e-10, atol=1e-10,
    )  # fmt: skip
    return float(solution.y[1, -1])


@pytest.mark.exhaustive(but=["3.0"])
@pytest.mark.parametrize("amplitude", few([0.1, 1.5, 3.0], {0.1, 3.0}))
def test_a_pendulum_swings_as_it_has_to(amplitude: float) -> None:
    run = eq.run(crank(), "20 s", speed=0.0, angle=amplitude - pi / 2)
    times = [event.time for event in run.events if event.kind == "reversal"]
    half = 2 * ellipk(np.sin(amplitude / 2) ** 2) / np.sqrt(WEIGHT / INERTIA)
    assert len(times) >= 5
    assert times == pytest.approx(half * np.arange(1, len(times) + 1), rel=1e-8)
    assert run.energy_error < 1e-9
    assert run.last_cycle is None  # it comes by the angle where cycles begin, to and fro
    assert run.to_dict()["last_cycle"] is None


def test_a_weak_motor_stalls_where_its_work_is_used_up() -> None:
    """It lifts the weight from the lowest place as far as its work goes."""
    torque = 0.6 * WEIGHT
    run = eq.run(crank(Motor(torque=torque)), angle=-pi / 2)
    assert run.end.kind == "stall"
    turned = run.end.crank_angle + pi / 2
    assert torque * turned == pytest.approx(WEIGHT * (1 - np.cos(turned)), rel=1e-8)
    assert run.lacking_torque == pytest.approx((WEIGHT * np.sin(turned), torque), rel=1e-8)


def test_a_motor_that_cannot_even_begin() -> None:
    run = eq.run(crank(Motor(torque=0.5 * WEIGHT)))
    assert (run.end.kind, run.end.time) == ("stall", 0.0)
    assert run.lacking_torque == pytest.approx((WEIGHT, 0.5 * WEIGHT))


def test_nothing_sets_a_hanging_crank_in_motion() -> None:
    assert eq.run(crank(gravity=0.0), speed=0.0).end.kind == "standstill"


def test_over_the_top_and_not() -> None:
    """From the lowest place it gets over the highest one with twice its weight's energy."""
    needed = np.sqrt(4 * WEIGHT / INERTIA)
    over = eq.run(crank(), "3 s", speed=1.001 * needed, angle=-pi / 2)
    under = eq.run(crank(), "3 s", speed=0.999 * needed, angle=-pi / 2)
    assert over.turned > 1
    height = np.max(under.crank_angle) + pi / 2
    assert height == pytest.approx(acos(1 - 2 * 0.999**2), rel=1e-6)


def test_switched_off_it_keeps_its_energy() -> None:
    run = eq.run(crank(Motor(torque=5.0)), turns=6, off_turns=2.5, angle=-pi / 2)
    assert [event.kind for event in run.events] == ["off", "turns"]
    assert run.work["drive"][-1] == pytest.approx(5.0 * 5 * pi, rel=1e-9)
    by_time = eq.run(crank(Motor(torque=5.0)), turns=6, off=run.events[0].time, angle=-pi / 2)
    assert by_time.end.time == pytest.approx(run.end.time, rel=1e-8)


SUBJECTS = ["crank_rocker:0", "slider_crank:1", "quick_return:0", "crank_rocker in soil:0"]
SUBJECTS += ["watt-six-bar", "cam-pusher", "four-stroke-engine", "transplanter"]


def motored(name: str) -> eq.Machine:
    """With a motor that turns it at least as fast as its file says."""
    machine = subject_of(name).machine
    motion = eq.move(machine, 90)
    need = float(np.max(np.abs(eq.forces(motion).drive_torque)))
    return machine.with_drive(motor=Motor(3 * abs(machine.drive.speed), 4 * need))


@pytest.mark.parametrize("name", SUBJECTS)
def test_energy_and_time_integration(name: str) -> None:
    """Work done is the linkage's own kinetic energy, and SciPy on the same equation in time, with
    no angle for a clock, comes to the same.
    """
    machine = motored(name)
    run = eq.run(machine, turns=4)
    assert run.end.kind == "turns"
    assert run.energy_error < 1e-9
    equation, driver = CrankEquation(machine), Driver.of(machine)

    def rates(_: float, y: np.ndarray) -> list[float]:
        inertia, slope, torques = equation.at(y[0], y[1])
        torque = float(np.sum(torques) + driver.torque(np.asarray(y[1])))
        return [y[1], (torque - slope * y[1] ** 2 / 2) / inertia]

    time = run.time[-1] / 4  # where soil sets in DOP853 is slow
    done = solve_ivp(rates, (0.0, time), [0.0, 0.0], "DOP853", rtol=1e-9, atol=1e-11)
    k = int(np.searchsorted(run.time, time))
    nearest = run.crank_angle[k] - run.crank_speed[k] * (run.time[k] - time)
    slope = abs(done.y[1, -1]) * abs(run.time[k] - run.time[k - 1])
    assert abs(nearest - done.y[0, -1]) < 1e-6 * abs(done.y[0, -1]) + 0.02 * slope


def test_a_drive_with_nothing_to_do_is_said_to_do_nothing() -> None:
    """Where weight and springs alone act, the microjoules of a last cycle say nothing."""
    machine = eq.load("walking-transplanter")
    text = str([*run_blocks(eq.run(machine))])
    assert "drive: zero mean power, as the file has neither friction nor load" in text
    assert " J in a turn" not in text
    loaded = replace(machine, loads=(eq.Load("coupler", "P", (1e-3, 0.0)),))
    assert "drive: zero mean power" not in str([*run_blocks(eq.run(loaded))])


def test_values_that_cannot_be_used() -> None:
    for values in ({"duration": 0.0}, {"turns": -1}, {"off": float("nan")}, {"turns": 1e9}):
        with pytest.raises(UsageError):
            eq.run(crank(), **values)  # type: ignore[arg-type]
    with pytest.raises(UsageError):
        eq.run(crank(), speed=float("inf"))
    with refused(UsageError, place="drive"):
        eq.run(eq.load("hydraulic-loader"))


@pytest.mark.parametrize(
    ("asked", "given"),
    [
        ({"duration": "30000 s"}, "30000 s"),
        pytest.param({"turns": 10_000}, "10000 turns", marks=EXHAUSTIVE),
    ],
)
def test_what_takes_too_long_is_refused_when_it_goes_on_evenly(
    asked: dict[str, Any], given: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And not after all the pieces that can be followed, which takes a minute."""
    count, piece = itertools.count(), Integration._piece

    def counted(self: Integration, begin: Instant) -> Instant | None:
        assert next(count) < 500
        return piece(self, begin)

    monkeypatch.setattr(Integration, "_piece", counted)
    monkeypatch.setattr(integration, "MOST_PIECES", 1000)
    monkeypatch.setattr(integration, "LOOKED", 64)
    with refused(ResponseError, asked=given) as caught:
        eq.run(crank(Motor(300.0, 400.0)), **asked)
    values = dict(values_of(caught.value.note))
    most, turns = values["time"].removesuffix(" s"), values["turns"]
    assert float(turns) == pytest.approx(float(most) * 300.0 / (2 * pi), rel=0.1)
    monkeypatch.undo()
    monkeypatch.setattr(integration, "MOST_PIECES", 1000)
    assert eq.run(crank(Motor(300.0, 400.0)), 0.95 * float(most)).end.kind == "time"


def test_nothing_is_switched_off_that_is_not_there() -> None:
    for values in ({"off": 0.1}, {"off_turns": 1.0}):
        with refused(UsageError, place="drive.motor"):
            eq.run(crank(), turns=1, **values)


def test_a_crank_that_swings_on_is_said_to_swing(monkeypatch: pytest.MonkeyPatch) -> None:
    """It ended \"at 0 rpm\", between two swings; a few say as much as 200."""
    monkeypatch.setattr(integration, "MOST_REVERSALS", 3)
    swinging = eq.run(crank(), speed=0.0)
    turned_back = [event for event in swinging.events if event.kind == "reversal"]
    assert f"turned back {len(turned_back)} times" in verdict(swinging)


def test_loads_that_drive_a_machine_backwards_are_named() -> None:
    """A torque of 2 N m resists the motor, and drives the crank back once that is off, against a
    viscous joint of 0.1 N m s/rad.
    """
    driven = crank(Motor(no_load_speed=10.0, stall_torque=9.0), gravity=0.0)
    damped = JointProperties("joints.A", torsional_damping=0.1)
    loaded = replace(driven, loads=(eq.Load("crank", torque=-2.0),), joints=(damped,))
    run = eq.run(loaded, off="2 s")
    assert run.end.kind == "steady" and run.driven_back is not None
    assert run.driven_back.kind == "reversal" and run.starting_time is None
    words = verdict(run)
    assert words.startswith("Switched off at 2.000 s, the machine turns back at ")
    assert "driven backwards by the loads" in words and "[[resistances]]" in words
    cycle = run.last_cycle
    assert cycle is not None and cycle.highest <= cycle.mean_speed <= cycle.lowest < 0
    assert cycle.mean_speed == pytest.approx(-2.0 / 0.1, rel=1e-4)
    assert 0 <= cycle.fluctuation < 1e-4


def test_a_machine_that_its_motor_drives_is_not_driven_back() -> None:
    """Clockwise too: its speeds have the sign of their mean."""
    motor = Motor(no_load_speed=10.0, stall_torque=9.0)
    clockwise = crank(motor, speed=-10.0, gravity=1.0)
    run = eq.run(clockwise)
    cycle = run.last_cycle
    assert run.driven_back is None and cycle is not None
    assert cycle.highest < cycle.mean_speed < cycle.lowest < 0 < cycle.fluctuation


@pytest.mark.parametrize(("speed", "remarks"), [(8.0, True), (10.1, False), (10.0, False)])
def test_another_speed_than_that_of_the_drive_is_remarked(speed: float, remarks: bool) -> None:
    """Without weight and loads a motor comes to its speed without load, 10 rad/s = 95.49 rpm."""
    machine = crank(Motor(no_load_speed=10.0, stall_torque=9.0), speed=speed, gravity=0.0)
    words = str([*run_headline(eq.run(machine))])
    assert ("the curve of its motor leads to 95.49 rpm" in words) == remarks
