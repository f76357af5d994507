"""Strands of a belt: they touch both pulleys, and the belt is as long as a taut thread."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from equipoise.mechanism.formulas.rolling import LEFT, RIGHT, Strands

APART = 0.31 * np.exp(0.7j)
BELTS = [Strands(APART, 0.05, 0.12), Strands(APART, 0.12, 0.05), Strands(APART, 0.08, 0.08)]
CROSSED = [Strands(APART, 0.05, -0.12), Strands(APART, 0.08, -0.08)]


@pytest.mark.parametrize("belt", [*BELTS, *CROSSED])
def test_strands_are_tangents(belt: Strands) -> None:
    """A tangent is square to the radius where it touches, and both strands are mirror images."""
    for side in (LEFT, RIGHT):
        start, stop = belt.ends(side)
        way = stop - start
        np.testing.assert_allclose(way, belt.length * belt.way(side), atol=1e-15)
        assert abs(belt.way(side)) == pytest.approx(1, abs=1e-15)
        assert (abs(start), abs(stop - APART)) == pytest.approx((belt.radius, abs(belt.other)))
        for radius in (start, stop - APART):
            assert (radius.conjugate() * way).real == pytest.approx(0, abs=1e-15)
        assert np.sign((APART.conjugate() * start).imag) == side
    (left, _), (right, _) = belt.ends(LEFT), belt.ends(RIGHT)
    assert left * APART.conjugate() == pytest.approx((right * APART.conjugate()).conjugate())


@pytest.mark.parametrize("belt", BELTS)
def test_an_open_belt_is_a_thread_about_both_discs(belt: Strands) -> None:
    """Its length is the hull's circumference, by Cauchy the mean width of the hull times pi."""
    ways = np.exp(2j * pi * np.arange(20_000) / 20_000)
    far = np.maximum(belt.radius, (APART * ways.conj()).real + belt.other)
    lean = 2 * np.arcsin(belt.sine)
    arcs = belt.radius * (pi + lean) + belt.other * (pi - lean)
    assert 2 * belt.length + arcs == pytest.approx(2 * pi * far.mean(), rel=1e-7)


def test_a_crossed_belt() -> None:
    """Lengths by the sides of right triangles: strands are tangents from where they cross."""
    belt = CROSSED[0]
    split = 0.31 * 0.05 / 0.17
    assert belt.length == pytest.approx(np.sqrt(0.31**2 - 0.17**2))
    assert belt.sine == pytest.approx(0.05 / split)
    (start, stop), (other, end) = belt.ends(LEFT), belt.ends(RIGHT)
    share = split / 0.31
    assert start + share * (stop - start) == pytest.approx(other + share * (end - other))


def test_columns() -> None:
    """Numbers may be columns of designs."""
    radii = np.array([[0.05], [0.12]])
    belts = Strands(np.full((2, 1), APART), radii, np.full((2, 1), 0.05))
    for k, radius in enumerate(radii[:, 0]):
        first = Strands(APART, radius, 0.05)
        assert belts.way(LEFT)[k, 0] == first.way(LEFT)
        assert belts.length[k, 0] == first.length
