"""When the tip passes the edge of the seedling tray."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.mechanism import kernels
from equipoise.mechanism.instants import crossings, roots
from equipoise.mechanism.tip import TipCurve
from equipoise.planting.vectors import Array


class Edge:
    """The tip beside the tray's edge, of machines that have a tray."""

    def __init__(self, curve: TipCurve) -> None:
        assert curve.planting.tray is not None
        self.curve = curve
        self.start, stop = (complex(*point) for point in curve.planting.tray)
        self.along = stop - self.start

    def beside(self, theta: Array) -> Any:
        """A signal with the sign of the side on which the tip is, (P, K)."""
        return kernels.cross(self.along, self.curve.at(theta).place - self.start)

    def slope(self, theta: Array) -> Any:
        """Its derivative by crank angle, (P, K)."""
        return kernels.cross(self.along, self.curve.at(theta).place_1)

    def reached(self, theta: Array) -> Array:
        """Whether the tip is between both ends, not only on the line through them, (P, K)."""
        share = kernels.dot(self.along, self.curve.at(theta).place - self.start)
        inside: Array = np.abs(share / abs(self.along) ** 2 - 0.5) <= 0.5
        return inside


def pick_up(curve: TipCurve, entry: Array) -> Array:
    """Crank angle (P,) at which the tip last passes the tray's edge before it enters the soil.

    NaN where it never does.
    """
    edge = Edge(curve)
    back = np.linspace(0.0, curve.period, len(curve.theta) + 1)
    nodes = entry[:, None] - np.sign(curve.speed) * back
    sides = np.signbit(edge.beside(nodes))
    passed = sides[:, 1:] != sides[:, :-1]
    most = max(1, int(np.max(np.sum(passed, axis=1))))
    first = np.argsort(~passed, axis=1, kind="stable")[:, :most]
    ends = (np.take_along_axis(nodes, first + step, axis=1) for step in (0, 1))
    crossing = roots(edge.beside, *ends)
    meant = np.take_along_axis(passed, first, axis=1) & edge.reached(crossing)
    last = np.take_along_axis(crossing, np.argmax(meant, axis=1)[:, None], axis=1)[:, 0]
    return np.where(np.any(meant, axis=1), last, np.nan)


def tray_crossings(curve: TipCurve) -> tuple[float, ...]:
    """Crank angles within one cycle at which the tip of one machine passes the edge, rising."""
    if curve.planting.tray is None:
        return ()
    edge = Edge(curve)
    ends = np.append(curve.theta, curve.period)
    nodes = np.unique(np.concatenate([ends, crossings(edge.slope, ends)]))
    angles = crossings(edge.beside, nodes)
    if not angles.size:
        return ()
    return tuple(float(angle) for angle in angles[edge.reached(angles[None])[0]])
