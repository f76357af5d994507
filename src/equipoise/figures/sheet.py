"""What a picture is made of before it is written: lines, signs and words at places of a sheet.

All lengths are points (1/72 inch), from the upper left corner, y downward.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

Array = np.ndarray[Any, Any]
Box = tuple[float, float, float, float]
"""Left, top, right, bottom."""
Anchor = Literal["start", "middle", "end"]


@dataclass(frozen=True, eq=False)
class Stroke:
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
class Signs:
    """The same marker at some places (N, 2).

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


Item = Stroke | Signs | Words


@dataclass
class Sheet:
    """A picture: its size, and what is drawn on it, what is of a higher order later."""

    width: float
    height: float
    title: str = ""
    _items: list[tuple[float, Item]] = field(default_factory=list)

    def add(self, item: Item, order: float = 5.0) -> None:
        """Draw something."""
        self._items.append((order, item))

    @property
    def items(self) -> list[Item]:
        """All of it in the order in which it is drawn."""
        return [item for _, item in sorted(self._items, key=lambda pair: pair[0])]

    @property
    def words(self) -> list[Words]:
        """Its texts."""
        return [item for item in self.items if isinstance(item, Words)]
