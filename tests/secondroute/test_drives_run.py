"""Runs of several drives: against free bodies with constraints, and the equations of motion against
the centres of mass of a motion.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline, CubicSpline

import equipoise as eq
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.steps import run as run_steps
from equipoise.mechanism.assembly.steps import u
from equipoise.mechanism.dynamics.loads import given_loads, spring_demands
from equipoise.mechanism.dynamics.reactions import demands_of
from equipoise.mechanism.dynamics.reduced import generalized_force
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.laws import AngleLaw, LengthLaw
from equipoise.mechanism.parts.machine import FurtherDrive, Row
from equipoise.mechanism.parts.motors import DcMotor, Motor
from equipoise.results.remarks import linkage_remarks
from equipoise.running.blocks import drives_verdict
from equipoise.running.drives_equation import DrivesEquation
from equipoise.running.friction import NEAR_REST
from support.machines import make
from support.pinned_bodies import PinnedBodies, in_rows
from support.poses import Array, pins

CLOSE = 3e-8
"""rad: free bodies drift off their pins, as nothing holds them there but second derivatives."""
BALANCE = 1e-9
"""Share of the largest energy, as the issue of this feature asks for."""
LAGGING = Motor(dc=DcMotor(24.0, 1.2, 0.08, 2e-3), ratio=12.0, inertia=3e-5, mean_speed="free")
QUICK = Motor(dc=DcMotor(24.0, 1.5, 0.06), ratio=10.0, inertia=2e-5, mean_speed="free")
SWING = AngleLaw(between=(0.3, 1.2))


def five_bar(drive: eq.Drive, other: FurtherDrive) -> eq.Machine:
    """A five-bar whose cranks can turn as they like."""
    crank = {"mass": 0.4, "inertia": 2e-4}
    arm = {"A": (0.0, 0.0), "B": (0.05, 0.0)}
    links = {
        "left crank": eq.Link(arm, center_of_mass=(0.02, 0.003), **crank),
        "left arm": eq.Link({"B": (0.0, 0.0), "C": (0.22, 0.0)}, 0.25, (0.11, 0.01), 1.1e-3),
        "right arm": eq.Link({"C": (0.0, 0.0), "D": (0.22, 0.0)}, 0.75, (0.04, 0.0), 3e-3),
        "right crank": eq.Link(
            {"D": (0.05, 0.0), "E": (0.0, 0.0)}, center_of_mass=(0.02, 0.0), **crank
        ),
    }
    return eq.Machine(
        "five-bar", drive, {"A": (0.0, 0.0), "E": (0.12, 0.0)}, links, assembly={"C": "left"},
        drives=(other,), gravity=(0.0, -9.81),
    )  # fmt: skip


def motor_torques(machine: eq.Machine, senses: Mapping[str, float]) -> Any:
    """Torques of direct-current motors on their links, with one more state for each current that
    lags; rotors belong to the links.
    """
    motors = {item.link: item.motor for item in machine.driven if item.motor is not None}
    lagging = [link for link, motor in motors.items() if motor.dc.inductance]

    def torques(_: float, moving: Any, currents: Array) -> Any:
        each, changes = {}, []
        for link, motor in motors.items():
            of, gear = motor.dc, senses[link] * motor.ratio
            left = of.voltage - of.torque_constant * gear * moving[link][1]
            if link in lagging:
                current = currents[lagging.index(link)]
                changes.append((left - of.resistance * current) / of.inductance)
            else:
                current = left / of.resistance
            each[link] = gear * of.torque_constant * current
        return each, np.array(changes)

    return torques, len(lagging)


def with_rotors(machine: eq.Machine) -> eq.Machine:
    """The machine with its rotors as inertia of links about their pivots' axes."""
    links = dict(machine.links)
    for item in machine.driven:
        if item.motor is not None:
            own = links[item.link]
            added = item.motor.ratio**2 * item.motor.inertia
            links[item.link] = replace(own, inertia=own.inertia + added)
    return replace(machine, links=links)


