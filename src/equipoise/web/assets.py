"""Script and style of the page, as they have been built."""

from __future__ import annotations

import sys
from importlib.resources import files

from equipoise.errors import UsageError
from equipoise.i18n import Note

TYPES = {"equipoise.js": "text/javascript", "equipoise.css": "text/css"}
"""Everything that there is, with its type."""
MAKE = Note(
    "the page has not been built; run `make page`, or `pip install -e .` "
    "where Node or a network is at hand"
)


def assets() -> dict[str, bytes]:
    """Script and style of the page, by name.

    Raises
    ------
    UsageError : they have not been built.
    """
    return {name: asset(name).encode() for name in TYPES}


def asset(name: str) -> str:
    """One of the files that have been built.

    Raises
    ------
    UsageError : it has not been built.
    """
    try:
        return (files("equipoise.web") / "static" / name).read_text(encoding="utf-8")
    except OSError:
        if sys.platform == "emscripten":  # a site has it beside the page, and not once more here
            from pyodide.http import open_url  # type: ignore[import-not-found]

            return str(open_url(name).read())
        raise UsageError(MAKE) from None
