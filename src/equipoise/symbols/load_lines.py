"""Loads in the line between two points: a dashed line with an arrow at both ends."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from equipoise.i18n import to_say
from equipoise.mechanism.parts.lines import AlongLine
from equipoise.symbols.shapes import BodyMark, Shape

LEGEND = "pull", to_say("force between two points")
HEAD = np.array([14 + 5j, 22 + 0j, 14 - 5j])
"""Corners of an arrow that begins at an end, units; x along the line."""
SHAPES = (
    Shape("pull", np.array([0j, 1 + 0j]), np.zeros(2, complex)),
    Shape("pull-head", np.zeros(3, complex), HEAD),
    Shape("pull-head", np.ones(3, complex), -HEAD),
)
"""Along over the length of the line."""


def load_line_marks(loads: Iterable[AlongLine]) -> Iterator[BodyMark]:
    """The signs of those loads that act in a line between two points."""
    for load in loads:
        if load.toward is None or load.point is None:
            continue
        for shape in SHAPES:
            yield BodyMark(load.link, load.point, shape, legend=LEGEND, to=load.toward)
