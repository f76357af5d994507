"""Dampers as pistons in cylinders between their points; torsion dampers as vanes about a pin."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.mechanism.parts.dampers import Damper
from equipoise.mechanism.parts.torsion_dampers import TorsionDamper
from equipoise.symbols.part_signs import Surroundings
from equipoise.symbols.shapes import PISTON, BodyMark, Shape, sign

HALF = 6.0
"""Half the width of the cylinder, units."""
RADIUS, OPEN, VANE = 14.0, 0.35, (4.0, 11.0)
"""Radius of the housing of a torsion damper, its opening, rad, and both ends of its vane, units."""


def damper_sign(damper: Damper, _: Surroundings) -> Iterator[BodyMark]:
    """A piston in a cylinder, from the link's point to the other."""
    for part in PISTON:
        shape = Shape("damper", part.real + 0j, 1j * HALF * part.imag)
        yield BodyMark(damper.link, damper.point, shape, to=damper.to)


def torsion_damper_sign(damper: TorsionDamper, around: Surroundings) -> Iterator[BodyMark]:
    """A vane that turns with the link in an open housing."""
    point = around.pin_between(damper.link, damper.on)
    housing = RADIUS * np.exp(1j * np.linspace(OPEN, 2 * np.pi - OPEN, 48))
    yield BodyMark(damper.link, point, sign("vane", 0j, housing))
    yield BodyMark(damper.link, point, sign("vane", 0j, -np.array(VANE)))
