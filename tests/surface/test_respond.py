"""`equipoise respond` and `modes` as a user runs them: tables, JSON, CSV and pictures."""

from __future__ import annotations

import csv
import json
import math
import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from support.chosen import EXHAUSTIVE, few, few_together
from surface.running import cells, changed, equipoise, example_text, read, succeeded, written

PLANAR = ("yamashita-rig", "yamashita-rig-counterweight", "walking-transplanter")
MODELS = ("linear", "torque", "moment", "coupled", "exact")
CASES = [
    *((name, model) for name in PLANAR for model in MODELS),
    *(("riding-transplanter", model) for model in MODELS[:3]),
]
GAUGES = {
    "yamashita-rig": {"gauge"},
    "yamashita-rig-counterweight": {"gauge"},
    "walking-transplanter": {"planting_part", "pitch", "handle_along"},
    "riding-transplanter": {"left_end", "right_end", "roll", "yaw"},
}
RIG = "yamashita-rig"
RPM = math.tau / 60
FIGURES = {"mean", "peak_to_peak", "max", "min", "rms", "orders", "harmonics", "phases"}


def answer(*words: str | Path) -> dict[str, Any]:
    return read("respond", RIG, *words)


def peak(content: dict[str, Any], gauge: str = "gauge") -> float:
    """Peak to peak at a gauge, mm."""
    return 1e3 * float(content["gauges"][gauge]["peak_to_peak"])


