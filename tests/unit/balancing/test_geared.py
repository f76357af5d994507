"""Shafts that are added: where they are, how fast they turn, and what they can do."""

from __future__ import annotations

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.geared import Gearing, nearest, with_shafts
from equipoise.errors import UsageError
from equipoise.mechanism.parts.balance import (
    Balance,
    BalanceShafts,
    GearedWeight,
    Objective,
    Weight,
)
from support.chosen import EXHAUSTIVE
from support.refusals import refused
from unit.mechanism.build import crank_rocker, slider_crank

MACHINE = crank_rocker()  # its rocker turns about D, 1 m to the right of A
ROOM = Weight(radius=0.2, at_most=2.0)
ROCKER = GearedWeight("rocker", ROOM, ratio=(0.5, 2.0), pitch_radius=0.3)
CRANK = GearedWeight("crank", ROOM, ratio=(0.5, 2.0), pitch_radius=0.3, direction=(pi, pi))
GEARS = {"gear_thickness": 0.01, "gear_density": 7850.0}


def gearing(geared: GearedWeight, **changes: object) -> Gearing:
    return Gearing(MACHINE, replace(geared, **changes))  # type: ignore[arg-type]


def test_radii_and_place_on_the_line_of_pivots() -> None:
    result = gearing(ROCKER)
    mesh = result.mesh(2.0, result.direction)
    assert (mesh.driver, mesh.shaft, mesh.ratio) == pytest.approx((0.3, 0.15, 2.0))
    assert result.axis(mesh) == pytest.approx(1.45 + 0j)


def test_place_in_a_direction() -> None:
    result = gearing(ROCKER, direction=(pi / 2, pi / 2))
    (way,) = {mesh.direction for mesh in result.meshes()}
    assert result.axis(result.mesh(1.0, way)) == pytest.approx(1 + 0.6j)


def test_radii_follow_from_a_given_place() -> None:
    result = gearing(ROCKER, pitch_radius=None, axis=(1.3, 0.4))
    mesh = result.mesh(1.5, result.direction)
    assert (mesh.driver, mesh.shaft) == pytest.approx((0.3, 0.2))
    assert result.axis(mesh) == pytest.approx(1.3 + 0.4j)
    assert mesh.direction == pytest.approx(np.angle(0.3 + 0.4j))


def test_pairs_of_teeth() -> None:
    """Module 20 mm, 17 to 20 teeth: every pair; on a given axis those that touch."""
    teeth = {"ratio": None, "pitch_radius": None, "teeth": (17, 20), "module": 0.02}
    result = gearing(ROCKER, **teeth)
    meshes = result.meshes()
    assert len(meshes) == 16
    for mesh in meshes:
        assert mesh.teeth is not None
        assert (mesh.driver, mesh.shaft) == pytest.approx(
            (mesh.teeth[0] / 100, mesh.teeth[1] / 100)
        )
        assert mesh.ratio == pytest.approx(mesh.teeth[0] / mesh.teeth[1])
    placed = gearing(ROCKER, **teeth, axis=(1.0, 0.36))
    assert {mesh.teeth for mesh in placed.meshes()} == {(17, 19), (18, 18), (19, 17)}


def test_gears_that_do_not_mesh() -> None:
    teeth = {"ratio": None, "pitch_radius": None, "teeth": (17, 20), "module": 0.02}
    with refused(UsageError, apart=365.0, teeth=36.5, module=20.0):
        gearing(ROCKER, **teeth, axis=(1.0, 0.365)).meshes()


def test_a_rocker_may_have_any_ratio() -> None:
    result = gearing(ROCKER)
    ratios = [mesh.ratio for mesh in result.meshes()]
    assert not result.turns_fully
    assert result.ranges == {"ratio": (0.5, 2.0)}
    assert (ratios[0], ratios[-1]) == pytest.approx((0.5, 2.0))
    assert np.ptp(np.diff(np.log(ratios))) < 1e-9
    assert gearing(ROCKER, ratio=(0.7, 0.7)).ranges == {}


