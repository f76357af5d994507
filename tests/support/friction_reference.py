"""Friction in joints by plain repetition: free bodies, then the law, until nothing changes.

Nothing of the package is used but where every link is.  In each round all links are cut free with
the friction of the round before, and the friction follows anew from the forces that this gives.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.machine import FRAME, Machine, Slider
from support import free_bodies
from support.free_bodies import Acting, FreeBodies, Reaction
from support.poses import Array, Poses, turned

ROUNDS, CLOSE = 300, 1e-14


@dataclass(frozen=True)
class Rubbing:
    """What rubs in a joint, on its body `on`: torque of a pin or force along a slider, (N,)."""

    on: str
    by: str
    effort: Array
    pressing: Array
    rate: Array


def rubbed(machine: Machine, joints: list[str], rng: np.random.Generator, size: float,
           force: float) -> Machine:  # fmt: skip
    """Return the machine whose joints all resist their motion in every way.

    size : of its links, m.  force : of its forces, N.
    """
    pace = abs(machine.drive.speed) or 1.0
    actual = []
    for name in joints:
        given = {"friction": rng.uniform(0.02, 0.12)}
        if rng.random() < 0.5:
            given |= {"static_friction": 0.2, "stribeck_speed": 0.05 * size * pace}
        if name in [slider.name for slider in machine.sliders]:
            given |= {"damping": 0.01 * force / (size * pace), "drag_force": 0.01 * force}
            if rng.random() < 0.7:
                given |= {"guide_length": rng.uniform(0.5, 1.0) * size}
        else:
            given |= {"radius": rng.uniform(0.01, 0.05) * size}
            given |= {"torsional_damping": 0.002 * force * size / pace}
            given |= {"drag_torque": 0.002 * force * size}
        actual.append(JointProperties(f"joints.{name}", **given))
    return replace(machine, joints=tuple(actual), balance=None)


def solve(
    machine: Machine, poses: Poses, pairs: Mapping[str, tuple[str, str]]
) -> tuple[FreeBodies, dict[str, Rubbing]]:
    """Solve the free bodies with friction; forces of sliders have it too."""
    given = {joint.joint.removeprefix("joints."): joint for joint in machine.joints}
    sliders = {slider.name: slider for slider in machine.sliders}
    acting: list[Acting] = []
    before, rubbing = np.zeros(1), dict[str, Rubbing]()
    for _ in range(ROUNDS):
        solved = free_bodies.solve(machine, poses, pairs, acting=acting)
        rubbing = {name: of_joint(given[name], value, poses, machine, sliders.get(name))
                   for name, value in solved.joints.items() if name in given}  # fmt: skip
        acting = [end for name, value in rubbing.items()
                  for end in ends(value, machine, poses, sliders.get(name))]  # fmt: skip
        now = np.array([value.effort for value in rubbing.values()])
        if now.shape == before.shape and np.max(np.abs(now - before)) <= CLOSE * np.max(
            np.abs(now)
        ):
            break
        before = now
    else:
        raise AssertionError("friction does not settle")
    return free_bodies.solve(machine, poses, pairs, acting=acting), rubbing


def of_joint(
    given: JointProperties,
    reaction: Reaction,
    poses: Poses,
    machine: Machine,
    slider: Slider | None,
) -> Rubbing:
    """Return the friction of one joint, from the force in it."""
    if slider is None:
        on, by, radius = reaction.on, reaction.by, given.radius or 0.0
        rate = speed_of(poses, on) - speed_of(poses, by)
        pressing, drag, damping = (
            np.hypot(*reaction.force.T),
            given.drag_torque,
            given.torsional_damping,
        )
    else:
        on, by, radius = slider.link, slider.on, 1.0
        along = line(slider, poses)
        across = np.abs(along[:, 0] * reaction.force[:, 1] - along[:, 1] * reaction.force[:, 0])
        length = given.guide_length
        # both ends of the guide bear half of the force, and a couple
        couple = 0.0 if length is None else reaction.couple / length
        pressing = across
        if length is not None:
            half = (along[:, 0] * reaction.force[:, 1] - along[:, 1] * reaction.force[:, 0]) / 2
            pressing = np.abs(half + couple) + np.abs(half - couple)
        rate = sliding(slider, machine, poses)
        drag, damping = given.drag_force, given.damping
    mu = np.full(rate.shape, given.friction or 0.0)
    if given.static_friction is not None and given.stribeck_speed is not None:
        share = np.exp(-((radius * rate / given.stribeck_speed) ** 2))
        mu = mu * (1 - share) + given.static_friction * share
    effort = -(np.sign(rate) * (mu * radius * pressing + drag) + damping * rate)
    return Rubbing(on, by, effort, pressing, rate)


def ends(item: Rubbing, machine: Machine, poses: Poses, slider: Slider | None) -> list[Acting]:
    """Return what friction exerts on both bodies of a joint."""
    if slider is None:
        nothing = np.zeros((len(item.effort), 2))
        return [(item.on, nothing, nothing, item.effort), (item.by, nothing, nothing, -item.effort)]
    at = poses.place(slider.link, machine.links[slider.link].points[slider.point])
    force = item.effort[:, None] * line(slider, poses)
    return [(item.on, at, force, 0.0), (item.by, at, -force, 0.0)]


def line(slider: Slider, poses: Poses) -> Array:
    """Return the direction of a guide, (N, 2)."""
    return turned(poses.angle_of(slider.on) + slider.direction, (1.0, 0.0))


def speed_of(poses: Poses, body: str) -> Array:
    """Return the angular velocity of a body, the frame too."""
    return np.zeros_like(poses.crank_angle) if body == FRAME else poses.omega[body]


def sliding(slider: Slider, machine: Machine, poses: Poses) -> Array:
    """Return how fast a link slides along its guide: from the velocity of its point, and of the
    place of the guide below it.
    """
    at = machine.links[slider.link].points[slider.point]
    moved = poses.speed(slider.link, at)
    if slider.on != FRAME:
        place = poses.place(slider.link, at)
        arm = place - poses.origin[slider.on]
        spin = poses.omega[slider.on][:, None] * np.stack([-arm[:, 1], arm[:, 0]], -1)
        moved = moved - poses.velocity[slider.on] - spin
    return np.asarray(np.sum(moved * line(slider, poses), axis=1))
