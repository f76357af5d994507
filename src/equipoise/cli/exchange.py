"""The commands `export` and `import`: files of other programs are written and read."""

from __future__ import annotations

import os
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from equipoise.cli.models import BundledFile
from equipoise.cli.options import (
    Angle,
    LanguageOption,
    NameList,
    OtherFile,
    Out,
    Rate,
    TextList,
    crank_angles,
    error_in_option,
    read_by,
    refuse_idle,
    size,
    wants,
)
from equipoise.cli.outputs import Shown, check_new, check_result_file, sources_of, wrote
from equipoise.cli.runner import CommandResult, command
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note, say

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.mechanism.parts.machine import Machine


STORE = ".zarr"
"""Ending by which a store is known before it is there."""
FILE = "Path of a model file or of a store, or the name of a bundled example."


@command(long=True)
def export(
    file: Annotated[BundledFile, Parameter(name="FILE", help=FILE)],
    /,
    *,
    out: Out = None,
    format: Annotated[str | None, wants("NAME")] = None,
    at: Angle = None,
    balanced: bool = False,
    kept: bool = False,
    link: Annotated[str | None, wants("LINK")] = None,
    angles: Annotated[Any, read_by(crank_angles)] = None,
    language: LanguageOption = "en",
) -> CommandResult:
    """Write a linkage for another program, or all designs of a store as one table, in SI units.

    Parameters
    ----------
    out
        Output file; its extension gives the format: .html for an interactive page, .xml for MuJoCo,
        .dxf, .xlsx, .inp for finite elements of a link, and for the designs of a store .csv or
        .parquet.  docs/exchange.md has them all.
    format
        Name of the format, such as mjcf, where the ending is to be another.
    at
        Crank angle at which a linkage is drawn; 0 deg if not given.  Of loads along a link that of
        the largest stress, or, as CSV, all.
    balanced
        Balance the linkage first, as "equipoise balance" does; its counterweights are included.
    kept
        For a store: only designs within all limits.
    link
        Of loads along a link: which; the only one with a section if not given.
    angles
        Of loads along a link: number of crank angles a turn, or the angles: "0 deg, 45 deg".
    language
        Of drawings and pages.
    """
    from equipoise.exchange.export import check_kind, check_link_loads, format_of, write_file
    from equipoise.schema.models import load_linkage
    from equipoise.schema.open_files import bundled

    if out is None:
        raise UsageError(at_place("--out", Note("missing; give the name of a file")))
    with error_in_option("--out" if format is None else "--format"):
        item = format_of(out, format, of_store=os.path.isdir(file) or file.endswith(STORE))
        if os.path.exists(file) or file in bundled():
            check_kind(item, of_store=os.path.isdir(file))
    if not item.worded:
        other = language if language != "en" else None
        refuse_idle(Note("a file of {title} has no sentences", title=item.title), language=other)
    if item.of_store:
        why = Note("a file of {title} holds the designs of a store", title=item.title)
        refuse_idle(why, at=at or None, balanced=balanced)
        check_link_loads(item, prefix="--", link=link, angles=angles)
        return CommandResult(save=lambda: _designs(file, out, kept))
    refuse_idle(Note("it goes with a store"), kept=kept)
    check_link_loads(item, prefix="--", link=link, angles=angles)
    if angles is not None and at is not None:
        raise UsageError(Note("--at and --angles were given; give one of them"))
    if not item.posed:
        why = Note("a file of {title} is the same at every crank angle", title=item.title)
        refuse_idle(why, at=at or None)
    machine = load_linkage(file)
    check_result_file("--out", out, sources_of(machine, file))
    what = _balanced(machine) if balanced else machine
    job = write_file(what, out, item.name, crank_angle=at, kept=False, link=link, angles=angles,
                     language=language)  # fmt: skip
    notes = () if job is None else job.notes("file")
    return CommandResult(save=lambda: [*notes, wrote(out)])


def _designs(store: str, out: str, kept: bool) -> list[str]:
    from equipoise.studies.selection import write_designs
    from equipoise.studies.store import open_store

    opened = open_store(store)
    check_result_file("--out", out, [])
    count = write_designs(opened, out, kept=kept)
    return [wrote(say("{count} designs to {file}", count=count, file=out))]


def _balanced(machine: Machine) -> Balanced:
    from equipoise.balancing.advice import advise
    from equipoise.balancing.optimisation import balance
    from equipoise.cli.progress import counted

    with counted("step") as progress:
        return advise(machine, partial(balance, progress=progress))


def _unit(option: str, text: str) -> float:
    """A length, or the unit of one: m."""
    from equipoise.cli.options import quantity

    bare = not any(map(str.isdigit, text))
    try:
        value = quantity(option, f"1 {text}" if bare else text, "length")
    except UsageError:
        if not bare:
            raise
        value = 0.0
    if value <= 0:
        raise UsageError(
            at_place(
                option,
                Note("got {text!r}; give a unit such as mm, or a length of more than 0", text=text),
            )
        )
    return value


@command(Shown)
def import_file(
    file: Annotated[BundledFile, Parameter(name="FILE")],
    /,
    *,
    out: Annotated[
        str | None, Parameter(name=["--out", "-o"], metavar="FILE"), OtherFile(".toml")
    ] = None,
    crank: Annotated[str | None, wants("LINK")] = None,
    speed: Rate = None,
    frame: NameList = None,
    guide: NameList = None,
    link: NameList = None,
    unit: Annotated[float | None, read_by(_unit, "UNIT")] = None,
    pin: Annotated[TextList, wants('"A = B"')] = None,
    tolerance: Annotated[
        float | None, size("length", "give more than 0"), wants('"0.1 mm"')
    ] = None,
    shown: Shown,
) -> CommandResult:
    """Create a model file from a DXF or SVG drawing, MJCF, URDF, Linkage or PMKS+.

    Parameters
    ----------
    file
        Path of the file.  The format is detected from content and extension.
    out
        Model file to write.  Default: FILE.toml in the current folder.
    crank
        Driven link; if not given the file's, or one that turns fully.
    speed
        Speed of the crank instead of the file's.
    frame
        Of a drawing: layer, colour or group of what stands still; "frame", "ground", "fixed" and
        "base" if not given.  Of a model: body that stands still.  May be repeated.
    guide
        Of a drawing: layer, colour or group of lines on which ends of links slide; "guide",
        "slider" and "rail" if not given.  May be repeated.
    link
        Of a drawing: layer, colour or group, what is drawn under which is one link.  May be
        repeated.
    unit
        Of a drawing: its unit, such as mm, or the length of one, such as "0.5 mm", instead of the
        unit that it states.
    pin
        Of a model: two bodies or sites that a pin joins, where the file closes no loops, as
        "rod_end = rocker_end".  May be repeated.
    tolerance
        Of a drawing: distance below which ends of lines meet; a millionth of its size if not given.
    """
    from equipoise.exchange.reading.formats import import_machine
    from equipoise.schema.files import write

    path = out or ""  # FILE.toml where none is given
    imported = import_machine(
        file,
        crank=crank or "",
        speed=speed,
        frame=frame or (),
        guide=guide or (),
        link=link or (),
        tolerance=tolerance or 0.0,
        pin=pin or (),
        unit=unit,
    )
    if shown.units:
        imported = imported.shown_in(shown.units)
    check_new(imported.outline.to_machine(), path)

    def save() -> list[str]:
        write(path, imported.text(), replace=False)
        return [wrote(path)]

    title = str(imported.outline.rest["title"])
    return CommandResult(imported.blocks, owner=imported.machine, title=title, save=save)
