"""Phases of rows and masses at once: against each alone, whole grids, and machines tried at random.

The second routes turn rows, change masses and add signals in time; nothing of them knows of
readings, boxes or orders.
"""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing import choose_phases
from equipoise.balancing.rows_and_masses import CLOSE
from equipoise.mechanism.parts.balance import (
    AddedMass,
    Balance,
    CenterMove,
    GearedWeight,
    Limit,
    Objective,
    Phases,
    Weight,
)
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from support.chosen import EXHAUSTIVE, few
from support.refusals import refused
from support.rows_in_time import in_time, side_by_side

TYPE_II = eq.load("yamashita-2")
RIDING = eq.load("riding-transplanter").with_balance(None)
LIFT = Objective("shaking_force.y")
POINT = AddedMass("crank", "A", Weight("point", 0.05, at_most=1.0))
COUPLER = CenterMove("coupler", x=(-0.05, -0.03), y=(-0.03, -0.01))
PHASES = Phases()


def rms(machine: Machine, output: str = "shaking_force.y") -> float:
    return float(np.sqrt(np.mean(np.abs(in_time(machine, output)) ** 2)))


def test_values_are_those_of_the_machine_that_comes_back() -> None:
    balanced = eq.balance(
        side_by_side(TYPE_II, (0.0, 0.4, 1.6)),
        Balance(masses=(POINT,), phases=PHASES, objectives=(LIFT,)),
    )
    before, after = balanced.objectives[LIFT.name]
    assert before == pytest.approx(rms(balanced.original), rel=1e-9)
    assert after == pytest.approx(rms(balanced.machine), rel=1e-7)
    assert balanced.cost == pytest.approx(after / before, rel=1e-9)
    assert [change.kind for change in balanced.changes] == ["added mass", "phases"]
    assert balanced.phasing is not None
    assert balanced.phasing.phases == tuple(row.phase for row in balanced.machine.rows)
    assert 0 <= balanced.gap <= CLOSE * (1 + 1e-6)


def test_together_where_one_after_the_other_is_worse() -> None:
    """Rows that are opposed leave a counterweight no first order to balance, so that either comes
    too early for the other; phases that look worse alone are the best with it.
    """
    machine = side_by_side(TYPE_II, (0.0, pi))
    plan = Balance(masses=(POINT,), objectives=(LIFT,))
    with refused(eq.EquipoiseError, name="rms of shaking_force.y"):
        eq.balance(machine, plan)
    alone = choose_phases(machine, [LIFT])
    balanced = eq.balance(machine, replace(plan, phases=PHASES))
    before, after = balanced.objectives[LIFT.name]
    assert after < 0.6 * alone.after[LIFT.name]
    assert after == pytest.approx(rms(balanced.machine), rel=1e-7)
    assert balanced.bound <= after / before <= balanced.bound + CLOSE * (1 + 1e-6)


# Rows with masses: `test_values_are_those_of_the_machine_that_comes_back`.
@pytest.mark.exhaustive
def test_riding_transplanter() -> None:
    """Its rows are in phases in which no mass on the crank does anything to the vertical force."""
    balanced = eq.balance(RIDING, Balance(masses=(POINT,), phases=PHASES, objectives=(LIFT,)))
    alone = choose_phases(RIDING, [LIFT])
    assert balanced.objectives[LIFT.name][1] < 0.5 * alone.after[LIFT.name]
    assert balanced.gap <= CLOSE * (1 + 1e-6)


