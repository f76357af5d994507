"""What stands in one pair of axes: shades, lines, curves, bars, signs and their words."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil, floor, log10
from typing import Any

import numpy as np

from equipoise.figures.machine import draw_machine
from equipoise.figures.metrics import DOWN, UP, width_of
from equipoise.figures.scales import Scale, Ticks, ticks_of
from equipoise.figures.sheet import Anchor, Box, Sheet, Signs, Stroke, Words
from equipoise.figures.style import GRID, INK, LINES, NORMAL, PALE, SMALL, Look, look_of
from equipoise.figures.texts import Labels, Text, spread
from equipoise.results.charts import Area, Bars, Curve, Mark, Panel

Array = np.ndarray[Any, Any]

MARKERS = 7
"""Signs on a curve that has a few of them, beside those of the others."""
ALIKE = (0.01, 0.004)
"""Shares of the axes nearer than which two marks are one."""
VISIBLE = 0.004
"""Over the longest bar: shorter ones cannot be seen, and get no number."""
MOST_DECIMALS = 4
"""Of numbers at bars; longer ones are left out."""
RINGS = 4
"""Circles of a polar diagram at most, out to its farthest corner."""
LEAD, ROW, STAND = 8.0, 9.6, 10.0
"""Points: line from the axes to words above or beside them; a row of these; an upright name."""
FARTHEST = 36.0
"""Points that words above the axes may be from their places before they are set upright."""
MIDDLE = (UP - DOWN) / 2
"""Of a text's height, from its base line, over its size."""


@dataclass(frozen=True, eq=False)
class View:
    """A panel with its place on a sheet."""

    panel: Panel
    x: Scale
    y: Scale
    sheet: Sheet

    @property
    def box(self) -> Box:
        """Left, top, right, bottom of the axes."""
        return self.x.start, self.y.end, self.x.end, self.y.start

    @cached_property
    def labels(self) -> Labels:
        """Texts inside of them."""
        return Labels(self.sheet, self.box)

    @cached_property
    def ticks(self) -> tuple[Ticks, Ticks]:
        """Numbers on both axes."""
        return ticks_of(self.x), ticks_of(self.y, upright=True)

    def places(self, x: Any, y: Any) -> Array:
        """Places (N, 2) on the sheet of values in SI units."""
        return np.column_stack(np.broadcast_arrays(self.x.at(x), self.y.at(y)))

    def line(self, places: Array, look: Look, order: float | None = None) -> None:
        """A line (N, 2) on the sheet, not clipped."""
        dashes = tuple(max(look.width, 0.8) * dash for dash in look.dashes)
        stroke = Stroke((places,), look.color, look.width, dashes)
        self.sheet.add(stroke, look.order if order is None else order)

    def area(self, places: Array, look: Look, order: float | None = None) -> None:
        """A filled area (N, 2), cut at the axes."""
        stroke = Stroke((places,), fill=look.fill, opacity=look.opacity, closed=True, clip=self.box)
        self.sheet.add(stroke, look.order if order is None else order)

    def write(self, x: float, y: float, text: str, anchor: Anchor = "start", **rest: Any) -> None:
        """A text that stands where it must; y is the middle of its height."""
        size = rest.pop("size", SMALL)
        words = Words(x, y + MIDDLE * size, text, size, rest.pop("color", INK), anchor, **rest)
        self.sheet.add(words, 7.0)


def draw(view: View) -> None:
    """Everything in a panel but its axes' numbers and what stands above."""
    panel = view.panel
    if not panel.bare:
        _grid(view)
    for band in panel.bands:
        ends = np.array([band.low, band.high])
        across = view.y.at(ends) if band.axis == "y" else view.x.at(ends)
        left, top, right, bottom = view.box
        box = (left, across[1], right, across[0]) if band.axis == "y" else (*across, top, bottom)
        corners = _corners(box) if band.axis == "y" else _corners((box[0], top, box[1], bottom))
        view.area(corners, look_of(band.role))
    if panel.surface is not None:
        from equipoise.figures.surface import draw_surface

        draw_surface(view, panel.surface)
    for area in panel.areas:
        _area(view, area)
    for outline in panel.outlines:
        look = look_of(outline.role)
        lines = tuple(view.places(one.real, one.imag) for one in (outline.places, *outline.holes))
        view.sheet.add(
            Stroke(lines, look.color, look.width, (), look.fill, look.opacity, True, view.box),
            look.order,
        )
    draw_machine(view.sheet, view.labels, panel, view.places, view.box)
    for line in panel.lines:
        _level(view, line.at, look_of(line.role), line.axis)
    for bars in panel.bars:
        _bars(view, bars)
    numbers = {role: k for k, role in enumerate(f"kind {n}" for n in range(6))}
    for curve in panel.curves:
        _curve(view, curve, numbers.get(curve.role, 0))
    for arrow in panel.arrows:
        _arrow(view, arrow.tail, arrow.head, look_of(arrow.role))
    _words(view)


