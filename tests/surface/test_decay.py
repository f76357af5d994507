"""`equipoise decay` as a user runs it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from surface.running import command_lines, equipoise, read, refused, refuses, succeeded


def text(time: Any, values: Any, header: str = "time [s],displacement [mm]") -> str:
    rows = [f"{t:.6f},{x:.6f}" for t, x in zip(time, values, strict=True)]
    return "\n".join([header, *rows]) + "\n"


TIME = np.linspace(0.0, 2.6, 800)
RECORD = eq.measured.simulate_decay(
    TIME,
    natural_frequency=12.4,
    damping_ratio=0.03,
    coulomb=0.4,
    start=20.0,
    center=5.0,
    noise=0.1,
)
GOOD = text(RECORD.time, RECORD.displacement)


@pytest.fixture(autouse=True)
def records(folder: Path) -> None:
    """Good records of lengths and angles."""
    Path("decay.csv").write_text(GOOD, encoding="utf-8")
    Path("angle.csv").write_text(GOOD.replace("displacement [mm]", "angle [deg]"), encoding="utf-8")


def as_json(*words: str) -> dict[str, Any]:
    return read("decay", *words)


def test_tables() -> None:
    shown = succeeded(equipoise("decay", "decay.csv"))
    lines = shown.splitlines()
    assert lines[0] == "decay.csv"
    assert re.match(r"800 samples over 2\.600 s, noise 0\.\d+ mm; 10 half-swings from", lines[1])
    assert re.match(r"line of half-swings: next = 0\.\d+ height - 1\.\d+ mm", lines[2])
    assert "95 % interval" in shown
    row = re.search(r"^damping ratio +(\S+) +(\S+) to (\S+) +(\S+) +(\S+) to (\S+)$", shown, re.M)
    assert row is not None
    values = [float(cell) for cell in row.groups()]
    assert values[1] < values[0] < values[2]
    assert values[4] < 0.03 < values[5]
    assert re.search(r"^Coulomb friction over stiffness, mm +0\.\d+", shown, re.M)
    for absent in ("mass", "nan", "inertia"):
        assert absent not in shown


def test_tables_with_a_stiffness() -> None:
    shown = succeeded(equipoise("decay", "decay.csv", "--stiffness", "2 N/mm"))
    for name in ("mass, kg", "viscous damping, N s/m", "Coulomb friction, N"):
        assert re.search(rf"^{name} +\S+ +\S+ to \S+", shown, re.M)
    shown = succeeded(equipoise("decay", "angle.csv", "--stiffness", "2 N m/rad"))
    for name in (
        "moment of inertia, kg m^2",
        "viscous damping, N m s/rad",
        "Coulomb friction, N m",
    ):
        assert re.search(rf"^{re.escape(name)} +\S+ +\S+ to \S+", shown, re.M)
    assert "over stiffness, deg" in shown


def test_json() -> None:
    content = as_json("decay.csv", "--stiffness", "2 N/mm")
    assert {"kind", "samples", "duration", "confidence", "stiffness"} < set(content)
    assert content["kind"] == "length"
    assert content["stiffness"] == 2000
    assert content["confidence"] == 0.95
    assert len(content["half_swings"]["heights"]) == 10
    assert set(content["half_swings"]["slope"]) == {"value", "low", "high"}
    for method in ("by_line", "by_record"):
        part = content[method]
        assert part["natural_angular_frequency"]["value"] == pytest.approx(12.4, rel=5e-3)
        assert part["mass"]["value"] == pytest.approx(2000 / 12.4**2, rel=0.01)
        assert part["coulomb_force"]["value"] == pytest.approx(0.4e-3 * 2000, rel=0.1)
        for name, quantity in part.items():
            if isinstance(quantity, dict):
                assert quantity["low"] < quantity["value"] < quantity["high"], name
    assert content["by_record"]["center"] == pytest.approx(5e-3, rel=0.02)
    assert content["notes"] == []


def test_arms() -> None:
    """The paper's rig: read 1.5 m from the pivot, its spring at 1.35 m."""
    words = ("--arm", "1.5 m", "--stiffness", "182 kgf/m", "--spring-arm", "1.35 m")
    content = as_json("decay.csv", *words)
    assert content["kind"] == "angle"
    assert content["stiffness"] == pytest.approx(182 * 9.80665 * 1.35**2)
    plain = as_json("decay.csv")
    heights = [height / 1.5 for height in plain["half_swings"]["heights"]]
    assert content["half_swings"]["heights"] == pytest.approx(heights)
    torsional = as_json(
        "decay.csv", "--arm", "1.5 m", "--stiffness", f"{content['stiffness']!r} N m/rad"
    )
    for name, quantity in content["by_record"].items():
        assert torsional["by_record"][name] == pytest.approx(quantity, rel=1e-9), name


def test_confidence() -> None:
    wide, narrow = (as_json("decay.csv", "--confidence", share) for share in ("0.99", "0.5"))
    for name in ("damping_ratio", "natural_frequency"):
        first, other = wide["by_record"][name], narrow["by_record"][name]
        assert first["value"] == other["value"]
        assert first["low"] < other["low"]
    assert "99 % interval" in succeeded(equipoise("decay", "decay.csv", "--confidence", "0.99"))


