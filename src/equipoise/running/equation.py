"""The equation of motion of a machine whose crank follows from torques: sources, friction.

Each is a source of generalized force.  It says which functions of the crank angle it needs, which
are tabulated, and what it makes of their values and of the crank's speed.

What presses in a joint follows from the crank's angle, from the square of its speed and from its
acceleration, and that from all torques, friction's among them:

    P = P_0 + q.^2 P_v + q.. P_a + B e + A f,    J q.. = T + r f - J' q.^2 / 2

with f the friction of all joints, r their rates by crank angle, T all other torques, and e the
efforts of dampers, stops and resistances, which follow from angle and speed.  So q.. is put into
the first equation, and what remains is the law of friction with other numbers.

    J(q) q.. + J'(q) q.^2 / 2 = Q(q, q.) + T

with reduced inertia and generalized forces of `mechanism.dynamics.reduced`, summed over all rows on
the shaft, and T the torque of the drive.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import field
from functools import cached_property
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import LockError, MassError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.acting import against_soil, given_loads, spring_demands
from equipoise.mechanism.dynamics.forces import forces, massless
from equipoise.mechanism.dynamics.friction import (
    Demands,
    FrictionLaw,
    Press,
    balanced,
    pressing_rows,
    unit_demands,
)
from equipoise.mechanism.dynamics.rated import (
    effort_demands,
    rated_efforts,
    rated_torque,
    rated_ways,
)
from equipoise.mechanism.dynamics.reactions import demands_of
from equipoise.mechanism.dynamics.reduced import generalized_force, reduced_inertia, weight_torque
from equipoise.mechanism.dynamics.shares import ELEMENTS
from equipoise.mechanism.formulas.kernels import dot
from equipoise.mechanism.kinematics.jumps import bends_of_rows, jumps_of_rows, resisted_back
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.kinematics.rubbing import RubbingJoint, rubbing_joints
from equipoise.mechanism.kinematics.tip import surface_of
from equipoise.mechanism.parts.field import Planting
from equipoise.mechanism.parts.force_kinds import RatedElement, rated_elements
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.results.outputs import CAUSES
from equipoise.running.tabulated import Tabulated
from equipoise.signals import Array

Motions = Sequence[Motion]
"""Of each row of a machine, at the same N instants."""


class Source(ABC):
    """What exerts a generalized force on the crank, by its angle and speed.

    key : its name in JSON.  label : for readers.
    conserves : whether it gives back over a cycle what it takes.
    """

    key: str
    label: str
    conserves: bool = False

    @abstractmethod
    def columns(self, motions: Motions) -> list[Array]:
        """Smooth functions (N,) of the crank angle that it needs."""

    def groups(self, count: int) -> list[int]:
        """Of each of so many columns, the group that it belongs to: one whose largest value tells
        what is rounding in all of it; each is a group of its own where not said otherwise.
        """
        return [*range(count)]

    @abstractmethod
    def torque(self, columns: Array, speed: Array) -> Array:
        """Generalized force (...), N m, by these (C, ...) and the crank's speed (...), rad/s."""

    def sliding_torque(self, columns: Array, speed: Array, sense: float) -> Array:
        """Torque (...) as of `torque`, with dry friction of full size against a sense, 1 or -1, in
        which the crank turns, or would.
        """
        return self.torque(columns, speed)

    def holding(self, columns: Array, sense: float) -> float:
        """Torque, N m, by which it holds a crank at rest against one that turns it in a sense."""
        still = np.zeros(())
        added = self.sliding_torque(columns, still, sense) - self.torque(columns, still)
        return -sense * float(added)


@dataclass(frozen=True)
class ByAngle(Source):
    """A source that depends on the crank angle alone."""

    key: str
    label: str
    of: Callable[[Motion], Array]
    conserves: bool = False

    def columns(self, motions: Motions) -> list[Array]:
        return [np.asarray(sum(self.of(motion) for motion in motions))]

    def torque(self, columns: Array, speed: Array) -> Array:
        torque: Array = columns[0]
        return torque


