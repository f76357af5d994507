"""A record that is dropped on the page: signals over crank angle or time, beside the model's own.

::

    time [s],shaking_force.y [N],rocker angle [deg]
    0,-3.2,41.5
    0.001,-3.4,41.6

A column is an output by its name or its label; its unit stands in the header.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError, at_place
from equipoise.i18n import Note, say
from equipoise.mechanism.outputs.declared import DECLARED
from equipoise.quantities import FACTORS, KINDS, Dimension, format_quantity, plain_unit, typeset
from equipoise.quantities.units import OF_UNIT
from equipoise.results.analysis import Analysis
from equipoise.schema.files import printable
from equipoise.schema.tables import TIMES, check_width, rows_of, shortened, wrong
from equipoise.signals import Array

HEAD = re.compile(r"(?P<name>[^\[\]]+?)\s*\[(?P<unit>[^\[\]]*)\]")
FIRST: dict[str, Dimension] = {"crank_angle": "angle", **dict.fromkeys(TIMES, "time")}
RIGHT = Note(
    "the header is crank_angle [deg] or time [s], then outputs, such as shaking_force.x [N]"
)
LEAST, MOST_ROWS, FAR = 8, 500_000, 36
"""Rows; a gap over so many parts of a cycle is drawn as one."""


@dataclass(frozen=True, eq=False)
class RecordColumn:
    """A column of a record: what it is called, what it is of, and its values (N,), SI units."""

    name: str
    dimension: Dimension | None
    values: Array


@dataclass(frozen=True, eq=False)
class MeasuredSignals:
    """Signals that were measured.

    name : of the file.  over : what they stand against.  at : (N,) rad or s.
    """

    name: str
    over: Literal["crank_angle", "time"]
    at: Array
    columns: tuple[RecordColumn, ...]


def record_of_text(name: str, text: str) -> MeasuredSignals:
    """Read a record from the text of a CSV file.

    Raises
    ------
    ModelError : one sentence: file, line and column, what was given and what would be right.
    """
    place = printable(name)
    try:
        return _record(place, text)
    except ModelError as error:
        raise ModelError("", Note("{place}, {what}", place=place, what=error.what)) from error


def _record(name: str, text: str) -> MeasuredSignals:
    rows = rows_of(text)
    line, header = next(rows, (1, []))
    heads = [_head(line, cell) for cell in header]
    if len(heads) < 2 or heads[0][0] not in FIRST or heads[0][1] != FIRST[heads[0][0]]:
        given = shortened(header[0]) if header else "no column"
        raise wrong(line, Note("got {given}; {right}", given=given, right=RIGHT))
    table = []
    for line, row in rows:
        check_width(line, row, len(heads))
        table.append([_number(line, head[0], cell) for head, cell in zip(heads, row, strict=True)])
        if len(table) > MOST_ROWS:
            raise wrong(
                line,
                Note(
                    "there are more than {most_rows} rows; thin the record out", most_rows=MOST_ROWS
                ),
            )
    if len(table) < LEAST:
        raise wrong(
            line,
            Note(
                "there are {count} rows below the header; give at least {least}",
                count=len(table),
                least=LEAST,
            ),
        )
    values = np.array(table).T * np.array([[factor] for *_, factor in heads])
    columns = tuple(
        RecordColumn(head[0], head[1], row) for head, row in zip(heads[1:], values[1:], strict=True)
    )
    over: Literal["crank_angle", "time"] = "time" if heads[0][0] in TIMES else "crank_angle"
    return MeasuredSignals(name, over, values[0], columns)


def _head(line: int, cell: str) -> tuple[str, Dimension | None, float]:
    """Name, dimension and factor of a column."""
    match = HEAD.fullmatch(cell.strip())
    if match is None:
        return cell.strip(), None, 1.0
    unit = plain_unit(match["unit"].strip())
    if unit not in OF_UNIT:
        raise wrong(
            line,
            Note("got the unit {given}; give one such as N or mm", given=shortened(match["unit"])),
        )
    return match["name"].strip(), OF_UNIT[unit], float(FACTORS[unit])


def _number(line: int, name: str, cell: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        raise wrong(line, Note("got {given}; give a number", given=shortened(cell)), name) from None
    if not np.isfinite(value):
        raise wrong(
            line,
            Note("got {given}; give a number, or leave the row out", given=shortened(cell)),
            name,
        )
    return value


# -- beside a model --------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Compared:
    """A record beside a machine.

    signals : (N,) by name of an output, SI units, at the machine's crank angles; NaN in gaps.
    sentences : how large they are beside the model's own.  left_out : columns that are no output.
    """

    signals: Mapping[str, Array]
    sentences: tuple[str, ...]
    left_out: tuple[str, ...]


def compared_with(
    record: MeasuredSignals, analysis: Analysis, gauges: Sequence[str] = ()
) -> Compared:
    """A record over the crank angles of a machine.

    gauges : names of those that a support has, whose readings are no outputs of an analysis.

    Raises
    ------
    UsageError : no column is an output of this machine, or the unit of one is of something else;
        a record over time needs a machine that turns.
    """
    known = _known(analysis, gauges)
    result, left_out = {}, []
    for column in record.columns:
        output = known.get(column.name.lower().replace(" ", "_"))
        if output is None:
            left_out.append(column.name)
            continue
        name, dimension = output
        if column.dimension != dimension:
            unit = KINDS[dimension].printed[0] if dimension else "none"
            raise UsageError(
                Note(
                    "{name}, column {name_2}: got another unit; give one such as {unit}",
                    name=record.name,
                    name_2=column.name,
                    unit=unit,
                )
            )
        result[name] = column.values
    if not result:
        raise UsageError(
            at_place(
                record.name, Note("no column is an output of this machine; {right}", right=RIGHT)
            )
        )
    angle = _angles(record, analysis)
    cycle = analysis.crank_angle, analysis.motion.turns, analysis.motion.speed
    signals = {name: _over(angle, values, *cycle) for name, values in result.items()}
    shift = _shift(signals, analysis) if record.over == "time" else 0
    signals = {name: np.roll(values, shift) for name, values in signals.items()}
    lines = [*_sizes(signals, analysis)]
    if record.over == "time":
        whole = 360 * analysis.motion.turns
        degrees = round(shift / len(analysis.crank_angle) * whole + whole / 2) % whole - whole // 2
        moved = typeset(str(degrees))
        lines.append(say("moved by {angle}° to where it fits best", angle=moved))
    return Compared(signals, tuple(lines), tuple(left_out))


def _known(analysis: Analysis, gauges: Sequence[str]) -> dict[str, tuple[str, Dimension | None]]:
    """Outputs by name and by label, in small letters and without spaces."""
    pairs = {}
    for item in analysis.outputs:
        for called in (item.label(), item.name):
            pairs[called.lower().replace(" ", "_")] = item.name, item.dimension
    for gauge in gauges:
        output = f"gauges.{gauge}"
        for called in (DECLARED["gauges.{}"].say(gauge), gauge, output):
            pairs[called.lower().replace(" ", "_")] = output, "length"
    return pairs


def _angles(record: MeasuredSignals, analysis: Analysis) -> Array:
    """Crank angles of a record, rad."""
    if record.over == "crank_angle":
        return record.at
    if not analysis.motion.speed:
        raise UsageError(
            at_place(
                record.name,
                Note(
                    "the record is over time, but the machine stands still; give it a speed, "
                    "or a record over crank_angle"
                ),
            )
        )
    return np.asarray(analysis.motion.speed * (record.at - record.at[0]))


def _over(angle: Array, values: Array, grid: Array, turns: int, speed: float) -> Array:
    """A signal at the crank angles of a machine: the mean of all cycles that it has."""
    count, cycle = len(grid), 2 * np.pi * turns
    way = np.sign(speed) or 1.0
    cell = np.rint(way * (angle - grid[0]) / cycle * count).astype(np.int64) % count
    hits = np.bincount(cell, minlength=count)
    sums = np.bincount(cell, weights=values, minlength=count)
    at = np.flatnonzero(hits)
    mean = sums[at] / hits[at]
    places = np.concatenate([[at[-1] - count], at, [at[0] + count]])
    heights = np.concatenate([[mean[-1]], mean, [mean[0]]])
    cells = np.arange(count)
    after = np.searchsorted(places, cells, "left")
    gap = places[after] - places[np.maximum(after - 1, 0)]
    usual = float(np.median(np.diff(places)))
    over = np.interp(cells, places, heights)
    over[(gap > max(3 * usual, count / FAR)) & (places[after] != cells)] = np.nan
    return np.asarray(over)


def _shift(signals: Mapping[str, Array], analysis: Analysis) -> int:
    """Samples by which a record is to be moved so that it is most like the model."""
    total = np.zeros(len(analysis.crank_angle))
    for name, values in signals.items():
        if name not in analysis.outputs or np.any(np.isnan(values)):
            continue
        model = analysis.outputs[name].values
        item, other = (x - np.mean(x) for x in (np.real(model), values))
        size = float(np.sqrt(np.sum(item**2) * np.sum(other**2)))
        if size:
            product = np.fft.rfft(item) * np.conj(np.fft.rfft(other))
            total += np.fft.irfft(product, len(total)) / size
    return int(np.argmax(total))


def _sizes(signals: Mapping[str, Array], analysis: Analysis) -> Iterator[str]:
    """RMS of what was measured and of the model's own at the same crank angles."""
    for name, values in signals.items():
        if name not in analysis.outputs:
            continue
        output = analysis.outputs[name]
        there = np.isfinite(values)
        rms = (
            float(np.sqrt(np.mean(np.square(x[there])))) for x in (values, np.real(output.values))
        )
        measured, model = (
            format_quantity(x, output.dimension) if output.dimension else f"{x:.4g}" for x in rms
        )
        yield say(
            "{output}: RMS measured {measured}, model {model}",
            output=output.label(),
            measured=measured,
            model=model,
        )