def table(path: str) -> tuple[list[str], np.ndarray[Any, Any]]:
    """Header and values of a CSV file."""
    with open(path, encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    return header, np.array(rows, float)


# -- one speed: tables and JSON --------------------------------------------------------------------


@pytest.mark.exhaustive(but=["yamashita-rig-counterweight", "riding-transplanter", "yamashita-rig"])
@pytest.mark.parametrize("name", GAUGES)
def test_tables_of_an_example(name: str) -> None:
    result = equipoise("respond", name, "--full")
    text = succeeded(result)
    assert result.err == ""
    assert text.splitlines()[0] == eq.load(name).title
    drive = "Drive, all rows together" if eq.load(name).rows else "Drive"
    for title in ("Natural frequencies", "Gauges", "Gauges by order", "Gauges by each model",
                  "Mounts: force on the support", f"{drive}$"):  # fmt: skip
        assert re.search(f"^{title}", text, re.MULTILINE), title
    assert not re.search(r"\b(nan|inf|None)\b", text)
    assert all(cells(text, gauge) for gauge in GAUGES[name])


@pytest.mark.parametrize("model", MODELS)
def test_tables_of_a_model(model: str) -> None:
    text = succeeded(equipoise("respond", "--full", RIG, "--model", model))
    assert f"by the {model} model: " in text
    assert ("residual" in text) == (model in {"coupled", "exact"})
    assert ("energy per period" in text) == (model == "exact")


def test_all_models_are_compared() -> None:
    text = succeeded(equipoise("respond", "--full", RIG))
    (header,) = (line for line in text.splitlines() if line.split() == list(MODELS))
    assert header
    part = text[text.index("Gauges by each model") :]
    assert cells(part, "gauge") == ["12.62", "12.61", "12.00", "12.61", "12.00"]
    spatial = succeeded(equipoise("respond", "--full", "riding-transplanter"))
    assert any(line.split() == list(MODELS[:3]) for line in spatial.splitlines())


@pytest.mark.parametrize(("name", "model"), CASES)
def test_json_has_the_documented_shape(name: str, model: str) -> None:
    content = read("respond", name, "--model", model)
    machine = eq.load(name)
    assert machine.support is not None
    assert content["model"] == model
    assert content["title"] == machine.title
    assert content["speed"] == pytest.approx(machine.drive.speed, rel=1e-15)
    assert set(content["gauges"]) == GAUGES[name]
    assert set(content["mounts"]) == set(machine.support.mounts)
    assert len(content["modes"]) == len(machine.support.coordinates)
    for gauge in content["gauges"].values():
        for signal in (gauge, gauge["velocity"], gauge["acceleration"]):
            assert set(signal) >= FIGURES
            assert len(signal["orders"]) == len(signal["harmonics"]) == len(signal["phases"])
            assert signal["orders"][:11] == list(range(11))
            assert signal["peak_to_peak"] == pytest.approx(signal["max"] - signal["min"])
            varying = np.linalg.norm(signal["harmonics"][1:]) / math.sqrt(2)
            assert signal["rms"] == pytest.approx(varying, rel=1e-8)
    for mount in content["mounts"].values():
        assert set(mount) >= {*FIGURES, "transmissibility", "lifts_off"}
    assert set(content["drive"]) == {"torque"}
    periodic = {"residual", "multipliers", "stable"} & set(content)
    assert bool(periodic) == (model in {"coupled", "exact"})
    assert content.get("residual", 0.0) < 1e-10
    assert content.get("stable", True) is True
    assert ("energy" in content) == (model == "exact")


@pytest.mark.exhaustive(but=["yamashita-rig"])
@pytest.mark.parametrize("name", few(GAUGES, {"yamashita-rig", "riding-transplanter"}))
def test_the_default_model_is_force_and_moment(name: str) -> None:
    """However the support is held; in each command that has one."""
    speeds = "--speed", "100:120 rpm", "--speeds", "2"
    for words in (("respond", name), ("respond", name, *speeds), ("modes", name)):
        assert read(*words) == read(*words, "--model", "moment")


def test_models_that_differ_say_so() -> None:
    """(59) is 5.2 % above the exact equations on the paper's rig, whose arm is long."""
    text = " ".join(succeeded(equipoise("respond", "--full", RIG)).split())
    assert (
        "the models differ: at gauge, linear gives 12.62 mm and exact, the most complete model, "
        "12.00 mm; moment, which is used here, agrees with exact" in text
    )


# -- speeds ----------------------------------------------------------------------------------------

EQUAL_SPEEDS = ("193 rpm", " 193  rpm", "20.210912738 rad/s", "3.21666666667 turn/s", "1158 deg/s")


@pytest.mark.parametrize("speed", EQUAL_SPEEDS)
def test_one_speed_in_any_unit(speed: str) -> None:
    content = answer("--speed", speed)
    assert content["speed"] == pytest.approx(193 * RPM, rel=1e-9)
    assert peak(content) == pytest.approx(12.00, abs=0.005)


def test_a_crank_that_turns_the_other_way() -> None:
    """The shaking force of a constant speed does not know the sense; the response nearly."""
    content = answer("--speed", "-193 rpm")
    assert content["speed"] == pytest.approx(-193 * RPM)
    assert peak(content) == pytest.approx(12.00, abs=0.02)
    assert "crank driven at -193.0 rpm (-20.21 rad/s)" in succeeded(
        equipoise("respond", RIG, "--speed", "-193 rpm", "--full")
    )


EQUAL_RANGES = ("20 rpm : 300 rpm", "20:300 rpm", "20 rpm:300 rpm", "20 : 300 rpm",
                "2.0943951023932 rad/s : 300 rpm")  # fmt: skip


@pytest.mark.exhaustive(but=["20:300 rpm", "20 : 300 rpm"])
@pytest.mark.parametrize("speeds", EQUAL_RANGES)
def test_a_range(speeds: str) -> None:
    content = answer("--speed", speeds, "--speeds", "10")
    speed = content["speed"]
    assert speed[0] == pytest.approx(20 * RPM) and speed[-1] == pytest.approx(300 * RPM)
    assert speed == sorted(speed)
    actual = content["resonances"]
    np.testing.assert_allclose(actual, [12.43, 6.22, 4.14, 3.11, 2.49], atol=0.006)
    assert set(np.searchsorted(speed, actual)) <= set(range(1, len(speed)))


@pytest.mark.exhaustive(but=["coupled", "linear"])
@pytest.mark.parametrize("model", MODELS)
def test_json_of_a_range(model: str) -> None:
    content = answer("--model", model, "--speed", "120:140 rpm", "--speeds", "4")
    assert set(content) >= {"title", "model", "speed", "gauges", "mounts", "modes", "resonances",
                            "resonance_map", "notes"}  # fmt: skip
    count = len(content["speed"])
    gauge = content["gauges"]["gauge"]
    arrays = [
        *(part[key] for part in (gauge, gauge["velocity"], gauge["acceleration"])
          for key in ("peak_to_peak", "rms")),
        gauge["harmonics"],
        *(mount[key] for mount in content["mounts"].values() for key in ("peak_to_peak", "rms")),
    ]  # fmt: skip
    assert all(len(values) == count for values in arrays)
    assert np.all(np.isfinite(np.array(gauge["peak_to_peak"], float)))
    assert ("stable" in content) == (model in {"coupled", "exact"})
    alone = answer("--model", model, "--speed", f"{content['speed'][1]!r} rad/s")
    # Peaks are sought between samples: the same to their rounding.
    assert gauge["peak_to_peak"][1] == pytest.approx(1e-3 * peak(alone), rel=1e-6)


# Their tables: tests/unit/vibration; other tables of ranges are read on every change.
@pytest.mark.exhaustive
def test_resonances_of_a_range() -> None:
    words = "--speed", "20:300 rpm", "--speeds", "2", "--model", "linear"
    content = answer(*words)
    (first, *_) = content["resonance_map"]
    assert first["speed"] == content["resonances"][0] == pytest.approx(12.415, abs=5e-4)
    assert (first["order"], first["mode"], first["share"]) == (1, 1, 1)
    assert first["avoid"][0] < first["speed"] < first["avoid"][1]
    text = succeeded(equipoise("respond", "--full", RIG, *words))
    assert "crank driven at 20.0 to 300 rpm" in text
    assert "96.81 to 136.9" in text
    assert "no resonance in this range" in succeeded(
        equipoise("respond", RIG, "--speed", "150:200 rpm", "--speeds", "2")
    )


# One speed of the other sense, and ranges, are read on every change.
@pytest.mark.exhaustive
def test_a_range_of_the_other_sense() -> None:
    content = answer("--speed", "-20:-300 rpm", "--speeds", "5")
    assert content["speed"] == sorted(content["speed"], reverse=True)
    forwards = answer("--speed", "20:300 rpm", "--speeds", "5")
    np.testing.assert_allclose(content["resonances"], np.negative(forwards["resonances"]))


def test_speeds_of_a_range_in_space() -> None:
    words = ("respond", "riding-transplanter", "--speed", "230:250 rpm", "--speeds", "3")
    assert set(read(*words)["gauges"]) == GAUGES["riding-transplanter"]
    assert "share of the loudest" in succeeded(equipoise(*words, "--full"))


# -- the motor, and from rest ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "sense"),
    few_together([("yamashita-rig", 1), ("walking-transplanter", -1)], {("yamashita-rig", 1)}),
)
def test_the_motor_holds_the_mean_speed(name: str, sense: int) -> None:
    content = read("respond", name, "--drive", "--speed", f"{sense * 190} rpm")
    speed = content["drive"]["speed"]
    assert content["model"] == "exact"
    assert content["speed"] == pytest.approx(sense * 190 * RPM, rel=1e-9)
    assert speed["mean"] == pytest.approx(content["speed"], rel=1e-9)
    fluctuation = content["drive"]["fluctuation"]
    assert fluctuation > 1e-3
    assert fluctuation == pytest.approx(speed["peak_to_peak"] / abs(speed["mean"]), rel=1e-9)
    assert content["energy"]["fed_in"] == pytest.approx(content["energy"]["lost"], rel=1e-7)


