"""Curves on which pins run, in terms."""

from __future__ import annotations

from math import pi, tau
from typing import Any

import numpy as np

from equipoise.codegen.coupled import MOST_BINS, Pieces, bins
from equipoise.codegen.terms import VectorTerm, angle_of, floor, greatest, select
from equipoise.codegen.trace import Array, Trace
from equipoise.mechanism.formulas.curve_kernels import plane_piece
from equipoise.mechanism.formulas.curves import MOST_POWERS, PeriodicCurve
from equipoise.mechanism.formulas.plane_curves import PlaneCurve

FEW = 2
"""Pieces that are told apart by comparing: of a dozen numbers each, more take long to compile."""


class TracedCurve:
    """A `PlaneCurve`, which no design changes, at parameters that are terms."""

    def __init__(self, trace: Trace, curve: PlaneCurve) -> None:
        self.trace, self.curve, self.closed = trace, curve, curve.closed

    def at(self, s: Any) -> tuple[Any, ...]:
        """Place and its first three derivatives by the parameter."""
        way, pieces = self._place(s, self.curve.knots)
        powers = [
            VectorTerm(pieces.value(item.real), pieces.value(item.imag))
            for item in self.curve.powers.T
        ]
        return tuple(plane_piece(way, *powers))  # type: ignore[no-untyped-call]

    def distance(self, s: Any) -> Any:
        """Arc length from the beginning, m."""
        knots, powers = self.curve.arcs
        way, pieces = self._place(s, knots)
        return plane_piece(way, *map(pieces.value, powers.T))[0]  # type: ignore[no-untyped-call]

    def turned(self, rotation: Any) -> Any:
        """The parameter of a closed curve, of which exp(i s) is known: by halves of a turn, as the
        angles that loops compute are.
        """
        ahead = select(rotation.real, 0.0, 1.0, -1.0)
        return angle_of(rotation * ahead) + select(rotation.real, 0.0, 0.0, pi)

    def _place(self, s: Any, knots: Array) -> tuple[Any, Pieces]:
        """The way into the piece between knots, and what finds the numbers of this."""
        if self.closed:
            s = s - tau * floor(s * (1 / tau))
        count = len(knots) - 1
        curve = PeriodicCurve(knots, np.zeros((count, MOST_POWERS)), np.zeros((count, 3)))
        pieces = Pieces(self.trace, curve, greatest(0.0, s), FEW)
        return s - pieces.beginning(), pieces


def can_look_up(curve: PlaneCurve) -> bool:
    """Whether the piece of a curve can be looked up."""
    return bins(curve.arcs[0]) <= MOST_BINS
