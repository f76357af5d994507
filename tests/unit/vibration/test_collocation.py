"""Periodic solutions by collocation, against equations whose solutions are known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, pi
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import mathieu_a, mathieu_b

from equipoise.errors import ResponseError
from equipoise.vibration.collocation import RULE, STAGES, BoundaryConditions, Orbit, Rates, solve
from equipoise.vibration.steady import FINE, steady
from support.refusals import refused
from unit.vibration.build import Array


@dataclass(frozen=True)
class Equations:
    """dx/ds = f(s, x)."""

    f: Callable[[Array, Array], list[Any]]

    def rates(self, s: Array) -> Rates:
        return lambda x: np.stack([np.asarray(part) for part in self.f(s, x)])


def solved(
    f: Callable[[Array, Array], list[Any]],
    period: float,
    count: int = 2,
    intervals: int = 24,
    conditions: BoundaryConditions | None = None,
    start: float = 0.0,
) -> Orbit:
    mesh = np.linspace(0.0, period, intervals + 1)
    return solve(
        Equations(f),
        mesh,
        lambda s: np.full((count, len(s)), start),
        conditions or BoundaryConditions.periodic(count),
    )


def oscillator(damping: float, frequency: float, force: float = 1.0) -> Any:
    """x'' + 2 D w x' + w^2 x = F cos s, as two equations."""

    def f(s: Array, x: Array) -> list[Any]:
        bend = force * np.cos(s) - 2 * damping * frequency * x[1] - frequency**2 * x[0]
        return [x[1], bend]

    return f


# -- solutions -------------------------------------------------------------------------------------


@pytest.mark.parametrize(("damping", "frequency"), [(0.1, 1.7), (0.02, 1.0), (0.6, 0.3)])
def test_linear_oscillator(damping: float, frequency: float) -> None:
    """x = Re exp(i s) / (w^2 - 1 + 2 i D w); of order 16 on 24 intervals only rounding is left.

    Closing the period makes it larger by 1 / (1 - |multiplier|): 8 times at a damping of 0.02.
    """
    tolerance = 1e-12 / -np.expm1(-2 * pi * damping * frequency)
    orbit = solved(oscillator(damping, frequency), 2 * pi)
    gain = 1 / (frequency**2 - 1 + 2j * damping * frequency)
    s = np.linspace(0, 2 * pi, 301)
    turning = gain * np.exp(1j * s)
    wanted = np.stack([turning.real, (1j * turning).real])
    np.testing.assert_allclose(orbit.at(s), wanted, rtol=0, atol=tolerance * abs(gain))
    middles = orbit.at(orbit.points[:-1] + pi / 24)[1]
    np.testing.assert_allclose(orbit.slopes_at(0.5)[0], middles, atol=10 * tolerance * abs(gain))
    assert orbit.change < 1e-12


def test_states_at_the_nodes_are_those_of_the_polynomials() -> None:
    orbit = solved(oscillator(0.1, 1.7), 2 * pi, intervals=5)
    assert orbit.nodes.shape == (5, STAGES)
    at = orbit.at(orbit.nodes.ravel()).reshape(2, 5, STAGES)
    np.testing.assert_allclose(orbit.states, at, rtol=0, atol=1e-12)
    np.testing.assert_allclose(orbit.at(orbit.points), orbit.starts, rtol=0, atol=1e-12)


def test_integral_over_the_period() -> None:
    """Of sin^2: pi."""
    orbit = solved(oscillator(0.1, 1.7), 2 * pi)
    assert orbit.integral(np.sin(orbit.nodes) ** 2) == pytest.approx(pi, rel=1e-14)


def test_gauss_rule_is_exact_to_its_order() -> None:
    """m nodes integrate powers up to 2 m - 1."""
    powers = np.arange(2 * STAGES)
    actual = RULE.weights @ RULE.nodes[:, None] ** powers
    np.testing.assert_allclose(actual, 1 / (powers + 1), rtol=1e-13)


