"""The frequency weighting Wh, in bands and exactly."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest

from equipoise.errors import UsageError
from equipoise.exposure.weighting import (
    EDGES,
    FASTEST,
    MIDDLES,
    NOMINAL,
    band_factors,
    exact_middles,
    factor,
    rms_in_bands,
    squared_factor,
    weighting,
)
from equipoise.handheld.chain import Dual
from support.refusals import refused

SPAN = np.geomspace(1e-3, 1e7, 400)


def tenth(count: int) -> Any:
    return mpmath.mpf(count) / 10


def in_fifty_digits(frequency: float) -> Any:
    """Magnitude of the product of the three complex filters, written anew."""
    with mpmath.workdps(50):
        f = mpmath.mpf(frequency)
        s, f1, f2 = 1j * f, mpmath.mpf(10) ** tenth(8), mpmath.mpf(10) ** tenth(31)
        f3, q1, q2 = 50 / mpmath.pi, 1 / mpmath.sqrt(2), mpmath.mpf("0.64")
        high = s**2 / (s**2 + f1 * s / q1 + f1**2)
        low = f2**2 / (s**2 + f2 * s / q1 + f2**2)
        return abs(high * low * (1 + s / f3) / (1 + s / q2 / f3 + s**2 / f3**2))


def test_the_complex_form_and_the_squared_form_are_one() -> None:
    np.testing.assert_allclose(np.abs(weighting(SPAN)) ** 2, squared_factor(SPAN**2), rtol=1e-13)
    np.testing.assert_allclose(np.abs(weighting(SPAN)), factor(SPAN), rtol=1e-14)


@pytest.mark.parametrize("frequency", [1e-3, 1.0, 6.3, 12.5, 80.0, 1250.0, 1e5])
def test_against_fifty_digits(frequency: float) -> None:
    assert float(factor(frequency)) == pytest.approx(float(in_fifty_digits(frequency)), rel=1e-14)


def test_many_digits_stay_many_digits() -> None:
    """Constants are floats, the arithmetic is not: two routes agree far beyond a float's digits."""
    with mpmath.workdps(40):
        f2 = mpmath.mpf(80) ** 2
        step = mpmath.mpf(10) ** -25
        change = squared_factor(f2 + step) - squared_factor(f2)
        slope = squared_factor(Dual(6400.0, np.ones(1))).slopes[0]
        assert float(change / step) == pytest.approx(slope, rel=1e-12)


def test_plain_numbers() -> None:
    whole, exact = squared_factor(6400), squared_factor(Fraction(6400))
    assert whole == pytest.approx(float(factor(80.0)) ** 2, rel=1e-15) == pytest.approx(exact)
    assert squared_factor(0) == 0


def test_numbers_that_carry_derivatives() -> None:
    for f2 in (40.0, 6400.0, 1e6):
        result = squared_factor(Dual(f2, np.ones(1)))
        assert result.value == pytest.approx(squared_factor(f2), rel=1e-15)
        step = 1e-4 * f2
        slope = (squared_factor(f2 + step) - squared_factor(f2 - step)) / (2 * step)
        assert result.slopes[0] == pytest.approx(slope, rel=1e-6)


def test_no_frequency_breaks_it() -> None:
    with np.errstate(all="raise", under="ignore"):
        ends = np.array([0.0, np.inf, -np.inf, 1e308, FASTEST, 1e-308])
        assert np.all(factor(ends) < 1e-50)
        assert np.all(np.abs(weighting(ends)) < 1e-50)
        assert np.all(np.isfinite(weighting(np.concatenate([-SPAN, SPAN, ends]))))


def test_any_shape() -> None:
    for shape in ((), (3,), (2, 3), (0,)):
        assert factor(np.full(shape, 80.0)).shape == weighting(np.full(shape, 80.0)).shape == shape
    assert factor([8, 16]).shape == (2,)


def test_negative_frequencies_are_conjugates() -> None:
    np.testing.assert_array_equal(weighting(-SPAN), np.conj(weighting(SPAN)))


@pytest.mark.parametrize("function", [factor, weighting])
def test_what_is_no_number_is_refused(function: Any) -> None:
    with refused(UsageError, place="frequency"):
        function([1.0, np.nan])


def test_limits() -> None:
    """Like f^2 at low frequencies; a velocity between; like f^-3 at high ones."""
    slope = np.diff(np.log(factor([0.01, 0.02, 90.0, 110.0, 1e5, 2e5]))) / np.log([2, 9e3 / 2])[0]
    assert slope[0] == pytest.approx(2, abs=1e-3)
    assert slope[4] == pytest.approx(-3, abs=1e-3)
    assert float(factor(100.0)) * 100 == pytest.approx(100 / (2 * np.pi), rel=0.02)


def test_middles_edges_and_names_belong_together() -> None:
    assert len(NOMINAL) == len(MIDDLES) == len(EDGES) - 1 == 24
    assert np.all((EDGES[:-1] < NOMINAL) & (EDGES[1:] > NOMINAL))
    np.testing.assert_allclose(EDGES[1:] / EDGES[:-1], 10**0.1)
    np.testing.assert_allclose(np.sqrt(EDGES[1:] * EDGES[:-1]), MIDDLES)
    np.testing.assert_allclose(NOMINAL, MIDDLES, rtol=0.012)


def test_nominal_and_exact_middles_are_taken() -> None:
    np.testing.assert_allclose(exact_middles(np.array(NOMINAL)), MIDDLES)
    np.testing.assert_allclose(exact_middles(MIDDLES), MIDDLES)


@pytest.mark.parametrize("wrong", [0.0, 5.0, 7.0, 70.0, 1600.0])
def test_other_frequencies_are_refused(wrong: float) -> None:
    with refused(UsageError, place="frequency", given=wrong):
        exact_middles(np.array([8.0, wrong]))


def test_factors_by_nominal_frequency() -> None:
    assert list(band_factors()) == list(NOMINAL)
    assert band_factors()[125.0] == float(factor(10**2.1))


def test_sums_in_bands() -> None:
    """Lines between the same edges add up; those outside are left out; an edge begins a band."""
    lines = np.array([1.0, 7.5, 8.5, float(EDGES[2]), 100.0, 1400.0, 1500.0])
    squares = np.array([[1.0, 9.0, 16.0, 4.0, 25.0, 36.0, 1.0], np.zeros(7)])
    result = rms_in_bands(lines, squares)
    assert result.shape == (2, 24)
    wanted = {8.0: 5.0, 10.0: 2.0, 100.0: 5.0, 1250.0: 6.0}
    assert {NOMINAL[k]: result[0, k] for k in np.flatnonzero(result[0])} == pytest.approx(wanted)
    assert not np.any(result[1])
