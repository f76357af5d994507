"""From a machine's meters and crank angles to the pixels and instants of a moving picture."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import floor, log10
from typing import Any, Literal

import numpy as np

from equipoise.errors import UsageError
from equipoise.i18n import say
from equipoise.results.charts import quantity
from equipoise.symbols.clear import clear_angle
from equipoise.symbols.pieces import Track
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import FOOT, Array

SIDE, STRIP = 30.0, 30.0
"""Pixels around the machine, and of the strip below it, of a picture 640 pixels wide."""
LONGEST = 0.2
"""Arrow of the force, in widths of the picture."""
IN_A_TURN = 240
"""Points of a path in a turn of the crank."""
SIZE, LEAST = 12.0, 11.0
"""Of type, in pixels: in a picture 640 pixels wide, and in small ones."""
RATES = {"gif": 25, "mp4": 30}
"""Frames a second of films.  Delays of a GIF are whole hundredths of a second."""
MOST_SECONDS = 600
WIDTHS = 100, 3840


@dataclass(frozen=True, eq=False)
class Arrow:
    """The shaking force, and where it is drawn.

    place : complex, m.  force : (N,) complex, N, at the crank angles of the scene.
    of_one : whether it is of one row where there are several.
    """

    place: complex
    force: Array
    of_one: bool = False


@dataclass(frozen=True, eq=False)
class Stage:
    """Places are complex numbers in pixels, x to the right and y downward.

    frames : instants in a turn.  width : pixels.
    """

    scene: Scene
    arrow: Arrow | None
    frames: int
    width: int

    @cached_property
    def unit(self) -> float:
        """Size of signs, 1 where the picture is 640 pixels wide."""
        return max(self.width / 640, 0.6)

    @cached_property
    def closed(self) -> bool:
        """Whether the motion begins anew at its end."""
        theta = self.scene.crank_angle
        turns = self._step * len(theta) / (2 * np.pi)
        even = np.allclose(np.diff(theta), self._step, rtol=0, atol=1e-9)
        return bool(even and round(turns) and abs(turns - round(turns)) < 1e-6)

    @cached_property
    def turns(self) -> float:
        """Turns of the crank from the first instant to the last."""
        return float(abs(self._step) * self._steps / (2 * np.pi))

    @cached_property
    def _step(self) -> float:
        """Mean step from one crank angle to the next, rad."""
        theta = self.scene.crank_angle
        return float((theta[-1] - theta[0]) / (len(theta) - 1))

    @property
    def _steps(self) -> int:
        return len(self.scene.crank_angle) - (not self.closed)

    @cached_property
    def chosen(self) -> Array:
        """(K,) numbers of the crank angles of the instants; the last one closes the motion.

        A cycle begins where links are clear of each other, which is what is seen where it stands.
        """
        count = int(np.clip(round(self.frames * self.turns), 1, self._steps))
        first = clear_angle(self.scene) if self.closed else 0
        steps = np.round(np.arange(count + 1) * self._steps / count).astype(int)
        return np.asarray(first + steps)

    @property
    def times(self) -> Array:
        """(K,) from 0 to 1."""
        return np.asarray((self.chosen - self.chosen[0]) / self._steps)

    @cached_property
    def strength(self) -> float:
        """Pixels for a newton."""
        peak = 0.0 if self.arrow is None else abs(self.arrow.force).max()
        return LONGEST * self.width / (peak or 1.0)

    @cached_property
    def _corners(self) -> tuple[complex, complex]:
        """Lower left and upper right of all that is drawn, m."""
        low, high = self.scene.box
        around = np.array([low, high])
        if self.arrow is not None:
            for _ in range(3):  # the arrow has its length in pixels, whose size it changes
                tips = self.arrow.place + self.arrow.force * self.strength / self._scale(high - low)
                every = np.concatenate([around, tips])
                low = complex(every.real.min(), every.imag.min())
                high = complex(every.real.max(), every.imag.max())
        return low, high

    def _scale(self, span: complex) -> float:
        room = self.width - 2 * SIDE * self.unit
        return float(min(room / (span.real or 1e-9), 0.9 * self.width / (span.imag or 1e-9)))

    @cached_property
    def scale(self) -> float:
        """Pixels for a meter."""
        low, high = self._corners
        return self._scale(high - low)

    @cached_property
    def height(self) -> int:
        """Pixels, even as films need them."""
        low, high = self._corners
        tall = max((high - low).imag * self.scale, 0.25 * self.width)
        return 2 * round((tall + (2 * SIDE + FOOT + STRIP) * self.unit) / 2)

    @cached_property
    def origin(self) -> complex:
        """Where the machine's origin is drawn."""
        low, high = self._corners
        middle = complex(self.width, self.height - (FOOT + STRIP) * self.unit) / 2
        return middle - ((low + high) / 2).conjugate() * self.scale

    @property
    def size_of_type(self) -> float:
        """Pixels."""
        return max(SIZE * self.unit, LEAST)

    def at(self, place: Any) -> Any:
        """Pixels of a place, m."""
        return np.conj(place) * self.scale + self.origin

    def path(self, values: Array) -> Array:
        """Of N values as many as a smooth line needs."""
        return values[:: max(1, int(len(values) / max(self.turns, 1) / IN_A_TURN))]

    def moves(self, track: Track) -> Moves:
        """The motion of a part at the instants."""
        count, angle = len(track.angle), -track.angle
        turns = round((angle[-1] - angle[0]) * count / (count - 1) / (2 * np.pi))
        cycles, again = np.divmod(self.chosen, count)
        angle = angle[again] + 2 * np.pi * turns * cycles
        return Moves(self.at(track.place)[again], angle, track.stretch[again])


