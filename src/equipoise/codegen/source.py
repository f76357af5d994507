"""What a loop over designs and crank angles computes, and the loop as source.

`TermSource` holds the terms of what is gathered, and what has to be handed to a loop: columns of a
table, one row a design, and rows of a grid, one column a crank angle.  Its loop is compiled by
Numba; NumPy runs `states`, the same terms on arrays.

Where a group of loops goes from one crank angle to the next, each crank angle takes what the one
before carries on, and the loop does some designs side by side, so that the processor can still
handle several at once: `codegen.loops`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, cached_property
from itertools import accumulate, chain, pairwise
from typing import Any

import numpy as np

from equipoise.codegen.emission import PYTHON, Lines, boundary, without_calls
from equipoise.codegen.figures import KINDS, Gathered
from equipoise.codegen.loops import WATCHED
from equipoise.codegen.terms import ANGLE, BOTH, DESIGN, Term, reached
from equipoise.codegen.trace import AngleFunction, Array, Recurrence, Slot, Trace
from equipoise.dataclass import dataclass

NO_NAMES: Mapping[Any, str] = {}
LANES = 32
"""Designs that a march does side by side: their values fit into the nearest cache."""
HEADER = "def loop(table, grid, out, samples):"
HEAD = '"""Written by equipoise.codegen from the steps of a linkage."""'


@dataclass(frozen=True)
class TermSource:
    """Terms of what a loop gathers, with what has to be handed to it.

    values : by the names of what is gathered.
    slots : what stands in the columns of its table, of which there are `width`.
    rows : numbers that depend on the crank angle alone, of which its grid is made.
    watched : dyads of the watched numbers; the first number of a dyad is its own margin.
    running : links whose angle is taken from that of the base.
    gathered : columns of what it fills: those that are wanted, then the others below.
    weakest, strongest : columns of the smallest and the largest value of each watched number.
    nearest : columns of how near the running links stay to the base's: smallest cosine between.
    carried : from crank angle to crank angle; none where each stands alone.
    following : what these are after the crank angle.
    ends : for each of `WATCHED` the columns of its last values.
    has_shares : whether the last row of its grid has the share of each crank angle in a mean.
    """

    values: Mapping[str, Any]
    slots: tuple[Slot, ...]
    width: int
    rows: tuple[AngleFunction, ...]
    watched: tuple[int, ...]
    running: tuple[str, ...]
    gathered: Gathered
    weakest: slice
    strongest: slice
    nearest: slice
    carried: tuple[Recurrence, ...]
    following: tuple[Any, ...]
    ends: Mapping[str, list[int]]
    has_shares: bool = False

    @cached_property
    def signals(self) -> tuple[str, ...]:
        """Names of values that are gathered at each crank angle."""
        return tuple(name for name in self.gathered.signals if name in self.values)

    @cached_property
    def outputs(self) -> list[Any]:
        """Values of signals, then what is carried on."""
        return [*(self.values[name] for name in self.signals), *self.following]

    @cached_property
    def _by_angle(self) -> list[Term]:
        """Terms in the rows of the grid."""
        return boundary(self.outputs, ANGLE)

    def grid(self, theta: Array, given: Mapping[str, Array] | None = None) -> Array:
        """Rows (G, N) for the loop of crank angles (N,), rad.

        given : rows of a march, by name.
        """
        names = {item.args[0] for item in reached(self._by_angle) if item.op == "argument"}
        known = {row.name: row.values(theta) for row in self.rows if row.name in names}
        values = on_arrays(self._by_angle)(**known, **(given or {}))
        grid = [np.broadcast_to(value, np.shape(theta)) for value in values]
        return np.array(grid, dtype=float).reshape(len(grid), len(theta))

    @cached_property
    def text(self) -> str:
        """The loop, for Numba."""
        outputs = without_calls(self.outputs)
        lines = Lines(outputs, PYTHON, {item: f"r{k}" for k, item in enumerate(self._by_angle)})
        loop = _march(self, lines) if self.carried else _loop(self, lines)
        head = ["from numpy import array", "", *lines.tables, ""] if lines.tables else [""]
        return "\n".join([HEAD, "", *head, *loop, ""])

    @cached_property
    def states(self) -> Callable[..., tuple[Any, ...]]:
        """Outputs as a function of arrays: columns of the table, rows of the grid, and what is
        carried.
        """
        names = {item: f"r{k}" for k, item in enumerate(self._by_angle)}
        columns = [f"d{k}" for k in range(self.width)]
        arguments = [*columns, *names.values(), *(item.before.args[0] for item in self.carried)]
        return _function(flat(self.outputs, arguments, names))


def on_arrays(outputs: Sequence[Any]) -> Callable[..., tuple[Any, ...]]:
    """Outputs as a function of NumPy's arrays, by the names of arguments."""
    arguments = [item.args[0] for item in reached(outputs) if item.op == "argument"]
    return _function(flat(outputs, arguments))


