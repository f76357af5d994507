"""What `equipoise sweep` and `resume` print: how many designs, why some failed, the best."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from shlex import quote
from typing import TYPE_CHECKING

from equipoise.schema.files import printable
from equipoise.studies.design_space import Output
from equipoise.terminal.best import best_table
from equipoise.terminal.tables import Row, table

if TYPE_CHECKING:
    from equipoise.schema.study_units import Unit
    from equipoise.studies.selection import Best
    from equipoise.studies.store import Store


BEST = "the best designs; --out writes one as a model file"


@dataclass(frozen=True)
class Summary:
    """What is in a store.

    failures : how many designs failed, by why.
    best : of those that keep every limit; None where there is none, or nothing to go by.
    note : why there is none.
    """

    title: str
    store: Store
    outputs: Sequence[Output]
    failures: Mapping[str, int]
    kept: int
    best: Best | None
    note: str

    @property
    def limited(self) -> bool:
        """Whether there are limits to keep."""
        return any((one.at_least, one.at_most) != (None, None) for one in self.outputs)


def print_swept(summary: Summary, units: Mapping[str, Unit], run: str) -> None:
    """Counts, the best designs, and what can be done with the store.

    run : how long it took.
    """
    store = summary.store
    print(summary.title)
    print(f"{printable(store.path)}: {store.size} designs of {len(store.numbers)} numbers{run}")
    print(table("Designs", ("", "", "%"), _counts(summary)))
    if summary.best is not None:
        print(best_table(summary.best, units))
    if summary.note:
        print(f"\nnote: {summary.note}")
    print("\nNext:")
    for command, what in _next(summary):
        print(f"  {command}  {what}")


def _counts(summary: Summary) -> Iterator[Row]:
    size = summary.store.size
    counts = {"computed": size - sum(summary.failures.values()), **summary.failures}
    if summary.limited:
        counts["keep every limit"] = summary.kept
    for what, count in counts.items():
        yield what, str(count), f"{100 * count / size:.2f}"


def _next(summary: Summary) -> list[tuple[str, str]]:
    store = summary.store.path
    path, table_file = quote(printable(store)), quote(printable(f"{store.stem}.parquet"))
    by = "" if any(one.make for one in summary.outputs) else f" --by {summary.outputs[0].name}"
    told = {} if summary.note else {f"equipoise best {path}{by}": BEST}
    told |= {
        f"equipoise export {path} -o {table_file}": "all designs as one table, or as .csv",
        f"xarray.open_zarr({printable(store)!r})": "the same in Python, without reading it all",
    }
    wide = max(map(len, told))
    return [(f"{command:<{wide}}", what) for command, what in told.items()]
