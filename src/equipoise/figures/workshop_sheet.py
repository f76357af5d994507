"""A workshop drawing as PDF: a sheet of A4 for each part to be cut, to scale, with its measures.

Outlines and measures are those of the DXF, from `exchange.parts`.
"""

from __future__ import annotations

import io
from cmath import rect
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.exchange.formats import Job
from equipoise.exchange.parts import Part, along, in_mm, parts
from equipoise.figures.style import INK, MAIN

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM, INCH = 1e3, 25.4
"""mm in a metre, and in an inch."""
SHEET = (210.0, 297.0)
ROOM = (150.0, 190.0)
"""Width and height of a sheet and of what is drawn on it, mm."""
SCALES = (1, 2, 5, 10, 20, 50, 100)
"""By how much smaller than true a part may be drawn."""
OFF = 12.0
"""Between a part and its widest measures, mm on paper."""
LOWEST = 45.0
"""mm on paper from the lower edge of the sheet to the part's middle, beside half its room."""


def made(job: Job) -> bytes:
    """The file's content."""
    from matplotlib.backends.backend_pdf import PdfPages

    out = io.BytesIO()
    with PdfPages(out, metadata={"CreationDate": None, "Title": str(job.machine.title)}) as pages:
        for part in parts(job):
            pages.savefig(_sheet(part, str(job.machine.title)))
    return out.getvalue()


def scale_of(part: Part) -> int:
    """By how much smaller than true a part is drawn, so that it fits on its sheet."""
    low, high = (MM * corner for corner in part.box)
    size = high - low
    needed = max(size.real / ROOM[0], size.imag / ROOM[1])
    return next((scale for scale in SCALES if scale >= needed), SCALES[-1])


def _sheet(part: Part, title: str) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(SHEET[0] / INCH, SHEET[1] / INCH))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    scale = scale_of(part)
    low, high = (MM * corner for corner in part.box)
    middle = (low + high) / 2
    half = complex(*SHEET) * scale / 2
    center = middle + 1j * scale * (SHEET[1] / 2 - LOWEST - ROOM[1] / 2)
    axes.set_xlim(center.real - half.real, center.real + half.real)
    axes.set_ylim(center.imag - half.imag, center.imag + half.imag)
    for edges in part.edges:
        for (one, bulge), (other, _) in zip(edges, (*edges[1:], edges[0]), strict=True):
            places = MM * along(one, other, bulge, 181 if bulge else 2)
            axes.plot(places.real, places.imag, color=INK, linewidth=1.0)
    _widths(axes, low, high, OFF * scale)
    _radii(axes, part, scale)
    lines = (title, *part.lines, f"scale 1:{scale}, dimensions in mm")
    figure.text(20 / SHEET[0], 1 - 20 / SHEET[1], "\n".join(lines), va="top", fontsize=11,
                linespacing=1.5, color=INK, wrap=True)  # fmt: skip
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


def _radii(axes: Axes, part: Part, scale: int) -> None:
    """Diameters of circles, and radii of arcs, each in a direction of its own."""
    for number, curve in enumerate(part.curves):
        center, radius = MM * curve.center, MM * curve.radius
        end = center + rect(radius, curve.direction if not curve.whole else pi / 4 + number * 0.5)
        widest = not curve.whole and curve.radius == max(one.radius for one in part.curves)
        outward = -1.5 if widest else 1.0  # away from the measures of the height
        text_at = end + rect(6.0 * scale, float(np.angle(outward * (end - center))))
        axes.annotate(
            curve.text, (end.real, end.imag), (text_at.real, text_at.imag), color=MAIN,
            ha="left" if text_at.real >= end.real else "right", va="center",
            arrowprops={"arrowstyle": "->", "color": MAIN},
        )  # fmt: skip
        axes.plot(center.real, center.imag, marker="+", markersize=9, color=MAIN)
