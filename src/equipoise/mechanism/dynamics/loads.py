"""What acts on links beside their joints: loads, soil, force elements, preloads of couplings."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import chain
from math import degrees, pi
from typing import Any, NamedTuple

import numpy as np

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names
from equipoise.mechanism.assembly.joints import coupling_pins
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.assembly.steps import planar
from equipoise.mechanism.checks import numbered
from equipoise.mechanism.dynamics.reactions import Acting, Demand, demands_of
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.indicators import loads_of
from equipoise.mechanism.kinematics.motion import Motion, PlacedBodies, move
from equipoise.mechanism.kinematics.tip import surface_of, tip_link
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.element_kinds import Placed
from equipoise.mechanism.parts.field import Soil
from equipoise.mechanism.parts.loads import MEETING as LOAD_MEETING
from equipoise.mechanism.parts.loads import ROUNDING
from equipoise.mechanism.parts.machine import FRAME, Load, LoadTable, Machine
from equipoise.mechanism.parts.resistances import TINY
from equipoise.mechanism.parts.row_laws import table_value
from equipoise.mechanism.parts.run_plans import TimedLoad
from equipoise.signals import Array

MEETING = 1e-12
"""Of the coordinates of both points: where they are closer, rounding decides their direction."""


def vector_between(motion: Motion, point: str, to: str) -> Any:
    """From a point to another (N,), m, complex."""
    return motion.point(to).place - motion.point(point).place


def direction_between(motion: Motion, where: str, ends: tuple[str, str, str], sentence: str) -> Any:
    """Unit vector from a point to another (N,), complex.

    where, ends, sentence : as of `check_apart`.

    Raises
    ------
    ModelError : they meet.
    """
    check_apart(motion, where, ends, sentence)
    along = vector_between(motion, *ends[1:])
    return along / abs(along)


def check_apart(motion: Motion, where: str, ends: tuple[str, str, str], sentence: str) -> None:
    """Raise a `ModelError` where a point of a link meets another; ends : link, point and that."""
    link, point, to = ends
    length = abs(vector_between(motion, point, to))
    coordinates = abs(motion.point(point).place) + abs(motion.point(to).place)
    meeting = length <= MEETING * coordinates
    if meeting.any():
        angle = degrees(motion.crank_angle[meeting.argmax()])
        named = {"point": point, "link": link, "to": to, "angle": angle}
        raise ModelError(where, Note(sentence, **named, **key_names("free_length")))


def load_axis(motion: Motion, where: str, load: Load | TimedLoad) -> Any:
    """Unit vector of the x axis along which the force of a load is given, in the frame (N,),
    complex; 1 of a load in the axes of the frame.

    where : its place in the file.

    Raises
    ------
    ModelError : the points between which it acts meet.
    """
    if load.toward is not None and load.point is not None:
        check_apart(motion, where, (load.link, load.point, load.toward), LOAD_MEETING)
    return axis_of(load, PlacedBodies(motion, where), own_axis(load, motion.machine))


def own_axis(load: Load | TimedLoad, machine: Machine) -> Any:
    """Unit vector of the x axis of a load in the axes of its link; 1 where that does not matter."""
    return np.exp(1j * load.axes_angle(machine.sliders)) if load.axes else 1.0


def axis_of(load: Load | TimedLoad, at: Placed, own: Any) -> Any:
    """Unit vector of the x axis of a load in the frame; own : in its link's axes, by `own_axis`."""
    if load.toward is not None and load.point is not None:
        along = at.point(load.bearer or FRAME, load.toward) - at.point(load.link, load.point)
        return along * (1 / kernels.length(along))
    return 1.0 if load.axes is None else at.turn(load.link) * own


def load_on_links(load: Load, force: Any, torque: Any) -> Iterator[Acting]:
    """Link, point, force and torque of a load at each of its ends on a link.

    force, torque : on the loaded link, in the frame, by arrays or terms.
    """
    yield load.link, load.point, force, torque
    if load.reaction_link is not None:  # in the same line, so at the same place where no other
        yield load.reaction_link, load.toward or load.point, -force, -torque


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
            rate = preload_rate(motion.linkage, coupling)
            at = PlacedBodies(motion, coupling.name)
            yield coupling.driven, [*preload_on_links(motion.linkage, coupling, rate, at)]


def preload_rate(linkage: Linkage, coupling: Coupling) -> float:
    """Force of a coupling's preload over the distance of its pins, N/m."""
    points = linkage.machine.points_of(coupling.carrier)
    driver, driven = (planar(points[pin]) for pin in coupling_pins(linkage.joints, coupling))
    rate: float = coupling.preload_rate(abs(driven - driver))
    return rate


def preload_on_links(
    linkage: Linkage, coupling: Coupling, rate: Any, at: Placed
) -> Iterator[Acting]:
    """Link, point, force and torque of a coupling's preload at each of its ends on a link.

    rate : as of `preload_rate`.
    """
    driver, driven = coupling_pins(linkage.joints, coupling)
    pull = (at.point(coupling.carrier, driven) - at.point(coupling.carrier, driver)) * rate
    for link, pin, force in ((coupling.driver, driver, pull), (coupling.driven, driven, -pull)):
        if link != FRAME:
            yield link, pin, force, 0.0


def inner_demands(motion: Motion) -> dict[str, Demand]:
    """What holds those of the loads whose opposite the frame bears."""
    return demands_of(motion, _acting(motion, lambda load: load.reaction == FRAME))


def loads_between(motion: Motion) -> Iterator[Acting]:
    """Link, point, force and torque of those of the loads whose opposite a body of the machine
    bears, at each end on a link.
    """
    return _acting(motion, lambda load: not load.is_external)


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
    return _acting(motion, lambda load: load.is_external)


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
        yield from load_on_links(load, *acting_load(motion, where, load))


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
    speed = motion.speed if crank_speed is None else crank_speed
    surface, forward = surface_of(motion.machine), planting.forward(speed)
    at, name = PlacedBodies(motion, "planting"), tip or planting.tip
    of_link = tip_link(motion.machine, name), name
    return np.asarray(soil_at(planting.soil, at, of_link, surface, forward))


def soil_at(soil: Soil, at: Placed, tip: tuple[str, str], surface: Any, forward: Any) -> Any:
    """Force of the soil on a tip, N, complex, by arrays (N,) or terms.

    tip : its link and its name.  surface : height of the soil in the frame, m.
    forward : velocity of the machine over ground, m/s.
    """
    return against_soil(soil, surface - at.point(*tip).imag, at.velocity(*tip) + forward)


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
