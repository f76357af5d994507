"""What the free numbers do to every output of a machine: signals that are linear in them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from equipoise.balancing.measures import Signal
from equipoise.balancing.design_variables import DesignVariables
from equipoise.balancing.design_variables import FreeSpring
from equipoise.errors import UsageError
from equipoise.mechanism import kernels
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.dynamics import Forces, demand_of_inertia, forces, place_of
from equipoise.mechanism.model import Machine
from equipoise.mechanism.motion import Motion, move
from equipoise.mechanism.reactions import Pass, reactions

Array = np.ndarray[Any, Any]

ANGLES = 720
"""Crank angles in a turn at which balancing looks."""
VECTORS = ("shaking_force", "frame_force")
SCALARS = ("shaking_moment", "frame_moment", "drive_torque")


class Effects:
    """Outputs of a machine as signals of its free numbers.

    machine : from which the numbers count.  parts : whose numbers they are, K in all.
    like : a machine of the same links, whose gears are in contact on the flanks that are taken.
    """

    def __init__(
        self,
        machine: Machine,
        parts: Sequence[DesignVariables],
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
        name, _, axis = output.rpartition(".")
        if axis in {"x", "y"} and name:
            whole = self.signal(name, about)
            if np.iscomplexobj(whole.start):
                part = np.real if axis == "x" else np.imag
                return Signal(part(whole.start), part(whole.columns), whole.turns)
        start, columns = self._whole(output, about)
        return Signal(start, columns, self.motion.turns)

    def _whole(self, output: str, about: str | None) -> tuple[Array, Array]:
        if output == "shaking_force":
            return self._start.shaking_force.value, self._full(-self._inertia[0])
        if output == "shaking_moment":
            pole = self._pole(about)
            return self._start.shaking_moment_about(pole), self._moment(self._inertia, pole)
        if output == "frame_force":
            return self._start.frame_force.value, self._full(-self._inertia[0] - self._weight[0])
        if output == "frame_moment":
            pole = self._pole(about)
            force = self._start.frame_force.value
            start = self._start.frame_moment + kernels.cross(self._start.about - pole, force)
            return start, self._moment(self._inertia, pole) + self._moment(self._weight, pole)
        if output == "drive_torque":
            return self._start.drive_torque, self._in_all(self._solved.drive_torque, output)
        if output.startswith("joints."):
            return self._joint(output.removeprefix("joints."))
        joints = [f"joints.{name}" for name in self._start.joints]
        raise UsageError(unknown(output, [*VECTORS, *SCALARS, *joints], "output"))

    def _joint(self, name: str) -> tuple[Array, Array]:
        if name not in self._start.joints:
            raise UsageError(unknown(name, self._start.joints, "joint"))
        columns = self._in_all(self._solved.joints[name].value, f"joints.{name}")
        return self._start.solved_like(self._flanks).joints[name].value, columns

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

    def _about_anchor(self, part: DesignVariables) -> tuple[Array, Array, Array]:
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
