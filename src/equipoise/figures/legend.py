"""Legends: how something looks, and its name, in rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from equipoise.figures.curves import draw_shapes, sample_of
from equipoise.figures.sheet import MIDDLE, Sheet, Signs, Stroke, Words, set_in, width_of
from equipoise.figures.style import INK, NORMAL, Look, look_of
from equipoise.results.charts import Panel
from equipoise.symbols.looks import LOOKS

KEY, SAMPLE, APART = 13.5, 20.0, 14.0
"""Points: height of a legend's row; width of a sample; between two of them."""


@dataclass(frozen=True)
class Key:
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
    if look.fill and not look.sign:
        return "patch"
    return "line"


def keys_of(panel: Panel, chart_level: bool) -> list[Key]:
    """What has a name in a panel: what the chart's legend tells, or that of the panel itself."""
    found = [Key(c.role, c.label, "line", c.dashed) for c in panel.curves if c.label]
    if panel.keyed:
        found = [] if chart_level else found
    elif not chart_level:
        return []
    if chart_level:
        found += [Key(b.role, b.label, "patch") for b in panel.bars if b.label]
        found += [Key(a.role, a.label, "patch") for a in panel.areas if a.label]
        found += [Key(o.role, o.label, "patch") for o in panel.outlines if o.label]
        found += [Key(line.role, line.label, "line") for line in panel.lines if line.label]
        found += [Key(m.role, m.label, "sign") for m in panel.marks if m.label]
        found += [Key(b.role, b.label, "patch") for b in panel.bands if b.label]
        if panel.surface is not None and panel.surface.lacking:
            found.append(Key("whole", panel.surface.lacking, "patch"))
    return [*dict.fromkeys(found)]


def rows_of(keys: list[Key], room: float) -> list[list[Key]]:
    """Entries of a legend in rows."""
    rows: list[list[Key]] = []
    left = 0.0
    for key in keys:
        wide = key.width + APART
        if not rows or left < wide - APART:
            rows.append([])
            left = room
        rows[-1].append(key)
        left -= wide
    return rows


def draw_legend(sheet: Sheet, keys: list[Key], left: float, right: float, top: float) -> float:
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


def _sample(sheet: Sheet, key: Key, x: float, y: float) -> None:
    if key.role in LOOKS:
        draw_shapes(sheet, sample_of(key.role), lambda z: np.array([x + SAMPLE / 2, y]), 1.0, 6.0)
        return
    look = look_of(key.role, key.dashed)
    if key.kind == "patch":
        fill = look.fill or look.color
        corners = np.array([(x + 3, y - 4), (x + 17, y - 4), (x + 17, y + 4), (x + 3, y + 4)])
        sheet.add(Stroke((corners,), fill=fill, opacity=look.opacity, closed=True), 6)
        return
    if look.width and key.kind == "line" and not (look.sign and look.order >= 4):
        dashes = tuple(max(look.width, 0.8) * dash for dash in look.dashes)
        ends = np.array([(x, y), (x + SAMPLE, y)])
        sheet.add(Stroke((ends,), look.color, look.width, dashes), 6)
    if look.sign or key.kind == "sign":
        sheet.add(_key_sign(look, x + SAMPLE / 2, y), 6.1)


def _key_sign(look: Look, x: float, y: float) -> Signs:
    face = look.fill or ("#ffffff" if look.hollow else look.color)
    sign, size = (look.sign, look.size) if look.sign else ("o", 4.0)
    size = 3.0 if sign == "." else size
    return Signs(np.array([(x, y)]), sign, size, look.color, face, max(look.width, 1.0))
