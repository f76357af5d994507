"""The trade-off between two objectives: how small one can become for every value of the other.

Each point is the least value of the second with the first as a limit, and as good as any can be.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from equipoise.balancing.balanced import Balanced
from equipoise.balancing.blocks import shown_unit
from equipoise.balancing.objectives import unit_of
from equipoise.balancing.optimisation import balance
from equipoise.balancing.outcome import gap_text, scope_of
from equipoise.balancing.problem import Problem
from equipoise.balancing.rounding import NEARLY
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note, say
from equipoise.mechanism.parts.balance import Balance, Limit, Objective
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.blocks import Block, Column, Table, Text, Value
from equipoise.results.outputs import DIMENSIONS, objective_named
from equipoise.results.result import ProgressCallback, Result
from equipoise.signals import Array

POINTS = 21
"""Of a front between two objectives, both ends among them: twenty steps of the first."""
SAME, CONSTRAINT_TOLERANCE = 1e-7, 3e-9
"""Over the value before: less than this between the ends is no trade-off; how exactly the least
second objective is held while the first is made small."""
TOUCH = 1e-4
"""Over the range: how far from the very end the first point lies, so that it can be reached."""


@dataclass(frozen=True, eq=False, repr=False)
class Front(Result):
    """A trade-off curve, from the least first objective to the least second one.

    first, second : what is traded.  points : the balanced machine at each.
    values : (P, 2) of both objectives, SI units.
    """

    blocks_in = "balancing.pareto.front_blocks"
    pictures_in = "figures.balancing.front_charts"
    records: ClassVar[str] = "points"

    original: Machine
    first: Objective
    second: Objective
    points: tuple[Balanced, ...]
    values: Array

    @property
    def gap(self) -> float:
        """The largest of all points."""
        return max(point.gap for point in self.points)

    def columns(self) -> list[tuple[str, str, Array]]:
        """Name, unit and values of both objectives, and of the added mass."""
        masses = np.array([point.added_mass for point in self.points])
        both = zip((self.first, self.second), self.values.T, strict=True)
        columns = [(item.name, unit_of(item, self.original), values) for item, values in both]
        return [*columns, ("added mass", "kg", masses)]

    def to_dict(self) -> dict[str, Any]:
        """The machine-readable output, SI units and radians."""
        both = (self.first, self.second)
        return {
            "title": self.original.title,
            "first": self.first.name,
            "second": self.second.name,
            "before": {item.name: Problem.value_of(self.original, item) for item in both},
            "points": [
                {
                    "first": first,
                    "second": second,
                    "added_mass": point.added_mass,
                    "gap": point.gap,
                    "changes": [change.to_dict() for change in point.changes],
                }
                for (first, second), point in zip(self.values.tolist(), self.points, strict=True)
            ],
        }


def trade_off(
    machine: Machine,
    first: Objective,
    second: Objective,
    plan: Balance | None = None,
    points: int = POINTS,
    progress: ProgressCallback | None = None,
) -> Front:
    """The least second objective for values of the first, from its own least upwards.

    Parameters
    ----------
    plan : what may be changed, and limits; its objectives do not count.  That of the machine if
        None.
    points : of the curve.
    progress : is called with how many points are done, and how many there are.

    Raises
    ------
    UsageError : as in `balance`; or both objectives are smallest together.
    """
    plan = plan or machine.balance or Balance()
    if plan.phases is not None:
        raise UsageError(Note("a front is not drawn over phases; leave them out"))
    if first.name == second.name:
        raise UsageError(
            Note("{name} cannot be traded against itself; give another objective", name=first.name)
        )
    ends = [balance(machine, replace(plan, objectives=(item,))) for item in (first, second)]
    ends[1] = _least_of_both(machine, plan, first, ends[1])
    low, high = (Problem.value_of(end.machine, first) for end in ends)
    before = ends[0].objectives[first.name][0] or 1.0
    if high - low <= SAME * before:
        raise UsageError(
            Note(
                "{name} and {name_2} become smallest together, so that there is nothing to trade",
                name=first.name,
                name_2=second.name,
            )
        )
    result = []
    share = np.linspace(0.0, 1.0, points) ** 2  # closer together near low, where the curve is steep
    values = low + (high - low) * (TOUCH + (1 - TOUCH) * share)
    for done, value in enumerate(values.tolist(), 1):
        limit = Limit(first, at_most=value)
        limited_plan = replace(plan, objectives=(second,), limits=(*plan.limits, limit))
        result.append(balance(machine, limited_plan) if done < points else ends[1])
        if progress is not None:
            progress(done, points)
    both = [[Problem.value_of(item.machine, which) for which in (first, second)] for item in result]
    return Front(machine, first, second, tuple(result), np.array(both))


def _least_of_both(machine: Machine, plan: Balance, first: Objective, least: Balanced) -> Balanced:
    """Of all with the least second objective, the one with the least first, if it is found."""
    (second,) = least.plan.objectives
    before, after = least.objectives[second.name]
    limit = Limit(second, at_most=after + CONSTRAINT_TOLERANCE * before)
    try:
        result = balance(machine, replace(plan, objectives=(first,), limits=(*plan.limits, limit)))
    except UsageError:  # as near to the least as that, there may be no room to move
        return least
    if Problem.value_of(result.machine, first) >= Problem.value_of(least.machine, first):
        return least
    value = Problem.value_of(result.machine, second)
    return replace(
        least,  # whose bound is that of the second objective
        machine=result.machine,
        changes=result.changes,
        objectives={second.name: (before, value)},
        cost=least.cost * value / after if after else least.cost,
    )


def front_blocks(front: Front) -> Iterator[Block]:
    """The trade-off, a point a row."""
    labels = (objective_named(front.first), objective_named(front.second), say("added mass"))
    units = [unit for _, unit, _ in front.columns()]
    columns = [
        Column(label, DIMENSIONS.get(unit), shown_unit(unit))
        for label, unit in zip(labels, units, strict=True)
    ]
    values = (column.tolist() for _, _, column in front.columns())
    rows = tuple(tuple(Value(item, NEARLY) for item in row) for row in zip(*values, strict=True))
    yield Table(say("Trade-off"), tuple(columns), rows)
    yield Text(
        say(
            "Every point is as good as any can be, to {gap} of the value before{scope}.",
            gap=gap_text(front.gap),
            scope=scope_of(front.points[0]),
        )
    )
