"""Loads of a machine, evaluated anew: a force at a point and a torque, against crank angle."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.mechanism.model import Load, LoadTable, Machine
from support.poses import Array, Poses, cross

TURN = 2 * np.pi


def force_and_torque(load: Load, crank_angle: Array) -> tuple[Array, Array]:
    """Return the force (N, 2) and the torque (N,) of one load."""
    acting = within(load, crank_angle).astype(float)
    force, torque = np.zeros((crank_angle.size, 2)), np.zeros(crank_angle.size)
    if load.table is not None:
        columns = np.stack(tabulated(load.table, crank_angle), -1)
        if columns.shape[1] == 2:
            force = columns
        else:
            torque = columns[:, 0]
    elif load.force is not None:
        force = force + np.array(load.force)
    elif load.torque is not None:
        torque = torque + load.torque
    return force * acting[:, None], torque * acting


def within(load: Load, crank_angle: Array) -> np.ndarray:
    """Tell at which crank angles a load acts."""
    if load.start is None or load.stop is None:
        return np.ones(crank_angle.size, bool)
    return (crank_angle - load.start) % TURN <= (load.stop - load.start) % TURN


def tabulated(table: LoadTable, crank_angle: Array) -> list[Array]:
    """Walk round the table's closed polygon."""
    nodes = np.array(table.crank_angle)
    since = (crank_angle - nodes[0]) % TURN
    turn = np.append(nodes - nodes[0], TURN)
    return [np.interp(since, turn, np.append(column, column[0])) for column in table.values]


def on_links(machine: Machine, poses: Poses) -> Iterator[tuple[str, Array, Array, Array]]:
    """Yield link, point of attack, force and torque of every load."""
    for load in machine.loads:
        force, torque = force_and_torque(load, poses.crank_angle)
        local = (0.0, 0.0)
        if load.point is not None:
            local = machine.links[load.link].points[load.point]
        yield load.link, poses.place(load.link, local), force, torque


def work_per_crank_angle(machine: Machine, poses: Poses) -> Array:
    """Return the loads' power over the crank's speed."""
    power = np.zeros_like(poses.crank_angle)
    for link, at, force, torque in on_links(machine, poses):
        arm = at - poses.origin[link]
        moment = torque + cross(arm, force)
        power += np.sum(force * poses.velocity[link], -1) + moment * poses.omega[link]
    return power / machine.drive.speed
