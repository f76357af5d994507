"""Machines whose motor has to brake in the mean, because what acts on them drives them."""

from __future__ import annotations

from collections.abc import Iterator

from equipoise.i18n import Note
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.quantities import format_quantity
from equipoise.results.motor_torque import LEAST_MEAN, motor_torque
from equipoise.results.outputs import AnalysisOutputs


def braking_motor(motion: Motion, outputs: AnalysisOutputs) -> Iterator[Note]:
    """That the motor brakes, which seldom is meant: a load with the wrong sign looks like that."""
    driven = motor_torque(motion.machine, outputs)
    if driven is None or not motion.whole_cycle:
        return
    torque, mean = driven
    if mean < -LEAST_MEAN * torque.figures.rms:
        yield Note(
            "what acts on the links drives the machine: in the mean its motor has to brake, with "
            "{torque} at the crank; if loads should resist, change their signs or that of the "
            "speed",
            torque=format_quantity(-mean, "torque"),
        )
