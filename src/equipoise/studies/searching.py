"""Global search of designs for one or several objectives, generation by generation.

A solver asks for designs, in the places 0 to 1 of each number's range or list; the study's
evaluator computes a whole generation at once.  The result is the best of all designs that
were ever computed, not of the last generation.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import replace
from math import inf, isnan
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from equipoise.codegen.figures import COMPUTED, NO_ASSEMBLY, NO_FULL_TURN, NO_MACHINE
from equipoise.dataclass import dataclass
from equipoise.design.solvers import DesignProblem, solve
from equipoise.design.variables import Choices, Range
from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.keys.requirement_kinds import Make
from equipoise.results.result import Result
from equipoise.signals import Array
from equipoise.studies.evaluate import pooled
from equipoise.studies.evolution import SOLVERS
from equipoise.studies.outcomes import (
    DesignBlock,
    Evaluator,
    Hypervolumes,
    Outcome,
    design_records,
    failures,
    far_apart,
    feasible,
    non_dominated,
    signs_of,
    why_none,
)
from equipoise.studies.study import Study, canonical, values_at

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.parts.machine import Machine


POPULATION, GENERATIONS = 100, 200
"""Designs of a generation, and generations at most, where nothing else follows from the study."""
FEWEST_GENERATIONS = 10
"""Into which a search of few designs is parted: in fewer, little is bred."""
TIMED = 4
"""Generations from which the time to breed one is taken."""
LEAST_POPULATION, MOST_POPULATION, MOST_GENERATIONS = 8, 100_000, 100_000
"""Fewer parents than eight breed the same again; more than the others are a slip of the pen."""

OnGeneration = Callable[[int, int, int, int], None]
"""Is called with generation, most of them, designs computed so far, designs on the front."""

FAILED = 1e6
"""Violation of a design that cannot be computed; those that can be stand at most at some tens."""
VIOLATIONS = np.full(256, FAILED)
VIOLATIONS[COMPUTED] = -1.0
VIOLATIONS[[NO_MACHINE, NO_ASSEMBLY, NO_FULL_TURN]] *= (4.0, 3.0, 2.0)
"""By reason: a design that fails is the further away from a machine that works."""


@dataclass(frozen=True, eq=False, repr=False)
class Searched(Result):
    """Result of a search: K designs that keep every limit and that no other beats in everything.

    front : number of all such designs; of more than a population some far apart are listed.
    objectives : output -> ``smallest`` or ``largest``.
    values : (K, d).  figures : (K, m).  SI units, in the order of the first objective.
    computed : number of different designs; failures : of these by reason; tried : all of them.
    generations : done.  stood_still : whether the front did not grow any more.
    volumes : after each generation: share of the box from the best to the worst figures of the last
        front that the front dominates (hypervolume); of one objective the best figure.
    solver : name of what looked for them.
    proof : why no design is better than these; None where nothing proves it.
    """

    blocks_in = "studies.blocks.searched_blocks"
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
    tried: DesignBlock
    solver: str = ""
    proof: Note | None = None

    def machine(self, number: int = 0) -> Machine | Tool:
        """One of the designs as a new machine, counted from 0."""
        values = self.values[number].tolist()
        return self.study.model.machine(dict(zip(self.study.paths, values, strict=True)))

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units."""
        study = self.study
        return {
            "title": study.title,
            "objectives": dict(self.objectives),
            "seed": self.seed,
            "front": self.front,
            "solver": self.solver,
            "proved": self.proof is not None,
            "generations": self.generations,
            "stood_still": self.stood_still,
            "computed": self.computed,
            "failures": dict(self.failures),
            "volumes": [None if isnan(volume) else volume for volume in self.volumes.tolist()],
            "designs": design_records(study.paths, self.values, study.names, self.figures),
        }


