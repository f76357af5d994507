"""Every command as a user runs it."""

from __future__ import annotations

import csv
import io
import json
import math
import os
import re
import runpy
import signal
import subprocess
import sys
import threading
import tomllib
from functools import cache
from importlib.resources import files
from itertools import pairwise, product
from pathlib import Path
from typing import Any
from unittest import mock

import jsonschema
import numpy as np
import pytest

import equipoise as package
from equipoise.cli import COMMANDS, ONE_THREAD, RAREST, _signs_of_life, main, run
from equipoise.errors import UsageError
from equipoise.schema.files import json_text
from support import refusals
from support.chosen import DISTINCT, few, few_together
from surface.registered import functions, options
from surface.running import (
    EXAMPLES,
    READY,
    STUDIES,
    TOOLS,
    changed,
    command,
    equipoise,
    example,
    example_text,
    massless,
    process,
    read,
    refused,
    refuses,
    replaced,
    succeeded,
    unfolded,
    written,
)

ROOT = Path(__file__).parents[2]
LINK_KEYS = ["angle", "angular_velocity", "angular_acceleration"]
LOAD_KEYS = ["stress", "axial_force", "bending_moment"]
"""Of links with a section."""
POINT_KEYS = ["x", "y", "vx", "vy", "ax", "ay"]


def analyzed(*arguments: str | Path) -> dict[str, Any]:
    return read("analyze", *arguments)


def test_outputs_and_dwells_are_reported_by_name(tmp_path: Path) -> None:
    """A vector by its components; with --csv alone, with --json beside all else."""
    table, name = tmp_path / "out.csv", "centers.coupler/frame"
    result = analyzed("yamashita-1", "--output", name, "--dwell", "0.5 mm")
    succeeded(equipoise("analyze", "--full", "yamashita-1", "--output", name, "--csv", table))
    assert list(result["outputs"]) == [f"{name}.x", f"{name}.y"]
    header = table.read_text().splitlines()[0]
    assert header == f"crank_angle [rad],{name}.x [m],{name}.y [m]"
    assert list(result["dwells"]) == ["C", "P"]
    assert result["dwells"]["P"]["tolerance"] == pytest.approx(0.5e-3)
    text = succeeded(equipoise("analyze", "--full", "stephenson-six-bar", "--dwell", "0.5 deg"))
    assert re.search(r"^output +0.5000 +120.0 at 128.5$", text, re.MULTILINE)
    assert "Force in each joint" not in text


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (
            ("--output", "centers.rod/frame"),
            "--output: no output is called 'centers.rod/frame'; there are 'links.crank.angle'",
        ),
        (("--dwell", "3 kg"), "--dwell: got '3 kg'; give a length of more than 0, such as"),
        (("--dwell", "-1 mm"), "--dwell: got '-1 mm'; give a length of more than 0, such as"),
        (("--dwell", "P"), "--dwell: got 'P'; give a length of more than 0, such as"),
    ],
)
def test_outputs_and_dwells_that_cannot_be_reported(options: tuple[str, ...], words: str) -> None:
    assert words in refused(equipoise("analyze", "yamashita-1", *options))


# -- in general ------------------------------------------------------------------------------------


HELPS = """
import sys
from equipoise.cli import ONE_THREAD, main, run
for name in sys.argv[1].split(","):
    run(name.split())
    print("=====")
"""


@cache
def helps() -> dict[str, str]:
    """What all commands tell of themselves, on a terminal of 80 signs.

    In a process of its own: within this one help is as wide as the first that was told here.
    """
    asked = [*(f"{name} --help" for name in OPTIONS), "--help", "-h", ""]
    words = [sys.executable, "-c", HELPS, ",".join(asked)]
    environment = {**os.environ, "COLUMNS": "80"}
    done = subprocess.run(words, capture_output=True, env=environment, check=True)
    assert done.stderr == b""
    return dict(zip(asked, done.stdout.decode().split("=====\n"), strict=False))


@pytest.mark.parametrize("asked", ["--help", "-h", ""])
def test_help_names_every_command(asked: str) -> None:
    listed = re.findall(r"^[│|] ([a-z]+) ", helps()[asked], re.MULTILINE)
    assert sorted(listed) == sorted(COMMANDS)


OPTIONS = {name: options(name) for name in functions()}


