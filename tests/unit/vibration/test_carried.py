"""Joint forces on a support that moves: known cases, and equilibrium of the support itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.force_elements import Motor
from equipoise.mechanism.model import Load
from equipoise.mechanism.reactions import Pass
from equipoise.mechanism.support import Row
from equipoise.vibration.exact import ExactSolution, solve_exact
from equipoise.vibration.linkages import BaseMotion, joint_forces, sums
from support.machines import make
from unit.vibration.build import SPEED, Array, close, rig, springs

THETA = np.linspace(0.05, 6.2, 24)
STILL = np.zeros((3, 24))
EXAMPLES = ("yamashita-1", "slider-crank-engine", "watt-six-bar", "geared-counterweight")
RANDOM = ("quick_return", "stephenson", "geared_coupler")
machines = pytest.mark.parametrize("name", [*EXAMPLES, *RANDOM])


def machine_of(name: str) -> eq.Machine:
    return make(name, 2).machine if name in RANDOM else eq.load(name)


def ride(
    rate: Array = STILL, change: Array = STILL, place: Array = STILL, spin_up: float = 0.0
) -> BaseMotion:
    """Ride at 20 rad/s of the crank."""
    one = np.ones(24)
    return BaseMotion(place, rate, change, THETA, 20 * one, spin_up * one, 0.3 - 0.2j)


def same(found: Pass, wanted: Pass | eq.mechanism.Forces) -> None:
    """Compare all joint forces and the torque to 1e-12 of the largest force and torque."""
    size = max(float(np.max(joint.size)) for joint in wanted.joints.values())
    for name, joint in wanted.joints.items():
        np.testing.assert_allclose(found.joints[name].value, joint.value, atol=1e-12 * size)
    for name, gear in wanted.gears.items():
        np.testing.assert_allclose(found.gears[name].value, gear.value, atol=1e-12 * size)
    close(found.drive_torque, wanted.drive_torque, 1e-11)


@machines
@pytest.mark.parametrize("spin_up", [0.0, 35.0])
def test_on_a_support_that_stands_still(name: str, spin_up: float) -> None:
    machine = machine_of(name)
    wanted = eq.analyze(machine, THETA, speed=20.0, acceleration=spin_up).forces
    same(joint_forces(machine, ride(spin_up=spin_up), 0.0, 0j), wanted)


@machines
def test_on_a_support_that_only_moves_along(name: str) -> None:
    """A steady velocity is not felt; an acceleration is felt as weight against it."""
    machine = machine_of(name)
    velocity, change = STILL.copy(), STILL.copy()
    velocity[:2], change[:2] = [[3.0], [-2.0]], [[4.0], [2.5]]
    found = joint_forces(machine, ride(velocity, change), 0.0, 0j)
    gx, gy = machine.gravity
    heavier = replace(machine, gravity=(gx - 4.0, gy - 2.5))
    same(found, eq.analyze(heavier, THETA, speed=20.0, acceleration=0.0).forces)


@machines
def test_on_a_support_that_leans(name: str) -> None:
    """In its own axes gravity leans the other way."""
    machine = machine_of(name)
    place = STILL.copy()
    place[2] = 0.7
    down = complex(*machine.gravity) * np.exp(-0.7j)
    leaning = replace(machine, gravity=(down.real, down.imag))
    wanted = eq.analyze(leaning, THETA, speed=20.0, acceleration=0.0).forces
    same(joint_forces(machine, ride(place=place), 0.0, 0j), wanted)


def test_of_a_row_that_is_ahead() -> None:
    machine = eq.load("yamashita-1")
    wanted = eq.analyze(machine, THETA + 1.3, speed=20.0, acceleration=0.0).forces
    same(joint_forces(machine, ride(), 1.3, 0.4 + 0.1j), wanted)


def test_a_crank_that_stands_still_in_space_is_not_spun_up() -> None:
    """Its support turns under it about the crank's own pivot: no inertia of the crank is felt."""
    machine = replace(rig(), gravity=(0.0, 0.0))
    turning, spin_up = STILL.copy(), STILL.copy()
    turning[2], spin_up[2] = -20.0, -7.0
    for link in ("coupler", "rocker"):
        machine = machine.with_link(link, mass=0.0, inertia=0.0)
    ahead = replace(ride(turning, spin_up, spin_up=7.0), reference=0j)
    found = joint_forces(machine, ahead, 0.0, 0j)
    plain = joint_forces(machine, replace(ride(), reference=0j), 0.0, 0j)
    assert np.max(found.joints["A"].size) < 1e-12 * np.max(plain.joints["A"].size)
    assert np.max(np.abs(found.drive_torque)) < 1e-12


