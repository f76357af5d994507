"""Figures and harmonics of periodic signals."""

from __future__ import annotations

from collections.abc import Callable
from math import pi, sqrt

import numpy as np
import pytest

import equipoise as eq
from equipoise import signals
from equipoise.errors import UsageError
from equipoise.signals import (
    LIFT,
    Figures,
    JumpSampling,
    Periodic,
    figures,
    harmonics,
    highest_at,
    panel_series,
    present,
    synthesis,
    tops_of_panels,
    within_period,
)
from support.refusals import refused

THETA = 2 * pi * np.arange(24) / 24


def test_figures_of_a_sine() -> None:
    result = figures(THETA, 1 + 3 * np.sin(THETA))
    assert result.mean == pytest.approx(1)
    assert result.rms == pytest.approx(sqrt(1 + 4.5))
    assert (result.max, result.max_at) == (pytest.approx(4), pytest.approx(pi / 2))
    assert (result.min, result.min_at) == (pytest.approx(-2), pytest.approx(3 * pi / 2))
    assert (result.peak, result.peak_at) == (result.max, result.max_at)
    assert result.peak_to_peak == pytest.approx(6)


def test_a_peak_may_be_a_minimum() -> None:
    result = figures(THETA, -1 + 3 * np.sin(THETA))
    assert (result.peak, result.peak_at) == (pytest.approx(4), pytest.approx(3 * pi / 2))
    assert result.peak == -result.min


@pytest.mark.parametrize("value", [2.5, 0.0, -2.5])
def test_figures_of_a_constant(value: float) -> None:
    result = figures(THETA, np.full(24, value))
    assert (result.mean, result.max, result.min) == (value, value, value)
    assert (result.rms, result.peak, result.peak_to_peak) == (abs(value), abs(value), 0.0)


def curve(count: int, of: Callable[[np.ndarray], np.ndarray], turns: int = 1) -> Figures:
    """Figures of a periodic function of the crank angle from so many samples in a turn."""
    theta = 2 * pi * np.arange(count * turns) / count
    return figures(theta, of(theta), 2 * pi * turns)


@pytest.mark.parametrize("phase", [0.0, 0.3, 0.5, 0.77])
@pytest.mark.parametrize("order", [1, 5, 20])
def test_extremes_lie_between_samples(order: int, phase: float) -> None:
    at = phase * 2 * pi / 360
    result = curve(360, lambda theta: 2 + 3 * np.cos(order * (theta - at)))
    error = 1e-12 + 5 * (2 * pi * order / 360) ** 9
    assert result.max == pytest.approx(5, abs=error)
    assert result.max_at == pytest.approx(at, abs=1e-4 * 2 * pi / 360)
    assert result.min == pytest.approx(-1, abs=error)
    assert result.peak_to_peak == pytest.approx(6, abs=2 * error)


def test_extremes_from_few_samples() -> None:
    result = curve(24, lambda theta: np.cos(theta - 0.1) + 0.2 * np.cos(2 * theta - 0.1))
    want = Periodic(np.array([0, np.exp(-0.1j), 0.2 * np.exp(-0.1j)])).figures
    assert result.max == pytest.approx(want.max, abs=1e-6)
    assert result.max_at == pytest.approx(want.max_at, abs=1e-5)


def test_extremes_of_several_turns() -> None:
    result = curve(360, lambda theta: np.cos(theta / 3 - 3.001), turns=3)
    assert (result.max, result.max_at) == (pytest.approx(1, abs=1e-13), pytest.approx(9.003))


@pytest.mark.parametrize("shift", np.linspace(0, 1, 21).tolist())
@pytest.mark.parametrize(
    "of",
    [
        lambda x: 1 - np.abs(x),  # a kink upwards
        lambda x: np.where(x > 0, 1 - x, 0.5 + x),  # a jump at the top
        lambda x: np.where(x > 0.001, 1.0, 0.0) - 0.01 * x,
        lambda x: np.maximum(np.cos(x), 0.9999),  # cut off
        lambda x: -np.abs(x),
    ],
)
def test_nothing_is_above_a_kink_or_a_jump(
    of: Callable[[np.ndarray], np.ndarray], shift: float
) -> None:
    """Wherever it lies between two samples."""
    at = (100 + shift) * 2 * pi / 360
    result = curve(360, lambda theta: of(theta - at))
    samples = of(2 * pi * np.arange(360) / 360 - at)
    assert np.max(samples) <= result.max <= max(np.max(of(np.linspace(-0.1, 0.1, 200001))), 0.0)
    assert 1e-6 >= result.min - np.min(samples) >= -1e-4


