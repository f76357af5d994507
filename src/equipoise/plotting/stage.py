"""From a machine's meters and crank angles to the pixels and instants of a moving picture."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.plotting.shapes import FOOT

if TYPE_CHECKING:
    from equipoise.scene import Body, Guide, Scene

Array = np.ndarray[Any, Any]

SIDE, STRIP = 30.0, 30.0
"""Pixels around the machine, and of the strip below it, of a picture 640 pixels wide."""
LONGEST = 0.2
"""Arrow of the force, in widths of the picture."""

IN_A_TURN = 240
"""Points of a path in a turn of the crank."""


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
class Track:
    """How a part moves over K instants.

    place : (K,) complex, pixels.  angle : (K,) rad, clockwise, counted on.
    stretch : (K,) factor along its x axis.
    """

    place: Array
    angle: Array
    stretch: Array


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
        """(K,) numbers of the crank angles of the instants; the last one closes the motion."""
        count = int(np.clip(round(self.frames * self.turns), 1, self._steps))
        return np.round(np.arange(count + 1) * self._steps / count).astype(int)

    @property
    def times(self) -> Array:
        """(K,) from 0 to 1."""
        return self.chosen / self._steps

    @cached_property
    def strength(self) -> float:
        """Pixels for a newton."""
        peak = 0.0 if self.arrow is None else abs(self.arrow.force).max()
        return LONGEST * self.width / (peak or 1.0)

    @cached_property
    def standing(self) -> tuple[str, ...]:
        """Points of the frame at which something is held."""
        held = {to for _, to in self.scene.springs} | self.scene.pins
        return tuple(name for name in self.scene.frame if name in held)

    @cached_property
    def _corners(self) -> tuple[complex, complex]:
        """Lower left and upper right of all that is drawn, m."""
        around = np.concatenate(list(self._drawn()))
        low, high = _box(around)
        if self.arrow is not None:
            for _ in range(3):  # the arrow has its length in pixels, whose size it changes
                tips = self.arrow.place + self.arrow.force * self.strength / self._scale(high - low)
                low, high = _box(np.concatenate([around, tips]))
        return low, high

    def _drawn(self) -> Iterator[Array]:
        scene = self.scene
        for name in {*scene.places}.difference(scene.frame).union(self.standing):
            yield scene.places[name]
        yield from scene.mass_centers.values()
        for guide in scene.guides:
            place = scene.places[guide.point]
            yield place - guide.behind * guide.way
            yield place + guide.ahead * guide.way
        for wheel in scene.wheels:
            for reach in (wheel.radius * (1 + 1j), -wheel.radius * (1 + 1j)):
                yield scene.places[wheel.center] + reach

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

    def at(self, place: Any) -> Any:
        """Pixels of a place, m."""
        return np.conj(place) * self.scale + self.origin

    def first(self, point: str) -> complex:
        """Where a point is at the beginning."""
        return complex(self.at(self.scene.places[point][0]))

    def path(self, values: Array) -> Array:
        """Of N values as many as a smooth line needs."""
        return values[:: max(1, int(len(values) / max(self.turns, 1) / IN_A_TURN))]

    def track(self, place: Array, angle: Array, stretch: Array | None = None) -> Track:
        """The motion of a part.

        place : (N,) complex, pixels.  angle : (N,) rad, clockwise, counted on.
        """
        count = len(angle)
        turns = round((angle[-1] - angle[0]) * count / (count - 1) / (2 * np.pi))
        angle = np.append(angle, angle[0] + 2 * np.pi * turns)
        long = np.ones(count) if stretch is None else stretch
        again = self.chosen % count
        return Track(place[again], angle[self.chosen], long[again])

    def local(self, body: Body, place: Array) -> complex:
        """Pixels from a link's first point, in the link's own axes; place : (N,) complex, m."""
        arm = place[0] - self.scene.places[body.points[0]][0]
        turned = arm * np.exp(-1j * self.scene.angles[body.name][0])
        return complex(np.conj(turned) * self.scale)

    def ends(self, guide: Guide) -> tuple[Array, Array]:
        """First and last place of a block on its line, (1,) complex, m, at the beginning."""
        way, place = guide.way[:1], self.scene.places[guide.point][:1]
        return place - guide.behind[:1] * way, place + guide.ahead[:1] * way


def _box(places: Array) -> tuple[complex, complex]:
    """Lower left and upper right corner."""
    x, y = places.real, places.imag
    return complex(x.min(), y.min()), complex(x.max(), y.max())


def directions(ways: Array) -> Array:
    """Angles of vectors, (N,) rad, counted on."""
    return np.unwrap(np.angle(ways))
