"""Measures of signals: what a cone program holds down is what is read off the solution.

The program's value and the measure read off its solution agree to 1e-8 of the value.
"""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.effects import Signal
from equipoise.balancing.objectives import bound_measure, mean_square_rows, measured, unit_of
from equipoise.balancing.program import Affine, Program
from equipoise.mechanism.balance import MEASURES, Measure, Objective

N = 96
ANGLE = np.arange(N) * (2 * pi / N)
SEEDS = pytest.mark.parametrize("seed", [0, 1, 2])


def random_signal(seed: int, is_vector: bool, count: int = 3, turns: int = 1) -> Signal:
    """Orders 0 to 4 with random amplitudes."""
    rng = np.random.default_rng(seed)
    orders = np.arange(-4, 5)
    sizes = rng.normal(size=(count + 1, 9)) + 1j * rng.normal(size=(count + 1, 9))
    both = sizes @ np.exp(1j * np.outer(orders, ANGLE))
    both = both if is_vector else both.real
    return Signal(both[0], both[1:], turns)


def solved(signal: Signal, measure: Measure) -> tuple[float, np.ndarray]:
    """The least measure by the program, and the numbers."""
    program = Program()
    numbers, term = program.numbers(len(signal.columns)), program.numbers(1)
    bound_measure(program, numbers, signal, measure, Affine.of(term, 1.0))
    program.cost = {int(term[0]): 1.0}
    found = program.solve()
    return found.value, found.x[numbers]


KINDS = [
    *((measure, False) for measure in MEASURES),
    *((measure, True) for measure in ("rms", "ripple", "peak")),
]


@SEEDS
@pytest.mark.parametrize(("measure", "is_vector"), KINDS)
def test_a_bound_is_the_measure(seed: int, measure: Measure, is_vector: bool) -> None:
    """And random steps from the solution make it larger."""
    signal = random_signal(seed, is_vector)
    value, numbers = solved(signal, measure)
    assert value == pytest.approx(measured(signal.at(numbers), measure), rel=1e-8)
    assert value < measured(signal.start, measure)
    for step in np.random.default_rng(9).normal(size=(20, 3)):
        assert measured(signal.at(numbers + 1e-2 * step), measure) >= value * (1 - 1e-9)


@pytest.mark.parametrize(("measure", "is_vector"), KINDS)
def test_a_limit_is_kept_and_has_its_price(measure: Measure, is_vector: bool) -> None:
    """The first number as large as it can be: its price is a difference of two programs."""
    signal = random_signal(5, is_vector)
    least, _ = solved(signal, measure)

    def at(limit: float) -> tuple[float, float, float]:
        program = Program()
        numbers = program.numbers(3)
        bound = Affine.fixed(limit)
        bound_measure(program, numbers, signal, measure, bound, "it")
        program.cost = {int(numbers[0]): -1.0}
        found = program.solve()
        return found.value, found.prices["it"], measured(signal.at(found.x[numbers]), measure)

    limit, step = 1.5 * least, 1e-4 * least
    _, price, used = at(limit)
    assert used == pytest.approx(limit, rel=1e-7)
    difference = (at(limit - step)[0] - at(limit + step)[0]) / (2 * step)
    assert price == pytest.approx(difference, rel=1e-3)


@pytest.mark.parametrize("is_vector", [False, True])
@pytest.mark.parametrize("measure", ["rms", "ripple"])
def test_few_rows_hold_the_mean_square(measure: Measure, is_vector: bool) -> None:
    signal = random_signal(3, is_vector)
    matrix, vector = mean_square_rows(signal, measure)
    assert matrix.shape == (4, 3)
    for numbers in np.random.default_rng(0).normal(size=(5, 3)):
        value = float(np.linalg.norm(matrix @ numbers + vector))
        assert value == pytest.approx(measured(signal.at(numbers), measure), rel=1e-12)


def test_figures_of_a_wave() -> None:
    """2 + 3 cos: mean square 4 + 4.5, deviation 3 / sqrt 2, from -1 to 5; the mean is no ripple."""
    wave = 2 + 3 * np.cos(ANGLE)
    assert measured(wave, "rms") == pytest.approx(np.sqrt(8.5))
    assert measured(wave, "ripple") == pytest.approx(3 / np.sqrt(2))
    assert measured(wave, "peak") == pytest.approx(5)
    assert measured(wave, "peak_to_peak") == pytest.approx(6)
    assert measured(wave - 2, "area") == pytest.approx(12, rel=1e-3)
    assert measured(2j + 3 * np.exp(1j * ANGLE), "ripple") == pytest.approx(3)


def test_a_number_that_moves_the_mean_alone_leaves_the_ripple() -> None:
    signal = Signal(2 + 3 * np.cos(ANGLE), np.ones((1, N)))
    matrix, vector = mean_square_rows(signal, "ripple")
    assert np.max(np.abs(matrix)) < 1e-14
    assert np.linalg.norm(vector) == pytest.approx(3 / np.sqrt(2))
    assert solved(signal, "peak")[1] == pytest.approx([-2.0], abs=1e-7)


@pytest.mark.parametrize("is_vector", [False, True])
def test_kept_orders(is_vector: bool) -> None:
    """Of a vector, waves that turn either way."""
    backwards = 0.7 * np.exp(-2j * ANGLE)
    start = 4 + 3 * np.exp(1j * ANGLE) + 0.5 * np.exp(2j * ANGLE) + backwards
    column = np.exp(2j * ANGLE) + np.exp(3j * ANGLE)
    if not is_vector:
        start, column = start.real, column.real
    signal = Signal(start, column[None, :])
    kept = signal.kept((2.0,))
    wanted = 0.5 * np.exp(2j * ANGLE) + backwards
    second = np.exp(2j * ANGLE)
    part = (lambda z: z) if is_vector else np.real
    assert kept.start == pytest.approx(part(wanted), abs=1e-12)
    assert kept.columns[0] == pytest.approx(part(second), abs=1e-12)
    assert np.iscomplexobj(kept.start) == is_vector
    assert signal.kept(()) is signal
    assert signal.kept((0.0, 3.0)).start == pytest.approx(np.full(N, 4.0), abs=1e-12)


def test_orders_count_events_in_one_turn_of_the_crank() -> None:
    """Two turns in the samples: the second wave in them is order 1, the first order 1/2."""
    signal = Signal(np.cos(ANGLE) + np.cos(2 * ANGLE), np.zeros((0, N)), turns=2)
    assert signal.kept((1.0,)).start == pytest.approx(np.cos(2 * ANGLE), abs=1e-12)
    assert signal.kept((0.5,)).start == pytest.approx(np.cos(ANGLE), abs=1e-12)


def test_division_and_values() -> None:
    signal = random_signal(0, True)
    numbers = np.array([0.3, -2.0, 1.0])
    assert signal.divided(4.0).at(numbers) == pytest.approx(signal.at(numbers) / 4)


@pytest.mark.parametrize(
    ("output", "measure", "unit"),
    [
        ("shaking_force", "rms", "N"),
        ("shaking_moment", "peak", "N m"),
        ("shaking_moment", "area", "J"),
        ("shaking_force.y", "area", "N rad"),
        ("joints.A", "peak", "N"),
        ("gauges.gauge", "ripple", "m"),
    ],
)
def test_units(output: str, measure: Measure, unit: str) -> None:
    assert unit_of(Objective(output, measure), eq.load("yamashita-rig")) == unit
