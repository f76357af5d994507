"""Script and style of the page, as they have been built."""

from __future__ import annotations

from importlib.resources import files

from equipoise.errors import UsageError

TYPES = {"equipoise.js": "text/javascript", "equipoise.css": "text/css"}
"""Everything that there is, with its type."""
MAKE = (
    "the page has not been built; run `make page`, or `pip install -e .` where Node or a network "
    "is at hand"
)


def assets() -> dict[str, bytes]:
    """Script and style of the page, by name.

    Raises
    ------
    UsageError : they have not been built.
    """
    folder = files("equipoise.web") / "static"
    try:
        return {name: (folder / name).read_bytes() for name in TYPES}
    except OSError:
        raise UsageError(MAKE) from None