def duffing(s: Array, x: Array) -> list[Any]:
    """x'' + 0.1 x' + x + x^3 = 0.6 cos s at frequency 1.4, in s = 1.4 t."""
    bend = 0.6 * np.cos(s) - 0.1 * x[1] - x[0] - x[0] ** 3
    return [x[1] / 1.4, bend / 1.4]


def test_duffing_against_integration() -> None:
    """DOP853 at 1e-13 keeps 1e-11 over one period from the same start."""
    orbit = solved(duffing, 2 * pi, intervals=40)
    s = np.linspace(0, 2 * pi, 61)
    followed = solve_ivp(
        lambda t, x: duffing(np.array(t), x), (0, 2 * pi), orbit.starts[:, 0], "DOP853",
        t_eval=s, rtol=1e-13, atol=1e-14,
    )  # fmt: skip
    assert np.max(np.abs(followed.y[0])) > 0.2
    np.testing.assert_allclose(orbit.at(s), followed.y, rtol=0, atol=1e-11)
    np.testing.assert_allclose(orbit.starts[:, -1], orbit.starts[:, 0], rtol=0, atol=1e-13)


def test_duffing_multipliers_against_integration() -> None:
    """Columns of the monodromy matrix by differences: 1e-5 wide, they miss by some 1e-9."""
    orbit = solved(duffing, 2 * pi, intervals=40)
    columns = []
    for step in 1e-5 * np.eye(2):
        ends = [
            solve_ivp(
                lambda t, x: duffing(np.array(t), x), (0, 2 * pi), orbit.starts[:, 0] + d,
                "DOP853", rtol=1e-13, atol=1e-14,
            ).y[:, -1]
            for d in (step, -step)
        ]  # fmt: skip
        columns.append((ends[0] - ends[1]) / 2e-5)
    np.testing.assert_allclose(orbit.monodromy, np.array(columns).T, rtol=0, atol=1e-7)
    assert np.linalg.det(orbit.monodromy) == pytest.approx(exp(-0.1 * 2 * pi / 1.4), rel=1e-10)


def test_other_conditions_than_a_period() -> None:
    """x' = -x from 1 on: a problem of initial values."""
    conditions = BoundaryConditions(np.eye(1), np.zeros((1, 1)), np.ones(1))
    orbit = solved(lambda _, x: [-x[0]], 3.0, 1, 12, conditions)
    s = np.linspace(0, 3, 31)
    np.testing.assert_allclose(orbit.at(s)[0], np.exp(-s), rtol=1e-12)


def test_a_period_that_is_sought() -> None:
    """The time x_1 of a turn follows from a speed x_0 that is the same all over and ends at 2."""
    begin, end = np.array([[0.0, 0.0], [0.0, 1.0]]), np.array([[0.0, 1.0], [0.0, 0.0]])
    conditions = BoundaryConditions(begin, end, np.array([2.0, 0.0]))
    orbit = solved(lambda _, x: [0 * x[0], 1 / x[0]], 2 * pi, 2, 3, conditions, start=1.0)
    np.testing.assert_allclose(orbit.starts[0], pi, rtol=1e-12)
    np.testing.assert_allclose(orbit.starts[1], np.linspace(0, 2, 4), atol=1e-12)


# -- multipliers -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("damping", "frequency"), [(0.05, 2.3), (0.3, 0.4), (0.0, 0.7)])
def test_multipliers_of_a_linear_oscillator(damping: float, frequency: float) -> None:
    """exp(lambda 2 pi), with lambda = w (-D +- i sqrt(1 - D^2))."""
    orbit = solved(oscillator(damping, frequency), 2 * pi)
    wanted = np.exp(2 * pi * frequency * (-damping + 1j * np.sqrt(1 - damping**2)))
    eigenvalues = np.linalg.eigvals(orbit.monodromy)
    upper = complex(wanted.real, abs(wanted.imag))
    np.testing.assert_allclose(sorted(eigenvalues, key=np.imag)[1], upper, rtol=1e-11)


def mathieu(a: float, q: float) -> Orbit:
    """x'' + (a - 2 q cos 2 s) x = 0 over a period of pi, at rest."""
    return solved(lambda s, x: [x[1], (2 * q * np.cos(2 * s) - a) * x[0]], pi)


