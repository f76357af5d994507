"""What the commands of studies share: designs as CSV and as model files, and where these may go."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from equipoise.cli.options import check_new_files

if TYPE_CHECKING:
    import numpy as np

    from equipoise.handheld.model import Tool
    from equipoise.mechanism.model import Machine
    from equipoise.studies.store import Store
    from equipoise.studies.study import Study


def check_model_out(model: Machine | Tool, path: str) -> None:
    """A new model file must have a place to go, and so must all that is written beside it."""
    from equipoise.schema.models import files_of

    check_new_files(path, lambda name: files_of(model, name))


def save_design(model: Machine | Tool, path: str, number: int, of: str) -> None:
    """Write a design as a model file, with where it comes from in its description.

    of : what it is a design of, such as ``the study "Lengths"``.
    """
    from equipoise.schema.files import printable
    from equipoise.schema.models import files_of, save

    title = f"{model.title}, design {number}"
    start = f"Design {number} of {of}. Started from: "
    description = f"{start}{model.description}".removesuffix(" Started from: ")
    made: Any = replace(model, title=title, description=description.strip())
    save(made, path)
    files = files_of(made, path)
    print(f"wrote {' and '.join(map(printable, files))}", file=sys.stderr)


def write_designs(
    path: str,
    designs: Iterable[int],
    columns: Mapping[str, np.ndarray[Any, Any]],
    units: Mapping[str, str],
) -> None:
    """Write designs as CSV, one a row, in SI units, and say so; the form is that of `export`."""
    import csv
    import io

    from equipoise.schema.files import printable
    from equipoise.schema.output import write

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    heads = (f"{name} [{units[name]}]" if units.get(name) else name for name in columns)
    writer.writerow(["design", *heads])
    writer.writerows(zip(designs, *(column.tolist() for column in columns.values()), strict=True))
    write(path, text.getvalue())
    print(f"wrote {printable(path)}", file=sys.stderr)


def title_of(store: Store) -> str:
    """Title of the study in a store."""
    import json

    return str(json.loads(store.texts["study"])["title"])


def si_units(study: Study) -> dict[str, str]:
    """SI unit of each number and output that has one, as a store tells it."""
    from equipoise.quantities import SI

    kinds = {one.path: one.dimension for one in study.vary}
    kinds |= {output.name: output.dimension for output in study.outputs}
    return {name: SI[kind] for name, kind in kinds.items() if kind}
