"""What a picture is made of before it is written: lines, signs and words at places of a sheet.

All lengths are points (1/72 inch), from the upper left corner, y downward.  Texts are measured
without drawing them, and put where they cover neither each other nor what is drawn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace
from textwrap import wrap
from typing import Any, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.style import FAINT, SMALL
from equipoise.signals import Array

Box = tuple[float, float, float, float]
"""Left, top, right, bottom."""
Anchor = Literal["start", "middle", "end"]


@dataclass(frozen=True, eq=False)
class CanvasStroke:
    """Lines, each (N, 2), open or closed, drawn and filled as one.

    color : of the line; none is drawn where empty.  fill : of the inside.
    clip : outside of which nothing is seen.  round : whether lines end in half circles.
    """

    lines: tuple[Array, ...]
    color: str = ""
    width: float = 1.0
    dashes: tuple[float, ...] = ()
    fill: str = ""
    opacity: float = 1.0
    closed: bool = False
    clip: Box | None = None
    round: bool = False


@dataclass(frozen=True, eq=False)
class Markers:
    """One marker drawn at some places (N, 2).

    shape : as Matplotlib calls it.  size : of its width, points.
    """

    places: Array
    shape: str
    size: float
    edge: str
    face: str
    width: float = 1.0
    clip: Box | None = None


@dataclass(frozen=True)
class Words:
    """A text on its base line.

    turned : whether it runs upward.  backed : whether it stands on a pale ground.
    """

    x: float
    y: float
    text: str
    size: float
    color: str
    anchor: Anchor = "start"
    bold: bool = False
    turned: bool = False
    backed: bool = False


SheetItem = CanvasStroke | Markers | Words


@dataclass
class Canvas:
    """A picture: its size, and what is drawn on it, what is of a higher order later."""

    width: float
    height: float
    title: str = ""
    _items: list[tuple[float, SheetItem]] = field(default_factory=list)

    def add(self, item: SheetItem, order: float = 5.0) -> None:
        """Draw something."""
        self._items.append((order, item))

    @property
    def items(self) -> list[SheetItem]:
        """All of it in the order in which it is drawn."""
        return [item for _, item in sorted(self._items, key=lambda pair: pair[0])]

    @property
    def words(self) -> list[Words]:
        """Texts of the sheet."""
        return [item for item in self.items if isinstance(item, Words)]


_WIDTHS = {
    0.28: "'ijlìíîïıł",
    0.3: "IJÌÍÎÏΙ",
    0.32: " ,.\u00a0·‘’",
    0.34: "/:;\\|¦ι",
    0.36: "f-",
    0.4: "()[]t!¡²³¹⁰⁴⁵⁶⁷⁸⁹",
    0.42: "rř",
    0.46: '"ªº',
    0.5: "*_`§¨¯°´¸–",
    0.53: "szśšźżž“”?¿⁻",
    0.55: "cçćčέεζ",
    0.57: "LŁΓνξFkκ",
    0.6: "vxyýÿγλςχPΡπτ•",
    0.62: "TYaoeèéêëęěÝàáâãäåāąòóôõöøőŸΤΥδθο«»",
    0.64: "ESbdghnpquÈÉÊËßñùúûüđğńňŚŞŠũūůűΕΞΣήηρσ$0123456789{}¢£¤¥µ¶βμ√",
    0.68: "KΚάαφψAVÀÁÂÃÄÅĄΑΔΛ",
    0.7: "BRXZŘŹŻŽΒΖΧCÇĆČ",
    0.75: "UÙÚÛÜŮŰHNÑŃŇΗΝΠΩ",
    0.79: "DGÐĎ&OQÒÓÔÕÖØŐΘΟΦΨ",
    0.84: "w∞#+<=>^~¬±×÷ω−≤≥→←≈MΜ",
    1.0: "%mæ@©®—…WŒœÆ¼½¾",
}
"""Over the size of type."""
_WIDTH = {sign: width for width, signs in _WIDTHS.items() for sign in signs}
_OTHER, _FULL, _EAST = 0.65, 1.0, 0x1100
"""Width of other signs, and of those of East Asia, which begin there."""
_BOLD = 1.12
UP, DOWN = 0.76, 0.22
"""Height above and depth below the base line, over the size of type."""
MIDDLE = (UP - DOWN) / 2
"""Of a text's height, from its base line, over its size."""
LEAST = 0.82
"""Share of its size to which a text is shrunk before it is cut."""
LAST = 12
"""Signs of a word that is left out as a whole, where a text is cut in it."""


def width_of(text: str, size: float, bold: bool = False) -> float:
    """Points."""
    ems = sum(
        _WIDTH[sign] if sign in _WIDTH else _FULL if ord(sign) >= _EAST else _OTHER for sign in text
    )
    return ems * size * (_BOLD if bold else 1.0)


