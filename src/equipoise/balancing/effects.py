"""What the free numbers do to every output of a machine: signals that are linear in them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from equipoise.balancing.design_variables import (
    DesignVariables,
    FreeSpring,
    LinkParameters,
)
from equipoise.balancing.measures import Signal
from equipoise.errors import UsageError
from equipoise.mechanism import kernels
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.dynamics import Forces, demand_of_inertia, forces, place_of
from equipoise.mechanism.model import Machine
from equipoise.mechanism.motion import Motion, move
from equipoise.mechanism.objectives import balanced_names
from equipoise.mechanism.outputs import Declared, matches
from equipoise.mechanism.reactions import JointForce, Pass, VectorSignal, reactions
from equipoise.signals import Array

ANGLES = 720
"""Crank angles in a turn at which balancing looks."""


class Effects:
    """Outputs of a machine as signals of its free numbers.

    machine : from which the numbers count.  parts : whose numbers they are, K in all.
    like : a machine of the same links, whose gears are in contact on the flanks that are taken.
    """

    def __init__(
        self,
        machine: Machine,
        parts: Sequence[DesignVariables | LinkParameters],
        motion: Motion | None = None,
        like: Machine | None = None,
    ) -> None:
        self.machine, self.parts = machine, tuple(parts)
        self.motion = move(machine, ANGLES, acceleration=0.0) if motion is None else motion
        self.like = like
        self.count = sum(part.count for part in parts)

    def at(self, speed: float) -> Effects:
        """The same at another speed, rad/s."""
        return Effects(self.machine, self.parts, self.motion.at(speed))

    def signal(self, output: str, about: str | None = None) -> Signal:
        """An output by name; complex where it is a vector.

        Raises
        ------
        UsageError : there is no such output.
        """
        one, item = self._declared(output)
        pole = self._pole(about)
        start = one.component(one.vector(Present(self, pole), item))
        columns = one.component(one.vector(Unit(self, pole), item))
        return Signal(start, self._full(columns), self.motion.turns)

    def _declared(self, output: str) -> tuple[Declared, str]:
        joints = self._start.joints
        found = [(one, item) for one, item in matches(output) if one.needs == "masses"]
        for one, item in found:
            if not one.reason and (not item or item in joints):
                return one, item
        if output.startswith("joints."):
            raise UsageError(unknown(output.removeprefix("joints."), joints, "joint"))
        raise UsageError(unknown(output, balanced_names(self.machine), "output"))

    def weight_moment(self, about: complex) -> Signal:
        """Moment of the weight about a point."""
        start = self._start.frame_moment * 0.0
        for link, (force, moment) in self._start.weights.items():
            at = self.motion.state[f"p({self._start.anchor(link)})"]
            start = start - moment - kernels.cross(at - about, force)
        return Signal(start, self._moment(self._weight, about), self.motion.turns)

    @cached_property
    def _start(self) -> Forces:
        return forces(self.motion)

    def _pole(self, about: str | None) -> complex:
        return place_of(self.machine, self.motion.linkage.pivot if about is None else about)

    @cached_property
    def _inertia(self) -> tuple[Array, Array]:
        """Demands (K, N), force and moment about the link's anchor, of a unit of each number."""
        return self._demands(
            lambda link, own: demand_of_inertia(self.motion, link, self.motion.speed**2, *own)
        )

    @cached_property
    def _weight(self) -> tuple[Array, Array]:
        """The same of weight."""
        gravity = complex(*self.machine.gravity)
        return self._demands(
            lambda link, own: kernels.weight_demand(
                self.motion.state[f"u({link})"], own[0], own[1], gravity
            )
        )

    def _demands(self, demand: Any) -> tuple[Array, Array]:
        force = np.zeros((self.count, len(self.motion.crank_angle)), complex)
        moment = np.zeros(force.shape)
        for part, rows in zip(self.parts, self._rows, strict=True):
            if not isinstance(part, FreeSpring):
                force[rows], moment[rows] = demand(part.link, self._about_anchor(part))
        return force, moment

    @cached_property
    def _rows(self) -> list[slice]:
        """Which of the K numbers each part has."""
        ends = np.cumsum([part.count for part in self.parts])
        return [
            slice(int(end) - part.count, int(end))
            for part, end in zip(self.parts, ends, strict=True)
        ]

    def _about_anchor(self, part: DesignVariables | LinkParameters) -> tuple[Array, Array, Array]:
        """Mass, first moment and inertia about the link's anchor of each number, (count, 1)."""
        anchor = complex(*self.machine.links[part.link].points[self._start.anchor(part.link)])
        mass, x, y, inertia = part.effect.T[:, :, None]
        found = kernels.about(mass, x + 1j * y, inertia, anchor)
        return found[0], found[1], found[2]

    @cached_property
    def _solved(self) -> Pass:
        """The run over the joints for each number."""
        demands: dict[str, tuple[Array, Array]] = {
            link: (np.zeros_like(self._inertia[0]), np.zeros_like(self._inertia[1]))
            for link in self.machine.links
        }
        for part, rows in zip(self.parts, self._rows, strict=True):
            if not isinstance(part, FreeSpring):
                for whole, one, other in zip(
                    demands[part.link], self._inertia, self._weight, strict=True
                ):
                    whole[rows] = one[rows] + other[rows]
        return reactions(self.motion, demands, self._flanks)

    @cached_property
    def _flanks(self) -> Pass:
        """A run whose gears are in contact on the flanks that count."""
        if self.like is None or not self.machine.gears:
            return self._start.solved
        motion = move(self.like, ANGLES, acceleration=0.0)
        return forces(motion.at(self.motion.speed)).solved

    def _in_all(self, columns: Array, output: str) -> Array:
        """Columns (K, N) of masses, with those of springs beside them."""
        full = np.array(self._full(columns))
        for part, rows in zip(self.parts, self._rows, strict=True):
            if isinstance(part, FreeSpring):
                full[rows] = part.columns(self.motion, output)
        return full

    def _full(self, columns: Array) -> Array:
        shape = (self.count, len(self.motion.crank_angle))
        return np.broadcast_to(columns, shape)

    def _moment(self, demands: tuple[Array, Array], about: complex) -> Array:
        """Moment on the frame (K, N) of demands."""
        total = -demands[1]
        for part, rows in zip(self.parts, self._rows, strict=True):
            if not isinstance(part, FreeSpring):
                at = self.motion.state[f"p({self._start.anchor(part.link)})"]
                total[rows] -= kernels.cross(at - about, demands[0][rows])
        return total


