"""What a good designer would do, where nobody said what may be changed.

First what is large on the machine (`results.yardsticks`).  Balancing aims at the largest figure
that shakes: what gauges read at the speeds at which the machine runs, a force, a moment or a
couple.  Remedies are other phases of rows, which cost nothing, holes, and counterweights of steel
plate in the room that is assumed (`balancing.room`, `balancing.remedies`).  A remedy is offered
where it takes away enough of its aim for its mass, and leaves no headline figure worse; to leave
the machine as it is, is an answer too.  Where nothing moves but rotors
(`results.rotors`), no remedy is offered that was not asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import cached_property

import numpy as np

from equipoise.balancing.balanced import Balanced, MoreRoom, Price, bending_notes
from equipoise.balancing.beyond_masses import Beyond, beyond_masses
from equipoise.balancing.box_bounds import PhaseProof
from equipoise.balancing.cylinder_phasing import PhasedRows, PhaseObjective
from equipoise.balancing.headlines import (
    Advice,
    AssessedMachine,
    HeadlineLimit,
    Saving,
    assessed,
    headline_objectives,
    watched_of,
)
from equipoise.balancing.objectives import unit_of
from equipoise.balancing.optimisation import balance, in_phases
from equipoise.balancing.phase_search import PhaseSearch, phasing_of
from equipoise.balancing.policy import (
    AIMED_FROM,
    ALL_BUT_GONE,
    COUPLE_FROM_NOTHING,
    ENOUGH_OF_BEST,
    LEAST_GAIN,
    LITTLE_MASS,
    MASS_PRICE,
    MOST_ADDED_MASS,
    NOTICED,
    QUIET_GAUGE,
)
from equipoise.balancing.problem import Problem
from equipoise.balancing.remedies import (
    Comparison,
    added_sector,
    best_cuts,
    best_holes,
    best_sectors,
    is_worth,
    with_cut,
    with_hole,
    with_sectors,
)
from equipoise.balancing.resonant_mounts import (
    ResonantMounts,
    outweighs,
    resonant_mounts_for,
)
from equipoise.balancing.room import Room, pivots_of, room_about, rooms_about, rooms_of_planes
from equipoise.balancing.workshop import Change
from equipoise.errors import EquipoiseError, MassError, ModelError, ResponseError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.balance import (
    GAUGES,
    OF_ROWS,
    ROWS,
    Balance,
    Limit,
    Objective,
    Phases,
)
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.rotors import unbalances
from equipoise.results.yardsticks import FigureAssessment
from equipoise.vibration.body import gauges_of
from equipoise.vibration.forced import check_moving
from equipoise.vibration.linear import Linear, resonances

Solve = Callable[[Machine, Balance], Balanced]
Remedy = tuple[Machine, tuple[Change, ...], Balance]
"""A changed machine, what is changed, and the plan that frees it."""

LEVEL = 1e-4
"""Of the couples that phases make between the rows: what is left of them, they may keep."""
ROUNDING = 1e-9
"""Over a limit: by how much a figure may be above it, as it is computed anew from the machine."""
LOUD, MOST_RESONANCES = 0.1, 2
"""Share of the loudest from which a resonance among the speeds is looked at; how many of them."""


def advise(machine: Machine, solve: Solve = balance) -> Balanced:
    """The machine's own plan carried out; where it has none, the remedy that helps most.

    What the file frees, or wants to become small, and its limits are kept.  Where nothing is worth
    building the result says so by `Balanced.helps`.  Everything that was tried is in
    `Balanced.tried`.

    Parameters
    ----------
    solve : carries out a plan.

    Raises
    ------
    MassError : a link has no mass given.
    UsageError : what the file frees has no effect on anything that counts.
    """
    if missing := massless(machine):
        raise MassError(missing)
    own = machine.balance or Balance()
    if own.objectives and not own.changes_nothing:
        return solve(machine, own)
    if not own.changes_nothing:
        return solve(machine, replace(own, objectives=_aims_of(machine, own)))
    check_moving(machine)
    return _Adviser(machine.with_balance(None), own, solve).advised()


def advice_against(balanced: Balanced, machine: Machine) -> Balanced:
    """Advice on a machine without its counterweights, judged beside the machine that has them."""
    advice, aims = balanced.advice, balanced.plan.objectives
    if advice is None:
        return balanced
    before = dict(zip((aim.name for aim in aims), Problem.values_of(machine, aims), strict=True))
    objectives = {name: (before[name], after) for name, (_, after) in balanced.objectives.items()}
    judged = replace(balanced, original=machine, objectives=objectives)
    old, new = assessed(machine), assessed(balanced.machine)
    share = max(judged.added_mass, 0.0) / (machine.mass or 1.0)
    figure = 1.0 if machine.balance and machine.balance.objectives else old.figure_gain(aims, new)
    worth = balanced.helps and bool(is_worth(judged.gain, share, figure))
    worse = old.worse_in(new, _saving(old, judged))
    offered = worth and not worse
    return replace(
        judged, advice=replace(advice, before=old.headline, worse=worse, offered=offered)
    )


def _saving(before: AssessedMachine, balanced: Balanced) -> Saving:
    pairs = {
        objective: balanced.objectives[objective.name] for objective in balanced.plan.objectives
    }
    return before.saving(pairs, balanced.gain)


class _Adviser:
    """Remedies of a machine, tried one after the other.

    own : what the file says of balancing: aims, limits, the most that may be added.
    """

    def __init__(self, machine: Machine, own: Balance, solve: Solve) -> None:
        self.machine, self.own, self.solve = machine, own, solve
        self.before = assessed(machine)
        self.known: dict[tuple[Objective, ...], list[float]] = {}
        values = self.values(tuple(limit.objective for limit in own.limits))
        limits = zip(own.limits, values, strict=True)
        self.watched = (
            *watched_of(self.before),
            *(HeadlineLimit((item.objective,), item.most(value)) for item, value in limits),
        )

    def advised(self) -> Balanced:
        """The remedy that is offered, else the best that was tried for the largest figure, else the
        machine as it is.
        """
        tried: list[Balanced] = []
        for objectives in self.aims():
            items = [*self.remedies(replace(self.own, objectives=objectives))]
            tried += items
            if good := [item for item in items if item.helps]:
                most = max(map(_score, good))
                best = next(item for item in good if _score(item) >= ENOUGH_OF_BEST * most)
                return self.with_more_room(replace(best, tried=tuple(tried)))
        if not tried:
            return self.unchanged()
        first = [item for item in tried if item.plan.objectives == tried[0].plan.objectives]
        best = max(first, key=lambda candidate: candidate.gain)
        return self.with_more_room(replace(best, tried=tuple(tried)))

    def with_more_room(self, result: Balanced) -> Balanced:
        """With the best counterweight of twice the room that is assumed, where it is worth it."""
        plan = replace(self.own, objectives=result.plan.objectives)
        least = _score(result) + LEAST_GAIN if result.helps else 0.0
        more_rooms = [
            MoreRoom(balanced, room.at, assumed, room.assumed)
            for link in pivots_of(self.machine)
            if any(room.is_limited_by_assumption for room in rooms_about(self.machine, link))
            for assumed in [room_about(self.machine, link).assumed]
            for room in rooms_about(self.machine, link, larger=2.0)
            for balanced in self.first_good(self.counterweights(plan, (room,)))
            if balanced.helps and _score(balanced) >= least and _radius_of(balanced) > assumed
        ]
        best = max(more_rooms, key=lambda item: _score(item.remedy), default=None)
        return replace(result, with_room=best)

    def values(self, objectives: tuple[Objective, ...]) -> list[float]:
        """Values of the machine as it is."""
        if objectives not in self.known:
            self.known[objectives] = Problem.values_of(self.machine, objectives)
        return self.known[objectives]

    def aims(self) -> Iterator[tuple[Objective, ...]]:
        """What is to become small, the largest first."""
        if self.own.objectives:
            yield self.own.objectives
            return
        large = [item for item in self.before.headline if _is_aim(item)]
        gauges = [item for item in large if item.output.startswith(GAUGES)]
        if gauges and (aims := self.loud_gauges):
            yield aims
        for entry in large:
            if entry not in gauges:
                output = entry.output.removeprefix(ROWS)
                yield (Objective(output, "rms" if entry.is_shaking else "ripple"),)

    def remedies(self, plan: Balance) -> Iterator[Balanced]:
        """What is tried, the simplest first; nothing more where half of the aim is gone."""
        for item in self._each(plan):
            yield item
            if item.helps and item.gain >= ENOUGH_OF_BEST:
                return  # of which nothing brings twice as much

    def _each(self, plan: Balance) -> Iterator[Balanced]:
        if len(self.machine.rows) > 1:
            yield from self.phases(plan)
        for link in pivots_of(self.machine):
            for room in rooms_about(self.machine, link):
                yield from self.changed(plan, (room,))
        for rooms in rooms_of_planes(self.machine):
            yield from self.changed(plan, rooms)

    def phases(self, plan: Balance) -> Iterator[Balanced]:
        """Other phases of the rows; where they twist the machine more than they save, those too
        that leave it without twist.
        """
        rows = PhasedRows(self.machine)
        try:
            moved = [
                objective
                for objective in plan.objectives
                if PhaseObjective(objective, rows.signals(objective)).influenced
            ]
            free = replace(plan, phases=Phases(), objectives=tuple(moved))
            judged = self.judged(_in_whole_degrees(self.solve(self.machine, free)))
            yield judged
            if twist := _twists_of(judged):
                limited = replace(free, limits=(*free.limits, *twist))
                level = _in_whole_degrees(self.solve(self.machine, limited))
                scope = (Note("without couples between the rows"), *level.scope)
                yield self.judged(replace(level, plan=free, scope=scope))
        except EquipoiseError:  # aims within one row, or that no phase changes
            return

    def changed(self, plan: Balance, rooms: tuple[Room, ...]) -> Iterator[Balanced]:
        """Mass taken off a link, or sectors on it, that gain."""
        comparison = self.comparison(plan, rooms)
        if not comparison.influences:
            return
        if len(rooms) == 1 and not rooms[0].neighbors:
            off = (
                with_hole(self.machine, rooms[0], best_hole) for best_hole in best_holes(comparison)
            )
            yield from self.first_good((*item, plan) for item in off)
            off = (with_cut(self.machine, rooms[0], best_cut) for best_cut in best_cuts(comparison))
            yield from self.first_good((*item, plan) for item in off)
        yield from self.first_good(self.counterweights(plan, rooms))

    def comparison(self, plan: Balance, rooms: tuple[Room, ...]) -> Comparison:
        """Shapes in some rooms beside each other."""
        aims = plan.objectives
        values = {aim.name: value for aim, value in zip(aims, self.values(aims), strict=True)}
        aim = self.before.largest_aim(aims)
        asked = self.requested
        return Comparison(self.machine, plan, rooms, self.watched, aim, values, asked)

    def most_mass(self, plan: Balance) -> float:
        """What may be added, kg: little against what is not large."""
        if self.own.added_mass is not None:
            return self.own.added_mass
        aim = self.before.largest_aim(plan.objectives)
        much = self.requested or aim is None or aim.is_large
        return (MOST_ADDED_MASS if much else LITTLE_MASS) * self.machine.mass

    def counterweights(self, plan: Balance, rooms: tuple[Room, ...]) -> Iterator[Remedy]:
        """Sectors in some rooms, the best first."""
        comparison = self.comparison(plan, rooms)
        if not comparison.influences:
            return
        for each in best_sectors(comparison, self.most_mass(plan), opposite=len(rooms) > 1):
            masses = tuple(map(added_sector, rooms, each))
            yield (*with_sectors(self.machine, rooms, each), replace(plan, masses=masses))

    def first_good(self, remedies: Iterable[Remedy]) -> Iterator[Balanced]:
        """The first that is worth building, with what is proved of it; else the first."""
        first: Balanced | None = None
        for machine, changes, plan in remedies:
            judged = self.judged(self.result(machine, changes, plan))
            first = first or judged
            if judged.helps:
                yield self.proved(judged)
                return
        if first is not None and first.gain >= NOTICED:
            yield first

    def result(self, machine: Machine, changes: tuple[Change, ...], plan: Balance) -> Balanced:
        """A changed machine beside the one that it comes from."""
        aims = plan.objectives
        pairs = zip(aims, self.values(aims), Problem.values_of(machine, aims), strict=True)
        objectives = {item.name: (old, new) for item, old, new in pairs}
        shares = [new / old if old else float(new > 0) for old, new in objectives.values()]
        cost = plan.combined(shares)
        limits = self.own.limits
        asked = tuple(limit.objective for limit in limits)
        reached = zip(limits, self.values(asked), Problem.values_of(machine, asked), strict=True)
        prices = {
            item.name: Price(item.most(old), new, 0.0, unit_of(item.objective, machine))
            for item, old, new in reached
        }
        method = Note("comparison of shapes")
        return Balanced(
            machine, self.machine, plan, changes, objectives, cost, cost, method, prices, 0,
            notes=tuple(bending_notes(self.machine)),
        )  # fmt: skip

    def proved(self, balanced: Balanced) -> Balanced:
        """With the bound of every sector in its room, round or not."""
        if not balanced.plan.masses:
            return balanced
        saving = _saving(self.before, balanced)
        limits = tuple(
            limit
            for item in self.watched
            for limit in item.limits(balanced.gain, saving.excess, saving.steadies)
            if not limit.objective.output.startswith(GAUGES)
        )
        unworsened = (Note("where no headline figure gets worse"),)
        for asked, scope in ((limits, unworsened), (self.own.limits, ())):
            plan = replace(balanced.plan, limits=asked, added_mass=self.most_mass(balanced.plan))
            try:
                proof = self.solve(self.machine, plan)
            except UsageError:  # the least that a limit allows is too much for the program
                continue
            return replace(
                balanced,
                bound=min(proof.bound, balanced.cost),
                method=proof.method,
                looked_at=proof.looked_at,
                scope=(*scope, *proof.scope),
                notes=proof.notes,
            )
        return balanced

    def judged(self, balanced: Balanced) -> Balanced:
        """With what its figures are against their yardsticks, and whether it is offered."""
        after = assessed(balanced.machine)
        worse = self.before.worse_in(after, _saving(self.before, balanced))
        share = max(balanced.added_mass, 0.0) / (self.machine.mass or 1.0)
        figure = self.figure_gain(balanced, after)
        enough = bool(is_worth(balanced.gain, share, figure)) and self.keeps_limits(balanced)
        if self.mounts is not None:
            enough = enough and outweighs(balanced.gain, self.mounts)
        if balanced.added_mass > 0:
            enough = enough and not self.is_for_more_arms(balanced)
        if not self.requested and unbalances(self.machine):
            enough = False  # it may be what the machine is for
        offered, before = enough and not worse, self.before.headline
        beyond = self.beyond
        if offered:  # what else helps is for the machine with the remedy
            mounts = self.mounts if balanced.gain < ALL_BUT_GONE else None
            beyond = beyond_masses(after.analysis, after.headline, mounts, self.beyond)
        advice = Advice(before, after.headline, worse, offered, beyond, self.requested)
        return replace(balanced, advice=advice)

    def is_for_more_arms(self, balanced: Balanced) -> bool:
        """Whether more arms on a carrier, which make up for each other, take off more of what is
        not large, against which nobody builds a weight then.
        """
        arms, aim = self.beyond.spaced, self.before.largest_aim(balanced.plan.objectives)
        small = aim is not None and not aim.is_large and not self.requested
        return small and arms is not None and arms.gain >= balanced.gain

    def figure_gain(self, balanced: Balanced, after: AssessedMachine) -> float:
        """Share that is gone of the figure that is large; 1 of aims that somebody asked for."""
        aims = balanced.plan.objectives
        return 1.0 if self.requested else self.before.figure_gain(aims, after)

    @cached_property
    def beyond(self) -> Beyond:
        """What helps the machine as it is beyond masses."""
        return beyond_masses(self.before.analysis, self.before.headline, self.mounts)

    @cached_property
    def loud_gauges(self) -> tuple[Objective, ...]:
        """What those gauges read that are loud, the loudest against its limit first."""
        # Reversed, for the largest entry of a gauge with several to remain.
        read = {item.output: item.excess for item in reversed(self.before.headline)
                if item.output.startswith(GAUGES)}  # fmt: skip
        least = QUIET_GAUGE * max(read.values(), default=0.0)
        # A gauge that nothing judges is no aim beside those that are judged.
        loud = [x for x in gauge_aims(self.machine) if read.get(x.output, 0.0) >= least]
        # To six digits: gauges that read alike keep their order whatever rounding does.
        return tuple(sorted(loud, key=lambda aim: -float(f"{read.get(aim.output, 0.0):.6g}")))

    @cached_property
    def mounts(self) -> ResonantMounts | None:
        """The resonance beside a speed at which the machine runs, and other mounts; None where
        the gauges are judged, read little, and the machine keeps away from it: leave it then.
        """
        aims = self.loud_gauges
        if not aims or (unbalances(self.machine) and not self.requested):
            return None
        speeds = {speed for aim in aims for speed in aim.speeds} or {self.machine.drive.speed}
        before, plan = self.values(aims), Balance(objectives=aims)

        def gain(machine: Machine) -> float:
            pairs = zip(before, Problem.values_of(machine, aims), strict=True)
            return 1 - plan.combined([new / old for old, new in pairs if old]) / len(aims)

        gauges = {aim.output.removeprefix(GAUGES) for aim in aims}
        mounts = resonant_mounts_for(self.machine, sorted(speeds, key=abs), gauges, gain)
        leaves_it = self.is_quiet and not self.requested
        return None if mounts is None or (leaves_it and not mounts.is_beside) else mounts

    @cached_property
    def is_quiet(self) -> bool:
        """Whether there is a limit or a usual value for each gauge, and it reads less."""
        judged = [item for item in self.before.headline if item.output.startswith(GAUGES)]
        names = {item.output for item in judged}
        aims = {aim.output for aim in gauge_aims(self.machine)}
        return names >= aims and not any(item.is_large for item in judged)

    def keeps_limits(self, balanced: Balanced) -> bool:
        """Whether the limits that the file gives are kept."""
        return all(
            price.used <= price.at_most * (1 + ROUNDING) for price in balanced.prices.values()
        )

    def unchanged(self) -> Balanced:
        """The machine as it is, where nothing that could be tried acts on what is large."""
        objectives = next(self.aims(), headline_objectives(self.before.headline))
        plan = replace(self.own, objectives=objectives)
        result = self.result(self.machine, (), plan)
        headline = self.before.headline
        advice = Advice(headline, headline, (), False, self.beyond, self.requested)
        return replace(result, advice=advice)

    @property
    def requested(self) -> bool:
        """Whether the objectives are the user's, and not the largest figures."""
        return bool(self.own.objectives)


