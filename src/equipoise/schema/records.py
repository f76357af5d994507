"""Recordings in CSV files with units in the header: free decays, accelerations, a day's tasks.

::

    time [s],displacement [mm]
    0,41.2
    0.002,41.1
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from itertools import islice
from typing import Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError, unknown
from equipoise.exposure.daily import Task
from equipoise.exposure.spectra import UNEVEN_STEPS, uneven
from equipoise.exposure.weighting import AXES
from equipoise.i18n import Note
from equipoise.measured.record import Record
from equipoise.mechanism.parts.support import TIME_IN_PERIOD
from equipoise.schema.files import read_text
from equipoise.schema.tables import (
    TIMES,
    ColumnForms,
    Taken,
    arrays_of,
    check_width,
    header_of,
    headers_of,
    headers_wanted,
    in_table,
    one_header_of,
    rows_of,
    shortened,
    value_of,
    wrong,
)
from equipoise.signals import Array

LARGEST, LARGEST_SIGNAL = 100_000_000, 300_000_000
"""Bytes of a decay, and of accelerations: some millions of rows."""
_RECORD: ColumnForms = (("time", "displacement"), ("time", "angle"))
ACCELERATION = "m/s^2"
_GAUGE = re.compile(rf"gauges\.(?P<name>.+)\.acceleration \[{re.escape(ACCELERATION)}\]")
"""The column of a gauge's acceleration in a response over time."""
SWEPT = Note(
    "there are gauges, but none with accelerations over time, which "
    "`equipoise respond FILE --csv` writes at one speed"
)
_TASKS: ColumnForms = (("acceleration", "duration"),)
_SIGNAL: ColumnForms = (("time", *AXES),)
_SPECTRUM: ColumnForms = (("frequency", *AXES),)


def read_record(path: str | os.PathLike[str]) -> Record:
    """Read a recorded decay from a CSV file.

    Raises
    ------
    ModelError
        One sentence: file, line and column, what was given and what would be right.
    """
    with in_table(path):
        return parse_record(read_text(path, LARGEST))


def parse_record(text: str) -> Record:
    """Read the text of a recorded decay; errors begin with the number of the line."""
    columns = arrays_of(text, _RECORD)
    time = columns.pop("time")
    ((name, displacement),) = columns.items()
    return Record(time, displacement, "angle" if name == "angle" else "length")


@dataclass(frozen=True, eq=False)
class Accelerations:
    """Accelerations as a file has them.

    kind : what they stand against.
    at : (N,), time in s, or frequency in Hz.
    axes : names of the axes.
    values : (axes, N), m/s2; of a spectrum, RMS.
    periodic : whether the file says that it is whole periods of a steady vibration.
    """

    kind: Literal["time", "frequency"]
    at: Array
    axes: tuple[str, ...]
    values: Array
    periodic: bool = False


def read_accelerations(
    path: str | os.PathLike[str], gauges: Sequence[str] = ()
) -> Accelerations | tuple[Task, ...]:
    """Read a signal, a spectrum or the tasks of a day from a CSV file; errors as `read_record`.

    gauges : of a response as `respond` writes it, up to three gauges of one place, whose
        accelerations are the axes x, y and z; all of the file where none is given.
    """
    with in_table(path):
        return parse_accelerations(read_text(path, LARGEST_SIGNAL), gauges)


def parse_accelerations(text: str, gauges: Sequence[str] = ()) -> Accelerations | tuple[Task, ...]:
    """Read the text of a file of accelerations; errors begin with the number of the line.

    gauges : as of `read_accelerations`.
    """
    number, header = next(rows_of(text), (1, []))
    if gauges or any(map(_GAUGE.fullmatch, header)):
        return _of_gauges(text, number, header, gauges)
    if any(cell.startswith("gauges.") for cell in header):
        raise wrong(number, SWEPT)
    names = [cell.split("[")[0].strip() for cell in header]
    if set(TIMES) & set(names):
        return _signal(text, names)
    if "frequency" in names:
        return _spectrum(text, names)
    if {"task", "acceleration", "duration"} & set(names):
        return _tasks(text)
    given = Note("the column {name}", name=shortened(header[0])) if header else Note("no column")
    right = one_header_of([*headers_of((*_SIGNAL, *_SPECTRUM)), *headers_of(_TASKS, "task,")])
    raise wrong(number, Note("got {given}; {right}", given=given, right=right))


