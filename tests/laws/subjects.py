"""Machines on which the laws are tried, and the words in which the laws are told.

Bundled examples are run at crank angles over their whole cycle, random machines of every kind at
some crank angles.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache, partial, reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

import equipoise as eq
from equipoise.mechanism.parts.field import Soil, SoilTable
from equipoise.mechanism.parts.machine import FRAME
from support import machines_cams
from support.loads import (
    axes_angle,
    force_and_torque,
    has_soil,
    pull_of,
    soil_force,
    tips_of,
)
from support.machines import KINDS, make
from support.machines_redundant import REDUNDANT
from support.machines_torsion import torque_of

Array = NDArray[Any]
IN_SOIL = "kim-chung-b in soil"
STRANDS = ("left", "right")
SEEDS = (0, 1, 2)
ANGLES = 0.0173 + np.linspace(0, 2 * np.pi, 24, endpoint=False)
"""Crank angles off the round numbers at which loads may begin or end."""


@cache
def names() -> tuple[str, ...]:
    """Names of all subjects: examples, one in soil, and kinds of random machines with a seed."""
    kinds = (*KINDS, *REDUNDANT, *machines_cams.ALL)
    random = (f"{kind}:{seed}" for kind in kinds for seed in SEEDS)
    return (*sorted(eq.examples("linkage")), IN_SOIL, *random)


@cache
def machine_of(name: str) -> eq.Machine:
    """Return the machine of a subject."""
    if name == IN_SOIL:
        return in_soil()
    kind, _, seed = name.partition(":")
    # What may be changed of it does nothing to what is analysed, and its names need not follow.
    # Friction and resistances, which have laws of their own, are left out.
    actual = make(kind, int(seed)).machine if seed else eq.load(name).with_balance(None)
    return spelled_out(replace(actual.without_friction(), resistances=()))


def spelled_out(machine: eq.Machine) -> eq.Machine:
    """Return a machine whose links are given by places and masses, not by lengths and bodies."""

    def plain(link: eq.Link) -> eq.Link:
        given = {name: getattr(link, name) for name in ("mass", "center_of_mass", "inertia")}
        return eq.Link(dict(link.points), **given)

    return replace(machine, links={name: plain(link) for name, link in machine.links.items()})


def in_soil() -> eq.Machine:
    """Return a planter with every value that the example with soil lacks."""
    return eq.load("kim-chung-b").with_planting(
        travel="backward", forward_speed=None, hill_spacing=0.08, units_per_turn=2,
        depth=None, surface=-0.12, release=3.9, tray=((0.1, 0.02), (0.15, 0.05)),
        soil=Soil(1.0, 20.0, 3.0, 400.0, SoilTable((0.01, 0.02), (4.0, 10.0))),
    )  # fmt: skip


@cache
def forces_of(name: str, speed: float | None = None, acceleration: float | None = None) -> Any:
    """Return the forces of a subject, at its own or at another speed and acceleration."""
    return forces(machine_of(name), speed=speed, acceleration=acceleration)


def forces(machine: eq.Machine, angles: Any = ANGLES, **how: Any) -> eq.mechanism.Forces:
    """Return the forces of a machine."""
    return eq.analyze(machine, angles, **how).forces


def kinetic_power(result: eq.mechanism.Forces) -> Array:
    """Rate of change of kinetic energy, from velocities and accelerations.

    Two rows a link, and one of the flywheel, which turns with the drive's link.
    """
    drive = result.motion.machine.drive
    crank = result.motion.links[drive.link]
    rows = [drive.flywheel * crank.angular_velocity * crank.angular_acceleration]
    for name, link in result.motion.machine.links.items():
        center, turning = result.motion.mass_centers[name], result.motion.links[name]
        assert link.mass is not None
        assert link.inertia is not None
        rows.append(link.mass * along(center.velocity, center.acceleration_vector))
        rows.append(link.inertia * turning.angular_velocity * turning.angular_acceleration)
    return np.array(rows)


def gravity_power(result: eq.mechanism.Forces) -> Array:
    """Power of gravity, one row a link."""
    machine = result.motion.machine
    gravity = complex(*machine.gravity)
    return np.array([
        (link.mass or 0.0) * along(result.motion.mass_centers[name].velocity, gravity)
        for name, link in machine.links.items()
    ])  # fmt: skip


def load_power(result: eq.mechanism.Forces) -> Array:
    """Power of the loads, one row a load.

    The soil's is what it does relative to the machine; the rest drives the machine over ground.
    """
    motion, rows = result.motion, [np.zeros(len(result.motion.crank_angle))]
    for link, point, force, torque in acting(result):
        turning, center = motion.links[link].angular_velocity, motion.mass_centers[link]
        at: Any = 0.0
        if point is not None:  # of the link there, of which it need not be a point
            at = center.velocity + 1j * turning * (motion.points[point].place - center.place)
        rows.append(along(at, force) + torque * turning)
    return np.array(rows)


def spring_power(result: eq.mechanism.Forces) -> Array:
    """Power of the springs, one row a spring: what their pull takes as they lengthen."""
    motion, machine = result.motion, result.motion.machine
    rows = [np.zeros(len(motion.crank_angle))]
    for spring in machine.springs:
        point, to = motion.points[spring.point], motion.points[spring.to]
        arm = point.place - to.place
        length = np.abs(arm)
        growth = along(arm, point.velocity - to.velocity) / np.where(length > 0, length, 1.0)
        rows.append(-pull_of(spring, length) * growth)
    for torsion in machine.torsion_springs:
        ends = [motion.links[body] for body in torsion.bodies if body != FRAME]
        turned, speed = (
            reduce(np.subtract, (getattr(end, key) for end in ends))
            for key in ("angle", "angular_velocity")
        )
        rows.append(torque_of(torsion, turned) * speed)
    return np.array(rows)


def acting(result: eq.mechanism.Forces) -> Iterator[tuple[str, str | None, Array, Array]]:
    """Link and point of each load, its force (complex, N) and torque (N m), evaluated anew."""
    motion, machine = result.motion, result.motion.machine
    for load in machine.loads:
        parts, torque = force_and_torque(load, motion.crank_angle)
        force = parts[:, 0] + 1j * parts[:, 1]
        if load.axes is not None:
            force = force * np.exp(1j * axes_angle(machine, load, partial(angle_of, motion)))
        yield load.link, load.point, force, torque
        if load.reaction not in (None, FRAME):
            yield load.reaction, load.point, -force, -torque
    if has_soil(machine):
        for link, point, _ in tips_of(machine):
            tip = motion.points[point]
            place, velocity = (np.stack([z.real, z.imag], -1) for z in (tip.place, tip.velocity))
            force = soil_force(machine, place, velocity, motion.speed)
            yield link, point, force[:, 0] + 1j * force[:, 1], np.zeros(len(force))


def angle_of(motion: eq.mechanism.Motion, body: str) -> Array:
    """Angle of a body in the frame, rad."""
    return np.zeros(len(motion.crank_angle)) if body == FRAME else motion.links[body].angle


def along(a: Any, b: Any) -> Any:
    """Scalar product of planar vectors."""
    return (np.conj(a) * b).real


def outputs(result: eq.mechanism.Forces) -> Iterator[tuple[str, Array]]:
    """Every output of the forces by name; vectors are complex."""
    for name in ("shaking_force", "frame_force"):
        yield name, getattr(result, name).value
    for name in ("shaking_moment", "frame_moment", "drive_torque"):
        yield name, getattr(result, name)
    yield from families_of(result)


def families_of(result: Any) -> Iterator[tuple[str, Array]]:
    """Every array of joints and contacts by name, of forces, a split or a regressor."""
    for family in ("joints", "gears", "racks", "cams", "belts"):
        for name, joint in getattr(result, family).items():
            for part in ("value", "normal", "moment", "tangential", "radial", *STRANDS):
                if hasattr(joint, part):
                    yield f"{family}/{name}/{part}", getattr(joint, part)


def sizes(result: eq.mechanism.Forces) -> tuple[float, float]:
    """Largest force (N) and moment (N m) that occur anywhere in a machine."""
    force, moment = [0.0], [0.0]
    for name, value in outputs(result):
        (force if is_force(name) else moment).append(float(np.max(np.abs(value))))
    return max(force), max(moment)


def is_force(name: str) -> bool:
    """Tell forces from moments by their name."""
    return name.rpartition("/")[2] not in ("moment", "shaking_moment", "frame_moment",
                                           "drive_torque")  # fmt: skip


def same(got: Any, want: Any, tolerance: float, scale: float | None = None) -> None:
    """Check that arrays agree, measured against the largest value or a given scale."""
    got, want = np.asarray(got), np.asarray(want)
    largest = float(np.max(np.abs(want))) if scale is None else scale
    assert np.all(np.isfinite(got))
    apart = float(np.max(np.abs(got - want)))
    assert apart <= tolerance * largest, f"{apart:.3g} off, of {largest:.3g}"


def same_outputs(got: eq.mechanism.Forces, want: eq.mechanism.Forces, tolerance: float) -> None:
    """Check that two machines have the same outputs, measured against the largest of each sort."""
    force, moment = sizes(want)
    expected = dict(outputs(want))
    assert dict(outputs(got)).keys() == expected.keys()
    for name, value in outputs(got):
        same(value, expected[name], tolerance, force if is_force(name) else moment)


def without_loads(machine: eq.Machine) -> eq.Machine:
    """Take all loads away, the soil and springs among them."""
    return replace(without_soil(machine), loads=(), springs=())


def without_soil(machine: eq.Machine) -> eq.Machine:
    return machine.with_planting(soil=None) if has_soil(machine) else machine