def test_tables_with_the_motor() -> None:
    text = succeeded(equipoise("respond", "--full", RIG, "--drive"))
    assert "rad/s), speed by the motor" in text
    assert "speed fluctuates by" in text
    assert "Gauges by each model" not in text
    assert cells(text, "crank speed")[0] == "193.0"


def test_the_motor_over_a_range() -> None:
    content = answer("--drive", "--speed", "180:200 rpm", "--speeds", "3")
    assert len(content["fluctuation"]) == len(content["speed"])
    assert min(content["fluctuation"]) > 0


@pytest.mark.exhaustive(but=["extra0"])
@pytest.mark.parametrize("extra", [(), ("--drive",), ("--speed", "-193 rpm")])
def test_from_rest(extra: tuple[str, ...]) -> None:
    content = read("simulate", RIG, "0.5 s", *extra)
    time = content["time"]
    assert (time[0], time[-1]) == (0, 0.5)
    series = [content["crank_angle"], content["crank_speed"], content["gauges"]["gauge"],
              *content["mounts"].values()]  # fmt: skip
    for values in series:
        (numbers,) = values.values() if isinstance(values, dict) else (values,)
        assert len(numbers) == len(time)
        assert np.all(np.isfinite(numbers))
    assert content["gauges"]["gauge"]["displacement"][0] == 0
    if "--drive" in extra:
        assert content["crank_speed"][0] == 0
    text = succeeded(equipoise("simulate", RIG, "500 ms", *extra))
    assert "\nFrom rest for 0.5000 s, " in text
    assert cells(text, "crank speed") and cells(text, "spring")