@machines
@pytest.mark.parametrize("seed", [0, 1])
def test_whole_force_is_the_change_of_momentum(name: str, seed: int) -> None:
    """On any motion: force and moment of all joints on the frame, by the sums over the links."""
    machine = replace(machine_of(name), loads=(), springs=())
    rng = np.random.default_rng(seed)
    place, rate, change = rng.normal(size=(3, 3, 24))
    here = replace(ride(rate, change, place, 11.0), crank_speed=rng.normal(size=24))
    found = joint_forces(machine, here, 0.4, 0.2 - 0.5j)
    row = machine.with_rows([Row(phase=0.4, offset=(0.2, -0.5))])
    s = sums(row, THETA, here.reference, 20.0)
    speed, spin_up, w, a = here.crank_speed, here.crank_acceleration, rate[2], change[2]
    felt = np.exp(-1j * place[2]) * (change[0] + 1j * change[1] - complex(*machine.gravity))
    bend = s.first_1 * spin_up + s.first_2 * speed**2
    force = s.mass * felt + (1j * a - w**2) * s.first + 2j * w * speed * s.first_1 + bend
    close(-found.frame_force, force, 1e-12)
    moment = (np.conj(s.first) * felt).imag + s.inertia * a + s.inertia_1 * w * speed
    moment = moment + s.spin * spin_up + s.spin_1 * speed**2
    pole = here.reference - (0.2 - 0.5j)
    close(-found.frame_moment(pole), moment, 1e-11)
    torque = (np.conj(s.first_1) * felt).real + s.spin * a + s.drive * spin_up
    torque = torque + s.drive_1 * speed**2 / 2 - s.inertia_1 * w**2 / 2
    close(found.drive_torque, torque, 1e-11)


# -- the support's own equilibrium -----------------------------------------------------------------

LINE = Motor(26.0, 6.0, ratio=1.1, inertia=0.004)
TWO = [Row(), Row(phase=1.9, offset=(0.2, 0.05))]


def solutions() -> dict[str, ExactSolution]:
    loads = (Load("coupler", "P", (20.0, 35.0), start=1.0, stop=4.0),)
    driven = springs().with_drive(motor=LINE, flywheel=0.02)
    return {
        "pivot": solve_exact(rig(), SPEED, False),
        "two rows": solve_exact(springs().with_rows(TWO), -14.0, False),
        "six-bar": solve_exact(springs("watt-six-bar"), 11.0, False),
        "loads": solve_exact(replace(springs(), loads=loads), SPEED, False),
        "motor": solve_exact(driven, SPEED, True),
        "motor, reversed": solve_exact(
            rig().with_rows(TWO).with_drive(motor=LINE, flywheel=0.02, speed=-SPEED), -SPEED, True
        ),
    }


@pytest.fixture(scope="module")
def solved() -> dict[str, ExactSolution]:
    return solutions()


CASES = ("pivot", "two rows", "six-bar", "loads", "motor", "motor, reversed")
cases = pytest.mark.parametrize("case", CASES)


def turning_with_the_crank(solution: ExactSolution) -> tuple[float, float]:
    """Return moments of inertia that turn as the support feels them, and as the crank does."""
    drive = solution.machine.drive
    if drive.motor is None:
        return drive.flywheel, drive.flywheel
    rotor, ratio = drive.motor.inertia, drive.motor.ratio
    return drive.flywheel + ratio * rotor, drive.flywheel + ratio**2 * rotor


