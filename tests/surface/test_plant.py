"""`equipoise plant` as a user runs it: tables, JSON, CSV, and one sentence where it cannot."""

from __future__ import annotations

import csv
import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.field import Soil
from equipoise.planting.summary import plant
from support.chosen import few
from surface.running import (
    cells,
    changed,
    equipoise,
    example_text,
    massless,
    read,
    refuses,
    succeeded,
)
from unit.planting.build import planetary, spinner, twice

EXAMPLES = ("kim-chung-a", "kim-chung-b", "kim-chung-c")
SURFACE = 'surface = "-117 mm"'


def planted(*words: str) -> dict[str, Any]:
    return read("plant", *words)


# -- tables ----------------------------------------------------------------------------------------


def test_tables_of_mechanism_a() -> None:
    result = equipoise("plant", "kim-chung-a")
    text = succeeded(result)
    assert result.err == ""
    lines = text.splitlines()
    assert lines[0] == "Planting mechanism A (Kim, Chung)"
    assert lines[1] == (
        "crank driven at 240.0 rpm, counterclockwise; machine drives forward at 0.6000 m/s"
    )
    assert lines[2] == "tip P on coupler, finger from B, surface of the soil at y = -116.9 mm"
    assert cells(text, "crank angle") == ["195.24", "236.77", "268.65", "47.01"]
    assert cells(text, "velocity") == ["2.707", "0.3069", "3.829", "0.8748"]
    assert cells(text, "height of the curve") == ["251.6"]
    assert cells(text, "width of the curve") == ["74.83"]
    assert cells(text, "crank travel in the soil") == ["73.41"]
    assert cells(text, "path in the soil over ground") == ["105.7"]
    assert cells(text, "ground distance from entry to exit") == ["48.83"]
    assert cells(text, "largest velocity of the tip") == ["4.473", "283.1", "90.79"]
    assert cells(text, "smallest velocity of the tip") == ["0.2575", "238.3", "32.79"]
    assert cells(text, "coupler")[:2] == ["-0.9215", "278.2"]
    assert cells(text, "rocker")[:2] == ["-0.8808", "267.1"]
    assert lines[-1] == "note: the finger is taken from B to P; finger_from can name another"
    assert not re.search("nan|inf|None", text)


ROWS = {
    # label, figure, and SI units in one unit of the table
    "height of the curve": ("curve.height", 0.001),
    "smallest radius of the curve": ("curve.smallest_radius.value", 0.001),
    "smallest radius over ground": ("ground.smallest_radius.value", 0.001),
    "distance of hills": ("hill_spacing", 0.001),
    "depth in the soil": ("soil.depth", 0.001),
    "time in the soil": ("soil.time", 0.001),
    "path in the soil relative to the machine": ("soil.path_length_machine", 0.001),
    "length of the hole at the surface": ("soil.hole_length", 0.001),
    "largest acceleration in the soil": ("soil.max_acceleration.value", 1),
    "smallest acceleration of the tip": ("min_acceleration.value", 1),
}


@pytest.mark.parametrize("name", few(EXAMPLES, {"kim-chung-c"}))
def test_tables_show_the_figures_to_four_digits(name: str) -> None:
    text = succeeded(equipoise("plant", name))
    figures = plant(eq.load(name))
    for label, (figure, unit) in ROWS.items():
        assert float(cells(text, label)[0]) == pytest.approx(figures[figure] / unit, rel=6e-4), (
            label
        )
    for label, key in (("x", "x"), ("y", "y")):
        wanted = [1000 * figures[f"{i}.{key}"] for i in ("entry", "lowest", "exit", "highest")]
        assert list(map(float, cells(text, label))) == pytest.approx(wanted, rel=6e-4)
    for label, key in (
        ("attitude of the finger", "attitude"),
        ("crank angle", "crank_angle"),
    ):
        wanted = [figures[f"{i}.{key}"] for i in ("entry", "lowest", "exit", "highest")]
        assert list(map(float, cells(text, label))) == pytest.approx(np.degrees(wanted), abs=0.006)