# -- CSV and units ---------------------------------------------------------------------------------

CSV = {
    "one speed": (("respond", RIG), 360, ["time_in_period [s]", "crank_angle [rad]"]),
    "motor": (("respond", RIG, "--drive"), 360,
              ["time_in_period [s]", "gauges.gauge.displacement [m]"]),
    "range": (("respond", RIG, "--speed", "150:200 rpm", "--speeds", "7"), 8, ["speed [rad/s]"]),
    "from rest": (("simulate", RIG, "0.2 s"), 2001,
                  ["time [s]", "crank_angle [rad]", "crank_speed [rad/s]"]),
}  # fmt: skip


@pytest.mark.parametrize(("words", "count", "first"), CSV.values(), ids=CSV)
def test_csv(words: tuple[str, ...], count: int, first: list[str]) -> None:
    result = equipoise(*words, "--csv", "out.csv")
    assert succeeded(result)
    assert result.err == "wrote out.csv\n"
    header, values = table("out.csv")
    assert header[: len(first)] == first
    assert len(set(header)) == len(header) > 3
    assert all(re.fullmatch(r"[a-z_.]+ \[[^\]]+\]", name) for name in header)
    assert values.shape == (count, len(header))
    # A mount that turns the support back hands on no force.
    texts = [k for k, name in enumerate(header) if name != "mounts.bearing.transmissibility [1]"]
    assert np.all(np.isfinite(values[:, texts]))


@pytest.mark.parametrize("words", [(), ("--speed", "-193 rpm"), ("--model", "exact"),
                                   ("--speed", "-193 rpm", "--drive")])  # fmt: skip
def test_columns_are_derivatives_of_each_other_by_time(words: tuple[str, ...]) -> None:
    """Whichever way the crank turns; both ends of the bound are the solver's own."""
    succeeded(equipoise("respond", "--full", RIG, *words, "--csv", "out.csv"))
    header, values = table("out.csv")
    columns = dict(zip(header, values.T, strict=True))
    time = columns["time_in_period [s]"]
    order = 1j * np.fft.rfftfreq(len(time), time[1]) * math.tau
    signals = [columns[f"gauges.gauge.{name}"] for name in
               ("displacement [m]", "velocity [m/s]", "acceleration [m/s^2]")]  # fmt: skip
    for signal, rate in pairwise(signals):
        result = np.fft.irfft(order * np.fft.rfft(signal), len(signal))
        np.testing.assert_allclose(result, rate, rtol=0, atol=1e-8 * np.max(np.abs(rate)))


def test_csv_and_json_together() -> None:
    result = equipoise("respond", RIG, "--csv", "out.csv", "--json")
    content = json.loads(result.out)
    assert result.err == "wrote out.csv\n"
    header, values = table("out.csv")
    moved = values[:, header.index("gauges.gauge.displacement [m]")]
    assert np.ptp(moved) == pytest.approx(1e-3 * peak(content), rel=1e-3)


def test_csv_of_a_range_is_the_json_of_it() -> None:
    words = ("respond", RIG, "--speed", "150:200 rpm", "--speeds", "4", "--csv", "out.csv")
    content = json.loads(succeeded(equipoise(*words, "--json")))
    header, values = table("out.csv")
    columns = dict(zip(header, values.T.tolist(), strict=True))
    assert columns["speed [rad/s]"] == content["speed"]
    gauge = content["gauges"]["gauge"]
    assert columns["gauges.gauge.peak_to_peak [m]"] == gauge["peak_to_peak"]
    assert columns["gauges.gauge.velocity_rms [m/s]"] == gauge["velocity"]["rms"]
    assert columns["mounts.spring.rms [N]"] == content["mounts"]["spring"]["rms"]


