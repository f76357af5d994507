"""Lines of equal value over two numbers, and the shades between them."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from equipoise.figures.curves import thinned
from equipoise.figures.sheet import Array, CanvasStroke, Words, width_of
from equipoise.figures.style import FAINT, INK, SMALL, mixed
from equipoise.figures.view import View, corners_of
from equipoise.results.charts import Surface

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
        _tell(view, surface.axis.told(level / surface.axis.unit.factor), line)


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
