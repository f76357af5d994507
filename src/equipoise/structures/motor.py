"""The torque that a motor or engine exerts on the crank."""

from __future__ import annotations

from math import copysign
from typing import Any

import numpy as np

from equipoise.errors import ResponseError
from equipoise.mechanism.model import Drive
from equipoise.mechanism.motor import Motor
from equipoise.structures.coupled import Torque

Array = np.ndarray[Any, Any]


def torque_on_crank(drive: Drive, way: float) -> Torque:
    """Torque on the crank, N m, at its speed and a shift of the motor's curve, both rad/s.

    way : with the sign of the speed at which the motor is to turn the crank.
    """
    motor = drive.motor
    assert motor is not None
    sense = copysign(1.0, way)
    speeds, torques = _rows(motor)
    slopes = np.diff(torques) / np.diff(speeds)

    def torque(speed: Array, shift: Array) -> Array:
        own = sense * motor.ratio * speed - shift
        k = np.clip(np.searchsorted(speeds, own.real, side="right") - 1, 0, len(slopes) - 1)
        value: Array = sense * motor.ratio * (torques[k] + slopes[k] * (own - speeds[k]))
        return value

    return torque


def _rows(motor: Motor) -> tuple[Array, Array]:
    """Speeds and torques between which the motor's curve is straight."""
    if motor.table is not None:
        return np.array(motor.table.speed), np.array(motor.table.torque)
    assert motor.no_load_speed is not None and motor.stall_torque is not None
    return np.array([0.0, motor.no_load_speed]), np.array([motor.stall_torque, 0.0])


def fastest(motor: Motor) -> float:
    """Highest speed of a motor's curve, rad/s."""
    return float(_rows(motor)[0][-1])


def speed_at(motor: Motor, torque: float) -> float:
    """Highest speed of the motor, rad/s, at which its torque, N m, falls through a value.

    Raises
    ------
    ResponseError : it never does.
    """
    speeds, torques = _rows(motor)
    for k in range(len(speeds) - 2, -1, -1):
        slope = (torques[k + 1] - torques[k]) / (speeds[k + 1] - speeds[k])
        if slope >= 0:
            continue
        speed = speeds[k] + (torque - torques[k]) / slope
        low = -np.inf if k == 0 else speeds[k]
        high = np.inf if k == len(speeds) - 2 else speeds[k + 1]
        if low <= speed <= high:
            return float(speed)
    raise ResponseError(
        f"drive.motor: its torque nowhere falls through {torque:g} N m, which the machine takes in "
        "the mean; give a stronger motor, or a higher ratio"
    )
