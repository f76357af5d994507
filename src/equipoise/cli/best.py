"""The commands `best` and `export`."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Annotated, Any

from equipoise.cli.app import MANY, OUT, SIGNED, STORE, app
from equipoise.cli.options import check_belonging, check_folder, check_result_file, whole
from equipoise.cli.results import Kind, draw
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.model import Machine
    from equipoise.studies.selection import Best
    from equipoise.studies.store import Store

MOST_TOLD = 100_000
ENDINGS = (".csv", ".parquet")


@app.command
def best(
    store: Annotated[str, STORE],
    /,
    *,
    by: Annotated[list[str] | None, MANY] = None,
    largest: Annotated[list[str] | None, MANY] = None,
    count: Annotated[str | None, SIGNED] = None,
    out: Annotated[str | None, OUT] = None,
    design: Annotated[str | None, SIGNED] = None,
    json: bool = False,
    csv: str | None = None,
    plot: str | None = None,
    format: Kind | None = None,
) -> None:
    """The best designs of a store, of those that keep every limit; of several aims, the trade-offs.

    Parameters
    ----------
    store
        Path of a store, as `equipoise sweep` makes it.
    by
        Name of an output or of a varied number to go by, instead of what the study makes small or
        large; small is good unless the study says otherwise.  May be repeated.
    largest
        The same, of which much is good.  May be repeated.
    count
        Most designs that are told, 10 if not given.
    out
        Write the first of them as a new model file.
    design
        With --out: number of another design to write.
    json
        Print one JSON object in SI units, and nothing else.
    csv
        Write the designs to this file, in SI units.
    plot
        Draw the designs into this folder.
    format
        With --plot: kind of the pictures, svg if not given.
    """
    from equipoise.schema.study_units import machine_of
    from equipoise.studies import selection as of_stores
    from equipoise.studies.store import open_store

    check_belonging("--out", out, design=design)
    check_belonging("--plot", plot, format=format)
    opened = open_store(store)
    number = None if design is None else whole("--design", design, 0, opened.size - 1)
    many = of_stores.COUNT if count is None else whole("--count", count, 1, MOST_TOLD)
    if csv is not None:
        check_result_file("--csv", csv, [], [] if out is None else [out])
    if plot is not None:
        check_folder("--plot", plot)
    if out is not None:
        _check_out(opened, out)
    ways: Any = dict.fromkeys(by or ()) | dict.fromkeys(largest or (), "largest")
    found = of_stores.best(opened, many, ways)
    chosen = int(found.designs[0]) if number is None else number
    model = None if out is None else machine_of(opened, chosen)
    if csv is not None:
        _write(found, opened, csv)
    if plot is not None:
        _draw(found, opened, plot, format or "svg")
    _show(found, opened, json)
    if model is not None and out is not None:
        _save(model, opened, chosen, out)


def _check_out(store: Store, out: str) -> None:
    """A design that is to be written must have a place to go, before it is looked for."""
    from equipoise.cli.designs import check_model_out
    from equipoise.schema.study_units import study_of

    check_model_out(study_of(store).model.base(), out)


def _save(model: Machine | Tool, store: Store, number: int, out: str) -> None:
    from equipoise.cli.designs import save_design, title_of

    save_design(model, out, number, f'the study "{title_of(store)}"')


def _write(found: Best, store: Store, path: str) -> None:
    from equipoise.cli.designs import write_designs
    from equipoise.terminal.designs import columns_of

    columns = columns_of(found.numbers, found.values, found.outputs, found.figures)
    write_designs(path, found.designs.tolist(), columns, store.units)


def _draw(found: Best, store: Store, folder: str, kind: Kind) -> None:
    from equipoise.cli.designs import title_of
    from equipoise.plotting.studies import best_drawings
    from equipoise.schema.study_units import units_in

    draw(best_drawings(found, title_of(store), units_in(store)), folder, kind)


def _show(found: Best, store: Store, json: bool) -> None:
    from equipoise.cli.designs import title_of

    if json:
        from equipoise.schema.output import json_text

        print(json_text({"title": title_of(store), **found.to_dict()}))
    else:
        from equipoise.schema.study_units import units_in
        from equipoise.studies.selection import outputs_of
        from equipoise.terminal.best import print_best

        print_best(found, title_of(store), outputs_of(store), units_in(store))


@app.command
def export(
    store: Annotated[str, STORE],
    /,
    *,
    out: Annotated[str | None, OUT] = None,
    kept: bool = False,
) -> None:
    """Write all designs of a store as one table, Parquet or CSV, in SI units.

    Parameters
    ----------
    store
        Path of a store, as `equipoise sweep` makes it.
    out
        The file, which ends in .parquet or .csv.
    kept
        Only designs that keep every limit.
    """
    from equipoise.schema.files import printable
    from equipoise.studies import table_files as of_stores
    from equipoise.studies.store import open_store

    opened = open_store(store)
    if out is None or not out.lower().endswith(ENDINGS):
        got = "missing" if out is None else f"got {out!r}"
        raise UsageError(f"--out: {got}; give the name of a file that ends in .parquet or .csv")
    check_result_file("--out", out, [])
    rows = of_stores.export(opened, out, kept=kept)
    print(f"wrote {rows} designs to {printable(os.fspath(out))}", file=sys.stderr)
