"""`equipoise balance` as a user runs it: tables, JSON, CSV, pictures, and the new model file."""

from __future__ import annotations

import csv
import json
import math
import re
import subprocess
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.advice import advise
from equipoise.balancing.blocks import balanced_headline
from equipoise.balancing.objectives import measured
from equipoise.balancing.outcome import reasons_to_leave
from equipoise.cli.plan import read_objective
from equipoise.mechanism.parts.balance import Balance, Limit, Objective
from equipoise.results.blocks import Text
from support.chosen import EXHAUSTIVE, few
from surface.running import (
    cells,
    changed,
    command,
    equipoise,
    massless,
    read,
    refused,
    refuses,
    succeeded,
    unfolded,
)

CRANK = ("yamashita-1", "--crank-counterweight")
FORCE = ("--objective", "shaking_force")


def run(*words: str | Path) -> str:
    asks_more = words[0] in ("trade-off", "conditions", "sensitivities", "arrangements")
    full = () if asks_more else ("--full",)
    return succeeded(equipoise("balance", *words, *full))


def as_json(*words: str | Path) -> dict[str, Any]:
    return read("balance", *words)


# -- tables ----------------------------------------------------------------------------------------


def test_tables_of_the_papers_counterweight() -> None:
    result = equipoise("balance", "balance-crank", "--full")
    text = succeeded(result)
    assert result.err == ""
    assert text.splitlines()[2] == "crank driven at 193.0 rpm (20.21 rad/s)"
    assert cells(text, "shaking force y, RMS about the mean, N") == ["12.19", "3.016", "-75.2 %"]
    assert (
        "crank: add a counterweight of 1145 g, its centre of mass 35.70 mm from A at -165.98 deg"
        in text
    )
    assert "(40882 g mm)" in text
    assert "point mass of 1145 g at (-34.64, -8.649) mm" in text
    assert (
        "Proof, by closed form: with a point mass of 1145 g on crank about A, no choice makes "
        "shaking force y, RMS about the mean at 193 rpm smaller than here by more than"
    ) in unfolded(text)
    assert cells(text, "mass of the links, g")[:2] == ["1145", "2290"]
    assert cells(text, "force in joint C, peak, N")[-1] == "same"
    assert cells(text, "shaking force, RMS, N") == ["14.98", "5.855", "-60.9 %"]
    assert cells(text, "drive torque, RMS, N m")
    assert not re.search(r"nan|inf|None|(?<!\+)-0 ", text)


def test_what_to_look_at_next_is_what_was_not_done(tmp_path: Path) -> None:
    out = tmp_path / "two words.toml"
    reported = unfolded(succeeded(equipoise("balance", "balance-crank")))
    written = unfolded(succeeded(equipoise("balance", "balance-crank", "--out", out)))
    assert "Look at next: balance --out FILE; balance --full." in reported
    assert f"Look at next: report '{out}'; balance --full." in written


def test_moved_centre_of_mass() -> None:
    text = run("balance-coupler")
    assert (
        "coupler: move the centre of mass from (-45.00, -20.00) mm to (6.240, 26.22) mm, "
        "with a mass of 761.0 g"
    ) in unfolded(text)
    assert cells(text, "mass of the links")[-1] == "same"


def test_limits_and_their_prices() -> None:
    words = (*CRANK, "--objective", "shaking_force.y", "--limit", "shaking_force.x <= 40 %")
    text = run(*words, "--limit", "peak joints.A <= 99 %")
    assert cells(text.partition("Limits")[2], "shaking force x, RMS") == [
        *("3.487", "3.487", "0.9613 N per N")
    ]
    assert cells(text.partition("Limits")[2], "force in joint A, peak")[-1] == "nothing"
    content = as_json(*words)
    price = content["prices"]["rms of shaking_force.x"]
    again = as_json(*words[:-1], "shaking_force.x <= 3.497 N")
    key = "rms of shaking_force.y"
    fall = content["objectives"][key]["after"] - again["objectives"][key]["after"]
    step = 3.497 - price["at_most"]
    assert fall / step == pytest.approx(price["price"], rel=0.02)


