"""Loops that run: compiled by Numba and kept on disk, or done by NumPy where Numba is missing.

A source is written to a file whose name tells its content and that of the kernels, because the
cache of compiled code looks at that file alone.
"""

from __future__ import annotations

import atexit
import hashlib
import importlib.util
import inspect
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from threading import Lock
from types import ModuleType
from typing import Any

import numpy as np

from equipoise.fused import unfused
from equipoise.fused.source import Source
from equipoise.mechanism import kernels

Array = np.ndarray[Any, Any]
Loop = Callable[[Array, Array, Array], None]
"""Is called with table (P, T), grid (G, N) and what it fills, (P, R); it lets other threads run."""

INLINE = {"forceinline": True, "fastmath": True, "error_model": "numpy"}
SIGNATURE = "void(float64[:, ::1], float64[:, ::1], float64[:, ::1])"
FOLDER = "EQUIPOISE_CACHE"
"""Variable of the environment with the folder for compiled loops."""
NOTICE = (
    "Numba is not installed, so designs are computed by NumPy, which takes ten to thirty times as "
    'long; install it by: pip install "equipoise[studies]"'
)


@cache
def engine() -> str:
    """What runs loops here: ``numba`` or ``numpy``; says so, once, where it is the slow one."""
    if importlib.util.find_spec("numba") is not None:
        return "numba"
    print(f"equipoise: {NOTICE}", file=sys.stderr)
    return "numpy"


def loop_of(text: str) -> tuple[Loop | None, ModuleType]:
    """The compiled loop of a source, None without Numba, and the module of the source."""
    with _one_at_a_time:
        return _loop_of(text)


_one_at_a_time = Lock()


@cache
def _loop_of(text: str) -> tuple[Loop | None, ModuleType]:
    path = _file_of(text)
    module = _imported(f"equipoise_{path.stem}", path)
    if engine() == "numpy":
        vars(module).update(_kernels_of(kernels), **vars(unfused.SUPPORT))
        return None, module
    from equipoise.fused import support

    vars(module).update(_compiled_kernels(), **support.compiled())
    return _compiled(module), module


def run(source: Source, table: Array, grid: Array) -> Array:
    """What a loop gathers (P, R) of designs (P, T) over a grid (G, N)."""
    loop, module = loop_of(source.text)
    if loop is None:
        return unfused.run(source, module.state, table, grid)
    out = np.empty((len(table), source.width))
    loop(table, grid, out)
    return out


def _compiled(module: ModuleType) -> Loop:
    """Compile a module's loop, or take it from the cache."""
    import numba

    vars(module)["state"] = numba.njit(**INLINE)(module.state)
    options = {"nogil": True, "fastmath": True, "error_model": "numpy"}
    try:
        return numba.njit(SIGNATURE, cache=True, **options)(module.loop)  # type: ignore[no-any-return]
    except (OSError, RuntimeError):  # no place for the cache: compile for this run alone
        return numba.njit(SIGNATURE, **options)(module.loop)  # type: ignore[no-any-return]


@cache
def _compiled_kernels() -> dict[str, Any]:
    """The kernels, loaded a second time and compiled to be taken into loops."""
    import numba

    module = _imported("equipoise_compiled_kernels", Path(inspect.getfile(kernels)))
    for name, kernel in _kernels_of(module).items():
        vars(module)[name] = numba.njit(**INLINE)(kernel)
    return {name: vars(module)[name] for name in _kernels_of(kernels)}


def _kernels_of(module: ModuleType) -> dict[str, Any]:
    return {name: found for name, found in vars(module).items() if inspect.isfunction(found)}


# -- files -----------------------------------------------------------------------------------------


def _file_of(text: str) -> Path:
    """The file of a source, written whole or not at all."""
    from equipoise.fused import support

    here = sys.modules[__name__]
    parts = (text, *map(inspect.getsource, (kernels, support, here)))
    key = hashlib.sha256("\0".join(parts).encode()).hexdigest()[:20]
    for folder in _folders():
        path = folder / f"loop_{key}.py"
        try:
            if not path.exists():
                folder.mkdir(parents=True, exist_ok=True)
                handle, name = tempfile.mkstemp(dir=folder, suffix=".tmp")
                with os.fdopen(handle, "w", encoding="utf-8") as file:
                    file.write(text)
                os.replace(name, path)
        except OSError:
            continue
        return path
    raise AssertionError("a new temporary folder can be written to")


def _folders() -> Iterator[Path]:
    """Where loops may be kept, the best place first; the last is for this process alone."""
    own = os.environ.get(FOLDER)
    if own:
        yield Path(own)
    else:
        from platformdirs import user_cache_path

        yield user_cache_path("equipoise", appauthor=False) / "loops"
    last = tempfile.mkdtemp(prefix="equipoise-")
    atexit.register(shutil.rmtree, last, ignore_errors=True)
    yield Path(last)


def _imported(name: str, path: Path) -> ModuleType:
    """A file as a module of its own, which compiled code from the cache looks for by its name."""
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None and spec.loader is not None
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
