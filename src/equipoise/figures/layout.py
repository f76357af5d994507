"""Where everything of a chart goes on its sheet: heading, legends, panels, words.

Every room is as large as what stands in it, so that nothing is cut and nothing lies on anything
else; no number here is the place of a thing, only its distance from the next.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.curves import UNIT, draw_shapes, sample_of, signs_at
from equipoise.figures.panel import LEAD, draw, flag_height, frame
from equipoise.figures.sheet import MIDDLE, Canvas, CanvasStroke, Words, lines_of, set_in, width_of
from equipoise.figures.style import INK, LARGE, LINES, NORMAL, SMALL, look_of
from equipoise.figures.view import (
    DECADES,
    AxisScale,
    View,
    corners_of,
    ends_of,
    round_below,
    ticks_of,
)
from equipoise.i18n import localized, say
from equipoise.results.charts import Axis, Chart, Panel
from equipoise.symbols.looks import LOOKS

KEY, SAMPLE, APART = 13.5, 20.0, 14.0
"""Points: height of a legend's row; width of a sample; between two of them."""


@dataclass(frozen=True)
class LegendKey:
    """An entry of a legend: how something looks, and its name."""

    role: str
    name: str
    kind: str
    dashed: bool = False

    @property
    def width(self) -> float:
        """Points."""
        return SAMPLE + 5 + width_of(self.name, NORMAL)


def kind_of(role: str) -> str:
    """How a role is shown in a legend."""
    if role in LOOKS:
        return "machine"
    look = look_of(role)
    return "patch" if look.fill and not look.sign else "line"


def keys_of(panel: Panel, chart_level: bool) -> list[LegendKey]:
    """Entries of the chart's legend from a panel, or those of the panel's own legend."""
    legend_keys = [LegendKey(c.role, c.label, "line", c.dashed) for c in panel.curves if c.label]
    if panel.keyed:
        legend_keys = [] if chart_level else legend_keys
    elif not chart_level:
        return []
    if chart_level:
        patches: Sequence[Any] = (*panel.bars, *panel.areas, *panel.outlines)
        kinds = ("patch", patches), ("line", panel.lines), ("sign", panel.marks)
        for kind, every in (*kinds, ("patch", panel.bands)):
            legend_keys += [LegendKey(item.role, item.label, kind) for item in every if item.label]
        if panel.surface is not None and panel.surface.lacking:
            legend_keys.append(LegendKey("off", panel.surface.lacking, "patch"))
    return [*dict.fromkeys(legend_keys)]


def rows_of(keys: list[LegendKey], room: float) -> list[list[LegendKey]]:
    """Entries of a legend in rows."""
    rows: list[list[LegendKey]] = []
    left = 0.0
    for key in keys:
        wide = key.width + APART
        if not rows or left < wide - APART:
            rows.append([])
            left = room
        rows[-1].append(key)
        left -= wide
    return rows


def draw_legend(
    sheet: Canvas, keys: list[LegendKey], left: float, right: float, top: float
) -> float:
    """Draw entries below each other in rows; where they end."""
    for row in rows_of(keys, right - left):
        x = left
        for key in row:
            _sample(sheet, key, x, top + KEY / 2)
            text, size = set_in(key.name, right - x - SAMPLE - 5, NORMAL)
            y = top + KEY / 2 + MIDDLE * NORMAL
            sheet.add(Words(x + SAMPLE + 5, y, text, size, INK), 7)
            x += key.width + APART
        top += KEY
    return top


def _sample(sheet: Canvas, key: LegendKey, x: float, y: float) -> None:
    if key.kind == "machine":
        draw_shapes(sheet, sample_of(key.role), lambda z: np.array([x + SAMPLE / 2, y]), 1.0, 6.0)
        return
    look = look_of(key.role, key.dashed)
    if key.kind == "patch":
        corners = corners_of((x + 3, y - 4, x + 17, y + 4))
        sheet.add(CanvasStroke((corners,), fill=look.inside, opacity=look.opacity, closed=True), 6)
        return
    if look.width and key.kind == "line" and not (look.sign and look.order >= 4):
        ends = np.array([(x, y), (x + SAMPLE, y)])
        sheet.add(CanvasStroke((ends,), look.color, look.width, _shortened(look.lengths)), 6)
    if look.sign or key.kind == "sign":
        sample_look = replace(look, size=3.0 if look.sign == "." else look.size)
        if not look.sign:
            sample_look = replace(look, sign="o", size=4.0)
        sheet.add(signs_at(np.array([(x + SAMPLE / 2, y)]), sample_look), 6.1)


