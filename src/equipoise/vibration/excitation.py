"""What linkages do to the support that carries them: wrench by orders, mass and weight."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace
from functools import cached_property, reduce
from operator import add

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.dynamics.forces import Forces, forces
from equipoise.mechanism.dynamics.loads import outer_loads, soil_loads
from equipoise.mechanism.dynamics.reactions import demands_of
from equipoise.mechanism.formulas.kernels import cross
from equipoise.mechanism.kinematics.jumps import resolved
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.links import moments_across
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.signals import Array, Periodic
from equipoise.vibration.body import SupportBody, moved
from equipoise.vibration.linkages import rows_of, spread
from equipoise.vibration.response import ExcitationModel

ANGLES = 720
"""Crank angles in a turn from which orders are taken; more where loads have kinks."""


def motion_of(machine: Machine) -> Motion:
    """Motion of one linkage at constant speed, from which orders are taken, jumps resolved."""
    sharp = bool(machine.loads) or machine.in_soil
    usual = resolved(move(machine, ANGLES, acceleration=0.0))
    if usual.sampling is None and sharp:  # tables have kinks, whose orders fall slowly
        return move(machine, ANGLES * 8, acceleration=0.0)
    return usual


@dataclass(frozen=True, eq=False)
class SupportExcitation(ABC):
    """Wrench of all linkages on the support, and where their mass and weight are."""

    body: SupportBody

    @property
    @abstractmethod
    def model(self) -> ExcitationModel:
        """The model that this is, by name."""

    @property
    @abstractmethod
    def rocks(self) -> bool:
        """Whether linkages rock the support out of the plane of the drawing."""

    @abstractmethod
    def _mass_of(self, row: Row) -> Array:
        """Mass matrix (6, 6) of the linkage of a row."""

    @abstractmethod
    def _center_of(self, row: Row) -> Array:
        """Where the weight of a row acts (3,), m."""

    @abstractmethod
    def _moment(self, forces: Forces) -> Array:
        """Moment (N,) on the support about the drive's pivot, N m."""

    @property
    def machine(self) -> Machine:
        return self.body.machine

    @cached_property
    def motion(self) -> Motion:
        return motion_of(self.machine)

    @cached_property
    def pivot(self) -> complex:
        """The drive's pivot in the frame."""
        return complex(*self.machine.frame[self.motion.linkage.pivot])

    def pivot_of(self, row: Row) -> Array:
        """The drive's pivot (3,) of a row, m."""
        x, y = row.offset
        return np.array([self.pivot.real + x, self.pivot.imag + y, row.lateral])

    @cached_property
    def mass(self) -> Array:
        """Mass matrix (6, 6) of the linkages."""
        total = np.zeros((6, 6))
        for row in rows_of(self.machine):
            total += self._mass_of(row)
        return total

    @cached_property
    def weights(self) -> list[tuple[Array, Array]]:
        """Weight (3,), N, and where it acts (3,), m, of the support and of each row."""
        gravity = np.array([*self.machine.gravity, 0.0])
        support = self.body.support
        pairs = [(support.mass * gravity, np.array(support.center_of_mass))]
        rows = rows_of(self.machine)
        return [*pairs, *((self.machine.mass * gravity, self._center_of(row)) for row in rows)]

    @property
    def across(self) -> float:
        """Sum of mass times plane, kg m."""
        links = self.machine.links.values()
        return float(sum(moments_across(link)[0] for link in links))

    def at(self, speed: float) -> Periodic:
        """Wrench (6, K + 1) about the support's reference point at a speed, rad/s.

        Without the weight itself, which the mounts carry at rest.
        """
        if self.machine.in_soil:
            return self._of_rows(self._on_pivot(speed).amplitudes)
        still, moving = self._by_square
        return Periodic(still + speed**2 * moving, self.motion.turns)

    def at_orders(self, speeds: Array, places: Array) -> Array:
        """Wrenches (6, S) at speeds (S,), rad/s, of one order each, by its place (S,) in `at`."""
        if self.machine.in_soil:
            return self._of_orders_in_soil(speeds, places)
        still, moving = self._by_square
        return np.asarray(still[:, places] + speeds**2 * moving[:, places])

    def _of_orders_in_soil(self, speeds: Array, places: Array) -> Array:
        """`at_orders` where the soil's force follows the speed in its own way, all else its square.

        The wrench is linear in the force at each angle, so that no joint force is solved again.
        """
        still, first = (self._without_soil(speed) for speed in (0.0, 1.0))
        parts = np.stack([still, first - still])
        columns = np.empty((6, len(speeds)), complex)
        for k, (speed, place) in enumerate(zip(speeds.tolist(), places.tolist(), strict=True)):
            motion = self.motion.at(speed)
            wrench = parts[0] + speed**2 * parts[1] + self._of_soil(motion)
            column = self.motion.amplitude(wrench, place)[:, None]
            turned = np.exp(1j * place / self.motion.turns * self._phases)
            rows = zip(turned, rows_of(self.machine), strict=True)
            columns[:, k] = sum(
                turn * self.about_reference(column, row)[:, 0] for turn, row in rows
            )
        return columns

    @cached_property
    def _phases(self) -> Array:
        return np.array([row.phase for row in rows_of(self.machine)])

    def _without_soil(self, speed: float) -> Array:
        """What `_signals` would be at a speed without the force of the soil, (5, N)."""
        motion = self.motion.at(speed)
        return self._signals(motion) - self._of_soil(motion)

    def _of_soil(self, motion: Motion) -> Array:
        """What the force of the soil adds to `_signals`, (5, N)."""
        added = np.zeros((5, len(motion.crank_angle)))
        for (_, _, force, _), (along_x, along_y) in zip(
            soil_loads(motion), self._of_unit_forces, strict=True
        ):
            added += along_x * force.real + along_y * force.imag
        return added

    @cached_property
    def _of_unit_forces(self) -> list[tuple[Array, Array]]:
        """What 1 N on each tip along x, and along y, adds to `_signals`, (5, N) each."""
        motion = self.motion.at(0.0)
        present = self._outer(motion)
        loads, before = [*outer_loads(motion)], self._signals_of(present)
        pairs = []
        for link, tip, _, _ in soil_loads(motion):
            added = []
            for unit in (1.0, 1j):
                force = np.full(len(motion.crank_angle), unit, complex)
                demands = demands_of(motion, [*loads, (link, tip, force, 0.0)])
                value = self._signals_of(replace(present, loads=demands)) - before
                if self.rocks:  # `across` asks the machine for its loads
                    couple = 1j * self.machine.links[link].plane_of(tip) * unit
                    value[3:] = [[couple.real], [couple.imag]]
                added.append(value)
            pairs.append((added[0], added[1]))
        return pairs

    @cached_property
    def _by_square(self) -> tuple[Array, Array]:
        """The wrench (6, K + 1) at rest, and what is added to it with the square of the speed."""
        still, moving = (self._of_rows(part).amplitudes for part in self._parts)
        return still, moving

    def _of_rows(self, on_pivot: Array) -> Periodic:
        """Wrench of all rows, of what one linkage does on its pivot (5, K + 1)."""
        turns = self.motion.turns
        rows = (
            Periodic(self.about_reference(on_pivot, row), turns).shifted(row.phase)
            for row in rows_of(self.machine)
        )
        return reduce(add, rows)

    def samples(self, theta: Array, speed: float) -> Array:
        """Wrenches (6, P) at crank angles (P,), rad, not by orders."""
        total: Array = np.zeros((6, len(theta)))
        for row in rows_of(self.machine):
            motion = move(self.machine, theta + row.phase, speed, 0.0)
            total = total + self.about_reference(self._signals(motion), row)
        return total

    def of_one(self, speed: float) -> Periodic:
        """Excitation by one linkage alone, as the file has it."""
        wrench = self.about_reference(self._on_pivot(speed).amplitudes, Row())
        return Periodic(wrench, self.motion.turns)

    def about_reference(self, on_pivot: Array, row: Row) -> Array:
        """Force along x and y, moment about the pivot of a row, and moments about x and y that act
        in its plane, (5, N), as a wrench (6, N).
        """
        force = np.zeros((on_pivot.shape[1], 3), on_pivot.dtype)
        force[:, :2] = on_pivot[:2].T
        wrench = self.body.wrench(force, self.pivot_of(row))
        wrench[:, 5] += on_pivot[2]
        wrench[:, 3:5] += on_pivot[3:].T
        return wrench.T

    def _on_pivot(self, speed: float) -> Periodic:
        """What one linkage does, as `about_reference` takes it; (5, K + 1)."""
        if self.machine.in_soil:
            return self.motion.periodic(self._signals(self.motion.at(speed)))
        still, moving = self._parts
        return Periodic(still + speed**2 * moving, self.motion.turns)

    @cached_property
    def _parts(self) -> tuple[Array, Array]:
        """What does not depend on the speed, and what grows with its square."""
        still, moving = (self._signals(self.motion.at(speed)) for speed in (0.0, 1.0))
        both = self.motion.periodic(np.stack([still, moving - still]))
        return both.amplitudes[0], both.amplitudes[1]

    def _signals(self, motion: Motion) -> Array:
        """Signals (5, N) at the crank angles of a motion."""
        return self._signals_of(self._outer(motion))

    def _outer(self, motion: Motion) -> Forces:
        """Forces without friction, which cancels in what bodies do that the support carries alike,
        and without springs between links and frame.
        """
        return replace(forces(motion, self.pivot), rubs=False).outer

    def _signals_of(self, forces: Forces) -> Array:
        force = forces.frame_force.value - forces.weight.value
        rocking = np.zeros(len(force), complex)
        if self.rocks:
            gravity = complex(*self.machine.gravity)
            rocking = forces.across.frame_rocking_moment.value - 1j * self.across * gravity
        moment = self._moment(forces)
        return np.stack([force.real, force.imag, moment, rocking.real, rocking.imag])


