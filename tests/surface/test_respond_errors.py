"""What `equipoise respond` and `modes` refuse, and what they make of supports that are odd."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest

from surface.running import equipoise, example_text, refused, succeeded

RIG = "yamashita-rig"
MODELS = ("linear", "torque", "moment", "coupled", "exact")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Every test runs in an empty folder of its own."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def no_constant(text: str) -> None:
    raise AssertionError(f"{text} is not JSON")


def file(*changes: tuple[str, str], name: str = RIG) -> str:
    """An example as a file here, with pieces of its text replaced."""
    text = example_text(name)
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    Path("model.toml").write_text(text, encoding="utf-8")
    return "model.toml"


# -- words -----------------------------------------------------------------------------------------

RANGE = "slower one first"
REFUSED = {
    # words after `respond`, what is said
    "no support": (["yamashita-1"], "yamashita-1: support: the machine stands on solid ground; ad"),
    "no support, range": (["yamashita-1", "--speed", "20:300 rpm"], "stands on solid ground; add "),
    "no file": (["nothing.toml"], "nothing.toml: there is no such file; give a path, or the name"),
    "unknown option": ([RIG, "--spede", "3 rpm"], "--spede"),
    "speed 0": ([RIG, "--speed", "0 rpm"], "--speed: got '0 rpm'; a crank that stands still"),
    "no unit": ([RIG, "--speed", "193"], "--speed: got '193'; the unit is missing; give an angula"),
    "wrong unit": ([RIG, "--speed", "3 m/s"], "--speed: got '3 m/s'; m/s is the unit of a speed"),
    "no number": ([RIG, "--speed", "nan rpm"], "--speed: got 'nan rpm'; give a finite number"),
    "empty": ([RIG, "--speed", ""], "--speed: got ''; give a speed, \"193 rpm\", or a range"),
    "three parts": ([RIG, "--speed", "1:2:3 rpm"], "--speed: got '1:2:3 rpm'; give a speed"),
    "half a range": ([RIG, "--speed", "20 rpm :"], "--speed: got '20 rpm :'; give a speed"),
    "other half": ([RIG, "--speed", ": 20 rpm"], "--speed: got ': 20 rpm'; give a speed"),
    "no unit at all": ([RIG, "--speed", "20:300"], "--speed: got '300'; the unit is missing"),
    "no second unit": ([RIG, "--speed", "20 rpm : 300"], "--speed: got '300'; the unit is missing"),
    "reversed": ([RIG, "--speed", "300 rpm : 20 rpm"], RANGE),
    "reversed backwards": ([RIG, "--speed", "-300:-20 rpm"], RANGE),
    "range of one": ([RIG, "--speed", "20:20 rpm"], RANGE),
    "range from 0": ([RIG, "--speed", "0:20 rpm"], RANGE),
    "two senses": ([RIG, "--speed", "-20:30 rpm"], RANGE),
    "speeds alone": ([RIG, "--speeds", "9"], "--speeds belongs to a range, --speed \"20 rpm :"),
    "speeds of one": ([RIG, "--speed", "9 rpm", "--speeds", "9"], "--speeds belongs to a range"),
    "one speed": ([RIG, "--speed", "20:30 rpm", "--speeds", "1"], "--speeds: got '1'; give"),
    "less": ([RIG, "--speed", "20:30 rpm", "--speeds", "-2"], "--speeds: got '-2'; give"),
    "many speeds": ([RIG, "--speed", "2:3 rpm", "--speeds", "20001"], "got '20001'; give"),
    "text": ([RIG, "--speed", "20:30 rpm", "--speeds", "many"], "--speeds"),
    "no motor": (["yamashita-rig-counterweight", "--drive"], "drive.motor: missing; give its no_l"),
    "linear motor": ([RIG, "--drive", "--model", "linear"], "the motor in the model exact, not in"),
    "motor in space": (["riding-transplanter", "--drive"], "riding-transplanter: drive.motor: mi"),
    "exact in space": (
        ["riding-transplanter", "--model", "exact"],
        "riding-transplanter: support.freedoms: the model exact is for motion in the plane",
    ),
    "coupled in space": (["riding-transplanter", "--model", "coupled"], "the model coupled is for"),
    "unknown model": ([RIG, "--model", "best"], "--model"),
    "format alone": ([RIG, "--format", "png"], "--format belongs to --plot; give both"),
    "kind": ([RIG, "--plot", "new", "--format", "gif"], "--format"),
    "no folder's name": ([RIG, "--plot", ""], "--plot: got ''; give the name of a folder"),
    "csv nowhere": ([RIG, "--csv", "no/x.csv"], "--csv: no/x.csv: there is no such folder; make i"),
    "csv is a folder": ([RIG, "--csv", "."], "--csv: . is a directory; give the name of a file"),
    "csv without name": ([RIG, "--csv", ""], "--csv: got an empty name; give the name of a file"),
    "units": ([RIG, "--units", "furlong"], "--units: got 'furlong'; choose among m, mm"),
    "unprinted unit": ([RIG, "--units", "mm, kg"], "--units: got 'kg'; choose among m, mm"),
    "two units": ([RIG, "--units", "mm, cm"], "--units: got 'mm' and 'cm', both units of length"),
}  # fmt: skip


FROM_REST = {
    "no support": (["yamashita-1", "1 s"], "yamashita-1: support: the machine stands on solid gro"),
    "in space": (["riding-transplanter", "1 s"], "the model exact is for motion in the plane"),
    "a range": ([RIG, "1 s", "--speed", "20:30 rpm"], "--speed: got '20:30 rpm'"),
    "backwards in time": ([RIG, "-1 s"], "DURATION: got '-1 s'; give a time of more than 0"),
    "no time": ([RIG, "0 s"], "DURATION: got '0 s'; give a time of more than 0"),
    "an age": ([RIG, "1e9 s"], "give a time of more than 0 and at most 2000 turns"),
    "no time's unit": ([RIG, "5"], "DURATION: got '5'; the unit is missing"),
    "time's unit": ([RIG, "5 rpm"], "DURATION: got '5 rpm'; rpm is the unit of"),
}


@pytest.mark.parametrize(("words", "said"), FROM_REST.values(), ids=FROM_REST)
def test_refused_from_rest(words: list[str], said: str) -> None:
    assert said in refused(equipoise("simulate", *words))
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize(("words", "said"), REFUSED.values(), ids=REFUSED)
def test_refused(words: list[str], said: str) -> None:
    assert said in refused(equipoise("respond", *words))
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize(
    "words",
    [["--speeds", "1", "--speed", "20:30 rpm"], ["--speed", "0 rpm"]],
)
def test_the_sentence_names_the_option(words: list[str]) -> None:
    line = refused(equipoise("respond", RIG, *words))
    assert words[0] in line
    assert "; give" in line


MODES = {
    "no support": (["yamashita-1"], "yamashita-1: support: the machine stands on solid ground; ad"),
    "unknown model": ([RIG, "--model", "best"], "--model"),
    "format alone": ([RIG, "--format", "png"], "--format belongs to --plot; give both"),
    "csv": ([RIG, "--csv", "x.csv"], "--csv"),
    "no file": (["nothing.toml"], "nothing.toml: there is no such file"),
}  # fmt: skip


@pytest.mark.parametrize(("words", "said"), MODES.values(), ids=MODES)
def test_refused_by_modes(words: list[str], said: str) -> None:
    assert said in refused(equipoise("modes", *words))
    assert list(Path().iterdir()) == []


ORDERS = {
    "zero alone": (["--crank-zero", "9 deg"], "--crank-zero belongs to --orders; give both"),
    "no orders": (["--orders", "0"], "--orders: got '0'; give a whole number from 1 to 100"),
    "fewer": (["--orders", "-1"], "--orders: got '-1'; give a whole number from 1 to 100"),
    "many": (["--orders", "101"], "--orders: got '101'; give a whole number from 1 to 100"),
    "text": (["--orders", "all"], "--orders"),
    "no unit": (["--orders", "3", "--crank-zero", "9"], "--crank-zero: got '9'; the unit is missi"),
    "wrong unit": (["--orders", "3", "--crank-zero", "9 m"], "--crank-zero: got '9 m'; m is the u"),
    "some angles": (["--orders", "3", "--angles", "0 deg, 9 deg"], "over the whole cycle; give a"),
}  # fmt: skip


@pytest.mark.parametrize(("words", "said"), ORDERS.values(), ids=ORDERS)
def test_orders_that_cannot_be(words: list[str], said: str) -> None:
    assert said in refused(equipoise("analyze", "yamashita-1", *words, "--csv", "x.csv"))
    assert list(Path().iterdir()) == []


def test_orders_without_masses() -> None:
    text = re.sub(r"(?m)^(mass|center_of_mass|inertia) = .*\n", "", example_text("yamashita-1"))
    Path("model.toml").write_text(text, encoding="utf-8")
    line = refused(equipoise("analyze", "model.toml", "--orders", "3"))
    assert line.startswith("model.toml: forces need mass, center_of_mass and inertia of every link")


# -- files -----------------------------------------------------------------------------------------


def test_results_do_not_take_the_place_of_what_they_come_from() -> None:
    """Neither the model nor the motor's table."""
    curve = "speed [rpm],torque [N m]\n0,1.2\n1500,0\n"
    Path("motor.csv").write_text(curve, encoding="utf-8")
    old = 'no_load_speed = "1500 rpm"\nstall_torque = "1.2 N m"'
    text = Path(file((old, 'table = "motor.csv"'))).read_text(encoding="utf-8")
    assert json.loads(succeeded(equipoise("respond", "model.toml", "--drive", "--json")))
    for name, content in (("model.toml", text), ("motor.csv", curve)):
        line = refused(equipoise("respond", "model.toml", "--csv", f"./{name}"))
        assert line == f"--csv: ./{name} is what is to be analysed; give another name"
        assert Path(name).read_text(encoding="utf-8") == content