# The paper's crank angles: tests/literature/test_kim_chung.py.
@pytest.mark.exhaustive
def test_crank_angles_from_another_direction() -> None:
    """phi of mechanism A is 90 deg: its own crank angles are those of the paper."""
    text = succeeded(equipoise("plant", "kim-chung-a", "--crank-zero", "90 deg"))
    assert "Crank angles count from 90.00 deg." in text.splitlines()
    assert cells(text, "crank angle") == ["105.24", "146.77", "178.65", "317.01"]
    assert cells(text, "largest acceleration in the soil") == ["197.5"]
    assert cells(text, "smallest acceleration of the tip") == ["44.92", "87.5", "34.82"]
    assert cells(text, "coupler")[:2] == ["-0.9215", "188.2"]
    assert "249.83" in text  # first pass of the loop
    back = succeeded(equipoise("plant", "kim-chung-a", "--crank-zero", "-1.5 turn"))
    assert cells(back, "crank angle") == ["15.24", "56.77", "88.65", "227.01"]
    assert planted("kim-chung-a", "--crank-zero", "90 deg") == planted("kim-chung-a")


# Units of all tables: tests/surface/test_units.py.
@pytest.mark.exhaustive
def test_units_of_the_tables() -> None:
    text = succeeded(equipoise("plant", "kim-chung-a", "--units", "cm, km/h, gn,rad"))
    assert "height of the curve, cm" in text and cells(text, "height of the curve") == ["25.16"]
    assert "largest velocity of the tip, km/h" in text
    assert cells(text, "largest velocity of the tip")[::2] == ["16.10", "1.5846"]
    assert "smallest acceleration of the tip, gn" in text
    assert cells(text, "smallest acceleration of the tip")[::2] == ["4.580", "0.6076"]
    assert cells(text, "time in the soil") == ["50.98"]
    assert planted("kim-chung-a", "--units", "mm") == planted("kim-chung-a")
    turns = succeeded(equipoise("plant", "kim-chung-a", "--units", "turn, rad/s, s"))
    assert "crank driven at 240.0 rpm" in turns
    assert cells(turns, "crank angle")[0] == "0.54235"
    assert cells(turns, "time in the soil") == ["0.05098"]


# Another speed of other tables: tests/surface/test_balance.py and test_respond.py.
@pytest.mark.exhaustive
def test_another_speed() -> None:
    text = succeeded(equipoise("plant", "kim-chung-a", "--speed", "-300 rpm"))
    assert "crank driven at 300.0 rpm, clockwise" in text
    figures = plant(eq.load("kim-chung-a"), speed=-math.tau * 5)
    assert planted("kim-chung-a", "--speed", "-5 turn/s") == figures.to_dict()


def test_soil_and_limits_have_tables() -> None:
    values = 'depth = "4 cm"\nacceleration_limit = "150 m/s^2"\nsoil.per_depth = "300 N/m"'
    text = succeeded(equipoise("plant", changed("kim-chung-a", ('depth = "4 cm"', values))))
    assert "Limits of the tip's acceleration" in text
    assert cells(text, "all the way")[:2] == ["150.0", "209.1, over the limit"]
    assert "Peaks of drive torque and joint forces" in text
    figures = plant(eq.load("model.toml"))
    assert figures.forces is not None
    air, soil = figures.forces.compared()["drive_torque"]
    row = cells(text, "drive torque")
    assert [float(row[0]), float(row[2])] == pytest.approx([air.peak, soil.peak], rel=6e-4)
    assert float(row[4]) == pytest.approx(soil.peak / air.peak, rel=6e-4)
    plain = succeeded(equipoise("plant", "kim-chung-a"))
    assert "Limits" not in plain
    assert "Peaks" not in plain


def test_tray_and_release_have_columns() -> None:
    values = f'{SURFACE}\nrelease = "200 deg"\ntray = [["-300 mm", "12 mm"], ["0 mm", "12 mm"]]'
    text = succeeded(equipoise("plant", changed("kim-chung-a", ('depth = "4 cm"', values))))
    header = next(line for line in text.splitlines() if "entry" in line)
    assert header.split() == [
        "pick-up",
        "entry",
        "release",
        "lowest",
        "point",
        "exit",
        "highest",
        "point",
    ]
    assert cells(text, "crank angle")[2] == "200.00"
    assert cells(text, "y")[0] == "12.00"
    assert "from the tray" in text


