"""Texts of a moving picture: names, the scale, the size of the force."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import floor, log10
from typing import Literal

import numpy as np

from equipoise.i18n import say
from equipoise.plotting.shapes import FOOT, Shape, line
from equipoise.plotting.stage import Stage
from equipoise.plotting.style import shown

SIZE, LEAST = 12.0, 11.0
"""Of type, in pixels: in a picture 640 pixels wide, and in small ones."""


@dataclass(frozen=True)
class Label:
    """A text that stands still.

    place : of its beginning, middle or end, as anchor says; the middle of its height.
    color : name in `plotting.cartoon.LIGHT`.
    """

    text: str
    place: complex
    anchor: Literal["start", "middle", "end"] = "middle"
    color: str = "ink"

    def box(self, size: float) -> tuple[float, float, float, float]:
        """Left, top, right, bottom; about as wide as the text will be."""
        wide = size * sum(1.1 if ord(sign) > 0x2E7F else 0.6 for sign in self.text)
        left = self.place.real - {"start": 0.0, "middle": 0.5, "end": 1.0}[self.anchor] * wide
        return left, self.place.imag - 0.6 * size, left + wide, self.place.imag + 0.6 * size


def size_of_type(stage: Stage) -> float:
    """Pixels."""
    return max(SIZE * stage.unit, LEAST)


def captions(stage: Stage, traced: tuple[str, ...]) -> tuple[Label, ...]:
    """Names of what stands still and of paths, each where it has room; then the strip below."""
    size = size_of_type(stage)
    found: list[Label] = []
    for choices in (*_strip(stage), *_of_pivots(stage), *_of_paths(stage, traced)):
        free = (one for one in choices if _fits(one, found, stage, size))
        if (label := next(free, None)) is not None:
            found.append(label)
    return tuple(found)


def ruler(stage: Stage) -> Shape:
    """A length by which one can measure, at the lower left."""
    left, right = _ruler_ends(stage)
    tick = 4j * stage.unit
    return line("scale", left - tick, left, right, right - tick)


def _strip(stage: Stage) -> Iterator[list[Label]]:
    right = _ruler_ends(stage)[1]
    length = _ruler_length(stage)
    words = f"{1000 * length:g} mm" if length < 10 else f"{length:g} m"
    yield [Label(words, right + 8 * stage.unit - 2j, "start")]
    if stage.arrow is not None:
        peak = shown(abs(stage.arrow.force).max())
        if stage.arrow.of_one:
            words = say("shaking force of one row, at most {peak} N", peak=peak)
        else:
            words = say("shaking force, at most {peak} N", peak=peak)
        corner = complex(stage.width - 12 * stage.unit, right.imag - 2)
        yield [Label(words, corner, "end", "stress")]


def _ruler_ends(stage: Stage) -> tuple[complex, complex]:
    left = complex(14 * stage.unit, stage.height - 12 * stage.unit)
    return left, left + _ruler_length(stage) * stage.scale


def _ruler_length(stage: Stage) -> float:
    """A round length, m, of a tenth to a fifth of the picture."""
    most = 0.22 * stage.width / stage.scale
    size = 10.0 ** floor(log10(most))
    return max(by * size for by in (1, 2, 5) if by * size <= most)


def _of_pivots(stage: Stage) -> Iterator[list[Label]]:
    side, below = 22 * stage.unit, (FOOT + 8) * stage.unit
    for name in stage.standing:
        place = stage.first(name)
        down = 10j * stage.unit
        yield [
            Label(name, place + 1j * below),
            Label(name, place + side + down, "start"),
            Label(name, place - side + down, "end"),
        ]


def _of_paths(stage: Stage, traced: tuple[str, ...]) -> Iterator[list[Label]]:
    """Beyond the ends of each path."""
    off = 14 * stage.unit
    for name in traced:
        path = stage.path(stage.at(stage.scene.places[name]))
        top, bottom = path[np.argmin(path.imag)], path[np.argmax(path.imag)]
        left, right = path[np.argmin(path.real)], path[np.argmax(path.real)]
        yield [
            Label(name, complex(top) - 1j * off, color="main"),
            Label(name, complex(left) - off, "end", "main"),
            Label(name, complex(right) + off, "start", "main"),
            Label(name, complex(bottom) + 1j * off, color="main"),
        ]


def _fits(label: Label, others: list[Label], stage: Stage, size: float) -> bool:
    """Whether a text lies in the picture and on no other text."""
    left, top, right, bottom = label.box(size)
    if left < 0 or top < 0 or right > stage.width or bottom > stage.height:
        return False
    boxes = (other.box(size) for other in others)
    return not any(left < b[2] and b[0] < right and top < b[3] and b[1] < bottom for b in boxes)
