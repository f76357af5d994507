"""Squares that a program can only keep above: their chords, values and tangents."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.design_variables import Change, Square, with_parameters
from equipoise.balancing.program import Affine, NoSolutionError, Program
from equipoise.mechanism.parameters import parameter_values

OVER = pytest.mark.parametrize("w", [None, 0.5, 2.0])


def started(w: float | None) -> tuple[Program, Square]:
    """lift = y^2 / w over ratios from -1 to 3, with w given."""
    program = Program()
    lift, y, over = map(int, program.numbers(3))
    program.zero(Affine.of(over, 1.0, -(1.0 if w is None else w)))
    square = Square(lift, y, None if w is None else over, -1.0, 3.0)
    square.keep_above(program)
    return program, square


def lift_at(program: Program, y: float, sign: float = 1.0) -> float:
    """The least lift (sign 1) or the most (-1) with y given."""
    program = program.copy()
    program.zero(Affine.of(1, 1.0, -y))
    program.cost = {0: sign}
    return float(program.solve().x[0])


@OVER
@pytest.mark.parametrize("ratio", [-0.8, 0.0, 1.7, 3.0])
def test_lift_lies_between_square_and_chord(w: float | None, ratio: float) -> None:
    program, square = started(w)
    square.keep_between(program, square.low, square.high)
    over = 1.0 if w is None else w
    assert lift_at(program, ratio * over) == pytest.approx(ratio**2 * over, abs=1e-7)
    chord = (2 * ratio + 3) * over  # through the squares of -1 and 3
    assert lift_at(program, ratio * over, -1.0) == pytest.approx(chord, abs=1e-6)


@OVER
@pytest.mark.parametrize("ratio", [-1.01, 3.01])
def test_ratio_stays_between(w: float | None, ratio: float) -> None:
    program, square = started(w)
    square.keep_between(program, square.low, square.high)
    with pytest.raises(NoSolutionError):
        lift_at(program, ratio * (1.0 if w is None else w))


def test_without_an_end_there_is_no_chord() -> None:
    program, square = started(None)
    square.keep_between(program, -np.inf, 2.0)
    assert lift_at(program, -50.0) == pytest.approx(2500.0, rel=1e-8)
    with pytest.raises(NoSolutionError):
        lift_at(program, 2.1)


@OVER
def test_ratio_held(w: float | None) -> None:
    program, square = started(w)
    square.keep_at(program, 1.5)
    over = 1.0 if w is None else w
    program.cost = {0: -1.0}
    assert program.solve().x[:2] == pytest.approx([2.25 * over, 1.5 * over], abs=1e-7)


@OVER
def test_tangent_near_a_ratio(w: float | None) -> None:
    """Within the square's own lower bound there is one point of it: where it touches."""
    program = Program(3)
    over = 1.0 if w is None else w
    square = Square(0, 1, None if w is None else 2, -1.0, 3.0)
    program.zero(Affine.of(2, 1.0, -over))
    square.keep_tangent(program, 1.5, 0.2)
    for ratio in (1.3, 1.5, 1.7):
        tangent = (2 * 1.5 * ratio - 1.5**2) * over
        assert lift_at(program, ratio * over) == pytest.approx(tangent, abs=1e-7)
    with pytest.raises(NoSolutionError):
        lift_at(program, 1.75 * over)


def test_ratio_and_what_is_missed() -> None:
    square = Square(0, 1, 2, -1.0, 3.0)
    assert square.ratio(np.array([9.0, 4.0, 2.0])) == 2.0
    assert square.missed(np.array([9.0, 4.0, 2.0])) == 1.0
    assert square.missed(np.array([7.0, 4.0, 2.0])) == 0.0
    assert square.ratio(np.array([9.0, -40.0, 2.0])) == -1.0
    assert square.ratio(np.array([0.0, 0.0, 0.0])) == 0.0
    alone = Square(0, 1, None, -1.0, 3.0)
    assert alone.ratio(np.array([9.0, 2.5, 0.0])) == 2.5
    assert alone.missed(np.array([9.0, 2.5, 0.0])) == 2.75


def test_parameters_given_and_read_back() -> None:
    machine = eq.load("yamashita-1")
    wanted = np.array([0.7, 0.01, -0.02, 3e-3])
    changed = with_parameters(machine, "coupler", wanted)
    values = parameter_values(changed).reshape(-1, 4)
    k = list(machine.links).index("coupler")
    assert values[k] == pytest.approx(wanted)
    assert np.delete(values, k, 0) == pytest.approx(
        np.delete(parameter_values(machine).reshape(-1, 4), k, 0)
    )


def test_rounding_leaves_no_negative_inertia_or_mass() -> None:
    machine = eq.load("yamashita-1")
    point = with_parameters(machine, "coupler", np.array([0.5, 0.05, 0.0, 0.005 - 1e-18]))
    assert point.links["coupler"].inertia == 0.0
    gone = with_parameters(machine, "coupler", np.array([-1e-20, 0.0, 0.0, 0.0]))
    assert gone.links["coupler"].mass == 0.0


def test_a_change_as_a_dictionary() -> None:
    change = Change("spring", "rocker", {"stiffness": 3.0})
    assert change.to_dict() == {"kind": "spring", "link": "rocker", "stiffness": 3.0}
