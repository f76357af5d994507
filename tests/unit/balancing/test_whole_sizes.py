"""Counterweights of a plan as they are cut: whole sizes, inside their room and all limits."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.balanced import Balanced, Price
from equipoise.balancing.problem import Problem
from equipoise.balancing.whole_sizes import in_whole_sizes
from equipoise.exchange.formats import Job
from equipoise.exchange.parts import COUNTERWEIGHT, parts
from equipoise.mechanism.dynamics.parameters import parameter_values
from equipoise.mechanism.parts.balance import AddedMass, Balance, Limit, Objective, Weight
from unit.balancing.bodies import PLATE, moments_of

DENSITIES = {"balance-shafts": {"crank": 7200.0}}
"""kg/m3 of counterweights that are not of steel."""
SHAPES = {
    "disc": Weight("disc", 0.0603, **PLATE),
    "ring": Weight("ring", 0.0604, 0.0123, mass=0.3, **PLATE),
    "sector": Weight("sector", 0.0605, 0.0123, **PLATE),
}


@cache
def balanced(name: str) -> Balanced:
    if name not in SHAPES:
        return eq.balance(eq.load(name))
    aim = "drive_torque" if name == "ring" else "shaking_force"
    link, at = ("rocker", "D") if name == "ring" else ("crank", "A")
    plan = Balance(masses=(AddedMass(link, at, SHAPES[name]),), objectives=(Objective(aim),))
    return eq.balance(eq.load("yamashita-1"), plan)


@cache
def rounded(name: str) -> tuple[Balanced, str]:
    return in_whole_sizes(balanced(name))


def added(result: Balanced, name: str) -> dict[str, Any]:
    """Mass, first moments and inertia of all pieces of each link, by integrals over them."""
    of_links: dict[str, Any] = {}
    for change in result.changes:
        for piece in change.values.get("pieces", ()):
            other = DENSITIES.get(name, {}).get(change.link, PLATE["density"]) / PLATE["density"]
            moments = other * moments_of(piece, complex(*change.values["center"]))
            of_links[change.link] = of_links.get(change.link, 0.0) + moments
    return of_links


def of_links(machine: eq.Machine) -> dict[str, Any]:
    return dict(zip(machine.links, parameter_values(machine).reshape(-1, 4), strict=True))


NAMES = pytest.mark.parametrize("name", [*SHAPES, "balance-shafts", "twin-engine"])


@NAMES
def test_the_machine_has_the_pieces_that_are_cut(name: str) -> None:
    """Against integrals over the old and the new pieces: nothing else has changed."""
    old, (new, _) = balanced(name), rounded(name)
    was, now = added(old, name), added(new, name)
    assert was.keys() == now.keys() != set()
    before, after = of_links(old.machine), of_links(new.machine)
    for link, values in after.items():
        wanted = before[link] + now.get(link, 0.0) - was.get(link, 0.0)
        scale = np.abs(before[link]) + 1e-9
        np.testing.assert_allclose(values / scale, wanted / scale, rtol=0, atol=1e-6)
    masses = {change.link: 0.0 for change in new.changes}
    for change in new.changes:
        masses[change.link] += change.values.get("mass", 0.0)
    for link, values in now.items():
        assert masses[link] == pytest.approx(values[0], rel=1e-9)


@NAMES
def test_sizes_are_whole_and_inside_of_the_room(name: str) -> None:
    """As they are read off the drawing; radii that the plan gives stay."""
    result, sentence = rounded(name)
    drawn = parts(Job(result.machine, 0.0, result.changes))
    drawn = [part for part in drawn if part.kind == COUNTERWEIGHT]
    assert drawn and sentence.startswith("sizes of counterweights are rounded to whole")
    given = {0.0605, 0.0123}
    for part in drawn:
        for curve in part.curves:
            size = 2e3 * curve.radius
            assert curve.radius in given or size == pytest.approx(round(size), abs=1e-6)
            if not curve.whole:
                for angle in np.degrees([curve.angle, curve.direction]):
                    assert angle == pytest.approx(round(angle), abs=1e-6)
        if name in SHAPES:
            low, high = part.box
            room = SHAPES[name].radius * (1 + 1e-9)
            assert max(abs(low.real), abs(low.imag), abs(high.real), abs(high.imag)) <= room
            lines = " ".join(part.lines)
            assert f"mass {1e3 * part.mass:.0f} g" in lines  # type: ignore[operator]


@NAMES
def test_figures_are_those_of_the_machine_that_is_cut(name: str) -> None:
    new, _ = rounded(name)
    values = Problem.values_of(new.machine, new.plan.objectives)
    assert [after for _, after in new.objectives.values()] == pytest.approx(values, rel=1e-12)


def test_what_rounding_changes_is_said_where_it_is_seen() -> None:
    """A sector of few degrees loses much; one that is a result's thousandth nothing."""
    result, sentence = rounded("balance-shafts")
    assert sentence.endswith("changes the result by less than 0.1 % of the value before")
    ((name, (before, best)),) = balanced("balance-shafts").objectives.items()
    assert abs(result.objectives[name][1] - best) < 1e-3 * before
    sharp = replace(balanced("balance-shafts"), objectives={name: (before, 0.9 * best)})
    _, sentence = in_whole_sizes(sharp)
    assert f"shaking force, RMS is {result.objectives[name][1]:.1f} instead of " in sentence