@pytest.mark.parametrize("name", OPTIONS)
def test_help_of_a_command_reports_each_option(name: str) -> None:
    text = helps()[f"{name} --help"]
    assert text.startswith(f"Usage: equipoise {name}")
    shown = re.findall(r"^[│|] [* ]{0,3}([A-Z]+|--[a-z-]+) +\S", text, re.MULTILINE)
    assert sorted(shown) == sorted(OPTIONS[name])
    assert [line for line in text.splitlines() if len(line) > 80] == []


def test_help_says_what_an_option_wants() -> None:
    """In words or by an example, not by a type of Python; what is not asked for is not done."""
    text = "".join(helps().values())
    assert re.findall(r"\b(?:STR|INT|FLOAT|ANY|BOOL)\b|default: (?:False|None)", text) == []
    assert '--speed "250 rpm"' in text and "--csv FILE" in text and "--orders NUMBER" in text


def test_help_has_lines_of_its_own_and_no_markup() -> None:
    """Whatever lines the text has in the source."""
    reported = helps()["balance --help"]
    assert (
        "Its table  │\n│          [balance] has the permitted changes and the objectives; the"
        in reported
    )
    assert "`" not in "".join(helps().values())


@pytest.mark.parametrize("page", ["README.md", "docs/tour.md"])
def test_no_page_shows_a_command_that_does_not_exist(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    shown = set(re.findall(r"^(?:\$ )?equipoise ([a-z]+)", text, re.MULTILINE))
    assert shown and shown <= {*COMMANDS}


@pytest.mark.exhaustive(but=["bash"])
@pytest.mark.parametrize("shell", few(["bash", "zsh", "fish", "powershell"], {"bash", "fish"}))
def test_a_shell_completes_commands_options_and_values(shell: str) -> None:
    text = succeeded(equipoise("completion", shell))
    assert {*COMMANDS, "trade-off"} <= {*re.findall(r"[a-z][a-z-]+", text)}
    assert "crank-zero" in text and re.search(r"svg\W+png\W+pdf", text)


# The man page is made by tests/surface/test_added_command.py.
@pytest.mark.exhaustive
def test_the_man_page_reports_every_option(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["equipoise"])  # by which the program is called
    page = runpy.run_path(str(ROOT / "docs" / "man.py"))["page"]().decode().replace("\\-", "-")
    reported = re.split(r"(?m)^equipoise ((?!-)[a-z -]+?)(?: [A-Z\[].*)?$", page)[1:]
    parts = dict(zip(reported[::2], reported[1::2], strict=True))
    assert parts.keys() == OPTIONS.keys()
    for name, listed in OPTIONS.items():
        heads = re.findall(r"(?m)^\.B \\fB(.*)\\fP$", parts[name])
        assert [
            item
            for item in listed
            if not any(item in head.replace(",", "").split() for head in heads)
        ] == [], name


# -- examples, check -------------------------------------------------------------------------------


def test_examples_are_listed_with_their_titles() -> None:
    lines = succeeded(equipoise("examples")).splitlines()
    listed = dict(line.split(maxsplit=1) for line in lines)
    assert listed == {name: example(name)["title"]["en"] for name in (*EXAMPLES, *TOOLS, *STUDIES)}
    there = (file.name for file in files("equipoise").joinpath("examples").iterdir())
    assert {f"{name}.toml" for name in listed} == {name for name in there if "toml" in name}


@pytest.mark.parametrize("name", EXAMPLES)
def test_check_of_an_example(name: str) -> None:
    text = succeeded(equipoise("check", name))
    assert unfolded(text).startswith(example(name)["title"]["en"])
    assert text.splitlines()[-1] == READY
    drive = example(name)["drive"]
    turns = not {"motion", "stroke"} & drive.keys() and "drives" not in example(name)
    assert (f"driven: {drive['link']} at" in text) == turns


def test_check_reports_the_build_up() -> None:
    text = succeeded(equipoise("check", "watt-six-bar"))
    assert "  coupler and rocker: dyad; joints B (pin on crank), D (pin on frame)" in text
    assert "by Newton's method" in succeeded(equipoise("check", "class-three"))
    assert "geared" in succeeded(equipoise("check", "geared-counterweight"))


def test_a_file_beats_the_example_of_its_name() -> None:
    changed("quick-return", to="yamashita-1")
    assert succeeded(equipoise("check", "yamashita-1")).startswith("Quick-return")


# -- analyze: the tables ---------------------------------------------------------------------------


def driving(name: str) -> str:
    """What drives an example: a cylinder or a slide pushes, all else turns."""
    return "drive_force" if "stroke" in example(name)["drive"] else "drive_torque"


@pytest.mark.parametrize("name", few(EXAMPLES, DISTINCT))
def test_tables_of_an_example(name: str) -> None:
    result = equipoise("analyze", name, "--full")
    text = succeeded(result)
    assert unfolded(text).startswith(example(name)["title"]["en"])
    for title in ("Links", "Moving points", "On frame and drive", "Force in each joint"):
        assert re.search(rf"^{title}", text, re.MULTILINE)
    drive = driving(name).replace("_", " ")
    for row in ("shaking force x", "shaking moment", drive, *example(name)["links"]):
        assert re.search(rf"^(one row: )?{row}[, ]", text, re.MULTILINE)
    assert "nan" not in text
    assert result.err == ""


@pytest.mark.parametrize("name", ["check", "analyze"])
def test_a_model_without_masses_is_reported_of(name: str) -> None:
    full = ["--full"] if name == "analyze" else []
    text = succeeded(equipoise(name, written(massless()), *full))
    assert re.search(r"^ *coupler[ :]", text, re.MULTILINE)
    assert re.search(r"^note: .*mass", text, re.MULTILINE)
    assert "shaking force" not in text


PROCESSES = {
    "tables": ("analyze", "yamashita-1"),
    "JSON": ("respond", "yamashita-rig", "--json"),
    "wrong": ("balance", "yamashita-1", "--spead", "5 rpm"),
    "version": ("--version",),
}


@pytest.mark.exhaustive(but=["tables", "wrong"])
@pytest.mark.parametrize("words", PROCESSES.values(), ids=PROCESSES)
def test_a_process_prints_the_same_as_a_call(words: tuple[str, ...]) -> None:
    """And nothing else; `test_start_is_quick_and_alone` and others run processes besides."""
    result = process(*words)
    assert result == equipoise(*words)
    assert bool(result.err) == bool(result.status)


def test_version() -> None:
    assert equipoise("--version").out == f"{package.__version__}\n"


@pytest.mark.parametrize(
    ("command", "more"),
    [("check", ()), ("analyze", ("--full",)), ("plant", ("--csv", "tip.csv"))],
)
def test_markup_in_names_is_shown_as_it_stands(command: str, more: tuple[str, ...]) -> None:
    pairs = (("links.coupler", "links.'[bold]coupler[/]'"), ("Planting", "[red]Planting"))
    text = succeeded(equipoise(command, changed("kim-chung-b", *pairs), *more))
    assert text.startswith("[red]Planting")
    assert "[bold]coupler[/]" in text


@pytest.mark.exhaustive(but=["no ending"])
@pytest.mark.parametrize("name", ["odd name [1] %s $x$.toml", "ü-機.toml", "no ending"])
def test_odd_file_names(name: str) -> None:
    changed("kim-chung-a", to=name)
    balance = ("balance", name, "--crank-counterweight", "--objective", "shaking_force", "-o")
    for words in (("analyze", name, "--csv"), ("plant", name, "--csv"), balance):
        result = equipoise(*words, f"{words[0]} {name}")
        succeeded(result)
        assert result.err == f"wrote {words[0]} {name}\n"
    succeeded(equipoise("check", f"balance {name}"))
    changed("kim-chung-a", ('depth = "4 cm"', 'depth = "4 m"'), to=name)
    line = refused(equipoise("plant", f"./{name}"))
    assert line.startswith(f"./{name}: planting.depth: got 4000 mm; the tip P never leaves")


@pytest.mark.parametrize(
    "pair",
    [("links.coupler", r'links."\u001b[31mcoupler"'), ("Planting", r"\u001b[2J\u0007")],
    ids=["name", "title"],
)
@pytest.mark.parametrize("name", ["check", "analyze"])
def test_control_characters_do_not_reach_the_terminal(name: str, pair: tuple[str, str]) -> None:
    changed("yamashita-1", pair)
    refuses(f"{name} model.toml", "give printable characters")


# -- analyze: JSON and CSV -------------------------------------------------------------------------


@pytest.mark.parametrize("name", few(EXAMPLES, DISTINCT))
def test_json_has_the_documented_shape(name: str) -> None:
    count = 8
    content = analyzed(name, "--angles", str(count))
    model = example(name)
    total = count * content["turns"]
    assert content["title"] == model["title"]["en"]
    assert content["crank_angle"] == pytest.approx([k * math.tau / count for k in range(total)])
    assert set(content["links"]) == set(model["links"])
    bodies = [model["frame"], *model["links"].values()]
    assert set(content["points"]) == {point for body in bodies for point in body["points"]}
    for link, values in content["links"].items():
        loads = LOAD_KEYS if "section" in model["links"][link] else []
        assert [*values] == [*LINK_KEYS, *loads]
    assert all(list(point) == POINT_KEYS for point in content["points"].values())
    assert content["joints"]
    arrays = [
        *(values for link in content["links"].values() for values in link.values()),
        *(values for point in content["points"].values() for values in point.values()),
        *(joint[key] for joint in content["joints"].values() for key in ("force_x", "force_y")),
        *(content["shaking_force"][key] for key in "xy"),
        content["shaking_moment"],
        content[driving(name)],
    ]
    for values in arrays:
        assert len(values) == total
        assert np.all(np.isfinite(values))


def test_json_is_in_si_units() -> None:
    content = analyzed("yamashita-1", "--angles", "4")
    assert content["speed"] == pytest.approx(193 * math.tau / 60, rel=1e-15)
    crank = content["links"]["crank"]
    assert crank["angle"] == pytest.approx(content["crank_angle"])
    assert crank["angular_velocity"] == pytest.approx([content["speed"]] * 4)
    assert content["points"]["B"]["x"] == pytest.approx([0.0335, 0, -0.0335, 0])
    assert set(content["joints"]) == set("ABCD")
    summary = content["summary"]
    torque = np.array(content["drive_torque"])
    assert summary["drive_torque"]["max"] == torque.max()
    assert summary["drive_torque"]["rms"] == pytest.approx(np.sqrt(np.mean(torque**2)))
    assert summary["drive_torque"]["max_at"] == content["crank_angle"][int(torque.argmax())]
    assert {"shaking_force.x", "shaking_force", "shaking_moment"} < set(summary)
    assert summary["four_bar"]["type"] == "crank-rocker"


def test_json_of_a_model_without_masses() -> None:
    content = analyzed(written(massless()), "--angles", "3")
    assert set(content["links"]) == {"crank", "coupler", "rocker"}
    assert len(content["points"]["P"]["ax"]) == 3
    assert "mass" in content["missing"]
    assert not {"joints", "shaking_force", "shaking_moment", "drive_torque"} & set(content)


# What is left out of such a terminal is tested in this process too.
@pytest.mark.exhaustive
@pytest.mark.parametrize("encoding", few(["ascii", "cp1252"], {"ascii"}))
def test_output_in_a_terminal_that_lacks_letters(
    monkeypatch: pytest.MonkeyPatch, encoding: str
) -> None:
    monkeypatch.setenv("PYTHONIOENCODING", encoding)
    path = changed("yamashita-1", ("Planting", "Überträger 机"))
    text = process("analyze", path, "--json", "--angles", "1", encoding=encoding).out
    assert json.loads(text)["title"].startswith("Überträger 机 mechanism")
    assert succeeded(process("check", path, encoding=encoding)).endswith(f"{READY}\n")


def split_by_dots(content: dict[str, Any], column: str) -> Any:
    """Return the array that a column's name stands for."""
    value: Any = content
    for part in column.split("."):
        value = value[part]
    return value


@pytest.mark.parametrize("name", ["yamashita-1", "slider-crank-engine", "geared-counterweight"])
def test_csv_has_the_numbers_of_the_json(name: str) -> None:
    path = Path("result.csv")
    result = equipoise("analyze", name, "--json", "--angles", "6", "--csv", path)
    content = json.loads(succeeded(result))
    assert result.err == f"wrote {path}\n"
    with path.open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    assert len(rows) == 6 * content["turns"]
    matches = [re.fullmatch(r"(.+) \[([^]]+)\]", cell) for cell in header]
    units = {match[1]: match[2] for match in matches if match}
    assert len(units) == len(header)
    assert header[0] == "crank_angle [rad]"
    assert units["links.crank.angular_velocity"] == "rad/s"
    assert units["shaking_force.x"] == units["joints.A.force_y"] == "N"
    assert units["drive_torque"] == units["shaking_moment"] == "N m"
    for column, values in zip(units, zip(*rows, strict=True), strict=True):
        assert list(map(float, values)) == split_by_dots(content, column)


def test_csv_stands_beside_the_tables(folder: Path) -> None:
    path = folder / "result.csv"
    path.write_text("old")
    result = equipoise("analyze", "yamashita-1", "--csv", path)
    assert succeeded(result) == equipoise("analyze", "yamashita-1").out
    assert len(path.read_text().splitlines()) == 361
    assert list(folder.iterdir()) == [path]


# -- analyze: options ------------------------------------------------------------------------------


def test_angles_by_number_cover_whole_cycles() -> None:
    path = changed("planetary-planting-arm", ("teeth = [40, 20]", "teeth = [40, 30]"))
    content = analyzed(path, "--angles", "10")
    assert content["turns"] == 3
    assert content["crank_angle"] == pytest.approx([k * math.tau / 10 for k in range(30)])
    assert len(analyzed("yamashita-1")["crank_angle"]) == 360


def test_angles_by_list() -> None:
    content = analyzed("yamashita-1", "--angles", "0 deg, 90 deg,-1.5 rad, 2 turn")
    assert content["crank_angle"] == pytest.approx([0, math.pi / 2, -1.5, 2 * math.tau])
    assert "turns" not in content
    x = content["points"]["C"]["x"]
    assert x[0] == pytest.approx(x[3])
    assert analyzed("yamashita-1", "--angles", "-45 deg")["crank_angle"] == [-math.pi / 4]


def test_forces_of_inertia_grow_with_the_square_of_the_speed() -> None:
    first, two = (
        analyzed("yamashita-1", "--angles", "12", "--speed", speed)
        for speed in ("100 rpm", "-200 rpm")
    )
    assert two["speed"] == pytest.approx(-2 * first["speed"])
    for place in ("shaking_force.x", "shaking_force.y", "shaking_moment", "points.P.ax"):
        slow, fast = (np.array(split_by_dots(content, place)) for content in (first, two))
        np.testing.assert_allclose(fast, 4 * slow, rtol=0, atol=1e-12 * np.max(np.abs(fast)))


def test_acceleration_adds_to_the_drive_link() -> None:
    content = analyzed("yamashita-1", "--acceleration", "10 rad/s^2", "--angles", "3")
    assert content["acceleration"] == 10
    assert content["links"]["crank"]["angular_acceleration"] == pytest.approx([10, 10, 10])


def test_moments_about_another_point() -> None:
    at_pivot = analyzed("yamashita-1", "--angles", "9")
    frame = example("yamashita-1")["frame"]["points"]["D"]
    assert frame == {"distance": "88 mm", "direction": "-83 deg"}
    angle = math.radians(-83)
    about = {"x": 0.088 * math.cos(angle), "y": 0.088 * math.sin(angle)}
    by_name = analyzed("yamashita-1", "--angles", "9", "--about", "D")
    place = f"{about['x']} m, {1e3 * about['y']} mm"
    by_place = analyzed("yamashita-1", "--angles", "9", "--about", place)
    force = {key: np.array(values) for key, values in at_pivot["shaking_force"].items()}
    moment = (
        np.array(at_pivot["shaking_moment"]) - about["x"] * force["y"] + about["y"] * force["x"]
    )
    for content in (by_name, by_place):
        assert content["about"] == pytest.approx(about)
        assert content["shaking_moment"] == pytest.approx(moment)
        assert content["shaking_force"] == at_pivot["shaking_force"]
        assert content["drive_torque"] == at_pivot["drive_torque"]


# -- schema ----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def schema() -> dict[str, Any]:
    result = equipoise("schema")
    assert result.err == ""
    return json.loads(succeeded(result))  # type: ignore[no-any-return]


@pytest.mark.parametrize("kind", ["model", "tool", "study"])
def test_schema_is_the_shipped_file(kind: str) -> None:
    shipped = Path(package.__file__).with_name("schema") / f"{kind}.schema.json"
    option = () if kind == "model" else (f"--{kind}",)
    content = json.loads(succeeded(equipoise("schema", *option)))
    assert content == json.loads(shipped.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(content)


@pytest.mark.parametrize("name", EXAMPLES)
def test_schema_fits_the_example(name: str, schema: dict[str, Any]) -> None:
    jsonschema.Draft202012Validator(schema).validate(example(name))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"193 rpm"', '"193"'),
        ('"193 rpm"', '"193 Hz"'),
        ('link = "crank"', 'lnk = "crank"'),
        ('mass = "199 g"', ""),
        ('C = "left"', 'C = "leftish"'),
        ("schema = 1", "schema = 2"),
    ],
)
def test_schema_refuses_what_the_reader_refuses(old: str, new: str, schema: dict[str, Any]) -> None:
    text = replaced(example_text("yamashita-1"), (old, new))
    assert not jsonschema.Draft202012Validator(schema).is_valid(tomllib.loads(text))
    refused(equipoise("check", written(text)))


