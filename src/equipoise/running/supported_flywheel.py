"""Steady states of a machine on its support, for which a flywheel is sized."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf, pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ResponseError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.parts.force_elements import Motor
from equipoise.mechanism.parts.machine import Machine
from equipoise.running.equation import CrankEquation
from equipoise.signals import Array
from equipoise.vibration.coupled import StallError
from equipoise.vibration.exact import solve_exact
from equipoise.vibration.forced import chosen_model

EVEN, FAR = 1e-7, 1e3
"""Share of the difference from its speed that a crank loses in a turn under a torque that is as
good as constant; speed over that of the crank at which that torque would have fallen to 0."""


@dataclass(eq=False)
class SupportedCycles:
    """Steady states of a machine whose support moves in the plane, by the exact equations; under a
    constant torque at the mean speed of its drive where it has no motor.

    slower : the speed of the drive over the mean speed with the motor, of the last one.

    Raises
    ------
    ModelError, UsageError : the exact model is not for such a machine.
    """

    machine: Machine
    slower: float = 1.0
    guess: Callable[[Array], Array] | None = None

    def __post_init__(self) -> None:
        if self.machine.support is not None and not self.machine.support.planar:
            raise UsageError(
                Note(
                    "a flywheel is sized on a support that moves in the plane of the drawing; "
                    "leave out the fluctuation or the support"
                )
            )
        drive = self.machine.drive
        motor = drive.motor and replace(drive.motor, mean_speed="free")
        self.machine = replace(self.machine, drive=replace(drive, motor=motor or self._even_motor))
        chosen_model(self.machine, "exact", drive=True)

    @property
    def _even_motor(self) -> Motor:
        inertia = float(np.mean(CrankEquation(self.machine).table.values[0]))
        speed = abs(self.machine.drive.speed)
        slope = EVEN * inertia * speed / (2 * pi)
        return Motor(FAR * speed, slope * FAR * speed, mean_speed="held")

    def fluctuation(self, added: float) -> float:
        """Highest less lowest speed over the mean, with an inertia, kg m2, on the crank beside its
        own; infinite where the motor stalls.

        Raises
        ------
        ResponseError : no steady state is met.
        """
        drive = self.machine.drive
        machine = replace(self.machine, drive=replace(drive, flywheel=drive.flywheel + added))
        solution = None
        if self.guess is not None:
            try:
                solution = solve_exact(machine, drive.speed, True, self.guess, patient=False)
            except ResponseError:
                self.guess = None
        try:
            solution = solution or solve_exact(machine, drive.speed, True)
        except StallError:
            return inf
        self.guess, self.slower = solution.steady.orbit.at, drive.speed / solution.speed
        readings = solution.response(brief=True).drive
        return readings.fluctuation
