"""The best numbers of one problem: closed form, cone program, or branch and bound.

The closed form is that of first moments where nothing but a mean square is asked: moved centres of
mass without limits, and weights of given mass in rooms without limits.  Where nothing meets all
limits, the error names the fewest that clash, and how far one of them can be met.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from math import inf, isfinite

import numpy as np

from equipoise.balancing.branch_and_bound import MOST_NODES, ProvedSolution, minimise
from equipoise.balancing.design_variables import AddedWeight, DesignVariables, MovedCenter
from equipoise.balancing.objectives import mean_square_rows, unit_of
from equipoise.balancing.problem import ADDED, WITHOUT_EFFECT, Problem
from equipoise.balancing.program import Affine, NoSolutionError, Program, StalledError
from equipoise.balancing.workshop import Change
from equipoise.dataclass import dataclass
from equipoise.decompositions import lstsq
from equipoise.errors import UsageError
from equipoise.i18n import Note, all_of
from equipoise.mechanism.parts.balance import Limit
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.result import ProgressCallback
from equipoise.signals import Array

SLACK, WORSE = 2e-9, 5e-9
"""Over the value before: by how much the cost may rise where that saves mass, as asked of the
solver and as read off the signals."""
STILL, SETTLED, ROUNDS = 1e-9, 1e-8, 20
"""Changes of cost and of numbers at which gauges have been read near enough; steps from near to
nearer."""
SAME_FRICTION = 1e-8
"""Change of objectives and limits, over their values before, at which friction has settled."""
FEW_NODES, PROOFS = 3, 3
"""Programs that are solved at most while friction has not settled; how often a proof may find
better numbers elsewhere, from which friction has to settle again."""
SHARES = (1.0, 0.5, 0.25, 0.1, 0.03, 0.01, 0.003)
"""Of a step towards the best of a nearby problem that are tried."""


@dataclass(frozen=True, eq=False)
class Solution:
    """Best numbers of one problem, the machine that they make, and the gears it has.

    ties : choices of gears that are as good.  weighed : how many of these were made as light as can
        be.  gears_left : whether some gears of several shafts were not tried together.
    """

    problem: Problem
    best: ProvedSolution
    numbers: list[Array]
    machine: Machine
    method: Note
    meshes: tuple[Change, ...] = ()
    ties: int = 1
    weighed: int = 1
    gears_left: bool = False

    @cached_property
    def friction_change(self) -> float:
        """By how much objectives and limits change at most, over their values before, from the
        friction that was taken as known to that of the solution itself; 0 without friction.
        """
        return self.problem.friction_change(self.numbers, self.machine)

    @property
    def settled(self) -> bool:
        """Whether the friction that was taken as known is that of the solution itself."""
        return self.friction_change <= SAME_FRICTION


class LimitsClashError(UsageError):
    """Limits cannot be met; `limits` has the names of those that clash."""

    def __init__(self, message: Note, limits: Sequence[str]) -> None:
        super().__init__(message)
        self.limits = tuple(limits)


def solve_problem(
    problem: Problem, progress: ProgressCallback | None = None, above: float = inf
) -> Solution:
    """The best numbers of one problem; step by step from near to near, where gauges are read or
    gears may change their flanks.

    above : of several problems, the least cost so far.
    """
    problem = _begun(problem)
    bent = problem.reads_gauges and problem.supports_more
    if problem.rubs:
        solution = _with_its_friction(problem, progress, above)
    else:
        solution = _solve_once(problem, progress, above)
    if not bent and not problem.flips:
        return solution
    cost, limits_gauges = problem.cost_of(solution.machine), bool(_gauged(problem))
    for _ in range(ROUNDS):
        linearized = problem.linearized_at(solution.numbers)
        towards = _solve_once(linearized, progress)
        if limits_gauges:  # which are kept where they are read, not a step before
            pairs = zip(solution.numbers, towards.numbers, strict=True)
            apart = max(float(np.max(np.abs(a - b), initial=0.0)) for a, b in pairs)
            better = towards if apart > SETTLED else None
        else:
            better = _on_the_way(linearized, solution, towards, cost)
        if better is None:
            return replace(solution, problem=linearized, best=towards.best)
        solution, cost = better, problem.cost_of(better.machine)
    return solution


def _with_its_friction(
    problem: Problem, progress: ProgressCallback | None, above: float = inf
) -> Solution:
    """The best numbers with the friction of their own forces."""
    try:
        solution = _settled(problem, progress, above)
    except LimitsClashError as error:
        numbers = _nearest_to_limits(problem, error.limits)
        if numbers is None:
            raise
    else:
        if solution.settled:
            return solution
        passed = problem.limits_passed_with_friction(solution.machine)
        numbers = _nearest_to_limits(problem, passed)
        if numbers is None:
            return solution
    try:
        solution = _settled(problem.linearized_at(numbers), progress, above)
        if solution.settled:
            return solution
    except LimitsClashError:  # with the friction of a result, if not with that of these numbers
        pass
    return _within_limits(problem, numbers, progress)


def _settled(problem: Problem, progress: ProgressCallback | None, above: float) -> Solution:
    """The best numbers with the friction of the problem, then of each result in turn, until that
    is its own.  Only then is it proved that nothing is better, as that takes most of the time.
    """
    solution, proofs = _solve_once(problem, None, most=FEW_NODES), 0
    for _ in range(ROUNDS):
        if solution.settled:
            if solution.best.nodes < FEW_NODES or solution.best.bound > above:
                return solution
            solution = _solve_once(solution.problem, progress, kept=solution.numbers)
            proofs += 1
            if solution.settled or proofs == PROOFS:
                return solution
        linearized = problem.linearized_at(solution.numbers)
        solution = _solve_once(linearized, None, most=FEW_NODES, kept=solution.numbers)
    return _solve_once(solution.problem, progress)


def _cost_kept(problem: Problem, numbers: list[Array], bound: float) -> float | None:
    """Cost of numbers whose own friction is that of the problem, where nothing is better by more
    than what counts as settled, and they keep the limits; else None.

    Where an optimum is flat, the best numbers wander, and with them friction, without an end.
    """
    known = problem.close.numbers
    if known is None or not np.array_equal(np.concatenate(numbers), known):
        return None
    cost = problem.cost_of(problem.close.machine)
    if cost - bound > SAME_FRICTION * problem.whole:
        return None
    return None if problem.limits_passed_with_friction(problem.close.machine) else cost


def _within_limits(
    problem: Problem, numbers: list[Array], progress: ProgressCallback | None
) -> Solution:
    """Good numbers with the friction of their own forces, where limits leave so little room that
    they cannot be kept with that of other numbers; the gap bounds how much better others may be.

    numbers : those that come nearest to the limits with their own friction; where they pass them
        because that has not settled, the result has not settled either.

    Raises
    ------
    LimitsClashError : the limits cannot be kept with the friction of these numbers.
    """
    for _ in range(ROUNDS):
        linearized = problem.linearized_at(numbers)
        towards = _solve_once(linearized, None, most=FEW_NODES)
        cost = problem.cost_of(linearized.close.machine)
        start = replace(towards, numbers=numbers, machine=linearized.close.machine)
        better = _on_the_way(linearized, start, towards, cost)
        if better is None:
            break
        numbers = better.numbers
    linearized = problem.linearized_at(numbers)
    proved, machine = _solve_once(linearized, progress), linearized.close.machine
    if problem.limits_passed_with_friction(machine):
        return proved
    best = replace(proved.best, value=problem.cost_of(machine))  # and not that of other numbers
    return replace(proved, best=best, numbers=numbers, machine=machine)


def _limit_to_lower(problem: Problem, clash: Sequence[str]) -> Limit | None:
    """Of limits that clash, the first that depends on friction, or else the first; None where only
    the added mass is limited.
    """
    clashing = (limit for limit in problem.plan.limits if limit.name in clash)
    rubs = problem.rubs
    return min(clashing, key=lambda limit: limit.objective.output not in rubs, default=None)


def _nearest_to_limits(problem: Problem, clash: Sequence[str]) -> list[Array] | None:
    """Numbers at which the first of the clashing outputs that depend on friction is least, with
    its own friction; None where friction has no part in it.

    With that of another machine a limit may look as if it could not be met, or by how much.

    Raises
    ------
    LimitsClashError : the other limits cannot be met either.
    """
    limit = _limit_to_lower(problem, clash)
    if limit is None or limit.objective.output not in problem.rubs:
        return None
    if not problem.moves(limit.objective):
        return None
    others = tuple(other for other in problem.plan.limits if other != limit)
    plan = replace(problem.plan, objectives=(limit.objective,), limits=others)
    first = replace(problem, plan=plan, counts=problem.before, known=problem.effects)
    return _with_its_friction(first, None).numbers


def _begun(problem: Problem) -> Problem:
    """The problem, read near a machine that keeps the limits of gauges as far as can be.

    Near the machine as it is, with a lighter support, they may look as if they could not be kept.
    """
    gauged = _gauged(problem)
    if not gauged or not problem.supports_more:
        return problem
    others = tuple(limit for limit in problem.plan.limits if limit not in gauged)
    objectives = tuple(item.objective for item in gauged)
    plan = replace(problem.plan, objectives=objectives, limits=others)
    first = replace(problem, plan=plan, counts=None, known=None)
    return problem.linearized_at(solve_problem(first).numbers)


def _gauged(problem: Problem) -> list[Limit]:
    """Limits of what gauges read."""
    return [limit for limit in problem.plan.limits if limit.objective.output.startswith("gauges.")]


def _on_the_way(
    problem: Problem, solution: Solution, towards: Solution, cost: float
) -> Solution | None:
    """A solution between two that costs less than the first, and with friction keeps the limits;
    None where there is none.
    """
    for share in SHARES:
        pairs = zip(solution.numbers, towards.numbers, strict=True)
        numbers = problem.project_feasible(
            [(1 - share) * item + share * two for item, two in pairs]
        )
        machine = problem.machine_with(numbers)
        cheaper = problem.cost_of(machine) < cost - STILL
        if cheaper and not problem.limits_passed_with_friction(machine):
            return replace(towards, numbers=numbers, machine=machine)
    return None


def _solve_once(
    problem: Problem,
    progress: ProgressCallback | None,
    above: float = inf,
    most: int = MOST_NODES,
    kept: list[Array] | None = None,
) -> Solution:
    """kept : numbers that stay where `_cost_kept` says so."""
    problem.check_influence()
    numbers = closed_form(problem)
    if numbers is not None:
        machine = problem.machine_with(numbers)
        cost = problem.cost_of(machine)
        best = ProvedSolution(
            np.zeros(0), cost, cost, {}, Program(), 0
        )  # no limit, no interval, no gap
        return Solution(problem, best, numbers, machine, Note("closed form"))
    built = problem.built
    try:
        best = minimise(built.program, built.squares, problem.whole, progress, above, most)
    except StalledError as error:
        raise UsageError(
            Note("{error}; change a limit a little, or free less", error=error.note)
        ) from error
    except NoSolutionError:
        raise infeasibility(problem) from None
    if kept is not None and (own := _cost_kept(problem, kept, best.bound)) is not None:
        best, numbers = replace(best, value=own), kept
    else:
        numbers = _split(problem, best.x) if above < inf else _lightest_numbers(problem, best)
        numbers = problem.minimize_added_mass(numbers)
    holds = best.nodes == 1
    method = Note("cone program") if holds else Note("branch and bound")
    return Solution(problem, best, numbers, problem.machine_with(numbers), method)


def _split(problem: Problem, x: Array) -> list[Array]:
    """The numbers of each part, projected onto what is feasible."""
    return problem.project_feasible([x[at] for at in problem.built.places])


def _lightest_numbers(problem: Problem, best: ProvedSolution) -> list[Array]:
    """Of the numbers that are as good, those that add the least mass."""
    arrays = _split(problem, best.x)
    masses, units = problem.added_masses(problem.built.places)
    if not len(masses) or (problem.reads_gauges and not problem.leaves_masses_open):
        return arrays
    program = best.program.copy()
    terms = np.array(list(program.cost))
    weights = np.array([program.cost[int(term)] for term in terms])
    program.nonnegative(Affine.of(terms, -weights, best.value + SLACK * problem.whole))
    program.cost = {int(m): float(u) for m, u in zip(masses, units / np.max(units), strict=True)}
    try:
        lighter = _split(problem, program.solve().x)
    except NoSolutionError:  # as near to the best as that, there may be no room to move
        return arrays
    worse = problem.cost_at(lighter) - best.value
    return lighter if worse <= WORSE * problem.whole else arrays


def closed_form(problem: Problem) -> list[Array] | None:
    """Numbers of each part at the least mean square, or None where there is no closed form."""
    plan = problem.plan
    squared = plan.combine == "squares" or len(plan.objectives) == 1
    if plan.limits or not squared or plan.added_mass is not None:
        return None
    if any(
        objective.measure not in {"rms", "ripple"} or len(objective.speeds) > 1
        for objective in plan.objectives
    ):
        return None
    free, given = [], []
    for part in problem.parts:
        numbers = _free_numbers(part)
        if numbers is None:
            return None
        free.append(np.isin(np.arange(part.count), numbers))
        given.append(np.zeros(part.count))
        if isinstance(part, AddedWeight) and part.weight.mass is not None:
            given[-1][0] = part.weight.mass / part.mass_unit
    if not free:
        return None
    values = _least_squares(problem, np.concatenate(free), np.concatenate(given))
    counts = np.cumsum([part.count for part in problem.parts])
    return None if values is None else problem.project_feasible(np.split(values, counts[:-1]))


def _free_numbers(part: DesignVariables) -> tuple[int, int] | None:
    """Which numbers of a part are first moments without limits; None where it has limits."""
    if isinstance(part, MovedCenter):
        move = part.move
        return (0, 1) if (move.x, move.y, move.center) == (None,) * 3 else None
    if isinstance(part, AddedWeight) and part.weight.mass is not None:
        free = part.weight.shape in {"any", "point"} and not isfinite(part.weight.radius)
        return (1, 2) if free else None
    return None


def _least_squares(problem: Problem, free: Array, given: Array) -> Array | None:
    """All numbers (K,), with the free ones such that the sum of squares is least.

    given : (K,) those that are given, and 0 elsewhere.
    """
    matrices, vectors = [], []
    lifts = ~free & (given == 0)
    for objective, factor in zip(problem.plan.objectives, problem.plan.factors, strict=True):
        (signal,) = problem.signals[objective.name]
        if np.max(np.abs(signal.columns[lifts]), initial=0.0) > WITHOUT_EFFECT:
            return None  # an inertia that grows with the square of a place
        matrix, vector = mean_square_rows(signal, objective.measure)
        matrices.append(factor * matrix[:, free])
        vectors.append(factor * (vector + matrix @ given))
    values = given.copy()
    values[free] = lstsq(np.concatenate(matrices), -np.concatenate(vectors), rcond=None)[0]
    return values


MOST_LIMITS = 40
"""Beyond which the fewest are not looked for."""


def infeasibility(problem: Problem) -> UsageError:
    """The error with the smallest set of limits that clash."""
    program = problem.built.program
    names = program.names
    if program.without(set(names)).feasible():
        clash = _infeasible_subset(program) if len(names) <= MOST_LIMITS else names
        sentence = all_of([_limit_in_words(problem, name) for name in clash], commas=True)
        alone = len(clash) == 1
        which = Note("this limit cannot be met") if alone else Note("these limits clash")
        return LimitsClashError(
            Note(
                "{which}: {limits}; {way_out}",
                which=which,
                limits=sentence,
                way_out=_way_out(problem, clash),
            ),
            clash,
        )
    return UsageError(
        Note(
            "what may be changed contradicts itself: a given mass has no place in its "
            "room, or the most that may be added is less than what is given"
        )
    )


def _infeasible_subset(program: Program) -> list[str]:
    """Limits none of which can be left out without the others becoming possible."""
    needed = list(program.names)
    for name in program.names:
        others = [other for other in needed if other != name]
        dropped = set(program.names) - set(others)
        if not program.without(dropped).feasible():
            needed = others
    return needed


def _limit_in_words(problem: Problem, name: str) -> Note | str:
    limit = next((limit for limit in problem.plan.limits if limit.name == name), None)
    if limit is None:
        most = problem.plan.added_mass
        if name != ADDED or not most:
            return name
        return Note("{name} at most {value:.4g} {unit}", name=name, value=1e3 * most, unit="g")
    if limit.ratio is not None:
        share = limit.ratio * 100
        return Note("{name} at most {share:.4g} % of before", name=name, share=share)
    unit = unit_of(limit.objective, problem.machine)
    return Note("{name} at most {value:.4g} {unit}", name=name, value=limit.at_most, unit=unit)


def _way_out(problem: Problem, clash: list[str]) -> Note:
    """How small one of the clashing outputs can become while the others are kept: one that depends
    on friction, as that of the best machine found is the one with which it is least.
    """
    limit = _limit_to_lower(problem, clash)
    if limit is None:
        return Note("allow more of it") if len(clash) == 1 else Note("allow more of one of them")
    plan = problem.plan
    others = tuple(other for other in plan.limits if other.name in clash and other != limit)
    relaxed = replace(plan, objectives=(limit.objective,), limits=others)
    try:
        # with the same friction, and the same flanks of gears
        relaxed_problem = replace(
            problem, plan=relaxed, counts=problem.before, known=problem.effects
        )
        least = relaxed_problem.built.program.solve().value * relaxed_problem.scale(limit.objective)
    except NoSolutionError:
        return Note("allow more of one of them")
    least /= relaxed.factors[0]
    unit = unit_of(limit.objective, problem.machine)
    text = {"name": limit.name, "least": least, "unit": unit}
    note = Note("{name} can become {least:.4g} {unit} at the least", **text)
    if len(clash) == 2:
        note = Note("{found} while the other is kept", found=note)
    if len(clash) > 2:
        note = Note("{found} while the others are kept", found=note)
    if limit.objective.output not in problem.rubs:
        return note
    return Note("{found}, with the friction of the best machine found", found=note)
