"""The linkages on a support as one: their sums, and joint forces on a moving base."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import resample

import equipoise as eq
from equipoise.errors import MassError
from equipoise.mechanism.dynamics.reactions import JointReactions
from equipoise.mechanism.parts.machine import Load
from equipoise.mechanism.parts.motors import Motor
from equipoise.mechanism.parts.support import Row
from equipoise.vibration.exact import ExactSolution, solve_exact
from equipoise.vibration.linkages import (
    BaseMotion,
    ReducedInertia,
    joint_forces,
    rows_of,
    spread,
    sums,
)
from support.machines import make
from unit.vibration.build import SPEED, Array, close, rig, springs

REFERENCE = 0.7 - 0.4j
KINDS = ("crank_rocker", "slider_crank", "stephenson", "quick_return", "geared_coupler")
ROWS = [Row(), Row(phase=2.1, offset=(0.3, -0.2)), Row(phase=-1.0, lateral=0.4)]


def machine_of(name: str) -> eq.Machine:
    machine = make(name, 1).machine if name in KINDS else eq.load(name)
    return replace(machine, loads=())


machines = pytest.mark.parametrize("name", [*KINDS, "yamashita-1", "watt-six-bar", "scotch-yoke"])


class Bodies:
    """Places, velocities and turning of all links on a support that moves anyhow: Z, Z., phi, phi.
    and theta. are drawn for each instant."""

    def __init__(self, machine: eq.Machine, theta: Array, seed: int = 0) -> None:
        rng = np.random.default_rng(seed)
        count = len(theta)
        z, dz = rng.normal(size=(2, count)) + 1j * rng.normal(size=(2, count))
        phi, dphi, dtheta = rng.normal(size=(3, count))
        self.dz, self.phi, self.dphi, self.dtheta = dz, phi, dphi, dtheta
        turn = np.exp(1j * phi)
        self.mass, self.inertia, self.place, self.velocity, self.spin = [], [], [], [], []
        for row in rows_of(machine):
            motion = eq.move(machine, theta + row.phase, speed=1.0, acceleration=0.0)
            for name, link in machine.links.items():
                center = motion.mass_centers[name]
                arm = center.place + complex(*row.offset) - REFERENCE
                self.mass.append(link.mass)
                self.inertia.append(link.inertia)
                self.place.append(z + turn * arm)
                rate = 1j * dphi * turn * arm + turn * center.velocity * dtheta
                self.velocity.append(dz + rate)
                self.spin.append(dphi + motion.links[name].angular_velocity * dtheta)
        self.z = z


THETA = np.linspace(0.1, 6.2, 9)


def at(machine: eq.Machine, theta: Array = THETA) -> ReducedInertia:
    return sums(machine, theta, REFERENCE, 10.0)


@machines
@pytest.mark.parametrize("rows", [(), ROWS], ids=["one", "three"])
def test_energy_and_momentum(name: str, rows: list[Row]) -> None:
    """Kinetic energy, momentum and moment of momentum about the reference point, body by body."""
    machine = machine_of(name).with_rows(rows)
    actual, b = at(machine), Bodies(machine, THETA)
    s, s1 = (np.exp(1j * b.phi) * part for part in (actual.first, actual.first_1))
    assert actual.mass == pytest.approx(sum(b.mass))
    momentum = actual.mass * b.dz + 1j * b.dphi * s + b.dtheta * s1
    close(momentum, sum(m * v for m, v in zip(b.mass, b.velocity, strict=True)), 1e-13)
    moment = (np.conj(s) * b.dz).imag + actual.inertia * b.dphi + actual.spin * b.dtheta
    wanted = sum(
        m * (np.conj(p - b.z) * v).imag + i * w
        for m, i, p, v, w in zip(b.mass, b.inertia, b.place, b.velocity, b.spin, strict=True)
    )
    close(moment, wanted, 1e-13)
    energy = (
        actual.mass * np.abs(b.dz) ** 2
        + actual.inertia * b.dphi**2
        + actual.drive * b.dtheta**2
        + 2 * (np.conj(b.dz) * (1j * b.dphi * s + b.dtheta * s1)).real
        + 2 * actual.spin * b.dphi * b.dtheta
    ) / 2
    wanted = sum(
        m * np.abs(v) ** 2 / 2 + i * w**2 / 2
        for m, i, v, w in zip(b.mass, b.inertia, b.velocity, b.spin, strict=True)
    )
    close(energy, wanted, 1e-13)


@machines
def test_derivatives_against_differences(name: str) -> None:
    """Central differences of fourth order over h = 2e-3 miss by some h^4 = 2e-11 of the higher
    derivatives, which are up to 1e3 times as large."""
    machine = machine_of(name).with_rows(ROWS[:2])
    h = 2e-3
    steps = {k: at(machine, THETA + k * h) for k in (-2, -1, 1, 2)}
    values = at(machine)
    for value, slope in (
        ("first", "first_1"),
        ("first_1", "first_2"),
        ("inertia", "inertia_1"),
        ("spin", "spin_1"),
        ("drive", "drive_1"),
    ):
        y = {k: getattr(step, value) for k, step in steps.items()}
        wanted = (8 * (y[1] - y[-1]) - (y[2] - y[-2])) / (12 * h)
        size = np.max(np.abs(wanted)) + np.max(np.abs(y[1]))
        np.testing.assert_allclose(getattr(values, slope), wanted, rtol=0, atol=1e-7 * size)


def test_what_turns_with_the_crank() -> None:
    """Energy of a flywheel I (phi. + theta.)^2 / 2 and a rotor I (phi. + n theta.)^2 / 2, less what
    turns with the support alone, which is the support's."""
    machine = rig()
    motor = Motor(300.0, 2.0, ratio=6.0, inertia=0.01)
    plain, geared = at(machine), at(machine.with_drive(flywheel=0.3, motor=motor))
    np.testing.assert_allclose(geared.spin - plain.spin, 0.3 + 6 * 0.01)
    np.testing.assert_allclose(geared.drive - plain.drive, 0.3 + 36 * 0.01)
    np.testing.assert_allclose(geared.inertia, plain.inertia)
    np.testing.assert_array_equal(geared.drive_1, plain.drive_1)


