"""All figures as one result: names, notes, plain data, and what cannot be read off."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from math import isfinite
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError, MotionError
from equipoise.mechanism.field import Planting, Soil
from equipoise.planting.summary import PlantingFigures, plant
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
def found(name: str) -> PlantingFigures:
    return plant(eq.load(name))


def at(content: dict[str, Any], name: str) -> Any:
    for part in name.split("."):
        content = content[part]
    return content


# -- as plain data ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", EXAMPLES)
def test_promised_fields(name: str) -> None:
    content = found(name).to_dict()
    for field in PROMISED:
        assert isinstance(at(content, field), float), field


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_figure_stands_in_the_output(name: str) -> None:
    """And all of it is JSON: numbers, text, lists."""
    figures = found(name)
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
        found("kim-chung-a")["curve.hight"]


def test_links_may_be_called_anything() -> None:
    """Also what looks like the name of a figure."""
    machine = eq.load("kim-chung-a")
    names = {"crank": "crank", "coupler": "rocker.min", "rocker": "rocker"}
    links = {names[name]: link for name, link in machine.links.items()}
    content = plant(replace(machine, links=links)).to_dict()
    wanted = found("kim-chung-a")
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
    figures = found("kim-chung-b")
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


def test_a_finger_that_is_assumed_is_told() -> None:
    assert tuple(map(str, found("kim-chung-a").notes)) == (ASSUMED,)
    assert plant(eq.load("kim-chung-a").with_planting(finger_from="B")).notes == ()


def test_several_stays_are_told() -> None:
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


def test_a_machine_at_rest_is_told_and_has_no_figures_over_ground() -> None:
    figures = plant(eq.load("kim-chung-a").with_planting(forward_speed=0.0))
    assert tuple(map(str, figures.notes)) == (
        "forward_speed is 0: there is no path over ground, and the figures of that path are "
        "left out",
        ASSUMED,
    )
    assert figures.loops == ()
    assert figures.cusps == ()
    left = set(found("kim-chung-a").figures) - set(figures.figures)
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
    assert len(figures.forces.motion.crank_angle) == 3 * 720
    json.dumps(figures.to_dict(), allow_nan=False)


# -- what cannot be read off -----------------------------------------------------------------------


def test_a_machine_without_planting() -> None:
    with pytest.raises(ModelError, match=r"^planting: missing; add a table \[planting\]"):
        plant(eq.load("yamashita-1"))


def test_a_crank_that_stands_still() -> None:
    machine = eq.load("kim-chung-a")
    for still in (lambda: plant(machine, speed=0.0), lambda: plant(machine.with_drive(speed=0.0))):
        with pytest.raises(ModelError, match=r"^drive.speed: got 0; give the speed at which"):
            still()


def test_a_crank_that_cannot_turn() -> None:
    values = Planting(tip="C", forward_speed=0.6, surface=0.5)
    with pytest.raises(MotionError, match="the crank cannot turn fully"):
        plant(four_bar(1.0, 0.9, 0.5, 0.9, planting=values))
