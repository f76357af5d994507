"""A machine as one turning mass: reduced inertia of the crank, and generalized forces on it.

With q the crank angle, a prime for the derivative by it, and p and alpha the place of a link's
centre of mass and its angle, the equation of motion (Eksergian's) is

    J q.. + J' q.^2 / 2 = Q,    J = sum m |p'|^2 + I alpha'^2

and Q is the power of everything that acts, at a crank speed of 1 rad/s.  Forces of rated elements
depend on velocities: their part of Q is computed at any crank speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from equipoise.mechanism.assembly.steps import p, u
from equipoise.mechanism.dynamics.reactions import Demand, demands_of
from equipoise.mechanism.formulas.kernels import dot
from equipoise.mechanism.kinematics.motion import Motion, PlacedBodies
from equipoise.mechanism.parts.element_kinds import RatedElement
from equipoise.mechanism.parts.machine import FRAME
from equipoise.signals import Array


def reduced_inertia(motion: Motion) -> tuple[Array, Array]:
    """J and J' (N,) of the links, kg m2, at the crank angles of a motion."""
    inertia, slope = np.zeros((2, len(motion.crank_angle)))
    for name, link in motion.machine.links.items():
        center = motion.mass_centers[name]
        _, w, a = (motion.state[key] for key in u(name))
        mass, own = link.mass, link.inertia
        inertia = inertia + mass * dot(center.place_1, center.place_1) + own * w**2
        slope = slope + 2 * (mass * dot(center.place_1, center.place_2) + own * w * a)
    return inertia, slope


def generalized_force(motion: Motion, demands: Mapping[str, Demand]) -> Array:
    """Generalized force (N,), N m, of what acts on links.

    demands : what would hold it, by link.
    """
    total: Array = np.zeros(len(motion.crank_angle))
    for link, (force, moment) in demands.items():
        anchor_1 = motion.state[p(motion.linkage.anchors[link])[1]]
        total = total - dot(anchor_1, force) - motion.state[u(link)[1]] * moment
    return total


def generalized_size(motion: Motion, demands: Mapping[str, Demand]) -> float:
    """The generalized force, N m, if nothing in it cancelled: its measure of rounding.

    Horizontal strokes against weight, for example, leave nothing of it but rounding.
    """
    total: Array = np.zeros(len(motion.crank_angle))
    for link, (force, moment) in demands.items():
        anchor_1 = motion.state[p(motion.linkage.anchors[link])[1]]
        total = total + np.abs(anchor_1) * np.abs(force)
        total = total + np.abs(motion.state[u(link)[1]] * moment)
    return float(np.max(total, initial=0.0))


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
