"""The drawing of a machine as a page is sent it: signs, and the arrays that move them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.kinematics.tip import surface_of
from equipoise.mechanism.parts.machine import Machine
from equipoise.symbols.carrier import MOUNT
from equipoise.symbols.looks import LOOKS
from equipoise.symbols.part_signs import dragged_circles
from equipoise.symbols.pieces import Piece, pieces
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import Shape
from equipoise.web.block import FloatBlock, Values
from equipoise.web.edits import Computed

UNIT = 1.25
"""Pixels: size of a unit of signs on a page."""


def stage_of(scene: Scene, handles: Sequence[str], circles: Sequence[Values] = ()) -> Values:
    """Names and the drawing of a scene.

    signs : from the back to the front, each with its ``layer``, the ``link`` that it is, the
        ``part`` (``slider`` or ``gears``, and its name) that it shows, what it moves with
        (`symbols.pieces.Hold`, with the ``length`` of which it is stretched), and its shapes:
        role, whether it is closed, radius (m), and that in pixels, then x and y (m) and offsets
        from there (pixels) of each corner.
    looks : role -> style.
    circles : see `circles_of`.
    """
    low, high = scene.box
    symbols = pieces(scene)
    shapes = iter(shapes_of([shape for piece in symbols for shape in piece.shapes]))
    roles = sorted({shape.role for piece in symbols for shape in piece.shapes})
    return {
        "frame": list(scene.frame),
        "standing": list(scene.standing),
        "bodies": [{"name": body.name, "points": list(body.points)} for body in scene.bodies],
        "guides": [{"name": guide.name, "point": guide.point} for guide in scene.guides],
        "mass_centers": list(scene.mass_centers),
        "box": [low.real, low.imag, high.real, high.imag],
        "movable": list(handles),
        "circles": list(circles),
        "signs": [
            {**_sign(scene, piece), "shapes": [next(shapes) for _ in piece.shapes]}
            for piece in symbols
        ],
        "looks": {role: LOOKS[role].css(UNIT) for role in roles},
        "reference": _reference(scene),
    }


def _sign(scene: Scene, piece: Piece) -> Values:
    hold = None if piece.hold is None else {k: v for k, v in vars(piece.hold).items() if v}
    if hold is not None and "to" in hold:
        hold["length"] = float(np.max(piece.shapes[0].places.real))
    if hold is not None and "mount" in hold:
        hold |= _strut(scene, hold["mount"])
    return {
        "layer": piece.layer,
        "link": piece.link,
        "hold": hold,
        "part": piece.part,
        "still": piece.still,
    }


def circles_of(machine: Machine, joints: Structure) -> list[Values]:
    """What a page needs to change circles by hand: of each the list of its part, the path and the
    value of its radius, its centre, and the point across from which it is dragged.
    """
    return [
        {
            "name": circle.name,
            "table": table,
            "path": str(KeyPath((table, number, circle.key))),
            "radius": getattr(part, circle.key),
            "axis": circle.axis,
            "point": circle.point,
        }
        for table, number, part, circle in dragged_circles(machine, joints)
    ]


def _strut(scene: Scene, name: str) -> Values:
    """Place of a mount on the support at rest (m), and from there to its ground (pixels)."""
    assert scene.carrier is not None
    mount = scene.carrier.support.mounts[name]
    assert mount.point is not None
    way = UNIT * MOUNT[0] * scene.carrier.way(mount)
    return {"at": list(mount.point[:2]), "ground": [way.real, way.imag]}


def _reference(scene: Scene) -> list[float] | None:
    """What a support turns about, m; None where there is none."""
    if scene.carrier is None:
        return None
    return [scene.carrier.reference.real, scene.carrier.reference.imag]


def shapes_of(shapes: Sequence[Shape]) -> list[list[Any]]:
    """Shapes as values of a message, see `stage_of`."""
    if not shapes:
        return []
    places = np.concatenate([shape.places for shape in shapes])
    offsets = UNIT * np.concatenate([shape.offsets for shape in shapes])
    corners = np.column_stack([
        places.real.round(7), places.imag.round(7), offsets.real.round(2), offsets.imag.round(2)
    ]).ravel().tolist()  # fmt: skip
    ends = 4 * np.cumsum([0, *(len(shape.places) for shape in shapes)])
    return [
        [shape.role, shape.closed, shape.radius, round(UNIT * shape.grown, 2), corners[low:high]]
        for shape, (low, high) in zip(shapes, pairwise(ends), strict=True)
    ]


def moves_of(scene: Scene, block: FloatBlock) -> None:
    """Where everything of a drawing is over the crank angle, for the block."""
    block.add("crank_angle", scene.crank_angle)
    for name, place in scene.places.items():
        block.add(f"place.{name}", place)
    for name, place in scene.mass_centers.items():
        block.add(f"mass_center.{name}", place)
    for name, angle in scene.angles.items():
        block.add(f"angle.{name}", angle)
    for guide in scene.guides:
        block.add(f"guide.{guide.name}", guide.way)


def ground_of(computed: Computed, block: FloatBlock) -> Values:
    """Paths of planting tips over ground, for the block, and the soil that they go into."""
    planting, speed = computed.analysis.machine.planting, computed.motion.speed
    if planting is None or speed == 0:
        return {}
    scene = computed.scene
    way = planting.forward(speed) / speed * scene.crank_angle
    tips = [arm.tip for arm in planting.every_arm]
    for tip in tips:
        block.add(f"ground.{tip}", scene.places[tip] + way)
    return {"planting": {"tips": tips, "surface": surface_of(computed.analysis.machine)}}
