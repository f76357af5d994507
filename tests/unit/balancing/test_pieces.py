"""Pieces against what they stand for: integrals over them add up to the numbers that were found.

Two points stand for a spread mass by the root of a small difference, and one sector for one that
throws farther than two by rounding: 1e-7.
"""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from equipoise.balancing.weights import AddedWeight
from equipoise.balancing.workshop import pieces_of
from equipoise.mechanism.balance import SHAPES, Shape, Weight
from unit.balancing.bodies import PLATE, ROOMS, Array, farthest, moments_of, part_of, random_numbers

SEEDS = pytest.mark.parametrize("seed", range(6))


def check(part: AddedWeight, numbers: Array, within: float) -> list[dict[str, object]]:
    """That pieces lie in the room and add up."""
    (change,) = part.changes(numbers)
    pieces = change.values["pieces"]
    wanted = numbers @ part.effect
    found = sum(moments_of(piece, part.center) for piece in pieces)
    scale = np.array([1, part.reach, part.reach, part.reach**2]) * wanted[0]
    assert (found - wanted) / scale == pytest.approx(np.zeros(4), abs=within)
    assert sum(piece["mass"] for piece in pieces) == pytest.approx(wanted[0])
    for piece in pieces:
        assert farthest(piece, part.center) <= part.weight.radius * (1 + 1e-9)
    return list(pieces)


@pytest.mark.parametrize("shape", SHAPES)
@SEEDS
def test_pieces_add_up_and_stay_in_the_room(shape: Shape, seed: int) -> None:
    part = part_of(ROOMS[shape])
    numbers, _ = random_numbers(part, np.random.default_rng(100 + seed))
    pieces = check(part, numbers, 1e-7)
    assert len(pieces) == (2 if shape == "any" else 1)
    assert {piece["shape"] for piece in pieces} == {"point" if shape == "any" else shape}


@SEEDS
def test_sectors_that_throw_less_are_two(seed: int) -> None:
    """They do not overlap, and their inertia is that of one."""
    part = part_of(ROOMS["sector"])
    rng = np.random.default_rng(seed)
    numbers, _ = random_numbers(part, rng)
    numbers[1:] *= rng.uniform(0.0, 0.95)
    one, other = check(part, numbers, 1e-7)
    apart = abs(np.angle(np.exp(1j * (one["direction"] - other["direction"]))))
    assert apart >= one["angle"] * (1 - 1e-9)
    assert one["angle"] == other["angle"]


def test_sectors_without_moment_face_each_other() -> None:
    part = part_of(ROOMS["sector"])
    one, other = check(part, np.array([0.4, 0.0, 0.0]), 1e-7)
    assert abs(one["direction"] - other["direction"]) == pytest.approx(pi)


def test_a_full_ring_of_a_sector_is_one_piece() -> None:
    part = part_of(ROOMS["sector"])
    (piece,) = check(part, np.array([1.0, 0.0, 0.0]), 1e-7)
    assert piece["angle"] == pytest.approx(2 * pi)


def test_spread_of_two_points() -> None:
    """0.4 kg with 3e-4 kg m2 about the centre and its middle at 20 mm: 18.71 mm to either side."""
    weight = Weight("any", 0.06)
    first, second = pieces_of(weight, 0.4, 0.4 * 0.02j, 3e-4, 0j)
    aside = np.sqrt(3e-4 / 0.4 - 0.02**2)
    places = sorted([first["place"], second["place"]])
    assert places[0] == pytest.approx((-aside, 0.02))
    assert places[1] == pytest.approx((aside, 0.02))
    assert first["mass"] == second["mass"] == 0.2


def test_a_spread_of_rounding_is_one_point() -> None:
    (piece,) = pieces_of(Weight("any", 0.06), 0.4, 0.4 * 0.02, 0.4 * 0.02**2 * (1 + 1e-9), 0.1j)
    assert piece["place"] == pytest.approx((0.02, 0.1))
    assert pieces_of(Weight("any", 0.06), 1e-10, 0j, 0.0, 0j) == []


def test_spread_mass_about_the_centre_itself() -> None:
    one, other = pieces_of(Weight("any", 0.06), 0.4, 0j, 0.4 * 0.05**2, 1 + 1j)
    both = complex(*one["place"]) + complex(*other["place"])
    assert both == pytest.approx(2 + 2j)
    assert abs(complex(*one["place"]) - 1 - 1j) == pytest.approx(0.05)


def test_sizes_of_disc_and_ring() -> None:
    """Areas times the plate's mass give back the mass."""
    plate = PLATE["thickness"] * PLATE["density"]
    (disc,) = pieces_of(ROOMS["disc"], 0.2, 0.002 + 0j, 0.0, 0j)
    assert plate * pi * disc["radius"] ** 2 == pytest.approx(0.2)
    assert disc["place"] == pytest.approx((0.01, 0.0))
    (ring,) = pieces_of(ROOMS["ring"], 0.2, 0j, 0.0, 0j)
    assert plate * pi * (ring["outer_radius"] ** 2 - 0.015**2) == pytest.approx(0.2)