@dataclass(frozen=True)
class Present:
    """The forces of the machine from which the numbers count, as outputs are read of them.

    about : point about which moments are taken, m.
    """

    effects: Effects
    about: complex

    @property
    def machine(self) -> Machine:
        return self.effects.machine

    @property
    def motion(self) -> Motion:
        return self.effects.motion

    @property
    def forces(self) -> Present:
        return self

    @property
    def shaking_force(self) -> VectorSignal:
        return self.effects._start.shaking_force

    @property
    def shaking_moment(self) -> Array:
        return self.effects._start.shaking_moment_about(self.about)

    @property
    def frame_force(self) -> VectorSignal:
        return self.effects._start.frame_force

    @property
    def frame_moment(self) -> Array:
        start = self.effects._start
        shift = kernels.cross(start.about - self.about, start.frame_force.value)
        return np.asarray(start.frame_moment + shift)

    @property
    def drive_torque(self) -> Array:
        return self.effects._start.drive_torque

    @property
    def joints(self) -> Mapping[str, JointForce]:
        return self.effects._start.solved_like(self.effects._flanks).joints


@dataclass(frozen=True)
class Unit(Present):
    """The same of a unit of each number; arrays (K, N)."""

    @property
    def shaking_force(self) -> VectorSignal:
        return VectorSignal(-self.effects._inertia[0])

    @property
    def shaking_moment(self) -> Array:
        return self.effects._moment(self.effects._inertia, self.about)

    @property
    def frame_force(self) -> VectorSignal:
        return VectorSignal(-self.effects._inertia[0] - self.effects._weight[0])

    @property
    def frame_moment(self) -> Array:
        effects = self.effects
        both = (effects._moment(one, self.about) for one in (effects._inertia, effects._weight))
        return sum(both, np.zeros(1))

    @property
    def drive_torque(self) -> Array:
        return self.effects._in_all(self.effects._solved.drive_torque, "drive_torque")

    @property
    def joints(self) -> Mapping[str, JointForce]:
        return _JointsOfUnit(self.effects)


class _JointsOfUnit(dict[str, JointForce]):
    """Joint forces (K, N) of a unit of each number, each made when it is asked for."""

    def __init__(self, effects: Effects) -> None:
        super().__init__()
        self.effects = effects

    def __missing__(self, name: str) -> JointForce:
        joint = self.effects._solved.joints[name]
        return replace(joint, value=self.effects._in_all(joint.value, f"joints.{name}"))