def test_rounding_is_not_printed() -> None:
    """A tray at y = 0 is passed at y = 0."""
    values = f'{SURFACE}\ntray = [["-300 mm", "0 mm"], ["0 mm", "0 mm"]]'
    text = succeeded(equipoise("plant", changed("kim-chung-a", ('depth = "4 cm"', values))))
    assert cells(text, "y")[0] == "0"
    assert not re.search(r"[0-9]e-1[0-9]", text)


def test_a_machine_at_rest() -> None:
    text = succeeded(equipoise("plant", changed("kim-chung-a", ("60 cm/s", "0 m/s"))))
    assert "note: forward_speed is 0: there is no path over ground" in text
    assert "Loops" not in text
    assert "ground distance" not in text
    assert "length of the path over ground" not in text
    assert "smallest radius over ground" not in text
    content = planted("model.toml")
    assert content["loops"] == []
    assert "ground_distance" not in content["soil"]


# Stays: tests/secondroute/test_planting.py.
@pytest.mark.exhaustive
def test_every_stay_is_listed() -> None:
    eq.save(twice(), "twice.toml")
    text = succeeded(equipoise("plant", "twice.toml", "--crank-zero", "10 deg"))
    rows = text.partition("Every stay in the soil; crank angles")[2].splitlines()[4:6]
    content = planted("twice.toml")
    assert len(content["visits"]) == 2
    for row, visit in zip(rows, content["visits"], strict=True):
        wanted = [(math.degrees(visit[k]) - 10) % 360 for k in ("entry", "exit", "deepest")]
        assert list(map(float, row.split())) == pytest.approx(
            [*wanted, 1000 * visit["depth"]], abs=0.06
        )
    assert "note: the tip is in the soil 2 times a cycle" in text
    assert "Every stay" not in succeeded(equipoise("plant", "kim-chung-a"))


def test_a_cusp_is_reported() -> None:
    eq.save(spinner(forward_speed=1.0), "cusp.toml")
    text = succeeded(equipoise("plant", "cusp.toml"))
    assert "Cusp of the path over ground at crank angle 90.00 deg" in text.splitlines()
    assert "Loops" not in text


# Cycles of three turns: tests/unit/planting.
@pytest.mark.exhaustive
def test_a_cycle_of_three_turns() -> None:
    eq.save(planetary(depth=0.1), "arm.toml")
    text = succeeded(equipoise("plant", "arm.toml"))
    figures = plant(eq.load("arm.toml"))
    assert cells(text, "crank angle")[0] == f"{math.degrees(figures['entry.crank_angle']):.2f}"
    assert figures["entry.crank_angle"] > math.tau
    assert len(planted("arm.toml")["visits"]) == 3


# -- JSON and CSV ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", few(EXAMPLES, {"kim-chung-b"}))
def test_json_is_one_object_with_all_figures(name: str) -> None:
    assert planted(name) == plant(eq.load(name)).to_dict()


