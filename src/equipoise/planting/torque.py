"""Drive torque and joint forces with the soil and without it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from equipoise.mechanism.dynamics import Forces, forces, massless
from equipoise.mechanism.model import Machine
from equipoise.mechanism.motion import Motion, move
from equipoise.signals import Figures, figures

Array = np.ndarray[Any, Any]


@dataclass(frozen=True, eq=False)
class SoilForces:
    """Forces of a machine in the soil, and of the same machine in the air.

    motion : what both belong to.  in_soil, in_air : their forces.
    """

    motion: Motion
    in_soil: Forces
    in_air: Forces

    def compared(self) -> dict[str, tuple[Figures, Figures]]:
        """Figures in the air and in the soil of the drive torque and of every joint's force."""
        air, soil = _signals(self.in_air), _signals(self.in_soil)
        angles = self.motion.crank_angle
        return {name: (figures(angles, air[name]), figures(angles, soil[name])) for name in air}


def soil_forces(machine: Machine, angles: int = 720) -> SoilForces | None:
    """Forces in the soil and in the air; None where no soil or not every mass is given."""
    planting = machine.planting
    if planting is None or planting.soil is None or massless(machine):
        return None
    motion = move(machine, angles)
    dry = replace(motion, linkage=motion.linkage.of(machine.with_planting(soil=None)))
    return SoilForces(motion, forces(motion), forces(dry))


def _signals(found: Forces) -> dict[str, Array]:
    joints = {f"joints.{name}": joint.size for name, joint in found.joints.items()}
    return {"drive_torque": found.drive_torque, **joints}