def test_a_flywheel_is_there_once_however_many_rows() -> None:
    machine = rig().with_drive(flywheel=0.3)
    first = at(machine).drive - 0.3
    two = at(machine.with_rows([Row(), Row()])).drive - 0.3
    np.testing.assert_allclose(two, 2 * first)


def test_rows_without_any_are_the_one_of_the_file() -> None:
    assert rows_of(rig()) == (Row(),)
    assert rows_of(rig().with_rows(ROWS)) == tuple(ROWS)


# -- loads -----------------------------------------------------------------------------------------


def test_work_of_loads() -> None:
    """Force at a tip, and torque on a link: power on a moving support, in the support's axes."""
    machine = eq.load("yamashita-1")
    force, torque = 3 - 7j, 0.4
    machine = replace(machine, loads=(
        Load("coupler", "P", (force.real, force.imag)), Load("rocker", torque=torque),
    ))  # fmt: skip
    rows = ROWS[:2]
    values = at(machine.with_rows(rows))
    rng = np.random.default_rng(3)
    dz = rng.normal(size=9) + 1j * rng.normal(size=9)
    phi, dphi, dtheta = rng.normal(size=(3, 9))
    power = np.zeros(9)
    turn = np.exp(1j * phi)
    for row in rows:
        motion = eq.move(machine, THETA + row.phase, speed=1.0)
        tip = motion.points["P"]
        arm = tip.place + complex(*row.offset) - REFERENCE
        velocity = dz + turn * (1j * dphi * arm + tip.velocity * dtheta)
        power += (np.conj(turn * force) * velocity).real
        power += torque * (dphi + motion.links["rocker"].angular_velocity * dtheta)
    whole = turn * values.load_force
    carried = (np.conj(whole) * dz).real + values.load_moment * dphi + values.load_torque * dtheta
    close(carried, power, 1e-13)


def test_springs_turn_the_crank_alone() -> None:
    """In every row by minus the slope of their energy, whatever carries the rows."""
    machine = eq.load("spring-balanced-crank")
    (spring,) = machine.springs
    values = at(machine.with_rows(ROWS[:2]))
    assert not np.any(values.load_force)
    assert not np.any(values.load_moment)
    wanted, step = np.zeros(9), 1e-5
    for row in ROWS[:2]:
        theta = THETA + row.phase
        places = [eq.move(machine, theta + h).points[spring.point].place for h in (step, -step)]
        lengths = [np.abs(place - complex(*machine.frame[spring.to])) for place in places]
        up, down = (spring.stiffness * (x - spring.free_length) ** 2 / 2 for x in lengths)
        wanted -= (up - down) / (2 * step)
    close(values.load_torque, wanted, 1e-8)


def test_no_loads() -> None:
    values = at(eq.load("yamashita-1"))
    for part in (values.load_force, values.load_moment, values.load_torque):
        assert not np.any(part)


# -- in the mean -----------------------------------------------------------------------------------


