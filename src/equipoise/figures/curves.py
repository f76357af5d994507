"""What is drawn in a pair of axes: curves, bars, areas, arrows, machines."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import groupby
from typing import Any

import numpy as np

from equipoise.figures.sheet import MIDDLE, Box, Canvas, CanvasStroke, Labels, Markers, Words
from equipoise.figures.style import INK, SMALL, DrawingStyle, look_of, mixed
from equipoise.figures.view import AxisScale, View, corners_of, ends_of, ticks_of
from equipoise.results.charts import Area, Bars, Cells, Curve, Panel, Rule
from equipoise.signals import Array
from equipoise.symbols import looks
from equipoise.symbols.carrier import gauge
from equipoise.symbols.constraints import LEGENDS, SIGNS
from equipoise.symbols.shapes import PIN, Shape, circle, mass, sign, zigzag
from equipoise.symbols.torsion_springs import spiral

SHADES = 4
"""Of cells in which something is."""
DOT = 6.0
"""Points: width of a dot that stands for a bar."""
CAP = 2.2
"""Points: half the line across the end of an interval."""
MARKERS = 7
"""Signs on a curve that has a few of them, beside those of the others."""


def draw_curve(view: View, curve: Curve, number: int) -> None:
    """A curve with its signs, where it can be drawn; number : among those that have a few."""
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
        alone = np.array([part[0] for part in parts if len(part) == 1])
        if longer:
            line = CanvasStroke(longer, look.color, look.width, look.lengths, clip=view.box)
            view.sheet.add(line, look.order)
        if len(alone):
            dot = DrawingStyle(look.color, sign=".", size=2.5)
            view.sheet.add(signs_at(alone, dot, view.box), look.order)
    if look.sign:
        at = _spaced(places, number, view.box) if look.spaced else np.flatnonzero(there)
        clip = None if look.spaced else view.box
        if len(at):
            view.sheet.add(signs_at(places[at], look, clip), look.order + 0.01)
    if not look.width and len(places) < 500:
        for x, y in places[there].tolist():
            view.labels.reserve(x, y, look.size / 2)
    else:
        inside = places[there & (places[:, 1] <= view.y.start + 1)]
        view.labels.avoid(inside, 0.6 if look.order < 3 else 1.0)


def thinned(places: Array) -> Array:
    """A line (N, 2) without the places in which it hardly turns."""
    points: Array = np.round(places, 1)
    new = np.concatenate([[True], np.any(np.diff(points, axis=0) != 0, axis=1)])
    points = points[new]
    if len(points) < 3:
        return points
    before, after = np.diff(points[:-1], axis=0), np.diff(points[1:], axis=0)
    turned = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]) > 1e-9
    ahead = np.sum(before * after, axis=1) > 0
    return np.asarray(points[np.concatenate([[True], turned | ~ahead, [True]])])


def _spaced(places: Array, number: int, box: Box) -> Array:
    """Indices of a few samples, offset from those of other curves, so that grey prints differ."""
    left, top, right, bottom = box
    x = np.where(np.isfinite(places[:, 0]), places[:, 0], -1e9)
    wanted = x[0] + (x[-1] - x[0]) * (np.arange(MARKERS) + (number + 0.5) / 6) / MARKERS
    nearest = np.unique(np.argmin(np.abs(x[:, None] - wanted), axis=0))
    inside = (places[nearest] >= (left, top)) & (places[nearest] <= (right, bottom))
    return np.asarray(nearest[np.all(inside, axis=1)])


def signs_at(places: Array, look: DrawingStyle, clip: Box | None = None) -> Markers:
    """Signs at places (N, 2) of the sheet."""
    width = max(look.width, 1.0)
    return Markers(places, look.sign, look.size, look.color, look.inside, width, clip)


def draw_area(view: View, area: Area) -> None:
    """What lies between two lines."""
    low, high = view.places(area.x, area.low), view.places(area.x, area.high)
    view.area(look_of(area.role), np.concatenate([high, low[::-1]]))


def draw_bars(view: View, bars: Bars) -> None:
    """Bars of one kind, each in the look of its role; dots where the axis has no 0 on which bars
    could stand.
    """
    if (view.y if bars.across == "x" else view.x).axis.scale == "log":
        _dots(view, bars)
        return
    half = np.broadcast_to(np.asarray(bars.width, float) / 2, bars.at.shape)
    along, up = (view.x, view.y) if bars.across == "x" else (view.y, view.x)
    by_role: dict[str, list[Array]] = {}
    for k, (at, wide, size) in enumerate(zip(bars.at, half, bars.size, strict=True)):
        if not np.isfinite(size):
            continue
        start, stop = along.at([at - wide, at + wide])
        foot, top = up.at([0.0, size])
        if bars.across == "x":
            box = (start, top, stop, min(foot, up.start))
        else:
            box = (max(foot, up.start), stop, top, start)
        role = bars.roles[k] if bars.roles else bars.role
        by_role.setdefault(role, []).append(corners_of(box))
    for role, corners in by_role.items():
        view.area(look_of(role), *corners)
    if bars.interval is not None:
        _intervals(view, bars, *bars.interval)


def _dots(view: View, bars: Bars) -> None:
    """A dot at the size of each, on which no text stands."""
    pair = (bars.at, bars.size) if bars.across == "x" else (bars.size, bars.at)
    roles = np.array(bars.roles or [bars.role] * len(bars.at))
    visible = np.isfinite(bars.size) & (bars.size > 0)
    for role in dict.fromkeys(roles[visible].tolist()):
        look = look_of(role)
        chosen = visible & (roles == role)
        places = view.places(pair[0][chosen], pair[1][chosen])
        signs = Markers(places, "o", DOT, look.ink, look.inside, 0.0, view.box)
        view.sheet.add(signs, look.order)
        for x, y in places.tolist():
            view.labels.reserve(x, y, DOT / 2)


def _intervals(view: View, bars: Bars, low: Array, high: Array) -> None:
    """From the least to the largest size of each bar, with a short line across either end."""
    look = look_of("interval")
    for at, *ends in zip(bars.at.tolist(), low.tolist(), high.tolist(), strict=True):
        line = np.array([(at, end) if bars.across == "x" else (end, at) for end in ends])
        places = view.places(*line.T)
        across = np.array([0.0, CAP]) if bars.across == "y" else np.array([CAP, 0.0])
        caps = (np.array([place - across, place + across]) for place in places)
        view.sheet.add(
            CanvasStroke((places, *caps), look.color, look.width, clip=view.box), look.order
        )


def draw_cells(view: View, cells: Cells) -> None:
    """Shades, the darker the more there are, by their logarithm; or dots."""
    look = look_of(cells.role)
    x, y = view.x.at(cells.x), view.y.at(cells.y)
    if cells.dots:
        rows, columns = np.nonzero(cells.counts)
        middles = np.column_stack([(x[1:] + x[:-1])[columns] / 2, (y[1:] + y[:-1])[rows] / 2])
        if len(middles):
            view.sheet.add(signs_at(middles, look, view.box), look.order)
        return
    largest = float(np.log(1.0 + np.max(cells.counts, initial=0))) or 1.0
    shades = np.ceil(SHADES * np.log1p(cells.counts) / largest).astype(int)
    for shade in range(1, SHADES + 1):
        corners = tuple(
            corners_of((float(x[a]), float(y[row + 1]), float(x[b]), float(y[row])))
            for row in range(len(shades))
            for a, b in _runs(shades[row] == shade)
        )
        if corners:
            color = mixed(look.color, shade / SHADES)
            line = CanvasStroke(corners, color, 0.3, fill=color, closed=True, clip=view.box)
            view.sheet.add(line, look.order + 0.01 * shade)


def _runs(mask: Array) -> list[tuple[int, int]]:
    """Stretches that are true, each from its first to beyond its last place."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int)))
    return [(a, b) for a, b in edges.reshape(-1, 2).tolist()]


