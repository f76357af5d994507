"""Where everything of a chart goes on its sheet: heading, legends, panels, words around them.

Every room is as large as what stands in it, so that nothing is cut and nothing lies on anything
else; no number here is the place of a thing, only its distance from the next.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.figures.legend import APART, KEY, Key, draw_legend, keys_of, kind_of, rows_of
from equipoise.figures.panel import LEAD, draw, flag_height, frame
from equipoise.figures.sheet import Sheet, Words, lines_of, set_in, width_of
from equipoise.figures.style import INK, LARGE, LINES, NORMAL, SMALL
from equipoise.figures.view import Scale, View, ends_of, ticks_of
from equipoise.results.charts import Chart, Panel

WIDE, HALF = 518.4, 340.0
"""Points: width of a picture, and of one of a pair, which is shown half as wide as a page."""

EDGE, GAP, BELOW = 10.0, 14.0, 12.0
"""Points: free at the edges, between columns, and between rows of panels."""
LINE, TOP = 12.0, 4.0
"""Points: height of a line of words; free above a picture without a heading."""
HIGH = {1: 190.0, 2: 132.0, 3: 106.0, 4: 92.0}
HIGH_OF_HALF = {1: 150.0, 2: 84.0, 3: 60.0, 4: 44.0}
"""Height of one of so many panels above each other; the last of more."""
LEAST, MOST, MOST_OF_HALF, ROOM, SMALL_ROOM = 110.0, 345.0, 200.0, 26.0, 0.13
"""Height of panels of one scale at least and at most; free in them around what is drawn, points
or, in small ones, a share."""
LIKE = 3.0
"""How much larger one panel's values may be than another's of the same kind on one scale."""
MOST_LINES = 2
"""Lines of a heading."""


def lay_out(chart: Chart, wide: float = WIDE, headed: bool = True) -> Sheet:
    """A chart on a sheet.

    wide : of the sheet, points.  headed : whether the chart's heading stands on it.
    """
    sheet = Sheet(wide, 0.0, chart.title)
    top = _heading(sheet, chart) if headed else TOP
    keys = [Key(role, name, kind_of(role)) for role, name in chart.keys]
    keys += [key for panel in chart.panels for key in keys_of(panel, chart_level=True)]
    keys = [*dict.fromkeys(keys)]
    top = draw_legend(sheet, keys, EDGE, wide - EDGE, top) + (5 if keys else 2)
    top = _panels(sheet, chart, top)
    if chart.foot:
        text, size = set_in(chart.foot, wide - 2 * EDGE, NORMAL)
        sheet.add(Words(wide / 2 + 14, top + 11, text, size, INK, "middle"), 7)
        top += 14
    sheet.height = top + 7
    return sheet


def _heading(sheet: Sheet, chart: Chart) -> float:
    """The machine, what is shown, and further words; where they end."""
    room = sheet.width - 2 * EDGE
    title, size = set_in(chart.title, room, LARGE, bold=True)
    sheet.add(Words(EDGE, 17.0, title, size, INK, bold=True), 7)
    top = 20.0
    for text in (chart.what, *chart.words):
        for line in lines_of(text, room, NORMAL, MOST_LINES):
            sheet.add(Words(EDGE, top + 9.5, line, NORMAL, INK), 7)
            top += LINE
    return top + 5


@dataclass(eq=False)
class Cell:
    """A panel and the room it needs, points: beside, above and below its axes."""

    panel: Panel
    x_ends: tuple[float, float]
    y_ends: tuple[float, float]
    height: float
    numbered: bool = True
    left: float = 0.0
    right: float = 0.0
    above: float = 0.0
    below: float = 0.0
    keys: tuple[Key, ...] = ()
    beside: bool = False
    """Whether its legend stands on the line of its title."""
    least_span: float = 0.0
    """That the values of panels of one scale, side by side, are drawn as if they had."""


def _panels(sheet: Sheet, chart: Chart, top: float) -> float:
    columns = min(chart.columns, len(chart.panels))
    if sheet.width == HALF and not all(panel.equal for panel in chart.panels):
        columns = 1  # words along the axes need the width
    rows = [chart.panels[k : k + columns] for k in range(0, len(chart.panels), columns)]
    high, most = (HIGH_OF_HALF, MOST_OF_HALF / len(rows)) if sheet.width == HALF else (HIGH, MOST)
    usual = high[min(len(rows), max(high))]
    highest = usual if sheet.width == HALF else np.inf
    cells = [_cell(panel, min(panel.height or usual, highest)) for panel in chart.panels]
    _share(cells)
    inner = (sheet.width - 2 * EDGE - (columns - 1) * GAP) / columns
    for number, cell in enumerate(cells):
        later = cells[number + columns :: columns]
        cell.numbered = not (chart.stacked and any(_same_x(cell, one) for one in later[:1]))
        _sides(cell)
    for column in range(columns):
        left = max(cell.left for cell in cells[column::columns])
        right = max(cell.right for cell in cells[column::columns])
        for cell in cells[column::columns]:
            cell.left, cell.right = left, right
            _settle(cell, inner - left - right, most, small=columns > 1)
            _above(cell, inner - left - right)
    for number in range(0, len(cells), columns):
        row = cells[number : number + columns]
        above = max(cell.above for cell in row)
        height = max(cell.height for cell in row)
        for column, cell in enumerate(row):
            x = EDGE + column * (inner + GAP)
            _draw(sheet, cell, x, top + above, inner)
        last = number + columns >= len(cells)
        top += above + height + max(cell.below for cell in row) + (0 if last else BELOW)
    return top


def _same_x(one: Cell, other: Cell) -> bool:
    alike = one.panel.x.text == other.panel.x.text and one.panel.x.scale == other.panel.x.scale
    return alike and bool(np.allclose(one.x_ends, other.x_ends)) and not one.panel.equal


def _cell(panel: Panel, height: float) -> Cell:
    curves = panel.curves
    x: list[Any] = [*(curve.x for curve in curves), *(area.x for area in panel.areas)]
    y: list[Any] = [curve.y for curve in curves]
    y += [ends for area in panel.areas for ends in (area.low, area.high)]
    for bars in panel.bars:
        half = np.asarray(bars.width, float) / 2
        along, up = np.concatenate([bars.at - half, bars.at + half]), [*bars.size, 0.0]
        x.append(along if bars.across == "x" else up)
        y.append(up if bars.across == "x" else along)
    x += [[mark.x] for mark in panel.marks]
    y += [[mark.y] for mark in panel.marks]
    places = [np.array([arrow.tail, arrow.head]) for arrow in panel.arrows]
    places += [outline.places for outline in panel.outlines]
    places += [np.array(panel.held)] if panel.held is not None else []
    places += [np.zeros(1)] if panel.rings or (panel.equal and panel.zero) else []
    x += [one.real for one in places]
    y += [one.imag for one in places]
    if panel.surface is not None:
        x.append(panel.surface.x)
        y.append(panel.surface.y)
    return Cell(panel, ends_of(panel.x, x), ends_of(panel.y, y), height)


def _share(cells: list[Cell]) -> None:
    """One scale for panels of one quantity, where each still fills a good part of its axes."""
    groups: dict[tuple[str, float | None, bool], list[Cell]] = {}
    for cell in cells:
        axis = cell.panel.y
        if axis.scale == "linear" and axis.unit.unit and axis.high is None:
            groups.setdefault((axis.text, axis.low, cell.panel.equal), []).append(cell)
    for group in groups.values():
        spans = [_span(cell) for cell in group]
        if max(spans) > LIKE * min(spans):
            continue
        if group[0].panel.equal:
            for cell in group:
                cell.least_span = max(spans)
            continue
        ends = (min(c.y_ends[0] for c in group), max(c.y_ends[1] for c in group))
        if ends[1] - ends[0] <= LIKE * min(spans):
            for cell in group:
                cell.y_ends = ends


def _span(cell: Cell) -> float:
    """Of the values in a panel; of one scale the larger of both axes."""
    x, y = (ends[1] - ends[0] for ends in (cell.x_ends, cell.y_ends))
    return max(x, y) if cell.panel.equal else y


def _sides(cell: Cell) -> None:
    """What stands at the left, at the right and below of the axes."""
    panel = cell.panel
    if panel.bare:
        cell.below = LINE * len(panel.x.label.split("\n")) + 4 if panel.x.label else 4.0
        return
    y = Scale(panel.y, *cell.y_ends, cell.height, 0.0)
    numbers = [text for _, text in ticks_of(y, upright=True)] or [""]
    if panel.equal:
        numbers.append("−0000")
    wide = max(width_of(text, SMALL) for text in numbers)
    cell.left = max(
        7 + wide + (15 if panel.y.label else 2),
        *(10 + width_of(text, NORMAL) for text in panel.left),
        *(10 + width_of(text, SMALL) for text in panel.flag_words),
        0.0,
    )
    cell.right = 8.0
    if panel.asides:
        cell.right = LEAD + 4 + max(width_of(aside.text, SMALL) for aside in panel.asides)
    if panel.right:
        cell.right = 10 + max(width_of(text, NORMAL) for text in panel.right)
    if panel.right_axis is not None:
        texts = [text for _, text in panel.right_axis.ticks or ()]
        cell.right = 24 + max((width_of(text, SMALL) for text in texts), default=0.0)
    cell.below = 14.0 + (LINE if panel.x.label else 0.0) if cell.numbered else 4.0


def _settle(cell: Cell, width: float, most: float, small: bool) -> None:
    """Ends of axes of one scale, so that they hold what is drawn with room for its words."""
    if not cell.panel.equal:
        return
    x, y = (np.array(ends) for ends in (cell.x_ends, cell.y_ends))
    fixed = cell.panel.height
    if small and not fixed:
        cell.height = min(width, most)
        inner = cell.height * (1 - 2 * SMALL_ROOM)
        point = max(np.ptp(x), np.ptp(y), cell.least_span) / inner or 1.0
    else:
        high, room = fixed or most, 0.0 if cell.panel.bare else ROOM
        point = max(np.ptp(x) / (width - 2 * room), np.ptp(y) / (high - 2 * room)) or 1.0
        cell.height = fixed or min(max(np.ptp(y) / point + 2 * room, LEAST), most)
    half_x, half_y = point * width / 2, point * cell.height / 2
    cell.x_ends = (float(np.mean(x)) - half_x, float(np.mean(x)) + half_x)
    cell.y_ends = (float(np.mean(y)) - half_y, float(np.mean(y)) + half_y)


def _above(cell: Cell, width: float) -> None:
    """What stands above the axes: words at lines, a title, a legend."""
    panel = cell.panel
    cell.keys = tuple(keys_of(panel, chart_level=False))
    cell.above = flag_height(panel, width)
    head = width_of(panel.title, NORMAL) + width_of(panel.remark, SMALL) + 24
    rows = rows_of([*cell.keys], width)
    cell.beside = len(rows) == 1 and sum(k.width + APART for k in cell.keys) + head < width
    if panel.title or panel.remark or cell.beside:
        cell.above += LINE + 1
    if cell.keys and not cell.beside:
        cell.above += KEY * len(rows) + 2


def _draw(sheet: Sheet, cell: Cell, left: float, top: float, inner: float) -> None:
    """A panel whose axes begin at some height, in its room from the left."""
    panel = cell.panel
    start, end = left + cell.left, left + inner - cell.right
    x = Scale(panel.x, *cell.x_ends, start, end)
    y = Scale(panel.y, *cell.y_ends, top + cell.height, top)
    view = View(panel, x, y, sheet)
    draw(view)
    above = top - flag_height(panel, end - start)
    if cell.keys and cell.beside:
        wide = sum(key.width + APART for key in cell.keys) - APART
        draw_legend(sheet, [*cell.keys], end - wide, end + 1, above - KEY - 0.5)
        above -= LINE + 1
    elif cell.keys:
        rows = rows_of([*cell.keys], end - start)
        draw_legend(sheet, [*cell.keys], start, end, above - KEY * len(rows) - 2)
        above -= KEY * len(rows) + 2
        _titles(sheet, panel, start, end, above)
        above = 0.0
    if above:
        _titles(sheet, panel, start, end, above if not cell.beside else above + LINE + 1)
    if panel.bare:
        for number, text in enumerate(panel.x.label.split("\n") if panel.x.label else ()):
            y_foot = top + cell.height + 10 + LINE * number
            sheet.add(Words((start + end) / 2, y_foot, text, SMALL, INK, "middle"), 7)
        return
    frame(view, cell.numbered)
    _name_axes(sheet, cell, view, left)


def _titles(sheet: Sheet, panel: Panel, start: float, end: float, foot: float) -> None:
    remark = set_in(panel.remark, end - start, SMALL)[0]
    room = end - start - (width_of(remark, SMALL) + 8 if remark else 0)
    title, size = set_in(panel.title, room, NORMAL)
    if title:
        sheet.add(Words(start, foot - 4, title, size, INK), 7)
    if remark:
        sheet.add(Words(end, foot - 4, remark, SMALL, LINES, "end"), 7)


def _name_axes(sheet: Sheet, cell: Cell, view: View, left: float) -> None:
    panel = cell.panel
    start, top, end, bottom = view.box
    if panel.y.label:
        text, size = set_in(panel.y.text, cell.height + 16, NORMAL)
        where = (left + 9, (top + bottom) / 2)
        sheet.add(Words(*where, text, size, INK, "middle", turned=True), 7)
    if panel.x.label and cell.numbered:
        text, size = set_in(panel.x.text, end - start + 40, NORMAL)
        sheet.add(Words((start + end) / 2, bottom + 23.5, text, size, INK, "middle"), 7)
    if panel.right_axis is not None:
        where = (end + cell.right - 4, (top + bottom) / 2)
        words = Words(*where, panel.right_axis.text, NORMAL, INK, "middle", turned=True)
        sheet.add(words, 7)
