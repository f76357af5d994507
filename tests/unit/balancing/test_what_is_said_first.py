"""What stands first of advice, and whether one can build from it: kilograms, materials, planes."""

from __future__ import annotations

from math import pi
from typing import Literal

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.advice import advise
from equipoise.balancing.balanced import _over_pins
from equipoise.balancing.beyond_masses import Counterbalance
from equipoise.balancing.outcome import benefit_sentences, why_not
from equipoise.balancing.policy import OVER_SOIL
from equipoise.balancing.problem import Problem
from equipoise.balancing.remedies import Comparison, Sector, sectors, with_sectors
from equipoise.balancing.room import room_about
from equipoise.balancing.workshop import covers, in_short, sentences
from equipoise.mechanism.kinematics.tip import surface_of
from equipoise.mechanism.parts.balance import AddedMass, Balance, Objective, Weight
from equipoise.results.blocks import Facts, Text
from support.findings import advice_for
from support.sentences import notes_by
from unit.balancing.test_beyond_masses import beyond, said


def first_lines(name: str) -> list[str]:
    """Of the short answer."""
    return [item.text for item in advice_for(name).headline(alone=True) if isinstance(item, Text)]


# -- weights before plates -------------------------------------------------------------------------


def test_half_a_piston_stands_before_the_plate_that_brings_less() -> None:
    """A gang frame saw that shakes its ground with 20 times its weight is not to be left as it is;
    the mass of the weight is what a whole analysis of the changed machine needs.
    """
    actual, piston = advice_for("frame-saw"), beyond("frame-saw").piston
    first, *_ = first_lines("frame-saw")
    assert first.startswith("Nothing of what reciprocates is balanced on crank: ")
    assert "by 74 kg m (245 kg at 300 mm) added on crank at 180° in its axes" in first
    assert "Leave" not in said("frame-saw") and piston is not None
    link = actual.original.links["crank"].with_added(245.0, (-0.3, 0.0), 0.0)
    changed = actual.original.with_link("crank", mass=link.mass, inertia=link.inertia,
                                       center_of_mass=link.center_of_mass)  # fmt: skip
    force = eq.analyze(changed, acceleration=0.0).summary
    assert force["shaking_force.y"].peak == pytest.approx(piston.half_along, rel=5e-3)
    assert force["shaking_force.x"].peak == pytest.approx(piston.half_across, rel=5e-3)


def test_a_reason_names_the_measure_in_which_a_figure_hardly_falls() -> None:
    """27 % of the RMS for 12 % of mass is within the rule; the peak falls by 23 %."""
    advice = advice_for("frame-saw")
    peaks = [eq.analyze(item, acceleration=0.0).summary["shaking_force"].peak
             for item in (advice.original, advice.machine)]  # fmt: skip
    gone = 1 - peaks[1] / peaks[0]
    assert advice.gain > 0.25 > gone
    assert why_not(advice) == f"shaking force, peak, falls by only {100 * gone:.1f} %"
    assert "too much for this reduction" not in said("frame-saw")


def test_a_weight_against_order_1_may_hold_what_the_crank_lifts() -> None:
    """Of a beam pump, most of which is the load of its rods: three tonnes and more on the crank."""
    actual, weight = advice_for("beam-pump"), beyond("beam-pump").counterbalance
    assert isinstance(weight, Counterbalance)
    first, *_ = first_lines("beam-pump")
    assert first.startswith("A weight of 2963 kg m (3292 kg at 900 mm) on crank, at -1° in its")
    machine = actual.original
    assert weight.moment > machine.mass * weight.radius
    assert weight.radius == pytest.approx(0.9)
    place = weight.moment / 3000 * np.exp(1j * weight.direction)
    link = machine.links["crank"].with_added(3000.0, (place.real, place.imag), 0.0)
    changed = machine.with_link("crank", mass=link.mass, inertia=link.inertia,
                                center_of_mass=link.center_of_mass)  # fmt: skip
    swings = [np.std(eq.analyze(item, 720).forces.drive_torque) for item in (machine, changed)]
    assert 1 - swings[1] / swings[0] == pytest.approx(weight.gain, abs=2e-3)
    sizes = [np.ptp(eq.analyze(item, 720).forces.drive_torque) for item in (machine, changed)]
    assert sizes[1] < 0.4 * sizes[0]


def test_the_radius_of_a_crank_is_from_its_pivot() -> None:
    """Wherever the origin of its axes is."""
    machine = advice_for("pump-jack").original
    crank = machine.links["crank"]
    points = {name: (x + 0.4, y) for name, (x, y) in crank.points.items()}
    assert crank.center_of_mass is not None
    center = (crank.center_of_mass[0] + 0.4, crank.center_of_mass[1])
    moved = machine.with_link("crank", points=points, center_of_mass=center)
    actual = [advise(item).advice for item in (machine, moved)]
    weights = [item.beyond.counterbalance for item in actual if item is not None]
    assert weights[0] is not None and weights[1] is not None
    assert weights[1].radius == pytest.approx(weights[0].radius) == pytest.approx(0.7)


