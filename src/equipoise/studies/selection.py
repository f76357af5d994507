"""What is taken out of a store: the best designs, all of them as one file, or a cloud of points.

A store of millions is gone through twice, block by block; what is kept is as large as the picture.

The best keep every limit, by one figure or by several; a file is Parquet or CSV.
"""

from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, ClassVar

import numpy as np

from equipoise.atomic_files import replaced
from equipoise.codegen.figures import COMPUTED, REASONS
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place, needed
from equipoise.i18n import Note
from equipoise.keys.requirement_kinds import Make
from equipoise.mechanism.checks import unknown
from equipoise.results.result import Result
from equipoise.signals import Array
from equipoise.studies.outcomes import (
    DesignBlock,
    design_records,
    far_apart,
    feasible,
    non_dominated,
    signs_of,
    why_none,
)
from equipoise.studies.store import REASON, UNKNOWN, Store, as_usage_error
from equipoise.studies.study import Output, random_numbers

DesignBlocks = Callable[[], Iterable[tuple[int, DesignBlock]]]
"""Gives all designs, each time anew, some at a time with the number of the first."""
NamePair = tuple[str, str]

MOST, SOME = 2000, 250
"""Designs up to which each is drawn; those that are drawn as lines from axis to axis."""
BINS = 40
"""Along each side of a picture of many."""
MIDST, DECADES = (5, 95), 30.0
"""Percentiles of a figure above 0, and their ratio from which its axis is logarithmic."""
STREAM_OF_LINES = 11
"""Stream of random numbers of those designs that are drawn as lines."""


@dataclass(frozen=True, eq=False)
class Spread:
    """What a column reaches over all designs that have figures; SI units."""

    low: float
    high: float
    log: bool

    @property
    def edges(self) -> Array:
        """Of the bins, (BINS + 1,)."""
        return self.at(np.arange(BINS + 1) / BINS)

    @property
    def middles(self) -> Array:
        """Of the bins, (BINS,)."""
        return self.at((np.arange(BINS) + 0.5) / BINS)

    def at(self, shares: Array | float) -> Array:
        """Values so far on the way from the lowest to the highest."""
        if self.log:
            return np.asarray(self.low * (self.high / self.low) ** np.asarray(shares))
        wide = self.high - self.low or abs(self.low) or 1.0
        return np.asarray(self.low + wide * np.asarray(shares))

    def bins(self, values: Array) -> Array:
        """The bin of each value (n,); any where there is none."""
        value = np.searchsorted(self.edges, np.nan_to_num(values), "right") - 1
        return np.asarray(np.clip(value, 0, BINS - 1))


@dataclass(frozen=True, eq=False)
class Cloud:
    """All designs that are stored.

    kept, beyond, failed : how many keep every limit, keep not all, have no figures.
    spreads : by name of a number or output.
    some : columns (n,) by name of designs with figures: all of them where `each`, else some that
        are drawn by chance.  good : whether each of them keeps every limit, (n,).
    counts : of two names: designs within limits and beyond, (2, BINS, BINS), along the second and
        the first; none where `each`.
    lost : of a number: middles of those bins, SI units, in which designs have no figures.
    """

    kept: int
    beyond: int
    failed: int
    spreads: Mapping[str, Spread]
    some: Mapping[str, Array]
    good: Array
    counts: Mapping[NamePair, Array]
    lost: Mapping[str, Array]

    @property
    def each(self) -> bool:
        """Whether every design is among `some`."""
        return len(self.good) == self.kept + self.beyond


def cloud_of(
    blocks: DesignBlocks,
    numbers: Sequence[str],
    outputs: Sequence[Output],
    pairs: Sequence[NamePair],
    size: int,
) -> Cloud:
    """The cloud of some designs.

    Parameters
    ----------
    numbers, outputs : what the columns of values and figures are.
    pairs : names of the columns that are drawn against each other.
    size : number of designs, at most.
    """
    names = [*numbers, *(output.name for output in outputs)]
    few = size <= MOST
    chosen = (
        np.arange(size)
        if few
        else random_numbers(1, STREAM_OF_LINES).choice(size, SOME, replace=False)
    )
    counted = np.zeros(3, int)
    least, most = np.full(len(names), np.inf), np.full(len(names), -np.inf)
    rows, marks = [np.empty((0, len(names)))], [np.empty((3, 0), bool)]
    for start, block in blocks():
        table, kinds = _table(block, outputs)
        counted += np.sum(kinds, axis=1)
        least, most = np.fmin(least, np.fmin.reduce(table)), np.fmax(most, np.fmax.reduce(table))
        own = np.isin(start + np.arange(len(table)), chosen)
        rows.append(table[own])
        marks.append(kinds[:, own])
    table, (good, bad, lost) = np.concatenate(rows), np.concatenate(marks, axis=1)
    there = good | bad
    ends = zip(names, least.tolist(), most.tolist(), table[there].T, strict=True)
    spreads = {
        name: _spread(low, high, column, name not in numbers) for name, low, high, column in ends
    }
    counts: dict[NamePair, Array] = {}
    failed = {name: spreads[name].bins(table[lost, k]) for k, name in enumerate(numbers)}
    if not few:
        counts, failed = _counts(blocks, names, outputs, pairs, spreads)
    middles = {name: spreads[name].middles[np.unique(bins)] for name, bins in failed.items()}
    some = {name: table[there, k] for k, name in enumerate(names)}
    inside, outside, without = counted.tolist()
    return Cloud(inside, outside, without, spreads, some, good[there], counts, middles)


