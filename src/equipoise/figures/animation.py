"""A machine as a moving picture: parts in pixels, how they move, and texts.

The SVG needs no script and no other file: its style sheet moves the parts, as rigid bodies, so
links keep their lengths between two instants.  It stands still in print, for readers who have asked
their computer for less motion, and while the pointer is on it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from hashlib import sha256
from html import escape
from itertools import groupby, product
from typing import Any, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.figures.stage import (
    RULER,
    ForceArrow,
    Moves,
    Stage,
    check_seconds,
    check_width,
    width_of,
)
from equipoise.figures.view import round_below
from equipoise.i18n import Note, decimals, localized, say
from equipoise.mechanism.parts.machine import unknown
from equipoise.signals import Array
from equipoise.symbols.carrier import mount
from equipoise.symbols.looks import DARK, LIGHT, LOOKS, Colors, in_turn, pixels
from equipoise.symbols.pieces import PieceTrack, pieces
from equipoise.symbols.scene import Scene, clear_angle
from equipoise.symbols.shapes import FOOT, Shape, arrow


@dataclass(frozen=True)
class Label:
    """A text that stands still.

    place : of its beginning, middle or end, as anchor says; the middle of its height.
    color : name in `symbols.looks.LIGHT`.  in_strip : whether it stands in the strip below, where
    that has several lines.
    """

    text: str
    place: complex
    anchor: Literal["start", "middle", "end"] = "middle"
    color: str = "ink"
    in_strip: bool = False

    def box(self, size: float) -> tuple[float, float, float, float]:
        """Left, top, right, bottom; about as wide as the text will be."""
        wide = width_of(self.text, size)
        left = self.place.real - {"start": 0.0, "middle": 0.5, "end": 1.0}[self.anchor] * wide
        return left, self.place.imag - 0.6 * size, left + wide, self.place.imag + 0.6 * size


def captions(stage: Stage, traced: tuple[str, ...]) -> tuple[Label, ...]:
    """Names of what stands still and of paths, each where it has room; then the strip below."""
    labels: list[Label] = []
    lines = np.concatenate([stage.links, *_of_mounts(stage)])
    places = (*_of_pivots(stage), *_of_gauges(stage), *_of_paths(stage, traced))
    for choices in (*_strip(stage), *places):
        for size in (stage.size_where_narrow, stage.size_of_type):
            free = [choice for choice in choices if _fits(choice, labels, stage, size)]
            if free:
                break
        if free:
            labels.append(min(free, key=lambda item: _covered(item, stage, lines)))
    return tuple(labels)


def _of_mounts(stage: Stage) -> Iterator[Array]:
    """Pixels of the signs of mounts at rest."""
    carrier = stage.scene.carrier
    if carrier is None:
        return
    for item in carrier.support.mounts.values():
        if item.point is not None:
            place = complex(*item.point[:2])
            for shape in mount(item, place, carrier.way(item)):
                yield _stroke(stage, shape, stage.origin).points


def _covered(label: Label, stage: Stage, lines: Array) -> int:
    """How often what is drawn, pixels (N,), lies on a text: links in all poses, and mounts."""
    left, top, right, bottom = label.box(stage.size_of_type)
    x, y = lines.real, lines.imag
    return int(np.sum((left < x) & (x < right) & (top < y) & (y < bottom)))


def _fits(label: Label, others: list[Label], stage: Stage, size: float) -> bool:
    """Whether a text of so many pixels lies in the picture and on no other text."""
    left, top, right, bottom = label.box(size)
    if left < 0 or top < 0 or right > stage.width or bottom > stage.height:
        return False
    boxes = (other.box(size) for other in others)
    return not any(left < b[2] and b[0] < right and top < b[3] and b[1] < bottom for b in boxes)


def _strip(stage: Stage) -> Iterator[list[Label]]:
    """Labels of the strip, set to the right: a scale bar, and lines of text one above the other."""
    right, length = ruler_ends(stage)[1], _ruler_length(stage)
    words = decimals(f"{1000 * length:g} mm" if length < 10 else f"{length:g} m")
    several = len(stage.lines) > 1
    yield [Label(words, right + 8 * stage.unit - 2j, "start", in_strip=several)]
    corner = complex(stage.width - 12 * stage.unit, right.imag - 2)
    for row, (words, color) in enumerate(stage.lines):
        place = corner - 1j * stage.row * row
        yield [Label(words, place, "end", color, several)] if words else []


def ruler_ends(stage: Stage) -> tuple[complex, complex]:
    left = complex(14 * stage.unit, stage.height - 12 * stage.unit)
    return left, left + _ruler_length(stage) * stage.scale


def _ruler_length(stage: Stage) -> float:
    """A round length, m, of a tenth to a fifth of the picture."""
    return round_below(RULER * stage.width / stage.scale)


def _of_pivots(stage: Stage) -> Iterator[list[Label]]:
    side = 22 * stage.unit
    for name in stage.scene.standing:
        place = complex(stage.at(stage.scene.places[name][0]))
        way = stage.scene.ground(name).conjugate() * stage.unit
        yield [
            Label(name, place + (FOOT + 8) * way),
            Label(name, place + side + 10 * way, "start"),
            Label(name, place - side + 10 * way, "end"),
        ]


AROUND: tuple[tuple[complex, Literal["start", "middle", "end"]], ...] = (
    (1j, "middle"), (1, "start"), (-1, "end"), (1 + 1j, "start"), (-1 + 1j, "end"),
    (1 - 1j, "start"), (-1 - 1j, "end"), (-3j, "middle"),
)  # fmt: skip
"""Where a text stands from a sign, and which of its ends is there."""


def _of_gauges(stage: Stage) -> Iterator[list[Label]]:
    """Beside each place of gauges that is seen, nearer or farther."""
    carrier = stage.scene.carrier
    gauges = {} if carrier is None else carrier.named(carrier.support.gauges)
    for place, names in gauges.items():
        if stage.scene.shows(place):
            at, words = complex(stage.at(place)), ", ".join(names)
            yield [
                Label(words, at + off * stage.unit * way, anchor)
                for off, (way, anchor) in product((14, 32, 50), AROUND)
            ]


def _of_paths(stage: Stage, traced: tuple[str, ...]) -> Iterator[list[Label]]:
    """Beyond the ends of each path."""
    off = 14 * stage.unit
    for name in traced:
        path = stage.way(name)
        ends = (path.imag.argmin(), path.real.argmin(), path.real.argmax(), path.imag.argmax())
        top, left, right, bottom = (complex(path[k]) for k in ends)
        yield [
            Label(name, top - 1j * off, color="main"),
            Label(name, left - off, "end", "main"),
            Label(name, right + off, "start", "main"),
            Label(name, bottom + 1j * off, color="main"),
        ]


HEAD = 13.0
"""Length of the head of an arrow, units."""


@dataclass(frozen=True, eq=False)
class PixelPath:
    """A shape in pixels: a line through points (n,), or a circle about the only one."""

    role: str
    points: Array
    closed: bool
    radius: float = 0.0


@dataclass(frozen=True, eq=False)
class MovingGroup:
    """Strokes that move together; those without moves stand still."""

    strokes: tuple[PixelPath, ...]
    moves: Moves | None = None


@dataclass(frozen=True, eq=False)
class Moving:
    """Everything that is drawn: what lies behind the links, the links, and over them the texts.

    behind, before : each from the back to the front.
    """

    stage: Stage
    behind: tuple[MovingGroup, ...]
    labels: tuple[Label, ...]
    before: tuple[MovingGroup, ...]

    @property
    def parts(self) -> tuple[MovingGroup, ...]:
        return self.behind + self.before


def laid_out(
    scene: Scene,
    traced: Collection[str] = (),
    frames: int = 60,
    width: int = 640,
    arrow: ForceArrow | None = None,
    begin: int | None = None,
) -> Moving:
    """Lay out a machine.

    traced : points whose path is drawn.  frames : instants in a turn of the crank, at most as many
    as the scene has crank angles there.  width : pixels.  begin : as of `Stage`.

    Raises
    ------
    UsageError : there is no such point, or it stands still; or the scene has one crank angle only.
    """
    for name in traced:
        if name not in scene.places:
            raise UsageError(unknown(name, scene.places, "point"))
        if name in scene.frame:
            raise UsageError(
                Note("{name!r} is a point of the frame, which has no path; give another", name=name)
            )
    if len(scene.crank_angle) < 2:
        raise UsageError(Note("got one crank angle; an animation needs two and more"))
    stage = Stage(scene, arrow, frames, width, begin)
    names = tuple(dict.fromkeys(traced))
    moves: dict[Any, Moves | None] = {}
    behind: list[MovingGroup] = []
    before: list[MovingGroup] = []
    for piece in pieces(scene, names):
        hold = piece.hold, piece.still
        if hold not in moves:  # pieces that are held alike share their moves
            track = piece.track(scene, stage.unit / stage.scale)
            moves[hold] = None if track is None else stage.moves(track)
        origin = stage.origin if moves[hold] is None else 0
        strokes = tuple(_stroke(stage, shape, origin) for shape in piece.shapes)
        part = MovingGroup(strokes, moves[hold])
        (behind if piece.lies.behind else before).append(part)
    behind.append(MovingGroup((*_paths(stage, names), _ruler(stage))))
    return Moving(stage, tuple(behind), captions(stage, names), (*before, *_force(stage)))


def _stroke(stage: Stage, shape: Shape, origin: complex = 0) -> PixelPath:
    points = np.conj(shape.at(stage.scale, stage.unit)) + origin
    return PixelPath(shape.role, points, shape.closed, shape.size(stage.scale, stage.unit))


def _paths(stage: Stage, traced: tuple[str, ...]) -> Iterator[PixelPath]:
    for name in traced:
        yield PixelPath("trace", stage.way(name), stage.closed)
    if stage.arrow is not None:
        tips = stage.at(stage.foot) + np.conj(stage.arrow.force) * stage.strength
        yield PixelPath("force-path", stage.path(tips), stage.closed)


def _force(stage: Stage) -> Iterator[MovingGroup]:
    """The arrow of the force: its shaft is stretched, its head is not, but where it is short."""
    if stage.arrow is None:
        return
    foot, size = stage.foot, HEAD * stage.unit / stage.scale
    reach = stage.arrow.force * stage.strength / stage.scale
    length, angle = abs(reach), np.unwrap(np.angle(reach))
    short = np.clip(length / (1.5 * size), 1e-3, 1)
    shaft = np.maximum(length - 0.8 * size * short, 1e-3 / stage.scale)
    longest = float(shaft.max())
    shapes = arrow("force", longest)
    tracks = (
        PieceTrack(foot, angle, shaft / longest),
        PieceTrack(foot + reach, angle, short),
    )
    for shape, track in zip(shapes, tracks, strict=True):
        yield MovingGroup((_stroke(stage, shape),), stage.moves(track))


def _ruler(stage: Stage) -> PixelPath:
    """A length by which one can measure, at the lower left."""
    left, right = ruler_ends(stage)
    tick = 4j * stage.unit
    return PixelPath("scale", np.array([left - tick, left, right, right - tick]), closed=False)


MOST_STEPS = 1500
"""Frames in a cycle, so that the text stays small."""
NARROW = 560
"""Pixels of a page so narrow that the picture shrinks."""


def animated_svg(
    scene: Scene,
    *,
    title: str,
    traced: Collection[str] = (),
    seconds: float = 2.0,
    frames: int = 60,
    width: int = 640,
    arrow: ForceArrow | None = None,
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
    parts = in_turn(scene, clear_angle(scene))
    options: dict[str, Any] = {
        "seconds": seconds, "frames": frames, "width": width, "arrow": arrow
    }  # fmt: skip
    if len(parts) > 1:
        return _one_below_another(scene, parts, title, traced, options)
    return _picture(scene, title, traced, **options)[0]


def _picture(
    scene: Scene,
    title: str,
    traced: Collection[str],
    *,
    seconds: float,
    frames: int,
    width: int,
    arrow: ForceArrow | None,
    place: str = "",
    begin: int | None = None,
) -> tuple[str, Stage]:
    """One picture as SVG, and its stage, which knows its width and height in pixels.

    place : attributes that place it within another picture.  begin : as of `Stage`.
    """
    moving = laid_out(scene, traced, frames, width, arrow, begin)
    if moving.stage.turns * frames > MOST_STEPS:
        frames = max(1, int(MOST_STEPS / moving.stage.turns))
        moving = laid_out(scene, traced, frames, width, arrow, begin)
    every = list({id(part.moves): part.moves for part in moving.parts if part.moves}.values())
    numbers = {id(moves): number for number, moves in enumerate(every, 1)}
    behind, before = (
        "\n".join(_group(part, numbers) for part in parts)
        for parts in (moving.behind, moving.before)
    )
    shapes = "\n".join([behind, before, *map(_text, moving.labels)])
    moves = [list(_steps(item, moving.stage.times)) for item in every]
    mark = f"e{sha256(repr((shapes, moves, seconds)).encode()).hexdigest()[:8]}"
    lasting = seconds * moving.stage.turns
    names = ", ".join(body.name for body in scene.bodies)
    turning = any(np.ptp(angle) for angle in scene.angles.values())
    words = [say("The linkage turns through its whole cycle.")] * turning
    words += [say("Links: {names}.", names=names)]
    words += [say("Path of {names}.", names=", ".join(traced))] if traced else []
    words += [text for text, _ in moving.stage.captions]
    style = "\n".join(
        [*_colors(mark, moving), *_motions(mark, moves, lasting, moving.stage.closed)]
    )
    stage = moving.stage
    text = f"""\