def test_three_half_swings_have_no_interval_by_the_line() -> None:
    part = TIME < 0.8
    Path("short.csv").write_text(text(TIME[part], RECORD.displacement[part]), encoding="utf-8")
    content = as_json("short.csv")
    assert content["by_line"]["damping_ratio"]["low"] is None
    shown = succeeded(equipoise("decay", "short.csv"))
    assert re.search(r"^damping ratio +\S+ +none +\S+ +\S+ to \S+", shown, re.M)
    assert "note: three half-swings have exactly one line" in shown


def test_notes_are_printed() -> None:
    time = np.linspace(0.0, 9.0, 3000)
    record = eq.measured.simulate_decay(
        time, natural_frequency=12.4, damping_ratio=0.04, noise=0.01
    )
    Path("long.csv").write_text(text(time, record.displacement), encoding="utf-8")
    shown = succeeded(equipoise("decay", "long.csv"))
    assert "\nnote: Coulomb friction cannot be told from noise" in shown
    assert as_json("long.csv")["notes"]


def test_odd_file_names() -> None:
    name = "odd [1] %s $x$ 機.csv"
    Path(name).write_text(GOOD, encoding="utf-8")
    assert succeeded(equipoise("decay", name, "--plot", "p")).startswith(f"{name}\n")


# -- refused ---------------------------------------------------------------------------------------

RECORDS = {
    "header": (
        GOOD.replace("displacement", "height"),
        "x.csv, line 1: got the column 'height [mm]'",
    ),
    "no unit": (
        GOOD.replace(" [mm]", ""),
        "x.csv, line 1, column displacement: the unit is missing",
    ),
    "text": (f"{GOOD}9,high\n", "x.csv, line 802, column displacement: got 'high'; give a finite"),
    "time": (f"{GOOD}0,1\n", "x.csv, line 802, column time: the times must rise from row to row"),
    "too short": (text(range(5), range(5)), "x.csv: got 5 samples; give at least 12, over three"),
    "constant": (
        text(TIME, 0 * TIME + 3),
        "x.csv: the displacement does not change; give a record",
    ),
    "growing": (
        text(TIME, np.exp(TIME) * np.sin(12.4 * TIME)),
        "x.csv: the swings grow from the first to the last; give a record of a decay, in which",
    ),
    "few swings": (
        text(TIME[TIME < 0.6], RECORD.displacement[TIME < 0.6]),
        "x.csv: found 2 of at least 3 free half-swings above the noise",
    ),
    "coarse": (
        text(TIME[::20], RECORD.displacement[::20]),
        "x.csv: the largest swings take about 4 samples each; take 6 or more in a half-swing",
    ),
    "nothing": ("", "x.csv, line 1: got no column; the header is time [s],displacement [mm] or"),
}


@pytest.mark.parametrize(("content", "said"), RECORDS.values(), ids=RECORDS)
def test_a_record_that_is_refused(content: str, said: str) -> None:
    Path("x.csv").write_text(content, encoding="utf-8")
    assert refused(equipoise("decay", "x.csv", "--plot", "pictures")).startswith(said)
    assert not Path("pictures").exists()


WORDS = {
    "decay": {
        "none.csv": "none.csv: there is no such file",
        ".": ".: this is a directory; give a file",
        "''": "'': there is no such file",
        "decay.csv --stiffness '-2 N/mm'": "--stiffness: got '-2 N/mm'",
        "decay.csv --arm '0 m'": "--arm: got '0 m'; give more than 0",
        "decay.csv --stiffness '2 kg'": "--stiffness: got '2 kg'; kg is the",
        "decay.csv --stiffness 2": "--stiffness: got '2'; the unit is m",
        "decay.csv --arm '2 deg'": "--arm: got '2 deg'; deg is the unit of an",
        "angle.csv --arm '1 m'": "--arm makes an angle of a length, but the record has",
        "decay.csv --arm '1 m' --spring-arm '1 m'": "--spring-arm belongs to --stiffness; give",
        "decay.csv --stiffness '2 N/mm' --spring-arm '1 m'": (
            "--spring-arm belongs to a record of an"
        ),
        "decay.csv --stiffness '2 N m/rad'": "--stiffness: got '2 N m/rad', but the record has",
        "angle.csv --stiffness '2 N/mm'": "--stiffness: got '2 N/mm', but the record has a",
        "angle.csv --stiffness '2 N m/rad' --spring-arm '1 m'": (
            "--spring-arm belongs to a stiffness in"
        ),
        "decay.csv --confidence 95": "--confidence: got 95; give 0.95, or an",
        "decay.csv --confidence high": 'unable to convert "high" into float',
        "decay.csv --format png": "--format belongs to --plot; give both",
        "decay.csv --plot ''": "--plot: got ''; give the name of a folder",
        "decay.csv --plot decay.csv": "--plot: got 'decay.csv'; give the name",
        "": '"decay" parameter CSV requires an argument',
    },
}


@command_lines(WORDS)
def test_words_that_are_refused(line: str, said: str) -> None:
    refuses(line, said)
