"""Yamashita, Ichikawa and Mori: forces of two rice transplanting four-bars.

Source: M. Yamashita, M. Ichikawa, K. Mori, "Studies on control of vibrations originating in rice
transplanting mechanism consisting of the four bar linkage" (in Japanese), about 1982.  Numbers in
parentheses are its equations.

Data: its Table 3, types I and II, as in the examples ``yamashita-1`` and ``yamashita-2``.  Moments
of inertia are not printed; they are assumed, and matter here only for torque and joint forces,
which are compared with the paper's equations, not with printed figures.

Frame: x forward, y up.  The line from crank pivot A to rocker pivot D points psi below forward.
theta_b, theta_c, theta_a (crank, coupler, rocker) start at that line; capitals theta_B = theta_b -
psi and so on start at the x axis.  So Equipoise's crank angle is theta_B = theta_b - psi, and
harmonic n of a signal over theta_b is its harmonic over the crank angle times exp(-i n psi).

Tolerances.  Equations are met to 1e-9 of the largest value: both sides are exact.  Figures that
follow from the data without sampling are met to their last printed digit.  The harmonics of
Table 4 miss the exact ones by up to 0.065 m/s2, 0.45 % of the first.  The mean shows that the
fault is theirs: a periodic acceleration has mean 0, they print 0.0209 m/s2.  Put together, the
differences are one bump of 0.4 m/s2 near theta_b = 47 deg and next to nothing elsewhere, so a few
of their samples there are wrong.  Figures found by a grid search carry half their grid step.

Slips in print or scan, each shown here by the equation that holds:
(12) has cos(theta_a - theta_b) and denominator c sin(theta_a - theta_c); in (13) only the last
term is multiplied by cos(theta_a - theta_c).  Table 1: for L = 1 the rocker is at psi_a - phi.
F(c) holds the acceleration of G_c, F(d) the lever DG_d.  In (35) the coupler's term has
sin(theta_A - theta_B) and the rocker's factor is b c.  In (36) the last lever's factor is b c, and
the last term is b c G(d) sin(theta_C - theta_B).  In (81) R S contains g_d1.  Table 4: phase 1 is
110.8 deg, R_9 is 0.035.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import equipoise as eq

Array = np.ndarray[Any, Any]

G = 9.80665
EXACT = 1e-9


@dataclass(frozen=True)
class Finger:
    """A column of Table 3: mm, g, degrees and rpm as printed."""

    name: str
    lengths: tuple[float, float, float, float]
    centers: tuple[complex, complex, complex]
    masses: tuple[float, float, float]
    psi: float
    rpm: float

    @property
    def machine(self) -> eq.Machine:
        return eq.load(self.name)

    @property
    def total_mass(self) -> float:
        return sum(self.masses) / 1e3


TYPE_1 = Finger("yamashita-1", (88, 33.5, 71.5, 80), (12, -50 - 20j, 32), (199, 687, 259), 83, 193)
TYPE_2 = Finger("yamashita-2", (85, 40, 70, 80), (17, -45 - 20j, 12), (226, 761, 226), 100, 200)
FINGERS = pytest.mark.parametrize("finger", [TYPE_1, TYPE_2], ids=["I", "II"])

THETA_B = np.radians(np.arange(0.0, 360.0, 2.5))
FINE = np.radians(np.arange(0.0, 360.0, 0.05))
ACCELERATION = 60.0
"""Of the crank, rad/s2: the equations are checked with the crank speeding up as well."""


# -- the paper's equations -------------------------------------------------------------------------


@dataclass(frozen=True)
class Angles:
    """theta_B, theta_C, theta_A from the x axis with first and second derivatives by time."""

    b: Array
    c: Array
    a: Array
    b1: float
    c1: Array
    a1: Array
    b2: float
    c2: Array
    a2: Array


def e_c(finger: Finger, theta_b: Array) -> Array:
    """E_c below (4)."""
    a, b, c, d = finger.lengths
    return np.asarray(a * a + b * b + c * c - d * d - 2 * a * b * np.cos(theta_b))


def angles(finger: Finger, theta_b: Array, speed: float, acceleration: float) -> Angles:
    """(3), (4) with Table 1 for a > b and L = 1, then (10) to (13)."""
    a, b, c, d = finger.lengths
    first = e_c(finger, theta_b)
    r_c = 2 * c * np.sqrt(a * a + b * b - 2 * a * b * np.cos(theta_b))
    phi = np.arctan(b * np.sin(theta_b) / (a - b * np.cos(theta_b)))
    t_c = np.arccos(first / r_c) - phi
    t_a = np.arccos((2 * c * c - 2 * d * d - first) / (r_c * d / c)) - phi
    sine, cosine = np.sin(t_a - t_c), np.cos(t_a - t_c)
    c1 = -b * speed * np.sin(t_a - theta_b) / (c * sine)
    a1 = -b * speed * np.sin(t_c - theta_b) / (d * sine)
    c2 = (
        -b * acceleration * np.sin(t_a - theta_b)
        + b * speed**2 * np.cos(t_a - theta_b)
        + c * c1**2 * cosine
        - d * a1**2
    ) / (c * sine)
    a2 = (
        -b * acceleration * np.sin(t_c - theta_b)
        + b * speed**2 * np.cos(t_c - theta_b)
        + c * c1**2
        - d * a1**2 * cosine
    ) / (d * sine)
    psi = radians(finger.psi)
    return Angles(theta_b - psi, t_c - psi, t_a - psi, speed, c1, a1, acceleration, c2, a2)


def vector(arm: complex, angle: Array, w: Any, w1: Any) -> Array:
    """Second derivative by time of a vector fixed in a link."""
    return np.asarray(arm * np.exp(1j * angle) * (1j * w1 - w * w))


def cross(arm: Array, force: Array) -> Array:
    return np.asarray((arm.conjugate() * force).imag)


def mass_acceleration(finger: Finger, s: Angles) -> tuple[Array, Array, Array]:
    """Mass times acceleration of G_b, G_c, G_d (N), the terms of (17) and (18)."""
    b = finger.lengths[1] / 1e3
    g_b, g_c, g_d = (g / 1e3 for g in finger.centers)
    m_b, m_c, m_d = (m / 1e3 for m in finger.masses)
    return (
        m_b * vector(g_b, s.b, s.b1, s.b2),
        m_c * (vector(b, s.b, s.b1, s.b2) + vector(g_c, s.c, s.c1, s.c2)),
        m_d * vector(g_d, s.a, s.a1, s.a2),
    )


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


def vertical(finger: Finger, machine: eq.Machine | None = None) -> Array:
    """Vertical acceleration of the common centre of mass over FINE, m/s2."""
    solved = eq.forces(moved(finger, FINE, machine))
    return -solved.shaking_force.y / finger.total_mass


def over_theta_b(finger: Finger, orders: int) -> Array:
    """Harmonics of the vertical acceleration over theta_b."""
    machine = finger.machine
    solved = eq.forces(eq.move(machine, 360))
    amplitudes = eq.signals.harmonics(-solved.shaking_force.y / finger.total_mass, orders)
    return np.asarray(amplitudes * np.exp(-1j * np.arange(orders + 1) * radians(finger.psi)))


def close(found: Any, wanted: Any) -> None:
    """Assert equality to EXACT of the largest value."""
    np.testing.assert_allclose(found, wanted, rtol=0, atol=EXACT * float(np.max(np.abs(wanted))))


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


@FINGERS
def test_shaking_force_follows_equations_17_and_18(finger: Finger) -> None:
    """The fluctuating load on the frame is opposite to (17), (18)."""
    solved, s = both(finger)
    close(-solved.shaking_force.value, sum(mass_acceleration(finger, s)))


TABLE_4 = {
    1: (13.6464, -5.1904, 14.600),
    2: (0.8922, -2.8232, 2.961),
    3: (1.1574, -1.3254, 1.760),
    4: (0.6724, -0.7729, 1.024),
    5: (0.4078, -0.4065, 0.576),
    6: (0.2346, -0.2097, 0.315),
    7: (0.1355, -0.0941, 0.165),
    8: (0.0724, -0.0345, 0.080),
    9: (0.0343, -0.0087, 0.035),
}
"""n: A_n, B_n, R_n in m/s2.  R_9 is printed as 0.099, which its A_9 and B_9 contradict."""

TABLE_4_ERROR = 0.065
"""m/s2: what a few wrong samples put into each harmonic of Table 4; see the docstring."""


def test_harmonics_of_type_1_are_exact() -> None:
    """Table 4 recomputed: R_1 to R_4, A_1, B_1 to their last digit; the mean is 0."""
    found = over_theta_b(TYPE_1, 9)
    assert found[0] == pytest.approx(0, abs=1e-12)
    assert np.abs(found[1:5]) == pytest.approx([14.585, 3.022, 1.809, 1.037], abs=5e-4)
    assert found[1].real == pytest.approx(13.6143, abs=5e-5)
    assert -found[1].imag == pytest.approx(-5.2313, abs=5e-5)


@pytest.mark.parametrize("n", TABLE_4)
def test_harmonics_of_type_1_agree_with_table_4(n: int) -> None:
    """Table 4.  Relative to R_n the difference grows from 0.1 % to 25 % at n = 9."""
    a, b, r = TABLE_4[n]
    found = over_theta_b(TYPE_1, 9)[n]
    assert found.real == pytest.approx(a, abs=TABLE_4_ERROR)
    assert -found.imag == pytest.approx(b, abs=TABLE_4_ERROR)
    assert abs(found) == pytest.approx(r, abs=TABLE_4_ERROR)


@pytest.mark.parametrize(
    ("n", "printed", "tolerance"), [(1, 110.8, 0.3), (2, 162.5, 0.5), (3, 138.9, 1), (4, 139.0, 4)]
)
def test_phases_of_type_1(n: int, printed: float, tolerance: float) -> None:
    """Table 4, Y = R sin(n theta_b + phase); 0.065 m/s2 turn an R of 1 m/s2 by up to 4 deg."""
    found = over_theta_b(TYPE_1, 4)[n]
    assert np.degrees(np.arctan2(found.real, -found.imag)) == pytest.approx(printed, abs=tolerance)


def test_table_4_misses_by_a_bump_at_one_place() -> None:
    """What Table 4 adds to the exact acceleration lies near theta_b = 47 deg and is 0.4 m/s2."""
    printed = np.array([0.0209, *(complex(a, -b) for a, b, _ in TABLE_4.values())])
    wrong = printed - over_theta_b(TYPE_1, 9)
    bump = (wrong @ np.exp(1j * np.outer(np.arange(10), FINE))).real
    assert np.degrees(FINE[np.argmax(bump)]) == pytest.approx(47.5, abs=1)
    assert np.max(bump) == pytest.approx(0.406, abs=0.005)
    elsewhere = (np.degrees(FINE) > 90) & (np.degrees(FINE) < 330)
    assert np.max(np.abs(bump[elsewhere])) < 0.04


def test_harmonics_fall_for_both_types() -> None:
    """Section 4-3: orders from 2 on grow smaller, and type II behaves alike."""
    for finger in (TYPE_1, TYPE_2):
        assert np.all(np.diff(np.abs(over_theta_b(finger, 9)[1:])) < 0)


def test_counterweight_of_type_1() -> None:
    """Section 5-3: 35.7 mm and 111 deg for a mass equal to that of the links.

    It takes 72 % off the largest acceleration and, says the paper, 54 % off the smallest: 59.2 %.
    """
    first = over_theta_b(TYPE_1, 1)[1]
    speed = TYPE_1.rpm * pi / 30
    phase = np.arctan2(first.real, -first.imag)
    assert abs(first) / speed**2 * 1e3 == pytest.approx(35.70, abs=0.006)
    assert np.degrees(phase) == pytest.approx(111.02, abs=0.005)
    alone = vertical(TYPE_1)
    rest = alone - abs(first) * np.sin(FINE + phase)
    assert 1 - np.max(rest) / np.max(alone) == pytest.approx(0.719, abs=5e-4)
    assert 1 - np.min(rest) / np.min(alone) == pytest.approx(0.592, abs=5e-4)


def test_two_units_of_type_2() -> None:
    """Section 5-5: best 180 deg apart; the paper says 77 % and 60 %, exact are 74.0 and 52.5 %."""
    alone = vertical(TYPE_2)
    step = len(alone) // 360
    spread = [float(np.std(alone + np.roll(alone, step * x))) for x in range(360)]
    assert np.argmin(spread) == 180
    pair = alone + np.roll(alone, step * 180)
    assert 1 - np.max(pair) / np.max(2 * alone) == pytest.approx(0.740, abs=5e-4)
    assert 1 - np.min(pair) / np.min(2 * alone) == pytest.approx(0.525, abs=5e-4)


def test_flattest_coupler_center_of_type_2() -> None:
    """Section 5-2: (5.8, 27.8) mm from a grid search; exact (6.24, 26.22) mm, 40.2 % less."""
    found = eq.mechanism.regressor(moved(TYPE_2, FINE))
    k = found.parameters.index(("coupler", "moment_x"))
    columns = -found.shaking_force[k : k + 2].imag / TYPE_2.total_mass
    alone = vertical(TYPE_2)
    change = np.linalg.lstsq(columns.T, -alone, rcond=None)[0]
    center = (found.values[k : k + 2] + change) / 0.761 * 1e3
    assert center == pytest.approx([6.24, 26.22], abs=0.006)
    flat = vertical(TYPE_2, moved_center("coupler", complex(*center)))
    assert 1 - np.std(flat) / np.std(alone) == pytest.approx(0.402, abs=5e-4)
    theirs = vertical(TYPE_2, moved_center("coupler", 5.8 + 27.8j))
    assert 1 - np.std(theirs) / np.std(alone) == pytest.approx(0.40, abs=0.005)


def moved_center(link: str, center: complex) -> eq.Machine:
    """Type II with the centre of mass of one link elsewhere, mm."""
    place = (center.real / 1e3, center.imag / 1e3)
    return TYPE_2.machine.with_link(link, center_of_mass=place)


# -- pure sine, complete balance -------------------------------------------------------------------


@pytest.mark.parametrize(
    ("link", "printed", "exact", "grid", "amplitude_printed", "amplitude"),
    [
        ("coupler", -3.0 + 0j, -3.118 + 0j, 0.15, 12853, 12888),
        ("rocker", 172 + 76j, 173.17 + 76.97j, 1.6, 19708, 19726),
    ],
)
def test_pure_sine_of_type_2(
    link: str,
    printed: complex,
    exact: complex,
    grid: float,
    amplitude_printed: float,
    amplitude: float,
) -> None:
    """Section 5-7 and (80), mm and mm/s2; the printed ones come from a search with 1 mm steps."""
    _, _, c, d = TYPE_2.lengths
    _, m_c, m_d = TYPE_2.masses
    _, g_c, g_d = TYPE_2.centers
    center = -m_d * g_d * c / (d * m_c) if link == "coupler" else -m_c * g_c * d / (c * m_d)
    assert center == pytest.approx(exact, abs=0.006)
    assert abs(center - printed) < grid
    found = np.abs(eq.signals.harmonics(vertical(TYPE_2, moved_center(link, center)), 20)) * 1e3
    assert found[1] == pytest.approx(amplitude, abs=0.5)
    assert found[1] == pytest.approx(amplitude_printed, rel=3e-3)
    assert np.max(found[2:]) < 1e-9


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


@FINGERS
def test_complete_balance_by_equations_84_and_85(finger: Finger) -> None:
    balanced = balanced_by_84_and_85(finger)
    solved = eq.forces(moved(finger, THETA_B, balanced, ACCELERATION))
    before = eq.forces(moved(finger, THETA_B, acceleration=ACCELERATION))
    assert np.max(before.shaking_force.size) > 10
    assert np.max(solved.shaking_force.size) < 1e-12
    assert np.max(np.abs(solved.shaking_moment)) > 0.1


def test_first_moments_of_the_balanced_type_1() -> None:
    """Below (85), g mm: m_d g_d1, m_d g_d2, m_b g_b1, m_b g_b2; printed exactly."""
    links = balanced_by_84_and_85(TYPE_1).links
    found = [
        moment
        for name in ("rocker", "crank")
        for moment in (1e6 * (links[name].mass or 0) * x for x in links[name].center_of_mass or ())
    ]
    assert found == pytest.approx([38433.6, 15373.4, -39108.6, -6437.6], abs=0.06)


def balanced_by_84_and_85(finger: Finger) -> eq.Machine:
    _, b, c, d = finger.lengths
    m_b, m_c, m_d = finger.masses
    g_c = finger.centers[1]
    rocker = -m_c * g_c * d / c / m_d / 1e3
    crank = -m_c * b / c * (c - g_c) / m_b / 1e3
    machine = finger.machine.with_link("rocker", center_of_mass=(rocker.real, rocker.imag))
    return machine.with_link("crank", center_of_mass=(crank.real, crank.imag))


# -- joint forces and torque -----------------------------------------------------------------------


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


@FINGERS
def test_frame_force_follows_equation_47(finger: Finger) -> None:
    """With the pivot A at rest, F_A + F_D = M r_G'' + M g j; the frame gets the opposite."""
    solved, s = both(finger)
    weight = 1j * finger.total_mass * G
    close(-solved.frame_force.value, sum(mass_acceleration(finger, s)) + weight)
    joints = solved.joints
    close(joints["A"].value + joints["D"].value, sum(mass_acceleration(finger, s)) + weight)


@FINGERS
def test_drive_torque_follows_equation_33(finger: Finger) -> None:
    solved, s = both(finger)
    close(solved.drive_torque, sum(torque_parts(finger, s).values()))


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
    found = eq.mechanism.regressor(motion)
    rows = found.values[:, None] * found.drive_torque
    return dict(zip(found.parameters, rows, strict=True))


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


# -- sensitivities ---------------------------------------------------------------------------------


@FINGERS
def test_sensitivities_of_equation_64(finger: Finger) -> None:
    """M dY''/d(first moment) of every link, and M dY''/dm, as columns of the regressor."""
    motion = moved(finger, THETA_B)
    s = angles(finger, THETA_B, finger.rpm * pi / 30, 0.0)
    found = eq.mechanism.regressor(motion)
    column = {p: -row.imag for p, row in zip(found.parameters, found.shaking_force, strict=True)}
    still = np.zeros(THETA_B.shape)
    rows: tuple[tuple[str, Array, Array, Array], ...] = (
        ("crank", s.b, still + s.b1, still),
        ("coupler", s.c, s.c1, s.c2),
        ("rocker", s.a, s.a1, s.a2),
    )
    base = -(s.b1**2) * finger.lengths[1] / 1e3 * np.sin(s.b)
    for (link, angle, w, w1), center in zip(rows, finger.centers, strict=True):
        g1, g2 = center.real / 1e3, center.imag / 1e3
        by_x = w1 * np.cos(angle) - w**2 * np.sin(angle)
        by_y = -w1 * np.sin(angle) - w**2 * np.cos(angle)
        close(column[link, "moment_x"], by_x)
        close(column[link, "moment_y"], by_y)
        by_mass = column[link, "mass"] + g1 * by_x + g2 * by_y
        close(by_mass, (base if link == "coupler" else 0) + g1 * by_x + g2 * by_y)


@pytest.mark.parametrize(
    ("quantity", "printed", "exact", "tolerance"),
    [
        ("moment_x", (10, 267), (6.72, 265.82), 3.5),
        ("moment_y", (30, 215, 320), (27.94, 214.74, 319.41, 330.64), 2.5),
    ],
)
def test_crank_angles_at_which_a_coupler_coordinate_has_no_effect(
    quantity: str, printed: tuple[float, ...], exact: tuple[float, ...], tolerance: float
) -> None:
    """Section 5-2, theta_b in degrees, read off a plot with wide steps (Fig. 11), type II.

    For g_c2 the paper names three angles.  A periodic function changes sign an even number of
    times: there is a fourth at 330.6 deg, close to the third, between which it stays small.
    """
    found = sign_changes(quantity)
    assert found == pytest.approx(exact, abs=0.006)
    for wanted, at in zip(printed, found, strict=False):
        assert at == pytest.approx(wanted, abs=tolerance)


def sign_changes(quantity: str) -> list[float]:
    """theta_b in degrees at which the coupler's first moment leaves the vertical force alone."""

    def effect(theta_b: Any) -> Array:
        found = eq.mechanism.regressor(moved(TYPE_2, np.radians(np.atleast_1d(theta_b))))
        column: Array = found.shaking_force[found.parameters.index(("coupler", quantity))].imag
        return column

    grid = np.arange(0.0, 361.0, 1.0)
    values = effect(grid)
    brackets = np.flatnonzero(values[:-1] * values[1:] < 0)
    return [float(brentq(lambda t: effect(t)[0], grid[k], grid[k + 1])) for k in brackets]