def _table(block: DesignBlock, outputs: Sequence[Output]) -> tuple[Array, Array]:
    """Values and figures (P, d + m), NaN where there are none; which designs keep every limit, keep
    not all, and fail, (3, P).
    """
    reason = block.outcome.reason
    stored, there = reason != UNKNOWN, reason == COMPUTED
    inside = there & np.all(feasible(outputs, block.outcome.figures), axis=1)
    figures = np.where(there[:, None], block.outcome.figures, np.nan)
    values = np.where(stored[:, None], block.values, np.nan)
    return np.hstack([values, figures]), np.array([inside, there & ~inside, stored & ~there])


def _spread(low: float, high: float, some: Array, figure: bool) -> Spread:
    """Of a column from its ends, and from some of its values."""
    if not low <= high:
        return Spread(0.0, 1.0, False)  # no design has it
    few, many = np.percentile(some, MIDST) if len(some) else (low, high)
    return Spread(low, high, bool(figure and low > 0 and many >= DECADES * few))


def _counts(
    blocks: DesignBlocks,
    names: Sequence[str],
    outputs: Sequence[Output],
    pairs: Sequence[NamePair],
    spreads: Mapping[str, Spread],
) -> tuple[dict[NamePair, Array], dict[str, Array]]:
    """`Cloud.counts`, and bins of each number in which designs fail."""
    counts = {pair: np.zeros((2, BINS * BINS), int) for pair in pairs}
    lost = {name: np.zeros(BINS, int) for name in dict.fromkeys(first for first, _ in pairs)}
    for _, block in blocks():
        table, (good, bad, failed) = _table(block, outputs)
        bins = {name: spreads[name].bins(table[:, k]) for k, name in enumerate(names)}
        for (first, second), outcome in counts.items():
            cells = BINS * bins[second] + bins[first]
            for row, mask in enumerate((good, bad)):
                outcome[row] += np.bincount(cells[mask], minlength=BINS * BINS)
        for name in lost:
            lost[name] += np.bincount(bins[name][failed], minlength=BINS)
    return (
        {pair: count.reshape(2, BINS, BINS) for pair, count in counts.items()},
        {name: np.flatnonzero(result) for name, result in lost.items()},
    )


COUNT = 10
"""Designs that are listed by default."""


class NothingBestError(UsageError):
    """A store has no design that is best: nothing is stored, or none keeps every limit.

    store : its path.  reason : the sentence without that path.
    """

    def __init__(self, store: Path | str, reason: Note) -> None:
        super().__init__(at_place(store, reason))
        self.store, self.reason = store, reason

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.store, self.reason)