def test_the_size_of_a_vector_near_zero() -> None:
    """It has no kink but in the limit, and its square is smooth."""
    at = 0.4321
    for least in (0.0, 1e-5, 1e-3, 0.1):
        result = curve(360, lambda theta, least=least: np.hypot(np.sin(theta - at), least))
        assert result.min == pytest.approx(least, abs=1e-8)
        assert np.sin(result.min_at - at) == pytest.approx(0, abs=1e-6)


def test_of_equal_extremes_the_first() -> None:
    """Also where one is nearer to a sample than the other."""
    result = curve(90, lambda theta: np.cos(4 * theta - 0.2))
    assert result.max_at == pytest.approx(0.05)
    assert result.min_at == pytest.approx(0.05 + pi / 4)
    assert result.peak_at == pytest.approx(0.05)
    shifted = curve(90, lambda theta: np.sin(theta - 0.01) * np.cos(theta - 0.01))
    assert shifted.peak_at == pytest.approx(0.01 + pi / 4)


def test_a_top_that_is_a_sample_stays_there() -> None:
    for order in (1, 2, 6):
        result = curve(360, lambda theta, order=order: np.cos(order * theta))
        assert (result.max, result.max_at) == (1.0, 0.0)


def test_extremes_of_what_is_not_finite() -> None:
    samples = np.tan(THETA / 2)
    samples[12] = np.inf
    result = figures(THETA, samples, 2 * pi)
    assert (result.max, result.max_at) == (np.inf, pi)
    assert result.min == pytest.approx(np.min(samples))


def test_extremes_between_jumps() -> None:
    """A top within a piece, one at the jump itself, and a kink where a slope is known to jump."""
    jumps, bends = np.array([1.0, 4.0]), np.array([4.7])

    def of(theta: np.ndarray) -> np.ndarray:
        bent = np.where(theta < 4.7, theta - 4.7, 2 * (4.7 - theta))
        inside = np.where(theta < 4.0, np.cos(3 * (theta - 2.3456)), 3 + bent)
        return np.where(theta < 1.0, theta, inside)

    grid = 2 * pi * np.arange(60) / 60
    sampling = JumpSampling.of(grid, 1, jumps, bends)
    every = np.array([of(sampling.crank_angle), np.minimum(of(sampling.crank_angle), 1.5)])
    actual, cut = sampling.figures_of_each(every)
    assert (actual.max, actual.max_at) == (pytest.approx(3, abs=1e-9), pytest.approx(4.7, abs=1e-9))
    assert actual.min == pytest.approx(-1, abs=1e-9)
    assert actual.min_at == pytest.approx(2.3456 - pi / 3, abs=1e-6)
    assert cut.max == pytest.approx(1.5, rel=1e-12)


def test_a_smooth_panel_exceeds_its_samples_by_little() -> None:
    """`LIFT` of a panel's range, within which its top is looked for, is twice what curves need."""
    _, nodes, *_ = panel_series()
    phase = np.linspace(0, 2 * pi, 100)[:, None]
    excesses = []
    for pace in np.linspace(0.05, 4, 40):
        for curve in (
            lambda x, pace=pace: np.cos(pace * x + phase),
            lambda x, pace=pace: np.exp(-pace * x**2) * np.cos(phase + x),
            lambda x, pace=pace: np.sqrt(1.02 + np.cos(pace * x / 2 + phase)),
        ):
            values = curve(nodes)
            highest = np.max(values, axis=1)
            top, _ = tops_of_panels(values)
            excesses.append((top - highest) / (highest - np.min(values, axis=1)))
    assert 0.02 < np.max(excesses) < LIFT / 2


def test_figures_are_plain_numbers() -> None:
    assert {type(value) for value in vars(figures(THETA, np.sin(THETA))).values()} == {float}


def test_phase_convention() -> None:
    """y = Re sum Y_n exp(i n theta): Re Y_n goes with the cosine, minus Im Y_n with the sine."""
    result = harmonics(5 + 2 * np.cos(THETA) - 3 * np.sin(THETA) + 0.5 * np.sin(4 * THETA))
    want = np.zeros(13, complex)
    want[[0, 1, 4]] = 5, 2 + 3j, -0.5j
    np.testing.assert_allclose(result, want, atol=1e-14)


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
    first, two = (harmonics(result.shaking_force.x, 6) for result in (coarse, fine))
    np.testing.assert_allclose(first, two, rtol=0, atol=1e-10 * np.max(np.abs(two)))
    assert abs(first[0]) < 1e-12 * np.max(np.abs(two))