def search(
    study: Study,
    *,
    population: int | None = None,
    generations: int | None = None,
    seed: int | None = None,
    progress: OnGeneration | None = None,
    compute: Evaluator | None = None,
    workers: int | None = None,
    cluster: str | None = None,
) -> Searched:
    """Look for the best designs of a study.

    Where all numbers are lists or whole and there are no more designs than generations have,
    every one is computed, which proves that none is better.  Else, which proves nothing, of one
    objective: differential evolution; two or three: NSGA-II; more: NSGA-III.  Limits of outputs are
    constraints, and designs that keep them go before those that do not.

    Parameters
    ----------
    study : varies by ranges and lists, and makes at least one output small or large.
    population, generations : designs in a generation, and the most generations; see `search_size`
        where one is None.  The search ends before where the front stands still.
    seed : of the random numbers, that of the study where None; the same gives the same result.
    progress : see `OnGeneration`.
    compute : computes designs instead of the study's own evaluator.
    workers : processes that compute what no loop does, where that takes more than some seconds; as
        many as this machine has processors if not given.
    cluster : address of a Dask scheduler whose workers compute instead, such as
        ``tcp://192.168.0.7:8786``.

    Raises
    ------
    ModelError : the study has nothing to search; `where` is its key.
    UsageError : population or generations cannot be used, or no design keeps the limits.
    """
    _check(study)
    population, generations = search_size(study, population, generations)
    if not LEAST_POPULATION <= population <= MOST_POPULATION:
        most = f"{LEAST_POPULATION} to {MOST_POPULATION}"
        raise UsageError(
            Note("got a population of {population}; give {most}", population=population, most=most)
        )
    if not 1 <= generations <= MOST_GENERATIONS:
        raise UsageError(
            Note(
                "got {generations} generations; give 1 to {most_generations}",
                generations=generations,
                most_generations=MOST_GENERATIONS,
            )
        )
    seed = study.sampling.seed if seed is None else seed
    with ExitStack() as exitstack:
        evaluate = compute or exitstack.enter_context(
            pooled(study, workers, cluster, population * generations)
        )
        return _search(_Archive(study, evaluate), population, generations, seed, progress)


def _search(
    archive: _Archive, population: int, generations: int, seed: int, progress: OnGeneration | None
) -> Searched:
    problem = _StudyProblem(archive, population, generations, seed, progress or (lambda *_: None))
    solution = solve(problem)
    best = archive.rows(problem.values_of(solution.places))
    result = _result(archive, problem.volumes, archive.some_of_front(best, population), seed)
    ended = len(problem.volumes.fronts) < generations or problem.is_still
    still = ended or solution.proof is not None
    return replace(result, solver=solution.solver, proof=solution.proof, stood_still=still)


class _StudyProblem(DesignProblem):
    """A study to search; each call of `evaluate` is a generation."""

    solvers = SOLVERS

    def __init__(
        self,
        archive: _Archive,
        population: int,
        generations: int,
        seed: int,
        progress: OnGeneration,
    ) -> None:
        self.archive, self.progress, self.volumes = archive, progress, Hypervolumes()
        self.population, self.generations, self.seed = population, generations, seed
        self.objectives, self.limits = len(archive.makes), 1 + len(archive.limits)

    @property
    def spreads(self) -> list[Range | Choices]:
        spreads = (item.spread for item in self.archive.study.vary)
        return [spread for spread in spreads if isinstance(spread, Range | Choices)]

    @property
    def first(self) -> Array:
        """Evenly spread, with the model's own among them."""
        places, own = super().first, self.archive.study.own.tolist()
        at = [spread.place(number) for spread, number in zip(self.spreads, own, strict=True)]
        if all(place is not None for place in at):
            places[0] = at
        return self.canonical(places)

    @property
    def is_still(self) -> bool:
        return self.volumes.still

    def canonical(self, places: Array) -> Array:
        return canonical(self.archive.study, places)

    def values_of(self, places: Array) -> Array:
        return values_at(self.archive.study, self.canonical(places))

    def known(self, values: Array) -> Array:
        return self.archive.known(values)

    def evaluate(self, places: Array) -> tuple[Array, Array]:
        archive, volumes = self.archive, self.volumes
        rows = archive.rows(self.values_of(places))
        volumes.add(archive.costs[archive.front])
        done = len(volumes.fronts)
        self.progress(done, self.generations, len(archive.values), len(archive.front))
        return archive.costs[rows], archive.violations[rows]


