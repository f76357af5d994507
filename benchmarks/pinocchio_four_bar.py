"""The objective of a four-bar by Pinocchio's recursive Newton-Euler algorithm, on one thread.

The loop is closed by the package's own dyad, on arrays of some designs.  The links then are a tree:
crank and coupler in a row, the rocker beside them, and under both a planar joint that stands still,
whose force and torque are those on the frame.  Joints between rigid links do no work, so the
drive's torque is that of all joints of the tree, each times how fast its angle changes with the
crank's.

What Pinocchio does best is taken: all crank angles of a design in one call, joints whose cosine and
sine are handed over, and one model, in which lengths and masses are changed from design to design.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pinocchio as pin

from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.machine import Link, Machine

VERSION = pin.__version__
AT_A_TIME = 8192
"""Designs times crank angles whose motion is computed in one go."""
JOINTS = {"crank": 2, "coupler": 3, "rocker": 4}
"""Numbers of the links' joints; joint 1 is that of the frame."""
VERTICAL, TURNING, FIRST = 1, 2, 3
"""Places among the forces of all joints: of two of the frame's three, and of the first link's."""
Array = np.ndarray
InverseDynamics = Callable[[Array, Array, Array, Array], None]
"""From place, velocity and acceleration of all joints (N, ...) to what it fills: their forces."""


class FourBar:
    """Designs of a four-bar with crank AB, coupler BC and rocker DC.

    lengths, masses : link -> column of the values that varies it.
    """

    def __init__(
        self, machine: Machine, lengths: Mapping[str, int], masses: Mapping[str, int], angles: int
    ) -> None:
        self.machine, self.lengths, self.masses = machine, lengths, masses
        self.crank = np.exp(1j * np.arange(angles) * (2 * np.pi / angles))
        self.pool = pin.ModelPool(_tree(machine), 1)
        self.model, self.data = self.pool.getModel(0), self.pool.getData(0)

    def __call__(self, values: Array) -> Array:
        """RMS (P, 3) of vertical shaking force, shaking moment and drive torque of designs."""
        return self._all(values, self._batched)

    def one_by_one(self, values: Array) -> Array:
        """The same with one call for each crank angle."""
        return self._all(values, self._looped)

    def _batched(self, q: Array, v: Array, a: Array, forces: Array) -> None:
        pin.rneaInParallel(1, self.pool, q.T, v.T, a.T, forces.T)

    def _looped(self, q: Array, v: Array, a: Array, forces: Array) -> None:
        for k in range(len(q)):
            forces[k] = pin.rnea(self.model, self.data, q[k], v[k], a[k])

    def _all(self, values: Array, inverse_dynamics: InverseDynamics) -> Array:
        many = max(1, AT_A_TIME // len(self.crank))
        parts = np.array_split(values, max(1, len(values) // many))
        return np.concatenate([self._some(part, inverse_dynamics) for part in parts])

    def _some(self, values: Array, inverse_dynamics: InverseDynamics) -> Array:
        u, w, a = self._motion(values)
        speed = self.machine.drive.speed
        forces = np.zeros((*u[0].shape, 6))
        q = np.zeros((*u[0].shape, 10))
        q[..., 2] = 1.0
        rates, accelerations = np.zeros_like(forces), np.zeros_like(forces)
        relative = u[0], u[1] * u[0].conjugate(), u[2]
        turning = (1.0, 0.0), (w[0] - 1, a[0]), (w[1], a[1])
        for k, turn in enumerate(relative):
            q[..., 4 + 2 * k], q[..., 5 + 2 * k] = turn.real, turn.imag
        for k, (rate, acceleration) in enumerate(turning, FIRST):
            rates[..., k], accelerations[..., k] = rate * speed, acceleration * speed**2
        for k, design in enumerate(values):
            self._change(design)
            inverse_dynamics(q[k], rates[k], accelerations[k], forces[k])
        torque = np.einsum("ijk,ijk->ij", forces[..., FIRST:], rates[..., FIRST:]) / speed
        weight, moment = self._weight(values, u)
        signals = forces[..., VERTICAL] - weight, forces[..., TURNING] - moment, torque
        return np.stack([np.sqrt(np.mean(s * s, axis=1)) for s in signals], axis=1)

    def _length(self, values: Array, link: str, point: str) -> Array:
        """Length of a link (P, 1)."""
        if link in self.lengths:
            return values[:, self.lengths[link], None]
        return np.full((len(values), 1), self.machine.links[link].points[point][0])

    def _motion(self, values: Array) -> tuple[Sequence[Array], Sequence[Array], Sequence[Array]]:
        """Rotation (P, N) of crank, coupler and rocker; derivatives of the last two."""
        side = 1.0 if self.machine.assembly["C"] == "left" else -1.0
        b = self._length(values, "crank", "B") * self.crank
        arms = (self._length(values, link, "C") + 0j for link in ("coupler", "rocker"))
        pivot = complex(*self.machine.frame["D"])
        found = kernels.rrr(b, 1j * b, -b, pivot, 0j, 0j, *arms, side)
        crank = np.broadcast_to(self.crank, b.shape)
        return (crank, found[0], found[3]), (found[1], found[4]), (found[2], found[5])

    def _change(self, design: Array) -> None:
        """Put the numbers of a design into the model."""
        if "crank" in self.lengths:
            place = np.array([design[self.lengths["crank"]], 0.0, 0.0])
            self.model.jointPlacements[JOINTS["coupler"]].translation = place
        for link, column in self.masses.items():
            body = self.machine.links[link]
            self.model.inertias[JOINTS[link]] = _inertia(body, design[column])

    def _weight(self, values: Array, u: Sequence[Array]) -> tuple[Array, Array]:
        """Force and moment on the frame of the links' weights, which are not shaking."""
        starts = {
            "crank": 0.0,
            "coupler": self._length(values, "crank", "B") * self.crank.real,
            "rocker": self.machine.frame["D"][0],
        }
        weight = moment = 0.0
        for turn, (name, link) in zip(u, self.machine.links.items(), strict=True):
            mass = values[:, self.masses[name], None] if name in self.masses else link.mass
            x, y = link.center_of_mass
            one = -mass * self.machine.gravity[1]
            weight = weight + one
            moment = moment + one * (starts[name] + x * turn.real - y * turn.imag)
        return weight, moment


def _tree(machine: Machine) -> pin.Model:
    model = pin.Model()
    model.gravity = pin.Motion(np.array([*machine.gravity, 0.0]), np.zeros(3))
    frame = model.addJoint(0, pin.JointModelPlanar(), pin.SE3.Identity(), "frame")
    crank = machine.links["crank"].points["B"]
    for link, parent, place in (
        ("crank", frame, (0.0, 0.0)),
        ("coupler", frame + 1, crank),
        ("rocker", frame, machine.frame["D"]),
    ):
        placement = pin.SE3(np.eye(3), np.array([*place, 0.0]))
        joint = model.addJoint(parent, pin.JointModelRUBZ(), placement, link)
        body = machine.links[link]
        model.appendBodyToJoint(joint, _inertia(body, body.mass), pin.SE3.Identity())
    return model


def _inertia(link: Link, mass: float) -> pin.Inertia:
    """A link with another mass, about its own axes."""
    return pin.Inertia(mass, np.array([*link.center_of_mass, 0.0]), np.diag([link.inertia] * 3))
