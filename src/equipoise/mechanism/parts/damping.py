"""What dampers share: a resistance proportional to a speed, or by a table of it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import Conditions, lacks, needs
from equipoise.mechanism.parts.force_kinds import RatedElement
from equipoise.mechanism.parts.ramps import ramp_value, ramps_of, wrong_rows

ZERO = 1e-9
"""Of the largest effort of a table, below which its effort at standstill is rounding."""


def one_law(efforts: str) -> Conditions:
    """Check that a damper gives its resistance in one way; efforts : key of the list of them."""
    return {
        "oneOf": [
            {**needs("damping"), **lacks("speeds", efforts, "table")},
            {**needs("table"), **lacks("damping", "speeds", efforts)},
            {**needs("speeds", efforts), **lacks("damping", "table")},
        ]
    }


class Damping(RatedElement):
    """A damper, which resists one speed between its bodies.

    efforts_key : key of the list of what it resists with, beside `speeds`.
    """

    cause = "damper"
    cause_label = to_say("dampers")
    efforts_key: ClassVar[str]

    damping: Any
    speeds: tuple[float, ...]
    table: Any

    @property
    @abstractmethod
    def rows(self) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
        """Speeds and efforts of a table; empty of a linear damper."""

    @property
    def linear(self) -> bool:
        return self.damping is not None

    def resistance(self, speed: Any) -> Any:
        """What it resists a speed with, of the sign of this."""
        if self.damping is not None:
            return self.damping * speed
        return ramp_value(ramps_of(*self.rows), speed)

    def efforts(self, ways: Sequence[tuple[Any, Any]]) -> tuple[Any, ...]:
        """What it exerts on its link along its way, or about its axis."""
        ((_, speed),) = ways
        return (-self.resistance(speed),)

    def wrong_law(self, where: str, given_twice: Note, uneven: Note) -> Iterator[ModelError]:
        """What is wrong with its resistance.

        given_twice : sentence for less or more than one law.  uneven : for lists of different
            lengths.
        """
        listed = bool(self.speeds or getattr(self, self.efforts_key))
        if [self.damping is not None, listed, self.table is not None].count(True) != 1:
            yield ModelError(where, given_twice)
        elif self.damping is None:
            at = f"{where}.table" if self.table is not None else f"{where}.speeds"
            falling = Note("the speeds must rise from row to row")
            wrong = [*wrong_rows(at, *self.rows, uneven, falling)]
            yield from wrong or self._driving(at)

    def _driving(self, where: str) -> Iterator[ModelError]:
        """A table by which it would not resist, but drive."""
        speeds, efforts = self.rows
        at_rest = ramp_value(ramps_of(speeds, efforts), 0.0)
        if abs(at_rest) > ZERO * max(map(abs, efforts)):
            wrong = Note("a damper exerts nothing at standstill; give a row of speed 0 with 0")
            yield ModelError(where, wrong)
        elif any(after < before for before, after in pairwise(efforts)):
            wrong = Note("a damper resists faster motion no less; let the second column not fall")
            yield ModelError(where, wrong)

    def demands(self) -> Iterator[Any]:
        """What has to be true of its damping and speeds, or of columns of them."""
        if self.damping is not None:
            yield self.damping >= 0
        yield from (after > before for before, after in pairwise(self.rows[0]))
