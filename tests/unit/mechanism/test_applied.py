"""Applied forces: soil and springs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError, MotionError
from equipoise.mechanism.dynamics.loads import acting_elements, resistance, soil_force
from equipoise.mechanism.dynamics.parameters import spring_units
from equipoise.mechanism.kinematics.tip import surface_of
from equipoise.mechanism.parts.field import Planting, Soil, SoilTable
from equipoise.results.remarks import linkage_remarks
from support import refusals
from unit.mechanism.build import ORIGIN, crank_rocker, four_bar, refused

EXAMPLES = ("kim-chung-a", "kim-chung-b")
"""With a crank that turns counterclockwise, and clockwise."""
TABLE = SoilTable((0.01, 0.02, 0.03), (4.0, 10.0, 8.0))
TERMS: dict[str, tuple[Soil, Any]] = {
    # soil, and the size of its force at depth d and speed v
    "resistance": (Soil(resistance=7.0), lambda d, v: 7 + 0 * d),
    "per_depth": (Soil(per_depth=300.0), lambda d, v: 300 * d),
    "per_speed": (Soil(per_speed=5.0), lambda d, v: 5 * v),
    "per_depth_and_speed": (Soil(per_depth_and_speed=90.0), lambda d, v: 90 * d * v),
    "table": (Soil(table=TABLE), lambda d, v: by_hand(d)),
    "all": (
        Soil(1.0, 20.0, 3.0, 40.0, TABLE),
        lambda d, v: 1 + 20 * d + 3 * v + 40 * d * v + by_hand(d),
    ),
}


def by_hand(depth: Any) -> Any:
    """TABLE: 4 N down to 10 mm, 10 N at 20 mm, 8 N from 30 mm on."""
    rising = 4 + (depth - 0.01) * 600
    falling = 10 - (depth - 0.02) * 200
    return np.clip(np.minimum(rising, falling), np.where(depth < 0.02, 4, 8), None)


def planted(name: str, soil: Soil, **more: Any) -> eq.Machine:
    return eq.load(name).with_planting(soil=soil, **more)


def below(motion: eq.mechanism.Motion) -> Any:
    """Depth of the tip, m."""
    return surface_of(motion.machine) - motion.points["P"].y


def over_ground(motion: eq.mechanism.Motion) -> Any:
    planting = motion.machine.planting
    assert planting is not None
    return motion.points["P"].velocity + planting.forward(motion.speed)


@pytest.mark.parametrize("term", TERMS)
@pytest.mark.parametrize("name", EXAMPLES)
@pytest.mark.parametrize("travel", ["forward", "backward"])
def test_size_and_direction(term: str, name: str, travel: str) -> None:
    soil, size = TERMS[term]
    motion = eq.move(planted(name, soil, travel=travel), 720)
    force, depth, velocity = soil_force(motion), below(motion), over_ground(motion)
    inside = depth > 0
    assert 100 < np.count_nonzero(inside) < 400
    assert not np.any(force[~inside])
    along = force[inside] / velocity[inside]
    assert np.all(along.real < 0)
    np.testing.assert_allclose(along.imag, 0, atol=1e-12 * np.max(np.abs(along)))
    wanted = size(depth[inside], np.abs(velocity[inside]))
    np.testing.assert_allclose(np.abs(force[inside]), wanted, rtol=1e-12)


def test_a_table_is_linear_between_its_rows_and_constant_beyond() -> None:
    depth = np.array([0.0, 0.005, 0.01, 0.015, 0.02, 0.025, 0.03, 0.5])
    result = resistance(Soil(table=TABLE), depth, np.zeros(8))
    np.testing.assert_allclose(result, [4, 4, 4, 7, 10, 9, 8, 8], rtol=1e-14)


def test_a_table_of_one_row_is_a_constant() -> None:
    result = resistance(Soil(table=SoilTable((0.02,), (6.0,))), np.array([0.0, 0.02, 1.0]), 0.0)  # type: ignore[arg-type]
    np.testing.assert_array_equal(result, [6, 6, 6])


def test_a_tip_at_rest_over_ground_is_not_pushed() -> None:
    """At speed 0 with hills to be spaced, neither crank nor machine moves."""
    hills = eq.load("kim-chung-a").with_planting(
        forward_speed=None, hill_spacing=0.15, soil=Soil(resistance=7.0)
    )
    assert not np.any(soil_force(eq.move(hills, 90, speed=0.0)))
    assert np.any(soil_force(eq.move(planted("kim-chung-a", Soil(7.0)), 90, speed=0.0)))


def test_no_soil_no_force() -> None:
    for machine in (eq.load("kim-chung-a"), eq.load("yamashita-1")):
        force = soil_force(eq.move(machine, 90))
        assert force.shape == (90,)
        assert not np.any(force)


def test_hills_tie_the_travel_to_the_crank() -> None:
    """Twice the speed doubles every velocity: the force per speed too, the constant not."""
    for soil, factor in ((Soil(resistance=7.0), 1), (Soil(per_speed=5.0), 2)):
        machine = planted("kim-chung-b", soil, forward_speed=None, hill_spacing=0.16)
        slow, fast = (soil_force(eq.move(machine, 360, speed=speed)) for speed in (-10.0, -20.0))
        np.testing.assert_allclose(fast, factor * slow, rtol=1e-13)


def test_reversing_the_crank_reverses_the_force_with_the_travel() -> None:
    machine = planted("kim-chung-a", Soil(1.0, 20.0, 3.0, 40.0, TABLE))
    back = machine.with_planting(travel="backward")
    ahead, reverse = (
        soil_force(eq.move(machine, 360)),
        soil_force(eq.move(back, 360, speed=-8 * np.pi)),
    )
    np.testing.assert_allclose(reverse, -ahead, atol=1e-12 * np.max(np.abs(ahead)))


# -- at given crank angles -------------------------------------------------------------------------


def test_given_crank_angles_get_the_force_of_the_cycle() -> None:
    machine = planted("kim-chung-a", TERMS["all"][0])
    whole = soil_force(eq.move(machine, 360))
    some = [250, 200, 10, 240]
    force = soil_force(eq.move(machine, np.radians([*some, 250 + 720, 200 - 360])))
    np.testing.assert_allclose(force, whole[[*some, 250, 200]], atol=1e-10)


def test_a_crank_that_swings_needs_a_surface() -> None:
    """Without a whole turn nothing tells the lowest point, from which a depth counts."""
    values = Planting(tip="C", forward_speed=0.6, surface=0.89, soil=Soil(resistance=7.0))
    swinging = four_bar(1.0, 0.9, 0.5, 0.9, planting=values)
    angles = np.array([0.5, 0.8, 1.1, 1.4])
    motion = eq.analyze(swinging, angles).forces.motion
    np.testing.assert_array_equal(soil_force(motion) != 0, motion.points["C"].y < 0.89)
    assert 0 < np.count_nonzero(soil_force(motion)) < 4
    deep = replace(swinging, planting=replace(values, surface=None, depth=0.1))
    with refusals.refused(MotionError, first="B", second="D", joint="C"):
        soil_force(eq.move(deep, angles))


# -- in an analysis --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", EXAMPLES)
def test_soil_is_a_load(name: str) -> None:
    """It makes the cause "load" of every output, and only that."""
    machine = planted(name, TERMS["all"][0])
    wet = eq.analyze(machine, 180).forces
    dry = eq.analyze(machine.with_planting(soil=None), 180).forces
    scale = np.max(np.abs(wet.drive_torque))
    for output in ("drive_torque", "frame_force", "joints.B"):
        with_soil, without = wet.split.by_cause(output), dry.split.by_cause(output)
        assert not np.any(without["load"])
        assert np.any(with_soil["load"])
        for cause in ("translation", "rotation", "weight"):
            np.testing.assert_allclose(with_soil[cause], without[cause], rtol=1e-13)
    extra = wet.drive_torque - dry.drive_torque
    np.testing.assert_allclose(
        wet.split.by_cause("drive_torque")["load"], extra, atol=1e-13 * scale
    )
    coupler = wet.split.by_link("drive_torque")["coupler"]
    other = dry.split.by_link("drive_torque")["coupler"]
    np.testing.assert_allclose(coupler - other, extra, atol=1e-13 * scale)


def test_soil_adds_to_other_loads_on_the_link() -> None:
    machine = planted("kim-chung-a", Soil(resistance=7.0))
    loaded = replace(machine, loads=(eq.Load("coupler", "C", force=(3.0, -4.0)),))
    only = loaded.with_planting(soil=None)
    none = machine.with_planting(soil=None)
    both, soil, load, bare = (
        eq.analyze(m, 90).forces.frame_force.value for m in (loaded, machine, only, none)
    )
    np.testing.assert_allclose(both - bare, soil - bare + load - bare, atol=1e-11)


def test_forces_at_another_speed_have_the_soil_of_that_speed() -> None:
    for changes in ({}, {"forward_speed": None, "hill_spacing": 0.15}):
        machine = planted("kim-chung-a", TERMS["all"][0], **changes)
        forces = eq.analyze(machine, 90).forces
        for speed in (12.0, -30.0):
            fresh = eq.analyze(machine, 90, speed=speed).forces
            np.testing.assert_array_equal(
                soil_force(forces.at(speed).motion), soil_force(fresh.motion)
            )
            np.testing.assert_allclose(
                forces.at(speed).drive_torque, fresh.drive_torque, rtol=1e-13, atol=1e-13
            )


FRAME = {"A": ORIGIN, "D": (1.0, 0.0), "S": (0.4, 2.5)}
FOUR = replace(crank_rocker(), frame=FRAME)
SPRING = eq.Spring("coupler", "C", "S", 300.0, 0.7)
THETA = np.linspace(0.1, 6.2, 9)


def sprung(**changes: Any) -> eq.Machine:
    return FOUR.with_springs([replace(SPRING, **changes)])


# -- what is refused -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "where", "expected"),
    [
        ({"link": "couple"}, ".link", {"given": "couple", "name": "coupler"}),
        ({"point": "X"}, ".point", {"given": "X", "body": "coupler"}),
        ({"to": "B"}, ".to", {"given": "B"}),
        ({"link": "rocker", "point": "D"}, ".point", {"point": "D"}),
        ({"stiffness": 0.0}, ".stiffness", {"text": "0 N/m"}),
        ({"stiffness": -3.0}, ".stiffness", {"text": "-3 N/m"}),
        ({"stiffness": np.inf}, ".stiffness", {"leaf": "inf"}),
        ({"free_length": -0.1}, ".free_length", {"text": "-0.1 m"}),
        ({"free_length": np.nan}, ".free_length", {"leaf": "nan"}),
    ],
)  # fmt: skip
def test_bad_springs(changes: dict[str, Any], where: str, expected: dict[str, Any]) -> None:
    refused(f"springs[1]{where}", expected, lambda: sprung(**changes))


def test_at_most_200() -> None:
    assert len(FOUR.with_springs([SPRING] * 200).springs) == 200
    with refusals.refused(ModelError, "springs", items="201", most="200"):
        FOUR.with_springs([SPRING] * 201)


def test_springs_leave_the_motion_as_it_is() -> None:
    """Nothing is solved again, and the frame's point is in use."""
    linkage = eq.mechanism.assemble(FOUR)
    assert eq.mechanism.assemble(sprung()).groups is linkage.groups
    assert list(linkage_remarks(linkage)) == ["frame.points.S is not used by any joint or spring"]
    assert not list(linkage_remarks(eq.mechanism.assemble(sprung())))


