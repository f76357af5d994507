"""The table [planting] of the model file: read, and written again."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from math import radians

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from equipoise.mechanism.field import Planting, Soil, SoilTable
from equipoise.schema import dumps, json_schema, loads
from unit.schema.samples import FOUR_BAR, PLANTING

VALIDATOR = Draft202012Validator(json_schema())
FULL = """
[planting]
tip = "C"
hill_spacing = "15 cm"
units_per_turn = 2
travel = "backward"
surface = "-120 mm"
finger_from = "B"
release = "-10 deg"
tray = [["-100 mm", "2 cm"], { distance = "50 mm", direction = "90 deg" }]
acceleration_limit = "20 gn"
soil_acceleration_limit = "100 m/s^2"

[planting.soil]
resistance = "2 kgf"
per_depth = "0.3 N/mm"
per_speed = "4 N s/m"
per_depth_and_speed = "1 kN s/m^2"
"""
VALUES = Planting(
    tip="C",
    hill_spacing=0.15,
    units_per_turn=2,
    travel="backward",
    surface=-0.12,
    finger_from="B",
    release=radians(-10),
    tray=((-0.1, 0.02), (0.0, 0.05)),
    acceleration_limit=196.133,
    soil_acceleration_limit=100.0,
    soil=Soil(19.6133, 300.0, 4.0, 1000.0),
)


def planting_of(text: str) -> Planting:
    planting = loads(text).planting
    assert planting is not None
    return planting


# -- reading ---------------------------------------------------------------------------------------


def test_few_values_and_the_defaults_of_the_others() -> None:
    assert planting_of(FOUR_BAR + PLANTING) == Planting(tip="C", forward_speed=0.6, depth=0.04)
    assert loads(FOUR_BAR).planting is None


def test_all_values_arrive_in_si_units() -> None:
    assert planting_of(FOUR_BAR + FULL) == VALUES


@pytest.mark.parametrize("text", [PLANTING, FULL], ids=["short", "full"])
def test_schema_accepts_what_is_read(text: str) -> None:
    VALIDATOR.validate(tomllib.loads(FOUR_BAR + text))
    VALIDATOR.validate(tomllib.loads(dumps(loads(FOUR_BAR + text))))


# -- writing ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", [PLANTING, FULL], ids=["short", "full"])
def test_what_is_written_is_read_again(text: str) -> None:
    machine = loads(FOUR_BAR + text)
    assert loads(dumps(machine)) == machine
    assert dumps(loads(dumps(machine))) == dumps(machine)


def test_planting_is_written_as_people_write_it() -> None:
    written = dumps(loads(FOUR_BAR + PLANTING))
    assert written.startswith(FOUR_BAR)
    assert written.endswith('\n[planting]\ntip = "C"\nforward_speed = "0.6 m/s"\ndepth = "40 mm"\n')
    soil = planting_lines(dumps(loads(FOUR_BAR + FULL)))
    assert 'soil.per_depth = "300 N/m"' in soil
    assert 'tray = [["-100 mm", "20 mm"], ["0 mm", "50 mm"]]' in soil
    assert 'travel = "backward"' in soil


def planting_lines(text: str) -> list[str]:
    return text.partition("[planting]\n")[2].splitlines()


length = st.floats(1e-12, 1e12)
place = st.tuples(length, length.map(lambda x: -x))
NUMBERS = st.floats(1e-20, 1e20)


@given(st.data())
def test_random_values_survive(data: st.DataObject) -> None:
    draw = data.draw
    tray = draw(st.none() | st.tuples(place, place).filter(lambda ends: ends[0] != ends[1]))
    optional = st.none() | NUMBERS
    table = draw(st.none() | st.just(SoilTable((0.0, 1.0), (1.0, 2.0), "s.csv")))
    terms = [draw(st.just(0.0) | NUMBERS) for _ in range(4)]
    soil = Soil(*terms, table) if any(terms) or table else None
    speed, depth = draw(st.tuples(st.booleans(), st.booleans()))
    planting = Planting(
        tip="C",
        forward_speed=draw(st.just(0.0) | NUMBERS) if speed else None,
        hill_spacing=None if speed else draw(NUMBERS),
        units_per_turn=draw(st.integers(1, 10**6)),
        travel=draw(st.sampled_from(["forward", "backward"])),
        depth=draw(NUMBERS) if depth else None,
        surface=None if depth else draw(st.floats(-1e6, 1e6).filter(big)),
        finger_from=draw(st.sampled_from([None, "B"])),
        release=draw(st.none() | st.floats(-20, 20).filter(big)),
        tray=tray,
        acceleration_limit=draw(optional),
        soil_acceleration_limit=draw(optional),
        soil=soil,
    )
    machine = replace(loads(FOUR_BAR), planting=planting)
    text = dumps(machine)
    content = tomllib.loads(text)
    VALIDATOR.validate(content)
    if table is not None:
        assert content["planting"]["soil"].pop("table") == "s.csv"
        text = text.replace('soil.table = "s.csv"\n', "")
        bare = replace(soil, table=None) if any(terms) else None
        planting = replace(planting, soil=bare)
    assert loads(text).planting == planting


def big(value: float) -> bool:
    """Whether a value is 0 or one that a machine can have."""
    return value == 0 or abs(value) > 1e-20
