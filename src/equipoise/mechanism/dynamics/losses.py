"""What friction in joints costs in a cycle: losses, efficiency, and the work that wears."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.dynamics.forces import Forces
from equipoise.mechanism.dynamics.reduced import generalized_force

NOTHING = 1e-9
"""Share of the power that goes through a machine below which the rest is rounding."""


@dataclass(frozen=True)
class JointLoss:
    """What one joint costs in the mean of a cycle.

    loss : power, W.  wear_work : contact force times sliding way in a turn of the crank, J.
    """

    loss: float
    wear_work: float


@dataclass(frozen=True)
class Losses:
    """Powers of a cycle in the mean, W.

    joints : by name.  drive : that all drives give.  loads : that loads and soil give; below 0
        where they take it.
    """

    joints: Mapping[str, JointLoss]
    drive: float
    loads: float

    @property
    def loss(self) -> float:
        """That all joints lose."""
        return sum(joint.loss for joint in self.joints.values())

    @property
    def efficiency(self) -> float | None:
        """Share of the power given that is taken at the other end, from drive to loads or from
        loads to drive; None where nothing takes any.
        """
        given, taken = max(self.drive, self.loads), -min(self.drive, self.loads)
        return taken / given if taken > NOTHING * given > 0 else None


def losses_of(forces: Forces) -> Losses | None:
    """Losses of a whole cycle; None where no joint has any, the crank is not turned evenly, or the
    crank angles are not those of a whole cycle.
    """
    motion = forces.motion
    if not forces.frictions or not motion.is_steady_cycle:
        return None
    turn = 2 * pi / abs(motion.speed)
    joints = {
        name: JointLoss(
            float(motion.mean(friction.loss)), float(motion.mean(friction.sliding_power)) * turn
        )
        for name, friction in forces.frictions.items()
    }
    loads = np.asarray(generalized_force(motion, forces.loads) * motion.speed)
    return Losses(joints, float(motion.mean(forces.power)), float(motion.mean(loads)))