@cases
def test_support_is_in_equilibrium(solved: dict[str, ExactSolution], case: str) -> None:
    """Newton's law of the support alone, with its mounts and its weight, and what the joints do.

    What spins up with the crank reacts on the support; as far as it turns with the support, it
    is a part of it.  A pivot's own force is not asked for.
    """
    solution = solved[case]
    here = solution.ride
    support = solution.machine.support
    assert support is not None
    turn = np.exp(1j * here.place[2])
    gravity = complex(*solution.machine.gravity)
    arm = turn * (complex(*support.center_of_mass[:2]) - here.reference)
    change = here.change[0] + 1j * here.change[1]
    center = change + (1j * here.change[2] - here.rate[2] ** 2) * arm
    force = support.mass * gravity * np.ones_like(turn)
    moment = (np.conj(arm) * support.mass * gravity).imag
    for contact in solution.system.contacts:
        fx, fy, turning = contact.at.wrench(contact.force(here.place, here.rate), here.place)
        force, moment = force + fx + 1j * fy, moment + turning
    rows = solution.machine.rows or (Row(),)
    for row, one in zip(rows, solution.passes, strict=True):
        force = force + turn * one.frame_force
        moment = moment + one.frame_moment(here.reference - complex(*row.offset))
    reaction = turning_with_the_crank(solution)[0] * here.crank_acceleration
    wanted = support.inertia[0] * here.change[2] + reaction
    wanted = wanted + support.mass * (np.conj(arm) * center).imag
    size = np.max(np.abs(moment)) + np.max(np.abs(wanted)) + np.max(np.abs(reaction))
    np.testing.assert_allclose(moment, wanted, rtol=0, atol=1e-9 * size)
    if support.pivot is None:
        close(force, support.mass * center, 1e-9)


@cases
def test_torques_of_the_rows_add_up(solved: dict[str, ExactSolution], case: str) -> None:
    """Torque of drive or motor: of all cranks, and of what else turns with them."""
    solution = solved[case]
    here = solution.ride
    carried, own = turning_with_the_crank(solution)
    wanted = sum(one.drive_torque for one in solution.passes)
    wanted = wanted + carried * here.change[2] + own * here.crank_acceleration
    found = solution.system.drive_torque(solution.sums, solution.states)
    close(found, wanted, 1e-9)


@cases
def test_signals_are_those_of_the_motion(solved: dict[str, ExactSolution], case: str) -> None:
    """Velocity and acceleration of the gauges are derivatives of their displacement.

    Displacements are good to some 1e-11; a derivative makes that larger by the highest order kept,
    some 100, each time.  A load that sets in at once leaves a kink in the velocity: its orders
    fall off with their cube, and 360 of them leave 2e-3.
    """
    response = solved[case].response()
    for gauge in response.gauges.values():
        slope = gauge.displacement.derivative() * response.speed
        tolerance = 2e-3 if case == "loads" else 1e-7
        theta = np.linspace(0, 6, 31)
        close(slope.values(theta), gauge.velocity.values(theta), tolerance)
        if case != "loads":
            twice = slope.derivative() * response.speed
            close(twice.values(theta), gauge.acceleration.values(theta), 1e-6)


def test_largest_joint_forces_are_told() -> None:
    """Of the first row, beside those on solid ground."""
    solution = solve_exact(rig(), SPEED, False)
    ground = eq.analyze(rig(), 720, speed=SPEED, acceleration=0.0).forces
    for name, joint in solution.response().joints.items():
        assert joint.on_ground == pytest.approx(float(np.max(ground.joints[name].size)))
        here = solution.passes[0].joints[name]
        assert joint.peak == pytest.approx(float(np.max(here.size)))
        assert 0.5 < joint.peak / joint.on_ground < 2
    assert not solution.response(brief=True).joints
