"""The support as it is drawn: its corners, how a mode displaces them, and views of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from equipoise.mechanism.motion import move
from equipoise.mechanism.support import Direction, unit_vector
from equipoise.symbols.scene import Scene, hull
from equipoise.vibration.linkages import rows_of

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine
    from equipoise.mechanism.support import Gauge, Mount, Support
    from equipoise.vibration.free import FreeVibration
    from equipoise.vibration.response import Mode

Array = np.ndarray[Any, Any]
View = Literal["side", "rear", "top"]

ACROSS: dict[View, tuple[int, int, int]] = {"side": (0, 1, 1), "rear": (2, 1, 1), "top": (0, 2, -1)}
"""View -> which of x, y, z run to the right and upward, and the sense of the second: from above,
what lies to the right of who looks forward is below."""
AXIS_SEEN: dict[View, str] = {"side": "pitch", "rear": "roll", "top": "yaw"}
"""The axis that a view looks along."""
SHOWN_SIZE = 0.13
"""Largest displacement drawn, over the size of the support."""
ROUND, DIRECTIONS = 0.035, 24
"""Radius of the outline's corners over the size of the support; points of a circle."""
ANGLES = 72
"""In a turn, from which the size of a linkage is told."""
PHASES = np.exp(1j * np.linspace(0, 2 * np.pi, 73))


@dataclass(frozen=True, eq=False)
class ModeShape:
    """A mode as it is drawn, displacements far larger than true."""

    free: FreeVibration
    mode: Mode

    @property
    def support(self) -> Support:
        """The support of the model."""
        return self.free.linear.body.support

    @property
    def reference(self) -> Array:
        """The point about which it turns, (3,), m."""
        return self.free.linear.body.reference

    @cached_property
    def linkages(self) -> Array:
        """Points of the frame in every row, (N, 3), m."""
        frame = self.free.machine.frame.values()
        return np.array(
            [
                (x + row.offset[0], y + row.offset[1], row.lateral)
                for row in rows_of(self.free.machine)
                for x, y in frame
            ]
        )

    @cached_property
    def corners(self) -> Array:
        """All points by which the support is drawn, (N, 3), m."""
        support = self.support
        items: list[Mount | Gauge] = [*support.mounts.values(), *support.gauges.values()]
        held = [item.point for item in items if item.point is not None]
        return np.array([*self.linkages, self.reference, support.center_of_mass, *held])

    @cached_property
    def size(self) -> float:
        """Of the support or, where that is a point, of what moves on it; m."""
        size = float(np.linalg.norm(np.ptp(self.corners, axis=0)))
        return size or size_of(self.free.machine) or 1e-3

    @cached_property
    def motion(self) -> Array:
        """Six coordinates, complex, so large that the picture shows them."""
        whole = np.zeros(6, complex)
        whole[self.free.linear.body.free] = self.mode.shape
        largest = float(np.max(np.abs(_moved(whole, self.corners - self.reference))))
        return whole * (SHOWN_SIZE * self.size / largest) if largest else whole

    def displaced(self, points: Array, phase: complex) -> Array:
        """Points (N, 3) at an instant of the mode, m."""
        moved = _moved(self.motion * phase, points - self.reference)
        return np.asarray(points + moved.real)

    def path(self, point: Array, view: View) -> Array:
        """Where a point (3,) goes in a cycle, complex, m."""
        moved = _moved(self.motion, (point - self.reference)[None])[0]
        return seen(point + np.outer(PHASES, moved).real, view)

    def outline(self, view: View, phase: complex = 0.0) -> Array:
        """Closed outline in a view, complex, m: a line drawn tightly around discs at corners."""
        corners = hull(seen(self.displaced(self.corners, phase), view))
        disc = ROUND * self.size * np.exp(2j * np.pi * np.arange(DIRECTIONS) / DIRECTIONS)
        around = hull((corners[:, None] + disc).ravel())
        return np.append(around, around[0])

    def extent(self, view: View) -> tuple[complex, complex]:
        """Lower left and upper right corner of all that moves in a view, m."""
        every = np.concatenate([self.outline(view, phase) for phase in (0, *PHASES[::6])])
        low = complex(np.min(every.real), np.min(every.imag))
        return low, complex(np.max(every.real), np.max(every.imag))


def size_of(machine: Machine) -> float:
    """Diagonal of the box that holds every point of a linkage all the time, m."""
    low, high = Scene.of(move(machine, ANGLES)).box
    return abs(high - low)


def _moved(motion: Array, arms: Array) -> Array:
    """Displacement (N, 3) of points at arms (N, 3) under six coordinates."""
    return np.asarray(motion[:3] + np.cross(motion[3:], arms))


def seen(points: Array, view: View) -> Array:
    """Points (..., 3) or directions in a view, complex, m."""
    right, up, sense = ACROSS[view]
    points = np.asarray(points)
    return np.asarray(points[..., right] + 1j * sense * points[..., up])


def along(direction: Direction, view: View) -> complex:
    """A unit vector in a view."""
    return complex(seen(np.array(unit_vector(direction)), view))
