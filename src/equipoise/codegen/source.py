"""The steps of a linkage written out as source: one crank angle of one design, and the loop.

``state`` is the steps, one line each, calling the kernels; it holds no formula of its own.
``loop`` calls it for every design and crank angle and gathers what the figures need.  Compiled,
both become one loop without calls.  NumPy runs ``state`` alone, on arrays.

Where a group of loops goes from one crank angle to the next, ``state`` takes what the angle before
carries on, and ``loop`` does some designs side by side, so that the processor can still handle
several at once: `codegen.loops`.
"""

from __future__ import annotations

import inspect
import keyword
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate, chain, pairwise
from typing import Any

import numpy as np

from equipoise.codegen.figures import KINDS, Gathered
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.formulas import (
    cam_kernels,
    curve_kernels,
    joint_kernels,
    kernels,
    rolling_kernels,
)
from equipoise.signals import ROUNDING

Array = np.ndarray[Any, Any]
Read = Callable[[Linkage], Any]
PLACE = {"highest": "{x} - {g} >", "lowest": "{g} - {x} >"}
"""An extreme has a new place where it grows by more than rounding, so that of equal ones the first
is told; this takes a branch, which costs the loop its speed."""
KERNELS = (kernels, joint_kernels, cam_kernels, curve_kernels, rolling_kernels)
"""Modules whose functions the lines call, those first that others are made of."""
CALLED = {
    name: found for one in KERNELS for name, found in vars(one).items() if inspect.isfunction(found)
}
"""These functions, by name."""
GIVEN = {"smallest", "greatest", "angle_of", "rotation", "chosen", "floored", "picked"}
RESERVED = {*CALLED, *keyword.kwlist, *GIVEN, "complex", "range", "abs", "array"}
RESERVED |= {"state", "loop", "table", "grid", "out", "i", "k"}
LANES = 32
"""Designs that a march does side by side: their values fit into the nearest cache."""
MARCH = ("step", "marked", "steady")
"""What `state` is told of a crank angle in a march: how far it is from the one before; 1 where the
file tells the pose, else 0; 1 from there on, 0 before."""
WATCHED = ("loose", "astray", "open")
"""Values that are carried on, whose last tells of a design whether Newton's method left its branch;
did not arrive from the base, or too far from where the file tells; came back elsewhere."""
RESERVED |= {*MARCH, "share", "work", "lane", "begin", "place", "empty", "min"}


@dataclass(frozen=True)
class Slot:
    """A number or vector that each design has of its own.

    read : finds it in the design's linkage.
    column : of the table; a vector takes this and the next.
    """

    name: str
    vector: bool
    read: Read
    column: int


@dataclass(frozen=True)
class Row:
    """Something that depends on the crank angle alone: values (N,) at crank angles (N,), rad.

    formula : the same of `theta`, or of the base what is near enough to it, as other languages
        write it too; empty where it has none.
    """

    name: str
    values: Callable[[Array], Array]
    formula: str = ""


@dataclass(frozen=True)
class Carried:
    """A value that each crank angle has from the one before.

    name, next : identifiers of what `state` takes and returns.  start : of every design.
    """

    name: str
    next: str
    start: float | complex


@dataclass(frozen=True)
class Source:
    """A loop as source, with what has to be handed to it.

    slots : what stands in the columns of its table, of which there are `width`.
    rows : of its grid.
    watched : dyads that numbers tell of; the first time it is the dyad's own number.
    running : links whose angle is taken from that of the base.
    gathered : columns of what it fills: those that are wanted, then the others below.
    weakest, strongest : columns of the smallest and the largest value of each watched number.
    nearest : columns of how near the running links stay to the base's: smallest cosine between.
    carried : from crank angle to crank angle; none where each stands alone.
    ends : for each of `WATCHED` the columns of its last values.
    has_shares : whether the last row of its grid has the share of each crank angle in a mean.
    """

    text: str
    slots: tuple[Slot, ...]
    width: int
    rows: tuple[Row, ...]
    watched: tuple[int, ...]
    running: tuple[str, ...]
    gathered: Gathered
    weakest: slice
    strongest: slice
    nearest: slice
    carried: tuple[Carried, ...]
    ends: Mapping[str, list[int]]
    has_shares: bool = False


