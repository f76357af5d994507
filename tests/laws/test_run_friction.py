"""Runs with friction: closed forms, what holds a machine at rest, and inverse dynamics."""

from __future__ import annotations

from dataclasses import replace
from math import log, pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.bushings import Bushing
from equipoise.mechanism.parts.dampers import Damper
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.loads import Load
from equipoise.mechanism.parts.motors import Motor
from equipoise.mechanism.parts.resistances import Resistance
from equipoise.mechanism.parts.stops import Stop
from equipoise.mechanism.parts.torsion_dampers import TorsionDamper
from equipoise.running.blocks import verdict
from equipoise.running.drivers import Driver
from support.chosen import few
from support.machines_redundant import planet_train
from support.refusals import refused

MASS, VISCOUS, DRY, OFFSET = 95.11, 203.5, 20.39, -3.165
"""Of the electro-mechanical positioning system (EMPS): kg, N s/m, N, N."""
HALT = DRY - OFFSET
ENGINE = replace(eq.load("slider-crank-engine"), balance=None, loads=())
JOINTS = (
    JointProperties("joints.A", radius=0.02, friction=0.05, torsional_damping=1e-4),
    JointProperties("joints.B", radius=0.02, friction=0.05),
    JointProperties("joints.C", radius=0.01, friction=0.1, static_friction=0.15,
                    stribeck_speed=0.5),
    JointProperties("joints.piston on frame", friction=0.1, guide_length=0.06, damping=2.0,
                    drag_force=10.0),
)  # fmt: skip
WORN = replace(ENGINE, joints=JOINTS)
ELEMENTS: list[dict[str, Any]] = [
    {},
    {"dampers": (Damper("rod", "C", "A", 30.0),),
     "torsion_dampers": (TorsionDamper("rod", "crank", 0.02),)},
    {"stops": (Stop("piston", "C", "A", 500.0, -pi / 2, restitution=0.5, speed=2.0),),
     "resistances": (Resistance("piston", "C", "A", direction=pi / 2, force=60.0, damping=4.0,
                                speed=1e-7),)},
    {"bushings": (Bushing("rod", "C", "A", stiffness=(200.0, 300.0), damping=(3.0, 4.0),
                          preload=(20.0, 0.0)),)},
]  # fmt: skip


def emps(motor: Motor | None = None, **given: Any) -> eq.Machine:
    """The positioning system as a wheel: what it slides, in m, is its angle."""
    wheel = eq.Link({"A": (0.0, 0.0)}, 1.0, (0.0, 0.0), MASS)
    joint = JointProperties("joints.A", torsional_damping=VISCOUS, drag_torque=DRY, **given)
    return eq.Machine("EMPS", eq.Drive("wheel", 1.0, motor=motor), {"A": (0.0, 0.0)},
                      {"wheel": wheel}, loads=(Load("wheel", torque=OFFSET),),
                      joints=(joint,))  # fmt: skip


@pytest.mark.parametrize("speed", [0.1, 1.0, -0.1, -1.0])
def test_a_positioning_system_comes_to_rest_as_viscous_and_dry_friction_have_it(
    speed: float,
) -> None:
    """The offset helps one way and hinders the other."""
    run = eq.run(emps(), speed=speed)
    assert run.end.kind == "standstill"
    size, way = abs(speed), speed / abs(speed)
    halt = DRY - way * OFFSET
    time = MASS / VISCOUS * log(1 + VISCOUS * size / halt)
    assert run.end.time == pytest.approx(time, rel=1e-8)
    wanted = (size + halt / VISCOUS) * np.exp(-run.time * VISCOUS / MASS) - halt / VISCOUS
    np.testing.assert_allclose(way * run.crank_speed, wanted, atol=1e-9 * size)
    assert run.energy_error < 1e-9
    distance = MASS / VISCOUS * size - halt / VISCOUS * time
    assert run.end.crank_angle == pytest.approx(way * distance, rel=1e-8)


def test_a_positioning_system_is_driven_to_its_steady_speed() -> None:
    force = 100.0
    run = eq.run(emps(Motor(torque=force)), "3 s")
    steady = (force - HALT) / VISCOUS
    wanted = steady * (1 - np.exp(-run.time * VISCOUS / MASS))
    np.testing.assert_allclose(run.crank_speed, wanted, atol=1e-9)
    lost = run.work["friction"][-1]
    assert lost == pytest.approx(-np.trapezoid((DRY + VISCOUS * wanted) * wanted, run.time),
                                 rel=1e-2)  # fmt: skip
    assert run.energy_error < 1e-9