@pytest.mark.parametrize("name", ["kim-chung-a", "kim-chung-b"])
def test_csv(name: str) -> None:
    """One row a crank angle as time goes on, whichever way the crank turns; SI units."""
    result = equipoise("plant", name, "--csv", "tip.csv", "--angles", "8")
    assert succeeded(result).startswith("Planting mechanism")
    assert result.err == "wrote tip.csv\n"
    with open("tip.csv", encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    assert header[:5] == ["crank_angle [rad]", "time [s]", "tip.x [m]", "tip.y [m]",
                          "tip.ground_x [m]"]  # fmt: skip
    assert "center_of_mass.acceleration [m/s^2]" in header
    assert len(set(header)) == len(header) == 24
    values = np.array(rows, float)
    assert values.shape == (8, 24)
    assert np.all(np.diff(values[:, 1]) > 0)
    sense = 1 if name == "kim-chung-a" else -1
    motion = eq.move(eq.load(name), sense * np.arange(8) * math.tau / 8).points["P"]
    columns = dict(zip(header, values.T, strict=True))
    np.testing.assert_allclose(columns["tip.x [m]"], motion.x, rtol=1e-12)
    np.testing.assert_allclose(columns["tip.vy [m/s]"], motion.vy, rtol=1e-10)
    np.testing.assert_allclose(
        columns["tip.ground_x [m]"], motion.x + 0.6 * columns["time [s]"], rtol=1e-12
    )


def test_csv_and_json_together() -> None:
    result = equipoise("plant", "kim-chung-a", "--csv", "tip.csv", "--json")
    assert json.loads(result.out)["title"].startswith("Planting")
    assert result.err == "wrote tip.csv\n"
    assert len(Path("tip.csv").read_text(encoding="utf-8").splitlines()) == 361


def test_without_masses_there_is_neither_force_nor_its_centre() -> None:
    eq.save(eq.loads(massless("kim-chung-b")).with_planting(soil=Soil(resistance=3.0)), "soil.toml")
    shown = succeeded(equipoise("plant", "soil.toml", "--csv", "tip.csv"))
    assert "tip P on coupler, finger from B" in shown
    assert "Peaks" not in shown
    assert "center_of_mass" not in Path("tip.csv").read_text(encoding="utf-8")


# -- machines that cannot --------------------------------------------------------------------------

MACHINES = {
    # what is replaced, by what, what is said of the file
    "never reaches": ('depth = "4 cm"', 'surface = "-20 cm"',
                      "planting.surface: got -200 mm; the tip P never reaches the soil, its lowest "
                      "point is at -156.9 mm; give a surface above that"),
    "never leaves": ('depth = "4 cm"', 'depth = "26 cm"',
                     "planting.depth: got 260 mm; the tip P never leaves the soil, its path is "
                     "251.6 mm high; give a depth below that"),
    "under the surface": ('depth = "4 cm"', 'surface = "10 cm"',
                          "planting.surface: got 100 mm; the tip P never leaves the soil, it is at "
                          "94.69 mm at most; give a surface below that"),
    "cannot turn": ('points.B = ["35 mm", "0 mm"]', 'points.B = ["79 mm", "0 mm"]',
                    "the crank cannot turn fully"),
    "stands still": ('"240 rpm"', '"0 rpm"', "drive.speed: got 0; give the speed at which"),
    "wrong tip": ('tip = "P"', 'tip = "Q"', "planting.tip: no point of a moving link is called"),
    "wrong key": ('depth = "4 cm"', 'deep = "4 cm"', "planting.deep: no key is called 'deep'"),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "said"), MACHINES.values(), ids=MACHINES)
def test_a_machine_that_cannot_plant(old: str, new: str, said: str) -> None:
    """One sentence that names the file, and no results beside it."""
    changed("kim-chung-a", (old, new))
    assert refuses("plant model.toml --csv tip.csv", said).startswith(f"model.toml: {said}")


DWELLING = """
[planting]
tip = "C"
depth = "1 mm"
forward_speed = "0.4 m/s"
[[drive.motion.segments]]
over = "120 deg"
to = "0 deg"

[[drive.motion.segments]]
over = "120 deg"
to = "-60 deg"
law = "3-4-5"

[[drive.motion.segments]]
over = "120 deg"
to = "0 deg"
law = "3-4-5"
"""


# Dwells: tests/secondroute/test_planting.py.
@pytest.mark.exhaustive
def test_a_tip_that_dwells(tmp_path: Path) -> None:
    """Where it stands still, speed and acceleration are nothing at once; loops, unlike dyads, have
    no pose at a crank angle that is no number.
    """
    file = tmp_path / "dwelling.toml"
    file.write_text(example_text("class-three") + DWELLING, encoding="utf-8")
    assert cells(succeeded(equipoise("plant", file)), "depth in the soil") == ["1.000"]


def test_a_crank_angle_that_is_no_number_has_no_pose() -> None:
    """Such as where a tip enters the soil that it never reaches; a table has no such place."""
    cycle = assemble(eq.load("class-three")).cycle
    for name in cycle.tables:
        values = cycle.reference(name, np.array([np.nan, 1.0]))
        assert np.all(np.isnan(values[..., 0])) and np.all(np.isfinite(values[..., 1]))
