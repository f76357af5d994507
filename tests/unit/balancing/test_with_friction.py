"""Balancing with friction in joints, which makes outputs nonlinear in the masses."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing import solution
from equipoise.balancing.balanced import _of_friction
from equipoise.balancing.problem import Problem
from equipoise.balancing.program import Program, ProgramSolution
from equipoise.errors import UsageError
from equipoise.mechanism.parts.balance import (
    AddedMass,
    Balance,
    CenterMove,
    Limit,
    Objective,
    Phases,
    Weight,
)
from equipoise.mechanism.parts.machine import Row
from support.refusals import has_value, refused
from support.sentences import notes_by

PUMP = eq.load("plunger-pump")
# with more friction than a pump would have, so that it matters where masses are
RUBBING = replace(
    PUMP,
    joints=tuple(replace(joint, friction=4 * (joint.friction or 0.0)) for joint in PUMP.joints),
)
BOX = (-0.02, 0.02)
ROD = CenterMove("rod", x=(0.0, 0.05), y=(-0.01, 0.01))
CRANK = CenterMove("crank", x=BOX, y=BOX)
SECTOR = Weight("sector", radius=0.034, thickness=0.012, density=7850.0)


@pytest.mark.parametrize("measure", ["rms", "peak"])
def test_no_place_nearby_is_better(measure: Literal["rms", "peak"]) -> None:
    """Of centres of mass about that of the result, each with the friction that it has itself."""
    objective = Objective("joints.A", measure)
    plan = Balance(moves=(CRANK,), objectives=(objective,))

    def value_at(place: complex) -> float:
        moved = RUBBING.with_link("crank", center_of_mass=(place.real, place.imag))
        return Problem.value_of(moved, objective)

    balanced = eq.balance(RUBBING, plan)
    without = eq.balance(RUBBING.without_friction(), plan)
    own, other = (complex(*result.changes[0].values["to"]) for result in (balanced, without))
    after = value_at(own)
    assert after == pytest.approx(balanced.objectives[objective.name][1], rel=1e-9)
    assert after < value_at(other) * (1 + 1e-9)
    around = [own + radius * np.exp(1j * np.arange(5)) for radius in (1e-4, 1e-3)]
    inside = [place for place in np.concatenate(around) if abs(place.real) < 0.02 > abs(place.imag)]
    assert len(inside) > 3
    # each step takes friction for known, so that its own change with the masses is left out
    assert after <= min(map(value_at, inside)) * (1 + 1e-4)


def test_limits_are_kept_with_friction() -> None:
    """Of a force that was 0.8 % above its limit while the optimum was computed without friction."""
    limited = Objective("joints.A", "peak")
    plan = Balance(
        masses=(AddedMass("crank", "A", SECTOR),),
        objectives=(Objective("drive_torque"),),
        limits=(Limit(limited, ratio=1.0),),
    )
    for machine in (PUMP, RUBBING):
        balanced = eq.balance(machine, plan)
        before = Problem.value_of(machine, limited)
        assert Problem.value_of(balanced.machine, limited) <= before * (1 + 1e-7)
        assert balanced.gap < 1e-6
        assert balanced.cost < 1
        (note,) = (note for note in balanced.notes if "nonlinear" in note)
        assert "drive_torque and joints.A" in note


def test_only_the_last_round_is_proved(monkeypatch: pytest.MonkeyPatch) -> None:
    """As a proof takes hundreds of programs, which earlier rounds do not need."""
    solved, solve = [0], Program.solve

    def counted(self: Program) -> ProgramSolution:
        solved[0] += 1
        return solve(self)

    plan = Balance(
        moves=(CRANK, CenterMove("rod", x=(-0.02, 0.06), y=BOX)),
        objectives=(Objective("drive_torque"),),
        limits=(Limit(Objective("joints.A", "peak"), ratio=0.95),),
    )
    monkeypatch.setattr(Program, "solve", counted)
    balanced = eq.balance(RUBBING, plan)
    assert 0 < solved[0] < 100
    assert balanced.gap < 1e-6
    assert balanced.prices["peak of joints.A"].used == pytest.approx(
        0.95 * Problem.value_of(RUBBING, Objective("joints.A", "peak")), rel=1e-7
    )


@pytest.mark.exhaustive(but=["machine1"])
@pytest.mark.parametrize("machine", [PUMP, RUBBING])
def test_what_can_be_reached_with_friction_is_not_refused(machine: eq.Machine) -> None:
    """Though with the friction of the machine before it could not be reached."""
    limited = Objective("joints.B", "peak")
    least = eq.balance(machine, Balance(moves=(ROD,), objectives=(limited,)))
    before, reached = least.objectives[limited.name]
    plan = Balance(
        moves=(ROD,),
        objectives=(Objective("joints.A"),),
        limits=(Limit(limited, at_most=reached * (1 + 1e-5)),),
    )
    assert Problem.value_of(eq.balance(machine, plan).machine, limited) <= reached * (1 + 1.1e-5)
    beyond = replace(plan, limits=(Limit(limited, ratio=0.999 * reached / before),))
    with refused(UsageError, name="peak of joints.B", unit="N", least=float(reached)):
        eq.balance(machine, beyond)


# Limits that friction passes: `test_limits_are_kept_with_friction`.
@pytest.mark.exhaustive
def test_a_limit_is_kept_though_friction_does_not_settle(monkeypatch: pytest.MonkeyPatch) -> None:
    """And the value by which such results are compared is the cost of their own numbers."""
    limited = Objective("joints.B", "peak")
    plan = Balance(
        moves=(ROD, CRANK),
        objectives=(Objective("shaking_force"),),
        limits=(Limit(limited, ratio=1.0),),
    )
    problem = Problem.of(RUBBING, plan)
    best = solution.solve_problem(problem)
    monkeypatch.setattr(solution, "ROUNDS", 0)
    first = solution._settled(problem, None, np.inf)
    assert not first.settled
    assert problem.limits_passed_with_friction(first.machine) == [limited.name]
    kept = solution.solve_problem(problem)
    assert problem.limits_passed_with_friction(kept.machine) == []
    assert kept.best.value == pytest.approx(problem.cost_of(kept.machine), rel=1e-9)
    assert kept.best.value > best.best.value


def test_the_limit_that_friction_changes_is_said_to_be_too_low() -> None:
    """Of a clash with one before it that no friction changes."""
    force, joint = Objective("shaking_force"), Objective("joints.A", "peak")
    plan = Balance(moves=(CRANK,), objectives=(joint,), limits=(Limit(force, ratio=0.5),))
    reached = eq.balance(RUBBING, plan).objectives[joint.name][1]
    plan = replace(plan, objectives=(Objective("drive_torque"),))
    plan = replace(plan, limits=(*plan.limits, Limit(joint, at_most=0.99 * reached)))
    least = float(reached)
    with refused(
        UsageError, share=50.0, name="peak of joints.A", value=1649.0, least=least
    ) as error:
        eq.balance(RUBBING, plan)
    assert has_value(error.value.note, "name", "rms of shaking_force")


def test_limits_that_clash_apart_from_friction_are_refused_without_a_word_of_it() -> None:
    plan = Balance(
        moves=(ROD,),
        objectives=(Objective("joints.A"),),
        limits=(Limit(Objective("shaking_force"), ratio=1e-3),),
    )
    with refused(UsageError, name="rms of shaking_force", share=0.1, least=81.77) as error:
        eq.balance(PUMP, plan)
    assert "friction" not in str(error.value)


def test_a_round_too_few_is_a_note(monkeypatch: pytest.MonkeyPatch) -> None:
    """Which tells by how much the figures differ from those that the bound assumes."""
    objective = Objective("joints.B", "peak")
    plan = Balance(moves=(ROD,), objectives=(objective,))
    settled = eq.balance(RUBBING, plan)
    assert notes_by(_of_friction, settled.notes, "outputs", "tolerance")
    monkeypatch.setattr(solution, "ROUNDS", 0)
    first = eq.balance(RUBBING, plan)
    (note,) = notes_by(_of_friction, first.notes, "outputs", "change")
    change = note.values["change"]
    assert change > 1e-4
    # the bound is the optimum with the friction of the machine before
    assert change == pytest.approx(abs(first.cost - first.bound), rel=0.06)


def test_a_limit_alone_may_depend_on_friction() -> None:
    """So that the cost is the same with any friction, from which nothing is to be concluded."""
    limited = Objective("joints.A", "peak")
    plan = Balance(
        moves=(CRANK,),
        objectives=(Objective("shaking_force"),),
        limits=(Limit(limited, ratio=0.93),),
    )
    balanced = eq.balance(RUBBING, plan)
    most = 0.93 * Problem.value_of(RUBBING, limited)
    assert Problem.value_of(balanced.machine, limited) <= most * (1 + 1e-7)
    assert notes_by(_of_friction, balanced.notes, "tolerance", outputs="joints.A")


def test_phases_are_proved_with_the_friction_of_the_result() -> None:
    """And not of the machine before, with which the cost was 0.2 % off and the gap 0."""
    rows = replace(RUBBING, rows=(Row(0.0, 0.0), Row(np.pi / 2, 0.05)))
    plan = Balance(moves=(ROD,), phases=Phases(np.pi / 12), objectives=(Objective("drive_torque"),))
    balanced = eq.balance(rows, plan)
    assert balanced.phasing is not None
    assert balanced.phasing.combined[1] == pytest.approx(balanced.cost, rel=1e-6)
    assert 0 < balanced.gap < 2e-3
    assert notes_by(_of_friction, balanced.notes, "outputs", "tolerance")
