"""A workshop drawing as PDF: a sheet of A4 for each part to be cut, to scale, with its measures.

Outlines and measures are those of the DXF, from `exchange.parts`.
"""

from __future__ import annotations

import io
from cmath import rect
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import cos, degrees, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from equipoise.exchange.formats import Job
from equipoise.exchange.parts import COUNTERWEIGHT, Part, in_mm, parts, places_along
from equipoise.figures.paint import fonts_for, settings
from equipoise.figures.sheet import lines_of
from equipoise.figures.style import INK, MAIN
from equipoise.i18n import LANGUAGES, Note, localized, say, sentence_start, speaking, spoken

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM, INCH = 1e3, 25.4
"""mm in a metre, and in an inch."""
SHEET = (210.0, 297.0)
"""Width and height of a sheet of A4, mm."""
EDGE = 20.0
"""mm on paper left, right and above what is written."""
LETTERS, POINTS = 11.0, 72.0
"""Height of letters, points; points of an inch."""
SCALES = (0.2, 0.5, 1, 2, 5, 10, 20, 50, 100)
"""By how much smaller than true a part may be drawn; below 1 larger."""
OFF = 12.0
"""Between a part and its widest measures, mm on paper."""
MARGIN = 12.0
"""mm on paper left, right and below all measures."""
WRITTEN = 80.0
"""mm on paper for 13 lines of text below the upper edge, and a gap."""
DRAWN = (SHEET[0] - 2 * MARGIN, SHEET[1] - EDGE - WRITTEN - MARGIN)
"""Width and height of what is drawn with all its measures, mm on paper."""
AXIS_BEFORE, AXIS_BEYOND = 0.15, 0.6
"""Over the radius of a sector: how far the x axis is drawn on both sides of its axis."""


NEAR_END, ON_LINE = 0.4, 1e-3
"""Where on an arc its radius is given beside the sector, over the angle from the middle; sine of
what is one direction.
"""


def export_bytes(job: Job) -> bytes:
    """The file's content, in the language that is spoken; in English where no font of this computer
    has its letters.
    """
    from matplotlib.backends.backend_pdf import PdfPages

    out = io.BytesIO()
    about = {"CreationDate": None, "Title": str(job.machine.title)}
    with sheets(job) as figures, PdfPages(out, metadata=about) as pages:
        for figure in figures:
            pages.savefig(figure)
    return out.getvalue()


@contextmanager
def sheets(job: Job) -> Iterator[list[Figure]]:
    """The sheet of each part, to be saved inside: fonts are written when a file is closed."""
    result = parts(job)
    texts = [_texts(job, part) for part in result]
    if spoken() != "en" and fonts_for(frozenset("".join(map("".join, texts))))[1]:
        job.leave_out(
            Note(
                "texts in {language}, for which this computer has no font; they are in English; "
                "install one such as Noto Sans CJK",
                language=LANGUAGES[spoken()],
            )
        )
        with speaking("en"):
            texts = [_texts(job, part) for part in result]
    with settings(texts="".join(map("".join, texts))):
        yield [_sheet(part, lines) for part, lines in zip(result, texts, strict=True)]


def _texts(job: Job, part: Part) -> tuple[str, ...]:
    """What is written above a part, a line each."""
    by = scale_of(part)
    ratio = f"1:{by:g}" if by >= 1 else f"{1 / by:g}:1"
    scale = say("scale {ratio}, dimensions in mm", ratio=ratio)
    rounded = [sentence_start(job.sizes)] if part.kind == COUNTERWEIGHT and job.sizes else []
    return localized(job.machine.title), *part.lines, *rounded, scale


def scale_of(part: Part) -> float:
    """By how much smaller than true a part is drawn, so that it fits on its sheet."""
    return next((scale for scale in SCALES if _fits(part, scale)), SCALES[-1])


def _fits(part: Part, scale: float) -> bool:
    """Whether a part has room on its sheet with all its measures."""
    low, high = _extent(part, scale)
    size = high - low
    return size.real <= DRAWN[0] * scale and size.imag <= DRAWN[1] * scale


