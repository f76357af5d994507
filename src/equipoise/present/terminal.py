"""Blocks on a terminal: words and tables in lines of its width, and colours.

Signs of East Asian scripts take two places.  What stands out does so by colour, or else by a word.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TextIO, get_args
from unicodedata import combining, east_asian_width

from equipoise.dataclass import dataclass
from equipoise.i18n import localized, say, to_say
from equipoise.present.cells import CellText, Grid, Head, bound, grid, with_omitted
from equipoise.results.blocks import (
    Block,
    Emphasis,
    Facts,
    FileText,
    Notes,
    PictureBlock,
    ReportSection,
    Table,
)
from equipoise.results.blocks import Text as Running

GAP, HEAD, DEEPER = 2, 14, 2
"""Places between columns, of a line of a heading with short words, and by which further lines of a
cell stand to the right."""
WORDS: dict[Emphasis, str] = {"broken": to_say("over the limit"), "worse": to_say("worse")}
"""Emphasis -> the word that replaces its colour on a terminal without colours."""
CODES = {"title": "1", "section": "1;4", "head": "2", "broken": "1;31", "worse": "1;31"}
"""Part of the output -> parameters of its ANSI escape sequence."""


@dataclass(frozen=True)
class Looks:
    """How parts look.  coloured : whether by colour."""

    coloured: bool

    def paint(self, text: str, part: str | None) -> str:
        """A text as a part of `CODES`."""
        return f"\x1b[{CODES[part]}m{text}\x1b[0m" if self.coloured and part and text else text

    def word(self, emphasis: Emphasis | None, limit: str = "") -> str:
        """Word that follows an emphasized cell; `limit` is the broken limit, empty if not shown."""
        if emphasis is None or (self.coloured and not limit):
            return ""
        if limit:
            return f", {say('over the limit of {limit}', limit=limit)}"
        return f"{',' * (emphasis == 'broken')} {say(WORDS[emphasis])}"


# -- lines -----------------------------------------------------------------------------------------

_OPEN, _SHUT = (
    "（「『【〔〈《",
    "、。，．・：；？！％）」』】〕〉》ー々ぁぃぅぇぉっゃゅょァィゥェォッャュョ",
)
_WIDE = "\u3041-\u30ff\u3400-\u9fff\uf900-\ufaff"
_PIECE = re.compile(rf" *[{_OPEN}]*(?:[{_WIDE}]|[^ {_OPEN}{_SHUT}{_WIDE}]+)?[{_SHUT}]*")
_INNER = re.compile(r".+?(?:(?<=[^\W\d]{2})[./-](?=\w)|$)")


_PLAIN = str.maketrans(
    {"²": "^2", "³": "^3", "°": " deg", "→": "->", "…": "...", "µ": "u", "λ": "lambda"}
    | {"±": "+-", "−": "-", "–": "-"}
)


def plain(text: str) -> str:
    """A text in signs that any terminal has."""
    return text.translate(_PLAIN)


def size(text: str) -> int:
    """Places that a text takes in a line."""
    return len(text) if text.isascii() else sum(map(_places, text))


def _places(sign: str) -> int:
    return 0 if combining(sign) else 2 if east_asian_width(sign) in "WF" else 1


def _pieces(text: str, inner: bool = False) -> Iterator[str]:
    """What no line breaks: words, numbers with their units, Japanese signs, and with `inner` the
    parts of dotted names.
    """
    for piece in filter(None, _PIECE.findall(bound(text))):
        whole = piece.replace("\N{NO-BREAK SPACE}", " ")
        yield from _INNER.findall(whole) if inner else [whole]


def _longest(texts: Iterable[str], inner: bool = False) -> int:
    """Places of the longest piece."""
    pieces = (piece.strip() for text in texts for piece in _pieces(text, inner))
    return max(map(size, pieces), default=0)


def wrapped(text: str, width: int, indent: int = 0, inner: bool = False) -> list[str]:
    """Lines of a text that are no longer than a width, further ones less an indent; only longer
    words are.  inner : whether names with dots are broken too.
    """
    lines, room = [""], width
    for piece in _pieces(text, inner):
        if lines[-1] and size(lines[-1]) + size(piece) > room:
            lines.append(piece.lstrip(" "))
            room = width - indent
        else:
            lines[-1] += piece
    return lines


# -- columns ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Column:
    """A column as texts in plain signs.

    cells : those of numbers are of one size.  tails : what is said behind them.
    roles : of the cells, as in `CODES`.  words : whether they may be wrapped.
    room : places in a line of the terminal.
    """

    label: str
    unit: str
    cells: tuple[str, ...]
    tails: tuple[str, ...]
    roles: tuple[str | None, ...]
    words: bool
    room: int

    @cached_property
    def longest(self) -> int:
        """Places of the longest piece of a cell."""
        return _longest(self.cells) if self.words else max(map(size, self.cells), default=0)

    @cached_property
    def natural(self) -> int:
        """Places that it takes where there is room."""
        heads = [self.label] if self.words else wrapped(self.label, HEAD, inner=True)
        return max(map(size, (*self.cells, *heads, self.unit)))

    @cached_property
    def close(self) -> int:
        """Places that it takes with one more line of heading; of words, where there is room."""
        lines = len(wrapped(self.label, HEAD, inner=True)) + 1
        widths = range(self.least, self.natural)
        enough = (width for width in widths if len(wrapped(self.label, width, 0, True)) <= lines)
        return self.natural if self.words else next(enough, self.natural)

    @cached_property
    def least(self) -> int:
        """Places below which it does not come."""
        head = max(_longest([self.label], inner=True), size(self.unit))
        if not self.words:
            return max(head, self.longest)
        return max(head, min(self.longest, self.room // 2), min(self.natural, self.room // 5))

    @cached_property
    def tail(self) -> int:
        return max(map(size, self.tails), default=0)

    def lines(self, row: int | None, width: int, looks: Looks) -> list[str]:
        """Lines of a cell, or of the heading where there is no row; all take the same places."""
        if row is None:
            lines = [*wrapped(self.label, width, inner=True), self.unit]
            return [self._set(line, width, "head", "", looks) for line in lines if line]
        lines, role, tail = [self.cells[row]], self.roles[row], self.tails[row]
        if self.words:
            first, *further = wrapped(self.cells[row], width, DEEPER, inner=self.longest > width)
            lines = [first, *(f"{'':{DEEPER}}{line}" for line in further)]
        return [self._set(line, width, role, tail, looks) for line in lines]

    def _set(self, text: str, width: int, role: str | None, tail: str, looks: Looks) -> str:
        """A line at its side of the column."""
        painted, blank = looks.paint(text, role), " " * (width - size(text))
        end = tail + " " * (self.tail - size(tail))
        return f"{painted}{blank}{end}" if self.words else f"{blank}{painted}{end}"


def _columns(grid: Grid, room: int, looks: Looks) -> Iterator[_Column]:
    for place, head in enumerate(grid.heads):
        cells, words = [row[place] for row in grid.rows], grid.is_words(place)
        tails = [looks.word(cell.emphasis, cell.limit) for cell in cells]
        texts = [*_aligned(cells)]
        if words:
            texts = [f"{plain(cell.text)}{tail}" for cell, tail in zip(cells, tails, strict=True)]
            tails = [""] * len(cells)
        roles = tuple(cell.emphasis for cell in cells)
        label, unit = plain(head.label), plain(_units(head))
        yield _Column(label, unit, tuple(texts), tuple(tails), roles, words, room)


def _units(head: Head) -> str:
    return f"{head.unit} at {head.at}".strip() if head.at else head.unit


def _aligned(cells: Sequence[CellText]) -> Iterator[str]:
    """Numbers and where they hold, both set to the right."""
    values, places = [plain(cell.text) for cell in cells], [plain(cell.at) for cell in cells]
    wide, far = max(map(size, values), default=0), max(map(size, places), default=0)
    for value, place in zip(values, places, strict=True):
        at = f"{' at ' if place else '    '}{' ' * (far - size(place))}{place}" if far else ""
        yield f"{' ' * (wide - size(value))}{value}{at}"


# -- tables ----------------------------------------------------------------------------------------


def table_lines(grid: Grid, room: int, looks: Looks) -> list[list[str]]:
    """Lines of a table, in as few parts as the places of a line ask for; one that is longer than
    high is rather turned.
    """
    parts = _laid_out(grid, room, looks)
    if len(parts) > 1 and len(grid.rows) < len(grid.heads):
        turned = _laid_out(_turned(grid), room, looks)
        return turned if len(turned) == 1 else parts
    return parts


def _turned(grid: Grid) -> Grid:
    """A table whose rows are columns."""
    first, comma = grid.leading, say(", ")
    names = (comma.join(cell.text for cell in row[:first] if cell.text) for row in grid.rows)
    labels = [comma.join(filter(None, (head.label, _units(head)))) for head in grid.heads]
    rows = tuple(
        (CellText(label), *(row[place] for row in grid.rows))
        for place, label in enumerate(labels)
        if place >= first
    )
    corner = comma.join(filter(None, labels[:first]))
    return Grid(grid.title, (Head(corner), *map(Head, names)), rows)


def _laid_out(grid: Grid, room: int, looks: Looks) -> list[list[str]]:
    """Lines of each part of a table that is too wide; each part repeats the leading columns."""
    columns = [*_columns(grid, room, looks)]
    parts = _parts(columns, grid.leading, room)
    return [[*_lines(part, len(grid.rows), looks)] for part in parts]


def _parts(columns: Sequence[_Column], first: int, room: int) -> list[list[_Column]]:
    """As few parts as there can be, of about the same width."""

    def filled(limit: int) -> list[list[_Column]]:
        parts: list[list[_Column]] = [[]]
        for column in columns[first:]:
            if parts[-1] and _places_of([*columns[:first], *parts[-1], column]) > limit:
                parts.append([])
            parts[-1].append(column)
        return [[*columns[:first], *part] for part in parts]

    fewest = len(filled(room))
    return next(parts for parts in map(filled, range(room + 1)) if len(parts) == fewest)


def _places_of(part: Sequence[_Column]) -> int:
    """Places below which a part does not come."""
    return sum(column.least + column.tail + GAP for column in part) - GAP


def _widths(part: Sequence[_Column]) -> list[int]:
    """Places of columns: headings are squeezed a little, then words, then headings."""
    widths = [column.natural for column in part]
    over = sum(widths) + sum(column.tail + GAP for column in part) - GAP - part[0].room
    floors = (
        [column.close for column in part],
        [column.least if column.words else column.close for column in part],
        [column.least for column in part],
    )
    for floor in floors:
        while over > 0 and (loose := [k for k, least in enumerate(floor) if widths[k] > least]):
            widths[max(loose, key=widths.__getitem__)] -= 1
            over -= 1
    return widths


def _lines(part: Sequence[_Column], rows: int, looks: Looks) -> Iterator[str]:
    """Lines of a part; headings end, and cells begin, side by side."""
    widths = _widths(part)
    for row in (None, *range(rows)):
        cells = [item.lines(row, width, looks) for item, width in zip(part, widths, strict=True)]
        tall = max(map(len, cells))
        for column, lines, width in zip(part, cells, widths, strict=True):
            empty = [" " * (width + column.tail)] * (tall - len(lines))
            lines[:] = empty + lines if row is None else lines + empty
        for line in zip(*cells, strict=True):
            yield (" " * GAP).join(line).rstrip()


LEAST, PROSE = 40, 100
"""Signs in a line below which nothing is laid out; most in a line of running text."""
SIGN = "! "
"""Before running text that stands out where there is no colour."""


def print_blocks(
    title: str | None,
    blocks: Iterable[Block | ReportSection],
    width: int | None = None,
    most: int | None = None,
) -> None:
    """Print a title and what stands below it; all of it, or nothing where a block has an error.

    Arguments as of `block_text`.
    """
    text = block_text(title, blocks, width, most)
    if sys.stdout is not None:  # where the shell has closed it
        sys.stdout.write(text)


def block_text(
    title: str | None,
    blocks: Iterable[Block | ReportSection],
    width: int | None = None,
    most: int | None = None,
) -> str:
    """What a terminal shows of a title and what stands below it, in colours where it has them.

    title : none if empty; None where it goes on below something else.
    width : signs in a line; those of the terminal if None.
    most : lines for which lists lose their last items, the last lists first; any if None.
    """
    columns = shutil.get_terminal_size().columns if width is None else width

    def printed(printed_blocks: Iterable[Block | ReportSection]) -> list[str]:
        printer = _Printer(max(columns, LEAST), Looks(coloured(sys.stdout)), begun=title is None)
        if title:
            printer.words(title, "title")
        printer.blocks(printed_blocks)
        return printer.lines

    printed_blocks = [*blocks] if most is not None else blocks
    lines = printed(printed_blocks)
    while most is not None and len(lines) > most and (shorter := _shortened([*printed_blocks])):
        printed_blocks = shorter
        lines = printed(printed_blocks)
    return "".join(f"{line}\n" for line in lines)


def _shortened(blocks: list[Block | ReportSection]) -> list[Block | ReportSection]:
    """Blocks without the last item of the last list that has several, then without notes, then
    without the last sentence of detail, then without a whole list; empty where nothing is left to
    leave out.
    """
    for least in (1, 0):
        for k in reversed(range(len(blocks))):
            block = blocks[k]
            rest: Block
            if isinstance(block, Facts) and len(block.items) > 1 and not block.is_whole:
                rest = replace(block, items=block.items[:-1], omitted=block.omitted + 1)
            elif isinstance(block, Notes) and len(block.notes) > least:
                rest = replace(block, notes=block.notes[:-1], omitted=block.omitted + 1)
            else:
                continue
            return [*blocks[:k], rest, *blocks[k + 1 :]]
    details = [
        k for k, block in enumerate(blocks) if isinstance(block, Running) and block.is_detail
    ]
    if details:
        return [*blocks[: details[-1]], *blocks[details[-1] + 1 :]]
    kinds = (block for block in enumerate(blocks) if isinstance(block[1], Notes | Facts))
    lists = [k for k, item in kinds if not getattr(item, "is_whole", False)]
    return [*blocks[: lists[-1]], *blocks[lists[-1] + 1 :]] if lists else []


def coloured(stream: TextIO | None) -> bool:
    """Whether a stream shows colours, by what users may set (no-color.org, force-color.org)."""
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR"):
        return True
    known = os.name != "nt" or "WT_SESSION" in os.environ  # what else Windows has, prints codes
    if stream is None or not stream.isatty():
        return False
    return known and os.environ.get("TERM") not in ("dumb", "unknown")


class _Printer:
    """Lines of blocks, one below the other.  begun : whether something stands above them."""

    def __init__(self, width: int, looks: Looks, begun: bool) -> None:
        self.width, self.looks, self.begun = width, looks, begun
        self.lines: list[str] = []
        self.apart = False  # whether running text begins after a space, as after a table

    def blocks(self, blocks: Iterable[Block | ReportSection]) -> None:
        for block in blocks:
            if self.apart and isinstance(block, Running):
                self.space()
            self.apart = isinstance(block, Table | Facts)
            if isinstance(block, ReportSection):
                self.space()
                self.words(block.title, "section")
                self.blocks(block.blocks)
            elif isinstance(block, Table):
                self.table(block)
            else:
                self.other(block)

    def other(self, block: Block) -> None:
        """What is not a table."""
        if isinstance(block, Running):
            self.words(block.text, block.emphasis)
        elif isinstance(block, Facts):
            if block.title:
                self.space()
                self.words(with_omitted(block.title, block.omitted), "title")
            for item in block.items:
                self.words(f"  {item}")
        elif isinstance(block, Notes):
            self.space()
            for place, note in enumerate(block.notes, 1):
                omitted = block.omitted if place == len(block.notes) else 0
                self.words(with_omitted(f"note: {localized(note)}", omitted))
            if not block.notes and block.omitted:
                self.words(say("notes left out here: {count}", count=block.omitted))
        elif isinstance(block, FileText):
            self.space()
            if block.title:
                self.words(block.title, "title")
            self.lines += map(plain, block.text.splitlines())
        else:
            assert isinstance(block, PictureBlock)  # a terminal draws none

    def space(self) -> None:
        """An empty line, but not at the very beginning."""
        if self.begun:
            self.lines.append("")
        self.begun = True

    def words(self, text: str, role: str | None = None) -> None:
        """Running text; further lines of what stands apart do so a little more."""
        self.begun = True
        text = plain(text)
        start = " " * (len(text) - len(text.lstrip(" ")))
        sign = SIGN if role in get_args(Emphasis) and not self.looks.coloured else ""
        further = start + " " * len(SIGN) if start or sign else ""
        room = min(self.width, PROSE) - len(start)
        lines = wrapped(sign + text.strip(), room, len(further) - len(start))
        for place, line in enumerate(lines):
            self.lines.append((further if place else start) + self.looks.paint(line, role))

    def table(self, block: Table) -> None:
        """A table, in as many parts as the width asks for."""
        for place, lines in enumerate(table_lines(grid(block), self.width, self.looks)):
            title = block.title if not place else say("{title} (continued)", title=block.title)
            self.space()
            if title:
                self.words(title, "title")
                self.space()
            self.lines += lines
