"""Phases of rows as part of a plan: the linkage is balanced first, its rows are turned after it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from equipoise.balancing.balanced import Balanced
from equipoise.balancing.optimisation import solve_plan
from equipoise.balancing.design_variables import Change
from equipoise.balancing.phase_search import PhaseSearch
from equipoise.balancing.phase_search import Phasing, choose_phases
from equipoise.balancing.balanced import result_of
from equipoise.errors import UsageError
from equipoise.mechanism.balance import Balance, Phases
from equipoise.mechanism.model import Machine

Progress = Callable[[int, int], None]

ORDER = (
    "the linkage was balanced first and its rows were turned after it; both together might do "
    "better"
)


def balance_rows(machine: Machine, plan: Balance, progress: Progress | None = None) -> Balanced:
    """Balance the linkage where the plan frees anything of it, then choose the phases of its rows.

    Nothing is proved of phases: they are looked for on a whole grid, and polished.
    """
    assert plan.phases is not None
    if plan.limits:
        raise UsageError("limits are not kept while phases are looked for; leave one of them out")
    linkage = replace(plan, phases=None)
    found: Balanced | None = None
    if not linkage.changes_nothing:
        found = result_of(machine, linkage, solve_plan(machine, linkage, progress))
    start = machine if found is None else found.machine
    phasing = choose_phases(start, plan.objectives, plan.phases, plan.combine, progress)
    return _joined(machine, plan, found, phasing)


def _joined(machine: Machine, plan: Balance, found: Balanced | None, phasing: Phasing) -> Balanced:
    """The result, with everything before read off the machine as it was."""
    search = PhaseSearch(machine, plan.objectives, plan.phases or Phases(), plan.combine)
    before = {term.objective.name: term.told(search.present) for term in search.cost.terms}
    change = Change("phases", "rows", {"phases": phasing.phases})
    earlier = () if found is None else found.changes
    notes = phasing.notes if found is None else (ORDER, *found.notes, *phasing.notes)
    after = phasing.after
    return Balanced(
        machine=phasing.machine,
        original=machine,
        plan=plan,
        changes=(*earlier, change),
        objectives={name: (before[name], after[name]) for name in after},
        cost=float(search.cost.of([after[name] for name in before])),
        bound=None,
        method=(
            f"{phasing.combinations} arrangements of the rows on a grid of "
            f"{np.degrees(phasing.step):.4g} deg, the best of them polished"
        ),
        prices={} if found is None else found.prices,
        looked_at=phasing.combinations,
        notes=notes,
        phasing=phasing,
    )