# -- new -------------------------------------------------------------------------------------------


def test_new_writes_a_file_that_can_be_analyzed(folder: Path) -> None:
    result = equipoise("new")
    assert (result.status, result.out) == (0, "")
    assert result.err == "wrote machine.toml; next: equipoise analyze machine.toml\n"
    assert [path.name for path in folder.iterdir()] == ["machine.toml"]
    assert analyzed("machine.toml", "--angles", "2")["joints"]
    assert succeeded(equipoise("check", "machine.toml")).endswith(f"{READY}\n")


def test_new_writes_a_study_that_can_be_computed() -> None:
    result = equipoise("new", "--study")
    assert result.err == "wrote study.toml; next: equipoise sweep study.toml -o designs.zarr\n"
    shown = succeeded(equipoise("check", "study.toml"))
    assert "computed many at once" in shown
    assert "ready for: equipoise search study.toml" in shown


def test_new_writes_one_kind_of_file() -> None:
    refuses("new other.toml --study --tool", "--tool and --study are two kinds of files")


def test_every_hint_in_the_new_file_is_valid() -> None:
    """Those of support, rows and motor, and those of a load."""
    assert equipoise("new", "mine.toml").status == 0
    text = Path("mine.toml").read_text(encoding="utf-8")
    before, hints = text.split("# The frame need not")
    hints, after = hints.split("# A load from outside")
    supported = re.sub(r"^# (?=\[|\w+ = )", "", hints, flags=re.MULTILINE)
    written(f"{before}# The frame need not{supported}# A load from outside{after}", to="all.toml")
    shown = succeeded(equipoise("check", "all.toml"))
    parts = ("support: 60.00 kg", "mount front", "handle: a gauge", "rows: 2", "motor: 3000 rpm")
    for words in parts:
        assert words in shown
    loads = re.compile(r"^# (\[\[loads\]\]|(?:link|point|force|from|to) = .*)$", re.MULTILINE)
    written(before + loads.sub(r"\1", f"# A load from outside{after}"), to="loaded.toml")
    by_cause = analyzed("loaded.toml", "--angles", "60", "--split")["by_cause"]
    assert any(by_cause["drive_torque"]["load"])


