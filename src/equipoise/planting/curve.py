"""Figures of the tip's whole curve: size, bends, extremes, ratios, transmission angle."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.mechanism import kernels
from equipoise.mechanism.tip import STEP, Signal, TipCurve, largest, roots, smallest
from equipoise.planting.stroke import (
    Array,
    Figures,
    direction,
    ground_drive,
    in_time,
    in_time_slope,
    while_driving,
    wrapped,
)


def size_of_curve(curve: TipCurve) -> Figures:
    """Extent and length of the curve relative to the machine."""
    grid = curve.grid

    def across(theta: Array) -> Any:
        return curve.at(theta).place.real

    def drift(theta: Array) -> Any:
        return curve.at(theta).place_1.real

    x = grid.place.real
    right = largest(across, drift, curve.theta, x)[0]
    left = smallest(across, drift, curve.theta, x)[0]
    bottom, top = curve.lowest[0], curve.highest[0]
    return {
        "curve.height": top - bottom,
        "curve.width": right - left,
        "curve.length": np.mean(np.abs(grid.place_1), axis=1) * curve.period,
        "curve.lift": top - curve.surface,
    }


def sharpest_bend(curve: TipCurve, name: str, drive: Any) -> Figures:
    """Smallest radius of curvature and its crank angle: one over the largest curvature.

    drive : way of the machine along x by crank angle, m; 0 for the path relative to the machine.
    """

    def squared(theta: Array) -> Any:
        tip = curve.at(theta)
        rate = tip.place_1 + drive
        return np.square(kernels.cross(rate, tip.place_2) / np.abs(rate) ** 3)

    def slope(theta: Array) -> Any:
        tip = curve.at(theta)
        rate, bend = tip.place_1 + drive, kernels.cross(tip.place_1 + drive, tip.place_2)
        turning = kernels.cross(rate, curve.place_3(theta)) * np.abs(rate) ** 2
        return bend * (turning - 3 * bend * kernels.dot(rate, tip.place_2))

    with np.errstate(divide="ignore", invalid="ignore"):
        samples = np.nan_to_num(squared(curve.grid.theta), nan=np.inf)
        value, at = largest(squared, slope, curve.theta, samples)
        slow = _slow_bend(curve, drive, slope)
        sharp = squared(slow[:, None])[:, 0]
        at = np.where(sharp <= value, at, slow)
        radius = 1 / np.sqrt(np.fmax(value, sharp))
    return {
        f"{name}.smallest_radius.value": radius,
        f"{name}.smallest_radius.crank_angle": wrapped(curve, at),
    }


def ground_bend(curve: TipCurve) -> Figures:
    """The same of the path over ground; NaN for a machine at rest, which has none."""
    found = sharpest_bend(curve, "ground", ground_drive(curve))
    return {name: value * while_driving(curve) for name, value in found.items()}


def _slow_bend(curve: TipCurve, drive: Any, slope: Signal) -> Array:
    """Crank angle (P,) of the bend at the slowest place, which may be sharper than samples tell."""

    def rate2(theta: Array) -> Any:
        return np.abs(curve.at(theta).place_1 + drive) ** 2

    def rising(theta: Array) -> Any:
        tip = curve.at(theta)
        return kernels.dot(tip.place_1 + drive, tip.place_2)

    value, slowest = smallest(rate2, rising, curve.theta, rate2(curve.grid.theta))
    at = slowest[:, None]
    width = np.sqrt(value)[:, None] / np.abs(curve.at(at).place_2)
    width = np.minimum(0.5 * width, curve.theta[1])
    found: Array = roots(slope, at - width, at + width)[:, 0]
    return found


def extreme(curve: TipCurve, name: str) -> Figures:
    """Largest or smallest velocity or acceleration relative to the machine, with its direction.

    name : ``max_speed``, ``min_speed``, ``max_acceleration`` or ``min_acceleration``.
    """
    find = largest if name.startswith("max") else smallest
    order = 1 if name.endswith("speed") else 2

    def vector(theta: Array) -> Any:
        return in_time(curve, theta, order)

    def squared(theta: Array) -> Any:
        return np.abs(vector(theta)) ** 2

    def rising(theta: Array) -> Any:
        return kernels.dot(vector(theta), in_time_slope(curve, theta, order))

    value, at = find(squared, rising, curve.theta, squared(curve.grid.theta))
    return {
        f"{name}.value": np.sqrt(value),
        f"{name}.crank_angle": wrapped(curve, at),
        f"{name}.direction": direction(vector(at[:, None])[:, 0]),
    }


def ratios(curve: TipCurve) -> Figures:
    """Extremes of the angular velocity of every link but the drive, over that of the drive."""
    result: Figures = {}
    machine = curve.machines[0]
    grid = curve.grid
    for link in machine.links:
        if link == machine.drive.link:
            continue

        def rate(theta: Array, link: str = link) -> Any:
            return curve.family.rates(curve.family.solve(theta), link)[0]

        def slope(theta: Array, link: str = link) -> Any:
            return curve.family.rates(curve.family.solve(theta), link)[1]

        samples = curve.family.rates(grid.state, link)[0]
        for which, find in (("min", smallest), ("max", largest)):
            value, at = find(rate, slope, curve.theta, samples)
            result[f"ratio.{link}.{which}"] = value
            result[f"ratio.{link}.{which}_at"] = wrapped(curve, at)
    return result


def transmission(curve: TipCurve) -> Figures:
    """Smallest transmission angle of any dyad; an obtuse one counts by what it lacks to 180 deg."""
    if not any(group.margin for group in curve.family.first.groups):
        return {}

    def margin(theta: Array) -> Any:
        return curve.family.margins(curve.family.solve(theta))

    def slope(theta: Array) -> Any:
        return margin(theta + STEP) - margin(theta - STEP)

    samples = curve.family.margins(curve.grid.state)
    value, at = smallest(margin, slope, curve.theta, samples)
    angle = np.arcsin(np.sqrt(np.clip(value, 0.0, 1.0)))
    return {"transmission.min": angle, "transmission.min_at": wrapped(curve, at)}
