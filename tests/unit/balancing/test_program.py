"""Cone programs whose solutions are known, prices against differences, and branch and bound.

The solver stops at 1e-10 of the cost and of the constraints; solutions are met to 1e-8, and where
the cost is flat about them, to its root.  The search closes the bounds to 1e-9 of the cost.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from equipoise.balancing.branch_and_bound import ProvedSolution, Square, minimise
from equipoise.balancing.program import Affine, ConeRows, NoSolutionError, Program
from support.refusals import refused

CLOSE = 1e-8


def row(columns: list[int], factors: list[float], constant: float = 0.0) -> Affine:
    return Affine.of(columns, factors, constant)


def fixed(*values: float) -> Affine:
    """A row that changes with the limit alone."""
    return Affine(np.zeros((len(values), 0)), np.zeros(0, int), np.array(values))


def factory(hours: float = 18.0) -> Program:
    """Most of 3 x + 5 y with x <= 4, 2 y <= 12, 3 x + 2 y <= hours: x = 2, y = 6, 36 in all."""
    program = Program()
    x, y = map(int, program.numbers(2))
    program.nonnegative(Affine(np.eye(2), np.array([x, y]), np.zeros(2)))
    program.nonnegative(row([x], [-1.0], 4.0), "first", fixed(1.0))
    program.nonnegative(row([y], [-2.0], 12.0), "second", fixed(1.0))
    program.nonnegative(row([x, y], [-3.0, -2.0], hours), "third", fixed(1.0))
    program.cost = {x: -3.0, y: -5.0}
    return program


def test_linear_program() -> None:
    solution = factory().solve()
    assert solution.x == pytest.approx([2.0, 6.0], abs=CLOSE)
    assert solution.value == pytest.approx(-36.0, abs=CLOSE)
    assert solution.bound <= solution.value
    assert solution.value - solution.bound < 1e-7
    assert solution.prices == pytest.approx({"first": 0.0, "second": 1.5, "third": 1.0}, abs=1e-7)


def test_a_solution_reports_its_cuts_and_leaves_the_program_as_it_is() -> None:
    """Least -x - y in the unit circle, of which the program knows no more than tangents: each round
    adds that where the ray through the last solution leaves the circle.
    """
    program = Program()
    x, y = map(int, program.numbers(2))
    program.nonnegative(Affine.of([x, y], [[-1.0, 0.0], [0.0, -1.0]], 1.0))
    program.cost = {x: -1.0, y: -1.0}

    def tangent(at: np.ndarray) -> list[ConeRows]:
        size = float(np.hypot(*at))
        if size <= 1 + CLOSE:
            return []
        return [ConeRows("nonnegative", row([x, y], (-at / size).tolist(), 1.0))]

    program.cutters.append(tangent)
    copy, own = program.copy(), len(program.blocks)
    solution = copy.solve()
    assert solution.value == pytest.approx(-np.sqrt(2), abs=1e-7)
    assert len(copy.blocks) == len(program.blocks) == own
    assert [len(cuts) for cuts in solution.cuts] == [1]
    program.add_cuts(solution.cuts)
    assert len(program.blocks) == own + 1
    again = program.solve()
    assert again.cuts == ()
    assert again.value == pytest.approx(solution.value, abs=CLOSE)


def test_limits_can_be_left_out() -> None:
    """Without 3 x + 2 y <= 18 the other two are met with equality."""
    program = factory()
    less = program.without({"third"})
    assert program.names == ["first", "second", "third"]
    assert less.names == ["first", "second"]
    assert less.solve().x == pytest.approx([4.0, 6.0], abs=CLOSE)
    assert len(program.blocks) == len(less.blocks) + 1


def test_a_copy_goes_its_own_way() -> None:
    program = factory()
    copy = program.copy()
    copy.zero(row([1], [1.0], -1.0))
    copy.cost[0] = -30.0
    assert copy.solve().x == pytest.approx([4.0, 1.0], abs=CLOSE)
    assert program.solve().value == pytest.approx(-36.0, abs=CLOSE)


def test_what_contradicts_itself() -> None:
    program = factory(hours=-1.0)
    assert not program.feasible()
    assert program.without({"third"}).feasible()
    with refused(NoSolutionError, reason="PrimalInfeasible"):
        program.solve()


def test_feasibility_does_not_depend_on_the_cost() -> None:
    program = Program()
    x = int(program.numbers(1)[0])
    program.nonnegative(row([x], [1.0]))
    program.cost = {x: -1.0}  # as small as one likes
    assert program.feasible()
    with pytest.raises(NoSolutionError):
        program.solve()


def away(radius: float, weight: float = 2.0) -> Program:
    """Least x + weight y on a disc about (1, 1)."""
    program = Program()
    places = program.numbers(2)
    inner = Affine(np.vstack([np.zeros(2), np.eye(2)]), places, np.array([radius, -1.0, -1.0]))
    program.cones(inner, 3, "radius", fixed(1.0, 0.0, 0.0))
    program.cost = {int(places[0]): 1.0, int(places[1]): weight}
    return program


def test_second_order_cone() -> None:
    solution = away(0.5).solve()
    assert solution.x == pytest.approx(1 - 0.5 * np.array([1, 2]) / np.sqrt(5), abs=1e-7)
    assert solution.value == pytest.approx(3 - 0.5 * np.sqrt(5), abs=CLOSE)


@pytest.mark.parametrize("radius", [0.3, 1.7])
def test_price_of_a_cone_is_a_difference(radius: float) -> None:
    step = 1e-3
    more, less = (away(radius + sign * step).solve().value for sign in (1, -1))
    price = away(radius).solve().prices["radius"]
    assert price == pytest.approx((less - more) / (2 * step), rel=1e-6)
    assert price == pytest.approx(np.sqrt(5), rel=1e-6)


def test_price_whose_slope_depends_on_the_numbers() -> None:
    """y >= 2 and y <= a x with the cost x: x = 2 / a, so that a unit more of a saves 2 / a^2."""

    def built(a: float) -> Program:
        program = Program()
        x, y = map(int, program.numbers(2))
        program.nonnegative(row([y], [1.0], -2.0))
        program.nonnegative(row([x, y], [a, -1.0]), "slope", row([x], [1.0]))
        program.cost = {x: 1.0}
        return program

    assert built(0.5).solve().prices["slope"] == pytest.approx(8.0, rel=1e-6)


def test_rotated_cone() -> None:
    """Least x + 4 y with x y >= 3^2 + 4^2 is 2 sqrt(4 25) at x = 10, y = 2.5."""
    program = Program()
    x, y, *z = map(int, program.numbers(4))
    for place, value in zip(z, (3.0, 4.0), strict=True):
        program.zero(row([place], [1.0], -value))
    both = Affine(np.eye(2), np.array(z), np.zeros(2))
    program.rotated(row([x], [1.0]), row([y], [1.0]), both)
    program.cost = {x: 1.0, y: 4.0}
    solution = program.solve()
    assert solution.value == pytest.approx(20.0, abs=1e-7)
    assert solution.x[:2] == pytest.approx([10.0, 2.5], abs=1e-4)


def test_rotated_cone_over_sums_that_share_numbers() -> None:
    """(x + 1) (2 - x) >= t^2 with the most of t: at x = 1/2, t = 3/2."""
    program = Program()
    x, t = map(int, program.numbers(2))
    program.rotated(row([x], [1.0], 1.0), row([x], [-1.0], 2.0), row([t], [1.0]))
    program.cost = {t: -1.0}
    solution = program.solve()
    assert solution.x == pytest.approx([0.5, 1.5], abs=1e-5)
    assert solution.value == pytest.approx(-1.5, abs=CLOSE)


def test_sparse_rows_do_what_full_ones_do() -> None:
    rng = np.random.default_rng(1)
    factors = rng.normal(size=(40, 6)) * (rng.random((40, 6)) < 0.3)
    values = []
    for kind in (np.asarray, sparse.csr_array):
        program = Program()
        program.numbers(3)
        places = program.numbers(6)
        program.nonnegative(Affine(kind(factors), places, np.ones(40)))
        program.nonnegative(Affine(np.eye(6), places, np.full(6, 5.0)))
        program.nonnegative(Affine(-np.eye(6), places, np.full(6, 5.0)))
        program.nonnegative(Affine(np.eye(3), np.arange(3), np.zeros(3)))
        program.cost = {int(place): 1.0 for place in places}
        values.append(program.solve().value)
        assert program.blocks[0].rows.at(np.ones(9)) == pytest.approx(factors.sum(axis=1) + 1)
    assert values[0] == pytest.approx(values[1], abs=CLOSE)
    assert values[0] > -30.0


def test_rows_with_a_spread_constant() -> None:
    rows = Affine.of([2, 0], [[1.0, 2.0], [3.0, 4.0]], 5.0)
    assert rows.at(np.array([1.0, 100.0, 10.0])) == pytest.approx([17.0, 39.0])


def round_about(gradual: bool) -> Program:
    """Least x + 2 y within 4000 half-planes round a disc of radius 2: -2 sqrt 5."""
    program = Program()
    x, y = map(int, program.numbers(2))
    angle = np.arange(4000) * (2 * np.pi / 4000)
    rows = Affine(-np.array([np.cos(angle), np.sin(angle)]).T, np.array([x, y]), np.full(4000, 2.0))
    block = ConeRows("nonnegative", rows, name="radius", slope=fixed(*np.ones(4000)))
    if gradual:
        program.add_lazy_rows(block)
    else:
        program.blocks.append(block)
    program.cost = {x: 1.0, y: 2.0}
    return program


def test_rows_that_are_taken_in_one_by_one() -> None:
    """Few of them, and those between them: the circle instead of the polygon that they make."""
    program, whole = round_about(True), round_about(False).solve()
    solution = program.solve()
    assert solution.value == pytest.approx(-2 * np.sqrt(5), abs=1e-8)
    assert solution.value == pytest.approx(whole.value, abs=1e-6)
    assert solution.x == pytest.approx(whole.x, abs=2e-3)
    assert solution.bound <= solution.value + 1e-9
    assert solution.prices["radius"] == pytest.approx(np.sqrt(5), rel=1e-5)
    taken_in = (*program.blocks, *(block for cuts in solution.cuts for block in cuts))
    assert sum(block.groups for block in taken_in) < 400
    assert program.waiting[0].slack(solution.x).min() > -1e-8
    assert program.without({"radius"}).waiting == []


def test_what_is_taken_in_serves_other_programs_that_are_given_it() -> None:
    program = round_about(True)
    start = len(program.blocks)
    solution = program.copy().solve()
    assert len(program.blocks) == start
    assert solution.cuts
    program.add_cuts(solution.cuts)
    assert len(program.blocks) == start + sum(map(len, solution.cuts))
    assert program.solve().cuts == ()


def test_lifts_let_go_of_their_squares() -> None:
    program = Program()
    lift, y = map(int, program.numbers(2))
    program.rotated(row([lift], [1.0]), fixed(1.0), row([y], [1.0]), lift)
    program.nonnegative(row([lift], [1.0], 7.0))
    program.zero(row([y], [1.0], -2.0))
    program.cost = {lift: 1.0}
    assert program.solve().value == pytest.approx(4.0, abs=1e-7)
    assert program.without_squares({lift}).solve().value == pytest.approx(-7.0, abs=1e-7)
    assert program.without_squares({y}).solve().value == pytest.approx(4.0, abs=1e-7)


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


def proved(result: ProvedSolution, gap: float = 1e-8) -> bool:
    return result.bound <= result.value and result.value - result.bound < gap


def test_exact_where_the_square_is_wanted_small() -> None:
    """Least y^2 + y at -1/2: one program is enough."""
    program, square = toy()
    program.cost = {0: 1.0, 1: 1.0}
    minimum = minimise(program, [square])
    assert minimum.value == pytest.approx(-0.25, abs=1e-9)
    assert minimum.nodes == 1
    assert proved(minimum)


def test_square_wanted_large() -> None:
    """Least y - y^2 over [-2, 1.5] is -6 at -2."""
    program, square = toy(-2.0, 1.5)
    program.cost = {0: -1.0, 1: 1.0}
    minimum = minimise(program, [square])
    assert minimum.x[:2] == pytest.approx([4.0, -2.0], abs=1e-6)
    assert proved(minimum)


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
    minimum = minimise(program, [square])
    assert minimum.x[1] == pytest.approx(np.sign(towards), abs=1e-7)
    assert minimum.value == pytest.approx(0.1 * (1 - abs(towards)), abs=1e-8)
    assert proved(minimum)
    assert minimum.nodes > 1


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
    minimum = minimise(program, [first, second])
    y, z = np.meshgrid(np.linspace(-1, 1, 801), np.linspace(-1, 1, 801))
    grid = sum(abs(f[0] * y**2 + f[1] * y + f[2] * z**2 + f[3] * z + f[4]) for f in factors)
    least = float(np.min(grid))
    assert minimum.bound <= least + 1e-9
    assert minimum.value <= least + 1e-8
    assert minimum.value > least - 0.02  # the grid's own step
    assert proved(minimum)
    assert all(square.excess(minimum.x) < 1e-7 for square in (first, second))


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
    minimum = minimise(program, [square])
    assert minimum.x[:3] == pytest.approx([0.5, -0.5, 0.5], abs=1e-6)
    assert minimum.value == pytest.approx(0.045, abs=1e-8)
    assert proved(minimum)


def test_a_ratio_without_limits() -> None:
    """|y^2 - 30| + |y - 7| over all y: at the root of 30."""
    program, square = toy(-np.inf, np.inf)
    first = size_of(program, [0], [1.0], -30.0)
    other = size_of(program, [1], [1.0], -7.0)
    program.cost = {first: 1.0, other: 1.0}
    minimum = minimise(program, [square], 30.0)
    assert minimum.x[1] == pytest.approx(np.sqrt(30), abs=1e-6)
    assert proved(minimum, 1e-6)


def test_price_of_a_limit_that_moves_the_ratio() -> None:
    """Least -y^2 with y <= 1.5: a unit more of the limit gains 2 y = 3."""
    program, square = toy(-1.0, 4.0)
    slope = Affine.fixed(1.0)
    program.nonnegative(Affine.of(1, -1.0, 1.5), "most", slope)
    program.cost = {0: -1.0}
    minimum = minimise(program, [square])
    assert minimum.value == pytest.approx(-2.25, abs=1e-8)
    assert minimum.prices["most"] == pytest.approx(3.0, rel=1e-3)


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


def test_progress_is_reported() -> None:
    program, square = hollows(0.2)
    texts: list[tuple[int, int]] = []
    minimum = minimise(program, [square], progress=lambda *pair: texts.append(pair))
    assert texts
    assert texts[-1][0] == minimum.nodes
    assert all(done <= total for done, total in texts)
