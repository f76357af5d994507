"""Friction of joints, and losses of meshes, in a machine of several drives.

What presses in a joint follows from what acts, and from the accelerations of all drives, and those
follow from friction:

    P = P_0 + sum P_j q_j.. + A f,    q.. = q_0.. + G f

with f the friction of all joints.  So q.. is put into the first equation, and what remains is the
law of friction with other numbers.  Near rest friction changes its sense smoothly: drives stop and
turn back at instants of their own, so that there is no crank whose sense tells that of all joints.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import LockError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.dynamics.friction import (
    Demands,
    FrictionLaw,
    Press,
    balanced,
    pressing_rows,
    unit_demands,
)
from equipoise.mechanism.kinematics.friction_joints import (
    STILL,
    RubbingJoint,
    rates_of,
    rubbing_joints,
)
from equipoise.running.drives_linkage import DrivesPose
from equipoise.running.friction import check_shared_friction, on_flanks, sided_meshes
from equipoise.running.linkage_rows import LinkageRows
from equipoise.signals import Array

NEAR_REST = 1e-3
"""rad, or lengths of the largest link, by rad of the crank at its usual speed, within which the
sense of a joint's motion changes."""


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