def _shortened(lengths: tuple[float, ...]) -> tuple[float, ...]:
    """Dashes of which a sample shows at least one and a half, else it looks like a whole line."""
    factor = min(1.0, SAMPLE / (1.5 * sum(lengths))) if lengths else 1.0
    return tuple(factor * length for length in lengths)


LIKE, ALIGNED = 5.0, 1.3
"""From how much less than others a panel spans that is drawn larger than they are; over the longest
of some axes, how long all may be so that all have the same ends."""
SHALLOW, LOWEST = 0.5, 50.0
"""Over the usual height, what a panel has at least that needs less than others on their scale; and
points, for three numbers and two texts."""
VARIES = 1e-9
"""Over the largest value: what varies by less is rounding."""


@dataclass(eq=False)
class PanelCell:
    """A panel and the room it needs, points: beside, above and below its axes."""

    panel: Panel
    x_ends: tuple[float, float]
    y_ends: tuple[float, float]
    height: float
    span: float
    """Of its axis of values, of one scale the longer of both; 0 where nothing varies."""
    least_span: float = 0.0
    """That it is drawn as if it had, where others have one scale with it."""
    numbered: bool = True
    left: float = 0.0
    right: float = 0.0
    above: float = 0.0
    below: float = 0.0
    keys: tuple[LegendKey, ...] = ()
    legend_in_title: bool = False
    """Whether its legend stands on the line of its title."""
    titles: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()
    apart: bool = False
    """Lines of its title and of its remark; whether these begin below the last line of that."""
    drawn_ends: tuple[tuple[float, float], ...] = ()
    """Of axes of one scale without the room for words, which their ends have then."""
    y_label: tuple[str, ...] = ()
    x_label: tuple[str, ...] = ()


def cell_of(panel: Panel, height: float) -> PanelCell:
    """A panel with the ends of its axes, that hold what is drawn."""
    curves = panel.curves
    x: list[Any] = [*(curve.x for curve in curves), *(area.x for area in panel.areas)]
    y: list[Any] = [curve.y for curve in curves]
    y += [ends for area in panel.areas for ends in (area.low, area.high)]
    for bars in panel.bars:
        half = np.asarray(bars.width, float) / 2
        along, up = np.concatenate([bars.at - half, bars.at + half]), [*bars.size, 0.0]
        x.append(along if bars.across == "x" else up)
        y.append(up if bars.across == "x" else along)
    x += [cells.x for cells in panel.cells]
    y += [cells.y for cells in panel.cells]
    x += [[mark.x] for mark in panel.marks]
    y += [[mark.y] for mark in panel.marks]
    places = [np.array([arrow.tail, arrow.head]) for arrow in panel.arrows]
    places += [outline.places for outline in panel.outlines]
    places += [np.array(panel.always_shown)] if panel.always_shown is not None else []
    places += [np.zeros(1)] if panel.rings or (panel.equal and panel.zero) else []
    x += [place.real for place in places]
    y += [place.imag for place in places]
    if panel.surface is not None:
        x.append(panel.surface.x)
        y.append(panel.surface.y)
    ends = ends_of(panel.x, x), ends_of(panel.y, y)
    spans = [high - low for low, high in ends] if panel.equal else [ends[1][1] - ends[1][0]]
    varying = _vary(y) or (panel.equal and _vary(x)) or panel.y.low is not None
    return PanelCell(panel, *ends, height, max(spans) if varying and not panel.message else 0.0)


def _vary(parts: list[Any]) -> bool:
    """Whether values are not all the same."""
    every = np.concatenate([np.zeros(0), *(np.ravel(np.asarray(part, float)) for part in parts)])
    every = every[np.isfinite(every)]
    return bool(every.size and np.ptp(every) > VARIES * np.max(np.abs(every)))


