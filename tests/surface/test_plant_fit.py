"""`equipoise plant fit` as a user runs it."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import equipoise as eq
from surface.running import command_lines, equipoise, refused, refuses, succeeded

TARGET = """
schema = 1
[search]
generations = 20
population = 20
[vary]
crank = ["30 mm", "40 mm"]
tip.y = ["-200 mm", "0 mm"]
[[goals]]
figure = "curve.height"
target = "26 cm"
"""


pytestmark = pytest.mark.usefixtures("with_progress")


@pytest.fixture(autouse=True)
def target(folder: Path) -> None:
    Path("target.toml").write_text(TARGET, encoding="utf-8")


def test_a_new_model_file_and_a_table(folder: Path) -> None:
    result = equipoise("plant", "fit", "kim-chung-a", "target.toml")
    text = succeeded(result)
    assert re.search(r"^height of the curve, mm +260\.0 ", text, re.MULTILINE)
    assert "yes" in text
    assert "crank, mm" in text
    assert result.err.splitlines()[-1] == "wrote kim-chung-a-fit.toml"
    assert "generation 1 of at most 20" in result.err
    actual = eq.load("kim-chung-a-fit.toml")
    assert eq.plant(actual)["curve.height"] == pytest.approx(0.26, abs=1e-8)
    assert "plant fit target.toml, seed 1" in actual.description
    assert {path.name for path in folder.iterdir()} == {"target.toml", "kim-chung-a-fit.toml"}


# A search by the command: `test_a_new_model_file_and_a_table`.
@pytest.mark.exhaustive
def test_json() -> None:
    words = ("--json", "--seed", 5, "--out", "new.toml")
    result = equipoise("plant", "fit", "kim-chung-a", "target.toml", *words)
    content = json.loads(succeeded(result))
    assert content["seed"] == 5
    assert content["goals"][0]["met"] is True
    assert content["before"]["curve"]["height"] == pytest.approx(0.25157, abs=1e-5)
    assert content["after"]["curve"]["height"] == pytest.approx(0.26, abs=1e-8)
    assert set(content["values"]) == {"crank", "tip.y"}
    assert eq.plant(eq.load("new.toml"))["curve.height"] == pytest.approx(0.26, abs=1e-8)


def test_a_file_that_is_there_stays(folder: Path) -> None:
    (folder / "kim-chung-a-fit.toml").write_text("mine", encoding="utf-8")
    said = refused(equipoise("plant", "fit", "kim-chung-a", "target.toml"))
    assert said == "kim-chung-a-fit.toml: is there already; choose another name by --out"
    assert (folder / "kim-chung-a-fit.toml").read_text(encoding="utf-8") == "mine"


REFUSED = {
    "plant fit": {
        "kim-chung-a none.toml": "none.toml: there is no such file",
        "kim-chung-a ''": "there is no such file",
        "yamashita-1 target.toml": "yamashita-1: planting: missing",
        "kim-chung-a target.toml --seed -3": "--seed: got -3; give 0 or more",
        "kim-chung-a target.toml --out ''": "--out: got an empty name",
        "kim-chung-a target.toml --out no/new.toml": "no/new.toml",
    },
}


@command_lines(REFUSED)
def test_refused(line: str, said: str) -> None:
    refuses(line, said)


def test_a_wrong_goal_names_the_target_file(folder: Path) -> None:
    text = TARGET.replace("crank =", "crnk =")
    (folder / "target.toml").write_text(text, encoding="utf-8")
    said = refused(equipoise("plant", "fit", "kim-chung-a", "target.toml"))
    assert said.startswith("target.toml: vary.crnk: ")
    assert "did you mean 'crank'" in said


GOAL = "schema = 1\n[search]\ngenerations = 4\npopulation = 6\n[[goals]]\nfigure = "


def asked(folder: Path, goal: str) -> str:
    (folder / "target.toml").write_text(GOAL + goal, encoding="utf-8")
    return succeeded(equipoise("plant", "fit", "transplanter", "target.toml"))


# A search by the command: `test_a_new_model_file_and_a_table`.
@pytest.mark.exhaustive
def test_the_smallest_population_and_a_figure_to_be_made_large(folder: Path) -> None:
    text = asked(folder, '"curve.height"\nmake = "largest"\n')
    assert re.search(r"^height of the curve, mm +largest ", text, re.MULTILINE)
    assert " yes" not in text


# Tolerances of targets are read in tests/unit/planting/test_search.py.
@pytest.mark.exhaustive
def test_a_target_of_0_has_a_tolerance(folder: Path) -> None:
    more = '"lowest.ground_velocity.x"\ntarget = "0 m/s"\n'
    assert " yes" in asked(folder, more)


# What gets lost is a figure as others: `test_a_new_model_file_and_a_table`.
@pytest.mark.exhaustive
def test_what_gets_lost_is_reported(folder: Path) -> None:
    """A search that is not told of the tray misses it."""
    text = asked(folder, '"curve.height"\ntarget = "40 cm"\n')
    assert "attitude of the finger at pick-up, deg" in text and "-158.15  " in text
    result = eq.plant(eq.load("transplanter-fit.toml"))
    for note in result.notes:
        assert f"note: {note}" in text
    assert result.machine.title.endswith(", fitted")


def test_tables_beside_the_new_file_are_not_replaced(folder: Path) -> None:
    machine = eq.load("kim-chung-a").with_planting(
        soil=eq.mechanism.Soil(table=eq.mechanism.SoilTable((0.0, 0.04), (5.0, 9.0)))
    )
    eq.save(machine, "mine.toml")
    (folder / "mine-fit.soil.csv").write_text("mine", encoding="utf-8")
    said = refused(equipoise("plant", "fit", "mine.toml", "target.toml"))
    assert said == "mine-fit.soil.csv: is there already; choose another name by --out"
    assert (folder / "mine-fit.soil.csv").read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize("path", ["target.toml", "new.toml"])
def test_results_keep_out_of_each_others_way(folder: Path, path: str) -> None:
    words = ["--out", "new.toml", "--csv", path]
    said = refused(equipoise("plant", "fit", "kim-chung-a", "target.toml", *words))
    assert said == f"--csv: {path} has another part in this command; give another name"


def test_an_empty_vary(folder: Path) -> None:
    lines = [line for line in TARGET.splitlines() if not line.startswith(("crank", "tip"))]
    (folder / "target.toml").write_text("\n".join(lines), encoding="utf-8")
    said = refused(equipoise("plant", "fit", "kim-chung-a", "target.toml"))
    assert said.startswith("target.toml: vary: names nothing")
