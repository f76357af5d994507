"""A panel with its place on a sheet: its scales, the numbers beside them, what draws in it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cached_property
from math import ceil, floor, log10
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.sheet import (
    HALF_PAGE,
    MIDDLE,
    Anchor,
    Box,
    Canvas,
    CanvasStroke,
    Labels,
    Words,
    width_of,
)
from equipoise.figures.style import INK, SMALL, DrawingStyle
from equipoise.quantities import typeset
from equipoise.results.charts import Axis, Panel
from equipoise.signals import Array

Ticks = list[tuple[float, str]]

TURN = (15, 30, 45, 60, 90, 180, 360, 720, 1440, 3600)
"""Degrees between crank angles that are numbered."""
UP, SIDE_GAP, NARROW = 22.0, 12.0, 4.0
"""Points between numbers above each other; free between those side by side, and at least."""
NEAREST = 11.0
"""Points between the middles of two numbers at least."""
FEWEST, MOST = 3, 40
"""Numbers on an axis."""
ROUND, ROUNDISH = (1, 2, 2.5, 5), (1, 1.5, 2, 2.5, 3, 4, 5, 6, 8)
"""First digits of the distances of numbers; and where these leave fewer than three."""
MANTISSAS = ((1,), (1, 3), (1, 2, 5), (1, 1.5, 2, 3, 4, 5, 6, 8))
"""First digits of the numbers on a log axis, from the fewest."""
DECADES = 6.0
"""Of a log axis at most."""


@dataclass(frozen=True)
class AxisScale:
    """An axis between two places.

    low, high : ends in the unit of the axis.  start, end : points, where these are.
    """

    axis: Axis
    low: float
    high: float
    start: float
    end: float

    def at(self, values: Any) -> Any:
        """Points of values in SI units."""
        return self.of(np.asarray(values, float) * self.axis.unit.factor)

    def of(self, values: Any) -> Any:
        """Points of values in the unit of the axis."""
        low, high = self.low, self.high
        if self.axis.scale == "log":
            with np.errstate(divide="ignore", invalid="ignore"):
                values = np.log10(np.maximum(values, low * 1e-9))
            low, high = log10(low), log10(high)
        return self.start + (values - low) / (high - low) * (self.end - self.start)

    @property
    def length(self) -> float:
        """Points."""
        return abs(self.end - self.start)


def ends_of(axis: Axis, values: Iterable[Any]) -> tuple[float, float]:
    """Ends of an axis in its unit, that hold values (SI) with room beyond where none are given."""
    factor = axis.unit.factor
    low, high = (None if end is None else factor * end for end in (axis.low, axis.high))
    if low is None or high is None:
        parts = [np.ravel(np.asarray(part, float)) for part in values]
        every = factor * (np.concatenate(parts) if parts else np.zeros(1))
        every = every[np.isfinite(every)]
        if axis.scale == "log":
            return _log_ends(every, low, high)
        pair = (float(np.min(every)), float(np.max(every))) if every.size else (0.0, 1.0)
        least, most = low if low is not None else pair[0], high if high is not None else pair[1]
        size = max(abs(least), abs(most))
        if most - least <= 1e-9 * size or not size:
            half = size / 2 or 1.0
            least, most = least - half * (low is None), most + half * (high is None)
        room = axis.room * (most - least)
        low = least - room if low is None else low
        high = most + room if high is None else high
    return (low, high) if high != low else (low - 1, low + 1)


def _log_ends(values: Array, low: float | None, high: float | None) -> tuple[float, float]:
    above = values[values > 0]
    most = (float(np.max(above)) if above.size else 1.0) if high is None else high
    least = (float(np.min(above)) if above.size else most / 10) if low is None else low
    least = max(least, most * 10**-DECADES)
    return (least, most) if most > least else (least / 3, most * 3)


def round_below(value: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is no larger than a value above 0."""
    power = 10.0 ** floor(log10(value))
    return max(digit * power for digit in (1, 2, 5) if digit * power <= value)


def round_above(value: float) -> float:
    """The least of 1, 2 and 5 times a power of ten that is no less than a value above 0."""
    power = 10.0 ** floor(log10(value))
    return next(digit * power for digit in (1, 2, 5, 10) if digit * power >= value)


def ticks_of(scale: AxisScale, upright: bool = False) -> Ticks:
    """Places in the unit of the axis, and numbers there: at least three where there is room."""
    axis = scale.axis
    if axis.ticks is not None:
        slack = 1e-6 * abs(scale.high - scale.low)
        low, high = sorted((scale.low, scale.high))
        pairs = [(place * axis.unit.factor, text) for place, text in axis.ticks]
        inside = [pair for pair in pairs if low - slack <= pair[0] <= high + slack]
        return inside if upright else _apart(scale, inside)
    return (_log_ticks if axis.scale == "log" else _round_ticks)(scale, upright)


TOUCHING, ASIDE = 3.0, 6.0
"""Points between words below an axis at least; by how many the first may be moved aside for that,
as the mean before many orders."""


def _apart(scale: AxisScale, ticks: Ticks) -> Ticks:
    """Those of words side by side that do not touch, where the first may be moved aside."""
    clear: Ticks = []
    end = -np.inf
    for place, text in ticks:
        half = width_of(text, SMALL) / 2
        x = float(scale.of(place))
        if x - half > end + TOUCHING:
            end = x + half - (0.0 if clear else ASIDE)
            clear.append((place, text))
    return clear


