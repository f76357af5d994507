"""`equipoise tool` as a user runs it."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from support.chosen import few
from surface.running import (
    TOOLS,
    changed,
    equipoise,
    example_text,
    read,
    refuses,
    succeeded,
    written,
)

RPM = np.pi / 30


def as_json(*words: str) -> dict[str, Any]:
    return read("tool", *words)


# -- what is told ----------------------------------------------------------------------------------


def test_the_paper_as_json() -> None:
    """Keys and figures of Nagamine and Irie's machine."""
    result = as_json("nagamine-irie")
    assert result["title"] == "Brush cutter of Nagamine and Irie"
    lambdas = (1.238, 2.413, 4.418, 6.290, 9.400)
    assert result["eigenvalues"][:5] == pytest.approx(lambdas, abs=5e-4)
    cycles = (127, 481, 1613, 3268, 7300)
    assert [60 * item for item in result["natural_frequencies"][:5]] == pytest.approx(
        cycles, abs=0.5
    )
    speeds = result["speed"]
    assert speeds == sorted(speeds)
    for station in ("handle", "harness"):
        part = result["transmission"][station]
        assert len(part["ratio"]) == len(part["phase"]) == len(speeds)
    quiet = np.array(result["transmission"]["handle"]["quiet_speeds"]) / RPM
    assert np.min(np.abs(quiet - 6134)) < 1
    assert len(result["a_hv"]) == len(speeds)
    assert result["a8"] is None


# The JSON of the paper's tool is read on every change.
@pytest.mark.exhaustive
def test_json_is_what_python_has() -> None:
    tool = eq.schema.load_tool("brush-cutter")
    result = as_json("brush-cutter", "--respond", "6000 : 9000 rpm", "--exposure")
    speeds = np.array(result["speed"])
    exposure = eq.handheld.expose_tool(tool, speeds)
    assert result["a_hv"] == pytest.approx(exposure.a_hv.tolist())
    assert result["a8"] == pytest.approx(exposure.a8)
    swept = eq.handheld.sweep_tool(tool, speeds)
    handle = result["stations"]["front-handle"]
    forces = swept.force("front-handle")["hand"]
    assert handle["forces"]["hand"] == pytest.approx(forces.tolist())
    assert result["equivalents"].keys() == {"rear-grip", "front-handle"}


@pytest.mark.exhaustive(but=["nagamine-irie"])
@pytest.mark.parametrize("name", few(TOOLS, {*TOOLS} - {"brush-cutter"}))
def test_every_bundled_tool_is_reported(name: str) -> None:
    shown = succeeded(equipoise("tool", "--full", name))
    for words in ("Natural frequencies", "Force at", "Largest forces", "a_hv"):
        assert words in shown
    assert not re.search(r"\b(nan|inf)\b", shown)


def test_two_planes_are_distinguished() -> None:
    shown = succeeded(equipoise("tool", "brush-cutter", "--modes", "--number", "3"))
    assert "without damping, vertical plane" in shown
    assert "with damping, lateral plane" in shown
    assert shown.count("damping ratio") == 2


def test_other_places_and_units() -> None:
    words = ("tool", "nagamine-irie", "--respond", "6000 rpm:8000 rpm", "--speeds", "20")
    shown = succeeded(equipoise(*words, "--at", "300 mm, 1.2 m", "--units", "um, rad/s"))
    header = re.search(r"^ +um +rad/s +um.*$", shown, re.MULTILINE)
    assert header
    places = re.findall(r"^ +(300000|1\.200e\+06) ", shown, re.MULTILINE)
    assert places == ["300000", "1.200e+06"]
    result = as_json(*words[1:], "--at", "300 mm")
    assert result["further"][0]["position"] == 0.3
    assert len(result["further"][0]["moment"]) == len(result["speed"])


def test_unrestrained_shaft_names_its_rigid_modes() -> None:
    text = 'schema = 1\ntitle = "Rod"\n[shaft]\nlength = "1 m"\nmass = "1 kg"\n'
    file = written(text + 'bending_stiffness = "1 N m^2"\n')
    shown = succeeded(equipoise("tool", "--full", file, "--number", "5"))
    assert "rigid: moves to and fro" in shown
    assert "rigid: turns about its left end" in shown
    assert as_json(file, "--number", "5")["eigenvalues"] == pytest.approx(
        [0, 0, 4.730040745, 7.853204624, 10.99560784], abs=1e-8
    )
    text = example_text("nagamine-irie").replace("harness = {", "# harness = {", 1)
    assert "rigid: turns about 0.4107 m" in succeeded(
        equipoise("tool", "--full", written(text), "--modes")
    )