# -- periodic signals by their orders --------------------------------------------------------------


def periodic(
    seed: int = 0, orders: int = 9, turns: int = 1, shape: tuple[int, ...] = ()
) -> Periodic:
    """Make a signal of random orders that fall off, and so has one highest point."""
    rng = np.random.default_rng(seed)
    size = (*shape, orders + 1)
    amplitudes = (rng.normal(size=size) + 1j * rng.normal(size=size)) / 1.5 ** np.arange(orders + 1)
    amplitudes[..., 0] = amplitudes[..., 0].real
    return Periodic(amplitudes, turns)


def same(result: Periodic, wanted: Periodic, tolerance: float = 1e-13) -> None:
    """Compare signals order by order, where one may have fewer."""
    assert result.turns == wanted.turns
    orders = max(result.amplitudes.shape[-1], wanted.amplitudes.shape[-1])
    theta = result.period * np.arange(2 * orders + 1) / (2 * orders + 1)
    np.testing.assert_allclose(result.values(theta), wanted.values(theta), rtol=0, atol=tolerance)


SHAPES = pytest.mark.parametrize("shape", [(), (3,), (2, 3)])
TURNS = pytest.mark.parametrize("turns", [1, 2, 3])


@SHAPES
@TURNS
@pytest.mark.parametrize("count", [19, 20, 64])
def test_samples_and_back(shape: tuple[int, ...], turns: int, count: int) -> None:
    """19 samples just hold 9 orders apart."""
    signal = periodic(turns=turns, shape=shape)
    samples = signal.samples(count)
    theta = np.arange(count) * 2 * pi * turns / count
    np.testing.assert_allclose(samples, signal.values(theta), rtol=0, atol=1e-13)
    same(Periodic.of(samples, turns), signal)


def test_fewer_samples_than_orders_are_still_values() -> None:
    signal = periodic(orders=9)
    for count in (1, 2, 5, 18):
        theta = np.arange(count) * 2 * pi / count
        np.testing.assert_allclose(signal.samples(count), signal.values(theta), atol=1e-13)


def test_orders_of_several_turns_are_fractions() -> None:
    """An event in one of three turns has order 1/3."""
    theta = np.arange(300) * 6 * pi / 300
    signal = Periodic.of(2 * np.cos(theta / 3) + np.sin(theta) + 0.5 * np.cos(4 * theta / 3), 3)
    assert signal.period == pytest.approx(6 * pi)
    np.testing.assert_allclose(signal.orders, np.arange(5) / 3)
    np.testing.assert_allclose(signal.sizes, [0, 2, 0, 1, 0.5], atol=1e-13)


def test_rounding_is_left_out() -> None:
    """Orders of 1e-16 of the largest are what the transform leaves; one of 1e-12 is not."""
    assert Periodic.of(3 + np.cos(2 * THETA)).amplitudes.shape == (3,)
    assert Periodic.of(3 + np.cos(2 * THETA) + 1e-12 * np.cos(7 * THETA)).amplitudes.shape == (8,)
    assert Periodic.of(np.zeros(24)).amplitudes == pytest.approx([0])


def test_an_order_counts_if_any_signal_of_a_stack_has_it() -> None:
    result = Periodic.of(np.stack([np.cos(THETA), np.sin(5 * THETA)]))
    np.testing.assert_allclose(result.sizes, [[0, 1, 0, 0, 0, 0], [0, 0, 0, 0, 0, 1]], atol=1e-14)


def test_order_at_half_the_number_of_samples_is_left_out() -> None:
    """24 samples of sin 12 theta are all zero: what they tell of order 12 is not its amplitude."""
    result = Periodic.of(np.cos(THETA) + 0.7 * np.cos(12 * THETA))
    assert result.amplitudes.shape[-1] <= 12
    np.testing.assert_allclose(result.sizes[:2], [0, 1], atol=1e-14)