<svg {place}xmlns="http://www.w3.org/2000/svg" class="linkage {mark}" role="img" \
viewBox="0 0 {stage.width} {stage.height}" width="{stage.width}" height="{stage.height}">
<title>{escape(localized(title))}</title>
<desc>{escape(" ".join(words))}</desc>
<style>
{style}
</style>
<rect class="paper" width="{stage.width}" height="{stage.height}" rx="4"/>
{shapes}
</svg>
"""
    return text, stage


def traced_in(part: Scene, scene: Scene, traced: Collection[str]) -> list[str]:
    """Of the points whose path is drawn those of a part of a scene, and those that it lacks too."""
    return [name for name in traced if name in part.places or name not in scene.places]


def _one_below_another(
    scene: Scene,
    scenes: list[tuple[tuple[str, ...], Scene]],
    title: str,
    traced: Collection[str],
    options: dict[str, Any],
) -> str:
    """Pictures of links that would cover each other, each scene with their names, in one."""
    pieces, width, top = [], 0, 0
    options = {**options, "begin": clear_angle(scene)}  # all at the same instant
    for names, part in scenes:
        own = traced_in(part, scene, traced)
        piece, stage = _picture(part, ", ".join(names), own, place=f'y="{top}" ', **options)
        pieces.append(piece)
        width, top = max(width, stage.width), top + stage.height
    inner = "".join(pieces)
    return f"""\
