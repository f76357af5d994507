"""What panels hold and how long their axes are: of one unit side by side, they have one scale."""

from __future__ import annotations

from dataclasses import replace
from math import floor, log10
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.sheet import width_of
from equipoise.figures.style import NORMAL
from equipoise.figures.view import DECADES, ends_of
from equipoise.i18n import say
from equipoise.results.charts import Panel

if TYPE_CHECKING:
    from equipoise.figures.legend import LegendKey

LIKE, ALIGNED = 5.0, 1.3
"""From how much less than others a panel spans that is drawn larger than they are; over the longest
of some axes, how long all may be so that all have the same ends."""
SHALLOW = 0.5
"""Over the usual height, what a panel has at least that needs less than others on their scale."""
VARIES = 1e-9
"""Over the largest value: what varies by less is rounding."""


@dataclass(eq=False)
class Cell:
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
    beside: bool = False
    """Whether its legend stands on the line of its title."""
    titles: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()
    apart: bool = False
    """Lines of its title and of its remark; whether these begin below the last line of that."""
    y_label: tuple[str, ...] = ()
    x_label: tuple[str, ...] = ()


def cell_of(panel: Panel, height: float) -> Cell:
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
    places += [np.array(panel.held)] if panel.held is not None else []
    places += [np.zeros(1)] if panel.rings or (panel.equal and panel.zero) else []
    x += [place.real for place in places]
    y += [place.imag for place in places]
    if panel.surface is not None:
        x.append(panel.surface.x)
        y.append(panel.surface.y)
    ends = ends_of(panel.x, x), ends_of(panel.y, y)
    spans = [high - low for low, high in ends] if panel.equal else [ends[1][1] - ends[1][0]]
    varying = _vary(y) or (panel.equal and _vary(x)) or panel.y.low is not None
    return Cell(panel, *ends, height, max(spans) if varying and not panel.message else 0.0)


def _vary(parts: list[Any]) -> bool:
    """Whether values are not all the same."""
    every = np.concatenate([np.zeros(0), *(np.ravel(np.asarray(part, float)) for part in parts)])
    every = every[np.isfinite(every)]
    return bool(every.size and np.ptp(every) > VARIES * np.max(np.abs(every)))


# -- one scale -------------------------------------------------------------------------------------


def share(cells: list[Cell], columns: int) -> None:
    """One scale for panels of one unit over like axes; what that would flatten is drawn larger."""
    groups: dict[tuple[str, str, bool], list[Cell]] = {}
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


def _enlarged(cell: Cell, most: float) -> float:
    """How many times larger than others a panel is drawn, which it tells; others span `most`."""
    if not cell.span or most < LIKE * cell.span:
        return 1.0
    times = most / cell.span
    power = 10.0 ** floor(log10(times))
    larger = power * max(digit for digit in (1, 2, 5) if digit * power <= times)
    text = say("drawn {times} times as large", times=f"{larger:g}")
    remark = f"{cell.panel.remark}; {text}" if cell.panel.remark else text
    cell.panel = replace(cell.panel, remark=remark)
    return larger


def _align(cells: list[Cell], rate: float) -> float:
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


def _stretch(cell: Cell, columns: int) -> None:
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
        part = min(max((high - low) / cell.least_span, SHALLOW), 1.0)
    cell.height *= part
    cell.y_ends = (low, low + part * cell.least_span)


NUMBERS = 15.0
"""Points above the highest bar that its number takes."""


def make_room(cell: Cell, over: float) -> None:
    """Higher axes of the same scale, where numbers at bars or a word of their name need that.

    over : points by which a name may be longer than its axis.
    """
    panel, factor = cell.panel, cell.panel.y.unit.factor
    fixed = panel.y.ticks is not None or panel.y.high is not None or panel.y.scale == "log"
    if panel.equal or panel.bare or fixed:
        return
    low, high = cell.y_ends
    rate = (high - low) / cell.height
    matching_bars = [bars for bars in panel.bars if bars.told and bars.across == "x"]
    top = factor * max(
        (float(np.max(bars.size, initial=0.0)) for bars in matching_bars), default=0.0
    )
    above = max(NUMBERS - (high - top) / rate, 0.0) if matching_bars else 0.0
    longest = max((width_of(word, NORMAL) for word in panel.y.text.split()), default=0.0)
    extra = max(longest - over - cell.height - above, 0.0)
    below = 0.0 if panel.bars else extra / 2
    cell.height += above + extra
    cell.y_ends = (low - below * rate, high + (above + extra - below) * rate)
