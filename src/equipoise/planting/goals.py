"""What a search of geometry has to reach: targets, limits, and figures to make small or large."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians
from typing import Any, Literal

import numpy as np

from equipoise.errors import UsageError
from equipoise.planting.names import TURNING, dimension_of

Array = np.ndarray[Any, Any]

USUAL_SHARE = 0.01
USUAL_ANGLE = radians(1)
"""Tolerance where none is given: a share of the value, or an angle."""


@dataclass(frozen=True)
class Goal:
    """What one figure has to be, in SI units and radians.

    figure : its dotted name, such as ``soil.hole_length``.
    target : value to come close to.  at_least, at_most : limits, which are kept.
    make : whether it is to become as small or as large as the limits allow.
    tolerance : what counts as one step away; `USUAL_SHARE` of the value where not given.
    """

    figure: str
    target: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    make: Literal["smallest", "largest"] | None = None
    tolerance: float | None = None

    def __post_init__(self) -> None:
        if self.target is None and self.at_least is None and self.at_most is None and not self.make:
            raise UsageError(
                f"{self.figure}: give at least one of target, at_least, at_most and make"
            )
        if self.target is not None and self.make:
            raise UsageError(f"{self.figure}: give either target or make")
        if self.make not in (None, "smallest", "largest"):
            raise UsageError(f"{self.figure}: got make = {self.make!r}; give smallest or largest")
        if None not in (self.at_least, self.at_most) and self.at_least > self.at_most:  # type: ignore[operator]
            raise UsageError(f"{self.figure}: at_least is above at_most")
        outside = (
            self.target is not None
            and not self.turning
            and any(slack[0] < 0 for slack in self.slack(np.array([self.target])))
        )
        if outside:
            raise UsageError(f"{self.figure}: the target lies outside the limits; change one")
        if self.tolerance is not None and not self.tolerance > 0:
            raise UsageError(f"{self.figure}: the tolerance must be more than 0")

    @property
    def group(self) -> str:
        """First part of the figure's name."""
        return self.figure.partition(".")[0]

    @property
    def turning(self) -> bool:
        """Whether the figure is an angle that is the same after a turn."""
        return self.figure.rpartition(".")[2] in TURNING

    @property
    def asks(self) -> bool:
        """Whether there is a target or a limit, which can be met or not."""
        return (self.target, self.at_least, self.at_most) != (None, None, None)

    def scale(self, start: float) -> float:
        """One step away; `start` is the figure of the machine to start from."""
        if self.tolerance is not None:
            return self.tolerance
        if dimension_of(self.figure) == "angle":
            return USUAL_ANGLE
        given = (self.target, self.at_least, self.at_most, start)
        sizes = [abs(value) for value in given if value is not None and np.isfinite(value)]
        return USUAL_SHARE * max(sizes, default=0.0) or USUAL_SHARE

    def off(self, values: Array) -> Array:
        """How far values are from the target, 0 without one."""
        if self.target is None:
            return np.zeros_like(values)
        off = values - self.target
        return np.mod(off + pi, 2 * pi) - pi if self.turning else off

    def slack(self, values: Array) -> list[Array]:
        """For each limit, how far values are inside it; negative outside."""
        limits = ((self.at_least, 1.0), (self.at_most, -1.0))
        return [
            sign * (self._near(values, limit) - limit)
            for limit, sign in limits
            if limit is not None
        ]

    def met(self, value: float, step: float) -> bool:
        """Whether a figure keeps the limits and is within one step of the target."""
        one = np.array([value])
        kept = all(slack[0] >= 0 for slack in self.slack(one))
        return kept and bool(abs(self.off(one)[0]) <= step)

    def _near(self, values: Array, limit: float) -> Array:
        """Values, or for turning angles those whole turns away that are nearest to a limit."""
        if not self.turning:
            return values
        middle = limit if None in (self.at_least, self.at_most) else self._middle()
        return middle + np.mod(values - middle + pi, 2 * pi) - pi

    def _middle(self) -> float:
        assert self.at_least is not None and self.at_most is not None
        return (self.at_least + self.at_most) / 2

    def size(self, values: Array) -> Array:
        """What is to become small, 0 unless `make` is given."""
        if self.make is None:
            return np.zeros_like(values)
        return values if self.make == "smallest" else -values
