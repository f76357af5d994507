"""Branch and bound on toys whose best numbers are known, and on grids.

The search closes the bounds to 1e-9 of the cost; squares are met to 1e-8.
"""

from __future__ import annotations

import numpy as np
import pytest

from equipoise.balancing.branch_and_bound import Best, Square, minimise
from equipoise.balancing.program import Affine, NoSolutionError, Program


def toy(low: float = -2.0, high: float = 2.0) -> tuple[Program, Square]:
    """Numbers lift and y with lift = y^2, y between two values."""
    program = Program()
    lift, y = map(int, program.numbers(2))
    square = Square(lift, y, None, low, high)
    square.keep_above(program)
    square.keep_between(program, low, high)
    return program, square


def size_of(program: Program, columns: list[int], factors: list[float], constant: float) -> int:
    """A number that is at least the absolute value of a row."""
    (size,) = map(int, program.numbers(1))
    for sign in (1.0, -1.0):
        factored = [1.0, *(sign * factor for factor in factors)]
        program.nonnegative(Affine.of([size, *columns], factored, sign * constant))
    return size


def proved(found: Best, gap: float = 1e-8) -> bool:
    return found.bound <= found.value and found.value - found.bound < gap


def test_exact_where_the_square_is_wanted_small() -> None:
    """Least y^2 + y at -1/2: one program is enough."""
    program, square = toy()
    program.cost = {0: 1.0, 1: 1.0}
    found = minimise(program, [square])
    assert found.value == pytest.approx(-0.25, abs=1e-9)
    assert found.nodes == 1
    assert proved(found)


def test_square_wanted_large() -> None:
    """Least y - y^2 over [-2, 1.5] is -6 at -2."""
    program, square = toy(-2.0, 1.5)
    program.cost = {0: -1.0, 1: 1.0}
    found = minimise(program, [square])
    assert found.x[:2] == pytest.approx([4.0, -2.0], abs=1e-6)
    assert proved(found)


def hollows(towards: float) -> tuple[Program, Square]:
    """|y^2 - 1| + |y - towards| / 10, with a hollow at y = -1 and one at 1."""
    program, square = toy()
    size = size_of(program, [0], [1.0], -1.0)
    away = size_of(program, [1], [1.0], -towards)
    program.cost = {size: 1.0, away: 0.1}
    return program, square


@pytest.mark.parametrize("towards", [0.2, -0.2, 0.01])
def test_two_hollows(towards: float) -> None:
    """The deeper one is found, though the first program lies between them."""
    program, square = hollows(towards)
    found = minimise(program, [square])
    assert found.x[1] == pytest.approx(np.sign(towards), abs=1e-7)
    assert found.value == pytest.approx(0.1 * (1 - abs(towards)), abs=1e-8)
    assert proved(found)
    assert found.nodes > 1


@pytest.mark.parametrize("seed", range(6))
def test_against_a_grid(seed: int) -> None:
    """Three times |a y^2 + b y + c z^2 + d z + e|: their sum is never above the grid's least."""
    rng = np.random.default_rng(seed)
    factors = rng.normal(size=(3, 5))
    program, first = toy(-1.0, 1.0)
    lift, z = map(int, program.numbers(2))
    second = Square(lift, z, None, -1.0, 1.0)
    second.keep_above(program)
    second.keep_between(program, -1.0, 1.0)
    sizes = [size_of(program, [0, 1, lift, z], list(f[:4]), f[4]) for f in factors]
    program.cost = dict.fromkeys(sizes, 1.0)
    found = minimise(program, [first, second])
    y, z = np.meshgrid(np.linspace(-1, 1, 801), np.linspace(-1, 1, 801))
    grid = sum(abs(f[0] * y**2 + f[1] * y + f[2] * z**2 + f[3] * z + f[4]) for f in factors)
    least = float(np.min(grid))
    assert found.bound <= least + 1e-9
    assert found.value <= least + 1e-8
    assert found.value > least - 0.02  # the grid's own step
    assert proved(found)
    assert all(square.missed(found.x) < 1e-7 for square in (first, second))


def test_square_over_a_mass() -> None:
    """lift = y^2 / m with m at most 2 and |y| <= m: least |lift - 0.5| + 0.1 m + 0.01 y.

    For m <= 0.5 lift = m at the most; the hollow is at m = 0.5, y = -0.5.
    """
    program = Program()
    lift, y, m = map(int, program.numbers(3))
    square = Square(lift, y, m, -1.0, 1.0)
    square.keep_above(program)
    square.keep_between(program, -1.0, 1.0)
    program.nonnegative(Affine.of(m, -1.0, 2.0))
    program.nonnegative(Affine.of(m, 1.0))
    size = size_of(program, [lift], [1.0], -0.5)
    program.cost = {size: 1.0, m: 0.1, y: 0.01}
    found = minimise(program, [square])
    assert found.x[:3] == pytest.approx([0.5, -0.5, 0.5], abs=1e-6)
    assert found.value == pytest.approx(0.045, abs=1e-8)
    assert proved(found)


def test_a_ratio_without_limits() -> None:
    """|y^2 - 30| + |y - 7| over all y: at the root of 30."""
    program, square = toy(-np.inf, np.inf)
    one = size_of(program, [0], [1.0], -30.0)
    other = size_of(program, [1], [1.0], -7.0)
    program.cost = {one: 1.0, other: 1.0}
    found = minimise(program, [square], 30.0)
    assert found.x[1] == pytest.approx(np.sqrt(30), abs=1e-6)
    assert proved(found, 1e-6)


def test_price_of_a_limit_that_moves_the_ratio() -> None:
    """Least -y^2 with y <= 1.5: a unit more of the limit gains 2 y = 3."""
    program, square = toy(-1.0, 4.0)
    slope = Affine.fixed(1.0)
    program.nonnegative(Affine.of(1, -1.0, 1.5), "most", slope)
    program.cost = {0: -1.0}
    found = minimise(program, [square])
    assert found.value == pytest.approx(-2.25, abs=1e-8)
    assert found.prices["most"] == pytest.approx(3.0, rel=1e-3)


def test_what_cannot_be_met() -> None:
    program, square = toy(-1.0, 1.0)
    program.nonnegative(Affine.of(1, 1.0, -3.0))
    with pytest.raises(NoSolutionError):
        minimise(program, [square])


def test_what_no_square_meets() -> None:
    """Between parabola and chord there is room, on the parabola there is none."""
    program, square = toy(-1.0, 1.0)
    program.zero(Affine.of([0, 1], [1.0, 0.0], -0.5))
    program.zero(Affine.of(1, 1.0, -0.1))
    with pytest.raises(NoSolutionError):
        minimise(program, [square])


def test_progress_is_told() -> None:
    program, square = hollows(0.2)
    told: list[tuple[int, int]] = []
    found = minimise(program, [square], progress=lambda *pair: told.append(pair))
    assert told
    assert told[-1][0] == found.nodes
    assert all(done <= total for done, total in told)
