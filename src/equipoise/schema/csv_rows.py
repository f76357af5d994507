"""Rows of CSV files as programs write them: separators, comments and decimal commas.

Everything is told by the file itself: the separator by its header, the decimal sign by its numbers.
What may be read in two ways is refused with both.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar

from equipoise.errors import ModelError, at_place
from equipoise.i18n import Note, all_of
from equipoise.quantities.reading import DECIMAL_COMMA, readings

Row = tuple[int, list[str]]
"""The number of a line, and the cells of its row."""

COMMENTS = ("#", "%", "//")
SEPARATORS = {"\t": Note("tabs"), ";": Note("semicolons"), ",": Note("commas")}
_ASIDE = re.compile(r'\[[^\]]*\]|"[^"]*"')
"""Units and quoted texts of a header, whose signs separate nothing."""
_BEGINS = re.compile(r"[+-]?[.,]?[0-9]")
_NUMBER = re.compile(r"[-+0-9.,eE]+")


def line_of(line: int, column: str = "") -> Note:
    """The place of a line, or of one of its columns."""
    if column:
        return Note("line {line}, column {column}", line=line, column=column)
    return Note("line {line}", line=line)


def wrong(line: int, what: Note, column: str = "") -> ModelError:
    """The error of a line, or of one of its columns."""
    return ModelError(
        "",
        at_place(line_of(line, column), what),
    )


def rows_of(text: str, columns: Mapping[str, str] | None = None) -> Iterator[Row]:
    """Rows that are neither blank nor comments; decimal commas as points where they are certain.

    The first is the header, which may be a comment right above the numbers.

    columns : heads of the columns that are taken, and the heads that they get; all as they are
        where not given.
    """
    rows = _rows(text)
    return rows if columns is None else _taken(rows, columns)


def _taken(rows: Iterator[Row], columns: Mapping[str, str]) -> Iterator[Row]:
    line, header = next(rows)
    places = [header.index(head) for head in columns]
    yield line, [*columns.values()]
    for line, row in rows:
        check_width(line, row, len(header))
        yield line, [row[place] for place in places]


def _rows(text: str) -> Iterator[Row]:
    at, header = _header(text)
    separator = _separator(at + 1, header)
    rows = _separated(text, at, header, separator)
    if "," not in text or (separator == "," and '"' not in text):
        return rows
    listed = list(rows)
    return iter(_with_points(listed) if _has_decimal_commas(listed) else listed)


def _header(text: str) -> tuple[int, str]:
    """Number of the header's line from 0, and its text."""
    comment: tuple[int, str] | None = None
    for number, line in enumerate(io.StringIO(text, newline="")):
        bare = line.strip()
        if bare.startswith(COMMENTS):
            comment = number, bare.lstrip("#%/ ")
        elif bare:
            return comment if comment and _BEGINS.match(bare) else (number, line)
    return 0, ""


def _separator(line: int, header: str) -> str:
    """What stands between the cells of a header."""
    bare = _ASIDE.sub("", header)
    matching_separators = [separator for separator in SEPARATORS if separator in bare]
    if len(matching_separators) > 1:
        both = all_of([SEPARATORS[separator] for separator in matching_separators])
        raise wrong(
            line, Note("the header has {both} between its columns; keep to one of them", both=both)
        )
    return matching_separators[0] if matching_separators else ","


def _separated(text: str, at: int, header: str, separator: str) -> Iterator[Row]:
    def lines() -> Iterator[str]:
        for number, line in enumerate(io.StringIO(text, newline="")):
            bare = line.lstrip()
            yield f"{header}\n" if number == at else "\n" if bare.startswith(COMMENTS) else line

    reader = csv.reader(lines(), strict=True, delimiter=separator)
    try:
        for row in reader:
            cells = [cell.strip() for cell in row]
            if any(cells):
                yield reader.line_num, cells
    except csv.Error as error:
        what = Note(
            "this is no table of values with {separators} between them ({error})",
            separators=SEPARATORS[separator],
            error=str(error),
        )
        raise wrong(reader.line_num, what) from error


def _has_decimal_commas(rows: list[Row]) -> bool:
    """Whether a comma is the decimal sign everywhere, and somewhere can be nothing else."""
    cells = [cell for _, row in rows[1:] for cell in row if _NUMBER.fullmatch(cell)]
    commas = [cell for cell in cells if "," in cell]
    if any("." in cell for cell in cells) or not all(map(DECIMAL_COMMA.fullmatch, commas)):
        return False
    return any(not all(readings(cell)) for cell in commas)


def _with_points(rows: list[Row]) -> list[Row]:
    return [rows[0], *((line, [_pointed(cell) for cell in row]) for line, row in rows[1:])]


def _pointed(cell: str) -> str:
    return cell.replace(",", ".") if "," in cell and DECIMAL_COMMA.fullmatch(cell) else cell


def check_width(line: int, row: list[str], columns: int) -> None:
    """A row has as many values as the header."""
    if len(row) != columns:
        what = Note(
            "got {count} values; the header has {columns} columns",
            count=len(row),
            columns=columns,
        )
        if columns < len(row) <= 2 * columns:
            what = Note("{sentence}; decimal commas need semicolons between values", sentence=what)
        raise wrong(line, what)


_quotes = ContextVar("_quotes", default=True)


@contextmanager
def unquoted() -> Iterator[None]:
    """Inside, errors say nothing of what stands in cells, which may be none of a table."""
    token = _quotes.set(False)
    try:
        yield
    finally:
        _quotes.reset(token)


def shortened(cell: str) -> str:
    """A cell for an error, cut where it is endless."""
    if not _quotes.get():
        return "'...'"
    return repr(cell if len(cell) <= 60 else f"{cell[:57]}...")
