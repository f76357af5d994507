"""A plan as a program, and its best numbers: effects, prices, equally good changes, refusals.

The closed form is held against the cone program, which must find the same: 1e-8.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

import equipoise as eq
from equipoise.balancing.balanced import Balanced, Price
from equipoise.balancing.optimisation import balance
from equipoise.balancing.problem import Problem
from equipoise.balancing.program import Affine
from equipoise.balancing.solution import closed_form
from equipoise.errors import MassError, ModelError, UsageError
from equipoise.mechanism.parts.balance import (
    AddedMass,
    Balance,
    CenterMove,
    Limit,
    Objective,
    SpringChoice,
    Statistic,
    Weight,
)
from support.chosen import few
from support.refusals import refused

MACHINE = eq.load("yamashita-1")
FORCE, TORQUE = Objective("shaking_force"), Objective("drive_torque", "peak", weight=0.5)
POINT = AddedMass("crank", "A", Weight("point", 0.06, at_most=0.8))
ON_ROCKER = AddedMass("rocker", "D", Weight("any", 0.06, at_most=0.4))
BOXED = CenterMove("coupler", x=(-0.06, 0.02), y=(-0.03, 0.03))
SPRING = SpringChoice("rocker", "C", "A", 100.0)
WHOLE = Balance(
    moves=(BOXED,),
    masses=(POINT, ON_ROCKER),
    springs=(SPRING,),
    objectives=(FORCE, TORQUE),
    added_mass=1.0,
)
PROBLEM = Problem.of(MACHINE, WHOLE)
NUMBERS = PROBLEM.project_feasible(
    [
        np.array([-0.2, 0.1, 9.0, 9.0]),
        np.array([0.5, 0.2, 0.3, 9.0, 9.0]),
        np.array([0.5, 0.1, 0.2, 0.3]),
        np.array([0.4, 0.1]),
    ]
)


def test_machine_of_numbers() -> None:
    result = PROBLEM.machine_with(NUMBERS)
    length = PROBLEM.parts[0].length  # type: ignore[attr-defined]
    coupler, old = result.links["coupler"], MACHINE.links["coupler"]
    assert coupler.center_of_mass == pytest.approx((-0.2 * length, 0.1 * length))
    assert (coupler.mass, coupler.inertia) == pytest.approx((old.mass, old.inertia))
    assert result.links["crank"].mass == pytest.approx(MACHINE.links["crank"].mass + 0.4)
    assert result.links["rocker"].mass == pytest.approx(MACHINE.links["rocker"].mass + 0.2)
    (spring,) = result.springs
    assert spring.stiffness == pytest.approx(40.0)


def test_no_numbers_make_the_machine_that_was() -> None:
    """Apart from a moved centre, which is then in the origin."""
    plan = replace(WHOLE, moves=())
    problem = Problem.of(MACHINE, plan)
    same = problem.machine_with([np.zeros(part.count) for part in problem.parts])
    for name, link in MACHINE.links.items():
        assert same.links[name].mass == pytest.approx(link.mass)
        assert same.links[name].center_of_mass == pytest.approx(link.center_of_mass)
        assert same.links[name].inertia == pytest.approx(link.inertia)


@pytest.mark.parametrize("combine", ["sum", "squares"])
def test_cost_of_numbers_is_that_of_their_machine(combine: str) -> None:
    problem = Problem.of(MACHINE, replace(WHOLE, combine=combine))  # type: ignore[arg-type]
    changed = problem.machine_with(NUMBERS)
    after, before = (
        eq.analyze(machine, 720, acceleration=0.0).summary for machine in (changed, MACHINE)
    )
    shares = (
        after["shaking_force"].rms / before["shaking_force"].rms,
        after["drive_torque"].peak / before["drive_torque"].peak,
    )

    def whole(first: float, second: float) -> float:
        return first + 0.5 * second if combine == "sum" else np.sqrt(first**2 + 0.5 * second**2)

    wanted = whole(*shares)
    assert problem.cost_at(NUMBERS) == pytest.approx(wanted, rel=1e-9)
    assert problem.cost_of(changed) == pytest.approx(wanted, rel=1e-9)
    assert problem.cost_of(MACHINE) == pytest.approx(whole(1.0, 1.0))


def test_program_holds_the_cost() -> None:
    """With all numbers given, its value is the cost of their machine."""
    program = PROBLEM.built.program.copy()
    for places, own in zip(PROBLEM.built.places, NUMBERS, strict=True):
        program.zero(Affine(np.eye(len(own)), places, -own))
    assert program.solve().value == pytest.approx(PROBLEM.cost_at(NUMBERS), rel=1e-6)


def test_squares_that_matter() -> None:
    """Inertia of crank and place of the coupler's centre squared: not for forces alone."""
    lifts = {square.lift for square in PROBLEM.built.squares}
    coupler, crank, *_ = PROBLEM.built.places
    assert lifts == set(map(int, coupler[2:]))  # a crank that turns evenly needs no inertia
    of_force = Problem.of(MACHINE, replace(WHOLE, objectives=(FORCE,)))
    assert of_force.built.squares == []
    assert not lifts & set(map(int, crank))


