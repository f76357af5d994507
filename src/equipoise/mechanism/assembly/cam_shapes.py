"""The shape of a cam, from the motion of what rides on it.

Everything stands in the axes of the cam's carrier, from the cam's axis, and is a function of the
angle that the cam has turned against the carrier; derivatives are by that angle.  Seen from the
cam the follower goes round it, and the cam is what the follower leaves: the curve of a knife's
edge, one that keeps a roller's radius away from the curve of its centre, or the envelope of a flat
face.  `docs/theory.md` derives the formulas.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from math import pi
from typing import Any, Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.formulas import cam_kernels as kernels
from equipoise.mechanism.formulas.kernels import cross, dot
from equipoise.signals import ROUNDING, highest_at

Array = np.ndarray[Any, Any]
Law = Callable[[Any], tuple[Any, Any, Any]]
"""Displacement and its two derivatives by the angle that the cam has turned."""

GRID = 3600
"""Angles of the cam among which the sharpest place is looked for."""
KNOT_OFFSET = 1e-7
"""rad: how far beside an angle at which a law changes is looked; nearer, rounding decides."""


@dataclass(frozen=True, eq=False)
class Ride:
    """What rides on the cam: a roller's centre, an edge, or a point of a flat face; arrays (N,).

    place, place_1, place_2 : m, complex.  turn_1, turn_2 : of the follower's angle.
    normal : unit vector of a flat face, away from the cam; else None.
    """

    place: Any
    place_1: Any
    place_2: Any
    turn_1: Any = 0.0
    turn_2: Any = 0.0
    normal: Any = None


class FollowerPath(Protocol):
    """How a follower moves in the carrier, by its displacement and the derivatives of that."""

    def ride(self, y: Any, y1: Any, y2: Any) -> Ride: ...

    def forth(self, at: Any) -> Any:
        """Unit vector along which the follower's material moves at a place, as it rises."""


@dataclass(frozen=True)
class Sliding:
    """A follower that slides along the unit vector `along`.

    rest : place of what rides on the cam where the displacement is 0.  normal : as of `Ride`.
    """

    along: complex
    rest: complex
    normal: complex | None = None

    def ride(self, y: Any, y1: Any, y2: Any) -> Ride:
        n = self.along
        return Ride(self.rest + n * y, n * y1, n * y2, normal=self.normal)

    def forth(self, at: Any) -> Any:
        return self.along


@dataclass(frozen=True)
class SwingingFollower:
    """A follower that turns about `pivot` by `sense` times its displacement.

    arm : from the pivot to what rides on the cam, and normal : as of `Ride`, both where the
    displacement is 0.
    """

    pivot: complex
    arm: complex
    sense: float
    normal: complex | None = None

    def ride(self, y: Any, y1: Any, y2: Any) -> Ride:
        turn = np.exp(1j * self.sense * y)
        w, a, arm = self.sense * y1, self.sense * y2, self.arm * turn
        normal = None if self.normal is None else self.normal * turn
        return Ride(self.pivot + arm, 1j * w * arm, (1j * a - w * w) * arm, w, a, normal)

    def forth(self, at: Any) -> Any:
        arm = at - self.pivot
        return 1j * self.sense * arm / abs(arm)


@dataclass(frozen=True, eq=False)
class CamShape:
    """A cam under its follower, at angles (N,), rad, that it has turned against its carrier.

    radius : of the roller, m; 0 of an edge or a flat face.
    """

    angle: Array
    path: FollowerPath
    law: Law
    radius: float = 0.0

    @cached_property
    def ride(self) -> Ride:
        return self.path.ride(*self.law(self.angle))

    @property
    def flat(self) -> bool:
        return self.ride.normal is not None

    @cached_property
    def contact(self) -> tuple[Array, Array]:
        """Where cam and follower touch, m, and the common normal, complex, from the cam's axis."""
        ride = self.ride
        touching: tuple[Array, Array] = (
            kernels.flat_contact(ride.place, ride.place_1, ride.turn_1, ride.normal)
            if self.flat
            else kernels.round_contact(ride.place, ride.place_1, self.radius)
        )
        return touching

    @property
    def surface(self) -> Array:
        """The cam's surface in the cam's own axes, from its axis; complex, m."""
        return self.contact[0] * self._back

    def offset_curve(self, away: float) -> Array:
        """The curve that keeps this distance, m, from `surface`; less than 0 inside of it.

        That of twice the roller's radius is the far flank of a groove.
        """
        at, normal = self.contact
        curve: Array = (at + away * normal) * self._back
        return curve

    @property
    def pitch(self) -> Array:
        """Curve of the roller's centre, or of the edge, in the cam's axes; complex, m."""
        curve: Array = self.ride.place * self._back
        return curve

    @property
    def _back(self) -> Array:
        return np.exp(-1j * self.angle)

    @property
    def pressure_angle(self) -> Array:
        """From the way in which the follower rises to the common normal (N,), rad."""
        at, normal = self.contact
        forth = self.path.forth(at if self.flat else self.ride.place)
        slant = np.arctan2(cross(forth, normal), dot(forth, normal))
        return np.broadcast_to(slant, np.broadcast_shapes(slant.shape, self.angle.shape))

    @property
    def curvature(self) -> Array:
        """Of the curve of roller or edge (N,), 1/m; positive where convex."""
        ride = self.ride
        bend: Array = kernels.round_curvature(ride.place, ride.place_1, ride.place_2)
        return bend

    @property
    def radius_of_curvature(self) -> Array:
        """Of the cam's surface (N,), m: positive where convex; zero and less where undercut."""
        ride = self.ride
        if self.flat:
            rates = ride.place_1, ride.place_2, ride.turn_1, ride.turn_2
            radius: Array = kernels.flat_radius(ride.place, *rates, ride.normal)
            return radius
        with np.errstate(divide="ignore"):
            return 1 / self.curvature - self.radius

    @property
    def surface_curvature(self) -> Array:
        """One over that (N,), 1/m: 0 where the surface is straight, less where it is hollow."""
        if self.flat:
            return 1 / self.radius_of_curvature
        return self.curvature / (1 - self.curvature * self.radius)

    def at(self, angle: Array) -> CamShape:
        """Shape of the cam at other angles."""
        return replace(self, angle=angle)


def design(value: Any, which: Any) -> Any:
    """What one design has, or some, of a number that may be a column (P, 1)."""
    return value[which] if np.ndim(value) else value


def lowest(
    shape: CamShape, value: Callable[[CamShape], Array], knots: Array
) -> tuple[float, float]:
    """Smallest value over a turn of the cam, and the angle (rad) of it.

    knots : angles at which the law changes, to both sides of which is looked.
    """
    around_knots = np.concatenate([knots - KNOT_OFFSET, knots + KNOT_OFFSET])
    angles = np.unique(np.concatenate([np.arange(GRID) * (2 * pi / GRID), around_knots % (2 * pi)]))
    width, best = 2 * pi / GRID, (np.inf, 0.0)
    for _ in range(4):
        with np.errstate(all="ignore"):
            result = np.broadcast_to(value(shape.at(angles)), angles.shape)
        values = np.nan_to_num(result, nan=-np.inf)
        k = int(highest_at(-values, smooth=False))
        if not values[k] >= best[0] - ROUNDING * abs(best[0]):  # else lower by rounding alone
            best = float(values[k]), float(angles[k])
        angles, width = best[1] + np.linspace(-width, width, 41), width / 18
    return best[0], best[1] % (2 * pi)
