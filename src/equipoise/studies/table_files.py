"""The designs of a store as one Parquet or CSV file, however many there are."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from json import dumps
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from equipoise.codegen.figures import REASONS
from equipoise.errors import UsageError
from equipoise.studies.extras import needed
from equipoise.studies.outcomes import Block
from equipoise.studies.outcomes import kept as keep
from equipoise.studies.selection import outputs_of
from equipoise.studies.store import REASON, UNKNOWN, Store, as_usage_error

Array = np.ndarray[Any, Any]
Write = Callable[[Any], None]
"""Takes a table of some rows."""


def export(store: Store, path: str | os.PathLike[str], *, kept: bool = False) -> int:
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
        raise UsageError(f"{target}: give the name of a file that ends in .csv or .parquet")
    schema = _schema(store)
    outputs = outputs_of(store)
    rows = 0
    with (
        as_usage_error(target, "the file cannot be written", "choose another place or name"),
        _replaced(target) as file,
        writers[target.suffix.lower()](file, schema, store) as write,
    ):
        for start, block in store.in_blocks():
            wanted = block.outcome.reason != UNKNOWN
            if kept:
                wanted = keep(outputs, block.outcome.figures).all(axis=1)
            table = _table(schema, start, block, np.flatnonzero(wanted))
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
    about = {"study": dumps(dict(store.texts), ensure_ascii=False)}
    return arrow.schema([arrow.field("design", arrow.int64()), *numbers, reason], metadata=about)


def _table(schema: Any, start: int, block: Block, rows: Array) -> Any:
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


@contextmanager
def _replaced(path: Path) -> Iterator[BinaryIO]:
    """A file that takes its place once it is whole."""
    target = Path(os.path.realpath(path))  # through a symbolic link, which is to stay one
    partial = target.with_name(f".{target.name}.{os.getpid()}.tmp")
    try:
        with open(partial, "wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.replace(partial, target)
    finally:
        partial.unlink(missing_ok=True)
