"""What the tip does in the soil, by many samples of the stay; speeds that keep within limits."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.planting.summary import PlantingFigures, plant
from unit.planting.build import (
    EXAMPLES,
    Array,
    apart,
    over_ground,
    planetary,
    spinner,
    tip_at,
    twice,
)

SAMPLES = 20_001
"""Sums over chords and largest samples are right to the square of a step: some 1e-8."""
MACHINES: dict[str, Any] = {
    **{name: lambda name=name: eq.load(name) for name in EXAMPLES},
    "backward": lambda: eq.load("kim-chung-b").with_planting(travel="backward", finger_from="C"),
    "speeding up": lambda: eq.load("kim-chung-a").with_drive(acceleration=150.0),
    "twice": twice,
    "three turns": lambda: planetary(-20.0, depth=0.05),
    "spinner": lambda: spinner(depth=0.06),
}
every_machine = pytest.mark.parametrize("name", MACHINES)


@cache
def found(name: str) -> PlantingFigures:
    return plant(MACHINES[name]())


def stay(figures: PlantingFigures) -> Array:
    """Crank angles from entry to exit, running on in the sense of the drive."""
    entry, sense = figures["entry.crank_angle"], np.sign(figures["speed"])
    travel = sense * (figures["exit.crank_angle"] - entry) % figures.curve.period
    return entry + sense * np.linspace(0.0, travel, SAMPLES)


@every_machine
def test_travel_time_and_depth(name: str) -> None:
    figures, theta = found(name), stay(found(name))
    travel = abs(theta[-1] - theta[0])
    assert figures["soil.crank_travel"] == pytest.approx(travel, abs=1e-12)
    assert figures["soil.time"] == pytest.approx(travel / abs(figures["speed"]), rel=1e-12)
    lowest = tip_at(figures.machine, theta).y.min()
    assert figures["soil.depth"] == pytest.approx(figures["surface"] - lowest, abs=1e-8)


@every_machine
def test_lengths_by_chords(name: str) -> None:
    figures, theta = found(name), stay(found(name))
    machine = np.sum(np.abs(np.diff(tip_at(figures.machine, theta).place)))
    ground = over_ground(figures, theta)
    assert figures["soil.path_length_machine"] == pytest.approx(machine, rel=1e-7)
    assert figures["soil.path_length_ground"] == pytest.approx(
        np.sum(np.abs(np.diff(ground))), rel=1e-7
    )
    advance = (ground[-1] - ground[0]).real
    assert figures["soil.ground_advance"] == pytest.approx(advance, abs=1e-13)
    assert figures["soil.ground_distance"] == abs(figures["soil.ground_advance"])


@every_machine
def test_largest_acceleration_by_sampling(name: str) -> None:
    figures, theta = found(name), stay(found(name))
    sizes = np.abs(tip_at(figures.machine, theta).acceleration_vector)
    assert sizes.max() * (1 - 1e-12) <= figures["soil.max_acceleration.value"]
    assert figures["soil.max_acceleration.value"] == pytest.approx(sizes.max(), rel=1e-7)
    if name != "spinner":  # whose acceleration is the same everywhere
        at = figures["soil.max_acceleration.crank_angle"]
        assert apart(at, theta[np.argmax(sizes)]) < 1e-3
        assert abs(tip_at(figures.machine, at).acceleration_vector[0]) == pytest.approx(sizes.max())


def test_the_largest_acceleration_may_lie_where_the_tip_leaves() -> None:
    figures = found("twice")
    leaving = figures["exit.acceleration.size"]
    assert figures["soil.max_acceleration.value"] == pytest.approx(leaving, rel=1e-12)
    assert leaving < figures["max_acceleration.value"] / 1.5


# -- the hole --------------------------------------------------------------------------------------


def cuts(figures: PlantingFigures, base: str) -> Array:
    """Places over ground at which the finger cuts the surface, while its foot is above."""
    theta = stay(figures)
    foot = eq.move(figures.machine, theta).points[base].place
    tip, level = tip_at(figures.machine, theta).place, figures["surface"]
    share = (level - tip.imag) / (foot.imag - tip.imag)
    x = over_ground(figures, theta).real + share * (foot - tip).real
    return np.asarray(x[foot.imag >= level])


@pytest.mark.parametrize("finger_from", ["B", "C"])
@pytest.mark.parametrize("name", EXAMPLES)
def test_hole_by_sampling(name: str, finger_from: str) -> None:
    machine = eq.load(name).with_planting(finger_from=finger_from)
    figures = plant(machine)
    places = cuts(figures, finger_from)
    assert len(places) == SAMPLES
    assert figures["soil.hole_length"] == pytest.approx(np.ptp(places), rel=1e-7)
    assert figures["soil.hole_length"] >= np.ptp(places) * (1 - 1e-12)


def test_hole_of_a_finger_that_goes_all_below() -> None:
    """Its foot is 20 mm from the tip and 40 mm deep: the cut ends at a jump."""
    machine = eq.load("kim-chung-a")
    points = machine.links["coupler"].points
    up = np.array(points["B"]) - points["P"]
    near = np.array(points["P"]) + 0.02 * up / np.hypot(*up)
    machine = machine.with_link("coupler", points={**points, "K": tuple(map(float, near))})
    figures = plant(machine.with_planting(finger_from="K"))
    places = cuts(figures, "K")
    assert 1000 < len(places) < SAMPLES - 1000
    assert figures["soil.hole_length"] == pytest.approx(np.ptp(places), abs=3e-5)


def test_a_machine_at_rest_has_no_ground_figures_of_the_stay() -> None:
    moving, resting = found("kim-chung-a"), plant(MACHINES["kim-chung-a"]().with_planting(
        forward_speed=0.0))  # fmt: skip
    missing = set(moving.figures) - set(resting.figures)
    assert {f"soil.{key}" for key in ("path_length_ground", "ground_advance", "ground_distance",
                                      "hole_length")} <= missing  # fmt: skip
    for key in ("crank_travel", "time", "depth", "path_length_machine", "max_acceleration.value"):
        assert resting[f"soil.{key}"] == pytest.approx(moving[f"soil.{key}"], rel=1e-13)


# -- limits ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("name", ["kim-chung-a", "twice", "three turns"])
def test_at_the_highest_speed_the_limit_is_just_met(name: str, sense: int) -> None:
    """One way round all of the path is held to its limit, the other way the stay in the soil."""
    limits = {"acceleration_limit": 80.0, "soil_acceleration_limit": 30.0}
    machine = MACHINES[name]().with_planting(**limits)
    limit, largest = {
        1: ("acceleration", "max_acceleration.value"),
        -1: ("soil_acceleration", "soil.max_acceleration.value"),
    }[sense]
    figures, wanted = plant(machine), limits[f"{limit}_limit"]
    assert figures[f"limits.{limit}.limit"] == wanted
    highest = figures[f"limits.{limit}.highest_speed"]
    assert plant(machine, speed=sense * highest)[largest] == pytest.approx(wanted, rel=1e-9)


def test_limits_leave_the_acceleration_of_the_drive_aside() -> None:
    machine = eq.load("kim-chung-a").with_planting(acceleration_limit=80.0)
    steady, rising = (plant(machine.with_drive(acceleration=a)) for a in (0.0, 150.0))
    name = "limits.acceleration.highest_speed"
    assert rising[name] == steady[name]
    assert rising["max_acceleration.value"] != steady["max_acceleration.value"]


def test_without_limits_there_are_none() -> None:
    assert not any(name.startswith("limits") for name in found("kim-chung-a").figures)
    only = plant(eq.load("kim-chung-a").with_planting(soil_acceleration_limit=30.0))
    assert {name for name in only.figures if name.startswith("limits")} == {
        "limits.soil_acceleration.limit",
        "limits.soil_acceleration.highest_speed",
        "limits.soil_acceleration.highest_forward_speed",
    }


def test_a_limit_of_one_g_on_the_crank() -> None:
    """r omega^2 = g."""
    figures = plant(spinner(acceleration_limit=9.80665))
    highest = figures["limits.acceleration.highest_speed"]
    assert highest == pytest.approx(np.sqrt(98.0665), rel=1e-12)
