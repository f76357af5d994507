"""A flywheel that is sized keeps the speed as it was to: the machine itself is let run with it."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import equipoise as eq
from equipoise.balancing.advice import advise
from equipoise.errors import ResponseError, UsageError
from equipoise.mechanism.parts.motors import DcMotor, InductionMotor, Motor
from equipoise.running import collocation
from equipoise.running.blocks import drives_headline, run_headline
from equipoise.running.collocation import Instant
from equipoise.running.drivers import Driver
from equipoise.running.equation import CrankEquation
from equipoise.running.flywheel import (
    Flywheel,
    Shooting,
    SteadyCycle,
    _check_mean_torque,
    share_of_mean,
    size_flywheel,
)
from equipoise.running.integration import Integration, Limits
from equipoise.running.run_results import DrivesRun
from equipoise.vibration.coupled import StallError
from support.analyses import subject_of
from support.chosen import few
from support.refusals import refused

WITHOUT_A_MOTOR = ("transplanter", "four-stroke-engine", "rotary-transplanter", "watt:1")


def with_flywheel(machine: eq.Machine, added: float) -> eq.Machine:
    drive = replace(machine.drive, flywheel=machine.drive.flywheel + added)
    return replace(machine, drive=drive)


@pytest.mark.exhaustive(but=["four-stroke-engine", "watt:1"])
@pytest.mark.parametrize("name", WITHOUT_A_MOTOR)
def test_scipy_goes_through_a_cycle_alike(name: str) -> None:
    """The equation of motion in time, under the constant torque of the drive."""
    machine = subject_of(name).machine
    flywheel = size_flywheel(machine, 0.05)
    equation = CrankEquation(with_flywheel(machine, flywheel.inertia))
    steady = SteadyCycle(equation)
    assert steady.speed is not None
    turns, sense = np.linspace(0.0, equation.period, 4001), np.sign(machine.drive.speed)
    grid = np.array([equation.at(q, machine.drive.speed)[2].sum() for q in turns[:-1]])
    torque = -float(np.mean(grid))

    def rates(_: float, state: list[float]) -> list[float]:
        inertia, slope, sources = equation.at(state[0], state[1])
        driven = float(np.sum(sources)) + torque - slope * state[1] ** 2 / 2
        return [state[1], driven / inertia]

    # begin at a node, and go through one cycle
    start = float(equation.table.lows[0] + equation.table.highs[0]) / 2
    table = equation.table
    first = steady.speed[0] @ np.linalg.inv(np.polynomial.chebyshev.chebvander(NODES, LAST)).T
    speed = sense * float(np.polynomial.chebyshev.chebval(0.0, first))
    period = equation.period / abs(machine.drive.speed)
    for _ in range(2):  # loads follow the speed, so that their mean is not that at a constant one
        done = solve_ivp(
            rates, (0.0, period), [start, speed], "DOP853", rtol=1e-9, dense_output=True
        )
        angle, end = done.y[:, -1]
        inertia = equation.at(start, speed)[0]
        torque -= sense * inertia * (end**2 - speed**2) / 2 / equation.period
    assert abs(angle - start) == pytest.approx(table.period, rel=2e-4)  # as its loads may jump
    assert end == pytest.approx(speed, rel=1e-4)
    rate = done.sol(np.linspace(0.0, period, 20001))[1]
    assert np.ptp(rate) / abs(machine.drive.speed) == pytest.approx(0.05, rel=1e-3)


RIGS = ("yamashita-rig", "balance-rig")
NODES = np.polynomial.chebyshev.chebpts1(collocation.NODES)
LAST = collocation.NODES - 1


@pytest.mark.parametrize("name", few(["walking-transplanter", *RIGS], {"balance-rig"}))
def test_with_a_motor_the_run_itself_is_as_even(name: str) -> None:
    machine = subject_of(name).machine
    wanted = 0.4 * size_flywheel(machine, 0.9).present
    flywheel = size_flywheel(machine, wanted)
    cycle = eq.run(with_flywheel(machine, flywheel.inertia), fluctuation=wanted).last_cycle
    assert flywheel.inertia > 0
    assert cycle is not None
    assert cycle.fluctuation == pytest.approx(wanted, rel=2e-3)  # at the nodes of a run


@pytest.mark.parametrize("name", few(["yamashita-rig", "walking-transplanter"], {"yamashita-rig"}))
def test_a_heavy_flywheel_is_sized_in_few_pieces(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The crank would come to its steady speed with it only over many hundreds of turns."""
    pieces, real = [], Integration._piece

    def piece(self: Integration, begin: Instant) -> Instant | None:
        pieces.append(begin)
        return real(self, begin)

    machine = subject_of(name).machine
    monkeypatch.setattr(Integration, "_piece", piece)
    flywheel = size_flywheel(machine, 1e-4)
    turns = len(pieces) / len(CrankEquation(machine).table.lows)
    assert turns < 100
    assert flywheel.inertia > 10 * flywheel.present * 1e-4 * flywheel.work / flywheel.speed**2
    shooting = Shooting(CrankEquation(with_flywheel(machine, flywheel.inertia)), flywheel.speed)
    steady = shooting.steady()
    assert steady is not None
    state, _ = steady
    limits = Limits(turns=shooting.equation.period / np.pi, steady=False)  # two cycles
    run = Integration(shooting.equation, Driver.of(shooting.equation.machine), limits)
    run.follow(0.0, float(state[0]) * flywheel.speed)
    assert run.events[-1].speed == pytest.approx(float(state[0]) * flywheel.speed, rel=1e-9)


