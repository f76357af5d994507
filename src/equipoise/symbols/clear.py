"""A crank angle at which the links of a machine hide each other least."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from equipoise.symbols.scene import Scene

Array = np.ndarray[Any, Any]

STILL = 1e-9
"""Over the size of the machine: what is less stands still."""
CANDIDATES = 24
"""Crank angles in a turn among which the clearest is chosen."""


def clear_angle(scene: Scene) -> int:
    """At which of a scene's crank angles (of the first turn) links hide each other least.

    Points keep away from the edges of links that they are no part of, and links that meet at a
    point do not lie in one line.  What never changes does not count.
    """
    count = int(np.searchsorted(scene.crank_angle, 2 * np.pi - 1e-9))
    at = np.unique(np.linspace(0, max(count, 1), CANDIDATES, endpoint=False).astype(int))
    size = abs(scene.linkage_box[1] - scene.linkage_box[0])
    gaps = [gap for gap in _gaps(scene, at) if np.ptp(gap) > STILL * size]
    if not gaps:
        return int(at[0])
    least = np.min(gaps, axis=0)
    best = float(np.max(least))
    if best <= STILL * size:  # something always lies on something: the others decide
        least = np.sum(gaps, axis=0)
        best = float(np.max(least))
    return int(at[np.argmax(np.round(least / best, 3))])


def _gaps(scene: Scene, at: Array) -> Iterator[Array]:
    """How far apart things are that should be, (M,) m each."""
    every = sorted({place for body in scene.bodies for place in body.outline})
    for body in scene.bodies:
        corners = [scene.places[name][at] for name in body.outline]
        for start, end in zip(corners, [*corners[1:], corners[0]], strict=True):
            for name in every:
                if name not in body.points:
                    yield _apart(scene.places[name][at], start, end)
    yield from _of_springs(scene, at)
    for met in _arms(scene, at).values():
        for number, one in enumerate(met):
            for other in met[:number]:
                yield _aside(one, other)


def _of_springs(scene: Scene, at: Array) -> Iterator[Array]:
    """How far springs are from the bars that they hang on."""
    for one, other in (*scene.springs, *scene.planned):
        place = scene.places[one][at]
        for body in scene.bodies:
            if one in body.points:
                ends = (scene.places[name][at] - place for name in body.outline)
                yield from (_aside(scene.places[other][at] - place, end) for end in ends)


def _arms(scene: Scene, at: Array) -> dict[str, list[Array]]:
    """Bars and lines of blocks by the point where they meet, as vectors from there, (M,)."""
    size = abs(scene.linkage_box[1] - scene.linkage_box[0])
    arms: dict[str, list[Array]] = {}
    for body in scene.bodies:
        if len(body.outline) == 2:
            one, other = (scene.places[name][at] for name in body.outline)
            arms.setdefault(body.outline[0], []).append(other - one)
            arms.setdefault(body.outline[1], []).append(one - other)
    for guide in scene.guides:
        arms.setdefault(guide.point, []).append(guide.way[at] * size)
    return arms


def _apart(place: Array, start: Array, end: Array) -> Array:
    """Distance of places from segments, (M,)."""
    way = end - start
    length = np.maximum(np.abs(way), 1e-150)
    along = np.clip(((place - start) * np.conj(way)).real / length**2, 0.0, 1.0)
    return np.asarray(np.abs(place - start - along * way))


def _aside(one: Array, other: Array) -> Array:
    """How far the end of the shorter of two bars that meet is from the other's line, (M,)."""
    sizes = np.abs(one), np.abs(other)
    shorter = np.minimum(*sizes)
    turned = np.abs(np.imag(np.conj(one) * other)) / np.maximum(sizes[0] * sizes[1], 1e-300)
    return np.asarray(shorter * turned)
