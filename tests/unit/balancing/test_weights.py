"""Added masses, and the pieces that stand for them, against integrals over real bodies.

Integrals are exact to rounding.  Two points stand for a spread mass by the root of a small
difference, and one sector for one that throws farther than two by rounding: 1e-7.
"""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from equipoise.balancing.design_variables import AddedWeight, MovedCenter
from equipoise.balancing.program import Affine, NoSolutionError, Program
from equipoise.balancing.workshop import pieces_of
from equipoise.mechanism.parts.balance import SHAPES, CenterMove, Weight, WeightShape, largest_mass
from unit.balancing.bodies import (
    PLATE,
    ROOMS,
    Array,
    farthest,
    machine_with_a_room,
    moments_of,
    part_of,
    random_numbers,
)

SHAPED = pytest.mark.parametrize("shape", SHAPES)
SEEDS = pytest.mark.parametrize("seed", range(6))


def program_of(part: AddedWeight) -> tuple[Program, Array]:
    program = Program()
    places = program.numbers(part.count)
    part.constrain(program, places)
    return program, places


def holds(part: AddedWeight, numbers: Array, slack: float = 1e-9) -> bool:
    """Whether numbers are allowed, but for slack."""
    program, places = program_of(part)
    rows = np.eye(part.count)
    program.nonnegative(Affine(rows, places, slack - numbers))
    program.nonnegative(Affine(-rows, places, slack + numbers))
    return program.feasible()


def least(part: AddedWeight, cost: dict[str, float]) -> Array:
    """Numbers at the least cost, given by their names."""
    program, places = program_of(part)
    program.cost = {int(places[part.names.index(name)]): x for name, x in cost.items()}
    return np.asarray(program.solve().x[places])


@SHAPED
@SEEDS
def test_effect_is_that_of_a_real_body(shape: WeightShape, seed: int) -> None:
    part = part_of(ROOMS[shape])
    numbers, wanted = random_numbers(part, np.random.default_rng(seed))
    scale = np.array([1, part.reach, part.reach, part.reach**2]) * wanted[0]
    assert (numbers @ part.effect - wanted) / scale == pytest.approx(np.zeros(4), abs=1e-12)


@SHAPED
@SEEDS
def test_every_real_body_is_allowed(shape: WeightShape, seed: int) -> None:
    part = part_of(ROOMS[shape])
    numbers, _ = random_numbers(part, np.random.default_rng(seed))
    assert holds(part, numbers, 1e-9)


@pytest.mark.parametrize("shape", ["any", "point", "disc", "sector"])
def test_no_body_reaches_beyond_its_room(shape: WeightShape) -> None:
    """The largest first moment of a given mass, by the bodies' own formulas."""
    weight = replace(ROOMS[shape], at_most=None, mass=0.3)
    part = part_of(weight)
    result = least(part, {"x": -1.0})
    plate, room, inner = 0.008 * 7850.0, weight.radius, weight.inner_radius
    half = 0.3 / (plate * (room**2 - inner**2))
    wanted = {
        "any": 0.3 * room,
        "point": 0.3 * room,
        "disc": 0.3 * (room - np.sqrt(0.3 / (pi * plate))),
        "sector": 2 / 3 * plate * (room**3 - inner**3) * np.sin(half),
    }[shape]
    assert result[1] * part.mass_unit * part.reach == pytest.approx(wanted, rel=1e-7)


@pytest.mark.parametrize("angle", [0.3, 1.2, pi / 2, 2.4, 3.1])
def test_moment_of_a_sector_follows_the_sine(angle: float) -> None:
    """Its half angle: past a right angle more mass throws less."""
    weight = ROOMS["sector"]
    mass = 0.008 * 7850.0 * (weight.radius**2 - weight.inner_radius**2) * angle
    part = part_of(replace(weight, mass=mass))
    result = least(part, {"x": -0.6, "y": -0.8})
    most = 2 / 3 * 0.008 * 7850.0 * (weight.radius**3 - weight.inner_radius**3)
    moment = np.hypot(*result[1:]) * part.mass_unit * part.reach
    assert moment == pytest.approx(most * np.sin(angle), rel=1e-6)


def test_the_best_sector_is_half_a_ring() -> None:
    part = part_of(ROOMS["sector"])
    result = least(part, {"x": -1.0})
    assert result[0] * part.mass_unit == pytest.approx(largest_mass(part.weight) / 2, rel=1e-4)


def test_sectors_that_there_can_be_are_not_cut_off() -> None:
    program, _ = program_of(part_of(ROOMS["sector"]))
    (cutter,) = program.cutters
    assert not cutter(np.array([0.5, 0.1, 0.1]))
    cuts = cutter(np.array([0.5, 0.7, 0.7]))
    assert len(cuts) > 1
    assert all(block.slack(np.array([0.5, 0.7, 0.7]))[0] < 0 for block in cuts)
    assert all(block.slack(np.array([0.5, 0.1, 0.1]))[0] > 0 for block in cuts)


