"""Table 3 of Yamashita, Ichikawa and Mori, their equations of motion, and what its digits leave.

Frame and symbols as in `test_yamashita_ichikawa_mori`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import pi, radians
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from support.conformance import Cause
from support.rounding import reach

Array = np.ndarray[Any, Any]

EXACT = 1e-9
THETA_B = 2 * pi * np.arange(1440) / 1440
"""rad."""


@dataclass(frozen=True)
class Finger:
    """A column of Table 3: mm, g, degrees and rpm as printed; lengths are a, b, c, d."""

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


def close(result: Any, wanted: Any) -> None:
    """Assert equality to EXACT of the largest value."""
    np.testing.assert_allclose(result, wanted, rtol=0, atol=EXACT * float(np.max(np.abs(wanted))))


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


def vertical_acceleration(finger: Finger) -> Array:
    """Y_G'' of the common centre of mass over THETA_B, m/s2, by (18)."""
    moving = angles(finger, THETA_B, finger.rpm * pi / 30, 0.0)
    return np.asarray(sum(mass_acceleration(finger, moving)).imag / finger.total_mass)


# -- what makes printed numbers other ones ---------------------------------------------------------


def numbers_of_table_3(finger: Finger) -> tuple[Array, Array]:
    """Lengths, centres, masses, psi and speed as one array, and half of the last digit of each."""
    data = [*finger.lengths, *(x for g in finger.centers for x in (g.real, g.imag)),
            *finger.masses, finger.psi, finger.rpm]  # fmt: skip
    halves = [0.5 if item == int(item) else 0.05 for item in data]
    return np.array(data), np.array(halves)


def with_table_3(numbers: Array) -> Finger:
    """A type with other numbers than those of Table 3."""
    a, b, c, d, *rest, m_b, m_c, m_d, psi, rpm = numbers.tolist()
    g_b, g_c, g_d = (complex(*rest[k : k + 2]) for k in (0, 2, 4))
    return Finger("", (a, b, c, d), (g_b, g_c, g_d), (m_b, m_c, m_d), psi, rpm)


def by_table_3(finger: Finger, value: Callable[[Finger], float]) -> Cause:
    """What half a digit of Table 3 leaves of a value."""

    def gives() -> list[float]:
        return reach(lambda numbers: value(with_table_3(numbers)), *numbers_of_table_3(finger))

    return Cause("half a digit of their Table 3", gives)


def first_order(finger: Finger) -> float:
    """R of the first order of Y_G'', mm/s2, where it is a pure sine: (75) with (81)."""
    _, b, _, d = finger.lengths
    m_b, m_c, m_d = finger.masses
    g_b, _, g_d = finger.centers
    turning = abs(m_b * g_b + m_c * b + m_d * g_d * b / d)
    return float(turning / sum(finger.masses) * (finger.rpm * pi / 30) ** 2)


def made_sine(finger: Finger, link: str) -> Finger:
    """With the centre of mass of coupler or rocker where (80) has it."""
    *_, c, d = finger.lengths
    _, m_c, m_d = finger.masses
    g_b, g_c, g_d = finger.centers
    if link == "coupler":
        g_c = -m_d * g_d * c / (m_c * d)
    else:
        g_d = -m_c * g_c * d / (m_d * c)
    return replace(finger, centers=(g_b, g_c, g_d))


def flattest_coupler(finger: Finger) -> Array:
    """Centre of mass of the coupler, mm, that makes U of (63) least; U is linear in it, squared."""
    g_b, _, g_d = finger.centers
    none, along, across = (
        vertical_acceleration(replace(finger, centers=(g_b, g_c, g_d))) for g_c in (0j, 1 + 0j, 1j)
    )
    changes = np.stack([along - none, across - none], axis=1)
    free, fixed = (item - np.mean(item, axis=0) for item in (changes, none))
    return np.asarray(np.linalg.lstsq(free, -fixed, rcond=None)[0])


def coupler_without_effect(finger: Finger, near: float) -> float:
    """theta_b near which Y_G'' does not depend on g_c1, deg, by (64)."""
    theta_b = np.radians(near + np.arange(-10.0, 10.1, 0.5))
    moving = angles(finger, theta_b, 1.0, 0.0)
    slope = moving.c2 * np.cos(moving.c) - moving.c1**2 * np.sin(moving.c)
    order = np.argsort(slope)
    return float(np.degrees(np.interp(0.0, slope[order], theta_b[order])))