def box_of(words: Words) -> Box:
    """Left, top, right and bottom of a text on its sheet."""
    wide = width_of(words.text, words.size, words.bold)
    before = {"start": 0.0, "middle": 0.5, "end": 1.0}[words.anchor] * wide
    up, down = UP * words.size, DOWN * words.size
    if words.turned:
        return words.x - up, words.y + before - wide, words.x + down, words.y + before
    return words.x - before, words.y - up, words.x - before + wide, words.y + down


def fitted(text: str, room: float, size: float, bold: bool = False) -> str:
    """A text cut to some points."""
    if width_of(text, size, bold) <= room:
        return text
    while text and width_of(text + "…", size, bold) > room:
        share = room / width_of(text + "…", size, bold)
        text = text[: max(0, min(len(text) - 1, int(len(text) * share)))]
    whole = text.rpartition(" ")[0] if " " in text[-LAST:] else text
    return f"{whole.rstrip()}…"


def set_in(text: str, room: float, size: float, bold: bool = False) -> tuple[str, float]:
    """A text and its size: shrunk a little, then cut, so that it fits into some points."""
    wide = width_of(text, size, bold)
    if wide > room:
        size *= max(LEAST, 0.99 * room / wide)
    return fitted(text, room, size, bold), size


def lines_of(text: str, room: float, size: float, bold: bool = False) -> list[str]:
    """A text in as few lines as fit into some points."""
    wide = width_of(text, size, bold)
    if not text or wide <= room:
        return [text] if text else []
    for count in range(max(int(len(text) * room / wide), 1) + LAST, 1, -1):
        lines = wrap(text, count)
        if all(width_of(line, size, bold) <= room for line in lines):
            return lines
    return [*text]


AROUND = tuple(range(0, 360, 30))
"""Directions, deg, in which a text may stand from its point."""
DISTANCES = (1.0, 2.0, 3.4, 5.2, 8.0)
"""How far it may stand away, over the nearest distance."""
TEXT_ON_TEXT, ON_POINT, FARTHER, TURNED, COVERED = 400.0, 1000.0, 8.0, 2.0, 3.0
"""Costs: of covering another text, or the text's own point, of a step away, of 30 deg off the
wish, of covering a piece of a line."""
PIECE, CLEAR, EDGE = 2.5, 1.5, 3.0
"""Points: length of the pieces of lines, room around texts, and their distance from the frame."""
INSIDE = 0.5
"""Weight of a place in an area, of which there is one in each square of two pieces."""
LINE = 1.25
"""Height of a line of several, over the size of type."""
HALF_PAGE = 300.0
"""Points: on a narrower sheet, as of half of a report's page, texts that would stand on others are
left out; tables have their numbers."""
ROUNDS = 5000
"""In which texts side by side push each other; as many as a paper full of them takes."""
ON_TOP, LEAD = 8.0, 4.0
"""Orders of texts, and of the lines that lead to them."""


@dataclass(frozen=True)
class CanvasText:
    """A text to be put beside a point, in lines.

    wish : direction (deg, against the clock) in which it stands best.  distance : least distance.
    optional : leave it out where there is no room.
    """

    text: str
    color: str
    wish: float = 90.0
    distance: float = 7.0
    optional: bool = False
    bold: bool = False
    size: float = SMALL


