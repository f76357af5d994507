"""Tables as texts: units of columns and rows, digits; the same numbers for every renderer."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import compress
from math import isfinite, isnan

from equipoise.dataclass import dataclass
from equipoise.i18n import Note, decimals, listed, say, spoken
from equipoise.quantities import Dimension, Display, change, display, fixed, typeset
from equipoise.quantities.numbers import ROUNDING
from equipoise.results.blocks import (
    FAINT,
    FAINT_IN_ROW,
    Cell,
    Column,
    Emphasis,
    Many,
    RelativeChange,
    Span,
    Table,
    Value,
)

CellUnit = tuple[Dimension | None, str | None]
"""Dimension and unit of a number; those of one kind have one unit in a table."""
Sizes = Mapping[tuple[int, CellUnit], float]
"""The largest number of each kind in each column; numbers that are rounding beside it show as 0."""
UNCHANGED = change(1.0, 1.0)
"""Text of `change` for two equal figures."""


@dataclass(frozen=True)
class CellText:
    """A cell as text.

    at : where the value holds.  number : whether it is set to the right.
    limit : the limit that the value breaks; empty if not shown.
    """

    text: str = ""
    at: str = ""
    number: bool = False
    emphasis: Emphasis | None = None
    limit: str = ""

    @property
    def text_with_note(self) -> str:
        """As print has it: the value, and behind it where it holds, or the limit that it breaks."""
        if self.limit:
            over = say("over the limit of {limit}", limit=self.limit)
            return listed(self.text, over)
        return f"{self.text}\N{NO-BREAK SPACE}({self.at})" if self.at else self.text


@dataclass(frozen=True)
class Head:
    """A heading: its words, the unit below them, and the unit of where the values hold."""

    label: str
    unit: str = ""
    at: str = ""

    @property
    def heading(self) -> str:
        """In one line."""
        units = f"{self.unit} ({self.at})" if self.at else self.unit
        return say(", ").join(filter(None, (self.label, units.strip())))


@dataclass(frozen=True)
class Grid:
    """A table whose cells are texts; units and numbers in plain signs."""

    title: str
    heads: tuple[Head, ...]
    rows: tuple[tuple[CellText, ...], ...]

    def is_words(self, column: int) -> bool:
        """Whether the cells of a column are words, which are set to the left."""
        return not any(row[column].number for row in self.rows)

    @property
    def leading(self) -> int:
        """Number of columns that name the rows: two, both of words, if the first has duplicates."""
        names = {row[0].text for row in self.rows}
        return 2 if len(names) < len(self.rows) and self.is_words(0) and self.is_words(1) else 1


def grid(table: Table) -> Grid:
    """A table as texts; a unit of a row stands behind its first words.  What no row has has no
    column.
    """
    sizes = _sizes(table)
    displays = _displays(table, sizes)
    rows = tuple(tuple(_row(table, row, displays, sizes)) for row in table.rows)
    if not rows:
        return Grid(table.title, tuple(Head(column.label) for column in table.columns), ())
    columns = zip(table.columns, zip(*table.rows, strict=True), strict=True)
    heads = (_head(*pair, displays) for pair in columns)
    is_sos = [any(cell.text for cell in cells) for cells in zip(*rows, strict=True)]
    return Grid(
        table.title,
        tuple(compress(heads, is_sos)),
        tuple(tuple(compress(row, is_sos)) for row in rows),
    )


def _row(
    table: Table, row: tuple[Cell, ...], displays: Mapping[CellUnit, Display], sizes: Sizes
) -> Iterator[CellText]:
    unit = _unit_of_row(table, row, displays)
    faint = _faint(table, row, sizes)
    for place, (column, cell) in enumerate(zip(table.columns, row, strict=True)):
        least = {kind: size for (at, kind), size in sizes.items() if at == place}
        text = _text(cell, column, displays, least, faint if column.alike else {})
        if place == 0 and unit:
            comma = say(", ").replace(" ", "\N{NO-BREAK SPACE}")
            text = replace(text, text=comma.join(filter(None, (text.text, unit))))
        yield text


def _faint(table: Table, row: tuple[Cell, ...], sizes: Sizes) -> dict[CellUnit, float]:
    """Of each kind with a dimension, the size up to which numbers of a row have no meaning."""
    whole = {kind: 0.0 for _, kind in sizes if kind[0] is not None}
    for (place, kind), size in sizes.items():
        if kind in whole and table.columns[place].alike:
            whole[kind] = max(whole[kind], FAINT * size)
    for column, cell in zip(table.columns, row, strict=True):
        for value in _values(cell):
            kind = _kind(value, column)
            if kind in whole and isfinite(value.value):
                whole[kind] = max(whole[kind], FAINT_IN_ROW * abs(value.value))
    return whole


def _unit_of_row(table: Table, row: tuple[Cell, ...], displays: Mapping[CellUnit, Display]) -> str:
    """Unit of the numbers of a row in columns without a dimension of their own."""
    own = (
        displays[_kind(value, column)].unit
        for column, cell in zip(table.columns, row, strict=True)
        for value in _values(cell)
        if value.dimension is not None and column.dimension is None
    )
    return next(own, "")


def _values(cell: Cell) -> tuple[Value, ...]:
    if isinstance(cell, Many):
        return cell.values
    if isinstance(cell, Span):
        return (Value(cell.low), Value(cell.high))
    return (cell,) if isinstance(cell, Value) else ()


def _kind(value: Value, column: Column) -> CellUnit:
    if value.dimension is not None:
        return value.dimension, value.unit
    return column.dimension, column.unit


def _sizes(table: Table) -> dict[tuple[int, CellUnit], float]:
    """The largest number of each kind in each column, but for what is rounding by its own scale."""
    sizes: dict[tuple[int, CellUnit], float] = {}
    for row in table.rows:
        for place, (column, cell) in enumerate(zip(table.columns, row, strict=True)):
            for value in _values(cell):
                size = abs(value.value) if isfinite(value.value) else 0.0
                size = 0.0 if size <= ROUNDING * abs(value.scale) else size
                key = place, _kind(value, column)
                sizes[key] = max(sizes.get(key, 0.0), size)
    return sizes


def _displays(table: Table, sizes: Sizes) -> dict[CellUnit, Display]:
    """The unit of each kind of number: the same in the whole table, so that they compare."""
    kinds: dict[CellUnit, list[float]] = {}
    for column in table.columns:
        kinds |= {(column.dimension, column.unit): [], column.at: []}
    for (_, kind), size in sizes.items():
        kinds.setdefault(kind, []).append(size)
    return {kind: _display(*kind, values) for kind, values in kinds.items()}


def _display(dimension: Dimension | None, unit: str | None, values: Iterable[float]) -> Display:
    if dimension is None:
        return Display(unit or "", 1.0)
    return display(dimension, [*values], unit)


def _head(column: Column, cells: tuple[Cell, ...], displays: Mapping[CellUnit, Display]) -> Head:
    is_so = any(value.at is not None for cell in cells for value in _values(cell))
    at = displays[column.at].unit if is_so else ""
    return Head(column.label, displays[column.dimension, column.unit].unit, at)


_IS_NUMBER = re.compile(r"[(+\-\N{MINUS SIGN}\N{PLUS-MINUS SIGN}]*[0-9]")
"""What a cell of words begins with that is a number, or a range of such, and no name."""


# -- cells -----------------------------------------------------------------------------------------


def _text(
    cell: Cell,
    column: Column,
    displays: Mapping[CellUnit, Display],
    sizes: Mapping[CellUnit, float],
    faint: Mapping[CellUnit, float],
) -> CellText:
    if cell is None or isinstance(cell, str):
        return CellText(decimals(cell) if cell and _IS_NUMBER.match(cell) else cell or "")
    if isinstance(cell, RelativeChange):
        share = change(cell.before, cell.after)
        text = say("same") if share == UNCHANGED else decimals(share)
        return CellText(text, "", True, cell.emphasis)
    if isinstance(cell, Many):
        values = [_text(value, column, displays, sizes, faint) for value in cell.values]
        labels = [say("and {count} more", count=cell.omitted)] if cell.omitted else []
        words = say(", ").join([*(item.text_with_note for item in values), *labels])
        return CellText(
            words, emphasis=next((item.emphasis for item in values if item.emphasis), None)
        )
    if isinstance(cell, Span):
        kind = column.dimension, column.unit
        unit, size = displays[kind], sizes[kind]
        scale = max(abs(cell.low), abs(cell.high), cell.scale)
        ends = [Value(end, scale, None, cell.digits, cell.after) for end in (cell.low, cell.high)]
        least = faint.get(kind, 0.0)
        low, high = (_number(end, unit, column.dimension, size, least) for end in ends)
        equal = cell.high - cell.low <= ROUNDING * scale or low == high
        return CellText(high if equal else say("{low} to {high}", low=low, high=high), number=True)
    kind = _kind(cell, column)
    text = _number(cell, displays[kind], kind[0], sizes[kind] * column.alike, faint.get(kind, 0.0))
    at = ""
    if cell.at is not None:
        place = Value(cell.at, after=1 if column.at[0] == "angle" else None)
        at = _number(place, displays[column.at], column.at[0])
    limit = "" if cell.limit is None else decimals(f"{cell.limit * displays[kind].factor:.4g}")
    return CellText(text, at, number=True, emphasis=cell.emphasis, limit=limit)


def _number(
    cell: Value,
    unit: Display,
    dimension: Dimension | None,
    size: float = 0.0,
    faint: float = 0.0,
) -> str:
    """A value as text.

    size : of the largest beside it; plain numbers have none in common.  faint : up to which a
    number is shown as 0.
    """
    if isnan(cell.value):
        return say("none")
    if cell.after is None and abs(cell.value) < faint:
        return "0"
    if cell.after is None:
        scale = abs(cell.scale) if dimension is None else max(abs(cell.scale), size)
        return decimals(unit.text(cell.value, scale, cell.digits))
    return decimals(fixed(unit, cell.value, cell.after))


# -- print -----------------------------------------------------------------------------------------

_MINUS = re.compile(r"(?<![\w.)²³⁻])-(?=[0-9])")
_POWER = re.compile(r"[0-9]e[+-][0-9]+")
_RAISED = re.compile(r"(?<=[a-z])\^[23]")
_UNIT = re.compile(r"(?<![A-Za-z])(k?N|k?g) (mm?|s)(?![A-Za-z])")
_VALUE = re.compile(
    r"(?<=[0-9)]) (?=(?:k?N|k?g|k?J|[cm]?m|m?rad|m?s|min|h|rpm|Hz|deg|[%°])[²³]?(?![A-Za-z0-9]))"
)


def printed(text: str) -> str:
    """A text as print has it: true minus, raised powers, no line that ends before a unit."""
    text = _POWER.sub(lambda result: typeset(f"{result[0]}"), text)
    text = _MINUS.sub("\N{MINUS SIGN}", text)
    text = _RAISED.sub(lambda match: typeset(match[0]), text)
    return bound(text)


def bound(text: str) -> str:
    """A text with spaces at which no line is broken before a unit and in it."""
    return _VALUE.sub("\N{NO-BREAK SPACE}", _UNIT.sub("\\1\N{NO-BREAK SPACE}\\2", text))


def sign_of(unit: str) -> str:
    """A unit as print has it."""
    return printed(Display(unit, 1.0).name)


def printed_grid(table: Table) -> Grid:
    """A table as texts that are ready for print."""
    text = grid(table)
    heads = (Head(printed(head.label), sign_of(head.unit), sign_of(head.at)) for head in text.heads)
    rows = (
        tuple(replace(item, text=printed(item.text), at=printed(item.at)) for item in row)
        for row in text.rows
    )
    return Grid(printed(text.title), tuple(heads), tuple(rows))


def with_omitted(text: str, omitted: int) -> str:
    """A text, and how many further ones are left out."""
    return say("{what} (and {count} more)", what=text, count=omitted) if omitted else text


def noted(note: Note | str) -> str:
    """A note in the language that is spoken; what that lacks, in its original wording."""
    if isinstance(note, Note) and note.is_translated:
        return say("Note: {note}", note=note.localized())
    if spoken() == "en":
        return say("Note: {note}", note=note)
    return say("Note, in its original wording: {note}", note=note)