def test_the_best_disc() -> None:
    """m (R - sqrt(m / (pi plate))) is largest where the disc's radius is two thirds of the room."""
    part = part_of(ROOMS["disc"])
    result = least(part, {"y": -1.0})
    plate = 0.008 * 7850.0
    assert result[0] * part.mass_unit == pytest.approx(plate * pi * (0.04) ** 2, rel=1e-4)
    assert result[2] * part.mass_unit * part.reach == pytest.approx(plate * pi * 0.04**2 * 0.02)


@SHAPED
def test_without_a_moment_there_is_no_mass(shape: WeightShape) -> None:
    """A disc about its point stayed as heavy as it was: 0.8 kg without any use."""
    part = part_of(ROOMS[shape])
    numbers = np.zeros(part.count)
    numbers[0] = 0.5
    assert part.minimize_added_mass(numbers, np.zeros(part.count, dtype=bool))[0] == 0.0


@pytest.mark.parametrize("shape", ["disc", "ring", "sector"])
def test_no_more_mass_than_fits(shape: WeightShape) -> None:
    part = part_of(ROOMS[shape])
    result = least(part, {"m": -1.0})
    assert result[0] * part.mass_unit == pytest.approx(largest_mass(part.weight), rel=1e-6)


@SHAPED
def test_price_of_the_most_mass(shape: WeightShape) -> None:
    """Named after its link, for each kg."""
    part = part_of(replace(ROOMS[shape], at_most=0.1))
    program, places = program_of(part)
    program.cost = {int(places[0]): -1.0}
    assert program.solve().prices["mass on crank"] == pytest.approx(1 / part.mass_unit, rel=1e-6)


def test_price_of_the_radius() -> None:
    """Of a point of 0.7 kg thrown outwards: 0.7 kg m for each m."""
    part = part_of(ROOMS["point"])
    program, places = program_of(part)
    outwards = -part.mass_unit * part.reach
    program.cost = {int(places[1]): 0.6 * outwards, int(places[2]): 0.8 * outwards}
    assert program.solve().prices["radius on crank"] == pytest.approx(0.7, rel=1e-6)


def test_price_of_the_radius_for_inertia() -> None:
    part = part_of(ROOMS["any"])
    program, places = program_of(part)
    program.cost = {int(places[3]): -part.mass_unit * part.reach**2}
    assert program.solve().prices["radius on crank"] == pytest.approx(0.7 * 2 * 0.06, rel=1e-6)


def test_a_given_mass_is_kept() -> None:
    part = part_of(Weight("any", 0.06, mass=0.2))
    assert least(part, {"m": -1.0})[0] * part.mass_unit == pytest.approx(0.2)
    part = part_of(Weight("point", mass=0.2))  # in a room without end
    assert least(part, {"m": 1.0})[0] * part.mass_unit == pytest.approx(0.2)


@pytest.mark.parametrize("shape", ["point", "disc", "ring"])
def test_squares_lie_on_or_above_their_parabolas(shape: WeightShape) -> None:
    part = part_of(ROOMS[shape])
    program, places = program_of(part)
    squares = part.constrain(Program(part.count), places)
    assert len(squares) == {"point": 2, "disc": 3, "ring": 1}[shape]
    program.cost = {square.lift: -1.0 for square in squares} | {int(places[0]): 0.5}
    x = program.solve().x
    assert all(square.excess(x) >= -1e-8 for square in squares)
    tight = part.project_feasible(x[places], np.ones(part.count, bool))
    full = np.zeros(program.count)
    full[places] = tight
    assert [square.excess(full) for square in squares] == pytest.approx([0] * len(squares))


def test_inertia_that_does_not_matter_is_least() -> None:
    part = part_of(ROOMS["any"])
    numbers = np.array([0.5, 0.2, 0.1, 0.4])
    matters = np.array([True, True, True, False])
    assert part.project_feasible(numbers, matters)[3] == pytest.approx((0.2**2 + 0.1**2) / 0.5)
    assert part.project_feasible(numbers, ~matters)[3] == pytest.approx(0.4)


def test_a_trace_of_mass_is_none() -> None:
    part = part_of(ROOMS["point"])
    result = part.project_feasible(np.array([1e-8, 1e-8, 0, 1e-8, 0]), np.ones(5, bool))
    assert not np.any(result)
    (change,) = part.changes(result)
    assert change.values["pieces"] == []
    assert change.values["moment"] == change.values["radius"] == 0.0


@SHAPED
def test_change_as_the_workshop_reads_it(shape: WeightShape) -> None:
    part = part_of(ROOMS[shape])
    numbers, (mass, x, y, _) = random_numbers(part, np.random.default_rng(8))
    (change,) = part.changes(numbers)
    moment = complex(x, y) - mass * part.center
    content = change.to_dict()
    assert (content["kind"], content["link"], content["at"]) == ("added mass", "crank", "R")
    assert content["mass"] == pytest.approx(mass, rel=1e-5)
    assert content["moment"] == pytest.approx(abs(moment), rel=1e-4, abs=1e-9)
    if shape != "ring":
        assert content["direction"] == pytest.approx(np.angle(moment), abs=1e-5)
        assert content["radius"] == pytest.approx(abs(moment) / mass, rel=1e-4)


