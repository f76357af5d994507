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
from unit.mechanism.build import crank_rocker, refused, refused_in_words

FOUR = crank_rocker()
SUPPORT = Support(60.0, (0.0, 0.3, 0.0), (4.0,))
SPATIAL = replace(SUPPORT, inertia=(3.0, 5.0, 4.0), freedoms=FREEDOMS)
MOUNT = Mount((0.1, 0.0, 0.0), stiffness=2e4)
TURN = Mount(axis="roll", torsional_stiffness=500.0)


def wrong(where: str, expected: dict[str, Any], support: Support) -> None:
    """Check that a machine with this support is refused at a place, with these values."""
    refused(where, expected, lambda: replace(FOUR, support=support))


# -- the body --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "key", "expected"),
    [
        ({"mass": 0.0}, ".mass", {"text": "0 kg"}),
        ({"mass": -2.0}, ".mass", {"text": "-2 kg"}),
        ({"inertia": ()}, "", {}),
        ({"pivot_inertia": 9.0}, "", {}),
        ({"inertia": (1.0, 2.0)}, ".inertia", {"inertia": 2}),
        ({"inertia": (0.0,)}, ".inertia", {"text": "0 kg m^2"}),
        ({"inertia": (1.0, -1.0, 1.0)}, ".inertia[2]", {"text": "-1 kg m^2"}),
        ({"inertia": (1.0, 1.0, 2.1)}, ".inertia",
         {"a": "1 kg m^2", "b": "1 kg m^2", "c": "2.1 kg m^2"}),
        ({"freedoms": ("roll",)}, ".inertia", {}),
        ({"freedoms": ("yaw", "sway", "pitch")}, ".inertia", {}),
        ({"products": (0.0, 0.0, 0.0)}, ".products", {}),
        ({"inertia": (1.0, 1.0, 1.0), "products": (0.1,)}, ".products", {}),
        ({"inertia": (1.0, 1.0, 1.0), "products": (1.0, 0.0, 0.0)}, ".products",
         {"xy": "1 kg m^2", "yz": "0 kg m^2", "zx": "0 kg m^2"}),
        # Each pair alone would do.
        ({"inertia": (1.0, 1.0, 1.0), "products": (0.6, 0.6, 0.6)}, ".products",
         {"xy": "0.6 kg m^2", "yz": "0.6 kg m^2", "zx": "0.6 kg m^2"}),
        ({"freedoms": ("pich",)}, ".freedoms[1]", {"leaf": "pich"}),
        ({"freedoms": ("surge", "pitch", "surge")}, ".freedoms[3]", {"name": "surge"}),
    ],
)  # fmt: skip
def test_values_of_the_body(changes: dict[str, Any], key: str, expected: dict[str, Any]) -> None:
    wrong(f"support{key}", expected, replace(SUPPORT, **changes))


PIVOTED = Support(60.0, (0.1, 0.3, 0.0), pivot_inertia=9.0, pivot=(0.1, 0.0))


@pytest.mark.parametrize(
    ("changes", "key", "expected"),
    [
        ({"pivot": None}, ".pivot_inertia", {}),
        ({"pivot_inertia": 5.3}, ".pivot_inertia", {"given": "5.3 kg m^2", "least": "5.4 kg m^2"}),
        ({"freedoms": ("pitch", "roll")}, ".pivot_inertia", {}),
        ({"products": (0.0, 0.0, 0.0)}, ".products", {}),
    ],
)  # fmt: skip
def test_values_about_a_pivot(changes: dict[str, Any], key: str, expected: dict[str, Any]) -> None:
    wrong(f"support{key}", expected, replace(PIVOTED, **changes))
    assert replace(FOUR, support=PIVOTED).support == PIVOTED


