"""A moving picture for pages: one SVG that needs no script and no other file.

Its style sheet moves the parts, as rigid bodies, so links keep their lengths between two instants.
It stands still in print, for readers who have asked their computer for less motion, and while the
pointer is on it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from hashlib import sha256
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.animation.limits import check_seconds, check_width
from equipoise.i18n import say
from equipoise.plotting.captions import Label, size_of_type
from equipoise.plotting.cartoon import DARK, LIGHT, Cartoon, Colors, Part, cartoon
from equipoise.plotting.shapes import LOOKS, Look, Shape, runs
from equipoise.plotting.stage import Arrow, Track

if TYPE_CHECKING:
    from equipoise.scene import Scene

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
    custom properties ``--linkage-paper``, ``-ink``, ``-lines``, ``-faint``, ``-pale``, ``-wheel``,
    ``-main`` and ``-stress``.

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
    drawn = cartoon(scene, traced, frames, width, arrow)
    if drawn.stage.turns * frames > MOST_STEPS:
        frames = max(1, int(MOST_STEPS / drawn.stage.turns))
        drawn = cartoon(scene, traced, frames, width, arrow)
    tracks = list({id(part.track): part.track for part in drawn.parts if part.track}.values())
    numbers = {id(track): number for number, track in enumerate(tracks, 1)}
    behind, before = (
        "\n".join(_group(part, numbers) for part in parts) for parts in (drawn.behind, drawn.before)
    )
    shapes = "\n".join([behind, *map(_text, drawn.labels), before])
    moves = [list(_steps(track, drawn.stage.times)) for track in tracks]
    mark = f"e{sha256(repr((shapes, moves, seconds)).encode()).hexdigest()[:8]}"
    lasting = seconds * drawn.stage.turns
    style = "\n".join([*_colors(mark, drawn), *_motions(mark, moves, lasting, drawn.stage.closed)])
    stage = drawn.stage
    return f"""\