# -- one scale -------------------------------------------------------------------------------------


def share(cells: list[PanelCell], columns: int) -> None:
    """One scale for panels of one unit over like axes; what that would flatten is drawn larger."""
    groups: dict[tuple[str, str, bool], list[PanelCell]] = {}
    for cell in cells:
        panel = cell.panel
        span = cell.span or panel.message  # what is constant may be far from the others
        if span and panel.y.unit.unit and (panel.y.scale == "log" or panel.y.high is None):
            key = panel.x.text, panel.y.unit.unit, panel.equal
            groups.setdefault(key, []).append(cell)
    for group in groups.values():
        if group[0].panel.y.scale == "log":
            low, high = (f(c.y_ends[k] for c in group) for k, f in enumerate((min, max)))
            for cell in group if high < low * 10**DECADES else ():
                cell.y_ends = (low, high)
            continue
        rate = max(cell.span / cell.height for cell in group)
        if len(group) < 2 or not rate:
            continue
        larger = [_enlarged(cell, rate * cell.height) for cell in group]
        if not group[0].panel.equal:
            alike = [cell for cell, times in zip(group, larger, strict=True) if times == 1]
            rate = _align([cell for cell in alike if cell.panel.y.low is None], rate)
        for cell, times in zip(group, larger, strict=True):
            cell.least_span = rate * cell.height / times
            if not cell.panel.equal:
                _stretch(cell, columns)


def _enlarged(cell: PanelCell, most: float) -> float:
    """Scale of a panel over that of the others, which span `most`; 1 unless stated on the panel."""
    if not cell.span or most < LIKE * cell.span:
        return 1.0
    larger = round_below(most / cell.span)
    text = say("drawn {times} times as large", times=f"{larger:g}")
    remark = f"{cell.panel.remark}; {text}" if cell.panel.remark else text
    cell.panel = replace(cell.panel, remark=remark)
    return larger


def _align(cells: list[PanelCell], rate: float) -> float:
    """Give axes equal ends, where these need not be much longer for that.

    rate : of one scale, a point in the unit of the axes.  Returns that which all of them have then.
    """
    ends = np.array([cell.y_ends for cell in cells if cell.span])
    if not ends.size:
        return rate
    low, high = float(np.min(ends)), float(np.max(ends))
    least = (high - low) / min(cell.height for cell in cells)
    if least > ALIGNED * rate:
        return rate
    for cell in cells:
        cell.y_ends = (low, high)
    return max(rate, least)


def _stretch(cell: PanelCell, columns: int) -> None:
    """An axis as long as its scale has it: in both senses, or from where it begins.

    One that begins somewhere, with no other beside it, gets less high before it gets longer.
    """
    low, high = cell.y_ends
    if cell.panel.y.low is None:
        middle, half = (low + high) / 2, cell.least_span / 2
        cell.y_ends = (middle - half, middle + half)
        return
    part = 1.0
    if columns == 1 and cell.span and not cell.panel.height:
        part = min(max((high - low) / cell.least_span, SHALLOW, LOWEST / cell.height), 1.0)
    cell.height *= part
    cell.y_ends = (low, low + part * cell.least_span)


NUMBERS = 15.0
"""Points that a number takes above the highest bar or a maximum, or below one that goes down."""
UPWARD = 45.0
"""deg from straight up or down, within which a text stands above or below its place."""


def make_room(row: list[PanelCell], over: float) -> None:
    """Higher axes of the same scale, where numbers at bars, extremes or a word of their name need
    that; alike for cells side by side.

    over : points by which a name may be longer than its axis.
    """
    needs = [_room_for_words(cell, over) for cell in row]
    above, below = (max(ends) for ends in zip(*needs, strict=True))
    for cell in row:
        if not _is_fixed(cell.panel):
            low, high = cell.y_ends
            rate = (high - low) / cell.height
            begins = cell.panel.y.low is not None and low >= 0
            own = 0.0 if begins else below
            cell.height += above + below
            cell.y_ends = (low - own * rate, high + (above + below - own) * rate)


