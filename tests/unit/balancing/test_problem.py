"""A plan as a program: its numbers, machines, values and costs, and what has an effect."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.problem import Problem
from equipoise.errors import UsageError
from equipoise.mechanism.balance import (
    AddedMass,
    Balance,
    CenterMove,
    Limit,
    Objective,
    SpringChoice,
    Weight,
)

MACHINE = eq.load("yamashita-1")
FORCE, TORQUE = Objective("shaking_force"), Objective("drive_torque", "peak", weight=0.5)
POINT = AddedMass("crank", "A", Weight("point", 0.06, at_most=0.8))
SPREAD = AddedMass("rocker", "D", Weight("any", 0.06, at_most=0.4))
MOVE = CenterMove("coupler", x=(-0.06, 0.02), y=(-0.03, 0.03))
SPRING = SpringChoice("rocker", "C", "A", 100.0)
PLAN = Balance(
    moves=(MOVE,),
    masses=(POINT, SPREAD),
    springs=(SPRING,),
    objectives=(FORCE, TORQUE),
    added_mass=1.0,
)
PROBLEM = Problem.of(MACHINE, PLAN)
NUMBERS = PROBLEM.tightened(
    [
        np.array([-0.2, 0.1, 9.0, 9.0]),
        np.array([0.5, 0.2, 0.3, 9.0, 9.0]),
        np.array([0.5, 0.1, 0.2, 0.3]),
        np.array([0.4, 0.1]),
    ]
)


def test_machine_of_numbers() -> None:
    found = PROBLEM.machine_with(NUMBERS)
    length = PROBLEM.parts[0].length  # type: ignore[attr-defined]
    coupler, old = found.links["coupler"], MACHINE.links["coupler"]
    assert coupler.center_of_mass == pytest.approx((-0.2 * length, 0.1 * length))
    assert (coupler.mass, coupler.inertia) == pytest.approx((old.mass, old.inertia))
    assert found.links["crank"].mass == pytest.approx(MACHINE.links["crank"].mass + 0.4)
    assert found.links["rocker"].mass == pytest.approx(MACHINE.links["rocker"].mass + 0.2)
    (spring,) = found.springs
    assert spring.stiffness == pytest.approx(40.0)


def test_no_numbers_make_the_machine_that_was() -> None:
    """Apart from a moved centre, which is then in the origin."""
    plan = replace(PLAN, moves=())
    problem = Problem.of(MACHINE, plan)
    same = problem.machine_with([np.zeros(part.count) for part in problem.parts])
    for name, link in MACHINE.links.items():
        assert same.links[name].mass == pytest.approx(link.mass)
        assert same.links[name].center_of_mass == pytest.approx(link.center_of_mass)
        assert same.links[name].inertia == pytest.approx(link.inertia)


@pytest.mark.parametrize("combine", ["sum", "squares"])
def test_cost_of_numbers_is_that_of_their_machine(combine: str) -> None:
    problem = Problem.of(MACHINE, replace(PLAN, combine=combine))  # type: ignore[arg-type]
    changed = problem.machine_with(NUMBERS)
    forces = eq.analyze(changed, 720, acceleration=0.0).forces
    before = eq.analyze(MACHINE, 720, acceleration=0.0).forces
    shares = (
        np.sqrt(np.mean(forces.shaking_force.size**2) / np.mean(before.shaking_force.size**2)),
        0.5 * np.max(np.abs(forces.drive_torque)) / np.max(np.abs(before.drive_torque)),
    )
    wanted = sum(shares) if combine == "sum" else np.hypot(*shares)
    assert problem.cost_at(NUMBERS) == pytest.approx(wanted, rel=1e-9)
    assert problem.cost_of(changed) == pytest.approx(wanted, rel=1e-9)
    assert problem.cost_of(MACHINE) == pytest.approx(1.5 if combine == "sum" else np.hypot(1, 0.5))


def test_program_holds_the_cost() -> None:
    """With all numbers given, its value is the cost of their machine."""
    from equipoise.balancing.program import Affine

    program = PROBLEM.built.program.copy()
    for places, own in zip(PROBLEM.built.places, NUMBERS, strict=True):
        program.zero(Affine(np.eye(len(own)), places, -own))
    assert program.solve().value == pytest.approx(PROBLEM.cost_at(NUMBERS), rel=1e-6)


def test_squares_that_matter() -> None:
    """Inertia of crank and place of the coupler's centre squared: not for forces alone."""
    lifts = {square.lift for square in PROBLEM.built.squares}
    coupler, crank, *_ = PROBLEM.built.places
    assert lifts == set(map(int, coupler[2:]))  # a crank that turns evenly needs no inertia
    of_force = Problem.of(MACHINE, replace(PLAN, objectives=(FORCE,)))
    assert of_force.built.squares == []
    assert not lifts & set(map(int, crank))


def test_limits_are_told_with_their_names() -> None:
    limit = Limit(Objective("joints.A", "peak"), at_most=50.0)
    problem = Problem.of(MACHINE, replace(PLAN, limits=(limit,)))
    names = problem.built.program.names
    assert "peak of joints.A" in names
    assert "added mass" in names
    assert problem.before[limit.name] == pytest.approx(
        np.max(eq.forces(eq.move(MACHINE, 720, acceleration=0.0)).joints["A"].size)
    )


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
        with pytest.raises(UsageError, match="nothing that is free to change has an effect"):
            problem.check_influence()
