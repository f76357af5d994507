"""MJCF and URDF against the programs that they are of: masses, joints, and the torque of the drive.

The machine that is read moves; its motion is given to MuJoCo or Pinocchio as the coordinates of the
open tree, whose inverse dynamics then does the work that the drive does here.  Forces of loops do
none.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from math import cos, dist, radians, sin
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from equipoise.errors import EquipoiseError
from equipoise.exchange.export import export
from equipoise.exchange.reading.formats import import_machine
from equipoise.exchange.reading.imported import Imported
from equipoise.exchange.reading.planar import planar
from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.links import size_of
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.schema.models import load_linkage, loads_linkage
from support.refusals import refused
from support.sentences import notes_by

FOUR_BAR = """
<mujoco model="standing four-bar">
  <compiler eulerseq="XYZ"/>
  <option gravity="0.3 0 -9.7"/>
  <default>
    <joint axis="0 -1 0"/>
    <geom density="2700"/>
    <default class="thin"><geom type="capsule" size="0.004"/></default>
  </default>
  <worldbody>
    <light pos="0 0 1"/>
    <site name="ground C" pos="0.09 0 0.01"/>
    <body name="crank" pos="0 0 0.02" euler="0 -30 0">
      <joint name="turn"/>
      <geom class="thin" fromto="0 0 0 0.03 0 0"/>
      <geom type="cylinder" size="0.012 0.003" axisangle="1 0 0 90" mass="0.05"/>
      <body name="coupler" pos="0.03 0 0" quat="0.9 0.1 0.2 -0.1">
        <joint name="knee" axis="{axis}"/>
        <inertial pos="0.02 0.004 0.01" mass="0.3" fullinertia="3e-4 4e-4 5e-4 1e-5 2e-5 -1e-5"/>
        <site name="coupler D" pos="{end}"/>
      </body>
    </body>
    <body name="rocker" pos="0.09 0 0.01" xyaxes="0 0 1 1 0 0">
      <joint name="rock" axis="0 0 1"/>
      <geom type="box" size="0.035 0.004 0.006" pos="0.03 0 0"/>
      <geom type="ellipsoid" size="0.01 0.02 0.03" pos="0.06 0.01 0" euler="10 20 30"/>
      <geom type="sphere" size="0.008"/>
      <frame pos="0.055 0 0.002" euler="0 0 90"><site name="rocker D"/></frame>
    </body>
  </worldbody>
  <equality><connect site1="coupler D" site2="rocker D"/></equality>
  <actuator><velocity joint="turn"/></actuator>
  <keyframe><key qvel="5 0 0"/></keyframe>
</mujoco>
"""


def four_bar() -> str:
    """The coupler is turned askew in space; its joint is still along y of the world, reversed."""
    half = radians(-30)
    turned = np.array([[cos(half), 0, sin(half)], [0, 1, 0], [-sin(half), 0, cos(half)]])
    own = np.zeros(9)
    quat = np.array([0.9, 0.1, 0.2, -0.1])
    mujoco.mju_quat2Mat(own, quat / np.linalg.norm(quat))
    whole = turned @ own.reshape(3, 3)
    origin = np.array([0, 0, 0.02]) + turned @ [0.03, 0, 0]
    axis = whole.T @ [0, 1, 0]
    end = whole.T @ (np.array([0.09, 0.002, 0.065]) - origin)  # where the rocker's is, out of plane
    return FOUR_BAR.format(axis=_row(axis), end=_row(end))


def _row(values: np.ndarray) -> str:
    return " ".join(repr(float(value)) for value in values)


SLIDER = """
<mujoco model="lying slider-crank">
  <compiler angle="radian"/>
  <worldbody>
    <body name="crank" euler="0 0 0.6">
      <joint name="crank"/>
      <inertial pos="0.01 0 0" mass="0.2" diaginertia="1e-5 1e-5 1e-5"/>
    </body>
    <body name="rod" pos="0.1 0.005 0" zaxis="0 0 2">
      <joint name="slide" type="slide" axis="2 0 0"/>
      <joint name="wrist"/>
      <inertial pos="0.01 0 0" mass="0.3" diaginertia="1e-5 2e-4 2e-4"/>
      <body name="pad" pos="-0.04 0.01 0">
        <inertial pos="0 0 0" mass="0.02" diaginertia="1e-6 1e-6 1e-6"/>
      </body>
    </body>
  </worldbody>
  <equality><connect body1="crank" body2="rod" anchor="0.02 0 0"/></equality>
  <actuator><motor joint="crank"/></actuator>
