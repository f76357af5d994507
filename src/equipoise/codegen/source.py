"""Terms as source: lines of a language, and what a loop over designs and crank angles computes.

Angles and rotations that differ by design are polynomials, since the call of a library would keep
the processor from several designs at once.  They are Chebyshev interpolations, exact to 1e-17.

`TermSource` holds the terms of what is gathered, and what has to be handed to a loop: columns of a
table, one row a design, and rows of a grid, one column a crank angle.  Its loop is compiled by
Numba; NumPy runs `states`, the same terms on arrays.

Where a group of loops goes from one crank angle to the next, each crank angle takes what the one
before carries on, and the loop does some designs side by side, so that the processor can still
handle several at once: `codegen.loops`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from functools import cache, cached_property, reduce
from itertools import accumulate, chain, pairwise
from typing import Any

import numpy as np

from equipoise.codegen.figures import KINDS, Gathered
from equipoise.codegen.loops import WATCHED
from equipoise.codegen.terms import (
    ANGLE,
    BOTH,
    DESIGN,
    LEAVES,
    Term,
    VectorTerm,
    nearest,
    reached,
    replaced,
    root,
)
from equipoise.codegen.trace import AngleFunction, Recurrence, Slot, Trace
from equipoise.dataclass import dataclass
from equipoise.signals import Array

DEEPEST = 12
"""Operations within each other in a line, so that no parser finds a line too deep."""
COMMON = {
    "+": "({} + {})",
    "-": "({} - {})",
    "*": "({} * {})",
    "negative": "(-{})",
    "inverse": "(1.0 / {})",
    "pick": "pick({}, {})",
}


@dataclass(frozen=True)
class Language:
    """How operations are written.

    forms : of each operation, with places for what it is done to.  line : that gives a value a
    name.  table : that does so for numbers that one is picked of.
    """

    forms: Mapping[str, str]
    line: str
    table: str

    def operation(self, op: str, args: Sequence[str]) -> str:
        form = self.forms["negative" if op == "-" and len(args) == 1 else op]
        return form.format(*args)


def _calls(names: Mapping[str, str]) -> dict[str, str]:
    counts = {"min": 2, "max": 2}
    return {op: f"{name}({', '.join(['{}'] * counts.get(op, 1))})" for op, name in names.items()}


_PLAIN = {op: op for op in ("sqrt", "abs", "floor", "cos", "sin", "min", "max")}
PYTHON = Language(
    COMMON | _calls(_PLAIN | {"round": "rint"})
    | {"angle": "arctan2({1}, {0})", "select": "where({} >= {}, {}, {})"},
    "{} = {}",
    "{} = array([{}])",
)  # fmt: skip
"""For NumPy's arrays, and compiled by Numba."""
C = Language(
    COMMON | _calls(_PLAIN | {"abs": "fabs", "min": "fmin", "max": "fmax", "round": "rint"})
    | {"angle": "atan2({1}, {0})", "select": "({} >= {} ? {} : {})",
       "pick": "pick({0}, sizeof {0} / sizeof *{0}, {1})"},
    "const double {} = {};",
    "static const double {}[] = {{{}}};",
)  # fmt: skip
JAVASCRIPT = Language(
    COMMON | _calls({op: f"Math.{name}" for op, name in _PLAIN.items()} | {"round": "Math.round"})
    | {"angle": "Math.atan2({1}, {0})", "select": "({} >= {} ? {} : {})"},
    "const {} = {};",
    "const {} = Float64Array.of({});",
)  # fmt: skip


