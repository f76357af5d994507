"""Reading files of tools: what is understood, and one sentence for everything else."""

from __future__ import annotations

import tomllib
from math import pi
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from equipoise.errors import ModelError
from equipoise.handheld.design_plan import DesignLimit, DesignVariable
from equipoise.handheld.model import Harness, Impedance, Tool
from equipoise.handheld.shaft import Section, Tube
from equipoise.schema import examples, load, loads
from equipoise.schema.documents import dumps
from equipoise.schema.models import load_linkage, load_tool, loads_tool
from equipoise.schema.schemas import json_schema
from support.refusals import refused
from unit.schema.samples import FOUR_BAR
from unit.schema.tool_samples import EVERY_TOOL, IMPEDANCE, TOOL

VALIDATOR = Draft202012Validator(json_schema("tool"))
RPM = 2 * pi / 60


def changed(old: str, new: str, text: str = TOOL) -> str:
    assert old in text
    return text.replace(old, new, 1)


# -- what is understood ----------------------------------------------------------------------------


def test_values_arrive_in_si_units() -> None:
    tool = loads_tool(TOOL)
    assert tool.shaft.profile == Section(980.0, 2.3)
    assert tool.shaft.length == 1.5
    engine, handle = tool.stations
    assert (engine.name, engine.position, engine.mass) == ("engine", 0.0, 3.6)
    assert handle.hand is not None
    assert (handle.hand.stiffness, handle.hand.hands) == ((8000.0, 8000.0), 1)
    (force,) = tool.excitations
    assert (force.name, force.force, force.direction) == ("engine force", 100.0, "vertical")
    assert (tool.operation, tool.work, tool.design) == (None, (), None)


def test_everything_is_read() -> None:
    tool = loads_tool(EVERY_TOOL)
    assert tool.shaft.profile == Tube(0.03, 0.027, 70e9, 2700.0, 0.33, 0.35)
    assert [segment.profile for segment in tool.shaft.segments] == [
        Tube(0.03, 0.023, 70e9, 2700.0, 0.33),
        Tube(0.026, 0.0, 45e9, 1780.0, 0.35),
    ]
    engine, post, belt, handle, _ = tool.stations
    assert engine.inertia == (0.02, 0.024)
    assert (post.stiffness, post.damping) == ((1961.33, 1961.33), (3.0, 0.0))
    assert belt.harness == Harness((1500.0, 1500.0), (60.0, 40.0))
    assert handle.absorber is not None and handle.absorber.stiffness == (61700.0, 61700.0)
    linkage, blade, force = tool.excitations
    assert linkage.linkage == load("slider-crank-engine")
    assert (linkage.name, linkage.file) == ("engine linkage", "slider-crank-engine")
    assert (blade.unbalance, blade.ratio) == (1.5e-4, -0.75)
    assert force.direction == "rotating"
    assert tool.work[0].duration == 9000.0
    assert tool.operation is not None and tool.operation.racing == 9500 * RPM
    assert tool.design is not None
    assert tool.design.variables[0] == DesignVariable("belt", "position", 0.25, 0.42)
    assert tool.design.limits[0] == DesignLimit("force", 60.0, "belt")
    assert (tool.design.measure, tool.design.hands) == ("peak", ("handle",))


def test_the_mass_of_the_whole_shaft() -> None:
    shaft = loads_tool(changed('mass_per_length = "2.3 kg/m"', 'mass = "3 kg"')).shaft
    assert shaft.profile == Section(980.0, 2.0)
    assert shaft.mass == 3.0


@pytest.mark.parametrize("material", ["aluminium", "steel", "titanium", "magnesium"])
def test_materials(material: str) -> None:
    tube = f'outer_diameter = "26 mm"\nmaterial = "{material}"'
    old = 'mass_per_length = "2.3 kg/m"\nbending_stiffness = "980 N m^2"'
    text = changed(old, tube)
    assert f'material = "{material}"\n' in dumps(loads_tool(text))
    VALIDATOR.validate(tomllib.loads(text))


@pytest.mark.parametrize("text", [TOOL, EVERY_TOOL], ids=["tool", "everything"])
def test_schema_accepts(text: str) -> None:
    VALIDATOR.validate(tomllib.loads(text))
    VALIDATOR.validate(tomllib.loads(dumps(loads_tool(text))))


