"""One file of a store's designs: Parquet and CSV, a block at a time."""

from __future__ import annotations

import csv
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pyarrow.parquet
import pytest

from equipoise.codegen.figures import REASONS
from equipoise.errors import UsageError
from equipoise.studies.run import create_store
from equipoise.studies.selection import write_designs
from equipoise.studies.study import Output, samples
from support.refusals import refused
from support.studies import LENGTH, MASS, SPEED, Formulas, filled, short_study

STUDY = short_study(250)
COLUMNS = ["design", LENGTH, MASS, SPEED, "area", "momentum", "energy", "reason"]


def check(table: pandas.DataFrame, rows: np.ndarray[Any, Any]) -> None:
    """To the last bit, the designs whose numbers are `rows`."""
    values = samples(STUDY, 0, 250)[rows]
    outcome = Formulas()(values)
    np.testing.assert_array_equal(table["design"], rows)
    np.testing.assert_array_equal(table[[LENGTH, MASS, SPEED]], values)
    np.testing.assert_array_equal(table[["area", "momentum", "energy"]], outcome.figures)
    assert list(table["reason"]) == [REASONS[k] for k in outcome.reason]


def csv_of(path: Path) -> tuple[list[str], pandas.DataFrame]:
    """Header and rows, each number as Python reads it."""
    with open(path, newline="") as file:
        header, *rows = csv.reader(file)
    table = pandas.DataFrame(rows, columns=COLUMNS)
    numbers = [[float(text or "nan") for text in row[1:-1]] for row in rows]
    table[COLUMNS[1:-1]] = np.array(numbers)
    return header, table.astype({"design": int})


def test_parquet_has_every_design_and_the_units(tmp_path: Path) -> None:
    target = tmp_path / "designs.parquet"
    assert write_designs(filled(tmp_path / "s", STUDY), target) == 250
    table = pandas.read_parquet(target)
    assert list(table) == COLUMNS
    check(table, np.arange(250))
    schema = pyarrow.parquet.read_schema(target)
    assert schema.field(SPEED).metadata == {b"unit": b"rad/s"}
    assert b"Short formulas" in schema.metadata[b"study"]
    assert table["energy"].isna().any()  # empty, not a number that is none
    assert pyarrow.parquet.read_table(target)["energy"].null_count == table["energy"].isna().sum()


def test_csv_has_every_design_with_units_in_its_header(tmp_path: Path) -> None:
    target = tmp_path / "designs.CSV"
    assert write_designs(filled(tmp_path / "s", STUDY), target) == 250
    header, table = csv_of(target)
    units = ["", " [m]", " [kg]", " [rad/s]", "", " [N]", " [J]", ""]
    assert header == [name + unit for name, unit in zip(COLUMNS, units, strict=True)]
    check(table, np.arange(250))


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_what_is_not_stored_yet_is_left_out(tmp_path: Path, ending: str) -> None:
    target = tmp_path / f"designs.{ending}"
    target.write_text("of before")
    assert write_designs(filled(tmp_path / "s", STUDY, (0, 2)), target) == 150
    read = pandas.read_csv if ending == "csv" else pandas.read_parquet
    rows = np.concatenate([np.arange(100), np.arange(200, 250)])
    np.testing.assert_array_equal(read(target)["design"], rows)
    assert [path.name for path in sorted(tmp_path.iterdir())] == [target.name, "s"]


def test_only_designs_that_keep_every_limit(tmp_path: Path) -> None:
    outcome = Formulas()(samples(STUDY, 0, 250))
    rows = np.flatnonzero((outcome.reason == 0) & (outcome.figures[:, 0] >= 0.0045))
    assert write_designs(filled(tmp_path / "s", STUDY), tmp_path / "d.parquet", kept=True) == len(
        rows
    )
    check(pandas.read_parquet(tmp_path / "d.parquet"), rows)


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_many_designs_are_written_a_block_at_a_time(
    tmp_path: Path, ending: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("equipoise.studies.store.BLOCK", 100)
    target = tmp_path / f"designs.{ending}"
    assert write_designs(filled(tmp_path / "s", STUDY), target) == 250
    check(pandas.read_parquet(target) if ending == "parquet" else csv_of(target)[1], np.arange(250))
    if ending == "parquet":
        assert pyarrow.parquet.ParquetFile(target).num_row_groups == 3


def test_names_with_quotes_and_commas_stand_in_the_header(tmp_path: Path) -> None:
    name = 'joint_forces."A, b".rms'
    study = short_study(5, outputs=(Output(name, dimension="force"),))
    write_designs(create_store(tmp_path / "s", study, 5, "numba"), tmp_path / "d.csv")
    assert list(pandas.read_csv(tmp_path / "d.csv"))[4] == f"{name} [N]"


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("designs.xlsx", {"by": "write_designs"}),
        ("folder.csv", {"brief": "is a directory"}),
        ("nowhere/designs.csv", {"brief": "no such file or directory"}),
    ],
)
def test_what_cannot_be_written_is_reported_and_leaves_nothing(
    tmp_path: Path, name: str, expected: dict[str, Any]
) -> None:
    (tmp_path / "folder.csv").mkdir()
    store = filled(tmp_path / "s", STUDY)
    with refused(UsageError, **expected):
        write_designs(store, tmp_path / name)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder.csv", "s"]


def test_a_disk_that_is_full_leaves_the_file_of_before(tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    target = tmp_path / "designs.csv"
    target.write_text("of before")
    store = filled(tmp_path / "s", STUDY)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    try:
        with refused(UsageError, brief="file too large"):
            write_designs(store, target)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert target.read_text() == "of before"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["designs.csv", "s"]


def test_without_pyarrow_the_sentence_reports_how_to_install_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = filled(tmp_path / "s", STUDY)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with refused(UsageError, library="pyarrow", command='pip install "equipoise[studies]"'):
        write_designs(store, tmp_path / "d.csv")
    assert not (tmp_path / "d.csv").exists()