@pytest.mark.parametrize("phase", [0.3, -2.0, 40.0])
@TURNS
def test_shift(phase: float, turns: int) -> None:
    signal, theta = periodic(turns=turns, shape=(2,)), np.linspace(-3, 9, 17)
    np.testing.assert_allclose(
        signal.shifted(phase).values(theta), signal.values(theta + phase), rtol=0, atol=1e-12
    )
    assert signal.shifted(phase).turns == turns
    np.testing.assert_allclose(signal.shifted(phase).rms_by_order, signal.rms_by_order)


@TURNS
def test_shift_by_a_period_changes_nothing(turns: int) -> None:
    signal = periodic(turns=turns)
    for periods in (1, -1, 5):
        same(signal.shifted(periods * signal.period), signal)


def test_shift_by_one_of_two_turns_is_none_by_a_period() -> None:
    signal = Periodic(np.array([0.0, 1.0 + 0j]), 2)
    same(signal.shifted(2 * pi), -signal)


@pytest.mark.parametrize("units", [2, 3, 4])
def test_units_with_equal_phases_between_them(units: int) -> None:
    """Of n units one behind the other only every n-th order is left, n times as large."""
    signal = periodic(orders=12)
    total = periodic() * 0.0
    for k in range(units):
        total = total + signal.shifted(2 * pi * k / units)
    left = total.amplitudes
    kept = np.arange(13) % units == 0
    np.testing.assert_allclose(left[kept], units * signal.amplitudes[kept], rtol=1e-13)
    assert np.max(np.abs(left[~kept])) < 1e-13


def test_units_in_phase() -> None:
    signal = periodic()
    same(signal + signal, 2 * signal)
    same(signal - signal, 0.0 * signal)
    same(signal + -signal, signal * 0.0)


def test_sum_of_signals_with_other_numbers_of_orders() -> None:
    first, other, theta = periodic(1, orders=3), periodic(2, orders=8), np.linspace(0, 6, 11)
    for total in (first + other, other + first):
        np.testing.assert_allclose(total.values(theta), first.values(theta) + other.values(theta))


def test_signals_of_other_numbers_of_turns_do_not_add_up() -> None:
    with refused(UsageError, turns=1, turns_2=2):
        periodic() + periodic(turns=2)


@TURNS
@SHAPES
def test_derivatives_against_differences(turns: int, shape: tuple[int, ...]) -> None:
    """Central differences over h miss by h^2 / 6 of the third derivative, here up to some 1e3."""
    signal, theta, h = periodic(turns=turns, shape=shape), np.linspace(0, 12, 23), 1e-4
    for times in (1, 2):
        before, after = (signal.derivative(times - 1).values(theta + d) for d in (-h, h))
        values = signal.derivative(times).values(theta)
        np.testing.assert_allclose(values, (after - before) / (2 * h), rtol=0, atol=1e-5)
    same(signal.derivative(2), signal.derivative().derivative(), 1e-11)


@TURNS
def test_integral_undoes_the_derivative_but_for_the_mean(turns: int) -> None:
    signal = periodic(turns=turns)
    back = signal.derivative().derivative(-1)
    theta = np.linspace(0, 6, 11)
    np.testing.assert_allclose(back.values(theta), signal.values(theta) - signal.mean, atol=1e-13)
    same(signal.derivative(-2), signal.derivative(-1).derivative(-1))
    same(signal.derivative(0), signal)


@SHAPES
@TURNS
def test_rms_by_order_adds_up(shape: tuple[int, ...], turns: int) -> None:
    """Parseval: squares of the orders' RMS add up to the mean square."""
    signal = periodic(turns=turns, shape=shape)
    samples = signal.samples(50)
    np.testing.assert_allclose(signal.rms, np.sqrt(np.mean(samples**2, axis=-1)))
    np.testing.assert_allclose(signal.vibration_rms, np.std(samples, axis=-1))
    np.testing.assert_allclose(signal.mean, np.mean(samples, axis=-1), rtol=0, atol=1e-14)
    assert np.shape(signal.rms) == shape


def test_phases_are_those_of_sines() -> None:
    signal = periodic()
    theta = np.linspace(0, 7, 31)
    n = np.arange(10)[:, None]
    sines = signal.sizes[:, None] * np.sin(n * theta + signal.phases[:, None])
    np.testing.assert_allclose(np.sum(sines, axis=0), signal.values(theta), rtol=0, atol=1e-13)
    sine = Periodic.of(4 * np.sin(3 * THETA + 0.8))
    assert sine.phases[3] == pytest.approx(0.8)


