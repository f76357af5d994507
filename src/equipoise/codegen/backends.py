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

from equipoise.codegen.figures import KINDS
from equipoise.codegen.source import CALLED, KERNELS, Source

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


def run_loop(source: Source, table: Array, grid: Array) -> Array:
    """What a loop gathers (P, R) of designs (P, T) over a grid (G, N)."""
    with _one_at_a_time:
        loop, module = _loop_of(source.text)
    out = np.empty((len(table), len(source.gathered.columns)))
    if loop is None:
        run_numpy(out, source, module.state, table, grid)
    else:
        loop(table, grid, out)
    return out


@cache
def _loop_of(text: str) -> tuple[Loop | None, ModuleType]:
    """The compiled loop of a source, None without Numba, and the module of the source."""
    path = _file_of(text)
    module = _imported(f"equipoise_{path.stem}", path)
    if engine() == "numpy":
        vars(module).update(CALLED, **NUMPY_FUNCTIONS)
        return None, module
    vars(module).update(_compiled_kernels(), **compiled_functions(), empty=np.empty)
    return _compile(module), module


def _compile(module: ModuleType) -> Loop:
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

    found: dict[str, Any] = {}
    for plain in KERNELS:
        path = Path(inspect.getfile(plain))
        module = _imported(f"equipoise_compiled_{path.stem}", path)
        vars(module).update(found)
        own = [name for name, kernel in CALLED.items() if kernel.__module__ == plain.__name__]
        for name in own:
            found[name] = vars(module)[name] = numba.njit(**INLINE)(vars(module)[name])
    return found


# -- files -----------------------------------------------------------------------------------------


def _file_of(text: str) -> Path:
    """The file of a source, written whole or not at all."""
    here = sys.modules[__name__]
    parts = (text, *map(inspect.getsource, (*KERNELS, here)))
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

    return {
        "smallest": _instruction("llvm.minnum", 2, ("fast",)),
        "greatest": _instruction("llvm.maxnum", 2, ("fast",)),
        "angle_of": numba.njit(**INLINE)(angle_of),
        "rotation": numba.njit(**INLINE)(_rotation(_instruction("llvm.rint", 1))),
        "chosen": numba.njit(**INLINE)(lambda flag, yes, no: yes if flag else no),
        "floored": _instruction("llvm.floor", 1),
        "picked": numba.njit(**INLINE)(
            _picked(_instruction("llvm.minnum", 2), _instruction("llvm.maxnum", 2))
        ),
    }


# The polynomials below are Chebyshev interpolations, exact to 1e-17.


def angle_of(u: Any) -> Any:
    """Angle of a rotation u, of at most 2.09 rad to either side: from the tangent of its fourth."""
    half = (0.5 + 0.5 * u.real) ** 0.5
    quarter = 0.5 * u.imag / (half * (1.0 + half))
    z = quarter * quarter
    arc = -0.005280870051487617
    arc = arc * z + 0.018095230564342743
    arc = arc * z + -0.032661656028653945
    arc = arc * z + 0.043802683513332864
    arc = arc * z + -0.051663638584717154
    arc = arc * z + 0.05864670804294048
    arc = arc * z + -0.0666435417001706
    arc = arc * z + 0.07692094669579978
    arc = arc * z + -0.09090895671012374
    arc = arc * z + 0.11111110560344459
    arc = arc * z + -0.14285714272114403
    arc = arc * z + 0.19999999999824117
    arc = arc * z + -0.3333333333333243
    arc = arc * z + 1.0
    return 4.0 * quarter * arc


def _rotation(nearest: Callable[[Any], Any]) -> Callable[[Any], Any]:
    def rotation(angle: Any) -> Any:
        """exp(i angle), as the fourth power of that of a fourth of the angle."""
        turns = angle * 0.15915494309189535
        quarter = (turns - nearest(turns)) * 1.5707963267948966
        z = quarter * quarter
        cos = -1.1353379638297575e-11
        cos = cos * z + 2.0875582380663952e-09
        cos = cos * z + -2.7557313097790086e-07
        cos = cos * z + 2.4801587283881152e-05
        cos = cos * z + -0.0013888888888861095
        cos = cos * z + 0.04166666666666645
        cos = cos * z + -0.5
        cos = cos * z + 1.0
        sin = 1.5894736651849094e-10
        sin = sin * z + -2.5050716974102745e-08
        sin = sin * z + 2.755731337640013e-06
        sin = sin * z + -0.000198412698286503
        sin = sin * z + 0.008333333333320363
        sin = sin * z + -0.16666666666666616
        sin = sin * z + 1.0
        u = complex(cos, quarter * sin)
        u = u * u
        return u * u

    return rotation


