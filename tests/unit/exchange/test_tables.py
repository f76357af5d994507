"""Excel read back by openpyxl, MATLAB by SciPy: every value as it was, and no formula."""

from __future__ import annotations

import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pytest
from scipy.io import loadmat

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.exchange import xlsx
from equipoise.exchange.formats import Job
from support.refusals import refused

MACHINE = eq.load("slider-crank-engine")
SIGNS = ("=1+1", "+1", "-1", "@sum(1)")
"""What Excel would take for formulas."""


@pytest.fixture(scope="module")
def analysis() -> Any:
    return eq.analyze(MACHINE)


def opened(what: object, path: Path) -> Any:
    assert eq.export(what, path) == ()  # type: ignore[arg-type]
    return openpyxl.load_workbook(path)


@pytest.fixture(scope="module")
def book(tmp_path_factory: pytest.TempPathFactory) -> Any:
    return opened(MACHINE, tmp_path_factory.mktemp("tables") / "x.xlsx")


def test_signals_and_summary(analysis: Any, book: Any) -> None:
    """Excel's numbers have 16 digits."""
    assert book.sheetnames == ["Summary", "Links", "Points", "Charts", "Signals"]
    names, units, *rows = book["Signals"].values
    values = dict(zip(names, np.array(rows, float).T, strict=True))
    assert {*names} == {"crank_angle", *(item.name for item in analysis.outputs.arrays)}
    np.testing.assert_allclose(values["crank_angle"], analysis.crank_angle, rtol=1e-14)
    for array in analysis.outputs.arrays:
        assert units[names.index(array.name)] == array.unit
        np.testing.assert_allclose(values[array.name], array.values, rtol=1e-14, atol=1e-300)
    head, *figures = book["Summary"].values
    assert head[:5] == ("output", "what it is", "unit", "mean", "rms")
    content = {row[0]: dict(zip(head, row, strict=True)) for row in figures}
    for name, array in analysis.summary.items():
        assert content[name]["peak_at [rad]"] == pytest.approx(array.peak_at, rel=1e-14)
    assert [*book["Links"].values][1][:2] == ("crank", 0.9)
    assert ("rod", "C", 0.09, 0.0) in [*book["Points"].values]


# The same cells of a small cycle: `test_signals_and_summary`.
@pytest.mark.exhaustive
def test_large_cycles_are_written_row_by_row(
    analysis: Any, book: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the same cells, and in little of the memory."""
    monkeypatch.setattr(xlsx, "analyze", lambda machine: analysis)
    tracemalloc.start()
    xlsx.export_bytes(Job(MACHINE))
    _, at_once = tracemalloc.get_traced_memory()
    monkeypatch.setattr(xlsx, "LARGE", 10)
    tracemalloc.reset_peak()
    xlsx.export_bytes(Job(MACHINE))
    _, by_row = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    cells = len(analysis.crank_angle) * len(analysis.outputs.arrays)
    assert by_row < at_once - 200 * cells  # each takes some hundred bytes where all are kept
    rows = opened(MACHINE, tmp_path / "rows.xlsx")
    for name in book.sheetnames:
        assert [*rows[name].values] == [*book[name].values]


def test_more_crank_angles_than_a_sheet_takes(monkeypatch: pytest.MonkeyPatch) -> None:
    """The library would leave the rest out, and say nothing."""
    monkeypatch.setattr(xlsx, "MOST_ROWS", 500)
    with refused(UsageError, turns="2", rows="720", most_rows="498"):
        xlsx.export_bytes(Job(eq.load("four-stroke-engine")))


def test_charts_show_every_signal(analysis: Any, book: Any) -> None:
    charts = book["Charts"]._charts
    drawn = [series.yVal.numRef.f for chart in charts for series in chart.series]
    columns = len(analysis.outputs.arrays)
    assert len(set(drawn)) == len(drawn) == columns
    last = len(analysis.crank_angle) + 2
    letter = openpyxl.utils.get_column_letter(columns + 1)
    assert f"Signals!${letter}$3:${letter}${last}" in drawn


def test_what_balancing_changes(tmp_path: Path) -> None:
    balanced = eq.balance(eq.load("balance-crank"))
    book = opened(balanced, tmp_path / "x.xlsx")
    (_,), (first,), *_ = book["Changes"].values
    assert first.startswith("crank: add a counterweight of")


def test_no_text_becomes_a_formula(tmp_path: Path) -> None:
    points = {"A": (0.0, 0.0), **dict.fromkeys(SIGNS, (0.1, 0.0))}
    link = eq.Link(points=points, mass=0.0, center_of_mass=(0.0, 0.0), inertia=0.0)
    machine = eq.Machine(SIGNS[0], eq.Drive(SIGNS[0], 1.0), {"A": (0.0, 0.0)}, {SIGNS[0]: link})
    book = opened(machine, tmp_path / "x.xlsx")
    texts = [cell for sheet in book for row in sheet.iter_rows() for cell in row if cell.value]
    assert {cell.data_type for cell in texts} <= {"s", "n"}
    assert {*SIGNS} <= {cell.value for cell in texts}


def test_a_machine_without_masses_has_its_motion(tmp_path: Path) -> None:
    links = {k: eq.Link(points=v.points) for k, v in MACHINE.links.items()}
    machine = eq.Machine(
        "x", MACHINE.drive, MACHINE.frame, links, MACHINE.assembly, MACHINE.sliders
    )
    eq.export(machine, tmp_path / "x.mat")
    result = loadmat(tmp_path / "x.mat", simplify_cells=True)["equipoise"]
    assert np.isnan(result["links"]["rod"]["mass"])
    assert "points_C_x" in result["signals"]
    assert "shaking_force_x" not in result["signals"]


def test_matlab(analysis: Any, tmp_path: Path) -> None:
    assert eq.export(MACHINE, tmp_path / "x.mat") == ()
    result = loadmat(tmp_path / "x.mat", simplify_cells=True)["equipoise"]
    assert result["title"] == str(MACHINE.title)
    assert result["speed"] == MACHINE.drive.speed
    signals = {item["name"]: item for item in result["signals"].values()}
    for array in analysis.outputs.arrays:
        assert signals[array.name]["unit"] == array.unit
        np.testing.assert_array_equal(signals[array.name]["values"], array.values)
    assert result["signals"]["joints_piston_on_frame_normal"]["unit"] == "N"
    assert result["summary"]["drive_torque"]["rms"] == analysis.summary["drive_torque"].rms
    np.testing.assert_array_equal(result["links"]["rod"]["points"]["C"], (0.09, 0.0))


def test_names_for_matlab_are_each_once(tmp_path: Path) -> None:
    points = {"A": (0.0, 0.0), "A b": (1.0, 0.0), "A-b": (2.0, 0.0), "1": (3.0, 0.0)}
    machine = eq.Machine("x", eq.Drive("k", 1.0), {"A": (0.0, 0.0)}, {"k": eq.Link(points=points)})
    eq.export(machine, tmp_path / "x.mat")
    result = loadmat(tmp_path / "x.mat", simplify_cells=True)["equipoise"]["links"]["k"]["points"]
    assert {name: at[0] for name, at in result.items()} == {"A": 0, "A_b": 1, "A_b2": 2, "x1": 3}