@pytest.mark.parametrize("seed", range(12))
@TURNS
def test_extremes_against_dense_sampling(seed: int, turns: int) -> None:
    """200 000 samples in a period miss a top by half of (step / 2)^2 times the curvature, 1e-8."""
    signal = periodic(seed, turns=turns)
    theta = np.arange(200_000) * signal.period / 200_000
    samples = signal.values(theta)
    for sign, extreme, at in (
        (1, np.max(samples), theta[np.argmax(samples)]),
        (-1, np.min(samples), theta[np.argmin(samples)]),
    ):
        value, angle = signal.extreme(sign)
        assert -1e-12 < sign * (value - extreme) < 1e-7
        away = (angle - at + signal.period / 2) % signal.period - signal.period / 2
        assert abs(away) < 1e-3
        assert 0 <= angle < signal.period
        assert signal.values(np.array([angle]))[0] == pytest.approx(float(value), abs=1e-12)
    peak_to_peak = signal.peak_to_peak
    assert peak_to_peak == pytest.approx(np.max(samples) - np.min(samples), abs=1e-7)


@SHAPES
def test_extremes_of_a_stack_are_those_of_each(shape: tuple[int, ...]) -> None:
    stack = periodic(shape=shape)
    value, at = stack.extreme(1)
    assert np.shape(value) == np.shape(at) == shape
    for index in np.ndindex(shape):
        first = Periodic(stack.amplitudes[index])
        assert (value[index], at[index]) == pytest.approx(tuple(map(float, first.extreme(1))))


def test_extremes_of_a_sine_to_the_digit() -> None:
    signal = Periodic.of(1 + 3 * np.sin(THETA - 0.2345))
    assert signal.extreme(1) == pytest.approx((4, pi / 2 + 0.2345), abs=1e-14)
    assert signal.extreme(-1) == pytest.approx((-2, 3 * pi / 2 + 0.2345), abs=1e-14)


@pytest.mark.parametrize("value", [2.5, 0.0, -2.5])
def test_extremes_of_a_constant(value: float) -> None:
    signal = Periodic.of(np.full(24, value))
    assert (float(signal.extreme(1)[0]), float(signal.extreme(-1)[0])) == (value, value)
    assert signal.peak_to_peak == 0
    assert signal.vibration_rms == 0


def test_extremes_of_a_flat_top() -> None:
    """At the top of cos t - cos 2 t / 4 the second derivative vanishes: Newton's method stalls."""
    signal = Periodic(np.array([0, 1, -0.25 + 0j]))
    assert float(signal.extreme(1)[0]) == pytest.approx(0.75, abs=1e-14)


def test_amplitudes_up_to_an_order() -> None:
    signal = periodic(orders=9, turns=2)
    assert [signal.count_to(order) for order in (0, 1, 4, 9)] == [1, 3, 9, 10]


# -- equal extremes --------------------------------------------------------------------------------

TURN = np.arange(720) * (2 * np.pi / 720)


@pytest.mark.parametrize("noise", range(5))
@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
def test_of_equal_extremes_the_first_is_reported(noise: int, size: float) -> None:
    """Rounding, here made larger, decides neither between tops nor between a top and a dip."""
    rng = np.random.default_rng(noise)
    rounding = 1 + 1e-14 * rng.standard_normal(TURN.size)
    result = figures(TURN, size * np.sin(3 * TURN) * rounding)
    assert result.max_at == pytest.approx(np.pi / 6)
    assert result.min_at == pytest.approx(np.pi / 2)
    assert result.peak_at == pytest.approx(np.pi / 6)
    turned = figures(TURN, -size * np.sin(3 * TURN) * rounding)
    assert turned.peak_at == pytest.approx(np.pi / 6)
    still = figures(TURN, np.full(720, size) * rounding)
    assert (still.max_at, still.min_at, still.peak_at) == (0.0, 0.0, 0.0)


def test_a_higher_top_is_reported_wherever_it_is() -> None:
    samples = np.sin(3 * TURN) + 1e-6 * np.sin(TURN - 1.0)
    result = figures(TURN, samples)
    assert result.max == np.max(samples)
    assert result.max_at == TURN[np.argmax(samples)]


def test_near_a_flat_top_its_own_angle_is_reported() -> None:
    """On a fine grid neighbours of the top are nearly as high as it."""
    fine = np.linspace(0.0, 2 * np.pi, 400_001)
    assert figures(fine, np.cos(fine - 2.0)).max_at == pytest.approx(2.0, abs=2e-5)


