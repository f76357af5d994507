"""Bad model files and arguments: exit status 2 and one sentence that tells what would be right."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from surface.running import (
    READY,
    command,
    equipoise,
    example_text,
    process,
    refused,
    succeeded,
)

FOUR_BAR = "yamashita-1"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Every test runs in an empty folder of its own."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def changed(old: str, new: str, name: str = FOUR_BAR) -> str:
    """Return the text of an example with one piece of text replaced."""
    text = example_text(name)
    assert old in text, f"{old!r} is not in {name}"
    return text.replace(old, new, 1)


def complaint(text: str | bytes, *words: str) -> str:
    """Return what `check` and `analyze` say of a model file; they have to agree."""
    data = text.encode() if isinstance(text, str) else text
    Path("bad.toml").write_bytes(data)
    line = refused(equipoise("check", "bad.toml"))
    assert refused(equipoise("analyze", "bad.toml", "--json")) == line
    assert line.startswith("bad.toml: ")
    return line.removeprefix("bad.toml: ")


# -- values of a model file ------------------------------------------------------------------------

CRANK = "links.crank"
VALUES = {
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
    "unknown side": ('C = "left"', 'C = "leftt"', "assembly.C", "give 'left', 'right'"),
    "unknown joint": ('C = "left"', 'C = "left"\nQ = "left"', "assembly.Q", "meet at C"),
    "missing assembly": ('[assembly]\nC = "left"', "", "assembly.C", '"left" or "right"'),
    "text for a table": ("[assembly]", 'assembly = "left"\n[links.more]', "", ""),
    "schema of another version": ("schema = 1", "schema = 2", "schema", "reads schema = 1"),
    "schema as text": ("schema = 1", 'schema = "1"', "schema", "reads schema = 1"),
    "no schema": ("schema = 1\n", "", "schema", "begin the file with schema = 1"),
    "title as a number": ('title = "Planting', 'title = 7\ndescription = "', "", ""),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "place", "said"), VALUES.values(), ids=VALUES)
def test_bad_values(old: str, new: str, place: str, said: str) -> None:
    line = complaint(changed(old, new))
    assert line.startswith(f"{place}: " if place else "")
    assert said in line


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
    "ratio of 0": ("geared-counterweight", "ratio = -0.47", "ratio = 0", "gears[1]", "rigid"),
    "ratio with a unit": ("geared-counterweight", "ratio = -0.47", 'ratio = "-0.47"',
                          "gears[1].ratio", "plain number"),
    "ratio that is not a number": ("geared-counterweight", "ratio = -0.47", "ratio = nan",
                                   "gears[1].ratio", "finite"),
    "half a tooth": ("planetary-planting-arm", "teeth = [40, 40]", "teeth = [40, 0.5]",
                     "gears[1].teeth[2]", "whole number"),
    "negative teeth": ("planetary-planting-arm", "teeth = [40, 40]", "teeth = [40, -40]",
                       "gears[1].teeth[2]", "1 or more"),
    "gear on itself": ("geared-counterweight", '"rocker", "counterweight"', '"rocker", "rocker"',
                       "gears[1]", "three different bodies"),
    "spring on an unknown link": ("spring-balanced-crank", '"rocker"\npoint', '"roker"\npoint',
                                  "springs[1].link", "did you mean 'rocker'?"),
    "spring to a moving point": ("spring-balanced-crank", 'to = "S"', 'to = "B"', "springs[1].to",
                                 "no point of the frame is called 'B'"),
    "spring at a pivot": ("spring-balanced-crank", 'point = "F"', 'point = "D"',
                          "springs[1].point", "give a point that moves"),
    "spring without stiffness": ("spring-balanced-crank", 'stiffness = "3.3 N/mm"\n', "",
                                 "springs[1].stiffness", 'add stiffness = "2 kN/m"'),
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


@pytest.mark.parametrize(("name", "old", "new", "place", "said"), ELSEWHERE.values(), ids=ELSEWHERE)
def test_bad_values_elsewhere(name: str, old: str, new: str, place: str, said: str) -> None:
    line = complaint(changed(old, new, name))
    assert line.startswith(f"{place}: ")
    assert said in line


LOAD = '\n[[loads]]\nlink = "coupler"\n'
LOADS = {
    "nothing": ("", "loads[1]", "exactly one of force, torque and table"),
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


@pytest.mark.parametrize(("text", "place", "said"), LOADS.values(), ids=LOADS)
def test_bad_loads(text: str, place: str, said: str) -> None:
    Path("bad.csv").write_text("angle,force\n0,1\n")
    Path("row.csv").write_text("crank_angle [deg],torque [N m]\n0,1\n10,1,2\n")
    Path("nan.csv").write_text("crank_angle [deg],torque [N m]\n0,nan\n")
    line = complaint(f"{example_text(FOUR_BAR)}{LOAD}{text}\n")
    assert line.startswith(f"{place}: ")
    assert said in line


SUPPORT = """
[support]
mass = "60 kg"
center_of_mass = ["0 mm", "300 mm"]
inertia = "4 kg m^2"
"""
MOUNT = '[support.mounts.front]\npoint = ["0 mm", "0 mm"]\n'
MOTOR = "[drive.motor]\n"
SUPPORTS = {
    "freedom": (f'{SUPPORT}freedoms = ["pich"]', "support.freedoms[1]", "got 'pich'; give 'surge'"),
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
    "bad table": (f'{MOTOR}table = "bad.csv"', "drive.motor.table", "bad.csv, line 1, column"),
    "falling speeds": (f'{MOTOR}table = "row.csv"', "drive.motor.table", "row.csv, line 3, column"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "place", "said"), SUPPORTS.values(), ids=SUPPORTS)
def test_bad_supports(text: str, place: str, said: str) -> None:
    Path("bad.csv").write_text("speed,torque\n0,1\n")
    Path("row.csv").write_text("speed [rpm],torque [N m]\n10,1\n0,2\n")
    line = complaint(f"{example_text(FOUR_BAR)}\n{text}\n")
    assert line.startswith(f"{place}: ")
    assert said in line


# -- the text of a model file ----------------------------------------------------------------------

TEXTS = {
    "duplicate key": (
        "schema = 1\nschema = 1\n",
        "line 2, column 11: cannot overwrite a value, a key or",
    ),
    "duplicate link": (
        example_text(FOUR_BAR) + "\n[links.crank]\n",
        "a key or table is given twice",
    ),
    "no quotes": ("schema = 1\n[drive]\nspeed = 193 rpm", "line 3, column 13: expected newline"),
    "empty": ("", "begin the file with schema = 1"),
    "prose": ("Dear Sir or Madam", "line 1"),
    "JSON": ('{"schema": 1}', "line 1"),
    "XML": ("<schema>1</schema>", "line 1"),
    "binary": (b"\x7fELF\x02\x01\x01\x00\xff\xfe" * 40, "UTF-8"),
    "zeros": (bytes(5000), "line 1"),
    "UTF-16": (example_text(FOUR_BAR).encode("utf-16"), "UTF-8"),
    "Latin-1": (changed("Planting", "Überträger").encode("latin-1"), "line 3 is not text in UTF-8"),
    "deep": (f"x = {'[' * 5000}{']' * 5000}", "nested too deeply"),
    "dotted": (f"{'a.' * 50_000}b = 1", "more than 50 parts"),
    "long number": (f"schema = {'1' * 5000}", "number"),
}


@pytest.mark.parametrize(("text", "said"), TEXTS.values(), ids=TEXTS)
def test_bad_texts(text: str | bytes, said: str) -> None:
    assert said in complaint(text)


def test_byte_order_mark_and_windows_lines_are_fine() -> None:
    text = "\ufeff" + example_text(FOUR_BAR).replace("\n", "\r\n")
    Path("good.toml").write_bytes(text.encode())
    assert succeeded(equipoise("check", "good.toml")).endswith(f"{READY}\n")


# -- linkages that cannot move ---------------------------------------------------------------------

LINKAGES = {
    "crank too long": (
        changed('points.B = ["33.5 mm", "0 mm"]', 'points.B = ["120 mm", "0 mm"]'),
        "the crank cannot turn fully: 'coupler' and 'rocker' reach each other only from",
    ),
    "never joined": (
        changed('distance = "88 mm"', 'distance = "880 mm"'),
        "cannot be joined at any crank angle",
    ),
    "change point": (
        changed('distance = "88 mm"', 'distance = "118 mm"'),  # 118 + 33.5 = 71.5 + 80
        "change point at crank angle",
    ),
    "parallelogram": (
        changed('distance = "88 mm"', 'distance = "71.5 mm"').replace('"80 mm"', '"33.5 mm"'),
        "change point at crank angle",
    ),
    "link of no length": (
        changed('points.C = ["71.5 mm", "0 mm"]', 'points.C = ["0 mm", "0 mm"]'),
        "links.coupler.points: B and C lie at the same place",
    ),
    "crank of no length": (
        changed('points.B = ["33.5 mm", "0 mm"]', 'points.B = ["0 mm", "0 mm"]'),
        "links.crank.points: A and B lie at the same place",
    ),
    "no free motion": (
        changed('points.P = ["-160 mm"', 'points.A = ["-160 mm"'),
        "no free motion",
    ),
    "two free motions": (
        changed("[assembly]", '[links.more]\npoints.P = ["0 mm", "0 mm"]\n[assembly]'),
        "2 free motions",
    ),
    "drive link off the frame": (
        changed('link = "crank"', 'link = "coupler"'),
        "drive.link: 'coupler' shares 0 points with the frame",
    ),
}


@pytest.mark.parametrize(("text", "said"), LINKAGES.values(), ids=LINKAGES)
def test_linkages_that_cannot_move(text: str, said: str) -> None:
    assert said in complaint(text)


def test_every_angle_is_told_that_a_rocking_crank_does_not_reach() -> None:
    text = changed('points.B = ["33.5 mm", "0 mm"]', 'points.B = ["120 mm", "0 mm"]')
    Path("model.toml").write_text(text)
    line = refused(equipoise("analyze", "model.toml", "--angles", "180 deg"))
    assert line.startswith("model.toml: the crank cannot turn fully")
    assert "180 deg" in line


# -- files that are none ---------------------------------------------------------------------------


def test_missing_file() -> None:
    assert refused(equipoise("check", "no/such.toml")).startswith("no/such.toml: there is no such")


def test_misspelt_example() -> None:
    for name in ("yamashta-1", "yamashita-1.toml", "Yamashita-1"):
        line = refused(equipoise("analyze", name))
        assert line.startswith(f"{name}: there is no such file; did you mean 'yamashita-1'")
    assert "equipoise examples" in refused(equipoise("analyze", "qqqq"))


@pytest.mark.parametrize("name", ["", " ", "a\nb", "\x1b[31m", "x" * 5000, "\udcff", "a\0b", "~"])
def test_odd_file_names(name: str) -> None:
    for words in (("check",), ("analyze", "--json")):
        refused(equipoise(*words, name))


def test_folder() -> None:
    assert "directory" in refused(equipoise("check", "."))


def test_pipe() -> None:
    os.mkfifo("pipe.toml")
    begin = time.monotonic()
    assert "no regular file" in refused(equipoise("check", "pipe.toml"))
    assert time.monotonic() - begin < 2


def test_sparse_file_of_100_megabytes() -> None:
    with Path("huge.toml").open("wb") as file:
        file.truncate(100_000_000)
    begin = time.monotonic()
    assert "at most 2 MB" in refused(process("check", "huge.toml"))
    assert time.monotonic() - begin < 2


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_unreadable_file() -> None:
    Path("secret.toml").touch(mode=0)
    assert "may not be read" in refused(equipoise("check", "secret.toml"))


# -- arguments -------------------------------------------------------------------------------------

ARGUMENTS = {
    "no angle": (["--angles", "0"], "give at least 1"),
    "fewer than no angles": (["--angles", "-3"], "give at least 1"),
    "angles as a word": (["--angles", "abc"], '--angles: got \'abc\''),
    "angles as a power": (["--angles", "1e9"], "--angles: got '1e9'; the unit is missing"),
    "too many angles": (["--angles", "1000000000"], "give at most 400000"),
    "far too many angles": (["--angles", "9" * 5000], "--angles: got '999"),
    "angles with a bar": (["--angles", "1_000"], "--angles: got '1_000'"),
    "angles in other digits": (["--angles", "٣"], "--angles: got '٣'"),
    "angle that is none": (["--angles", "nan deg"], "--angles: got 'nan deg'; give a finite"),
    "angles with a gap": (["--angles", "0 deg,,1 deg"], "--angles: got ''"),
    "speed without unit": (["--speed", "5"], "--speed: got '5'; the unit is missing"),
    "speed in metres": (["--speed", "5 m"], "--speed: got '5 m'; m is the unit of a length"),
    "speed in hertz": (["--speed", "50 Hz"], '--speed: got \'50 Hz\'; Hz does not tell'),
    "speed that is none": (["--speed", "nan rpm"], "--speed: got 'nan rpm'; give a finite number"),
    "speed with a comma": (["--speed", "250,5 rpm"], '"250.5 rpm"'),
    "no speed": (["--speed"], "--speed requires an argument"),
    "speed twice": (["--speed", "1 rpm", "--speed", "2 rpm"], "--speed specified multiple times"),
    "acceleration in rpm": (["--acceleration", "5 rpm"], "--acceleration: got '5 rpm'; rpm is the"),
    "unknown point": (["--about", "Q"], "no point of the frame is called 'Q'; there are 'A', 'D'"),
    "moving point": (["--about", "B"], "no point of the frame is called 'B'"),
    "half a place": (["--about", "1 mm,"], "--about: got ''"),
    "place in space": (["--about", "1 mm, 2 mm, 3 mm"], '"10 mm, 20 mm"'),
    "place without units": (["--about", "1, 2"], "--about: got '1'; the unit is missing"),
    "unknown option": (["--spead", "5 rpm"], "Unknown option: --spead. Did you mean --speed?"),
    "option with colours": (["--\x1b[31m"], "Unknown option: --\\x1b[31m"),
    "one more": (["kim-chung-a"], "kim-chung-a"),
    "json with a word": (["--json=perhaps"], "--json"),
    "csv into a missing folder": (["--csv", "no/x.csv"], "no/x.csv: there is no such folder"),
    "csv onto a folder": (["--csv", "."], ". is a directory; give the name of a file"),
    "csv below a file": (["--csv", "file/x.csv"], "there is no such folder"),
    "csv without a name": (["--csv", ""], "got an empty name"),
    "csv with a name too long": (["--csv", "x" * 300], "name too long"),
}  # fmt: skip


@pytest.mark.parametrize(("words", "said"), ARGUMENTS.values(), ids=ARGUMENTS)
def test_bad_arguments(folder: Path, words: list[str], said: str) -> None:
    Path("file").touch()
    assert said in refused(equipoise("analyze", FOUR_BAR, *words))
    assert [path.name for path in folder.iterdir()] == ["file"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["analyse", FOUR_BAR], 'Unknown command "analyse". Did you mean "analyze"?'),
        (["qqq"], "Available commands: analyze, animate, balance, best, check, decay"),
        (["--qqq"], "--qqq"),
        (["analyze"], "FILE requires an argument"),
        (["check"], "FILE requires an argument"),
        (["sweep"], "STUDY requires an argument"),
        (["best"], "STORE requires an argument"),
        (["check", FOUR_BAR, "--json=1"], "--json"),
        (["examples", "more"], "more"),
        (["schema", "more"], "more"),
        (["new", "a.toml", "b.toml"], "b.toml"),
        (["analyze", "--FILE", FOUR_BAR], "--FILE"),
    ],
)
def test_bad_commands(words: list[str], said: str) -> None:
    assert said in refused(equipoise(*words))


def test_unknown_point_for_moments_of_a_model_without_masses() -> None:
    lines = example_text(FOUR_BAR).splitlines()
    kept = [line for line in lines if not line.startswith(("mass", "center_of_mass", "inertia"))]
    Path("massless.toml").write_text("\n".join(kept))
    assert "called 'Q'" in refused(equipoise("analyze", "massless.toml", "--about", "Q"))


@pytest.mark.parametrize("words", [["--angles", "1e29 deg"], ["--speed", "1e29 rad/s"]])
def test_extreme_arguments_are_refused_or_answered_with_numbers(words: list[str]) -> None:
    result = equipoise("analyze", FOUR_BAR, *words, "--json")
    if result.status:
        refused(result)
    else:
        assert "NaN" not in result.out
        assert "Infinity" not in result.out


def test_a_process_says_the_same() -> None:
    for words in ((), ("--angles", "0"), ("--speed", "5"), ("--spead", "5")):
        name = FOUR_BAR if words else "nothing.toml"
        assert refused(process("analyze", name, *words)) == refused(
            equipoise("analyze", name, *words)
        )


def test_csv_does_not_take_the_place_of_a_pipe_or_device() -> None:
    # A FIFO stands for every special file: /dev/null itself would be lost if this failed as root.
    os.mkfifo("pipe")
    for words in (("analyze", FOUR_BAR, "--csv", "pipe"), ("new", "pipe")):
        refused(equipoise(*words))
        assert Path("pipe").is_fifo()


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


@pytest.mark.parametrize(
    ("module", "function"), [("equipoise.results.analysis", "analyze"), ("os", "fsync")]
)
def test_interruption_leaves_nothing_half_written(module: str, function: str, folder: Path) -> None:
    program = WAITING.format(module=module, function=function)
    words = [sys.executable, "-c", program, "analyze", FOUR_BAR, "--csv", "x.csv"]
    pipe = subprocess.PIPE
    with subprocess.Popen(
        words,
        stdout=pipe,
        stderr=pipe,
        encoding="utf-8",
        preexec_fn=heed_interrupts,  # noqa: PLW1509
    ) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == "ready\n"
        child.send_signal(signal.SIGINT)
        out, err = child.communicate(timeout=30)
    assert (child.returncode, out, err) == (130, "", "equipoise: interrupted\n")
    assert list(folder.iterdir()) == []


def heed_interrupts() -> None:
    """A shell that runs the tests in the background makes them and their children ignore it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def test_interruption_of_a_long_analysis(folder: Path) -> None:
    words = command("analyze", "watt-six-bar", "--angles", "400000", "--csv", "x.csv")
    pipe = subprocess.PIPE
    with subprocess.Popen(
        words,
        stdout=pipe,
        stderr=pipe,
        encoding="utf-8",
        preexec_fn=heed_interrupts,  # noqa: PLW1509
    ) as child:
        time.sleep(2.5)  # well past the start, far from the end
        assert child.poll() is None
        child.send_signal(signal.SIGINT)
        out, err = child.communicate(timeout=30)
    assert (child.returncode, out, err) == (130, "", "equipoise: interrupted\n")
    assert list(folder.iterdir()) == []


