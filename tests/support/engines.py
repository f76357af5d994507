"""What every rigid-body engine is asked: shaking force, shaking moment and drive torque."""

from __future__ import annotations

from collections.abc import Callable

from equipoise.mechanism.parts.machine import Machine
from support.analyses import Subject, agree, force_size, moment_size, vector
from support.mujoco_engine import Totals
from support.poses import Poses

TOLERANCE = 1e-9
TOTALS = "shaking force, shaking and rocking moment, drive torque"
FLOOR = 1e-3
"""Part of the size of all forces below which an output counts as vanishing (balanced machines)."""

Engine = Callable[[Machine, Poses], Totals]


def same_totals(subject: Subject, engine: Engine) -> float:
    """Compare the outputs of a machine with those of an engine; tell how far they are apart."""
    machine, poses, forces = subject.machine, subject.poses, subject.forces
    reported = engine(machine, poses)
    force, moment = FLOOR * force_size(machine, poses), FLOOR * moment_size(machine, poses)
    # engines tell the work of all drives by crank angle
    torque = sum(forces.drives[d.link] * poses.omega[d.link] for d in machine.driven)
    torque = (forces.power if machine.pushers else torque) / machine.drive.speed
    across = subject.forces.across
    return max(
        agree("rocking", vector(across.rocking_moment), reported.rocking_moment, TOLERANCE, moment),
        agree(
            "shaking force", vector(forces.shaking_force), reported.shaking_force, TOLERANCE, force
        ),
        agree("shaking moment", forces.shaking_moment, reported.shaking_moment, TOLERANCE, moment),
        agree("drive torque", torque, reported.drive_torque, TOLERANCE, moment),
    )