def test_limits_are_reported_with_their_names() -> None:
    limit = Limit(Objective("joints.A", "peak"), at_most=50.0)
    problem = Problem.of(MACHINE, replace(WHOLE, limits=(limit,)))
    names = problem.built.program.names
    assert "peak of joints.A" in names
    assert "added mass" in names
    peak = eq.analyze(MACHINE, 720, acceleration=0.0).summary["joints.A"].peak
    assert problem.before[limit.name] == pytest.approx(peak)


def test_added_masses() -> None:
    masses, units = PROBLEM.added_masses(PROBLEM.built.places)
    assert list(masses) == [PROBLEM.built.places[1][0], PROBLEM.built.places[2][0]]
    assert list(units) == pytest.approx([0.8, 0.4])


@pytest.mark.parametrize(
    ("objective", "has_effect"),
    [(FORCE, True), (Objective("joints.D"), False), (Objective("shaking_moment"), False)],
)
def test_influence(objective: Objective, has_effect: bool) -> None:
    """A weight about the crank's own pivot has no moment about it and does not reach D."""
    plan = Balance(masses=(POINT,), objectives=(objective,))
    problem = Problem.of(MACHINE, plan)
    if has_effect:
        problem.check_influence()
    else:
        with refused(UsageError, name=f"rms of {objective.output}"):
            problem.check_influence()


CRANK = AddedMass("crank", "A", Weight("any", 0.06, at_most=0.8))
LIFT = Objective("shaking_force.y", "ripple")
PLAN = Balance(masses=(CRANK,), objectives=(LIFT,))


@pytest.mark.parametrize(
    ("machine", "plan", "error", "expected"),
    [
        (MACHINE, None, UsageError, {"by": "_checked"}),
        (MACHINE, Balance(objectives=(LIFT,)), UsageError, {"by": "_checked"}),
        (MACHINE, Balance(masses=(CRANK,)), UsageError, {"by": "_checked"}),
        (MACHINE.with_drive(speed=0.0), PLAN, UsageError, {"by": "check_moving"}),
        (
            MACHINE,
            Balance(masses=(CRANK,), objectives=(Objective("joints.D"),)),
            UsageError,
            {"name": "rms of joints.D"},
        ),
        (
            MACHINE,
            Balance(springs=(SpringChoice("rocker", "C", "A", 9.0),), objectives=(LIFT,)),
            UsageError,
            {"name": "ripple of shaking_force.y"},
        ),
        (
            MACHINE,
            Balance(moves=(CenterMove("fork"),), objectives=(LIFT,)),
            ModelError,
            {"place": "balance.moves[1].link", "given": "fork"},
        ),
        (
            MACHINE.with_link("rocker", mass=None, center_of_mass=None, inertia=None),
            PLAN,
            MassError,
            {"links": "rocker"},
        ),
    ],
)
def test_refusals(
    machine: eq.Machine, plan: Balance | None, error: type[Exception], expected: dict[str, Any]
) -> None:
    with refused(error, **expected):
        eq.balance(machine, plan)


def test_the_least_mass_of_equally_good_ones_is_taken() -> None:
    """A limit that is met with less: the first order of y alone takes one first moment."""
    wish = Objective("shaking_force.y", "rms", (1.0,))
    balanced = eq.balance(MACHINE, Balance(masses=(CRANK,), objectives=(wish,)))
    change = balanced.changes[0].values
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


