"""Joint forces of a machine whose frame moves: what the links' inertia asks for then.

Everything is written in the support's axes, so that the pass over the joints is the same as on
solid ground.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from equipoise.mechanism.kernels import cross
from equipoise.mechanism.loads import load_demands, spring_demands
from equipoise.mechanism.model import Machine
from equipoise.mechanism.motion import Motion, move
from equipoise.mechanism.reactions import Demand, Pass, reactions
from equipoise.mechanism.steps import p, u
from equipoise.structures.readings import PITCH

Array = np.ndarray[Any, Any]


@dataclass(frozen=True, eq=False)
class Ride:
    """Motion of support and crank at N instants.

    place, rate, change : (3, N) displacement, velocity and acceleration along surge, heave, pitch.
    crank_angle, crank_speed, crank_acceleration : (N,), rad, rad/s and rad/s2, relative to it.
    reference : the point whose displacement is told, m.
    """

    place: Array
    rate: Array
    change: Array
    crank_angle: Array
    crank_speed: Array
    crank_acceleration: Array
    reference: complex


def joint_forces(machine: Machine, ride: Ride, phase: float, offset: complex) -> Pass:
    """Forces in the joints of one linkage on a moving support, in the support's axes.

    phase, offset : of its row, rad and m.
    """
    motion = move(machine, ride.crank_angle + phase, acceleration=0.0)
    demands: dict[str, Demand] = {}
    acting = load_demands(motion), spring_demands(motion)
    shift = offset - ride.reference
    for link in machine.links:
        force, moment = _demand(motion, link, ride, shift)
        for held in acting:
            more = held.get(link, (0j, 0.0))
            force, moment = force + more[0], moment + more[1]
        demands[link] = (force, moment)
    return reactions(replace(motion, whole_cycle=False), demands)


def _demand(motion: Motion, link: str, ride: Ride, shift: complex) -> Demand:
    """Force and moment about its anchor that move a link and carry its weight."""
    body = motion.machine.links[link]
    assert body.mass is not None and body.inertia is not None
    center = motion.mass_centers[link]
    _, w, a = (motion.state[name] for name in u(link))
    turn = np.exp(-1j * ride.place[PITCH])
    turning, spin_up = ride.rate[PITCH], ride.change[PITCH]
    carried = turn * (ride.change[0] + 1j * ride.change[1] - complex(*motion.machine.gravity))
    speed = ride.crank_speed
    acceleration = (
        carried
        + (1j * spin_up - turning**2) * (center.place + shift)
        + 2j * turning * speed * center.place_1
        + center.place_1 * ride.crank_acceleration
        + center.place_2 * speed**2
    )
    angular = spin_up + w * ride.crank_acceleration + a * speed**2
    force = body.mass * acceleration
    arm = center.place - motion.state[p(motion.linkage.anchors[link])[0]]
    return force, body.inertia * angular + cross(arm, force)
