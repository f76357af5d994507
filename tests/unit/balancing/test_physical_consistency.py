"""What can be balanced completely: known machines, words and proofs."""

from __future__ import annotations

import json

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.physical_consistency import feasibility
from unit.mechanism.build import ORIGIN, crank_rocker, heavy, machine, slider_crank, two_gears


def test_in_line_slider_crank() -> None:
    """Force by heavy rod and crank; moment by a rod that is a physical pendulum; not both.

    For both, J / l^2 + m_piston = 0, which no masses meet.
    """
    result = feasibility(slider_crank())
    assert result.force.masses_kept
    assert result.moment.masses_kept
    assert not result.both.possible
    assert not result.both.by_points
    proof = result.both.proof
    assert proof is not None
    assert proof.text == "rod.inertia / (1000 mm)^2 + piston.mass"
    assert proof.unit == "kg"
    assert proof.least == pytest.approx(0.5 + 2e-3, rel=1e-6)


def test_four_bar() -> None:
    result = feasibility(crank_rocker())
    assert result.force.masses_kept
    assert result.force.by_points
    for answer in (result.moment, result.both):
        assert answer.added_mass is None
        assert not answer.masses_kept
        assert answer.by_points
        assert answer.proof is not None
        assert answer.proof.text == "coupler.inertia / (900 mm)^2 + rocker.inertia / (800 mm)^2"
        assert answer.proof.least == pytest.approx(2e-3 / 0.81 + 2e-3 / 0.64, rel=1e-6)
        assert "only mass points" in answer.reason


def test_four_bar_of_mass_points() -> None:
    """Without moments of inertia, coupler and rocker can be points in the crank's pin and in D."""
    given = crank_rocker()
    for link in given.links:
        given = given.with_link(link, inertia=0.0)
    assert feasibility(given).both.masses_kept


def test_lone_crank() -> None:
    result = feasibility(machine({"A": ORIGIN}, {"crank": heavy(A=ORIGIN, B=(0.3, 0.0))}))
    assert all(answer.masses_kept for answer in result.answers)
    assert result.force.reason == "The shaking force can be made zero, with every mass as it is."


def test_wheels_that_turn_evenly() -> None:
    result = feasibility(two_gears(eq.Gear("crank", "wheel", -1.0)))
    assert all(answer.masses_kept for answer in result.answers)


def test_opposed_pistons_must_weigh_the_same() -> None:
    """Two yokes on opposite pins of a crank: only their masses matter, and must be equal."""
    links = {
        "crank": eq.Link({"A": ORIGIN, "B": (0.1, 0.0), "C": (-0.1, 0.0)}, 1.0, ORIGIN, 1e-3),
        "one": eq.Link({"B": ORIGIN}, 0.1, ORIGIN, 1e-5),
        "other": eq.Link({"C": ORIGIN}, 0.1, ORIGIN, 1e-5),
        "left": eq.Link({"S": ORIGIN}, 0.7, ORIGIN, 1e-3),
        "right": eq.Link({"T": ORIGIN}, 0.4, ORIGIN, 1e-3),
    }
    given = machine(
        {"A": ORIGIN, "H": (0.0, 0.0)},
        links,
        sliders=(
            eq.Slider("one", "B", "left", "S", np.pi / 2),
            eq.Slider("other", "C", "right", "T", np.pi / 2),
            eq.Slider("left", "S", "frame", "H", 0.0),
            eq.Slider("right", "T", "frame", "H", 0.0),
        ),
    )
    force = feasibility(given).force
    assert force.possible
    assert not force.masses_kept
    assert force.added_mass is not None
    assert dict(force.added_mass) == pytest.approx({"right": 0.3}, rel=1e-4)
    assert force.reason == (
        "The shaking force can be made zero, but not with every mass as it is: "
        "it takes 300 g on right."
    )


def test_a_link_without_mass_needs_some() -> None:
    given = slider_crank().with_link("rod", mass=0.0, inertia=0.0, center_of_mass=ORIGIN)
    force = feasibility(given).force
    assert force.possible
    assert dict(force.added_mass or {}) == {"rod": 0.0}
    assert "some mass, however little, on rod" in force.reason


def test_a_yoke_cannot_be_balanced() -> None:
    force = feasibility(eq.load("scotch-yoke")).force
    assert force.proof is not None
    assert (force.proof.text, force.proof.unit) == ("yoke.mass", "kg")
    assert force.proof.least == pytest.approx(1.2, rel=1e-6)


def test_plain_data() -> None:
    content = json.loads(json.dumps(feasibility(slider_crank()).to_dict()))
    assert list(content) == ["shaking_force", "shaking_moment", "shaking_force_and_moment"]
    assert content["shaking_force"] == {
        "possible": True,
        "masses_kept": True,
        "added_mass": {},
        "by_points": True,
        "reason": "The shaking force can be made zero, with every mass as it is.",
        "proof": None,
    }
    assert content["shaking_force_and_moment"]["proof"]["unit"] == "kg"
    assert str(feasibility(slider_crank())).count("\n") == 2
