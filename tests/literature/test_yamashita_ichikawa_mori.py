"""Yamashita, Ichikawa and Mori: forces of two rice transplanting four-bars.

Numbers in parentheses are its equations; `support.sources` has the citation.

Data: its Table 3, types I and II, as in the examples ``yamashita-1`` and ``yamashita-2``.  Moments
of inertia are not printed; they are assumed, and matter here only for torque and joint forces,
which are compared with the paper's equations, not with printed figures.

Frame: x forward, y up.  The line from crank pivot A to rocker pivot D points psi below forward.
theta_b, theta_c, theta_a (crank, coupler, rocker) start at that line; capitals theta_B = theta_b -
psi and so on start at the x axis.  So Equipoise's crank angle is theta_B = theta_b - psi, and
harmonic n of a signal over theta_b is its harmonic over the crank angle times exp(-i n psi).

Their harmonics and the rig are in `test_yamashita_vibration`, conditions of balance and what they
found by balancing in `test_yamashita_balancing`, rows in `test_yamashita_phases`.

Tolerances.  Equations are met to 1e-9 of the largest value: both sides are exact.
"""

from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest

import equipoise as eq
from literature.yamashita import (
    EXACT,
    FINGERS,
    TYPE_1,
    TYPE_2,
    Angles,
    Array,
    Finger,
    angles,
    close,
    e_c,
    mass_acceleration,
    vector,
)
from support.conformance import equation
from support.sources import YAMASHITA

G = 9.80665


THETA_B = np.radians(np.arange(0.0, 360.0, 2.5))
FINE = np.radians(np.arange(0.0, 360.0, 0.05))
ACCELERATION = 60.0
"""Of the crank, rad/s2: the equations are checked with the crank speeding up as well."""


# -- the paper's equations -------------------------------------------------------------------------


def cross(arm: Array, force: Array) -> Array:
    return np.asarray((arm.conjugate() * force).imag)


def joint_forces(finger: Finger, s: Angles) -> dict[str, Array]:
    """(25) to (32), as complex numbers x + i y."""
    _, _, c, d = (x / 1e3 for x in finger.lengths)
    _, g_c, g_d = (g / 1e3 for g in finger.centers)
    m_b, m_c, m_d = (m / 1e3 for m in finger.masses)
    inertia = inertias(finger)
    by_b, by_c, by_d = mass_acceleration(finger, s)
    arm_c, arm_d = g_c * np.exp(1j * s.c), g_d * np.exp(1j * s.a)
    f_c = inertia["coupler own"] * s.c2 + cross(arm_c, by_c + 1j * m_c * G)
    f_d = inertia["rocker"] * s.a2 + cross(arm_d, np.full(s.a.shape, 1j * m_d * G))
    on_rocker = f_c * d * np.exp(1j * s.a) + f_d * c * np.exp(1j * s.c)
    f_cd = on_rocker / (c * d * np.sin(s.c - s.a))
    f_bc = f_cd + by_c + 1j * m_c * G
    return {
        "C": f_cd,
        "B": f_bc,
        "A": f_bc + by_b + 1j * m_b * G,
        "D": -f_cd + by_d + 1j * m_d * G,
    }


def inertias(finger: Finger) -> dict[str, float]:
    """Moments of inertia about A, B and D, and the coupler's about G_c, kg m2."""
    links = finger.machine.links
    own = {name: float(link.inertia or 0) for name, link in links.items()}
    steiner = [m * abs(g) ** 2 / 1e9 for m, g in zip(finger.masses, finger.centers, strict=True)]
    about = {name: own[name] + extra for name, extra in zip(own, steiner, strict=True)}
    return {**about, "coupler own": own["coupler"]}


