"""Sums over the links against energy and momentum of bodies that move one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import MassError
from equipoise.mechanism.force_elements import Motor
from equipoise.mechanism.model import Load
from equipoise.mechanism.support import Row
from equipoise.vibration.linkages import Sums, rows_of, spread, sums
from support.machines import make
from unit.vibration.build import Array, close, rig

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


def at(machine: eq.Machine, theta: Array = THETA) -> Sums:
    return sums(machine, theta, REFERENCE, 10.0)


@machines
@pytest.mark.parametrize("rows", [(), ROWS], ids=["one", "three"])
def test_energy_and_momentum(name: str, rows: list[Row]) -> None:
    """Kinetic energy, momentum and moment of momentum about the reference point, body by body."""
    machine = machine_of(name).with_rows(rows)
    found, b = at(machine), Bodies(machine, THETA)
    s, s1 = (np.exp(1j * b.phi) * part for part in (found.first, found.first_1))
    assert found.mass == pytest.approx(sum(b.mass))
    momentum = found.mass * b.dz + 1j * b.dphi * s + b.dtheta * s1
    close(momentum, sum(m * v for m, v in zip(b.mass, b.velocity, strict=True)), 1e-13)
    moment = (np.conj(s) * b.dz).imag + found.inertia * b.dphi + found.spin * b.dtheta
    wanted = sum(
        m * (np.conj(p - b.z) * v).imag + i * w
        for m, i, p, v, w in zip(b.mass, b.inertia, b.place, b.velocity, b.spin, strict=True)
    )
    close(moment, wanted, 1e-13)
    energy = (
        found.mass * np.abs(b.dz) ** 2
        + found.inertia * b.dphi**2
        + found.drive * b.dtheta**2
        + 2 * (np.conj(b.dz) * (1j * b.dphi * s + b.dtheta * s1)).real
        + 2 * found.spin * b.dphi * b.dtheta
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
    found = at(machine)
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
        np.testing.assert_allclose(getattr(found, slope), wanted, rtol=0, atol=1e-7 * size)


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
    one = at(machine).drive - 0.3
    two = at(machine.with_rows([Row(), Row()])).drive - 0.3
    np.testing.assert_allclose(two, 2 * one)


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
    found = at(machine.with_rows(rows))
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
    whole = turn * found.load_force
    carried = (np.conj(whole) * dz).real + found.load_moment * dphi + found.load_torque * dtheta
    close(carried, power, 1e-13)


def test_springs_turn_the_crank_alone() -> None:
    """In every row by minus the slope of their energy, whatever carries the rows."""
    machine = eq.load("spring-balanced-crank")
    (spring,) = machine.springs
    found = at(machine.with_rows(ROWS[:2]))
    assert not np.any(found.load_force)
    assert not np.any(found.load_moment)
    wanted, step = np.zeros(9), 1e-5
    for row in ROWS[:2]:
        theta = THETA + row.phase
        places = [eq.move(machine, theta + h).points[spring.point].place for h in (step, -step)]
        lengths = [np.abs(place - complex(*machine.frame[spring.to])) for place in places]
        up, down = (spring.stiffness * (x - spring.free_length) ** 2 / 2 for x in lengths)
        wanted -= (up - down) / (2 * step)
    close(found.load_torque, wanted, 1e-8)


def test_no_loads() -> None:
    found = at(eq.load("yamashita-1"))
    for part in (found.load_force, found.load_moment, found.load_torque):
        assert not np.any(part)


# -- in the mean -----------------------------------------------------------------------------------


@machines
def test_spread_in_the_plane_is_the_mean_of_the_sums(name: str) -> None:
    """About the frame's origin: mass, first moment and moment of inertia."""
    machine = machine_of(name)
    theta = eq.move(machine, 360).crank_angle
    found, mean = spread(machine, theta), sums(machine, theta, 0j, 1.0)
    first = np.mean(mean.first)
    wanted = [
        [mean.mass, 0, -first.imag],
        [0, mean.mass, first.real],
        [-first.imag, first.real, np.mean(mean.inertia)],
    ]
    np.testing.assert_allclose(found[np.ix_((0, 1, 5), (0, 1, 5))], wanted, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(found, found.T)


def test_spread_in_space_is_the_mean_energy() -> None:
    """Flat links of points in their plane: v + w x r of each, in the mean over a turn."""
    machine = eq.load("yamashita-1")
    for name in machine.links:
        machine = machine.with_link(name, inertia=0.0)
    theta = eq.move(machine, 90).crank_angle
    motion = eq.move(machine, theta)
    rate = np.random.default_rng(0).normal(size=6)
    energy = 0.0
    for name, link in machine.links.items():
        center = motion.mass_centers[name].place
        places = np.stack([center.real, center.imag, 0 * center.real], axis=-1)
        velocity = rate[:3] + np.cross(rate[3:], places)
        energy += (link.mass or 0.0) * float(np.mean(np.sum(velocity**2, axis=1))) / 2
    assert rate @ spread(machine, theta) @ rate / 2 == pytest.approx(energy)


def test_a_flat_link_has_half_its_inertia_about_an_axis_in_its_plane() -> None:
    plain, heavy = eq.load("yamashita-1"), eq.load("yamashita-1")
    heavy = heavy.with_link("rocker", inertia=(plain.links["rocker"].inertia or 0) + 0.4)
    theta = eq.move(plain, 90).crank_angle
    more = spread(heavy, theta) - spread(plain, theta)
    np.testing.assert_allclose(more, np.diag([0, 0, 0, 0.2, 0.2, 0.4]), atol=1e-12)


def test_missing_masses() -> None:
    machine = replace(
        eq.load("yamashita-1"),
        links={n: eq.Link(dict(k.points)) for n, k in eq.load("yamashita-1").links.items()},
    )
    with pytest.raises(MassError):
        at(machine)
