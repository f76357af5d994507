"""Values of support, mounts, gauges and rows: each wrong one is refused at its key."""

from __future__ import annotations

import pickle
from dataclasses import replace
from math import inf, nan, pi
from typing import Any

import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.parts.support import (
    FREEDOMS,
    MOST,
    UP,
    Gauge,
    Mount,
    Row,
    Support,
    unit_vector,
)
from support import refusals
from unit.mechanism.build import crank_rocker, refused

FOUR = crank_rocker()
SUPPORT = Support(60.0, (0.0, 0.3, 0.0), (4.0,))
SPATIAL = replace(SUPPORT, inertia=(3.0, 5.0, 4.0), freedoms=FREEDOMS)
MOUNT = Mount((0.1, 0.0, 0.0), stiffness=2e4)
TURN = Mount(axis="roll", torsional_stiffness=500.0)


def wrong(where: str, words: str, support: Support) -> None:
    """Check that a machine with this support is refused at a place, in these words."""
    refused(where, words, lambda: replace(FOUR, support=support))


# -- the body --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"mass": 0.0}, ".mass", "got 0 kg; give more than 0"),
        ({"mass": -2.0}, ".mass", "got -2 kg; give more than 0"),
        ({"inertia": ()}, "", "give either inertia or pivot_inertia"),
        ({"pivot_inertia": 9.0}, "", "give either inertia or pivot_inertia"),
        ({"inertia": (1.0, 2.0)}, ".inertia", "got 2 values; give one or three"),
        ({"inertia": (0.0,)}, ".inertia", "got 0 kg m^2; give more than 0"),
        ({"inertia": (1.0, -1.0, 1.0)}, ".inertia[2]", "got -1 kg m^2; give more than 0"),
        ({"inertia": (1.0, 1.0, 2.1)}, ".inertia",
         "got 2.1 kg m^2 beside 1 kg m^2 and 1 kg m^2; no body has one moment of inertia "
         "above the sum of the others"),
        ({"freedoms": ("roll",)}, ".inertia",
         "got one value, but the support can roll; give three, about x, y and z"),
        ({"freedoms": ("yaw", "sway", "pitch")}, ".inertia",
         "got one value, but the support can sway and yaw; give three, about x, y and z"),
        ({"products": (0.0, 0.0, 0.0)}, ".products", "goes with an inertia of three values"),
        ({"inertia": (1.0, 1.0, 1.0), "products": (0.1,)}, ".products",
         "give three values, of x y, y z and z x"),
        ({"inertia": (1.0, 1.0, 1.0), "products": (1.0, 0.0, 0.0)}, ".products",
         "got 1 kg m^2, 0 kg m^2 and 0 kg m^2 beside an inertia of 1 kg m^2, 1 kg m^2 and "
         "1 kg m^2; no body has that, give smaller ones"),
        # Each pair alone would do.
        ({"inertia": (1.0, 1.0, 1.0), "products": (0.6, 0.6, 0.6)}, ".products",
         "got 0.6 kg m^2, 0.6 kg m^2 and 0.6 kg m^2 beside an inertia of 1 kg m^2, 1 kg m^2 and "
         "1 kg m^2; no body has that, give smaller ones"),
        ({"freedoms": ("pich",)}, ".freedoms[1]",
         "got 'pich'; give 'surge', 'heave', 'sway', 'roll', 'yaw' or 'pitch'"),
        ({"freedoms": ("surge", "pitch", "surge")}, ".freedoms[3]", "'surge' is given twice"),
    ],
)  # fmt: skip
def test_values_of_the_body(changes: dict[str, Any], key: str, words: str) -> None:
    wrong(f"support{key}", words, replace(SUPPORT, **changes))


PIVOTED = Support(60.0, (0.1, 0.3, 0.0), pivot_inertia=9.0, pivot=(0.1, 0.0))


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"pivot": None}, ".pivot_inertia",
         "there is no pivot; give inertia, about the centre of mass"),
        ({"pivot_inertia": 5.3}, ".pivot_inertia",
         "got 5.3 kg m^2; mass and center_of_mass alone make 5.4 kg m^2, give more"),
        ({"freedoms": ("pitch", "roll")}, ".pivot_inertia",
         "the support can roll too; give inertia about the centre of mass, three values"),
        ({"products": (0.0, 0.0, 0.0)}, ".products", "goes with an inertia of three values"),
    ],
)  # fmt: skip
def test_values_about_a_pivot(changes: dict[str, Any], key: str, words: str) -> None:
    wrong(f"support{key}", words, replace(PIVOTED, **changes))
    assert replace(FOUR, support=PIVOTED).support == PIVOTED


