"""Runs of several drives: motions with a known answer, events, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError, ResponseError, UsageError
from equipoise.figures.style import look_of
from equipoise.figures.time_charts import drives_charts
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.laws import AngleLaw
from equipoise.mechanism.parts.machine import FurtherDrive
from equipoise.mechanism.parts.motors import DcMotor, Motor, ServoMotor
from equipoise.mechanism.parts.run_plans import TimedLoad
from equipoise.mechanism.parts.torsion_dampers import TorsionDamper
from equipoise.results.blocks import Facts
from equipoise.running import drives_integration
from equipoise.running.blocks import drives_blocks, drives_headline, drives_verdict
from support.machines import make
from support.machines_redundant import planet_train
from support.refusals import refused

MASS, ARM, OWN = 2.0, 0.3, 0.05
INERTIA = OWN + MASS * ARM**2
STRAIGHT = Motor(30.0, 6.0, mean_speed="free")


def cranks(drive: eq.Drive, other: FurtherDrive, gravity: float = 0.0) -> eq.Machine:
    """Two links that turn about points of the frame and do not feel each other."""
    links = {
        "left": eq.Link({"A": (0.0, 0.0), "C": (0.5, 0.0)}, MASS, (ARM, 0.0), OWN),
        "right": eq.Link({"B": (0.0, 0.0), "D": (0.5, 0.0)}, MASS, (ARM, 0.0), OWN),
    }
    return eq.Machine(
        "cranks", drive, {"A": (0.0, 0.0), "B": (2.0, 0.0)}, links, drives=(other,),
        gravity=(0.0, -gravity),
    )  # fmt: skip


def test_motors_of_straight_lines_start_exponentially() -> None:
    machine = cranks(eq.Drive("left", 30.0, motor=STRAIGHT),
                     FurtherDrive("right", ratio=-0.5, motor=Motor(10.0, 6.0)))  # fmt: skip
    run = eq.run(machine, 0.8)
    left, right = run.drives.values()
    rates = {6.0 / 30.0: (left, 30.0), 6.0 / 10.0: (right, -10.0)}
    for slope, (course, final) in rates.items():
        wanted = final * (1 - np.exp(-slope / INERTIA * run.time))
        np.testing.assert_allclose(course.speed, wanted, atol=1e-9 * abs(final))
        np.testing.assert_allclose(course.effort, slope * (final - course.speed), atol=1e-8)
    assert run.end.kind == "time"


def test_each_drive_has_a_look_of_its_own_in_pictures() -> None:
    """The same over speed and torque."""
    machine = cranks(eq.Drive("left", 30.0, motor=STRAIGHT), FurtherDrive("right", motor=STRAIGHT))
    speeds, torques = drives_charts(eq.run(machine, 0.05))["speed"].panels
    looks = {curve.label: look_of(curve.role) for curve in speeds.curves}
    assert len({*looks.values()}) == len(looks) == 2
    assert {curve.label: look_of(curve.role) for curve in torques.curves} == looks


def test_a_crank_that_only_swings_does_not_keep_a_run_of_turns_going() -> None:
    """Its motor holds it from above a quarter of a turn: it swings about where both balance."""
    weak = Motor(1e6, 0.1, mean_speed="free")
    machine = cranks(
        eq.Drive("left", 30.0, motor=weak), FurtherDrive("right", motor=STRAIGHT), 9.81
    )
    run = eq.run(machine, turns=1)
    assert run.end.kind == "swings" and run.end.of == "left"
    back = [event for event in run.events if (event.kind, event.of) == ("reversal", "left")]
    assert len(back) == 20 and run.energy_error < 1e-9
    assert run.end.time == pytest.approx(back[-1].time, abs=0.1)
    (headline, *_) = drives_headline(run)
    assert "20 times" in headline.text


def test_a_crank_that_swings_until_a_load_turns_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """As often as ends a run else; the load, which begins then, makes the turn asked for."""
    monkeypatch.setattr(drives_integration, "MOST_RETURNS", 3)
    load = TimedLoad("left", times=(0.0, 2.5, 2.6, 9.0), factors=(0.0, 0.0, 1.0, 1.0), torque=90.0)
    machine = cranks(eq.Drive("left", 3.0, free=True), FurtherDrive("right", free=True), 9.81)
    run = eq.run(replace(machine, timed_loads=(load,)), turns=1, speed=0.0)
    back = [event for event in run.events if (event.kind, event.of) == ("reversal", "left")]
    assert run.end.kind == "turns" and len(back) >= 3


def test_a_steady_state_of_two_motors() -> None:
    strong = Motor(30.0, 60.0, mean_speed="free")
    machine = cranks(eq.Drive("left", 30.0, motor=strong), FurtherDrive("right", motor=strong))
    run = eq.run(machine)
    assert run.end.kind == "steady"
    assert run.drives["right"].speed[-1] == pytest.approx(30.0, rel=1e-5)
    assert run.energy_error < 1e-9


def test_a_crank_that_follows_the_first_takes_nothing_from_it() -> None:
    alone = eq.run(cranks(eq.Drive("left", 30.0, motor=STRAIGHT),
                          FurtherDrive("right", free=True, ratio=0.0)), 0.5)  # fmt: skip
    beside = eq.run(cranks(eq.Drive("left", 30.0, motor=STRAIGHT), FurtherDrive("right", 2.0)), 0.5)
    assert beside.drives["left"].angle[-1] == pytest.approx(
        alone.drives["left"].angle[-1], rel=1e-9
    )
    right = beside.drives["right"]
    wanted = INERTIA * 2 * (6.0 - 6.0 / 30.0 * beside.drives["left"].speed) / INERTIA
    np.testing.assert_allclose(right.effort, wanted, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("speed", [20.0, -20.0])
def test_cycles_of_a_crank_of_constant_speed(speed: float) -> None:
    machine = cranks(eq.Drive("left", speed), FurtherDrive("right", free=True))
    run = eq.run(machine, turns=2.5)
    assert run.end.kind == "turns" and abs(run.turned) == pytest.approx(2.5)
    period = 2 * pi / 20.0
    np.testing.assert_allclose(run.cycle_begins, [0.0, period, 2 * period], atol=1e-9)
    assert run.drives["right"].speed[-1] == pytest.approx(speed)


@pytest.mark.parametrize(
    "given", [{"turns": 2.0}, {"duration": 0.5}, {"duration": 0.5, "turns": 2}]
)
def test_a_run_ends_where_a_cycle_of_constant_speed_begins(given: dict[str, float]) -> None:
    """Both happen at once."""
    machine = cranks(eq.Drive("left", 8 * pi), FurtherDrive("right", free=True))
    run = eq.run(machine, **given)
    assert run.time[-1] == pytest.approx(0.5, rel=1e-12)
    np.testing.assert_allclose(run.cycle_begins, [0.0, 0.25, 0.5], atol=1e-12)


def test_a_crank_that_stands_still_beside_a_free_one() -> None:
    machine = cranks(eq.Drive("left", 0.0), FurtherDrive("right", motor=Motor(torque=2.0)))
    run = eq.run(machine, 0.5)
    assert run.drives["right"].speed[-1] == pytest.approx(2.0 * 0.5 / INERTIA, rel=1e-8)


def test_a_pendulum_keeps_its_energy_and_turns_back() -> None:
    machine = cranks(eq.Drive("left", 10.0), FurtherDrive("right", ratio=0.0, free=True), 9.81)
    run = eq.run(machine, 1.5)
    right = run.drives["right"]
    energy = INERTIA * right.speed**2 / 2 + MASS * 9.81 * ARM * np.sin(right.angle)
    np.testing.assert_allclose(energy, 0.0, atol=1e-8)
    back = [event for event in run.events if event.kind == "reversal"]
    assert {event.of for event in back} == {"right"}
    assert right.angle[np.searchsorted(run.time, back[0].time)] == pytest.approx(-pi, abs=1e-2)


def test_a_load_over_time_gives_its_impulse() -> None:
    machine = replace(
        cranks(eq.Drive("left", 10.0, free=True), FurtherDrive("right", ratio=0.0, free=True)),
        timed_loads=(TimedLoad("left", (0.0, 0.2), (1.0, 0.0), torque=3.0),),
    )
    run = eq.run(machine, 0.5)
    left = run.drives["left"]
    gained = INERTIA * (left.speed[-1] - 10.0)
    assert gained == pytest.approx(3.0 * 0.2 / 2, rel=1e-8)
    assert run.work["timed_loads"][-1] == pytest.approx(
        INERTIA * (left.speed[-1] ** 2 - 10.0**2) / 2, rel=1e-8
    )


def test_motors_are_switched_off_and_a_brake_stops_the_first() -> None:
    motor = Motor(dc=DcMotor(24.0, 1.0, 0.1, 5e-3), ratio=5.0, mean_speed="free")
    machine = cranks(eq.Drive("left", 30.0, motor=motor, brake=4.0),
                     FurtherDrive("right", motor=motor))  # fmt: skip
    run = eq.run(machine, 2.0, off=0.5)
    kinds = [event.kind for event in run.events]
    assert kinds == ["off", "time"]
    left, right = run.drives.values()
    assert abs(left.speed[-1]) < 1e-2 and right.speed[-1] > 1.0
    after = run.time > 0.5
    assert not np.any(right.effort[after]) and not np.any(right.electric.current[after])
    assert run.work["brake"][-1] < 0
    assert run.energy_error < 1e-9


def test_motors_that_cannot_lift_a_weight_stall() -> None:
    motor = Motor(servo=ServoMotor(speed=5.0, torque_limit=3.0, speed_gain=50.0), mean_speed="free")
    machine = cranks(eq.Drive("left", 5.0, motor=motor), FurtherDrive("right", motor=motor), 9.81)
    machine = replace(machine, torsion_dampers=tuple(
        TorsionDamper(link, damping=8.0) for link in ("left", "right")))  # fmt: skip
    run = eq.run(machine, "60 s")
    assert run.end.kind == "stall"
    level = np.arccos(3.0 / (MASS * 9.81 * ARM))
    for course in run.drives.values():
        assert course.angle[-1] == pytest.approx(-level, abs=1e-4)
    assert "stall" in drives_verdict(run)


def five_bar(**drive: Any) -> eq.Machine:
    """One whose arms are too short for all angles of its cranks."""
    crank = {"mass": 0.4, "inertia": 2e-4, "center_of_mass": (0.02, 0.0)}
    arm = {"mass": 0.25, "inertia": 1e-3, "center_of_mass": (0.04, 0.0)}
    links = {
        "left": eq.Link({"A": (0.0, 0.0), "B": (0.05, 0.0)}, **crank),
        "left arm": eq.Link({"B": (0.0, 0.0), "C": (0.08, 0.0)}, **arm),
        "right arm": eq.Link({"C": (0.0, 0.0), "D": (0.08, 0.0)}, **arm),
        "right": eq.Link({"D": (0.05, 0.0), "E": (0.0, 0.0)}, **crank),
    }
    return eq.Machine(
        "five-bar", eq.Drive("left", 10.0, **drive), {"A": (0.0, 0.0), "E": (0.12, 0.0)}, links,
        assembly={"C": "left"}, drives=(FurtherDrive("right", free=True),),
    )  # fmt: skip


def test_a_run_ends_in_a_dead_position() -> None:
    run = eq.run(apart(), 5.0)
    assert (run.end.kind, run.end.of) == ("dead", "C")
    state = run.drives["left"].angle[-1], run.drives["right"].angle[-1]
    ends = [0.05 * np.exp(1j * state[0]), 0.12 + 0.05 * np.exp(1j * state[1])]
    assert abs(ends[1] - ends[0]) == pytest.approx(0.16, rel=1e-5)
    assert run.energy_error < 1e-9
    assert any("dead position" in str(block) for block in drives_blocks(run))
    assert [*drives_headline(run, alone=True)]


def apart(**changes: Any) -> eq.Machine:
    """The five-bar whose cranks turn against each other."""
    machine = five_bar(free=True)
    return replace(machine, drives=(FurtherDrive("right", ratio=-1.0, free=True),), **changes)


def test_what_has_run_and_is_changed_runs_as_changed() -> None:
    """Nothing of the masses before is kept, neither for a flywheel nor for a link."""
    plain = apart()
    eq.run(plain, 0.05)
    changes: list[Callable[[eq.Machine], eq.Machine]] = [
        lambda machine: machine.with_drive(flywheel=0.01),
        lambda machine: machine.with_link("left", mass=3.0),
    ]
    before = eq.run(apart(), 0.05).drives["left"].angle[-1]
    for change in changes:
        after, fresh = (eq.run(change(each), 0.05) for each in (plain, apart()))
        assert after.drives["left"].angle[-1] == fresh.drives["left"].angle[-1] != before


def test_a_flywheel_is_as_inertia_of_its_link() -> None:
    plain = apart()
    heavier = plain.with_link("left", inertia=plain.links["left"].inertia + 0.01)
    ends = [eq.run(each, 0.2).drives["left"].angle[-1]
            for each in (plain.with_drive(flywheel=0.01), heavier)]  # fmt: skip
    assert ends[0] == pytest.approx(ends[1], rel=1e-9)


def test_strokes_alone_are_refused_without_advice_that_cannot_be_followed() -> None:
    """Neither a motor nor `free` goes with a stroke."""
    with refused(UsageError, place="drive") as caught:
        eq.run(eq.load("hydraulic-loader"), 1.0)
    assert "motor" not in str(caught.value)


def test_turns_of_a_crank_that_stands_are_refused() -> None:
    machine = cranks(eq.Drive("left", 0.0), FurtherDrive("right", motor=Motor(torque=2.0)))
    for given in ({"turns": 2.0}, {"duration": 1.0, "off_turns": 1.0}):
        with refused(UsageError, by="_limits_of_drives"):
            eq.run(machine, **given)


def test_progress_counts_to_where_a_run_ends() -> None:
    counted: list[tuple[int, int]] = []
    machine = cranks(eq.Drive("left", 10.0, free=True), FurtherDrive("right", free=True))
    run = eq.run(machine, progress=lambda done, most: counted.append((done, most)))
    assert {most for _, most in counted} == {30}
    assert run.end.kind in ("turns", "time", "steady")


def test_links_that_reach_no_start_are_refused() -> None:
    with refused(ResponseError, by="_first_values") as caught:
        eq.run(replace(five_bar(free=True), drives=(FurtherDrive("right", start=pi, free=True),)),
               1.0, angle=pi)  # fmt: skip
    assert caught.value.topic == "links-cannot-be-joined-at-any-crank-angle"
    rubbing = eq.load("two-motor-mixer")  # whose friction is not what keeps it from its start
    with refused(ResponseError, by="_first_values"):
        eq.run(replace(rubbing, frame={**rubbing.frame, "E": (0.43, 0.0)}))


def test_drives_of_given_motions_alone_are_refused() -> None:
    machine = cranks(eq.Drive("left", 10.0), FurtherDrive("right"))
    with refused(UsageError, place="drive"):
        eq.run(machine)
    with refused(UsageError, by="CrankEquation.__post_init__"):
        eq.run(replace(machine, drive=eq.Drive("left", 10.0, free=True)), fluctuation=0.01)


def test_a_motor_beside_a_motion_or_a_free_drive_is_refused() -> None:
    with refused(ModelError, "drive.free"):
        cranks(eq.Drive("left", 10.0, free=True, motor=STRAIGHT), FurtherDrive("right"))
    law = AngleLaw(between=(0.0, 1.0))
    with refused(ModelError, "drives[1].motor"):
        cranks(eq.Drive("left", 10.0), FurtherDrive("right", motion=law, motor=STRAIGHT))


def test_a_motor_of_a_further_drive_without_a_curve_is_refused() -> None:
    """As that of the first one is, with its place."""
    half = replace(STRAIGHT, no_load_speed=None)
    with pytest.raises(ModelError) as first:
        cranks(eq.Drive("left", 10.0, motor=half), FurtherDrive("right"))
    with pytest.raises(ModelError) as further:
        cranks(eq.Drive("left", 10.0), FurtherDrive("right", motor=half))
    assert str(first.value).startswith("drive.motor: ")
    assert str(further.value) == "drives[1].motor" + str(first.value).removeprefix("drive.motor")


def test_dry_friction_brings_two_cranks_to_rest() -> None:
    machine = replace(
        cranks(eq.Drive("left", 30.0, free=True), FurtherDrive("right", free=True)),
        joints=(
            JointProperties("joints.A", drag_torque=4.0),
            JointProperties("joints.B", drag_torque=2.0),
        ),
    )
    run = eq.run(machine, "60 s")
    assert run.end.kind == "standstill"
    assert run.end.time == pytest.approx(INERTIA * 30.0 / 2.0, rel=1e-2)
    for joint in ("A", "B"):
        assert run.losses[joint][-1] == pytest.approx(INERTIA * 30.0**2 / 2, rel=1e-5)
    left = run.drives["left"]
    turning = run.time < 0.99 * INERTIA * 30.0 / 4.0
    wanted = 30.0 - 4.0 / INERTIA * run.time[turning]
    np.testing.assert_allclose(left.speed[turning], wanted, atol=1e-8)
    assert run.energy_error < 1e-9


def beside(machine: eq.Machine) -> eq.Machine:
    """A machine with one crank, and a crank of its own beside it that it does not feel."""
    lone = eq.Link({"lone pivot": (0.0, 0.0)}, MASS, (ARM, 0.0), OWN)
    return replace(
        machine,
        frame={**machine.frame, "lone pivot": (9.0, 9.0)},
        links={**machine.links, "lone": lone},
        drives=(FurtherDrive("lone", free=True),),
        balance=None,
        run=None,
    )


WORN = replace(
    eq.load("slider-crank-engine"),
    joints=(
        JointProperties("joints.A", radius=0.02, friction=0.05, torsional_damping=1e-4),
        JointProperties("joints.B", radius=0.02, friction=0.05),
        JointProperties("joints.C", radius=0.01, friction=0.1),
        JointProperties("joints.piston on frame", friction=0.1, guide_length=0.06, damping=2.0),
    ),
)
ALONE = {
    "worn": (WORN, 1e-6),
    "loops": (eq.load("class-three"), 1e-8),
    "couplings behind dyads": (make("geared_coupler", 1).machine, 1e-8),
    "planet behind a dyad": (make("sun_and_planet", 2).machine, 1e-8),
    "cam": (eq.load("cam-pusher"), 1e-6),
}


@pytest.mark.parametrize("name", ALONE)
def test_a_crank_beside_another_runs_as_it_does_alone(name: str) -> None:
    """By time and at all drives' angles, and by one crank's angle and tables over it."""
    machine, close = ALONE[name]
    drive = replace(machine.drive, acceleration=0.0, speeds=(), motor=None)
    machine = replace(machine, drive=drive, support=None, rows=(), balance=None, run=None)
    speed = abs(drive.speed)
    run = eq.run(machine, 2.0 / speed, speed=speed)
    both = beside(replace(machine, drive=replace(drive, free=True)))
    result = eq.run(both, 2.0 / speed, speed=speed)
    course = result.drives[machine.drive.link]
    assert result.energy_error < 1e-9
    assert course.angle[-1] == pytest.approx(run.crank_angle[-1], rel=close)
    assert course.speed[-1] == pytest.approx(run.crank_speed[-1], rel=10 * close)
    assert {*result.losses} == {*run.losses}
    for joint, lost in result.losses.items():
        assert lost[-1] == pytest.approx(run.losses[joint][-1], rel=1e-4)


def test_friction_in_meshes_that_share_their_force_is_refused() -> None:
    """As with one crank."""
    machine = planet_train(np.random.default_rng(1)).machine
    joint = JointProperties(f"gears.{machine.gears[0].name}", mesh_loss=0.02)
    drive = replace(machine.drive, acceleration=0.0, speeds=(), motor=None, free=True)
    lossy = replace(machine, drive=drive, joints=(joint,), support=None, rows=())
    with refused(UsageError, by="check_shared_friction"):
        eq.run(beside(lossy), 0.5)


def test_a_run_without_a_whole_cycle_has_no_last_one() -> None:
    """What friction had taken until then stood below that heading."""
    machine = cranks(eq.Drive("left", 30.0, free=True), FurtherDrive("right", free=True))
    machine = replace(machine, joints=(JointProperties("joints.A", drag_torque=0.1),))
    for turns, cycles in ((0.2, 0), (1.2, 1)):
        run = eq.run(machine, turns=turns, speed=30.0)
        assert run.losses["A"][-1] > 0
        heads = [block for block in drives_headline(run, alone=True) if isinstance(block, Facts)]
        assert len(heads) == cycles
