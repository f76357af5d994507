"""Every command as a user runs it."""

from __future__ import annotations

import csv
import json
import math
import re
import subprocess
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

import equipoise as package
from surface.running import (
    EXAMPLES,
    READY,
    STUDIES,
    TOOLS,
    command,
    equipoise,
    example,
    example_text,
    process,
    refused,
    succeeded,
    told,
)

ROOT = Path(__file__).parents[2]
COMMANDS = (
    *["analyze", "animate", "balance", "best", "check", "decay", "examples", "export"],
    *["exposure", "modes", "new", "plant", "plot", "report", "respond", "resume", "schema"],
    *["search", "serve", "simulate", "sweep", "tolerance", "tool"],
)
LINK_KEYS = ["angle", "angular_velocity", "angular_acceleration"]
POINT_KEYS = ["x", "y", "vx", "vy", "ax", "ay"]
MASSES = re.compile(r"^(mass|center_of_mass|inertia) = .*\n", re.MULTILINE)


def no_constant(text: str) -> None:
    raise AssertionError(f"{text} is not JSON")


def analyzed(*arguments: str | Path) -> dict[str, Any]:
    """Return what `equipoise analyze ... --json` prints, and check that it prints only that."""
    result = equipoise("analyze", *arguments, "--json")
    assert result.err == ""
    content = json.loads(succeeded(result), parse_constant=no_constant)
    assert result.out.count("\n") == 1
    return content  # type: ignore[no-any-return]


@pytest.fixture
def massless(tmp_path: Path) -> Path:
    """A model file without masses."""
    path = tmp_path / "massless.toml"
    path.write_text(MASSES.sub("", example_text("yamashita-1")), encoding="utf-8")
    return path


# -- in general ------------------------------------------------------------------------------------


def test_version() -> None:
    result = process("--version")
    assert (result.status, result.out, result.err) == (0, f"{package.__version__}\n", "")


def test_help_names_every_command() -> None:
    for result in (told("--help"), told("-h"), told()):
        listed = re.findall(r"^[│|] ([a-z]+) ", succeeded(result), re.MULTILINE)
        assert sorted(listed) == sorted(COMMANDS)


DRAWN = ["--json", "--plot", "--format"]
OUTPUTS = [*DRAWN, "--csv"]
FREED = [
    *["--move-cm", "--crank-counterweight", "--counterweight", "--geared-counterweight"],
    *["--ratio", "--pitch-radius", "--shape", "--radius", "--mass", "--at-most", "--thickness"],
    *["--material", "--phases"],
]
OPTIONS = {
    "analyze": [
        *["FILE", "--angles", "--speed", "--acceleration", "--about", "--split", "--csv"],
        *["--orders", "--crank-zero", "--json"],
    ],
    "animate": [
        *["FILE", "--out", "--seconds", "--turns", "--width", "--trace", "--force", "--speed"],
        *["--dark"],
    ],
    "balance": ["FILE", "--objective", "--limit", "--speed", "--out", *OUTPUTS, *FREED],
    "balance arrangements": ["FILE", "ROWS", "--spacing", "--speed", "--json"],
    "balance conditions": ["FILE", "--speed", "--json"],
    "balance sensitivities": ["FILE", "OUTPUT", "--crank-zero", "--speed", "--json"],
    "balance trade-off": [
        *["FILE", "FIRST", "SECOND", "--points", "--limit", "--speed", *OUTPUTS, *FREED],
    ],
    "best": ["STORE", "--by", "--largest", "--count", "--out", "--design", *OUTPUTS],
    "check": ["FILE"],
    "decay": ["CSV", "--stiffness", "--arm", "--spring-arm", "--confidence", *DRAWN],
    "examples": [],
    "export": ["STORE", "--out", "--kept"],
    "exposure": [
        *["INPUT", "--duration", "--idle", "--racing", "--bands", "--weighted", "--single-axis"],
        *["--periodic", *DRAWN],
    ],
    "modes": ["FILE", "--model", *DRAWN],
    "new": ["FILE", "--tool", "--study"],
    "plant": ["FILE", "--speed", "--crank-zero", "--angles", "--units", *OUTPUTS],
    "plant fit": ["FILE", "TARGETS", "--out", "--seed", "--speed", "--units", *OUTPUTS],
    "plot": ["FILE", "--out", "--format", "--only", "--output", "--at", "--speed"],
    "plot map": [
        *["FILE", "FIRST", "SECOND", "OUTPUT", "--set", "--points", "--speed", "--out"],
        "--format",
    ],
    "report": ["FILE", "--out", "--language", "--pdf", "--speed"],
    "respond": ["FILE", "--model", "--speed", "--speeds", "--drive", "--units", *OUTPUTS],
    "resume": ["STORE", "--workers", "--cluster", "--json"],
    "schema": ["--tool", "--study"],
    "search": [
        *["STUDY", "--population", "--generations", "--seed", "--out", "--design", *OUTPUTS],
    ],
    "serve": ["FILE", "--port", "--no-browser"],
    "simulate": ["FILE", "DURATION", "--speed", "--drive", "--units", *OUTPUTS],
    "sweep": ["STUDY", "--out", "--workers", "--cluster", "--json"],
    "tolerance": ["STUDY", "--designs", *DRAWN],
    "tool": [
        *["FILE", "--modes", "--number", "--respond", "--speeds", "--at", "--exposure"],
        *["--duration", "--units", *OUTPUTS],
    ],
    "tool design": ["FILE", "--out", "--units", *DRAWN],
    "tool sensitivities": ["FILE", "--speeds", "--units", "--json"],
    "tool vary": ["FILE", "CHANGE", "--number", "--units", *DRAWN],
}