def test_a_steady_state_far_from_the_usual_speed_is_met_on_the_way(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Where none is met from the usual speed on, after some cycles another try meets it."""
    machine = with_flywheel(subject_of("yamashita-rig").machine, 1.0)
    tries, turns, real = [], [0], Shooting.steady

    def steady(self: Shooting, near: Any = None) -> Any:
        tries.append(near)
        return None if len(tries) == 1 else real(self, near)

    directly = size_flywheel(machine, 0.5).present
    monkeypatch.setattr(Shooting, "steady", steady)
    flywheel = size_flywheel(machine, 0.5, lambda done, most: turns.append(done))
    assert flywheel.present == pytest.approx(directly, rel=1e-6)
    assert max(turns) == 4
    assert len(tries) == 2


def test_turns_towards_steady_states_have_one_limit_for_all_flywheels(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each takes six turns, and together they take more than 20."""
    machine, seen = subject_of("yamashita-rig").machine, []
    monkeypatch.setattr(Shooting, "steady", lambda *_: None)
    monkeypatch.setattr("equipoise.running.flywheel.MOST_TURNS", 20)

    def progress(done: int, most: int) -> None:
        seen.append((done, most))

    with refused(ResponseError, count="20"):
        size_flywheel(machine, 0.05, progress)
    assert seen == sorted(seen)
    assert seen[-1] == (20, 20)
    monkeypatch.setattr("equipoise.running.flywheel.MOST_TURNS", 400)
    assert size_flywheel(machine, 0.05).inertia > 0


def test_how_far_a_run_is_can_be_seen() -> None:
    seen: list[tuple[int, int]] = []
    eq.run(
        subject_of("yamashita-rig").machine,
        turns=2.5,
        progress=lambda done, most: seen.append((done, most)),
    )
    assert {most for _, most in seen} == {3}
    assert {done for done, _ in seen} == {0, 1, 2}


# Currents in a run: tests/laws/test_motors.py.
@pytest.mark.exhaustive
def test_a_current_that_is_far_quicker_than_the_crank_takes_few_steps(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """And the crank moves as without inductance."""
    calls, real = [], Integration._rates

    def rates(self: Integration, time: float, state: Any) -> list[float]:
        calls.append(time)
        return real(self, time, state)

    monkeypatch.setattr(Integration, "_rates", rates)
    machine = subject_of("yamashita-rig").machine
    ends = []
    for inductance in (1e-9, 0.0):
        circuit = DcMotor(voltage=12.0, resistance=2.0, torque_constant=0.05, inductance=inductance)
        drive = replace(machine.drive, motor=Motor(dc=circuit, ratio=20.0, inertia=4e-5))
        ends.append(eq.run(replace(machine, drive=drive), turns=0.5).crank_speed[-1])
    assert len(calls) < 10_000
    assert ends[0] == pytest.approx(ends[1], rel=1e-6)


def test_the_mean_speed_is_that_of_the_drive() -> None:
    """Over time: the crank needs for a cycle what it needs at constant speed."""
    equation = CrankEquation(subject_of("transplanter").machine)
    steady = SteadyCycle(equation, 0.05)
    assert steady.speed is not None
    table = equation.table
    halves = (table.highs - table.lows) / 2
    inverse = np.linalg.inv(np.polynomial.chebyshev.chebvander(NODES, LAST))
    whole = np.array([0 if k % 2 else 2 / (1 - k * k) for k in range(len(NODES))]) @ inverse
    time = float(np.sum(halves * ((1 / steady.speed) @ whole)))
    assert time == pytest.approx(equation.period / abs(equation.machine.drive.speed), rel=1e-12)


def test_none_is_needed_where_there_is_enough() -> None:
    machine = with_flywheel(subject_of("transplanter").machine, 10.0)
    flywheel = size_flywheel(machine, 0.05)
    assert flywheel.inertia == 0.0
    assert flywheel.estimate == 0.0
    assert 0 < flywheel.present < 0.05


def test_a_crank_that_nearly_stands_still_at_its_heaviest_place() -> None:
    """So slow that whatever lifts the weight over the top is faster in the mean."""
    mean = 0.05
    link = eq.Link({"A": (0.0, 0.0), "B": (1.0, 0.0)}, 10.0, (0.8, 0.0), 0.1)
    drive = eq.Drive("crank", mean)
    machine = eq.Machine("crank", drive, {"A": (0.0, 0.0)}, {"crank": link}, gravity=(0.0, -9.81))
    flywheel = size_flywheel(machine, 0.1)
    assert flywheel.present == inf
    assert flywheel.to_dict()["present"] is None
    inertia, weight = 0.1 + 10 * 0.64 + flywheel.inertia, 10 * 9.81 * 0.8
    # by hand: highest less lowest speed of an energy that is E + weight * cos, to its third order
    assert 2 * weight / (inertia * mean**2) == pytest.approx(0.1, rel=2e-3)
    run = eq.run(machine, "1 s", speed=mean, fluctuation="10 %")
    assert "nearly stands still at its heaviest place" in str([*run_headline(run)])


@pytest.mark.parametrize(
    ("given", "share"), [("2 %", 0.02), ("2%", 0.02), (0.3, 0.3), ("0.3", 0.3)]
)
def test_shares(given: float | str, share: float) -> None:
    assert share_of_mean(given) == pytest.approx(share)


@pytest.mark.parametrize("given", ["two", "0 %", "100 %", -0.1, "nan", "2 rpm", ""])
def test_what_is_no_share_is_refused(given: float | str) -> None:
    with refused(UsageError, given=given):
        eq.run(subject_of("transplanter").machine, fluctuation=given)


def test_in_the_output() -> None:
    run = eq.run(subject_of("yamashita-rig").machine, fluctuation=0.02)
    assert isinstance(run.flywheel, Flywheel)
    assert run.to_dict()["flywheel"] == run.flywheel.to_dict()
    assert "textbook" in str([*run_headline(run)])


def with_load(machine: eq.Machine, torque: float, **motor: float) -> eq.Machine:
    """A crank that a torque resists at every angle, N m, with a motor."""
    load = eq.Load(machine.drive.link, torque=-torque)
    drive = replace(machine.drive, motor=Motor(no_load_speed=80.0, **motor))
    return replace(machine, loads=(load,), drive=drive)


def test_no_flywheel_is_looked_for_where_the_motor_is_too_weak_in_the_mean(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The work of a turn is that of the load, at any speed: 5 N m is more than twice 2 N m."""
    machine = with_load(subject_of("transplanter").machine, 5.0, stall_torque=2.0, ratio=2.0)
    monkeypatch.setattr(Shooting, "_cycle", lambda *_: pytest.fail("a cycle was followed"))
    with pytest.raises(StallError) as error:
        size_flywheel(machine, 0.02)
    needed = SteadyCycle(CrankEquation(machine)).resisting(80.0 / 2 / 48)
    assert needed == pytest.approx(5.0, rel=0.02)
    assert f"needs {needed:.4g} N m" in str(error.value)
    assert "has 3.917 N m" in str(error.value)  # 4 N m, less 1 / 48 of it


def test_the_narrow_top_of_an_induction_motor_is_met() -> None:
    """Its breakdown torque, 2 % above what is needed, lies between two of the speeds tried."""
    crank = with_load(subject_of("transplanter").machine, 5.0, stall_torque=9.0)
    needed = SteadyCycle(CrankEquation(crank)).resisting(80.0)
    for share in (1.02, 0.98):
        motor = Motor(induction=InductionMotor(80.0, share * needed, 0.03))
        steady = SteadyCycle(CrankEquation(replace(crank, drive=replace(crank.drive, motor=motor))))
        if share > 1:
            _check_mean_torque(steady)
        else:
            with pytest.raises(StallError):
                _check_mean_torque(steady)


def test_balancing_ends_where_the_motor_is_too_weak(monkeypatch: pytest.MonkeyPatch) -> None:
    machine = with_load(subject_of("transplanter").machine, 5.0, stall_torque=2.0, ratio=2.0)
    monkeypatch.setattr(Shooting, "_cycle", lambda *_: pytest.fail("a cycle was followed"))
    advice = advise(machine).advice
    assert advice is not None and advice.beyond.flywheels is None


def test_a_flywheel_is_added_to_the_one_that_there_is() -> None:
    """As much in all as without it, and both are said; the speed is that of a run with it."""
    machine = with_load(subject_of("transplanter").machine, 2.0, stall_torque=4.0, ratio=2.0)
    alone, present = size_flywheel(machine, 0.05), 0.3
    assert (alone.existing, alone.total) == (0.0, alone.inertia)
    half = present * alone.inertia
    run = eq.run(with_flywheel(machine, half), fluctuation=0.05)
    flywheel = run.flywheel
    assert flywheel is not None and flywheel.existing == half
    assert flywheel.total == pytest.approx(alone.total, rel=1e-6)
    assert run.to_dict()["flywheel"]["total"] == flywheel.total
    assert " in all." in str([*run_headline(run)])
    running = eq.run(with_flywheel(machine, flywheel.total)).last_cycle
    assert running is not None and flywheel.speed == pytest.approx(running.mean_speed, rel=1e-4)
    assert flywheel.speed != pytest.approx(machine.drive.speed, rel=1e-2)


@pytest.mark.parametrize("has_motor", [False, True])
def test_a_heavy_support_is_a_fixed_frame(has_motor: bool) -> None:
    """By the exact equations on the one, by the crank's own on the other."""
    machine = eq.load("balance-rig")
    motor = machine.drive.motor if has_motor else None
    machine = replace(machine, drive=replace(machine.drive, motor=motor))
    assert machine.support is not None and machine.support.pivot_inertia is not None
    light = size_flywheel(machine, 0.05, support=True)
    still = size_flywheel(machine, 0.05)
    mass, inertia = 1e3 * machine.support.mass, 1e3 * machine.support.pivot_inertia
    support = replace(machine.support, mass=mass, pivot_inertia=inertia)
    supported = replace(machine, support=support)
    sized = size_flywheel(supported, 0.05, support=True)
    # a thousandth of what the light one, which sways, makes of it, and samples of the speed
    assert sized.inertia == pytest.approx(still.inertia, rel=2e-4)
    assert sized.speed == pytest.approx(still.speed, rel=1e-6)
    assert abs(light.inertia - still.inertia) > 0.01 * still.inertia


@pytest.mark.exhaustive  # the sentence runs with the steady state above
def test_a_run_on_its_support_is_as_even_as_its_flywheel_was_sized_for() -> None:
    machine = eq.load("balance-rig")
    sized = eq.run(machine, "0.01 s", support=True, fluctuation="5 %")
    assert isinstance(sized, DrivesRun) and sized.flywheel is not None
    assert "flywheel of" in " ".join(str(block) for block in drives_headline(sized))
    run = eq.run(with_flywheel(machine, sized.flywheel.inertia), support=True,
                 speed=sized.flywheel.speed)  # fmt: skip
    assert isinstance(run, DrivesRun) and run.last_cycle is not None
    speed = run.drives["crank"].speed[run.last_cycle]
    # after 30 turns the support still swings a little
    assert np.ptp(speed) / sized.flywheel.speed == pytest.approx(0.05, rel=0.05)
