"""Where everything of a chart goes on its sheet: heading, legends, panels, words around them.

Every room is as large as what stands in it, so that nothing is cut and nothing lies on anything
else; no number here is the place of a thing, only its distance from the next.
"""

from __future__ import annotations

import numpy as np

from equipoise.figures.cells import Cell, cell_of, make_room, share
from equipoise.figures.legend import APART, KEY, LegendKey, draw_legend, keys_of, kind_of, rows_of
from equipoise.figures.panel import LEAD, draw, flag_height, frame
from equipoise.figures.sheet import Canvas, Words, lines_of, width_of
from equipoise.figures.style import INK, LARGE, LINES, NORMAL, SMALL
from equipoise.figures.view import AxisScale, View, ticks_of
from equipoise.i18n import said
from equipoise.results.charts import Axis, Chart

WIDE, HALF = 518.4, 290.0
"""Points: width of a picture, and of one of a pair, which is shown half as wide as a page."""

EDGE, GAP, BELOW = 10.0, 14.0, 12.0
"""Points: free at the edges, between columns, and between rows of panels."""
TIED = "\N{NO-BREAK SPACE}"
LINE, OVER, TOP = 12.0, 16.0, 4.0
"""Points: height of a line of words; by how much the name of an axis may be longer than that; free
above a picture without a heading."""
HIGH = {1: 190.0, 2: 132.0, 3: 106.0, 4: 92.0}
HIGH_OF_HALF = {1: 110.0, 2: 70.0, 3: 50.0, 4: 38.0}
"""Height of one of so many panels above each other; the last of more."""
LEAST, MOST, MOST_OF_HALF, ROOM, SMALL_ROOM = 110.0, 345.0, 140.0, 26.0, 0.13
"""Height of panels of one scale at least and at most; free in them around what is drawn, points
or, in small ones, a share."""


def lay_out(chart: Chart, wide: float = WIDE, headed: bool = True) -> Canvas:
    """A chart on a sheet.

    wide : of the sheet, points.  headed : whether the chart's heading stands on it.
    """
    sheet = Canvas(wide, 0.0, said(chart.title))
    top = _heading(sheet, chart) if headed else TOP
    keys = [LegendKey(role, name, kind_of(role)) for role, name in chart.keys]
    keys += [key for panel in chart.panels for key in keys_of(panel, chart_level=True)]
    keys = [*dict.fromkeys(keys)]
    top = draw_legend(sheet, keys, EDGE, wide - EDGE, top) + (5 if keys else 2)
    top = _panels(sheet, chart, top)
    if chart.foot:
        for line in lines_of(chart.foot, wide - 2 * EDGE, NORMAL):
            sheet.add(Words(wide / 2, top + 11, line, NORMAL, INK, "middle"), 7)
            top += LINE
        top += 2
    sheet.height = top + 7
    return sheet


def _heading(sheet: Canvas, chart: Chart) -> float:
    """The machine, what is shown, and further words; where they end."""
    room, top = sheet.width - 2 * EDGE, 3.0
    for line in lines_of(said(chart.title), room, LARGE, bold=True):
        sheet.add(Words(EDGE, top + 14.0, line, LARGE, INK, bold=True), 7)
        top += LARGE + 4
    top += 2.5
    for text in (chart.what, *chart.words):
        for line in lines_of(text, room, NORMAL):
            sheet.add(Words(EDGE, top + 9.5, line, NORMAL, INK), 7)
            top += LINE
    return top + 5


def _panels(sheet: Canvas, chart: Chart, top: float) -> float:
    columns = min(chart.columns, len(chart.panels))
    if sheet.width == HALF and not all(panel.equal for panel in chart.panels):
        columns = 1  # words along the axes need the width
    rows = [chart.panels[k : k + columns] for k in range(0, len(chart.panels), columns)]
    high, most = (HIGH_OF_HALF, MOST_OF_HALF / len(rows)) if sheet.width == HALF else (HIGH, MOST)
    usual = high[min(len(rows), max(high))]
    highest = usual if sheet.width == HALF else np.inf
    cells = [cell_of(panel, min(panel.height or usual, highest)) for panel in chart.panels]
    share(cells, columns)
    for cell in cells:
        make_room(cell, OVER)
    inner = (sheet.width - 2 * EDGE - (columns - 1) * GAP) / columns
    for number, cell in enumerate(cells):
        later = cells[number + columns :: columns]
        cell.numbered = not (chart.stacked and any(_same_x(cell, item) for item in later[:1]))
        _sides(cell)
    one_scale = cells[0].panel.equal  # and so one width
    for column in range(columns):
        aligned = cells if one_scale else cells[column::columns]
        left, right = max(cell.left for cell in aligned), max(cell.right for cell in aligned)
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


def _same_x(cell: Cell, other: Cell) -> bool:
    alike = cell.panel.x.text == other.panel.x.text and cell.panel.x.scale == other.panel.x.scale
    return alike and bool(np.allclose(cell.x_ends, other.x_ends)) and not cell.panel.equal