def test_new_leaves_a_file_that_is_there_alone() -> None:
    Path("mine.toml").write_text("mine")
    refuses("new mine.toml", "is there already")
    Path("dangling.toml").symlink_to("nowhere")
    refuses("new dangling.toml", "is there already")
    assert Path("mine.toml").read_text() == "mine"
    refuses("new no/x.toml", "no such file or directory")


def test_new_that_fails_midway_leaves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    refuses("new x.toml", "no space left")


# -- streams ---------------------------------------------------------------------------------------


def test_the_reader_may_stop_early() -> None:
    words = command("analyze", "yamashita-1", "--json", "--angles", "4000")
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as child:
        assert child.stdout is not None
        assert child.stderr is not None
        assert child.stdout.read(8) == b'{"title"'
        child.stdout.close()
        assert child.stderr.read() == b""
        assert child.wait(300) == 0


# The end of a pipe: `test_the_reader_may_stop_early`.
@pytest.mark.exhaustive
def test_pictures_stay_where_nobody_reads_their_list() -> None:
    reader, writer = os.pipe()
    os.close(reader)
    words = command("plot", "yamashita-1", "--only", "linkage", "-o", "pictures")
    done = subprocess.run(words, stdout=writer, stderr=subprocess.PIPE, timeout=300, check=False)
    os.close(writer)
    assert (done.returncode, done.stderr) == (0, b"wrote 1 picture to pictures\n")
    assert Path("pictures/linkage.svg").is_file()


