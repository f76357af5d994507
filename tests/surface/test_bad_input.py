"""Bad model files, odd files and interruptions: one sentence, and soon."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import equipoise as eq
from equipoise.errors import MotionError
from support.chosen import EXHAUSTIVE, few
from surface.running import (
    READY,
    changed,
    equipoise,
    example_text,
    interrupted,
    massless,
    refused,
    refuses,
    replaced,
    succeeded,
    within,
)

FOUR_BAR = "yamashita-1"


def four_bar(old: str, new: str) -> str:
    """Return the text of an example with one piece of text replaced."""
    return replaced(example_text(FOUR_BAR), (old, new))


# -- model files -----------------------------------------------------------------------------------

CRANK = "links.crank"
VALUES = {
    "name": ("[links.crank]", '[links."クランク"]\nm = 1', 'links."クランク".m', "no key is"),
    "case of a key": ('inertia = "', 'Inertia = "', f"{CRANK}.Inertia", "did you mean 'inertia'?"),
    # what is replaced, by what, the place, what is said
    "nan": ('"33.5 mm"', '"nan mm"', f"{CRANK}.points.B[1]", "give a finite number"),
    "nan as a number": ('"33.5 mm"', "nan", f"{CRANK}.points.B[1]", '"33.5 mm"'),
    "infinity": ('"33.5 mm"', '"-inf mm"', f"{CRANK}.points.B[1]", "give a finite number"),
    "infinite power": ('"33.5 mm"', '"1e999 mm"', f"{CRANK}.points.B[1]", "give a usual size"),
    "huge": ('"33.5 mm"', '"1e40 mm"', f"{CRANK}.points.B[1]", "give a usual size"),
    "tiny": ('"33.5 mm"', '"1e-40 mm"', f"{CRANK}.points.B[1]", "give a usual size"),
    "bare number": ('"33.5 mm"', "33.5", f"{CRANK}.points.B[1]", '"33.5 mm"'),
    "no unit": ('"33.5 mm"', '"33.5"', f"{CRANK}.points.B[1]", "the unit is missing"),
    "no number": ('"33.5 mm"', '"mm"', f"{CRANK}.points.B[1]", '"33.5 mm"'),
    "empty": ('"33.5 mm"', '""', f"{CRANK}.points.B[1]", "give number and unit"),
    "no space": ('"33.5 mm"', '"33.5mm"', f"{CRANK}.points.B[1]", "put a space between"),
    "comma": ('"33.5 mm"', '"33,5 mm"', f"{CRANK}.points.B[1]", '"33.5 mm"'),
    "wrong unit": ('"33.5 mm"', '"33.5 kg"', f"{CRANK}.points.B[1]", "kg is the unit of a mass"),
    "unknown unit": ('"33.5 mm"', '"33.5 furlong"', f"{CRANK}.points.B[1]", "a length is wanted"),
    "misspelt unit": ('"33.5 mm"', '"33.5 MM"', f"{CRANK}.points.B[1]", '"33.5 mm"'),
    "hertz": ('"193 rpm"', '"50 Hz"', "drive.speed", '"50 turn/s" or "3000 rpm"'),
    "negative mass": ('"199 g"', '"-199 g"', f"{CRANK}.mass", "a mass cannot be negative"),
    "negative inertia": ('"30 kg mm^2"', '"-30 kg mm^2"', f"{CRANK}.inertia", "negative"),
    "inertia without mass": ('"199 g"', '"0 g"', f"{CRANK}.inertia", "give 0"),
    "half a mass": ('mass = "199 g"\n', "", CRANK, "mass missing; give mass, center_of_mass and"),
    "three coordinates": ('["33.5 mm", "0 mm"]', '["1 mm", "0 mm", "0 mm"]', f"{CRANK}.points.B",
                          "give a list of two values"),
    "one coordinate": ('["33.5 mm", "0 mm"]', '["1 mm"]', f"{CRANK}.points.B",
                       "give a list of two values"),
    "point as text": ('["33.5 mm", "0 mm"]', '"33.5 mm, 0 mm"', f"{CRANK}.points.B",
                      'give ["33.5 mm", "0 mm"] or {'),
    "half a polar point": (', direction = "-83 deg"', "", "frame.points.D.direction", "missing"),
    "unknown key": ('link = "crank"', 'lnk = "crank"', "drive.lnk", "did you mean 'link'?"),
    "unknown table": ("[assembly]", "[asembly]", "asembly", "did you mean 'assembly'?"),
    "missing key": ('speed = "193 rpm"', "", "drive.speed", 'add speed = "193 rpm"'),
    "missing table": ('[drive]\nlink = "crank"\nspeed = "193 rpm"', "", "drive",
                      "add the table [drive]"),
    "unknown link": ('link = "crank"', 'link = "cranc"', "drive.link", "did you mean 'crank'?"),
    "a link called frame": ("[links.rocker]", "[links.frame]", "links.frame", "another name"),
    "a link without a name": ("[links.rocker]", "[links.'']", "", "another name"),
    "a link without points": ('points.A = ["0 mm", "0 mm"]\npoints.B = ["33.5 mm", "0 mm"]\n',
                              "points = {}\n", f"{CRANK}.points", "give at least one"),
    "unknown side": ('C = "left"', 'C = "leftt"', "assembly.C", "did you mean 'left'?"),
    "unknown joint": ('C = "left"', 'C = "left"\nQ = "left"', "assembly.Q", "meet at C"),
    "missing assembly": ('[assembly]\nC = "left"', "", "assembly.C", '"left" or "right"'),
    "text for a table": ("[assembly]", 'assembly = "left"\n[links.more]', "", ""),
    "schema of another version": ("schema = 1", "schema = 2", "schema", "reads schema = 1"),
    "schema as text": ("schema = 1", 'schema = "1"', "schema", "reads schema = 1"),
    "no schema": ("schema = 1\n", "", "schema", "begin the file with schema = 1"),
    "title as a number": ('title.en = "', 'title.en = 7 # "', "title.en",
                          "got the number 7; give text in quotes"),
}  # fmt: skip
ELSEWHERE = {
    "slider on an unknown link": ("slider-crank-engine", 'on = "frame"', 'on = "fram"',
                                  "sliders[1].on", "did you mean 'frame'?"),
    "slider at an unknown point": ("slider-crank-engine", 'point = "C"\non =', 'point = "Q"\non =',
                                   "sliders[1].point", "no point of piston is called 'Q'"),
    "slider on itself": ("slider-crank-engine", 'on = "frame"', 'on = "piston"', "sliders[1].on",
                         "cannot slide on itself"),
    "ratio and teeth": ("geared-counterweight", "ratio = -0.47", "ratio = -0.47\nteeth = [2, 3]",
                        "gears[1]", "either ratio or teeth"),
    "neither ratio nor teeth": ("geared-counterweight", "ratio = -0.47", "", "gears[1]",
                                "either ratio or teeth"),
    "ratio of 0": ("geared-counterweight", "ratio = -0.47", "ratio = 0", "gears[1]",
                   "no pair of gears has that"),
    "ratio with a unit": ("geared-counterweight", "ratio = -0.47", 'ratio = "-0.47"',
                          "gears[1].ratio", "plain number"),
    "ratio that is not a number": ("geared-counterweight", "ratio = -0.47", "ratio = nan",
                                   "gears[1].ratio", "finite"),
    "half a tooth": ("planetary-planting-arm", "teeth = [40, 40]", "teeth = [40, 0.5]",
                     "gears[1].teeth[2]", "whole number"),
    "negative teeth": ("planetary-planting-arm", "teeth = [40, 40]", "teeth = [40, -40]",
                       "gears[1].teeth[2]", "1 or more"),
    "teeth that push backwards": ("planetary-planting-arm", "teeth = [40, 40]",
                                  'teeth = [40, 40]\npressure_angle = "95 deg"',
                                  "gears[1].pressure_angle", "got 95 deg; give an angle from 0"),
    "gear on itself": ("geared-counterweight", '"rocker", "counterweight"', '"rocker", "rocker"',
                       "gears[1]", "three different bodies"),
    "spring on an unknown link": ("spring-balanced-crank", '"rocker"\npoint', '"roker"\npoint',
                                  "springs[1].link", "did you mean 'rocker'?"),
    "spring to a moving point": ("spring-balanced-crank", 'to = "S"', 'to = "B"', "springs[1].to",
                                 "no point of the frame is called 'B'"),
    "spring at a pivot": ("spring-balanced-crank", 'point = "F"', 'point = "D"',
                          "springs[1].point", "give a point that moves"),
    "spring without stiffness": ("spring-balanced-crank", 'stiffness = "3.3 N/mm"\n', "",
                                 "springs[1]", "give exactly one of stiffness"),
    "spring that is too soft": ("spring-balanced-crank", '"3.3 N/mm"', '"0 N/mm"',
                                "springs[1].stiffness", "more than 0"),
    "negative free length": ("spring-balanced-crank", '"76 mm"', '"-76 mm"',
                             "springs[1].free_length", "cannot be negative"),
    "stiffness as a force": ("spring-balanced-crank", '"3.3 N/mm"', '"3.3 N"',
                             "springs[1].stiffness", "stiffness"),
    "gear as a table": ("geared-counterweight", "[[gears]]", "[gears]", "gears", "[[gears]]"),
    "unknown point of the position": ("class-three", 'points.Q = ["205 mm", "10 mm"]',
                                      'points.QQ = ["205 mm", "10 mm"]', "position.points.QQ",
                                      "did you mean 'Q'?"),
}  # fmt: skip
LOAD = '\n[[loads]]\nlink = "coupler"\n'
LOADS = {
    "nothing": ("", "loads[1]", "exactly one of force, torque, table, gas and indicator"),
    "force at no point": ('force = ["0 N", "1 N"]', "loads[1].point", "missing"),
    "torque at a point": ('point = "P"\ntorque = "1 N m"', "loads[1].point", "leave it out"),
    "force and torque": ('point = "P"\nforce = ["0 N", "1 N"]\ntorque = "1 N m"', "loads[1]",
                         "exactly one"),
    "half a window": ('torque = "1 N m"\nfrom = "0 deg"', "loads[1]", "both from and to"),
    "unknown point": ('point = "Q"\nforce = ["0 N", "1 N"]', "loads[1].point", "called 'Q'"),
    "missing table": ('table = "no.csv"', "loads[1].table", "there is no such file"),
    "table that is a folder": ('table = "."', "loads[1].table", "directory"),
    "bad table": ('table = "bad.csv"', "loads[1].table", "bad.csv, line 1: "),
    "bad row": ('table = "row.csv"', "loads[1].table", "row.csv, line 3: "),
    "nan in a table": ('table = "nan.csv"', "loads[1].table", "nan.csv, line 2"),
}  # fmt: skip
SUPPORT = """
[support]
mass = "60 kg"
center_of_mass = ["0 mm", "300 mm"]
inertia = "4 kg m^2"
"""
MOUNT = '[support.mounts.front]\npoint = ["0 mm", "0 mm"]\n'
MOTOR = "[drive.motor]\n"
SUPPORTS = {
    "freedom": (f'{SUPPORT}freedoms = ["pich"]', "support.freedoms[1]",
                "got 'pich'; did you mean 'pitch'?"),
    "no place": (f'{SUPPORT}[support.mounts.front]\nstiffness = "1 kN/m"', "support.mounts.front",
                 "give either point or axis"),
    "wrong kind": (f'{SUPPORT}{MOUNT}torsional_stiffness = "1 N m/rad"',
                   "support.mounts.front.torsional_stiffness", "has no place beside a point"),
    "unknown key": (f'{SUPPORT}{MOUNT}stifness = "1 kN/m"', "support.mounts.front.stifness",
                    "did you mean 'stiffness'?"),
    "space": (f'{SUPPORT}freedoms = ["roll"]', "support.inertia", "give three, about x, y and z"),
    "row": ("[[rows]]\n[[rows]]\nphase = 90", "rows[2].phase", "got the bare number 90"),
    "rows": ("[[rows]]\n" * 201, "rows", "got 201; at most 200 are used"),
    "half a motor": (f'{MOTOR}stall_torque = "1 N m"', "drive.motor", "give either no_load_speed"),
    "missing table": (f'{MOTOR}table = "no.csv"', "drive.motor.table", "there is no such file"),
    "bad table": (f'{MOTOR}table = "unit.csv"', "drive.motor.table", "unit.csv, line 1, column"),
    "falling speeds": (f'{MOTOR}table = "fall.csv"', "drive.motor.table", "fall.csv, line 3,"),
}  # fmt: skip
TEXTS = {
    "duplicate key": (
        "schema = 1\nschema = 1\n",
        "line 2, column 11: cannot overwrite a value, a key or",
    ),
    "duplicate link": (
        example_text(FOUR_BAR) + "\n[links.crank]\n",
        "a table of this name is there already; put all its keys below one",
    ),
    "no quotes": ("schema = 1\n[drive]\nspeed = 193 rpm", 'put text in quotes: speed = "193 rpm"'),
    "word without quotes": ("[drive]\nlink = crank  # it", 'put text in quotes: link = "crank"'),
    "curly quotes": ("title = “A drive”", 'put text in quotes: title = "A drive"'),
    "decimal comma": (
        "schema = 1\nmass = 0,9\n",
        "line 2, column 9: the decimal sign is a point, not a comma: 0.9",
    ),
    "decimal comma and unit": ("mass = 900,5 g", 'stands in quotes: "900.5 g"'),
    "decimal comma in a list": ("points.B = [25,5 mm, 0 mm]", 'stands in quotes: "25.5 mm"'),
    "decimal comma and thousands": ("mass = 1.900,5 g # it", 'stands in quotes: "1900.5 g"'),
    "decimal comma in a table": ('x = { a = 25,5, b = "1" }', "not a comma: 25.5"),
    "quantity in a list": ('x = [25 mm, "0 mm"]', 'put number and unit in quotes: "25 mm"'),
    "open quotes": ('mass = "900 g\n', "the quotes are opened, but not closed: mass"),
    "colon": ('mass: "900 g"', 'column 5: write mass = "900 g"'),
    "no equals sign": ("mass 900 g", 'column 6: write mass = "900 g"'),
    "open bracket": ("[links.crank\n", "put the name of a table in brackets: [links.crank]"),
    "missing bracket": ("sliders]]\n", "put the name of a table in brackets: [[sliders]]"),
    "missing comma": ('x = ["1 mm" "2 mm"]', "a comma is missing before this, or ] at the end"),
    "table of values without units": ("t,x\n1,2\n", "this is a table of values (CSV), not a mo"),
    "table of values": ("time [s],x [m]\n1,2\n", "this is a table of values (CSV), not a model"),
    "two numbers": ("schema = 1 2", "line 1, column 12: expected newline"),
    "space in a name": (
        "[links.rod 1]",
        'line 1, column 12: put the name in quotes: [links."rod 1"]',
    ),
    "Japanese name": (
        "\n[links.クランク]",
        'put the name in quotes: [links."クランク"]; without them',
    ),
    "point with a space": ("points.B 1 = []", 'put the name in quotes: points."B 1" ='),
    "name inside": ('points = { "a b" = 1, é = 2 }', 'put the name in quotes: "é" ='),
    "half quoted": ('[[a."b c".d e]]', 'put the name in quotes: [[a."b c"."d e"]]'),
    "text like a key": ('title = "a, b c = 3\n', "line 1, column 20: "),
    "quoted name": ('[links."クランク"]\nmass = "5"', "schema: missing"),
    "empty": ("", "begin the file with schema = 1"),
    "prose": ("Dear Sir or Madam", "line 1"),
    "JSON": ('{"schema": 1}', "this is JSON, not a model file"),
    "XML": ("<schema>1</schema>", "this is XML, not a model file; `equipoise import` reads"),
    "binary": (b"\x7fELF\x02\x01\x01\x00\xff\xfe" * 40, "UTF-8"),
    "zeros": (bytes(5000), "line 1"),
    "UTF-16": (example_text(FOUR_BAR).encode("utf-16"), "UTF-8"),
    "Latin-1": (
        four_bar("Planting", "Überträger").encode("latin-1", "replace"),
        "line 3 is not text in UTF-8",
    ),
    "deep": (f"x = {'[' * 5000}{']' * 5000}", "nested too deeply"),
    "dotted": (f"{'a.' * 50_000}b = 1", "more than 50 parts"),
    "long number": (f"schema = {'1' * 5000}", "number"),
}
LINKAGES = {
    "never joined": (
        four_bar('distance = "88 mm"', 'distance = "880 mm"'),
        "cannot be joined at any crank angle",
    ),
    "link of no length": (
        four_bar('points.C = ["71.5 mm", "0 mm"]', 'points.C = ["0 mm", "0 mm"]'),
        "links.coupler.points: B and C lie at the same place",
    ),
    "crank of no length": (
        four_bar('points.B = ["33.5 mm", "0 mm"]', 'points.B = ["0 mm", "0 mm"]'),
        "links.crank.points: A and B lie at the same place",
    ),
    "no free motion": (
        four_bar('points.P = ["-160 mm"', 'points.A = ["-160 mm"'),
        "the linkage cannot move",
    ),
    "two free motions": (
        four_bar("[assembly]", '[links.more]\npoints.P = ["0 mm", "0 mm"]\n[assembly]'),
        "the mobility of the linkage is 2",
    ),
    "drive link off the frame": (
        four_bar('link = "crank"', 'link = "coupler"'),
        "drive.link: 'coupler' shares 0 points with the frame",
    ),
}

STUCK = {
    "crank too long": four_bar('points.B = ["33.5 mm", "0 mm"]', 'points.B = ["120 mm", "0 mm"]'),
    # 118 + 33.5 = 71.5 + 80
    "change point": four_bar('distance = "88 mm"', 'distance = "118 mm"'),
    "parallelogram": four_bar('distance = "88 mm"', 'distance = "71.5 mm"').replace(
        '"80 mm"', '"33.5 mm"'
    ),
}
"""Models whose crank cannot turn fully, or not in a definite way."""


FILES = {
    "bad.csv": "angle,force\n0,1\n",
    "row.csv": "crank_angle [deg],torque [N m]\n0,1\n10,1,2\n",
    "nan.csv": "crank_angle [deg],torque [N m]\n0,nan\n",
    "unit.csv": "speed,torque\n0,1\n",
    "fall.csv": "speed [rpm],torque [N m]\n10,1\n0,2\n",
}


def bad_models() -> Iterator[object]:
    """Text of a model file, where it is wrong, and what is said of that."""
    for name, (old, new, place, said) in VALUES.items():
        yield pytest.param(four_bar(old, new), place, said, id=name)
    for name, (model, old, new, place, said) in ELSEWHERE.items():
        yield pytest.param(replaced(example_text(model), (old, new)), place, said, id=name)
    for begin, table in ((LOAD, LOADS), ("\n", SUPPORTS)):
        for name, (more, place, said) in table.items():
            yield pytest.param(f"{example_text(FOUR_BAR)}{begin}{more}\n", place, said, id=name)
    for name, (text, said) in (TEXTS | LINKAGES).items():
        yield pytest.param(text, "", said, id=name)


@pytest.mark.parametrize(("text", "place", "said"), [*bad_models()])
def test_a_bad_model(text: str | bytes, place: str, said: str) -> None:
    """Of which `check` and `analyze` say the same."""
    for name, content in FILES.items():
        Path(name).write_text(content)
    Path("bad.toml").write_bytes(text.encode() if isinstance(text, str) else text)
    line = refuses("check bad.toml", said)
    assert refused(equipoise("analyze", "bad.toml", "--json")) == line
    assert line.startswith(f"bad.toml: {place}: " if place else "bad.toml: ")


STUDY = """schema = 1
model = "bad.toml"
vary = [{ path = "links.rocker.mass", range = ["100 g", "900 g"], steps = 3 }]
outputs = [{ value = "shaking_force.rms" }]
sampling = { method = "grid" }
"""


REFUSING = (
    "analyze bad.toml --json",
    "check bad.toml",
    "balance conditions bad.toml",
    "balance sensitivities bad.toml shaking_force.y",
    "balance bad.toml",
    "report bad.toml -o page.html",
    "animate bad.toml -o moving.svg",
    "check bad-study.toml",
    "sweep bad-study.toml -o bad.zarr",
)
"""Commands that ask what a machine does."""


@pytest.mark.exhaustive(but=["crank too long"])
@pytest.mark.parametrize("text", STUCK.values(), ids=STUCK)
def test_a_crank_that_cannot_turn(text: str) -> None:
    """Every command says the same of it; each line that it gives makes a machine that works."""
    Path("bad.toml").write_text(text)
    Path("bad-study.toml").write_text(STUDY)
    before = set(os.listdir())
    texts = [equipoise(*words.split()) for words in REFUSING]
    said = {re.split("bad.toml: |compute the model: ", refused(item))[-1] for item in texts}
    assert len(said) == 1, said
    (line,) = said
    assert line.startswith(("the crank cannot turn fully: it stops at", "change point at crank"))
    assert set(os.listdir()) == before
    below = {item.err.partition("\n")[2].strip() for item in texts}
    (lines_to_paste,) = {lines.partition("\n# more: equipoise explain ")[0] for lines in below}
    assert len(below) == 1
    with pytest.raises(MotionError) as caught:
        eq.analyze(eq.load("bad.toml"))
    assert str(caught.value).split("\n\n") == [line, lines_to_paste]
    for number, cure in enumerate(cures_in(lines_to_paste)):
        old = 'C = "left" ' if cure.startswith("C = ") else 'speed = "193 rpm"'
        new = cure if cure.startswith("C = ") else f"{old}\n{cure}"
        Path(f"good{number}.toml").write_text(replaced(text, (old, new)))
        assert succeeded(equipoise("check", f"good{number}.toml")).endswith(f"{READY}\n")
        succeeded(equipoise("analyze", f"good{number}.toml", "--json"))


def cures_in(lines: str) -> list[str]:
    """Each of the ways out that an error has lines for, as a line of the file."""
    return re.findall(r"motion = \{.*?\}$|\bC = .*$", lines, re.MULTILINE)


@pytest.mark.parametrize("words", ["respond", "modes", "simulate 0.1_s"])
def test_a_crank_that_cannot_turn_on_a_support(words: str) -> None:
    rig = replaced(example_text("yamashita-rig"), ('points.B = ["33.5 mm"', 'points.B = ["120 mm"'))
    Path("bad.toml").write_text(rig)
    name, *more = (word.replace("_", " ") for word in words.split())
    line = refused(equipoise(name, "bad.toml", *more))
    assert line.startswith("bad.toml: the crank cannot turn fully: it stops at")


def test_only_pictures_show_a_crank_that_cannot_turn_and_say_so() -> None:
    Path("bad.toml").write_text(STUCK["crank too long"])
    result = equipoise("plot", "bad.toml", "--only", "linkage", "-o", "pictures")
    assert result.status == 0
    assert "note: the crank cannot turn fully: it stops at" in result.err
    assert "which is not in the file: motion = { between = [" in result.err
    assert ", swinging as its crank" in Path("pictures/linkage.svg").read_text()


# Bases that do not turn: `test_base_need_not_turn` of tests/unit/codegen.
@pytest.mark.exhaustive
def test_a_study_of_designs_that_turn_may_begin_with_one_that_does_not() -> None:
    Path("bad.toml").write_text(STUCK["crank too long"])
    vary = '{ path = "links.crank.points.B[1]", range = ["30 mm", "120 mm"], steps = 4 }'
    Path("lengths.toml").write_text(re.sub(r"vary = \[.*\]", f"vary = [{vary}]", STUDY))
    Path("x").mkdir()
    printed = succeeded(equipoise("sweep", "lengths.toml", "-o", "x/designs.zarr"))
    assert re.search(r"does not turn fully", printed)


def test_missing_sides_can_be_pasted() -> None:
    """All at once, with the one that lets the crank turn fully; a pasted file is ready."""
    text = example_text("watt-six-bar")
    sides = text[text.index("[assembly]") :].partition("\n\n")[0]
    Path("bad.toml").write_text(replaced(text, (sides, "")))
    result = equipoise("check", "bad.toml")
    assert "assembly: C is missing, F is missing; give each" in refused(result)
    assert '\nC = "left"  # at (135.0, 88.74) mm at crank angle 0 deg; the crank' in result.err
    _, _, lines = result.err.partition("\n")
    Path("good.toml").write_text(replaced(text, (sides, lines)))
    assert succeeded(equipoise("check", "good.toml")).endswith(f"{READY}\n")


def test_byte_order_mark_and_windows_lines_are_fine() -> None:
    text = "\ufeff" + example_text(FOUR_BAR).replace("\n", "\r\n")
    Path("good.toml").write_bytes(text.encode())
    assert succeeded(equipoise("check", "good.toml")).endswith(f"{READY}\n")


def test_every_angle_reports_that_a_rocking_crank_does_not_reach() -> None:
    changed(FOUR_BAR, ('points.B = ["33.5 mm", "0 mm"]', 'points.B = ["120 mm", "0 mm"]'))
    line = refuses("analyze model.toml --angles '180 deg'", "180 deg")
    assert line.startswith("model.toml: the crank cannot turn fully")


# -- files that are none ---------------------------------------------------------------------------


def test_missing_files_and_misspelt_examples() -> None:
    refuses("check no/such.toml", "no/such.toml: there is no such")
    for name in ("yamashta-1", "yamashita-1.toml", "Yamashita-1"):
        refuses(f"analyze {name}", f"{name}: there is no such file; did you mean 'yamashita-1'")
    refuses("analyze qqqq", "equipoise examples")


@pytest.mark.parametrize("name", ["", " ", "a\nb", "\x1b[31m", "x" * 5000, "\udcff", "a\0b", "~"])
def test_odd_file_names(name: str) -> None:
    for words in (("check",), ("analyze", "--json")):
        refused(equipoise(*words, name))


def test_folder_and_pipe() -> None:
    refuses("check .", "directory")
    os.mkfifo("pipe.toml")
    with within(2):
        refuses("check pipe.toml", "no regular file")


def test_sparse_file_of_100_megabytes() -> None:
    with Path("huge.toml").open("wb") as file:
        file.truncate(100_000_000)
    with within(2):
        refuses("check huge.toml", "at most 2 MB")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_unreadable_file() -> None:
    Path("secret.toml").touch(mode=0)
    refuses("check secret.toml", "may not be read")


# -- arguments -------------------------------------------------------------------------------------


def test_unknown_point_for_moments_of_a_model_without_masses() -> None:
    Path("massless.toml").write_text(massless())
    refuses("analyze massless.toml --about Q", "called 'Q'")


def test_csv_does_not_take_the_place_of_a_pipe_or_device() -> None:
    # A FIFO stands for every special file: /dev/null itself would be lost if this failed as root.
    os.mkfifo("pipe")
    for words in (("analyze", FOUR_BAR, "--csv", "pipe"), ("new", "pipe")):
        refused(equipoise(*words))
        assert Path("pipe").is_fifo()


@pytest.mark.parametrize(
    "words",
    [
        ("plot", FOUR_BAR, "-o", "p.png"),
        ("plot", FOUR_BAR, "--out", "deep/p.SVG"),
        ("balance", FOUR_BAR, "--phases", "--objective", "drive_torque", "--plot", "p.pdf/"),
        ("plot", "map", FOUR_BAR, "links.crank.mass = 1 kg : 2 kg", "drive.speed = 60 rpm : 90 rpm",
         "rms shaking_force.y", "-o", "map.gif"),
        ("site", "-o", "site.html"),
    ],
)  # fmt: skip
def test_a_folder_is_not_called_as_a_file(words: tuple[str, ...], folder: Path) -> None:
    sentence = refused(equipoise(*words))
    assert f"got {words[-1]!r}, the name of a file; give a folder, into which all" in sentence
    assert list(folder.iterdir()) == []


def test_a_folder_that_is_there_may_be_called_as_a_file(folder: Path) -> None:
    folder.joinpath("p.png").mkdir()
    assert equipoise("plot", FOUR_BAR, "--only", "linkage", "-o", "p.png").status == 0
    assert [path.name for path in folder.joinpath("p.png").iterdir()] == ["linkage.svg"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_unwritable_folder(folder: Path) -> None:
    folder.chmod(0o555)
    assert "permission denied" in refused(equipoise("new"))
    assert list(folder.iterdir()) == []


def test_a_failure_keeps_the_old_csv(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    Path("old.csv").write_text("old")
    monkeypatch.setattr(os, "fsync", full)
    line = refused(equipoise("analyze", FOUR_BAR, "--csv", "old.csv"))
    assert line.startswith("old.csv: the file cannot be written (no space left on device)")
    assert Path("old.csv").read_text() == "old"
    assert [path.name for path in folder.iterdir()] == ["old.csv"]


# -- interruption ----------------------------------------------------------------------------------

WAITING = """
import sys, time
import {module}

