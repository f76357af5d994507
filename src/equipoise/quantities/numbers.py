"""Numbers as people read them: few digits, rounding shown as 0."""

from __future__ import annotations

from collections.abc import Iterable
from math import floor, isfinite, log10, pi

PER_RPM = pi / 30
"""Of an angular speed, rad/s in one rpm."""
ROUNDING = 1e-10
"""Share of what stands beside a value below which it is rounding."""
LEAST, MOST = 1e-3, 1e6
"""Sizes between which a number is written without a power of ten."""
SAME = 5e-4
"""Share of a change that is told as none."""

MINUS = "\N{MINUS SIGN}"
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


# -- numbers ---------------------------------------------------------------------------------------


def number(value: float, scale: float = 0.0, digits: int = 4) -> str:
    """A value with so many significant digits; 0 where it is rounding beside `scale`."""
    if value == 0 or abs(value) <= ROUNDING * abs(scale):
        return "0"
    if not isfinite(value) or not LEAST <= abs(value) < MOST:
        return f"{value:.{digits - 1}e}"
    after = max(0, digits - 1 - floor(log10(abs(value))))
    return f"{value:.{after}f}"


def brief(value: float, scale: float = 0.0) -> str:
    """A value with three digits, as sentences have it."""
    return number(value, scale, 3)


def percent(share: float, after: int = 0) -> str:
    """A share as per cent without the sign, and without the minus of what rounds to 0."""
    return f"{round(100 * share, after) + 0.0:.{after}f}"


def change(before: float, after: float) -> str:
    """By how much a figure has changed, in per cent with its sign; empty where it came from 0."""
    if before <= ROUNDING * max(abs(after), 1e-30):
        return ""
    share = after / before - 1
    if abs(share) < SAME:
        return "\N{PLUS-MINUS SIGN}0 %"
    return f"{100 * share:+.1f} %"


def span(values: Iterable[float], scale: float = 0.0, to: str = " to ") -> str:
    """Smallest to largest value; one number where they differ by rounding only."""
    values = [float(value) for value in values]
    low, high = min(values), max(values)
    scale = max(abs(low), abs(high), scale)
    if high - low <= ROUNDING * scale:
        return number(high, scale)
    return f"{number(low, scale)}{to}{number(high, scale)}"


def typeset(text: str) -> str:
    """A number or unit as print has it: a true minus, ``10⁻⁴`` for ``e-04``, ``m²`` for ``m^2``."""
    digits, power, exponent = text.partition("e")
    if power and exponent.lstrip("+-").isdigit() and digits[-1:].isdigit():
        text = f"{digits}×10{str(int(exponent)).translate(_RAISED)}"
    for plain, raised in (("^2", "²"), ("^3", "³")):
        text = text.replace(plain, raised)
    return text.replace("-", MINUS)