</mujoco>
"""


def imported(path: Path, text: str, **reported: object) -> Imported:
    path.write_text(text)
    return import_machine(path, **reported)  # type: ignore[arg-type]


def angles(motion: Motion, link: str) -> np.ndarray:
    """Angle of a link, its rate and its second derivative by time, (N, 3)."""
    count = motion.crank_angle.size
    if link == FRAME:
        return np.zeros((count, 3))
    first = motion.links[link]
    parts = (first.angle, first.angular_velocity, first.angular_acceleration)
    return np.column_stack([np.broadcast_to(part, count) for part in parts])


def coordinates(
    machine: Machine, result: Imported, tree: dict[str, str], sign: float
) -> np.ndarray:
    """Hinges of a tree, link by its parent, (N, links, 3), from where it is drawn."""
    motion = move(machine, 12)
    drawn = {name: pose.angle for name, pose in result.outline.poses.items()} | {FRAME: 0.0}
    columns = []
    for link, parent in tree.items():
        first = angles(motion, link) - angles(motion, parent)
        first[:, 0] -= drawn[link] - drawn[parent]
        columns.append(sign * first)
    return np.stack(columns, 1)


def torque_by_mujoco(text: str, states: np.ndarray, speed: float) -> tuple[np.ndarray, float]:
    """Torque of the drive by the work of the open tree, and by how much loops stand open, m."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    actual, gap = [], 0.0
    for state in states:
        data.qpos[:], data.qvel[:], data.qacc[:] = state.T
        data.eq_active[:] = 1
        mujoco.mj_fwdPosition(model, data)
        gap = max(gap, float(np.abs(data.efc_pos).max()))
        data.eq_active[:] = 0
        mujoco.mj_inverse(model, data)
        actual.append(data.qfrc_inverse @ data.qvel / speed)
    return np.array(actual), gap


def test_a_standing_four_bar_of_shapes_does_what_mujoco_does(tmp_path: Path) -> None:
    text = four_bar()
    result = imported(tmp_path / "a.xml", text)
    machine = result.machine
    assert machine is not None, result.missing
    assert (machine.drive.link, machine.drive.speed) == ("crank", pytest.approx(5.0))
    assert machine == loads_linkage(result.text())
    assert machine.gravity == pytest.approx((0.3, -9.7))
    states = coordinates(
        machine, result, {"crank": FRAME, "coupler": "crank", "rocker": FRAME}, 1.0
    )
    states[:, 1:] *= -1  # their axes are reversed
    torque, gap = torque_by_mujoco(text, states, machine.drive.speed)
    ours = forces(move(machine, 12)).drive_torque
    assert gap < 3e-3  # MuJoCo sees what is out of the plane too
    assert np.abs(torque - ours).max() < 1e-9 * np.abs(ours).max()


def test_a_body_on_a_slide_and_a_hinge_does_what_mujoco_does(tmp_path: Path) -> None:
    """Lies flat: gravity acts across the plane.  A body without joints is part of its parent."""
    result = imported(tmp_path / "a.xml", SLIDER, speed=8.0)
    machine = result.machine
    assert machine is not None, result.missing
    assert machine.gravity == (0.0, 0.0)
    assert [*machine.links] == ["crank", "rod", "slide carrier"]
    assert machine.links["rod"].mass == pytest.approx(0.32)
    tree = {"crank": FRAME, "slide carrier": FRAME, "rod": FRAME}
    states = coordinates(machine, result, tree, 1.0)
    motion = move(machine, 12)
    point = motion.points[machine.sliders[0].point]
    parts = (point.place - 0.1, point.velocity, point.acceleration_vector)
    states[:, 1] = np.column_stack([part.real for part in parts])
    torque, gap = torque_by_mujoco(SLIDER, states, 8.0)
    ours = forces(motion).drive_torque
    assert gap < 1e-12
    assert np.abs(torque - ours).max() < 1e-9 * np.abs(ours).max()