<svg xmlns="http://www.w3.org/2000/svg" class="linkage {mark}" role="img" \
viewBox="0 0 {stage.width} {stage.height}" width="{stage.width}" height="{stage.height}">
<title>{escape(title)}</title>
<desc>{escape(_description(scene, traced))}</desc>
<style>
{style}
</style>
<rect class="paper" width="{stage.width}" height="{stage.height}" rx="4"/>
{shapes}
</svg>
"""


def _description(scene: Scene, traced: Collection[str]) -> str:
    words = [say("The linkage turns through its whole cycle.")]
    words.append(say("Links: {names}.", names=", ".join(body.name for body in scene.bodies)))
    if traced:
        words.append(say("Path of {names}.", names=", ".join(traced)))
    return " ".join(words)


def _group(part: Part, numbers: dict[int, int]) -> str:
    shapes = "".join(_shapes(part.shapes))
    if part.track is None:
        return f"<g>{shapes}</g>"
    track = part.track
    at = f"translate({_xy(track.place[0])})rotate({_short(np.degrees(track.angle[0]))})"
    if _stretches(track):
        at += f"scale({_short(track.stretch[0], 4)} 1)"
    return f'<g class="m m{numbers[id(track)]}" transform="{at}">{shapes}</g>'


def _shapes(shapes: tuple[Shape, ...]) -> Iterator[str]:
    for run in runs(shapes):
        look = run[0].look
        if not run[0].radius:
            yield f'<path class="{look}" d="{"".join(map(_path, run))}"/>'
            continue
        for shape in run:
            x, y = _short(shape.points[0].real), _short(shape.points[0].imag)
            yield f'<circle class="{look}" cx="{x}" cy="{y}" r="{_short(shape.radius)}"/>'


def _path(shape: Shape) -> str:
    return f"M{'L'.join(map(_xy, shape.points))}{'Z' if shape.closed else ''}"


def _text(label: Label) -> str:
    x, y = _short(label.place.real), _short(label.place.imag)
    return (
        f'<text class="{label.color}" x="{x}" y="{y}" text-anchor="{label.anchor}">'
        f"{escape(label.text)}</text>"
    )


def _steps(track: Track, times: Any) -> Iterator[str]:
    """Keyframes of a track."""
    stretched = _stretches(track)
    for time, place, angle, stretch in zip(
        times, track.place, np.degrees(track.angle), track.stretch, strict=True
    ):
        x, y = _short(place.real), _short(place.imag)
        by = f"scale({_short(stretch, 4)},1)" if stretched else ""
        yield (
            f"{_short(100 * time, 3)}%{{transform:translate({x}px,{y}px)"
            f"rotate({_short(angle)}deg){by}}}"
        )


def _stretches(track: Track) -> bool:
    return bool(np.any(track.stretch != 1))


def _motions(mark: str, moves: list[list[str]], seconds: float, closed: bool) -> Iterator[str]:
    way = "" if closed else " alternate"
    for number, steps in enumerate(moves, 1):
        yield f".{mark} .m{number}{{animation-name:{mark}-{number}}}"
        yield f"@keyframes {mark}-{number}{{{''.join(steps)}}}"
    yield f".{mark} .m{{animation-duration:{seconds:g}s;animation-iteration-count:infinite;"
    yield f"animation-timing-function:linear;animation-direction:{way.strip() or 'normal'}}}"
    yield f".{mark}:hover .m{{animation-play-state:paused}}"
    yield f"@media (prefers-reduced-motion:reduce){{.{mark} .m{{animation:none}}}}"
    yield f"@media print{{.{mark} .m{{animation:none}}}}"


def _colors(mark: str, drawn: Cartoon) -> Iterator[str]:
    unit = drawn.stage.unit
    used = {shape.look for part in drawn.parts for shape in part.shapes}
    yield f".{mark}{{{_properties(LIGHT)};max-width:100%;height:auto}}"
    dark = f".{mark}{{{_properties(DARK)}}}"
    yield f"@media screen and (prefers-color-scheme:dark){{{dark}}}"
    size = size_of_type(drawn.stage)
    yield f".{mark} path{{stroke-linecap:round;stroke-linejoin:round}}"
    yield f".{mark} .paper{{fill:var(--paper)}}"
    yield f".{mark}:root{{background:var(--paper)}}"
    for name in sorted(used):
        yield f".{mark} .{name}{{{_look(LOOKS[name], unit)}}}"
    yield f".{mark} text{{font:{_short(size)}px 'DejaVu Sans',Verdana,sans-serif;"
    yield "dominant-baseline:central;paint-order:stroke;stroke:var(--paper);stroke-width:3px}"
    larger = f".{mark} text{{font-size:{_short(max(size, SHRUNK * drawn.stage.width))}px}}"
    yield f"@media (max-width:{NARROW}px){{{larger}}}"
    for color in sorted({label.color for label in drawn.labels}):
        yield f".{mark} text.{color}{{fill:var(--{color})}}"


def _properties(colors: Colors) -> str:
    return ";".join(f"--{name}:var(--linkage-{name},{color})" for name, color in colors.items())


def _look(look: Look, unit: float) -> str:
    fill = f"var(--{look.fill})" if look.fill else "none"
    if look.line is None:
        return f"fill:{fill}"
    more = ";stroke-linecap:butt" if look.dashes or look.flat else ""
    if look.dashes:
        more += f";stroke-dasharray:{' '.join(_short(length * unit) for length in look.dashes)}"
    return f"fill:{fill};stroke:var(--{look.line});stroke-width:{_short(look.width * unit)}{more}"


def _xy(place: complex) -> str:
    return f"{_short(place.real)} {_short(place.imag)}"


def _short(value: float, digits: int = 2) -> str:
    """A number without needless signs."""
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".") if digits else f"{value:.0f}"
    return "0" if text == "-0" else text