def search_size(
    study: Study, population: int | None = None, generations: int | None = None
) -> tuple[int, int]:
    """Designs in a generation, and the most generations, of which either may be given.

    What is not given follows from the study's number of designs, which bounds the search: 100
    designs in a generation, or a tenth of all where that is less, and at most 200 generations.

    Raises
    ------
    ModelError : the study has too few designs for a generation.
    """
    if population is None and generations is None and study.size < LEAST_POPULATION:
        where = "vary" if study.sampling.method == "grid" else "sampling.designs"
        note = Note(
            "got {size} designs; give {least_population} or more for a search",
            size=study.size,
            least_population=LEAST_POPULATION,
        )
        raise ModelError(where, note)
    if population is None:
        few = study.size // FEWEST_GENERATIONS if generations is None else POPULATION
        population = max(LEAST_POPULATION, min(POPULATION, few))
    if generations is None:
        generations = max(1, min(GENERATIONS, study.size // max(population, 1)))
    return population, generations


def breeding_time(study: Study, population: int) -> float:
    """Time to breed a generation, s, without computing it: from a search of random figures."""
    random, moments = np.random.default_rng(0), list[float]()
    low = [-inf if output.at_least is None else output.at_least for output in study.outputs]
    high = [inf if output.at_most is None else output.at_most for output in study.outputs]

    def sample_outcome(values: Array) -> Outcome:
        figures = random.random((len(values), len(low))).clip(low, high)
        return Outcome(figures, np.zeros(len(values), np.uint8))

    def note(*_: int) -> None:
        moments.append(perf_counter())

    search(study, population=population, generations=TIMED, progress=note, compute=sample_outcome)
    return (moments[-1] - moments[0]) / max(len(moments) - 1, 1)


def _check(study: Study) -> None:
    for number, item in enumerate(study.vary, 1):
        if not isinstance(item.spread, Range | Choices):
            note = Note(
                "{path} has a tolerance, which cannot be chosen; a search takes a range or a list, "
                "and equipoise tolerance takes this",
                path=item.path,
            )
            raise ModelError(f"vary[{number}]", note)
    if study.correlations:
        raise ModelError("correlations", Note("have no place in a search; leave them out"))
    if not study.objectives:
        note = Note('no output is an objective; give one of them make = "smallest"')
        raise ModelError("outputs", note)


def _result(archive: _Archive, volumes: Hypervolumes, reported: Array, seed: int) -> Searched:
    study, counts = archive.study, archive.outcome.counts
    if not len(archive.front):
        good = archive.outcome.figures[archive.outcome.computed]
        limits = np.sum(feasible(study.outputs, good), axis=0)
        raise UsageError(why_none(study.outputs, counts, limits))
    order = reported[np.lexsort(archive.costs[reported].T[::-1])]
    makes = {output.name: output.make for output in study.objectives if output.make}
    return Searched(
        study=study,
        front=len(archive.front),
        objectives=makes,
        values=archive.values[order],
        figures=archive.outcome.figures[order],
        computed=len(archive.values),
        failures=failures(counts),
        generations=len(volumes.fronts),
        stood_still=False,
        volumes=volumes.all * (archive.signs[0] if len(archive.signs) == 1 else 1),
        seed=seed,
        tried=DesignBlock(archive.values, archive.outcome),
    )


# -- what was computed -----------------------------------------------------------------------------


class _Archive:
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
        self.limits = [
            (k, limit, sign)
            for k, output in enumerate(study.outputs)
            for limit, sign in ((output.at_least, -1.0), (output.at_most, 1.0))
            if limit is not None
        ]
        self.costs = np.empty((0, len(self.makes)))
        self.violations = np.empty((0, 1 + len(self.limits)))
        self.front = np.empty(0, np.intp)
        self._ranges: Array | None = None

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
        return np.array([self.numbers[key] for key in keys], np.intp)

    def known(self, values: Array) -> Array:
        """Which of some designs (P, d) are here already, (P,)."""
        return np.array([key in self.numbers for key in _keys(values)], bool)

    def add(self, values: Array) -> None:
        result = self.compute(values)
        begin = len(self.values)
        self.values = np.concatenate([self.values, values])
        self.outcome = Outcome.joined([self.outcome, result])
        costs = np.where(result.computed[:, None], result.figures[:, self.makes] * self.signs, 0.0)
        self.costs = np.concatenate([self.costs, costs])
        beyond = (  # of each limit, over the range of the first figures
            np.where(result.computed, sign * (result.figures[:, k] - limit) / self.ranges[k], 0.0)
            for k, limit, sign in self.limits
        )
        violations = np.column_stack([VIOLATIONS[result.reason], *beyond])
        self.violations = np.concatenate([self.violations, violations])
        fine = begin + np.flatnonzero(np.all(violations <= 0, axis=1))
        known = np.concatenate([self.front, fine])
        self.front = known[non_dominated(self.costs[known])]

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
