"""How close links come to the soil and to the tray."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np

from equipoise.mechanism import kernels
from equipoise.mechanism.instants import Signal, lowest_within
from equipoise.mechanism.tip import TipCurve
from equipoise.planting.tray import pick_up
from equipoise.planting.vectors import Array, Figures, wrapped


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