def test_prices_of_masses() -> None:
    words = (*CRANK, *FORCE, "--radius", "40 mm", "--at-most", "300 g")
    text = run(*words)
    assert cells(text, "mass on crank, g")[:2] == ["300.0", "300.0"]
    assert cells(text, "mass on crank, g")[-1].endswith(" N per g")
    text = run(*CRANK, *FORCE, "--radius", "40 mm", "--limit", "added_mass <= 300 g")
    assert cells(text, "added mass, g")[:2] == ["300.0", "300.0"]
    text = run(*words, "--objective", "drive_torque")
    assert cells(text, "mass on crank, g")[-1].endswith(" % of all per g")


PLATE = ("--thickness", "10 mm", "--material", "steel", "--radius", "50 mm")


@pytest.mark.exhaustive(but=["sector", "point"])
@pytest.mark.parametrize("shape", ["any", "point", "disc", "sector"])
def test_shapes(shape: str) -> None:
    plate = PLATE if shape in {"disc", "sector"} else PLATE[-2:]
    words = (*CRANK, *FORCE, "--shape", shape, *plate)
    made = f"{shape} of" if shape in {"disc", "sector"} else "point mass of"
    assert f"made as: {made}" in run(*words)
    content = as_json(*words)
    (change,) = content["changes"]
    assert sum(piece["mass"] for piece in change["pieces"]) == pytest.approx(change["mass"])
    assert change["mass"] == pytest.approx(content["added_mass"])
    for piece in change["pieces"]:
        assert math.hypot(*piece["place"]) <= 0.05 * (1 + 1e-6)
    assert content["gap"] < 1e-6


def test_a_ring_on_the_rocker_changes_the_torque() -> None:
    """It shakes nothing, but the rocker's speed varies."""
    words = ("--shape", "ring", *PLATE, "--objective", "peak drive_torque")
    text = run("yamashita-1", "--counterweight", "rocker", *words)
    assert "rocker: add" in text


def test_everything_else_that_may_be_freed() -> None:
    text = run("yamashita-1", "--move-cm", "coupler", "--move-cm", "rocker", *FORCE)
    assert "coupler: move the centre of mass" in text
    assert "rocker: move the centre of mass" in text
    text = run("yamashita-1", "--counterweight", "rocker", "--mass", "100 g", *FORCE)
    assert "rocker: add a counterweight of 100.0 g" in text


def test_several_objectives() -> None:
    words = ("--objective", "peak shaking_force weight 2", "--objective", "rms drive_torque")
    content = as_json(*CRANK, *words)
    assert list(content["objectives"]) == ["peak of shaking_force", "rms of drive_torque"]
    before_after = content["objectives"].values()
    cost = sum(w * x["after"] / x["before"] for w, x in zip((2, 1), before_after, strict=True))
    # the optimisation sees a peak at twice the crank angles of the figures that are told
    assert content["cost"] == pytest.approx(cost, rel=3e-4)


@pytest.mark.exhaustive(
    but=[
        "shaking_energy about D-area under shaking_moment about D",
        "shaking_force.y orders 1,2-rms of shaking_force.y (order 1, 2)",
    ]
)
@pytest.mark.parametrize(
    ("asked", "name"),
    [
        ("shaking_energy about D", "area under shaking_moment about D"),
        ("peak_to_peak drive_torque", "peak to peak of drive_torque"),
        ("shaking_force.y orders 1,2", "rms of shaking_force.y (order 1, 2)"),
        ("  rms   joints.B ", "rms of joints.B"),
    ],
)
def test_objectives_in_words(asked: str, name: str) -> None:
    content = as_json("yamashita-1", "--move-cm", "coupler", "--objective", asked)
    assert list(content["objectives"]) == [name]
    values = content["objectives"][name]
    assert values["after"] < values["before"]


def test_an_objective_alone_is_reduced_within_the_assumed_room() -> None:
    """It was refused, as no change is permitted, though `balance` itself proposes the option."""
    content = read("balance", "yamashita-1", "--objective", "shaking_force.y")
    values = content["objectives"]["rms of shaking_force.y"]
    assert values["after"] < 0.7 * values["before"]


def test_where_no_mass_acts_on_the_objective_it_is_named() -> None:
    """The largest figure was named, which may be another."""
    plan = Balance(objectives=(Objective("drive_torque"),))
    result = advise(eq.load("scotch-yoke").with_balance(plan))
    [sentence] = reasons_to_leave(result)
    assert "drive torque, RMS" in sentence
    *_, after = balanced_headline(result, alone=True)  # which proposes no objective again
    assert isinstance(after, Text) and "balance --counterweight LINK; " in after.text


