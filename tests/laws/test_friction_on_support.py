"""Friction in joints of a machine on its support: it loads the drive, and shakes nothing itself."""

from __future__ import annotations

from dataclasses import replace

import pytest

import equipoise as eq
from equipoise.mechanism.parts.force_elements import Motor
from equipoise.mechanism.parts.joint_properties import JointProperties

RIG = eq.load("yamashita-rig")
JOINTS = tuple(
    JointProperties(f"joints.{name}", radius=0.012, friction=0.15, torsional_damping=2e-3)
    for name in ("A", "B", "C", "D")
)
RUBBING = replace(RIG, joints=JOINTS)


@pytest.mark.parametrize("model", ["linear", "torque", "moment", "exact"])
def test_friction_between_links_and_frame_shakes_no_support(model: str) -> None:
    """What joints exert on the frame as a whole follows from what the links move alone."""
    wanted, found = (eq.respond(machine, model=model) for machine in (RIG, RUBBING))
    for name, signals in wanted.gauges.items():
        read = found.gauges[name].displacement.figures
        assert read.rms == pytest.approx(signals.displacement.figures.rms, rel=1e-7)
        assert read.peak_to_peak == pytest.approx(
            signals.displacement.figures.peak_to_peak, rel=1e-7
        )


def test_the_drive_on_a_support_gives_what_joints_lose() -> None:
    """At a constant speed of the crank, beside what the support's own dampers take."""
    bare, rubbing = (eq.respond(machine, model="exact") for machine in (RIG, RUBBING))
    losses = eq.analyze(RUBBING).losses
    assert losses is not None and losses.loss > 0
    speed = RUBBING.drive.speed
    more = (rubbing.drive.torque_figures.mean - bare.drive.torque_figures.mean) * speed
    assert more == pytest.approx(losses.loss, rel=1e-3)


def test_joint_forces_on_a_support_have_friction() -> None:
    """Of a support that hardly moves: those of an analysis, whose friction is its own."""
    assert RUBBING.support is not None
    support = replace(RUBBING.support, mass=1e6, inertia=(1e6,), pivot_inertia=None)
    heavy = replace(RUBBING, support=support)
    for joint in eq.respond(heavy, model="exact").joints.values():
        assert joint.peak == pytest.approx(joint.on_ground, rel=3e-4)


def test_a_motor_on_solid_ground_runs_as_in_time() -> None:
    """A flywheel keeps the speed even, at which friction is that of constant speed."""
    motor = Motor(26.0, 6.0, mean_speed="free")
    machine = RUBBING.with_drive(flywheel=1.0, motor=motor, speed=22.0)
    ground = replace(machine, support=None)
    steady = eq.respond(ground, drive=True)
    run = eq.run(ground, speed=abs(steady.drive.speed.mean))
    cycle = run.last_cycle
    assert run.end.kind == "steady" and cycle is not None
    assert steady.drive.speed.mean == pytest.approx(cycle.mean_speed, rel=1e-3)
    without = eq.respond(replace(ground, joints=()), drive=True)
    assert without.drive.speed.mean > 1.01 * steady.drive.speed.mean
