"""Figures of the stay in the soil, and speeds that keep within limits."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.mechanism.instants import integral, lowest_within
from equipoise.mechanism.tip import TipCurve
from equipoise.planting.moments import finger_base
from equipoise.planting.vectors import Array, Figures, ground_drive, in_time, while_driving, wrapped

PANELS = 24
SAMPLES_OF_TURN = 720
"""Panels of the stay in which lengths are summed up, and samples of a turn."""


def in_soil(curve: TipCurve, entry: Array, leave: Array, breaks: Array | None) -> Figures:
    """What the tip does between entry and exit.  Ground figures are NaN for a machine at rest."""
    travel = np.abs(leave - entry)
    time = travel / np.abs(curve.speed[:, 0])
    if breaks is None:
        breaks = entry[:, None] + (leave - entry)[:, None] * np.linspace(0, 1, PANELS + 1)
    ends = curve.at(np.stack([entry, leave], axis=1)).place.real
    advance = ends[:, 1] - ends[:, 0] + curve.forward[:, 0] * time
    drives = while_driving(curve)
    sharpest, at = _largest_in_soil(curve, entry, leave)
    return {
        "soil.depth": curve.surface - curve.lowest[0],
        "soil.crank_travel": travel,
        "soil.time": time,
        "soil.path_length_machine": _length(curve, breaks, 0.0),
        "soil.path_length_ground": _length(curve, breaks, ground_drive(curve)) * drives,
        "soil.ground_advance": advance * drives,
        "soil.ground_distance": np.abs(advance) * drives,
        "soil.hole_length": _hole_length(curve, entry, leave) * drives,
        "soil.max_acceleration.value": sharpest,
        "soil.max_acceleration.crank_angle": wrapped(curve, at),
    }


def _length(curve: TipCurve, breaks: Array, drive: Any) -> Array:
    """Length (P,) of the path, m; `drive` is the machine's way by crank angle, m."""
    return np.abs(integral(lambda theta: np.abs(curve.at(theta).place_1 + drive), breaks))


def _hole_length(curve: TipCurve, entry: Array, leave: Array) -> Array:
    """Way over ground between the outermost places at which the finger cuts the surface.

    Instants at which the whole finger is below the surface do not count; a finger that comes or
    goes with its base first opens no hole that could be told: NaN.
    """
    base = finger_base(curve)
    if base is None:
        return np.full(curve.count, np.nan)
    level, start = curve.surface[:, None], entry[:, None]

    def cut(theta: Array, side: int) -> Any:
        """Place over ground of the cut, times `side`; infinite where the finger is all below."""
        tip = curve.at(theta)
        back = curve.point_of(tip.state, base)[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.clip((level - tip.place.imag) / (back.imag - tip.place.imag), 0, 1)
        x = tip.place.real + share * (back.real - tip.place.real)
        x = x + (theta - start) * ground_drive(curve)
        return np.where((back.imag >= level) & np.isfinite(share), side * x, np.inf)

    left = lowest_within(lambda theta: cut(theta, 1), entry, leave)[0]
    right = lowest_within(lambda theta: cut(theta, -1), entry, leave)[0]
    ends = np.stack([entry, leave], axis=1)
    upright = np.all(curve.point_of(curve.at(ends).state, base)[0].imag >= level, axis=1)
    return np.where(upright, -right - left, np.nan)


def _largest_in_soil(curve: TipCurve, entry: Array, leave: Array) -> tuple[Array, Array]:
    value, at = lowest_within(lambda theta: -np.abs(in_time(curve, theta, 2)), entry, leave)
    return -value, at


def limits(curve: TipCurve, entry: Array, leave: Array) -> Figures:
    """Highest speeds of the drive (rad/s, without acceleration) that keep within the limits.

    The forward speed is the one at which hills stay as far apart as they are.
    """
    planting = curve.planting

    def less(theta: Array) -> Any:
        return -np.abs(curve.at(theta).place_2)

    result: Figures = {}
    ends = np.zeros(curve.count), np.full(curve.count, curve.period)
    for name, limit, (low, high) in (
        ("acceleration", planting.acceleration_limit, ends),
        ("soil_acceleration", planting.soil_acceleration_limit, (entry, leave)),
    ):
        if limit is not None:
            bend = -lowest_within(less, low, high, samples=SAMPLES_OF_TURN * curve.turns)[0]
            result[f"limits.{name}.limit"] = np.full(curve.count, limit)
            speed = np.sqrt(limit / bend)
            result[f"limits.{name}.highest_speed"] = speed
            way = np.abs(ground_drive(curve)[:, 0])
            result[f"limits.{name}.highest_forward_speed"] = way * speed
    return result
