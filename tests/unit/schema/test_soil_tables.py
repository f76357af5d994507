"""Tables of the soil's resistance against depth: CSV files beside the model file."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from equipoise.errors import ModelError
from equipoise.mechanism.field import Soil, SoilTable
from equipoise.mechanism.model import Load, LoadTable
from equipoise.schema import dumps, load, loads, save
from equipoise.schema.tables import format_soil, read_soil
from unit.schema.samples import FOUR_BAR

SHORT = '\n[planting]\ntip = "C"\nforward_speed = "60 cm/s"\ndepth = "4 cm"\n'
TABLE = SoilTable((0.0, 0.01, 1 / 30), (1.0, 2.5, 1 / 3), "soil.csv")
CSV = "depth [mm],resistance [N]\n0,1\n10,2.5\n40,1.5\n"


def test_a_table_is_read_beside_the_model(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text(FOUR_BAR + SHORT + 'soil.table = "soil.csv"\n')
    (tmp_path / "soil.csv").write_text(CSV)
    planting = load(path).planting
    assert planting is not None
    assert planting.soil == Soil(table=SoilTable((0.0, 0.01, 0.04), (1.0, 2.5, 1.5)))
    assert planting.soil.table is not None
    assert planting.soil.table.file == "soil.csv"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (None, "soil.csv: there is no such file"),
        ("", "soil.csv, line 1: got no column; the header is depth [mm],resistance [N]"),
        ("depth [mm]\n0\n", "line 1: got depth; the header is depth [mm],resistance [N]"),
        ("depth [mm],force_x [N]\n0,1\n", "line 1: got the column 'force_x [N]'; the header is"),
        ("depth,resistance [N]\n0,1\n", "line 1, column depth: the unit is missing; depth [m]"),
        ("depth [N],resistance [N]\n0,1\n", "line 1, column depth: got '0 N'; N is the unit of"),
        ("depth [mm],resistance [N]\n", "there are no rows"),
        ("depth [mm],resistance [N]\n0,1\n0,2\n", "line 3, column depth: the depths must rise"),
        ("depth [mm],resistance [N]\n0,1,2\n", "line 2: got 3 values; the header has 2 columns"),
        ("depth [mm],resistance [N]\n0,x\n", "line 2, column resistance: got 'x'; give a finite"),
        ("depth [mm],resistance [N]\n-1,1\n0,2\n", "the depths must rise from row to row, from 0"),
        ("depth [mm],resistance [N]\n0,1\n5,-2\n", "got -2 N; soil resists, give 0 or more"),
    ],
)
def test_bad_tables(text: str | None, said: str, tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text(FOUR_BAR + SHORT + 'soil.table = "soil.csv"\n')
    if text is not None:
        (tmp_path / "soil.csv").write_text(text)
    with pytest.raises(ModelError) as caught:
        load(path)
    assert str(caught.value).startswith(f"{path}: planting.soil.table: ")
    assert said in str(caught.value)


def test_tables_are_saved_beside_the_model(tmp_path: Path) -> None:
    machine = loads(FOUR_BAR + SHORT)
    crank = Load("crank", table=LoadTable((0.0, pi), ((1.0, 2.0),)))
    machine = replace(machine, loads=(crank,)).with_planting(soil=Soil(3.0, table=TABLE))
    save(machine, tmp_path / "a.toml")
    names = sorted(file.name for file in tmp_path.iterdir())
    assert names == ["a.load-1.csv", "a.soil.csv", "a.toml"]
    again = load(tmp_path / "a.toml")
    assert again == machine
    assert again.planting is not None
    assert again.planting.soil is not None
    assert again.planting.soil.table == replace(TABLE, file="a.soil.csv")


def test_a_table_without_a_file_is_not_dumped() -> None:
    machine = loads(FOUR_BAR + SHORT).with_planting(soil=Soil(table=replace(TABLE, file="")))
    with pytest.raises(ModelError, match=r"^planting.soil.table: the table has no file; save"):
        dumps(machine)
    named = machine.with_planting(soil=Soil(table=TABLE))
    assert 'soil.table = "soil.csv"' in dumps(named)


@given(
    st.lists(st.floats(1e-20, 1e6), min_size=1, max_size=5, unique=True).map(sorted),
    st.lists(st.just(0.0) | st.floats(1e-20, 1e20), min_size=5, max_size=5),
)
def test_random_tables_survive(
    tmp_path_factory: pytest.TempPathFactory, depth: list[float], resistance: list[float]
) -> None:
    table = SoilTable(tuple(depth), tuple(resistance[: len(depth)]))
    folder = tmp_path_factory.getbasetemp()
    (folder / "random-soil.csv").write_text(format_soil(table))
    assert read_soil("random-soil.csv", folder) == table
