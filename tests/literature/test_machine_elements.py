"""Rainflow counting of ASTM E1049, and a bearing of Shigley's Mechanical Engineering Design."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from equipoise.mechanism.dynamics.joint_duty import bearing_life
from equipoise.mechanism.dynamics.link_stress import rainflow
from equipoise.mechanism.parts.joint_properties import RollingBearing

E1049 = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]
RPM = 2 * pi / 60


def test_the_example_of_rainflow_counting() -> None:
    """Figure 6 of ASTM E1049: ranges and how many cycles have each."""
    result = rainflow(np.array(E1049)).by_range()
    assert result == [(3.0, 0.5), (4.0, 1.5), (6.0, 0.5), (8.0, 1.0), (9.0, 0.5)]


def test_a_deep_groove_ball_bearing() -> None:
    """Chapter 11: 25 kh at 350 rpm under 2.5 kN times 1.2; 525 million turns, C10 24.26 kN at 90 %
    (the book rounds the life that 90 % reach in its distribution to 0.9933 of L10), and 0.9195 for
    the next larger bearing of 25.5 kN.
    """
    bearing = RollingBearing(25.5e3, load_factor=1.2, life=25e3 * 3600.0, reliability=0.9)
    life = bearing_life(bearing, 2500.0, 350 * RPM)
    assert life.equivalent_load == pytest.approx(3000.0)
    assert bearing.life is not None
    assert bearing.life * life.speed / (2 * pi * 1e6) == pytest.approx(525.0)
    assert life.needed_rating == pytest.approx(24.26e3, abs=5.0)
    assert life.reached == pytest.approx(0.9195, abs=5e-5)
