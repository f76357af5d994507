"""Where points have to go so that geometric constraints hold."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import chain

import numpy as np

from equipoise.decompositions import lstsq
from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.checks import Bodies, Vector
from equipoise.mechanism.parts.constraints import (
    ACROSS,
    HOLDS,
    IN_LINE,
    MISSES,
    BodyLine,
    BodyPoint,
    Constraint,
)
from equipoise.quantities import clean_place
from equipoise.signals import Array

SOLVED = 1e-12
"""Far below `HOLDS`, and well above the rounding of its equations in double precision."""
MOST_STEPS = 60
"""It needs 5 to 30, fewer the less points have to move."""
RANK = 1e-9
"""Of the largest singular value: smaller ones belong to equations that say the same."""
STEP = 1e-30
"""Of complex steps, which lose no digits however small they are."""


class ConstraintEquations:
    """Constraints of a machine as equations of the coordinates of points."""

    def __init__(self, constraints: Sequence[Constraint], bodies: Bodies) -> None:
        self.kinds = [MISSES[constraint.kind] for constraint in constraints]
        self.lines = [constraint.lines(bodies) for constraint in constraints]
        points = dict.fromkeys(chain.from_iterable(chain.from_iterable(self.lines)))
        self.places = {(body, point): np.array(bodies[body][point]) for body, point in points}

    @property
    def size(self) -> float:
        """Length of the longest line, m."""
        lines = chain.from_iterable(self.lines)
        return max(float(np.hypot(*(self.places[b] - self.places[a]))) for a, b in lines)

    def residuals(self, places: Mapping[BodyPoint, Array]) -> Array:
        """Residual of each equation at places (2,), m, of the points."""
        rows = []
        for miss, ((a, b), (c, d)) in zip(self.kinds, self.lines, strict=True):
            rows += miss((places[a], places[b]), (places[c], places[d]))
        return np.array(rows)

    @property
    def residual(self) -> float:
        """The largest residual in size; infinite where a line has no length."""
        with np.errstate(all="ignore"):
            worst = float(np.max(np.abs(self.residuals(self.places))))
        return worst if np.isfinite(worst) else np.inf

    def solve(self, movers: Sequence[BodyPoint]) -> bool:
        """Move points, as little as possible, until all equations hold; whether they do.

        Each step goes to the place nearest to the start at which the equations hold to first
        order, so that where it ends no nearer one holds them.
        """
        start = np.array([self.places[point] for point in movers]).ravel()
        way = np.zeros_like(start)
        for _ in range(MOST_STEPS if movers else 0):
            residuals, slopes = self.residuals(self.places), self._slopes(movers)
            if not (np.isfinite(residuals).all() and np.isfinite(slopes).all()):
                return False
            before, way = way, lstsq(slopes, slopes @ way - residuals, RANK)[0]
            for point, place in zip(movers, (start + way).reshape(-1, 2), strict=True):
                self.places[point] = place
            at_rest = float(np.abs(way - before).max()) <= SOLVED * self.size
            if at_rest and self.residual <= SOLVED:
                return True
        return self.residual <= HOLDS

    def _slopes(self, movers: Sequence[BodyPoint]) -> Array:
        """Derivatives of the equations by the coordinates of movers, by complex steps."""
        columns = []
        for point in movers:
            for axis in (0, 1):
                turned = self.places[point].astype(complex)
                turned[axis] += 1j * STEP
                columns.append(self.residuals({**self.places, point: turned}).imag / STEP)
        return np.array(columns).T


def constrained(
    constraints: Sequence[Constraint],
    bodies: Bodies,
    changed: frozenset[BodyPoint] = frozenset(),
    given: frozenset[BodyPoint] = frozenset(),
) -> dict[BodyPoint, Vector]:
    """Points that have to go elsewhere so that constraints hold.

    An end moves of the second line of each constraint that is missed, or of the first where that
    cannot.  Where it does not do, such ends of all constraints move, or else all points of lines
    that may, as little as possible.

    Parameters
    ----------
    bodies : points of each, in its own axes, m.
    changed : points that were just put where they are, and stay.
    given : points whose places are worked out from parameters; the end of the other line moves
        rather than they.

    Returns
    -------
    The new places of points that moved, m.

    Raises
    ------
    ModelError : no places were found at which all of them hold.
    """
    if not constraints:
        return {}
    start = ConstraintEquations(constraints, bodies)
    if start.residual <= SOLVED:
        return {}
    for staying in dict.fromkeys((changed, frozenset[BodyPoint]())):
        ends = [_ends(constraint.kind, lines, staying, given)
                for constraint, lines in zip(constraints, start.lines, strict=True)]  # fmt: skip
        violated = [end for end, constraint in zip(ends, constraints, strict=True)
                  if constraint.misses(bodies) > SOLVED]  # fmt: skip
        everything = start.places.keys() - staying
        for moving in ({*chain(*violated)}, {*chain(*ends)}, everything):
            problem = ConstraintEquations(constraints, bodies)
            if problem.solve(sorted(moving)):
                return _moved(start.places, problem.places, problem.size)
    what = Note("cannot all hold with these places; give other ones, or take one of them away")
    raise ModelError("constraints", what)


def _ends(
    kind: str,
    lines: tuple[BodyLine, BodyLine],
    staying: frozenset[BodyPoint],
    given: frozenset[BodyPoint],
) -> list[BodyPoint]:
    """The points that move for a constraint: ends of its second line, or of its first where those
    stay.  Of two lengths that which was changed keeps its value.
    """
    (a, b), (c, d) = lines
    if kind == IN_LINE and staying.isdisjoint({c, d} - {a, b}):
        return [point for point in (c, d) if point not in (a, b)]
    order = *sorted((d, b), key=lambda point: point in given), c, a
    first, second = (not staying.isdisjoint(line) for line in lines)
    if kind in ACROSS and first != second:
        order = (d, c, b, a) if first else (b, a, d, c)
    free = [point for point in order if point not in staying]
    return free if kind == IN_LINE else free[:1]


def _moved(
    before: Mapping[BodyPoint, Array], after: Mapping[BodyPoint, Array], size: float
) -> dict[BodyPoint, Vector]:
    moved = {}
    for point, place in after.items():
        if np.abs(place - before[point]).max() > SOLVED * size:
            moved[point] = clean_place(complex(*place), size)
    return moved
