"""Friction of followers on cams: by hand for a flat tappet, and against power that goes in."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism import JointProperties
from equipoise.mechanism.parts.cams import Cam
from equipoise.mechanism.parts.laws import LengthLaw
from support.machines import make
from support.machines_cams import ALL
from support.refusals import refused
from unit.schema.samples import survives

FRICTION, BASE, LIFT, SPEED, LOAD = 0.08, 0.02, 0.01, 30.0, 200.0
"""Coefficient, m, m, rad/s, N."""


def tappet(friction: float = FRICTION) -> eq.Machine:
    """A camshaft under a flat tappet without mass that a constant force presses on it."""
    lift = LengthLaw(between=(0.0, LIFT))
    cam = Cam("camshaft", "tappet", "flat", "T", "ribs", BASE, lift=lift)
    links = {"camshaft": eq.Link({"A": (0.0, 0.0)}, 0.0, (0.0, 0.0), 0.0),
             "tappet": eq.Link({"T": (0.0, 0.0)}, 0.0, (0.0, 0.0), 0.0)}  # fmt: skip
    slider = eq.mechanism.Slider("tappet", "T", "frame", "A", np.pi / 2)
    joints = (JointProperties("cams.camshaft to tappet", friction=friction),) if friction else ()
    return eq.Machine(
        "tappet", eq.Drive("camshaft", SPEED), {"A": (0.0, 0.0)}, links, sliders=(slider,),
        cams=(cam,), joints=joints, loads=(eq.Load("tappet", point="T", force=(0.0, -LOAD)),),
    )  # fmt: skip


def test_a_flat_tappet_by_hand() -> None:
    """The force that presses is the load, since the guide has no friction.  The contact is at the
    lift's slope beside the axis and at base radius plus lift above it, with which the camshaft
    passes under the face: T = F y' + mu F (r + y), and what is lost is mu F (r + y) w.
    """
    analysis = eq.analyze(tappet(), 36)
    motion = analysis.motion
    y = motion.points["T"].y
    rise, level = motion.points["T"].vy / SPEED, y  # the face is at base radius plus lift
    assert np.min(level) == pytest.approx(BASE) and np.max(level) == pytest.approx(BASE + LIFT)
    np.testing.assert_allclose(
        analysis.forces.drive_torque, LOAD * rise + FRICTION * LOAD * level, rtol=1e-11
    )
    friction = analysis.forces.frictions["camshaft to tappet"]
    np.testing.assert_allclose(friction.pressing, LOAD, rtol=1e-12)
    np.testing.assert_allclose(friction.loss, FRICTION * LOAD * level * SPEED, rtol=1e-11)
    force = analysis.forces.cams["camshaft to tappet"]
    np.testing.assert_allclose(np.abs(force.x), FRICTION * LOAD, rtol=1e-11)
    np.testing.assert_allclose(force.y, LOAD, rtol=1e-11)
    assert analysis.losses is not None
    wear = analysis.losses.joints["camshaft to tappet"].wear_work
    assert wear == pytest.approx(LOAD * 2 * np.pi * np.mean(level), rel=1e-9)


@pytest.mark.parametrize("kind", sorted(ALL)[:6])
def test_power_that_goes_in_is_what_is_lost(kind: str) -> None:
    """Drive power less that without friction is the loss at every crank angle."""
    machine = replace(make(kind, 0).machine, balance=None, joints=())
    free = eq.analyze(machine, 24)
    joints = tuple(JointProperties(f"cams.{cam.name}", friction=FRICTION) for cam in machine.cams)
    analysis = eq.analyze(replace(machine, joints=joints), 24)
    size = np.max(np.abs(free.forces.power))
    loss = sum(friction.loss for friction in analysis.forces.frictions.values())
    np.testing.assert_allclose(analysis.forces.power - free.forces.power, loss, atol=1e-9 * size)
    assert np.min(loss) >= 0 and np.max(loss) > 1e-6 * size


def test_a_run_loses_the_same() -> None:
    """At any instant the acceleration is that at which inverse dynamics needs no torque."""
    camshaft = eq.Link({"A": (0.0, 0.0)}, 1.0, (0.0, 0.0), 0.01)
    machine = tappet()
    heavy = replace(
        machine,
        links={**machine.links, "camshaft": camshaft,
               "tappet": eq.Link({"T": (0.0, 0.0)}, 0.3, (0.0, 0.0), 0.0)},
    )  # fmt: skip
    run = eq.run(heavy, speed=4 * SPEED, turns=2)
    assert run.energy_error < 1e-9 and run.work["friction"][-1] < -1.0
    for k in np.linspace(1, len(run.time) - 2, 9).astype(int):
        angle, speed = float(run.crank_angle[k]), float(run.crank_speed[k])
        inertia, slope, torques = run.equation.at(angle, speed)
        rate = (float(np.sum(torques)) - slope * speed**2 / 2) / inertia
        asked = float(eq.analyze(heavy, [angle], speed, rate).forces.drive_torque[0])
        assert abs(asked) < 1e-8 * np.max(np.abs(torques))


def test_it_is_an_output_and_in_files() -> None:
    machine = tappet()
    survives(machine)
    analysis = eq.analyze(machine, 90)
    assert analysis.losses is not None
    assert analysis.summary["cams.camshaft to tappet.friction_loss"].mean == pytest.approx(
        analysis.losses.loss
    )


def test_a_cam_has_neither_radius_nor_damping() -> None:
    joint = JointProperties("cams.camshaft to tappet", friction=0.1, damping=1.0)
    with refused(ModelError, "joints[1].damping", joint="cams.camshaft to tappet"):
        eq.analyze(replace(tappet(), joints=(joint,)))
