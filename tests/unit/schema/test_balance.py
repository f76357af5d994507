"""[balance] of the model file: read in SI units, and written such that it is read again."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from math import pi, radians
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from equipoise.mechanism.outputs.declared import DECLARED
from equipoise.mechanism.parts.balance import (
    MATERIALS,
    MEASURED_IN,
    MEASURES,
    SHAPES,
    AddedMass,
    Balance,
    BalanceShafts,
    CenterMove,
    GearedWeight,
    Limit,
    Objective,
    Phases,
    SpringChoice,
    Weight,
)
from equipoise.schema import dumps, loads
from unit.schema.samples import BALANCE, FOUR_BAR, ROWS, SUPPORT, VALIDATOR, survives

BASE = FOUR_BAR + SUPPORT + ROWS
RPM = 2 * pi / 60


def balance_of(text: str) -> Balance:
    balance = loads(BASE + text).balance
    assert balance is not None
    return balance


# -- reading ---------------------------------------------------------------------------------------


def test_all_values_arrive_in_si_units() -> None:
    balance = balance_of(BALANCE)
    assert (balance.added_mass, balance.combine) == (0.5, "squares")
    assert balance.phases == Phases(radians(10))
    assert balance.moves == (CenterMove("crank", (-0.06, 0.02), (-0.03, 0.03)),)
    assert balance.masses == (
        AddedMass("crank", "A", Weight("sector", 0.06, 0.01, 0.008, 7850.0, at_most=0.8)),
        AddedMass("rocker", "D", Weight(mass=0.5)),
    )
    assert balance.geared == (
        GearedWeight("rocker", Weight(radius=0.04), (0.3, 2.0), pitch_radius=0.05,
                     direction=(0.0, 0.0),
                     gear_thickness=0.008, gear_density=7850.0, clear_of=("coupler",)),
        GearedWeight("crank", Weight("disc", 0.04, 0.0, 0.008, 7800.0), teeth=(17, 80),
                     module=0.002, axis=(0.1, 0.0), gear_thickness=0.008, gear_density=7800.0,
                     name="other"),
    )  # fmt: skip
    assert balance.shafts == (BalanceShafts(2, ((0.0, -0.06), (0.04, -0.06)), Weight(radius=0.03)),)
    assert balance.springs == (SpringChoice("rocker", "C", "A", 5000.0, (0.02, 0.12)),)
    assert balance.objectives == (
        Objective("shaking_moment", "peak", (1.0, 2.0), "D", 2.0),
        Objective("gauges.handle", speeds=(150 * RPM, 240 * RPM)),
    )
    assert balance.limits == (
        Limit(Objective("joints.B", "peak"), at_most=120.0),
        Limit(Objective("shaking_force.x", "area"), ratio=0.8),
    )


def test_few_values_and_the_defaults_of_the_others() -> None:
    assert loads(FOUR_BAR).balance is None
    assert balance_of("[balance]\n") == Balance()
    assert balance_of("[balance.phases]\n") == Balance(phases=Phases())
    text = '[[balance.geared]]\ndriver = "rocker"\nratio = 1\npitch_radius = "1 cm"\nmass = "1 g"\n'
    assert balance_of(text).geared[0].ratio == (1.0, 1.0)


@pytest.mark.parametrize(
    ("output", "measure", "at_most", "value"),
    [
        ("shaking_force", "rms", "2 kN", 2000.0),
        ("joints.B.x", "peak_to_peak", "1 kgf", 9.80665),
        ("drive_torque", "peak", "3 N cm", 0.03),
        ("yaw_moment", "ripple", "3 N m", 3.0),
        ("drive_torque", "area", "2 kJ", 2000.0),
        ("gauges.handle", "peak", "2 mm", 0.002),
        ("gauges.nod", "peak", "180 deg", pi),
    ],
)
def test_units_of_limits(output: str, measure: str, at_most: str, value: float) -> None:
    text = f'[[balance.limits]]\noutput = "{output}"\nmeasure = "{measure}"\nat_most = "{at_most}"'
    assert balance_of(text).limits[0].at_most == pytest.approx(value, rel=1e-15)
    VALIDATOR.validate(tomllib.loads(BASE + text))
    assert loads(dumps(loads(BASE + text))) == loads(BASE + text)


@pytest.mark.parametrize("material", MATERIALS)
def test_materials(material: str) -> None:
    plate = 'shape = "disc"\nradius = "1 cm"\nthickness = "1 mm"\n'
    text = f'[[balance.masses]]\nlink = "crank"\nat = "A"\n{plate}material = "{material}"\n'
    assert balance_of(text).masses[0].weight.density == MATERIALS[material]
    assert f'material = "{material}"' in dumps(loads(BASE + text))
    VALIDATOR.validate(tomllib.loads(BASE + text))


def test_dimensions_of_limits_are_those_of_outputs() -> None:
    linear = {value.dimension for value in DECLARED.values() if not value.reason}
    assert linear | {"energy", "angle"} == {*MEASURED_IN}


# -- writing ---------------------------------------------------------------------------------------


def test_it_is_written_as_people_write_it() -> None:
    machine = loads(BASE + BALANCE)
    assert dumps(machine).endswith(BALANCE)
    VALIDATOR.validate(tomllib.loads(dumps(machine)))
    empty = loads(f"{BASE}\n[balance]\n")
    assert dumps(empty).endswith("\n[balance]\n")
    assert loads(dumps(empty)) == empty


length = st.floats(1e-6, 1e6)
mass = st.floats(1e-6, 1e6)
number = st.just(0.0) | length | length.map(lambda x: -x)
places = st.tuples(number, number)
ranges = st.tuples(number, number).map(sorted).map(tuple)
sizes = st.tuples(length, length).map(sorted).map(tuple)
ratios = st.tuples(*[st.floats(1e-6, 1e3)] * 2).map(sorted).map(tuple)
masses = st.none() | mass
density = st.sampled_from([*MATERIALS.values()]) | st.floats(1.0, 2e4)


@st.composite
def weights(draw: Any, shapes: tuple[Any, ...] = SHAPES) -> Weight:
    shape = draw(st.sampled_from(shapes))
    radius, most = draw(st.floats(1e-6, 1e3)), draw(masses)
    if shape in {"any", "point"}:
        given = Weight(shape, mass=radius), Weight(shape, radius, at_most=most)
        return given[draw(st.integers(0, 1))]
    inner = 0.0 if shape == "disc" else radius * draw(st.just(0.0) | st.floats(0.1, 0.9))
    return Weight(shape, radius, inner, draw(length), draw(density), at_most=most)


moves = st.builds(CenterMove, st.just("crank"), x=st.none() | ranges, y=ranges) | st.builds(
    CenterMove, st.just("crank"), center=places, radius=length
)
added = st.builds(AddedMass, st.just("crank"), st.sampled_from("AB"), weights())
gears = st.fixed_dictionaries(
    {
        "ratio": st.tuples(*[st.floats(1e-6, 1e3)] * 2).map(sorted).map(tuple),
        "pitch_radius": length,
        "direction": st.none() | ranges,
    }
) | st.fixed_dictionaries(
    {"teeth": st.tuples(st.integers(5, 20), st.integers(20, 99)), "module": length}
)
plates = st.just({}) | st.fixed_dictionaries({"gear_thickness": length, "gear_density": density})


@st.composite
def geared(draw: Any) -> GearedWeight:
    clear = draw(st.sampled_from([(), ("coupler",), ("crank", "coupler")]))
    return GearedWeight("rocker", draw(weights()), clear_of=clear, **draw(gears), **draw(plates))


shafts = st.builds(
    BalanceShafts,
    st.sampled_from([1, 2]),
    st.tuples(places, places).filter(lambda axes: axes[0] != axes[1]),
    weights(("any", "point", "disc", "sector")),
    st.sampled_from(["balance-shaft", "né"]),
)
springs = st.builds(
    SpringChoice, st.just("rocker"), st.just("C"), st.just("A"), length, st.none() | sizes
)
wishes = st.builds(
    Objective,
    st.sampled_from(["drive_torque", "joints.B.x", "frame_force.y", "yaw_moment", "gauges.nod"]),
    st.sampled_from(MEASURES),
    st.lists(st.integers(0, 9).map(float) | length, unique=True, max_size=3).map(tuple),
    weight=length,
) | st.builds(
    Objective,
    st.just("gauges.handle"),
    speeds=st.lists(length, unique=True, max_size=3).map(tuple),
)
limits = st.builds(Limit, wishes.map(lambda wish: replace(wish, weight=1.0)), ratio=length) | (
    st.builds(
        Limit,
        st.sampled_from(MEASURES).map(lambda m: Objective("frame_moment", m)),
        at_most=length,
    )
)


def some(items: Any, most: int = 3) -> Any:
    return st.lists(items, max_size=most).map(tuple)


@given(
    st.builds(
        Balance,
        some(moves, 1),
        some(added),
        some(geared(), 1),
        some(shafts, 1),
        some(springs),
        st.none() | st.builds(Phases, st.floats(1e-6, 1.5)),
        some(wishes),
        some(limits),
        st.sampled_from(["sum", "squares"]),
        masses,
    )
)
def test_random_tables_survive(balance: Balance) -> None:
    machine = loads(BASE).with_balance(balance)
    survives(machine)
