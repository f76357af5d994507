"""The command `tolerance`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

from equipoise.cli.app import SIGNED, STUDY, app
from equipoise.cli.options import naming, whole
from equipoise.errors import ModelError, UsageError

if TYPE_CHECKING:
    from equipoise.io.study_units import Unit
    from equipoise.studies.study import Study
    from equipoise.studies.tolerance import Tolerances

MOST_DESIGNS = 10_000_000


@app.command
def tolerance(
    study: Annotated[str, STUDY],
    /,
    *,
    designs: Annotated[str | None, SIGNED] = None,
    json: bool = False,
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
    """
    from equipoise.io.studies import load_study
    from equipoise.io.study_units import units_of

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
    if json:
        from equipoise.io.output import json_text

        print(json_text(found.to_dict()))
    else:
        from equipoise.terminal.tolerance import print_tolerances

        print_tolerances(found, units)


def _found(study: Study, units: dict[str, Unit]) -> Tolerances:
    from equipoise.cli.progress_studies import Watched, swept
    from equipoise.studies.tolerance import tolerance as of_study

    with swept(units) as told:
        watched = Watched(study, told)
        return of_study(study, progress=lambda _, total: watched.tell(total), compute=watched)
