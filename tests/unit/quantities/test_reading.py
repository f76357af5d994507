"""Quantities: what is read, what is refused, and the way back."""

from __future__ import annotations

import re
from decimal import Decimal, localcontext
from fractions import Fraction
from math import pi
from typing import Any, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from equipoise import quantities
from equipoise.errors import UsageError
from equipoise.quantities import KINDS, Dimension, format_exact, parse
from support.refusals import refused, values_of

DIMENSIONS = get_args(Dimension)
numbers = st.floats(1e-29, 1e29) | st.floats(-1e29, -1e-29) | st.floats(-1e4, 1e4)
usual = numbers.filter(lambda x: x == 0 or abs(x) > 1e-29)


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("33.5 mm", "length", 0.0335),
        ("1 in", "length", 0.0254),
        (".5 ft", "length", 0.1524),
        ("-1.e+3 um", "length", -0.001),
        ("180 deg", "angle", pi),
        ("1 turn", "angle", 2 * pi),
        ("199 g", "mass", 0.199),
        ("1 lb", "mass", 0.45359237),
        ("16 oz", "mass", 0.45359237),
        ("30 kg mm^2", "inertia", 3e-5),
        ("30 kg*mm**2", "inertia", 3e-5),
        ("30 kg\N{MIDDLE DOT}mm\N{SUPERSCRIPT TWO}", "inertia", 3e-5),
        ("1 kgf cm s^2", "inertia", 0.0980665),
        ("1 gf cm s^2", "inertia", 9.80665e-5),
        ("1 lb ft^2", "inertia", 0.45359237 * 0.3048**2),
        ("60 rpm", "angular speed", 2 * pi),
        ("50 turn/s", "angular speed", 100 * pi),
        ("60 rpm/s", "angular acceleration", 2 * pi),
        ("-1 gn", "acceleration", -9.80665),
        ("1 kgf", "force", 9.80665),
        ("1 lbf", "force", 4.4482216152605),
        ("1 lbf in", "torque", 0.1129848290276167),
        ("1 kgf cm", "torque", 0.0980665),
        ("36 km/h", "speed", 10.0),
        ("50 Hz", "frequency", 50.0),
        ("1 kgf/mm", "stiffness", 9806.65),
        ("4 kN/mm", "stiffness", 4e6),
        ("4 MN/m", "stiffness", 4e6),
        ("7.85 g/cm^3", "density", 7850.0),
        ("7.85 kg/dm**3", "density", 7850.0),
        ("7850 kg/m\N{SUPERSCRIPT THREE}", "density", 7850.0),
        ("1 lb/in^3", "density", 0.45359237 / 0.0254**3),
        ("2 kJ", "energy", 2000.0),
    ],
)
def test_reads(text: str, dimension: Dimension, value: float) -> None:
    assert parse(text, dimension) == pytest.approx(value, rel=1e-15)


@given(st.decimals(-1000, 1000, places=4))
def test_reading_rounds_once(number: Decimal) -> None:
    expected = float(Fraction(number) / 1000)
    assert parse(f"{number:f} mm", "length") == (0 if abs(expected) < 1e-30 else expected)