@dataclass(frozen=True, eq=False)
class WholeExcitation(SupportExcitation):
    """Force and moment of all joints on the frame; mass spread as in the mean over a turn.

    Nothing is left out of what linkages exert on a support that hardly moves.
    """

    @property
    def model(self) -> ExcitationModel:
        return "moment"

    @property
    def rocks(self) -> bool:
        return self.machine.has_planes

    def _mass_of(self, row: Row) -> Array:
        origin = np.array([*row.offset, row.lateral])
        return moved(self._spread, origin - self.body.reference)

    @cached_property
    def _spread(self) -> Array:
        return spread(self.motion)

    def _center_of(self, row: Row) -> Array:
        center = self._mean_center + complex(*row.offset)
        z = row.lateral + (self.across / self.machine.mass if self.machine.mass else 0.0)
        return np.array([center.real, center.imag, z])

    @cached_property
    def _mean_center(self) -> complex:
        """Mean place of the links' common centre of mass."""
        if not self.machine.mass:
            return self.pivot
        sx, sy = self._spread[1, 5], -self._spread[0, 5]
        return complex(sx, sy) / self.machine.mass

    def _moment(self, forces: Forces) -> Array:
        gravity = complex(*self.machine.gravity)
        # what the mounts carry at rest
        mean = self.machine.mass * float(cross(self._mean_center - self.pivot, gravity))
        return np.asarray(forces.frame_moment - mean)
