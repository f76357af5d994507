"""The loop that `equipoise.codegen` writes out, in C: the same arithmetic, compiled by gcc.

The terms of a source are lines of C as well.  Around them stands the same loop over designs and
crank angles, with the same sums of squares and extremes.
"""

from __future__ import annotations

import ctypes
import shutil
import signal
import subprocess
from collections.abc import Callable
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from equipoise.codegen.figures import KINDS
from equipoise.codegen.source import C, Lines, TermSource, boundary
from equipoise.codegen.terms import ANGLE, BOTH, DESIGN

ALWAYS = ["-O3", "-march=native", "-ffast-math", "-shared", "-fPIC"]
FLAGS = (
    [],
    ["-mprefer-vector-width=256"],
    ["-mprefer-vector-width=512"],
    ["-mprefer-vector-width=512", "-funroll-loops"],
)
"""Added to `ALWAYS`, each tried."""
ADD = {
    "squares": "{g} += {x} * {x};",
    "sum": "{g} += {x};",
    "highest": "{g} = {x} > {g} ? {x} : {g};",
    "lowest": "{g} = {x} < {g} ? {x} : {g};",
}
"""The line of what is gathered; extremes, which are taken after the loop, are not timed here."""
Loop = Callable[[np.ndarray, np.ndarray], np.ndarray]


def gcc() -> str | None:
    """Version of gcc; None where it is missing."""
    if shutil.which("gcc") is None:
        return None
    told = subprocess.run(["gcc", "-dumpfullversion"], check=True, capture_output=True, text=True)
    return told.stdout.strip()


def compiled(source: TermSource, flags: list[str], folder: Path) -> Loop:
    """The loop of a source: called with table (P, T) and grid (G, N), it returns (P, R)."""
    number = len(list(folder.iterdir()))
    program, library = folder / f"loop{number}.c", folder / f"loop{number}.so"
    program.write_text(in_c(source), encoding="utf-8")
    subprocess.run(["gcc", *ALWAYS, *flags, str(program), "-o", str(library), "-lm"], check=True)
    loop = ctypes.CDLL(str(library)).loop
    double = ctypes.POINTER(ctypes.c_double)
    loop.argtypes = [double, ctypes.c_long, double, ctypes.c_long, double]
    loop.restype = None

    def run(table: np.ndarray, grid: np.ndarray) -> np.ndarray:
        out = np.empty((len(table), len(source.gathered.columns)))
        # C takes numbers one after the other, whatever way the arrays were made.
        given = [np.ascontiguousarray(array, float) for array in (table, grid)]
        places = [array.ctypes.data_as(double) for array in (*given, out)]
        loop(places[0], len(table), places[1], grid.shape[1], places[2])
        return out

    return run


def crashes(loop: Loop, table: np.ndarray, grid: np.ndarray) -> str:
    """The signal that ends a process which runs a loop; empty where it runs to its end.

    What gcc makes for a processor that it does not know well has crashed: the benchmark goes on
    without those flags.
    """
    process = get_context("fork").Process(target=loop, args=(table, grid))
    process.start()
    process.join()
    code = process.exitcode or 0
    return signal.Signals(-code).name if code < 0 else ""


# -- writing ---------------------------------------------------------------------------------------


def in_c(source: TermSource) -> str:
    """The loop as a C program, of the same terms."""
    assert not source.running and not source.carried, "nothing but arithmetic is compared"
    by_angle = boundary(source.outputs, ANGLE)
    lines = Lines(source.outputs, C, {one: f"r{k}" for k, one in enumerate(by_angle)})
    own = [one.args[0] for one in lines.terms if one.op == "argument" and one.mask == DESIGN]
    setting = [*lines.write((DESIGN,), boundary(source.outputs, DESIGN))]
    going = [*lines.write((BOTH,), source.outputs)]
    signals = dict(zip(source.signals, map(lines.text, source.outputs), strict=True))
    every = [*enumerate(source.gathered.columns)]
    columns = [(k, column) for k, column in every if column[1] in KINDS]
    width, count = source.width, len(every)
    return "\n".join(
        [
            "#include <math.h>",
            "void loop(const double *restrict table, long designs,",
            "          const double *restrict grid, long angles, double *restrict out) {",
            "for (long i = 0; i < designs; i++) {",
            *(f"const double {name} = table[i * {width} + {name[1:]}];" for name in own),
            *setting,
            *(f"double g{k} = {KINDS[kind].start};" for k, (_, kind) in columns),
            "for (long k = 0; k < angles; k++) {",
            *(f"const double r{k} = grid[{k} * angles + k];" for k in range(len(by_angle))),
            *going,
            *(ADD[kind].format(g=f"g{k}", x=signals[signal]) for k, (signal, kind) in columns),
            "}",
            *(f"out[i * {count} + {k}] = NAN;" for k in {*range(count)} - {k for k, _ in columns}),
            *(f"out[i * {count} + {k}] = g{k};" for k, _ in columns),
            "}",
            "}",
            "",
        ]
    )
