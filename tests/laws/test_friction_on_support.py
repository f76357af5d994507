"""Friction in joints of a machine on its support: it loads the drive, and shakes nothing itself."""

from __future__ import annotations

from dataclasses import replace

import pytest

import equipoise as eq
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.motors import InductionMotor, Motor
from equipoise.mechanism.parts.torsion_dampers import TorsionDamper

RIG = eq.load("yamashita-rig")
JOINTS = tuple(
    JointProperties(f"joints.{name}", radius=0.012, friction=0.15, torsional_damping=2e-3)
    for name in ("A", "B", "C", "D")
)
RUBBING = replace(RIG, joints=JOINTS)


@pytest.mark.parametrize("model", ["linear", "torque", "moment", "exact"])
def test_friction_between_links_and_frame_shakes_no_support(model: str) -> None:
    """What joints exert on the frame as a whole follows from what the links move alone."""
    wanted, actual = (eq.respond(machine, model=model) for machine in (RIG, RUBBING))
    for name, signals in wanted.gauges.items():
        read = actual.gauges[name].displacement.figures
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


@pytest.mark.parametrize("coefficient", [0.01, 0.3])
@pytest.mark.parametrize("kind", ["damper", "friction"])
def test_a_free_motor_meets_what_viscous_parts_need_at_its_own_speed(
    kind: str, coefficient: float
) -> None:
    """Its line meets that of the resistance at stall / (stall / no load + c), which needs no
    integration; at the speed of the drive the larger coefficient takes nine times the torque that
    the motor has at standstill.
    """
    stall, no_load = 10.0, 300.0
    bare = replace(eq.load("slider-crank-engine"), loads=(), balance=None)
    if kind == "damper":
        held = replace(bare, torsion_dampers=(TorsionDamper("crank", damping=coefficient),))
    else:
        pin = JointProperties("joints.A", radius=0.01, torsional_damping=coefficient)
        held = replace(bare, joints=(pin,))
    motor = Motor(no_load, stall, mean_speed="free")
    machine = held.with_drive(flywheel=50.0, motor=motor, speed=300.0)
    steady = eq.respond(machine, drive=True)
    expected = stall / (stall / no_load + coefficient)
    # the flywheel leaves a fluctuation whose share of the loss is its square
    assert steady.drive.speed.mean == pytest.approx(expected, rel=1e-7)


def test_a_motor_with_a_narrow_top_is_not_taken_for_stalled() -> None:
    """Its breakdown lies closer to its synchronous speed than any evenly spaced speeds do."""
    bare = replace(eq.load("slider-crank-engine"), loads=(), balance=None)
    induction = InductionMotor(300.0, 10.0, 0.004)
    motor = Motor(induction=induction, mean_speed="free")
    pin = JointProperties("joints.A", radius=0.01, drag_torque=9.0)
    machine = replace(bare, joints=(pin,)).with_drive(flywheel=50.0, motor=motor, speed=300.0)
    steady = eq.respond(machine, drive=True)
    wanted = induction.speed_at(9.0)
    assert wanted is not None
    assert steady.drive.speed.mean == pytest.approx(wanted, rel=1e-6)