@pytest.mark.parametrize("command", ["respond", "modes"])
def test_pictures_do_not_take_the_place_of_a_file(command: str) -> None:
    Path("file").write_text("mine")
    assert "give the name of a folder" in refused(equipoise(command, RIG, "--plot", "file"))
    assert "'file/new'; give" in refused(equipoise(command, RIG, "--plot", "file/new"))
    assert Path("file").read_text() == "mine"
    assert [path.name for path in Path().iterdir()] == ["file"]


# -- machines that cannot --------------------------------------------------------------------------

SPRING = """[support.mounts.spring]
point = ["10 mm", "0 mm"]             # L_E = 1.35 m from O
stiffness = "182 kgf/m"
"""
BEARING = """[support.mounts.bearing]
axis = "pitch"
torsional_damping = "0.333 kgf m s/rad"
"""
GAUGE = """[support.gauges.gauge]
point = ["160 mm", "0 mm"]            # 1.5 m from O
"""
FLAT = ("schema = 1\n", 'schema = 1\ngravity = ["0 m/s^2", "0 m/s^2"]\n')
UNCARRIED = "support.mounts: they do not carry the weight in pitch; add a mount there"
CANNOT = {
    # changes, words, what is said of the file
    "massless": ([('mass = "199 g"\ncenter_of_mass = ["12 mm", "0 mm"]\ninertia = "30 kg mm^2"  '
                   "              # assumed\n", "")], "forces need mass, center_of_mass and inert"),
    "no spring": ([(SPRING, "")], UNCARRIED),
    "no mounts": ([(SPRING, ""), (BEARING, "")], UNCARRIED),
    "cannot turn": ([('points.B = ["33.5 mm", ', 'points.B = ["70 mm", ')], "the crank cannot tur"),
    "pushed away": ([FLAT, (SPRING, "")], "a constant force drives the support away in pitch"),
}  # fmt: skip