def draw_rule(view: View, rule: Rule) -> None:
    """An upright axis with its numbers, on a pale ground, for lines run across it."""
    _, top, _, bottom = view.box
    x = float(view.x.at(rule.at))
    scale = AxisScale(rule.axis, *ends_of(rule.axis, ()), bottom, top)
    view.line(np.array([(x, top), (x, bottom)]), look_of("rule"))
    for place, text in ticks_of(scale, upright=True):
        y = float(scale.of(place))
        view.line(np.array([(x, y), (x + 3, y)]), look_of("rule"))
        words = Words(x + 5, y + MIDDLE * SMALL, text, SMALL, INK, backed=True)
        view.sheet.add(words, 7.0)


def draw_arrow(view: View, tail: complex, head: complex, look: DrawingStyle) -> None:
    """An arrow between two places, complex, SI units."""
    (start,), (end,) = (view.places(z.real, z.imag) for z in (tail, head))
    way = end - start
    size = float(np.hypot(*way))
    if not size:
        return
    length = min(max(4.0 + 2.2 * look.width, 5.5), size)
    along = way / size
    foot, half_width = end - length * along, 0.4 * length * np.array([-along[1], along[0]])
    if look.width and size > length:
        shaft = np.array([start, foot + 0.3 * length * along])
        view.sheet.add(CanvasStroke((shaft,), look.color, look.width), 3.5)
    corners = np.array([end, foot + half_width, foot - half_width])
    view.sheet.add(CanvasStroke((corners,), fill=look.color, closed=True), 3.6)
    view.labels.avoid(np.array([start, end]))


Placing = Callable[[Array], Array]
"""Places (n,) complex, m -> places (n, 2) on the sheet."""

