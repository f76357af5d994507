"""Signs of geometric constraints on their lines, as in textbooks of geometry."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType

import numpy as np

from equipoise.i18n import to_say
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.constraints import Constraint
from equipoise.symbols.shapes import BodyMark, sign

LINES: Mapping[str, tuple[tuple[complex, ...], ...]] = MappingProxyType({
    "equal": ((-2 - 7j, -2 + 7j), (2 - 7j, 2 + 7j)),
    "parallel": ((-5 + 6j, 1, -5 - 6j), (0 + 6j, 6, 0 - 6j)),
    "perpendicular": ((0, 9j), (4 + 0j, 4 + 4j, 4j)),
    "in line": ((-9, -4), (-2.5, 2.5), (4, 9)),
})  # fmt: skip
"""Corners of the strokes of each kind, units; the line of the body along x."""
WHERE: Mapping[str, float] = MappingProxyType({
    "equal": 0.5, "parallel": 0.42, "perpendicular": 0.6, "in line": 0.35,
})  # fmt: skip
"""Share of a line at which each kind has its sign, so that a line with several shows them all."""
LEGEND = "constraint", to_say("geometric constraint")


def constraint_marks(constraints: Iterable[Constraint], bodies: Bodies) -> Iterator[BodyMark]:
    """The signs on both lines of each; none where a point is not there yet."""
    for one in constraints:
        if any(one.problems("", bodies)):
            continue
        for (body, start), (_, end) in one.lines(bodies):
            way = complex(*bodies[body][end]) - complex(*bodies[body][start])
            turn = way / abs(way) if way else 1.0
            for stroke in LINES[one.kind]:
                shape = sign("constraint", way * WHERE[one.kind], np.array(stroke) * turn)
                yield BodyMark(body, start, shape, table="constraints", legend=LEGEND)
