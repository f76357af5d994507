"""Pictures: charts as data, laid out once, written as SVG here and as PNG or PDF by Matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from equipoise.results.charts import Chart

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Kind = Literal["svg", "png", "pdf"]

__all__ = ["Kind", "plot", "render"]


def render(picture: Chart | Figure, kind: Kind = "svg") -> bytes:
    """The picture as a file; the same bytes for the same picture."""
    if not isinstance(picture, Chart):
        from equipoise.plotting.style import render as drawn

        return drawn(picture, kind)
    from equipoise.figures.layout import lay_out

    sheet = lay_out(picture)
    if kind == "svg":
        from equipoise.figures.vector import svg_of

        return svg_of(sheet).encode()
    from equipoise.figures.paint import painted

    return painted(sheet, kind)


def plot(chart: Chart) -> Figure:
    """The picture as a figure of Matplotlib."""
    from equipoise.figures.layout import lay_out
    from equipoise.figures.paint import figure_of

    return figure_of(lay_out(chart))