def _extent(part: Part, scale: float) -> tuple[complex, complex]:
    """Lower left and upper right corner of a part with its measures, mm."""
    low, high = (MM * corner for corner in part.box)
    off = 1.5 * OFF * scale
    if not part.arcs:
        return low - off * (1 + 1j), high + off * (1 + 1j)
    outer = part.arcs[0]
    ends = outer.direction - outer.angle / 2, outer.direction + outer.angle / 2
    center = MM * outer.center
    course = center + (MM * outer.radius + off) * np.exp(1j * np.linspace(*ends, 181))
    axis = center + np.array(_axis_ends(part, scale))
    places = np.array([*course, *axis, low, high])
    x, y = places.real, places.imag
    return complex(np.min(x), np.min(y)), complex(np.max(x), np.max(y))


def _axis_ends(part: Part, scale: float) -> tuple[float, float, float]:
    """Where the x axis of a link begins and ends and where its letter stands, beside a sector, mm
    from the axis of that.
    """
    outer = part.arcs[0]
    way = 1.0 if abs(outer.direction) > outer.angle / 2 else -1.0
    reach = MM * outer.radius
    end = AXIS_BEYOND * reach
    return -AXIS_BEFORE * way * reach, way * end, way * (end + 3.0 * scale)


def _sheet(part: Part, lines: Sequence[str]) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(SHEET[0] / INCH, SHEET[1] / INCH))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    scale = scale_of(part)
    low, high = (MM * corner for corner in part.box)
    half = complex(*SHEET) * scale / 2
    extent = _extent(part, scale)
    center = (extent[0] + extent[1]) / 2 + 1j * scale * (SHEET[1] / 2 - MARGIN - DRAWN[1] / 2)
    axes.set_xlim(center.real - half.real, center.real + half.real)
    axes.set_ylim(center.imag - half.imag, center.imag + half.imag)
    for edges in part.edges:
        for places in places_along(edges):
            axes.plot(MM * places.real, MM * places.imag, color=INK, linewidth=1.0)
    if part.arcs:
        _angle(axes, part, scale)
    elif not part.is_round:
        _widths(axes, low, high, OFF * scale)
    _radii(axes, part, scale)
    _threads(axes, part, scale)
    _joints(axes, part, scale)
    room = (SHEET[0] - 2 * EDGE) / INCH * POINTS
    short = [piece for line in lines for piece in lines_of(line, room, LETTERS)]
    figure.text(EDGE / SHEET[0], 1 - EDGE / SHEET[1], "\n".join(short), va="top",
                fontsize=LETTERS, linespacing=1.5, color=INK)  # fmt: skip
    return figure


def _widths(axes: Axes, low: complex, high: complex, off: float) -> None:
    """Width below a part and height left of it."""
    below, left = low.imag - off, low.real - off
    arrow = {"arrowstyle": "<->", "color": MAIN, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (low.real, below), (high.real, below), arrowprops=arrow)
    axes.annotate("", (left, low.imag), (left, high.imag), arrowprops=arrow)
    size = high - low
    middle = (low + high) / 2
    axes.text(middle.real, below - off / 6, in_mm(size.real), ha="center", va="top", color=MAIN)
    axes.text(left - off / 6, middle.imag, in_mm(size.imag), ha="right", va="center",
              rotation=90, color=MAIN)  # fmt: skip


