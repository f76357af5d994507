"""Numbers as people read them: few digits, rounding shown as 0, units that are chosen or suit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from decimal import Decimal
from functools import cache, cached_property
from math import floor, isfinite, log10, pi
from types import MappingProxyType
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.i18n import decimals
from equipoise.quantities.units import FACTORS, KINDS, SI, Dimension

PER_RPM = pi / 30
"""Of an angular speed, rad/s in one rpm."""
ROUNDING = 1e-10
"""Share of what stands beside a value below which it is rounding."""
LEAST, MOST = 1e-3, 1e6
"""Sizes between which a number is written without a power of ten."""
SAME = 5e-4
"""Relative change that counts as none."""

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


def rate_text(rate: float | None) -> str:
    """A rate of designs a second as text; empty for None and 0."""
    if not rate:
        return ""
    return f"{float(f'{rate:.3g}'):.0f} designs/s" if rate >= 100 else f"{rate:.3g} designs/s"


def duration_text(seconds: float) -> str:
    """A duration, given in s, as text in s, in min and s, or in h and min."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 60:
        return f"{minutes} min {rest} s"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min"


def typeset(text: str) -> str:
    """A number or unit as print has it: a true minus, ``10⁻⁴`` for ``e-04``, ``m²`` for ``m^2``,
    and the decimal sign of the language that is spoken.
    """
    text = decimals(text)
    digits, power, exponent = text.partition("e")
    if power and exponent.lstrip("+-").isdigit() and digits[-1:].isdigit():
        text = f"{digits}×10{str(int(exponent)).translate(_RAISED)}"
    for plain, raised in (("^2", "²"), ("^3", "³")):
        text = text.replace(plain, raised)
    return text.replace("-", MINUS)


# -- what a reader has chosen ----------------------------------------------------------------------

Units = Mapping[Dimension, str]
"""Units by dimension."""

_NONE: Units = MappingProxyType({})
_chosen: ContextVar[Units] = ContextVar("units", default=_NONE)

_FOLLOWS: dict[Dimension, str] = {
    "speed": "{length}/s",
    "acceleration": "{length}/s^2",
    "torque": "{force} {length}",
    "inertia": "{mass} {length}^2",
    "unbalance": "{mass} {length}",
    "stiffness": "{force}/{length}",
    "damping": "{force} s/{length}",
    "torsional stiffness": "{force} {length}/rad",
    "bending stiffness": "{force} {length}^2",
    "mass per length": "{mass}/{length}",
    "density": "{mass}/{length}^3",
    "volume": "{length}^3",
}
"""Unit of a dimension that follows from others, where all of them are chosen."""


@contextmanager
def showing(units: Units) -> Iterator[None]:
    """Inside, values are shown in these units, and others as before; only in this thread."""
    token = _chosen.set({**_chosen.get(), **units})
    try:
        yield
    finally:
        _chosen.reset(token)


@contextmanager
def showing_by_default(units: Units) -> Iterator[None]:
    """Inside, show units where none is chosen yet, as those of a model file are."""
    with showing({**units, **_chosen.get()}):
        yield


def chosen_units() -> Units:
    """Those that are chosen here, to be shown elsewhere."""
    return _chosen.get()


def chosen_unit(dimension: Dimension) -> str | None:
    """The unit of a dimension that is chosen, or follows from such; None where none does.

    A unit follows if it is one that files may have, and no metric one: who wants lengths in mm
    does not want accelerations in mm/s^2.
    """
    chosen = _chosen.get()
    if dimension in chosen or not chosen or dimension not in _FOLLOWS:
        return chosen.get(dimension)
    try:
        unit = _FOLLOWS[dimension].format(**{str(kind): item for kind, item in chosen.items()})
    except KeyError:
        return None
    known = unit in KINDS[dimension].units
    return unit if known and Decimal(FACTORS[unit]).normalize().as_tuple().digits != (1,) else None


# -- units -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Display:
    """A unit in which values are shown.

    unit : in plain signs, such as ``kg mm^2``.  factor : how many of it are one SI unit.
    """

    unit: str
    factor: float

    @cached_property
    def name(self) -> str:
        """The unit as print has it."""
        return _SIGNS.get(self.unit) or typeset(self.unit)

    def text(self, value: float, scale: float = 0.0, digits: int = 4) -> str:
        """A value in SI units as a number of this unit; 0 where it is rounding beside `scale`."""
        return number(self.factor * value, self.factor * scale, digits)

    def with_unit(self, text: str) -> str:
        """A number of this unit with its name behind it."""
        return f"{text}{'' if self.name in {'', DEGREE} else ' '}{self.name}"


DEGREE = "\N{DEGREE SIGN}"
_SIGNS = {"deg": DEGREE, "um": "µm", "um/s": "µm/s", "urad": "µrad", "urad/s": "µrad/s"}
_SIGNS |= {"ug": "µg", "uN": "µN", "uN m": "µN m", "uJ": "µJ"}

_SHOWN: dict[Dimension, str] = {
    "length": "mm",
    "angle": "deg",
    "mass": "g",
    "inertia": "kg mm^2",
    "unbalance": "g mm",
    "volume": "cm^3",
    "modulus": "MPa",
    "pressure times speed": "MPa m/s",
}
"""Unit that is shown usually; SI of every other dimension."""

