"""Numbers in sentences about what is wrong with them, in the units in which they were written.

What checks a machine knows floats in SI units.  Who wrote ``"-12 mm"`` into a file looks for -12
mm, so a sentence keeps its numbers as `Measured` values, and where the file is read each gets the
text that stands there (`as_written`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import replace
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.quantities.numbers import in_unit
from equipoise.quantities.reading import parse, pattern, plain_unit
from equipoise.quantities.units import SI, Dimension


@dataclass(frozen=True)
class Measured:
    """A quantity in a sentence.

    Attributes
    ----------
    value : in SI units and radians.
    dimension : what it is; None for a number without a unit.
    unit : in which it stands where nobody has written it; the SI unit if empty, degrees of angles.
    limit : whether it is set here, so that no equal number of a file is meant.
    """

    value: float
    dimension: Dimension | None
    unit: str = ""
    limit: bool = False

    def __str__(self) -> str:
        if self.dimension is None:
            return f"{self.value:g}"
        unit = self.unit or ("deg" if self.dimension == "angle" else SI[self.dimension])
        return f"{in_unit(unit).factor * self.value:g} {unit}"


def with_measured(sentence: Note, change: Callable[[Measured], Any]) -> Note:
    """A sentence with other values for the quantities in it."""

    return sentence.with_values(lambda item: change(item) if isinstance(item, Measured) else item)


def as_written(sentence: Note, texts: Iterable[str]) -> Note:
    """A sentence with each quantity as it was written, and what else is of its dimension, such as
    a limit, in the unit of the first of those.

    texts : of a file, such as ``"-12 mm"``, whatever they are of; of equal quantities the first
        counts.
    """
    written = [*texts]
    units: dict[Dimension | None, str] = {}

    def typed(amount: Measured) -> Any:
        if amount.dimension is None or amount.limit:
            return amount
        for text in written:
            match = re.fullmatch(pattern(amount.dimension), text)
            with suppress(UsageError):
                if match and parse(text, amount.dimension) == amount.value:
                    units.setdefault(amount.dimension, plain_unit(match[2]))
                    short = f"{float(match[1]):g} {match[2]}"  # of -1.0 kg, as programs write it
                    return short if parse(short, amount.dimension) == amount.value else text
        return amount

    def alike(amount: Measured) -> Any:
        return replace(amount, unit=units.get(amount.dimension, amount.unit))

    return with_measured(with_measured(sentence, typed), alike)
