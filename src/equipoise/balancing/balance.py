"""Balancing from beginning to end, one stage a line.

Plan -> shafts -> free numbers -> cone program -> best numbers -> new machine -> what it does.
"""

from __future__ import annotations

from collections.abc import Callable

from equipoise.balancing.balanced import Balanced
from equipoise.balancing.optimisation import solve_plan
from equipoise.balancing.optimisation import balance_rows
from equipoise.balancing.balanced import result_of
from equipoise.errors import MassError, UsageError
from equipoise.mechanism.balance import Balance
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine
from equipoise.structures.choice import check_moving

Progress = Callable[[int, int], None]


def balance(
    machine: Machine, plan: Balance | None = None, progress: Progress | None = None
) -> Balanced:
    """Find what to change so that a machine shakes least.

    Parameters
    ----------
    plan : what may be changed and what is to become small; that of the machine if None.
    progress : is called with how many programs of a scan are solved, and how many there are.

    Returns
    -------
    Balanced, with the new machine, every change, and a proved lower bound.

    Raises
    ------
    UsageError : nothing is free, nothing is asked, limits clash, gears do not mesh.
    MassError : a link has no mass given.
    """
    plan = machine.balance if plan is None else plan
    plan = _checked(machine, plan)
    machine = machine.with_balance(None)  # whose names the new links may take
    if plan.phases is not None:
        return balance_rows(machine, plan, progress)
    found = solve_plan(machine, plan, progress)
    return result_of(machine, plan, found)


def _checked(machine: Machine, plan: Balance | None) -> Balance:
    """The plan, refused where there is nothing to do; its values are checked with the machine."""
    if missing := massless(machine):
        raise MassError(missing)
    if plan is None or plan.changes_nothing:
        raise UsageError(
            "nothing is free to change; give tables such as [[balance.masses]] or "
            "[[balance.moves]], or options such as --crank-counterweight or --move-cm LINK"
        )
    if not plan.objectives:
        raise UsageError(
            "nothing is to become small; give [[balance.objectives]], or an option such as "
            '--objective "shaking_force.y"'
        )
    check_moving(machine)
    machine.with_balance(plan)  # checks that what it names is there
    return plan
