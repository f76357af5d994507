"""Theo Jansen's leg against its published lengths, by intersections of circles."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq

PUBLISHED = (38.0, 41.5, 39.3, 40.1, 55.8, 39.4, 36.7, 65.7, 49.0, 50.0, 61.9, 7.8, 15.0)
LENGTHS = dict(zip("abcdefghijklm", PUBLISHED, strict=True))
"""The lengths a to m, mm, as Jansen published them (The Great Pretender, 2007)."""


def meeting(first: complex, near: float, second: complex, far: float, side: int) -> complex:
    """Where circles about two points meet, left (1) or right (-1) of the way between them."""
    way = second - first
    along = (near**2 - far**2 + abs(way) ** 2) / (2 * abs(way))
    return first + way / abs(way) * complex(along, side * np.sqrt(near**2 - along**2))


def foot(angle: float) -> complex:
    """Place of the foot, mm."""
    of = LENGTHS
    pivot, pin = complex(-of["a"], -of["l"]), of["m"] * np.exp(1j * angle)
    top = meeting(pin, of["j"], pivot, of["b"], -1)
    knee = meeting(pin, of["k"], pivot, of["c"], 1)
    outer = meeting(pivot, of["d"], top, of["e"], 1)
    heel = meeting(outer, of["f"], knee, of["g"], -1)
    return meeting(heel, of["h"], knee, of["i"], -1)


def test_the_foot_follows_the_published_lengths() -> None:
    motion = eq.analyze(eq.load("jansen-leg")).motion
    expected = np.array([foot(angle) for angle in motion.crank_angle])
    assert motion.point("F").place * 1e3 == pytest.approx(expected, abs=1e-5)


def test_the_foot_runs_level_on_the_ground() -> None:
    place = np.array([foot(angle) for angle in np.radians(np.arange(360))])
    low = place[place.imag < np.min(place.imag) + 1.0]  # 1 mm, of a leg of 100
    assert len(low) > 130
    assert np.ptp(low.real) > 50
