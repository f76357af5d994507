"""Why nothing meets all limits: the fewest that clash, and how far one of them can be met."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from equipoise.balancing.measures import unit_of
from equipoise.balancing.problem import ADDED, Problem
from equipoise.balancing.program import NoSolutionError, Program
from equipoise.errors import UsageError
from equipoise.mechanism.balance import Limit

MOST_LIMITS = 40
"""Beyond which the fewest are not looked for."""


def explained(problem: Problem) -> UsageError:
    """The error that tells which limits clash."""
    program = problem.built.program
    names = program.names
    if program.without(set(names)).feasible():
        clash = _fewest(program) if len(names) <= MOST_LIMITS else names
        told = listed([_told(problem, name) for name in clash])
        which = "this limit cannot be met" if len(clash) == 1 else "these limits clash"
        return UsageError(f"{which}: {told}; {_way_out(problem, clash)}")
    return UsageError(
        "what may be changed contradicts itself: a given mass has no place in its room, or the "
        "most that may be added is less than what is given"
    )


def listed(names: Sequence[str]) -> str:
    """Names as they are told one after the other."""
    return " and ".join([*filter(None, [", ".join(names[:-1])]), *names[-1:]])


def _fewest(program: Program) -> list[str]:
    """Limits none of which can be left out without the others becoming possible."""
    needed = list(program.names)
    for name in program.names:
        others = [other for other in needed if other != name]
        dropped = set(program.names) - set(others)
        if not program.without(dropped).feasible():
            needed = others
    return needed


def _told(problem: Problem, name: str) -> str:
    limit = next((limit for limit in problem.plan.limits if limit.name == name), None)
    if limit is None:
        most = problem.plan.added_mass
        return f"{name} at most {1e3 * most:.4g} g" if name == ADDED and most else name
    if limit.ratio is not None:
        return f"{name} at most {limit.ratio * 100:.4g} % of before"
    return f"{name} at most {limit.at_most:.4g} {_unit(problem, limit)}"


def _way_out(problem: Problem, clash: list[str]) -> str:
    """How small the first of the clashing outputs can become while the others are kept."""
    limit = next((limit for limit in problem.plan.limits if limit.name in clash), None)
    if limit is None:
        return "allow more of it" if len(clash) == 1 else "allow more of one of them"
    plan = problem.plan
    others = tuple(other for other in plan.limits if other.name in clash and other != limit)
    relaxed = replace(plan, objectives=(limit.objective,), limits=others)
    try:
        asked = Problem(problem.machine, relaxed, problem.start, problem.parts, problem.close)
        least = asked.built.program.solve().value * asked.scale(limit.objective)
    except NoSolutionError:
        return "allow more of one of them"
    least /= limit.objective.weight
    kept = "the other is kept" if len(clash) == 2 else "the others are kept"
    where = f" while {kept}" if len(clash) > 1 else ""
    return f"{limit.name} can become {least:.4g} {_unit(problem, limit)} at the least{where}"


def _unit(problem: Problem, limit: Limit) -> str:
    return unit_of(limit.objective, problem.machine)