# -- force -----------------------------------------------------------------------------------------


def test_force_towards_the_frame() -> None:
    machine = sprung()
    motion = eq.move(machine, THETA)
    ((_, _, force, _),) = acting_elements(motion)
    along = complex(*FRAME["S"]) - motion.points["C"].place
    np.testing.assert_allclose(np.abs(force), 300 * np.abs(np.abs(along) - 0.7), rtol=1e-13)
    np.testing.assert_allclose(np.angle(force), np.angle(along), rtol=1e-13)


def test_a_spring_shorter_than_its_free_length_pushes() -> None:
    machine = sprung(free_length=9.0)
    motion = eq.move(machine, THETA)
    along = complex(*FRAME["S"]) - motion.points["C"].place
    ((_, _, force, _),) = acting_elements(motion)
    pull = (force / along).real
    assert np.all(pull < 0)


def lone_crank(free_length: float) -> eq.Machine:
    """A crank whose end passes the hook at 90 deg."""
    return eq.Machine(
        "crank",
        eq.Drive("crank", 10.0),
        {"A": ORIGIN, "S": (0.0, 0.3)},
        {"crank": eq.Link({"A": ORIGIN, "B": (0.3, 0.0)}, 1.0, ORIGIN, 1.0)},
        springs=(eq.Spring("crank", "B", "S", 50.0, free_length),),
        gravity=ORIGIN,
    )


def test_ends_that_meet() -> None:
    expected = {"link": "crank", "to": "S", "angle": 90.0}
    refused("springs[1]", expected, lambda: eq.analyze(lone_crank(0.1), 360))
    forces = eq.analyze(lone_crank(0.0), 360).forces
    assert forces.drive_torque[90] == pytest.approx(0, abs=1e-14)
    with refusals.refused(ModelError, "springs", link="crank", to="S", angle=90.0):
        spring_units(forces.motion, "crank", "B", "S")


def test_torque_of_a_spring_on_a_crank() -> None:
    """k a c sin: a spring without a free length from a crank to a hook at c above its pivot."""
    forces = eq.analyze(lone_crank(0.0), THETA).forces
    np.testing.assert_allclose(forces.drive_torque, -50 * 0.3 * 0.3 * np.cos(THETA), atol=1e-14)
    force = 50 * (0.3j - 0.3 * np.exp(1j * THETA))
    np.testing.assert_allclose(forces.joints["A"].value, -force, atol=1e-13)
    np.testing.assert_allclose(forces.frame_force.value, 0, atol=1e-13)
    np.testing.assert_allclose(forces.frame_moment, 0, atol=1e-13)