# Those of tables from rest are read on every change.
@pytest.mark.exhaustive
def test_units_of_the_tables() -> None:
    text = succeeded(equipoise("respond", "--full", RIG, "--units", "um, rad/s, cm/s, gn, kgf"))
    numbers = cells(text, "gauge")
    assert re.search(r"^ +um +um +cm/s +cm/s +gn +gn$", text, re.MULTILINE)
    figures = answer()["gauges"]["gauge"]
    wanted = [
        signal[key] / unit
        for signal, unit in ((figures, 1e-6), (figures["velocity"], 0.01),
                             (figures["acceleration"], 9.80665))
        for key in ("peak_to_peak", "rms")
    ]  # fmt: skip
    assert list(map(float, numbers)) == pytest.approx(wanted, rel=5e-4)
    spring = answer()["mounts"]["spring"]["mean"] / 9.80665
    assert float(cells(text, "spring")[0]) == pytest.approx(spring, rel=5e-4)
    assert answer("--units", "um, rad/s") == answer()
    words = ("--speed", "20:300 rpm", "--speeds", "2", "--units", "rad/s, cm")
    text = succeeded(equipoise("respond", "--full", RIG, *words))
    assert "gauge, cm" in text and "at rad/s" in text
    pitch = succeeded(equipoise("respond", "--full", "walking-transplanter", "--units", "rad"))
    assert re.search(r"^ +rad +rad +rad/s +rad/s +rad/s.2 +rad/s.2$", pitch, re.MULTILINE)


def test_units_of_the_tables_from_rest() -> None:
    words = ("simulate", RIG, "0.5 s")
    usual = float(cells(succeeded(equipoise(*words)), "gauge")[1])
    text = succeeded(equipoise(*words, "--units", "um, rad/s"))
    assert float(cells(text, "gauge")[1]) == pytest.approx(1000 * usual, rel=1e-3)
    assert "crank speed, rad/s" in text


# -- rows ------------------------------------------------------------------------------------------


@EXHAUSTIVE  # On every change: two rows in `secondroute/test_vibration.py`.
def test_rows_in_opposite_phase_on_a_float() -> None:
    """What is left shakes less, and the float stays on the ground."""
    rows = changed("walking-transplanter", ('lateral = "150 mm"', 'phase = "180 deg"'))
    content = read("respond", rows, "--model", "exact")
    together = read("respond", "walking-transplanter", "--model", "exact")
    assert peak(content, "planting_part") < 0.2 * peak(together, "planting_part")
    assert content["mounts"]["float"]["lifts_off"] == 0 < together["mounts"]["float"]["lifts_off"]


# -- modes -----------------------------------------------------------------------------------------


@pytest.mark.exhaustive(but=["yamashita-rig-counterweight", "walking-transplanter"])
@pytest.mark.parametrize("name", GAUGES)
def test_modes(name: str) -> None:
    machine = eq.load(name)
    assert machine.support is not None
    content = read("modes", name)
    count = len(machine.support.coordinates)
    assert set(content) >= {"title", "model", "coordinates", "modes", "preloads"}
    assert content["coordinates"] == list(machine.support.coordinates)
    assert len(content["modes"]) == count
    assert set(content["preloads"]) == set(machine.support.mounts)
    for key in ("mass", "damping", "stiffness"):
        assert np.shape(content[key]) == (count, count)
    for mode in content["modes"]:
        assert mode["natural_frequency"] == pytest.approx(math.tau * mode["hertz"])
        assert len(mode["shape"]) == count
        assert set(mode["gauges"]) == GAUGES[name]
    text = succeeded(equipoise("modes", name))
    for title in ("Natural frequencies", "Crank speeds that meet a mode", "Shapes;",
                  "Shapes at the gauges", "Mounts at rest"):  # fmt: skip
        assert re.search(f"^{title}", text, re.MULTILINE), title


def test_modes_of_the_rig() -> None:
    (mode,) = read("modes", RIG, "--model", "linear")["modes"]
    assert mode["natural_frequency"] == pytest.approx(12.415, abs=5e-4)
    assert mode["gauges"]["gauge"] == pytest.approx([1.5, 0])  # m in a rad: 1.5 m from the pivot
    text = succeeded(equipoise("modes", RIG, "--model", "linear"))
    assert cells(text, "1")[:4] == ["12.42", "1.976", "118.6", "0.006232"]
    (spread,) = read("modes", RIG)["modes"]
    assert 1e-3 < abs(spread["natural_frequency"] / mode["natural_frequency"] - 1) < 0.01


