"""Outputs of all rows: against sums of signals in time, and against changed machines.

Phases of rows as part of a plan."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing import balanced as outcome
from equipoise.balancing.box_bounds import CLOSE
from equipoise.balancing.cylinder_phasing import PhasedRows
from equipoise.balancing.effects import Effects
from equipoise.balancing.objectives import of_all_rows
from equipoise.balancing.phase_search import choose_phases
from equipoise.balancing.problem import Problem
from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.parts.balance import AddedMass, Balance, Limit, Objective, Phases, Weight
from equipoise.mechanism.parts.support import Row
from equipoise.signals import Periodic
from support.refusals import refused
from support.sentences import notes_by

Array = np.ndarray[Any, Any]

ROWS = (
    Row(0.3, -0.2, (0.01, 0.02)),
    Row(2.0, 0.1, (0.0, 0.0)),
    Row(4.5, 0.35, (-0.03, 0.04)),
)
MACHINE = replace(eq.load("yamashita-1"), rows=ROWS)
COUNTER = AddedMass("crank", "A", Weight("any", 0.06, at_most=0.5))
OUTPUTS = ("shaking_force.x", "shaking_force.y", "shaking_moment", "frame_force.y", "frame_moment",
           "drive_torque", "roll_moment", "yaw_moment")  # fmt: skip
EXACT = 1e-9


def in_time(machine: eq.Machine, output: str, about: complex) -> Array:
    """The sum over rows at 720 angles, each row moved to its place and ahead by its phase."""
    total: Array = np.zeros(720)
    for row in machine.rows:
        angles = np.arange(720) * np.pi / 360 + row.phase
        forces = eq.forces(eq.move(machine, angles), about - complex(*row.offset))
        signals = {
            "shaking_force.x": forces.shaking_force.x,
            "shaking_force.y": forces.shaking_force.y,
            "shaking_moment": forces.shaking_moment,
            "frame_force.y": forces.frame_force.y,
            "frame_moment": forces.frame_moment,
            "drive_torque": forces.drive_torque,
            "roll_moment": -row.lateral * forces.shaking_force.y,
            "yaw_moment": row.lateral * forces.shaking_force.x,
        }
        total = total + signals[output]
    return total


@pytest.mark.parametrize("output", OUTPUTS)
def test_sum_in_time(output: str) -> None:
    signal = of_all_rows(Effects(MACHINE, ()), output)
    wanted = in_time(MACHINE, output, 0j)
    np.testing.assert_allclose(signal.start, wanted, rtol=0, atol=EXACT * np.max(np.abs(wanted)))


def test_about_another_point() -> None:
    signal = of_all_rows(Effects(MACHINE, ()), "shaking_moment", "D")
    wanted = in_time(MACHINE, "shaking_moment", complex(*MACHINE.frame["D"]))
    np.testing.assert_allclose(signal.start, wanted, rtol=0, atol=EXACT * np.max(np.abs(wanted)))


@pytest.mark.parametrize("output", OUTPUTS)
def test_columns_are_those_of_changed_machines(output: str) -> None:
    plan = Balance(masses=(COUNTER,), objectives=(Objective("shaking_force.x"),))
    problem = Problem.of(MACHINE, plan)
    numbers = np.array([0.7, 0.3, -0.2, 0.5])
    changed = problem.machine_with([numbers])
    signal = of_all_rows(problem.effects, output)
    wanted = in_time(changed, output, 0j)
    atol = EXACT * np.max(np.abs(wanted))
    np.testing.assert_allclose(signal.at(numbers), wanted, rtol=0, atol=atol)


def test_a_counterweight_against_rows_that_cancel_already() -> None:
    """Two rows opposed leave no first order, and a counterweight has nothing to do."""
    rows = (Row(0.0), Row(np.pi))
    machine = replace(eq.load("yamashita-1"), rows=rows)
    plan = Balance(masses=(COUNTER,), objectives=(Objective("shaking_force"),))
    with refused(eq.EquipoiseError, name="rms of shaking_force"):
        eq.balance(machine, plan)


def test_roll_is_balanced_by_what_is_free() -> None:
    balanced = eq.balance(
        MACHINE, Balance(masses=(COUNTER,), objectives=(Objective("roll_moment"),))
    )
    before, after = balanced.objectives["rms of roll_moment"]
    assert before == pytest.approx(np.sqrt(np.mean(in_time(MACHINE, "roll_moment", 0j) ** 2)))
    assert after == pytest.approx(
        np.sqrt(np.mean(in_time(balanced.machine, "roll_moment", 0j) ** 2))
    )
    assert after < 0.7 * before
    assert notes_by(outcome._notes, balanced.notes, "rows")


TRANSPLANTER = eq.load("four-row-transplanter")
LIFT = Objective("shaking_force.y")
CRANK = AddedMass("crank", "A", Weight("point", 0.05, at_most=1.0))
COARSE = Phases(step=np.pi / 6)


def rows_value(machine: eq.Machine) -> float:
    """RMS of the vertical force of all rows, turned and added."""
    angles = np.arange(720) * np.pi / 360
    total = sum(
        eq.forces(eq.move(machine, angles + row.phase, acceleration=0.0)).shaking_force.y
        for row in machine.rows
    )
    return float(np.sqrt(np.mean(total**2)))


def test_phases_alone() -> None:
    balanced = eq.balance(TRANSPLANTER, Balance(phases=COARSE, objectives=(LIFT,)))
    phasing = choose_phases(TRANSPLANTER, (LIFT,), COARSE)
    before, after = balanced.objectives[LIFT.name]
    assert before == pytest.approx(rows_value(TRANSPLANTER))
    assert after == pytest.approx(rows_value(balanced.machine), rel=1e-6)
    assert balanced.phasing is not None
    assert balanced.phasing.phases == phasing.phases
    (change,) = balanced.changes
    assert (change.kind, change.link) == ("phases", "rows")
    assert change.values["phases"] == tuple(row.phase for row in balanced.machine.rows)
    assert balanced.cost == pytest.approx(after / before)
    assert balanced.bound == phasing.bound
    assert 0 <= balanced.gap <= CLOSE
    assert balanced.proved
    assert str(balanced.method) == "branch and bound over all phases of the rows"
    assert balanced.machine.links == TRANSPLANTER.links
    content = json.loads(json.dumps(balanced.to_dict(), default=np.ndarray.tolist))
    assert content["rows"]["phases"] == list(phasing.phases)


def test_linkage_and_phases_together() -> None:
    """The cost counts from the machine as it was, not from the balanced linkage."""
    plan = Balance(masses=(CRANK,), phases=COARSE, objectives=(LIFT,))
    balanced = eq.balance(TRANSPLANTER, plan)
    linkage = eq.balance(TRANSPLANTER, replace(plan, phases=None))
    before, after = balanced.objectives[LIFT.name]
    assert before == pytest.approx(rows_value(TRANSPLANTER))
    assert after == pytest.approx(rows_value(balanced.machine), rel=1e-6)
    assert balanced.cost == pytest.approx(after / before)
    assert [change.kind for change in balanced.changes] == ["added mass", "phases"]
    after_it = choose_phases(linkage.machine, (LIFT,), COARSE).after[LIFT.name]
    assert after <= after_it * (1 + 1e-9)
    assert set(balanced.prices) == set(linkage.prices)
    assert balanced.gap <= 1e-3 * (1 + 1e-6)
    assert "all phases of the rows and all masses" in str(balanced.method)


def test_two_objectives_as_squares() -> None:
    both = (LIFT, Objective("shaking_force.x", weight=0.5))
    balanced = eq.balance(
        TRANSPLANTER,
        Balance(masses=(CRANK,), phases=COARSE, objectives=both, combine="squares"),
    )
    shares = [after / before for before, after in balanced.objectives.values()]
    assert balanced.cost == pytest.approx(np.sqrt(shares[0] ** 2 + 0.5 * shares[1] ** 2))


def test_roll_counts_for_the_linkage_too() -> None:
    both = (LIFT, Objective("roll_moment"))
    balanced = eq.balance(TRANSPLANTER, Balance(masses=(CRANK,), phases=COARSE, objectives=both))
    alone = choose_phases(TRANSPLANTER, both, COARSE)
    assert set(balanced.objectives) == {item.name for item in both}
    assert balanced.objectives["rms of roll_moment"][0] == 0.0
    assert balanced.cost <= alone.combined[1] * (1 + 1e-9)
    assert balanced.bound <= balanced.cost


@pytest.mark.parametrize(
    ("limit", "expected"),
    [
        (Limit(LIFT, at_most=1.0), {"name": "rms of shaking_force.y"}),
        (
            Limit(Objective("roll_moment"), ratio=0.5),
            {"name": "rms of roll_moment"},
        ),
        (
            Limit(Objective("joints.A"), ratio=1.0),
            {"by": "balance_rows"},
        ),
    ],
)
def test_what_is_refused(limit: Limit, expected: dict[str, Any]) -> None:
    plan = Balance(phases=COARSE, objectives=(LIFT,), limits=(limit,))
    with refused(UsageError, **expected):
        eq.balance(TRANSPLANTER, plan)


def test_torque_of_each_of_several_drives() -> None:
    rows = (Row(0.0, 0.0), Row(np.pi / 2, 0.0))
    machine = replace(eq.load("pick-and-place"), rows=rows)
    result = PhasedRows(machine).signals(Objective("drives.right crank.torque"))
    own = eq.analyze(machine, 720).forces.drives["right crank"]
    first, second = (row[0, 1:4] for row in result.amplitudes[0])
    np.testing.assert_allclose(second, first, rtol=1e-12)  # phases come with the plan
    np.testing.assert_allclose(abs(first), abs(Periodic.of(own, 1).amplitudes[1:4]), rtol=1e-4)


@pytest.mark.parametrize("output", ["bearings.front", "joints.B1"])
def test_forces_within_a_row_have_no_phase(output: str) -> None:
    rows = PhasedRows(replace(eq.load("twin-engine"), rows=ROWS))
    with refused(UsageError, output=output):
        rows.signals(Objective(output))


def test_what_another_kind_of_drive_exerts_is_no_output() -> None:
    with refused(ModelError, "objective.output", kind="output", given="drive_torque"):
        PhasedRows(eq.load("hydraulic-loader")).signals(Objective("drive_torque"))
