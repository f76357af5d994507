"""What stands in one pair of axes: grid, shades, lines, and all that is drawn over them."""

from __future__ import annotations

from math import ceil, floor, log10

import numpy as np

from equipoise.figures.curves import draw_area, draw_arrow, draw_bars, draw_curve, draw_surface
from equipoise.figures.machine import draw_machine
from equipoise.figures.scales import Scale
from equipoise.figures.sheet import Stroke
from equipoise.figures.style import GRID, LINES, PALE, Look, look_of
from equipoise.figures.view import View, corners_of
from equipoise.figures.words import write_words

RINGS = 4
"""Circles of a polar diagram at most, out to its farthest corner."""


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
        corners = corners_of(box) if band.axis == "y" else corners_of((box[0], top, box[1], bottom))
        view.area(corners, look_of(band.role))
    if panel.surface is not None:
        draw_surface(view, panel.surface)
    for area in panel.areas:
        draw_area(view, area)
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
        draw_bars(view, bars)
    numbers = {role: k for k, role in enumerate(f"kind {n}" for n in range(6))}
    for curve in panel.curves:
        draw_curve(view, curve, numbers.get(curve.role, 0))
    for arrow in panel.arrows:
        draw_arrow(view, arrow.tail, arrow.head, look_of(arrow.role))
    write_words(view)


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


def frame(view: View, numbers: bool) -> None:
    """The box around the axes, its ticks and, along x where wanted, their numbers."""
    left, _, right, bottom = view.box
    panel = view.panel
    view.sheet.add(Stroke((corners_of(view.box),), LINES, 0.7, closed=True), 5.0)
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