@dataclass(frozen=True, repr=False)
class Best(Result):
    """The best designs of a store, K of them.

    by : what makes them the best, and which way; several give a Pareto front.
    designs : (K,) their numbers.  values : (K, d).  figures : (K, m).  SI units.
    numbers, outputs : names of the columns of values and figures.
    front : number of Pareto-optimal designs, of which K are listed; 1 where there
        is one figure to go by, but for others just as good.
    kept, computed, stored : number of designs that keep every limit, that have figures, that are
        stored at all.
    trade_off : (F, M) what the whole front has of `by`; none where there is one figure to go by.
    note : where no design keeps every limit, why not; the designs are then those nearest to them.
    """

    blocks_in = "studies.blocks.best_blocks"
    records: ClassVar[str] = "designs"

    by: Mapping[str, Make]
    numbers: tuple[str, ...]
    outputs: tuple[str, ...]
    designs: Array
    values: Array
    figures: Array
    front: int
    kept: int
    computed: int
    stored: int
    trade_off: Array | None = None
    note: str = ""

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units."""
        values = design_records(self.numbers, self.values, self.outputs, self.figures)
        numbered = zip(self.designs.tolist(), values, strict=True)
        return {
            "by": dict(self.by),
            "front": self.front,
            "kept": self.kept,
            "computed": self.computed,
            "stored": self.stored,
            "designs": [{"design": number, **design} for number, design in numbered],
        }


def best(
    store: Store,
    count: int = COUNT,
    by: Mapping[str, Make | None] | None = None,
    *,
    nearest: bool = False,
) -> Best:
    """The best designs that are stored so far, of those that keep every limit.

    Parameters
    ----------
    count : the most that are listed; of a larger front some that lie far from each other.
    by : outputs, or varied numbers, to go by instead of the objectives of the study, each
        ``smallest`` or ``largest``; where None, as the study has it, or ``smallest``.
    nearest : where no design keeps every limit, whether to give those that come nearest, by the sum
        of what they lack of each limit over that limit.

    Raises
    ------
    UsageError : there is nothing to go by, nothing is stored, or no design keeps the limits, or,
        with `nearest`, none has figures.
    """
    if count < 1:
        raise UsageError(Note("got {count} designs; give 1 or more", count=count))
    outputs = store.wishes
    choice = _Choice(store, outputs, _ways(store, outputs, by), count)
    for start, block in store.in_blocks():
        choice.add(start, block)
    return choice.result(nearest)


def _ways(
    store: Store, outputs: Sequence[Output], by: Mapping[str, Make | None] | None
) -> dict[str, Make]:
    makes = {output.name: output.make for output in outputs if output.make}
    if not by:
        if not makes:
            raise UsageError(
                Note(
                    "the study has no objective; name an output to rank by, or give it make = "
                    '"smallest" in the study'
                )
            )
        return makes
    known = [*store.outputs, *store.numbers]
    for name in by:
        if name not in known:
            raise UsageError(unknown(name, known, "output or varied number"))
    return {name: way or makes.get(name) or "smallest" for name, way in by.items()}


class _Choice:
    """What is known of the designs so far."""

    def __init__(
        self, store: Store, outputs: Sequence[Output], ways: Mapping[str, Make], count: int
    ) -> None:
        self.store, self.outputs, self.ways, self.count = store, outputs, ways, count
        columns = [*store.numbers, *store.outputs]
        self.places = [columns.index(name) for name in ways]
        self.signs = signs_of(ways.values())
        self.reasons = np.zeros(256, np.int64)
        self.limits = np.zeros(len(outputs), np.int64)
        self.kept = 0
        self.designs = np.empty(0, np.int64)
        self.rows = np.empty((0, len(columns)))
        self.near = np.empty((0, 2 + len(columns)))  # what they lack, their numbers, their rows

    def add(self, start: int, block: DesignBlock) -> None:
        """Take in designs that follow each other from a number on."""
        self.reasons += block.outcome.counts
        computed = np.flatnonzero(block.outcome.computed)
        figures = block.outcome.figures[computed]
        inside = feasible(self.outputs, figures)
        self.limits += np.sum(inside, axis=0)
        good = np.all(inside, axis=1)
        self.kept += int(np.sum(good))
        if not self.kept:
            lacking = _lack(self.outputs, figures)
            rows = np.column_stack([lacking, start + computed, block.values[computed], figures])
            nearest = np.concatenate([self.near, rows])
            self.near = nearest[np.argsort(nearest[:, 0], kind="stable")[: self.count]]
        rows = np.hstack([block.values[computed[good]], figures[good]])
        self.designs = np.concatenate([self.designs, start + computed[good]])
        self.rows = np.concatenate([self.rows, rows])
        if len(self.ways) > 1:
            self.keep_only(non_dominated(self.costs))
        else:
            self.keep_only(np.argsort(self.costs[:, 0], kind="stable")[: self.count])

    @property
    def costs(self) -> Array:
        costs: Array = self.rows[:, self.places] * self.signs
        return costs

    def keep_only(self, places: Array) -> None:
        self.designs, self.rows = self.designs[places], self.rows[places]

    def result(self, nearest: bool = False) -> Best:
        """The best of all, else the nearest; `UsageError` says why there is none."""
        where, stored = self.store.path, int(np.sum(self.reasons[list(REASONS)]))
        if not stored:
            reason = Note(
                "nothing is computed yet; go on with: equipoise resume {path}", path=where
            )
            raise NothingBestError(where, reason)
        note = ""
        if not self.kept:
            units = [self.store.units.get(output.name, "") for output in self.outputs]
            note = why_none(self.outputs, self.reasons, self.limits, units)
            if not (nearest and len(self.near)):
                raise NothingBestError(where, note)
            self.designs, self.rows = self.near[:, 1].astype(np.int64), self.near[:, 2:]
        front, trade_off = 1, None
        if self.kept and len(self.ways) > 1:
            front, trade_off = len(self.designs), self.costs * self.signs
            self.keep_only(far_apart(self.costs, self.count))
            self.keep_only(np.argsort(self.costs[:, 0], kind="stable"))
        values, figures = np.split(self.rows, [len(self.store.numbers)], axis=1)
        return Best(
            by=dict(self.ways),
            numbers=self.store.numbers,
            outputs=self.store.outputs,
            designs=self.designs,
            values=values,
            figures=figures,
            front=front,
            kept=self.kept,
            computed=int(self.reasons[COMPUTED]),
            stored=stored,
            trade_off=trade_off,
            note=note,
        )


def _lack(outputs: Sequence[Output], figures: Array) -> Array:
    """What designs (P, m) lack of all limits, (P,), each over that limit, or by itself where 0."""
    lacking = np.zeros(len(figures))
    for output, column in zip(outputs, figures.T, strict=True):
        for limit, over in ((output.at_most, 1.0), (output.at_least, -1.0)):
            if limit is not None:
                lacking += np.maximum(over * (column - limit), 0.0) / (abs(limit) or 1.0)
    return lacking


# -- as one table ----------------------------------------------------------------------------------

Write = Callable[[Any], None]
"""Takes a table of some rows."""


def write_designs(store: Store, path: str | os.PathLike[str], *, kept: bool = False) -> int:
    """Write every design that is stored into a file, one a row; returns how many those are.

    Columns are `design`, its number from 0, all varied numbers and outputs in SI units, and
    `reason` in words.  Figures that a design lacks are empty.  Units stand in the header of a CSV
    file, and in the metadata of each column of a Parquet file.

    Parameters
    ----------
    path : of a file whose name ends in .csv or .parquet; one that is there is replaced.
    kept : only those designs that have figures and keep every limit of the study.

    Raises
    ------
    UsageError : pyarrow is not installed, or the file cannot be written.
    """
    target = Path(path)
    writers = {".csv": _csv, ".parquet": _parquet}
    if target.suffix.lower() not in writers:
        raise UsageError(
            at_place(target, Note("give the name of a file that ends in .csv or .parquet"))
        )
    schema = _schema(store)
    outputs = store.wishes
    rows = 0
    with (
        as_usage_error(
            target, Note("the file cannot be written"), Note("choose another place or name")
        ),
        replaced(target) as file,
        writers[target.suffix.lower()](file, schema, store) as write,
    ):
        for start, block in store.in_blocks():
            wanted = block.outcome.reason != UNKNOWN
            if kept:
                wanted = feasible(outputs, block.outcome.figures).all(axis=1)
            table = _arrow_table(schema, start, block, np.flatnonzero(wanted))
            write(table)
            rows += len(table)
    return rows


def _schema(store: Store) -> Any:
    arrow = needed("pyarrow", "an export")
    units = {name: {"unit": unit} for name, unit in store.units.items()}
    numbers = [
        arrow.field(name, arrow.float64(), metadata=units.get(name))
        for name in (*store.numbers, *store.outputs)
    ]
    reason = arrow.field(REASON, arrow.dictionary(arrow.int8(), arrow.string()))
    about = {"study": json.dumps(dict(store.texts), ensure_ascii=False)}
    return arrow.schema([arrow.field("design", arrow.int64()), *numbers, reason], metadata=about)


def _arrow_table(schema: Any, start: int, block: DesignBlock, rows: Array) -> Any:
    """Some rows of designs."""
    arrow = needed("pyarrow", "an export")
    reason = block.outcome.reason
    columns = [
        arrow.array(column[rows], from_pandas=True)  # NaN is what is lacking
        for column in (*block.values.T, *block.outcome.figures.T)
    ]
    words = arrow.DictionaryArray.from_arrays(
        arrow.array(reason[rows].astype(np.int8)), [REASONS[k] for k in range(len(REASONS))]
    )
    return arrow.Table.from_arrays([arrow.array(start + rows), *columns, words], schema=schema)


@contextmanager
def _parquet(file: BinaryIO, schema: Any, _: Store) -> Iterator[Write]:
    parquet = needed("pyarrow.parquet", "an export")
    with parquet.ParquetWriter(file, schema, compression="zstd") as writer:
        yield writer.write_table


@contextmanager
def _csv(file: BinaryIO, schema: Any, store: Store) -> Iterator[Write]:
    arrow_csv = needed("pyarrow.csv", "an export")
    units = store.units
    header = io.StringIO()
    csv.writer(header, lineterminator="\n").writerow(
        f"{name} [{units[name]}]" if name in units else name for name in schema.names
    )
    file.write(header.getvalue().encode())
    # No reason has a sign in it that would need quotes.
    options = arrow_csv.WriteOptions(include_header=False, quoting_style="none")
    with arrow_csv.CSVWriter(file, schema, write_options=options) as writer:
        yield writer.write_table