@pytest.mark.parametrize(
    ("make", "key", "words"),
    [
        (lambda: replace(SUPPORT, mass="60 mm"), "mass", "got '60 mm'..."),
        (lambda: replace(SUPPORT, center_of_mass=(0.0,)), "center_of_mass",
         "got (0.0,); give two or three numbers"),
        (lambda: replace(SUPPORT, center_of_mass=0.3), "center_of_mass",
         "got 0.3; give two or three numbers"),
        (lambda: replace(SUPPORT, inertia=4.0), "inertia", "got 4.0; give numbers"),
        (lambda: replace(SUPPORT, pivot=(0.0, 0.0, 0.0)), "pivot",
         "got (0.0, 0.0, 0.0); give two numbers"),
        (lambda: replace(SUPPORT, freedoms="pitch"), "freedoms",
         "got 'pitch'; give a list of texts"),
        (lambda: replace(SUPPORT, mounts=[1]), "mounts",
         "got [1]; give a mapping of names to such objects"),
        (lambda: Mount((0.0, 0.0), "up"), "direction",
         "got 'up'..."),  # type: ignore[arg-type]
        (lambda: Mount((0.0, 0.0), (0.0, 1.0)), "direction",  # type: ignore[arg-type]
         "got (0.0, 1.0); give an angle, or three numbers"),
        (lambda: Mount((0.0, 0.0), one_sided=1), "one_sided",
         "got 1; give true or false"),  # type: ignore[arg-type]
        (lambda: Gauge("abc"), "point",
         "got 'abc'; give two or three numbers"),  # type: ignore[arg-type]
        (lambda: Row("90 mm"), "phase", "got '90 mm'..."),  # type: ignore[arg-type]
        (lambda: Row(offset=(1.0,)), "offset",
         "got (1.0,); give two numbers"),  # type: ignore[arg-type]
    ],
)  # fmt: skip
def test_shapes(make: Any, key: str, words: str) -> None:
    refused(key, words, make)


@pytest.mark.parametrize("value", [nan, inf])
@pytest.mark.parametrize(
    ("where", "make"),
    [
        ("support.mass", lambda x: replace(SUPPORT, mass=x)),
        ("support.center_of_mass[3]", lambda x: replace(SUPPORT, center_of_mass=(0.0, 0.0, x))),
        ("support.mounts.m.preload",
         lambda x: replace(SUPPORT, mounts={"m": replace(MOUNT, preload=x)})),
        ("support.gauges.g.direction[2]",
         lambda x: replace(SUPPORT, gauges={"g": Gauge((0.0, 0.0), (0.0, x, 0.0))})),
    ],
)  # fmt: skip
def test_numbers_are_finite(where: str, make: Any, value: float) -> None:
    wrong(where, f"got {value}; give a finite number", make(value))


# -- mounts and gauges -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("item", "key", "words"),
    [
        (Mount(stiffness=1.0), "", "give either point or axis"),
        (replace(MOUNT, axis="roll"), "", "give either point or axis"),
        (Mount((0.0, 0.0)), "", "give at least one of stiffness and damping"),
        (Mount((0.0, 0.0), preload=5.0), "", "give at least one of stiffness and damping"),
        (Mount(axis="roll"), "", "give at least one of torsional_stiffness and torsional_damping"),
        (replace(MOUNT, damping=-3.0), ".damping", "got -3 N s/m; give 0 or more"),
        (replace(TURN, torsional_stiffness=-3.0), ".torsional_stiffness",
         "got -3 N m/rad; give 0 or more"),
        (replace(MOUNT, torsional_damping=3.0), ".torsional_damping",
         "has no place in a mount with a point"),
        (replace(TURN, stiffness=3.0), ".stiffness", "has no place in a mount with an axis"),
        (replace(TURN, direction=0.0), ".direction", "goes with a point, not with an axis"),
        (replace(TURN, one_sided=True), ".one_sided",
         "only a mount with a point can push on one side"),
        (replace(TURN, axis="rol"), ".axis", "got 'rol'; give 'roll', 'yaw' or 'pitch'"),
        (replace(MOUNT, direction=(0.0, 0.0, 0.0)), ".direction",
         "got [0, 0, 0]; give a direction"),
        (Mount((0.0, 0.0), damping=1.0, preload=1.0, one_sided=True), ".one_sided",
         "a contact without stiffness carries nothing"),
        (Gauge(), "", "give either point or axis"),
        (Gauge((0.0, 0.0), axis="yaw"), "", "give either point or axis"),
        (Gauge(axis="yae"), ".axis", "got 'yae'; give 'roll', 'yaw' or 'pitch'"),
        (Gauge(axis="yaw", direction=0.0), ".direction", "goes with a point, not with an axis"),
        (Gauge((0.0, 0.0), (0.0, 0.0, 0.0)), ".direction", "got [0, 0, 0]; give a direction"),
    ],
)  # fmt: skip
def test_values_of_mounts_and_gauges(item: Mount | Gauge, key: str, words: str) -> None:
    kind = "mounts" if isinstance(item, Mount) else "gauges"
    wrong(f"support.{kind}.m{key}", words, replace(SPATIAL, **{kind: {"m": item}}))


