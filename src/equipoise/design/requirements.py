"""What is wanted of a figure: an objective, limits, a target, or that it is reported."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians
from typing import Literal

import numpy as np

from equipoise.errors import UsageError
from equipoise.signals import Array

Make = Literal["smallest", "largest"]
TURNING = {"crank_angle", "direction", "attitude", "min_at", "max_at"}
"""Last parts of the names of angles that are the same after a turn."""
USUAL_SHARE = 0.01
USUAL_ANGLE = radians(1)
"""Tolerance where none is given: a share of the value, or an angle."""


@dataclass(frozen=True)
class Requirement:
    """What one figure has to be, in SI units and radians.

    figure : its dotted name, such as ``soil.hole_length``.
    target : value to come close to.  at_least, at_most : limits, which are kept.
    make : whether it is to become as small or as large as the limits allow.
    tolerance : what counts as one step away; `USUAL_SHARE` of the value where not given.
    turning : whether it is an angle that is the same after a turn; told by its name if None.

    Where nothing is asked of it, it is a fact to be reported.
    """

    figure: str
    target: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    make: Make | None = None
    tolerance: float | None = None
    turning: bool | None = None

    def __post_init__(self) -> None:
        if self.target is not None and self.make:
            raise UsageError(f"{self.figure}: give either target or make")
        if self.make not in (None, "smallest", "largest"):
            raise UsageError(f"{self.figure}: got make = {self.make!r}; give smallest or largest")
        if None not in (self.at_least, self.at_most) and self.at_least > self.at_most:  # type: ignore[operator]
            raise UsageError(f"{self.figure}: at_least is above at_most")
        outside = (
            self.target is not None
            and not self.turns
            and any(slack[0] < 0 for slack in self.slack(np.array([self.target])))
        )
        if outside:
            raise UsageError(f"{self.figure}: the target lies outside the limits; change one")
        if self.tolerance is not None and not self.tolerance > 0:
            raise UsageError(f"{self.figure}: the tolerance must be more than 0")

    @property
    def turns(self) -> bool:
        """Whether the figure is an angle that is the same after a turn."""
        if self.turning is None:
            return self.figure.rpartition(".")[2] in TURNING
        return self.turning

    @property
    def limited(self) -> bool:
        """Whether it has a limit."""
        return (self.at_least, self.at_most) != (None, None)

    @property
    def is_fact(self) -> bool:
        """Whether nothing is asked of it but that it is reported."""
        return not (self.asks or self.make)

    @property
    def asks(self) -> bool:
        """Whether there is a target or a limit, which can be met or not."""
        return (self.target, self.at_least, self.at_most) != (None, None, None)

    def scale(self, start: float, dimension: str | None) -> float:
        """One step away; `start` is the figure of the machine to start from."""
        if self.tolerance is not None:
            return self.tolerance
        if dimension == "angle":
            return USUAL_ANGLE
        given = (self.target, self.at_least, self.at_most, start)
        sizes = [abs(value) for value in given if value is not None and np.isfinite(value)]
        return USUAL_SHARE * max(sizes, default=0.0) or USUAL_SHARE

    def off(self, values: Array) -> Array:
        """How far values are from the target, 0 without one."""
        if self.target is None:
            return np.zeros_like(values)
        off = values - self.target
        return np.mod(off + pi, 2 * pi) - pi if self.turns else off

    def slack(self, values: Array) -> list[Array]:
        """For each limit, how far values are inside it; negative outside."""
        signs = {1.0: self.at_least, -1.0: self.at_most}
        given = [limit for limit in signs.values() if limit is not None]
        if self.turns and given:  # the values whole turns away that are nearest to the limits
            middle = sum(given) / len(given)
            values = middle + np.mod(values - middle + pi, 2 * pi) - pi
        return [sign * (values - limit) for sign, limit in signs.items() if limit is not None]

    def kept(self, values: Array) -> Array:
        """Whether values (P,) keep every limit; False where one is NaN."""
        inside = ~np.isnan(values)
        for slack in self.slack(values):
            inside &= slack >= 0
        return inside

    def met(self, value: float, step: float) -> bool:
        """Whether a figure keeps the limits and is within one step of the target."""
        one = np.array([value])
        return bool(self.kept(one)[0] and abs(self.off(one)[0]) <= step)

    def size(self, values: Array) -> Array:
        """What is to become small, 0 unless `make` is given."""
        if self.make is None:
            return np.zeros_like(values)
        return values if self.make == "smallest" else -values
