"""Recorded decays, accelerations and tasks as CSV files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.exposure.daily import Task
from equipoise.schema.records import (
    Accelerations,
    parse_accelerations,
    parse_record,
    read_accelerations,
    read_record,
)
from equipoise.schema.tables import columns_of

ROWS = 20


def text(header: str = "time [s],displacement [mm]", **cells: str) -> str:
    """A record of twenty rows; ``r3="0.3,x"`` puts another row in place of the third."""
    rows = [cells.get(f"r{k}", f"{k / 10:g},{k % 4}") for k in range(ROWS)]
    return "\n".join([header, *rows]) + "\n"


def test_columns_in_si_units() -> None:
    record = parse_record(text("time [ms],displacement [in]"))
    np.testing.assert_allclose(record.time, 1e-4 * np.arange(ROWS), rtol=1e-15)
    np.testing.assert_allclose(record.displacement, 0.0254 * (np.arange(ROWS) % 4), rtol=1e-15)
    assert record.kind == "length"


def test_angles_and_columns_in_any_order() -> None:
    lines = [f"{k % 4},{k / 10:g}" for k in range(ROWS)]
    record = parse_record("\n".join(["angle [deg], time [s]", *lines]))
    assert record.kind == "angle"
    assert record.displacement[3] == pytest.approx(np.radians(3))
    assert record.time[3] == pytest.approx(0.3)


def test_exponents_spaces_blank_lines_and_a_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "decay.csv"
    path.write_text("\ufeff" + text(r5=" 5e-1 , +2.5E0 ", r6="\n,\n0.6,.5"), encoding="utf-8")
    record = read_record(path)
    assert record.displacement[5] == pytest.approx(2.5e-3)
    assert record.displacement[6] == pytest.approx(0.5e-3)
    assert len(record.time) == ROWS


def test_reading_as_a_whole_and_cell_by_cell_agree() -> None:
    plain = text("time [min],displacement [ft]")
    whole = parse_record(plain)
    slow = columns_of(plain, (("time", "displacement"),))
    np.testing.assert_allclose(whole.time, slow["time"], rtol=3e-16)
    np.testing.assert_allclose(whole.displacement, slow["displacement"], rtol=3e-16)


def test_recordings_as_other_programs_write_them() -> None:
    """A logger's, with semicolons, decimal commas and what it tells of itself."""
    lines = [f"{k / 10:g};{k % 4}".replace(".", ",") for k in range(ROWS)]
    record = parse_record("\n".join(["# Gerät 3", "time [s];angle [°]", *lines, "# end"]))
    np.testing.assert_allclose(record.time, np.arange(ROWS) / 10, rtol=1e-15)
    np.testing.assert_allclose(record.displacement, np.radians(np.arange(ROWS) % 4), rtol=1e-15)
    tasks = "task;acceleration [m/s^2];duration [h]\nsaw, 2,4 kW;4,5;2,5\n"
    assert parse_accelerations(tasks) == (Task("saw, 2,4 kW", 4.5, 9000.0),)


RIGHT = "the header is time [s],displacement [mm] or time [s],angle [deg]"
REFUSED = {
    "column": (text("time [s],height [mm]"), f"line 1: got the column 'height [mm]'; {RIGHT}"),
    "load": (text("crank_angle [deg],torque [N m]"), "line 1: got the column 'crank_angle [deg]'"),
    "no unit": (text("time [s],displacement"), "line 1, column displacement: the unit is missing"),
    "other unit": (text("time [s],displacement [kg]"), "line 1, column displacement: got '0 kg'"),
    "one column": ("time [s]\n1\n", f"line 1: got time; {RIGHT}"),
    "twice": (text("time [s],time [s]"), "line 1, column time: given twice"),
    "both": (
        "time [s],displacement [mm],angle [deg]\n1,1,1\n",
        "line 1: got time, displacement, a",
    ),
    "text": (text(r4="0.4,high"), "line 6, column displacement: got 'high'; give a finite number"),
    "empty cell": (text(r4="0.4,"), "line 6, column displacement: got ''; give a finite number"),
    "not finite": (text(r4="0.4,nan"), "line 6, column displacement: got 'nan'; give a finite"),
    "infinite": (text(r4="inf,1"), "line 6, column time: got 'inf'; give a finite number"),
    "underscore": (text(r4="0.4,1_0"), "line 6, column displacement: got '1_0'; give a finite"),
    "digits": (text(r4="0.4,１"), "line 6, column displacement: got '１'; give a finite"),
    "comma": (text(r4="0,4,1"), "line 6: got 3 values; the header has 2 columns"),
    "far": (text(r4="0.4,1e40"), "line 6, column displacement: got '1e40 mm', which no machine"),
    "falling": (text(r4="0.2,1"), "line 6, column time: the times must rise from row to row"),
    "empty": ("", f"line 1: got no column; {RIGHT}"),
    "no rows": ("time [s],displacement [mm]\n", "line 1: there are no rows below the header"),
    "short": ("time [s],displacement [mm]\n0,1\n1,2\n", "got 2 samples; give at least 12"),
}