def test_a_crank_comes_back_after_few_turns() -> None:
    """Halves and thirds from 1/2 to 2; every one closes in three turns at the most."""
    result = gearing(CRANK)
    meshes = result.meshes()
    assert result.turns_fully
    assert result.ranges == {}
    assert sorted(mesh.ratio for mesh in meshes) == pytest.approx(
        [1 / 2, 2 / 3, 1, 4 / 3, 3 / 2, 5 / 3, 2]
    )
    assert {eq.move(result.added(mesh)[0], 1).turns for mesh in meshes} == {1, 2, 3}
    with refused(UsageError, low=0.51, high=0.6):
        gearing(CRANK, ratio=(0.51, 0.6)).meshes()


def test_a_range_of_directions() -> None:
    all_round = gearing(ROCKER, ratio=(1.0, 1.0), direction=(0.0, 2 * pi)).meshes()
    half = gearing(ROCKER, ratio=(1.0, 1.0), direction=(0.0, pi)).meshes()
    ways = np.unwrap([mesh.direction for mesh in all_round])
    assert 2 * pi - (ways[-1] - ways[0]) == pytest.approx(ways[1] - ways[0])
    assert (half[0].direction, half[-1].direction) == pytest.approx((0.0, pi))


@pytest.mark.parametrize("ratio", [0.5, 1.3])
def test_the_shaft_turns_against_its_driver(ratio: float) -> None:
    result = gearing(ROCKER)
    machine, part = result.added(result.mesh(ratio, 0.0))
    motion = eq.move(machine, 90)
    driver = motion.links["rocker"].angular_velocity
    assert motion.links["counterweight"].angular_velocity == pytest.approx(-ratio * driver)
    assert machine.links["counterweight"].mass == 0
    assert (part.link, part.at, part.center) == ("counterweight", "counterweight-axis", 0j)
    place = machine.frame["counterweight-axis"]
    assert place == pytest.approx((1 + 0.3 + 0.3 / ratio, 0.0))


def test_gears_are_solid_discs() -> None:
    """Of 10 mm steel: their masses on driver and shaft, turning about the pins."""
    result = gearing(ROCKER, **GEARS)
    machine, _ = result.added(result.mesh(1.5, 0.0))
    masses = [78.5 * pi * radius**2 for radius in (0.3, 0.2)]
    assert machine.links["counterweight"].mass == pytest.approx(masses[1])
    assert machine.links["counterweight"].inertia == pytest.approx(masses[1] * 0.2**2 / 2)
    first, other = MACHINE.links["rocker"], machine.links["rocker"]
    assert other.mass - first.mass == pytest.approx(masses[0])
    moment = (
        np.array(other.center_of_mass) * other.mass - np.array(first.center_of_mass) * first.mass
    )
    assert moment == pytest.approx(np.zeros(2), abs=1e-12)  # the pin is the link's origin
    about_pin = [
        link.inertia + link.mass * np.sum(np.square(link.center_of_mass)) for link in (first, other)
    ]
    assert about_pin[1] - about_pin[0] == pytest.approx(masses[0] * 0.3**2 / 2)


def test_change_as_the_workshop_reads_it() -> None:
    result = gearing(ROCKER, ratio=None, pitch_radius=None, teeth=(20, 30), module=0.02)
    mesh = next(mesh for mesh in result.meshes() if mesh.teeth == (30, 20))
    content = result.change(mesh).to_dict()
    assert content["kind"] == "gears"
    assert (content["driver"], content["link"]) == ("rocker", "counterweight")
    assert content["ratio"] == pytest.approx(1.5)
    assert (content["teeth"], content["module"]) == ((30, 20), 0.02)
    assert content["axis"] == pytest.approx((1.5, 0.0))


def test_links_to_stay_clear_of() -> None:
    """On the line of pivots towards the crank the coupler comes by; beyond it does not."""
    inwards = gearing(ROCKER, direction=(pi, pi), clear_of=("coupler",))
    with refused(UsageError, name="counterweight", link="coupler"):
        inwards.meshes()
    outwards = gearing(ROCKER, direction=(radians(-20), radians(-20)), clear_of=("coupler",))
    assert len(outwards.meshes()) == 33
    assert inwards.is_clear(inwards.mesh(1.0, pi)) is False


