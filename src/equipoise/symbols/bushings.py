"""Bushings as two rings, the inner one with the link, the outer one with the other body."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.mechanism.parts.bushings import Bushing
from equipoise.symbols.part_signs import Surroundings
from equipoise.symbols.shapes import BodyMark, sign

INNER, OUTER, TICKS = 6.5, 13.0, 8
"""Radii, units, and spokes of the outer ring, which end between both."""


def bushing_sign(bushing: Bushing, _: Surroundings) -> Iterator[BodyMark]:
    """A ring at the point of the link, and a larger one with spokes at the other point."""
    circle = np.exp(1j * np.linspace(0, 2 * np.pi, 48))
    yield BodyMark(bushing.link, bushing.point, sign("bushing", 0j, INNER * circle))
    yield BodyMark(bushing.on, bushing.to, sign("bushing", 0j, OUTER * circle))
    turned = np.exp(1j * (bushing.direction + 2 * np.pi * np.arange(TICKS) / TICKS))
    for way in turned:
        spoke = np.array([OUTER, 0.5 * (INNER + OUTER)]) * way
        yield BodyMark(bushing.on, bushing.to, sign("bushing", 0j, spoke))
