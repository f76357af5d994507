"""Driven links that follow motion laws, and machines with several drives."""

from __future__ import annotations

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.sensitivity import sensitivities
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
from equipoise.codegen.gram import MassBatch
from equipoise.errors import MobilityError, ModelError, MotionError, UsageError
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.laws import AngleLaw, AngleSegment
from equipoise.mechanism.parts.machine import Drive, FurtherDrive, Link, Machine
from equipoise.mechanism.parts.motors import Motor
from equipoise.results.remarks import linkage_remarks
from equipoise.web.design import Design
from equipoise.web.edits import solved
from equipoise.web.state import status_of
from laws.subjects import gravity_power, kinetic_power
from support.machines import make
from support.refusals import refused
from unit.mechanism.build import crank_rocker

SWING = AngleLaw(between=(radians(-30), radians(40)))


def five_bar(**changes):
    """A five-bar with two drives, without loads and springs."""
    return replace(make("five_bar", 1).machine, loads=(), springs=(), **changes)


def test_a_swinging_pendulum_asks_for_the_torque_of_its_equation():
    """The torque is that on the driven link, at reversal too, where it does no work."""
    link = Link({"A": (0.0, 0.0)}, 2.0, (0.3, 0.0), 0.05)
    pendulum = Machine(
        title="",
        drive=Drive("arm", 5.0, motion=SWING),
        frame={"A": (0.0, 0.0)},
        links={"arm": link},
    )
    analysis = eq.analyze(pendulum)
    theta, half, middle = analysis.crank_angle, radians(35), radians(5)
    angle, alpha = middle - half * np.cos(theta), half * np.cos(theta) * 25
    wanted = (0.05 + 2 * 0.09) * alpha + 2 * 9.80665 * 0.3 * np.cos(angle)
    np.testing.assert_allclose(analysis.forces.drive_torque, wanted, rtol=1e-12)
    assert analysis.forces.work["arm"] == pytest.approx(0, abs=1e-13)
    assert analysis.outputs["drives.arm.power"].values == pytest.approx(analysis.forces.power)


def test_power_of_both_drives_is_what_the_machine_takes():
    forces = eq.analyze(five_bar()).forces
    taken = kinetic_power(forces).sum(axis=0) - gravity_power(forces).sum(axis=0)
    np.testing.assert_allclose(forces.power, taken, atol=1e-12 * np.max(np.abs(taken)))
    assert len(forces.drives) == 2


def test_work_of_the_drives_is_reported_and_cancels_without_losses():
    analysis = eq.analyze(five_bar(), acceleration=0.0)
    work = [value["work"] for value in analysis.to_dict()["drives"].values()]
    period = 2 * pi * analysis.motion.turns / abs(analysis.motion.speed)
    for link, item in zip(analysis.forces.drives, work, strict=True):
        mean = np.mean(analysis.outputs[f"drives.{link}.power"].values)
        assert item == pytest.approx(mean * period, abs=1e-9)
    assert sum(work) == pytest.approx(0, abs=1e-9 * max(map(abs, work)))


def test_parts_of_each_torque_add_up():
    forces = eq.analyze(five_bar()).forces
    regressor = eq.mechanism.regressor(forces.motion)
    for link, torque in forces.drives.items():
        parts = forces.split.by_cause(f"drives.{link}.torque")
        np.testing.assert_allclose(sum(parts.values()), torque, atol=1e-9)
        np.testing.assert_allclose(regressor.values @ regressor.drives[link], torque, atol=1e-9)


def test_the_cycle_is_that_of_all_drives_and_laws():
    machine = five_bar(drives=(FurtherDrive("follower", ratio=2 / 3),))
    law = AngleLaw(between=(0.0, 2.0), turns=2)
    machine = machine.with_drive(motion=law)
    assert eq.move(machine, 4).turns == 6


def test_cycles_that_take_too_many_turns_are_reported():
    machine = five_bar(drives=(FurtherDrive("follower", motion=replace(SWING, turns=97)),))
    machine = machine.with_drive(motion=replace(SWING, turns=89))
    with refused(MotionError, turns="8633"):
        eq.move(machine, 4)


def test_a_jump_of_acceleration_is_noted_and_is_no_place_without_effect():
    """A trapezoid of speed, whose acceleration jumps at four crank angles; a cycloid has none."""
    ways = (AngleSegment(pi, 0.8, "trapezoid"), AngleSegment(pi, 0.0, "trapezoid"))
    pendulum = crank_rocker().with_drive(motion=AngleLaw(segments=ways))
    (text,) = [
        str(remark)
        for remark in linkage_remarks(assemble(pendulum))
        if "infinite jerk" in str(remark)
    ]
    assert "'crank' commands jumps at crank angle 60, 120, 240, 300 deg, an" in text
    result = sensitivities(pendulum, "drive_torque")
    theta = result["rocker.inertia"].no_effect_at
    away = np.abs(theta[:, None] - np.arange(7) * pi / 3)
    assert len(theta) and np.min(away) > 1e-6
    smooth = AngleLaw(segments=tuple(replace(way, law="cycloidal") for way in ways))
    text = map(str, linkage_remarks(assemble(pendulum.with_drive(motion=smooth))))
    assert not any("jerk" in item for item in text)


