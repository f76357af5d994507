"""Numbers as people read them: few digits, rounding shown as 0, units that suit the size."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import degrees, floor, isfinite, log10, pi
from typing import Any

from equipoise.quantities.units import FACTORS, SI, Dimension

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


def angle(radians: float, after: int = 1) -> str:
    """An angle in degrees with so many digits after the point."""
    return f"{round(degrees(radians), after) + 0.0:.{after}f}"


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


def rate_told(rate: float | None) -> str:
    """Designs a second."""
    if not rate:
        return ""
    return f"{float(f'{rate:.3g}'):.0f} designs/s" if rate >= 100 else f"{rate:.3g} designs/s"


def time_told(seconds: float) -> str:
    """A time as one says it."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 60:
        return f"{minutes} min {rest} s"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min"


def typeset(text: str) -> str:
    """A number or unit as print has it: a true minus, ``10⁻⁴`` for ``e-04``, ``m²`` for ``m^2``."""
    digits, power, exponent = text.partition("e")
    if power and exponent.lstrip("+-").isdigit() and digits[-1:].isdigit():
        text = f"{digits}×10{str(int(exponent)).translate(_RAISED)}"
    for plain, raised in (("^2", "²"), ("^3", "³")):
        text = text.replace(plain, raised)
    return text.replace("-", MINUS)


# -- units -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Display:
    """A unit in which values are shown.

    unit : in plain signs, such as ``kg mm^2``.  factor : how many of it are one SI unit.
    """

    unit: str
    factor: float

    @property
    def name(self) -> str:
        """The unit as print has it."""
        return _SIGNS.get(self.unit) or typeset(self.unit)

    def text(self, value: float, scale: float = 0.0, digits: int = 4) -> str:
        """A value in SI units as a number of this unit; 0 where it is rounding beside `scale`."""
        return number(self.factor * value, self.factor * scale, digits)


_SIGNS = {"deg": "°", "um": "µm", "um/s": "µm/s", "urad": "µrad", "urad/s": "µrad/s"}

_SHOWN: dict[Dimension, tuple[str, str, str]] = {
    "length": ("mm", "um", "m"),
    "speed": ("m/s", "mm/s", "m/s"),
    "acceleration": ("m/s^2", "mm/s^2", "m/s^2"),
    "angle": ("deg", "deg", "deg"),
    "angular speed": ("rad/s", "mrad/s", "rad/s"),
    "angular acceleration": ("rad/s^2", "mrad/s^2", "rad/s^2"),
    "mass": ("g", "mg", "kg"),
    "inertia": ("kg mm^2", "g mm^2", "kg m^2"),
    "force": ("N", "mN", "kN"),
    "torque": ("N m", "mN m", "kN m"),
    "power": ("W", "mW", "kW"),
    "energy": ("J", "mJ", "kJ"),
    "unbalance": ("g mm", "g mm", "kg m"),
}
"""Unit that is shown usually, of small and of large values; SI of every other dimension."""

_MORE = {
    "mrad": 1e3,
    "urad": 1e6,
    "mrad/s": 1e3,
    "urad/s": 1e6,
    "um/s": 1e6,
    "mrad/s^2": 1e3,
    "mN m": 1e3,
}
"""Units that are shown but not read: how many are one SI unit."""

SMALL, LARGE = 1e-3, 1e4
"""Numbers between which the usual unit stays."""


def in_unit(unit: str) -> Display:
    """The display of a unit that is given."""
    return Display(unit, _MORE[unit] if unit in _MORE else 1 / float(FACTORS[unit]))


def display(
    dimension: Dimension | None, values: Any = (), usual: tuple[str, str, str] | None = None
) -> Display:
    """The unit in which values (SI) of a dimension are best read; no unit of plain numbers.

    usual : units that are shown usually, of small and of large values, instead of the common ones;
        a support's displacements are told in mrad where a link's angles are in degrees.
    """
    if dimension is None:
        return Display("", 1.0)
    names = usual or _SHOWN.get(dimension, (SI[dimension],) * 3)
    first, small, large = map(in_unit, names)
    import numpy as np  # here: who reads a quantity or asks for help does not wait for it

    sizes = np.abs(np.asarray(values, float))
    largest = first.factor * float(np.max(sizes[np.isfinite(sizes)], initial=0.0))
    if 0 < largest < SMALL:
        return small
    return large if largest > LARGE else first


def display_rules() -> Mapping[str, Any]:
    """What the live page needs to write numbers as they are written here.

    least, most : sizes between which there is no power of ten.
    length : unit of a drawing, and how many of it are one SI unit.
    units : what may follow a number in a sentence, and stays in its line; longer ones first.
    """
    units = sorted({*FACTORS, *_MORE, "%"}, key=lambda unit: (-len(unit), unit))
    length = display("length")
    drawing = {"unit": length.name, "factor": length.factor}
    return {"least": LEAST, "most": MOST, "length": drawing, "units": units}
