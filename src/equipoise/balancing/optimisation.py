"""Balancing from beginning to end, one stage a line.

Plan -> shafts -> free numbers -> cone program -> best numbers -> new machine -> what it does.

Of gears, numbers of teeth are tried one and all; of ratios and directions a grid, whose best are
followed as far down as they go.  Where phases of rows are free, the linkage is balanced first, and
its rows are turned after it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf

import numpy as np

from equipoise.balancing.balanced import Balanced, result_of
from equipoise.balancing.geared import Gearing, Mesh, with_shafts
from equipoise.balancing.phase_search import PhaseSearch, Phasing, choose_phases
from equipoise.balancing.problem import Problem
from equipoise.balancing.solution import Solution, solve_problem
from equipoise.balancing.weights import AddedWeight
from equipoise.balancing.workshop import Change
from equipoise.errors import MassError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.balance import AddedMass, Balance, Objective, Phases, Weight
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine
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


SMALLEST = 0.05
"""Room of a counterweight on a link that has no other point than its pin, m."""


def default_plan(machine: Machine) -> Balance:
    """The machine's own plan; else what makes the RMS of its whole shaking force small.

    That is a counterweight on the crank's axis, within the crank's reach; or, of rows side by side,
    their phases, which cost nothing.

    Raises
    ------
    MassError : a link has no mass given.
    """
    if missing := massless(machine):
        raise MassError(missing)
    own = machine.balance
    if own is not None and own.objectives and not own.changes_nothing:
        return own
    force = (Objective("shaking_force"),)
    if len(machine.rows) > 1:
        return Balance(phases=Phases(), objectives=force)
    crank = machine.drive.link
    weight = Weight(radius=reach_of(machine, crank))
    return Balance(masses=(AddedMass(crank, pin_of(machine, crank), weight),), objectives=force)


def pin_of(machine: Machine, link: str) -> str:
    """The link's point in the frame; its first point where it has none."""
    points = machine.links[link].points
    return next((name for name in points if name in machine.frame), next(iter(points)))


def reach_of(machine: Machine, link: str) -> float:
    """Distance of a link's farthest point from its pin, m."""
    points = machine.links[link].points
    center = complex(*points[pin_of(machine, link)])
    return max(abs(complex(*point) - center) for point in points.values()) or SMALLEST


LARGE = 1e300
"""A cost that every solution is below, while none is known."""
CLOSER, NEARER = 1e-10, 1e-6
"""Of the cost, and of a ratio or direction, to which the best ones of a range are followed."""
TIE, MOST_TIES = 5e-9, 24
"""Difference in cost that is none; choices among which the lightest is looked for."""
BEST_CHOICES, STEPS, MOST_STEPS = 3, 40, 80
"""Choices that are followed; first steps over a range; programs that are solved for each."""


def solve_plan(machine: Machine, plan: Balance, progress: Progress | None = None) -> Solution:
    """The best of all choices of gears."""
    base, weights = machine, list[AddedWeight]()
    for shafts in plan.shafts:
        base, more = with_shafts(base, shafts)
        weights += more
    return _with_gears(machine, plan, base, weights, progress)


def _with_gears(
    machine: Machine,
    plan: Balance,
    base: Machine,
    weights: list[AddedWeight],
    progress: Progress | None,
) -> Solution:
    """Add geared weights one by one; only one of them may have several choices of gears."""
    changes: list[Change] = []
    open_one: tuple[Gearing, list[Mesh]] | None = None
    for geared in plan.geared:
        gearing = Gearing(base, geared)
        meshes = gearing.meshes()
        if len(meshes) > 1:
            if geared is not plan.geared[-1]:
                raise UsageError(
                    "only the last of [[balance.geared]] may have several ratios; give the others "
                    "one ratio each"
                )
            open_one = (gearing, meshes)
        else:
            base, weight = gearing.added(meshes[0])
            weights.append(weight)
            changes.append(gearing.change(meshes[0]))
    if open_one is None:
        return _one(machine, plan, base, weights, changes, progress)
    return _scan(machine, plan, weights, changes, *open_one, progress)


