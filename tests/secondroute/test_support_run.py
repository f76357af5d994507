"""Runs on a support: against the exact model of one crank, free bodies, and conserved momentum."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import Rotation

import equipoise as eq
from equipoise.mechanism.assembly.steps import u
from equipoise.mechanism.parts.laws import AngleLaw
from equipoise.mechanism.parts.loads import Load
from equipoise.mechanism.parts.machine import FRAME, FurtherDrive
from equipoise.mechanism.parts.motors import Motor
from equipoise.mechanism.parts.support import AXES, FREEDOMS, Mount, Row, Support
from equipoise.running.drives_linkage import LinkageRows, pose_of
from equipoise.running.friction import NEAR_REST
from equipoise.running.run_results import DrivesRun
from equipoise.running.support_equation import SupportedEquation
from equipoise.vibration.body import SupportBody
from equipoise.vibration.excitation import WholeExcitation
from secondroute.test_drives_run import (
    JOINTS,
    ROWS,
    angles_of_rows,
    five_bar,
    friction_in_pins,
    motor_torques,
    pushed_five_bar,
    stroke_by_time,
    two_motors,
)
from support.pinned_bodies import PinnedBodies, in_rows
from support.poses import Array

PITCH = FREEDOMS.index("pitch")
CLOSE = 3e-8
"""rad and m: free bodies drift off their pins, as nothing holds them but second derivatives."""
BALANCE = 1e-9
CENTRE = (0.06, -0.05, 0.0)
FEET = {
    "left": Mount((-0.1, -0.1, 0.0), stiffness=2500.0, damping=9.0, preload=26.0),
    "right": Mount((0.2, -0.1, 0.0), stiffness=1800.0, damping=7.0, preload=22.0),
    "side": Mount((0.2, -0.1, 0.0), direction=0.0, stiffness=900.0, damping=4.0, preload=0.0),
    "turn": Mount(axis="pitch", torsional_stiffness=6.0, torsional_damping=0.02, preload=0.1),
}
SUPPORT = Support(2.5, CENTRE, inertia=(0.03,), mounts=FEET)


def sampled(run: DrivesRun, times: Array) -> dict[str, Array]:
    """Angles of the drives from the start, and where the support is, at times."""
    assert run.support is not None
    time, places = np.unique(run.time, return_index=True)

    def at(values: Array, rates: Array) -> Array:
        return np.asarray(CubicHermiteSpline(time, values[places], rates[places])(times))

    values = {
        link: at(course.angle, course.speed) - course.angle[0]
        for link, course in run.drives.items()
    }
    for row, name in ((0, "x"), (1, "y"), (PITCH, FRAME)):
        values[name] = at(run.support.place[row], run.support.rate[row])
    return values


# -- one crank and its motor, by the exact model ---------------------------------------------------


def rig(**changes: Any) -> eq.Machine:
    """The bundled rig, whose motor is as its curve, on a support that moves in all ways."""
    base = eq.load("balance-rig")
    assert base.support is not None and base.drive.motor is not None
    motor = replace(base.drive.motor, mean_speed="free")
    feet = {
        "left": Mount((-1.2, -0.3, 0.0), stiffness=4e3, damping=60.0),
        "right": Mount((0.3, -0.3, 0.0), stiffness=4e3, damping=60.0),
        "side": Mount((0.0, -0.3, 0.0), direction=0.0, stiffness=3e3, damping=40.0, preload=0.0),
    }
    support = replace(
        base.support, pivot=None, pivot_inertia=None, inertia=(4.0,), mounts=feet,
        freedoms=("surge", "heave", "pitch"),
    )  # fmt: skip
    drive = replace(base.drive, motor=motor, flywheel=0.002)
    return replace(base, drive=drive, support=replace(support, **changes))


def against_exact(machine: eq.Machine, duration: float, close: float) -> DrivesRun:
    """Compare a run of one crank and its support with the exact model from rest."""
    wanted = eq.simulate(machine, duration, drive=True, samples=60)
    run = eq.run(machine, duration, support=True)
    assert isinstance(run, DrivesRun)
    result = sampled(run, wanted.time)
    np.testing.assert_allclose(result["crank"], wanted.crank_angle, atol=close)
    place, _ = wanted.system.place_and_rate(wanted.states)
    for row, name in enumerate(("x", "y", FRAME)):
        np.testing.assert_allclose(result[name], place[row], atol=close)
    assert run.energy_error < BALANCE
    return run


def test_one_crank_and_its_motor_as_the_exact_model() -> None:
    run = against_exact(rig(), 0.4, 3e-9)
    assert run.support is not None and run.driven_back is None
    assert np.all(np.ptp(run.support.place[[0, 1, PITCH]], axis=1) > 1e-4)


def test_rows_on_a_support_as_the_exact_model() -> None:
    rows = (Row(phase=0.4), Row(phase=2.2, offset=(-0.3, 0.1)))
    machine = replace(rig(), rows=rows)
    run = against_exact(machine, 0.25, 3e-9)
    alone = eq.run(replace(machine, rows=()), 0.25, support=True)
    assert abs(run.turned / alone.turned - 1) > 0.01


def test_a_support_about_a_pivot_as_the_exact_model() -> None:
    base = eq.load("balance-rig")
    assert base.drive.motor is not None
    motor = replace(base.drive.motor, mean_speed="free")
    against_exact(replace(base, drive=replace(base.drive, motor=motor)), 0.4, 3e-9)


def test_loads_from_outside_push_the_support_as_in_the_exact_model() -> None:
    machine = rig()
    link = next(name for name in machine.links if name != "crank")
    point = next(iter(machine.links[link].points))
    loads = (Load(link, point, force=(6.0, -9.0)), Load(link, torque=0.3, reaction="frame"))
    against_exact(replace(machine, loads=loads), 0.4, 3e-9)


def test_mounts_let_go_and_touch_again() -> None:
    feet = {
        "left": Mount((-1.2, -0.3, 0.0), stiffness=9e3, damping=20.0, preload=1.0, one_sided=True),
        "right": Mount((0.3, -0.3, 0.0), stiffness=9e3, damping=20.0, preload=1.0, one_sided=True),
        "side": Mount((0.0, -0.3, 0.0), direction=0.0, stiffness=3e3, damping=40.0, preload=0.0),
        "weak": Mount((-0.4, -0.3, 0.0), stiffness=800.0, preload=-2.0),
    }
    machine = replace(rig(mounts=feet), gravity=(0.0, 0.0))
    run = against_exact(machine, 0.6, 3e-8)
    assert run.support is not None
    forces = run.support.mounts["right"]
    assert np.min(forces) == 0 and np.sum(np.diff(forces > 0) != 0) >= 4


# -- several drives, by free bodies ----------------------------------------------------------------


def against_free_bodies(
    machine: eq.Machine,
    duration: float,
    given: dict[str, Any] | None = None,
    strokes: Sequence[Any] = (),
    speed: float | None = None,
) -> DrivesRun:
    """Compare drives and support over time; return the run."""
    run = eq.run(machine, duration, support=True, speed=speed)
    assert isinstance(run, DrivesRun)
    assert run.energy_error < BALANCE
    torques, more = motor_torques(machine, {item.link: 1.0 for item in machine.driven})
    whole, shafts = in_rows(machine) if machine.rows else (machine, [])
    bodies = PinnedBodies(whole, given or {}, torques, on_support=True)
    bodies.shafts, bodies.strokes = shafts, strokes
    bodies.rubbing = friction_in_pins(machine, whole)
    bodies.slow = NEAR_REST * abs(machine.drive.speed)
    speeds = {link: course.speed[0] for link, course in run.drives.items()}
    speeds |= {other: speeds[link] for link, other in shafts}
    angles = angles_of_rows(machine, run)
    state = np.concatenate([bodies.start(angles, speeds), np.zeros(more)])
    times = np.linspace(0.0, run.time[-1], 40)
    wanted, actual = bodies.follow(state, times), sampled(run, times)
    for name, values in actual.items():
        np.testing.assert_allclose(values, wanted[name] - wanted[name][0], atol=CLOSE)
    return run


def test_two_motors_shake_their_support() -> None:
    run = against_free_bodies(two_motors(support=SUPPORT), 0.04)
    assert run.support is not None
    assert np.all(np.ptp(run.support.place[[0, 1, PITCH]], axis=1) > 1e-3)
    fixed = eq.run(two_motors(), 0.04)
    other = fixed.drives["left crank"].turns / run.drives["left crank"].turns
    assert abs(other - 1) > 1e-3  # the support acts back on the drives


# From rest joints come out of where their friction changes its sense, in ten times the time.
FROM_REST = pytest.mark.exhaustive(but=["running"])
STARTS = pytest.mark.parametrize(
    ("speed", "duration"), [(12.0, 5e-4), (None, 0.01)], ids=["running", "from-rest"]
)


@FROM_REST
@STARTS
def test_friction_in_pins_is_pressed_by_the_support_too(
    speed: float | None, duration: float
) -> None:
    machine = two_motors(joints=JOINTS, support=SUPPORT)
    run = against_free_bodies(machine, duration, speed=speed)
    fixed = eq.run(two_motors(joints=JOINTS), duration, speed=speed)
    assert abs(fixed.losses["A"][-1] / run.losses["A"][-1] - 1) > 1e-3


@FROM_REST
@STARTS
def test_two_rows_with_friction_shake_their_support(speed: float | None, duration: float) -> None:
    """Friction of a row is pressed by what that of the other does to the shafts and the support."""
    machine = two_motors(joints=JOINTS, support=SUPPORT, rows=ROWS)
    run = against_free_bodies(machine, duration, speed=speed)
    alone = eq.run(replace(machine, rows=()), duration, support=True, speed=speed)
    assert abs(run.losses["A"][-1] / alone.losses["A"][-1] - 1) > 1e-2


def test_a_cylinder_between_the_cranks_on_their_support() -> None:
    drive = eq.Drive("left crank", 15.0, free=True, motion=AngleLaw(between=(0.0, 0.5)))
    machine = replace(pushed_five_bar(drive), support=SUPPORT)
    stroke = ("left crank", "P"), ("right crank", "D"), stroke_by_time
    run = against_free_bodies(machine, 0.05, strokes=[stroke])
    wanted = [stroke_by_time(time)[0] for time in run.time]
    np.testing.assert_allclose(run.drives["right crank"].length, wanted, atol=1e-12)


# One-sided mounts: `test_mounts_let_go_and_touch_again`; free drives: those of an undamped support.
@pytest.mark.exhaustive
def test_free_drives_on_one_sided_mounts() -> None:
    feet = {
        **FEET,
        "left": replace(FEET["left"], one_sided=True, preload=16.0),
        "right": replace(FEET["right"], one_sided=True, preload=14.0),
    }
    drive = eq.Drive("left crank", 15.0, free=True)
    machine = five_bar(drive, FurtherDrive("right crank", start=pi / 3, free=True))
    machine = replace(machine, support=replace(SUPPORT, mounts=feet))
    run = against_free_bodies(machine, 0.4)
    assert run.support is not None
    assert np.min(run.support.mounts["left"]) == 0 < np.max(run.support.mounts["left"])


def test_drives_of_given_motion_on_their_support() -> None:
    """Nothing but the support follows from forces."""
    drive = eq.Drive("left crank", 15.0)
    other = FurtherDrive("right crank", motion=AngleLaw(between=(0.3, 1.2)))

    def swing(time: float) -> tuple[float, float, float]:
        half, turned = 0.45, 15.0 * time
        return (
            0.3 + half * (1 - np.cos(turned)), half * 15.0 * np.sin(turned),
            half * 15.0**2 * np.cos(turned),
        )  # fmt: skip

    machine = replace(five_bar(drive, other), support=SUPPORT)
    laws = {"left crank": lambda time: (15.0 * time, 15.0, 0.0), "right crank": swing}
    run = against_free_bodies(machine, 0.2, laws)
    assert {course.moved_by for course in run.drives.values()} == {"given motion"}


# -- what stays ------------------------------------------------------------------------------------


def momenta(run: DrivesRun, places: Array) -> tuple[Array, Array]:
    """Momentum (K,), complex, and moment of momentum (K,) about the origin of all bodies, by their
    centres of mass in space.
    """
    assert run.support is not None
    support, motion = run.machine.support, run.motion_at(places)
    assert support is not None
    x, y, tilt = run.support.place[[0, 1, PITCH]][:, places]
    vx, vy, turning = run.support.rate[[0, 1, PITCH]][:, places]
    moved, moving, turn = x + 1j * y, vx + 1j * vy, np.exp(1j * tilt)
    reference = complex(*support.reference[:2])

    def in_space(place: Array, rate: Array) -> tuple[Array, Array]:
        arm = turn * (place - reference)
        return reference + moved + arm, moving + 1j * turning * arm + turn * rate

    bodies = [
        (support.mass, support.inertia[0], *in_space(
            np.full(len(x), complex(*support.center_of_mass[:2])), np.zeros(len(x))), turning)
    ]  # fmt: skip
    for name, link in run.machine.links.items():
        centre = motion.mass_centers[name]
        rate = turning + motion.state[u(name)[1]]
        bodies.append((link.mass, link.inertia, *in_space(centre.place, centre.place_1), rate))
    linear = sum(mass * v for mass, _, _, v, _ in bodies)
    angular = sum(
        mass * (np.conj(place) * v).imag + inertia * rate
        for mass, inertia, place, v, rate in bodies
    )
    for item, course in zip(run.machine.driven, run.drives.values(), strict=True):
        if item.motor is not None:
            angular = angular + item.motor.ratio * item.motor.inertia * course.speed[places]
    return np.asarray(linear), np.asarray(angular)


@pytest.mark.parametrize("rubbing", [False, True])
def test_a_free_support_keeps_momentum(rubbing: bool) -> None:
    """Motors, friction and springs between links and support act within the machine."""
    loose = replace(SUPPORT, mounts={"film": Mount(axis="pitch", torsional_damping=1e-15)})
    joints = JOINTS if rubbing else ()
    machine = two_motors(support=loose, gravity=(0.0, 0.0), joints=joints)
    run = eq.run(machine, 0.02, support=True)
    assert isinstance(run, DrivesRun)
    places = np.linspace(0, len(run.time) - 1, 50).astype(int)
    linear, angular = momenta(run, places)
    largest = np.max(np.abs(run.drives["left crank"].speed)) * 0.25 * 0.05
    np.testing.assert_allclose(linear, 0, atol=1e-9 * largest)
    np.testing.assert_allclose(angular, 0, atol=1e-9 * largest * 0.1)
    assert np.ptp(run.support.place[PITCH]) > 1e-5  # which turns against the cranks


def test_an_undamped_support_keeps_energy() -> None:
    """Kinetic energy, weight and springs of mounts, from where bodies are."""
    feet = {name: replace(mount, damping=0.0, torsional_damping=0.0)
            for name, mount in FEET.items()}  # fmt: skip
    drive = eq.Drive("left crank", 15.0, free=True)
    machine = five_bar(drive, FurtherDrive("right crank", start=pi / 3, free=True))
    machine = replace(machine, support=replace(SUPPORT, mounts=feet))
    run = eq.run(machine, 0.3, support=True)
    assert isinstance(run, DrivesRun) and run.support is not None
    motion = run.motion_at(np.arange(len(run.time)))
    x, y, tilt = run.support.place[[0, 1, PITCH]]
    turn, reference = np.exp(1j * tilt), complex(*CENTRE[:2])
    heights = {
        name: (turn * (centre.place - reference)).imag + y
        for name, centre in motion.mass_centers.items()
    }
    stored = 9.81 * (2.5 * y + sum(link.mass * heights[n] for n, link in machine.links.items()))
    for mount in feet.values():
        moved = tilt
        if mount.axis is None:
            assert isinstance(mount.point, tuple) and isinstance(mount.direction, float)
            arm = complex(*mount.point[:2]) - reference
            way = x + 1j * y + turn * arm - arm
            moved = (way * np.exp(-1j * mount.direction)).real
        stored = stored + mount.spring * moved**2 / 2 - (mount.preload or 0.0) * moved
    total = run.kinetic_energy + stored
    np.testing.assert_allclose(total, total[0], atol=BALANCE * np.max(run.kinetic_energy))


def test_motor_as_curve_on_its_support_starts_and_is_switched_off() -> None:
    """A start, a switch-off and a coast-down keep the balance of energy."""
    line = Motor(40.0, 2.0, inertia=1e-4, mean_speed="free")
    drive = eq.Drive("left crank", 15.0, motor=line)
    machine = five_bar(drive, FurtherDrive("right crank", ratio=-1.0, start=pi / 3))
    run = eq.run(replace(machine, support=SUPPORT), 0.4, off=0.2, support=True)
    assert isinstance(run, DrivesRun)
    assert [event.kind for event in run.events][-2:] == ["off", "time"]
    assert run.energy_error < BALANCE
    late = run.time > 0.2
    assert not np.any(run.drives["left crank"].effort[late])


def test_a_motor_that_is_too_weak_swings_on_its_support() -> None:
    """It does not lift the links over, which the run knows, and where it turns back."""
    base = rig()
    weak = Motor(40.0, 0.2, inertia=1e-4, mean_speed="free")
    run = eq.run(replace(base, drive=replace(base.drive, motor=weak)), 0.8, support=True)
    assert isinstance(run, DrivesRun)
    course, (first, second) = run.drives["crank"], run.reversals("crank")
    speeds = np.interp([first.time, second.time], run.time, course.speed)
    np.testing.assert_allclose(speeds, 0.0, atol=1e-2 * np.max(np.abs(course.speed)))
    assert run.driven_back == "crank" and abs(course.turns) < 1


# -- in space --------------------------------------------------------------------------------------

IN_SPACE = Support(
    2.5, (0.06, -0.05, 0.03), inertia=(0.02, 0.03, 0.04), products=(0.002, -0.001, 0.003),
    freedoms=FREEDOMS,
)  # fmt: skip
APART = (Row(lateral=-0.05), Row(phase=1.9, offset=(0.3, -0.05), lateral=0.2))


class PointMasses(NamedTuple):
    """Bodies of a run at K instants, in space: links as four points each, which are as flat.

    mass : (B, 1).  place, velocity : (B, K, 3), m and m/s.  spin : moment of momentum of the
    support and of rotors about their own centres, (K, 3).
    """

    mass: Array
    place: Array
    velocity: Array
    spin: Array


def in_space(run: DrivesRun, places: Array) -> PointMasses:
    """All bodies, by rotation matrices and their differences."""
    machine, where = run.machine, run.where
    support, rows, count = machine.support, LinkageRows(machine), len(run.drives)
    assert support is not None and run.support is not None
    reference, step = np.array(support.center_of_mass), 1e-6
    place, rate = run.support.place[:, places].T, run.support.rate[:, places].T
    turn = Rotation.from_rotvec(place[:, 3:]).as_matrix()
    ends = [Rotation.from_rotvec(place[:, 3:] + s * rate[:, 3:]).as_matrix() for s in (step, -step)]
    turning = (ends[0] - ends[1]) / (2 * step)
    masses, points, rates = [support.mass], [reference + 0 * place[:, :3]], [0 * place[:, :3]]
    for number, row in enumerate(rows.all):
        own = number * len(run.time) + places
        near = {name: values[..., number, places] for name, values in run.references.items()}
        angles = (where.angles[:count, own], where.speeds[:count, own])
        motion = pose_of(run.equation.linkage, where.crank_angle[own], *angles, near).moving
        for name, link in machine.links.items():
            centre, (way, speed, _) = motion.mass_centers[name], (motion.state[k] for k in u(name))
            for corner in range(4):
                arm = 1j**corner * np.sqrt(link.inertia / link.mass) * way
                at, moving = centre.place + arm + complex(*row.offset), 1j * speed * arm
                moving = moving + centre.place_1
                across = row.lateral + link.plane + 0 * at.real
                masses.append(link.mass / 4)
                points.append(np.array([at.real, at.imag, across]).T)
                rates.append(np.array([moving.real, moving.imag, 0 * across]).T)
    arms = np.array(points) - reference
    tensor, (xy, yz, zx) = np.diag(support.inertia), support.products
    tensor = tensor - np.array([[0, xy, zx], [xy, 0, yz], [zx, yz, 0]])
    skew = np.einsum("kji,kjl->kil", turn, turning)
    spin = np.array([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]]).T @ tensor
    for drive, course in zip(machine.driven, run.drives.values(), strict=True):
        if drive.motor is not None:
            spin[:, 2] += drive.motor.ratio * drive.motor.inertia * course.speed[places]
    return PointMasses(
        np.array(masses)[:, None],
        reference + place[:, :3] + np.einsum("kij,bkj->bki", turn, arms),
        rate[:, :3] + np.einsum("kij,bkj->bki", turning, arms)
        + np.einsum("kij,bkj->bki", turn, np.array(rates)),
        np.einsum("kij,kj->ki", turn, spin),
    )  # fmt: skip


def test_a_free_support_keeps_momentum_in_space() -> None:
    """All six of them, with rows in different planes, rotors, and a support of any axes."""
    film = {"film": Mount(axis="pitch", torsional_damping=1e-15)}
    support = replace(IN_SPACE, mounts=film)
    run = eq.run(two_motors(support=support, gravity=(0.0, 0.0), rows=APART), 0.06, support=True)
    assert isinstance(run, DrivesRun) and run.support is not None
    assert run.energy_error < BALANCE
    bodies = in_space(run, np.linspace(0, len(run.time) - 1, 20).astype(int))
    linear = np.sum(bodies.mass[..., None] * bodies.velocity, axis=0)
    moments = bodies.mass[..., None] * np.cross(bodies.place, bodies.velocity)
    largest = np.max(np.linalg.norm(bodies.velocity, axis=2))
    # differences of rotations leave 1e-10
    np.testing.assert_allclose(linear, 0, atol=1e-9 * largest)
    np.testing.assert_allclose(np.sum(moments, axis=0) + bodies.spin, 0, atol=1e-9 * largest)
    assert np.all(np.ptp(run.support.place, axis=1) > 1e-3)


def test_an_undamped_support_keeps_energy_in_space() -> None:
    """Weight and springs of mounts, from where points are in space."""
    directions = ((1.0, 0.2, 0.1), (0.0, 1.0, 0.3), (0.1, 0.0, 1.0), (0.0, 1.0, 0.0))
    corners = ((-0.1, -0.1, 0.2), (0.2, -0.1, -0.2), (0.1, 0.15, 0.1), (0.0, -0.1, 0.3))
    feet = {
        f"foot {k}": Mount(corner, direction=along, stiffness=2e3 + 300 * k)
        for k, (corner, along) in enumerate(zip(corners, directions, strict=True))
    }
    feet |= {axis: Mount(axis=axis, torsional_stiffness=20.0) for axis in ("roll", "yaw", "pitch")}
    drive = eq.Drive("left crank", 15.0, free=True)
    machine = five_bar(drive, FurtherDrive("right crank", start=pi / 3, free=True))
    machine = replace(machine, support=replace(IN_SPACE, mounts=feet), rows=APART)
    run = eq.run(machine, 0.1, support=True)
    assert isinstance(run, DrivesRun) and run.support is not None
    bodies = in_space(run, np.arange(len(run.time)))
    stored = 9.81 * np.sum(bodies.mass * bodies.place[..., 1], axis=0)
    place, reference = run.support.place, np.array(IN_SPACE.center_of_mass)
    turn = Rotation.from_rotvec(place[3:].T).as_matrix()
    for contact in run.equation.mounted.contacts:
        given = feet[contact.name]
        moved = place[3 + AXES.index(given.axis)] if given.axis else None
        if moved is None:
            arm = np.array(given.point) - reference
            along = np.array(given.direction) / np.linalg.norm(given.direction)
            moved = (place[:3].T + turn @ arm - arm) @ along
        stored = stored + contact.stiffness * moved**2 / 2 - contact.preload * moved
    total = run.kinetic_energy + stored
    np.testing.assert_allclose(total, total[0], atol=BALANCE * np.max(run.kinetic_energy))
    assert run.energy_error < BALANCE
    assert np.all(np.ptp(place, axis=1) > 1e-4)


def test_what_links_exert_on_a_support_in_space_is_as_of_orders() -> None:
    """On a support that is where it is drawn, by crank angles; four rows in four planes."""
    machine = replace(eq.load("riding-transplanter"), gravity=(0.0, 0.0), planting=None, run=None)
    machine = replace(machine, balance=None, joints=(), drive=replace(machine.drive, motor=None))
    equation = SupportedEquation(machine)
    crank = np.linspace(0, 2 * pi, 12, endpoint=False)
    angles, speeds = np.zeros((2, 7, 12))
    angles[0], speeds[0] = crank, machine.drive.speed
    near = {
        name: np.concatenate([SupportedEquation(machine, angle).references_at_start()[name]
                              for angle in crank.tolist()], axis=-1)
        for name in equation.references_at_start()
    }  # fmt: skip
    state = equation.at(np.zeros(12), 0.0, equation.placed(np.zeros(12), angles, speeds), near)
    excitation = WholeExcitation(SupportBody(machine))
    wanted = excitation.samples(crank, machine.drive.speed)
    actual = -equation.rows.total(state.pose.bias)[1:]
    np.testing.assert_allclose(actual, wanted, atol=1e-9 * np.max(np.abs(wanted)))


# What links exert on a support at rest, and rigid bodies in space: the tests above.
@pytest.mark.exhaustive
def test_the_riding_transplanter_comes_to_its_linear_response() -> None:
    """In heave, roll and yaw, each with its main order, by a motor that keeps the speed to 3e-4."""
    machine = eq.load("riding-transplanter")
    speed, support = machine.drive.speed, machine.support
    assert support is not None
    yaw = replace(support.mounts["hitch_yaw"], torsional_damping=600.0)  # else it takes 60 turns
    machine = replace(
        machine, support=replace(support, mounts={**support.mounts, "hitch_yaw": yaw})
    )
    response = eq.respond(machine)
    motor = Motor(speed * 1.0005, 2e4, mean_speed="free")
    driven = replace(machine, drive=replace(machine.drive, motor=motor))
    run = eq.run(driven, turns=20, support=True, speed=speed)
    assert isinstance(run, DrivesRun) and run.support is not None
    assert run.energy_error < BALANCE
    crank, places = np.unique(run.crank_angle, return_index=True)
    grid = crank[-1] - np.linspace(0, 2 * pi, 64, endpoint=False)
    waves = np.exp(-1j * np.outer([1, 2, 3], grid)) / 32
    for name, gauge in response.gauges.items():
        actual = waves @ np.interp(grid, crank, run.support.gauges[name][places])
        wanted = gauge.displacement.amplitudes[1:4]
        # tilts of 6e-3 rad and changes of speed are not in the linear model
        np.testing.assert_allclose(actual, wanted, atol=2e-3 * np.max(np.abs(wanted)))
