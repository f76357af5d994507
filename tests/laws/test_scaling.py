"""A machine in other units of length, mass and time does the same, however small it is.

Everything that a file may say is scaled by its declared dimension, and so is everything that is
told, by its unit: a machine of micrometres and picograms balances, shakes and looks like one of
decimetres and kilograms.  The dimensions of units are pint's.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pint
import pytest

import equipoise as eq
from equipoise.balancing.blocks import figure_unit
from equipoise.keys import Frozen, Point, innermost
from equipoise.keys import Table as TableKind
from equipoise.keys.declaring import declarations
from equipoise.mechanism.balance import Balance, Limit
from equipoise.mechanism.objectives import quantity_of
from equipoise.quantities import SI
from equipoise.results.blocks import Column, Many, Span, Table, Value
from laws.transforms import Units

MICRO = Units(2.0**-13, 2.0**-38, 2.0**-6)
"""A crank of 4 um and links of 1e-12 kg that turn 64 times as fast; powers of 2, so that scaling rounds nothing."""


@cache
def factor(unit: str, units: Units) -> float:
    """How many of the new units make one of the old."""
    written = unit.replace(" ", "*").replace("turn", "radian")
    found = pint.application_registry.Quantity(1, written).dimensionality
    sizes = {"[length]": units.length, "[mass]": units.mass, "[time]": units.time}
    return float(np.prod([sizes[name] ** power for name, power in found.items()]))


def in_units(thing: Any, units: Units, machine: eq.Machine | None = None) -> Any:
    """A machine, or a part of one, with every declared quantity in other units."""
    if isinstance(thing, eq.Machine):
        machine = thing
    if isinstance(thing, Limit) and thing.at_most is not None:
        assert machine is not None
        dimension = quantity_of(thing.objective, machine)
        assert dimension is not None
        thing = replace(thing, at_most=thing.at_most * factor(SI[dimension], units))
    changes = {
        one.field: scaled(getattr(thing, one.field), innermost(one.kind), units, machine)
        for one in declarations(type(thing))
    }
    return replace(thing, **changes)


def scaled(value: Any, kind: Any, units: Units, machine: eq.Machine | None) -> Any:
    if isinstance(value, Frozen):
        return in_units(value, units, machine)
    if isinstance(kind, TableKind):  # with one key, which the object has without it
        kind = innermost(declarations(kind.type)[0].kind)
    if isinstance(value, Mapping):
        return {name: scaled(one, kind, units, machine) for name, one in value.items()}
    if isinstance(value, tuple):
        return tuple(scaled(one, kind, units, machine) for one in value)
    dimension = "length" if isinstance(kind, Point) else getattr(kind, "dimension", None)
    if value is None or isinstance(value, str) or dimension is None:
        return value
    return value * factor(SI[dimension], units)


# -- what is told ----------------------------------------------------------------------------------

NUMBER = re.compile(r"[-+−]?\d+(?:\.\d+)?(?:e[-+]\d+)?")


def words(text: Any) -> str:
    """A sentence without its numbers."""
    return NUMBER.sub("#", str(text))


def same_blocks(found: Any, want: Any, units: Units, tolerance: float) -> None:
    """Compare what two results show: the same words, and numbers by their dimension."""
    left, right = list(found.blocks()), list(want.blocks())
    assert [type(one) for one in left] == [type(one) for one in right]
    for one, other in zip(left, right, strict=True):
        if not isinstance(one, Table):
            assert words(one) == words(other)
            continue
        assert (one.title, len(one.rows)) == (other.title, len(other.rows))
        columns = list(zip(one.columns, zip(*one.rows, strict=True), zip(*other.rows, strict=True)))
        for column, cells, others in columns:
            for cell, wanted in zip(cells, others, strict=True):
                same_cell(cell, wanted, column, units, tolerance)


def same_cell(cell: Any, want: Any, column: Column, units: Units, tolerance: float) -> None:
    assert type(cell) is type(want)
    if isinstance(cell, Many):
        for one, other in zip(cell.values, want.values, strict=True):
            same_cell(one, other, column, units, tolerance)
    elif isinstance(cell, Value):
        dimension = cell.dimension or column.dimension
        unit = SI[dimension] if dimension else column.label  # which may be one
        grown = factor(unit, units) if unit in (*SI.values(), "1/min") else 1.0
        size = max(abs(want.value), 1e-10 * abs(want.scale)) * grown
        assert abs(cell.value - grown * want.value) <= tolerance * size, (column.label, cell, want)
    elif isinstance(cell, Span):
        same_cell(Value(cell.low, cell.scale), Value(want.low, want.scale), column, units, tolerance)
        same_cell(
            Value(cell.high, cell.scale), Value(want.high, want.scale), column, units, tolerance
        )
    elif isinstance(cell, str):
        assert words(cell) == words(want)