def _corners(box: Box) -> Array:
    left, top, right, bottom = box
    return np.array([(left, top), (right, top), (right, bottom), (left, bottom)])


# -- behind ----------------------------------------------------------------------------------------


def _grid(view: View) -> None:
    left, top, right, bottom = view.box
    panel = view.panel
    if panel.rings:
        _rings(view)
    elif panel.grid:
        across, up = (
            [float(s.of(p)) for p, _ in t] for s, t in zip(_both(view), view.ticks, strict=True)
        )
        if panel.bars:
            standing = panel.bars[0].across
            across, up = (across, []) if standing == "y" else ([], up)
        lines = [np.array([(x, top), (x, bottom)]) for x in across]
        lines += [np.array([(left, y), (right, y)]) for y in up]
        if lines:
            view.sheet.add(Stroke(tuple(lines), GRID, 0.6), 0.5)
    for scale, axis in ((view.y, "y"), (view.x, "x")):
        level = panel.zero and (axis == "y" or panel.equal)
        if level and scale.axis.scale == "linear" and scale.low < 0 < scale.high:
            _level(view, 0.0, look_of("zero"), axis)


def _both(view: View) -> tuple[Scale, Scale]:
    return view.x, view.y


def _rings(view: View) -> None:
    """Circles of round sizes about the origin."""
    corners = [
        abs(complex(x, y)) for x in (view.x.low, view.x.high) for y in (view.y.low, view.y.high)
    ]
    step = 10.0 ** floor(log10(max(corners) / RINGS))
    step *= next(by for by in (1, 2, 5, 10) if RINGS * by * step >= max(corners))
    turn = np.radians(np.arange(0, 361, 3))
    lines = tuple(
        np.column_stack([view.x.of(k * step * np.cos(turn)), view.y.of(k * step * np.sin(turn))])
        for k in range(1, ceil(max(corners) / step) + 1)
    )
    view.sheet.add(Stroke(lines, PALE, 0.6, clip=view.box), 0.5)


def _level(view: View, at: float, look: Look, axis: str) -> None:
    left, top, right, bottom = view.box
    if axis == "y":
        y = float(view.y.at(at))
        ends = [(left, y), (right, y)] if top - 0.1 <= y <= bottom + 0.1 else []
    else:
        x = float(view.x.at(at))
        ends = [(x, bottom), (x, top)] if left - 0.1 <= x <= right + 0.1 else []
    if ends:
        view.line(np.array(ends), look)


# -- curves and bars -------------------------------------------------------------------------------


def _curve(view: View, curve: Curve, number: int) -> None:
    look = look_of(curve.role, curve.dashed)
    x, y = curve.x, curve.y
    if curve.steps:
        x, y = np.repeat(x, 2)[1:], np.repeat(y, 2)[:-1]
    places = view.places(x, y)
    there = np.all(np.isfinite(places), axis=1)
    if look.width:
        edges = np.flatnonzero(np.diff(np.concatenate([[False], there, [False]]).astype(int)))
        parts = [thinned(places[a:b]) for a, b in edges.reshape(-1, 2)]
        longer = tuple(part for part in parts if len(part) > 1)
        dashes = tuple(max(look.width, 0.8) * dash for dash in look.dashes)
        if longer:
            view.sheet.add(
                Stroke(longer, look.color, look.width, dashes, clip=view.box), look.order
            )
        alone = [part[0] for part in parts if len(part) == 1]
        if alone:
            view.sheet.add(
                _signs(np.array(alone), Look(look.color, sign=".", size=2.5)), look.order
            )
    if look.sign:
        at = _spaced(places, number) if look.spaced else np.flatnonzero(there)
        clip = None if look.spaced else view.box
        if len(at):
            view.sheet.add(_signs(places[at], look, clip), look.order + 0.01)
    if not look.width and len(places) < 500:
        for place in places[there]:
            view.labels.reserve(*place, half=look.size / 2)
    else:
        inside = places[there & (places[:, 1] <= view.y.start + 1)]
        view.labels.avoid(inside, 0.6 if look.order < 3 else 1.0)


def thinned(places: Array) -> Array:
    """A line (N, 2) without the places in which it hardly turns."""
    kept = np.round(places, 1)
    new = np.concatenate([[True], np.any(np.diff(kept, axis=0) != 0, axis=1)])
    kept = kept[new]
    if len(kept) < 3:
        return kept
    before, after = np.diff(kept[:-1], axis=0), np.diff(kept[1:], axis=0)
    turned = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]) > 1e-9
    ahead = np.sum(before * after, axis=1) > 0
    return np.asarray(kept[np.concatenate([[True], turned | ~ahead, [True]])])


