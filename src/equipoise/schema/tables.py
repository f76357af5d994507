"""CSV files with units in the header: tables of loads, laws, soil, a motor and implements.

The format is detected from the file: the separator from its header, the decimal sign from its
numbers.  What may be read in two ways is refused with both.

::

    crank_angle [deg],force_x [N],force_y [N]
    0,0,-12.5
    10,0,-13
"""

from __future__ import annotations

import csv
import io
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from contextvars import ContextVar
from dataclasses import fields
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from equipoise.errors import ModelError, UsageError, at_place
from equipoise.i18n import Note, all_of, any_of
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.parts.loads import OVER, GasTable, IndicatorDiagram, LoadTable
from equipoise.mechanism.parts.support import TIME_IN_PERIOD
from equipoise.quantities import (
    FACTORS,
    HUGE,
    KINDS,
    TINY,
    Dimension,
    format_exact,
    parse,
    plain_unit,
)
from equipoise.quantities.reading import DECIMAL_COMMA, readings, separators_note, usual_unit
from equipoise.schema.files import FileError, printable, read_text
from equipoise.schema.numbers import from_polar

if TYPE_CHECKING:
    from equipoise.signals import Array

NumberedRow = tuple[int, list[str]]
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


def rows_of(text: str, columns: Mapping[str, str] | None = None) -> Iterator[NumberedRow]:
    """Rows that are neither blank nor comments; decimal commas as points where they are certain.

    The first is the header, which may be a comment right above the numbers.

    columns : heads of the columns that are taken, and the heads that they get; all as they are
        where not given.
    """
    rows = _rows(text)
    return rows if columns is None else _taken(rows, columns)


def _taken(rows: Iterator[NumberedRow], columns: Mapping[str, str]) -> Iterator[NumberedRow]:
    line, header = next(rows)
    places = [header.index(head) for head in columns]
    yield line, [*columns.values()]
    for line, row in rows:
        check_width(line, row, len(header))
        yield line, [row[place] for place in places]


def _rows(text: str) -> Iterator[NumberedRow]:
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


def _separated(text: str, at: int, header: str, separator: str) -> Iterator[NumberedRow]:
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


def _has_decimal_commas(rows: list[NumberedRow]) -> bool:
    """Whether a comma is the decimal sign everywhere, and somewhere can be nothing else."""
    cells = [cell for _, row in rows[1:] for cell in row if _NUMBER.fullmatch(cell)]
    commas = [cell for cell in cells if "," in cell]
    if any("." in cell for cell in cells) or not all(map(DECIMAL_COMMA.fullmatch, commas)):
        return False
    return any(not all(readings(cell)) for cell in commas)


def _with_points(rows: list[NumberedRow]) -> list[NumberedRow]:
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


NumbersByName = dict[str, tuple[float, ...]]
ColumnForms = tuple[tuple[str, ...], ...]
"""Columns of each form of a table; the first must rise from row to row."""
Taken = Mapping[str, str] | None

COLUMNS: dict[str, tuple[Dimension, str]] = {
    # name: what it is, unit that a header is shown with
    "crank_angle": ("angle", "deg"),
    "extension_rate": ("speed", "m/s"),
    "force": ("force", "N"),
    "force_x": ("force", "N"),
    "force_y": ("force", "N"),
    "torque": ("torque", "N m"),
    "pressure": ("modulus", "bar"),
    "position": ("length", "mm"),
    "volume": ("volume", "cm^3"),
    "depth": ("length", "mm"),
    "resistance": ("force", "N"),
    "speed": ("angular speed", "rpm"),
    "time": ("time", "s"),
    TIME_IN_PERIOD: ("time", "s"),
    "displacement": ("length", "mm"),
    "angle": ("angle", "deg"),
    "length": ("length", "mm"),
    "frequency": ("frequency", "Hz"),
    "x": ("acceleration", "m/s^2"),
    "y": ("acceleration", "m/s^2"),
    "z": ("acceleration", "m/s^2"),
    "acceleration": ("acceleration", "m/s^2"),
    "duration": ("time", "h"),
    "reactance": ("damping", "N s/m"),
    "magnitude": ("damping", "N s/m"),
    "phase": ("angle", "deg"),
}
TIMES = ("time", TIME_IN_PERIOD)
"""Columns of time: of any record, and of one that is whole periods of a steady vibration."""


def _column(name: str, forms: ColumnForms) -> tuple[Dimension, str]:
    """Dimension of a column, and the unit that it is shown with."""
    first = forms[0][0] if forms else ""
    return CsvTable.like(first).columns.get(name) or COLUMNS[name]


# -- what is wrong ---------------------------------------------------------------------------------