def _is_fixed(panel: Panel) -> bool:
    """Whether its axis of values has the ends that it has."""
    given = panel.y.ticks is not None or panel.y.high is not None or panel.y.scale == "log"
    return panel.equal or panel.bare or given


def _room_for_words(cell: PanelCell, over: float) -> tuple[float, float]:
    """Points that are missing above and below what is drawn."""
    panel, factor = cell.panel, cell.panel.y.unit.factor
    if _is_fixed(panel):
        return 0.0, 0.0
    low, high = cell.y_ends
    rate = (high - low) / cell.height
    matching_bars = [bars for bars in panel.bars if bars.labelled and bars.across == "x"]
    up = [float(np.max(bars.size, initial=0.0)) for bars in matching_bars]
    sizes = [float(np.min(bars.size, initial=0.0)) for bars in matching_bars]
    down = [size for size in sizes if size < 0]
    for mark in panel.marks:
        if mark.text and abs(abs(mark.wish) - 90.0) < UPWARD:
            (up if mark.wish > 0 else down).append(mark.y)
    above = max((NUMBERS - (high - factor * top) / rate for top in up), default=0.0)
    below = max((NUMBERS - (factor * bottom - low) / rate for bottom in down), default=0.0)
    above, below = max(above, 0.0), max(below, 0.0)
    longest = max((width_of(word, NORMAL) for word in panel.y.text.split()), default=0.0)
    extra = max(longest - over - cell.height - above, 0.0)
    return (above + extra, below) if panel.bars else (above + extra / 2, below + extra / 2)


WIDE, HALF = 518.4, 262.0
"""Points: width of a picture, and of one of a pair, which is shown half as wide as a page."""

EDGE, GAP, BELOW = 10.0, 14.0, 12.0
"""Points: free at the edges, between columns, and between rows of panels."""
TIED = "\N{NO-BREAK SPACE}"
LINE, OVER, TOP = 12.0, 16.0, 8.0
"""Points: height of a line of words; by how much the name of an axis may be longer than that; free
above a picture without a heading."""
HIGH = {1: 190.0, 2: 132.0, 3: 106.0, 4: 92.0}
HIGH_OF_HALF = {1: 110.0, 2: 64.0, 3: 42.0, 4: 38.0}
"""Height of one of so many panels above each other; the last of more."""
LEAST, MOST, ROOM, SMALL_ROOM = 110.0, 345.0, 26.0, 0.13
"""Height of panels of one scale at least and at most; free in them around what is drawn, points
or, in small ones, a share."""
MOST_OF_HALF, ONE_OF_HALF, LEAST_OF_HALF = 300.0, 150.0, 90.0
"""Height of all such panels in half of a page, of one, and of one of more than have room so."""
FLATTEST = 0.45
"""Least height of axes of one scale beside others, over their width, around flat curves."""
MOST_OF_ROWS = 220.0
"""Height of all rows of drawings in a picture, so that a page has room for two such pictures."""
MOST_ALONE = 4
"""Rows of drawings in half of a page that share its height; more have `LEAST_OF_HALF` each."""
PAIRED = 4
"""Drawings without names of axes that stand in pairs on a telephone; fewer below each other, but
for those without axes, such as dials."""


def lay_out(chart: Chart, wide: float = WIDE, headed: bool = True) -> Canvas:
    """A chart on a sheet.

    wide : of the sheet, points.
    headed : whether the chart's heading stands on it; without, it is lower where it has rows of
        drawings, as a page of a report has others beside it.
    """
    return _sheet(chart, _cells(chart, wide, low=not headed), wide, headed)


def on_telephone(chart: Chart) -> Canvas:
    """A wide chart without its heading on a sheet of half that width: panels below each other, but
    for small ones without names of axes, which stand in pairs.  It is as high as it needs.
    """
    panels = chart.panels
    small = all(panel.equal and not panel.y.label for panel in panels)
    paired = small and (len(panels) >= PAIRED or all(panel.bare for panel in panels))
    chart = replace(chart, columns=2 if paired else 1)
    return _sheet(chart, _cells(chart, HALF, scrolled=True), HALF, headed=False)


