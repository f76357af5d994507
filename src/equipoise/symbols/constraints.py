"""Signs of geometric constraints on their lines, as in textbooks of geometry."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import to_say
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.constraints import HOLDS, Constraint
from equipoise.symbols.shapes import BodyMark, sign


@dataclass(frozen=True)
class ConstraintSign:
    """The sign of a kind of constraint.

    at : share of the line at which it stands; each kind has another, so that a line with several
        shows them all.
    strokes : corners of each, complex, units; the line of the body along x.
    """

    at: float
    strokes: tuple[tuple[complex, ...], ...]


SIGNS: Mapping[str, ConstraintSign] = MappingProxyType({
    "equal": ConstraintSign(0.5, ((-2 - 7j, -2 + 7j), (2 - 7j, 2 + 7j))),
    "parallel": ConstraintSign(0.42, ((-5 + 6j, 1, -5 - 6j), (0 + 6j, 6, 0 - 6j))),
    "perpendicular": ConstraintSign(0.6, ((0, 9j), (4 + 0j, 4 + 4j, 4j))),
    "in line": ConstraintSign(0.35, ((-9, -4), (-2.5, 2.5), (4, 9))),
})  # fmt: skip
"""Of each kind."""
LEGENDS = {
    True: ("constraint", to_say("geometric constraint")),
    False: ("missed-constraint", to_say("geometric constraint that does not hold")),
}
"""Role and name of a sign, by whether its constraint holds."""


def constraint_marks(constraints: Iterable[Constraint], bodies: Bodies) -> Iterator[BodyMark]:
    """The signs on both lines of each, in another colour and dashed where these places miss it;
    none where a point is not there yet.
    """
    for constraint in constraints:
        if any(constraint.problems("", bodies)):
            continue
        legend = LEGENDS[constraint.misses(bodies) <= HOLDS]
        for (body, start), (_, end) in constraint.lines(bodies):
            way = complex(*bodies[body][end]) - complex(*bodies[body][start])
            turn = way / abs(way) if way else 1.0
            constraint_sign = SIGNS[constraint.kind]
            for stroke in constraint_sign.strokes:
                shape = sign(legend[0], way * constraint_sign.at, np.array(stroke) * turn)
                yield BodyMark(body, start, shape, table="constraints", legend=legend)