def test_nearest_place_of_a_link() -> None:
    """The crank sweeps a disc of 0.35 m; a bar is near between its ends too."""
    motion = eq.move(MACHINE, 720)
    assert nearest(motion, "crank", 1.0 + 0j) == pytest.approx(0.65, abs=1e-9)
    ends = [motion.points[name].place for name in ("B", "C")]
    share = np.linspace(0, 1, 2001)[:, None]
    dense = np.min(np.abs(ends[0] + share * (ends[1] - ends[0]) - (0.2 + 0.5j)))
    assert nearest(motion, "coupler", 0.2 + 0.5j) == pytest.approx(dense, abs=1e-4)


def test_the_best_of_all_teeth() -> None:
    """No single pair does better than the one that is chosen."""
    free = replace(ROCKER, ratio=None, pitch_radius=None, teeth=(16, 18), module=0.03)
    wish = (Objective("shaking_moment"),)
    balanced = eq.balance(MACHINE, Balance(geared=(free,), objectives=wish))
    costs = {}
    for mesh in Gearing(MACHINE, free).meshes():
        assert mesh.teeth is not None
        machine, part = Gearing(MACHINE, free).added(mesh)
        alone = eq.balance(
            machine,
            Balance(masses=(eq.balancing.AddedMass(part.link, part.at, ROOM),), objectives=wish),
        )
        costs[mesh.teeth] = alone.objectives[wish[0].name][1]
    gears, _ = balanced.changes
    assert gears.values["teeth"] == min(costs, key=lambda teeth: costs[teeth])
    assert balanced.objectives[wish[0].name][1] == pytest.approx(min(costs.values()), rel=1e-7)
    assert "9 choices of gears" in str(balanced.method)


# A ratio that is no optimum fails in `test_a_free_ratio` of tests/secondroute/test_balancing.py.
@EXHAUSTIVE
def test_a_ratio_is_followed_between_the_grid() -> None:
    """No fixed ratio of a finer grid does better."""
    wish = (Objective("shaking_moment"),)
    narrow = replace(ROCKER, ratio=(0.8, 1.6))
    balanced = eq.balance(MACHINE, Balance(geared=(narrow,), objectives=wish))
    for ratio in np.linspace(0.8, 1.6, 41):
        fixed = replace(ROCKER, ratio=(float(ratio), float(ratio)))
        first = eq.balance(MACHINE, Balance(geared=(fixed,), objectives=wish))
        assert balanced.cost <= first.cost + 1e-8


# -- balance shafts --------------------------------------------------------------------------------


def shafts(order: int, weight: Weight = ROOM) -> BalanceShafts:
    return BalanceShafts(order, ((0.2, -0.5), (0.2, 0.5)), weight)


@pytest.mark.parametrize("order", [1, 2])
def test_shafts_turn_against_each_other(order: int) -> None:
    machine, parts = with_shafts(MACHINE, shafts(order))
    motion = eq.move(machine, 90)
    for name, sign in (("balance-shaft-1", -1), ("balance-shaft-2", 1)):
        speed = motion.links[name].angular_velocity
        assert speed == pytest.approx(sign * order * motion.speed)
    assert motion.turns == 1
    assert machine.frame["balance-shaft-2-axis"] == (0.2, 0.5)
    assert [part.link for part in parts] == ["balance-shaft-1", "balance-shaft-2"]


def test_lanchester_shafts_take_the_second_order_of_an_engine() -> None:
    """Each has half of A2 / (2 w)^2, where A2 is the second harmonic of the force."""
    engine = slider_crank().with_link("rod", center_of_mass=(0.4, 0.0))  # on its line
    before = np.abs(eq.signals.harmonics(eq.forces(eq.move(engine, 720)).shaking_force.x, 4))
    plan = Balance(
        shafts=(shafts(2),),
        objectives=(Objective("shaking_force", orders=(2.0,)),),
    )
    balanced = eq.balance(engine, plan)
    force = eq.forces(eq.move(balanced.machine, 720)).shaking_force
    after = np.abs(eq.signals.harmonics(force.x, 4))
    assert before[2] > 0
    assert after[2] < 1e-7 * before[2]
    assert np.abs(eq.signals.harmonics(force.y, 4))[2] < 1e-7 * before[2]
    assert after[[1, 4]] == pytest.approx(before[[1, 4]], rel=1e-7)
    wanted = before[2] / 2 / (2 * engine.drive.speed) ** 2
    assert [change.values["moment"] for change in balanced.changes] == pytest.approx(
        [wanted, wanted], rel=1e-6
    )
