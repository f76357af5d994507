"""A new store: its folder with everything but the designs."""

from __future__ import annotations

import os
import platform
import shutil
import sys
import warnings
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from json import dumps
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import equipoise
from equipoise.codegen.figures import REASONS
from equipoise.errors import UsageError
from equipoise.studies.extras import needed
from equipoise.studies.spread import Choices
from equipoise.studies.store import LAYOUT, REASON, UNKNOWN, ZSTD, Store, open_store, told
from equipoise.studies.units import SI

if TYPE_CHECKING:
    from equipoise.studies.study import Study


@cache
def versions() -> dict[str, str]:
    """What the last digit of a figure may depend on."""
    found = {"equipoise": equipoise.__version__}
    for library in ("numpy", "scipy", "numba"):
        try:
            found[library] = version(library)
        except PackageNotFoundError:
            found[library] = "none"
    python = ".".join(map(str, sys.version_info[:2]))
    return {**found, "python": python, "processor": platform.machine()}


def create(path: str | os.PathLike[str], study: Study, chunk: int, engine: str) -> Store:
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
            f"{target}: is there already; choose another name, or go on with a store by: "
            f"equipoise resume {target}"
        )
    # Made beside its place, so that a store is a whole one from the moment it is there.
    begun = target.with_name(f".{target.name}.{os.getpid()}.tmp")
    try:
        with told(target, "the store cannot be made", "choose another place or name"):
            target.parent.mkdir(parents=True, exist_ok=True)
            _make(begun, study, chunk, engine)
            os.rename(begun, target)
    finally:
        shutil.rmtree(begun, ignore_errors=True)
    return open_store(target, write=True)


def _make(folder: Path, study: Study, chunk: int, engine: str) -> None:
    zarr = needed("zarr", "a store")
    group = zarr.create_group(folder, zarr_format=3, attributes=_about(study, chunk, engine))

    def add(name: str, kind: str, none: float, compressed: bool, attributes: Any) -> None:
        group.create_array(
            name,
            shape=(study.size,),
            chunks=(chunk,),
            dtype=kind,
            fill_value=none,
            compressors=zarr.codecs.ZstdCodec(level=ZSTD) if compressed else None,
            dimension_names=("design",),
            attributes=attributes,
        )
        (folder / name / "c").mkdir()

    for one in study.vary:
        # All but those that repeat are random in most of their digits: compressing them by a
        # tenth would take as long again as storing them.
        repeated = study.sampling.method == "grid" or isinstance(one.spread, Choices)
        add(one.path, "float64", nan, repeated, _unit(one.dimension))
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
        zarr.consolidate_metadata(folder)


def _unit(dimension: str | None) -> dict[str, str]:
    return {"units": SI[dimension]} if dimension else {}


def _about(study: Study, chunk: int, engine: str) -> dict[str, Any]:
    return {
        "equipoise_store": LAYOUT,
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
