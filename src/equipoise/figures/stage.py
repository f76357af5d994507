"""From a machine's meters and crank angles to the pixels and instants of a moving picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from math import ceil
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note, say
from equipoise.results.charts import Axis, quantity
from equipoise.signals import Array
from equipoise.symbols.pieces import PieceTrack
from equipoise.symbols.scene import Scene, clear_angle
from equipoise.symbols.shapes import FOOT

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis

SIDE, STRIP = 30.0, 30.0
"""Pixels around the machine, and of the strip below it, of a picture 640 pixels wide."""
LONGEST = 0.2
"""Arrow of the force, in widths of the picture."""
IN_A_TURN = 240
"""Points of a path in a turn of the crank."""
SIZE, LEAST = 12.0, 11.0
"""Of type, in pixels: in a picture 640 pixels wide, and in small ones."""
ROUNDING = 1e-9
"""Over a distance: coordinates that are less are zeros."""
RULER = 0.22
"""Most length of the ruler, in widths of the picture."""
SOME = 24
"""Instants, and places on an edge of a link, at which texts are kept free."""
SHRUNK = 18 / 640
"""Size of type where the picture is shown on a narrow page, in widths of the picture."""
SHRUNK_STRIP = 12.5 / 640
"""Size of type there of several lines in the strip below: 7 pixels on a telephone."""
RATES = {"gif": 25, "mp4": 30}
"""Frames a second of films.  Delays of a GIF are whole hundredths of a second."""
MOST_SECONDS = 600
WIDTHS = 100, 3840


@dataclass(frozen=True, eq=False)
class ForceArrow:
    """The shaking force, and where it is drawn.

    place : complex, m.  force : (N,) complex, N, at the crank angles of the scene.
    of_one : whether it is of one row where there are several.
    """

    place: complex
    force: Array
    of_one: bool = False

    @classmethod
    def of(cls, analysis: Analysis) -> ForceArrow:
        """The force arrow of a machine whose masses are known."""
        forces, of_one = analysis.forces, len(analysis.machine.rows) > 1
        return cls(forces.about, forces.shaking_force.value, of_one)


@dataclass(frozen=True, eq=False)
class Stage:
    """Places are complex numbers in pixels, x to the right and y downward.

    frames : instants in a turn.  width : pixels.
    begin : number of the crank angle at which a cycle begins; where links are clear of each other,
    which is what is seen where it stands, if None.
    """

    scene: Scene
    arrow: ForceArrow | None
    frames: int
    width: int
    begin: int | None = None

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
        """(K,) numbers of the crank angles of the instants; the last one closes the motion."""
        count = int(np.clip(round(self.frames * self.turns), 1, self._steps))
        begin = clear_angle(self.scene) if self.begin is None else self.begin
        first = begin if self.closed else 0
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
        low, high = self.scene.swept_box
        around = np.array([low, high])
        if self.arrow is not None:
            for _ in range(3):  # the arrow has its length in pixels, whose size it changes
                tips = self.foot + self.arrow.force * self.strength / self._scale(high - low)
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
        return 2 * round((tall + 2 * SIDE * self.unit + self._below) / 2)

    @cached_property
    def origin(self) -> complex:
        """Where the machine's origin is drawn."""
        low, high = self._corners
        middle = complex(self.width, self.height - self._below) / 2
        return middle - ((low + high) / 2).conjugate() * self.scale

    @property
    def size_of_type(self) -> float:
        """Pixels."""
        return max(SIZE * self.unit, LEAST)

    @property
    def size_where_narrow(self) -> float:
        """Of type where the picture is shown small, pixels of the whole picture."""
        return max(self.size_of_type, SHRUNK * self.width)

    @cached_property
    def captions(self) -> list[tuple[str, str]]:
        """What is to be said of the support, its movement and the force, and its colour."""
        swing = self.scene.swing
        lines = (
            *row_legend(self.scene),
            *beyond(self.scene),
            *(() if swing is None else swing.captions),
        )
        pairs = [(words, "ink") for words in lines]
        if self.arrow is not None:
            peak = quantity(float(abs(self.arrow.force).max()), "force")
            words = say("shaking force, at most {peak}", peak=peak)
            if self.arrow.of_one:
                words = say("shaking force of one row, at most {peak}", peak=peak)
            pairs.append((words, "stress"))
        return pairs

    @cached_property
    def lines(self) -> list[tuple[str, str]]:
        """Remarks in lines from below; the first is empty where none fits beside the ruler."""
        result = []
        for words, color in self.captions:
            size = width_of(words, self._size_in_strip) / len(words)
            parts = wrap(words, max(1, int((self.width - 24 * self.unit) / size)))
            result += [(part, color) for part in parts]
        size = self._size_in_strip if len(result) > 1 else self.size_where_narrow
        width = (1 - RULER) * self.width - 36 * self.unit - width_of("500 mm ", size)
        if result and width_of(result[-1][0], size) > width:
            result.append(("", "ink"))
        return result[::-1]

    @property
    def row(self) -> float:
        """Pixels from one of these to the next."""
        return max(1.4 * self.size_of_type, 1.1 * self._size_in_strip)

    @property
    def _size_in_strip(self) -> float:
        """Of type in several lines where the picture is shown small, pixels."""
        return max(self.size_of_type, SHRUNK_STRIP * self.width)

    @property
    def _below(self) -> float:
        """Height, px, of stands, of the strip below, and of its lines of text."""
        return (FOOT + STRIP) * self.unit + self.row * max(len(self.lines) - 1, 0)

    @property
    def foot(self) -> Array:
        """Where the arrow of the force begins, m."""
        assert self.arrow is not None
        return np.asarray(self.scene.swung(self.arrow.place) + 0 * self.arrow.force)

    def at(self, place: Any) -> Any:
        """Pixels of a place, m."""
        return np.conj(place) * self.scale + self.origin

    @cached_property
    def links(self) -> Array:
        """Pixels along the edges of links at some instants."""
        at = self.chosen[:: max(1, len(self.chosen) // SOME)] % len(self.scene.crank_angle)
        values = [np.zeros(0, complex)]
        for body in self.scene.bodies:
            corners = [
                self.at(self.scene.swung(self.scene.places[name])[at]) for name in body.outline
            ]
            for start, end in pairwise((*corners, corners[0])):
                values += [start + (end - start) * part for part in np.linspace(0, 1, SOME)]
        return np.concatenate(values)

    def way(self, point: str) -> Array:
        """Pixels through which a point goes, as many as a smooth line needs."""
        return self.path(self.at(self.scene.swung(self.scene.places[point])))

    def path(self, values: Array) -> Array:
        """Of N values as many as a smooth line needs."""
        return values[:: max(1, int(len(values) / max(self.turns, 1) / IN_A_TURN))]

    def moves(self, track: PieceTrack) -> Moves:
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


def row_legend(scene: Scene) -> list[str]:
    """How each of several rows is drawn, and by how much it is ahead, in one line; or no line."""
    rows = scene.rows
    parts = [say("{rows}: as drawn", rows=rows_named(rows.drawn))] if rows.drawn else []
    for part in rows.others:
        text = {"rows": rows_named(part.numbers), "phase": f"{np.degrees(part.phase):.4g}°"}
        if not part.places:
            parts.append(say("{rows}: beside the drawing, {phase} ahead", **text))
        elif part.phase:
            parts.append(say("{rows}: pale, {phase} ahead", **text))
        else:
            parts.append(say("{rows}: pale", **text))
    return [say("; ").join(parts)] if parts else []


def rows_named(numbers: tuple[int, ...]) -> str:
    """Rows by their numbers in words, such as ``rows 2, 3``."""
    text = ", ".join(map(str, numbers))
    if len(numbers) == 1:
        return say("row {number}", number=text)
    return say("rows {numbers}", numbers=text)


def beyond(scene: Scene) -> list[str]:
    """What a support has too far from the linkage to be in its picture, and where."""
    carrier = scene.carrier
    if carrier is None:
        return []
    places = {carrier.center: [say("centre of mass")]}
    if carrier.support.pivot is not None:
        places = {carrier.reference: [say("pivot")]} | places
    for items in (carrier.support.mounts, carrier.support.gauges):
        for place, names in carrier.named(items).items():
            places[place] = places.get(place, []) + names
    return beyond_text({place: names for place, names in places.items() if not scene.shows(place)})


def beyond_text(places: Mapping[complex, Sequence[str]]) -> list[str]:
    """What is at places, m, that a drawing does not reach, in one line; or no line."""
    text = []
    for place, names in places.items():
        axis = Axis.of("", "length", [place])
        least = ROUNDING * abs(place)
        parts = (part if abs(part) > least else 0.0 for part in (place.real, place.imag))
        x, y = map(axis.format_value, parts)
        text.append(f"{', '.join(names)} ({x}, {y}) {axis.unit_name}")
    return [say("Beyond the drawing: {items}", items="; ".join(text))] if text else []


def width_of(text: str, size: float) -> float:
    """Pixels that a text takes, about."""
    return size * sum(1.1 if ord(sign) > 0x2E7F else 0.6 for sign in text)


LEAST_ANGLES = 720
"""In a turn, for smooth paths."""


def in_a_turn(kind: str, seconds: float) -> int:
    """Frames of a film in a turn of the crank that takes some seconds."""
    return max(1, round(seconds * RATES[kind]))


def check_seconds(seconds: float) -> None:
    """Raise `UsageError` if no turn of the crank can take so long."""
    if not 0 < seconds <= MOST_SECONDS:
        raise UsageError(
            Note(
                "got {seconds:g} s for a turn; give more than 0 s, and at most {most_seconds} s",
                seconds=seconds,
                most_seconds=MOST_SECONDS,
            )
        )


def check_width(width: int) -> None:
    """Raise `UsageError` if no picture is so wide."""
    low, high = WIDTHS
    if not low <= width <= high:
        raise UsageError(
            Note(
                "got a width of {width} pixels; give {low} to {high}",
                width=width,
                low=low,
                high=high,
            )
        )


def smooth(frames: int) -> int:
    """Crank angles in a turn of so many frames: as many for each that paths are smooth."""
    return frames * ceil(LEAST_ANGLES / frames)
