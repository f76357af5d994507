"""Points of a planar support that turns: what a gauge reads there, and what a mount does there.

Places and rates are arrays (3, ...) along surge, heave and pitch; rotation is not small.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.mechanism.support import Gauge, Mount, unit_vector
from equipoise.structures.body import Body, Rest

Array = np.ndarray[Any, Any]

SURGE, HEAVE, PITCH = 0, 1, 2
IN_PLANE = (0, 1, 5)
"""Their numbers among the six coordinates of `structures.body`."""


@dataclass(frozen=True, eq=False)
class Reading:
    """Motion of a point of the support along a direction fixed in space, or its rotation.

    along : unit vector (2,), or None for the rotation.  arm : (2,) from the reference point, m.
    share : 0 for an axis about which a planar support does not turn.
    """

    along: Array | None
    arm: Array
    share: float = 1.0

    @classmethod
    def of(cls, body: Body, item: Mount | Gauge) -> Reading:
        if item.point is None:
            return cls(None, np.zeros(2), 1.0 if item.axis == "pitch" else 0.0)
        arm = (np.array(item.point) - body.reference)[:2]
        return cls(np.array(unit_vector(item.direction)[:2]), arm)

    def displacement(self, place: Array) -> Array:
        """From the drawn position, m or rad."""
        if self.along is None:
            return np.asarray(place[PITCH] * self.share)
        x, y = self.turned(place[PITCH])
        return self._sum(place, x - self.arm[0], y - self.arm[1])

    def velocity(self, place: Array, rate: Array) -> Array:
        """m/s or rad/s."""
        if self.along is None:
            return np.asarray(rate[PITCH] * self.share)
        x, y = self.turned(place[PITCH])
        return self._sum(rate, -rate[PITCH] * y, rate[PITCH] * x)

    def acceleration(self, place: Array, rate: Array, change: Array) -> Array:
        """m/s2 or rad/s2."""
        if self.along is None:
            return np.asarray(change[PITCH] * self.share)
        x, y = self.turned(place[PITCH])
        square = rate[PITCH] ** 2
        return self._sum(change, -change[PITCH] * y - square * x, change[PITCH] * x - square * y)

    def wrench(self, force: Array, place: Array) -> tuple[Any, Any, Array]:
        """Force along x and y, and moment about the reference point, of a force or moment here."""
        if self.along is None:
            return 0.0, 0.0, force * self.share
        x, y = self.turned(place[PITCH])
        fx, fy = force * self.along[0], force * self.along[1]
        return fx, fy, x * fy - y * fx

    def turned(self, pitch: Array) -> tuple[Array, Array]:
        """The arm, turned with the support."""
        c, s = np.cos(pitch), np.sin(pitch)
        return c * self.arm[0] - s * self.arm[1], s * self.arm[0] + c * self.arm[1]

    def _sum(self, moved: Array, x: Array, y: Array) -> Array:
        assert self.along is not None
        found: Array = self.along[0] * (moved[SURGE] + x) + self.along[1] * (moved[HEAVE] + y)
        return found


@dataclass(frozen=True, eq=False)
class Contact:
    """A mount: a spring and damper that may be preloaded, and may push on one side only."""

    name: str
    at: Reading
    preload: float
    stiffness: float
    damping: float
    one_sided: bool

    def force(self, place: Array, rate: Array) -> Array:
        """With which it pushes the support, N or N m."""
        moved, moving = self.at.displacement(place), self.at.velocity(place, rate)
        force = self.preload - self.stiffness * moved - self.damping * moving
        if self.one_sided:
            force = np.where(force.real > 0, force, 0.0)
        return force


def contacts_of(body: Body, rest: Rest) -> tuple[Contact, ...]:
    """The mounts of a planar support."""
    return tuple(
        Contact(
            name,
            Reading.of(body, mount),
            rest.preload[name],
            mount.spring,
            mount.damper,
            mount.one_sided,
        )
        for name, mount in body.support.mounts.items()
    )
