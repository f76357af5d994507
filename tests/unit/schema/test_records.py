"""Recorded decays as CSV files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.schema.records import parse_record, read_record

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
    slow = parse_record(plain.replace("0.1,1", "0.1\N{NO-BREAK SPACE},1"))
    np.testing.assert_allclose(whole.time, slow.time, rtol=3e-16)
    np.testing.assert_allclose(whole.displacement, slow.displacement, rtol=3e-16)


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