# Results of varied tools: tests/unit/handheld; their lines: test_widths.py.
@pytest.mark.exhaustive
def test_variation() -> None:
    words = ("vary", "nagamine-irie", "harness position = 0 mm : 154.4 mm", "--number", "5")
    result = as_json(*words)["variation"]
    assert len(result["values"]) == len(result["eigenvalues"])
    first, last = result["eigenvalues"][0], result["eigenvalues"][-1]
    assert first == pytest.approx((1.650, 3.105, 4.326, 6.169, 9.359), abs=5e-4)
    assert last == pytest.approx((1.497, 2.631, 4.364, 6.221, 9.387), abs=5e-4)
    shown = succeeded(equipoise("tool", *words))
    assert "Natural frequencies against position of harness" in shown and "1/min" in shown


def test_sensitivities_are_those_of_python() -> None:
    result = as_json("sensitivities", "pole-saw", "--speeds", "5000 rpm : 6000 rpm")
    speeds = np.linspace(5000 * RPM, 6000 * RPM, 201)
    slopes = eq.handheld.tool_sensitivities(eq.schema.load_tool("pole-saw"), speeds)
    first = {(s, k): v for s, part in result["sensitivities"].items() for k, v in part.items()}
    assert first.keys() == slopes.keys()
    assert list(first.values()) == pytest.approx(list(slopes.values()))
    assert "mm/s^2" in succeeded(equipoise("tool", "sensitivities", "pole-saw"))


def test_a_file_to_start_from() -> None:
    result = equipoise("new", "mine.toml", "--tool")
    assert result.err == "wrote mine.toml; next: equipoise tool mine.toml\n"
    shown = succeeded(equipoise("tool", "--full", "mine.toml"))
    assert "A day at handle" in shown
    assert "ready: equipoise tool mine.toml" in succeeded(equipoise("check", "mine.toml"))
    refuses("new mine.toml --tool", "is there already")


def test_a_check_shows_what_tubes_are_made_of() -> None:
    text = " ".join(succeeded(equipoise("check", "brush-cutter")).split())
    assert "0.9926 kg, aluminium, 2700 kg/m^3, 70.00 GPa, bending stiffness" in text


# -- a better tool ---------------------------------------------------------------------------------

SMALL = """
[design]
speeds = ["6500 rpm", "8000 rpm"]

[[design.variables]]
station = "harness"
key = "position"
from = "200 mm"
to = "300 mm"
"""


def test_design_is_written_and_read_back(folder: Path) -> None:
    text = example_text("nagamine-irie")
    hand = 'hand = { stiffness = "51 kgf/cm", hands = 2 }'
    damped = hand.replace("stiffness", 'damping = "60 N s/m", stiffness')
    file = written(text + SMALL, (hand, damped), to="tool.toml")
    result = equipoise("tool", "design", file, "-o", "better.toml", "--json")
    content = json.loads(succeeded(result))["design"]
    assert result.err == "wrote better.toml; next: equipoise tool better.toml\n"
    assert {path.name for path in folder.iterdir()} == {"tool.toml", "better.toml"}
    place = content["variables"]["harness position"]
    better = eq.schema.load_tool("better.toml")
    assert better.station("harness").position == pytest.approx(place["after"], rel=1e-12)
    measure = content["figures"]["a_hv of the worst hand, RMS over the band"]
    assert measure["after"] < measure["before"]
    speeds = np.array(content["speed"])
    a_hv = eq.handheld.expose_tool(better, speeds).a_hv
    assert a_hv.tolist() == pytest.approx(content["a_hv_after"])
    weights = np.ones(len(speeds))
    weights[[0, -1]] = 0.5
    assert np.sqrt(np.average(a_hv**2, weights=weights)) == pytest.approx(
        measure["after"], rel=1e-3
    )


# A design is written and read back on every change.
@pytest.mark.exhaustive
def test_design_before_and_after() -> None:
    """One table: what to change, and what that brings; what ends at its range says so."""
    text = example_text("pole-saw")
    shown = succeeded(
        equipoise("tool", written(text + SMALL.replace('"harness"', '"belt"'), to="tool.toml"))
    )
    assert "What to change" not in shown
    shown = succeeded(equipoise("tool", "design", "tool.toml"))
    row = re.search(r"^position of belt, mm +600\.0 +(\S+) +(\S+ %)(.*)$", shown, re.MULTILINE)
    assert row
    assert 200 <= float(row[1]) <= 300
    assert (" limit" in row[3]) == (row[1] in {"200.0", "300.0"})
    assert "a_hv of the worst hand, RMS over the band, m/s^2" in shown
    assert re.search(r"^[1-8] of 8 searches from different", shown, re.MULTILINE)


# -- files -----------------------------------------------------------------------------------------


