"""Rainflow counting, Haigh's diagram and Miner's rule."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest

from equipoise.errors import UsageError
from equipoise.mechanism.dynamics.link_stress import (
    LoadCycles,
    WoehlerLine,
    amplitudes_about_zero,
    damage,
    rainflow,
)
from support.refusals import refused


@pytest.mark.parametrize("seed", range(5))
def test_closed_loops_make_up_the_way_of_a_load_that_repeats(seed: int) -> None:
    """Second route: each cycle goes up and down its range once, and together they are all of the
    load's way up and down; where it begins does not matter.
    """
    rng = np.random.default_rng(seed)
    load = rng.integers(-9, 10, 60).astype(float) if seed < 3 else rng.normal(size=200)
    result = rainflow(load, repeats=True)
    way = np.sum(np.abs(np.diff(np.append(load, load[0]))))
    assert np.all(result.counts == 1)
    assert 2 * np.sum(result.ranges) == pytest.approx(way)
    assert np.max(result.ranges) == np.ptp(load)
    later = rainflow(np.roll(load, 17), repeats=True)
    np.testing.assert_allclose(np.sort(later.ranges), np.sort(result.ranges))
    np.testing.assert_allclose(np.sort(later.means), np.sort(result.means))


def test_a_small_swing_rides_on_a_large_one() -> None:
    angle = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    result = rainflow(10 * np.sin(angle) + 3 * np.sin(9 * angle), repeats=True)
    assert np.sum(result.ranges > 20) == 1 and np.sum(result.counts) > 4
    assert rainflow(np.full(5, 3.0), repeats=True).ranges.size == 0


def test_a_line_and_its_knee() -> None:
    line = WoehlerLine(100e6, 1e6, 5.0)
    cycles = line.cycles(np.array([50e6, 100e6, 200e6]))
    np.testing.assert_allclose(cycles, [inf, 1e6, 1e6 / 32])
    going_on = WoehlerLine(100e6, 1e6, 5.0, endless=False)
    assert going_on.cycles(np.array([50e6])) == pytest.approx(32e6)


def test_a_mean_in_tension_counts() -> None:
    """Goodman: 100 MPa about 200 MPa of 400 MPa is as 200 MPa about 0."""
    cycles = LoadCycles(
        np.array([200e6, 200e6, 10.0]), np.array([200e6, -300e6, 400e6]), np.ones(3)
    )
    np.testing.assert_allclose(amplitudes_about_zero(cycles, 400e6), [200e6, 100e6, inf])
    np.testing.assert_allclose(amplitudes_about_zero(cycles, None), [100e6, 100e6, 5.0])
    line = WoehlerLine(100e6, 1e6, 5.0)
    assert damage(LoadCycles(*(a[:2] for a in (cycles.ranges, cycles.means, cycles.counts))), line,
                  400e6) == pytest.approx(33e-6)  # fmt: skip


def test_a_part_that_breaks_at_once_has_used_up_any_life() -> None:
    """A mean above the tensile strength, and an amplitude whose power is no number."""
    once = LoadCycles(np.array([2e6, 20e6]), np.array([500e6, 0.0]), np.ones(2))
    assert damage(once, WoehlerLine(100e6), 400e6) == inf
    huge = LoadCycles(np.array([1e90]), np.zeros(1), np.ones(1))
    assert damage(huge, WoehlerLine(100e6)) == inf


@pytest.mark.parametrize("load", [[], [1.0, float("nan")], [[1.0, 2.0]]])
def test_what_cannot_be_counted_is_refused(load: list[float]) -> None:
    with refused(UsageError, by="rainflow"):
        rainflow(np.array(load))
