"""The linkages on a support as one: sums at a crank angle, and joint forces on a moving base.

Written for the support's own axes, so that the pass over the joints is the same as on solid ground,
and from its reference point.  With p the place of a link's centre
of mass and alpha the link's angle there, a prime for the derivative by crank angle, and sums over
the links of all rows:

    first     S = sum m p                        with S', S''
    inertia   J = sum m |p|^2 + I                with J'
    spin      H = sum m p x p' + I alpha'        with H'
    drive     E = sum m |p'|^2 + I alpha'^2      with E'

Kinetic energy, momentum and moment of momentum on any moving support follow from these alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from functools import reduce
from operator import add
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MassError
from equipoise.mechanism.assembly.steps import p, u
from equipoise.mechanism.dynamics.forces import forces, massless
from equipoise.mechanism.dynamics.friction import with_friction
from equipoise.mechanism.dynamics.loads import (
    load_demands,
    loads_between,
    outer_loads,
    spring_demands,
)
from equipoise.mechanism.dynamics.reactions import Demand, JointReactions, demands_of, reactions
from equipoise.mechanism.dynamics.reduced import generalized_force, rated_ways, reduced_inertia
from equipoise.mechanism.formulas.kernels import cross, dot
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.element_kinds import rated_elements
from equipoise.mechanism.parts.links import masses_of, moments_across
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.signals import Array
from equipoise.vibration.body import PITCH


@dataclass(frozen=True, eq=False)
class ReducedInertia:
    """Sums over all links at crank angles (N,), as defined above.

    mass : kg.  first, first_1, first_2 : complex, kg m.
    inertia, inertia_1, spin, spin_1, drive, drive_1 : kg m2.
    load_force (complex, N), load_moment (N m, about the reference point) and load_torque (N m, on
    the crank) : what loads from outside do; the torque is that of springs and of friction, too.
    ways : of dampers, stops and resistances of each row, as of `rated_ways`, each (N,).
    """

    mass: float
    first: Array
    first_1: Array
    first_2: Array
    inertia: Array
    inertia_1: Array
    spin: Array
    spin_1: Array
    drive: Array
    drive_1: Array
    load_force: Array
    load_moment: Array
    load_torque: Array
    ways: tuple[Array, ...] = ()

    def __add__(self, other: ReducedInertia) -> ReducedInertia:
        return ReducedInertia(
            *(getattr(self, f.name) + getattr(other, f.name) for f in fields(ReducedInertia))
        )

    def with_shaft(self, inertia: float, ratio: float) -> ReducedInertia:
        """With a rotor that turns `ratio` times as fast as the crank, relative to the support.

        Its mass, and its moment of inertia as far as it turns with the support, are the support's.
        """
        return replace(
            self, spin=self.spin + ratio * inertia, drive=self.drive + ratio**2 * inertia
        )


def rows_of(machine: Machine) -> tuple[Row, ...]:
    """The linkages on the support: those of `[[rows]]`, or the one of the file."""
    return machine.rows or (Row(),)


def sums(machine: Machine, theta: Array, reference: complex, speed: float) -> ReducedInertia:
    """Sums over the links of all rows, and over what else turns with the crank.

    Parameters
    ----------
    theta : (N,) crank angles of a row of phase 0, rad.
    reference : point of the support from which positions are measured, m.
    speed : of the crank, rad/s, for loads that depend on it, and for friction.

    Raises
    ------
    MassError : a link has no mass given.
    """
    if missing := massless(machine):
        raise MassError(missing)
    total = reduce(
        add,
        (
            _of_row(move(machine, theta + row.phase, speed, 0.0), complex(*row.offset) - reference)
            for row in rows_of(machine)
        ),
    ).with_shaft(machine.drive.flywheel, 1.0)
    motor = machine.drive.motor
    return total if motor is None else total.with_shaft(motor.inertia, motor.ratio)


def _of_row(motion: Motion, shift: complex) -> ReducedInertia:
    zero = np.zeros(len(motion.crank_angle))
    reduced, loads = reduced_inertia(motion), _loads(motion, shift)
    ways = (*rated_ways(motion, rated_elements(motion.machine)),)
    total = ReducedInertia(0.0, *(zero + 0j,) * 3, *(zero,) * 4, *reduced, *loads, ways)
    for mass, own, place, first, second, w, a in _bodies(motion, shift):
        total += ReducedInertia(
            mass,
            mass * place,
            mass * first,
            mass * second,
            mass * dot(place, place) + own,
            2 * mass * dot(place, first),
            mass * cross(place, first) + own * w,
            mass * cross(place, second) + own * a,
            *(zero,) * 5,
        )
    return total


def _bodies(motion: Motion, shift: complex) -> Iterator[tuple[Any, ...]]:
    """Mass, inertia, place, place', place'', alpha' and alpha'' of each link."""
    for name, link in motion.machine.links.items():
        center = motion.mass_centers[name]
        _, w, a = (motion.state[key] for key in u(name))
        yield (link.mass, link.inertia, center.place + shift, center.place_1, center.place_2, w, a)


def _loads(motion: Motion, shift: complex) -> tuple[Array, Array, Array]:
    """Force and moment on the support, and torque on the crank, of loads from outside.

    Springs and loads between bodies turn the crank only: what they do to both cancels.
    """
    about = np.zeros(len(motion.crank_angle))
    total = about + 0j
    loads = demands_of(motion, outer_loads(motion))
    for link, (force, moment) in loads.items():
        anchor = motion.state[p(motion.linkage.anchors[link])[0]]
        total = total - force
        about = about - moment - cross(anchor + shift, force)
    between = demands_of(motion, loads_between(motion))
    every = (loads, between, spring_demands(motion, rated=False))
    turning = sum(generalized_force(motion, demands) for demands in every)
    return total, about, np.asarray(turning + _rubbed(motion))


def _rubbed(motion: Motion) -> Array | float:
    """Torque (N,) of friction in joints on the crank, N m, on solid ground: beside the speed of the
    crank that of the support is small, and friction acts between bodies that it carries alike.
    """
    if not motion.machine.rubs:
        return 0.0
    lost = sum(friction.loss for friction in forces(motion).frictions.values())
    return np.asarray(-lost / motion.speed)


def spread(motion: Motion) -> Array:
    """Mean mass matrix (6, 6) of the links of one row about the frame's origin, in its plane 0.

    Coordinates as in `vibration.body`.  Links are flat: their own inertia about the lateral axis
    is twice that about an axis in the plane, in the mean over directions.
    """
    machine = motion.machine
    total = np.zeros((6, 6))
    for mass, own, place, *_ in _bodies(motion, 0j):
        x, y = place.real, place.imag
        xx, yy, xy = (float(motion.mean(v)) * mass for v in (x * x, y * y, x * y))
        sx, sy = float(motion.mean(x)) * mass, float(motion.mean(y)) * mass
        total[:3, :3] += mass * np.eye(3)
        total[:3, 3:] += np.array([[0, 0, -sy], [0, 0, sx], [sy, -sx, 0]])
        total[3:, 3:] += np.array(
            [[yy + own / 2, -xy, 0], [-xy, xx + own / 2, 0], [0, 0, xx + yy + own]]
        )
    if machine.has_planes:
        total += _spread_across(motion)
    total[3:, :3] = total[:3, 3:].T
    return total


def _spread_across(motion: Motion) -> Array:
    """What masses beside the plane 0 add to it, but for what stands below the diagonal."""
    total = np.zeros((6, 6))
    for name, link in motion.machine.links.items():
        anchor = motion.linkage.anchors[name]
        mz, moment = moments_across(link, anchor)
        zz = sum(mass * z**2 for mass, _, z in masses_of(link))
        center = motion.state[p(anchor)[0]] * mz + motion.state[u(name)[0]] * moment
        mean = complex(motion.mean(center + np.zeros(len(motion.crank_angle))))
        total[:3, 3:] += np.array([[0, mz, 0], [-mz, 0, 0], [0, 0, 0]])
        zx, yz = -mean.real, -mean.imag
        total[3:, 3:] += np.array([[zz, 0, zx], [0, zz, yz], [zx, yz, 0]])
    return total


@dataclass(frozen=True, eq=False)
class BaseMotion:
    """Motion of support and crank at N instants.

    place, rate, change : (3, N) displacement, velocity and acceleration along surge, heave, pitch.
    crank_angle, crank_speed, crank_acceleration : (N,), rad, rad/s and rad/s2, relative to it.
    reference : the point whose displacement is reported, m.
    """

    place: Array
    rate: Array
    change: Array
    crank_angle: Array
    crank_speed: Array
    crank_acceleration: Array
    reference: complex


def joint_forces(
    machine: Machine, ride: BaseMotion, phase: float, offset: complex
) -> JointReactions:
    """Forces in the joints of one linkage on a moving support, in the support's axes.

    phase, offset : of its row, rad and m.
    """
    motion = move(machine, ride.crank_angle + phase, acceleration=0.0)
    demands = {link: _demand(motion, link, ride, offset - ride.reference) for link in machine.links}
    speeds: Any = ride.crank_speed  # one for each crank angle, which dampers need
    turning = replace(motion, speed=speeds)
    for acting in (load_demands(motion), spring_demands(turning)):
        for link, (force, moment) in acting.items():
            demands[link] = (demands[link][0] + force, demands[link][1] + moment)
    if machine.rubs:
        return with_friction(replace(turning, whole_cycle=False), demands)
    return reactions(replace(motion, whole_cycle=False), demands)


def _demand(motion: Motion, link: str, ride: BaseMotion, shift: complex) -> Demand:
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