@machines
def test_spread_in_the_plane_is_the_mean_of_the_sums(name: str) -> None:
    """About the frame's origin: mass, first moment and moment of inertia."""
    machine = machine_of(name)
    motion = eq.move(machine, 360)
    actual, mean = spread(motion), sums(machine, motion.crank_angle, 0j, 1.0)
    first = np.mean(mean.first)
    wanted = [
        [mean.mass, 0, -first.imag],
        [0, mean.mass, first.real],
        [-first.imag, first.real, np.mean(mean.inertia)],
    ]
    np.testing.assert_allclose(actual[np.ix_((0, 1, 5), (0, 1, 5))], wanted, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(actual, actual.T)


def test_spread_in_space_is_the_mean_energy() -> None:
    """Flat links of points in their plane: v + w x r of each, in the mean over a turn."""
    machine = eq.load("yamashita-1")
    for name in machine.links:
        machine = machine.with_link(name, inertia=0.0)
    motion = eq.move(machine, 90)
    rate = np.random.default_rng(0).normal(size=6)
    energy = 0.0
    for name, link in machine.links.items():
        center = motion.mass_centers[name].place
        places = np.stack([center.real, center.imag, 0 * center.real], axis=-1)
        velocity = rate[:3] + np.cross(rate[3:], places)
        energy += (link.mass or 0.0) * float(np.mean(np.sum(velocity**2, axis=1))) / 2
    assert rate @ spread(motion) @ rate / 2 == pytest.approx(energy)


def test_a_flat_link_has_half_its_inertia_about_an_axis_in_its_plane() -> None:
    plain, heavy = eq.load("yamashita-1"), eq.load("yamashita-1")
    heavy = heavy.with_link("rocker", inertia=(plain.links["rocker"].inertia or 0) + 0.4)
    more = spread(eq.move(heavy, 90)) - spread(eq.move(plain, 90))
    np.testing.assert_allclose(more, np.diag([0, 0, 0, 0.2, 0.2, 0.4]), atol=1e-12)


def test_missing_masses() -> None:
    machine = replace(
        eq.load("yamashita-1"),
        links={n: eq.Link(dict(k.points)) for n, k in eq.load("yamashita-1").links.items()},
    )
    with pytest.raises(MassError):
        at(machine)


CARRIED_THETA = np.linspace(0.05, 6.2, 24)
STILL = np.zeros((3, 24))
EXAMPLES = ("yamashita-1", "slider-crank-engine", "watt-six-bar", "geared-counterweight")
RANDOM = ("quick_return", "stephenson", "geared_coupler")
carried_machines = pytest.mark.parametrize("name", [*EXAMPLES, *RANDOM])


def carried_machine(name: str) -> eq.Machine:
    return make(name, 2).machine if name in RANDOM else eq.load(name)


def ride(
    rate: Array = STILL, change: Array = STILL, place: Array = STILL, spin_up: float = 0.0
) -> BaseMotion:
    """Ride at 20 rad/s of the crank."""
    first = np.ones(24)
    return BaseMotion(place, rate, change, CARRIED_THETA, 20 * first, spin_up * first, 0.3 - 0.2j)


def same(result: JointReactions, wanted: JointReactions | eq.mechanism.Forces) -> None:
    """Compare all joint forces and the torque to 1e-12 of the largest force and torque."""
    size = max(float(np.max(joint.size)) for joint in wanted.joints.values())
    for name, joint in wanted.joints.items():
        np.testing.assert_allclose(result.joints[name].value, joint.value, atol=1e-12 * size)
    for name, gear in wanted.gears.items():
        np.testing.assert_allclose(result.contacts[name].value, gear.value, atol=1e-12 * size)
    close(result.drive_torque, wanted.drive_torque, 1e-11)


@carried_machines
@pytest.mark.parametrize("spin_up", [0.0, 35.0])
def test_on_a_support_that_stands_still(name: str, spin_up: float) -> None:
    machine = carried_machine(name)
    wanted = eq.analyze(machine, CARRIED_THETA, speed=20.0, acceleration=spin_up).forces
    same(joint_forces(machine, ride(spin_up=spin_up), 0.0, 0j), wanted)


@carried_machines
def test_on_a_support_that_only_moves_along(name: str) -> None:
    """A steady velocity is not felt; an acceleration is felt as weight against it."""
    machine = carried_machine(name)
    velocity, change = STILL.copy(), STILL.copy()
    velocity[:2], change[:2] = [[3.0], [-2.0]], [[4.0], [2.5]]
    forces = joint_forces(machine, ride(velocity, change), 0.0, 0j)
    gx, gy = machine.gravity
    heavier = replace(machine, gravity=(gx - 4.0, gy - 2.5))
    same(forces, eq.analyze(heavier, CARRIED_THETA, speed=20.0, acceleration=0.0).forces)


@carried_machines
def test_on_a_support_that_leans(name: str) -> None:
    """In its own axes gravity leans the other way."""
    machine = carried_machine(name)
    place = STILL.copy()
    place[2] = 0.7
    down = complex(*machine.gravity) * np.exp(-0.7j)
    leaning = replace(machine, gravity=(down.real, down.imag))
    wanted = eq.analyze(leaning, CARRIED_THETA, speed=20.0, acceleration=0.0).forces
    same(joint_forces(machine, ride(place=place), 0.0, 0j), wanted)


def test_of_a_row_that_is_ahead() -> None:
    machine = eq.load("yamashita-1")
    wanted = eq.analyze(machine, CARRIED_THETA + 1.3, speed=20.0, acceleration=0.0).forces
    same(joint_forces(machine, ride(), 1.3, 0.4 + 0.1j), wanted)


def test_a_crank_that_stands_still_in_space_is_not_spun_up() -> None:
    """Its support turns under it about the crank's own pivot: no inertia of the crank is felt."""
    machine = replace(rig(), gravity=(0.0, 0.0))
    turning, spin_up = STILL.copy(), STILL.copy()
    turning[2], spin_up[2] = -20.0, -7.0
    for link in ("coupler", "rocker"):
        machine = machine.with_link(link, mass=0.0, inertia=0.0)
    ahead = replace(ride(turning, spin_up, spin_up=7.0), reference=0j)
    forces = joint_forces(machine, ahead, 0.0, 0j)
    plain = joint_forces(machine, replace(ride(), reference=0j), 0.0, 0j)
    assert np.max(forces.joints["A"].size) < 1e-12 * np.max(plain.joints["A"].size)
    assert np.max(np.abs(forces.drive_torque)) < 1e-12


@carried_machines
@pytest.mark.parametrize("seed", [0, 1])
def test_whole_force_is_the_change_of_momentum(name: str, seed: int) -> None:
    """On any motion: force and moment of all joints on the frame, by the sums over the links."""
    machine = replace(carried_machine(name), loads=(), springs=())
    rng = np.random.default_rng(seed)
    place, rate, change = rng.normal(size=(3, 3, 24))
    here = replace(ride(rate, change, place, 11.0), crank_speed=rng.normal(size=24))
    forces = joint_forces(machine, here, 0.4, 0.2 - 0.5j)
    row = machine.with_rows([Row(phase=0.4, offset=(0.2, -0.5))])
    s = sums(row, CARRIED_THETA, here.reference, 20.0)
    speed, spin_up, w, a = here.crank_speed, here.crank_acceleration, rate[2], change[2]
    felt = np.exp(-1j * place[2]) * (change[0] + 1j * change[1] - complex(*machine.gravity))
    bend = s.first_1 * spin_up + s.first_2 * speed**2
    force = s.mass * felt + (1j * a - w**2) * s.first + 2j * w * speed * s.first_1 + bend
    close(-forces.frame_force, force, 1e-12)
    moment = (np.conj(s.first) * felt).imag + s.inertia * a + s.inertia_1 * w * speed
    moment = moment + s.spin * spin_up + s.spin_1 * speed**2
    pole = here.reference - (0.2 - 0.5j)
    close(-forces.frame_moment(pole), moment, 1e-11)
    torque = (np.conj(s.first_1) * felt).real + s.spin * a + s.drive * spin_up
    torque = torque + s.drive_1 * speed**2 / 2 - s.inertia_1 * w**2 / 2
    close(forces.drive_torque, torque, 1e-11)


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
    here = solution.base_motion
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
    for row, reactions in zip(rows, solution.passes, strict=True):
        force = force + turn * reactions.frame_force
        moment = moment + reactions.frame_moment(here.reference - complex(*row.offset))
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
    here = solution.base_motion
    carried, own = turning_with_the_crank(solution)
    wanted = sum(reactions.drive_torque for reactions in solution.passes)
    wanted = wanted + carried * here.change[2] + own * here.crank_acceleration
    torque = solution.system.drive_torque(solution.sums, solution.states)
    close(torque, wanted, 1e-9)


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


def test_largest_joint_forces_are_reported() -> None:
    """Of the first row, beside those on solid ground."""
    solution = solve_exact(rig(), SPEED, False)
    ground = eq.analyze(rig(), speed=SPEED, acceleration=0.0).summary
    for name, joint in solution.response().joints.items():
        assert joint.on_ground == pytest.approx(ground[f"joints.{name}"].peak, rel=1e-12)
        here = solution.passes[0].joints[name]
        between = resample(here.size, 64 * len(here.size))  # by the trigonometric polynomial
        assert joint.peak == pytest.approx(float(np.max(between)), rel=1e-8)
        assert 0.5 < joint.peak / joint.on_ground < 2
    assert not solution.response(brief=True).joints
