"""Resistances as arrowheads against the motion, or as a pad where they have no direction."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.mechanism.parts.resistances import Resistance
from equipoise.symbols.part_signs import Surroundings
from equipoise.symbols.shapes import BodyMark, sign

HEAD, APART, COUNT = 7.0, 6.0, 3
"""Size of an arrowhead, units, from one to the next, and how many there are."""
RADIUS = 11.0
"""Of a pad, units."""


def resistance_sign(resistance: Resistance, _: Surroundings) -> Iterator[BodyMark]:
    """Arrowheads at the other point, against the direction; a crossed circle about the point."""
    if resistance.direction is None:
        rim = RADIUS * np.exp(1j * np.linspace(0, 2 * np.pi, 32))
        yield BodyMark(resistance.link, resistance.point, sign("resistance", 0j, rim))
        stroke = RADIUS * np.exp(1j * np.array([0.25, 1.25]) * np.pi)
        yield BodyMark(resistance.link, resistance.point, sign("resistance", 0j, stroke))
        return
    way = np.exp(1j * resistance.direction)
    for place in APART * np.arange(COUNT):
        head = np.array([place + HEAD * (1 + 1j), place, place + HEAD * (1 - 1j)]) * way
        yield BodyMark(resistance.on, resistance.to, sign("resistance", 0j, head))
