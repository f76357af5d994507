"""Parts of the frame's plane: which points are followed, and axes that hold them on one scale."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.plotting.panels import Panel

if TYPE_CHECKING:
    from equipoise.mechanism.motion import Motion
    from equipoise.scene import Scene

Array = np.ndarray[Any, Any]

ROOM = 0.36
"""Inches free around what is drawn, for labels."""
STILL = 1e-9
"""Over the motion of what moves most, or the size of the machine: what is less stands still."""
CANDIDATES = 24
"""Crank angles in a turn among which the clearest is chosen."""


def hold(places: Array, wide: float, high: float, low: float = 0.0) -> Panel:
    """The part of the plane around places (in units of the axes) that fills so many inches.

    wide : exactly.  high, low : at most and at least.
    """
    start = complex(np.min(places.real), np.min(places.imag))
    end = complex(np.max(places.real), np.max(places.imag))
    across, up = (end - start).real, (end - start).imag
    inch = max(across / (wide - 2 * ROOM), up / (high - 2 * ROOM)) or 1.0
    half_across = wide * inch / 2
    half_up = max(up / 2 + ROOM * inch, low * inch / 2)
    middle = (start + end) / 2
    return Panel(
        middle.real - half_across,
        middle.real + half_across,
        middle.imag - half_up,
        middle.imag + half_up,
        inch,
    )


def moving(motion: Motion) -> list[str]:
    """Points that do not stand still."""
    fastest = {name: float(np.max(np.abs(point.place_1))) for name, point in motion.points.items()}
    least = STILL * max(fastest.values())
    return [name for name, rate in fastest.items() if rate > least]


def traced(motion: Motion) -> list[str]:
    """Points with a path worth following: those of couplers, first those that are no joint.

    A point of a link that is pinned to the frame runs on a circle; these come only where a machine
    has no others, and those of the drive last of all.
    """
    machine, joints = motion.machine, motion.linkage.joints
    pinned = [link for link in machine.links.values() if set(link.points) & set(machine.frame)]
    circling = {point for link in pinned for point in link.points}
    names = moving(motion)
    driven = [name for name in names if name not in machine.links[machine.drive.link].points]
    found = [name for name in names if name not in circling] or driven or names
    return sorted(found, key=lambda name: name in joints.pins)


def clear_angle(scene: Scene) -> int:
    """At which of a scene's crank angles (of the first turn) points and bars keep apart best."""
    count = int(np.searchsorted(scene.crank_angle, 2 * np.pi - 1e-9))
    at = np.unique(np.linspace(0, max(count, 1), CANDIDATES, endpoint=False).astype(int))
    least = np.full(len(at), np.inf)
    every = sorted({place for body in scene.bodies for place in body.outline})
    for body in scene.bodies:
        corners = [scene.places[name][at] for name in body.outline]
        edges = zip(corners, [*corners[1:], corners[0]], strict=True)
        for start, end in edges:
            for name in every:
                gap = _apart(scene.places[name][at], start, end)
                if name not in body.points and np.max(gap) > STILL * abs(
                    scene.box[1] - scene.box[0]
                ):
                    least = np.minimum(least, gap)
    best = float(np.max(least))
    if not 0 < best < np.inf:  # nothing can meet, or something always does
        return int(at[0])
    return int(at[np.argmax(np.round(least / best, 3))])


def _apart(place: Array, start: Array, end: Array) -> Array:
    """Distance of places from segments, (M,)."""
    way = end - start
    length = np.maximum(np.abs(way), 1e-150)
    along = np.clip(((place - start) * np.conj(way)).real / length**2, 0.0, 1.0)
    return np.asarray(np.abs(place - start - along * way))