def against_free_bodies(
    machine: eq.Machine,
    duration: float,
    given: Mapping[str, Any],
    strokes: Sequence[Any] = (),
    **start: Any,
) -> Any:
    """Compare all cranks' angles over time; return the run."""
    run = eq.run(machine, duration, **start)
    assert run.energy_error < BALANCE
    speeds = {link: course.speed[0] for link, course in run.drives.items()}
    torques, more = motor_torques(machine, {item.link: 1.0 for item in machine.driven})
    whole, shafts = in_rows(machine) if machine.rows else (machine, [])
    bodies = PinnedBodies(with_rotors(whole), given, torques)
    bodies.shafts = shafts
    bodies.rubbing = friction_in_pins(machine, whole)
    angles = angles_of_rows(machine, run)
    speeds |= {other: speeds[link] for link, other in shafts}
    bodies.strokes = strokes
    bodies.slow = NEAR_REST * abs(machine.drive.speed)
    state = np.concatenate([bodies.start(angles, speeds), np.zeros(more)])
    times = np.linspace(0.0, run.time[-1], 40)
    wanted = bodies.follow(state, times)
    time, places = np.unique(run.time, return_index=True)
    for link, course in run.drives.items():
        spline = CubicHermiteSpline(time, course.angle[places], course.speed[places])
        gone = wanted[link] - wanted[link][0]
        # the spline between instants of a step is off by less than the tolerance
        np.testing.assert_allclose(spline(times) - course.angle[0], gone, atol=CLOSE)
    return run


def friction_in_pins(machine: eq.Machine, whole: eq.Machine) -> dict[str, float]:
    """Coefficient times radius, m, of each pin of all rows."""
    each = {
        entry.joint.partition(".")[2]: (entry.friction or 0.0) * (entry.radius or 0.0)
        for entry in machine.joints
    }
    return {pin: each.get(pin.removesuffix(" 2"), 0.0) for pin in pins(whole)}


def angles_of_rows(machine: eq.Machine, run: Any) -> dict[str, float]:
    """Angles of the links of all rows at the start of a run, as of `in_rows`, in each of which
    drives of constant ratios are ahead by its phase.
    """
    linkage, angles = assemble(machine), {}
    for number, row in enumerate(machine.rows or (Row(),), 1):
        first = [
            run.drives[drive.link].angle[0] + row.phase * getattr(drive, "ratio", 1.0)
            for drive in machine.driven
        ]
        motion = at_angles(linkage, first, np.zeros((1, len(first))))
        for link in machine.links:
            angle = float(np.angle(np.ravel(motion.state[u(link)[0]])[0]))
            angles[link if number == 1 else f"{link} {number}"] = angle
    return angles


ROWS = (Row(), Row(phase=1.9, offset=(0.3, -0.05)))


def two_motors(**changes: Any) -> eq.Machine:
    drive = eq.Drive("left crank", 15.0, motor=LAGGING)
    other = FurtherDrive("right crank", start=pi / 3, motor=QUICK)
    return replace(five_bar(drive, other), **changes)


def test_two_motors_turn_two_rows() -> None:
    run = against_free_bodies(two_motors(rows=ROWS), 0.04, {})
    alone = eq.run(two_motors(), 0.04)
    shares = [run.drives[link].turns / course.turns for link, course in alone.drives.items()]
    assert max(abs(share - 1) for share in shares) > 0.05


def test_two_motors_turn_a_five_bar() -> None:
    drive = eq.Drive("left crank", 15.0, motor=LAGGING)
    other = FurtherDrive("right crank", start=pi / 3, motor=QUICK)
    result = against_free_bodies(five_bar(drive, other), 0.3, {})
    assert all(abs(course.turns) > 0.5 for course in result.drives.values())


def table_on_two_cranks(drive: eq.Drive, other: FurtherDrive) -> eq.Machine:
    """The bundled table on three links, of which one stands on a crank of its own."""
    base = eq.load("class-three")
    frame = dict(base.frame)
    pivot = frame.pop("E")
    second = eq.Link({"F": (0.0, 0.0), "E": (0.012, 0.0)}, 0.15, (0.004, 0.001), 4e-5)
    return replace(
        base, drive=drive, frame={**frame, "F": (pivot[0] - 0.012, pivot[1])},
        links={**base.links, "second crank": second}, drives=(other,), support=None, balance=None,
    )  # fmt: skip


@pytest.mark.exhaustive
def test_a_table_on_two_cranks_whose_links_are_solved_at_once() -> None:
    drive = eq.Drive("crank", 15.0, free=True)
    other = FurtherDrive("second crank", motor=QUICK)
    result = against_free_bodies(table_on_two_cranks(drive, other), 0.25, {})
    assert result.drives["second crank"].turns > 0.5


JOINTS = tuple(
    JointProperties(f"joints.{pin}", radius=0.01, friction=friction)
    for pin, friction in (("A", 0.1), ("B", 0.15), ("C", 0.2), ("D", 0.1), ("E", 0.05))
)


