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
from equipoise.mechanism.kinematics.friction_joints import STILL, RubbingJoint, rubbing_joints
from equipoise.running.drives_linkage import DrivesPose
from equipoise.running.friction import check_shared_friction, on_flanks, sided_meshes
from equipoise.signals import Array

NEAR_REST = 1e-3
"""rad, or lengths of the largest link, by rad of the crank at its usual speed, within which the
sense of a joint's motion changes."""


@dataclass(frozen=True)
class DrivesFriction:
    """Joints of a linkage that resist their motion.

    usual : speed of the crank, rad/s.

    Raises
    ------
    UsageError : a run cannot tell how forces with friction are shared.
    """

    linkage: Linkage
    usual: float

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
        """Rates (J,), rad/s or m/s, below which the sense of a joint's motion changes."""
        sizes = np.array([joint.still / STILL for joint in self.joints])
        return NEAR_REST * self.usual * sizes

    def senses(self, rates: Array, settled: Array) -> Array:
        """Of joints at rates (J, K): from -1 to 1 between both of their `slow` rates.

        settled : (J,) 1 or -1 of a joint that is known to be beyond them, else 0.
        """
        share = np.clip(rates / self.slow[:, None], -1.0, 1.0)
        smooth = share * (3 - share**2) / 2
        return np.where(settled[:, None], settled[:, None], smooth)

    def of(self, pose: DrivesPose, demands: Demands) -> FrictionOf:
        """In K states, where everything but friction and accelerations makes some demands."""
        motion, count = pose.moving, len(self.linkage.machine.driven)
        rates = np.array([joint.rate(pose.along) for joint in self.joints])
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
        return FrictionOf(self, ways, rates[:, -1], pressed)


@dataclass(frozen=True, eq=False)
class FrictionOf:
    """Friction in K states.

    ways : rates (J, N, K) of joints with a unit of speed of each drive.  rates : (J, K) that they
    have, rad/s or m/s.  pressed : (U, 2, 1 + N + U, K) with what acts, with a unit of acceleration
    of each drive, and with a unit of each friction, and of each flank; U is J with the latter.
    """

    friction: DrivesFriction
    ways: Array
    rates: Array
    pressed: Array

    def efforts(self, settled: Array, accelerations: Array, response: Array) -> Array:
        """Friction (J, K) that obeys the law, N m or N.

        settled : as of `DrivesFriction.senses`.  accelerations : of all drives (N, K) without it.
        response : (N, J, K) of these to a unit of each friction.

        Raises
        ------
        LockError : the machine locks itself.
        """
        own, drives = self.friction, len(accelerations)
        count, sides = len(own.joints), len(own.sides)
        known, parts = self.pressed[:, :, 0], self.pressed[:, :, 1 : 1 + drives]
        without = known + np.einsum("jcnk,nk->jck", parts, accelerations)
        added = np.array(self.pressed[:, :, 1 + drives :])
        added[:, :, :count] += np.einsum("jcnk,nmk->jcmk", parts, response)
        law = FrictionLaw.of(own.joints, self.rates, own.senses(self.rates, settled))
        law = law.with_sides(own.sides) if sides else law
        efforts, share = balanced(law, Press.of(without, added))
        if np.any(share < 1):
            raise LockError(Note("friction in joints locks the machine on the way"))
        return np.asarray(efforts[:count])


def leaving(rates: Array, slow: Array, settled: Array) -> Array:
    """How far joints (J, K) are from where `settled` changes: below 0 beyond."""
    share = rates / slow[:, None]
    state: Any = settled[:, None]
    return np.where(state, state * share - 1.0, 1.0 - np.abs(share))


def settled_at(rates: Array, slow: Array) -> Array:
    """Which joints (J,) are beyond their slow rates, as of `DrivesFriction.senses`."""
    return np.where(np.abs(rates) > slow, np.sign(rates), 0.0)
