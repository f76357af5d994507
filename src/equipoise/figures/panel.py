"""What stands in and around one pair of axes: grid, shades, contours, lines, words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import ceil, floor, log10
from typing import Any

import numpy as np

from equipoise.figures.curves import (
    draw_area,
    draw_arrow,
    draw_bars,
    draw_cells,
    draw_curve,
    draw_machine,
    draw_rule,
    signs_at,
    thinned,
)
from equipoise.figures.sheet import MIDDLE, CanvasStroke, CanvasText, Words, spread, width_of
from equipoise.figures.style import (
    FAINT,
    GRID,
    INK,
    KINDS,
    LINES,
    NORMAL,
    PALE,
    SMALL,
    DrawingStyle,
    look_of,
    mixed,
)
from equipoise.figures.view import View, aside, corners_of, round_above
from equipoise.i18n import decimals
from equipoise.results.charts import Bars, Mark, Outline, Panel, Surface
from equipoise.signals import Array

LEVELS = 12
"""Lines at most."""
STEEP = 90
"""Percentile of the values up to which there are lines: beside dead points they rise endlessly."""
DARK = "#cfe0ef"
"""Low is dark, in grey too; never so dark that a line or a label would be lost."""
FINE = 240
"""Steps along an axis, between which lines of equal value are straight."""
APART = 5.0
"""Points between the lines that fill what has no values."""


def draw_surface(view: View, surface: Surface) -> None:
    """Lines, their values, and shades between them."""
    from contourpy import contour_generator

    left, top, right, bottom = view.box
    if surface.lacking:
        view.sheet.add(CanvasStroke((corners_of(view.box),), fill="#f2f2f2", closed=True), 0.1)
        reach = bottom - top
        slants = tuple(
            np.array([(x, bottom), (x + reach, top)])
            for x in np.arange(left - reach, right, APART).tolist()
        )
        view.sheet.add(CanvasStroke(slants, FAINT, 0.5, clip=view.box), 0.2)
    values = surface.axis.unit.factor * surface.values
    levels = levels_of(values)
    if not len(levels):
        return  # the same everywhere: there is no line to draw
    x, y, smooth = finer(surface.x, surface.y, values)
    places = (view.x.at(x), view.y.at(y))
    generator = contour_generator(*places, np.ma.masked_invalid(smooth), fill_type="OuterOffset")
    ends = [min(float(np.nanmin(smooth)), levels[0]) - 1e-300, *levels]
    for number, (low, high) in enumerate(zip(ends, [*ends[1:], np.inf], strict=True)):
        share = number / max(len(ends) - 2, 1)
        color = mixed(DARK, 1.0 - min(share, 1.0))
        columns: Any = generator.filled(
            low, high
        )  # points, and where the lines in them begin and end
        for points, parts in zip(*columns, strict=True):
            lines = tuple(thinned(points[a:b]) for a, b in pairwise(parts.tolist()))
            view.sheet.add(
                CanvasStroke(lines, color, 0.3, fill=color, closed=True, clip=view.box), 1.0
            )
    text = []
    for level in levels:
        every: Any = generator.lines(level)
        lines = tuple(line for line in map(thinned, every) if len(line) > 1)
        if lines:
            view.sheet.add(CanvasStroke(lines, INK, 0.8, clip=view.box), 2.0)
            text.append((level, max(lines, key=_length)))
        for line in lines:
            view.labels.avoid(line)
    for level, line in text:
        _label_line(view, surface.axis.format_value(level / surface.axis.unit.factor), line)


def finer(x: Array, y: Array, values: Array) -> tuple[Array, Array, Array]:
    """Places (K,) and (J,) and values (J, K) that are closer together, so that lines bend smoothly.

    They go through all that is given, by cubic polynomials along x and then along y whose slopes
    follow from their neighbours (Akima 1970, as modified in SciPy), so that a crease, as of a peak,
    does not make them swing.  Where a value is lacking, those up to the next ones are.
    """
    across, wider = _finer(x, values)
    along, both = _finer(y, wider.T)
    return across, along, both.T


def _finer(places: Array, rows: Array) -> tuple[Array, Array]:
    """Finer places and interpolated rows (J, K) over places (K,)."""
    from scipy.interpolate import Akima1DInterpolator

    steps = -(-FINE // (len(places) - 1))
    if steps < 2:
        return places, rows
    shares = np.arange(steps * (len(places) - 1) + 1) / steps
    between = np.interp(shares, np.arange(len(places)), places)
    values = np.full((len(rows), len(between)), np.nan)
    there = np.isfinite(rows)
    for mask in np.unique(there, axis=0):  # rows that lack the same are drawn together
        own = np.all(there == mask, axis=1)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int)))
        for first, last in edges.reshape(-1, 2).tolist():
            part = np.s_[steps * first : steps * (last - 1) + 1]
            known = rows[own, first:last]
            if last - first > 1:
                curve = Akima1DInterpolator(places[first:last], known, axis=1, method="makima")
                known = curve(between[part])
            values[own, part] = known
    return between, values


def levels_of(values: Array) -> list[float]:
    """Round values at which there are lines."""
    low, high = float(np.nanmin(values)), float(np.nanpercentile(values, STEEP))
    high = high if high > low else float(np.nanmax(values))
    if not high > low:
        return []
    power = 10.0 ** np.floor(np.log10((high - low) / LEVELS))
    step = next(k * power for k in (1, 2, 2.5, 5, 10, 20) if (high - low) / (k * power) <= LEVELS)
    value = step * np.arange(np.floor(low / step) + 1, np.ceil(high / step) + 1)
    return [float(level) for level in value if low < level < np.nanmax(values)]


def _length(line: Array) -> float:
    return float(np.sum(np.hypot(*np.diff(line, axis=0).T)))


def _label_line(view: View, text: str, line: Array) -> None:
    """Label a contour line (N, 2) with its value, at the sample farthest from the axes' edges."""
    wide = width_of(text, SMALL)
    left, top, right, bottom = view.box
    if _length(line) < 2 * wide:
        return
    inside = np.minimum.reduce(
        [line[:, 0] - left - wide, right - wide - line[:, 0], line[:, 1] - top, bottom - line[:, 1]]
    )
    for boxed in np.argsort(-np.minimum(inside, 20.0 + 1e-3 * inside))[:: max(len(line) // 40, 1)]:
        x, y = line[boxed]
        box = np.array([x - wide / 2, y - 5, x + wide / 2, y + 5])
        clear = view.labels.boxes
        apart = np.any((clear[:, :2] >= box[2:]) | (clear[:, 2:] <= box[:2]), axis=1)
        if inside[boxed] > 4 and np.all(apart):
            words = Words(x, y + 0.27 * SMALL, text, SMALL, INK, "middle", backed=True)
            view.sheet.add(words, 7.0)
            view.labels.occupy((box[0], box[1], box[2], box[3]))
            return


BarNumber = tuple[str, float, float, str]
"""At a bar: text, place on the sheet, colour."""
RINGS = 4
"""Circles of a polar diagram at most, out to its farthest corner."""


def draw(view: View) -> None:
    """Everything in a panel but its axes' numbers and what stands above."""
    panel = view.panel
    if not panel.bare:
        _grid(view)
    left, top, right, bottom = view.box
    for band in panel.bands:
        if band.axis == "y":
            low, high = view.y.at([band.low, band.high])
            box = (left, high, right, low)
        else:
            low, high = view.x.at([band.low, band.high])
            box = (low, top, high, bottom)
        view.area(look_of(band.role), corners_of(box))
    if panel.surface is not None:
        draw_surface(view, panel.surface)
    behind: list[tuple[Any, Sequence[Any]]] = [
        (draw_cells, panel.cells),
        (draw_area, panel.areas),
        (draw_rule, panel.rules),
    ]
    for draw_one, parts in behind:
        for part in parts:
            draw_one(view, part)
    for outline in panel.outlines:
        _outline(view, outline)
    draw_machine(view.sheet, view.labels, panel, view.places, view.box)
    for line in panel.lines:
        _level(view, line.at, look_of(line.role), line.axis)
    for bars in panel.bars:
        draw_bars(view, bars)
    numbers = {f"kind {number}": number for number in range(len(KINDS))}
    for curve in panel.curves:
        draw_curve(view, curve, numbers.get(curve.role, 0))
    for arrow in panel.arrows:
        draw_arrow(view, arrow.tail, arrow.head, look_of(arrow.role))
    write_words(view)


def _outline(view: View, outline: Outline) -> None:
    """An area with its holes, on which no text stands that has room elsewhere."""
    look = look_of(outline.role)
    lines = tuple(view.places(edge.real, edge.imag) for edge in (outline.places, *outline.holes))
    view.sheet.add(
        CanvasStroke(lines, look.color, look.width, (), look.fill, look.opacity, True, view.box),
        look.order,
    )
    for line in lines:
        view.labels.avoid(np.vstack([line, line[:1]]))
    view.labels.avoid_inside(lines)


# -- behind ----------------------------------------------------------------------------------------


def _grid(view: View) -> None:
    left, top, right, bottom = view.box
    panel = view.panel
    if panel.rings:
        _rings(view)
    elif panel.grid:
        across = [float(view.x.of(place)) for place, _ in view.ticks[0]]
        up = [float(view.y.of(place)) for place, _ in view.ticks[1]]
        if panel.bars:
            across, up = (across, []) if panel.bars[0].across == "y" else ([], up)
        lines = [np.array([(x, top), (x, bottom)]) for x in across]
        lines += [np.array([(left, y), (right, y)]) for y in up]
        if lines:
            view.sheet.add(CanvasStroke(tuple(lines), GRID, 0.6), 0.5)
    for scale, axis in ((view.y, "y"), (view.x, "x")):
        level = panel.zero and (axis == "y" or panel.equal)
        if level and scale.axis.scale == "linear" and scale.low < 0 < scale.high:
            _level(view, 0.0, look_of("zero"), axis)


def _rings(view: View) -> None:
    """Circles of round sizes about the origin."""
    x, y = view.x, view.y
    most = max(abs(complex(a, b)) for a in (x.low, x.high) for b in (y.low, y.high))
    step = round_above(most / RINGS)
    turn = np.radians(np.arange(0, 361, 3))
    lines = tuple(
        np.column_stack([x.of(k * step * np.cos(turn)), y.of(k * step * np.sin(turn))])
        for k in range(1, ceil(most / step) + 1)
    )
    view.sheet.add(CanvasStroke(lines, PALE, 0.6, clip=view.box), 0.5)


def _level(view: View, at: float, look: DrawingStyle, axis: str) -> None:
    """A line from end to end at a value of an axis, where that is in sight."""
    left, top, right, bottom = view.box
    if axis == "y":
        y = float(view.y.at(at))
        inside, ends = top - 0.1 <= y <= bottom + 0.1, [(left, y), (right, y)]
    else:
        x = float(view.x.at(at))
        inside, ends = left - 0.1 <= x <= right + 0.1, [(x, bottom), (x, top)]
    if inside:
        view.line(np.array(ends), look)


def frame(view: View, numbers: bool) -> None:
    """The box around the axes, its ticks and, along x where wanted, their numbers."""
    left, _, right, bottom = view.box
    panel = view.panel
    view.sheet.add(CanvasStroke((corners_of(view.box),), LINES, 0.7, closed=True), 5.0)
    lines = []
    for (place, text), off in zip(view.ticks[0], aside(view.x, view.ticks[0]), strict=True):
        x = float(view.x.of(place))
        lines.append(np.array([(x, bottom), (x, bottom + 3)]))
        if numbers:
            view.write(x - off, bottom + 9, text, "middle")
    for place, text in view.ticks[1]:
        y = float(view.y.of(place))
        lines.append(np.array([(left - 3, y), (left, y)]))
        view.write(left - 5, y, text, "end")
    if panel.right_axis is not None:
        for value, text in panel.right_axis.ticks or ():
            y = float(view.y.at(value))
            lines.append(np.array([(right, y), (right + 3, y)]))
            view.write(right + 5, y, text)
    if lines:
        view.sheet.add(CanvasStroke(tuple(lines), LINES, 0.7), 5.0)


ALIKE = (0.01, 0.004)
"""Shares of the axes nearer than which two signs with numbers, or two equal names, are one."""
VISIBLE = 0.004
"""Over the longest bar: shorter ones cannot be seen, and get no number."""
OVER, UNDER = -5.5, 6.5
"""Points from the end of a bar to the middle of its number: above it, or below one that goes down.
"""
MINUS = "\N{MINUS SIGN}"
MOST_DECIMALS = 4
"""Of numbers at bars; longer ones are left out."""
LEAD, ROW, STAND = 8.0, 9.6, 10.0
"""Points: line from the axes to words above or beside them; a row of these; an upright name."""
FARTHEST = 36.0
"""Points that words above the axes may be from their places before they are set upright."""


UPRIGHT, LEVEL = 1.5, 0.5
"""Weights of lines from end to end: of an upright one few pieces lie below a text, and they go
through its letters.
"""


def write_words(view: View) -> None:
    """Numbers of bars, marks with their texts, and words around the axes."""
    panel = view.panel
    for line in panel.lines:
        if line.axis == "x" and view.x.low <= line.at * view.x.axis.unit.factor <= view.x.high:
            x = float(view.x.at(line.at))
            view.labels.avoid(np.array([(x, view.y.start), (x, view.y.end)]), UPRIGHT)
        elif line.axis == "y":
            y = float(view.y.at(line.at))
            view.labels.avoid(np.array([(view.x.start, y), (view.x.end, y)]), LEVEL)
    _bar_numbers(view)
    _marks(view)
    if panel.message:
        left, top, right, bottom = view.box
        middle = (left + right) / 2, top + 0.4 * (bottom - top)
        view.write(*middle, panel.message, "middle", size=NORMAL, backed=True)
    _flags(view)
    _asides(view)


def dot_of(look: DrawingStyle) -> DrawingStyle:
    """What a single place of a curve looks like, on which signs that it has may stand already."""
    if look.sign and not look.spaced:
        return look
    hollow = look.hollow and not look.spaced
    return DrawingStyle(look.color, sign="o", size=4.0, hollow=hollow)


def _marks(view: View) -> None:
    apart: list[tuple[Mark, Array]] = []
    size = np.array([view.x.length, view.y.length])
    for mark in view.panel.marks:
        (place,) = view.places(mark.x, mark.y)
        same = [
            (item, at) for item, at in apart if item.text and (item.sign or item.text == mark.text)
        ]
        values = [at for item, at in same if mark.sign or item.text == mark.text]
        if mark.text and any(np.all(np.abs(place - at) < ALIKE * size) for at in values):
            continue
        apart.append((mark, place))
        look = look_of(mark.role)
        if mark.sign:
            signs = dot_of(look)
            view.sheet.add(signs_at(place[None], signs), max(look.order, 4.0))
            view.labels.reserve(float(place[0]), float(place[1]), max(signs.size / 2, 2.0))
    for mark, (x, y) in apart:
        if mark.text:
            ink = look_of(mark.role).ink
            text = CanvasText(mark.text, ink, mark.wish, mark.distance, mark.optional, mark.bold)
            view.labels.put(float(x) + mark.off.real, float(y) - mark.off.imag, text)


def _bar_numbers(view: View) -> None:
    """Sizes of bars that can be seen, at their ends, with as many decimals as all have room for.

    Numbers up to 100 keep a decimal, and those whose largest is below 1 two digits of that, however
    crowded they are: bars of 1.2 and 0.6 would both read 1.
    """
    matching_bars = [bars for bars in view.panel.bars if bars.labelled]
    if not matching_bars:
        return
    scale = view.y if matching_bars[0].across == "x" else view.x
    factor = scale.axis.unit.factor
    largest = factor * max(float(np.max(np.abs(bars.size), initial=0)) for bars in matching_bars)
    if not largest:
        return
    numbers = [
        (size, at, look_of(bars.role).ink)
        for bars in matching_bars
        for at, size in zip(bars.at.tolist(), (factor * bars.size).tolist(), strict=True)
        if abs(size) > VISIBLE * largest
    ]
    if scale is view.x:
        for size, at, _ in numbers:
            text = decimals(f"{size:.1f} {scale.axis.unit_name}")
            view.write(float(scale.of(size)) + 4, float(view.y.at(at)), text, color=INK)
        return
    most = max(0, 2 - floor(log10(largest)))
    if most > MOST_DECIMALS:
        return
    least = min(most, max(1, most - 1))
    spans = [span for bars in matching_bars for span in _spans(view, bars)]
    for fewer in range(most, least - 1, -1):
        texts = [
            (
                decimals(f"{size:.{fewer}f}".replace("-", MINUS)),
                float(view.x.at(at)),
                float(scale.of(size)) + (UNDER if size < 0 else OVER),
                color,
            )
            for size, at, color in numbers
            if round(size, fewer)
        ]
        clear = _clear(_off_bars(texts, spans, (view.x.start, view.x.end)))
        if len(clear) == len(texts):
            break
    for text, x, y, color in clear:
        view.write(x, y, text, "middle", color=color)


BarSpan = tuple[float, float, float, float]
"""Of a bar on the sheet: left, right, top and foot."""


def _spans(view: View, bars: Bars) -> Iterator[BarSpan]:
    """Where each bar is, of those that go down none of it."""
    half = np.broadcast_to(np.asarray(bars.width, float) / 2, bars.at.shape)
    ends = (view.x.at(bars.at - half), view.x.at(bars.at + half), view.y.at(bars.size))
    foot = float(view.y.at(0.0))
    for left, right, top in zip(*ends, strict=True):
        yield float(left), float(right), float(top), foot


def _off_bars(
    texts: list[BarNumber], spans: list[BarSpan], ends: tuple[float, float]
) -> list[BarNumber]:
    """Numbers that are moved to the side off higher bars beside their own, and into the axes; those
    without room for that are left out.

    ends : of the axes, points.
    """
    moved = []
    for text, x, y, color in texts:
        half = width_of(text, SMALL) / 2 + 1
        higher = [
            (left, right) for left, right, top, foot in spans if top < y - OVER / 2 < foot - OVER
        ]
        start = max((right for _, right in higher if right <= x), default=ends[0])
        end = min((left for left, _ in higher if left >= x), default=ends[1])
        if end - start >= 2 * half:
            moved.append((text, min(max(x, start + half), end - half), y, color))
    return moved


def _clear(texts: list[BarNumber]) -> list[BarNumber]:
    """Those that lie on no number of a higher bar."""
    clear: list[BarNumber] = []
    for item in sorted(texts, key=lambda number: number[2]):
        text, x, y, _ = item
        half = width_of(text, SMALL) / 2
        if all(
            abs(x - at) > half + width_of(other, SMALL) / 2 + 2 or abs(y - up) > SMALL + 1
            for other, at, up, _ in clear
        ):
            clear.append(item)
    return clear


def flag_height(panel: Panel, width: float) -> float:
    """Points that words above the axes take."""
    if not panel.flags:
        return 0.0
    if upright(panel, width):
        return LEAD + 4 + max(width_of(flag.texts[0], SMALL) for flag in panel.flags)
    return LEAD + 2 + ROW * max(len(flag.texts) for flag in panel.flags)


def upright(panel: Panel, width: float) -> bool:
    """Whether words above the axes, of one row each, are so many that they stand upright."""
    if not panel.flags or panel.flag_words or any(len(flag.texts) > 1 for flag in panel.flags):
        return False
    wide = [width_of(flag.texts[0], SMALL) + 7 for flag in panel.flags]
    ends = (panel.x.low or 0.0, panel.x.high or 1.0)
    places = [(flag.at - ends[0]) / (ends[1] - ends[0]) * width for flag in panel.flags]
    moved = spread(places, wide, -40.0, width + 6.0)
    return sum(wide) > width + 46 or bool(np.max(np.abs(moved - places)) > FARTHEST)


def _flags(view: View) -> None:
    """Words above the axes, each with a line down to its place."""
    panel = view.panel
    low, high = view.x.low - 1e-9, view.x.high * (1 + 1e-9)
    flags = [f for f in panel.flags if low <= f.at * view.x.axis.unit.factor <= high]
    turned = upright(panel, view.x.length)
    wide = [STAND if turned else max(width_of(text, SMALL) for text in f.texts) + 6 for f in flags]
    while flags and sum(wide) > view.x.length + (0 if panel.bare else 12):
        gone = min(range(len(flags)), key=lambda k: flags[k].weight)
        del flags[gone], wide[gone]
    if not flags:
        return
    top = view.y.end
    places = [float(view.x.at(flag.at)) for flag in flags]
    before, beyond = (0, 0) if panel.bare else (4 if panel.flag_words else 20, 8)
    moved = spread(places, wide, view.x.start - before, view.x.end + beyond)
    count = max(len(flag.texts) for flag in flags)
    for flag, place, x in zip(flags, places, moved.tolist(), strict=True):
        view.line(np.array([(place, top), (x, top - LEAD)]), look_of("zero"), 2.0)
        if turned:
            foot = x + MIDDLE * SMALL, top - LEAD - 2
            view.sheet.add(Words(*foot, flag.texts[0], SMALL, INK, turned=True), 7.0)
            continue
        for row, text in enumerate(flag.texts):
            view.write(x, top - LEAD - 1 - ROW * (count - row - 0.5), text, "middle")
    for row, text in enumerate(panel.flag_words):
        y = top - LEAD - 1 - ROW * (count - row - 0.5)
        view.write(view.x.start - 8, y, text, "end", color=LINES)


def _asides(view: View) -> None:
    """Words at the right of the axes, each with a line to its place; and beside both ends."""
    panel = view.panel
    left, top, right, bottom = view.box
    if panel.asides:
        places = [float(view.y.at(aside.at)) for aside in panel.asides]
        moved = spread(places, [ROW] * len(places), top - 4, bottom + 4)
        for aside, place, y in zip(panel.asides, places, moved.tolist(), strict=True):
            view.line(np.array([(right, place), (right + LEAD, y)]), look_of("zero"), 2.0)
            view.write(right + LEAD + 2, y, aside.text, color=look_of(aside.role).ink)
    for lines, x, anchor in ((panel.left, left - 8, "end"), (panel.right, right + 8, "start")):
        middle = (top + bottom) / 2
        for row, text in enumerate(lines):
            y = middle + 11.5 * (row - (len(lines) - 1) / 2)
            view.write(x, y, text, anchor, size=NORMAL)  # type: ignore[arg-type]
