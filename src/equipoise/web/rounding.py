"""Numbers that a page makes by arithmetic, with the digits that a file needs and no more.

Sliders, drags and counterweights leave 1.2369999999999999 kg where 1.237 kg is meant.  They are
rounded when they are made, so that the machine that is computed is the one that is written.
"""

from __future__ import annotations

from math import floor, isfinite, log10

from equipoise.mechanism.model import Vector
from equipoise.quantities import parse, rounded
from equipoise.quantities.units import HUGE, TINY, Dimension

DIGITS, SHORT = 12, 9
"""Significant ones that are kept, and those of a number that somebody may have meant in SI."""
OTHER: dict[Dimension, str] = {"angle": "deg", "angular speed": "rpm"}
"""Units of files that are no power of ten of the SI unit."""


def clean(value: float, dimension: Dimension | None = None) -> float:
    """A value (SI units, radians) of 12 digits, in the unit in which a file has it."""
    unit = None if dimension is None else OTHER.get(dimension)
    plain = float(f"{value:.{DIGITS}g}")
    short = plain == float(f"{value:.{SHORT}g}")
    if dimension is None or unit is None or short or not TINY < abs(value) < HUGE:
        return plain
    return parse(rounded(value, unit, DIGITS), dimension)


def clean_place(place: complex, size: float = 0.0) -> Vector:
    """Coordinates (m) whose last digit is the 12th of the longer one, or of a size."""
    longest = max(abs(place.real), abs(place.imag), size)
    if not longest or not isfinite(longest):
        return place.real, place.imag
    last = DIGITS - 1 - floor(log10(longest))
    return round(place.real, last) + 0.0, round(place.imag, last) + 0.0