@pytest.mark.parametrize(
    ("make", "key", "expected"),
    [
        (lambda: replace(SUPPORT, mass="60 mm"), "mass", {"given": "'60 mm'"}),
        (lambda: replace(SUPPORT, center_of_mass=(0.0,)), "center_of_mass", {"given": "(0.0,)"}),
        (lambda: replace(SUPPORT, center_of_mass=0.3), "center_of_mass", {"given": 0.3}),
        (lambda: replace(SUPPORT, inertia=4.0), "inertia", {"given": 4.0}),
        (lambda: replace(SUPPORT, pivot=(0.0, 0.0, 0.0)), "pivot", {"given": "(0.0, 0.0, 0.0)"}),
        (lambda: replace(SUPPORT, freedoms="pitch"), "freedoms", {"given": "'pitch'"}),
        (lambda: replace(SUPPORT, mounts=[1]), "mounts", {"given": "[1]"}),
        (lambda: Mount((0.0, 0.0), "up"), "direction", {"given": "'up'"}),  # type: ignore[arg-type]
        (lambda: Mount((0.0, 0.0), (0.0, 1.0)), "direction",  # type: ignore[arg-type]
         {"given": "(0.0, 1.0)"}),
        (lambda: Mount((0.0, 0.0), one_sided=1), "one_sided",
         {"given": 1}),  # type: ignore[arg-type]
        (lambda: Gauge("abc"), "point", {"given": "'abc'"}),  # type: ignore[arg-type]
        (lambda: Row("90 mm"), "phase", {"given": "'90 mm'"}),  # type: ignore[arg-type]
        (lambda: Row(offset=(1.0,)), "offset", {"given": "(1.0,)"}),  # type: ignore[arg-type]
    ],
)  # fmt: skip
def test_shapes(make: Any, key: str, expected: dict[str, Any]) -> None:
    refused(key, expected, make)


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
    wrong(where, {"leaf": str(value)}, make(value))


# -- mounts and gauges -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("item", "key", "expected"),
    [
        (Mount(stiffness=1.0), "", {}),
        (replace(MOUNT, axis="roll"), "", {}),
        (Mount((0.0, 0.0)), "", {"first": "stiffness", "last": "damping"}),
        (Mount((0.0, 0.0), preload=5.0), "", {"first": "stiffness", "last": "damping"}),
        (Mount(axis="roll"), "", {"first": "torsional_stiffness", "last": "torsional_damping"}),
        (replace(MOUNT, damping=-3.0), ".damping", {"text": "-3 N s/m"}),
        (replace(TURN, torsional_stiffness=-3.0), ".torsional_stiffness", {"text": "-3 N m/rad"}),
        (replace(MOUNT, torsional_damping=3.0), ".torsional_damping", {}),
        (replace(TURN, stiffness=3.0), ".stiffness", {}),
        (replace(TURN, direction=0.0), ".direction", {}),
        (replace(TURN, one_sided=True), ".one_sided", {}),
        (replace(TURN, axis="rol"), ".axis", {"leaf": "rol"}),
        (replace(MOUNT, direction=(0.0, 0.0, 0.0)), ".direction", {}),
        (Mount((0.0, 0.0), damping=1.0, preload=1.0, one_sided=True), ".one_sided", {}),
        (Gauge(), "", {}),
        (Gauge((0.0, 0.0), axis="yaw"), "", {}),
        (Gauge(axis="yae"), ".axis", {"leaf": "yae"}),
        (Gauge(axis="yaw", direction=0.0), ".direction", {}),
        (Gauge((0.0, 0.0), (0.0, 0.0, 0.0)), ".direction", {}),
    ],
)  # fmt: skip
def test_values_of_mounts_and_gauges(
    item: Mount | Gauge, key: str, expected: dict[str, Any]
) -> None:
    kind = "mounts" if isinstance(item, Mount) else "gauges"
    wrong(f"support.{kind}.m{key}", expected, replace(SPATIAL, **{kind: {"m": item}}))


@pytest.mark.parametrize("kind", ["mounts", "gauges"])
@pytest.mark.parametrize("name", ["", " ", "a\nb", "x" * 201])
def test_names(kind: str, name: str) -> None:
    item = MOUNT if kind == "mounts" else Gauge(axis="pitch")
    unnamed = replace(SUPPORT, **{kind: {name: item}})
    words = f"got the name {name[:60]!r}; give another"
    refused_in_words(f"support.{kind}", words, lambda: replace(FOUR, support=unnamed))


def test_numbers_of_mounts_gauges_and_rows() -> None:
    mounts = {str(number): MOUNT for number in range(MOST["mounts"])}
    assert replace(FOUR, support=replace(SUPPORT, mounts=mounts)).support is not None
    wrong("support.mounts", {"items": 201, "most": 200},
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
