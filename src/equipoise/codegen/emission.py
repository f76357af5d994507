"""Terms as lines of source in a language."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from typing import Any

from equipoise.codegen.terms import LEAVES, Term, reached
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