def _in_whole_degrees(balanced: Balanced) -> Balanced:
    """Phases that can be set: of the nearest whole degrees."""
    plan, machine = balanced.plan, balanced.original
    assert balanced.phasing is not None
    search = PhaseSearch(machine, plan.objectives, Phases(), plan.combine)
    phases = np.array(balanced.phasing.phases) - balanced.phasing.phases[0]
    whole = np.radians(np.round(np.degrees(phases))) % search.cost.period
    if np.array_equal(whole, phases):
        return balanced
    proof = PhaseProof(whole, balanced.phasing.bound, balanced.looked_at, complete=True)
    phasing = replace(phasing_of(search, whole, proof), notes=balanced.phasing.notes)
    return in_phases(machine, plan, phasing, balanced.method, balanced.scope)


def _twists_of(balanced: Balanced) -> tuple[Limit, ...]:
    """Limits of the couples between the rows that phases make where there were none."""
    assert balanced.advice is not None
    increases = (
        (Objective(new.output.removeprefix(ROWS)), new)
        for was, new in balanced.advice.worse
        if abs(was.value) <= COUPLE_FROM_NOTHING * abs(new.value)
    )
    return tuple(
        Limit(couple, at_most=LEVEL * abs(new.value))
        for couple, new in increases
        if couple.output in OF_ROWS
    )


