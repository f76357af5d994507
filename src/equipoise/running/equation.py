"""The equation of motion of a machine whose crank follows from torques.

    J(q) q.. + J'(q) q.^2 / 2 = Q(q, q.) + T

with reduced inertia and generalized forces of `mechanism.dynamics.reduced`, summed over all rows on
the shaft, and T the torque of the drive.
"""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise
from math import pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MassError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.dynamics.reduced import reduced_inertia
from equipoise.mechanism.kinematics.jumps import bends_of_rows, jumps_of_rows, resisted_back
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.running.collocation import Tabulated
from equipoise.running.friction import FRICTION, Friction
from equipoise.running.sources import Factors, Source, sources_of
from equipoise.signals import Array

PIECES = 12
"""Pieces of a turn, to begin with."""
DIFFERENCE = 1e-6
"""rad/s, or of a speed: steps of a difference that only tells whether the motion is stiff."""
CLOSE = 1e-9
"""rad, within which edges of pieces are one: rounding of crank angles at which a load sets in."""


@dataclass(frozen=True, eq=False)
class CrankEquation:
    """A machine as a function of its crank's angle and speed.

    Raises
    ------
    MassError : a link has no mass given.
    MotionError : the crank cannot turn fully.
    UsageError : the machine is not driven by one crank.
    """

    machine: Machine

    def __post_init__(self) -> None:
        if not self.machine.has_crank:
            raise UsageError(
                Note(
                    "a flywheel is sized for one crank that a torque turns: several drives need "
                    "not come to a common cycle, and what follows a law does not fluctuate; leave "
                    "the fluctuation, or the others, out"
                )
            )
        if missing := massless(self.machine):
            raise MassError(missing)

    @cached_property
    def period(self) -> float:
        """Crank angle after which everything repeats, rad."""
        return 2 * pi * assemble(self.machine).cycle.turns

    @cached_property
    def sources(self) -> tuple[Source, ...]:
        """What acts on the crank beside the drive; friction in joints comes last."""
        friction = () if self.friction is None else (self.friction,)
        return (*sources_of(self.machine), *friction)

    @property
    def works(self) -> tuple[str, ...]:
        """What acts on the crank beside the drive, as `torques` has it: keys of sources, and
        ``friction.JOINT`` of each joint with friction.
        """
        keys = [source.key for source in self.sources if source is not self.friction]
        return (*keys, *(f"{FRICTION}.{name}" for name in self.rubbing))

    @property
    def rubbing(self) -> tuple[str, ...]:
        """Joints with friction."""
        return () if self.friction is None else self.friction.names

    @cached_property
    def friction(self) -> Friction | None:
        """Friction in joints, where they have some."""
        return Friction(self.machine) if self.machine.rubs else None

    def motions(self, theta: Array) -> list[Motion]:
        """Motion of each row at crank angles (N,), at a crank speed of 1 rad/s."""
        rows = self.machine.rows or (Row(),)
        return [move(self.machine, theta + row.phase, 1.0, 0.0) for row in rows]

    def inertia(self, theta: Array) -> tuple[Array, Array]:
        """J and J' (N,), kg m2, at crank angles (N,), from the linkage itself."""
        inertia, slope = np.sum([reduced_inertia(motion) for motion in self.motions(theta)], axis=0)
        return inertia + self.machine.drive.shaft_inertia, slope

    def energy(self, theta: Array, speed: Array) -> Array:
        """Kinetic energy (N,), J, from the linkage itself."""
        return np.asarray(self.inertia(theta)[0] * speed**2 / 2)

    @cached_property
    def times(self) -> tuple[float, ...]:
        """Times, rising, s, at which the course of a load over time changes."""
        return tuple(sorted({time for load in self.machine.timed_loads for time in load.times}))

    @cached_property
    def edges(self) -> Array:
        """Crank angles of a cycle between which everything is smooth, from 0 on, rad."""
        linkage = assemble(self.machine)
        turns = linkage.cycle.turns
        grid = np.linspace(0.0, self.period, PIECES * turns + 1)
        jumps, bends = jumps_of_rows(linkage), bends_of_rows(linkage, turns)
        turned = resisted_back(linkage)
        apart = np.sort(np.concatenate([jumps, bends, turned]))
        apart = apart[np.diff(apart, prepend=-1.0) > CLOSE]
        nearest = np.min(np.abs(np.subtract.outer(grid, apart)), axis=1, initial=np.inf)
        nearest[[0, -1]] = np.inf
        inside = apart[(apart > CLOSE) & (apart < self.period - CLOSE)]
        return np.sort(np.concatenate([grid[nearest > CLOSE], inside]))

    @cached_property
    def table(self) -> Tabulated:
        """J, and the columns of each source one after the other."""

        def functions(theta: Array) -> Array:
            motions = self.motions(theta)
            links = sum(reduced_inertia(motion)[0] for motion in motions)
            inertia = links + self.machine.drive.shaft_inertia
            columns = [inertia, *(c for source in self.sources for c in source.columns(motions))]
            return np.array([np.broadcast_to(column, theta.shape) for column in columns])

        motions = self.motions(self.edges)
        groups, sizes = [0], [0.0]
        for source, part in zip(self.sources, self.slices, strict=True):
            first = max(groups) + 1
            groups += [first + number for number in source.groups(part.stop - part.start)]
            sizes += source.sizes(motions)
        return Tabulated(functions, self.edges, np.array(groups), np.array(sizes))

    @cached_property
    def slices(self) -> tuple[slice, ...]:
        """Of each source, its columns in the table."""
        few = self.motions(np.zeros(1))
        counts = [len(source.columns(few)) for source in self.sources]
        ends = 1 + np.cumsum([0, *counts])
        return tuple(slice(int(a), int(b)) for a, b in pairwise(ends))

    def torques(
        self,
        columns: Array,
        speed: Array,
        driving: Array | float = 0.0,
        sense: float = 1.0,
        factors: Factors = (),
    ) -> Array:
        """Torque (K, ...) of each of `works`, N m, by columns (C, ...) of the table, at speeds.

        driving : torque (...) of the drive, which matters to friction in joints only.
        sense : in which the crank turns, 1 or -1, which matters to all dry friction.
        factors : of loads over time, as of `load_factors`.
        """
        each = zip(self.sources, self.slices, strict=True)
        values = [source.sliding_torque(columns[part], speed, sense, factors)
                  for source, part in each if source is not self.friction]  # fmt: skip
        if self.friction is not None:
            others = columns[0], np.asarray(sum(values, start=driving))
            own = columns[self.slices[-1]]
            values += [*self.friction.torques_beside(own, speed, sense, factors, others)]
        return np.array(values) if values else np.zeros((0, *np.shape(speed)))

    def at(
        self,
        theta: float,
        speed: float,
        driving: float = 0.0,
        sense: float = 1.0,
        factors: Factors = (),
    ) -> tuple[float, float, Array]:
        """J, J' and the torque of each of `works` at a crank angle and speed, as of `torques`."""
        values, slopes = self.table.at(theta)
        torques = self.torques(values, np.asarray(speed), np.asarray(driving), sense, factors)
        return float(values[0]), float(slopes[0]), torques

    @cached_property
    def largest_at_rest(self) -> float:
        """Largest torque of any source but friction on a crank at rest, N m, at any angle, with
        loads over time as they are given.
        """
        columns = self.table.values
        still = np.zeros(columns.shape[1:])
        each = zip(self.sources, self.slices, strict=True)
        factors = [1.0] * len(self.machine.timed_loads)
        torques = (source.torque(columns[part], still, factors)
                   for source, part in each if source is not self.friction)  # fmt: skip
        return max((float(np.max(np.abs(torque))) for torque in torques), default=0.0)

    def damping(self, theta: Array, speed: float, sense: float) -> float:
        """By how much the torque of all sources falls with the crank's speed, over the inertia,
        1/s: the most at crank angles (N,).
        """
        step, rates = DIFFERENCE * max(abs(speed), 1.0), []
        for angle in theta.tolist():
            inertia, _, slow = self.at(angle, speed, 0.0, sense)
            fast = self.at(angle, speed + step, 0.0, sense)[2]
            rates.append(float(np.sum(slow - fast)) / (step * inertia))
        return max(rates)

    def at_rest(self, theta: float, factors: Factors = ()) -> tuple[float, dict[float, float]]:
        """Torque of all sources but friction on a crank that stands still, N m, and the torque
        beyond which it leaves its rest, by the sense.
        """
        values, _ = self.table.at(theta)
        others = [(source, values[part])
                  for source, part in zip(self.sources, self.slices, strict=True)
                  if source is not self.friction]  # fmt: skip
        still = np.zeros(())
        acting = sum(float(source.torque(columns, still, factors)) for source, columns in others)
        holding = {
            sense: sum(source.holding(columns, sense) for source, columns in others)
            for sense in (1.0, -1.0)
        }
        if self.friction is not None:
            columns = values[self.slices[-1]]
            for sense in holding:
                holding[sense] += self.friction.breakaway(columns, sense, factors)
        return acting, holding
