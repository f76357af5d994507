"""A moving picture for pages: one SVG that needs no script and no other file.

Its style sheet moves the parts, as rigid bodies, so links keep their lengths between two instants.
It stands still in print, for readers who have asked their computer for less motion, and while the
pointer is on it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from hashlib import sha256
from html import escape
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.moving import Moving, Part, Stroke, laid_out
from equipoise.figures.stage import Arrow, Label, Moves, check_seconds, check_width
from equipoise.i18n import say
from equipoise.symbols.looks import DARK, LIGHT, LOOKS, Colors, pixels

if TYPE_CHECKING:
    from equipoise.symbols.scene import Scene

MOST_STEPS = 1500
"""Frames in a cycle, so that the text stays small."""
NARROW, SHRUNK = 560, 18 / 640
"""Pixels of a page so narrow that the picture shrinks; size of its texts there, in widths of it."""


def animated_svg(
    scene: Scene,
    *,
    title: str,
    traced: Collection[str] = (),
    seconds: float = 2.0,
    frames: int = 60,
    width: int = 640,
    arrow: Arrow | None = None,
) -> str:
    """A linkage that moves, the same text on every run.

    Several of them fit into one page.  Where the page has colours of its own, it gives them as the
    custom properties ``--linkage-paper``, ``-ink``, ``-lines`` and so on, by the names in
    `symbols.looks.LIGHT`.

    Parameters
    ----------
    title : what it is, for those who cannot see it.
    traced : points whose path is drawn.
    seconds, frames : of a turn of the crank; parts go evenly from one frame to the next.  Where a
        cycle takes many turns, there are fewer frames in each.
    width : pixels; it shrinks on a narrower page.
    arrow : the shaking force, where it is wanted.

    Raises
    ------
    UsageError : there is no such point, or it stands still; or the scene has one crank angle only.
    """
    check_seconds(seconds)
    check_width(width)
    drawn = laid_out(scene, traced, frames, width, arrow)
    if drawn.stage.turns * frames > MOST_STEPS:
        frames = max(1, int(MOST_STEPS / drawn.stage.turns))
        drawn = laid_out(scene, traced, frames, width, arrow)
    every = list({id(part.moves): part.moves for part in drawn.parts if part.moves}.values())
    numbers = {id(moves): number for number, moves in enumerate(every, 1)}
    behind, before = (
        "\n".join(_group(part, numbers) for part in parts) for parts in (drawn.behind, drawn.before)
    )
    shapes = "\n".join([behind, *map(_text, drawn.labels), before])
    moves = [list(_steps(one, drawn.stage.times)) for one in every]
    mark = f"e{sha256(repr((shapes, moves, seconds)).encode()).hexdigest()[:8]}"
    lasting = seconds * drawn.stage.turns
    names = ", ".join(body.name for body in scene.bodies)
    words = [say("The linkage turns through its whole cycle."), say("Links: {names}.", names=names)]
    words += [say("Path of {names}.", names=", ".join(traced))] if traced else []
    style = "\n".join([*_colors(mark, drawn), *_motions(mark, moves, lasting, drawn.stage.closed)])
    stage = drawn.stage
    return f"""\