def _of_gauges(text: str, line: int, header: list[str], gauges: Sequence[str]) -> Accelerations:
    """Accelerations of gauges in what `respond` writes, as those of axes."""
    known = {match["name"]: cell for cell in header if (match := _GAUGE.fullmatch(cell))}
    for name in gauges:
        if name not in known:
            raise wrong(line, unknown(name, known, "gauge"))
    chosen = [*dict.fromkeys(gauges or known)]
    if len(chosen) > (len(AXES) if gauges else 1):
        names = ", ".join(map(repr, known))
        raise wrong(
            line,
            Note(
                "there are the gauges {names}; name that of the hand, or up to three of "
                "one place, along x, y and z (gauge)",
                names=names,
            ),
        )
    times = [cell for cell in header if cell.split("[")[0].strip() in TIMES]
    if not times:
        raise wrong(line, Note("a column such as time [s] is missing"))
    heads = {
        known[name]: f"{axis} [{ACCELERATION}]" for name, axis in zip(chosen, AXES, strict=False)
    }
    columns = [times[0].split("[")[0].strip(), *AXES[: len(chosen)]]
    return _signal(text, columns, {times[0]: times[0], **heads})


def _signal(text: str, names: list[str], taken: Taken = None) -> Accelerations:
    first = TIME_IN_PERIOD if TIME_IN_PERIOD in names else "time"
    axes, columns = _axes(text, first, names, taken)
    time = columns[first]
    worst = uneven(time) if len(time) > 1 else None
    if worst is not None:
        raise wrong(
            _line(text, worst),
            Note("{time:.6g} s {uneven_steps}", time=time[worst], uneven_steps=UNEVEN_STEPS),
            first,
        )
    values = np.array([columns[axis] for axis in axes])
    return Accelerations("time", time, axes, values, first == TIME_IN_PERIOD)


def _spectrum(text: str, names: list[str]) -> Accelerations:
    axes, columns = _axes(text, "frequency", names)
    for name, column in columns.items():
        if np.any(column < 0):
            first = int(np.argmax(column < 0))
            what = Note(
                "got {column:g}; give RMS values and frequencies of 0 or more", column=column[first]
            )
            raise wrong(_line(text, first), what, name)
    values = np.array([columns[axis] for axis in axes])
    return Accelerations("frequency", columns["frequency"], axes, values)


def _axes(
    text: str, first: str, names: list[str], taken: Taken = None
) -> tuple[tuple[str, ...], dict[str, Array]]:
    """Axes that a file has, and its columns; the error of a file without axes names all three."""
    axes = tuple(axis for axis in AXES if axis in names) or AXES
    return axes, arrays_of(text, ((first, *axes),), taken)


def _line(text: str, row: int) -> int:
    """Line of a row below the header."""
    number, _ = next(islice(rows_of(text), row + 1, None))
    return number


def _tasks(text: str) -> tuple[Task, ...]:
    """Tasks of a day; the names of tasks are a column of text."""
    rows = rows_of(text)
    line, header = next(rows)
    names, unit_of = _tasks_header(line, header)
    at = header.index("task")
    tasks: list[Task] = []
    for number, row in rows:
        check_width(number, row, len(header))
        name = row.pop(at) or f"task {len(tasks) + 1}"
        cells = zip(names, unit_of, row, strict=True)
        values = {key: value_of(number, key, unit, cell) for key, unit, cell in cells}
        try:
            tasks.append(Task(name, **values))
        except UsageError as error:
            raise ModelError(
                "", Note("line {line}, column {sentence}", line=number, sentence=error.note)
            ) from error
    if not tasks:
        raise wrong(line, Note("there are no rows below the header; give at least one"))
    return tuple(tasks)


def _tasks_header(line: int, header: list[str]) -> tuple[list[str], list[str]]:
    """Names and units of the columns that are no text."""
    right = headers_wanted(_TASKS, "task,")
    if header.count("task") != 1:
        raise wrong(
            line, Note("got {count} columns task; {right}", count=header.count("task"), right=right)
        )
    return header_of(line, [cell for cell in header if cell != "task"], _TASKS, right)
