"""Sums and products in number fields, against pint's own reading of them."""

from __future__ import annotations

from typing import Any

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
    ("text", "expected"),
    [
        ("2*100", {"text": "2*100"}),
        ("2 mm * 3 mm", {"unit": "mm"}),
        ("2 mm + 3", {"unit": "mm"}),
        ("2 mm / 0", {"text": "2 mm / 0"}),
        ("2*3 kg", {"text": "2*3 kg"}),
        ("=2 mm # and 3 mm", {"unit": "mm"}),
        ("=9**9**9*1 mm", {"unit": "mm"}),
        ("=" + "1 mm + " * 5000 + "1 mm", {"most": 200, "count": 35005}),
        ("=__import__('os')", {"unit": "mm"}),
        ("=2**3 mm", {"unit": "mm"}),
        ("(" * 90 + "2 mm" + ")" * 89, {"unit": "mm"}),
        ("=1e999*1 mm", {"text": "'=1e999*1 mm'"}),
        ("=", {"unit": "mm"}),
        ("12mm", {"number": "12", "unit": "mm"}),
        ("-5", {"by": "parse"}),
        ("1e-3", {"by": "parse"}),
        ("100-300 mm", {"low": "100 mm", "given": "'100-300 mm'"}),
    ],
)
def test_what_is_no_length_is_refused_in_a_sentence(text: str, expected: dict[str, Any]) -> None:
    with refused(UsageError, **expected):
        parse_expression(text, "length")


CRANK, COUNT = parse_amount("33.5 mm"), parse_amount("3")


@pytest.mark.parametrize(
    ("text", "length"),
    [("=crank", 0.0335), ("=2*crank + 3 mm", 0.07), ("=count*crank/(33.5 mm) * 1 cm", 0.03)],
)
def test_names_stand_for_amounts(text: str, length: float) -> None:
    names = {"crank": CRANK, "count": COUNT}
    assert parse_expression(text, "length", names) == length


def test_an_amount_reports_its_dimension() -> None:
    assert parse_amount("=crank/2", {"crank": CRANK}).dimension == "length"
    assert parse_amount("=crank/(1 mm)", {"crank": CRANK}).dimension is None
    assert parse_number("=count*crank/(67 mm)", {"crank": CRANK, "count": COUNT}) == 1.5


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("=crnk/2", {"name": "crank", "text": "=crnk/2"}),
        ("=count", {"text": "=count"}),
        ("=crank*crank", {"unit": "mm"}),
        ("=crank + 2", {"unit": "mm"}),
        ("=crank.real", {"unit": "mm"}),
        ("=crank/(count - 3)", {"text": "=crank/(count - 3)"}),
    ],
)
def test_what_names_cannot_give_is_refused(text: str, expected: dict[str, Any]) -> None:
    with refused(UsageError, **expected):
        parse_expression(text, "length", {"crank": CRANK, "count": COUNT})


def test_products_of_quantities_are_no_amount() -> None:
    with refused(UsageError, text="=2 mm * 3 mm"):
        parse_amount("=2 mm * 3 mm")
