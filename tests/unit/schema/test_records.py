"""Recorded decays, accelerations and tasks as CSV files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

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
from support.refusals import refused

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


REFUSED = {
    "column": (
        text("time [s],height [mm]"),
        {
            "given": "'height [mm]'",
            "line": 1,
        },
    ),
    "load": (text("crank_angle [deg],torque [N m]"), {"given": "'crank_angle [deg]'", "line": 1}),
    "no unit": (
        text("time [s],displacement"),
        {"name": "displacement", "column": "displacement", "line": 1},
    ),
    "other unit": (
        text("time [s],displacement [kg]"),
        {"given": "'0 kg'", "column": "displacement", "line": 1},
    ),
    "one column": (
        "time [s]\n1\n",
        {"line": 1},
    ),
    "twice": (text("time [s],time [s]"), {"column": "time", "line": 1}),
    "both": (
        "time [s],displacement [mm],angle [deg]\n1,1,1\n",
        {"line": 1},
    ),
    "text": (text(r4="0.4,high"), {"given": "'high'", "column": "displacement", "line": 6}),
    "empty cell": (text(r4="0.4,"), {"given": "''", "column": "displacement", "line": 6}),
    "not finite": (text(r4="0.4,nan"), {"given": "'nan'", "column": "displacement", "line": 6}),
    "infinite": (text(r4="inf,1"), {"given": "'inf'", "column": "time", "line": 6}),
    "underscore": (text(r4="0.4,1_0"), {"given": "'1_0'", "column": "displacement", "line": 6}),
    "digits": (text(r4="0.4,１"), {"given": "'１'", "column": "displacement", "line": 6}),
    "comma": (text(r4="0,4,1"), {"columns": 2, "line": 6, "count": 3}),
    "far": (text(r4="0.4,1e40"), {"text": "'1e40 mm'", "column": "displacement", "line": 6}),
    "falling": (text(r4="0.2,1"), {"column": "time", "what": "times", "line": 6}),
    "empty": (
        "",
        {"line": 1},
    ),
    "no rows": ("time [s],displacement [mm]\n", {"line": 1}),
    "short": ("time [s],displacement [mm]\n0,1\n1,2\n", {"least_samples": 12, "count": 2}),
}


@pytest.mark.parametrize(("given", "expected"), REFUSED.values(), ids=REFUSED)
def test_refused_with_its_place(given: str, expected: dict[str, Any], tmp_path: Path) -> None:
    path = tmp_path / "decay.csv"
    path.write_text(given, encoding="utf-8")
    with refused(eq.EquipoiseError, **expected) as caught:
        read_record(path)
    assert str(caught.value).startswith(str(path))


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
    result = parse_accelerations(text)
    assert isinstance(result, Accelerations)
    return result


def test_axes_in_si_units() -> None:
    result = measured(signal("time [ms],x [gn],y [ft/s^2]"))
    assert (result.kind, result.axes) == ("time", ("x", "y"))
    np.testing.assert_allclose(result.at, 1e-4 * np.arange(ROWS), rtol=1e-15)
    np.testing.assert_allclose(result.values[0], 9.80665 * (np.arange(ROWS) % 4), rtol=1e-15)
    np.testing.assert_allclose(result.values[1], -0.3048 * (np.arange(ROWS) % 3), rtol=1e-15)


def test_axes_and_columns_in_any_order() -> None:
    result = measured("z [m/s^2],frequency [kHz],x [m/s^2]\n1,0.1,2\n3,0.2,4\n")
    assert (result.kind, result.axes) == ("frequency", ("x", "z"))
    np.testing.assert_array_equal(result.values, [[2, 4], [1, 3]])
    np.testing.assert_array_equal(result.at, [100, 200])


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


UNREAD = {
    "empty": ("", {"line": 1}),
    "other": ("crank_angle [deg]\n0\n", {"name": "'crank_angle [deg]'", "line": 1}),
    "misspelt": (signal("time [s],xx [m/s^2]"), {"given": "'xx [m/s^2]'", "line": 1}),
    "acceleration": (signal("time [s],acceleration [m/s^2]"), {"by": "header_of"}),
    "no axis": ("time [s]\n1\n", {"line": 1}),
    "gap": (signal(r9="0.97,1,1"), {"column": "time", "time": 0.97, "line": 11}),
    "negative": (f"{SPECTRUM}\n8,1,1,1\n\n10,1,-2,1\n", {"column": "y", "line": 4}),
    "below zero": (f"{SPECTRUM}\n-8,1,1,1\n10,1,2,1\n", {"column": "frequency", "line": 2}),
    "down": (f"{SPECTRUM}\n8,1,1,1\n6,1,1,1\n",
             {"column": "frequency", "what": "frequencies", "line": 3}),
    "task: no task": ("duration [h]\n1\n", {"line": 1, "count": 0}),
    "task: two": ("task,task,duration [h]\na,b,1\n", {"count": 2}),
    "task: missing": ("task,duration [h]\na,1\n", {"line": 1}),
    "task: unit": ("task,acceleration,duration [h]\na,1,1\n",
                   {"name": "acceleration", "column": "acceleration"}),
    "task: wrong unit": (f"{TASKS[:-3]}[m]\na,1,1\n", {"given": "'0 m'", "column": "duration"}),
    "task: cells": (f"{TASKS}\na,1\n", {"columns": 3, "line": 2, "count": 2}),
    "task: nan": (f"{TASKS}\na,1,1\nb,nan,1\n",
                  {"given": "'nan'", "column": "acceleration", "line": 3}),
    "task: no time": (f"{TASKS}\na,1,\n", {"given": "''", "column": "duration", "line": 2}),
    "task: negative": (f"{TASKS}\na,-1,1\n", {"value": -1.0, "line": 2}),
    "task: no hours": (f"{TASKS}\na,1,0\n", {"duration": 0.0, "line": 2}),
    "task: long": (f"{TASKS}\na,1,25\n", {"duration": 25.0, "line": 2}),
    "task: none": (TASKS, {"line": 1}),
    "quotes": ('task,"acceleration\n', {"line": 1}),
}  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), UNREAD.values(), ids=UNREAD)
def test_accelerations_are_refused(text: str, expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected) as caught:
        parse_accelerations(text)
    assert str(caught.value).startswith("line ")


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("none.csv", {"by": "open_file"}),
        ("", {"by": "open_file"}),
        (".", {"by": "_bytes"}),
        ("bad.csv", {"given": "'?'", "column": "x", "line": 2}),
        ("latin.csv", {"line": 2}),
    ],
)
def test_files_of_accelerations(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, expected: dict[str, Any]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("bad.csv").write_text("time [s],x [gn]\n0,?\n", encoding="utf-8")
    Path("latin.csv").write_bytes(f"{TASKS}\nMähen,1,1\n".encode("latin-1"))
    with refused(ModelError, **expected):
        read_accelerations(name)
