"""What the free numbers do to every output of a machine: signals that are linear in them.

A signal over equally spaced crank angles of a whole cycle, or over those that resolve jumps, is
start (N,) + numbers @ columns (K, N), real, or complex where it is a vector in the plane.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from equipoise.balancing.design_variables import DesignVariables, FreeSpring, LinkParameters
from equipoise.balancing.rounding import NEARLY
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.dynamics.forces import Forces, demand_of_inertia, forces
from equipoise.mechanism.dynamics.out_of_plane import OutOfPlaneMoments, exerted_in
from equipoise.mechanism.dynamics.reactions import (
    Demand,
    ForceReadings,
    JointReactions,
    VectorSignal,
    demands_of,
    reactions,
    refuse_unbounded,
)
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.jumps import resolved
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.outputs.declared import Declared, OutputSource, matches
from equipoise.mechanism.parts.balance import balanced_names
from equipoise.mechanism.parts.links import in_frame
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import Array, JumpSampling, Periodic

ANGLES = 720
"""Crank angles in a turn at which balancing looks: eight of the 90th order; peaks between them are
met by rows that are added where a program breaks them (`Program.solve`)."""


@dataclass(frozen=True, eq=False)
class Signal:
    """start (N,) + numbers @ columns (K, N); turns of the crank in the N samples.

    sampling : at whose crank angles the samples are, where forces jump.
    """

    start: Array
    columns: Array
    turns: int = 1
    sampling: JumpSampling | None = None

    @property
    def angles(self) -> Array:
        """Crank angle (N,), rad, that each sample stands for in a mean over one turn."""
        if self.sampling is None:
            return np.full(len(self.start), 2 * np.pi / len(self.start))
        return 2 * np.pi * self.sampling.shares

    @property
    def on_grid(self) -> Signal:
        """The samples at equally spaced crank angles."""
        return self if self.sampling is None else self._of(self.sampling.grid)

    def _of(self, places: Array) -> Signal:
        return Signal(self.start[places], self.columns[:, places], self.turns)

    def at(self, numbers: Array) -> Array:
        """The signal (N,) for numbers (K,)."""
        return np.asarray(self.start + numbers @ self.columns)

    def with_orders(self, orders: tuple[float, ...]) -> Signal:
        """The signal with these orders of the crank's speed only; all of them if there are none.

        Where forces jump, amplitudes up to order 100 differ from those of a finer sampling by
        rounding if the signal is smooth between jumps, and by up to 5e-6 of its range where
        friction bends it sharply there (largest of the drive torques of the examples).
        """
        if not orders:
            return self
        if self.sampling is not None:
            return self._with_orders(lambda n: np.any(np.isclose(n[:, None], orders), axis=1))
        places = np.fft.fftfreq(len(self.start), 1 / len(self.start)) / self.turns
        wanted = np.any(np.isclose(np.abs(places)[:, None], orders, atol=NEARLY), axis=1)
        return self.filtered(lambda amplitudes: np.where(wanted, amplitudes, 0.0))

    def ahead_by(self, phase: float) -> Signal:
        """The signal ahead by a phase, rad; of one that jumps, as far as its orders reach."""
        if self.sampling is not None:
            return self._with_orders(lambda n: np.exp(1j * phase * n))
        orders = np.fft.fftfreq(len(self.start), 1 / len(self.start)) / self.turns
        turning = np.exp(1j * phase * orders)
        return self.filtered(lambda amplitudes: amplitudes * turning)

    def filtered(self, change: Callable[[Array], Array]) -> Signal:
        """With its amplitudes (..., N), as `np.fft` orders them, changed; real if it was."""

        def changed(values: Array) -> Array:
            ifft = np.fft.ifft(change(np.fft.fft(values)))
            return ifft if np.iscomplexobj(values) else ifft.real

        return Signal(changed(self.start), changed(self.columns), self.turns)

    def _with_orders(self, factors: Callable[[Array], Array]) -> Signal:
        """With its amplitudes times factors of their orders (n,), at the same crank angles."""
        sampling = self.sampling
        assert sampling is not None

        def changed(values: Array) -> Array:
            if np.iscomplexobj(values):
                return np.asarray(changed(values.real) + 1j * changed(values.imag))
            periodic = sampling.periodic(values)
            turned = Periodic(periodic.amplitudes * factors(periodic.orders), periodic.turns)
            return turned.values(sampling.crank_angle)

        return replace(self, start=changed(self.start), columns=changed(self.columns))

    def divided(self, scale: float) -> Signal:
        return replace(self, start=self.start / scale, columns=self.columns / scale)


class Effects:
    """Outputs of a machine as signals of its free numbers.

    machine : from which the numbers count.  parts : whose numbers they are, K in all.
    like : a machine of the same links, whose couplings are in contact on the flanks that are taken.
    rubbing : a machine of the same motion, whose friction in joints is taken, as forces are linear
        in the numbers with friction that is known only; there is none of it if None.
    """

    def __init__(
        self,
        machine: Machine,
        parts: Sequence[DesignVariables | LinkParameters],
        motion: Motion | None = None,
        like: Machine | None = None,
        rubbing: Machine | None = None,
    ) -> None:
        self.machine, self.parts, self.like = machine, tuple(parts), like
        self.rubbing = rubbing
        usual = move(machine, ANGLES, acceleration=0.0) if motion is None else motion
        self.motion = resolved(usual)
        self.count = sum(part.count for part in parts)
        ends = np.cumsum([part.count for part in parts]).tolist()
        places = [slice(end - part.count, end) for part, end in zip(parts, ends, strict=True)]
        each = list(zip(parts, places, strict=True))
        self.masses = [(item, rows) for item, rows in each if not isinstance(item, FreeSpring)]
        self.springs = [(item, rows) for item, rows in each if isinstance(item, FreeSpring)]

    def at(self, speed: float) -> Effects:
        """Effects at another speed, rad/s."""
        return Effects(self.machine, self.parts, self.motion.at(speed), rubbing=self.rubbing)

    def at_angles(self, crank_angle: Array) -> Effects:
        """Effects at other crank angles (N,), rad, of one cycle or not."""
        motion = self.motion
        moved = move(self.machine, crank_angle, motion.speed, motion.acceleration)
        return Effects(self.machine, self.parts, moved, self.like, self.rubbing)

    def of_row(self, phase: float) -> Effects:
        """Of a linkage ahead by a phase, rad, at the same crank angles of the first one."""
        motion = self.motion
        moved = move(self.machine, motion.crank_angle + phase, motion.speed, motion.acceleration)
        turned = replace(moved, whole_cycle=motion.whole_cycle, sampling=motion.sampling)
        return Effects(self.machine, self.parts, turned, self.like, self.rubbing)

    def signal(self, output: str, about: str | None = None) -> Signal:
        """An output by name; complex where it is a vector.

        Raises
        ------
        UsageError : there is no such output.
        """
        declared, item = self._declared(output)
        pole = in_frame(self.machine.frame, self.motion.linkage.pivot if about is None else about)
        start, columns = (
            declared.component(
                declared.vector(OutputSource(self.motion, forces_of(self, pole)), item)
            )
            for forces_of in (Baseline, UnitResponse)
        )
        return Signal(start, self.full(columns), self.motion.turns, self.motion.sampling)

    def _declared(self, output: str) -> tuple[Declared, str]:
        joints = self.start.joints
        for entry, item in matches(output):
            known = item in (joints if entry.group == "joints" else entry.members(self.machine))
            if entry.is_of_row and not entry.reason and known:
                return entry, item
        if output.startswith("joints."):
            refuse_unbounded(self.motion.linkage, output)
            raise UsageError(unknown(output.removeprefix("joints."), joints, "joint"))
        raise UsageError(unknown(output, balanced_names(self.machine), "output"))

    def weight_moment(self, about: complex) -> Signal:
        """Moment of the weight about a point."""
        start = self.start.frame_moment * 0.0
        for link, (force, moment) in self.start.weights.items():
            at = self.motion.state[f"p({self.start.anchor(link)})"]
            start = start - moment - kernels.cross(at - about, force)
        columns, motion = self.moment(self.weight, about), self.motion
        return Signal(start, columns, motion.turns, motion.sampling)

    @cached_property
    def start(self) -> Forces:
        """Forces of the machine from which the numbers count; without friction where there are
        numbers.
        """
        return replace(forces(self.motion), rubs=not self.parts)

    @cached_property
    def inertia(self) -> Demand:
        """Demands of a unit of each number."""
        speed2 = self.motion.speed**2
        return self._demands(lambda link, own: demand_of_inertia(self.motion, link, speed2, *own))

    @cached_property
    def weight(self) -> Demand:
        """Demands of weight of a unit of each number."""
        turn, gravity = self.motion.state, complex(*self.machine.gravity)
        return self._demands(
            lambda link, own: kernels.weight_demand(turn[f"u({link})"], own[0], own[1], gravity)
        )

    def _demands(self, demand: Callable[[str, tuple[Array, Array, Array]], Demand]) -> Demand:
        force = np.zeros((self.count, len(self.motion.crank_angle)), complex)
        moment = np.zeros(force.shape)
        for part, rows in self.masses:
            force[rows], moment[rows] = demand(part.link, self._about_anchor(part))
        return force, moment

    def _about_anchor(self, part: DesignVariables | LinkParameters) -> tuple[Array, Array, Array]:
        """Mass, first moment and inertia about the link's anchor of each number, (count, 1)."""
        anchor = complex(*self.machine.links[part.link].points[self.start.anchor(part.link)])
        mass, x, y, inertia = part.effect.T[:, :, None]
        about = kernels.about(mass, x + 1j * y, inertia, anchor)
        return about[0], about[1], about[2]

    @cached_property
    def solved(self) -> JointReactions:
        """The run over the joints for each number."""
        force, moment = self.inertia
        links = self.machine.links
        demands = {link: (np.zeros_like(force), np.zeros_like(moment)) for link in links}
        for part, rows in self.masses:
            for whole, demand, other in zip(
                demands[part.link], self.inertia, self.weight, strict=True
            ):
                whole[rows] = demand[rows] + other[rows]
        for spring, rows in self.springs:
            pairs = [(spring.link, spring.choice.point, spring.pulls(self.motion), 0.0)]
            for whole, demand in zip(
                demands[spring.link], demands_of(self.motion, pairs)[spring.link], strict=True
            ):
                whole[rows] = demand
        return reactions(self.motion, demands, self.flanks)

    @cached_property
    def present(self) -> JointReactions:
        """The run over the joints as they are, with the friction and on the flanks that count."""
        if self.rubbing is None:
            return self.start.solved_like(self.flanks)
        frictions = forces(self._moved_like(self.rubbing)).frictions
        return self.start.solved_like(self.flanks, frictions)

    def _moved_like(self, machine: Machine) -> Motion:
        """Another machine at the same crank angles and speed."""
        motion = self.motion
        equally = motion.whole_cycle and motion.sampling is None
        theta = ANGLES if equally else motion.crank_angle
        return move(machine, theta, acceleration=0.0).at(motion.speed)

    @cached_property
    def flanks(self) -> JointReactions:
        """A run whose couplings are in contact on the flanks that count."""
        if self.like is None or not self.machine.couplings:
            return self.start.solved
        return replace(forces(self._moved_like(self.like)), rubs=False).solved

    def full(self, columns: Array) -> Array:
        """Columns (K, N), also where the output is the same at every crank angle."""
        return np.broadcast_to(columns, (self.count, len(self.motion.crank_angle)))

    @cached_property
    def across(self) -> OutOfPlaneMoments:
        """What a unit of each number does across the plane."""
        links, count = self.machine.links, (self.count, len(self.motion.crank_angle))
        inertia, weights, springs = (
            {link: np.zeros(count, complex) for link in links} for _ in range(3)
        )
        for part, rows in self.masses:
            plane = links[part.link].plane if part.plane is None else part.plane
            inertia[part.link][rows] = plane * self.inertia[0][rows]
            weights[part.link][rows] = plane * self.weight[0][rows]
        for spring, rows in self.springs:
            plane = links[spring.link].plane_of(spring.choice.point)
            springs[spring.link][rows] = -plane * spring.pulls(self.motion)
        return OutOfPlaneMoments(
            self.motion, inertia, weights, {}, springs, exerted_in(self.solved)
        )

    def moment(self, demands: Demand, about: complex) -> Array:
        """Moment on the frame (K, N) of demands."""
        total: Array = -demands[1]
        for part, rows in self.masses:
            at = self.motion.state[f"p({self.start.anchor(part.link)})"]
            total[rows] -= kernels.cross(at - about, demands[0][rows])
        return total


