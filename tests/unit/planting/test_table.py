"""Columns against crank angle: those of the motion, in the order of time."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.planting.summary import PlantingFigures, plant, table
from unit.planting.build import TURN, planetary, spinner, twice

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
def found(name: str) -> PlantingFigures:
    return plant(MACHINES[name]())


@pytest.mark.parametrize("angles", [1, 7, 90])
@pytest.mark.parametrize("name", MACHINES)
def test_columns_are_those_of_the_motion(name: str, angles: int) -> None:
    figures = found(name)
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
    columns = table(found("clockwise"), 4)
    assert [(name, unit) for name, unit, _ in columns] == [
        ("crank_angle", "rad"),
        ("time", "s"),
        *((f"tip.{key}", unit) for key, unit in UNITS.items()),
        *((f"center_of_mass.{key}", unit) for key, unit in UNITS.items()),
    ]


def test_rows_follow_time_whichever_way_the_crank_turns() -> None:
    for name in ("counterclockwise", "clockwise"):
        columns = {key: values for key, _, values in table(found(name), 8)}
        assert np.all(np.diff(columns["time"]) > 0)
        assert columns["crank_angle"][0] == 0
        step = np.diff(np.degrees(columns["crank_angle"]))[1:]
        np.testing.assert_allclose(step, 45 if name == "counterclockwise" else -45)


def test_without_masses_there_is_no_centre_of_mass() -> None:
    names = [name for name, _, _ in table(plant(twice()), 3)]
    assert names == ["crank_angle", "time", *(f"tip.{key}" for key in UNITS)]


def test_the_table_has_360_crank_angles_a_turn_unless_said_otherwise() -> None:
    assert {len(values) for _, _, values in table(found("clockwise"))} == {360}
    assert {len(values) for _, _, values in table(found("three turns"))} == {1080}


@pytest.mark.parametrize("angles", [0, -3, 400_001])
def test_a_number_of_crank_angles_that_cannot_be(angles: int) -> None:
    with pytest.raises(UsageError, match=f"got {angles}; give 1 to 400000"):
        table(plant(spinner()), angles)
    with pytest.raises(UsageError, match="give 1 to 133333"):
        table(found("three turns"), 133_334)