class Sheet:
    """Lines of ``state`` as they are written, and the names of its values."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.slots: dict[str, Slot] = {}
        self.width = 0
        self.rows: dict[str, Row] = {}
        self.running: dict[str, str] = {}
        self.carried: dict[str, float | complex] = {}
        self.constants: dict[str, list[float]] = {}
        self.has_shares = False
        self._names: dict[str, str] = {}

    def name(self, value: str) -> str:
        """An identifier for a value of a state, such as ``p_B`` for ``p(B)``."""
        if value not in self._names:
            plain = re.sub(r"\W", "_", value.rstrip(")"), flags=re.ASCII) or "_"
            taken = RESERVED.union(self._names.values())
            number = 2
            found = plain
            while found in taken:
                found, number = f"{plain}_{number}", number + 1
            self._names[value] = found
        return self._names[value]

    def slot(self, name: str, read: Read, vector: bool = False) -> str:
        """A number or vector that each design has of its own."""
        found = self.name(name)
        if found not in self.slots:
            self.slots[found] = Slot(found, vector, read, self.width)
            self.width += 1 + vector
        return found

    def row(self, name: str, values: Callable[[Array], Array], formula: str = "") -> str:
        """A number that depends on the crank angle alone."""
        found = self.name(name)
        self.rows.setdefault(found, Row(found, values, formula))
        return found

    def constant(self, name: str, values: Array) -> str:
        """Numbers that all designs share, of which one is picked at a time."""
        self.constants[self.name(name)] = values.tolist()
        return self.name(name)

    def carry(self, value: str, start: float | complex) -> str:
        """A value of the crank angle before; that of this one is put as ``next`` of it."""
        self.carried[value] = start
        return self.name(value)

    def put(self, value: str, expression: str) -> str:
        """Write a line that gives a value of the state."""
        found = self.name(value)
        self.lines.append(f"{found} = {expression}")
        return found

    def call(self, kernel: str, arguments: Iterable[str], outputs: Sequence[str]) -> None:
        """Write a line that calls a kernel."""
        names = ", ".join(self.name(output) for output in outputs)
        comma = "," if len(outputs) == 1 else ""
        self.lines.append(f"{names}{comma} = {kernel}({', '.join(arguments)})")


def source_of(
    sheet: Sheet, signals: Sequence[str], numbers: Mapping[str, int], wanted: Gathered
) -> Source:
    """Put ``state`` and ``loop`` around the lines.

    signals : identifiers of the signals, in the order of `wanted`.
    numbers : identifiers of those that are watched, each with the dyad that it tells of.
    """
    watched = [f"number {k}" for k in range(len(numbers))]
    cosines = [f"cosine {k}" for k in range(len(sheet.running))]
    carried = tuple(
        Carried(sheet.name(value), sheet.name(f"next {value}"), start)
        for value, start in sheet.carried.items()
    )
    last = {key: [v for v in sheet.carried if v.startswith(f"{key} ")] for key in WATCHED}
    columns = [
        wanted.columns,
        [(number, "lowest") for number in watched],
        [(number, "highest") for number in watched],
        [(cosine, "lowest") for cosine in cosines],
        [(sheet.name(f"next {value}"), "highest") for value in chain(*last.values())],
    ]
    gathered = Gathered(tuple(chain(*columns)))
    ends = pairwise(accumulate(map(len, columns), initial=0))
    _, weakest, strongest, nearest, _ = (slice(*both) for both in ends)
    march = MARCH if carried else ()
    arguments = ", ".join([*march, *sheet.rows, *sheet.slots, *(one.name for one in carried)])
    results = [*signals, *numbers, *sheet.running.values(), *(one.next for one in carried)]
    loop = _march(sheet, gathered, arguments, carried) if carried else None
    lines = [
        '"""Written out by equipoise.codegen from the steps of a linkage."""',
        *(["", "from numpy import array", ""] if sheet.constants else []),
        *(f"{name} = array({values!r})" for name, values in sheet.constants.items()),
        "",
        "",
        f"def state({arguments}):",
        *(f"    {line}" for line in sheet.lines),
        f"    return {', '.join(results)},",
        "",
        "",
        *(loop or _loop(sheet, gathered, arguments)),
        "",
    ]
    return Source(
        "\n".join(lines),
        tuple(sheet.slots.values()),
        sheet.width,
        tuple(sheet.rows.values()),
        tuple(numbers.values()),
        tuple(sheet.running),
        gathered,
        weakest,
        strongest,
        nearest,
        carried,
        {
            key: [gathered.columns.index((sheet.name(f"next {v}"), "highest")) for v in values]
            for key, values in last.items()
        },
        sheet.has_shares,
    )


def _loop(sheet: Sheet, gathered: Gathered, arguments: str) -> list[str]:
    signals = {signal: f"x{k}" for k, signal in enumerate(gathered.signals)}
    columns = {column: f"g{k}" for k, column in enumerate(gathered.columns)}
    return [
        "def loop(table, grid, out):",
        "    for i in range(table.shape[0]):",
        *(f"        {slot.name} = {_read(slot)}" for slot in sheet.slots.values()),
        *(f"        {name} = {KINDS[kind].start}" for (_, kind), name in columns.items()),
        "        for k in range(grid.shape[1]):",
        *(f"            {name} = grid[{k}, k]" for k, name in enumerate(_rows(sheet))),
        f"            {', '.join(signals.values())}, = state({arguments})",
        *(f"            {line}" for line in _gathering(columns, signals, sheet)),
        *(f"        out[i, {k}] = {name}" for k, name in enumerate(columns.values())),
    ]


def _rows(sheet: Sheet, first: Iterable[str] = ()) -> list[str]:
    """Identifiers of the rows of the grid that tell of the crank angle, after the first ones."""
    return [*first, *sheet.rows, *(["share"] if sheet.has_shares else [])]


def _read(slot: Slot) -> str:
    """A design's number or vector out of its row of the table."""
    first = f"table[i, {slot.column}]"
    return f"complex({first}, table[i, {slot.column + 1}])" if slot.vector else first


