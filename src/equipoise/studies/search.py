"""Global search of designs for one or several objectives, generation by generation.

pymoo breeds the designs, in the places 0 to 1 of each number's range or list; the study's evaluator
computes a whole generation at once.  What is told in the end is the best of all designs that were
ever computed, not of the last generation.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isnan
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from equipoise.errors import ModelError, UsageError
from equipoise.results.result import Result
from equipoise.studies.design_space import Choices, Make, Range
from equipoise.studies.evaluate import evaluator
from equipoise.studies.evolution import Archive, Hypervolumes, canonical, evolution
from equipoise.studies.outcomes import Evaluator, designs_told, failures, kept, why_none
from equipoise.studies.sampling import values_at
from equipoise.studies.study import Study

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]

POPULATION, GENERATIONS = 100, 200
LEAST_POPULATION, MOST_POPULATION, MOST_GENERATIONS = 8, 100_000, 100_000

OnGeneration = Callable[[int, int, int, int], None]
"""Is called with generation, most of them, designs computed so far, designs on the front."""


@dataclass(frozen=True, eq=False, repr=False)
class Searched(Result):
    """Result of a search: K designs that keep every limit and that no other beats in everything.

    front : number of all such designs; of more than a population some that lie far apart are told.
    objectives : output -> ``smallest`` or ``largest``.
    values : (K, d).  figures : (K, m).  SI units, in the order of the first objective.
    computed : number of different designs; failures : of these by reason.
    generations : done.  stood_still : whether the front did not grow any more.
    volumes : after each generation: share of the box from the best to the worst figures of the last
        front that the front dominates (hypervolume); of one objective the best figure.
    """

    records: ClassVar[str] = "designs"

    study: Study
    front: int
    objectives: Mapping[str, Make]
    values: Array
    figures: Array
    computed: int
    failures: Mapping[str, int]
    generations: int
    stood_still: bool
    volumes: Array
    seed: int

    def machine(self, number: int = 0) -> Machine | Tool:
        """One of the designs as a new machine, counted from 0."""
        values = self.values[number].tolist()
        return self.study.model.machine(dict(zip(self.study.paths, values, strict=True)))

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units."""
        volumes = [None if isnan(one) else one for one in self.volumes.tolist()]
        study = self.study
        return {
            "title": study.title,
            "objectives": dict(self.objectives),
            "seed": self.seed,
            "front": self.front,
            "generations": self.generations,
            "stood_still": self.stood_still,
            "computed": self.computed,
            "failures": dict(self.failures),
            "volumes": volumes,
            "designs": designs_told(study.paths, self.values, study.names, self.figures),
        }


def search_designs(
    study: Study,
    *,
    population: int = POPULATION,
    generations: int = GENERATIONS,
    seed: int | None = None,
    progress: OnGeneration | None = None,
    compute: Evaluator | None = None,
) -> Searched:
    """Look for the best designs of a study.

    One objective: differential evolution; two or three: NSGA-II; more: NSGA-III.  Limits of outputs
    are constraints, and designs that keep them go before those that do not.

    Parameters
    ----------
    study : varies by ranges and lists, and makes at least one output small or large.
    population, generations : designs in a generation, and the most generations; the search ends
        before where the front stands still.
    seed : of the random numbers, that of the study where None; the same gives the same result.
    progress : see `OnGeneration`.
    compute : computes designs instead of the study's own evaluator.

    Raises
    ------
    ModelError : the study has nothing to search; `where` is its key.
    UsageError : population or generations cannot be used, or no design keeps the limits.
    """
    _check(study)
    if not LEAST_POPULATION <= population <= MOST_POPULATION:
        limits = f"{LEAST_POPULATION} to {MOST_POPULATION}"
        raise UsageError(f"got a population of {population}; give {limits}")
    if not 1 <= generations <= MOST_GENERATIONS:
        raise UsageError(f"got {generations} generations; give 1 to {MOST_GENERATIONS}")
    seed = study.sampling.seed if seed is None else seed
    seen = Archive(study, compute or evaluator(study))
    breeding = evolution(study, population, seed, seen.known)
    volumes = Hypervolumes()
    for generation in range(1, generations + 1):
        bred = breeding.ask()
        if bred is None:
            break  # there is hardly another design
        places = canonical(study, bred.get("X"))
        rows = seen.rows(values_at(study, places))
        bred.set("X", places, "F", seen.costs[rows], "G", seen.violations[rows])
        breeding.tell(infills=bred)
        volumes.add(seen.front_costs)
        if progress is not None:
            progress(generation, generations, seen.count, len(seen.front))
        if volumes.still:
            break
    still = bred is None or volumes.still
    last = seen.rows(values_at(study, breeding.pop.get("X")))
    told = seen.some_of_front(last, population)
    return _result(study, seen, volumes, told, still, seed)


# -- checks ----------------------------------------------------------------------------------------


def _check(study: Study) -> None:
    for number, one in enumerate(study.vary, 1):
        if not isinstance(one.spread, Range | Choices):
            raise ModelError(
                f"vary[{number}]",
                f"{one.path} has a tolerance, which cannot be chosen; a search takes a range or a "
                "list, and equipoise tolerance takes this",
            )
    if study.correlations:
        raise ModelError("correlations", "have no place in a search; leave them out")
    if not study.objectives:
        raise ModelError(
            "outputs", 'none is to become small or large; give one of them make = "smallest"'
        )


def _result(
    study: Study, seen: Archive, volumes: Hypervolumes, told: Array, still: bool, seed: int
) -> Searched:
    counts = seen.outcome.counts
    if not len(seen.front):
        good = seen.outcome.figures[seen.outcome.computed]
        limits = np.sum(kept(study.outputs, good), axis=0)
        raise UsageError(why_none(study.outputs, counts, limits))
    order = told[np.lexsort(seen.costs[told].T[::-1])]
    makes = {output.name: output.make for output in study.objectives if output.make}
    return Searched(
        study=study,
        front=len(seen.front),
        objectives=makes,
        values=seen.values[order],
        figures=seen.outcome.figures[order],
        computed=seen.count,
        failures=failures(counts),
        generations=len(volumes.fronts),
        stood_still=still,
        volumes=volumes.all * (seen.signs[0] if len(seen.signs) == 1 else 1),
        seed=seed,
    )
