"""The commands `sweep`, `resume` and `tolerance`: all designs of a study, computed."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any

from equipoise.cli.designs import own_of
from equipoise.cli.models import OpenedStore, StudyFile, TolerancedFile
from equipoise.cli.options import (
    Computers,
    Out,
    blaming_by_place,
    count,
)
from equipoise.cli.outputs import PlottedOutput
from equipoise.cli.progress import Watched, swept
from equipoise.cli.runner import CommandResult, command
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note, say
from equipoise.quantities.numbers import duration_text, rate_text

if TYPE_CHECKING:
    from equipoise.figures import Picture
    from equipoise.studies.blocks import Summary, Unit
    from equipoise.studies.outcomes import Progress
    from equipoise.studies.store import Store

MOST_DESIGNS = 10_000_000
LISTED_DESIGNS = 3
"""Designs at most that are listed in the end."""


@command(PlottedOutput, long=True)
def sweep(
    study: StudyFile, /, *, out: Out = None, computers: Computers = Computers()
) -> CommandResult:
    """Compute every design of a study into a store; an interrupted sweep can be resumed.

    Parameters
    ----------
    out
        The store, a new folder.
    """
    from equipoise.schema.study_units import units_of
    from equipoise.studies.run import sweep

    if not out:
        raise UsageError(
            at_place(
                "--out", Note("missing; say where the store is to be, such as -o designs.zarr")
            )
        )
    return _computed(partial(sweep, study, out, **vars(computers)), out, units_of(study))


@command(PlottedOutput, long=True)
def resume(store: OpenedStore, /, *, computers: Computers = Computers()) -> CommandResult:
    """Compute the designs that are missing in a store, and continue an interrupted sweep."""
    from equipoise.schema import study_units

    path = str(store.path)
    work = partial(study_units.resume, path, **vars(computers))
    return _computed(work, path, study_units.units_in(store))


def _computed(work: Callable[..., Store], path: str, units: dict[str, Unit]) -> CommandResult:
    """Compute with progress on standard error.

    work : computes a store, which is at the `path`, and reports its `progress`.
    """
    from equipoise.studies.blocks import summary_blocks

    last: list[Progress] = []
    with _going_on(path):
        with swept(units) as text:

            def show_progress(progress: Progress) -> None:
                last[:] = [progress]
                text(progress)

            store = work(progress=show_progress)
        (end,) = last
        summary = _summary(store, end)
    rate = rate_text(end.computed / max(end.seconds, 1e-9))
    run = (
        f", {duration_text(end.seconds)}, {rate}" if end.computed else say(", nothing was missing")
    )
    return CommandResult(
        lambda: summary_blocks(summary, units, run),
        lambda: _values(summary, end),
        title=summary.title,
        pictures=lambda: _charts(store, units),
        around=lambda: _going_on(path),
    )


def _charts(store: Store, units: dict[str, Unit]) -> Mapping[str, Picture]:
    """All designs, the best of them where the study has a word for that, and the model itself."""
    from equipoise.figures.studies import best_charts
    from equipoise.schema.study_units import owner_of
    from equipoise.studies.selection import best

    aimed = any(output.make for output in store.wishes)
    result = best(store, LISTED_DESIGNS, None if aimed else {store.outputs[0]: None}, nearest=True)
    owner = owner_of(store)
    own = None if owner is None else own_of(owner)
    return best_charts(result, store.title, units, store, own, aimed)


@contextmanager
def _going_on(store: str) -> Iterator[None]:
    """Print how to continue a sweep, if it is interrupted."""
    try:
        yield
    except KeyboardInterrupt:
        if not os.path.lexists(store):
            raise
        following = f"equipoise resume {quote(store)}"
        words = say("what is stored stays; continue with: {command}", command=following)
        raise KeyboardInterrupt(words) from None


def _summary(store: Store, last: Progress) -> Summary:
    """Counts and best designs, as far as the study has a word for what is best."""
    from equipoise.studies.blocks import Summary
    from equipoise.studies.selection import NothingBestError, best

    outputs, title = store.wishes, store.title
    aimed = any(output.make for output in outputs)
    try:
        result = best(store, LISTED_DESIGNS, None if aimed else {store.numbers[0]: None})
    except NothingBestError as error:  # no design keeps every limit, or none has figures
        return Summary(title, store, outputs, last.failures, 0, None, error.reason)
    feasible = result.kept
    return Summary(title, store, outputs, last.failures, feasible, result if aimed else None, "")


def _values(summary: Summary, last: Progress) -> dict[str, Any]:
    store = summary.store
    return {
        "title": summary.title,
        "store": str(store.path),
        "designs": store.size,
        "failures": dict(summary.failures),
        "kept": summary.kept,
        "seconds": last.seconds,
        "computed_now": last.computed,
        "best": None if summary.best is None else summary.best.to_dict(),
        "note": summary.note or None,
    }


# -- tolerances ------------------------------------------------------------------------------------


@command(PlottedOutput, long=True)
def tolerance(
    study: TolerancedFile,
    /,
    *,
    designs: Annotated[int | None, count(1, MOST_DESIGNS)] = None,
    computers: Computers = Computers(),
) -> CommandResult:
    """Effect of manufacturing tolerances on the figures of a machine, and which to tighten first.

    Parameters
    ----------
    designs
        Number of sampled machines, instead of that of the study.
    """
    from equipoise.figures.studies import tolerance_charts
    from equipoise.schema.study_units import units_of
    from equipoise.studies.tolerances import machines_of
    from equipoise.studies.tolerances import tolerance as of_study

    given: dict[tuple[str, ...], str] = {("sampling", "designs"): "--designs"}
    if designs is not None:
        study = replace(study, sampling=replace(study.sampling, designs=designs))
    units = units_of(study)
    with (
        blaming_by_place({} if designs is None else given),
        swept(units) as text,
        Watched(study, text, computers, machines_of(study)) as watched,
    ):
        result = of_study(study, progress=watched.show_progress, compute=watched)
    return CommandResult(
        lambda: result.blocks(units=units),
        result.to_dict,
        study,
        pictures=lambda: tolerance_charts(result, units),
    )
