"""Stops as hatched lines, across the direction in which they push."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.mechanism.parts.stops import Stop
from equipoise.symbols.part_signs import Surroundings
from equipoise.symbols.shapes import BodyMark, sign

HALF, STROKES, DEEP = 14.0, 5, 6.0
"""Half the length of the line, units; strokes of its hatching, and how deep these are."""


def stop_sign(stop: Stop, _: Surroundings) -> Iterator[BodyMark]:
    """A line through the point of the stop, hatched behind."""
    way = np.exp(1j * stop.direction)
    yield BodyMark(stop.on, stop.to, sign("stop", 0j, [1j * HALF * way, -1j * HALF * way]))
    for place in np.linspace(-HALF, HALF, STROKES):
        begin = 1j * place * way
        stroke = [begin, begin - DEEP * (1 + 1j) * way]
        yield BodyMark(stop.on, stop.to, sign("stop", 0j, stroke))
