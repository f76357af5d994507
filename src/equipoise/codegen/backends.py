"""Loops that run: compiled by Numba and kept on disk, or done by NumPy where Numba is missing.

A source is written to a file whose name has a hash of its content and of this module's, because the
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
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from threading import Lock
from types import ModuleType
from typing import Any

import numpy as np

from equipoise.codegen.extremes import (
    HELPERS,
    SIGNATURES,
    CurveTops,
    columns_of,
    kernel_text,
)
from equipoise.codegen.figures import KINDS
from equipoise.codegen.source import LANES, TermSource
from equipoise.signals import Array

CompiledLoop = Callable[[Array, Array, Array, Array], None]
"""Is called with table (P, T), grid (G, N) and what it fills, (P, R) and, of signals whose extremes
are wanted, (P, S, N); it lets other threads run."""

SIGNATURE = "void(float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[:, :, ::1])"
FOLDER = "EQUIPOISE_CACHE"
"""Variable of the environment with the folder for compiled loops."""
NOTICE = (
    "Numba is not installed, so designs are computed by NumPy, which takes ten to thirty times as "
    'long; install it by: pip install "equipoise[studies]"'
)
SAMPLES_AT_ONCE = 65_536
"""Values of signals whose extremes are wanted, so that they stay in the processor's cache."""
AT_A_TIME = 16_384
"""Designs times crank angles, so that the values of a state stay in the processor's cache."""


@cache
def engine() -> str:
    """What runs loops here: ``numba`` or ``numpy``; says so, once, where it is the slow one."""
    if importlib.util.find_spec("numba") is not None:
        return "numba"
    print(f"equipoise: {NOTICE}", file=sys.stderr)
    return "numpy"


