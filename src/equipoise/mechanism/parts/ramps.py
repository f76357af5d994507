"""Straight lines between rows of a table, and beyond them as between the last two: no branches."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.formulas.kernels import positive

MOST_ROWS = 200
"""Of a table, each of which is a term of the law in compiled loops."""

Ramps = tuple[Any, Any, Any, tuple[tuple[Any, Any], ...]]
"""A place, the value and slope there; then places at which the slope changes, and by how much."""


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