@pytest.mark.parametrize(("changes", "said"), CANNOT.values(), ids=CANNOT)
@pytest.mark.parametrize(
    "words", [(), ("--model", "exact"), ("--drive",), ("--speed", "20:30 rpm"), ("--json",)]
)
def test_a_machine_that_cannot(
    changes: list[tuple[str, str]], said: str, words: tuple[str, ...]
) -> None:
    line = refused(equipoise("respond", file(*changes), *words, "--csv", "out.csv"))
    assert line.startswith("model.toml: ")
    assert said in line
    assert [path.name for path in Path().iterdir()] == ["model.toml"]


@pytest.mark.parametrize("kind", ["massless", "no spring", "no mounts", "cannot turn"])
@pytest.mark.parametrize("words", [("modes",), ("modes", "--json"), ("simulate", "1 s")])
def test_modes_and_the_way_from_rest_of_such_a_machine(kind: str, words: tuple[str, ...]) -> None:
    changes, said = CANNOT[kind]
    line = refused(equipoise(words[0], file(*changes), *words[1:]))
    assert line.startswith("model.toml: ")
    assert said in line


def test_a_motor_that_never_pulls() -> None:
    """A curve that rises everywhere has no speed at which it settles."""
    Path("motor.csv").write_text("speed [rpm],torque [N m]\n0,1\n1500,2\n", encoding="utf-8")
    old = 'no_load_speed = "1500 rpm"\nstall_torque = "1.2 N m"'
    line = refused(equipoise("respond", file((old, 'table = "motor.csv"')), "--drive"))
    assert line.startswith("model.toml: drive.motor: its torque nowhere falls through")
    assert "give a stronger motor" in line


