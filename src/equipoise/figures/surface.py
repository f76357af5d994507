"""Values over two numbers: lines of equal value with what they are, and shades between them."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.metrics import width_of
from equipoise.figures.sheet import Stroke, Words
from equipoise.figures.style import FAINT, INK, SMALL

if TYPE_CHECKING:
    from equipoise.figures.panel import View
    from equipoise.results.charts import Surface

Array = np.ndarray[Any, Any]

LEVELS = 12
"""Lines at most."""
STEEP = 90
"""Percentile of the values up to which there are lines: beside dead points they rise endlessly."""
DARK, LIGHT = np.array([0xCF, 0xE0, 0xEF]), np.array([0xFF, 0xFF, 0xFF])
"""Low is dark, in grey too; never so dark that a line or a label would be lost."""
APART = 5.0
"""Points between the lines that fill what has no values."""


def draw_surface(view: View, surface: Surface) -> None:
    """Lines, their values, and shades between them."""
    from contourpy import contour_generator

    left, top, right, bottom = view.box
    if surface.lacking:
        corners = np.array([(left, top), (right, top), (right, bottom), (left, bottom)])
        view.sheet.add(Stroke((corners,), fill="#f2f2f2", closed=True), 0.1)
        reach = bottom - top
        slants = tuple(
            np.array([(x, bottom), (x + reach, top)])
            for x in np.arange(left - reach, right, APART).tolist()
        )
        view.sheet.add(Stroke(slants, FAINT, 0.5, clip=view.box), 0.2)
    values = surface.axis.unit.factor * surface.values
    levels = levels_of(values)
    if not len(levels):
        return  # the same everywhere: there is no line to draw
    places = (view.x.at(surface.x), view.y.at(surface.y))
    drawn = contour_generator(*places, np.ma.masked_invalid(values))
    ends = [min(float(np.nanmin(values)), levels[0]) - 1e-300, *levels]
    for number, (low, high) in enumerate(zip(ends, [*ends[1:], np.inf], strict=True)):
        share = number / max(len(ends) - 2, 1)
        color = "#" + "".join(f"{round(c):02x}" for c in DARK + (LIGHT - DARK) * min(share, 1.0))
        polygons, offsets = drawn.filled(low, high)
        for points, parts in zip(polygons, offsets, strict=True):
            lines = tuple(points[a:b] for a, b in pairwise(parts.tolist()))
            view.sheet.add(Stroke(lines, color, 0.3, fill=color, closed=True, clip=view.box), 1.0)
    told = []
    for level in levels:
        lines = tuple(line for line in drawn.lines(level) if len(line) > 1)
        if lines:
            view.sheet.add(Stroke(lines, INK, 0.8, clip=view.box), 2.0)
            told.append((level, max(lines, key=_length)))
        for line in lines:
            view.labels.avoid(line)
    for level, line in told:
        _tell(view, surface.axis.told(level / surface.axis.unit.factor), line)


def levels_of(values: Array) -> list[float]:
    """Round values at which there are lines."""
    low, high = float(np.nanmin(values)), float(np.nanpercentile(values, STEEP))
    high = high if high > low else float(np.nanmax(values))
    if not high > low:
        return []
    power = 10.0 ** np.floor(np.log10((high - low) / LEVELS))
    step = next(k * power for k in (1, 2, 2.5, 5, 10, 20) if (high - low) / (k * power) <= LEVELS)
    found = step * np.arange(np.floor(low / step) + 1, np.ceil(high / step) + 1)
    return [float(level) for level in found if low < level < np.nanmax(values)]


def _length(line: Array) -> float:
    return float(np.sum(np.hypot(*np.diff(line, axis=0).T)))


def _tell(view: View, text: str, line: Array) -> None:
    """The value of a line on it, where it is farthest from the ends of the axes."""
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
