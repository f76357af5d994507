"""Figures of the tip's motion, for one machine or for many designs of it at once.

Every figure has a dotted name, as in the output, and an array (P,) of values in SI units; NaN
where a design does not have it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

import numpy as np

from equipoise.mechanism.formulas.kernels import cross, dot
from equipoise.mechanism.kinematics.tip import (
    STEP,
    Signal,
    TipCurve,
    integral,
    largest,
    lowest_within,
    roots,
    smallest,
)
from equipoise.planting.clearance import clearances
from equipoise.planting.stroke import (
    Figures,
    direction,
    finger_base,
    ground_drive,
    in_time,
    in_time_slope,
    instant,
    pick_up,
    release,
    while_driving,
    whole_cycle,
    wrapped,
)
from equipoise.signals import Array

OF_MACHINE = ("ratio", "transmission")
"""Groups of figures that are of no arm."""
PANELS, SAMPLES_OF_TURN = 24, 720
"""Panels of the stay in which lengths are summed up, and samples of a turn."""


def tip_figures(
    curve: TipCurve,
    entry: Array,
    leave: Array,
    breaks: Array | None = None,
    wanted: Collection[str] | None = None,
) -> Figures:
    """Every figure of the path, of the instants and of the stay in the soil.

    entry, leave : (P,) crank angles at which the tip enters and leaves the soil, running on in the
        sense of the drive.
    breaks : (P, B) crank angles from entry to leave between which the path is smooth; None for
        equal panels.
    wanted : groups that are needed, such as ``curve``; None for all.

    What is of the whole machine comes with the first of its arms.
    """
    instants: dict[str, Callable[[], Array]] = {
        "lowest": lambda: curve.lowest[1],
        "highest": lambda: curve.highest[1],
        "entry": lambda: entry,
        "exit": lambda: leave,
        "release": lambda: release(curve),
    }
    if curve.planting.tray is not None:
        instants["pick_up"] = lambda: pick_up(curve, entry)
    groups: dict[str, Callable[[str], Figures]] = {
        "surface": lambda name: {name: curve.surface},
        "curve": lambda name: size_of_curve(curve),
        "curve.smallest_radius": lambda name: sharpest_bend(curve, "curve", 0.0),
        "ground": lambda name: sharpest_bend(
            curve, name, ground_drive(curve), while_driving(curve)
        ),
        **dict.fromkeys(
            ("max_speed", "min_speed", "max_acceleration", "min_acceleration"),
            lambda name: extreme(curve, name),
        ),
        "ratio": lambda name: ratios(curve),
        "transmission": lambda name: transmission(curve),
        "soil": lambda name: in_soil(curve, entry, leave, breaks),
        "limits": lambda name: limits(curve, entry, leave),
        "clearance": lambda name: clearances(curve, entry),
        **dict.fromkeys(instants, lambda name: instant(curve, name, instants[name]())),
    }
    if curve is not curve.arms[0]:
        groups = {name: group for name, group in groups.items() if name not in OF_MACHINE}
    known = [group(name) for name, group in groups.items() if wanted is None or name in wanted]
    return {name: values for result in known for name, values in result.items()}


def size_of_curve(curve: TipCurve) -> Figures:
    """Extent and length of the curve relative to the machine."""
    left, right = (
        find(
            lambda theta: curve.at(theta).place.real,
            lambda theta: curve.at(theta).place_1.real,
            curve.theta,
            curve.grid.place.real,
        )[0]
        for find in (smallest, largest)
    )
    bottom, top = curve.lowest[0], curve.highest[0]
    return {
        "curve.height": top - bottom,
        "curve.width": right - left,
        "curve.length": np.mean(np.abs(curve.grid.place_1), axis=1) * curve.period,
        "curve.lift": top - curve.surface,
    }


def sharpest_bend(curve: TipCurve, name: str, drive: Any, share: Any = 1.0) -> Figures:
    """Smallest radius of curvature and its crank angle: one over the largest curvature.

    drive : way of the machine along x by crank angle, m; 0 for the path relative to the machine.
    share : NaN for a machine that has no such path.
    """

    def squared(theta: Array) -> Any:
        tip = curve.at(theta)
        rate = tip.place_1 + drive
        return np.square(cross(rate, tip.place_2) / np.abs(rate) ** 3)

    def slope(theta: Array) -> Any:
        tip = curve.at(theta)
        rate, bend = tip.place_1 + drive, cross(tip.place_1 + drive, tip.place_2)
        turning = cross(rate, curve.place_3(theta)) * np.abs(rate) ** 2
        return bend * (turning - 3 * bend * dot(rate, tip.place_2))

    with np.errstate(divide="ignore", invalid="ignore"):
        samples = np.nan_to_num(squared(curve.grid.theta), nan=np.inf)
        value, at = largest(squared, slope, curve.theta, samples)
        slow = _slow_bend(curve, drive, slope)
        sharp = squared(slow[:, None])[:, 0]
        radius = 1 / np.sqrt(np.fmax(value, sharp))
    return {
        f"{name}.smallest_radius.value": radius * share,
        f"{name}.smallest_radius.crank_angle": wrapped(curve, np.where(sharp <= value, at, slow))
        * share,
    }


def _slow_bend(curve: TipCurve, drive: Any, slope: Signal) -> Array:
    """Crank angle (P,) of the bend at the slowest place, which may be sharper than samples tell."""

    def rate2(theta: Array) -> Any:
        return np.abs(curve.at(theta).place_1 + drive) ** 2

    def rising(theta: Array) -> Any:
        tip = curve.at(theta)
        return dot(tip.place_1 + drive, tip.place_2)

    value, slowest = smallest(rate2, rising, curve.theta, rate2(curve.grid.theta))
    at = slowest[:, None]
    half_width = 0.5 * np.sqrt(value)[:, None] / np.abs(curve.at(at).place_2)
    width = np.fmin(half_width, curve.theta[1])  # near is 0 over 0 where the tip dwells
    return np.asarray(roots(slope, at - width, at + width)[:, 0])


def extreme(curve: TipCurve, name: str) -> Figures:
    """Largest or smallest velocity or acceleration relative to the machine, with its direction.

    name : ``max_speed``, ``min_speed``, ``max_acceleration`` or ``min_acceleration``.
    """
    find = largest if name.startswith("max") else smallest
    order = 1 if name.endswith("speed") else 2

    def squared(theta: Array) -> Any:
        return np.abs(in_time(curve, theta, order)) ** 2

    def rising(theta: Array) -> Any:
        return dot(in_time(curve, theta, order), in_time_slope(curve, theta, order))

    value, at = find(squared, rising, curve.theta, squared(curve.grid.theta))
    return {
        f"{name}.value": np.sqrt(value),
        f"{name}.crank_angle": wrapped(curve, at),
        f"{name}.direction": direction(in_time(curve, at[:, None], order)[:, 0]),
    }


def ratios(curve: TipCurve) -> Figures:
    """Extremes of the angular velocity of every link but the drive, over that of the drive."""
    result: Figures = {}
    machine, family = curve.machines[0], curve.family
    for link in machine.links:
        if link == machine.drive.link:
            continue
        rate, slope = (
            lambda theta, link=link, order=order: family.rates(family.solve(theta), link)[order]
            for order in (0, 1)
        )
        samples = family.rates(curve.grid.state, link)[0]
        for which, find in (("min", smallest), ("max", largest)):
            value, at = find(rate, slope, curve.theta, samples)
            result[f"ratio.{link}.{which}"] = value
            result[f"ratio.{link}.{which}_at"] = wrapped(curve, at)
    return result


def transmission(curve: TipCurve) -> Figures:
    """Smallest transmission angle of any dyad; an obtuse one counts by what it lacks to 180 deg."""
    family = curve.family
    if not any(group.margin for group in family.first.groups):
        return {}

    def margin(theta: Array) -> Any:
        return family.margins(family.solve(theta))

    samples = family.margins(curve.grid.state)
    value, at = smallest(
        margin, lambda x: margin(x + STEP) - margin(x - STEP), curve.theta, samples
    )
    angle = np.arcsin(np.sqrt(np.clip(value, 0.0, 1.0)))
    return {"transmission.min": angle, "transmission.min_at": wrapped(curve, at)}


def in_soil(curve: TipCurve, entry: Array, leave: Array, breaks: Array | None) -> Figures:
    """What the tip does between entry and exit.  Ground figures are NaN for a machine at rest."""
    travel = np.abs(leave - entry)
    time = travel / np.abs(curve.speed[:, 0])
    if breaks is None:
        breaks = entry[:, None] + (leave - entry)[:, None] * np.linspace(0, 1, PANELS + 1)
    ends = curve.at(np.stack([entry, leave], axis=1)).place.real
    advance = ends[:, 1] - ends[:, 0] + curve.forward[:, 0] * time
    drives = while_driving(curve)
    sharpest, at = lowest_within(lambda theta: -np.abs(in_time(curve, theta, 2)), entry, leave)
    return {
        "soil.depth": curve.surface - curve.lowest[0],
        "soil.crank_travel": travel,
        "soil.time": time,
        "soil.path_length_machine": _length(curve, breaks, 0.0),
        "soil.path_length_ground": _length(curve, breaks, ground_drive(curve)) * drives,
        "soil.ground_advance": advance * drives,
        "soil.ground_distance": np.abs(advance) * drives,
        "soil.hole_length": _hole_length(curve, entry, leave) * drives,
        "soil.max_acceleration.value": -sharpest,
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


def limits(curve: TipCurve, entry: Array, leave: Array) -> Figures:
    """Highest speeds of the drive (rad/s, without acceleration) that keep within the limits.

    The forward speed is the one at which hills stay as far apart as they are.
    """
    result: Figures = {}
    for name, limit, ends in (
        ("acceleration", curve.planting.acceleration_limit, whole_cycle(curve)),
        ("soil_acceleration", curve.planting.soil_acceleration_limit, (entry, leave)),
    ):
        if limit is not None:
            samples = SAMPLES_OF_TURN * curve.turns
            bend = lowest_within(lambda x: -np.abs(curve.at(x).place_2), *ends, samples=samples)[0]
            speed = np.sqrt(limit / -bend)
            result |= {
                f"limits.{name}.limit": np.full(curve.count, limit),
                f"limits.{name}.highest_speed": speed,
                f"limits.{name}.highest_forward_speed": np.abs(ground_drive(curve)[:, 0]) * speed,
            }
    return result
