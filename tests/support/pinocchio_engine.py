"""A machine in Pinocchio: an open tree of hinges at the machine's own pins, cut where loops close.

Unlike the MuJoCo model the links hang on each other, with relative angles as coordinates; a link
that no pin holds hangs on the base by two slides and a hinge.  Virtual work and the base, which is
free but stands still, give the same outputs by a different recursion.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pinocchio as pin

from equipoise.mechanism.parts.machine import FRAME, Link, Machine, Vector
from support.loads import work_per_crank_angle
from support.machines_planes import pieces
from support.mujoco_engine import Totals
from support.poses import Array, Poses, drive_pivot, pins

Coordinate = tuple[Array, Array, Array]
"""Position, velocity and acceleration of one joint, each (N,)."""


@dataclass
class Tree:
    """The model as it grows, with the motion of each of its joints in the order they came.

    numbers : of the joint that carries each body.  held : the point of each link, in its own
    axes, that is the origin of its joint.
    """

    machine: Machine
    poses: Poses
    model: pin.Model = field(default_factory=pin.Model)
    numbers: dict[str, int] = field(default_factory=dict)
    held: dict[str, Vector] = field(default_factory=dict)
    motion: list[Coordinate] = field(default_factory=list)

    def joint(
        self,
        parent: int,
        kind: object,
        place: Vector,
        name: str,
        motion: Coordinate,
        across: float = 0.0,
    ) -> int:
        """Add one joint and how it moves."""
        shift = pin.SE3(np.eye(3), np.array([*place, across]))
        self.motion.append(motion)
        return int(self.model.addJoint(parent, kind, shift, name))

    def loose(self, parent: int, name: str, place: Vector, motion: list[Coordinate]) -> int:
        """Add two slides and a hinge, or two slides and three hinges."""
        kinds = [pin.JointModelPX(), pin.JointModelPY(), pin.JointModelRX(), pin.JointModelRY()]
        *before, last = motion
        for kind, part in zip(kinds, before, strict=False):
            parent = self.joint(parent, kind, place, f"{name} {len(self.motion)}", part)
            place = (0.0, 0.0)
        plane = 0.0 if name == FRAME else self.machine.links[name].plane
        return self.joint(parent, pin.JointModelRZ(), place, name, last, plane)

    def hang(self, name: str, parent: str, label: str) -> None:
        """Hang a link by a pin on a body that is in the tree already."""
        own, p = self.machine.links[name].points[label], self.poses
        place = self.machine.points_of(parent)[label]
        if parent == FRAME:
            pivot = self.machine.frame[drive_pivot(self.machine)]
            place = (place[0] - pivot[0], place[1] - pivot[1])
        else:
            held = self.held[parent]
            place = (place[0] - held[0], place[1] - held[1])
        relative = [p.angle[name], p.omega[name], p.alpha[name]]
        if parent != FRAME:
            before = (p.angle[parent], p.omega[parent], p.alpha[parent])
            relative = [a - b for a, b in zip(relative, before, strict=True)]
        a, v, c = relative
        across = self.machine.links[name].plane
        across -= 0.0 if parent == FRAME else self.machine.links[parent].plane
        kind = pin.JointModelRZ()
        number = self.joint(self.numbers[parent], kind, place, name, (a, v, c), across)
        self._finish(name, number, own)

    def float(self, name: str) -> None:
        """Hang a link that no pin holds on the base."""
        p, pivot = self.poses, np.array(self.machine.frame[drive_pivot(self.machine)])
        at = p.origin[name] - pivot
        motion = [(at[:, k], p.velocity[name][:, k], p.acceleration[name][:, k]) for k in (0, 1)]
        motion.append((p.angle[name], p.omega[name], p.alpha[name]))
        self._finish(name, self.loose(self.numbers[FRAME], name, (0.0, 0.0), motion), (0.0, 0.0))

    def _finish(self, name: str, number: int, held: Vector) -> None:
        """Give a link its mass; its joint's axes have their origin where it is held."""
        link: Link = self.machine.links[name]
        self.numbers[name] = number
        self.held[name] = held
        for mass, at, plane, inertia in pieces(link):
            lever = np.array([at[0] - held[0], at[1] - held[1], plane - link.plane])
            body = pin.Inertia(mass, lever, np.eye(3) * inertia)
            self.model.appendBodyToJoint(number, body, pin.SE3.Identity())


def tree(machine: Machine, poses: Poses) -> Tree:
    """Build the tree from the frame outwards."""
    grown = Tree(machine, poses)
    nothing = np.zeros_like(poses.crank_angle)
    pivot = machine.frame[drive_pivot(machine)]
    grown.numbers[FRAME] = grown.loose(0, FRAME, pivot, [(nothing, nothing, nothing)] * 5)
    while len(grown.numbers) <= len(machine.links):
        name, parent, label = _next(machine, grown)
        if parent:
            grown.hang(name, parent, label)
        else:
            grown.float(name)
    return grown


def _next(machine: Machine, grown: Tree) -> tuple[str, str, str]:
    """Return a link that is not in the tree, and the body and pin by which it can hang."""
    for label, bodies in pins(machine).items():
        held = [body for body in bodies if body in grown.numbers]
        free = [body for body in bodies if body not in grown.numbers]
        if held and free:
            return free[0], held[0], label
    return next(name for name in machine.links if name not in grown.numbers), "", ""


def totals(machine: Machine, poses: Poses) -> Totals:
    """Return what Pinocchio finds for shaking force, shaking moment and drive torque."""
    grown = tree(machine, poses)
    bare, heavy = (demanded(grown, gravity) for gravity in ((0.0, 0.0), machine.gravity))
    rates = np.column_stack([velocity for _, velocity, _ in grown.motion])
    work = np.sum(heavy * rates, -1) / machine.drive.speed
    torque = work - work_per_crank_angle(machine, poses)
    return Totals(-bare[:, :2], -bare[:, 4], torque, -bare[:, 2:4])


def demanded(grown: Tree, gravity: Vector) -> Array:
    """Return the forces of all joints at every crank angle, the base's first, (N, joints)."""
    model = grown.model
    model.gravity.linear = np.array([*gravity, 0.0])
    data = model.createData()
    at, rate, change = (np.column_stack(part) for part in zip(*grown.motion, strict=True))
    rows = [pin.rnea(model, data, *row) for row in zip(at, rate, change, strict=True)]
    return np.array([np.array(row) for row in rows])