<svg xmlns="http://www.w3.org/2000/svg" class="linkage {mark}" role="img" \
viewBox="0 0 {stage.width} {stage.height}" width="{stage.width}" height="{stage.height}">
<title>{escape(title)}</title>
<desc>{escape(" ".join(words))}</desc>
<style>
{style}
</style>
<rect class="paper" width="{stage.width}" height="{stage.height}" rx="4"/>
{shapes}
</svg>
"""


def _group(part: Part, numbers: dict[int, int]) -> str:
    strokes = "".join(_strokes(part.strokes))
    if part.moves is None:
        return f"<g>{strokes}</g>"
    moves = part.moves
    at = f"translate({_xy(moves.place[0])})rotate({pixels(np.degrees(moves.angle[0]))})"
    if _stretches(moves):
        at += f"scale({pixels(moves.stretch[0], 4)} 1)"
    return f'<g class="m m{numbers[id(moves)]}" transform="{at}">{strokes}</g>'


def _strokes(strokes: tuple[Stroke, ...]) -> Iterator[str]:
    for (role, round_), run in groupby(strokes, lambda one: (one.role, one.radius > 0)):
        if not round_:
            yield f'<path class="{role}" d="{"".join(map(_path, run))}"/>'
            continue
        for one in run:
            x, y = pixels(one.points[0].real), pixels(one.points[0].imag)
            yield f'<circle class="{role}" cx="{x}" cy="{y}" r="{pixels(one.radius)}"/>'


def _path(stroke: Stroke) -> str:
    return f"M{'L'.join(map(_xy, stroke.points))}{'Z' if stroke.closed else ''}"


def _text(label: Label) -> str:
    x, y = pixels(label.place.real), pixels(label.place.imag)
    place = f'x="{x}" y="{y}" text-anchor="{label.anchor}"'
    return f'<text class="{label.color}" {place}>{escape(label.text)}</text>'


def _steps(moves: Moves, times: Any) -> Iterator[str]:
    """Keyframes of what moves."""
    stretched = _stretches(moves)
    for time, place, angle, stretch in zip(
        times, moves.place, np.degrees(moves.angle), moves.stretch, strict=True
    ):
        x, y = pixels(place.real), pixels(place.imag)
        by = f"rotate({pixels(angle)}deg)"
        by += f"scale({pixels(stretch, 4)},1)" if stretched else ""
        yield f"{pixels(100 * time, 3)}%{{transform:translate({x}px,{y}px){by}}}"


def _stretches(moves: Moves) -> bool:
    return bool(np.any(moves.stretch != 1))


def _motions(mark: str, moves: list[list[str]], seconds: float, closed: bool) -> Iterator[str]:
    way = "normal" if closed else "alternate"
    for number, steps in enumerate(moves, 1):
        yield f".{mark} .m{number}{{animation-name:{mark}-{number}}}"
        yield f"@keyframes {mark}-{number}{{{''.join(steps)}}}"
    yield f".{mark} .m{{animation-duration:{seconds:g}s;animation-iteration-count:infinite;"
    yield f"animation-timing-function:linear;animation-direction:{way}}}"
    yield f".{mark}:hover .m{{animation-play-state:paused}}"
    yield f"@media (prefers-reduced-motion:reduce){{.{mark} .m{{animation:none}}}}"
    yield f"@media print{{.{mark} .m{{animation:none}}}}"


def _colors(mark: str, drawn: Moving) -> Iterator[str]:
    unit = drawn.stage.unit
    used = {stroke.role for part in drawn.parts for stroke in part.strokes}
    yield f".{mark}{{{_properties(LIGHT)};max-width:100%;height:auto}}"
    yield f"@media screen and (prefers-color-scheme:dark){{.{mark}{{{_properties(DARK)}}}}}"
    size = drawn.stage.size_of_type
    yield f".{mark} path{{stroke-linecap:round;stroke-linejoin:round}}"
    yield f".{mark} .paper{{fill:var(--paper)}}"
    yield f".{mark}:root{{background:var(--paper)}}"
    for name in sorted(used):
        yield f".{mark} .{name}{{{LOOKS[name].css(unit)}}}"
    yield f".{mark} text{{font:{pixels(size)}px 'DejaVu Sans',Verdana,sans-serif;"
    yield "dominant-baseline:central;paint-order:stroke;stroke:var(--paper);stroke-width:3px}"
    larger = f".{mark} text{{font-size:{pixels(max(size, SHRUNK * drawn.stage.width))}px}}"
    yield f"@media (max-width:{NARROW}px){{{larger}}}"
    for color in sorted({label.color for label in drawn.labels}):
        yield f".{mark} text.{color}{{fill:var(--{color})}}"


def _properties(colors: Colors) -> str:
    return ";".join(f"--{name}:var(--linkage-{name},{color})" for name, color in colors.items())


def _xy(place: complex) -> str:
    return f"{pixels(place.real)} {pixels(place.imag)}"
