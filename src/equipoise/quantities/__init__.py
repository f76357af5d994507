"""Quantities: what can be measured, in which units, how it is read and how it is written.

`units` has the dimensions and their units, `reading` turns strict text into SI floats and back,
`problems` says what is wrong with a text, and `numbers` is the one formatter of numbers.
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
from equipoise.quantities.problems import described
from equipoise.quantities.reading import format_exact, parse, rounded
from equipoise.quantities.units import (
    FACTORS,
    HUGE,
    KINDS,
    SI,
    TINY,
    Dimension,
    Kind,
    pattern,
    plain_unit,
)

__all__ = [
    "FACTORS",
    "HUGE",
    "KINDS",
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
