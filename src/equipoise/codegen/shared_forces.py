"""Forces that joints share, in terms: of all that hold the machine, those of the least squares.

With the equations A x = b of all free bodies these are x = A' y, where A A' y = b.  A A' is
symmetric and positive, so that it is eliminated in the order in which it stands, without pivots.
"""

from __future__ import annotations

from math import tau
from typing import Any

import numpy as np

from equipoise.codegen.trace import Trace
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.loops import CouplingLoop, Pose, Poses
from equipoise.mechanism.assembly.shared import RedundantReactions
from equipoise.mechanism.checks import FRAME

STRONG = 1e-3
"""How well joints have to hold the machine: products of rows lose the square of it in digits, so
that 1e-10 of the forces is left."""
LOOKED_AT = 180
"""Crank angles in a turn at which it is seen how well they do."""
SWITCHING = Note(
    "forces that joints share with teeth or strands, which bear by the sense of the force, cannot "
    "be computed in a loop"
)
STIFF = Note("forces that joints share by their stiffness cannot be computed in a loop")
SINGULAR = Note("joint forces near a singular position cannot be computed in a loop")

Column = dict[int, Any]


def check_shared(trace: Trace) -> None:
    """Raise a `UsageError` where forces that joints share have no formula that holds."""
    shared = trace.linkage.shared
    assert shared is not None
    if any(isinstance(loop, CouplingLoop) for loop in shared.loops):
        raise UsageError(SWITCHING)
    if shared.compliance:
        raise UsageError(STIFF)
    turns = trace.linkage.cycle.turns
    theta = np.linspace(0.0, tau * turns, LOOKED_AT * turns, endpoint=False)
    if np.min(shared.strength(trace.linkage.solve(theta))) < STRONG:
        raise UsageError(SINGULAR)


def trace_shared(trace: Trace, number: int) -> None:
    """Add the forces in all joints, and what each drive gets: the step of this number of the
    linkage's ``forces``.
    """
    shared = trace.linkage.forces[number]
    assert isinstance(shared, RedundantReactions)
    poses = _poses(trace, shared)
    size = float(shared.group.size)
    columns, units = [], []
    for loop in shared.loops:
        columns += shared.columns(loop, poses, 0.0)
        units += [size if loop.turns and not part else 1.0 for part in range(loop.unknowns)]
    for drive in shared.drives:
        columns.append({3 * shared.group.links.index(drive) + 2: 1.0})
        units.append(size)
    rows = [1.0, 1.0, size] * len(shared.group.links)
    columns = [
        {row: entry * (unit / rows[row]) for row, entry in column.items() if not _is_zero(entry)}
        for column, unit in zip(columns, units, strict=True)
    ]
    demand = [part for link in shared.group.links for part in _demand(trace, link)]
    right = [part * (1.0 / row) for part, row in zip(demand, rows, strict=True)]
    weights = _eliminated(columns, right)
    strengths = iter([
        unit * sum(entry * weights[row] for row, entry in column.items())
        for column, unit in zip(columns, units, strict=True)
    ])  # fmt: skip
    state = trace.state
    for loop, reaction in zip(shared.loops, shared.reactions, strict=True):
        wrenches = loop.wrenches(poses, 0.0)
        parts = [next(strengths) for _ in wrenches]
        for name, unit in zip(reaction.outputs, zip(*wrenches, strict=True), strict=False):
            state[name] = sum(part * item for part, item in zip(parts, unit, strict=True))
        state.setdefault(f"p({reaction.at})", loop.place(poses))
    for drive, pin in shared.pins.items():
        state[f"F({drive})"], state[f"M({drive})"] = state[pin.force], next(strengths)


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


def _eliminated(columns: list[Column], right: list[Any]) -> list[Any]:
    """What the products of rows make the right-hand side of.

    columns : of the equations, by row, without zeros.
    """
    count = len(right)
    products = [dict[int, Any]() for _ in range(count)]  # of each row, from its own place on
    for column in columns:
        for i, item in column.items():
            for j, other in column.items():
                if j >= i:
                    value = item * other
                    products[i][j] = products[i][j] + value if j in products[i] else value
    solution = [*right]
    for i, row in enumerate(products):
        inverse = row[i] = 1.0 / row[i]
        for j in [j for j in row if j > i]:
            share = row[j] * inverse
            for k in [k for k in row if k >= j]:
                value = share * row[k]
                products[j][k] = products[j][k] - value if k in products[j] else -value
            solution[j] = solution[j] - share * solution[i]
    for i in reversed(range(count)):
        row = products[i]
        left = sum((row[j] * solution[j] for j in row if j > i), 0.0)
        solution[i] = (solution[i] - left) * row[i]
    return solution
