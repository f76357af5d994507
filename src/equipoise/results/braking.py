"""Machines whose motor has to brake in the mean, because what acts on them drives them."""

from __future__ import annotations

from collections.abc import Iterator
from math import copysign

from equipoise.i18n import Note
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.quantities import format_quantity
from equipoise.results.outputs import AnalysisOutputs

LEAST_SHARE = 1e-3
"""Of the RMS of the drive torque; a smaller mean is rounding, as of masses alone, whose mean is 0.
"""


def braking_motor(motion: Motion, outputs: AnalysisOutputs) -> Iterator[Note]:
    """That the motor brakes, which seldom is meant: a load with the wrong sign looks like that."""
    machine = motion.machine
    name = f"rows.{machine.drive.effort}"
    name = name if name in outputs else machine.drive.effort
    if machine.drive.motor is None or not machine.has_crank or name not in outputs:
        return
    if not motion.whole_cycle:
        return
    figures = outputs[name].figures
    mean = copysign(1.0, machine.drive.speed) * figures.mean
    if mean < -LEAST_SHARE * figures.rms:
        yield Note(
            "what acts on the links drives the machine: in the mean its motor has to brake, with "
            "{torque} at the crank; if loads should resist, change their signs or that of the "
            "speed",
            torque=format_quantity(-mean, "torque"),
        )
