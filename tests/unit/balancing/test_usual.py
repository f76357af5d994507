"""What is balanced where nothing in particular is asked."""

from __future__ import annotations

import pytest

import equipoise as eq
from equipoise.balancing.optimisation import default_plan
from equipoise.cli.plan import Freed, plan_of
from equipoise.errors import MassError


def test_a_machine_is_balanced_as_its_file_says() -> None:
    machine = eq.load("balance-crank")
    assert default_plan(machine) is machine.balance


def test_else_by_a_counterweight_on_the_crank_as_the_command_has_it() -> None:
    machine = eq.load("yamashita-1")
    asked = plan_of(machine, Freed(crank_counterweight=True), ["rms shaking_force"], None)
    assert default_plan(machine) == asked
    found = eq.balance(machine, default_plan(machine))
    (change,) = found.changes
    assert (change.link, change.values["at"]) == ("crank", "A")
    ((before, after),) = found.objectives.values()
    assert after < 0.6 * before


def test_rows_are_balanced_by_their_phases() -> None:
    """A counterweight on each crank does nothing where opposite rows have cancelled order 1."""
    found = eq.balance(eq.load("riding-transplanter"), default_plan(eq.load("riding-transplanter")))
    assert [change.kind for change in found.changes] == ["phases"]
    ((before, after),) = found.objectives.values()
    assert after < 0.5 * before


def test_a_machine_without_masses_has_nothing_to_balance() -> None:
    with pytest.raises(MassError, match="crank"):
        default_plan(
            eq.load("yamashita-1").with_link("crank", mass=None, center_of_mass=None, inertia=None)
        )