def torque_parts(finger: Finger, s: Angles) -> dict[str, Array]:
    """T_ac (34), T_tm (35) and T_sg (36), each over R(theta_C, theta_A) as in (33), N m."""
    _, b, c, d = (x / 1e3 for x in finger.lengths)
    g_b, g_c, g_d = (g / 1e3 for g in finger.centers)
    m_b, m_c, m_d = (m / 1e3 for m in finger.masses)
    inertia = inertias(finger)
    sin_ca, sin_ab, sin_cb = np.sin(s.c - s.a), np.sin(s.a - s.b), np.sin(s.c - s.b)
    cos_cb, r = np.cos(s.c - s.b), c * d * sin_ca
    g1, g2 = g_c.real, g_c.imag
    t_ac = b * c * d * m_c * sin_ca * (
        (g1 * s.c2 - g2 * s.c1**2) * cos_cb - (g2 * s.c2 + g1 * s.c1**2) * sin_cb
    ) + b * b * d * m_c * sin_ab * (
        (g1 * s.b2 + g2 * s.b1**2) * cos_cb - (g2 * s.b2 - g1 * s.b1**2) * sin_cb
    )
    t_tm = (
        c * d * (inertia["crank"] + m_c * b * b) * s.b2 * sin_ca
        + b * d * inertia["coupler"] * s.c2 * sin_ab
        + b * c * inertia["rocker"] * s.a2 * sin_cb
    )
    t_sg = (
        c * d * m_b * G * (g_b * np.exp(1j * s.b)).real * sin_ca
        + b * d * m_c * G * (g_c * np.exp(1j * s.c)).real * sin_ab
        + b * c * d * m_c * G * np.cos(s.b) * sin_ca
        + b * c * m_d * G * (g_d * np.exp(1j * s.a)).real * sin_cb
    )
    return {"ac": t_ac / r, "tm": t_tm / r, "sg": t_sg / r}


# -- the same from Equipoise -----------------------------------------------------------------------


def moved(
    finger: Finger, theta_b: Array, machine: eq.Machine | None = None, acceleration: float = 0.0
) -> eq.mechanism.Motion:
    """Motion at the paper's crank angles."""
    machine = finger.machine if machine is None else machine
    return eq.move(machine, theta_b - radians(finger.psi), acceleration=acceleration)


def both(finger: Finger) -> tuple[eq.mechanism.Forces, Angles]:
    """Forces from Equipoise and angles from the paper, with the crank speeding up."""
    solved = eq.forces(moved(finger, THETA_B, acceleration=ACCELERATION))
    return solved, angles(finger, THETA_B, finger.rpm * pi / 30, ACCELERATION)


# -- data and geometry -----------------------------------------------------------------------------


@FINGERS
def test_example_holds_table_3(finger: Finger) -> None:
    machine, bar = finger.machine, eq.mechanism.four_bar(finger.machine)
    assert bar is not None
    assert (bar.a, bar.b, bar.c, bar.d) == pytest.approx([x / 1e3 for x in finger.lengths])
    for link, mass, center in zip(
        machine.links.values(), finger.masses, finger.centers, strict=True
    ):
        assert link.mass == pytest.approx(mass / 1e3)
        assert link.center_of_mass == pytest.approx((center.real / 1e3, center.imag / 1e3))
    assert machine.drive.speed == pytest.approx(finger.rpm * pi / 30)
    a = finger.lengths[0] / 1e3 * np.exp(-1j * radians(finger.psi))
    assert complex(*machine.frame["D"]) - complex(*machine.frame["A"]) == pytest.approx(a)


@equation(
    YAMASHITA,
    "(3), (4), (10) to (13)",
    "angles, angular velocities and accelerations",
    EXACT,
    "(12) has cos(theta_a - theta_b) and denominator c sin(theta_a - theta_c); in (13) only the "
    "last term is multiplied by cos(theta_a - theta_c) (scan). Table 1: for L = 1 the rocker is at"
    " psi_a - phi. In (3), (4) E_c = a^2 + b^2 + c^2 - d^2 - 2 a b cos(theta_b)",
)
@FINGERS
def test_angles_follow_equations_3_4_and_10_to_13(finger: Finger) -> None:
    solved, s = both(finger)
    links = solved.motion.links
    for link, angle, first, second in (
        (links["coupler"], s.c, s.c1, s.c2),
        (links["rocker"], s.a, s.a1, s.a2),
    ):
        close(np.exp(1j * link.angle), np.exp(1j * angle))
        close(link.angular_velocity, first)
        close(link.angular_acceleration, second)


@equation(YAMASHITA, "(1), (2)", "closure of the loop", EXACT)
@FINGERS
def test_loop_closes_by_equations_1_and_2(finger: Finger) -> None:
    links = moved(finger, THETA_B).links
    a, b, c, d = finger.lengths
    psi = radians(finger.psi)
    t_b, t_c, t_a = (links[name].angle + psi for name in ("crank", "coupler", "rocker"))
    close(b * np.sin(t_b) + c * np.sin(t_c) - d * np.sin(t_a) + a, np.full(t_b.shape, a))
    close(b * np.cos(t_b) + c * np.cos(t_c) - d * np.cos(t_a), np.full(t_b.shape, a))