def _is_aim(assessment: FigureAssessment) -> bool:
    """Whether masses are tried against it: what shakes, and a torque, which weights may steady."""
    return (
        assessment.ratio >= AIMED_FROM
        if assessment.is_shaking
        else assessment.is_large and assessment.is_torque
    )


def _score(balanced: Balanced) -> float:
    """Gain, less the price of mass."""
    share = max(balanced.added_mass, 0.0) / (balanced.original.mass or 1.0)
    return balanced.gain - MASS_PRICE * share


def _radius_of(balanced: Balanced) -> float:
    """Of the largest piece that is added, m."""
    pieces = (piece for change in balanced.changes for piece in change.values.get("pieces", ()))
    return max((float(piece["outer_radius"]) for piece in pieces), default=0.0)


# -- what gauges are read for ----------------------------------------------------------------------


def gauge_aims(machine: Machine) -> tuple[Objective, ...]:
    """What every gauge reads at each of `running_speeds`; nothing without a steady state."""
    if machine.support is None:
        return ()
    try:
        linear = Linear.of(machine)
        speeds = running_speeds(machine, linear)
        names = gauges_of(linear.body)
    except (ModelError, ResponseError):
        return ()
    each = [(speed,) for speed in speeds] if len(speeds) > 1 else [()]
    return tuple(Objective(f"gauges.{name}", "ripple", speeds=at) for name in names for at in each)


