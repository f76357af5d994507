"""Statically indeterminate joint forces, in terms.

With the equations A x = b of all free bodies the least forces are x = A' y, where A A' y = b.  A A'
is symmetric and positive, so that it is eliminated in the order in which it stands, without pivots.
Where joints have a stiffness, x' S x is least with the compliances S: soft joints bear S^-1 A' y,
and for rigid ones, with the columns R, R' y = 0 and A S^-1 A' y + R x = b.  As R' y is 0, R R' y
may be added: the matrix is positive with it, and nothing that is divided by is 0.

Teeth and strands bear by the sense of their force.  From the senses without slant, those are
changed that do not agree, a fixed number of times; whether all agree then is watched.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from math import tau
from typing import Any

import numpy as np

from equipoise.codegen.terms import select
from equipoise.codegen.trace import Trace
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.loops import Pose, Poses
from equipoise.mechanism.assembly.redundant_reactions import RedundantReactions
from equipoise.mechanism.checks import FRAME
from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.dynamics.reactions import idle_teeth_notes
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.motion import move

STRONG = 1e-3
"""How well joints have to hold the machine: products of rows lose the square of it in digits, so
that 1e-10 of the forces is left."""
LOOKED_AT = 180
"""Crank angles in a turn at which it is seen how well they do."""
CHANGES = 2
"""How often senses are changed that do not agree with their forces."""
MOST_SWITCHING, MOST_RIGID = 2, 6
"""Teeth and strands, and forces without stiffness beside such with one, of which loops are
compiled: more take minutes to compile, and scripts take them.
"""
NO_SIGN = 1e-9
"""Of the largest force that is asked for: a push that is smaller has no sense."""
SWITCHING = Note(
    "forces that joints share with teeth or strands of which none agrees with its force at some "
    "crank angle cannot be computed in a loop"
)
MANY = Note(
    "forces that joints share with many teeth or strands, or by a stiffness that few of them have, "
    "cannot be computed in a loop"
)
SINGULAR = Note("joint forces near a singular position cannot be computed in a loop")

SparseColumn = dict[int, Any]


def check_shared(trace: Trace) -> None:
    """Raise a `UsageError` where forces that joints share have no formula that holds."""
    shared = trace.linkage.shared
    assert shared is not None
    turns = trace.linkage.cycle.turns
    theta = np.linspace(0.0, tau * turns, LOOKED_AT * turns, endpoint=False)
    if np.min(shared.strength(trace.linkage.solve(theta))) < STRONG:
        raise UsageError(SINGULAR)
    loops = shared.loops
    switching = [loop for loop in loops if loop.switches]
    forces_of = zip(loops, shared.reactions, strict=True)
    rigid = sum(loop.unknowns for loop, item in forces_of if item.force not in shared.compliance)
    many = len(switching) > MOST_SWITCHING or (shared.compliance and rigid > MOST_RIGID)
    if many and not trace.alone:
        raise UsageError(MANY)
    if switching:
        solved = forces(move(trace.machine, theta)).solved
        if any(idle_teeth_notes(trace.linkage, solved.state)):
            raise UsageError(SWITCHING)


def trace_shared(trace: Trace, number: int) -> None:
    """Add the forces in all joints, and what each drive gets: the step of this number of the
    linkage's ``forces``.
    """
    step = trace.linkage.forces[number]
    assert isinstance(step, RedundantReactions)
    _SharedForces(trace, step).put()


class _SharedForces:
    """Joints that share forces, whose numbers are terms.

    couplings : places of teeth and strands among the loops whose line depends on their sense.
    """

    def __init__(self, trace: Trace, shared: RedundantReactions) -> None:
        self.trace, self.shared = trace, shared
        self.poses = _poses(trace, shared)
        demand = [part for link in shared.group.links for part in _demand(trace, link)]
        rows = shared.rows.tolist()
        self.right = [part * (1.0 / row) for part, row in zip(demand, rows, strict=True)]
        self.couplings = [k for k, loop in enumerate(shared.loops) if loop.switches]

    def put(self) -> None:
        """Add the forces to the state."""
        shared, state = self.shared, self.trace.state
        senses = self.senses()
        strengths = iter(self.strengths(senses))
        of_loops = [[*islice(strengths, loop.unknowns)] for loop in shared.loops]
        shared.put(state, self.poses, senses, of_loops)
        for drive, pin in shared.pins.items():
            state[f"F({drive})"], state[f"M({drive})"] = state[pin.force], next(strengths)

    def senses(self) -> list[Any]:
        """Sense of each loop's push; 0 of those that have none."""
        senses: list[Any] = [0.0] * len(self.shared.loops)
        if not self.couplings:
            return senses
        for k, push in zip(self.couplings, self.pushes(senses), strict=True):
            (senses[k],) = kernels.flank(push)
        for _ in range(CHANGES):
            for k, push in zip(self.couplings, self.pushes(senses), strict=True):
                senses[k] = select(push * senses[k], 0.0, senses[k], -senses[k])
        largest = NO_SIGN * sum((abs(part) for part in self.right), 0.0)
        for k, push in zip(self.couplings, self.pushes(senses), strict=True):
            loop = self.shared.loops[k]
            agrees = select(push * senses[k] + largest, 0.0, 1.0, -1.0)
            self.trace.running[f"sense of {loop.name}"] = agrees
            self.trace.state[f"flank({loop.name})"] = senses[k]
        return senses

    def pushes(self, senses: Sequence[Any]) -> list[Any]:
        """Pushes of those whose line depends on it, by given senses."""
        strengths = self.strengths(senses)
        unknowns = [loop.unknowns for loop in self.shared.loops]
        return [strengths[sum(unknowns[:k])] for k in self.couplings]

    def strengths(self, senses: Sequence[Any]) -> list[Any]:
        """What each joint bears of its unit forces, then the torque of each drive."""
        shared = self.shared
        rows, units = shared.rows.tolist(), shared.units.tolist()
        columns = [
            {row: entry * (unit / rows[row]) for row, entry in column.items()
             if not _is_zero(entry)}
            for column, unit in zip(shared.columns(self.poses, senses), units, strict=True)
        ]  # fmt: skip
        if shared.compliance:
            soft = (shared.softness / np.max(shared.softness)).tolist()
            values = _softest(columns, soft, self.right)
        else:
            weights = _eliminated(_products(columns, len(rows)), self.right)
            values = [
                sum(entry * weights[row] for row, entry in column.items()) for column in columns
            ]
        return [unit * value for unit, value in zip(units, values, strict=True)]


