"""Velocity, acceleration and way of the tip, and angles as they are told."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.mechanism.family import column
from equipoise.mechanism.tip import TipCurve

Array = np.ndarray[Any, Any]
Figures = dict[str, Array]
"""Figures by dotted name; (P,), one value for each machine."""


def in_time(curve: TipCurve, theta: Array, order: int) -> Any:
    """Velocity (order 1) or acceleration (2) of the tip relative to the machine, complex."""
    tip = curve.at(theta)
    if order == 1:
        return tip.place_1 * curve.speed
    return tip.place_2 * curve.speed**2 + tip.place_1 * acceleration_of_drive(curve)


def in_time_slope(curve: TipCurve, theta: Array, order: int) -> Any:
    """Derivative of `in_time` by crank angle."""
    bend = curve.at(theta).place_2
    if order == 1:
        return bend * curve.speed
    return curve.place_3(theta) * curve.speed**2 + bend * acceleration_of_drive(curve)


def acceleration_of_drive(curve: TipCurve) -> Array:
    """Acceleration of the crank, rad/s2, (P, 1)."""
    return column(machine.drive.acceleration for machine in curve.machines)


def ground_drive(curve: TipCurve) -> Array:
    """Way of the machine along x by crank angle, m, (P, 1)."""
    return curve.forward / curve.speed


def while_driving(curve: TipCurve) -> Array:
    """1 for a machine that drives, NaN for one at rest, which has no figures over ground; (P,)."""
    return np.where(curve.forward[:, 0] != 0, 1.0, np.nan)


def direction(vector: Array) -> Array:
    """Direction of vectors from x, rad, above -pi; of one along x, no rounding turns it round."""
    level = np.abs(vector.imag) <= 1e-12 * np.abs(vector.real)
    return np.angle(np.where(level, vector.real + 0j, vector))


def wrapped(curve: TipCurve, theta: Array) -> Array:
    """Crank angles within one cycle, from 0."""
    inside = np.mod(theta, curve.period)
    return np.where(inside > curve.period - 1e-12, 0.0, inside)