@dataclass(frozen=True)
class OfSoil(Source):
    """The soil, whose force follows the velocity of each tip over ground."""

    planting: Planting
    surface: float
    key: str = "soil"
    label: str = to_say("soil")

    def columns(self, motions: Motions) -> list[Array]:
        tips = [motion.point(arm.tip) for motion in motions for arm in self.planting.every_arm]
        places = [self.surface - tip.y for tip in tips]
        return [*places, *(tip.place_1.real for tip in tips), *(tip.place_1.imag for tip in tips)]

    def torque(self, columns: Array, speed: Array) -> Array:
        assert self.planting.soil is not None
        depth, x, y = columns.reshape(3, -1, *columns.shape[1:])
        if not np.any(depth > 0):  # most of a turn
            return np.zeros_like(speed)
        way = x + 1j * y
        over_ground = way * speed + self.planting.forward(speed)
        force = against_soil(self.planting.soil, depth, over_ground)
        return np.asarray(np.sum(dot(force, way), axis=0))


def _of_loads(motion: Motion) -> Array:
    return generalized_force(motion, demands_of(motion, given_loads(motion)))


def _of_springs(motion: Motion) -> Array:
    return generalized_force(motion, spring_demands(motion, rated=False))


@dataclass(frozen=True)
class OfRatedElements(Source):
    """Force elements of one cause whose forces depend on velocities."""

    elements: tuple[tuple[str, int, RatedElement], ...]
    key: str
    label: str

    def columns(self, motions: Motions) -> list[Array]:
        """Of each row its ways and their derivatives, as of `rated_ways`."""
        return [column for motion in motions for column in rated_ways(motion, self.elements)]

    def groups(self, count: int) -> list[int]:
        """Ways of an element and their derivatives are measured together: some may vanish, such as
        the way across its direction.
        """
        sizes = [2 * element.freedoms for element in self._each]
        sizes *= count // sum(sizes)
        return [number for number, size in enumerate(sizes) for _ in range(size)]

    def torque(self, columns: Array, speed: Array) -> Array:
        return rated_torque(self._each, columns, speed)

    def sliding_torque(self, columns: Array, speed: Array, sense: float) -> Array:
        return rated_torque(self._each, columns, speed, sense)

    @property
    def _each(self) -> list[RatedElement]:
        return [element for *_, element in self.elements]


def sources_of(machine: Machine) -> Iterator[Source]:
    """Everything but the drive that turns the crank or brakes it."""
    if any(machine.gravity):
        yield ByAngle("weight", to_say("weight"), weight_torque, conserves=True)
    stiff = [element for *_, element in machine.force_elements if not element.rated]
    if stiff or any(coupling.preload for coupling in machine.couplings):
        yield ByAngle("springs", to_say("springs"), _of_springs, conserves=True)
    rated = rated_elements(machine)
    for cause in ELEMENTS:
        if own := tuple(item for item in rated if item[2].cause == cause):
            yield OfRatedElements(own, f"{cause}s", CAUSES[cause])
    if machine.loads:
        yield ByAngle("loads", to_say("loads"), _of_loads)
    planting = machine.planting
    if planting is not None and planting.soil is not None:
        yield OfSoil(planting, surface_of(machine))


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


