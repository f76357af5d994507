"""Loads of a machine, the soil's on a planting tip among them, and its springs, evaluated anew."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import chain

import numpy as np
from scipy.optimize import minimize_scalar

import equipoise as eq
from equipoise.mechanism.parts.field import Planting
from equipoise.mechanism.parts.machine import FRAME, Load, LoadTable, Machine, Vector
from equipoise.mechanism.parts.springs import Spring
from support.machines_torsion import torsion_on_links
from support.poses import Array, Poses, cross

TURN = 2 * np.pi


def loaded_long(machine: Machine, rng: np.random.Generator) -> Machine:
    """Give a machine a load whose table takes two or three turns."""
    turns, link = int(rng.integers(2, 4)), str(rng.choice(list(machine.links)))
    rows = np.sort(rng.uniform([0, *[0.4] * 6, turns - 0.5], [0.4, *[turns - 0.5] * 6, turns]))
    forces = bool(rng.random() < 0.7)
    columns = rng.normal(size=(1 + forces, rows.size)) * 100
    table = LoadTable(tuple((TURN * rows).tolist()), tuple(map(tuple, columns.tolist())))
    point = str(rng.choice(list(machine.links[link].points))) if forces else None
    outside = ("zero", "hold", "wrap")[rng.integers(3)]
    return replace(machine, loads=(*machine.loads, Load(link, point, table=table, outside=outside)))


def force_and_torque(load: Load, crank_angle: Array) -> tuple[Array, Array]:
    """Return the force (N, 2) and the torque (N,) of one load."""
    acting = within(load, crank_angle).astype(float)
    force, torque = np.zeros((crank_angle.size, 2)), np.zeros(crank_angle.size)
    if load.table is not None:
        columns = np.stack(tabulated(load, load.table, crank_angle), -1)
        if columns.shape[1] == 2:
            force = columns
        else:
            torque = columns[:, 0]
    elif load.force is not None:
        force = force + np.array(load.force)
    elif load.torque is not None:
        torque = torque + load.torque
    return force * acting[:, None], torque * acting


def axes_angle(machine: Machine, load: Load, angle_of: Callable[[str], Array]) -> Array:
    """Return the angle (N,) of the axes of a load that turns: of its link, or of its guide."""
    if load.axes == "link":
        return angle_of(load.link)
    own = [slider for slider in machine.sliders if slider.link == load.link]
    at_point = [slider for slider in own if slider.point == load.point] or own
    guide = own[0] if len(own) == 1 else at_point[0]
    return angle_of(guide.on) + guide.direction


def within(load: Load, crank_angle: Array) -> np.ndarray:
    """Tell at which crank angles a load acts."""
    if load.start is None or load.stop is None:
        return np.ones(crank_angle.size, bool)
    return (crank_angle - load.start) % TURN <= (load.stop - load.start) % TURN


def tabulated(load: Load, table: LoadTable, crank_angle: Array) -> list[Array]:
    """Walk along the table's rows, turn after turn, and over the gap behind the last one."""
    nodes = np.array(table.crank_angle)
    last = nodes[-1] - nodes[0]
    cycle = TURN * max(1, np.ceil(last / TURN - 1e-6))
    since = (crank_angle - nodes[0]) % cycle
    actual = []
    for column in table.values:
        ahead = {"zero": 0.0, "hold": column[-1], "wrap": np.nan, None: np.nan}[load.outside]
        across = column[-1] + (column[0] - column[-1]) * (since - last) / max(cycle - last, 1e-300)
        ahead = np.where(np.isnan(ahead), across, ahead)
        actual.append(np.where(since > last, ahead, np.interp(since, nodes - nodes[0], column)))
    return actual


def has_soil(machine: Machine) -> bool:
    """Tell whether soil acts on the machine."""
    return machine.planting is not None and machine.planting.soil is not None


def tips_of(machine: Machine) -> Iterator[tuple[str, str, Vector]]:
    """Yield link, point and place on the link of each tip; a shared point is the first link's."""
    assert machine.planting is not None
    links = machine.links.items()
    for tip in (machine.planting.tip, *(arm.tip for arm in machine.planting.arms)):
        yield next((name, tip, k.points[tip]) for name, k in links if tip in k.points)


def surface_height(machine: Machine) -> float:
    """Return the height of the soil's surface, from a dense scan for the tips' lowest point."""
    planting = machine.planting
    assert planting is not None
    if planting.surface is not None:
        return planting.surface
    assert planting.depth is not None
    return min(_lowest(machine, tip) for _, tip, _ in tips_of(machine)) + planting.depth


def _lowest(machine: Machine, tip: str) -> float:
    def height(crank_angle: float) -> float:
        return float(eq.move(machine, np.array([crank_angle])).points[tip].y[0])

    cycle = eq.move(machine, 3600)
    angles, heights = cycle.crank_angle, cycle.points[tip].y
    low = (heights <= np.roll(heights, 1)) & (heights <= np.roll(heights, -1))
    step = angles[1] - angles[0]
    return min(
        minimize_scalar(height, bounds=(at - step, at + step), method="bounded").fun
        for at in angles[low]
    )


