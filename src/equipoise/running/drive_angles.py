"""Where all drives of a machine are, and how they move with the unknowns of its equation."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import Array


class DriveAngles(NamedTuple):
    """Angles of all drives (N, K), rad, and their rates.

    crank_angle : (K,) rad.  speeds : rad/s.
    jacobian : (N, U, K), speeds with a unit of speed of each unknown alone.
    bias_accelerations : rad/s2, while no unknown accelerates.
    virtual_speeds : (N, U, K), with a unit of speed of each unknown while no given motion goes on,
    so that its drive does no work.
    effort_speeds : rad/s at which torques do work; of strokes m/s, at which forces do.
    lengths : of strokes (P, K), m.  slopes : of these by the angles of all drives (P, N, K), m/rad.
    """

    crank_angle: Array
    angles: Array
    speeds: Array
    jacobian: Array
    bias_accelerations: Array
    virtual_speeds: Array
    effort_speeds: Array
    lengths: Array
    slopes: Array


def drives_at(machine: Machine, crank_angle: float) -> tuple[Array, Array]:
    """Angles of all drives (N,), rad, as the file has them at a crank angle, rad, and their
    derivatives by it.
    """
    moved = machine.moved(np.array([crank_angle]))
    angles, rates = (
        np.array([np.ravel(moved[drive.link][order])[0] for drive in machine.driven])
        for order in (0, 1)
    )
    return angles, rates
