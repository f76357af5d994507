"""Words and tables in lines of a width: nothing is cut, nothing lost, whatever the script."""

from __future__ import annotations

import pytest
from rich.cells import cell_len

from equipoise.present.cells import grid
from equipoise.present.terminal import Looks, size, table_lines, wrapped
from equipoise.results.blocks import Cell, Column, Many, Table, Value

PLAIN = Looks(coloured=False)


def lines(table: Table, width: int) -> list[list[str]]:
    return table_lines(grid(table), width, PLAIN)


def numbers(count: int, *rows: str) -> Table:
    """A table of so many columns of numbers."""
    columns = (Column(""), *(Column(f"order {k}", "force") for k in range(1, count + 1)))
    cells = [(row, *(Value(k + 0.25) for k in range(count))) for row in rows]
    return Table.of("title", columns, cells)


# -- words -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["plain", "リンク機構", "연결봉 길이", "x̄ of A", "（仮）a", ""])
def test_signs_take_the_places_that_a_terminal_gives_them(text: str) -> None:
    assert size(text) == cell_len(text)


def test_units_stay_with_their_numbers_and_names_whole() -> None:
    reported = wrapped("driven at 193.0 rpm, 1.200 N m, by /a/very/long/path", 12)
    assert reported == ["driven at", "193.0 rpm,", "1.200 N m,", "by", "/a/very/long/path"]
    assert wrapped("links.crank.mass", 8, inner=True) == ["links.", "crank.", "mass"]
    assert wrapped("0.25 balance-shaft-1", 9, inner=True) == ["0.25", "balance-", "shaft-1"]
    assert wrapped("one two three", 7, indent=2) == ["one two", "three"]


def test_japanese_breaks_anywhere_but_before_what_closes() -> None:
    text = "起振力（x方向）は、クランクを釣り合わせると小さくなる。"
    for width in range(6, 40):
        reported = wrapped(text, width)
        assert "".join(reported) == text
        assert max(map(size, reported)) <= width
        assert not any(line[0] in "、。）ー" or line[-1] == "（" for line in reported)
    assert wrapped("기진력을 작게 한다", 9) == ["기진력을", "작게 한다"]


# -- tables ----------------------------------------------------------------------------------------


def test_a_table_of_one_row_is_turned_where_it_is_too_wide() -> None:
    table = numbers(6, "gauge, mm")
    (wide,), (narrow,) = lines(table, 100), lines(table, 40)
    assert [len(wide), len(narrow)] == [3, 7]
    assert narrow[:2] == ["            gauge, mm", "order 1, N     0.2500"]


def test_parts_are_about_as_wide_and_each_reports_its_rows() -> None:
    parts = lines(numbers(6, *"ABCDEFG"), 40)
    assert [part[0].split()[1::2] for part in parts] == [["1", "2", "3"], ["4", "5", "6"]]
    assert all([line[0] for line in part[2:]] == [*"ABCDEFG"] for part in parts)


def test_headings_give_way_before_words_and_words_before_the_table() -> None:
    columns = (Column(""), Column("peak to peak", "force"), Column("mean", "force"))
    rows = [("moment of the shaking force", Value(1.0), Value(2.0))]
    table = Table.of("", columns, rows)
    content = {width: lines(table, width)[0] for width in (48, 47, 40)}
    assert [content[48][0].split(), content[48][-1]] == [
        ["peak", "to", "peak", "mean"],
        "moment of the shaking force         1.000  2.000",
    ]
    assert content[47][:2] == [f"{'peak to':>40}", f"{'peak   mean':>47}"]
    assert content[40][-2:] == ["moment of the shaking       1.000  2.000", "  force"]


def test_numbers_and_where_they_hold_stand_below_each_other() -> None:
    cells: list[Cell] = [Value(12.5, at=0.1), Value(4.0), Value(100.0, at=5.0)]
    table = Table.of("", (Column(""), Column("largest", "force")), zip("ABC", cells, strict=True))
    assert lines(table, 80)[0][2:] == ["A  12.50 at   5.7", "B  4.000", "C  100.0 at 286.5"]


def test_a_value_stays_with_where_it_holds_in_a_list() -> None:
    peaks = Many(tuple(Value(k, at=1.0) for k in (12.5, 3.5, 1.5)))
    table = Table.of("", (Column(""), Column("peaks", "force")), [("gauge", peaks)])
    reported = lines(table, 24)[0]
    assert reported[-3:] == [
        "gauge  12.50 (57.3),",
        "         3.500 (57.3),",
        "         1.500 (57.3)",
    ]


def test_a_column_without_any_text_is_left_out() -> None:
    table = Table.of("", ("", "value", "remark"), [("A", Value(1.0), ""), ("B", Value(2.0), None)])
    assert [head.label for head in grid(table).heads] == ["", "value"]