def _picked(smaller: Callable[..., Any], larger: Callable[..., Any]) -> Callable[..., Any]:
    def picked(values: Any, place: Any) -> Any:
        """One of some values, by its place from 0 on; no other is read, whatever the place."""
        return values[np.int32(smaller(larger(place, 0.0), values.shape[0] - 1.0))]

    return picked


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
        # What is put aside on the stack lies across lines of the cache otherwise.  llvmlite tells
        # the alignment only beside another attribute.
        builder.function.attributes.alignstack = 64
        builder.function.attributes.add("nounwind")
        return builder.call(function, arguments, fastmath=fastmath)

    typed = types.float64(*[types.float64] * count), generate

    def of_one(context: Any, a: Any) -> Any:
        return typed

    def of_two(context: Any, a: Any, b: Any) -> Any:
        return typed

    return intrinsic(of_one if count == 1 else of_two)


NUMPY_FUNCTIONS = {
    "smallest": np.minimum,
    "greatest": np.maximum,
    "angle_of": np.angle,
    "rotation": lambda angle: np.exp(1j * angle),
    "chosen": np.where,
    "floored": np.floor,
    "picked": lambda values, place: values[
        np.clip(np.nan_to_num(place), 0, len(values) - 1).astype(int)
    ],
}


def run_numpy(
    out: Array, source: Source, state: Callable[..., Any], table: Array, grid: Array
) -> None:
    """Fill what a loop would gather, some designs at a time."""
    if source.carried:
        with np.errstate(all="ignore"):
            march_numpy(out, source, state, table, grid)
        return
    step, shares = max(1, AT_A_TIME // grid.shape[1]), None
    if source.has_shares:
        grid, shares = grid[:-1], grid[-1]
    with np.errstate(all="ignore"):
        for begin in range(0, len(table), step):
            some = slice(begin, begin + step)
            parts = table[some].T[:, :, None]
            own = (
                parts[one.column] + 1j * parts[one.column + 1] if one.vector else parts[one.column]
                for one in source.slots
            )
            values = dict(zip(source.gathered.signals, state(*grid, *own), strict=True))
            shape = (parts.shape[1], grid.shape[1])
            for k, (signal, kind) in enumerate(source.gathered.columns):
                x = np.broadcast_to(values[signal], shape)
                out[some, k] = KINDS[kind].gathered(x, shares)


def march_numpy(
    out: Array, source: Source, state: Callable[..., Any], table: Array, grid: Array
) -> None:
    """The same where crank angles follow from each other: all designs go round together."""
    columns = table.T
    own = [
        columns[one.column] + 1j * columns[one.column + 1] if one.vector else columns[one.column]
        for one in source.slots
    ]
    carried = [np.full(len(table), one.start) for one in source.carried]
    last = {one.next for one in source.carried}
    signals = [one for one in source.gathered.signals if one not in last]
    found: dict[int, list[Array]] = {}
    shares: dict[int, float] = {}
    if source.has_shares:
        shares = dict(zip(grid[0].astype(int).tolist(), grid[-1].tolist(), strict=True))
        grid = grid[:-1]
    for place, *rows in grid.T:
        values = state(*rows, *own, *carried)
        carried = values[len(signals) :]
        if place >= 0:
            found[int(place)] = [np.broadcast_to(v, len(table)) for v in values[: len(signals)]]
    in_order = [found[k] for k in sorted(found)]
    share = np.array([shares[k] for k in sorted(found)]) if shares else None
    stacks = [np.stack(values, axis=1) for values in zip(*in_order, strict=True)]
    values = dict(zip(signals, stacks, strict=True))
    ends = {one.next: value for one, value in zip(source.carried, carried, strict=True)}
    for k, (signal, kind) in enumerate(source.gathered.columns):
        if signal in values:
            out[:, k] = KINDS[kind].gathered(values[signal], share)
        else:
            out[:, k] = ends[signal]
