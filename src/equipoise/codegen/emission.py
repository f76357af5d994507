"""Terms as lines of source in a language, and angles by polynomials.

A call of a library would keep them from that.  The polynomials are Chebyshev interpolations, exact
to 1e-17.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from functools import reduce
from typing import Any

from equipoise.codegen.terms import BOTH, LEAVES, Term, VectorTerm, nearest, reached, replaced, root
from equipoise.dataclass import dataclass

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
