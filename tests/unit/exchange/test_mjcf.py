"""MJCF runs in MuJoCo as it is, by its own servo and constraints; exact figures: `crosscheck`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

import equipoise as eq
from equipoise.exchange.mjcf import STEPS
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.stops import Stop
from equipoise.mechanism.parts.support import unit_vector
from support.conformance import compared
from support.loads import with_loads_in_lines
from support.rated import HELD, LAWS, LINEAR, ON_LINKS, machine_with
from support.refusals import refused
from support.sources import MUJOCO

START = 0.3
"""Crank angle at which the files are drawn, rad."""
RUNNING = [
    *("lee-kim-a", "kim-chung-b", "class-three", "quick-return", "scotch-yoke", "watt-six-bar"),
    *("spring-balanced-crank", "geared-counterweight", "planetary-planting-arm"),
    "four-row-transplanter",
]


def opened(
    machine: eq.Machine, path: Path, start: float = START
) -> tuple[mujoco.MjModel, mujoco.MjData]:
    eq.export(machine, path, crank_angle=start)
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    return model, data


@compared(MUJOCO, "drive torque of the exported file over a turn, its constraints soft", 0.02)
@pytest.mark.parametrize("name", RUNNING)
def test_a_turn_of_the_crank(name: str, tmp_path: Path) -> None:
    """Pins hold to 3e-4 of the size, since MuJoCo's are soft; the servo lags 1e-4 of the speed.

    The drive's torque has the steps' error, largest where it changes fastest: 2 % of its peak.
    """
    machine = replace(eq.load(name), loads=(), balance=None)
    model, data = opened(machine, tmp_path / "model.xml")
    row = " 1" if machine.rows else ""
    crank = model.joint(machine.drive.link + row).qposadr[0]
    angles, torques = np.empty((2, STEPS))
    for step in range(STEPS):
        angles[step] = START + data.qpos[crank]
        mujoco.mj_step(model, data)
        torques[step] = data.sensor("drive torque").data[0]
    turned = data.time * machine.drive.speed
    assert turned == pytest.approx(np.copysign(2 * np.pi, machine.drive.speed))
    assert data.qpos[crank] == pytest.approx(turned, rel=1e-3)
    mujoco.mj_forward(model, data)
    points = eq.move(machine, [START + data.qpos[crank]]).points
    size = max(eq.mechanism.parts.machine.size_of(body) for body in machine.bodies.values())
    for link, body in machine.links.items():
        for point in body.points:
            place = complex(*data.site(f"{link}{row} {point}").xpos[:2])
            assert abs(place - points[point].place[0]) < 3e-4 * size
    late = angles - machine.drive.speed * model.opt.timestep  # the torque of a step is implicit
    phases = [item.phase for item in machine.rows] or [0.0]
    wanted = sum(eq.forces(eq.move(machine, late + phase)).drive_torque for phase in phases)
    settled = slice(STEPS // 10, None)
    assert np.max(np.abs(torques - wanted)[settled]) < 0.02 * np.max(np.abs(wanted))


def put_in_motion(
    model: mujoco.MjModel, data: mujoco.MjData, machine: eq.Machine, crank_angle: float
) -> None:
    """Joints of a file drawn at `START` as in the package at a crank angle."""
    motion, drawn = (eq.move(machine, [at], acceleration=0.0) for at in (crank_angle, START))
    angles = {name: motion.links[name].angle[0] - drawn.links[name].angle[0]
              for name in machine.links}  # fmt: skip
    rates = {name: motion.links[name].angular_velocity[0] for name in machine.links}
    for number in range(model.njnt):
        joint = model.joint(number)
        body = joint.bodyid[0]
        link, parent = model.body(body).name, model.body(model.body(body).parentid[0]).name
        if model.jnt_type[number] == mujoco.mjtJoint.mjJNT_SLIDE:
            name = next(slider.name for slider in machine.sliders if slider.link == link)
            now, before = (item.sliders[name] for item in (motion, drawn))
            data.qpos[joint.qposadr[0]] = now.travel[0] - before.travel[0]
            data.qvel[joint.dofadr[0]] = now.velocity[0]
            continue
        data.qpos[joint.qposadr[0]] = angles[link] - angles.get(parent, 0.0)
        data.qvel[joint.dofadr[0]] = rates[link] - rates.get(parent, 0.0)


def power_of(machine: eq.Machine, bare: eq.Machine, crank_angle: float, folder: Path) -> float:
    """Power, W, that MuJoCo takes with what a machine has beyond another, in a pose and at the
    velocities of the package.
    """
    powers = []
    for number, item in enumerate((machine, bare)):
        rig, state = opened(item, folder / f"{number}.xml")
        put_in_motion(rig, state, machine, crank_angle)
        state.ctrl[:] = machine.drive.speed  # the servo adds nothing
        mujoco.mj_forward(rig, state)
        powers.append((state.qfrc_passive + state.qfrc_actuator) @ state.qvel)
    return float(powers[1] - powers[0])


def losses_in(machine: eq.Machine, tables: Iterable[str], crank_angle: float) -> float:
    """Power, W, that force elements turn to heat."""
    pose = eq.move(machine, [crank_angle])
    return sum(
        pose.element_values(table, number)["loss"][0]
        for table in tables
        for number in range(len(getattr(machine, table)))
    )


@pytest.mark.exhaustive(but=["0.0", "1.5", "3.0", "6.0"])
@pytest.mark.parametrize("at", np.linspace(0.0, 6.0, 13))
def test_dampers_and_viscous_resistances(at: float, tmp_path: Path) -> None:
    machine = machine_with(LINEAR)
    taken = power_of(machine, machine_with({}), START + at, tmp_path)
    assert taken == pytest.approx(losses_in(machine, LINEAR, START + at), rel=1e-9)


def energy_rate(machine: eq.Machine, table: str, crank_angle: float) -> float:
    """Power, W, that goes into force elements, by what they do to the drive torque."""
    bare = replace(machine, **{table: ()})
    torques = (eq.forces(eq.move(item, [crank_angle])).drive_torque for item in (machine, bare))
    return float(np.subtract(*torques)[0] * machine.drive.speed)


@pytest.mark.parametrize("at", np.linspace(0.0, 6.0, 7))
def test_bushings(at: float, tmp_path: Path) -> None:
    """With preloads, torsional springs and dampers, by the power that they take from the drive."""
    machine = machine_with(HELD)
    assert eq.export(machine, tmp_path / "m.xml") == ()
    taken = power_of(machine, machine_with({}), START + at, tmp_path)
    assert taken == pytest.approx(energy_rate(machine, "bushings", START + at), rel=1e-9)


def test_elastic_stops(tmp_path: Path) -> None:
    """They push where the point is beyond their line, and nowhere else."""
    machine = machine_with({"stops": (Stop("coupler", "P", "A", 300.0, 1.2),)})
    assert eq.export(machine, tmp_path / "m.xml") == ()
    actual = []
    for at in np.linspace(0.0, 6.0, 13):
        taken = power_of(machine, machine_with({}), START + at, tmp_path)
        actual.append(energy_rate(machine, "stops", START + at))
        assert taken == pytest.approx(actual[-1], rel=1e-9, abs=1e-12)
    assert 0 < np.count_nonzero(actual) < len(actual)


@pytest.mark.parametrize("at", [0.5, 2.5, 4.5])
def test_damping_and_drag_of_joints(at: float, tmp_path: Path) -> None:
    """Of pins, one of which closes the loop, and of a slider; drag as friction loss, which MuJoCo
    has among its soft constraints.
    """
    engine = replace(eq.load("plunger-pump"), loads=(), joints=())
    given = (
        JointProperties("joints.A", radius=0.01, torsional_damping=0.02, drag_torque=0.3),
        JointProperties("joints.B", torsional_damping=0.01),
        JointProperties("joints.C", drag_torque=0.2),
        JointProperties("joints.plunger on frame", damping=30.0, drag_force=12.0),
    )
    machine = replace(engine, joints=given)
    assert eq.export(machine, tmp_path / "m.xml") == ()
    model, data = opened(machine, tmp_path / "m.xml")
    put_in_motion(model, data, machine, START + at)
    data.ctrl[:] = machine.drive.speed
    mujoco.mj_forward(model, data)
    friction = data.efc_type == mujoco.mjtConstraint.mjCNSTR_FRICTION_DOF
    friction |= data.efc_type == mujoco.mjtConstraint.mjCNSTR_FRICTION_TENDON
    jacobian = np.zeros((data.nefc, model.nv))
    jacobian[:] = np.reshape(data.efc_J, jacobian.shape)
    taken = -data.qfrc_passive @ data.qvel
    taken -= (jacobian @ data.qvel)[friction] @ data.efc_force[friction]
    wanted = eq.forces(eq.move(machine, [START + at])).friction_loss[0]
    assert taken == pytest.approx(wanted, rel=1e-6)
    rubbing = replace(machine, joints=(*given[:3], replace(given[3], friction=0.1)))
    (left_out,) = eq.export(rubbing, tmp_path / "m.xml")
    assert left_out == "friction in joints by what presses there: damping and drag alone are left"


def test_what_a_file_leaves_out_of_force_elements(tmp_path: Path) -> None:
    path = tmp_path / "m.xml"
    left_out = (
        "dampers with a table",
        "the restitution of stops: they lose nothing",
        "dry and one-way parts of resistances",
    )
    assert eq.export(machine_with(LAWS), path) == left_out
    assert eq.export(machine_with(ON_LINKS), path) == (
        "torsion dampers with a table",
        "bushings on a body that moves",
        "stops on a body that moves",
        "resistances on a body that moves",
    )


@compared(MUJOCO, "gauges of the exported file from rest, its constraints soft", 0.02)
@pytest.mark.parametrize("name", ["yamashita-rig", "exudyn-slider-crank", "sieve"])
def test_a_support_from_rest(name: str, tmp_path: Path) -> None:
    """Its gauges for half a turn, to 2 % of their largest displacement, with the softness above."""
    machine = replace(eq.load(name).with_drive(motor=None), balance=None)
    model, data = opened(machine, tmp_path / "model.xml", 0.0)
    seen = np.empty((STEPS // 2, len(machine.support.gauges), 3))
    mujoco.mj_forward(model, data)
    sites = [model.site(f"gauge {gauge}").id for gauge in machine.support.gauges]
    start = data.site_xpos[sites].copy()
    for step in range(len(seen)):
        seen[step] = data.site_xpos[sites] - start
        mujoco.mj_step(model, data)
    times = (len(seen) - 1) * model.opt.timestep
    exact = eq.simulate(machine, times, machine.drive.speed, samples=len(seen))
    for number, (gauge, reading) in enumerate(machine.support.gauges.items()):
        moved, wanted = seen[:, number] @ unit_vector(reading.direction), exact.gauges[gauge]
        assert np.max(np.abs(moved - wanted)) < 0.02 * np.max(np.abs(wanted)), gauge


def test_a_constant_load(tmp_path: Path) -> None:
    """Its moment about the crank's pin, at rest."""
    load = eq.Load("crank", point="B", force=(3.0, 4.0)), eq.Load("crank", torque=0.5)
    machine = replace(eq.load("yamashita-1"), loads=load)
    model, data = opened(machine, tmp_path / "model.xml")
    data.qvel[:], data.ctrl[:] = 0.0, 0.0
    mujoco.mj_forward(model, data)
    x, y = (data.site("crank B").xpos - data.site("crank A").xpos)[:2]
    crank = model.joint("crank").qposadr[0]
    assert data.qfrc_actuator[crank] == pytest.approx(x * 4.0 - y * 3.0 + 0.5)


