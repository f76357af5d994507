"""Phases of rows as part of a plan."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.phase_search import choose_phases
from equipoise.errors import UsageError
from equipoise.mechanism.balance import AddedMass, Balance, Limit, Objective, Phases, Weight

MACHINE = eq.load("four-row-transplanter")
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
    found = eq.balance(MACHINE, Balance(phases=COARSE, objectives=(LIFT,)))
    phasing = choose_phases(MACHINE, (LIFT,), COARSE)
    before, after = found.objectives[LIFT.name]
    assert before == pytest.approx(rows_value(MACHINE))
    assert after == pytest.approx(rows_value(found.machine), rel=1e-6)
    assert found.phasing is not None
    assert found.phasing.phases == phasing.phases
    (change,) = found.changes
    assert (change.kind, change.link) == ("phases", "rows")
    assert change.values["phases"] == tuple(row.phase for row in found.machine.rows)
    assert found.cost == pytest.approx(after / before)
    assert (found.bound, found.gap) == (None, None)
    assert "arrangements of the rows" in found.method
    assert found.machine.links == MACHINE.links
    told = json.loads(json.dumps(found.to_dict(), default=np.ndarray.tolist))
    assert told["rows"]["phases"] == list(phasing.phases)


def test_linkage_first_and_phases_after_it() -> None:
    """The cost counts from the machine as it was, not from the balanced linkage."""
    plan = Balance(masses=(CRANK,), phases=COARSE, objectives=(LIFT,))
    found = eq.balance(MACHINE, plan)
    linkage = eq.balance(MACHINE, replace(plan, phases=None))
    before, after = found.objectives[LIFT.name]
    assert before == pytest.approx(rows_value(MACHINE))
    assert after == pytest.approx(rows_value(found.machine), rel=1e-6)
    assert found.cost == pytest.approx(after / before)
    assert [change.kind for change in found.changes] == ["added mass", "phases"]
    assert found.machine.links == linkage.machine.links
    assert found.prices == linkage.prices
    assert found.notes[0].startswith("the linkage was balanced first")
    assert found.added_mass == pytest.approx(linkage.added_mass)


def test_two_objectives_as_squares() -> None:
    both = (LIFT, Objective("shaking_force.x", weight=0.5))
    found = eq.balance(
        MACHINE, Balance(masses=(CRANK,), phases=COARSE, objectives=both, combine="squares")
    )
    shares = [after / before for before, after in found.objectives.values()]
    assert found.cost == pytest.approx(np.hypot(shares[0], 0.5 * shares[1]))


def test_roll_counts_for_the_linkage_too() -> None:
    both = (LIFT, Objective("roll_moment"))
    found = eq.balance(MACHINE, Balance(masses=(CRANK,), phases=COARSE, objectives=both))
    alone = eq.balance(MACHINE, Balance(masses=(CRANK,), objectives=both))
    assert set(found.objectives) == {one.name for one in both}
    assert found.machine.links == alone.machine.links


def test_what_is_refused() -> None:
    limit = Limit(Objective("shaking_force.x"), ratio=1.0)
    plan = Balance(phases=COARSE, objectives=(LIFT,), limits=(limit,))
    with pytest.raises(UsageError, match="limits are not kept while phases are looked for"):
        eq.balance(MACHINE, plan)