class Labels:
    """Texts inside a box of a sheet.

    sparse : whether a text is left out that would have to stand on another.
    """

    def __init__(self, sheet: Canvas, frame: Box, sparse: bool = False) -> None:
        self.sheet, self.sparse = sheet, sparse
        self.frame = np.array(frame)
        self.boxes = np.empty((0, 4))
        self._pieces: list[Array] = []
        self._weights: list[Array] = []

    def avoid(self, places: Array, weight: float = 1.0) -> None:
        """Keep texts away from a line (N, 2)."""
        places = places[np.all(np.isfinite(places), axis=1)]
        if not len(places):
            return
        steps = np.hypot(*np.diff(places, axis=0).T)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        count = int(min(along[-1] / PIECE, 4000)) + 2
        at = np.linspace(0.0, along[-1], count)
        self._pieces.append(np.column_stack([np.interp(at, along, part) for part in places.T]))
        self._weights.append(np.full(count, weight))

    def avoid_inside(self, lines: Sequence[Array]) -> None:
        """Keep texts off an area between closed lines (N, 2), where there is room beside it."""
        corners = np.concatenate([*lines])
        low, high = np.min(corners, axis=0), np.max(corners, axis=0)
        x, y = (np.arange(a + PIECE, b, 2 * PIECE) for a, b in zip(low, high, strict=True))
        places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        crossed = np.zeros(len(places), int)
        for line in lines:
            first, last = line, np.roll(line, -1, axis=0)
            for (x0, y0), (x1, y1) in zip(first.tolist(), last.tolist(), strict=True):
                if y0 != y1:
                    along = (places[:, 1] - y0) / (y1 - y0)
                    right = x0 + along * (x1 - x0) > places[:, 0]
                    crossed += (along >= 0) & (along < 1) & right
        inside = places[crossed % 2 == 1]
        self._pieces.append(inside)
        self._weights.append(np.full(len(inside), INSIDE))

    def reserve(self, x: float, y: float, half: float = 3.0) -> None:
        """Keep texts away from a marker, so many points around its middle."""
        self.occupy((x - half, y - half, x + half, y + half))

    def occupy(self, box: Box) -> None:
        """Keep texts out of a box."""
        self.boxes = np.vstack([self.boxes, box])

    def put(self, x: float, y: float, text: CanvasText) -> bool:
        """Write a text beside a point; whether there was room."""
        lines = text.text.split("\n")
        wide = max(width_of(line, text.size, text.bold) for line in lines)
        size = np.array([wide, text.size * (1 + LINE * (len(lines) - 1))])
        offsets, costs = self._choices(np.array([x, y]), size, text.wish, text.distance)
        best = int(np.argmin(costs))
        most = TEXT_ON_TEXT / 8 if text.optional else TEXT_ON_TEXT if self.sparse else np.inf
        if costs[best] >= most:
            return False
        middle = np.array([x, y]) + offsets[best]
        top = middle[1] - size[1] / 2
        style = Words(float(middle[0]), 0.0, "", text.size, text.color, "middle", text.bold)
        for number, line in enumerate(lines):
            base = float(top + text.size * (0.78 + LINE * number))
            self.sheet.add(replace(style, y=base, text=line, backed=True), ON_TOP)
        low, high = middle - size / 2, middle + size / 2
        self.occupy((low[0], low[1], high[0], high[1]))
        if np.hypot(*np.maximum(np.abs(offsets[best]) - size / 2, 0)) > 2.5 * text.distance:
            self._lead(np.array([x, y]), offsets[best], size)
        return True

    def _choices(self, at: Array, size: Array, wish: float, gap: float) -> tuple[Array, Array]:
        """Offsets (M, 2) of a text's middle from its point, and what each costs (M,)."""
        turned = np.radians(np.array([wish, *AROUND]))
        ways = np.column_stack([np.cos(turned), -np.sin(turned)])
        support = np.abs(ways) @ size / 2
        offsets = np.concatenate([ways * (gap * far + support)[:, None] for far in DISTANCES])
        bend = np.degrees(np.abs(np.angle(np.exp(1j * (turned - turned[0]))))) / 30
        costs = np.concatenate([TURNED * bend + FARTHER * step for step in range(len(DISTANCES))])
        least, most = self.frame[:2] + size / 2 + EDGE, self.frame[2:] - size / 2 - EDGE
        offsets = np.clip(at + offsets, least, np.maximum(most, least)) - at
        low, high = at + offsets - size / 2 - CLEAR, at + offsets + size / 2 + CLEAR
        apart = (self.boxes[:, None, :2] >= high) | (self.boxes[:, None, 2:] <= low)
        costs += TEXT_ON_TEXT * np.sum(~np.any(apart, axis=2), axis=0)
        costs += COVERED * self._covered(low, high)
        on_point = np.all(np.abs(offsets) < size / 2 + gap / 2, axis=1)
        return offsets, costs + ON_POINT * on_point

    def _covered(self, low: Array, high: Array) -> Any:
        """Weight of the pieces of lines in boxes, (M,)."""
        if not self._pieces:
            return 0.0
        if len(self._pieces) > 1:
            self._pieces = [np.concatenate(self._pieces)]
            self._weights = [np.concatenate(self._weights)]
        pieces, weights = self._pieces[0], self._weights[0]
        overlapping = np.all(
            (pieces >= np.min(low, axis=0)) & (pieces <= np.max(high, axis=0)), axis=1
        )
        pieces = pieces[overlapping]
        inside = (pieces[:, None] >= low) & (pieces[:, None] <= high)
        return weights[overlapping] @ np.all(inside, axis=2)

    def _lead(self, at: Array, offset: Array, size: Array) -> None:
        """A thin line from a point to the nearest place of its text's box."""
        corner = np.clip(0.0, offset - size / 2, offset + size / 2)
        far = float(np.hypot(*corner)) or 1.0
        ends = np.array([at + corner * min(2 / far, 1.0), at + corner * max(1 - 3 / far, 0.0)])
        self.sheet.add(CanvasStroke((ends,), FAINT, 0.6), LEAD)


def spread(middles: Sequence[float], widths: Sequence[float], low: float, high: float) -> Array:
    """Middles of texts side by side, moved as little as keeps them apart and between two ends."""
    order = np.argsort(middles, kind="stable")
    half = np.array(widths, float)[order] / 2
    gaps = half[1:] + half[:-1]
    placed = np.array(middles, dtype=float)[order]
    for _ in range(ROUNDS):
        lack = gaps - np.diff(placed)
        if np.all(lack <= 1e-9) and np.all(placed >= low + half) and np.all(placed <= high - half):
            break
        push = np.maximum(lack, 0) / 2
        placed[:-1] -= push
        placed[1:] += push
        placed = np.clip(placed, low + half, high - half)
    result = np.empty_like(placed)
    result[order] = placed
    return result
