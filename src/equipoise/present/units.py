"""Units that a reader chooses for what is printed."""

from __future__ import annotations

from equipoise.errors import UsageError
from equipoise.quantities import KINDS, Dimension

PRINTED: tuple[Dimension, ...] = (
    "length",
    "angle",
    "speed",
    "acceleration",
    "time",
    "frequency",
    "angular speed",
    "force",
    "torque",
)
"""Dimensions whose units can be chosen."""


def read_units(text: str) -> dict[Dimension, str]:
    """Chosen units by dimension, from a list such as ``"mm, km/h"``.

    Raises
    ------
    UsageError : there is no such unit, or there are two of a dimension.
    """
    given: dict[Dimension, str] = {}
    for unit in filter(None, (part.strip() for part in text.split(","))):
        dimension = _dimension(unit)
        if given.setdefault(dimension, unit) != unit:
            raise UsageError(
                f"--units: got {given[dimension]!r} and {unit!r}, both units of {dimension}; "
                "give one"
            )
    return given


def _dimension(unit: str) -> Dimension:
    for dimension in PRINTED:
        if unit in KINDS[dimension].units:
            return dimension
    known = (unit for dimension in PRINTED for unit in KINDS[dimension].units)
    raise UsageError(f"--units: got {unit!r}; choose among {', '.join(known)}")