# Two motors, and friction in the pins of a machine of two drives: the tests above and below.
@pytest.mark.exhaustive
def test_two_motors_turn_a_five_bar_with_friction_in_its_pins() -> None:
    drive = eq.Drive("left crank", 15.0, motor=LAGGING)
    other = FurtherDrive("right crank", start=pi / 3, motor=QUICK)
    machine = replace(five_bar(drive, other), joints=JOINTS)
    result = against_free_bodies(machine, 0.07, {})
    without = eq.run(replace(machine, joints=()), 0.07)
    slower = result.drives["left crank"].turns / without.drives["left crank"].turns
    assert 0.3 < slower < 0.9999
    total = np.sum([*result.losses.values()], axis=0)
    np.testing.assert_allclose(result.work["friction"], -total, atol=1e-12 * total[-1])
    assert min(lost[-1] for lost in result.losses.values()) > 0.001 * total[-1]


# As `test_two_motors_turn_a_five_bar`.
@pytest.mark.exhaustive
def test_the_bundled_mixer_starts_by_two_motors() -> None:
    machine = eq.load("two-motor-mixer")
    result = against_free_bodies(machine, 0.06, {})
    assert {*result.losses} == {"A", "B", "C", "D", "E"}
    assert all(course.turns > 0.05 for course in result.drives.values())


@pytest.mark.exhaustive
def test_a_five_bar_swings_with_friction() -> None:
    """Joints turn back at instants of their own."""
    drive = eq.Drive("left crank", 5.0, free=True)
    other = FurtherDrive("right crank", ratio=0.0, start=0.3, free=True)
    machine = replace(five_bar(drive, other), joints=JOINTS)
    result = against_free_bodies(machine, 0.2, {})
    assert {event.of for event in result.events if event.kind == "reversal"} >= {"left crank"}
    lost = result.kinetic_energy - result.work["weight"] - result.work["friction"]
    np.testing.assert_allclose(lost, lost[0], atol=1e-9 * np.max(np.abs(lost)))


def test_a_five_bar_moves_freely() -> None:
    drive = eq.Drive("left crank", 15.0, free=True)
    other = FurtherDrive("right crank", start=pi / 3, free=True)
    result = against_free_bodies(five_bar(drive, other), 0.5, {}, speed=12.0)
    total = result.kinetic_energy - result.work["weight"]
    np.testing.assert_allclose(total, total[0], rtol=BALANCE)
    assert not np.any(result.drives["left crank"].effort)


@pytest.mark.exhaustive
def test_a_motor_beside_a_crank_of_constant_speed() -> None:
    drive = eq.Drive("left crank", 15.0)
    other = FurtherDrive("right crank", start=pi / 3, motor=LAGGING)
    law = {"left crank": lambda time: (15.0 * time, 15.0, 0.0)}
    result = against_free_bodies(five_bar(drive, other), 0.3, law)
    np.testing.assert_allclose(result.drives["left crank"].speed, 15.0)


def test_a_free_crank_beside_one_that_swings() -> None:
    drive = eq.Drive("left crank", 15.0, free=True, motion=AngleLaw(between=(0.0, 2.0)))
    other = FurtherDrive("right crank", motion=SWING)

    def law(time: float) -> tuple[float, float, float]:
        low, high = 0.3, 1.2
        half, turned = (high - low) / 2, 15.0 * time
        return (
            low + half * (1 - np.cos(turned)), half * 15.0 * np.sin(turned),
            half * 15.0**2 * np.cos(turned),
        )  # fmt: skip

    result = against_free_bodies(five_bar(drive, other), 0.3, {"right crank": law})
    assert result.drives["right crank"].moved_by == "given motion"


def test_a_drive_that_follows_the_crank_feels_its_own_torque_alone() -> None:
    """Its torque changes nothing of the crank: both cranks on their own, but for their arms."""
    drive = eq.Drive("left crank", 15.0, motor=QUICK)
    machine = five_bar(drive, FurtherDrive("right crank", ratio=-1.0, start=pi / 3))
    run = eq.run(machine, 0.2)
    left, right = run.drives.values()
    np.testing.assert_allclose(right.angle, pi / 3 - left.angle, atol=1e-12)
    assert run.energy_error < BALANCE


# -- strokes ---------------------------------------------------------------------------------------

LENGTHS = (0.1, 0.12)


