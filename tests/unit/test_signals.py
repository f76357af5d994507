"""Figures and harmonics of periodic signals."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

import equipoise as eq
from equipoise.signals import figures, harmonics, synthesis

THETA = 2 * pi * np.arange(24) / 24


def test_figures_of_a_sine() -> None:
    found = figures(THETA, 1 + 3 * np.sin(THETA))
    assert found.mean == pytest.approx(1)
    assert found.rms == pytest.approx(sqrt(1 + 4.5))
    assert (found.max, found.max_at) == (pytest.approx(4), pytest.approx(pi / 2))
    assert (found.min, found.min_at) == (pytest.approx(-2), pytest.approx(3 * pi / 2))
    assert (found.peak, found.peak_at) == (found.max, found.max_at)
    assert found.peak_to_peak == pytest.approx(6)


def test_a_peak_may_be_a_minimum() -> None:
    found = figures(THETA, -1 + 3 * np.sin(THETA))
    assert (found.peak, found.peak_at) == (pytest.approx(4), pytest.approx(3 * pi / 2))
    assert found.peak == -found.min


@pytest.mark.parametrize("value", [2.5, 0.0, -2.5])
def test_figures_of_a_constant(value: float) -> None:
    found = figures(THETA, np.full(24, value))
    assert (found.mean, found.max, found.min) == (value, value, value)
    assert (found.rms, found.peak, found.peak_to_peak) == (abs(value), abs(value), 0.0)


def test_figures_are_plain_numbers() -> None:
    assert {type(value) for value in vars(figures(THETA, np.sin(THETA))).values()} == {float}


def test_phase_convention() -> None:
    """y = Re sum Y_n exp(i n theta): Re Y_n goes with the cosine, minus Im Y_n with the sine."""
    found = harmonics(5 + 2 * np.cos(THETA) - 3 * np.sin(THETA) + 0.5 * np.sin(4 * THETA))
    want = np.zeros(13, complex)
    want[[0, 1, 4]] = 5, 2 + 3j, -0.5j
    np.testing.assert_allclose(found, want, atol=1e-14)


@pytest.mark.parametrize("count", [1, 2, 3, 8, 9, 24, 25])
def test_harmonics_add_up_to_the_signal(count: int) -> None:
    samples = np.random.default_rng(count).normal(size=(3, count))
    theta = 2 * pi * np.arange(count) / count
    amplitudes = harmonics(samples)
    assert amplitudes.shape == (3, count // 2 + 1)
    np.testing.assert_allclose(synthesis(amplitudes, theta), samples, atol=1e-13)


@pytest.mark.parametrize("count", [8, 9])
def test_energy_is_that_of_the_harmonics(count: int) -> None:
    samples = np.random.default_rng(count).normal(size=count)
    amplitudes = harmonics(samples)
    power = np.abs(amplitudes) ** 2 / 2
    power[0] *= 2
    if count % 2 == 0:
        power[-1] *= 2
    assert power.sum() == pytest.approx(np.mean(samples**2))


def test_highest_order() -> None:
    samples = np.random.default_rng(0).normal(size=24)
    np.testing.assert_array_equal(harmonics(samples, 3), harmonics(samples)[:4])
    assert harmonics(samples, 0) == pytest.approx(samples.mean())


def test_a_cosine_at_half_the_number_of_samples() -> None:
    amplitudes = harmonics(np.cos(12 * THETA))
    assert amplitudes[12] == pytest.approx(1)


def test_synthesis_anywhere() -> None:
    theta = np.array([0.1, 2.0, 7.7])
    got = synthesis(np.array([1.0, 2 - 1j, 0.5j]), theta)
    want = 1 + 2 * np.cos(theta) + np.sin(theta) - 0.5 * np.sin(2 * theta)
    np.testing.assert_allclose(got, want)


@pytest.mark.parametrize("name", ["yamashita-1", "scotch-yoke", "watt-six-bar"])
def test_harmonics_of_a_machine_converge(name: str) -> None:
    """A turn is periodic: a coarse sampling tells the same low orders as a fine one."""
    coarse, fine = (eq.analyze(eq.load(name), count).forces for count in (240, 960))
    one, two = (harmonics(found.shaking_force.x, 6) for found in (coarse, fine))
    np.testing.assert_allclose(one, two, rtol=0, atol=1e-10 * np.max(np.abs(two)))
    assert abs(one[0]) < 1e-12 * np.max(np.abs(two))