ROBOT = """
<robot name="closed by hand">
  <link name="base"/>
  <link name="crank">
    <visual><geometry><box size="1 1 1"/></geometry></visual>
    <inertial><origin xyz="0 0.01 0.002" rpy="0.1 0.2 0.3"/><mass value="0.2"/>
      <inertia ixx="1e-5" iyy="2e-5" izz="3e-5" ixy="1e-6" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="rod"><inertial><origin xyz="0.03 0 0"/><mass value="0.3"/>
    <inertia ixx="1e-4" iyy="1e-4" izz="2e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="rod_end"/>
  <link name="rocker"><inertial><origin xyz="0 0 0.02"/><mass value="0.1"/>
    <inertia ixx="1e-4" iyy="1e-4" izz="2e-4" ixy="0" ixz="1e-5" iyz="0"/></inertial></link>
  <link name="rocker_end"/>
  <joint name="a" type="continuous"><parent link="base"/><child link="crank"/>
    <origin xyz="0 0 0.1" rpy="1.5707963267948966 0 0"/><axis xyz="0 0 1"/></joint>
  <joint name="b" type="revolute"><parent link="crank"/><child link="rod"/>
    <origin xyz="0 0.03 0.01" rpy="0 0 0.4"/><axis xyz="0 0 -2"/>
    <limit effort="1" velocity="1"/></joint>
  <joint name="c" type="fixed"><parent link="rod"/><child link="rod_end"/>
    <origin xyz="0.07 0 0"/></joint>
  <joint name="d" type="continuous"><parent link="base"/><child link="rocker"/>
    <origin xyz="0.08 0 0.1"/><axis xyz="0 -1 0"/></joint>
  <joint name="e" type="fixed"><parent link="rocker"/><child link="rocker_end"/>
    <origin xyz="-0.01 0 0.06"/></joint>
</robot>
"""


def test_a_robot_whose_loop_is_exported_does_what_pinocchio_does(tmp_path: Path) -> None:
    pin = pytest.importorskip("pinocchio")
    result = imported(tmp_path / "a.urdf", ROBOT, pin=["rod_end = rocker_end"], speed=6.0)
    machine = result.machine
    assert machine is not None, result.missing
    assert machine.drive.link == "crank"
    tree = {"crank": FRAME, "rod": "crank", "rocker": FRAME}
    states = coordinates(machine, result, tree, 1.0)
    states[:, 1] *= -1
    model = pin.buildModelFromXML(ROBOT)
    data = model.createData()
    model.gravity.linear = np.array([0, 0, -9.80665])
    ours = forces(move(machine, 12)).drive_torque
    assert [*model.names][1:] == ["a", "b", "d"]
    for state, torque in zip(states, ours, strict=True):
        q = np.concatenate([[cos(state[0, 0]), sin(state[0, 0])], state[1, :1],
                            [cos(state[2, 0]), sin(state[2, 0])]])  # fmt: skip
        needs = pin.rnea(model, data, q, state[:, 1], state[:, 2])
        assert needs @ state[:, 1] / 6.0 == pytest.approx(torque, rel=1e-9, abs=1e-12)


GEARED = """
<mujoco>
  <compiler angle="radian"/>
  <worldbody>
    <body name="arm"><joint name="arm"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <body name="planet" pos="0.05 0 0" euler="0 0 0.2"><joint name="planet" axis="0 0 -1"/>
        <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></body>
    <body name="idle" pos="0.2 0 0" euler="0 0 0.9"><joint name="idle"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>
  </worldbody>
  <equality>
    <joint joint1="planet" joint2="arm" polycoef="0 -2 0 0 0"/>
    <joint joint1="idle" joint2="arm" polycoef="0.1 -0.5 0 0 0"/>
  </equality>
</mujoco>
"""


def test_joints_that_are_tied_are_gears(tmp_path: Path) -> None:
    """The planet turns three times as fast as its arm: about a sun that stands still it is -2."""
    machine = imported(tmp_path / "a.xml", GEARED).machine
    assert machine is not None
    planet, idle = machine.gears
    assert (planet.driver, planet.driven, planet.carrier) == (FRAME, "planet", "arm")
    assert planet.ratio == pytest.approx(-2.0)
    assert (idle.driver, idle.driven, idle.carrier) == ("arm", "idle", FRAME)
    assert idle.ratio == pytest.approx(-0.5)
    drawn = move(machine, [0.0]).links
    assert drawn["planet"].angle[0] == pytest.approx(0.2)
    assert drawn["idle"].angle[0] == pytest.approx(0.9)


WRIST = '<joint name="wrist"/>'


