"""Values of planting and soil: each wrong one is refused at its key, with what would be right."""

from __future__ import annotations

import pickle
from dataclasses import replace
from math import inf, nan, pi
from typing import Any

import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.kinematics.tip import TipCurve, planting_of, surface_of, tip_link
from equipoise.mechanism.parts.field import Planting, Soil, SoilTable
from support import refusals
from unit.mechanism.build import crank_rocker, refused

FOUR = crank_rocker()
PLANTING = Planting(tip="C", forward_speed=0.6, depth=0.1)
TABLE = SoilTable((0.0, 0.02), (5.0, 9.0))
RESISTANCES = {"resistance": "N", "per_depth": "N/m", "per_speed": "N s/m",
               "per_depth_and_speed": "N s/m^2"}  # fmt: skip
TABLES: list[tuple[Any, Any, str]] = [
    ((), (), "the table has no rows"),
    ((0.0, 0.1), (1.0,), "the columns differ in length"),
    ((0.1, 0.0), (1.0, 2.0), "the depths must rise from row to row, from 0 or more"),
    ((0.1, 0.1), (1.0, 2.0), "the depths must rise from row to row, from 0 or more"),
    ((-0.1, 0.1), (1.0, 2.0), "the depths must rise from row to row, from 0 or more"),
    ((0.0, 0.1), (1.0, -2.0), "got -2 N; soil resists, give 0 or more"),
]
TRAY = ((0.0, 0.0), (0.1, 0.0))


def planted(**changes: Any) -> eq.Machine:
    return replace(FOUR, planting=replace(PLANTING, **changes))


def wrong(where: str, words: str, **changes: Any) -> None:
    """Check that a planting with these changes is refused at a place, in these words."""
    refused(where, words, lambda: planted(**changes))


# -- planting --------------------------------------------------------------------------------------


def test_an_unknown_tip_is_refused_with_a_suggestion() -> None:
    known = "'A', 'B', 'C', 'D'"
    wrong("planting.tip", f"no point of a moving link is called 'Tip'; there are {known}",
            tip="Tip")  # fmt: skip
    grip = FOUR.with_link("coupler", points={**FOUR.links["coupler"].points, "Grip": (0.2, 0.1)})
    with pytest.raises(ModelError) as caught:
        replace(grip, planting=replace(PLANTING, tip="Grib"))
    assert caught.value.what.endswith("did you mean 'Grip'?")


def test_a_point_of_the_frame_alone_is_no_tip() -> None:
    frame = {**FOUR.frame, "S": (0.5, 0.5)}
    with refusals.refused(ModelError, "planting.tip", given="S"):
        replace(FOUR, frame=frame, planting=replace(PLANTING, tip="S"))


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"forward_speed": None}, "", "give either forward_speed or hill_spacing"),
        ({"hill_spacing": 0.15}, "", "give either forward_speed or hill_spacing"),
        ({"depth": None}, "", "give either depth or surface"),
        ({"surface": -0.3}, "", "give either depth or surface"),
        ({"travel": "left"}, ".travel", "got 'left'; give 'forward' or 'backward'"),
        ({"forward_speed": -0.6}, ".forward_speed",
         'got -0.6 m/s; give its size, and travel = "backward" for a machine that drives against '
         "x"),
        ({"forward_speed": None, "hill_spacing": -0.15}, ".hill_spacing",
         "got -0.15 m; give more than 0"),
        ({"forward_speed": None, "hill_spacing": 0.0}, ".hill_spacing",
         "got 0 m; give more than 0"),
        ({"units_per_turn": 0}, ".units_per_turn", "got 0; give 1 or more"),
        ({"units_per_turn": -2}, ".units_per_turn", "got -2; give 1 or more"),
        ({"depth": 0.0}, ".depth", "got 0 m; give more than 0"),
        ({"depth": -0.04}, ".depth", "got -0.04 m; give more than 0"),
        ({"acceleration_limit": 0.0}, ".acceleration_limit", "got 0 m/s^2; give more than 0"),
        ({"soil_acceleration_limit": -5.0}, ".soil_acceleration_limit",
         "got -5 m/s^2; give more than 0"),
        ({"finger_from": "C"}, ".finger_from",
         "no other point of coupler, the tip's link, is called 'C'; there are 'B'"),
        ({"finger_from": "D"}, ".finger_from",
         "no other point of coupler, the tip's link, is called 'D'; there are 'B'"),
        *(({"soil": Soil(**{key: -2.0})}, f".soil.{key}",
           f"got -2 {unit}; soil resists, give 0 or more") for key, unit in RESISTANCES.items()),
        ({"soil": Soil()}, ".soil",
         "give at least one of resistance, per_depth, per_speed, per_depth_and_speed and table"),
        *(({"soil": Soil(table=SoilTable(*rows))}, ".soil.table", words)
          for *rows, words in TABLES),
        ({"tray": ((0.1, 0.2), (0.1, 0.2))}, ".tray",
         "its two points are the same; give both ends of the edge"),
    ],
)  # fmt: skip
def test_values_of_planting(changes: dict[str, Any], key: str, words: str) -> None:
    wrong(f"planting{key}", words, **changes)


