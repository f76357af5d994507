"""Torque on the crank of force elements whose forces depend on velocities, at any crank speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from equipoise.mechanism.assembly.steps import Array
from equipoise.mechanism.dynamics.reactions import Demand, demands_of
from equipoise.mechanism.kinematics.motion import Motion, PlacedBodies
from equipoise.mechanism.parts.force_kinds import RatedElement
from equipoise.mechanism.parts.machine import FRAME

NumberedElements = Sequence[tuple[str, int, RatedElement]]
"""Force elements, each with its list in the file and its place there from 0."""
SPEED_STEP = 1e-6
"""Share of a speed by which it is changed for the slope of a torque over it, which sets only how
fast Newton's method converges."""


def rated_ways(motion: Motion, elements: NumberedElements) -> list[Array]:
    """The ways (N,) of each element, m or rad, each followed by its derivative by the crank angle,
    which is its speed at a crank speed of 1 rad/s.
    """
    turning = motion.at(1.0, 0.0)
    return [
        np.asarray(value + np.zeros(len(motion.crank_angle)))
        for table, number, element in elements
        for way in element.ways(PlacedBodies(turning, f"{table}[{number + 1}]"))
        for value in way
    ]


def rated_efforts(
    elements: Sequence[RatedElement], columns: Array, speed: Array, sense: float | None = None
) -> tuple[list[Array], list[Array]]:
    """Efforts (...), N or N m, along each way, and the ways' derivatives (...) by the crank angle.

    columns : (C, ...), as of `rated_ways`, of these elements once for each row of the machine.
    speed : of the crank (...), rad/s.
    sense : 1 or -1, in which the crank turns, or would, against which dry friction has its full
        size; it changes its sense smoothly, by the law of each element, if None.
    """
    ways = columns.reshape(-1, 2, *columns.shape[1:])
    rows = len(ways) // sum(element.freedoms for element in elements)
    efforts: list[Array] = []
    for element in [*elements] * rows:
        own = ways[len(efforts) : len(efforts) + element.freedoms]
        moving = [(way, slope * speed) for way, slope in own]
        if sense is None:
            efforts += element.efforts(moving)
        else:
            efforts += element.sliding_efforts(moving, [slope * sense for _, slope in own])
    return efforts, [*ways[:, 1]]


def rated_torque(
    elements: Sequence[RatedElement], columns: Array, speed: Array, sense: float | None = None
) -> Array:
    """Torque (...) on the crank, N m; arguments as of `rated_efforts`."""
    pairs = zip(*rated_efforts(elements, columns, speed, sense), strict=True)
    return np.asarray(sum((effort * slope for effort, slope in pairs), np.zeros(np.shape(speed))))


def effort_demands(motion: Motion, elements: NumberedElements) -> list[dict[str, Demand]]:
    """What holds a unit effort along each way of each element, on both its bodies."""
    demands = []
    for table, number, element in elements:
        placed = PlacedBodies(motion, f"{table}[{number + 1}]")
        for own in range(element.freedoms):
            efforts = [float(own == other) for other in range(element.freedoms)]
            actions = element.exerted(placed, efforts)
            demands.append(demands_of(motion, (item for item in actions if item[0] != FRAME)))
    return demands


def differentiable_torque(elements: Sequence[RatedElement], columns: Array, speed: Array) -> Array:
    """Torque (...) as of `rated_torque`; at a complex speed, the real part's torque with its slope
    times the imaginary part, because laws with a kink take no complex numbers.
    """
    if not np.iscomplexobj(speed) or all(element.linear for element in elements):
        return rated_torque(elements, columns, speed)
    step = SPEED_STEP * np.maximum(np.abs(speed.real), SPEED_STEP)
    slow, fast = (rated_torque(elements, columns, speed.real + way * step) for way in (-1, 1))
    middle = rated_torque(elements, columns, speed.real)
    return np.asarray(middle + 1j * speed.imag * (fast - slow) / (2 * step))
