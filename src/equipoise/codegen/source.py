"""The steps of a linkage written out as source: one crank angle of one design, and the loop.

``state`` is the steps, one line each, calling the kernels; it holds no formula of its own.
``loop`` calls it for every design and crank angle and gathers what the figures need.  Compiled,
both become one loop without calls.  NumPy runs ``state`` alone, on arrays.
"""

from __future__ import annotations

import inspect
import keyword
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.codegen.figures import Gathered
from equipoise.mechanism import kernels
from equipoise.mechanism.linkage import Linkage
from equipoise.signals import ROUNDING

Array = np.ndarray[Any, Any]
Read = Callable[[Linkage], Any]
START = {
    "sum": "0.0",
    "squares": "0.0",
    "highest": "-1e300",
    "lowest": "1e300",
    "highest_at": "0.0",
    "lowest_at": "0.0",
}
ADD = {
    "sum": ("{g} += {x}",),
    "squares": ("{g} += {x} * {x}",),
    "highest": ("{g} = greatest({g}, {x})",),
    "lowest": ("{g} = smallest({g}, {x})",),
}
PLACE = {"highest": "{x} - {g} >", "lowest": "{g} - {x} >"}
"""An extreme has a new place where it grows by more than rounding, so that of equal ones the first
is told; this takes a branch, which costs the loop its speed."""
RESERVED = {name for name, found in vars(kernels).items() if inspect.isfunction(found)}
RESERVED |= {*keyword.kwlist, "smallest", "greatest", "angle_of", "rotation", "complex", "range"}
RESERVED |= {"abs", "state", "loop", "table", "grid", "out", "i", "k"}


@dataclass(frozen=True)
class Slot:
    """A number or vector that each design has of its own, and where in its linkage it stands."""

    name: str
    vector: bool
    read: Read


@dataclass(frozen=True)
class Row:
    """Something that depends on the crank angle alone: values (N,) at crank angles (N,), rad."""

    name: str
    values: Callable[[Array], Array]


@dataclass(frozen=True)
class Source:
    """A loop as source, with what has to be handed to it.

    slots : columns of its table, in order; a vector takes two.
    rows : rows of its grid; those of vectors take two.
    watched : dyads that numbers tell of; the first time it is the dyad's own number.
    running : links whose angle is taken from that of the base.
    """

    text: str
    slots: tuple[Slot, ...]
    rows: tuple[Row, ...]
    watched: tuple[int, ...]
    running: tuple[str, ...]
    gathered: Gathered

    @property
    def width(self) -> int:
        """Columns of what it fills: what is gathered, and those below."""
        return len(self.gathered.columns) + 2 * len(self.watched) + len(self.running)

    @property
    def weakest(self) -> slice:
        """Columns of the smallest value of each number that is watched."""
        first = len(self.gathered.columns)
        return slice(first, first + len(self.watched))

    @property
    def strongest(self) -> slice:
        """Columns of the largest value of each of them."""
        first = len(self.gathered.columns) + len(self.watched)
        return slice(first, first + len(self.watched))

    @property
    def nearest(self) -> slice:
        """Columns of how near the running links stay to the base's: smallest cosine between."""
        return slice(len(self.gathered.columns) + 2 * len(self.watched), self.width)


class Sheet:
    """Lines of ``state`` as they are written, and the names of its values."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.slots: dict[str, Slot] = {}
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

    def slot(self, name: str, read: Read, vector: bool) -> str:
        """A number that each design has of its own."""
        found = self.name(name)
        self.slots.setdefault(found, Slot(found, vector, read))
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
    sheet: Sheet, signals: Sequence[str], numbers: Mapping[str, int], gathered: Gathered
) -> Source:
    """Put ``state`` and ``loop`` around the lines.

    signals : identifiers of the signals, in the order of `gathered`; numbers : of the dyads' own
        numbers and what else is watched, each with the dyad that it tells of.
    """
    arguments = [*sheet.rows, *sheet.slots]
    results = [*signals, *numbers, *sheet.running.values()]
    text = "\n".join(
        [
            '"""Written out by equipoise.codegen from the steps of a linkage."""',
            "",
            "",
            f"def state({', '.join(arguments)}):",
            *(f"    {line}" for line in sheet.lines),
            f"    return {', '.join(results)},",
            "",
            "",
            *_loop(sheet, gathered, len(numbers), arguments),
            "",
        ]
    )
    return Source(
        text,
        tuple(sheet.slots.values()),
        tuple(sheet.rows.values()),
        tuple(numbers.values()),
        tuple(sheet.running),
        gathered,
    )


def _loop(sheet: Sheet, gathered: Gathered, dyads: int, arguments: list[str]) -> list[str]:
    signals = {signal: f"x{k}" for k, signal in enumerate(gathered.signals)}
    names = [f"g{k}" for k in range(len(gathered.columns))]
    numbers = [f"n{k}" for k in range(dyads)]
    cosines = [f"c{k}" for k in range(len(sheet.running))]
    extremes = [f"{kind}_{number}" for kind in ("weakest", "strongest") for number in numbers]
    extremes += [f"nearest_{cosine}" for cosine in cosines]
    return [
        "def loop(table, grid, out):",
        "    for i in range(table.shape[0]):",
        *(f"        {line}" for line in _unpacked(sheet)),
        *(
            f"        {name} = {START[kind]}"
            for name, (_, kind) in zip(names, gathered.columns, strict=True)
        ),
        *(f"        {name} = {'-1e300' if name[0] == 's' else '1e300'}" for name in extremes),
        "        for k in range(grid.shape[1]):",
        *(f"            {name} = grid[{k}, k]" for k, name in enumerate(sheet.rows)),
        f"            {', '.join([*signals.values(), *numbers, *cosines])}, = state("
        f"{', '.join(arguments)})",
        *(f"            {line}" for line in _gathering(gathered, signals, names)),
        *(f"            weakest_{n} = smallest(weakest_{n}, {n})" for n in numbers),
        *(f"            strongest_{n} = greatest(strongest_{n}, {n})" for n in numbers),
        *(f"            nearest_{c} = smallest(nearest_{c}, {c})" for c in cosines),
        *(f"        out[i, {k}] = {name}" for k, name in enumerate(names)),
        *(f"        out[i, {len(names) + k}] = {name}" for k, name in enumerate(extremes)),
    ]


def _unpacked(sheet: Sheet) -> Iterable[str]:
    """Lines that read a design's numbers from its row of the table."""
    place = 0
    for slot in sheet.slots.values():
        if slot.vector:
            yield f"{slot.name} = complex(table[i, {place}], table[i, {place + 1}])"
        else:
            yield f"{slot.name} = table[i, {place}]"
        place += 1 + slot.vector


def _gathering(gathered: Gathered, signals: dict[str, str], names: list[str]) -> Iterable[str]:
    columns = dict(zip(gathered.columns, names, strict=True))
    for (signal, kind), name in columns.items():
        x = signals[signal]
        place = columns.get((signal, f"{kind}_at"))
        if place is not None:
            yield f"if {PLACE[kind].format(g=name, x=x)} {ROUNDING!r} * abs({x}):"
            yield f"    {place} = k"
        yield from (line.format(g=name, x=x) for line in ADD.get(kind, ()))
