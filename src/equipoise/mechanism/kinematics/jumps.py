"""Crank angles at which forces jump, and motions that are taken piece by piece between them.

Loads, motion laws and soil say themselves where they set in, end or change suddenly; dry friction
does so where a joint turns back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from math import pi
from typing import Any

import numpy as np

from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import size_of_links
from equipoise.mechanism.kinematics.friction_joints import STILL, rubbing_joints, ways_of
from equipoise.mechanism.kinematics.indicators import loads_of
from equipoise.mechanism.kinematics.motion import Motion, PlacedBodies, move, move_again
from equipoise.mechanism.kinematics.tip import crossings, roots, surface_of
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.element_kinds import rated_elements
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.signals import Array, JumpSampling

ANGLES = 720
"""In a turn, between two of which a law passes a knot at most once, or a tip the surface."""
SAME = 1e-9
"""rad, within which jumps are one."""
BESIDE = np.arange(-2, 4)
"""Samples about one after which a signal passes zero, from which it is estimated where."""
ACCELERATION = 2
"""Order of the derivative of a motion law that forces follow from."""


def jumps_of(linkage: Linkage) -> Array:
    """Crank angles (J,) within the cycle of one row at which forces may jump, rising, rad.

    Raises
    ------
    MotionError : the crank cannot turn fully.
    """
    known: Array | None = linkage.memory.get("jumps")
    if known is None:
        known = np.empty(0)
        if linkage.machine.rubs or may_jump(linkage):
            turns = linkage.cycle.turns
            every = [*declared_jumps(linkage, turns), *_jumps_on_the_way(linkage)]
            known = _within(every, turns)
        linkage.memory["jumps"] = known
    return known


def jumps_of_rows(linkage: Linkage) -> Array:
    """Crank angles (J,) of the first row, rising, rad, at which forces in any row may jump."""
    values, machine = jumps_of(linkage), linkage.machine
    return of_rows(machine, values, linkage.cycle.turns) if len(values) else values


def of_rows(machine: Machine, jumps: Array, turns: int) -> Array:
    """Crank angles of the first row, rising, rad, at which any row is where one row jumps (J,)."""
    phases = [row.phase for row in machine.rows] or [0.0]
    return _within([np.subtract.outer(jumps, phases).ravel()], turns)


def bends_of(linkage: Linkage, turns: int) -> Array:
    """Crank angles (B,) of one row, rising, rad, at which the slope of a load's table may jump."""
    every = [np.empty(0)]
    for table in (load.rows for load in loads_of(linkage) if load.rows is not None):
        again = 2 * pi * np.arange(0, turns, table.turns)
        every.append(np.add.outer(again, table.crank_angle).ravel())
    return _within(every, turns)


def bends_of_rows(linkage: Linkage, turns: int) -> Array:
    """Crank angles (B,) of the first row, rising, rad, at which the slope of a load's table in any
    row may jump.
    """
    return of_rows(linkage.machine, bends_of(linkage, turns), turns)


def may_jump(linkage: Linkage) -> bool:
    """Whether there is anything that jumps, as far as is known before the motion on its way."""
    machine = linkage.machine
    return (
        machine.in_soil
        or any(load.jumps for load in loads_of(linkage))
        or any(len(law.jumps(ACCELERATION)) for law in machine.laws.values())
        or any(len(coupling.jumps) for coupling in machine.couplings)
    )


def declared_jumps(linkage: Linkage, turns: int) -> Iterator[Array]:
    """Crank angles, rad, in so many turns at which loads and the laws of drives jump."""
    for load in loads_of(linkage):
        for angle, every in load.jumps:
            yield angle + 2 * pi * np.arange(0, turns, every)
    for law in linkage.machine.laws.values():
        again = 2 * pi * np.arange(0, turns, law.turns)
        yield np.add.outer(again, law.jumps(ACCELERATION)).ravel()


def _within(every: Iterable[Array], turns: int) -> Array:
    """Crank angles of a cycle, each once, rising, rad."""
    angles = np.concatenate([np.empty(0), *every])
    value = np.sort(np.mod(angles + SAME, 2 * pi * turns)) - SAME
    return np.maximum(value[np.diff(value, prepend=-1.0) > SAME], 0.0)


def resolved(motion: Motion) -> Motion:
    """A motion over a whole cycle at crank angles that resolve its jumps; itself without any."""
    if not motion.whole_cycle or motion.sampling is not None:
        return motion
    linkage, theta = motion.linkage, motion.crank_angle
    jumps = jumps_of_rows(linkage)
    if not len(jumps):
        return motion
    bends = bends_of_rows(linkage, motion.turns)
    key = len(theta), jumps.tobytes(), bends.tobytes()  # other rows and loads have the same memory
    last_key, sampling = linkage.memory.get("sampling", (None, None))
    if key != last_key:
        sampling = JumpSampling.of(theta, motion.turns, jumps, bends)
        linkage.memory["sampling"] = key, sampling  # the last alone, as they take memory
    moved = move_again(motion.machine, sampling.crank_angle, motion.speed, motion.acceleration)
    return replace(moved, whole_cycle=True, sampling=sampling)


