"""Evolution of designs: as places from 0 to 1, the algorithms of pymoo that breed them, and the
archive of all that were computed, with the front and how it grows.
"""

from __future__ import annotations

from collections.abc import Callable
from math import comb
from typing import Any

import numpy as np

from equipoise.codegen.figures import COMPUTED, NO_ASSEMBLY, NO_FULL_TURN, NO_MACHINE
from equipoise.errors import needed
from equipoise.studies.design_space import Choices
from equipoise.studies.outcomes import Evaluator, Outcome, far_apart, non_dominated, signs_of
from equipoise.studies.sampling import values_at
from equipoise.studies.study import Study

Array = np.ndarray[Any, Any]

Known = Callable[[Array], Array]
MANY = 4
"""Objectives from which reference directions, not crowding, keep designs apart."""


def canonical(study: Study, places: Array) -> Array:
    """The same designs, each value of a list in one place only, so that equal ones are seen."""
    settled = np.clip(places, 0.0, 1.0)
    for k, one in enumerate(study.vary):
        spread: Any = one.spread
        if isinstance(spread, Choices) or spread.whole:
            listed = isinstance(spread, Choices)
            count = len(spread.values) if listed else int(spread.high - spread.low) + 1
            step = np.minimum(np.floor(settled[:, k] * count), count - 1)
            settled[:, k] = (step + 0.5) / count
    return settled


def evolution(study: Study, population: int, seed: int, known: Known) -> Any:
    """The algorithm, ready to be asked for a generation.

    known : which of some designs (P, d), as values, were computed before; with several objectives
        they are not bred again, so that lists are searched to their ends.
    """
    for library in ("pymoo", "moocore"):
        needed(library, "a search")
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.algorithms.moo.nsga3 import NSGA3
    from pymoo.algorithms.soo.nonconvex.de import DE
    from pymoo.core.problem import Problem
    from pymoo.core.termination import NoTermination
    from pymoo.util.ref_dirs import get_reference_directions

    makes = len(study.objectives)
    limits = sum((o.at_least is not None) + (o.at_most is not None) for o in study.outputs)
    width = len(study.vary)
    first, new = _first(study, population, seed), _only_new(study, known)
    if makes == 1:
        algorithm = DE(pop_size=population, sampling=first, variant="DE/rand/1/bin", CR=0.9)
    elif makes < MANY:
        algorithm = NSGA2(pop_size=population, sampling=first, eliminate_duplicates=new)
    else:
        fine = max(p for p in range(1, population) if comb(p + makes - 1, p) <= population)
        directions = get_reference_directions("das-dennis", makes, n_partitions=fine)
        algorithm = NSGA3(directions, pop_size=population, sampling=first, eliminate_duplicates=new)
    problem = Problem(n_var=width, n_obj=makes, n_ieq_constr=1 + limits, xl=0.0, xu=1.0)
    return algorithm.setup(problem, termination=NoTermination(), seed=seed, verbose=False)


def _only_new(study: Study, known: Known) -> Any:
    """What strikes out designs that were computed before, or are in a generation twice."""
    from pymoo.core.duplicate import DuplicateElimination

    class OnlyNew(DuplicateElimination):  # type: ignore[misc]
        def _do(self, bred: Any, other: Any, struck: Array) -> Array:
            values = values_at(study, canonical(study, bred.get("X")))
            if other is None:
                _, first = np.unique(values, axis=0, return_index=True)
                struck[:] = True
                struck[first] = known(values[first])
            elif len(other):
                there = {*_keys(values_at(study, canonical(study, other.get("X"))))}
                struck |= [key in there for key in _keys(values)]
            return struck

    return OnlyNew()


def _first(study: Study, population: int, seed: int) -> Array:
    """Places (P, d) of the first generation: evenly spread, with the model's own among them."""
    from scipy.stats import qmc

    power = (population - 1).bit_length()  # SciPy warns of other numbers than powers of two
    places = qmc.Sobol(len(study.vary), seed=seed).random_base2(power)[:population]
    own = [_place(one.spread, study.model.number(one.path)[0]) for one in study.vary]
    if all(place is not None for place in own):
        places[0] = own
    return canonical(study, places)


def _place(spread: Any, value: float) -> float | None:
    """Where a value is in a range or list; None where it is not in there."""
    if isinstance(spread, Choices):
        if value not in spread.values:
            return None
        return (spread.values.index(value) + 0.5) / len(spread.values)
    if not spread.low <= value <= spread.high:
        return None
    if spread.whole:
        return float((value - spread.low + 0.5) / (spread.high - spread.low + 1))
    return float((value - spread.low) / (spread.high - spread.low))


PATIENCE, STILL, MARGIN = 20, 1e-4, 0.1
"""The search stands still if so many generations have added less than this share of the volume,
which reaches by a margin beyond the worst of the front."""
FAILED = 1e6
"""Violation of a design that cannot be computed; those that can be stand at most at some tens."""
VIOLATIONS = np.full(256, FAILED)
VIOLATIONS[COMPUTED] = -1.0
VIOLATIONS[[NO_MACHINE, NO_ASSEMBLY, NO_FULL_TURN]] *= (4.0, 3.0, 2.0)
"""By reason: a design that fails is the further away from a machine that works."""