def wait(*_):
    print("ready", flush=True)
    time.sleep(60)

{module}.{function} = wait
from equipoise.cli import main
main()
"""


@pytest.mark.exhaustive(but=["os-fsync"])
@pytest.mark.parametrize(
    ("module", "function"), [("equipoise.results.analysis", "analyze"), ("os", "fsync")]
)
def test_interruption_leaves_nothing_half_written(module: str, function: str, folder: Path) -> None:
    program = WAITING.format(module=module, function=function)
    words = [sys.executable, "-c", program, "analyze", FOUR_BAR, "--csv", "x.csv"]
    result = interrupted(words, "ready\n")
    assert (result.status, result.out, result.err) == (130, "", "equipoise: interrupted\n")
    assert list(folder.iterdir()) == []


COMPUTING = """
import {module}

real = {module}.{function}

def compute(*given, **options):
    print("ready", flush=True)
    while True:  # on a fast machine, too
        real(*given, **options)

{module}.{function} = compute
from equipoise.cli import main
main()
"""


@pytest.mark.parametrize(
    ("function", "words"),
    [
        pytest.param(
            "equipoise.results.analysis.analyze",
            ("analyze", "watt-six-bar", "--angles", "400000", "--csv", "x.csv"),
            marks=EXHAUSTIVE,
        ),
        (
            "equipoise.balancing.optimisation.balance",
            ("balance", "balance-crank", "-o", "new.toml", "--csv", "x.csv", "--plot", "pictures"),
        ),
    ],
)
def test_interruption_of_what_computes(function: str, words: tuple[str, ...], folder: Path) -> None:
    module, _, name = function.rpartition(".")
    program = COMPUTING.format(module=module, function=name)
    result = interrupted([sys.executable, "-c", program, *words], "ready\n")
    assert (result.status, result.out) == (130, "")
    assert result.err.splitlines()[-1] == "equipoise: interrupted"
    assert list(folder.iterdir()) == []


# -- files in each other's place -------------------------------------------------------------------

SOIL, CURVE = "depth [mm],resistance [N]\n0,1\n40,9\n", "speed [rpm],torque [N m]\n0,1.2\n1500,0\n"
IN_SOIL = ("kim-chung-a", 'depth = "4 cm"', 'depth = "4 cm"\nsoil.table = "table.csv"')
PULLED = ("yamashita-rig", 'no_load_speed = "1500 rpm"\nstall_torque = "1.2 N m"',
          'table = "table.csv"')  # fmt: skip


@pytest.mark.parametrize("name", ["model.toml", "./model.toml", "table.csv"])
@pytest.mark.parametrize(
    ("command", "model", "table"),
    [("analyze", IN_SOIL, SOIL), ("plant", IN_SOIL, SOIL), ("respond", PULLED, CURVE)],
)
def test_results_do_not_take_the_place_of_what_they_come_from(
    command: str, model: tuple[str, str, str], table: str, name: str
) -> None:
    """Neither of the model nor of the tables that it names."""
    Path("table.csv").write_text(table)
    changed(model[0], model[1:])
    succeeded(equipoise(command, "model.toml", "--json"))
    before = Path(name).read_text(encoding="utf-8")
    line = refuses(f"{command} model.toml --csv {name}", "give another name")
    assert line == f"--csv: {name} is what is to be analysed; give another name"
    assert Path(name).read_text(encoding="utf-8") == before


# -- speed of failure ------------------------------------------------------------------------------


def four_bars_in_a_row(count: int) -> str:
    """Return a sound linkage of so many four-bars, each driven by the rocker before."""
    lines = ['schema = 1\ntitle = "row"\ndrive = { link = "crank", speed = "10 rpm" }',
             '[frame]\npoints.A = ["0 mm", "0 mm"]']  # fmt: skip
    lines += [f'points.G{k} = ["{100 * (k + 1)} mm", "0 mm"]' for k in range(count)]
    lines += ['[links.crank]\npoints.A = ["0 mm", "0 mm"]\npoints.B0 = ["10 mm", "0 mm"]']
    for k in range(count):
        lines += [f'[links.c{k}]\npoints.B{k} = ["0 mm", "0 mm"]\npoints.C{k} = ["100 mm", "0 mm"]',
                  f'[links.r{k}]\npoints.G{k} = ["0 mm", "0 mm"]\npoints.C{k} = ["60 mm", "0 mm"]',
                  f'points.B{k + 1} = ["0 mm", "50 mm"]']  # fmt: skip
    return "\n".join([*lines, "[assembly]", *(f'C{k} = "left"' for k in range(count))])


def start() -> str:
    return (
        'schema = 1\ntitle = "t"\ndrive = { link = "crank", speed = "10 rpm" }\n'
        '[frame]\npoints.A = ["0 mm", "0 mm"]\n[links.crank]\npoints.A = ["0 mm", "0 mm"]\n'
        'points.B0 = ["0 mm", "0 mm"]\n'
    )


def chain(count: int) -> str:
    """Return a chain that hangs loose."""
    link = '[links.c{0}]\npoints.B{0} = ["0 mm", "0 mm"]\npoints.B{1} = ["9 mm", "0 mm"]\n'
    return start() + "".join(link.format(k, k + 1) for k in range(count))


def star(count: int) -> str:
    """Return links that all turn about one pin."""
    return start() + "".join(f'[links.c{k}]\npoints.A = ["0 mm", "0 mm"]\n' for k in range(count))


def many(line: str, size: int = 1_800_000) -> str:
    """Return a line over and over, numbered, up to a size."""
    return "\n".join(line.format(k) for k in range(size // (len(line) + 6)))


GEAR = '[[gears]] # {}\nbetween = ["crank", "rocker"]\nratio = -2'

HUGE = {
    "2000 links in four-bars": lambda: four_bars_in_a_row(1000),
    "100 links in four-bars": lambda: four_bars_in_a_row(49),
    "100 links in a chain": lambda: chain(98),
    "100 links about a pin": lambda: star(98),
    "2000 links in a chain": lambda: chain(2000),
    "2000 links about a pin": lambda: star(2000),
    "20 000 links": lambda: start() + many('[links.w{0}]\npoints.Q{0} = ["0 m", "0 m"]'),
    "2 MB of points": lambda: start() + many('points.Q{} = ["0 mm", "0 mm"]'),
    "2 MB of comments": lambda: example_text(FOUR_BAR) + many("# {} no comment"),
    "2 MB of description": lambda: four_bar('tion.en = """', 'tion.en = """' + "x" * 1_900_000),
    "2 MB of joints": lambda: four_bar("[assembly]", "[assembly]\n" + many('j{} = "left"')),
    "2 MB of loads": lambda: example_text(FOUR_BAR) + many(LOAD + 'torque = "{} N m"'),
    "2 MB of gears": lambda: example_text(FOUR_BAR) + many(GEAR),
    "1 MB of a name": lambda: example_text(FOUR_BAR).replace("coupler", "x" * 900_000),
    "1 MB of an unknown name": lambda: four_bar('link = "crank"', f'link = "{"x" * 1_000_000}"'),
    "1 MB of an unknown key": lambda: four_bar("[drive]", f"[drive]\n{'x' * 1_000_000} = 1"),
    "1 MB of a number": lambda: four_bar("33.5 mm", "1" * 1_000_000 + " mm"),
    "1 MB of spaces": lambda: four_bar("33.5 mm", "1" + " " * 1_000_000 + "x"),
    "a list of 200 000": lambda: four_bar('["33.5 mm",', "[" + '"1 mm",' * 200_000),
}  # fmt: skip
LONG = {"20 000 links", "2000 links in four-bars", "a list of 200 000"} | {
    f"2 MB of {part}" for part in ("joints", "points", "loads", "gears")
}
LONG |= {"2 MB of description", "1 MB of spaces", "1 MB of an unknown key", "100 links about a pin"}
"""Read by the same loops as others, most for seconds."""


@pytest.mark.exhaustive(but=["1 MB of a name", "100 links in a chain", "2000 links about a pin"])
@pytest.mark.parametrize("huge", few(HUGE, {*HUGE} - LONG))
def test_huge_files_are_answered_soon(huge: str) -> None:
    """Files that no engineer would write."""
    text = HUGE[huge]()
    assert len(text) < 2_000_000
    Path("huge.toml").write_text(text)
    with within(15):  # twice what the slowest takes
        result = equipoise("check", "huge.toml")
    assert result.status in (0, 2)
    if result.status:
        assert len(refused(result)) < 3000