@pytest.mark.parametrize("name", OPTIONS)
def test_help_of_a_command_tells_each_option(name: str) -> None:
    text = succeeded(told(*name.split(), "--help"))
    assert text.startswith(f"Usage: equipoise {name}")
    shown = re.findall(r"^[│|] \*? *([A-Z]+|--[a-z-]+) +\S", text, re.MULTILINE)
    assert shown == OPTIONS[name]
    assert [line for line in text.splitlines() if len(line) > 80] == []


@pytest.mark.parametrize("name", COMMANDS)
def test_the_tour_shows_every_command(name: str) -> None:
    tour = (ROOT / "docs" / "tour.md").read_text(encoding="utf-8")
    assert re.search(rf"\bequipoise {name}\b", tour), f"docs/tour.md lacks `equipoise {name}`"


@pytest.mark.parametrize("page", ["README.md", "docs/tour.md"])
def test_no_page_shows_a_command_that_does_not_exist(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    shown = set(re.findall(r"^(?:\$ )?equipoise ([a-z]+)", text, re.MULTILINE))
    assert shown and shown <= {*COMMANDS}


# -- examples, check -------------------------------------------------------------------------------


def test_examples_are_listed_with_their_titles() -> None:
    lines = succeeded(equipoise("examples")).splitlines()
    listed = dict(line.split(maxsplit=1) for line in lines)
    assert listed == {name: example(name)["title"] for name in (*EXAMPLES, *TOOLS, *STUDIES)}


@pytest.mark.parametrize("name", EXAMPLES)
def test_check_of_an_example(name: str) -> None:
    lines = succeeded(equipoise("check", name)).splitlines()
    assert lines[0] == example(name)["title"]
    assert lines[-1] == READY
    assert f"driven: {example(name)['drive']['link']} at" in lines[1]


def test_check_tells_the_build_up() -> None:
    text = succeeded(equipoise("check", "watt-six-bar"))
    assert "  coupler and rocker: dyad; joints B (pin on crank), D (pin on frame)" in text
    assert "by Newton's method" in succeeded(equipoise("check", "class-three"))
    assert "geared" in succeeded(equipoise("check", "geared-counterweight"))


def test_check_of_a_model_without_masses(massless: Path) -> None:
    assert re.search(r"^note: .*mass", succeeded(equipoise("check", massless)), re.MULTILINE)


def test_a_file_beats_the_example_of_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("yamashita-1").write_text(example_text("quick-return"), encoding="utf-8")
    assert succeeded(equipoise("check", "yamashita-1")).startswith("Quick-return")


# -- analyze: the tables ---------------------------------------------------------------------------


@pytest.mark.parametrize("name", EXAMPLES)
def test_tables_of_an_example(name: str) -> None:
    result = equipoise("analyze", name)
    text = succeeded(result)
    assert text.startswith(f"{example(name)['title']}\n")
    for title in ("Links", "Moving points", "On frame and drive", "Force in each joint"):
        assert re.search(rf"^{title}", text, re.MULTILINE)
    for row in ("shaking force x", "shaking moment", "drive torque", *example(name)["links"]):
        assert re.search(rf"^(one row: )?{row}[, ]", text, re.MULTILINE)
    assert "nan" not in text
    assert result.err == ""


def test_tables_of_a_model_without_masses(massless: Path) -> None:
    text = succeeded(equipoise("analyze", massless))
    assert re.search(r"^coupler ", text, re.MULTILINE)
    assert re.search(r"^note: .*mass", text, re.MULTILINE)
    assert "shaking force" not in text


def test_a_process_prints_the_same_as_a_call() -> None:
    result = process("analyze", "yamashita-1")
    assert result.err == ""
    assert result.out == equipoise("analyze", "yamashita-1").out


def test_markup_in_names_is_shown_as_it_stands(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    text = example_text("yamashita-1").replace("links.coupler", "links.'[bold]coupler[/]'")
    path.write_text(text.replace("Planting", "[red]Planting"), encoding="utf-8")
    for name in ("check", "analyze"):
        text = succeeded(equipoise(name, path))
        assert text.startswith("[red]Planting")
        assert "[bold]coupler[/]" in text


def test_control_characters_do_not_reach_the_terminal(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    text = example_text("yamashita-1")
    for changed in (
        text.replace("links.coupler", r'links."\u001b[31mcoupler"'),
        text.replace("Planting", r"\u001b[2J\u0007"),
    ):
        path.write_text(changed, encoding="utf-8")
        for name in ("check", "analyze"):
            line = refused(equipoise(name, path))
            assert line.isprintable()
            assert "give printable characters" in line


# -- analyze: JSON and CSV -------------------------------------------------------------------------


@pytest.mark.parametrize("name", EXAMPLES)
def test_json_has_the_documented_shape(name: str) -> None:
    count = 8
    content = analyzed(name, "--angles", str(count))
    model = example(name)
    total = count * content["turns"]
    assert content["title"] == model["title"]
    assert content["crank_angle"] == pytest.approx([k * math.tau / count for k in range(total)])
    assert set(content["links"]) == set(model["links"])
    bodies = [model["frame"], *model["links"].values()]
    assert set(content["points"]) == {point for body in bodies for point in body["points"]}
    assert all(list(link) == LINK_KEYS for link in content["links"].values())
    assert all(list(point) == POINT_KEYS for point in content["points"].values())
    assert content["joints"]
    arrays = [
        *(values for link in content["links"].values() for values in link.values()),
        *(values for point in content["points"].values() for values in point.values()),
        *(joint[key] for joint in content["joints"].values() for key in ("force_x", "force_y")),
        *(content["shaking_force"][key] for key in "xy"),
        content["shaking_moment"],
        content["drive_torque"],
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


def test_json_of_a_model_without_masses(massless: Path) -> None:
    content = analyzed(massless, "--angles", "3")
    assert set(content["links"]) == {"crank", "coupler", "rocker"}
    assert len(content["points"]["P"]["ax"]) == 3
    assert "mass" in content["missing"]
    assert not {"joints", "shaking_force", "shaking_moment", "drive_torque"} & set(content)


def test_json_of_a_process_is_all_of_its_output() -> None:
    result = process("analyze", "yamashita-1", "--json", "--angles", "3")
    assert result.err == ""
    assert json.loads(result.out) == analyzed("yamashita-1", "--angles", "3")


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_output_in_a_terminal_that_lacks_letters(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, encoding: str
) -> None:
    monkeypatch.setenv("PYTHONIOENCODING", encoding)
    path = tmp_path / "model.toml"
    path.write_text(example_text("yamashita-1").replace("Planting", "Überträger 机"), "utf-8")
    text = process("analyze", path, "--json", "--angles", "1", encoding=encoding).out
    assert json.loads(text)["title"].startswith("Überträger 机 mechanism")
    assert succeeded(process("check", path, encoding=encoding)).endswith(f"{READY}\n")
    assert json.loads(process("schema", encoding=encoding).out)


def split_by_dots(content: dict[str, Any], column: str) -> Any:
    """Return the array that a column's name stands for."""
    value: Any = content
    for part in column.split("."):
        value = value[part]
    return value


@pytest.mark.parametrize("name", ["yamashita-1", "slider-crank-engine", "geared-counterweight"])
def test_csv_has_the_numbers_of_the_json(name: str, tmp_path: Path) -> None:
    path = tmp_path / "result.csv"
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


def test_csv_stands_beside_the_tables(tmp_path: Path) -> None:
    path = tmp_path / "result.csv"
    path.write_text("old")
    result = equipoise("analyze", "yamashita-1", "--csv", path)
    assert succeeded(result) == equipoise("analyze", "yamashita-1").out
    assert len(path.read_text().splitlines()) == 361
    assert list(tmp_path.iterdir()) == [path]


# -- analyze: options ------------------------------------------------------------------------------


def test_angles_by_number_cover_whole_cycles(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    text = example_text("planetary-planting-arm").replace("teeth = [40, 20]", "teeth = [40, 30]")
    path.write_text(text, encoding="utf-8")
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
    one, two = (
        analyzed("yamashita-1", "--angles", "12", "--speed", speed)
        for speed in ("100 rpm", "-200 rpm")
    )
    assert two["speed"] == pytest.approx(-2 * one["speed"])
    for place in ("shaking_force.x", "shaking_force.y", "shaking_moment", "points.P.ax"):
        slow, fast = (np.array(split_by_dots(content, place)) for content in (one, two))
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


def test_schema_is_the_shipped_file(schema: dict[str, Any]) -> None:
    shipped = Path(package.__file__).with_name("schema") / "model.schema.json"
    assert schema == json.loads(shipped.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)


@pytest.mark.parametrize("kind", ["tool", "study"])
def test_schemas_of_other_files_are_the_shipped_ones(kind: str) -> None:
    shipped = Path(package.__file__).with_name("schema") / f"{kind}.schema.json"
    found = json.loads(succeeded(equipoise("schema", f"--{kind}")))
    assert found == json.loads(shipped.read_text(encoding="utf-8"))


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
def test_schema_refuses_what_the_reader_refuses(
    old: str, new: str, schema: dict[str, Any], tmp_path: Path
) -> None:
    import tomllib

    text = example_text("yamashita-1")
    assert old in text
    text = text.replace(old, new, 1)
    assert not jsonschema.Draft202012Validator(schema).is_valid(tomllib.loads(text))
    path = tmp_path / "model.toml"
    path.write_text(text, encoding="utf-8")
    refused(equipoise("check", path))


# -- new -------------------------------------------------------------------------------------------


def test_new_writes_a_file_that_can_be_analyzed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = equipoise("new")
    assert (result.status, result.out) == (0, "")
    assert result.err == "wrote machine.toml; next: equipoise analyze machine.toml\n"
    assert [path.name for path in tmp_path.iterdir()] == ["machine.toml"]
    assert analyzed("machine.toml", "--angles", "2")["joints"]
    assert succeeded(equipoise("check", "machine.toml")).endswith(f"{READY}\n")


def test_new_writes_a_study_that_can_be_computed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = equipoise("new", "--study")
    assert result.err == "wrote study.toml; next: equipoise sweep study.toml -o designs.zarr\n"
    shown = succeeded(equipoise("check", "study.toml"))
    assert "computed many at once" in shown
    assert "ready for: equipoise search study.toml" in shown
    said = refused(equipoise("new", "other.toml", "--study", "--tool"))
    assert said == "--tool and --study are two kinds of files; give one of them"
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


def test_every_hint_in_the_new_file_is_valid(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    assert equipoise("new", path).status == 0
    loads = re.compile(r"^# (\[\[loads\]\]|(?:link|point|force|from|to) = .*)$", re.MULTILINE)
    head, tail = path.read_text(encoding="utf-8").split("# A load from outside")
    path.write_text(head + loads.sub(r"\1", "# A load from outside" + tail), encoding="utf-8")
    by_cause = analyzed(path, "--angles", "60", "--split")["by_cause"]
    assert any(by_cause["drive_torque"]["load"])


def test_new_leaves_a_file_that_is_there_alone(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("mine")
    assert "is there already" in refused(equipoise("new", path))
    dangling = tmp_path / "dangling.toml"
    dangling.symlink_to(tmp_path / "nowhere")
    assert "is there already" in refused(equipoise("new", dangling))
    assert path.read_text() == "mine"
    assert sorted(tmp_path.iterdir()) == [dangling, path]


def test_new_in_a_missing_folder_leaves_nothing(tmp_path: Path) -> None:
    assert "no such file or directory" in refused(equipoise("new", tmp_path / "no" / "x.toml"))
    assert list(tmp_path.iterdir()) == []


def test_new_that_fails_midway_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    assert "no space left" in refused(equipoise("new", tmp_path / "x.toml"))
    assert list(tmp_path.iterdir()) == []


# -- streams ---------------------------------------------------------------------------------------


def test_the_reader_may_stop_early() -> None:
    words = command("analyze", "yamashita-1", "--json", "--angles", "20000")
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as child:
        assert child.stdout is not None
        assert child.stderr is not None
        assert child.stdout.read(8) == b'{"title"'
        child.stdout.close()
        assert child.stderr.read() == b""
        assert child.wait(60) == 0


def test_closed_output() -> None:
    words = ["sh", "-c", 'exec "$@" >&-', "sh", *command("check", "yamashita-1")]
    done = subprocess.run(words, stderr=subprocess.PIPE, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, b"")


def test_output_onto_a_full_disk() -> None:
    full = Path("/dev/full")
    if not full.is_char_device():
        pytest.skip("there is no /dev/full")
    with full.open("wb") as stream:
        result = process("analyze", "yamashita-1", capture_output=False, stdout=stream,
                         stderr=subprocess.PIPE)  # fmt: skip
    assert result.status == 2
    assert result.err == "equipoise: the output cannot be written (No space left on device)\n"
