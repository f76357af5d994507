"""Points by distance and direction, as engineers measure them."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin

from equipoise.errors import UsageError
from equipoise.mechanism.model import Vector
from equipoise.quantities import format_exact, parse, rounded


def from_polar(distance: float, direction: float) -> Vector:
    """Return x and y (m) of a point by its distance (m) and direction (rad) from the origin."""
    return distance * _clean(cos(direction)), distance * _clean(sin(direction))


def _clean(ratio: float) -> float:
    # The cosine of 90 degrees is 6e-17 in floats; in a file it means 0.
    return 0.0 if abs(ratio) < 4e-16 else ratio


def written(point: Vector) -> list[str] | dict[str, str]:
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


def _reads_as(point: Vector, distance: str, direction: str) -> bool:
    try:
        return from_polar(parse(distance, "length"), parse(direction, "angle")) == point
    except UsageError:  # such as 1e-40 deg, where one component is tiny beside the other
        return False