def test_masses_that_are_not_given_stay_open(tmp_path: Path) -> None:
    """Of a mesh without an inertial; what hangs fixed on a link of URDF weighs nothing then."""
    rod = '</body>\n    <body name="rod"'
    mesh = changed(rod, f'<body><geom mesh="m"/></body>{rod}')
    result = imported(tmp_path / "a.xml", mesh)
    assert result.massless == ["crank"]
    assert any("meshes" in note for note in result.notes)
    looks = "<visual><geometry><sphere radius='1'/></geometry></visual>"
    seen = ROBOT.replace('<link name="rod_end"/>', f'<link name="rod_end">{looks}</link>')
    assert imported(tmp_path / "a.urdf", seen).massless == []
    bare = ROBOT.replace('<link name="rocker"><inertial>', f'<link name="rocker">{looks}<x>')
    bare = bare.replace('ixz="1e-5" iyz="0"/></inertial>', 'ixz="1e-5" iyz="0"/></x>')
    assert imported(tmp_path / "b.urdf", bare).massless == ["rocker"]


def changed(old: str, new: str) -> str:
    assert old in SLIDER
    return SLIDER.replace(old, new, 1)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (changed(WRIST, '<joint name="wrist" axis="0 1 1"/>'),
         {"place": "joint 'wrist'", "first": "crank"}),
        (changed('angle="radian"', 'coordinate="global"'), {"place": "compiler"}),
        (changed('axis="2 0 0"', 'axis="1 0 1"'), {"place": "joint 'slide'"}),
        (changed(WRIST, '<joint name="wrist" type="ball"/>'),
         {"place": "joint 'wrist'", "kind": "ball"}),
        (changed(WRIST, "<freejoint/>"), {"place": "body 'rod'"}),
        (changed('mass="0.3"', 'mass="nan"'), {"place": "inertial", "given": "nan"}),
        (changed('mass="0.3"', ""), {"place": "inertial"}),
        (changed('zaxis="0 0 2"', 'zaxis="0 0 0"'), {"place": "body 'rod'"}),
        (changed('body1="crank"', 'body1="cranks"'), {"place": "connect 1", "name": "cranks"}),
        (changed("<worldbody>", '<include file="b.xml"/><worldbody>'), {"tag": "include"}),
        (changed('body name="rod"', 'body name="crank"'), {"name": "crank"}),
        (changed('anchor="0.02 0 0"', 'anchor="0 0"'),
         {"place": "connect", "given": "0 0", "count": 3}),
        (ROBOT.replace('child link="rod"', 'child link="crank"'),
         {"place": "link 'crank'", "count": 2}),
        (ROBOT.replace('link="base"/><child link="crank"', 'link="rod"/><child link="crank"'),
         {"place": "link 'crank'"}),
        (ROBOT.replace('type="continuous"', 'type="floating"', 1),
         {"place": "joint 'a'", "kind": "floating"}),
        (ROBOT.replace('axis xyz="0 0 -2"', 'axis xyz="0 1 0"'),
         {"place": "joint 'b'", "first": "a"}),
    ],
)  # fmt: skip
def test_what_is_no_planar_machine_is_refused(
    text: str, expected: dict[str, Any], tmp_path: Path
) -> None:
    with refused(EquipoiseError, **expected):
        imported(tmp_path / "a.xml", text)


def test_bodies_can_be_held_still(tmp_path: Path) -> None:
    """A weld makes one link of two bodies, `--frame` one of a body and the world."""
    welded = changed("<connect", '<weld body1="rod" body2="pad"/><connect')
    assert imported(tmp_path / "a.xml", welded).outline.mobility == 1
    outline = imported(tmp_path / "a.xml", SLIDER, frame=["crank"]).outline
    assert [*outline.links] == ["rod", "slide carrier"]
    assert outline.mobility == 0


