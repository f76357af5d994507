"""The best numbers of one problem: refusals, prices, equally good changes, limits that clash.

The closed form is held against the cone program, which must find the same: 1e-8."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.balanced import Balanced, Price
from equipoise.balancing.optimisation import balance
from equipoise.balancing.problem import Problem
from equipoise.balancing.solution import closed_form
from equipoise.errors import MassError, ModelError, UsageError
from equipoise.mechanism.balance import (
    AddedMass,
    Balance,
    CenterMove,
    Limit,
    Measure,
    Objective,
    SpringChoice,
    Weight,
)

MACHINE = eq.load("yamashita-1")
CRANK = AddedMass("crank", "A", Weight("any", 0.06, at_most=0.8))
LIFT = Objective("shaking_force.y", "ripple")
PLAN = Balance(masses=(CRANK,), objectives=(LIFT,))


@pytest.mark.parametrize(
    ("machine", "plan", "error", "words"),
    [
        (MACHINE, None, UsageError, "nothing is free to change"),
        (MACHINE, Balance(objectives=(LIFT,)), UsageError, "nothing is free to change"),
        (MACHINE, Balance(masses=(CRANK,)), UsageError, "nothing is to become small"),
        (MACHINE.with_drive(speed=0.0), PLAN, UsageError, "stands still"),
        (
            MACHINE,
            Balance(masses=(CRANK,), objectives=(Objective("joints.D"),)),
            UsageError,
            "nothing that is free to change has an effect on the rms of joints.D",
        ),
        (
            MACHINE,
            Balance(springs=(SpringChoice("rocker", "C", "A", 9.0),), objectives=(LIFT,)),
            UsageError,
            "has an effect on the ripple of shaking_force.y",
        ),
        (MACHINE, Balance(moves=(CenterMove("fork"),), objectives=(LIFT,)), ModelError, "fork"),
        (
            MACHINE.with_link("rocker", mass=None, center_of_mass=None, inertia=None),
            PLAN,
            MassError,
            "rocker",
        ),
    ],
)
def test_refusals(
    machine: eq.Machine, plan: Balance | None, error: type[Exception], words: str
) -> None:
    with pytest.raises(error, match=words):
        eq.balance(machine, plan)


def test_the_least_mass_of_equally_good_ones_is_taken() -> None:
    """A limit that is met with less: the first order of y alone takes one first moment."""
    wish = Objective("shaking_force.y", "rms", (1.0,))
    found = eq.balance(MACHINE, Balance(masses=(CRANK,), objectives=(wish,)))
    change = found.changes[0].values
    assert change["mass"] < 0.8
    assert change["moment"] == pytest.approx(0.06 * change["mass"], rel=1e-4)


def test_price_of_one_objective_is_in_its_unit() -> None:
    """N for each kg; the weight of the only objective does not count."""
    rms = Objective("shaking_force", "rms", weight=3.0)

    def force(most: float) -> Balanced:
        weight = AddedMass("crank", "A", Weight("any", 0.06, at_most=most))
        return eq.balance(MACHINE, Balance(masses=(weight,), objectives=(rms,)))

    values = [force(0.2 + step).objectives[rms.name][1] for step in (1e-4, -1e-4)]
    price = force(0.2).prices["mass on crank"]
    assert price.price == pytest.approx((values[1] - values[0]) / 2e-4, rel=1e-4)
    assert price.active
    assert price.used == pytest.approx(0.2)
    assert not Price(1.0, 0.5, 0.0).active


@pytest.mark.parametrize("shape", ["disc", "ring"])
def test_price_of_mass_cut_from_a_plate(shape: str) -> None:
    """Inertia grows with the square of the mass."""
    torque = Objective("drive_torque", "rms")

    def at(most: float) -> Balanced:
        inner = {"inner_radius": 0.01} if shape == "ring" else {}
        weight = Weight(shape, 0.05, thickness=0.008, density=7850.0, at_most=most, **inner)  # type: ignore[arg-type]
        return eq.balance(
            MACHINE, Balance(masses=(AddedMass("rocker", "D", weight),), objectives=(torque,))
        )

    values = [at(0.15 + step).objectives[torque.name][1] for step in (1e-3, -1e-3)]
    price = at(0.15).prices["mass on rocker"].price
    assert price == pytest.approx((values[1] - values[0]) / 2e-3, rel=1e-3)


GIVEN = AddedMass("crank", "A", Weight("point", mass=1.0))
SPREAD = AddedMass("rocker", "D", Weight("any", mass=0.4))
MOVE = CenterMove("coupler")

FORCE = Objective("shaking_force")

PLANS = {
    "a moved centre": Balance(moves=(MOVE,), objectives=(LIFT,)),
    "a weight": Balance(masses=(GIVEN,), objectives=(FORCE,)),
    "both": Balance(masses=(GIVEN, SPREAD), moves=(MOVE,), objectives=(LIFT,)),
    "a joint": Balance(moves=(CenterMove("crank"),), objectives=(Objective("joints.A", "rms"),)),
    "squares of two": Balance(
        masses=(GIVEN,),
        moves=(MOVE,),
        objectives=(replace(LIFT, weight=2.0), Objective("shaking_force.x")),
        combine="squares",
    ),
}


@pytest.mark.parametrize("name", PLANS)
def test_the_cone_program_finds_the_same(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found = balance(MACHINE, PLANS[name])
    assert (str(found.method), found.gap, found.looked_at) == ("closed form", 0.0, 0)
    monkeypatch.setattr("equipoise.balancing.solution.closed_form", lambda problem: None)
    program = balance(MACHINE, PLANS[name])
    assert str(program.method) == "cone program"
    assert found.cost == pytest.approx(program.cost, abs=1e-8)
    assert found.cost <= program.cost + 1e-12
    assert program.bound <= found.cost + 1e-9


def test_the_least_squares_is_flat_there() -> None:
    """Any step of the coupler's centre makes it worse."""
    found = balance(MACHINE, PLANS["a moved centre"])
    x, y = found.machine.links["coupler"].center_of_mass
    for step in np.exp(1j * np.arange(0, 6, 0.5)) * 1e-4:
        place = (x + step.real, y + step.imag)
        beside = MACHINE.with_link("coupler", center_of_mass=place)
        assert Problem.value_of(beside, LIFT) > found.objectives[LIFT.name][1]


