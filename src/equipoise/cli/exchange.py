"""The command `export`: a linkage, or the designs of a store, as a file of another program."""

from __future__ import annotations

import os
import sys
from functools import partial
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from equipoise.cli.models import linkage_of
from equipoise.cli.options import Angle, Out, blaming, naming, wants
from equipoise.cli.outputs import check_result_file, sources_of, tell, wrote
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.mechanism.parts.machine import Machine

FILE = "Path of a model file or of a store, or the name of a bundled example."


def export(
    file: Annotated[str, Parameter(name="FILE", help=FILE)],
    /,
    *,
    out: Out = None,
    format: Annotated[str | None, wants("NAME")] = None,
    at: Angle = None,
    balanced: bool = False,
    kept: bool = False,
) -> None:
    """Write a linkage for another program, or all designs of a store as one table, in SI units.

    Parameters
    ----------
    out
        The file, whose ending tells the format: .html for an interactive page, .xml for MuJoCo,
        .dxf, .xlsx, and for the designs of a store .csv or .parquet.  docs/exchange.md has them
        all.
    format
        Name of the format, such as mjcf, where the ending is to be another.
    at
        Crank angle at which a linkage is drawn; 0 deg if not given.
    balanced
        Balance the linkage first, as "equipoise balance" would; its counterweights are told too.
    kept
        Of a store, only designs that keep every limit.
    """
    from equipoise.exchange.export import check_kind, format_of
    from equipoise.exchange.export import export as write
    from equipoise.schema.opening import bundled

    if out is None:
        raise UsageError("--out: missing; give the name of a file")
    with blaming("--out" if format is None else "--format"):
        one = format_of(out, format)
        if os.path.exists(file) or file in bundled():
            check_kind(one, of_store=os.path.isdir(file))
    if one.of_store:
        _check(f"a file of {one.title} holds the designs of a store", at=at, balanced=balanced)
        _designs(file, out, kept)
        return
    _check("it goes with a store", kept=kept)
    if not one.posed:
        _check(f"a file of {one.title} is the same at every crank angle", at=at)
    machine = linkage_of(file)
    check_result_file("--out", out, sources_of(machine, file))
    with naming(file):
        what = _balanced(machine) if balanced else machine
        for part in write(what, out, one.name, crank_angle=at or 0.0):
            tell(f"note: the file leaves out {part}", sys.stderr)
    wrote(out)


def _check(why: str, **options: object) -> None:
    """Refuse options that do nothing."""
    for name, given in options.items():
        if given:
            raise UsageError(f"--{name}: {why}; leave it out")


def _designs(store: str, out: str, kept: bool) -> None:
    from equipoise.studies.selection import write_designs
    from equipoise.studies.store import open_store

    opened = open_store(store)
    check_result_file("--out", out, [])
    wrote(f"{write_designs(opened, out, kept=kept)} designs to {out}")


def _balanced(machine: Machine) -> Balanced:
    from equipoise.balancing.advice import advise
    from equipoise.balancing.optimisation import balance
    from equipoise.cli.progress import counted

    with counted("step") as progress:
        return advise(machine, partial(balance, progress=progress))
