"""How what charts are made of looks: colours, widths, dashes and signs by role."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from equipoise.dataclass import dataclass
from equipoise.i18n import without_middle
from equipoise.symbols.looks import LIGHT

INK, LINES, FAINT, PALE = (LIGHT[name] for name in ("ink", "lines", "faint", "pale"))
MAIN, STRESS, PAPER = (LIGHT[name] for name in ("main", "stress", "paper"))
SOIL, EARTH = (LIGHT[name] for name in ("soil", "earth"))
"""As symbols have them."""
THIN = "#8c8c8c"
"""Of a line on a strong one: as pale as it can be on paper."""
GRID, STUBBLE = "#e6e6e6", "#dccbb0"
"""Of charts alone: behind their curves, and the hatching below the surface."""
QUIET, LOUD, STRETCH = "#ededed", "#d3d3d3", "#e9b79b"
"""Of bands of speeds to keep away from, and of stretches in which a limit is broken."""

SMALL, NORMAL, LARGE = 7.5, 8.5, 10.5
"""Sizes of type, points."""


@dataclass(frozen=True)
class DrawingStyle:
    """How something is drawn.

    dashes : lengths over the width.  sign : a marker, as Matplotlib calls it, of so many points.
    hollow : whether the sign is white inside.  fill : of an area, with so much opacity.
    spaced : whether only a few places of a curve have the sign.  order : what is higher lies above.
    words : colour of words about it, where its own is too pale for them.
    """

    color: str = MAIN
    width: float = 1.6
    dashes: tuple[float, ...] = ()
    sign: str = ""
    size: float = 4.0
    hollow: bool = False
    fill: str = ""
    opacity: float = 1.0
    spaced: bool = False
    order: float = 3.0
    words: str = ""

    @property
    def ink(self) -> str:
        """Colour of words about it."""
        return self.words or self.color or LINES

    @property
    def inside(self) -> str:
        """Colour of what it fills: a sign, a bar, a patch."""
        return self.fill or ("#ffffff" if self.hollow else self.color)

    @property
    def lengths(self) -> tuple[float, ...]:
        """Of its dashes, points."""
        return tuple(max(self.width, 0.8) * dash for dash in self.dashes)


LONG, MEDIUM, DOTS, DOT_DASH = (5.0, 2.0), (4.0, 2.0), (1.5, 1.5), (5.0, 2.0, 1.0, 2.0)
KINDS = (
    (MAIN, "o"),
    (STRESS, "s"),
    (INK, "^"),
    ("#008a6a", "D"),
    ("#a3478f", "v"),
    ("#8a6d00", "P"),
)
"""Colour and sign of several curves; any further curves are thin."""

POINTS, DIM = "#6b9fc9", "#c4c4c4"
"""Of what is many, and of that of it which is not wanted; in grey one is lighter."""

LOOKS: dict[str, DrawingStyle] = {
    "main": DrawingStyle(),
    "ink": DrawingStyle(INK),
    "lines": DrawingStyle(LINES, 0.9),
    "strong": DrawingStyle(INK, 1.8),
    "dashed ink": DrawingStyle(INK, 1.2, (4.0, 2.0)),
    "stress": DrawingStyle(STRESS, 1.8, order=3.4),
    "faint": DrawingStyle(FAINT, 0.9, order=2),
    "thin": DrawingStyle(MAIN, 1.0),
    "zero": DrawingStyle(FAINT, 0.8, order=1),
    # rows, and before and after: the thin line lies on the strong one, and is lighter, so that both
    # are seen in grey too where they are one; so are their dots
    "one": DrawingStyle(THIN, 1.0, hollow=True, order=3.1, words=LINES),
    "all": DrawingStyle(MAIN, 2.2),
    "before": DrawingStyle(THIN, 1.0, hollow=True, order=3.1, words=LINES),
    "after": DrawingStyle(MAIN, 2.2),
    "unchanged": DrawingStyle(LINES, 1.3),
    "bar before": DrawingStyle(LINES, fill=FAINT),
    "bar after": DrawingStyle(MAIN, fill=MAIN),
    # several signals of one quantity
    "several 1": DrawingStyle(MAIN),
    "several 2": DrawingStyle(STRESS, dashes=(5, 1.6)),
    "several 3": DrawingStyle(INK, dashes=(6, 1.6, 1.2, 1.6)),
    "several 4": DrawingStyle(EARTH, dashes=(1.3, 1.1)),
    "several 5": DrawingStyle(LINES, dashes=(10, 3)),
    "several 6": DrawingStyle(POINTS),
    "several 7": DrawingStyle("#008a6a", dashes=(4, 1.4, 1, 1.4, 1, 1.4)),
    "several 8": DrawingStyle("#a3478f", dashes=(2.4, 1.6)),
    "several 9": DrawingStyle("#8a6d00", dashes=(12, 2, 3, 2)),
    "several 10": DrawingStyle(INK, 0.9),
    "air": DrawingStyle(LINES, dashes=(4, 1.6)),
    "soil signal": DrawingStyle(STRESS),
    # lines and shades
    "mean": DrawingStyle(LINES, 0.9, LONG, order=2),
    "entry": DrawingStyle(LINES, 0.9, LONG, order=2),
    "lowest": DrawingStyle(LINES, 0.9, DOT_DASH, order=2),
    "exit": DrawingStyle(LINES, 0.9, DOTS, order=2),
    "soil": DrawingStyle("", fill=SOIL, order=0.1),
    "off": DrawingStyle("", fill=PALE, order=0.1),
    "forbidden": DrawingStyle("", fill=PALE, opacity=0.55, order=0.1),
    "quiet band": DrawingStyle("", fill=QUIET, order=0.1),
    "loud band": DrawingStyle("", fill=LOUD, order=0.2),
    "loud": DrawingStyle(LINES, 0.8, MEDIUM, order=1.5),
    "quiet": DrawingStyle(FAINT, 0.5, (1.5, 2), order=1.4),
    "natural": DrawingStyle(FAINT, 0.8, (1.5, 2), order=1.5),
    "not stable": DrawingStyle(INK, 1.5, (2.2, 1.3)),
    "work": DrawingStyle(LINES, 0.9, DOT_DASH, order=1.7),
    "station line": DrawingStyle(FAINT, 0.6, order=1),
    "action": DrawingStyle(INK, 1.2, (1, 2.4), order=2.2),
    "limit": DrawingStyle(INK, 1.6, (1, 1), order=2.2),
    "action value": DrawingStyle(LINES, 1.0, (3.7, 1.6), order=2),
    "limit value": DrawingStyle(LINES, 1.0, order=2),
    "now": DrawingStyle(INK, 1.0, DOTS, order=2),
    # modes and orders
    "mode": DrawingStyle(MAIN, 1.4),
    "order": DrawingStyle(LINES, 0.8, order=2),
    "meeting": DrawingStyle(STRESS, 1.3, sign="o", size=7, hollow=True, order=4),
    "shape": DrawingStyle(MAIN, 1.5),
    "other end": DrawingStyle(FAINT, 1.0, MEDIUM, order=2),
    "node": DrawingStyle(STRESS, 1.4, sign="x", size=5, order=5),
    "hand": DrawingStyle(LINES, 1.0, sign="s", size=4.5, order=4, fill=INK),
    "harness or ground": DrawingStyle(LINES, 1.0, sign="^", size=5, hollow=True, order=4),
    "station": DrawingStyle(LINES, 1.0, sign="o", size=4.5, hollow=True, order=4),
    "quiet speed": DrawingStyle(LINES, 1.0, sign="v", size=5.5, order=5),
    # clouds
    "kept": DrawingStyle(POINTS, 0.0, sign=".", size=2.4, order=2.2),
    "beyond": DrawingStyle(DIM, 0.0, sign=".", size=1.7, order=2.1),
    "failed": DrawingStyle(INK, 0.0, sign="x", size=3.0, order=2.3),
    "kept line": DrawingStyle(POINTS, 0.5, order=2.2),
    "beyond line": DrawingStyle(DIM, 0.5, order=2.1),
    "design": DrawingStyle(STRESS, 0.0, sign="o", size=4.5, order=4.2),
    "design line": DrawingStyle(STRESS, 1.3, order=3.3),
    "front": DrawingStyle(STRESS, 1.0, order=4.1),
    "rule": DrawingStyle(INK, 0.9, order=3.6),
    "own line": DrawingStyle(INK, 1.5, MEDIUM, order=3.4),
    "own": DrawingStyle(INK, 1.0, sign="D", size=6.5, hollow=True, order=4),
    "best": DrawingStyle(MAIN, 1.6, sign="o", size=4.5),
    "least": DrawingStyle(STRESS, 1.0, sign="P", size=9, order=6),
    "model": DrawingStyle(INK, 1.2, order=4),
    "bound": DrawingStyle(STRESS, 1.6, (4, 1.6), order=4),
    "machines": DrawingStyle(MAIN, fill=MAIN),
    "outside": DrawingStyle(FAINT, fill=FAINT),
    "part": DrawingStyle(MAIN, fill=MAIN, order=3.2),
    "whole": DrawingStyle(FAINT, fill=FAINT, order=2),
    "interval": DrawingStyle(INK, 0.9, order=4),
    "samples": DrawingStyle(FAINT, 0.0, sign=".", size=2.2, order=2),
    "fit": DrawingStyle(MAIN, 0.9),
    "turning": DrawingStyle(STRESS, 1.0, sign="o", size=4, hollow=True, order=4),
    "zeros": DrawingStyle(STRESS, 1.0, sign="o", size=5, hollow=True, order=4),
    "even": DrawingStyle(LINES, 0.8, MEDIUM, order=1),
    "task": DrawingStyle(MAIN, 1.0, sign="o", size=5, hollow=True, order=5),
    "day": DrawingStyle(INK, 1.6, sign="D", size=5, order=6),
    "broken": DrawingStyle(STRESS, 3.0, sign="x", size=8, order=6),
    "warned": DrawingStyle(EARTH, 1.6, sign="^", size=7, order=6),
    "broken stretch": DrawingStyle(STRETCH, 6.0, order=2.5),
    "unweighted": DrawingStyle(LINES, 0.9),
    "weighted": DrawingStyle(MAIN, 1.9, order=3.1),
    "dial": DrawingStyle(FAINT, 0.8, order=1),
    "stand": DrawingStyle(LINES, 0.9, sign="stand", size=10, hollow=True, order=2.5),
    "point": DrawingStyle(MAIN, 1.0, sign="o", size=2.6),
    "pivot": DrawingStyle(LINES, 1.0, sign="o", size=3),
    "point path": DrawingStyle(POINTS, 0.8, order=1.2),
    "path in soil": DrawingStyle(STRESS, 2.8, order=3.1),
    "other unit": DrawingStyle(FAINT, 0.9, MEDIUM, order=2),
    "tick": DrawingStyle(MAIN, 0.6, order=2.9),
    "dimension": DrawingStyle(INK, 0.7, order=4),
    "crossing": DrawingStyle(INK, 1.2, sign="x", size=5, order=4),
    "room": DrawingStyle(LINES, 0.9, (5.5, 3.3), order=2.3),
    "gear": DrawingStyle(STRESS, 0.9, (9.0, 2.2, 1.7, 2.2), order=2.3),
    "added mass": DrawingStyle(MAIN, 1.0, fill=MAIN, opacity=0.45, order=3.1),
    "arm": DrawingStyle(LINES, 0.7, order=2.4),
    "point mass": DrawingStyle(MAIN, 1.0, sign="o", size=7.5, order=3.4),
    "move": DrawingStyle(STRESS, 1.4, sign="o", size=4.5, order=3.6),
    "old center": DrawingStyle(STRESS, 1.0, sign="o", size=4.5, hollow=True, order=3.6),
    "swing": DrawingStyle(MAIN, 1.5, order=1.2),
    "other swing": DrawingStyle(STRESS, 1.5, MEDIUM, order=1.2),
    "gauge way": DrawingStyle(INK, 0.9, order=1.25),
    "mean size": DrawingStyle(LINES, 0.9, LONG, order=2),
}
"""Role -> look."""
LOOKS |= {
    f"quiet speed {number}": replace(LOOKS["quiet speed"], color=color)
    for number, (color, _) in enumerate(KINDS)
}
KIND = DrawingStyle(width=1.5, size=4.5, hollow=True, spaced=True)
LOOKS |= {
    f"kind {number}": replace(KIND, color=color, sign=sign, order=round(3.9 - 0.1 * number, 1))
    for number, (color, sign) in enumerate(KINDS)
}
LOOKS |= {
    f"cycles {number}": DrawingStyle(color, 1.0, sign=sign, size=4.5, order=4.1)
    for number, (color, sign) in enumerate(KINDS)
}
LOOKS |= {
    f"instant {name}": DrawingStyle(INK, 1.1, sign=sign, size=5, hollow=True, order=4)
    for name, sign in zip(
        ("pick-up", "entry", "lowest", "release", "exit"), ("D", "v", "o", "s", "^"), strict=True
    )
}
SEVERAL = sum(role.startswith("several ") for role in LOOKS)
"""Signals of one quantity with looks of their own; further signals repeat the looks."""
LOOKS["quieter"] = DrawingStyle(FAINT, 0.7, order=2.5)


def mixed(color: str, share: float) -> str:
    """So much of a colour on white."""
    parts = (int(color[k : k + 2], 16) for k in (1, 3, 5))
    return "#" + "".join(f"{round(255 + share * (part - 255)):02x}" for part in parts)


def look_of(role: str, dashed: bool = False) -> DrawingStyle:
    """The look of a role, ``meeting 5.5`` of so many points; or the same, dashed."""
    name, _, size = role.rpartition(" ")
    if name == "meeting":
        return replace(LOOKS[name], size=float(size))
    if name == "several":
        role = f"several {(int(size) - 1) % SEVERAL + 1}"
    look = LOOKS[role]
    return replace(look, dashes=MEDIUM) if dashed else look


def short(name: str, most: int = 24) -> str:
    """A name that may be long."""
    return without_middle(name, most)


def free_name(name: str, taken: Iterable[str]) -> str:
    """A name that is none yet, of signs that every file system takes."""
    name = "".join("_" if sign in '/\\:*?"<>|' else sign for sign in name)[:60].rstrip(". ")
    number = 1
    while (f"{name}-{number}" if number > 1 else name).lower() in map(str.lower, taken):
        number += 1
    return f"{name}-{number}" if number > 1 else name
