"""`equipoise exposure` as a user runs it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.exposure.spectra import weigh_orders
from equipoise.exposure.weighting import NOMINAL, factor
from equipoise.mechanism.parts.support import TIME_IN_PERIOD
from surface.running import command_lines, equipoise, read, refused, refuses, succeeded

RATE = 4000.0
TIME = np.arange(int(8 * RATE)) / RATE
WAVE = np.sqrt(2) * np.sin(2 * np.pi * 80.0 * TIME)
TASKS = "task,acceleration [m/s^2],duration [h]\nbrush saw,4.6,2\nfelling,6,1\nstripping,3.6,2\n"


def columns(header: str, *values: Any) -> str:
    rows = [",".join(f"{cell:.6f}" for cell in row) for row in zip(*values, strict=True)]
    return "\n".join([header, *rows]) + "\n"


SIGNAL = columns("time [s],x [m/s^2],y [m/s^2],z [m/s^2]", TIME, 10 * WAVE, 2 * WAVE, -WAVE)
LINES = columns("frequency [Hz],x [m/s^2],y [m/s^2]", [50, 100], [3, 4], [0, 1])
BANDS = columns("frequency [Hz],x [m/s^2]", NOMINAL, np.linspace(1, 9, 24))
FILES = {"signal.csv": SIGNAL, "lines.csv": LINES, "bands.csv": BANDS, "tasks.csv": TASKS}


@pytest.fixture(autouse=True)
def measured(folder: Path) -> None:
    """Good files of every kind."""
    for name, text in FILES.items():
        Path(name).write_text(text, encoding="utf-8")


def as_json(*words: str) -> dict[str, Any]:
    return read("exposure", *words)


# -- a day -----------------------------------------------------------------------------------------


def test_one_value() -> None:
    """ISO 5349-2, E.2.1."""
    shown = succeeded(equipoise("exposure", "7.4 m/s^2 for 2.5 h"))
    assert re.search(
        r"^7\.4 m/s\^2 +7\.400 +2\.500 +4\.137 +100 +0\.9131 +3\.652 +2\.000$", shown, re.M
    )
    assert "A(8) = 4.137 m/s^2, above the action value of 2.5 m/s^2 (2002/44/EC)" in shown
    assert "allowed, but the employer has to act" in shown
    assert "reaches the action value after 54 min, the limit value after 3 h 39 min" in shown
    assert "after 7.1 years (ISO 5349-1, Annex C)" in shown
    assert "Japan, guideline of 2009: such work for at most 2 h a day" in shown


def test_tasks_in_a_file_and_in_words_are_the_same() -> None:
    words = (
        "brush saw: 4.6 m/s^2 for 2 h",
        "felling: 6 m/s^2 for 60 min",
        "stripping: 3.6 m/s^2 for 2 h",
    )
    by_file, by_words = as_json("tasks.csv"), as_json(*words)
    assert by_file == by_words
    assert by_file["a8"] == pytest.approx(3.6097, abs=1e-4)
    assert [task["name"] for task in by_file["tasks"]] == ["brush saw", "felling", "stripping"]
    assert by_file["verdict"] == "above the action value"
    shown = succeeded(equipoise("exposure", "tasks.csv"))
    assert re.search(r"^felling +6\.000 +1\.000 +2\.121 +35 ", shown, re.M)
    assert re.search(r"^all of them +4\.566 +5\.000 +3\.610 +100 ", shown, re.M)
    assert "This mix of work reaches the action value after 2 h 23 min" in shown


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("1 m/s^2 for 2 h", ("below the action value", "acceptable", "more than 24 h")),
        ("2.5 m/s^2 for 8 h", ("below the action value", "acceptable", "after 8 h,")),
        ("20 m/s^2 for 1 h", ("above the limit value", "nobody may be exposed", "30 min a day\n")),
        ("0 m/s^2 for 1 h", ("A(8) = 0 m/s^2, below the action value", "acceptable")),
    ],
)
def test_plain_words(value: str, words: tuple[str, ...]) -> None:
    shown = succeeded(equipoise("exposure", value))
    assert all(word in shown for word in words), shown
    assert "nan" not in shown and "inf" not in shown


def test_idling_and_racing() -> None:
    content = as_json("--idle", "1 m/s^2", "--racing", "7 m/s^2", "--duration", "8 h")
    assert content["a_hv"] == pytest.approx(5.0)
    assert content["tasks"][0]["name"] == "idling and racing"


# -- what is measured ------------------------------------------------------------------------------


def test_a_signal() -> None:
    a_hv = np.sqrt(105) * float(factor(80.0))
    shown = succeeded(equipoise("exposure", "signal.csv", "--duration", "2 h"))
    lines = shown.splitlines()
    assert lines[:2] == ["signal.csv", "signal, 3 axes, 8.000 s at 4000 Hz"]
    assert re.search(r"^x +10\.00 +2\.0\d\d$", shown, re.M)
    assert re.search(rf"^total value a_hv, root of the sum of squares +{a_hv:.3f}$", shown, re.M)
    assert "Most of it: band of 80 Hz, 100 % of the weighted mean square; axis x" in shown
    assert f"A(8) = {a_hv / 2:.3f} m/s^2, below the action value" in shown
    content = as_json("signal.csv", "--duration", "2 h")
    assert content["a8"] == pytest.approx(a_hv / 2, rel=1e-4)
    (file,) = content["measured"]
    assert (file["name"], file["kind"], file["axes"]) == ("signal.csv", "signal", ["x", "y", "z"])
    assert file["sampling_rate"] == pytest.approx(RATE) and file["duration"] == pytest.approx(8)
    assert file["a_h"] == pytest.approx([10, 2, 1], rel=1e-4)
    assert file["dominant_band"] == 80 and file["notes"] == []


def test_a_spectrum_without_a_time() -> None:
    content = as_json("lines.csv")
    assert content["a8"] is None and content["measured"][0]["kind"] == "spectrum"
    assert content["a_hv"] == content["measured"][0]["a_hv"]
    (task,) = content["tasks"]
    assert task["a_hv"] == content["measured"][0]["a_hv"] and task["duration"] is None
    assert task["time_to_limit"] == pytest.approx(4 * task["time_to_action"])
    shown = succeeded(equipoise("exposure", "lines.csv"))
    assert "note: the total value is that of two axes and may be too low" in shown
    assert re.search(r"^lines\.csv +1\.178 +over 24 +over 24 +2\.000$", shown, re.M)
    assert "There is no daily exposure without a time" in shown


def test_options_on_spectra() -> None:
    plain, bands, already, single = (
        as_json("bands.csv", *more)["measured"][0]
        for more in ((), ("--bands",), ("--weighted", "--bands"), ("--single-axis", "--bands"))
    )
    assert bands["kind"] == "bands" and "say so (bands)" in plain["notes"][0]
    assert 0 < abs(bands["a_hv"] - plain["a_hv"]) < 0.01 * plain["a_hv"]
    assert already["a_hw"][0] == pytest.approx(np.linalg.norm(np.linspace(1, 9, 24)))
    assert already["a_h"] is None
    assert single["a_hv"] == pytest.approx(1.7 * bands["a_hv"])
    shown = succeeded(equipoise("exposure", "bands.csv", "--bands", "--single-axis", "--weighted"))
    assert "spectrum in one-third-octave bands, 1 axis, weighted already" in shown
    assert "total value a_hv, 1.7 times the largest" in shown


def test_a_periodic_signal() -> None:
    part = TIME < 0.05
    text = columns("time [s],z [m/s^2]", TIME[part][::10], WAVE[part][::10])
    Path("period.csv").write_text(text, encoding="utf-8")
    assert "sampled at 400 Hz; give at least" in refused(equipoise("exposure", "period.csv"))
    (file,) = as_json("period.csv", "--periodic")["measured"]
    assert file["a_hw"] == pytest.approx([float(factor(80.0))], rel=1e-5)
    assert file["axes"] == ["z"]
    assert "nothing above half its sampling rate, 200 Hz" in file["notes"][0]


def test_a_response_is_weighed() -> None:
    """What `respond --csv` writes, against the orders of the response itself; its rows are a whole
    period, so that both have the same lines.
    """
    succeeded(equipoise("respond", "yamashita-rig", "--csv", "r.csv"))
    by_file = as_json("r.csv")["measured"][0]  # the file itself says that it is whole periods
    response = eq.respond(eq.load("yamashita-rig"))
    orders = response.gauges["gauge"].acceleration.amplitudes[1:]
    speed = eq.load("yamashita-rig").drive.speed
    by_orders = weigh_orders(speed, np.arange(1, len(orders) + 1), orders)
    # 360 samples fold orders above 180 back, which are below a millionth of the first here
    assert by_file["a_hv"] == pytest.approx(by_orders.a_hv, rel=1e-6)
    assert as_json("r.csv", "--periodic", "--gauge", "gauge")["measured"][0] == by_file
    assert "no gauge is called 'guage'; did you mean 'gauge'?" in refused(
        equipoise("exposure", "r.csv", "--gauge", "guage")
    )
    text = Path("r.csv").read_text(encoding="utf-8")
    assert text.startswith(f"{TIME_IN_PERIOD} [s],")
    Path("old.csv").write_text(text.replace(TIME_IN_PERIOD, "time", 1), encoding="utf-8")
    assert as_json("old.csv", "--periodic")["measured"][0] == by_file | {"name": "old.csv"}


def test_gauges_of_a_response_are_axes_where_they_are_named() -> None:
    rows = np.arange(100) / 4000.0, np.sin(np.arange(100)), np.cos(np.arange(100))
    heads = "time [s],gauges.a b.acceleration [m/s^2],gauges.c.acceleration [m/s^2]"
    Path("r.csv").write_text(columns(heads, *rows), encoding="utf-8")
    several = refused(equipoise("exposure", "r.csv", "--periodic"))
    assert "there are the gauges 'a b', 'c'; name that of the hand" in several
    both = as_json("r.csv", "--periodic", "--gauge", "c", "--gauge", "a b")["measured"][0]
    Path("x.csv").write_text(columns("time [s],y [m/s^2],x [m/s^2]", *rows), encoding="utf-8")
    axes = as_json("x.csv", "--periodic")["measured"][0]
    assert both["a_hv"] == pytest.approx(axes["a_hv"], rel=1e-12)
    Path("r.csv").write_text(f"{heads}\n0,1,2\n0.1,2\n", encoding="utf-8")
    short = refused(equipoise("exposure", "r.csv", "--gauge", "c"))
    assert short.startswith("r.csv, line 3: got 2 values; the header has 3 columns")


def test_a_spectrum_of_nothing() -> None:
    Path("still.csv").write_text("frequency [Hz],x [gn]\n50,0\n", encoding="utf-8")
    shown = succeeded(equipoise("exposure", "still.csv", "--duration", "1 h"))
    assert "A(8) = 0 m/s^2, below the action value" in shown and "most of it" not in shown


def test_durations_of_several_files() -> None:
    both = as_json("signal.csv", "mowing: 3 m/s^2 for 1 h", "lines.csv", "--duration", "30 min")
    assert [task["duration"] for task in both["tasks"]] == [1800, 3600, 1800]
    each = as_json("signal.csv", "lines.csv", "--duration", "30 min", "--duration", "2 h")
    assert [task["duration"] for task in each["tasks"]] == [1800, 7200]
    assert [file["name"] for file in each["measured"]] == ["signal.csv", "lines.csv"]


def test_odd_names() -> None:
    name = "odd [1] %s $x$ 機.csv"
    Path(name).write_text(LINES, encoding="utf-8")
    assert succeeded(equipoise("exposure", name, "--plot", "p")).startswith(f"{name}\n")
    Path("3 m/s^2 for 2 h".replace("/", "")).write_text(LINES, encoding="utf-8")
    assert as_json("3 ms^2 for 2 h")["measured"][0]["kind"] == "spectrum"
    content = as_json(f"{'long ' * 100}: 3 m/s^2 for 2 h", "\x1b[1m: 3 m/s^2 for 2 h")
    assert len(content["tasks"]) == 2
    shown = succeeded(equipoise("exposure", f"{'long ' * 100}\x1b: 3 m/s^2 for 2 h"))
    assert "\x1b" not in shown and max(map(len, shown.splitlines())) < 130


# -- refused ---------------------------------------------------------------------------------------

CONTENTS = {
    "empty": ("", "x.csv, line 1: got no column; the header is time [s],x [m/s^2]"),
    "misspelt": (SIGNAL.replace("x [", "xx ["), "x.csv, line 1: got the column 'xx [m/s^2]'"),
    "over speeds": (
        "speed [rad/s],gauges.a.acceleration_rms [m/s^2]\n1,1\n",
        "x.csv, line 1: there are gauges, but none with accelerations over time, which `equip",
    ),
    "wrong unit": (SIGNAL.replace("[s]", "[m]"), "x.csv, line 1, column time: got '0 m'; m is the"),
    "nan": (f"{SIGNAL}8.0,nan,1,1\n", "x.csv, line 32002, column x: got 'nan'; give a finite"),
    "gap": (f"{SIGNAL}9.0,1,1,1\n", "x.csv, line 32001, column time: 7.99975 s is not where equal"),
    "slow": (columns("time [s],x [gn]", TIME[::4], WAVE[::4]), "x.csv: sampled at 1000 Hz; give"),
    "short": (columns("time [s],x [gn]", TIME[:999], WAVE[:999]), "x.csv: the record takes 0.25 s"),
    "one row": ("time [s],x [gn]\n0,1\n", "x.csv: time: got one sample; give a record"),
    "no band": (
        "frequency [Hz],x [gn]\n70,1\n",
        "x.csv: frequency: got 70 Hz; give middles of one",
    ),
    "negative": (
        "frequency [Hz],x [gn]\n8,-1\n",
        "x.csv, line 2, column x: got -9.80665; give RMS",
    ),
    "no hours": (f"{TASKS}raking,3,0\n", "x.csv, line 5, column duration: got 0 h; give more than"),
    "no time": (f"{TASKS}raking,3,\n", "x.csv, line 5, column duration: got ''; give a finite"),
    "negative task": (
        f"{TASKS}raking,-3,1\n",
        "x.csv, line 5, column acceleration: got -3 m",
    ),
    "long day": (f"{TASKS}raking,3,20\n", "the tasks take 25 h together; give at most 24 h a day"),
}


@pytest.mark.parametrize(("content", "said"), CONTENTS.values(), ids=CONTENTS)
def test_a_file_that_is_refused(content: str, said: str) -> None:
    Path("x.csv").write_text(content, encoding="utf-8")
    words = ["--bands"] if content.startswith("freq") else []
    assert refused(equipoise("exposure", "x.csv", "--plot", "pictures", *words)).startswith(said)
    assert not Path("pictures").exists()


WORDS = {
    "exposure": {
        "": 'give a value, "7.4 m/s^2 for 2.5 h", or the path of a CSV file',
        "none.csv": "none.csv: there is no such file",
        ".": ".: this is a directory; give a file",
        "''": "'': there is no such file",
        "'7.4 m/s^2'": "got '7.4 m/s^2'; say for how long a day, as in \"7.4 m/s^2 for",
        "'a: 7.4 m/s^2 for'": "got 'a: 7.4 m/s^2 for'; say for how long a day",
        "7.4": "got '7.4'; say for how long a day",
        "'7.4 m/s for 2 h'": "'7.4 m/s for 2 h': got '7.4 m/s'; m/s is the unit of a",
        "'7.4 m/s^2 for 2'": "'7.4 m/s^2 for 2': got '2'; the unit is missing; give a",
        "'7,4 m/s^2 for 2 h'": "the decimal sign is a point, not a comma",
        "'a: nan m/s^2 for 2 h'": "give a finite number and a unit",
        "'a: -4 m/s^2 for 2 h'": "got 'a: -4 m/s^2 for 2 h'; give an acceleration",
        "'a: 4 m/s^2 for 0 h'": "a: duration: got 0 h; give more than 0 and at most 24 h",
        "'4 m/s^2 for 25 h'": "4 m/s^2: duration: got 25 h; give more than 0 and",
        "--idle '3 m/s^2'": "--idle belongs to --racing; give both",
        "--racing '3 m/s^2'": "--racing belongs to --idle; give both",
        "--idle '3 gn' --racing '-3 gn'": "--racing: got '-3 gn'; give an accelerat",
        "--idle 3 --racing '3 gn'": "--idle: got '3'; the unit is missing",
        "lines.csv --duration '0 h'": "--duration: got '0 h'; give more than 0",
        "lines.csv --duration '2 m'": "--duration: got '2 m'; m is the unit",
        "lines.csv --duration '1 h' --duration '1 h'": "--duration: given 2",
        "tasks.csv --duration '1 h'": "--duration belongs to a signal, a spectrum",
        "tasks.csv lines.csv": "lines.csv: the time of exposure is missing; give it by",
        "signal.csv --bands": "--bands belongs to a spectrum; give one, or leave it",
        "tasks.csv --weighted": "--weighted belongs to a signal or a spectrum; give",
        "signal.csv --single-axis": "--single-axis belongs to a signal or",
        "lines.csv --periodic": "--periodic belongs to a signal; give one, or leave",
        "'3 m/s^2 for 1 h' --gauge x": "--gauge belongs to a response of gauges; give one",
        "signal.csv --gauge x": "signal.csv, line 1: no gauge is called 'x'; there are none",
        "tasks.csv --hours 3": "Unknown option: --hours",
        "tasks.csv --format png": "--format belongs to --plot; give both",
        "tasks.csv --plot ''": "--plot: got ''; give the name of a folder",
        "tasks.csv --plot tasks.csv": "--plot: got 'tasks.csv'; give the name",
    },
}


@command_lines(WORDS)
def test_words_that_are_refused(line: str, said: str) -> None:
    refuses(line, said)
