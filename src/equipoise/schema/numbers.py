"""Numbers of a file as they are written: quantities, shares such as ``"80 %"``, and points."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from decimal import Decimal, localcontext
from functools import cached_property
from math import atan2, cos, hypot, isfinite, pi, sin
from types import MappingProxyType
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.keys import PLANES, Frozen, declared, key
from equipoise.quantities import (
    HUGE,
    NUMBER,
    SI,
    TINY,
    Dimension,
    format_exact,
    parse,
    plain_unit,
    rounded,
)
from equipoise.quantities.reading import described, too_far
from equipoise.quantities.units import OF_UNIT

SHARE = rf"({NUMBER}) +%"
_DIGITS = 60


def parse_share(text: str) -> float | None:
    """Read a share such as ``"80 %"`` as the float nearest to 0.8; None for what is no share.

    Raises
    ------
    UsageError : it ends as a share does, but is none.
    """
    if not text.rstrip().endswith("%"):
        return None
    match = re.fullmatch(SHARE, text)
    if match is None:
        given = text if len(text) <= 60 else f"{text[:57]}..."
        raise UsageError(
            Note('got {given!r}; give a number, a space and %, such as "80 %"', given=given)
        )
    with localcontext() as context:
        context.prec = _DIGITS
        share = float(Decimal(match[1]) / 100)
    if abs(share) > HUGE or 0 < abs(share) < TINY:
        raise UsageError(too_far(text))
    return share


def format_share(share: float) -> str:
    """Write a share such that `parse_share` gives back exactly the same float."""
    with localcontext() as context:
        context.prec = _DIGITS
        percent = (Decimal(repr(share)) * 100).normalize()
    return f"{percent:f} %" if -5 <= percent.adjusted() < 9 else f"{percent} %".lower()


# -- points in the plane ---------------------------------------------------------------------------


@declared
class Polar(Frozen):
    """A point by its distance and direction from the origin."""

    distance: float = key("length", "from the origin", example="88 mm")
    direction: float = key("angle", "from the x axis, positive counterclockwise", example="-83 deg")

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> tuple[float, float]:
        return from_polar(given["distance"], given["direction"])


def from_polar(distance: float, direction: float) -> tuple[float, float]:
    """Return x and y (m) of a point by its distance (m) and direction (rad) from the origin."""
    return distance * _clean(cos(direction)), distance * _clean(sin(direction))


def _clean(ratio: float) -> float:
    # The cosine of 90 degrees is 6e-17 in floats; in a file it means 0.
    return 0.0 if abs(ratio) < 4e-16 else ratio


def written_point(
    point: tuple[float, float],
    given: Mapping[str, str] = MappingProxyType({}),
    read: Callable[[str, Dimension], float] = parse,
) -> list[str] | dict[str, str]:
    """Write a point such that reading it gives exactly the same floats, in the shorter form.

    given : texts for its distance, its direction or both.  read : how they are read.
    """
    components = [format_exact(component, "length") for component in point]
    if not given and max(map(len, components)) < 20:
        return components
    distance = given.get("distance") or rounded(hypot(*point), "mm", 9)
    for turn in (0.0, 2 * pi):
        direction = given.get("direction") or rounded(atan2(point[1], point[0]) + turn, "deg", 9)
        if _reads_as(point, distance, direction, read):
            return {"distance": distance, "direction": direction}
    return components


def _reads_as(
    point: tuple[float, float],
    distance: str,
    direction: str,
    read: Callable[[str, Dimension], float],
) -> bool:
    try:
        return from_polar(read(distance, "length"), read(direction, "angle")) == point
    except UsageError:  # such as 1e-40 deg, where one component is tiny beside the other
        return False


# -- numbers that can be others --------------------------------------------------------------------

XYZ, POLAR = ("x", "y", "z"), ("distance", "direction")
VECTORS = ("length", "force", "acceleration")
"""Dimensions of pairs that are x and y."""
_QUANTITY = re.compile(rf"{NUMBER} +(\S.*)")


@dataclass(frozen=True)
class FileNumber:
    """A number of a model file.

    value : in SI units; an `int` where only whole numbers will do.
    dimension : None of a plain number.
    share : whether it is written as a share such as ``"80 %"``.
    """

    value: float
    dimension: Dimension | None = None
    share: bool = False

    def written(self, value: float) -> str | float:
        """Another value in the form of this one; a whole number stays one if it can."""
        if self.share:
            return format_share(float(value))
        if self.dimension is not None:
            if not isfinite(value):  # refused where it is read
                return f"{value} {SI[self.dimension]}"
            return format_exact(value, self.dimension)
        whole = isinstance(self.value, int) and float(value).is_integer()
        return int(value) if whole else float(value)


def unit_of(given: str) -> str:
    """Unit of a quantity, as the lists of units have it; empty of what is none."""
    match = _QUANTITY.fullmatch(given)
    return "" if match is None else plain_unit(match[1])


def read_number(given: Any, whole: bool = False) -> FileNumber | None:
    """What a value of a model file is as a number; None where it is none.

    whole : whether only whole numbers will do there.
    """
    if isinstance(given, bool):
        return None
    if isinstance(given, int | float):
        return FileNumber(given if whole else float(given))
    if not isinstance(given, str):
        return None
    try:
        dimension = OF_UNIT.get(unit_of(given))
        if dimension is not None:
            return FileNumber(parse(given, dimension), dimension)
        share = parse_share(given)
    except UsageError:
        return None
    return None if share is None else FileNumber(share, share=True)


def si_value(where: str, given: Any, dimension: str | None) -> float:
    """A value of a file in SI units; a plain number where its figure has no dimension.

    Raises
    ------
    ModelError : it is something else; `where` is its place.
    """
    if dimension is None:
        number = read_number(given)
        if number is None or number.dimension is not None:
            raise ModelError(
                where, Note("got {given}; give a plain number, such as 2", given=described(given))
            )
        return number.value
    try:
        return parse(given, dimension)  # type: ignore[arg-type]
    except UsageError as error:
        raise ModelError(where, error.note) from error


@dataclass(frozen=True)
class FileVector:
    """Two or three components in a list, or a point by distance and direction.

    given : as it stands in the file.
    components : in SI units.
    """

    given: Any
    components: tuple[float, ...]
    dimension: Dimension

    @cached_property
    def numbers(self) -> dict[str, FileNumber]:
        """Everything of it that can be varied, by its last key."""
        file_numbers = {
            key: FileNumber(value, self.dimension)
            for key, value in zip(XYZ, self.components, strict=False)
        }
        if self.dimension == "length":
            distance, direction = self._polar
            file_numbers["distance"] = FileNumber(distance, "length")
            file_numbers["direction"] = FileNumber(direction, "angle")
        return file_numbers

    @property
    def _polar(self) -> tuple[float, float]:
        if isinstance(self.given, dict):
            return parse(self.given["distance"], "length"), parse(self.given["direction"], "angle")
        x, y = self.components[:2]
        return hypot(x, y), atan2(y, x)

    def changed(self, values: Mapping[str, float]) -> Any:
        """With other numbers, of either form but not of both, as it would stand in the file."""
        if all(self.numbers[key].value == value for key, value in values.items()):
            return self.given
        if set(values) <= set(POLAR):
            distance, direction = (values.get(key, self.numbers[key].value) for key in POLAR)
            if isinstance(self.given, dict):
                return {
                    "distance": format_exact(distance, "length"),
                    "direction": format_exact(direction, "angle"),
                }
            components = (*from_polar(distance, direction), *self.components[2:])
        else:
            own = zip(XYZ, self.components, strict=False)
            components = tuple(values.get(key, value) for key, value in own)
        return [format_exact(component, self.dimension) for component in components]


@dataclass(frozen=True)
class PlanePair:
    """One value of a tool for both planes of bending, which can be taken apart."""

    given: str
    number: FileNumber

    @property
    def numbers(self) -> dict[str, FileNumber]:
        return dict.fromkeys(PLANES, self.number)

    def changed(self, values: Mapping[str, float]) -> Any:
        """As `FileVector.changed`."""
        if all(value == self.number.value for value in values.values()):
            return self.given
        return {
            plane: self.number.written(values.get(plane, self.number.value)) for plane in PLANES
        }


def vector_of(given: Any) -> FileVector | None:
    """A list of two or three quantities, or a point by distance and direction; else None."""
    if isinstance(given, dict) and set(given) == set(POLAR):
        distance, direction = (read_number(given[key]) for key in POLAR)
        if (
            distance
            and direction
            and (distance.dimension, direction.dimension)
            == (
                "length",
                "angle",
            )
        ):
            return FileVector(given, from_polar(distance.value, direction.value), "length")
    if isinstance(given, list) and len(given) in (2, 3):
        numbers = [read_number(item) for item in given]
        kinds = {None if number is None else number.dimension for number in numbers}
        dimension = kinds.pop()
        if not kinds and dimension in VECTORS:
            return FileVector(given, tuple(number.value for number in numbers if number), dimension)
    return None
