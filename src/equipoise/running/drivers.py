"""What turns the crank: a motor by its curve, while it is switched on."""

from __future__ import annotations

from math import copysign

import numpy as np

from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import Array
from equipoise.vibration.steady import torque_on_crank


class Driver:
    """The drive of a machine: its torque on the crank by the crank's speed.

    sense : 1 where it turns the crank counterclockwise, -1 clockwise.  on : whether it is on.
    """

    def __init__(self, machine: Machine) -> None:
        drive = machine.drive
        self.sense = copysign(1.0, drive.speed)
        self.on = drive.motor is not None
        self._torque = torque_on_crank(drive, drive.speed) if self.on else None

    def torque(self, speed: Array) -> Array:
        """On the crank (...), N m, at its speed (...), rad/s."""
        if self._torque is None or not self.on:
            return np.zeros_like(speed)
        return self._torque(speed, np.zeros(()))
