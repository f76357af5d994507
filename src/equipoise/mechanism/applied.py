"""Applied forces: loads, those against crank angle too, soil and springs; and what holds them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import degrees, pi
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.mechanism import kernels
from equipoise.mechanism.field import Soil
from equipoise.mechanism.force_elements import Spring
from equipoise.mechanism.model import Load, LoadTable
from equipoise.mechanism.motion import Motion
from equipoise.mechanism.reactions import Demand
from equipoise.mechanism.tip import surface_of, tip_link

Array = np.ndarray[Any, Any]
Acting = tuple[str, str | None, Array, Any]
"""Link, its point or None for a torque, force and torque."""

ROUNDING = 1e-9
"""rad: a window includes its first crank angle and excludes its last, whatever their rounding."""
MEETING = 1e-12
"""Of the coordinates of its ends: where they are closer, rounding decides where a spring points."""


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


def soil_force(motion: Motion) -> Array:
    """Force of the soil on the tip (N,), N, complex; 0 above the surface.

    Raises
    ------
    ModelError : the machine has no `[planting]`.
    MotionError : its crank cannot turn fully, so that no lowest point tells where the surface is.
    """
    planting = motion.machine.planting
    if planting is None or planting.soil is None:
        return np.zeros(len(motion.crank_angle), complex)
    tip = motion.points[planting.tip]
    depth = surface_of(motion.machine) - tip.y
    over_ground = tip.velocity + planting.forward(motion.speed)
    speed = np.abs(over_ground)
    size = np.where(depth > 0, resistance(planting.soil, depth, speed), 0.0)
    against = np.divide(-over_ground, speed, out=np.zeros_like(over_ground), where=speed > 0)
    return size * against


def resistance(soil: Soil, depth: Array, speed: Array) -> Array:
    """Size of the force (N,), N, at depths (N,), m, and speeds over ground (N,), m/s."""
    size = soil.resistance + soil.per_depth * depth + soil.per_speed * speed
    size = size + soil.per_depth_and_speed * depth * speed
    if soil.table is not None:
        size = size + np.interp(depth, soil.table.depth, soil.table.resistance)
    return size


def spring_force(motion: Motion, spring: Spring) -> Any:
    """Force of a spring on its link's point (N,), N, complex; minus this on the frame's.

    Raises
    ------
    ModelError : its ends meet, so that a spring with a free length points nowhere.
    """
    if spring.free_length:
        spring_direction(motion, spring.link, spring.point, spring.to)
    to = complex(*motion.machine.frame[spring.to])
    place = motion.points[spring.point].place
    return kernels.spring(place, to, spring.stiffness, spring.free_length)


def spring_vector(motion: Motion, point: str, to: str) -> Any:
    """From a moving point to a point of the frame (N,), m, complex."""
    return complex(*motion.machine.frame[to]) - motion.points[point].place


def spring_direction(motion: Motion, link: str, point: str, to: str) -> Any:
    """Unit vector from a moving point to a point of the frame (N,), complex.

    Raises
    ------
    ModelError : they meet.
    """
    along = spring_vector(motion, point, to)
    length = abs(along)
    coordinates = abs(motion.points[point].place) + abs(complex(*motion.machine.frame[to]))
    meeting = length <= MEETING * coordinates
    if meeting.any():
        angle = degrees(motion.crank_angle[meeting.argmax()])
        raise ModelError(
            "springs",
            f"{point!r} of {link!r} meets {to!r} at crank angle {angle:.6g} deg, where a spring "
            "with a free length points nowhere; give another point, or a free_length of 0",
        )
    return along / length