def test_a_motor_too_weak_to_turn_the_crank() -> None:
    """Which stands still before the first turn is over: no speed follows from it."""
    weak = ('"1.2 N m"', '"1e-6 N m"\nmean_speed = "free"')
    bare = ('inertia = "400 g cm^2"\n', "")
    line = refused(equipoise("respond", file(weak, bare), "--drive"))
    assert line.startswith("model.toml: ")


HELD = """
[support]
mass = "60 kg"
center_of_mass = ["0 mm", "-100 mm"]
inertia = "4 kg m^2"
freedoms = ["{0}"]

[support.mounts.spring]
point = ["0 mm", "0 mm"]
direction = "{1} deg"
stiffness = "5 kN/m"
"""
HEAVE, SURGE = HELD.format("heave", 90), HELD.format("surge", 0)
DAMPED = 'damping = "40 N s/m"\n'
WHEEL = """
schema = 1
title = "A wheel"
drive = {{ link = "wheel", speed = "{speed}" }}
frame.points.A = ["0 mm", "0 mm"]

[links.wheel]
points.A = ["0 mm", "0 mm"]
mass = "4 kg"
center_of_mass = ["{eccentric} mm", "0 mm"]
inertia = "300 kg mm^2"
"""


def wheel(support: str, eccentric: float = 10, speed: str = "193 rpm") -> str:
    """An eccentric wheel on a support."""
    Path("model.toml").write_text(WHEEL.format(eccentric=eccentric, speed=speed) + support)
    return "model.toml"


def test_an_undamped_resonance() -> None:
    """64 kg on 1024 N/m: just 4 rad/s, where nothing holds an undamped support."""
    exact = HEAVE.replace('"5 kN/m"', '"1024 N/m"')
    line = refused(equipoise("respond", wheel(exact, speed="4 rad/s"), "--csv", "out.csv"))
    assert line.startswith("model.toml: ")
    assert "resonance without damping at 4 rad/s; give" in line
    assert not Path("out.csv").exists()
    assert json.loads(succeeded(equipoise("respond", wheel(exact), "--json")))


@pytest.mark.parametrize("model", ["linear", "moment", "exact"])
def test_a_range_over_an_undamped_resonance(model: str) -> None:
    """That one speed has no answer does not take away those of the others."""
    exact = HEAVE.replace('"5 kN/m"', '"1024 N/m"')
    words = ("--speed", "3:5 rad/s", "--speeds", "4", "--model", model, "--json")
    content = json.loads(
        succeeded(equipoise("respond", wheel(exact), *words)), parse_constant=no_constant
    )
    values = content["gauges"]["heave"]["peak_to_peak"]
    assert content["resonances"] == [pytest.approx(4)]
    assert values[0] > 0 < values[-1]


PENDULUM = (
    (SPRING + "\n" + BEARING, '[support.mounts.hold]\naxis = "pitch"\ntorsional_stiffness = '
     '"10 N m/rad"\ntorsional_preload = "0 N m"\n'),
    ('pivot = ["-1.34 m", "0 mm"]', 'pivot = ["-0.59 m", "-1 m"]'),
    ('center_of_mass = ["-0.59 m", "0 mm"]', 'center_of_mass = ["-0.618 m", "0 mm"]'),
    ('"19.0479488 kg m^2"', '"50 kg m^2"'),
)  # fmt: skip


def test_a_support_that_falls_over() -> None:
    """It is told of the mode, beside the answer, and seen from rest."""
    path = file(*PENDULUM)
    assert "unstable: falls over" in succeeded(equipoise("modes", path))
    content = json.loads(succeeded(equipoise("respond", path, "--json")))
    assert any("falls over" in note for note in content["notes"])
    content = json.loads(succeeded(equipoise("simulate", path, "4 s", "--json")))
    moved = content["gauges"]["gauge"]["displacement"]
    assert abs(moved[-1]) > 100 * abs(moved[100])


# -- odd machines that can -------------------------------------------------------------------------

