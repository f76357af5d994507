"""The shipped factors of the units are those of pint's standard registry."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest
from pint import UnitRegistry

from equipoise import analyze, load
from equipoise.mechanism.parts.sections import LinkSection
from equipoise.present.terminal import print_blocks
from equipoise.quantities import format_exact, parse, parse_expression, told
from equipoise.quantities.units import FACTORS, KINDS, SAME, Dimension
from equipoise.results.section_blocks import section_blocks

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


SHARED = {"modulus", "stress", "pressure"}


def test_no_unit_belongs_to_two_dimensions_but_those_that_are_alike() -> None:
    """What is read without a key, such as a parameter, is known by its unit."""
    owners: dict[str, set[Dimension]] = {}
    for dimension, kind in KINDS.items():
        for unit in kind.units:
            owners.setdefault(unit, set()).add(dimension)
    assert {frozenset(own) for own in owners.values() if len(own) > 1} == {frozenset(SHARED)}
    assert {one for one, first in SAME.items() if one != first} == SHARED - {"modulus"}


@pytest.mark.parametrize(
    ("dimension", "value", "text"),
    [
        ("modulus", 206e9, "206 GPa"),
        ("modulus", 2.4e9, "2.4 GPa"),
        ("stress", 181.3e6, "181.3 MPa"),
        ("stress", 1.2e6, "1.2 MPa"),
        ("pressure", 12e6, "12 MPa"),
        ("pressure", 150e3, "0.15 MPa"),
        ("pressure times speed", 1.7e6, "1.7 MPa m/s"),
    ],
)
def test_stress_and_pressure_are_shown_in_the_units_of_engineers(
    dimension: Dimension, value: float, text: str
) -> None:
    shown = told(value, dimension).split(" ", 1)
    assert f"{float(shown[0]):g} {shown[1]}" == text
    assert float(shown[0]) * float(FACTORS[text.split(" ", 1)[1]]) == pytest.approx(value)
    assert parse(format_exact(value, dimension), dimension) == value


def test_a_stress_is_worked_out_of_moduli() -> None:
    assert parse_expression("=355 MPa/2 + 10 N/mm^2", "stress") == 187.5e6


def test_the_stress_of_a_link_is_shown_in_mpa(capsys: pytest.CaptureFixture[str]) -> None:
    """Pa on the terminal have powers of ten, which nobody compares with a yield strength."""
    machine = load("slider-crank-engine")
    section = LinkSection(None, "22 mm", "10 mm", yield_strength="355 MPa")
    rod = replace(machine.links["rod"], section=section)
    found = analyze(replace(machine, links={**machine.links, "rod": rod}), 72)
    print_blocks(None, section_blocks(found))
    shown = capsys.readouterr().out
    assert "MPa" in shown
    assert "e+0" not in shown