PIECES = 24
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
                    "forward dynamics is for one crank that a torque turns, not for several drives "
                    "or one that follows a law; leave the others and the law out"
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

    @cached_property
    def friction(self) -> Friction | None:
        """Friction in joints, where they have some."""
        return Friction(self.machine) if self.machine.rubs else None

    @property
    def shaft_inertia(self) -> float:
        """Moment of inertia of flywheel and rotor as the crank feels it, kg m2."""
        drive = self.machine.drive
        motor = drive.motor
        return drive.flywheel + (0.0 if motor is None else motor.ratio**2 * motor.inertia)

    def motions(self, theta: Array) -> list[Motion]:
        """Motion of each row at crank angles (N,), at a crank speed of 1 rad/s."""
        rows = self.machine.rows or (Row(),)
        return [move(self.machine, theta + row.phase, 1.0, 0.0) for row in rows]

    def inertia(self, theta: Array) -> tuple[Array, Array]:
        """J and J' (N,), kg m2, at crank angles (N,), from the linkage itself."""
        inertia, slope = np.sum([reduced_inertia(motion) for motion in self.motions(theta)], axis=0)
        return inertia + self.shaft_inertia, slope

    def energy(self, theta: Array, speed: Array) -> Array:
        """Kinetic energy (N,), J, from the linkage itself."""
        return np.asarray(self.inertia(theta)[0] * speed**2 / 2)

    @cached_property
    def edges(self) -> Array:
        """Crank angles of a cycle between which everything is smooth, from 0 on, rad."""
        linkage = assemble(self.machine)
        turns = linkage.cycle.turns
        grid = np.linspace(0.0, self.period, PIECES * turns + 1)
        jumps, bends = jumps_of_rows(linkage), bends_of_rows(self.machine, turns)
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
            inertia = sum(reduced_inertia(motion)[0] for motion in motions) + self.shaft_inertia
            columns = [inertia, *(c for source in self.sources for c in source.columns(motions))]
            return np.array([np.broadcast_to(column, theta.shape) for column in columns])

        groups = [0]
        for source, part in zip(self.sources, self.slices, strict=True):
            first = max(groups) + 1
            groups += [first + number for number in source.groups(part.stop - part.start)]
        return Tabulated(functions, self.edges, np.array(groups))

    @cached_property
    def slices(self) -> tuple[slice, ...]:
        """Of each source, its columns in the table."""
        few = self.motions(np.zeros(1))
        counts = [len(source.columns(few)) for source in self.sources]
        ends = 1 + np.cumsum([0, *counts])
        return tuple(slice(int(a), int(b)) for a, b in pairwise(ends))

    def torques(
        self, columns: Array, speed: Array, driving: Array | float = 0.0, sense: float = 1.0
    ) -> Array:
        """Torque (K, ...) of each source, N m, by columns (C, ...) of the table, at speeds.

        driving : torque (...) of the drive, which matters to friction in joints only.
        sense : in which the crank turns, 1 or -1, which matters to all dry friction.
        """
        each = zip(self.sources, self.slices, strict=True)
        values = [source.sliding_torque(columns[part], speed, sense) for source, part in each
                 if source is not self.friction]  # fmt: skip
        if self.friction is not None:
            acting, part = np.asarray(sum(values, start=driving)), self.slices[-1]
            values.append(
                self.friction.torque_beside(columns[0], columns[part], speed, sense, acting)
            )
        return np.array(values) if values else np.zeros((0, *np.shape(speed)))

    def at(
        self, theta: float, speed: float, driving: float = 0.0, sense: float = 1.0
    ) -> tuple[float, float, Array]:
        """J, J' and the torque of each source at a crank angle and speed, as of `torques`."""
        values, slopes = self.table.at(theta)
        torques = self.torques(values, np.asarray(speed), np.asarray(driving), sense)
        return float(values[0]), float(slopes[0]), torques

    @cached_property
    def largest_at_rest(self) -> float:
        """Largest torque of any source but friction on a crank at rest, N m, at any angle."""
        columns = self.table.values
        still = np.zeros(columns.shape[1:])
        each = zip(self.sources, self.slices, strict=True)
        torques = (source.torque(columns[part], still)
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

    def at_rest(self, theta: float) -> tuple[float, dict[float, float]]:
        """Torque of all sources but friction on a crank that stands still, N m, and the torque
        beyond which it leaves its rest, by the sense.
        """
        values, _ = self.table.at(theta)
        others = [(source, values[part])
                  for source, part in zip(self.sources, self.slices, strict=True)
                  if source is not self.friction]  # fmt: skip
        acting = sum(float(source.torque(columns, np.zeros(()))) for source, columns in others)
        holding = {
            sense: sum(source.holding(columns, sense) for source, columns in others)
            for sense in (1.0, -1.0)
        }
        if self.friction is not None:
            columns = values[self.slices[-1]]
            for sense in holding:
                holding[sense] += self.friction.breakaway(columns, sense)
        return acting, holding
