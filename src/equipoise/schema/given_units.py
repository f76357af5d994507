"""The units in which files give numbers, for whoever shows others of them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from equipoise.quantities.units import KINDS, NUMBER, Dimension, plain_unit
from equipoise.schema.finding import Found
from equipoise.schema.numbers import XYZ, read_number

SHARE = "%"
_QUANTITY = re.compile(rf"{NUMBER} +(\S.*)")


def unit_in(content: Mapping[str, Any], found: Found) -> str:
    """Unit in which a model file gives a number; one that is usual where it has none.

    Returns
    -------
    str
        ``mm``, ``%`` of a share, nothing of a plain number.
    """
    number = found.number
    if number is None or number.share:
        return SHARE if number is not None else ""
    if number.dimension is None:
        return ""
    for given in _given(content, found):
        read = read_number(given)
        if read is not None and read.dimension == number.dimension:
            return unit_of(given)
    return handy(number.dimension)


def unit_of(given: str) -> str:
    """Unit of a quantity that can be read, as the lists have it."""
    match = _QUANTITY.fullmatch(given)
    return "" if match is None else plain_unit(match[1])


def handy(dimension: Dimension) -> str:
    """Unit in which quantities of a dimension are usually told."""
    return KINDS[dimension].printed[0]


def _given(content: Mapping[str, Any], found: Found) -> Iterator[Any]:
    """What stands in the file where a number does: first its own text, then those beside it."""
    here: Any = content
    for key in found.place:
        if isinstance(here, dict) and key not in here:
            return  # left out, so that a default stands for it
        here = here[key]
    if isinstance(here, dict):
        yield from (here[key] for key in sorted(here, key=lambda key: key != found.part))
    elif isinstance(here, list):
        yield from here[XYZ.index(found.part) :] if found.part in XYZ else ()
        yield from here
    else:
        yield here