@dataclass(frozen=True, eq=False)
class Moves:
    """How a part moves over K instants.

    place : (K,) complex, pixels.  angle : (K,) rad, clockwise, counted on.
    stretch : (K,) factor along its x axis.
    """

    place: Array
    angle: Array
    stretch: Array


# -- texts -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Label:
    """A text that stands still.

    place : of its beginning, middle or end, as anchor says; the middle of its height.
    color : name in `symbols.looks.LIGHT`.
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


def captions(stage: Stage, traced: tuple[str, ...]) -> tuple[Label, ...]:
    """Names of what stands still and of paths, each where it has room; then the strip below."""
    found: list[Label] = []
    for choices in (*_strip(stage), *_of_pivots(stage), *_of_paths(stage, traced)):
        free = (one for one in choices if _fits(one, found, stage))
        if (label := next(free, None)) is not None:
            found.append(label)
    return tuple(found)


def _fits(label: Label, others: list[Label], stage: Stage) -> bool:
    """Whether a text lies in the picture and on no other text."""
    left, top, right, bottom = label.box(stage.size_of_type)
    if left < 0 or top < 0 or right > stage.width or bottom > stage.height:
        return False
    boxes = (other.box(stage.size_of_type) for other in others)
    return not any(left < b[2] and b[0] < right and top < b[3] and b[1] < bottom for b in boxes)


def _strip(stage: Stage) -> Iterator[list[Label]]:
    right, length = ruler_ends(stage)[1], _ruler_length(stage)
    words = f"{1000 * length:g} mm" if length < 10 else f"{length:g} m"
    yield [Label(words, right + 8 * stage.unit - 2j, "start")]
    if stage.arrow is not None:
        peak = quantity(float(abs(stage.arrow.force).max()), "force")
        words = say("shaking force, at most {peak}", peak=peak)
        if stage.arrow.of_one:
            words = say("shaking force of one row, at most {peak}", peak=peak)
        corner = complex(stage.width - 12 * stage.unit, right.imag - 2)
        yield [Label(words, corner, "end", "stress")]


def ruler_ends(stage: Stage) -> tuple[complex, complex]:
    left = complex(14 * stage.unit, stage.height - 12 * stage.unit)
    return left, left + _ruler_length(stage) * stage.scale


def _ruler_length(stage: Stage) -> float:
    """A round length, m, of a tenth to a fifth of the picture."""
    most = 0.22 * stage.width / stage.scale
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


def _of_paths(stage: Stage, traced: tuple[str, ...]) -> Iterator[list[Label]]:
    """Beyond the ends of each path."""
    off = 14 * stage.unit
    for name in traced:
        path = stage.path(stage.at(stage.scene.places[name]))
        ends = (path.imag.argmin(), path.real.argmin(), path.real.argmax(), path.imag.argmax())
        top, left, right, bottom = (complex(path[k]) for k in ends)
        yield [
            Label(name, top - 1j * off, color="main"),
            Label(name, left - off, "end", "main"),
            Label(name, right + off, "start", "main"),
            Label(name, bottom + 1j * off, color="main"),
        ]


def in_a_turn(kind: str, seconds: float) -> int:
    """Frames of a film in a turn of the crank that takes some seconds."""
    return max(1, round(seconds * RATES[kind]))


def check_seconds(seconds: float) -> None:
    """Raise `UsageError` if no turn of the crank can take so long."""
    if not 0 < seconds <= MOST_SECONDS:
        raise UsageError(
            f"got {seconds:g} s for a turn; give more than 0 s, and at most {MOST_SECONDS} s"
        )


def check_width(width: int) -> None:
    """Raise `UsageError` if no picture is so wide."""
    low, high = WIDTHS
    if not low <= width <= high:
        raise UsageError(f"got a width of {width} pixels; give {low} to {high}")
