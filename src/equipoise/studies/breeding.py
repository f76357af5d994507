"""Designs as places from 0 to 1, and the algorithms of pymoo that breed them."""

from __future__ import annotations

from collections.abc import Callable
from math import comb
from typing import Any

import numpy as np

from equipoise.studies.extras import needed
from equipoise.studies.design_space import Choices
from equipoise.studies.study import Study

Array = np.ndarray[Any, Any]

Known = Callable[[Array], Array]
MANY = 4
"""Objectives from which reference directions, not crowding, keep designs apart."""


def values_of(study: Study, places: Array) -> Array:
    """Values (P, d), SI units, at places (P, d) from 0 to 1 of ranges and lists."""
    columns = [one.spread.at(places[:, k]) for k, one in enumerate(study.vary)]
    return np.stack(columns, axis=1)


def settled(study: Study, places: Array) -> Array:
    """The same designs, each value of a list in one place only, so that equal ones are seen."""
    settled = np.clip(places, 0.0, 1.0)
    for k, one in enumerate(study.vary):
        count = _levels(one.spread)
        if count:
            step = np.minimum(np.floor(settled[:, k] * count), count - 1)
            settled[:, k] = (step + 0.5) / count
    return settled


def _levels(spread: Any) -> int:
    if isinstance(spread, Choices):
        return len(spread.values)
    return int(spread.high - spread.low) + 1 if spread.whole else 0


def breeder(study: Study, population: int, seed: int, known: Known) -> Any:
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
    first = _first(study, population, seed)
    if makes == 1:
        algorithm = DE(pop_size=population, sampling=first, variant="DE/rand/1/bin", CR=0.9)
    elif makes < MANY:
        algorithm = NSGA2(
            pop_size=population, sampling=first, eliminate_duplicates=_only_new(study, known)
        )
    else:
        fine = max(p for p in range(1, population) if comb(p + makes - 1, p) <= population)
        directions = get_reference_directions("das-dennis", makes, n_partitions=fine)
        algorithm = NSGA3(
            directions,
            pop_size=population,
            sampling=first,
            eliminate_duplicates=_only_new(study, known),
        )
    problem = Problem(n_var=width, n_obj=makes, n_ieq_constr=1 + limits, xl=0.0, xu=1.0)
    return algorithm.setup(problem, termination=NoTermination(), seed=seed, verbose=False)


def _only_new(study: Study, known: Known) -> Any:
    """What strikes out designs that were computed before, or are in a generation twice."""
    from pymoo.core.duplicate import DuplicateElimination

    class OnlyNew(DuplicateElimination):  # type: ignore[misc]
        def _do(self, bred: Any, other: Any, struck: Array) -> Array:
            values = values_of(study, settled(study, bred.get("X")))
            if other is None:
                _, first = np.unique(values, axis=0, return_index=True)
                struck[:] = True
                struck[first] = known(values[first])
            elif len(other):
                there = {row.tobytes() for row in values_of(study, settled(study, other.get("X")))}
                struck |= [row.tobytes() in there for row in values]
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
    return settled(study, places)


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
