"""One formatter of numbers: digits, rounding, units that suit the size."""

from __future__ import annotations

from math import inf, pi

import numpy as np
import pytest

from equipoise.quantities import (
    KINDS,
    angle,
    change,
    display,
    display_rules,
    in_unit,
    number,
    percent,
    span,
    typeset,
)


@pytest.mark.parametrize(
    ("value", "scale", "text"),
    [
        (0.0, 0.0, "0"),
        (-0.0, 0.0, "0"),
        (12.3456, 0.0, "12.35"),
        (-0.0012344, 0.0, "-0.001234"),
        (0.00012344, 0.0, "1.234e-04"),
        (999999.4, 0.0, "999999"),
        (1e6, 0.0, "1.000e+06"),
        (1e-12, 1.0, "0"),
        (1e-9, 1.0, "1.000e-09"),
        (inf, 0.0, "inf"),
    ],
)
def test_a_number_has_four_digits_and_rounding_is_zero(
    value: float, scale: float, text: str
) -> None:
    assert number(value, scale) == text


def test_nothing_rounds_to_minus_zero() -> None:
    assert angle(-1e-9) == "0.0°" and percent(-1e-9) == "0" and percent(-0.0004, 1) == "0.0"


def test_a_change_is_reported_with_its_sign_and_none_from_nothing() -> None:
    assert change(2.0, 1.0) == "-50.0 %" and change(1.0, 1.0001) == "±0 %"
    assert change(0.0, 1.0) == ""


def test_a_span_of_equal_values_is_one_number() -> None:
    assert span(np.array([1.0, 1.0 + 1e-12])) == "1.000"
    assert span([-1.0, 2.0]) == "-1.000 to 2.000"


def test_print_has_true_signs() -> None:
    assert typeset("-1.234e-04") == "−1.234×10⁻⁴" and typeset("kg mm^2") == "kg mm²"
    assert typeset("-83 deg") == "−83 deg"  # words keep their letters


@pytest.mark.parametrize(
    ("values", "unit", "factor"),
    [([0.5], "N", 1.0), ([2e-4], "mN", 1e3), ([2e4, 1.0], "kN", 1e-3), ([], "N", 1.0)],
)
def test_the_unit_suits_the_size(values: list[float], unit: str, factor: float) -> None:
    shown = display("force", values)
    assert (shown.name, shown.factor) == (unit, pytest.approx(factor))


def test_values_that_are_not_finite_choose_no_unit() -> None:
    assert display("length", [inf, 0.01]).unit == "mm"


def test_a_unit_that_is_asked_for() -> None:
    assert in_unit("deg").text(pi) == "180.0" and in_unit("mrad").text(1e-3) == "1.000"
    assert display("angle", [1e-3], "mrad").name == "mrad"


def test_the_page_gets_the_same_rules() -> None:
    rules = display_rules()
    assert number(rules["least"]) == "0.001000" and "e" in number(0.99 * rules["least"])
    assert "e" in number(rules["most"]) and "e" not in number(0.99 * rules["most"])
    assert {unit for kind in KINDS.values() for unit in kind.units} < set(rules["units"])
