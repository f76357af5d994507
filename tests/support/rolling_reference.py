"""Gears of varying ratio by brute strength: pitch curves as distances from the driver's axis.

The driver's curve is a function of the direction from its axis, and the centres are as far apart as
closes the driven one, found by bisection.  The ratio is that of both distances to the pitch point;
angles are quadratures of it, and slopes are taken by steps along the imaginary axis.  An ellipse of
one lobe is a crossed four-bar: its foci are joined by bars as long as the centres are apart.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq
from scipy.special import roots_legendre

from equipoise.mechanism.parts.gear_shapes import GearShape
from equipoise.mechanism.parts.gears import Gear

STEP = 1e-30
NODES, WEIGHTS = roots_legendre(30)


def tabled(shape: GearShape, values: tuple[float, ...]) -> Callable[[Any], Any]:
    """Return the periodic spline through a table, also for complex angles near the real ones."""
    period = 2 * np.pi / shape.lobes
    spline = CubicSpline(
        [*shape.angle, shape.angle[0] + period], [*values, values[0]], bc_type="periodic"
    )

    def curve(x: Any) -> Any:
        return spline(np.real(x)) + 1j * np.imag(x) * spline(np.real(x), 1)

    return curve


def waves(shape: GearShape, x: Any) -> Any:
    """Return 1 and the sum of a shape's cosines and sines."""
    cosines = (a * np.cos(k * shape.lobes * x) for k, a in enumerate(shape.cosines, 1))
    sines = (b * np.sin(k * shape.lobes * x) for k, b in enumerate(shape.sines, 1))
    return 1 + sum(cosines) + sum(sines)


def profile(shape: GearShape) -> Callable[[Any], Any]:
    """Return the driver's distance to its pitch curve, by direction, up to a factor."""
    e, n = shape.eccentricity or 0.0, shape.lobes
    if shape.kind == "radius" and shape.angle:
        return tabled(shape, shape.radius)
    return {
        "elliptic": lambda x: 1 / (1 + e * np.cos(n * x)),
        "eccentric": lambda x: (1 - (e * np.sin(x)) ** 2) ** 0.5 - e * np.cos(x),
        "limacon": lambda x: 1 - e * np.cos(n * x),
        "radius": lambda x: waves(shape, x),
    }[shape.kind]


def total(function: Callable[[Any], Any], end: float, shape: GearShape) -> float:
    """Return an integral from 0, in pieces that end at the rows of a table too."""
    low, high = min(0.0, end), max(0.0, end)
    rounds = 2 * np.pi / shape.lobes * np.arange(-40, 41)
    way = -1 if shape.kind == "radius" else 1
    rows = np.add.outer(rounds, way * np.array(shape.angle or (0.0,))).ravel()
    inner = rows[(rows > low) & (rows < high)]
    edges = np.unique([*np.linspace(low, high, 2 + int(4 * (high - low))), *inner])
    half = np.diff(edges)[:, None] / 2
    at = edges[:-1, None] + half * (1 + NODES)
    return float(np.sign(end) * np.sum(half * WEIGHTS * np.real(function(at))))


@lru_cache(maxsize=64)
def ratio_of(shape: GearShape, mean: float) -> Callable[[Any], Any]:
    """Return the ratio by the driver's angle, from where 0 of its curve points across."""
    period = 2 * np.pi / shape.lobes
    if shape.kind == "ratio":
        curve = tabled(shape, shape.ratio) if shape.angle else (lambda x: waves(shape, x))
        share = total(curve, period, shape) / period
        return lambda x: mean * curve(x) / share
    radius = profile(shape)
    grid = np.arange(2048) * (2 * np.pi / 2048)  # equal steps sum up a period to rounding
    far, near = np.max(radius(grid).real), np.min(radius(grid).real)

    def missing(apart: float) -> float:
        return float(np.mean((radius(grid) / (radius(grid) + apart)).real)) - mean

    # to the driven gear's radius the driver's one and the distance add up, with these signs
    if mean < 0:
        ends = (-1e3 * far, -far * (1 + 1e-9))
    else:
        ends = (-near * (1 - 1e-9), -1e-3 * near) if mean > 1 else (1e-3 * near, 1e3 * far)
    apart = brentq(missing, *ends, xtol=1e-15, rtol=1e-15)
    return lambda x: radius(-x) / (radius(-x) + apart)


class Rolling:
    """One pair: its ratio, the derivative of that, and the angle that adds up."""

    def __init__(self, gear: Gear) -> None:
        assert gear.shape is not None
        self.gear, self.shape = gear, gear.shape
        self.ratio_at = ratio_of(gear.shape, gear.speed_ratio)

    def ratio(self, x: Any) -> Any:
        """Return the ratio at angles of the driver seen from the carrier."""
        return np.real(self.ratio_at(np.asarray(x) - self.shape.phase))

    def bend(self, x: Any) -> Any:
        """Return the ratio's derivative there."""
        return np.imag(self.ratio_at(np.asarray(x) - self.shape.phase + 1j * STEP)) / STEP

    def angle(self, x: float) -> float:
        """Return how far the driven gear has turned there."""
        if self.shape.kind == "elliptic" and self.shape.lobes == 1 == -self.gear.speed_ratio:
            return crossed_bars(float(self.shape.eccentricity or 0.0), x - self.shape.phase)
        return total(self.ratio_at, x - self.shape.phase, self.shape)

    def tilt(self, x: Any) -> Any:
        """Return the angle of the driver's curve, at the pitch point, from square to its radius.

        A curve at the distance s from an axis leans by the angle whose tangent is s' / s, where s'
        is by the direction in the gear's axes, which falls as the gear turns on.
        """
        ratio, bend = self.ratio(x), self.bend(x)
        part = ratio / (ratio - 1)  # of the distance of the centres
        return np.arctan(-bend / (ratio - 1) ** 2 / part)


def crossed_bars(e: float, x: float) -> float:
    """Return the angle of the far crank of an antiparallelogram: links 1 between the pivots and
    across, cranks e; the long coupler stays the mirror image of the frame.
    """
    tip = e * np.exp(1j * x)  # of the first crank, on from its pivot at 0, the other is at -1
    along = (tip + 1) / abs(tip + 1)  # square to the mirror, which swaps the ends of both links
    end = 1 + ((tip - 1) * along.conjugate()).real * along
    angle = np.angle(end / e)
    return float(angle - 2 * np.pi * np.round((angle + x) / (2 * np.pi)))
