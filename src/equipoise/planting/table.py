"""Tip and centre of mass against crank angle, relative to machine and ground."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.mechanism.motion import MOST_ANGLES, PointMotion, move
from equipoise.planting.summary import PlantingFigures

Array = np.ndarray[Any, Any]


def table(figures: PlantingFigures, angles: int = 360) -> list[tuple[str, str, Array]]:
    """Columns as name, unit and values (N,), over one cycle in the order of time.

    angles : number of crank angles in a turn, from 0 in the sense of the drive.

    The path over ground begins where the machine is at crank angle 0: X = x + v t, equation [11] of
    Kim and Chung with a signed crank speed, so that it holds for both senses of rotation.
    """
    turns = figures.curve.turns
    if not 1 <= angles <= MOST_ANGLES // turns:
        raise UsageError(f"--angles: got {angles}; give 1 to {MOST_ANGLES // turns}")
    speed, forward = figures["speed"], figures["forward_speed"]
    way = np.arange(angles * turns) * (2 * pi / angles)
    motion = move(figures.machine, np.sign(speed) * way)
    time = way / abs(speed)
    columns = [
        ("crank_angle", "rad", np.mod(motion.crank_angle, 2 * pi * turns)),
        ("time", "s", time),
    ]
    columns += _columns("tip", motion.points[figures.planting.tip], time, forward)
    if figures.curve.link in motion.mass_centers:
        center = motion.mass_centers[figures.curve.link]
        columns += _columns("center_of_mass", center, time, forward)
    return columns


def _columns(
    name: str, point: PointMotion, time: Array, forward: float
) -> list[tuple[str, str, Array]]:
    over_ground = point.velocity + forward
    columns = {
        "x": ("m", point.x),
        "y": ("m", point.y),
        "ground_x": ("m", point.x + forward * time),
        "vx": ("m/s", point.vx),
        "vy": ("m/s", point.vy),
        "speed": ("m/s", np.abs(point.velocity)),
        "ground_vx": ("m/s", over_ground.real),
        "ground_speed": ("m/s", np.abs(over_ground)),
        "ax": ("m/s^2", point.ax),
        "ay": ("m/s^2", point.ay),
        "acceleration": ("m/s^2", np.abs(point.acceleration_vector)),
    }
    return [(f"{name}.{key}", unit, values) for key, (unit, values) in columns.items()]