def test_closed_output() -> None:
    words = ["sh", "-c", 'exec "$@" >&-', "sh", *command("check", "yamashita-1")]
    done = subprocess.run(words, stderr=subprocess.PIPE, timeout=300, check=False)
    assert (done.returncode, done.stderr) == (0, b"")


# A full disk leaves nothing: `test_a_full_disk_leaves_nothing`.
@pytest.mark.exhaustive
def test_output_onto_a_full_disk() -> None:
    full = Path("/dev/full")
    if not full.is_char_device():
        pytest.skip("there is no /dev/full")
    with full.open("wb") as stream:
        result = process("analyze", "yamashita-1", capture_output=False, stdout=stream,
                         stderr=subprocess.PIPE)  # fmt: skip
    assert result.status == 2
    assert result.err == "equipoise: the output cannot be written (No space left on device)\n"


@pytest.mark.exhaustive(but=["export yamashita-1 -o x.urdf"])
@pytest.mark.skipif(os.name != "posix", reason="a folder in use cannot be deleted elsewhere")
@pytest.mark.parametrize(
    "line",
    few(["report yamashita-1", "export yamashita-1 -o x.urdf", "mcp"],
        {"report yamashita-1", "export yamashita-1 -o x.urdf"}),
)  # fmt: skip
def test_a_current_folder_that_was_deleted(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "gone"
    folder.mkdir()
    monkeypatch.chdir(folder)
    folder.rmdir()
    said = refused(process(*line.split()))
    assert said.startswith("the current folder does not exist any more; go to another")


@pytest.mark.exhaustive(but=["new m.toml"])
@pytest.mark.skipif(os.name != "posix", reason="a folder in use cannot be deleted elsewhere")
@pytest.mark.parametrize("line", ["new m.toml", "site -o out"])
def test_a_file_in_a_current_folder_that_was_deleted(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder := tmp_path / "gone").mkdir()
    monkeypatch.chdir(folder)
    folder.rmdir()
    said = refused(equipoise(*line.split()))
    assert "cannot be written (the current folder does not exist any more)" in said


# Files instead of a store: the test above.
@pytest.mark.exhaustive
@pytest.mark.skipif(os.name != "posix", reason="a folder in use cannot be deleted elsewhere")
def test_a_store_in_a_current_folder_that_was_deleted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder := tmp_path / "gone").mkdir()
    monkeypatch.chdir(folder)
    folder.rmdir()
    said = refused(process("sweep", "study-of-lengths", "-o", "new.zarr"))
    assert "the store cannot be made (the current folder does not exist any more)" in said


