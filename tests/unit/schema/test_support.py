"""Support and rows of the model file: read, and written again."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from math import pi, radians
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from equipoise.mechanism.support import AXES, FREEDOMS, UP, Gauge, Mount, Row, Support
from equipoise.schema import dumps, json_schema, loads
from unit.schema.samples import BODY, FOUR_BAR, ROWS, SUPPORT, SUPPORTED

VALIDATOR = Draft202012Validator(json_schema())
SPATIAL = """
[support]
mass = "60 kg"
center_of_mass = ["0 mm", "300 mm", "-10 mm"]
inertia = ["3 kg m^2", "5 kg m^2", "4 kg m^2"]
products = ["0.1 kg m^2", "0 kg m^2", "-2000 kg cm^2"]
freedoms = ["pitch", "roll", "heave"]
"""
PIVOTED = """
[support]
mass = "60 kg"
center_of_mass = { distance = "300 mm", direction = "90 deg" }
pivot_inertia = "10 kg m^2"
pivot = ["0 mm", "-100 mm"]
"""


def support_of(text: str) -> Support:
    support = loads(FOUR_BAR + text).support
    assert support is not None
    return support


# -- reading ---------------------------------------------------------------------------------------


def test_few_values_and_the_defaults_of_the_others() -> None:
    assert support_of(BODY) == Support(60.0, (0.0, 0.3, 0.0), (4.0,))
    bare = loads(FOUR_BAR)
    assert (bare.support, bare.rows) == (None, ())
    assert loads(f"{FOUR_BAR}\n[[rows]]\n").rows == (Row(),)


def test_all_values_arrive_in_si_units() -> None:
    assert support_of(SPATIAL) == Support(
        60.0, (0.0, 0.3, -0.01), (3.0, 5.0, 4.0), (0.1, 0.0, -0.2),
        freedoms=("pitch", "roll", "heave"),
    )  # fmt: skip
    assert support_of(SPATIAL).coordinates == ("heave", "roll", "pitch")
    assert support_of(PIVOTED) == Support(
        60.0, (0.0, 0.3, 0.0), pivot_inertia=10.0, pivot=(0.0, -0.1)
    )
    support = support_of(SUPPORT)
    assert support.mounts == {
        "front": Mount((0.4, -0.2, 0.0), UP, 5e4, 400.0),
        "float": Mount((-0.4, -0.2, 0.03), (0.5, 2.0, 0.0), 9806.65, 0.0, 90.0, True),
        "hitch": Mount(
            axis="pitch", torsional_stiffness=500.0, torsional_damping=3.0, preload=-20.0
        ),
    }
    assert list(support.mounts) == ["front", "float", "hitch"]
    handle = support.gauges["handle"]
    assert handle.point == pytest.approx((-(0.5**0.5), 0.5**0.5, 0.0), abs=1e-15)
    assert handle.direction == pytest.approx(radians(-30), rel=1e-15)
    assert support.gauges["nod"] == Gauge(axis="pitch")
    assert loads(FOUR_BAR + ROWS).rows == (Row(0.0, -0.15), Row(pi, 0.15, (0.02, -0.005)))


TEXTS = {"short": BODY, "spatial": SPATIAL, "pivoted": PIVOTED, "all": SUPPORTED, "sample": SUPPORT}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_schema_accepts_what_is_read(text: str) -> None:
    VALIDATOR.validate(tomllib.loads(FOUR_BAR + text))
    VALIDATOR.validate(tomllib.loads(dumps(loads(FOUR_BAR + text))))


# -- writing ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_what_is_written_is_read_again(text: str) -> None:
    machine = loads(FOUR_BAR + text)
    assert loads(dumps(machine)) == machine
    assert dumps(loads(dumps(machine))) == dumps(machine)


def test_a_support_is_written_as_people_write_it() -> None:
    text = """
[support]
mass = "60 kg"
center_of_mass = ["0 mm", "300 mm"]
inertia = "4 kg m^2"

[support.mounts.front]
point = ["400 mm", "-200 mm", "1 m"]
direction = [0, 1, -0.5]
stiffness = "500 N/m"
preload = "0 N"
one_sided = true

[support.mounts."rear axle"]
axis = "pitch"
torsional_damping = "3 N m s/rad"
torsional_preload = "0 N m"

[support.gauges.handle]
point = ["0 mm", "1 m"]
direction = "45 deg"

[[rows]]
lateral = "-150 mm"

[[rows]]
phase = "180 deg"
lateral = "150 mm"
offset = ["20 mm", "0 mm"]
"""
    assert dumps(loads(FOUR_BAR + text)) == FOUR_BAR + text


size = st.floats(1e-20, 1e20)
number = st.just(0.0) | size | size.map(lambda x: -x)
place = st.tuples(number, number, number)
direction = st.just(UP) | st.floats(1e-9, 20) | st.tuples(number, number, number).filter(any)
names = st.text(min_size=1, max_size=8).filter(lambda name: name.isprintable() and name.strip())
positive = st.just(0.0) | size
at_a_point = st.builds(
    Mount,
    point=place,
    direction=direction,
    stiffness=size,
    damping=positive,
    preload=st.none() | number,
    one_sided=st.booleans(),
)
about_an_axis = st.builds(
    Mount,
    axis=st.sampled_from(AXES),
    torsional_stiffness=positive,
    torsional_damping=size,
    preload=st.none() | number,
)
gauges = st.builds(Gauge, point=place, direction=direction) | st.builds(
    Gauge, axis=st.sampled_from(AXES)
)
rows = st.builds(Row, phase=number, lateral=number, offset=st.tuples(number, number))


@st.composite
def bodies(draw: Any) -> dict[str, Any]:
    """Inertia, pivot and freedoms that go together."""
    pivot = draw(st.none() | st.tuples(number, number))
    left = FREEDOMS if pivot is None else AXES  # a pin leaves rotations only
    spatial = st.lists(st.sampled_from(left), unique=True).map(tuple)
    if draw(st.booleans()):
        moment = draw(size)
        products = draw(st.just(()) | st.tuples(*[st.floats(1e-3, 0.3)] * 3))
        return {
            "inertia": (moment, 1.5 * moment, moment),
            "products": tuple(moment * share for share in products),
            "pivot": pivot,
            "freedoms": draw(spatial),
        }
    return {"inertia": (draw(size),), "pivot": pivot, "freedoms": draw(st.just(("pitch",)))}


@given(
    size,
    place,
    bodies(),
    st.dictionaries(names, at_a_point | about_an_axis, max_size=3),
    st.dictionaries(names, gauges, max_size=3),
    st.lists(rows, max_size=3).map(tuple),
)
def test_random_supports_survive(
    mass: float,
    center: Any,
    body: dict[str, Any],
    mounts: dict[str, Mount],
    gauges: dict[str, Gauge],
    rows: tuple[Row, ...],
) -> None:
    support = Support(mass, center, mounts=mounts, gauges=gauges, **body)
    machine = replace(loads(FOUR_BAR), support=support, rows=rows)
    text = dumps(machine)
    try:
        text.encode()
    except UnicodeEncodeError:  # half of a surrogate pair is no text
        return
    VALIDATOR.validate(tomllib.loads(text))
    assert loads(text) == machine
    assert list(loads(text).support.mounts) == list(mounts)  # type: ignore[union-attr]


@given(size, st.tuples(number, number))
def test_random_pivots_survive(mass: float, pivot: Any) -> None:
    machine = loads(FOUR_BAR).with_support(
        mass=mass, center_of_mass=(*pivot, 0.0), pivot=pivot, pivot_inertia=1e20
    )
    assert loads(dumps(machine)) == machine
