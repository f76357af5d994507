"""The table [planting] of the model file: read, refused in one sentence, and written again."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from math import radians

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from equipoise.errors import ModelError
from equipoise.mechanism.field import Planting, Soil, SoilTable
from equipoise.schema import dumps, json_schema, loads
from unit.schema.samples import FOUR_BAR

VALIDATOR = Draft202012Validator(json_schema())
SHORT = '\n[planting]\ntip = "C"\nforward_speed = "60 cm/s"\ndepth = "4 cm"\n'
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
    assert planting_of(FOUR_BAR + SHORT) == Planting(tip="C", forward_speed=0.6, depth=0.04)
    assert loads(FOUR_BAR).planting is None


def test_all_values_arrive_in_si_units() -> None:
    assert planting_of(FOUR_BAR + FULL) == VALUES


@pytest.mark.parametrize("text", [SHORT, FULL], ids=["short", "full"])
def test_schema_accepts_what_is_read(text: str) -> None:
    VALIDATOR.validate(tomllib.loads(FOUR_BAR + text))
    VALIDATOR.validate(tomllib.loads(dumps(loads(FOUR_BAR + text))))


SPEED, DEPTH = 'forward_speed = "60 cm/s"', 'depth = "4 cm"'
REFUSED = {
    # what is replaced, by what, the place, what is said
    "wrong unit": (SPEED, 'forward_speed = "60 cm"', ".forward_speed",
                   "got '60 cm'; cm is the unit of a length; a speed is wanted: m/s, "),
    "bare number": (DEPTH, "depth = 0.04", ".depth",
                    'got the bare number 0.04; give number and unit in quotes, such as "33.5 mm"'),
    "no unit": (DEPTH, 'depth = "4"', ".depth", "the unit is missing; give a length"),
    "no quantity": (DEPTH, 'depth = "deep"', ".depth", "got 'deep'; write the number"),
    "unknown key": (DEPTH, 'dept = "4 cm"', ".dept", "no key is called 'dept'; did you mean 'de"),
    "no tip": ('tip = "C"\n', "", ".tip", 'missing; add tip = "P"'),
    "tip as a number": ('tip = "C"', "tip = 3", ".tip", "got the number 3; give text in quotes"),
    "travel": (DEPTH, f'{DEPTH}\ntravel = "left"', ".travel",
               "got 'left'; give 'forward' or 'backward'"),
    "units as text": (DEPTH, f'{DEPTH}\nunits_per_turn = "2"', ".units_per_turn",
                      "got '2'; give a whole number without quotes"),
    "half a unit": (DEPTH, f"{DEPTH}\nunits_per_turn = 1.5", ".units_per_turn",
                    "got the number 1.5; give a whole number"),
    "no unit a turn": (DEPTH, f"{DEPTH}\nunits_per_turn = 0", ".units_per_turn",
                       "got the number 0; give 1 or more"),
    "many units a turn": (DEPTH, f"{DEPTH}\nunits_per_turn = 2000000", ".units_per_turn",
                          "got the number 2000000; give 1000000 or less"),
    "tray with one point": (DEPTH, f'{DEPTH}\ntray = [["0 mm", "0 mm"]]', ".tray",
                            "got a list of 1; give a list of two values"),
    "tray with three points": (
        DEPTH, f'{DEPTH}\ntray = [["0 mm", "0 mm"], ["1 mm", "0 mm"], ["2 mm", "0 mm"]]', ".tray",
        "got a list of 3; give a list of two values"),
    "tray as one point": (DEPTH, f'{DEPTH}\ntray = ["0 mm", "1 mm"]', ".tray[1]",
                          "got '0 mm'; give [\"33.5 mm\", \"0 mm\"] or {"),
    "unit in the tray": (DEPTH, f'{DEPTH}\ntray = [["0 mm", "0 s"], ["1 mm", "0 mm"]]',
                         ".tray[1][2]", "s is the unit of a time; a length is wanted"),
    "limit": (DEPTH, f'{DEPTH}\nacceleration_limit = "20 g"', ".acceleration_limit",
              "g is the unit of a mass; an acceleration is wanted: m/s^2, mm/s^2, ft/s^2, gn"),
    "release": (DEPTH, f'{DEPTH}\nrelease = "1 mm"', ".release", "an angle is wanted"),
    "soil as a force": (DEPTH, f'{DEPTH}\nsoil = "20 N"', ".soil", "got '20 N'; give a table"),
    "soil per depth": (DEPTH, f'{DEPTH}\nsoil.per_depth = "20 N"', ".soil.per_depth",
                       "N is the unit of a force; a stiffness is wanted: N/m, N/mm"),
    "soil per speed": (DEPTH, f'{DEPTH}\nsoil.per_speed = "20 N/m"', ".soil.per_speed",
                       "a damping coefficient is wanted: N s/m"),
    "soil per both": (DEPTH, f'{DEPTH}\nsoil.per_depth_and_speed = "20 N s/m"',
                      ".soil.per_depth_and_speed", "a damping coefficient per length is wanted"),
    "unknown key of soil": (DEPTH, f'{DEPTH}\nsoil.resistence = "20 N"', ".soil.resistence",
                            "no key is called 'resistence'; did you mean 'resistance'?"),
    "soil table as a list": (DEPTH, f"{DEPTH}\nsoil.table = [1, 2]", ".soil.table",
                             "got a list of 2; give text in quotes"),
    "both speeds": (DEPTH, f'{DEPTH}\nhill_spacing = "15 cm"', "",
                    "give either forward_speed or hill_spacing"),
    "no speed": (SPEED, "", "", "give either forward_speed or hill_spacing"),
    "depth and surface": (DEPTH, f'{DEPTH}\nsurface = "-1 cm"', "", "give either depth or surface"),
    "neither depth nor surface": (DEPTH, "", "", "give either depth or surface"),
}  # fmt: skip
"""What both the reader and the schema refuse."""
BEYOND_THE_SCHEMA = {
    "unknown tip": ('tip = "C"', 'tip = "Cc"', ".tip",
                    "no point of a moving link is called 'Cc'; did you mean 'C'?"),
    "negative speed": (SPEED, 'forward_speed = "-60 cm/s"', ".forward_speed",
                       'got -0.6 m/s; give its size, and travel = "backward" for a machine'),
    "negative depth": (DEPTH, 'depth = "-4 cm"', ".depth", "got -0.04 m; give more than"),
    "no depth": (DEPTH, 'depth = "0 cm"', ".depth", "got 0 m; give more than 0"),
    "negative hills": (SPEED, 'hill_spacing = "-15 cm"', ".hill_spacing",
                       "got -0.15 m; give more than 0"),
    "finger": (DEPTH, f'{DEPTH}\nfinger_from = "D"', ".finger_from",
               "no other point of coupler, the tip's link, is called 'D'; there are 'B'"),
    "tray of no length": (DEPTH, f'{DEPTH}\ntray = [["1 mm", "0 mm"], ["1 mm", "0 mm"]]', ".tray",
                          "its two points are the same; give both ends of the edge"),
    "empty soil": (DEPTH, f"{DEPTH}\nsoil = {{}}", ".soil", "give at least one of resistance, per"),
    "pulling soil": (DEPTH, f'{DEPTH}\nsoil.resistance = "-1 N"', ".soil.resistance",
                     "got -1 N; soil resists, give 0 or more"),
    "table without a folder": (DEPTH, f'{DEPTH}\nsoil.table = "s.csv"', ".soil.table",
                               "got 's.csv'; a table can only be read beside a file"),
}  # fmt: skip


def complaint(old: str, new: str) -> str:
    assert old in SHORT
    with pytest.raises(ModelError) as caught:
        loads(FOUR_BAR + SHORT.replace(old, new), "model.toml")
    text = str(caught.value)
    assert "\n" not in text
    assert len(text) < 400
    return text.removeprefix("model.toml: planting")


@pytest.mark.parametrize(("old", "new", "key", "said"), REFUSED.values(), ids=REFUSED)
def test_reader_and_schema_refuse(old: str, new: str, key: str, said: str) -> None:
    assert complaint(old, new).startswith(f"{key}: ")
    assert said in complaint(old, new)
    assert not VALIDATOR.is_valid(tomllib.loads(FOUR_BAR + SHORT.replace(old, new)))


@pytest.mark.parametrize(
    ("old", "new", "key", "said"), BEYOND_THE_SCHEMA.values(), ids=BEYOND_THE_SCHEMA
)
def test_the_reader_refuses(old: str, new: str, key: str, said: str) -> None:
    assert complaint(old, new).startswith(f"{key}: ")
    assert said in complaint(old, new)
    VALIDATOR.validate(tomllib.loads(FOUR_BAR + SHORT.replace(old, new)))


# -- writing ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", [SHORT, FULL], ids=["short", "full"])
def test_what_is_written_is_read_again(text: str) -> None:
    machine = loads(FOUR_BAR + text)
    assert loads(dumps(machine)) == machine
    assert dumps(loads(dumps(machine))) == dumps(machine)


def test_planting_is_written_as_people_write_it() -> None:
    written = dumps(loads(FOUR_BAR + SHORT))
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
