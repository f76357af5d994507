"""Pictures: charts as data, laid out once, written as SVG here and as PNG or PDF by Matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from equipoise.errors import UsageError
from equipoise.results.charts import Chart

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Kind = Literal["svg", "png", "pdf"]
Picture = Chart
"""What can be drawn."""

__all__ = ["Kind", "Picture", "drawn", "figure", "plot", "render", "unwritten"]


def render(picture: Chart, kind: Kind = "svg") -> bytes:
    """The picture as a file; the same bytes for the same picture."""
    from equipoise.figures.layout import lay_out

    sheet = lay_out(picture)
    if kind == "svg":
        from equipoise.figures.vector import svg_of

        return svg_of(sheet).encode()
    from equipoise.figures.paint import painted

    return painted(sheet, kind)


def unwritten(picture: Chart) -> str:
    """Signs of a picture that no installed font has, so that PNG and PDF show boxes for them."""
    from equipoise.figures.layout import lay_out
    from equipoise.figures.paint import unwritten as found

    return found(lay_out(picture))


MOST_OF_HALF = 4
"""Panels side by side and below each other that are seen in half of the width of a page."""


def drawn(picture: Chart) -> tuple[str, bool]:
    """The picture as SVG for a page that tells its heading beside it; whether it is a wide one."""
    from equipoise.figures.layout import HALF, WIDE, lay_out
    from equipoise.figures.vector import svg_of

    wide = picture.columns > 1 and len(picture.panels) > MOST_OF_HALF
    return svg_of(lay_out(picture, WIDE if wide else HALF, headed=False)), wide


def figure(picture: Chart) -> Figure:
    """The picture as a figure of Matplotlib."""
    from equipoise.figures.layout import lay_out
    from equipoise.figures.paint import figure_of

    return figure_of(lay_out(picture))


def plot(result: Any, *names: str) -> Figure | dict[str, Figure]:
    """Pictures of a result by name: the one that is named, or all by their names.

    Raises
    ------
    UsageError : there is no such picture.
    """
    from equipoise.figures.pictures import pictures_of
    from equipoise.mechanism.checks import unknown

    found = pictures_of(result)
    for name in names:
        if name not in found:
            raise UsageError(unknown(name, found, "picture"))
    if len(names) == 1:
        return figure(found[names[0]])
    return {name: figure(found[name]) for name in names or found}
