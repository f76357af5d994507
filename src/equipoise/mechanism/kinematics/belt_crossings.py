"""Strands of belts that lie across links of their carriers."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees

import numpy as np

from equipoise.i18n import Note
from equipoise.mechanism.assembly.joints import coupling_pins, place_in_file
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.formulas.kernels import cross
from equipoise.mechanism.formulas.rolling import LEFT, RIGHT
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.machine import FRAME
from equipoise.signals import Array

ANGLES = 72
"""In a turn, at which it is looked."""


def crossings(linkage: Linkage) -> Iterator[Note]:
    """A sentence on each belt and link of its carrier that do not pass each other.

    Links that turn about the pin of a pulley lie beside it anyway, and so do those in a plane of
    their own.
    """
    machine, joints = linkage.machine, linkage.joints
    motion = move(machine, ANGLES)
    for belt in machine.belts:
        pulleys = [machine.links[item] for item in (belt.driver, belt.driven) if item != FRAME]
        planes = {pulley.plane for pulley in pulleys}
        for pin, bodies in joints.pins.items():
            if belt.carrier not in bodies or pin in coupling_pins(joints, belt):
                continue
            for link in bodies:
                if link in (belt.carrier, FRAME) or link in joints.riders:
                    continue
                if machine.links[link].plane not in planes:
                    continue
                at = motion.crank_angle[_across(motion, belt, pin, link)]
                if at.size:
                    yield Note(
                        "{place}: a strand lies across {link!r} at crank angle {angle:.4g} deg; "
                        "move {pin}, change the radii, or give {link!r} a plane of its own",
                        place=place_in_file(joints, belt),
                        link=link,
                        angle=degrees(float(at[0])),
                        pin=pin,
                    )


def _across(motion: Motion, belt: Belt, pin: str, link: str) -> Array:
    """Whether a strand lies across the way from a link's pin to any other of its points (N,)."""
    first, second = (
        motion.point(coupling_pin).place
        for coupling_pin in coupling_pins(motion.linkage.joints, belt)
    )
    strands = belt.strands(second - first)
    root, values = motion.point(pin).place, np.zeros(motion.crank_angle.shape, bool)
    for tip in motion.machine.links[link].points:
        arm = motion.point(tip).place - root
        for side in (LEFT, RIGHT):
            begin, end = (first + end - root for end in strands.ends(side))
            way = end - begin
            apart = cross(arm, begin) * cross(arm, end) < 0
            values |= apart & (cross(way, begin) * cross(way, begin - arm) < 0)
    return values
