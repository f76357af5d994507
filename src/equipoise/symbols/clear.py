"""The crank angle at which a machine is drawn where none is asked for."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, pairwise

import numpy as np

from equipoise.mechanism.formulas.kernels import cross
from equipoise.symbols.carrier import MOUNT
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import Array, off_outline

CANDIDATES = 24
"""Crank angles in a turn among which the clearest is chosen."""
ROOM, OPEN = 80.0, np.radians(60.0)
"""Units from a sign to a link, and angle between links that meet, of which more is no clearer."""


def clear_angle(scene: Scene) -> int:
    """At which of a scene's crank angles (of the first turn) links hide each other least.

    Signs keep away from links that they are no part of, links do not cross, and those that meet at
    a point do not lie in one line.  Each adds the cube of what it lacks, so that many that are
    near weigh less than one that is hidden, and what never changes does not count.
    """
    count = int(np.searchsorted(scene.crank_angle, 2 * np.pi - 1e-9))
    at = np.unique(np.linspace(0, max(count, 1), CANDIDATES, endpoint=False).astype(int))
    shares = [*_off_links(scene, at), *_uncrossed(scene, at), *_opened(scene, at)]
    lacking = sum((np.clip(1 - share, 0, 1) ** 3 for share in shares), np.zeros(len(at)))
    return int(at[np.argmin(np.round(lacking, 3))])


def _off_links(scene: Scene, at: Array) -> Iterator[Array]:
    """How far signs are from links and springs, over the room that they should have, (M,) each."""
    outlines = [(body.name, set(body.points), body.outline) for body in scene.bodies]
    outlines += [("", set(ends), ends) for ends in _springs(scene)]
    signs = [("", name, place[at]) for name, place in scene.places.items()]
    middles = ((scene.places[item] + scene.places[other]) / 2 for item, other in _springs(scene))
    signs += [("", "", middle[at]) for middle in middles]
    signs += [(link, "", center[at]) for link, center in scene.mass_centers.items()]
    if scene.carrier is not None:
        below = -0.5j * MOUNT[0] * scene.unit
        mount_points = (
            item.point for item in scene.carrier.items.values() if item.point is not None
        )
        signs += [("", "", np.full(len(at), complex(*point[:2]) + below)) for point in mount_points]
    for link, points, outline in outlines:
        corners = np.array([scene.places[name][at] for name in outline])
        for own, point, place in signs:
            if point not in points and own != link:
                yield off_outline(place, corners) / (ROOM * scene.unit)


def _springs(scene: Scene) -> list[tuple[str, str]]:
    return [*scene.stretched]


def _uncrossed(scene: Scene, at: Array) -> Iterator[Array]:
    """Whether edges of links, and springs, cross each other, (M,) each."""
    edges = [{*ends} for ends in _springs(scene)]
    for body in scene.bodies:
        edges += [{*ends} for ends in pairwise((*body.outline, body.outline[0]))]
    for edge, other in combinations([ends for ends in edges if len(ends) == 2], 2):
        if not edge & other:
            a, b, c, d = (scene.places[name][at] for name in (*sorted(edge), *sorted(other)))
            yield 1.0 * (_overlap(scene, a, b, c, d) | _overlap(scene, c, d, a, b))


def _overlap(scene: Scene, a: Array, b: Array, c: Array, d: Array) -> Array:
    """Whether c and d lie on one side of the line from a to b, or one of them on it, (M,)."""
    ends = cross(b - a, c - a) * cross(b - a, d - a)
    return np.asarray(ends > -((scene.unit * np.abs(b - a)) ** 2))


def _opened(scene: Scene, at: Array) -> Iterator[Array]:
    """Angles between what meets at a point, over what they should be, (M,) each."""
    arms: dict[str, list[Array]] = {}
    bars = [body.outline for body in scene.bodies if len(body.outline) == 2]
    for start, end in (*bars, *_springs(scene)):
        along = scene.places[end][at] - scene.places[start][at]
        arms.setdefault(start, []).append(along)
        arms.setdefault(end, []).append(-along)
    for guide in scene.guides:
        arms.setdefault(guide.point, []).append(guide.way[at])
    for point, ways in arms.items():
        for number, way in enumerate(ways):
            if point in scene.standing:
                yield np.abs(np.angle(way / scene.ground(point))) / OPEN
            for other in ways[:number]:
                angle = np.abs(np.angle(way * other.conj()))
                yield np.minimum(angle, np.pi - angle) / OPEN