def _poses(trace: Trace, shared: RedundantReactions) -> Poses:
    """Where the links are, from their anchors, and the frame from the pivot of the first drive."""
    poses = {FRAME: Pose((trace.state[f"p({shared.pivot})"], 0j, 0j), (1 + 0j, 0.0, 0.0))}
    for link in shared.group.links:
        x, x1, x2, turn, w, a = trace.body(link)
        poses[link] = Pose((x, x1, x2), (turn, w, a))
    return poses


def _demand(trace: Trace, link: str) -> tuple[Any, Any, Any]:
    force, moment = trace.state[f"F({link})"], trace.state[f"M({link})"]
    return force.real, force.imag, moment


def _is_zero(entry: Any) -> bool:
    return isinstance(entry, int | float) and entry == 0


def _products(columns: Sequence[SparseColumn], count: int) -> list[SparseColumn]:
    """Of each of so many rows its products with others, from its own place on.

    columns : of the equations, by row, without zeros.
    """
    products = [SparseColumn() for _ in range(count)]
    for column in columns:
        for i, item in column.items():
            for j, other in column.items():
                if j >= i:
                    _gain(products[i], j, item * other)
    return products


def _softest(
    columns: Sequence[SparseColumn], soft: Sequence[float], right: Sequence[Any]
) -> list[Any]:
    """Of all unknowns that meet the equations those that store the least energy.

    soft : energy of a unit of each; 0 of those that are rigid.
    """
    count = len(right)
    rigid = [k for k, energy in enumerate(soft) if not energy]
    weighed = [
        {row: entry * (energy or 1.0) ** -0.5 for row, entry in column.items()}
        for column, energy in zip(columns, soft, strict=True)
    ]
    matrix = _products(weighed, count) + [SparseColumn() for _ in rigid]
    for place, k in enumerate(rigid, count):
        for row, entry in columns[k].items():
            matrix[row][place] = entry
    solution = _eliminated(matrix, [*right, *[0.0] * len(rigid)])
    forces = dict(zip(rigid, solution[count:], strict=True))
    for k, (column, energy) in enumerate(zip(columns, soft, strict=True)):
        if energy:
            forces[k] = sum(entry * solution[row] for row, entry in column.items()) * (1 / energy)
    return [forces[k] for k in range(len(columns))]


def _gain(row: SparseColumn, place: int, value: Any) -> None:
    row[place] = row[place] + value if place in row else value


def _eliminated(matrix: list[SparseColumn], right: Sequence[Any]) -> list[Any]:
    """Solve symmetric equations, whose rows are there from their own place on."""
    count = len(right)
    solution = [*right]
    for i, row in enumerate(matrix):
        inverse = row[i] = 1.0 / row[i]
        for j in [j for j in row if j > i]:
            share = row[j] * inverse
            for k in [k for k in row if k >= j]:
                _gain(matrix[j], k, -(share * row[k]))
            solution[j] = solution[j] - share * solution[i]
    for i in reversed(range(count)):
        row = matrix[i]
        left = sum((row[j] * solution[j] for j in row if j > i), 0.0)
        solution[i] = (solution[i] - left) * row[i]
    return solution
