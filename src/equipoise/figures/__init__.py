"""Pictures: charts as data, laid out once, written as SVG here and as PNG or PDF by Matplotlib."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from equipoise.displays import PictureFormat
from equipoise.errors import UsageError
from equipoise.results.charts import Chart

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Picture = Chart
"""What can be drawn."""

__all__ = ["Picture", "PictureFormat", "pictures_of", "plot", "render", "unwritten"]


def render(picture: Chart, kind: PictureFormat = "svg") -> bytes:
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


def is_wide(picture: Chart) -> bool:
    """Whether a report has it across the page, and not in one of two columns.

    So are drawings side by side whose axes have names, three of anything, and what asks for it.
    """
    panels = picture.panels
    if picture.across:
        return True
    if picture.columns < 2 or len(panels) < 2:
        return False
    drawings = all(panel.equal and panel.y.label for panel in panels)
    return drawings or picture.columns > 2 or len(panels) > MOST_OF_HALF


LOW = 260.0
"""Height of a picture that need not be parted, points: a third of a page."""


class StandaloneSvg(NamedTuple):
    """A picture as SVG for a page that has its heading beside it.

    wide : whether it runs across the page.  rows : of its panels, each as SVG of its own.
    narrow : for a telephone, of one that is wide.
    """

    svg: str
    wide: bool
    rows: tuple[str, ...] = ()
    narrow: str = ""


def standalone_svg(picture: Chart, by_rows: bool = False) -> StandaloneSvg:
    """A picture without its heading.

    by_rows : whether a high one is drawn by rows of its panels, too; those of drawings are seen
        beside each other, and are not parted.
    """
    from equipoise.figures.layout import HALF, WIDE, lay_out, lay_out_rows, on_telephone
    from equipoise.figures.vector import svg_of

    wide = is_wide(picture)
    room = WIDE if wide else HALF
    sheet = lay_out(picture, room, headed=False)
    narrow = svg_of(on_telephone(picture)) if wide else ""
    drawings = any(panel.equal and panel.y.label for panel in picture.panels)
    if not by_rows or drawings or sheet.height <= LOW:
        return StandaloneSvg(svg_of(sheet), wide, narrow=narrow)
    rows = tuple(map(svg_of, lay_out_rows(picture, room)))
    return StandaloneSvg(svg_of(sheet), wide, rows if len(rows) > 1 else (), narrow)


def pictures_of(result: Any) -> Mapping[str, Chart]:
    """Every picture of a result by name, which also does for a file.

    Raises
    ------
    UsageError : there are none of such a result.
    """
    from equipoise.i18n import Note
    from equipoise.results.result import Result

    if not isinstance(result, Result):
        raise UsageError(
            Note("there are no pictures of {kind}; give a result", kind=type(result).__name__)
        )
    return result.charts()


def plot(result: Any, name: str = "", ax: Axes | None = None) -> Figure:
    """A picture of a result as a figure of Matplotlib, which a notebook shows.

    name : of the picture; the first that the result has where not given.
    ax : axes in which it is drawn, as large as they are; those of a new figure where not given.

    Raises
    ------
    UsageError : there is no such picture.
    """
    from equipoise.figures.layout import lay_out
    from equipoise.figures.paint import figure_of, paint_in
    from equipoise.mechanism.checks import unknown

    charts = pictures_of(result)
    if name and name not in charts:
        raise UsageError(unknown(name, charts, "picture"))
    sheet = lay_out(charts[name or next(iter(charts))])
    return figure_of(sheet) if ax is None else paint_in(ax, sheet)
