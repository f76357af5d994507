"""A machine in MuJoCo: every link loose on a loose base, and the motion forced upon them.

No joint of the machine exists in this model.  The base may move along x and y and turn about the
drive pivot; each link hangs on it by two slides and a hinge at its own origin.  MuJoCo's inverse
dynamics then tells what must act on each link, and, on the base that stands still, on all of them.
Springs are tendons between links and base, whose pull it takes off.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np

from equipoise.mechanism.model import Link, Machine, Vector
from support.loads import work_per_crank_angle
from support.poses import Array, Poses, drive_pivot

LEAST_INERTIA = 1e-12
"""MuJoCo wants some inertia of everything that turns; what is added is taken off again."""


@dataclass(frozen=True)
class Demands:
    """What inverse dynamics asks for.

    base : force and moment about the drive pivot on all bodies together, (N, 3).
    links : force and moment about the link's origin on each link, (N, 3).
    """

    base: Array
    links: Mapping[str, Array]


@dataclass(frozen=True)
class Totals:
    """The outputs that an engine can tell without knowing the joints."""

    shaking_force: Array
    shaking_moment: Array
    drive_torque: Array


def massive(machine: Machine) -> dict[str, Link]:
    """Return the links that have mass; the others ask for nothing."""
    return {name: link for name, link in machine.links.items() if link.mass}


def springless(machine: Machine) -> Machine:
    """Return the machine with those springs only that MuJoCo lacks: on links without mass."""
    heavy = massive(machine)
    return machine.with_springs(s for s in machine.springs if s.link not in heavy)


def shaking_and_torque(
    demands_at: Mapping[Vector, Demands], machine: Machine, poses: Poses
) -> Totals:
    """Turn demands without and with gravity into shaking force, shaking moment and drive torque."""
    bare, heavy = demands_at[0.0, 0.0], demands_at[machine.gravity]
    work = -work_per_crank_angle(springless(machine), poses)
    for name, demand in heavy.links.items():
        work += np.sum(demand * rates(poses, name), -1) / machine.drive.speed
    return Totals(-bare.base[:, :2], -bare.base[:, 2], work)


def rates(poses: Poses, name: str) -> Array:
    """Return velocity of a link's origin and angular velocity, (N, 3)."""
    return np.column_stack([poses.velocity[name], poses.omega[name]])


def totals(machine: Machine, poses: Poses) -> Totals:
    """Return what MuJoCo finds for shaking force, shaking moment and drive torque."""
    cases: set[Vector] = {(0.0, 0.0), machine.gravity}
    return shaking_and_torque({g: demands(machine, poses, g) for g in cases}, machine, poses)


def demands(machine: Machine, poses: Poses, gravity: Vector) -> Demands:
    """Return what MuJoCo's inverse dynamics asks for at every crank angle."""
    model = mujoco.MjModel.from_xml_string(mjcf(machine, gravity))
    data = mujoco.MjData(model)
    states = state(machine, poses)
    found = np.empty((poses.crank_angle.size, model.nv))
    for number in range(len(found)):
        data.qpos[:], data.qvel[:], data.qacc[:] = (part[number] for part in states)
        mujoco.mj_inverse(model, data)
        found[number] = data.qfrc_inverse
    return without_additions(machine, poses, gravity, found)


def without_additions(machine: Machine, poses: Poses, gravity: Vector, found: Array) -> Demands:
    """Take off the weight of the base and the moments of inertia that were added."""
    base = found[:, :3] + np.array([*gravity, 0.0])
    links = {}
    for number, (name, link) in enumerate(massive(machine).items(), 1):
        links[name] = found[:, 3 * number : 3 * number + 3].copy()
        excess = (held_inertia(link) - (link.inertia or 0.0)) * poses.alpha[name]
        links[name][:, 2] -= excess
        base[:, 2] -= excess
    return Demands(base, links)


def state(machine: Machine, poses: Poses) -> tuple[Array, Array, Array]:
    """Return positions, velocities and accelerations in the order of the model's joints."""
    pivot = np.array(machine.frame[drive_pivot(machine)])
    still = np.zeros((poses.crank_angle.size, 3))
    parts: tuple[list[Array], ...] = ([still], [still], [still])
    for name in massive(machine):
        parts[0].append(np.column_stack([poses.origin[name] - pivot, poses.angle[name]]))
        parts[1].append(rates(poses, name))
        parts[2].append(np.column_stack([poses.acceleration[name], poses.alpha[name]]))
    at, rate, change = (np.hstack(part) for part in parts)
    return at, rate, change


def held_inertia(link: Link) -> float:
    """Return the moment of inertia that the model gets."""
    return max(link.inertia or 0.0, LEAST_INERTIA)


def mjcf(machine: Machine, gravity: Vector) -> str:
    """Write the model down."""
    x, y = machine.frame[drive_pivot(machine)]
    bodies = "\n".join(
        f'<body name="{number}">{_joints()}{_inertial(link)}{_eyes(machine, name)}</body>'
        for number, (name, link) in enumerate(massive(machine).items())
    )
    hooks, tendons = _springs(machine)
    return f"""
    <mujoco>
      <compiler angle="radian" boundmass="0" boundinertia="0" balanceinertia="false"/>
      <option gravity="{gravity[0]!r} {gravity[1]!r} 0">
        <flag contact="disable" constraint="disable"/>
      </option>
      <worldbody>
        <body name="base" pos="{x!r} {y!r} 0">
          {_joints()}
          <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
          {bodies}
          {hooks}
        </body>
      </worldbody>
      <tendon>{tendons}</tendon>
    </mujoco>"""


def _eyes(machine: Machine, name: str) -> str:
    """Where springs are hooked on a link."""
    sites = []
    for number, spring in enumerate(machine.springs):
        if spring.link == name:
            x, y = machine.links[name].points[spring.point]
            sites.append(f'<site name="eye {number}" pos="{x!r} {y!r} 0"/>')
    return "".join(sites)


def _springs(machine: Machine) -> tuple[str, str]:
    """Where springs are hooked on the base, and the springs as tendons."""
    px, py = machine.frame[drive_pivot(machine)]
    hooks, tendons = [], []
    for number, spring in enumerate(machine.springs):
        if spring.link in massive(machine):
            x, y = machine.frame[spring.to]
            hooks.append(f'<site name="hook {number}" pos="{x - px!r} {y - py!r} 0"/>')
            tendons.append(
                f'<spatial stiffness="{spring.stiffness!r}" springlength="{spring.free_length!r}">'
                f'<site site="eye {number}"/><site site="hook {number}"/></spatial>'
            )
    return "".join(hooks), "".join(tendons)


def _joints() -> str:
    free = 'limited="false" damping="0" armature="0" stiffness="0" frictionloss="0"'
    return (
        f'<joint type="slide" axis="1 0 0" {free}/><joint type="slide" axis="0 1 0" {free}/>'
        f'<joint type="hinge" axis="0 0 1" {free}/>'
    )


def _inertial(link: Link) -> str:
    x, y = link.center_of_mass or (0.0, 0.0)
    inertia = " ".join([repr(held_inertia(link))] * 3)
    return f'<inertial pos="{x!r} {y!r} 0" mass="{link.mass!r}" diaginertia="{inertia}"/>'
