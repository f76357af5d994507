"""The instants of a stroke: when they are, and what the tip does then."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.mechanism.instants import roots
from equipoise.mechanism.tip import TipCurve
from equipoise.planting.vectors import Array, Figures, direction, in_time, wrapped


def soil_crossings(curve: TipCurve) -> tuple[Array, Array]:
    """Crank angles (P,) at which the tip enters the soil before its lowest point, and leaves after.

    They run on in the sense of the drive; NaN where it does not reach the surface or never leaves.
    """
    sense = np.sign(curve.speed)
    count = len(curve.theta)
    ahead = np.linspace(0.0, curve.period, count + 1)
    lowest = curve.lowest[1][:, None]
    nodes = lowest + sense * ahead
    level = curve.surface[:, None]
    above = curve.height(nodes) >= level
    k_leave = np.argmax(above, axis=1)[:, None]
    k_entry = count - np.argmax(above[:, ::-1], axis=1)[:, None]
    found = np.any(above, axis=1) & ~above[:, 0]
    k_leave, k_entry = np.clip(k_leave, 1, count), np.clip(k_entry, 0, count - 1)

    def over(theta: Array) -> Any:
        return curve.height(theta) - level

    def between(k: Array) -> Array:
        ends = (np.take_along_axis(nodes, k + step, axis=1) for step in (0, 1))
        return np.where(found, roots(over, *ends)[:, 0], np.nan)

    return between(k_entry) - sense[:, 0] * curve.period, between(k_leave - 1)


def release(curve: TipCurve) -> Array:
    """Crank angle (P,) at which the seedling is let go."""
    given = curve.planting.release
    return curve.lowest[1] if given is None else np.full(curve.count, given)


def instant(curve: TipCurve, instant: str, theta: Array) -> Figures:
    """Place, velocity, acceleration and attitude at crank angles (P,)."""
    tip = curve.at(theta[:, None])
    velocity = in_time(curve, theta[:, None], 1)[:, 0]
    result = {
        "crank_angle": wrapped(curve, theta),
        "x": tip.place[:, 0].real,
        "y": tip.place[:, 0].imag,
    }
    for name, vector in (
        ("velocity", velocity),
        ("acceleration", in_time(curve, theta[:, None], 2)[:, 0]),
        ("ground_velocity", velocity + curve.forward[:, 0]),
    ):
        result |= {
            f"{name}.x": vector.real,
            f"{name}.y": vector.imag,
            f"{name}.size": np.abs(vector),
            f"{name}.direction": direction(vector),
        }
    base = finger_base(curve)
    if base is not None:
        finger = tip.place - curve.point_of(tip.state, base)[0]
        result["attitude"] = direction(finger[:, 0])
    return {f"{instant}.{key}": value for key, value in result.items()}


def finger_base(curve: TipCurve) -> str | None:
    """The point from which the finger points to the tip, if the tip's link has one."""
    if curve.planting.finger_from is not None:
        return curve.planting.finger_from
    points = curve.machines[0].links[curve.link].points
    return next((point for point in points if point != curve.planting.tip), None)
