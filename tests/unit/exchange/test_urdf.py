"""URDF read back by Pinocchio: cut open and told how to move, it needs the same drive torque."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import equipoise as eq
from equipoise.mechanism.parts.joint_properties import JointProperties
from support.conformance import compared
from support.sources import PINOCCHIO

START, LATER = 0.3, 1.1
"""Crank angles at which the file is drawn and looked at, rad."""
CUT = ["yamashita-1", "quick-return", "scotch-yoke", "class-three", "slider-crank-engine"]


def opened(machine: eq.Machine, path: Path) -> tuple[pin.Model, tuple[str, ...]]:
    exported = eq.export(machine, path, crank_angle=START)
    return pin.buildModelFromUrdf(str(path)), exported


def coordinate(machine: eq.Machine, model: pin.Model, number: int, motion: object) -> list[float]:
    """A joint's way from where it is drawn to each of three crank angles."""
    link = model.names[number]
    parent = model.names[model.parents[number]]
    turned = motion.links[link].angle  # type: ignore[attr-defined]
    slider = next(
        (item for item in machine.sliders if {link, parent} == {item.link, item.on}), None
    )
    slider = slider or next(
        (s for s in machine.sliders if s.on == "frame" and s.link == link), None
    )
    if slider is not None and model.joints[number].shortname() != "JointModelRUBZ":
        travel = motion.sliders[slider.name].travel  # type: ignore[attr-defined]
        return list((travel - travel[0]) * (1 if slider.link == link else -1))
    if number and model.parents[number]:
        turned = turned - motion.links[parent].angle  # type: ignore[attr-defined]
    return list(turned - turned[0])


@compared(PINOCCHIO, "drive torque of the exported tree, by differences", 1e-6)
@pytest.mark.parametrize("name", CUT)
def test_drive_torque_of_the_tree(name: str, tmp_path: Path) -> None:
    """Virtual work of all joints, speeds and accelerations by differences over 1e-4 rad: 1e-6."""
    machine = eq.load(name)
    machine = eq.Machine(**{**{k: getattr(machine, k) for k in KEPT}, "loads": ()})
    model, text = opened(machine, tmp_path / "x.urdf")
    assert model.nv == len(machine.links)
    assert any("closes a loop" in item for item in text)
    step = 1e-4
    motion = eq.move(machine, [START, LATER - step, LATER, LATER + step], acceleration=0.0)
    ways = np.array([coordinate(machine, model, k, motion) for k in range(1, model.njoints)])
    rate = (ways[:, 3] - ways[:, 1]) / (2 * step) * machine.drive.speed
    change = (ways[:, 3] - 2 * ways[:, 2] + ways[:, 1]) / step**2 * machine.drive.speed**2
    model.gravity.linear = np.array([*machine.gravity, 0.0])
    place = pin.integrate(model, pin.neutral(model), ways[:, 2])
    asked = pin.rnea(model, model.createData(), place, rate, change)
    forces = eq.forces(eq.move(machine, [LATER], acceleration=0.0))
    size = float(np.max(np.abs(eq.forces(eq.move(machine, acceleration=0.0)).drive_torque)))
    torque = asked @ rate / machine.drive.speed
    assert torque == pytest.approx(float(forces.drive_torque[0]), abs=1e-6 * size)


KEPT = ("title", "drive", "frame", "links", "assembly", "sliders", "gears", "gravity", "position")


def test_gears_follow_each_other(tmp_path: Path) -> None:
    machine = eq.load("geared-counterweight")
    (gear,) = machine.gears
    opened(machine, tmp_path / "x.urdf")
    text = (tmp_path / "x.urdf").read_text("utf-8")
    assert f'<mimic joint="{gear.driver}" multiplier="{gear.speed_ratio!r}" />' in text


def test_damping_and_drag_of_joints(tmp_path: Path) -> None:
    """Pinocchio reads them of the joints of the tree; the pin that is cut has none."""
    given = (
        JointProperties("joints.A", radius=0.01, torsional_damping=0.02, drag_torque=0.3),
        JointProperties("joints.B", torsional_damping=0.01, radius=0.015, friction=0.04),
        JointProperties("joints.C", drag_torque=0.2),
        JointProperties("joints.plunger on frame", damping=30.0, drag_force=12.0),
    )
    machine = replace(eq.load("plunger-pump"), loads=(), joints=given)
    model, text = opened(machine, tmp_path / "x.urdf")
    joints = {model.names[k]: model.joints[k].idx_v for k in range(1, model.njoints)}
    for link, damping, drag in (("crank", 0.02, 0.3), ("plunger", 30.0, 12.0), ("rod", 0.01, 0.0)):
        assert (model.damping[joints[link]], model.friction[joints[link]]) == (damping, drag)
    assert "friction in joints by what presses there: damping and drag alone are left" in text


def test_what_is_left_out(tmp_path: Path) -> None:
    exported = eq.export(eq.load("spring-balanced-crank"), tmp_path / "x.urdf")
    assert "springs" in exported
    assert "the drive's speed" in exported
