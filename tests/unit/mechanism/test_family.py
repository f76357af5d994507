"""Machines solved in a stack move as each does alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.family import Family
from support.machines import make
from unit.mechanism.build import ORIGIN, body, four_bar, machine

WITHIN = 1e-13
"""Of the largest value: sums are taken in another order."""
THETA = np.linspace(0.1, 6.2, 17)


def designs_of(given: eq.Machine, count: int, seed: int = 0) -> list[eq.Machine]:
    """The machine and others with every point of the frame and of the links moved a little."""
    rng = np.random.default_rng(seed)
    result = [given]
    while len(result) < count:
        links = {
            name: replace(link, points={p: moved(place, rng) for p, place in link.points.items()})
            for name, link in given.links.items()
        }
        frame = {p: moved(place, rng) for p, place in given.frame.items()}
        result.append(replace(given, links=links, frame=frame))
    return result


def moved(place: tuple[float, float], rng: np.random.Generator) -> tuple[float, float]:
    x, y = np.array(place) * rng.uniform(0.97, 1.03, 2)
    return float(x), float(y)


def rows(count: int) -> np.ndarray:
    """Other crank angles for each machine, (P, K)."""
    return THETA + np.arange(count)[:, None] * 0.37


def same_as_alone(designs: Sequence[eq.Machine]) -> Family:
    """Compare every point and link of a stack with each machine by itself."""
    family = Family([eq.mechanism.assemble(design) for design in designs])
    theta = rows(len(designs))
    state = family.solve(theta)
    alone = [eq.move(design, row) for design, row in zip(designs, theta, strict=True)]
    for link, given in designs[0].links.items():
        for point in given.points:
            triple = family.point(state, link, point)
            for order, part in enumerate(("place", "place_1", "place_2")):
                want = np.array([getattr(motion.points[point], part) for motion in alone])
                close(triple[order], want)
        for order, part in enumerate(("angle_1", "angle_2")):
            want = np.array([getattr(motion.links[link], part) for motion in alone])
            close(family.rates(state, link)[order], want)
    return family


def close(found: np.ndarray, want: np.ndarray) -> None:
    assert found.shape == want.shape
    largest = float(np.max(np.abs(want))) or 1.0
    np.testing.assert_allclose(found, want, rtol=0, atol=WITHIN * largest)


@pytest.mark.parametrize("count", [1, 2, 9])
def test_crank_rockers(count: int) -> None:
    family = same_as_alone(designs_of(eq.load("kim-chung-b"), count))
    assert family.steps is not None


@pytest.mark.parametrize(
    "kind", ["slider_crank", "stephenson", "quick_return", "scotch_yoke", "v_twin"]
)
def test_other_linkages_of_dyads(kind: str) -> None:
    family = same_as_alone(designs_of(make(kind, 1).machine, 3))
    assert family.steps is not None


@pytest.mark.parametrize("name", ["planetary-planting-arm", "geared-counterweight", "class-three"])
def test_gears_and_loops_are_solved_one_by_one(name: str) -> None:
    """Their steps tell turns and poses of one machine."""
    family = same_as_alone(designs_of(eq.load(name), 3))
    assert family.steps is None


def test_a_crank_alone() -> None:
    """Nothing but the drive is known, and its rates are those of the crank angle."""
    cranks = [machine({"A": ORIGIN}, {"crank": body(A=ORIGIN, P=(r, 0.1))}) for r in (0.1, 0.2)]
    family = same_as_alone(cranks)
    first, second = family.rates(family.solve(rows(2)), "crank")
    assert np.all(first == 1.0) and np.all(second == 0.0)
    assert family.margins(family.solve(rows(2))).shape == (2, len(THETA))


def test_numbers_are_squared_sines_of_transmission_angles() -> None:
    designs = designs_of(eq.load("kim-chung-a"), 4)
    family = Family([eq.mechanism.assemble(design) for design in designs])
    theta = rows(4)
    found = family.margins(family.solve(theta))
    for row, design, angles in zip(found, designs, theta, strict=True):
        points = eq.move(design, angles).points
        coupler, rocker = (points["C"].place - points[p].place for p in "BD")
        sine = (np.conj(coupler) * rocker).imag / np.abs(coupler * rocker)
        np.testing.assert_allclose(row, sine**2, atol=1e-13)


def test_a_design_that_stays_open_has_negative_numbers() -> None:
    """Frame 1, crank 0.35, coupler 0.9: a rocker of 0.3 is too short for parts of the turn."""
    good, bad = four_bar(1.0, 0.35, 0.9, 0.8), four_bar(1.0, 0.35, 0.9, 0.3)
    family = Family([eq.mechanism.assemble(good), eq.mechanism.assemble(bad)])
    theta = np.broadcast_to(np.linspace(0, 2 * np.pi, 90), (2, 90))
    numbers = family.margins(family.solve(theta))
    gap = np.abs(1.0 - 0.35 * np.exp(1j * theta[1]))
    reach = (gap < 0.9 + 0.3) & (gap > 0.9 - 0.3)
    assert np.all(numbers[0] > 0)
    assert 0 < np.count_nonzero(reach) < 90
    np.testing.assert_array_equal(numbers[1] > 0, reach)


def test_points_of_the_frame_may_differ_from_design_to_design() -> None:
    given = eq.load("kim-chung-a")
    shifted = replace(given, frame={p: (x + 1.0, y - 2.0) for p, (x, y) in given.frame.items()})
    family = Family([eq.mechanism.assemble(given), eq.mechanism.assemble(shifted)])
    place = family.point(family.solve(np.broadcast_to(THETA, (2, 17))), "coupler", "P")[0]
    np.testing.assert_allclose(place[1] - place[0], 1 - 2j, atol=1e-14)
