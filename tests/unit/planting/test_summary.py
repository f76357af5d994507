"""All that is read off a planting machine: figures, forces in the soil, and a table."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from math import isfinite
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError, MotionError, UsageError
from equipoise.mechanism.parts.field import Planting, Soil
from equipoise.planting.summary import PlantingFigures, plant, soil_forces, table
from support.refusals import refused
from unit.mechanism.build import four_bar
from unit.planting.build import EXAMPLES, TURN, planetary, spinner, twice

VECTOR = ("x", "y", "size", "direction")
PROMISED = {
    *("curve.height", "curve.width", "lowest.crank_angle"),
    *(f"{end}.crank_angle" for end in ("entry", "exit")),
    *(
        f"{end}.{vector}.{part}"
        for end in ("entry", "exit", "lowest")
        for vector in ("velocity", "acceleration")
        for part in VECTOR
    ),
    *(f"soil.{key}" for key in ("crank_travel", "path_length_ground", "ground_distance")),
    *(
        f"{which}_{what}.{key}"
        for which in ("max", "min")
        for what in ("speed", "acceleration")
        for key in ("value", "crank_angle", "direction")
    ),
    *("ratio.coupler.min", "ratio.rocker.min"),
}
"""Fields that other programs may rely on."""


@cache
def figures_of(name: str) -> PlantingFigures:
    return plant(eq.load(name))


def at(content: dict[str, Any], name: str) -> Any:
    for part in name.split("."):
        content = content[part]
    return content


# -- as plain data ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", EXAMPLES)
def test_promised_fields(name: str) -> None:
    content = figures_of(name).to_dict()
    for field in PROMISED:
        assert isinstance(at(content, field), float), field


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_figure_stands_in_the_output(name: str) -> None:
    """And all of it is JSON: numbers, text, lists."""
    figures = figures_of(name)
    content = figures.to_dict()
    assert json.loads(json.dumps(content, allow_nan=False)) == content
    for field, value in figures.figures.items():
        assert at(content, field) == value == figures[field]
        assert isfinite(value)
    assert (content["title"], content["tip"]) == (figures.machine.title, "P")
    assert content["finger_from"] == "B"
    assert [visit["entry"] for visit in content["visits"]] == [figures["entry.crank_angle"]]
    assert content["loops"][0]["way"] == figures.loops[0].way
    assert content["clearance"]["soil"]["rocker"]["value"] == figures["clearance.soil.rocker.value"]
    assert "tray" not in content["clearance"]
    assert content["notes"] == list(map(str, figures.notes))


def test_a_name_that_is_none_is_met_with_one_that_is() -> None:
    with pytest.raises(KeyError, match=r"no figure is called 'curve.hight'; did you mean"):
        figures_of("kim-chung-a")["curve.hight"]


def test_links_may_be_called_anything() -> None:
    """Also what looks like the name of a figure."""
    machine = eq.load("kim-chung-a")
    names = {"crank": "crank", "coupler": "rocker.min", "rocker": "rocker"}
    links = {names[name]: link for name, link in machine.links.items()}
    content = plant(replace(machine, links=links)).to_dict()
    wanted = figures_of("kim-chung-a")
    assert content["ratio"]["rocker.min"]["min"] == wanted["ratio.coupler.min"]
    assert content["ratio"]["rocker"]["min"] == wanted["ratio.rocker.min"]
    assert content["clearance"]["soil"]["rocker.min"]["value"] > 0


def test_lists_of_crank_angles_in_the_output() -> None:
    content = plant(spinner(forward_speed=1.0, tray=((0.0, 0.0), (0.0, 0.2)))).to_dict()
    assert content["cusps"] == [pytest.approx(np.pi / 2)]
    assert content["tray_crossings"] == [pytest.approx(np.pi / 2)]
    assert set(content["clearance"]["tray"]) >= {"crank"}


# -- the drive -------------------------------------------------------------------------------------


def test_figures_of_the_drive() -> None:
    figures = figures_of("kim-chung-b")
    assert figures["speed"] == pytest.approx(-8 * np.pi)
    assert figures["forward_speed"] == 0.6
    assert figures["hill_spacing"] == pytest.approx(0.15)
    assert figures["surface"] == pytest.approx(figures["lowest.y"] + 0.04)
    both = plant(eq.load("kim-chung-b").with_planting(travel="backward", units_per_turn=2))
    assert both["forward_speed"] == -0.6
    assert both["hill_spacing"] == pytest.approx(0.075)
    hills = eq.load("kim-chung-b").with_planting(
        forward_speed=None, hill_spacing=0.16, units_per_turn=2
    )
    assert plant(hills)["hill_spacing"] == pytest.approx(0.16)
    assert plant(hills, speed=-TURN)["forward_speed"] == pytest.approx(0.32)


def test_another_speed_is_that_of_another_machine() -> None:
    machine = eq.load("kim-chung-a")
    figures = plant(machine, speed=-12.0)
    assert machine.drive.speed == pytest.approx(8 * np.pi)
    assert figures.figures == plant(machine.with_drive(speed=-12.0)).figures
    assert figures.machine.drive.speed == -12.0


# -- notes -----------------------------------------------------------------------------------------

ASSUMED = "the finger is taken from B to P; finger_from can name another"


def test_a_finger_that_is_assumed_is_reported() -> None:
    assert tuple(map(str, figures_of("kim-chung-a").notes)) == (ASSUMED,)
    assert plant(eq.load("kim-chung-a").with_planting(finger_from="B")).notes == ()


def test_several_stays_are_reported() -> None:
    figures = plant(twice(finger_from="B"))
    assert tuple(map(str, figures.notes)) == (
        "the tip is in the soil 2 times a cycle; entry, exit and lowest point are those of the "
        "deepest stay",
    )
    deepest, other = figures.visits
    assert deepest.depth > other.depth
    assert figures["entry.crank_angle"] == deepest.entry
    assert figures["exit.crank_angle"] == deepest.exit
    assert figures["lowest.crank_angle"] == pytest.approx(deepest.deepest)


def test_a_machine_at_rest_is_reported_and_has_no_figures_over_ground() -> None:
    figures = plant(eq.load("kim-chung-a").with_planting(forward_speed=0.0))
    assert tuple(map(str, figures.notes)) == (
        "forward_speed is 0: there is no path over ground, and the figures of that path are "
        "left out",
        ASSUMED,
    )
    assert figures.loops == ()
    assert figures.cusps == ()
    left = set(figures_of("kim-chung-a").figures) - set(figures.figures)
    assert {"soil.path_length_ground", "soil.ground_distance", "soil.hole_length"} < left
    json.dumps(figures.to_dict(), allow_nan=False)


def test_a_machine_at_rest_has_no_radius_over_ground() -> None:
    figures = plant(eq.load("kim-chung-a").with_planting(forward_speed=0.0))
    assert not [name for name in figures.figures if name.startswith("ground.")]


# -- several turns ---------------------------------------------------------------------------------


@pytest.mark.parametrize("speed", [20.0, -20.0])
def test_a_cycle_of_three_turns(speed: float) -> None:
    """Crank angles are told within three turns; hills are still those of one."""
    figures = plant(planetary(speed, depth=0.1, soil=Soil(resistance=3.0)))
    assert figures.curve.turns == 3
    angles = [value for name, value in figures.figures.items()
              if name.endswith(("crank_angle", "min_at", "max_at"))]  # fmt: skip
    angles += [angle for visit in figures.visits for angle in (visit.entry, visit.exit,
                                                               visit.deepest)]  # fmt: skip
    assert min(angles) >= 0
    assert TURN < max(angles) < 3 * TURN
    assert len(figures.visits) == 3
    assert figures["hill_spacing"] == pytest.approx(0.5 * TURN / 20)
    assert figures["lowest.crank_angle"] == pytest.approx(figures.visits[0].deepest)
    assert figures.forces is not None
    sampling = figures.forces.motion.sampling
    assert sampling.turns == 3
    assert len(sampling.curve_places) == 3 * (720 + 2 * 2)  # into the soil and out, both sides
    json.dumps(figures.to_dict(), allow_nan=False)


# -- what cannot be read off -----------------------------------------------------------------------


def test_a_machine_without_planting() -> None:
    with refused(ModelError, "planting"):
        plant(eq.load("yamashita-1"))


def test_a_crank_that_stands_still() -> None:
    machine = eq.load("kim-chung-a")
    for still in (lambda: plant(machine, speed=0.0), lambda: plant(machine.with_drive(speed=0.0))):
        with refused(ModelError, "drive.speed"):
            still()


def test_a_crank_that_cannot_turn() -> None:
    values = Planting(tip="C", forward_speed=0.6, surface=0.5)
    with refused(MotionError, first="B", second="D", joint="C"):
        plant(four_bar(1.0, 0.9, 0.5, 0.9, planting=values))


SOIL = Soil(resistance=5.0, per_depth=400.0)


@pytest.mark.parametrize("name", [*EXAMPLES, "three turns"])
def test_both_are_what_an_analysis_finds(name: str) -> None:
    machine = planetary(depth=0.05) if name == "three turns" else eq.load(name)
    forces = soil_forces(machine.with_planting(soil=SOIL))
    assert forces is not None
    wet = eq.analyze(machine.with_planting(soil=SOIL), 720).resolved.forces
    dry = eq.analyze(machine, forces.motion.crank_angle).forces
    for got, want in ((forces.in_soil, wet), (forces.in_air, dry)):
        np.testing.assert_allclose(got.drive_torque, want.drive_torque, rtol=1e-12, atol=1e-12)
        for joint in want.joints:
            np.testing.assert_allclose(got.joints[joint].value, want.joints[joint].value,
                                       rtol=1e-12, atol=1e-10)  # fmt: skip
    assert np.max(np.abs(wet.drive_torque - dry.drive_torque)) > 0.1
    np.testing.assert_array_equal(forces.motion.crank_angle, wet.motion.crank_angle)


def test_figures_of_torque_and_joints() -> None:
    machine = eq.load("kim-chung-b").with_planting(soil=SOIL)
    result = soil_forces(machine)
    assert result is not None
    compared = result.compared()
    assert list(compared) == ["drive_torque", "joints.A", "joints.B", "joints.D", "joints.C"]
    for name, (air, soil) in compared.items():
        for figures, forces in ((air, result.in_air), (soil, result.in_soil)):
            values = forces.drive_torque if name == "drive_torque" else (
                forces.joints[name.removeprefix("joints.")].size
            )  # fmt: skip
            mean = np.sum(values * result.motion.shares)
            theta, values = result.motion.shown(values)
            k = int(np.argmax(np.abs(values)))
            assert abs(values[k]) <= figures.peak <= abs(values[k]) * (1 + 1e-4)  # between samples
            assert figures.peak_at == pytest.approx(theta[k], abs=2 * np.pi / len(theta))
            assert figures.mean == pytest.approx(mean, rel=1e-12, abs=1e-12)


def test_loads_of_the_machine_act_in_air_and_in_soil() -> None:
    machine = eq.load("kim-chung-a").with_planting(soil=SOIL)
    loaded = replace(machine, loads=(eq.Load("crank", torque=-1.0),))
    forces = soil_forces(loaded)
    bare = soil_forces(machine)
    assert forces is not None
    assert bare is not None
    np.testing.assert_allclose(forces.in_air.drive_torque, bare.in_air.drive_torque + 1)
    np.testing.assert_allclose(forces.in_soil.drive_torque, bare.in_soil.drive_torque + 1)


def test_no_soil_or_masses_no_forces() -> None:
    assert soil_forces(eq.load("kim-chung-a")) is None
    assert soil_forces(eq.load("yamashita-1")) is None
    assert soil_forces(twice(soil=SOIL)) is None
    assert plant(twice(soil=SOIL)).forces is None
    assert "forces" not in plant(twice(soil=SOIL)).to_dict()


def test_they_stand_in_the_output() -> None:
    figures = plant(eq.load("kim-chung-a").with_planting(soil=SOIL))
    given = figures.to_dict()["forces"]
    assert figures.forces is figures.forces
    assert figures.forces is not None
    air, soil = figures.forces.compared()["joints.C"]
    assert given["joints.C"]["in_air"]["peak"] == air.peak
    assert given["joints.C"]["in_soil"]["max_at"] == soil.max_at
    assert set(given["drive_torque"]["in_soil"]) == {
        "mean", "rms", "peak", "peak_at", "max", "max_at", "min", "min_at", "peak_to_peak"
    }  # fmt: skip


MACHINES: dict[str, Any] = {
    "counterclockwise": lambda: eq.load("kim-chung-a"),
    "clockwise": lambda: eq.load("kim-chung-c"),
    "backward": lambda: eq.load("kim-chung-b").with_planting(travel="backward"),
    "speeding up": lambda: eq.load("kim-chung-a").with_drive(acceleration=70.0),
    "three turns": lambda: planetary(-20.0),
}
UNITS = {"x": "m", "y": "m", "ground_x": "m", "vx": "m/s", "vy": "m/s", "speed": "m/s",
         "ground_vx": "m/s", "ground_speed": "m/s", "ax": "m/s^2", "ay": "m/s^2",
         "acceleration": "m/s^2"}  # fmt: skip


@cache
def table_of(name: str) -> PlantingFigures:
    return plant(MACHINES[name]())


@pytest.mark.exhaustive(but=["three turns-1", "clockwise-7", "backward-90", "counterclockwise-1"])
@pytest.mark.parametrize("angles", [1, 7, 90])
@pytest.mark.parametrize("name", MACHINES)
def test_columns_are_those_of_the_motion(name: str, angles: int) -> None:
    figures = table_of(name)
    columns = {key: values for key, _, values in table(figures, angles)}
    turns = figures.curve.turns
    theta = np.sign(figures["speed"]) * np.arange(angles * turns) * TURN / angles
    time = theta / figures["speed"]
    motion = eq.move(figures.machine, theta)
    np.testing.assert_allclose(columns["time"], time, rtol=1e-14)
    np.testing.assert_allclose(
        np.exp(1j * columns["crank_angle"] / turns), np.exp(1j * theta / turns), atol=1e-13
    )
    assert np.all((columns["crank_angle"] >= 0) & (columns["crank_angle"] < TURN * turns))
    points = {"tip": motion.points["P"], "center_of_mass": motion.mass_centers[figures.curve.link]}
    for point, moving in points.items():
        ahead = moving.velocity + figures["forward_speed"]
        wanted = {
            "x": moving.x,
            "y": moving.y,
            "ground_x": moving.x + figures["forward_speed"] * time,
            "vx": moving.vx,
            "vy": moving.vy,
            "speed": np.hypot(moving.vx, moving.vy),
            "ground_vx": ahead.real,
            "ground_speed": np.abs(ahead),
            "ax": moving.ax,
            "ay": moving.ay,
            "acceleration": np.hypot(moving.ax, moving.ay),
        }
        assert wanted.keys() == UNITS.keys()
        for key, values in wanted.items():
            np.testing.assert_allclose(columns[f"{point}.{key}"], values, rtol=1e-12, atol=1e-13)


def test_names_and_units_in_order() -> None:
    columns = table(table_of("clockwise"), 4)
    assert [(name, unit) for name, unit, _ in columns] == [
        ("crank_angle", "rad"),
        ("time", "s"),
        *((f"tip.{key}", unit) for key, unit in UNITS.items()),
        *((f"center_of_mass.{key}", unit) for key, unit in UNITS.items()),
    ]


def test_rows_follow_time_whichever_way_the_crank_turns() -> None:
    for name in ("counterclockwise", "clockwise"):
        columns = {key: values for key, _, values in table(table_of(name), 8)}
        assert np.all(np.diff(columns["time"]) > 0)
        assert columns["crank_angle"][0] == 0
        step = np.diff(np.degrees(columns["crank_angle"]))[1:]
        np.testing.assert_allclose(step, 45 if name == "counterclockwise" else -45)


def test_without_masses_there_is_no_centre_of_mass() -> None:
    names = [name for name, _, _ in table(plant(twice()), 3)]
    assert names == ["crank_angle", "time", *(f"tip.{key}" for key in UNITS)]


def test_the_table_has_360_crank_angles_a_turn_unless_said_otherwise() -> None:
    assert {len(values) for _, _, values in table(table_of("clockwise"))} == {360}
    assert {len(values) for _, _, values in table(table_of("three turns"))} == {1080}


@pytest.mark.parametrize("angles", [0, -3, 400_001])
def test_a_number_of_crank_angles_that_cannot_be(angles: int) -> None:
    with refused(UsageError, angles=angles, most_angles=400_000):
        table(plant(spinner()), angles)
    with refused(UsageError, most_angles="133333"):
        table(table_of("three turns"), 133_334)
