"""The command `search`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from equipoise.cli.app import OUT, SIGNED, STUDY, app
from equipoise.cli.options import (
    check_belonging,
    check_folder,
    check_result_file,
    naming,
    whole,
)
from equipoise.cli.results import Kind, draw
from equipoise.errors import UsageError

if TYPE_CHECKING:
    import numpy as np

    from equipoise.schema.study_units import Unit
    from equipoise.studies.search import Searched
    from equipoise.studies.study import Study

Own = tuple["np.ndarray[Any, Any]", "np.ndarray[Any, Any]"]
MOST_SEED = 2**32 - 1


@app.command
def search(
    study: Annotated[str, STUDY],
    /,
    *,
    population: Annotated[str | None, SIGNED] = None,
    generations: Annotated[str | None, SIGNED] = None,
    seed: Annotated[str | None, SIGNED] = None,
    out: Annotated[str | None, OUT] = None,
    design: Annotated[str | None, SIGNED] = None,
    json: bool = False,
    csv: str | None = None,
    plot: str | None = None,
    format: Kind | None = None,
) -> None:
    """Look for the best designs of a study; of several aims, those that no other beats.

    Parameters
    ----------
    study
        Path of a study file, or the name of a bundled example.
    population
        Designs in a generation, 100 if not given.
    generations
        Most generations, 200 if not given; the search ends where nothing gets better any more.
    seed
        Of the random numbers, that of the study if not given; the same gives the same designs.
    out
        Write the first of the designs as a new model file.
    design
        With --out: number of another design to write.
    json
        Print one JSON object in SI units, and nothing else.
    csv
        Write the designs to this file, in SI units.
    plot
        Draw the designs, and how the search went, into this folder.
    format
        With --plot: kind of the pictures, svg if not given.
    """
    from equipoise.schema.studies import load_study
    from equipoise.schema.study_units import units_of

    check_belonging("--out", out, design=design)
    check_belonging("--plot", plot, format=format)
    asked = load_study(study)
    number = 0 if design is None else whole("--design", design, 0, 100_000)
    if csv is not None:
        check_result_file("--csv", csv, [study], [] if out is None else [out])
    if plot is not None:
        check_folder("--plot", plot)
    if out is not None:
        from equipoise.cli.designs import check_model_out

        check_model_out(asked.model.base(), out)
    units = units_of(asked)
    options = _options(population, generations, seed)
    with naming(study):
        found = _found(asked, units, options)
        most = len(found.values) - 1
        if number > most:
            raise UsageError(f"--design: got {number}; give a whole number from 0 to {most}")
        own = _own(found.study) if plot is not None or not json else None
        if plot is not None:
            from equipoise.plotting.studies import searched_drawings

            draw(searched_drawings(found, units, own), plot, format or "svg")
        _give(found, units, own, json, csv)
    if out is not None:
        _save(found, number, out)


def _options(population: str | None, generations: str | None, seed: str | None) -> dict[str, int]:
    """Those that were given, as whole numbers."""
    from equipoise.studies.search import LEAST_POPULATION, MOST_GENERATIONS, MOST_POPULATION

    given = {
        "population": (population, LEAST_POPULATION, MOST_POPULATION),
        "generations": (generations, 1, MOST_GENERATIONS),
        "seed": (seed, 0, MOST_SEED),
    }
    return {
        name: whole(f"--{name}", text, least, most)
        for name, (text, least, most) in given.items()
        if text is not None
    }


def _found(study: Study, units: dict[str, Unit], options: dict[str, int]) -> Searched:
    from equipoise.cli.progress_studies import Watched, swept
    from equipoise.studies.search import GENERATIONS, POPULATION, search_designs

    most = options.get("population", POPULATION) * options.get("generations", GENERATIONS)
    given: Any = options
    with swept(units) as told:
        watched = Watched(study, told)
        return search_designs(
            study, progress=lambda *_: watched.tell(most), compute=watched, **given
        )


def _give(
    found: Searched, units: dict[str, Unit], own: Own | None, json: bool, csv: str | None
) -> None:
    if csv is not None:
        from equipoise.cli.designs import si_units, write_designs
        from equipoise.terminal.designs import columns_of

        study = found.study
        columns = columns_of(study.paths, found.values, study.names, found.figures)
        write_designs(csv, range(len(found.values)), columns, si_units(study))
    if json:
        from equipoise.schema.output import json_text

        print(json_text(found.to_dict()))
    else:
        from equipoise.terminal.search import print_searched

        print_searched(found, units, own)


def _own(study: Study) -> Own | None:
    """Values and figures of the model itself, for comparison; None where it cannot be computed."""
    import numpy as np

    from equipoise.codegen.figures import COMPUTED
    from equipoise.studies.evaluate import evaluator

    values = np.array([study.model.number(path)[0] for path in study.paths], dtype=float)
    outcome = evaluator(study)(values[None])
    return (values, outcome.figures[0]) if outcome.reason[0] == COMPUTED else None


def _save(found: Searched, number: int, out: str) -> None:
    from equipoise.cli.designs import save_design

    of = f'a search of the study "{found.study.title}", seed {found.seed}'
    save_design(found.machine(number), out, number, of)
