"""A sheet as a figure of Matplotlib, for PNG, PDF and notebooks; nothing else knows Matplotlib."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from io import BytesIO
from threading import RLock
from typing import Any

import matplotlib
import numpy as np
from matplotlib import font_manager
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import get_font
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path

from equipoise.displays import PictureFormat
from equipoise.figures.sheet import Canvas, CanvasStroke, Markers, SheetItem, Words, box_of
from equipoise.figures.style import PAPER
from equipoise.figures.vector import BACK, SHAPES

PARAMETERS: Any = {
    "font.sans-serif": ["DejaVu Sans", "Verdana"],
    "lines.solid_joinstyle": "round",
    "lines.scale_dashes": False,
    "text.parse_math": False,
    "figure.dpi": 144,
    "savefig.dpi": "figure",
    "text.hinting": "no_hinting",
    "svg.hashsalt": "equipoise",
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
}
"""Texts stay texts in PDF; none of them is read as a formula."""
METADATA: dict[str, dict[str, None]] = {
    "svg": {"Date": None, "Creator": None},
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
OTHER_SCRIPTS = (
    "Noto Sans CJK JP",
    "Noto Sans CJK KR",
    "Noto Sans CJK SC",
    "Noto Sans JP",
    "Noto Sans KR",
    "Source Han Sans",
    "Hiragino Sans",
    "Apple SD Gothic Neo",
    "Yu Gothic",
    "Malgun Gothic",
    "IPAexGothic",
    "NanumGothic",
    "WenQuanYi Zen Hei",
)
"""Fonts, where a computer has them, for signs that Matplotlib's own font lacks."""

LAST_RESORT = "Last Resort"
"""The font that has a box for every sign."""

_painting = RLock()


def font_folder() -> str:
    """Where the fonts are that everybody has who has Matplotlib."""
    return f"{matplotlib.get_data_path()}/fonts/ttf"


@cache
def _families() -> list[str]:
    installed = {font.name for font in font_manager.fontManager.ttflist}
    return ["DejaVu Sans", *(name for name in OTHER_SCRIPTS if name in installed), "sans-serif"]


@cache
def _signs_of(path: str) -> frozenset[int]:
    try:
        return frozenset(get_font(path).get_charmap())
    except (OSError, RuntimeError):  # a font that cannot be read
        return frozenset()


@cache
def fonts_for(signs: frozenset[str]) -> tuple[tuple[str, ...], str]:
    """Families beside the usual ones that have further signs, of all fonts there are, and the signs
    that none has.
    """
    left = {ord(sign) for sign in signs if not sign.isspace()}
    fonts = font_manager.fontManager
    every = {font.name: font.fname for font in reversed(fonts.ttflist)}
    for name in _families()[:-1]:
        left -= _signs_of(every[name])
    if left:  # the list may be older than a font
        known = {font.fname for font in fonts.ttflist}
        for path in sorted({*font_manager.findSystemFonts()} - known):
            if left & _signs_of(path):
                fonts.addfont(path)
        every = {font.name: font.fname for font in reversed(fonts.ttflist)}
    fallbacks: list[str] = []
    for name in sorted(every):
        if left & _signs_of(every[name]) and not name.startswith(LAST_RESORT):
            fallbacks.append(name)
            left -= _signs_of(every[name])
    return tuple(fallbacks), "".join(sorted(map(chr, left)))


def unwritten(sheet: Canvas) -> str:
    """Signs of a sheet's texts that no installed font has."""
    return fonts_for(_signs(sheet))[1]


def _signs(sheet: Canvas) -> frozenset[str]:
    return frozenset("".join(words.text for words in sheet.words))


@contextmanager
def settings(sheet: Canvas | None = None, texts: str = "") -> Iterator[None]:
    """Everything inside looks the same whatever the user's Matplotlib is set to, with fonts for the
    texts of a sheet, or others.

    Matplotlib's settings belong to the whole process, so one thread paints at a time.
    """
    with _painting, matplotlib.rc_context(), warnings.catch_warnings():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(PARAMETERS)
        font = fonts_for(frozenset(texts) if sheet is None else _signs(sheet))[0]
        matplotlib.rcParams["font.family"] = [*_families()[:-1], *font, "sans-serif"]
        warnings.filterwarnings("ignore", r"Glyph \d+ .*missing from", UserWarning)
        yield


class ShownFigure(Figure):
    """A figure that a notebook shows without pyplot, as it is when the cell ends."""

    def _repr_png_(self) -> bytes:
        return _saved(self, "png")


