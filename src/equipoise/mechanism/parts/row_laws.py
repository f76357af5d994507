"""Laws of elements that are a constant or rows of a table, those of dampers among them.

Between rows lines are straight, and beyond them as between the last two: no branches.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, say, to_say
from equipoise.keys import KeyConditions, lacks, needs
from equipoise.mechanism.formulas.kernels import positive
from equipoise.mechanism.parts.element_kinds import RatedElement
from equipoise.quantities import Dimension, format_quantity

MOST_ROWS = 200
"""Of a table, each of which is a term of the law in compiled loops."""

Ramps = tuple[Any, Any, Any, tuple[tuple[Any, Any], ...]]
"""A place, the value and slope there; then places at which the slope changes, and by how much."""

ZERO = 1e-9
"""Of the largest effort of a table, below which its effort at standstill is rounding."""


def ramps_of(places: Sequence[Any], values: Sequence[Any]) -> Ramps:
    """The line through rows of a table, two or more."""
    rows = pairwise(zip(places, values, strict=True))
    slopes = [(v1 - v0) / (p1 - p0) for (p0, v0), (p1, v1) in rows]
    changes = (after - before for before, after in pairwise(slopes))
    return places[0], values[0], slopes[0], (*zip(places[1:-1], changes, strict=True),)


def ramp_value(ramps: Ramps, place: Any) -> Any:
    """Value of the line at a place."""
    start, value, slope, changes = ramps
    turned = (change * positive(place - at) for at, change in changes)
    return value + slope * (place - start) + sum(turned)


def table_value(places: Sequence[Any], values: Sequence[Any], place: Any) -> Any:
    """Value of a table at a place: linear between its rows, and as in the first and last beyond
    them.
    """
    if len(places) == 1:
        return values[0]
    first, last = places[0], places[-1]
    within = first + positive(place - first) - positive(place - last)
    return ramp_value(ramps_of(places, values), within)


def ramp_integral(ramps: Ramps, place: Any) -> Any:
    """Integral of the line from the first of its places to another."""
    start, value, slope, changes = ramps
    way = place - start
    turned = (0.5 * change * positive(place - at) ** 2 for at, change in changes)
    return way * (value + 0.5 * slope * way) + sum(turned)


def wrong_rows(
    where: str, keys: tuple[str, str], places: Sequence[Any], values: Sequence[Any]
) -> Iterator[ModelError]:
    """What is wrong with the rows of a table; keys : of both lists, as the file has them."""
    if len(places) != len(values):
        wrong = Note(
            "got {count} values in {places} and {others} in {values}; give as many of both",
            count=len(places),
            places=keys[0],
            others=len(values),
            values=keys[1],
        )
        yield ModelError(where, wrong)
    elif not 2 <= len(places) <= MOST_ROWS:
        wrong = Note("got {rows} rows; give 2 to {most}", rows=len(places), most=MOST_ROWS)
        yield ModelError(where, wrong)
    elif any(after <= before for before, after in pairwise(places)):
        yield ModelError(where, Note("the {what} must rise from row to row", what=keys[0]))


def one_law(constant: str, lists: tuple[str, str], beside: tuple[str, ...] = ()) -> KeyConditions:
    """What the JSON Schema says of an element that gives its law in one way; see `RowLaw`."""
    return {
        "oneOf": [
            {**needs(constant), **lacks(*lists, "table")},
            {**needs("table"), **lacks(constant, *beside, *lists)},
            {**needs(*lists), **lacks(constant, *beside, "table")},
        ]
    }


class TableRows:
    """An element with rows of a table: two lists of the file, or a CSV file with both.

    lists : keys of the lists, of places and of values.
    """

    lists: ClassVar[tuple[str, str]]
    table: Any

    @property
    def rows(self) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
        """Places and values of the rows, SI units; empty where there are none."""
        source, names = (
            (self, self.lists) if self.table is None else (self.table, self.table.forms[0])
        )
        places, values = (getattr(source, name) for name in names)
        return places, values

    def rising(self) -> Iterator[Any]:
        """What has to be true of the places of rows, or of columns of them."""
        return (after > before for before, after in pairwise(self.rows[0]))

    def rows_in_words(self, dimension: Dimension) -> str:
        """How many rows there are, and between which places; dimension : of these."""
        places = self.rows[0]
        first, last = (format_quantity(places[end], dimension) for end in (0, -1))
        return say("{count} rows from {first} to {last}", count=len(places), first=first, last=last)

    def wrong_rows(self, where: str) -> Iterator[ModelError]:
        """What is wrong with the rows."""
        yield from wrong_rows(self.rows_at(where), self.lists, *self.rows)

    def rows_at(self, where: str) -> str:
        """Where the file has the rows."""
        return f"{where}.{self.lists[0] if self.table is None else 'table'}"


class RowLaw(TableRows):
    """An element whose law is a constant, or rows.

    constant : key of the constant.  beside : keys that go with it alone.
    """

    constant: ClassVar[str]
    beside: ClassVar[tuple[str, ...]] = ()

    @property
    def idle_keys(self) -> tuple[str, ...]:
        """Keys that count for nothing beside rows."""
        return () if getattr(self, self.constant) is not None else self.beside

    def wrong_law(self, where: str) -> Iterator[ModelError]:
        """What is wrong with the constant and the rows."""
        listed = any(getattr(self, name) for name in self.lists)
        is_constant = getattr(self, self.constant) is not None
        if [is_constant, listed, self.table is not None].count(True) != 1:
            places, values = self.lists
            wrong = Note(
                "give exactly one of {constant}, {places} with {values}, and table",
                constant=self.constant,
                places=places,
                values=values,
            )
            yield ModelError(where, wrong)
        elif not is_constant:
            for name in self.beside:
                if getattr(self, name):
                    wrong = Note("goes with {constant}; the rows say it already, leave it out",
                                 constant=self.constant)  # fmt: skip
                    yield ModelError(f"{where}.{name}", wrong)
            yield from self.wrong_rows(where)


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
