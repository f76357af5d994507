"""Balancing from beginning to end, one stage a line.

Plan -> shafts -> free numbers -> cone program -> best numbers -> new machine -> what it does.

Of gears, numbers of teeth are tried one and all; of ratios and directions a grid, whose best are
followed as far down as they go.  Where phases of rows are free, they and the masses are searched
together, after the gears.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from equipoise.balancing.balanced import Balanced, result_of
from equipoise.balancing.geared import Gearing, Mesh, with_shafts
from equipoise.balancing.phase_search import PhaseSearch
from equipoise.balancing.phasing import Phasing, choose_phases
from equipoise.balancing.problem import Problem
from equipoise.balancing.rows_and_masses import Together
from equipoise.balancing.solution import Solution, solve_problem
from equipoise.balancing.weights import AddedWeight
from equipoise.balancing.workshop import Change
from equipoise.errors import MassError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.balance import Balance
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.objectives import WITHIN
from equipoise.signals import Array
from equipoise.vibration.forced import check_moving

Progress = Callable[[int, int], None]


def balance(
    machine: Machine, plan: Balance | None = None, progress: Progress | None = None
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
                "nothing is free to change; give tables such as [[balance.masses]] or "
                "[[balance.moves]], or options such as --crank-counterweight or --move-cm "
                "LINK"
            )
        )
    if not plan.objectives:
        raise UsageError(
            Note(
                "nothing is to become small; give [[balance.objectives]], or an option "
                'such as --objective "shaking_force.y"'
            )
        )
    check_moving(machine)
    machine.with_balance(plan)  # checks that what it names is there
    return plan


LARGE = 1e300
"""A cost that every solution is below, while none is known."""
CLOSER, NEARER = 1e-10, 1e-6
"""Of the cost, and of a ratio or direction, to which the best ones of a range are followed."""
TIE, MOST_TIES, LIGHT_TIES = 5e-9, 24, 8
"""Difference in cost that is none; choices, all over the range, among which the lightest is looked
for; and those beside them that looked lightest at first.
"""
BEST_CHOICES, STEPS, MOST_STEPS = 3, 40, 80
"""Choices that are followed; first steps over a range; programs that are solved for each."""


@dataclass(frozen=True, eq=False)
class _WithShafts:
    """A machine with shafts that its plan adds: the weights on them, and their gears."""

    machine: Machine
    plan: Balance
    base: Machine
    weights: tuple[AddedWeight, ...] = ()
    gears: tuple[Change, ...] = ()

    def with_gears(self, gearing: Gearing, mesh: Mesh) -> _WithShafts:
        base, weight = gearing.added(mesh)
        gears = (*self.gears, gearing.change(mesh))
        return replace(self, base=base, weights=(*self.weights, weight), gears=gears)

    def solved(self, progress: Progress | None = None, above: float = inf) -> Solution:
        problem = Problem.of(self.machine, self.plan, self.base, self.weights)
        return replace(solve_problem(problem, progress, above), meshes=self.gears)


def solve_plan(machine: Machine, plan: Balance, progress: Progress | None = None) -> Solution:
    """The best of all choices of gears, of which only the last shaft may have several."""
    found = _WithShafts(machine, plan, machine)
    for shafts in plan.shafts:
        base, more = with_shafts(found.base, shafts)
        found = replace(found, base=base, weights=(*found.weights, *more))
    for geared in plan.geared:
        gearing = Gearing(found.base, geared)
        meshes = gearing.meshes()
        if len(meshes) == 1:
            found = found.with_gears(gearing, meshes[0])
        elif geared is plan.geared[-1]:
            return _scan(found, gearing, meshes, progress)
        else:
            raise UsageError(
                Note(
                    "only the last of [[balance.geared]] may have several ratios; give the "
                    "others one ratio each"
                )
            )
    return found.solved(progress)


def _scan(
    start: _WithShafts, gearing: Gearing, meshes: list[Mesh], progress: Progress | None
) -> Solution:
    """Solve for every choice of gears; over a range of ratios, follow the best to their tops."""
    found: list[tuple[Mesh, Solution]] = []
    problems: list[UsageError] = []
    most = len(meshes) + (BEST_CHOICES * MOST_STEPS if gearing.ranges else 0)

    def at(mesh: Mesh) -> float:
        least = min((one.best.value for _, one in found), default=LARGE)
        try:
            one = start.with_gears(gearing, mesh).solved(None, least)
        except UsageError as error:
            problems.append(error)
            return inf
        found.append((mesh, one))
        if progress is not None:
            progress(min(len(found), most), most)
        return one.best.value

    values = [at(mesh) for mesh in meshes]
    if not found:
        raise problems[0]
    for k in np.argsort(values)[:BEST_CHOICES]:
        if gearing.ranges and np.isfinite(values[k]):
            _follow(gearing, meshes[k], at)
    least = min(one.best.value for _, one in found)
    ties = {
        mesh: one.problem.mass_added(one.numbers)
        for mesh, one in found
        if one.best.value <= least + TIE
    }
    equal = sorted(ties, key=lambda mesh: (mesh.ratio, mesh.direction))
    light = sorted(equal, key=ties.__getitem__)[:LIGHT_TIES]
    tried = dict.fromkeys([*equal[:: max(1, len(equal) // MOST_TIES)], *light])
    lightest = min(
        (start.with_gears(gearing, mesh).solved() for mesh in tried),
        key=lambda one: one.problem.mass_added(one.numbers),
    )
    count = sum(one.best.nodes for _, one in found)
    method = Note(
        "{method}, for each of {count} choices of gears", method=lightest.method, count=len(found)
    )
    best = replace(lightest.best, nodes=count)
    return replace(lightest, method=method, best=best, ties=len(equal), weighed=len(tried))


def _follow(gearing: Gearing, start: Mesh, cost: Callable[[Mesh], float]) -> None:
    """Go down from a choice of gears, along all that may be any number between two."""
    from scipy.optimize import minimize

    first = {"ratio": start.ratio, "direction": start.direction}
    ranges = gearing.ranges

    def at(numbers: Array) -> float:
        here = {name: float(x) for name, x in zip(ranges, numbers, strict=True)}
        mesh = gearing.near(start, here)
        return cost(mesh) if gearing.is_clear(mesh) else inf

    begin = np.array([first[name] for name in ranges])
    steps = [(high - low) / STEPS for low, high in ranges.values()]
    simplex = np.vstack([begin, *(begin + step for step in np.diag(steps))])
    limits = np.array(list(ranges.values()))
    over = simplex > limits[:, 1]
    simplex[over] = (2 * begin - simplex)[over]
    options = {"initial_simplex": simplex, "xatol": NEARER, "fatol": CLOSER, "maxfev": MOST_STEPS}
    minimize(at, begin, method="Nelder-Mead", bounds=limits, options=options)


def balance_rows(machine: Machine, plan: Balance, progress: Progress | None = None) -> Balanced:
    """Choose the phases of a machine's rows; together with masses where the plan frees these."""
    assert plan.phases is not None
    told = progress or (lambda done, most: None)
    linkage, solution = replace(plan, phases=None), None
    scope: tuple[Note, ...] = ()
    limits = tuple(one for one in plan.limits if not one.objective.output.startswith(WITHIN))
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
        together = Together(problem, search)
        solution, phasing = together.run(first, told)
        method = Note("branch and bound over all phases of the rows and all masses")
        scope = together.scope
    found = in_phases(machine, plan, phasing, method, scope)
    if solution is None:
        return found
    changed = result_of(machine, plan, solution)
    after = replace(search, machine=changed.machine)
    return replace(
        changed,
        changes=(*changed.changes, *found.changes),
        objectives={
            one.objective.name: (one.value_at(search.present), after.value_of(one.objective))
            for one in search.cost.terms
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
        notes=phasing.notes,
        phasing=phasing,
        scope=scope,
    )
