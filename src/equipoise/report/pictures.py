"""Every picture of what can be told of a file: its name, where it belongs, and how to draw it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from equipoise.report.findings import Findings, ToolFindings

if TYPE_CHECKING:
    from equipoise.figures import Picture as Drawn

SECTIONS = ("motion", "planting", "forces", "joints", "vibration", "modes", "balance", "tool")
"""In the order in which they are shown."""


@dataclass(frozen=True)
class Picture:
    """A picture that is drawn when it is wanted.

    name : which also does for a file.  section : one of `SECTIONS`.
    caption : an English sentence, to be said when it is shown.
    """

    name: str
    section: str
    caption: str
    draw: Callable[[], Drawn]


def pictures(found: Findings | ToolFindings, at: Sequence[float] | None = None) -> list[Picture]:
    """All of them, in the order of `SECTIONS`.

    at : crank angles at which the linkage is drawn, rad; usual ones if None.
    """
    return list(each(found, at))


def each(
    found: Findings | ToolFindings,
    at: Sequence[float] | None = None,
    sections: Collection[str] = SECTIONS,
) -> Iterator[Picture]:
    """Those of some sections one by one: what only later ones need is not computed before."""
    from equipoise.figures.style import free_name
    from equipoise.report.shown import of_linkage
    from equipoise.report.shown_tool import of_tool

    parts = of_tool(found) if isinstance(found, ToolFindings) else of_linkage(found, at)
    taken: dict[str, None] = {}
    for section, entries in parts:
        if section not in sections:
            continue
        for name, caption, draw in entries:
            own = free_name(name, taken)
            taken[own] = None
            yield Picture(own, section, caption, draw)