@pytest.mark.parametrize(
    "name", ["watt-six-bar", "class-three", "geared-counterweight", "planetary-planting-arm",
             "scotch-yoke", "spring-balanced-crank", "balance-geared-a"]
)  # fmt: skip
def test_what_export_wrote_for_mujoco_comes_back(name: str, tmp_path: Path) -> None:
    """All figures to 1e-9, with gears, sliders and springs; axes and names are the file's."""
    machine = load_linkage(name)
    export(machine, tmp_path / "a.xml", crank_angle=0.3)
    actual = import_machine(tmp_path / "a.xml").machine
    assert actual is not None
    assert actual.drive.speed == pytest.approx(machine.drive.speed, rel=1e-12)
    assert actual.links.keys() == machine.links.keys()
    old, new = forces(move(machine)), forces(move(actual))
    least = 10 * machine.mass * size_of(machine.links[machine.drive.link].points)  # some are 0
    for first, other in (
        (old.drive_torque, new.drive_torque),
        (old.shaking_force.x, new.shaking_force.x),
        (old.shaking_force.y, new.shaking_force.y),
        (old.shaking_moment, new.shaking_moment),
    ):
        assert np.abs(other - first).max() <= 1e-9 * max(np.abs(first).max(), least)


def test_a_support_can_be_held_still(tmp_path: Path) -> None:
    """Rows on one shaft are linkages of one crank then, whose masses add up."""
    machine = load_linkage("riding-transplanter")
    export(machine, tmp_path / "a.xml")
    actual = import_machine(tmp_path / "a.xml", frame=["support"]).machine
    assert actual is not None
    assert len(actual.links) == 1 + len(machine.rows) * (len(machine.links) - 1)
    assert actual.mass == pytest.approx(len(machine.rows) * machine.mass, rel=1e-9)


def test_a_support_that_is_not_held_still_is_reported(tmp_path: Path) -> None:
    export(load_linkage("sieve"), tmp_path / "a.xml")
    text = "'support' moves freely in the plane; --frame 'support' holds it still"
    assert text in import_machine(tmp_path / "a.xml").notes
    held = import_machine(tmp_path / "a.xml", frame=["support"])
    assert held.machine is not None
    assert text not in held.notes


@pytest.mark.parametrize("name", ["slider-crank-engine", "yamashita-1"])
def test_what_export_wrote_as_urdf_comes_back(name: str, tmp_path: Path) -> None:
    """Told the pins that it leaves out, by the small links at their ends: all lengths to 1e-9."""
    machine = load_linkage(name)
    left = export(machine, tmp_path / "a.urdf", crank_angle=0.3)
    cut = import_machine(tmp_path / "a.urdf")
    assert notes_by(planar, cut.notes)
    pins = [item.split('"')[1] for item in left if "--pin" in item]
    actual = import_machine(tmp_path / "a.urdf", pin=pins, crank=machine.drive.link).machine
    assert actual is not None
    assert actual.links.keys() == machine.links.keys()
    assert actual.mass == pytest.approx(machine.mass, rel=1e-12)
    for link in actual.links:
        lengths, before = (_lengths(each, link) for each in (actual, machine))
        for length in lengths:
            assert min(abs(length - item) for item in before) <= 1e-9 * max(before)


def _lengths(machine: Machine, link: str) -> list[float]:
    """Between points of a link, m; 0 is among them."""
    return [dist(*pair) for pair in product(machine.links[link].points.values(), repeat=2)]


PRESS = """
schema = 1
title = "Toggle press"
assembly = { K = "right", R = "forward" }
drive = { link = "crank", speed = "60 rpm" }
frame.points.O = ["-420 mm", "-150 mm"]
frame.points.G = ["0 mm", "0 mm"]
links.crank = { points = ["O", "B"], length = "60 mm" }
links.rod = { points = ["B", "K"], length = "400 mm" }
links.upper = { points = ["G", "K"], length = "180 mm" }
links.lower = { points = ["K", "R"], length = "220 mm" }
links.ram.points.R = ["0 mm", "0 mm"]
sliders = [{ link = "ram", point = "R", on = "frame", through = "G", direction = "-90 deg" }]
"""


def test_a_centre_of_mass_that_is_rounding_is_read_as_0(tmp_path: Path) -> None:
    """Turned through space, 0 came out as -3e-33 m, a length that no machine is said to have."""
    drawn = loads_linkage(PRESS)
    links = {name: replace(link, mass=85.0, center_of_mass=(0.0, 0.0), inertia=1.0)
             for name, link in drawn.links.items()}  # fmt: skip
    press = replace(drawn, links=links)
    file = tmp_path / "press.xml"
    export(press, file)
    back = import_machine(file).machine
    assert back is not None
    assert back.links["ram"].center_of_mass == (0.0, 0.0)
    before, after = (forces(move(item)).drive_torque for item in (press, back))
    assert np.abs(after - before).max() < 1e-6 * np.abs(before).max()