# Half a piston stands before it too: the first test of this file.
@pytest.mark.exhaustive
def test_more_arms_stand_before_the_plate_that_brings_less() -> None:
    first, second, *_ = first_lines("planetary-planting-arm")
    assert first.startswith("A second arm like this one, opposite on carrier, would take 100 %")
    assert second.startswith("Without that: Shaking force, RMS: 40.6 → 22.4 N")


# Nearly dead dyads: tests/unit/results/test_headline.py.
@pytest.mark.exhaustive
def test_lengths_stand_before_masses_where_a_dyad_is_nearly_dead() -> None:
    """Two arms of a wiper, 18.5 deg from where the first of them is stretched."""
    assert first_lines("wiper")[0].startswith("Transmission angle at C: 162°")
    assert said("wiper").count("Transmission angle at C") == 1


@pytest.mark.exhaustive(but=["beam-pump", "frame-saw"])
@pytest.mark.parametrize("name", ["reciprocating-saw", "frame-saw", "beam-pump", "wiper"])
def test_advice_on_what_to_do_does_not_say_to_leave_it(name: str) -> None:
    text = " ".join(first_lines(name))
    assert not advice_for(name).helps
    assert "Leave" not in text and "No other change that was tried is worth building" in text


# -- room ------------------------------------------------------------------------------------------


@pytest.mark.exhaustive(but=["kim-chung-b"])
@pytest.mark.parametrize("name", ["kim-chung-b", "transplanter"])
def test_a_counterweight_keeps_over_what_is_planted(name: str) -> None:
    advice = advice_for(name)
    machine = advice.original
    assert advice.helps and machine.planting is not None
    for change in advice.changes:
        pivot = machine.frame[change.values["at"]][1]
        for piece in change.values["pieces"]:
            lowest = pivot - piece["outer_radius"] - surface_of(machine)
            assert lowest >= OVER_SOIL * (1 - 1e-9)


# Planes of their own: tests/unit/balancing/test_advice.py.
@pytest.mark.exhaustive
def test_a_weight_that_passes_a_slot_has_a_plane_of_its_own() -> None:
    """The block of a scotch yoke goes 30 mm up and down in it, across which the sector turns."""
    advice = advice_for("scotch-yoke")
    (change,) = advice.changes
    motion = eq.move(advice.original, 360)
    block, yoke = (motion.points[name].place for name in "BY")
    along = np.imag(block - yoke)
    ends = (yoke + 1j * np.min(along), yoke + 1j * np.max(along))
    pivot = complex(*advice.original.frame["A"])
    (piece,) = change.values["pieces"]
    crossed = False
    for share in np.linspace(0, 1, 61):
        place = ends[0] + share * (ends[1] - ends[0]) - pivot
        seen = place * np.exp(-1j * motion.links["crank"].angle)
        aside = np.abs(np.angle(seen * np.exp(-1j * piece["direction"])))
        within = (piece["inner_radius"] < np.abs(seen)) & (np.abs(seen) < piece["outer_radius"])
        crossed |= bool(np.any(within & (aside < piece["angle"] / 2)))
    assert crossed
    assert next(in_short(change)).endswith("in a plane of its own beside yoke")


def test_a_plan_of_the_file_is_reported_of_the_pin_that_its_plate_covers() -> None:
    """The pin of a crank is 27 mm from its pivot, in the sector from 15 to 34 mm towards it."""
    result = eq.balance(eq.load("four-stroke-engine"))
    values = {"link": "crank", "pins": "B", "moment": "2256 g mm", "at": "A"}
    assert len(notes_by(_over_pins, result.notes, **values)) == 1
    (change,) = result.changes
    (piece,) = change.values["pieces"]
    assert covers(piece, 0j, 0.027 + 0j) and not covers(piece, 0j, -0.027 + 0j)
    assert not covers(piece, 0j, 0.036 + 0j) and not covers(piece, 0j, 0.014 + 0j)
    balanced = eq.balance(eq.load("balance-shafts"))
    assert not notes_by(_over_pins, balanced.notes, "link", "pins", "moment", "at")