def test_an_objective_is_named_also_where_no_figure_is_large() -> None:
    """It was said of the machine that no figure is large, and nothing of the objective."""
    base, plan = eq.load("scotch-yoke"), Balance(objectives=(Objective("drive_torque"),))
    slow = replace(base, gravity=(0.0, 0.0), drive=replace(base.drive, speed=0.01))
    result = advise(slow.with_balance(plan))
    assert result.advice is not None and not any(item.is_large for item in result.advice.before)
    [sentence] = reasons_to_leave(result)
    assert "drive torque, RMS" in sentence


def test_another_speed() -> None:
    slow, fast = (as_json("balance-crank", "--speed", speed) for speed in ("-100 rpm", "200 rpm"))
    assert fast["speed"] == pytest.approx(200 * math.pi / 30)
    (first,), (other,) = slow["objectives"].values(), fast["objectives"].values()
    assert other["after"] == pytest.approx(4 * first["after"])


# Several speeds: tests/unit/balancing/test_effects.py.
@pytest.mark.exhaustive
def test_gauges_at_several_speeds() -> None:
    text = run("balance-rig")
    name = "reading at gauge, peak to peak, at 150, 193, 240 rpm, mm"
    assert cells(text, name)[:2] == ["19.87", "7.622"]
    assert cells(text, "reading at gauge, peak to peak, mm")
    assert "note: added mass increases the mass of the support" in text
    words = ("peak gauges.gauge speeds 100 rpm, 193 rpm", "--at-most", "500 g")
    content = as_json("yamashita-rig", "--crank-counterweight", "--objective", *words)
    (values,) = content["objectives"].values()
    assert values["after"] < values["before"]


def test_a_balanced_machine_has_no_speed_at_which_it_shakes_as_before() -> None:
    text = run("exudyn-slider-crank")
    assert cells(text, "shaking force, RMS, N")[-1] == "-100.0 %"
    speeds = text.partition("Speed at which it shakes as before")[2]
    assert "shaking_force" not in speeds
    assert "shaking moment, RMS" in speeds
    content = as_json("exudyn-slider-crank")
    assert not any(name.startswith("shaking_force") for name in content["equivalent_speeds"])


def test_rounding_is_not_printed() -> None:
    """A balanced machine shakes by rounding alone, of which no share is told either."""
    succeeded(equipoise("balance", "--full", "exudyn-slider-crank", "-o", "still.toml"))
    limit = ("--limit", "shaking_force <= 1 N")
    text = run("still.toml", "--move-cm", "rod", "--objective", "shaking_moment", *limit)
    assert cells(text, "shaking force, RMS, N")[0] == "0"
    assert cells(text, "reading at x, peak to peak, mm")[0] == "0"
    assert not re.search(r"[0-9]e-1[0-9] +[0-9]", text.partition("Before and after")[2])


# -- gears, phases ---------------------------------------------------------------------------------

GEARED = ("lee-kim-b", "--geared-counterweight", "rocker", "--pitch-radius", "50 mm",
          "--objective", "shaking_energy", "--at-most", "416 g")  # fmt: skip


def test_a_geared_counterweight_of_one_ratio() -> None:
    words = (*GEARED, "--ratio", "0.8", "--radius", "74.257 mm")
    text = run(*words, "-o", "geared.toml")
    assert cells(text, "shaking moment, area over a full angle, J")[:2] == ["14.31", "9.928"]
    assert "counterweight: a shaft at (186.5, 0) mm of the frame, geared to rocker" in text
    assert "geared to rocker, no choice makes " in text
    assert cells(text, "force in joint counterweight-axis, peak, N")[-1] == "new"
    machine = eq.load("geared.toml")
    moment = eq.forces(eq.move(machine, 720)).shaking_moment
    assert measured(moment, "area") == pytest.approx(9.9284, abs=1e-3)


def test_a_second_geared_counterweight_has_a_name_of_its_own() -> None:
    run(*GEARED, "--ratio", "1", "-o", "one.toml")
    run("one.toml", *GEARED[1:], "--ratio", "0.5", "-o", "two.toml")
    machine = eq.load("two.toml")
    assert [*machine.links][-2:] == ["counterweight", "counterweight-2"]
    assert machine.title == "Planting mechanism B (Lee, Kim), balanced"


