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
TABLES: list[tuple[Any, Any, dict[str, Any]]] = [
    ((), (), {}),
    ((0.0, 0.1), (1.0,), {}),
    ((0.1, 0.0), (1.0, 2.0), {}),
    ((0.1, 0.1), (1.0, 2.0), {}),
    ((-0.1, 0.1), (1.0, 2.0), {}),
    ((0.0, 0.1), (1.0, -2.0), {"least": -2.0}),
]
TRAY = ((0.0, 0.0), (0.1, 0.0))


def planted(**changes: Any) -> eq.Machine:
    return replace(FOUR, planting=replace(PLANTING, **changes))


def wrong(where: str, expected: dict[str, Any], **changes: Any) -> None:
    """Check that a planting with these changes is refused at a place, with these values."""
    refused(where, expected, lambda: planted(**changes))


# -- planting --------------------------------------------------------------------------------------


def test_an_unknown_tip_is_refused_with_a_suggestion() -> None:
    wrong("planting.tip", {"given": "Tip"}, tip="Tip")
    grip = FOUR.with_link("coupler", points={**FOUR.links["coupler"].points, "Grip": (0.2, 0.1)})
    with refusals.refused(ModelError, "planting.tip", given="Grib", name="Grip"):
        replace(grip, planting=replace(PLANTING, tip="Grib"))


def test_a_point_of_the_frame_alone_is_no_tip() -> None:
    frame = {**FOUR.frame, "S": (0.5, 0.5)}
    with refusals.refused(ModelError, "planting.tip", given="S"):
        replace(FOUR, frame=frame, planting=replace(PLANTING, tip="S"))


@pytest.mark.parametrize(
    ("changes", "key", "expected"),
    [
        ({"forward_speed": None}, "", {}),
        ({"hill_spacing": 0.15}, "", {}),
        ({"depth": None}, "", {}),
        ({"surface": -0.3}, "", {}),
        ({"travel": "left"}, ".travel", {"leaf": "left"}),
        ({"forward_speed": -0.6}, ".forward_speed", {"text": "-0.6 m/s"}),
        ({"forward_speed": None, "hill_spacing": -0.15}, ".hill_spacing", {"text": "-0.15 m"}),
        ({"forward_speed": None, "hill_spacing": 0.0}, ".hill_spacing", {"text": "0 m"}),
        ({"units_per_turn": 0}, ".units_per_turn", {"text": 0}),
        ({"units_per_turn": -2}, ".units_per_turn", {"text": -2}),
        ({"depth": 0.0}, ".depth", {"text": "0 m"}),
        ({"depth": -0.04}, ".depth", {"text": "-0.04 m"}),
        ({"acceleration_limit": 0.0}, ".acceleration_limit", {"text": "0 m/s^2"}),
        ({"soil_acceleration_limit": -5.0}, ".soil_acceleration_limit", {"text": "-5 m/s^2"}),
        ({"finger_from": "C"}, ".finger_from", {"given": "C", "link": "coupler"}),
        ({"finger_from": "D"}, ".finger_from", {"given": "D", "link": "coupler"}),
        *(({"soil": Soil(**{key: -2.0})}, f".soil.{key}",
           {"text": f"-2 {unit}"}) for key, unit in RESISTANCES.items()),
        ({"soil": Soil()}, ".soil",
         {"names": "resistance, per_depth, per_speed, per_depth_and_speed"}),
        *(({"soil": Soil(table=SoilTable(*rows))}, ".soil.table", expected)
          for *rows, expected in TABLES),
        ({"tray": ((0.1, 0.2), (0.1, 0.2))}, ".tray", {}),
    ],
)  # fmt: skip
def test_values_of_planting(changes: dict[str, Any], key: str, expected: dict[str, Any]) -> None:
    wrong(f"planting{key}", expected, **changes)


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
    wrong(where, {"leaf": str(value)}, **make(value))


@pytest.mark.parametrize(
    ("changes", "key", "expected"),
    [
        ({"tip": 3}, "tip", {"given": 3}),
        ({"depth": "4 kg"}, "depth", {"given": "'4 kg'"}),
        ({"units_per_turn": 1.5}, "units_per_turn", {"given": 1.5}),
        ({"units_per_turn": 10**7}, "units_per_turn", {"given": 10000000}),
        ({"tray": (0.1, 0.2)}, "tray", {"given": "(0.1, 0.2)"}),
        ({"tray": ((0.1, 0.2),)}, "tray", {"given": "((0.1, 0.2),)"}),
    ],
)  # fmt: skip
def test_shapes_of_planting(changes: dict[str, Any], key: str, expected: dict[str, Any]) -> None:
    refused(key, expected, lambda: replace(PLANTING, **changes))


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
        with refusals.refused(ModelError, "planting"):
            read(FOUR)  # type: ignore[operator]


def test_the_surface_lies_where_it_is_said_or_above_the_lowest_point() -> None:
    assert surface_of(planted(depth=None, surface=0.3)) == 0.3
    heights = eq.move(FOUR, 100_000).points["C"].y
    machine = planted()
    assert surface_of(machine) == pytest.approx(heights.min() + 0.1, abs=1e-9)
    assert surface_of(machine) == surface_of(machine)
    assert surface_of(machine.with_planting(depth=0.2)) == pytest.approx(surface_of(machine) + 0.1)
