"""The commands `animate` and `report`: a moving linkage, and all results on one page."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any

from equipoise.cli.models import ModelFile, at_speed
from equipoise.cli.options import (
    SIGNED,
    LanguageOption,
    Out,
    Rate,
    SpeedText,
    TextList,
    check_belonging,
    error_in_option,
    quantity,
    refuse_idle,
    wants,
)
from equipoise.cli.outputs import (
    Shown,
    boxes,
    check_result_file,
    default_name,
    sources_of,
    wrote,
)
from equipoise.cli.progress import counted
from equipoise.cli.runner import CommandResult, command
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note, say

if TYPE_CHECKING:
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.results.analysis import Analysis
    from equipoise.symbols.scene import Scene

FILMS = ("svg", "gif", "mp4")
SVG_FRAMES = 60
"""In a turn; from one to the next, parts go evenly."""
MOST_LARGER = 1e9
"""Times that the movement of a support may be drawn larger than true."""


@command(long=True)
def animate(
    file: ModelFile,
    /,
    *,
    out: Out = None,
    seconds: Annotated[float, SIGNED] = 2.0,
    turns: Annotated[int | None, SIGNED] = None,
    width: Annotated[int, SIGNED] = 640,
    trace: Annotated[TextList, wants("POINT")] = None,
    force: bool = False,
    speed: Rate = None,
    exaggerate: Annotated[float | None, SIGNED] = None,
    mode: Annotated[int | None, SIGNED] = None,
    dark: bool = False,
) -> CommandResult:
    """Animate a linkage and its support, as SVG, GIF or MP4.

    A hand-held tool is shown in a mode of its vertical plane, as SVG.

    Parameters
    ----------
    out
        Animation file, .svg, .gif or .mp4. Default: FILE.svg in the current folder.
    seconds
        Duration of a turn of the crank, or with --mode of an oscillation.
    turns
        With .mp4: turns of the crank.  Default: the whole cycle.
    width
        Width of the picture in pixels.
    trace
        A point whose path is drawn; may be repeated.  Default: a planting tip, or points of
        couplers.
    force
        Draw the shaking force on the frame as an arrow.
    speed
        With --force or a support: speed of the crank instead of the file's.
    exaggerate
        Magnification of the motion of the support; 1 is to scale.  Default: a visible one.
    mode
        Animate this mode of the support, counted from 1, instead of the motion at speed; for a tool
        its mode, by default the lowest.
    dark
        With .gif and .mp4: light lines on a dark ground.  An SVG follows the reader's screen.
    """
    from equipoise.figures.motion import followed
    from equipoise.figures.stage import ForceArrow, check_seconds, check_width
    from equipoise.results.analysis import analyze
    from equipoise.schema.files import write
    from equipoise.schema.models import load_linkage
    from equipoise.schema.open_files import kind_of_text, opened

    name = default_name(file, ".svg") if out is None else out
    kind = _kind(name)
    _check_turns(kind, turns)
    if kind == "svg":
        refuse_idle(Note("an SVG follows the reader's screen"), dark=dark)
    check_seconds(seconds)
    check_width(width)
    if kind_of_text(opened(file).text) == "tool":
        if kind != "svg":
            raise UsageError(
                at_place("--out", Note("a tool is animated as SVG; give a name that ends in .svg"))
            )
        given = {"turns": turns, "trace": trace, "speed": speed, "exaggerate": exaggerate}
        refuse_idle(Note("a tool swings in a mode"), **given, force=force)
        write(name, _tool_in_mode(file, mode, seconds, width))
        return CommandResult(save=lambda: [wrote(name)])
    machine = at_speed(load_linkage(file), speed)
    _check_support(machine, force, speed, exaggerate, mode)
    check_result_file("--out", name, sources_of(machine, file))
    options: dict[str, Any] = {"seconds": seconds, "width": width, "traced": trace}
    if kind != "svg":
        options["dark"] = dark
    if kind == "mp4":
        options["turns"] = turns
    count = _angles_of(kind, seconds)
    notes = list[str]()
    if kind != "svg" and mode is None:
        _check_film(machine, kind, seconds, turns, width)
    if mode is not None:
        scene = _in_mode(machine, mode, count)
    else:
        result = analyze(machine, count)
        scene, notes = _swinging(result, exaggerate)
        options["arrow"] = ForceArrow.of(result) if force else None
    if trace is None:
        options["traced"] = () if mode is not None else followed(result.motion)
    write(name, _animated(scene, machine.title, kind, options))
    return CommandResult(save=lambda: [*notes, wrote(name)])


def _check_turns(kind: str, turns: int | None) -> None:
    """Refuse turns of what is no film."""
    if turns is not None and (kind != "mp4" or turns < 1):
        raise UsageError(
            at_place(
                "--turns",
                Note("got {turns}; give 1 or more, with a name that ends in .mp4", turns=turns),
            )
        )


def _check_film(machine: Machine, kind: str, seconds: float, turns: int | None, width: int) -> None:
    """Refuse a film of a cycle of too many turns before all of it is computed."""
    from equipoise.figures.film import check_frames
    from equipoise.figures.stage import in_a_turn
    from equipoise.mechanism.assembly.linkage import assemble

    cycle = assemble(machine).cycle.turns
    if cycle > 1:
        check_frames(in_a_turn(kind, seconds) * (turns or cycle), width)


def _check_support(
    machine: Machine,
    force: bool,
    speed: float | None,
    exaggerate: float | None,
    mode: int | None,
) -> None:
    """Refuse options that do nothing."""
    if exaggerate is not None and not 0 <= exaggerate < MOST_LARGER:
        raise UsageError(
            at_place(
                "--exaggerate",
                Note(
                    "got {exaggerate:g}; give 0 to {most_larger:.0e}",
                    exaggerate=exaggerate,
                    most_larger=MOST_LARGER,
                ),
            )
        )
    if machine.support is None:
        check_belonging("--force", force, speed=speed)
        refuse_idle(Note("the machine stands on solid ground"), exaggerate=exaggerate, mode=mode)
    if mode is not None:
        why = Note("in a mode the crank stands still")
        refuse_idle(why, exaggerate=exaggerate, speed=speed, force=force)


TOOL_FRAMES = 24
"""Of half a swing, which takes a second where nothing else is asked for: fewer are seen to jump."""


def _tool_in_mode(file: str, mode: int | None, seconds: float, width: int) -> str:
    from equipoise.figures.tool_side import in_mode
    from equipoise.figures.vector import flipped
    from equipoise.handheld.modes import vibrate_tool
    from equipoise.handheld.sweep import MODES
    from equipoise.schema.models import load_tool

    modes = vibrate_tool(load_tool(file), MODES)
    with error_in_option("--mode"):
        return flipped(in_mode(modes, 1 if mode is None else mode, TOOL_FRAMES), seconds, width)


def _swinging(analysis: Analysis, factor: float | None) -> tuple[Scene, list[str]]:
    """What moves at speed, its support too, as far as that can be computed, and what is not."""
    from equipoise.figures.swing import moving

    scene, problem = moving(analysis, factor)
    if problem is not None and factor is not None:
        raise problem
    if problem is None:
        return scene, []
    return scene, [say("the support is drawn standing still: {problem}", problem=problem.message())]


def _in_mode(machine: Machine, number: int, count: int) -> Scene:
    from equipoise.figures.swing import in_mode
    from equipoise.vibration.free import modes

    free = modes(machine)
    with error_in_option("--mode"):
        return in_mode(free, number, count)


def _kind(out: str) -> str:
    kind = os.path.splitext(out)[1].lower().removeprefix(".")
    if kind not in FILMS:
        raise UsageError(
            at_place(
                "--out", Note("got {out!r}; give a name that ends in .svg, .gif or .mp4", out=out)
            )
        )
    return kind


def _angles_of(kind: str, seconds: float) -> int:
    """Crank angles in a turn."""
    from equipoise.figures.stage import in_a_turn, smooth

    return smooth(SVG_FRAMES if kind == "svg" else in_a_turn(kind, seconds))


def _animated(scene: Scene, title: str, kind: str, options: dict[str, Any]) -> str | bytes:
    if kind == "svg":
        from equipoise.figures.animation import animated_svg

        return animated_svg(scene, title=title, frames=SVG_FRAMES, **options)
    from equipoise.figures import film

    draw = film.gif if kind == "gif" else film.mp4
    with counted("frame") as text:
        return draw(scene, progress=text, **options)


# -- the report ------------------------------------------------------------------------------------


@command(Shown, long=True)
def report(
    file: ModelFile,
    /,
    *,
    out: Out = None,
    language: LanguageOption = "en",
    pdf: bool = False,
    speed: SpeedText = None,
) -> CommandResult:
    """Write a report of a linkage or a tool: summary, plots, tables, before and after.

    Parameters
    ----------
    out
        Report file, .html or .pdf.  Default: NAME-report.html in the current folder.
    language
        Of the report.
    pdf
        Also write a PDF next to the page.
    """
    paths = _paths(file, out, pdf)
    rate = None if speed is None else quantity("--speed", speed, "angular speed")
    from equipoise.present.composition import check, kind_of, write_document
    from equipoise.present.findings import find
    from equipoise.present.pages import boxed_in_pdf

    check(paths, language)

    result = find(file, speed=rate)
    document = write_document(result, paths, language, _command(file, language, speed))

    def lines() -> Iterator[str]:
        for path in paths:
            yield wrote(path)
            if kind_of(path) == "pdf":
                yield from boxes(boxed_in_pdf(document), Note("read the report as .html"))

    return CommandResult(save=lines)


def _paths(file: str, out: str | None, pdf: bool) -> list[str]:
    """The files that are wanted."""
    from equipoise.present.composition import kind_of

    if out is None:
        out = default_name(file, "-report.html")
    with error_in_option("--out"):
        kind = kind_of(out)
    also = [f"{os.path.splitext(out)[0]}.pdf"] if pdf and kind == "html" else []
    for path in (out, *also):
        check_result_file("--out", path, [file])
    return [out, *also]


def _command(file: str, language: str, speed: str | None) -> str:
    """The command as it can be given again, wherever the report goes."""
    from equipoise.schema.files import printable

    words = ["equipoise", "report", printable(os.path.basename(file))]
    words += [] if language == "en" else ["--language", language]
    return shlex.join([*words, *([] if speed is None else ["--speed", speed])])
