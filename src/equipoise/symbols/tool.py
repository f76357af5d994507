"""A hand-held tool from the side, as signs that move with its shaft."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.signals import Array
from equipoise.symbols.carrier import MOUNT, SPRING, foot, ground, turning
from equipoise.symbols.pieces import PieceTrack
from equipoise.symbols.scene import WIDE
from equipoise.symbols.shapes import Shape, circle, line, sign

DENSITY = 1000.0
"""Of bodies of which the mass alone is known, kg/m3: they are drawn as cubes of water."""
THIN = 3.5
"""Half the width of a shaft whose diameter is not known, units."""
ROOM = 6.0
"""Around all that is drawn, units."""
BLADE, TILT = 2.2, np.exp(0.55j)
"""Length of a blade over the width of the head that has it, and its direction."""


@dataclass(frozen=True)
class TubeSign:
    """A part of the shaft, m; of no diameter where that is not known."""

    start: float
    stop: float
    diameter: float


@dataclass(frozen=True)
class SeatSign:
    """What sits at a place of the shaft, m.

    mass : of a rigid body, absorber : of one on a spring, kg.  hands : that hold on there.
    harness : whether a belt, grounded, clamped : whether a spring or damper holds it.
    excitation : by a ``force``, by what ``turns``, or by nothing.
    part : ``motor`` and whether it has a cylinder (``engine``), ``blade``, or nothing of these.
    """

    name: str
    place: float
    mass: float = 0.0
    absorber: float = 0.0
    hands: int = 0
    harness: bool = False
    grounded: bool = False
    clamped: bool = False
    excitation: str = ""
    part: str = ""

    @property
    def edge(self) -> float:
        """Of its body as it is drawn, m."""
        return float((self.mass / DENSITY) ** (1 / 3))


@dataclass(frozen=True, eq=False)
class ToolScene:
    """A tool from the side at N instants.

    shaft : its parts, end to end.
    along : places (X,) on it, m, and how far they are deflected: (N, X), m, to the scale drawn.
    """

    shaft: tuple[TubeSign, ...]
    seats: tuple[SeatSign, ...]
    along: Array
    deflected: Array

    @cached_property
    def tracks(self) -> Mapping[str, tuple[PieceTrack, PieceTrack]]:
        """Of every seat: of what turns with the shaft, and of what stays upright."""
        slopes, pairs = np.gradient(self.deflected, self.along, axis=1), {}
        for seat in self.seats:
            high, slope = (
                np.array([np.interp(seat.place, self.along, row) for row in rows])
                for rows in (self.deflected, slopes)
            )
            place, none = seat.place + 1j * high, np.zeros(len(high))
            turned, upright = (PieceTrack(place, by, none + 1) for by in (np.arctan(slope), none))
            pairs[seat.name] = turned, upright
        return pairs

    @property
    def unit(self) -> float:
        """Of signs, m, about."""
        length, widest = self.shaft[-1].stop, max((seat.edge for seat in self.seats), default=0.0)
        return (length + 2 * widest) / WIDE

    @cached_property
    def box(self) -> tuple[complex, complex]:
        """Lower left and upper right corner of all that a picture should hold, m."""
        every = [shape for k in range(len(self.deflected)) for shape in self.at(k)]
        corners = np.concatenate([shape.at(1.0, self.unit) for shape in every])
        room = ROOM * self.unit * (1 + 1j)
        low, high = (complex(end(corners.real), end(corners.imag)) for end in (np.min, np.max))
        return low - room, high + room

    def pieces(self) -> list[tuple[str, SeatSign, bool, tuple[Shape, ...]]]:
        """What every seat has, about its place on the shaft: layer, seat, whether it turns with the
        shaft, shapes.  The shaft lies between the layers ``below`` and ``above``.
        """
        kinds = (
            ("below", _restraint, False),
            ("below", _absorber, True),
            ("above", _body, True),
            ("above", _hands, False),
        )
        values = [
            (layer, seat, turns, tuple(draw(seat)))
            for layer, draw, turns in kinds
            for seat in self.seats
        ]
        return [item for item in values if item[3]]

    def at(self, k: int) -> list[Shape]:
        """Everything that is drawn at the k-th instant, from the back to the front."""
        below, above = (
            [
                self.tracks[seat.name][not turns].moved(shape, k)
                for where, seat, turns, shapes in self.pieces()
                for shape in shapes
                if where == layer
            ]
            for layer in ("below", "above")
        )
        return [*below, *self._shaft(k), *above]

    def _shaft(self, k: int) -> Iterator[Shape]:
        for tube in self.shaft:
            between = self.along[(self.along > tube.start) & (self.along < tube.stop)]
            x = np.array([tube.start, *between, tube.stop])
            center = x + 1j * np.interp(x, self.along, self.deflected[k])
            side = np.full(len(x), 1j)
            places = [center + s * side * tube.diameter / 2 for s in (1, -1)]
            off = [(0 if tube.diameter else THIN) * s * side for s in (1, -1)]
            around, offsets = (np.concatenate([item, other[::-1]]) for item, other in (places, off))
            yield Shape("rim", around, offsets, closed=True)


def _box(role: str, edge: float, middle: complex = 0, tall: float = 1.0) -> Shape:
    """A box so wide, m, about a place, m."""
    half = edge / 2 * np.array([-1 - 1j * tall, 1 - 1j * tall, 1 + 1j * tall, -1 + 1j * tall])
    return line(role, *(middle + half), closed=True)


def _body(seat: SeatSign) -> Iterator[Shape]:
    """A body by its mass; with a cylinder, or with a blade across its own axis."""
    edge = seat.edge
    if not edge or seat.hands or (seat.harness and not seat.part):
        return
    if seat.part == "blade":
        middle = -0.95j * TILT * edge
        ends = middle + BLADE / 2 * edge * TILT * np.array([-1, 1])
        yield line("tray", *ends)
        yield line("rail", 0, middle)
    if seat.part == "engine":
        yield _box("rest", 0.55 * edge, 0.75j * edge, 1.1)
        for level in (0.65, 0.78, 0.91):
            yield line("rail", *(edge * (1j * level + np.array([-0.36, 0.36]))))
    yield _box("rest", edge)
    if seat.part in ("motor", "engine"):
        yield circle("pin", 0, grown=3.6)


def _restraint(seat: SeatSign) -> Iterator[Shape]:
    """The belt, and springs and dampers to the ground."""
    if seat.harness:
        loop = 66j - 14j * np.exp(1j * np.linspace(0.15, 2, 9) * np.pi)
        yield sign("tie", 0, [18j, 44j, *loop, 44j])
        yield circle("float", 0, grown=9.0)
        yield sign("mount", 0, [9j, 18j])
    if seat.grounded:
        yield sign("mount", 0, -1j * MOUNT[0] * SPRING[0])
        yield from (*ground(0, -1j), *foot(0, -1j, one_sided=False))
    if seat.clamped:
        yield from turning(0, 0, of_gauge=False)


def _absorber(seat: SeatSign) -> Iterator[Shape]:
    """A body on a spring below the shaft."""
    if not seat.absorber:
        return
    down = -1j * np.array([4, 9, *(9 + 3.5 * (np.arange(6) + 0.5)), 30, 34])
    yield sign("spring", 0, down + np.array([0, 0, 6, -6, 6, -6, 6, -6, 0, 0]))
    edge = (seat.absorber / DENSITY) ** (1 / 3)
    box = _box("rest", edge, -0.5j * edge)
    yield Shape(box.role, box.places, box.offsets - 34j, closed=True)


FINGER, ROUND = 6.4, np.exp(1j * np.linspace(0, np.pi, 7))
"""Width of a finger, units; half a circle."""


def _hands(seat: SeatSign) -> Iterator[Shape]:
    """Hands around the shaft, each with the arm that it comes from; an arrow of what shakes."""
    for hand in range(seat.hands):
        off = 32.0 * (hand - (seat.hands - 1) / 2)
        arm = np.array([-11 + 8j, -17 + 64j, 9 + 64j, 13 + 8j]) + off
        yield sign("stand", 0, arm)
        for number in range(4):
            x = off + FINGER * (number - 1.5)
            top, bottom = 3.2 * ROUND + 8j, -3.2 * ROUND - 8j
            yield sign("stand", 0, x + np.concatenate([top, bottom]), closed=True)
    if seat.excitation == "force":
        yield sign("force", 0, [0, 40j])
        yield sign("force-head", 0, [52j, 39j + 5, 39j - 5], closed=True)
    elif seat.excitation:
        arc = 15 * np.exp(1j * np.radians(np.linspace(-50, 170, 24)))
        yield sign("force-arc", 0, arc)
        head = arc[-1] + 9 * arc[-1] / abs(arc[-1]) * np.array([1j, 0.4, -0.4])
        yield sign("force-head", 0, head, closed=True)