def _spaced(places: Array, number: int) -> Array:
    """Numbers of a few places, beside those of other curves, so that grey tells them apart."""
    x = places[:, 0]
    x = np.where(np.isfinite(x), x, -1e9)
    wanted = x[0] + (x[-1] - x[0]) * (np.arange(MARKERS) + (number + 0.5) / 6) / MARKERS
    nearest = np.unique(np.argmin(np.abs(x[:, None] - wanted), axis=0))
    return np.asarray(nearest[np.isfinite(places[nearest, 1])])


def _signs(places: Array, look: Look, clip: Box | None = None) -> Signs:
    face = look.fill or ("#ffffff" if look.hollow else look.color)
    return Signs(places, look.sign, look.size, look.color, face, max(look.width, 1.0), clip)


def _area(view: View, area: Area) -> None:
    low, high = view.places(area.x, area.low), view.places(area.x, area.high)
    view.area(np.concatenate([high, low[::-1]]), look_of(area.role))


def _bars(view: View, bars: Bars) -> None:
    half = np.broadcast_to(np.asarray(bars.width, float) / 2, bars.at.shape)
    ends = (bars.at - half, bars.at + half)
    lowest = (
        np.zeros_like(bars.size) if view_low(view, bars) <= 0 else np.full_like(bars.size, 1e-300)
    )
    by_role: dict[str, list[Array]] = {}
    for k, (start, stop, size) in enumerate(zip(*ends, bars.size, strict=True)):
        if not np.isfinite(size):
            continue
        if bars.across == "x":
            (left, right), (foot, top) = view.x.at([start, stop]), view.y.at([lowest[k], size])
            foot = min(foot, view.y.start)
        else:
            (foot, top), (left, right) = view.y.at([start, stop]), view.x.at([lowest[k], size])
            left = max(left, view.x.start)
        role = bars.roles[k] if bars.roles else bars.role
        by_role.setdefault(role, []).append(_corners((left, top, right, foot)))
    for role, corners in by_role.items():
        look = look_of(role)
        fill = look.fill or look.color
        item = Stroke(tuple(corners), fill=fill, opacity=look.opacity, closed=True, clip=view.box)
        view.sheet.add(item, look.order)


def view_low(view: View, bars: Bars) -> float:
    """Where the axis begins along which bars grow."""
    return view.y.low if bars.across == "x" else view.x.low


def _arrow(view: View, tail: complex, head: complex, look: Look) -> None:
    (start,), (end,) = (view.places(z.real, z.imag) for z in (tail, head))
    way = end - start
    size = float(np.hypot(*way))
    if not size:
        return
    length = min(max(4.0 + 2.2 * look.width, 5.5), size)
    along = way / size
    foot, beside = end - length * along, 0.4 * length * np.array([-along[1], along[0]])
    if look.width and size > length:
        view.sheet.add(
            Stroke((np.array([start, foot + 0.3 * length * along]),), look.color, look.width), 3.5
        )
    head_of = np.array([end, foot + beside, foot - beside])
    view.sheet.add(Stroke((head_of,), fill=look.color, closed=True), 3.6)
    view.labels.avoid(np.array([start, end]))


# -- words -----------------------------------------------------------------------------------------


def _words(view: View) -> None:
    """Numbers of bars, marks with their texts, and words around the axes."""
    panel = view.panel
    for line in panel.lines:
        if line.axis == "x" and view.x.low <= line.at * view.x.axis.unit.factor <= view.x.high:
            x = float(view.x.at(line.at))
            view.labels.avoid(np.array([(x, view.y.start), (x, view.y.end)]), 0.5)
        elif line.axis == "y":
            y = float(view.y.at(line.at))
            view.labels.avoid(np.array([(view.x.start, y), (view.x.end, y)]), 0.5)
    _bar_numbers(view)
    _marks(view)
    if panel.message:
        left, top, right, bottom = view.box
        view.write(
            (left + right) / 2,
            top + 0.4 * (bottom - top),
            panel.message,
            "middle",
            size=NORMAL,
            backed=True,
        )
    _flags(view)
    _asides(view)


def _marks(view: View) -> None:
    apart: list[tuple[Mark, Array]] = []
    size = np.array([view.x.length, view.y.length])
    for mark in view.panel.marks:
        (place,) = view.places(mark.x, mark.y)
        near = (
            bool(np.all(np.abs(place - other) < ALIKE * size)) and one.text for one, other in apart
        )
        if mark.text and any(near):
            continue
        apart.append((mark, place))
        look = look_of(mark.role)
        if mark.sign:
            signs = look if look.sign and not look.spaced else Look(look.color, sign="o", size=4.0)
            view.sheet.add(_signs(place[None], signs), max(look.order, 4.0))
            view.labels.reserve(*place, half=max(signs.size / 2, 2.0))
    for mark, (x, y) in apart:
        if mark.text:
            text = Text(
                mark.text, look_of(mark.role).ink, mark.wish, mark.near, mark.optional, mark.bold
            )
            view.labels.put(float(x), float(y), text)


