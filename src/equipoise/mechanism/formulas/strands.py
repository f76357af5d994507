"""The two straight strands of a belt: tangents of its pulleys, and how far the belt lies on these.

Complex vectors in the carrier's axes, m, from the driver's pin.  The left strand leaves the driver
on the left of the way to the driven pulley, the right one on its right.  Every number may be a
column.
"""

from __future__ import annotations

from math import pi
from typing import Any, Literal

import numpy as np

from equipoise.dataclass import dataclass

Side = Literal[1, -1]
LEFT: Side = 1
RIGHT: Side = -1


@dataclass(frozen=True)
class Strands:
    """A belt about two pulleys.

    apart : from the driver's pin to the driven pulley's.
    radius : of the driver.  other : of the driven pulley, below 0 where the belt is crossed.
    """

    apart: Any
    radius: Any
    other: Any

    @property
    def distance(self) -> Any:
        """Of the pins, m."""
        return abs(self.apart)

    @property
    def sine(self) -> Any:
        """Of the angle between a strand and the line of the pins."""
        return (self.radius - self.other) / self.distance

    @property
    def cosine(self) -> Any:
        return np.sqrt(1 - self.sine * self.sine)

    @property
    def length(self) -> Any:
        """Of a strand, m; both are as long."""
        return self.distance * self.cosine

    def way(self, side: Side) -> Any:
        """Unit vector along a strand, from the driver to the driven pulley."""
        return self.apart * (self.cosine - 1j * side * self.sine) / self.distance

    @property
    def toward(self) -> Any:
        """Sum of the unit vectors along both, which points from pin to pin."""
        return self.apart * (2 * self.cosine / self.distance)

    def ends(self, side: Side) -> tuple[Any, Any]:
        """Where a strand leaves the driver, and where it comes to the driven pulley."""
        out = 1j * side * self.way(side)
        return self.radius * out, self.apart + self.other * out

    def run_through(self, place: Any, share: float) -> bool:
        """Whether a strand comes to a place, from the driver's pin (complex, m), as near as this
        share of the distance of the pins.
        """
        for side in (LEFT, RIGHT):
            start, _ = self.ends(side)
            way = (place - start) * np.conj(self.way(side))
            inside = (way.real >= 0) & (way.real <= self.length)
            if np.all(inside & (abs(way.imag) <= share * self.distance)):
                return True
        return False

    @property
    def wraps(self) -> tuple[Any, Any]:
        """Angles over which the belt lies on driver and driven pulley, rad."""
        lean = 2 * np.arcsin(self.sine)
        return pi + lean, pi - lean * np.sign(self.other)

    @property
    def belt_length(self) -> Any:
        """Of the whole belt, m."""
        first, second = self.wraps
        return 2 * self.length + self.radius * first + abs(self.other) * second
