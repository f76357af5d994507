"""Every output is linear in inertial parameters and springs: regressor, and base parameters.

The parameters of a link are its mass, its two first moments and its moment of inertia, the last
three about the origin of the link's axes.  Without loads and springs an output is
``values @ regressor``.  Several parameters always act together; the base parameters are the
combinations that are identifiable from the outputs.

A spring makes drive and joints bear what is linear in its stiffness and its pull.  With the vector
d from the link's point to the frame's, it exerts k d + f d / |d|, where k is its stiffness and
f = -k l0 the pull that a free length l0 takes off.  So drive torque and joint forces are those
without the spring, plus k times the first row and f times the second.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import lstsq
from equipoise.displays import Brief
from equipoise.errors import MassError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.steps import planar
from equipoise.mechanism.dynamics.forces import (
    Shares,
    demand_of_inertia,
    forces,
    massless,
)
from equipoise.mechanism.dynamics.loads import direction_between, vector_between
from equipoise.mechanism.dynamics.out_of_plane import (
    OutOfPlaneMoments,
    exerted_in,
    needed_by_inertia,
)
from equipoise.mechanism.dynamics.reactions import JointReactions, pushed, reactions
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.links import in_frame, moments_across
from equipoise.mechanism.parts.machine import Link, Machine, Vector, unknown
from equipoise.mechanism.parts.springs import MEETING
from equipoise.signals import Array

QUANTITIES = ("mass", "moment_x", "moment_y", "inertia")
"""Inertial parameters of a link: kg, kg m, kg m, kg m2; moments and inertia about its origin."""
ACROSS = ("moment_z", "product_zx", "product_yz")
"""More of them, which matter to what links do across the plane: kg m, kg m2, kg m2."""


@dataclass(frozen=True, eq=False, repr=False)
class Regressor(Shares):
    """Derivative of every output by every inertial parameter.

    Arrays are (P, N).  parameters : P pairs of link and quantity; values : (P,) those of the
    machine.  What loads and springs add is `Forces.split` of causes "load" and "spring".
    across : arrays (P + 3 L, N), by the parameters of `values_across`.
    """

    parameters: tuple[tuple[str, str], ...]
    values: Array


@dataclass(frozen=True, eq=False, repr=False)
class BaseParameters(Brief):
    """The combinations of inertial parameters that are identifiable from the outputs.

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
        names = [f"{link}.{quantity}" for link, quantity in self.parameters]
        rows = [zip(row, names, strict=True) for row in self.combinations]
        return "\n".join(" ".join(f"{x:+.6g} {n}" for x, n in r if x) for r in rows)


def parameter_names(
    machine: Machine, quantities: Sequence[str] = QUANTITIES
) -> tuple[tuple[str, str], ...]:
    """Pairs of link and quantity, in file order."""
    return tuple((link, quantity) for link in machine.links for quantity in quantities)


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
    pole = in_frame(machine.frame, motion.linkage.pivot if about is None else about)
    inertia, total = _unit_demands(motion)
    solved = reactions(motion, total, whole.solved)
    return Regressor(
        -sum(force for force, _ in inertia.values()),
        -whole.moment(inertia, pole),
        solved.frame_force,
        solved.frame_moment(pole),
        solved.drive_torque,
        solved.drives,
        solved.joints,
        solved.couplings(lambda _: 0.0),
        _across(motion, solved) if machine.has_planes else None,
        parameter_names(machine),
        values,
        drive_force=pushed(solved),
    )


def _across(motion: Motion, solved: JointReactions) -> OutOfPlaneMoments:
    """What a unit of each parameter does across the plane, and then of each link's sums of mass
    times plane (kg m) and of that times x and y (kg m2, about its origin).
    """
    machine = motion.machine
    count, width = len(machine.links), len(QUANTITIES) + len(ACROSS)
    size, angles = width * count, len(motion.crank_angle)
    gravity = complex(*machine.gravity)
    inertia: dict[str, Array] = {}
    weights: dict[str, Array] = {}
    for k, (name, link) in enumerate(machine.links.items()):
        shift = complex(*link.points[motion.linkage.anchors[name]])
        unit = np.eye(len(ACROSS))[:, :, None]
        own = unit[0], unit[1] + 1j * unit[2] - shift * unit[0]
        rows = slice(len(QUANTITIES) * count + len(ACROSS) * k, None)
        parts = (
            needed_by_inertia(motion, name, own),
            kernels.weight_demand(motion.state[f"u({name})"], *own, gravity)[0],
        )
        for result, part in zip((inertia, weights), parts, strict=True):
            result[name] = np.zeros((size, angles), complex)
            result[name][rows][: len(ACROSS)] = part
    exerted = {
        name: replace(
            joint_force, value=np.pad(joint_force.value, ((0, len(ACROSS) * count), (0, 0)))
        )
        for name, joint_force in exerted_in(solved).items()
    }
    return OutOfPlaneMoments(motion, inertia, weights, {}, {}, exerted)


def values_across(machine: Machine) -> Array:
    """Parameters of `Regressor.across`: those of `parameter_values`, then each link's sums of mass
    times plane, and of that times x and y.
    """
    values = []
    for link in machine.links.values():
        mass, moment = moments_across(link)
        values += [mass, moment.real, moment.imag]
    return np.concatenate([parameter_values(machine), values])


