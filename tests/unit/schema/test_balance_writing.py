"""[balance] of the model file, written such that it is read again."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from typing import Any

from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from equipoise.mechanism.balance import (
    MATERIALS,
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
from equipoise.schema import dumps, json_schema, loads
from unit.schema.samples import BALANCE, FOUR_BAR, ROWS, SUPPORT

VALIDATOR = Draft202012Validator(json_schema())
BASE = FOUR_BAR + SUPPORT + ROWS


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
    st.builds(Limit, st.sampled_from(MEASURES).map(lambda m: Objective("frame_moment", m)), length)
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
    text = dumps(machine)
    VALIDATOR.validate(tomllib.loads(text))
    assert loads(text) == machine
