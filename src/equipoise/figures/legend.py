"""Legends: how something looks, and its name, in rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.curves import draw_shapes, sample_of, signs_at
from equipoise.figures.sheet import MIDDLE, Canvas, CanvasStroke, Words, set_in, width_of
from equipoise.figures.style import INK, NORMAL, look_of
from equipoise.figures.view import corners_of
from equipoise.results.charts import Panel
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
    """What has a name in a panel: what the chart's legend tells, or that of the panel itself."""
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
    if key.role in LOOKS:
        draw_shapes(sheet, sample_of(key.role), lambda z: np.array([x + SAMPLE / 2, y]), 1.0, 6.0)
        return
    look = look_of(key.role, key.dashed)
    if key.kind == "patch":
        corners = corners_of((x + 3, y - 4, x + 17, y + 4))
        sheet.add(CanvasStroke((corners,), fill=look.inside, opacity=look.opacity, closed=True), 6)
        return
    if look.width and key.kind == "line" and not (look.sign and look.order >= 4):
        ends = np.array([(x, y), (x + SAMPLE, y)])
        sheet.add(CanvasStroke((ends,), look.color, look.width, look.lengths), 6)
    if look.sign or key.kind == "sign":
        shown = replace(look, size=3.0 if look.sign == "." else look.size)
        if not look.sign:
            shown = replace(look, sign="o", size=4.0)
        sheet.add(signs_at(np.array([(x + SAMPLE / 2, y)]), shown), 6.1)