def processors() -> int:
    """Number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


_one_at_a_time = Lock()


def run_loop(source: TermSource, table: Array, grid: Array, tops: CurveTops | None = None) -> Array:
    """What a loop gathers (P, R) of designs (P, T) over a grid (G, N).

    tops : finds extremes; where it is not given, their columns are NaN.
    """
    out = np.full((len(table), len(source.gathered.columns)), np.nan)
    if engine() == "numpy":
        run_numpy(out, source, table, grid, tops)
        return out
    sampled = source.gathered.sampled
    count = int(grid[0].max()) + 1 if source.carried else grid.shape[1]
    kernel = tops.kernel(count) if sampled and tops is not None else ""
    with _one_at_a_time:
        loop = _loop_of(source.text)
        find = compiled_kernel(kernel) if kernel else None
    groups = max(1, -(-len(table) // LANES))  # a march fills whole lanes
    if sampled:
        groups = min(groups, max(1, SAMPLES_AT_ONCE // (LANES * len(sampled) * count)))
    step = LANES * groups
    samples, columns = np.empty((step, len(sampled), count)), columns_of(source.gathered)
    for begin in range(0, len(table), step):
        part = out[begin : begin + step]
        loop(table[begin : begin + step], grid, part, samples)
        if find is not None and tops is not None:
            find(samples, part, columns, *tops.arguments())
        elif tops is not None:
            for k, signal in enumerate(sampled):
                source.gathered.fill_tops(part, signal, samples[: len(part), k], tops)
    return out


def extremes_of(curve: CurveTops, values: Array) -> tuple[Array, Array]:
    """Highest and lowest values (M,) of the curves through values (M, N), in the order of the
    curve; compiled where Numba is installed.
    """
    if _uses_numpy(curve, values):
        return curve(values)[0], -curve(-values)[0]
    gathered = _extremes(curve, values, [0, 1, 2, -1, 3, -1])
    return gathered[:, 2], gathered[:, 3]


def highest_of(curve: CurveTops, values: Array) -> Array:
    """Highest values (M,) of the curves as of `extremes_of`, in half the time."""
    if _uses_numpy(curve, values):
        return curve(values)[0]
    return _extremes(curve, values, [0, 1, 2, -1, -1, -1])[:, 2]


def _uses_numpy(curve: CurveTops, values: Array) -> bool:
    """Whether extremes of curves through values (M, N) are left to NumPy."""
    return engine() == "numpy" or not curve.kernel(values.shape[1])


def _extremes(curve: CurveTops, values: Array, columns: list[int]) -> Array:
    """Highest and lowest value, top and dip (M, 4) of each curve, by columns as of `columns_of`."""
    with _one_at_a_time:
        find = compiled_kernel(curve.kernel(values.shape[1]))
    gathered = np.empty((len(values), 4))
    gathered[:, 0], gathered[:, 1] = values.max(axis=1), values.min(axis=1)
    unknown = np.isnan(gathered[:, 0])  # which compiled code passes over
    find(np.ascontiguousarray(values)[:, None], gathered, np.array([columns]), *curve.arguments())
    gathered[unknown] = np.nan
    return gathered


@cache
def _loop_of(text: str) -> CompiledLoop:
    """The compiled loop of a source."""
    path = _file_of(text)
    module = _imported(f"equipoise_{path.stem}", path)
    vars(module).update(compiled_functions())
    return _compile(module.loop, SIGNATURE, {"fastmath": True})  # type: ignore[no-any-return]


@cache
def compiled_kernel(name: str) -> Callable[..., None]:
    """A compiled function that finds extremes, by its name; exact to rounding, as by NumPy."""
    import numba

    path = _file_of(kernel_text())
    module = _imported(f"equipoise_{path.stem}", path)
    space = vars(module)
    space["larger"], space["smaller"] = (compiled_functions()[name] for name in ("max", "min"))
    for helper in HELPERS:
        space[helper.__name__] = numba.njit(error_model="numpy")(space[helper.__name__])
    return _compile(space[name], SIGNATURES[name], {})  # type: ignore[no-any-return]


def _compile(function: Any, types: str, extra: Mapping[str, Any]) -> Any:
    """Compile a function of a module, or take it from the cache."""
    import numba

    options = {"nogil": True, "error_model": "numpy", **extra}
    try:
        return numba.njit(types, cache=True, **options)(function)
    except (OSError, RuntimeError):  # no place for the cache: compile for this run alone
        return numba.njit(types, **options)(function)


# -- files -----------------------------------------------------------------------------------------


def _file_of(text: str) -> Path:
    """The file of a source, written whole or not at all."""
    here = sys.modules[__name__]
    parts = (text, inspect.getsource(here))
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


@cache
def compiled_functions() -> dict[str, Any]:
    """Functions by name, to be called from compiled loops."""
    import numba

    inline = numba.njit(forceinline=True, fastmath=True, error_model="numpy")
    smaller, larger = (_instruction(name, 2) for name in ("llvm.minnum", "llvm.maxnum"))
    return {name: getattr(np, name) for name in ("sqrt", "cos", "sin", "arctan2", "empty")} | {
        "min": _instruction("llvm.minnum", 2, ("fast",)),
        "max": _instruction("llvm.maxnum", 2, ("fast",)),
        "rint": _instruction("llvm.rint", 1),
        "floor": _instruction("llvm.floor", 1),
        "where": inline(lambda flag, yes, no: yes if flag else no),
        "pick": inline(_pick(smaller, larger)),
    }


def _pick(smaller: Callable[..., Any], larger: Callable[..., Any]) -> Callable[..., Any]:
    def pick(table: Any, place: Any) -> Any:
        """A number of a table, by its place from 0 on; no other is read, whatever the place."""
        return table[np.int32(smaller(larger(place, 0.0), table.shape[0] - 1.0))]

    return pick


def _instruction(name: str, count: int, fastmath: tuple[str, ...] = ()) -> Any:
    """A function of one number or two that is a single instruction.

    Of an extreme a comparison, or `min` and `max`, which look after NaN, would keep the loop from
    handling several crank angles at once.
    """
    from llvmlite import ir
    from numba import types
    from numba.extending import intrinsic

    number = ir.DoubleType()
    kind = ir.FunctionType(number, [number] * count)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        function = builder.module.declare_intrinsic(name, [number], kind)
        # What is put aside on the stack lies across lines of the cache otherwise.  llvmlite
        # writes the alignment only beside another attribute.
        builder.function.attributes.alignstack = 64
        builder.function.attributes.add("nounwind")
        return builder.call(function, arguments, fastmath=fastmath)

    typed = types.float64(*[types.float64] * count), generate

    def of_one(context: Any, a: Any) -> Any:
        return typed

    def of_two(context: Any, a: Any, b: Any) -> Any:
        return typed

    return intrinsic(of_one if count == 1 else of_two)


def run_numpy(
    out: Array, source: TermSource, table: Array, grid: Array, tops: CurveTops | None = None
) -> None:
    """Fill what a loop would gather, some designs at a time."""
    if source.carried:
        with np.errstate(all="ignore"):
            march_numpy(out, source, table, grid, tops)
        return
    step, shares = max(1, AT_A_TIME // grid.shape[1]), None
    if source.has_shares:
        grid, shares = grid[:-1], grid[-1]
    with np.errstate(all="ignore"):
        for begin in range(0, len(table), step):
            some = slice(begin, begin + step)
            columns = table[some].T[:, :, None]
            values = dict(zip(source.signals, source.states(*columns, *grid), strict=True))
            shape = (columns.shape[1], grid.shape[1])
            whole = {name: np.broadcast_to(value, shape) for name, value in values.items()}
            _gather(out[some], source, whole, shares, tops)


def _gather(
    out: Array,
    source: TermSource,
    values: Mapping[str, Array],
    shares: Array | None,
    tops: CurveTops | None,
) -> None:
    """Fill what is gathered (P, R) of values (P, N) by signal, and extremes where asked for."""
    for k, (signal, kind) in enumerate(source.gathered.columns):
        if kind in KINDS and signal in values:
            out[:, k] = KINDS[kind].gathered(values[signal], shares)
    if tops is not None:
        for signal in source.gathered.sampled:
            source.gathered.fill_tops(out, signal, values[signal], tops)


def march_numpy(
    out: Array, source: TermSource, table: Array, grid: Array, tops: CurveTops | None = None
) -> None:
    """Fill that where crank angles follow from each other: all designs go round together."""
    carried: Sequence[Any] = [np.full(len(table), item.start) for item in source.carried]
    gathered: dict[int, list[Array]] = {}
    shares: dict[int, float] = {}
    if source.has_shares:
        shares = dict(zip(grid[0].astype(int).tolist(), grid[-1].tolist(), strict=True))
        grid = grid[:-1]
    for place, *rows in grid.T:
        values = source.states(*table.T, *rows, *carried)
        carried = values[len(source.signals) :]
        if place >= 0:
            signals = values[: len(source.signals)]
            gathered[int(place)] = [np.broadcast_to(value, len(table)) for value in signals]
    in_order = [gathered[k] for k in sorted(gathered)]
    share = np.array([shares[k] for k in sorted(gathered)]) if shares else None
    stacks = [np.stack(values, axis=1) for values in zip(*in_order, strict=True)]
    by_name = dict(zip(source.signals, stacks, strict=True))
    last = iter([v for item, v in zip(source.carried, carried, strict=True) if item.watch])
    for k, (signal, _) in enumerate(source.gathered.columns):
        if signal not in by_name:
            out[:, k] = next(last)
    _gather(out, source, by_name, share, tops)
