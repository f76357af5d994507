"""From the best numbers to what is told of them: objectives, changes, prices, notes."""

from __future__ import annotations

from collections.abc import Iterator

from equipoise.balancing.balanced import Balanced, Price
from equipoise.balancing.geared import geared_range
from equipoise.balancing.measures import unit_of
from equipoise.balancing.solution import Solution
from equipoise.balancing.design_variables import Bound
from equipoise.balancing.problem import ADDED
from equipoise.mechanism.balance import Balance
from equipoise.mechanism.model import Machine


def told(machine: Machine, plan: Balance, found: Solution) -> Balanced:
    """The result, with what was asked read off the new machine."""
    problem = found.problem
    objectives = {
        one.name: (problem.before[one.name], problem.value_of(found.machine, one))
        for one in plan.objectives
    }
    pairs = zip(problem.parts, found.numbers, strict=True)
    changes = [*found.meshes, *(change for part, own in pairs for change in part.changes(own))]
    return Balanced(
        found.machine,
        machine,
        plan,
        tuple(changes),
        objectives,
        problem.cost_of(found.machine),
        found.best.bound,
        found.method,
        _prices(found),
        found.best.nodes,
        tuple(_notes(found)),
        scope=_scope(found),
    )


def _scope(found: Solution) -> str:
    """Of what the bound is proved, where that is not all that the plan allows."""
    problem, told = found.problem, []
    pairs = zip(problem.parts, found.numbers, strict=True)
    if problem.reads_gauges and problem.supports_more:
        told.append("for small changes about it")
    if any(part.stopped(own) for part, own in pairs):
        told.append("within where it was stopped")
    if problem.flips:
        told.append("for the flanks of gears in contact here")
    if any(geared_range(geared) for geared in problem.plan.geared):
        told.append("for each of the gears tried")
    return " and ".join(told)


def _prices(found: Solution) -> dict[str, Price]:
    """Prices of the limits, in SI units."""
    problem, plan = found.problem, found.problem.plan
    only = plan.objectives[0] if len(plan.objectives) == 1 else None
    unit = 1.0 if only is None else problem.scale(only) / only.weight
    prices = {}
    for limit in plan.limits:
        scale = problem.scale(limit.objective)
        at_most = (
            limit.at_most
            if limit.at_most is not None
            else (limit.ratio or 0.0) * problem.before[limit.name]
        )
        used = problem.value_of(found.machine, limit.objective)
        paid = found.best.prices.get(limit.name, 0.0) * unit / scale
        paid = _rounded(paid, unit / scale)
        prices[limit.name] = Price(at_most, used, paid, unit_of(limit.objective, problem.machine))
    return prices | _prices_of_parts(found, unit)


def _prices_of_parts(found: Solution, unit: float) -> dict[str, Price]:
    """Prices of added mass in all, and of the limits that each part has of itself."""
    problem, most = found.problem, found.problem.plan.added_mass
    pairs = [*zip(problem.parts, found.numbers, strict=True)]
    bounds = [bound for part, own in pairs for bound in part.bounds(own)]
    if most is not None:
        weights = sum(float(own @ part.effect[:, 0]) for part, own in pairs if part.mass_place == 0)
        bounds.append(Bound(ADDED, most, weights, "kg"))
    prices = {}
    for one in bounds:
        paid = _rounded(found.best.prices.get(one.name, 0.0) * unit, unit / one.at_most)
        prices[one.name] = Price(one.at_most, one.used, paid, one.unit)
    return prices


def _rounded(price: float, scale: float) -> float:
    """A price that is nothing but the solver's rounding is 0."""
    return price if price > 1e-7 * scale else 0.0


def _notes(found: Solution) -> Iterator[str]:
    """What a reader has to know."""
    problem, rows = found.problem, len(found.problem.machine.rows)
    if problem.machine.drive.acceleration:
        yield "the drive's acceleration is left out: the crank is taken as turning steadily"
    if problem.reads_gauges and problem.supports_more:
        yield (
            "added mass makes the support heavier, which bends what is linear otherwise: the bound "
            "is that of small changes about this result"
        )
    pairs = zip(problem.parts, found.numbers, strict=True)
    yield from filter(None, (part.stopped(own) for part, own in pairs))
    if rows > 1 and any(part.mass_place is not None for part in problem.parts):
        yield f"masses are those of one row; the machine has {rows}"
    if found.ties > 1:
        yield (
            f"{found.ties} of the ratios tried are as good, and the lightest was taken; drive and "
            "joints may tell them apart: give them a limit"
        )
    if found.best.nodes >= 1 and found.best.value - found.best.bound > 1e-7:
        yield (
            "the search ended before it had proved that nothing better exists; the gap tells how "
            "far it came"
        )
