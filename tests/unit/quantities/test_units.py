"""The shipped factors of the units are those of pint's standard registry."""

from __future__ import annotations

from functools import cache

import pytest
from pint import UnitRegistry

from equipoise.quantities.units import FACTORS, KINDS

UNITS = [(unit, kind.si) for kind in KINDS.values() for unit in kind.units]


@cache
def registry() -> UnitRegistry[float]:
    return UnitRegistry()


def in_words_of_pint(unit: str) -> str:
    return unit.replace(" ", "*").replace("^", "**").replace("gn", "standard_gravity")


@pytest.mark.parametrize(("unit", "si"), UNITS)
def test_factor(unit: str, si: str) -> None:
    quantity = registry().Quantity(1.0, in_words_of_pint(unit)).to(in_words_of_pint(si))
    assert float(FACTORS[unit]) == pytest.approx(quantity.magnitude, rel=1e-14)


def test_every_unit_has_a_factor_and_no_other() -> None:
    assert {unit for unit, _ in UNITS} == set(FACTORS)
    assert all(float(FACTORS[si]) == 1.0 for _, si in UNITS)
