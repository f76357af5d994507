"""A sheet as an SVG document, and pictures that follow one another in one SVG without a script."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from hashlib import sha256
from html import escape
from itertools import pairwise

import numpy as np

from equipoise.figures.layout import lay_out
from equipoise.figures.sheet import Box, Canvas, CanvasStroke, Markers, Words, box_of
from equipoise.figures.style import PAPER
from equipoise.i18n import localized
from equipoise.results.charts import Chart
from equipoise.signals import Array

FONTS = "DejaVu Sans, Verdana, sans-serif"
FAR = 1e6
"""px, beyond which nothing is seen, and whole numbers of a processor may end."""
BACK = 0.7
"""Opacity of the ground behind texts on a drawing."""
SHAPES: dict[str, tuple[tuple[float, float], ...]] = {
    "s": ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)),
    "D": ((0, -0.7), (0.7, 0), (0, 0.7), (-0.7, 0)),
    "^": ((0, -0.5), (0.5, 0.5), (-0.5, 0.5)),
    "v": ((0, 0.5), (0.5, -0.5), (-0.5, -0.5)),
    "P": (
        *((-0.17, -0.5), (0.17, -0.5), (0.17, -0.17), (0.5, -0.17), (0.5, 0.17), (0.17, 0.17)),
        *((0.17, 0.5), (-0.17, 0.5), (-0.17, 0.17), (-0.5, 0.17), (-0.5, -0.17), (-0.17, -0.17)),
    ),
    "stand": ((0.0, 0.0), (0.5, 0.87), (-0.5, 0.87)),
}
"""Markers of width 1 around 0."""


def svg_of(sheet: Canvas) -> str:
    """The whole document."""
    width, height = _number(sheet.width), _number(sheet.height)
    clips: dict[Box, str] = {}
    parts: list[str] = []
    for item in sheet.items:
        if isinstance(item, Words):
            parts += _words(item)
            continue
        text = _signs(item) if isinstance(item, Markers) else _stroke(item)
        if item.clip is not None:
            name = clips.setdefault(item.clip, f"c{len(clips) + 1}")
            text = text.replace(" ", f' clip-path="url(#{name})" ', 1)
        parts.append(text)
    boxes = "".join(
        f'<clipPath id="{name}"><rect {_rectangle(box)}/></clipPath>' for box, name in clips.items()
    )
    defined = f"<defs>{boxes}</defs>\n" if boxes else ""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}pt" height="{height}pt" '
        f'viewBox="0 0 {width} {height}" font-family="{FONTS}">\n{defined}'
        f'<rect width="{width}" height="{height}" fill="{PAPER}"/>\n'
        + "\n".join(parts)
        + "\n</svg>\n"
    )


def _words(words: Words) -> Iterator[str]:
    if words.backed:
        left, top, right, bottom = box_of(words)
        box = _rectangle((left - 1, top + 0.5, right + 1, bottom))
        yield f'<rect {box} fill="{PAPER}" fill-opacity="{BACK}"/>'
    look = f'font-size="{_number(words.size)}" fill="{words.color}"'
    look += ' font-weight="bold"' if words.bold else ""
    look += f' text-anchor="{words.anchor}"' if words.anchor != "start" else ""
    place = f'x="{_number(words.x)}" y="{_number(words.y)}"'
    if words.turned:
        place = f'transform="translate({_number(words.x)} {_number(words.y)}) rotate(-90)"'
    yield f"<text {place} {look}>{escape(words.text, quote=False)}</text>"


def _stroke(stroke: CanvasStroke) -> str:
    end = "Z" if stroke.closed else ""
    path = "".join(f"{_path(line)}{end}" for line in stroke.lines)
    look = f'fill="{stroke.fill or "none"}"'
    if stroke.fill and len(stroke.lines) > 1:
        look += ' fill-rule="evenodd"'
    if stroke.opacity < 1:
        look += f' fill-opacity="{_number(stroke.opacity, 2)}"'
    if stroke.color:
        look += f' stroke="{stroke.color}" stroke-width="{_number(stroke.width)}"'
        look += ' stroke-linejoin="round"'
        look += ' stroke-linecap="round"' if stroke.round else ""
    if stroke.dashes:
        dashes = " ".join(_number(dash) for dash in stroke.dashes)
        look += f' stroke-dasharray="{dashes}"'
    return f'<path d="{path}" {look}/>'


def _path(line: Array) -> str:
    """SVG path data of straight lines, each step relative to the previous point."""
    tenths = np.round(10 * np.clip(line, -FAR, FAR)).astype(int).tolist()
    steps = (
        f"{_tenths(x - x0)},{_tenths(y - y0)}"
        for (x0, y0), (x, y) in pairwise(tenths)
        if x != x0 or y != y0
    )
    x, y = map(_tenths, tenths[0])
    rest = " ".join(steps)
    return f"M{x},{y}l{rest}" if rest else f"M{x},{y}h0"


@lru_cache(10_000)
def _tenths(count: int) -> str:
    """So many tenths; most steps of a picture are among few."""
    return f"{count / 10:g}"


def _signs(signs: Markers) -> str:
    places, size = signs.places, signs.size
    if signs.shape == ".":
        path = "".join(f"M{_number(x)},{_number(y)}h0" for x, y in places.tolist())
        line = f'stroke="{signs.edge}" stroke-width="{_number(size)}" stroke-linecap="round"'
        return f'<path d="{path}" fill="none" {line}/>'
    look = f'fill="{signs.face}" stroke="{signs.edge}" stroke-width="{_number(signs.width)}"'
    half, whole = size / 2, _number(size)
    if signs.shape == "o":
        radius = _number(round(size, 1) / 2, 2)  # of arcs that are no half circles a ring is oval
        arc = f"a{radius},{radius} 0 1,0"
        ring = f"{arc} {whole},0{arc} {_number(-size)},0"
        path = "".join(f"M{_number(x - half)},{_number(y)}{ring}" for x, y in places.tolist())
    elif signs.shape == "x":
        cross = f"l{whole},{whole}m-{whole},0l{whole},-{whole}"
        path = "".join(
            f"M{_number(x - half)},{_number(y - half)}{cross}" for x, y in places.tolist()
        )
    else:
        outline = size * np.array(SHAPES[signs.shape])
        path = "".join(f"{_path(place + outline)}Z" for place in places)
    return f'<path d="{path}" {look}/>'


def _rectangle(box: Box) -> str:
    left, top, right, bottom = box
    return (
        f'x="{_number(left)}" y="{_number(top)}" '
        f'width="{_number(right - left)}" height="{_number(bottom - top)}"'
    )


def _number(value: float, digits: int = 1) -> str:
    return f"{round(value, digits) + 0.0:g}"


def flipped(pictures: Sequence[Chart], seconds: float, width: int) -> str:
    """The pictures there and back in so many seconds; in print and for less motion the first.

    What all of them have is drawn once, below the rest.  width : pixels.
    """
    sheets = [lay_out(picture) for picture in pictures]
    each = [svg_of(sheet).splitlines()[1:-1] for sheet in sheets]
    common = set(each[0]).intersection(*each[1:])
    still = [line for line in each[0] if line in common]
    frames = ["\n".join(line for line in lines if line not in common) for lines in each]
    mark = f"e{sha256(repr((still, frames, seconds)).encode()).hexdigest()[:8]}"
    sheet = sheets[0]
    head = svg_of(sheet).partition("viewBox")[2].partition("\n")[0]
    height = round(width * sheet.height / sheet.width)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" class="{mark}" role="img" width="{width}" '
        f'height="{height}" viewBox{head}',
        f"<title>{escape(localized(pictures[0].title))}</title>",
        "<style>",
        *_motions(mark, len(frames), seconds),
        "</style>",
        *still,
        *(f'<g class="f f{k}">\n{lines}\n</g>' for k, lines in enumerate(frames)),
        "</svg>\n",
    ]
    return "\n".join(parts)


def _motions(mark: str, count: int, seconds: float) -> Iterator[str]:
    yield f".{mark}{{max-width:100%;height:auto}}.{mark} .f{{visibility:hidden}}"
    for k in range(count):
        begin, end = (f"{100 * share / count:.4g}%" for share in (k, k + 1))
        shows = f"{begin}{{visibility:visible}}{end}{{visibility:hidden}}"
        yield f"@keyframes {mark}-{k}{{0%{{visibility:hidden}}{shows}}}"
        yield f".{mark} .f{k}{{animation:{mark}-{k} {seconds / 2:g}s step-end infinite alternate}}"
    yield f".{mark}:hover .f{{animation-play-state:paused}}"
    first = f".{mark} .f{{animation:none}}.{mark} .f0{{visibility:visible}}"
    yield f"@media (prefers-reduced-motion:reduce){{{first}}}"
    yield f"@media print{{{first}}}"