@pytest.mark.parametrize("q", [0.3, 1.0, 4.0])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_stability_of_mathieu_equation(q: float, order: int) -> None:
    """On its characteristic curves the multipliers meet at 1 or -1; between them one is larger."""
    low, high = float(mathieu_b(order, q)), float(mathieu_a(order, q))
    sign = (-1) ** order
    for boundary in (low, high):
        # The trace crosses its bound at some 1e-12: SciPy's characteristic values are that good.
        assert np.trace(mathieu(boundary, q).monodromy) == pytest.approx(2 * sign, abs=1e-9)
    inside = np.abs(np.linalg.eigvals(mathieu((low + high) / 2, q).monodromy))
    assert np.max(inside) > 1 + 1e-4
    outside = np.abs(np.linalg.eigvals(mathieu(high + 0.05, q).monodromy))
    np.testing.assert_allclose(outside, 1, rtol=1e-9)
    assert np.prod(inside) == pytest.approx(1, rel=1e-11)


# -- steady states ---------------------------------------------------------------------------------


def stop(s: Array, x: Array) -> list[Any]:
    """An oscillator that meets a stop at 0.3, as stiff as its spring."""
    hit = np.where(x[0].real > 0.3, x[0] - 0.3, 0 * x[0])
    return [x[1], np.cos(s) - 0.3 * x[1] - 2 * x[0] - 2 * hit]


def test_mesh_is_refined_where_a_stop_sets_in() -> None:
    """Followed in time for 50 periods it comes to the same; at 1e-10 that keeps some 1e-8."""
    result = steady(
        Equations(stop), [lambda s: np.zeros((2, len(s)))], 1, BoundaryConditions.periodic(2)
    )
    assert result.residual < FINE
    steps = np.diff(result.orbit.points)
    assert np.max(steps) / np.min(steps) > 100
    s = np.linspace(0, 2 * pi, 41)
    followed = solve_ivp(
        lambda t, x: stop(np.array(t), x), (0, 102 * pi), [0.0, 0.0], "DOP853",
        t_eval=100 * pi + s, rtol=1e-10, atol=1e-12, max_step=0.1,
    )  # fmt: skip
    np.testing.assert_allclose(result.orbit.at(s), followed.y, rtol=0, atol=1e-7)


def test_largest_multiplier_comes_first() -> None:
    def f(s: Array, x: Array) -> list[Any]:
        return [np.cos(s) - x[0], np.sin(s) + 0.1 * x[1], -0.5 * x[2]]

    result = steady(
        Equations(f), [lambda s: np.zeros((3, len(s)))], 1, BoundaryConditions.periodic(3)
    )
    wanted = np.exp(2 * pi * np.array([0.1, -0.5, -1]))
    np.testing.assert_allclose(result.multipliers(3), wanted, rtol=1e-10)
    np.testing.assert_allclose(result.multipliers(1), wanted[2:], rtol=1e-10)


def growing(_: Array, x: Array) -> list[Any]:
    return [1 + x[0] ** 2]


def test_no_steady_state() -> None:
    """x' = 1 + x^2 never comes back."""
    with refused(ResponseError, by="_first"):
        steady(
            Equations(growing), [lambda s: np.zeros((1, len(s)))], 1, BoundaryConditions.periodic(1)
        )


def test_second_guess_where_the_first_leads_nowhere() -> None:
    """x' = (x - 1) (1 + x^2) has one real periodic solution; from far below Newton's steps fail."""
    asked = []

    def far(s: Array) -> Array:
        return np.full((1, len(s)), np.nan)

    def near(s: Array) -> Array:
        asked.append(len(s))
        return np.full((1, len(s)), 1.2)

    f = Equations(lambda _, x: [(x[0] - 1) * (1 + x[0] ** 2)])
    result = steady(f, [far, near], 1, BoundaryConditions.periodic(1))
    np.testing.assert_allclose(result.orbit.starts, 1, rtol=1e-12)
    assert asked
    with pytest.raises(ResponseError):
        steady(f, [far], 1, BoundaryConditions.periodic(1))
