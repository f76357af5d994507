"""Where signals vanish or turn: against answers known in closed form and against brute force."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from equipoise.mechanism.kinematics.tip import crossings, largest, lowest_within, roots, smallest

Array = np.ndarray[Any, Any]

TURN = 2 * np.pi
GRID = np.arange(720) * (TURN / 720)
FINE = np.linspace(0.0, TURN, 200_001)
ENDS = np.append(GRID, TURN)


def harmonics(seed: int, machines: int = 1) -> Any:
    """A sum of six random harmonics for each machine, and its derivative."""
    rng = np.random.default_rng(seed)
    orders = np.arange(1, 7)
    amplitudes = rng.normal(size=(machines, 6)) + 1j * rng.normal(size=(machines, 6))

    def signal(theta: Any, order: int = 0) -> Any:
        waves = np.exp(1j * orders * np.asarray(theta)[..., None])
        return np.sum(amplitudes[:, None] * (1j * orders) ** order * waves, axis=-1).real

    return signal, lambda theta: signal(theta, 1)


# -- roots -----------------------------------------------------------------------------------------


def test_roots_of_many_brackets_at_once() -> None:
    """Zeros of the cosine, shifted from machine to machine."""
    shift = np.array([[0.0], [0.3], [-0.2]])
    low = np.array([[1.0, 4.0]] * 3)
    result = roots(lambda theta: np.cos(theta - shift), low, low + 1.2)
    np.testing.assert_allclose(result, np.array([[0.5, 1.5]]) * np.pi + shift, rtol=1e-15)


def test_a_root_of_high_order_is_found() -> None:
    result = roots(lambda x: (x - 0.3) ** 3, np.array([[0.0]]), np.array([[1.0]]))
    assert result[0, 0] == pytest.approx(0.3, abs=1e-4)


@pytest.mark.parametrize("zero", [1.0, 2.0])
def test_a_root_at_an_end(zero: float) -> None:
    result = roots(lambda x: x - zero, np.array([[1.0]]), np.array([[2.0]]))
    assert result[0, 0] == zero


def test_without_a_root_the_nearer_end_comes_back() -> None:
    """For a bracket without a change of sign, while another one beside it is solved."""
    low, high = np.array([[1.0, 0.0, 2.0]]), np.array([[2.0, 1.0, 1.0]])
    result = roots(lambda x: x - 0.25, low, high)
    np.testing.assert_allclose(result, [[1.0, 0.25, 1.0]], rtol=1e-15)


# -- crossings -------------------------------------------------------------------------------------


def test_every_crossing_once_and_rising() -> None:
    result = crossings(lambda theta: np.sin(5 * theta - 0.4), ENDS)
    np.testing.assert_allclose(result, (np.arange(10) * np.pi + 0.4) / 5, atol=1e-15)


def test_crossings_of_a_random_signal_by_brute_force() -> None:
    signal, _ = harmonics(3)
    result = crossings(signal, ENDS)
    values = signal(FINE[None])[0]
    k = np.flatnonzero(np.sign(values[1:]) != np.sign(values[:-1]))
    assert len(result) == len(k) > 3
    assert np.all((FINE[k] <= result) & (result <= FINE[k + 1]))
    assert np.max(np.abs(signal(result[None]))) < 1e-13


def test_a_signal_that_never_vanishes_has_no_crossing() -> None:
    assert crossings(lambda theta: 2 + np.sin(theta), ENDS).size == 0


# -- largest and smallest --------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(5))
def test_extremes_of_random_signals_by_brute_force(seed: int) -> None:
    """Three machines at once; the finest sample lies within (its step)^2 of the extreme."""
    signal, slope = harmonics(seed, 3)
    samples = signal(np.broadcast_to(GRID, (3, 720)))
    many = signal(np.broadcast_to(FINE, (3, len(FINE))))
    scale = np.max(np.abs(many))
    for find, best, sign in ((largest, np.argmax, 1), (smallest, np.argmin, -1)):
        value, at = find(signal, slope, GRID, samples)
        k = best(many, axis=1)
        brute = many[np.arange(3), k]
        assert np.all(sign * (value - brute) >= -1e-14 * scale)
        assert np.all(np.abs(value - brute) < 1e-7 * scale)
        np.testing.assert_allclose(at % TURN, FINE[k], atol=TURN / 200_000)
        assert np.max(np.abs(slope(at[:, None]))) < 1e-11 * scale
        np.testing.assert_allclose(signal(at[:, None])[:, 0], value, rtol=1e-15)


def test_the_highest_sample_need_not_lie_by_the_highest_top() -> None:
    """One of two tops lies on a sample; the other, a little higher, between two."""
    half_step = GRID[1] / 2

    def phase(theta: Any) -> Any:
        return 2 * theta + half_step * (1 - np.cos(theta))

    def signal(theta: Any) -> Any:
        return np.cos(phase(theta)) - 1e-6 * np.cos(theta)

    def slope(theta: Any) -> Any:
        turning = 2 + half_step * np.sin(theta)
        return -np.sin(phase(theta)) * turning + 1e-6 * np.sin(theta)

    samples = signal(GRID[None])
    assert np.argmax(samples[0]) == 0
    value, at = largest(signal, slope, GRID, samples)
    assert at[0] == pytest.approx(np.pi - half_step, abs=1e-4)
    assert value[0] == pytest.approx(1 + 1e-6, abs=1e-10)


def test_a_top_at_the_seam_of_the_period() -> None:
    for top in (-1e-4, 0.0, 1e-4):
        value, at = largest(lambda x, t=top: np.cos(x - t), lambda x, t=top: -np.sin(x - t), GRID,
                            np.cos(GRID[None] - top))  # fmt: skip
        assert value[0] == 1.0
        assert at[0] == pytest.approx(top, abs=1e-14)


def test_a_constant_signal_has_its_value_anywhere() -> None:
    constant = np.full((2, 720), 3.0)
    value, at = largest(lambda x: np.full(x.shape, 3.0), np.zeros_like, GRID, constant)
    assert np.all(value == 3.0)
    assert np.all(np.isfinite(at))


def test_a_kink_at_the_top_is_not_missed() -> None:
    """Where the slope jumps, the sample may be the best there is, and the value is no lower."""
    samples = -np.abs(GRID[None] - GRID[100])
    value, at = largest(lambda x: -np.abs(x - GRID[100]), lambda x: np.sign(GRID[100] - x), GRID,
                        samples)  # fmt: skip
    assert value[0] == pytest.approx(0.0, abs=1e-12)
    assert at[0] == pytest.approx(GRID[100], abs=1e-12)


# -- within a range --------------------------------------------------------------------------------


def test_lowest_within_finds_kinks_turning_points_and_ends() -> None:
    """Three machines: a kink, a smooth bottom, and one that falls to the end of the range."""
    low, high = np.zeros(3), np.full(3, 2.0)

    def signal(x: Any) -> Any:
        rows = np.abs(x[:1] - 0.777), np.square(x[1:2] - 1.3), -x[2:3]
        return np.concatenate(rows)

    value, at = lowest_within(signal, low, high)
    np.testing.assert_allclose(value, [0.0, 0.0, -2.0], atol=2e-9)
    np.testing.assert_allclose(at, [0.777, 1.3, 2.0], atol=1e-8)


def test_a_range_may_run_backwards() -> None:
    value, at = lowest_within(np.cos, np.array([4.0]), np.array([1.0]))
    assert value[0] == pytest.approx(-1.0, abs=1e-15)
    assert at[0] == pytest.approx(np.pi, abs=1e-7)


def test_a_signal_may_be_infinite_in_part() -> None:
    """The lowest place lies where the signal ends."""
    result = lowest_within(lambda x: np.where(x > 0.6, x, np.inf), np.zeros(1), np.ones(1))
    assert result[0][0] == pytest.approx(0.6, abs=1e-8)
    assert result[1][0] == result[0][0]


@pytest.mark.parametrize("seed", range(5))
def test_lowest_within_a_part_of_a_random_signal(seed: int) -> None:
    signal, _ = harmonics(seed)
    value, at = lowest_within(signal, np.array([1.0]), np.array([2.5]))
    brute = signal(np.linspace(1.0, 2.5, 100_001)[None])[0].min()
    assert brute - 1e-7 < value[0] <= brute + 1e-14
    assert signal(at[:, None])[0, 0] == value[0]
    assert 1.0 <= at[0] <= 2.5


@pytest.mark.parametrize("noise", range(4))
def test_of_equal_tops_the_first_is_reported(noise: int) -> None:
    """Five equal tops, more than are followed, whose samples differ by rounding."""
    rng = np.random.default_rng(noise)
    theta = np.linspace(0.0, 2 * np.pi, 360, endpoint=False)

    def signal(x: Array) -> Array:
        return np.cos(5 * x - 1.0) * (1 + 1e-14 * rng.standard_normal(np.shape(x)))

    def slope(x: Array) -> Array:
        return -np.sin(5 * x - 1.0)

    for find, at in ((largest, 0.2), (smallest, 0.2 + np.pi / 5)):
        value, angle = find(signal, slope, theta, signal(theta[None]))
        assert abs(value[0]) == pytest.approx(1.0)
        assert angle[0] == pytest.approx(at, abs=1e-6)