<svg xmlns="http://www.w3.org/2000/svg" class="linkages" role="img" \
viewBox="0 0 {width} {top}" width="{width}" height="{top}" style="max-width:100%;height:auto">
<title>{escape(localized(title))}</title>
{inner}</svg>
"""


def _group(part: MovingGroup, numbers: dict[int, int]) -> str:
    strokes = "".join(_strokes(part.strokes))
    if part.moves is None:
        return f"<g>{strokes}</g>"
    moves = part.moves
    at = f"translate({_xy(moves.place[0])})rotate({pixels(np.degrees(moves.angle[0]))})"
    if _stretches(moves):
        at += f"scale({pixels(moves.stretch[0], 4)} 1)"
    return f'<g class="m m{numbers[id(moves)]}" transform="{at}">{strokes}</g>'


def _strokes(strokes: tuple[PixelPath, ...]) -> Iterator[str]:
    for (role, round_), run in groupby(strokes, lambda stroke: (stroke.role, stroke.radius > 0)):
        if not round_:
            yield f'<path class="{role}" d="{"".join(map(_path, run))}"/>'
            continue
        for item in run:
            x, y = pixels(item.points[0].real), pixels(item.points[0].imag)
            yield f'<circle class="{role}" cx="{x}" cy="{y}" r="{pixels(item.radius)}"/>'


def _path(stroke: PixelPath) -> str:
    return f"M{'L'.join(map(_xy, stroke.points))}{'Z' if stroke.closed else ''}"


def _text(label: Label) -> str:
    x, y = pixels(label.place.real), pixels(label.place.imag)
    place = f'x="{x}" y="{y}" text-anchor="{label.anchor}"'
    role = f"{label.color} strip" if label.in_strip else label.color
    return f'<text class="{role}" {place}>{escape(label.text)}</text>'


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


def _sizes_where_narrow(stage: Stage) -> tuple[float, float]:
    """Of letters where the picture is shown small, pixels: beside the machine, and in the strip
    below, whose lines neither touch nor run out of the picture.
    """
    larger, room = stage.size_where_narrow, stage.width - 24 * stage.unit
    longest = max((width_of(words, 1.0) for words, _ in stage.lines), default=0.0)
    fitting = min(larger, stage.row / 1.05, room / max(longest, 1e-9))
    if stage.lines and stage.lines[0][0]:  # which stands beside the ruler and its length
        width = (1 - RULER) * stage.width - 36 * stage.unit
        fitting = min(fitting, width / width_of(stage.lines[0][0] + "500 mm ", 1.0))
    return larger, max(stage.size_of_type, fitting) if len(stage.lines) > 1 else larger


def _colors(mark: str, moving: Moving) -> Iterator[str]:
    unit = moving.stage.unit
    used = {stroke.role for part in moving.parts for stroke in part.strokes}
    yield f".{mark}{{{_properties(LIGHT)};max-width:100%;height:auto}}"
    yield f"@media screen and (prefers-color-scheme:dark){{.{mark}{{{_properties(DARK)}}}}}"
    size = moving.stage.size_of_type
    yield f".{mark} path{{stroke-linecap:round;stroke-linejoin:round}}"
    yield f".{mark} .paper{{fill:var(--paper)}}"
    yield f".{mark}:root{{background:var(--paper)}}"
    for name in sorted(used):
        yield f".{mark} .{name}{{{LOOKS[name].css(unit)}}}"
    yield f".{mark} text{{font:{pixels(size)}px 'DejaVu Sans',Verdana,sans-serif;"
    yield "dominant-baseline:central;paint-order:stroke;stroke:var(--paper);stroke-width:3px}"
    larger, strip = _sizes_where_narrow(moving.stage)
    rules = f".{mark} text{{font-size:{pixels(larger)}px}}"
    if strip < larger:
        rules += f".{mark} text.strip{{font-size:{pixels(strip)}px}}"
    yield f"@media (max-width:{NARROW}px){{{rules}}}"
    for color in sorted({label.color for label in moving.labels}):
        yield f".{mark} text.{color}{{fill:var(--{color})}}"


def _properties(colors: Colors) -> str:
    return ";".join(f"--{name}:var(--linkage-{name},{color})" for name, color in colors.items())


def _xy(place: complex) -> str:
    return f"{pixels(place.real)} {pixels(place.imag)}"