def flat(
    outputs: Sequence[Any], arguments: Iterable[str], names: Mapping[Any, str] = NO_NAMES
) -> str:
    """Source of a function ``states`` of arrays that returns outputs."""
    lines = Lines(outputs, PYTHON, dict(names))
    body = [*lines.write((DESIGN, ANGLE, BOTH), outputs)]
    results = "".join(f"{lines.text(output)}, " for output in outputs)
    head = f"def states({', '.join(arguments)}):"
    return "\n".join(
        [*lines.tables, head, *(f"    {item}" for item in body), f"    return ({results})"]
    )


def pick_from(table: Array, place: Any) -> Any:
    """Numbers of a table by their places; the first or last where there is no such."""
    return table[np.clip(np.nan_to_num(place), 0, len(table) - 1).astype(int)]


NUMPY = {
    name: getattr(np, name)
    for name in ("sqrt", "abs", "floor", "rint", "cos", "sin", "arctan2", "where", "array")
} | {"min": np.minimum, "max": np.maximum, "pick": pick_from}
"""Functions that lines for arrays call."""


@cache
def _function(text: str) -> Callable[..., tuple[Any, ...]]:
    space = dict(NUMPY)
    exec(text, space)
    return space["states"]  # type: ignore[no-any-return]


def source_of(
    trace: Trace, wanted: Gathered, signals: Mapping[str, Any], has_shares: bool = False
) -> TermSource:
    """The source of what is wanted of a trace; signals : their values by name."""
    numbers = trace.numbers()
    margins = {f"margin {k}": number for k, (number, _) in enumerate(numbers)}
    cosines = {f"cosine {k}": cosine for k, cosine in enumerate(trace.running.values())}
    ends = {f"carried {k}": item.watch for k, item in enumerate(trace.carried) if item.watch}
    columns = [
        wanted.columns,
        [(name, "lowest") for name in margins],
        [(name, "highest") for name in margins],
        [(name, "lowest") for name in cosines],
        [(name, "highest") for name in ends],
    ]
    places = pairwise(accumulate(map(len, columns), initial=0))
    _, weakest, strongest, nearest, last = (slice(*both) for both in places)
    watches = [*enumerate(ends.values(), last.start)]
    return TermSource(
        {**signals, **margins, **cosines},
        tuple(trace.slots.values()),
        trace.width,
        tuple(trace.rows.values()),
        tuple(dyad for _, dyad in numbers),
        tuple(trace.running),
        Gathered(tuple(chain(*columns))),
        weakest,
        strongest,
        nearest,
        tuple(trace.carried),
        tuple(trace.following[item.before] for item in trace.carried),
        {watch: [k for k, item in watches if item == watch] for watch in WATCHED},
        has_shares,
    )


# -- the loop --------------------------------------------------------------------------------------


def _loop(source: TermSource, lines: Lines) -> Iterator[str]:
    columns = {c: f"g{k}" for k, c in enumerate(source.gathered.columns) if c[1] in KINDS}
    own = boundary(lines.outputs, DESIGN)
    yield HEADER
    yield "    for i in range(table.shape[0]):"
    yield from _indented(2, _of_design(lines, own))
    yield from _indented(
        2, (f"{name} = {KINDS[kind].start}" for (_, kind), name in columns.items())
    )
    yield "        for k in range(grid.shape[1]):"
    yield from _indented(3, _of_angle(source))
    yield from _indented(3, lines.write((BOTH,), lines.outputs))
    signals = dict(zip(source.signals, map(lines.text, lines.outputs), strict=True))
    yield from _indented(3, _gathering(source, columns, signals))
    yield from _indented(3, _sampling(source, "i", signals))
    yield from _indented(2, (f"out[i, {name[1:]}] = {name}" for name in columns.values()))


def _indented(depth: int, lines: Iterable[str]) -> Iterator[str]:
    return (f"{'    ' * depth}{line}" for line in lines)


