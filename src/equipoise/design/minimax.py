"""Problems whose cost is the largest of many functions, and their descent by exact derivatives.

The largest of several functions has a kink wherever two of them tie, which is where the best design
usually lies.  The bound on them becomes a number of the program: as small as can be, and no
function above it (the epigraph form).  `descended` does so for several groups of functions at once,
each with a bound of its own, by sequential quadratic programs of SciPy (SLSQP).
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.design.solvers import DesignProblem, DesignSolution
from equipoise.errors import ResponseError
from equipoise.i18n import Note
from equipoise.results.result import ProgressCallback
from equipoise.sequences import sobol
from equipoise.signals import Array

TRIED, FOLLOWED = 256, 8
"""Designs spread over the room, and how many of the best are followed downhill."""
STEPS, TOLERANCE = 200, 1e-9
"""Programs of a descent at most, and the change of the cost, over its start, at the end."""
WITHIN = 1e-6
"""Share of a limit by which a design may pass it: what the programs end with."""
OVER_LIMIT = 10
"""What passing a limit by all of it costs, over the cost itself, where designs are compared before
any is followed: enough that one within its limits is preferred to one of a tenth of its cost."""
SAME = 1e-4
"""Share of the best within which a descent has arrived at it too."""
NONE_WITHIN = Note(
    "no design within the limits was found; raise a limit, or widen the range of a variable"
)


class ValuesAndSlopes(NamedTuple):
    """Functions at a design.

    values : (P,).
    slopes : (P, d), their derivatives by the d variables.
    """

    values: Array
    slopes: Array


class MinimaxProblem(DesignProblem):
    """A problem whose cost is the largest of functions of which the derivatives are known.

    start : the place (d,) of the design that there is.
    """

    start: Array

    @abstractmethod
    def functions(
        self, place: Array, slopes: bool = True
    ) -> tuple[ValuesAndSlopes, ValuesAndSlopes]:
        """Functions whose largest is the cost, and limited ones, each at most 1, at a place (d,).

        slopes : whether derivatives by the place are needed; without, there may be none.
        """

    def cost(self, place: Array) -> float:
        """The largest function at a place (d,)."""
        return float(np.max(self.functions(place, slopes=False)[0].values))

    def evaluate(self, places: Array) -> tuple[Array, Array]:
        """Costs (n, 1), and by how much the limits are passed, each over its own, (n, 1)."""
        pairs = [self.functions(place, slopes=False) for place in places]
        costs = [np.max(functions.values) for functions, _ in pairs]
        beyond = [np.max(limited.values, initial=0.0) - 1 - WITHIN for _, limited in pairs]
        return np.array(costs)[:, None], np.array(beyond)[:, None]

    def jacobian(self, places: Array) -> tuple[Array, Array]:
        """Slopes of the largest function (n, 1, d), and of the largest over its limit (n, 1, d)."""
        pairs = [self.functions(place) for place in places]
        largest = [[_slope_of_largest(group) for group in pair] for pair in pairs]
        costs, limited = (np.array(group)[:, None] for group in zip(*largest, strict=True))
        return costs, limited


def _slope_of_largest(functions: ValuesAndSlopes) -> Array:
    values, slopes = functions
    return slopes[np.argmax(values)] if len(values) else np.zeros(slopes.shape[1])


@dataclass(frozen=True, eq=False)
class SequentialPrograms:
    """Designs spread over the room are tried, and the best of them followed downhill.

    progress : is called with how many are followed, and how many there are.
    starts : places (K, d) that are followed instead.
    """

    progress: ProgressCallback
    starts: Array | None = None
    name: ClassVar[str] = "sequential quadratic programs"

    def suits(self, problem: Any) -> bool:
        return isinstance(problem, MinimaxProblem)

    def solve(self, problem: MinimaxProblem) -> DesignSolution:
        """The best place; details : how many descents arrived there, and how many there were.

        Raises
        ------
        ResponseError : nothing within the limits was found.
        """
        places = _promising(problem) if self.starts is None else self.starts
        result = []
        for done, place in enumerate(places):
            self.progress(done, len(places))
            result.append(_downhill(problem, place))
        ends = np.array(result)
        values, beyond = (item[:, 0] for item in problem.evaluate(ends))
        if not np.any(beyond <= 0):
            raise ResponseError(NONE_WITHIN)
        values = np.where(beyond <= 0, values, np.inf)
        best = int(np.argmin(values))
        arrived = int(np.sum(values <= values[best] * (1 + SAME)))
        return DesignSolution(ends[best][None], details=(arrived, len(places)))


def _promising(problem: MinimaxProblem) -> Array:
    """The best of designs spread over the room; the one that there is is among them."""
    spread = sobol(len(problem.spreads), 1).random(TRIED)
    places = np.vstack([np.clip(problem.start, 0, 1), spread])
    worth = [_worth(problem, place) for place in places]
    order = np.argsort(worth, kind="stable")[:FOLLOWED]
    return places[order if 0 in order else np.append(order[:-1], 0)]


def _worth(problem: MinimaxProblem, place: Array) -> float:
    functions, limited = problem.functions(place, slopes=False)
    beyond = float(np.sum(np.maximum(limited.values - 1, 0)))
    cost = float(np.nan_to_num(np.max(functions.values), nan=np.inf))
    return cost * (1 + OVER_LIMIT * beyond)


def _downhill(problem: MinimaxProblem, place: Array) -> Array:
    """The least place that a descent from this one comes to, or this one where none is better."""
    end = descended(
        lambda x: [problem.functions(x)[0]],
        place,
        units=np.array([problem.cost(place)]),
        limited=lambda x: problem.functions(x)[1],
        box=(0.0, 1.0),
        most=(STEPS, TOLERANCE),
    )
    end = np.clip(end, 0, 1)
    return np.asarray(end if _worth(problem, end) <= _worth(problem, place) else place)


def descended(
    groups: Callable[[Array], Sequence[ValuesAndSlopes]],
    begin: Array,
    *,
    units: Array,
    box: tuple[float, float],
    most: tuple[int, float],
    limited: Callable[[Array], ValuesAndSlopes] | None = None,
    total: Callable[[Array], tuple[float, Array]] | None = None,
    least: Array | None = None,
    after: Callable[[], None] | None = None,
) -> Array:
    """Numbers (d,) at which a sum over groups of the largest of each is least nearby.

    Parameters
    ----------
    groups : functions of each of G groups at numbers (d,).
    begin : (d,).
    units : of the functions of each group (G,), which count as 1.
    box : ends of the numbers.
    most : programs at most, and the change of the sum at which they end.
    limited : functions that are each at most 1.
    total : the sum by the largest of each group (G,), and its slopes (G,); of a single group its
        largest where not given.
    least : bounds (G,) below which the largest of a group need not go; none where not given.
    after : is called after each program.
    """
    from scipy.optimize import minimize

    count = len(begin)
    bounds_from = np.full(len(units), -np.inf) if least is None else least / units

    def room(x: Array) -> Array:
        above = x[count:] * units
        parts = [
            (bound - group.values) / unit
            for group, bound, unit in zip(groups(x[:count]), above, units, strict=True)
        ]
        if limited is not None:
            parts.append(1 - limited(x[:count]).values)
        return np.concatenate(parts)

    def slopes(x: Array) -> Array:
        parts = []
        for k, (group, unit) in enumerate(zip(groups(x[:count]), units, strict=True)):
            bound = np.zeros((len(group.values), len(units)))
            bound[:, k] = 1.0
            parts.append(np.hstack([-group.slopes / unit, bound]))
        if limited is not None:
            rows = limited(x[:count]).slopes
            parts.append(np.hstack([-rows, np.zeros((len(rows), len(units)))]))
        return np.vstack(parts)

    def cost(x: Array) -> float:
        return float(x[count] if total is None else total(x[count:] * units)[0])

    def cost_slope(x: Array) -> Array:
        by_bounds = np.ones(1) if total is None else total(x[count:] * units)[1] * units
        return np.concatenate([np.zeros(count), by_bounds])

    now = np.array([np.max(group.values) for group in groups(begin)])
    rounds, change = most
    result = minimize(
        cost,
        np.concatenate([begin, np.maximum(now / units, bounds_from)]),
        jac=cost_slope,
        method="SLSQP",
        bounds=[box] * count + [(float(low), None) for low in bounds_from],
        constraints={"type": "ineq", "fun": room, "jac": slopes},
        options={"maxiter": rounds, "ftol": change},
        callback=None if after is None else lambda _: after(),
    )
    return np.asarray(result.x[:count])
