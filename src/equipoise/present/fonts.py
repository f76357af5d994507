"""Fonts of a PDF: which there are on this computer for a language, and what none of them has."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from equipoise.errors import EquipoiseError, UsageError
from equipoise.i18n import Note
from equipoise.i18n.languages import KNOWN

if TYPE_CHECKING:
    import typst

LATIN = "DejaVu Sans"
"""The font of Western letters, which comes with Matplotlib: pages end alike on every computer."""
NO_TYPST = Note('a PDF needs Typst; install it by: pip install "equipoise[report]"')
LAST_WESTERN = "\u2e7f"
"""Signs after it are letters of East Asia, which not every computer has."""


def check_pdf(language: str) -> None:
    """Tell what is missing before anything is computed."""
    families(language)


@cache
def installed() -> typst.Fonts:
    """All that this computer has, and those of Matplotlib."""
    try:
        import typst
    except ImportError as error:
        raise EquipoiseError(NO_TYPST) from error
    from equipoise.figures.paint import font_folder

    return typst.Fonts(font_paths=[font_folder()])


def families(language: str) -> list[str]:
    """Fonts that are there for a language, the best first."""
    there = set(installed().families())
    wanted = {code: item.fonts for code, item in KNOWN.items() if item.fonts}
    eastern = {code: [name for name in names if name in there] for code, names in wanted.items()}
    if language in eastern and not eastern[language]:
        raise UsageError(
            Note(
                "this computer has no font with {languages} letters, so that a PDF would "
                "show boxes; install one, such as {eastern} (fonts-noto-cjk), or write "
                "the report as .html",
                languages=KNOWN[language].name,
                eastern=wanted[language][0],
            )
        )
    order = sorted(eastern, key=lambda code: code != language)
    return [LATIN, *(name for code in order for name in eastern[code])]


def boxes(text: str) -> str:
    """Letters of East Asia in a text that no font of this computer has, each once."""
    from equipoise.figures.paint import fonts_for

    signs = frozenset(sign for sign in text if sign > LAST_WESTERN)
    return fonts_for(signs)[1] if signs else ""
