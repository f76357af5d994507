"""Colours of pictures as properties of a page, which has others where it is dark."""

from __future__ import annotations

from equipoise.figures.style import DIM, GRID, LOUD, POINTS, QUIET, STRETCH, STUBBLE
from equipoise.symbols.looks import DARK, LIGHT

NAMES = {color: name for name, color in LIGHT.items()} | {
    GRID: "grid",
    STUBBLE: "stubble",
    QUIET: "quiet",
    LOUD: "loud",
    STRETCH: "stretch",
    POINTS: "points",
    DIM: "dim",
}
"""Colour of a picture -> name of the page's property that takes its place."""
DARK_ONLY = {
    "grid": "#2b3138",
    "soil": "#332c20",
    "stubble": "#57492f",
    "earth": "#c9a774",
    "quiet": "#22272d",
    "loud": "#343b43",
    "stretch": "#6e4631",
    "points": "#4f86b5",
    "dim": "#525a63",
}

PRINTED_STRESS = "#8c3200"
"""Colour of words on paper that have to be seen: as the same red of pictures, they would be paler
than other words where a page is printed in grey."""


def colored(color: str) -> str:
    """A colour of a picture as the page has it."""
    return f"var(--linkage-{NAMES[color]},{color})" if color in NAMES else color


def colors(dark: bool) -> str:
    """The properties of a page, as a style sheet has them."""
    chosen = {**DARK, **DARK_ONLY} if dark else {**LIGHT, **{v: k for k, v in NAMES.items()}}
    return ";".join(f"--linkage-{name}:{color}" for name, color in chosen.items())
