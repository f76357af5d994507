"""What a result shows, as plain values: whatever renders it, a terminal, a page or a notebook.

A result builds its blocks in the language that is spoken.  Numbers stay as they are, in SI units;
who renders them chooses digits and signs by `equipoise.quantities`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import takewhile
from math import isclose
from typing import Any, ClassVar, Literal

from equipoise.dataclass import dataclass
from equipoise.i18n import Note, say
from equipoise.quantities import Dimension
from equipoise.results.charts import Chart

Emphasis = Literal["broken", "worse"]
"""Why something has to stand out: a limit is broken, or a figure has got worse."""


def broken_if(so: bool) -> Emphasis | None:
    """The emphasis of what breaks a limit, if it does."""
    return "broken" if so else None


def worse_if(so: bool) -> Emphasis | None:
    """The emphasis of what got worse, if it did."""
    return "worse" if so else None


# -- cells of tables -------------------------------------------------------------------------------


FAINT, FAINT_IN_ROW = 1e-5, 1e-4
"""Over the largest number of its kind in a table, and in a row, which has one subject: a smaller
number has no meaning for a reader, since the large one has four digits, and is shown as 0."""


@dataclass(frozen=True)
class Value:
    """A number in a table, in SI units; a plain number where it has no dimension.

    scale : beside which a smaller value is rounding, and is shown as 0.
    at : where it holds, such as a crank angle, rad; not shown where None.
    digits : significant ones; after : digits behind the point instead, where given.
    emphasis : why it stands out, if it does.
    dimension, unit : as of `Column`, where the numbers of a column are not all alike.
    limit : that the value breaks, in the same unit, where no other column has it.
    """

    value: float
    scale: float = 0.0
    at: float | None = None
    digits: int = 4
    after: int | None = None
    emphasis: Emphasis | None = None
    dimension: Dimension | None = None
    unit: str | None = None
    limit: float | None = None


@dataclass(frozen=True)
class Span:
    """The smallest and largest of some values, in SI units; one number where they are equal."""

    low: float
    high: float
    scale: float = 0.0
    digits: int = 4
    after: int | None = None


@dataclass(frozen=True)
class RelativeChange:
    """By how much a figure has changed, in per cent; nothing where it came from 0."""

    before: float
    after: float
    emphasis: Emphasis | None = None


@dataclass(frozen=True)
class Many:
    """Several values in one cell.  omitted : number of further values, which are not shown."""

    values: tuple[Value, ...]
    omitted: int = 0


Cell = str | Value | Span | RelativeChange | Many | None
"""Words, a number, a range, a change, several numbers, or nothing."""


@dataclass(frozen=True)
class Column:
    """A column of a table.

    label : its heading.
    dimension : of its numbers; they are plain ones where None.
    unit : in which they are shown; the one that suits their sizes where not given.  A unit without
        a dimension, such as ``%``, is that of the numbers as they are.
    at : dimension and unit of where its values hold.
    alike : whether its numbers are of one kind, so that what is rounding beside the largest is 0.
    """

    label: str
    dimension: Dimension | None = None
    unit: str | None = None
    at: tuple[Dimension, str] = ("angle", "deg")
    alike: bool = True


# -- blocks ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Text:
    """Running text.

    emphasis : why it stands out, if it does.
    is_detail : whether it may be left out where there is little room, as the tables have it too.
    """

    kind: ClassVar[str] = "text"
    text: str
    emphasis: Emphasis | None = None
    is_detail: bool = False


@dataclass(frozen=True)
class Facts:
    """Sentences of a kind; `title` stands above them where there is one.

    omitted : how many further ones there are, which are left out.
    is_whole : whether none may be left out, such as of what has to be changed.
    """

    kind: ClassVar[str] = "facts"
    title: str
    items: tuple[str, ...]
    omitted: int = 0
    is_whole: bool = False


@dataclass(frozen=True)
class Table:
    """A table; columns whose cells are words are set to the left, numbers to the right.

    detail : whether it stands in the appendix of a report, however short it is.
    """

    kind: ClassVar[str] = "table"
    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    detail: bool = False

    @classmethod
    def of(cls, title: str, columns: Iterable[Any], rows: Iterable[Iterable[Any]]) -> Table:
        """From columns and rows of cells; words alone head a column of plain numbers or words."""
        heads = (Column(column) if isinstance(column, str) else column for column in columns)
        return cls(title, tuple(heads), tuple(map(tuple, rows)))

    @classmethod
    def of_filled(cls, title: str, columns: Sequence[Any], rows: Sequence[Sequence[Any]]) -> Table:
        """As `of`, without columns in which every cell is None."""
        filled = [k for k in range(len(columns)) if any(row[k] is not None for row in rows)]
        return cls.of(
            title, [columns[k] for k in filled], ([row[k] for k in filled] for row in rows)
        )


@dataclass(frozen=True)
class Notes:
    """What a reader has to know of the result.

    omitted : how many further notes there are, which are left out.
    """

    kind: ClassVar[str] = "notes"
    notes: tuple[Note | str, ...]
    omitted: int = 0


@dataclass(frozen=True)
class PictureBlock:
    """A chart, or a drawing that is made when it is wanted.

    chart : its data.  draw : makes it otherwise, as `figures` renders it.
    """

    kind: ClassVar[str] = "picture"
    name: str
    caption: str
    chart: Chart | None = None
    draw: Callable[[], Any] | None = None


@dataclass(frozen=True)
class SvgPicture:
    """A picture as SVG, as it has been drawn, without its heading.

    caption : what is drawn.  headline : what is seen in it.  instead : for those who cannot see it.
    wide : whether it takes the width of a page, not half of it.
    detail : whether it stands in the appendix of a report.
    rows : a high picture once more, each row of its panels on its own, for pages that have no room
        for all of them.
    narrow : a wide picture once more for a telephone, its panels below each other.
    """

    kind: ClassVar[str] = "drawn"
    name: str
    caption: str
    svg: str
    headline: str = ""
    instead: str = ""
    wide: bool = True
    detail: bool = False
    rows: tuple[str, ...] = ()
    narrow: str = ""


@dataclass(frozen=True)
class FileText:
    """Text as it stands in a file."""

    kind: ClassVar[str] = "listing"
    title: str
    text: str


Block = Text | Facts | Table | Notes | PictureBlock | SvgPicture | FileText


@dataclass(frozen=True)
class ReportSection:
    """A heading and what stands below it; `name` is its anchor.

    headline : what is seen in it, in one line.
    """

    kind: ClassVar[str] = "section"
    name: str
    title: str
    blocks: tuple[Block | ReportSection, ...]
    headline: str = ""


def look_at_next(*commands: str) -> Text:
    """Commands that show more, in a line."""
    return Text(say("Look at next: {commands}.", commands="; ".join(commands)))


# -- before and after ------------------------------------------------------------------------------

SAME, ROUNDING = 1e-6, 1e-9
"""Changes below these are not listed: a share of the figure itself, and, against rounding, of the
largest number of its table column."""


def interleave_changes(before: Iterable[Block], after: Iterable[Block]) -> Iterator[Block]:
    """Blocks of something, in whose tables each row is followed by that of it changed, where that
    differs; rows are those that begin with the same words, of tables of the same title.

    A table that has other columns afterwards, such as those of further orders, follows whole.
    """
    later = {item.title: item for item in after if isinstance(item, Table)}
    for entry in before:
        other = later.get(entry.title) if isinstance(entry, Table) else None
        if not isinstance(entry, Table) or other is None:
            yield entry
        elif [column.label for column in other.columns] == [c.label for c in entry.columns]:
            rows = {_words(row): row for row in other.rows}
            yield replace(entry, rows=tuple(_followed(entry.rows, rows)))
        else:
            yield entry
            yield replace(other, title=say("{what}, after", what=other.title))


def _followed(
    rows: Iterable[tuple[Cell, ...]], later: dict[tuple[str, ...], tuple[Cell, ...]]
) -> Iterator[tuple[Cell, ...]]:
    for row in rows:
        yield row
        words = _words(row)
        changed = later.pop(words, None)
        if words and changed is not None and not all(map(_alike, row, changed)):
            yield _named_after(changed)
    yield from (_named_after(row) for words, row in later.items() if words)


def _words(row: tuple[Cell, ...]) -> tuple[str, ...]:
    """The words that a row begins with."""
    return tuple(takewhile(lambda cell: isinstance(cell, str), row))  # type: ignore[arg-type]


def _named_after(row: tuple[Cell, ...]) -> tuple[Cell, ...]:
    words = _words(row)
    return (say("{what}, after", what=words[0]), *("" for _ in words[1:]), *row[len(words) :])


def _alike(cell: Cell, other: Cell) -> bool:
    """Whether two cells have equal contents, but for rounding."""
    if isinstance(cell, Value) and isinstance(other, Value):
        least = ROUNDING * max(cell.scale, other.scale)
        return isclose(cell.value, other.value, rel_tol=SAME, abs_tol=least)
    return cell == other
