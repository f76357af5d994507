"""How close links come to the soil and to the tray's edge."""

from __future__ import annotations

from functools import partial
from itertools import combinations
from typing import Any

import numpy as np

from equipoise.mechanism.kinematics.tip import Signal, TipCurve, lowest_within
from equipoise.planting.stroke import Figures, distance, pick_up, to_line, whole_cycle, wrapped
from equipoise.signals import Array


def clearances(curve: TipCurve, entry: Array) -> Figures:
    """Smallest distance of each link from the soil and from the tray's edge.

    A link is the lines between its points, the tip left out, which is meant to go into the soil
    and to pass the edge.  The tip's own distance from the edge is 0 where it passes it.

    entry : (P,) crank angles at which the tip enters the soil.
    """
    result: Figures = {}
    tip, tray = curve.arm.tip, curve.planting.tray
    outlines = _outlines(curve)

    def places(theta: Array, link: str) -> Array:
        state = curve.family.solve(theta)
        return np.array([curve.point_of(state, point, link)[0] for point in outlines[link]])

    def height(theta: Array, link: str) -> Any:
        return np.min(places(theta, link).imag, axis=0) - curve.surface[:, None]

    for link in outlines:
        result |= _smallest(curve, f"clearance.soil.{link}", partial(height, link=link))
    if tray is None:
        return result
    start, stop = (complex(*point) for point in tray)

    def apart(theta: Array, link: str) -> Any:
        result = places(theta, link)
        lines = combinations(result, 2) if len(result) > 1 else [(result[0], result[0])]
        return np.min([distance(a, b, start, stop) for a, b in lines], axis=0)

    for link in outlines:
        result |= _smallest(curve, f"clearance.tray.{link}", partial(apart, link=link))
    name, passes = f"clearance.tray.tip {tip}", pick_up(curve, entry)
    figures = _smallest(curve, name, lambda theta: to_line(curve.at(theta).place, start, stop))
    met = np.isfinite(passes)
    figures[f"{name}.value"][met] = 0.0
    figures[f"{name}.crank_angle"][met] = wrapped(curve, passes)[met]
    return result | figures


def _outlines(curve: TipCurve) -> dict[str, list[str]]:
    """Points of each link that has some beside tips; none where the arm is not the first."""
    if curve is not curve.arms[0]:
        return {}
    tips = {arm.arm.tip for arm in curve.arms}
    links = curve.machines[0].links.items()
    outlines = {name: [point for point in link.points if point not in tips] for name, link in links}
    return {name: points for name, points in outlines.items() if points}


def _smallest(curve: TipCurve, name: str, signal: Signal) -> Figures:
    value, at = lowest_within(signal, *whole_cycle(curve), samples=len(curve.theta) + 1)
    return {f"{name}.value": value, f"{name}.crank_angle": wrapped(curve, at)}
