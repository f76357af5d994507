"""Loads from outside, those against crank angle and the soil's, springs, and what holds them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import pi
from typing import Any

import numpy as np

from equipoise.mechanism import kernels
from equipoise.mechanism.model import Load, LoadTable
from equipoise.mechanism.motion import Motion
from equipoise.mechanism.reactions import Demand
from equipoise.mechanism.soil import soil_force
from equipoise.mechanism.spring import spring_force
from equipoise.mechanism.tip import tip_link

Array = np.ndarray[Any, Any]
Acting = tuple[str, str | None, Array, Any]
"""Link, its point or None for a torque, force and torque."""

ROUNDING = 1e-9
"""rad: a window includes its first crank angle and excludes its last, whatever their rounding."""


def load_demands(motion: Motion) -> dict[str, Demand]:
    """What holds the loads, for every link that has one."""
    return demands_of(motion, _loads(motion))


def spring_demands(motion: Motion) -> dict[str, Demand]:
    """What holds the springs, for every link that has one.

    Raises
    ------
    ModelError : the ends of a spring with a free length meet.
    """
    springs = motion.machine.springs
    return demands_of(motion, ((s.link, s.point, spring_force(motion, s), 0.0) for s in springs))


def demands_of(motion: Motion, acting: Iterable[Acting]) -> dict[str, Demand]:
    """What holds forces (complex, N) and torques (N m), for every link that has one."""
    result: dict[str, Demand] = {}
    for link, point, force, torque in acting:
        anchor = motion.state[f"p({motion.linkage.anchors[link]})"]
        at = anchor if point is None else motion.points[point].place
        f, m = kernels.load_demand(anchor, at, force, torque)
        before = result.get(link, (0.0, 0.0))
        result[link] = (before[0] + f, before[1] + m)
    return result


def _loads(motion: Motion) -> Iterator[Acting]:
    """Link, point, force and torque of each load."""
    machine = motion.machine
    for load in machine.loads:
        yield load.link, load.point, *load_at(load, motion.crank_angle)
    if machine.planting is not None and machine.planting.soil is not None:
        yield tip_link(machine), machine.planting.tip, soil_force(motion), 0.0


def _interpolated(table: LoadTable, column: tuple[float, ...], crank_angle: Array) -> Array:
    """Linear between the rows; a table of less than a whole turn goes on to its first row."""
    first = table.crank_angle[0]
    angles, values = [a - first for a in table.crank_angle], list(column)
    if angles[-1] < 2 * pi - ROUNDING:
        angles, values = [*angles, 2 * pi], [*values, values[0]]
    return np.interp(np.mod(crank_angle - first, 2 * pi), angles, values)


def load_at(load: Load, crank_angle: Array) -> tuple[Array, Array]:
    """Force (complex, N) and torque (N m) of a load at crank angles (N,)."""
    zero = np.zeros(len(crank_angle))
    if load.table is not None:
        columns = [_interpolated(load.table, column, crank_angle) for column in load.table.values]
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