@dataclass(frozen=True)
class SolvedOutputs(ForceReadings):
    """Outputs of a machine, or of what is added to it.

    about : point about which moments are taken, m.
    """

    effects: Effects
    about: complex

    preloads: ClassVar[bool] = False


class Baseline(SolvedOutputs):
    """Of the machine from which the numbers count."""

    preloads: ClassVar[bool] = True

    @property
    def solved(self) -> JointReactions:
        return self.effects.present

    @property
    def shaking_force(self) -> VectorSignal:
        return self.effects.start.shaking_force

    @property
    def shaking_moment(self) -> Array:
        return self.effects.start.shaking_moment_about(self.about)

    @property
    def frame_force(self) -> VectorSignal:
        return self.effects.start.frame_force

    @property
    def frame_moment(self) -> Array:
        start = self.effects.start
        shift = kernels.cross(start.about - self.about, start.frame_force.value)
        return np.asarray(start.frame_moment + shift)

    @property
    def across(self) -> OutOfPlaneMoments:
        return replace(self.effects.start.across, exerted=exerted_in(self.solved))


class UnitResponse(SolvedOutputs):
    """Of a unit of each number; arrays (K, N)."""

    @property
    def solved(self) -> JointReactions:
        return self.effects.solved

    @property
    def shaking_force(self) -> VectorSignal:
        return VectorSignal(-self.effects.inertia[0])

    @property
    def shaking_moment(self) -> Array:
        return self.effects.moment(self.effects.inertia, self.about)

    @property
    def frame_force(self) -> VectorSignal:
        return VectorSignal(-self.effects.inertia[0] - self.effects.weight[0])

    @property
    def frame_moment(self) -> Array:
        weight = self.effects.moment(self.effects.weight, self.about)
        return np.asarray(self.shaking_moment + weight)

    @property
    def across(self) -> OutOfPlaneMoments:
        return self.effects.across
