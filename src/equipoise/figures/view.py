"""A panel with its place on a sheet, and what everything in it is drawn with."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from equipoise.figures.metrics import DOWN, UP
from equipoise.figures.scales import Scale, Ticks, ticks_of
from equipoise.figures.sheet import Anchor, Box, Sheet, Stroke, Words
from equipoise.figures.style import INK, SMALL, Look
from equipoise.figures.texts import Labels
from equipoise.results.charts import Panel

Array = np.ndarray[Any, Any]
MIDDLE = (UP - DOWN) / 2
"""Of a text's height, from its base line, over its size."""


@dataclass(frozen=True, eq=False)
class View:
    """A panel with its place on a sheet."""

    panel: Panel
    x: Scale
    y: Scale
    sheet: Sheet

    @property
    def box(self) -> Box:
        """Left, top, right, bottom of the axes."""
        return self.x.start, self.y.end, self.x.end, self.y.start

    @cached_property
    def labels(self) -> Labels:
        """Texts inside of them."""
        return Labels(self.sheet, self.box)

    @cached_property
    def ticks(self) -> tuple[Ticks, Ticks]:
        """Numbers on both axes."""
        return ticks_of(self.x), ticks_of(self.y, upright=True)

    def places(self, x: Any, y: Any) -> Array:
        """Places (N, 2) on the sheet of values in SI units."""
        return np.column_stack(np.broadcast_arrays(self.x.at(x), self.y.at(y)))

    def line(self, places: Array, look: Look, order: float | None = None) -> None:
        """A line (N, 2) on the sheet, not clipped."""
        dashes = tuple(max(look.width, 0.8) * dash for dash in look.dashes)
        stroke = Stroke((places,), look.color, look.width, dashes)
        self.sheet.add(stroke, look.order if order is None else order)

    def area(self, places: Array, look: Look, order: float | None = None) -> None:
        """A filled area (N, 2), cut at the axes."""
        stroke = Stroke((places,), fill=look.fill, opacity=look.opacity, closed=True, clip=self.box)
        self.sheet.add(stroke, look.order if order is None else order)

    def write(self, x: float, y: float, text: str, anchor: Anchor = "start", **rest: Any) -> None:
        """A text that stands where it must; y is the middle of its height."""
        size = rest.pop("size", SMALL)
        words = Words(x, y + MIDDLE * size, text, size, rest.pop("color", INK), anchor, **rest)
        self.sheet.add(words, 7.0)


def corners_of(box: Box) -> Array:
    """The corners (4, 2) of a box."""
    left, top, right, bottom = box
    return np.array([(left, top), (right, top), (right, bottom), (left, bottom)])
