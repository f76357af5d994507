"""Values of a machine or tool as they stand in its file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from equipoise.quantities import Dimension, format_exact


def unless(default: bool, **items: Any) -> dict[str, Any]:
    """Keys that are written where their values are not the default."""
    return {} if default else items


def quantities(table: Any, dimensions: Mapping[str, Dimension]) -> dict[str, str]:
    """Write those attributes that are neither None nor 0."""
    return {
        name: format_exact(value, dimension)
        for name, dimension in dimensions.items()
        if (value := getattr(table, name))
    }


def tidy(value: float) -> float:
    """Return a whole number without its decimal point."""
    return int(value) if value.is_integer() and abs(value) < 1e6 else value


def listed(values: Iterable[float], dimension: Dimension) -> list[str]:
    """Write a list of quantities of one dimension."""
    return [format_exact(value, dimension) for value in values]


def usual_name(station: str, cause: str) -> str:
    """Name of an excitation that has none of its own."""
    return f"{station} {cause}".strip()