@contextmanager
def in_table(path: str | os.PathLike[str]) -> Iterator[None]:
    """Name a table's file in front of what is wrong with it."""
    place = printable(path) or "''"
    try:
        yield
    except (FileError, UsageError) as error:
        raise ModelError("", at_place(place, error.note)) from error
    except ModelError as error:
        raise ModelError("", Note("{place}, {what}", place=place, what=error.what)) from error


def headers_wanted(forms: ColumnForms, first: str = "") -> Note:
    """Say which headers would be right; `first` begins each."""
    return one_header_of(headers_of(forms, first))


def one_header_of(headers: Sequence[str]) -> Note:
    """Say which headers would be right."""
    return Note("the header is {headers}", headers=any_of(headers))


def headers_of(forms: ColumnForms, first: str = "") -> list[str]:
    """Headers that would be right; `first` begins each."""

    whole = [form for form in forms if not any(set(form) < set(other) for other in forms)]
    columns = ([f"{name} [{_column(name, forms)[1]}]" for name in form] for form in whole)
    return [first + ",".join(form) for form in columns]


# -- reading ---------------------------------------------------------------------------------------


def columns_of(text: str, forms: ColumnForms, taken: Taken = None) -> NumbersByName:
    """Columns of a table by name, in SI units and radians; `taken` as of `rows_of`."""
    rows = rows_of(text, taken)
    number, header = next(rows, (1, []))
    names, unit_of = header_of(number, header, forms)
    columns: list[list[float]] = [[] for _ in names]
    lines = []
    for number, row in rows:
        check_width(number, row, len(names))
        for name, unit, cell, column in zip(names, unit_of, row, columns, strict=True):
            column.append(value_of(number, name, unit, cell, forms))
        lines.append(number)
    if not lines:
        raise wrong(number, Note("there are no rows below the header; give at least one"))
    by_name = dict(zip(names, map(tuple, columns), strict=True))
    first = forms[0][0]
    rising = by_name[first] if CsvTable.like(first).rises else ()
    for line, before, after in zip(lines[1:], rising, rising[1:], strict=False):
        if after <= before:
            plural = {"angle": "angles", "frequency": "frequencies"}
            what = plural.get(COLUMNS[first][0], f"{first}s")
            raise wrong(line, Note("the {what} must rise from row to row", what=what), first)
    return by_name


def arrays_of(text: str, forms: ColumnForms, taken: Taken = None) -> dict[str, Array]:
    """Columns of a table as arrays (N,), for files of a million rows: cell by cell only to locate
    an error.
    """
    import numpy as np

    arrays = _whole(rows_of(text, taken), forms)
    if arrays is None:
        columns = columns_of(text, forms, taken)
        arrays = {name: np.array(column) for name, column in columns.items()}
    return arrays


def _whole(lines: Iterator[NumberedRow], forms: ColumnForms) -> dict[str, Array] | None:
    """All columns together; None where a row or cell is not what it should be."""
    import numpy as np

    names, unit_of = header_of(*next(lines, (1, [])), forms)
    cells = [row for _, row in lines]
    if not cells or any(len(row) != len(names) for row in cells):
        return None
    # Python reads such numbers, but they are none here
    if any("_" in cell or not cell.isascii() for row in cells for cell in row):
        return None
    try:
        values = np.array([[float(cell) for cell in row] for row in cells])
    except ValueError:
        return None
    values *= [float(FACTORS[plain_unit(unit)]) for unit in unit_of]
    sizes = np.abs(values)
    if not np.all((sizes <= HUGE) & ((sizes >= TINY) | (sizes == 0))):
        return None
    by_name = dict(zip(names, values.T.copy(), strict=True))
    first = forms[0][0]
    return (
        by_name if not CsvTable.like(first).rises or np.all(np.diff(by_name[first]) > 0) else None
    )


def header_of(
    line: int, cells: list[str], forms: ColumnForms, right: Note | None = None
) -> tuple[list[str], list[str]]:
    """Names and units of the columns; a wrong one is refused with its line.

    right : says which headers would be right, where more than those of the forms stands in them.
    """
    right = right or headers_wanted(forms)
    names: list[str] = []
    unit_of: list[str] = []
    for cell in cells:
        match = re.fullmatch(r"(\w+)\s*\[([^\]]*)\]", cell)
        name = match[1] if match else cell
        if name in TIMES and forms in (LoadTable.forms, GasTable.forms):
            raise wrong(
                line, Note("got the column {name}; {of_time}", name=name, of_time=OF_TIME), name
            )
        if name in OVER and forms == GasTable.forms:
            what = Note("got the column {name}; a diagram over it is the key {key}", name=name,
                        key="indicator")  # fmt: skip
            raise wrong(line, what, name)
        if not any(name in form for form in forms):
            raise wrong(
                line, Note("got the column {given}; {right}", given=shortened(cell), right=right)
            )
        if match is None:
            unit = _column(name, forms)[1]
            raise wrong(
                line, Note("the unit is missing; {name} [{unit}]", name=name, unit=unit), name
            )
        if name in names:
            raise wrong(line, Note("given twice; {right}", right=right), name)
        unit = usual_unit(match[2], _column(name, forms)[0])
        value_of(line, name, unit, "0", forms)  # a wrong unit is the header's fault
        names.append(name)
        unit_of.append(unit)
    if not any(sorted(names) == sorted(form) for form in forms):
        raise wrong(
            line,
            Note("got {names}; {right}", names=", ".join(names) or Note("no column"), right=right),
        )
    return names, unit_of


