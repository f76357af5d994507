"""Balancing from beginning to end, one stage a line.

Plan -> shafts -> free numbers -> cone program -> best numbers -> new machine -> what it does.

Gears are searched around the program (`geared`).  Where phases of rows are free, they and the
masses are searched together, after the gears.
"""

from __future__ import annotations

from dataclasses import replace

from equipoise.balancing.balanced import Balanced, bending_notes, result_of
from equipoise.balancing.geared import GearSearch, WithShafts, with_shafts
from equipoise.balancing.phase_search import PhaseSearch, Phasing, choose_phases
from equipoise.balancing.problem import Problem
from equipoise.balancing.rows_and_masses import JointPhaseMassOptimizer
from equipoise.balancing.solution import Solution
from equipoise.balancing.workshop import Change
from equipoise.errors import MassError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.balance import (
    WITHIN,
    AddedMass,
    Balance,
    BalanceShafts,
    CenterMove,
    GearedWeight,
    Limit,
    Objective,
    Phases,
    SpringChoice,
    Weight,
)
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.result import ProgressCallback
from equipoise.vibration.forced import check_moving


def balance(
    machine: Machine, plan: Balance | None = None, progress: ProgressCallback | None = None
) -> Balanced:
    """Find what to change so that a machine shakes least.

    Parameters
    ----------
    plan : what may be changed and what is to become small; that of the machine if None.
    progress : is called with how many steps of a part of the work are done, and how many that
        part has at most: programs of a scan or a branch and bound, arrangements of rows, steps of
        refining the best of them, boxes of the proof.

    Returns
    -------
    Balanced, with the new machine, every change, and a proved lower bound.

    Raises
    ------
    UsageError : nothing is free, nothing is asked, limits clash, gears do not mesh.
    MassError : a link has no mass given.
    """
    plan = _checked(machine, machine.balance if plan is None else plan)
    machine = machine.with_balance(None)  # whose names the new links may take
    if plan.phases is not None:
        return balance_rows(machine, plan, progress)
    return result_of(machine, plan, solve_plan(machine, plan, progress))


def _checked(machine: Machine, plan: Balance | None) -> Balance:
    """The plan, refused where there is nothing to do; its values are checked with the machine."""
    if missing := massless(machine):
        raise MassError(missing)
    if plan is None or plan.changes_nothing:
        raise UsageError(
            Note(
                "no change is permitted; give tables such as [[balance.masses]] or "
                "[[balance.moves]], or options such as --crank-counterweight or --move-cm LINK"
            )
        )
    if not plan.objectives:
        raise UsageError(
            Note(
                "there is no objective; give [[balance.objectives]], or an option such as "
                '--objective "shaking_force.y"'
            )
        )
    check_moving(machine)
    machine.with_balance(plan)  # checks that what it names is there
    return plan


def solve_plan(
    machine: Machine, plan: Balance, progress: ProgressCallback | None = None
) -> Solution:
    """The best of all choices of gears, with the best numbers for these."""
    start = WithShafts(machine, plan, machine)
    for shafts in plan.shafts:
        base, added_weights = with_shafts(start.base, shafts)
        start = replace(start, base=base, weights=(*start.weights, *added_weights))
    if not plan.geared:
        return start.solved(progress)
    return GearSearch(start, progress).run()


def balance_rows(
    machine: Machine, plan: Balance, progress: ProgressCallback | None = None
) -> Balanced:
    """Choose the phases of a machine's rows; together with masses where the plan frees these."""
    assert plan.phases is not None
    text = progress or (lambda done, most: None)
    linkage, solution = replace(plan, phases=None), None
    scope: tuple[Note, ...] = ()
    limits = tuple(limit for limit in plan.limits if not limit.objective.output.startswith(WITHIN))
    search = PhaseSearch(machine, plan.objectives, plan.phases, plan.combine, limits)
    method = Note("branch and bound over all phases of the rows")
    if linkage.changes_nothing:
        if len(limits) < len(plan.limits):
            raise UsageError(Note("no phase changes a force inside of a row; leave its limit out"))
        phasing = choose_phases(
            machine, plan.objectives, plan.phases, plan.combine, progress, limits
        )
    else:
        try:
            first = solve_plan(machine, linkage, progress)
        except UsageError:  # in these phases, and perhaps in no others
            if plan.shafts or plan.geared:
                raise
            first = None
        problem = Problem.of(machine, linkage) if first is None else first.problem
        joint_phase_mass_optimizer = JointPhaseMassOptimizer(problem, search)
        solution, phasing = joint_phase_mass_optimizer.run(first, text)
        method = Note("branch and bound over all phases of the rows and all masses")
        scope = joint_phase_mass_optimizer.scope
    balanced = in_phases(machine, plan, phasing, method, scope)
    if solution is None:
        return balanced
    changed = result_of(machine, plan, solution)
    after = replace(search, machine=changed.machine)
    return replace(
        changed,
        changes=(*changed.changes, *balanced.changes),
        objectives={
            term.objective.name: (term.value_at(search.present), after.value_of(term.objective))
            for term in search.cost.terms
        },
        bound=min(phasing.bound, changed.cost),
        method=method,
        looked_at=phasing.looked_at,
        notes=(*changed.notes, *phasing.notes),
        phasing=phasing,
        scope=scope,
    )


def in_phases(
    machine: Machine, plan: Balance, phasing: Phasing, method: Note, scope: tuple[Note, ...]
) -> Balanced:
    """The result where nothing but phases has changed."""
    return Balanced(
        machine=phasing.machine,
        original=machine,
        plan=plan,
        changes=(Change("phases", "rows", {"phases": phasing.phases}),),
        objectives={name: (phasing.before[name], after) for name, after in phasing.after.items()},
        cost=phasing.combined[1],
        bound=min(phasing.bound, phasing.combined[1]),
        method=method,
        prices={},
        looked_at=phasing.looked_at,
        notes=(*bending_notes(machine), *phasing.notes),
        phasing=phasing,
        scope=scope,
    )


__all__ = [
    "AddedMass",
    "Balance",
    "BalanceShafts",
    "CenterMove",
    "GearedWeight",
    "Limit",
    "Objective",
    "Phases",
    "SpringChoice",
    "Weight",
]
