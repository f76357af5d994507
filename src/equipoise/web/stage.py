"""What a page is sent of a linkage's drawing: signs in axes of their own, which the page moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from equipoise.symbols.looks import LOOKS
from equipoise.symbols.pieces import Piece, pieces
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import Shape

Values = dict[str, Any]

UNIT = 1.25
"""Pixels: size of a unit of signs on a page."""


def stage_of(scene: Scene, handles: Sequence[str]) -> Values:
    """Names and the drawing of a scene.

    signs : from the back to the front, each with its ``layer``, the ``link`` that it is, what it
        moves with (`symbols.pieces.Hold`, with the ``length`` of which it is stretched), and its
        shapes: role, whether it is closed, radius (m), and that in pixels, then x and y (m) and
        offsets from there (pixels) of each corner.
    looks : role -> style.
    """
    low, high = scene.box
    drawn = pieces(scene)
    roles = sorted({shape.role for piece in drawn for shape in piece.shapes})
    return {
        "frame": list(scene.frame),
        "standing": list(scene.standing),
        "bodies": [{"name": body.name, "points": list(body.points)} for body in scene.bodies],
        "guides": [{"name": guide.name, "point": guide.point} for guide in scene.guides],
        "mass_centers": list(scene.mass_centers),
        "box": [low.real, low.imag, high.real, high.imag],
        "movable": list(handles),
        "traced": traced(scene),
        "signs": [_sign(piece) for piece in drawn],
        "looks": {role: LOOKS[role].css(UNIT) for role in roles},
    }


def _sign(piece: Piece) -> Values:
    hold = None if piece.hold is None else {k: v for k, v in asdict(piece.hold).items() if v}
    if hold is not None and "to" in hold:
        hold["length"] = float(np.max(piece.shapes[0].places.real))
    shapes = [_shape(shape) for shape in piece.shapes]
    return {"layer": piece.layer, "link": piece.link, "hold": hold, "shapes": shapes}


def _shape(shape: Shape) -> list[Any]:
    offsets = UNIT * shape.offsets
    corners = np.column_stack([
        shape.places.real.round(7), shape.places.imag.round(7),
        offsets.real.round(2), offsets.imag.round(2),
    ])  # fmt: skip
    sizes = shape.radius, round(UNIT * shape.grown, 2)
    return [shape.role, shape.closed, *sizes, corners.ravel().tolist()]


def traced(scene: Scene) -> list[str]:
    """Points whose paths are shown first: those of links alone, else all that move on a curve."""
    moving = [name for name in scene.places if name not in scene.frame]
    return [name for name in moving if name not in scene.pins] or moving
