"""Every result shows itself: on a terminal of any width, on a page, in print, in a notebook."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from rich.cells import cell_len

import equipoise as eq
from equipoise.balancing.linear_conditions import conditions
from equipoise.balancing.pareto import trade_off
from equipoise.balancing.sensitivity import sensitivities
from equipoise.exposure.daily import Exposure, Task, daily_exposure
from equipoise.handheld.hand_exposure import expose_tool
from equipoise.handheld.modes import vary_tool, vibrate_tool
from equipoise.handheld.response import respond_tool
from equipoise.handheld.sweep import sweep_tool
from equipoise.i18n import speaking
from equipoise.mechanism.parts.balance import Objective
from equipoise.planting.summary import plant
from equipoise.present import html_of, terminal
from equipoise.present.cells import grid, printed, printed_grid
from equipoise.present.pages import ReportDocument, page, pdf
from equipoise.present.summary import tool_tiles
from equipoise.present.terminal import plain
from equipoise.quantities import showing
from equipoise.results.analysis import Analysis
from equipoise.results.blocks import Column, RelativeChange, ReportSection, Span, Table, Text, Value
from equipoise.schema.models import load_tool
from support.chosen import few
from support.findings import findings_of
from support.printing import printed as shown
from support.printing import words

SPEEDS = np.linspace(600.0, 800.0, 12)
RESULTS: dict[str, Callable[[], Any]] = {
    "analysis": lambda: eq.analyze(eq.load("yamashita-1")),
    "slider": lambda: eq.analyze(eq.load("slider-crank-engine")),
    "response": lambda: eq.respond(eq.load("riding-transplanter")),
    "exact response": lambda: eq.respond(eq.load("yamashita-rig"), model="exact"),
    "sweep": lambda: eq.vibration.sweep_speed(eq.load("yamashita-rig"), 5.0, 40.0, speeds=12),
    "free vibration": lambda: eq.modes(eq.load("riding-transplanter")),
    "run": lambda: eq.run(eq.load("yamashita-rig"), turns=3),
    "transient": lambda: eq.simulate(eq.load("yamashita-rig"), 0.3),
    "balanced": lambda: eq.balance(eq.load("balance-crank")),
    "phases": lambda: eq.balance(eq.load("four-row-transplanter")),
    "front": lambda: trade_off(
        eq.load("balance-crank"),
        Objective("shaking_force"),
        Objective("drive_torque"),
        eq.load("balance-crank").balance,
        4,
    ),
    "conditions": lambda: conditions(eq.load("yamashita-1")),
    "sensitivities": lambda: sensitivities(eq.load("yamashita-1")),
    "planting": lambda: plant(eq.load("transplanter")),
    "tool modes": lambda: vibrate_tool(load_tool("brush-cutter"), 5),
    "tool sweep": lambda: sweep_tool(load_tool("brush-cutter"), SPEEDS),
    "tool response": lambda: respond_tool(load_tool("pole-saw"), SPEEDS),
    "tool exposure": lambda: expose_tool(load_tool("brush-cutter"), SPEEDS),
    "variation": lambda: vary_tool(
        load_tool("nagamine-irie"), "harness", "position", np.linspace(0.0, 0.2, 4), 4
    ),
    "exposure": lambda: Exposure((Task("mowing", 4.6, 7200.0), Task("sawing", 9.0, 7200.0))),
}


@cache
def result(name: str) -> Any:
    return RESULTS[name]()


def tables(blocks: Any) -> list[Table]:
    """All tables, those of sections too."""
    parts = (
        tables(block.blocks) if isinstance(block, ReportSection) else [block] for block in blocks
    )
    return [item for part in parts for item in part if isinstance(item, Table)]


@pytest.mark.exhaustive(
    but=[
        "tool modes-60",
        "transient-60",
        "run-60",
        "tool sweep-60",
        "free vibration-60",
        "response-60",
        "slider-60",
    ]
)
@pytest.mark.parametrize("width", few([60, 80, 120], {60}))
@pytest.mark.parametrize("name", RESULTS)
def test_no_line_is_longer_than_the_terminal(name: str, width: int) -> None:
    lines = shown(result(name).blocks(), result(name).title, width).splitlines()
    assert lines
    assert [line for line in lines if len(line) > width] == []
    assert all(line.isprintable() and line.isascii() for line in lines)


@pytest.mark.parametrize("language", few(["ja", "ko"], {"ja"}))
@pytest.mark.parametrize("name", RESULTS)
def test_wide_signs_keep_within_the_terminal(name: str, language: str) -> None:
    with speaking(language):
        text = shown(result(name).blocks(), result(name).title, 60)
    assert not text.isascii()
    wide = [line for line in text.splitlines() if cell_len(line) > 60]
    assert [line for line in wide if len(line.split()) > 1] == []


@pytest.mark.parametrize("name", RESULTS)
def test_no_number_is_cut_and_page_and_terminal_report_the_same(name: str) -> None:
    blocks = result(name).blocks()
    text, page = words(shown(blocks, width=80)), html_of(result(name))
    for table in tables(blocks):
        for row, in_print in zip(grid(table).rows, printed_grid(table).rows, strict=True):
            for cell, other in zip(row, in_print, strict=True):
                if cell.number and cell.text:
                    assert plain(cell.text) in text
                    assert other.text == printed(cell.text)
                    assert other.text_with_note in page


@pytest.mark.parametrize("name", RESULTS)
def test_a_notebook_shows_little(name: str) -> None:
    actual = result(name)
    assert len(repr(actual)) < 120 and "\n" not in repr(actual)
    assert 200 < len(actual._repr_html_()) < 50_000
    assert not re.search(r"\b(nan|None)\b", actual._repr_html_())


@pytest.mark.parametrize("language", few(("en", "ja", "ko"), ("en",)))
def test_every_result_can_be_set_by_typst(language: str) -> None:
    with speaking(language):
        sections = tuple(
            ReportSection(
                f"s{k}",
                name,
                tuple(b for b in actual().blocks() if not isinstance(b, ReportSection)),
            )
            for k, name in enumerate(RESULTS)
            for actual in [lambda name=name: result(name)]
        )
    document = ReportDocument("en", "title", "", "", (), (), "", sections)
    assert pdf(document).startswith(b"%PDF")


# -- as data ---------------------------------------------------------------------------------------


@pytest.mark.exhaustive(
    but=[
        "response",
        "balanced",
        "exact response",
        "slider",
        "tool sweep",
        "front",
        "planting",
        "transient",
        "sweep",
        "conditions",
    ]
)
@pytest.mark.parametrize("name", RESULTS)
def test_every_result_is_a_dataset_and_a_frame(name: str) -> None:
    pytest.importorskip("xarray"), pytest.importorskip("pandas")
    actual = result(name)
    dataset, frame = actual.to_dataset(), actual.to_frame()
    assert len(frame) and (len(frame.columns) or name == "tool response")
    reported = dict(leaves(actual.to_dict()))
    for path, value in reported.items():
        if isinstance(value, np.ndarray):
            np.testing.assert_array_equal(dataset[path], value)
        elif isinstance(value, int | float | str) and not isinstance(actual, Analysis):
            assert dataset.attrs[path] == value
    if frame.index.name is None:
        return
    index = frame.index.name.partition(" [")[0]
    assert dataset[index].dims == (index,)
    heads = {str(column).partition(" [")[0]: column for column in frame.columns}
    for name in heads.keys() & set(dataset.data_vars):
        assert dataset[name].dims == (index,)
        np.testing.assert_array_equal(dataset[name], frame[heads[name]])
        if unit := dataset[name].attrs.get("units"):
            assert heads[name] == f"{name} [{unit}]"


def leaves(values: Any, path: str = "") -> Any:
    for key, value in values.items():
        if isinstance(value, dict):
            yield from leaves(value, f"{path}{key}.")
        else:
            yield f"{path}{key}", value


@pytest.mark.parametrize(
    ("name", "index", "rows", "columns"),
    [
        (
            "sweep",
            "speed [rad/s]",
            None,
            ["gauges.gauge.rms [m]", "mounts.spring.transmissibility [1]"],
        ),
        ("transient", "time [s]", 2001, ["crank_angle [rad]", "gauges.gauge.displacement [m]"]),
        (
            "response",
            "time_in_period [s]",
            360,
            ["crank_angle [rad]", "gauges.roll.displacement [rad]"],
        ),
        ("free vibration", None, 6, ["natural_frequency"]),
        ("front", None, 4, ["first", "second", "added_mass"]),
        ("conditions", None, 4, ["condition", "residual"]),
        ("tool modes", "places [m]", 401, ["planes.vertical.shapes.4"]),
        ("tool sweep", "speed [rad/s]", 12, ["engine.moment [N m]", "belt.phase_vertical [rad]"]),
        ("sensitivities", "crank_angle [rad]", 720, ["sensitivities.crank.mass.values"]),
        ("variation", "values", 4, ["natural_frequencies.0", "natural_frequencies.3"]),
        ("exposure", None, 2, ["name", "a_hv"]),
        ("planting", None, 1, ["curve.height", "max_speed.value"]),
    ],
)
def test_rows_and_columns(
    name: str, index: str | None, rows: int | None, columns: list[str]
) -> None:
    """A sweep has as many rows as its curves need."""
    pytest.importorskip("pandas")
    actual = result(name)
    frame = actual.to_frame()
    assert frame.index.name == index
    assert len(frame) == (len(actual.speed) if rows is None else rows)
    prefix = f"{actual.records}." if actual.records else ""
    assert {f"{prefix}{column}" for column in columns} <= set(frame.columns)


def test_units_of_arrays_and_axes_of_tables() -> None:
    pytest.importorskip("xarray")
    reported = result("sweep").to_dataset()
    assert reported["speed"].attrs == {"units": "rad/s"}
    assert reported["gauges.gauge.rms"].attrs == {"units": "m"}
    assert reported["gauges.gauge.harmonics"].dims == ("speed", "gauges.gauge.harmonics.index_1")
    reported = result("response").to_dataset()
    assert reported["gauges.roll.harmonics"].dims == ("gauges.roll.orders",)
    assert result("transient").to_dataset()["mounts.spring.force"].attrs == {"units": "N"}


# -- cells -----------------------------------------------------------------------------------------


def table_of(*cells: Any, column: Column | None = None) -> Table:
    first = column or Column("value", "length")
    return Table("title", (Column(""), first), tuple((f"row {k}", c) for k, c in enumerate(cells)))


def test_units_and_digits() -> None:
    reported = grid(table_of(Value(0.0123), Span(-0.001, 1.0), Value(1e-15, 1.0), None, "none"))
    assert [row[1].text for row in reported.rows] == ["12.30", "-1.000 to 1000", "0", "", "none"]
    assert reported.heads[1].heading == "value, mm"
    assert grid(table_of(Value(1.0), Span(-1e-20, 2e-20))).rows[1][1].text == "0"
    with showing({"length": "cm"}):
        chosen = grid(table_of(Value(0.0123)))
    assert (chosen.rows[0][1].text, chosen.heads[1].unit) == ("1.230", "cm")
    mixed = table_of(
        Value(2.0, dimension="force"), Value(3e-3, dimension="torque"), column=Column("")
    )
    assert [row[0].text for row in grid(mixed).rows] == ["row 0,\xa0N", "row 1,\xa0N m"]
    turned = grid(table_of(Value(1.0, at=np.pi / 2), Value(np.nan)))
    assert (
        turned.rows[0][1].text_with_note == "1000\xa0(90.0)"
        and turned.heads[1].heading == "value, mm (deg)"
    )
    assert turned.rows[1][1].text == "none"


def test_what_breaks_a_limit_stands_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a word, or by colour where there is colour; numbers stay below each other."""
    table = table_of(Value(7.0, emphasis="broken"), Value(1.0), RelativeChange(1.0, 2.0, "worse"))
    sentence = Text("Nobody may be exposed to this.", "broken")
    assert shown([table, sentence]).splitlines()[-5:] == [
        "row 0      7000, over the limit",
        "row 1      1000",
        "row 2  +100.0 % worse",
        "",
        "! Nobody may be exposed to this.",
    ]
    assert [row[1].emphasis for row in grid(table).rows] == ["broken", None, "worse"]
    html = page(
        ReportDocument("en", "", "", "", (), (), "", (ReportSection("s", "", (table, sentence)),))
    )
    assert (
        re.search(r'<td class="strong"[^>]*>\+100\.0', html) and '<p class="strong">Nobody' in html
    )
    assert re.search(r"\n\.strong\{color:[^}]*font-weight", html)
    monkeypatch.setenv("FORCE_COLOR", "1")
    text = shown([table, sentence])
    assert "\x1b[1;31m    7000\x1b[0m\n" in text and "\x1b[1;31m+100.0 %\x1b[0m\n" in text
    assert "\x1b[1;31mNobody may" in text and not re.search("over the limit|worse|!", text)
    day = words(result("exposure").blocks())
    assert "above the limit value of 5 m/s^2 (2002/44/EC)" in day and "nobody may be exposed" in day


