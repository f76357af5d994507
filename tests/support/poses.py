"""Where every link is and how it moves: the only thing the second routes take from a motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from equipoise.mechanism.parts.machine import FRAME, Machine, Vector

Array = NDArray[Any]


def turned(angle: Array | float, vector: Vector) -> Array:
    """Return a vector of a body's axes in the frame's axes, (N, 2)."""
    cos, sin = np.cos(angle), np.sin(angle)
    x, y = vector
    return np.stack([cos * x - sin * y, sin * x + cos * y], -1)


def quarter(vector: Array) -> Array:
    """Return vectors turned by a right angle, counterclockwise."""
    return np.stack([-vector[..., 1], vector[..., 0]], -1)


def cross(a: Array, b: Array) -> Array:
    """Return the component out of the plane of the product of planar vectors."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


@dataclass(frozen=True)
class Poses:
    """Origins (N, 2) and angles (N,) of all links with their first and second time derivatives."""

    crank_angle: Array
    origin: Mapping[str, Array]
    velocity: Mapping[str, Array]
    acceleration: Mapping[str, Array]
    angle: Mapping[str, Array]
    omega: Mapping[str, Array]
    alpha: Mapping[str, Array]

    def turned(self, body: str, vector: Vector) -> Array:
        """Return a vector of a link's or the frame's axes in the frame's axes."""
        return turned(self.angle_of(body), vector)

    def angle_of(self, body: str) -> Array:
        """Return the angle of a link, or zeros for the frame."""
        return np.zeros_like(self.crank_angle) if body == FRAME else self.angle[body]

    def place(self, body: str, local: Vector) -> Array:
        """Return the position of a point given in the axes of a body."""
        offset = self.turned(body, local)
        return offset if body == FRAME else self.origin[body] + offset

    def speed(self, body: str, local: Vector) -> Array:
        """Return the velocity of a point given in the axes of a link."""
        arm = self.turned(body, local)
        return self.velocity[body] + self.omega[body][:, None] * quarter(arm)

    def change(self, body: str, local: Vector) -> Array:
        """Return the acceleration of a point given in the axes of a link."""
        arm = self.turned(body, local)
        swing = self.alpha[body][:, None] * quarter(arm)
        return self.acceleration[body] + swing - self.omega[body][:, None] ** 2 * arm


def from_motion(machine: Machine, motion: Any) -> Poses:
    """Read the poses off a motion: of each link its angle and its first point."""
    origin, velocity, acceleration = {}, {}, {}
    angle = {name: motion.links[name].angle for name in machine.links}
    omega = {name: motion.links[name].angular_velocity for name in machine.links}
    alpha = {name: motion.links[name].angular_acceleration for name in machine.links}
    for name, link in machine.links.items():
        label, local = next(iter(link.points.items()))
        point, arm = motion.points[label], turned(angle[name], local)
        w, a = omega[name][:, None], alpha[name][:, None]
        origin[name] = np.stack([point.x, point.y], -1) - arm
        velocity[name] = np.stack([point.vx, point.vy], -1) - w * quarter(arm)
        acceleration[name] = np.stack([point.ax, point.ay], -1) - a * quarter(arm) + w**2 * arm
    return Poses(motion.crank_angle, origin, velocity, acceleration, angle, omega, alpha)


def pins(machine: Machine) -> dict[str, list[str]]:
    """Return the bodies at each shared point, the frame first and then in the file's order."""
    bodies = [FRAME, *machine.links]
    labels = [label for body in bodies for label in machine.points_of(body)]
    at = {label: [b for b in bodies if label in machine.points_of(b)] for label in labels}
    return {label: sharing for label, sharing in at.items() if len(sharing) > 1}


def drive_pivot(machine: Machine) -> str:
    """Return the name of the point at which the drive link is pinned to the frame."""
    points = machine.links[machine.drive.link].points
    return next(label for label in points if label in machine.frame)


def pin_between(machine: Machine, item: str, other: str) -> str:
    """Return the name of the point that two bodies share."""
    others = machine.points_of(other)
    return next(label for label in machine.points_of(item) if label in others)