@pytest.mark.parametrize(("torque", "moves"), [(HALT * 0.999, False), (HALT * 1.001, True)])
def test_it_stays_put_until_the_torque_breaks_it_away(torque: float, moves: bool) -> None:
    run = eq.run(emps(Motor(torque=torque)), "1 s")
    assert (run.end.kind == "time") == moves
    if not moves:
        assert (run.end.kind, run.turned) == ("stall", 0.0)
        assert run.lacking_torque == pytest.approx((HALT, torque))
        assert "needs 23.55 N m to start, and has 23.53 N m" in verdict(run)


def test_a_load_below_what_holds_it_does_not_start_a_machine() -> None:
    """The offset is smaller than dry friction, which holds a machine without a motor at rest."""
    assert eq.run(emps(), speed=0.0).end.kind == "standstill"


@pytest.mark.exhaustive(but=["machine0"])
@pytest.mark.parametrize("machine", [WORN, replace(WORN, rows=(eq.mechanism.Row(),
                         eq.mechanism.Row(phase=pi / 2)))])  # fmt: skip
def test_a_coast_down_loses_its_energy_in_joints(machine: eq.Machine) -> None:
    run = eq.run(machine, speed=100.0)
    assert run.end.kind == "standstill" and run.energy_error < 1e-9
    energy = run.kinetic_energy
    lost = run.work["friction"] + run.work["weight"]
    np.testing.assert_allclose(energy - energy[0], lost, atol=1e-9 * energy[0])
    assert np.all(np.diff(run.work["friction"]) <= 1e-12 * energy[0])
    assert run.losses.keys() == {*run.equation.rubbing}
    for lost in run.losses.values():
        assert np.all(np.diff(lost) >= -1e-12 * energy[0])
    np.testing.assert_allclose(-sum(run.losses.values()), run.work["friction"], rtol=1e-12)


@pytest.mark.exhaustive(but=["one row-stops, resistances", "one row-bushings"])
@pytest.mark.parametrize("elements", ELEMENTS, ids=lambda elements: ", ".join(elements) or "none")
@pytest.mark.parametrize("rows", few([(), (eq.mechanism.Row(), eq.mechanism.Row(phase=2.0))], [()]),
                         ids=["one row", "two rows"])  # fmt: skip
def test_the_acceleration_is_that_of_which_inverse_dynamics_needs_no_torque(
    rows: tuple[Any, ...], elements: dict[str, Any]
) -> None:
    """Inverse dynamics, whose friction knows nothing of runs, asks for what the drive gives."""
    machine = replace(WORN, rows=rows, **elements)
    run = eq.run(machine, speed=100.0, turns=1)
    assert run.energy_error < 1e-9
    equation = run.equation
    for k in np.linspace(1, len(run.time) - 2, 15).astype(int):
        angle, speed = float(run.crank_angle[k]), float(run.crank_speed[k])
        if np.min(np.abs(equation.edges - angle)) < 1e-6:
            continue  # there a slider turns back, and its friction has two values
        inertia, slope, torques = equation.at(angle, speed, 0.0, 1.0)
        rate = (float(np.sum(torques)) - slope * speed**2 / 2) / inertia
        phases = [row.phase for row in rows] or [0.0]
        alone = replace(machine, rows=())
        each = [eq.analyze(alone, [angle + phase], speed, rate).forces for phase in phases]
        size = abs(float(torques[-1])) + inertia * abs(rate)
        assert abs(sum(float(forces.drive_torque[0]) for forces in each)) < 1e-9 * size


# What friction takes: `test_a_coast_down_loses_its_energy_in_joints`.
@pytest.mark.exhaustive
def test_a_motor_works_against_friction() -> None:
    motor = Motor(300.0, 30.0)
    drive = replace(WORN.drive, speed=200.0, motor=motor)
    run = eq.run(replace(WORN, drive=drive))
    assert run.end.kind == "steady"
    cycle = run.last_cycle
    assert cycle is not None and cycle.energy > 0
    free = eq.run(replace(ENGINE, drive=drive)).last_cycle
    assert free is not None and cycle.mean_speed < free.mean_speed
    torque = Driver.of(run.machine).torque(np.array(cycle.mean_speed))
    assert cycle.energy_per_turn == pytest.approx(2 * pi * float(torque), rel=0.05)