@pytest.mark.parametrize(("given", "said"), REFUSED.values(), ids=REFUSED)
def test_refused_with_its_place(given: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "decay.csv"
    path.write_text(given, encoding="utf-8")
    with pytest.raises(eq.EquipoiseError) as caught:
        read_record(path)
    between = ": " if said.startswith("got") else ", "
    assert str(caught.value).startswith(f"{path}{between}{said}")


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    binary = tmp_path / "binary.csv"
    binary.write_bytes(b"time [s]\n\xff\xfe")
    for path, said in (
        (tmp_path, "this is a directory; give a file"),
        (tmp_path / "none.csv", "there is no such file"),
        (binary, "line 2 is not text in UTF-8"),
    ):
        with pytest.raises(eq.EquipoiseError) as caught:
            read_record(path)
        assert str(caught.value).startswith(f"{path}: {said}")


def test_records_may_be_larger_than_model_files(tmp_path: Path) -> None:
    path = tmp_path / "decay.csv"
    rows = "".join(f"{k / 1000:.3f},{k % 7}.123456789012345\n" for k in range(100_000))
    path.write_text(f"time [s],displacement [mm]\n{rows}", encoding="utf-8")
    assert path.stat().st_size > 2_000_000
    assert len(read_record(path).time) == 100_000


# -- accelerations and tasks -----------------------------------------------------------------------

SIGNAL = "time [s],x [m/s^2],y [m/s^2],z [m/s^2]"
SPECTRUM = "frequency [Hz],x [m/s^2],y [m/s^2],z [m/s^2]"
TASKS = "task,acceleration [m/s^2],duration [h]"


def signal(header: str = "time [s],x [m/s^2],z [m/s^2]", **cells: str) -> str:
    """A signal of twenty rows; ``r3="0.3,x,1"`` puts another row in place of the third."""
    rows = [cells.get(f"r{k}", f"{k / 10:g},{k % 4},-{k % 3}") for k in range(ROWS)]
    return "\n".join([header, *rows]) + "\n"


def measured(text: str) -> Accelerations:
    found = parse_accelerations(text)
    assert isinstance(found, Accelerations)
    return found


def test_axes_in_si_units() -> None:
    found = measured(signal("time [ms],x [gn],y [ft/s^2]"))
    assert (found.kind, found.axes) == ("time", ("x", "y"))
    np.testing.assert_allclose(found.at, 1e-4 * np.arange(ROWS), rtol=1e-15)
    np.testing.assert_allclose(found.values[0], 9.80665 * (np.arange(ROWS) % 4), rtol=1e-15)
    np.testing.assert_allclose(found.values[1], -0.3048 * (np.arange(ROWS) % 3), rtol=1e-15)


def test_axes_and_columns_in_any_order() -> None:
    found = measured("z [m/s^2],frequency [kHz],x [m/s^2]\n1,0.1,2\n3,0.2,4\n")
    assert (found.kind, found.axes) == ("frequency", ("x", "z"))
    np.testing.assert_array_equal(found.values, [[2, 4], [1, 3]])
    np.testing.assert_array_equal(found.at, [100, 200])


def test_axes_as_a_whole_and_cell_by_cell_agree() -> None:
    plain = signal()
    slow = measured(plain.replace("0.1,1", "0.1\N{NO-BREAK SPACE},1"))
    np.testing.assert_array_equal(measured(plain).values, slow.values)


def test_tasks() -> None:
    text = 'duration [min],task,acceleration [m/s^2]\n120,"mowing, edges",4.6\n\n60,,6\n'
    assert parse_accelerations(text) == (
        Task("mowing, edges", 4.6, 7200.0),
        Task("task 2", 6.0, 3600.0),
    )


def test_a_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "tasks.csv"
    path.write_text(f"\ufeff{TASKS}\nMähen 草刈り,4,2\n", encoding="utf-8")
    assert read_accelerations(path) == (Task("Mähen 草刈り", 4.0, 7200.0),)


OF_TASKS = f"is {TASKS}"
WHOLE = f"the header is {SIGNAL} or {SPECTRUM} or {TASKS}"
UNREAD = {
    "empty": ("", f"line 1: got no column; {WHOLE}"),
    "other": ("crank_angle [deg]\n0\n", f"line 1: got the column 'crank_angle [deg]'; {WHOLE}"),
    "misspelt": (signal("time [s],xx [m/s^2]"), f"'xx [m/s^2]'; the header is {SIGNAL}"),
    "acceleration": (signal("time [s],acceleration [m/s^2]"), "got the column 'acceleration [m/"),
    "no axis": ("time [s]\n1\n", f"line 1: got time; the header is {SIGNAL}"),
    "gap": (signal(r9="0.97,1,1"), "line 11, column time: 0.97 s is not where equal steps"),
    "negative": (f"{SPECTRUM}\n8,1,1,1\n\n10,1,-2,1\n", "line 4, column y: got -2; give RMS"),
    "below zero": (f"{SPECTRUM}\n-8,1,1,1\n10,1,2,1\n", "line 2, column frequency: got -8; give"),
    "down": (f"{SPECTRUM}\n8,1,1,1\n6,1,1,1\n", "line 3, column frequency: the frequencies must"),
    "task: no task": ("duration [h]\n1\n", f"got 0 columns task; the header {OF_TASKS}"),
    "task: two": ("task,task,duration [h]\na,b,1\n", "got 2 columns task; the header is"),
    "task: missing": ("task,duration [h]\na,1\n", f"line 1: got duration; the header is {TASKS}"),
    "task: unit": ("task,acceleration,duration [h]\na,1,1\n", "column acceleration: the unit is"),
    "task: wrong unit": (f"{TASKS[:-3]}[m]\na,1,1\n", "column duration: got '0 m'; m is the"),
    "task: cells": (f"{TASKS}\na,1\n", "line 2: got 2 values; the header has 3 columns"),
    "task: nan": (f"{TASKS}\na,1,1\nb,nan,1\n", "line 3, column acceleration: got 'nan'; give"),
    "task: no time": (f"{TASKS}\na,1,\n", "line 2, column duration: got ''; give a finite number"),
    "task: negative": (f"{TASKS}\na,-1,1\n", "line 2, column acceleration: got -1 m/s^2; give a"),
    "task: no hours": (f"{TASKS}\na,1,0\n", "line 2, column duration: got 0 h; give more than 0"),
    "task: long": (f"{TASKS}\na,1,25\n", "line 2, column duration: got 25 h; give more"),
    "task: none": (TASKS, "line 1: there are no rows below the header; give at least one"),
    "quotes": ('task,"acceleration\n', "line 1: this is no table of values with commas"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "said"), UNREAD.values(), ids=UNREAD)
def test_accelerations_are_refused(text: str, said: str) -> None:
    with pytest.raises(ModelError) as caught:
        parse_accelerations(text)
    assert said in str(caught.value)
    assert str(caught.value).startswith("line ")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("none.csv", "none.csv: there is no such file"),
        ("", "'': there is no such file"),
        (".", ".: this is a directory; give a file"),
        ("bad.csv", "bad.csv, line 2, column x: got '?'; give a finite number"),
        ("latin.csv", "latin.csv: line 2 is not text in UTF-8"),
    ],
)
def test_files_of_accelerations(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("bad.csv").write_text("time [s],x [gn]\n0,?\n", encoding="utf-8")
    Path("latin.csv").write_bytes(f"{TASKS}\nMähen,1,1\n".encode("latin-1"))
    with pytest.raises(ModelError) as caught:
        read_accelerations(name)
    assert str(caught.value).startswith(said)
