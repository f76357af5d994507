"""Numbers that were computed, as somebody would have given them in a file."""

from __future__ import annotations

from math import floor, isfinite, log10

from equipoise.quantities.numbers import chosen_unit
from equipoise.quantities.reading import parse, rounded
from equipoise.quantities.units import HUGE, SI, TINY, Dimension

DIGITS, SHORT = 12, 9
"""Significant ones that are kept, and those of a number that somebody may have meant in SI."""
MEANT, ROUNDING = 6, 1e-8
"""Digits of a number that is meant where another differs by no more than this share from it: what a
program finds at a limit of 100 mm is 99.999999637 mm."""
OTHER: dict[Dimension, str] = {"angle": "deg", "angular speed": "rpm"}
"""Units of files that are no power of ten of the SI unit."""


def clean(value: float, dimension: Dimension | None = None) -> float:
    """A value (SI units, radians) of 12 digits, in the unit in which a file has it."""
    plain = float(f"{value:.{DIGITS}g}")
    if dimension is None or not TINY < abs(value) < HUGE:
        return plain
    unit = chosen_unit(dimension) or OTHER.get(dimension, SI[dimension])
    meant = parse(rounded(value, unit, MEANT), dimension)
    if abs(meant - value) <= ROUNDING * abs(value):
        return meant
    short = plain == float(f"{value:.{SHORT}g}")
    return plain if short else parse(rounded(value, unit, DIGITS), dimension)


def clean_place(place: complex, size: float = 0.0, digits: int = DIGITS) -> tuple[float, float]:
    """Coordinates (m) whose last digit is such a one of the longer of them, or of a size."""
    longest = max(abs(place.real), abs(place.imag), size)
    if not longest or not isfinite(longest):
        return place.real, place.imag
    last = digits - 1 - floor(log10(longest))
    return round(place.real, last) + 0.0, round(place.imag, last) + 0.0
