"""Files of tools at the command line: `check` tells what it has read, or one sentence."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import pytest
import tomli_w
from hypothesis import given
from jsonschema import Draft202012Validator

from surface.running import (
    READY,
    TOOLS,
    equipoise,
    example,
    refused,
    refuses,
    replaced,
    succeeded,
    unfolded,
)
from surface.test_fuzz import Document, checked, fuzz, garbled, mutated_of
from unit.schema.tool_samples import EVERY_TOOL, IMPEDANCE, TOOL

HAND = 'hand.stiffness = "8000 N/m"'


def checked_tool(text: str) -> list[str]:
    Path("mine.toml").write_text(text, encoding="utf-8")
    return succeeded(equipoise("check", "mine.toml")).splitlines()


# -- good files ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", TOOLS)
def test_check_of_an_example(name: str) -> None:
    lines = succeeded(equipoise("check", name)).splitlines()
    assert lines[0] == example(name)["title"]["en"]
    assert lines[-1] == f"ready: equipoise tool {name}"
    assert f"shaft: {float(example(name)['shaft']['length'].split()[0]) * 1e3:.0f} mm" in lines[2]
    for station in example(name)["shaft"]["stations"]:
        assert any(line.startswith(f"  {station['name']} at ") for line in lines)


def test_check_reports_what_it_has_read() -> None:
    text = unfolded("\n".join(checked_tool(EVERY_TOOL)))
    for part in (
        "from 1300 mm to 1500 mm: bending stiffness 1822 N m^2, 0.7867 kg/m",
        "engine at 0 mm: 3.600 kg, 0.02000 (vertical) and 0.02400 (lateral) kg m^2",
        "2 hands (0.1500 kg, 9000 (vertical) and 7000 (lateral) N/m",
        "excitation blade: unbalance 150.0 g mm, at saw, -0.7500 times the engine's speed",
        "day: mowing 2.500 h, walking 0.5000 h",
        "may change: position of belt, damping of the absorber at handle",
        "force at belt: at most 60.00 N",
        "weighted acceleration at handle: at most 2.500 m/s^2",
        "added mass: at most 100.0 g",
    ):
        assert part in text


def test_check_of_a_tool_with_a_table() -> None:
    Path("hand.csv").write_text(IMPEDANCE)
    lines = checked_tool(TOOL.replace(HAND, 'hand.impedance = "hand.csv"'))
    assert "  handle at 550.0 mm: 1 hand (impedance from 20.00 to 40.00 Hz)" in lines


def test_schema_fits_the_examples() -> None:
    schema = json.loads(succeeded(equipoise("schema", "--tool")))
    assert schema["title"] == "Equipoise tool file"
    for name in TOOLS:
        Draft202012Validator(schema).validate(example(name))


def test_the_engine_of_the_brush_cutter() -> None:
    text = succeeded(equipoise("check", "brush-cutter-engine"))
    assert text.endswith(f"{READY}\n")


# -- bad files -------------------------------------------------------------------------------------


@pytest.mark.parametrize("words", [("analyze", "--json"), ("plant",), ("respond",), ("modes",)])
def test_a_tool_for_commands_of_linkages(words: tuple[str, ...]) -> None:
    Path("mine.toml").write_text(TOOL)
    line = refused(equipoise(words[0], "mine.toml", *words[1:]))
    said = "this is the file of a tool, with a table [shaft]; use `equipoise tool FILE`"
    assert line == f"mine.toml: {said}"


BAD = {
    # what is replaced, by what, what is said
    "misspelt key": ("position", "positon", "shaft.stations[1].positon: no key is called"),
    "no unit": ('"1.5 m"', '"1.5"', "shaft.length: got '1.5'; the unit is missing; give a length"),
    "comma": ('"1.5 m"', '"1,5 m"', 'shaft.length: got \'1,5 m\'; the decimal sign is a point'),
    "off the shaft": ('"550 mm"', '"550 cm"', "shaft.stations[2].position: got 550 cm, which is"),
    "same name": ('"handle"', '"engine"', "shaft.stations[2].name: 'engine' is given twice"),
    "control": ('"handle"', '"\\u001b[31m"', "shaft.stations[2].name: got '\\x1b[31m'; give pri"),
    "no cause": ('force = "100 N"', "", "excitations[1]: give exactly one of force, unbalance"),
    "no table": (HAND, 'hand.impedance = "no.csv"',
                 "shaft.stations[2].hand.impedance: no.csv: there is no such file"),
    "bad table": (HAND, 'hand.impedance = "bad.csv"',
                  "shaft.stations[2].hand.impedance: bad.csv, line 1: got the column 'x'; the"),
    "table that is a folder": (HAND, 'hand.impedance = "."',
                               "shaft.stations[2].hand.impedance: .: this is a directory"),
    "no linkage": ('force = "100 N"', 'linkage = "brush-cutter-engin"',
                   "excitations[1].linkage: brush-cutter-engin: there is no such file; did you mean"
                   " 'brush-cutter-engine'? or give a path"),
    "itself": ('force = "100 N"', 'linkage = "mine.toml"',
               "excitations[1].linkage: mine.toml: this is the file of a tool"),
    "duplicate": ("[[excitations]]", "[shaft]\n[[excitations]]",
                  "line 19, column 7: a table of this name is there"),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "said"), BAD.values(), ids=BAD)
def test_bad_files(old: str, new: str, said: str) -> None:
    Path("bad.csv").write_text("x\n1\n")
    Path("mine.toml").write_text(replaced(TOOL, (old, new)))
    assert refuses("check mine.toml", said).startswith(f"mine.toml: {said}")


# -- random ones -----------------------------------------------------------------------------------


@given(mutated_of([tomllib.loads(EVERY_TOOL), *map(example, TOOLS)]))
@fuzz(150)
def test_mutated_documents(document: Document) -> None:
    Path("random.toml").write_bytes(tomli_w.dumps(document).encode())
    checked(equipoise("check", "random.toml"))


@given(garbled(TOOLS))
@fuzz(100)
def test_garbled_text(content: bytes) -> None:
    Path("random.toml").write_bytes(content)
    checked(equipoise("check", "random.toml"))
