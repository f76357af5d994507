"""Texts of moving pictures: names where they are read best, and what is told below the machine."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import floor, log10
from typing import Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.stage import RULER, Stage, width_of
from equipoise.i18n import decimals
from equipoise.symbols.shapes import FOOT


@dataclass(frozen=True)
class Label:
    """A text that stands still.

    place : of its beginning, middle or end, as anchor says; the middle of its height.
    color : name in `symbols.looks.LIGHT`.  in_strip : whether it stands in the strip below, where
    that has several lines.
    """

    text: str
    place: complex
    anchor: Literal["start", "middle", "end"] = "middle"
    color: str = "ink"
    in_strip: bool = False

    def box(self, size: float) -> tuple[float, float, float, float]:
        """Left, top, right, bottom; about as wide as the text will be."""
        wide = width_of(self.text, size)
        left = self.place.real - {"start": 0.0, "middle": 0.5, "end": 1.0}[self.anchor] * wide
        return left, self.place.imag - 0.6 * size, left + wide, self.place.imag + 0.6 * size


def captions(stage: Stage, traced: tuple[str, ...]) -> tuple[Label, ...]:
    """Names of what stands still and of paths, each where it has room; then the strip below."""
    labels: list[Label] = []
    places = (*_of_pivots(stage), *_of_gauges(stage), *_of_paths(stage, traced))
    for choices in (*_strip(stage), *places):
        for size in (stage.size_where_narrow, stage.size_of_type):
            free = [choice for choice in choices if _fits(choice, labels, stage, size)]
            if free:
                break
        if free:
            labels.append(min(free, key=lambda item: _covered(item, stage)))
    return tuple(labels)


def _covered(label: Label, stage: Stage) -> int:
    """How often links pass over a text."""
    left, top, right, bottom = label.box(stage.size_of_type)
    x, y = stage.links.real, stage.links.imag
    return int(np.sum((left < x) & (x < right) & (top < y) & (y < bottom)))


def _fits(label: Label, others: list[Label], stage: Stage, size: float) -> bool:
    """Whether a text of so many pixels lies in the picture and on no other text."""
    left, top, right, bottom = label.box(size)
    if left < 0 or top < 0 or right > stage.width or bottom > stage.height:
        return False
    boxes = (other.box(size) for other in others)
    return not any(left < b[2] and b[0] < right and top < b[3] and b[1] < bottom for b in boxes)


def _strip(stage: Stage) -> Iterator[list[Label]]:
    """A length by which one can measure, and what is told, one above the other from the right."""
    right, length = ruler_ends(stage)[1], _ruler_length(stage)
    words = decimals(f"{1000 * length:g} mm" if length < 10 else f"{length:g} m")
    several = len(stage.lines) > 1
    yield [Label(words, right + 8 * stage.unit - 2j, "start", in_strip=several)]
    corner = complex(stage.width - 12 * stage.unit, right.imag - 2)
    for row, (words, color) in enumerate(stage.lines):
        place = corner - 1j * stage.row * row
        yield [Label(words, place, "end", color, several)] if words else []


def ruler_ends(stage: Stage) -> tuple[complex, complex]:
    left = complex(14 * stage.unit, stage.height - 12 * stage.unit)
    return left, left + _ruler_length(stage) * stage.scale


def _ruler_length(stage: Stage) -> float:
    """A round length, m, of a tenth to a fifth of the picture."""
    most = RULER * stage.width / stage.scale
    size = 10.0 ** floor(log10(most))
    return max(by * size for by in (1, 2, 5) if by * size <= most)


def _of_pivots(stage: Stage) -> Iterator[list[Label]]:
    side = 22 * stage.unit
    for name in stage.scene.standing:
        place = complex(stage.at(stage.scene.places[name][0]))
        way = stage.scene.ground(name).conjugate() * stage.unit
        yield [
            Label(name, place + (FOOT + 8) * way),
            Label(name, place + side + 10 * way, "start"),
            Label(name, place - side + 10 * way, "end"),
        ]


AROUND: tuple[tuple[complex, Literal["start", "middle", "end"]], ...] = (
    (1j, "middle"), (1, "start"), (-1, "end"), (1 + 1j, "start"), (-1 + 1j, "end"),
    (1 - 1j, "start"), (-1 - 1j, "end"), (-3j, "middle"),
)  # fmt: skip
"""Where a text stands from a sign, and which of its ends is there."""


def _of_gauges(stage: Stage) -> Iterator[list[Label]]:
    """Beside each place of gauges that is seen, nearer or farther."""
    carrier = stage.scene.carrier
    gauges = {} if carrier is None else carrier.named(carrier.support.gauges)
    for place, names in gauges.items():
        if stage.scene.shows(place):
            at, words = complex(stage.at(place)), ", ".join(names)
            yield [
                Label(words, at + off * stage.unit * way, anchor)
                for off, (way, anchor) in product((14, 32, 50), AROUND)
            ]


def _of_paths(stage: Stage, traced: tuple[str, ...]) -> Iterator[list[Label]]:
    """Beyond the ends of each path."""
    off = 14 * stage.unit
    for name in traced:
        path = stage.way(name)
        ends = (path.imag.argmin(), path.real.argmin(), path.real.argmax(), path.imag.argmax())
        top, left, right, bottom = (complex(path[k]) for k in ends)
        yield [
            Label(name, top - 1j * off, color="main"),
            Label(name, left - off, "end", "main"),
            Label(name, right + off, "start", "main"),
            Label(name, bottom + 1j * off, color="main"),
        ]
