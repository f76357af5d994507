"""Conditions of balance, the least moments that meet them, sensitivities, and what each shows."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.linear_conditions import (
    conditions,
    conditions_blocks,
    joint_length,
    least_moments,
    reading,
)
from equipoise.balancing.physical_consistency import feasibility
from equipoise.balancing.sensitivity import known_outputs, sensitivities
from equipoise.errors import MassError, RangeError, UsageError
from support.printing import words
from support.refusals import refused
from unit.mechanism.build import ORIGIN, crank_rocker, four_bar, heavy, machine, slider_crank


def lone() -> eq.Machine:
    return machine({"A": ORIGIN}, {"crank": heavy(A=ORIGIN, B=(0.3, 0.0))})


def test_a_lone_crank_must_be_centered() -> None:
    result = conditions(lone())
    assert result.sentences == ("crank.moment_x = 0", "crank.moment_y = 0")
    assert result.units == ("kg m", "kg m")
    link = lone().links["crank"]
    assert link.mass is not None
    assert result.residuals == pytest.approx(link.mass * np.array(link.center_of_mass))
    assert result.without_effect == (("crank", "mass"), ("crank", "inertia"))
    assert str(result) == "crank.moment_x = 0\ncrank.moment_y = 0"


def test_a_lone_crank_shakes_in_a_sine_and_without_moment() -> None:
    for kind, output in (("sine", "shaking_force"), ("zero", "shaking_moment")):
        result = conditions(lone(), kind, [output])  # type: ignore[arg-type]
        assert result.count == 0
        assert result.coefficients.shape == (0, 4)
        assert len(result.without_effect) == 4


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
    result = conditions(four_bar(*(size * x for x in (1.0, 0.35, 0.9, 0.8))))
    plain = conditions(crank_rocker())
    assert np.array_equal(result.coefficients != 0, plain.coefficients != 0)


def test_gears_of_many_turns() -> None:
    """Order 1 is the crank's turn, not the cycle's."""
    result = conditions(eq.load("planetary-planting-arm"), "sine")
    assert result.sentences == ("idler.moment_x = 0", "idler.moment_y = 0")


def test_plain_data() -> None:
    content = conditions(slider_crank()).to_dict()
    text = json.loads(json.dumps(content))
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
    with refused(UsageError, kind="none"):
        conditions(lone(), "none")  # type: ignore[arg-type]
    with refused(UsageError, name="shaking_force"):
        conditions(lone(), "zero", ["shaking_forces"])
    with refused(UsageError, by="conditions"):
        conditions(lone(), "zero", [])
    bare = lone().with_link("crank", mass=None, center_of_mass=None, inertia=None)
    with refused(MassError, links="crank"):
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
    result = reading(given, row)
    assert (result.text, result.unit, result.factor) == ("rocker.inertia", "kg m2", -0.25)
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


def test_slider_crank_needs_rod_and_crank() -> None:
    given = slider_crank()
    moments = least_moments(given, ["crank", "rod"])
    assert moments.totals["rod"] == pytest.approx((-0.5, 0.0))
    assert moments.totals["crank"] == pytest.approx((-0.3, 0.0))
    assert np.max(eq.analyze(moments.machine).forces.shaking_force.size) < 1e-11
    with refused(UsageError, names="crank"):
        least_moments(given, ["crank"])
    with refused(UsageError, names="no link"):
        least_moments(given, [])


def test_a_balanced_machine_needs_nothing() -> None:
    balanced = least_moments(crank_rocker(), ["crank", "rocker"]).machine
    again = least_moments(balanced, ["crank", "coupler", "rocker"])
    assert again.cost < 1e-15


def test_free_links_alone() -> None:
    moments = least_moments(crank_rocker(), [], ["crank", "rocker"])
    assert moments.cost == 0
    priced = least_moments(crank_rocker(), ["crank", "rocker"])
    for link, moment in moments.moments.items():
        assert moment == pytest.approx(priced.moments[link])


def test_least_moments_as_plain_data() -> None:
    moments = least_moments(crank_rocker(), ["crank", "rocker"])
    data = json.loads(json.dumps(moments.to_dict()))
    assert list(data) == ["added", "total", "center_of_mass", "cost"]
    for link in ("crank", "rocker"):
        assert 0.5 * np.array(data["center_of_mass"][link]) == pytest.approx(data["total"][link])


def test_refusals_of_least_moments() -> None:
    given = crank_rocker()
    with refused(UsageError, name="crank"):
        least_moments(given, ["cranks"])
    with refused(UsageError, name="crank"):
        least_moments(given, ["crank"], ["crank"])
    with refused(UsageError, name="rocker"):
        least_moments(given.with_link("rocker", mass=0.0, inertia=0.0), ["crank", "rocker"])
    bare = given.with_link("crank", mass=None, center_of_mass=None, inertia=None)
    with pytest.raises(MassError):
        least_moments(bare, ["crank"])


def test_sensitivities_of_a_lone_crank() -> None:
    """At 10 rad/s the force is 100 m r, and its height that times a sine."""
    result = sensitivities(lone(), angles=36)
    theta = result.crank_angle
    np.testing.assert_allclose(result["crank.center_x"].values, 50 * np.sin(theta), atol=1e-12)
    np.testing.assert_allclose(result["crank.center_y"].values, 50 * np.cos(theta), atol=1e-12)
    assert result["crank.center_x"].rms == pytest.approx(50 / 2**0.5)
    assert result["crank.center_x"].percent == pytest.approx(0.003 * 50 / 2**0.5)
    np.testing.assert_allclose(result["crank.center_x"].no_effect_at, [0, np.pi], atol=1e-12)
    half = [np.pi / 2, 3 * np.pi / 2]
    np.testing.assert_allclose(result["crank.center_y"].no_effect_at, half, atol=1e-12)
    assert not result["crank.inertia"].has_effect
    assert result["crank.inertia"].no_effect_at.size == 0
    assert [item.name for item in result.ranked][-1] == "crank.mass"


def test_torque_of_a_lone_crank_is_weight() -> None:
    result = sensitivities(lone(), "drive_torque", 36)
    wanted = 0.5 * 9.80665 * np.cos(result.crank_angle)
    np.testing.assert_allclose(result["crank.center_x"].values, wanted, atol=1e-12)
    assert not result["crank.inertia"].has_effect


def test_acceleration_of_the_drive_does_not_count() -> None:
    given = crank_rocker()
    starting = given.with_drive(acceleration=50.0)
    for output in ("shaking_moment", "drive_torque"):
        first, two = (sensitivities(m, output, 24) for m in (given, starting))
        for name in first.by_name:
            np.testing.assert_array_equal(first[name].values, two[name].values)


def test_number_of_crank_angles_does_not_move_the_zeros() -> None:
    few, many = (sensitivities(crank_rocker(), angles=n) for n in (180, 1440))
    for name, value in few.by_name.items():
        np.testing.assert_allclose(value.no_effect_at, many[name].no_effect_at, atol=1e-9)


def test_a_machine_at_rest_has_none() -> None:
    result = sensitivities(crank_rocker(drive=eq.Drive("crank", 0.0)), angles=24)
    assert result.ranked == ()


def test_a_cycle_of_many_turns() -> None:
    result = sensitivities(eq.load("planetary-planting-arm"), angles=72)
    assert len(result.crank_angle) == 72 * result.turns
    for item in result.ranked:
        assert np.all(np.diff(item.no_effect_at) > 0)
        assert np.all(item.no_effect_at < 2 * np.pi * result.turns)


def test_sensitivities_as_plain_data() -> None:
    content = sensitivities(lone(), angles=36).to_dict()
    assert content["output"] == "shaking_force.y"
    assert content["crank_angle"].shape == (36,)
    first = content["sensitivities"]["crank.center_x"]
    assert list(first) == ["values", "rms", "percent", "has_effect", "no_effect_at"]


def test_refusals_of_sensitivities() -> None:
    with refused(UsageError, given="shaking_force"):
        sensitivities(lone(), "shaking_force")
    with refused(UsageError, least_angles="8"):
        sensitivities(lone(), angles=3)
    for angles in (True, 36.0, "36"):
        with pytest.raises(UsageError):  # or its CallError, by the door of the package
            sensitivities(lone(), angles=angles)  # type: ignore[arg-type]
    with refused(UsageError, name="crank.center_x"):
        sensitivities(lone(), angles=36)["crank.centre_x"]
    bare = lone().with_link("crank", mass=None, center_of_mass=None, inertia=None)
    with pytest.raises(MassError):
        sensitivities(bare)


def test_conditions() -> None:
    given = eq.load("yamashita-1")
    actual = conditions(given), conditions(given, "sine")
    text = words(
        conditions_blocks(*actual, verdict=[answer.reason for answer in feasibility(given).answers])
    )
    assert "Conditions for shaking force to be zero" in text
    assert "Conditions for shaking force to be a pure sine of the crank angle" in text
    assert "mass*x of coupler / 71.5 mm + mass*x of rocker / 80 mm = 0 -0.3768 kg" in text
    assert "inertia of coupler / (71.5 mm)^2 + inertia of rocker / (80 mm)^2 would have" in text
    assert not re.search(r"moment_|[a-z]\.[a-z]", text)
    assert "The shaking force can be made zero, with every mass as it is." in text


def test_a_swing_is_no_crank() -> None:
    """Order 1 is that of the cycle, of two cranks that swing."""
    text = words(conditions_blocks(conditions(eq.load("pick-and-place"), "sine")))
    assert "Conditions for shaking force to be a pure sine, once a cycle" in text


def test_nothing_to_meet() -> None:
    yoke = eq.load("scotch-yoke")
    text = words(conditions_blocks(conditions(yoke, "sine"), conditions(yoke)))
    assert "none, it always is" in text
    assert "mass*y of crank = 0 0 kg mm" in text
    assert "mass of yoke = 0 1.200 kg" in text


def test_added() -> None:
    text = words(least_moments(eq.load("yamashita-1"), ["crank", "rocker"]).blocks())
    assert "rocker 30.15 15.37 38.43 15.37 148.4 59.36" in text


def test_sensitivities() -> None:
    text = words(sensitivities(eq.load("yamashita-2")).blocks(zero=np.radians(-100)))
    assert "coupler centre of mass, y 0.1200 mm 0.2801 27.9, 214.7, 319.4, 330.6" in text
    assert "No effect at any crank angle: crank (inertia), coupler (inertia), rocker" in text
    assert "crank angle from -100.0 deg" in text


@pytest.mark.parametrize("output", known_outputs(eq.load("yamashita-1")))
def test_every_output_has_a_title(output: str) -> None:
    result = sensitivities(eq.load("yamashita-1"), output, 36)
    assert "effect of each parameter" in words(result.blocks())
