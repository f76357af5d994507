"""Units in which values are shown: chosen ones, what follows from them, and what suits the size."""

from __future__ import annotations

from threading import Thread
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.parts.shown_units import ShownUnits, read_units
from equipoise.quantities import (
    KINDS,
    Dimension,
    angle,
    chosen_unit,
    display,
    format_exact,
    format_quantity,
    in_unit,
    number,
    parse,
    showing,
    showing_by_default,
)
from equipoise.quantities.numbers import _SCALES, LARGE, SMALL
from support.refusals import refused

INCHES: dict[Dimension, str] = {"length": "in", "force": "lbf", "mass": "lb"}


def test_units_are_chosen_inside_their_block_and_in_its_thread_only() -> None:
    heard: list[str] = []
    with showing({"length": "in"}):
        Thread(target=lambda: heard.append(display("length").unit)).start()
        with showing_by_default({"length": "cm", "mass": "t"}):
            heard += [display("length").unit, display("mass").unit]
    assert sorted(heard) == ["in", "mm", "t"] and display("length").unit == "mm"


def test_what_follows_from_chosen_units_is_shown_in_them() -> None:
    wanted: dict[Dimension, str] = {
        "speed": "in/s", "acceleration": "in/s^2", "torque": "lbf in", "inertia": "lb in^2",
        "stiffness": "lbf/in", "damping": "lbf s/in", "unbalance": "lb in",
        "torsional stiffness": "lbf in/rad", "bending stiffness": "lbf in^2",
    }  # fmt: skip
    with showing(INCHES):
        assert {kind: display(kind).unit for kind in wanted} == wanted
        assert format_quantity(1.3558179483314004, "torque") == "12.00 lbf in"
    with showing({"length": "cm", "force": "kN"}):  # metric units leave the others as they are
        assert [display(kind).unit for kind in wanted] == [
            "m/s", "m/s^2", "N m", "kg mm^2", "N/m", "N s/m", "g mm", "N m/rad", "N m^2",
        ]  # fmt: skip
    with showing({"length": "in", "speed": "km/h"}):
        assert chosen_unit("speed") == "km/h" and chosen_unit("torque") is None


@pytest.mark.parametrize(
    ("dimension", "value", "unit", "text"),
    [
        ("mass", 1437.0, None, "1437 kg"),
        ("mass", 1437.0, "g", "1437 kg"),
        ("mass", 12.0, "g", "12000 g"),
        ("mass", 52_000.0, None, "52.00 t"),
        ("mass", 1e-12, None, "1.000 ng"),
        ("length", 5.0, "mm", "5000 mm"),
        ("length", 2e-9, None, "2.000 nm"),
        ("force", 3e4, None, "30.00 kN"),
        ("stiffness", 4e6, "N/m", "4000 kN/m"),
        ("stiffness", 20_000.0, "N/m", "20000 N/m"),
        ("inertia", 4e-5, "kg m^2", "40.00 kg mm²"),
        ("angular speed", 2e4, "rpm", "190986 rpm"),
        ("unbalance", 650.0, None, "650.0 kg m"),
    ],
)
def test_the_unit_suits_the_size_of_any_machine(
    dimension: Dimension, value: float, unit: str | None, text: str
) -> None:
    assert format_quantity(value, dimension, unit) == text


@given(st.sampled_from([*KINDS]), st.floats(1e-6, 1e6))
def test_no_size_of_a_usual_machine_needs_a_power_of_ten(dimension: Dimension, size: float) -> None:
    """Where there are units for it: from the smallest to the largest of its scale."""
    shown = display(dimension, [size])
    scale = next((item for item in _SCALES if shown.unit in item), (shown.unit,))
    ends = (SMALL / in_unit(scale[0]).factor, LARGE / in_unit(scale[-1]).factor)
    if ends[0] <= size <= ends[1]:
        assert "e" not in shown.text(size)
    # the same value, whatever unit tells it
    assert float(shown.text(size, digits=12)) / shown.factor == pytest.approx(size, rel=1e-10)


@given(
    st.sampled_from([(kind, unit) for kind, name in KINDS.items() for unit in name.units]),
    st.decimals(-9999, 9999, allow_nan=False, places=3),
)
def test_a_rounded_number_comes_back_as_it_was_typed(kind: tuple[Dimension, str], typed) -> None:  # type: ignore[no-untyped-def]
    """Whatever unit it was typed in and whatever unit is wanted: what is written is read back, and
    no longer than what was typed where that unit is the wanted one."""
    dimension, unit = kind
    value = parse(f"{typed} {unit}", dimension)
    assert parse(format_exact(value, dimension), dimension) == value
    with showing({dimension: unit}):
        written = format_exact(value, dimension)
        assert parse(written, dimension) == value
        assert len(written.split()[0]) <= len(f"{typed:f}")
        assert display(dimension, [value]).unit == unit
        if dimension != "angle":
            text, near = display(dimension).text(value), value / parse(f"1 {unit}", dimension)
            # half a digit is rounded either way, by how the unit's factor is rounded
            assert text in {number(near * (1 + off)) for off in (-1e-12, 1e-12)}


def test_angles_have_their_unit() -> None:
    assert angle(1.0) == "57.3°" and angle(-1e-9) == "0.0°"
    with showing({"angle": "rad"}):
        assert angle(1.0) == "1.000 rad"


# -- what is given ---------------------------------------------------------------------------------


def test_units_are_read_by_name_or_by_themselves() -> None:
    assert read_units("length=in, force=lbf") == {"length": "in", "force": "lbf"}
    assert read_units("in, lbf,angular speed = rpm, N·m") == {
        "length": "in", "force": "lbf", "angular speed": "rpm", "torque": "N m",
    }  # fmt: skip
    assert read_units(" , ") == {}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("furlong", {"by": "_named"}),
        ("inch", {"meant": "in"}),
        ("length=kg", {"dimension": "length"}),
        ("length=inch", {"dimension": "length", "meant": "in"}),
        ("lenght=mm", {"given": "lenght", "name": "length"}),
        ("length", {"by": "_named"}),
        ("mm, cm", {"first": "mm", "second": "cm", "dimension": "length"}),
    ],
)
def test_a_wrong_unit_is_reported_with_what_there_is(text: str, expected: dict[str, Any]) -> None:
    with refused(UsageError, **expected):
        read_units(text)


def test_a_wrong_unit_in_python() -> None:
    with refused(ModelError, "length", meant="in", given="'inch'", dimension="length"):
        ShownUnits(length="inch")
    assert ShownUnits(length="in", angular_speed="rpm").by_dimension == {
        "length": "in", "angular speed": "rpm",
    }  # fmt: skip


def test_stresses_are_in_the_unit_of_workshops() -> None:
    """Of parts from a soft bearing to steel, and their wear."""
    for stress, text in ((316_506.0, "0.3165 MPa"), (75.98e6, "75.98 MPa"), (206e9, "206.0 GPa")):
        assert format_quantity(stress, "modulus") == text
    assert format_quantity(1.623e6, "pressure times speed") == "1.623 MPa m/s"
