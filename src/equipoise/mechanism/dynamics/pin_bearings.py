"""Bearings in pins: how fast they turn, and what presses in plain ones."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.joints import given_properties
from equipoise.mechanism.assembly.steps import Array, Reaction
from equipoise.mechanism.dynamics.reactions import JointForce
from equipoise.mechanism.kinematics.friction_joints import STILL
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.joint_properties import JointProperties


def ring_speed(motion: Motion, reaction: Reaction) -> Array:
    """Speed (N,) of one body of a pin against the other, rad/s; 0 where it rests."""
    turns = [motion.state[f"w({body})"] for body in (reaction.on, reaction.by)]
    rate = np.broadcast_to(np.asarray(turns[0] - turns[1], float), motion.crank_angle.shape)
    return np.where(np.abs(rate) > STILL, rate, 0.0) * motion.speed


def joint_properties(motion: Motion) -> dict[str, tuple[Reaction, JointProperties]]:
    """Joints of which the file says something, by name."""
    if not motion.machine.joints:
        return {}
    linkage = motion.linkage
    names = {item.force: name for name, item in linkage.named_reactions}
    given = given_properties(linkage.machine, linkage.joints, linkage.reactions)
    return {names[reaction.force]: (reaction, item) for _, reaction, item in given
            if reaction.force in names}  # fmt: skip


@dataclass(frozen=True, eq=False)
class PlainBearing:
    """A plain bearing over the crank angle.

    pressure : (N,) force over width times diameter, Pa.
    pressure_speed : (N,) that times the sliding speed, Pa m/s.
    """

    pressure: Array
    pressure_speed: Array


def plain_bearings(motion: Motion, joints: Mapping[str, JointForce]) -> Mapping[str, PlainBearing]:
    """Plain bearings by joint: pins whose radius and width are given."""
    by_name: dict[str, PlainBearing] = {}
    if all(item.width is None for item in motion.machine.joints):
        return by_name
    for name, (reaction, item) in joint_properties(motion).items():
        if item.width is not None and item.radius is not None and name in joints:
            pressure = joints[name].size / (item.width * 2 * item.radius)
            sliding = np.abs(ring_speed(motion, reaction)) * item.radius
            by_name[name] = PlainBearing(pressure, pressure * sliding)
    return by_name