# On every change: `test_two_shafts_with_choices_each` of `unit/balancing/test_gear_search.py`.
@EXHAUSTIVE
def test_a_range_of_ratios_is_proved_one_by_one() -> None:
    text = run(*GEARED, "--ratio", "0.8, 0.81")
    assert "value before for each of the gears tried." in text
    teeth = changed(
        "balance-geared-b",
        ('ratio = [0.2, 3]\npitch_radius = "50 mm"', 'teeth = [39, 41]\nmodule = "2.5 mm"'),
    )
    text = run(teeth)
    assert "for each of 9 choices of gears: with " in text
    assert "teeth of module 2.500 mm" in text and "with the ratio" in text


# Phases by an option: the test below.
@pytest.mark.exhaustive
def test_phases_of_rows() -> None:
    text = run("four-row-transplanter", "-o", "rows.toml")
    assert "  Rows: set the phases to 0, 180, 270, 90 deg" in text.splitlines()
    assert "Proof, by branch and bound over all phases of the rows: with other phases" in text
    assert "no choice makes all rows: shaking force, RMS at 200 rpm smaller than here" in unfolded(
        text
    )
    speeds = text.partition("Speed at which it shakes as before")[2]
    assert cells(speeds, "all rows: shaking force, RMS") == ["501.4"]
    phases = [math.degrees(row.phase) for row in eq.load("rows.toml").rows]
    assert phases == pytest.approx([0, 180, 270, 90])
    content = as_json("four-row-transplanter")
    assert 0 <= content["gap"] < 1e-3
    assert content["rows"]["remaining_orders"][:2] == [4, 8]
    assert [math.degrees(phase) for phase in content["rows"]["phases"]] == pytest.approx(phases)


def test_phases_by_an_option() -> None:
    path = changed("four-row-transplanter", ('phases = { step = "5 deg" }', ""))
    assert "set the phases" in run(path, "--phases")


# -- JSON, CSV, pictures, model file ---------------------------------------------------------------


def test_json_is_the_result_of_the_function() -> None:
    content = as_json("balance-crank")
    balanced = eq.balance(eq.load("balance-crank"))
    assert list(content) == list(balanced.to_dict())
    for key in ("before", "after", "equivalent_speeds", "objectives", "gap", "prices", "bound"):
        assert content[key] == balanced.to_dict()[key], key
    assert content["changes"][0]["pieces"][0]["shape"] == "point"
    assert content["changes"][0]["radius"] == pytest.approx(0.0357, abs=5e-5)
    assert content["planting_kept"] is None
    effects = content["sensitivities"]["shaking_force.y"]["sensitivities"]
    assert effects["coupler.mass"]["rms"] > 0 and "values" not in effects["coupler.mass"]


