"""The command `plot`."""

from __future__ import annotations

from pathlib import Path

import pytest

from surface.running import equipoise, refused, succeeded

WEIGHT = "counterweights.crank"
RADIUS = f"{WEIGHT}.radius = 0 : 70 mm"
DIRECTION = f"{WEIGHT}.direction = 0 deg : 360 deg"
MAP = (RADIUS, DIRECTION, "ripple shaking_force.y")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_every_picture_is_written_and_told(folder: Path) -> None:
    told = succeeded(equipoise("plot", "balance-crank")).splitlines()
    there = sorted(str(path.relative_to(folder)) for path in folder.rglob("*.svg"))
    assert sorted(line.split("  ")[0] for line in told) == there
    assert len(there) >= 14
    assert all(
        path.read_text(encoding="utf-8").startswith(("<?xml", "<svg"))
        for path in folder.rglob("*.svg")
    )


@pytest.mark.parametrize(
    ("arguments", "written"),
    [
        (["pole-saw", "--only", "modes", "--format", "pdf"], ["pole-saw-pictures/modes.pdf"]),
        (
            ["yamashita-1", "--only", "linkage", "--at", "0 deg, 90 deg", "--speed", "1 rpm"],
            ["yamashita-1-pictures/linkage.svg"],
        ),
        (
            ["yamashita-1", "--only", "polar", "--only", "force", "-o", "a", "--format", "png"],
            ["a/force.png", "a/polar.png"],
        ),
    ],
)
def test_chosen_pictures(folder: Path, arguments: list[str], written: list[str]) -> None:
    succeeded(equipoise("plot", *arguments))
    there = (path for path in folder.rglob("*") if path.is_file())
    assert sorted(str(path.relative_to(folder)) for path in there) == written


def test_a_map_tells_the_best_place(folder: Path) -> None:
    """Fig. 12 of Yamashita, Ichikawa and Mori: 35.7 mm at 111 deg from the line of pivots."""
    options = ("--points", "9", "--set", f"{WEIGHT}.mass = 1145 g", "-o", "map")
    result = equipoise("plot", "map", "yamashita-1", *MAP, *options)
    told = succeeded(result)
    assert f"{WEIGHT}.radius = 35.7 mm and {WEIGHT}.direction = 194 deg" in told
    assert [path.name for path in (folder / "map").iterdir()] == ["landscape.svg"]


BAD = {
    "name": (["plot", "--only", "polr"], "did you mean 'polar'"),
    "angle": (["plot", "--at", "3 mm"], "--at"),
    "folder": (["plot", "-o", "taken"], "--out"),
    "half a map": (["plot", "map", "links.crank.mass = 1 g : 2 g"], "parameter SECOND requires"),
    "no aim": (["plot", "map", *MAP[:2]], "parameter OUTPUT requires"),
    "unknown aim": (["plot", "map", *MAP[:2], "rms force"], "no output is called 'force'"),
    "unknown number": (["plot", "map", "links.a = 1 : 2", *MAP[1:]], "no number of the model"),
    "no range": (
        ["plot", "map", "links.crank.mass = 2 g", *MAP[1:]], "FIRST: got 'links.crank.mass = 2 g'; "
        "give a number and its range"),
    "no path": (["plot", "map", "2 g : 3 g", *MAP[1:]], "give such as"),
    "wrong unit": (["plot", "map", "links.crank.mass = 1 : 2 mm", *MAP[1:]], "a mass is wanted"),
    "back to front": (["plot", "map", "links.crank.mass = 2 : 1 g", *MAP[1:]], "the smaller value"),
    "the same twice": (["plot", "map", RADIUS, RADIUS, MAP[2]], "twice"),
    "set too": (["plot", "map", *MAP, "--set", f"{WEIGHT}.radius = 1 mm"], "give one of both"),
    "points": (["plot", "map", *MAP, "--points", "3"], "--points"),
    "a map's folder": (["plot", "map", *MAP, "-o", "taken"], "--out"),
}  # fmt: skip


@pytest.mark.parametrize(("words", "said"), BAD.values(), ids=BAD)
def test_wrong_wishes_are_told(folder: Path, words: list[str], said: str) -> None:
    (folder / "taken").write_text("", encoding="utf-8")
    name = 2 if words[1] == "map" else 1
    assert said in refused(equipoise(*words[:name], "yamashita-1", *words[name:]))
    assert [path.name for path in folder.iterdir()] == ["taken"]


def test_tools_have_no_crank_angles_and_no_map() -> None:
    assert "crank angles" in refused(equipoise("plot", "pole-saw", "--at", "0 deg"))
    assert "tool vary" in refused(equipoise("plot", "map", "pole-saw", *MAP))


def test_studies_draw_what_they_print(folder: Path) -> None:
    pytest.importorskip("pymoo")
    study = ["study-of-balance", "--population", "8", "--generations", "2"]
    result = equipoise("search", *study, "--plot", "found", "--format", "pdf", "--json")
    assert succeeded(result).count("\n") == 1
    pictures = sorted(path.name for path in (folder / "found").iterdir())
    assert pictures == ["designs.pdf", "front.pdf", "search.pdf"]
    succeeded(equipoise("tolerance", "study-of-tolerances", "--designs", "800", "--plot", "made"))
    pictures = sorted(path.name for path in (folder / "made").iterdir())
    assert pictures == ["scatter.svg", "shares.svg", "tighten.svg"]
