"""A moving picture as pixels, frame by frame."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.colors import to_rgb, to_rgba
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.transforms import Affine2D

from equipoise.figures.moving import Moving, Part, Stroke
from equipoise.figures.paint import settings
from equipoise.symbols.looks import LIGHT, LOOKS, Colors, Look

Array = np.ndarray[Any, Any]
Brushed = tuple[Any, Path, Any]
"""Brush, path, and colour of the inside or none."""
DOTS = 72
"""An inch, so that a point is a pixel."""


def draw_frames(drawn: Moving, colors: Colors = LIGHT) -> Iterator[Array]:
    """Frames of the motion, each (height, width, 3) uint8; none of them twice."""
    stage = drawn.stage
    canvas: Any = RendererAgg(stage.width, stage.height, DOTS)  # type: ignore[no-untyped-call]
    behind, before = (
        [(part, list(_prepared(canvas, part, colors, stage.unit))) for part in parts]
        for parts in (drawn.behind, drawn.before)
    )
    texts, cover = _texts(drawn, colors)
    upright = Affine2D().scale(1, -1).translate(0, stage.height)
    image = np.asarray(canvas.buffer_rgba())
    ground = [round(255 * part) for part in to_rgba(colors["paper"])]

    def draw(parts: list[tuple[Part, list[Brushed]]], instant: int) -> None:
        for part, strokes in parts:
            placed = _placed(part, instant) + upright
            for brush, path, fill in strokes:
                canvas.draw_path(brush, path, placed, fill)

    for instant in range(len(stage.times) - stage.closed):
        image[:] = ground
        draw(behind, instant)
        image[cover] = np.round(texts + (1 - texts[:, 3:] / 255) * image[cover])
        draw(before, instant)
        yield image[..., :3].copy()


def _placed(part: Part, instant: int) -> Affine2D:
    moves = part.moves
    if moves is None:
        return Affine2D()
    place = moves.place[instant]
    stretched = Affine2D().scale(moves.stretch[instant], 1)
    return stretched.rotate(moves.angle[instant]).translate(place.real, place.imag)


def _prepared(canvas: Any, part: Part, colors: Colors, unit: float) -> Iterator[Brushed]:
    for role, run in groupby(part.strokes, lambda stroke: stroke.role):
        look = LOOKS[role]
        path = Path.make_compound_path(*map(_path, run))
        fill = None if look.fill is None else to_rgb(colors[look.fill])
        yield _brush(canvas, look, colors, unit), path, fill


def _path(shape: Stroke) -> Path:
    if shape.radius:
        return Path.circle((shape.points[0].real, shape.points[0].imag), shape.radius)
    corners = np.column_stack([shape.points.real, shape.points.imag])
    if not shape.closed:
        return Path(corners)
    return Path(np.vstack([corners, corners[:1]]), closed=True)


def _brush(canvas: Any, look: Look, colors: Colors, unit: float) -> Any:
    brush = canvas.new_gc()
    brush.set_snap(False)  # lines that move must not jump from pixel to pixel
    brush.set_joinstyle("round")
    brush.set_capstyle("butt" if look.dashes or look.flat else "round")
    brush.set_linewidth(look.width * unit if look.line else 0)
    brush.set_foreground(colors[look.line or "ink"])
    if look.dashes:
        brush.set_dashes(0, [length * unit for length in look.dashes])
    return brush


def _texts(drawn: Moving, colors: Colors) -> tuple[Array, Array]:
    """Pixels (P, 4) that texts cover, their colours already weighed, and which (height, width)."""
    stage = drawn.stage
    with settings():
        figure = Figure(figsize=(stage.width / DOTS, stage.height / DOTS), dpi=DOTS)
        figure.patch.set_alpha(0)
        canvas: Any = FigureCanvasAgg(figure)
        for label in drawn.labels:
            figure.text(
                label.place.real / stage.width,
                1 - label.place.imag / stage.height,
                label.text,
                fontsize=stage.size_of_type,
                color=colors[label.color],
                ha={"start": "left", "middle": "center", "end": "right"}[label.anchor],
                va="center",
                path_effects=[withStroke(linewidth=3 * stage.unit, foreground=colors["paper"])],
            )
        canvas.draw()
    image = np.asarray(canvas.buffer_rgba()).astype(float)
    cover = image[..., 3] > 0
    pixels = image[cover]
    pixels[:, :3] *= pixels[:, 3:] / 255
    return pixels, cover
