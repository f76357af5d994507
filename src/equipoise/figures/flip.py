"""Pictures that follow one another, there and back, as one SVG without a script."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from hashlib import sha256
from html import escape

from equipoise.figures.layout import lay_out
from equipoise.figures.vector import svg_of
from equipoise.i18n import said
from equipoise.results.charts import Chart


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
        f"<title>{escape(said(pictures[0].title))}</title>",
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