@pytest.mark.parametrize("share", [1.0, 1.0 - 1e-4])
def test_sizes_that_would_exceed_a_limit_are_rounded_otherwise_or_not(share: float) -> None:
    """The added mass: a lighter piece keeps it.  The optimum itself: nothing else keeps it."""
    exact = balanced("sector")
    objective = exact.plan.objectives[0]
    (_, best) = exact.objectives[objective.name]
    limit = Limit(objective, at_most=best)
    hard = replace(
        exact,
        plan=replace(exact.plan, limits=(limit,)),
        prices={limit.name: Price(best, best, 0.0, "N")},
    )
    kept, sentence = in_whole_sizes(hard)
    assert kept is hard and "would exceed the limit on" in sentence
    mass = sum(change.values["mass"] for change in exact.changes)
    light = replace(exact, prices={"added mass": Price(mass, mass, 0.0, "kg")})
    result, sentence = in_whole_sizes(light)
    assert "rounded to whole" in sentence
    assert sum(change.values["mass"] for change in result.changes) <= mass * (1 + 1e-6)


def test_limits_on_two_weights_of_one_link_are_those_of_the_pieces_that_are_cut() -> None:
    """Each limit beside the mass of its own piece, and the added mass beside that of both."""
    masses = tuple(
        AddedMass("crank", at, Weight("disc", 0.0603, at_most=0.0512, **PLATE)) for at in "AB"
    )
    plan = Balance(masses=masses, objectives=(Objective("shaking_force"),), added_mass=10.0)
    exact = eq.balance(eq.load("yamashita-1"), plan)
    result, _ = in_whole_sizes(exact)
    used = {str(name): price.used for name, price in result.prices.items()}
    changed = [change.values["mass"] for change in result.changes]
    assert len(changed) == 2 and result.changes != exact.changes
    assert used["added mass"] == pytest.approx(sum(changed), rel=1e-6)
    for number, mass in enumerate(changed, 1):
        assert used[f"mass on crank ({number})"] == pytest.approx(mass, rel=1e-6)


@pytest.mark.parametrize(("inner", "outer"), [(0.0202, 0.0205), (0.0302, 0.0302)])
def test_a_thin_ring_does_not_vanish(inner: float, outer: float) -> None:
    """Its outer diameter stays beyond its hole; where no whole one fits, it stays as it is."""
    weight = Weight("ring", outer, inner, mass=0.01, **PLATE)
    plan = Balance(
        masses=(AddedMass("rocker", "D", weight),), objectives=(Objective("drive_torque"),)
    )
    exact = balanced("ring")
    (change,) = exact.changes
    piece = {**change.values["pieces"][0], "inner_radius": inner, "outer_radius": inner + 1e-4}
    thin = replace(change, values={**change.values, "pieces": [piece]})
    result, _ = in_whole_sizes(replace(exact, changes=(thin,), plan=plan, prices={}))
    (cut,) = result.changes[0].values["pieces"]
    assert cut["mass"] > 0 and inner < cut["outer_radius"]
    whole = 2e3 * cut["outer_radius"]
    assert (whole == pytest.approx(round(whole), abs=1e-6)) == (outer > inner)


def test_sizes_that_are_whole_stay() -> None:
    """Those of advice are chosen so."""
    advised = eq.balancing.advise(eq.load("yamashita-1"))
    assert in_whole_sizes(advised) == (advised, "")
