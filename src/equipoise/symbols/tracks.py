"""What signs move with: a link, a guide, two points between which they stretch, or the support."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.symbols.carrier import MOUNT
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import Array, Shape


@dataclass(frozen=True, eq=False)
class PieceTrack:
    """How a piece moves over N crank angles.

    place : of its origin, (N,) complex, m.  angle : (N,) rad, counterclockwise, counted on.
    stretch : (N,) factor of its places along its x axis.
    """

    place: Array
    angle: Array
    stretch: Array

    def moved(self, shape: Shape, k: int) -> Shape:
        """A shape where it is at the k-th instant."""
        turn = np.exp(1j * self.angle[k])
        stretched = shape.places.real * self.stretch[k] + 1j * shape.places.imag
        places = self.place[k] + stretched * turn
        return replace(shape, places=places, offsets=shape.offsets * turn)


@dataclass(frozen=True)
class Hold:
    """What a piece moves with.

    point : its origin.  Its x axis is that of a link, the way of a guide, or points to another
    point, between which and the origin it is stretched; one of the three is given.
    rigid : whether it keeps its length between two points.
    mount : between whose place on the support and its ground it is stretched, instead.
    row : which of the other rows that the scene shows it belongs to, from 1; 0 where to none.
    """

    point: str = ""
    link: str = ""
    guide: str = ""
    to: str = ""
    mount: str = ""
    row: int = 0
    rigid: bool = False


def track_of(scene: Scene, hold: Hold | None, still: bool, unit: float) -> PieceTrack | None:
    """How signs with a hold, or without one, move; None where they stand still.

    still : whether they stand on the ground.  unit : of signs, m.
    """
    if hold is not None and hold.mount:
        return _strutted(scene, hold.mount, unit)
    piece_track = None if hold is None else _in_frame(scene, hold)
    if scene.swing is None or still:
        return piece_track
    if piece_track is None:
        zero = 0 * scene.crank_angle
        piece_track = PieceTrack(zero + 0j, zero, zero + 1)
    return PieceTrack(
        scene.swung(piece_track.place), piece_track.angle + scene.swing.angle, piece_track.stretch
    )


def _in_frame(scene: Scene, hold: Hold) -> PieceTrack:
    """Motion with a link, on a guide or between two points, in the axes of the frame."""
    if hold.row:
        row = scene.rows.visible[hold.row - 1]
        return PieceTrack(
            row.places[hold.point], row.angles[hold.link], np.ones(len(scene.crank_angle))
        )
    place = scene.places[hold.point]
    if hold.link:
        return PieceTrack(place, scene.angles[hold.link], np.ones(len(place)))
    if hold.guide:
        (way,) = (guide.way for guide in scene.guides if guide.name == hold.guide)
        return PieceTrack(place, np.unwrap(np.angle(way)), np.ones(len(place)))
    way = scene.places[hold.to] - place
    length = abs(way)
    usual = length if hold.rigid else float(length.mean()) or 1.0
    return PieceTrack(place, np.unwrap(np.angle(way)), length / usual)


def _strutted(scene: Scene, name: str, unit: float) -> PieceTrack:
    """Motion of what is stretched between a mount's place on the support and its ground."""
    assert scene.carrier is not None
    mount = scene.carrier.support.mounts[name]
    assert mount.point is not None
    at_rest, length = complex(*mount.point[:2]), MOUNT[0] * unit
    place = scene.swung(np.full(len(scene.crank_angle), at_rest))
    way = at_rest + length * scene.carrier.way(mount) - place
    return PieceTrack(place, np.unwrap(np.angle(way)), abs(way) / length)
