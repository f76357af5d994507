"""What is wanted of a figure: an objective, limits, a target, or that it is reported.

The kinds of these are declared in `keys.requirement_kinds`.
"""

from __future__ import annotations

from math import pi, radians
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note
from equipoise.keys.requirement_kinds import Asks, RequiredFigure, asks_of
from equipoise.signals import Array

TURNING = {"crank_angle", "direction", "attitude", "min_at", "max_at"}
"""Last parts of the names of angles that are the same after a turn."""
USUAL_SHARE, USUAL_ANGLE = 0.01, radians(1)
"""Tolerance where none is given: a share of the value, or an angle."""


@dataclass(frozen=True, init=False)
class Requirement(RequiredFigure):
    """What one figure has to be, in SI units and radians.

    figure : its dotted name, such as ``soil.hole_length``.
    extra : what is asked, by the key of a `RequirementKind`: `target`, a value to come close to;
        `at_least` and `at_most`, limits, which are kept; `make`, whether it is to become the
        ``smallest`` or ``largest`` that the limits allow.
    tolerance : what counts as one step away; `USUAL_SHARE` of the value where not given.
    turning : whether it is an angle that is the same after a turn; decided by its name if None.

    Where nothing is asked of it, it is a fact to be reported.
    """

    figure: str
    tolerance: float | None = None
    turning: bool | None = None

    def __init__(
        self,
        figure: str,
        *,
        tolerance: float | None = None,
        turning: bool | None = None,
        asks: Asks = (),
        **extra: Any,
    ) -> None:
        object.__setattr__(self, "figure", figure)
        object.__setattr__(self, "tolerance", tolerance)
        object.__setattr__(self, "turning", turning)
        object.__setattr__(self, "asks", asks_of(extra, asks))
        self._check()

    def _check(self) -> None:
        if self.target is not None and self.make:
            raise UsageError(at_place(self.figure, Note("give either target or make")))
        for key, given, right in self.wrong_asks():
            what = Note("got {key} = {given}; {right}", key=key, given=given, right=right)
            raise UsageError(at_place(self.figure, what))
        if None not in (self.at_least, self.at_most) and self.at_least > self.at_most:  # type: ignore[operator]
            raise UsageError(at_place(self.figure, Note("at_least is above at_most")))
        outside = (
            self.target is not None
            and not self.turns
            and any(slack[0] < 0 for slack in self.slack(np.array([self.target])))
        )
        if outside:
            raise UsageError(
                at_place(self.figure, Note("the target lies outside the limits; change one"))
            )
        if self.tolerance is not None and not self.tolerance > 0:
            raise UsageError(at_place(self.figure, Note("the tolerance must be more than 0")))

    @property
    def turns(self) -> bool:
        """Whether the figure is an angle that is the same after a turn."""
        if self.turning is None:
            return self.figure.rpartition(".")[2] in TURNING
        return self.turning

    @property
    def is_fact(self) -> bool:
        """Whether nothing is asked of it but that it is reported."""
        return not (self.can_be_met or self.make)

    @property
    def can_be_met(self) -> bool:
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

    def satisfied(self, values: Array) -> Array:
        """Whether values (P,) keep every limit; False where one is NaN."""
        inside = ~np.isnan(values)
        for slack in self.slack(values):
            inside &= slack >= 0
        return inside

    def met(self, value: float, step: float) -> bool:
        """Whether a figure keeps the limits and is within one step of the target."""
        values = np.array([value])
        return bool(self.satisfied(values)[0] and abs(self.off(values)[0]) <= step)

    def size(self, values: Array) -> Array:
        """What is to become small, 0 unless `make` is given."""
        if self.make is None:
            return np.zeros_like(values)
        return values if self.make == "smallest" else -values
