"""How outputs of results are declared: JSON, CSV, tables, dimensions and documentation follow.

A class that holds outputs has them as ``declared``, by key in the order of its JSON object:

    declared = {
        "peak": ResultOutput("largest force", "force", heading=to_say("peak")),
    }
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from operator import attrgetter
from typing import Any, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import say
from equipoise.quantities import SI, Dimension
from equipoise.results.blocks import Cell, Column, Table, Value
from equipoise.signals import Array

CsvColumn = tuple[str, str, Array]
"""Name, SI unit and values of a column of a CSV file."""
OwnDimension = Literal["own"]
OWN: OwnDimension = "own"
"""The dimension of a figure that has that of the output whose figure it is."""
FIGURES_OF_LISTS = ("mean", "rms", "peak", "max", "min", "peak_to_peak")
PLACES = ("peak_at", "max_at", "min_at")
"""Figures of a list of numbers, and where along its abscissa these are."""
ALONG: dict[str, Dimension] = {"crank_angle": "angle", "speed": "angular speed"}
"""Keys along which lists of a result may run, and their dimensions."""


@dataclass(frozen=True)
class ResultOutput:
    """One output of a result, or a group of outputs.

    Parameters
    ----------
    meaning : in English, for the documentation.
    dimension : of its values, which are in SI units; `OWN` for that of the group in which it
        stands, None of texts and plain numbers.
    turned : the dimension of a gauge or mount that turns about an axis, where it differs.
    read : gets the value from the object that declares it, or names an attribute of it; by default
        that of its key.
    of : the outputs of the value, or of each where the value is a list or a family.
    many : whether the value is a list.
    family : whether the value maps names to values of one kind.
    members : names of a family in a model, and whether each turns; not needed where none does.
    named : name of an entry of a list in columns of the CSV file.
    lookup : dimension of what stands below by names that are declared elsewhere.
    spliced : whether the outputs below it stand in the place of its key.
    present : attribute of an object that is not None nor empty where it has this.
    slow : whether it is left out where only other keys are wanted.
    along : key of the abscissa of its lists.
    nulls : whether its arrays become lists with None for what is not finite.
    column : its part of a name in the CSV file, with ``{}`` for the member of a family; None where
        it is not there.
    series : attribute of the object that the CSV file holds, where that is not the value.
    rank : of its column among those beside it.
    heading, unit : of its column in a table, and the unit in which it is shown; no heading, no
        column.
    cell : makes the cell of the object that declares it; by default of the value.
    table : title under which the documentation lists the outputs of a group that others share.
    """

    meaning: str
    dimension: Dimension | OwnDimension | None = None
    turned: Dimension | None = None
    read: Callable[[Any], Any] | str = ""
    of: dict[str, ResultOutput] | None = None
    many: bool = False
    family: bool = False
    members: Callable[[Any], Mapping[str, bool]] | None = None
    named: Callable[[Any], str] | None = None
    lookup: Callable[[Any, str], Dimension | None] | None = None
    spliced: bool = False
    present: str = ""
    slow: bool = False
    along: str = ""
    nulls: bool = False
    column: str | None = None
    series: str = ""
    rank: int = 0
    heading: str = ""
    unit: str | None = None
    cell: Callable[[Any], Cell] | None = None
    table: str = ""

    def value(self, key: str, holder: Any) -> Any:
        """The value of an object, as it holds it."""
        read = self.read or key
        return attrgetter(read)(holder) if isinstance(read, str) else read(holder)

    def is_in(self, holder: Any) -> bool:
        """Whether an object has it at all."""
        value = attrgetter(self.present)(holder) if self.present else True
        return bool(value) if isinstance(value, Mapping | tuple) else value is not None

    def plain(self, value: Any) -> Any:
        """The value as plain data."""
        if self.nulls:
            return _with_nulls(value)
        if value is None:
            return None
        if self.of is None:
            return dict(value) if isinstance(value, Mapping) else value
        if self.family:
            return {name: values_of(item, self.of) for name, item in value.items()}
        if self.many:
            return [values_of(item, self.of) for item in value]
        return values_of(value, self.of)

    def kind(self, own: Dimension | None, turned: bool) -> Dimension | None:
        """Dimension, in a group of this dimension, of a part that may turn."""
        if self.dimension == OWN:
            return own
        return self.turned if turned and self.turned else self.dimension

    @property
    def has_columns(self) -> bool:
        """Whether outputs below it are columns of the CSV file."""
        return any(item.column is not None for item in (self.of or {}).values())


def _with_nulls(values: Array) -> list[Any]:
    result = values.astype(object)
    result[~np.isfinite(values)] = None
    return list(result.tolist())


Declarations = dict[str, ResultOutput]
TITLE = ResultOutput("title of the model")
NOTES = ResultOutput(
    "what a reader has to know, in sentences", read=lambda result: list(map(str, result.notes))
)


def values_of(
    holder: Any, declared: Declarations, wanted: Collection[str] | None = None
) -> dict[str, Any]:
    """All outputs of an object as plain data in SI units.

    wanted : keys that are needed of those that are slow; None for all.
    """
    values: dict[str, Any] = {}
    for key, item in declared.items():
        if item.is_in(holder) and (not item.slow or wanted is None or key in wanted):
            value = item.plain(item.value(key, holder))
            values |= value if item.spliced else {key: value}
    return values


def flat(declared: Declarations) -> Declarations:
    """Declarations with those in the place of others among them, as keys of the JSON object."""
    declarations: Declarations = {}
    for key, item in declared.items():
        declarations |= flat(item.of) if item.spliced and item.of is not None else {key: item}
    return declarations


# -- columns of CSV files --------------------------------------------------------------------------


def columns_of(
    holder: Any,
    declared: Declarations,
    sampled: Callable[[Any], Array] = np.asarray,
    model: Any = None,
    before: str = "",
    turned: bool = False,
) -> Iterator[CsvColumn]:
    """The columns of an object's CSV file.

    sampled : makes the values of a column.  model : the machine or tool, which knows the members
    of families.  before : what names begin with.  turned : whether the object is of a part that
    turns.
    """
    for key, item in sorted(declared.items(), key=lambda pair: pair[1].rank):
        if item.column is None or not item.is_in(holder):
            continue
        value = getattr(holder, item.series) if item.series else item.value(key, holder)
        if value is None:
            continue
        named = value.items() if isinstance(value, Mapping) else [("", value)]
        if item.many:
            named = [("" if item.named is None else item.named(part), part) for part in value]
        members = {} if item.members is None else item.members(model)
        for name, part in named:
            column = before + item.column.format(name)
            turns = members.get(name, turned)
            if item.of is not None and item.has_columns:
                yield from columns_of(part, item.of, sampled, model, column, turns)
            else:
                dimension = item.kind(None, turns)
                yield column, "1" if dimension is None else SI[dimension], sampled(part)


# -- dimensions by path ----------------------------------------------------------------------------


def dimension_at(declared: Declarations, path: str, model: Any = None) -> Dimension | None:
    """Dimension of the value at a dotted path, without places in lists; None of plain numbers.

    model : the machine or tool, which knows the members of families.
    """
    return next(_matching(declared, path, model, None, False), None)


def _matching(
    declared: Declarations, path: str, model: Any, own: Dimension | None, turned: bool
) -> Iterator[Dimension | None]:
    for key, item in declared.items():
        if item.spliced:
            rest = path
        elif f"{path}.".startswith(f"{key}."):
            rest = path[len(key) + 1 :]
        else:
            continue
        for after, turns in _members(item, rest, model) if item.family else [(rest, turned)]:
            kind = item.kind(own, turns)
            if item.lookup is not None:
                if (known_elsewhere := item.lookup(model, after)) is not None:
                    yield known_elsewhere
            elif item.of is not None:
                yield from _matching(item.of, after, model, kind, turns)
            elif after in ("", *FIGURES_OF_LISTS):
                yield kind
            elif after in PLACES and item.along:
                yield ALONG[item.along]


def _members(output: ResultOutput, rest: str, model: Any) -> Iterator[tuple[str, bool]]:
    """What may stand behind the name of a member, and whether that turns; names may hold dots."""
    known = None if output.members is None else output.members(model)
    words = rest.split(".")
    for count in range(len(words), 0, -1):
        name = ".".join(words[:count])
        if known is None or name in known:
            yield ".".join(words[count:]), bool(known and known[name])


# -- tables ----------------------------------------------------------------------------------------


def table_of(
    title: str, rows: Mapping[str, Any], declared: Declarations, before: Sequence[str] = ("",)
) -> Table:
    """A table with a row for each object by its name, and a column for each headed output.

    before : headings of what stands before them, the name among it.
    """
    heads = [*before, *headings(declared)]
    return Table.of(title, heads, ((name, *cells_of(row, declared)) for name, row in rows.items()))


def headings(declared: Declarations, turned: bool = False) -> Iterator[Column]:
    """The columns of headed outputs.  turned : whether they are of what turns."""
    for item in declared.values():
        if item.heading:
            yield Column(say(item.heading), item.kind(None, turned), item.unit)


def cells_of(holder: Any, declared: Declarations) -> Iterator[Cell]:
    """The cells of an object below these."""
    for key, item in declared.items():
        if item.heading:
            yield Value(float(item.value(key, holder))) if item.cell is None else item.cell(holder)


def figures_of(holder: Any, declared: Declarations) -> Iterator[Table]:
    """A table of the headed outputs of one object, a row for each, where there are any."""
    rows = [
        (column.label, replace(cell, dimension=column.dimension, unit=column.unit))
        for column, cell in zip(headings(declared), cells_of(holder, declared), strict=True)
        if isinstance(cell, Value)
    ]
    if rows:
        yield Table.of(say("Figures"), ("", ""), rows)


# -- documentation ---------------------------------------------------------------------------------


def documented(declared: Declarations) -> str:
    """The outputs of a result as a table of the documentation, in Markdown."""
    head = "| key | unit | meaning | CSV |\n|---|---|---|---|\n"
    return head + "".join(_rows(declared, ""))


def _rows(declared: Declarations, before: str) -> Iterator[str]:
    for key, item in declared.items():
        path = before.removesuffix(".") if item.spliced else before + key
        path += ".NAME" * item.family + "[1]" * (item.many and item.of is not None)
        csv = "" if item.column is None or item.has_columns else "yes"
        if csv and (item.spliced or item.column != key):
            csv = f"`{item.column}`"
        if path and not (item.spliced and item.of and not item.table):
            yield f"| `{path}` | {unit_shown(item)} | {item.meaning} | {csv} |\n"
        if item.of is not None and not item.table:
            yield from _rows(item.of, before if item.spliced else f"{path}.")


def unit_shown(output: ResultOutput) -> str:
    """SI unit of an output for the documentation."""
    kinds: Iterable[Any] = dict.fromkeys(filter(None, (output.dimension, output.turned)))
    return " or ".join("that of the signal" if kind == OWN else SI[kind] for kind in kinds)
