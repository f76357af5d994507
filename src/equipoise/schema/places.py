"""Places: of keys in a file, and of points in the plane, as both are written."""

from __future__ import annotations

import re
from collections.abc import Iterable
from json import dumps as quoted
from math import atan2, cos, hypot, pi, sin
from typing import Any

from equipoise.errors import UsageError
from equipoise.keys import Frozen, declared, key
from equipoise.quantities import format_exact, parse, rounded

Place = tuple[str | int, ...]
"""Keys, and numbers in lists from 0."""
LONGEST_KEY = 60

# -- in a file -------------------------------------------------------------------------------------


def written_key(name: str) -> str:
    """Return a key as it stands in TOML, cut where it is endless."""
    name = name if len(name) <= LONGEST_KEY else f"{name[:57]}..."
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else quoted(name)


def written_place(place: Iterable[str | int]) -> str:
    """Dotted path with numbers from 1, as the machine's own checks write it."""
    text = "".join(f"[{s + 1}]" if isinstance(s, int) else f".{written_key(s)}" for s in place)
    return text.removeprefix(".")


# -- in the plane ----------------------------------------------------------------------------------


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


def written_point(point: tuple[float, float]) -> list[str] | dict[str, str]:
    """Write a point such that reading it gives exactly the same floats, in the shorter form."""
    components = [format_exact(component, "length") for component in point]
    if max(map(len, components)) < 20:
        return components
    distance = rounded(hypot(*point), "mm", 9)
    for turn in (0.0, 2 * pi):
        direction = rounded(atan2(point[1], point[0]) + turn, "deg", 9)
        if _reads_as(point, distance, direction):
            return {"distance": distance, "direction": direction}
    return components


def _reads_as(point: tuple[float, float], distance: str, direction: str) -> bool:
    try:
        return from_polar(parse(distance, "length"), parse(direction, "angle")) == point
    except UsageError:  # such as 1e-40 deg, where one component is tiny beside the other
        return False