# -- moved centres of mass -------------------------------------------------------------------------


def moved(**room: object) -> MovedCenter:
    return MovedCenter(machine_with_a_room(), CenterMove("rocker", **room))  # type: ignore[arg-type]


def best_center(part: MovedCenter, *cost: float) -> tuple[Array, dict[str, float]]:
    program = Program()
    places = program.numbers(4)
    part.constrain(program, places)
    program.cost = dict(zip(map(int, places), cost, strict=True))
    solution = program.solve()
    return solution.x[places], solution.prices


def test_effect_of_a_moved_center() -> None:
    part = moved(x=(-0.2, 0.3), y=(-0.1, 0.1))
    mass = 0.5
    numbers = part.project_feasible(np.array([0.3, -0.1, 9.0, 9.0]), np.ones(4, bool))
    place = np.array([0.3, -0.1]) * part.length
    wanted = mass * np.array([0, *place, place @ place])
    assert numbers @ part.effect == pytest.approx(wanted)
    (change,) = part.changes(numbers)
    assert change.values["to"] == pytest.approx(tuple(place))
    assert change.values["from"] == pytest.approx((0.4 * 0.8 + 0.01, 0.03))


def test_center_stays_in_its_rectangle() -> None:
    part = moved(x=(-0.2, 0.3), y=(-0.1, 0.1))
    actual, _ = best_center(part, -1.0, 1.0, 0.0, 0.0)
    assert actual[:2] * part.length == pytest.approx([0.3, -0.1], abs=1e-7)
    lifted, _ = best_center(part, 0.0, 0.0, -1.0, -1.0)
    assert lifted[2] * part.length**2 == pytest.approx(0.3**2)
    with pytest.raises(NoSolutionError):
        best_center(moved(x=(0.3, -0.2)), 0.0, 0.0, 0.0, 0.0)


def test_center_stays_in_its_circle() -> None:
    """And a unit more of radius moves it a unit farther."""
    part = moved(center=(0.1, 0.05), radius=0.04)
    actual, prices = best_center(part, -0.6, -0.8, 0.0, 0.0)
    assert actual[:2] * part.length == pytest.approx([0.124, 0.082], abs=1e-7)
    (price,) = prices.values()
    assert price * part.length == pytest.approx(1.0, rel=1e-6)


def check(part: AddedWeight, numbers: Array, within: float) -> list[dict[str, object]]:
    """That pieces lie in the room and add up."""
    (change,) = part.changes(numbers)
    pieces = change.values["pieces"]
    wanted = numbers @ part.effect
    result = sum(moments_of(piece, part.center) for piece in pieces)
    scale = np.array([1, part.reach, part.reach, part.reach**2]) * wanted[0]
    assert (result - wanted) / scale == pytest.approx(np.zeros(4), abs=within)
    assert sum(piece["mass"] for piece in pieces) == pytest.approx(wanted[0])
    for piece in pieces:
        assert farthest(piece, part.center) <= part.weight.radius * (1 + 1e-9)
    return list(pieces)


@pytest.mark.parametrize("shape", SHAPES)
@SEEDS
def test_pieces_add_up_and_stay_in_the_room(shape: WeightShape, seed: int) -> None:
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
    first, other = check(part, numbers, 1e-7)
    apart = abs(np.angle(np.exp(1j * (first["direction"] - other["direction"]))))
    assert apart >= first["angle"] * (1 - 1e-9)
    assert first["angle"] == other["angle"]


def test_sectors_without_moment_face_each_other() -> None:
    part = part_of(ROOMS["sector"])
    first, other = check(part, np.array([0.4, 0.0, 0.0]), 1e-7)
    assert abs(first["direction"] - other["direction"]) == pytest.approx(pi)


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
    assert pieces_of(Weight("any", 0.06), 0.0, 0j, 0.0, 0j) == []


def test_spread_mass_about_the_centre_itself() -> None:
    first, other = pieces_of(Weight("any", 0.06), 0.4, 0j, 0.4 * 0.05**2, 1 + 1j)
    both = complex(*first["place"]) + complex(*other["place"])
    assert both == pytest.approx(2 + 2j)
    assert abs(complex(*first["place"]) - 1 - 1j) == pytest.approx(0.05)


def test_sizes_of_disc_and_ring() -> None:
    """Areas times the plate's mass give back the mass."""
    plate = PLATE["thickness"] * PLATE["density"]
    (disc,) = pieces_of(ROOMS["disc"], 0.2, 0.002 + 0j, 0.0, 0j)
    assert plate * pi * disc["radius"] ** 2 == pytest.approx(0.2)
    assert disc["place"] == pytest.approx((0.01, 0.0))
    (ring,) = pieces_of(ROOMS["ring"], 0.2, 0j, 0.0, 0j)
    assert plate * pi * (ring["outer_radius"] ** 2 - 0.015**2) == pytest.approx(0.2)
