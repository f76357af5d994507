"""The torque that a motor has to give, and what of its mean is rounding."""

from __future__ import annotations

from math import copysign

from equipoise.mechanism.parts.machine import Machine
from equipoise.results.outputs import AnalysisOutput, AnalysisOutputs

LEAST_MEAN = 0.01
"""Of the RMS of a torque: less is what samples of narrow peaks leave of a mean that is 0, as of a
machine that swings near a dead position and does no work, or on which only masses act."""


def motor_torque(machine: Machine, outputs: AnalysisOutputs) -> tuple[AnalysisOutput, float] | None:
    """The drive torque of all rows of a machine with a motor, and its mean, N m, in the direction
    in which the crank turns: less than 0 where the motor brakes; None where there is none.
    """
    name = f"rows.{machine.drive.effort}"
    name = name if name in outputs else machine.drive.effort
    if machine.drive.motor is None or not machine.has_crank or name not in outputs:
        return None
    torque = outputs[name]
    return torque, copysign(1.0, machine.drive.speed) * torque.figures.mean