@pytest.mark.parametrize("shape", few(["disc", "ring"], {"ring"}))
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
    balanced = balance(MACHINE, PLANS[name])
    assert (str(balanced.method), balanced.gap, balanced.looked_at) == ("closed form", 0.0, 0)
    monkeypatch.setattr("equipoise.balancing.solution.closed_form", lambda problem: None)
    program = balance(MACHINE, PLANS[name])
    assert str(program.method) == "cone program"
    assert balanced.cost == pytest.approx(program.cost, abs=1e-8)
    assert balanced.cost <= program.cost + 1e-12
    assert program.bound <= balanced.cost + 1e-9


@pytest.mark.parametrize("weight", [0.2, 2.0, 9.0])
def test_weights_multiply_the_squares(weight: float) -> None:
    """What is least is weight * x^2 + y^2, over values before: against Nelder and Mead."""
    both = (replace(LIFT, weight=weight), Objective("shaking_force.x"))
    balanced = balance(MACHINE, Balance(moves=(MOVE,), objectives=both, combine="squares"))
    before = np.array([Problem.value_of(MACHINE, item) for item in both])

    def cost(place: np.ndarray[Any, Any]) -> float:
        moved = MACHINE.with_link("coupler", center_of_mass=tuple(map(float, place)))
        shares = [Problem.value_of(moved, item) for item in both] / before
        return float(np.sqrt(weight * shares[0] ** 2 + shares[1] ** 2))

    start = MACHINE.links["coupler"].center_of_mass
    blind = minimize(cost, start, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
    assert balanced.cost == pytest.approx(blind.fun, rel=1e-8)
    assert balanced.machine.links["coupler"].center_of_mass == pytest.approx(blind.x, abs=1e-6)


def test_the_least_squares_is_flat_there() -> None:
    """Any step of the coupler's centre makes it worse."""
    balanced = balance(MACHINE, PLANS["a moved centre"])
    x, y = balanced.machine.links["coupler"].center_of_mass
    for step in np.exp(1j * np.arange(0, 6, 0.5)) * 1e-4:
        place = (x + step.real, y + step.imag)
        beside = MACHINE.with_link("coupler", center_of_mass=place)
        assert Problem.value_of(beside, LIFT) > balanced.objectives[LIFT.name][1]


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


def limit(output: str, measure: Statistic, **much: float) -> Limit:
    return Limit(Objective(output, measure), **much)


def refusal(*limits: Limit, **more: object) -> str:
    plan = Balance(masses=(BOUNDED_CRANK,), objectives=(FORCE,), limits=limits, **more)  # type: ignore[arg-type]
    with pytest.raises(UsageError) as caught:
        eq.balance(MACHINE, plan)
    return str(caught.value)


def least_of(objective: Objective, *limits: Limit) -> float:
    plan = Balance(masses=(BOUNDED_CRANK,), objectives=(objective,), limits=limits)
    return eq.balance(MACHINE, plan).objectives[objective.name][1]


def printed_number(text: str) -> float:
    match = re.search(r"can become ([\d.e+-]+) ", text)
    assert match is not None, text
    return float(match[1])


def test_one_that_cannot_be_met() -> None:
    """With how small it can become at the least, which another program finds as well."""
    text = refusal(limit("shaking_force", "peak", ratio=0.01))
    assert text.startswith(
        "this limit cannot be met: peak of shaking_force at most 1 % of before; "
        "peak of shaking_force can become "
    )
    assert text.endswith(" N at the least")
    least = least_of(Objective("shaking_force", "peak"))
    assert printed_number(text) == pytest.approx(least, rel=1e-3)


def test_absolute_limits_have_units() -> None:
    text = refusal(limit("joints.A", "peak", at_most=0.5))
    assert "peak of joints.A at most 0.5 N;" in text


def test_two_that_clash() -> None:
    """Each alone can be met, and a third that is harmless is not named."""
    x = limit("shaking_force.x", "rms", at_most=2.9)
    y = limit("shaking_force.y", "rms", ratio=0.26)
    harmless = limit("drive_torque", "peak", ratio=50.0)
    text = refusal(harmless, x, y)
    for item in (x, y):
        assert least_of(FORCE, item) > 0
    assert text.startswith("these limits clash: rms of shaking_force.x at most 2.9 N and ")
    assert " and rms of shaking_force.y at most 26 % of before; " in text
    assert "drive_torque" not in text
    assert text.endswith(" while the other is kept")
    assert printed_number(text) == pytest.approx(least_of(x.objective, y), rel=1e-3)


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
    with refused(UsageError, value=700.0, unit="g"):
        eq.balance(MACHINE, plan)
