"""Shapes of the shaft: between its nodes, in free vibration, and where they stand still."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from equipoise.errors import UsageError
from equipoise.handheld.chain import Pair, States, carry, solve
from equipoise.handheld.frequencies import floating, rigid_modes
from equipoise.handheld.layout import Kind, Layout
from equipoise.handheld.model import Station
from equipoise.signals import highest_at

Array = np.ndarray[Any, Any]


class Line(NamedTuple):
    """Of some places (X) of the shaft, in both planes: arrays (X, 2, F).

    displacement (m) and slope (rad); moment (N m) and shear (N), just right of a station.
    """

    displacement: Array
    slope: Array
    moment: Array
    shear: Array


@dataclass(frozen=True, eq=False)
class Field:
    """The answer of a layout at complex frequencies s (1 or 2, F)."""

    layout: Layout
    s: Array
    states: States
    kind: Kind = "forced"

    def at(self, places: Array) -> Line:
        """Shape at some places (X), m from the left end.

        Raises
        ------
        UsageError : a place is off the shaft.
        """
        places = np.asarray(places, dtype=float)
        length = self.layout.tool.shaft.length
        if np.any((places < 0) | (places > length)):
            raise UsageError(f"got a place off the shaft; give places from 0 to {length:g} m")
        starts = np.array([cell.start for cell in self.layout.cells])
        which = np.clip(np.searchsorted(starts, places, "right") - 1, 0, len(starts) - 1)
        over = self.layout.part(which, places - starts[which], self.s, self.kind)
        w, t = (np.array(part)[which] for part in zip(*self.states.motion, strict=True))
        v, m = (np.array(part)[which] for part in zip(*self.states.force, strict=True))
        displacement, slope, shear, moment = over.carried(w, t, v, m)
        return Line(displacement, slope, moment, shear)


BESIDE, ASIDE, LOUDER = 1e-9, 1e-3, 100.0
"""Shares of an eigenvalue by which a load shakes beside it to bring out the shape, and further off;
how many times as loud it must be at the first."""
SAME = 1e-9
"""Share of each other within which two natural frequencies are one."""


def still_shapes(layout: Layout, frequency: Array, places: Array) -> Array:
    """Shapes (2, K, X) without damping; of equal frequencies such that they share no momentum."""
    swing = 1j * np.where(frequency > 0, frequency, 1.0)
    found = shapes_beside(layout, swing, places, "undamped")
    shapes, slopes = (np.moveaxis(part, 0, -1).real.copy() for part in found)
    for plane, free in enumerate(rigid_modes(layout.tool)):
        floats = len(floating(layout.tool)[plane])
        for k, (across, slope) in enumerate(free[: frequency.shape[1]]):
            shapes[plane, k], slopes[plane, k] = across + slope * places, slope
        shapes[plane, len(free) : len(free) + floats] = 0.0
        for k in range(1, shapes.shape[1]):
            earlier, later = frequency[plane, k - 1 : k + 1]
            if later - earlier <= SAME * later and later > 0:
                pairs = [(shapes[plane, one], slopes[plane, one]) for one in (k - 1, k)]
                share = _share(layout, plane, later, places, *pairs)
                shapes[plane, k] -= share * shapes[plane, k - 1]
    return np.asarray(scaled(shapes).real)


Shape = tuple[Array, Array]
"""Displacement and slope at the places, (X,) each."""


def _share(
    layout: Layout, plane: int, frequency: float, places: Array, one: Shape, other: Shape
) -> float:
    """How much of one shape is in another, by the momentum that they share."""

    def momentum(shape: Shape) -> float:
        total = 0.0
        for start, stop, section in layout.tool.shaft.pieces:
            inside = (places >= start) & (places <= stop)
            for kind, density in ((0, section.mass_per_length), (1, section.rotary_inertia)):
                along = np.trapezoid((one[kind] * shape[kind])[inside], places[inside])
                total += density * float(along)
        for station in layout.tool.stations:
            here, there = (
                [float(np.interp(station.position, places, part)) for part in each]
                for each in (one, shape)
            )
            total += _mass(layout, station, plane, frequency) * here[0] * there[0]
            total += station.inertia[plane] * here[1] * there[1]
        return total

    own = momentum(one)
    return momentum(other) / own if own else 0.0


def _mass(layout: Layout, station: Station, plane: int, frequency: float) -> float:
    """What moves with a station, kg, with its absorber, which swings further than it."""
    total = float(layout.mass_at(station))
    absorber = station.absorber
    if absorber is not None:
        stiffness = absorber.stiffness[plane]
        below = stiffness - absorber.mass * frequency**2
        total += absorber.mass * (stiffness / below) ** 2 if below else 0.0
    return total


def shapes_beside(layout: Layout, s: Array, places: Array, kind: Kind) -> tuple[Array, Array]:
    """Displacement and slope (X, 2, K) of the shaft for each eigenvalue (1 or 2, K), 1/s.

    Its answer close beside each to a load that knows no symmetry; nothing where that is no louder
    than far beside, as the shaft then is at rest while something on it swings.
    """
    near, far = (_loaded(layout, s * (1 + share), places, kind) for share in (BESIDE, ASIDE))
    still = np.max(np.abs(near[0]), axis=0) < LOUDER * np.max(np.abs(far[0]), axis=0)
    return np.where(still, 0.0, near[0]), np.where(still, 0.0, near[1])


def _loaded(layout: Layout, s: Array, places: Array, kind: Kind) -> tuple[Array, Array]:
    """Displacement and slope (X, 2, K) under that load."""
    numbers = np.arange(s.shape[-1])
    loads = [
        Pair(1 + np.cos(2.4 * k + 0.7 * numbers), np.sin(1.3 * k + 0.3 + 1.1 * numbers))
        for k in range(len(layout.nodes))
    ]
    states = solve(carry(layout.chain(s, kind)), loads)
    line = Field(layout, np.broadcast_to(s, (2, s.shape[-1])), states, kind).at(places)
    return line.displacement, line.slope


def scaled(shapes: Array) -> Array:
    """Shapes (..., X), each 1 where it is largest."""
    at = highest_at(np.abs(shapes), smooth=False)[..., None]
    largest = np.take_along_axis(shapes, at, -1)
    return np.asarray(shapes / np.where(largest == 0, 1.0, largest))


def zeros_of(places: Array, shape: Array) -> Array:
    """Places at which a shape changes its sign, by a cubic through the four points about each."""
    before = np.flatnonzero(np.signbit(shape[1:]) != np.signbit(shape[:-1]))
    return np.array([_zero(places, shape, int(k)) for k in before])


def _zero(places: Array, shape: Array, k: int) -> float:
    """The place between two points, as a cubic of the displacement; on a line across a kink."""
    first = min(max(k - 1, 0), len(places) - 4)
    x, y = places[first : first + 4], shape[first : first + 4]
    cubic = 0.0
    with np.errstate(all="ignore"):
        for i in range(4):
            others = np.delete(y, i)
            cubic += float(x[i] * np.prod(others / (others - y[i])))
    if places[k] <= cubic <= places[k + 1]:
        return cubic
    share = shape[k] / (shape[k] - shape[k + 1])
    return float(places[k] + share * (places[k + 1] - places[k]))