def _march(
    sheet: Sheet, gathered: Gathered, arguments: str, carried: Sequence[Carried]
) -> list[str]:
    """The loop where crank angles follow from each other: some designs go round side by side.

    What they have of their own lies in `work`, each value of all of them in a row.
    """
    ends = {one.next: one.name for one in carried}
    signals = {s: f"x{k}" for k, s in enumerate(gathered.signals) if s not in ends}
    columns = {c: f"g{k}" for k, c in enumerate(gathered.columns) if c[0] in signals}
    vectors = {slot.name: slot.vector for slot in sheet.slots.values()}
    vectors |= {one.name: isinstance(one.start, complex) for one in carried}
    vectors |= dict.fromkeys([*signals.values(), *columns.values()], False)
    offsets = dict(zip(vectors, accumulate(1 + v for v in vectors.values()), strict=True))
    width = max(offsets.values())
    at = {name: f"work[{(end - 1) * LANES} + lane]" for name, end in offsets.items()}
    before = {name: f"work[{(end - 2) * LANES} + lane]" for name, end in offsets.items()}

    def get(name: str) -> str:
        return f"{name} = " + (
            f"complex({before[name]}, {at[name]})" if vectors[name] else at[name]
        )

    def keep(name: str, value: str) -> list[str]:
        if vectors[name]:
            return [f"{before[name]} = {value}.real", f"{at[name]} = {value}.imag"]
        return [f"{at[name]} = {value}"]

    starts = [line for one in carried for line in keep(one.name, repr(one.start))]
    starts += [f"{at[name]} = {KINDS[kind].start}" for (_, kind), name in columns.items()]
    taken = [
        name for name, v in vectors.items() if name not in {*signals.values(), *columns.values()}
    ]
    found = [*signals.values(), *ends]
    kept = [line for x in signals.values() for line in keep(x, x)]
    kept += [line for key, name in ends.items() for line in keep(name, key)]
    results = [columns[c] if c in columns else ends[c[0]] for c in gathered.columns]
    return [
        "def loop(table, grid, out):",
        f"    work = empty({width * LANES})",
        f"    for begin in range(0, table.shape[0], {LANES}):",
        f"        for lane in range({LANES}):",
        "            i = min(begin + lane, table.shape[0] - 1)",
        f"            for k in range({sheet.width}):",
        f"                work[k * {LANES} + lane] = table[i, k]",
        *(f"            {line}" for line in starts),
        "        for k in range(grid.shape[1]):",
        "            place = grid[0, k]",
        *(f"            {name} = grid[{r}, k]" for r, name in enumerate(_rows(sheet, MARCH), 1)),
        f"            for lane in range({LANES}):",
        *(f"                {get(name)}" for name in taken),
        f"                {', '.join(found)}, = state({arguments})",
        *(f"                {line}" for line in kept),
        "            if place >= 0.0:",
        f"                for lane in range({LANES}):",
        *(f"                    {get(name)}" for name in [*signals.values(), *columns.values()]),
        *(f"                    {line}" for line in _gathering(columns, signals, sheet, "place")),
        *(f"                    {at[name]} = {name}" for name in columns.values()),
        f"        for lane in range(min({LANES}, table.shape[0] - begin)):",
        *(f"            out[begin + lane, {k}] = {at[name]}" for k, name in enumerate(results)),
    ]


def _gathering(
    columns: Mapping[tuple[str, str], str],
    signals: Mapping[str, str],
    sheet: Sheet,
    number: str = "k",
) -> Iterator[str]:
    """Lines that take in the signals' values at the crank angle of this number."""
    for (signal, kind), name in columns.items():
        x = signals[signal]
        place = columns.get((signal, f"{kind}_at"))
        if place is not None:
            yield f"if {PLACE[kind].format(g=name, x=x)} {ROUNDING!r} * abs({x}):"
            yield f"    {place} = {number}"
        if line := (sheet.has_shares and KINDS[kind].shared) or KINDS[kind].add:
            yield line.format(g=name, x=x)