@pytest.mark.parametrize(
    ("piece", "inside", "outside"),
    [
        ({"shape": "point"}, (), (0.01,)),
        ({"shape": "disc", "place": (0.05, 0.0), "radius": 0.02}, (0.05, 0.069), (0.029, 0.071)),
        ({"shape": "ring", "inner_radius": 0.01, "outer_radius": 0.02}, (0.015, -0.015j), (0.005,)),
        ({"shape": "sector", "inner_radius": 0.01, "outer_radius": 0.02, "angle": pi / 2,
          "direction": pi}, (-0.015, 0.015 * np.exp(2.4j)), (0.015, 0.015 * np.exp(2.3j))),
    ],
)  # fmt: skip
def test_what_a_plate_covers(
    piece: dict[str, object], inside: tuple[complex, ...], outside: tuple[complex, ...]
) -> None:
    assert all(covers(piece, 0j, complex(item)) for item in inside)
    assert not any(covers(piece, 0j, complex(item)) for item in outside)


@pytest.mark.parametrize("combine", ["sum", "squares"])
def test_shapes_are_compared_by_the_weights_that_a_plan_has(
    combine: Literal["sum", "squares"],
) -> None:
    """By the machine with the sector on its crank: a weight of 9 counts a square nine times."""
    machine = eq.load("yamashita-1").with_balance(None)
    aims = (Objective("shaking_force", weight=9.0), Objective("shaking_moment"))
    plan = Balance(objectives=aims, combine=combine)
    before = Problem.values_of(machine, aims)
    room, shape = room_about(machine, "crank"), Sector(0.05, 0.01, 0.01, -150, 120)
    known = {aim.name: value for aim, value in zip(aims, before, strict=True)}
    comparison = Comparison(machine, plan, (room,), (), None, known)
    changed, _ = with_sectors(machine, (room,), (shape,))
    force, moment = np.array(Problem.values_of(changed, aims)) / before
    left = (
        (9 * force + moment) / 10 if combine == "sum" else np.sqrt((9 * force**2 + moment**2) / 10)
    )
    (gain,) = comparison.gains(comparison.numbers_of([sectors([shape])]))
    assert gain == pytest.approx(1 - left, abs=1e-3)


# -- what can be built from ------------------------------------------------------------------------


# Plates and other shapes: `test_a_plate_names_its_material` and those beside it.
@pytest.mark.exhaustive
def test_a_mass_of_two_points_names_both() -> None:
    """Their middle alone has another moment of inertia."""
    balanced = eq.balance(eq.load("balance-geared-a"))
    change = balanced.changes[-1]
    assert len(change.values["pieces"]) == 2
    lines = [*in_short(change)]
    assert lines == [*sentences(change)] and len(lines) == 3
    assert [line.split("made as: ")[1].startswith("point mass of 117.6 g") for line in lines[1:]]
    assert " ".join(benefit_sentences(balanced)).count("point mass of ") == 2


def test_a_plate_names_its_material() -> None:
    balanced = eq.balance(eq.load("balance-shafts"))
    (facts,) = (item for item in balanced.headline(alone=True) if isinstance(item, Facts))
    crank, *shafts = facts.items
    assert "25.00 mm of cast iron" in crank
    assert len(shafts) == 2 and all("30.00 mm of steel" in shaft for shaft in shafts)
    for change in balanced.changes:
        for piece in change.values["pieces"]:
            area = piece["angle"] / 2 * (piece["outer_radius"] ** 2 - piece["inner_radius"] ** 2)
            whole = area * piece["thickness"] * piece["density"]
            assert whole == pytest.approx(piece["mass"], rel=1e-6)


def test_a_mass_of_another_density_names_that() -> None:
    machine = eq.load("yamashita-1").with_balance(None)
    weight = Weight("sector", 0.05, 0.01, 0.01, 4500.0)
    masses = (AddedMass("crank", "A", weight),)
    plan = Balance(masses=masses, objectives=(Objective("shaking_force"),))
    (change,) = eq.balance(machine, plan).changes
    assert "10.00 mm of 4500 kg/m³, " in " ".join(in_short(change))


# Holes: `test_holes_take_off_what_is_too_heavy` of test_advice.py.
@pytest.mark.exhaustive
def test_mass_that_is_taken_off_is_reported_as_a_hole() -> None:
    """67 g of steel are 8.5 cm3."""
    advice = advice_for("yamashita-rig-counterweight")
    (change,) = advice.changes
    assert change.kind == "removed mass"
    (text,) = in_short(change)
    assert text.endswith(", as much as a hole of 28 mm through 13.9 mm of steel")
    assert 7850 * pi / 4 * 0.028**2 * 0.0139 == pytest.approx(change.values["mass"], rel=3e-3)


def test_what_is_laid_behind_a_pin_has_kilograms() -> None:
    arms = beyond("rotary-transplanter").arms
    assert arms is not None
    machine = advice_for("rotary-transplanter").original
    moments = [(machine.links[name].mass or 0.0) * arms.distance for name in arms.links]
    assert arms.moment == pytest.approx(max(moments))
    assert "up to 25 kg mm (650 g at 38.2 mm) on each" in said("rotary-transplanter")
