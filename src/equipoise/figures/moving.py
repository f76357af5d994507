"""A machine laid out as a moving picture: parts in pixels, how they move, and its texts."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.figures.stage import Arrow, Label, Moves, Stage, captions, ruler_ends
from equipoise.mechanism.model import unknown
from equipoise.symbols.pieces import Track, pieces
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import Array, Shape, arrow

HEAD = 13.0
"""Length of the head of an arrow, units."""
BEHIND = ("field", "support", "wheels", "guides", "stands")
"""Layers of pieces on which the texts and paths stand."""


@dataclass(frozen=True, eq=False)
class Stroke:
    """A shape in pixels: a line through points (n,), or a circle about the only one."""

    role: str
    points: Array
    closed: bool
    radius: float = 0.0


@dataclass(frozen=True, eq=False)
class Part:
    """Strokes that move together; those without moves stand still."""

    strokes: tuple[Stroke, ...]
    moves: Moves | None = None


@dataclass(frozen=True, eq=False)
class Moving:
    """Everything that is drawn: what lies behind the links, on that the texts, then the links.

    behind, before : each from the back to the front.
    """

    stage: Stage
    behind: tuple[Part, ...]
    labels: tuple[Label, ...]
    before: tuple[Part, ...]

    @property
    def parts(self) -> tuple[Part, ...]:
        return self.behind + self.before


def laid_out(
    scene: Scene,
    traced: Collection[str] = (),
    frames: int = 60,
    width: int = 640,
    arrow: Arrow | None = None,
) -> Moving:
    """Lay out a machine.

    traced : points whose path is drawn.  frames : instants in a turn of the crank, at most as many
    as the scene has crank angles there.  width : pixels.

    Raises
    ------
    UsageError : there is no such point, or it stands still; or the scene has one crank angle only.
    """
    for name in traced:
        if name not in scene.places:
            raise UsageError(unknown(name, scene.places, "point"))
        if name in scene.frame:
            raise UsageError(f"{name!r} is a point of the frame, which has no path; give another")
    if len(scene.crank_angle) < 2:
        raise UsageError("got one crank angle; an animation needs two and more")
    stage = Stage(scene, arrow, frames, width)
    names = tuple(dict.fromkeys(traced))
    moves: dict[Any, Moves] = {}
    behind: list[Part] = []
    before: list[Part] = []
    for piece in pieces(scene, names):
        origin = stage.origin if piece.hold is None else 0
        strokes = tuple(_stroke(stage, shape, origin) for shape in piece.shapes)
        track = None if piece.hold in moves else piece.track(scene)
        if track is not None:  # pieces with one hold share their moves
            moves[piece.hold] = stage.moves(track)
        part = Part(strokes, moves.get(piece.hold))
        (behind if piece.layer in BEHIND else before).append(part)
    behind.append(Part((*_paths(stage, names), _ruler(stage))))
    return Moving(stage, tuple(behind), captions(stage, names), (*before, *_force(stage)))


def _stroke(stage: Stage, shape: Shape, origin: complex = 0) -> Stroke:
    points = np.conj(shape.at(stage.scale, stage.unit)) + origin
    return Stroke(shape.role, points, shape.closed, shape.size(stage.scale, stage.unit))


def _paths(stage: Stage, traced: tuple[str, ...]) -> Iterator[Stroke]:
    for name in traced:
        yield Stroke("trace", stage.path(stage.at(stage.scene.places[name])), stage.closed)
    if stage.arrow is not None:
        tips = stage.at(stage.arrow.place) + np.conj(stage.arrow.force) * stage.strength
        yield Stroke("force-path", stage.path(tips), stage.closed)


def _force(stage: Stage) -> Iterator[Part]:
    """The arrow of the force: its shaft is stretched, its head is not, but where it is short."""
    if stage.arrow is None:
        return
    foot, size = stage.arrow.place, HEAD * stage.unit / stage.scale
    reach = stage.arrow.force * stage.strength / stage.scale
    length, angle = abs(reach), np.unwrap(np.angle(reach))
    short = np.clip(length / (1.5 * size), 1e-3, 1)
    shaft = np.maximum(length - 0.8 * size * short, 1e-3 / stage.scale)
    longest = float(shaft.max())
    shapes = arrow("force", longest)
    tracks = (
        Track(np.full(len(reach), foot), angle, shaft / longest),
        Track(foot + reach, angle, short),
    )
    for shape, track in zip(shapes, tracks, strict=True):
        yield Part((_stroke(stage, shape),), stage.moves(track))


def _ruler(stage: Stage) -> Stroke:
    """A length by which one can measure, at the lower left."""
    left, right = ruler_ends(stage)
    tick = 4j * stage.unit
    return Stroke("scale", np.array([left - tick, left, right, right - tick]), closed=False)
