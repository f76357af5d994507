"""A spring between link and frame: its stiffness, and its pull where it would have no length.

Its force k (l - l0) is linear in the stiffness k and in the constant pull k l0.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.balancing.design_variables import Bound, Change, DesignVariables, Square
from equipoise.balancing.program import Affine, Program
from equipoise.mechanism.balance import SpringChoice
from equipoise.mechanism.model import Machine
from equipoise.mechanism.motion import Motion
from equipoise.mechanism.spring import Spring
from equipoise.mechanism.spring_columns import spring_columns

Array = np.ndarray[Any, Any]

NOTHING = 1e-6
"""Over the most: stiffness, and its product with the free length, that are none."""
LONGEST = 2.0
"""Free length over the largest distance of points, where none is given: longer and softer springs
would pull ever more evenly, and have no end."""


class FreeSpring(DesignVariables):
    """Two numbers: stiffness over the most, and stiffness times free length over the most times a
    length.
    """

    count = 2

    def __init__(self, machine: Machine, choice: SpringChoice) -> None:
        self.link, self.choice = choice.link, choice
        place = complex(*machine.frame[choice.to])
        sizes = [abs(complex(*p) - place) for p in machine.frame.values()]
        sizes += [abs(complex(*p)) for p in machine.links[choice.link].points.values()]
        self.length = max(choice.free_length or sizes) or 1.0

    @property
    def effect(self) -> Array:
        return np.zeros((2, 4))

    @property
    def _units(self) -> Array:
        """Stiffness, N/m, and constant pull, N, of a unit of each number."""
        return np.array([self.choice.stiffness, self.choice.stiffness * self.length])

    def constrain(self, program: Program, places: Array) -> list[Square]:
        k, pull = map(int, places)
        slope = Affine.of([], np.zeros((1, 0)), 1 / self.choice.stiffness)
        program.nonnegative(Affine.of(k, 1.0))
        program.nonnegative(Affine.of(k, -1.0, 1.0), self._name, slope)
        low, high = self.choice.free_length or (0.0, LONGEST * self.length)
        program.nonnegative(Affine.of([k, pull], [-low / self.length, 1.0]))
        program.nonnegative(Affine.of([k, pull], [high / self.length, -1.0]))
        return []

    @property
    def _name(self) -> str:
        return f"stiffness on {self.link}"

    def bounds(self, numbers: Array) -> list[Bound]:
        most = self.choice.stiffness
        return [Bound(self._name, most, float(numbers[0]) * most, "N/m")]

    def stopped(self, numbers: Array) -> str:
        longest = LONGEST * float(numbers[0])
        if self.choice.free_length is not None or not 0 < 0.999 * longest < float(numbers[1]):
            return ""
        return (
            f"the spring on {self.link} has come to twice the largest distance of points, "
            "where its free length was stopped; give it free_length"
        )

    def columns(self, motion: Motion, output: str) -> Array:
        """Effect (2, N) on the drive's torque or on a joint's force."""
        choice = self.choice
        torque, joints = spring_columns(motion, choice.link, choice.point, choice.to)
        found = torque if output == "drive_torque" else joints[output.removeprefix("joints.")]
        units = self._units * np.array([1.0, -1.0])  # the pull is towards the frame's point
        return np.asarray(found * units[:, None])

    def spring(self, numbers: Array) -> Spring | None:
        """The spring, or None where there is to be none."""
        stiffness, pull = numbers * self._units
        if np.max(numbers) < NOTHING:
            return None
        choice = self.choice
        free = float(pull / stiffness)
        free = free if free > NOTHING * self.length else 0.0
        return Spring(choice.link, choice.point, choice.to, float(stiffness), free)

    def changes(self, numbers: Array) -> list[Change]:
        spring = self.spring(numbers)
        values: dict[str, Any] = {"point": self.choice.point, "to": self.choice.to}
        values["stiffness"] = 0.0 if spring is None else spring.stiffness
        values["free_length"] = 0.0 if spring is None else spring.free_length
        return [Change("spring", self.link, values)]