def lay_out_rows(chart: Chart, wide: float) -> Iterator[Canvas]:
    """Rows of panels on sheets of their own, without headings, in the scale of the whole chart.

    The last row stands with the one before where it has fewer panels.
    """
    cells, columns = _cells(chart, wide, parted=True), _columns(chart, wide)
    starts = range(0, max(len(cells) - columns, 0) + 1, columns)
    for begin, end in zip(starts, (*starts[1:], len(cells)), strict=True):
        row = replace(chart, panels=chart.panels[begin:end])
        yield _sheet(row, cells[begin:end], wide, headed=False)


def _sheet(chart: Chart, cells: list[PanelCell], wide: float, headed: bool) -> Canvas:
    sheet = Canvas(wide, 0.0, localized(chart.title))
    top = _heading(sheet, chart) if headed else TOP
    keys = [LegendKey(role, name, kind_of(role)) for role, name in chart.keys]
    keys += [key for panel in chart.panels for key in keys_of(panel, chart_level=True)]
    keys = [*dict.fromkeys(keys)]
    top = draw_legend(sheet, keys, EDGE, wide - EDGE, top) + (5 if keys else 2)
    top = _panels(sheet, cells, _columns(chart, wide), top)
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
    for line in lines_of(localized(chart.title), room, LARGE, bold=True):
        sheet.add(Words(EDGE, top + 14.0, line, LARGE, INK, bold=True), 7)
        top += LARGE + 4
    top += 2.5
    for text in (chart.what, *chart.words):
        for line in lines_of(text, room, NORMAL):
            sheet.add(Words(EDGE, top + 9.5, line, NORMAL, INK), 7)
            top += LINE
    return top + 5


def _columns(chart: Chart, wide: float) -> int:
    """Panels beside each other."""
    if wide == HALF and not all(panel.equal for panel in chart.panels):
        return 1  # words along the axes need the width
    return min(chart.columns, len(chart.panels))


def _inner(wide: float, columns: int) -> float:
    """Width of each of some columns."""
    return (wide - 2 * EDGE - (columns - 1) * GAP) / columns