def _of_design(lines: Lines, own: Sequence[Term]) -> Iterator[str]:
    """Lines for what one design has of its own, the row i of the table."""
    for term in lines.terms:
        if term.op == "argument" and term.mask == DESIGN:
            yield f"{term.args[0]} = table[i, {term.args[0][1:]}]"
    yield from lines.write((DESIGN,), own)


def _of_angle(source: TermSource, first: int = 0) -> Iterator[str]:
    """Lines for the grid's rows from this one on."""
    rows = [f"r{k}" for k in range(len(source._by_angle))]
    rows += ["share"] * source.has_shares
    return (f"{name} = grid[{k}, k]" for k, name in enumerate(rows, first))


def _march(source: TermSource, lines: Lines) -> Iterator[str]:
    """The loop where crank angles follow from each other: some designs go round side by side.

    What they have of their own lies in `work`, each value of all of them in a row.
    """
    own = boundary(lines.outputs, DESIGN)
    signals = {signal: f"x{k}" for k, signal in enumerate(source.signals)}
    columns = {
        c: f"g{k}"
        for k, c in enumerate(source.gathered.columns)
        if c[0] in signals and c[1] in KINDS
    }
    before = [item.before.args[0] for item in source.carried]
    setting = [*_of_design(lines, own)]
    going = [*lines.write((BOTH,), lines.outputs)]
    given = [*map(lines.text, own), *before]
    results = [*map(lines.text, lines.outputs)]
    at = {
        name: f"work[{k * LANES} + lane]"
        for k, name in enumerate([*given, *signals.values(), *columns.values()])
    }
    last = iter([item.before.args[0] for item in source.carried if item.watch])
    filled = [
        (k, at[columns.get(c) or next(last)])
        for k, c in enumerate(source.gathered.columns)
        if c[1] in KINDS
    ]

    def get(names: Iterable[str]) -> Iterator[str]:
        return (f"{name} = {at[name]}" for name in names)

    yield HEADER
    yield f"    work = empty({len(at) * LANES})"
    yield f"    for begin in range(0, table.shape[0], {LANES}):"
    yield "        left = table.shape[0] - begin"
    yield f"        lanes = left if left < {LANES} else {LANES}"
    yield f"        for lane in range({LANES}):"
    yield "            i = begin + lane if lane < lanes else begin"
    yield from _indented(3, setting)
    yield from _indented(3, (f"{at[name]} = {name}" for name in given[: len(own)]))
    yield from _indented(
        3, (f"{at[item.before.args[0]]} = {item.start!r}" for item in source.carried)
    )
    yield from _indented(
        3, (f"{at[name]} = {KINDS[kind].start}" for (_, kind), name in columns.items())
    )
    yield "        for k in range(grid.shape[1]):"
    yield "            place = grid[0, k]"
    yield from _indented(3, _of_angle(source, 1))
    yield f"            for lane in range({LANES}):"
    yield from _indented(4, get(given))
    yield from _indented(4, going)
    assignments = zip([*signals.values(), *before], results, strict=True)
    yield from _indented(4, (f"{at[name]} = {value}" for name, value in assignments))
    yield "            if place >= 0.0:"
    yield f"                for lane in range({LANES}):"
    yield from _indented(5, get([*signals.values(), *columns.values()]))
    yield from _indented(5, _gathering(source, columns, signals))
    yield from _indented(5, _sampling(source, "begin + lane", signals, "int(place)"))
    yield from _indented(5, (f"{at[name]} = {name}" for name in columns.values()))
    yield "        for lane in range(lanes):"
    yield from _indented(3, (f"out[begin + lane, {k}] = {x}" for k, x in filled))


def _gathering(
    source: TermSource,
    columns: Mapping[tuple[str, str], str],
    signals: Mapping[str, str],
) -> Iterator[str]:
    """Lines that take in the signals' values at a crank angle."""
    for (signal, kind), name in columns.items():
        line = (source.has_shares and KINDS[kind].shared) or KINDS[kind].add
        yield line.format(g=name, x=signals[signal])


def _sampling(
    source: TermSource, design: str, signals: Mapping[str, str], number: str = "k"
) -> Iterator[str]:
    """Lines that keep the values of signals whose extremes are wanted, at the crank angle of this
    number.
    """
    for k, signal in enumerate(source.gathered.sampled):
        yield f"samples[{design}, {k}, {number}] = {signals[signal]}"