def test_other_mishaps_with_files_name_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of which no command says itself what they are; standard output has no name."""
    gone = Path("gone") / "x"
    monkeypatch.setattr("equipoise.cli._drop_output", lambda: None)  # a terminal's only
    monkeypatch.setattr("equipoise.present.checks.machine_blocks", lambda _: gone.read_bytes())
    said = refused(equipoise("check", "yamashita-1"))
    assert said == f"{str(gone)!r} cannot be used (No such file or directory)"


@pytest.mark.parametrize("columns", [1, 2, 20])
def test_help_in_a_narrow_terminal(columns: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    lines = succeeded(equipoise("analyze", "--help")).splitlines()
    assert any("--angles" in line for line in lines)
    assert max(map(len, lines)) <= 40


SIZES = ["0", "\u00b2", "9" * 5000]


@pytest.mark.exhaustive(but=["LINES-0"])
@pytest.mark.parametrize(
    ("variable", "size"),
    few_together(
        product(["COLUMNS", "LINES"], SIZES),
        [*zip(("LINES", "COLUMNS", "COLUMNS"), SIZES, strict=True)],
    ),
)
def test_help_where_the_size_of_the_terminal_is_no_size(variable: str, size: str) -> None:
    """The last has more digits than Python takes as a number."""
    environment = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
    assert succeeded(process("--help", env={**environment, variable: size})) == helps()["--help"]


def test_names_of_files_are_printed_in_plain_signs() -> None:
    name = "a\x1b[31mb"
    result = equipoise("plot", "yamashita-1", "-o", name, "--only", "linkage")
    assert "\x1b" not in succeeded(result) + result.err
    assert Path(name).is_dir()


def test_json_refuses_what_is_not_finite() -> None:
    values = {"gauges": {"seat": np.array([1.0, np.inf])}}
    with refusals.refused(UsageError, place="gauges.seat[2]"):
        json_text(values)


def test_everything_is_written_or_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """A table that cannot be shown, after all files were written."""

    def broken(*_: object, **__: object) -> None:
        raise UsageError("a figure is missing")

    monkeypatch.setattr("equipoise.present.terminal._Printer.table", broken)
    files = ("-o", "new.toml", "--csv", "b.csv", "--plot", "pictures")
    words = ("balance", "balance-crank", "--full", *files)
    assert refused(equipoise(*words)) == "a figure is missing"
    assert not list(Path().iterdir())


@pytest.mark.skipif(os.name != "posix", reason="needs a shell that limits the sizes of files")
def test_a_full_disk_leaves_nothing() -> None:
    """Files of more than 4 kB cannot be written; the model would have been a small one."""
    words = command("balance", "balance-crank", "-o", "new.toml", "--plot", "pictures")
    limited = ["sh", "-c", 'ulimit -f 8; exec "$@"', "sh", *words]
    # Python would cut off the bytecode of what it compiles, and fail of it from then on.
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        limited, capture_output=True, encoding="utf-8", timeout=300, check=False, env=environment
    )
    assert done.returncode == 2
    assert done.stderr.startswith("equipoise: pictures/")
    assert "the file cannot be written (file too large)" in done.stderr
    assert not list(Path().iterdir())


def test_a_command_that_takes_long_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    reported = threading.Event()

    def slowly(*_: object) -> None:
        assert reported.wait(300)

    class Heard(io.StringIO):
        def write(self, text: str) -> int:
            reported.set()
            return super().write(text)

    monkeypatch.delenv("EQUIPOISE_PROGRESS")
    monkeypatch.setattr("equipoise.cli.SIGN", 0.01)
    monkeypatch.setattr("equipoise.vibration.forced.respond", slowly)
    monkeypatch.setattr("sys.stderr", heard := Heard())
    with pytest.raises(AttributeError):  # there is nothing to show
        run(["respond", "yamashita-rig"])
    assert re.match(r"still computing, \d+ s\n", heard.getvalue())


def test_long_work_between_two_steps_says_how_far_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """A line that was told long ago does not count."""
    reported = threading.Event()

    class Heard(io.StringIO):
        def write(self, text: str) -> int:
            done = super().write(text)
            if "step 3 of 40" in self.getvalue():
                reported.set()
            return done

    def balanced(*_: object, progress: Any, **__: object) -> None:
        progress(3, 40)
        assert reported.wait(300)

    monkeypatch.delenv("EQUIPOISE_PROGRESS")
    monkeypatch.setattr("equipoise.cli.SIGN", 0.05)
    monkeypatch.setattr("equipoise.balancing.optimisation.balance", balanced)
    monkeypatch.setattr("sys.stderr", heard := Heard())
    with pytest.raises(AttributeError):  # there is nothing to show
        run(["balance", "balance-crank"])
    assert re.search(r"^still computing, \d+ s; step 3 of 40$", heard.getvalue(), re.MULTILINE)


def test_no_silence_is_longer_than_the_longest_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    """A line of progress shortly before a sign of life does not put that off for twice as long."""
    now, moments = [0.0], [0.0]
    lines, ended = [25.0, 110.0, 190.0, 400.0], threading.Event()

    class Clock(threading.Event):
        def wait(self, timeout: float | None = None) -> bool:
            now[0] += timeout or 0.0
            moments.extend(at for at in lines if moments[-1] < at <= now[0])
            if now[0] > 600:
                ended.set()
            return ended.is_set()

    class Heard(io.StringIO):
        def write(self, text: str) -> int:
            if "still computing" in text:
                moments.append(now[0])
            return super().write(text)

    def last_line() -> float:
        return max((at for at in lines if at <= now[0]), default=0.0)

    monkeypatch.delenv("EQUIPOISE_PROGRESS")
    monkeypatch.setattr("equipoise.cli.progress.last_line", last_line)
    monkeypatch.setattr("equipoise.cli.monotonic", lambda: now[0])
    monkeypatch.setattr("equipoise.cli.Event", Clock)
    monkeypatch.setattr("sys.stderr", Heard())
    with _signs_of_life(["check"]):
        assert ended.wait(300)
    gaps = [after - before for before, after in pairwise(moments)]
    assert len(gaps) > 12
    assert max(gaps) <= RAREST, moments


def test_linear_algebra_takes_no_thread_beside_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("_collect_later", "_limit_memory"):  # which are for a process of its own
        monkeypatch.setattr(f"equipoise.cli.{name}", lambda: None)
    monkeypatch.setattr(signal, "signal", lambda *_: None)
    monkeypatch.setattr(sys, "stdout", io.StringIO())
    texts = []
    monkeypatch.setattr("equipoise.cli.run", lambda: texts.extend(map(os.getenv, ONE_THREAD)))
    kept = {name: value for name, value in os.environ.items() if name not in ONE_THREAD}
    there = mock.patch.dict(os.environ, {**kept, ONE_THREAD[0]: "3"}, clear=True)
    with there, pytest.raises(SystemExit):
        main()
    assert texts == ["3", "1", "1"]