@pytest.mark.parametrize("at", np.linspace(0.0, 6.0, 7))
def test_forces_in_the_line_between_two_points(at: float, tmp_path: Path) -> None:
    """To the frame and to the crank, by the power that they take from the drive."""
    bare, machine = with_loads_in_lines()
    taken = power_of(machine, bare, START + at, tmp_path)
    assert taken == pytest.approx(energy_rate(machine, "loads", START + at), rel=1e-9)


def test_what_is_left_out_is_reported(tmp_path: Path) -> None:
    exported = eq.export(eq.load("transplanter"), tmp_path / "m.xml")
    assert exported == ("the soil's force",)
    exported = eq.export(eq.load("slider-crank-engine"), tmp_path / "m.xml")
    assert exported == ("load 1, which is not constant",)
    machine = eq.load("yamashita-1").with_link("coupler", mass=0.0, inertia=0.0)
    (exported,) = eq.export(machine.with_drive(acceleration=0.0), tmp_path / "m.xml")
    assert exported.startswith("that 'coupler' has no mass")


def test_a_linkage_without_masses(tmp_path: Path) -> None:
    path = tmp_path / "m.xml"
    bare = eq.load("yamashita-1").with_link("crank", mass=None, center_of_mass=None, inertia=None)
    with refused(eq.EquipoiseError, links="crank"):
        eq.export(replace(bare, balance=None), path)
    assert not path.exists()
