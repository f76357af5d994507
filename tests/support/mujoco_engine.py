"""A machine in MuJoCo, as it is exported: a tree of bodies, told how it moves.

The loops stay open and every joint is told its motion.  MuJoCo's inverse dynamics then tells what
must act on each link, and its tree what must act on all of them.  Springs are its tendons.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from equipoise.exchange.formats import Job
from equipoise.exchange.mjcf import export_bytes
from equipoise.mechanism.parts.machine import FRAME, Machine, Vector
from equipoise.mechanism.parts.springs import Spring
from equipoise.mechanism.parts.torsion_springs import TorsionSpring
from support.loads import work_per_crank_angle
from support.poses import Array, Poses, cross, drive_pivot, quarter, turned

LEAST = 1e-17
"""kg and kg m2: nothing, but MuJoCo divides by it."""


@dataclass(frozen=True)
class Demands:
    """What inverse dynamics asks for.

    base : force and moment about the drive pivot on all bodies together, (N, 3).
    links : force and moment about the link's origin on each link, (N, 3).
    work : of the joints on all links, over the crank's speed, (N,).
    across : moment about x and y in the plane 0 on all bodies together, (N, 2).
    """

    base: Array
    across: Array
    links: Mapping[str, Array]
    work: Array


@dataclass(frozen=True)
class Totals:
    """The outputs that an engine can tell without knowing the joints."""

    shaking_force: Array
    shaking_moment: Array
    drive_torque: Array
    rocking_moment: Array


def totals(machine: Machine, poses: Poses) -> Totals:
    """Return what MuJoCo finds for shaking force, shaking moment and drive torque."""
    linear = tuple(spring for spring in machine.torsion_springs if spring.stiffness is not None)
    others = tuple(spring for spring in machine.torsion_springs if spring.stiffness is None)
    model = model_of(machine, machine.springs, linear)
    sprung = machine.springs or linear
    bare = demands(model_of(machine) if sprung else model, machine, poses, (0.0, 0.0))
    work = demands(model, machine, poses, machine.gravity).work
    loads = work_per_crank_angle(replace(machine, springs=(), torsion_springs=others), poses)
    return Totals(-bare.base[:, :2], -bare.base[:, 2], work - loads, -bare.across)


def model_of(
    machine: Machine, springs: Sequence[Spring] = (), torsion: Sequence[TorsionSpring] = ()
) -> mujoco.MjModel:
    """Return a machine with some springs as it is exported, in MuJoCo."""
    even = tuple(replace(gear, shape=None) for gear in machine.gears)  # the file has no other
    alone = replace(
        machine, support=None, rows=(), balance=None, springs=tuple(springs), gears=even,
        torsion_springs=tuple(torsion),
    )  # fmt: skip
    model = mujoco.MjModel.from_xml_string(export_bytes(Job(alone)))
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    for name, link in machine.links.items():  # what the file makes a little heavier than it is
        if any(body.plane is not None for body in link.bodies):
            continue
        model.body(name).mass[:] = max(link.mass or 0.0, LEAST)
        model.body(name).inertia[:] = max(link.inertia or 0.0, LEAST)
    return model


def demands(model: mujoco.MjModel, machine: Machine, poses: Poses, gravity: Vector) -> Demands:
    """Return what MuJoCo's inverse dynamics asks for at every crank angle."""
    model.opt.gravity[:2] = gravity
    data = mujoco.MjData(model)
    states = np.stack([coordinate(model, poses, joint) for joint in range(model.njnt)], -1)
    texts: list[list[Array]] = []
    for data.qpos[:], data.qvel[:], data.qacc[:] in zip(*states, strict=True):
        mujoco.mj_inverse(model, data)
        mujoco.mj_rnePostConstraint(model, data)
        work = data.qfrc_inverse @ data.qvel / machine.drive.speed
        texts.append([data.cfrc_int.copy(), data.subtree_com.copy(), data.xpos.copy(), work])
    *bodies, work = map(np.array, zip(*texts, strict=True))
    links = {name: asked(model, name, *bodies) for name in machine.links}
    arms = {name: poses.origin[name] - machine.frame[drive_pivot(machine)] for name in links}
    base = sum(
        value[:, :3] + about(cross(arms[name], value[:, :2])) for name, value in links.items()
    )
    across = sum(link[:, 3:] for link in links.values())
    flat = {name: value[:, :3] for name, value in links.items()}
    return Demands(np.asarray(base), np.asarray(across), flat, work)


def about(moment: Array) -> Array:
    """Return moments as forces and moments, (N, 3)."""
    return np.stack([0.0 * moment, 0.0 * moment, moment], -1)


def asked(
    model: mujoco.MjModel, link: str, through_joints: Array, middles: Array, places: Array
) -> Array:
    """Return force, moment about its origin, and moments about x and y in the plane 0, that move
    one link, (N, 5).

    MuJoCo tells what goes through each joint (N, bodies, 6), about the centre of mass of the whole
    tree.
    """
    body = model.body(link).id
    through = through_joints[:, body] - through_joints[:, model.body_parentid == body].sum(1)
    arm = middles[:, model.body_rootid[body]] - places[:, body] * [1.0, 1.0, 0.0]
    force = through[:, 3:]
    moment = through[:, :3] + np.cross(arm, force)
    return np.column_stack([force[:, :2], moment[:, 2], moment[:, :2]])


def coordinate(model: mujoco.MjModel, poses: Poses, number: int) -> Array:
    """Return a joint's position, velocity and acceleration, (3, N)."""
    joint = model.joint(number)
    body = model.body(joint.bodyid[0])
    link, parent = body.name, model.body(body.parentid[0]).name.replace("world", FRAME)
    drawn = 2 * np.arctan2(body.quat[3], body.quat[0])
    still = np.zeros_like(poses.crank_angle)
    w, alpha = (still, still) if parent == FRAME else (poses.omega[parent], poses.alpha[parent])
    if joint.type[0] == mujoco.mjtJoint.mjJNT_HINGE:
        turn = poses.angle[link] - poses.angle_of(parent) - drawn
        return np.stack([turn, poses.omega[link] - w, poses.alpha[link] - alpha])
    along = turned(poses.angle_of(parent) + drawn, (joint.axis[0], joint.axis[1]))
    nothing = np.zeros_like(along)
    base = (nothing,) * 3
    if parent != FRAME:
        base = poses.origin[parent], poses.velocity[parent], poses.acceleration[parent]
    own = poses.origin[link], poses.velocity[link], poses.acceleration[link]
    way, rate, change = (a - b for a, b in zip(own, base, strict=True))
    rate = rate - w[:, None] * quarter(way)
    change = change - alpha[:, None] * quarter(way) + w[:, None] ** 2 * way
    change = change - 2 * w[:, None] * quarter(rate)
    way = way - poses.turned(parent, (body.pos[0], body.pos[1]))
    return np.stack([np.sum(along * item, -1) for item in (way, rate, change)])