@dataclass
class Lines:
    """Lines of a language for outputs, each term that is used more than once in one of its own.

    names : of terms that are known, or have been written.  tables : lines for tables.
    used : terms by whose names lines were written, since this was last cleared.
    """

    outputs: Sequence[Any]
    language: Language
    names: dict[Term, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.terms = reached(self.outputs, self.names)
        self._uses = Counter(
            arg for term in self.terms if term.op not in LEAVES for arg in term.args
            if type(arg) is Term
        )  # fmt: skip
        self._depths: dict[Term, int] = {}
        self.used: set[Term] = set()
        self.tables: list[str] = []
        for term in self.terms:
            if term.op == "table":
                self.names[term] = f"t{len(self.tables)}"
                values = ", ".join(map(repr, term.args[0]))
                self.tables.append(self.language.table.format(self.names[term], values))
            elif term.op == "argument":
                self.names.setdefault(term, term.args[0])

    def write(self, masks: Collection[int], needed: Iterable[Any] = ()) -> Iterator[str]:
        """Lines for terms that depend on one of these, and are needed, or used more than once."""
        used = {item for item in needed if type(item) is Term}
        for term in self.terms:
            if term.mask not in masks or term in self.names:
                continue
            depth = 1 + max((self._depths.get(arg, 0) for arg in term.args), default=0)
            if self._uses[term] > 1 or term in used or depth > DEEPEST:
                text, depth = self.text(term), 0
                self.names[term] = name = f"v{len(self.names)}"
                yield self.language.line.format(name, text)
            self._depths[term] = depth

    def text(self, value: Any) -> str:
        """A value as an expression."""
        if type(value) is not Term:
            number = repr(float(value))
            return f"({number})" if number.startswith("-") else number
        if value in self.names:
            self.used.add(value)
            return self.names[value]
        return self.language.operation(value.op, [self.text(arg) for arg in value.args])


def boundary(outputs: Iterable[Any], mask: int) -> list[Term]:
    """Terms of this dependence that outputs, or terms of another dependence, are made of."""
    outputs = list(outputs)
    used = {arg for term in reached(outputs) if term.op not in LEAVES and term.mask != mask
            for arg in term.args if type(arg) is Term}  # fmt: skip
    used |= {output for output in outputs if type(output) is Term}
    return [item for item in sorted(used, key=lambda term: term.order) if item.mask == mask]


ARC = (
    -0.005280870051487617,
    0.018095230564342743,
    -0.032661656028653945,
    0.043802683513332864,
    -0.051663638584717154,
    0.05864670804294048,
    -0.0666435417001706,
    0.07692094669579978,
    -0.09090895671012374,
    0.11111110560344459,
    -0.14285714272114403,
    0.19999999999824117,
    -0.3333333333333243,
    1.0,
)
"""Arctangent over its argument, by powers of the argument's square, up to tan(2.09 / 4)."""
COSINE = (
    -1.1353379638297575e-11,
    2.0875582380663952e-09,
    -2.7557313097790086e-07,
    2.4801587283881152e-05,
    -0.0013888888888861095,
    0.04166666666666645,
    -0.5,
    1.0,
)
SINE = (
    1.5894736651849094e-10,
    -2.5050716974102745e-08,
    2.755731337640013e-06,
    -0.000198412698286503,
    0.008333333333320363,
    -0.16666666666666616,
    1.0,
)
"""Sine over its argument; both by powers of the argument's square, up to half a turn over 4."""


def _polynomial(coefficients: Iterable[float], z: Any) -> Any:
    return reduce(lambda value, item: value * z + item, coefficients)


def arc(x: Any, y: Any) -> Any:
    """Angle of the unit vector (x, y), of at most 2.09 rad to either side: from the tangent of its
    fourth.
    """
    half = root(0.5 + 0.5 * x)
    quarter = 0.5 * y * (1.0 / (half * (1.0 + half)))
    return 4.0 * quarter * _polynomial(ARC, quarter * quarter)


def turn(angle: Any) -> Any:
    """exp(i angle), as the fourth power of that of a fourth of the angle."""
    turns = angle * 0.15915494309189535
    quarter = (turns - nearest(turns)) * 1.5707963267948966
    z = quarter * quarter
    u = VectorTerm(_polynomial(COSINE, z), quarter * _polynomial(SINE, z))
    u = u * u
    return u * u


def without_calls(outputs: Iterable[Any]) -> list[Any]:
    """Outputs with polynomials in place of functions of the crank angle and the design."""

    def change(term: Term, args: Sequence[Any]) -> Any:
        if term.mask != BOTH or term.op not in ("cos", "sin", "angle"):
            return None
        if term.op == "angle":
            return arc(*args)
        u = turn(*args)
        return u.real if term.op == "cos" else u.imag

    return replaced(outputs, change)


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
