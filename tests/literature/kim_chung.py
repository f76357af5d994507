"""Table 1 of Kim and Chung, and what their own way of computing makes of readings.

They held a protractor to the joints at every tenth degree of the crank, and put what they read into
[8-4] to [10].  `Reading` is that: the same equations with theta3 and theta4 off by half a degree,
either way, and where that is asked for with a1 to a4 of Table 1 off by half a digit.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise, product
from math import pi, radians
from typing import Any

import numpy as np

import equipoise as eq
from support.conformance import Cause

Array = np.ndarray[Any, Any]

FORWARD = 0.60
"""Speed of the machine, m/s (Table 1)."""
DEPTH = 0.04
"""Planting depth above the lowest point, m (Table 2)."""
ANGLE_OFF, LENGTH_OFF = radians(0.5), 5e-4
"""Half of the finest mark of a protractor, rad, and half a digit of Table 1, m."""
ANGLES, ALL = (
    np.array([(0,) * 6, *product((-1, 1), (-1, 1), *[sides] * 4)], float)[..., None]
    for sides in ((0,), (-1, 1))
)


@dataclass(frozen=True)
class Planter:
    """A column of Table 1, cm and degrees, with the sense of its crank."""

    name: str
    lengths: tuple[float, float, float, float]
    tip: complex
    phi: float
    sense: int

    @property
    def machine(self) -> eq.Machine:
        return eq.load(self.name)

    def move(self, theta2: Any) -> eq.mechanism.Motion:
        """Motion at crank angles theta2, rad."""
        return eq.move(self.machine, np.atleast_1d(theta2) + radians(self.phi))

    def tip_at(self, theta2: Any) -> Any:
        return self.move(theta2).points["P"]


A = Planter("kim-chung-a", (7.5, 3.5, 7.5, 8.0), -23.78 - 10.17j, 90, +1)
B = Planter("kim-chung-b", (12.5, 4.0, 10.0, 8.5), -27.38 + 6.33j, 322, -1)
C = Planter("kim-chung-c", (12.0, 3.8, 10.3, 7.5), -34.51 - 10.03j, 282, -1)


class Reading:
    """Tip and ratios at crank angles theta2, rad: rows are as drawn, then all readings of it."""

    def __init__(self, planter: Planter, theta2: Any, lengths: bool = False) -> None:
        t2 = np.atleast_1d(np.asarray(theta2, float))
        points = planter.move(t2).points
        pins = [points[name].place for name in ("A", "B", "C", "D")]
        x2, x3, x4 = (np.angle(end - start) for start, end in pairwise(pins))
        off3, off4, *off = (ALL if lengths else ANGLES).transpose(1, 0, 2)
        t3, t4 = x3 - x2 + ANGLE_OFF * off3, x4 - x3 + ANGLE_OFF * off4
        a1, a2, a3, a4 = (
            x / 100 + LENGTH_OFF * sign for x, sign in zip(planter.lengths, off, strict=True)
        )
        omega2, phi = planter.sense * 8 * pi, radians(planter.phi)
        s23, s234, s4 = np.sin(t2 + t3), np.sin(t2 + t3 + t4), np.sin(t4)
        self.coupler, self.rocker = 1 + a1 * s234 / (a3 * s4), 1 - a1 * s23 / (a4 * s4)
        w3, w4 = self.coupler * omega2, self.rocker * omega2
        change = np.cos(t2 + t3 + t4) * s4 * w4 - s234 * np.cos(t4) * (w4 - w3)
        alpha3 = a1 * omega2 * change / (a3 * s4**2)
        crank = a2 * np.exp(1j * (t2 + phi))
        arm = (a3 + planter.tip / 100) * np.exp(1j * (t2 + t3 + phi))
        self.place = crank + arm
        self.velocity = 1j * omega2 * crank + 1j * w3 * arm
        self.acceleration = -(omega2**2) * crank + (1j * alpha3 - w3**2) * arm


Signal = Callable[[Reading], Array]
AND_LENGTHS = " and half a digit of their Table 1"


def direction(vector: Array) -> Array:
    """Of readings of a vector, degrees, within half a turn of the one as drawn."""
    return np.asarray(np.degrees(np.angle(vector[0]) + np.angle(vector / vector[0])))


def read_at(
    planter: Planter, theta2: float, signal: Signal, why: str = "", lengths: bool = False
) -> Cause:
    """What a signal may be at one crank angle, deg."""
    text = f"their readings at {theta2:g} deg{why}{AND_LENGTHS if lengths else ''}"
    return Cause(text, lambda: _ends(signal(Reading(planter, radians(theta2), lengths))))


def extreme_at(planter: Planter, theta2: float, signal: Signal, sign: int) -> Cause:
    """A crank angle at which, among those that they computed, the extreme may be by readings."""

    def gives() -> float:
        own = np.append(np.arange(0.0, 360.0, 10.0), theta2)
        values = -sign * signal(Reading(planter, np.radians(own)))
        if np.max(values[:, -1]) >= np.max(np.min(values, axis=0)):
            return theta2
        return float(own[np.argmax(values[0])])

    return Cause("by their readings it may be here", gives)


def extent(planter: Planter, signal: Signal, lengths: bool = False) -> Cause:
    """Largest less smallest of a coordinate, cm."""

    def gives() -> list[float]:
        least, most = _each(planter, signal, lengths)
        apart = [np.max(least) - np.min(most), np.max(most) - np.min(least)]
        return [100 * float(item) for item in apart]

    return Cause(f"their readings{AND_LENGTHS if lengths else ''}", gives)


def crosses(planter: Planter, theta2: float) -> Cause:
    """Crank angles about theta2, deg, at which the tip may be DEPTH above its lowest point."""

    def gives() -> Array:
        least, most = _each(planter, lambda reading: reading.place.imag)
        near = theta2 + np.arange(-8.0, 8.1, 0.25)
        low, high = _ends_of_each(Reading(planter, np.radians(near)).place.imag)
        return near[(low <= np.min(most) + DEPTH) & (high >= np.min(least) + DEPTH)]

    return Cause("their readings", gives)


def path_between(planter: Planter, entry: float, leave: float) -> Cause:
    """Length over ground, cm, of the path between two crank angles, deg, its ends as read."""

    def gives() -> list[float]:
        way = planter.sense * ((leave - entry) * planter.sense % 360)
        theta2 = np.radians(entry + np.linspace(0.0, way, 2001))
        ground = planter.tip_at(theta2).place + FORWARD * (theta2 - theta2[0]) / (
            planter.sense * 8 * pi
        )
        steps = np.diff(ground)
        ends = Reading(planter, theta2[[0, -1]]).place
        along = (ends - ends[0]) * np.conj(steps[[0, -1]] / np.abs(steps[[0, -1]]))
        reach = float(np.sum(np.max(along.real, axis=0)))
        length = float(np.sum(np.abs(steps)))
        return [100 * (length - reach), 100 * (length + reach)]

    return Cause("their readings of both ends", gives)


def _ends(values: Array) -> list[float]:
    return [float(np.min(values)), float(np.max(values))]


def _ends_of_each(values: Array) -> tuple[Array, Array]:
    """The least and the largest reading at each crank angle."""
    return np.min(values, axis=0), np.max(values, axis=0)


@cache
def _every_ten_degrees(planter: Planter, lengths: bool) -> Reading:
    return Reading(planter, np.radians(np.arange(0.0, 360.0, 10.0)), lengths)


def _each(planter: Planter, signal: Signal, lengths: bool = False) -> tuple[Array, Array]:
    return _ends_of_each(signal(_every_ten_degrees(planter, lengths)))
