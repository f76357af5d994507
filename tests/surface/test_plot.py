"""The command `plot`."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import numpy as np
import pytest

from support.gallery import keep_files
from surface.running import equipoise, refuses, succeeded

WEIGHT = "counterweights.crank"
RADIUS = f"{WEIGHT}.radius = 0 : 70 mm"
DIRECTION = f"{WEIGHT}.direction = 0 deg : 360 deg"
MAP = (RADIUS, DIRECTION, "ripple shaking_force.y")


def test_every_picture_is_written_and_reported(folder: Path) -> None:
    lines = succeeded(equipoise("plot", "balance-crank")).splitlines()
    there = sorted(str(path.relative_to(folder)) for path in folder.rglob("*.svg"))
    assert sorted(line.split("  ")[0] for line in lines) == there
    assert len(there) >= 14
    assert all(
        path.read_text(encoding="utf-8").startswith(("<?xml", "<svg"))
        for path in folder.rglob("*.svg")
    )


@pytest.mark.exhaustive(but=["arguments1-written1"])
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


def test_outputs_are_reported_by_their_labels(folder: Path) -> None:
    outputs = ("--output", "shaking_force.y", "--output", "drive_torque")
    printed = succeeded(equipoise("plot", "yamashita-1", *outputs, "-o", "a"))
    assert printed == "a/outputs.svg  shaking force y, drive torque\n"


def test_a_map_reports_the_best_place(folder: Path) -> None:
    """Fig. 12 of Yamashita, Ichikawa and Mori: 35.7 mm at 111 deg from the line of pivots."""
    options = ("--points", "9", "--set", f"{WEIGHT}.mass = 1145 g", "-o", "map")
    result = equipoise("plot", "map", "yamashita-1", *MAP, *options)
    printed = succeeded(result)
    weight = "of the counterweight on the crank"
    assert f"at radius {weight} = 35.7 mm and direction {weight} = 194 deg" in printed
    assert [path.name for path in (folder / "map").iterdir()] == ["landscape.svg"]
    keep_files("plot map yamashita-1", folder / "map")


def test_tools_have_no_crank_angles_and_no_map() -> None:
    refuses("plot pole-saw --at '0 deg'", "crank angles")
    refuses(f"plot map pole-saw {shlex.join(MAP)}", "tool vary")


PICTURES = {
    # a command line: the pictures that it draws beside what it prints
    "respond yamashita-rig": {"drive", "gauge-gauge", "mounts", "spectrum"},
    "respond yamashita-rig --speed '100:140 rpm' --speeds 5": {
        *("response", "velocity", "acceleration", "resonance-map", "mounts")
    },
    "simulate yamashita-rig '0.2 s'": {"gauges", "mounts"},
    "run yamashita-rig '0.2 s'": {"speed"},
    "modes yamashita-rig": {"mode-1"},
    "balance trade-off yamashita-1 --crank-counterweight "
    "shaking_force.x shaking_force.y --points 3": {"front"},
    "decay decay.csv": {"record", "swings"},
    "exposure lines.csv lines.csv --duration '1 h'": {"exposure", "spectrum-2", "spectrum"},
    "search study-of-balance --population 8 --generations 2": {
        *("designs", "front", "parallel", "search")
    },
    "tolerance study-of-tolerances --designs 800": {"scatter", "shares", "tighten"},
}


@pytest.mark.exhaustive(
    but=[
        "modes yamashita-rig",
        "respond yamashita-rig",
        "exposure lines.csv lines.csv --duration '1 h'",
        "decay decay.csv",
    ]
)
@pytest.mark.parametrize("line", PICTURES)
def test_pictures_beside_what_is_printed(line: str) -> None:
    time = np.linspace(0.0, 2.6, 800)
    swings = 9 * np.exp(-0.4 * time) * np.cos(12.4 * time)
    rows = "".join(f"{t:.6f},{x:.6f}\n" for t, x in zip(time, swings, strict=True))
    Path("decay.csv").write_text(f"time [s],displacement [mm]\n{rows}")
    Path("lines.csv").write_text("frequency [Hz],x [m/s^2]\n50,3\n100,4\n")
    result = equipoise(*shlex.split(line), "--plot", "new/pictures")
    assert succeeded(result)
    names = PICTURES[line]
    count = "1 picture" if len(names) == 1 else f"{len(names)} pictures"
    assert result.err == f"wrote {count} to new/pictures\n"
    assert {path.name for path in Path("new/pictures").iterdir()} == {f"{n}.svg" for n in names}
    assert all(b"<svg" in path.read_bytes()[:600] for path in Path("new/pictures").iterdir())
    keep_files(line, Path("new/pictures"))


@pytest.mark.parametrize(("kind", "begin"), [("png", b"\x89PNG"), ("pdf", b"%PDF")])
def test_kinds_of_pictures(kind: str, begin: bytes) -> None:
    """Beside one line of JSON, and in a folder that is there."""
    words = ("modes", "yamashita-rig", "--plot", ".", "--format", kind)
    result = equipoise(*words, "--json")
    assert json.loads(succeeded(result))["modes"]
    assert result.err == "wrote 1 picture to .\n"
    assert Path(f"mode-1.{kind}").read_bytes().startswith(begin)
