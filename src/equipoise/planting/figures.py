"""Figures of the tip's motion, for one machine or for many designs of it at once.

Figures of the tip's motion, for one machine or for many designs of it at once.

Every figure has a dotted name, as in the output, and an array (P,) of values in SI units; NaN
where a design does not have it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from itertools import combinations
from typing import Any

import numpy as np

from equipoise.mechanism import kernels
from equipoise.mechanism.tip import Signal, TipCurve, integral, lowest_within
from equipoise.planting.curve import (
    extreme,
    ground_bend,
    ratios,
    sharpest_bend,
    size_of_curve,
    transmission,
)
from equipoise.planting.stroke import (
    Array,
    Figures,
    finger_base,
    ground_drive,
    in_time,
    instant,
    pick_up,
    release,
    while_driving,
    wrapped,
)

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


def clearances(curve: TipCurve, entry: Array) -> Figures:
    """Smallest distance of each link from the soil and from the tray's edge.

    A link is the lines between its points, the tip left out, which is meant to go into the soil
    and to pass the edge.  The tip's own distance from the edge is 0 where it passes it.

    entry : (P,) crank angles at which the tip enters the soil.
    """
    result: Figures = {}
    outlines = _outlines(curve)
    for link, points in outlines.items():
        result |= _smallest(curve, f"clearance.soil.{link}", _above_soil(curve, link, points))
    if curve.planting.tray is None:
        return result
    start, stop = (complex(*point) for point in curve.planting.tray)
    for link, points in outlines.items():
        apart = _from_line(curve, link, points, start, stop)
        result |= _smallest(curve, f"clearance.tray.{link}", apart)
    tip = f"clearance.tray.tip {curve.planting.tip}"
    result |= _smallest(curve, tip, lambda theta: _to_line(curve.at(theta).place, start, stop))
    passes = pick_up(curve, entry)
    met = np.isfinite(passes)
    result[f"{tip}.value"] = np.where(met, 0.0, result[f"{tip}.value"])
    angle = np.where(met, wrapped(curve, passes), result[f"{tip}.crank_angle"])
    result[f"{tip}.crank_angle"] = angle
    return result


def _outlines(curve: TipCurve) -> dict[str, list[str]]:
    """Points of each moving link but the tip."""
    tip = curve.planting.tip
    outlines = {
        name: [point for point in link.points if point != tip]
        for name, link in curve.machines[0].links.items()
    }
    return {name: points for name, points in outlines.items() if points}


def _above_soil(curve: TipCurve, link: str, points: list[str]) -> Signal:
    """Height of a link's lowest point above the surface."""

    def height(theta: Array) -> Any:
        return np.min(_places(curve, link, points, theta).imag, axis=0) - curve.surface[:, None]

    return height


def _from_line(
    curve: TipCurve, link: str, points: list[str], start: complex, stop: complex
) -> Signal:
    """Distance of a link from a line that stands still."""

    def apart(theta: Array) -> Any:
        places = _places(curve, link, points, theta)
        lines = combinations(places, 2) if len(points) > 1 else [(places[0], places[0])]
        return np.min([distance(a, b, start, stop) for a, b in lines], axis=0)

    return apart


def _places(curve: TipCurve, link: str, points: list[str], theta: Array) -> Array:
    state = curve.family.solve(theta)
    return np.array([curve.point_of(state, point, link)[0] for point in points])


def _smallest(curve: TipCurve, name: str, signal: Signal) -> Figures:
    ends = np.zeros(curve.count), np.full(curve.count, curve.period)
    value, at = lowest_within(signal, *ends, samples=len(curve.theta) + 1)
    return {f"{name}.value": value, f"{name}.crank_angle": wrapped(curve, at)}


def distance(a: Array, b: Array, c: complex, d: complex) -> Array:
    """Distance between lines from a to b (..., K) and a line from c to d, m."""
    gaps = [_to_line(a, c, d), _to_line(b, c, d), _to_line(c, a, b), _to_line(d, a, b)]
    apart = kernels.cross(b - a, c - a) * kernels.cross(b - a, d - a) < 0
    across = kernels.cross(d - c, a - c) * kernels.cross(d - c, b - c) < 0
    return np.where(apart & across, 0.0, np.min(np.broadcast_arrays(*gaps), axis=0))


def _to_line(point: Any, start: Any, stop: Any) -> Array:
    along = stop - start
    length2 = np.maximum(np.abs(along) ** 2, 1e-300)
    share = np.clip(kernels.dot(along, point - start) / length2, 0.0, 1.0)
    gap: Array = np.abs(point - start - share * along)
    return gap


def tip_figures(
    curve: TipCurve,
    entry: Array,
    leave: Array,
    breaks: Array | None = None,
    wanted: Collection[str] | None = None,
) -> Figures:
    """Every figure of the path, of the instants and of the stay in the soil.

    Parameters
    ----------
    entry, leave : (P,) crank angles at which the tip enters and leaves the soil, running on in the
        sense of the drive.
    breaks : (P, B) crank angles from entry to leave between which the path is smooth; None for
        equal panels.
    wanted : first parts of the names that are needed, such as ``curve``; None for all.
    """
    instants = {
        "lowest": lambda: curve.lowest[1],
        "highest": lambda: curve.highest[1],
        "entry": lambda: entry,
        "exit": lambda: leave,
        "release": lambda: release(curve),
        "pick_up": lambda: pick_up(curve, entry),
    }
    if curve.planting.tray is None:
        del instants["pick_up"]
    groups: dict[str, Callable[[], Figures]] = {
        "surface": lambda: {"surface": curve.surface},
        "curve": lambda: size_of_curve(curve) | sharpest_bend(curve, "curve", 0.0),
        "ground": lambda: ground_bend(curve),
        "max_speed": lambda: extreme(curve, "max_speed"),
        "min_speed": lambda: extreme(curve, "min_speed"),
        "max_acceleration": lambda: extreme(curve, "max_acceleration"),
        "min_acceleration": lambda: extreme(curve, "min_acceleration"),
        "ratio": lambda: ratios(curve),
        "transmission": lambda: transmission(curve),
        "soil": lambda: in_soil(curve, entry, leave, breaks),
        "limits": lambda: limits(curve, entry, leave),
        "clearance": lambda: clearances(curve, entry),
    }
    for name, when in instants.items():
        groups[name] = lambda name=name, when=when: instant(curve, name, when())  # type: ignore[misc]
    result: Figures = {}
    for name, group in groups.items():
        if wanted is None or name in wanted:
            result |= group()
    return result