@pytest.mark.parametrize(
    ("lengths", "turns", "apart"),
    [
        (TYPE_1.lengths, True, True),
        (TYPE_2.lengths, True, True),
        ((88, 70, 71.5, 80), False, True),
        ((88, 33.5, 41.5, 80), True, False),
        ((88, 33.5, 90, 35.5), True, False),
    ],
    ids=["type I", "type II", "crank too long", "a + b = c + d", "b + c = a + d"],
)
def test_conditions_5_and_6(
    lengths: tuple[float, float, float, float], turns: bool, apart: bool
) -> None:
    """(5) at every crank angle, (6), against the figures of `four_bar`."""
    a, b, c, d = lengths
    shape = Finger("", lengths, TYPE_1.centers, TYPE_1.masses, 83, 193)
    first = e_c(shape, FINE)
    r_c = 2 * c * np.sqrt(a * a + b * b - 2 * a * b * np.cos(FINE))
    second = 2 * c * c - 2 * d * d - first
    largest = max(np.max(np.abs(first / r_c)), np.max(np.abs(second * c / (r_c * d))))
    assert bool(largest <= 1 + 1e-12) == turns
    assert (min(abs(a + b - c - d), abs(b + c - a - d)) > 1e-9) == apart
    bar = eq.mechanism.four_bar(with_lengths(lengths))
    assert bar is not None
    assert (bar.condition_5, bar.condition_6) == (turns, apart)


def with_lengths(lengths: tuple[float, float, float, float]) -> eq.Machine:
    a, b, c, d = (x / 1e3 for x in lengths)
    machine = eq.Machine(
        title="four-bar",
        drive=eq.Drive("crank", 1.0),
        frame={"A": (0.0, 0.0), "D": (a, 0.0)},
        links={
            "crank": eq.Link({"A": (0.0, 0.0), "B": (b, 0.0)}),
            "coupler": eq.Link({"B": (0.0, 0.0), "C": (c, 0.0)}),
            "rocker": eq.Link({"D": (0.0, 0.0), "C": (d, 0.0)}),
        },
        assembly={"C": "left"},
    )
    return machine


# -- shaking force ---------------------------------------------------------------------------------


@equation(YAMASHITA, "(17), (18)", "shaking force", EXACT)
@FINGERS
def test_shaking_force_follows_equations_17_and_18(finger: Finger) -> None:
    """The fluctuating load on the frame is opposite to (17), (18)."""
    solved, s = both(finger)
    close(-solved.shaking_force.value, sum(mass_acceleration(finger, s)))


# -- a common centre of mass on a circle -----------------------------------------------------------


@equation(
    YAMASHITA,
    "(81), (82)",
    "circle of the common centre of mass",
    EXACT,
    "in (81) R S contains g_d1",
)
@FINGERS
def test_circle_of_equations_81_and_82(finger: Finger) -> None:
    """Under (80) the common centre of mass moves on a circle of radius |RS + i RT| / M."""
    _, b, c, d = finger.lengths
    m_b, m_c, m_d = finger.masses
    g_b, g_c, _ = finger.centers
    g_d = -m_c * g_c * d / (c * m_d)
    machine = finger.machine.with_link("rocker", center_of_mass=(g_d.real / 1e3, g_d.imag / 1e3))
    rs_rt = (m_b * g_b + m_c * b + m_d * g_d * b / d) / 1e6
    motion = moved(finger, THETA_B, machine, ACCELERATION)
    wanted = vector(rs_rt, motion.crank_angle, motion.speed, ACCELERATION)
    close(-eq.forces(motion).shaking_force.value, wanted)


# -- joint forces and torque -----------------------------------------------------------------------


@equation(
    YAMASHITA,
    "(25) to (32)",
    "forces in all joints",
    EXACT,
    "F(c) holds the acceleration of G_c, F(d) the lever DG_d",
)
@FINGERS
def test_joint_forces_follow_equations_25_to_32(finger: Finger) -> None:
    """F_A, F_D act on crank and rocker by the frame, F_bc on the coupler, F_cd on the rocker."""
    solved, s = both(finger)
    wanted = joint_forces(finger, s)
    assert {name: (j.on, j.by) for name, j in solved.joints.items()} == {
        "A": ("crank", "frame"),
        "B": ("coupler", "crank"),
        "C": ("rocker", "coupler"),
        "D": ("rocker", "frame"),
    }
    for name, force in wanted.items():
        close(solved.joints[name].value, force)