@pytest.mark.parametrize("value", [nan, inf])
@pytest.mark.parametrize(
    ("where", "make"),
    [
        ("planting.forward_speed", lambda x: {"forward_speed": x}),
        ("planting.depth", lambda x: {"depth": x}),
        ("planting.release", lambda x: {"release": x}),
        ("planting.tray[2][1]", lambda x: {"tray": ((0.0, 0.0), (x, 0.0))}),
        ("planting.soil.per_speed", lambda x: {"soil": Soil(per_speed=x)}),
        ("planting.soil.table.depth[2]",
         lambda x: {"soil": Soil(table=SoilTable((0.0, x), (1.0, 1.0)))}),
    ],
)  # fmt: skip
def test_numbers_are_finite(where: str, make: Any, value: float) -> None:
    wrong(where, f"got {value}; give a finite number", **make(value))


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"tip": 3}, "tip", "got 3; give text"),
        ({"depth": "4 kg"}, "depth", "got '4 kg'..."),
        ({"units_per_turn": 1.5}, "units_per_turn",
         "got 1.5; give a whole number of at most 1000000"),
        ({"units_per_turn": 10**7}, "units_per_turn",
         "got 10000000; give a whole number of at most 1000000"),
        ({"tray": (0.1, 0.2)}, "tray", "got (0.1, 0.2); give two points of two numbers each"),
        ({"tray": ((0.1, 0.2),)}, "tray", "got ((0.1, 0.2),); give two points of two numbers each"),
    ],
)  # fmt: skip
def test_shapes_of_planting(changes: dict[str, Any], key: str, words: str) -> None:
    refused(key, words, lambda: replace(PLANTING, **changes))


def test_what_is_right_is_kept() -> None:
    full = planted(tray=TRAY, release=-1.0, finger_from="B", travel="backward", units_per_turn=2,
                   acceleration_limit=9.0, soil_acceleration_limit=8.0)  # fmt: skip
    assert full.planting is not None
    assert full.planting.tray == TRAY
    assert pickle.loads(pickle.dumps(full)) == full
    assert planted(forward_speed=0.0).planting is not None
    assert planted(depth=None, surface=-0.3).planting is not None
    assert planted(soil=Soil(table=TABLE)).planting is not None


def test_a_table_is_the_same_from_another_file() -> None:
    assert replace(TABLE, file="a.csv") == replace(TABLE, file="b.csv")


# -- what planting values tell ---------------------------------------------------------------------


def test_forward_is_signed_and_may_follow_the_crank() -> None:
    assert PLANTING.forward(3.0) == PLANTING.forward(-30.0) == 0.6
    assert replace(PLANTING, travel="backward").forward(3.0) == -0.6
    hills = replace(PLANTING, forward_speed=None, hill_spacing=0.15, units_per_turn=2)
    assert hills.forward(2 * pi) == pytest.approx(0.3)
    assert hills.forward(-4 * pi) == pytest.approx(0.6)
    assert replace(hills, travel="backward").forward(-2 * pi) == pytest.approx(-0.3)


def test_planting_is_changed_key_by_key() -> None:
    machine = planted()
    cycle = eq.mechanism.assemble(machine).cycle
    deeper = machine.with_planting(depth=0.2)
    assert deeper.planting == replace(PLANTING, depth=0.2)
    assert machine.planting == PLANTING
    assert FOUR.with_planting(tip="C", forward_speed=0.6, depth=0.1).planting == PLANTING
    assert eq.mechanism.assemble(deeper).cycle is cycle
    with refusals.refused(ModelError, "planting.depth"):
        machine.with_planting(depth=-1.0)


def test_the_tip_belongs_to_the_first_link_that_has_it() -> None:
    assert tip_link(planted()) == "coupler"
    assert tip_link(planted(tip="D")) == "rocker"


def test_a_machine_without_planting_says_what_to_add() -> None:
    for read in (planting_of, tip_link, surface_of, lambda machine: TipCurve([machine])):
        with pytest.raises(ModelError) as caught:
            read(FOUR)  # type: ignore[operator]
        assert str(caught.value) == (
            'planting: missing; add a table [planting] with at least tip = "P", '
            'forward_speed = "0.6 m/s" and depth = "40 mm"'
        )


def test_the_surface_lies_where_it_is_said_or_above_the_lowest_point() -> None:
    assert surface_of(planted(depth=None, surface=0.3)) == 0.3
    heights = eq.move(FOUR, 100_000).points["C"].y
    machine = planted()
    assert surface_of(machine) == pytest.approx(heights.min() + 0.1, abs=1e-9)
    assert surface_of(machine) == surface_of(machine)
    assert surface_of(machine.with_planting(depth=0.2)) == pytest.approx(surface_of(machine) + 0.1)
