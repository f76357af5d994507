"""What may change in a design problem: a range, a list or a tolerance of one number."""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite
from numbers import Real
from typing import ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.signals import Array

MOST_STEPS = 1_000_000
"""Values of one number on a grid."""
LEAST, MOST = 2.0**-54, 1 - 2.0**-53
"""Nearest to 0 and 1 that a place in a spread comes: both ends of a normal one are endless."""


@dataclass(frozen=True)
class Range:
    """Anything from `low` to `high`, all alike.

    steps : values on a grid, both ends among them; needed there only.
    whole : whole numbers only, such as those of teeth.
    """

    tolerance: ClassVar[bool] = False
    low: float
    high: float
    steps: int | None = None
    whole: bool = False

    def __post_init__(self) -> None:
        _check_finite((self.low, self.high))
        if not self.low < self.high:
            raise UsageError(Note("the first limit must be below the second"))
        for end in (self.low, self.high) if self.whole else ():
            if not float(end).is_integer():
                raise UsageError(Note("got {end:g}; give whole numbers", end=end))
        if self.steps is not None and not 2 <= self.steps <= MOST_STEPS:
            raise UsageError(
                Note(
                    "got {steps} steps; give 2 to {most_steps}",
                    steps=self.steps,
                    most_steps=MOST_STEPS,
                )
            )

    @property
    def levels(self) -> Array:
        """Values on a grid, (steps,); `UsageError` where their number is not given."""
        if self.steps is None:
            raise UsageError(Note("a grid needs the number of steps of the range"))
        levels = np.linspace(self.low, self.high, self.steps)
        if self.whole and np.any(levels != np.rint(levels)):
            count = self.high - self.low + 1
            raise UsageError(
                Note(
                    "{steps} steps from {low:g} to {high:g} are no whole numbers; give "
                    "another number of steps, such as {count:g}",
                    steps=self.steps,
                    low=self.low,
                    high=self.high,
                    count=count,
                )
            )
        return levels

    @property
    def count(self) -> int:
        """How many whole numbers there are; 0 where it is any number."""
        return int(self.high - self.low) + 1 if self.whole else 0

    def place(self, value: float) -> float | None:
        """Where a value is, between 0 and 1; None where it is beyond the limits."""
        if not self.low <= value <= self.high:
            return None
        if self.whole:
            return float((value - self.low + 0.5) / (self.high - self.low + 1))
        return float((value - self.low) / (self.high - self.low))

    def at(self, u: Array) -> Array:
        """Values (n,) at places u (n,) between 0 and 1."""
        if self.whole:
            whole: Array = np.floor(self.low + (self.high - self.low + 1) * u)
            return np.minimum(whole, self.high)
        inside: Array = np.clip(self.low + (self.high - self.low) * u, self.low, self.high)
        return inside


@dataclass(frozen=True)
class Choices:
    """One of some values, all alike."""

    tolerance: ClassVar[bool] = False
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        _check_finite(self.values)
        object.__setattr__(self, "values", tuple(map(float, self.values)))
        if not self.values:
            raise UsageError(Note("the list is empty; give at least one value"))
        if len(set(self.values)) < len(self.values):
            raise UsageError(Note("the list has a value twice; give each once"))

    @property
    def levels(self) -> Array:
        """Values on a grid, (n,), in the order in which they are given."""
        return np.array(self.values)

    @property
    def count(self) -> int:
        """How many values there are."""
        return len(self.values)

    def place(self, value: float) -> float | None:
        """Where a value is, between 0 and 1; None where it is not in the list."""
        return (self.values.index(value) + 0.5) / self.count if value in self.values else None

    def at(self, u: Array) -> Array:
        """Values (n,) at places u (n,) between 0 and 1."""
        place = np.minimum((np.asarray(u) * self.count).astype(np.intp), self.count - 1)
        chosen: Array = self.levels[place]
        return chosen


@dataclass(frozen=True)
class Normal:
    """About `mean` with a standard deviation.

    cut : nothing lies further from the mean than so many deviations; those of the whole curve, so
        that what is left has a somewhat smaller one.
    """

    tolerance: ClassVar[bool] = True
    mean: float
    deviation: float
    cut: float | None = None

    def __post_init__(self) -> None:
        _check_finite((self.mean, self.deviation))
        if self.deviation <= 0:
            raise UsageError(
                Note("got a deviation of {deviation:g}; give more than 0", deviation=self.deviation)
            )
        if self.cut is not None and not 0 < self.cut < np.inf:
            raise UsageError(
                Note("got cut = {cut:g}; give deviations, more than 0, such as 3", cut=self.cut)
            )

    @property
    def levels(self) -> Array:
        """There are none: `UsageError`."""
        raise UsageError(Note("a normal spread has no grid; give a range or a list"))

    def at(self, u: Array) -> Array:
        """Values (n,) at places u (n,) between 0 and 1."""
        from scipy.special import ndtr, ndtri

        low = 0.0 if self.cut is None else ndtr(-self.cut)
        most = np.inf if self.cut is None else self.cut
        inside = np.clip(low + (1 - 2 * low) * np.asarray(u), LEAST, MOST)
        values: Array = self.mean + self.deviation * np.clip(ndtri(inside), -most, most)
        return values


@dataclass(frozen=True)
class Uniform:
    """Anything within `half_width` of the centre, all alike."""

    tolerance: ClassVar[bool] = True
    centre: float
    half_width: float

    def __post_init__(self) -> None:
        _check_finite((self.centre, self.half_width))
        if self.half_width <= 0:
            raise UsageError(
                Note(
                    "got a half width of {half_width:g}; give more than 0",
                    half_width=self.half_width,
                )
            )

    @property
    def levels(self) -> Array:
        """There are none: `UsageError`."""
        raise UsageError(Note("a uniform tolerance has no grid; give a range or a list"))

    def at(self, u: Array) -> Array:
        """Values (n,) at places u (n,) between 0 and 1."""
        return self.centre + self.half_width * (2 * np.asarray(u) - 1)


NumberSpread = Range | Choices | Normal | Uniform
"""Spread of a number; its `tolerance` is true for scatter of manufacture."""
SPREADS: dict[str, type[NumberSpread]] = {
    "range": Range,
    "list": Choices,
    "normal": Normal,
    "uniform": Uniform,
}
"""Each by the key that gives it in a study file."""
KEYS = {kind: key for key, kind in SPREADS.items()}


def _check_finite(values: Iterable[float]) -> None:
    for value in values:
        if isinstance(value, bool) or not isinstance(value, Real) or not isfinite(value):
            raise UsageError(Note("got {value!r}; give finite numbers", value=value))


@dataclass(frozen=True)
class Variable:
    """A number that varies.

    path : of a number in the model file, such as ``links.crank.points.B.x``, or the name of a
        `Lift`, such as ``crank``, the length of that link.
    spread : what it may be, SI units.
    dimension : of its quantity, None for a plain number; a study has it from its model.
    """

    path: str
    spread: NumberSpread
    dimension: str | None = None