@pytest.mark.parametrize("kind", ["mounts", "gauges"])
@pytest.mark.parametrize("name", ["", " ", "a\nb", "x" * 201])
def test_names(kind: str, name: str) -> None:
    item = MOUNT if kind == "mounts" else Gauge(axis="pitch")
    wrong(f"support.{kind}", f"got the name {name[:60]!r}; give another",
            replace(SUPPORT, **{kind: {name: item}}))  # fmt: skip


def test_numbers_of_mounts_gauges_and_rows() -> None:
    mounts = {str(number): MOUNT for number in range(MOST["mounts"])}
    assert replace(FOUR, support=replace(SUPPORT, mounts=mounts)).support is not None
    wrong("support.mounts", "got 201; at most 200 are computed with",
            replace(SUPPORT, mounts={**mounts, "more": MOUNT}))  # fmt: skip
    assert len(replace(FOUR, rows=(Row(),) * MOST["rows"]).rows) == 200
    with refusals.refused(ModelError, "rows", rows="201", most="200"):
        replace(FOUR, rows=(Row(),) * 201)


# -- what the values tell --------------------------------------------------------------------------


def test_what_is_right_is_kept() -> None:
    products = (0.1, -0.2, 0.3)
    support = replace(SPATIAL, products=products, mounts={"m": MOUNT, "t": TURN},
                      gauges={"g": Gauge((0, 1))})  # fmt: skip
    machine = replace(FOUR, support=support, rows=(Row(), Row(pi, 0.3)))
    assert pickle.loads(pickle.dumps(machine)) == machine
    assert support.gauges["g"].point == (0.0, 1.0, 0.0)
    with pytest.raises(TypeError):
        support.mounts["m"] = MOUNT  # type: ignore[index]


def test_freedoms_in_their_order() -> None:
    assert SUPPORT.coordinates == ("surge", "heave", "pitch")
    assert SUPPORT.planar
    assert PIVOTED.coordinates == ("pitch",)
    assert replace(SUPPORT, freedoms=("pitch", "heave")).coordinates == ("heave", "pitch")
    assert SPATIAL.coordinates == FREEDOMS
    assert not SPATIAL.planar


def test_the_reference_point() -> None:
    assert SUPPORT.reference == (0.0, 0.3, 0.0)
    assert PIVOTED.reference == (0.1, 0.0, 0.0)


def test_directions_as_vectors() -> None:
    assert unit_vector(UP) == (0.0, 1.0, 0.0)
    assert unit_vector(pi) == (-1.0, 0.0, 0.0)
    assert unit_vector((0.0, 3.0, -4.0)) == (0.0, 0.6, -0.8)
    assert unit_vector(pi / 6) == pytest.approx((0.75**0.5, 0.5, 0.0))


def test_a_support_is_changed_key_by_key() -> None:
    machine = replace(FOUR, support=SUPPORT)
    cycle = eq.mechanism.assemble(machine).cycle
    heavier = machine.with_support(mass=80.0)
    assert heavier.support == replace(SUPPORT, mass=80.0)
    assert machine.support == SUPPORT
    given = FOUR.with_support(mass=60.0, center_of_mass=(0.0, 0.3), inertia=(4.0,))
    assert given == machine
    assert eq.mechanism.assemble(heavier).cycle is cycle
    rows = machine.with_rows([Row(), Row(pi)])
    assert rows.rows == (Row(), Row(pi))
    assert eq.mechanism.assemble(rows).cycle is cycle
    with refusals.refused(ModelError, "support.mass", limit="0"):
        machine.with_support(mass=-1.0)
