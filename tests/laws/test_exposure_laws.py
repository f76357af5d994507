"""Laws of hand-arm vibration: energy, ratios, and that no way of saying the same matters."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from equipoise.exposure.daily import LIMIT, Task, daily_exposure, limit_time, time_to_reach
from equipoise.exposure.spectra import weigh_orders, weigh_signal, weigh_spectrum
from equipoise.exposure.weighting import factor

HOUR = 3600.0
RATES = st.sampled_from([2850.0, 4000.0, 5000.3, 12800.0, 44100.0])
ACCELERATIONS = st.floats(0.01, 100.0)
DURATIONS = st.floats(60.0, 4 * HOUR)
TASKS = st.lists(st.builds(Task, st.just("task"), ACCELERATIONS, DURATIONS), min_size=1, max_size=6)


def periods(rate: float, count: int, waves: np.ndarray, rms: np.ndarray, phases: np.ndarray):
    """Whole periods of a sum of waves, `waves` of them in `count` samples."""
    time = np.arange(count) / rate
    angles = 2 * np.pi * rate / count * np.outer(waves, time) + phases[:, None]
    return time, np.sqrt(2) * rms @ np.sin(angles), waves * rate / count


@settings(max_examples=30)
@given(RATES, st.integers(1000, 1100), st.integers(0, 2**31))
def test_the_way_by_time_and_the_way_by_the_spectrum_are_one(
    rate: float, count: int, seed: int
) -> None:
    """Parseval: whole periods in time, and their lines; exact at any sampling rate."""
    rng = np.random.default_rng(seed)
    waves = np.sort(rng.choice(np.arange(1, 400), 5, replace=False))
    rms, phases = rng.uniform(0.1, 10, 5), rng.uniform(0, 2 * np.pi, 5)
    time, values, lines = periods(rate, count, waves, rms, phases)
    by_time = weigh_signal(time, values, periodic=True)
    by_lines = weigh_spectrum(lines, rms)
    assert by_time.a_hw == pytest.approx(by_lines.a_hw, rel=1e-9)
    np.testing.assert_allclose(by_time.band_a_hw, by_lines.band_a_hw, atol=1e-9 * by_time.a_hv)
    by_orders = weigh_orders(2 * np.pi * rate / count, waves, np.sqrt(2) * rms)
    assert by_orders.a_hw == pytest.approx(by_lines.a_hw, rel=1e-12)


@settings(max_examples=30)
@given(RATES, st.floats(20.0, 1400.0), st.floats(0.0, 6.3), st.floats(0.1, 50.0))
def test_a_weighted_sine_is_the_factor_times_its_rms_at_any_sampling_rate(
    rate: float, frequency: float, phase: float, rms: float
) -> None:
    """Not of whole periods: 4 seconds, to a thousandth."""
    time = np.arange(int(4 * rate)) / rate
    values = np.sqrt(2) * rms * np.sin(2 * np.pi * frequency * time + phase)
    weighted = weigh_signal(time, values)
    assert weighted.a_hw[0] == pytest.approx(rms * float(factor(frequency)), rel=1e-3)


def test_scale_sense_axes_and_time_do_not_matter() -> None:
    rng = np.random.default_rng(4)
    time = np.arange(20_000) / 4500.0
    values = rng.normal(size=(3, len(time)))
    plain = weigh_signal(time, values)
    for other in (
        weigh_signal(time + 17.0, values),
        weigh_signal(time, -values[:, ::-1]),
        weigh_signal(time, values + np.array([[3.0], [-9.81], [0.0]])),
    ):
        np.testing.assert_allclose(other.a_hw, plain.a_hw, rtol=1e-9)
    np.testing.assert_allclose(weigh_signal(time, 7 * values).a_hw, 7 * plain.a_hw)
    turned, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    assert weigh_signal(time, turned @ values).a_hv == pytest.approx(plain.a_hv, rel=1e-9)


def test_the_same_vibration_sampled_twice_as_fast_weighs_the_same() -> None:
    rng = np.random.default_rng(5)
    waves, phases = np.arange(10, 700, 7), rng.uniform(0, 6, 99)
    rms = rng.uniform(0, 1, 99)
    actual = [
        weigh_signal(*periods(rate, int(rate), waves, rms, phases)[:2]).a_hv
        for rate in (3000.0, 6000.0, 48000.0)
    ]
    assert actual[1:] == pytest.approx([actual[0]] * 2, rel=1e-6)


@given(TASKS)
def test_squares_of_exposures_add_up(tasks: list[Task]) -> None:
    day = daily_exposure(tasks)
    assert day.a8**2 == pytest.approx(sum(task.partial**2 for task in tasks))
    assert sum(day.share(task) for task in tasks) == pytest.approx(1)
    assert min(t.acceleration for t in tasks) <= day.a_hv * (1 + 1e-12)
    assert day.a_hv <= max(t.acceleration for t in tasks) * (1 + 1e-12)


@given(TASKS, st.floats(0.1, 0.9))
def test_a_task_may_be_split_and_tasks_may_change_places(tasks: list[Task], part: float) -> None:
    whole, first = daily_exposure(tasks), tasks[0]
    halves = [
        Task("one", first.acceleration, part * first.duration),
        Task("other", first.acceleration, (1 - part) * first.duration),
    ]
    assert daily_exposure([*tasks[:0:-1], *halves]).a8 == pytest.approx(whole.a8)


@given(ACCELERATIONS, DURATIONS, st.floats(0.5, 3.0))
def test_twice_the_vibration_is_a_quarter_of_the_time(
    acceleration: float, duration: float, ratio: float
) -> None:
    first = Task("", acceleration, duration)
    other = Task("", acceleration * ratio, duration / ratio**2)
    assert other.partial == pytest.approx(first.partial)
    assert other.times.to_limit == pytest.approx(first.times.to_limit / ratio**2)


@given(ACCELERATIONS)
def test_the_japanese_time_is_that_until_the_limit_value(acceleration: float) -> None:
    """T = 200/a^2 hours is 8 h (5/a)^2."""
    assert limit_time(acceleration) == pytest.approx(time_to_reach(LIMIT, acceleration))
    times = Task("", acceleration, HOUR).times
    assert times.to_limit == pytest.approx(4 * times.to_action)
    assert times.japanese <= 2 * HOUR