def test_examples_of_tools() -> None:
    names = examples("tool")
    others = {*examples("linkage"), *examples("study")}
    assert set(names) | others == set(examples())
    for name, title in names.items():
        tool = load_tool(name)
        assert tool.title == title
        VALIDATOR.validate(tomllib.loads(dumps(tool)))


# -- one kind of file for another ------------------------------------------------------------------


def test_a_tool_is_no_linkage(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(TOOL)
    with pytest.raises(ModelError) as caught:
        load_linkage(path)
    said = "this is the file of a tool, with a table [shaft]; use `equipoise tool FILE`"
    assert str(caught.value) == f"{path}: {said}"
    assert load(path) == loads_tool(TOOL)


def test_a_linkage_is_no_tool(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(FOUR_BAR)
    with refused(ModelError, place=str(path)):
        load_tool(path)
    assert load(path) == loads(FOUR_BAR)


@pytest.mark.parametrize("text", ["schema = 1\n", "schema = 1\n[shaft]\n[drive]\n", "x", ""])
def test_what_reports_neither_is_read_as_a_linkage(text: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(ModelError) as of_any:
        load(path)
    with pytest.raises(ModelError) as of_linkage:
        load(path)
    assert str(of_any.value) == str(of_linkage.value)


# -- refused ---------------------------------------------------------------------------------------

MASS = 'mass_per_length = "2.3 kg/m"'
SECTION = f'{MASS}\nbending_stiffness = "980 N m^2"'
TUBE = 'outer_diameter = "26 mm"\ninner_diameter = "23 mm"\n'
HAND = 'hand.stiffness = "8000 N/m"'
FORCE = 'force = "100 N"'
DESIGN = '[design]\nspeeds = ["6000 rpm", "8000 rpm"]\n'
VARIABLE = '[[design.variables]]\nstation = "handle"\nkey = "position"\nfrom = "0.1 m"\n'
REFUSED: dict[str, tuple[str, str, str, str]] = {
    # what is replaced, by what, the place, what is said
    "unknown key": ("length", "lenght", "shaft.lenght", "did you mean 'length'?"),
    "no shaft": (TOOL[TOOL.index("[shaft]") :], "", "shaft", "missing; add the table [shaft]"),
    "no section": (SECTION, "", "shaft", "give either bending_stiffness and mass_per_length, or"),
    "no stiffness": (SECTION, MASS, "shaft", "give either bending_stiffness and"),
    "no mass": (MASS, "", "shaft.mass_per_length", "missing; give it together with bending_stif"),
    "two masses": (MASS, f'{MASS}\nmass = "3 kg"', "shaft.mass", "has no place beside mass_per_"),
    "section and tube": (MASS, f"{MASS}\n{TUBE}", "shaft.outer_diameter", "has no place beside"),
    "mass of a tube": (SECTION, f'{MASS}\n{TUBE}material = "steel"', "shaft.mass_per_length",
                       "has no place beside outer_diameter; carried adds"),
    "no material": (SECTION, TUBE, "shaft.material", 'missing; give one such as "aluminium"'),
    "half a material": (SECTION, f'{TUBE}density = "2700 kg/m^3"', "shaft.youngs_modulus",
                        "missing; give it together with density"),
    "two materials": (SECTION, f'{TUBE}material = "steel"\nyoungs_modulus = "70 GPa"',
                      "shaft.youngs_modulus", "has no place beside material; give one of both"),
    "unknown material": (SECTION, f'{TUBE}material = "stel"', "shaft.material",
                         "did you mean 'steel'? (youngs_modulus and density stand for"),
    "unknown theory": (MASS, f'{MASS}\ntheory = "timo"', "shaft.theory",
                       "got 'timo'; did you mean 'timoshenko'?"),
    "no position": ('position = "550 mm"', "", "shaft.stations[2].position",
                    'missing; add position = "0 mm"'),
    "one plane": (HAND, 'hand.stiffness = { vertical = "1 N/m" }',
                  "shaft.stations[2].hand.stiffness.lateral", 'missing; add lateral = "20 kN/m"'),
    "unknown plane": (HAND, 'hand.stiffness = { vertikal = "1 N/m" }',
                      "shaft.stations[2].hand.stiffness.vertikal", "did you mean 'vertical'?"),
    "bad plane": (HAND, 'hand.stiffness = { vertical = "1 N/m", lateral = 2 }',
                  "shaft.stations[2].hand.stiffness.lateral", "got the bare number 2"),
    "planes as a list": (HAND, 'hand.stiffness = ["1 N/m", "2 N/m"]',
                         "shaft.stations[2].hand.stiffness",
                         'got a list of 2; give "20 kN/m", or { vertical = "20 kN/m", lateral'),
    "three hands": (HAND, f"{HAND}\nhand.hands = 3", "shaft.stations[2].hand.hands", "1 or 2"),
    "hand as text": (HAND, 'hand = "two"', "shaft.stations[2].hand", "got 'two'; give a table"),
    "no hand": (HAND, "hand = {}", "shaft.stations[2].hand", "the hand has no properties; give"),
    "spring and impedance": (HAND, f'{HAND}\nhand.impedance = "x.csv"',
                             "shaft.stations[2].hand.impedance", "a table can only be read beside"),
    "impedance as number": (HAND, "hand.impedance = 3", "shaft.stations[2].hand.impedance",
                            "got the number 3; give text in quotes"),
    "harness without spring": (HAND, 'harness.damping = "1 N s/m"',
                               "shaft.stations[2].harness.stiffness", 'add stiffness = "2 kN/m"'),
    "excitations as table": ("[[excitations]]", "[excitations]", "excitations",
                             "got a table; write each as a table under [[excitations]]"),
    "no cause": (FORCE, "", "excitations[1]", "give exactly one of force, unbalance and linkage"),
    "two causes": (FORCE, f'{FORCE}\nunbalance = "1 g mm"', "excitations[1]", "exactly one of"),
    "unbalance in kg": (FORCE, 'unbalance = "1 kg"', "excitations[1].unbalance",
                        "kg is the unit of a mass; an unbalance is wanted: kg m"),
    "unknown direction": (FORCE, f'{FORCE}\ndirection = "up"', "excitations[1].direction",
                          "got 'up'; give 'vertical', 'lateral' or 'rotating'"),
    "direction alone": (FORCE, 'unbalance = "1 g mm"\ndirection = "vertical"',
                        "excitations[1].direction", "goes with a force; leave it out"),
    "no ratio": (FORCE, f"{FORCE}\nratio = 0", "excitations[1].ratio", "got 0; what does not turn"),
    "one speed": (FORCE, f'{FORCE}\n[operation]\nspeed = "1 rpm"\nspeeds = ["1 rpm"]',
                  "operation.speeds", 'got a list of 1; give two such as ["6000 rpm"'),
    "unknown key of a station": (FORCE, f'{FORCE}\n{DESIGN}{VARIABLE}to = "1 m"\n'.replace(
                                 "position", "positon"), "design.variables[1].key",
                                 "no key of a station is called 'positon'; did you mean"),
    "range in another unit": (FORCE, f'{FORCE}\n{DESIGN}{VARIABLE}to = "1 kg"',
                              "design.variables[1].to", "kg is the unit of a mass; a length is"),
    "range as number": (FORCE, f"{FORCE}\n{DESIGN}{VARIABLE}to = 1", "design.variables[1].to",
                        "got the number 1; give number and unit in quotes"),
    "unknown output": (FORCE, f'{FORCE}\n{DESIGN}[[design.limits]]\noutput = "forces"\n'
                       'at_most = "1 N"', "design.limits[1].output", "did you mean 'force'?"),
    "unknown measure": (FORCE, f'{FORCE}\n{DESIGN}measure = "mean"', "design.measure",
                        "got 'mean'; give 'rms' or 'peak'"),
}  # fmt: skip
"""What both the reader and the schema refuse."""
BEYOND_THE_SCHEMA: dict[str, tuple[str, str, str, str]] = {
    "mass of parts": (SECTION, 'bending_stiffness = "980 N m^2"\nmass = "3 kg"\n'
                      f'[[shaft.segments]]\nfrom = "0 m"\nto = "1 m"\n{SECTION}', "shaft.mass",
                      "does not determine that of each segment; give mass_per_length"),
    "timoshenko without measures": (MASS, f'{MASS}\ntheory = "timoshenko"',
                                    "shaft.bending_stiffness", "give the dimensions of a tube"),
    "off the shaft": ('"550 mm"', '"1.6 m"', "shaft.stations[2].position",
                      "got 1.6 m, which is off the shaft; give 0 m to 1.5 m"),
    "unknown station": ('station = "engine"', 'station = "engin"', "excitations[1].station",
                        "no station is called 'engin'; did you mean 'engine'?"),
    "no linkage": (FORCE, 'linkage = "engine.toml"', "excitations[1].linkage",
                   "got 'engine.toml'; without a file beside which to look, give the name of"),
    "linkage that is a tool": (FORCE, 'linkage = "pole-saw"', "excitations[1].linkage",
                               "pole-saw: this is the file of a tool"),
    "nothing to change": (FORCE, f"{FORCE}\n{DESIGN}", "design.variables", "give at least one"),
}  # fmt: skip


@pytest.mark.parametrize("case", [*REFUSED, *BEYOND_THE_SCHEMA])
def test_refused(case: str) -> None:
    old, new, place, said = (REFUSED | BEYOND_THE_SCHEMA)[case]
    text = changed(old, new)
    with pytest.raises(ModelError) as caught:
        loads_tool(text, "tool.toml")
    line = str(caught.value)
    assert line.startswith(f"tool.toml: {place}: ")
    assert said in line
    assert "\n" not in line
    assert len(line) < 400
    assert VALIDATOR.is_valid(tomllib.loads(text)) is (case in BEYOND_THE_SCHEMA)


# -- files beside it -------------------------------------------------------------------------------


def beside(tmp_path: Path, old: str, new: str, **files: str) -> Path:
    """Write a tool with files beside it."""
    for name, text in files.items():
        (tmp_path / name.replace("_", ".")).write_text(text)
    path = tmp_path / "tool.toml"
    path.write_text(changed(old, new))
    return path


def impedances_of(tool: Tool) -> tuple[Impedance, ...]:
    (held,) = tool.grips
    assert held.hand is not None
    return held.hand.impedance


def test_an_impedance_for_both_planes(tmp_path: Path) -> None:
    path = beside(tmp_path, HAND, 'hand.impedance = "hand.csv"', hand_csv=IMPEDANCE)
    (table,) = impedances_of(load_tool(path))
    assert table == Impedance((20.0, 40.0), (120.0, 150.0), (-80.0, 10.0))
    assert table.file == "hand.csv"


def test_an_impedance_for_each_plane(tmp_path: Path) -> None:
    polar = "frequency [kHz],magnitude [N s/mm],phase [deg]\n0.02,0.1,90\n0.04,0.2,-60\n"
    new = 'hand.impedance = { vertical = "a.csv", lateral = "b.csv" }\nhand.hands = 2'
    path = beside(tmp_path, HAND, new, a_csv=IMPEDANCE, b_csv=polar)
    _, lateral = impedances_of(load_tool(path))
    assert lateral.frequency == (20.0, 40.0)
    assert lateral.resistance == pytest.approx((0.0, 100.0))
    assert lateral.reactance == pytest.approx((100.0, -(30000**0.5)))
    assert lateral.resistance[0] == 0.0


def engine(old: str = "", new: str = "") -> str:
    text = (
        Path(__file__).parents[3] / "src/equipoise/examples/slider-crank-engine.toml"
    ).read_text(encoding="utf-8")
    return changed(old, new, text) if old else text


def test_a_linkage_beside_the_tool(tmp_path: Path) -> None:
    path = beside(tmp_path, FORCE, 'linkage = "engine.toml"', engine_toml=engine())
    (shaken,) = load_tool(path).excitations
    assert (shaken.linkage, shaken.file) == (load("slider-crank-engine"), "engine.toml")


def test_a_linkage_beside_goes_before_an_example(tmp_path: Path) -> None:
    path = beside(tmp_path, FORCE, 'linkage = "scotch-yoke"')
    (tmp_path / "scotch-yoke").write_text(engine())
    (shaken,) = load_tool(path).excitations
    assert shaken.linkage == load("slider-crank-engine")


LINKAGES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "missing": ({}, {"place": "excitations[1].linkage"}),
    "broken": ({"engine_toml": "schema = 2"}, {"place": "excitations[1].linkage"}),
    "no masses": ({"engine_toml": FOUR_BAR}, {"place": "excitations[1].linkage"}),
    "itself": ({"engine_toml": TOOL}, {"place": "excitations[1].linkage"}),
    "rocking": (
        {"engine_toml": engine('["25 mm", "0 mm"]', '["95 mm", "0 mm"]')},
        {"place": "excitations[1].linkage"},
    ),
}


@pytest.mark.parametrize(("files", "expected"), LINKAGES.values(), ids=LINKAGES)
def test_bad_linkages(files: dict[str, Any], expected: dict[str, Any], tmp_path: Path) -> None:
    path = beside(tmp_path, FORCE, 'linkage = "engine.toml"', **files)
    with refused(ModelError, **expected) as caught:
        load_tool(path)
    assert "\n" not in str(caught.value)