def with_losses(name: str, loss: float = 0.05) -> eq.Machine:
    """A bundled machine whose meshes lose, and whose pins rub, by the names of its forces."""
    machine = with_chain() if name == "chain" else eq.load(name)
    names = eq.analyze(machine, [0.0]).forces
    joints = [
        JointProperties(f"joints.{pin}", friction=0.08, radius=0.004)
        for pin, force in names.joints.items()
        if not hasattr(force, "normal")
    ]
    joints += [
        JointProperties(f"{mesh.list_name}.{mesh.name}", mesh_loss=loss)
        for mesh in machine.couplings
        if mesh.list_name in ("gears", "racks", "belts")
    ]
    return replace(machine, joints=tuple(joints), balance=None, run=None)


def with_chain() -> eq.Machine:
    """A crank that swings a wheel by a rod, whose sprocket drives another by a chain."""
    machine = eq.load("geared-counterweight")
    (gear,) = machine.gears
    chain = Belt(gear.driver, gear.driven, radii=(0.02, 0.03), carrier=gear.carrier)
    return replace(machine, gears=(), belts=(chain,), balance=None)


@pytest.mark.parametrize(
    "name", ["geared-counterweight", "planetary-planting-arm", "knife-drive", "transplanter",
             "elliptic-quick-return", "chain"],
)  # fmt: skip
def test_teeth_chains_and_soil_press_in_a_run_as_in_inverse_dynamics(name: str) -> None:
    """Flanks and strands change within a turn, and the soil pushes; what they press in joints
    and what meshes lose is that of inverse dynamics, which passes over each flank anew.
    """
    machine = with_losses(name)
    speed = machine.drive.speed
    run = eq.run(machine, speed=speed, turns=1)
    assert run.energy_error < 1e-9
    equation, compared = run.equation, 0
    for k in np.linspace(1, len(run.time) - 2, 25).astype(int):
        angle, now = float(run.crank_angle[k]), float(run.crank_speed[k])
        if np.min(np.abs(equation.edges - angle % equation.period)) < 1e-6:
            continue
        sense = float(np.sign(now))
        inertia, slope, torques = equation.at(angle, now, 0.0, sense)
        rate = (float(np.sum(torques)) - slope * now**2 / 2) / inertia
        forces = eq.analyze(machine, [angle], now, rate).forces
        size = np.max(np.abs(torques)) + inertia * abs(rate)
        assert abs(float(forces.drive_torque[0])) < 1e-8 * size
        assert abs(float(torques[-1])) > 1e-6 * size
        compared += 1
    assert compared > 10


@pytest.mark.parametrize("name", ["rotary-transplanter", "chain"])
def test_each_row_has_flanks_strands_and_soil_of_its_own(name: str) -> None:
    """Drive torques of single rows at their phases, by inverse dynamics, add up to nothing."""
    alone = with_losses(name)
    phases = (0.0, 1.3)
    machine = replace(alone, rows=tuple(eq.mechanism.Row(phase=phase) for phase in phases))
    run = eq.run(machine, speed=alone.drive.speed, turns=1)
    assert run.energy_error < 1e-9
    equation, compared = run.equation, 0
    for k in np.linspace(1, len(run.time) - 2, 8).astype(int):
        angle, now = float(run.crank_angle[k]), float(run.crank_speed[k])
        if np.min(np.abs(equation.edges - angle % equation.period)) < 1e-6:
            continue
        inertia, slope, torques = equation.at(angle, now, 0.0, float(np.sign(now)))
        rate = (float(np.sum(torques)) - slope * now**2 / 2) / inertia
        asked = sum(
            float(eq.analyze(alone, [angle + phase], now, rate).forces.drive_torque[0])
            for phase in phases
        )
        assert abs(asked) < 1e-8 * (np.max(np.abs(torques)) + inertia * abs(rate))
        compared += 1
    assert compared > 4


def test_friction_is_refused_where_teeth_share_their_force_with_what_is_redundant() -> None:
    machine = planet_train(np.random.default_rng(1)).machine
    joint = JointProperties(f"gears.{machine.gears[0].name}", mesh_loss=0.02)
    with refused(UsageError, by="check_shared_friction"):
        eq.run(replace(machine, joints=(joint,)), speed=1.0, turns=1)


def test_joints_lose_what_an_analysis_says_at_constant_speed() -> None:
    """A flywheel keeps the speed; an analysis has the friction of inverse dynamics."""
    machine = WORN.with_drive(flywheel=1e4, speed=50.0, motor=None, acceleration=0.0)
    actual, losses = eq.run(machine, turns=1, speed=50.0), eq.analyze(machine, 720).losses
    assert losses is not None and len(losses.joints) == len(actual.losses) > 1
    time = 2 * pi / 50.0
    for name, joint in losses.joints.items():
        # the mean over 720 crank angles misses corners of the losses, where forces pass 0
        assert actual.losses[name][-1] == pytest.approx(joint.loss * time, rel=1e-3)
