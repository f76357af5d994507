"""The command `import`: a machine from a file of another program."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from equipoise.cli.models import BundledFile
from equipoise.cli.options import Many, Names, OtherFile, Rate, read_by, size, wants
from equipoise.cli.outputs import Shown, check_new, wrote
from equipoise.cli.runner import CommandResult, command
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note


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
    frame: Names = None,
    guide: Names = None,
    link: Names = None,
    unit: Annotated[float | None, read_by(_unit, "UNIT")] = None,
    pin: Annotated[Many, wants('"A = B"')] = None,
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
    check_new(imported.outline.machine(), path)

    def save() -> list[str]:
        write(path, imported.text(), replace=False)
        return [wrote(path)]

    title = str(imported.outline.rest["title"])
    return CommandResult(imported.blocks, owner=imported.machine, title=title, save=save)
