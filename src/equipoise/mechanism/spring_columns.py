"""What a spring makes drive and joints bear, by its stiffness and its pull: linear in both.

With the vector d from the link's point to the frame's, a spring exerts k d + f d / |d|, where k is
its stiffness and f = -k l0 the pull that a free length l0 takes off.  So drive torque and joint
forces are those without the spring, plus k times the first row and f times the second.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.mechanism.dynamics import forces
from equipoise.mechanism.loads import demands_of
from equipoise.mechanism.model import Machine, unknown
from equipoise.mechanism.motion import Motion
from equipoise.mechanism.reactions import Demand, reactions
from equipoise.mechanism.spring import spring_direction, spring_vector

Array = np.ndarray[Any, Any]


def spring_columns(
    motion: Motion, link: str, point: str, to: str
) -> tuple[Array, dict[str, Array]]:
    """Drive torque (2, N) and the force in each joint by name (2, N), complex.

    First row: of a spring of 1 N/m without a free length; second row: of a pull of 1 N towards the
    frame's point; each alone.  Shaking force and moment, and force and moment on the frame, have
    nothing of a spring.  Gears press on the flank that all forces of the machine together choose.

    Raises
    ------
    MassError : there are gears, and a link has no mass given.
    ModelError : the ends meet, so that a pull has no direction.
    UsageError : there is no such link or point.
    """
    _check(motion.machine, link, point, to)
    units = np.stack([spring_vector(motion, point, to), spring_direction(motion, link, point, to)])
    zero = np.zeros(units.shape)
    demands: dict[str, Demand] = dict.fromkeys(motion.machine.links, (zero + 0j, zero))
    demands |= demands_of(motion, [(link, point, units, 0.0)])
    like = forces(motion).solved if motion.machine.gears else None
    solved = reactions(motion, demands, like)
    return solved.drive_torque, {name: joint.value for name, joint in solved.joints.items()}


def _check(machine: Machine, link: str, point: str, to: str) -> None:
    if link not in machine.links:
        raise UsageError(unknown(link, machine.links, "link"))
    points = machine.links[link].points
    if point not in points:
        raise UsageError(unknown(point, points, f"point of {link}"))
    if to not in machine.frame:
        raise UsageError(unknown(to, machine.frame, "point of the frame"))