AROUND = np.exp(1j * np.radians(np.arange(0, 360, 4)))
UNIT = 0.64
"""Points: size of a unit of signs on paper."""
GROUND, BEFORE = 0.6, 1.3
"""Orders of the first sign behind curves, and of the first one before thin ones."""
RANGES = {GROUND: 0.4, BEFORE: 1.3}
"""By how much the last one lies above the first."""
WEIGHTS = {"edge": 1.0, "rail": 2.0, "stand": 3.0, "slot": 1.0, "block": 2.0, "spring": 1.0}
WEIGHTS |= {"planned": 1.0, "added": 1.0, "driver": 2.0, "mount": 2.0, "tray": 4.0, "needle": 2.0}
WEIGHTS |= {"room": 1.0, "surface": 1.0, "rest": 1.0, "swing": 1.0, "other-swing": 1.0}
"""What names keep clear of, and how much it matters."""


def draw_machine(sheet: Canvas, labels: Labels, panel: Panel, places: Any, box: Box) -> None:
    """The signs in a panel; places : of x and y in SI units on the sheet, (n, 2)."""

    def at(corners: Array) -> Array:
        values: Array = places(corners.real, corners.imag)
        return values

    for shapes, order in ((panel.ground, GROUND), (panel.signs, BEFORE)):
        draw_shapes(sheet, shapes, at, panel.sign_size, order, box)
        _keep_clear(labels, shapes, at, panel.sign_size, box)


def draw_shapes(
    sheet: Canvas,
    shapes: Iterable[Shape],
    at: Placing,
    size: float,
    order: float,
    clip: Box | None = None,
) -> None:
    """Draw shapes, the first of them lowest, in the looks of their roles; size : of signs."""
    groups = [
        (*key, list(run))
        for key, run in groupby(shapes, lambda shape: (shape.role, shape.radius > 0, shape.closed))
    ]
    for number, (role, to_scale, closed, run) in enumerate(groups):
        look, above = looks.LOOKS[role], order + RANGES.get(order, 0.4) * number / len(groups)
        color = looks.LIGHT[look.line] if look.line else ""
        fill = looks.LIGHT[look.fill] if look.fill else ""
        width = look.width * UNIT * size
        if run[0].grown:
            middles = np.concatenate([_corners(item, at, size) for item in run])
            wide = 2 * run[0].grown * UNIT * size
            sheet.add(Markers(middles, "o", wide, color or fill, fill, width or 0.1, clip), above)
            continue
        lines = tuple(
            at(item.places[0] + item.radius * AROUND) if to_scale else _corners(item, at, size)
            for item in run
        )
        dashes = tuple(length * UNIT * size for length in look.dashes or ())
        filled = fill if closed or len(lines[0]) > 2 else ""
        flat = bool(look.dashes) or look.flat
        stroke = CanvasStroke(lines, color, width, dashes, filled, 1.0, closed, clip, not flat)
        sheet.add(stroke, above)


def _corners(shape: Shape, at: Placing, size: float) -> Array:
    offsets = UNIT * size * shape.offsets
    return np.asarray(at(shape.places) + np.column_stack([offsets.real, -offsets.imag]))


def _keep_clear(
    labels: Labels, shapes: Iterable[Shape], at: Placing, size: float, box: Box
) -> None:
    """Keep names away from what is drawn."""
    left, top, right, bottom = box
    for shape in shapes:
        corners = _corners(shape, at, size)
        if shape.grown:
            x, y = corners[0].tolist()
            labels.reserve(x, y, 4 * UNIT * size)
        elif shape.role in WEIGHTS:
            line = np.vstack([corners, corners[:1]]) if shape.closed else corners
            inside = np.clip(line, (left, top), (right, bottom))
            labels.avoid(inside, WEIGHTS[shape.role])


SPRINGS = ("spring", "planned", "added")
"""That there are, that are to be found, and that were found."""


def sample_of(role: str) -> list[Shape]:
    """Shapes that stand for a role in a legend."""
    look = looks.LOOKS[role]
    if role == "mass":
        return [*mass(0)]
    signs = {"gauge": gauge(0, 0), "foot": [circle("foot", 0, grown=PIN)]}
    signs |= {name: [circle(name, 0, grown=3.0)] for name in ("dot", "float", "pin")}
    spring = zigzag(-15, 15, 4)
    signs |= {name: [sign(name, 0, spring.places + spring.offsets)] for name in SPRINGS}
    signs |= {
        name: [sign(name, 0, stroke) for stroke in SIGNS["equal"].strokes]
        for name, _ in LEGENDS.values()
    }
    signs["spiral"] = [sign("spiral", 0, spiral() * 0.5)]
    if role in signs:
        return signs[role]
    box = np.array([-12 - 6j, 12 - 6j, 12 + 6j, -12 + 6j])
    if role == "soil":
        return [sign(role, 0, box, closed=True), sign("surface", 0, box[[3, 2]])]
    if role == "support":
        return [sign(name, 0, box, closed=True) for name in ("rim", "wheel")]
    if look.fill and look.line:
        return [sign(role, 0, box, closed=True)]
    return [sign(role, 0, [-15, 15])]
