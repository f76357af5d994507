"""Friction of joints and losses of meshes, on a crank or several drives that follow from torques.

What presses in a joint follows from the crank's angle, from the square of its speed and from its
acceleration, and that from all torques, friction's among them:

    P = P_0 + q.^2 P_v + q.. P_a + B e + A f,    J q.. = T + r f - J' q.^2 / 2

with f the friction of all joints, r their rates by crank angle, T all other torques, and e the
efforts of dampers, stops and resistances, forces of the soil, and factors of loads over time, which
follow from angle, speed and time.  So q.. is put into the first equation, and what remains is the
law of friction with other numbers.

Teeth push on the flank, and chains pull with the strand, that the sense of their force asks for.
P is that of forward flanks; where the push T of a mesh is below 0, its other flank adds the effort
-T along what sets both lines of action apart, whose rate is 0: a further row of the same law.

Of several drives it follows from what acts, and from the accelerations of all drives,

    P = P_0 + sum P_j q_j.. + A f,    q.. = q_0.. + G f

which are put into the first equation likewise.  Near rest friction changes its sense smoothly:
drives stop and turn back at instants of their own, so that there is no crank whose sense tells that
of all joints.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import LockError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.dynamics.friction import (
    Demands,
    FrictionLaw,
    Press,
    balanced,
    pressing_rows,
    unit_demands,
)
from equipoise.mechanism.dynamics.loads import given_loads, spring_demands
from equipoise.mechanism.dynamics.reactions import Acting, JointReactions, demands_of
from equipoise.mechanism.dynamics.reduced import (
    effort_demands,
    rated_efforts,
    rated_ways,
    reduced_inertia,
)
from equipoise.mechanism.kinematics.friction_joints import (
    STILL,
    RubbingJoint,
    guide_of,
    rates_of,
    rubbing_joints,
)
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.tip import surface_of, tip_link
from equipoise.mechanism.parts.element_kinds import RatedElement, rated_elements
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.machine import Machine
from equipoise.running.drives_linkage import DrivesPose, LinkageRows
from equipoise.running.sources import Factors, Motions, OfSoil, Source, plus, timed_units
from equipoise.signals import Array

FRICTION = "friction"
"""In the works of a run: friction in all joints."""
KNOWN = 3
"""Parts of what presses without friction: what stands still, by speed squared, by acceleration."""

NOISE = 1e-14
"""Of an inertia, per rad, below which its derivative is rounding, which no polynomial follows."""

NEAR_REST = 1e-3
"""rad, or lengths of the largest link, by rad of the crank at its usual speed, within which the
sense of a joint's motion changes."""


