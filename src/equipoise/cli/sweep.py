"""The commands `sweep` and `resume`."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any

from equipoise.cli.app import OUT, SIGNED, STORE, STUDY, app
from equipoise.cli.options import naming, whole
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from equipoise.schema.study_units import Unit
    from equipoise.studies.outcomes import Progress
    from equipoise.studies.store import Store
    from equipoise.terminal.swept import Summary

MOST_WORKERS = 1000
TOLD = 3
"""Designs that are told in the end."""


@app.command
def sweep(
    study: Annotated[str, STUDY],
    /,
    *,
    out: Annotated[str | None, OUT] = None,
    workers: Annotated[str | None, SIGNED] = None,
    cluster: str | None = None,
    json: bool = False,
) -> None:
    """Compute every design of a study into a store, from which any interruption can be resumed.

    Parameters
    ----------
    study
        Path of a study file, or the name of a bundled example.
    out
        The store, a new folder.
    workers
        Threads or processes of this machine, one a processor if not given.
    cluster
        Address of a Dask scheduler whose workers compute instead, such as tcp://192.168.0.7:8786.
    json
        Print one JSON object in SI units, and nothing else.
    """
    from equipoise.schema.studies import load_study
    from equipoise.schema.study_units import units_of
    from equipoise.studies import run

    asked = load_study(study)
    if not out:
        raise UsageError("--out: missing; say where the store is to be, such as -o designs.zarr")
    count = _workers(workers, cluster)
    units = units_of(asked)
    with naming(study), _going_on(out):
        store, last = _told(
            units,
            lambda told: run.run_study(asked, out, workers=count, cluster=cluster, progress=told),
        )
        _give(store, last, units, json)


@app.command
def resume(
    store: Annotated[str, STORE],
    /,
    *,
    workers: Annotated[str | None, SIGNED] = None,
    cluster: str | None = None,
    json: bool = False,
) -> None:
    """Compute what is missing in a store, as if nothing had ever stopped.

    Parameters
    ----------
    store
        Path of a store, as `equipoise sweep` makes it.
    workers
        Threads or processes of this machine, one a processor if not given.
    cluster
        Address of a Dask scheduler whose workers compute instead, such as tcp://192.168.0.7:8786.
    json
        Print one JSON object in SI units, and nothing else.
    """
    from equipoise.schema import study_units
    from equipoise.schema.study_units import units_in
    from equipoise.studies.store import open_store

    count = _workers(workers, cluster)
    units = units_in(open_store(store))
    with _going_on(store):
        found, last = _told(
            units,
            lambda told: study_units.resume(store, workers=count, cluster=cluster, progress=told),
        )
        _give(found, last, units, json)


def _workers(workers: str | None, cluster: str | None) -> int | None:
    if cluster is not None and workers is not None:
        raise UsageError(
            "--workers belongs to this machine, and --cluster computes elsewhere; give one of them"
        )
    return None if workers is None else whole("--workers", workers, 1, MOST_WORKERS)


@contextmanager
def _going_on(store: str) -> Iterator[None]:
    """Tell whoever interrupts a sweep how it goes on."""
    try:
        yield
    except KeyboardInterrupt:
        if not os.path.lexists(store):
            raise
        words = f"what is stored stays; go on by: equipoise resume {quote(store)}"
        raise KeyboardInterrupt(words) from None


def _told(
    units: dict[str, Unit], work: Callable[[Callable[[Progress], None]], Store]
) -> tuple[Store, Progress]:
    """Compute with progress on standard error; returns how far it was in the end, too."""
    from equipoise.cli.progress_studies import swept

    last: list[Progress] = []

    with swept(units) as told:

        def tell(progress: Progress) -> None:
            last[:] = [progress]
            told(progress)

        store = work(tell)
    return store, last[0]


def _give(store: Store, last: Progress, units: dict[str, Unit], json: bool) -> None:
    summary = _summary(store, last)
    if json:
        from equipoise.schema.output import json_text

        print(json_text(_values(summary, last)))
    else:
        from equipoise.cli.progress_studies import rate_told, time_told
        from equipoise.terminal.swept import print_swept

        rate = rate_told(last.computed / max(last.seconds, 1e-9))
        run = f", {time_told(last.seconds)}, {rate}" if last.computed else ", nothing was missing"
        print_swept(summary, units, run)


def _summary(store: Store, last: Progress) -> Summary:
    """Counts and best designs, as far as the study has a word for what is best."""
    from equipoise.cli.designs import title_of
    from equipoise.studies.selection import best, outputs_of
    from equipoise.terminal.swept import Summary

    outputs = outputs_of(store)
    title = title_of(store)
    aimed = any(output.make for output in outputs)
    try:
        found = best(store, TOLD, None if aimed else {store.numbers[0]: None})
    except UsageError as error:  # no design keeps every limit, or none has figures
        note = str(error).removeprefix(f"{store.path}: ")
        return Summary(title, store, outputs, last.failures, 0, None, note)
    kept = found.kept
    return Summary(title, store, outputs, last.failures, kept, found if aimed else None, "")


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