def _aims_of(machine: Machine, plan: Balance) -> tuple[Objective, ...]:
    """What a plan that frees something is to make small: what gauges read, where it can change it;
    else the shaking force.
    """
    moved = _moved(machine, replace(plan, objectives=gauge_aims(machine)))
    return tuple(moved) or (Objective("shaking_force"),)


def _moved(machine: Machine, plan: Balance) -> Iterator[Objective]:
    """Objectives that are not nothing, and that the plan can change."""
    rows = PhasedRows(machine) if plan.phases is not None else None
    weights = replace(plan, phases=None)
    problem = None if weights.changes_nothing else Problem.of(machine, weights)
    for objective in plan.objectives:
        turned = rows is None or PhaseObjective(objective, rows.signals(objective)).influenced
        if turned and (problem is None or problem.moves(objective)):
            yield objective


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
    loud = sorted(resonances(linear, slow, fast), key=lambda resonance: -resonance.share)
    speeds = [item.speed for item in loud if item.avoid is not None and item.share >= LOUD]
    result = {drive.speed, slow, (slow + fast) / 2, fast, *speeds[:MOST_RESONANCES]}
    return tuple(sorted((item for item in result if _is_steady(linear, item)), key=abs))


def _is_steady(linear: Linear, speed: float) -> bool:
    """Whether no undamped resonance is met."""
    try:
        linear.motion(speed)
    except ResponseError:
        return False
    return True
