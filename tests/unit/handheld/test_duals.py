"""Numbers that carry derivatives: every operation against derivatives taken in 40 digits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest

from equipoise.handheld.chain import Dual

OPERATIONS: dict[str, Callable[[Any, Any], Any]] = {
    "x + y": lambda x, y: x + y,
    "x + 3": lambda x, y: x + 3,
    "3 + x": lambda x, y: 3 + x,
    "x - y": lambda x, y: x - y,
    "x - 3": lambda x, y: x - 3,
    "3 - x": lambda x, y: 3 - x,
    "-x": lambda x, y: -x,
    "x y": lambda x, y: x * y,
    "x 3": lambda x, y: x * 3,
    "3 x": lambda x, y: 3 * x,
    "x x": lambda x, y: x * x,
    "x / y": lambda x, y: x / y,
    "x / 3": lambda x, y: x / 3,
    "3 / x": lambda x, y: 3 / x,
    "rational": lambda x, y: (2 - x * y) / (1 + x * x) - 5 * (y / (x - 4)) / (2 * y - x / y),
    "nested": lambda x, y: 1 / (x + 1 / (y - 2 / (x * y + 3))) - -x * (y - x) * y,
}
PLACES = [(0.7, -1.3), (12.5, 0.04), (0.3 + 0.8j, -1.1 + 0.2j), (-2.0 + 1e-3j, 5.0)]


@pytest.mark.parametrize("operation", OPERATIONS.values(), ids=OPERATIONS)
@pytest.mark.parametrize("place", PLACES, ids=str)
def test_operation(operation: Callable[[Any, Any], Any], place: tuple[complex, complex]) -> None:
    """1e-14: a dozen roundings, none of which cancels more than a digit at these places."""
    x, y = (Dual(np.array(part), np.array(row)) for part, row in zip(place, np.eye(2), strict=True))
    result = operation(x, y)
    with mpmath.workdps(40):
        exact = [mpmath.mpmathify(part) for part in place]
        wanted = [operation(*exact)]
        wanted += [mpmath.diff(operation, tuple(exact), order) for order in ((1, 0), (0, 1))]
        value, *slopes = [complex(number) for number in wanted]
    assert complex(result.value) == pytest.approx(value, rel=1e-14)
    np.testing.assert_allclose(np.broadcast_to(result.slopes, 2), slopes, rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize("operation", OPERATIONS.values(), ids=OPERATIONS)
def test_arrays_of_numbers(operation: Callable[[Any, Any], Any]) -> None:
    """One operation on arrays is that on each number by itself."""
    rng = np.random.default_rng(3)
    x, y = rng.uniform(0.5, 2, (2, 3, 4)) + 1j * rng.uniform(0.5, 2, (2, 3, 4))
    by_x, by_y = rng.normal(size=(2, 5, 3, 4))
    result = operation(Dual(x, by_x), Dual(y, by_y))
    for at in np.ndindex(3, 4):
        here = (slice(None), *at)
        first = operation(Dual(x[at], by_x[here]), Dual(y[at], by_y[here]))
        assert result.value[at] == pytest.approx(first.value, rel=1e-15)
        np.testing.assert_allclose(result.slopes[here], first.slopes, rtol=1e-14)


@pytest.mark.parametrize(
    "operation",
    [lambda a, x: a + x, lambda a, x: a - x, lambda a, x: a * x, lambda a, x: a / x],
    ids=["+", "-", "*", "/"],
)
def test_an_array_on_the_left(operation: Callable[[Any, Any], Any]) -> None:
    """NumPy must not take the number for an object of which it makes an array."""
    row = np.array([1.0, -2.0, 3.0 + 1j])
    number = Dual(np.array(0.7), np.array([1.0, -4.0])[:, None])
    result = operation(row, number)
    assert isinstance(result, Dual)
    whole = operation(Dual(row, np.zeros((2, 3))), number)
    np.testing.assert_allclose(result.value, operation(row, 0.7))
    np.testing.assert_allclose(np.broadcast_to(result.slopes, (2, 3)), whole.slopes, rtol=1e-15)


def test_conjugate() -> None:
    """By a real variable, |f|^2 = f conj(f) has the slope 2 Re (conj(f) f')."""
    x = Dual(np.array(0.8), np.array([1.0]))
    f = (1 + 2j) * x * x / (x + 3j)
    with mpmath.workdps(40):
        square = mpmath.diff(lambda t: abs((1 + 2j) * t * t / (t + 3j)) ** 2, mpmath.mpf(0.8))
    assert (f * f.conj()).slopes[0] == pytest.approx(float(square), rel=1e-14)
    assert f.conj().value == f.value.conjugate()


def test_parts() -> None:
    number = Dual(np.arange(6.0).reshape(2, 3), np.arange(24.0).reshape(4, 2, 3))
    part = number[1]
    assert part.value.tolist() == [3, 4, 5]
    np.testing.assert_array_equal(part.slopes, np.arange(24.0).reshape(4, 2, 3)[:, 1])
    part = number[:, 2]
    np.testing.assert_array_equal(part.slopes, np.arange(24.0).reshape(4, 2, 3)[:, :, 2])
