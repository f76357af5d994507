"""What every picture keeps, read off its sheet, where each text has its measured place."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import combinations
from xml.etree import ElementTree

import numpy as np
import pytest

from equipoise.figures import is_wide, layout
from equipoise.figures.curves import DOT
from equipoise.figures.layout import lay_out
from equipoise.figures.panel import dot_of
from equipoise.figures.sheet import Canvas, CanvasStroke, Markers, SheetItem, Words, box_of
from equipoise.figures.style import PAPER, DrawingStyle, look_of
from equipoise.figures.vector import svg_of
from equipoise.figures.view import View
from equipoise.i18n import say
from equipoise.results.charts import DEGREES, Chart
from equipoise.symbols.shapes import Shape

Fault = tuple[str, str]
"""What is not kept, and where."""
NUMBERS = 3
"""On each axis at least."""
LOW_TEXT = 14.5
"""Points from a dot to the edge of the axes between which a small text fits."""
SLACK = 1.5
"""Points that a line may be off the axes, by its width."""
LIGHTER, WIDER = 15.0, 0.8
"""Lightness (CIE L*) and points by which lines in grey differ that differ in nothing else; a thin
one that lies on a wide one is not seen by its width."""


@dataclass(frozen=True, eq=False)
class Laid:
    """A chart on its sheet; panels : each with what is drawn in it."""

    chart: Chart
    sheet: Canvas
    panels: tuple[tuple[View, tuple[SheetItem, ...]], ...]

    @classmethod
    def of(cls, chart: Chart, wide: float = layout.WIDE, headed: bool = True) -> Laid:
        return cls.by(chart, lambda: lay_out(chart, wide, headed))

    @classmethod
    def on_telephone(cls, chart: Chart) -> Laid:
        """As telephones show a wide one."""
        return cls.by(chart, lambda: layout.on_telephone(chart))

    @classmethod
    def by(cls, chart: Chart, lay: Callable[[], Canvas]) -> Laid:
        actual: list[tuple[View, tuple[SheetItem, ...]]] = []
        draw = layout.draw

        def seen(view: View) -> None:
            before = {id(item) for item in view.sheet.items}
            draw(view)
            actual.append((view, tuple(i for i in view.sheet.items if id(i) not in before)))

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(layout, "draw", seen)
            sheet = lay()
        return cls(chart, sheet, tuple(actual))

    @classmethod
    def in_report(cls, chart: Chart) -> Laid:
        """As reports have it: without a heading, and most in half of the width."""
        return cls.of(chart, layout.WIDE if is_wide(chart) else layout.HALF, headed=False)

    @property
    def faults(self) -> list[Fault]:
        """All that is not kept."""
        checks = (
            texts_cut,
            texts_covered,
            axes,
            axes_in_words,
            runs_back,
            bars_afloat,
            numbers_on_bars,
            dots_whole,
            first_orders,
            extremes_without_room,
            signs_without_names,
            panels_left,
            supports_cut,
            machines_small,
            drawings_low,
            alike_in_grey,
        )
        return [fault for check in checks for fault in check(self)]


def views(chart: Chart) -> list[View]:
    """Panels with the scales that they are drawn on."""
    return [view for view, _ in Laid.of(chart).panels]


def check(chart: Chart) -> None:
    """A chart of any machine, whose names may be so long that they have to be shortened."""
    laid = Laid.of(chart)
    ElementTree.fromstring(svg_of(laid.sheet))
    faults = [fault for fault in laid.faults if fault[0] != "text shortened"]
    assert not faults, f"{chart.name}: {faults[:9]}"


# -- texts -----------------------------------------------------------------------------------------


def texts_cut(laid: Laid) -> Iterator[Fault]:
    """No text leaves the picture, and all of it is written."""
    sheet = laid.sheet
    for words in sheet.words:
        left, top, right, bottom = box_of(words)
        if left < 0 or top < 0 or right > sheet.width or bottom > sheet.height:
            yield "text cut", words.text
        if "…" in words.text:
            yield "text shortened", words.text


def texts_covered(laid: Laid) -> Iterator[Fault]:
    """No text lies on another."""
    texts = [words for words in laid.sheet.words if words.text]
    boxes = np.array([box_of(words) for words in texts]).reshape(-1, 4)
    ends, begins = boxes[:, 2:], boxes[:, :2]
    shared = np.minimum(ends[:, None], ends) - np.maximum(begins[:, None], begins)
    for first, other in np.argwhere(np.triu(np.all(shared > (1, 2), axis=2), 1)):
        yield "text covered", f"{texts[first].text!r} and {texts[other].text!r}"


# -- axes ------------------------------------------------------------------------------------------


def axes(laid: Laid) -> Iterator[Fault]:
    """Axes are named, with their units; on each that has a size are three numbers or more, of two
    axes of one scale on one of them.

    Places with names, such as bars of joints, have no numbers; nor has the size of a mode.
    """
    chart = laid.chart
    for view, _ in laid.panels:
        panel = view.panel
        if panel.bare:
            continue
        if not (panel.x.label or chart.name.startswith(("scatter", "joint-polars"))):
            yield "axis without a name", "x"
        if not (panel.y.label or panel.title or panel.y.ticks is not None or panel.rings):
            yield "axis without a name", "y"
        every = [[text for _, text in ticks if _is_number(text)] for ticks in view.ticks]
        scaled = panel.equal and max(map(len, every)) >= NUMBERS
        for axis, numbers in zip((panel.x, panel.y), every, strict=True):
            if len(numbers) < NUMBERS and (axis.ticks is None or numbers) and not scaled:
                yield "few numbers on an axis", f"{axis.text}: {numbers}"


def axes_in_words(laid: Laid) -> Iterator[Fault]:
    """Axes are named in words and not by names of the code, in units that suit what is drawn."""
    largest: dict[str, float] = {}
    for view, _ in laid.panels:
        for axis, scale in ((view.panel.x, view.x), (view.panel.y, view.y)):
            if re.search(r"(?<!\S)[a-z]+(_[a-z]+)+(?![^\s,;])", axis.label):
                yield "axis named as in the code", axis.label
            most = max(abs(scale.low), abs(scale.high))
            largest[axis.unit_name] = max(largest.get(axis.unit_name, 0.0), most)
    for unit, most in largest.items():
        if unit.startswith("k") and not unit.startswith("kg") and most < 1:
            yield "unit too large", f"{most:g} {unit}"


def runs_back(laid: Laid) -> Iterator[Fault]:
    """Over the crank angle lines go on from left to right."""
    for view, _ in laid.panels:
        for curve in view.panel.curves if view.panel.x.scale == "crank" else ():
            if np.any(np.diff(curve.x) < 0):
                yield "line that runs back", view.panel.y.text
            if view.panel.y.unit == DEGREES and np.any(np.abs(np.diff(curve.y)) > np.pi):
                yield "angle that leaps back", view.panel.title or view.panel.y.text


def bars_afloat(laid: Laid) -> Iterator[Fault]:
    """Bars and areas stand on 0, which a logarithmic axis does not have."""
    for view, items in laid.panels:
        panel = view.panel
        ups = {"x": panel.y, "y": panel.x}
        if any(ups[bars.across].scale == "log" for bars in panel.bars):
            filled = [item for item in items if isinstance(item, CanvasStroke) and item.fill]
            colors = {
                look_of(role).inside for bars in panel.bars for role in (bars.role, *bars.roles)
            }
            if any(item.fill in colors for item in filled):
                yield "bars on a logarithmic axis", _heading(view)
        lowest = view.y.low / panel.y.unit.factor * (1 + 1e-9)
        if panel.y.scale == "log" and any(np.any(area.low <= lowest) for area in panel.areas):
            yield "area on a logarithmic axis", _heading(view)


def numbers_on_bars(laid: Laid) -> Iterator[Fault]:
    """Sizes that stand at bars lie on no higher bar beside their own, nor on the axes."""
    for view, items in laid.panels:
        numbers = [item for item in items if isinstance(item, Words) and _is_number(item.text)]
        for bars in view.panel.bars:
            if bars.across != "x" or view.y.axis.scale == "log":
                continue
            for entry in numbers if bars.labelled else ():
                start, _, end, _ = box_of(entry)
                if view.box[1] < entry.y and not view.box[0] <= start < end <= view.box[2]:
                    yield "number on an axis", f"{entry.text} in {_heading(view)}"
            foot = float(view.y.at(0.0))
            ends = (view.x.at(bars.at + side * np.asarray(bars.width) / 2) for side in (-1, 1))
            tops = np.where(
                bars.size > 0, view.y.at(bars.size), np.inf
            )  # not of those that go down
            for left, right, top in zip(*ends, tops, strict=True):
                for entry in numbers:
                    start, up, end, bottom = box_of(entry)
                    beside = min(right, end) - max(left, start) > 1
                    reached = bottom - top > 2 * SLACK and foot > up
                    if beside and view.box[1] < entry.y and reached:
                        yield "number on a bar", f"{entry.text} in {_heading(view)}"


def extremes_without_room(laid: Laid) -> Iterator[Fault]:
    """Between an extreme and the end of its axis its number fits, however low the panel is."""
    for view, _ in laid.panels:
        panel, (_, top, _, bottom) = view.panel, view.box
        if panel.equal or panel.y.scale == "log" or panel.y.high is not None:
            continue
        for mark in panel.marks:
            y, up = float(view.y.at(mark.y)), mark.wish == 90.0
            beyond = y - top if up else bottom - y
            fixed = not up and panel.y.low is not None
            if mark.text and mark.wish in (90.0, -90.0) and beyond < LOW_TEXT and not fixed:
                yield "no room at an extreme", f"{mark.text} in {_heading(view)}"


def signs_without_names(laid: Laid) -> Iterator[Fault]:
    """The edge of a seedling tray, a bare line, is named in every picture that has it; blades of
    tools look alike.
    """
    named = any(say("tray") in words.text for words in laid.sheet.words)
    for view, _ in laid.panels:
        if not (named or view.panel.bare) and any(
            shape.role == "tray" for shape in view.panel.signs
        ):
            yield "sign without a name", "tray"


def dots_whole(laid: Laid) -> Iterator[Fault]:
    """Dots that stand for bars are cut by no axis and covered by no text."""
    for view, items in laid.panels if any(v.panel.bars for v, _ in laid.panels) else ():
        left, top, right, bottom = view.box
        for dots in (item for item in items if isinstance(item, Markers) and item.size == DOT):
            half = DOT / 2 - SLACK / 2
            for x, y in dots.places.tolist():
                if not (left + half < x < right - half and top + half < y < bottom - half):
                    yield "dot cut", _heading(view)
                for words in (item for item in items if isinstance(item, Words)):
                    start, up, end, down = box_of(words)
                    if start < x + half and end > x - half and up < y + half and down > y - half:
                        yield "text on a dot", f"{words.text} in {_heading(view)}"


def first_orders(laid: Laid) -> Iterator[Fault]:
    """The first places of an axis with words have theirs: the mean, and the order of the crank."""
    for view, _ in laid.panels:
        every = view.panel.x.ticks or ()
        if view.panel.bars and view.panel.bars[0].across == "x" and len(every) > 1:
            written = [text for _, text in view.ticks[0]]
            if [text for _, text in every[:2]] != written[:2]:
                yield "place without its word", every[1][1]


def _is_number(text: str) -> bool:
    try:
        float(text.replace("\N{MINUS SIGN}", "-").rstrip("°"))
    except ValueError:
        return False
    return True


# -- lines -----------------------------------------------------------------------------------------


def panels_left(laid: Laid) -> Iterator[Fault]:
    """Nothing that is drawn in axes leaves them, and no part of a drawing is lost at their edge.

    Words above or beside axes stand outside of them, with the lines that lead there.
    """
    for view, items in laid.panels:
        panel = view.panel
        if not (panel.flags or panel.asides):
            for item in items:
                if not isinstance(item, Words) and item.clip is None and _outside(view, item):
                    yield "drawn outside of its axes", _heading(view)
        whole = [*_drawn_whole(view)] if panel.equal else []
        if panel.bare:  # whose edges nobody sees
            strokes = (entry for entry in items if isinstance(entry, CanvasStroke) and entry.clip)
            whole += [line for stroke in strokes for line in stroke.lines]
        if any(_beyond(view, places) > SLACK for places in whole):
            yield "cut by its axes", _heading(view)


SMALLEST = 0.33
"""Share of the axes that a machine takes at least along one of them."""


def machines_small(laid: Laid) -> Iterator[Fault]:
    """A machine stays in sight among its centrodes, which may run far away."""
    for view, _ in laid.panels if laid.chart.name == "centrodes" else ():
        if view.panel.signs:
            x, y = (np.ptp(part) for part in _places(view, view.panel.signs).T)
            if max(x / view.x.length, y / view.y.length) < SMALLEST:
                yield "machine too small", _heading(view)


LOWEST_DRAWING = 72.0
"""Points of the shorter side of axes of one scale, where no others stand beside them."""


def drawings_low(laid: Laid) -> Iterator[Fault]:
    """Machines and paths are large enough for the words at them, also in half of a page."""
    alone = len({view.y.start for view, _ in laid.panels}) == len(laid.panels)
    for view, _ in laid.panels if alone else ():
        low = min(view.x.length, view.y.length) < LOWEST_DRAWING
        if view.panel.equal and not view.panel.bare and low:
            yield "drawing too low", f"{_heading(view)}: {view.y.length:.0f} points"


def supports_cut(laid: Laid) -> Iterator[Fault]:
    """Where a support goes on beyond a drawing, words say what is there."""
    note = say("Beyond the drawing: {items}", items="").strip()
    for view, _ in laid.panels:
        supports = [item for item in view.panel.ground if item.role.startswith("support")]
        noted = not supports or any(note in text for text in laid.chart.words)
        if not noted and _beyond(view, _places(view, supports)) > SLACK:
            yield "support cut without a note", _heading(view)


def _places(view: View, shapes: Iterable[Shape]) -> np.ndarray:
    """Places (N, 2) of shapes of a machine on the sheet, without the sizes of their signs."""
    every = np.concatenate([np.atleast_1d(shape.places) for shape in shapes])
    return view.places(every.real, every.imag)


def _drawn_whole(view: View) -> Iterator[np.ndarray]:
    """Places (N, 2) of what a drawing tells, but for the machine, whose support may be far."""
    for curve in view.panel.curves:
        yield view.places(curve.x, curve.y)
    for outline in view.panel.outlines:
        yield view.places(outline.places.real, outline.places.imag)


def _outside(view: View, item: SheetItem) -> bool:
    lines: Iterable[np.ndarray] = getattr(item, "lines", None) or [item.places]
    return _beyond(view, np.vstack([*lines])) > SLACK


def _beyond(view: View, places: np.ndarray) -> float:
    """Points by which places (N, 2) are off the axes."""
    left, top, right, bottom = view.box
    x, y = places[np.all(np.isfinite(places), axis=1)].T
    ends = (left - np.min(x, initial=left), np.max(x, initial=right) - right)
    return max(*ends, top - np.min(y, initial=top), np.max(y, initial=bottom) - bottom)


def _heading(view: View) -> str:
    return view.panel.title or view.panel.y.text


# -- grey ------------------------------------------------------------------------------------------


def alike_in_grey(laid: Laid) -> Iterator[Fault]:
    """Lines in one panel that mean different things differ without colour, too; so do bars, and the
    dots at places of lines with the same dashes.
    """
    for view, _ in laid.panels:
        lines = dict.fromkeys((curve.role, curve.dashed) for curve in view.panel.curves)
        dotted = {mark.role for mark in view.panel.marks if mark.sign}
        for first, other in combinations(lines, 2):
            a, b = look_of(*first), look_of(*other)
            if (a.dashes, a.sign) != (b.dashes, b.sign):
                continue
            thin, wide = sorted((a, b), key=lambda look: look.width)
            if wide.width - thin.width >= WIDER and wide.order >= thin.order:
                continue
            dots = [(dot.sign, lightness(dot.inside)) for dot in map(dot_of, (a, b))]
            alike = dots[0][0] == dots[1][0] and abs(dots[0][1] - dots[1][1]) < LIGHTER
            alike = alike and {first[0], other[0]} <= dotted
            if alike or abs(lightness(a.color) - lightness(b.color)) < LIGHTER:
                yield "alike in grey", f"{first[0]} and {other[0]}"
        for first, other in combinations(dict.fromkeys(bars.role for bars in view.panel.bars), 2):
            if abs(_shade(look_of(first)) - _shade(look_of(other))) < LIGHTER:
                yield "alike in grey", f"{first} and {other}"


def _shade(look: DrawingStyle) -> float:
    """Lightness of an area on paper."""
    return look.opacity * lightness(look.inside) + (1 - look.opacity) * lightness(PAPER)


def lightness(color: str) -> float:
    """CIE L* of a colour such as ``#0060a8``; 0 is black, 100 is white."""
    parts = np.array([int(color[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    luminance = float(linear @ (0.2126, 0.7152, 0.0722))
    return 116 * np.cbrt(luminance) - 16 if luminance > 216 / 24389 else luminance * 24389 / 27
