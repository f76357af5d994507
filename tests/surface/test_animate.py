"""`equipoise animate` as a user runs it."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from equipoise.cli.reports import TOOL_FRAMES
from surface.running import (
    changed,
    equipoise,
    example_text,
    massless,
    process,
    refuses,
    succeeded,
    written,
)


def test_an_svg_is_written_to_the_current_folder_by_default() -> None:
    result = equipoise("animate", "yamashita-1", "--force", "--speed", "240 rpm")
    assert succeeded(result) == ""
    assert result.err == "wrote yamashita-1.svg\n"
    text = Path("yamashita-1.svg").read_text(encoding="utf-8")
    assert "<title>Planting mechanism type I (Yamashita, Ichikawa, Mori)</title>" in text
    assert "Path of P." in text
    assert "shaking force, at most 35.91 N" in text  # 23.22 N at 193 rpm, by the square


@pytest.mark.parametrize(("name", "path"), [("sieve", "C, D"), ("transplanter", "P")])
def test_paths_are_those_that_page_and_report_follow(name: str, path: str) -> None:
    """Also where every point joins something; of a planting finger its tip alone."""
    succeeded(equipoise("animate", name, "-o", "a.svg"))
    assert f"Path of {path}." in Path("a.svg").read_text(encoding="utf-8")


@pytest.mark.exhaustive(but=["a.GIF-GIF89a-more0"])
@pytest.mark.parametrize(
    ("name", "begins", "more"),
    [
        ("a.GIF", b"GIF89a", ["--dark"]),
        ("a.mp4", b"\0\0\0 ftypisom", ["--turns", "2", "--trace", "B", "--trace", "Y"]),
    ],
)
def test_films_are_written_by_the_kind_in_their_name(
    name: str, begins: bytes, more: list[str]
) -> None:
    if name.endswith("mp4"):
        pytest.importorskip("av")
    words = ["--seconds", "0.3", "--width", "200", *more]
    succeeded(equipoise("animate", "scotch-yoke", "-o", name, *words))
    assert Path(name).read_bytes().startswith(begins)


def test_a_machine_without_masses_moves_but_has_no_force() -> None:
    succeeded(equipoise("animate", written(massless(), to="massless.toml")))
    assert Path("massless.svg").exists()
    assert refuses("animate massless.toml --force", "mass").startswith("massless.toml: ")


def test_a_model_is_never_written_over() -> None:
    changed("yamashita-1", to="model.svg")
    refuses("animate model.svg -o model.svg", "is what is to be analysed")
    assert Path("model.svg").read_text(encoding="utf-8") == example_text("yamashita-1")


@pytest.mark.exhaustive(but=["a.gif"])
@pytest.mark.parametrize("name", ["a.svg", "a.gif"])
def test_the_same_bytes_on_every_run(name: str) -> None:
    words = ("animate", "planetary-planting-arm", "--seconds", "0.2", "--width", "200", "--force")
    succeeded(equipoise(*words, "-o", name))
    seed = {**os.environ, "PYTHONHASHSEED": "7"}
    assert process(*words, "-o", f"again-{name}", env=seed).status == 0
    assert Path(name).read_bytes() == Path(f"again-{name}").read_bytes()


def test_the_movement_of_the_support_is_drawn_and_reported() -> None:
    succeeded(equipoise("animate", "yamashita-1"))
    for name, words, text in (
        ("chosen", [], "movement of the support 2 times as large"),
        ("twenty", ["--exaggerate", "20"], "movement of the support 20 times as large"),
        ("true", ["--exaggerate", "1", "--speed", "150 rpm"], "movement of the support to scale"),
        ("mode", ["--mode", "1"], "Mode 1: "),
        ("still", ["--exaggerate", "0"], "</svg>"),
    ):
        succeeded(equipoise("animate", "yamashita-rig", "-o", f"{name}.svg", *words))
        assert text in Path(f"{name}.svg").read_text(encoding="utf-8")
    assert Path("chosen.svg").read_bytes() != Path("yamashita-1.svg").read_bytes()


@pytest.mark.parametrize(
    ("command", "why"),
    [
        ("yamashita-1 --exaggerate 2", "stands on solid ground"),
        ("yamashita-1 --mode 1", "stands on solid ground"),
        ('yamashita-1 --speed "300 rpm"', "--speed belongs to --force"),
        ("yamashita-rig --mode 2", "has the modes 1 to 1"),
        ("yamashita-rig --mode 1 --force", "in a mode the crank stands still"),
        ("yamashita-rig --exaggerate -1", "got -1; give 0 to"),
        ("riding-transplanter --mode 1", "across the drawing alone"),
    ],
)
def test_options_of_the_support_that_do_nothing_are_refused(command: str, why: str) -> None:
    refuses(f"animate {command}", why)


def test_a_support_that_cannot_be_computed_is_drawn_standing_still() -> None:
    result = equipoise("animate", "sieve", "--speed", "0 rpm", "-o", "still.svg")
    assert "the support is drawn standing still: " in result.err
    assert "movement" not in Path("still.svg").read_text(encoding="utf-8")


# -- tools -----------------------------------------------------------------------------------------


def test_a_tool_swings_in_a_mode() -> None:
    """Each instant has its share of half a swing, and is another picture."""
    succeeded(equipoise("animate", "brush-cutter", "--mode", "3", "--seconds", "4"))
    text = Path("brush-cutter.svg").read_text(encoding="utf-8")
    frames = re.findall(r'<g class="f f\d+">(.*?)</g>', text, re.DOTALL)
    assert len(frames) == len({*frames}) == TOOL_FRAMES >= 24  # pictures a second
    still = text.split('<g class="f f0">')[0]
    assert "mode 3: " in still and "<title>Brush cutter with loop handle</title>" in still
    assert still.count("2s step-end infinite alternate") == TOOL_FRAMES
    shown = re.findall(r"([\d.]+)%\{visibility:visible\}([\d.]+)%", text)
    ends = [float(end) for share in shown for end in share]
    assert ends[0] == 0 and ends[-1] == 100 and ends[1:-1:2] == ends[2:-1:2]


@pytest.mark.parametrize(
    ("command", "why"),
    [
        ("--mode 7", "got 7; of the vertical plane there are 1 to 6"),
        ("--mode 0", "got 0; of the vertical plane there are 1 to 6"),
        ("--force", "--force: a tool swings in a mode"),
        ("--trace P", "--trace: a tool swings in a mode"),
        ("-o saw.gif", "give a name that ends in .svg"),
    ],
)
def test_what_only_a_linkage_has_is_refused_of_a_tool(command: str, why: str) -> None:
    refuses(f"animate pole-saw {command}", why)
