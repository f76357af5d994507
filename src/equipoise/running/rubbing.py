"""Friction in joints while torques decide the motion.

What presses in a joint follows from the crank's angle, from the square of its speed and from its
acceleration, and that from all torques, friction's among them:

    P = P_0 + q.^2 P_v + q.. P_a + B e + A f,    J q.. = T + r f - J' q.^2 / 2

with f the friction of all joints, r their rates by crank angle, T all other torques, and e the
efforts of dampers, stops and resistances, which follow from angle and speed.  So q.. is put into
the first equation, and what remains is the law of friction with other numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import LockError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.acting import given_loads, spring_demands
from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.dynamics.friction import (
    Demands,
    FrictionLaw,
    Press,
    balanced,
    pressing_rows,
    unit_demands,
)
from equipoise.mechanism.dynamics.rated import effort_demands, rated_efforts, rated_ways
from equipoise.mechanism.dynamics.reactions import demands_of
from equipoise.mechanism.dynamics.reduced import reduced_inertia
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.rubbing import RubbingJoint, rubbing_joints
from equipoise.mechanism.parts.force_kinds import RatedElement, rated_elements
from equipoise.mechanism.parts.machine import Machine
from equipoise.running.sources import Motions, Source
from equipoise.signals import Array

KNOWN = 3
"""Parts of what presses without friction: what stands still, by speed squared, by acceleration."""

NOISE = 1e-14
"""Of an inertia, per rad, below which its derivative is rounding, which no polynomial follows."""


def plus(*demands: Demands) -> dict[str, Any]:
    """Demands of links, added up."""
    total: dict[str, Any] = {}
    for demand in demands:
        for link, (force, moment) in demand.items():
            own = total.get(link, (0.0, 0.0))
            total[link] = own[0] + force, own[1] + moment
    return total


@dataclass(frozen=True, eq=False)
class Friction(Source):
    """The friction of all joints of all rows.

    Raises
    ------
    UsageError : soil, or flanks of teeth, make what presses depend on more than that.
    """

    machine: Machine
    key: str = field(default="friction", init=False)
    label: str = field(default=to_say("friction"), init=False)

    def __post_init__(self) -> None:
        planting = self.machine.planting
        if self.machine.switches or (planting is not None and planting.soil is not None):
            raise UsageError(
                Note(
                    "a run does not compute friction in joints together with soil, or with teeth "
                    "and chains; leave one of them out"
                )
            )

    @cached_property
    def joints(self) -> tuple[RubbingJoint, ...]:
        """Those of all rows, one row after the other."""
        return rubbing_joints(assemble(self.machine)) * max(len(self.machine.rows), 1)

    @cached_property
    def elements(self) -> tuple[tuple[str, int, RatedElement], ...]:
        """Dampers, stops and resistances, whose forces press in joints."""
        return rated_elements(self.machine)

    @cached_property
    def ways(self) -> int:
        """How many ways these have in all rows together."""
        freedoms = sum(element.freedoms for *_, element in self.elements)
        return freedoms * max(len(self.machine.rows), 1)

    def columns(self, motions: Motions) -> list[Array]:
        """J', then rates (J,), then parts (J, 2, 3 + J + W) of what presses, then W ways of
        dampers, stops and resistances with their derivatives, as of `rated_ways`.
        """
        inertia, slope = np.sum([reduced_inertia(motion) for motion in motions], axis=0)
        if np.max(np.abs(slope)) <= NOISE * np.max(inertia):  # of a crank alone, which is constant
            slope = np.zeros_like(slope)
        joints, efforts = len(self.joints), KNOWN + len(self.joints)
        whole = np.zeros((joints, 2, efforts + self.ways, len(motions[0].crank_angle)))
        rates, ways, begin = [], [], 0
        for row, motion in enumerate(motions):
            own = rubbing_joints(motion.linkage)
            rates += [joint.rate(motion) for joint in own]
            ways += rated_ways(motion, self.elements)
            part, end = _parts(motion, own, self.elements), begin + len(own)
            first, last = (efforts + k * self.ways // len(motions) for k in (row, row + 1))
            whole[begin:end, :, :KNOWN] = part[:, :, :KNOWN]
            whole[begin:end, :, KNOWN + begin : KNOWN + end] = part[:, :, KNOWN : KNOWN + len(own)]
            whole[begin:end, :, first:last] = part[:, :, KNOWN + len(own) :]
            begin = end
        return [np.asarray(slope), *rates, *whole.reshape(-1, whole.shape[-1]), *ways]

    def groups(self, count: int) -> list[int]:
        """J', all rates, and what presses anywhere by the same cause: most of that vanishes, such
        as forces in a joint beside the one that friction acts in.  Then each element's ways.
        """
        joints, each = len(self.joints), KNOWN + len(self.joints) + self.ways
        causes = [2 + cause for _ in range(2 * joints) for cause in range(each)]
        rows = max(len(self.machine.rows), 1)
        sizes = [2 * element.freedoms for *_, element in self.elements] * rows
        ways = [2 + each + number for number, size in enumerate(sizes) for _ in range(size)]
        return [0, *[1] * joints, *causes, *ways]

    def torque(self, columns: Array, speed: Array) -> Array:
        """It depends on more: see `torque_beside`."""
        raise NotImplementedError

    def torque_beside(
        self, inertia: Array, columns: Array, speed: Array, sense: float, acting: Array
    ) -> Array:
        """Torque (...) of friction on the crank, N m.

        inertia : reduced, kg m2.  columns : (C, ...).  speed : rad/s.
        sense : 1 or -1, in which the crank turns, or would.  acting : of all else, N m.
        """
        shape = np.shape(speed)
        inertia, speed, acting = (np.ravel(item) for item in (inertia, speed, acting))
        slope, rates, parts = self._split(columns, speed, sense)
        free = (acting - slope * speed**2 / 2) / inertia
        of_acceleration = parts[:, :, 2]
        without = parts[:, :, 0] + speed**2 * parts[:, :, 1] + free * of_acceleration
        response = parts[:, :, KNOWN:] + np.einsum("jcn,kn->jckn", of_acceleration, rates / inertia)
        result = self._found(rates, speed, sense, Press.of(without, response))
        return np.asarray(result.reshape(shape))

    def breakaway(self, columns: Array, sense: float) -> float:
        """Torque, N m, that has to be exceeded for the crank to leave its rest in a sense."""
        _, rates, parts = self._split(columns, np.zeros(1), sense)
        press = Press.of(parts[:, :, 0], parts[:, :, KNOWN:])
        return -sense * float(self._found(rates, np.zeros(1), sense, press)[0])

    def _split(self, columns: Array, speed: Array, sense: float) -> tuple[Array, Array, Array]:
        """J' (N,), rates (J, N) and parts (J, 2, 3 + J, N), of which the first have what dampers,
        stops and resistances do at speeds (N,) in a sense.
        """
        whole, count = columns.reshape(len(columns), -1), len(self.joints)
        each = KNOWN + count + self.ways
        begin, end = 1 + count, 1 + count + 2 * count * each
        parts = whole[begin:end].reshape(count, 2, each, -1)
        if self.ways:
            elements = [element for *_, element in self.elements]
            efforts, _ = rated_efforts(elements, whole[end:], speed, sense)
            values = np.array(np.broadcast_arrays(*efforts, parts[0, 0, 0])[:-1])
            pressed = np.einsum("jcwn,wn->jcn", parts[:, :, KNOWN + count :], values)
            parts = parts[:, :, : KNOWN + count].copy()
            parts[:, :, 0] += pressed
        return whole[0], whole[1 : 1 + count], parts

    def _found(self, rates: Array, speed: Array, sense: float, press: Press) -> Array:
        """Torque (N,) on the crank of the friction that obeys the law."""
        law = FrictionLaw.of(self.joints, rates * speed, sense * np.sign(rates))
        efforts, share = balanced(law, press)
        if np.any(share < 1):
            raise LockError(Note("friction in joints locks the machine on the way"))
        return np.asarray(np.sum(rates * efforts, axis=0))


def _parts(
    motion: Motion,
    joints: Sequence[RubbingJoint],
    elements: tuple[tuple[str, int, RatedElement], ...],
) -> Array:
    """Parts (J, 2, 3 + J + W, N) of what presses in the joints of a row."""
    still, turning, starting = (motion.at(*rates) for rates in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)))
    result = forces(still)
    loads = demands_of(motion, given_loads(motion))
    demands = plus(result.weights, loads, spring_demands(motion, rated=False))
    rows = [demands, forces(turning).inertia, forces(starting).inertia]
    rows += unit_demands(motion, joints)
    rows += effort_demands(motion, elements)
    return pressing_rows(motion, rows, joints, None)
