"""Turning points of records as they come: held, pushed, stopped, with gaps, noise and offsets."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.measured.turning import Turns, find_turns
from support.refusals import refused
from unit.measured.samples import OMEGA, held, integrated, noisy, simulated

Array = np.ndarray[Any, Any]
HALF = pi / (OMEGA * sqrt(1 - 0.03**2))
TIME = np.linspace(0.0, 6.0, 3000)


def check(turns: Turns, release: float, count: tuple[int, ...], tolerance: float) -> None:
    """Turning points from the release on, evenly spaced, where they should be.

    The last half-swing is 0.06 m high, so noise of 0.01 m may hide it.
    """
    exact = release + HALF * np.arange(len(turns.time))
    np.testing.assert_allclose(turns.time, exact, atol=0.03 * HALF)
    wanted = held(np.maximum(exact, release), release)
    np.testing.assert_allclose(turns.displacement - wanted, 0, atol=tolerance)
    assert len(turns.heights) in count
    assert turns.side == 1


def test_a_clean_record() -> None:
    """To 3e-4, by which polynomials of fourth order miss a cosine at most."""
    turns = find_turns(eq.measured.Record(TIME, held(TIME, -1e-9)))
    check(turns, 0.0, (13,), 3e-4)
    assert turns.noise < 1e-4


LONG = np.linspace(0.0, 30.0, 15000)
UNEVEN = np.sort(np.random.default_rng(2).uniform(0.0, 6.0, 2500))
GAPPY = UNEVEN[(UNEVEN < 2.0) | (UNEVEN > 2.15)]
SLOW = np.sin(np.clip(TIME / 0.8, 0, 1) * pi / 2)
RECORDS = {
    **{
        f"held until {release} s": (TIME, held(TIME, release), release, 0.0125)
        for release in (0.01, 0.4, 1.234, 2.5)
    },
    "pushed and held": (TIME, np.where(TIME < 1.4, SLOW, held(TIME, 1.4)), 1.4, 0.0125),
    "long at rest": (LONG, held(LONG, 0.5), 0.5, 0.0125),
    "uneven, with a gap": (GAPPY, held(GAPPY, 0.5), 0.5, 0.02),
}


@pytest.mark.parametrize("record", RECORDS.values(), ids=RECORDS)
def test_records_as_they_come(record: tuple[Array, Array, float, float]) -> None:
    """To 0.0125, four standard errors of the first turning point and six of the others."""
    time, values, release, tolerance = record
    check(find_turns(noisy(time, values)), release, (12, 13), tolerance)


def test_struck_at_rest() -> None:
    """The swing from rest to the first peak is no half-swing."""
    moved = np.zeros(len(TIME))
    on = TIME >= 1.3
    moved[on] = integrated(TIME[on], OMEGA, 0.03, 0.02, 0.0, 12.0)
    turns = find_turns(noisy(TIME, moved))
    assert turns.time[0] == pytest.approx(1.3 + HALF / 2, abs=0.02)
    assert len(turns.heights) == 12


def test_a_stop_is_a_turning_point() -> None:
    """Three half-swings, of which the last ends at rest."""
    time = np.linspace(0.0, 3.0, 1500)
    turns = find_turns(noisy(time, held(time, 0.5, coulomb=0.15), 0.003))
    assert turns.time[-1] == pytest.approx(0.5 + 3 * HALF, abs=0.02)
    assert turns.displacement[-1] == pytest.approx(held(time, 0.5, coulomb=0.15)[-1], abs=0.004)


def test_an_offset_costs_nothing() -> None:
    values = held(TIME, 0.5)
    near, far = (find_turns(noisy(TIME, values + offset)) for offset in (0.0, 1000.0))
    np.testing.assert_allclose(near.heights, far.heights, atol=1e-9)


def test_a_gap_that_hides_turning_points_ends_the_decay() -> None:
    """Nobody can count the half-swings in it; those before it do."""
    kept = (TIME < 2.3) | (TIME > 2.9)
    turns = find_turns(noisy(TIME[kept], held(TIME, 0.0)[kept]))
    assert np.all(np.isfinite(turns.displacement))
    assert turns.time[-1] < 2.3
    assert len(turns.heights) >= 7


def test_a_record_turned_over_and_in_other_units() -> None:
    values = held(TIME, 0.5)
    first = find_turns(noisy(TIME, values))
    other = find_turns(eq.measured.Record(TIME, -1e-3 * noisy(TIME, values).displacement))
    np.testing.assert_allclose(other.heights, 1e-3 * first.heights, rtol=1e-9)
    np.testing.assert_allclose(other.passed, first.passed, rtol=1e-9)
    assert other.side == -1


@pytest.mark.parametrize("count", [160, 200, 400])
def test_few_samples_in_a_half_swing(count: int) -> None:
    """Seven, eight and seventeen of them."""
    time = np.linspace(0.0, 6.0, count)
    turns = find_turns(noisy(time, held(time, 0.0), 0.001))
    assert len(turns.heights) >= 12
    assert np.diff(turns.passed) == pytest.approx(HALF, rel=0.1)


REFUSED: dict[str, tuple[Array, dict[str, Any]]] = {
    "constant": (np.ones(3000), {"by": "find_turns"}),
    "ramp": (TIME, {"count": 1, "needed": 3}),
    "step": (1.0 * (TIME > 3), {"by": "_half_swing"}),
    "growing": (np.exp(0.2 * TIME) * np.sin(OMEGA * TIME), {"by": "_swings"}),
    "one swing": (integrated(TIME, OMEGA, 0.6, 0.02, 1.0, 0.0), {"needed": 3}),
    "noise": (noisy(TIME, np.zeros(3000)).displacement, {"per_half_swing": 6}),
    "few samples": (held(np.linspace(0, 6, 100), 0), {"samples": 4.27588, "per_half_swing": 6}),
}


@pytest.mark.parametrize(("values", "expected"), REFUSED.values(), ids=REFUSED)
def test_what_is_no_free_decay(values: Array, expected: dict[str, Any]) -> None:
    time = np.linspace(0.0, 6.0, len(values))
    with refused(eq.EquipoiseError, **expected):
        find_turns(eq.measured.Record(time, values))


def test_two_half_swings_are_too_few() -> None:
    with refused(eq.EquipoiseError, count=2, needed=3):
        find_turns(simulated(duration=0.6, count=100))
