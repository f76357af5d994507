"""Motor, planting, support and rows of a linkage's file: read in SI units, and written again."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from math import pi, radians
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from equipoise.mechanism.parts.field import Planting, Soil, SoilTable
from equipoise.mechanism.parts.motors import Motor
from equipoise.mechanism.parts.support import AXES, FREEDOMS, UP, Gauge, Mount, Row, Support
from equipoise.schema import dumps, loads
from unit.schema.samples import (
    BODY,
    FOUR_BAR,
    MOTOR,
    PLANTING,
    ROWS,
    SUPPORT,
    SUPPORTED,
    VALIDATOR,
    survives,
)

RPM = 2 * pi / 60
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


FULL = """
[planting]
tip = "C"
hill_spacing = "15 cm"
units_per_turn = 2
travel = "backward"
surface = "-120 mm"
finger_from = "B"
release = "-10 deg"
tray = [["-100 mm", "2 cm"], { distance = "50 mm", direction = "90 deg" }]
acceleration_limit = "20 gn"
soil_acceleration_limit = "100 m/s^2"

[planting.soil]
resistance = "2 kgf"
per_depth = "0.3 N/mm"
per_speed = "4 N s/m"
per_depth_and_speed = "1 kN s/m^2"
"""
VALUES = Planting(
    tip="C",
    hill_spacing=0.15,
    units_per_turn=2,
    travel="backward",
    surface=-0.12,
    finger_from="B",
    release=radians(-10),
    tray=((-0.1, 0.02), (0.0, 0.05)),
    acceleration_limit=196.133,
    soil_acceleration_limit=100.0,
    soil=Soil(19.6133, 300.0, 4.0, 1000.0),
)


def support_of(text: str) -> Support:
    support = loads(FOUR_BAR + text).support
    assert support is not None
    return support


# -- reading ---------------------------------------------------------------------------------------


def test_flywheel_and_motor() -> None:
    assert loads(FOUR_BAR + MOTOR).drive.motor == Motor(3000 * RPM, 2.0)
    more = 'ratio = 25\ninertia = "80 g cm^2"\nmean_speed = "free"\n'
    motor = loads(FOUR_BAR + MOTOR + more).drive.motor
    assert motor == Motor(3000 * RPM, 2.0, ratio=25.0, inertia=8e-6, mean_speed="free")
    text = FOUR_BAR.replace("[frame]", 'flywheel = "2 kg cm^2"\n[frame]')
    assert loads(text).drive.flywheel == 2e-4
    assert loads(FOUR_BAR).drive.flywheel == 0
    assert loads(FOUR_BAR).drive.motor is None


def test_planting() -> None:
    few, full = loads(FOUR_BAR + PLANTING), loads(FOUR_BAR + FULL)
    assert few.planting == Planting(tip="C", forward_speed=0.6, depth=0.04)
    assert full.planting == VALUES
    assert loads(FOUR_BAR).planting is None


def test_a_support_of_few_values() -> None:
    assert support_of(BODY) == Support(60.0, (0.0, 0.3, 0.0), (4.0,))
    bare = loads(FOUR_BAR)
    assert (bare.support, bare.rows) == (None, ())
    assert loads(f"{FOUR_BAR}\n[[rows]]\n").rows == (Row(),)


def test_supports_and_rows() -> None:
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


TEXTS = {
    "motor": MOTOR,
    "geared motor": f"{MOTOR}ratio = 2.5\n",
    "planting": PLANTING,
    "all of planting": FULL,
    "support": BODY,
    "spatial": SPATIAL,
    "pivoted": PIVOTED,
    "mounts": SUPPORTED,
    "gauges": SUPPORT,
}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_what_is_written_is_read_again(text: str) -> None:
    VALIDATOR.validate(tomllib.loads(FOUR_BAR + text))
    written = survives(loads(FOUR_BAR + text))
    assert dumps(loads(written)) == written


# -- writing ---------------------------------------------------------------------------------------


def test_a_motor_is_written_as_people_write_it() -> None:
    written = dumps(loads(FOUR_BAR + MOTOR))
    assert f'speed = "193 rpm"\n{MOTOR}\n[frame]\n' in written


def test_planting_is_written_as_people_write_it() -> None:
    written = dumps(loads(FOUR_BAR + PLANTING))
    assert written.startswith(FOUR_BAR)
    assert written.endswith('\n[planting]\ntip = "C"\nforward_speed = "0.6 m/s"\ndepth = "40 mm"\n')
    soil = planting_lines(dumps(loads(FOUR_BAR + FULL)))
    assert 'soil.per_depth = "300 N/m"' in soil
    assert 'tray = [["-100 mm", "20 mm"], ["0 mm", "50 mm"]]' in soil
    assert 'travel = "backward"' in soil


def planting_lines(text: str) -> list[str]:
    return text.partition("[planting]\n")[2].splitlines()


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
positive = st.just(0.0) | size
place = st.tuples(number, number, number)
direction = st.just(UP) | st.floats(1e-9, 20) | st.tuples(number, number, number).filter(any)
names = st.text(min_size=1, max_size=8).filter(lambda name: name.isprintable() and name.strip())
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
    text = survives(machine)
    assert list(loads(text).support.mounts) == list(mounts)  # type: ignore[union-attr]


@given(size, st.tuples(number, number))
def test_random_pivots_survive(mass: float, pivot: Any) -> None:
    machine = loads(FOUR_BAR).with_support(
        mass=mass, center_of_mass=(*pivot, 0.0), pivot=pivot, pivot_inertia=1e20
    )
    survives(machine)


@given(size, size, size, positive, positive, st.sampled_from(["held", "free"]))
def test_random_motors_survive(
    speed: float, torque: float, ratio: float, inertia: float, flywheel: float, mean: str
) -> None:
    motor = Motor(speed, torque, ratio=ratio, inertia=inertia, mean_speed=mean)  # type: ignore[arg-type]
    machine = loads(FOUR_BAR).with_drive(flywheel=flywheel, motor=motor)
    survives(machine)


length = st.floats(1e-12, 1e12)
ends = st.tuples(length, length.map(lambda x: -x))


@given(st.data())
def test_random_planting_survives(data: st.DataObject) -> None:
    draw = data.draw
    tray = draw(st.none() | st.tuples(ends, ends).filter(lambda both: both[0] != both[1]))
    optional = st.none() | size
    table = draw(st.none() | st.just(SoilTable((0.0, 1.0), (1.0, 2.0), "s.csv")))
    terms = [draw(st.just(0.0) | size) for _ in range(4)]
    soil = Soil(*terms, table) if any(terms) or table else None
    speed, depth = draw(st.tuples(st.booleans(), st.booleans()))
    planting = Planting(
        tip="C",
        forward_speed=draw(st.just(0.0) | size) if speed else None,
        hill_spacing=None if speed else draw(size),
        units_per_turn=draw(st.integers(1, 10**6)),
        travel=draw(st.sampled_from(["forward", "backward"])),
        depth=draw(size) if depth else None,
        surface=None if depth else draw(st.floats(-1e6, 1e6).filter(big)),
        finger_from=draw(st.sampled_from([None, "B"])),
        release=draw(st.none() | st.floats(-20, 20).filter(big)),
        tray=tray,
        acceleration_limit=draw(optional),
        soil_acceleration_limit=draw(optional),
        soil=soil,
    )
    machine = replace(loads(FOUR_BAR), planting=planting)
    text = dumps(machine)
    content = tomllib.loads(text)
    VALIDATOR.validate(content)
    if table is not None:
        assert content["planting"]["soil"].pop("table") == "s.csv"
        text = text.replace('soil.table = "s.csv"\n', "")
        bare = replace(soil, table=None) if any(terms) else None
        planting = replace(planting, soil=bare)
    assert loads(text).planting == planting


def big(value: float) -> bool:
    """Whether a value is 0 or one that a machine can have."""
    return value == 0 or abs(value) > 1e-20
