"""What is straight of belts and racks: strands between pulleys, and bars with teeth."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi, radians, tan

import numpy as np

from equipoise.mechanism.assembly.builder import Guide
from equipoise.mechanism.assembly.joints import coupling_pins
from equipoise.mechanism.formulas.rolling import LEFT, RIGHT
from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.racks import Rack
from equipoise.signals import Array
from equipoise.symbols.part_signs import Surroundings
from equipoise.symbols.shapes import BodyMark, line

MOST_TEETH = 80
"""That are drawn of a rack."""
SLOPE = tan(radians(20))
"""Of their flanks."""


def strand_sign(belt: Belt, around: Surroundings) -> Iterator[BodyMark]:
    """Both strands, but where one pulley covers the other, as it may in a sketch."""
    driver, driven = coupling_pins(around.joints, belt)
    points = around.bodies[belt.carrier]
    strands = belt.strands(complex(*points[driven]) - complex(*points[driver]))
    if not strands.distance > abs(strands.radius - strands.other):
        return
    for side in (LEFT, RIGHT):
        strand = line("strand", *strands.ends(side))
        yield BodyMark(belt.carrier, driver, strand, (belt.list_name, belt.name))


def rack_sign(rack: Rack, around: Surroundings) -> Iterator[BodyMark]:
    """The rack, as far as its pinion rolls on it, and a radius more; a sketch may lack its guide or
    its pin.
    """
    guides = around.joints.guides(rack)
    pins = around.joints.pins_between(rack.pinion, rack.carrier)
    if not guides or len(pins) != 1:
        return
    guide = Guide.seen_from(guides[0], rack.carrier)
    points = around.bodies[rack.carrier]
    foot = (complex(*points[pins[0]]) - complex(*points[guide.base])) / guide.along
    foot -= 1j * rack.left * rack.radius
    reach = foot.real - around.travel(guides[0])
    low, high = float(np.min(reach)) - rack.radius, float(np.max(reach)) + rack.radius
    toward = 1j * rack.left  # the pinion, of a bar along the x axis
    corners = low + 1j * foot.imag + _bar(high - low, rack.radius, toward)
    bar = line("wheel", *(corners / guide.turn), closed=True)
    yield BodyMark(rack.rack, guide.point, bar, (rack.list_name, rack.name))


def _bar(length: float, radius: float, toward: complex) -> Array:
    """Corners of a bar whose pitch line begins at 0, with teeth; `toward` is the way these point.

    A file says nothing of the teeth's size; it has to do with the pinion's, and be seen.
    """
    count = max(1, min(MOST_TEETH, round(10 * length / (pi * radius))))
    pitch = length / count
    module = pitch / pi
    root, top = (pitch / 4 + sign * deep * module * SLOPE for sign, deep in ((1, 1.25), (-1, 1.0)))
    tooth = [-root - 1.25j * module, -top + 1j * module, top + 1j * module, root - 1.25j * module]
    teeth = (np.arange(count)[:, None] + 0.5) * pitch + np.array(tooth)
    square = np.array([-3.5j, -1.25j]) * module
    corners = np.array([*square, *teeth.ravel(), *(length + square[::-1])])
    return np.asarray(corners.real + corners.imag * toward)