def value_of(line: int, name: str, unit: str, cell: str, forms: ColumnForms = ()) -> float:
    """A cell in SI units."""
    try:
        return parse(f"{cell} {unit}", _column(name, forms)[0])
    except UsageError as error:
        if _is_number(cell):
            raise wrong(line, error.note, name) from error
        right = separators_note(cell) or Note("give a finite number with a decimal point")
        what = Note("got {given}; {right}", given=shortened(cell), right=right)
        raise wrong(line, what, name) from error


def _is_number(cell: str) -> bool:
    try:
        return isfinite(float(cell)) and cell.isascii() and "_" not in cell
    except ValueError:
        return False


# -- tables beside a model -------------------------------------------------------------------------

TABLES = CsvTable.kinds
"""The class of each sort of table."""
OF_TIME = Note(
    "a load goes with the crank, at whatever speed that turns; give crank_angle [deg] instead, "
    "of which 100 rpm make 600 in a second"
)
HANDY = {"crank_angle": "deg", "angle": "deg", "length": "mm", "speed": "rpm", "x": "mm", "y": "mm"}
"""Units of columns that are written in them where they are exact, else in SI units."""


def read_beside(sort: str, file: str, folder: Path) -> CsvTable:
    """Read a table of a sort such as ``load``.

    file : its name, relative to `folder`, which is that of the model file.  Of a file elsewhere,
        which a stranger's model may have named, no error quotes anything.

    Raises
    ------
    ModelError
        Names the table's file, line and column; `where` is empty.
    """
    beyond = Path(file).is_absolute() or ".." in Path(file).parts
    with in_table(file), unquoted() if beyond else nullcontext():
        return parse_table(sort, read_text(folder / file, within=folder), file)


def parse_table(sort: str, text: str, file: str = "") -> CsvTable:
    """Read the text of a table; errors begin with the number of the line."""
    columns = columns_of(text, TABLES[sort].forms)
    if sort == "load":
        angles = columns.pop("crank_angle")
        if "torque" in columns:
            return LoadTable(angles, (columns["torque"],), file)
        none = (0.0,) * len(angles)  # of a component that is left out
        parts = tuple(columns.get(name, none) for name in ("force_x", "force_y"))
        return LoadTable(angles, parts, file)
    if sort == "indicator":
        over: Literal["volume", "position"] = "volume" if "volume" in columns else "position"
        return IndicatorDiagram(columns[over], columns["pressure"], over, file)
    if "magnitude" in columns:
        pairs = zip(columns["magnitude"], columns["phase"], strict=True)
        resistance, reactance = zip(*(from_polar(*pair) for pair in pairs), strict=True)
        from equipoise.handheld.model import Impedance

        return Impedance(columns["frequency"], resistance, reactance, file)
    csv_table: CsvTable = TABLES[sort](*(columns[name] for name in TABLES[sort].forms[0]), file)
    return csv_table


def format_table(table: CsvTable) -> str:
    """Write a table as CSV such that reading it gives exactly the same numbers."""
    if isinstance(table, LoadTable):
        form: tuple[str, ...] = LoadTable.forms[0 if len(table.values) == 2 else 1]
        return _text(form, [table.crank_angle, *table.values])
    if isinstance(table, IndicatorDiagram):
        return _text((table.over, "pressure"), [table.places, table.pressure])
    form = table.forms[0]
    columns = [getattr(table, item.name) for item in fields(table)]
    return _text(form, columns[: len(form)])


def _text(form: tuple[str, ...], columns: Sequence[Sequence[float]]) -> str:
    """The text of a CSV file; numbers with all their digits."""
    header, cells = [], []
    for name, values in zip(form, columns, strict=True):
        dimension = _column(name, (form,))[0]
        unit = HANDY.get(name, "")
        texts = [format_exact(value, dimension).split(" ", 1) for value in values if unit]
        if not unit or any(given != unit for _, given in texts):
            unit, texts = KINDS[dimension].si, [[repr(float(value))] for value in values]
        header.append(f"{name} [{unit}]")
        cells.append([text[0] for text in texts])
    return "\n".join(",".join(row) for row in (header, *zip(*cells, strict=True))) + "\n"
