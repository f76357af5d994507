"""The units in which tables are printed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from equipoise.errors import UsageError
from equipoise.quantities.units import FACTORS, KINDS, Dimension
from equipoise.terminal.tables import number

USUAL: dict[Dimension, str] = {
    "length": "cm",
    "angle": "deg",
    "speed": "m/s",
    "acceleration": "m/s^2",
    "time": "ms",
    "frequency": "Hz",
    "angular speed": "rpm",
    "force": "N",
    "torque": "N m",
}

OF_VIBRATION: dict[Dimension, str] = {**USUAL, "length": "mm", "speed": "mm/s"}


@dataclass(frozen=True)
class Units:
    """One unit for each dimension that is printed."""

    chosen: Mapping[Dimension, str]

    @classmethod
    def read(cls, text: str, usual: Mapping[Dimension, str] = USUAL) -> Units:
        """Units from a list such as ``"mm, km/h"``; the usual ones of what is not in it."""
        given: dict[Dimension, str] = {}
        for unit in filter(None, (part.strip() for part in text.split(","))):
            dimension = _dimension(unit, usual)
            if given.setdefault(dimension, unit) != unit:
                raise UsageError(
                    f"--units: got {given[dimension]!r} and {unit!r}, both units of "
                    f"{dimension}; give one"
                )
        return cls({**usual, **given})

    def name(self, dimension: Dimension) -> str:
        """The unit, such as ``cm``."""
        return self.chosen[dimension]

    def value(self, value: float, dimension: Dimension) -> float:
        """A value in SI units, in the unit that is printed."""
        return value / float(FACTORS[self.chosen[dimension]])

    def shown(self, value: float | None, dimension: Dimension, scale: float = 0.0) -> str:
        """A value in SI units as text without its unit; 0 where it is rounding beside `scale`."""
        if value is None:
            return ""
        if dimension == "angle":
            return f"{self.value(value, dimension):.{ANGLE_DIGITS[self.chosen['angle']]}f}"
        return number(self.value(value, dimension), self.value(scale, dimension))


ANGLE_DIGITS = {"deg": 2, "rad": 4, "turn": 5}


def _dimension(unit: str, usual: Mapping[Dimension, str]) -> Dimension:
    for dimension in usual:
        if unit in KINDS[dimension].units:
            return dimension
    known = (unit for dimension in usual for unit in KINDS[dimension].units)
    raise UsageError(f"--units: got {unit!r}; choose among {', '.join(known)}")
