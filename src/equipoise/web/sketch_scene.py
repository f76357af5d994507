"""The drawing of an unfinished machine: what there is of it, where each of its links lies."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

import numpy as np

from equipoise.errors import EquipoiseError
from equipoise.mechanism.assembly.joints import pin_radii
from equipoise.symbols.constraints import constraint_marks
from equipoise.symbols.part_signs import Surroundings, in_order, load_line_marks, signs_of
from equipoise.symbols.scene import (
    DriveSign,
    GuideSign,
    Scene,
    Wheel,
    bodies_of,
    stretched,
    wheels_of,
)
from equipoise.symbols.shapes import BodyMark
from equipoise.web.sketch import Sketch

EMPTY = (-0.1 - 0.08j, 0.2 + 0.1j)
"""What is in sight of a machine that has no links yet, m."""
RAIL = 0.35
"""How far a line reaches from its block to either side, over the size of the machine."""


def drawn_scene(sketch: Sketch) -> Scene:
    """What there is to draw of a sketch, at the crank angle at which it is drawn."""
    values = np.ones(1)
    guides = tuple(
        GuideSign(
            slider.name,
            slider.point,
            way * values,
            slider.on,
            *2 * (RAIL * sketch.extent * values,),
        )
        for slider in sketch.sliders
        for way in [np.exp(1j * (sketch.pose(slider.on).angle + slider.direction))]
    )
    centers = {
        name: sketch.pose(name).out(link.center_of_mass) * values
        for name, link in sketch.links.items()
        if link.center_of_mass is not None
    }
    joints, drive = sketch.joints, _sense(sketch)
    return Scene(
        sketch.pose(drive.link).angle * values if drive.link else 0 * values,
        tuple(sketch.frame),
        tuple(bodies_of(sketch.links)),
        {name: place * values for name, place in sketch.places.items()},
        joints.pinned_points,
        _radii(sketch),
        centers,
        tuple(_wheels(sketch)),
        guides,
        stretched(sketch.elements),
        {name: pose.angle * values for name, pose in sketch.poses.items()},
        (drive,),
        marks=in_order(
            (
                *_marks(sketch),
                *constraint_marks(sketch.rest.get("constraints", ()), sketch.bodies),
            )
        ),
        room=() if sketch.links else EMPTY,
    )


def _wheels(sketch: Sketch) -> list[Wheel]:
    """Pitch curves, as far as their wheels have their pins by now."""
    try:
        angles = {name: pose.angle for name, pose in sketch.poses.items()}
        return [*wheels_of(sketch.joints, sketch.bodies, angles)]
    except EquipoiseError:
        return []


def _marks(sketch: Sketch) -> Iterator[BodyMark]:
    """Signs of parts, as far as what they need is there."""
    around = Surroundings(sketch.to_machine, sketch.joints, sketch.bodies, _radii(sketch),
                          sketch.travel)  # fmt: skip
    for part in (*sketch.joints.couplings, *sketch.elements):
        with suppress(EquipoiseError, ValueError):
            yield from signs_of("", part, around)
    for key in ("loads", "timed_loads"):
        yield from load_line_marks(sketch.rest.get(key, ()))


def _radii(sketch: Sketch) -> dict[str, float]:
    """Of pins that are drawn to scale, by point, m."""
    return pin_radii(sketch.joints, sketch.rest.get("joints", ()))


def _sense(sketch: Sketch) -> DriveSign:
    drive = sketch.drive
    if drive is None:
        return DriveSign("", "", 0)
    pivots = [point for point in sketch.links[drive.link].points if point in sketch.frame]
    if len(pivots) != 1:
        return DriveSign(drive.link, "", 0)
    return DriveSign(drive.link, pivots[0], int(np.sign(drive.speed)))
