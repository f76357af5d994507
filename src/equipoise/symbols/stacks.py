"""Links that cover each other in a drawing, so that it shows them in turn."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations, zip_longest

import numpy as np

from equipoise.symbols.looks import EDGE
from equipoise.symbols.scene import LinkOutline, Scene
from equipoise.symbols.shapes import Array, off_outline

COVERED = 0.25
"""Share of a link's outline that another one hides, from which both are not read together."""
ALIKE = 1e-6
"""rad within which links turn alike: others part as the crank goes on."""
SAMPLES = 16
"""Places on an edge."""


def in_turn(scene: Scene, k: int) -> list[tuple[tuple[str, ...], Scene]]:
    """The scene; or, where links of one shape that turn alike cover each other at the k-th crank
    angle, scenes of which each has some of these, whose names come with it, and all other links.
    """
    stacks = _stacks(scene, k)
    if not stacks:
        return [((), scene)]
    covering = {name for stack in stacks for name in stack}
    shown = [tuple(filter(None, names)) for names in zip_longest(*stacks)]
    return [(names, _without(scene, covering - {*names})) for names in shown]


def _stacks(scene: Scene, k: int) -> list[list[str]]:
    """Names of links that cover each other, directly or by others between them."""
    bodies = [body for body in scene.bodies if len(body.outline) > 1]
    stacks = {body.name: [body.name] for body in bodies}
    for item, other in combinations(bodies, 2):
        if stacks[item.name] is not stacks[other.name] and _covers(scene, item, other, k):
            stacks[item.name] += stacks[other.name]
            for name in stacks[other.name]:
                stacks[name] = stacks[item.name]
    by_name = {id(stack): stack for stack in stacks.values() if len(stack) > 1}
    return [*by_name.values()]


def _covers(scene: Scene, outline: LinkOutline, other: LinkOutline, k: int) -> bool:
    """Whether links of one shape that turn alike cover each other."""
    turned = scene.angles[outline.name] - scene.angles[other.name]
    if len(outline.outline) != len(other.outline) or np.ptp(turned) > ALIKE:
        return False
    outlines = [np.array([complex(scene.places[name][k]) for name in body.outline])
                for body in (outline, other)]  # fmt: skip
    shift = outlines[1] - outlines[0]
    if np.ptp(shift.real) + np.ptp(shift.imag) > scene.unit:
        return False
    off = [off_outline(_along(first), second[:, None])
           for first, second in (outlines, outlines[::-1])]  # fmt: skip
    return float(np.mean(np.array(off) < EDGE * scene.unit)) >= COVERED


def _along(corners: Array) -> Array:
    """Places on the edges of an outline."""
    share = np.arange(SAMPLES) / SAMPLES
    edges = np.roll(corners, -1) - corners
    return np.asarray((corners[:, None] + edges[:, None] * share).ravel())


def _without(scene: Scene, hidden: set[str]) -> Scene:
    """A scene without some links, and what only they have."""
    bodies = tuple(body for body in scene.bodies if body.name not in hidden)
    shared = {name for body in bodies for name in body.points}
    dropped = {name for body in scene.bodies if body.name in hidden for name in body.points}
    gone = dropped - shared - {*scene.frame}
    return replace(
        scene,
        bodies=bodies,
        places={name: place for name, place in scene.places.items() if name not in gone},
        pins=scene.pins - gone,
        pin_radii={name: size for name, size in scene.pin_radii.items() if name not in gone},
        mass_centers={
            name: place for name, place in scene.mass_centers.items() if name not in hidden
        },
        wheels=tuple(wheel for wheel in scene.wheels if wheel.link not in hidden),
        guides=tuple(
            guide for guide in scene.guides if guide.point not in gone and guide.on not in hidden
        ),
        springs=tuple(ends for ends in scene.springs if not {*ends} & gone),
        planned=tuple(ends for ends in scene.planned if not {*ends} & gone),
        marks=tuple(
            mark
            for mark in scene.marks
            if mark.body not in hidden and not {mark.point, mark.to} & {*gone}
        ),
    )