def test_results_do_not_take_the_place_of_the_model(tmp_path: Path) -> None:
    model = tmp_path / "model.toml"
    model.write_text(example_text(FOUR_BAR), encoding="utf-8")
    assert "is what is to be analysed" in refused(equipoise("analyze", model, "--csv", model))
    assert model.read_text(encoding="utf-8") == example_text(FOUR_BAR)


def test_split_belongs_to_json() -> None:
    assert "--split belongs to --json" in refused(equipoise("analyze", FOUR_BAR, "--split"))


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
    "2 MB of description": lambda: changed('tion = """', 'tion = """' + "x" * 1_900_000),
    "2 MB of joints": lambda: changed("[assembly]", "[assembly]\n" + many('j{} = "left"')),
    "2 MB of loads": lambda: example_text(FOUR_BAR) + many(LOAD + 'torque = "{} N m"'),
    "2 MB of gears": lambda: example_text(FOUR_BAR) + many(GEAR),
    "1 MB of a name": lambda: example_text(FOUR_BAR).replace("coupler", "x" * 900_000),
    "1 MB of an unknown name": lambda: changed('link = "crank"', f'link = "{"x" * 1_000_000}"'),
    "1 MB of an unknown key": lambda: changed("[drive]", f"[drive]\n{'x' * 1_000_000} = 1"),
    "1 MB of a number": lambda: changed("33.5 mm", "1" * 1_000_000 + " mm"),
    "1 MB of spaces": lambda: changed("33.5 mm", "1" + " " * 1_000_000 + "x"),
    "a list of 200 000": lambda: changed('["33.5 mm",', "[" + '"1 mm",' * 200_000),
}  # fmt: skip


@pytest.fixture(params=HUGE)
def huge(request: pytest.FixtureRequest) -> Iterator[str]:
    """A file that no engineer would write, and its name."""
    text = HUGE[request.param]()
    assert len(text) < 2_000_000
    Path("huge.toml").write_text(text)
    return request.param  # type: ignore[no-any-return]


def test_huge_files_are_answered_soon(huge: str) -> None:
    begin = time.monotonic()
    result = process("check", "huge.toml", timeout=8)
    assert result.status in (0, 2)
    if result.status:
        assert len(refused(result)) < 3000
    assert time.monotonic() - begin < 8