def pushed_five_bar(
    drive: eq.Drive, lengths: tuple[float, float] = LENGTHS, start: float = 2.0
) -> eq.Machine:
    """The five-bar with a cylinder between both of its cranks."""
    machine = five_bar(drive, FurtherDrive("right crank", start=2.0))
    crank = machine.links["left crank"]
    crank = replace(crank, points={**crank.points, "P": (0.01, 0.002)})
    stroke = LengthLaw(between=lengths)
    other = FurtherDrive("right crank", start=start, between=("P", "D"), stroke=stroke)
    return replace(machine, links={**machine.links, "left crank": crank}, drives=(other,))


def stroke_by_time(time: float) -> tuple[float, float, float]:
    """To and fro in a turn of a crank at 15 rad/s."""
    middle, half, turned = np.mean(LENGTHS), (LENGTHS[1] - LENGTHS[0]) / 2, 15.0 * time
    cos, sin = half * np.cos(turned), half * np.sin(turned)
    return middle - cos, 15.0 * sin, 15.0**2 * cos


def test_a_cylinder_between_the_cranks_of_a_five_bar() -> None:
    """The first drive is free beside a cycle that goes on evenly."""
    drive = eq.Drive("left crank", 15.0, free=True, motion=AngleLaw(between=(0.0, 0.5)))
    machine, pushing = pushed_five_bar(drive), (("left crank", "P"), ("right crank", "D"))
    result = against_free_bodies(machine, 0.08, {}, [(*pushing, stroke_by_time)])
    course = result.drives["right crank"]
    wanted = [stroke_by_time(time)[0] for time in result.time]
    np.testing.assert_allclose(course.length, wanted, atol=1e-12)
    bodies = PinnedBodies(machine, {}, motor_torques(machine, {})[0])
    bodies.strokes = [(*pushing, stroke_by_time)]
    motion = result.motion_at(np.array([0]))
    angles = {link: float(np.angle(motion.state[u(link)[0]][0])) for link in machine.links}
    speeds = {link: item.speed[0] for link, item in result.drives.items()}
    multiplier = bodies.multipliers(0.0, bodies.start(angles, speeds))[-1]
    # of half a squared length, and on the side of the accelerations
    np.testing.assert_allclose(course.effort[0], -multiplier * course.length[0], rtol=1e-8)


def test_a_cylinder_turns_a_crank_as_a_given_motion_does() -> None:
    """Its force has the moment that the motion takes, and does its work."""
    drive = eq.Drive("left crank", 15.0, motor=LAGGING)
    machine = five_bar(drive, FurtherDrive("right crank", start=1.0))
    stroke = LengthLaw(between=(0.065, 0.095))
    pushed = FurtherDrive("right crank", start=1.0, between=("G", "D"), stroke=stroke)
    machine = replace(
        machine, frame={**machine.frame, "G": (0.2, 0.02)}, drives=(pushed,), joints=JOINTS
    )
    assert not any("points.G" in str(note) for note in linkage_remarks(assemble(machine)))
    run = eq.run(machine, 0.05)
    assert run.energy_error < BALANCE
    course, crank = run.drives["right crank"], run.crank_angle
    np.testing.assert_allclose(course.length, stroke.value(crank)[0], atol=1e-12)
    turn = machine.moved(crank)["right crank"]
    np.testing.assert_allclose(course.angle, turn[0], atol=1e-11)
    work = run.work["drives.right crank"]
    time, places = np.unique(run.time, return_index=True)
    power = course.effort * stroke.value(crank)[1] * run.drives["left crank"].speed
    done = CubicSpline(time, power[places]).antiderivative()(time)
    np.testing.assert_allclose(done - done[0], work[places], atol=1e-4 * np.max(np.abs(work)))
    # without friction, which the force adds to, a torque on the crank does the same
    free = replace(machine, joints=())
    at = np.arange(360) * pi / 180
    angles = AngleLaw(crank_angles=tuple(at), values=tuple(free.moved(at)["right crank"][0]))
    turned = replace(free, drives=(FurtherDrive("right crank", motion=angles),))
    pairs = [eq.run(each, 0.05).drives["left crank"] for each in (free, turned)]
    np.testing.assert_allclose(pairs[0].turns, pairs[1].turns, rtol=1e-5)
    assert np.max(np.abs(course.effort)) > 1.0


