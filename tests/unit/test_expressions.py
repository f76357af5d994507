"""Sums and products in number fields, against pint's own reading of them."""

from __future__ import annotations

import pint
import pytest

from equipoise.errors import UsageError
from equipoise.quantities import Dimension, parse_amount, parse_expression
from equipoise.quantities.expressions import parse_number
from support.refusals import refused

REGISTRY = pint.UnitRegistry()


@pytest.mark.parametrize(
    ("text", "dimension", "unit"),
    [
        ("2*100 g", "mass", "kg"),
        ("=33.5 mm + 2 mm", "length", "m"),
        ("(33.5 mm + 1 in)/2", "length", "m"),
        ("2*(30 + 3.5) mm", "length", "m"),
        ("100 mm - 2*1.5 cm", "length", "m"),
        ("-3 mm + 1e1 mm", "length", "m"),
        ("0.5*0.2 kg + 10 g", "mass", "kg"),
        ("10 mm / (4 mm) * 3 mm", "length", "m"),
        ("33.5 mm", "length", "m"),
    ],
)
def test_what_is_typed_is_what_pint_reads(text: str, dimension: Dimension, unit: str) -> None:
    expected = REGISTRY.parse_expression(text.lstrip("=").replace(") mm", ")*mm"))
    assert parse_expression(text, dimension) == pytest.approx(expected.m_as(unit), rel=1e-14)


def test_sums_are_rounded_once() -> None:
    assert parse_expression("=33.5 mm + 2 mm", "length") == 0.0355
    assert parse_expression("3*0.1 mm", "length") == 0.0003


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("2*100", "which has no unit"),
        ("2 mm * 3 mm", "no sum or product that gives a length"),
        ("2 mm + 3", "no sum or product that gives a length"),
        ("2 mm / 0", "divides by 0"),
        ("2*3 kg", "which gives a mass; give a length, such as '33.5 mm'"),
        ("=2 mm # and 3 mm", "no sum or product that gives a length"),
        ("=9**9**9*1 mm", "no sum or product that gives a length"),
        ("=" + "1 mm + " * 5000 + "1 mm", "which has 35005 characters; give at most 200"),
        ("=__import__('os')", "no sum or product that gives a length"),
        ("=2**3 mm", "no sum or product that gives a length"),
        ("(" * 90 + "2 mm" + ")" * 89, "no sum or product that gives a length"),
        ("=1e999*1 mm", "no machine can have"),
        ("=", "no sum or product that gives a length"),
        ("12mm", 'put a space between number and unit: "12 mm"'),
        ("-5", "the unit is missing"),
        ("1e-3", "the unit is missing"),
        ("100-300 mm", "not a range"),
    ],
)
def test_what_is_no_length_is_refused_in_a_sentence(text: str, what: str) -> None:
    with pytest.raises(UsageError, match=what):
        parse_expression(text, "length")


CRANK, COUNT = parse_amount("33.5 mm"), parse_amount("3")


@pytest.mark.parametrize(
    ("text", "length"),
    [("=crank", 0.0335), ("=2*crank + 3 mm", 0.07), ("=count*crank/(33.5 mm) * 1 cm", 0.03)],
)
def test_names_stand_for_amounts(text: str, length: float) -> None:
    names = {"crank": CRANK, "count": COUNT}
    assert parse_expression(text, "length", names) == length


def test_an_amount_tells_its_dimension() -> None:
    assert parse_amount("=crank/2", {"crank": CRANK}).dimension == "length"
    assert parse_amount("=crank/(1 mm)", {"crank": CRANK}).dimension is None
    assert parse_number("=count*crank/(67 mm)", {"crank": CRANK, "count": COUNT}) == 1.5


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("=crnk/2", "no parameter is called 'crnk'; did you mean 'crank'"),
        ("=count", "which gives a plain number; give a length, such as '33.5 mm'"),
        ("=crank*crank", "no sum or product that gives a length"),
        ("=crank + 2", "no sum or product that gives a length"),
        ("=crank.real", "no sum or product that gives a length"),
        ("=crank/(count - 3)", "divides by 0"),
    ],
)
def test_what_names_cannot_give_is_refused(text: str, what: str) -> None:
    with pytest.raises(UsageError, match=what):
        parse_expression(text, "length", {"crank": CRANK, "count": COUNT})


def test_products_of_quantities_are_no_amount() -> None:
    with refused(UsageError, text="=2 mm * 3 mm"):
        parse_amount("=2 mm * 3 mm")
