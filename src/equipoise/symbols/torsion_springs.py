"""Torsion springs as spirals about the pin that both of their bodies share."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.mechanism.parts.torsion_springs import TorsionSpring
from equipoise.signals import Array
from equipoise.symbols.part_signs import Surroundings
from equipoise.symbols.shapes import BodyMark, sign

INNER, OUTER, TURNS, CORNERS = 6.0, 17.0, 2.25, 64
"""Radii of the spiral, units; its turns, and the corners of its line."""
END = 6.0
"""Units, of the straight end that holds on to the link."""


def torsion_sign(spring: TorsionSpring, around: Surroundings) -> Iterator[BodyMark]:
    """A spiral that turns with the link."""
    point = around.pin_between(spring.link, spring.on)
    yield BodyMark(spring.link, point, sign("spiral", 0j, spiral()))


def spiral() -> Array:
    """Corners of the line, complex, units."""
    share = np.linspace(0.0, 1.0, CORNERS)
    line = (INNER + (OUTER - INNER) * share) * np.exp(2j * np.pi * TURNS * share)
    return np.append(line, line[-1] * (1 + END / OUTER))
