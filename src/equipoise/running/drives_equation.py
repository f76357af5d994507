"""The equations of motion of a machine of several drives, of which some follow from forces.

    M q.. + h = Q + T

Angles of drives with a motor, and of those that are free, are the unknowns; all others follow their
motion over the crank angle.  That is the angle of the first drive where it is such an unknown
itself, else it goes on evenly with time.  A drive with a given motion takes its torque T from
outside, as a servo motor that follows the crank would: nothing but its own link feels it.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from equipoise.codegen.drive_equations import DriveEquations, DriveState, drive_equations
from equipoise.dataclass import dataclass
from equipoise.errors import MassError, UsageError, at_place
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.dynamics.shares import ELEMENTS
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.machine import Machine
from equipoise.running.drivers import Driver
from equipoise.signals import Array


class DriveAngles(NamedTuple):
    """Angles of all drives (N,), rad, and their rates.

    crank_angle : rad.  speeds : rad/s.  slopes : by the crank angle, of given motions, 0 of others.
    bends : what given motions accelerate while the crank turns evenly, rad/s2, 0 of others.
    """

    crank_angle: Any
    angles: list[Any]
    speeds: list[Any]
    slopes: list[Any]
    bends: list[Any]


@dataclass(frozen=True, eq=False)
class DrivesEquation:
    """A machine as a function of the angles and speeds of its drives.

    start : crank angle at the start, rad, where it goes on with time.

    Raises
    ------
    MassError : a link has no mass given.
    UsageError : no drive moves freely, or something acts that a run of several drives lacks.
    """

    machine: Machine
    start: float = 0.0

    def __post_init__(self) -> None:
        if missing := massless(self.machine):
            raise MassError(missing)
        if not self.unknowns:
            raise UsageError(
                at_place(
                    "drive",
                    Note(
                        "every drive follows a given motion, so that there is nothing to "
                        "integrate; give one of them a motor, or `free = true`"
                    ),
                )
            )
        if reason := next(_lacking(self.machine), None):
            raise UsageError(at_place(*reason))

    @property
    def drives(self) -> tuple[Drive | FurtherDrive, ...]:
        """All of them; the first one has the crank angle."""
        return self.machine.driven

    @cached_property
    def unknowns(self) -> tuple[int, ...]:
        """Places of the drives whose angles follow from forces."""
        return tuple(k for k, drive in enumerate(self.drives) if drive.moves_freely)

    @cached_property
    def given(self) -> tuple[int, ...]:
        """Places of those that follow their motion."""
        return tuple(k for k in range(len(self.drives)) if k not in self.unknowns)

    @cached_property
    def by_crank(self) -> bool:
        """Whether the crank angle is an unknown, and not a matter of time."""
        return 0 in self.unknowns and self.machine.crank_turns

    @cached_property
    def program(self) -> DriveEquations:
        """What the machine's steps come to."""
        causes = {cause: f"{cause}s" for cause in ELEMENTS}
        return drive_equations(assemble(self.machine), causes)

    @cached_property
    def rotors(self) -> tuple[float, ...]:
        """Moment of inertia that turns with each drive, as its link feels it, kg m2."""
        motors = (drive.motor for drive in self.drives)
        each = [0.0 if motor is None else motor.ratio**2 * motor.inertia for motor in motors]
        each[0] += self.machine.drive.flywheel
        return tuple(each)

    @property
    def nominal_speeds(self) -> list[float]:
        """Of each drive at crank angle 0, at the speed of the file, rad/s; of one whose motion
        begins at rest that of the crank.
        """
        crank = self.machine.drive.speed
        rates = [float(np.ravel(drive.turned(np.zeros(1))[1])[0]) for drive in self.drives]
        return [rate * crank or crank for rate in rates]

    def drivers(self) -> list[Driver]:
        """Of each drive, what turns it, at its start."""
        brakes = [self.machine.drive.brake, *[0.0] * len(self.machine.drives)]
        each = zip(self.drives, self.nominal_speeds, brakes, strict=True)
        return [Driver(drive.motor, speed, brake) for drive, speed, brake in each]

    def placed(self, time: Any, angles: Sequence[Any], speeds: Sequence[Any]) -> DriveAngles:
        """All drives at a time, s, or times, by the angles and speeds of the unknowns."""
        pace = speeds[0] if self.by_crank else self.machine.drive.speed
        crank = angles[0] if self.by_crank else self.start + pace * time
        whole = DriveAngles(crank, *([0.0] * len(self.drives) for _ in range(4)))
        for k, angle, speed in zip(self.unknowns, angles, speeds, strict=True):
            whole.angles[k], whole.speeds[k] = angle, speed
        for k in self.given:
            angle, first, second = self.drives[k].turned(crank)
            whole.angles[k], whole.speeds[k] = angle, first * pace
            whole.slopes[k], whole.bends[k] = first, second * pace**2
        return whole

    def at(self, time: float, since: float, where: DriveAngles) -> DriveState | None:
        """The equations in a state; None where the machine cannot be.

        since : an instant, s, after which loads over time follow the line that counts.
        """
        program = self.program
        crank = np.array([where.crank_angle if program.loads else 0.0])
        loads = (float(np.ravel(load(crank))[0]) for load in program.loads)
        factors = (float(load.line_after(since)(time)) for load in self.machine.timed_loads)
        numbers = (*where.angles, *where.speeds, *loads, *factors)
        return program.at(*map(float, numbers))

    def accelerations(
        self, state: DriveState, where: DriveAngles, torques: Sequence[float]
    ) -> list[float]:
        """Of all drives (N,), rad/s2, with torques (N,) on those that are unknown, N m."""
        inertia = [[*row] for row in state.inertia]
        for k, rotor in enumerate(self.rotors):
            inertia[k][k] += rotor
        left, right = [], []
        for row in self.unknowns:
            acting = sum(force[row] for force in state.forces) + torques[row] - state.bias[row]
            bent = sum(inertia[row][k] * where.bends[k] for k in self.given)
            left.append([inertia[row][k] for k in self.unknowns])
            right.append(acting - bent)
            if self.by_crank:
                left[-1][0] += sum(inertia[row][k] * where.slopes[k] for k in self.given)
        found = _solved(left, right)
        whole = [*where.bends]
        for k, value in zip(self.unknowns, found, strict=True):
            whole[k] = value
        if self.by_crank:
            for k in self.given:
                whole[k] += where.slopes[k] * found[0]
        return whole

    def given_torques(self, state: DriveState, accelerations: Sequence[float]) -> dict[int, float]:
        """Of the drives with a given motion, N m, by their places."""
        each = {}
        for k in self.given:
            demand = sum(m * a for m, a in zip(state.inertia[k], accelerations, strict=True))
            demand += self.rotors[k] * accelerations[k] + state.bias[k]
            each[k] = demand - sum(force[k] for force in state.forces)
        return each

    def energy(self, angles: Array, speeds: Array) -> Array:
        """Kinetic energy (K,), J, of all drives at angles and speeds (N, K)."""
        inertia = self.program.inertia(angles)
        own = np.einsum("ik,ijk,jk->k", speeds, inertia, speeds)
        return np.asarray((own + np.array(self.rotors) @ speeds**2) / 2)


def _solved(left: list[list[float]], right: list[float]) -> list[float]:
    """Solution of few linear equations by elimination, for which an inertia needs no search for
    pivots.
    """
    count = len(right)
    for k in range(count):
        for row in range(k + 1, count):
            share = left[row][k] / left[k][k]
            left[row] = [own - share * other for own, other in zip(left[row], left[k], strict=True)]
            right[row] -= share * right[k]
    found = [0.0] * count
    for k in reversed(range(count)):
        rest = sum(left[k][j] * found[j] for j in range(k + 1, count))
        found[k] = (right[k] - rest) / left[k][k]
    return found


def _lacking(machine: Machine) -> Any:
    """What a run of several drives does not compute, with its place in the file."""
    if machine.rows:
        yield "rows", Note("a run of several drives computes one row; leave the others out")
    if machine.rubs:
        yield (
            "joints",
            Note(
                "a run of several drives computes no friction in joints; leave it out, or give "
                "[[resistances]] and [[torsion_dampers]]"
            ),
        )
    if machine.in_soil:
        yield "planting.soil", Note("a run of several drives computes no soil; leave it out")