def figure_of(sheet: Canvas) -> Figure:
    """A sheet as a figure, one unit of whose axes is a point."""
    with settings(sheet):
        figure = ShownFigure(figsize=(sheet.width / 72, sheet.height / 72), facecolor=PAPER)
        FigureCanvasAgg(figure)
        _paint_all(figure.add_axes((0, 0, 1, 1)), sheet, 1.0)
    return figure


def paint_in(axes: Axes, sheet: Canvas) -> Figure:
    """A sheet in axes that are there, as large as fits; the figure that these belong to."""
    figure = axes.get_figure(root=True)
    assert isinstance(figure, Figure)
    box = axes.get_window_extent()
    wide, high = (72 * length / figure.dpi for length in (box.width, box.height))
    with settings(sheet):
        axes.clear()
        axes.set_aspect("equal", anchor="NW")
        _paint_all(axes, sheet, min(wide / sheet.width, high / sheet.height))
    return figure


def _paint_all(axes: Axes, sheet: Canvas, scale: float) -> None:
    """All of a sheet in axes whose unit is a point of it.

    scale : points of the figure in one of the sheet.
    """
    axes.set_axis_off()
    axes.set_xlim(0, sheet.width)
    axes.set_ylim(sheet.height, 0)
    for order, item in enumerate(sheet.items):
        _paint(axes, item, order, scale)


def painted(sheet: Canvas, kind: PictureFormat) -> bytes:
    """A sheet as a file of Matplotlib."""
    return _saved(figure_of(sheet), kind, sheet)


def _saved(figure: Figure, kind: PictureFormat, sheet: Canvas | None = None) -> bytes:
    file = BytesIO()
    with settings(sheet):
        figure.savefig(file, format=kind, metadata=METADATA[kind])
    return file.getvalue()


def _paint(axes: Axes, item: SheetItem, order: int, scale: float) -> None:
    """An item; its widths and letters are points, its places units of the axes."""
    artist: Any
    if isinstance(item, Words):
        _write(axes, item, order, scale)
        return
    if isinstance(item, Markers) and item.shape in SHAPES:
        outlines = tuple(place + item.size * np.array(SHAPES[item.shape]) for place in item.places)
        item = CanvasStroke(
            outlines, item.edge, item.width, fill=item.face, closed=True, clip=item.clip
        )
    if isinstance(item, Markers):
        artist = Line2D(*item.places.T, linestyle="none", marker=item.shape, zorder=order)
        wide = 2 * item.size if item.shape == "." else item.size
        artist.set(markersize=scale * wide, markeredgecolor=item.edge, markerfacecolor=item.face)
        artist.set(markeredgewidth=0 if item.shape == "." else scale * item.width)
    else:
        look: Any = {"facecolor": item.fill or "none", "edgecolor": item.color or "none"}
        look |= {"linewidth": scale * item.width if item.color else 0.0, "joinstyle": "round"}
        look |= {"linestyle": (0, [scale * dash for dash in item.dashes])} if item.dashes else {}
        look |= {"alpha": item.opacity} if item.opacity < 1 else {}
        cap: Any = "round" if item.round else "butt"
        artist = PathPatch(_path(item), capstyle=cap, zorder=order, **look)
    axes.add_artist(artist)
    if item.clip is not None:
        left, top, right, bottom = item.clip
        box = Rectangle((left, top), right - left, bottom - top, transform=axes.transData)
        artist.set_clip_path(box)
    else:
        artist.set_clip_on(False)


def _path(stroke: CanvasStroke) -> Path:
    parts = []
    for line in stroke.lines:
        corners = np.vstack([line, line[:1]]) if stroke.closed else line
        codes = np.full(len(corners), Path.LINETO, Path.code_type)
        codes[0] = Path.MOVETO
        if stroke.closed:
            codes[-1] = Path.CLOSEPOLY
        parts.append(Path(corners, codes))
    return Path.make_compound_path(*parts)


def _write(axes: Axes, words: Words, order: int, scale: float) -> None:
    if words.backed:
        left, top, right, bottom = box_of(words)
        look: Any = {"facecolor": PAPER, "alpha": BACK, "linewidth": 0, "zorder": order}
        axes.add_artist(Rectangle((left - 1, top + 0.5), right - left + 2, bottom - top, **look))
    ends = {"start": "left", "middle": "center", "end": "right"}
    place: Any = {"ha": ends[words.anchor], "va": "baseline"}
    x = words.x
    if words.turned:
        upright = {"start": "bottom", "middle": "center", "end": "top"}
        place = {"ha": "right", "va": upright[words.anchor], "rotation": 90}
        x += 0.22 * words.size
    weight = "bold" if words.bold else "normal"
    place |= {"fontsize": scale * words.size, "color": words.color, "fontweight": weight}
    axes.text(x, words.y, words.text, zorder=order + 0.5, **place)
