"""The command `tolerance`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

from equipoise.cli.app import SIGNED, STUDY, app
from equipoise.cli.options import check_belonging, check_folder, naming, whole
from equipoise.cli.results import Kind, draw
from equipoise.errors import ModelError, UsageError

if TYPE_CHECKING:
    from equipoise.schema.study_units import Unit
    from equipoise.studies.study import Study
    from equipoise.studies.tolerances import Tolerances

MOST_DESIGNS = 10_000_000


@app.command
def tolerance(
    study: Annotated[str, STUDY],
    /,
    *,
    designs: Annotated[str | None, SIGNED] = None,
    json: bool = False,
    plot: str | None = None,
    format: Kind | None = None,
) -> None:
    """What manufacturing tolerances do to the figures of a machine, and which to tighten first.

    Parameters
    ----------
    study
        Path of a study file whose numbers have tolerances, or the name of a bundled example.
    designs
        Machines that are drawn, instead of as many as the study has.
    json
        Print one JSON object in SI units, and nothing else.
    plot
        Draw the scatter of figures and what causes it into this folder.
    format
        With --plot: kind of the pictures, svg if not given.
    """
    from equipoise.schema.studies import load_study
    from equipoise.schema.study_units import units_of

    check_belonging("--plot", plot, format=format)
    if plot is not None:
        check_folder("--plot", plot)
    asked = load_study(study)
    if designs is not None:
        number = whole("--designs", designs, 1, MOST_DESIGNS)
        with naming(study):
            asked = replace(asked, sampling=replace(asked.sampling, designs=number))
    units = units_of(asked)
    with naming(study):
        try:
            found = _found(asked, units)
        except ModelError as error:
            if designs is None or error.where != "sampling.designs":
                raise
            raise UsageError(f"--designs: {error.what}") from error
    if plot is not None:
        from equipoise.plotting.studies import tolerance_drawings

        draw(tolerance_drawings(found, units), plot, format or "svg")
    if json:
        from equipoise.schema.output import json_text

        print(json_text(found.to_dict()))
    else:
        from equipoise.terminal.tolerance import print_tolerances

        print_tolerances(found, units)


def _found(study: Study, units: dict[str, Unit]) -> Tolerances:
    from equipoise.cli.progress_studies import Watched, swept
    from equipoise.studies.tolerances import tolerance as of_study

    with swept(units) as told:
        watched = Watched(study, told)
        return of_study(study, progress=lambda _, total: watched.tell(total), compute=watched)
