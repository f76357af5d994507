"""The command `animate`."""

from __future__ import annotations

import os
import sys
from math import ceil
from typing import TYPE_CHECKING, Annotated, Any

from equipoise.cli.app import FILE, MANY, OUT, SIGNED, app
from equipoise.cli.options import check_belonging, check_target, naming, quantity
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis

KINDS = ("svg", "gif", "mp4")
SVG_FRAMES = 60
"""In a turn; from one to the next, parts go evenly."""
LEAST_ANGLES = 720
"""In a turn, for smooth paths."""
MOST_PATHS = 3


@app.command
def animate(
    file: Annotated[str, FILE],
    /,
    *,
    out: Annotated[str | None, OUT] = None,
    seconds: Annotated[float, SIGNED] = 2.0,
    turns: Annotated[int | None, SIGNED] = None,
    width: Annotated[int, SIGNED] = 640,
    trace: Annotated[list[str] | None, MANY] = None,
    force: bool = False,
    speed: Annotated[str | None, SIGNED] = None,
    dark: bool = False,
) -> None:
    """Show how a linkage moves: as SVG for a page, as GIF, or as a film in MP4.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example.
    out
        The animation: name of an .svg, .gif or .mp4 file; FILE.svg beside you if not given.
    seconds
        Time that a turn of the crank takes.
    turns
        With .mp4: turns of the crank, the whole cycle if not given.
    width
        Width of the picture in pixels.
    trace
        A point whose path is drawn; can be given again.  If not given, points that join nothing.
    force
        Draw the shaking force on the frame as an arrow.
    speed
        With --force: speed of the crank instead of the file's, such as "300 rpm".
    dark
        With .gif and .mp4: light lines on a dark ground.  An SVG follows the reader's screen.
    """
    from equipoise.animation.limits import check_seconds, check_width
    from equipoise.schema.models import load_linkage
    from equipoise.schema.output import write

    name = f"{os.path.basename(file).removesuffix('.toml')}.svg" if out is None else out
    kind = _kind(name)
    if turns is not None and (kind != "mp4" or turns < 1):
        raise UsageError(f"--turns: got {turns}; give 1 or more, with a name that ends in .mp4")
    if dark and kind == "svg":
        raise UsageError("--dark: an SVG follows the reader's screen; leave it out")
    check_belonging("--force", force or None, speed=speed)
    check_seconds(seconds)
    check_width(width)
    machine = load_linkage(file)
    check_target("--out", name, file, machine)
    if speed is not None:
        machine = machine.with_drive(speed=quantity("--speed", speed, "angular speed"))
    options: dict[str, Any] = {"seconds": seconds, "width": width, "traced": trace}
    if kind != "svg":
        options["dark"] = dark
    if kind == "mp4":
        options["turns"] = turns
    from equipoise.results.analysis import analyze

    with naming(file):
        found = analyze(machine, _angles(kind, seconds))
        data = _animated(found, kind, force, options)
    write(name, data)
    print(f"wrote {name}", file=sys.stderr)


def _kind(out: str) -> str:
    kind = os.path.splitext(out)[1].lower().removeprefix(".")
    if kind not in KINDS:
        raise UsageError(f"--out: got {out!r}; give a name that ends in .svg, .gif or .mp4")
    return kind


def _angles(kind: str, seconds: float) -> int:
    """Crank angles in a turn: so many for each frame that paths are smooth."""
    from equipoise.animation.film import in_a_turn

    frames = SVG_FRAMES if kind == "svg" else in_a_turn(kind, seconds)
    return frames * ceil(LEAST_ANGLES / frames)


def _animated(found: Analysis, kind: str, force: bool, options: dict[str, Any]) -> str | bytes:
    from equipoise.animation import film
    from equipoise.animation.svg import animated_svg
    from equipoise.cli.progress import counted
    from equipoise.plotting.stage import Arrow
    from equipoise.scene import Scene

    scene = Scene.of(found.motion)
    if options["traced"] is None:
        options["traced"] = scene.ends[:MOST_PATHS]
    if force:
        forces, of_one = found.forces, len(found.machine.rows) > 1
        options["arrow"] = Arrow(forces.about, forces.shaking_force.value, of_one)
    if kind == "svg":
        return animated_svg(scene, title=found.machine.title, frames=SVG_FRAMES, **options)
    draw = film.gif if kind == "gif" else film.mp4
    with counted("frame") as told:
        return draw(scene, told=told, **options)