def _one(
    machine: Machine,
    plan: Balance,
    base: Machine,
    weights: list[AddedWeight],
    changes: list[Change],
    progress: Progress | None = None,
    above: float = inf,
) -> Solution:
    problem = Problem.of(machine, plan, base, weights)
    return replace(solve_problem(problem, progress, above), meshes=tuple(changes))


def _scan(
    machine: Machine,
    plan: Balance,
    weights: list[AddedWeight],
    changes: list[Change],
    gearing: Gearing,
    meshes: list[Mesh],
    progress: Progress | None,
) -> Solution:
    """Solve for every choice of gears; over a range of ratios, follow the best to their tops."""
    found: list[tuple[Mesh, Solution]] = []
    problems: list[UsageError] = []
    least = LARGE

    def solved(mesh: Mesh, above: float) -> Solution:
        base, weight = gearing.added(mesh)
        told_of = [*changes, gearing.change(mesh)]
        return _one(machine, plan, base, [*weights, weight], told_of, None, above)

    def at(mesh: Mesh) -> float:
        nonlocal least
        try:
            one = solved(mesh, least)
        except UsageError as error:
            problems.append(error)
            return inf
        found.append((mesh, one))
        least = min(least, one.best.value)
        if progress is not None:
            progress(min(len(found), most), most)
        return one.best.value

    most = len(meshes) + (BEST_CHOICES * MOST_STEPS if gearing.ranges else 0)
    values = [at(mesh) for mesh in meshes]
    if not found:
        raise problems[0]
    for k in np.argsort(values)[:BEST_CHOICES]:
        if gearing.ranges and np.isfinite(values[k]):
            _follow(gearing, meshes[k], at)
    best = _lightest_choice(found, least, lambda mesh: solved(mesh, inf))
    count = sum(one.best.nodes for _, one in found)
    template = to_say("{method}, for each of {count} choices of gears")
    method = Note(template, method=best.method, count=len(found))
    return replace(best, method=method, best=replace(best.best, nodes=count))


def _lightest_choice(
    found: list[tuple[Mesh, Solution]], least: float, solved: Callable[[Mesh], Solution]
) -> Solution:
    """Of the choices that are as good as the best, the one that adds the least mass."""
    ties = {mesh for mesh, one in found if one.best.value <= least + TIE}
    equal = sorted(ties, key=lambda mesh: (mesh.ratio, mesh.direction))
    best = [solved(mesh) for mesh in equal[:: max(1, len(equal) // MOST_TIES)]]
    lightest = min(best, key=lambda one: one.problem.mass_added(one.numbers))
    return replace(lightest, ties=len(equal))


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


ROWS_AFTER_LINKAGE = Note(
    "the linkage was balanced first and its rows were turned after it; both together "
    "might do better"
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
    before = {term.objective.name: term.value_at(search.present) for term in search.cost.terms}
    change = Change("phases", "rows", {"phases": phasing.phases})
    earlier = () if found is None else found.changes
    notes = phasing.notes if found is None else (ROWS_AFTER_LINKAGE, *found.notes, *phasing.notes)
    after = phasing.after
    return Balanced(
        machine=phasing.machine,
        original=machine,
        plan=plan,
        changes=(*earlier, change),
        objectives={name: (before[name], after[name]) for name in after},
        cost=float(search.cost.of([after[name] for name in before])),
        bound=None,
        method=Note(
            "{count} arrangements of the rows on a grid of {step} deg, the best of them polished",
            count=phasing.combinations,
            step=f"{np.degrees(phasing.step):.4g}",
        ),
        prices={} if found is None else found.prices,
        looked_at=phasing.combinations,
        notes=notes,
        phasing=phasing,
    )
