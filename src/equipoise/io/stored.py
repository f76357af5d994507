"""Stores and the studies in them: what takes a store and gives a machine, or goes on with it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING

from equipoise.codegen.figures import COMPUTED, REASONS
from equipoise.errors import UsageError
from equipoise.io.files import printable
from equipoise.io.studies import restore

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine
    from equipoise.studies.run import Told
    from equipoise.studies.store import Store
    from equipoise.studies.study import Study
    from equipoise.tools.model import Tool

__all__ = ["machine_of", "resume", "study_of"]


def resume(
    path: str | os.PathLike[str],
    *,
    workers: int | None = None,
    cluster: str | None = None,
    progress: Told | None = None,
) -> Store:
    """Compute what is missing in a store; the same bytes as if nothing had ever stopped.

    Where nothing is missing, nothing is done but telling the progress.

    Parameters
    ----------
    path : of the store.
    workers, cluster, progress : as in `equipoise.sweep`.

    Raises
    ------
    UsageError : there is no store, or other versions made it; or as in `equipoise.sweep`.
    """
    from equipoise.studies import run

    def restored(texts: Mapping[str, str]) -> Study:
        return _restored(texts, path)

    return run.resume(path, restored, workers=workers, cluster=cluster, progress=progress)


def study_of(store: Store) -> Study:
    """The study whose designs are in a store.

    Raises
    ------
    UsageError : it cannot be read any more.
    """
    return _restored(store.texts, store.path)


def machine_of(store: Store, design: int) -> Machine | Tool:
    """One design of a store as a machine or tool, exactly as it was computed.

    design : its number, from 0.

    Raises
    ------
    UsageError : there is no such design, or it failed; or the study cannot be read any more.
    """
    if not 0 <= design < store.size:
        raise UsageError(
            f"got design {design}; {printable(store.path)} has {store.size} designs, from 0"
        )
    block = store.read(range(design, design + 1))
    reason = int(block.outcome.reason[0])
    if reason != COMPUTED:
        why = REASONS.get(reason, "not computed yet")
        raise UsageError(f"design {design} has no figures ({why}); choose another")
    study = study_of(store)
    return study.model.machine(dict(zip(store.numbers, block.values[0].tolist(), strict=True)))


def _restored(texts: Mapping[str, str], path: str | os.PathLike[str]) -> Study:
    try:
        return restore(texts)
    except UsageError as error:
        raise UsageError(f"{printable(path)}: {error}") from error