def test_a_daily_exposure_beyond_the_limit_value_stands_out() -> None:
    """In the table also of a day with one task, and in the tile of a report, by colour and word."""
    day = daily_exposure([Task("mowing", 20.0, 3600.0)])
    assert "7.071, over the limit of 5" in words(day.blocks())
    cells = [cell for block in day.blocks() if isinstance(block, Table)
             for row in grid(block).rows for cell in row if cell.emphasis == "broken"]  # fmt: skip
    assert {cell.text_with_note for cell in cells} == {"7.071, over the limit of 5"}
    allowed = daily_exposure([Task("mowing", 5.0, 8 * 3600.0)])
    assert "over the limit" not in words(allowed.blocks())
    tile = next(item for item in tool_tiles(findings_of("brush-cutter")) if "A(8)" in item.label)
    assert tile.emphasis == "broken"
    document = ReportDocument("en", "", "", "", (tile, replace(tile, emphasis=None)), (), "", ())
    html = page(document)
    assert html.count(f'class="value strong">{tile.value} ') == 1
    assert html.count("m/s², over the limit</span>") == 1
    assert pdf(document) != pdf(replace(document, tiles=(replace(tile, emphasis=None),) * 2))


@pytest.mark.parametrize(
    ("environment", "a_terminal", "colour"),
    [
        ({}, True, True),
        ({}, False, False),
        ({"TERM": "dumb"}, True, False),
        ({"NO_COLOR": "1"}, True, False),
        ({"NO_COLOR": ""}, True, True),
        ({"FORCE_COLOR": "1"}, False, True),
        ({"FORCE_COLOR": "1", "NO_COLOR": "1"}, True, False),
    ],
)
def test_colours_are_for_terminals_that_want_them(
    environment: dict[str, str], a_terminal: bool, colour: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    for name, value in {"TERM": "xterm", **environment}.items():
        monkeypatch.setenv(name, value)
    stream = io.StringIO()
    monkeypatch.setattr(stream, "isatty", lambda: a_terminal, raising=False)
    assert terminal.coloured(stream) is colour