def _bar_numbers(view: View) -> None:
    """Sizes of bars that can be seen, at their ends, with as many digits as all have room for."""
    told = [bars for bars in view.panel.bars if bars.told]
    if not told:
        return
    scale = view.y if told[0].across == "x" else view.x
    factor = scale.axis.unit.factor
    largest = factor * max(float(np.max(bars.size, initial=0.0)) for bars in told)
    if not largest:
        return
    seen = []
    for bars in told:
        color = look_of(bars.role).ink
        for at, size in zip(bars.at.tolist(), (factor * bars.size).tolist(), strict=True):
            if size > VISIBLE * largest:
                seen.append((size, at, color))
    if scale is view.x:
        for size, at, _ in seen:
            view.write(
                float(scale.of(size)) + 4,
                float(view.y.at(at)),
                f"{size:.1f} {scale.axis.unit_name}",
                color=INK,
            )
        return
    decimals = max(0, 2 - floor(log10(largest)))
    if decimals > MOST_DECIMALS:
        return
    for fewer in range(decimals, -1, -1):
        texts = [
            (f"{size:.{fewer}f}", float(view.x.at(at)), float(scale.of(size)), color)
            for size, at, color in seen
            if round(size, fewer)
        ]
        clear = _clear(texts)
        if len(clear) == len(texts) or not fewer or largest * 10 ** (fewer - 1) < 10:
            break
    for text, x, y, color in clear:
        view.write(x, y - 5.5, text, "middle", color=color)


def _clear(texts: list[tuple[str, float, float, str]]) -> list[tuple[str, float, float, str]]:
    """Those that lie on no number of a higher bar."""
    clear: list[tuple[str, float, float, str]] = []
    for text in sorted(texts, key=lambda one: one[2]):
        half = width_of(text[0], SMALL) / 2
        if all(
            abs(text[1] - other[1]) > half + width_of(other[0], SMALL) / 2 + 2
            or abs(text[2] - other[2]) > SMALL + 1
            for other in clear
        ):
            clear.append(text)
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
    flags = [
        f
        for f in panel.flags
        if view.x.low - 1e-9 <= f.at * view.x.axis.unit.factor <= view.x.high * (1 + 1e-9)
    ]
    turned = upright(panel, view.x.length)
    wide = [STAND if turned else max(width_of(text, SMALL) for text in f.texts) + 6 for f in flags]
    while flags and sum(wide) > view.x.length + 12:
        gone = min(range(len(flags)), key=lambda k: flags[k].weight)
        del flags[gone], wide[gone]
    if not flags:
        return
    top = view.y.end
    places = [float(view.x.at(flag.at)) for flag in flags]
    moved = spread(places, wide, view.x.start - (4 if panel.flag_words else 20), view.x.end + 8)
    count = max(len(flag.texts) for flag in flags)
    for flag, place, x in zip(flags, places, moved.tolist(), strict=True):
        view.line(np.array([(place, top), (x, top - LEAD)]), look_of("zero"), 2.0)
        for row, text in enumerate(flag.texts):
            if turned:
                words = Words(x + MIDDLE * SMALL, top - LEAD - 2, text, SMALL, INK, turned=True)
                view.sheet.add(words, 7.0)
            else:
                view.write(x, top - LEAD - 1 - ROW * (count - row - 0.5), text, "middle")
    for row, text in enumerate(panel.flag_words):
        view.write(
            view.x.start - 8, top - LEAD - 1 - ROW * (count - row - 0.5), text, "end", color=LINES
        )


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


def frame(view: View, numbers: bool) -> None:
    """The box around the axes, its ticks and, along x where wanted, their numbers."""
    left, _, right, bottom = view.box
    panel = view.panel
    view.sheet.add(Stroke((_corners(view.box),), LINES, 0.7, closed=True), 5.0)
    lines, (across, up) = [], view.ticks
    for place, text in across:
        x = float(view.x.of(place))
        lines.append(np.array([(x, bottom), (x, bottom + 3)]))
        if numbers:
            view.write(x, bottom + 9, text, "middle")
    for place, text in up:
        y = float(view.y.of(place))
        lines.append(np.array([(left - 3, y), (left, y)]))
        view.write(left - 5, y, text, "end")
    if panel.right_axis is not None:
        for value, text in panel.right_axis.ticks or ():
            y = float(view.y.at(value))
            lines.append(np.array([(right, y), (right + 3, y)]))
            view.write(right + 5, y, text)
    if lines:
        view.sheet.add(Stroke(tuple(lines), LINES, 0.7), 5.0)