# Pictures of tools: tests/unit/figures; their columns: tests/unit/results.
@pytest.mark.exhaustive
def test_pictures_and_columns(folder: Path) -> None:
    words = ("tool", "pole-saw", "--modes", "--respond", "4000:6000 rpm", "--exposure")
    result = equipoise(*words, "--plot", "pictures", "--format", "png", "--csv", "sweep.csv")
    succeeded(result)
    names = {path.stem for path in (folder / "pictures").iterdir()}
    assert {"modes", "determinant", "transmission", "acceleration", "exposure"} <= names
    lines = Path("sweep.csv").read_text(encoding="utf-8").splitlines()
    header = lines[0].split(",")
    assert header[0] == "speed [rad/s]"
    assert any(name.endswith(".force_hand [N]") for name in header)
    rows = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    assert rows.shape[1] == len(header)
    assert np.all(np.isfinite(rows))


def test_start_is_quick_and_alone() -> None:
    """Neither Matplotlib nor SciPy is there for figures alone."""
    code = (
        "import sys; from equipoise.cli import run; run(['tool', 'nagamine-irie']); "
        "print(*[m for m in ('matplotlib', 'scipy') if m in sys.modules], file=sys.stderr)"
    )
    alone = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert alone.stderr == "\n"


# -- what cannot be --------------------------------------------------------------------------------


def test_designs_that_cannot_be() -> None:
    refuses("tool design nagamine-irie", "design: missing; add the table [design]")
    refuses("tool design nagamine-irie --out .", "--out: . is a directory")


def test_the_other_kind_of_file() -> None:
    refuses("tool yamashita-1", "use `equipoise analyze FILE`")
    refuses("analyze pole-saw", "`equipoise tool")
    refuses("tool nearly.toml", "nearly.toml: there is no such file")


def test_station_off_the_shaft() -> None:
    changed("nagamine-irie", ('position = "1.544 m"', 'position = "1.6 m"'))
    said = refuses("tool model.toml", "1.544 m")
    assert said.startswith("model.toml: shaft.stations[4].position: got 1.6 m")


def test_table_of_a_hand_that_ends_too_soon() -> None:
    Path("hand.csv").write_text(
        "frequency [Hz],resistance [N s/m],reactance [N s/m]\n10,60,-130\n100,85,20\n"
    )
    old = 'hand = { stiffness = "51 kgf/cm", hands = 2 }'
    file = changed("nagamine-irie", (old, 'hand = { impedance = "hand.csv" }'))
    said = "shaft.stations[3].hand.impedance: the table hand.csv reaches from 10 Hz to 100 Hz"
    assert "150 Hz" in refuses(f"tool {file} --respond '1000 rpm : 9000 rpm'", said)
    shown = succeeded(equipoise("tool", file, "--respond", "1000 rpm : 6000 rpm"))
    assert "handle" in shown
    assert "known by its impedance" in succeeded(equipoise("tool", file, "--modes"))


def test_what_is_missing_is_reported() -> None:
    text = example_text("nagamine-irie")
    start = text.index("[[excitations]]")
    written(text[:start] + text[text.index("[operation]") :], to="silent.toml")
    refuses("tool silent.toml --exposure", "excitations: nothing shakes the tool")
    assert "Force at handle" in succeeded(equipoise("tool", "--full", "silent.toml"))
    written(text.replace('hand = { stiffness = "51 kgf/cm", hands = 2 }', "", 1), to="unheld.toml")
    refuses("tool unheld.toml --exposure", "no hand holds the tool")
    written(text[: text.index("[operation]")], to="lazy.toml")
    refuses("tool lazy.toml --exposure", "give --respond")
    assert "Natural frequencies" in succeeded(equipoise("tool", "--full", "lazy.toml"))


def test_new_file_takes_no_others_place() -> None:
    Path("there.toml").write_text("mine")
    refuses("tool design brush-cutter --out there.toml", "is there already")
    assert Path("there.toml").read_text() == "mine"


def test_no_design_within_the_limits() -> None:
    limit = (
        '\n[[design.limits]]\noutput = "acceleration"\nstation = "handle"\nat_most = "1 mm/s^2"\n'
    )
    written(example_text("nagamine-irie") + SMALL + limit)
    refuses("tool design model.toml", "no design within the limits was found")


def test_numbers_out_of_scale() -> None:
    """A length in km for mm: told at once, not computed for hours."""
    changed("nagamine-irie", ('length = "1.544 m"', 'length = "1544 km"'))
    said = "check its length, stiffness and mass"
    line = refuses("tool model.toml --respond '1000 rpm : 9000 rpm'", said)
    assert line.startswith("model.toml: shaft: at ")


@pytest.mark.parametrize("length", ["1e20 m", "1e30 m"])
def test_a_shaft_of_absurd_length(length: str) -> None:
    text = example_text("nagamine-irie").replace("1.544 m", length)
    for words in ("--modes", "--modes --json", "--respond '1000:9000 rpm' --json"):
        refuses(f"tool {written(text)} {words}", "shaft: ")