PLANE = """
[support]
mass = "60 kg"
center_of_mass = ["10 mm", "-100 mm"]
inertia = "4 kg m^2"

[support.mounts.left]
point = ["-400 mm", "-200 mm"]
stiffness = "50 kN/m"
damping = "400 N s/m"

[support.mounts.right]
point = ["400 mm", "-200 mm"]
stiffness = "50 kN/m"
damping = "400 N s/m"
one_sided = true

[support.mounts.along]
point = ["0 mm", "-200 mm"]
direction = "0 deg"
stiffness = "50 kN/m"
damping = "400 N s/m"
"""
CARRIED = ("planetary-planting-arm", "slider-crank-engine", "class-three", "transplanter",
           "geared-counterweight", "quick-return", "scotch-yoke", "kim-chung-b")  # fmt: skip


def every_model(path: str) -> dict[str, Any]:
    """What each model answers; it may say in a sentence why not."""
    found = {}
    for model in MODELS:
        result = equipoise("respond", path, "--model", model, "--json")
        if result.status:
            assert refused(result).startswith(f"{path}: ")
        else:
            content = json.loads(result.out, parse_constant=no_constant)
            assert content["gauges"]
            assert content.get("residual", 0) < 1e-8
            found[model] = content
    for words in (("modes",), ("modes", "--json")):
        assert not re.search(
            r"\b(nan|inf|None)\b", succeeded(equipoise(words[0], path, *words[1:]))
        )
    return found


@pytest.mark.parametrize("name", CARRIED)
def test_any_linkage_on_a_support(name: str) -> None:
    """Geared ones with cycles of several turns, loads with windows, soil."""
    Path("model.toml").write_text(example_text(name) + PLANE, encoding="utf-8")
    found = every_model("model.toml")
    assert set(found) == set(MODELS)
    exact, moment = found["exact"], found["moment"]
    assert exact["energy"]["fed_in"] == pytest.approx(exact["energy"]["lost"], rel=1e-6)
    if exact["mounts"]["right"]["lifts_off"]:
        return
    for gauge, values in moment["gauges"].items():
        near = exact["gauges"][gauge]["peak_to_peak"]
        assert values["peak_to_peak"] == pytest.approx(near, rel=0.1), gauge


ODD = {
    "no gauges": [(GAUGE, "")],
    "flat": [FLAT, (SPRING, ""), (BEARING, "")],
    "flat with a spring": [FLAT, (BEARING, "")],
    "undamped": [(BEARING, "")],
    "overdamped": [('"0.333 kgf m s/rad"', '"1e6 N m s/rad"')],
    "heavy": [('mass = "25 kg"', 'mass = "1e20 kg"'), ('"19.0479488 kg m^2"', '"1e20 kg m^2"')],
}


@pytest.mark.parametrize("changes", ODD.values(), ids=ODD)
def test_odd_supports(changes: list[tuple[str, str]]) -> None:
    every_model(file(*changes))


@pytest.mark.parametrize("support", [HEAVE, SURGE, HEAVE + DAMPED, SURGE + DAMPED])
@pytest.mark.parametrize("eccentric", [0, 10])
def test_a_wheel_that_shakes_one_way(support: str, eccentric: float) -> None:
    """One freedom, m e w^2 / (k - M w^2); damping hardly counts that far from the resonance."""
    found = every_model(wheel(support, eccentric))
    assert set(found) == set(MODELS)
    square = (193 / 60 * math.tau) ** 2
    wanted = 2 * 4 * 1e-3 * eccentric * square / abs(5000 - 64 * square)
    for content in found.values():
        (gauge,) = content["gauges"].values()
        assert gauge["peak_to_peak"] == pytest.approx(wanted, rel=2e-3, abs=1e-12)


def test_links_without_mass_move_nothing() -> None:
    masses = [(f'mass = "{mass} g"', 'mass = "0 g"') for mass in (199, 687, 259)]
    inertias = [(f'inertia = "{own} kg mm^2"', 'inertia = "0 kg mm^2"') for own in (30, 1500, 300)]
    found = every_model(file(*masses, *inertias))
    assert set(found) == set(MODELS)
    for content in found.values():
        assert content["gauges"]["gauge"]["peak_to_peak"] < 1e-12


def test_a_float_that_hangs_in_the_air() -> None:
    """Left out of small motion, with a note."""
    gap = ("one_sided = true", 'one_sided = true\npreload = "-50 N"')
    path = file(gap, name="walking-transplanter")
    text = succeeded(
        equipoise("respond", path, "--speed", "150 rpm", "--model", "linear", "--json")
    )
    assert "float does not touch at rest, and is left out" in json.loads(text)["notes"]
