"""Every output is linear in inertial parameters and springs: regressor, and base parameters.

The parameters of a link are its mass, its two first moments and its moment of inertia, the last
three about the origin of the link's axes.  Without loads and springs an output is
``values @ regressor``.  Several parameters always act together; the base parameters are the
combinations that the outputs can tell apart.

A spring makes drive and joints bear what is linear in its stiffness and its pull.  With the vector
d from the link's point to the frame's, it exerts k d + f d / |d|, where k is its stiffness and
f = -k l0 the pull that a free length l0 takes off.  So drive torque and joint forces are those
without the spring, plus k times the first row and f times the second.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.errors import MassError, UsageError
from equipoise.mechanism import kernels
from equipoise.mechanism.dynamics import Forces, demand_of_inertia, forces, massless, place_of
from equipoise.mechanism.model import Link, Machine, Vector, unknown
from equipoise.mechanism.motion import Motion, move
from equipoise.mechanism.reactions import (
    Demand,
    JointForce,
    MeshForce,
    demands_of,
    reactions,
    spring_direction,
    spring_vector,
)
from equipoise.mechanism.steps import planar

Array = np.ndarray[Any, Any]

QUANTITIES = ("mass", "moment_x", "moment_y", "inertia")
"""Inertial parameters of a link: kg, kg m, kg m, kg m2; moments and inertia about its origin."""

FRAME_OUTPUTS = ("shaking_force", "shaking_moment", "drive_torque")


@dataclass(frozen=True, eq=False)
class Regressor:
    """Derivative of every output by every inertial parameter.

    parameters : P pairs of link and quantity; values : (P,) those of the machine.
    shaking_force, frame_force : (P, N) complex.  shaking_moment, frame_moment, drive_torque :
        (P, N).  joints, gears : name -> force whose arrays are (P, N).

    What loads and springs add is `Forces.split` of causes "load" and "spring".
    """

    parameters: tuple[tuple[str, str], ...]
    values: Array
    shaking_force: Array
    shaking_moment: Array
    frame_force: Array
    frame_moment: Array
    drive_torque: Array
    joints: Mapping[str, JointForce]
    gears: Mapping[str, MeshForce]


@dataclass(frozen=True, eq=False)
class BaseParameters:
    """The combinations of inertial parameters that the outputs can tell apart.

    parameters : P pairs of link and quantity.
    combinations : (B, P); row k is base parameter k, a sum of parameters with these factors.
    values : (B,) those of the machine.
    """

    parameters: tuple[tuple[str, str], ...]
    combinations: Array
    values: Array | None

    @property
    def count(self) -> int:
        return len(self.combinations)

    def __str__(self) -> str:
        return "\n".join(self._row(row) for row in self.combinations)

    def _row(self, row: Array) -> str:
        terms = [
            f"{factor:+.6g} {link}.{quantity}"
            for factor, (link, quantity) in zip(row, self.parameters, strict=True)
            if abs(factor) > 1e-12
        ]
        return " ".join(terms)


def parameter_names(machine: Machine) -> tuple[tuple[str, str], ...]:
    """Pairs of link and quantity, in file order."""
    return tuple((link, quantity) for link in machine.links for quantity in QUANTITIES)


def parameter_values(machine: Machine) -> Array:
    """Inertial parameters of a machine (P,), in the order of `parameter_names`."""
    if missing := massless(machine):
        raise MassError(missing)
    return np.array([value for link in machine.links.values() for value in parameters_of(link)])


def parameters_of(link: Link) -> tuple[Any, Any, Any, Any]:
    """The four of one link, in the order of `QUANTITIES`; columns where its numbers are."""
    assert link.mass is not None and link.center_of_mass is not None and link.inertia is not None
    to_origin = -planar(link.center_of_mass)
    mass, moment, inertia = kernels.about(link.mass, 0j, link.inertia, to_origin)
    return mass, moment.real, moment.imag, inertia


def regressor(motion: Motion, about: str | Vector | complex | None = None) -> Regressor:
    """Derivatives of every output by every inertial parameter.

    about : point about which moments are taken, a name or (x, y) in m; the drive pivot if None.
    """
    machine = motion.machine
    values = parameter_values(machine)
    whole = forces(motion, about)
    pole = place_of(machine, motion.linkage.pivot if about is None else about)
    inertia, total = _unit_demands(motion)
    solved = reactions(motion, total, whole.solved)
    shaking = Forces(motion, pole, inertia, {}, {})
    return Regressor(
        parameter_names(machine),
        values,
        -sum(force for force, _ in inertia.values()),
        shaking.shaking_moment,
        solved.frame_force,
        solved.frame_moment(pole),
        solved.drive_torque,
        solved.joints,
        solved.gears,
    )


def _unit_demands(motion: Motion) -> tuple[dict[str, Any], dict[str, Any]]:
    """Demands of a unit of each parameter, without and with weight: link -> (P, N) pairs."""
    machine = motion.machine
    count, shape = len(machine.links), len(motion.crank_angle)
    gravity = complex(*machine.gravity)
    inertia, total = {}, {}
    for k, link in enumerate(machine.links):
        own = _about_anchor(motion, link)
        moving = demand_of_inertia(motion, link, motion.speed**2, *own)
        weight = kernels.weight_demand(motion.state[f"u({link})"], *own[:2], gravity)
        inertia[link] = _spread(moving, k, count, shape)
        carried = _spread(weight, k, count, shape)
        total[link] = tuple(a + b for a, b in zip(inertia[link], carried, strict=True))
    return inertia, total


def _about_anchor(motion: Motion, link: str) -> tuple[Array, Array, Array]:
    """Mass, first moment and inertia about the anchor for a unit of each parameter, (4, 1)."""
    points = motion.machine.links[link].points
    r = complex(*points[motion.linkage.anchors[link]])
    mass = np.array([1.0, 0, 0, 0])
    moment = np.array([0, 1, 1j, 0])
    inertia = np.array([0, 0, 0, 1.0])
    mass, moment, inertia = kernels.about(mass, moment, inertia, r)
    return mass[:, None], moment[:, None], inertia[:, None]


def _spread(demand: tuple[Any, Any], k: int, count: int, shape: int) -> tuple[Array, Array]:
    """Put the four rows of link k among those of all links."""
    result = (np.zeros((4 * count, shape), complex), np.zeros((4 * count, shape)))
    for rows, part in zip(result, demand, strict=True):
        rows[4 * k : 4 * k + 4] = part
    return result


def base_parameters(
    machine: Machine, outputs: Sequence[str] = FRAME_OUTPUTS, angles: int = 72
) -> BaseParameters:
    """Find the combinations of inertial parameters that some outputs can tell apart, in any motion.

    Parameters
    ----------
    outputs : names of outputs of `Regressor`: those of the frame by default.
    angles : crank angles a turn at which the outputs are compared.

    Notes
    -----
    The columns are taken in order; one that is a combination of those before it is grouped with
    them, after Gautier, "Numerical calculation of the base inertial parameters of robots", 1991.
    """
    if isinstance(outputs, str):
        outputs = [outputs]
    if not outputs:
        raise UsageError("give at least one output, such as drive_torque")
    names = parameter_names(machine)
    size = _length(machine)
    motion = move(_with_any_masses(machine), angles)
    matrix = np.concatenate([_rows(motion, output, size) for output in outputs])
    scale = np.tile([1.0, size, size, size**2], len(machine.links))
    kept, grouping = independent_columns(matrix * scale)
    combinations = grouping * scale[kept][:, None] / scale
    complete = all(link.has_mass for link in machine.links.values())
    values = combinations @ parameter_values(machine) if complete else None
    return BaseParameters(names, combinations, values)


def _with_any_masses(machine: Machine) -> Machine:
    """Give masses to links that have none: which combinations count does not depend on them."""
    for name, link in machine.links.items():
        if not link.has_mass:
            machine = machine.with_link(name, mass=1.0, center_of_mass=(0.0, 0.0), inertia=1.0)
    return machine


def _length(machine: Machine) -> float:
    places = [abs(complex(*p)) for link in machine.links.values() for p in link.points.values()]
    return max(places) or 1.0


def _rows(motion: Motion, output: str, size: float) -> Array:
    """Rows of an output in any motion: at rest, at constant speed, starting from rest."""
    rate = (9.81 / size) ** 0.5
    parts = []
    for case in (motion.at(0.0, 0.0), motion.at(rate, 0.0), motion.at(0.0, rate**2)):
        found = regressor(case)
        names = [name for name, value in vars(found).items() if isinstance(value, np.ndarray)]
        if output not in names[1:]:
            raise UsageError(unknown(output, names[1:], "output"))
        array = getattr(found, output)
        parts += [array.real.T, array.imag.T] if np.iscomplexobj(array) else [array.T / size]
    return np.concatenate(parts)


def independent_columns(matrix: Array, tolerance: float = 1e-9) -> tuple[list[int], Array]:
    """Columns that are no combination of earlier ones, and all columns in terms of these.

    Returns the kept columns' numbers and factors (B, P) with matrix = matrix[:, kept] @ factors.
    """
    limit = tolerance * float(np.max(np.linalg.norm(matrix, axis=0)))
    kept: list[int] = []
    basis = np.zeros((len(matrix), 0))
    for k, column in enumerate(matrix.T):
        rest = column - basis @ (basis.T @ column)
        rest -= basis @ (basis.T @ rest)
        norm = float(np.linalg.norm(rest))
        if norm > limit:
            kept.append(k)
            basis = np.column_stack([basis, rest / norm])
    factors = np.linalg.lstsq(matrix[:, kept], matrix, rcond=None)[0]
    factors[np.abs(factors) < tolerance] = 0.0
    return kept, factors


def spring_columns(
    motion: Motion, link: str, point: str, to: str
) -> tuple[Array, dict[str, Array]]:
    """Drive torque (2, N) and the force in each joint by name (2, N), complex.

    First row: of a spring of 1 N/m without a free length; second row: of a pull of 1 N towards the
    frame's point; each alone.  Shaking force and moment, and force and moment on the frame, have
    nothing of a spring.  Gears press on the flank that all forces of the machine together choose.

    Raises
    ------
    MassError : there are gears, and a link has no mass given.
    ModelError : the ends meet, so that a pull has no direction.
    UsageError : there is no such link or point.
    """
    _check(motion.machine, link, point, to)
    units = np.stack([spring_vector(motion, point, to), spring_direction(motion, link, point, to)])
    zero = np.zeros(units.shape)
    demands: dict[str, Demand] = dict.fromkeys(motion.machine.links, (zero + 0j, zero))
    demands |= demands_of(motion, [(link, point, units, 0.0)])
    like = forces(motion).solved if motion.machine.gears else None
    solved = reactions(motion, demands, like)
    return solved.drive_torque, {name: joint.value for name, joint in solved.joints.items()}


def _check(machine: Machine, link: str, point: str, to: str) -> None:
    if link not in machine.links:
        raise UsageError(unknown(link, machine.links, "link"))
    points = machine.links[link].points
    if point not in points:
        raise UsageError(unknown(point, points, f"point of {link}"))
    if to not in machine.frame:
        raise UsageError(unknown(to, machine.frame, "point of the frame"))
