"""When the tip is in the soil."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.mechanism.instants import crossings
from equipoise.mechanism.tip import TipCurve
from equipoise.planting.vectors import wrapped

Array = np.ndarray[Any, Any]


TOUCH = 1e-12
"""Share of the path's height within which the tip touches the surface and does not pass it."""


@dataclass(frozen=True)
class Visit:
    """A stay of the tip in the soil.

    entry, exit : crank angles, rad, running on in the sense of the drive from within one cycle.
    deepest : crank angle of the lowest point in between, rad.  depth : of that, m.
    """

    entry: float
    exit: float
    deepest: float
    depth: float


def visits(curve: TipCurve) -> tuple[Visit, ...]:
    """Every stay in the soil in one cycle, the deepest first.

    Raises
    ------
    ModelError : the tip never reaches the soil, or never leaves it.
    """
    level = float(curve.surface[0])
    _check_reach(curve, level)
    sense = float(np.sign(curve.speed[0, 0]))
    nodes = curve.level_nodes()
    angles = crossings(lambda theta: curve.height(theta) - level, nodes)
    falls = curve.rise(angles[None])[0] * sense < 0
    entries, exits = (
        np.sort(np.mod(sense * angles[side], curve.period)) for side in (falls, ~falls)
    )
    found = []
    for entry in entries:
        leave = _next(exits, entry, curve.period)
        theta, depth = _deepest(curve, nodes, sense * entry, sense * leave, level)
        found.append(Visit(sense * entry, sense * leave, theta, depth))
    return tuple(sorted(found, key=lambda visit: -visit.depth))


def _next(ways: Array, way: float, period: float) -> float:
    """The first of some ways after another, in this cycle or the next."""
    return float(np.min(np.where(ways > way, ways, ways + period)))


def _deepest(
    curve: TipCurve, nodes: Array, entry: float, leave: float, level: float
) -> tuple[float, float]:
    """Crank angle of the lowest point between entry and exit, and its depth."""
    low, high = min(entry, leave), max(entry, leave)
    inside = nodes + curve.period * np.ceil((low - nodes) / curve.period)
    inside = inside[inside < high]
    heights = curve.height(inside[None])[0]
    k = int(np.argmin(heights))
    return float(wrapped(curve, inside[k])), float(level - heights[k])


def _check_reach(curve: TipCurve, level: float) -> None:
    lowest, highest = float(curve.lowest[0][0]), float(curve.highest[0][0])
    touch = TOUCH * (highest - lowest)
    tip, given = curve.planting.tip, curve.planting.depth
    if level <= lowest + touch:
        raise ModelError(
            "planting.surface",
            f"got {_mm(level)}; the tip {tip} never reaches the soil, its lowest point is at "
            f"{_mm(lowest)}; give a surface above that",
        )
    if level >= highest - touch:
        key, value = ("surface", level) if given is None else ("depth", given)
        right = (
            f"it is at {_mm(highest)} at most; give a surface below that"
            if given is None
            else f"its path is {_mm(highest - lowest)} high; give a depth below that"
        )
        raise ModelError(
            f"planting.{key}", f"got {_mm(value)}; the tip {tip} never leaves the soil, {right}"
        )


def _mm(metres: float) -> str:
    return f"{1e3 * metres:.4g} mm"
