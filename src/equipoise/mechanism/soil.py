"""What the soil does to the tip of a planting finger."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.mechanism.field import Soil
from equipoise.mechanism.motion import Motion
from equipoise.mechanism.tip import surface_of

Array = np.ndarray[Any, Any]


def soil_force(motion: Motion) -> Array:
    """Force of the soil on the tip (N,), N, complex; 0 above the surface.

    Raises
    ------
    ModelError : the machine has no `[planting]`.
    MotionError : its crank cannot turn fully, so that no lowest point tells where the surface is.
    """
    planting = motion.machine.planting
    if planting is None or planting.soil is None:
        return np.zeros(len(motion.crank_angle), complex)
    tip = motion.points[planting.tip]
    depth = surface_of(motion.machine) - tip.y
    over_ground = tip.velocity + planting.forward(motion.speed)
    speed = np.abs(over_ground)
    size = np.where(depth > 0, resistance(planting.soil, depth, speed), 0.0)
    against = np.divide(-over_ground, speed, out=np.zeros_like(over_ground), where=speed > 0)
    return size * against


def resistance(soil: Soil, depth: Array, speed: Array) -> Array:
    """Size of the force (N,), N, at depths (N,), m, and speeds over ground (N,), m/s."""
    size = soil.resistance + soil.per_depth * depth + soil.per_speed * speed
    size = size + soil.per_depth_and_speed * depth * speed
    if soil.table is not None:
        size = size + np.interp(depth, soil.table.depth, soil.table.resistance)
    return size