def _sides(cell: Cell) -> None:
    """What stands at the left, at the right and below of the axes."""
    panel = cell.panel
    if panel.bare:
        cell.below = LINE * len(panel.x.label.split("\n")) + 4 if panel.x.label else 4.0
        return
    y = AxisScale(panel.y, *cell.y_ends, cell.height, 0.0)
    numbers = [text for _, text in ticks_of(y, upright=True)] or [""]
    if panel.equal:
        numbers.append("−0000")
    wide = max(width_of(text, SMALL) for text in numbers)
    if panel.y.label:
        cell.y_label = _name_of(panel.y, cell.height + OVER)
    cell.left = max(
        7 + wide + 2 + (1 + LINE * len(cell.y_label) if cell.y_label else 0),
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
        side = min(width, most)
        room = SMALL_ROOM * side
        point = max(np.ptp(x), np.ptp(y), cell.least_span) / (side - 2 * room) or 1.0
        cell.height = side if cell.panel.held is None else np.ptp(y) / point + 2 * room
    else:
        high, room = fixed or most, 0.0 if cell.panel.bare else ROOM
        point = max(np.ptp(x) / (width - 2 * room), np.ptp(y) / (high - 2 * room)) or 1.0
        cell.height = fixed or min(max(np.ptp(y) / point + 2 * room, LEAST), most)
    half_x, half_y = point * width / 2, point * cell.height / 2
    cell.x_ends = (float(np.mean(x)) - half_x, float(np.mean(x)) + half_x)
    cell.y_ends = (float(np.mean(y)) - half_y, float(np.mean(y)) + half_y)


def _above(cell: Cell, width: float) -> None:
    """What stands above the axes: words at lines, a title, a legend; and the name below them."""
    panel = cell.panel
    cell.keys = tuple(keys_of(panel, chart_level=False))
    cell.above = flag_height(panel, width)
    head = width_of(panel.title, NORMAL) + width_of(panel.remark, SMALL) + 24
    rows = rows_of([*cell.keys], width)
    cell.beside = len(rows) == 1 and sum(k.width + APART for k in cell.keys) + head < width
    cell.titles = tuple(lines_of(panel.title, width, NORMAL))
    cell.remarks = tuple(lines_of(panel.remark, width, SMALL))
    last = width_of(cell.titles[-1], NORMAL) + 8 if cell.titles else 0.0
    cell.apart = bool(last) and last + width_of(panel.remark, SMALL) > width
    lines = len(cell.titles) + len(cell.remarks)
    lines -= bool(cell.titles and cell.remarks and not cell.apart)
    if cell.titles or cell.remarks or cell.beside:
        cell.above += LINE * max(lines, 1) + 1
    if cell.keys and not cell.beside:
        cell.above += KEY * len(rows) + 2
    if cell.numbered and panel.x.label and not panel.bare:
        cell.x_label = _name_of(panel.x, width + 2 * OVER)
        cell.below += LINE * (len(cell.x_label) - 1)


def _draw(sheet: Canvas, cell: Cell, left: float, top: float, inner: float) -> None:
    """A panel whose axes begin at some height, in its room from the left."""
    panel = cell.panel
    start, end = left + cell.left, left + inner - cell.right
    x = AxisScale(panel.x, *cell.x_ends, start, end)
    y = AxisScale(panel.y, *cell.y_ends, top + cell.height, top)
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
    _titles(sheet, cell, start, end, above + (LINE + 1 if cell.beside else 0.0))
    if panel.bare:
        for number, text in enumerate(panel.x.label.split("\n") if panel.x.label else ()):
            y_foot = top + cell.height + 10 + LINE * number
            sheet.add(Words((start + end) / 2, y_foot, text, SMALL, INK, "middle"), 7)
        return
    frame(view, cell.numbered)
    _name_axes(sheet, cell, view, left)


def _titles(sheet: Canvas, cell: Cell, start: float, end: float, foot: float) -> None:
    for line in reversed(cell.remarks):
        sheet.add(Words(end, foot - 4, line, SMALL, LINES, "end"), 7)
        foot -= LINE
    foot += 0.0 if cell.apart or not cell.remarks else LINE
    for line in reversed(cell.titles):
        sheet.add(Words(start, foot - 4, line, NORMAL, INK), 7)
        foot -= LINE


def _name_of(axis: Axis, room: float) -> tuple[str, ...]:
    """Lines of the name of an axis, whose unit stays whole."""
    unit = axis.unit_name
    whole = axis.text.replace(unit, unit.replace(" ", TIED)) if " " in unit else axis.text
    return tuple(line.replace(TIED, " ") for line in lines_of(whole, room, NORMAL))


def _name_axes(sheet: Canvas, cell: Cell, view: View, left: float) -> None:
    panel = cell.panel
    start, top, end, bottom = view.box
    for number, line in enumerate(cell.y_label):
        where = (left + 9 + LINE * number, (top + bottom) / 2)
        sheet.add(Words(*where, line, NORMAL, INK, "middle", turned=True), 7)
    for number, line in enumerate(cell.x_label):
        where = ((start + end) / 2, bottom + 23.5 + LINE * number)
        sheet.add(Words(*where, line, NORMAL, INK, "middle"), 7)
    if panel.right_axis is not None:
        where = (end + cell.right - 4, (top + bottom) / 2)
        words = Words(*where, panel.right_axis.text, NORMAL, INK, "middle", turned=True)
        sheet.add(words, 7)
