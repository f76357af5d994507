"""Excel: the machine, figures of every output, all signals over crank angle, and charts of them.

Everything is in SI units, which stand beside it.  Names and titles are written as text, whatever
they begin with, so that none of them becomes a formula.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from itertools import groupby
from math import isfinite
from typing import Any

from equipoise.balancing.workshop import sentences
from equipoise.errors import UsageError, needed
from equipoise.exchange.formats import Job
from equipoise.i18n import Note
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.analysis import Analysis, analyze
from equipoise.results.outputs import AnalysisOutput

SheetCell = str | float | None
HEADS, MOST_ROWS, MOST_COLUMNS = 2, 2**20, 2**14
"""Rows above the signals, with their names and units; what a sheet takes."""
LARGE = 1_000_000
"""Numbers of signals beyond which rows go to the disk as they are written, since each takes some
hundred bytes; then columns keep their usual widths.
"""
WIDE, HIGH = 8, 16
"""Columns and rows that a chart takes."""


def export_bytes(job: Job) -> bytes:
    """The file's content."""
    data = io.BytesIO()
    analysis = analyze(job.machine)
    columns = analysis.outputs.arrays
    rows = len(analysis.crank_angle)
    _check_size(rows, 1 + len(columns), analysis.motion.turns)
    options = {"constant_memory": True} if rows * len(columns) > LARGE else {"in_memory": True}
    book = needed("xlsxwriter", "Excel").Workbook(data, options)
    book.set_properties({"title": str(job.machine.title)})
    job.leave_out_forces()
    _sheet(book, "Summary", _summary(analysis))
    _sheet(book, "Links", _links(job.machine))
    _sheet(book, "Points", _points(job.machine))
    if job.changes:
        values = [(sentence,) for change in job.changes for sentence in sentences(change)]
        _sheet(book, "Changes", [("what to change",), *values])
    charts = book.add_worksheet("Charts")
    _signals(book, analysis, columns)
    _charts(book, charts, columns, len(analysis.crank_angle))
    book.close()
    return data.getvalue()


def _check_size(rows: int, columns: int, turns: int) -> None:
    """Refuse more signals than a sheet takes, of which the library would leave out the rest."""
    if rows + HEADS > MOST_ROWS or columns > MOST_COLUMNS:
        raise UsageError(
            Note(
                "a cycle of {turns} turns has {rows} crank angles and {columns} columns; "
                "a sheet of Excel takes {most_rows} and {most_columns}: write .mat "
                "instead",
                turns=turns,
                rows=rows,
                columns=columns,
                most_rows=MOST_ROWS - HEADS,
                most_columns=MOST_COLUMNS,
            )
        )


def _sheet(book: Any, name: str, rows: Sequence[Sequence[SheetCell]]) -> Any:
    """A sheet whose first row is its head, and stays in sight."""
    sheet = book.add_worksheet(name)
    bold = book.add_format({"bold": True})
    for number, row in enumerate(rows):
        for column, cell in enumerate(row):
            _write(sheet, number, column, cell, *([] if number else [bold]))
    sheet.freeze_panes(1, 1)
    if not book.constant_memory:
        sheet.autofit()
    return sheet


def _write(sheet: Any, row: int, column: int, cell: SheetCell, *form: Any) -> None:
    if isinstance(cell, str):
        sheet.write_string(row, column, cell, *form)
    elif cell is not None and isfinite(cell):
        sheet.write_number(row, column, cell, *form)


def _summary(analysis: Analysis) -> list[Sequence[SheetCell]]:
    """A row an output: its words, its unit, its figures."""
    outputs = analysis.outputs
    rows = [
        (name, outputs[name].label(), outputs[name].unit, *asdict(figures).values())
        for name, figures in analysis.summary.items()
    ]
    figures = next((asdict(item) for item in analysis.summary.values()), {})
    heads = (f"{figure} [rad]" if figure.endswith("_at") else figure for figure in figures)
    return [("output", "what it is", "unit", *heads), *rows]


def _links(machine: Machine) -> list[Sequence[SheetCell]]:
    head = ("link", "mass [kg]", "centre x [m]", "centre y [m]", "inertia [kg m^2]")
    rows = [
        (name, link.mass, *(link.center_of_mass or (None, None)), link.inertia)
        for name, link in machine.links.items()
    ]
    return [head, *rows]


def _points(machine: Machine) -> list[Sequence[SheetCell]]:
    rows = [(b, name, *at) for b, points in machine.bodies.items() for name, at in points.items()]
    return [("body", "point", "x [m]", "y [m]"), *rows]


def _signals(book: Any, analysis: Analysis, columns: Iterable[AnalysisOutput]) -> None:
    """Name, unit, and the values over crank angle, below each other."""
    items = [(column.name, column.unit, column.values) for column in columns]
    sheet = _sheet(book, "Signals", [["crank_angle", *(name for name, _, _ in items)]])
    every = [("crank_angle", "rad", analysis.crank_angle), *items]
    for column, (_, unit, _) in enumerate(every):
        _write(sheet, 1, column, unit)
    for row, values in enumerate(zip(*(values for _, _, values in every), strict=True), HEADS):
        for column, value in enumerate(values):
            _write(sheet, row, column, float(value))
    sheet.freeze_panes(2, 1)


def _charts(book: Any, sheet: Any, columns: Sequence[AnalysisOutput], count: int) -> None:
    """Signals of one group and unit in one chart; they are drawn from the sheet of signals."""
    numbered = sorted(enumerate(columns, 1), key=lambda item: (item[1].group, item[1].unit))
    kinds = groupby(numbered, key=lambda column: (column[1].group, column[1].unit))
    for place, ((group, unit), members) in enumerate(kinds):
        chart = book.add_chart({"type": "scatter", "subtype": "straight"})
        for column, _ in members:
            chart.add_series(
                {
                    "name": ["Signals", 0, column],
                    "categories": ["Signals", 2, 0, count + 1, 0],
                    "values": ["Signals", 2, column, count + 1, column],
                }
            )
        chart.set_title({"name": f"{group} [{unit}]" if unit else group})
        chart.set_x_axis({"name": "crank_angle [rad]", "min": 0})
        sheet.insert_chart(place // 2 * HIGH, place % 2 * WIDE, chart)