def test_a_run_ends_where_a_stroke_has_no_lever() -> None:
    """The cylinder and the crank that it turns are then in one line."""
    drive = eq.Drive("left crank", 15.0, free=True, motion=AngleLaw(between=(0.0, 0.2)))
    run = eq.run(pushed_five_bar(drive, (0.064, 0.068), 2.9), 1.0)
    assert (run.end.kind, run.end.of) == ("lever", "right crank")
    motion = run.motion_at(np.array([len(run.time) - 1]))
    end, pushed, pivot = (motion.point(name).place[0] for name in "PDE")
    across = np.imag((pushed - end) * np.conj(pushed - pivot))
    assert abs(across) < 2e-3 * abs(pushed - end) * abs(pushed - pivot)
    assert run.energy_error < 1e-7
    assert "right crank" in drives_verdict(run)


# -- the equations of motion -----------------------------------------------------------------------


def at_angles(linkage: Any, angles: Any, rates: Array) -> Motion:
    """A motion whose drives stand at angles, with rates (R, N) in each of its R places."""
    count = len(rates)
    state = linkage.start(np.zeros(count))
    for k, item in enumerate(linkage.machine.driven):
        values = (np.exp(1j * angles[k]) * np.ones(count), rates[:, k], np.zeros(count))
        state.update(zip(u(item.link), values, strict=True))
        state[f"phi({item.link})"] = np.full(count, angles[k])
    run_steps(linkage.motion, state)
    return Motion(linkage, np.full(count, angles[0]), 1.0, 0.0, False, state)


def free(machine: eq.Machine) -> eq.Machine:
    """The machine with a crank that is free, as a run of several drives has it."""
    drive = replace(machine.drive, free=True, motor=None, acceleration=0.0)
    return replace(machine, drive=drive, support=None, rows=(), balance=None, run=None)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kind", ["crank_rocker", "slider_crank", "stephenson", "quick_return",
                                  "geared_five_bar", "five_bar_of_two_drives"])  # fmt: skip
def test_equations_of_motion_are_those_of_centres_of_mass(kind: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    if kind == "five_bar_of_two_drives":
        machine = five_bar(eq.Drive("left crank", 5.0, free=True),
                           FurtherDrive("right crank", start=1.0, free=True))  # fmt: skip
    else:
        machine = free(make(kind, seed).machine)
    equation, linkage = DrivesEquation(machine), assemble(machine)
    count = len(machine.driven)
    angles = np.array([np.ravel(item.turned(np.array([0.4]))[0]) for item in machine.driven])
    speeds = rng.uniform(-3, 3, (count, 1))
    where = equation.placed(np.zeros(1), angles, speeds)
    state = equation.at(np.zeros(1), 0.0, where, {})
    motion = at_angles(linkage, angles.ravel(), np.vstack([np.eye(count), speeds.T]))
    inertia, bias = by_centres(motion, count)
    scale = np.max(np.abs(inertia))
    np.testing.assert_allclose(state.inertia[:, :, 0], inertia, atol=1e-12 * scale)
    fastest = np.max(np.abs(speeds)) ** 2
    np.testing.assert_allclose(state.pose.bias[:, 0], bias, atol=1e-10 * scale * fastest)
    acting = dict(zip((item.key for item in equation.sources), state.forces[..., 0], strict=True))
    wanted = {
        "weight": weight_by_centres(motion)[:count],
        "springs": generalized_force(motion, spring_demands(motion, rated=False))[:count],
        "loads": generalized_force(motion, demands_of(motion, given_loads(motion)))[:count],
    }
    for key, force in wanted.items():
        size = max(float(np.max(np.abs(force))), 1e-9)
        np.testing.assert_allclose(acting.get(key, np.zeros(count)), force, atol=1e-11 * size)


def weight_by_centres(motion: Motion) -> Array:
    """Generalized force of the links' weight at their centres of mass."""
    gravity, links = np.array(motion.machine.gravity), motion.machine.links.items()
    ways = [(link.mass, motion.mass_centers[name].place_1) for name, link in links]
    return np.asarray(sum(m * (gravity[0] * way.real + gravity[1] * way.imag) for m, way in ways))


def by_centres(motion: Motion, count: int) -> tuple[Array, Array]:
    """Reduced inertia and what it demands at the last rates, from centres of mass."""
    inertia, bias = np.zeros((count, count)), np.zeros(count)
    for name, link in motion.machine.links.items():
        centre = motion.mass_centers[name]
        along = np.stack([centre.place_1.real[:count], centre.place_1.imag[:count]])
        w, a = (np.ravel(motion.state[key] * np.ones(count + 1)) for key in u(name)[1:])
        change = centre.place_2[count]
        inertia += link.mass * along.T @ along + link.inertia * np.outer(w[:count], w[:count])
        bias += link.mass * along.T @ np.array([change.real, change.imag])
        bias += link.inertia * w[:count] * a[count]
    return inertia, bias