@equation(YAMASHITA, "(47)", "force on the frame", EXACT)
@FINGERS
def test_frame_force_follows_equation_47(finger: Finger) -> None:
    """With the pivot A at rest, F_A + F_D = M r_G'' + M g j; the frame gets the opposite."""
    solved, s = both(finger)
    weight = 1j * finger.total_mass * G
    close(-solved.frame_force.value, sum(mass_acceleration(finger, s)) + weight)
    joints = solved.joints
    close(joints["A"].value + joints["D"].value, sum(mass_acceleration(finger, s)) + weight)


@equation(
    YAMASHITA,
    "(33) to (36)",
    "drive torque",
    EXACT,
    "in (35) the coupler's term has sin(theta_A - theta_B) and the rocker's factor is b c; in (36)"
    " the last lever's factor is b c, and the last term is b c G(d) sin(theta_C - theta_B)",
)
@FINGERS
def test_drive_torque_follows_equation_33(finger: Finger) -> None:
    solved, s = both(finger)
    close(solved.drive_torque, sum(torque_parts(finger, s).values()))


@equation(YAMASHITA, "(34) to (36)", "parts of the drive torque by parameter", EXACT)
@FINGERS
def test_parts_of_the_torque_are_columns_of_the_regressor(finger: Finger) -> None:
    """(34): coupler's first moments; (35): inertias and m_c b^2 theta_B''; (36): weight.

    The columns hold weight too; what they are at rest is (36), the rest is inertia.  First moments
    of crank and rocker act through weight alone.
    """
    solved, s = both(finger)
    wanted = torque_parts(finger, s)
    parts = regressor_parts(solved.motion)
    still = regressor_parts(solved.motion.at(0.0, 0.0))
    moving = {key: parts[key] - still[key] for key in parts}
    close(sum(still.values()), wanted["sg"])
    close(moving["coupler", "moment_x"] + moving["coupler", "moment_y"], wanted["ac"])
    turning = [moving[link, "inertia"] for link in ("crank", "coupler", "rocker")]
    close(sum(turning) + moving["coupler", "mass"], wanted["tm"])
    m_c, b = finger.masses[1] / 1e3, finger.lengths[1] / 1e3
    close(moving["coupler", "mass"], np.full(THETA_B.shape, m_c * b * b * ACCELERATION))
    for link in ("crank", "rocker"):
        for quantity in ("mass", "moment_x", "moment_y"):
            assert np.max(np.abs(moving[link, quantity])) < 1e-12


def regressor_parts(motion: eq.mechanism.Motion) -> dict[tuple[str, str], Array]:
    """Drive torque by link and inertial parameter, N m."""
    regressor = eq.mechanism.regressor(motion)
    rows = regressor.values[:, None] * regressor.drive_torque
    return dict(zip(regressor.parameters, rows, strict=True))


@equation(YAMASHITA, "(90)", "drive torque of turning alone", EXACT)
@FINGERS
def test_torque_of_equation_90(finger: Finger) -> None:
    """Under (74) and (76) only T_tm is left: no weight and no T_ac in the drive torque."""
    _, b, _, _ = finger.lengths
    m_b, m_c, _ = finger.masses
    machine = finger.machine
    for link, x in (("crank", -m_c / m_b * b / 1e3), ("coupler", 0.0), ("rocker", 0.0)):
        machine = machine.with_link(link, center_of_mass=(x, 0.0))
    solved = eq.forces(moved(finger, THETA_B, machine))
    s = angles(finger, THETA_B, finger.rpm * pi / 30, 0.0)
    b, c, d = (x / 1e3 for x in finger.lengths[1:])
    i_c, i_d = (machine.links[name].inertia or 0.0 for name in ("coupler", "rocker"))
    t_tm = b * d * i_c * s.c2 * np.sin(s.a - s.b) + b * c * i_d * s.a2 * np.sin(s.c - s.b)
    close(solved.drive_torque, t_tm / (c * d * np.sin(s.c - s.a)))
    assert np.max(np.abs(solved.at(0.0).drive_torque)) < 1e-12
