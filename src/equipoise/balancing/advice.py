"""What helps most, where nobody said what may be changed: remedies that can be built, tried.

The aims are what a machine is judged by: what its gauges read, RMS about the mean, at the speeds
at which it runs; without gauges the RMS of its shaking force.  Remedies are other phases of rows,
which cost nothing, and counterweights of steel plate in the room that their links sweep already.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from math import floor, log10

from equipoise.balancing.balanced import Balanced
from equipoise.balancing.compared import WORSE
from equipoise.balancing.multi_row import Rows, Term
from equipoise.balancing.optimisation import balance
from equipoise.balancing.problem import Problem
from equipoise.errors import MassError, ModelError, ResponseError, UsageError
from equipoise.mechanism.balance import (
    MATERIALS,
    AddedMass,
    Balance,
    Limit,
    Objective,
    Phases,
    Weight,
    largest_mass,
)
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine
from equipoise.mechanism.steps import size_of_bodies
from equipoise.vibration.forced import usual_step
from equipoise.vibration.linear import Linear, gauges_of
from equipoise.vibration.resonance import resonances

Solve = Callable[[Machine, Balance], Balanced]

SMALLEST = 0.05
"""Room of a counterweight on a link that has no other point than its pin, m; less in a machine
that is smaller."""
THICK, HUB = 0.3, 0.2
"""Over a link's reach: the thickest plate, and the inner radius, inside which the shaft is."""
THICKEST = 0.1
"""m; plates beyond are not to be had."""
PLATES = (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
"""Thicknesses to be had, times a power of ten."""
CLEAR = 0.5
"""Share of the most that any remedy gains from which a simpler one is offered."""
LOUD, MOST_RESONANCES = 0.1, 2
"""Share of the loudest from which a resonance among the speeds is looked at; how many of them."""


def advise(machine: Machine, solve: Solve = balance) -> Balanced:
    """The machine's own plan carried out; where it has none, the remedy that helps most.

    What the file frees, or wants to become small, is kept; what it leaves out is as above.  Of the
    remedies tried the simplest is taken that brings at least half of what the best one does, before
    all one by which no gauge gets worse.  All are in `Balanced.tried`.

    Parameters
    ----------
    solve : carries out a plan.

    Raises
    ------
    MassError : a link has no mass given.
    UsageError : nothing that is tried has an effect on anything that counts.
    """
    if missing := massless(machine):
        raise MassError(missing)
    own = machine.balance or Balance()
    if own.objectives and not own.changes_nothing:
        return solve(machine, own)
    found: list[Balanced] = []
    problems: list[UsageError] = []
    for plan in remedies(machine, own):
        if plan.phases is not None and plan.masses and any(one.helps for one in found):
            continue  # both together are for machines that neither helps
        try:
            one = _without_harm(machine, replace(plan, objectives=aims_of(machine, plan)), solve)
        except UsageError as problem:
            problems.append(problem)
        else:
            found.append(replace(one, tried=(one,)))
            if one.gain >= CLEAR and not one.harms:
                break  # of which nothing brings twice as much
    if not problems and not found:
        raise UsageError(
            "there is nothing that could be tried: no link has a pin in the frame and another "
            "point, which would tell the room of a counterweight; say in [balance] what may be "
            "changed"
        )
    if not found:
        raise problems[0]
    return replace(_chosen(found), tried=tuple(found))


def _without_harm(machine: Machine, plan: Balance, solve: Solve) -> Balanced:
    """A plan carried out such that no gauge gets worse, where that brings anything."""
    found = solve(machine, plan)
    if plan.phases is not None or not found.harms:
        return found
    limits = tuple(Limit(replace(one, weight=1.0), ratio=1.0) for one in plan.objectives)
    try:
        kept = solve(machine, replace(plan, limits=(*plan.limits, *limits)))
    except UsageError:  # the least that a weight does is too much
        return found
    return kept if kept.gain > WORSE else found


def _chosen(found: list[Balanced]) -> Balanced:
    """The first that brings half of what the best one does; before all without harm to gauges."""
    good = [one for one in found if one.helps]
    fair = [one for one in good if not one.harms] or good or found
    most = max(one.gain for one in fair)
    return next(one for one in fair if one.gain >= (CLEAR * most if good else most))


# -- what is tried ---------------------------------------------------------------------------------


def remedies(machine: Machine, own: Balance) -> Iterator[Balance]:
    """Plans without objectives, the simplest first: what the file frees, or what can be built, with
    weights that are together no heavier than all links of a row.

    own : what the file says of balancing.
    """
    if not own.changes_nothing:
        yield own
        return
    crank, rows = machine.drive.link, len(machine.rows) > 1
    pinned = [name for name, link in machine.links.items() if machine.frame.keys() & link.points]
    swept = [link for link in dict.fromkeys((crank, *pinned)) if _reach(machine, link)]
    each = [counterweight_on(machine, link) for link in swept]
    if sum(largest_mass(one.weight) for one in each) > machine.mass > 0 and own.added_mass is None:
        own = replace(own, added_mass=machine.mass)
    if rows:
        yield replace(own, phases=Phases())
    if each:
        yield replace(own, masses=tuple(each[:1]))
    if len(each) > 1:
        yield replace(own, masses=tuple(each))
    if rows and each:
        yield replace(own, masses=tuple(each), phases=Phases())


def counterweight_on(machine: Machine, link: str) -> AddedMass:
    """A sector of steel plate within the reach of a link, from a fifth of it; the plate is the
    thickest of at most 0.3 of the reach and 100 mm.
    """
    reach = reach_of(machine, link)
    sector = Weight("sector", reach, HUB * reach, plate_of(THICK * reach), MATERIALS["steel"])
    return AddedMass(link, pin_of(machine, link), sector)


def plate_of(most: float) -> float:
    """The thickest plate (m) to be had that is at most so thick."""
    most = min(most, THICKEST) * (1 + 1e-9)
    unit = 10.0 ** floor(log10(most))
    return float(max(size * unit for size in PLATES if size * unit <= most))


def pin_of(machine: Machine, link: str) -> str:
    """The link's point in the frame; its first point where it has none."""
    points = machine.links[link].points
    return next((name for name in points if name in machine.frame), next(iter(points)))


def reach_of(machine: Machine, link: str) -> float:
    """Distance of a link's farthest point from its pin, m."""
    return _reach(machine, link) or min(SMALLEST, float(size_of_bodies(machine)))


def _reach(machine: Machine, link: str) -> float:
    """The same; 0 where nothing tells how large the link is."""
    points = machine.links[link].points
    center = complex(*points[pin_of(machine, link)])
    return max(abs(complex(*point) - center) for point in points.values())


# -- what it is judged by --------------------------------------------------------------------------


def aims_of(machine: Machine, plan: Balance) -> tuple[Objective, ...]:
    """What is to become small: the plan's own objectives; else what every gauge reads at each of
    `running_speeds`, where the plan can change it; else the shaking force.
    """
    if plan.objectives:
        return plan.objectives
    force = (Objective("shaking_force"),)
    if machine.support is None:
        return force
    try:
        linear = Linear.of(machine, usual_step(machine))
        speeds = running_speeds(machine, linear)
        each = [(speed,) for speed in speeds] if len(speeds) > 1 else [()]
        names = gauges_of(linear.body)
        wanted = [(f"gauges.{name}", at) for name in names for at in each]
        aims = tuple(Objective(name, "ripple", speeds=at) for name, at in wanted)
        return tuple(_moved(machine, replace(plan, objectives=aims))) or force
    except (ModelError, ResponseError):  # without a steady state the gauges tell nothing
        return force


def _moved(machine: Machine, plan: Balance) -> Iterator[Objective]:
    """Objectives that are not nothing, and that the plan can change."""
    rows = Rows(machine) if plan.phases is not None else None
    weights = replace(plan, phases=None)
    problem = None if weights.changes_nothing else Problem.of(machine, weights)
    if problem is not None:
        problem = replace(problem, plan=weights)
    for one in plan.objectives:
        turned = rows is None or Term(one, rows.signals(one)).influenced
        if turned and (problem is None or problem.moves(one)):
            yield one


def running_speeds(machine: Machine, linear: Linear) -> tuple[float, ...]:
    """Speeds (rad/s) that stand for all at which a machine runs, rising in size: its own; of a
    range the ends, the middle, and the loudest resonances between them.

    Raises
    ------
    ResponseError : there is no steady state at its own speed.
    """
    drive = machine.drive
    linear.motion(drive.speed)
    if drive.range is None:
        return (drive.speed,)
    slow, fast = drive.range
    loud = sorted(resonances(linear, slow, fast), key=lambda one: -one.share)
    near = [one.speed for one in loud if one.avoid is not None and one.share >= LOUD]
    found = {drive.speed, slow, (slow + fast) / 2, fast, *near[:MOST_RESONANCES]}
    return tuple(sorted((one for one in found if _is_steady(linear, one)), key=abs))


def _is_steady(linear: Linear, speed: float) -> bool:
    """Whether no undamped resonance is met."""
    try:
        linear.motion(speed)
    except ResponseError:
        return False
    return True