@dataclass(frozen=True, eq=False)
class Friction(Source):
    """The friction of all joints of all rows.

    Raises
    ------
    UsageError : meshes whose flank depends on the sense of their force share it with joints in a
        way that statics leaves open.
    """

    machine: Machine
    key: str = field(default=FRICTION, init=False)
    label: str = field(default=to_say("friction"), init=False)

    def __post_init__(self) -> None:
        check_shared_friction(self.machine)

    # -- what it consists of -----------------------------------------------------------------------

    @cached_property
    def rows(self) -> int:
        """How many rows turn on the shaft."""
        return max(len(self.machine.rows), 1)

    @cached_property
    def joints(self) -> tuple[RubbingJoint, ...]:
        """Friction joints of all rows, one row after the other."""
        return rubbing_joints(assemble(self.machine)) * self.rows

    @cached_property
    def sides(self) -> tuple[RubbingJoint, ...]:
        """Meshes of all rows whose flank, or strand, depends on the sense of their force."""
        return sided_meshes(assemble(self.machine)) * self.rows

    @cached_property
    def elements(self) -> tuple[tuple[str, int, RatedElement], ...]:
        """Dampers, stops and resistances, whose forces press in joints."""
        return rated_elements(self.machine)

    @cached_property
    def soil(self) -> OfSoil | None:
        """The soil, whose force presses in joints."""
        planting = self.machine.planting
        if planting is None or planting.soil is None:
            return None
        return OfSoil(planting, surface_of(self.machine))

    @cached_property
    def given(self) -> tuple[int, int, int]:
        """How many efforts follow from angle, speed and time, in all rows: of elements, of soil,
        and of loads over time.
        """
        freedoms = sum(element.freedoms for *_, element in self.elements)
        tips = 0 if self.soil is None else len(self.soil.planting.every_arm)
        loads = len(self.machine.timed_loads)
        return freedoms * self.rows, 2 * tips * self.rows, loads * self.rows

    @property
    def unknowns(self) -> int:
        """How many efforts follow from what presses: of friction, and of flanks."""
        return len(self.joints) + len(self.sides)

    # -- tabulated ---------------------------------------------------------------------------------

    def columns(self, motions: Motions) -> list[Array]:
        """J', then rates (J,), then parts (U, 2, 3 + U + W) of what presses, then the ways of
        elements with their derivatives, as of `rated_ways`, and the columns of the soil; U and W
        are the sums of `unknowns` and `given`.
        """
        inertia, slope = np.sum([reduced_inertia(motion) for motion in motions], axis=0)
        if np.max(np.abs(slope)) <= NOISE * np.max(inertia):  # of a crank alone, which is constant
            slope = np.zeros_like(slope)
        width = KNOWN + self.unknowns + sum(self.given)
        whole = np.zeros((self.unknowns, 2, width, len(motions[0].crank_angle)))
        rates, ways = [], []
        for row, motion in enumerate(motions):
            own = rubbing_joints(motion.linkage)
            rates += [*rates_of(own, motion)]
            ways += rated_ways(motion, self.elements)
            pressed, causes = self._places(row)
            whole[np.ix_(pressed, (0, 1), causes)] = _parts(motion, own, self.elements)
        soil = [] if self.soil is None else self.soil.columns(motions)
        return [np.asarray(slope), *rates, *whole.reshape(-1, whole.shape[-1]), *ways, *soil]

    def _places(self, row: int) -> tuple[list[int], list[int]]:
        """Of a row, which of the U are its own, and which of the 3 + U + W causes."""
        pressed, begin = [], 0
        for count in (len(self.joints), len(self.sides)):
            pressed += _share(begin, count, row, self.rows)
            begin += count
        causes = [*range(KNOWN), *(KNOWN + place for place in pressed)]
        begin += KNOWN
        for count in self.given:
            causes += _share(begin, count, row, self.rows)
            begin += count
        return pressed, causes

    def groups(self, count: int) -> list[int]:
        """J', all rates, and what presses anywhere by the same cause: most of that vanishes, such
        as forces in a joint beside the one that friction acts in.  Then each element's ways, and
        each column of the soil.
        """
        each = KNOWN + self.unknowns + sum(self.given)
        causes = [2 + cause for _ in range(2 * self.unknowns) for cause in range(each)]
        sizes = [2 * element.freedoms for *_, element in self.elements] * self.rows
        ways = [2 + each + number for number, size in enumerate(sizes) for _ in range(size)]
        known = [0, *[1] * len(self.joints), *causes, *ways]
        first = max(known) + 1
        return [*known, *range(first, first + count - len(known))]

    # -- on the crank ------------------------------------------------------------------------------

    def torque(self, columns: Array, speed: Array, factors: Factors) -> Array:
        """Raise `NotImplementedError`: friction needs more, see `torques_beside`."""
        raise NotImplementedError

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Of the friction joints of a row, in order."""
        return tuple(joint.name for joint in self.joints[: len(self.joints) // self.rows])

    def torques_beside(
        self,
        columns: Array,
        speed: Array,
        sense: float,
        factors: Factors,
        others: tuple[Array, Array],
    ) -> Array:
        """Torque (J, ...) of friction on the crank, N m, of each of `names` in all rows together.

        columns : (C, ...).  speed : rad/s.  sense : 1 or -1, in which the crank turns, or would.
        factors : of loads over time.  others : reduced inertia, kg m2, and torque of the rest, N m.
        """
        shape = np.shape(speed)
        inertia, acting, speed = (np.ravel(item) for item in (*others, speed))
        slope, rates, parts = self._split(columns, speed, sense, factors)
        free = (acting - slope * speed**2 / 2) / inertia
        of_acceleration = parts[:, :, 2]
        without = parts[:, :, 0] + speed**2 * parts[:, :, 1] + free * of_acceleration
        response = parts[:, :, KNOWN:] + np.einsum("jcn,kn->jckn", of_acceleration, rates / inertia)
        each = self._obeying(rates, speed, sense, Press.of(without, response))[: len(self.joints)]
        return np.asarray(each.reshape(self.rows, len(self.names), *shape).sum(axis=0))

    def breakaway(self, columns: Array, sense: float, factors: Factors) -> float:
        """Torque, N m, that has to be exceeded for the crank to leave its rest in a sense."""
        _, rates, parts = self._split(columns, np.zeros(1), sense, factors)
        press = Press.of(parts[:, :, 0], parts[:, :, KNOWN:])
        return -sense * float(np.sum(self._obeying(rates, np.zeros(1), sense, press)))

    def _split(
        self, columns: Array, speed: Array, sense: float, factors: Factors
    ) -> tuple[Array, Array, Array]:
        """J' (N,), rates (U, N) and parts (U, 2, 3 + U, N), of which the first have what elements,
        soil and loads over time do at speeds (N,) in a sense.
        """
        whole, joints, unknowns = columns.reshape(len(columns), -1), len(self.joints), self.unknowns
        each = KNOWN + unknowns + sum(self.given)
        begin, end = 1 + joints, 1 + joints + 2 * unknowns * each
        rates = np.concatenate([whole[1:begin], np.zeros((unknowns - joints, whole.shape[1]))])
        parts = whole[begin:end].reshape(unknowns, 2, each, -1)
        if any(self.given):
            values = self._given_efforts(whole[end:], speed, sense, factors)
            pressed = np.einsum("jcwn,wn->jcn", parts[:, :, KNOWN + unknowns :], values)
            parts = parts[:, :, : KNOWN + unknowns].copy()
            parts[:, :, 0] += pressed
        return whole[0], rates, parts

    def _given_efforts(self, columns: Array, speed: Array, sense: float, factors: Factors) -> Array:
        """Efforts (W, N) of elements and soil by their columns (C, N) at speeds (N,) in a sense,
        and factors of loads over time.
        """
        ways = 2 * self.given[0]
        efforts: list[Array] = []
        if self.elements:
            elements = [element for *_, element in self.elements]
            efforts, _ = rated_efforts(elements, columns[:ways], speed, sense)
        if self.soil is not None:
            for force in self.soil.forces(columns[ways:], speed):
                efforts += [force.real, force.imag]
        loads = [*factors] or [0.0] * len(self.machine.timed_loads)
        efforts += [np.ravel(factor) for factor in loads] * self.rows
        return np.array(np.broadcast_arrays(*efforts, speed)[:-1])

    def _obeying(self, rates: Array, speed: Array, sense: float, press: Press) -> Array:
        """Torque (U, N) on the crank of each friction that obeys the law, and of each flank."""
        law = FrictionLaw.of(self.joints, rates[: len(self.joints)] * speed,
                             sense * np.sign(rates[: len(self.joints)]))  # fmt: skip
        efforts, share = balanced(law.with_sides(self.sides), press)
        if np.any(share < 1):
            raise LockError(Note("friction in joints locks the machine on the way"))
        return np.asarray(rates * efforts)


def check_shared_friction(machine: Machine) -> None:
    """Raise a `UsageError` where a run cannot tell how forces with friction are shared."""
    shared = assemble(machine).shared
    if machine.switches and shared is not None and shared.count:
        raise UsageError(
            Note(
                "a run does not compute friction in joints where teeth or chains share their "
                "force with redundant constraints; leave one of them out"
            )
        )


def sided_meshes(linkage: Linkage) -> tuple[RubbingJoint, ...]:
    """Meshes of a linkage whose flank, or strand, depends on the sense of their force."""
    by_name = {(item.kind, item.name): item for item in linkage.reactions}
    return tuple(
        RubbingJoint(
            mesh.name,
            by_name[mesh.list_name, mesh.name],
            JointProperties(f"{mesh.list_name}.{mesh.name}"),
            None,
            0.0,
            mesh,
        )
        for mesh in linkage.machine.couplings
        if mesh.switches
    )


def _share(begin: int, count: int, row: int, rows: int) -> list[int]:
    """Of so many places from one on, those of a row."""
    return [*range(begin + row * count // rows, begin + (row + 1) * count // rows)]


def _parts(
    motion: Motion,
    joints: Sequence[RubbingJoint],
    elements: tuple[tuple[str, int, RatedElement], ...],
) -> Array:
    """Parts (U, 2, 3 + U + W, N) of what presses in the joints and meshes of a row."""
    still, turning, starting = (motion.at(*rates) for rates in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)))
    result = forces(still)
    loads = demands_of(motion, given_loads(motion))
    demands = plus(result.weights, loads, spring_demands(motion, rated=False))
    known = [demands, forces(turning).inertia, forces(starting).inertia]
    units = unit_demands(motion, joints)
    given = [*effort_demands(motion, elements), *_soil_units(motion), *timed_units(motion)]
    sides = sided_meshes(motion.linkage)
    if not sides:
        return pressing_rows(motion, [*known, *units, *given], joints, None)
    pressed, apart = on_flanks(motion, [*known, *units, *given], (*joints, *sides), sides)
    before = KNOWN + len(units)
    return np.concatenate([pressed[:, :, :before], apart, pressed[:, :, before:]], axis=2)


def on_flanks(
    motion: Motion,
    rows: Sequence[Demands],
    joints: Sequence[RubbingJoint],
    sides: Sequence[RubbingJoint],
) -> tuple[Array, Array]:
    """What presses (J, 2, R, N) with each of R demands where forward flanks bear, and what a unit
    of effort between both flanks of each of S meshes adds to it (J, 2, S, N).

    The latter is what one pass differs from the other, over the push of the mesh, by the demand
    with which that is largest.
    """
    forward = {f"flank({mesh.name})": 1.0 for mesh in motion.machine.couplings}
    probes = [_pushing(motion, side) for side in sides]

    def passed(flanks: dict[str, float]) -> Array:
        like = JointReactions(motion, {**flanks})
        return pressing_rows(motion, [*rows, *probes], joints, like)

    pressed, apart = passed(forward), []
    for number, side in enumerate(sides):
        backward = passed({**forward, f"flank({side.name})": -1.0})
        push = pressed[len(joints) - len(sides) + number, 0]
        largest = np.argmax(np.abs(push), axis=0)[None]
        push = np.take_along_axis(push, largest, axis=0)[0]
        change = np.take_along_axis(pressed - backward, largest[None, None], axis=2)[:, :, 0]
        apart.append(np.divide(change, push, out=np.zeros_like(change), where=push != 0))
    return pressed[:, :, : len(rows)], np.stack(apart, axis=2)


def _pushing(motion: Motion, side: RubbingJoint) -> Demands:
    """A demand that a mesh meets by its push: a torque on its driven link, or a force on a driven
    rack along its guide.
    """
    assert side.mesh is not None
    guide = guide_of(motion.linkage, side.mesh)
    if guide is None:
        return demands_of(motion, [(side.on, None, 0j, 1.0)])  # type: ignore[list-item]
    sliding = replace(side, slider=guide)
    return demands_of(motion, [(side.on, sliding.place(motion), sliding.direction(motion), 0.0)])


def _soil_units(motion: Motion) -> list[Demands]:
    """What holds a unit of the soil's force along x, and along y, on each tip."""
    planting = motion.machine.planting
    if planting is None or planting.soil is None:
        return []
    tips = [(tip_link(motion.machine, arm.tip), arm.tip) for arm in planting.every_arm]
    units: list[Acting] = [(*tip, unit, 0.0) for tip in tips for unit in (1 + 0j, 1j)]  # type: ignore[misc]
    return [demands_of(motion, [unit]) for unit in units]


