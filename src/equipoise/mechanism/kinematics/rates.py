"""Motion of one link, point or slider: by crank angle, and what that is in time."""

from __future__ import annotations

from equipoise.dataclass import dataclass
from equipoise.displays import Brief
from equipoise.mechanism.assembly.steps import Array


def in_time(first: Array, second: Array, speed: float, acceleration: float) -> Array:
    """Second derivative by time, from the derivatives by crank angle."""
    steady = second * speed**2
    return steady + first * acceleration if acceleration else steady


@dataclass(frozen=True, eq=False, repr=False)
class LinkMotion(Brief):
    """Motion of one link; every array (N,).

    angle : rad, counted on through the turns.
    angle_1, angle_2 : first and second derivative by crank angle (kinematic coefficients).
    """

    angle: Array
    angle_1: Array
    angle_2: Array
    speed: float
    acceleration: float

    @property
    def angular_velocity(self) -> Array:
        """rad/s."""
        return self.angle_1 * self.speed

    @property
    def angular_acceleration(self) -> Array:
        """rad/s2."""
        return in_time(self.angle_1, self.angle_2, self.speed, self.acceleration)


@dataclass(frozen=True, eq=False, repr=False)
class PointMotion(Brief):
    """Motion of one point; complex arrays (N,), x + i y.

    place : m.  place_1, place_2 : first and second derivative by crank angle, m.  The parts x and
    y of place (m), velocity (m/s) and acceleration (m/s2) are real.
    """

    place: Array
    place_1: Array
    place_2: Array
    speed: float
    acceleration: float

    @property
    def x(self) -> Array:
        return self.place.real

    @property
    def y(self) -> Array:
        return self.place.imag

    @property
    def velocity(self) -> Array:
        """m/s, complex."""
        return self.place_1 * self.speed

    @property
    def acceleration_vector(self) -> Array:
        """m/s2, complex."""
        return in_time(self.place_1, self.place_2, self.speed, self.acceleration)

    @property
    def vx(self) -> Array:
        return self.velocity.real

    @property
    def vy(self) -> Array:
        return self.velocity.imag

    @property
    def ax(self) -> Array:
        return self.acceleration_vector.real

    @property
    def ay(self) -> Array:
        return self.acceleration_vector.imag


@dataclass(frozen=True, eq=False, repr=False)
class SliderMotion(Brief):
    """Motion along the guide of a sliding joint; arrays (N,).

    travel : m, of the slider's point from the guide's point along the guide's direction.
    travel_1, travel_2 : first and second derivative by crank angle, m.
    """

    travel: Array
    travel_1: Array
    travel_2: Array
    speed: float
    acceleration: float

    @property
    def velocity(self) -> Array:
        """m/s, as seen from the guide."""
        return self.travel_1 * self.speed

    @property
    def along_acceleration(self) -> Array:
        """m/s2, as seen from the guide."""
        return in_time(self.travel_1, self.travel_2, self.speed, self.acceleration)
