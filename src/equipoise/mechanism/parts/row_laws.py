"""Laws of elements that are a constant, or rows of a table."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, say
from equipoise.keys import Conditions, lacks, needs
from equipoise.mechanism.parts.ramps import wrong_rows
from equipoise.quantities import Dimension, format_quantity


def one_law(constant: str, lists: tuple[str, str], beside: tuple[str, ...] = ()) -> Conditions:
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
