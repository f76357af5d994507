"""How close links come to the soil and to the tray."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from equipoise.mechanism import kernels
from equipoise.mechanism.instants import lowest_within
from equipoise.mechanism.tip import TipCurve
from equipoise.planting.visits import tray_crossings

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Clearance:
    """Smallest distance, m, and the crank angle (rad) of it; below 0 under the surface."""

    value: float
    crank_angle: float


def soil_clearances(curve: TipCurve) -> dict[str, Clearance]:
    """Height of each link's lowest point above the surface; the tip is meant to go below."""
    level = float(curve.surface[0])
    found = {}
    for link, points in _outlines(curve).items():

        def height(theta: Array, link: str = link, points: list[str] = points) -> Any:
            return np.min(_places(curve, link, points, theta).imag, axis=0) - level

        found[link] = _smallest(curve, height)
    return found


def tray_clearances(curve: TipCurve) -> dict[str, Clearance]:
    """Distance of each link, and of the tip, from the tray's edge.

    A link is the lines between its points, the tip left out, which is meant to pass the edge.
    """
    if curve.planting.tray is None:
        return {}
    start, stop = (complex(*point) for point in curve.planting.tray)
    found = {}
    for link, points in _outlines(curve).items():

        def apart(theta: Array, link: str = link, points: list[str] = points) -> Any:
            places = _places(curve, link, points, theta)
            lines = combinations(places, 2) if len(points) > 1 else [(places[0], places[0])]
            return np.min([distance(a, b, start, stop) for a, b in lines], axis=0)

        found[link] = _smallest(curve, apart)
    tip, crossed = f"tip {curve.planting.tip}", tray_crossings(curve)
    if crossed:
        found[tip] = Clearance(0.0, crossed[0])
    else:
        found[tip] = _smallest(curve, lambda x: _to_line(curve.at(x).place, start, stop))
    return found


def _outlines(curve: TipCurve) -> dict[str, list[str]]:
    """Points of each moving link but the tip."""
    tip = curve.planting.tip
    outlines = {
        name: [point for point in link.points if point != tip]
        for name, link in curve.machines[0].links.items()
    }
    return {name: points for name, points in outlines.items() if points}


def _places(curve: TipCurve, link: str, points: list[str], theta: Array) -> Array:
    state = curve.family.solve(theta)
    return np.array([curve.point_of(state, point, link)[0] for point in points])


def _smallest(curve: TipCurve, signal: Any) -> Clearance:
    ends = np.zeros(1), np.full(1, curve.period)
    value, at = lowest_within(signal, *ends, samples=len(curve.theta) + 1)
    return Clearance(float(value[0]), float(np.mod(at[0], curve.period)))


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
