"""Conditions of balance: their words, their refusals, and machines with a known answer."""

from __future__ import annotations

import json

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.linear_conditions import conditions, joint_length, reading
from equipoise.errors import MassError, RangeError, UsageError
from unit.mechanism.build import ORIGIN, crank_rocker, four_bar, heavy, machine, slider_crank


def lone() -> eq.Machine:
    return machine({"A": ORIGIN}, {"crank": heavy(A=ORIGIN, B=(0.3, 0.0))})


def test_a_lone_crank_must_be_centered() -> None:
    found = conditions(lone())
    assert found.sentences == ("crank.moment_x = 0", "crank.moment_y = 0")
    assert found.units == ("kg m", "kg m")
    link = lone().links["crank"]
    assert link.mass is not None
    assert found.residuals == pytest.approx(link.mass * np.array(link.center_of_mass))
    assert found.without_effect == (("crank", "mass"), ("crank", "inertia"))
    assert str(found) == "crank.moment_x = 0\ncrank.moment_y = 0"


def test_a_lone_crank_shakes_in_a_sine_and_without_moment() -> None:
    for kind, output in (("sine", "shaking_force"), ("zero", "shaking_moment")):
        found = conditions(lone(), kind, [output])  # type: ignore[arg-type]
        assert found.count == 0
        assert found.coefficients.shape == (0, 4)
        assert len(found.without_effect) == 4


def test_slider_crank() -> None:
    assert conditions(slider_crank()).sentences == (
        "crank.moment_x / 300 mm + rod.mass + piston.mass = 0",
        "crank.moment_y = 0",
        "rod.moment_x / 1000 mm + piston.mass = 0",
        "rod.moment_y = 0",
    )


def test_slider_crank_across_its_guide() -> None:
    """Across the guide the piston's mass does nothing, so that rod and crank are free of it."""
    across = conditions(slider_crank(), "zero", "shaking_force.y")  # type: ignore[arg-type]
    assert across.count == 3
    assert ("piston", "mass") in across.without_effect


def test_scotch_yoke_is_a_sine_whatever_its_masses() -> None:
    yoke = eq.load("scotch-yoke")
    assert conditions(yoke, "sine").count == 0
    assert conditions(yoke).sentences[-1] == "yoke.mass = 0"
    assert conditions(yoke).units[-1] == "kg"


def test_force_and_moment_of_a_four_bar() -> None:
    both = conditions(four_bar(1.0, 0.35, 0.9, 0.8), "zero", ["shaking_force", "shaking_moment"])
    assert both.count == 7
    assert "coupler.inertia / (900 mm)^2 + rocker.inertia / (800 mm)^2 = 0" in both.sentences
    assert both.units[both.sentences.index("coupler.moment_y = 0")] == "kg m"
    assert "kg m2" in both.units


@pytest.mark.parametrize("size", [1e-3, 1e3])
def test_size_does_not_matter(size: float) -> None:
    found = conditions(four_bar(*(size * x for x in (1.0, 0.35, 0.9, 0.8))))
    plain = conditions(crank_rocker())
    assert np.array_equal(found.coefficients != 0, plain.coefficients != 0)


def test_gears_of_many_turns() -> None:
    """Order 1 is the crank's turn, not the cycle's."""
    found = conditions(eq.load("planetary-planting-arm"), "sine")
    assert found.sentences == ("idler.moment_x = 0", "idler.moment_y = 0")


def test_plain_data() -> None:
    found = conditions(slider_crank()).to_dict()
    text = json.loads(json.dumps(found))
    assert text["kind"] == "zero"
    assert text["outputs"] == ["shaking_force"]
    first = text["conditions"][0]
    assert first["coefficients"] == pytest.approx(
        {"crank.moment_x": 1.0, "rod.mass": 0.3, "piston.mass": 0.3}
    )
    assert first["unit"] == "kg m"
    assert first["condition"].startswith("crank.moment_x / 300 mm")
    assert "piston.inertia" in text["without_effect"]


def test_refusals() -> None:
    with pytest.raises(UsageError, match="give zero or sine"):
        conditions(lone(), "none")  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="did you mean 'shaking_force'"):
        conditions(lone(), "zero", ["shaking_forces"])
    with pytest.raises(UsageError, match="at least one output"):
        conditions(lone(), "zero", [])
    bare = lone().with_link("crank", mass=None, center_of_mass=None, inertia=None)
    with pytest.raises(MassError, match="missing for crank"):
        conditions(bare)
    with pytest.raises(RangeError):
        conditions(four_bar(1.0, 0.8, 0.9, 0.5))


# -- wording ---------------------------------------------------------------------------------------


def test_first_term_is_positive_unless_the_sign_counts() -> None:
    given = crank_rocker()
    row = np.zeros(12)
    row[1], row[5] = -2.0, 1.0
    assert reading(given, row).text == "crank.moment_x / 350 mm - coupler.moment_x / 700 mm"
    signed = reading(given, row, signed=True)
    assert signed.text == "-crank.moment_x / 350 mm + coupler.moment_x / 700 mm"
    assert signed.factor == pytest.approx(1 / 0.7)


def test_one_term_keeps_its_unit() -> None:
    given, row = crank_rocker(), np.zeros(12)
    row[11] = -4.0
    found = reading(given, row)
    assert (found.text, found.unit, found.factor) == ("rocker.inertia", "kg m2", -0.25)
    assert reading(given, row, signed=True).text == "-rocker.inertia"


def test_masses_stand_alone() -> None:
    given, row = crank_rocker(), np.zeros(12)
    row[0], row[4], row[7] = 2.0, 1.0, 8.0
    assert (
        reading(given, row).text == "crank.mass + 0.5 coupler.mass + coupler.inertia / (500 mm)^2"
    )


def test_length_between_joints() -> None:
    """The coupler's tip is no joint; a link with one joint has its size, a point the machine's."""
    given = eq.load("yamashita-1")
    assert joint_length(given, "coupler") == pytest.approx(0.0715)
    assert joint_length(lone(), "crank") == pytest.approx(0.3)
    assert joint_length(slider_crank(), "piston") == pytest.approx(1.0)