LIMITED = {
    "a limit": {"limits": (Limit(FORCE, ratio=2.0),)},
    "a sum of two": {"objectives": (LIFT, FORCE)},
    "a peak": {"objectives": (Objective("shaking_force.y", "peak"),)},
    "a room": {"masses": (AddedMass("crank", "A", Weight("point", 0.05, mass=1.0)),)},
    "an open mass": {"masses": (AddedMass("crank", "A", Weight("point", 0.05, at_most=1.0)),)},
    "a most of all mass": {"added_mass": 2.0},
    "a box": {"moves": (CenterMove("coupler", x=(-0.05, 0.05), y=(-0.05, 0.05)),)},
    "a disc": {
        "masses": (
            AddedMass("crank", "A", Weight("disc", 0.1, thickness=0.01, density=7850.0, mass=0.1)),
        )
    },
    "a spring": {"springs": (SpringChoice("rocker", "C", "A", 100.0),)},
    "inertia that counts": {"objectives": (Objective("shaking_moment"),)},
}


@pytest.mark.parametrize("why", LIMITED)
def test_there_is_none_with(why: str) -> None:
    plan = replace(PLANS["both"], **LIMITED[why])
    assert closed_form(Problem.of(MACHINE, plan)) is None
    assert closed_form(Problem.of(MACHINE, PLANS["both"])) is not None


BOUNDED_CRANK = AddedMass("crank", "A", Weight("point", 0.05, at_most=0.9))


def limit(output: str, measure: Measure, **much: float) -> Limit:
    return Limit(Objective(output, measure), **much)


def refusal(*limits: Limit, **more: object) -> str:
    plan = Balance(masses=(BOUNDED_CRANK,), objectives=(FORCE,), limits=limits, **more)  # type: ignore[arg-type]
    with pytest.raises(UsageError) as caught:
        eq.balance(MACHINE, plan)
    return str(caught.value)


def least_of(objective: Objective, *limits: Limit) -> float:
    plan = Balance(masses=(BOUNDED_CRANK,), objectives=(objective,), limits=limits)
    return eq.balance(MACHINE, plan).objectives[objective.name][1]


def told_number(text: str) -> float:
    found = re.search(r"can become ([\d.e+-]+) ", text)
    assert found is not None, text
    return float(found[1])


def test_one_that_cannot_be_met() -> None:
    """With how small it can become at the least, which another program finds as well."""
    text = refusal(limit("shaking_force", "peak", ratio=0.01))
    assert text.startswith(
        "this limit cannot be met: peak of shaking_force at most 1 % of before; "
        "peak of shaking_force can become "
    )
    assert text.endswith(" N at the least")
    least = least_of(Objective("shaking_force", "peak"))
    assert told_number(text) == pytest.approx(least, rel=1e-3)


def test_absolute_limits_have_units() -> None:
    text = refusal(limit("joints.A", "peak", at_most=0.5))
    assert "peak of joints.A at most 0.5 N;" in text


def test_two_that_clash() -> None:
    """Each alone can be met, and a third that is harmless is not named."""
    x = limit("shaking_force.x", "rms", at_most=2.9)
    y = limit("shaking_force.y", "rms", ratio=0.26)
    harmless = limit("drive_torque", "peak", ratio=50.0)
    text = refusal(harmless, x, y)
    for one in (x, y):
        assert least_of(FORCE, one) > 0
    assert text.startswith("these limits clash: rms of shaking_force.x at most 2.9 N and ")
    assert " and rms of shaking_force.y at most 26 % of before; " in text
    assert "drive_torque" not in text
    assert text.endswith(" while the other is kept")
    assert told_number(text) == pytest.approx(least_of(x.objective, y), rel=1e-3)


def test_mass_that_is_lacking_is_named() -> None:
    """10 g in all cannot do it, 900 g can."""
    wish = limit("shaking_force", "rms", ratio=0.6)
    assert least_of(FORCE, wish) > 0
    text = refusal(wish, added_mass=0.01)
    assert "rms of shaking_force at most 60 % of before" in text
    assert "added mass at most 10 g" in text
    assert "can become" in text


def test_a_plan_that_contradicts_itself() -> None:
    given = AddedMass("crank", "A", Weight("point", 0.05, mass=0.5))
    plan = Balance(masses=(given, given), objectives=(FORCE,), added_mass=0.7)
    with pytest.raises(UsageError, match="added mass at most 700 g; allow more of it"):
        eq.balance(MACHINE, plan)