def aside(scale: AxisScale, ticks: Ticks) -> Iterator[float]:
    """By how many points each text below an axis is moved to its beginning: the first off the next,
    which is a shorter one.
    """
    if len(ticks) > 1:
        (first, text), (second, following) = ticks[:2]
        half = (width_of(text, SMALL) + width_of(following, SMALL)) / 2
        gap = float(scale.of(second) - scale.of(first)) - half
        yield min(max(TOUCHING - gap, 0.0), ASIDE)
    yield from (0.0 for _ in ticks[len(ticks) > 1 :])


def steps_of(scale: AxisScale, digits: tuple[float, ...]) -> Iterator[float]:
    """Round distances of numbers, from small to large."""
    span = scale.high - scale.low
    if scale.axis.scale == "crank" and span >= 90:
        yield from (step for step in TURN if step <= span)
        return
    power = 10.0 ** floor(log10(span / 20))
    while power < 10 * span:
        yield from (digit * power for digit in digits)
        power *= 10


def _round_ticks(scale: AxisScale, upright: bool) -> Ticks:
    """Numbers as near to each other as they have room, but not fewer than three."""
    fewer: Ticks = []
    for digits, free in ((ROUND, SIDE_GAP), (ROUNDISH, NARROW)):
        for step in steps_of(scale, digits):
            first, last = ceil(scale.low / step - 1e-6), floor(scale.high / step + 1e-6)
            if last - first > MOST or step / (scale.high - scale.low) * scale.length < NEAREST:
                continue
            ticks = [(k * step, _written(k * step, step)) for k in range(first, last + 1)]
            if _fits(scale, ticks, upright, free):
                if len(ticks) >= FEWEST:
                    return ticks
                fewer = max(fewer, ticks, key=len)
                break
    return fewer


def _fits(scale: AxisScale, ticks: Ticks, upright: bool, free: float) -> bool:
    if len(ticks) < 2:
        return True
    gap = abs(float(scale.of(ticks[1][0]) - scale.of(ticks[0][0])))
    if upright:
        return gap >= (UP if free == SIDE_GAP else SMALL + NARROW)
    return gap >= max(width_of(text, SMALL) for _, text in ticks) + free


def _written(value: float, step: float) -> str:
    digits = max(0, -floor(log10(step) + 1e-9))
    if abs(step * 10**digits - round(step * 10**digits)) > 1e-6:
        digits += 1
    if digits > 5 or abs(value) >= 1e7:
        return typeset(f"{value:g}")
    return typeset(f"{value + 0.0:.{digits}f}") if value else "0"


def _log_ticks(scale: AxisScale, upright: bool) -> Ticks:
    """Plain numbers, as few digits as give three of them; round ones where there are no decades."""
    powers = range(floor(log10(scale.low)), ceil(log10(scale.high)) + 1)
    result: Ticks = []
    for digits in MANTISSAS:
        places = sorted(digit * 10.0**power for power in powers for digit in digits)
        inside = [p for p in places if 0.999 * scale.low <= p <= 1.001 * scale.high]
        ticks = [(p, typeset(f"{p:.4g}")) for p in inside]
        if result and len(result) >= FEWEST and not _log_fits(scale, ticks, upright):
            return result
        result = ticks
    return result if len(result) >= FEWEST else _round_ticks(scale, upright)


def _log_fits(scale: AxisScale, ticks: Ticks, upright: bool) -> bool:
    gaps = np.abs(np.diff([float(scale.of(place)) for place, _ in ticks]))
    least = 0.7 * UP
    if not upright:
        least = max(width_of(text, SMALL) for _, text in ticks) + SIDE_GAP / 2
    return bool(np.all(gaps >= least))


@dataclass(frozen=True, eq=False)
class View:
    """A panel with its place on a sheet."""

    panel: Panel
    x: AxisScale
    y: AxisScale
    sheet: Canvas

    @property
    def box(self) -> Box:
        """Left, top, right, bottom of the axes."""
        return self.x.start, self.y.end, self.x.end, self.y.start

    @cached_property
    def labels(self) -> Labels:
        """Texts inside of them."""
        return Labels(self.sheet, self.box, sparse=self.sheet.width < HALF_PAGE)

    @cached_property
    def ticks(self) -> tuple[Ticks, Ticks]:
        """Numbers on both axes."""
        return ticks_of(self.x), ticks_of(self.y, upright=True)

    def places(self, x: Any, y: Any) -> Array:
        """Places (N, 2) on the sheet of values in SI units."""
        return np.column_stack(np.broadcast_arrays(self.x.at(x), self.y.at(y)))

    def line(self, places: Array, look: DrawingStyle, order: float | None = None) -> None:
        """A line (N, 2) on the sheet, not clipped."""
        stroke = CanvasStroke((places,), look.color, look.width, look.lengths)
        self.sheet.add(stroke, look.order if order is None else order)

    def area(self, look: DrawingStyle, *places: Array) -> None:
        """Filled areas, each (N, 2), cut at the axes."""
        color = look.inside
        stroke = CanvasStroke(places, fill=color, opacity=look.opacity, closed=True, clip=self.box)
        self.sheet.add(stroke, look.order)

    def write(self, x: float, y: float, text: str, anchor: Anchor = "start", **rest: Any) -> None:
        """A text that stands where it must; y is the middle of its height."""
        size = rest.pop("size", SMALL)
        words = Words(x, y + MIDDLE * size, text, size, rest.pop("color", INK), anchor, **rest)
        self.sheet.add(words, 7.0)


def corners_of(box: Box) -> Array:
    """The corners (4, 2) of a box."""
    left, top, right, bottom = box
    return np.array([(left, top), (right, top), (right, bottom), (left, bottom)])