def test_degrees_are_the_nearest_floats() -> None:
    digits = "3.14159265358979323846264338327950288419716939937510582097494459"
    with localcontext() as context:
        context.prec = 50
        for degrees in range(-360, 361):
            expected = float(Decimal(digits) * degrees / 180)
            assert parse(f"{degrees} deg", "angle") == expected


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("33,5 mm", "length", {"decimal": '"33.5 mm"'}),
        (
            "1,033 mm",
            "length",
            {"decimal": '"1.033 mm"', "whole": '"1033 mm"'},
        ),
        ("-12,000kg mm²", "inertia", {"decimal": '"-12.000 kg mm²"', "whole": '"-12000 kg mm²"'}),
        ("0,125 mm", "length", {"decimal": '"0.125 mm"'}),
        ("1,5e-3 m", "length", {"decimal": '"1.5e-3 m"'}),
        ("1,000.5 mm", "length", {"whole": '"1000.5 mm"'}),
        ("1.000,5 mm", "length", {"whole": '"1000.5 mm"'}),
        ("1,000,000 mm", "length", {"whole": '"1000000 mm"'}),
        ("1 000 mm", "length", {"whole": '"1000 mm"'}),
        ("1'000 mm", "length", {"whole": '"1000 mm"'}),
        ("33.5mm", "length", {"number": 33.5, "unit": "mm"}),
        ("nan mm", "length", {"by": "parse"}),
        ("inf m", "length", {"by": "parse"}),
        ("0x10 m", "length", {"by": "parse"}),
        ("1_000 mm", "length", {"whole": '"1000 mm"'}),
        ("1_0 mm", "length", {"by": "parse"}),
        ("\N{ARABIC-INDIC DIGIT THREE} mm", "length", {"by": "parse"}),
        ("5\N{NO-BREAK SPACE}mm", "length", {"by": "parse"}),
        ("5\tmm", "length", {"by": "parse"}),
        ("5 mm\n", "length", {"by": "parse"}),
        ("", "length", {"given": "''"}),
        ("12", "length", {"by": "parse"}),
        ("mm", "length", {"given": "'mm'", "example": "33.5 mm"}),
        ("1,5", "mass", {"such": "1.5 g"}),
        ("up", "angle", {"number": 90, "unit": "deg"}),
        ("north", "angle", {"example": "-83 deg"}),
        ("6000 U/min", "angular speed", {"number": 6000, "unit": "rpm"}),
        ("6000 min^-1", "angular speed", {"number": 6000, "unit": "rpm"}),
        ("5 newton metres", "torque", {"number": 5, "unit": "N m"}),
        ("5 metres/sec", "speed", {"number": 5, "unit": "m/s"}),
        ("100-300 rpm", "angular speed", {"low": "100 rpm"}),
        ("3 kg .. 4 kg", "mass", {"low": "3 kg"}),
        ("5 mm", "mass", {"unit": "mm"}),
        ("1 Hz", "angular speed", {"turns": 1, "rpm": 60}),
        ("5 Nm", "torque", {"number": 5, "unit": "N m"}),
        ("2 MNm", "torque", {"number": 2, "unit": "MN m"}),
        ("2 mNm", "torque", {"number": 2, "unit": "mN m"}),  # and not MN m, a billion times as much
        ("2 mN/m", "stiffness", {"unit": "'mN/m'"}),
        ("3 mn", "force", {"number": 3, "unit": "mN"}),
        ("3 Mw", "power", {"number": 3, "unit": "MW"}),
        ("3 KN", "force", {"number": 3, "unit": "kN"}),
        ("5 kg mm2", "inertia", {"number": 5, "unit": "kg mm^2"}),
        ("aluminum", "density", {"given": "'aluminum'", "name": "aluminum"}),
        ("5 kg/m3", "density", {"number": 5, "unit": "kg/m^3"}),
        ("5 kg/m^2", "density", {"unit": "'kg/m^2'"}),
        ("5 N m", "energy", {"unit": "N m"}),
        ("5\N{DEGREE SIGN}", "angle", {"number": 5, "unit": "deg"}),
        ("5 furlong", "length", {"unit": "'furlong'"}),
        ("1e999 m", "length", {"by": "parse"}),
        ("1e-40 m", "length", {"by": "parse"}),
        (33.5, "length", {"number": 33.5}),
        pytest.param(16**5000, "length", {"by": "parse"}, id="endless"),
        (True, "length", {"given": "true"}),
        (None, "length", {"by": "parse"}),
        ({}, "length", {"by": "parse"}),
    ],
)
def test_refuses(text: object, dimension: Dimension, expected: dict[str, Any]) -> None:
    with refused(UsageError, **expected) as caught:
        parse(text, dimension)
    assert "\n" not in str(caught.value)


def complaint(text: str, dimension: Dimension) -> str:
    try:
        parse(text, dimension)
    except UsageError as error:
        return str(error)
    return ""


@given(st.text() | st.from_regex(r"[0-9.,eE+-]{1,6} ?[a-zA-Z/^*2 ]{1,8}"))
def test_any_text_is_read_or_refused_in_one_short_sentence(text: str) -> None:
    for dimension in DIMENSIONS:
        said = complaint(text, dimension)
        assert len(said) < 600
        assert said.startswith("got ") or re.fullmatch(quantities.pattern(dimension), text)


@given(usual, st.sampled_from(DIMENSIONS))
def test_writing_is_exact(value: float, dimension: Dimension) -> None:
    text = format_exact(value, dimension)
    assert parse(text, dimension) == value
    assert re.fullmatch(quantities.pattern(dimension), text)


@given(st.integers(-(10**6), 10**6), st.sampled_from(["mm", "m"]))
def test_writing_gives_short_text_back(tenths: int, unit: str) -> None:
    value = parse(f"{tenths}e-1 {unit}", "length")
    assert len(format_exact(value, "length")) <= len(f"{tenths / 10} {unit}") + 1


@pytest.mark.parametrize(
    "text", ["33.5 mm", "1.5 m", "-83 deg", "193 rpm", "199 g", "1.2 kg", "30 kg mm^2", "0 mm"]
)
def test_writing_prefers_the_usual_unit(text: str) -> None:
    dimension = next(d for d in DIMENSIONS if text.split(" ", 1)[1] in KINDS[d].units)
    assert format_exact(parse(text, dimension), dimension) == text


def test_printed_units_are_listed() -> None:
    for kind in KINDS.values():
        assert set(kind.printed) <= set(kind.units)


def test_no_unit_is_in_two_lists() -> None:
    listed = [unit for kind in KINDS.values() for unit in kind.units]
    assert len(set(listed)) == len(listed)


@pytest.mark.parametrize(
    ("given", "turns", "rpm"),
    [
        ("1", "1", 60.0),
        ("20", "20", 1200.0),
        ("-2.5", "-2.5", -150.0),
        ("1e3", "1e3", 60_000.0),
        ("1e-9", "1e-9", 6e-8),
        ("0.33333333", "0.33333333", 19.9999998),
        ("0", "0", 0.0),
    ],
)
def test_hertz_are_refused_with_the_same_speed_in_units_that_say_what_turns(
    given: str, turns: str, rpm: float
) -> None:
    """Both that are offered can be read, and are one speed."""
    with refused(UsageError, turns=turns) as caught:
        parse(f"{given} Hz", "angular speed")
    offered = dict(values_of(caught.value.note))
    assert float(offered["rpm"]) == pytest.approx(rpm, rel=1e-12)
    assert parse(f"{offered['rpm']} rpm", "angular speed") == pytest.approx(
        parse(f"{offered['turns']} turn/s", "angular speed"), rel=1e-12
    )
