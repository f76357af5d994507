"""Load tables in CSV."""

from __future__ import annotations

from math import pi
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from equipoise.errors import ModelError
from equipoise.mechanism.model import LoadTable
from equipoise.schema import load
from equipoise.schema.tables import format_load, parse_load, read_load
from unit.schema.samples import FOUR_BAR

FORCES = "crank_angle [deg],force_x [N],force_y [N]\n0,1,2\n90,3,-4.5\n"


def test_forces_and_torques() -> None:
    assert parse_load(FORCES) == LoadTable((0.0, pi / 2), ((1.0, 3.0), (2.0, -4.5)))
    torque = parse_load("torque [N mm], crank_angle [turn]\r\n\r\n1000,0\r\n2e3,.5\r\n")
    assert torque == LoadTable((0.0, pi), ((1.0, 2.0),))


def test_the_order_of_columns_does_not_matter() -> None:
    swapped = "force_y [N],crank_angle [deg],force_x [N]\n2,0,1\n-4.5,90,3\n"
    assert parse_load(swapped) == parse_load(FORCES)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "line 1: got no column; the header is"),
        ("crank_angle [deg]\n0\n", "line 1: got crank_angle; the header is"),
        ("crank_angle [deg],force_x [N]\n0,1\n", "line 1: got crank_angle, force_x; the header"),
        ("crank_angle [deg];torque [N m]\n0;1\n", "line 1: got the column 'crank_angle [deg];t"),
        ("crank_angle,torque [N m]\n0,1\n", "column crank_angle: the unit is missing; crank_angle"),
        ("crank_angle [mm],torque [N m]\n0,1\n", "line 1, column crank_angle: got '0 mm'; mm is"),
        ("crank_angle [deg],torque [N m],torque [N m]\n0,1,1\n", "column torque: given twice"),
        ("crank_angle [deg],torque [N m]\n", "there are no rows"),
        ("crank_angle [deg],torque [N m]\n0,1\n5\n", "line 3: got 1 values; the header has 2"),
        ("crank_angle [deg],torque [N m]\n0,abc\n", "line 2, column torque: got 'abc'; give a"),
        ("crank_angle [deg],torque [N m]\n0,nan\n", "line 2, column torque: got 'nan'; give a"),
        ("crank_angle [deg],torque [N m]\n0,\n", "line 2, column torque: got ''; give a finite"),
        ("crank_angle [deg],torque [N m]\n0,1e300\n", "line 2, column torque: got '1e300 N m', "),
        ("crank_angle [deg],torque [N m]\n0,1\n\n0,2\n", "line 4, column crank_angle: the angles"),
        ('crank_angle [deg],torque [N m]\n0,"1\n', "no table of comma-separated values"),
        (f"crank_angle [deg],torque [N m]\n0,{'1' * 200_000}\n", "no table of comma-separated"),
    ],
)
def test_bad_tables(text: str, said: str) -> None:
    with pytest.raises(ModelError) as caught:
        parse_load(text)
    assert said in str(caught.value)


def complaint(text: str) -> str:
    try:
        parse_load(text)
    except ModelError as error:
        return str(error)
    return "read"


@given(st.text())
def test_any_text_is_refused_with_a_sentence(text: str) -> None:
    for whole in (text, FORCES + text, text + FORCES):
        assert complaint(whole).startswith(("line ", "read"))


@given(
    st.lists(st.floats(0, 6), min_size=1, max_size=5, unique=True),
    st.floats(1e-20, 1e20),
)
def test_tables_survive(angles: list[float], value: float) -> None:
    angles = sorted(angle for angle in angles if angle > 1e-20) or [0.0]
    table = LoadTable(tuple(angles), ((value,) * len(angles), (-value,) * len(angles)))
    assert parse_load(format_load(table)) == table


def test_whole_degrees_are_written_as_degrees() -> None:
    assert format_load(parse_load(FORCES)).startswith("crank_angle [deg],force_x [N],force_y [N]")
    assert "\n90,3.0,-4.5\n" in format_load(parse_load(FORCES))


def test_errors_name_model_and_table(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text(FOUR_BAR + '[[loads]]\nlink = "coupler"\npoint = "C"\ntable = "f.csv"\n')
    table = tmp_path / "f.csv"
    with pytest.raises(ModelError, match=r"loads\[1\].table: f.csv: there is no such file"):
        load(path)
    table.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ModelError, match=r"f.csv: line 1 is not text in UTF-8"):
        load(path)
    table.write_text(FORCES.replace("-4.5", "x"))
    with pytest.raises(ModelError, match=r"f.csv, line 3, column force_y: got 'x'") as caught:
        load(path)
    assert str(caught.value).startswith(f"{path}: loads[1].table: ")
    table.write_text("\ufeff" + FORCES, encoding="utf-8")
    assert load(path).loads[0].table == parse_load(FORCES, "f.csv")
    assert read_load("f.csv", tmp_path).file == "f.csv"
