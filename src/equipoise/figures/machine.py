"""Signs of machines on a sheet."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import groupby
from typing import Any

import numpy as np

from equipoise.figures.sheet import Box, Sheet, Signs, Stroke
from equipoise.figures.texts import Labels
from equipoise.results.charts import Panel
from equipoise.symbols.looks import LIGHT, LOOKS
from equipoise.symbols.shapes import PIN, Shape, circle, gauge, mass, sign

Array = np.ndarray[Any, Any]
Placing = Callable[[Array], Array]
"""Places (n,) complex, m -> places (n, 2) on the sheet."""

UNIT = 0.64
"""Points: size of a unit of signs on paper."""
GROUND, BEFORE = 0.6, 1.3
"""Orders of the first sign behind curves, and of the first one before thin ones."""
RANGES = {GROUND: 0.4, BEFORE: 1.3}
"""By how much the last one lies above the first."""
WEIGHTS = {"edge": 1.0, "rail": 2.0, "stand": 3.0, "slot": 1.0, "block": 2.0, "spring": 1.0}
WEIGHTS |= {"planned": 1.0, "added": 1.0, "driver": 2.0, "mount": 2.0, "tray": 4.0, "needle": 2.0}
WEIGHTS |= {"surface": 1.0, "rest": 1.0, "swing": 1.0, "other-swing": 1.0}
"""What names keep clear of, and how much it matters."""


def draw_machine(sheet: Sheet, labels: Labels, panel: Panel, places: Any, box: Box) -> None:
    """The signs in a panel; places : of x and y in SI units on the sheet, (n, 2)."""

    def at(corners: Array) -> Array:
        found: Array = places(corners.real, corners.imag)
        return found

    for shapes, order in ((panel.ground, GROUND), (panel.signs, BEFORE)):
        draw_shapes(sheet, shapes, at, panel.sign_size, order, box)
        _keep_clear(labels, shapes, at, panel.sign_size, box)


def draw_shapes(
    sheet: Sheet,
    shapes: Iterable[Shape],
    at: Placing,
    size: float,
    order: float,
    clip: Box | None = None,
) -> None:
    """Draw shapes, the first of them lowest, in the looks of their roles; size : of signs."""
    groups = [
        (*key, list(run))
        for key, run in groupby(shapes, lambda one: (one.role, one.radius > 0, one.closed))
    ]
    for number, (role, to_scale, closed, run) in enumerate(groups):
        look, above = LOOKS[role], order + RANGES.get(order, 0.4) * number / len(groups)
        color = LIGHT[look.line] if look.line else ""
        fill = LIGHT[look.fill] if look.fill else ""
        width = look.width * UNIT * size
        if run[0].grown:
            middles = np.concatenate([_corners(one, at, size) for one in run])
            wide = 2 * run[0].grown * UNIT * size
            drawn = Signs(middles, "o", wide, color or fill, fill, width or 0.1, clip)
            sheet.add(drawn, above)
            continue
        lines = tuple(_ring(one, at) if to_scale else _corners(one, at, size) for one in run)
        dashes = tuple(length * UNIT * size for length in look.dashes or ())
        flat = bool(look.dashes) or look.flat
        sheet.add(
            Stroke(lines, color, width, dashes, fill if closed or len(lines[0]) > 2 else "", 1.0,
                   closed, clip, not flat),
            above,
        )  # fmt: skip


def _kind(shape: Shape) -> tuple[str, bool, bool]:
    return shape.role, shape.radius > 0, shape.closed


def _corners(shape: Shape, at: Placing, size: float) -> Array:
    offsets = UNIT * size * shape.offsets
    return np.asarray(at(shape.places) + np.column_stack([offsets.real, -offsets.imag]))


def _ring(shape: Shape, at: Placing) -> Array:
    """A circle to scale."""
    around = shape.radius * np.exp(1j * np.radians(np.arange(0, 360, 4)))
    return at(shape.places[0] + around)


def _keep_clear(
    labels: Labels, shapes: Iterable[Shape], at: Placing, size: float, box: Box
) -> None:
    """Keep names away from what is drawn."""
    left, top, right, bottom = box
    for one in shapes:
        corners = _corners(one, at, size)
        if one.grown:
            x, y = corners[0].tolist()
            labels.reserve(x, y, 4 * UNIT * size)
        elif one.role in WEIGHTS:
            line = np.vstack([corners, corners[:1]]) if one.closed else corners
            inside = np.clip(line, (left, top), (right, bottom))
            labels.avoid(inside, WEIGHTS[one.role])


def sample_of(role: str) -> list[Shape]:
    """Shapes that stand for a role in a legend."""
    look = LOOKS[role]
    if role == "mass":
        return mass(0)
    signs = {"gauge": gauge(0, 0), "foot": [circle("foot", 0, grown=PIN)]}
    signs |= {name: [circle(name, 0, grown=3.0)] for name in ("dot", "float", "pin")}
    if role in signs:
        return signs[role]
    box = np.array([-12 - 6j, 12 - 6j, 12 + 6j, -12 + 6j])
    if role == "soil":
        return [sign(role, 0, box, closed=True), sign("surface", 0, box[[3, 2]])]
    if role == "support":
        edge = sign("rim", 0, box, closed=True)
        return [edge, sign("wheel", 0, box, closed=True)]
    if look.fill and look.line:
        return [sign(role, 0, box, closed=True)]
    return [sign(role, 0, [-15, 15])]