@dataclass(frozen=True)
class DrivesFriction:
    """Joints of a linkage that resist their motion.

    usual : speed of the crank, rad/s.  rows : R linkages, whose J joints follow each other joint by
    joint, each in all rows.

    Raises
    ------
    UsageError : a run cannot tell how forces with friction are shared.
    """

    linkage: Linkage
    usual: float
    rows: LinkageRows

    def __post_init__(self) -> None:
        check_shared_friction(self.linkage.machine)

    @cached_property
    def joints(self) -> tuple[RubbingJoint, ...]:
        """All of them."""
        return rubbing_joints(self.linkage)

    @cached_property
    def sides(self) -> tuple[RubbingJoint, ...]:
        """Meshes whose flank, or strand, depends on the sense of their force."""
        return sided_meshes(self.linkage)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Of the joints."""
        return tuple(joint.name for joint in self.joints)

    @cached_property
    def slow(self) -> Array:
        """Rates (J R,), rad/s or m/s, below which the sense of a joint's motion changes."""
        sizes = np.array([joint.still / STILL for joint in self.joints])
        return NEAR_REST * self.usual * np.repeat(sizes, self.rows.count)

    def senses(self, rates: Array, settled: Array) -> Array:
        """Of joints at rates (J R, K): from -1 to 1 between both of their `slow` rates.

        settled : (J R,) 1 or -1 of a joint that is known to be beyond them, else 0.
        """
        share = np.clip(rates / self.slow[:, None], -1.0, 1.0)
        smooth = share * (3 - share**2) / 2
        return np.where(settled[:, None], settled[:, None], smooth)

    def of(self, pose: DrivesPose, demands: Demands) -> JointPressing:
        """In K states of all rows, where all but friction and accelerations makes some demands."""
        motion, count = pose.moving, len(self.linkage.machine.driven)
        rates = rates_of(self.joints, pose.along)
        rates = rates.reshape(len(self.joints), count + 1, pose.count)
        units = unit_demands(motion, self.joints)
        rows = [demands, *pose.accelerated, *units]
        if self.sides:
            whole = (*self.joints, *self.sides)
            pressed, apart = on_flanks(motion, rows, whole, self.sides)
            pressed = np.concatenate([pressed, apart], axis=2)
        else:
            pressed = pressing_rows(motion, rows, self.joints, None)
        ways = np.zeros((len(self.joints), len(pose.accelerated), pose.count))
        ways[:, :count] = rates[:, :-1]  # joints do not move by what carries the whole machine
        return JointPressing(self, ways, self._by_joint(rates[:, -1]), pressed)

    def _by_joint(self, values: Array) -> Array:
        """Values (J R, K) of (J, R K)."""
        return values.reshape(len(values) * self.rows.count, -1)


