"""The loop that `equipoise.codegen` writes out, in C: the same arithmetic, compiled by gcc.

``state`` and the kernels do arithmetic only, so they run on numbers that write down, as lines of C,
what is done to them; a vector is a pair of doubles.  Around these lines stands the same loop over
designs and crank angles, with the same sums of squares and extremes.
"""

from __future__ import annotations

import ctypes
import inspect
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from equipoise.codegen.figures import KINDS
from equipoise.codegen.source import Source
from equipoise.mechanism.formulas import kernels

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
"""The line of what is gathered; others are not timed here."""
Loop = Callable[[np.ndarray, np.ndarray], np.ndarray]


def gcc() -> str | None:
    """Version of gcc; None where it is missing."""
    if shutil.which("gcc") is None:
        return None
    told = subprocess.run(["gcc", "-dumpfullversion"], check=True, capture_output=True, text=True)
    return told.stdout.strip()


def compiled(source: Source, flags: list[str], folder: Path) -> Loop:
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
        places = [array.ctypes.data_as(double) for array in (table, grid, out)]
        loop(places[0], len(table), places[1], grid.shape[1], places[2])
        return out

    return run


# -- writing ---------------------------------------------------------------------------------------


def in_c(source: Source) -> str:
    """The loop as a C program."""
    assert not source.running, "angles that are counted on need more than arithmetic"
    lines, results = _state(source)
    columns = len(source.gathered.columns)
    signals = dict(zip(source.gathered.signals, results, strict=True))
    starts, gathered = [], []
    for k, (signal, kind) in enumerate(source.gathered.columns):
        starts.append(f"double g{k} = {KINDS[kind].start};")
        gathered.append(ADD[kind].format(g=f"g{k}", x=signals[signal]))
    return "\n".join(
        [
            "#include <math.h>",
            "void loop(const double *restrict table, long designs,",
            "          const double *restrict grid, long angles, double *restrict out) {",
            "for (long i = 0; i < designs; i++) {",
            *(f"double t{k} = table[i * {source.width} + {k}];" for k in range(source.width)),
            *starts,
            "for (long k = 0; k < angles; k++) {",
            *(f"double r{k} = grid[{k} * angles + k];" for k in range(len(source.rows))),
            *lines,
            *gathered,
            "}",
            *(f"out[i * {columns} + {k}] = g{k};" for k in range(columns)),
            "}",
            "}",
            "",
        ]
    )


def _state(source: Source) -> tuple[list[str], list[str]]:
    """Lines of C for one crank angle, and the names of what ``state`` returns."""
    lines: list[str] = []
    arguments = [Number(lines, f"r{k}") for k in range(len(source.rows))]
    arguments += [
        Number(lines, f"t{slot.column}", f"t{slot.column + 1}" if slot.vector else None)
        for slot in source.slots
    ]
    module = {name: found for name, found in vars(kernels).items() if inspect.isfunction(found)}
    for name, sign in (("smallest", "<"), ("greatest", ">")):
        module[name] = lambda a, b, sign=sign: a.chosen(b, sign)
    exec(source.text, module)
    found = [Number.of(value, lines) for value in module["state"](*arguments)]
    return lines, [number.x for number in found]


class Number:
    """A number or vector of the C program: names or constants of its parts, y None for a number."""

    def __init__(self, lines: list[str], x: str, y: str | None = None) -> None:
        self.lines, self.x, self.y = lines, x, y

    @classmethod
    def of(cls, value: Any, lines: list[str]) -> Number:
        if isinstance(value, Number):
            return value
        if isinstance(value, complex):
            return cls(lines, repr(value.real), repr(value.imag))
        return cls(lines, repr(float(value)))

    def _put(self, x: str, y: str | None = None) -> Number:
        """Write down what is computed, and name it."""
        names = []
        for part in filter(None, (x, y)):
            names.append(f"v{len(self.lines)}")
            self.lines.append(f"double {names[-1]} = {part};")
        return Number(self.lines, *names)

    @property
    def real(self) -> Number:
        return Number(self.lines, self.x)

    @property
    def imag(self) -> Number:
        return Number(self.lines, self.y or "0.0")

    def conjugate(self) -> Number:
        return self if self.y is None else Number(self.lines, self.x, f"(-{self.y})")

    def chosen(self, other: Any, sign: str) -> Number:
        """The smaller or larger of two numbers."""
        a, b = self.x, self.of(other, self.lines).x
        return self._put(f"{a} {sign} {b} ? {a} : {b}")

    def __abs__(self) -> Number:
        assert self.y is None, "lengths of vectors are roots"
        return self._put(f"fabs({self.x})")

    def __neg__(self) -> Number:
        return self._put(f"-{self.x}", self.y and f"-{self.y}")

    def __pow__(self, power: float) -> Number:
        assert power == 0.5 and self.y is None
        return self._put(f"sqrt({self.x})")

    def __add__(self, other: Any) -> Number:
        return self._added(self.of(other, self.lines), "+")

    def __sub__(self, other: Any) -> Number:
        return self._added(self.of(other, self.lines), "-")

    def __radd__(self, other: Any) -> Number:
        return self.of(other, self.lines) + self

    def __rsub__(self, other: Any) -> Number:
        return self.of(other, self.lines) - self

    def _added(self, other: Number, sign: str) -> Number:
        x = f"{self.x} {sign} {other.x}"
        if self.y is None and other.y is None:
            return self._put(x)
        return self._put(x, f"{self.y or '0.0'} {sign} {other.y or '0.0'}")

    def __mul__(self, other: Any) -> Number:
        a, b = self, self.of(other, self.lines)
        if a.y is not None and b.y is not None:
            return self._put(f"{a.x} * {b.x} - {a.y} * {b.y}", f"{a.x} * {b.y} + {a.y} * {b.x}")
        x = f"{a.x} * {b.x}"
        if a.y is None and b.y is None:
            return self._put(x)
        return self._put(x, f"{a.y or a.x} * {b.x if b.y is None else b.y}")

    def __rmul__(self, other: Any) -> Number:
        return self.of(other, self.lines) * self

    def __truediv__(self, other: Any) -> Number:
        b = self.of(other, self.lines)
        assert b.y is None, "a vector is divided by none"
        return self._put(f"{self.x} / {b.x}", self.y and f"{self.y} / {b.x}")

    def __rtruediv__(self, other: Any) -> Number:
        return self.of(other, self.lines) / self
