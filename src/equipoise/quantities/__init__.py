"""Quantities: what can be measured, in which units, how it is read and how it is written.

`units` has the dimensions and their units, `reading` turns strict text into SI floats and back,
and `numbers` is the one formatter of numbers.
"""

from equipoise.quantities.numbers import (
    PER_RPM,
    Display,
    angle,
    brief,
    change,
    display,
    display_rules,
    in_unit,
    number,
    percent,
    span,
    typeset,
)
from equipoise.quantities.reading import (
    NUMBER,
    described,
    format_exact,
    parse,
    pattern,
    plain_unit,
    rounded,
)
from equipoise.quantities.units import FACTORS, HUGE, KINDS, SI, TINY, Dimension, Kind

__all__ = [
    "FACTORS",
    "HUGE",
    "KINDS",
    "NUMBER",
    "PER_RPM",
    "SI",
    "TINY",
    "Dimension",
    "Display",
    "Kind",
    "angle",
    "brief",
    "change",
    "described",
    "display",
    "display_rules",
    "format_exact",
    "in_unit",
    "number",
    "parse",
    "pattern",
    "percent",
    "plain_unit",
    "rounded",
    "span",
    "typeset",
]
