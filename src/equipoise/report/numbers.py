"""Numbers as a report shows them: few digits, a true minus, rounding shown as 0."""

from __future__ import annotations

import re
from math import degrees, floor, log10, pi
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]

PER_RPM = pi / 30
MINUS = "\N{MINUS SIGN}"
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
ROUNDING = 1e-10
SAME = 5e-4
"""Share of a change that is told as none."""


def number(value: float, scale: float = 0.0, digits: int = 4) -> str:
    """A value with so many significant digits; 0 where it is rounding beside `scale`."""
    if value == 0 or abs(value) <= ROUNDING * abs(scale):
        return "0"
    if not 1e-3 <= abs(value) < 1e6:
        return _powered(value, digits - 1)
    after = max(0, digits - 1 - floor(log10(abs(value))))
    return f"{value:.{after}f}".replace("-", MINUS)


def _powered(value: float, after: int) -> str:
    """A value with a power of ten, ``1.23×10⁻⁴``."""
    digits, power = f"{value:.{after}e}".split("e")
    return f"{digits}×10{str(int(power)).translate(RAISED)}".replace("-", MINUS)


def about(value: float) -> str:
    """The power of ten of a small value, with one digit."""
    return _powered(value, 0)


def brief(value: float, scale: float = 0.0) -> str:
    """A value with three digits, as sentences have it."""
    return number(value, scale, 3)


def angle(radians: float) -> str:
    """An angle in degrees, whole ones."""
    return f"{degrees(radians) + 0.0:.0f}".replace("-", MINUS)


def percent(share: float) -> str:
    """A share in per cent, without the minus of what rounds to 0."""
    return f"{round(100 * share) + 0:d}".replace("-", MINUS)


def change(before: float, after: float) -> str:
    """By how much a figure has changed, in per cent with its sign; empty where it came from 0."""
    if before <= ROUNDING * max(abs(after), 1e-30):
        return ""
    share = after / before - 1
    if abs(share) < SAME:
        return "\N{PLUS-MINUS SIGN}0 %"
    return f"{100 * share:+.1f} %".replace("-", MINUS)


def span(values: Array, scale: float = 0.0) -> str:
    """Smallest to largest value."""
    low, high = float(np.min(values)), float(np.max(values))
    scale = max(abs(low), abs(high), scale)
    if high - low <= ROUNDING * scale:
        return number(high, scale)
    return f"{number(low, scale)} … {number(high, scale)}"


def place(xy: tuple[float, float]) -> str:
    """A place in mm."""
    scale = 1e3 * max(map(abs, xy))
    return f"{number(1e3 * xy[0], scale)}, {number(1e3 * xy[1], scale)}"


_UNIT = re.compile(r"(?<![A-Za-z])(k?N|k?g) (mm?|s)(?![A-Za-z])")
_VALUE = re.compile(
    r"(?<=[0-9)]) (?=(?:k?N|k?g|k?J|[cm]?m|m?rad|m?s|min|h|rpm|Hz|[%°])[²³]?(?![A-Za-z0-9]))"
)


def kept_together(text: str) -> str:
    """A text that never ends a line within a unit, or between it and its number."""
    bound = _UNIT.sub("\\1\N{NO-BREAK SPACE}\\2", text)
    return _VALUE.sub("\N{NO-BREAK SPACE}", bound)


def capital(text: str) -> str:
    """A text that begins a sentence."""
    return text[:1].upper() + text[1:]
