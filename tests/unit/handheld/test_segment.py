"""The transfer matrix of a segment against the exponential of its equations, in 40 digits."""

from __future__ import annotations

from math import inf, pi, sqrt
from typing import Any

import mpmath
import numpy as np
import pytest

from equipoise.handheld.chain import Dual, Transfer, longest, shear_transfer, transfer
from support.beam_reference import Piece, Reference

Array = np.ndarray[Any, Any]
EPS = np.finfo(float).eps


def square(result: Transfer) -> Array:
    """The matrix (..., 4, 4) from w, theta, V, M to the same."""
    rows = ("ww wt wv wm", "tw tt tv tm", "vw vt vv vm", "mw mt mv mm")
    shape = np.broadcast_shapes(*(np.shape(entry) for entry in result))
    parts = [[np.broadcast_to(getattr(result, key), shape) for key in row.split()] for row in rows]
    return np.moveaxis(np.array(parts), (0, 1), (-2, -1))


def system(e: Any, s: Any, m: Any, r: Any) -> list[list[Any]]:
    """w' = theta + V s, theta' = M e, V' = m w, M' = r theta - V."""
    return [[0, 1, s, 0], [0, 0, 0, e], [m, 0, 0, 0], [0, r, -1, 0]]


def exponential(
    length: float, coefficients: tuple[complex, complex, complex, complex]
) -> tuple[Array, Array]:
    """The exact matrix, and that of the sizes of all terms: what rounding may be held beside."""
    with mpmath.workdps(40):
        a = mpmath.matrix(system(*coefficients)) * mpmath.mpf(length)
        sizes = a.apply(abs)
        exact, bound = (mpmath.expm(part, method="taylor") for part in (a, sizes))
        return tuple(  # type: ignore[return-value]
            np.array(part.tolist()).astype(complex) for part in (exact, bound)
        )


def random_section(rng: np.random.Generator) -> tuple[float, float, float, float]:
    """Flexibility, shear, mass and rotary inertia, from slender to where shear is all."""
    stiffness, mass = 10 ** rng.uniform(1, 5), 10 ** rng.uniform(-1, 1)
    depth = 10 ** rng.uniform(-3, -0.5)
    return 1 / stiffness, depth**2 / stiffness * rng.uniform(1, 4), mass, mass * depth**2


KINDS = ("real", "complex", "loss")


def square_of_s(kind: str, frequency: float, rng: np.random.Generator) -> complex:
    if kind == "complex":
        return (frequency * np.exp(1j * rng.uniform(0, 2 * pi))) ** 2
    return -(frequency**2)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("share", [1.0, 0.4, 1e-3])
def test_exponential(kind: str, seed: int, share: float) -> None:
    """Up to the longest segment for a frequency, at any complex frequency of that size.

    An entry is a sum of terms; 8 roundings of their sizes added.
    """
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    e, s, m, r = random_section(rng)
    frequency = 10 ** rng.uniform(0, 4)
    at = square_of_s(kind, frequency, rng)
    loss = 1 + 0.3j if kind == "loss" else 1.0
    for theory in ("euler-bernoulli", "timoshenko"):
        thick = theory == "timoshenko"
        length = share * longest(frequency, e, s * thick, m, r * thick)
        numbers = (e / loss, s * thick / loss, m * at, r * at * thick)
        wanted, sizes = exponential(length, numbers)
        actual = (
            shear_transfer(length, *numbers) if thick else transfer(length, numbers[0], numbers[2])
        )
        assert np.all(np.abs(square(actual) - wanted) <= 8 * EPS * sizes)


def samples(count: int = 40) -> tuple[Array, Array, Array, Array, Array]:
    """Many segments, each as long as it may be, at complex frequencies."""
    rng = np.random.default_rng(11)
    rows = []
    for _ in range(count):
        e, s, m, r = random_section(rng)
        frequency = 10 ** rng.uniform(0, 4)
        at = square_of_s("complex", frequency, rng)
        rows.append((longest(frequency, e, s, m, r), e, s, m * at, r * at))
    return tuple(np.array(rows).T)  # type: ignore[return-value]


@pytest.mark.parametrize("theory", ["euler-bernoulli", "timoshenko"])
def test_derivative_by_length_meets_the_equations(theory: str) -> None:
    """Carried along by `Dual`: dT / dl = A T."""
    length, e, s, m, r = samples(6)
    if theory == "euler-bernoulli":
        s, r = 0 * s, 0 * r
    variable = Dual(length, np.ones((1, 6)))
    actual = (
        shear_transfer(variable, e, s, m, r) if theory == "timoshenko" else transfer(variable, e, m)
    )
    value = square(Transfer(*(part.value for part in actual)))
    slope = square(Transfer(*(np.broadcast_to(part.slopes, (1, 6))[0] for part in actual)))
    for k in range(6):
        a = np.array(system(e[k], s[k], m[k], r[k]))
        away = np.abs(slope[k] - a @ value[k])
        assert np.all(away <= 1e-13 * np.max(np.abs(a) @ np.abs(value[k]), axis=1)[:, None])


@pytest.mark.parametrize("seed", range(12))
def test_longest_leaves_no_frequency_below(seed: int) -> None:
    """Finite elements of a segment held at both ends: none below, and not so much as 3 times above.

    The bound is Friedrichs', 0.9 of it squared: 22.37 / (pi^2 sqrt 0.9) = 2.39 where bending is
    all, 1 / sqrt 0.9 = 1.05 where shear is.
    """
    rng = np.random.default_rng([seed, 5])
    e, s, m, r = random_section(rng)
    frequency = 10 ** rng.uniform(0, 4)
    if seed < 3:
        s = r = 0.0
    elif seed < 6:
        s = 30 * s
    length = longest(frequency, e, s, m, r)
    held = [(place, what) for place in (0.0, length) for what in ("displacement", "slope")]
    piece = Piece(length, 1 / e, m, 1 / s if s else inf, r)
    first = Reference([piece], elements=48, held=held).natural_frequencies(1)[0]
    assert 1 < first / frequency < 3
    if seed < 3:
        assert first / frequency == pytest.approx(4.730040745**2 / (pi**2 * sqrt(0.9)), rel=1e-6)


@pytest.mark.parametrize("seed", range(12))
def test_longest_is_where_the_bound_is_met(seed: int) -> None:
    rng = np.random.default_rng([seed, 6])
    e, s, m, r = random_section(rng)
    frequency = 10 ** rng.uniform(0, 4)
    x = (longest(frequency, e, s, m, r) / pi) ** 2
    bound = m * e * x**2 + m * s * x + r * e * x
    assert bound * frequency**2 == pytest.approx(0.9, rel=1e-12)