@pytest.mark.parametrize("model", MODELS)
def test_modes_of_a_model_are_those_beside_its_response(model: str) -> None:
    assert answer("--model", model)["modes"] == [
        {key: value for key, value in mode.items() if key != "gauges"}
        for mode in read("modes", RIG, "--model", model)["modes"]
    ]


# -- analyze by order ------------------------------------------------------------------------------

TABLES = (
    "Acceleration of the common centre of mass along x",
    "Acceleration of the common centre of mass along y",
    *("Shaking force along x", "Shaking force along y", "Shaking moment", "Drive torque"),
)


def test_orders_of_analyze() -> None:
    """Table 4 of Yamashita and others counts from the frame's line, at -83 deg."""
    words = ("analyze", "yamashita-1", "--orders", "5", "--crank-zero", "-83 deg")
    text = succeeded(equipoise(*words))
    assert "theta: crank angle from -83.0 deg" in text
    assert all(title in text for title in TABLES)
    assert len(re.findall("^1  ", text, re.MULTILINE)) == len(TABLES)
    assert cells(text[text.index("centre of mass along y") :], "1")[3] == "111.0"
    parts = read(*words)["by_order"]
    assert {len(values) for part in parts.values() for values in part.values()} == {6}
    whole = read("analyze", "yamashita-1")
    angle = np.array(whole["crank_angle"]) - math.radians(-83)
    for name, values in (
        ("shaking_force.x", whole["shaking_force"]["x"]),
        ("shaking_moment", whole["shaking_moment"]),
        ("drive_torque", whole["drive_torque"]),
    ):
        for n in range(1, 6):
            for key, wave in (("a", np.cos), ("b", np.sin)):
                wanted = 2 * np.mean(np.array(values) * wave(n * angle))
                assert parts[name][key][n] == pytest.approx(wanted, abs=1e-12)


def test_orders_beside_json_and_csv() -> None:
    words = ("analyze", "yamashita-1", "--orders", "3")
    assert "by_order" not in read("analyze", "yamashita-1")
    by_x, turned = (read(*words, *more)["by_order"] for more in ((), ("--crank-zero", "90 deg")))
    for name, part in by_x.items():
        np.testing.assert_allclose(part["harmonics"], turned[name]["harmonics"], atol=1e-13)
    assert equipoise(*words, "--csv", "out.csv").err == "wrote out.csv\n"
    assert len(table("out.csv")[1]) == 360


# -- more than one steady state --------------------------------------------------------------------

WALKING = "walking-transplanter"


@pytest.mark.parametrize("drive", [[], pytest.param(["--drive"], marks=EXHAUSTIVE)])
def test_the_louder_of_two_steady_states(drive: list[str]) -> None:
    """A float that lets go softens its machine, which then jumps below its resonance."""
    two = read("respond", WALKING, "--model", "exact", "--speed", "168 rpm", *drive)
    assert two["gauges"]["planting_part"]["peak_to_peak"] == pytest.approx(26.2e-3, abs=0.1e-3)
    assert any("another steady state" in note for note in two["notes"])
    first = read("respond", WALKING, "--model", "exact", "--speed", "172 rpm", *drive)
    assert first["gauges"]["planting_part"]["peak_to_peak"] == pytest.approx(25.7e-3, abs=0.1e-3)
    assert first["stable"]
    assert not any("another steady state" in note for note in first["notes"])


@EXHAUSTIVE  # On every change: `test_the_louder_of_two_steady_states`, at two speeds.
def test_both_branches_of_a_range() -> None:
    result = read(
        "respond", WALKING, "--model", "exact", "--speed", "160:175 rpm", "--speeds", "16"
    )
    readings = result["gauges"]["planting_part"]["peak_to_peak"]
    assert max(readings) == pytest.approx(26.2e-3, abs=0.3e-3)
    assert any(re.search("two steady states at .* rpm", note) for note in result["notes"])


def test_what_does_nothing_is_reported() -> None:
    text = example_text(RIG) + '\n[support.gauges.roll]\naxis = "roll"\n'
    speeding = ('speed = "193 rpm"', 'speed = "193 rpm"\nacceleration = "5 rad/s^2"')
    notes = read("respond", written(text, speeding))["notes"]
    assert any("gauges.roll does nothing: the support cannot roll" in note for note in notes)
    assert any("acceleration of the drive is ignored" in note for note in notes)