def _unit_demands(motion: Motion) -> tuple[dict[str, Any], dict[str, Any]]:
    """Demands of a unit of each parameter, without and with weight: link -> (P, N) pairs."""
    machine = motion.machine
    count, shape = len(machine.links), len(motion.crank_angle)
    gravity = complex(*machine.gravity)
    inertia, total = {}, {}
    for k, (name, link) in enumerate(machine.links.items()):
        shift = complex(*link.points[motion.linkage.anchors[name]])
        unit = np.eye(4)[:, :, None]  # mass, moments and inertia, of one parameter a row
        own = kernels.about(unit[0], unit[1] + 1j * unit[2], unit[3], shift)
        moving = demand_of_inertia(motion, name, motion.speed**2, *own)
        weight = kernels.weight_demand(motion.state[f"u({name})"], own[0], own[1], gravity)
        inertia[name] = _spread(moving, k, count, shape)
        carried = _spread(weight, k, count, shape)
        total[name] = tuple(a + b for a, b in zip(inertia[name], carried, strict=True))
    return inertia, total


def _spread(demand: tuple[Any, Any], k: int, count: int, shape: int) -> tuple[Array, Array]:
    """Put the four rows of link k among those of all links."""
    result = (np.zeros((4 * count, shape), complex), np.zeros((4 * count, shape)))
    for rows, part in zip(result, demand, strict=True):
        rows[4 * k : 4 * k + 4] = part
    return result


def base_parameters(
    machine: Machine,
    outputs: Sequence[str] = ("shaking_force", "shaking_moment", "drive_torque"),
    angles: int = 72,
) -> BaseParameters:
    """Find the combinations of inertial parameters that outputs can identify, in any motion.

    Parameters
    ----------
    outputs : names of outputs of `Regressor`; by default what frame and drive feel.  With rocking
        moments the sums of `ACROSS` are parameters too, behind all others.
    angles : crank angles a turn at which the outputs are compared.

    Notes
    -----
    The columns are taken in order; one that is a combination of those before it is grouped with
    them, after Gautier, "Numerical calculation of the base inertial parameters of robots", 1991.
    """
    if isinstance(outputs, str):
        outputs = [outputs]
    if not outputs:
        raise UsageError(Note("give at least one output, such as drive_torque"))
    names = parameter_names(machine)
    bodies = (link.points.values() for link in machine.links.values())
    size = max(abs(complex(*place)) for places in bodies for place in places) or 1.0
    known = machine
    for name, link in machine.links.items():
        if not link.has_mass:  # which combinations count does not depend on masses
            known = known.with_link(name, mass=1.0, center_of_mass=(0.0, 0.0), inertia=1.0)
    motion, count = move(known, angles), len(machine.links)
    rows = [_rows(motion, output, size) for output in outputs]
    width = max(part.shape[1] for part in rows)
    matrix = np.concatenate([np.pad(part, ((0, 0), (0, width - part.shape[1]))) for part in rows])
    scale, out_of_plane = np.tile([1.0, size, size, size**2], count), width > len(names)
    if out_of_plane:
        names += parameter_names(machine, ACROSS)
        scale = np.append(scale, np.tile([size, size**2, size**2], count))
    independent, grouping = independent_columns(matrix * scale)
    combinations = grouping * scale[independent][:, None] / scale
    if not all(link.has_mass for link in machine.links.values()):
        return BaseParameters(names, combinations, None)
    own = values_across(machine) if out_of_plane else parameter_values(machine)
    return BaseParameters(names, combinations, combinations @ own)


def _rows(motion: Motion, output: str, size: float) -> Array:
    """Rows of an output in any motion: at rest, at constant speed, starting from rest."""
    rate = (9.81 / size) ** 0.5
    parts: list[Array] = []
    for case in (motion.at(0.0, 0.0), motion.at(rate, 0.0), motion.at(0.0, rate**2)):
        of_machine = regressor(case).of_machine
        if output not in of_machine:
            raise UsageError(unknown(output, of_machine, "output"))
        array = of_machine[output] / (1.0 if output.endswith("force") else size)
        parts += [array.real.T, array.imag.T] if np.iscomplexobj(array) else [array.T]
    return np.concatenate(parts)


def independent_columns(matrix: Array, tolerance: float = 1e-9) -> tuple[list[int], Array]:
    """Columns that are no combination of earlier ones, and all columns in terms of these.

    Returns the kept columns' numbers and factors (B, P) with matrix = matrix[:, kept] @ factors.
    """
    limit = tolerance * float(np.max(np.linalg.norm(matrix, axis=0)))
    independent: list[int] = []
    basis = np.zeros((len(matrix), 0))
    for k, column in enumerate(matrix.T):
        rest = column - basis @ (basis.T @ column)
        rest -= basis @ (basis.T @ rest)
        norm = float(np.linalg.norm(rest))
        if norm > limit:
            independent.append(k)
            basis = np.column_stack([basis, rest / norm])
    factors = lstsq(matrix[:, independent], matrix, rcond=None)[0]
    factors[np.abs(factors) < tolerance] = 0.0
    return independent, factors


def spring_units(motion: Motion, link: str, point: str, to: str, where: str = "springs") -> Array:
    """Force (2, N) on a link's point, N, complex: of a spring of 1 N/m without a free length, and
    of a pull of 1 N towards the frame's point, each alone.

    where : place of the spring in the file.

    Raises
    ------
    ModelError : the ends meet, so that a pull has no direction.
    """
    along = direction_between(motion, where, (link, point, to), MEETING)
    return np.stack([vector_between(motion, point, to), along])
