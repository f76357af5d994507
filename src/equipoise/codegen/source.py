"""The steps of a linkage written out as source: one crank angle of one design, and the loop.

``state`` is the steps, one line each, calling the kernels; it holds no formula of its own.
``loop`` calls it for every design and crank angle and gathers what the figures need.  Compiled,
both become one loop without calls.  NumPy runs ``state`` alone, on arrays.
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
from equipoise.mechanism import kernels
from equipoise.mechanism.linkage import Linkage
from equipoise.signals import ROUNDING

Array = np.ndarray[Any, Any]
Read = Callable[[Linkage], Any]
PLACE = {"highest": "{x} - {g} >", "lowest": "{g} - {x} >"}
"""An extreme has a new place where it grows by more than rounding, so that of equal ones the first
is told; this takes a branch, which costs the loop its speed."""
RESERVED = {name for name, found in vars(kernels).items() if inspect.isfunction(found)}
RESERVED |= {*keyword.kwlist, "smallest", "greatest", "angle_of", "rotation", "complex", "range"}
RESERVED |= {"abs", "state", "loop", "table", "grid", "out", "i", "k"}


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
    """Something that depends on the crank angle alone: values (N,) at crank angles (N,), rad."""

    name: str
    values: Callable[[Array], Array]


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


class Sheet:
    """Lines of ``state`` as they are written, and the names of its values."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.slots: dict[str, Slot] = {}
        self.width = 0
        self.rows: dict[str, Row] = {}
        self.running: dict[str, str] = {}
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

    def row(self, name: str, values: Callable[[Array], Array]) -> str:
        """A number that depends on the crank angle alone."""
        found = self.name(name)
        self.rows.setdefault(found, Row(found, values))
        return found

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
    columns = [
        wanted.columns,
        [(number, "lowest") for number in watched],
        [(number, "highest") for number in watched],
        [(cosine, "lowest") for cosine in cosines],
    ]
    gathered = Gathered(tuple(chain(*columns)))
    ends = pairwise(accumulate(map(len, columns), initial=0))
    _, weakest, strongest, nearest = (slice(*both) for both in ends)
    arguments = ", ".join([*sheet.rows, *sheet.slots])
    lines = [
        '"""Written out by equipoise.codegen from the steps of a linkage."""',
        "",
        "",
        f"def state({arguments}):",
        *(f"    {line}" for line in sheet.lines),
        f"    return {', '.join([*signals, *numbers, *sheet.running.values()])},",
        "",
        "",
        *_loop(sheet, gathered, arguments),
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
        *(f"            {name} = grid[{k}, k]" for k, name in enumerate(sheet.rows)),
        f"            {', '.join(signals.values())}, = state({arguments})",
        *(f"            {line}" for line in _gathering(columns, signals)),
        *(f"        out[i, {k}] = {name}" for k, name in enumerate(columns.values())),
    ]


def _read(slot: Slot) -> str:
    """A design's number or vector out of its row of the table."""
    first = f"table[i, {slot.column}]"
    return f"complex({first}, table[i, {slot.column + 1}])" if slot.vector else first


def _gathering(columns: Mapping[tuple[str, str], str], signals: Mapping[str, str]) -> Iterator[str]:
    """Lines that take in the signals' values."""
    for (signal, kind), name in columns.items():
        x = signals[signal]
        place = columns.get((signal, f"{kind}_at"))
        if place is not None:
            yield f"if {PLACE[kind].format(g=name, x=x)} {ROUNDING!r} * abs({x}):"
            yield f"    {place} = k"
        if line := KINDS[kind].add:
            yield line.format(g=name, x=x)
