"""Blocks of something beside those of it changed."""

from __future__ import annotations

import pytest

from equipoise.present.pages import page
from equipoise.results.blocks import Column, Table, Text, Value, interleave_changes
from support.findings import report_of


def table(label: str, *rows: tuple[str, float]) -> Table:
    columns = (Column(""), Column(label, dimension="force"))
    return Table("Forces", columns, tuple((name, Value(value)) for name, value in rows))


def test_each_row_is_followed_by_that_after_a_change() -> None:
    before = [Text("words"), table("RMS", ("x", 1.0), ("y", 2.0))]
    words, both = interleave_changes(before, [table("RMS", ("x", 1.0), ("y", 3.0), ("z", 4.0))])
    assert words is before[0]
    assert isinstance(both, Table)
    assert [row[0] for row in both.rows] == ["x", "y", "y, after", "z, after"]


def test_a_table_of_other_columns_follows_whole() -> None:
    before, after = table("RMS", ("x", 1.0)), table("peak", ("x", 2.0))
    first, second = interleave_changes([before], [after])
    assert first is before
    assert isinstance(second, Table)
    assert (second.title, second.rows) == ("Forces, after", after.rows)


@pytest.mark.exhaustive(but=["exudyn-slider-crank"])
@pytest.mark.parametrize("name", ["exudyn-slider-crank", "riding-transplanter", "sieve"])
def test_reports_of_machines_on_mounts_can_be_laid_out(name: str) -> None:
    """After what helps, more orders may be told than before."""
    assert ", after" in page(report_of(name))
