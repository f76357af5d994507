"""What helps most, where nobody said what may be changed: remedies that can be built, tried.

The aims are what a machine is judged by: what its gauges read, RMS about the mean, at the speeds
at which it runs; without gauges the RMS of its shaking force.  Remedies are other phases of rows,
which cost nothing, and counterweights of steel plate, as far about their pins as links reach.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from math import floor, log10

from equipoise.balancing.balanced import Balanced
from equipoise.balancing.compared import WORTH, too_dear
from equipoise.balancing.multi_row import Rows, Term
from equipoise.balancing.optimisation import balance
from equipoise.balancing.problem import Problem
from equipoise.errors import MassError, ModelError, ResponseError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.steps import size_of_bodies
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.balance import (
    MATERIALS,
    AddedMass,
    Balance,
    Limit,
    Objective,
    Phases,
    Weight,
    largest_mass,
)
from equipoise.mechanism.parts.body_checks import outlines
from equipoise.mechanism.parts.machine import Machine
from equipoise.vibration.linear import Linear, gauges_of
from equipoise.vibration.resonance import resonances

Solve = Callable[[Machine, Balance], Balanced]

SMALLEST = 0.05
"""Room of a counterweight on a link that has no other point than its pin, m; less in a machine
that is smaller."""
THICK, HUB = 0.3, 0.2
"""Over a link's reach: the thickest plate, and the inner radius, inside which the shaft is."""
THICKER, THICKEST = 3.0, 0.03
"""Over the thickness of the link that carries it, and m: beyond, no workshop screws it on."""
PLATES = (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
"""Thicknesses to be had, times a power of ten."""
CLEAR = 0.5
"""Share of the most that any remedy gains from which a simpler one is offered."""
ROUNDS = 3
"""How often a remedy that harms is looked for again."""
LOUD, MOST_RESONANCES = 0.1, 2
"""Share of the loudest from which a resonance among the speeds is looked at; how many of them."""


def advise(machine: Machine, solve: Solve = balance) -> Balanced:
    """The machine's own plan carried out; where it has none, the remedy that helps most.

    What the file frees, or wants to become small, is kept; what it leaves out is as above.  Of the
    remedies that are worth building the simplest is taken that brings at least half of what the
    best one does, before all one by which no gauge gets worse; where none is, the one that gains
    most, of which `Balanced.helps` tells that it is not.  All are in `Balanced.tried`.

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
            one = _weighed(machine, replace(plan, objectives=aims_of(machine, plan)), solve)
        except UsageError as problem:
            problems.append(problem)
        else:
            found.append(one)
            if one.helps and one.gain >= CLEAR and not one.harms:
                break  # of which nothing brings twice as much
    if not problems and not found:
        raise UsageError(
            Note(
                "there is nothing that could be tried: no link has a pin in the frame and "
                "another point, which would tell the room of a counterweight; say in "
                "[balance] what may be changed"
            )
        )
    if not found:
        raise problems[0]
    return replace(_chosen(found), tried=tuple(found))


def _weighed(machine: Machine, plan: Balance, solve: Solve) -> Balanced:
    """A plan carried out; where that harms, again such that it does not, if that is worth it."""
    first = found = _as_tried(solve(machine, plan))
    held: dict[Objective, Limit] = {}
    for _ in range(ROUNDS if plan.phases is None else 0):
        new = {one.objective: one for one in _held(found)} if found.gain >= WORTH else {}
        if not new:
            break
        held |= new
        try:
            found = _as_tried(solve(machine, replace(plan, limits=(*plan.limits, *held.values()))))
        except UsageError:  # the least that a weight does is too much
            break
    return found if found.helps else first


def _as_tried(found: Balanced) -> Balanced:
    """A result that is held to what is asked of remedies."""
    return replace(found, tried=(found,))


def _held(found: Balanced) -> Iterator[Limit]:
    """Limits by which a remedy does no harm: no gauge gets worse, and nothing else grows by more
    than half of what is gained, since with them less is.
    """
    if found.harms:
        yield from (Limit(replace(one, weight=1.0), ratio=1.0) for one in found.plan.objectives)
    if len(found.original.rows) > 1 or not too_dear(found.worse, found.gain):
        return  # limits are those of all rows together
    half = found.gain / 2
    for one in found.worse:
        if one.group != "gauges" and one.before and one.weight > half:
            rms = replace(one.objective, measure="rms")  # a cone, where a peak is hundreds
            yield Limit(rms, ratio=1 + half * one.growth / one.weight)


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
    thickest of at most 0.3 of the reach, three times the link's own thickness, and 30 mm.
    """
    reach, bodies = reach_of(machine, link), machine.links[link].bodies
    own = max((one.thickness or one.outer_diameter or 0.0 for one in bodies), default=0.0)
    plate = plate_of(min(THICK * reach, THICKER * own or THICKEST))
    sector = Weight("sector", reach, HUB * reach, plate, MATERIALS["steel"])
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
    """Distance of what of a link is farthest from its pin, m: a point, or an edge of a body."""
    return _reach(machine, link) or min(SMALLEST, float(size_of_bodies(machine)))


def _reach(machine: Machine, link: str) -> float:
    """The same; 0 where nothing tells how large the link is."""
    body = machine.links[link]
    places = [(complex(*point), 0.0) for point in body.points.values()]
    for part in body.bodies:
        for corners, radius in outlines(part, body.points):
            places += [(corner, max(radius, 0.0)) for corner in corners]
    center = complex(*body.points[pin_of(machine, link)])
    return max(abs(place - center) + radius for place, radius in places)


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
        linear = Linear.of(machine)
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