def _jumps_on_the_way(linkage: Linkage) -> Iterator[Array]:
    """Crank angles at which couplings come to knots of their laws, and tips to the soil."""
    machine = linkage.machine
    for coupling in machine.couplings:
        yield from _knots(linkage, coupling)
    joints = [joint for joint in rubbing_joints(linkage) if joint.jumps]
    if joints:
        still = np.array([[joint.still] for joint in joints])
        yield _signs_changed(linkage, partial(ways_of, joints), still)
    if machine.planting is not None and machine.planting.soil is not None:
        surface = surface_of(machine)
        for arm in machine.planting.every_arm:
            yield _crossed(linkage, partial(_height, arm.tip, surface))


def _height(tip: str, surface: float, motion: Motion) -> Array:
    """Height (N,) of a tip over the soil's surface, m."""
    return np.asarray(motion.points[tip].y - surface)


def _knots(linkage: Linkage, coupling: Coupling) -> Iterator[Array]:
    """Crank angles at which a coupling's driver has turned to a knot of its law."""
    for knot in coupling.jumps:
        values = _crossed(linkage, partial(_beyond, coupling, knot, np.sin))
        if len(values):  # half a turn away the sine is 0, too
            yield values[_beyond(coupling, knot, np.cos, move(linkage.machine, values)) > 0]


def _beyond(coupling: Coupling, knot: float, read: Callable[[Any], Any], motion: Motion) -> Array:
    """Sine or cosine (N,) of the angle by which a coupling's driver has turned beyond a knot."""
    ends = (coupling.driver, coupling.carrier)
    driver, carrier = (0.0 if end == FRAME else motion.links[end].angle for end in ends)
    return np.asarray(read(driver - carrier - knot))


def resisted_back(linkage: Linkage) -> Array:
    """Crank angles (B,) of the first row, rising, rad, at which in any row the point of a dry force
    element turns back, or comes to a corner of its force by the way.
    """
    machine = linkage.machine
    dry = [entry for entry in rated_elements(machine) if entry[2].dry]
    if not dry:
        return np.empty(0)
    still = STILL * size_of_links(machine)

    def signals(motion: Motion) -> Array:
        turning, values = motion.at(1.0, 0.0), []
        for table, number, item in dry:
            ways = item.ways(PlacedBodies(turning, f"{table}[{number + 1}]"))
            rates, corners = item.sign_changes(ways)
            values += [np.where(np.abs(rate) > still, rate, 0.0) for rate in rates]
            values += corners
        return np.array([np.broadcast_to(value, motion.crank_angle.shape) for value in values])

    turns = linkage.cycle.turns
    return of_rows(machine, _within([_signs_changed(linkage, signals)], turns), turns)


def _signs_changed(
    linkage: Linkage, read: Callable[[Motion], Array], still: Array | float = 0.0
) -> Array:
    """Crank angles of a cycle at which signals (J, N) that are read of a motion change their signs:
    of all of them from the same motions.

    still : (J, 1) size up to which a signal is rounding.
    """
    turns = linkage.cycle.turns
    nodes = np.linspace(0.0, 2 * pi * turns, ANGLES * turns + 1)

    def rates(theta: Array) -> Array:
        return read(move(linkage.machine, theta))

    sampled = rates(nodes)
    sampled[np.abs(sampled) <= still] = 0.0
    back = sampled < 0
    back[:, -1] = back[:, 0]  # the same instant, whatever rounding says
    joint, k = np.nonzero(back[:, :-1] != back[:, 1:])
    if not k.size:
        return np.empty(0)

    def signal(theta: Array) -> Array:
        return rates(theta[0])[joint, np.arange(k.size)][None]

    near = (k[:, None] + BESIDE) % (len(nodes) - 1)
    first = nodes[k] + nodes[1] * _zeros_between(sampled[joint[:, None], near])
    known = sampled[None, joint, k], sampled[None, joint, k + 1], first[None]
    values: Array = roots(signal, nodes[None, k], nodes[None, k + 1], known)[0]
    return values


def _zeros_between(values: Array) -> Array:
    """Where signals are about zero between the middle two of six equally spaced values (K, 6), as
    shares (K,) of the step: by the polynomial of the step in their values; 0.5 where it leads out.
    """
    with np.errstate(all="ignore"):
        weights = np.ones_like(values)
        for k in range(1, len(BESIDE)):
            other = np.roll(values, k, axis=1)
            weights *= other / (other - values)
        share = weights @ BESIDE
    return np.where((share > 0) & (share < 1), share, 0.5)


def _crossed(linkage: Linkage, read: Callable[[Motion], Array]) -> Array:
    """Crank angles of a cycle at which what is read of a motion passes zero."""

    def signal(theta: Array) -> Array:
        return np.reshape(read(move(linkage.machine, theta.ravel())), theta.shape)

    turns = linkage.cycle.turns
    return crossings(signal, np.linspace(0.0, 2 * pi * turns, ANGLES * turns + 1))