def test_of_a_top_and_a_bottom_that_are_equal_the_first_is_the_peak() -> None:
    """Equal is what differs by less than a share of the range between them, as in loops."""
    samples = np.array([0.0, -1.0, 0.0, 1.0 + 1.5e-9, 0.0])
    theta = np.arange(5.0)
    assert figures(theta, samples).peak_at == 1.0
    assert figures(theta, -samples).peak_at == 1.0
    samples[3] = 1.0 + 3e-9
    assert figures(theta, samples).peak_at == 3.0
    assert figures(theta, samples).peak == samples[3]


def test_an_extreme_between_samples_is_that_of_the_first_top() -> None:
    signal = Periodic(np.array([0.0, 0.0, 0.0, np.exp(-0.3j)]))
    assert signal.extreme(1)[1] == pytest.approx(0.1)
    assert signal.extreme(-1)[1] == pytest.approx(0.1 + np.pi / 3)
    at_zero = Periodic(np.array([0.0, 1.0 + 1e-17j]))
    assert at_zero.extreme(1)[1] == 0.0


@pytest.mark.parametrize(
    ("values", "at"),
    [
        ([1.0, 3.0, 3.0 + 1e-13, 2.0], 1),
        ([-np.inf, 2.0, 1.0], 1),
        ([0.0, np.inf, 1.0], 1),
        ([1.0, np.nan, 2.0], 1),
        ([0.0, 0.0], 0),
    ],
)
def test_highest_of_any_values(values: list[float], at: int) -> None:
    assert highest_at(np.array(values), smooth=False) == at
    assert highest_at(np.array(values)) == at


def test_angles_short_of_a_period_by_rounding_are_zero() -> None:
    given = np.array([-1e-17, 2 * np.pi, 7.0, -1.0])
    np.testing.assert_allclose(
        within_period(given, 2 * np.pi), [0, 0, 7 - 2 * np.pi, 2 * np.pi - 1]
    )


# -- of very many orders ---------------------------------------------------------------------------


def test_samples_of_more_orders_than_they_report_apart() -> None:
    """A sum over orders, angle by angle, comes to the same."""
    random = np.random.default_rng(7)
    signal = Periodic(random.normal(size=(2, 23)) + 1j * random.normal(size=(2, 23)), 3)
    for count in (4, 7, 8, 45, 46, 60):
        theta = np.arange(count) * (signal.period / count)
        assert signal.samples(count) == pytest.approx(signal.values(theta), abs=1e-12)


def test_signals_in_parts_are_those_of_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(8)
    signal = Periodic(random.normal(size=(3, 2, 11)) + 1j * random.normal(size=(3, 2, 11)), 2)
    theta = np.linspace(0, 9, 37)
    values, extremes = signal.values(theta), signal.extreme(1)
    monkeypatch.setattr(signals, "AT_ONCE", 25)
    assert signal.values(theta) == pytest.approx(values, abs=1e-12)
    assert np.array_equal(signal.extreme(1)[0], extremes[0])
    assert signal.values(np.empty(0)).shape == (3, 2, 0)


def test_orders_that_are_rounding_of_each_signal_are_left_out() -> None:
    """A small signal keeps what is large in it, beside a large one."""
    amplitudes = np.zeros((3, 40), complex)
    amplitudes[0, [0, 7, 30]] = 1.0, 2j, 1e-15
    amplitudes[1, [7, 31]] = 1e-20, 1e-35
    result = Periodic(amplitudes, 5).without_rounding()
    assert present(result.amplitudes).tolist() == [0, 7]
    theta = np.linspace(0, 31, 60)
    waves = np.array([1 + (2j * np.exp(1.4j * theta)).real, 1e-20 * np.cos(1.4 * theta)])
    assert result.values(theta)[:2] == pytest.approx(waves, rel=1e-12, abs=1e-33)
    assert not result.values(theta)[2].any()


def test_orders_above_the_last_are_nothing() -> None:
    result = Periodic.of(np.cos(3 * np.arange(64) * 2 * pi / 64)[None])
    assert result.amplitude(3) == pytest.approx(np.ones(1))
    assert result.amplitudes.shape == (1, 4)
    np.testing.assert_array_equal(result.amplitude(4), np.zeros(1))
