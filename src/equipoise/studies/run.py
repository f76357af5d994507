"""A study from its first design to its last, into a store that is made for it."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from json import dumps, loads
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from equipoise.atomic_files import make_folder, temporary_name
from equipoise.codegen.figures import REASONS
from equipoise.design.evaluator import Runner, StoppedError
from equipoise.design.variables import Choices
from equipoise.errors import UsageError, at_place, needed
from equipoise.fence import place_of
from equipoise.folders import Folder
from equipoise.i18n import Note
from equipoise.quantities import SI
from equipoise.studies.clusters import elsewhere
from equipoise.studies.evaluate import evaluator
from equipoise.studies.outcomes import DesignBlock, Progress, Tally
from equipoise.studies.store import (
    ABOUT,
    CHECKSUM,
    LAYOUT,
    MARK,
    NUMBERS,
    REASON,
    UNKNOWN,
    ZSTD,
    DamagedError,
    Store,
    as_usage_error,
    brief,
    checksum_of,
    open_store,
    versions,
)
from equipoise.studies.study import SLOW_CHUNK, samples

if TYPE_CHECKING:
    from equipoise.quantities import Dimension
    from equipoise.studies.study import Study

OnProgress = Callable[[Progress], None]
"""Is called at the beginning, and with every chunk that is stored."""
SHARED, SLOW_SHARED = 16, 64
"""Chunks of a small study, so that every worker has some: of compiled, and of slow designs."""
LEAST_CHUNK = 8192
"""Compiled designs, fewer of which cost more time each."""


def sweep(
    study: Study,
    path: str | os.PathLike[str],
    *,
    workers: int | None = None,
    cluster: str | None = None,
    progress: OnProgress | None = None,
) -> Store:
    """Compute all designs of a study, and store them.

    Parameters
    ----------
    path : of the new store.
    workers : threads or processes on this machine; as many as it has processors if not given.
    cluster : address of a Dask scheduler whose workers compute instead, such as
        ``tcp://192.168.0.7:8786``.
    progress : called with the progress.

    Raises
    ------
    ModelError : the outputs of the study cannot be computed.
    UsageError : there is something at `path`, or an argument cannot be used; or the sweep had to
        stop: then what is stored by then stays, and `resume` goes on.
    """
    route = Route(study)
    with _runner(route, workers, cluster) as runner:
        store = create_store(path, study, route.chunk, route.engine)
        _fill(store, study, runner, progress)
    return store


def resume(
    path: str | os.PathLike[str],
    restore: Callable[[Mapping[str, str]], Study],
    *,
    workers: int | None = None,
    cluster: str | None = None,
    progress: OnProgress | None = None,
) -> Store:
    """Compute what is missing in a store; the same bytes as if nothing had ever stopped.

    Where nothing is missing, nothing is done but to report progress.

    Parameters
    ----------
    restore : makes the study of its texts; `equipoise.schema.studies.restore`.
    workers, cluster, progress : as in `sweep`.

    Raises
    ------
    UsageError : there is no store, or other versions made it; or as in `sweep`.
    """
    store = open_store(path)
    study = restore(store.texts)
    if study.size != store.size:  # of a grid, which only the study itself can count
        raise UsageError(
            at_place(
                store.path,
                Note(
                    "has places for {size} designs, and its study has {size_2}; it was "
                    "changed, sweep anew",
                    size=store.size,
                    size_2=study.size,
                ),
            )
        )
    tally, missing = _counted(store, study)
    if not missing:
        with suppress(UsageError), store.writing():  # clears what a killed process left
            pass
        if progress is not None:
            progress(tally.progress())
        return store
    route = Route(study)
    _check_same(store, route.engine)
    with _runner(route, workers, cluster) as runner:
        _fill(store, study, runner, progress)
    return store


def _fill(
    store: Store, study: Study, runner: Runner[range, DesignBlock], progress: OnProgress | None
) -> None:
    """Compute and store what is missing or damaged."""
    with store.writing():
        tally, missing = _counted(store, study)
        report = progress or (lambda _: None)
        report(tally.progress())
        try:
            for designs, block in runner.each(map(store.designs, missing)):
                _store(store, designs, block)
                tally.add(block, computed=True)
                report(tally.progress())
        except StoppedError as error:
            raise UsageError(
                at_place(
                    store.path,
                    Note(
                        "{error}; {done} of {size} designs are stored, go on with the others by: "
                        "equipoise resume {path}",
                        error=error.note,
                        done=tally.done,
                        size=store.size,
                        path=store.path,
                    ),
                )
            ) from error


def _store(store: Store, designs: range, block: DesignBlock) -> None:
    try:
        store.write(designs, block)
    except OSError as error:
        if not os.path.lexists(store.path):
            raise UsageError(
                at_place(
                    store.path, Note("the folder has gone, and what was stored with it; sweep anew")
                )
            ) from error
        raise StoppedError(
            Note("designs cannot be written ({brief}); make room or mend that", brief=brief(error))
        ) from error


def _counted(store: Store, study: Study) -> tuple[Tally, list[int]]:
    """The sums over what is stored already, and the chunks that are not, or are damaged."""
    tally = Tally(study.outputs, store.size)
    missing = store.missing()
    for chunk in sorted({*range(store.chunks)}.difference(missing)):
        try:
            tally.add(store.read(store.designs(chunk)), computed=False)
        except DamagedError:
            missing.append(chunk)
    return tally, sorted(missing)


def _check_same(store: Store, engine: str) -> None:
    here = {**versions(), "engine": engine}
    for name, wanted in {**store.versions, "engine": store.engine}.items():
        result = here.get(name, "none")
        if result != wanted:
            raise UsageError(
                at_place(
                    store.path,
                    Note(
                        "was begun with {name} {wanted}, and here is {name} {given}, with which "
                        "the last digits may differ; install what it was begun with, or sweep "
                        "anew",
                        name=name,
                        wanted=wanted,
                        given=result,
                    ),
                )
            )


# -- how a study is computed -----------------------------------------------------------------------


class Route:
    """Draws designs of a study by their numbers, and computes them.

    compiled : whether they are computed without holding Python's lock, so that threads are enough.
    engine : name of what computes them.
    chunk : designs that are computed and stored together.
    """

    def __init__(self, study: Study) -> None:
        self.study = study
        self.evaluate = evaluator(study, threads=1)  # other threads have chunks of their own
        self.compiled: bool = getattr(self.evaluate, "compiled", False)
        self.engine: str = getattr(self.evaluate, "engine", "general")
        self.chunk = chunk_of(study, self.compiled)

    def __call__(self, designs: range) -> DesignBlock:
        values = samples(self.study, designs.start, len(designs))
        return DesignBlock(values, self.evaluate(values))


def _runner(route: Route, workers: int | None, cluster: str | None) -> Runner[range, DesignBlock]:
    make, threads = partial(Route, route.study), route.compiled
    return Runner(route, make, workers, threads=threads, elsewhere=elsewhere(cluster, workers))


def chunk_of(study: Study, compiled: bool) -> int:
    """Designs that are stored together: of slow ones as many as take some seconds."""
    if compiled:
        most = NUMBERS // len(study.paths + study.names)
        return min(study.chunk, study.size, most, max(LEAST_CHUNK, -(-study.size // SHARED)))
    return min(study.chunk, SLOW_CHUNK, -(-study.size // SLOW_SHARED))


def create_store(path: str | os.PathLike[str], study: Study, chunk: int, engine: str) -> Store:
    """Make a store without designs.

    chunk : designs that are computed and stored together.
    engine : name of what computes them.

    Raises
    ------
    UsageError : there is something at `path`, or the folder cannot be made.
    """
    target = Path(path)
    if os.path.lexists(target):
        raise UsageError(
            at_place(
                target,
                Note(
                    "is there already; choose another name, or go on with a store by: "
                    "equipoise resume {target}",
                    target=target,
                ),
            )
        )
    # Made beside its place, so that a store is a whole one from the moment it is there.
    with as_usage_error(
        target, Note("the store cannot be made"), Note("choose another place or name")
    ):
        make_folder(target.parent)
        above, name = place_of(target)
        with temporary_name(above, name) as begun:
            _write_empty(above.make(begun), study, chunk, engine)
            above.rename(begun, name)
    return open_store(target)


def _write_empty(folder: Folder, study: Study, chunk: int, engine: str) -> None:
    """Write what a store says of itself, and folders for its chunks."""
    files = _described(study, chunk, engine)
    content = loads(files[ABOUT])
    content["attributes"][CHECKSUM] = checksum_of(content)
    files[ABOUT] = dumps(content, ensure_ascii=False, indent=2).encode()
    for name, data in files.items():
        *array, file = name.split("/")
        below = folder
        for part in array:
            below = below.subfolder(part)
        below.put(file, data)
        if array:
            below.subfolder("c")


def _described(study: Study, chunk: int, engine: str) -> dict[str, bytes]:
    """The files of a store without chunks, by name, as Zarr writes them, which it does nowhere."""
    zarr = needed("zarr", "a store")
    packing, checksum = [zarr.codecs.ZstdCodec(level=ZSTD)], zarr.codecs.Crc32cCodec()
    files: dict[str, Any] = {}
    memory = zarr.storage.MemoryStore(files)
    group = zarr.create_group(memory, zarr_format=3, attributes=_about(study, chunk, engine))

    def add(name: str, kind: str, none: float, compressed: bool, attributes: Any) -> None:
        group.create_array(
            name,
            shape=(study.size,),
            chunks=(chunk,),
            dtype=kind,
            fill_value=none,
            compressors=[*packing, checksum] if compressed else [checksum],
            dimension_names=("design",),
            attributes=attributes,
        )

    for item in study.vary:
        # All but those that repeat are random in most of their digits: compressing them by a
        # tenth would take as long again as storing them.
        repeated = study.sampling.method == "grid" or isinstance(item.spread, Choices)
        add(item.path, "float64", nan, repeated, _unit(item.dimension))
    for output in study.outputs:
        add(output.name, "float64", nan, False, _unit(output.dimension))
    meanings = {**REASONS, UNKNOWN: "not computed yet"}
    flags = {
        "flag_values": list(meanings),
        "flag_meanings": " ".join(words.replace(" ", "_") for words in meanings.values()),
    }
    add(REASON, "uint8", UNKNOWN, True, flags)
    with warnings.catch_warnings():  # that not every reader knows of a list of all arrays
        warnings.simplefilter("ignore")
        zarr.consolidate_metadata(memory)
    return {name: data.to_bytes() for name, data in files.items()}


def _unit(dimension: str | None) -> dict[str, str]:
    return {"units": SI[cast("Dimension", dimension)]} if dimension else {}


def _about(study: Study, chunk: int, engine: str) -> dict[str, Any]:
    return {
        MARK: LAYOUT,
        "title": study.title,
        "method": study.sampling.method,
        "seed": study.sampling.seed,
        "chunk": chunk,
        "engine": engine,
        "numbers": list(study.paths),
        "outputs": list(study.names),
        # Texts, because other formats than Zarr hold nothing else.
        "versions": dumps(versions()),
        "study": dumps(study.texts, ensure_ascii=False),
    }