# Together they are better than one after the other: the test above.
@pytest.mark.exhaustive
def test_no_phases_on_a_grid_with_their_best_masses_are_better() -> None:
    """Masses by a cone program for every phase of two rows at 10 deg."""
    wishes = (LIFT, Objective("shaking_force.x", weight=0.5))
    plan = Balance(masses=(POINT,), objectives=wishes, combine="squares")
    machine = side_by_side(TYPE_II, (0.0, 0.4))
    balanced = eq.balance(machine, replace(plan, phases=PHASES))
    old = [balanced.objectives[wish.name][0] for wish in wishes]
    for phase in np.radians(np.arange(0, 360, 10)):
        turned = machine.with_rows([machine.rows[0], replace(machine.rows[1], phase=phase)])
        try:
            first = eq.balance(turned, plan).machine
        except eq.EquipoiseError:  # where masses do nothing
            first = turned
        shares = np.array([rms(first, w.output) for w in wishes]) / old * [1.0, np.sqrt(0.5)]
        assert np.linalg.norm(shares) >= balanced.cost - CLOSE
        assert np.linalg.norm(shares) >= balanced.bound - 1e-9


CASES: dict[str, Balance] = {
    "weight": Balance(masses=(POINT,), objectives=(LIFT,)),
    "two moments": Balance(
        moves=(COUPLER,), objectives=(Objective("shaking_force"), Objective("shaking_moment"))
    ),
    "peak": Balance(moves=(COUPLER,), objectives=(Objective("shaking_force.y", "peak"),)),
}


# Values and bounds of boxes: tests/laws/test_jumping_rows.py.
@pytest.mark.exhaustive
@pytest.mark.parametrize("case", few(CASES, {"weight"}))
def test_no_machine_tried_at_random_is_below_the_bound(case: str) -> None:
    plan = CASES[case]
    machine = side_by_side(TYPE_II, (0.0, 0.4, 1.6))
    balanced = eq.balance(machine, replace(plan, phases=PHASES))
    assert balanced.bound <= balanced.cost < balanced.whole
    rng = np.random.default_rng(7)
    for share in rng.uniform(0, 1, 20):
        near = [row.phase for row in balanced.machine.rows] + share * rng.normal(size=3)
        link = "coupler" if plan.moves else "crank"
        body = TYPE_II.links[link]
        assert body.mass is not None and body.center_of_mass is not None
        if plan.moves:
            center = rng.uniform((-0.05, -0.03), (-0.03, -0.01))
            changed = machine.with_link(link, center_of_mass=tuple(center))
        else:
            mass, place = rng.uniform(0, 1.0), 0.05 * np.sqrt(rng.random())
            angle = rng.uniform(0, 2 * pi)
            added = mass * place * np.exp(1j * angle)
            first = body.mass * complex(*body.center_of_mass) + added
            center = first / (body.mass + mass)
            changed = machine.with_link(
                link,
                mass=body.mass + mass,
                center_of_mass=(center.real, center.imag),
            )
        turned = side_by_side(changed, near)
        value = 0.0
        for objective in plan.objectives:
            signal = in_time(turned, objective.output)
            size = (
                np.max(np.abs(signal))
                if objective.measure == "peak"
                else rms(turned, objective.output)
            )
            value += size / balanced.objectives[objective.name][0]
        assert value >= balanced.bound - 1e-6


def test_a_force_that_can_vanish() -> None:
    """The coupler's centre for a pure sine, (80), and opposed rows: nothing is left."""
    plan = Balance(
        moves=(CenterMove("coupler", x=(-0.08, 0.08), y=(-0.05, 0.05)),),
        phases=PHASES,
        objectives=(Objective("shaking_force"),),
    )
    balanced = eq.balance(side_by_side(TYPE_II, (0.0, 0.4)), plan)
    assert balanced.cost == pytest.approx(0.0, abs=1e-9)
    assert balanced.bound == pytest.approx(0.0, abs=1e-9)
    (x, y) = balanced.changes[0].values["to"]
    assert (1e3 * x, 1e3 * y) == pytest.approx((-3.118, 0.0), abs=1e-3)
    assert balanced.machine.rows[1].phase == pytest.approx(pi, abs=1e-6)