_SCALES: tuple[tuple[str, ...], ...] = (
    ("nm", "um", "mm", "m", "km"),
    ("um", "cm", "m"),
    ("um/s", "mm/s", "m/s"),
    ("mm/s^2", "m/s^2"),
    ("urad", "mrad", "rad"),
    ("urad/s", "mrad/s", "rad/s"),
    ("mrad/s^2", "rad/s^2"),
    ("ng", "ug", "mg", "g", "kg", "t"),
    ("g mm^2", "kg mm^2", "kg m^2"),
    ("g mm", "kg mm", "kg m"),
    ("nN", "uN", "mN", "N", "kN", "MN"),
    ("nN m", "uN m", "mN m", "N m", "kN m", "MN m"),
    ("mW", "W", "kW", "MW"),
    ("nJ", "uJ", "mJ", "J", "kJ", "MJ"),
    ("N/m", "kN/m", "MN/m"),
    ("Hz", "kHz"),
    ("ms", "s"),
    ("Pa", "kPa", "MPa", "GPa"),
    ("Pa m/s", "MPa m/s"),
)
"""Units of which the next is taken where numbers become too small or too large."""

_EXTRA_UNITS = {
    "nm": 1e9,
    "mrad": 1e3,
    "urad": 1e6,
    "mrad/s": 1e3,
    "urad/s": 1e6,
    "um/s": 1e6,
    "mrad/s^2": 1e3,
    "ug": 1e9,
    "ng": 1e12,
    "nN": 1e9,
    "uN": 1e6,
    "nN m": 1e9,
    "uN m": 1e6,
    "nJ": 1e9,
    "uJ": 1e6,
}
"""Units that are shown but not read: how many are one SI unit."""

SMALL, LARGE = 1e-3, 1e4
"""Numbers between which a unit stays that follows the sizes."""
FEW = 0.1
"""Least number for which no still smaller unit is taken."""
LARGE_IN_UNIT = 1e5
"""Largest number for which the unit of a column stays, whatever suits the sizes."""


@cache
def in_unit(unit: str) -> Display:
    """The display of a unit that is given."""
    return Display(unit, _EXTRA_UNITS[unit] if unit in _EXTRA_UNITS else 1 / float(FACTORS[unit]))


def display(dimension: Dimension | None, values: Any = (), unit: str | None = None) -> Display:
    """The unit in which values (SI) of a dimension are shown; no unit of plain numbers.

    That is the one which a reader has chosen; else one in which they are best read.

    unit : to use while sizes allow it, instead of the customary one.
    """
    if dimension is None:
        return Display("", 1.0)
    chosen = chosen_unit(dimension)
    if chosen is not None:
        return in_unit(chosen)
    first = in_unit(unit or _SHOWN.get(dimension, SI[dimension]))
    if isinstance(values, tuple) and not values:
        return first
    import numpy as np  # here: who reads a quantity or asks for help does not wait for it

    sizes = np.abs(np.asarray(values, float))
    largest = float(np.max(sizes[np.isfinite(sizes)], initial=0.0))
    return _fitting(first, largest, LARGE if unit is None else LARGE_IN_UNIT)


def _fitting(first: Display, largest: float, most: float) -> Display:
    """The unit, or of its scale the next smaller or larger one that suits the largest value."""
    size = first.factor * largest
    if not 0 < size < SMALL and not size > most:
        return first
    scale = next((scale for scale in _SCALES if first.unit in scale), (first.unit,))
    place, result = scale.index(first.unit), first
    for result in map(in_unit, scale[place + 1 :] if size > most else scale[:place][::-1]):
        number_of_it = result.factor * largest
        if number_of_it <= LARGE if size > most else number_of_it >= FEW:
            break
    return result


def format_quantity(
    value: float,
    dimension: Dimension,
    unit: str | None = None,
    scale: float = 0.0,
    digits: int = 4,
) -> str:
    """A value (SI) as a sentence has it, with its unit; further arguments as of `display`.

    scale : beside which a smaller value is rounding, and is printed as 0.
    """
    unit_display = display(dimension, [value], unit)
    return unit_display.with_unit(unit_display.text(value, scale, digits))


def angle(radians: float, after: int = 1) -> str:
    """An angle with its unit: degrees with so many digits behind the point, or as is chosen."""
    unit_display = in_unit(chosen_unit("angle") or "deg")
    return unit_display.with_unit(fixed(unit_display, radians, after))


MORE_DIGITS = {"rad": 2, "turn": 3}
"""Of angles, beyond those behind the point in degrees."""


def fixed(unit_display: Display, value: float, after: int) -> str:
    """A value (SI) with so many digits behind the point, and without the minus of what is 0."""
    value = unit_display.factor * value
    after += MORE_DIGITS.get(unit_display.unit, 0)
    return f"{round(value, after) + 0.0:.{after}f}" if isfinite(value) else f"{value}"


def display_rules() -> Mapping[str, Any]:
    """What the live page needs to write numbers as they are written here.

    least, most : sizes between which there is no power of ten.
    units : what may follow a number in a sentence, and stays in its line; longer ones first.
    lengths : m in each unit in which a length may be typed.
    """
    units = sorted({*FACTORS, *_EXTRA_UNITS, "%"}, key=lambda unit: (-len(unit), unit))
    lengths = {unit: float(FACTORS[unit]) for unit in KINDS["length"].units}
    return {"least": LEAST, "most": MOST, "units": units, "lengths": lengths}


def column_heading(name: str, unit: str) -> str:
    """The head of a column of numbers: its name, and its unit where it has one."""
    return f"{name} [{unit}]" if unit else name
