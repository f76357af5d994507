"""What a row adds to the moments of all rows: signals of one linkage, and levers by its place."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.formulas.kernels import cross
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.objectives import OF_ROWS
from equipoise.mechanism.parts.places import in_frame
from equipoise.mechanism.parts.support import Row
from equipoise.signals import Array

SHAKING, FRAME, ROCKING = 0, 3, 6
"""Among signals of one row: force x, y and moment about the drive's pivot, twice; rocking moment x
and y."""
UNIT = np.array([1.0, 1j, 0.0]), np.array([0.0, 0.0, 1.0])
"""Force and moment of which force x, y and moment are 1 in turn."""
ACROSS: Mapping[str, Callable[[Array], Array]] = {
    "roll_moment": np.real,
    "yaw_moment": np.imag,
    **dict.fromkeys(("rocking_moment", "frame_rocking_moment"), np.asarray),
}
"""Moments about x and y: what each is of the complex one."""
OWN = dict.fromkeys(OF_ROWS, "rocking_moment")
"""What each row adds of its own to what only rows have."""


def signals_of_row(motion: Motion) -> Array:
    """Signals of one linkage (8, N), in the order listed above."""
    result, nothing = forces(motion), np.zeros(len(motion.crank_angle))
    shaking, frame = result.shaking_force, result.frame_force
    rocking = (nothing, nothing)
    if motion.machine.has_planes:
        rocking = (result.across.rocking_moment.x, result.across.rocking_moment.y)
    moments = result.shaking_moment, result.frame_moment
    return np.stack([shaking.x, shaking.y, moments[0], frame.x, frame.y, moments[1], *rocking])


def lever(motion: Motion, output: str, row: Row, about: str | None) -> Array:
    """Rows (C, 8) by which an output of all rows reads the signals of one of them."""
    if output in OF_ROWS:
        values = np.zeros((1, ROCKING + 2))
        values[0, :2] = moment_of_row(output, row, 0j, UNIT[0][:2], np.zeros(2))
        values[0, ROCKING + OF_ROWS.index(output)] = 1.0
        return values
    first = FRAME if output.startswith("frame") else SHAKING
    kind = output.removeprefix("frame_").removeprefix("shaking_")
    whole = np.eye(ROCKING + 2)[first : first + 3]
    if output.endswith("_moment"):
        arm = arm_of(motion.machine, motion, row, about)
        return moment_of_row(output, row, arm, *UNIT)[None] @ whole
    return whole[{"force": [0, 1], "force.x": [0], "force.y": [1]}[kind]]


def arm_of(machine: Machine, motion: Motion, row: Row, about: str | None) -> complex:
    """From the point about which moments are taken to a row's drive pivot, m."""
    pivot = complex(*machine.frame[motion.linkage.pivot])
    return (
        pivot + complex(*row.offset) - (pivot if about is None else in_frame(machine.frame, about))
    )


def moment_of_row(output: str, row: Row, arm: complex, force: Array, moment: Array) -> Array:
    """What a row adds to a moment: (x, y, z) x F, with (x, y) the arm and z to the side, N m.

    force : complex, in the row's plane, N.
    moment : of the row about its own drive pivot, or complex its rocking moment, N m.
    """
    if output in ACROSS:
        whole = 1j * row.lateral * force + moment
        return np.asarray(ACROSS[output](whole))
    return np.asarray(moment + cross(arm, force))