def test_csv() -> None:
    result = equipoise("balance", "balance-crank", "--csv", "x.csv")
    assert succeeded(result).startswith("Planting mechanism type I")
    assert result.err == "wrote x.csv\n"
    with open("x.csv", encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    assert header[0] == "crank_angle [rad]"
    assert "drive_torque.after [N m]" in header
    values = dict(zip(header, np.array(rows, float).T, strict=True))
    assert len(rows) == 720
    content = as_json("balance-crank")
    for when in ("before", "after"):
        force = values[f"shaking_force.y.{when} [N]"]
        assert measured(force, "rms") == pytest.approx(content[when]["shaking_force.y.rms"])


@pytest.mark.exhaustive(but=["balance-coupler"])
@pytest.mark.parametrize(
    "name",
    few(
        ["balance-crank", "balance-coupler", "balance-rig", "exudyn-slider-crank"],
        {"balance-coupler", "balance-rig"},
    ),
)
def test_the_new_model_does_what_was_printed(name: str) -> None:
    result = equipoise("balance", name, "--out", "new.toml", "--json")
    assert result.err == "wrote new.toml\n"
    content = json.loads(succeeded(result))
    schema = json.loads(succeeded(equipoise("schema")))
    text = Path("new.toml").read_text(encoding="utf-8")
    jsonschema.validate(tomllib.loads(text), schema)
    machine = eq.load("new.toml")
    assert machine.title.endswith(", balanced")
    assert machine.description.startswith("Changed by equipoise balance: ")
    assert "Changed" not in machine.description.texts["ja"]  # type: ignore[attr-defined]
    assert machine.balance is None
    forces = eq.forces(eq.move(machine, 360, acceleration=0.0))
    for output, values in (
        ("shaking_force", forces.shaking_force.value),
        ("shaking_moment", forces.shaking_moment),
        ("drive_torque", forces.drive_torque),
        *((f"joints.{name}", joint.value) for name, joint in forces.joints.items()),
    ):
        for measure in ("rms", "peak"):
            wanted = content["after"][f"{output}.{measure}"]
            assert measured(values, measure) == pytest.approx(wanted, rel=1e-9, abs=1e-9)
    assert "ready to be analysed" in succeeded(equipoise("check", "new.toml"))


# Planting stays as it is: tests/unit/balancing/test_balanced.py.
@pytest.mark.exhaustive
def test_planting_figures_are_kept() -> None:
    text = run("kim-chung-a", "--crank-counterweight", *FORCE)
    assert "The planting figures stay as they are." in text
    assert as_json("kim-chung-a", "--crank-counterweight", *FORCE)["planting_kept"] is True


# -- other questions -------------------------------------------------------------------------------

FRONT = ("trade-off", *CRANK, "shaking_force.x", "shaking_force.y", "--points", "4")


def test_front() -> None:
    text = run(*FRONT)
    rows = [line.split() for line in text.splitlines() if re.match(r" +[0-9]", line)]
    values = np.array(rows, float)
    assert values.shape == (4, 3)
    assert np.all(np.diff(values[:, 0]) > 0)
    assert np.all(np.diff(values[:, 1]) < 0)
    assert values[[0, -1], :2] == pytest.approx(
        np.array([[2.809, 5.109], [5.018, 3.016]]), rel=1e-3
    )
    assert "Every point is as good as any can be, to" in text
    content = as_json(*FRONT)
    assert content["before"]["rms of shaking_force.x"] == pytest.approx(8.718, abs=5e-4)
    actual = [[p["first"], p["second"], 1e3 * p["added_mass"]] for p in content["points"]]
    np.testing.assert_allclose(actual, values, rtol=6e-4)
    assert all(point["gap"] < 1e-7 and point["changes"] for point in content["points"])
    succeeded(equipoise("balance", *FRONT, "--csv", "x.csv"))
    lines = Path("x.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "rms of shaking_force.x [N],rms of shaking_force.y [N],added mass [kg]"
    assert len(lines) == 5


def test_front_has_21_points() -> None:
    assert len(as_json(*FRONT[:-2])["points"]) == 21


def test_conditions() -> None:
    text = run("conditions", "yamashita-1")
    assert "mass*x of coupler / 71.5 mm + mass*x of rocker / 80 mm = 0" in text
    assert "The shaking force can be made zero, with every mass as it is." in text
    content = as_json("conditions", "yamashita-1")
    assert [len(content[kind]["conditions"]) for kind in ("zero", "sine")] == [4, 2]
    assert content["zero"]["conditions"][3]["condition"].startswith("coupler.moment_y / 71.5 mm")
    assert content["verdict"]["shaking_force"]["possible"] is True
    assert content["verdict"]["shaking_moment"]["proof"]["unit"] == "kg"


def test_sensitivities() -> None:
    words = ("sensitivities", "yamashita-2", "shaking_force.y")
    text = run(*words, "--crank-zero", "-100 deg")
    assert "crank angle from -100.0 deg" in text
    row = cells(text, "coupler  centre of mass, x")
    assert row[1] == "mm"
    assert [float(part) for part in row[3].split(",")] == pytest.approx([6.7, 265.8])
    content = as_json(*words)
    assert content["output"] == "shaking_force.y"
    at = np.degrees(content["sensitivities"]["coupler.center_x"]["no_effect_at"]) + 100
    assert at % 360 == pytest.approx([265.8, 6.7], abs=0.05)


@pytest.mark.parametrize("output", ["shaking_force.x", "shaking_moment", "drive_torque"])
def test_sensitivities_of_other_outputs(output: str) -> None:
    text = run("sensitivities", "lee-kim-a", output)
    assert re.search("^coupler +mass  +[0-9]", text, re.MULTILINE)
    assert "crank angle from" not in text


def test_arrangements() -> None:
    text = run("arrangements", "yamashita-2", "4")
    assert cells(text, "all in phase") == ["86.74", "0", "0"]
    assert cells(text.partition("Figures")[2], "4 quarter turns") == ["13.80", "9.556", "6.522"]
    wide = run("arrangements", "yamashita-2", "4", "--spacing", "600 mm")
    row = cells(wide.partition("Figures")[2], "4 quarter turns")
    assert [float(part) for part in row] == pytest.approx([13.80, 2 * 9.556, 2 * 6.522], rel=1e-3)
    content = as_json("arrangements", "yamashita-2", "6")
    assert [entry["source"] for entry in content["patterns"]][:1] == ["Table 5, 6 claws (a)"]


# -- plans that cannot be -------------------------------------------------------------------------

RATIO = "ratio = [0.2, 3]"
PAIR = f'{RATIO}\npitch_radius = "50 mm"'
POINT = 'shape = "point"\nmass = "1145 g"'
MACHINES = {
    # example, what is replaced, by what, what is said
    "into a link": ("balance-geared-a", RATIO,
                    'ratio = 1\ndirection = "180 deg"\nclear_of = ["coupler"]',
                    "the counterweight would run into coupler, which comes within "),
    "into no link": ("balance-geared-a", RATIO, 'ratio = 1\nclear_of = ["copler"]',
                     "model.toml: balance.geared[1].clear_of[1]: no link is called 'copler'"),
    "gears apart": ("balance-geared-a", PAIR, 'teeth = [20, 22]\nmodule = "2 mm"\n'
                    'axis = ["200 mm", "0 mm"]', "model.toml: balance.geared[1].axis: lies 134 mm "
                    "from the driver's pin 'O4'; two gears with these teeth are 40 mm to 44 mm ap"),
    "gears that do not mesh": ("balance-geared-a", PAIR, 'teeth = [20, 22]\nmodule = "2 mm"\n'
                               'axis = ["107.3 mm", "0 mm"]', "the gears of the counterweight do "
                               "not mesh: shafts 41.3 mm apart need 41.3 teeth of module 2 mm"),
    "no way back": ("balance-geared-a", f'driver = "rocker"\n{RATIO}',
                    'driver = "crank"\ndirection = "180 deg"\nratio = [0.1, 0.3]',
                    "has no ratio from 0.1 to 0.3 that brings it back within 3 turns; give anoth"),
    "taken": ("balance-geared-a", RATIO, 'ratio = 1\nname = "rocker"', "model.toml: balance.geared"
              "[1].name: 'rocker' is taken already; give another name"),
    "larger than its room": ("balance-crank", POINT, 'shape = "disc"\nradius = "40 mm"\nthickness '
                             '= "5 mm"\nmaterial = "steel"\nmass = "1145 g"', "model.toml: balance."
                             "masses[1].mass: a disc of 1145 g and 5 mm steel has a radius of"),
    "a ring of no use": ("balance-crank", POINT, 'shape = "ring"\nradius = "40 mm"\nthickness = '
                         '"5 mm"\nmaterial = "steel"', "none of the permitted changes affects"),
    "no masses": ("balance-crank", 'mass = "687 g"\n', "", "mass"),
    "no balance": ("balance-crank", "[[balance.masses]]", "[[balance.mases]]", "balance.mases: no"),
}  # fmt: skip


@pytest.mark.parametrize(("name", "old", "new", "said"), MACHINES.values(), ids=MACHINES)
def test_a_plan_that_cannot_be(name: str, old: str, new: str, said: str) -> None:
    changed(name, (old, new))
    refuses("balance model.toml -o new.toml --csv x.csv --plot pictures", said)


def test_missing_masses_are_named() -> None:
    Path("model.toml").write_text(massless(), encoding="utf-8")
    for words in (
        "model.toml --crank-counterweight --objective shaking_force.y",
        "conditions model.toml",
        "sensitivities model.toml drive_torque",
    ):
        said = "model.toml: forces need mass, center_of_mass and inertia of every"
        assert refuses(f"balance {words}", said).startswith(said)


def test_a_file_that_is_there_is_not_overwritten() -> None:
    Path("new.toml").write_text("mine", encoding="utf-8")
    line = refuses("balance balance-crank --out new.toml --csv x.csv", "")
    assert line == "new.toml: is there already; choose another name by --out"
    assert Path("new.toml").read_text(encoding="utf-8") == "mine"


# A drawing beside a new model: the test below; sheets: tests/unit/exchange/test_drawings.py.
@pytest.mark.exhaustive
def test_the_drawing_of_each_counterweight_is_written_with_the_new_model(tmp_path: Path) -> None:
    new, drawing = tmp_path / "new.toml", tmp_path / "new.pdf"
    process = equipoise("balance", "balance-rig", "--out", new, "--drawing", drawing)
    succeeded(process)
    assert [x for x in process.err.splitlines() if x.startswith("wrote")] == [
        f"wrote {new}",
        f"wrote {drawing}",
    ]
    assert drawing.read_bytes().startswith(b"%PDF") and new.is_file()


def test_what_a_drawing_cannot_have_is_said(tmp_path: Path) -> None:
    """And neither file is written where there is nothing to draw."""
    new, drawing = tmp_path / "p.toml", tmp_path / "p.dxf"
    process = equipoise("balance", "balance-crank", "--out", new, "--drawing", drawing)
    assert process.status == 0 and "note: the drawing leaves out" in process.err
    assert new.is_file() and drawing.is_file()
    other = ("balance", "balance-crank", "--out", tmp_path / "q.toml")
    sentence = refused(equipoise(*other, "--drawing", tmp_path / "q.pdf"))
    assert "balancing gives none to what it changes: crank" in sentence
    assert 'the shape "disc", "ring" or "sector"' in sentence
    assert not (tmp_path / "q.toml").exists()
    sentence = refused(equipoise(*other, "--drawing", tmp_path / "q.xml"))
    assert "give a name that ends in .pdf, .dxf or .svg" in sentence


def test_a_limit_of_the_file_is_kept_beside_that_of_the_option() -> None:
    said = "rms of gauges.gauge at most 1 % of before"
    refuses("balance balance-rig --limit 'gauges.gauge <= 1 %'", said)


def test_nothing_is_printed_beside_a_broken_pipe() -> None:
    """Where nobody reads, the command ends quietly."""
    words = " ".join(f"'{word}'" for word in command("balance", "balance-crank"))
    done = subprocess.run(f"{words} | head -1", shell=True, capture_output=True, check=True)
    assert done.stderr == b""


# The names alone: the test below.
@pytest.mark.exhaustive
@pytest.mark.parametrize("row", few(["drive_torque", "rows.drive_torque"], {"rows.drive_torque"}))
def test_outputs_of_several_rows_are_taken_by_the_names_that_results_have(row: str) -> None:
    """What `analyze` calls rows.drive_torque is the drive_torque that balancing makes small."""
    words = ("--phases", "--objective", f"rms {row}", "--limit", f"rms {row} <= 100 %")
    text = succeeded(equipoise("balance", "walking-transplanter", *words, "--json"))
    before = json.loads(text)["objectives"]["rms of drive_torque"]["before"]
    summary = eq.analyze(eq.load("walking-transplanter"), acceleration=0.0).summary
    assert before == pytest.approx(summary["rows.drive_torque"].rms, rel=1e-9)


def test_a_file_names_outputs_of_several_rows_as_results_do() -> None:
    machine = eq.load("four-row-transplanter")
    aims = Objective("rows.drive_torque"), Objective("drive_torque")
    plans = [Balance(objectives=(aim,), limits=(Limit(aim, ratio=1.0),)) for aim in aims]
    assert plans[0] == plans[1] and machine.with_balance(plans[0]).balance == plans[1]


def test_an_output_of_a_link_of_two_words_is_an_objective() -> None:
    aim = read_objective("--objective", "peak drives.left crank.torque orders 1")
    assert (aim.output, aim.measure, aim.orders) == ("drives.left crank.torque", "peak", (1.0,))


# First lines: tests/unit/results/test_headline.py.
@pytest.mark.exhaustive
@pytest.mark.parametrize("name", few(["quick-return", "plunger-pump"], {"quick-return"}))
def test_where_masses_stay_the_flywheel_that_helps_stands_on_the_first_page(name: str) -> None:
    """A torque that swings is what is large there, and only `--full` said what steadies it."""
    output = succeeded(equipoise("balance", name))
    words = " ".join(output.split())
    assert "Flywheel on a shaft" in words and "keeps its speed within 20 %" in words
    assert len(output.splitlines()) <= 15
