"""What kind of quantity a figure is, told by its name."""

from __future__ import annotations

_NAMES = {
    "length": "height width length lift depth x y surface hill_spacing smallest_radius "
    "path_length_machine path_length_ground ground_advance ground_distance hole_length",
    "angle": "crank_angle direction attitude crank_travel min_at max_at transmission",
    "speed": "velocity ground_velocity max_speed min_speed forward_speed highest_forward_speed",
    "acceleration": "acceleration max_acceleration min_acceleration limit",
    "time": "time",
    "frequency": "planting_frequency",
    "angular speed": "speed highest_speed",
}
_DIMENSIONS = {name: kind for kind, names in _NAMES.items() for name in names.split()}

TURNING = {"crank_angle", "direction", "attitude", "min_at", "max_at"}
"""Last parts of the names of angles that are the same after a turn."""


def dimension_of(figure: str) -> str | None:
    """Dimension of a figure such as ``curve.height``, or None for a plain number."""
    *path, last = figure.split(".")
    if path and path[0] == "ratio" and last in ("min", "max"):
        return None
    if path and path[0] == "clearance" and last == "value":
        return "length"
    component = last in ("size", "value", "min") or (last in ("x", "y") and len(path) > 1)
    return _DIMENSIONS.get(path[-1] if path and component else last)