def travel(planting: Planting, speed: float) -> Array:
    """Return the machine's velocity over ground (2,) at a speed of its crank."""
    size = planting.forward_speed
    if size is None:
        assert planting.hill_spacing is not None
        size = planting.hill_spacing * planting.units_per_turn * abs(speed) / TURN
        size *= 1 + len(planting.arms)
    return np.array([{"forward": size, "backward": -size}[planting.travel], 0.0])


def soil_force(machine: Machine, place: Array, velocity: Array, speed: float) -> Array:
    """Return the soil's force on the tip, from the tip's place and velocity; all (N, 2)."""
    planting = machine.planting
    assert planting is not None
    assert planting.soil is not None
    soil, over_ground = planting.soil, velocity + travel(planting, speed)
    depth, fast = surface_height(machine) - place[:, 1], np.hypot(*over_ground.T)
    size = soil.resistance + soil.per_speed * fast
    size = size + (soil.per_depth + soil.per_depth_and_speed * fast) * depth
    if soil.table is not None:
        size = size + np.interp(depth, soil.table.depth, soil.table.resistance)
    # a tip at rest over ground is not pushed
    part = np.where((depth > 0) & (fast > 0), size / np.where(fast > 0, fast, 1.0), 0.0)
    return -part[:, None] * over_ground


def loads_by_end(machine: Machine) -> Iterator[Load]:
    """Yield every load, once for each of its ends on a link."""
    for load in machine.loads:
        yield load
        if load.reaction not in (None, FRAME):
            yield load


def on_links(machine: Machine, poses: Poses) -> Iterator[tuple[str, Array, Array, Array]]:
    """Yield link, point of attack, force and torque of every load, on each link at its ends."""
    for load in machine.loads:
        force, torque = force_and_torque(load, poses.crank_angle)
        local = (0.0, 0.0)
        if load.point is not None:
            local = machine.links[load.link].points[load.point]
        if load.axes is not None:
            angle = axes_angle(machine, load, poses.angle_of)
            x, y = force.T
            force = np.stack(
                [x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)], -1
            )
        at = poses.place(load.link, local)
        yield load.link, at, force, torque
        if load.reaction not in (None, FRAME):
            yield load.reaction, at, -force, -torque
    if has_soil(machine):
        for link, _, local in tips_of(machine):
            at, velocity = poses.place(link, local), poses.speed(link, local)
            yield link, at, soil_force(machine, at, velocity, machine.drive.speed), 0.0 * at[:, 0]


def spring_force(spring: Spring, at: Array, to: Vector) -> Array:
    """Return what a spring does to a point at some places (N, 2)."""
    arm = at - np.array(to)
    length = np.hypot(*arm.T)
    stretched = pull_of(spring, length) / np.where(length > 0, length, 1.0)
    return -stretched[:, None] * arm


def pull_of(spring: Spring, length: Array) -> Array:
    """Return the pull of a spring at some lengths (N,): linear, or between rows searched anew."""
    if spring.stiffness is not None:
        return (spring.preload or 0.0) + spring.stiffness * (length - spring.free_length)
    lengths, forces = map(np.asarray, spring.rows)
    k = np.clip(np.searchsorted(lengths, length) - 1, 0, len(lengths) - 2)
    slope = (forces[k + 1] - forces[k]) / (lengths[k + 1] - lengths[k])
    return np.asarray(forces[k] + slope * (length - lengths[k]))


def springs_on_links(machine: Machine, poses: Poses) -> Iterator[tuple[str, Array, Array, Array]]:
    """Yield link, point of attack, force and torque at every end of a spring of either kind."""
    for spring in machine.springs:
        at = poses.place(spring.link, machine.links[spring.link].points[spring.point])
        to = poses.place(spring.on, machine.points_of(spring.on)[spring.to])
        force = spring_force(spring, at, to)
        yield spring.link, at, force, np.zeros(len(at))
        if spring.on != FRAME:
            yield spring.on, to, -force, np.zeros(len(at))
    for link, torque in torsion_on_links(machine, poses):
        yield link, poses.origin[link], np.zeros((len(torque), 2)), torque


def work_per_crank_angle(machine: Machine, poses: Poses) -> Array:
    """Return the power of loads and springs over the crank's speed."""
    power = np.zeros_like(poses.crank_angle)
    acting = chain(on_links(machine, poses), springs_on_links(machine, poses))
    for link, at, force, torque in acting:
        arm = at - poses.origin[link]
        moment = torque + cross(arm, force)
        power += np.sum(force * poses.velocity[link], -1) + moment * poses.omega[link]
    return power / machine.drive.speed


def with_loads_in_lines() -> tuple[Machine, Machine]:
    """A machine without loads, and with two: one in the line to a point of the frame, one in that
    to a point of its crank, N.
    """
    bare = replace(eq.load("yamashita-1"), balance=None, loads=())
    bare = replace(bare, frame={**bare.frame, "S": (0.1, 0.6)})
    for link, points in {"coupler": {"Q": (0.07, 0.11)}, "crank": {"R": (-0.05, 0.02)}}.items():
        bare = bare.with_link(link, points={**bare.links[link].points, **points})
    loads = (
        Load("coupler", "Q", (35.0, 0.0), toward="S", reaction=FRAME),
        Load("coupler", "Q", (-20.0, 0.0), toward="R", reaction="crank"),
    )
    return bare, replace(bare, loads=loads)
