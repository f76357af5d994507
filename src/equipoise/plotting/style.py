"""How pictures look, and how they become files that are the same on every run."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from io import BytesIO
from threading import RLock
from typing import Any, Literal

import matplotlib
import numpy as np
from matplotlib import font_manager
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from equipoise.i18n import to_say

Kind = Literal["svg", "png", "pdf"]

INK, LINES, FAINT, PALE = "#1a1a1a", "#595959", "#a6a6a6", "#d9d9d9"
MAIN, STRESS = "#0060a8", "#c8500a"
"""Blue and vermilion keep apart for the colour-blind; in grey, width and dashes tell them apart."""
SOIL, STUBBLE, EARTH = "#efe4d2", "#dccbb0", "#7a5c33"
"""Below the surface: fill, hatching, and the surface itself."""

SMALL, NORMAL, LARGE = 7.5, 8.5, 10.5
"""Sizes of type, points."""
SMALLEST = 7.0
"""Points: long headings are set so small before they are cut."""
LAST = 12
"""Signs of a word that is left out as a whole, where a text is cut in it."""

MARKS = {
    "pick-up": "D",
    "entry": "v",
    "lowest": "o",
    "release": "s",
    "exit": "^",
}
"""Instant of a planting stroke -> marker."""
INSTANTS = {
    "pick-up": to_say("pick-up"),
    "entry": to_say("entry"),
    "lowest": to_say("lowest"),
    "release": to_say("release"),
    "exit": to_say("exit"),
}
"""The same in words."""

PARAMETERS: Any = {
    "font.size": NORMAL,
    "font.sans-serif": ["DejaVu Sans", "Verdana"],
    "axes.labelsize": NORMAL,
    "axes.edgecolor": LINES,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.7,
    "axes.titley": 1.0,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.limits": (-4, 5),
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.6,
    "lines.solid_joinstyle": "round",
    "hatch.linewidth": 0.5,
    "legend.frameon": False,
    "legend.fontsize": NORMAL,
    "text.color": INK,
    "text.parse_math": False,
    "xtick.labelsize": SMALL,
    "ytick.labelsize": SMALL,
    "xtick.color": LINES,
    "ytick.color": LINES,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "figure.dpi": 144,
    "savefig.dpi": "figure",
    "text.hinting": "no_hinting",
    "svg.hashsalt": "equipoise",
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
}
"""Texts stay texts in SVG and PDF; none of them is read as a formula."""

METADATA: dict[Kind, dict[str, None]] = {
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


def font_folder() -> str:
    """Where the fonts are that everybody has who has Matplotlib."""
    return f"{matplotlib.get_data_path()}/fonts/ttf"


@cache
def _families() -> list[str]:
    installed = {font.name for font in font_manager.fontManager.ttflist}
    return ["DejaVu Sans", *(name for name in OTHER_SCRIPTS if name in installed), "sans-serif"]


_drawing = RLock()
_styled = False


@contextmanager
def styled() -> Iterator[None]:
    """Everything inside looks the same whatever the user's Matplotlib is set to.

    Matplotlib's settings belong to the whole process, so one thread draws at a time.
    """
    global _styled  # noqa: PLW0603  guarded by the lock
    with _drawing:
        if _styled:
            yield
            return
        _styled = True
        try:
            with _style():
                yield
        finally:
            _styled = False


@contextmanager
def _style() -> Iterator[None]:
    with matplotlib.rc_context(), warnings.catch_warnings():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(PARAMETERS)
        matplotlib.rcParams["font.family"] = _families()
        warnings.filterwarnings("ignore", r"Glyph \d+ .*missing from", UserWarning)
        yield


def blank(width: float, height: float) -> Figure:
    """A picture of so many inches, on which texts can be measured."""
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure


def render(figure: Figure, kind: Kind) -> bytes:
    """The picture as a file; the same bytes for the same figure."""
    file = BytesIO()
    with styled():
        figure.savefig(file, format=kind, metadata=METADATA[kind])
    return file.getvalue()


def heading(figure: Figure, title: str, what: str, left: float, right: float = 0.15) -> None:
    """Two lines at the top: the machine, and what is shown; margins in inches."""
    width, height = figure.get_size_inches()
    lines = ((title, 0.10, LARGE, "bold"), (what, 0.31, NORMAL, "normal"))
    for words, below, size, weight in lines:
        text = figure.text(
            left / width, 1 - below / height, words, fontsize=size, fontweight=weight, va="top"
        )
        fit(text, width - left - right, SMALLEST / size)


def fit(text: Any, room: float, least: float = 1.0) -> None:
    """Shorten a text to some inches.

    least : share of its size of type down to which it is shrunk before that.
    """
    wide = inches(text)[0]
    if wide > room and least < 1:
        text.set_fontsize(text.get_fontsize() * max(least, 0.99 * room / wide))
    words = text.get_text()
    while words and inches(text)[0] > room:
        words = words[: max(0, min(len(words) - 1, int(len(words) * room / inches(text)[0])))]
        whole = words.rpartition(" ")[0] if " " in words[-LAST:] else words
        text.set_text(f"{whole.rstrip()}\N{HORIZONTAL ELLIPSIS}")


def inches(text: Any) -> tuple[float, float]:
    """Width and height of a text."""
    box = text.get_window_extent()
    return box.width / text.figure.dpi, box.height / text.figure.dpi


def shown(value: float) -> str:
    """Four significant digits, with a true minus."""
    return f"{value:.4g}".replace("-", "\N{MINUS SIGN}")


def degrees_shown(angle: float) -> str:
    """An angle in rad as degrees."""
    return f"{np.degrees(angle):.1f}°".replace("-", "\N{MINUS SIGN}")


def short(name: str, most: int = 24) -> str:
    """A name that may be long."""
    return name if len(name) <= most else f"{name[: most - 1]}\N{HORIZONTAL ELLIPSIS}"


def free_name(name: str, taken: Iterable[str]) -> str:
    """A name that is none yet, of signs that every file system takes."""
    name = "".join("_" if sign in '/\\:*?"<>|' else sign for sign in name)[:60].rstrip(". ")
    number = 1
    while (f"{name}-{number}" if number > 1 else name).lower() in map(str.lower, taken):
        number += 1
    return f"{name}-{number}" if number > 1 else name


WIDTH, LEFT, RIGHT = 7.2, 0.86, 0.2
"""Inches: width of a picture, and its margins."""


def place(figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Axes at a place of the picture, all in inches."""
    across, up = figure.get_size_inches()
    axes = figure.add_axes((left / across, bottom / up, width / across, height / up))
    # At the left stand the titles.
    axes.yaxis.set_offset_position("right")
    return axes


def legend(figure: Figure, handles: Sequence[Any]) -> None:
    """What the lines are, below the heading at the left."""
    if not handles:
        return
    width, height = figure.get_size_inches()
    figure.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(LEFT / width, 1 - 0.49 / height),
        ncols=len(handles),
        borderaxespad=0,
        borderpad=0,
    )
