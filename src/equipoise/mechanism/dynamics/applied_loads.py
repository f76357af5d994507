"""What acts on links beside their joints: loads, soil, force elements, preloads of couplings."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import chain
from typing import Any

import numpy as np

from equipoise.mechanism.assembly.joints import coupling_pins
from equipoise.mechanism.assembly.steps import Array
from equipoise.mechanism.checks import numbered
from equipoise.mechanism.dynamics.lines import check_apart
from equipoise.mechanism.dynamics.loads import acting_load
from equipoise.mechanism.dynamics.reactions import Acting, Demand, demands_of
from equipoise.mechanism.kinematics.indicators import loads_of
from equipoise.mechanism.kinematics.motion import Motion, PlacedBodies
from equipoise.mechanism.kinematics.tip import surface_of, tip_link
from equipoise.mechanism.parts.field import Soil
from equipoise.mechanism.parts.machine import FRAME, Load
from equipoise.mechanism.parts.ramps import table_value
from equipoise.mechanism.parts.resistances import TINY


def load_demands(motion: Motion) -> dict[str, Demand]:
    """What holds the loads, for every link that has one."""
    return demands_of(motion, acting_loads(motion))


def spring_demands(
    motion: Motion, rated: bool | None = None, cause: str | None = None
) -> dict[str, Demand]:
    """What holds force elements and preloads of couplings, for every link that has one.

    rated, cause : as of `acting_elements`; preloads are springs, and depend on no velocity.

    Raises
    ------
    ModelError : the ends of a spring with a free length meet, or a link turns beyond where the
        torque of a torsion spring is known.
    """
    left_out = rated or cause not in (None, "spring")
    preloads = () if left_out else (end for _, ends in acting_preloads(motion) for end in ends)
    return demands_of(motion, chain(acting_elements(motion, rated, cause), preloads))


def acting_elements(
    motion: Motion, rated: bool | None = None, cause: str | None = None
) -> Iterator[Acting]:
    """Link, point, force and torque of each force element at each of its ends on a link.

    rated : whether only of those whose forces depend on velocities, or only of the others.
    cause : only of those of this cause.

    Raises
    ------
    ModelError : as of `spring_demands`.
    """
    for table, number, element in motion.machine.force_elements:
        if (rated is not None and element.rated != rated) or cause not in (None, element.cause):
            continue
        where = f"{table}[{number + 1}]"
        if sentence := element.meeting:
            (link, point), (_, to) = element.points
            check_apart(motion, where, (link, point, to), sentence)
        yield from element.on_links(PlacedBodies(motion, where))


def acting_preloads(motion: Motion) -> Iterator[tuple[str, list[Acting]]]:
    """Driven links of couplings with what preloads do to driver and driven link, whether or not
    these pass a torque on.
    """
    for coupling in motion.machine.couplings:
        if coupling.preload:
            driver, driven = coupling_pins(motion.linkage.joints, coupling)
            apart = motion.point(driven).place - motion.point(driver).place
            pull = apart * coupling.preload_rate(abs(apart))
            ends = (coupling.driver, driver, pull), (coupling.driven, driven, -pull)
            yield coupling.driven, [(*end, 0.0) for end in ends if end[0] != FRAME]


def inner_demands(motion: Motion) -> dict[str, Demand]:
    """What holds those of the loads whose opposite the frame bears."""
    return demands_of(motion, _acting(motion, lambda load: load.reaction == FRAME))


def loads_between(motion: Motion) -> Iterator[Acting]:
    """Link, point, force and torque of those of the loads whose opposite a body of the machine
    bears, at each end on a link.
    """
    return _acting(motion, lambda load: load.reaction is not None)


def acting_loads(motion: Motion) -> Iterator[Acting]:
    """Link, point, force and torque of each load, at each of its ends on a link."""
    yield from given_loads(motion)
    yield from soil_loads(motion)


def outer_loads(motion: Motion) -> Iterator[Acting]:
    """Demands of loads from outside, and of the soil."""
    yield from loads_from_outside(motion)
    yield from soil_loads(motion)


def loads_from_outside(motion: Motion) -> Iterator[Acting]:
    """Link, point, force and torque of each load of the file whose opposite no part bears."""
    return _acting(motion, lambda load: load.reaction is None)


def given_loads(motion: Motion) -> Iterator[Acting]:
    """Link, point, force and torque of each load of the file, at each of its ends on a link; they
    depend on the crank angle alone, be it by the angle of a link.
    """
    return _acting(motion, lambda load: True)


def soil_loads(motion: Motion, crank_speed: Array | None = None) -> Iterator[Acting]:
    """Link, point, force and torque of the soil on each tip.

    crank_speed : as of `soil_force`.
    """
    machine = motion.machine
    if machine.planting is not None and machine.planting.soil is not None:
        for arm in machine.planting.every_arm:
            force = soil_force(motion, arm.tip, crank_speed)
            yield tip_link(machine, arm.tip), arm.tip, force, 0.0


def _acting(motion: Motion, counts: Callable[[Load], bool]) -> Iterator[Acting]:
    for where, load in numbered("loads", loads_of(motion.linkage)):
        if not counts(load):
            continue
        force, torque = acting_load(motion, where, load)
        yield load.link, load.point, force, torque
        if load.reaction_link is not None:  # in the same line, so at the same place where no other
            yield load.reaction_link, load.toward or load.point, -force, -torque


def soil_force(motion: Motion, tip: str | None = None, crank_speed: Array | None = None) -> Array:
    """Force of the soil on a tip (N,), N, complex; 0 above the surface.

    tip : of any arm; of the first where not given.
    crank_speed : (N,), rad/s, at which the machine drives over ground; that of the motion if not
        given.

    Raises
    ------
    ModelError : the machine has no `[planting]`.
    MotionError : its crank cannot turn fully, so that no lowest point defines the surface.
    """
    planting = motion.machine.planting
    if planting is None or planting.soil is None:
        return np.zeros(len(motion.crank_angle), complex)
    point = motion.point(tip or planting.tip)
    depth = surface_of(motion.machine) - point.y
    speed = motion.speed if crank_speed is None else crank_speed
    over_ground = point.velocity + planting.forward(speed)
    return np.asarray(against_soil(planting.soil, depth, over_ground))


def against_soil(soil: Soil, depth: Any, over_ground: Any) -> Any:
    """Force, N, complex, on a tip at a depth, m, with a velocity over ground, m/s, complex; 0 above
    the surface.  Of arrays (N,), or of terms.
    """
    speed = np.abs(over_ground)
    against = -over_ground * (1.0 / np.maximum(speed, TINY))
    return np.heaviside(depth, 0.0) * resistance(soil, depth, speed) * against


def resistance(soil: Soil, depth: Any, speed: Any) -> Any:
    """Size of the force, N, at a depth, m, and a speed over ground, m/s."""
    size = soil.resistance + soil.per_depth * depth + soil.per_speed * speed
    size = size + soil.per_depth_and_speed * depth * speed
    if soil.table is not None:
        size = size + table_value(soil.table.depth, soil.table.resistance, depth)
    return size