def _cells(
    chart: Chart, wide: float, parted: bool = False, low: bool = False, scrolled: bool = False
) -> list[PanelCell]:
    """Panels with their axes, in one scale.

    parted : whether each row stands alone, so that all axes have numbers.
    low : whether rows of drawings have `MOST_OF_ROWS` at most.
    scrolled : whether each of several drawings may be as high as one alone in half of a page, and
        so each panel of a chart that runs across the page for its many curves.
    """
    columns = _columns(chart, wide)
    rows = -(-len(chart.panels) // columns)
    high, most = HIGH, MOST
    if wide == HALF:
        high, most = HIGH_OF_HALF, min(MOST_OF_HALF / rows, ONE_OF_HALF)
        if rows > MOST_ALONE:
            most = LEAST_OF_HALF
        if scrolled:
            most = ONE_OF_HALF
    usual = high[1 if scrolled and chart.across else min(rows, max(high))]
    highest = usual if wide == HALF else np.inf
    cells = [cell_of(panel, min(panel.height or usual, highest)) for panel in chart.panels]
    share(cells, columns)
    for start in range(0, len(cells), columns):
        make_room(cells[start : start + columns], OVER)
    inner = _inner(wide, columns)
    for number, cell in enumerate(cells):
        later = cells[number + columns :: columns] if chart.stacked and not parted else []
        cell.numbered = not any(_same_x(cell, item) for item in later[:1])
    _widths(cells, columns, inner, most)
    if cells[0].panel.equal:  # names beside the axes are as long as these are high then
        _widths(cells, columns, inner, most)
    for start in range(0, len(cells), columns):
        _level(cells[start : start + columns])
    if low and wide == WIDE and rows > 1 and cells[0].panel.always_shown is not None:
        heights = [cell.height for cell in cells]
        total = sum(max(heights[k : k + columns]) for k in range(0, len(cells), columns))
        _widths(cells, columns, inner, max(heights) * min(1.0, MOST_OF_ROWS / total))
    for cell in cells:
        _above(cell, inner - cell.left - cell.right)
    return cells


def _panels(sheet: Canvas, cells: list[PanelCell], columns: int, top: float) -> float:
    """Draw cells below a place, in so many columns; where they end."""
    inner = _inner(sheet.width, columns)
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


def _widths(cells: list[PanelCell], columns: int, inner: float, most: float) -> None:
    """What stands beside the axes, alike in each column, and the axes' ends and heights."""
    one_scale = cells[0].panel.equal  # and so one width
    for cell in cells:
        _sides(cell)
    for column in range(columns):
        aligned = cells if one_scale else cells[column::columns]
        left, right = max(cell.left for cell in aligned), max(cell.right for cell in aligned)
        for cell in cells[column::columns]:
            cell.left, cell.right = left, right
            _settle(cell, inner - left - right, most, small=columns > 1)


def _same_x(cell: PanelCell, other: PanelCell) -> bool:
    alike = cell.panel.x.text == other.panel.x.text and cell.panel.x.scale == other.panel.x.scale
    return alike and bool(np.allclose(cell.x_ends, other.x_ends)) and not cell.panel.equal


def _sides(cell: PanelCell) -> None:
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


def _settle(cell: PanelCell, width: float, most: float, small: bool) -> None:
    """Ends of axes of one scale, so that they hold what is drawn with room for its words."""
    if not cell.panel.equal:
        return
    cell.drawn_ends = cell.drawn_ends or (cell.x_ends, cell.y_ends)
    x, y = np.array(cell.drawn_ends, float)
    fixed = cell.panel.height
    if cell.panel.bare and cell.panel.signs:
        most = max(most, _hold_signs(cell.panel, x, y, width))
    if small and not fixed:
        side = min(width, most)
        room = SMALL_ROOM * side
        point = max(np.ptp(x), np.ptp(y), cell.least_span) / (side - 2 * room) or 1.0
        cell.height = np.ptp(y) / point + 2 * room
        if cell.panel.always_shown is None:
            square = cell.panel.rings or cell.panel.bare
            cell.height = side if square else max(cell.height, FLATTEST * side)
    else:
        high, room = fixed or most, 0.0 if cell.panel.bare else ROOM
        point = max(np.ptp(x) / (width - 2 * room), np.ptp(y) / (high - 2 * room)) or 1.0
        cell.height = fixed or min(max(np.ptp(y) / point + 2 * room, LEAST), most)
    half_x, half_y = point * width / 2, point * cell.height / 2
    cell.x_ends = (float(np.mean(x)) - half_x, float(np.mean(x)) + half_x)
    cell.y_ends = (float(np.mean(y)) - half_y, float(np.mean(y)) + half_y)


def _level(row: list[PanelCell]) -> None:
    """Give curves of one scale side by side the height of the highest, each on its own scale."""
    if not all(cell.panel.equal and cell.panel.always_shown is None for cell in row):
        return
    highest = max(cell.height for cell in row)
    for cell in row:
        low, high = cell.y_ends
        more = (high - low) * (highest / cell.height - 1) / 2
        cell.y_ends, cell.height = (low - more, high + more), highest


ROUNDS = 4
"""In which the ends and the scale of a drawing follow each other; they hardly change then."""


def _hold_signs(panel: Panel, x: Any, y: Any, width: float) -> float:
    """Move the ends x, y (2,) of a drawing without axes so that they hold its signs too, whose size
    on paper is their own; its height then, points.
    """
    unit, factor = UNIT * panel.sign_size, panel.x.unit.factor
    for _ in range(ROUNDS):
        point = np.ptp(x) / width or 1.0
        scale = factor / point
        for part, ends in (("real", x), ("imag", y)):
            every = np.concatenate([
                getattr(shape.at(scale, unit), part) + side * shape.size(scale, unit)
                for shape in panel.signs for side in (-1, 1)
            ])  # fmt: skip
            ends[:] = min(ends[0], point * np.min(every)), max(ends[1], point * np.max(every))
    return float(np.ptp(y) / (np.ptp(x) / width))


def _above(cell: PanelCell, width: float) -> None:
    """What stands above the axes: words at lines, a title, a legend; and the name below them."""
    panel = cell.panel
    cell.keys = tuple(keys_of(panel, chart_level=False))
    cell.above = flag_height(panel, width)
    head = width_of(panel.title, NORMAL) + width_of(panel.remark, SMALL) + 24
    rows = rows_of([*cell.keys], width)
    cell.legend_in_title = len(rows) == 1 and sum(k.width + APART for k in cell.keys) + head < width
    cell.titles = tuple(lines_of(panel.title, width, NORMAL))
    cell.remarks = _tied_lines(panel.remark, panel.y.unit_name, width, SMALL)
    last = width_of(cell.titles[-1], NORMAL) + 8 if cell.titles else 0.0
    cell.apart = bool(last) and last + width_of(panel.remark, SMALL) > width
    lines = len(cell.titles) + len(cell.remarks)
    lines -= bool(cell.titles and cell.remarks and not cell.apart)
    if cell.titles or cell.remarks or cell.legend_in_title:
        cell.above += LINE * max(lines, 1) + 1
    if cell.keys and not cell.legend_in_title:
        cell.above += KEY * len(rows) + 2
    if cell.numbered and panel.x.label and not panel.bare:
        cell.x_label = _name_of(panel.x, width + 2 * OVER)
        cell.below += LINE * (len(cell.x_label) - 1)


def _draw(sheet: Canvas, cell: PanelCell, left: float, top: float, inner: float) -> None:
    """A panel whose axes begin at some height, in its room from the left."""
    panel = cell.panel
    start, end = left + cell.left, left + inner - cell.right
    x = AxisScale(panel.x, *cell.x_ends, start, end)
    y = AxisScale(panel.y, *cell.y_ends, top + cell.height, top)
    view = View(panel, x, y, sheet)
    draw(view)
    above = top - flag_height(panel, end - start)
    if cell.keys and cell.legend_in_title:
        wide = sum(key.width + APART for key in cell.keys) - APART
        draw_legend(sheet, [*cell.keys], end - wide, end + 1, above - KEY - 0.5)
        above -= LINE + 1
    elif cell.keys:
        rows = rows_of([*cell.keys], end - start)
        draw_legend(sheet, [*cell.keys], start, end, above - KEY * len(rows) - 2)
        above -= KEY * len(rows) + 2
    _titles(sheet, cell, start, end, above + (LINE + 1 if cell.legend_in_title else 0.0))
    if panel.bare:
        for number, text in enumerate(panel.x.label.split("\n") if panel.x.label else ()):
            y_foot = top + cell.height + 10 + LINE * number
            sheet.add(Words((start + end) / 2, y_foot, text, SMALL, INK, "middle"), 7)
        return
    frame(view, cell.numbered)
    _name_axes(sheet, cell, view, left)


def _titles(sheet: Canvas, cell: PanelCell, start: float, end: float, foot: float) -> None:
    for line in reversed(cell.remarks):
        sheet.add(Words(end, foot - 4, line, SMALL, LINES, "end"), 7)
        foot -= LINE
    foot += 0.0 if cell.apart or not cell.remarks else LINE
    for line in reversed(cell.titles):
        sheet.add(Words(start, foot - 4, line, NORMAL, INK), 7)
        foot -= LINE


def _name_of(axis: Axis, room: float) -> tuple[str, ...]:
    """Lines of the name of an axis, whose unit stays whole."""
    return _tied_lines(axis.text, axis.unit_name, room, NORMAL)


def _tied_lines(text: str, unit: str, room: float, size: float) -> tuple[str, ...]:
    """Lines of a text, with its numbers and their unit on one."""
    tied = unit.replace(" ", TIED)
    whole = (
        re.sub(rf"(?<=\d) (?={re.escape(tied)})", TIED, text.replace(unit, tied)) if unit else text
    )
    return tuple(line.replace(TIED, " ") for line in lines_of(whole, room, size))


def _name_axes(sheet: Canvas, cell: PanelCell, view: View, left: float) -> None:
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
