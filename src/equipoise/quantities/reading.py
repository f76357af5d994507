"""Quantities at the door: strict text such as ``"33.5 mm"`` to SI floats, and back without loss.

The grammar is number, space, unit; the units are an explicit list for each dimension.  Conversion
is in decimal arithmetic, so that ``parse("33.5 mm", "length")`` is the float nearest to 0.0335.
"""

from __future__ import annotations

import re
from decimal import Decimal, localcontext
from functools import cache
from math import isfinite

from equipoise.errors import UsageError
from equipoise.quantities.problems import not_text, too_far, wrong_text
from equipoise.quantities.units import FACTORS, HUGE, KINDS, TINY, Dimension, pattern, plain_unit

_DIGITS = 60
"""Digits carried in conversions: enough that only the last step, to a float, rounds."""


def parse(text: object, dimension: Dimension) -> float:
    """Read a quantity such as ``"33.5 mm"``.

    Parameters
    ----------
    text : number, space, unit; anything else is refused.
    dimension : what it has to be.

    Returns
    -------
    float
        In SI units and radians, the float nearest to what the text says.

    Raises
    ------
    UsageError
        One sentence: what was given and what would be right.
    """
    if not isinstance(text, str):
        raise UsageError(not_text(text, dimension))
    match = _grammar(dimension).fullmatch(text)
    if match is None:
        raise UsageError(wrong_text(text, dimension))
    with localcontext() as context:
        context.prec = _DIGITS
        value = float(Decimal(match[1]) * _factor(plain_unit(match[2])))
    if not isfinite(value) or abs(value) > HUGE or 0 < abs(value) < TINY:
        raise UsageError(too_far(text))
    return value


def format_exact(value: float, dimension: Dimension) -> str:
    """Write a value in its handiest unit, such that `parse` gives back exactly the same float.

    Parameters
    ----------
    value : in SI units and radians; finite.
    dimension : what it is.

    Returns
    -------
    str
        ``"33.5 mm"`` for 0.0335 m; where no usual unit gives a short number, the SI unit with as
        many digits as the float needs.
    """
    value = float(value)
    kind = KINDS[dimension]
    if value == 0:
        return f"0 {kind.printed[0]}"
    numbers = [(number, unit) for unit in kind.printed if (number := _short(value, unit))]
    if not numbers:
        return f"{value!r} {kind.si}"
    number, unit = min(numbers, key=lambda pair: len(pair[0]))
    return f"{number} {unit}"


def rounded(value: float, unit: str, digits: int) -> str:
    """Write a value in a given unit with so many significant digits at most."""
    return f"{_digits_of(_rounded(value, unit, digits))} {unit}"


@cache
def _grammar(dimension: Dimension) -> re.Pattern[str]:
    return re.compile(pattern(dimension))


def _factor(unit: str) -> Decimal:
    """SI units in one `unit`."""
    return Decimal(FACTORS[unit])


def _short(value: float, unit: str) -> str | None:
    """Digits of `value` in `unit` if at most 15 of them give the same float back."""
    number = _rounded(value, unit, 15)
    with localcontext() as context:
        context.prec = _DIGITS
        exact = float(number * _factor(unit)) == value
    return _digits_of(number) if exact else None


def _rounded(value: float, unit: str, digits: int) -> Decimal:
    factor = _factor(unit)
    with localcontext() as context:
        context.prec = _DIGITS
        exact = Decimal(value) / factor
        context.prec = digits
        return (+exact).normalize()


def _digits_of(number: Decimal) -> str:
    return f"{number:f}" if -5 <= number.adjusted() < 9 else str(number).lower()