@EXHAUSTIVE
def test_limits_are_kept_in_other_phases() -> None:
    """Of phases alone, and with masses, of which none could keep the limit in the phases before."""
    machine = side_by_side(TYPE_II, (0.0, 0.0, 0.0, 0.0))
    roll = Limit(Objective("roll_moment"), at_most=1.0)
    balanced = eq.balance(machine, Balance(phases=PHASES, objectives=(LIFT,), limits=(roll,)))
    assert rms(balanced.machine, "roll_moment") <= 1.0 * (1 + 1e-6)
    free = choose_phases(machine, [LIFT]).after[LIFT.name]
    assert free < rms(balanced.machine) < 0.5 * rms(machine)
    assert balanced.bound <= balanced.cost
    machine = side_by_side(TYPE_II, (0.0, 0.0))
    along = Limit(Objective("shaking_force.x"), ratio=0.2)
    plan = Balance(masses=(POINT,), objectives=(LIFT,), limits=(along,))
    both = eq.balance(machine, replace(plan, phases=PHASES))
    assert rms(both.machine, "shaking_force.x") <= 0.2 * rms(machine, "shaking_force.x") * (
        1 + 1e-6
    )
    price = both.prices[along.name]
    assert price.at_most == pytest.approx(0.2 * rms(machine, "shaking_force.x"), rel=1e-9)
    assert rms(both.machine) < 0.35 * rms(machine)
    assert 0 <= both.gap <= 5 * CLOSE  # the price is that of phases that are followed in turn
    without = eq.balance(machine, replace(plan, phases=PHASES, limits=()))
    assert without.cost <= both.cost


# Rows with masses: `test_values_are_those_of_the_machine_that_comes_back`.
@pytest.mark.exhaustive
def test_mass_that_does_nothing_is_not_added() -> None:
    """A disc that is too light to do better than phases alone do without it."""
    disc = AddedMass("crank", "A", Weight("disc", 0.06, thickness=0.012, density=7850.0))
    machine = side_by_side(TYPE_II, [0.0] * 4)
    balanced = eq.balance(machine, Balance(masses=(disc,), phases=PHASES, objectives=(LIFT,)))
    assert [change.kind for change in balanced.changes] == ["phases"]
    assert balanced.added_mass == 0.0
    assert balanced.cost == pytest.approx(choose_phases(machine, [LIFT]).combined[1], rel=1e-9)
    assert balanced.gap <= CLOSE * (1 + 1e-6)


@EXHAUSTIVE
def test_gauges_at_several_speeds() -> None:
    """Masses that only move, so that the support carries the same."""
    end = Objective("gauges.left_end", speeds=(20.0, 25.0))
    plan = Balance(moves=(COUPLER,), phases=PHASES, objectives=(end,))
    balanced = eq.balance(RIDING, plan)
    alone = choose_phases(RIDING, [end]).after[end.name]
    _, after = balanced.objectives[end.name]
    assert after <= alone * (1 + 1e-9)
    loudest = max(
        float(eq.respond(balanced.machine, speed).gauges["left_end"].displacement.vibration_rms)
        for speed in end.speeds
    )
    assert after == pytest.approx(loudest, rel=1e-6)
    assert balanced.bound <= balanced.cost


# The scope of rows: the other tests of this file.
@pytest.mark.exhaustive
def test_gears_are_reported_in_the_scope() -> None:
    weight = Weight("any", 0.04, at_most=0.3)
    plan = Balance(
        geared=(GearedWeight("crank", weight, ratio=(1.0, 1.0), axis=(0.1, 0.0)),),
        phases=PHASES,
        objectives=(LIFT,),
    )
    machine = TYPE_II.with_rows([Row(0.0, -0.15), Row(0.5, 0.15)])
    balanced = eq.balance(machine, plan)
    assert "for the gears taken" in " and ".join(map(str, balanced.scope))
    assert rms(balanced.machine) <= choose_phases(machine, [LIFT]).after[LIFT.name] * (1 + 1e-9)
