"""Recorded decays: CSV files of time and displacement, or angle, with units in the header.

::

    time [s],displacement [mm]
    0,41.2
    0.002,41.1
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from itertools import islice
from typing import Any, Literal

import numpy as np

from equipoise.errors import ModelError, UsageError
from equipoise.exposure.daily import Task
from equipoise.exposure.spectra import UNEVEN_STEPS, uneven
from equipoise.exposure.weighting import AXES
from equipoise.measured.record import Record
from equipoise.schema import csv_columns
from equipoise.schema.csv_columns import Forms, arrays_of
from equipoise.schema.files import FileError, printable, read_text

LARGEST = 100_000_000
"""Bytes: some millions of rows."""
_RECORD: Forms = (("time", "displacement"), ("time", "angle"))


def read_record(path: str | os.PathLike[str]) -> Record:
    """Read a recorded decay from a CSV file.

    Raises
    ------
    ModelError
        One sentence: file, line and column, what was given and what would be right.
    """
    shown = printable(path) or "''"
    try:
        return parse_record(read_text(path, LARGEST))
    except FileError as problem:
        raise ModelError("", f"{shown}: {problem}") from problem
    except UsageError as error:
        raise ModelError("", f"{shown}: {error}") from error
    except ModelError as error:
        raise ModelError("", f"{shown}, {error.what}") from error


def parse_record(text: str) -> Record:
    """Read the text of a recorded decay; errors begin with the number of the line."""
    columns = arrays_of(text, _RECORD)
    time = columns.pop("time")
    ((name, displacement),) = columns.items()
    return Record(time, displacement, "angle" if name == "angle" else "length")


Array = np.ndarray[Any, Any]

LARGEST_SIGNAL = 300_000_000
"""Bytes: some millions of rows of three axes."""
_TASKS: csv_columns.Forms = (("acceleration", "duration"),)
_SIGNAL: csv_columns.Forms = (("time", *AXES),)
_SPECTRUM: csv_columns.Forms = (("frequency", *AXES),)


@dataclass(frozen=True, eq=False)
class Accelerations:
    """Accelerations as a file has them.

    kind : what they stand against.
    at : (N,), time in s, or frequency in Hz.
    axes : names of the axes.
    values : (axes, N), m/s2; of a spectrum, RMS.
    """

    kind: Literal["time", "frequency"]
    at: Array
    axes: tuple[str, ...]
    values: Array


def read_accelerations(path: str | os.PathLike[str]) -> Accelerations | tuple[Task, ...]:
    """Read a signal, a spectrum or the tasks of a day from a CSV file.

    Raises
    ------
    ModelError
        One sentence: file, line and column, what was given and what would be right.
    """
    shown = printable(path) or "''"
    try:
        return parse_accelerations(read_text(path, LARGEST_SIGNAL))
    except FileError as problem:
        raise ModelError("", f"{shown}: {problem}") from problem
    except ModelError as error:
        raise ModelError("", f"{shown}, {error.what}") from error


def parse_accelerations(text: str) -> Accelerations | tuple[Task, ...]:
    """Read the text of such a file; errors begin with the number of the line."""
    number, header = next(csv_columns.rows_of(text), (1, []))
    names = [cell.split("[")[0].strip() for cell in header]
    if "time" in names:
        return _signal(text, names)
    if "frequency" in names:
        return _spectrum(text, names)
    if {"task", "acceleration", "duration"} & set(names):
        return _tasks(text)
    given = f"the column {csv_columns.shortened(header[0])}" if header else "no column"
    right = csv_columns.told_forms((*_SIGNAL, *_SPECTRUM, *_TASKS)).replace(
        " or acc", " or task,acc"
    )
    raise ModelError("", f"line {number}: got {given}; {right}")


def _signal(text: str, names: list[str]) -> Accelerations:
    axes, columns = _axes(text, "time", names)
    time = columns["time"]
    worst = uneven(time) if len(time) > 1 else None
    if worst is not None:
        raise ModelError(
            "", f"line {_line(text, worst)}, column time: {time[worst]:.6g} s {UNEVEN_STEPS}"
        )
    return Accelerations("time", time, axes, np.array([columns[axis] for axis in axes]))


def _spectrum(text: str, names: list[str]) -> Accelerations:
    axes, columns = _axes(text, "frequency", names)
    for name, column in columns.items():
        if np.any(column < 0):
            first = int(np.argmax(column < 0))
            raise ModelError(
                "",
                f"line {_line(text, first)}, column {name}: got {column[first]:g}; give RMS values "
                "and frequencies of 0 or more",
            )
    values = np.array([columns[axis] for axis in axes])
    return Accelerations("frequency", columns["frequency"], axes, values)


def _axes(text: str, first: str, names: list[str]) -> tuple[tuple[str, ...], dict[str, Array]]:
    """Axes that a file has, and its columns; one that has none is told of all three."""
    axes = tuple(axis for axis in AXES if axis in names) or AXES
    forms: csv_columns.Forms = ((first, *axes),)
    return axes, csv_columns.arrays_of(text, forms)


def _line(text: str, row: int) -> int:
    """Line of a row below the header."""
    number, _ = next(islice(csv_columns.rows_of(text), row + 1, None))
    return number


def _tasks(text: str) -> tuple[Task, ...]:
    """Tasks of a day; the names of tasks are a column of text."""
    rows = csv_columns.rows_of(text)
    line, header = next(rows)
    names, unit_of = _tasks_header(line, header)
    at = header.index("task")
    tasks: list[Task] = []
    for number, row in rows:
        if len(row) != len(header):
            raise ModelError(
                "", f"line {number}: got {len(row)} values; the header has {len(header)} columns"
            )
        name = row.pop(at) or f"task {len(tasks) + 1}"
        cells = zip(names, unit_of, row, strict=True)
        values = {key: csv_columns.value_of(number, key, unit, cell) for key, unit, cell in cells}
        try:
            tasks.append(Task(name, **values))
        except UsageError as error:
            raise ModelError("", f"line {number}, column {error}") from error
    if not tasks:
        raise ModelError("", f"line {line}: there are no rows below the header; give at least one")
    return tuple(tasks)


def _tasks_header(line: int, header: list[str]) -> tuple[list[str], list[str]]:
    """Names and units of the columns that are no text."""
    right = csv_columns.told_forms(_TASKS)
    whole = right.replace("acceleration", "task,acceleration")
    if header.count("task") != 1:
        raise ModelError("", f"line {line}: got {header.count('task')} columns task; {whole}")
    try:
        return csv_columns.header_of(line, [cell for cell in header if cell != "task"], _TASKS)
    except ModelError as error:
        raise ModelError("", error.what.replace(right, whole)) from error