@dataclass(frozen=True, eq=False)
class JointPressing:
    """What presses in joints in K states.

    ways : rates (J, C, R K) of joints with a unit of speed of each coordinate.
    rates : (J R, K) that they have, rad/s or m/s.
    pressed : (U, 2, 1 + C + U, R K) with what acts, with a unit of acceleration of each coordinate,
    and with a unit of each friction, and of each flank; U is J with the latter.
    """

    friction: DrivesFriction
    ways: Array
    rates: Array
    pressed: Array

    def efforts(self, settled: Array, accelerations: Array, response: Array) -> Array:
        """Friction (J R, K) that obeys the law, N m or N.

        settled : as of `DrivesFriction.senses`.  accelerations : of all coordinates of each row
        (C, R K) without it.  response : (C, J R, R K) of these to a unit of each friction.

        Raises
        ------
        LockError : the machine locks itself.
        """
        own, law = self.friction, self._law(settled)
        known, parts = self.pressed[:, :, 0], self.pressed[:, :, 1 : 1 + len(accelerations)]
        without = known + np.einsum("jcnk,nk->jck", parts, accelerations)
        press = Press.of(self._rows_first(without), self._added(parts, response))
        efforts, share = balanced(law, press)
        if np.any(share < 1):
            raise LockError(Note("friction in joints locks the machine on the way"))
        return np.asarray(efforts[: len(own.joints) * own.rows.count])

    def _law(self, settled: Array) -> FrictionLaw:
        """The law of all joints of all rows, and of their sides."""
        own, count = self.friction, self.friction.rows.count
        joints = [joint for joint in own.joints for _ in range(count)]
        law = FrictionLaw.of(tuple(joints), self.rates, own.senses(self.rates, settled))
        if not own.sides:
            return law
        return law.with_sides(tuple(side for side in own.sides for _ in range(count)))

    def _added(self, parts: Array, response: Array) -> Array:
        """What presses (U R, 2, U R, K) with a unit of each friction, and of each flank: in its own
        row as it is, and in all by the accelerations that it makes.
        """
        own, rows = self.friction, self.friction.rows
        units, count = len(self.pressed), len(own.joints) * rows.count
        direct = rows.apart(self.pressed[:, :, 1 + parts.shape[2] :])  # (U, 2, U, R, K)
        added = np.zeros((units, rows.count, 2, units, rows.count, direct.shape[-1]))
        for row in range(rows.count):
            added[:, row, :, :, row] = direct[:, :, :, row]
        added = added.reshape(units * rows.count, 2, units * rows.count, -1)
        added[:, :, :count] += self._rows_first(np.einsum("jcnk,nmk->jcmk", parts, response))
        return added

    def _rows_first(self, values: Array) -> Array:
        """Values (U R, 2, ..., K) of (U, 2, ..., R K)."""
        apart = np.moveaxis(self.friction.rows.apart(values), -2, 1)
        return apart.reshape(-1, *apart.shape[2:])


def leaving(rates: Array, slow: Array, settled: Array) -> Array:
    """How far joints (J, K) are from where `settled` changes: below 0 beyond."""
    share = rates / slow[:, None]
    state: Any = settled[:, None]
    return np.where(state, state * share - 1.0, 1.0 - np.abs(share))


def settled_at(rates: Array, slow: Array) -> Array:
    """Which joints (J,) are beyond their slow rates, as of `DrivesFriction.senses`."""
    return np.where(np.abs(rates) > slow, np.sign(rates), 0.0)