@pytest.mark.parametrize(
    ("drives", "expected"),
    [
        (
            (FurtherDrive("follower", ratio=pi),),
            {"place": "drives[1].ratio", "most": 100, "fraction": "311/99"},
        ),
        (
            (FurtherDrive("follower", ratio=-0.1428571),),
            {"place": "drives[1].ratio", "fraction": "-1/7", "ratio": -0.142857},
        ),
        ((FurtherDrive("crank"),), {"place": "drives[1].link", "link": "crank"}),
        ((FurtherDrive("nobody"),), {"place": "drives[1].link", "given": "nobody"}),
        ((FurtherDrive("follower", 2.0, motion=SWING),), {"place": "drives[1]"}),
        ((FurtherDrive("follower", motion=AngleLaw()),), {"place": "drives[1].motion"}),
    ],
)
def test_a_wrong_drive_is_reported(drives, expected):
    with refused(ModelError, **expected):
        five_bar(drives=drives)


def test_drives_that_are_too_many_or_hang_nowhere_are_reported():
    machine = eq.load("yamashita-1")
    with refused(
        MobilityError,
        count="0",
        drives="2",
        last="4 pins",
        link="coupler",
        mobility="1",
        second="C",
    ):
        eq.analyze(replace(machine, drives=(FurtherDrive("rocker"),)))
    with refused(ModelError, "drives[1].link", drive="left arm", pivots="0"):
        eq.mechanism.assemble(five_bar(drives=(FurtherDrive("left arm"),)))


def test_what_turns_with_a_crank_goes_with_no_motion():
    for name, given in (("flywheel", 0.2), ("motor", Motor(300.0, 2.0))):
        with refused(ModelError, f"drive.{name}"):
            eq.load("yamashita-1").with_drive(motion=SWING, **{name: given})


def test_models_in_which_the_crank_turns_the_support_are_refused():
    machine = eq.load("yamashita-rig")
    machine = machine.with_drive(motion=SWING, motor=None, flywheel=0.0)
    for model in ("torque", "coupled", "exact"):
        with refused(UsageError, value=model):
            eq.respond(machine, model=model)
    assert eq.respond(machine, model="moment").gauges


def test_a_file_keeps_drives_and_laws():
    segments = (AngleSegment(pi, 1.0, "3-4-5"), AngleSegment(pi, 0.0))
    drives = (FurtherDrive("follower", motion=AngleLaw(segments=segments)),)
    machine = five_bar(drives=drives).with_drive(motion=SWING)
    assert eq.loads(eq.dumps(machine)) == machine


def test_a_page_can_take_such_a_machine_apart_and_put_it_together_again():
    """Its crank angle is the phase, which the pose of no link tells."""
    machine = eq.load("pick-and-place")
    solution = solved(Design("pick-and-place", machine, {}))
    again = solution.sketch(100).finished()
    assert again.own.drives == machine.drives
    assert again.own.assembly == machine.assembly
    status = status_of(solution)
    assert (status["mobility"], status["drive"]) == (2, None)


# -- flywheel --------------------------------------------------------------------------------------

WHEEL = 0.02
"""kg m2."""


@pytest.mark.parametrize("name", ["yamashita-1", "transplanter", "lee-kim-b"])
def test_a_flywheel_counts_as_inertia_of_the_crank(name: str) -> None:
    """Where the crank is accelerated: in every output, and in the shares by cause."""
    machine = eq.load(name).with_drive(acceleration=-35.0)
    crank = machine.links[machine.drive.link]
    assert crank.inertia is not None
    beside = machine.with_drive(flywheel=WHEEL)
    within = machine.with_link(machine.drive.link, inertia=crank.inertia + WHEEL)
    actual, wanted, without = (eq.analyze(item, 90) for item in (beside, within, machine))
    for output, figures in wanted.summary.items():
        assert actual.summary[output].rms == pytest.approx(figures.rms, rel=1e-12), output
    torque = actual.forces.drive_torque - without.forces.drive_torque
    assert torque == pytest.approx(-35.0 * WHEEL)
    assert sum(actual.forces.split.drive_torque.reshape(-1, 90)) == pytest.approx(
        actual.forces.drive_torque, rel=1e-10, abs=1e-10
    )
    still = eq.analyze(beside, 90, acceleration=0.0).forces.drive_torque
    assert still == pytest.approx(eq.analyze(machine, 90, acceleration=0.0).forces.drive_torque)


def test_rows_share_one_flywheel() -> None:
    machine = eq.load("four-row-transplanter").with_drive(acceleration=20.0)
    actual, without = (
        eq.analyze(item, 90).rows_total for item in (machine.with_drive(flywheel=WHEEL), machine)
    )
    assert actual["drive_torque"] - without["drive_torque"] == pytest.approx(20.0 * WHEEL)
    assert actual["shaking_moment"] - without["shaking_moment"] == pytest.approx(-20.0 * WHEEL)


@pytest.mark.parametrize("kind", [Batch, MassBatch])
def test_loops_have_the_flywheel(kind) -> None:
    machine = eq.load("yamashita-1").with_drive(acceleration=-35.0, flywheel=WHEEL)
    names = ("drive_torque", "shaking_moment", "frame_moment")
    wanted = [Figure(name, "mean") for name in names]
    batch = kind(machine, ["links.coupler.mass"], wanted, 90)
    masses = [0.1, 2.0]
    figures, _ = batch(np.array(masses)[:, None])
    for row, mass in zip(figures, masses, strict=True):
        forces = eq.analyze(machine.with_link("coupler", mass=mass), 90).forces
        assert row == pytest.approx([np.mean(getattr(forces, name)) for name in names])
