"""Loads from outside at any crank angle, and their work in a cycle."""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np

from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.steps import Array
from equipoise.mechanism.dynamics.lines import load_axis
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.force_elements import ROUNDING
from equipoise.mechanism.parts.machine import Load, LoadTable, Machine


def _interpolated(load: Load, table: LoadTable, crank_angle: Array) -> list[Array]:
    """Each column of a table, linear between the rows and beyond the last one as it says."""
    first, period = table.crank_angle[0], 2 * pi * table.turns
    since = np.mod(crank_angle - first + ROUNDING, period) - ROUNDING
    angles, columns = np.subtract(table.crank_angle, first), np.array(table.values)
    if load.outside == "wrap" and not table.covers:
        angles, columns = np.append(angles, period), np.append(columns, columns[:, :1], axis=1)
    ends = 0.0 if load.outside == "zero" and not table.covers else None
    since = np.where(abs(since - table.span) < ROUNDING, table.span, np.maximum(since, 0.0))
    return [np.interp(since, angles, column, right=ends) for column in columns]


def load_at(load: Load, crank_angle: Array) -> tuple[Array, Array]:
    """Force (complex, N), in the load's axes, and torque (N m) at crank angles (N,)."""
    zero = np.zeros(len(crank_angle))
    if (rows := load.rows) is not None:
        columns = _interpolated(load, rows, crank_angle)
    elif load.force is not None:
        columns = [zero + load.force[0], zero + load.force[1]]
    else:
        columns = [zero + (load.torque or 0.0)]
    if load.start is not None and load.stop is not None:
        span = np.mod(load.stop - load.start, 2 * pi) or 2 * pi
        acts = np.mod(crank_angle - load.start + ROUNDING, 2 * pi) < span
        columns = [np.where(acts, column, 0.0) for column in columns]
    if len(columns) == 2:
        return columns[0] + 1j * columns[1], zero
    return zero + 0j, columns[0]


def acting_load(motion: Motion, where: str, load: Load) -> tuple[Array, Array]:
    """Force (complex, N) in the axes of the frame, and torque (N m) of a load in a motion.

    where : its place in the file.

    Raises
    ------
    ModelError : the points between which it acts meet.
    """
    force, torque = load_at(load, motion.crank_angle)
    return force * load_axis(motion, where, load), torque


PIECE, NODES = pi / 12, 4
"""Longest piece of a cycle, rad, over which work is summed, and crank angles in it."""


class LoadWork(NamedTuple):
    """What a load does in a whole cycle.

    net : its work, J.  both : work that it gives and that it takes, added up, J.
    largest : its largest size, N or N m.
    """

    net: float
    both: float
    largest: float


def work_in_cycle(machine: Machine, load: Load, where: str = "loads") -> LoadWork:
    """What a load does in a whole cycle.

    where : its place in the file.

    Gauss's quadrature between its rows, its ends and the angles of a grid, so that what sets in or
    ends suddenly is no trouble; from the motion alone, without masses.  What the mean of a load
    does is known: a force nothing, as its point comes back, a torque itself times the link's turns.
    Where a link bears the opposite, its work is that of both.

    Raises
    ------
    MotionError : the crank cannot turn fully.
    """
    cycle = assemble(machine).cycle
    edges = _edges(load, cycle.turns)
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    half = 0.5 * np.diff(edges)
    theta = (edges[:-1] + half + half * nodes[:, None]).ravel()
    motion = move(machine, theta)
    force, torque = acting_load(motion, where, load)
    turning, way = _ways(motion, load)
    share = (half * weights[:, None]).ravel()
    parts = share * (torque * turning + kernels.dot(force, way))
    steady = share @ force / edges[-1], share @ torque / edges[-1]
    if load.reaction_link is not None:  # past which its point does not come back in the frame
        steady = 0j, steady[1]
    summed = np.sum(parts - share * (steady[1] * turning + kernels.dot(steady[0], way)))
    # just behind and just before each edge, where what is linear between them is largest
    ends = (load_at(load, at) for at in (edges, edges - 3 * ROUNDING))
    sizes = [np.hypot(abs(force), torque) for force, torque in ends]
    windings = cycle.windings[load.link]
    if load.reaction_link is not None:
        windings -= cycle.windings[load.reaction_link]
    whole = summed + steady[1] * 2 * pi * windings
    net = float(whole) * (1 if machine.drive.speed >= 0 else -1)
    return LoadWork(net, float(np.sum(np.abs(parts))), float(np.max(sizes)))


def _ways(motion: Motion, load: Load) -> tuple[Array, Array]:
    """Turning and way of the loaded point, by the crank angle (N,): past the link that bears the
    opposite of the load, if one does, so that work is that of both.
    """
    turning = motion.links[load.link].angle_1
    point = None if load.point is None else motion.points[load.point]
    way = turning * 0j if point is None else point.place_1
    if load.reaction_link is None:
        return turning, way
    other, anchor = motion.links[load.reaction_link].angle_1, motion.linkage.anchors
    if point is not None:
        at = motion.points[anchor[load.reaction_link]]
        way = way - at.place_1 - 1j * other * (point.place - at.place)
    return turning - other, way


def _edges(load: Load, turns: int) -> Array:
    """Crank angles of a cycle between which a load and its motion are smooth, from 0 on."""
    cycle = 2 * pi * turns
    values = [np.arange(0.0, cycle, PIECE)]
    if (rows := load.rows) is not None:
        again = np.arange(0.0, cycle - 1.0, 2 * pi * rows.turns)
        values.append(np.add.outer(again, rows.crank_angle).ravel())
    for angle, every in load.jumps:
        values.append(np.arange(0.0, cycle - 1.0, 2 * pi * every) + angle)
    angles = np.concatenate(values)
    return np.unique(np.append(np.mod(angles, cycle), cycle))
