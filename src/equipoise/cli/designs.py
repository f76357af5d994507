"""The commands `best` and `search`: designs of a study, the best first."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any

from equipoise.cli.models import OpenedStore, StudyFile
from equipoise.cli.options import Computers, NameList, count
from equipoise.cli.outputs import Chosen, CsvColumns, Outputs, check_new, write_model
from equipoise.cli.progress import Watched, swept
from equipoise.cli.runner import CommandResult, command
from equipoise.i18n import Note

if TYPE_CHECKING:
    from equipoise.figures import Picture
    from equipoise.signals import Array
    from equipoise.studies.study import Study


MOST_LISTED, MOST_SEED = 100_000, 2**32 - 1


@command(Outputs)
def best(
    store: OpenedStore,
    /,
    *,
    by: NameList = None,
    largest: NameList = None,
    most: Annotated[int, count(1, MOST_LISTED, "--count")] = 10,
    chosen: Chosen = Chosen(),
    outputs: Outputs,
) -> CommandResult:
    """Best designs of a store within all limits; for several objectives, the Pareto front.

    Parameters
    ----------
    by
        Output or varied number to rank by, instead of the objectives of the study; smallest first
        unless the study says otherwise.  May be repeated.
    largest
        Output or varied number to rank by, largest first.  May be repeated.
    most
        Largest number of designs to list.
    """
    from equipoise.figures.studies import best_charts
    from equipoise.schema.study_units import machine_of, owner_of, study_of, units_in
    from equipoise.studies import selection as of_stores
    from equipoise.studies.blocks import columns_of

    chosen.check(0, store.size - 1)
    if chosen.out is not None:
        check_new(study_of(store).model.base(), chosen.out)
    ways: Any = dict.fromkeys(by or ()) | dict.fromkeys(largest or (), "largest")
    result = of_stores.best(store, most, ways, nearest=outputs.plot is not None)
    first = int(result.designs[0]) if chosen.design is None else chosen.design
    model = None if chosen.out is None else machine_of(store, first)
    title, units = store.title, units_in(store)

    def charts() -> Mapping[str, Picture]:
        owner = owner_of(store)
        own = None if owner is None else own_of(owner)
        return best_charts(result, title, units, store, own)

    columns = columns_of(result.numbers, result.values, result.outputs, result.figures)
    source = Note('the study "{title}"', title=title)
    return CommandResult(
        lambda: result.blocks(outputs=store.wishes, units=units),
        lambda: {"title": title, **result.to_dict()},
        title=title,
        columns=lambda: _columns(result.designs, columns, store.units),
        pictures=charts,
        save=lambda: _save(model, chosen.out, first, source),
    )


@command(Outputs, long=True)
def search(
    study: StudyFile,
    /,
    *,
    population: Annotated[int | None, count(8, 100_000)] = None,
    generations: Annotated[int | None, count(1, 100_000)] = None,
    seed: Annotated[int | None, count(0, MOST_SEED)] = None,
    computers: Computers = Computers(),
    chosen: Chosen = Chosen(),
) -> CommandResult:
    """Optimize the designs of a study; for several objectives, find the Pareto front.

    Parameters
    ----------
    population
        Designs in a generation.  Default: 100, or a tenth of the designs of the study.
    generations
        Largest number of generations.  Default: as many as the designs of the study make, at most
        200. The search ends when it has converged.
    seed
        Seed of the random numbers.  Default: that of the study.  The same seed gives the same
        designs.
    """
    from equipoise.figures.studies import searched_charts
    from equipoise.schema.study_units import units_of
    from equipoise.studies.blocks import columns_of
    from equipoise.studies.searching import search, search_size

    if chosen.out is not None:
        check_new(study.model.base(), chosen.out)
    size, turns = search_size(study, population, generations)
    units = units_of(study)
    with swept(units) as text, Watched(study, text, computers, size * turns) as watched:
        result = search(
            study,
            population=size,
            generations=turns,
            seed=seed,
            progress=watched.show_progress,
            compute=watched,
        )
    chosen.check(0, len(result.values) - 1)
    number, made_of = chosen.design or 0, result.study
    model = None if chosen.out is None else result.machine(number)
    own = cache(lambda: own_of(made_of))
    columns = columns_of(made_of.paths, result.values, made_of.names, result.figures)
    source = Note(
        'a search of the study "{title}", seed {seed}', title=made_of.title, seed=result.seed
    )
    return CommandResult(
        lambda: result.blocks(units=units, own=own()),
        result.to_dict,
        made_of,
        columns=lambda: _columns(range(len(result.values)), columns, _si_units(made_of)),
        pictures=lambda: searched_charts(result, units, own()),
        save=lambda: _save(model, chosen.out, number, source),
    )


def own_of(study: Study) -> tuple[Array, Array] | None:
    """Values and figures of the model itself, for comparison; None where it cannot be computed."""
    from equipoise.codegen.figures import COMPUTED
    from equipoise.studies.evaluate import evaluator

    outcome = evaluator(study)(study.own[None])
    return (study.own, outcome.figures[0]) if outcome.reason[0] == COMPUTED else None


def _save(model: Any, out: str | None, number: int, of: Note) -> list[str]:
    """Write a design as a new model, where that is wanted."""
    if out is None:
        return []
    origin = Note("Design {number} of {of}.", number=number, of=of)
    return write_model(model, out, Note(", design {number}", number=number), origin.localized)


def _columns(
    designs: Iterable[int], columns: Mapping[str, Array], units: Mapping[str, str]
) -> CsvColumns:
    """Columns of designs as name, unit and values; the form is that of `export`."""
    import numpy as np

    items = [(name, units.get(name) or "", values) for name, values in columns.items()]
    return [("design", "", np.array([*designs])), *items]


def _si_units(study: Study) -> dict[str, str]:
    """SI unit of each number and output that has one, as in a store."""
    from equipoise.quantities import SI

    kinds: dict[str, Any] = {item.path: item.dimension for item in study.vary}
    kinds |= {output.name: output.dimension for output in study.outputs}
    return {name: SI[kind] for name, kind in kinds.items() if kind}
