"""What dampers share: a resistance proportional to a speed, or by a table of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note, say, to_say
from equipoise.mechanism.parts.force_kinds import RatedElement
from equipoise.mechanism.parts.ramps import ramp_value, ramps_of
from equipoise.mechanism.parts.row_laws import RowLaw
from equipoise.quantities import Dimension, format_quantity

ZERO = 1e-9
"""Of the largest effort of a table, below which its effort at standstill is rounding."""


class Damping(RowLaw, RatedElement):
    """A damper, which resists one speed between its bodies."""

    cause = "damper"
    cause_label = to_say("dampers")
    constant = "damping"

    damping: Any

    @property
    def linear(self) -> bool:
        return self.damping is not None

    def size(self, dimension: Dimension, unit: str) -> str:
        """Its damping, of a dimension, in a unit, or how many rows it has."""
        if self.damping is None:
            return say("{count} rows", count=len(self.rows[0]))
        return format_quantity(self.damping, dimension, unit)

    def resistance(self, speed: Any) -> Any:
        """What it resists a speed with, of the sign of this."""
        if self.damping is not None:
            return self.damping * speed
        return ramp_value(ramps_of(*self.rows), speed)

    def efforts(self, ways: Sequence[tuple[Any, Any]]) -> tuple[Any, ...]:
        """What it exerts on its link along its way, or about its axis."""
        ((_, speed),) = ways
        return (-self.resistance(speed),)

    def wrong_rows(self, where: str) -> Iterator[ModelError]:
        """What is wrong with the rows, by which it must not drive."""
        wrong = [*super().wrong_rows(where)]
        yield from wrong or self._driving(self.rows_at(where))

    def _driving(self, where: str) -> Iterator[ModelError]:
        """A table by which it would not resist, but drive."""
        speeds, efforts = self.rows
        at_rest = ramp_value(ramps_of(speeds, efforts), 0.0)
        if abs(at_rest) > ZERO * max(map(abs, efforts)):
            wrong = Note("a damper exerts nothing at standstill; give a row of speed 0 with 0")
            yield ModelError(where, wrong)
        elif any(after < before for before, after in pairwise(efforts)):
            wrong = Note(
                "a damper resists faster motion no less; the {what} must not fall from row to row",
                what=self.lists[1],
            )
            yield ModelError(where, wrong)

    def demands(self) -> Iterator[Any]:
        """What has to be true of its damping and speeds, or of columns of them."""
        if self.damping is not None:
            yield self.damping >= 0
        yield from self.rising()
