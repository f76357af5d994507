"""Straight lines of belts and racks: strands between their pulleys, and pitch lines."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.mechanism.builder import Guide
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.joints import Structure, coupling_pins
from equipoise.mechanism.motion import Motion
from equipoise.mechanism.strands import LEFT, RIGHT
from equipoise.symbols.shapes import Mark, line


def strands_of(joints: Structure, bodies: Bodies) -> Iterator[Mark]:
    """Both strands of every belt."""
    for belt in (one for one in joints.couplings if one.table == "belts"):
        driver, driven = coupling_pins(joints, belt)
        points = bodies[belt.carrier]
        strands = belt.strands(complex(*points[driven]) - complex(*points[driver]))  # type: ignore[attr-defined]
        for side in (LEFT, RIGHT):
            yield Mark(belt.carrier, driver, line("strand", *strands.ends(side)))


def racks_of(motion: Motion) -> Iterator[Mark]:
    """The pitch line of every rack, as long as its pinion rolls on it, and a radius more."""
    machine, joints = motion.machine, motion.linkage.joints
    for rack in machine.racks:
        pair = (rack.rack, rack.carrier)
        slider = next(one for one in machine.sliders if (one.link, one.on) == pair)
        guide = Guide.seen_from(slider, rack.carrier)
        points = machine.points_of(rack.carrier)
        (pin,) = joints.pins_between(rack.pinion, rack.carrier)
        foot = (complex(*points[pin]) - complex(*points[guide.base])) / guide.along
        foot -= 1j * rack.left * rack.radius
        reach = foot.real - motion.sliders[slider.name].travel
        low, high = float(np.min(reach)) - rack.radius, float(np.max(reach)) + rack.radius
        ends = (complex(end, foot.imag) / guide.turn for end in (low, high))
        yield Mark(rack.rack, guide.point, line("strand", *ends))