class Archive:
    """All designs that were computed, each once; grows by generations.

    costs : (n, M) objectives, all to be small; 0 of failed designs.
    violations : (n, 1 + L) above 0 where a design fails, or does not keep a limit.
    """

    def __init__(self, study: Study, compute: Evaluator) -> None:
        self.study, self.compute = study, compute
        self.numbers: dict[bytes, int] = {}
        self.values = np.empty((0, len(study.vary)))
        self.outcome = Outcome(np.empty((0, len(study.outputs))), np.empty(0, np.uint8))
        self.makes = [k for k, output in enumerate(study.outputs) if output.make]
        self.signs = signs_of(study.outputs[k].make for k in self.makes)
        self.costs = np.empty((0, len(self.makes)))
        self.violations = np.empty((0, 1))
        self.front = np.empty(0, np.intp)
        self._ranges: Array | None = None

    @property
    def count(self) -> int:
        return len(self.values)

    @property
    def front_costs(self) -> Array:
        """Objectives of the best designs, (K, M)."""
        best: Array = self.costs[self.front]
        return best

    def some_of_front(self, chosen: Array, count: int) -> Array:
        """Rows of so many of the best designs: first those among the chosen rows, then others that
        lie far from each other.
        """
        first = np.intersect1d(chosen, self.front)[:count]
        others = np.setdiff1d(self.front, first)
        far = others[far_apart(self.costs[others], max(count - len(first), 0))]
        return np.concatenate([first, far])

    def rows(self, values: Array) -> Array:
        """Rows of designs (P, d); those that are new are computed together."""
        keys = _keys(values)
        new = {key: k for k, key in enumerate(keys) if key not in self.numbers}
        if new:
            self.add(values[list(new.values())])
            self.numbers |= {key: len(self.numbers) + k for k, key in enumerate(new)}
        return np.array([self.numbers[key] for key in keys])

    def known(self, values: Array) -> Array:
        """Which of some designs (P, d) are here already, (P,)."""
        return np.array([key in self.numbers for key in _keys(values)], bool)

    def add(self, values: Array) -> None:
        found = self.compute(values)
        begin = self.count
        self.values = np.concatenate([self.values, values])
        self.outcome = Outcome.joined([self.outcome, found])
        costs = np.where(found.computed[:, None], found.figures[:, self.makes] * self.signs, 0.0)
        self.costs = np.concatenate([self.costs, costs])
        violations = np.column_stack([VIOLATIONS[found.reason], *self.beyond(found)])
        before = self.violations.reshape(-1, violations.shape[1])
        self.violations = np.concatenate([before, violations])
        fine = begin + np.flatnonzero(np.all(violations <= 0, axis=1))
        known = np.concatenate([self.front, fine])
        self.front = known[non_dominated(self.costs[known])]

    def beyond(self, found: Outcome) -> list[Array]:
        """By how much each limit is exceeded (P,), over the range of the first figures."""
        sides = []
        for k, output in enumerate(self.study.outputs):
            figures = found.figures[:, k]
            for limit, sign in ((output.at_least, -1.0), (output.at_most, 1.0)):
                if limit is not None:
                    over = sign * (figures - limit) / self.ranges[k]
                    sides.append(np.where(found.computed, over, 0.0))
        return sides

    @property
    def ranges(self) -> Array:
        """Range of each figure (m,) in the first generation that has any; 1 where there is none."""
        good = self.outcome.figures[self.outcome.computed]
        if self._ranges is None and len(good):
            wide = np.ptp(good, axis=0)
            self._ranges = np.where(wide > 0, wide, 1.0)
        return np.ones(len(self.study.outputs)) if self._ranges is None else self._ranges


def _keys(values: Array) -> list[bytes]:
    return [row.tobytes() for row in np.ascontiguousarray(values)]


class Hypervolumes:
    """How much the front has grown."""

    def __init__(self) -> None:
        self.fronts: list[Array] = []

    def add(self, costs: Array) -> None:
        self.fronts.append(costs)

    @property
    def still(self) -> bool:
        """Whether the last generations have added next to nothing."""
        if len(self.fronts) <= PATIENCE or not len(self.fronts[-1 - PATIENCE]):
            return False
        before, now = self.fronts[-1 - PATIENCE], self.fronts[-1]
        if now.shape[1] == 1:
            gained = float(before[0, 0] - now[0, 0])
            return gained <= STILL * abs(float(now[0, 0]))
        old, new = self.volume(before), self.volume(now)
        return new - old <= STILL * new

    def volume(self, costs: Array) -> float:
        """Share of a box about the last front that costs (K, M) dominate."""
        from pymoo.indicators.hv import HV

        last = self.fronts[-1]
        low, high = last.min(axis=0), last.max(axis=0)
        wide = np.where(high > low, high - low, 1.0)
        places = (costs - low) / wide
        corner = 1 + MARGIN
        inside = places[np.all(places < corner, axis=1)]
        if not len(inside):
            return 0.0
        return float(HV(ref_point=np.full(len(low), corner))(inside)) / corner ** len(low)

    @property
    def all(self) -> Array:
        """Of every generation; NaN where there was no front yet."""
        if self.fronts[-1].shape[1] == 1:
            return np.array([f[0, 0] if len(f) else np.nan for f in self.fronts])
        return np.array([self.volume(f) if len(f) else np.nan for f in self.fronts])
