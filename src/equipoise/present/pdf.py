"""A report as PDF, set by Typst: the same document as the page, on A4."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING

import jinja2

import equipoise
from equipoise.errors import EquipoiseError, UsageError
from equipoise.i18n import LANGUAGES, say, speaking
from equipoise.present.cells import noted, printed
from equipoise.present.document import Document
from equipoise.present.html import printed_grid, text_of

if TYPE_CHECKING:
    import typst

LATIN = ("Noto Sans", "Liberation Sans", "Arial", "Helvetica Neue", "DejaVu Sans")
"""Fonts of Western letters, the first that is there; the last comes with Matplotlib."""
EASTERN = {
    "ja": ("Noto Sans CJK JP", "Noto Sans JP", "Hiragino Sans", "Yu Gothic", "Source Han Sans"),
    "ko": ("Noto Sans CJK KR", "Noto Sans KR", "Apple SD Gothic Neo", "Malgun Gothic"),
}
MORE_EASTERN = {
    "ja": ("Meiryo", "MS Gothic", "IPAexGothic", "IPAGothic", "TakaoGothic", "VL Gothic"),
    "ko": ("NanumGothic", "Nanum Gothic", "UnDotum", "Baekmuk Dotum", "Source Han Sans K"),
}
SHRUNK, PAGE, HALF = 0.8, 504.0, 338.0
"""Width of a picture over how it is drawn; points between the margins; height that fits twice."""
LEAST = 0.7
"""Scale below which its letters would be too small to read."""
NO_TYPST = 'a PDF needs Typst; install it by: pip install "equipoise[report]"'


def check_pdf(language: str) -> None:
    """Tell what is missing before anything is computed."""
    _families(language)


def pdf(document: Document) -> bytes:
    """A document as PDF."""
    import typst

    families = _families(document.language)
    with speaking(document.language):
        labels = {
            "summary": say("Summary"),
            "made": say("Made by Equipoise {version}", version=equipoise.__version__),
        }
    source = _template().render(document=document, labels=labels, families=families)
    try:
        made = typst.compile(source.encode(), font_paths=_fonts(), format="pdf", timestamp=0)
    except typst.TypstError as error:
        raise EquipoiseError(f"the PDF could not be set ({error})") from error
    assert isinstance(made, bytes)
    return made


@cache
def _fonts() -> typst.Fonts:
    """All that this computer has, and those of Matplotlib."""
    try:
        import typst
    except ImportError as error:
        raise EquipoiseError(NO_TYPST) from error
    from equipoise.figures.paint import font_folder

    return typst.Fonts(font_paths=[font_folder()])


def _families(language: str) -> list[str]:
    """Fonts that are there for a language, the best first."""
    there = set(_fonts().families())
    wanted = {code: (*EASTERN[code], *MORE_EASTERN[code]) for code in EASTERN}
    eastern = {code: [name for name in names if name in there] for code, names in wanted.items()}
    if language in eastern and not eastern[language]:
        raise UsageError(
            f"this computer has no font with {LANGUAGES[language]} letters, so that a PDF would "
            f"show boxes; install one, such as {EASTERN[language][0]} (fonts-noto-cjk), or write "
            "the report as .html"
        )
    order = sorted(eastern, key=lambda code: code != language)
    latin = next(name for name in LATIN if name in there)
    return [latin, *(name for code in order for name in eastern[code]), "DejaVu Sans"]


@cache
def _template() -> jinja2.Template:
    environment = jinja2.Environment(autoescape=False, trim_blocks=True, lstrip_blocks=True)
    environment.filters["text"] = _text
    environment.filters["grid"] = printed_grid
    environment.filters["printed"] = printed
    environment.filters["noted"] = noted
    environment.filters["width"] = _width
    return environment.from_string(text_of("report.typ.j2"))


def _width(svg: str) -> str:
    """Width of a picture on paper, where it is a little smaller than drawn."""
    size = re.search(r'viewBox="0 0 ([0-9.]+) ([0-9.]+)"', svg)
    if size is None:
        return "100%"
    width, height = map(float, size.groups())
    return f"{min(width * min(SHRUNK, max(HALF / height, LEAST)), PAGE):.1f}pt"


def _text(value: str) -> str:
    """A text as Typst has it between quotation marks, so that no sign of it is a command."""
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