def _angle(axes: Axes, part: Part, scale: float) -> None:
    """The angle of a sector outside of it, and the x axis of its link through its axis."""
    outer = part.arcs[0]
    center, radius = MM * outer.center, MM * outer.radius + OFF * scale
    ends = outer.direction - outer.angle / 2, outer.direction + outer.angle / 2
    course = center + radius * np.exp(1j * np.linspace(*ends, 181))
    axes.plot(course.real, course.imag, color=MAIN, linewidth=1.0)
    arrow = {"arrowstyle": "->", "color": MAIN, "shrinkA": 0, "shrinkB": 0}
    for end, before in ((course[0], course[5]), (course[-1], course[-6])):
        axes.annotate("", (end.real, end.imag), (before.real, before.imag), arrowprops=arrow)
        line = np.array([center, center + (end - center) * (1 + 2.0 * scale / radius)])
        axes.plot(line.real, line.imag, color=MAIN, linewidth=0.6)
    sideways = cos(outer.direction)
    align = "center" if abs(sideways) < 0.5 else "left" if sideways > 0 else "right"
    at = center + rect(radius + (5.0 if align == "center" else 2.0) * scale, outer.direction)
    axes.text(at.real, at.imag, f"{in_mm(degrees(outer.angle))}°", ha=align, va="center",
              color=MAIN)  # fmt: skip
    start, end_at, letter = _axis_ends(part, scale)
    axes.plot([center.real + start, center.real + end_at],
              [center.imag] * 2, color=MAIN, linewidth=0.8, dashes=(8, 2, 1.5, 2))  # fmt: skip
    axes.text(center.real + letter, center.imag, "x" if letter > 0 else "−x", ha="center",
              va="center", color=MAIN)  # fmt: skip


def _radii(axes: Axes, part: Part, scale: float) -> None:
    """Diameters of circles, and radii of arcs, each in a direction of its own."""
    aside = _side_of_radii(part)
    for number, curve in enumerate(part.curves):
        center, radius = MM * curve.center, MM * curve.radius
        if aside and not curve.whole:
            toward = curve.direction + aside * NEAR_END * curve.angle
            end = center + rect(radius, toward)
            beyond = radius * (0.5 - NEAR_END) * curve.angle + 6.0 * scale
            text_at = end + rect(beyond, toward + aside * pi / 2)
        else:
            end = center + rect(
                radius, curve.direction if not curve.whole else pi / 4 + number * 0.5
            )
            widest = not curve.whole and curve.radius == max(item.radius for item in part.curves)
            outward = -1.5 if widest else 1.0  # away from the measures of the height
            text_at = end + rect(6.0 * scale, float(np.angle(outward * (end - center))))
        axes.annotate(
            curve.text, (end.real, end.imag), (text_at.real, text_at.imag), color=MAIN,
            ha="left" if text_at.real >= end.real else "right", va="center",
            arrowprops={"arrowstyle": "->", "color": MAIN},
        )  # fmt: skip
        axes.plot(center.real, center.imag, marker="+", markersize=9, color=MAIN)


def _side_of_radii(part: Part) -> int:
    """On which side of a sector its radii are written, away from the x axis, where threads lie in
    its middle; 0 where they can be written in it.
    """
    threads, arcs = part.threads, part.arcs
    if threads is None or not arcs:
        return 0
    middle = arcs[0].direction
    if any(abs(sin(way - middle)) > ON_LINE for _, way in threads.about_axis):
        return 0
    ends = {side: abs(sin(middle + side * arcs[0].angle / 2)) for side in (-1, 1)}
    return max(ends, key=lambda side: ends[side])


def _joints(axes: Axes, part: Part, scale: float) -> None:
    """A cross at each joint, its name beside it on the side of the middle."""
    middle = MM * sum(part.box).real / 2
    for name, at in part.joints:
        x, y = MM * at.real, MM * at.imag
        axes.plot(x, y, marker="+", markersize=9, color=MAIN)
        inward = 1 if x <= middle else -1
        axes.text(x + 2.5 * inward * scale, y, name, ha="left" if inward > 0 else "right",
                  va="center", color=MAIN)  # fmt: skip


def _threads(axes: Axes, part: Part, scale: float) -> None:
    """Circles of threads, each with its size on the side away from the others."""
    if part.threads is None:
        return
    radius, places = part.threads.size / 2, MM * np.array(part.threads.places)
    course = radius * np.exp(1j * np.linspace(0, 2 * pi, 61))
    for place in places:
        axes.plot((place + course).real, (place + course).imag, color=INK, linewidth=0.6)
        axes.plot(place.real, place.imag, marker="+", markersize=6, color=MAIN)
    text_at = places[0] + radius + 2.0 * scale
    axes.text(text_at.real, text_at.imag, f"M{part.threads.size}", ha="left", va="center",
              color=MAIN)  # fmt: skip
